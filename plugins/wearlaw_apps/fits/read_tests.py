"""Reading wear tests from tables, with errors by line and column."""

from __future__ import annotations

import io
import os
from collections.abc import Collection, Iterator
from difflib import get_close_matches
from pathlib import Path
from typing import TYPE_CHECKING

import wearlaw as wl
from wearlaw import loader
from wearlaw.errors import DataError, InputError, UnitError, did_you_mean, shown
from wearlaw.models.model import CONDITIONS
from wearlaw.text_files import read_text
from wearlaw_apps.fits.wear_tests import COLUMNS, Values, WearTests
from wearlaw_apps.output.datasets import names_in
from wearlaw_apps.tables import Table

if TYPE_CHECKING:
    import pandas as pd

LARGEST = 2**22
"""Size of the largest file of tests that is read [bytes]."""

TEXTS = ("label", "comment")
"""Columns of text."""


def read_tests(
    source: str | os.PathLike[str] | pd.DataFrame,
    *,
    outcomes: Collection[str] = (),
    sep: str | None = None,
    decimal: str = ".",
) -> WearTests:
    """Read tests from a table, or return shipped tests by their name.

    Parameters
    ----------
    source : path, str or pandas.DataFrame
        A CSV file with units in its header, such as ``creepage [%]``, or any table that `read_table` takes; or the name
        of shipped tests, such as "lewis2004". Columns such as ``mass [kg]`` are other conditions of a rig, and columns
        such as ``heat_flux [W/mm^2]`` measured outcomes of laws.
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
    outcomes = names_in(outcomes, "outcomes")
    if isinstance(source, str | os.PathLike):
        return parse_tests(text_of_tests(source), str(source), outcomes, sep, decimal)
    return _checked(wl.read_table(source, sep=sep, decimal=decimal), "a table", outcomes)


def text_of_tests(path_or_name: str | os.PathLike[str]) -> str:
    """Return the text of a CSV file, or of shipped tests by their name."""
    plugins = loader.discovered()
    if path_or_name in plugins["test set"]:
        text: str = plugins.find("test set", str(path_or_name))
        return text
    path = Path(path_or_name)
    try:
        return read_text(path, LARGEST)
    except FileNotFoundError:
        shipped = list(plugins["test set"].items())
        beside = sorted(file.name for file in path.parent.glob("*.csv")) if path.parent.is_dir() else []
        hint = did_you_mean(path.name, [*beside, *shipped])
        raise DataError(f"there is no file {shown(path)}{hint} Shipped tests: {', '.join(shipped) or 'none'}") from None
    except InputError as error:
        raise DataError(f"cannot read the tests {shown(path)}: {error}") from None


def parse_tests(
    text: str, name: str, outcomes: Collection[str] = (), sep: str | None = None, decimal: str = "."
) -> WearTests:
    """Return the tests of a CSV text; its `name` stands in errors, and for the source of tests that state none."""
    file = io.StringIO(text)
    file.name = name
    return _checked(wl.read_table(file, sep=sep, decimal=decimal), name, outcomes)


def _checked(table: Table, name: str, outcomes: Collection[str]) -> WearTests:
    """Return the tests of a table."""
    table.label = f"the tests {shown(Path(name))}"
    conditions = {name for rig in loader.installed("rig").values() for name in rig.conditions()} | CONDITIONS
    measured = {*outcomes, *(law.outcome.name for law in loader.installed("law").values())}
    wrong = list(_unknown(table, {*conditions, *measured}))
    if wrong:
        raise DataError(f"{table.label} are wrong in:", wrong)
    columns: dict[str, Values] = {}
    for column in table.columns:
        try:
            if column not in TEXTS:
                columns[column] = table[column]
        except DataError as error:
            wrong += error.problems
        except UnitError as error:
            wrong.append(f"column '{table.columns[column].head}': {error}")
    if wrong:
        raise DataError(f"{table.label} are wrong in:", wrong)
    texts = {name: table.texts(name) for name in TEXTS if name in table.columns}
    count = len(next(iter(columns.values()), ()))
    if not count:
        raise DataError(f"{table.label}: no test follows the header")
    source = next(
        (comment.partition(":")[2].strip() for comment in table.comments if comment.casefold().startswith("source:")),
        "",
    )
    return WearTests.checked(
        columns,
        texts.get("label", [""] * count),
        source or Path(name).name,
        measured,
        table.label,
        lambda column, row: table.where(row, column),
    )


def _unknown(table: Table, names: Collection[str]) -> Iterator[str]:
    """Yield what is wrong with columns that are neither of tests nor conditions or outcomes of installed rigs or laws.

    Another condition of a rig has a unit, and a name unlike those of missing columns.
    """
    missing = [name for name in (*COLUMNS, *TEXTS) if name not in table.columns]
    unknown = []
    for column in table.columns.values():
        if column.name in (*COLUMNS, *TEXTS, *names):
            continue
        of_body = column.name.startswith("wear_rate_")  # the wear rate of one body
        alike = [name for name in missing if not (of_body and name == "wear_rate")]
        if column.unit is None or get_close_matches(column.name, alike, n=1):
            unknown.append(column)
            yield f"column '{column.head}': unknown column{did_you_mean(column.name, [*COLUMNS, *TEXTS])}"
    if unknown:
        heads = ", ".join(f"{name} [{spec.unit}]" if spec.unit else name for name, spec in COLUMNS.items())
        yield (
            f"the columns are {heads}, {', '.join(TEXTS)}, in any unit; another condition of a rig has its unit in"
            " square brackets, as in 'mass [kg]'"
        )


def explain_tests(name: str, text: str) -> Iterator[str]:
    """Yield the lines of `wearlaw show` for a test set."""
    for line in text.splitlines():
        if line.startswith("#"):
            yield line.removeprefix("#").strip()
    tests = parse_tests(text, name)
    header, *_ = (line for line in text.splitlines() if not line.startswith("#"))
    yield from ("", f"tests: {len(tests)}", f"columns: {header}")
    yield from ("", f'In a case: measured = {{label = "Tests", tests = "{name}"}}. In Python: wl.read_tests("{name}").')
