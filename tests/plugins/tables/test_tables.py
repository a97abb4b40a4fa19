"""Reading tables: what a file holds comes back with units, and what is wrong is named by its place."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st

import wearlaw as wl
from tests.cases import wearlaw
from tests.core.distributions import Install
from tests.plugins.tables.sheets import xlsx
from wearlaw import Q
from wearlaw.errors import DataError
from wearlaw_apps.tables import Table

FORCE, SLIP = np.linspace(5.0, 7.0, 50), np.linspace(-0.02, 0.03, 50)
COLUMNS = {"force": "Fz", "creepage": "-slip [-]"}


def frame() -> Any:
    return pd.DataFrame({"Time [s]": np.arange(50) / 8.0, "Fz [kN]": FORCE, "slip [-]": SLIP, "note": "dry"})


def dataset() -> xr.Dataset:
    along = {"Fz": ("time", FORCE, {"units": "kN"}), "slip": ("time", SLIP, {"units": "1"})}
    return xr.Dataset(along, {"Time": ("time", np.arange(50) / 8.0, {"units": "s"})})


def text(content: str, columns: Any = None, **options: Any) -> Table:
    return wl.read_table(io.StringIO(content), columns, **options)


def with_comments(path: Path) -> None:
    path.write_bytes(b"\xef\xbb\xbf# source: run 7; dry\r\n\r\n" + frame().to_csv(lineterminator="\r\n").encode())


WRITERS: dict[str, tuple[Callable[[Path], object], dict[str, Any]]] = {
    "csv": (lambda path: frame().to_csv(path, index=False), {}),
    "comments": (with_comments, {}),
    "semicolons": (lambda path: frame().to_csv(path, index=False, sep=";", decimal=","), {"decimal": ","}),
    "tabs": (lambda path: frame().to_csv(path, index=False, sep="\t"), {}),
    "bars": (lambda path: frame().to_csv(path, index=False, sep="|"), {"sep": "|"}),
    "quotes": (lambda path: frame().to_csv(path, index=False, quoting=csv.QUOTE_ALL), {}),
    "commas at ends": (lambda path: path.write_text(frame().to_csv(index=False).replace("\n", ",\n")), {}),
}


@pytest.mark.parametrize("kind", WRITERS)
def test_a_file_gives_what_was_written(kind: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("wearlaw_apps.tables.CELLS", 30)  # private: several pieces
    write, options = WRITERS[kind]
    write(tmp_path / "run")
    table = wl.read_table(tmp_path / "run", COLUMNS, **options)
    assert (table["force"] == Q(FORCE, "kN")).all()
    assert (table["creepage"] == Q(-SLIP, "")).all()


@pytest.mark.parametrize("table", [frame(), dataset()], ids=["pandas", "xarray"])
def test_a_table_in_memory_is_read_likewise(table: Any) -> None:
    found = wl.read_table(table, COLUMNS)
    assert (found["force"] == Q(FORCE, "kN")).all()
    assert (found["creepage"] == Q(-SLIP, "")).all()


def test_units_come_from_heads_attributes_or_the_user() -> None:
    along: Any = {"b": ("row", [2.0], {"units": "kN"}), "d": ("row", [4.0]), "n": ("row", [5])}
    found = wl.read_table(xr.Dataset(along), {"b": "b", "d": "d [MN]", "n": "n"})
    assert {name: column.unit for name, column in found.columns.items()} == {"b": "kN", "d": "MN", "n": None}
    assert found["d"] == Q([4.0], "MN")
    assert isinstance(found["n"], np.ndarray)
    assert wl.read_table(pd.DataFrame({"a [N]": [1.0]}))["a"] == Q([1.0], "N")


@given(
    values=st.lists(st.floats(allow_nan=False, allow_infinity=False), min_size=1, max_size=5),
    sep=st.sampled_from(",;\t"),
    decimal=st.sampled_from(".,"),
)
def test_every_number_is_read_to_the_last_bit(values: list[float], sep: str, decimal: str) -> None:
    if sep == decimal:
        return
    cells = "\n".join(f"{value!r}{sep}x".replace(".", decimal) for value in values)
    assert text(f"a [mm]{sep}b\n{cells}\n", decimal=decimal).numbers("a").tolist() == values


def test_cells_texts_lines_and_comments() -> None:
    table = text('# source: a lab, "B"\n\na [%],note\n1, x\n\n,\nNA,"two\nlines"\n\u22122e0,\n')
    np.testing.assert_array_equal(table.numbers("a"), [1.0, np.nan, -2.0])
    assert table.texts("note") == ["x", "two\nlines", ""]
    assert (table.lines.tolist(), table.header) == ([4, 7, 9], 3)
    assert table.where(1, "note") == "line 7, column 'note'"
    assert table.comments[0] == 'source: a lab, "B'


def test_numbers_without_a_header_are_columns_by_their_number() -> None:
    table = text("# y z\n1.0  2\n # n\n -3\t4 \n", {"y": "-1 [mm]", "z": "2"})
    assert (table["y"] == Q([-1.0, 3.0], "mm")).all()
    assert table.numbers("z").tolist() == [2.0, 4.0]
    assert table.lines.tolist() == [2, 4]


LINES = frame().to_csv(index=False).splitlines()


def at_line(number: int, line: str) -> str:
    return "\n".join([*LINES[: number - 1], line, *LINES[number:]])


WRONG: dict[str, tuple[str, dict[str, Any], str]] = {
    "text": (at_line(9, "1,n.a.,0.1,dry"), {}, r"line 9, column 'Fz \[kN\]': 'n.a.'"),
    "a truth value": (at_line(9, "1,True,0.1,dry"), {}, r"line 9, column 'Fz \[kN\]': 'True'"),
    "after an empty line": (at_line(9, "\n\n1,x,0.1,dry"), {}, r"line 11, column 'Fz \[kN\]': 'x'"),
    "after a cell of two lines": (at_line(5, '1,5,0,"a\nb"\n1,x,0.1,dry'), {}, r"line 7, column 'Fz \[kN\]': 'x'"),
    "a decimal comma": (at_line(9, '1,"5,5",0.1,dry'), {}, r"line 9, .*give decimal=\",\""),
    "a decimal point": ("Fz [kN];slip\n1.5;2\n", {"decimal": ","}, r"line 2, .*give decimal=\"\.\""),
    "decimal commas": (at_line(9, "0,875,5,0.1,dry"), {}, r"line 9: has 5 cells, not 4; .*decimal=\",\""),
    "a short row": (at_line(9, "1,5"), {}, "line 9: has 2 cells, not 4"),
    "an open quotation mark": (at_line(9, '1,5,0.1,"dry'), {}, "cannot be read as CSV"),
    "a column that is not there": ("\n".join(LINES), {"columns": {"f": "Fzz"}}, r"f: .*did you mean 'Fz'\?"),
    "a column that is there twice": ("Fz,Fz\n1,2\n", {"columns": {"f": "Fz"}}, "f: the column 'Fz' is there 2 times"),
    "a name that is given twice": ("Fz,Fz [N]\n1,2\n", {"columns": None}, "Fz is given twice"),
    "units that differ": ("\n".join(LINES), {"columns": {"f": "Fz [N]"}}, r"'Fz \[kN\]': has the units 'N' and"),
    "a unit that is unknown": ("\n".join(LINES), {"columns": {"f": "note [weights]"}}, "f: column 'note': 'weights'"),
    "no name": ("\n".join(LINES), {"columns": {"my force": "Fz"}}, "columns: 'my force'"),
    "no mapping": ("\n".join(LINES), {"columns": ["Fz"]}, r"columns: .*got \['Fz'\]"),
    "titles above the heads": ("Run\nTime Fz\n1 2\n", {"columns": {"f": "Fz"}}, "Time Fz; 1 2; begin lines"),
    "what is no text": ("a,b\n\0\0", {}, "is no text; export it as text"),
    "an empty file": ("\n# only a comment\n", {}, "is empty"),
    "a decimal mark": ("a\n1\n", {"decimal": "'"}, "decimal: "),
}  # fmt: skip


@pytest.mark.parametrize("name", WRONG)
def test_what_is_wrong_is_named_by_its_place(name: str) -> None:
    content, options, message = WRONG[name]
    with pytest.raises(DataError, match=message):
        text(content, **{"columns": COLUMNS, **options})["force"]


def test_all_wrong_cells_are_named() -> None:
    with pytest.raises(DataError) as error:
        text("a,b\n1,2\nx,y\n\nz,2\n")["a"]
    assert [problem.split(",")[0] for problem in error.value.problems] == ["line 3", "line 5"]
    with pytest.raises(DataError) as error:
        text("a,b\n1,2,3\n\n1,2\n4\n")["a"]
    assert [problem.split(":")[0] for problem in error.value.problems] == [
        "line 2",
        "line 5",
        "as read, with commas between cells, it begins",
    ]


@pytest.mark.parametrize("inline", [False, True])
def test_a_spreadsheet_is_a_table_with_the_rows_of_its_sheet(tmp_path: Path, inline: bool) -> None:
    rows: list[list[object]] = [["# made up"], ["Fz [kN]", None, "slip"], [7.1, None, 0.5], [], [7.25, "a & b", -1e-3]]
    table = wl.read_table(xlsx(tmp_path / "run.xlsx", rows, [], inline=inline), {"force": "Fz", "slip": "-slip [%]"})
    assert table.numbers("force").tolist() == [7.1, 7.25]
    assert table.numbers("slip").tolist() == [-0.5, 1e-3]
    assert (table.lines.tolist(), table.comments) == ([3, 5], ["made up"])
    with pytest.raises(DataError, match=r"has 2 sheets with cells, 'sheet1\.xml' and 'sheet2\.xml'; name one"):
        wl.read_table(xlsx(tmp_path / "two.xlsx", rows, rows))


@pytest.mark.parametrize(
    ("units", "expected"),
    [
        ("[kN],[-],", True),
        ("kN,-,m", True),
        ("kN,1,m", True),
        ("(kN);-;", True),
        ("7,8,9", False),
        ("dry,wet,2", False),
    ],
)
def test_a_row_of_units_below_the_heads(units: str, expected: bool) -> None:
    mark = ";" if ";" in units else ","
    found = text(f"Fz{mark}xi{mark}s\n{units}\n1{mark}2{mark}3\n4{mark}5{mark}x\n", columns={"force": "Fz", "xi": "xi"})
    assert (found.columns["force"].unit, found.columns["xi"].unit) == (("kN", "") if expected else (None, None))
    if expected:
        assert found.numbers("force").tolist() == [1.0, 4.0]
        with pytest.raises(DataError, match="line 4, column 's"):
            wl.read_table(io.StringIO(f"s{mark}Fz\n[m]{mark}kN\n1{mark}2\nx{mark}5\n"))["s"]


def test_heads_and_numbers_may_stand_between_spaces() -> None:
    found = text("# a run\nt   Fz  xi\ns\tkN  -\n0   7.1  0.01\n1 7.2 0.02\n", columns={"force": "Fz", "time": "t"})
    assert (found.numbers("force").tolist(), found.columns["force"].unit) == ([7.1, 7.2], "kN")
    single = text("Track position\n5\n6\n", columns={"s": "Track position [m]"})
    assert single.numbers("s").tolist() == [5.0, 6.0]


BLOCKS = """made up
Mon Jan 1 2024

W1L N
2
  0.00000000E+00 ;   6.00000000E+04
  1.00000000E-02 ;   6.10000000E+04

W1L xi
2
  0.00000000E+00 ;   1.00000000E-03
  1.00000000E-02 ;   1.10000000E-03
"""


def test_blocks_of_a_vehicle_program_are_a_table() -> None:
    found = text(BLOCKS, columns={"time": "x [s]", "force": "W1L N [N]", "xi": "-W1L xi [-]"})
    assert found.numbers("time").tolist() == [0.0, 0.01]
    assert found.numbers("force").tolist() == [6e4, 6.1e4]
    assert found.numbers("xi").tolist() == [-1e-3, -1.1e-3]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (("W1L xi\n2", "W1L xi\n3"), "the block 'W1L xi' from line 10 has not 3 rows of x ; y"),
        (("W1L xi", "W1L N"), "the block 'W1L N' from line 10 is there twice; rename one"),
        (("1.00000000E-02 ;   1.1", "2.00000000E-02 ;   1.1"), "the blocks 'W1L N' and 'W1L xi' have other x; export"),
    ],
)
def test_blocks_that_do_not_fit_are_named(change: tuple[str, str], message: str) -> None:
    with pytest.raises(DataError, match=message):
        text(BLOCKS.replace(*change), columns=None)


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "cp1252"])
def test_tables_of_windows_are_read_below_their_titles(tmp_path: Path, encoding: str) -> None:
    """Excel and PowerShell write these encodings, titles above tables, groups of heads, and heads of two lines."""
    lines = 'Fahrt 3\r\nStraße X;;\r\n\r\nBahn;;;Zeit\r\nGröße;F [°];t;"u\r\n[s]"\r\n1,5;2;3;4\r\n'
    (tmp_path / "run.csv").write_bytes(lines.encode(encoding))
    table = wl.read_table(tmp_path / "run.csv", decimal=",")
    assert (table.numbers("Größe").tolist(), table.numbers("F").tolist()) == ([1.5], [2.0])
    assert (table.comments[0], table.where(0), table.numbers("u").tolist()) == ("Fahrt 3", "line 7", [4.0])


def test_decimal_commas_between_blanks_are_no_cells_of_a_title() -> None:
    table = text("creep load\n0,3 7,4\n0,5 7,4\n", columns=None, decimal=",")
    assert table.numbers("load").tolist() == [7.4, 7.4]


@pytest.mark.parametrize(
    ("cell", "says"),
    [
        ("7,400", "for decimals .* --decimal ,; leave out what separates thousands"),
        ("1,234,567", "is not a number; leave out what separates thousands"),
        ("2.1 ± 0.1", 'keep what follows "±" in a column of its own'),
        ("60 000", "leave out what separates thousands"),
        ("7.4 kN", r"state the unit in the head, as in 'Fz \[N\]'"),
        ("0.3%", "state the unit in the head"),
        ("<0.5", "leave cells without a value empty"),
    ],
)
def test_cells_without_a_number_say_what_to_do(cell: str, says: str) -> None:
    with pytest.raises(DataError, match=says):
        text(f"a;b\n{cell};1\n", columns=None)["a"]


def test_what_is_no_table_is_refused(tmp_path: Path) -> None:
    dataset().to_netcdf(tmp_path / "run.nc")
    (tmp_path / "none.csv").write_bytes(b"")
    (tmp_path / "run.xlsx").write_bytes(b"PK\x03\x04\x14\x00\x06\x00")
    with pytest.raises(DataError, match=r"is no spreadsheet in \.xlsx \(.*\); save its sheet as CSV"):
        wl.read_table(tmp_path / "run.xlsx")
    with pytest.raises(DataError, match="cannot be read: it is a spreadsheet, not text; save its sheet as CSV"):
        wl.read_table((tmp_path / "run.xlsx").rename(tmp_path / "run.csv"))
    for wrong in ("run.nc", "none.csv", "missing.csv", ""):
        with pytest.raises(DataError, match=re.escape(str(tmp_path / wrong))):
            wl.read_table(tmp_path / wrong)
    with pytest.raises(DataError, match="table"):
        wl.read_table(3)  # type: ignore[arg-type]
    with pytest.raises(DataError, match="several levels"):
        wl.read_table(frame().set_index(["Time [s]", "note"]))


def test_variables_lie_along_one_dimension() -> None:
    assert wl.read_table(dataset().assign(one=3.0), {"n": "one"}).numbers("n").tolist() == [3.0] * 50
    with pytest.raises(DataError, match="'other' along car"):
        wl.read_table(dataset().assign(other=("car", [1.0, 2.0])))


PAGE = Path(__file__).parents[3] / "docs" / "your-files.md"
(PLUGIN,) = re.findall(r":caption: wearlaw_polar\.py\n\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)


def test_files_are_read_by_the_readers_of_plugins(install: Install, tmp_path: Path) -> None:
    install("polar", PLUGIN)
    angle = np.linspace(-0.1, 0.1, 101)
    np.savetxt(tmp_path / "head.polar", np.stack([angle, np.full(101, 300.0)], axis=1))
    profile = wl.read_profile(tmp_path / "head.polar", shift_z="1 mm")
    assert profile.kind == "rail"
    curve = profile.curve
    assert 1.0 / curve.curvature[curve.s.size // 2] == pytest.approx(0.3, rel=1e-6)
    assert curve.at(0.0)[1] == pytest.approx(1e-3, abs=1e-9)
    (tmp_path / "run.fwf").write_text("Fz [N]   slip [-]\n7000     0.01\n7400     0.02\n")
    found = wl.read_table(tmp_path / "run.fwf", {"force": "Fz", "creepage": "slip"})
    assert found.numbers("force").tolist() == [7000.0, 7400.0]
    assert "It reads files that end in .polar" in wearlaw("show", "polar").stdout


def test_a_reader_that_returns_no_profile_is_named(install: Install, tmp_path: Path) -> None:
    install("polar", PLUGIN)
    (tmp_path / "head.fwf").write_text("a b\n1 2\n")
    with pytest.raises(DataError, match=r"head\.fwf': the reader of '\.fwf' returned a DataFrame, not a wl\.Profile"):
        wl.read_profile(tmp_path / "head.fwf", kind="rail")
