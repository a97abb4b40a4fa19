"""What contact problems have in common: frozen records of arrays with one entry an operating point."""

from __future__ import annotations

import dataclasses
import math
from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import Any, Self

import numpy as np

from wearlaw.arrays import Array


class Batch(ABC):
    """A frozen record of SI arrays of one shape, the *batch*; a field may be None where it was not given."""

    __slots__ = ()

    @classmethod
    def from_si(cls, **arrays: Array) -> Self:
        """Return the record of SI arrays."""
        return cls(**arrays)

    @property
    @abstractmethod
    def batch_shape(self) -> tuple[int, ...]:
        """The shape of the batch, () for one operating point."""

    @property
    def size(self) -> int:
        """The number of operating points."""
        return math.prod(self.batch_shape)

    def __getitem__(self, index: Any) -> Self:
        """Return the problem at some operating points of the batch; `index` is any NumPy index."""
        return self._map(lambda array: array[index])

    def broadcast_to(self, shape: tuple[int, ...]) -> Self:
        """Return the problem with a larger batch shape, to which its own broadcasts."""
        return self._map(lambda array: np.broadcast_to(array, shape))

    def flatten(self) -> Self:
        """Return the problem with its batch as one axis."""
        return self._map(lambda array: array.reshape(-1))

    def _map(self, function: Callable[[Array], Array]) -> Self:
        fields = ((field.name, getattr(self, field.name)) for field in dataclasses.fields(self))  # type: ignore[arg-type]
        return self.from_si(**{name: function(array) for name, array in fields if array is not None})
