"""The lateral displacement at which the rails bear a given lateral force.

The rails guide a wheelset by the lateral forces Y of its wheels. The sum over both wheels,

    ∑ Y = ∑ (Fy cos δ - N sin δ),

is the lateral force H of the vehicle on the wheelset. As the wheelset moves outwards, ∑ Y grows slowly on the treads
and steeply on a flange, and falls where the flange climbs. Of several displacements with this force, the wheelset takes
one at which ∑ Y grows: there it is stable.

The search begins where a rigid wheel passes from its tread to its flange. Newton's method, whose rates are those of the
pressure, goes on between bounds. Where ∑ Y nowhere reaches H, the greatest ∑ Y lies where its rate vanishes.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from wearlaw import Array
from wearlaw_models.rigs.wheelset.loads import ROUGH, Loads
from wearlaw_models.rigs.wheelset.task import Task

STEP = 1e-3
"""Steps in which rigid wheels are looked at [m]."""

FARTHEST = 60e-3
"""Greatest displacement that is tried [m]: the play of flanges is at most 40 mm."""

HALVINGS = 10
"""How often a step is halved to find where a rigid wheel climbs, to 1 µm."""

BEYOND = 0.5e-3
"""Distance from there on that is searched too [m]: elastic flanges take the whole load some 0.1 mm later."""

BORNE = 5e-3
"""Lateral force that may be left over, as a share of the axle load: from there on, the pressure finds the rest."""

CLOSE = 1e-7
"""Distance of the bounds at which the force jumps between them [m]."""

STEPS, SLOW = 40, 6
"""Greatest number of steps, and those after which every other one halves the bounds."""


class Guided(NamedTuple):
    """Where wheelsets stand under lateral forces, as arrays with one entry for each position.

    Attributes
    ----------
    displacement : ndarray
        Lateral displacement [m], nearly; where a wheel climbs, that with the greatest ∑ Y.
    climbs : ndarray of bool
        Whether no displacement bears the force.
    greatest : ndarray
        The greatest ∑ Y that was found towards that side [N].
    """

    displacement: Array
    climbs: NDArray[np.bool_]
    greatest: Array


def guided(
    task: Task,
    solved: Callable[[Task], Loads],
    stands: Callable[[Array, NDArray[np.intp], bool], NDArray[np.bool_]],
    begins: Callable[[Array], Array],
) -> Guided:
    """Return the displacements at which the rails bear the lateral forces of a task.

    Parameters
    ----------
    task : Task
        Its lateral force is given, and its displacement is not read.
    solved : callable
        Returns the loads of a part of the task.
    stands : callable
        Returns whether both rigid wheels stand on their rails, at displacements [m] of the positions in the second
        argument; if the third one is true, below the steepest points of their flanges.
    begins : callable
        Returns where the search begins, by lateral forces over the load of a wheel: distances from the middle [m].
    """
    assert task.lateral_force is not None
    force, count = task.lateral_force, task.lateral_force.size
    left_over = BORNE * task.load.sum(axis=-1)

    def borne(points: NDArray[np.intp], displacement: Array) -> tuple[Array, Array]:
        """Return ∑ Y at positions [N], NaN where no loads balance, and its rate [N/m]."""
        loads = solved(task.part(points, displacement))
        balanced = (loads.left.max(axis=-1) <= ROUGH) | ~loads.task.bears.any(axis=-1)
        return np.where(balanced, loads.lateral.sum(axis=-1), np.nan), loads.stiffness

    # From here on, distances and forces are positive to the side to which the wheelset moves from the middle.
    every = np.arange(count)
    middle, _ = borne(every, np.zeros(count))
    side = np.where(force < middle, -1.0, 1.0)
    end = _last(lambda distance, points, below: stands(side[points] * distance, points, below), count)
    low, high, at_low = np.zeros(count), np.full(count, np.inf), side * (middle - force)
    most, place = at_low.copy(), np.zeros(count)
    distance = np.where(
        np.abs(at_low) <= left_over, 0.0, np.minimum(begins(np.abs(force) / task.load.mean(axis=-1)), end)
    )
    going, climbs = every[np.abs(at_low) > left_over], np.zeros(count, dtype=np.bool_)
    for step in range(STEPS):
        if not going.size:
            break
        x = distance[going]
        total, rate = borne(going, side[going] * x)
        excess = side[going] * (total - force[going])
        most[going], place[going] = np.fmax(most[going], excess), np.where(excess > most[going], x, place[going])
        over = (excess > 0.0) | np.isnan(excess)  # friction may hold a flange; the root is sought before that
        beyond = ~over & (rate <= 0.0)  # the wheel climbs: a greater force lies before
        over |= beyond
        high[going] = np.where(over, x, high[going])
        low[going] = np.where(over, low[going], x)
        with np.errstate(invalid="ignore", divide="ignore"):
            ahead = x - excess / rate
        bound = np.minimum(high[going], end[going])
        inside = (ahead > low[going]) & (ahead < bound) & ~beyond & (rate > 0.0)
        if step >= SLOW and step % 2:
            inside[:] = False
        distance[going] = np.where(inside, ahead, 0.5 * (low[going] + bound))
        done = (np.abs(excess) <= left_over[going]) | (bound - low[going] <= CLOSE)
        distance[going[np.abs(excess) <= left_over[going]]] = x[np.abs(excess) <= left_over[going]]
        climbs[going] = done & (np.abs(excess) > left_over[going]) & (most[going] < 0.0)
        going = going[~done]
    return Guided(side * np.where(climbs, place, distance), climbs, side * most + force)


def _last(stands: Callable[[Array, NDArray[np.intp], bool], NDArray[np.bool_]], count: int) -> Array:
    """Return the farthest distances that are searched [m]."""
    last, step = np.zeros(count), STEP
    points = np.arange(count)
    while points.size and last[points[0]] < FARTHEST:
        points = points[stands(last[points] + step, points, True)]
        last[points] += step
    points = np.flatnonzero(last < FARTHEST)
    for _ in range(HALVINGS):
        step *= 0.5
        last[points] += np.where(stands(last[points] + step, points, True), step, 0.0)
    return last + np.where(stands(last + BEYOND, np.arange(count), False), BEYOND, 0.0)
