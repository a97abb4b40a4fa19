"""Tables of numbers with units, from CSV files, pandas or xarray.

>>> import wearlaw as wl
>>> table = wl.read_table("run.csv", {"normal_force": "Fz [kN]", "creepage": "-slip [%]"})
>>> table["normal_force"]
[7.100 7.200] kN
"""

from __future__ import annotations

import csv
import inspect
import io
import itertools
import os
import re
import sys
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, TextIO

import numpy as np

from wearlaw import loader
from wearlaw.arrays import Array
from wearlaw.errors import PROBLEMS, DataError, UnitError, did_you_mean, shown
from wearlaw.late import needed_for
from wearlaw.text_files import NOT_A_SPREADSHEET, SPREADSHEETS, encoding_of
from wearlaw.units.quantities import Q, Quantity
from wearlaw_apps import sheets
from wearlaw_apps.heads import Column, agreed, is_title, known, named_column

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

HEAD_LINES, SHOWN, LONGEST = 40, 4, 80
"""Lines at the top that show the form of a file, those that a message shows, and its most characters of each."""

SEPARATORS = {" ": "spaces", "\t": "tabs", ",": "commas", ";": "semicolons", "|": "bars"}

LISTED = 20
"""Most columns that a message lists."""


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
    comments : list of str
        Lines above the header of a CSV file that begin with "#".
    header : int
        The line of the header of a CSV file, from 1.
    on_disk : bool
        Whether its values are in a file, and not in memory.
    """

    on_disk = False

    def __init__(self, label: str, heads: Iterable[str] = ()) -> None:
        self.label = label
        self.heads = [named_column(head, place) for place, head in enumerate(heads)]
        self.columns: dict[str, Column] = {}
        self.comments: list[str] = []
        self.header = 0
        self.decimal = "."
        self.dim = ROW
        self.labels: dict[str, Any] = {}

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
        (values,) = self._numbers([column], self._whole, 0, [name])
        return values

    @cached_property
    def lines(self) -> NDArray[np.intp]:
        """The line of each row of a CSV file, from 1; empty for other tables."""
        return np.empty(0, dtype=np.intp)

    def texts(self, name: str) -> list[str]:
        """Return the cells of a column as text, "" for missing ones."""
        texts = (str(cell).strip() for cell in self._whole[self._column(name).place])
        return ["" if text in MISSING else text for text in texts]

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
        if columns is not None and not isinstance(columns, Mapping):
            raise DataError(
                f'{argument}: must map names to columns, such as {{"force": "Fz [N]"}}, got {shown(columns)}'
            )
        wrong: list[str] = []
        selected: dict[str, Column] = {}
        for column in self.heads if columns is None else ():
            if column.name in selected:
                wrong.append(f"{column.name} is given twice, by '{selected[column.name].head}' and '{column.head}'")
            selected[column.name] = column
        for name, text in (columns or {}).items():
            try:
                if not name.isidentifier():
                    raise DataError(f"{argument}: '{name}' is no name; use letters, digits and underscores")
                selected[name] = self._find(name, text)
            except (DataError, UnitError) as error:
                wrong.append(str(error))
        if wrong and len(self.heads) == 1 and (begin := self.as_read()):
            wrong.append(f'{begin}; begin lines above the heads with "#", or give sep')
        if wrong:
            raise DataError(f"{self.label} is wrong in:", wrong)
        return selected

    def pieces(self, columns: Sequence[Column], gaps: Collection[str] = ()) -> Iterator[list[Array]]:
        """Yield the values of columns piece by piece.

        Raises
        ------
        DataError
            If a cell holds text, or is missing in a column that is not named in `gaps`; the message names the lines.
        """
        first = 0
        for frame in self._frames():
            values = self._numbers(columns, frame, first, gaps)
            yield values
            first += len(values[0])

    def _frames(self) -> Iterator[Any]:
        """Yield some rows, with the places of columns as their names."""
        yield self._whole

    @cached_property
    def _whole(self) -> Any:
        """All rows."""
        raise NotImplementedError

    def as_read(self) -> str:
        """Return the first lines of a file as they were understood, for messages."""
        return ""

    def _rows_in_words(self, rows: Collection[int]) -> dict[int, str]:
        return {row: f"row {row} (the first is row 0)" for row in rows}

    def _column(self, name: str) -> Column:
        if name not in self.columns:
            raise DataError(f"{self.label}: there is no column '{name}'{did_you_mean(name, self.columns)}")
        return self.columns[name]

    def _find(self, name: str, text: str) -> Column:
        """Return the column that a text names, with its sign and the unit that the text or the table states."""
        for sign, rest in ((1.0, text), (-1.0, text.removeprefix("-").strip())):
            wanted = named_column(rest, 0)
            for matches in (
                [column for column in self.heads if column.head == rest],
                [column for column in self.heads if column.name == wanted.name],
            ):
                if len(matches) > 1:
                    raise DataError(f"{name}: the column '{rest}' is there {len(matches)} times; rename all but one")
                if matches:
                    return matches[0]._replace(name=name, unit=agreed(name, wanted, matches[0]), sign=sign)
        heads = [column.head for column in self.heads]
        near = did_you_mean(text.removeprefix("-"), [*heads, *(column.name for column in self.heads)]).rstrip(".")
        listed = ", ".join(f"'{column}'" for column in heads[:LISTED]) + (", ..." if len(heads) > LISTED else "")
        raise DataError(f"{name}: there is no column '{text}'{near or ';'} The columns are {listed}")

    def _numbers(self, columns: Sequence[Column], frame: Any, first: int, gaps: Collection[str]) -> list[Array]:
        """Return columns of a frame, the first row of which has the number `first`, as floats."""
        arrays, wrong = [], []
        for column in columns:
            cells = frame[column.place]
            values, missing = _floats(cells, self.decimal)
            arrays.append(values if column.sign > 0 else -values)
            without = np.isnan(values) & ~(missing & (column.name in gaps))
            wrong += [
                (int(row), column, "" if missing[row] else str(cells.iloc[row]))
                for row in np.flatnonzero(without)[:PROBLEMS]
            ]
        if wrong:
            wrong = sorted(wrong, key=lambda cell: cell[0])[:PROBLEMS]
            if self._hint(wrong[0][2]):  # all others of the column are alike
                wrong = wrong[:1]
            places = self._rows_in_words({first + row for row, _, _ in wrong})
            problems = [
                f"{places[first + row]}, column '{column.head}': "
                + (
                    f"{shown(text)} is not a number{self._hint(text) or '; leave cells without a value empty'}"
                    if text
                    else "is missing"
                )
                for row, column, text in wrong
            ]
            if first + wrong[0][0] == 0 and (begin := self.as_read()):  # wrong from the first row on
                problems.append(begin)
            raise DataError(f"{self.label} is wrong in:", problems)
        return arrays

    def _hint(self, text: str) -> str:
        """Return how to write what is nearly a number."""
        other = "," if self.decimal == "." else "."
        decimal = f'for decimals with "{other}", give decimal="{other}", on the command line --decimal {other}'
        hints = {
            rf"\d*\{other}\d*": decimal,
            rf"\d{{1,3}}([ {other}]\d{{3}})+": "leave out what separates thousands",
            r".*±.*": 'keep what follows "±" in a column of its own',
            r"[\d.,]*\d ?[^\W\d].*|.*[%°]": "state the unit in the head, as in 'Fz [N]'",
        }
        bare = text.lstrip("+-")
        return "".join(f"; {hint}" for pattern, hint in hints.items() if re.fullmatch(pattern, bare))


def read_table(
    source: str | os.PathLike[str] | TextIO | pandas.DataFrame | xarray.Dataset,
    columns: Mapping[str, str] | None = None,
    *,
    sep: str | None = None,
    decimal: str = ".",
    comment: str = "#",
    sheet: str | None = None,
) -> Table:
    """Return columns of a table with their units.

    Parameters
    ----------
    source : path, text file, pandas.DataFrame or xarray.Dataset
        A CSV file, a spreadsheet (.xlsx, .ods), or a table of pandas or xarray, such as
        ``xarray.open_dataset("run.nc", decode_times=False)``. The unit of a column stands in its head, as in "Fz [kN]"
        or "Fz (kN)", in a row of units below the heads, or in the `attrs["units"]` of xarray. "[-]" is a ratio. If all
        cells of the first row of a CSV file are numbers, it has no header, and the columns are "1", "2", ...
    columns : mapping of str to str, optional
        The columns to use by the names that they get, as in {"force": "Fz [kN]", "creepage": "-slip"}. A minus changes
        the sign. State the unit in brackets if the table does not. Default: all, by their heads without units.
    sep : str, optional
        What separates the cells of a CSV file; " " for any number of spaces. Default: the first of semicolon, tab, bar
        and comma that the header has, and spaces for numbers or heads without any of them.
    decimal : {".", ","}
        The decimal mark of a CSV file.
    comment : str
        What lines above the header of a CSV file begin with that are comments; without a header, all such lines.
    sheet : str, optional
        The sheet of a spreadsheet by its name. Default: the only one that has cells.

    Returns
    -------
    Table

    Raises
    ------
    DataError
        If there is no such table, or no such column; the message names all faults.
    """
    table = open_table(source, sep=sep, decimal=decimal, comment=comment, sheet=sheet)
    table.columns = table.select(columns)
    return table


def open_table(
    source: Any, *, sep: str | None = None, decimal: str = ".", comment: str = "#", sheet: str | None = None
) -> Table:
    """Return a table without columns in use; arguments as for `read_table`."""
    if sheet is not None and not is_spreadsheet(source):
        name = getattr(source, "name", source)
        raise DataError(f"sheet: {shown(name)} is no spreadsheet; give one that ends in {', '.join(sheets.ENDINGS)}")
    if isinstance(source, str | os.PathLike):
        path, label = Path(source), f"table {shown(Path(source))}"
        if is_spreadsheet(path):
            return CsvTable(label, sheets.text_of(path, label, sheet), "\t", decimal, comment)
        if reader := dict(loader.installed("file reader")).get(path.suffix[1:]):
            return open_table(reader(path))
        return CsvTable(label, path, sep, decimal, comment)
    if hasattr(source, "read"):
        return CsvTable(f"table '{getattr(source, 'name', 'text')}'", source.read().encode(), sep, decimal, comment)
    pandas, xarray = sys.modules.get("pandas"), sys.modules.get("xarray")  # loaded already if the table is theirs
    if xarray is not None and isinstance(source, xarray.Dataset):
        return FrameTable(_frame(source))
    if pandas is not None and isinstance(source, pandas.DataFrame):
        return FrameTable(source)
    raise DataError(f"table: must be a path, a pandas.DataFrame or an xarray.Dataset, got {shown(source)}")


def explain_reader(name: str, reader: Callable[..., Any]) -> Iterator[str]:
    """Yield the lines of `wearlaw show` for a reader of files."""
    yield inspect.getdoc(reader) or ""
    yield f"It reads files that end in .{name}, in wl.read_profile or wl.sweep."


def is_spreadsheet(source: object) -> bool:
    """Return whether a source is the path of a spreadsheet, by its ending."""
    return isinstance(source, str | os.PathLike) and Path(source).suffix.lower() in sheets.ENDINGS


class FrameTable(Table):
    """A pandas.DataFrame."""

    def __init__(self, frame: pandas.DataFrame) -> None:
        super().__init__("table", map(str, frame.columns))
        if frame.index.nlevels > 1:
            raise DataError("table: its index has several levels; call reset_index() on it")
        self.dim = ROW if frame.index.name is None else str(frame.index.name)
        self.labels = {self.dim: (self.dim, frame.index.to_numpy())}
        self._frame = frame.set_axis(range(frame.shape[1]), axis=1)

    @cached_property
    def _whole(self) -> Any:
        return self._frame


def _frame(dataset: xarray.Dataset) -> pandas.DataFrame:
    """Return a dataset as a table, with units in its heads."""
    if len(dataset.sizes) != 1:
        along = ", ".join(f"'{name}' along {' × '.join(map(str, variable.dims))}" for name, variable in dataset.items())
        raise DataError(f"table: its columns must all lie along one dimension, got {along}; select some of them")
    units = {name: variable.attrs.get("units") for name, variable in dataset.variables.items()}
    frame = dataset.to_dataframe()
    return frame.rename(columns={name: f"{name} [{unit}]" for name, unit in units.items() if unit})


class CsvTable(Table):
    """A CSV file, or the bytes of one."""

    def __init__(self, label: str, source: Path | bytes, sep: str | None, decimal: str, comment: str = "#") -> None:
        super().__init__(label)
        if decimal not in (".", ","):
            raise DataError(f'decimal: must be "." or ",", got {decimal!r}')
        self._source, self.decimal = source, decimal
        self.on_disk = isinstance(source, Path)
        self._skip, header, units = 0, "", ""
        with self._opened() as file:
            head = [file.readline() for _ in range(HEAD_LINES)]
            if any("\0" in line for line in head):
                raise DataError(f"{label} is no text; export it as text or as a spreadsheet, or give a table of pandas")
            self._of_blocks = _begins_blocks(head)
            if self._of_blocks:
                self._source, sep, self.on_disk = _joined(label, [*head, *file]).encode(), "\t", False
        with self._opened() as file:
            while header := file.readline():
                while header.count('"') % 2 and (more := file.readline()):  # a line break in a head
                    header, self._skip = header + more, self._skip + 1
                text = "".join(header.split()).strip(",;")
                if text and not header.lstrip('" ').startswith(comment) and not is_title(header, head):
                    break
                self._skip += 1
                self.comments.append(header.strip('",; \t\r\n').lstrip(f"{comment} "))
            units = file.readline()
        if not header:
            raise DataError(f"{label} is empty")
        marks = [mark for mark in ";\t|," if mark in header]
        spaced = len(header.split()) > 1 and any(_are_numbers(line.split(), header.split(), decimal) for line in head)
        self.sep = sep or next(iter(marks), " " if spaced or _is_number(header.split()[0], decimal) else ",")
        cells, below = map(self._split, (header, units))
        while cells and not cells[-1]:
            cells.pop()
        bare = all(_is_number(cell, decimal) for cell in cells)
        self.header = self._skip + 1
        self._skip += not bare
        self._comment = comment if bare else None
        if not bare and _are_units(below, decimal):
            self._skip += 1
            stated = (unit.strip("[]()") for unit in below)
            pairs = itertools.zip_longest(cells, itertools.islice(stated, len(cells)), fillvalue="")
            cells = [f"{cell} [{unit}]" if unit and "[" not in cell else cell for cell, unit in pairs]
        self.heads = [named_column(str(place + 1) if bare else cell, place) for place, cell in enumerate(cells)]

    def _split(self, line: str) -> list[str]:
        cells = next(csv.reader([" ".join(line.splitlines())], delimiter=self.sep, skipinitialspace=True), [])
        return self._cells(cells)

    def _cells(self, cells: Sequence[str]) -> list[str]:
        return " ".join(cells).split() if self.sep == " " else [cell.strip() for cell in cells]

    @contextmanager
    def _opened(self, whole: bool = False) -> Iterator[TextIO]:
        """Give the file as text, behind the lines to skip."""
        try:
            with io.BytesIO(self._source) if isinstance(self._source, bytes) else self._source.open("rb") as raw:
                begin = raw.peek(1) if isinstance(raw, io.BufferedReader) else b""
                if begin.startswith(SPREADSHEETS):
                    raise DataError(f"{self.label} cannot be read: {NOT_A_SPREADSHEET}")
                file = io.TextIOWrapper(raw, encoding=encoding_of(begin), newline="")
                for _ in range(0 if whole else self._skip):
                    file.readline()
                yield file
        except FileNotFoundError:
            raise DataError(f"{self.label}: there is no such file") from None
        except (OSError, UnicodeDecodeError, csv.Error) as error:
            raise self._failed(error) from None

    def _failed(self, error: Exception) -> DataError:
        reason = getattr(error, "strerror", None) or f"{type(error).__name__}: {error}"
        others = "open other files with pandas or xarray, and give the table"
        return DataError(f"{self.label} cannot be read as CSV in UTF-8: {reason}; {others}")

    def _frames(self) -> Iterator[Any]:
        pd = _pandas()
        width = len(self.heads)
        with self._opened() as file:
            try:
                with pd.read_csv(
                    file,
                    sep=r"\s+" if self.sep == " " else self.sep,
                    header=None,  # and no names, or pandas would not see rows that are too long
                    decimal=self.decimal,
                    comment=self._comment,
                    keep_default_na=False,
                    na_values=list(MISSING),
                    skipinitialspace=True,
                    chunksize=max(CELLS // width, 1),
                    low_memory=False,
                ) as reader:
                    for frame in reader:
                        if len(frame.columns) < width or frame.iloc[:, width:].notna().any(axis=None):
                            raise self._uneven()
                        yield frame.dropna(how="all")
            except pd.errors.EmptyDataError:
                return
            except pd.errors.ParserError as error:
                raise self._uneven() if "Expected" in str(error) else self._failed(error) from None

    @cached_property
    def _whole(self) -> Any:
        width = len(self.heads)
        rows = []
        for _, cells in self._rows():
            if len(cells) < width or any(cell not in MISSING for cell in cells[width:]):
                raise self._uneven()
            rows.append(cells[:width])
        return _pandas().DataFrame(rows, columns=range(width), dtype=object)

    @cached_property
    def lines(self) -> NDArray[np.intp]:
        """The line of each row, from 1."""
        return np.array([line for line, _ in self._rows()], dtype=np.intp)

    def _rows(self) -> Iterator[tuple[int, list[str]]]:
        """Yield the line and the cells of each row that is not empty."""
        with self._opened() as file:
            reader = csv.reader(file, delimiter=self.sep, skipinitialspace=True, strict=True)
            line = self._skip + 1
            for row in reader:
                cells = self._cells(row)
                comment = self._comment and cells and cells[0].startswith(self._comment)
                if not comment and any(cell not in MISSING for cell in cells):
                    yield line, cells
                line = self._skip + reader.line_num + 1

    def _rows_in_words(self, rows: Collection[int]) -> dict[int, str]:
        if self._of_blocks:
            return super()._rows_in_words(rows)
        try:
            lines = itertools.islice(self._rows(), max(rows) + 1)
            words = {row: f"line {line}" for row, (line, _) in enumerate(lines) if row in rows}
        except DataError:  # on another machine
            words = {}
        return {**super()._rows_in_words(rows), **words}

    def _uneven(self) -> DataError:
        """Return the error for rows of other lengths than the header."""
        width = len(self.heads)
        comma = '; separate cells with decimal commas by ";", and give decimal=","' if self.sep == "," else ""
        wrong = (
            f"line {line}: has {len(cells)} cells, not {width}{comma if len(cells) > width else ''}"
            for line, cells in self._rows()
            if len(cells) < width or any(cell not in MISSING for cell in cells[width:])
        )
        return DataError(f"{self.label} is wrong in:", [*itertools.islice(wrong, PROBLEMS - 1), self.as_read()])

    def as_read(self) -> str:
        """Return the first lines as they were understood, for messages."""
        with self._opened(whole=True) as file:
            lines = [line for line in itertools.islice(file, SHOWN) if line.strip()]
        cells = "; ".join(" | ".join(self._split(line))[:LONGEST] for line in lines)
        return f"as read, with {SEPARATORS.get(self.sep, shown(self.sep))} between cells, it begins: {cells}"


def _pandas() -> Any:
    with needed_for("reading a table", "sweeps"):
        import pandas

    return pandas


def _are_units(cells: Sequence[str], decimal: str) -> bool:
    """Return whether the cells below a header are units: no numbers, and units in more than half of those in use."""
    texts = [cell.strip("[]()") for cell in cells if cell]
    if not any(map(str.isalpha, "".join(texts))) or any(_is_number(text, decimal) for text in {*texts} - {"1"}):
        return False
    matched = 0
    for text in texts:
        with suppress(UnitError):
            known(text)
            matched += 1
    return 2 * matched > len(texts)


def _begins_blocks(lines: Sequence[str]) -> bool:
    """Return whether a file has blocks, one for each variable: its name, the number of points, and x and y of each."""
    return any(
        name.strip() and count.strip().isdigit() and ";" in pair and len(_pair(pair)) == 2
        for name, count, pair in zip(lines, lines[1:], lines[2:], strict=False)
    )


def _pair(line: str) -> list[str]:
    cells = [cell.strip() for cell in line.split(";")]
    return cells if all(_is_number(cell, ".") for cell in cells) else []


def _joined(label: str, lines: Sequence[str]) -> str:
    """Return blocks as one table, with x in the first column and a column for each variable."""
    x: list[str] = []
    columns: dict[str, list[str]] = {}
    name, rest = "", iter(enumerate(lines, 1))
    for number, line in rest:
        if not line.strip().isdigit():
            name = line.strip() or name
            continue
        pairs = [_pair(row) for _, row in itertools.islice(rest, int(line))]
        if len(pairs) < int(line) or any(len(pair) != 2 for pair in pairs):
            raise DataError(f"{label}: the block '{name}' from line {number} has not {line.strip()} rows of x ; y")
        if name in columns:
            raise DataError(f"{label}: the block '{name}' from line {number} is there twice; rename one")
        x = x or [pair[0] for pair in pairs]
        if list(map(float, x)) != [float(pair[0]) for pair in pairs]:
            first = next(iter(columns))
            raise DataError(f"{label}: the blocks '{first}' and '{name}' have other x; export them at the same steps")
        columns[name] = [pair[1] for pair in pairs]
    return "\n".join(map("\t".join, [("x", *columns), *zip(x, *columns.values(), strict=True)])) + "\n"


def _are_numbers(cells: Sequence[str], heads: Sequence[str], decimal: str) -> bool:
    """Return whether cells are numbers, one for each head."""
    return len(cells) == len(heads) and all(_is_number(cell, decimal) for cell in cells)


def _is_number(text: str, decimal: str) -> bool:
    try:
        float(text.replace(decimal, "."))
    except ValueError:
        return False
    return True


def _floats(cells: Any, decimal: str) -> tuple[Array, NDArray[np.bool_]]:
    """Return the numbers of a column of pandas, NaN where there is none, and which cells are missing."""
    if isinstance(cells.dtype, np.dtype) and cells.dtype.kind in "iuf":
        values = np.ascontiguousarray(cells, dtype=np.float64)
        return values, np.isnan(values)
    pd = _pandas()
    missing = cells.isna()
    if cells.dtype.kind in "bmM":  # truth values and times are no numbers
        return np.full(len(cells), np.nan), missing.to_numpy()
    texts = cells.where(~missing, "nan").map(str).str.strip().str.replace("\u2212", "-")
    missing |= texts.isin(MISSING)
    if decimal == ",":
        texts = texts.str.replace(".", "?", regex=False).str.replace(",", ".")
    there = pd.to_numeric(texts, errors="coerce").notna()  # but pandas before 3 may miss the last bit
    return texts.where(there, "nan").map(float).to_numpy(dtype=np.float64), missing.to_numpy()
