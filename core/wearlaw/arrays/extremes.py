"""The smallest and the largest entry of an array, in one pass if kernels are compiled."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from wearlaw.arrays.array import Array
from wearlaw.arrays.kernels import accelerated, compiled

Bits: TypeAlias = NDArray[np.int64]

SIGNATURE = "UniTuple(float64, 2)(Array(int64, 1, 'C', True))"  # also of arrays that are read-only


def extremes(array: Array) -> tuple[float, float]:
    """Return the smallest and the largest entry; NaN if any entry is NaN."""
    if array.ndim == 0:
        value = float(array)
        return value, value
    if array.flags.c_contiguous and accelerated(array.size):
        low, high = _compiled()(array.reshape(-1).view(np.int64))
        if low <= high:
            return low, high
    return float(array.min()), float(array.max())


def _of_bits(bits: Bits) -> tuple[float, float]:
    """Return the extremes of floats without sign from their bits, or NaN if any entry has a sign or is NaN.

    Such floats keep their order when they are read as integers, with infinity and NaN at the end. A processor compares
    several integers at a time. It cannot do so with floats, because any of them may be NaN.
    """
    low = high = bits[0]
    for i in range(bits.size):
        low = bits[i] if bits[i] < low else low
        high = bits[i] if bits[i] > high else high
    ends = np.array([low, high]).view(np.float64)
    return (ends[0], ends[1]) if low >= 0 else (np.nan, np.nan)


@functools.cache
def _compiled() -> Callable[[Bits], tuple[float, float]]:
    made: Callable[[Bits], tuple[float, float]] = compiled("njit", _of_bits, SIGNATURE)
    return made
