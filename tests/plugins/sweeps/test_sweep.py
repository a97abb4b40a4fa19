"""Sweeps in one process: results, tables of operating points, and errors."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import xarray as xr

import wearlaw as wl
from tests.plugins.sweeps.sweeps import CONDITIONS, OUTPUTS, predictor
from wearlaw import Q


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
    words = {name: values.attrs["long_name"] for name, values in ds.variables.items()}
    assert words["tangential_force"] == "tangential force T"
    assert all(words[name].startswith(str(name).replace("_", " ")) for name in units)
    assert (ds.attrs["status"], ds.attrs["Conventions"]) == ("complete", "CF-1.8")
    assert json.loads(ds.attrs["provenance"])["plugins"]["wear law usfd"].startswith("wearlaw ")


def test_results_become_a_table_with_units_in_its_heads_which_a_sweep_reads() -> None:
    predict = predictor()
    ds = wl.sweep(predict, creepage=Q([1, 2], "%"), normal_force=Q([7, 8], "kN"), friction_coefficient=0.4)
    table = wl.to_dataframe(ds[["wear_rate", "traction_coefficient"]])
    assert list(table) == [
        "creepage [%]", "normal_force [kN]", "friction_coefficient", "wear_rate [ug/m/mm^2]", "traction_coefficient"
    ]  # fmt: skip
    assert table["wear_rate [ug/m/mm^2]"].tolist() == ds.wear_rate.values.ravel().tolist()
    again = wl.sweep(predict, table[["creepage [%]", "normal_force [kN]", "friction_coefficient"]])
    assert again.wear_rate.values.tolist() == table["wear_rate [ug/m/mm^2]"].tolist()
    (row,) = wl.to_dataframe(ds.isel(creepage=0, normal_force=1)).to_dict("records")
    assert (row["creepage [%]"], row["normal_force [kN]"]) == (1.0, 8.0)


HEADS = {
    "creepage [%]": [1.0, 2.0, 5.0],
    "max_pressure [MPa]": [900.0, 1000.0, 1200.0],
    "friction_coefficient": [0.3, 0.4, 0.5],
}


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


@pytest.mark.parametrize(
    ("table", "conditions", "named"),
    [
        (HEADS, {}, "table"),
        (FRAME.rename(columns={"creepage [%]": "creepage"}), {}, "creepage"),
        (FRAME.rename(columns={"creepage [%]": "crepage [%]"}), {}, "did you mean 'creepage'"),
        (FRAME.rename(columns={"creepage [%]": "creepage [N]"}), {}, "creepage"),
        (FRAME.assign(label=["a", "b", "c"]), {}, "label"),
        (FRAME.assign(creepage=[1, 2, 3]), {}, "creepage"),
        (FRAME, {"friction_coefficient": 0.4}, "friction_coefficient"),
        (with_attribute("1"), {}, "creepage"),
        (FRAME[:0], {}, "no rows"),
        (FRAME, {"rolling_speed": Q([1, 2], "m/s")}, "rolling_speed"),
        (FRAME.assign(**{"creepage [%]": [1.0, np.nan, 2.0]}), {}, "row 1 .*creepage"),
    ],
)
def test_wrong_tables_are_refused(table: Any, conditions: Any, named: str) -> None:
    with pytest.raises(wl.InputError, match=named):
        wl.sweep(predictor(), table, **conditions)


@pytest.mark.parametrize(
    ("named", "changes"),
    [
        ("creepage", {"creepage": Q([], "%")}),
        ("creepage", {"creepage": Q([1, np.nan], "%")}),
        ("friction_coefficient", {"friction_coefficient": [0.1, np.nan]}),
        ("normal_force", {"normal_force": Q([1, -2], "kN")}),
        ("creepage", {"creepage": Q([[1, 2]], "%")}),
        ("creepage", {"creepage": [0.01, 0.02]}),
        ("creepage", {"creepage": ["a"]}),
        ("did you mean 'creepage'", {"crepage": Q([1], "%")}),
        ("did you mean 'wear_rate'", {"outputs": ["wear_rat"]}),
        ("contact", {"outputs": ["contact"]}),
        ("creepage", {"outputs": ["creepage"]}),
        ("outputs", {"outputs": "wear_rate"}),
        ("workers", {"workers": 0}),
        ("resume", {"resume": True}),
        ("axis", {"creepage": "1 %", "normal_force": "1 kN", "friction_coefficient": 0.3}),
    ],
)
def test_wrong_sweeps_are_refused(named: str, changes: dict[str, Any]) -> None:
    with pytest.raises(wl.InputError, match=named):
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


@pytest.mark.usefixtures("small_blocks")
def test_warnings_are_those_of_one_prediction_of_all_points() -> None:
    wide: dict[str, Any] = {**CONDITIONS, "creepage": Q(np.linspace(1.0, 90.0, 20), "%"), "normal_force": "14 kN"}
    predict = predictor()
    with pytest.warns(wl.RangeWarning) as swept:
        ds = wl.sweep(predict, **wide)
    with pytest.warns(wl.RangeWarning) as predicted:
        predict(**{**wide, "creepage": wide["creepage"][:, None]})
    lines = [line for one in swept for line in str(one.message).splitlines()]
    assert lines == [str(one.message) for one in predicted]
    assert [one.category for one in swept] == [wl.PlasticityWarning, wl.RangeWarning]  # one a kind
    assert {one.filename for one in swept} == {__file__}
    assert ds.attrs["notes"].split("\n") == lines
