from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import wearlaw as wl
from tests.strategies import EPS, LINE_MODELS, line_problems, log_uniform, saturation_creepage, with_creepage
from wearlaw import Array
from wearlaw.crossings import CROSSINGS, crossings

NONE = 0.5 * math.pi


def find(name: str, problem: wl.LineProblem, breakpoints: dict[str, tuple[float, ...]]) -> tuple[Array, Array]:
    """Return the crossings of a batch of one axis, as θ and as x."""
    model = LINE_MODELS[name]
    start, end = model.slip_zone(problem)
    theta = crossings(model, problem, (start, end), breakpoints)
    half = 0.5 * (end - start)[:, None]
    return theta, 0.5 * (start + end)[:, None] + half * np.sin(theta)


def one(problem: wl.LineProblem) -> wl.LineProblem:
    return problem[None] if problem.creepage.ndim == 0 else problem


def suros(creepage: float, max_pressure: float = 1500e6) -> wl.LineProblem:
    return one(
        wl.TwinDisc.suros().problem(
            max_pressure=wl.Q(max_pressure, "Pa"), creepage=wl.Q(creepage, ""), friction_coefficient=0.46
        )
    )


def test_a_law_without_breakpoints_needs_no_splits() -> None:
    theta, _ = find("exact", suros(0.02), {})
    assert theta.shape == (1, 0)


def test_there_is_a_column_for_each_possible_crossing() -> None:
    problem = wl.TwinDisc.suros().problem(
        max_pressure=wl.Q(1500, "MPa"), creepage=wl.Q([0.001, 0.01, 0.1], ""), friction_coefficient=0.46
    )
    theta, _ = find("exact", problem, {"pressure": (1e9,), "slip_speed": (0.2, 0.7)})
    assert theta.shape == (3, 3 * CROSSINGS)
    assert (np.abs(theta) <= NONE).all()


@given(problem=line_problems(), share=st.floats(0.01, 0.99))
def test_the_pressure_is_crossed_at_the_root_of_hertz(problem: wl.LineProblem, share: float) -> None:
    # in full slip, where the zone is the patch
    full = one(with_creepage(problem, 2.0 * saturation_creepage(problem)))
    _, x = find("exact", full, {"pressure": (share * float(problem.max_pressure),)})
    root = float(problem.half_width) * math.sqrt((1.0 - share) * (1.0 + share))
    # a relative rounding of p moves x by p / |p'| of it, a²/x - x
    tolerance = 16 * EPS * (float(problem.half_width) ** 2 / root)
    assert x[0] == pytest.approx([-root, root], abs=tolerance)


@given(problem=line_problems(), share=st.floats(0.01, 0.99))
def test_the_slip_speed_is_crossed_at_the_root_of_the_slip(problem: wl.LineProblem, share: float) -> None:
    reduced = 3.0
    saturation = saturation_creepage(problem)
    full = one(with_creepage(problem, reduced * saturation))
    speed = (reduced - 1.0 + 2.0 * share) * saturation * float(problem.rolling_speed)
    theta, x = find("exact", full, {"slip_speed": (speed,)})
    assert x[0, 0] == pytest.approx(
        float(problem.half_width) * (2.0 * share - 1.0), abs=32 * EPS * float(problem.half_width)
    )
    assert theta[0, 1] == NONE  # a rising variable is crossed once


@pytest.mark.parametrize("name", ["exact", "fastsim-parabolic-line", "fastsim-elliptic-line"])
@given(reduced=st.floats(0.05, 10.0), share=st.floats(0.02, 0.98))
def test_at_every_crossing_the_variable_has_its_breakpoint(name: str, reduced: float, share: float) -> None:
    problem = suros(reduced * 0.0123)
    model = LINE_MODELS[name]
    start, end = model.slip_zone(problem)
    inside = start + (end - start) * np.linspace(0.001, 0.999, 500)
    fields = model.fields(problem[..., None], inside)
    values = np.abs(fields.traction * fields.slip)
    breakpoint_ = share * float(values.max())
    theta, x = find(name, problem, {"wear_index_density": (breakpoint_,)})
    found = theta[0] < NONE
    at = model.fields(problem[..., None], x[:, found])
    assert (at.traction * at.slip)[0] == pytest.approx(np.full(found.sum(), breakpoint_), rel=1e-9)
    # and there are as many as changes of sign on a grid of 500
    changes = int(np.diff(np.signbit(values - breakpoint_)).sum())
    assert found.sum() >= changes


@given(gap=log_uniform(1e-10, 1e-3))
def test_a_hump_between_two_samples_is_found(gap: float) -> None:
    # p0 just above the breakpoint: p is above it on a stretch of √(2 gap) about the middle
    problem = suros(0.02, 2.1e9 * (1.0 + gap))
    _, x = find("exact", problem, {"pressure": (2.1e9,)})
    root = float(problem.half_width[0]) * math.sqrt(1.0 - (2.1e9 / float(problem.max_pressure[0])) ** 2)
    # p0 itself is exact to a few EPS, which the root feels as EPS/√(2 gap)
    assert x[0] == pytest.approx([-root, root], abs=32 * EPS / math.sqrt(2.0 * gap) * float(problem.half_width[0]))


@given(gap=log_uniform(1e-10, 1e-3))
def test_a_hump_that_stays_below_is_not_found(gap: float) -> None:
    theta, _ = find("exact", suros(0.02, 2.1e9 * (1.0 - gap)), {"pressure": (2.1e9,)})
    assert (theta == NONE).all()


@pytest.mark.parametrize(("name", "half"), [("exact", 0.5), ("fastsim-parabolic-line", 0.75)])
@given(gap=log_uniform(1e-9, 1e-7), behind=log_uniform(1e-5, 3e-3))
def test_a_hump_next_to_the_start_of_the_zone_is_found(name: str, half: float, gap: float, behind: float) -> None:
    # the pressure peaks at x = 0, a little behind where slip begins, x = a (1-2d) = -2 behind·a
    problem = suros(0.001, 2.1e9 * (1.0 + gap))
    slipping = one(with_creepage(problem[0], half * saturation_creepage(problem[0]) * (1.0 + 2.0 * behind)))
    a = float(problem.half_width[0])
    root = a * math.sqrt(1.0 - (2.1e9 / float(problem.max_pressure[0])) ** 2)
    start = float(LINE_MODELS[name].slip_zone(slipping)[0][0])
    _, x = find(name, slipping, {"pressure": (2.1e9,)})
    crossed = [v for v in (-root, root) if v > start]
    assert x[0, : len(crossed)] == pytest.approx(crossed, abs=64 * EPS / math.sqrt(2.0 * gap) * a)


def test_negative_creepage_is_crossed_where_positive_is() -> None:
    forward, backward = suros(0.03), suros(-0.03)
    zone = LINE_MODELS["exact"].slip_zone(forward)
    # slip and traction carry the sign of the creepage, which a law's breakpoints do not
    breakpoints = {"slip_speed": (0.03,), "wear_index_density": (1e7,), "slip": (0.03,), "traction": (3e8,)}
    one_way, other = (crossings(LINE_MODELS["exact"], p, zone, breakpoints) for p in (forward, backward))
    assert (one_way == other).all()
    assert (one_way[:, ::CROSSINGS] < NONE).all()


def test_nothing_is_crossed_without_slip() -> None:
    theta, _ = find("fastsim-elliptic-line", suros(0.0), {"wear_index_density": (1e7,), "slip_speed": (0.2,)})
    assert (theta == NONE).all()
