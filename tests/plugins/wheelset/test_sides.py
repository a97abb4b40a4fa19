"""Wheels and rails with a profile of their own on each side."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

import wearlaw as wl
from tests.plugins.wheelset.test_positions import assert_same, geometry
from tests.plugins.wheelset.wheelsets import wheelset
from wearlaw import Q

pytestmark = pytest.mark.filterwarnings("ignore::wearlaw.RangeWarning")

NEW = wl.Profile.s1002()
S = np.linspace(-40.0, 40.0, 401)
WORN = NEW.worn(Q(S, "mm"), Q(0.3 * np.exp(-0.5 * ((S + 5.0) / 15.0) ** 2), "mm"))
RAIL = wl.Profile.uic60()
GROUND = RAIL.worn(Q(S[50:-50], "mm"), Q(0.2 * np.exp(-0.5 * (S[50:-50] / 8.0) ** 2), "mm"))
PLACES = np.array([-5.6, -3.0, -1.0, 0.4, 2.0, 4.0, 5.6]) * 1e-3
CONDITIONS: dict[str, Any] = {"vertical_load": "60 kN", "friction_coefficient": 0.3}


@pytest.fixture(autouse=True)
def by_default() -> Iterator[None]:
    yield
    wl.accelerate(None)


@pytest.mark.parametrize("compiled", [False, True])
def test_at_a_given_roll_each_side_is_that_of_a_wheelset_with_its_profiles(compiled: bool) -> None:
    wl.accelerate(compiled)
    pair = wheelset(wheel=NEW, left_wheel=WORN, rail=RAIL, left_rail=GROUND)
    alike = {"left": wheelset(wheel=WORN, rail=GROUND), "right": wheelset(wheel=NEW, rail=RAIL)}
    given: dict[str, Any] = {"lateral_displacement": Q(PLACES, "m"), "yaw": "5 mrad", "roll": "0.3 mrad"}
    found = pair.geometry(**given).dataset
    for side, one in alike.items():
        expected = one.geometry(**given).dataset
        for name in ("y", "z", "wheel_position", "rail_position", "rolling_radius", "wheel_curvature"):
            assert np.array_equal(found[name].sel(side=side), expected[name].sel(side=side), equal_nan=True), name


@pytest.mark.parametrize("compiled", [False, True])
def test_swapped_profiles_are_the_mirrored_position(compiled: bool) -> None:
    wl.accelerate(compiled)
    one = geometry(wheelset(wheel=NEW, left_wheel=WORN, rail=RAIL, left_rail=GROUND), PLACES, 5e-3)
    other = geometry(wheelset(wheel=WORN, left_wheel=NEW, rail=GROUND, left_rail=RAIL), -PLACES, -5e-3)
    swapped = other.assign_coords(side=["right", "left"]).sel(side=["left", "right"])
    for name in ("y", "contact_angle", "roll"):
        swapped[name] = swapped[name].copy(data=-swapped[name].values)
    assert_same(one, swapped)
    assert np.abs(one["roll"].values).max() > 0.1  # the pair is not symmetric


@pytest.mark.parametrize("patch", ["strips", "ellipse"])
def test_at_a_given_roll_and_speed_loads_are_those_of_a_wheelset_with_its_profiles(patch: Any) -> None:
    chain = wl.contact_model("linear") if patch == "ellipse" else wl.contact_model("strip_theory")
    given = {"lateral_displacement": "2 mm", "yaw": "1 mrad", "roll": "0.1 mrad", "angular_speed": "4.35 rad/s"}
    pairs = {"both": {"wheel": NEW, "left_wheel": WORN}, "left": {"wheel": WORN}, "right": {"wheel": NEW}}
    found = {
        name: (wheelset(patch=patch, **profiles) | chain)(**given, **CONDITIONS) for name, profiles in pairs.items()
    }
    for side in ("left", "right"):
        one, other = found["both"].sel(side=side), found[side].sel(side=side)
        for name in ("normal_force", "max_pressure", "tangential_force", "wear_index"):
            # Loads balance to 1e-7 of the load, which the creep forces follow up to tens of times.
            assert one[name].magnitude == pytest.approx(other[name].magnitude, rel=1e-5, nan_ok=True), (name, side)


@pytest.mark.parametrize("patch", ["strips", "ellipse"])
def test_loads_of_swapped_profiles_are_the_mirrored_ones(patch: Any) -> None:
    chain = wl.contact_model("linear") if patch == "ellipse" else wl.contact_model("strip_theory")
    found = []
    for sign, profiles in ((1.0, {"wheel": NEW, "left_wheel": WORN}), (-1.0, {"wheel": WORN, "left_wheel": NEW})):
        pair = wheelset(patch=patch, rail=RAIL, **profiles)
        places = Q(sign * PLACES[[1, 4]], "m")
        found.append((pair | chain)(lateral_displacement=places, yaw=Q(sign, "mrad"), **CONDITIONS))
    one, other = found
    for name in ("normal_force", "max_pressure", "tangential_force", "wear_index"):
        value, mirrored = (each[name].to_base_units().magnitude for each in (one, other))
        assert mirrored[:, ::-1] == pytest.approx(value, rel=1e-5, nan_ok=True), name
