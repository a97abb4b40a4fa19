"""The array type of all values in SI."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

Array: TypeAlias = NDArray[np.float64]
"""A float64 array of SI values."""


def type_name(value: object) -> str:
    """Return the type of a value that should be a float64 array, for a message."""
    return str(value.dtype) if type(value) is np.ndarray else type(value).__name__
