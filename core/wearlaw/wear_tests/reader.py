"""Reading wear tests from CSV as spreadsheets write it, with errors by line and column."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Sequence
from pathlib import Path
from typing import NoReturn

import numpy as np

from wearlaw.arrays.array import Array
from wearlaw.errors import DataError, InputError, did_you_mean, excerpt, quoted, shortened
from wearlaw.plugins import loader
from wearlaw.settings.arguments import expect_names
from wearlaw.settings.csv_files import kind_of
from wearlaw.settings.text_files import MIB, UTF_16, decoded, read_file
from wearlaw.units.quantities import Q
from wearlaw.wear_tests.columns import faulty, with_traction
from wearlaw.wear_tests.csv_table import TEXTS, Head, Problems, Table, table_of
from wearlaw.wear_tests.tests import WearTests

LARGEST = 4 * MIB
"""Size of the largest file of tests that is read [bytes]."""

MISSING = ("", "na", "n/a", "nan", "-")
"""Contents of a cell without a value, in upper or lower case."""

_NUMBER = re.compile(r"[+\-\u2212]?(\d+([.,]\d*)?|[.,]\d+)([eE][+-]?\d+)?", re.ASCII)


def read_tests(path_or_name: str | Path, *, outcomes: Collection[str] = ()) -> WearTests:
    """Read tests from a CSV file, or return shipped tests by their name.

    Parameters
    ----------
    path_or_name : str or Path
        Path of a CSV file with units in its header, such as ``creepage [%]``, or a name such as "lewis2004". Columns
        such as ``mass [kg]`` are other conditions of a rig, and columns such as ``heat_flux [W/mm^2]`` measured
        outcomes of laws.
    outcomes : collection of str, optional
        Names of columns that are outcomes of laws that no plugin provides. Without it, such a column must be complete.

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
    return parse_tests(text_of_tests(path_or_name), str(path_or_name), outcomes)


def text_of_tests(path_or_name: str | Path) -> str:
    """Return the text of a CSV file, or of shipped tests by their name.

    Raises
    ------
    DataError
        If there is no such file and no such tests, or the file is not text.
    """
    found = loader.installed()
    if path_or_name in found.test_sets.providers:
        return found.test_sets.find(str(path_or_name), found.broken)
    path = Path(path_or_name)
    try:
        content = read_file(path, LARGEST)
    except FileNotFoundError:
        _refuse_missing(path, list(found.test_sets.items()))
    except InputError as error:
        raise DataError(f"cannot read the tests {quoted(path)}: {error}") from None
    return _decoded(content, path)


def _refuse_missing(path: Path, shipped: list[str]) -> NoReturn:
    beside = sorted(one.name for one in path.parent.glob("*.csv")) if path.parent.is_dir() else []
    hint = did_you_mean(path.name, [*beside, *shipped])
    raise DataError(f"there is no file {quoted(path)}{hint} Shipped tests: {', '.join(shipped) or 'none'}")


def _decoded(content: bytes, path: Path) -> str:
    """Decode UTF-8, UTF-16 with its mark, or else the code page of old spreadsheets."""
    kind = kind_of(content)
    if kind is None and b"\0" in content and not content.startswith(UTF_16):
        kind = "no text"
    if kind is not None:
        raise DataError(f"cannot read the tests {quoted(path)}: it is {kind}; save it as CSV and give that file")
    try:
        return decoded(content, otherwise="cp1252")
    except UnicodeDecodeError:
        raise DataError(
            f"cannot read the tests {quoted(path)}: it is not text in UTF-8; save it as CSV in UTF-8"
        ) from None


def parse_tests(text: str, name: str, outcomes: Collection[str] = ()) -> WearTests:
    """Parse tests from a CSV text.

    Parameters
    ----------
    text : str
        The content of the file.
    name : str
        Its path, or its name if shipped; also the source of tests that state none.
    outcomes : collection of str, optional
        As for `read_tests`.

    Raises
    ------
    DataError
        If the contents are wrong. The message names all faults.
    """
    wrong = Problems()
    measured = {*outcomes, *_outcomes()}
    table = table_of(text, name, wrong, _conditions(), measured)
    columns = {one.name: _values(one, table, wrong) for one in table.heads if one.is_numbers}
    texts = {one.name: [row.cells[one.place].strip() for row in table.rows] for one in table.heads if one.name in TEXTS}
    _check_values(columns, table, measured, wrong)
    _check_decimal_marks(table, wrong)
    if not wrong.found:
        _check_duplicates([*columns.values(), *texts.values()], table, wrong)
    if wrong.found:
        raise DataError(f"the tests {quoted(Path(name))} are wrong in:", wrong.texts())
    labels = texts.get("label", [""] * len(table.rows))
    others = {
        one.name: columns[one.name] if one.unit is None else Q(columns[one.name], one.unit)
        for one in table.heads
        if one.is_other
    }
    tests = WearTests(with_traction(columns), tuple(labels), table.source or Path(name).name, others)
    return tests.measuring(measured)


def _conditions() -> set[str]:
    """Return the conditions of the installed rigs."""
    return {name for rig in loader.rigs().values() for name in rig.conditions()}


def _outcomes() -> set[str]:
    """Return the outcomes of the installed laws."""
    return {law.outcome.name for law in loader.laws().values()}


def _values(one: Head, table: Table, wrong: Problems) -> Array:
    """Return a column in SI, with NaN for missing or wrong cells."""
    numbers = [_number(row.line, row.cells[one.place].strip(), one, table.separator, wrong) for row in table.rows]
    with np.errstate(over="ignore"):  # an overflow is reported as not finite
        return np.array(numbers, dtype=np.float64) * one.factor


def _number(line: int, text: str, one: Head, separator: str, wrong: Problems) -> float:
    if text.casefold() in MISSING:
        return np.nan
    if not _NUMBER.fullmatch(text):
        hint = "; the unit goes into the header" if _NUMBER.match(text) else ""
        wrong.add(line, one.text, f"{shortened(text)} is not a number{hint}")
    elif separator == "," and "," in text:
        wrong.add(line, one.text, f"{quoted(text)} has a decimal comma; write a point, or separate cells by ';'")
    else:
        return float(text.replace(",", ".").replace("\u2212", "-"))
    return np.nan


def _check_values(columns: dict[str, Array], table: Table, outcomes: Collection[str], wrong: Problems) -> None:
    """Note missing and impossible values in the columns with a valid unit."""
    heads = {one.name: one for one in table.heads if not np.isnan(one.factor)}
    for i, name, rule in faulty({name: values for name, values in columns.items() if name in heads}, outcomes):
        row = table.rows[i]
        text = row.cells[heads[name].place].strip()
        got = "" if text.casefold() in MISSING else f"got {excerpt(text)}, which "
        wrong.add(row.line, heads[name].text, f"{got}{rule}")


def _check_decimal_marks(table: Table, wrong: Problems) -> None:
    """Note a mix of decimal commas and points: one of them may separate thousands."""
    first: dict[str, int] = {}
    for row in table.rows:
        for one in table.heads:
            text = row.cells[one.place].strip()
            if one.is_numbers and _NUMBER.fullmatch(text):
                for mark in set(text) & {",", "."}:
                    first.setdefault(mark, row.line)
    if len(first) == 2 and table.separator != ",":
        wrong.add(
            max(first.values()),
            "",
            f"decimal marks are mixed: a comma in line {first[',']}, a point in line {first['.']}; use one of them",
        )


def _check_duplicates(columns: Sequence[Iterable[object]], table: Table, wrong: Problems) -> None:
    """Note rows that are equal in every column: a row pasted twice would count twice."""
    first: dict[tuple[str, ...], int] = {}
    for row, values in zip(table.rows, zip(*columns, strict=True), strict=True):
        line = first.setdefault(tuple(map(str, values)), row.line)
        if line != row.line:
            wrong.add(row.line, "", f"is equal to line {line} in every column; leave it out, or label a repeated test")
