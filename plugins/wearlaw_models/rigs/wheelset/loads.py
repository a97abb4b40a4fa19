"""The loads of a wheelset at all positions, which are solved in blocks, and laid again where wheels move far."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from copy import copy
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

import wearlaw as wl
from wearlaw import Array
from wearlaw_models.rigs.wheelset.motion import placed
from wearlaw_models.rigs.wheelset.patches import Patches, joined
from wearlaw_models.rigs.wheelset.rows import Samples
from wearlaw_models.rigs.wheelset.search import Section, Touching, both_sides
from wearlaw_models.rigs.wheelset.stand import BALANCED, Creeping, Stand
from wearlaw_models.rigs.wheelset.task import Elastic, Patch, Task

AGAIN, WHOLE = 8, 3
"""How often rows of a position are laid again at most, and from which one on loads are balanced before the next."""

FARTHEST, MOST_ROLL = 0.5e-3, 1e-3
"""Greatest changes of the height [m] and of the roll [rad] from one laying of rows to the next."""

BLOCK = 64
"""Positions that are solved at once: the influences of their elements take some 20 MB."""

OUTWARDS = 0.2e-3
"""Longest step outwards on a flange [m]."""

ROUGH, PASSING = 1e-3, 1e-2
"""Greatest imbalance of a result, and of a position on the way to one."""

KEPT = 20_000_000
"""Influences that stay between the loads without and with creep forces; beyond these 160 MB they are found again."""

BALANCE = "balanced"
"""Status of a position whose loads balance."""

LACKING = (
    "the vertical load of the left wheel is off by {:.2g} of the load",
    "the vertical load of the right wheel is off by {:.2g} of the load",
    "the torque on the axle is off by {:.2g} of that of full slip",
    "the lateral force is off by {:.2g} of the load of a wheel",
)
"""Status of other positions, by the column of `Loads.left`."""

SLIDES = "a wheel slides along its flank, and its rows do not lie where it stands"
"""Status of positions at which no laying of the rows is the last one."""

WEDGED, HELD = "the {} wheel is wedged: friction holds its flank, whose normal force is {:.2g} times the load", 5.0
"""Status of positions without a balance at which a normal force is more than so many times the load."""


def _limited(height: Array, roll: Array, new_height: Array, new_roll: Array) -> tuple[Array, Array]:
    """Return heights [m] and rolls [rad] on the straight way to new ones, at most `FARTHEST` and `MOST_ROLL` away."""
    raised, rolled = new_height - height, new_roll - roll
    most = np.maximum(np.abs(raised).max(axis=-1) / FARTHEST, np.abs(rolled) / MOST_ROLL)
    share = 1.0 / np.maximum(most, 1.0)
    return height + share[:, None] * raised, roll + share * rolled


@dataclass
class Loads:
    """The loads of a wheelset at all positions, in their order.

    Attributes
    ----------
    stands : list of Stand
        The positions in blocks; where one was laid again, the last one counts.
    """

    section: Section
    samples: Samples
    elastic: Elastic
    task: Task
    patch: Patch
    stands: list[Stand]

    def begun(self, points: NDArray[np.intp], roll: Array, touching: Touching) -> Loads:
        """Return the loads with some positions where rigid wheels stand, without creep forces.

        Under these the wheelset turns with the mean of its radii. Rolls and touching places are those of `points`.
        """
        task, stands, kept = self.task.part(points), list(self.stands), 0
        place = placed(self.section, both_sides(task.displacement, roll, task.yaw), touching.arc[..., 0])
        lever = place.y + place.z * np.tan(place.angle)
        for start in range(0, points.size, BLOCK):
            some = np.arange(start, min(start + BLOCK, points.size))
            stand = Stand.laid(
                self.section, self.samples, self.elastic, task.part(some), points[some], touching.least[some],
                roll[some], lever[some],
            )  # fmt: skip
            for each in self.until_near(stand):
                kept += each.pressed.influence.size
                if kept > KEPT:
                    each.pressed.influence = np.empty(0)
                stands.append(each)
        loads = replace(self, stands=stands)
        loads.stands = [stands[number] for number in np.unique(loads._last)]
        return loads

    def until_near(
        self, stand: Stand, forces: Callable[[wl.Problem], wl.CreepForces] | None = None, goal: Array | None = None,
        slides: NDArray[np.bool_] | None = None, some: NDArray[np.bool_] | None = None, again: int = AGAIN,
    ) -> Iterator[Stand]:  # fmt: skip
        """Yield a stand, and those of its positions that are laid again because they have moved far.

        With creep forces, they are balanced to the greatest imbalance of each position, (positions of the stand,), and
        slide as `Stand.balance` says. `some` are the positions that count.
        """
        slides = np.zeros(stand.points.shape, dtype=np.bool_) if slides is None else slides
        some = np.ones(stand.points.shape, dtype=np.bool_) if some is None else some
        for number in range(again + 1):
            if forces is not None:
                assert goal is not None
                stand.balance(forces, self.patch, number >= WHOLE, goal, slides, some)
            yield stand
            far = some & (stand.shift > 1.0)
            if number == again or not far.any():
                return
            points, (height, roll) = stand.points[far], stand.next_place
            height, roll = _limited(stand.height, stand.roll, height, roll)
            task = replace(stand.task.part(np.flatnonzero(far)), displacement=stand.displacement[far])
            stand = Stand.laid(
                self.section, self.samples, self.elastic, task, points, height[far], roll[far], None,
                None if forces is None else stand.creeping,
            )  # fmt: skip
            slides, some = slides[far], some[far]
            goal = None if goal is None else goal[far]

    def under(self, conditions: Mapping[str, Array]) -> Loads:
        """Return the loads under conditions of contact models and stages, (positions,)."""
        task = replace(self.task, conditions=conditions)
        stands = [copy(stand) for stand in self.stands]
        for stand in stands:
            stand.task = replace(stand.task, conditions=task.part(stand.points).conditions)
        return replace(self, task=task, stands=stands)

    def solved(self, forces: Callable[[wl.Problem], wl.CreepForces], goal: Array) -> Loads:
        """Return the loads that balance the creep forces of a problem with one entry for each patch.

        `goal` is the greatest imbalance of each position.
        """
        number = self._last
        stands: list[Stand] = []
        for index, stand in enumerate(self.stands):
            some = number[stand.points] == index
            stands += self.until_near(stand.copy(), forces, goal[stand.points], None, some)
        return self._kept(stands)

    def outwards(
        self, forces: Callable[[wl.Problem], wl.CreepForces], begun: Callable[[Loads, NDArray[np.intp]], Loads]
    ) -> Loads:
        """Return the loads that balance the creep forces at the displacements that are asked for, in steps from these.

        A position that loses its balance on the way starts there, from what `begun` returns without creep forces.
        """
        rest = self.task.due - self.task.displacement
        loads, moves = self.solved(forces, np.where(rest == 0.0, BALANCED, PASSING)), rest != 0.0
        while True:
            points = np.flatnonzero((rest != 0.0) & ~loads.unsettled(PASSING))
            if not points.size:
                break
            rest[points] -= np.clip(rest[points], -OUTWARDS, OUTWARDS)
            goal = np.where(rest == 0.0, BALANCED, PASSING)[points]
            loads = loads.moved(forces, points, (self.task.due - rest)[points], goal, again=WHOLE)
        lost = np.flatnonzero(moves & loads.unsettled(ROUGH))
        loads = begun(replace(loads, task=replace(self.task, displacement=self.task.due)), lost)
        return loads._again(forces, lost, *loads._ahead(self.task.due), None, np.full(lost.size, BALANCED))

    def moved(
        self, forces: Callable[[wl.Problem], wl.CreepForces], points: NDArray[np.intp], displacement: Array,
        goal: Array, slides: NDArray[np.bool_] | None = None, again: int = AGAIN,
    ) -> Loads:  # fmt: skip
        """Return the loads with some positions at other displacements [m], with the creep forces that they had.

        `goal` is the greatest imbalance of each of them, `slides` whether each may slide from there, and `again` how
        often rows are laid again at most.
        """
        whole = self.task.displacement.copy()
        whole[points] = displacement
        moved = replace(self, task=replace(self.task, displacement=whole))
        return moved._again(forces, points, *self._ahead(whole), self._creeping, goal, slides, again)

    def _again(
        self, forces: Callable[[wl.Problem], wl.CreepForces], points: NDArray[np.intp], height: Array, roll: Array,
        creeping: Creeping | None, goal: Array, slides: NDArray[np.bool_] | None = None, again: int = AGAIN,
    ) -> Loads:  # fmt: skip
        """Return the loads with some positions laid anew, by heights [m] and rolls [rad] of all."""
        stands = list(self.stands)
        for start in range(0, points.size, BLOCK):
            some = points[start : start + BLOCK]
            stand = Stand.laid(
                self.section, self.samples, self.elastic, self.task.part(some), some, height[some], roll[some], None,
                creeping,
            )  # fmt: skip
            part = slice(start, start + BLOCK)
            sliding = None if slides is None else slides[part]
            stands += self.until_near(stand, forces, goal[part], sliding, again=again)
        return self._kept(stands)

    def _ahead(self, displacement: Array) -> tuple[Array, Array]:
        """Return heights of the axle at both wheels [m] and rolls [rad] at other displacements [m]."""
        height, roll = np.empty((displacement.size, 2)), np.empty(displacement.size)
        for stand in self.stands:
            (high, leaned), (heights, rolls) = stand.now, stand.ahead(displacement[stand.points])
            height[stand.points], roll[stand.points] = _limited(high, leaned, heights, rolls)
        return height, roll

    @property
    def _creeping(self) -> Creeping:
        """What the rows of all positions leave to those that are laid anew."""
        last, parts = self._last, []
        for number, stand in enumerate(self.stands):
            each = stand.creeping
            of = stand.points[stand.rows.wheel // 2]
            parts.append([array[last[of] == number] for array in each[2:]])
        keys, ratio, sine = (np.concatenate(arrays) for arrays in zip(*parts, strict=True))
        order = np.argsort(keys)
        rotation = self.rotation / self._gathered("rolling")
        return Creeping(np.arange(last.size), rotation, keys[order], ratio[order], sine[order])

    def _kept(self, stands: list[Stand]) -> Loads:
        """Return the loads of stands as results keep them: the last ones, which need no influences any more."""
        loads = replace(self, stands=stands)
        loads.stands = [stands[number] for number in np.unique(loads._last)]
        for stand in loads.stands:
            stand.pressed.influence = np.empty(0)
        return loads

    @property
    def _last(self) -> NDArray[np.intp]:
        """Index of the last stand of each position."""
        last = np.empty(self.task.yaw.size, dtype=np.intp)
        for number, stand in enumerate(self.stands):
            last[stand.points] = number
        return last

    def _gathered(self, name: str) -> Array:
        """Return an array of the stands for all positions."""
        pieces = [(stand.points, getattr(stand, name)) for stand in self.stands]
        whole = np.empty((self.task.yaw.size, *pieces[0][1].shape[1:]))
        for points, piece in pieces:
            whole[points] = piece
        return whole

    @cached_property
    def rotation(self) -> Array:
        """Speed of rotation at each position, Ω [rad/s]."""
        return self._gathered("rotation")

    @cached_property
    def displacement(self) -> Array:
        """Lateral displacement at each position [m]."""
        return self._gathered("displacement")

    @cached_property
    def left(self) -> Array:
        """What is left over, as in `Stand`, (positions, 4)."""
        return self._gathered("left")

    def unsettled(self, most: float) -> NDArray[np.bool_]:
        """Return at which positions more is left over than `most`, or rows do not lie where the wheels stand."""
        return np.asarray((self.left[:, :3].max(axis=-1) > most) | (self._gathered("shift") > 1.0))

    @cached_property
    def vertical(self) -> Array:
        """Vertical force of each wheel on its rail, Q [N], (positions, 2)."""
        return self._gathered("vertical")

    @cached_property
    def lateral(self) -> Array:
        """Lateral force of each wheel on its rail, positive to the right, Y [N], (positions, 2)."""
        return self._gathered("lateral")

    @cached_property
    def stiffness(self) -> Array:
        """Rate of the sum of the lateral forces with the lateral displacement [N/m]."""
        return self._gathered("rates")[:, 2]

    @cached_property
    def roll(self) -> Array:
        """Roll at each position, positive if it lowers the right wheel, ρ [rad]."""
        whole = np.empty(self.task.yaw.size)
        for stand in self.stands:
            whole[stand.points] = stand.now[1]
        return whole

    @cached_property
    def patches(self) -> Patches:
        """The patches of all positions."""
        last, kept = self._last, []
        for number, stand in enumerate(self.stands):
            part = stand.patches
            points = stand.points[part.point]
            some = last[points] == number
            kept.append(replace(part.part(some), point=points[some]))
        return joined(kept)

    @property
    def status(self) -> NDArray[np.object_]:
        """What does not balance at each position, and by how much, as texts; `BALANCE` where nothing lacks."""
        status = np.full(self.task.yaw.shape, BALANCE, dtype=object)
        for point in np.flatnonzero((self.left.max(axis=-1) > ROUGH) & self.task.bears.any(axis=-1)):
            most = int(self.left[point].argmax())
            status[point] = LACKING[most].format(self.left[point, most])
        status[(status == BALANCE) & (self._gathered("shift") > 1.0) & self.task.bears.any(axis=-1)] = SLIDES
        patches, load = self.patches, self.task.load
        share = np.bincount(2 * patches.point + patches.side, patches.force, load.size).reshape(-1, 2) / load
        for point, side in np.argwhere((share > HELD) & self.task.bears & (status != BALANCE)[:, None]):
            status[point] = WEDGED.format(("left", "right")[side], share[point, side])
        return status

    @property
    def climbs(self) -> NDArray[np.bool_]:
        """Whether the first patch of each wheel lies on its flange beyond the steepest place, (positions, 2).

        Never under a lateral force: the search stops where its sum grows outwards, as beyond an edge of a worn flank.
        """
        patches, climbs = self.patches, np.zeros((self.task.yaw.size, 2), dtype=np.bool_)
        if self.task.lateral_force is not None:
            return climbs
        steepest = np.array([pair.steepest for pair in self.section.sides])
        over = (patches.number == 0) & (patches.arc < steepest[patches.side])
        climbs[patches.point[over], patches.side[over]] = True
        return climbs & self.task.bears

    def check_torque(self) -> None:
        """Raise an error for a torque that friction cannot transmit."""
        patches = self.patches
        problem = patches.posed(self.task, self.elastic, self.rotation, self.patch)
        grip = np.bincount(
            patches.point, problem.friction_coefficient * patches.force * patches.radius, self.task.yaw.size
        )
        over = ~(np.abs(self.task.torque) < grip)
        if over.any():
            point = int(np.argmax(over))
            raise wl.ConditionsError(
                f"axle_torque: {self.task.torque[point]:.4g} N*m is more than friction can transmit, about"
                f" {grip[point]:.4g} N*m under this load"
            )
