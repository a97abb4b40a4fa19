"""Which part of a profile a contact can reach: it ends where the profile is too steep."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from wearlaw import Array
from wearlaw_models.rigs.wheelset.curve import Curve

STEEPEST = np.radians(86.0)
"""Steepest slope of a profile on which contact is looked for [rad]."""

DEEPEST = 36e-3
"""Depth below a rail's top that no flange reaches, where a foot or a plate beside a nose lies [m]."""

LOST = 0.5e-3
"""Width beyond an end that is worth a word [m]."""

PIECE, GENTLE = 2e-3, np.radians(80.0)
"""Length of the pieces beyond an end [m], so that noise does not count, and the slope up to which their width does
[rad]: the sides of rails are steeper even under the greatest cant."""

LEANING = np.radians(3.0)
"""Greatest cant in use, 1 in 20, rounded up; single points that are too steep under it are passed over [rad]."""

MOST_SPOTS = 10
"""Number of single points that are passed over at most; if there are more, the points have noise."""

SHARP, RARE, SHARE = np.radians(60.0), 6.0, 0.25
"""Least turn of the line at a point that stands out [rad], also in standard deviations of all turns, which noise has;
and the share of it by which the line turns back on both sides."""

MEDIAN = 0.6745
"""Median of the absolute value of a normal distribution with a standard deviation of 1."""

NEAR = 2
"""Number of points on both sides of a steep place among which the one that makes it is looked for."""


class End(NamedTuple):
    """Where the reachable part of a profile ends, as an index of the curve, and the width that lies beyond [m].

    The width is that of pieces that are flatter than the sides of rails and not undercut.
    """

    place: int
    lost: float


class Reach(NamedTuple):
    """The reachable part of a profile, as indices of the curve, and its ends that are too steep."""

    part: slice
    ends: tuple[End, ...]


def reach(curve: Curve, lean: float = 0.0, steepest: float = STEEPEST) -> Reach:
    """Return the part of a profile that a contact can reach.

    It goes from the top of a wheel's flange outwards, or from the top of a rail to both sides, up to the first place
    that is too steep. Without such a place it ends with the profile.

    Parameters
    ----------
    curve : Curve
        The profile.
    lean : float
        Angle by which a rail leans inwards [rad].
    steepest : float
        Steepest slope of the part [rad].
    """
    across = curve.y * np.cos(lean) + curve.z * np.sin(lean)
    down = curve.z * np.cos(lean) - curve.y * np.sin(lean)
    steep = np.cos(curve.angle - lean) < np.cos(steepest)  # a loop adds a turn to the angles behind it
    size = round(PIECE * (curve.s.size - 1) / (curve.s[-1] - curve.s[0]))
    if curve.sign < 0.0:
        flange = np.flatnonzero(curve.y < 0.0)
        tip = int(flange[curve.z[flange].argmax()]) if flange.size else 0
        last, ends = _outwards(across, steep, tip, size)
        return Reach(slice(tip, last), ends)
    top = int(down.argmin())
    across = np.where(down < down[top] + DEEPEST, across, across[top])
    last, ends = _outwards(across, steep, top, size)
    final = curve.s.size - 1
    first, others = _outwards(-across[::-1], steep[::-1], final - top, size)
    return Reach(slice(final + 1 - first, last), tuple(End(final - end.place, end.lost) for end in others) + ends)


def _outwards(y: Array, steep: NDArray[np.bool_], start: int, size: int) -> tuple[int, tuple[End, ...]]:
    """Return the index behind the part from a start to greater y, and its end if it is too steep.

    The size is the number of steps of a piece.
    """
    places = np.flatnonzero(steep[start:])
    if not places.size:
        return y.size, ()
    index = start + int(places[0])
    gained = np.diff(np.maximum.accumulate(y[index:])[::size])
    return index, (End(index, float(gained[gained > PIECE * np.cos(GENTLE)].sum())),)


def without_spots(y: Array, z: Array, through: Callable[[NDArray[np.bool_]], Curve]) -> tuple[Curve, tuple[int, ...]]:
    """Return the curve through points [m] but for single ones that stand out, and the indices of these.

    Such a point is a spike, or alone ends the reachable part of the profile: without it, that part goes on behind it.
    `through` returns the curve of the points to keep. Places that more than one point makes steep stay.
    """
    keep = np.ones(y.size, dtype=np.bool_)
    spots = _spikes(y, z)
    if len(spots) > MOST_SPOTS:
        return through(keep), ()
    keep[spots] = False
    curve = through(keep)
    while len(spots) <= MOST_SPOTS:
        tried = (_passed_over(y, z, through, keep, curve, end) for end in _early(curve))
        step = next((choice for choice in tried if choice is not None), None)
        if step is None:
            return curve, tuple(sorted(spots))
        spot, curve = step
        keep[spot] = False
        spots.append(spot)
    return through(np.ones_like(keep)), ()


def _spikes(y: Array, z: Array) -> list[int]:
    """Return the points at which the line turns sharply, and back on both sides."""
    turn = np.diff(np.unwrap(np.arctan2(np.diff(z), np.diff(y))))
    before, here, behind = turn[:-2], turn[1:-1], turn[2:]
    back = np.minimum(-before * np.sign(here), -behind * np.sign(here))
    sharp = max(SHARP, RARE * float(np.median(np.abs(turn))) / MEDIAN)
    places: list[int] = (2 + np.flatnonzero((np.abs(here) > sharp) & (back > SHARE * np.abs(here)))).tolist()
    return places


def _early(curve: Curve) -> list[End]:
    """Return the ends of the reachable part with a width that is worth a word beyond them."""
    steepest = STEEPEST - (LEANING if curve.sign > 0.0 else 0.0)
    return [end for end in reach(curve, steepest=steepest).ends if end.lost > LOST]


def _passed_over(
    y: Array, z: Array, through: Callable[[NDArray[np.bool_]], Curve], keep: NDArray[np.bool_], curve: Curve, end: End
) -> tuple[int, Curve] | None:
    """Return the point without which the reachable part goes on behind an end, and the curve without it."""
    at = curve.y[end.place], curve.z[end.place]
    kept = np.flatnonzero(keep)
    nearest = int(np.hypot(y[kept] - at[0], z[kept] - at[1]).argmin())
    around = kept[max(nearest - NEAR, 0) : nearest + NEAR + 1]
    size = float(np.hypot(y[around[0]] - y[around[-1]], z[around[0]] - z[around[-1]]))
    choices: list[tuple[float, int, Curve]] = []  # with the sharpest bend, least without the point that is off
    for spot in around.tolist():
        rest = keep.copy()
        rest[spot] = False
        new = through(rest)
        if all(np.hypot(new.y[other.place] - at[0], new.z[other.place] - at[1]) > size for other in _early(new)):
            near = np.hypot(new.y - at[0], new.z - at[1]) < size
            choices.append((float(np.abs(new.curvature[near]).max(initial=0.0)), spot, new))
    return min(choices, key=lambda choice: choice[0])[1:] if choices else None
