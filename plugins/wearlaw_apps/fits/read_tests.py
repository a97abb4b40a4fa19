"""Reading wear tests from tables, with errors by line and column."""

from __future__ import annotations

import io
import os
import re
from collections.abc import Collection, Iterator, Mapping
from difflib import get_close_matches
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from wearlaw import loader
from wearlaw.errors import DataError, InputError, UnitError, did_you_mean, shown
from wearlaw.models.model import CONDITIONS
from wearlaw.text_files import read_text
from wearlaw.units.quantities import Q, QuantityLike, parse
from wearlaw_apps.fits.wear_tests import BALANCE, COLUMNS, ROLLED, WAYS, Values, WearTests, is_way
from wearlaw_apps.heads import Column
from wearlaw_apps.output.datasets import names_in
from wearlaw_apps.tables import Table, is_spreadsheet, open_table

if TYPE_CHECKING:
    import pandas as pd

LARGEST = 2**22
"""Size of the largest file of tests that is read [bytes]."""

TEXTS = ("label", "comment")
"""Columns of text."""


Source: TypeAlias = "str | os.PathLike[str] | pd.DataFrame"
"""A file of tests, the name of shipped tests, or a table."""

Columns: TypeAlias = "Mapping[str, str] | None"
"""Columns of a table by the names that they get, as in {"normal_force": "Load (N)"}."""

OTHER_NAMES = {
    "slip": "creepage",
    "slip ratio": "creepage",
    "slippage": "creepage",
    "load": "normal_force",
    "force": "normal_force",
    "pressure": "max_pressure",
    "p0": "max_pressure",
    "mu": "friction_coefficient",
    "cof": "friction_coefficient",
    "friction": "friction_coefficient",
    "traction": "traction_coefficient",
    "weight loss": "mass_loss",
    "wear": "wear_rate",
    "revs": "revolutions",
    "time": "duration",
    "test": "label",
    "run": "label",
    "specimen": "label",
    "test no.": "label",
}
"""What labs call columns, for suggestions."""

BY_UNIT = {"creepage": ("%",), "normal_force": ("kN", "N"), "mass_loss": ("mg", "g")}
"""Columns that are suggested for heads in these units, whatever their language."""


def read_tests(
    source: Source | io.StringIO,
    *,
    columns: Columns = None,
    outcomes: Collection[str] = (),
    sep: str | None = None,
    decimal: str = ".",
    sheet: str | None = None,
    balance_resolution: QuantityLike | None = None,
) -> WearTests:
    """Read tests from a table, or return shipped tests by their name.

    Parameters
    ----------
    source : path, str or pandas.DataFrame
        A CSV file with units in its header, such as ``creepage [%]``, or any table that `read_table` takes; or the name
        of shipped tests, such as "lewis2004". Columns such as ``mass [kg]`` are other conditions of a rig, and columns
        such as ``heat_flux [W/mm^2]`` measured outcomes of laws.
    columns : mapping of str to str, optional
        Columns by the names that they get, as in {"normal_force": "Load (N)", "creepage": "Slip [%]"}; state the unit
        in brackets if the table does not. Columns that have such names already stay, and all others are left out.
    outcomes : collection of str, optional
        Names of columns that are outcomes of laws that no plugin provides. Without it, such a column must be complete.
    sep, decimal : str, optional
        What separates the cells, and the decimal mark, as in `read_table`.
    sheet : str, optional
        The sheet of a spreadsheet by its name. Default: the only one that has cells.
    balance_resolution : Quantity or str, optional
        Smallest step of the balance [kg], from which the standard uncertainty of `mass_loss` follows.

    Raises
    ------
    DataError
        If there is no such file, or its contents are wrong. The message names all faults by line and column.
    UnknownModelError
        If several plugins ship tests of that name.
    """
    if isinstance(source, str | os.PathLike) and not is_spreadsheet(source):
        source = _text_file(text_of_tests(source), str(source))
    of_file = str(source) if isinstance(source, str | os.PathLike) else "a table"
    name = source.name if isinstance(source, io.StringIO) else of_file
    table = open_table(source, sep=sep, decimal=decimal, sheet=sheet)
    table.label = f"the tests {shown(Path(name))}"
    conditions = {name for rig in loader.installed("rig").values() for name in rig.conditions()} | CONDITIONS
    measured = {*names_in(outcomes, "outcomes"), *(law.outcome.name for law in loader.installed("law").values())}
    names = {*COLUMNS, *TEXTS, *conditions, *measured}
    table.columns, wrong = _chosen(table, names, columns)
    wrong += _unknown(table, {*conditions, *measured}) if columns is None else []
    if wrong:
        raise DataError(f"{table.label} are wrong in:", wrong)
    raw = _values_of(table)
    count = len(next(iter(raw.values()), ()))
    if not count:
        raise DataError(f"{table.label}: no test follows the header")
    if balance_resolution is not None:
        step = parse(balance_resolution)
        raw[BALANCE.name] = Q(np.full(count, float(step.magnitude)), str(step.units))
    texts = {name: table.texts(name) for name in TEXTS if name in table.columns}
    stated = next(
        (comment.partition(":")[2].strip() for comment in table.comments if comment.casefold().startswith("source:")),
        "",
    )
    return WearTests.checked(
        raw,
        texts.get("label", [""] * count),
        stated or Path(name).name,
        measured,
        table.label,
        lambda column, row: table.where(row, column),
    )


def tests_of(tests: WearTests | Source, columns: Columns) -> WearTests:
    """Return the argument `tests` of a function, which may be anything that `read_tests` reads."""
    if not isinstance(tests, WearTests):
        if isinstance(tests, str | os.PathLike) or hasattr(tests, "to_numpy"):
            return read_tests(tests, columns=columns)
        raise InputError(
            f"tests: must be wearlaw_apps.fits.WearTests, as from wl.read_tests, or a table; got {shown(tests)}"
        )
    if columns is not None:
        raise InputError("columns: the tests are read already; give columns to wl.read_tests")
    return tests


def text_of_tests(path_or_name: str | os.PathLike[str]) -> str:
    """Return the text of a CSV file, or of shipped tests by their name."""
    plugins = loader.discovered()
    if path_or_name in plugins["test set"]:
        text: str = plugins.find("test set", str(path_or_name))
        return text
    path = Path(path_or_name)
    try:
        return read_text(path, LARGEST, of_windows=True)
    except FileNotFoundError:
        shipped = list(plugins["test set"].items())
        beside = sorted(file.name for file in path.parent.glob("*.csv")) if path.parent.is_dir() else []
        hint = did_you_mean(path.name, [*beside, *shipped])
        raise DataError(f"there is no file {shown(path)}{hint} Shipped tests: {', '.join(shipped) or 'none'}") from None
    except InputError as error:
        raise DataError(f"cannot read the tests {shown(path)}: {error}") from None


def _text_file(text: str, name: str) -> io.StringIO:
    file = io.StringIO(text)
    file.name = name
    return file


def _values_of(table: Table) -> dict[str, Values]:
    """Return the columns of numbers with their units, or raise an error that names all faults."""
    raw: dict[str, Values] = {}
    wrong: list[str] = []
    for column in table.columns:
        try:
            if column not in TEXTS:
                raw[column] = table[column]
        except DataError as error:
            wrong += [problem for problem in error.problems if problem not in wrong]
        except UnitError as error:
            spec, head = COLUMNS.get(column), table.columns[column].head
            unit = (spec.unit if spec else "") or "-"
            plain = head.partition("[")[0].strip()
            wrong.append(
                f"column '{head}': {error}; convert it, or state its unit by columns, as in '{plain} [{unit}]'"
            )
    if wrong:
        raise DataError(f"{table.label} are wrong in:", wrong)
    return raw


def _chosen(table: Table, names: Collection[str], columns: Columns) -> tuple[dict[str, Column], list[str]]:
    """Return the columns to use by name, and what is wrong with them.

    Beside `columns` these are all that have the name of a column of tests, in any case, with blanks or underscores;
    without `columns` all.
    """
    selected, wrong = ({}, []) if columns is None else (table.select(columns), [])
    taken = {column.place for column in selected.values()}
    for column in table.heads:
        if column.place in taken:
            continue
        plain = re.sub(r"[\s-]+", "_", column.name).casefold()
        name = plain if plain in names or is_way(plain) else column.name
        if columns is not None and (name in selected or not (name in names or is_way(name))):
            continue
        if name in selected:
            wrong.append(f"{name} is given twice, by '{selected[name].head}' and '{column.head}'")
        selected[name] = column._replace(name=name)
    return selected, wrong


def _unknown(table: Table, names: Collection[str]) -> Iterator[str]:
    """Yield what is wrong with columns that are neither of tests nor conditions or outcomes of installed rigs or laws.

    Another condition of a rig has a unit, and a name unlike those of missing columns.
    """
    missing = [name for name in (*COLUMNS, *TEXTS) if name not in table.columns]
    close_alone = (*WAYS, *ROLLED, BALANCE.name)  # a mass is no mass_loss
    near, nearer = ([name for name in missing if (name in close_alone) == close] for close in (False, True))
    unknown: list[Column] = []
    likely: dict[str, str] = {}
    for column in table.columns.values():
        if column.name in (*COLUMNS, *TEXTS, *names) or is_way(column.name):
            continue
        of_body = column.name.startswith("wear_rate_")  # the wear rate of one body
        alike = [name for name in near if not (of_body and name == "wear_rate")]
        words = column.name.casefold().replace("_", " ").rstrip(" %")
        other = "mass_loss" if words == "wear" and column.unit in BY_UNIT["mass_loss"] else OTHER_NAMES.get(words)
        close = get_close_matches(column.name, alike, n=1) or get_close_matches(column.name, nearer, n=1, cutoff=0.8)
        name = next((name for name in (other, *close) if name in missing), "")
        if column.unit is None or name:
            unknown.append(column)
            name = name or next(iter(get_close_matches(words.replace(" ", "_"), missing, n=1)), "")
            if name:
                likely.setdefault(name, column.head)
            meant = f"; did you mean '{name}'?" if name else ""
            yield f"column '{column.head}': unknown column{meant}"
    if unknown and table.heads[1:] and all(re.fullmatch(r"[\d.,]+", column.name) for column in table.heads[1:]):
        yield "the heads are numbers; turn the table, so that each test has a row"
    for name, units in BY_UNIT.items() if unknown and not likely.keys() >= BY_UNIT.keys() else ():
        fitting = [column for column in table.columns.values() if column.unit in units and column not in unknown]
        if fitting and name in missing and fitting[0].name not in names:
            likely.setdefault(name, fitting[0].head)
    if unknown:
        heads = ", ".join(f"{name} [{spec.unit}]" if spec.unit else name for name, spec in COLUMNS.items())
        likely = likely or ({"creepage": "HEAD"} if "creepage" in missing else {})
        in_python = ", ".join(f'"{name}": "{column}"' for name, column in likely.items())
        options = " ".join(f'--columns {name}="{column}"' for name, column in likely.items())
        yield (
            f"say which column is which by columns={{{in_python}}}, on the command line by"
            f" {options or '--columns NAME=HEAD'}; others are then left out"
        )
        yield (
            f"the columns are {heads}, {', '.join(TEXTS)}, in any unit; another condition of a rig has its unit in"
            " square brackets, as in 'mass [kg]'"
        )


def explain_tests(name: str, text: str) -> Iterator[str]:
    """Yield the lines of `wearlaw show` for a test set."""
    for line in text.splitlines():
        if line.startswith("#"):
            yield line.removeprefix("#").strip()
    tests = read_tests(_text_file(text, name))
    header, *_ = (line for line in text.splitlines() if not line.startswith("#"))
    yield from ("", f"tests: {len(tests)}", f"columns: {header}")
    yield from ("", f'In a case: measured = {{label = "Tests", tests = "{name}"}}. In Python: wl.read_tests("{name}").')
