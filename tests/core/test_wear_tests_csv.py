"""Wear tests from CSV: every way in which spreadsheets write it is read, and what is wrong is named by its place."""

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

HEADER = "label,creepage [%],normal_force [kN],wear_rate [ug/m/mm^2]"
GOOD = f"{HEADER}\na,1,7.4,30\nb,2,7.4,40\n"


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
        f"sep=|\n{GOOD.replace(',', '|')}",
        "sep=\t\n" + GOOD.replace(",", "\t"),
        GOOD.replace(",", ", ").replace("a, 1", '"a", 1').replace("30", '"30"'),
        f"# source: t,,,\n{GOOD}",
    ],
    ids=["a separator that is stated", "a tab that is stated", "spaces before quotes", "a padded comment"],
)
def test_what_else_programs_write_is_understood(text: str) -> None:
    assert parse_tests(text, "t") == parse_tests(GOOD, "t")


def test_repeated_tests_with_other_results_or_labels_are_welcome() -> None:
    repeated = f"{HEADER}\na,1,7.4,30\na,1,7.4,31\nb,1,7.4,30\n"
    assert parse_tests(repeated, "t").labels == ("a", "a", "b")
    assert len(parse_tests(f"{HEADER.replace('label', 'comment')}\nmorning,1,7.4,30\nevening,1,7.4,30\n", "t")) == 2


def test_rows_that_cannot_be_read_are_not_taken_for_equal_ones() -> None:
    with pytest.raises(wl.DataError) as refusal:
        parse_tests(f"{HEADER}\na,1,x,30\na,1,y,30\n", "t")
    assert [problem.split(":")[1] for problem in refusal.value.problems] == [
        " 'x' is not a number",
        " 'y' is not a number",
    ]


def test_the_first_source_of_several_is_not_lost_and_other_comments_are(tmp_path: Path) -> None:
    assert parse_tests(f"# about the rig\n#Source:  a lab \n# more: words\n{GOOD}", "t").source == "a lab"
    assert parse_tests(GOOD, str(tmp_path / "some.csv")).source == "some.csv"


def test_a_path_may_be_text_and_a_shipped_name_comes_before_a_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    for name in ("lewis2004", "mine.csv"):
        Path(name).write_text(GOOD, encoding="utf-8")
    assert wl.read_tests("mine.csv") == wl.read_tests(Path("mine.csv"))
    assert "Dwyer-Joyce" in wl.read_tests("lewis2004").source
    assert wl.read_tests("./lewis2004").labels == ("a", "b")


# What is refused

HEAD_FAULTS = [
    ("creepage [%]", "creepage", "line 1, column 'creepage': has no unit; write it as 'creepage [%]'"),
    ("creepage [%]", "creepage []", "line 1, column 'creepage []': has no unit; write it as 'creepage [%]'"),
    (
        "creepage [%]",
        "creepage (%)",
        "line 1, column 'creepage (%)': unknown column; write the unit in square brackets;",
    ),
    ("creepage [%]", "creepage [%", "line 1, column 'creepage [%': unknown column; did you mean 'creepage'?"),
    (
        "creepage [%]",
        "crepage [%]",
        "line 1, column 'crepage [%]': unknown column; did you mean 'creepage'? The columns",
    ),
    ("creepage [%]", "zzz [%]", "line 1, column 'zzz [%]': unknown column; The columns are: creepage, normal_force"),
    ("creepage [%]", "zzz [%]", "line 1: creepage: is missing; add a column 'creepage [%]'"),
    ("creepage [%]", "", "line 1: the head of column 2 is empty"),
    (
        "[kN]",
        "[mm]",
        "column 'normal_force [mm]': got 'mm', which is not of the dimension of 'kN'; give it in kN or an",
    ),
    (
        "[kN]",
        "[weights]",
        "column 'normal_force [weights]': 'weights' is not a known unit; give it in kN or another unit of",
    ),
    (
        "[kN]",
        "[N*]",
        "line 1, column 'normal_force [N*]': 'N*' is not a unit; give it in kN or another unit of that dim",
    ),
    ("[ug/m/mm^2]", "[degC]", "column 'wear_rate [degC]': got 'degC', which is not of the dimension of 'ug/m/mm^2'"),
    ("label", "label [-]", "line 1, column 'label [-]': is text and takes no unit"),
    ("label", "creepage [-]", "line 1, column 'creepage [%]': is there more than once; keep one of them"),
    ("label", "creepage [-]", "line 1, column 'creepage [-]': is there more than once; keep one of them"),
    (
        "label",
        "max_pressure [MPa]",
        "line 1: give exactly one load of normal_force [kN], normal_force_per_width [kN/m], "
        "max_pressure [MPa]; got normal_force and max_pressure",
    ),
    (
        "label,",
        "frictional_heat [W],",
        "line 1: frictional_heat: is T × creepage × rolling speed; add a column 'rolling",
    ),
    ("label", "friction_coefficient [N]", "'friction_coefficient [N]': got 'N', which is not a ratio; give it as a pl"),
    ("wear_rate", "wear_rate_uncertainty", "line 1: wear_rate_uncertainty: has no wear_rate that it belongs to"),
    (",wear_rate [ug/m/mm^2]\n", ",comment\n", "line 1: nothing is measured; add a column 'wear_rate [ug/m/mm^2]' or"),
]


@pytest.mark.parametrize(("old", "new", "message"), HEAD_FAULTS, ids=[f"{new}-{m[-40:]}" for _, new, m in HEAD_FAULTS])
def test_a_wrong_header_is_refused_with_line_and_column(old: str, new: str, message: str) -> None:
    assert old in GOOD
    text = "\n".join([GOOD.splitlines()[0].replace(old.strip("\n"), new.strip("\n"), 1), *GOOD.splitlines()[1:]])
    with pytest.raises(wl.DataError) as refusal:
        parse_tests(text, "mine.csv")
    assert str(refusal.value).startswith("the tests 'mine.csv' are wrong in:\n")
    assert message in str(refusal.value)


ROW_FAULTS = [
    ("b,-2,7.4,-40", "line 3, column 'wear_rate [ug/m/mm^2]': got -40, which must not be negative"),
    ("b,2,0,40", "line 3, column 'normal_force [kN]': got 0, which must be greater than zero"),
    ("b,2,-7.4,40", "line 3, column 'normal_force [kN]': got -7.4, which must be greater than zero"),
    ("b,2,1e999,40", "line 3, column 'normal_force [kN]': got 1e999, which must be finite"),
    ("b,2,1e307,40", "line 3, column 'normal_force [kN]': got 1e307, which must be finite"),
    ("b,2000,7.4,40", "column 'creepage [%]': got 2000, which must not exceed 100 % in magnitude; is its unit right?"),
    ("b,-101,7.4,40", "line 3, column 'creepage [%]': got -101, which must not exceed 100 % in magnitude; is its unit"),
    ("b,,7.4,40", "line 3, column 'creepage [%]': is missing; every test needs it"),
    ("b,2,n/a,40", "line 3, column 'normal_force [kN]': is missing; every test needs it"),
    ("b,two,7.4,40", "line 3, column 'creepage [%]': 'two' is not a number"),
    ("b,2 %,7.4,40", "line 3, column 'creepage [%]': '2 %' is not a number; the unit goes into the header"),
    ("b,2,7 400,40", "line 3, column 'normal_force [kN]': '7 400' is not a number"),
    ("b,2,inf,40", "line 3, column 'normal_force [kN]': 'inf' is not a number"),
    ("b,2,\u0667,40", "line 3, column 'normal_force [kN]': '\u0667' is not a number"),
    ('b,2,"7,4",40', "line 3, column 'normal_force [kN]': '7,4' has a decimal comma; write a point, or separate cells"),
    ("b,2,7,4,40", "line 3: has 5 cells, but the header has 4; with decimal commas, separate cells by ';'"),
    ("b,2,7.4", "line 3: has 3 cells, but the header has 4"),
    ("# b,2,7.4", "line 3: has 3 cells, but the header has 4; comments go above the header"),
    (
        '"b,2,7.4,40\nc,2,7.4,40',
        "line 3: has 1 cells, but the header has 4; a quotation mark in it may have no partner",
    ),
    ("a,1,7.4,30", "line 3: is equal to line 2 in every column; leave it out, or label a repeated test"),
    ("a, 1.0 ,74e-1,3e1", "line 3: is equal to line 2 in every column; leave it out, or label a repeated test"),
]


@pytest.mark.parametrize(("row", "message"), ROW_FAULTS, ids=[row for row, _ in ROW_FAULTS])
def test_a_wrong_row_is_refused_with_line_and_column(row: str, message: str) -> None:
    with pytest.raises(wl.DataError) as refusal:
        parse_tests(f"{HEADER}\na,1,7.4,30\n{row}\n", "mine.csv")
    (problem,) = refusal.value.problems
    assert message in problem


def test_lines_are_counted_as_an_editor_shows_them() -> None:
    text = f'\ufeffsep=,\r\n# a comment\r\n\r\n{HEADER}\r\n\r\n"a\r\nb",1,7,3\r\n,,,\r\nc,1,7,x\r\nd,1,7,y'
    with pytest.raises(wl.DataError) as refusal:
        parse_tests(text.removeprefix("\ufeff"), "t")
    assert [problem.split(",")[0] for problem in refusal.value.problems] == ["line 9", "line 10"]


@pytest.mark.parametrize("text", ["a;0,5;7.4;30", "a;0.5;7,4;30", "a;0.5;7;30\nb;0,5;7;30"])
def test_mixed_decimal_marks_are_refused_with_the_lines_of_both(text: str) -> None:
    last = text.count("\n") + 2
    with pytest.raises(wl.DataError) as refusal:
        parse_tests(f"{HEADER.replace(',', ';')}\n{text}\n", "t")
    assert refusal.value.problems[0].startswith(
        f"line {last}: decimal marks are mixed: a comma in line {last}, a point"
    )


def test_a_decimal_comma_in_text_is_not_mixed_with_points() -> None:
    rows = "1,5 h;0.5;7.4;30\n2.5 h;0.5;7.4;31\n"
    assert parse_tests(f"{HEADER.replace(',', ';')}\n{rows}", "t").labels == ("1,5 h", "2.5 h")


def test_all_faults_of_a_file_are_said_in_the_order_of_its_lines() -> None:
    text = "label,creepage [%],normal_force [mm],wear [ug/m/mm^2]\na,x,7,3\nb,1,y,-3\nc,1,7\n"
    with pytest.raises(wl.DataError) as refusal:
        parse_tests(text, "t")
    starts = [problem.split(":")[0] for problem in refusal.value.problems]
    assert starts == [
        "line 1, column 'normal_force [mm]'",
        "line 1, column 'wear [ug/m/mm^2]'",
        "line 2, column 'creepage [%]'",
        "line 3, column 'normal_force [mm]'",
        "line 4",
    ]


@pytest.mark.parametrize(
    ("heat", "message"),
    [
        (
            "0,7.4,2,1",
            "'frictional_heat [W]': got 2, which gives a traction coefficient of inf; check the creepage and",
        ),
        ("1,7.4,2,", "column 'rolling_speed [m/s]': is missing; frictional_heat needs it"),
        ("1,7.4,0,1", "column 'frictional_heat [W]': got 0, which must be greater than zero"),
        ("1,7.4,x,-1", "column 'rolling_speed [m/s]': got -1, which must be greater than zero"),
    ],
)
def test_heat_that_gives_no_traction_is_refused(heat: str, message: str) -> None:
    header = "creepage [%],normal_force [kN],frictional_heat [W],rolling_speed [m/s]"
    with pytest.raises(wl.DataError) as refusal:
        parse_tests(f"{header}\n1,7.4,3,1\n{heat}\n0,7.4,,\n", "t")
    assert all(problem.startswith("line 3") for problem in refusal.value.problems)
    assert message in refusal.value.problems[-1]


@pytest.mark.parametrize(
    "header",
    [
        "creepage [%],normal_force [kN],frictional_heat [W],tangential_force [N],rolling_speed [m/s]",
        "creepage [mm],normal_force [kN],frictional_heat [W],rolling_speed [m/s],label",
        "creepage [%],normal_force [kN],frictional_heat [W],rolling_speed [mm],label",
        "creepage [%],normal_force [mm],frictional_heat [J],rolling_speed [m/s],label",
        "creepage [%],max_pressure [MPa],frictional_heat [W],comment,label",
    ],
)
def test_a_header_that_gives_no_traction_ends_in_no_other_error(header: str) -> None:
    with pytest.raises(wl.DataError, match="line 1") as refusal:
        parse_tests(f"{header}\n0,1,1,1,1\n", "t")
    assert all(problem.startswith("line 1") for problem in refusal.value.problems)


NO_TABLES = {
    "nothing": (b"", "the tests '{}' are empty; begin with a header such as: creepage [%], ..."),
    "comments": (b"# source: x\n\n;;;\n", "the tests '{}' are empty; begin with a header such as"),
    "only a header": (HEADER.encode(), "line 1: no test follows the header"),
    "no header": (
        b"1,2,3\n4,5,6\n",
        "line 1: is no header; the columns are: creepage [%], normal_force [kN], normal_f",
    ),
    "empty quotes": (b'""\n', "line 1: is no header; the columns are: creepage"),
    "a workbook": (b"PK\x03\x04\x14\x00\x06\x00", "it is a workbook (.xlsx, .ods); save it as CSV and give that file"),
    "an old workbook": (b"\xd0\xcf\x11\xe0\xa1\xb1", "it is an old workbook (.xls); save it as CSV and give that file"),
    "a picture": (b"\x89PNG\r\n\x1a\n\x00\x00\x00\rIHDR", "it is no text; save it as CSV and give that file"),
    "no known code": (b"label\x81\x8d,creepage [%]\n", "it is no text in UTF-8; save it as CSV in UTF-8"),
    "half of UTF-16": (b"\xff\xfea", "it is no text in UTF-8; save it as CSV in UTF-8"),
    "an endless cell": (
        HEADER.encode() + b'\n"' + b"a" * 200_000,
        "cannot be read as CSV: field larger than field lim",
    ),
}


@pytest.mark.parametrize(("content", "message"), NO_TABLES.values(), ids=NO_TABLES)
def test_a_file_that_is_no_table_is_refused(tmp_path: Path, content: bytes, message: str) -> None:
    path = tmp_path / "mine.csv"
    path.write_bytes(content)
    with pytest.raises(wl.DataError) as refusal:
        wl.read_tests(path)
    assert message.format(path) in str(refusal.value)
    assert str(path) in str(refusal.value)


@given(content=st.binary(max_size=60) | st.text(',;\t\n"[]%#=sep.- 1x', max_size=60).map(str.encode))
def test_whatever_a_file_holds_it_is_refused_as_data(tmp_path_factory: pytest.TempPathFactory, content: bytes) -> None:
    path = tmp_path_factory.getbasetemp() / "anything.csv"
    path.write_bytes(content)
    with pytest.raises(wl.DataError):
        wl.read_tests(path)


@given(st.data())
def test_a_table_with_any_cell_changed_is_read_or_refused_as_data(data: st.DataObject) -> None:
    rows = [line.split(",") for line in GOOD.splitlines()]
    row = data.draw(st.sampled_from(rows))
    row[data.draw(st.integers(0, len(row) - 1))] = data.draw(st.text(',;"[]%/^*()-+.eE0123456789 aµNk\n#', max_size=8))
    try:
        tests = parse_tests("\n".join(map(",".join, rows)), "t")
    except wl.DataError:
        return
    for name in ("creepage", "normal_force"):
        assert np.isfinite(tests.columns[name]).all()


def test_a_missing_file_is_refused_with_the_one_that_may_be_meant(tmp_path: Path) -> None:
    (tmp_path / "my-tests.csv").write_text(GOOD, encoding="utf-8")
    with pytest.raises(
        wl.DataError, match=r"there is no file '.*my-test.csv'; did you mean 'my-tests.csv'\? Shipped tes"
    ):
        wl.read_tests(tmp_path / "my-test.csv")
    with pytest.raises(wl.DataError, match=r"no file 'lewis2005'; did you mean 'lewis2004'\? Shipped tests: lewis2004"):
        wl.read_tests("lewis2005")
    with pytest.raises(wl.DataError, match=r"there is no file '.*zzz'; Shipped tests: lewis2004"):
        wl.read_tests(tmp_path / "nowhere" / "zzz")


@pytest.mark.parametrize("name", [".", "", "mine\0.csv", "x" * 300])
def test_what_cannot_be_opened_is_refused(name: str) -> None:
    with pytest.raises(wl.DataError, match="cannot read the tests '"):
        wl.read_tests(name)
    with pytest.raises(wl.DataError, match=r"cannot read the tests '\.': it is a folder; give a CSV file"):
        wl.read_tests(".")
