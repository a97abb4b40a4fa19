"""The rig of a wheel on a rail, and the contact problem that its conditions pose."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest

import wearlaw as wl
from tests.strategies import EPS
from wearlaw import Q
from wearlaw.errors import CompositionError

GIVEN: dict[str, Any] = {
    "wheel_radius": Q(460, "mm"),
    "rail_head_radius": Q(300, "mm"),
    "wheel_profile_radius": Q(np.inf, "mm"),
    "material": wl.steel(),
    "rolling_speed": Q(30, "m/s"),
}
CONDITIONS: dict[str, Any] = {
    "normal_force": Q(80, "kN"),
    "friction_coefficient": 0.3,
    "longitudinal_creepage": Q(0.2, "%"),
}


def rig(**changes: Any) -> wl.WheelRail:
    return wl.WheelRail(**{**GIVEN, **changes})


def test_equal_curvatures_make_a_circle_of_the_closed_form() -> None:
    # a³ = 3 N R / (4 E*) for spheres of relative radius R (Johnson, Contact Mechanics, 1985, eq. 4.22).
    steel = wl.steel()
    found = rig(rail_head_radius=Q(460, "mm")).problem(**CONDITIONS)
    modulus = 0.5 * steel.youngs_modulus.to("Pa").magnitude / (1.0 - steel.poisson_ratio**2)
    radius = np.cbrt(0.75 * 8e4 * 0.46 / modulus)
    assert found.a == pytest.approx(radius, rel=1e-12)
    assert found.b == pytest.approx(radius, rel=1e-12)
    assert found.shear_modulus == pytest.approx(206.47742e9 / 2.56, rel=4 * EPS)
    assert found.poisson_ratio == 0.28
    assert found.rolling_speed == 30.0
    assert found.density == 7850.0


def test_the_longer_axis_lies_where_the_bodies_are_flatter() -> None:
    assert rig(rail_head_radius=Q(80, "mm")).problem(**CONDITIONS).a > rig().problem(**CONDITIONS).b
    wide = rig(rail_head_radius=Q(300, "mm"), wheel_profile_radius=Q(-330, "mm")).problem(**CONDITIONS)
    assert wide.b > wide.a


def test_the_load_may_be_given_by_its_maximum_pressure() -> None:
    loads = Q([20.0, 80.0, 200.0], "kN")
    by_force = rig().problem(**{**CONDITIONS, "normal_force": loads})
    by_pressure = rig().problem(
        max_pressure=Q(by_force.max_pressure, "Pa"), friction_coefficient=0.3, longitudinal_creepage=Q(0.2, "%")
    )
    # The cube multiplies the rounding of the pressure by three.
    assert by_pressure.normal_force == pytest.approx(by_force.normal_force, rel=32 * EPS)
    assert by_pressure.a == pytest.approx(by_force.a, rel=32 * EPS)


WRONG_RIGS: list[tuple[dict[str, Any], str]] = [
    ({"wheel_radius": Q(np.inf, "mm")}, "wheel_radius: must be finite"),
    ({"rail_head_radius": Q(np.inf, "mm")}, "the bodies touch in a point only if the sum is positive"),
    ({"wheel_profile_radius": Q(-300, "mm")}, "sum to 0 1/m across the rail"),
    ({"wheel_profile_radius": Q(-250, "mm")}, "a hollow must have a larger radius than the body inside it"),
    ({"rail_head_radius": Q(0, "mm")}, "a radius must not be zero"),
    ({"wheel_profile_radius": "1e-310 mm"}, "a radius must not be zero or next to it"),
    ({"rail_head_radius": 300}, "rail_head_radius: got the bare number 300, which has no unit"),
    ({"rolling_speed": Q(0, "m/s")}, "rolling_speed: must be greater than zero"),
]


@pytest.mark.parametrize(("changes", "message"), WRONG_RIGS)
def test_bodies_that_do_not_touch_in_a_point_are_refused(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(wl.ConfigurationError, match=re.escape(message)):
        rig(**changes)


WRONG_CONDITIONS: list[tuple[dict[str, Any], str]] = [
    ({"spin": Q(0.3, "1/s")}, "spin: got 0.3000 1/s, which does not have the dimension of '1/m'"),
    ({"longitudinal_creepage": Q(1.1, "")}, "longitudinal_creepage: must not exceed 1 in magnitude"),
    ({"longitudinal_creepage": None}, "longitudinal_creepage: is missing; give longitudinal_creepage=Q(0.2"),
    (
        {"creepage": Q(1, "%")},
        "creepage: unknown condition; did you mean 'longitudinal_creepage'? The conditions are: normal_force, ",
    ),
    (
        {"rolling_speed": Q(20, "m/s")},
        "rolling_speed: is a field of rig 'wheel_rail', with one value for all operating points; give it to the rig.",
    ),
    (
        {"max_pressure": Q(1, "GPa")},
        "give exactly one of normal_force, max_pressure; got normal_force and max_pressure",
    ),
    ({"normal_force": None, "max_pressure": Q(1e200, "Pa")}, "check the units of the load and of the rig"),
    ({"friction_coefficient": 1e-13}, "friction_coefficient: must be at least 1e-12"),
]


@pytest.mark.parametrize(("changes", "message"), WRONG_CONDITIONS)
@pytest.mark.filterwarnings("ignore::wearlaw.UnusualWarning")  # loads that overflow
def test_wrong_conditions_are_named(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(wl.InputError, match=re.escape(message)):
        rig().problem(**{**CONDITIONS, **changes})


def test_a_line_model_given_an_ellipse_says_so() -> None:
    with pytest.raises(CompositionError, match="contact model 'exact' does not solve elliptic contacts, only line"):
        wl.contact_model("exact").solve(rig().problem(**CONDITIONS))


def test_an_elliptic_model_given_a_line_says_so() -> None:
    line = wl.TwinDisc.suros().problem(max_pressure="1500 MPa", creepage="1 %", friction_coefficient=0.3)
    with pytest.raises(CompositionError, match="contact model 'polach' does not solve line contacts, only elliptic"):
        wl.contact_model("polach").solve(line)
