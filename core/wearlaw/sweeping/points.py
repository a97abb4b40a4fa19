"""The operating points of a sweep: axes whose values are all combined, or the rows of a table.

They are never expanded as a whole: a block holds only the values along each dimension, and is expanded where it is
evaluated.
"""

from __future__ import annotations

import itertools
import math
import sys
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np
import pint

from wearlaw.arrays.array import Array
from wearlaw.contact.conditions import is_friction_law
from wearlaw.errors import ConditionsError, DataError, UnitError
from wearlaw.units.quantities import HEAD, Q, real_array
from wearlaw.units.registry import symbol

BLOCK = 100_000
"""Most operating points in a block; most blocks have more than half as many."""

ROW = "row"
"""Default name for the dimension of a table's rows."""

Column: TypeAlias = tuple[str, str | None, Any, str | None]
"""A column: head, dimension, values and unit."""


@dataclass(frozen=True, eq=False)
class Varying:
    """A condition that varies along one dimension of the operating points.

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
        """Return values as an argument of a prediction."""
        return values if self.unit is None else Q(values, self.unit)


@dataclass(frozen=True)
class Block:
    """A rectangle of operating points that are contiguous in the results.

    Attributes
    ----------
    number : int
        Index of the block.
    slices : tuple of slice
        Range along each dimension.
    flat : slice
        Range among all points, with the last dimension fastest.
    """

    number: int
    slices: tuple[slice, ...]
    flat: slice

    @property
    def size(self) -> int:
        """Number of operating points."""
        size: int = self.flat.stop - self.flat.start
        return size


@dataclass(frozen=True, eq=False)
class Points:
    """Operating points.

    Attributes
    ----------
    fixed : mapping of str to object
        Conditions that are the same at all points, as given.
    varying : mapping of str to Varying
        Other conditions. Those along one dimension vary together; different dimensions are combined.
    rows : mapping of str to object
        Labels of a table's rows, by their dimension.
    weight : float
        Size of an operating point compared with a single line or ellipse, such as the number of its patches. Blocks
        have fewer points in proportion.
    """

    fixed: Mapping[str, Any]
    varying: Mapping[str, Varying]
    rows: Mapping[str, Any] = field(default_factory=dict)
    weight: float = 1.0

    @cached_property
    def sizes(self) -> dict[str, int]:
        """Number of values along each dimension."""
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
        """Number of operating points."""
        return math.prod(self.shape)

    @cached_property
    def block_shape(self) -> tuple[int, ...]:
        """The shape of a block: last dimensions in full, the one before in even parts, single values of the others."""
        shape, room = [], max(int(BLOCK / self.weight), 1)
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
        """Return the conditions as arguments of a prediction, with an entry for each operating point."""
        laid_out = {name: one.given(self._laid_out(one)) for name, one in self.varying.items()}
        return {**self.fixed, **laid_out}

    def _laid_out(self, one: Varying) -> Array:
        shape = [-1 if dim == one.dim else 1 for dim in self.dims]
        return np.broadcast_to(one.values.reshape(shape), self.shape).reshape(-1)


def outer_product(conditions: Mapping[str, Any]) -> Points:
    """Return all combinations of the conditions that are arrays, in the order given.

    Raises
    ------
    ConditionsError
        If a condition has more than one axis or an empty one, or none is an array.
    """
    fixed, varying = split(conditions)
    if not varying:
        raise ConditionsError('no condition is an axis; give at least one as an array, such as creepage=Q([1, 2], "%")')
    return Points(fixed, varying)


def split(conditions: Mapping[str, Any]) -> tuple[dict[str, Any], dict[str, Varying]]:
    """Separate conditions of one value, as given, from axes; a condition of None counts as not given.

    Raises
    ------
    ConditionsError
        If a condition has more than one axis or an empty one.
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
    """Return the numbers of a condition, and their unit if they have one."""
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


def from_table(table: Any, conditions: Mapping[str, Any]) -> Points:
    """Return the operating points in the rows of a table, with further conditions that all rows share.

    Parameters
    ----------
    table : pandas.DataFrame or xarray.Dataset
        Its columns are conditions. The unit of a column comes from its type (pint), from its `attrs["units"]`, or from
        its head, as in "creepage [%]".
    conditions : mapping of str to object
        Conditions that are the same in all rows.

    Raises
    ------
    DataError
        If this is not a table, or a column is wrong.
    """
    fixed, arrays = split(conditions)
    for name in arrays:
        raise DataError(f"{name}: beside a table it must be one value; add it to the table as a column")
    columns, rows = _columns(table)
    found: dict[str, Varying] = {}
    for head, dim, values, given_unit in columns:
        name, unit = _named(head, given_unit)
        if name in found or name in fixed:
            raise DataError(f"table: {name} is given twice; keep one")
        if dim is None:
            fixed[name] = values if unit is None else Q(values, unit)
        else:
            found[name] = _column(head, name, dim, values, unit)
    if not found:
        raise DataError("table: has no columns")
    return Points(fixed, found, rows)


def _columns(table: Any) -> tuple[list[Column], dict[str, Any]]:
    """Return the columns, and the labels of the rows."""
    pandas, xarray = (
        sys.modules.get("pandas"),
        sys.modules.get("xarray"),
    )  # loaded already if the table is one of theirs
    if pandas is not None and isinstance(table, pandas.DataFrame):
        return _of_pandas(table)
    if xarray is not None and isinstance(table, xarray.Dataset):
        return _of_xarray(table)
    raise DataError(
        f"table: must be a pandas.DataFrame or an xarray.Dataset with a row for each operating point, got"
        f" {type(table).__name__}; give conditions by name, as in creepage=..."
    )


def _of_pandas(table: Any) -> tuple[list[Column], dict[str, Any]]:
    if table.index.nlevels > 1:
        raise DataError("table: its index has several levels; call reset_index() on it")
    dim = str(table.index.name or ROW)
    columns: list[Column] = [(str(head), dim, *_typed(table[head])) for head in table.columns]
    return columns, {dim: (dim, table.index.to_numpy())}


def _typed(column: Any) -> tuple[Any, str | None]:
    """Return the values of a column, and their unit from its type or attributes, if any."""
    units = getattr(column.dtype, "units", None)  # a PintType
    if units is not None:
        return np.asarray(column.pint.magnitude), symbol(units, "~C")
    return column.to_numpy(), column.attrs.get("units")


def _of_xarray(table: Any) -> tuple[list[Column], dict[str, Any]]:
    dims = [str(dim) for dim in table.dims]
    if len(dims) != 1:
        raise DataError(f"table: must have one dimension for its rows, got {', '.join(dims) or 'none'}")
    columns = [(str(head), *_variable(variable)) for head, variable in table.data_vars.items()]
    named = {dim: (dim, table.indexes[dim].to_numpy()) for dim in dims if dim in table.indexes}
    return columns, named


def _variable(variable: Any) -> tuple[str | None, Any, str | None]:
    data, dim = variable.data, str(variable.dims[0]) if variable.dims else None
    if isinstance(data, pint.Quantity):
        return dim, data.magnitude, symbol(data.units, "~C")
    return dim, variable.to_numpy() if dim else variable.item(), variable.attrs.get("units")


def _named(head: str, unit: str | None) -> tuple[str, str | None]:
    """Return the name of a column and its unit, which may stand in its head."""
    match = HEAD.fullmatch(head)
    if match is None or match["unit"] is None:
        return head, unit
    if unit is not None and unit != match["unit"]:
        raise DataError(f"table: column '{head}' has the unit '{unit}' as well; keep one of the two")
    return match["name"], "" if match["unit"] == "-" else match["unit"]


def _column(head: str, name: str, dim: str, values: Any, unit: str | None) -> Varying:
    try:
        return axis(name, dim, values, unit)
    except ConditionsError:
        raise DataError("table: has no rows") from None
    except UnitError as error:
        raise DataError(f"table: column '{head}': {error}; leave out columns that are not conditions") from None
