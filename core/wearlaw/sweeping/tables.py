"""Tables of operating points, from pandas or xarray, with the unit of each column."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from typing import Any, TypeAlias

import numpy as np
import pint

from wearlaw.errors import ConditionsError, DataError, UnitError
from wearlaw.sweeping.points import Points, Varying, axis, split
from wearlaw.units.quantities import HEAD, Q
from wearlaw.units.registry import symbol

ROW = "row"
"""The dimension of the rows of a table that has no name for them."""

Column: TypeAlias = tuple[str, str | None, Any, str | None]
"""Head, dimension, values and unit of a column."""


def from_table(table: Any, conditions: Mapping[str, Any]) -> Points:
    """Return the points of a table, a row each, with conditions that are the same in all of them.

    Parameters
    ----------
    table : pandas.DataFrame or xarray.Dataset
        Its columns are conditions. The unit of a column comes from its type (pint), from its `attrs["units"]`, or from
        its head, as in "creepage [%]".
    conditions : mapping of str to object
        What is the same in all rows.

    Raises
    ------
    DataError
        If it is no such table, or a column is wrong.
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
    """Return the columns, and what the rows are called."""
    pandas, xarray = sys.modules.get("pandas"), sys.modules.get("xarray")  # loaded if the table is one of theirs
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
    """Return the values of a column, and their unit if its type or its attributes say one."""
    units = getattr(column.dtype, "units", None)  # a PintType
    if units is not None:
        return np.asarray(column.pint.magnitude), symbol(units, "~C")
    return column.to_numpy(), column.attrs.get("units")


def _of_xarray(table: Any) -> tuple[list[Column], dict[str, Any]]:
    dims = [str(dim) for dim in table.dims]
    if len(dims) != 1:
        raise DataError(f"table: must have one dimension, that of its rows, got {', '.join(dims) or 'none'}")
    columns = [(str(head), *_variable(variable)) for head, variable in table.data_vars.items()]
    named = {dim: (dim, table.indexes[dim].to_numpy()) for dim in dims if dim in table.indexes}
    return columns, named


def _variable(variable: Any) -> tuple[str | None, Any, str | None]:
    data, dim = variable.data, str(variable.dims[0]) if variable.dims else None
    if isinstance(data, pint.Quantity):
        return dim, data.magnitude, symbol(data.units, "~C")
    return dim, variable.to_numpy() if dim else variable.item(), variable.attrs.get("units")


def _named(head: str, unit: str | None) -> tuple[str, str | None]:
    """Return the name of a column, and its unit, which its head may give."""
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
        raise DataError(f"table: column '{head}': {error}; leave out columns that are no conditions") from None
