"""Tables of numbers with units: CSV files and tables of pandas and xarray, with the line of each row for errors.

>>> import wearlaw as wl
>>> table = wl.read_table("run.csv", {"normal_force": "Fz [kN]", "creepage": "-slip [%]"})
>>> table["normal_force"]
[7.100 7.200] kN
"""

from __future__ import annotations

import csv
import io
import itertools
import os
import sys
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, TextIO

import numpy as np
import pint

from wearlaw.arrays.array import Array
from wearlaw.errors import DataError, UnitError, did_you_mean, shown
from wearlaw.extras import needed_for
from wearlaw.units.quantities import HEAD, Q, Quantity
from wearlaw.units.registry import symbol

if TYPE_CHECKING:
    import pandas
    import xarray
    from numpy.typing import NDArray

CELLS = 1_000_000
"""Cells of a file that are read at a time."""

ROW = "row"
"""Default name for the dimension of the rows."""

MISSING = ("", "-", "NA", "N/A", "n/a", "na", "nan", "NaN", "NAN", "null", "NULL", "None", "#N/A")
"""Cells without a value."""

LISTED = 20
"""Most columns that a message lists."""


class Column(NamedTuple):
    """A column in use.

    Attributes
    ----------
    name : str
        The name that it got.
    head : str
        Its head in the table.
    place : int
        Its index in the table.
    unit : str or None
        Its unit, "" for a ratio; None for plain numbers. An unknown unit is kept as it is written.
    sign : float
        The factor 1 or -1.
    """

    name: str
    head: str
    place: int
    unit: str | None
    sign: float = 1.0


class Head(NamedTuple):
    """The head of a column as written, and its unit if the table has that elsewhere.

    Without a choice of columns, those are read that are `data`: all but the coordinates of an xarray.Dataset.
    """

    text: str
    unit: str | None = None
    data: bool = True

    @property
    def name(self) -> str:
        """The head without a unit in brackets."""
        match = HEAD.fullmatch(self.text)
        return match["name"] if match else self.text

    @property
    def units(self) -> list[str]:
        """The units in the head and beside it."""
        match = HEAD.fullmatch(self.text)
        return [unit for unit in (match and match["unit"], self.unit) if unit]


class Table:
    """Columns of a table, from `read_table`.

    ``table["creepage"]`` is a column as a quantity, or as plain numbers if it has no unit, with NaN for missing values.
    Values are read at the first use.

    Attributes
    ----------
    label : str
        The table in messages, such as "table 'run.csv'".
    columns : dict of str to Column
        The columns in use, by name.
    heads : list of Head
        The heads of all columns.
    comments : list of str
        Lines above the header of a CSV file that begin with "#".
    header : int
        The line of the header of a CSV file, from 1.
    """

    def __init__(self, label: str) -> None:
        self.label = label
        self.heads: list[Head] = []
        self.columns: dict[str, Column] = {}
        self.comments: list[str] = []
        self.header = 0
        self.decimal = "."
        self.dim = ROW
        self.labels: dict[str, Any] = {}
        self.size = 1

    def __getitem__(self, name: str) -> Quantity | Array:
        """Return a column.

        Raises
        ------
        DataError
            If there is no such column, or a cell holds text; the message names every line.
        """
        values, unit = self.numbers(name), self.columns[name].unit
        return values if unit is None else Q(values, unit)

    def numbers(self, name: str) -> Array:
        """Return a column in its unit, without it; errors as for a column."""
        column = self._column(name)
        (values,) = self._numbers([column], [self._whole[column.place]], 0, [name])
        return values

    @cached_property
    def lines(self) -> NDArray[np.intp]:
        """The line of each row of a CSV file, from 1; empty for other tables."""
        return np.empty(0, dtype=np.intp)

    def texts(self, name: str) -> list[str]:
        """Return the cells of a column as text, "" for missing ones."""
        whole = self._whole[self._column(name).place]
        return ["" if missing else str(cell).strip() for cell, missing in zip(whole, whole.isna(), strict=True)]

    def where(self, row: int, name: str | None = None) -> str:
        """Return the place of a row, from 0, or of one of its cells in words, as in "line 7, column 'Fz [N]'"."""
        return self._rows_in_words([row])[row] + ("" if name is None else f", column '{self._column(name).head}'")

    def select(self, columns: Mapping[str, str] | None, argument: str = "columns") -> dict[str, Column]:
        """Return columns by the names that they get, from a mapping as in `read_table`.

        Raises
        ------
        DataError
            If there are no such columns, or units contradict each other; the message names all faults.
        """
        chosen: list[tuple[str, str, int | None, float, str | None]]
        if columns is None:
            chosen = [(head.name, head.text, place, 1.0, None) for place, head in enumerate(self.heads) if head.data]
        elif isinstance(columns, Mapping):
            chosen = [(name, text, *self._find(text)) for name, text in columns.items()]
        else:
            raise DataError(
                f'{argument}: must map names to columns, such as {{"force": "Fz [N]"}}, got {shown(columns)}'
            )
        wrong: list[str] = []
        found: dict[str, Column] = {}
        for name, text, place, sign, given in chosen:
            if not name.isidentifier() and columns is not None:
                wrong.append(f"{argument}: '{name}' is no name; use letters, digits and underscores")
            elif place is None:
                wrong.append(f"{name}: {given}")
            elif name in found:
                wrong.append(f"{name} is given twice, by '{found[name].head}' and '{text}'; keep one")
            else:
                head = self.heads[place]
                try:
                    found[name] = Column(name, head.text, place, _agreed(given, head.units), sign)
                except UnitError as error:
                    wrong.append(f"{name}: column '{head.text}': {error}")
        if wrong:
            raise DataError(f"{self.label} is wrong in:", wrong)
        return found

    def pieces(self, columns: Sequence[Column], gaps: Collection[str] = ()) -> Iterator[tuple[list[Array], int]]:
        """Yield the values of columns piece by piece, with the part of `size` that was read for each.

        Raises
        ------
        DataError
            If a cell holds text, or is missing in a column that is not named in `gaps`; the message names the lines.
        """
        first = 0
        for raw, part in self._raw([column.place for column in columns]):
            values = self._numbers(columns, [raw[column.place] for column in columns], first, gaps)
            yield values, part
            first += len(values[0])

    def _raw(self, places: Sequence[int]) -> Iterator[tuple[Any, int]]:
        """Yield some rows of columns by their places, and the part of `size` that was read for them."""
        raise NotImplementedError

    @cached_property
    def _whole(self) -> Any:
        """The columns in use, by their places."""
        pd = _pandas()
        places = [column.place for column in self.columns.values()]
        parts = [raw for raw, _ in self._raw(places)]
        return {place: pd.concat([pd.Series(part[place]) for part in parts], ignore_index=True) for place in places}

    def _rows_in_words(self, rows: Collection[int]) -> dict[int, str]:
        return {row: f"row {row} (the first is row 0)" for row in rows}

    def _column(self, name: str) -> Column:
        if name not in self.columns:
            raise DataError(f"{self.label}: there is no column '{name}'{did_you_mean(name, self.columns)}")
        return self.columns[name]

    def _find(self, text: str) -> tuple[int | None, float, str | None]:
        """Return the index, the sign and the stated unit of a column; or None, and what is wrong."""
        for sign, rest in ((1.0, text), (-1.0, text.removeprefix("-").strip())):
            match = HEAD.fullmatch(rest)
            name, unit = (match["name"], match["unit"]) if match else (rest, None)
            for places in (
                [place for place, head in enumerate(self.heads) if head.text == rest],
                [place for place, head in enumerate(self.heads) if head.name == name],
            ):
                if len(places) > 1:
                    return None, sign, f"the column '{rest}' is there {len(places)} times; rename all but one"
                if places:
                    return places[0], sign, unit
        known = [head.text for head in self.heads]
        near = did_you_mean(text.removeprefix("-"), [*known, *(head.name for head in self.heads)]).rstrip(".")
        listed = ", ".join(f"'{one}'" for one in known[:LISTED]) + (", ..." if len(known) > LISTED else "")
        return None, 1.0, f"there is no column '{text}'{near or ';'} The columns are {listed}"

    def _numbers(self, columns: Sequence[Column], raw: Sequence[Any], first: int, gaps: Collection[str]) -> list[Array]:
        """Return columns of pandas or numpy as floats, the first row of which has the number `first`."""
        found, wrong = [], []
        for column, cells in zip(columns, raw, strict=True):
            values, missing = _floats(cells, self.decimal)
            found.append(values if column.sign > 0 else -values)
            without = np.isnan(values) & ~(missing & (column.name in gaps))
            wrong += [
                (int(row), column, "" if missing[row] else str(np.asarray(cells)[row]))
                for row in np.flatnonzero(without)[: DataError.MOST]
            ]
        if wrong:
            wrong = sorted(wrong, key=lambda one: one[0])[: DataError.MOST]
            places = self._rows_in_words({first + row for row, _, _ in wrong})
            raise DataError(
                f"{self.label} is wrong in:",
                [
                    f"{places[first + row]}, column '{column.head}': "
                    + (f"{shown(text)} is not a number{self._hint(text)}" if text else "is missing")
                    for row, column, text in wrong
                ],
            )
        return found

    def _hint(self, text: str) -> str:
        """Return how to read a number with the other decimal mark."""
        other = "," if self.decimal == "." else "."
        if text.count(other) == 1 and text.lstrip("+-").replace(other, "").isdigit():
            return f'; for decimals with "{other}", give decimal="{other}"'
        return ""

    def _failed(self, error: Exception) -> DataError:
        reason = getattr(error, "strerror", None) or f"{type(error).__name__}: {error}"
        others = "open other files with pandas or xarray, and give the table"
        return DataError(f"{self.label} cannot be read as CSV in UTF-8: {reason}; {others}")


def read_table(
    source: str | os.PathLike[str] | TextIO | pandas.DataFrame | xarray.Dataset,
    columns: Mapping[str, str] | None = None,
    *,
    sep: str | None = None,
    decimal: str = ".",
    comment: str = "#",
) -> Table:
    """Return columns of a table with their units.

    Parameters
    ----------
    source : path, text file, pandas.DataFrame or xarray.Dataset
        A CSV file, or a table of pandas or xarray, such as ``xarray.open_dataset("run.nc", decode_times=False)``, of
        which one piece is read at a time. The unit of a column stands in its head, as in "Fz [kN]", in its
        `attrs["units"]`, or in its type (pint). "[-]" is a ratio. If all cells of the first row of a CSV file are
        numbers, it has no header, and the columns are "1", "2", ...
    columns : mapping of str to str, optional
        The columns to use by the names that they get, as in {"force": "Fz [kN]", "creepage": "-slip"}. A minus changes
        the sign. State the unit in brackets if the table does not. Default: all, by their heads without units.
    sep : str, optional
        What separates the cells of a CSV file; " " for any number of spaces. Default: the first of semicolon, tab and
        comma that the header has, and spaces for numbers without any of them.
    decimal : {".", ","}
        The decimal mark of a CSV file.
    comment : str
        What lines above the header of a CSV file begin with that are comments; without a header, all such lines.

    Returns
    -------
    Table

    Raises
    ------
    DataError
        If there is no such table, or no such column; the message names all faults.
    """
    table = open_table(source, sep=sep, decimal=decimal, comment=comment)
    table.columns = table.select(columns)
    return table


def open_table(source: Any, *, sep: str | None = None, decimal: str = ".", comment: str = "#") -> Table:
    """Return a table without columns in use; arguments as for `read_table`."""
    if isinstance(source, str | os.PathLike):
        return CsvTable(f"table {shown(Path(source))}", Path(source), sep, decimal, comment)
    if hasattr(source, "read"):
        return CsvTable(f"table '{getattr(source, 'name', 'text')}'", source.read().encode(), sep, decimal, comment)
    pandas, xarray = sys.modules.get("pandas"), sys.modules.get("xarray")  # loaded already if the table is theirs
    if pandas is not None and isinstance(source, pandas.DataFrame):
        return FrameTable("table", source)
    if xarray is not None and isinstance(source, xarray.Dataset):
        return XarrayTable("table", source)
    raise DataError(f"table: must be a path, a pandas.DataFrame or an xarray.Dataset, got {shown(source)}")


class CsvTable(Table):
    """A CSV file, or the bytes of one."""

    def __init__(self, label: str, source: Path | bytes, sep: str | None, decimal: str, comment: str = "#") -> None:
        super().__init__(label)
        if decimal not in (".", ","):
            raise DataError(f'decimal: must be "." or ",", got {decimal!r}')
        self._source, self.decimal = source, decimal
        self._skip, header = 0, ""
        with self._opened() as (file, raw):
            self.size = raw.seek(0, os.SEEK_END)
            raw.seek(0)
            while header := file.readline():
                if "".join(header.split()).strip(",;") and not header.lstrip('" ').startswith(comment):
                    break
                self._skip += 1
                self.comments.append(header.strip('",; \t\r\n').lstrip(f"{comment} "))
        if not header:
            raise DataError(f"{label} is empty")
        marks = [mark for mark in ";\t," if mark in header]
        self.sep = sep or next(iter(marks), " " if _is_number(header.split()[0], decimal) else ",")
        cells = self._cells(next(csv.reader([header], delimiter=self.sep, skipinitialspace=True)))
        while cells and not cells[-1]:
            cells.pop()
        bare = all(_is_number(cell, decimal) for cell in cells)
        self.header = self._skip + 1
        self._skip += not bare
        self._comment = comment if bare else None
        self.heads = [Head(str(place + 1) if bare else cell) for place, cell in enumerate(cells)]

    def _cells(self, cells: Sequence[str]) -> list[str]:
        return " ".join(cells).split() if self.sep == " " else [cell.strip() for cell in cells]

    @contextmanager
    def _opened(self) -> Iterator[tuple[TextIO, Any]]:
        """Give the file as text, behind the lines to skip, and its bytes."""
        try:
            with io.BytesIO(self._source) if isinstance(self._source, bytes) else self._source.open("rb", 2**20) as raw:
                file = io.TextIOWrapper(raw, encoding="utf-8-sig", newline="")
                for _ in range(self._skip):
                    file.readline()
                yield file, raw
        except (OSError, UnicodeDecodeError, csv.Error) as error:
            raise self._failed(error) from None

    def _raw(self, places: Sequence[int], dtype: Any = None) -> Iterator[tuple[Any, int]]:  # noqa: ARG002
        pd = _pandas()  # which is given no places: it would not see rows that are too long
        before = 0
        with self._opened() as (file, raw):
            try:
                with pd.read_csv(
                    file,
                    sep=r"\s+" if self.sep == " " else self.sep,
                    header=None,
                    decimal=self.decimal,
                    comment=self._comment,
                    keep_default_na=False,
                    na_values=list(MISSING),
                    skipinitialspace=True,
                    chunksize=max(CELLS // len(self.heads), 1),
                    dtype=dtype,
                    low_memory=False,
                ) as reader:
                    for frame in reader:
                        beyond = frame.iloc[:, len(self.heads) :]
                        if len(frame.columns) < len(self.heads) or (beyond.size and beyond.notna().any(axis=None)):
                            raise self._uneven()
                        read = raw.tell()
                        yield frame.dropna(how="all"), read - before
                        before = read
            except pd.errors.EmptyDataError:
                return
            except pd.errors.ParserError as error:
                raise self._uneven() if "Expected" in str(error) else self._failed(error) from None

    @cached_property
    def _whole(self) -> Any:
        pd = _pandas()
        _ = self.lines  # checks the lengths of the rows
        parts = [frame for frame, _ in self._raw([], str)]
        return pd.concat(parts, ignore_index=True) if parts else pd.DataFrame(columns=range(len(self.heads)))

    @cached_property
    def lines(self) -> NDArray[np.intp]:
        """The line of each row, from 1."""
        wrong = self._uneven_rows()
        if wrong:
            raise DataError(f"{self.label} is wrong in:", wrong)
        return np.array([line for line, _ in self._rows()], dtype=np.intp)

    def _rows(self) -> Iterator[tuple[int, list[str]]]:
        """Yield the line and the cells of each row that is not empty."""
        with self._opened() as (file, _):
            reader = csv.reader(file, delimiter=self.sep, skipinitialspace=True)
            line = self._skip + 1
            for found in reader:
                cells = self._cells(found)
                comment = self._comment and cells and cells[0].startswith(self._comment)
                if not comment and any(cell not in MISSING for cell in cells):
                    yield line, cells
                line = self._skip + reader.line_num + 1

    def _rows_in_words(self, rows: Collection[int]) -> dict[int, str]:
        try:
            lines = itertools.islice(self._rows(), max(rows) + 1)
            found = {row: f"line {line}" for row, (line, _) in enumerate(lines) if row in rows}
        except DataError:  # on another machine
            found = {}
        return {**super()._rows_in_words(rows), **found}

    def _uneven(self) -> DataError:
        """Return the error for rows that pandas found to differ in length."""
        wrong = self._uneven_rows() or ["rows end with different numbers of empty cells"]
        return DataError(f"{self.label} is wrong in:", wrong)

    def _uneven_rows(self) -> list[str]:
        """Return the faults of rows of other lengths than the header."""
        width = len(self.heads)
        comma = '; separate cells with decimal commas by ";", and give decimal=","' if self.sep == "," else ""
        rows = (
            f"line {line}: has {len(cells)} cells, not {width}{comma if len(cells) > width else ''}"
            for line, cells in self._rows()
            if len(cells) < width or any(cell not in MISSING for cell in cells[width:])
        )
        return list(itertools.islice(rows, DataError.MOST))


class XarrayTable(Table):
    """An xarray.Dataset, whose values may still be in its file; the columns are variables along one dimension."""

    def __init__(self, label: str, dataset: Any) -> None:
        super().__init__(label)
        self._dataset = dataset
        self._variables = list(dataset.variables.values())
        for name, one in dataset.variables.items():
            nothing = one.isel(dict.fromkeys(one.dims, slice(0))).data  # shows a unit of pint, and reads no values
            self.heads.append(Head(str(name), _unit_of(nothing, one.attrs), name in dataset.data_vars))
        self.labels = {str(dim): (dim, index.to_numpy()) for dim, index in dataset.indexes.items()}
        if len(dataset.sizes) == 1:
            self.dim, self.size = next((str(dim), size) for dim, size in dataset.sizes.items())

    def _raw(self, places: Sequence[int]) -> Iterator[tuple[Any, int]]:
        chosen = {place: self._variables[place] for place in places}
        dims = {one.dims for one in chosen.values()} - {()}
        if len(dims) != 1 or len(next(iter(dims))) != 1:
            along = ", ".join(
                f"'{self.heads[place].text}' along {' × '.join(map(str, one.dims)) or 'none'}"
                for place, one in chosen.items()
            )
            raise DataError(f"{self.label}: its columns must all lie along one dimension, got {along}")
        ((dim,),) = dims
        self.dim, self.size = str(dim), self._dataset.sizes[dim]
        step = max(CELLS // len(places), 1)
        for start in range(0, self.size, step):
            rows = slice(start, min(start + step, self.size))
            yield {place: _part(one, rows) for place, one in chosen.items()}, rows.stop - start


def _part(variable: Any, rows: slice) -> Any:
    """Return some rows of a variable of xarray; one that has no dimension is the same in all."""
    data = variable[rows].data if variable.dims else variable.data
    values = np.asarray(getattr(data, "magnitude", data))
    return values if values.ndim else np.full(rows.stop - rows.start, values)


class FrameTable(Table):
    """A pandas.DataFrame."""

    def __init__(self, label: str, frame: Any) -> None:
        super().__init__(label)
        if frame.index.nlevels > 1:
            raise DataError(f"{label}: its index has several levels; call reset_index() on it")
        self.dim = str(frame.index.name or ROW)
        self.labels = {self.dim: (self.dim, frame.index.to_numpy())}
        self._frame, self.size = frame, len(frame)
        for place, text in enumerate(frame.columns):
            column = frame.iloc[:, place]
            self.heads.append(Head(str(text), _unit_of(column.dtype, column.attrs)))

    def _raw(self, places: Sequence[int]) -> Iterator[tuple[Any, int]]:
        columns = {place: self._frame.iloc[:, place] for place in places}
        yield (
            {
                place: np.asarray(one.pint.magnitude) if hasattr(one.dtype, "units") else one
                for place, one in columns.items()
            },
            self.size,
        )


def _pandas() -> Any:
    with needed_for("reading a table", "sweeps"):
        import pandas

    return pandas


def _unit_of(typed: Any, attributes: Mapping[str, Any]) -> str | None:
    """Return the unit of a column from its type or its attributes."""
    units = getattr(typed, "units", None)
    return symbol(units, "~C") if isinstance(units, pint.Unit) else attributes.get("units")


def _agreed(given: str | None, written: Sequence[str]) -> str | None:
    """Return the unit that the user and the table state; an unknown one of the table alone as it is written."""
    stated = [_known(given)] if given is not None else []
    for unit in written:
        try:
            stated.append(_known(unit))
        except UnitError:
            if not stated:
                return unit
    if any(Q(1.0, unit) != Q(1.0, stated[0]) for unit in stated[1:]):
        units = " and ".join(f"'{unit}'" for unit in dict.fromkeys(stated))
        raise UnitError(f"has the units {units}; keep one of them")
    return stated[0] if stated else None


def _known(unit: str) -> str:
    """Return a unit in the notation of pint, "" for "-" and "1"."""
    return "" if unit.strip() in ("", "-", "1") else symbol(Q(1.0, unit).units, "~C")


def _is_number(text: str, decimal: str) -> bool:
    try:
        float(text.replace(decimal, "."))
    except ValueError:
        return False
    return True


def _floats(cells: Any, decimal: str) -> tuple[Array, NDArray[np.bool_]]:
    """Return the numbers of a column, NaN where there is none, and which cells are missing."""
    kind = cells.dtype.kind if isinstance(cells.dtype, np.dtype) else "O"
    if kind in "iuf":
        values = np.ascontiguousarray(cells, dtype=np.float64)
        return values, np.isnan(values)
    pd = _pandas()
    series = pd.Series(np.asarray(cells, dtype=object))
    missing = series.isna().to_numpy()
    if kind in "bmM":  # truth values and times are no numbers
        return np.full(len(series), np.nan), missing
    texts = series.where(~missing, "nan").map(str).str.strip().str.replace("\u2212", "-")
    missing = missing | texts.isin(MISSING).to_numpy()
    if decimal == ",":
        texts = texts.str.replace(".", "?", regex=False).str.replace(",", ".")
    return pd.to_numeric(texts, errors="coerce").to_numpy(dtype=np.float64), missing
