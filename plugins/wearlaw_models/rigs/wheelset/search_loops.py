"""The contact search of `_search` in loops that numba compiles, and the formulas that both share."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

import wearlaw as wl
from wearlaw import Array

PATCHES = 3
"""Greatest number of contact patches of a wheel."""

FIRST = 4
"""One in so many coarse points gives the first estimate of the roll."""

ROLLS = 30
"""Greatest number of iterations for the roll; four or five are usual."""

ROLL_ACCURACY = 1e-12
"""Step of the roll that ends its search [rad]."""

ROOTS = 40
"""Greatest number of iterations for a contact point; eight to twelve are usual."""

LEAST_LEVER = 0.005
"""Smallest lever in a step of the roll [m]."""

MOST_ROLL = 5e-3
"""Greatest step of the roll [rad]."""

WINDOW = 16
"""Coarse points around a contact point among which it is looked for after a small roll: 8 mm."""

ROUNDING = 1e-12
"""Difference between slopes at a contact point that is rounding."""

VECTOR = "float64[::1]"
ROWS = "float64[:, ::1]"
TABLES = f"UniTuple(Tuple((float64, float64, {ROWS})), 3)"
"""Start, step and cubics of the tables of a wheel's y and radius over its arc length, and of its rail's z over y."""


def locus(
    y: Any, radius: Any, slope: Any, displacement: Any, turn: tuple[Any, Any, Any, Any], axes: float
) -> tuple[Any, ...]:
    """Return x, y and z of points of the locus of contact, and the slope dz/dy of the locus there.

    Parameters
    ----------
    y, radius, slope : float or ndarray
        Distance from the middle of the wheelset [m], R [m] and R' of the profile.
    displacement : float or ndarray
        Lateral displacement of the wheelset [m].
    turn : tuple
        The sine and the cosine of the roll, and those of the yaw.
    axes : float
        Curvature of a roller in place of the rail, 1 over the distance between its axis and the axle [1/m]; 0 for a
        rail. z is then that of the circle about this axis, above the axis.
    """
    sin_roll, cos_roll, sin_yaw, cos_yaw = turn
    tan_yaw = sin_yaw / cos_yaw
    lean, ahead = tan_yaw * sin_roll, tan_yaw * cos_roll
    if axes == 0.0:
        return of_circle(y, radius, slope, displacement, turn, lean, ahead)
    meets = axes * (y + radius * slope)  # where the normals of a circle meet the axle
    tilt = meets * ahead / (1.0 - meets * sin_roll)
    lean, ahead = lean - tilt * cos_roll, ahead + tilt * sin_roll
    x, across, z, steep = of_circle(y, radius, slope, displacement, turn, lean, ahead)
    turned, above = axes * x, np.abs(1.0 - axes * z)  # of points beside any rail it may be negative
    z = z - turned * x / (above + np.sqrt(above * above + turned * turned))
    return x, across, z, steep / np.sqrt(1.0 + (tilt * cos_yaw) ** 2)


def of_circle(
    y: Any, radius: Any, slope: Any, displacement: Any, turn: tuple[Any, Any, Any, Any], lean: Any, ahead: Any
) -> tuple[Any, ...]:
    """Return the point of a circle at sin(α + β) = -ahead R' cos β with tan β = lean, and the slope there."""
    sin_roll, cos_roll, sin_yaw, cos_yaw = turn
    scale = 1.0 / np.sqrt(1.0 + lean * lean)
    sine = -ahead * scale * slope
    cosine = np.sqrt(np.maximum(1.0 - sine * sine, 0.0))
    sin_angle = scale * (sine - lean * cosine)
    cos_angle = scale * (cosine + lean * sine)
    upright, along = radius * cos_angle, radius * sin_angle
    across = y * cos_roll - upright * sin_roll
    normal_y = sin_angle * sin_yaw - cos_yaw * (slope * cos_roll + cos_angle * sin_roll)
    normal_z = cos_angle * cos_roll - slope * sin_roll
    return (
        along * cos_yaw - across * sin_yaw,
        across * cos_yaw + along * sin_yaw + displacement,
        y * sin_roll + upright * cos_roll,
        -normal_y / normal_z,
    )


def roll_step(excess: Any, lever: Any) -> Any:
    """Return the change of roll that levels the gaps, by Newton's method [rad].

    A roll by dρ changes the least gap of a side by -(y + z tan δ) dρ: it lowers the wheel by y and moves its bottom
    across the rail by z. On a flange the two nearly cancel.

    Parameters
    ----------
    excess : float or ndarray
        Least gap of the right side minus that of the left one [m].
    lever : float or ndarray
        Sum of y + z tan δ of both sides [m].
    """
    return np.minimum(np.maximum(excess / np.maximum(np.abs(lever), LEAST_LEVER), -MOST_ROLL), MOST_ROLL)


def cubic(t: Any, step: float, coefficients: Any) -> tuple[Any, Any]:
    """Return the value and the slope at t from 0 to 1 of a cubic in a cell of a table."""
    value, first, square, cube = coefficients
    return value + t * (first + t * (square + t * cube)), (first + t * (2.0 * square + 3.0 * t * cube)) / step


def at(x: float, table: tuple[float, float, Array]) -> tuple[float, float]:
    """Return the value and the slope of a table at x; beyond its ends those of the outermost cubic."""
    start, step, cubics = table
    share = (x - start) / step
    index = min(max(int(share), 0), cubics.shape[1] - 1)
    of_cell = cubics[0, index], cubics[1, index], cubics[2, index], cubics[3, index]
    values: tuple[float, float] = cubic(share - index, step, of_cell)
    return values


def ends(table: tuple[float, float, Array]) -> tuple[float, float]:
    """Return the ends of a table."""
    start, step, cubics = table
    return start, start + step * cubics.shape[1]


def below(
    arc: float, tables: Any, shift: float, turn: tuple[float, float, float, float], axes: float
) -> tuple[float, ...]:
    """Return y and z of the locus at an arc length of the wheel, its slope dz/dy, and z and slope of the rail there."""
    there, d_there = at(arc, tables[0])
    size, d_size = at(arc, tables[1])
    _, across, down, steep = locus(there, size, d_size / d_there, shift, turn, axes)
    rail, rail_slope = at(across, tables[2])
    return across, down, steep, rail, rail_slope


def touch(
    shift: float,
    turn: tuple[float, float, float, float],
    axes: float,
    every: int,
    points: tuple[Array, Array, Array, Array],
    tables: Any,
    gap: Array,
    rise: Array,
    height: Array,
    cell: Any,
    place: Array,
    contacts: Array,
    above: Array,
) -> tuple[float, float]:
    """Find the contact points of one wheel, and return its least gap and the lever of a roll [m].

    One in `every` coarse points is read. If that is zero, they are looked for around the first of those in `contacts`.
    """
    arc, y, radius, slope = points
    spacing = arc[2] - arc[1]
    lever = 0.0
    begin, end = 0, arc.size
    if not every:
        every = 1
        middle = int((contacts[0] - arc[0]) / spacing) + 1
        begin = min(max(middle - WINDOW // 2, 0), arc.size - WINDOW)
        end = begin + WINDOW
    for patch in range(PATCHES):
        place[patch], height[patch], cell[patch] = np.nan, np.inf, -1
    moved = abs(turn[0]) + abs(turn[2])
    lean, ahead = turn[2] / turn[3] * turn[0], turn[2] / turn[3] * turn[1]
    first, last = ends(tables[2])
    for k in range(begin, end, every):
        away = moved * (radius[k] + y[k])  # farther than roll and yaw move the point across the rail
        gap[k], rise[k] = np.inf, 0.0
        if first - away <= y[k] + shift <= last + away:
            if axes != 0.0:
                _, across, down, steep = locus(y[k], radius[k], slope[k], shift, turn, axes)
            else:  # what all points share is outside of the loop, which saves a third
                _, across, down, steep = of_circle(y[k], radius[k], slope[k], shift, turn, lean, ahead)
            if first <= across < last:
                rail, rail_slope = at(across, tables[2])
                gap[k], rise[k] = rail - down, rail_slope - steep
        if k == begin:
            continue
        before = k - every
        falls = rise[before] < 0.0 or gap[before] == np.inf
        low = falls and rise[k] >= 0.0 and gap[k] < np.inf
        if not low and not (rise[before] < 0.0 and gap[before] < np.inf and gap[k] == np.inf):
            continue
        size = min(gap[before], gap[k])
        rank = PATCHES - 1
        if size >= height[rank]:
            continue
        while rank > 0 and size < height[rank - 1]:
            height[rank], cell[rank] = height[rank - 1], cell[rank - 1]
            rank -= 1
        height[rank], cell[rank] = size, before
    for patch in range(PATCHES):
        k = cell[patch]
        if k < 0:
            continue
        left, right = float(arc[k]), float(arc[k + every])
        if gap[k] == np.inf:
            left = right
        if gap[k + every] == np.inf:
            right = left
        at_left = at_right = 0.0
        for iteration in range(ROOTS + 2):
            root = left if iteration == 0 else right  # the ends first
            if iteration > 1:
                share = at_right / (at_right - at_left) if at_right != at_left else 0.0
                root = right - share * (right - left)
            _, down, steep, rail, rail_slope = below(root, tables, shift, turn, axes)
            value = rail_slope - steep
            if iteration == 0:
                at_left = value
                continue
            height[patch] = rail - down
            if iteration == 1:
                at_right = value
                continue
            if value * at_right > 0.0:
                at_left *= 0.5
            else:
                left, at_left = right, at_right
            right, at_right = root, value
            if abs(value) < ROUNDING or right == left:
                break
        place[patch] = right
    for done in range(PATCHES - 1):  # sort by the gap at the roots
        for patch in range(PATCHES - 1 - done):
            if height[patch + 1] < height[patch]:
                height[patch], height[patch + 1] = height[patch + 1], height[patch]
                place[patch], place[patch + 1] = place[patch + 1], place[patch]
                cell[patch], cell[patch + 1] = cell[patch + 1], cell[patch]
    if cell[0] >= 0:
        across, down, _, _, rail_slope = below(place[0], tables, shift, turn, axes)
        lever = across + rail_slope * down
    for patch in range(PATCHES):
        contacts[patch] = place[patch]
        above[patch] = height[patch] - height[0] if cell[patch] >= 0 else np.nan
    return height[0], lever


@wl.compiled_loop(
    f"void({VECTOR}, {VECTOR}, boolean, UniTuple(UniTuple({VECTOR}, 4), 2), UniTuple({TABLES}, 2), float64, {VECTOR},"
    " float64[:, :, ::1], float64[:, :, ::1], float64[:, ::1])"
)
def compiled_search(
    displacement: Array,
    yaw: Array,
    fixed: bool,
    points: tuple[Any, Any],
    tables: tuple[Any, Any],
    axes: float,
    roll: Array,
    contacts: Array,
    above: Array,
    least: Array,
) -> None:
    """Find the roll, unless it is given, and the contact points of both wheels at each position.

    Coarse points and tables are those of the left and the right side.
    """
    most = max(points[0][0].size, points[1][0].size)
    gap, rise = np.empty(most), np.empty(most)
    height, cell, place = np.empty(PATCHES), np.empty(PATCHES, np.int64), np.empty(PATCHES)
    for point in range(displacement.size):
        sin_yaw, cos_yaw = math.sin(yaw[point]), math.cos(yaw[point])
        every = 1 if fixed else FIRST  # all points once the roll is found
        for _ in range(ROLLS):
            sin_roll, cos_roll, levers = math.sin(roll[point]), math.cos(roll[point]), 0.0
            for side in range(2):
                out = 2.0 * side - 1.0
                least[point, side], lever = touch(
                    out * displacement[point], (out * sin_roll, cos_roll, out * sin_yaw, cos_yaw), axes,
                    every, points[side], tables[side], gap, rise, height, cell, place,
                    contacts[point, side], above[point, side],
                )  # fmt: skip
                levers += lever
            step = roll_step(least[point, 1] - least[point, 0], levers)
            lost = math.isnan(contacts[point, 0, 0]) or math.isnan(contacts[point, 1, 0])
            level = not abs(step) > ROLL_ACCURACY
            if fixed or (every == 1 and level):
                break
            every = 1 if lost or level else 0
            if not every:
                roll[point] += step
