"""Where a field crosses a value: by closed forms and by a search, against roots worked out by hand."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

import wearlaw as wl
from tests.line import fields_at, slip_zone
from tests.strategies import EPS, LINE_MODELS, log_uniform, saturation_creepage, with_creepage
from wearlaw import Array
from wearlaw.errors import ModelError
from wearlaw.numerics.crossings import crossings  # private: not the means that they split
from wearlaw_kit import line_problems
from wearlaw_models.contact_models.exact import Exact


class Searched(Exact):
    """Carter's theory without its closed forms."""

    def crossings(self, problem: wl.Problem, variable: str, value: Array) -> None:
        return None


MODELS: dict[str, wl.LineContactModel] = {**LINE_MODELS, "exact, searched": Searched()}
EXACT = ("exact", "exact, searched")


def find(
    name: str, problem: wl.Problem, breakpoints: Mapping[str, tuple[float, ...]]
) -> tuple[Array, NDArray[np.bool_]]:
    """Return the crossings of a batch of one axis as x, in the order of x, and which of them are there."""
    zone = MODELS[name].zones(problem)[1]
    angles = crossings(MODELS[name], problem, zone, breakpoints)[:, ::-1]
    x = problem.half_width[:, None] - zone.span[:, None] * np.sin(0.5 * angles) ** 2
    return x, angles < zone.angle[:, None]


def one(problem: wl.Problem) -> wl.Problem:
    return problem[None] if problem.creepage.ndim == 0 else problem


def suros(creepage: float, max_pressure: float = 1500e6) -> wl.Problem:
    return one(
        wl.TwinDisc.suros().problem(
            max_pressure=wl.Q(max_pressure, "Pa"), creepage=wl.Q(creepage, ""), friction_coefficient=0.46
        )
    )


def test_a_law_without_breakpoints_needs_no_splits() -> None:
    x, _ = find("exact", suros(0.02), {})
    assert x.shape == (1, 0)


def test_crossings_are_in_ascending_order() -> None:
    zone = LINE_MODELS["exact"].zones(suros(0.1))[1]
    found = crossings(LINE_MODELS["exact"], suros(0.1), zone, {"slip_speed": (0.1, 0.09), "pressure": (1e9, 5e8)})
    assert (np.diff(found[0]) >= 0.0).all()
    assert (found < zone.angle[:, None]).sum() > 3


@pytest.mark.parametrize("name", EXACT)
@given(problem=line_problems(), share=st.floats(0.01, 0.99))
def test_the_pressure_is_crossed_at_the_root_of_hertz(name: str, problem: wl.Problem, share: float) -> None:
    # in full slip, where the zone is the patch
    full = one(with_creepage(problem, 2.0 * saturation_creepage(problem)))
    x, _ = find(name, full, {"pressure": (share * float(problem.max_pressure),)})
    root = float(problem.half_width) * math.sqrt((1.0 - share) * (1.0 + share))
    # a relative rounding of p moves x by p / |p'| of it, a²/x - x
    tolerance = 16 * EPS * (float(problem.half_width) ** 2 / root)
    assert x[0] == pytest.approx([-root, root], abs=tolerance)


@pytest.mark.parametrize("name", ["exact", "fastsim-parabolic-line", "fastsim-elliptic-line"])
@given(reduced=st.floats(0.05, 10.0), share=st.floats(0.02, 0.98))
def test_at_every_crossing_the_variable_has_its_breakpoint(name: str, reduced: float, share: float) -> None:
    problem = suros(reduced * 0.0123)
    model = LINE_MODELS[name]
    start, end = slip_zone(model, problem)
    inside = start[:, None] + (end - start)[:, None] * np.linspace(0.001, 0.999, 500)
    fields = fields_at(model, problem, inside)
    values = np.abs(fields.traction * fields.slip)
    breakpoint_ = share * float(values.max())
    x, there = find(name, problem, {"wear_index_density": (breakpoint_,)})
    found = there[0]
    at = fields_at(model, problem, x[:, found])
    assert (at.traction * at.slip)[0] == pytest.approx(np.full(found.sum(), breakpoint_), rel=1e-9)
    # and there are as many as changes of sign on a grid of 500
    changes = int(np.diff(np.signbit(values - breakpoint_)).sum())
    assert found.sum() >= changes


@pytest.mark.parametrize("name", EXACT)
@given(gap=log_uniform(1e-10, 1e-3))
def test_a_hump_between_two_samples_is_found(name: str, gap: float) -> None:
    # p0 just above the breakpoint: p is above it on a stretch of √(2 gap) about the middle
    problem = suros(0.02, 2.1e9 * (1.0 + gap))
    x, _ = find(name, problem, {"pressure": (2.1e9,)})
    root = float(problem.half_width[0]) * math.sqrt(1.0 - (2.1e9 / float(problem.max_pressure[0])) ** 2)
    # p0 itself is exact to a few EPS, which the root feels as EPS/√(2 gap)
    assert x[0] == pytest.approx([-root, root], abs=32 * EPS / math.sqrt(2.0 * gap) * float(problem.half_width[0]))


@pytest.mark.parametrize("name", EXACT)
@given(gap=log_uniform(1e-10, 1e-3))
def test_a_hump_that_stays_below_is_not_found(name: str, gap: float) -> None:
    _, there = find(name, suros(0.02, 2.1e9 * (1.0 - gap)), {"pressure": (2.1e9,)})
    assert not there.any()


class WithAHole(Searched):
    """No pressure is known where it is close to 1 GPa, between two of the places that are searched."""

    def fields(self, problem: wl.Problem, nodes: wl.Nodes) -> wl.LineFields:
        fields = super().fields(problem, nodes)
        pressure = np.where(np.abs(fields.pressure - 1e9) < 1e6, np.nan, fields.pressure)
        return dataclasses.replace(fields, pressure=pressure)


def test_a_model_whose_fields_are_not_finite_next_to_a_crossing_is_refused_by_name() -> None:
    model, problem = WithAHole(), suros(0.1)
    with pytest.raises(ModelError, match="contact model 'exact': its pressure crosses a breakpoint, but the "):
        crossings(model, problem, model.zones(problem)[1], {"pressure": (1e9,)})


@pytest.mark.parametrize("name", MODELS)
def test_nothing_is_crossed_without_slip(name: str) -> None:
    _, there = find(name, suros(0.0), {"wear_index_density": (1e7,), "slip_speed": (0.2,)})
    assert not there.any()
