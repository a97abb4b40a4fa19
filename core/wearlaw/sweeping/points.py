"""The operating points of a sweep: axes whose values are all combined, or a table taken row by row.

They are never laid out whole. A block of them knows the few values that its conditions take, and lays them out where
it is evaluated.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
import pint

from wearlaw.arrays.array import Array
from wearlaw.contact.conditions import is_friction_law
from wearlaw.errors import ConditionsError, UnitError
from wearlaw.units.quantities import Q, parse, real_array
from wearlaw.units.registry import symbol

if TYPE_CHECKING:
    import xarray

BLOCK = 100_000
"""The most operating points of a block; most blocks have more than half of it."""


@dataclass(frozen=True, eq=False)
class Varying:
    """A condition that differs from operating point to operating point, along one dimension.

    Attributes
    ----------
    dim : str
        The dimension.
    values : ndarray, (size of the dimension,)
    unit : str or None
        Their unit; None for plain numbers.
    """

    dim: str
    values: Array
    unit: str | None

    def __getitem__(self, part: slice) -> Varying:
        """Return some of the values."""
        return Varying(self.dim, self.values[part], self.unit)

    def given(self, values: Array | float) -> Any:
        """Return values as a prediction takes them."""
        return values if self.unit is None else Q(values, self.unit)


@dataclass(frozen=True)
class Block:
    """A rectangle of operating points that lie next to each other in the order of the results.

    Attributes
    ----------
    number : int
        Which it is.
    slices : tuple of slice
        Where it lies along each dimension.
    flat : slice
        Where it lies among all points, the last dimension running fastest.
    """

    number: int
    slices: tuple[slice, ...]
    flat: slice


@dataclass(frozen=True, eq=False)
class Points:
    """Operating points.

    Attributes
    ----------
    fixed : mapping of str to object
        The conditions that are the same everywhere, as they were given.
    varying : mapping of str to Varying
        The others. Those along one dimension vary together, those along different ones are combined.
    rows : mapping of str to object
        What a table calls its rows, by their dimension.
    """

    fixed: Mapping[str, Any]
    varying: Mapping[str, Varying]
    rows: Mapping[str, Any] = field(default_factory=dict)

    @cached_property
    def sizes(self) -> dict[str, int]:
        """How many values there are along each dimension."""
        return {one.dim: one.values.size for one in self.varying.values()}

    @property
    def dims(self) -> tuple[str, ...]:
        """The dimensions."""
        return tuple(self.sizes)

    @property
    def shape(self) -> tuple[int, ...]:
        """The shape of the results."""
        return tuple(self.sizes.values())

    @property
    def size(self) -> int:
        """How many there are."""
        return math.prod(self.shape)

    @cached_property
    def block_shape(self) -> tuple[int, ...]:
        """The shape of a block: the last dimensions whole, one of them in even parts, one value of those before."""
        shape, room = [], BLOCK
        for size in reversed(self.shape):
            parts = math.ceil(size / max(room, 1))
            shape.append(math.ceil(size / parts))
            room = room // size if parts == 1 else 0
        return tuple(reversed(shape))

    def blocks(self) -> list[Block]:
        """Return all blocks, in the order of the results."""
        along = [range(0, size, step) for size, step in zip(self.shape, self.block_shape, strict=True)]
        found, first = [], 0
        for number, corner in enumerate(itertools.product(*along)):
            slices = tuple(
                slice(start, min(start + step, size))
                for start, step, size in zip(corner, self.block_shape, self.shape, strict=True)
            )
            points = math.prod(one.stop - one.start for one in slices)
            found.append(Block(number, slices, slice(first, first + points)))
            first += points
        return found

    def part(self, slices: Iterable[slice]) -> Points:
        """Return the points of a block."""
        by_dim = dict(zip(self.dims, slices, strict=True))
        return Points(self.fixed, {name: one[by_dim[one.dim]] for name, one in self.varying.items()})

    def conditions(self) -> dict[str, Any]:
        """Return the conditions as a prediction takes them, one entry an operating point."""
        laid_out = {name: one.given(self._laid_out(one)) for name, one in self.varying.items()}
        return {**self.fixed, **laid_out}

    def _laid_out(self, one: Varying) -> Array:
        shape = [-1 if dim == one.dim else 1 for dim in self.dims]
        return np.broadcast_to(one.values.reshape(shape), self.shape).reshape(-1)

    def dataset(self, variables: Mapping[str, Array], units: Mapping[str, str]) -> xarray.Dataset:
        """Return results, (points,) each, under their names, with the conditions as coordinates."""
        import xarray

        coordinates: dict[str, Any] = dict(self.rows)
        for name, one in self.varying.items():
            coordinates[name] = (one.dim, one.values, {"units": one.unit or ""})
        numbers = {name: _number(value) for name, value in self.fixed.items()}
        coordinates |= {name: number for name, number in numbers.items() if number is not None}
        data = {
            name: (self.dims, values.reshape(self.shape), {"units": units[name]}) for name, values in variables.items()
        }
        others = {name: str(self.fixed[name]) for name, number in numbers.items() if number is None}
        return xarray.Dataset(data, coordinates, others)


def outer_product(conditions: Mapping[str, Any]) -> Points:
    """Return the points of all combinations of the conditions that are arrays, in the order in which they are given.

    Raises
    ------
    ConditionsError
        If a condition has more than one axis, or an empty one, or none is an array.
    """
    fixed, varying = split(conditions)
    if not varying:
        raise ConditionsError('no condition is an axis; give at least one as an array, such as creepage=Q([1, 2], "%")')
    return Points(fixed, varying)


def split(conditions: Mapping[str, Any]) -> tuple[dict[str, Any], dict[str, Varying]]:
    """Return the conditions that are one value, as they were given, and those that are axes; None is not given.

    Raises
    ------
    ConditionsError
        If a condition has more than one axis, or an empty one.
    """
    fixed: dict[str, Any] = {}
    varying: dict[str, Varying] = {}
    for name, value in conditions.items():
        if value is None:  # not given, as in a prediction
            continue
        values, unit = _plain(name, value)
        if np.ndim(values) == 0:
            fixed[name] = value
        elif np.ndim(values) == 1:
            varying[name] = axis(name, name, values, unit)
        else:
            raise ConditionsError(
                f"{name}: must be one value or an axis of values, got an array of shape {np.shape(values)};"
                " all axes are combined with each other"
            )
    return fixed, varying


def _plain(name: str, value: Any) -> tuple[Any, str | None]:
    """Return the number or numbers of a condition, and their unit if they have one."""
    if isinstance(value, pint.Quantity):
        return value.magnitude, symbol(value.units, "~C")
    if isinstance(value, (str, int, float)) or is_friction_law(value):  # text with a unit, or a law of friction
        return 0.0, None
    try:
        return real_array(value), None
    except UnitError as error:
        raise UnitError(f"{name}: {error}") from None


def axis(name: str, dim: str, values: object, unit: str | None) -> Varying:
    """Return a condition that varies along a dimension.

    Raises
    ------
    ConditionsError
        If there are no values.
    """
    array = real_array(values)
    if array.size == 0:
        raise ConditionsError(f"{name}: the axis is empty; give at least one value")
    return Varying(dim, np.ascontiguousarray(array), unit)


def _number(value: Any) -> Any:
    """Return a condition as a coordinate without axes, or None if it is a law of friction."""
    if is_friction_law(value):
        return None
    quantity = parse(value) if isinstance(value, str) else value
    if isinstance(quantity, pint.Quantity):
        return (), float(quantity.magnitude), {"units": symbol(quantity.units, "~C")}
    return (), float(quantity), {"units": ""}
