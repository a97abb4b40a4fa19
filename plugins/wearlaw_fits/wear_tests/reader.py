"""Reading wear tests from CSV, with errors by line and column."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from difflib import get_close_matches
from pathlib import Path
from typing import Any

import numpy as np
import pint

from wearlaw.arrays.array import Array
from wearlaw.errors import DataError, InputError, UnitError, did_you_mean, shown
from wearlaw.plugins import loader
from wearlaw.settings.arguments import expect_names
from wearlaw.settings.text_files import MIB, read_text
from wearlaw.tables import Column, CsvTable, Head
from wearlaw.units.quantities import Q
from wearlaw_fits.wear_tests.columns import COLUMNS, factor, faulty, faulty_columns, head, with_traction
from wearlaw_fits.wear_tests.tests import WearTests

LARGEST = 4 * MIB
"""Size of the largest file of tests that is read [bytes]."""

TEXTS = ("label", "comment")
"""Columns of text."""

WEAR_OF = "wear_rate"
"""The wear rate; behind it may follow the name of a body, as in "wear_rate_rail"."""


def read_tests(
    path_or_name: str | Path, *, outcomes: Collection[str] = (), sep: str | None = None, decimal: str = "."
) -> WearTests:
    """Read tests from a CSV file, or return shipped tests by their name.

    Parameters
    ----------
    path_or_name : str or Path
        Path of a CSV file with units in its header, such as ``creepage [%]``, or a name such as "lewis2004". Columns
        such as ``mass [kg]`` are other conditions of a rig, and columns such as ``heat_flux [W/mm^2]`` measured
        outcomes of laws.
    outcomes : collection of str, optional
        Names of columns that are outcomes of laws that no plugin provides. Without it, such a column must be complete.
    sep, decimal : str, optional
        What separates the cells, and the decimal mark, as in `read_table`.

    Raises
    ------
    DataError
        If there is no such file, or its contents are wrong. The message names all faults by line and column.
    UnknownModelError
        If several plugins ship tests of that name.
    """
    if isinstance(outcomes, str):
        raise DataError(f'outcomes: give a list of names, such as ["{outcomes}"]')
    outcomes = expect_names(outcomes, "outcomes", "rcf_damage", least=0)
    return parse_tests(text_of_tests(path_or_name), str(path_or_name), outcomes, sep, decimal)


def text_of_tests(path_or_name: str | Path) -> str:
    """Return the text of a CSV file, or of shipped tests by their name.

    Raises
    ------
    DataError
        If there is no such file and no such tests, or the file is not text.
    """
    found = loader.installed()
    if path_or_name in found.resources["test set"].providers:
        text: str = found.resources["test set"].find(str(path_or_name), found.broken)
        return text
    path = Path(path_or_name)
    try:
        return read_text(path, LARGEST)
    except FileNotFoundError:
        shipped = list(found.resources["test set"].items())
        beside = sorted(one.name for one in path.parent.glob("*.csv")) if path.parent.is_dir() else []
        hint = did_you_mean(path.name, [*beside, *shipped])
        raise DataError(f"there is no file {shown(path)}{hint} Shipped tests: {', '.join(shipped) or 'none'}") from None
    except InputError as error:
        raise DataError(f"cannot read the tests {shown(path)}: {error}") from None


def parse_tests(
    text: str, name: str, outcomes: Collection[str] = (), sep: str | None = None, decimal: str = "."
) -> WearTests:
    """Parse tests from a CSV text.

    Parameters
    ----------
    text : str
        The content of the file.
    name : str
        Its path, or its name if shipped; also the source of tests that state none.
    outcomes, sep, decimal
        As for `read_tests`.

    Raises
    ------
    DataError
        If the contents are wrong. The message names all faults.
    """
    label = f"the tests {shown(Path(name))}"
    table = CsvTable(label, text.encode(), sep, decimal)
    conditions = {name for rig in loader.rigs().values() for name in rig.conditions()}
    measured = {*outcomes, *(law.outcome.name for law in loader.laws().values())}
    wrong = _use_columns(table, conditions, measured)
    columns: dict[str, Array] = {}
    others: dict[str, pint.Quantity[Array] | Array] = {}
    try:
        lines = table.lines
        for column in table.columns.values():
            if column.name not in TEXTS:
                _add_column(table, column, columns, others, wrong)
    except DataError as error:  # rows of different lengths
        if not error.problems:
            raise
        raise DataError(f"{label} are wrong in:", [*wrong, *error.problems]) from None
    if not lines.size and not wrong:
        wrong.append("no test follows the header")
    every = columns | {name: np.asarray(getattr(value, "magnitude", value)) for name, value in others.items()}
    for row, name, rule in faulty(every, measured):
        cell = table.texts(name)[row]
        wrong.append(f"{table.where(row, name)}: {f'got {cell:.100}, which ' if cell else ''}{rule}")
    texts = {name: table.texts(name) for name in TEXTS if name in table.columns}
    wrong += [] if wrong else _duplicates([*every.values(), *texts.values()], lines.tolist())
    if wrong:
        raise DataError(f"{label} are wrong in:", wrong)
    source = next((one.partition(":")[2].strip() for one in table.comments if one.casefold().startswith("source:")), "")
    labels = texts.get("label", [""] * lines.size)
    tests = WearTests(with_traction(columns), tuple(labels), source or Path(name).name, others)
    return tests.measuring(measured)


def _use_columns(table: CsvTable, conditions: Collection[str], outcomes: Collection[str]) -> list[str]:
    """Take the columns of tests into use, and return the faults of the header."""
    wrong: list[str] = []
    present = [one.name for one in table.heads]
    missing = [name for name in (*COLUMNS, *TEXTS) if name not in present]
    for place, one in enumerate(table.heads):
        where = f"line {table.header}, column '{one.text}'"
        if present.count(one.name) > 1:
            wrong.append(f"{where}: is there more than once; keep one of them")
        if one.name in TEXTS and one.units:
            wrong.append(f"{where}: is text and takes no unit")
        elif one.name in COLUMNS and COLUMNS[one.name].unit and not one.units:
            wrong.append(f"{where}: has no unit; write it as '{head(one.name)}'")
        elif one.name not in (*COLUMNS, *TEXTS) and not _is_other(one, missing, {*conditions, *outcomes}):
            bracket = "; write the unit in square brackets" if "(" in one.name else ""
            wrong.append(
                f"{where}: unknown column{bracket}{did_you_mean(one.name, [*COLUMNS, *TEXTS])} The columns are:"
                f" {', '.join([*COLUMNS, *TEXTS])}; another condition of a rig has its unit in brackets, as in"
                " 'mass [kg]'"
            )
        else:
            table.columns |= {one.name: Column(one.name, one.text, place, next(iter(one.units), None))}
    meant = [near for one in present if one not in table.columns for near in get_close_matches(one, COLUMNS, n=1)]
    known = [name for name in (*table.columns, *meant) if name not in (*TEXTS, *outcomes)]
    others = [name for name in table.columns if name not in (*COLUMNS, *TEXTS)]
    measured = any(name in outcomes or name not in conditions for name in others)  # a law of a script may predict it
    return wrong + [f"line {table.header}: {fault}" for fault in faulty_columns(known, measured)]


def _is_other(one: Head, missing: Collection[str], known: Collection[str]) -> bool:
    """Return whether a column is a condition or an outcome that is not in the table of columns.

    It belongs to an installed rig or law, or has a unit and a name unlike those of missing columns.
    """
    if one.name.startswith(f"{WEAR_OF}_"):  # the wear rate of one body
        missing = [column for column in missing if column != WEAR_OF]
    unlike = bool(one.units) and not get_close_matches(one.name, missing, n=1)
    return one.name.isidentifier() and (one.name in known or unlike)


def _add_column(
    table: CsvTable,
    column: Column,
    columns: dict[str, Array],
    others: dict[str, pint.Quantity[Array] | Array],
    wrong: list[str],
) -> None:
    """Add the values of a column: to `columns` in SI, or to `others` in their own unit; note what is wrong."""
    try:
        values = table.numbers(column.name)
        unit = "" if column.unit in (None, "-") else str(column.unit)
        if column.name not in COLUMNS:
            others[column.name] = values if column.unit is None else Q(values, unit)
            return
        with np.errstate(over="ignore"):  # an overflow is reported as not finite
            columns[column.name] = values * factor(column.name, unit)
    except UnitError as error:
        wrong.append(f"line {table.header}, column '{column.head}': {error}")
    except DataError as error:
        wrong += error.problems


def _duplicates(columns: list[Any], lines: list[int]) -> list[str]:
    """Return the faults of rows that are equal in every column: a row pasted twice would count twice."""
    first: dict[tuple[str, ...], int] = {}
    rows = zip(*columns, strict=True)
    return [
        f"line {line}: is equal to line {earlier} in every column; leave it out, or label a repeated test"
        for line, values in zip(lines, rows, strict=True)
        if (earlier := first.setdefault(tuple(map(str, values)), line)) != line
    ]


def explain_tests(name: str, text: str) -> Iterator[str]:
    """Yield the lines of `wearlaw show` for a test set."""
    for line in text.splitlines():
        if line.startswith("#"):
            yield line.removeprefix("#").strip()
    tests = parse_tests(text, name)
    head, *_ = (line for line in text.splitlines() if not line.startswith("#"))
    yield from ("", f"tests: {len(tests)}", f"columns: {head}")
    yield from ("", f'In a case: measured = {{label = "Tests", tests = "{name}"}}. In Python: wl.read_tests("{name}").')
