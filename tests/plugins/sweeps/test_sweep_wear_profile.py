"""Sweeps that give the wear across a profile, and its sum weighted by shares."""

from __future__ import annotations

import shutil
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import xarray as xr

import wearlaw as wl
from tests.plugins.wheelset.wheelsets import wheelset
from wearlaw import Q
from wearlaw.errors import DataError, OutputError, ResumeWarning

pytestmark = pytest.mark.filterwarnings("ignore::wearlaw.RangeWarning", "ignore::wearlaw.CalibrationWarning")

AT = Q(np.arange(-45.0, 30.0, 0.5), "mm")
GIVEN: dict[str, Any] = {"vertical_load": "60 kN", "friction_coefficient": 0.3, "at": AT}
PLACES = np.array([-4.0, -1.0, 0.5, 2.0, 5.0, 5.5, 3.0])
SHARES = np.array([0.1, 0.2, 0.3, 0.1, 0.1, 0.1, 0.1])
TABLE = pd.DataFrame({"lateral_displacement [mm]": PLACES, "share [%]": 100.0 * SHARES})
with warnings.catch_warnings():
    warnings.simplefilter("ignore", wl.CalibrationWarning)
    PREDICT = wheelset() | wl.contact_model("fastsim") | wl.wear_law("usfd", fitted_for="fastsim")


def single() -> wl.Prediction:
    return PREDICT(lateral_displacement=Q(PLACES, "mm"), vertical_load="60 kN", friction_coefficient=0.3)


@pytest.mark.parametrize("body", ["wheel", "rail"])
def test_profiles_have_the_names_of_conditions(body: str) -> None:
    found = wl.wear_profiles(PREDICT, lateral_displacement=Q(PLACES, "mm"), body=body, **GIVEN)
    assert found["depth"].dims == ("lateral_displacement", "side", "profile_position")
    expected = single().wear_profile(body, at=AT)
    for name in ("depth", "sliding_distance"):
        value = expected[name]
        assert found[name].values == pytest.approx(Q(value.values, value.units).m_as(found[name].units), rel=1e-12)


def test_sum_is_weighted_by_the_shares() -> None:
    found = wl.wear_profiles(PREDICT, TABLE, share="share [%]", **GIVEN)
    one = single()
    assert found["depth"].dims == ("side", "profile_position")
    expected = np.tensordot(SHARES, one.wear_profile("wheel", at=AT)["depth"].values, axes=1)
    assert found["depth"].values == pytest.approx(expected, rel=1e-12)
    mass = SHARES @ np.nansum(one.mass_lost("1 km", "wheel").m_as("mg"), axis=-1)
    assert found["mass"].values == pytest.approx(mass, rel=1e-12)
    assert found["mass"].attrs["units"] == "mg/km"


def test_sum_is_the_same_from_a_file_in_blocks(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("wearlaw_apps.sweeps.points.BLOCK", 300)  # private: small blocks
    TABLE.to_csv(tmp_path / "line.csv", index=False)
    found = wl.wear_profiles(PREDICT, tmp_path / "line.csv", share="share", **GIVEN)
    whole = wl.wear_profiles(PREDICT, TABLE, share="share", **GIVEN)
    assert found["depth"].values == pytest.approx(whole["depth"].values, rel=1e-12)


def test_sum_in_a_store_goes_on_after_an_interrupt(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("wearlaw_apps.sweeps.points.BLOCK", 300)  # private: small blocks
    given, path = {**GIVEN, "share": "share [%]"}, tmp_path / "sum.zarr"
    due = wl.wear_profiles(PREDICT, TABLE, store=path, **given)
    xr.testing.assert_identical(due, wl.wear_profiles(PREDICT, TABLE, **given))
    first, second, *others = sorted(path.glob("part_*"))
    assert others
    shutil.rmtree(first)
    (second / "depth/c/0/0").write_bytes(b"damaged")
    with pytest.raises(OutputError, match="resume"):
        wl.wear_profiles(PREDICT, TABLE, store=path, **given)
    with pytest.warns(ResumeWarning, match=f"{len(others)} of {len(others) + 2} blocks are kept"):
        xr.testing.assert_identical(due, wl.wear_profiles(PREDICT, TABLE, store=path, resume=True, **given))
    with xr.open_zarr(path, consolidated=False) as stored:
        xr.testing.assert_identical(stored.load(), due)
    with pytest.raises(OutputError, match="kept"):
        wl.wear_profiles(PREDICT, TABLE.iloc[::-1], store=path, resume=True, **given)


def test_profiles_in_a_store_are_those_in_memory(tmp_path: Path) -> None:
    given = {"lateral_displacement": Q(PLACES, "mm"), **GIVEN}
    with wl.wear_profiles(PREDICT, store=tmp_path / "profiles.zarr", **given) as stored:
        assert np.array_equal(stored["depth"], wl.wear_profiles(PREDICT, **given)["depth"])
        assert stored["profile_position"].values == pytest.approx(AT.magnitude)


def test_profiles_stand_beside_other_outputs(tmp_path: Path) -> None:
    given = {"lateral_displacement": Q(PLACES, "mm"), **GIVEN, "outputs": ["mass_per_distance"]}
    found = wl.wear_profiles(PREDICT, **given)
    assert found["depth"].dims == ("lateral_displacement", "side", "profile_position")
    mass = found["mass_per_distance"]
    assert mass.dims == ("lateral_displacement", "side", "patch")
    assert mass.values == pytest.approx(single().mass_per_distance.m_as(mass.units), rel=1e-12, nan_ok=True)
    with pytest.raises(wl.InputError, match=r"outputs: .*'wear_rat'"):
        wl.wear_profiles(PREDICT, **{**given, "outputs": ["wear_rat"]})
    with wl.wear_profiles(PREDICT, store=tmp_path / "both.zarr", **given) as stored:
        xr.testing.assert_equal(stored.load()[["depth", "mass_per_distance"]], found[["depth", "mass_per_distance"]])


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"share": "part"}, "no column 'part'"),
        ({"share": "share", "outputs": ["wear_rate"]}, "share: needs a table and no further outputs"),
        ({"share": "share", "at": None}, "at: "),
        ({"share": "share", "body": "axle"}, "axle"),
    ],
)
def test_wrong_sums_are_refused(options: dict[str, Any], message: str) -> None:
    with pytest.raises(wl.InputError, match=message):
        wl.wear_profiles(PREDICT, TABLE, **{**GIVEN, **options})


def test_a_sweep_names_the_verb_for_profiles() -> None:
    with pytest.raises(wl.InputError, match=r"outputs: wear across a profile is wl\.wear_profiles"):
        wl.sweep(PREDICT, TABLE, outputs=["wear_profile", "mass_per_distance"], vertical_load="60 kN")


def test_a_row_without_a_balance_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    """Few rounds balance the loads in the middle of the track, and do not on a flange."""
    monkeypatch.setattr("wearlaw_models.rigs.wheelset.stand.STEPS", 3)  # private: the rounds of a search
    table = pd.DataFrame({"lateral_displacement [mm]": [0.0, 6.31], "share": 0.5})
    with pytest.raises(DataError, match=r"row 1 .*lateral_displacement = 6.31 mm.*no normal forces balance"):
        wl.wear_profiles(PREDICT, table, share="share", **GIVEN)


def test_a_row_in_which_the_wheel_climbs_is_named() -> None:
    table = pd.DataFrame({"lateral_displacement [mm]": [0.0, 1.0, 7.0], "share": [0.5, 0.25, 0.25]})
    with pytest.raises(DataError, match=r"row 2 .*lateral_displacement = 7 mm.*climbs"):
        wl.wear_profiles(PREDICT, table, share="share", **GIVEN)
