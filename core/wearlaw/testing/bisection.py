"""Jumps and lost digits of a function of one number, for many such functions at once.

A continuous function changes less and less over an interval that is halved again and again; a jump stays.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from wearlaw.arrays import Array

HALVINGS = 46
"""From 1/32 to 4e-16, the rounding of a number near 1."""

JUMP = 1e-6
"""Share of the function's value that counts as a jump. What grows as steeply as a square root, the steepest onset of
the theories of contact, changes by √(2^-46) = 1.2e-7 over the last interval."""

Indices: TypeAlias = NDArray[np.intp]

Function: TypeAlias = Callable[[Indices, Array], Array]
"""From indices of functions and their arguments in [0, 1], both of shape (n,), to values."""


def find_jumps(function: Function, count: int, intervals: int = 32) -> list[tuple[int, float, float, float]]:
    """Return the jumps of functions of one number: index, argument, and the values before and behind it.

    In each of `intervals` equal parts of [0, 1] the half over which the function changes more, relative to its size,
    is kept again and again. A jump is found if it exceeds what the curvature does in an interval.
    """
    edges = np.linspace(0.0, 1.0, intervals + 1)
    index = np.repeat(np.arange(count), intervals)
    low, high = np.tile(edges[:-1], count), np.tile(edges[1:], count)
    at_low, at_high = function(index, low), function(index, high)
    size = np.maximum(np.abs(at_low), np.abs(at_high))
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        at_middle = function(index, middle)
        left = _change(at_low, at_middle) >= _change(at_middle, at_high)
        low, at_low = np.where(left, low, middle), np.where(left, at_low, at_middle)
        high, at_high = np.where(left, middle, high), np.where(left, at_middle, at_high)
    found = np.flatnonzero(np.abs(at_high - at_low) > JUMP * size)
    return [(int(index[i]), float(high[i]), float(at_low[i]), float(at_high[i])) for i in found]


def _change(before: Array, behind: Array) -> Array:
    total = np.abs(before) + np.abs(behind)
    change: Array = np.divide(np.abs(behind - before), total, out=np.zeros_like(total), where=total > 0)
    return change


def lost_digits(function: Callable[[float], Array], message: str) -> None:
    """Assert that a function of a factor near 1 resolves changes of 1e-8, which single precision does not.

    With D(h) the change over h relative to the value, a smooth function has D(1e-8) = D(1e-5) to about 1e-5, and
    double precision rounds D(1e-8) by about 1e-16/1e-8. Single precision, with its 6e-8, leaves 0 or 6 of it.
    Entries where D(1e-4) and D(1e-5) differ hold a kink or a jump and are passed over; a kink within 1e-8 lies on
    one side only.
    """
    here = function(1.0)
    lost = np.ones(here.shape, dtype=bool)
    worst = np.zeros(here.shape)
    for side in (-1.0, 1.0):
        coarse, middle, fine = (_slope(function, here, side * step) for step in (1e-4, 1e-5, 1e-8))
        smooth = np.abs(coarse - middle) <= 0.01 * (1.0 + np.abs(middle))
        lost &= smooth & (np.abs(fine - middle) > 0.1 * (1.0 + np.abs(middle)))
        worst = np.maximum(worst, np.where(smooth, np.abs(fine - middle), 0.0))
    assert not lost.any(), (
        f"{message}: relative to a change of 1e-8 it is off by {worst[lost].max():.2g} times that;"
        " is it computed in single precision?"
    )


def _slope(function: Callable[[float], Array], here: Array, step: float) -> Array:
    change = function(1.0 + step) - here
    slope: Array = np.divide(change, step * here, out=np.zeros_like(here), where=here != 0)
    return slope
