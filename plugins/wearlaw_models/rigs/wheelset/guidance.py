"""The lateral displacement at which the rails bear a given lateral force.

The rails guide a wheelset by the lateral forces Y of its wheels. The sum over both wheels,

    ∑ Y = ∑ (Fy cos δ - N sin δ),

is the lateral force H of the vehicle on the wheelset. As the wheelset moves outwards, ∑ Y grows slowly on the treads
and steeply on a flange, jumps where contact jumps, and falls where the flange climbs. Of several displacements with
this force, the wheelset takes the one nearest to the middle of the track at which ∑ Y grows: there it is stable.

The search goes outwards in steps, from the middle to shortly beyond where a rigid wheel passes the steepest point of
its flange. Within the first step over which ∑ Y passes H, interpolation within bounds finds the place. If there is
none, the search repeats the last steps in finer ones, since ∑ Y is greatest there.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from wearlaw import Array
from wearlaw_models.rigs.wheelset.loads import Balance, Task

STEP, FINE = 1e-3, 0.1e-3
"""Steps of the search outwards, and of that for the greatest force before a wheel climbs [m]."""

FARTHEST = 60e-3
"""Greatest displacement that is tried [m]: the play of flanges is at most 40 mm."""

HALVINGS = 10
"""How often a step is halved to find where a rigid wheel climbs, to 1 µm."""

BEYOND = 0.5e-3
"""Distance from there on that is searched too [m]: elastic flanges take the whole load some 0.1 mm later."""

BORNE = 1e-5
"""Lateral force that may be left over, as a share of the axle load. On a flange, ∑ Y grows by the axle load in some
50 µm, and the level of both wheels is found to 1e-10 m."""

CLOSE = 1e-9
"""Distance of the bounds at which the force jumps between them [m]."""

STEPS = 60
"""Greatest number of steps within bounds."""


class Guided(NamedTuple):
    """Where wheelsets stand under lateral forces, as arrays with one entry for each position.

    Attributes
    ----------
    displacement : ndarray
        Lateral displacement [m]; where a wheel climbs, that with the greatest ∑ Y.
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
    solved: Callable[[Task, NDArray[np.intp]], Balance],
    stands: Callable[[Array, NDArray[np.intp], bool], NDArray[np.bool_]],
) -> Guided:
    """Return the displacements at which the rails bear the lateral forces of a task.

    Parameters
    ----------
    task : Task
        Its lateral force is given, and its displacement is not read.
    solved : callable
        Returns the balance of a part of the task, whose positions are named by the second argument.
    stands : callable
        Returns whether both rigid wheels stand on their rails, at displacements [m] of the positions in the second
        argument; if the third one is true, below the steepest points of their flanges.
    """
    assert task.lateral_force is not None
    force, count = task.lateral_force, task.lateral_force.size
    left_over = BORNE * task.load.sum(axis=-1)

    def borne(rows: NDArray[np.intp], displacement: Array) -> Array:
        """Return ∑ Y at positions [N], NaN where no loads balance."""
        balance = solved(task.part(rows, displacement), rows)
        return np.where(balance.balanced, balance.lateral.sum(axis=-1), np.nan)

    # From here on, distances and forces are positive to the side to which the wheelset moves from the middle.
    every = np.arange(count)
    middle = borne(every, np.zeros(count))
    side = np.where(force < middle, -1.0, 1.0)

    def excess(rows: NDArray[np.intp], distance: Array) -> Array:
        return np.asarray(side[rows] * (borne(rows, side[rows] * distance) - force[rows]))

    end = _last(lambda distance, rows, below: stands(side[rows] * distance, rows, below), count)
    low, high, held = np.zeros(count), np.full(count, np.nan), np.full(count, np.nan)
    first = side * (middle - force)
    at_low, at_high, most, place = first.copy(), np.full(count, np.nan), first.copy(), np.zeros(count)

    def look(rows: NDArray[np.intp], distance: Array) -> None:
        """Note the excess at distances beyond those before."""
        if not rows.size:
            return
        excesses = excess(rows, distance)
        over, none = excesses >= 0.0, np.isnan(excesses)
        high[rows[over]], at_high[rows[over]] = distance[over], excesses[over]
        held[rows] = np.where(none & np.isnan(held[rows]), distance, held[rows])
        under = rows[~over & ~none]
        low[under], at_low[under] = distance[~over & ~none], excesses[~over & ~none]
        place[rows] = np.where(excesses > most[rows], distance, place[rows])
        most[rows] = np.fmax(most[rows], excesses)

    rows = every
    for number in range(1, round(FARTHEST / STEP) + 1):
        rows = rows[np.isnan(high[rows]) & ((number - 1) * STEP < end[rows])]
        look(rows, np.minimum(number * STEP, end[rows]))
    again = np.isnan(high)  # the greatest force may lie shortly before the end
    low[again], at_low[again] = 0.0, first[again]
    for number in range(round(STEP / FINE), 0, -1):
        rows = np.flatnonzero(np.isnan(high) & (end > number * FINE))
        look(rows, end[rows] - number * FINE)
    jams = np.isnan(high) & ~np.isnan(held)  # friction holds the flange from there on, and no loads balance
    high[jams], at_high[jams], low[jams], at_low[jams] = held[jams], np.inf, 0.0, first[jams]
    climbs = np.isnan(high)
    distance = _root(excess, low, at_low, high, at_high, left_over)
    return Guided(side * np.where(climbs, place, distance), climbs, side * most + force)


def _last(stands: Callable[[Array, NDArray[np.intp], bool], NDArray[np.bool_]], count: int) -> Array:
    """Return the farthest distances that are searched [m]."""
    last = np.zeros(count)
    rows = np.arange(count)
    while rows.size and last[rows[0]] < FARTHEST:
        rows = rows[stands(last[rows] + STEP, rows, True)]
        last[rows] += STEP
    step, rows = STEP, np.flatnonzero(last < FARTHEST)
    for _ in range(HALVINGS):
        step *= 0.5
        last[rows] += np.where(stands(last[rows] + step, rows, True), step, 0.0)
    return last + np.where(stands(last + BEYOND, np.arange(count), False), BEYOND, 0.0)


def _root(
    excess: Callable[[NDArray[np.intp], Array], Array],
    low: Array,
    at_low: Array,
    high: Array,
    at_high: Array,
    left_over: Array,
) -> Array:
    """Return distances between bounds at which the excess vanishes; where there are no bounds, the low ones.

    Where no loads balance on some part of the way, as between two humps of a patch, the root is sought below it, and
    then above it. If it is in neither, the result is the last place below.
    """
    distance = low.copy()
    rows = np.flatnonzero(np.isfinite(at_low) & np.isfinite(high) & (np.abs(at_low) > left_over))
    for unknown in (np.inf, -np.inf):
        x, missed = _bracketed(
            excess, rows, low[rows], at_low[rows], high[rows], at_high[rows], left_over[rows], unknown
        )
        distance[rows] = np.where(~missed | (unknown > 0.0), x, distance[rows])
        rows = rows[missed]
    return distance


def _bracketed(
    excess: Callable[[NDArray[np.intp], Array], Array],
    rows: NDArray[np.intp],
    low: Array,
    at_low: Array,
    high: Array,
    at_high: Array,
    left_over: Array,
    unknown: float,
) -> tuple[Array, NDArray[np.bool_]]:
    """Return roots between bounds, and whether there is none, by inverse quadratic interpolation and bisection.

    After T. R. Chandrupatla, Advances in Engineering Software 28 (1997) 145-149. The excess bends sharply where a
    flange begins to bear. `unknown` is taken for an excess that is NaN.
    """
    last, at_last, other, at_other = low.copy(), at_low.copy(), high.copy(), at_high.copy()  # of opposite signs
    share, going = np.full(low.shape, 0.5), np.arange(low.size)
    for _ in range(STEPS):
        if not going.size:
            break
        x1, f1, x2, f2 = last[going], at_last[going], other[going], at_other[going]
        x = x1 + share[going] * (x2 - x1)
        f = excess(rows[going], x)
        f = np.where(np.isnan(f), unknown, f)
        same = (f < 0.0) == (f1 < 0.0)
        x3, f3 = np.where(same, x1, x2), np.where(same, f1, f2)
        x2, f2 = np.where(same, x2, x1), np.where(same, f2, f1)
        last[going], at_last[going], other[going], at_other[going] = x, f, x2, f2
        with np.errstate(invalid="ignore", divide="ignore", over="ignore"):  # an infinite excess bisects
            place, height = (x - x2) / (x3 - x2), (f - f2) / (f3 - f2)
            smooth = (height**2 < place) & ((1.0 - height) ** 2 < 1.0 - place)
            ahead = f / (f2 - f) * f3 / (f2 - f3) + (x3 - x) / (x2 - x) * f / (f3 - f) * f2 / (f3 - f2)
        width = np.abs(x2 - x)
        least = np.minimum(0.5 * CLOSE / width, 0.5)
        share[going] = np.where(smooth & np.isfinite(ahead), np.clip(ahead, least, 1.0 - least), 0.5)
        going = going[(np.abs(f) > left_over[going]) & (width > CLOSE)]
    nearer = np.abs(at_other) < np.abs(at_last)
    return np.where(nearer, other, last), np.minimum(np.abs(at_other), np.abs(at_last)) > left_over
