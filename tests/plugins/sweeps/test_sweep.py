"""Sweeps in one process: results, tables of operating points, and errors."""

from __future__ import annotations

import functools
import json
import os
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pint_pandas  # noqa: F401  (registers the type of columns)
import pytest
import xarray as xr

import wearlaw as wl
from tests.core.cases import Linear
from tests.plugins.sweeps.sweeps import CONDITIONS, OUTPUTS, predictor
from wearlaw import Q
from wearlaw_sweeps import room
from wearlaw_sweeps.points import BLOCK, Points, Varying


def points(*sizes: int) -> Points:
    return Points(
        {},
        {
            f"c{number}": Varying(f"c{number}", np.arange(size, dtype=np.float64), None)
            for number, size in enumerate(sizes)
        },
    )


@pytest.mark.usefixtures("small_blocks")
def test_a_sweep_is_the_prediction_at_all_combinations() -> None:
    predict = predictor()
    ds = wl.sweep(predict, **CONDITIONS, outputs=OUTPUTS)
    assert ds.sizes == {"creepage": 20, "normal_force": 3, "friction_coefficient": 4}
    for creepage, load, friction in ((0, 0, 0), (7, 2, 3), (19, 1, 2)):
        r = predict(
            creepage=CONDITIONS["creepage"][creepage],
            normal_force=CONDITIONS["normal_force"][load],
            friction_coefficient=CONDITIONS["friction_coefficient"][friction],
        )
        at = ds.isel(creepage=creepage, normal_force=load, friction_coefficient=friction)
        # Both are right to their error estimates; T is one formula of few operations.
        assert abs(float(at.wear_rate) - r.wear_rate.magnitude) <= 2 * r.wear_rate_error.magnitude
        assert float(at.tangential_force) == pytest.approx(r.tangential_force.magnitude, rel=1e-14)


def test_a_sweep_solves_each_point_once(monkeypatch: pytest.MonkeyPatch) -> None:
    model, solved, made = type(wl.contact_model("fastsim")), [], []
    solve_ellipse, problem = model.solve_ellipse, wl.WheelRail.problem

    def counted(self: Any, contact: wl.Problem) -> wl.Contact:
        solved.append(contact.size)
        return solve_ellipse(self, contact)

    @functools.wraps(problem)
    def counted_problem(self: Any, **conditions: Any) -> wl.Problem:
        made.append(conditions)
        return problem(self, **conditions)

    monkeypatch.setattr(model, "solve_ellipse", counted)
    monkeypatch.setattr(wl.WheelRail, "problem", counted_problem)
    rig = wl.WheelRail(
        wheel_radius=Q(460, "mm"),
        rail_head_radius=Q(300, "mm"),
        wheel_profile_radius=Q(np.inf, "mm"),
        material=wl.steel(),
        rolling_speed=Q(30, "m/s"),
    )
    predict = rig | wl.contact_model("fastsim") | Linear(slope=Q(1, "mm"))
    outputs = ["wear_rate", "mean_slip", "mass_per_distance", "longitudinal_force", "semi_axis_a", "patch_area"]
    load, creepage = Q([60.0, 80.0], "kN"), Q([0.1, 0.2, 0.3], "%")
    others: dict[str, Any] = {"friction_coefficient": 0.3, "lateral_creepage": Q(0.0, "%"), "spin": Q(0.1, "1/m")}
    ds = wl.sweep(predict, normal_force=load, longitudinal_creepage=creepage, **others, outputs=outputs)
    assert solved == [6]
    assert len(made) == 3  # along each axis to check the conditions, and for the only block
    units = {name: ds[name].attrs["units"] for name in outputs}
    assert units == {
        "wear_rate": "ug/m/mm^2",
        "mean_slip": "%",
        "mass_per_distance": "ug/m",
        "longitudinal_force": "N",
        "semi_axis_a": "mm",
        "patch_area": "mm^2",
    }


def test_results_are_labelled_as_the_conditions_were_given_with_units() -> None:
    ds = wl.sweep(predictor(), creepage=Q([1, 2], "%"), normal_force="7 kN", friction_coefficient=0.4, outputs=OUTPUTS)
    assert ds.creepage.to_numpy().tolist() == [1.0, 2.0]
    assert (ds.normal_force.item(), ds.friction_coefficient.item()) == (7.0, 0.4)
    units = {name: ds[name].attrs["units"] for name in ds.variables}
    assert units == {
        "creepage": "%",
        "normal_force": "kN",
        "friction_coefficient": "",
        "wear_rate": "ug/m/mm^2",
        "tangential_force": "N",
    }
    assert ds.attrs["status"] == "complete"
    assert json.loads(ds.attrs["provenance"])["plugins"]["wear law usfd"].startswith("wearlaw ")


@pytest.mark.parametrize(
    "sizes", [(1,), (BLOCK,), (3 * BLOCK + 1,), (7, BLOCK // 3, 5), (9, 11, 13), (2, 2 * BLOCK, 3)]
)
def test_blocks_cover_all_points_once_in_the_order_of_the_results(sizes: tuple[int, ...]) -> None:
    some = points(*sizes)
    numbers = np.arange(some.size).reshape(some.shape)
    blocks = some.blocks()
    assert [block.number for block in blocks] == list(range(len(blocks)))
    in_order = np.concatenate([numbers[block.slices].ravel() for block in blocks])
    assert (in_order == np.arange(some.size)).all()
    for block in blocks:
        assert (numbers[block.slices].ravel() == np.arange(some.size)[block.flat]).all()


@pytest.mark.parametrize("sizes", [(3 * BLOCK + 1,), (215, 216, 217), (1000, 1000), (100, 10, 100, 10)])
def test_blocks_of_large_sweeps_are_large_but_not_too_large(sizes: tuple[int, ...]) -> None:
    lengths = [block.flat.stop - block.flat.start for block in points(*sizes).blocks()]
    assert max(lengths) <= 200_000
    assert np.median(lengths) >= 20_000


def test_a_block_lays_out_the_conditions_of_its_points() -> None:
    some = points(2, 3)
    (block,) = some.blocks()
    laid_out = some.part(block.slices).conditions()
    assert laid_out["c0"].tolist() == [0, 0, 0, 1, 1, 1]
    assert laid_out["c1"].tolist() == [0, 1, 2, 0, 1, 2]


def test_a_wheel_on_a_rail_is_swept_as_well() -> None:
    rig = wl.WheelRail(wheel_radius="460 mm", rail_head_radius="300 mm", material=wl.steel(), rolling_speed="20 m/s")
    predict = rig | wl.contact_model("fastsim") | wl.wear_law("kth")
    given: Any = {"longitudinal_creepage": Q([0.1, 0.3], "%"), "normal_force": "80 kN", "friction_coefficient": 0.3}
    ds = wl.sweep(predict, **given, outputs=["wear_rate", "longitudinal_force"])
    assert ds.longitudinal_force.to_numpy() == pytest.approx(predict(**given).longitudinal_force.magnitude, rel=1e-14)


def test_a_condition_that_is_none_is_not_given() -> None:
    nothing: dict[str, Any] = {"max_pressure": None, "traction_coefficient": None}
    xr.testing.assert_identical(wl.sweep(predictor(), **CONDITIONS, **nothing), wl.sweep(predictor(), **CONDITIONS))


def test_a_number_is_a_coordinate_also_as_an_array_without_axes() -> None:
    given: Any = {"creepage": Q([1, 2], "%"), "normal_force": "7 kN"}
    due = wl.sweep(predictor(), **given, friction_coefficient=0.46)
    xr.testing.assert_identical(wl.sweep(predictor(), **given, friction_coefficient=np.array(0.46)), due)
    assert due.friction_coefficient.item() == 0.46


HEADS = {
    "creepage [%]": [1.0, 2.0, 5.0],
    "max_pressure [MPa]": [900.0, 1000.0, 1200.0],
    "friction_coefficient": [0.3, 0.4, 0.5],
}


def typed() -> Any:
    table: Any = pd.DataFrame({"creepage": HEADS["creepage [%]"], "max_pressure": HEADS["max_pressure [MPa]"]})
    table["creepage"] = table["creepage"].astype("pint[percent]")
    table["max_pressure"] = table["max_pressure"].astype("pint[MPa]")
    return table.assign(friction_coefficient=HEADS["friction_coefficient"])


def of_xarray() -> xr.Dataset:
    units = {"creepage": "%", "max_pressure": "MPa", "friction_coefficient": ""}
    columns = zip(units.items(), HEADS.values(), strict=True)
    return xr.Dataset({name: ("test", values, {"units": unit}) for (name, unit), values in columns})


def of_quantities() -> xr.Dataset:
    units = zip(("%", "MPa", ""), of_xarray().items(), strict=True)
    return xr.Dataset({name: ("test", Q(values.to_numpy(), unit)) for unit, (name, values) in units})


@pytest.mark.parametrize("make", [lambda: pd.DataFrame(HEADS), of_xarray, typed, of_quantities])
def test_a_table_is_taken_row_by_row(make: Any) -> None:
    predict = predictor()
    ds = wl.sweep(predict, make())
    r = predict(
        creepage=Q([1, 2, 5], "%"), max_pressure=Q([900, 1000, 1200], "MPa"), friction_coefficient=[0.3, 0.4, 0.5]
    )
    assert (abs(ds.wear_rate.to_numpy() - r.wear_rate.magnitude) <= 2 * r.wear_rate_error.magnitude).all()
    assert len(ds.dims) == 1


def test_a_table_keeps_the_names_of_its_rows_and_takes_conditions_for_all_of_them() -> None:
    table = pd.DataFrame(HEADS, index=pd.Index(["a", "b", "c"], name="test")).drop(columns="friction_coefficient")
    ds = wl.sweep(predictor(), table, friction_coefficient=0.4)
    assert ds.test.to_numpy().tolist() == ["a", "b", "c"]
    assert ds.creepage.dims == ("test",)
    assert ds.friction_coefficient.item() == 0.4


FRAME = pd.DataFrame(HEADS)


def with_attribute(unit: str) -> xr.Dataset:
    """Return the table with a unit of the creepage beside the one in its head."""
    ds = xr.Dataset({head: ("test", values) for head, values in HEADS.items()})
    ds["creepage [%]"].attrs["units"] = unit
    return ds


def test_what_a_dataset_holds_once_is_the_same_in_all_rows() -> None:
    ds = of_xarray()
    ds["friction_coefficient"] = 0.4
    ds["max_pressure"] = ((), 1000, {"units": "MPa"})
    due = wl.sweep(predictor(), ds[["creepage"]], max_pressure="1000 MPa", friction_coefficient=0.4)
    found = wl.sweep(predictor(), ds)
    assert found.max_pressure.to_numpy().tolist() == [1000.0] * found.wear_rate.size
    assert found.wear_rate.to_numpy().tolist() == due.wear_rate.to_numpy().tolist()


def test_the_same_unit_in_the_head_and_beside_it_is_no_contradiction() -> None:
    assert wl.sweep(predictor(), with_attribute("%")).creepage.to_numpy().tolist() == HEADS["creepage [%]"]


@pytest.mark.parametrize(
    ("table", "conditions", "message"),
    [
        (HEADS, {}, "must be a path, a pandas.DataFrame or an xarray.Dataset"),
        (FRAME.rename(columns={"creepage [%]": "creepage"}), {}, "creepage: got array.*has no unit"),
        (FRAME.rename(columns={"creepage [%]": "crepage [%]"}), {}, "crepage: unknown condition; did you mean 'cree"),
        (FRAME.rename(columns={"creepage [%]": "creepage [N]"}), {}, "creepage: .*not a ratio"),
        (FRAME.assign(label=["a", "b", "c"]), {}, "column 'label': label: unknown condition"),
        (FRAME.assign(creepage=[1, 2, 3]), {}, "creepage is given twice"),
        (FRAME, {"friction_coefficient": 0.4}, "friction_coefficient is given twice; keep one"),
        (with_attribute("1"), {}, r"column 'creepage \[%\]': has the units '%' and ''; keep one"),
        (FRAME[:0], {}, "table: has no rows"),
        (pd.DataFrame(), {}, "none of its columns is a condition"),
        (FRAME, {"rolling_speed": Q([1, 2], "m/s")}, "rolling_speed: beside a table it must be one value"),
        (FRAME.set_index(["creepage [%]", "max_pressure [MPa]"]), {}, "reset_index"),
        (FRAME.assign(**{"creepage [%]": [1.0, np.nan, 2.0]}), {}, r"row 1 .*, column 'creepage \[%\]': is missing"),
        (
            xr.Dataset({"creepage": (("a", "b"), np.ones((2, 2)))}),
            {"max_pressure": "1 GPa", "friction_coefficient": 0.4},
            "one dimension, got 'creepage' along a × b",
        ),
    ],
)  # fmt: skip
def test_wrong_tables_are_refused(table: Any, conditions: Any, message: str) -> None:
    with pytest.raises(wl.InputError, match=message):
        wl.sweep(predictor(), table, **conditions)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"creepage": Q([], "%")}, "creepage: the axis is empty; give at least one value"),
        ({"creepage": Q([1, np.nan], "%")}, r"creepage: must be a number, got nan % at index \[1\]"),
        ({"friction_coefficient": [0.1, np.nan]}, r"friction_coefficient: .*got nan at index \[1\]"),
        ({"normal_force": Q([1, -2], "kN")}, "normal_force: must be greater than zero"),
        ({"creepage": Q([[1, 2]], "%")}, r"creepage: must be one value or an axis of values, got .* shape \(1, 2\)"),
        ({"creepage": [0.01, 0.02]}, "creepage: got .*has no unit"),
        ({"creepage": ["a"]}, "creepage: .* is not a number with a unit"),
        ({"crepage": Q([1], "%")}, "crepage: unknown condition; did you mean 'creepage'"),
        ({"crepage": None}, "crepage: unknown condition; did you mean 'creepage'"),
        ({"outputs": ["wear_rat"]}, "outputs: there is no 'wear_rat' .*did you mean 'wear_rate'"),
        ({"outputs": ["contact"]}, "outputs: there is no 'contact'"),
        ({"outputs": ["creepage"]}, "outputs: 'creepage' is one of the conditions"),
        ({"outputs": "wear_rate"}, "outputs: must be a list of names"),
        ({"outputs": []}, "outputs: must be a list of names"),
        ({"outputs": 5}, "outputs: must be a list of names, .*, got 5"),
        ({"outputs": [5]}, r"outputs: must be a list of names, .*, got \[5\]"),
        ({"workers": 0}, "workers: must be the number of processes, at least 1; got 0"),
        ({"resume": True}, "resume: needs the store"),
        ({"creepage": "1 %", "normal_force": "1 kN", "friction_coefficient": 0.3}, "no condition is an axis"),
    ],
)
def test_wrong_sweeps_are_refused(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(wl.InputError, match=message):
        wl.sweep(predictor(), **{**CONDITIONS, **changes})


MANY: dict[str, Any] = {
    "creepage": Q(np.linspace(0.1, 1.0, 2**20), "%"),
    "normal_force": Q(np.linspace(1.0, 2.0, 2**20), "kN"),
    "friction_coefficient": 0.4,
}


def test_a_sweep_too_large_for_memory_says_what_it_needs_before_it_starts() -> None:
    with pytest.raises(wl.InputError, match=r"need 1.64e\+04 GiB of memory, but .* GiB are free; give a folder"):
        wl.sweep(predictor(), **MANY, outputs=OUTPUTS)


def test_a_sweep_too_large_for_the_disk_says_what_it_needs_and_leaves_nothing(tmp_path: Path) -> None:
    pytest.importorskip("zarr")
    with pytest.raises(wl.InputError, match=r"need 1.64e\+04 GiB on disk, but '.*' has .* GiB free"):
        wl.sweep(predictor(), **MANY, outputs=OUTPUTS, store=tmp_path / "map.zarr")
    assert not list(tmp_path.iterdir())


def test_where_the_free_memory_is_unknown_nothing_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(room, "available_memory", lambda: None)
    room.check_memory(2**80, "")


def test_the_free_memory_is_known_here() -> None:
    there = room.available_memory()
    assert there is not None
    assert 2**20 < there < 2**50


def test_without_proc_the_memory_is_all_of_the_machine_and_unknown_where_that_is_not_told_either(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def missing(*_: Any, **__: Any) -> str:
        raise FileNotFoundError

    monkeypatch.setattr(Path, "read_text", missing)
    monkeypatch.setattr(os, "sysconf", {"SC_PHYS_PAGES": 3 * 2**18, "SC_PAGE_SIZE": 4096}.__getitem__)
    assert room.available_memory() == 3 * 2**30
    monkeypatch.delattr(os, "sysconf")
    assert room.available_memory() is None


@pytest.mark.usefixtures("small_blocks")
def test_warnings_are_those_of_one_prediction_of_all_points() -> None:
    wide: dict[str, Any] = {**CONDITIONS, "creepage": Q(np.linspace(1.0, 90.0, 20), "%"), "normal_force": "14 kN"}
    predict = predictor()
    with pytest.warns(wl.RangeWarning) as swept:
        ds = wl.sweep(predict, **wide)
    with pytest.warns(wl.RangeWarning) as predicted:
        predict(**{**wide, "creepage": wide["creepage"][:, None]})
    assert [str(one.message) for one in swept] == [str(one.message) for one in predicted]
    assert [one.category for one in swept] == [wl.PlasticityWarning, *[wl.RangeWarning] * 3]
    assert {one.filename for one in swept} == {__file__}
    assert ds.attrs["notes"].split("\n") == [str(one.message) for one in swept]
