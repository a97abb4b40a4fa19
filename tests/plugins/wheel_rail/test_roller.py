"""A roller in place of the rail: the gap, the spin and the wear of two surfaces of revolution."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import scipy

import wearlaw as wl
from tests.strategies import EPS
from wearlaw import Q

WHEEL, ROLLER, HEAD = 0.46, 0.7, 0.3
FIELDS: dict[str, Any] = {
    "wheel_radius": Q(WHEEL, "m"),
    "rail_head_radius": Q(HEAD, "m"),
    "material": wl.steel(),
    "rolling_speed": "20 m/s",
}
CONDITIONS: dict[str, Any] = {"normal_force": "60 kN", "friction_coefficient": 0.3, "longitudinal_creepage": "0.2 %"}


def rig(**changes: Any) -> wl.WheelRail:
    return wl.WheelRail(**{**FIELDS, "roller_radius": Q(ROLLER, "m"), **changes})


def distance(radius: float, profile: float, angle: float, x: float, sense: float) -> float:
    """Return how far a surface of revolution is from the tangential plane at a step x ahead, upwards along the normal.

    Its axis lies along y, above (sense 1) or below (-1) the contact point. Its profile touches the plane of the contact
    angle there: a cone if its radius is infinite, or else the arc of a convex body below.
    """

    def outside(along: float) -> float:
        y, z = along * np.sin(angle), along * np.cos(angle)
        on_profile = -np.tan(angle) * y
        if np.isfinite(profile):
            on_profile = np.sqrt(profile**2 - (y + profile * np.sin(angle)) ** 2) - profile * np.cos(angle)
        return float(np.hypot(x, z - sense * radius) - (radius - sense * on_profile))

    return float(scipy.optimize.brentq(outside, -1e-2, 1e-2, xtol=1e-16))


@pytest.mark.validates(
    "hertz",
    "A wheel on a roller at contact angles up to {angle:g}°: curvature of the gap in the rolling direction",
    source="the distance of both surfaces of revolution from their tangential plane, found by roots",
    held_to="{within:g}, relative",
    angle=60,
    within=1e-5,
)
@pytest.mark.parametrize("degrees", [0.0, 5.0, -30.0, 60.0])
def test_the_gap_is_that_of_two_surfaces_of_revolution(degrees: float, angle: float, within: float) -> None:
    assert abs(degrees) <= angle
    delta, x = np.radians(degrees), 1e-3
    gap = distance(WHEEL, np.inf, delta, x, 1.0) - distance(ROLLER, HEAD, delta, x, -1.0)
    # The gap is an even series in x: its next part is some x²/R² of the first, 5e-6 for the sharpest 0.46 m.
    along = wl.Quantity(0.5 * x**2 / gap, "m")
    same = wl.WheelRail(**{**FIELDS, "wheel_radius": along * np.cos(delta)}, contact_angle=Q(degrees, "deg"))
    found = rig(contact_angle=Q(degrees, "deg")).problem(**CONDITIONS)
    for name in ("a", "b", "max_pressure"):
        assert getattr(found, name) == pytest.approx(getattr(same.problem(**CONDITIONS), name), rel=within), name


@pytest.mark.parametrize("degrees", [-60.0, 0.0, 3.0])
def test_the_spin_is_the_difference_of_both_rotations_about_the_normal(degrees: float) -> None:
    ahead, left, up = np.eye(3)
    delta, speed = np.radians(degrees), 20.0
    wheel, roller = speed / WHEEL * left, -speed / ROLLER * left
    for rotation, axis in ((wheel, WHEEL * up), (roller, -ROLLER * up)):  # both surfaces run back at V
        assert np.cross(rotation, -axis) == pytest.approx(-speed * ahead)
    normal = np.cross(ahead, np.cos(delta) * left - np.sin(delta) * up)
    found = rig().problem(**CONDITIONS, contact_angle=Q(degrees, "deg")).spin
    assert found * speed == pytest.approx(float((wheel - roller) @ normal), rel=8 * EPS, abs=EPS)


def test_a_roller_wears_as_a_wheel_does() -> None:
    """Of like materials, as much is lost from both; it is spread over circumferences of 2πr and 2πR."""
    predicted = (rig() | wl.contact_model("fastsim") | wl.wear_law("energy", mass_per_energy="0.001 ug/J"))(
        **CONDITIONS
    )
    wheel, roller = (predicted.wear_profile(body).depth for body in ("wheel", "rail"))
    assert roller.units == wheel.units == "um/km"
    assert roller.values == pytest.approx(wheel.values * WHEEL / ROLLER, rel=1e-12)
    assert rig(roller_radius=None) == wl.WheelRail(**FIELDS)
