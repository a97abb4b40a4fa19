"""The march of `_march` in loops that numba compiles, and formulas of one strip and one cell that NumPy shares."""

from __future__ import annotations

import math
from typing import Any, TypeVar

import numpy as np

import wearlaw as wl
from wearlaw import Array

WIDTH = 1000
"""Most strips of a compiled march; not a power of two, so that the rows do not compete for the same cache lines."""

Y, HALF_LENGTH, GROW_X, GROW_Y, TURN, BOUND, TO_SLIP_X, TO_SLIP_Y, SLIP_Y = (WIDTH * row for row in range(1, 10))
"""Starts of the rows, as constants that let a compiler see that the rows do not overlap."""

SIGNATURE = f"void(float64[:, ::1], boolean, {', '.join(['float64[:, :, ::1]'] * 6)})"

Number = TypeVar("Number", float, Array)


def strip(ellipse: Any, elliptic: bool, v: Number, s: Number, count: int) -> tuple[Number, ...]:
    """Return values shared by all cells of the strip at y = b v, s = √(1-v²), from the quantities of an ellipse.

    They are half the strip's length; half the growth of the traction in a cell along x, along y at x = 0, and along y
    by x over the half length; half the bound at x = 0; and slip over half the clipped traction, along x and y.
    """
    a, b, creepage_x, creepage_y = ellipse[0], ellipse[1], ellipse[2], ellipse[3]
    spin, flexibility_x, flexibility_y, flexibility_spin = ellipse[4], ellipse[5], ellipse[6], ellipse[7]
    half_length = a * s
    length = half_length * (2.0 / count)
    half_spin = 0.5 * spin / flexibility_spin * length
    return (
        half_length,
        0.5 * creepage_x / flexibility_x * length - half_spin * b * v,
        0.5 * creepage_y / flexibility_y * length,
        -half_spin * half_length,
        0.5 * ellipse[8] * (s if elliptic else s * s),
        2.0 * flexibility_x / length,
        2.0 * flexibility_y / length,
    )


def along(k: int, count: int, elliptic: bool) -> tuple[float, float]:
    """Return x over the half length in the middle of a cell, and the bound at its end over the bound at x = 0."""
    end = 4.0 * (k + 1) * (count - k - 1) / (count * count)
    return (2 * k + 1 - count) / count, math.sqrt(end) if elliptic else end


@wl.compiled_loop(SIGNATURE)
def compiled_march(
    ellipses: Array,
    elliptic: bool,
    x: Array,
    traction_x: Array,
    traction_y: Array,
    slip_x: Array,
    slip_y: Array,
    bound: Array,
) -> None:
    """Fill the cells of ellipses, (points, quantities), one after the other; at most `WIDTH` strips."""
    points, count, strips = x.shape
    rows = np.empty(10 * WIDTH)
    for p in range(points):
        _start_rows(rows, ellipses[p], elliptic, count, strips)
        _march_rows(rows, elliptic, x[p], traction_x[p], traction_y[p], slip_x[p], slip_y[p], bound[p])


def _start_rows(rows: Array, ellipse: Array, elliptic: bool, count: int, strips: int) -> None:
    """Lay out the strips of a patch side by side."""
    for i in range(strips):
        v = (2.0 * i + 1.0) / strips - 1.0
        s = math.sqrt(1.0 - v * v)
        length, grow_x, grow_y, turn, bound, to_slip_x, to_slip_y = strip(ellipse, elliptic, v, s, count)
        rows[i] = rows[Y + i] = 0.0
        rows[HALF_LENGTH + i] = length
        rows[GROW_X + i], rows[GROW_Y + i], rows[TURN + i] = grow_x, grow_y, turn
        rows[BOUND + i], rows[TO_SLIP_X + i], rows[TO_SLIP_Y + i] = bound, to_slip_x, to_slip_y


def _march_rows(
    rows: Array,
    elliptic: bool,
    x: Array,
    traction_x: Array,
    traction_y: Array,
    slip_x: Array,
    slip_y: Array,
    bound: Array,
) -> None:
    """March along the strips of a patch, in two loops: compilers give up on loops that write too many arrays."""
    before, count = 0.0, x.shape[0]
    for k in range(count):
        middle, end = along(k, count, elliptic)
        to_traction_x, to_traction_y, to_slip_x = traction_x[k], traction_y[k], slip_x[k]
        to_x, to_slip_y, to_bound = x[k], slip_y[k], bound[k]
        for i in range(to_x.size):
            free_x = rows[i] + rows[GROW_X + i]
            free_y = rows[Y + i] + (rows[TURN + i] * middle + rows[GROW_Y + i])
            share = rows[BOUND + i] * end / math.sqrt(free_x * free_x + free_y * free_y)
            share = share if share < 1.0 else 1.0
            next_x, next_y = free_x * share, free_y * share
            to_traction_x[i] = rows[i] + next_x
            to_traction_y[i] = rows[Y + i] + next_y
            to_slip_x[i] = (free_x - next_x) * rows[TO_SLIP_X + i]
            rows[SLIP_Y + i] = (free_y - next_y) * rows[TO_SLIP_Y + i]
            rows[i], rows[Y + i] = next_x, next_y
        for i in range(to_x.size):
            to_slip_y[i] = rows[SLIP_Y + i]
            to_x[i] = rows[HALF_LENGTH + i] * middle
            to_bound[i] = rows[BOUND + i] * (before + end)
        before = end
