"""Parsing CSV files as spreadsheets write them: header, separator and rows with their line numbers."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Collection
from dataclasses import dataclass, field
from difflib import get_close_matches
from pathlib import Path
from typing import NamedTuple

import numpy as np

from wearlaw.errors import DataError, UnitError, did_you_mean, quoted
from wearlaw.settings.csv_files import Row, preamble, rows
from wearlaw.units.quantities import HEAD, Q
from wearlaw.units.registry import symbol
from wearlaw.wear_tests.columns import COLUMNS, factor, faulty_columns, head

TEXTS = ("label", "comment")
"""Columns of text."""

WEAR_OF = "wear_rate"
"""The wear rate; behind it may follow the name of a body, as in "wear_rate_rail"."""


class Head(NamedTuple):
    """One column of a file.

    Attributes
    ----------
    text : str
        The head as written.
    place : int
        Index from the left.
    name : str
        The name of the column, "" if unknown.
    factor : float
        The factor from its unit to SI, NaN if the unit is wrong or missing. 1 for other conditions of a rig, which keep
        their unit.
    unit : str or None
        The unit of such a condition; None for plain numbers.
    """

    text: str
    place: int
    name: str
    factor: float
    unit: str | None = None

    @property
    def is_other(self) -> bool:
        """Whether it is a condition that is not in the table of columns."""
        return self.name not in ("", *COLUMNS, *TEXTS)

    @property
    def is_numbers(self) -> bool:
        """Whether it is a known column of numbers."""
        return self.name not in ("", *TEXTS)


class Table(NamedTuple):
    """The contents of a file."""

    source: str
    separator: str
    heads: list[Head]
    rows: list[Row]


LISTED = 3
"""Number of lines with the same fault up to which each is listed."""


@dataclass
class Problems:
    """Collects the faults of a file, each with its line."""

    found: list[tuple[int, str, str]] = field(default_factory=list)
    """Line, place in it and message of each fault."""
    cells: set[tuple[int, str]] = field(default_factory=set)
    """Line and column of the cells that already have a fault."""

    def add(self, line: int, column: str, message: str) -> None:
        """Add a fault, unless its cell already has one."""
        if not column or (line, column) not in self.cells:
            self.cells.add((line, column))
            self.found.append((line, f", column {quoted(column)}" if column else "", message))

    def texts(self) -> list[str]:
        """Return all faults in the order of the file, one for many lines that are wrong in the same way."""
        lines: dict[tuple[str, str], list[int]] = {}
        for line, place, message in sorted(self.found, key=lambda one: one[0]):
            lines.setdefault((place, message), []).append(line)
        found = []
        for (place, message), those in lines.items():
            if len(those) > LISTED:
                found.append(
                    (those[0], f"line {those[0]} (and {len(those) - 1} more, up to line {those[-1]}){place}: {message}")
                )
            else:
                found += [(line, f"line {line}{place}: {message}") for line in those]
        return [text for _, text in sorted(found, key=lambda one: one[0])]


def table_of(
    text: str, name: str, wrong: Problems, conditions: Collection[str] = (), outcomes: Collection[str] = ()
) -> Table:
    """Return the header and the rows with a cell for each column, and note the faults of others.

    `conditions` are those of the installed rigs, and `outcomes` those of the installed laws.
    """
    lines = io.StringIO(text, newline=None).readlines()
    source, separator, start = preamble(lines)
    try:
        found = [] if start is None else list(rows(lines[start:], start, separator))
    except csv.Error as error:
        raise DataError(f"the tests {quoted(Path(name))} cannot be read as CSV: {error}") from None
    if not found:
        raise DataError(
            f"the tests {quoted(Path(name))} are empty; begin with a header such as: {head('creepage')}, ..."
        )
    heads = _heads(found[0], wrong, conditions, outcomes)
    if not any(one.name for one in heads):
        known = ", ".join([*map(head, COLUMNS), *TEXTS])
        raise DataError(
            f"the tests {quoted(Path(name))} are wrong in:",
            [f"line {found[0].line}: is not a header; the columns are: {known}"],
        )
    table = Table(source, separator, heads, [])
    table.rows.extend(row for row in found[1:] if any(map(str.strip, row.cells)) and _fits(row, table, wrong))
    if not table.rows and not wrong.found:
        wrong.add(found[0].line, "", "no test follows the header")
    return table


def _heads(header: Row, wrong: Problems, conditions: Collection[str], outcomes: Collection[str]) -> list[Head]:
    """Return the columns, and note faults of single ones and of their combination."""
    texts = [cell.strip() for cell in header.cells]
    while texts and not texts[-1]:
        texts.pop()
    present = {_bare(text) for text in texts}
    heads = [
        _other(header.line, text, place, present, {*conditions, *outcomes}, wrong)
        or Head(text, place, *_meaning(header.line, text, place, wrong))
        for place, text in enumerate(texts)
    ]
    names = [one.name for one in heads if one.name]
    for one in heads:
        if names.count(one.name) > 1:
            wrong.add(header.line, one.text, "is there more than once; keep one of them")
    meant = [name for one in heads if not one.name for name in get_close_matches(_bare(one.text), COLUMNS, n=1)]
    others = [one.name for one in heads if one.is_other]
    measured = any(name in outcomes or name not in conditions for name in others)  # a law of a script may predict it
    known = [name for name in (*names, *meant) if name not in (*TEXTS, *outcomes)]
    for fault in faulty_columns(known, measured):
        wrong.add(header.line, "", fault)
    return heads


def _other(
    line: int, text: str, place: int, present: Collection[str], known: Collection[str], wrong: Problems
) -> Head | None:
    """Return a column of a condition or outcome that is not in the table of columns, or None if it is not one.

    It belongs to an installed rig or law, or has a unit and a name unlike those of missing columns.
    """
    match = HEAD.fullmatch(text)
    name, unit = (match["name"], match["unit"]) if match else ("", None)
    if name in (*COLUMNS, *TEXTS) or not name.isidentifier():
        return None
    missing = [column for column in (*COLUMNS, *TEXTS) if column not in present]
    if name.startswith(f"{WEAR_OF}_"):  # the wear rate of one body
        missing = [column for column in missing if column != WEAR_OF]
    if name not in known and (unit is None or get_close_matches(name, missing, n=1)):
        return None
    if unit is None:
        return Head(text, place, name, 1.0)
    try:
        return Head(text, place, name, 1.0, symbol(Q(1.0, "" if unit == "-" else unit).units, "~C"))
    except UnitError as error:
        wrong.add(line, text, str(error))
        return Head(text, place, name, np.nan)


def _bare(text: str) -> str:
    """Return the head of a column without its unit, in any brackets."""
    return re.split(r"[\[(]", text)[0].strip()


def _meaning(line: int, text: str, place: int, wrong: Problems) -> tuple[str, float]:
    """Return the name of a column, "" if unknown, and the factor from its unit to SI, NaN if wrong."""
    match = HEAD.fullmatch(text)
    name, unit = (match["name"], match["unit"]) if match else (text, None)
    if not text:
        wrong.add(line, "", f"the head of column {place + 1} is empty")
    elif name not in (*COLUMNS, *TEXTS):
        bracket = "; write the unit in square brackets" if "(" in name else ""
        known = [*COLUMNS, *TEXTS]
        hint = did_you_mean(_bare(text), known)
        other = "; another condition of a rig has its unit in brackets, as in 'mass [kg]'"
        wrong.add(line, text, f"unknown column{bracket}{hint} The columns are: {', '.join(known)}{other}")
    elif name in TEXTS:
        if unit is not None:
            wrong.add(line, text, "is text and takes no unit")
        return name, np.nan
    elif COLUMNS[name].unit and not unit:
        wrong.add(line, text, f"has no unit; write it as '{head(name)}'")
        return name, np.nan
    else:
        try:
            return name, factor(name, "" if unit in (None, "-") else str(unit))
        except UnitError as error:
            wrong.add(line, text, str(error))
        return name, np.nan
    return "", np.nan


def _fits(row: Row, table: Table, wrong: Problems) -> bool:
    """Return whether a row has a cell for each column, and only empty ones beyond."""
    expected, cells = len(table.heads), row.cells
    beyond = len("".join(cells[expected:]).strip()) > 0
    if len(cells) >= expected and not beyond:
        return True
    hint = ""
    if cells[0].startswith("#"):
        hint = "; comments go above the header"
    elif any("\n" in cell for cell in cells):
        hint = "; a quotation mark in it may have no partner"
    elif beyond and table.separator == ",":
        hint = "; with decimal commas, separate cells by ';'"
    wrong.add(row.line, "", f"has {len(cells)} cells, but the header has {expected}{hint}")
    return False
