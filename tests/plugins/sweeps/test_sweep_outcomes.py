"""What a sweep keeps: laws of any outcome, and every quantity of an operating point that is none of the conditions."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

import wearlaw as wl
from tests.cases import Linear
from tests.core.outcome_laws import MIXED, Damage, Heat, Volume
from tests.core.stages import EXACT, FASTSIM, KTH, RAILS, RIG, silently
from wearlaw import Q
from wearlaw.errors import CompositionError

GIVEN: dict[str, Any] = {
    "creepage": Q([0.1, 0.5, 2.0], "%"),
    "normal_force": Q([5.0, 7.0], "kN"),
    "friction_coefficient": 0.4,
}
TOGETHER = silently(RIG, EXACT, KTH, Damage(), Heat())


def swept(predict: Any, **options: Any) -> xr.Dataset:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", wl.WearlawWarning)
        return wl.sweep(predict, **{**GIVEN, **options})


def test_by_default_a_sweep_holds_the_variables_of_a_prediction_and_the_outcomes_of_all_laws_first() -> None:
    ds = swept(TOGETHER)
    first = list(ds.data_vars)[:3]
    labels = {name: (ds[name].attrs["units"], ds[name].attrs["long_name"]) for name in first}
    assert labels == {
        "wear_rate": ("ug/m/mm^2", "wear rate"),
        "rcf_damage": ("", "rcf damage"),
        "heat_flux": ("W/mm^2", "heat flux"),
    }
    one = swept(TOGETHER, creepage=Q([2.0], "%"), normal_force=Q([7.0], "kN"))
    assert (ds.rcf_damage < 0.0).any(), "the damage has a sign"
    for name in labels:
        assert float(ds[name][-1, -1]) == pytest.approx(float(one[name].item()), rel=64 * np.finfo(np.float64).eps)


def test_laws_of_bodies_are_outputs_of_their_own() -> None:
    predict = silently(MIXED, EXACT, Volume(body="disc_1"), Volume(body="disc_2", factor=3.0))
    ds = swept(predict)
    assert {name: one.attrs["long_name"] for name, one in ds.data_vars.items() if "wear_rate" in str(name)} == {
        "wear_rate_disc_1": "wear rate of disc_1",
        "wear_rate_disc_2": "wear rate of disc_2",
    }
    alone = swept(silently(MIXED, EXACT, Volume(body="disc_2", factor=3.0)))
    assert alone.wear_rate.attrs["long_name"] == "wear rate of disc_2"
    np.testing.assert_allclose(alone.wear_rate, ds.wear_rate_disc_2, rtol=16 * np.finfo(np.float64).eps)
    ratio = ds.wear_rate_disc_2 / ds.wear_rate_disc_1
    np.testing.assert_allclose(ratio, 3.0 * 8800.0 / 7850.0, rtol=16 * np.finfo(np.float64).eps)
    with pytest.raises((wl.InputError, CompositionError), match="disc_2"):
        swept(predict, outputs=["wear_rate"])


def test_named_outputs_mix_outcomes_errors_and_other_properties() -> None:
    ds = swept(TOGETHER, outputs=["rcf_damage", "wear_index", "heat_flux_error"])
    assert [one.attrs["units"] for one in ds.data_vars.values()] == ["", "N", "W/mm^2"]
    whole = swept(TOGETHER)
    assert (ds.heat_flux_error > 0.0).all()
    assert (ds.heat_flux_error < 1e-9 * whole.heat_flux).all(), "of closed-form fields"


def test_a_large_sweep_keeps_the_outcomes_of_laws_alone_and_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    whole = swept(TOGETHER)
    assert {"tangential_force", "max_pressure", "stick_ratio", "mass_per_distance", "outside_range"} <= set(whole)
    assert "keeps only" not in whole.attrs["notes"]
    numbers = len(whole.data_vars) * 6
    monkeypatch.setattr("wearlaw_apps.sweeps.sweep.MOST", numbers)  # private: small blocks
    assert list(swept(TOGETHER)) == list(whole)
    monkeypatch.setattr("wearlaw_apps.sweeps.sweep.MOST", numbers - 1)  # private: small blocks
    cut = swept(TOGETHER)
    assert list(cut) == ["wear_rate", "rcf_damage", "heat_flux"]
    said = f"the sweep is large and keeps only the outcomes of laws: all outputs are {numbers:.2g} numbers"
    assert said in cut.attrs["notes"].splitlines()
    assert list(swept(TOGETHER, outputs=["wear_index"])) == ["wear_index"]


STAGED = silently(RIG, FASTSIM, wl.stage("patch_mean"), KTH, Damage(), Heat())
FINE: dict[str, Any] = {"creepage": Q(np.geomspace(0.1, 10.0, 12), "%")}


@pytest.mark.usefixtures("small_blocks")
def test_outcomes_are_the_same_in_a_store(tmp_path: Path) -> None:
    here = swept(STAGED, **FINE)
    stored = swept(STAGED, **FINE, store=tmp_path / "map.zarr")
    xr.testing.assert_equal(here, stored)
    assert {name: one.attrs for name, one in stored.data_vars.items()} == {
        name: one.attrs for name, one in here.data_vars.items()
    }
    xr.testing.assert_identical(stored, swept(STAGED, **FINE, store=tmp_path / "map.zarr", resume=True))


CREEPAGE = Q([0.1, 0.3], "%")
LINE: dict[str, Any] = {"creepage": CREEPAGE, "normal_force": "8 kN", "friction_coefficient": 0.3}
ELLIPSE: dict[str, Any] = {"longitudinal_creepage": CREEPAGE, "normal_force": "80 kN", "friction_coefficient": 0.3}
LAW = Linear(slope=Q(1.0, "mm"))
ON_DISCS, ON_RAILS = (rig | wl.contact_model("fastsim") | LAW for rig in (wl.TwinDisc.suros(), RAILS))
MEANS = RAILS | wl.contact_model("polach") | LAW


def test_what_only_a_wheel_on_a_rail_has_has_its_unit() -> None:
    units = {
        "longitudinal_force": "N",
        "lateral_force": "N",
        "semi_axis_a": "mm",
        "semi_axis_b": "mm",
        "cell_wear_index": "N",
        "mass_per_distance": "ug/m",
        "patch_area": "mm^2",
    }
    ds = wl.sweep(ON_RAILS, **ELLIPSE, outputs=list(units))
    assert {name: one.attrs["units"] for name, one in ds.data_vars.items()} == units


@pytest.mark.parametrize(("predict", "given"), [(ON_DISCS, LINE), (ON_RAILS, ELLIPSE), (MEANS, ELLIPSE)])
def test_the_contact_alone_is_swept_without_a_law(predict: wl.Pipeline[...], given: dict[str, Any]) -> None:
    contact = predict.without_law()
    alone, both = (wl.sweep(one, **given, outputs=["tangential_force"]) for one in (contact, predict))
    # The same forces by another way: fastsim's in closed form on a line, else the same sums.
    np.testing.assert_allclose(alone.tangential_force, both.tangential_force, rtol=64 * np.finfo(np.float64).eps)
    every = wl.sweep(contact, **given)
    assert not {name for name in every if every[name].isnull().any()}
    assert "tangential_force" in every
    assert not {"wear_rate", "wear_rate_error", "mass_per_distance"} & set(every)
