"""Tables of operating points: which columns are which conditions, and their numbers with signs and units."""

from __future__ import annotations

import os
import sys
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import IO, Any, NamedTuple, TypeAlias, cast

import numpy as np
import pint

from wearlaw.arrays.array import Array
from wearlaw.errors import ConditionsError, DataError, UnitError, did_you_mean, quoted, shortened
from wearlaw.sweeping.located import advice
from wearlaw.sweeping.points import OnDisk, Points, Varying, axis, split
from wearlaw.sweeping.progress import Bar
from wearlaw.sweeping.table_files import ROW, Head, TableFile, faults, open_table, state
from wearlaw.units.quantities import HEAD, Q
from wearlaw.units.registry import symbol
from wearlaw.units.variables import VARIABLES

Columns: TypeAlias = Mapping[str, str]
"""The columns of a table by the names that they get, as in {"normal_force": "-Fz [N]"}."""

LISTED = 20
"""Most columns that a message lists."""

KEPT = "keep"
"""The argument that names the columns that are kept."""


class Use(NamedTuple):
    """A use of a column.

    Attributes
    ----------
    name : str
        The name of the condition or coordinate.
    place : int
        Index of the column.
    unit : str or None
        The unit; None for plain numbers.
    sign : float
        The factor 1 or -1.
    kept : bool
        Whether the column is a coordinate of the results, not a condition.
    """

    name: str
    place: int
    unit: str | None
    sign: float = 1.0
    kept: bool = False


class Given(NamedTuple):
    """A column of a table in memory: dimension and values."""

    dim: str | None
    values: Any


def uses(label: str, heads: Sequence[Head], columns: Columns | None, keep: Columns | None) -> list[Use]:
    """Return the columns that are used.

    Parameters
    ----------
    label : str
        The name of the table in messages.
    heads : sequence of Head
        The columns of the table.
    columns : mapping of str to str, optional
        The column of each condition; without it, the name of a column is that of its condition.
    keep : mapping of str to str, optional
        The columns to keep as coordinates.

    Raises
    ------
    DataError
        If there are no such columns, or their units are missing or unknown; the message names all faults.
    """
    wrong: list[str] = []
    found = _wanted(heads, KEPT, keep or {}, wrong)
    if columns is not None:
        found += _wanted(heads, "columns", columns, wrong)
    else:
        taken = {one.place for one in found}
        alone = [place for place, head in enumerate(heads) if head.alone and place not in taken]
        found += [Use(_name(heads[place]), place, _unit(heads[place])) for place in alone]
    names = [one.name for one in found]
    wrong += [f"{name} is given twice; keep one" for name in dict.fromkeys(names) if names.count(name) > 1]
    if wrong:
        listed = ", ".join(f"{quoted(head.text)}" for head in heads[:LISTED])
        more = f" and {len(heads) - LISTED} more" if len(heads) > LISTED else ""
        missing = any("there is no column" in one for one in wrong)
        raise DataError(f"{label} is wrong in:", [*wrong, *([f"its columns are {listed}{more}"] if missing else [])])
    return found


def _wanted(heads: Sequence[Head], argument: str, columns: Columns, wrong: list[str]) -> list[Use]:
    """Return the columns of a mapping; note the faults."""
    if not isinstance(columns, Mapping) or not all(isinstance(one, str) for pair in columns.items() for one in pair):
        raise DataError(
            f'{argument}: must map names to columns, such as {{"normal_force": "Fz [N]"}}, got {shortened(columns)}'
        )
    found = []
    for name, text in columns.items():
        place, sign, given = _column(heads, text)
        if not name.isidentifier():
            wrong.append(f"{argument}: {quoted(name)} is no name; use letters, digits and underscores")
        elif isinstance(place, str):
            wrong.append(f"{name}: {place}")
        else:
            try:
                unit = _agreed(heads[place], given, argument == KEPT)
                if unit is None and argument != KEPT and name in VARIABLES and VARIABLES[name].unit:
                    raise UnitError(advice(name, text))
                found.append(Use(name, place, unit, sign, argument == KEPT))
            except (UnitError, DataError) as error:
                wrong.append(f"{name}: column {quoted(heads[place].text)} {error}")
    return found


def _column(heads: Sequence[Head], text: str) -> tuple[int | str, float, str | None]:
    """Return the index of a column or what is wrong, its sign, and the unit that the user states."""
    texts = [head.text for head in heads]
    for sign, rest in ((1.0, text), (-1.0, text.removeprefix("-").strip())):
        match = HEAD.fullmatch(rest)
        name, unit = (match["name"], match["unit"]) if match else (rest, None)
        for places in (
            [place for place, one in enumerate(texts) if one == rest],
            [place for place, one in enumerate(heads) if one.name == name],
        ):
            if len(places) > 1:
                return f"the column {quoted(rest)} is there {len(places)} times; rename all but one", sign, None
            if places:
                return places[0], sign, unit
    near = did_you_mean(text.removeprefix("-"), [*texts, *(head.name for head in heads)])
    return f"there is no column {quoted(text)}{near.rstrip('.')}", 1.0, None


def _agreed(head: Head, given: str | None, kept: bool) -> str | None:
    """Return the unit of a column in the notation of pint, from the file and from the user.

    Raises
    ------
    UnitError
        If it is unknown; the unit of a column that is only kept may be any text.
    DataError
        If the two differ.
    """
    written = _unit(head)
    if written is not None and given is None:
        try:
            return _known(written)
        except UnitError as error:
            if kept:
                return written
            raise UnitError(
                f"has a unit that is unknown: {error}; write one in brackets that is known, as in '{head.name} [N*m]'"
            ) from None
    if given is None:
        return None
    unit = _known(given)
    try:
        if written is not None and Q(1.0, _known(written)) != Q(1.0, unit):
            raise DataError(f"has the unit {quoted(written)}, but {quoted(given)} is stated; keep one of the two")
    except UnitError:
        pass  # the file's unit is unknown, so that the user states it
    return unit


def _known(unit: str) -> str:
    """Return a unit in the notation of pint, "" for "-" and "1"."""
    return "" if unit.strip() in ("", "-", "1") else symbol(Q(1.0, unit).units, "~C")


def _name(head: Head) -> str:
    return head.name if _in_head(head) is not None else head.text


def _in_head(head: Head) -> str | None:
    """Return the unit in brackets of a head."""
    match = HEAD.fullmatch(head.text)
    return match["unit"] if match else None


def _unit(head: Head) -> str | None:
    """Return the unit of a column, which may stand in its head; "-" is that of plain ratios.

    Raises
    ------
    DataError
        If it is given twice, and differs.
    """
    within = _in_head(head)
    if within is None:
        return head.unit if head.unit != "-" else ""
    if head.unit is not None and head.unit != within:
        raise DataError(
            f"table: column {quoted(head.text)} has the unit {quoted(head.unit)} as well; keep one of the two"
        )
    return "" if within == "-" else within


@contextmanager
def from_table(
    table: Any,
    conditions: Mapping[str, Any],
    *,
    columns: Columns | None = None,
    keep: Columns | None = None,
    check: Callable[[Mapping[str, Any]], None] = lambda _: None,
    on_disk: Path | None = None,
    progress: bool = False,
) -> Iterator[Points]:
    """Give the operating points in the rows of a table, with further conditions that all rows share.

    Parameters
    ----------
    table : path, pandas.DataFrame or xarray.Dataset
        The unit of a column comes from its type (pint), from its `attrs["units"]`, or from its head, as in
        "creepage [%]".
    conditions : mapping of str to object
        Conditions that are the same in all rows.
    columns, keep : mapping of str to str, optional
        As in `sweep`.
    check : callable
        Called with the names of all conditions before a file is read; it raises an error for wrong ones.
    on_disk : Path, optional
        A path in whose folder the numbers of a file are kept while the context lasts. By default they are kept in
        memory.
    progress : bool
        Whether to show how much of a file is read.

    Raises
    ------
    DataError
        If this is not a table, or a column is wrong.
    """
    fixed, arrays = split(conditions)
    for name in arrays:
        raise DataError(f"{name}: beside a table it must be one value; add it to the table as a column")
    if not isinstance(table, str | os.PathLike):
        yield _in_memory(table, fixed, columns, keep)
        return
    file = open_table(table)
    used = uses(f"table {quoted(file.path)}", file.heads, columns, keep)
    for one in used:
        if one.name in fixed:
            raise DataError(f"table {quoted(file.path)}: {one.name} is given twice; keep one")
    if all(one.kept for one in used):
        raise DataError(f"table {quoted(file.path)}: none of its columns is a condition; name them in columns={{...}}")
    try:
        check({**fixed, **{one.name: None for one in used if not one.kept}})
    except ConditionsError as error:
        name, _, fault = str(error).partition(": ")
        if name not in {one.name for one in used}:
            raise
        raise ConditionsError(f"table {quoted(file.path)}, column {quoted(name)}: {fault}") from None
    with ExitStack() as stack:
        collected = _read(file, used, None if on_disk is None else _files(on_disk, len(used), stack), progress)
        found = {
            one.name: Varying(
                file.dim, values, one.unit, f"{'-' * (one.sign < 0)}{file.heads[one.place].text} of {file.path.name}"
            )
            for one, values in zip(used, collected, strict=True)
        }
        varying, kept = ({one.name: found[one.name] for one in used if one.kept == which} for which in (False, True))
        size = next(iter(varying.values())).values.size
        yield Points(fixed, varying, kept=kept, file=file, numbers=range(size))


def _files(beside: Path, count: int, stack: ExitStack) -> list[IO[bytes]]:
    """Return files without a name, which end with the context."""
    beside.parent.mkdir(parents=True, exist_ok=True)
    return [cast(IO[bytes], stack.enter_context(tempfile.TemporaryFile(dir=beside.parent))) for _ in range(count)]


def _read(file: TableFile, used: Sequence[Use], into: Sequence[IO[bytes]] | None, progress: bool) -> list[Array]:
    """Return the numbers of columns, with their signs."""
    pieces: list[list[Array]] = [[] for _ in used]
    rows, before = 0, state(file.path)
    with Bar(max(file.size, 1), progress) as bar:
        bar.stage(f"reading {file.path.name}")
        for piece in file.pieces([one.place for one in used]):
            wrong = [
                (rows + int(row), one.place)
                for one, values, text in zip(used, piece.values, piece.texts, strict=True)
                for row in np.flatnonzero(_without_number(one, values, text))[: DataError.MOST]
            ]
            if wrong:
                raise DataError(
                    f"table {quoted(file.path)} is wrong in:", faults(file, sorted(wrong)[: DataError.MOST])
                )
            for number, (one, values) in enumerate(zip(used, piece.values, strict=True)):
                signed = np.ascontiguousarray(values if one.sign > 0 else -values)
                if into is None:
                    pieces[number].append(signed)
                else:
                    into[number].write(signed.data)
            rows += piece.values[0].size
            bar(piece.done)
    if rows == 0:
        raise DataError(f"table {quoted(file.path)}: has no rows")
    if state(file.path) != before:
        raise DataError(f"table {quoted(file.path)}: was changed while it was read; wait until it is complete")
    if into is None:
        return [np.concatenate(some) for some in pieces]
    return [cast(Array, OnDisk(one)) for one in into]  # in the place of arrays, of which it has what is used


def _without_number(one: Use, values: Array, text: Any) -> Any:
    """Return where a column is wrong: a condition needs a number in every row, a kept column may lack some."""
    missing = False if one.kept else np.isnan(values)
    return missing if text is None else missing | text


def _in_memory(table: Any, fixed: dict[str, Any], columns: Columns | None, keep: Columns | None) -> Points:
    """Return the operating points of a table of pandas or xarray."""
    heads, given, rows = _columns(table)
    varying: dict[str, Varying] = {}
    kept: dict[str, Varying] = {}
    for one in uses("table", heads, columns, keep):
        dim, values = given[one.place]
        if one.name in fixed:
            raise DataError(f"table: {one.name} is given twice; keep one")
        if dim is None:
            fixed[one.name] = one.sign * values if one.unit is None else Q(one.sign * values, one.unit)
        else:
            found = _column_of(heads[one.place].text, one, dim, values)
            (kept if one.kept else varying)[one.name] = found
    if not varying:
        raise DataError("table: has no columns")
    return Points(fixed, varying, rows, kept=kept)


def _column_of(head: str, one: Use, dim: str, values: Any) -> Varying:
    try:
        found = axis(one.name, dim, values, one.unit)
    except ConditionsError:
        raise DataError("table: has no rows") from None
    except UnitError as error:
        raise DataError(f"table: column {quoted(head)}: {error}; leave out columns that are not conditions") from None
    return found if one.sign > 0 else Varying(dim, -found.values, found.unit)


def _columns(table: Any) -> tuple[list[Head], list[Given], dict[str, Any]]:
    """Return the columns of a table in memory, and the labels of the rows."""
    pandas, xarray = (
        sys.modules.get("pandas"),
        sys.modules.get("xarray"),
    )  # loaded already if the table is one of theirs
    if pandas is not None and isinstance(table, pandas.DataFrame):
        return _of_pandas(table)
    if xarray is not None and isinstance(table, xarray.Dataset):
        return _of_xarray(table)
    raise DataError(
        "table: must be a pandas.DataFrame or an xarray.Dataset with a row for each operating point, or the path of a"
        f" file with such a table, got {shortened(table)}; give conditions by name, as in creepage=..."
    )


def _of_pandas(table: Any) -> tuple[list[Head], list[Given], dict[str, Any]]:
    if table.index.nlevels > 1:
        raise DataError("table: its index has several levels; call reset_index() on it")
    dim = str(table.index.name or ROW)
    typed = [_typed(table.iloc[:, place]) for place in range(len(table.columns))]
    heads = [Head(str(head), unit) for head, (_, unit) in zip(table.columns, typed, strict=True)]
    return heads, [Given(dim, values) for values, _ in typed], {dim: (dim, table.index.to_numpy())}


def _typed(column: Any) -> tuple[Any, str | None]:
    """Return the values of a column, and their unit from its type or attributes, if any."""
    units = getattr(column.dtype, "units", None)  # a PintType
    if units is not None:
        return np.asarray(column.pint.magnitude), symbol(units, "~C")
    return column.to_numpy(), column.attrs.get("units")


def _of_xarray(table: Any) -> tuple[list[Head], list[Given], dict[str, Any]]:
    dims = [str(dim) for dim in table.dims]
    if len(dims) != 1:
        raise DataError(f"table: must have one dimension for its rows, got {', '.join(dims) or 'none'}")
    heads, given = [], []
    for head, variable in table.variables.items():
        dim, values, unit = _variable(variable)
        heads.append(Head(str(head), unit, head in table.data_vars))
        given.append(Given(dim, values))
    return heads, given, {dim: (dim, table.indexes[dim].to_numpy()) for dim in dims if dim in table.indexes}


def _variable(variable: Any) -> tuple[str | None, Any, str | None]:
    data, dim = variable.data, str(variable.dims[0]) if variable.dims else None
    if isinstance(data, pint.Quantity):
        return dim, data.magnitude, symbol(data.units, "~C")
    return dim, variable.to_numpy() if dim else variable.item(), variable.attrs.get("units")
