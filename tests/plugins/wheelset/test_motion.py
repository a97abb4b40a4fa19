"""Creepages, spin and torque against the motion of material points of wheelsets and against equilibrium in space."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import wearlaw as wl
from tests.plugins.wheelset.wheelsets import R0, cone, on_round_heads, wheelset
from wearlaw import Array, Q
from wearlaw_models.rigs.wheelset.stand import BALANCED  # private: the accuracy that a search ends at

pytestmark = pytest.mark.filterwarnings("ignore::wearlaw.UnusualWarning")  # loads so small that nothing gives way

STENCIL = {1: 4.0 / 5.0, 2: -1.0 / 5.0, 3: 4.0 / 105.0, 4: -1.0 / 280.0}
"""Weights of differences between values in steps ahead and back, for a derivative of eighth order."""

SPEED = 20.0
"""V [m/s]."""

STANDARD = wheelset(rolling_speed=Q(SPEED, "m/s"))
CONES = on_round_heads(cone(0.1), 0.2, rolling_speed=Q(SPEED, "m/s"))
ROLLERS = wheelset(rolling_speed=Q(SPEED, "m/s"), roller_radius="350 mm")


class State(NamedTuple):
    """A wheelset at the time zero, in SI; the velocities are those of the displacement and the yaw."""

    displacement: float
    yaw: float
    rotation: float
    lateral_velocity: float = 0.0
    yaw_velocity: float = 0.0
    curve_radius: float = np.inf


def derivative(of: Callable[[float], Array], step: float = 1e-4) -> Array:
    """Return the derivative at time zero."""
    parts = [weight * (of(k * step) - of(-k * step)) / step for k, weight in STENCIL.items()]
    return np.asarray(np.sum(parts, axis=0))


@functools.cache
def stands(pair: wl.Wheelset, displacement: float, yaw: float) -> tuple[float, float]:
    """Return the roll and the height of the middle at which both wheels touch, in SI."""
    found = pair.geometry(lateral_displacement=Q(displacement, "m"), yaw=Q(yaw, "rad")).dataset
    return 1e-3 * found["roll"].item(), 1e-3 * found["vertical_displacement"].item() - R0


def moved(pair: wl.Wheelset, state: State) -> Callable[[float], tuple[Rotation, Array]]:
    """Return the orientation and the place of the wheelset in space over time; at time zero they are in the track.

    The middle of the wheelset runs along a circle, and it rolls and moves vertically so that both wheels touch.
    """
    u, psi = state.displacement, state.yaw
    sideways, turning = state.lateral_velocity, state.yaw_velocity

    def position(time: float) -> tuple[Rotation, Array]:
        roll, height = stands(pair, u + sideways * time, psi + turning * time)
        turn = 0.5 * SPEED * time / state.curve_radius
        chord = SPEED * time * np.sinc(turn / np.pi)
        own = Rotation.from_euler("yxz", [-state.rotation * time, roll, psi + turning * time])
        along = np.array([chord * np.cos(turn), u + sideways * time + chord * np.sin(turn), height])
        return Rotation.from_euler("z", 2.0 * turn) * own, along

    return position


def slips(
    pair: wl.Wheelset, state: State, arm: Array, angle: float, ahead: float = 0.0, across: float = 0.0
) -> tuple[float, float, float]:
    """Return ξ, η and φ at an arm from the middle of the axle [m], on a plane at a contact angle [rad].

    They are those of the material point of the wheel there, or beside it on that plane [m], less those of a roller. The
    vertical velocity is the one that keeps the wheel on the plane.
    """
    position = moved(pair, state)
    turned, middle = position(0.0)
    # A roller turns at V/R about an axis R below its top.
    roller = 0.0 if pair.roller_radius is None else 1.0 / wl.scalar_si(pair.roller_radius, "m")
    (x, _, z), rolls = arm + middle, np.array([0.0, SPEED * roller, 0.0])
    pitched = Rotation.from_euler("y", np.arctan2(-roller * x, 1.0 - roller * z))
    forwards, tangent, normal = pitched.apply(
        [[1.0, 0.0, 0.0], [0.0, np.cos(angle), np.sin(angle)], [0.0, -np.sin(angle), np.cos(angle)]]
    )

    def velocity(arm: Array) -> Array:
        material, (ahead, _, below) = turned.inv().apply(arm), arm + middle

        def place(time: float) -> Array:
            now, middle = position(time)
            return np.asarray(now.apply(material) + middle)

        of_roller = np.cross(rolls, [ahead, 0.0, below])  # less the one at its top
        return np.asarray(derivative(place) - of_roller)

    slip = velocity(arm + ahead * forwards + across * tangent)
    slip -= velocity(arm) @ normal / normal[2] * np.array([0.0, 0.0, 1.0])
    rate = derivative(lambda time: position(time)[0].as_matrix()) @ turned.as_matrix().T
    spin = np.array([rate[2, 1], rate[0, 2], rate[1, 0]])
    return float(slip @ forwards / SPEED), float(slip @ tangent / SPEED), float((spin - rolls) @ normal / SPEED)


class Row(NamedTuple):
    """A row: its arm from the middle of the axle [m] and contact angle [rad] in the track, and ξ, η and φ [1/m]."""

    arm: Array
    angle: float
    creepage: Array


def most_pressed(problem: Any) -> tuple[Row, Row]:
    """Return the rows of the left and the right wheel that carry most."""
    stand = problem.loads.stands[-1]
    rows, sliding = stand.rows, stand.sliding.at(problem.loads.rotation[0])
    pressed = []
    for wheel, sign in ((0, -1.0), (1, 1.0)):
        row = int(np.where(rows.wheel == wheel, stand._row_force(), -1.0).argmax())
        x, y, z, angle = (float(array[row]) for array in rows.place[:4])
        pressed.append(Row(np.array([x, sign * y, z]), sign * angle, np.array([one[row] for one in sliding])))
    return pressed[0], pressed[1]


def creepages(pair: wl.Wheelset, state: State) -> wl.Problem:
    """Return the problem, with creepages of the axes side and patch, under a load too small to sink the wheels."""
    return pair.problem(
        lateral_displacement=Q(state.displacement, "m"), yaw=Q(state.yaw, "rad"), vertical_load="1e-5 N",
        friction_coefficient=0.3, angular_speed=Q(state.rotation, "rad/s"),
        lateral_velocity=Q(state.lateral_velocity, "m/s"), yaw_velocity=Q(state.yaw_velocity, "rad/s"),
        curve_radius=Q(state.curve_radius, "m"),
    )  # fmt: skip


STATES = [
    State(0.0, 0.0, 43.5),
    State(3e-3, 0.0, 43.6),
    State(-3e-3, 7.2e-3, 43.4),
    State(5.7e-3, 14e-3, 43.0),
    State(-5.7e-3, 14e-3, 43.0),
    State(5.7e-3, -25e-3, 44.0),
]


MOVING = [
    State(1.5e-3, 2e-3, 43.5, lateral_velocity=0.05),
    State(-3e-3, 7.2e-3, 43.5, lateral_velocity=0.1),
    State(5.7e-3, 14e-3, 43.5, lateral_velocity=-0.1),
    State(5.7e-3, 20e-3, 43.5, yaw_velocity=0.5),
    State(-3e-3, -5e-3, 43.5, lateral_velocity=0.05, yaw_velocity=-0.05),
]
CURVES = [
    State(0.0, 0.0, 43.5, curve_radius=300.0),
    State(-3e-3, 7.2e-3, 43.5, curve_radius=-500.0),
    State(5.7e-3, 14e-3, 43.0, curve_radius=200.0),
]


@pytest.mark.validates(
    "wheelset",
    "Creepages and spin of a wheelset with roll and yaw, in a curve, on rollers, as it moves sideways, yaws and rolls",
    source="numerical differentiation of the motion of its material points in space, along a circle too (scipy)",
    held_to="{relative:g} of V, and per metre; {moving:g} as it moves sideways or yaws, and on rollers",
    relative=1e-9,
    moving=1.2e-5,
)
@pytest.mark.parametrize(
    ("pair", "state"),
    [(STANDARD, state) for state in STATES + MOVING + CURVES]
    + [(pair, state) for pair in (CONES, ROLLERS) for state in STATES + MOVING],
    ids=lambda one: (
        str(one) if isinstance(one, State) else {id(CONES): "cones", id(ROLLERS): "rollers"}.get(id(one), "s1002")
    ),
)
def test_creepages_are_the_velocities_of_material_points(
    pair: wl.Wheelset, state: State, relative: float, moving: float
) -> None:
    # Rounding of places of some cm over a step of 0.1 ms is 1e-13 m/s; the eighth order leaves (Ω 0.1 ms)^8. The roll
    # is known to 2e-12, which is 2e-8 rad/s over the steps of time. As it moves, the roll follows rows: these lie up to
    # half of 1/16 mm from the contact point, where 13 mm of radius turn them by 2.4e-3 of a velocity of V/200. A row
    # may be off its roller by 1 µm, which is 3e-6 of the roller's radius.
    bound = moving if state.lateral_velocity or state.yaw_velocity or pair is ROLLERS else relative
    problem = creepages(pair, state)
    for row in most_pressed(problem):
        due = slips(pair, state, row.arm, row.angle)
        assert row.creepage == pytest.approx(due, rel=0.0, abs=bound)


@pytest.mark.parametrize("state", [STATES[2], STATES[4], CURVES[2]], ids=str)
def test_spin_is_the_change_of_slip_across_and_along_the_patch(state: State) -> None:
    # w = (ξ - φ y, η - φ x) with x backwards. Places 1 mm away add a thousandth of a relative error of 1e-9.
    step = 1e-3
    for row in most_pressed(creepages(STANDARD, state)):
        spin = row.creepage[2]
        for ahead, across, expected in ((0.0, step, (-spin, 0.0)), (step, 0.0, (0.0, spin))):
            far, near = (
                slips(STANDARD, state, row.arm, row.angle, sign * ahead, sign * across) for sign in (1.0, -1.0)
            )
            found = [(far[axis] - near[axis]) / (2.0 * step) for axis in (0, 1)]
            assert found == pytest.approx(expected, rel=0.0, abs=2e-6)


def test_signs_are_those_of_the_conventions() -> None:
    # Yaw turns the wheels to the right, so that they slide to the left of where they roll.
    problem = creepages(STANDARD, State(0.0, 5e-3, SPEED / R0))
    angle, spin, lateral = (
        np.asarray(one)[:, 0] for one in (problem.contact_angle, problem.spin, problem.lateral_creepage)
    )
    assert angle[1] < 0.0 < angle[0]
    assert spin[1] < 0.0 < spin[0]
    assert (lateral < 0.0).all()
    # φ = sin δ/r at a small creepage and no roll, but for the yaw: cos ψ.
    assert spin == pytest.approx(np.sin(angle) / R0, rel=1e-2)
    # The wheel that turns faster than it rolls drives. The radius is within 0.1 mm of the nominal one.
    driving = creepages(STANDARD, State(0.0, 0.0, 1.01 * SPEED / R0))
    assert driving.longitudinal_creepage[:, 0] == pytest.approx(-0.01, rel=0.0, abs=1.01e-4 / R0)


# ---------------------------------------------------------------------------------------------------- torque and power


class Balanced(NamedTuple):
    """Patches under load: places from the axle, tangents and normals (n, 3); N, Fx, Fy, Mz and ξ, η, φ; Ω and e."""

    arm: Array
    tangent: Array
    normal: Array
    force: Array
    creepage: Array
    rotation: float
    axle: Array


def balanced(pair: wl.Wheelset, displacement: float, yaw: float, **conditions: Any) -> Balanced:
    """Return all patches of a wheelset under load, at the means of their rows, with the roll of rigid wheels."""
    where = {"lateral_displacement": Q(displacement, "m"), "yaw": Q(yaw, "rad")}
    where["roll"] = Q(pair.geometry(**where).dataset["roll"].item(), "mrad")
    result = (pair | wl.contact_model("fastsim"))(
        **where, vertical_load="60 kN", friction_coefficient=0.35, **conditions
    )
    problem: Any = result.problem
    stand, roll = problem.loads.stands[-1], problem.roll[0, 0]
    place, (row, patch) = stand.rows.place, stand.of_row
    patches = problem.loads.patches
    exists = patches.point, patches.side, patches.number
    weight = stand._row_force()[row]

    def mean(values: Array) -> Array:
        return np.asarray(np.bincount(patch, weight * values[row]) / np.bincount(patch, weight))

    arm = np.stack([mean(place.x), patches.sign * mean(place.y), mean(place.z)], axis=-1)
    angle = patches.sign * patches.angle
    nothing = np.zeros_like(angle)
    quantities = (result.normal_force, result.longitudinal_force, result.lateral_force, result.spin_moment)
    creepage = (problem.longitudinal_creepage, problem.lateral_creepage, problem.spin)
    axle = Rotation.from_euler("xz", [roll, yaw]).apply([0.0, 1.0, 0.0])
    rotation = float(problem.loads.rotation[0])
    return Balanced(
        arm,
        np.stack([nothing, np.cos(angle), np.sin(angle)], axis=-1),
        np.stack([nothing, -np.sin(angle), np.cos(angle)], axis=-1),
        np.stack([one.to_base_units().magnitude[exists[1:]] for one in quantities]),
        np.stack([one[exists[1:]] for one in creepage]),
        rotation,
        axle,
    )


@pytest.mark.validates(
    "wheelset",
    "Torque on the axle: moments of all forces on the wheels about it",
    source="static equilibrium in space",
    held_to="{share:g} of the torque that friction transmits",
    share=1e-3,
)
@pytest.mark.parametrize(
    ("displacement", "yaw", "torque"),
    [(0.0, 0.0, 12e3), (-3e-3, 7.2e-3, 0.0), (-3e-3, 7.2e-3, -8e3), (5.7e-3, 14e-3, 3e3)],
)
def test_forces_balance_the_torque_on_the_axle(displacement: float, yaw: float, torque: float, share: float) -> None:
    found = balanced(STANDARD, displacement, yaw, axle_torque=Q(torque, "N*m"))
    normal, along, across, moment = found.force
    on_wheel = (
        -along[:, None] * np.array([1.0, 0.0, 0.0]) - across[:, None] * found.tangent - normal[:, None] * found.normal
    )
    about = (np.cross(found.arm, on_wheel) - moment[:, None] * found.normal) @ found.axle
    # A torque that drives turns about -e.
    grip = 0.35 * 120e3 * R0
    # Rows of a patch turn by up to 0.05 rad, and the square of that is left of their means.
    assert about.sum() == pytest.approx(torque, rel=0.0, abs=share * grip)


@pytest.mark.parametrize("torque", [0.0, 3e3, -8e3])
def test_torque_and_traction_do_the_work_that_friction_dissipates(torque: float) -> None:
    # The track holds the wheelset back by the sum of Fx, against which it is pulled at V.
    found = balanced(STANDARD, -3e-3, 7.2e-3, axle_torque=Q(torque, "N*m"))
    dissipated = SPEED * (found.creepage * found.force[1:]).sum()
    work = torque * found.rotation + SPEED * found.force[1].sum()
    assert dissipated > 0.0
    assert work == pytest.approx(dissipated, rel=0.0, abs=BALANCED * 0.35 * 120e3 * SPEED)
