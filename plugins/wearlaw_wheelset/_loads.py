"""Patches of a wheelset under load, and the balance of its loads with the creep forces.

On each wheel the patches carry the vertical load together with their lateral creep forces, and the torque about the
axle is the given one:

    ∑ (N cos δ + Fy sin δ) = Q,  V ∑ (Fx ∂ξ/∂Ω + Fy ∂η/∂Ω + Mz ∂φ/∂Ω) = M.

The unknowns are the vertical penetration h of each wheel and the speed of rotation Ω. All patches of a wheel are
penetrated by (h - g) cos δ, with the gap g at first touching. The load grows nearly with the power 3/2 of h, and the
torque grows with Ω; each is found by the secant method, in h in logarithms, and Ω within the bounds found so far.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

import wearlaw as wl
from wearlaw import Array
from wearlaw_wheelset import _normal
from wearlaw_wheelset._motion import Creepages, Place, creepages, placed
from wearlaw_wheelset._search import Position, Section, Touching, gaps

SAMPLES = 81
"""Samples of the gap under a patch."""

SPACING = 0.25e-3
"""Distance from one sample to the next [m]; it is doubled where a patch is wider than the samples."""

WIDENINGS = 2
"""How often the distance is doubled at most."""

SEPARATE = 0.5
"""Two bumps are patches of their own if the gap between them exceeds this share of the penetration, the share of the
virtual penetration."""

SPARE = 1.5
"""A patch is followed if its gap is at most this share of the penetration under the whole load."""

LEAST = 1e-3
"""Smallest penetration of a patch that is followed, as a share of the wheel's; below it the patch is open."""

BALANCED = 1e-8
"""Greatest imbalance, as a share of the load, and of the torque of full slip."""

STEPS = 100
"""Greatest number of steps of the balance; five to ten are usual."""

WIDEST_STEP, MOST_TURN = 1.0, 0.01
"""Greatest step of the logarithm of the penetration, and of the speed of rotation as a share of it."""

LEAST_SHARE = 0.1
"""Smallest share of the load that a step of the penetration counts with."""

CLOSED = 1e-12
"""Bounds have met if they differ by this share."""


@dataclass(frozen=True)
class Elastic:
    """E* [Pa], G [Pa] and ν of the pair, and the density of the wheel [kg/m³]."""

    modulus: float
    shear_modulus: float
    poisson_ratio: float
    density: float


@dataclass(frozen=True)
class Task:
    """What is asked of a wheelset at each position, as SI arrays of shape (positions,) except where stated.

    Attributes
    ----------
    speed, lateral_velocity, turn_rate, roll_rate : ndarray
        V and v_y [m/s], ω_z and ρ' [rad/s].
    load : ndarray
        Vertical load of each wheel, Q [N].
    friction : ndarray, (positions, 2)
        Friction coefficient on the tread and on the flange [-].
    flange_angle : float
        Contact angle beyond which a patch is one of the flange [rad].
    torque : ndarray
        Torque on the axle, M [N m], positive if it drives.
    rotation : ndarray or None
        Given speed of rotation, Ω [rad/s]; the torque then follows.
    """

    speed: Array
    lateral_velocity: Array
    turn_rate: Array
    roll_rate: Array
    load: Array
    friction: Array
    flange_angle: float
    torque: Array
    rotation: Array | None


@dataclass(frozen=True)
class Candidates:
    """Places where wheels may touch under load, as arrays with one entry for each of them.

    Attributes
    ----------
    point, side, number : ndarray of int
        Index of the position, of the side (0 left, 1 right) and of the patch on its side.
    position : Position
        In outward coordinates.
    arc, gap : ndarray
        Arc length of the wheel's profile, and vertical gap there at first touching [m].
    cosine : ndarray
        cos δ there [-].
    start, step, samples : ndarray
        The gap normal to the surface around the place, above its least value [m], `samples` of shape (places, samples).
    curvature_x : ndarray
        Half the relative curvature along the rolling direction [1/m].
    """

    point: NDArray[np.intp]
    side: NDArray[np.intp]
    number: NDArray[np.intp]
    position: Position
    arc: Array
    gap: Array
    cosine: Array
    start: Array
    step: Array
    samples: Array
    curvature_x: Array

    @property
    def wheel(self) -> NDArray[np.intp]:
        """Index of the wheel among all wheels."""
        return 2 * self.point + self.side

    def part(self, rows: NDArray[Any]) -> Candidates:
        """Return some of the places."""
        found = {name: getattr(self, name)[rows] for name in self.__dataclass_fields__ if name != "position"}
        return Candidates(position=Position(*(array[rows] for array in self.position)), **found)


def candidates(section: Section, position: Position, touching: Touching) -> Candidates:
    """Return all places where wheels come close to their rails; positions are of shape (positions, sides)."""
    point, side, number = np.nonzero(~np.isnan(touching.arc))
    here = Position(*(array[point, side] for array in position))
    arc = touching.arc[point, side, number]
    place = placed(section, here, arc)
    count = arc.size
    found = Candidates(
        point, side, number, here, arc, touching.gap[point, side, number], np.cos(place.angle),
        np.empty(count), np.empty(count), np.empty((count, SAMPLES)), 0.5 * np.cos(place.angle) / place.radius,
    )  # fmt: skip
    sample(section, found, np.arange(count), SPACING)
    return found


def sample(section: Section, found: Candidates, rows: NDArray[np.intp], spacing: float) -> None:
    """Fill in, in place, the gaps around some of the places at a spacing [m]."""
    offsets = spacing * (np.arange(SAMPLES) - SAMPLES // 2)
    arc = found.arc[rows, None] + offsets
    outside = (arc < section.wheel_y.start) | (arc > section.wheel_y.end)
    at = gaps(section, Position(*(array[rows] for array in found.position)).widened(), arc)
    beside = (at.y < section.rail_z.start) | (at.y > section.rail_z.end)
    own = at.gap[:, SAMPLES // 2, None]
    rail = np.arctan(at.rail_slope)
    turned = np.abs(rail - rail[:, SAMPLES // 2, None]) > np.radians(60.0)
    normal = (at.gap - own) * np.cos(rail) / np.cos(rail - rail[:, SAMPLES // 2, None])
    found.start[rows] = offsets[0]
    found.step[rows] = spacing
    found.samples[rows] = np.where(outside | beside | turned, np.inf, normal)


def separated(found: Candidates, saddle: Array, penetration: Array) -> Candidates:
    """Return the places that are patches of their own, each with the gap on its own side of the saddles between them.

    Parameters
    ----------
    found : Candidates
    saddle : ndarray
        Vertical gap of the saddle between each place and the first one of its wheel [m].
    penetration : ndarray
        Estimate of the vertical penetration of each place's wheel [m].
    """
    own = (found.number == 0) | ((found.gap < SPARE * penetration) & (saddle > SEPARATE * penetration))
    kept = found.part(own)
    order = np.argsort(kept.wheel, kind="stable")
    for shift in (1, 2):
        for one, other in ((order[shift:], order[:-shift]), (order[:-shift], order[shift:])):
            same = kept.wheel[one] == kept.wheel[other]
            _cut(kept, one[same], kept.arc[other[same]])
    return kept


def _cut(found: Candidates, rows: NDArray[np.intp], neighbour: Array) -> None:
    """Make the gaps infinite, in place, beyond the saddle to a neighbour at an arc length of the wheel [m]."""
    if not rows.size:
        return
    offset = found.start[rows, None] + found.step[rows, None] * np.arange(SAMPLES)
    towards = np.sign(neighbour - found.arc[rows])[:, None]
    away = offset * towards
    between = (away >= 0.0) & (away <= np.abs(neighbour - found.arc[rows])[:, None])
    samples = found.samples[rows]
    highest = np.where(between & np.isfinite(samples), samples, -np.inf).argmax(axis=-1)
    border = np.take_along_axis(away, highest[:, None], axis=-1)
    found.samples[rows] = np.where(away > border, np.inf, samples)


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
        with np.errstate(invalid="ignore", divide="ignore"):
            secant = (value - self.value) / (self.x - self.before)
        self.slope = np.where((secant > 0.0) & np.isfinite(secant), secant, self.slope)
        self.low = np.where(going & (value < 0.0), self.x, self.low)
        self.high = np.where(going & (value > 0.0), self.x, self.high)
        trial = self.x + np.clip(-value / self.slope, -self.most, self.most)
        bounded = np.isfinite(self.low) & np.isfinite(self.high)
        middle = 0.5 * (np.where(bounded, self.low, trial) + np.where(bounded, self.high, trial))
        trial = np.where((trial <= self.low) | (trial >= self.high), middle, trial)
        self.before, self.value = np.where(going, self.x, self.before), np.where(going, value, self.value)
        self.x = np.where(going, trial, self.x)

    def closed(self) -> NDArray[np.bool_]:
        """Return where the bounds have met."""
        return self.high - self.low <= CLOSED * np.abs(self.x)

    def reopen(self) -> None:
        """Forget bounds that have met: they were found while something else was still moving."""
        closed = self.closed()
        self.low, self.high = np.where(closed, -np.inf, self.low), np.where(closed, np.inf, self.high)


@dataclass
class Balance:
    """The loads of a wheelset's patches at some positions."""

    section: Section
    elastic: Elastic
    task: Task
    found: Candidates
    hertz: bool
    strips: int
    penetration: Array
    """Vertical penetration of each wheel, h [m]."""
    rotation: Array
    """Speed of rotation at each position, Ω [rad/s]."""
    scale: Array
    """Factor on the pressure of each wheel's patches, 1 except where the load jumps as a hump joins a patch."""

    @classmethod
    def begun(
        cls, section: Section, elastic: Elastic, task: Task, position: Position, touching: Touching, hertz: bool,
        strips: int,
    ) -> Balance:  # fmt: skip
        """Return the loads without creep forces, under which the wheelset turns with the mean of its radii."""
        found = candidates(section, position, touching)
        first = found.number == 0
        wheels = 2 * task.load.size
        whole = np.zeros(wheels)
        whole[found.wheel[first]] = cls._alone(section, elastic, task, found, np.flatnonzero(first))
        saddle = touching.saddle[found.point, found.side, found.number]
        kept = separated(found, saddle, whole[found.wheel])
        radius = np.full(wheels, np.nan)
        first = kept.number == 0
        radius[kept.wheel[first]] = placed(section, kept.part(first).position, kept.arc[first]).radius
        rotation = task.speed / radius.reshape(-1, 2).mean(axis=-1) if task.rotation is None else task.rotation
        begun = cls(section, elastic, task, kept, hertz, strips, whole, rotation, np.ones(wheels))
        begun.solve(None)
        return begun

    def check_torque(self) -> None:
        """Raise an error for a torque that friction cannot transmit."""
        problem, patch = self.posed(self.found, self.penetration, self.rotation, self.scale)
        _, _, grip = self._sums(self.found, patch, problem, None)
        over = ~(np.abs(self.task.torque) < grip)
        if over.any():
            point = int(np.argmax(over))
            raise wl.ConditionsError(
                f"axle_torque: {self.task.torque[point]:.4g} N*m is more than friction can transmit, about"
                f" {grip[point]:.4g} N*m under this load"
            )

    @staticmethod
    def _alone(section: Section, elastic: Elastic, task: Task, found: Candidates, rows: NDArray[np.intp]) -> Array:
        """Return the vertical penetration if one patch of each wheel carries the whole load, and widen its samples."""
        penetration = np.empty(rows.size)
        open_ = np.arange(rows.size)
        for widening in range(WIDENINGS + 1):
            part = found.part(rows[open_])
            patch = _normal.loaded(
                part.start, part.step, np.maximum(part.samples, 0.0), part.curvature_x, elastic.modulus,
                task.load[part.point] / part.cosine, 5,
            )  # fmt: skip
            penetration[open_] = patch.penetration / part.cosine
            open_ = open_[patch.narrow]
            if not open_.size or widening == WIDENINGS:
                break
            sample(section, found, rows[open_], SPACING * 2.0 ** (widening + 1))
        return penetration

    def solve(self, forces: Callable[[wl.Problem], wl.CreepForces] | None) -> None:
        """Find the penetrations and the speeds of rotation that balance the loads, in place.

        Parameters
        ----------
        forces : callable or None
            Returns the creep forces of a problem with one entry for each patch. None leaves out the creep forces; the
            speed of rotation then stays as it is.
        """
        count = self.task.load.size
        free = self.task.rotation is None and forces is not None
        self.scale = np.ones(self.scale.shape)
        depths = _Root.begun(np.log(self.penetration), 1.5, WIDEST_STEP)
        turns = _Root.begun(self.rotation, np.nan, MOST_TURN * self.rotation)
        load = self.task.load.repeat(2)
        open_ = np.ones(count, dtype=np.bool_)
        for _ in range(STEPS):
            part = self.found.part(open_[self.found.point])
            problem, patch = self.posed(part, np.exp(depths.x), turns.x, self.scale)
            force = None if forces is None else forces(problem)
            carried, torque, grip = self._sums(part, patch, problem, force)
            excess = np.log(np.maximum(carried / load, LEAST_SHARE))
            lacking = torque - self.task.torque if free else np.zeros(count)
            level = (np.abs(excess) <= BALANCED).reshape(-1, 2).all(axis=-1)
            open_ &= ~(level & (np.abs(lacking) <= BALANCED * grip))
            if not open_.any():
                break
            wheels = open_.repeat(2)
            jump = wheels & depths.closed()
            self.scale = np.where(jump, self.scale * np.exp(-excess), self.scale)
            depths.step(excess, wheels & ~jump)
            if free:
                if np.isnan(turns.slope).all():
                    turns.slope = self._stiffness(part, patch, problem)
                turns.reopen()
                turns.step(lacking, open_)
        self.penetration, self.rotation = np.exp(depths.x), turns.x

    def _sums(
        self, part: Candidates, patch: Patches, problem: wl.Problem, force: wl.CreepForces | None
    ) -> tuple[Array, Array, Array]:
        """Return the vertical load of each wheel [N], the torque of each axle and that of full slip [N m]."""
        count = self.task.load.size
        vertical = patch.normal_force * np.cos(patch.place.angle)
        torque = np.zeros(part.point.size)
        if force is not None:
            side = np.where(part.side == 1, 1.0, -1.0)
            vertical = vertical + side * force.lateral * np.sin(patch.place.angle)
            parts = zip((force.longitudinal, force.lateral, force.spin_moment), patch.creepages.turning, strict=True)
            torque = problem.rolling_speed * sum(one * other for one, other in parts)
        grip = problem.friction_coefficient * patch.normal_force * patch.place.radius
        load = np.bincount(part.wheel, vertical, 2 * count)
        load[np.bincount(part.wheel, minlength=2 * count) == 0] = 1.0
        torques, grips = (np.asarray(np.bincount(part.point, one, count), np.float64) for one in (torque, grip))
        return np.asarray(load, np.float64), torques, grips

    def _stiffness(self, part: Candidates, patch: Patches, problem: wl.Problem) -> Array:
        """Return the rate of the torque with the speed of rotation, by Kalker's linear theory [N m s]."""
        c11 = wl.kalker.coefficients(problem.a / problem.b, self.elastic.poisson_ratio).c11
        rate = self.elastic.shear_modulus * problem.a * problem.b * c11 * patch.place.radius**2 / problem.rolling_speed
        return np.maximum(np.bincount(part.point, rate, self.task.load.size), 1e-300)

    def posed(self, part: Candidates, penetration: Array, rotation: Array, scale: Array) -> tuple[wl.Problem, Patches]:
        """Return the contact problem of some patches, with one entry for each, and the patches."""
        depth = penetration[part.wheel]
        normal = np.maximum(depth - part.gap, LEAST * depth) * part.cosine
        task, elastic = self.task, self.elastic
        side = np.where(part.side == 1, 1.0, -1.0)
        patch = self._ellipse(part, normal) if self.hertz else self._strips(part, normal, scale[part.wheel])
        arc = part.arc + patch.pop("centre")
        place = placed(self.section, part.position, arc)
        sliding = creepages(
            part.position, place, task.speed[part.point], side * task.lateral_velocity[part.point],
            side * task.turn_rate[part.point], side * task.roll_rate[part.point], side,
        )  # fmt: skip
        flange = (np.abs(place.angle) > task.flange_angle).astype(np.intp)
        longitudinal, lateral, spin = sliding.at(rotation[part.point])
        make: Callable[..., wl.Problem] = wl.Problem.ellipse_from_si if self.hertz else wl.Problem.of_strips
        problem = make(
            **patch,
            shear_modulus=np.full(side.shape, elastic.shear_modulus),
            poisson_ratio=np.full(side.shape, elastic.poisson_ratio),
            density=np.full(side.shape, elastic.density),
            friction_coefficient=task.friction[part.point, flange],
            longitudinal_creepage=longitudinal,
            lateral_creepage=lateral,
            spin=spin,
            rolling_speed=task.speed[part.point],
            contact_angle=side * place.angle,
        )
        return problem, Patches(problem.normal_force, arc, place, sliding, depth > part.gap)

    def _strips(self, part: Candidates, penetration: Array, scale: Array) -> dict[str, Any]:
        """Return the strips of patches at penetrations normal to the surface [m], and the semi-axes and the centre."""
        found = _normal.penetrated(
            part.start, part.step, np.maximum(part.samples, 0.0), part.curvature_x, self.elastic.modulus, penetration,
            self.strips,
        )  # fmt: skip
        right = (part.side == 1)[:, None]
        across = np.where(right, 1.0, -1.0) * (found.y - found.centre[:, None])
        arrays = {
            "y": across,
            "width": found.width,
            "half_length": found.half_length,
            "max_pressure": found.pressure * scale[:, None],
        }  # y grows on the left too
        strips = {name: np.where(right, array, array[:, ::-1]) for name, array in arrays.items()}
        return {"strips": wl.Strips(**strips), "a": found.a, "b": found.b, "centre": found.centre}

    def _ellipse(self, part: Candidates, penetration: Array) -> dict[str, Any]:
        """Return Hertz's ellipses of the curvatures at first touching."""
        at = placed(self.section, part.position, part.arc)
        across = 0.5 * (self.section.wheel.at(part.arc)[3] + self.section.rail.at(at.rail_arc)[3])
        unit = _normal.hertz(part.curvature_x, across, self.elastic.modulus, np.ones(across.shape))
        share = np.sqrt(penetration / unit.penetration)
        return {"a": unit.a * share, "b": unit.b * share, "normal_force": share**3, "centre": np.zeros(across.shape)}


@dataclass(frozen=True)
class Patches:
    """What the balance reads of patches: N, arc length of the wheel, place, creepages, and whether they touch."""

    normal_force: Array
    arc: Array
    place: Place
    creepages: Creepages
    touch: NDArray[np.bool_]
