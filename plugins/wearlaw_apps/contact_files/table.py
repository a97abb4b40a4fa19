"""Tables of numbers as CONTACT writes them: comment lines that begin with %, and rows of one length."""

from __future__ import annotations

import io
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
from wearlaw.errors import DataError
from wearlaw_apps import tables

LARGEST = 256 * 2**20
"""Size of the largest file that is read [bytes]."""

LONGEST = 1000
"""Most characters of a row; CONTACT writes some 200."""

HUGE = 1e30
"""What no number of a contact exceeds in magnitude, in any unit."""

NUMBER = re.compile(r"([+-]?(?:\d+\.?\d*|\.\d+))(?:[eEdD]?([+-]\d+)|[eEdD](\d+))?", re.ASCII)
"""A number of Fortran; it drops the E before an exponent of three digits."""


@dataclass(frozen=True)
class Table:
    """The rows of a file."""

    path: Path
    values: Array
    """The numbers, (rows, columns)."""
    lines: NDArray[np.intp]
    """The line of each row."""

    def wrong(self, row: int, column: int, name: str, rule: str) -> NoReturn:
        """Raise an error for a number, by its row and column from 0."""
        got = f"{self.values[row, column]:g}"
        raise DataError(f"'{self.path}', line {self.lines[row]}, column {column + 1} ({name}): {rule}, got {got}")

    def whole(self, row: int, column: int, name: str, choices: Sequence[int] | range) -> int:
        """Return a whole number among those known, or raise an error."""
        value = self.values[row, column]
        if value not in choices:
            some = (
                f"from {choices[0]} to {choices[-1]}" if isinstance(choices, range) else " or ".join(map(str, choices))
            )
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
        If the file is none of CONTACT's, is cut short, has longer rows than CONTACT writes, or holds anything but
        finite numbers.
    """
    try:
        text = wl.read_file(path, LARGEST).decode("ascii")
    except (FileNotFoundError, wl.InputError) as error:
        raise DataError(f"cannot read '{path}': {getattr(error, 'strerror', None) or error}") from None
    except UnicodeDecodeError:
        raise DataError(f"'{path}': is not plain text, as CONTACT writes it") from None
    lines = text.splitlines()
    if not text.endswith(("\n", "\r")):
        raise DataError(f"'{path}', line {len(lines)}: ends without a line break; the file is cut short there")
    if too_long := [number for number, line in enumerate(lines, 1) if len(line) > LONGEST]:
        raise DataError(f"'{path}', line {too_long[0]}: is longer than any row of CONTACT; is it one of its files?")
    try:
        table = wl.read_table(io.StringIO(text), sep=" ", comment="%")
        values = np.column_stack([_numbers(table, name) for name in table.columns])
    except DataError as error:
        if not error.problems:
            raise DataError(f"'{path}': holds no numbers; is the file complete?") from None
        raise DataError(f"'{path}' is wrong in:", error.problems) from None
    if not values.size:
        raise DataError(f"'{path}': holds no numbers; is the file complete?")
    problems = []
    for row, column in np.argwhere(~(np.abs(values) <= HUGE)):
        cell = table.texts(str(column + 1))[row]
        what = f"exceeds {HUGE:g} in magnitude" if np.isfinite(values[row, column]) else "is no finite number"
        full = " (Fortran writes this if the number needs more room)" if "*" in cell else ""
        problems.append(f"line {table.lines[row]}, column {column + 1}: '{cell[:40] or 'NaN'}' {what}{full}")
    if problems:
        raise DataError(f"'{path}' is wrong in:", problems)
    return Table(path, values, table.lines)


def _numbers(table: tables.Table, name: str) -> Array:
    """Return a column, with NaN for what is no number."""
    try:
        return table.numbers(name)
    except DataError:  # Fortran's exponents, or worse
        return np.array([_number(cell) for cell in table.texts(name)])


def _number(text: str) -> float:
    """Return a number, or NaN for anything else."""
    match = NUMBER.fullmatch(text)
    if match is None:
        return math.nan
    digits, signed, plain = match.groups()
    return float(f"{digits}e{signed or plain or 0}")
