"""Checks of the points of a profile; each error says where, and what to do."""

from __future__ import annotations

from collections.abc import Callable

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
SHARPEST = 150.0
"""Turn at a point beyond which the profile runs back on itself [deg]."""
NARROWEST, WIDEST = 5e-3, 300e-3
"""Bounds of the width of a profile, from that of a small roller [m]."""
CLEAR = 5e-3
"""Height by which a profile must stand out to show which way up it is, or on which side its flange is [m]."""
TIP = 1e-3
"""Height by which the top of a flange stands above both ends of the profile [m]."""
BLOCK = 64
"""Steps in a block whose bounding box is compared with those of others."""


Name = Callable[[int], str]
"""Returns the name of a point in messages from its index."""


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
    _refuse(~(np.isfinite(y) & np.isfinite(z)), y, z, name, "is not finite", "leave it out")
    with np.errstate(over="ignore"):  # an infinite extent is refused
        width, height = y.max() - y.min(), z.max() - z.min()
    if not NARROWEST <= width <= WIDEST:
        hint = "; were they in metres? Give their unit" if width < WIDEST * 1e-3 else ""
        hint = "; is their unit right?" if width > WIDEST else hint
        hint = "; are y and z swapped?" if width < NARROWEST <= height <= WIDEST else hint
        raise wl.InputError(
            f"the points are {_mm(width)} wide, but a profile has {1e3 * NARROWEST:g} to {1e3 * WIDEST:g} mm{hint}"
        )
    if height > WIDEST:
        raise wl.InputError(
            f"the points are {_mm(height)} high, but a profile has at most {1e3 * WIDEST:g} mm; is their unit right?"
        )
    step_y, step_z = np.diff(y), np.diff(z)
    step = np.hypot(step_y, step_z)
    _refuse(np.append(False, step < LEAST_STEP), y, z, name, "is the same as the point before", "leave one of them out")
    cross = step_y[:-1] * step_z[1:] - step_z[:-1] * step_y[1:]
    turn = np.abs(np.arctan2(cross, step_y[:-1] * step_y[1:] + step_z[:-1] * step_z[1:]))
    back = np.zeros(y.size, dtype=np.bool_)
    back[1:-1] = turn > np.deg2rad(SHARPEST)
    _refuse(back, y, z, name, "is where the profile runs back on itself", "put the points in their order")
    longest = max(LONGEST_STEP, TIMES_MEDIAN * float(np.median(step)))
    _refuse(
        np.append(step > longest, False),
        y,
        z,
        name,
        f"has a gap behind it: the next point is {_mm(step.max())} away, the median distance is"
        f" {_mm(float(np.median(step)))}",
        f"add points, so that no two are further apart than {_mm(longest)}, or cut the profile there",
    )
    crossing = crossed_steps(y, z)
    if crossing is not None:
        first, second = crossing
        raise wl.InputError(
            f"the profile crosses itself: the line behind {point(first, y, z, name)} meets that behind"
            f" {point(second, y, z, name)}; leave out the points of the loop, or put all points in their order"
        )


def check_orientation(kind: str, y: Array, z: Array, name: Name) -> None:
    """Raise an error if a profile is upside down, or if a wheel has its flange at y > 0.

    Raises
    ------
    InputError
        If y and z are swapped, or if the profile stands out from its median height by more than 5 mm to the wrong side.
    """
    if swapped(kind, y, z):
        raise wl.InputError(
            f"the {kind} lies on its side: it is {_mm(float(np.ptp(y)))} wide and {_mm(float(np.ptp(z)))} high; are y"
            " and z swapped? y goes across the track and comes first in a file, unless its columns are named"
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
        raise wl.InputError(
            f"the {kind} is upside down: z is positive down, but its {part} has {point(place, y, z, name)}, above its"
            f" median height of {_mm(level)}; change the sign of z, in a file by mirror_z=True"
        )
    place = int(np.argmax(z))
    if kind != "wheel" or down <= CLEAR or y[place] < 0.0:
        return
    flange = point(place, y, z, name)
    if y[place] > 0.5 * (y.min() + y.max()):
        raise wl.InputError(
            f"the wheel is mirrored: its flange must be at y < 0, but has {flange}; change the sign of y, in a file by"
            " mirror_y=True. A left wheel has the same profile as a right one"
        )
    raise wl.InputError(
        f"the wheel must have its origin at the taping line, with the flange at y < 0, but its flange has {flange};"
        ' shift it, in a file by shift_y, such as shift_y="-70 mm" if y = 0 is the back of the flange'
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


def _refuse(wrong: NDArray[np.bool_], y: Array, z: Array, name: Name, what: str, fix: str) -> None:
    places = np.flatnonzero(wrong)
    if places.size:
        more = f" ({places.size} points in all)" if places.size > 1 else ""
        raise wl.InputError(f"{point(int(places[0]), y, z, name)} {what}{more}; {fix}")


def point(index: int, y: Array, z: Array, name: Name) -> str:
    """Return the name and place of a point in messages."""
    return f"{name(index)} (y = {_mm(y[index])}, z = {_mm(z[index])})"


def _mm(value: float) -> str:
    return f"{1e3 * value:.6g} mm"
