"""Checks of the points of a profile; each error says where, and what to do."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

import wearlaw as wl
from wearlaw import Array

FEWEST, MOST = 10, 20_000
"""Smallest and largest number of points."""
LEAST_STEP = 1e-9
"""Distance below which two points are the same [m]."""
LONGEST_STEP, TIMES_MEDIAN = 5e-3, 10.0
"""A step that is longer [m], and longer than so many times the median one, is a gap."""
LOOP = 0.1
"""Greatest share of the points in a loop that may be left out."""
SHARPEST = 150.0
"""Turn at a point beyond which the profile runs back on itself [deg]."""
NARROWEST, WIDEST = 5e-3, 300e-3
"""Bounds of the width of a profile, from that of a small roller [m]."""
CLEAR = 5e-3
"""Height by which a profile must stand out to show which way up it is, or on which side its flange is [m]."""
TIP = 1e-3
"""Height by which the top of a flange stands above both ends of the profile [m]."""
UPRIGHT = np.radians(80.0)
"""Slope from which a side is too steep to touch [rad], so that two points are enough for a straight one."""
FLANGE_BACK = -70e-3
"""Usual place of the back of a flange [m]."""
BACK = 5e-3
"""Distance from y = 0 up to which the end of a wheel's profile is taken for the back of its flange [m]."""
MIRROR_Y, MIRROR_Z = "mirror_y=True", "mirror_z=True"
"""What mends points that are mirrored or upside down."""
BLOCK = 64
"""Steps in a block whose bounding box is compared with those of others."""


Name = Callable[[int], str]
"""Returns the name of a point in messages from its index."""


class Repair(NamedTuple):
    """How to mend points: leave some out, change coordinates by a matrix and a shift [m], or fill gaps straight."""

    text: str
    leave_out: NDArray[np.intp] = np.empty(0, dtype=np.intp)
    matrix: tuple[tuple[float, float], tuple[float, float]] = ((1.0, 0.0), (0.0, 1.0))
    shift_y: float = 0.0
    fill: bool = False


class PointsError(wl.InputError):
    """Points make no profile; `repair` does what the message suggests, if that is clear."""

    def __init__(self, message: str, repair: Repair | None = None) -> None:
        super().__init__(message)
        self.repair = repair


def check_points(y: Array, z: Array, name: Name) -> None:
    """Raise an error if points [m] cannot be joined to one profile in their order; `name` names a point by its index.

    Raises
    ------
    InputError
        If there are fewer than 10 points or more than 20 000, or if points are not finite, doubled, out of order, far
        apart, or on lines that cross.
    """
    if y.size != z.size:
        raise wl.InputError(f"y and z must have the same number of values, got {y.size} and {z.size}")
    if not FEWEST <= y.size <= MOST:
        raise wl.InputError(f"a profile needs {FEWEST} to {MOST} points, got {y.size}")
    infinite = ~(np.isfinite(y) & np.isfinite(z))
    _refuse(infinite, y, z, name, "is not finite", "leave it out", _without(infinite))
    with np.errstate(over="ignore"):  # an infinite extent is refused
        width, height = y.max() - y.min(), z.max() - z.min()
    if not NARROWEST <= width <= WIDEST:
        hint, repair = "", None
        if width < NARROWEST <= height <= WIDEST:
            hint, repair = "; are y and z swapped?", Repair("y and z swapped", matrix=((0.0, 1.0), (1.0, 0.0)))
        elif width < WIDEST * 1e-3:
            hint = "; were they in metres? Give their unit"
            repair = Repair("taken in metres", matrix=((1e3, 0.0), (0.0, 1e3)))
        elif width > WIDEST:
            hint = "; is their unit right?"
        raise PointsError(
            f"the points are {_mm(width)} wide, but a profile has {1e3 * NARROWEST:g} to {1e3 * WIDEST:g} mm{hint}",
            repair,
        )
    if height > WIDEST:
        raise wl.InputError(
            f"the points are {_mm(height)} high, but a profile has at most {1e3 * WIDEST:g} mm; is their unit right?"
        )
    step_y, step_z = np.diff(y), np.diff(z)
    step = np.hypot(step_y, step_z)
    same = np.append(False, step < LEAST_STEP)
    _refuse(same, y, z, name, "is the same as the point before", "leave one of them out", _without(same))
    cross = step_y[:-1] * step_z[1:] - step_z[:-1] * step_y[1:]
    turn = np.abs(np.arctan2(cross, step_y[:-1] * step_y[1:] + step_z[:-1] * step_z[1:]))
    back = np.zeros(y.size, dtype=np.bool_)
    back[1:-1] = turn > np.deg2rad(SHARPEST)
    advice = "put the points in their order, or leave out those that run back, in a file by repair=True"
    _refuse(back, y, z, name, "is where the profile runs back on itself", advice, _shorter(back, y, z))
    gaps = _gaps(y, z)
    longest = max(LONGEST_STEP, TIMES_MEDIAN * float(np.median(step)))
    _refuse(
        np.append(gaps & ~_upright(y, z), False),
        y,
        z,
        name,
        f"has a gap behind it: the next point is {_mm(step.max())} away, the median distance is"
        f" {_mm(float(np.median(step)))}",
        f"add points, so that no two are further apart than {_mm(longest)}, or cut the profile there; if it is straight"
        " there, in a file give repair=True",
        Repair("filled by a straight line", fill=True),
    )
    crossing = crossed_steps(y, z)
    if crossing is not None:
        first, second = crossing
        loop = np.arange(first + 1, second + 1)
        raise PointsError(
            f"the profile crosses itself: the line behind {point(first, y, z, name)} meets that behind"
            f" {point(second, y, z, name)}; leave out the points of the loop, or put all points in their order",
            Repair("left out", loop) if loop.size <= LOOP * y.size else None,
        )


def _gaps(y: Array, z: Array) -> NDArray[np.bool_]:
    """Return which steps between points are gaps."""
    step = np.hypot(np.diff(y), np.diff(z))
    return step > max(LONGEST_STEP, TIMES_MEDIAN * float(np.median(step)))


def _upright(y: Array, z: Array) -> NDArray[np.bool_]:
    """Return which steps are too steep to touch, or undercut."""
    along = np.diff(y) * (1.0 if y[-1] >= y[0] else -1.0)
    upright: NDArray[np.bool_] = along < np.cos(UPRIGHT) * np.hypot(np.diff(y), np.diff(z))
    return upright


def filled(y: Array, z: Array, *more: Array, every: bool = False) -> tuple[Array, ...]:
    """Return points [m], and more values of them, with points on the straight sides that are given by their ends.

    With `every` all gaps are filled, otherwise those that are too steep to touch.
    """
    gaps = _gaps(y, z) if every else _gaps(y, z) & _upright(y, z)
    step = np.hypot(np.diff(y), np.diff(z))
    count = np.where(gaps, np.ceil(step / np.median(step)), 1.0)
    place = np.append(0.0, np.cumsum(count))
    return tuple(np.interp(np.arange(place[-1] + 1.0), place, value) for value in (y, z, *more))


def check_orientation(kind: str, y: Array, z: Array, name: Name) -> None:
    """Raise an error if a profile is upside down, or if a wheel has its flange at y > 0.

    Raises
    ------
    InputError
        If y and z are swapped, or if the profile stands out from its median height by more than 5 mm to the wrong side.
    """
    if swapped(kind, y, z):
        raise PointsError(
            f"the {kind} lies on its side: it is {_mm(float(np.ptp(y)))} wide and {_mm(float(np.ptp(z)))} high; are y"
            " and z swapped? y goes across the track and comes first in a file, unless its columns are named",
            Repair("y and z swapped", matrix=((0.0, 1.0), (1.0, 0.0))),
        )
    order = np.argsort(y)
    across = np.linspace(y.min(), y.max(), 201)
    level = float(np.median(np.interp(across, y[order], z[order])))
    up, down = level - float(z.min()), float(z.max()) - level
    # The field side of a wheel may rise more than its flange falls, up to the end of the profile. A rail that is upside
    # down has its highest places at its ends; a nose between low plates has not.
    at_end = z.min() + TIP >= min(z[0], z[-1])
    if up > max(down, CLEAR) and at_end == (kind == "rail"):
        part = "flange" if kind == "wheel" else "side"
        place = int(np.argmin(z))
        raise PointsError(
            f"the {kind} is upside down: z is positive down, but its {part} has {point(place, y, z, name)}, above its"
            f" median height of {_mm(level)}; change the sign of z, in a file by mirror_z=True",
            Repair(MIRROR_Z, matrix=((1.0, 0.0), (0.0, -1.0))),
        )
    place = int(np.argmax(z))
    if kind != "wheel" or down <= CLEAR:
        return
    flange = point(place, y, z, name)
    if y[place] > 0.5 * (y.min() + y.max()):
        raise PointsError(
            f"the wheel is mirrored: its flange must be where y is least, but has {flange}; change the sign of y, in a"
            f" file by {MIRROR_Y}. A left wheel has the same profile as a right one",
            Repair(MIRROR_Y),
        )
    if y[place] < 0.0 < y.max():
        return
    back = float(y.min()) if y.min() < 0.0 or y.min() > BACK else 0.0
    shift = f'shift_y="{1e3 * (FLANGE_BACK - back):.6g} mm"'
    raise PointsError(
        f"the wheel must have its origin at the taping line, with the flange at y < 0, but its flange has {flange};"
        f" shift it, in a file by shift_y, such as {shift} if y = {_mm(back)} is the back of the flange",
        Repair(shift, shift_y=FLANGE_BACK - back) if abs(y.min()) < BACK else None,
    )


def swapped(kind: str, y: Array, z: Array) -> bool:
    """Return whether a profile lies on its side: a wheel that is higher than wide, or a rail whose top looks sideways.

    Such a rail has its ends above each other, and its middle beside both. The gauge side alone has its middle between
    its ends, and a whole rail has its ends beside each other.
    """
    if np.ptp(y) >= np.ptp(z):
        return False
    ends = sorted((float(y[0]), float(y[-1])))
    beside = y.min() < ends[0] - CLEAR or y.max() > ends[1] + CLEAR
    return kind == "wheel" or bool(beside and abs(z[-1] - z[0]) > 0.5 * np.ptp(z))


def crossed_steps(y: Array, z: Array) -> tuple[int, int] | None:
    """Return the first two steps between points that cross each other, by the indices of their first points."""
    if (np.diff(y) > 0.0).all():  # no step comes back to the y of another
        return None
    count = y.size - 1
    starts = np.arange(0, count, BLOCK)
    low, high = [], []
    for value in (y, z):
        least, most = np.minimum(value[:-1], value[1:]), np.maximum(value[:-1], value[1:])
        low.append(np.minimum.reduceat(least, starts))
        high.append(np.maximum.reduceat(most, starts))
    near = np.ones((starts.size, starts.size), dtype=np.bool_)
    for least, most in zip(low, high, strict=True):
        near &= (least[:, None] <= most) & (least <= most[:, None])
    for first, second in BLOCK * np.argwhere(np.triu(near)):
        step = first + np.arange(min(BLOCK, count - first))[:, None]
        other = second + np.arange(min(BLOCK, count - second))[None, :]
        crosses = (other > step + 1) & _cross(y, z, step, other)
        if crosses.any():
            row, column = np.argwhere(crosses)[0]
            return int(step[row, 0]), int(other[0, column])
    return None


def _cross(y: Array, z: Array, first: NDArray[np.intp], second: NDArray[np.intp]) -> NDArray[np.bool_]:
    """Return whether steps cross or touch each other."""

    def side(step: NDArray[np.intp], point: NDArray[np.intp]) -> Array:
        """Return on which side of a step a point lies."""
        return np.sign((y[step + 1] - y[step]) * (z[point] - z[step]) - (z[step + 1] - z[step]) * (y[point] - y[step]))

    crosses: NDArray[np.bool_] = (side(first, second) * side(first, second + 1) <= 0.0) & (
        side(second, first) * side(second, first + 1) <= 0.0
    )
    # Steps on one line fulfil both conditions wherever they are, so the boxes around them must meet too.
    for value in (y, z):
        least = np.minimum(value[first], value[first + 1]), np.minimum(value[second], value[second + 1])
        most = np.maximum(value[first], value[first + 1]), np.maximum(value[second], value[second + 1])
        crosses = crosses & (least[0] <= most[1]) & (least[1] <= most[0])
    return crosses


def _refuse(
    wrong: NDArray[np.bool_], y: Array, z: Array, name: Name, what: str, fix: str, repair: Repair | None
) -> None:
    places = np.flatnonzero(wrong)
    if places.size:
        more = f" ({places.size} points in all)" if places.size > 1 else ""
        raise PointsError(f"{point(int(places[0]), y, z, name)} {what}{more}; {fix}", repair)


def _without(wrong: NDArray[np.bool_]) -> Repair:
    return Repair("left out", np.flatnonzero(wrong))


def _shorter(back: NDArray[np.bool_], y: Array, z: Array) -> Repair | None:
    """Return the repair of the first place at which a profile runs back: without the point there, or the next one.

    The line is shorter without the one that is wrong.
    """
    if not back.any():
        return None
    first = int(back.argmax())

    def length(without: int) -> float:
        return float(np.hypot(np.diff(np.delete(y, without)), np.diff(np.delete(z, without))).sum())

    return Repair("left out", np.array([min(first, first + 1, key=length)]))


def point(index: int, y: Array, z: Array, name: Name) -> str:
    """Return the name and place of a point in messages."""
    return f"{name(index)} (y = {_mm(y[index])}, z = {_mm(z[index])})"


def _mm(value: float) -> str:
    return f"{1e3 * value:.6g} mm"
