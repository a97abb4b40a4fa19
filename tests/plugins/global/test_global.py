"""The one cell of patch means, against the models that its total is from."""

from __future__ import annotations

import dataclasses
import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import wearlaw as wl
from tests.cases import load, table
from tests.plugins.kit.cells import Cells
from tests.strategies import EPS, LINE_MODELS, log_uniform, with_creepage
from wearlaw import Q
from wearlaw.errors import CaseError
from wearlaw_kit import checks, line_problems

SUROS = wl.TwinDisc.suros()
CONDITIONS = {"normal_force": Q(7.4143, "kN"), "friction_coefficient": 0.46}


@pytest.mark.parametrize("name", LINE_MODELS)
@given(problem=line_problems())
def test_the_total_is_that_of_the_model_it_is_taken_from(name: str, problem: wl.Problem) -> None:
    model = LINE_MODELS[name]
    contact = wl.contact_model("global", total_from=model).solve(problem)
    assert float(contact.tangential_force) == pytest.approx(float(model.solve(problem).tangential_force), rel=4 * EPS)


@given(problem=line_problems(), coefficient=log_uniform(1e-3, 1.0), sign=st.sampled_from([-1.0, 0.0, 1.0]))
def test_a_measured_traction_coefficient_takes_the_place_of_the_theory(
    problem: wl.Problem, coefficient: float, sign: float
) -> None:
    measured = dataclasses.replace(
        with_creepage(problem, sign * float(problem.creepage)), traction_coefficient=np.array(coefficient)
    )
    contact = wl.contact_model("global").solve(measured)
    force = sign * coefficient * float(problem.normal_force)
    assert float(contact.tangential_force) == pytest.approx(force, rel=4 * EPS)
    assert float(contact.wear_index) == pytest.approx(
        coefficient * float(problem.normal_force * abs(measured.creepage)), rel=8 * EPS
    )
    assert abs(float(contact.traction[0])) <= float(contact.traction_bound[0]) * (1.0 + 4 * EPS)


def test_a_pipeline_hands_a_measured_traction_coefficient_on() -> None:
    contact = (SUROS | wl.contact_model("global"))(creepage=Q(1, "%"), traction_coefficient=0.4, **CONDITIONS)  # type: ignore[arg-type]
    assert contact.traction_coefficient.magnitude == pytest.approx(0.4, rel=4 * EPS)


def test_the_exemptions_follow_the_model_that_the_total_is_from() -> None:
    kalker = wl.contact_model("fastsim", bound="elliptic", flexibility="kalker")
    assert set(wl.contact_model("global").exemptions) == {"stick"}
    assert set(wl.contact_model("global", total_from=kalker).exemptions) == {"stick", "saturation", "initial_slope"}
    # the energy of the one cell is balanced whatever slip the inner model prints
    printed = wl.contact_model("global", total_from=wl.contact_model("exact", slip="as_printed"))
    assert set(printed.exemptions) == {"stick"}


def test_an_unknown_model_for_the_total_is_refused_by_name() -> None:
    with pytest.raises(wl.ConfigurationError, match=r"total_from: no contact model is called 'exakt'.*'exact'"):
        wl.contact_model("global", total_from="exakt")


@pytest.mark.parametrize("name", ["linear", "polach", "shen_hedrick_elkins"])
def test_a_model_that_solves_no_lines_cannot_give_the_total(name: str) -> None:
    message = f"total_from: must be a contact model that solves line contacts, such as \"exact\"; got '{name}'"
    with pytest.raises(wl.ConfigurationError, match=re.escape(message)):
        wl.contact_model("global", total_from=name)


def test_a_case_whose_total_is_of_a_model_that_solves_no_lines_is_refused_at_its_path(tmp_path: Path) -> None:
    models = [{"model": "global", "total_from": {"model": "linear"}}]
    with pytest.raises(CaseError, match=r"contact_models\.0\.total_from: must be .* line contacts, .* 'linear'"):
        load(tmp_path, table(contact_models=models))


def test_its_force_is_as_exact_as_that_of_the_model_it_is_taken_from() -> None:
    model = wl.contact_model("global", total_from=Cells())
    assert model.accuracy == Cells().accuracy
    held_to_friction = {"traction_keeps_its_bound", "full_slip_is_reached"}
    checked = [check for check in checks(model) if check.name in held_to_friction]
    assert len(checked) == len(held_to_friction)
    for check in checked:
        check()
