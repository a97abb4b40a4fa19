"""Wear tests from CSV: every way in which spreadsheets write it is read."""

from __future__ import annotations

import csv
import io
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import wearlaw as wl
from tests.core.cases import TESTS_CSV, TESTS_HEAD
from tests.strategies import EPS
from wearlaw_fits.wear_tests.reader import parse_tests

# Round trip

UNITS = {
    "creepage": {"%": 1e-2, "-": 1.0, "1": 1.0, "permille": 1e-3, "ppm": 1e-6},
    "normal_force": {"N": 1.0, "kN": 1e3, "MN": 1e6},
    "normal_force_per_width": {"N/m": 1.0, "kN/m": 1e3, "N/mm": 1e3, "kN/mm": 1e6},
    "max_pressure": {"Pa": 1.0, "MPa": 1e6, "GPa": 1e9, "N/mm²": 1e6, "N/mm^2": 1e6, "N / mm**2": 1e6},
    "friction_coefficient": {"": 1.0, "-": 1.0, "%": 1e-2},
    "traction_coefficient": {"": 1.0, "-": 1.0},
    "wear_rate": {
        "ug/m/mm^2": 1e-3,
        "µg/m/mm²": 1e-3,  # the micro sign, which code page 1252 has too
        "ug/(m mm^2)": 1e-3,
        "mg/km/mm^2": 1e-3,
        "mg/m/cm^2": 1e-2,
        "kg/m^3": 1.0,
    },
    "wear_rate_uncertainty": {"ug/m/mm^2": 1e-3, "mg/m/mm²": 1.0},
}
"""Units as text, each with its factor to SI, worked out by hand."""

MISSING = ["", "NA", "n/a", "NaN", "nan", "-", "N/A", "  "]
LINE = st.text(st.characters(codec="utf-8", exclude_characters="\r\n", exclude_categories=["Cc"]), max_size=12)
"""Text of one line."""


@dataclass
class File:
    """A table of tests, the bytes of its file, and what must be read from it."""

    content: bytes
    decimal: str
    columns: dict[str, np.ndarray]
    labels: tuple[str, ...]
    source: str


def numbers(name: str, factor: float) -> st.SearchStrategy[float]:
    """Return numbers that a column may hold in its unit, zero and negative ones where they may be."""
    positive = st.floats(1e-6, 0.99) if name == "creepage" else st.floats(1e-6, 1e6)
    value = positive.map(lambda si: float(f"{si / factor:.6g}"))
    if name == "creepage":
        return value | value.map(lambda number: -number) | st.just(0.0)
    return value | st.just(0.0) if name == "wear_rate" else value


@st.composite
def files(draw: st.DrawFn) -> File:
    loads = ["normal_force", "normal_force_per_width", "max_pressure"]
    names = ["creepage", draw(st.sampled_from(loads)), "wear_rate"]
    names += [name for name in ("friction_coefficient", "traction_coefficient", "wear_rate_uncertainty") if draw(BOOL)]
    count = draw(st.integers(1, 5))
    separator, mark = draw(st.sampled_from([(",", "."), (";", "."), (";", ","), ("\t", "."), ("\t", ",")]))
    heads, columns, si = [], [], {}
    for name in names:
        unit = draw(st.sampled_from(sorted(UNITS[name])))
        factor = UNITS[name][unit]
        gaps = name in ("traction_coefficient", "wear_rate", "wear_rate_uncertainty")
        values = [None if gaps and draw(BOOL) else draw(numbers(name, factor)) for _ in range(count)]
        heads.append(f"{name} [{unit}]" if unit else name)
        columns.append([draw(st.sampled_from(MISSING)) if v is None else repr(v).replace(".", mark) for v in values])
        si[name] = np.array([np.nan if value is None else value * factor for value in values])
    labels = [f"{number} {draw(LINE)}".strip() for number in range(count)]  # so that no two rows are equal
    order = draw(st.permutations(range(len(heads) + 1)))
    table = [[[*heads, "label"][place] for place in order]]
    table += [[[*cells, label][place] for place in order] for *cells, label in zip(*columns, labels, strict=True)]
    source = draw(st.sampled_from(["", "a lab, 2026; series B"]))
    return File(_written(draw, table, separator, source), mark, si, tuple(labels), source)


BOOL = st.booleans()


def _written(draw: st.DrawFn, table: list[list[str]], separator: str, source: str) -> bytes:
    """Return a table as one of the programs there are may write it."""
    width = len(table[0]) + draw(st.integers(0, 2))
    rows = [row + [""] * (width - len(row)) for row in table] + [[""] * width] * draw(st.integers(0, 2))
    text = io.StringIO()
    quoting: Any = draw(st.sampled_from([csv.QUOTE_MINIMAL, csv.QUOTE_ALL]))
    writer = csv.writer(text, delimiter=separator, quoting=quoting, lineterminator="\n")
    if source and draw(BOOL):
        writer.writerow([f"# source: {source}", *[""] * (width - 1)])  # as a spreadsheet keeps a comment
    elif source:
        text.write(f"# source: {source}\n# another comment\n\n")
    writer.writerows(rows)
    newline = draw(st.sampled_from(["\n", "\r\n"]))
    written = text.getvalue().replace("\n", newline)
    return written.encode(draw(st.sampled_from(["utf-8", "utf-8-sig", "utf-16"])))


@given(file=files())
def test_whatever_program_wrote_a_table_it_is_read_back(tmp_path_factory: pytest.TempPathFactory, file: File) -> None:
    path = tmp_path_factory.getbasetemp() / "round-trip.csv"
    path.write_bytes(file.content)
    tests = wl.read_tests(path, decimal=file.decimal)
    assert set(tests.columns) == set(file.columns)
    for name, values in file.columns.items():
        # The factor of a unit is a product of a few powers of ten, each rounded.
        np.testing.assert_allclose(tests.columns[name], values, rtol=8 * EPS, err_msg=name)
    assert tests.labels == file.labels
    assert tests.source == (file.source or "round-trip.csv")


# What is understood


def test_frictional_heat_and_force_become_traction() -> None:
    heat = parse_tests("creepage [%],normal_force [kN],frictional_heat [W],rolling_speed [km/h]\n-2,7.2,72,3.6\n", "t")
    force = parse_tests("creepage [%],normal_force [kN],tangential_force [kN]\n-2,7.2,3.6\n2,7.2,-\n", "t")
    # T = 72 W / (0.02 × 1 m/s) = 3.6 kN, half the load.
    np.testing.assert_allclose(heat.traction_coefficient.magnitude, [0.5], rtol=8 * EPS)
    np.testing.assert_allclose(force.traction_coefficient.magnitude, [0.5, np.nan], rtol=8 * EPS)
    assert list(heat.columns) == list(force.columns) == ["creepage", "normal_force", "traction_coefficient"]


def test_a_comment_column_is_passed_over_and_a_cell_may_span_lines() -> None:
    text = 'comment,creepage [%],normal_force [kN],wear_rate [ug/m/mm^2],label\n"two\nlines",1,7,3,"a, b"\n"",2,7,x,c\n'
    with pytest.raises(wl.DataError, match=r"line 4, column 'wear_rate \[ug/m/mm\^2\]': 'x' is not a number"):
        parse_tests(text, "t")
    tests = parse_tests(text.replace("x", "4"), "t")
    assert tests.labels == ("a, b", "c")
    assert set(tests.columns) == {"creepage", "normal_force", "wear_rate"}


def test_repeated_tests_with_other_results_or_labels_are_welcome() -> None:
    repeated = f"{TESTS_HEAD}\na,1,7.4,30\na,1,7.4,31\nb,1,7.4,30\n"
    assert parse_tests(repeated, "t").labels == ("a", "a", "b")
    assert len(parse_tests(f"{TESTS_HEAD.replace('label', 'comment')}\nmorning,1,7.4,30\nevening,1,7.4,30\n", "t")) == 2


def test_rows_that_cannot_be_read_are_not_taken_for_equal_ones() -> None:
    with pytest.raises(wl.DataError) as refusal:
        parse_tests(f"{TESTS_HEAD}\na,1,x,30\na,1,y,30\n", "t")
    assert [problem.split(":")[1] for problem in refusal.value.problems] == [
        " 'x' is not a number",
        " 'y' is not a number",
    ]


def test_the_first_source_of_several_is_not_lost_and_other_comments_are(tmp_path: Path) -> None:
    assert parse_tests(f"# about the rig\n#Source:  a lab \n# more: words\n{TESTS_CSV}", "t").source == "a lab"
    assert parse_tests(TESTS_CSV, str(tmp_path / "some.csv")).source == "some.csv"


def test_a_path_may_be_text_and_a_shipped_name_comes_before_a_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    for name in ("lewis2004", "mine.csv"):
        Path(name).write_text(TESTS_CSV, encoding="utf-8")
    assert wl.read_tests("mine.csv") == wl.read_tests(Path("mine.csv"))
    assert "Dwyer-Joyce" in wl.read_tests("lewis2004").source
    assert wl.read_tests("./lewis2004").labels == ("a", "b")


# Errors

HEADERS: list[tuple[str, str, str]] = [
    ("creepage [%]", "creepage", "line 1, column 'creepage': has no unit; write it as 'creepage [%]'"),
    ("creepage [%]", "creepage (%)", "column 'creepage (%)': unknown column; write the unit in square brackets"),
    ("creepage [%]", "crepage [%]", "column 'crepage [%]': unknown column; did you mean 'creepage'?"),
    ("creepage [%]", "zzz", "line 1: creepage: is missing; add a column 'creepage [%]'"),
    ("creepage [%]", "", "line 1, column '': unknown column"),
    ("[kN]", "[mm]", "line 1, column 'normal_force [mm]': got 'mm', which does not have the dimension of 'kN'"),
    ("[kN]", "[weights]", "column 'normal_force [weights]': 'weights' is not a known unit; give it in kN or"),
    ("label", "label [-]", "line 1, column 'label [-]': is text"),
    ("label", "creepage [-]", "line 1, column 'creepage [%]': is there more than once"),
    ("label", "max_pressure [MPa]", "line 1: give exactly one load of "),
    ("label,", "frictional_heat [W],", "line 1: frictional_heat: "),
    ("wear_rate", "wear_rate_uncertainty", "line 1: wear_rate_uncertainty: "),
    (",wear_rate [ug/m/mm^2]\n", ",comment\n", "line 1: nothing is measured"),
]
ROWS: list[tuple[str, str]] = [
    ("b,-2,7.4,-40", "line 3, column 'wear_rate [ug/m/mm^2]': got -40, which must not be negative"),
    ("b,2,0,40", "line 3, column 'normal_force [kN]': got 0, which must be greater than zero"),
    ("b,2,1e307,40", "line 3, column 'normal_force [kN]': got 1e307, which must be finite"),
    ("b,2000,7.4,40", "column 'creepage [%]': got 2000, which must not exceed 100 % in magnitude; is its unit right?"),
    ("b,,7.4,40", "line 3, column 'creepage [%]': is missing"),
    ("b,two,7.4,40", "line 3, column 'creepage [%]': 'two' is not a number"),
    ("b,2,7,4,40", "line 3: has 5 cells, not 4"),
    ("b,2,7.4", "line 3: has 3 cells, not 4"),
    ("a, 1.0 ,74e-1,3e1", "line 3: is equal to line 2 in every column"),
]
HEAT = "creepage [%],normal_force [kN],frictional_heat [W],rolling_speed [m/s]\n1,7.4,3,1"
HEATS: list[tuple[str, str]] = [
    ("0,7.4,2,1", "line 3, column 'frictional_heat [W]': got 2, which gives a traction coefficient of inf"),
    ("1,7.4,2,", "line 3, column 'rolling_speed [m/s]': is missing; frictional_heat needs it"),
]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        *((TESTS_CSV.replace(old, new, 1), message) for old, new, message in HEADERS),
        *((f"{TESTS_HEAD}\na,1,7.4,30\n{row}\n", message) for row, message in ROWS),
        *((f"{HEAT}\n{row}\n", message) for row, message in HEATS),
        (TESTS_HEAD, "no test follows the header"),
        ("1,2,3\n4,5,6\n", "column '1': unknown column"),
    ],
)
def test_what_is_wrong_is_named_by_line_and_column(text: str, message: str) -> None:
    with pytest.raises(wl.DataError) as error:
        parse_tests(text, "mine.csv")
    assert str(error.value).startswith("the tests 'mine.csv' are wrong in:\n")
    assert any(message in problem for problem in error.value.problems)


def test_a_header_that_gives_no_traction_ends_in_no_other_error() -> None:
    for header in (
        "creepage [%],normal_force [kN],frictional_heat [W],tangential_force [N],rolling_speed [m/s]",
        "creepage [%],normal_force [mm],frictional_heat [J],rolling_speed [m/s],label",
    ):
        with pytest.raises(wl.DataError) as error:
            parse_tests(f"{header}\n0,1,1,1,1\n", "t")
        assert all(problem.startswith("line 1") for problem in error.value.problems)


@given(st.data())
def test_a_table_with_any_cell_changed_is_read_or_refused_as_data(data: st.DataObject) -> None:
    rows: list[list[str]] = [[*line.split(",")] for line in TESTS_CSV.splitlines()]
    row = data.draw(st.sampled_from(rows))
    row[data.draw(st.integers(0, len(row) - 1))] = data.draw(st.text(',;"[]%/^*()-+.eE0123456789 aµNk\n#', max_size=8))
    try:
        tests = parse_tests("\n".join(map(",".join, rows)), "t")
    except wl.DataError:
        return
    for name in ("creepage", "normal_force"):
        assert np.isfinite(tests.columns[name]).all()


def test_a_missing_file_is_refused_with_the_one_that_may_be_meant(tmp_path: Path) -> None:
    (tmp_path / "my-tests.csv").write_text(TESTS_CSV, encoding="utf-8")
    for name, message in ((tmp_path / "my-test.csv", "'my-tests.csv'"), ("lewis2005", "'lewis2004'")):
        with pytest.raises(wl.DataError, match=rf"did you mean {message}\? Shipped tests: lewis2004"):
            wl.read_tests(name)
    (tmp_path / "picture.csv").write_bytes(b"\x89PNG\r\n")
    for name in ("mine\0.csv", tmp_path, tmp_path / "picture.csv"):
        with pytest.raises(wl.DataError, match="cannot read the tests '"):
            wl.read_tests(name)
