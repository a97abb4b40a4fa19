"""Tables of numbers as CONTACT writes them: comment lines that begin with %, and rows of one length."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NoReturn

import numpy as np
from numpy.typing import NDArray

import wearlaw as wl
from wearlaw import Array

LARGEST = 256 * 2**20
"""Size of the largest file that is read [bytes]."""

OTHERS = {
    b"MATLAB 5.0 MAT-file": "a binary file of MATLAB or Octave",
    b"\x89HDF\r\n\x1a\n": "an HDF5 file, as MATLAB 7.3 writes it",
    b"PK\x03\x04": "an archive or a workbook",
}
"""Other files, by their first bytes."""

NUMBER = re.compile(r"([+-]?(?:\d+\.?\d*|\.\d+))(?:[eEdD]?([+-]\d+)|[eEdD](\d+))?", re.ASCII)
"""A number of Fortran; it drops the E before an exponent of three digits."""


HUGE = 1e30
"""What no number of a contact exceeds in magnitude, in any unit."""


@dataclass(frozen=True)
class Table:
    """The rows of a file.

    Attributes
    ----------
    path : Path
        The file, for messages.
    values : ndarray, (rows, columns)
        The numbers.
    lines : ndarray of int, (rows,)
        The line of each row.
    """

    path: Path
    values: Array
    lines: NDArray[np.intp]

    def wrong(self, row: int, column: int, name: str, rule: str) -> NoReturn:
        """Raise an error for a number, by its row and column from 0."""
        got = f"{self.values[row, column]:g}"
        raise wl.DataError(f"'{self.path}', line {self.lines[row]}, column {column + 1} ({name}): {rule}, got {got}")

    def whole(self, row: int, column: int, name: str, known: Sequence[int] | range) -> int:
        """Return a whole number among those known, or raise an error."""
        value = self.values[row, column]
        if value not in known:
            some = f"from {known[0]} to {known[-1]}" if isinstance(known, range) else " or ".join(map(str, known))
            self.wrong(row, column, name, f"must be {some}")
        return int(value)

    def positive(self, row: int, column: int, name: str) -> float:
        """Return a positive number, or raise an error."""
        value = float(self.values[row, column])
        if not value > 0.0:
            self.wrong(row, column, name, "must be positive")
        return value


def is_table(head: bytes) -> bool:
    """Return whether a file may be such a table, by its first bytes."""
    return head.startswith(b"%") and b"\0" not in head


def table_of(path: Path) -> Table:
    """Return the numbers of a file.

    Raises
    ------
    DataError
        If the file is none of CONTACT's, is cut short, or holds anything but numbers that a contact can have.
    """
    rows = list(_rows(path))
    if not rows:
        raise wl.DataError(f"'{path}': holds no numbers, only comments; is the file complete?")
    first, width = rows[0][0], len(rows[0][1])
    for line, cells in rows:
        if len(cells) != width:
            cut = "; the file seems to be cut short there" if line == rows[-1][0] and len(cells) < width else ""
            raise wl.DataError(f"'{path}', line {line}: has {len(cells)} columns, but line {first} has {width}{cut}")
    lines = np.array([line for line, _ in rows])
    try:
        values = np.array([cells for _, cells in rows], dtype=np.float64)
    except ValueError:
        values = np.array([[_number(cell) for cell in cells] for _, cells in rows])
    possible = np.abs(values) <= HUGE
    if not possible.all():
        problems = []
        for row, column in np.argwhere(~possible):
            text = rows[row][1][column]
            what = f"exceeds {HUGE:g} in magnitude" if np.isfinite(values[row, column]) else "is no finite number"
            full = " (Fortran writes this if the number needs more room)" if "*" in text else ""
            problems.append(f"line {lines[row]}, column {column + 1}: '{text[:40]}' {what}{full}")
        raise wl.DataError(f"'{path}' is wrong in:", problems)
    return Table(path, values, lines)


def _rows(path: Path) -> list[tuple[int, list[str]]]:
    """Return the cells of the lines that are not comments, with the number of each line."""
    try:
        content = wl.read_file(path, LARGEST)
    except (FileNotFoundError, wl.InputError) as error:
        raise wl.DataError(f"cannot read '{path}': {getattr(error, 'strerror', None) or error}") from None
    if not content:
        raise wl.DataError(f"'{path}': is empty")
    for start, kind in OTHERS.items():
        if content.startswith(start):
            raise wl.DataError(f"'{path}': is {kind}, not a text file of CONTACT")
    if b"\0" in content or not content.isascii():
        raise wl.DataError(f"'{path}': is not plain text, as CONTACT writes it")
    lines = content.decode("ascii").splitlines()
    if not content.endswith((b"\n", b"\r")):
        raise wl.DataError(f"'{path}', line {len(lines)}: ends without a line break; the file is cut short there")
    cells = [(number, line.split()) for number, line in enumerate(lines, 1) if not line.lstrip().startswith("%")]
    return [(number, row) for number, row in cells if row]


def _number(text: str) -> float:
    """Return a number, or NaN for anything else."""
    found = NUMBER.fullmatch(text)
    if found is None:
        return math.nan
    digits, signed, plain = found.groups()
    return float(f"{digits}e{signed or plain or 0}")
