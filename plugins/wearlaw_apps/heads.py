"""Heads of columns, with the unit that they state."""

from __future__ import annotations

import re
from collections.abc import Sequence
from contextlib import suppress
from typing import NamedTuple

from wearlaw.errors import DataError, UnitError
from wearlaw.units.quantities import Q
from wearlaw.units.registry import symbol

_WORDS = r"[^\[\]\s]*+(?:\s++[^\[\]\s]++)*+"
HEAD = re.compile(rf"(?P<name>{_WORDS})\s*+(?:\[\s*+(?P<unit>{_WORDS})\s*+\])?")
"""The head of a column, as in "creepage [%]": a name and an optional unit; the time is linear in the length."""

OTHER_HEAD = re.compile(r"(?P<name>.*\S)(?:\s*\((?P<unit>[^()]+)\)|(?:,|\s/|\s+in)\s+(?P<behind>\S+))")
"""Other heads that state a unit, if it is known: "Load (N)", "Load, N", "F / N" and "Load in N"."""


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


def named_column(head: str, place: int) -> Column:
    """Return the column of a head; an unknown unit is kept as it is written."""
    match = HEAD.fullmatch(head)
    name, unit = (match["name"], match["unit"]) if match else (head, None)
    with suppress(UnitError):
        unit = unit and known(unit)
    if unit is None and (match := OTHER_HEAD.fullmatch(head)):
        with suppress(UnitError):
            name, unit = match["name"], known(match["unit"] or match["behind"])
    return Column(name, head, place, unit)


def agreed(name: str, wanted: Column, column: Column) -> str | None:
    """Return the unit that the user states for a column, or else that of the table, which must not be another one."""
    if wanted.unit is None:
        return column.unit
    try:
        unit = Q(1.0, wanted.unit)
    except UnitError as error:
        raise UnitError(f"{name}: column '{column.head}': {error}") from None
    if column.unit is not None and wanted.unit != column.unit:
        with suppress(UnitError):  # what the table states may be no unit
            if Q(1.0, column.unit) != unit:
                units = f"'{wanted.unit}' and '{column.unit}'"
                raise DataError(f"{name}: column '{column.head}': has the units {units}; keep one of them")
    return wanted.unit


def known(unit: str) -> str:
    """Return a unit in the notation of pint, "" for "-" and "1"."""
    return "" if unit.strip() in ("", "-", "1") else symbol(Q(1.0, unit).units, "~C")


def is_title(line: str, lines: Sequence[str]) -> bool:
    """Return whether a line has half of the cells of the last one at most, and stands above a line with more words."""
    rest = [row for row in lines[lines.index(line) + 1 :] if row.strip(_EMPTY)] if line in lines else []
    mark = next((mark for mark in ";\t|," if rest and mark in rest[-1].strip(_EMPTY)), "")
    if not mark:
        return False

    def width(row: str) -> int:
        return sum(bool(cell.strip(_EMPTY)) for cell in row.split(mark))

    most = width(rest[-1]) // 2
    return width(line) <= most and any(width(row) > most and any(map(str.isalpha, row)) for row in rest)


_EMPTY = "\"',; \t\r\n"
"""Characters of a line without content."""
