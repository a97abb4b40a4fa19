"""Wheelsets on rollers, against surfaces of revolution in space."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
import pytest

import wearlaw as wl
from tests.plugins.wheelset.test_search import first, si
from tests.plugins.wheelset.wheelsets import Body, least_gap, standing, wheelset
from wearlaw import Q

RADIUS = 0.35
PAIR = wheelset(roller_radius=Q(RADIUS, "m"))


@pytest.mark.validates(
    "wheelset",
    "Contact of S1002 on rollers of 60E1 with roll and yaw: the least gap between the bodies is zero, and where it is",
    source="search over the surface of the wheel in space (scipy)",
    held_to="gap {gap:g} and place {place:g} of the height by which the wheelset is off that of its taping line",
    gap=2.2e-4,
    place=1.2e-2,
)
@pytest.mark.parametrize(("displacement", "yaw"), [(0.0, 0.0), (3e-3, 20e-3), (-5.5e-3, 10e-3), (5e-3, -15e-3)])
def test_wheels_touch_where_their_surfaces_in_space_are_nearest(
    displacement: float, yaw: float, gap: float, place: float
) -> None:
    # The search takes the distance R + r0 of the axes. A crest at x = -ψ y R/A moves by r/R of the share by which A is
    # off, and by 6.6 mm r0/(R A) at most; y and z follow it on the locus. Heights change by 1 - cos(x/R).
    found = first(PAIR, displacement, yaw)
    down = float(si(found, "vertical_displacement"))
    where = standing(displacement, si(found, "roll"), yaw, down)
    for side, name in ((-1, "left"), (1, "right")):
        least, nearest = least_gap(Body(PAIR, side), *where)
        there = np.array([si(found.sel(side=name), axis) for axis in "xyz"])
        assert abs(least) < 1e-9 + gap * abs(down)
        assert nearest == pytest.approx(there, rel=0.0, abs=2e-7 + place * abs(down))


def test_a_roller_as_large_as_the_earth_is_a_rail() -> None:
    # What differs is of the order of the wheel's radius over the roller's.
    law = wl.wear_law("energy", mass_per_energy="0.001 ug/J")
    where: dict[str, Any] = {
        "lateral_displacement": Q([0.0, 4.9, 6.2], "mm"), "yaw": "7 mrad", "vertical_load": "60 kN",
        "friction_coefficient": 0.3, "lateral_velocity": "0.02 m/s", "yaw_velocity": "0.05 rad/s",
    }  # fmt: skip
    on_rail, on_roller = ((pair | wl.contact_model("strip_theory") | law)(**where)
                          for pair in (wheelset(), wheelset(roller_radius="6371 km")))  # fmt: skip
    for name in ("max_pressure", "longitudinal_force", "lateral_force", "wear_rate", "spin"):
        due = on_rail[name].magnitude
        assert on_roller[name].magnitude == pytest.approx(due, rel=1e-5, abs=1e-5 * np.nanmax(np.abs(due)), nan_ok=True)
    assert on_rail.wear_profile("rail").depth.units == "nm"
    assert on_roller.wear_profile("rail").depth.units == "um/km"


def test_bodies_of_a_problem_have_the_radii_of_their_patches() -> None:
    with warnings.catch_warnings(action="ignore"):
        problem: Any = (PAIR | wl.contact_model("fastsim")).posed({
            "lateral_displacement": "6.3 mm", "vertical_load": "60 kN", "friction_coefficient": 0.3,
        })  # fmt: skip
    roller = problem.body("rail")
    _, z = Body(PAIR, 1).rail(roller.profile_position[problem.exists])
    # The mean over rows is off from their middle by what the arc of 13 mm falls beside its tangent.
    off = 0.5 * float(np.nanmax(problem.b)) ** 2 / 13e-3
    assert roller.rolling_radius[problem.exists] == pytest.approx(RADIUS - z, abs=off)
    assert z.max() > 5e-3


def test_rollers_are_straight_track() -> None:
    with pytest.raises(wl.ConditionsError, match="curve_radius: rollers stand for straight track"):
        PAIR.problem(lateral_displacement="0 mm", vertical_load="50 kN", friction_coefficient=0.3, curve_radius="300 m")
