"""Positions of wheels on rails: mirrored, turned and shifted ones, jumps, ends of profiles, and loops against NumPy."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import wearlaw as wl
from tests.plugins.wheelset.wheelsets import wheelset
from wearlaw import Array, Q
from wearlaw_models.rigs.wheelset.search import (  # private: one step of the contact, against another way to it
    Touching,
    searched,
)
from wearlaw_models.rigs.wheelset.search_loops import ROLL_ACCURACY  # private: the accuracy that a search ends at

STANDARD = wheelset()
ROUNDING = 2e-9
"""A contact point [m] or an angle [rad] after other roundings: the roll is known to a few ROLL_ACCURACY, and a contact
point moves by up to 500 times what the wheel does, where the relative curvature is small."""
ODD = ("y", "contact_angle")
"""Variables of a patch that change their sign in the mirror."""
OF_PATCH = (
    "x", "y", "z", "contact_angle", "rolling_radius", "wheel_y", "wheel_z", "rail_y", "rail_z",
)  # fmt: skip
"""Variables of a patch that are places or angles."""


def geometry(pair: wl.Wheelset, displacement: Array, yaw: Any = 0.0) -> Any:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", wl.RangeWarning)
        return pair.geometry(lateral_displacement=Q(displacement, "m"), yaw=Q(yaw, "rad")).dataset


def values(data: Any, name: str) -> Array:
    """Return a variable in m or rad."""
    return np.asarray(data[name].values * (np.pi / 180.0 if data[name].attrs["units"] == "deg" else 1e-3))


def assert_same(one: Any, other: Any, but: tuple[str, ...] = (), rounding: float = ROUNDING) -> None:
    """Two geometries agree in the places of first patches, but for some variables."""
    for name in (*OF_PATCH, "roll", "vertical_displacement"):
        if name not in but:
            found, expected = (values(data.sel(patch=1), name) for data in (one, other))
            assert found == pytest.approx(expected, rel=0.0, abs=rounding), name


@pytest.fixture(autouse=True)
def by_default() -> Iterator[None]:
    """Leave the choice of loops as it was."""
    yield
    wl.accelerate(None)


# Between jumps: at 0.2185, 4.855 to 4.9 and 6.18 to 6.25 mm the point is where rounding puts it.
displacements = st.floats(0.3e-3, 4.7e-3) | st.floats(5.0e-3, 6.1e-3) | st.floats(6.3e-3, 9e-3) | st.just(0.0)
yaws = st.floats(-30e-3, 30e-3)


@given(displacement=displacements, yaw=yaws)
def test_the_mirrored_position_swaps_sides_and_signs(displacement: float, yaw: float) -> None:
    one = geometry(STANDARD, np.array([displacement]), yaw)
    other = geometry(STANDARD, np.array([-displacement]), -yaw)
    for name in OF_PATCH:
        sign = -1.0 if name in ODD else 1.0
        found, expected = values(other.sel(patch=1), name), values(one.sel(patch=1), name)
        assert sign * found[:, ::-1] == pytest.approx(expected, rel=0.0, abs=ROUNDING), name
    assert -values(other, "roll") == pytest.approx(values(one, "roll"), rel=0.0, abs=4.0 * ROLL_ACCURACY)


GRID = np.array([-8.0, -5.5, -2.0, 0.0, 1.3, 4.0, 6.0, 7.0]) * 1e-3
"""Displacements away from jumps [m]."""


def test_a_rail_turned_by_hand_is_one_with_cant() -> None:
    turned = wheelset(rail=wl.Profile.uic60().turned(Q(-np.arctan(1.0 / 40.0), "rad")), rail_cant="0 rad")
    # The rail's own coordinates are turned, and nothing else.
    assert_same(geometry(turned, GRID, 10e-3), geometry(STANDARD, GRID, 10e-3), but=("rail_y", "rail_z"))


def test_shifted_wheel_profiles_with_their_inner_faces_are_the_same_wheels() -> None:
    shifted = wheelset(
        wheel=wl.Profile.s1002().shifted(y="3 mm", z="2 mm"), flange_back_position="-67 mm", nominal_radius="458 mm"
    )
    other = geometry(shifted, GRID, -15e-3)
    one = geometry(STANDARD, GRID, -15e-3)
    # The taping line is 2 mm lower on the wheel, and so is the wheel when that line is on the rail's top.
    assert_same(other, one, but=("wheel_y", "wheel_z", "vertical_displacement"))
    for name, shift in (("wheel_y", 3e-3), ("wheel_z", 2e-3), ("vertical_displacement", -2e-3)):
        found = values(other.sel(patch=1), name)
        assert found == pytest.approx(values(one.sel(patch=1), name) + shift, rel=0.0, abs=ROUNDING), name


def test_shifted_rail_profiles_change_nothing() -> None:
    shifted = wheelset(rail=wl.Profile.uic60().shifted(y="5 mm", z="-3 mm"))
    other, one = (geometry(pair, GRID, 5e-3) for pair in (shifted, STANDARD))
    assert_same(other, one, but=("rail_y", "rail_z"))


# ------------------------------------------------------------------------------------------------------------ jumps

JUMPS = [(0.2089e-3, 10.2e-3), (4.8479e-3, 10.48e-3)]
"""Displacements at which the contact point of the right wheel jumps without yaw, and about how far [m]."""


def right(displacement: Array, yaw: Array | float = 0.0) -> Array:
    """Return y of the right contact point [m]."""
    return values(geometry(STANDARD, displacement, yaw).sel(side="right", patch=1), "y")


def test_jumps_of_the_contact_point_are_kept() -> None:
    for place, jump in JUMPS:
        low, high = place - 2e-6, place + 2e-6
        for _ in range(40):  # the jump between two displacements that differ by rounding
            middle = 0.5 * (low + high)
            y = right(np.array([low, middle, high]))
            low, high = (middle, high) if abs(y[1] - y[0]) < abs(y[1] - y[2]) else (low, middle)
        before, after = right(np.array([low, high]))
        assert high - low < 1e-15
        assert abs(before - after) == pytest.approx(jump, rel=0.02)
        # On either side the point stays on its own branch: the nearest of 50 displacements is off by what the branch
        # itself moves, never in between.
        y = right(np.linspace(low - 1e-6, high + 1e-6, 50))
        off = np.minimum(np.abs(y - before), np.abs(y - after))
        assert off.max() < 1e-4


def test_two_patches_are_listed_at_a_jump_and_are_those_on_its_sides() -> None:
    place, _ = JUMPS[1]
    around = geometry(STANDARD, np.array([place - 1e-6, place + 1e-6])).sel(side="right")
    y = values(around, "y")
    assert y[0, :2] == pytest.approx(y[1, 1::-1], rel=0.0, abs=1e-4)
    gap = values(around, "gap")
    assert (gap[:, 0] == 0.0).all()
    # The gap of the second grows with the displacement by the difference of tan δ between both, 0.28 - 0.13.
    assert ((gap[:, 1] > 0.0) & (gap[:, 1] < 1e-6)).all()


# ------------------------------------------------------------------------------------------------ compiled loops


def both_ways(
    displacement: Array, yaw: Array, roll: Array | None = None, pair: wl.Wheelset = STANDARD
) -> list[tuple[Array, Touching]]:
    """Return roll and contact points by NumPy and by compiled loops."""
    found = []
    for compiled in (False, True):
        wl.accelerate(compiled)
        found.append(searched(pair._section, displacement, yaw, roll))
    return found


@pytest.mark.parametrize("pair", [STANDARD, wheelset(roller_radius="350 mm")], ids=["rails", "rollers"])
@pytest.mark.parametrize("rolled", [False, True])
def test_compiled_loops_find_what_numpy_finds(rolled: bool, pair: wl.Wheelset) -> None:
    pytest.importorskip("numba")
    rng = np.random.default_rng(7)
    displacement, yaw = rng.uniform(-10e-3, 10e-3, 1000), rng.uniform(-30e-3, 30e-3, 1000)
    # Near jumps too, where the two may stand on different sides.
    displacement[:100] = np.concatenate([place + rng.uniform(-1e-9, 1e-9, 50) for place, _ in JUMPS])
    yaw[:100] = 0.0
    rolls = rng.uniform(-2e-3, 2e-3, 1000) if rolled else None
    (roll, one), (other_roll, other) = both_ways(displacement, yaw, rolls, pair)
    assert other_roll == pytest.approx(roll, rel=0.0, abs=4.0 * ROLL_ACCURACY)
    assert other.least == pytest.approx(one.least, rel=0.0, abs=4.0 * ROLL_ACCURACY)
    # The order of two patches is free where their gaps are the same, to what the rolls leave open.
    tie = (one.gap[..., 1:] - one.gap[..., :-1] < 1e-10).any(axis=-1)
    assert tie.sum() < 20
    same = ~tie
    assert np.array_equal(np.isnan(one.arc[same]), np.isnan(other.arc[same]))
    for found, expected in ((other.arc, one.arc), (other.gap, one.gap)):
        assert found[same] == pytest.approx(expected[same], rel=0.0, abs=ROUNDING, nan_ok=True)


# ------------------------------------------------------------------------------------------------------ no contact


def part(profile: wl.Profile, low: float, high: float) -> wl.Profile:
    """Return the part of a profile between two values of y [m], through its points."""
    y, z = (one.to("mm").magnitude for one in profile.points)
    kept = (y > 1e3 * low) & (y < 1e3 * high)
    return wl.Profile.from_points(y=Q(y[kept][::4], "mm"), z=Q(z[kept][::4], "mm"), kind=profile.kind)


def test_a_wheel_on_the_end_of_its_profile_is_an_error() -> None:
    # Its tread ends 5 mm outside of the taping line; the left wheel needs more of it from y = 5 mm on.
    narrow = wheelset(wheel=part(wl.Profile.s1002(), -69e-3, 7e-3))
    narrow.geometry(lateral_displacement="1 mm")
    with pytest.raises(wl.ConditionsError, match=r"at 5 mm the left wheel does not touch its rail within the profiles"):
        narrow.geometry(lateral_displacement="5 mm")


def test_a_wheel_on_the_end_of_its_rail_is_an_error() -> None:
    # The left wheel runs outwards on its rail, from 0.2 mm outside of the middle of the head to 4.3 mm at y = 3 mm.
    rail = part(wl.Profile.uic60(), -10e-3, 30e-3)
    with pytest.raises(wl.InputError, match="gauge_depth: 14 mm is below the gauge side of the rail"):
        wheelset(rail=rail)
    narrow = wheelset(rail=part(wl.Profile.uic60(), -40e-3, 3.5e-3))
    narrow.geometry(lateral_displacement="1 mm")
    with pytest.raises(wl.ConditionsError, match=r"lateral_displacement: at 3 mm the left wheel"):
        narrow.geometry(lateral_displacement="3 mm")


@pytest.mark.parametrize("compiled", [False, True])
@pytest.mark.parametrize("displacement", ["60 mm", "-60 mm", "3 m"])
def test_a_wheel_beside_its_rail_is_an_error(displacement: str, compiled: bool) -> None:
    if compiled:
        pytest.importorskip("numba")
    wl.accelerate(compiled)
    with pytest.raises(wl.ConditionsError, match=r"the (left|right) wheel does not touch its rail"):
        STANDARD.geometry(lateral_displacement=displacement)


def test_a_climbing_wheel_is_warned_of_and_has_a_result() -> None:
    # Where a wheel climbs shows under load, with the roll.
    contact = STANDARD | wl.contact_model("fastsim")
    with pytest.warns(wl.RangeWarning, match=r"6.5 mm the right wheel climbs"):
        contact.posed({"lateral_displacement": "6.5 mm", "vertical_load": "10 kN", "friction_coefficient": 0.3})
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        contact.posed({"lateral_displacement": "6 mm", "vertical_load": "10 kN", "friction_coefficient": 0.3})
