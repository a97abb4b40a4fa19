"""The fields of a result along the contact, with their units."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest
import xarray

import wearlaw as wl
from tests.core.discs import CONDITIONS, FRICTION, HALF_WIDTH, LAW, PREDICT, RIG, solved
from tests.strategies import EPS
from wearlaw import Q


def test_the_profile_of_one_point_is_labelled_by_x_with_units() -> None:
    creepage = 0.004
    profile = PREDICT(creepage=Q(creepage, ""), **CONDITIONS).profile
    assert profile.sizes == {"x": 200}
    assert {name: profile[name].attrs["units"] for name in profile.variables} == {
        "x": "mm",
        "pressure": "MPa",
        "traction": "MPa",
        "traction_bound": "MPa",
        "slip": "%",
        "wear_rate": "ug/m/mm^2",
    }
    x = profile["x"].values * 1e-3
    # Centres of 200 equal cells from the leading to the trailing edge.
    np.testing.assert_allclose(x, HALF_WIDTH * (np.arange(200) - 99.5) / 100.0, rtol=1e-12)
    solution, v = solved(creepage), 1.0 - x / HALF_WIDTH
    bound, slip = 1e-6 * solution.traction(v), np.where(v < solution.border, solution.slip(v), 0.0)
    np.testing.assert_allclose(profile["traction_bound"], bound, rtol=1e-10)
    np.testing.assert_allclose(profile["pressure"], bound / FRICTION, rtol=1e-10)
    np.testing.assert_allclose(profile["slip"], 100 * slip, rtol=1e-10)
    slipping = slip > 0
    np.testing.assert_allclose(profile["traction"][slipping], bound[slipping], rtol=1e-10)
    assert (profile["traction"][~slipping] < bound[~slipping]).all()
    w = bound * slip  # Table 4 of Tassini et al. (2010), exact
    rates = np.where(w < 55 / 5.3, 5.3 * w, np.where(w < 95, 55, 55 + 83.7 * (w - 95)))
    np.testing.assert_allclose(profile["wear_rate"], rates, rtol=1e-10)


def test_the_profile_of_a_batch_has_an_axis_a_condition_axis() -> None:
    result = PREDICT(
        creepage=Q([0.004, 0.01, 0.02], ""), normal_force=Q([[5.0], [6.0]], "kN"), friction_coefficient=0.4
    )
    profile = result.profile
    assert profile.sizes == {"point_0": 2, "point_1": 3, "cell": 200}
    assert set(profile.coords) == {"x"}
    assert set(profile.data_vars) == {"pressure", "traction", "traction_bound", "slip", "wear_rate"}
    one = PREDICT(creepage="0.4 %", **CONDITIONS).profile
    for name in one.data_vars:
        np.testing.assert_allclose(profile[name][1, 0], one[name], rtol=1e-12)
    np.testing.assert_allclose(profile["x"][1, 0], one["x"], rtol=1e-12)


def test_the_profile_of_a_contact_alone_has_no_wear_and_that_of_patch_means_one_cell() -> None:
    contact = RIG | wl.contact_model("fastsim")
    assert "wear_rate" not in contact(creepage="1 %", **CONDITIONS).profile
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", wl.CalibrationWarning)
        means = (contact | wl.patch_mean() | LAW)(creepage="1 %", **CONDITIONS)
    assert means.profile.sizes == {"x": 1}
    assert float(means.profile["wear_rate"][0]) == pytest.approx(means.wear_rate.magnitude, rel=4 * EPS)


def test_the_profile_writes_to_netcdf_and_back(tmp_path: Path) -> None:
    profile = (RIG | wl.contact_model("exact"))(creepage=Q([1.0, 2.0], "%"), **CONDITIONS).profile
    profile.to_netcdf(tmp_path / "profile.nc", engine="h5netcdf")
    with xarray.open_dataset(tmp_path / "profile.nc", engine="h5netcdf") as read:
        xarray.testing.assert_identical(read.load(), profile)
