"""A wheel that bears no load: its results are zero, and those of all others stay."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pandas as pd
import pytest

import wearlaw as wl
from wearlaw import Q

pytestmark = pytest.mark.filterwarnings("ignore::wearlaw.RangeWarning", "ignore::wearlaw.CalibrationWarning")

RIG = wl.WheelRail(wheel_radius="460 mm", rail_head_radius="300 mm", material=wl.steel(), rolling_speed="25 m/s")
RUN = pd.DataFrame(
    {
        "normal_force [N]": [0.0, 0.0, 4000.0, 9000.0, 0.0],
        "longitudinal_creepage [-]": [0.0, 0.004, 0.004, 0.005, 0.0],
        "lateral_creepage [-]": [0.0, 0.0, 0.002, 0.003, 0.0],
        "spin [1/m]": [0.0, 0.0, 1.9, 1.9, 0.0],
        "friction_coefficient": [0.3, 0.3, 0.3, 0.3, 0.3],
    }
)
LIFTED = RUN["normal_force [N]"].to_numpy() == 0.0


def pipeline(model: str = "fastsim") -> wl.Pipeline[...]:
    law = wl.wear_law("usfd", fitted_for="fastsim" if model == "fastsim" else "exact")
    return RIG | wl.contact_model(model) | law


def conditions(table: pd.DataFrame) -> dict[str, Any]:
    columns = {head.partition(" [")[0]: (head, head.partition(" [")[2].rstrip("]")) for head in map(str, table)}
    values = {name: (table[head].to_numpy(), unit) for name, (head, unit) in columns.items()}
    return {name: Q(value, "" if unit == "-" else unit) if unit else value for name, (value, unit) in values.items()}


@pytest.mark.parametrize("model", ["fastsim", "strip_theory"])
def test_results_of_a_lifted_wheel_are_zero_and_others_stay(model: str) -> None:
    predict = pipeline(model)
    every, loaded = predict(**conditions(RUN)), predict(**conditions(RUN[~LIFTED]))
    expected = loaded.to_dataset()
    for name, values in every.to_dataset().data_vars.items():
        assert not values.values[LIFTED].any(), name
        assert values.values[~LIFTED] == pytest.approx(expected[name].values, rel=1e-12), name
    assert len(every.to_dataframe()) == len(RUN)
    for body in ("wheel", "rail"):
        depth = every.wear_profile(body)["depth"].values
        assert not depth[LIFTED].any()
        assert depth[~LIFTED] == pytest.approx(loaded.wear_profile(body)["depth"].values, rel=1e-12)
        assert not every[0].mass_lost("1 km", body).magnitude


def test_a_lifted_wheel_alone_has_results() -> None:
    r = pipeline()(**conditions(RUN[:1].iloc[[0]]) | {"normal_force": "0 N"})
    for name, values in r.to_dataset().data_vars.items():
        assert not values.values.any(), name
    assert not pipeline()(max_pressure="0 MPa", longitudinal_creepage="1 %", friction_coefficient=0.3).wear_rate.m


def test_a_run_with_a_lifted_wheel(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """In blocks of one row, some of which have no contact; a run may also be all of such rows."""
    expected = pipeline()(**conditions(RUN[~LIFTED])).mass_per_distance.m_as("ug/m")
    RUN.to_csv(tmp_path / "run.csv", index=False)
    monkeypatch.setattr("wearlaw_apps.sweeps.points.BLOCK", 1)  # private: small blocks
    for store in (None, tmp_path / "run.zarr"):
        with wl.sweep(pipeline(), tmp_path / "run.csv", store=store) as found:
            assert found["mass_per_distance"].values[~LIFTED] == pytest.approx(expected, rel=1e-12)
            for name, values in found.data_vars.items():
                assert not values.values[LIFTED].any(), name
    assert not wl.sweep(pipeline(), RUN[LIFTED].reset_index(drop=True))["mass_per_distance"].values.any()


def test_a_load_below_zero_is_refused() -> None:
    with pytest.raises(wl.UnitError, match="normal_force: must not be negative"):
        pipeline()(normal_force="-1 N", longitudinal_creepage="1 %", friction_coefficient=0.3)
