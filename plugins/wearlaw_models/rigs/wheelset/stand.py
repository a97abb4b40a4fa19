"""Loads of a wheelset on its rails, and their balance with the creep forces.

On each wheel the pressure carries the vertical load together with the lateral creep forces, and the torque about the
axle is the given one:

    ∑ (N cos δ + Fy sin δ) = Q,  V ∑ (Fx ∂ξ/∂Ω + Fy ∂η/∂Ω + Mz ∂φ/∂Ω) = M.

The unknowns are the height of the axle and, unless it is given, its roll, or the heights of both wheels; and the speed
of rotation Ω. The overlap of the bodies is linear in heights and roll, so the pressure and they are found together. Of
the creep forces only Fy/N of each patch enters there. It hardly depends on the load, so a few rounds of pressure and
creep forces are enough; the rates of the creep forces with Ω are estimated.

Rows are laid where the wheel stands under its load alone, or where it is expected by rates of an earlier state. Where
it moves along the rail by more than `SHIFT`, they are laid again.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

import wearlaw as wl
from wearlaw import Array
from wearlaw_models.rigs.wheelset.motion import Creepages, Place, creepages, roll_rate
from wearlaw_models.rigs.wheelset.patches import Patches
from wearlaw_models.rigs.wheelset.pressure import TINY, Pressed
from wearlaw_models.rigs.wheelset.rows import SPARE, Near, Rows, Samples, near, rows
from wearlaw_models.rigs.wheelset.search import Position, Section, both_sides
from wearlaw_models.rigs.wheelset.search_loops import LEAST_LEVER, PATCHES
from wearlaw_models.rigs.wheelset.sequence import Sequence
from wearlaw_models.rigs.wheelset.task import Elastic, Patch, Task

BALANCED = 1e-6
"""Greatest imbalance, as a share of the load, and of the torque of full slip, after which the search ends."""

STEPS = 30
"""Most rounds of pressure and creep forces, of which four or five are usual."""

TOGETHER = 8
"""Rounds after which rows that have been in one patch stay in one: patches that part and meet have other forces."""

SCALE = 100.0
"""Change of Fy/N that counts as much as a change of the speed of rotation by all of it."""

SHIFT = 5e-5
"""Distance along the rail by which a wheel moves before its rows are laid again [m]."""

LEAST_WEIGHT = 0.02
"""Least part of a normal force that counts as bearing a wheel while pressure is sought, since loads grow with it; what
friction takes off beyond that is made up for in the next round."""

WITHIN, SLID = 1e-5, 5e-5
"""Longest way aside within rows [m], and the lateral force that may be left over, over the load of a wheel."""

EDGE = 0.25
"""Least maximum pressure of a strip over the greater one of its neighbours: a row begins to touch on part of its width,
so that areas do not jump."""

MOST_TURN = 0.01
"""Greatest step of the speed of rotation, as a share of it."""

LOST, DEEP = 0.8, 4.0
"""Shares of the estimated approach by which a wheel may lack or exceed it before it is put back on its rail."""

WIDEST_ROLL = 1e-3
"""Greatest change of the roll by the estimated approach of both wheels [rad]."""

TOUCH = 1e-3
"""Force of a wheel that is lost for a while [N]."""

STILL = 0.05
"""Imbalance of the vertical loads, over that of the torque, below which bounds of the speed of rotation hold."""

POWER = 0.3
"""Exponent of 1 - f, the share of full slip that is missing, in the creepage of FASTSIM on an ellipse."""

FULL = 0.999
"""Greatest share of full slip that the rates of creep forces count with, so that they never vanish."""


def _held(
    section: Section, samples: Samples, elastic: Elastic, task: Task, height: Array, roll: Array, position: Position,
    around: Near,
) -> tuple[Array, Array, Position, Near]:  # fmt: skip
    """Return heights and rolls at which no wheel is lost, as one may be by a step that was too long."""
    for _ in range(2):
        least = around.gap.min(axis=-1)
        least = np.where(np.isfinite(least), least, height.reshape(-1))  # beside the rail
        depth = around.sunk(task.load.reshape(-1), least, elastic.modulus)
        lacks = (depth - (height.reshape(-1) - least)).reshape(-1, 2)
        share = lacks / depth.reshape(-1, 2)
        lacks = np.where(((share > LOST) | (share < -DEEP)).any(axis=-1, keepdims=True), lacks, 0.0)
        if not lacks.any():
            break
        if task.free:
            lowest = around.gap.argmin(axis=-1)
            lever = around.lean[np.arange(lowest.size), lowest].reshape(-1, 2)
            change = (lacks[:, 1] - lacks[:, 0]) / np.maximum(np.abs(lever.sum(axis=-1)), LEAST_LEVER)
            change = np.clip(change, -WIDEST_ROLL, WIDEST_ROLL)
            roll = roll + change
            lacks = (lacks - lever * change[:, None] * (-1.0, 1.0)).mean(axis=-1, keepdims=True) + np.zeros(2)
            pairs = both_sides(task.displacement, roll, task.yaw)
            position = Position(*(np.ascontiguousarray(array).reshape(-1) for array in pairs))
            around = near(section, position, samples)
        height = height + lacks
    return height, roll, position, around


class Creeping(NamedTuple):
    """What rows that are laid anew take over from earlier ones, in the order of `keys`.

    Attributes
    ----------
    points, rotation : ndarray, (positions,)
        Positions of the whole task in their order, and their speeds of rotation over `Stand.rolling` [-].
    keys : ndarray, (rows,)
        Twenty times the position, ten more on the right, and the arc length of the rail [m].
    ratio, sine : ndarray, (rows,)
        As in `Stand`.
    """

    points: NDArray[np.intp]
    rotation: Array
    keys: Array
    ratio: Array
    sine: Array

    def of(self, points: NDArray[np.intp], wheel: NDArray[np.intp], arc: Array) -> tuple[Array, Array, Array]:
        """Return rotation of positions, and ratio and sine of the rows nearest to other rows of theirs."""
        keys = 20.0 * points[wheel // 2] + 10.0 * (wheel % 2) + arc
        after = np.clip(np.searchsorted(self.keys, keys), 1, self.keys.size - 1)
        nearest = np.where(keys - self.keys[after - 1] < self.keys[after] - keys, after - 1, after)
        return self.rotation[np.searchsorted(self.points, points)], self.ratio[nearest], self.sine[nearest]


@dataclass(eq=False)
class Stand:
    """Wheelsets on their rails at some positions, whose rows stay while their loads are balanced.

    Attributes
    ----------
    points : ndarray of int
        Which positions of the whole task these are.
    height : ndarray, (positions, 2)
        Height of the axle at which the rows were laid, for each wheel, positive down [m].
    roll : ndarray
        Roll there [rad].
    ratio, sine : ndarray, (rows,)
        Lateral creep force over the normal force of the patch of each row, and the patch's sin δ, in the track's axes.
    linked : ndarray of bool, (rows,), or None
        After some rounds, whether rows have been in one patch with those before them.
    rotation : ndarray
        Speed of rotation, Ω [rad/s].
    left : ndarray, (positions, 4)
        What is left over: shares of the loads of both wheels, of the torque of full slip, and of the load of a wheel as
        a lateral force.
    """

    section: Section
    elastic: Elastic
    task: Task
    points: NDArray[np.intp]
    height: Array
    roll: Array
    rows: Rows
    pressed: Pressed
    sliding: Creepages
    ratio: Array
    sine: Array
    rotation: Array
    left: Array
    vertical: Array
    lateral: Array
    patches: Patches = field(init=False)
    of_row: tuple[NDArray[np.intp], NDArray[np.intp]] = field(init=False)
    linked: NDArray[np.bool_] | None = field(init=False, default=None)

    @classmethod
    def laid(
        cls, section: Section, samples: Samples, elastic: Elastic, task: Task, points: NDArray[np.intp], height: Array,
        roll: Array, least: Array | None = None, before: Creeping | None = None,
    ) -> Stand:  # fmt: skip
        """Return wheelsets with rows at heights and rolls; with the least gaps of rigid wheels, at those under load."""
        pairs = both_sides(task.displacement, roll, task.yaw)
        position = Position(*(np.ascontiguousarray(array).reshape(-1) for array in pairs))
        around = near(section, position, samples)
        if least is not None:
            depth = around.sunk(task.load.reshape(-1), height.reshape(-1), elastic.modulus).reshape(-1, 2)
            if task.free:
                lever = np.maximum(np.abs(least.sum(axis=-1)), LEAST_LEVER)
                change = np.clip((depth[:, 1] - depth[:, 0]) / lever, -WIDEST_ROLL, WIDEST_ROLL)
                roll = roll + change
                depth = (depth - least * change[:, None] * (-1.0, 1.0)).mean(axis=-1, keepdims=True) + np.zeros(2)
                pairs = both_sides(task.displacement, roll, task.yaw)
                position = Position(*(np.ascontiguousarray(array).reshape(-1) for array in pairs))
                around = around.rolled((change[:, None] * (-1.0, 1.0)).reshape(-1))
            height = height + depth
        else:
            height, roll, position, around = _held(section, samples, elastic, task, height, roll, position, around)
        laid = rows(section, samples, position, height.reshape(-1), around)
        side = np.where(laid.wheel % 2 == 1, 1.0, -1.0)
        right = laid.wheel % 2
        if task.free:
            rates: Any = [laid.down, side * laid.lean]
        else:
            rates = [laid.down * (1 - right), laid.down * right]
        rates = np.stack([*rates, side * laid.out], axis=-1)
        pressed = Pressed.begun(laid, elastic.modulus, rates, task.loops)
        none, count = np.zeros(side.shape), roll.size
        stand = cls(
            section, elastic, task, points, height, roll, laid, pressed, Creepages((none,) * 3, (none,) * 3), none,
            none, np.zeros(count), np.zeros((count, 4)), np.zeros((count, 2)), np.zeros((count, 2)),
        )  # fmt: skip
        if before is not None:
            stand.rotation, stand.ratio, stand.sine = before.of(points, laid.wheel, laid.place.rail_arc)
        stand._carry(np.ones(count, dtype=np.bool_))
        force = stand._row_force()
        turn = np.zeros(count)
        if task.free:
            turn = stand._roll_rate(force)
        point = laid.wheel // 2
        stand.sliding = creepages(
            Position(*(array[laid.wheel] for array in position)), laid.place, task.speed[point],
            side * task.lateral_velocity[point], side * task.turn_rate[point], side * turn[point], side,
            section.roller,
        )  # fmt: skip
        if task.rotation is not None:
            stand.rotation = task.rotation.copy()
        else:
            stand.rotation = stand.rolling * (1.0 if before is None else stand.rotation)
        stand.patches = stand._found()
        stand._sum(None, stand.patches)
        return stand

    @property
    def creeping(self) -> Creeping:
        """Return what rows that are laid anew take over."""
        wheel = self.rows.wheel
        keys = 20.0 * self.points[wheel // 2] + 10.0 * (wheel % 2) + self.rows.place.rail_arc
        return Creeping(self.points, self.rotation / self.rolling, keys, self.ratio, self.sine)

    @property
    def rolling(self) -> Array:
        """Speed of rotation with which the mean of the rolling radii by force rolls [rad/s]."""
        point, force, count = self.rows.wheel // 2, self._row_force() + TINY, self.roll.size  # both wheels may be lost
        rolls = self.rows.place.radius / (1.0 - self.section.roller * self.rows.place.rail_z)
        mean = np.bincount(point, force * rolls, count) / np.bincount(point, force, count)
        return np.asarray(self.task.speed / mean)

    def copy(self) -> Stand:
        """Return a copy whose loads change on their own."""
        copy = replace(self, pressed=self.pressed.copy())
        for name in ("ratio", "sine", "left", "vertical", "lateral"):
            setattr(copy, name, getattr(self, name).copy())
        copy.patches, copy.of_row = self.patches, self.of_row
        return copy

    def _row_force(self) -> Array:
        point = self.rows.wheel // 2
        forces = self.pressed.forces
        force: Array = forces[:, 0] + (forces[:, 1:] * self.pressed.moved[point]).sum(axis=-1)
        return np.maximum(force, 0.0)

    def _carry(self, some: NDArray[np.bool_]) -> None:
        """Find the pressure that carries the loads with the creep forces as they are, at some positions."""
        rows = self.rows
        right, angle = np.where(rows.wheel % 2 == 1, 1.0, 0.0), rows.place.angle
        bears = np.cos(angle) + self.ratio * self.sine
        weight = np.maximum(bears, LEAST_WEIGHT)
        self.pressed.weights = np.stack([weight * (1 - right), weight * right], axis=-1)
        held = np.bincount(rows.wheel, (weight - bears) * self._row_force(), self.task.load.size)
        self.pressed.carry(self.task.load + held.reshape(-1, 2), np.flatnonzero(some))

    def _across(self) -> Array:
        """Return what the force of each row adds to the sum of the lateral forces [-]."""
        angle, side = self.rows.place.angle, np.where(self.rows.wheel % 2 == 1, 1.0, -1.0)
        return np.asarray(-side * np.sin(angle) + self.ratio * np.sqrt(np.maximum(1.0 - self.sine**2, 0.0)))

    def _roll_rate(self, force: Array) -> Array:
        """Return the roll velocity at which both wheels stay on their rails [rad/s]."""
        rows, count = self.rows, self.roll.size

        def mean(values: Array) -> Array:
            weight = force + TOUCH  # a wheel may be lost for a while
            sums = np.bincount(rows.wheel, weight * values, 2 * count) / np.bincount(rows.wheel, weight, 2 * count)
            return np.asarray(sums).reshape(-1, 2)

        x, y, z, angle, rail_z = (mean(array) for array in rows.place[:5])
        place = Place(x, y, z, angle, rail_z, np.zeros(0), np.zeros(0))
        return roll_rate(place, self.task.lateral_velocity, self.task.yaw_velocity, self.section.roller)

    def _found(self) -> Patches:
        """Return the patches: rows that touch and lie beside each other, at most `PATCHES` of them on each side."""
        rows, force = self.rows, self._row_force()
        most, crest = self.pressed.peaks()
        touches = (force > 0.0) & (most > 0.0)
        lost = ~np.logical_or.reduceat(touches, rows.start[:-1])
        if lost.any():  # for a while, while loads are balanced
            overlap = self.pressed.overlap()
            lowest = [
                first + overlap[first:last].argmax()
                for first, last in zip(rows.start[:-1][lost], rows.start[1:][lost], strict=True)
            ]
            force[lowest], most[lowest], touches[lowest] = TOUCH, 1.0, True
        at = np.flatnonzero(touches)
        wheel, arc = rows.wheel[at], rows.place.rail_arc[at]
        gap = np.diff(arc, prepend=-np.inf) - 0.5 * (rows.width[at] + np.roll(rows.width[at], 1))
        first_row, apart = np.diff(wheel, prepend=-1) != 0, gap > 0.25 * rows.width[at]
        if self.linked is not None:
            apart &= np.diff(np.cumsum(~self.linked)[at], prepend=-1) > 0
        begins = first_row | apart
        for crowded in np.flatnonzero(np.bincount(wheel[begins]) > PATCHES):  # join those that are nearest
            inner = np.flatnonzero(begins & (wheel == crowded))[1:]
            begins[inner[np.argsort(gap[inner])[: 1 - PATCHES]]] = False
        first, patch = np.flatnonzero(begins), np.cumsum(begins) - 1
        self.of_row = at, patch
        if self.linked is not None:
            step = np.zeros(rows.wheel.size + 1, dtype=np.intp)
            step[at[:-1][~begins[1:]] + 1] += 1
            step[at[1:][~begins[1:]] + 1] -= 1
            self.linked |= np.cumsum(step[:-1]) > 0
        count, size = first.size, np.diff(np.append(np.flatnonzero(begins), at.size))
        of, point = wheel[first], wheel[first] // 2
        side = np.where(of % 2 == 1, 1.0, -1.0)
        force, most, crest, width, angle = force[at], most[at], crest[at], rows.width[at], rows.place.angle[at]
        before, after = np.where(begins, 0.0, np.roll(most, 1)), np.where(np.roll(begins, -1), 0.0, np.roll(most, -1))
        beside = np.maximum(before, after)
        half_length, part = 2.0 / np.pi * force / (width * most), most / np.maximum(most, EDGE * beside)
        arc = arc + 0.5 * width * (1.0 - part) * (after - before) / np.maximum(beside, TINY)
        most, width = most / part, width * part
        whole = np.add.reduceat(force, first)

        def mean(values: Array) -> Array:
            return np.asarray(np.add.reduceat(force * values, first) / whole)

        sunk = self.pressed.overlap()[at] / np.cos(angle)
        approach = np.maximum.reduceat(sunk, first)
        order = np.lexsort((-approach, of))
        number = np.empty(count, dtype=np.intp)
        number[order] = (
            np.arange(count)
            - np.flatnonzero(np.diff(of[order], prepend=-1))[np.cumsum(np.diff(of[order], prepend=-1) != 0) - 1]
        )
        middle = mean(arc)
        a = np.maximum.reduceat(half_length, first)
        b = 2.0 / np.pi * np.add.reduceat(half_length * width, first) / a
        slot = np.arange(at.size) - first[patch]
        slot = np.where(side[patch] > 0.0, slot, size[patch] - 1 - slot)
        strips = {name: np.zeros((count, size.max())) for name in ("y", "width", "half_length", "max_pressure", "x")}
        values = side[patch] * (arc - middle[patch]), width, half_length, most, crest - mean(crest)[patch]
        for array, value in zip(strips.values(), values, strict=True):
            array[patch, slot] = value
        moved = [np.zeros((count, size.max())) for _ in range(6)]
        means = []
        for array, rate in zip(moved, (*self.sliding.still, *self.sliding.turning), strict=True):
            array[patch, slot] = rate[at]
            means.append(mean(rate[at]))
        across, upright = -mean(np.sin(angle)), mean(np.cos(angle))
        return Patches(
            point, of % 2, number, whole, across, upright, mean(rows.wheel_arc[at]), middle,
            mean(rows.place.radius[at]), mean(rows.place.rail_z[at]), approach,
            mean(np.where(np.abs(angle) > self.task.flange_angle, 1.0, 0.0)),
            Creepages(tuple(means[:3]), tuple(means[3:])), a, b, strips, Creepages(tuple(moved[:3]), tuple(moved[3:])),
        )  # fmt: skip

    def _sum(self, force: wl.CreepForces | None, patches: Patches, friction: Array | None = None) -> Array:
        """Note the loads of some patches and what they leave over at their positions; return excess torques [N m].

        `friction` are the friction coefficients of the patches.
        """
        count, task = self.roll.size, self.task
        wheel, sign = 2 * patches.point + patches.side, patches.sign
        vertical, lateral = patches.force * patches.upright, sign * patches.force * patches.across
        torque: Any = np.zeros(count)
        grip: Any = np.ones(count)
        if force is not None:
            vertical = vertical + sign * np.sin(patches.angle) * force.lateral
            lateral = lateral + np.cos(patches.angle) * force.lateral
            parts = zip((force.longitudinal, force.lateral, force.spin_moment), patches.sliding.turning, strict=True)
            power = task.speed[patches.point] * sum(part * rate for part, rate in parts)
            assert friction is not None
            torque = np.bincount(patches.point, power, count)
            grip = np.bincount(patches.point, friction * patches.force * patches.radius, count)
        some = np.bincount(patches.point, minlength=count) > 0
        sums = (np.bincount(wheel, of, 2 * count).reshape(-1, 2) for of in (vertical, lateral))
        for array, values in zip((self.vertical, self.lateral), sums, strict=True):
            array[some] = values[some]
        self.left[some, :2] = np.abs(self.vertical / task.load - 1.0)[some]
        if force is not None and task.rotation is None:
            self.left[some, 2] = np.abs((torque - task.torque) / np.maximum(grip, TINY))[some]
        if task.lateral_force is not None:
            lacks = self.lateral.sum(axis=-1) - task.lateral_force
            self.left[some, 3] = np.abs(lacks / task.load.mean(axis=-1))[some]
        return np.asarray(torque - task.torque)

    def balance(
        self, forces: Callable[[wl.Problem], wl.CreepForces], patch: Patch, last: bool, goal: Array,
        slides: NDArray[np.bool_], going: NDArray[np.bool_],
    ) -> None:  # fmt: skip
        """Balance the loads with the creep forces, in place, at positions that are `going`.

        `goal` is the greatest imbalance of each position. Wheelsets that slide move aside within their rows, by up to
        `WITHIN`, to where the rails bear their lateral force.
        """
        task, count = self.task, self.roll.size
        sequence, scale, of_load = Sequence(), SCALE / self.rotation, np.ones(count)
        if slides.any():
            of_load = np.maximum(self.rates[:, 2], TINY) / task.load.mean(axis=-1)
        low, high = np.full(count, -np.inf), np.full(count, np.inf)
        best = np.full(count, np.inf)
        kept = self.ratio.copy(), self.sine.copy(), self.rotation.copy()
        for step in range(STEPS + 1):
            if step == STEPS:  # creep forces jump; the nearest state that was met stays
                rows = going[self.rows.wheel // 2]
                self.ratio, self.sine = (
                    np.where(rows, *pair) for pair in zip(kept[:2], (self.ratio, self.sine), strict=True)
                )
                self.rotation = np.where(going, kept[2], self.rotation)
            if step:
                self._carry(going)
                if step == TOGETHER:
                    self.linked = np.zeros(self.rows.wheel.size, dtype=np.bool_)
                self.patches = self._found()
            some = self.patches.part(going[self.patches.point])
            problem = some.posed(task, self.elastic, self.rotation, patch)
            force = forces(problem)
            excess = self._sum(force, some, problem.friction_coefficient)
            most = self.left[:, :3].max(axis=-1)
            nearer, best = most < best, np.minimum(most, best)
            rows = nearer[self.rows.wheel // 2]
            kept = (
                np.where(rows, self.ratio, kept[0]), np.where(rows, self.sine, kept[1]),
                np.where(nearer, self.rotation, kept[2]),
            )  # fmt: skip
            aside = self._aside(slides)
            going = going & ((most > goal) | ((aside != 0.0) & (self.left[:, 3] > SLID)))
            if step and not last:
                going &= self.shift <= 1.0
            if not going.any() or step == STEPS:
                return
            rate, drift = self._rates(some, problem, force)
            turn, widest = np.zeros(count), MOST_TURN * self.rotation
            if task.rotation is None:
                turn = np.clip(-excess / np.maximum(rate, TINY), -widest, widest)
            row, of = self.of_row
            used = self.ratio[row[np.flatnonzero(np.diff(of, prepend=-1))]]
            slot = some.point, 2 + some.side * PATCHES + some.number
            now, new = np.zeros((2, count, 2 + 2 * PATCHES))
            now[:, 1] = self.pressed.moved[:, 2] * of_load
            new[:, 1] = now[:, 1] + aside * of_load
            now[:, 0] = self.rotation * scale
            new[:, 0] = (self.rotation + turn) * scale
            now[slot] = used[np.isin(self.patches.point, some.point)]
            new[slot] = (force.lateral + drift * turn[some.point]) / some.force
            new = sequence.next(now, new)
            there = np.where(going & slides, np.clip(new[:, 1] / of_load, -WITHIN, WITHIN), self.pressed.moved[:, 2])
            still = there == self.pressed.moved[:, 2]
            self.pressed.moved[:, 2] = there
            if task.rotation is None:
                ahead = np.clip(new[:, 0] / scale, self.rotation - widest, self.rotation + widest)
                # The torque grows with Ω, steeply at first and then hardly, so bounds help once the loads hardly move
                # and the wheelset stays where it is.
                still &= self.left[:, :2].max(axis=-1) < STILL * self.left[:, 2]
                low = np.where(still, np.where(excess < 0.0, self.rotation, low), -np.inf)
                high = np.where(still, np.where(excess > 0.0, self.rotation, high), np.inf)
                ahead = np.where((ahead <= low) | (ahead >= high), self.rotation + turn, ahead)
                beyond = ((ahead <= low) | (ahead >= high)) & np.isfinite(low) & np.isfinite(high)
                ahead[beyond] = 0.5 * (low[beyond] + high[beyond])
                self.rotation = np.where(going, ahead, self.rotation)
            bound = problem.friction_coefficient
            ratio = np.zeros(self.patches.force.size)
            ratio[np.isin(self.patches.point, some.point)] = np.clip(new[slot], -bound, bound)
            self._push(ratio, going)

    def _push(self, ratio: Array, going: NDArray[np.bool_]) -> None:
        """Set the lateral creep forces of rows by those of patches over their normal forces, in place."""
        row, patch = self.of_row
        place = np.searchsorted(row, np.arange(self.ratio.size))  # rows that do not touch take what the next ones have
        place = np.minimum(place, row.size - 1)
        wheel = self.rows.wheel
        place = np.where((wheel[row[place]] != wheel) & (place > 0), place - 1, place)
        mine, some = patch[place], going[wheel // 2]
        sine = self.patches.sign * np.sin(self.patches.angle)
        self.ratio, self.sine = np.where(some, ratio[mine], self.ratio), np.where(some, sine[mine], self.sine)

    def _rates(self, patches: Patches, problem: wl.Problem, force: wl.CreepForces) -> tuple[Array, Array]:
        """Return estimates of the rates with Ω of the torques of axles, and of the lateral forces of patches.

        The creep forces start with Kalker's rates. As f, their share of μN, grows, the rate along the force falls to
        (1 - f)^0.7, and that across it to f/x with 1 - f = (1 - 0.3 x)^(10/3). This is FASTSIM on an ellipse within
        1 %, x being the force of the linear theory over μN; in full slip, that at the present creepages.
        """
        size, bound = np.maximum(force.tangential, TINY), problem.friction_coefficient * patches.force
        x, y = force.longitudinal / size, force.lateral / size
        share = np.minimum(size / bound, FULL)
        c = wl.kalker.coefficients(patches.a / patches.b, self.elastic.poisson_ratio)
        stiffness, width = self.elastic.shear_modulus * patches.a * patches.b, np.sqrt(patches.a * patches.b)
        whole = np.hypot(
            c.c11 * problem.longitudinal_creepage, c.c22 * problem.lateral_creepage + c.c23 * width * problem.spin
        )
        slope, linear = (1.0 - share) ** (1.0 - POWER), -np.expm1(POWER * np.log1p(-share)) / POWER
        across = share / np.maximum(np.maximum(linear, stiffness * whole / bound), TINY)
        slope = np.minimum(slope, across)
        xi, eta, phi = patches.sliding.turning
        linear_x, linear_y = stiffness * c.c11 * xi, stiffness * (c.c22 * eta + c.c23 * width * phi)
        along = (slope - across) * (x * linear_x + y * linear_y)
        force_x, force_y = across * linear_x + along * x, across * linear_y + along * y
        power = problem.rolling_speed * (xi * force_x + eta * force_y)
        return np.asarray(np.bincount(patches.point, power, self.roll.size), np.float64), force_y

    def _aside(self, slides: NDArray[np.bool_]) -> Array:
        """Return how far wheelsets that slide are from where the rails bear their lateral forces, by rates [m]."""
        if self.task.lateral_force is None or not slides.any():
            return np.zeros(slides.shape)
        rate, now = self.rates[:, 2], self.pressed.moved[:, 2]
        step = (self.task.lateral_force - self.lateral.sum(axis=-1)) / np.where(rate > 0.0, rate, np.inf)
        return np.where(slides, np.clip(now + step, -WITHIN, WITHIN) - now, 0.0)

    @property
    def displacement(self) -> Array:
        """Lateral displacement, to which wheelsets may have slid [m]."""
        return np.asarray(self.task.displacement + self.pressed.moved[:, 2])

    @property
    def shift(self) -> Array:
        """How far wheels have moved since their rows were laid, over what these allow: along the rail, and into it."""
        rows, point = self.rows, self.rows.wheel // 2
        height, roll = self.now
        side = np.where(rows.wheel % 2 == 1, 1.0, -1.0)
        lowered = (height - self.height)[point, rows.wheel % 2]
        leaned = side * (roll - self.roll)[point]
        angle = rows.place.angle
        aside = side * self.pressed.moved[point, 2] - rows.place.z * leaned
        moved = aside * np.cos(angle) + (lowered + rows.place.y * leaned) * np.sin(angle)
        shift = np.zeros(self.roll.size)
        np.maximum.at(shift, point, np.where(self._row_force() > 0.0, np.abs(moved) / SHIFT, 0.0))
        sunk = (self.pressed.overlap() - rows.overlap) / (SPARE * rows.deepest[rows.wheel])
        np.maximum.at(shift, point, sunk)
        return shift

    @property
    def now(self) -> tuple[Array, Array]:
        """Heights of the axle at both wheels, (positions, 2) [m], and the roll [rad]."""
        moved = self.pressed.moved
        if self.task.free:
            return self.height + moved[:, :1], self.roll + moved[:, 1]
        return self.height + moved[:, :2], self.roll

    @property
    def next_place(self) -> tuple[Array, Array]:
        """Heights of the axle at both wheels [m] and rolls [rad] at which rows are laid next.

        A wheelset rolls about one wheel's contact, and a flank of the other that is steeper than its way bears more the
        higher it goes. Nothing stays in balance there, and what balances loads by rates lies the other way.
        """
        height, roll = self.now
        if self.task.free:
            over = np.linalg.det(self._load_rates[:, :2, :2]) < 0.0
            height = np.where(over[:, None], 2.0 * self.height - height, height)
            roll = np.where(over, 2.0 * self.roll - roll, roll)
        return height, roll

    @property
    def _load_rates(self) -> Array:
        """Rates of the loads of both wheels and of the sum of the lateral forces with the displacements, (., 3, .)."""
        rows, forces = self.rows, self.pressed.forces[:, 1:]
        weights = np.concatenate([self.pressed.weights, self._across()[:, None]], axis=-1)
        return np.asarray(np.add.reduceat(weights[:, :, None] * forces[:, None, :], rows.start[:-1:2]))

    @property
    def rates(self) -> Array:
        """Rates with the lateral displacement under the same loads, without slip's change, (positions, 3).

        The first are those of the heights of the axle at both wheels [-], or of its height and its roll [rad/m], where
        the roll is free; the last is that of the sum of the lateral forces [N/m].
        """
        sums = self._load_rates
        moves = np.asarray(-np.linalg.solve(sums[:, :2, :2], sums[:, :2, 2:]), np.float64)
        return np.concatenate([moves, sums[:, 2:, 2:] + sums[:, 2:, :2] @ moves], axis=1)[..., 0]

    def ahead(self, displacement: Array) -> tuple[Array, Array]:
        """Return heights of the axle [m] and rolls [rad] at other displacements [m], by their rates."""
        (height, roll), moves = self.now, self.rates * (displacement - self.displacement)[:, None]
        if self.task.free:
            return height + moves[:, :1], roll + moves[:, 1]
        return height + moves[:, :2], roll
