"""What a contact model has from `LineContactModel`."""

from __future__ import annotations

import dataclasses
from typing import Any, ClassVar

import numpy as np
import pytest
from hypothesis import given

import wearlaw as wl
from tests.strategies import EPS, LINE_MODELS
from wearlaw import Array, Q
from wearlaw_kit import line_problems

pytestmark = pytest.mark.filterwarnings("ignore::wearlaw.WearlawWarning")

RIG = wl.TwinDisc.suros()
every_model = pytest.mark.parametrize("name", LINE_MODELS)

SUM = 64.0 * EPS
"""A sum over the nodes of a zone, of which each carries some ten roundings that do not add up."""


def mirrored(problem: wl.Problem) -> wl.Problem:
    return problem.replaced(longitudinal_creepage=-problem.creepage)


def sweep(creepage: Array, **changes: Any) -> wl.Problem:
    conditions: Any = {"max_pressure": "1500 MPa", "friction_coefficient": 0.46, **changes}
    return RIG.problem(creepage=Q(creepage, ""), **conditions)


class Bare(wl.LineContactModel):
    """A block that slips as a whole, with the methods that must be there and no other."""

    name: ClassVar[str] = "bare"
    source: ClassVar[str] = "the tests"

    def slip_length(self, problem: wl.Problem) -> Array:
        return np.where(problem.creepage > 0.0, 2.0 * problem.half_width, 0.0)

    def fields(self, problem: wl.Problem, nodes: wl.Nodes) -> wl.LineFields:
        pressure = wl.hertz.pressure(nodes.x, problem.half_width, problem.max_pressure)
        bound = np.broadcast_to(problem.friction_coefficient * problem.max_pressure, nodes.x.shape)
        slip = np.broadcast_to(problem.creepage, nodes.x.shape)
        return wl.LineFields(pressure=pressure, traction=0.5 * bound, slip=slip, traction_bound=bound)

    def tangential_force_per_width(self, problem: wl.Problem) -> Array:
        force = problem.friction_coefficient * problem.max_pressure * problem.half_width
        return np.where(problem.creepage > 0.0, force, 0.0)


# --- What the class gives ----------------------------------------------------------------------------------------


def test_a_model_with_nothing_but_the_required_methods_predicts_wear() -> None:
    predict = RIG | Bare() | wl.wear_law("usfd")
    found = predict(max_pressure="1500 MPa", creepage=Q([-0.01, 0.0, 0.2], ""), friction_coefficient=0.46)
    density = 0.5 * 0.46 * 1500.0 * np.array([0.01, 0.0, 0.2])  # q·s everywhere, in N/mm²
    expected = np.minimum(5.3 * density, 55.0) + 61.9 * np.maximum(density - 77.26, 0.0)
    assert found.wear_rate.m_as("ug/m/mm^2") == pytest.approx(expected, rel=SUM)


@every_model
@given(problem=line_problems())
def test_the_force_has_the_sign_of_the_creepage_and_is_that_of_solve(name: str, problem: wl.Problem) -> None:
    model = LINE_MODELS[name]
    force = model.tangential_force(problem)
    assert force == model.tangential_force_per_width(problem.forward()) * problem.track_width
    assert model.tangential_force(mirrored(problem)) == -force
    for each in (problem, mirrored(problem)):
        assert model.solve(each).tangential_force == model.tangential_force(each)


@every_model
@given(problem=line_problems())
def test_the_zones_share_the_patch(name: str, problem: wl.Problem) -> None:
    model, patch = LINE_MODELS[name], 2.0 * problem.half_width
    stick, slip = model.zones(problem)
    assert slip.length == model.slip_length(problem)
    assert slip.length + stick.length == pytest.approx(patch, rel=2 * EPS)
    assert tuple(zone.length for zone in model.zones(mirrored(problem))) == (stick.length, slip.length)
    assert slip.span == (patch if name.startswith("fastsim") else slip.length)
    contact = model.solve(problem)
    length = contact.area / problem.track_width
    assert length.sum() == pytest.approx(float(patch), rel=SUM)
    assert length[contact.slip != 0.0].sum() == pytest.approx(float(slip.length), rel=SUM)
    border, rounding = float(problem.half_width - slip.length), 4 * EPS * float(problem.half_width)
    sticks = contact.x[contact.slip == 0.0]
    assert (sticks <= border + rounding).all()
    assert (contact.x[contact.slip != 0.0] >= border - rounding).all()
    assert np.abs(contact.x).max() <= float(problem.half_width) + rounding


@every_model
@pytest.mark.parametrize("shape", [(), (3,), (2, 3)])
def test_the_contact_can_be_had_at_any_nodes(name: str, shape: tuple[int, ...]) -> None:
    model, random = LINE_MODELS[name], np.random.default_rng(71)
    problem = sweep(random.choice([-1.0, 1.0], shape) * 10.0 ** random.uniform(-4.0, -1.0, shape))
    x = np.sort(random.uniform(-1.0, 1.0, (*shape, 7)), axis=-1) * problem.half_width[..., None]
    nodes = wl.Nodes.at(x, problem.half_width)
    nodes = dataclasses.replace(nodes, length=np.full(x.shape, 1e-6))
    contact = model.at(problem, nodes)
    fields = model.fields(problem.forward()[..., None], nodes)
    sign = np.sign(problem.creepage)[..., None]
    assert contact.x == pytest.approx(x, abs=2 * EPS * float(problem.half_width.max()))
    assert (contact.area == 1e-6 * problem.track_width[..., None]).all()
    assert (contact.pressure == fields.pressure).all()
    assert (contact.traction == sign * fields.traction).all()
    assert (contact.slip == sign * fields.slip).all()
    assert (contact.traction_bound == fields.traction_bound).all()
    assert (contact.tangential_force == model.tangential_force(problem)).all()
