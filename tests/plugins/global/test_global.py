"""The one cell of patch means, against the models that its total is from."""

from __future__ import annotations

import dataclasses
import math
import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import wearlaw as wl
from tests.cases import load, table
from tests.plugins.kit.cells import Cells
from tests.strategies import EPS, LINE_MODELS, log_uniform, saturation_creepage, with_creepage
from wearlaw import Q
from wearlaw.errors import CaseError
from wearlaw_kit import checks, line_problems

SUROS = wl.TwinDisc.suros()
CONDITIONS = {"normal_force": Q(7.4143, "kN"), "friction_coefficient": 0.46}


@given(problem=line_problems())
def test_the_one_cell_holds_the_patch_means(problem: wl.Problem) -> None:
    contact = wl.contact_model("global").solve(problem)
    area = float(2.0 * problem.half_width * problem.track_width)
    assert contact.pressure.shape == (1,)
    assert float(contact.area[0]) == pytest.approx(area, rel=4 * EPS)
    # p = (π/4) p0
    assert float(contact.pressure[0]) == pytest.approx(0.25 * math.pi * float(problem.max_pressure), rel=16 * EPS)
    assert float(contact.slip[0]) == float(problem.creepage)
    assert float(contact.traction[0]) * area == pytest.approx(float(contact.tangential_force), rel=4 * EPS)


@given(problem=line_problems())
def test_the_total_is_that_of_carter_by_default(problem: wl.Problem) -> None:
    reduced = min(float(problem.creepage) / saturation_creepage(problem), 1.0)
    # d (2-d), as 1-(1-d)² without its rounding at small d
    expected = float(problem.friction_coefficient * problem.normal_force) * reduced * (2.0 - reduced)
    assert float(wl.contact_model("global").solve(problem).tangential_force) == pytest.approx(expected, rel=16 * EPS)


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


def test_the_patch_means_of_a_local_model_are_the_global_contact() -> None:
    conditions = {"creepage": Q([-2.0, -0.5, 0.0, 0.5, 2.0], "%"), **CONDITIONS}
    means = (SUROS | wl.contact_model("fastsim") | wl.patch_mean())(**conditions).contact  # type: ignore[arg-type]
    one_cell = (SUROS | wl.contact_model("global", total_from="fastsim"))(**conditions).contact  # type: ignore[arg-type]
    for field in ("pressure", "traction", "slip", "area", "tangential_force", "wear_index"):
        # the means sum the nodes of the patch
        assert getattr(means, field) == pytest.approx(getattr(one_cell, field), rel=64 * EPS), field


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
