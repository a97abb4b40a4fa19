"""Patches of a wheelset under load, and the balance of its loads with the creep forces.

On each wheel the patches carry the vertical load together with their lateral creep forces, and the torque about the
axle is the given one:

    ∑ (N cos δ + Fy sin δ) = Q,  V ∑ (Fx ∂ξ/∂Ω + Fy ∂η/∂Ω + Mz ∂φ/∂Ω) = M.

The unknowns are the vertical penetration h of each wheel, the speed of rotation Ω and, unless it is given, the roll ρ.
All patches of a wheel are penetrated by (h - g) cos δ, with the gap g at first touching. The axle is rigid, so the
wheels sink together: with the heights of the axle at which either wheel touches first,

    height + h of the right wheel = height + h of the left wheel.

Newton's method finds ln h, Ω and ρ together. It estimates the rates and learns from its steps, so that each step costs
the creep forces once. Where it fails, because the load jumps, it tries again with the humps of a patch as patches of
their own. Where that fails too, each unknown is found by the secant method within the bounds found so far, the roll
outermost.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Literal, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

import wearlaw as wl
from wearlaw import Array
from wearlaw_models.rigs.wheelset import half_space, normal
from wearlaw_models.rigs.wheelset.candidates import (
    SAMPLES,
    SEPARATE,
    SPACING,
    Candidates,
    candidates,
    distinct,
    sample,
    sampled,
    separated,
)
from wearlaw_models.rigs.wheelset.motion import Creepages, Place, creepages, curvature_along, placed, roll_rate
from wearlaw_models.rigs.wheelset.search import Position, Section, Touching, both_sides, searched, searched_again
from wearlaw_models.rigs.wheelset.search_loops import LEAST_LEVER

WIDENINGS = 2
"""How often the distance is doubled at most."""

LEAST = 1e-5
"""Smallest penetration of a patch that is followed, as a share of the wheel's. Below it the patch is open, and its
load is below `BALANCED`."""

BALANCED = 1e-7
"""Greatest imbalance, as a share of the load, and of the torque of full slip. Creep forces are off by 1e-3 and more,
and those of FASTSIM jump by up to 1e-3 where a strip begins to stick once more."""

FIRST = 2e-3
"""Imbalance that may stay before there are creep forces."""

ROUGH = 1e-3
"""Greatest imbalance of a result; the forces of FASTSIM jump by less, as a strip begins to stick once more."""

BALANCE = "balanced"
"""Status of a position whose loads balance."""

LACKING = (
    "the vertical load of the left wheel is off by {:.2g} of the load",
    "the vertical load of the right wheel is off by {:.2g} of the load",
    "the torque on the axle is off by {:.2g} of that of full slip",
    "the level of the axle is off by {:.2g} of the load",
    "the lateral force is off by {:.2g} of the load of a wheel",
)
"""Status of other positions, by the column of `Balance.left`."""

STALLED = 1e-4
"""Imbalance from which on each unknown is sought within bounds, after Newton's method."""

SLIGHT = 1e-9
"""Change of the roll that leaves all but the heights of the wheels as it is [rad]."""

BEND = 1e-12
"""Product of the changes of the roll since the last two searches up to which places change in proportion [rad²]."""

SMALL = 1e-5
"""Change that does so before there are creep forces, which change the roll by about 1e-6 [rad]."""

NEAR = 1e-4
"""Change of the roll after which places are only followed [rad]."""

FAR = 3.0
"""Gap over the estimated penetration beyond which a place cannot touch as the roll changes in steps."""

MOST = 100.0
"""Greatest penetration that is tried, over that of the load without creep forces."""

NEWTON_STEPS, STEPS = 20, 100
"""Greatest number of steps by Newton's method, of which three or four are usual, and within bounds."""

PATIENCE = 5
"""Steps that Newton's method is given to halve the imbalance once more, beyond `NEWTON_STEPS` or below `STALLED`."""

WIDEST_STEP, MOST_TURN, WIDEST_ROLL = 1.0, 0.01, 1e-3
"""Greatest step of the logarithm of the penetration, of the speed of rotation as a share of it, and of the roll [rad].
"""

HUMP = 0.1
"""Bulge of the gap within a patch, over half the penetration, from which strips are warned of."""

FLATTEST = 1e-3
"""Least curvature across the rolling direction that is tried, over that along it."""

LEVEL = 1e-10
"""Greatest difference between the heights at which both wheels carry the axle [m]."""

JUMP = 1e-3
"""Share of the difference of level that the roll explains, below which it jumps."""

COUPLED = np.array([[1.0, 0.0, 1.0, 1.0], [0.0, 1.0, 1.0, 1.0], [1.0, 1.0, 1.0, 1.0], [1.0, 1.0, 0.0, 1.0]])
"""Which of ln h of both wheels, Ω and ρ the load of each wheel, the torque and the level depend on."""

NEARLY = 1e-2
"""Difference of level, over the penetration, up to which it is linear in penetrations and roll."""

LEAST_SHARE = 0.1
"""Smallest share of the load that a step of the penetration counts with."""

POWER = 0.3
"""Exponent of 1 - f, the share of full slip that is missing, in the creepage of FASTSIM on an ellipse."""

FULL = 0.999
"""Greatest share of full slip that the rates of creep forces count with, so that they never vanish."""

TINY = 1e-300
"""Keeps divisors from zero."""

CLOSED = 1e-12
"""Bounds have met if they differ by this share."""


@dataclass(frozen=True)
class Elastic:
    """E* [Pa], G [Pa] and ν of the pair, and the density of the wheel [kg/m³]."""

    modulus: float
    shear_modulus: float
    poisson_ratio: float
    density: float


Pressure: TypeAlias = Literal["kpec", "hertz", "half_space"]

Friction: TypeAlias = Array | wl.FallingFriction


@dataclass(frozen=True)
class Task:
    """What is asked of a wheelset at each position, as SI arrays of shape (positions,) except where stated.

    Attributes
    ----------
    displacement, yaw : ndarray
        u [m] and ψ [rad].
    speed, lateral_velocity, yaw_velocity, turn_rate : ndarray
        V and v_y [m/s], the rate of the yaw and ω_z [rad/s].
    load : ndarray, (positions, 2)
        Vertical load of each wheel, Q [N].
    bears : ndarray of bool, (positions, 2)
        Whether each wheel bears a load; the small load of one that does not is left out of the results.
    friction : pair of ndarray or FallingFriction
        Friction coefficient on the tread and on the flange [-].
    flange_angle : float
        Contact angle beyond which a patch is one of the flange [rad].
    torque : ndarray
        Torque on the axle, M [N m], positive if it drives.
    rotation : ndarray or None
        Given speed of rotation, Ω [rad/s]; the torque then follows.
    free : bool
        Whether the wheelset finds its roll; a given one stays, and has no rate.
    lateral_force : ndarray or None
        Given sum of the lateral forces on the rails, H [N]; the displacement then follows.
    """

    displacement: Array
    yaw: Array
    speed: Array
    lateral_velocity: Array
    yaw_velocity: Array
    turn_rate: Array
    load: Array
    bears: NDArray[np.bool_]
    friction: tuple[Friction, Friction]
    flange_angle: float
    torque: Array
    rotation: Array | None
    free: bool
    lateral_force: Array | None = None

    def part(self, rows: NDArray[np.intp], displacement: Array) -> Task:
        """Return what is asked at some positions, at other displacements [m]."""
        found: dict[str, Any] = {name: one[rows] for name, one in vars(self).items() if isinstance(one, np.ndarray)}
        friction = tuple(one[rows] if isinstance(one, np.ndarray) else one for one in self.friction)
        return replace(self, **found | {"friction": friction, "displacement": displacement})

    def friction_of(self, point: NDArray[np.intp], flange: NDArray[np.bool_], creep_speed: Array) -> Array:
        """Return the friction coefficients of patches [-] at creep speeds [m/s]."""
        tread, on_flange = (
            one[point] if isinstance(one, np.ndarray) else one.coefficient(creep_speed) for one in self.friction
        )
        return np.where(flange, on_flange, tread)


@dataclass
class _Root:
    """Roots of functions that grow, by the secant method within the bounds found so far; arrays of one shape."""

    x: Array
    slope: Array
    most: Array | float
    """Greatest step."""
    low: Array
    high: Array
    before: Array
    value: Array

    @classmethod
    def begun(cls, x: Array, slope: float, most: Array | float) -> _Root:
        """Return the search from first guesses of the roots and of the slope."""
        infinite, none = np.full(x.shape, np.inf), np.full(x.shape, np.nan)
        return cls(x, np.full(x.shape, slope), most, -infinite, infinite, none, none)

    def step(self, value: Array, going: NDArray[np.bool_]) -> None:
        """Move the places that are still going; the function has these values at the present ones."""
        with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
            secant = (value - self.value) / (self.x - self.before)
            self.slope = np.where((secant > 0.0) & np.isfinite(secant), secant, self.slope)
            ahead = np.clip(-value / self.slope, -self.most, self.most)
        self.low = np.where(going & (value < 0.0), self.x, self.low)
        self.high = np.where(going & (value > 0.0), self.x, self.high)
        trial = self.x + ahead
        bounded = np.isfinite(self.low) & np.isfinite(self.high)
        middle = 0.5 * (np.where(bounded, self.low, trial) + np.where(bounded, self.high, trial))
        trial = np.where((trial <= self.low) | (trial >= self.high), middle, trial)
        self.before, self.value = np.where(going, self.x, self.before), np.where(going, value, self.value)
        self.x = np.where(going, trial, self.x)

    def closed(self) -> NDArray[np.bool_]:
        """Return where the bounds have met."""
        return self.high - self.low <= CLOSED * np.abs(self.x)


class _State(NamedTuple):
    """The loads of some positions at a step.

    Attributes
    ----------
    part : Candidates
        Their places.
    problem, patch, forces
        The contact problem of the places, what else is read of them, and the creep forces, or None without.
    load, lateral : ndarray, (2 positions,)
        Vertical load that each wheel carries, and lateral force on its rail, to the right [N].
    grip : ndarray, (positions,)
        Torque of full slip [N m].
    miss : ndarray, (positions, 4)
        Logarithm of the load of both wheels over the given one, the excess of the torque over `grip`, and how much
        lower the left wheel carries the axle than the right one, over the mean of `Balance.whole`.
    """

    part: Candidates
    problem: wl.Problem
    patch: Patches
    forces: wl.CreepForces | None
    load: Array
    lateral: Array
    grip: Array
    miss: Array


@dataclass
class Balance:
    """The loads of a wheelset's patches at some positions."""

    section: Section
    elastic: Elastic
    task: Task
    pressure: Pressure
    strips: int
    roll: Array
    """Roll at each position, positive if it lowers the right wheel, ρ [rad]."""
    penetration: Array
    """Vertical penetration of each wheel, h [m]."""
    rotation: Array
    """Speed of rotation at each position, Ω [rad/s]."""
    whole: Array
    """The penetration if one patch of each wheel carried the load without creep forces [m]."""
    touching: Touching
    """All places where wheels come near their rails, at the roll of `placed`."""
    sampled: Array
    """Roll at which the gaps around them were found [rad]."""
    apart: Array
    """Change of the roll between the last two times if they gave the rates of the places, otherwise infinite [rad]."""
    searched: Array
    """Roll at which they were last looked for all along the profiles [rad]."""
    power: Array
    """Power of the penetration with which the normal force of each wheel grows [-]."""
    height: Array
    """Least gap of each wheel plus a constant, as `Touching.least` [m], (positions, 2)."""
    lever: Array
    """y + z tan δ of the first place of each wheel, by which a roll changes its gap [m], (positions, 2)."""
    roll_rate: Array
    """Rate of the roll, ρ' [rad/s]."""
    left: Array
    """Share that is left over [-], (positions, 5): of the loads of both wheels, of the torque of full slip, of the load
    that would level the axle, and of the load of a wheel as a lateral force."""
    share: Array
    """Share of the penetration by which the gap must rise between patches of each position [-]."""
    scale: Array
    """Factor on the pressure of each wheel's patches, 1 except where the load jumps as a hump joins a patch."""
    vertical: Array
    """Vertical force of each wheel on its rail, Q [N], (positions, 2)."""
    lateral: Array
    """Lateral force of each wheel on its rail, positive to the right, Y [N], (positions, 2)."""
    correction: Array
    """What Newton's method has learnt of the rates of `_State.miss`, (positions, 4, 4)."""
    shapes: dict[str, Array] = field(default_factory=dict)
    """Strips or ellipses of all places at the last step of each."""
    starts: dict[tuple[int, int], half_space.Rows] = field(default_factory=dict)
    """The last solution on half-spaces of each wheel and patch."""
    found: Candidates = field(init=False)
    """The places of contact at this roll."""

    @classmethod
    def begun(
        cls,
        section: Section,
        elastic: Elastic,
        task: Task,
        roll: Array,
        touching: Touching,
        pressure: Pressure,
        strips: int,
    ) -> Balance:
        """Return the loads without creep forces, under which the wheelset turns with the mean of its radii.

        The roll, and where the wheels touch, are the given ones or those of rigid wheels.
        """
        count = roll.size
        wheels, pairs, none = np.zeros(2 * count), np.zeros((count, 2)), np.zeros(count)
        balance = cls(
            section, elastic, task, pressure, strips, roll.copy(), wheels, none, wheels, touching, roll.copy(),
            np.full(count, np.inf), roll.copy(), np.full(2 * count, 1.5), pairs, pairs.copy(), none.copy(),
            np.zeros((count, 5)), np.full(count, SEPARATE), np.ones(2 * count), pairs.copy(), pairs.copy(),
            np.zeros((count, 4, 4)),
        )  # fmt: skip
        balance.whole, sunk = balance._guessed()
        if task.free:
            roll = sunk
            touching = searched_again(section, task.displacement, task.yaw, roll, touching, count)
        balance._stand(np.arange(count), roll, touching)
        balance.penetration = balance.whole.copy()
        first = balance.found.part(balance.found.number == 0)
        radius = placed(section, first.position, first.arc).radius.reshape(-1, 2).mean(axis=-1)
        balance.rotation = task.speed / radius if task.rotation is None else task.rotation.copy()
        left = np.ones(count, dtype=np.bool_)
        if task.free:  # the roll needs only rough penetrations, since it is found again with the creep forces
            balance._newton(None, left, False, once=True)
            left, before = balance.imbalance > FIRST, balance.sampled.copy()
            balance._level(SMALL)
            left |= balance.sampled != before
        balance._newton(None, left, False)
        left = balance.imbalance > FIRST
        if left.any():
            balance._bracketed(None, left)
        if task.free:
            balance._level(np.inf)
        return balance

    @property
    def imbalance(self) -> Array:
        """Greatest share that is left over at each position [-]."""
        return np.asarray(self.left.max(axis=-1))

    @property
    def status(self) -> NDArray[np.object_]:
        """What does not balance at each position, and by how much, as texts; `BALANCE` where nothing lacks."""
        status = np.full(self.roll.shape, BALANCE, dtype=object)
        for point in np.flatnonzero(~self.balanced):
            most = int(self.left[point].argmax())
            status[point] = LACKING[most].format(self.left[point, most])
        return status

    @property
    def balanced(self) -> NDArray[np.bool_]:
        """Whether the loads of each position balance; if no wheel bears a load, there is nothing to balance."""
        return (self.imbalance <= ROUGH) | ~self.task.bears.any(axis=-1)

    def _level(self, slight: float) -> None:
        """Roll the wheelset, in place, until both wheels carry it at one height; `slight` as in `_turn`."""
        ahead = np.clip(-self._lower() / self._levers(), -WIDEST_ROLL, WIDEST_ROLL)
        self._turn(np.arange(self.roll.size), self.roll + ahead, slight)

    def _guessed(self) -> tuple[Array, Array]:
        """Return guesses of the penetration of each wheel [m] and of the rolls [rad], by Hertz where bodies touch."""
        task, arc = self.task, self.touching.arc[..., 0]
        position = both_sides(task.displacement, self.roll, task.yaw)
        place = placed(self.section, position, arc)
        cosine = np.cos(place.angle)
        along = 0.5 * curvature_along(self.section, position, place, arc)
        depth = self._unit(position, place, arc, along).penetration * np.cbrt(task.load / cosine) ** 2 / cosine
        lever = np.maximum(np.abs((place.y + place.z * np.tan(place.angle)).sum(axis=-1)), LEAST_LEVER)
        ahead = np.clip((depth[:, 1] - depth[:, 0]) / lever, -WIDEST_ROLL, WIDEST_ROLL)
        return depth.reshape(-1), self.roll + ahead

    def _stand(self, rows: NDArray[np.intp], roll: Array, touching: Touching) -> None:
        """Put some positions at rolls, in place, where their wheels touch as given."""
        task, known = self.task, bool(self.shapes)
        for array, values in zip(self.touching, touching, strict=True):
            array[rows] = values
        if known:  # places that are far from touching need no samples
            far = touching.gap > FAR * self.whole.reshape(-1, 2)[rows][..., None]
            touching = touching._replace(arc=np.where(far, np.nan, touching.arc))
        spacing = np.full(self.whole.size, self._spacing)
        if known:
            np.maximum.at(spacing, self.found.wheel, self.found.step)
        position = both_sides(task.displacement[rows], roll, task.yaw[rows])
        places = candidates(self.section, position, touching, spacing.reshape(-1, 2)[rows])
        saddle = touching.saddle[places.point, places.side, places.number]
        places, first = replace(places, point=rows[places.point]), places.number == 0
        lowest = places.part(first)
        if not known:
            lowest = sampled(self.section, lowest, self.roll.size)
            self.whole[lowest.wheel] = self._alone(lowest)
            places.start[first], places.step[first] = lowest.start, lowest.step
        joins = self.pressure == "half_space"
        own = distinct(places, saddle, self.whole[places.wheel], self.share[places.point], joins)
        kept = sampled(self.section, places.part(own if known else own & ~first), self.roll.size)
        kept = separated(kept if known else lowest.joined(kept)[0])
        change = np.zeros(self.roll.shape)
        change[rows] = roll - self.sampled[rows]
        self.roll[rows], self.sampled[rows], self.height[rows] = roll, roll, touching.least
        place = Place(*(array.reshape(-1, 2) for array in placed(self.section, lowest.position, lowest.arc)))
        self.lever[rows] = lowest.lever.reshape(-1, 2)
        if task.free:
            self.roll_rate[rows] = roll_rate(place, task.lateral_velocity[rows], task.yaw_velocity[rows])
        if not known:
            self.found = kept
            return
        stay = ~self._chosen(rows)[self.found.point]
        old = np.flatnonzero(~stay)
        self.apart[rows] = np.where(kept.learn(self.found, old, change), np.abs(change), np.inf)[rows]
        if np.array_equal(self.found.wheel[old], kept.wheel):  # as many as before
            self.found.put(old, kept)
            return
        self.found, order = self.found.part(stay).joined(kept)
        for name, array in self.shapes.items():  # those of the new places follow at the next step
            none = np.full((kept.point.size, *array.shape[1:]), np.nan)
            self.shapes[name] = np.concatenate([array[stay], none])[order]

    @property
    def _spacing(self) -> float:
        """Distance between samples of the gap [m]; half-spaces need a window that holds both humps of a patch."""
        return 2.0 * SPACING if self.pressure == "half_space" else SPACING

    def _chosen(self, rows: NDArray[np.intp]) -> NDArray[np.bool_]:
        """Return whether each position is among some."""
        chosen = np.zeros(self.roll.shape, dtype=np.bool_)
        chosen[rows] = True
        return chosen

    def _turn(self, rows: NDArray[np.intp], roll: Array, slight: float = SLIGHT) -> None:
        """Roll some positions, in place; those whose wheels would leave the rails stay.

        After changes below `slight`, only the heights of the wheels and the gaps of further places are new. After
        changes that are small beside those before, all else follows in proportion.
        """
        ahead, by, found = np.abs(roll - self.sampled[rows]), np.zeros(self.roll.size), self.found
        near = (ahead < slight) | (ahead < BEND / (ahead + self.apart[rows]))
        by[rows[near]] = (roll - self.roll[rows])[near]
        self.roll += by
        self.height += self.lever * by[:, None] * (1.0, -1.0)
        tilt = found.lever - self.lever[found.point, found.side]
        found.gap[:] += np.where(found.side == 0, 1.0, -1.0) * tilt * by[found.point]
        found.turn(np.where(self.apart < np.inf, by, 0.0)[found.point])
        rows, roll, task = rows[~near], roll[~near], self.task
        if not rows.size:
            return
        given = task.displacement[rows], task.yaw[rows], roll
        touching = Touching(*(array[rows] for array in self.touching))
        if (np.abs(roll - self.searched[rows]) < NEAR).all():
            touching = searched_again(self.section, *given, touching, self.roll.size)
        else:
            _, touching = searched(self.section, *given, self.roll.size)
            self.searched[rows] = roll
        on = ~np.isnan(touching.arc[..., 0]).any(axis=-1)
        if on.any():
            self._stand(rows[on], roll[on], Touching(*(array[on] for array in touching)))

    def check_torque(self) -> None:
        """Raise an error for a torque that friction cannot transmit."""
        problem, patch = self.posed()
        _, _, _, grip = self._sums(self.found, patch, problem, None)
        over = ~(np.abs(self.task.torque) < grip)
        if over.any():
            point = int(np.argmax(over))
            raise wl.ConditionsError(
                f"axle_torque: {self.task.torque[point]:.4g} N*m is more than friction can transmit, about"
                f" {grip[point]:.4g} N*m under this load"
            )

    def _alone(self, found: Candidates) -> Array:
        """Return the vertical penetration if one patch of each wheel carries the whole load, and widen its samples."""
        penetration = self.whole[found.wheel]
        open_ = np.arange(found.wheel.size)
        widest = self._spacing if self.pressure == "half_space" else SPACING * 2.0**WIDENINGS
        while open_.size:
            part = found if open_.size == found.wheel.size else found.part(open_)
            load = self.task.load[part.point, part.side] / part.cosine
            depth, power, step, before = penetration[open_], np.full(open_.size, 1.5), 0.0 * load, 0.0 * load
            patch: Any = None
            for _ in range(2):
                patch = self._penetrated(part, depth * part.cosine, 5)
                borne = np.log(np.maximum(patch.normal_force / load, LEAST_SHARE))
                power = np.divide(borne - before, step, out=power, where=np.abs(step) > STALLED)
                power = np.minimum(np.maximum(power, 1.0), 3.0)
                before, step = borne, -borne / power
                depth = depth * np.exp(step)
            penetration[open_], self.power[part.wheel] = depth, power
            open_ = open_[patch.narrow & (part.step < widest)]
            sample(self.section, found, open_, 2.0 * found.step[open_], self.roll.size)
        return penetration

    def _penetrated(self, part: Candidates, depth: Array, strips: int) -> normal.StripPatch:
        """Return strips at penetrations normal to the surface [m]."""
        return normal.penetrated(
            part.start, part.step, part.gaps, part.curvature_x, self.elastic.modulus, depth, strips, self.roll.size,
        )  # fmt: skip

    def solved(self, forces: Callable[[wl.Problem], wl.CreepForces], bounds: bool = True) -> Balance:
        """Return the loads with penetrations and speeds of rotation that balance the creep forces.

        Parameters
        ----------
        forces : callable
            Returns the creep forces of a problem with one entry for each patch.
        bounds : bool
            Whether to search within bounds where Newton's method fails, which takes a hundred times as long.
        """
        copies: dict[str, Any] = {name: one.copy() for name, one in vars(self).items() if isinstance(one, np.ndarray)}
        copies["scale"] = np.ones(self.scale.shape)
        touching = Touching(*(array.copy() for array in self.touching))
        found = replace(self, touching=touching, shapes=dict(self.shapes), starts=dict(self.starts), **copies)
        found.found = self.found.part(np.arange(self.found.point.size))
        rolls = self.task.free
        found._newton(forces, np.ones(self.roll.shape, dtype=np.bool_), rolls, known=True)
        left = found.imbalance > STALLED
        if rolls and left.any():  # one of two humps of a patch takes over from the other; let them share the load
            found._restart(self, left, 0.0)
            found._newton(forces, left, rolls)
            left &= found.imbalance > ROUGH
        if left.any() and bounds:
            if rolls:
                found._restart(self, left, SEPARATE)
                found._rolled(forces, left)
            else:
                found._bracketed(forces, left)
        return found

    def _restart(self, begun: Balance, left: NDArray[np.bool_], share: float) -> None:
        """Put some positions back to where they began, in place, with another `share` of the penetration."""
        wheels = left.repeat(2)
        self.penetration[wheels], self.rotation[left] = begun.penetration[wheels], begun.rotation[left]
        self.share[left], self.correction[left], self.apart[left] = share, 0.0, np.inf
        self._turn(np.flatnonzero(left), begun.roll[left], 0.0)

    def _newton(
        self,
        forces: Callable[[wl.Problem], wl.CreepForces] | None,
        chosen: NDArray[np.bool_],
        rolls: bool,
        known: bool = False,
        once: bool = False,
    ) -> None:
        """Balance the loads of some positions by Newton's method, in place; their rolls stay unless `rolls`.

        If `known`, the present shapes of patches are taken for the first step; if `once`, there is no other.

        Broyden's method corrects the estimated rates, in Schubert's form, which keeps those that are zero. The speed
        of rotation and the roll count with the torque and the level that they change. Where the wheels are nearly
        level, the roll makes them so at the new penetrations.
        """
        count = self.roll.size
        open_, unit = chosen.copy(), np.ones((count, 1, 4))
        step, before = np.zeros((2, count, 4))
        least, halved = np.full(count, np.inf), np.zeros(count)
        for iteration in range(1 if once else STEPS):
            state = self._state(forces, open_, known and iteration == 0)
            if not rolls:
                state.miss[:, 3] = 0.0
            self._note(state, open_)
            worst, tilt = np.abs(state.miss[:, :3]).max(axis=-1), np.abs(state.miss[:, 3])
            open_ &= (worst > (FIRST if forces is None else BALANCED)) | (tilt * self._depths() > LEVEL)
            imbalance = self.imbalance
            better = imbalance < 0.5 * least
            least, halved = np.where(better, imbalance, least), np.where(better, iteration, halved)
            slow = (iteration >= NEWTON_STEPS - 1) | (imbalance < STALLED)
            open_ &= ~slow | (iteration - halved < PATIENCE)
            rows = np.flatnonzero(open_)
            if not rows.size:
                break
            rates, miss = self._rates(state)[rows], state.miss[rows]
            if not rolls:
                rates[:, 3] = 0.0, 0.0, 0.0, 1.0
            if iteration == 0:
                unit[rows, 0, 2:] = np.diagonal(rates, axis1=1, axis2=2)[:, 2:]
            rates /= unit[rows]
            moved = step[rows] * unit[rows, 0]
            unforeseen = miss - before[rows] - ((rates + self.correction[rows]) @ moved[..., None])[..., 0]
            unforeseen[:, :2][miss[:, :2] <= np.log(LEAST_SHARE)] = 0.0  # a load that is lost tells nothing of its rate
            own = moved[:, None, :] * COUPLED  # steps below BALANCED only show rounding
            self.correction[rows] += (
                unforeseen[..., None] * own / np.maximum((own**2).sum(axis=-1), BALANCED**2)[..., None]
            )
            ahead = -np.linalg.solve(rates + self.correction[rows], miss[..., None])[..., 0] / unit[rows, 0]
            ahead[:, :2] = np.clip(ahead[:, :2], -WIDEST_STEP, WIDEST_STEP)
            most = MOST_TURN * self.rotation[rows]
            ahead[:, 2] = np.clip(ahead[:, 2], -most, most)
            self.penetration.reshape(-1, 2)[rows] *= np.exp(ahead[:, :2])
            self.rotation[rows] += ahead[:, 2]
            if rolls:
                was = self.roll[rows]
                ahead[:, 3] = np.where(tilt[rows] < NEARLY, -(self._lower() / self._levers())[rows], ahead[:, 3])
                self._turn(rows, was + np.clip(ahead[:, 3], -WIDEST_ROLL, WIDEST_ROLL))
                ahead[:, 3] = self.roll[rows] - was
            step[rows], before[rows] = ahead, miss

    def _depths(self) -> Array:
        """Return the mean of `whole` at each position [m]."""
        return np.asarray(self.whole.reshape(-1, 2).mean(axis=-1))

    def _note(self, state: _State, chosen: NDArray[np.bool_]) -> None:
        """Keep what some positions leave over; a difference of level counts with the load that it would carry."""
        left = np.abs(np.hstack([np.expm1(state.miss[:, :2]), state.miss[:, 2:] * (1.0, 1.5)]))
        self.left[chosen, :4] = left[chosen]
        self.vertical[chosen], self.lateral[chosen] = (
            one.reshape(-1, 2)[chosen] for one in (state.load, state.lateral)
        )

    def _rolled(self, forces: Callable[[wl.Problem], wl.CreepForces] | None, open_: NDArray[np.bool_]) -> None:
        """Find the rolls of some positions within bounds, in place, with the loads balanced at each roll."""
        going = open_.copy()
        rolls = _Root.begun(self.roll, np.nan, WIDEST_ROLL)
        for _ in range(STEPS):
            self.scale[going.repeat(2)] = 1.0
            self._newton(forces, going, False)
            left = going & (self.imbalance > ROUGH)
            if left.any():
                self._bracketed(forces, left)
            lower = self._lower()
            self.left[going, 3] = 1.5 * np.abs(lower)[going]
            jump = (rolls.high - rolls.low) * self._levers() < JUMP * np.abs(lower)
            going &= (np.abs(lower) * self._depths() > LEVEL) & ~jump
            if not going.any():
                break
            if np.isnan(rolls.slope).all():
                rolls.slope = self._levers()
            rolls.step(lower, going)
            rows = np.flatnonzero(going)
            self._turn(rows, rolls.x[rows])
            going &= self.roll == rolls.x
            if not going.any():
                break

    def _lower(self) -> Array:
        """Return how much lower the left wheel carries the axle than the right one, over the mean of `whole`."""
        carried = self.height + self.penetration.reshape(-1, 2)
        return np.asarray((carried[:, 0] - carried[:, 1]) / self._depths())

    def _levers(self) -> Array:
        """Return the rate of `_lower` with the roll [1/rad]."""
        return np.asarray(np.maximum(np.abs(self.lever.sum(axis=-1)), LEAST_LEVER) / self._depths())

    def _bracketed(self, forces: Callable[[wl.Problem], wl.CreepForces] | None, open_: NDArray[np.bool_]) -> None:
        """Balance some positions in place, the torque within bounds, and at each speed of rotation the loads."""
        start, going = self.penetration.copy(), open_.copy()
        self.penetration = np.where(open_.repeat(2), self.whole, start)
        turns = _Root.begun(self.rotation, np.nan, MOST_TURN * self.rotation)
        for _ in range(STEPS):
            state = self._carried(forces, going)
            lost = (np.abs(state.miss[:, :2]) > ROUGH).any(axis=-1)
            going &= (np.abs(state.miss[:, 2]) > BALANCED) & ~lost & ~turns.closed()
            if not going.any():
                break
            if np.isnan(turns.slope).all():
                turns.slope = np.maximum(self._rates(state)[:, 2, 2], TINY)
            turns.step(state.miss[:, 2], going)
            self.rotation = turns.x
        state = self._state(forces, open_)
        state.miss[:, 3] = 0.0
        self._note(state, open_)

    def _carried(self, forces: Callable[[wl.Problem], wl.CreepForces] | None, open_: NDArray[np.bool_]) -> _State:
        """Balance the vertical loads of some positions at their speed of rotation, in place."""
        depths, going = _Root.begun(np.log(self.penetration), 1.5, WIDEST_STEP), open_.copy()
        self.scale = np.where(open_.repeat(2), 1.0, self.scale)
        for _ in range(STEPS):
            state = self._state(forces, going)
            excess = state.miss[:, :2].reshape(-1)
            deep = (self.penetration > MOST * self.whole).reshape(-1, 2).any(axis=-1)
            going &= (np.abs(state.miss[:, :2]) > BALANCED).any(axis=-1) & ~deep
            if not going.any():
                break
            wheels = going.repeat(2)
            jump = wheels & depths.closed()
            self.scale = np.where(jump, self.scale * np.exp(-excess), self.scale)
            depths.step(excess, wheels & ~jump)
            self.penetration = np.where(wheels, np.exp(depths.x), self.penetration)
            if self.pressure == "hertz":  # only creep forces jump, which a scale does not mend
                going &= ~jump.reshape(-1, 2).any(axis=-1)
            if not going.any():
                break
        return self._state(forces, open_)

    def _state(
        self, forces: Callable[[wl.Problem], wl.CreepForces] | None, open_: NDArray[np.bool_], known: bool = False
    ) -> _State:
        """Return the loads of some positions as they are; `known` if the shapes of all patches are as well."""
        rows = np.flatnonzero(open_[self.found.point])
        part = self.found if rows.size == self.found.point.size else self.found.part(rows)
        normal = {"hertz": self._ellipses, "kpec": self._strips, "half_space": self._half_spaces}
        shapes = self.shapes if known else normal[self.pressure](part)
        if rows.size == self.found.point.size:
            self.shapes = shapes
        else:
            for name, array in shapes.items():
                self.shapes[name][rows] = array
        problem, patch = self._posed(part, shapes)
        force = None if forces is None else forces(problem)
        load, lateral, torque, grip = self._sums(part, patch, problem, force)
        miss = np.zeros((open_.size, 4))
        miss[:, :2] = np.log(np.maximum(load / self.task.load.reshape(-1), LEAST_SHARE)).reshape(-1, 2)
        if force is not None and self.task.rotation is None:
            miss[:, 2] = (torque - self.task.torque) / np.maximum(grip, TINY)
        if self.task.free:
            miss[:, 3] = np.where(open_, self._lower(), 0.0)
        return _State(part, problem, patch, force, load, lateral, grip, miss)

    def _sums(
        self, part: Candidates, patch: Patches, problem: wl.Problem, force: wl.CreepForces | None
    ) -> tuple[Array, Array, Array, Array]:
        """Return vertical and lateral loads of wheels [N], torques of axles and those of full slip [N m]."""
        count = self.roll.size
        side = np.where(part.side == 1, 1.0, -1.0)
        cos, sin = np.cos(patch.place.angle), side * np.sin(patch.place.angle)
        vertical, lateral = patch.normal_force * cos, -patch.normal_force * sin
        torque = np.zeros(part.point.size)
        if force is not None:
            vertical, lateral = vertical + sin * force.lateral, lateral + cos * force.lateral
            parts = zip((force.longitudinal, force.lateral, force.spin_moment), patch.creepages.turning, strict=True)
            torque = problem.rolling_speed * sum(one * other for one, other in parts)
        grip = problem.friction_coefficient * patch.normal_force * patch.place.radius
        load = np.bincount(part.wheel, vertical, 2 * count)
        load[np.bincount(part.wheel, minlength=2 * count) == 0] = 1.0
        across = np.bincount(part.wheel, lateral, 2 * count)
        torques, grips = (np.asarray(np.bincount(part.point, one, count), np.float64) for one in (torque, grip))
        return np.asarray(load, np.float64), np.asarray(across, np.float64), torques, grips

    def _rates(self, state: _State) -> Array:
        """Return estimates of the rates of `_State.miss` with ln h of both wheels, Ω and ρ, (positions, 4, 4).

        The normal force grows with the power 3/2 of the penetration. The creep forces start with Kalker's rates. As f,
        their share of μN, grows, the rate along the force falls to (1 - f)^0.7, and that across it to f/x with
        1 - f = (1 - 0.3 x)^(10/3). This is FASTSIM on an ellipse within 1 %, x being the force of the linear theory
        over μN, which falls with the third root of N.
        """
        part, problem, patch, force, load, _, grip, _ = state
        count = load.size // 2
        found = np.zeros((count, 4, 4))
        own, side = patch.normal_force * np.cos(patch.place.angle), np.where(part.side == 1, 1.0, -1.0)
        grip = np.maximum(grip, TINY)
        depth = self.penetration[part.wheel]
        growth = self.power[part.wheel] / np.maximum(1.0 - part.gap / depth, LEAST)
        if force is not None:
            bound = problem.friction_coefficient * patch.normal_force
            size = np.maximum(force.tangential, TINY)
            x, y, up = force.longitudinal / size, force.lateral / size, side * np.sin(patch.place.angle)
            share = np.minimum(size / bound, FULL)
            slope, linear = (1.0 - share) ** (1.0 - POWER), -np.expm1(POWER * np.log1p(-share)) / POWER
            across, swelling = share / linear, bound * (share - slope * linear / 3.0)
            c = wl.kalker.coefficients(problem.a / problem.b, self.elastic.poisson_ratio)
            stiffness, width = self.elastic.shear_modulus * problem.a * problem.b, np.sqrt(problem.a * problem.b)
            xi, eta, phi = patch.creepages.turning
            linear_x, linear_y = stiffness * c.c11 * xi, stiffness * (c.c22 * eta + c.c23 * width * phi)
            along = (slope - across) * (x * linear_x + y * linear_y)
            force_x, force_y = across * linear_x + along * x, across * linear_y + along * y
            own = own + up * y * swelling
            speed = problem.rolling_speed
            found[:, :2, 2] = (np.bincount(part.wheel, up * force_y, 2 * count) / load).reshape(-1, 2)
            found[:, 2, 2] = np.bincount(part.point, speed * (xi * force_x + eta * force_y), count) / grip
            turned = np.bincount(part.wheel, growth * speed * (xi * x + eta * y) * swelling, 2 * count)
            found[:, 2, :2] = turned.reshape(-1, 2) / grip[:, None]
        if force is None or self.task.rotation is not None:
            found[:, 2] = 0.0, 0.0, 1.0, 0.0
        vertical = np.bincount(part.wheel, growth * own, 2 * count) / load
        found[:, (0, 1), (0, 1)] = vertical.reshape(-1, 2)
        found[:, 3, 3] = 1.0
        if self.task.free:
            # A roll brings a further place nearer to its rail than the first one by the difference of their levers.
            tilt = side * (part.lever - self.lever[part.point, part.side])
            nearer = np.where(part.number == 0, 0.0, growth * own * tilt / depth)
            found[:, :2, 3] = (np.bincount(part.wheel, nearer, 2 * count) / load).reshape(-1, 2)
            found[:, 3, 3] = self._levers()
            found[:, 3, :2] = self.penetration.reshape(-1, 2) * (1.0, -1.0) / self._depths()[:, None]
        return found

    def posed(self) -> tuple[wl.Problem, Patches]:
        """Return the contact problem of all places, with one entry for each, and what else is read of the patches."""
        return self._posed(self.found, self.shapes)

    def _posed(self, part: Candidates, shapes: Mapping[str, Array]) -> tuple[wl.Problem, Patches]:
        task, elastic = self.task, self.elastic
        side = np.where(part.side == 1, 1.0, -1.0)
        arc = part.arc_at(shapes["centre"][:, None])[:, 0]
        place = placed(self.section, part.position, arc)
        if "angle" in shapes:  # of two humps the middle may lie between them
            place = place._replace(angle=shapes["angle"], rail_arc=self.section.rail_position.at(shapes["rail_y"])[0])
        sliding = creepages(
            part.position, place, task.speed[part.point], side * task.lateral_velocity[part.point],
            side * task.turn_rate[part.point], side * self.roll_rate[part.point], side,
        )  # fmt: skip
        flange = np.abs(place.angle) > task.flange_angle
        longitudinal, lateral, spin = sliding.at(self.rotation[part.point])
        creep_speed = task.speed[part.point] * np.hypot(longitudinal, lateral)
        given = {name: shapes[name] for name in ("a", "b")}
        made = {
            "shear_modulus": np.full(side.shape, elastic.shear_modulus),
            "poisson_ratio": np.full(side.shape, elastic.poisson_ratio),
            "density": np.full(side.shape, elastic.density),
            "friction_coefficient": task.friction_of(part.point, flange, creep_speed),
            "longitudinal_creepage": longitudinal,
            "lateral_creepage": lateral,
            "spin": spin,
            "rolling_speed": task.speed[part.point],
            "contact_angle": side * place.angle,
        }
        if self.pressure == "hertz":
            problem = wl.Problem.ellipse_from_si(**given, **made, normal_force=shapes["normal_force"])
        else:
            strips = wl.Strips(**{name: shapes[name] for name in wl.Strips.__slots__ if name in shapes})
            problem = wl.Problem.of_strips(strips=strips, **given, **made)
        touch = self.penetration[part.wheel] > part.gap
        return problem, Patches(problem.normal_force, arc, place, sliding, touch)

    def _depth(self, part: Candidates) -> Array:
        """Return the penetrations normal to the surface [m]."""
        depth = self.penetration[part.wheel]
        normal: Array = np.maximum(depth - part.gap, LEAST * depth) * part.cosine
        return normal

    def humps(self) -> NDArray[np.bool_]:
        """Return which places have a second hump that bears: the gap bulges over a line from its least to another."""
        middle, half = SAMPLES // 2, 0.5 * self._depth(self.found)[:, None]
        gaps = self.found.gaps
        number, humps = np.arange(1, middle + 1), np.zeros(half.size, dtype=np.bool_)
        for samples in (gaps[:, middle + 1 :], gaps[:, middle - 1 :: -1]):
            slope = np.where(samples < half, samples / number, np.inf)
            least = np.minimum.accumulate(slope[:, ::-1], axis=-1)[:, ::-1]
            with np.errstate(invalid="ignore"):  # beyond the patch
                humps |= (samples - number * least > HUMP * half).any(axis=-1)
        return humps

    def _strips(self, part: Candidates) -> dict[str, Array]:
        """Return the strips of patches, their semi-axes and their centres."""
        found = self._penetrated(part, self._depth(part), self.strips)
        shapes = {name: getattr(found, name) for name in ("y", "width", "half_length", "a", "b", "centre")}
        return self._sided(part, shapes | {"max_pressure": found.pressure})

    def _sided(self, part: Candidates, shapes: dict[str, Array]) -> dict[str, Array]:
        """Return strips about their centre with y to the right on both sides, and their pressure times `scale`."""
        right = (part.side == 1)[:, None]
        y = np.where(right, 1.0, -1.0) * (shapes["y"] - shapes["centre"][:, None])
        arrays = shapes | {"y": y, "max_pressure": shapes["max_pressure"] * self.scale[part.wheel, None]}
        return {
            name: np.where(right, array, array[:, ::-1]) if array.ndim == 2 else array for name, array in arrays.items()
        }  # y grows on the left too

    def _half_spaces(self, part: Candidates) -> dict[str, Array]:
        """Return rows of elements as strips, an ellipse of their area and length, their centres and mean angles."""
        y, half_length, pressure, width = np.empty((4, part.arc.size, 2 * self.strips))
        rail_y, angle, error = np.empty((3, part.arc.size))
        for k, depth in enumerate(self._depth(part)):
            key = int(part.wheel[k]), int(part.number[k])
            self.starts[key] = found = half_space.rows(
                self.section.sides[part.side[k]], part.part(np.array([k])), float(depth), self.elastic.modulus,
                2 * self.strips, self.starts.get(key),
            )  # fmt: skip
            y[k], half_length[k], pressure[k], width[k], rail_y[k], angle[k], error[k] = found[:7]
        load, a = half_length * pressure * width, half_length.max(axis=-1)
        return self._sided(
            part,
            {
                "y": y,
                "width": width,
                "half_length": half_length,
                "max_pressure": pressure,
                "a": a,
                "b": 2.0 / np.pi * (half_length * width).sum(axis=-1) / a,
                "centre": (load * y).sum(axis=-1) / load.sum(axis=-1),
                "rail_y": rail_y,
                "angle": angle,
                "error": error,
            },
        )

    def _ellipses(self, part: Candidates) -> dict[str, Array]:
        """Return Hertz's ellipses of the curvatures at first touching."""
        unit = self._unit(part.position, placed(self.section, part.position, part.arc), part.arc, part.curvature_x)
        share = np.sqrt(self._depth(part) / unit.penetration)
        return {"a": unit.a * share, "b": unit.b * share, "normal_force": share**3, "centre": np.zeros(share.shape)}

    def _unit(self, position: Position, place: Place, arc: Array, along: Array) -> normal.HertzPatch:
        """Return Hertz's ellipses under 1 N, with half the curvature along the rolling direction [1/m]."""
        cosine, wheel = np.cos(place.angle), self.section.at("wheel", arc, position.side)[3]
        circle = cosine / place.radius
        across = 0.5 * (wheel + circle + self.section.at("rail", place.rail_arc, position.side)[3]) - along
        turn = np.tan(position.yaw) / cosine  # of the wheel's circles, which skews the gap
        skew = 0.5 * (wheel - circle) * turn / (1.0 + turn**2)
        more = np.hypot(0.5 * (along - across), skew) - np.abs(0.5 * (along - across))
        more = np.where(along > across, more, -more)
        along, across = along + more, across - more
        across = np.maximum(across, FLATTEST * along)  # a place that is only followed may pass an inflection
        return normal.hertz(along, across, self.elastic.modulus, np.ones(across.shape))


@dataclass(frozen=True)
class Patches:
    """What the balance reads of patches: N, arc length of the wheel, place, creepages, and whether they touch."""

    normal_force: Array
    arc: Array
    place: Place
    creepages: Creepages
    touch: NDArray[np.bool_]
