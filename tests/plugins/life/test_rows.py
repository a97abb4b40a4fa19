"""Rows of a line with their own speed, friction and loads, and shares from the times or distances of a run."""

from __future__ import annotations

import functools
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

import wearlaw as wl
from tests.plugins.life.test_life import GIVEN, last, line, pipeline
from tests.plugins.wheelset.wheelsets import wheelset
from wearlaw import Q
from wearlaw.errors import DataError
from wearlaw_apps.sweeps import shares  # private: small pieces

Y, SPEED = "lateral_displacement [mm]", "rolling_speed [km/h]"

pytestmark = pytest.mark.filterwarnings("ignore::wearlaw.RangeWarning", "ignore::wearlaw.CalibrationWarning")

ROWS = pd.DataFrame(
    {
        Y: [-2.0, 0.5, 3.0],
        SPEED: [40.0, 90.0, 160.0],
        "friction_coefficient": [0.15, 0.3, 0.45],
        "vertical_load_left [kN]": [70.0, 50.0, 40.0],
        "vertical_load_right [kN]": [40.0, 60.0, 70.0],
    }
)


def mass(states: pd.DataFrame | Path, predict: Any = None, **options: Any) -> float:
    """Return the mass that a wheel loses in the first kilometres."""
    return last(wl.wear_out(predict or pipeline(), states, over="10 km", **options), "mass [kg]")


def test_rows_wear_as_single_predictions_of_their_speed_friction_and_loads() -> None:
    """KTH's slip speeds see the rolling speed: each row is a rig of its own."""
    law = wl.wear_law("kth")
    share = np.array([0.2, 0.3, 0.5])
    each = []
    for row in ROWS.to_dict("records"):
        rig = wheelset(rolling_speed=Q(row[SPEED], "km/h"))
        loads = {f"vertical_load_{side}": Q(row[f"vertical_load_{side} [kN]"], "kN") for side in ("left", "right")}
        r = (rig | wl.contact_model("fastsim") | law)(
            lateral_displacement=Q(row[Y], "mm"), friction_coefficient=row["friction_coefficient"], **loads
        )
        each.append(np.nansum(r.mass_lost("10 km", "wheel").m_as("kg"), axis=-1).mean())
    predict = wheelset(rolling_speed="5 m/s") | wl.contact_model("fastsim") | law
    assert mass(ROWS.assign(share=share), predict) == pytest.approx(share @ each, rel=1e-9)


def test_a_speed_of_zero_names_its_row() -> None:
    states = ROWS.assign(share=1.0 / 3.0)
    states.loc[1, SPEED] = 0.0
    with pytest.raises(wl.InputError, match=r"row 1.*rolling_speed"):
        mass(states)


def test_equal_shares() -> None:
    states = line(5).drop(columns="share")
    assert mass(states, share="equal", **GIVEN) == pytest.approx(mass(states.assign(share=0.2), **GIVEN), rel=1e-12)


TIME = np.array([0.0, 1.0, 3.0, 4.0, 8.0])


@functools.cache
def mass_by_shares(speed: tuple[float, ...] | None, weights: tuple[float, ...]) -> float:
    """Return the mass on the states of a run whose shares are given."""
    states = line(5).assign(share=np.array(weights) / sum(weights))
    return mass(states if speed is None else states.assign(**{"rolling_speed [m/s]": speed}), **GIVEN)


@pytest.mark.parametrize("piece", [1_000_000, 2])
@pytest.mark.parametrize("from_file", [False, True])
@pytest.mark.parametrize(
    ("column", "speed", "expected"),
    [
        # half-way to the neighbours: 0.5, 1.5, 1.5, 2.5 and 2 of 8 s
        ("time [s]", None, (0.5, 1.5, 1.5, 2.5, 2.0)),
        ("distance [km]", (10.0, 20.0, 30.0, 40.0, 50.0), (0.5, 1.5, 1.5, 2.5, 2.0)),
        ("time [min]", (10.0, 20.0, 30.0, 40.0, 50.0), (5.0, 30.0, 45.0, 100.0, 100.0)),
    ],
)
def test_shares_of_a_run(
    column: str, speed: Any, expected: Any, from_file: bool, piece: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(shares, "PIECE", piece)
    states: Any = line(5).drop(columns="share")
    if speed is not None:
        states["rolling_speed [m/s]"] = speed
    run = states.assign(**{column: TIME})
    if from_file:
        run.to_csv(tmp_path / "run.csv", index=False)
        run = tmp_path / "run.csv"
    name = column.partition(" ")[0]
    assert mass(run, share=name, **GIVEN) == pytest.approx(mass_by_shares(speed, expected), rel=1e-12)


@pytest.mark.parametrize(("times", "row"), [([0.0, 1.0, 1.0, 2.0, 3.0], 2), ([0.0, 2.0, 3.0, 1.0, 4.0], 3)])
def test_times_must_grow(times: list[float], row: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shares, "PIECE", 2)
    with pytest.raises(DataError, match=f"row {row} .*column 'time'.*must grow"):
        mass(line(5).drop(columns="share").assign(**{"time [s]": times}), share="time", **GIVEN)


def test_a_sum_over_service_takes_times_too() -> None:
    states = line(5).drop(columns="share").assign(**{"time [s]": TIME})
    at = Q(np.arange(-50.0, 40.0, 0.5), "mm")
    found = wl.wear_profiles(pipeline(), states, at=at, share="time", **GIVEN)
    given = states.drop(columns="time [s]").assign(share=np.array([0.5, 1.5, 1.5, 2.5, 2.0]) / 8.0)
    expected = wl.wear_profiles(pipeline(), given, at=at, share="share", **GIVEN)
    assert found["mass"].values == pytest.approx(expected["mass"].values, rel=1e-12)
