"""Operating points in the rows of a table: which columns are which conditions."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import IO, Any, cast

import numpy as np

from wearlaw.arrays import Array
from wearlaw.errors import ConditionsError, DataError, UnitError
from wearlaw.units.quantities import Q
from wearlaw.units.variables import VARIABLES
from wearlaw_sweeps.located import advice
from wearlaw_sweeps.points import OnDisk, Points, Varying, split
from wearlaw_tables import Column, Table, open_table

Columns = Mapping[str, str]
"""The columns of a table by the names that they get, as in {"normal_force": "-Fz [N]"}."""


@contextmanager
def from_table(
    source: Any,
    conditions: Mapping[str, Any],
    *,
    columns: Columns | None = None,
    keep: Columns | None = None,
    sep: str | None = None,
    decimal: str = ".",
    check: Callable[[Mapping[str, Any]], None] = lambda _: None,
    on_disk: Path | None = None,
) -> Iterator[Points]:
    """Give the operating points in the rows of a table, with further conditions that all rows share.

    Parameters
    ----------
    source : path, pandas.DataFrame or xarray.Dataset
        As in `read_table`.
    conditions : mapping of str to object
        Conditions that are the same in all rows.
    columns, keep, sep, decimal
        As in `sweep`.
    check : callable
        Called with the names of all conditions before the rows are read; it raises an error for wrong ones.
    on_disk : Path, optional
        A path in whose folder the numbers of a file are kept while the context lasts. By default they are kept in
        memory.

    Raises
    ------
    DataError
        If this is not a table, or a column is wrong.
    """
    fixed, arrays = split(conditions)
    for name in arrays:
        raise DataError(f"{name}: beside a table it must be one value; add it to the table as a column")
    table = open_table(source, sep=sep, decimal=decimal)
    kept, given = _chosen(table, columns, keep)
    for name in given:
        if name in fixed or name in kept:
            raise DataError(f"{table.label}: {name} is given twice; keep one")
    if not given:
        raise DataError(f"{table.label}: none of its columns is a condition; name them in columns={{...}}")
    try:
        check({**fixed, **given})
    except ConditionsError as error:
        name = str(error).partition(": ")[0]
        if name not in given:
            raise
        raise ConditionsError(f"{table.label}, column '{given[name].head}': {error}") from None
    file = isinstance(source, str | os.PathLike)
    origin = f" of {Path(source).name}" if file else ""
    every = [*kept.values(), *given.values()]
    with ExitStack() as stack:
        collected = _read(table, every, kept, _files(on_disk, len(every), stack) if file else None)
        found = {
            one.name: Varying(table.dim, values, one.unit, file * f"{'-' * (one.sign < 0)}{one.head}{origin}")
            for one, values in zip(every, collected, strict=True)
        }
        yield Points(
            fixed,
            {name: found[name] for name in given},
            {dim: labels for dim, labels in table.labels.items() if dim == table.dim},
            kept={name: found[name] for name in kept},
            file=table if file else Table(table.label),
            numbers=range(found[next(iter(given))].values.size),
        )


def _chosen(table: Table, columns: Columns | None, keep: Columns | None) -> tuple[dict[str, Column], dict[str, Column]]:
    """Return the columns to keep and those of conditions, by name."""
    wrong: list[str] = []
    kept: dict[str, Column] = {}
    given: dict[str, Column] = {}
    for choice, argument, found in ((keep or {}, "keep", kept), (columns, "columns", given)):
        try:
            found |= table.select(choice, argument)
        except DataError as error:
            if not error.problems:
                raise
            wrong += error.problems
    if columns is None:
        places = {column.place for column in kept.values()}
        given = {name: column for name, column in given.items() if column.place not in places}
    for name, column in given.items():
        try:
            if column.unit is None and columns is not None and name in VARIABLES and VARIABLES[name].unit:
                raise UnitError(advice(name, "-" * (column.sign < 0) + column.head))
            Q(1.0, column.unit or "")
        except UnitError as error:
            wrong.append(f"{name}: column '{column.head}': {error}")
    if wrong:
        raise DataError(f"{table.label} is wrong in:", wrong)
    return kept, given


def _files(beside: Path | None, count: int, stack: ExitStack) -> list[IO[bytes]] | None:
    """Return files without a name, which end with the context; None to keep the numbers in memory."""
    if beside is None:
        return None
    beside.parent.mkdir(parents=True, exist_ok=True)
    return [cast(IO[bytes], stack.enter_context(tempfile.TemporaryFile(dir=beside.parent))) for _ in range(count)]


def _read(
    table: Table, columns: Sequence[Column], gaps: Mapping[str, Column], into: list[IO[bytes]] | None
) -> list[Array]:
    """Return the numbers of columns."""
    pieces: list[list[Array]] = []
    rows = 0
    for values in table.pieces(columns, gaps):
        rows += values[0].size
        if into is None:
            pieces.append(values)
        else:
            for file, numbers in zip(into, values, strict=True):
                file.write(np.ascontiguousarray(numbers).data)
    if rows == 0:
        raise DataError(f"{table.label}: has no rows")
    if into is None:
        return [np.concatenate(some) for some in zip(*pieces, strict=True)]
    return [cast(Array, OnDisk(one)) for one in into]  # in the place of arrays, of which it has what is used
