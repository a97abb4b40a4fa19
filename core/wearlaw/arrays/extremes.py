"""The smallest and the largest entry of an array."""

from __future__ import annotations

from wearlaw.arrays.array import Array


def extremes(array: Array) -> tuple[float, float]:
    """Return the smallest and the largest entry; NaN if any entry is NaN."""
    if array.ndim == 0 or array.size == 1:  # NumPy's methods take twenty times as long
        value = float(array.item())
        return value, value
    return float(array.min()), float(array.max())
