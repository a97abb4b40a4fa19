"""Running a case: its datasets against predictions made one by one."""

from __future__ import annotations

import itertools
import warnings
from typing import Any

import numpy as np
import pytest
import xarray

import wearlaw as wl
from tests.core import cases
from tests.core.cases import InstallModel, case
from tests.plugins.studies.studies import FRICTIONS, LOADS, MEASURED, lattice_study
from tests.strategies import EPS
from wearlaw import Q
from wearlaw.pipeline.variables import OF_CONTACT, OF_POINT, offered
from wearlaw.units.variables import UNITS
from wearlaw_studies.results import along_main_axis, axes_of, main_axis
from wearlaw_studies.study import Study, run

MODELS = {"global": wl.contact_model("global"), "exact": wl.contact_model("exact")}
LAWS = {"usfd": wl.wear_law("usfd"), "kth": wl.wear_law("kth"), "brr": wl.wear_law("brr")}


@pytest.fixture(scope="module")
def study() -> Study:
    return lattice_study()


def test_a_study_prints_its_pairs_sweeps_and_profiles(study: Study) -> None:
    lines = repr(study).splitlines()
    assert lines[0] == f"Study of '{study.case.title}'"
    assert max(map(len, lines)) <= 100
    shown = " ".join(map(str.strip, lines[1:]))
    assert shown.startswith("pairs      " + ", ".join(pair.label for pair in study.pairs))
    for name, sweep in study.sweeps.items():
        assert f"{name} ({', '.join(f'{axis} {sweep.sizes[axis]}' for axis in axes_of(sweep))})" in shown
    assert shown.endswith(f"notes      {len(study.notes)}") or not study.notes


def direct(model: str, law: wl.WearLaw, **conditions: Any) -> wl.Prediction:
    """Return the prediction for one point, by the public way."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", wl.WearlawWarning)
        return (wl.TwinDisc.suros() | MODELS[model] | law)(**conditions)


def lattice_points() -> list[tuple[dict[str, int], dict[str, Any]]]:
    """Return index and conditions of each point of the lattice."""
    sizes = {"max_pressure": 2, "creepage": 8, "friction_coefficient": 3}
    indices = [dict(zip(sizes, index, strict=True)) for index in np.ndindex(*sizes.values())]
    return [
        (
            index,
            {
                "max_pressure": LOADS[index["max_pressure"]],
                "creepage": Q(-2.0 + index["creepage"], "%"),
                "friction_coefficient": FRICTIONS[index["friction_coefficient"]],
            },
        )
        for index in indices
    ]


def assert_same_rate(value: float, prediction: wl.Prediction) -> None:
    """Both are the same integral, maybe on other nodes: they may differ by the errors of both, and rounding."""
    expected = prediction.wear_rate.to(UNITS["wear_rate"]).magnitude
    error = prediction.wear_rate_error.to(UNITS["wear_rate"]).magnitude
    assert abs(value - expected) <= 2.0 * error + 16.0 * EPS * expected


def test_a_sweep_has_the_axes_of_its_grid_and_one_entry_a_pair_and_a_contact_model(study: Study) -> None:
    lattice = study.sweeps["lattice"]
    assert dict(lattice.sizes) == {
        "pair": 5, "max_pressure": 2, "creepage": 8, "friction_coefficient": 3, "contact_model": 2,
    }  # fmt: skip
    assert list(lattice.pair.values) == [
        "usfd on global", "kth on global", "brr on global", "usfd on exact", "kth on exact",
    ]  # fmt: skip
    assert list(lattice.pair_wear_law.values) == ["usfd", "kth", "brr", "usfd", "kth"]
    assert list(lattice.pair_contact_model.values) == ["global"] * 3 + ["exact"] * 2
    assert list(lattice.contact_model.values) == ["global", "exact"]
    axes = ("max_pressure", "creepage", "friction_coefficient")
    for name in lattice.data_vars:
        of_pair = str(name).startswith("wear_rate") or name == "outside_range"
        first = {"pair"} if of_pair else {"contact_model"} if name in OF_CONTACT else set()
        assert set(lattice[name].dims) == first | set(axes)
    np.testing.assert_allclose(lattice.max_pressure, [1000.0, 1500.0], rtol=1e-14)
    np.testing.assert_allclose(lattice.creepage, np.arange(-2.0, 6.0), rtol=1e-14, atol=1e-15)
    np.testing.assert_allclose(lattice.friction_coefficient, FRICTIONS, rtol=1e-14)
    for name in (*lattice.data_vars, *axes):
        assert lattice[name].attrs["units"] == UNITS[str(name)]


def test_rates_and_their_bands_are_those_of_direct_predictions(study: Study) -> None:
    lattice = study.sweeps["lattice"]
    for pair in lattice.pair.values:
        law_name, model = pair.split(" on ")
        law = LAWS[law_name]
        ends = (
            {end: wl.wear_law("kth", coefficient=end) for end in ("low", "high")}
            if law_name == "kth"
            else {"low": law, "high": law}
        )
        for index, conditions in lattice_points():
            one = lattice.sel(pair=pair).isel(index)
            assert_same_rate(one.wear_rate.item(), direct(model, law, **conditions))
            assert_same_rate(one.wear_rate_low.item(), direct(model, ends["low"], **conditions))
            assert_same_rate(one.wear_rate_high.item(), direct(model, ends["high"], **conditions))
            assert 0.0 <= one.wear_rate_low <= one.wear_rate <= one.wear_rate_high
            assert 0.0 <= one.wear_rate_error <= 1e-9 * one.wear_rate + 1e-15


def test_totals_and_conditions_are_those_of_direct_predictions(study: Study) -> None:
    lattice = study.sweeps["lattice"]
    for model in MODELS:
        for index, conditions in lattice_points():
            one = lattice.sel(contact_model=model).isel(index)
            prediction = direct(model, LAWS["usfd"], **conditions)
            assert set(offered(prediction, (*OF_CONTACT, *OF_POINT))) == {
                name for name in (*OF_CONTACT, *OF_POINT) if name in lattice
            }
            for name in (name for name in (*OF_CONTACT, *OF_POINT) if name in lattice):
                expected = getattr(prediction, name).to(UNITS[name]).magnitude
                # mean_slip and stick_ratio are sums over nodes of a share of at most 1 (100 %).
                np.testing.assert_allclose(one[name].item(), expected, rtol=1e-12, atol=1e-12, err_msg=name)


def test_zero_creepage_is_no_wear_and_opposite_creepage_the_same_wear(study: Study) -> None:
    lattice = study.sweeps["lattice"]
    assert (lattice.wear_rate.isel(creepage=2) == 0.0).all()
    assert (lattice.tangential_force.isel(creepage=2) == 0.0).all()
    # The axis holds -1 % and 1 % to rounding only.
    back, ahead = lattice.isel(creepage=1), lattice.isel(creepage=3)
    np.testing.assert_allclose(back.wear_rate, ahead.wear_rate, rtol=100 * EPS)
    np.testing.assert_allclose(back.tangential_force, -ahead.tangential_force, rtol=100 * EPS)


def test_a_profile_is_that_of_a_direct_prediction(study: Study) -> None:
    profile = study.profiles["partial_slip"]
    assert list(profile.contact_model.values) == ["exact"]
    assert list(profile.pair.values) == ["usfd on exact", "kth on exact"]
    for law in ("usfd", "kth"):
        expected = direct("exact", LAWS[law], **cases.POINT).profile
        np.testing.assert_array_equal(profile.x, expected.x)
        np.testing.assert_array_equal(profile.wear_rate.sel(pair=f"{law} on exact"), expected.wear_rate)
        for name in ("pressure", "traction", "traction_bound", "slip"):
            np.testing.assert_array_equal(profile[name].sel(contact_model="exact"), expected[name])
            assert profile[name].attrs["units"] == UNITS[name]
    assert profile.x.attrs["units"] == "mm"


# Measured traction


def test_a_sweep_with_measured_traction_is_for_the_models_that_can_use_it() -> None:
    study = run(case(sweeps={"measured": MEASURED}, profiles={}))
    sweep = study.sweeps["measured"]
    assert list(sweep.contact_model.values) == ["global"]
    assert list(sweep.pair.values) == ["usfd on global", "kth on global", "brr on global"]
    np.testing.assert_allclose(sweep.traction_coefficient, 0.2, rtol=4 * EPS)
    np.testing.assert_allclose(
        sweep.tangential_force.sel(contact_model="global"), 200.0 * sweep.normal_force, rtol=4 * EPS
    )
    assert study.notes.count("sweep 'measured': exact is left out, since it computes the traction itself") == 1


def test_measured_traction_may_be_an_axis() -> None:
    conditions = {**cases.POINT, "creepage": ["1 %", "2 %"], "traction_coefficient": [0.1, 0.2, 0.3]}
    sweep = run(case(sweeps={"measured": conditions}, profiles={})).sweeps["measured"]
    assert axes_of(sweep) == ["creepage", "traction_coefficient"]
    np.testing.assert_array_equal(sweep.traction_coefficient, [0.1, 0.2, 0.3])
    for (i, creepage), (j, traction) in itertools.product(enumerate(["1 %", "2 %"]), enumerate([0.1, 0.2, 0.3])):
        one = {**cases.POINT, "creepage": creepage, "traction_coefficient": traction}
        found = sweep.wear_rate.sel(pair="usfd on global")[i, j].item()
        assert_same_rate(found, direct("global", LAWS["usfd"], **one))


# Shapes


def test_one_operating_point_is_a_sweep_without_axes() -> None:
    sweep = run(case(sweeps={"point": cases.POINT}, profiles={})).sweeps["point"]
    assert axes_of(sweep) == []
    assert sweep.wear_rate.dims == ("pair",)
    assert_same_rate(sweep.wear_rate.sel(pair="kth on exact").item(), direct("exact", LAWS["kth"], **cases.POINT))
    assert main_axis(sweep, "creepage") == "creepage"
    line = along_main_axis(sweep, "creepage")
    assert line.wear_rate.sel(pair="kth on exact").dims == ("creepage",)
    assert line.creepage.values == pytest.approx([0.5], rel=1e-14)


def test_tables_and_figures_run_along_creepage_or_else_the_longest_axis_at_the_middle_of_the_others() -> None:
    loads, frictions = ["500 MPa", "1000 MPa", "1500 MPa"], [0.2, 0.3, 0.4, 0.5]
    sweeps = {
        "a": {**cases.POINT, "creepage": ["1 %", "2 %"], "friction_coefficient": frictions},
        "b": {**cases.POINT, "max_pressure": loads, "friction_coefficient": frictions},
    }
    study = run(case(contact_models=["global"], wear_laws=["usfd"], profiles={}, sweeps=sweeps))
    assert [main_axis(study.sweeps[name], "creepage") for name in "ab"] == ["creepage", "friction_coefficient"]
    by_creepage, by_friction = (along_main_axis(study.sweeps[name], "creepage") for name in "ab")
    assert by_creepage.friction_coefficient == 0.4
    xarray.testing.assert_equal(by_creepage.wear_rate, study.sweeps["a"].wear_rate[:, :, 2])
    assert by_friction.max_pressure == pytest.approx(1000.0, rel=1e-14)
    xarray.testing.assert_equal(by_friction.wear_rate, study.sweeps["b"].wear_rate[:, 1, :])


def test_a_model_with_nodes_of_its_own_has_its_profile_beside_those_on_uniform_cells(
    install_model: InstallModel,
) -> None:
    install_model(cases.Coarse)
    study = run(case(contact_models=["exact", "coarse"], wear_laws=["kth"]))
    profile = study.profiles["partial_slip"]
    coarse = profile.sel(contact_model="coarse", pair="kth on coarse").dropna("x")
    exact = profile.sel(contact_model="exact", pair="kth on exact").dropna("x")
    assert coarse.sizes["x"] == 7
    np.testing.assert_array_equal(exact.traction, direct("exact", LAWS["kth"], **cases.POINT).profile.traction)
    np.testing.assert_allclose(coarse.traction, 0.46 * coarse.pressure, rtol=1e-14)
    np.testing.assert_allclose(coarse.slip, 0.5, rtol=1e-14)
