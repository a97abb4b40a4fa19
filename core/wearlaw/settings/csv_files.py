"""CSV as spreadsheets and other programs write it: comments, separator, header, and rows with their line numbers."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterable, Iterator
from typing import NamedTuple

_NOT_TEXT = {b"PK\x03\x04": "a workbook (.xlsx, .ods)", b"\xd0\xcf\x11\xe0": "an old workbook (.xls)"}


class Preamble(NamedTuple):
    """The lines above the header.

    Attributes
    ----------
    source : str
        The source stated in a comment, as in "# source: ...", or "".
    separator : str
        The separator of cells.
    header : int or None
        Index of the header's line; None if there is none.
    """

    source: str
    separator: str
    header: int | None


class Row(NamedTuple):
    """The cells of a row, and the number of its first line."""

    line: int
    cells: list[str]


def kind_of(start: bytes) -> str | None:
    """Return the kind of a file that is no CSV from its first bytes, or None."""
    return next((kind for first, kind in _NOT_TEXT.items() if start.startswith(first)), None)


def preamble(lines: Iterable[str]) -> Preamble:
    """Return the source, the separator and the place of the header."""
    source = separator = ""
    for number, line in enumerate(lines):
        stripped = line.strip()
        if re.fullmatch("sep=[,;|]?", stripped):
            separator = stripped[4:] or "\t"
        elif stripped.startswith(("#", '"#')):
            key, _, value = _comment(stripped).partition(":")
            source = value.strip() if key.casefold() == "source" else source
        elif stripped.strip(",;"):
            found = next((mark for mark in ";\t" if mark in line), ",")
            return Preamble(source, separator or found, number)
    return Preamble(source, ",", None)


def _comment(line: str) -> str:
    """Return a comment without the quotes and separators that a spreadsheet adds to it."""
    quoted = re.match(r'"((?:[^"]|"")*)', line)
    text = quoted[1].replace('""', '"') if quoted else line.rstrip(",;\t ")
    return text.lstrip("# ")


def rows(lines: Iterable[str], start: int, separator: str) -> Iterator[Row]:
    """Yield the rows of `lines`, the first of which has the index `start` in its file.

    Raises
    ------
    csv.Error
        If they are not CSV.
    """
    reader = csv.reader(lines, delimiter=separator, skipinitialspace=True)
    line = start + 1
    for cells in reader:
        yield Row(line, cells)
        line = start + reader.line_num + 1
