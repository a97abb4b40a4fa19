"""Sweeps over tables in files: formats, columns, units, signs, errors by line and column, and long files."""

from __future__ import annotations

import sys
import tracemalloc
from collections.abc import Callable
from decimal import Decimal
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import xarray as xr

import wearlaw as wl
from tests.core.axles import KTH, Axle
from tests.core.sweeps import interrupted_after, predictor
from wearlaw import Q
from wearlaw.sweeping import points, table_files, tables
from wearlaw.sweeping.table_files import CsvFile

ROWS = 100
RANDOM = np.random.default_rng(5)
CREEPAGE, LOAD = RANDOM.uniform(1e-3, 5e-2, ROWS), RANDOM.uniform(3e3, 8e3, ROWS)
TIME = np.arange(ROWS) / 8.0
COLUMNS = {"creepage": "-slip", "normal_force": "Fz"}
KEEP = {"time": "Time"}
FRICTION: Any = {"friction_coefficient": 0.4}


def frame() -> Any:
    return pd.DataFrame({"Time [s]": TIME, "Fz [N]": LOAD, "slip [-]": -CREEPAGE, "note": "dry"})


def dataset() -> Any:
    units = {"Fz": "N", "slip": "1"}
    given = {"Fz": LOAD.copy(), "slip": -CREEPAGE}  # xarray would share the memory
    along = {name: ("time", values, {"units": units[name]}) for name, values in given.items()}
    return xr.Dataset(along, {"Time": ("time", TIME, {"units": "s"})})


def expected(**changes: Any) -> wl.Prediction:
    given = {"creepage": Q(CREEPAGE, ""), "normal_force": Q(LOAD, "N"), **FRICTION, **changes}
    return predictor()(**given)


def swept(path: Any, **changes: Any) -> xr.Dataset:
    return wl.sweep(predictor(), path, **{"columns": COLUMNS, "keep": KEEP, **FRICTION, **changes})


def write_csv(path: Path) -> None:
    frame().to_csv(path, index=False)


def write_spreadsheet(path: Path) -> None:
    """Write decimal commas, a comment, a blank line, and Windows' encoding and ends of lines."""
    text = "# source: run 7; dry\n\nZeit;Fz;slip;Größe\ns;N;-;mm\n" + frame().to_csv(
        index=False, header=False, sep=";", decimal=",", lineterminator="\n"
    )
    path.write_bytes(text.replace("Zeit", "Time").replace("\n", "\r\n").encode("cp1252"))


def write_tabs(path: Path) -> None:
    frame().to_csv(path, index=False, sep="\t", encoding="utf-16")


def write_commas_at_ends(path: Path) -> None:
    path.write_text(frame().to_csv(index=False).replace("\n", ",\n"), encoding="utf-8")


def write_parquet(path: Path) -> None:
    pytest.importorskip("pyarrow")
    frame().to_parquet(path)


def write_netcdf(path: Path) -> None:
    dataset().to_netcdf(path)


def write_netcdf_3(path: Path) -> None:
    dataset().to_netcdf(path, engine="scipy")


def write_zarr(path: Path) -> None:
    pytest.importorskip("zarr")
    dataset().to_zarr(path, consolidated=False, zarr_format=3)


WRITERS = [write_csv, write_spreadsheet, write_tabs, write_commas_at_ends, write_parquet]
WRITERS += [write_netcdf, write_netcdf_3, write_zarr]


@pytest.mark.usefixtures("small_blocks")
@pytest.mark.parametrize("write", WRITERS, ids=lambda one: one.__name__)
@pytest.mark.parametrize("stored", [False, True])
def test_a_file_gives_what_its_arrays_give(
    write: Callable[[Path], None], stored: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(table_files, "ROWS", 7)
    write(tmp_path / "run")
    if stored:
        pytest.importorskip("zarr")
    ds = swept(tmp_path / "run", store=tmp_path / "map.zarr" if stored else None)
    r = expected()
    # The numbers are the same to the last bit, but for decimal fractions of old parsers.
    np.testing.assert_allclose(ds.creepage, CREEPAGE, rtol=4e-16)
    assert (abs(ds.wear_rate.to_numpy() - r.wear_rate.magnitude) <= 2 * r.wear_rate_error.magnitude).all()
    assert ds.wear_rate.dims == ds.time.dims == ("row",) or ds.wear_rate.dims == ("time",)
    assert ds.time.to_numpy().tolist() == TIME.tolist()
    assert (ds.time.attrs["units"], ds.normal_force.attrs["units"], ds.creepage.attrs["units"]) == ("s", "N", "")
    assert set(ds.coords) == {"creepage", "normal_force", "time", "friction_coefficient"}


@pytest.mark.parametrize("table", [frame(), dataset()], ids=["pandas", "xarray"])
def test_columns_of_tables_in_memory_are_mapped_likewise(table: Any) -> None:
    ds = swept(table)
    assert ds.creepage.to_numpy().tolist() == CREEPAGE.tolist()
    assert ds.time.to_numpy().tolist() == TIME.tolist()
    assert ds.wear_rate.to_numpy().tolist() == expected().wear_rate.magnitude.tolist()


def test_columns_named_as_conditions_need_no_mapping(tmp_path: Path) -> None:
    table = frame()[["slip [-]", "Fz [N]"]].rename(columns={"slip [-]": "creepage [-]", "Fz [N]": "normal_force [N]"})
    table["creepage [-]"] *= -1
    table.to_csv(tmp_path / "run.csv", index=False)
    ds = wl.sweep(predictor(), tmp_path / "run.csv", **FRICTION)
    assert ds.wear_rate.to_numpy().tolist() == expected().wear_rate.magnitude.tolist()


def test_a_unit_in_the_head_and_another_in_the_row_below_are_refused(tmp_path: Path) -> None:
    (tmp_path / "run.csv").write_text("slip,Fz [N]\n-,kN\n-0.01,5\n", encoding="utf-8")
    with pytest.raises(wl.DataError, match=r"column 'Fz \[N\]' has the unit 'kN' as well; keep one of the two"):
        wl.sweep(predictor(), tmp_path / "run.csv", columns=COLUMNS, **FRICTION)


def test_a_comma_at_the_end_of_each_line_makes_no_column(tmp_path: Path) -> None:
    text = "creepage [-],normal_force [N],\n0.01,5000,\n"
    (tmp_path / "run.csv").write_text(text, encoding="utf-8")
    ds = wl.sweep(predictor(), tmp_path / "run.csv", **FRICTION)
    assert ds.normal_force.to_numpy().tolist() == [5000.0]


def test_heads_of_old_spreadsheets_are_read_with_their_letters(tmp_path: Path) -> None:
    (tmp_path / "run.csv").write_bytes("creepage [-];Höhe [m];Kraft [N]\n0,01;0,5;5000\n".encode("cp1252"))
    mapped = {"creepage": "creepage", "normal_force": "Kraft"}
    ds = wl.sweep(predictor(), tmp_path / "run.csv", columns=mapped, keep={"height": "Höhe"}, **FRICTION)
    assert ds.height.to_numpy().tolist() == [0.5]


@pytest.mark.parametrize("column", ["Fz [kN]", "Fz"])
def test_a_unit_comes_from_the_file_or_from_the_user(column: str, tmp_path: Path) -> None:
    table = frame().rename(columns={"Fz [N]": column})
    table[column] /= 1e3
    table.to_csv(tmp_path / "run.csv", index=False)
    ds = swept(tmp_path / "run.csv", columns={**COLUMNS, "normal_force": "Fz [kN]"}, outputs=["max_pressure"])
    assert ds.max_pressure.to_numpy() == pytest.approx(expected().max_pressure.magnitude, rel=1e-14)


def test_a_unit_of_the_file_that_is_unknown_can_be_stated(tmp_path: Path) -> None:
    frame().rename(columns={"Fz [N]": "Fz [Newtons!]"}).to_csv(tmp_path / "run.csv", index=False)
    with pytest.raises(wl.DataError, match=r"normal_force: column 'Fz \[Newtons!\]' has a unit that is unknown"):
        swept(tmp_path / "run.csv")
    ds = swept(tmp_path / "run.csv", columns={**COLUMNS, "normal_force": "Fz [N]"})
    assert ds.wear_rate.to_numpy().tolist() == expected().wear_rate.magnitude.tolist()


def test_a_head_may_begin_with_a_minus(tmp_path: Path) -> None:
    table = frame().assign(**{"-slip [-]": CREEPAGE / 2.0})
    table.to_csv(tmp_path / "run.csv", index=False)
    ds = swept(tmp_path / "run.csv", columns={**COLUMNS, "creepage": "-slip [-]"})
    assert ds.creepage.to_numpy() == pytest.approx(CREEPAGE / 2.0, rel=1e-15)


def test_a_kept_column_may_have_gaps_and_any_unit(tmp_path: Path) -> None:
    table = frame().rename(columns={"Time [s]": "Time [since Monday]"})
    table.iloc[4, 0] = np.nan
    table.to_csv(tmp_path / "run.csv", index=False)
    ds = swept(tmp_path / "run.csv")
    assert np.flatnonzero(np.isnan(ds.time)).tolist() == [4]
    assert ds.time.attrs["units"] == "since Monday"


LINE_9 = "0.875,5000,-0.01,dry"


def line_9(text: str) -> Callable[[list[str]], list[str]]:
    return lambda lines: [*lines[:8], text, *lines[9:]]


WRONG: dict[str, tuple[Callable[[list[str]], list[str]], dict[str, Any], str]] = {
    "text": (line_9("1,n.a.,-0.01,dry"), {}, r"in:\n  line 9, column 'Fz \[N\]': 'n.a.' is not a number$"),
    "bool": (line_9("1,True,-0.01,dry"), {}, r"in:\n  line 9, column 'Fz \[N\]': 'True' is not a number$"),
    "missing": (line_9("1,,-0.01,dry"), {}, r"line 9, column 'Fz \[N\]': is missing$"),
    "nan": (line_9("1,5000,nan,dry"), {}, r"line 9, column 'slip \[-\]': 'nan' is not a number$"),
    "two": (
        lambda lines: line_9(",,-0.01,dry")([*lines[:49], "1,x,y,dry", *lines[50:]]),
        {},
        r"line 9, .*'Fz \[N\]': is missing\n  line 50, .*'Fz \[N\]': 'x' is .*\n  line 50, .*'slip \[-\]': 'y'",
    ),
    "after an empty line": (
        lambda lines: line_9("1,,-0.01,dry")([*lines[:4], "", *lines[4:]]),
        {},
        r"line 9, column 'Fz \[N\]': is missing$",
    ),
    "after a cell of two lines": (
        lambda lines: line_9("1,,-0.01,dry")([*lines[:4], '1,5000,-0.01,"a', 'b"', *lines[6:]]),
        {},
        r"line 9, column 'Fz \[N\]': is missing$",
    ),
    "text in a kept column": (line_9("now,5000,-0.01,dry"), {}, r"line 9, column 'Time \[s\]': 'now' is not a number"),
    "decimal commas": (line_9("0,875,5000,-0.01,dry"), {}, "line 9: has 5 cells, but the header has 4; with decimal"),
    "cut off": (lambda lines: [*lines[:50], "6.125,50"], {}, "line 51, column 'slip"),
    "cut off beyond": (line_9("0.875,5000,-0.01"), {}, "line 9: has 3 cells, but the header has 4$"),
    "negative": (
        line_9("1,-5000,-0.01,dry"),
        {},
        r"line 9, column 'Fz \[N\]': normal_force: must be greater than zero",
    ),
    "large": (line_9("1,5000,-1.5,dry"), {}, r"line 9, column '-slip \[-\]': creepage: must not exceed 1 in magnitude"),
    "infinite": (line_9("1,inf,-0.01,dry"), {}, r"line 9, column 'Fz \[N\]': normal_force: must be finite"),
    "quotation mark": (line_9('1,5000,-0.01,"dry'), {}, "cannot be read as CSV: .*EOF inside string"),
    "empty": (lambda _: [], {}, "'bad.csv' is empty"),
    "no rows": (lambda lines: lines[:1], {}, "'bad.csv': has no rows"),
    "no unit": (
        lambda lines: ["Time,Fz,slip,note", *lines[1:]],
        {},
        r"in:\n  creepage: column 'slip' has no unit; write it in brackets, as in columns=\{.* \"-slip \[%\]\"\}"
        r"\n  normal_force: column 'Fz' has no unit; .* \"Fz \[kN\]\"\}$",
    ),
    "other unit": (
        lambda lines: lines,
        {"columns": {**COLUMNS, "normal_force": "Fz [kN]"}},
        r"column 'Fz \[N\]' has the unit 'N', but 'kN' is stated; keep one",
    ),
    "wrong dimension": (
        lambda lines: [lines[0].replace("[N]", "[m]"), *lines[1:]],
        {},
        r"line 2, column 'Fz \[m\]': normal_force: got .* m, which does not have the dimension of 'kN'",
    ),
    "no column": (
        lambda lines: lines,
        {"columns": {**COLUMNS, "normal_force": "Fzz"}},
        r"normal_force: there is no column 'Fzz'; did you mean 'Fz'\?\n  its columns are 'Time \[s\]', 'Fz \[N\]'",
    ),
    "a column twice": (
        lambda lines: [lines[0].replace("note", "Fz [N]"), *lines[1:]],
        {},
        r"normal_force: the column 'Fz' is there 2 times; rename all but one",
    ),
    "no condition": (lambda lines: lines, {"columns": {**COLUMNS, "lod": "Time"}}, "column 'lod': unknown condition"),
    "missing condition": (lambda lines: lines, {"columns": {"normal_force": "Fz"}}, "creepage: is missing"),
    "only kept": (lambda lines: lines, {"columns": {}}, "none of its columns is a condition"),
    "no name": (lambda lines: lines, {"keep": {"my time": "Time"}}, "keep.*'my time' is no name"),
    "kept twice": (lambda lines: lines, {"keep": {"creepage": "Time"}}, "creepage is given twice"),
    "given twice": (lambda lines: lines, {"normal_force": "5 kN"}, "normal_force is given twice"),
    "no mapping": (
        lambda lines: lines,
        {"columns": ["Fz"]},
        r"columns: must map names to columns, such as .*got \['Fz'",
    ),
    "kept as output": (
        lambda lines: lines,
        {"keep": {"wear_rate": "Time"}, "outputs": ["wear_rate"]},
        "outputs: 'wear_rate' is one of the conditions, and among the coordinates",
    ),
}


@pytest.mark.parametrize("name", WRONG)
def test_wrong_files_are_refused_with_line_and_column(name: str, folder: Path) -> None:
    edit, changes, message = WRONG[name]
    lines = edit([line.replace("\r", "") for line in frame().to_csv(index=False).splitlines()])
    Path(folder, "bad.csv").write_text("\n".join(lines), encoding="utf-8")
    with pytest.raises(wl.InputError, match=message):
        swept("bad.csv", **changes)


def test_the_same_fault_in_every_row_is_that_of_the_column(tmp_path: Path) -> None:
    frame().assign(**{"Fz [N]": -5.0}).to_csv(tmp_path / "run.csv", index=False)
    with pytest.raises(wl.DataError, match=r"run.csv', column 'Fz \[N\]': normal_force: must be greater than zero"):
        swept(tmp_path / "run.csv")


def test_a_fault_far_down_is_found_in_any_piece(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(table_files, "ROWS", 7)
    monkeypatch.setattr("wearlaw.sweeping.sweep.SAMPLE", 5)
    monkeypatch.setattr("wearlaw.sweeping.sweep.BLOCK", 11)
    table = frame()
    table.loc[63, "Fz [N]"] = -1.0
    table.to_csv(tmp_path / "run.csv", index=False)
    with pytest.raises(wl.DataError, match=r"line 65, column 'Fz \[N\]': .*got -1.000 N"):
        swept(tmp_path / "run.csv")
    table.loc[63, "Fz [N]"] = np.nan
    table.to_csv(tmp_path / "run.csv", index=False)
    with pytest.raises(wl.DataError, match=r"line 65, column 'Fz \[N\]': is missing"):
        swept(tmp_path / "run.csv")


@pytest.mark.usefixtures("small_blocks")
@pytest.mark.parametrize("workers", [1, 2])
def test_a_row_that_only_its_block_shows_to_be_wrong_is_named(
    workers: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("wearlaw.sweeping.sweep.SAMPLE", 10)  # of a rig with several patches, before it starts
    table: Any = pd.DataFrame({"y [mm]": np.linspace(-5.0, 5.0, 60), "mu": 0.3})
    table.loc[33, "mu"] = -0.3
    table.to_csv(tmp_path / "run.csv", index=False)
    given: Any = {"load": "80 kN", "longitudinal_creepage": "0.2 %", "spin": "0.3 1/m"}
    columns = {"displacement": "y", "friction_coefficient": "mu"}
    predict: Any = Axle() | wl.contact_model("fastsim") | KTH
    with pytest.raises(wl.DataError, match="line 35, column 'mu': friction_coefficient: must be a positive"):
        wl.sweep(predict, tmp_path / "run.csv", columns=columns, workers=workers, **given)
    table["mu"] = 0.3
    ds = wl.sweep(predict, table.rename(columns={"y [mm]": "displacement [mm]", "mu": "friction_coefficient"}), **given)
    table.to_csv(tmp_path / "run.csv", index=False)
    found = wl.sweep(predict, tmp_path / "run.csv", columns=columns, workers=workers, **given)
    assert found.sizes == {"row": 60, "side": 2, "patch": 2}
    np.testing.assert_array_equal(found.wear_rate, ds.wear_rate)


def test_rows_of_other_formats_are_counted(tmp_path: Path) -> None:
    ds = dataset()
    ds.Fz[7], ds.slip[9] = np.nan, -2.0
    ds.to_netcdf(tmp_path / "bad.nc")
    with pytest.raises(wl.DataError, match=r"row 7 \(the first is row 0\), column 'Fz': is missing"):
        swept(tmp_path / "bad.nc")
    ds.Fz[7] = 5e3
    ds.to_netcdf(tmp_path / "worse.nc")
    with pytest.raises(wl.DataError, match=r"row 9 \(the first is row 0\), column '-slip': creepage: must not exceed"):
        swept(tmp_path / "worse.nc")


def test_files_of_other_kinds_and_damaged_ones_are_refused(tmp_path: Path) -> None:
    whole = tmp_path / "whole.nc"
    write_netcdf(whole)
    content = whole.read_bytes()
    for name, start, message in (
        ("none.csv", None, "cannot read '.*none.csv': No such file"),
        ("book.xlsx", b"PK\x03\x04", "is a workbook"),
        ("data.bin", b"\0\1\2", "is no text"),
        ("cut.nc", content[: len(content) // 2], "cannot be read as netCDF or zarr: "),
    ):
        if start is not None:
            (tmp_path / name).write_bytes(start)
        with pytest.raises(wl.DataError, match=message):
            swept(tmp_path / name)
    with pytest.raises(wl.DataError, match="is a folder and no zarr store"):
        swept(tmp_path)


def test_columns_of_a_dataset_lie_along_one_dimension(tmp_path: Path) -> None:
    dataset().assign(Fz=("other", LOAD, {"units": "N"})).to_netcdf(tmp_path / "run.nc")
    with pytest.raises(wl.DataError, match=r"must all lie along one dimension, got .*'Fz' along other"):
        swept(tmp_path / "run.nc")


def test_columns_of_a_file_have_one_dimension_each(tmp_path: Path) -> None:
    grid = {"Fz": (("time", "car"), np.full((3, 2), 5e3), {"units": "N"})}
    xr.Dataset({**grid, "slip": (("time", "car"), np.full((3, 2), -0.01), {"units": "1"})}).to_netcdf(
        tmp_path / "run.nc"
    )
    with pytest.raises(wl.DataError, match=r"must all lie along one dimension, got 'slip' along time × car, 'Fz'"):
        wl.sweep(predictor(), tmp_path / "run.nc", columns=COLUMNS, **FRICTION)


def test_coordinates_of_a_file_are_no_conditions_unless_they_are_mapped(tmp_path: Path) -> None:
    given = {"creepage": ("time", [0.01, 0.02], {"units": "1"}), "normal_force": ("time", [5e3, 6e3], {"units": "N"})}
    xr.Dataset(given, {"time": ("time", [0.0, 1.0], {"units": "s"})}).to_netcdf(tmp_path / "run.nc")
    ds = wl.sweep(predictor(), tmp_path / "run.nc", **FRICTION)
    assert ds.normal_force.to_numpy().tolist() == [5e3, 6e3]


def test_a_table_whose_index_has_several_levels_is_refused() -> None:
    with pytest.raises(wl.DataError, match=r"its index has several levels; call reset_index\(\)"):
        swept(frame().set_index(["Time [s]", "note"]))


def test_decimals_of_parquet_are_numbers(tmp_path: Path) -> None:
    pyarrow = pytest.importorskip("pyarrow")
    pytest.importorskip("pyarrow.parquet")
    force = pyarrow.array([Decimal("5000.25")], pyarrow.decimal128(9, 2))
    table = pyarrow.table({"creepage [-]": [0.01], "normal_force [N]": force})
    pyarrow.parquet.write_table(table, tmp_path / "run.parquet")
    ds = wl.sweep(predictor(), tmp_path / "run.parquet", **FRICTION)
    assert ds.normal_force.to_numpy().tolist() == [5000.25]


def test_parquet_of_text_or_damaged_is_refused(tmp_path: Path) -> None:
    pytest.importorskip("pyarrow")
    frame().astype({"Fz [N]": str}).to_parquet(tmp_path / "text.parquet")
    with pytest.raises(wl.DataError, match=r"column 'Fz \[N\]': is .*string, not numbers"):
        swept(tmp_path / "text.parquet")
    frame().to_parquet(tmp_path / "run.parquet")
    (tmp_path / "cut.parquet").write_bytes((tmp_path / "run.parquet").read_bytes()[:1000])
    with pytest.raises(wl.DataError, match="cannot be read as parquet"):
        swept(tmp_path / "cut.parquet")


def test_without_pyarrow_parquet_says_what_to_install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "run.parquet").write_bytes(b"PAR1")
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    monkeypatch.setitem(sys.modules, "pyarrow.parquet", None)
    with pytest.raises(wl.DataError, match=r'python -m pip install "wearlaw\[parquet\]"'):
        swept(tmp_path / "run.parquet")


def test_a_file_that_changes_while_it_is_read_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write_csv(tmp_path / "run.csv")
    pieces = CsvFile.pieces

    def growing(self: CsvFile, places: Any) -> Any:
        yield from pieces(self, places)
        with self.path.open("a", encoding="utf-8") as file:
            file.write("1,5000,-0.01,dry\n")

    monkeypatch.setattr(CsvFile, "pieces", growing)
    with pytest.raises(wl.DataError, match="was changed while it was read"):
        swept(tmp_path / "run.csv")


def test_a_sound_file_is_read_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for write in (write_csv, write_spreadsheet):
        write(tmp_path / "run.csv")
        with monkeypatch.context() as patched:
            patched.setattr(
                CsvFile, "_check_widths", lambda _: pytest.fail("all rows have as many cells as the header")
            )
            swept(tmp_path / "run.csv")


@pytest.mark.parametrize("argument", ["columns", "keep"])
def test_columns_belong_to_a_table(argument: str) -> None:
    changes: Any = {argument: {"creepage": "slip"}}
    with pytest.raises(wl.InputError, match=f"{argument}: belongs to a table"):
        wl.sweep(predictor(), creepage=Q([1, 2], "%"), normal_force="5 kN", **FRICTION, **changes)


@pytest.mark.usefixtures("small_blocks")
def test_an_interrupted_sweep_over_a_file_is_resumed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("zarr")
    write_csv(tmp_path / "run.csv")
    whole = swept(tmp_path / "run.csv", store=tmp_path / "whole.zarr").load()
    with monkeypatch.context() as patched:
        interrupted_after(3, patched)  # the first of which is reading the file
        with pytest.raises(KeyboardInterrupt):
            swept(tmp_path / "run.csv", store=tmp_path / "map.zarr")
    seen: list[int] = []
    monkeypatch.setattr("wearlaw.sweeping.progress.Bar.__call__", lambda _, points: seen.append(points))
    with pytest.warns(wl.ResumeWarning):
        resumed = swept(tmp_path / "run.csv", store=tmp_path / "map.zarr", resume=True)
    assert 0 < seen[1] < ROWS  # done before, and not again
    xr.testing.assert_identical(resumed.load(), whole)
    assert {path.name for path in tmp_path.iterdir()} == {"run.csv", "whole.zarr", "map.zarr"}


@pytest.mark.parametrize(("column", "name"), [("Fz [N]", "conditions.normal_force"), ("Time [s]", "kept.time")])
def test_a_changed_file_is_not_resumed(column: str, name: str, tmp_path: Path) -> None:
    pytest.importorskip("zarr")
    write_csv(tmp_path / "run.csv")
    swept(tmp_path / "run.csv", store=tmp_path / "map.zarr")
    table = frame()
    table.loc[50, column] += 1e-3
    table.to_csv(tmp_path / "run.csv", index=False)
    with pytest.raises(wl.OutputError, match=rf"since these have changed:\n  {name}: was 100 values.* of run.csv, SHA"):
        swept(tmp_path / "run.csv", store=tmp_path / "map.zarr", resume=True)


def test_numbers_on_disk_are_read_in_parts(tmp_path: Path) -> None:
    with (tmp_path / "numbers").open("w+b") as file:
        file.write(np.arange(5000.0).data)
        kept = points.OnDisk(file)
        assert (kept.size, kept.shape) == (5000, (5000,))
        assert kept[4990:6000:3].tolist() == [4990.0, 4993.0, 4996.0, 4999.0]
        assert kept[-1:].tolist() == [4999.0]


def peak_of(rows: int, folder: Path) -> int:
    """Return the peak memory of a sweep from a file of many rows into a store [bytes]."""
    frame().sample(rows, replace=True, random_state=1).to_csv(folder / "run.csv", index=False)
    tracemalloc.start()
    try:
        swept(folder / "run.csv", store=folder / f"{rows}.zarr", outputs=["wear_rate"])
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


def test_four_times_the_rows_take_no_more_memory(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("zarr")
    monkeypatch.setattr(table_files, "ROWS", 1000)
    monkeypatch.setattr(points, "BLOCK", 1000)
    monkeypatch.setattr("wearlaw.sweeping.sweep.BLOCK", 1000)
    monkeypatch.setattr("wearlaw.sweeping.provenance.BLOCK", 1000)
    peak_of(2000, tmp_path)  # imports
    few, many = peak_of(40_000, tmp_path), peak_of(160_000, tmp_path)
    assert many < few + 120_000  # a byte for each row; one column of doubles would take eight


def test_the_mapping_of_a_table_is_checked_as_a_whole() -> None:
    heads = [table_files.Head("a [N]"), table_files.Head("b")]
    found = tables.uses("table", heads, {"normal_force": "-a"}, {"other": "b"})
    assert found == [
        tables.Use("other", 1, None, 1.0, True),
        tables.Use("normal_force", 0, "N", -1.0, False),
    ]


def test_a_file_that_is_no_table_is_named(tmp_path: Path) -> None:
    text = tmp_path / "notes.txt"
    text.write_text("hello world\nthis is text\n")
    with pytest.raises(wl.ConditionsError, match=r"table '.*notes\.txt', column 'hello world': unknown condition"):
        wl.sweep(predictor(), text, **FRICTION)
    csv = tmp_path / "good.csv"
    csv.write_text("normal_force [N]\n5000\n")
    with pytest.raises(wl.ConditionsError, match=r"^crepage: unknown condition; did you mean 'creepage'"):
        wl.sweep(predictor(), csv, crepage="1 %", **FRICTION)


def test_a_folder_that_is_no_zarr_store_is_named(tmp_path: Path) -> None:
    with pytest.raises(wl.DataError, match=r"'.*' is a folder and no zarr store; give the path of a file or of a"):
        wl.sweep(predictor(), tmp_path, **FRICTION)
