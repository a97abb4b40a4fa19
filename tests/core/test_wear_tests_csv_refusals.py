"""Wear tests from CSV: what is wrong is named by its place."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import wearlaw as wl
from tests.core.cases import TESTS_CSV, TESTS_HEAD
from wearlaw.wear_tests.reader import parse_tests

HEAD_FAULTS = [
    ("creepage [%]", "creepage", "line 1, column 'creepage': has no unit; write it as 'creepage [%]'"),
    ("creepage [%]", "creepage []", "line 1, column 'creepage []': has no unit; write it as 'creepage [%]'"),
    (
        "creepage [%]",
        "creepage (%)",
        "line 1, column 'creepage (%)': unknown column; write the unit in square brackets",
    ),
    ("creepage [%]", "creepage [%", "line 1, column 'creepage [%': unknown column; did you mean 'creepage'?"),
    (
        "creepage [%]",
        "crepage [%]",
        "line 1, column 'crepage [%]': unknown column; did you mean 'creepage'? The columns",
    ),
    ("creepage [%]", "zzz", "line 1, column 'zzz': unknown column. The columns are: creepage, normal_force"),
    ("creepage [%]", "zzz", "line 1: creepage: is missing; add a column 'creepage [%]'"),
    ("creepage [%]", "", "line 1: the head of column 2 is empty"),
    (
        "[kN]",
        "[mm]",
        "column 'normal_force [mm]': got 'mm', which does not have the dimension of 'kN'; give it in kN or an",
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
    (
        "[ug/m/mm^2]",
        "[degC]",
        "column 'wear_rate [degC]': got 'degC', which does not have the dimension of 'ug/m/mm^2'",
    ),
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
    ("wear_rate", "wear_rate_uncertainty", "line 1: wear_rate_uncertainty: there is no wear_rate beside it"),
    (",wear_rate [ug/m/mm^2]\n", ",comment\n", "line 1: nothing is measured; add a column 'wear_rate [ug/m/mm^2]' or"),
]


@pytest.mark.parametrize(("old", "new", "message"), HEAD_FAULTS, ids=[f"{new}-{m[-40:]}" for _, new, m in HEAD_FAULTS])
def test_a_wrong_header_is_refused_with_line_and_column(old: str, new: str, message: str) -> None:
    assert old in TESTS_CSV
    with pytest.raises(wl.DataError) as refusal:
        parse_tests(TESTS_CSV.replace(old, new, 1), "mine.csv")
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
        parse_tests(f"{TESTS_HEAD}\na,1,7.4,30\n{row}\n", "mine.csv")
    (problem,) = refusal.value.problems
    assert message in problem


def test_a_fault_of_many_lines_is_said_once() -> None:
    commas = "".join(f"{name},{name},7,4,40\n" for name in "123456")
    with pytest.raises(wl.DataError) as refusal:
        parse_tests(f"{TESTS_HEAD}\n{commas}x,y,7.4,40\nx,y,7.4,50\n", "mine.csv")
    assert list(refusal.value.problems) == [
        "line 2 (and 5 more, up to line 7): has 5 cells, but the header has 4; with decimal commas, separate cells by"
        " ';'",
        "line 8, column 'creepage [%]': 'y' is not a number",
        "line 9, column 'creepage [%]': 'y' is not a number",
    ]


def test_lines_are_counted_as_an_editor_shows_them() -> None:
    text = f'\ufeffsep=,\r\n# a comment\r\n\r\n{TESTS_HEAD}\r\n\r\n"a\r\nb",1,7,3\r\n,,,\r\nc,1,7,x\r\nd,1,7,y'
    with pytest.raises(wl.DataError) as refusal:
        parse_tests(text.removeprefix("\ufeff"), "t")
    assert [problem.split(",")[0] for problem in refusal.value.problems] == ["line 9", "line 10"]


@pytest.mark.parametrize("text", ["a;0,5;7.4;30", "a;0.5;7,4;30", "a;0.5;7;30\nb;0,5;7;30"])
def test_mixed_decimal_marks_are_refused_with_the_lines_of_both(text: str) -> None:
    last = text.count("\n") + 2
    with pytest.raises(wl.DataError) as refusal:
        parse_tests(f"{TESTS_HEAD.replace(',', ';')}\n{text}\n", "t")
    assert refusal.value.problems[0].startswith(
        f"line {last}: decimal marks are mixed: a comma in line {last}, a point"
    )


def test_a_decimal_comma_in_text_is_not_mixed_with_points() -> None:
    rows = "1,5 h;0.5;7.4;30\n2.5 h;0.5;7.4;31\n"
    assert parse_tests(f"{TESTS_HEAD.replace(',', ';')}\n{rows}", "t").labels == ("1,5 h", "2.5 h")


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
    "only a header": (TESTS_HEAD.encode(), "line 1: no test follows the header"),
    "no header": (
        b"1,2,3\n4,5,6\n",
        "line 1: is not a header; the columns are: creepage [%], normal_force [kN], normal_f",
    ),
    "empty quotes": (b'""\n', "line 1: is not a header; the columns are: creepage"),
    "a workbook": (b"PK\x03\x04\x14\x00\x06\x00", "it is a workbook (.xlsx, .ods); save it as CSV and give that file"),
    "an old workbook": (b"\xd0\xcf\x11\xe0\xa1\xb1", "it is an old workbook (.xls); save it as CSV and give that file"),
    "a picture": (b"\x89PNG\r\n\x1a\n\x00\x00\x00\rIHDR", "it is no text; save it as CSV and give that file"),
    "no known code": (b"label\x81\x8d,creepage [%]\n", "it is not text in UTF-8; save it as CSV in UTF-8"),
    "half of UTF-16": (b"\xff\xfea", "it is not text in UTF-8; save it as CSV in UTF-8"),
    "an endless cell": (
        TESTS_HEAD.encode() + b'\n"' + b"a" * 200_000,
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
    with pytest.raises(
        wl.DataError, match=r"there is no file '.*my-test.csv'; did you mean 'my-tests.csv'\? Shipped tes"
    ):
        wl.read_tests(tmp_path / "my-test.csv")
    with pytest.raises(wl.DataError, match=r"no file 'lewis2005'; did you mean 'lewis2004'\? Shipped tests: lewis2004"):
        wl.read_tests("lewis2005")
    with pytest.raises(wl.DataError, match=r"there is no file '.*zzz'. Shipped tests: lewis2004"):
        wl.read_tests(tmp_path / "nowhere" / "zzz")


@pytest.mark.parametrize("name", ["", "mine\0.csv", "x" * 300])
def test_what_cannot_be_opened_is_refused(name: str) -> None:
    with pytest.raises(wl.DataError, match="cannot read the tests '"):
        wl.read_tests(name)


def test_a_folder_is_refused_as_one() -> None:
    with pytest.raises(wl.DataError, match=r"cannot read the tests '\.': Is a directory"):
        wl.read_tests(".")
