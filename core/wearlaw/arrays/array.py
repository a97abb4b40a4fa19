"""The array type of all values in SI, and the extremes of an array."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

Array: TypeAlias = NDArray[np.float64]
"""A float64 array of SI values."""


def type_name(value: object) -> str:
    """Return the type of a value that should be a float64 array, for a message."""
    return str(value.dtype) if type(value) is np.ndarray else type(value).__name__


def extremes(array: Array) -> tuple[float, float]:
    """Return the smallest and the largest entry; NaN if any entry is NaN."""
    if array.size == 1:  # NumPy's methods take twenty times as long
        value = float(array.item())
        return value, value
    return float(array.min()), float(array.max())
