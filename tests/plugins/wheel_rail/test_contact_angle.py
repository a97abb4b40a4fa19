"""The contact angle of a wheel on a rail: the patch, the spin with its sign, the depth and its parts."""

from __future__ import annotations

import dataclasses
import re
from typing import Any

import numpy as np
import pytest
import scipy

import wearlaw as wl
from tests.strategies import EPS
from wearlaw import Q

STEEL = wl.steel()
FLANGE: dict[str, Any] = {
    "wheel_radius": Q(460, "mm"),
    "rail_head_radius": Q(13, "mm"),
    "wheel_profile_radius": Q(-20, "mm"),
    "material": STEEL,
    "rolling_speed": Q(20, "m/s"),
}
CONDITIONS: dict[str, Any] = {
    "normal_force": Q(60, "kN"),
    "friction_coefficient": 0.3,
    "longitudinal_creepage": Q(0.2, "%"),
}
FASTSIM = wl.contact_model("fastsim")
PER_ENERGY = wl.wear_law("energy", mass_per_energy="0.001 ug/J")


def rig(**changes: Any) -> wl.WheelRail:
    return wl.WheelRail(**{**FLANGE, **changes})


def problem(contact_angle: Any = None, **changes: Any) -> wl.Problem:
    return rig().problem(**{**CONDITIONS, **changes, "contact_angle": contact_angle})


def predicted(**changes: Any) -> wl.Prediction:
    return (rig() | FASTSIM | PER_ENERGY)(**{**CONDITIONS, **changes})


def arrays(found: wl.Problem) -> dict[str, Any]:
    values = {field.name: getattr(found, field.name) for field in dataclasses.fields(found)}
    return {name: value for name, value in values.items() if hasattr(value, "dtype")}


# --- The patch -------------------------------------------------------------------------------------------------------


@pytest.mark.validates(
    "hertz",
    "The patch of a flange at {angle:g}°, 60 kN on radii of 460, -20 and 13 mm: p0 = {p0:g} MPa, a = {a:g} mm",
    source="Hertz's equations (Johnson 1985, after CONTACT) in Legendre's integrals, with R/cos δ",
    held_to="the digits given, and {within:g}, relative",
    angle=70,
    p0=1885,
    a=12.29,
    within=1e-09,
)
def test_the_patch_of_a_flange(angle: float, p0: float, a: float, within: float) -> None:
    found = problem(Q(angle, "deg"))
    assert round(1e-6 * float(found.max_pressure)) == p0
    assert round(1e3 * float(found.a), 2) == a

    along, across = 0.5 * np.cos(np.radians(angle)) / 0.46, 0.5 * (1 / 0.013 - 1 / 0.020)
    modulus = 0.5 * STEEL.youngs_modulus.to("Pa").magnitude / (1 - STEEL.poisson_ratio**2)

    def misfit(ratio: float) -> float:  # b/a, of B/A = ((a/b)² E - K)/(K - E)
        m = 1 - ratio**2
        k, e = scipy.special.ellipk(m), scipy.special.ellipe(m)
        return float((e / ratio**2 - k) / (k - e) - across / along)

    ratio = scipy.optimize.brentq(misfit, 1e-3, 0.999, xtol=1e-14)
    m = 1 - ratio**2
    # A = p0 b/(E* a² e²) (K - E) with p0 = 3N/(2πab), of which b = ratio a leaves a³
    cube = 1.5 * 60e3 / np.pi / modulus / (m * along) * (scipy.special.ellipk(m) - scipy.special.ellipe(m))
    assert float(found.a) == pytest.approx(np.cbrt(cube), rel=within)
    assert float(found.b) == pytest.approx(ratio * np.cbrt(cube), rel=within)


def test_the_distance_rolled_keeps_the_rolling_radius() -> None:
    found = predicted(contact_angle=Q(70, "deg"))
    assert found.problem.bodies["wheel"].rolling_radius == 0.46
    per_turn, per_metre = found.mass_per_cycle("wheel").to("kg"), found.mass_lost("1 m", "wheel").to("kg")
    assert per_turn.magnitude == pytest.approx(2 * np.pi * 0.46 * per_metre.magnitude, rel=8 * EPS)


def test_the_angle_of_the_rig_and_of_the_condition_are_one() -> None:
    of_rig, of_condition = rig(contact_angle="70 deg").problem(**CONDITIONS), problem("70 deg")
    for name, value in arrays(of_rig).items():
        assert value == pytest.approx(getattr(of_condition, name), rel=8 * EPS), name


def test_the_condition_replaces_the_angle_of_the_rig() -> None:
    steep = rig(contact_angle="70 deg")
    assert arrays(steep.problem(**CONDITIONS, contact_angle=Q(30, "deg"))) == arrays(problem(Q(30, "deg")))


def test_a_level_surface_has_the_same_digits_with_and_without_its_angle() -> None:
    without, with_angle = problem(), problem("0 deg")
    assert without.contact_angle is None
    assert with_angle.contact_angle == 0.0
    for name, value in arrays(without).items():
        assert value == getattr(with_angle, name), name
    assert arrays(rig(contact_angle="0 deg").problem(**CONDITIONS)) == arrays(without)


def test_an_array_of_angles_is_one_problem_for_each() -> None:
    angles, loads = np.array([[-70.0], [0.0], [3.0], [89.9]]), np.array([20.0, 60.0])
    found = problem(Q(angles, "deg"), normal_force=Q(loads, "kN"))
    assert found.batch_shape == (4, 2)
    for i, j in np.ndindex(4, 2):
        alone = problem(Q(float(angles[i, 0]), "deg"), normal_force=Q(float(loads[j]), "kN"))
        for name, value in arrays(found).items():
            # The iteration for the axis ratio may end a step earlier alone, where the last step is below rounding.
            assert value[i, j] == pytest.approx(getattr(alone, name), rel=64 * EPS), name


def test_the_load_may_be_a_maximum_pressure_at_any_angle() -> None:
    by_force = problem(Q([0.0, 40.0, 70.0], "deg"))
    given = {**CONDITIONS, "normal_force": None, "max_pressure": Q(by_force.max_pressure, "Pa")}
    by_pressure = rig().problem(**given, contact_angle=Q([0.0, 40.0, 70.0], "deg"))
    # The cube multiplies the rounding of the pressure by three.
    assert by_pressure.normal_force == pytest.approx(by_force.normal_force, rel=64 * EPS)


# --- Spin ------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("angle", [-70.0, -3.0, 0.0, 3.0, 70.0])
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_the_spin_is_the_rotation_about_the_normal(angle: float, side: float) -> None:
    # Ahead, to the left and up are the axes of space; y points to the left (side 1) or to the right (side -1).
    ahead, left, up = np.eye(3)
    delta = np.radians(angle)
    along_y = np.cos(delta) * side * left - np.sin(delta) * up  # δ > 0: the surface falls towards y
    radius, speed = 0.46, 20.0
    rotation = speed / radius * left
    assert np.cross(rotation, -radius * up) == pytest.approx(-speed * ahead)  # the wheel rolls ahead
    turning = np.cross(rotation, along_y)  # how the wheel moves a small step along y away from the contact point
    # A positive spin moves a point at y by -φy in the rolling direction.
    assert problem(Q(angle, "deg")).spin == pytest.approx(-float(turning @ ahead) / speed, rel=8 * EPS, abs=EPS)
    # It turns from the rolling direction towards y.
    assert problem(Q(angle, "deg")).spin * speed == pytest.approx(
        float(rotation @ np.cross(ahead, along_y)), rel=8 * EPS, abs=EPS
    )


@pytest.mark.validates(
    "elliptic-contact",
    "Spin of a contact angle, φ = sin δ / r: on tread and flange of the Manchester benchmark A-2.2, both wheels",
    source="CONTACT, `mbench_a22_right.ref_out` and `mbench_a22_left.ref_out` (commit d431cdb)",
    held_to="{digits:g}, relative (the digits printed)",
    digits=2e-3,
)
@pytest.mark.parametrize(
    ("delta", "roll", "omega", "speed", "spin"),
    [  # DELTCP(TR) [rad], ROLL_WS [rad], VPITCH_WS [rad/s], VELOC [mm/s], CPHI [rad/mm] of cases 1, 12 and 14
        (-0.0290, 0.0, -4.3481181, 2000.0, 6.302e-5),
        (-0.3363, -4.777e-4, -4.3318864, 2004.0, 7.122e-4),
        (-1.1591, -4.376e-3, -4.2748834, 2018.0, 1.937e-3),
        (0.0290, 0.0, -4.3481181, 2000.0, -6.302e-5),  # the left wheel
    ],
)
def test_the_spin_is_that_of_contact(
    digits: float, delta: float, roll: float, omega: float, speed: float, spin: float
) -> None:
    # y points to the right there and z downwards, so that the lower body comes first: rail minus wheel. δ is measured
    # from the track, the axle is tilted by its roll. Of the digits printed, those of δ are the fewest: 5e-5 in 0.029.
    rolling = rig(wheel_radius=Q(speed / abs(omega), "mm"), contact_angle=Q(delta - roll, "rad"))
    found = rolling.problem(**CONDITIONS).spin
    assert -1e-3 * found == pytest.approx(spin, rel=digits)


def test_a_given_spin_is_kept_even_if_it_is_zero() -> None:
    steep = rig(contact_angle="70 deg")
    assert steep.problem(**CONDITIONS, spin=Q(0, "1/m")).spin == 0.0
    assert steep.problem(**CONDITIONS, spin=Q([0, 0.3], "1/m")).spin.tolist() == [0.0, 0.3]
    assert problem(Q([10, 70], "deg"), spin=Q(0.3, "1/m")).spin.tolist() == [0.3, 0.3]


def test_the_other_wheel_is_the_mirror() -> None:
    here = predicted(contact_angle="70 deg", lateral_creepage="0.1 %")
    there = predicted(contact_angle="-70 deg", lateral_creepage="-0.1 %")
    # Some thousand steps of the march and sums over them, each rounded.
    assert there.longitudinal_force.magnitude == pytest.approx(here.longitudinal_force.magnitude, rel=1e-12)
    assert there.lateral_force.magnitude == pytest.approx(-here.lateral_force.magnitude, rel=1e-12)
    assert there.spin_moment.magnitude == pytest.approx(-here.spin_moment.magnitude, rel=1e-12)
    assert there.wear_rate.magnitude == pytest.approx(here.wear_rate.magnitude, rel=1e-12)
    right, left = here.wear_profile("wheel"), there.wear_profile("wheel")
    for name in ("depth", "depth_vertical", "depth_lateral", "sliding_distance"):
        assert left[name].values[::-1] == pytest.approx(right[name].values, rel=1e-12), name


# --- Depth -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("body", ["wheel", "rail"])
def test_depth_is_normal_and_has_a_vertical_and_a_lateral_part(body: str) -> None:
    profile = predicted(contact_angle=Q([-70.0, 0.0, 20.0], "deg")).wear_profile(body)
    delta = np.radians([[-70.0], [0.0], [20.0]])
    assert profile.depth_vertical.values == pytest.approx(profile.depth.values * np.cos(delta), rel=4 * EPS)
    assert profile.depth_lateral.values == pytest.approx(profile.depth.values * np.abs(np.sin(delta)), rel=4 * EPS)
    assert profile.depth_lateral.attrs["units"] == profile.depth.attrs["units"]
    assert profile.depth_vertical.attrs["long_name"].startswith("depth vertical per ")


def test_the_normal_depth_over_the_surface_is_the_mass_lost() -> None:
    found = predicted(contact_angle="70 deg")
    profile, contact = found.wear_profile("wheel"), found.contact
    area = (1e-9 * profile.depth.values * contact.strip_width).sum()  # of the section, y along the surface
    lost = area * 2 * np.pi * 0.46 * 7850
    assert lost == pytest.approx(found.mass_per_distance.to("kg/m").magnitude, rel=64 * EPS)


def test_a_missing_patch_has_no_parts_of_a_depth() -> None:
    two = problem(Q([70.0, 20.0], "deg")).replaced(dims={"patch": (1, 2)}, exists=np.array([True, False]))
    profile = (rig() | FASTSIM | PER_ENERGY).predict(two).wear_profile("wheel")
    alone = predicted(contact_angle="70 deg").wear_profile("wheel")
    assert profile.depth_lateral.dims[0] == "patch"
    assert profile.depth_lateral.values[0] == pytest.approx(alone.depth_lateral.values, rel=64 * EPS)
    assert np.isnan(profile.depth_vertical.values[1]).all()


def test_a_surface_without_an_angle_has_a_depth_only() -> None:
    assert set(predicted().wear_profile("rail")) == {"depth", "sliding_distance"}


# --- What is taken, and what is not ----------------------------------------------------------------------------------

WRONG: list[tuple[Any, str]] = [
    (Q(90, "deg"), "must lie between -90 and 90 deg, got 90.00 deg; give the angle of the surface to the axle"),
    ("1.6 rad", "must lie between -90 and 90 deg, got 91.67 deg"),
    (Q(np.nan, "deg"), "must be a number"),
]


@pytest.mark.parametrize(("angle", "message"), WRONG)
def test_a_wrong_angle_is_named(angle: Any, message: str) -> None:
    with pytest.raises(wl.ConfigurationError, match=re.escape(f"WheelRail: contact_angle: {message}")):
        rig(contact_angle=angle)
    with pytest.raises(wl.UnitError, match=re.escape(f"contact_angle: {message}")):
        problem(angle)
