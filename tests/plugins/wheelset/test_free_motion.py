"""Free motion against the closed form of cones, an integration along the track, and creepages without and with load."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
import pytest
import scipy

import wearlaw as wl
from tests.plugins.wheelset.wheelsets import R0, cone, middle_of_head, on_round_heads, wheelset
from wearlaw import Array, Q

SPEED = 20.0


def columns(table: pd.DataFrame) -> tuple[Array, ...]:
    """Return displacement, yaw and their derivatives over the distance, and shares, in SI."""
    y, yaw, velocity, rate, share = table.to_numpy().T
    return 1e-3 * y, 1e-3 * yaw, velocity / SPEED, rate / SPEED, share


def geometry(rig: wl.Wheelset, y: Array) -> tuple[Array, Array]:
    """Return the radii of rigid wheels, and the distances of their points from the middle of the axle [m]."""
    found = rig.geometry(lateral_displacement=Q(1e3 * y, "mm")).dataset.isel(patch=0)
    return 1e-3 * found["rolling_radius"].values, np.abs(1e-3 * found["y"].values - y[:, None])


@pytest.mark.parametrize("conicity", [0.025, 0.05, 0.1])
def test_cones_move_in_klingels_sines(conicity: float) -> None:
    """With points of contact 2 b apart on heads of radius R, λ = γ (b + R γ)/(b - r γ) (Wickens), and k² = λ/(b r).

    The formula is of first order in the angles: their squares, γ² and (y/b)², are left.
    """
    radius, amplitude = 0.3, 3e-3
    rig = on_round_heads(cone(conicity), radius, rolling_speed=Q(SPEED, "m/s"))
    base = middle_of_head(radius) - radius * conicity
    rolling = R0 + conicity * (0.75 - base)
    y, yaw, velocity, rate, share = columns(wl.free_motion(rig, amplitudes="3 mm", shares=[1.0], phases=12))
    effective = conicity * (base + radius * conicity) / (base - rolling * conicity)
    k = np.sqrt(effective / (base * rolling))
    theta = 2.0 * np.pi * (np.arange(12) + 0.5) / 12
    error = 2.0 * conicity**2
    assert y == pytest.approx(amplitude * np.sin(theta), abs=1e-9)
    assert yaw == pytest.approx(amplitude * k * np.cos(theta), rel=error)
    assert rate == pytest.approx(-amplitude * k**2 * np.sin(theta), rel=2.0 * error)
    assert velocity == pytest.approx(yaw, rel=1e-12)
    assert share == pytest.approx(1.0 / 12, rel=error)


@pytest.mark.parametrize("amplitude", [1.0, 3.0, 5.5])
def test_states_follow_the_motion_along_the_track(amplitude: float) -> None:
    """The wheelset starts at the turning point, and moves as both wheels roll without slip."""
    rig = wheelset(rolling_speed=Q(SPEED, "m/s"))
    places = np.linspace(-6e-3, 6e-3, 2401)
    radius, lever = geometry(rig, places)
    turning = (radius[:, 1] - radius[:, 0]) / (radius[:, 1] * lever[:, 0] + radius[:, 0] * lever[:, 1])

    def motion(_: float, state: Array) -> list[float]:
        return [float(state[1]), -float(np.interp(state[0], places, turning))]

    start = [1e-3 * amplitude, 0.0]
    found = scipy.integrate.solve_ivp(motion, (0.0, 30.0), start, "LSODA", rtol=1e-9, atol=1e-13, max_step=2e-3)
    y, yaw, _, rate, share = columns(wl.free_motion(rig, amplitudes=Q(amplitude, "mm"), shares=[1.0], phases=16))
    # Tables of 0.015 mm, in which jumps of Δr are not placed any better.
    first = found.y[1] <= 0.0
    first &= np.logical_and.accumulate(first)
    falls = np.interp(y[yaw < 0.0], found.y[0][first][::-1], found.y[1][first][::-1])
    assert yaw[yaw < 0.0] == pytest.approx(falls, rel=5e-3)
    assert rate == pytest.approx(-np.interp(y, places, turning), rel=2e-2)
    # Sorted by phase, from one turning point to the other: the distance between the middles of its phases.
    half = np.argsort(-y[yaw < 0.0])
    along = np.interp(-y[yaw < 0.0][half], -found.y[0][first], found.t[first])
    parts = share[yaw < 0.0][half]
    between = 0.5 * (parts[1:] + parts[:-1])
    assert np.diff(along) / np.diff(along).sum() == pytest.approx(between / between.sum(), rel=5e-2)


def test_both_rigid_wheels_roll_without_creeping() -> None:
    """Ω r/V = 1 ∓ ψ' b on both sides, with one speed of rotation: their ratio is that of the radii."""
    rig = wheelset(rolling_speed=Q(SPEED, "m/s"))
    y, _, _, rate, _ = columns(wl.free_motion(rig, amplitudes=Q([2, 4], "mm"), shares=[0.5, 0.5]))
    radius, lever = geometry(rig, y)
    held = radius[:, 1] / radius[:, 0] - 1.0
    left = radius[:, 1] / radius[:, 0] - (1.0 - rate * lever[:, 1]) / (1.0 + rate * lever[:, 0])
    # Between displacements 0.015 mm apart the difference is interpolated; S1002 bends most beside its jump at 0.
    assert np.abs(left).max() < 1e-3 * np.abs(held).max()


def creepage(rig: wl.Wheelset, table: pd.DataFrame) -> float:
    """Return the root mean square of the creepage of patches, weighted by force and share, under 60 kN."""
    states: dict[str, Any] = {
        name: Q(values.to_numpy(), unit.removesuffix("]"))
        for (name, unit), values in ((str(head).split(" ["), table[head]) for head in table if head != "share")
    }
    predict = rig | wl.contact_model("strip_theory")
    problem = predict(vertical_load="60 kN", friction_coefficient=0.3, **states).problem
    force = np.nan_to_num(problem.normal_force)
    square = np.nan_to_num(problem.longitudinal_creepage**2 + problem.lateral_creepage**2)
    mean = (force * square).sum(axis=(-2, -1)) / force.sum(axis=(-2, -1))
    return float(np.sqrt(table["share"] @ mean))


@pytest.mark.parametrize(
    ("amplitudes", "load", "most"), [((2.5, 3.5, 4.5), None, 0.3), ((0.5, 1.0, 2.0, 4.5), "60 kN", 0.1)]
)
def test_creepages_under_load_are_small_beside_those_of_held_wheelsets(
    amplitudes: tuple[float, ...], load: str | None, most: float
) -> None:
    """Rigid wheels jump by Δr = 0.5 mm at the middle of the track, loaded ones do not."""
    rig = wheelset(rolling_speed=Q(SPEED, "m/s"))
    shares = np.full(len(amplitudes), 1.0 / len(amplitudes))
    free = wl.free_motion(rig, amplitudes=Q(amplitudes, "mm"), shares=shares, vertical_load=load)
    ratio = creepage(rig, free) / creepage(rig, free[["lateral_displacement [mm]", "share"]])
    print(f"creepage of free over held states, Δr under {load}: {ratio:.3f}")
    assert ratio < most


def test_wheels_of_unequal_radii_move_about_where_they_are_equal() -> None:
    equal = on_round_heads(cone(0.05), 0.3)
    pair = on_round_heads(cone(0.05), 0.3, left_wheel=cone(0.05).shifted(z="0.1 mm"))
    table, other = (wl.free_motion(rig, amplitudes="2 mm", shares=[1.0]) for rig in (equal, pair))
    middle = other["lateral_displacement [mm]"].mean()
    assert middle == pytest.approx(1.0, rel=0.06)  # 0.1 mm/(2 λ): 1/λ is up to 5 % below 1/γ, as above
    shifted = other["lateral_displacement [mm]"] - middle
    assert shifted.to_numpy() == pytest.approx(table["lateral_displacement [mm]"].to_numpy(), abs=1e-3)


@pytest.mark.parametrize(
    ("options", "named"),
    [
        ({"amplitudes": "8 mm"}, r"amplitudes: 8 mm is beyond the clearance of 6\.\d+ mm: flanges touch at"),
        ({"amplitudes": "3 mm", "shares": [0.5, 0.5]}, "shares: give one for each amplitude"),
        ({"amplitudes": "3 mm", "phases": 1}, "phases"),
    ],
)
def test_mistakes_name_the_argument(options: dict[str, Any], named: str) -> None:
    with pytest.raises(wl.InputError, match=named):
        wl.free_motion(wheelset(), **{"shares": [1.0], **options})


def test_cylinders_are_not_steered() -> None:
    with pytest.raises(wl.InputError, match="does not steer"):
        wl.free_motion(on_round_heads(cone(0.0), 0.3), amplitudes="3 mm", shares=[1.0])
    with pytest.raises(wl.InputError, match="wheelset"):
        wl.free_motion("s1002", amplitudes="3 mm", shares=[1.0])
