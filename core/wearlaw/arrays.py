"""The type of arrays in SI, their extremes and equality, and errors of floats."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import fields, is_dataclass
from typing import Any, TypeAlias, TypeVar

import numpy as np
from numpy.typing import NDArray

Array: TypeAlias = NDArray[np.float64]
"""A float64 array of SI values."""

ArrayT = TypeVar("ArrayT", bound=NDArray[Any])


def steadily() -> np.errstate:
    """Return a context with NumPy's own treatment of errors of floats, whatever `np.errstate` the caller has set.

    With all="raise", a number that underflows on its way to zero would end a computation. Results that are not finite
    are found by checks, which name the model.
    """
    return np.errstate(divide="warn", over="warn", under="ignore", invalid="warn")


steady = steadily()
"""The same as a decorator, in less than half the time. It counts as a caller in the `stacklevel` of warnings."""


WRITEABLE = 0x0400
"""The bit of `flags.num` for `flags.writeable`, which warns if an array is from `np.broadcast_arrays`."""


def read_only(array: ArrayT) -> ArrayT:
    """Return an array that cannot be written to: itself, or a view of it, so that its owner still can write."""
    if array.flags.num & WRITEABLE:
        array = array.view()
        array.setflags(False)  # type: ignore[call-arg]  # a keyword would take as long again
    return array


def freeze(record: object, names: Iterable[str]) -> None:
    """Make those fields of a frozen record read-only that are arrays."""
    for name in names:
        value = getattr(record, name)
        if type(value) is np.ndarray and value.flags.num & WRITEABLE:
            object.__setattr__(record, name, read_only(value))


def type_name(value: object) -> str:
    """Return the type of a value that should be a float64 array, for a message."""
    return str(value.dtype) if type(value) is np.ndarray else type(value).__name__


def extremes(array: Array) -> tuple[float, float]:
    """Return the smallest and the largest entry; NaN if any entry is NaN."""
    if array.ndim and array.size != 1 and any(array.strides):
        # `min` and `max` of the array itself pass through Python, which takes as long as a thousand entries.
        return float(np.minimum.reduce(array, None)), float(np.maximum.reduce(array, None))
    value = float(array.item(0) if array.ndim else array)  # one number, maybe broadcast
    return value, value


def same(first: object, second: object) -> bool:
    """Return whether two values are the same, with arrays in records compared by entry; NaN is the same as NaN."""
    if isinstance(first, np.ndarray) or isinstance(second, np.ndarray):
        first, second = np.asarray(first), np.asarray(second)
        return np.array_equal(first, second, equal_nan=first.dtype.kind == second.dtype.kind == "f")
    if type(first) is not type(second):
        return False
    if is_dataclass(first):
        return all(same(getattr(first, field.name), getattr(second, field.name)) for field in fields(first))
    if isinstance(first, Mapping) and isinstance(second, Mapping):
        return list(first) == list(second) and all(same(first[key], second[key]) for key in first)
    if isinstance(first, (tuple, list)) and isinstance(second, (tuple, list)):
        return len(first) == len(second) and all(map(same, first, second))
    return bool(first == second)
