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
from wearlaw.wear_tests.reader import parse_tests

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
LINE = st.text(st.characters(codec="cp1252", exclude_characters="\r\n", exclude_categories=["Cc"]), max_size=12)
"""Text of one line that code page 1252 can hold too."""


@dataclass
class File:
    """A table of tests, the bytes of its file, and what must be read from it."""

    content: bytes
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
    source = draw(st.sampled_from(["", "a lab, 2026; series B", 'called "B"']))
    return File(_written(draw, table, separator, source), si, tuple(labels), source)


BOOL = st.booleans()


def _written(draw: st.DrawFn, table: list[list[str]], separator: str, source: str) -> bytes:
    """Return a table as one of the programs there are may write it."""
    width = len(table[0]) + draw(st.integers(0, 2))
    rows = [row + [""] * (width - len(row)) for row in table] + [[""] * width] * draw(st.integers(0, 2))
    text = io.StringIO()
    quoting: Any = draw(st.sampled_from([csv.QUOTE_MINIMAL, csv.QUOTE_ALL]))
    writer = csv.writer(text, delimiter=separator, quoting=quoting, lineterminator="\n")
    if draw(BOOL):
        text.write(f"sep={separator}\n" if separator != "\t" else "\n")
    if source and draw(BOOL):
        writer.writerow([f"# source: {source}", *[""] * (width - 1)])  # as a spreadsheet keeps a comment
    elif source:
        text.write(f"# source: {source}\n# another comment\n\n")
    writer.writerows(rows)
    newline = draw(st.sampled_from(["\n", "\r\n", "\r"]))
    written = text.getvalue().replace("\n", newline)
    encodings = ["utf-8", "utf-8-sig", "utf-16", *([] if _like_utf8(written.encode("cp1252")) else ["cp1252"])]
    return written.encode(draw(st.sampled_from(encodings)))


def _like_utf8(content: bytes) -> bool:
    """Return whether nobody can tell the bytes from UTF-8, as those of "Ã¼" in code page 1252, which are "ü" there."""
    try:
        content.decode("utf-8")
    except UnicodeDecodeError:
        return False
    return True


@given(file=files())
def test_whatever_program_wrote_a_table_it_is_read_back(tmp_path_factory: pytest.TempPathFactory, file: File) -> None:
    path = tmp_path_factory.getbasetemp() / "round-trip.csv"
    path.write_bytes(file.content)
    tests = wl.read_tests(path)
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


@pytest.mark.parametrize(
    ("text", "value"),
    [("1e1", 10.0), ("+1.", 1.0), (".5", 0.5), ("1E-1", 0.1), ("\u22125", -5.0), (" 2 ", 2.0), ("-0.25", -0.25)],
)
def test_numbers_are_understood_as_they_are_typed(text: str, value: float) -> None:
    tests = parse_tests(f"creepage [%],normal_force [N],wear_rate [kg/m^3]\n{text},1,1\n", "t")
    assert tests.columns["creepage"][0] == pytest.approx(value / 100.0, rel=4 * EPS)


def test_a_comment_column_is_passed_over_and_a_cell_may_span_lines() -> None:
    text = 'comment,creepage [%],normal_force [kN],wear_rate [ug/m/mm^2],label\n"two\nlines",1,7,3,"a, b"\n"",2,7,x,c\n'
    with pytest.raises(wl.DataError, match=r"line 4, column 'wear_rate \[ug/m/mm\^2\]': 'x' is not a number"):
        parse_tests(text, "t")
    tests = parse_tests(text.replace("x", "4"), "t")
    assert tests.labels == ("a, b", "c")
    assert set(tests.columns) == {"creepage", "normal_force", "wear_rate"}


@pytest.mark.parametrize(
    "text",
    [
        f"sep=|\n{TESTS_CSV.replace(',', '|')}",
        "sep=\t\n" + TESTS_CSV.replace(",", "\t"),
        TESTS_CSV.replace(",", ", ").replace("a, 1", '"a", 1').replace("30", '"30"'),
        f"# source: t,,,\n{TESTS_CSV}",
    ],
    ids=["a separator that is stated", "a tab that is stated", "spaces before quotes", "a padded comment"],
)
def test_what_else_programs_write_is_understood(text: str) -> None:
    assert parse_tests(text, "t") == parse_tests(TESTS_CSV, "t")


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
