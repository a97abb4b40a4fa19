"""The lateral displacement at which the rails bear a given lateral force.

The rails guide a wheelset by the lateral forces Y of its wheels. The sum over both wheels,

    ∑ Y = ∑ (Fy cos δ - N sin δ),

is the lateral force H of the vehicle on the wheelset. As the wheelset moves outwards, ∑ Y grows slowly on the treads
and steeply on a flange, and falls where the flange climbs. Of several displacements with this force, the wheelset takes
one at which ∑ Y grows: there it is stable.

The search begins where rigid wheels bear the force without friction, but on the tread: beyond it, a flange may bear
alone or together with the tread, and a wheelset comes from the tread. From there on, wheelsets move by Newton's method
between bounds, each with the creep forces that it had before; the rates are those of the pressure. Between two places
where ∑ Y is less and more than H, they go to the root of a cubic. Rows that are laid anew may bear another force, so
close to the end wheelsets move within the rows of one laying. Where ∑ Y nowhere reaches H, the greatest ∑ Y lies where
its rate vanishes.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

import wearlaw as wl
from wearlaw import Array
from wearlaw_models.rigs.wheelset.geometry import patches
from wearlaw_models.rigs.wheelset.loads import ROUGH, Loads
from wearlaw_models.rigs.wheelset.search import Section, both_sides, searched
from wearlaw_models.rigs.wheelset.stand import BALANCED, WITHIN

STEP, USUAL, FARTHEST = 0.1e-3, 15e-3, 60e-3
"""Steps in which rigid wheels are looked at, and their end [m], usually and at most: the play is at most 40 mm."""

BEYOND = 0.5e-3
"""Distance past the steepest point of a rigid flange that is searched too [m]: an elastic one takes the whole load some
0.1 mm later."""

BORNE, NEAR = 1e-4, 5e-3
"""Lateral force that may be left over, over the axle load, and that from which on loads are balanced finely."""

LEAST, SMALL = 0.2, 1e-6
"""Least whole rate over that of the pressure alone; least step that shows the rate of the creep forces [m]."""

CLOSE, SURE = 1e-8, 2e-3
"""Distance of bounds between which the force jumps [m]; share of ∑ Y by which a greater one may be missed."""

SHORTEST = 0.1e-3
"""Step outwards that is allowed however near the steepest point is [m]; else it is half of the distance at most."""

FLANGE, INWARDS = 0.8, 0.9
"""Shares of the distance of the steepest point from which a flange may climb, and of that at which nothing balances to
go on with.
"""

TREAD = 0.95
"""Share of the way to the end of the tread up to which a search may begin."""

STEPS, SLOW, HALVINGS = 40, 8, 20
"""Greatest number of steps, those after which every other one halves the bounds, and the halvings in search of a root.
"""


class Play(NamedTuple):
    """How rigid wheelsets without yaw stand between their rails.

    Attributes
    ----------
    displacement : ndarray
        Lateral displacements at which both wheels stand below the steepest points of their flanges [m].
    slope : ndarray
        The lateral force that they bear without friction, over the load of a wheel: tan δ of the right wheel less that
        of the left one, where it falls outwards that from before.
    ends, treads : tuple of float
        Displacements up to which a search may go, and up to which both wheels stand on their treads [m].
    """

    displacement: Array
    slope: Array
    ends: tuple[float, float]
    treads: tuple[float, float]

    def at(self, share: Array) -> Array:
        """Return displacements [m] at which rigid wheels bear lateral forces over the load of a wheel."""
        return np.asarray(np.interp(share, self.slope, self.displacement))

    def begin(self, share: Array) -> Array:
        """Return where a search for lateral forces over the load of a wheel begins, on the treads [m]."""
        first, last = self.treads
        return np.clip(self.at(share), TREAD * first, TREAD * last)

    def share(self, displacement: Array) -> Array:
        """Return lateral forces over the load of a wheel that rigid wheels bear at displacements [m]."""
        return np.asarray(np.interp(displacement, self.displacement, self.slope))


def play(section: Section, flange_angle: float) -> Play:
    """Return how rigid wheelsets stand between their rails; a wheel is on its flange beyond an angle [rad]."""
    for farthest in (USUAL, FARTHEST):
        looked_at = _play(section, flange_angle, round(farthest / STEP))
        if np.abs(looked_at.displacement[[0, -1]]).max() < farthest - 2.0 * BEYOND:
            break
    return looked_at


def _play(section: Section, flange_angle: float, middle: int) -> Play:
    """Return the play among a number of steps to each side."""
    displacement = np.asarray(STEP * np.arange(-middle, middle + 1), np.float64)
    none = np.zeros_like(displacement)
    roll, touching = searched(section, displacement, none)
    arc = touching.arc[..., 0]
    angle = patches(section, both_sides(displacement, roll, none), touching)["contact_angle"]
    angle = np.abs(np.where(np.isnan(arc), np.inf, angle[..., 0]))

    def last(stands: NDArray[np.bool_]) -> tuple[int, int]:
        """Return the first and the last place about the middle, which counts, up to which both wheels stand so."""
        both = np.pad(stands.all(axis=-1), 1)
        both[middle + 1] = True
        return middle + 1 - int(np.argmin(both[middle + 1 :: -1])), middle - 1 + int(np.argmin(both[middle + 1 :]))

    begin, end = last(arc >= [pair.steepest for pair in section.sides])
    first, final = displacement[list(last(~np.isnan(arc)))]
    some = slice(begin, end + 1)
    steep = np.tan(angle[some])
    apart = steep[:, 1] - steep[:, 0]
    to_left, to_right = apart[middle - begin :: -1], apart[middle - begin :]
    slope = np.append(np.minimum.accumulate(to_left)[:0:-1], np.maximum.accumulate(to_right)).astype(np.float64)
    ends = max(displacement[begin] - BEYOND, first), min(displacement[end] + BEYOND, final)
    treads = displacement[list(last(angle <= flange_angle))]
    return Play(displacement[some], slope + 1e-9 * np.arange(slope.size), ends, (float(treads[0]), float(treads[1])))


def _back(now: Array, before: Array, rate: Array, rate_before: Array) -> Array:
    """Return how far before the present place a cubic vanishes, as a share of the way from the place before.

    It has the values of both places, whose signs differ, and their rates times the way.
    """
    near, far = np.zeros(now.shape), np.ones(now.shape)
    for _ in range(HALVINGS):
        share = 0.5 * (near + far)
        rest = 1.0 - share
        of_now, of_before = now * (1.0 + 2.0 * share) - rate * share, before * (1.0 + 2.0 * rest) + rate_before * rest
        same = (of_now * rest**2 + of_before * share**2) * now > 0.0
        near, far = np.where(same, share, near), np.where(same, far, share)
    return 0.5 * (near + far)


class Guided(NamedTuple):
    """Where wheelsets stand under lateral forces.

    Attributes
    ----------
    loads : Loads
        Where a wheel climbs, those at which the search ended.
    place, greatest : ndarray, (positions,)
        Lateral displacement with the greatest ∑ Y towards that side which was met [m], and that ∑ Y [N].
    climbs : ndarray of bool, (positions,)
        Whether no displacement bears the force.
    """

    loads: Loads
    place: Array
    greatest: Array
    climbs: NDArray[np.bool_]


def guided(loads: Loads, forces: Callable[[wl.Problem], wl.CreepForces], play: Play) -> Guided:
    """Return where the rails bear the lateral forces of a task; loads without creep forces say where that begins."""
    task = loads.task
    assert task.lateral_force is not None
    count, axle = task.yaw.size, task.load.sum(axis=-1)
    loads = loads.solved(forces, np.full(count, ROUGH))
    excess = loads.lateral.sum(axis=-1) - task.lateral_force
    rigid = play.at(play.share(task.displacement) - excess / task.load.mean(axis=-1))
    # From here on, distances and forces are positive to the side on which the rails bear the force.
    side = np.where(rigid < 0.0, -1.0, 1.0)
    ends, steep = (np.where(side < 0.0, -left, right) for left, right in (play.ends, play.displacement[[0, -1]]))
    distance, rigid = side * task.displacement, side * rigid
    low, at_low, rise = np.full((3, count), -np.inf)  # the lower bound, with excess and rate there
    high, most, place = ends.copy(), np.full(count, -np.inf), np.zeros(count)
    last = np.full((3, count), np.nan)  # distance, excess and rate of the step before
    slip = np.zeros(count)
    reached, falls, climbs, fine = np.zeros((4, count), dtype=np.bool_)
    going = np.arange(count)
    for step in range(STEPS):
        if step:
            goal = np.where(fine[going], BALANCED, ROUGH)
            slides = (high - low)[going] < WITHIN
            loads = loads.moved(forces, going, side[going] * distance[going], goal, slides)
            distance[going] = side[going] * loads.displacement[going]
        d, rate = distance[going], loads.stiffness[going]
        balanced = (loads.left[:, :3].max(axis=-1) <= ROUGH) | ~loads.task.bears.any(axis=-1)
        excess = (side * (np.where(balanced, loads.lateral.sum(axis=-1), np.nan) - task.lateral_force))[going]
        near = np.abs(excess) <= BORNE * axle[going]
        done = near & fine[going] & (rate > 0.0)
        fine[going] |= np.abs(excess) <= NEAR * axle[going]
        more = excess > most[going]
        most[going], place[going] = np.fmax(most[going], excess), np.where(more, d, place[going])
        # Bounds: friction may hold a flange, or the wheel climbs; a root or the greatest force lies before.
        # Where a flank begins to bear, there may be no balance; but there is one beside.
        lost = np.isnan(excess)
        beside = lost & np.where(reached[going], ~falls[going], np.isfinite(last[1, going]))
        lost = (lost & ~beside) | ((rate <= 0.0) & (excess <= 0.0) & (d > FLANGE * steep[going]))
        over = lost | (excess > 0.0)
        vain = ~over & (d >= high[going]) & ~reached[going]
        falls[going], reached[going] = np.where(over, lost, falls[going]), reached[going] | over
        high[going] = np.where(over, d, high[going])
        for array, value in ((low, d), (at_low, excess), (rise, rate)):
            array[going] = np.where(over | beside, array[going], value)
        top = at_low[going] + rise[going] * (high - low)[going]  # the sum bends down before the wheel climbs
        total = np.abs(most + side * task.lateral_force)[going]
        with np.errstate(invalid="ignore"):  # where nothing has balanced so far, there is no greatest force
            vain |= falls[going] & (top < 0.0) & (top - most[going] < SURE * total)
        vain |= reached[going] & (high - low <= CLOSE)[going]
        climbs[going] = vain & ~done & (most[going] < 0.0)
        # The next distance, by the rate of the pressure and what the last step shows of that of the creep forces.
        by = d - last[0, going]
        with np.errstate(invalid="ignore", divide="ignore"):
            chord = (excess - last[1, going]) / by - 0.5 * (rate + last[2, going])
            slip[going] = np.where(np.isfinite(chord) & (np.abs(by) > SMALL), chord, slip[going])
            slope = np.where(rate + slip[going] > LEAST * rate, rate + slip[going], rate)
            ahead = d - excess / slope
            back = by * _back(excess, last[1, going], rate * by, last[2, going] * by)
            ahead = np.where(excess * last[1, going] < 0.0, d - back, ahead)
        last[:, going] = d, excess, rate
        if step == 0:
            ahead = np.where((np.abs(rigid - d) > SHORTEST) & (np.abs(rigid - d) < np.abs(ahead - d)), rigid, ahead)
        limit = np.minimum(d + np.maximum(0.5 * (steep[going] - d), SHORTEST), high[going])
        least = d - np.maximum(0.5 * (steep[going] + d), SHORTEST)
        between = reached[going] & np.isfinite(low[going])
        inside = (ahead > low[going]) & (~reached[going] | (ahead < high[going]))
        inside &= (rate > 0.0) & ~lost & ~beside & ~((step >= SLOW) & (step % 2 == 1) & between)
        ahead = np.where(reached[going], np.maximum(ahead, least), np.minimum(ahead, limit))
        middle = 0.5 * (np.where(beside, d, np.where(between, low[going], 0.0)) + high[going])
        middle = np.where(between, middle, np.where(over, INWARDS * d, limit))
        distance[going] = np.where(inside, ahead, middle)
        going = going[~(done | vain)]
        if not going.size:
            break
    return Guided(loads, side * place, side * most + task.lateral_force, climbs)
