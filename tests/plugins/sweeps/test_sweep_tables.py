"""Sweeps over tables in files: formats, columns, units, signs, errors by line and column, and long files."""

from __future__ import annotations

import tracemalloc
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import xarray as xr

import wearlaw as wl
from tests.core.axles import KTH, Axle
from tests.plugins.sweeps.sweeps import interrupted_after, predictor, told
from wearlaw import Q
from wearlaw.errors import DataError, OutputError, ResumeWarning
from wearlaw_apps.sweeps import plan, points  # private: small blocks

ROWS = 100
RANDOM = np.random.default_rng(5)
# Of few digits, which older versions of pandas read exactly too.
CREEPAGE, LOAD = RANDOM.uniform(1e-3, 5e-2, ROWS).round(9), RANDOM.uniform(3e3, 8e3, ROWS).round(6)
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


def of_csv(folder: Path) -> Any:
    frame().to_csv(folder / "run", index=False)
    return folder / "run"


def of_netcdf(folder: Path) -> Any:
    dataset().to_netcdf(folder / "run")
    return xr.open_dataset(folder / "run", decode_times=False)


@pytest.mark.usefixtures("small_blocks")
@pytest.mark.parametrize("table_of", [of_csv, of_netcdf], ids=lambda one: one.__name__)
@pytest.mark.parametrize("stored", [False, True])
def test_a_file_gives_what_its_arrays_give(
    table_of: Callable[[Path], Any], stored: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("wearlaw_apps.tables.CELLS", 28)  # private: tables in small pieces
    if stored:
        pytest.importorskip("zarr")
    ds = swept(table_of(tmp_path), store=tmp_path / "map.zarr" if stored else None)
    r = expected()
    assert ds.creepage.to_numpy().tolist() == CREEPAGE.tolist()
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


@pytest.mark.parametrize("column", ["Fz [kN]", "Fz"])
def test_a_unit_comes_from_the_file_or_from_the_user(column: str, tmp_path: Path) -> None:
    table = frame().rename(columns={"Fz [N]": column})
    table[column] /= 1e3
    table.to_csv(tmp_path / "run.csv", index=False)
    ds = swept(tmp_path / "run.csv", columns={**COLUMNS, "normal_force": "Fz [kN]"}, outputs=["max_pressure"])
    assert ds.max_pressure.to_numpy() == pytest.approx(expected().max_pressure.magnitude, rel=1e-14)


def test_a_kept_column_may_have_gaps_and_any_unit(tmp_path: Path) -> None:
    table = frame().rename(columns={"Time [s]": "Time [since Monday]"})
    table.iloc[4, 0] = np.nan
    table.to_csv(tmp_path / "run.csv", index=False)
    ds = swept(tmp_path / "run.csv")
    assert np.flatnonzero(np.isnan(ds.time)).tolist() == [4]
    assert ds.time.attrs["units"] == "since Monday"


def line_9(text: str) -> Callable[[list[str]], list[str]]:
    return lambda lines: [*lines[:8], text, *lines[9:]]


WRONG: dict[str, tuple[Callable[[list[str]], list[str]], dict[str, Any], str]] = {
    "missing": (line_9("1,,-0.01,dry"), {}, r"line 9, column 'Fz \[N\]': is missing$"),
    "two": (
        lambda lines: line_9(",,-0.01,dry")([*lines[:49], "1,x,y,dry", *lines[50:]]),
        {},
        r"line 9, .*'Fz \[N\]': is missing(.|\n)*line 50, .*'Fz \[N\]': 'x'",
    ),
    "text in a kept column": (line_9("now,5000,-0.01,dry"), {}, r"line 9, column 'Time \[s\]': 'now' is not a number"),
    "decimal commas": (line_9("0,875,5000,-0.01,dry"), {}, "line 9: has 5 cells, not 4"),
    "cut off": (lambda lines: [*lines[:50], "6.125,50"], {}, "line 51, column 'slip"),
    "negative": (line_9("1,-5000,-0.01,dry"), {}, r"line 9, column 'Fz \[N\]': normal_force: "),
    "large": (line_9("1,5000,-1.5,dry"), {}, r"line 9, column '-slip \[-\]': creepage: "),
    "infinite": (line_9("1,inf,-0.01,dry"), {}, r"line 9, column 'Fz \[N\]': normal_force: must be finite"),
    "no rows": (lambda lines: lines[:1], {}, "'bad.csv': has no rows"),
    "no unit": (
        lambda lines: ["Time,Fz,slip,note", *lines[1:]],
        {},
        r"creepage: column 'slip'.*\n.*normal_force: column 'Fz'",
    ),
    "wrong dimension": (
        lambda lines: [lines[0].replace("[N]", "[m]"), *lines[1:]],
        {},
        r"line 2, column 'Fz \[m\]'",
    ),
    "no column": (
        lambda lines: lines,
        {"columns": {**COLUMNS, "normal_force": "Fzz"}, "keep": {"t": "Tme [s]"}},
        r"t: .*did you mean 'Time \[s\]'(.|\n)*normal_force: .*did you mean 'Fz'",
    ),
    "no condition": (
        lambda lines: lines,
        {"columns": {**COLUMNS, "lod": "note"}},
        "column 'note': lod: unknown condit",
    ),
    "missing condition": (lambda lines: lines, {"columns": {"normal_force": "Fz"}}, "creepage: is missing"),
    "only kept": (lambda lines: lines, {"columns": {}}, "none of its columns is a condition"),
    "kept twice": (lambda lines: lines, {"keep": {"creepage": "Time"}}, "creepage is given twice"),
    "given twice": (lambda lines: lines, {"normal_force": "5 kN"}, "normal_force is given twice"),
    "kept as output": (
        lambda lines: lines,
        {"keep": {"wear_rate": "Time"}, "outputs": ["wear_rate"]},
        "wear_rate",
    ),
}


@pytest.mark.parametrize("name", WRONG)
def test_wrong_files_are_refused_with_line_and_column(name: str, folder: Path) -> None:
    edit, changes, message = WRONG[name]
    lines = edit([line.replace("\r", "") for line in frame().to_csv(index=False).splitlines()])
    Path(folder, "bad.csv").write_text("\n".join(lines), encoding="utf-8")
    with pytest.raises(wl.InputError, match=message):
        swept("bad.csv", **changes)


def test_a_fault_far_down_is_found_in_any_piece(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("wearlaw_apps.tables.CELLS", 28)  # private: tables in small pieces
    monkeypatch.setattr("wearlaw_apps.sweeps.sweep.SAMPLE", 5)  # private: small blocks
    monkeypatch.setattr("wearlaw_apps.sweeps.sweep.BLOCK", 11)  # private: small blocks
    table = frame()
    table.loc[63, "Fz [N]"] = -1.0
    table.to_csv(tmp_path / "run.csv", index=False)
    with pytest.raises(DataError, match=r"line 65, column 'Fz \[N\]': .*got -1.000 N"):
        swept(tmp_path / "run.csv")
    table.loc[63, "Fz [N]"] = np.nan
    table.to_csv(tmp_path / "run.csv", index=False)
    with pytest.raises(DataError, match=r"line 65, column 'Fz \[N\]': is missing"):
        swept(tmp_path / "run.csv")


@pytest.mark.usefixtures("small_blocks")
@pytest.mark.parametrize("workers", [1, 2])
def test_a_row_that_only_its_block_shows_to_be_wrong_is_named(
    workers: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(
        "wearlaw_apps.sweeps.sweep.SAMPLE", 10
    )  # private: of a rig with several patches, before it starts
    table: Any = pd.DataFrame({"y [mm]": np.linspace(-5.0, 5.0, 60), "mu": 0.3})
    table.loc[33, "mu"] = -0.3
    table.to_csv(tmp_path / "run.csv", index=False)
    given: Any = {"load": "80 kN", "longitudinal_creepage": "0.2 %", "spin": "0.3 1/m"}
    columns = {"displacement": "y", "friction_coefficient": "mu"}
    predict: Any = Axle() | wl.contact_model("fastsim") | KTH
    with pytest.raises(DataError, match="line 35, column 'mu': friction_coefficient: must be a positive"):
        wl.sweep(predict, tmp_path / "run.csv", columns=columns, workers=workers, **given)
    table["mu"] = 0.3
    ds = wl.sweep(predict, table.rename(columns={"y [mm]": "displacement [mm]", "mu": "friction_coefficient"}), **given)
    table.to_csv(tmp_path / "run.csv", index=False)
    found = wl.sweep(predict, tmp_path / "run.csv", columns=columns, workers=workers, **given)
    assert found.sizes == {"row": 60, "side": 2, "patch": 2}
    np.testing.assert_array_equal(found.wear_rate, ds.wear_rate)


def test_rows_of_tables_in_memory_are_counted() -> None:
    ds = dataset()
    ds.Fz[7], ds.slip[9] = np.nan, -2.0
    with pytest.raises(DataError, match=r"row 7 \(the first is row 0\), column 'Fz \[N\]': is missing"):
        swept(ds)
    ds.Fz[7] = 5e3
    with pytest.raises(DataError, match=r"row 9 \(the first is row 0\): creepage: must not exceed"):
        swept(ds)


def test_coordinates_of_a_dataset_are_no_conditions_unless_they_are_mapped() -> None:
    given = {"creepage": ("time", [0.01, 0.02], {"units": "1"}), "normal_force": ("time", [5e3, 6e3], {"units": "N"})}
    table = xr.Dataset(given, {"time": ("time", [0.0, 1.0], {"units": "s"})})
    ds = wl.sweep(predictor(), table, **FRICTION)
    assert ds.normal_force.to_numpy().tolist() == [5e3, 6e3]


@pytest.mark.parametrize("argument", ["columns", "keep"])
def test_columns_belong_to_a_table(argument: str) -> None:
    changes: Any = {argument: {"creepage": "slip"}}
    with pytest.raises(wl.InputError, match=f"{argument}: belongs to a table"):
        wl.sweep(predictor(), creepage=Q([1, 2], "%"), normal_force="5 kN", **FRICTION, **changes)


@pytest.mark.usefixtures("small_blocks")
def test_an_interrupted_sweep_over_a_file_is_resumed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("zarr")
    frame().to_csv(tmp_path / "run.csv", index=False)
    whole = swept(tmp_path / "run.csv", store=tmp_path / "whole.zarr").load()
    with monkeypatch.context() as patched:
        interrupted_after(3, patched)  # the first of which is reading the file
        with pytest.raises(KeyboardInterrupt):
            swept(tmp_path / "run.csv", store=tmp_path / "map.zarr")
    seen = told(monkeypatch)
    with pytest.warns(ResumeWarning):
        resumed = swept(tmp_path / "run.csv", store=tmp_path / "map.zarr", resume=True)
    assert 0 < seen[1] < ROWS  # done before, and not again
    xr.testing.assert_identical(resumed.load(), whole)
    assert {path.name for path in tmp_path.iterdir()} == {"run.csv", "whole.zarr", "map.zarr"}


@pytest.mark.parametrize(("column", "name"), [("Fz [N]", "conditions.normal_force"), ("Time [s]", "kept.time")])
def test_a_changed_file_is_not_resumed(column: str, name: str, tmp_path: Path) -> None:
    pytest.importorskip("zarr")
    frame().to_csv(tmp_path / "run.csv", index=False)
    swept(tmp_path / "run.csv", store=tmp_path / "map.zarr")
    table = frame()
    table.loc[50, column] += 1e-3
    table.to_csv(tmp_path / "run.csv", index=False)
    with pytest.raises(OutputError, match=rf"since these have changed:\n  {name}: was 100 values.* of run.csv, SHA"):
        swept(tmp_path / "run.csv", store=tmp_path / "map.zarr", resume=True)


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
    monkeypatch.setattr("wearlaw_apps.tables.CELLS", 4000)  # private: tables in small pieces
    monkeypatch.setattr(points, "BLOCK", 1000)
    monkeypatch.setattr(plan, "LARGEST", 0)
    monkeypatch.setattr("wearlaw_apps.sweeps.sweep.BLOCK", 1000)  # private: small blocks
    monkeypatch.setattr("wearlaw_apps.sweeps.provenance.BLOCK", 1000)  # private: small blocks
    peak_of(2000, tmp_path)  # imports
    few, many = peak_of(40_000, tmp_path), peak_of(160_000, tmp_path)
    assert many < few + 120_000  # a byte for each row; one column of doubles would take eight


def test_a_file_that_is_no_table_is_named(tmp_path: Path) -> None:
    text = tmp_path / "notes.txt"
    text.write_text("hello world\nthis is text\n")
    with pytest.raises(
        wl.ConditionsError, match=r"table '.*notes\.txt', column 'hello world': hello world: unknown condition"
    ):
        wl.sweep(predictor(), text, **FRICTION)
    csv = tmp_path / "good.csv"
    csv.write_text("normal_force [N]\n5000\n")
    with pytest.raises(wl.ConditionsError, match=r"^crepage: unknown condition; did you mean 'creepage'"):
        wl.sweep(predictor(), csv, crepage="1 %", **FRICTION)


WHEELS, CONTACTS = ("1L", "1R"), ("1", "2")
BY_PATTERN = {"normal_force": "W{wheel}.{contact} N", "creepage": "-c{contact} xi of {wheel}"}


def wheels(folder: Path, **changes: Any) -> Path:
    """Write a file with two wheels and two contacts in a row, and a row of units."""
    values = {"Time": TIME}
    for number, (wheel, contact) in enumerate((wheel, contact) for wheel in WHEELS for contact in CONTACTS):
        values[f"W{wheel}.{contact} N"] = (1.0 + 0.1 * number) * LOAD
        values[f"c{contact} xi of {wheel}"] = -CREEPAGE / (1.0 + number)
    table = pd.DataFrame(values | changes)
    units = {name: "N" if str(name).endswith("N") else "s" if name == "Time" else "-" for name in table}
    pd.concat([pd.DataFrame([units]), table.map("{:.17g}".format)]).to_csv(folder / "wheels.csv", index=False)
    return folder / "wheels.csv"


@pytest.mark.usefixtures("small_blocks")
@pytest.mark.parametrize("where", ["memory", "store"])
def test_a_pattern_names_the_columns_of_all_wheels_and_contacts(tmp_path: Path, where: str) -> None:
    given: Any = {"columns": BY_PATTERN, "keep": KEEP, **FRICTION, "outputs": ["wear_rate"]}
    more: Any = {"store": tmp_path / "wheels.zarr", "workers": 2} if where == "store" else {}
    found = wl.sweep(predictor(), wheels(tmp_path), **given, **more)
    assert dict(found.sizes) == {"row": ROWS, "wheel": 2, "contact": 2}
    assert found.time.dims == ("row",)
    for number, (wheel, contact) in enumerate((wheel, contact) for wheel in WHEELS for contact in CONTACTS):
        at = {"normal_force": Q((1.0 + 0.1 * number) * LOAD, "N"), "creepage": Q(CREEPAGE / (1.0 + number), "")}
        here = found.sel(wheel=wheel, contact=contact)
        assert here.normal_force.values == pytest.approx(at["normal_force"].magnitude, rel=1e-15)
        assert here.wear_rate.values == pytest.approx(expected(**at).wear_rate.m_as(here.wear_rate.units), rel=1e-12)
    assert list(found.wheel.values) == list(WHEELS)


@pytest.mark.parametrize(
    ("changes", "columns", "message"),
    [
        ({}, {"normal_force": "V{wheel} N"}, r"normal_force: no column fits 'V\{wheel\} N'"),
        ({"W1L.3 N": 1.0}, {}, "there is no column 'W1R.3 N'; every wheel and contact needs one"),
        ({"W1R.2 N": -LOAD}, {}, r"line 3, column 'W\{wheel\}\.\{contact\} N': normal_force: "),
        ({}, {"creepage": "c1 xi of 1L [%]"}, "creepage: column 'c1 xi of 1L .*has the units '%' and"),
    ],
)  # fmt: skip
def test_what_does_not_fit_a_pattern_is_named(tmp_path: Path, changes: Any, columns: Any, message: str) -> None:
    with pytest.raises(wl.InputError, match=message):
        wl.sweep(predictor(), wheels(tmp_path, **changes), columns=BY_PATTERN | columns, **FRICTION)


def test_a_file_that_is_no_table_shows_how_it_was_read(tmp_path: Path) -> None:
    (tmp_path / "run.out").write_text("own run\nMon Jan 1 2024\n1 2 3\n")
    with pytest.raises(
        DataError, match=r"none of its columns is a condition; .* it begins: own run; Mon Jan 1 2024; 1 2"
    ):
        wl.sweep(predictor(), tmp_path / "run.out", keep={"own": "own run"}, **FRICTION)
