"""Reading columns of a file, block by block: CSV, parquet, netCDF and zarr."""

from __future__ import annotations

import csv
import io
import itertools
import os
import re
from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any, ClassVar, NamedTuple

import numpy as np
import pandas as pd
import xarray

from wearlaw.arrays.array import Array
from wearlaw.errors import DataError, InputError, described, quoted, shortened
from wearlaw.settings.csv_files import kind_of, preamble, rows
from wearlaw.settings.text_files import UTF_16, decoded, read_start, reason_of
from wearlaw.units.quantities import HEAD

ROWS = 100_000
"""Rows read at a time."""

ROW = "row"
"""Default name for the dimension of a table's rows."""

START = 2**16
"""Bytes at the beginning of a CSV file in which its header must stand."""

BUFFER = 2**20
"""Bytes of a CSV file read at a time."""

ZARR = ("zarr.json", ".zgroup", ".zmetadata")
"""Files of which a zarr store has one."""
LONGEST = 2**20
"""Bytes of the longest line of a CSV file: a table may have any number of lines, but is read line by line."""

DECIMAL_COMMA = re.compile(r"[+-]?\d*,\d+([eE][+-]?\d+)?", re.ASCII)


class Head(NamedTuple):
    """The head of a column as written, its unit if the file has it elsewhere, and whether it is a condition by itself.

    Where the user maps no columns, a column is a condition if `alone` is true.
    """

    text: str
    unit: str | None = None
    alone: bool = True

    @property
    def name(self) -> str:
        """The head without a unit in brackets."""
        match = HEAD.fullmatch(self.text)
        return match["name"] if match else self.text


class Piece(NamedTuple):
    """Some rows of some columns.

    Attributes
    ----------
    values : list of ndarray, (rows,)
        The columns, with NaN where there is no number.
    texts : list of ndarray of bool, (rows,), or None
        Where a column has text in place of a number.
    done : int
        The part of the file's `size` that has been read for these rows.
    """

    values: list[Array]
    texts: list[Any]
    done: int


class TableFile(ABC):
    """A file with a table; it is open only while pieces are read.

    Parameters
    ----------
    path : Path

    Attributes
    ----------
    path : Path
    heads : list of Head
        The columns.
    dim : str
        Name for the dimension of the rows.
    size : int
        Size of the file, in units of its own, for a progress bar.

    Raises
    ------
    DataError
        If the file cannot be read, or is empty.
    """

    kind: ClassVar[str]

    def __init__(self, path: Path) -> None:
        self.path = path
        self.heads: list[Head] = []
        self.dim = ROW
        self.size = 0

    @abstractmethod
    def pieces(self, places: Sequence[int]) -> Iterator[Piece]:
        """Yield the rows of some columns, given by their indices in `heads`, in pieces of up to `ROWS` rows."""

    def places_of(self, cells: Sequence[tuple[int, int]]) -> list[tuple[str, str]]:
        """Return for cells, given by row and column, the row in words and the text of the cell, or "" for none.

        Rows and columns count from zero.
        """
        return [(f"row {row} (the first is row 0)", "") for row, _ in cells]

    def failed(self, error: BaseException) -> DataError:
        """Return the error for a file that another package could not read."""
        reason = getattr(error, "strerror", None) or described(error)
        return DataError(f"table: {quoted(self.path)} cannot be read as {self.kind}: {reason}")


def open_table(path: str | os.PathLike[str]) -> TableFile:
    """Return the table in a file of any of the known formats, which is told by the first bytes.

    Raises
    ------
    DataError
        If there is no such file, or it holds no table.
    """
    path = Path(path)
    if os.path.isdir(path):
        if not any((path / name).exists() for name in ZARR):
            raise DataError(
                f"table: {quoted(path)} is a folder and no zarr store; give the path of a file or of a store"
            )
        return XarrayFile(path)
    try:
        start = read_start(path, START)
    except (FileNotFoundError, InputError) as error:
        raise DataError(f"table: cannot read {quoted(path)}: {reason_of(error)}") from None
    if not start:
        raise DataError(f"table: {quoted(path)} is empty")
    if start.startswith(b"PAR1"):
        return ParquetFile(path)
    if start.startswith((b"\x89HDF", b"CDF")):
        return XarrayFile(path)
    return CsvFile(path, start)


class _Lines(io.FileIO):
    """A file of lines that counts the bytes of a kind as they are read, and refuses a line that is too long."""

    def __init__(self, path: Path, counted: bytes = b"\n") -> None:
        super().__init__(path)
        self._counted = counted
        self.count = self._line = 0

    def readinto(self, buffer: Any, /) -> int | None:
        read = super().readinto(buffer)
        if read:
            content = bytes(memoryview(buffer)[:read])
            self.count += content.count(self._counted)
            end = max(content.rfind(b"\n"), content.rfind(b"\r"))
            self._line = read - 1 - end if end >= 0 else self._line + read
            if self._line > LONGEST:
                raise DataError(f"table '{self.name}': has a line of more than {LONGEST} bytes; is it a table?")
        return read


class CsvFile(TableFile):
    """A CSV file as spreadsheets and other programs write it, with a header and, below it, a row of units or none."""

    kind = "CSV"

    def __init__(self, path: Path, start: bytes) -> None:
        super().__init__(path)
        kind = kind_of(start)
        if kind is None and b"\0" in start and not start.startswith(UTF_16):
            kind = "no text"
        if kind is not None:
            raise DataError(f"table: {quoted(path)} is {kind}; give a file in CSV, parquet, netCDF or zarr")
        self.size = path.stat().st_size
        self.encoding = self._encoding(start)
        with self._opened() as file:
            source = preamble(itertools.islice(file, START))
        if source.header is None:
            raise DataError(f"table: {quoted(path)} is empty")
        self.separator = source.separator
        try:
            with self._opened() as file:
                above = list(itertools.islice(file, source.header))
                first = [row for row, _ in zip(rows(file, len(above), self.separator), range(100), strict=False)]
        except csv.Error as error:
            raise self.failed(error) from None
        header, below = first[0], [row for row in first[1:] if any(map(str.strip, row.cells))]
        units = below[0].cells if below and self._are_units(below[0].cells) else []
        self.first_line = below[bool(units)].line if len(below) > bool(units) else 0
        self.width = len(header.cells)
        spare: list[str | None] = [None] * self.width
        given = [cell.strip().strip("[]()").strip() or None for cell in units]
        self.heads = [Head(text.strip(), unit) for text, unit in zip(header.cells, [*given, *spare], strict=False)]
        while self.heads and not self.heads[-1].text:
            self.heads.pop()
        commas = (DECIMAL_COMMA.fullmatch(cell.strip()) for row in below for cell in row.cells)
        self.decimal = "," if self.separator != "," and any(commas) else "."

    @staticmethod
    def _encoding(start: bytes) -> str:
        if start.startswith(UTF_16):
            return "utf-16"
        try:
            decoded(start[: start.rfind(b"\n") + 1])
        except UnicodeDecodeError:
            return "cp1252"
        return "utf-8-sig"

    @staticmethod
    def _are_units(cells: Sequence[str]) -> bool:
        """Return whether a row below the header holds units: texts, none of which is a number."""
        texts = [cell.strip() for cell in cells if cell.strip()]
        return bool(texts) and not any(re.match(r"[+-]?[.,]?\d|[+-]?(nan|inf)", text, re.IGNORECASE) for text in texts)

    def _opened(self) -> io.TextIOWrapper:
        return self._text(_Lines(self.path))

    def _text(self, raw: _Lines, buffer: int = START) -> io.TextIOWrapper:
        buffered = io.BufferedReader(raw, buffer)
        return io.TextIOWrapper(buffered, encoding=self.encoding, errors="replace", newline="")

    def pieces(self, places: Sequence[int]) -> Iterator[Piece]:
        """Yield the rows of some columns."""
        if not self.first_line:
            return
        count, before = 0, 0
        with _Lines(self.path, self.separator.encode("ascii")) as raw:
            text = self._text(raw, BUFFER)
            above = sum(line.count(self.separator) for line in itertools.islice(text, self.first_line - 1))
            try:
                with pd.read_csv(
                    text,
                    sep=self.separator,
                    header=None,
                    names=list(range(self.width)),
                    usecols=list(dict.fromkeys(places)),
                    index_col=False,
                    chunksize=ROWS,
                    decimal=self.decimal,
                    skipinitialspace=True,
                ) as reader:
                    for frame in reader:
                        count += len(frame)
                        done = raw.tell() - before
                        before += done
                        columns = [_numbers(frame[place]) for place in places]
                        yield Piece([one for one, _ in columns], [text for _, text in columns], done)
            except (OSError, pd.errors.ParserError, pd.errors.EmptyDataError) as error:
                raise self.failed(error) from None
            if raw.count - above != count * (self.width - 1):
                self._check_widths()

    def _check_widths(self) -> None:
        """Raise an error for the first row with more or fewer cells than the header."""
        for row in self._rows():
            beyond = "".join(row.cells[self.width :]).strip()
            if len(row.cells) < self.width or beyond:
                hint = "; with decimal commas, separate cells by ';'" if beyond and self.separator == "," else ""
                raise DataError(
                    f"table {quoted(self.path)}, line {row.line}: has {len(row.cells)} cells, but the header has"
                    f" {self.width}{hint}"
                )

    def _rows(self) -> Iterator[Any]:
        """Yield the rows below the header, without empty lines."""
        with self._opened() as file:
            above = sum(1 for _ in itertools.islice(file, self.first_line - 1))
            for row in rows(file, above, self.separator):
                if len(row.cells) > 1 or "".join(row.cells).strip():
                    yield row

    def places_of(self, cells: Sequence[tuple[int, int]]) -> list[tuple[str, str]]:
        """Return the lines of cells, and their texts."""
        wanted = {row for row, _ in cells}
        try:
            last = max(wanted, default=-1)
            found = {n: row for n, row in enumerate(itertools.islice(self._rows(), last + 1)) if n in wanted}
        except (OSError, csv.Error):  # on another machine
            return super().places_of(cells)
        if found.keys() < wanted:
            return super().places_of(cells)
        texts = [found[row].cells[place : place + 1] for row, place in cells]
        return [(f"line {found[row].line}", "".join(text).strip()) for (row, _), text in zip(cells, texts, strict=True)]


def _numbers(column: Any) -> tuple[Array, Any]:
    """Return a column of pandas as floats, and where it holds text, or None."""
    if column.dtype.kind in "iuf" and isinstance(column.dtype, np.dtype):
        return column.to_numpy(dtype=np.float64), None
    if column.dtype == bool:
        return np.full(len(column), np.nan), np.full(len(column), fill_value=True)
    numbers = pd.to_numeric(column.map(str).where(column.notna()), errors="coerce").to_numpy(dtype=np.float64)
    return numbers, np.isnan(numbers) & column.notna().to_numpy()


class ParquetFile(TableFile):
    """A parquet file; `pyarrow` reads it."""

    kind = "parquet"

    def __init__(self, path: Path) -> None:
        super().__init__(path)
        pyarrow = self._pyarrow()
        try:
            with pyarrow.parquet.ParquetFile(path) as file:
                self.heads = [Head(name) for name in file.schema_arrow.names]
                self.size = file.metadata.num_rows
        except (OSError, pyarrow.ArrowException) as error:
            raise self.failed(error) from None

    def _pyarrow(self) -> Any:
        try:
            import pyarrow.parquet
        except ImportError:
            raise DataError(
                f"table: {quoted(self.path)} is a parquet file, which pyarrow reads; install it with"
                ' python -m pip install "wearlaw[parquet]", or give the table as CSV or netCDF'
            ) from None
        return pyarrow

    def pieces(self, places: Sequence[int]) -> Iterator[Piece]:
        """Yield the rows of some columns."""
        pa = self._pyarrow()
        with pa.parquet.ParquetFile(self.path) as file:
            for place in places:
                kind = file.schema_arrow.field(place).type
                if not (pa.types.is_integer(kind) or pa.types.is_floating(kind) or pa.types.is_decimal(kind)):
                    raise DataError(
                        f"table {quoted(self.path)}, column {quoted(self.heads[place].text)}: is {kind}, not numbers"
                    )
            names = [self.heads[place].text for place in places]
            try:
                for batch in file.iter_batches(ROWS, columns=list(dict.fromkeys(names)), use_threads=False):
                    values = [batch.column(name).cast(pa.float64()).to_numpy(zero_copy_only=False) for name in names]
                    yield Piece(values, [None] * len(values), batch.num_rows)
            except (OSError, pa.ArrowException) as error:
                raise self.failed(error) from None


class XarrayFile(TableFile):
    """A netCDF file or a zarr store; xarray reads it."""

    kind = "netCDF or zarr"

    def __init__(self, path: Path) -> None:
        super().__init__(path)
        with self._opened() as dataset:
            sizes = {str(dim): size for dim, size in dataset.sizes.items()}
            self._dims = {str(name): tuple(map(str, one.dims)) for name, one in dataset.variables.items()}
            self.heads = [
                Head(name, dataset.variables[name].attrs.get("units"), name in dataset.data_vars) for name in self._dims
            ]
        if len(sizes) == 1:
            ((self.dim, self.size),) = sizes.items()
        self._sizes = sizes

    def _opened(self) -> Any:
        try:
            if self.path.is_dir():
                return xarray.open_zarr(self.path, chunks=None, consolidated=False, decode_times=False)
            return xarray.open_dataset(self.path, decode_times=False)
        except (OSError, ValueError, KeyError, ImportError) as error:
            raise self.failed(error) from None

    def pieces(self, places: Sequence[int]) -> Iterator[Piece]:
        """Yield the rows of some columns, which must lie along one dimension."""
        heads = [self.heads[place].text for place in places]
        dims = {self._dims[head] for head in heads}
        if len(dims) != 1 or len(next(iter(dims))) != 1:
            laid_out = ", ".join(f"{quoted(head)} along {' × '.join(self._dims[head]) or 'none'}" for head in heads)
            raise DataError(f"table {quoted(self.path)}: its columns must all lie along one dimension, got {laid_out}")
        ((self.dim,),) = dims
        self.size = self._sizes[self.dim]
        with self._opened() as dataset:
            for head in heads:
                if dataset.variables[head].dtype.kind not in "iuf":
                    raise DataError(f"table {quoted(self.path)}, column {quoted(head)}: holds no numbers")
            for start in range(0, self.size, ROWS):
                part = {self.dim: slice(start, start + ROWS)}
                values = [np.asarray(dataset.variables[head].isel(part).values, dtype=np.float64) for head in heads]
                yield Piece(values, [None] * len(values), len(values[0]))


def state(path: Path) -> object:
    """Return the size and the time of the last change of a file; None for a folder."""
    if path.is_dir():
        return None
    found = path.stat()
    return found.st_size, found.st_mtime_ns


def faults(file: TableFile, cells: Iterable[tuple[int, int]]) -> list[str]:
    """Return a message for each cell without a number, given by row and column."""
    cells = list(cells)
    return [
        f"{where}, column {quoted(file.heads[place].text)}: "
        + (f"{shortened(text)} is not a number" if text else "is missing")
        for (_, place), (where, text) in zip(cells, file.places_of(cells), strict=True)
    ]
