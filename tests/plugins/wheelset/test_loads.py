"""Loads of a wheelset: the balance of normal and creep forces, torque, friction by patch, and several patches."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import wearlaw as wl
from tests.plugins.wheelset.wheelsets import borne, cone, on_round_heads, wheelset
from wearlaw import Array, Q
from wearlaw_models.rigs.wheelset.stand import BALANCED  # private: the accuracy that a search ends at

FASTSIM = wl.contact_model("fastsim")
PAIR = wheelset(rolling_speed="20 m/s")


def predicted(pair: wl.Wheelset, **conditions: Any) -> wl.Prediction:
    """Return the prediction of FASTSIM, without warnings of climbing."""
    given_: dict[str, Any] = {"vertical_load": "60 kN", "friction_coefficient": 0.3}
    predict: Any = pair | FASTSIM
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", wl.RangeWarning)
        result: wl.Prediction = predict(**given_ | conditions)
    return result


def newtons(quantity: Any, unit: str = "N") -> Array:
    """Return forces, zero where there is no patch."""
    return np.asarray(np.nan_to_num(np.asarray(quantity.to(unit).magnitude)))


def carried(result: wl.Prediction) -> Array:
    """Return the vertical load of each wheel [N]."""
    load, _ = borne(result.problem, newtons(result.lateral_force))
    return load.reshape(result.problem.exists.shape[:-1])  # type: ignore[union-attr]


def powers(result: wl.Prediction, speed: float) -> tuple[Array, Array]:
    """Return the dissipated power, and the work of the track on the wheelset at V with its sign reversed [W]."""
    dissipated = speed * newtons(result.wear_index).sum(axis=(-2, -1))
    return dissipated, speed * newtons(result.longitudinal_force).sum(axis=(-2, -1))


def rotation(result: wl.Prediction, speed: float = 20.0) -> Array:
    """Return Ω from the longitudinal creepage of the first patches, without yaw and roll of note [rad/s]."""
    radius = np.asarray(result.problem.bodies["wheel"].rolling_radius)[..., 0]
    return np.asarray(speed * (1.0 - result.problem.longitudinal_creepage[..., 0]) / radius)


conditions = st.fixed_dictionaries(
    {
        "displacement": st.floats(-6.2e-3, 6.2e-3),
        "yaw": st.floats(-20e-3, 20e-3),
        "load": st.floats(5e3, 120e3),
        "friction": st.floats(0.05, 0.6),
        "share": st.floats(-0.6, 0.6),
        "curvature": st.floats(-1.0 / 150.0, 1.0 / 150.0),
    }
)


def at_random(drawn: dict[str, float]) -> tuple[wl.Prediction, float]:
    """Return the prediction of drawn conditions, and the torque [N m]."""
    load, friction, turn = drawn["load"], drawn["friction"], drawn.get("curvature", 0.0)
    torque = drawn["share"] * friction * 2.0 * load * 0.46
    result = predicted(
        PAIR,
        lateral_displacement=Q(drawn["displacement"], "m"),
        yaw=Q(drawn["yaw"], "rad"),
        vertical_load=Q(load, "N"),
        friction_coefficient=friction,
        axle_torque=Q(torque, "N*m"),
        curve_radius=Q(1.0 / turn if turn else np.inf, "m"),
    )
    return result, torque


@pytest.mark.validates(
    "wheelset",
    "Each wheel carries its load with the normal and the lateral forces of all its patches",
    source="equilibrium, at random conditions",
    held_to="{share:g} of the load, or `imbalance` where creep forces jump",
    share=1e-6,
)
@given(drawn=conditions)
def test_each_wheel_carries_its_load(drawn: dict[str, float], share: float) -> None:
    load, friction, turn = drawn["load"], drawn["friction"], drawn.get("curvature", 0.0)
    result, torque = at_random(drawn)
    # Where FASTSIM's forces jump, no penetration carries the load; `imbalance` is the greatest share of the load and
    # of the torque of full slip that is left over.
    problem: Any = result.problem
    left = float(np.nanmax(problem.imbalance))
    assert np.abs(carried(result) / load - 1.0).max() <= max(share, left)
    # M Ω + V ∑ Fx = V ∑ (ξ Fx + η Fy + φ Mz), but for the curve: there V (ξ - 1) and the like have parts in V/R.
    place = np.asarray(problem.bodies["wheel"].rolling_radius)
    assert (np.asarray(problem.exists).sum(axis=-1) >= 1).all()
    assert np.isfinite(place[np.asarray(problem.exists)]).all()
    if not turn:
        dissipated, pulled = powers(result, 20.0)
        bound = 2.0 * max(BALANCED, left) * friction * 2.0 * load * 20.0
        assert torque * rotation(result).mean() + pulled == pytest.approx(dissipated, rel=0.01, abs=bound)
    force = np.hypot(newtons(result.longitudinal_force), newtons(result.lateral_force))
    assert (force <= (1.0 + 1e-9) * friction * newtons(result.normal_force)).all()


CONES = on_round_heads(cone(0.05), 0.3, patch="ellipse", rolling_speed="20 m/s")


def test_driving_and_braking_have_opposite_creepages() -> None:
    result = predicted(CONES, lateral_displacement="0 mm", axle_torque=Q([5.0, 0.0, -5.0], "kN*m"))
    driving, _, braking = result.problem.longitudinal_creepage[..., 0]
    assert (driving < 0.0).all()
    assert (braking > 0.0).all()
    # Small creepages are linear; the spin is the same in both, and what is left of second order is 1 % of 0.1 %.
    assert driving == pytest.approx(-braking, rel=1e-2)
    # The torque is that of the longitudinal forces on the radius of the cones at the contact point.
    radius = np.asarray(result.problem.bodies["wheel"].rolling_radius)[0, :, 0]
    forces = newtons(result.longitudinal_force)[..., 0]
    assert -(forces[0] * radius).sum() == pytest.approx(5e3, rel=1e-3)


def test_a_given_speed_of_rotation_is_kept() -> None:
    radius = 1e-3 * CONES.geometry(lateral_displacement="1 mm").dataset.rolling_radius.sel(patch=1).values
    speed = 20.0 / radius.mean()
    result = predicted(CONES, lateral_displacement="1 mm", angular_speed=Q([1.001 * speed, 0.999 * speed], "rad/s"))
    assert rotation(result)[:, 0] == pytest.approx([1.001 * speed, 0.999 * speed], rel=2.0 * BALANCED)
    torque = -newtons(result.longitudinal_force).sum(axis=(-2, -1))
    assert torque[0] > 0.0 > torque[1]
    # The torque that such a speed takes gives that speed back.
    again = predicted(CONES, lateral_displacement="1 mm", axle_torque=Q(moment_about_axle(result)[0], "N*m"))
    assert rotation(again).mean() == pytest.approx(1.001 * speed, rel=2.0 * BALANCED)


def moment_about_axle(result: wl.Prediction) -> Array:
    """Return the torque that the creep forces ask of an axle, by power: M Ω + V ∑ Fx is dissipated [N m]."""
    dissipated, pulled = powers(result, 20.0)
    return np.asarray((dissipated - pulled) / rotation(result)[..., 0])


def test_a_torque_beyond_friction_is_an_error() -> None:
    # 0.3 of 120 kN on 0.46 m.
    with pytest.raises(wl.ConditionsError, match=r"axle_torque: 1\.7e\+04 N\*m is more than friction can transmit"):
        predicted(CONES, lateral_displacement="0 mm", axle_torque="17 kN*m")
    predicted(CONES, lateral_displacement="0 mm", axle_torque="16 kN*m")


# ---------------------------------------------------------------------------------------------------- several patches


def test_friction_falls_with_the_creep_speed_of_each_patch() -> None:
    tread = wl.FallingFriction(static_coefficient=0.5, limit_ratio=0.4, decay="2 s/m")
    flange = wl.FallingFriction(static_coefficient=0.2, limit_ratio=0.5, decay="4 s/m")
    found = predicted(
        PAIR,
        lateral_displacement=Q([3.0, 6.9], "mm"),
        yaw="10 mrad",
        friction_coefficient=tread,
        flange_friction_coefficient=flange,
    )
    problem = found.problem
    assert problem.contact_angle is not None
    there = np.isfinite(problem.longitudinal_creepage)
    steep = np.abs(problem.contact_angle[there]) > np.radians(30.0)
    assert 0 < steep.sum() < steep.size
    speed = 20.0 * np.hypot(problem.longitudinal_creepage[there], problem.lateral_creepage[there])
    due = np.where(
        steep, 0.2 * (0.5 * np.exp(-4.0 * speed) + 0.5), 0.5 * (0.6 * np.exp(-2.0 * speed) + 0.4)
    )  # Polach (2005), eq. (9)
    assert (due < np.where(steep, 0.2, 0.5) - 0.01).all()
    np.testing.assert_allclose(problem.friction_coefficient[there], due, rtol=8 * np.finfo(float).eps)
    np.testing.assert_allclose(carried(found), 60e3, rtol=1e-6)  # as with one coefficient


def test_patches_that_lift_off_do_not_exist() -> None:
    # At 4.8 mm the gap of the second place of the right wheel is 9 µm: more than the penetration of 0.5 kN.
    light, heavy = (predicted(PAIR, lateral_displacement="4.8 mm", vertical_load=load) for load in ("0.5 kN", "15 kN"))
    assert np.asarray(light.problem.exists)[1].tolist() == [True, False, False]
    assert np.asarray(heavy.problem.exists)[1, :2].tolist() == [True, True]
    for field in ("normal_force", "contact_angle", "longitudinal_creepage", "spin"):
        values = np.asarray(getattr(light.problem, field))
        assert np.isnan(values[1, 1:]).all()
        assert np.isfinite(values[1, 0])
    for result, load in ((light, 0.5e3), (heavy, 15e3)):
        assert carried(result) == pytest.approx(np.full(2, load), rel=2.0 * BALANCED)


def test_loads_are_continuous_as_a_patch_touches() -> None:
    load = np.linspace(0.5e3, 15e3, 30)
    result = predicted(PAIR, lateral_displacement="4.8 mm", vertical_load=Q(load, "N"))
    exists = np.asarray(result.problem.exists)[:, 1, 1]
    assert not exists[0]
    assert exists[-1]
    first = int(np.argmax(exists))
    second = newtons(result.normal_force)[:, 1, 1]
    # It begins at zero and grows less than the step of 0.5 kN puts on the wheel.
    assert second[first] < 0.5e3
    assert (np.diff(second) >= 0.0).all()
    assert carried(result) == pytest.approx(np.stack([load, load], axis=-1), rel=2.0 * BALANCED)


def test_loads_are_balanced_as_humps_join_patches() -> None:
    displacement = Q(np.arange(0.0, 10.1, 0.25), "mm")
    result = predicted(PAIR, lateral_displacement=displacement, vertical_load="10 kN")
    assert carried(result) == pytest.approx(np.full((41, 2), 10e3), rel=2.0 * BALANCED)


# ---------------------------------------------------------------------------------------------------------- end to end


@pytest.mark.validates(
    "wheelset",
    "Wear of cones on round rail heads: that of `WheelRail` with the same radii, creepages and load",
    source="the rig of a single contact",
    held_to="{share:g}",
    share=0.03,
)
@pytest.mark.filterwarnings("ignore::wearlaw.CalibrationWarning")
def test_cones_wear_like_single_wheels(share: float) -> None:
    law = wl.wear_law("usfd")
    result = (CONES | FASTSIM | law)(
        lateral_displacement="2 mm", yaw="3 mrad", vertical_load="60 kN", friction_coefficient=0.3,
        axle_torque="3 kN*m",
    )  # fmt: skip
    # The grid of the pressure is off by 1 % of the maximum and 3 % of the area.
    problem: Any = result.problem
    roll = Q(problem.roll[0, 0], "rad")
    one = CONES.geometry(lateral_displacement="2 mm", yaw="3 mrad", roll=roll).dataset.sel(patch=1)
    for number, side in enumerate(("left", "right")):
        cosine = np.cos(np.radians(one.contact_angle.sel(side=side).item()))
        wheel, rail = cosine / one.rolling_radius.sel(side=side).item(), 1.0 / 300.0
        # Cylinders that cross at less than a right angle, by θ: K. L. Johnson, Contact Mechanics (1985), eqs. 4.4, 4.5.
        double = 2.0 * np.arctan(np.tan(3e-3) / cosine)
        apart = np.sqrt(wheel**2 + rail**2 - 2.0 * wheel * rail * np.cos(double))
        along, across = (0.5 * (wheel + rail + sign * apart) for sign in (-1.0, 1.0))
        single = wl.WheelRail(
            wheel_radius=Q(1.0 / along, "mm"), rail_head_radius=Q(1.0 / across, "mm"), material=wl.steel(),
            rolling_speed="20 m/s",
        )  # fmt: skip
        expected = (single | FASTSIM | law)(
            normal_force=Q(problem.normal_force[number, 0], "N"),
            longitudinal_creepage=Q(problem.longitudinal_creepage[number, 0], ""),
            lateral_creepage=Q(problem.lateral_creepage[number, 0], ""),
            spin=Q(problem.spin[number, 0], "1/m"),
            friction_coefficient=0.3,
        )
        for name in ("wear_rate", "wear_index", "semi_axis_a", "semi_axis_b", "max_pressure", "lateral_force"):
            found = getattr(result, name).to_base_units().magnitude[number, 0]
            assert found == pytest.approx(getattr(expected, name).to_base_units().magnitude, rel=share), name


@given(displacement=st.floats(1e-3, 4.5e-3) | st.floats(5.2e-3, 6e-3), yaw=st.floats(-20e-3, 20e-3))
@settings(max_examples=4)
def test_mirrored_wheelsets_wear_alike(displacement: float, yaw: float) -> None:
    one, other = (
        predicted(
            PAIR,
            lateral_displacement=Q(sign * displacement, "m"),
            yaw=Q(sign * yaw, "rad"),
            curve_radius=Q(sign * 500.0, "m"),
            lateral_velocity=Q(sign * 0.02, "m/s"),
        )
        for sign in (1.0, -1.0)
    )
    # Positions agree to 2e-9 m of 1e-3, the loads to BALANCED; the slip begins at other places of the strips.
    for name, sign in (
        ("normal_force", 1.0), ("longitudinal_force", 1.0), ("lateral_force", -1.0), ("wear_index", 1.0),
    ):  # fmt: skip
        found, expected = newtons(getattr(other, name)), newtons(getattr(one, name))
        assert sign * found[::-1] == pytest.approx(expected, rel=1e-5, abs=1e-5 * 60e3), name
