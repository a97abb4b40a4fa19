"""Cells on the strips of an ellipse, split where a law jumps."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np
import pytest

import wearlaw as wl
from tests.strategies import EPS
from wearlaw import Array
from wearlaw.numerics.solving import Solver  # private: what the solver checks of each block
from wearlaw.numerics.splits import split_rates  # private: rates of split cells, not their sum

RAILS = wl.WheelRail(wheel_radius="460 mm", rail_head_radius="300 mm", material=wl.steel(), rolling_speed="30 m/s")
FULL_SLIP: Any = {"normal_force": "80 kN", "longitudinal_creepage": "10 %", "friction_coefficient": 0.3}
STRIPS = 20


class PressedHard(wl.WearLaw):
    """Wears at one rate where a body slips under a pressure in some intervals, and not elsewhere."""

    name: ClassVar[str] = "pressed_hard"
    levels: ClassVar[tuple[float, ...]] = ()
    variable: ClassVar[str] = "pressure"

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Array:
        above = np.sum([getattr(contact, self.variable) >= level for level in self.levels], axis=0)
        rate: Array = np.where((contact.slip != 0.0) & (above % 2 == 1), 1e-3, 0.0)
        return rate

    def breakpoints(self, p: wl.Numbers) -> wl.BreakpointMap:
        return {self.variable: self.levels}

    def jumps(self, p: wl.Numbers) -> wl.BreakpointMap:
        return self.breakpoints(p)


def law(*levels: float, declares: bool = True, variable: str = "pressure") -> wl.WearLaw:
    """Return the law that jumps at these pressures [Pa], or values of another variable in SI."""
    members: dict[str, Any] = {"levels": levels, "variable": variable, "__module__": __name__}
    if not declares:
        members["jumps"] = wl.WearLaw.jumps
    made: wl.WearLaw = type("Pressed", (PressedHard,), members)()
    return made


def lengths(levels: tuple[float, ...], declares: bool = True, strips: int = STRIPS) -> tuple[Any, Array]:
    """Return the contact, and the length of each strip that wears, over that of the longest [-]."""
    predict = RAILS | wl.contact_model("fastsim", strips=strips) | law(*levels, declares=declares)
    found: Any = predict(**FULL_SLIP)
    wear = found.wear_profile("rail").depth.values * 1e-9 * 7850.0 / 1e-3
    return found, wear / (2.0 * found.problem.a)


def exact(share: float, y: Array) -> Array:
    """Return the length of strips at y/b within the ellipse where p/p0 is at least a share, over 2a."""
    return np.sqrt(np.maximum(1.0 - y**2 - share**2, 0.0))


def error_of_interpolation(contact: Any, p0: float, share: float) -> Array:
    """Return the largest error of the place where linear interpolation between nodes finds a pressure, over 2a.

    Between nodes h apart it is off by h² |p''|/8 / |p'| at most, with p'' and p' at the two nodes; on both sides.
    """
    x, y, a, b = contact.x, contact.y, contact.problem.a, contact.problem.b
    inside = np.maximum(1.0 - (y / b) ** 2 - (x / a) ** 2, 1e-12)
    first, second = np.abs(x / a) / np.sqrt(inside), (1.0 - (y / b) ** 2) / inside**1.5
    h = np.diff(x / a, axis=-2)
    most = h**2 / 8.0 * np.maximum(second[1:], second[:-1]) / np.minimum(first[1:], first[:-1])
    crossed = (contact.pressure[1:] >= share * p0) != (contact.pressure[:-1] >= share * p0)
    bound: Array = 0.5 * np.where(crossed, most, 0.0).sum(axis=0)
    return bound


@pytest.mark.parametrize("share", [0.3, 0.6, 0.8])
def test_a_jump_is_placed_between_nodes_to_second_order(share: float) -> None:
    p0 = float((RAILS | wl.contact_model("fastsim"))(**FULL_SLIP).problem.max_pressure)
    found, length = lengths((share * p0,))
    contact = found.contact
    y = contact.y[0] / float(found.problem.b)
    assert ((contact.slip > 0.0) | (contact.area == 0.0)).all()  # so a strip crosses the pressure twice or never
    error = np.abs(length - exact(share, y))
    reaches = (contact.pressure >= share * p0).any(axis=0)
    assert reaches.sum() > STRIPS // 3
    assert (error <= error_of_interpolation(contact, p0, share) + 64 * EPS)[reaches].all()
    _, unsplit = lengths((share * p0,), declares=False)
    assert error[reaches].max() < 0.2 * np.abs(unsplit - exact(share, y))[reaches].max()


def test_two_jumps_between_two_nodes_are_both_placed() -> None:
    p0 = float((RAILS | wl.contact_model("fastsim"))(**FULL_SLIP).problem.max_pressure)
    low, high = 0.70, 0.71  # a band narrower than a cell
    found, length = lengths((low * p0, high * p0))
    y = found.contact.y[0] / float(found.problem.b)
    reaches = (found.contact.pressure >= high * p0).any(axis=0)
    want = exact(low, y) - exact(high, y)
    # The width of a band that two lines between the same two nodes cut off: the slope of a chord in place of p'.
    assert length[reaches].sum() == pytest.approx(want[reaches].sum(), rel=0.1)
    _, unsplit = lengths((low * p0, high * p0), declares=False)
    assert abs(unsplit[reaches].sum() / want[reaches].sum() - 1.0) > 0.3


@pytest.mark.parametrize(("variable", "level"), [("slip_speed", 1e-6), ("pressure", 0.9e9)])
def test_what_sticks_does_not_wear_beside_a_jump(variable: str, level: float) -> None:
    # Where a strip begins to slip, the slip jumps from zero, so that nothing may be interpolated there.
    conditions = {**FULL_SLIP, "longitudinal_creepage": "0.15 %", "lateral_creepage": "0.05 %"}
    predict: Any = RAILS | wl.contact_model("fastsim", strips=STRIPS) | law(level, variable=variable)
    found = predict(**conditions)
    contact = found.contact
    assert 0.3 < contact.stick_ratio < 0.7
    solver, own = Solver(predict.contact_model), predict.wear_law
    batch = contact.problem[None]
    rates = split_rates(solver, own, predict.contact_model.solve(batch), batch, own.numbers)[0]
    assert (rates[contact.slip == 0.0] == 0.0).all()
    if variable == "slip_speed":
        assert found.wear_rate.m_as("kg/m^3") == pytest.approx(1e-3 * (1.0 - contact.stick_ratio), rel=64 * EPS)


def test_a_patch_whose_strips_are_not_in_the_middle_wears_as_one_whose_strips_are() -> None:
    half, count = 5e-3, 8
    x = (np.arange(count) + 0.5) * 2.0 * half / count - half
    p, s = 1e9 * (x + half) / half, np.linspace(0.5, 1.5, count)
    nodes = {"pressure": p, "slip": s, "traction": 1e8 * np.ones(count)}
    problem = wl.Problem.ellipse(
        a="5 mm", b="3 mm", normal_force="80 kN", shear_modulus="82 GPa", poisson_ratio=0.28, friction_coefficient=0.3,
        longitudinal_creepage="10 %", lateral_creepage="0 %", spin="0 1/m",
    )  # fmt: skip
    one = wl.CreepForces(longitudinal=np.array(1.0), lateral=np.array(0.0), spin_moment=np.array(0.0))
    jump = 1.1e9  # where x = 0.1 half

    def wear(shift: float, more: int) -> float:
        """Return the wear with the patch moved along x, and some nodes without area before it."""

        def column(values: Array) -> Array:
            return np.pad(values, (more, 0))[:, None]

        step = x[1] - x[0]
        along = (x[0] + shift + step * np.arange(-more, count))[:, None]
        contact = wl.Contact.from_strips(
            problem, one, x=along, y=np.zeros(1), length=column(np.full(count, step)), strip_width=np.full(1, 1e-3),
            traction=(column(nodes["traction"]), column(np.zeros(count))), slip=(column(s), column(np.zeros(count))),
            traction_bound=column(np.full(count, np.inf)), pressure=column(p),
        )  # fmt: skip
        return float(wl.Prediction.of(contact, law(jump)).wear_rate.m_as("kg/m/m^2"))

    # The pressure is linear, so the part beyond the jump is exact: it wears from x = 0.1 half to half.
    assert wear(0.0, 0) == pytest.approx(1e-3 * 0.45, rel=1e-12)
    for shift, more in ((3e-3, 0), (-2e-3, 0), (0.0, 4), (1e-3, 2)):
        assert wear(shift, more) == pytest.approx(1e-3 * 0.45, rel=1e-12), (shift, more)
