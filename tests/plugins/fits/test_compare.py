"""Comparing predictors: the same tests for all, the ranking, what is noted, and what of fits is counted."""

from __future__ import annotations

import math
import warnings
from typing import Any

import numpy as np
import pytest

import wearlaw as wl
from tests.plugins.fits.comparisons import (
    CREEPAGE,
    EXACT,
    GLOBAL,
    RIG,
    TRACTION,
    by_label,
    made,
    order,
    scattered,
    usfd,
)
from tests.strategies import EPS
from wearlaw import Q

# What is compared


def test_tests_without_a_wear_rate_are_left_out_for_all() -> None:
    rates = made().wear_rate.magnitude.copy()
    rates[[1, 4]] = np.nan
    data = made(wear_rate=Q(rates, "ug/m/mm^2"), traction_coefficient=TRACTION)
    comparison = wl.compare([EXACT | usfd(), EXACT | wl.wear_law("kth")], data)
    assert "2 of 8 tests have no wear rate and are left out" in comparison.notes
    assert len(comparison.tests) == 6
    assert {one.agreement.tests for one in comparison.compared} == {6}
    assert comparison.compared[0].agreement.rms_factor == pytest.approx(1.0, rel=1e2 * EPS)


def test_the_global_model_takes_the_measured_traction_and_that_is_noted() -> None:
    comparison = wl.compare([EXACT | usfd(), GLOBAL | usfd(fitted_for="global")], made(traction_coefficient=TRACTION))
    found = by_label(comparison)["usfd(fitted_for=global) on global"]
    conditions: dict[str, Any] = {"max_pressure": "1500 MPa", "creepage": "0.5 %", "friction_coefficient": 0.46}
    measured = (GLOBAL | usfd(fitted_for="global"))(**conditions, traction_coefficient=0.3)
    assert found.predicted[1] == pytest.approx(measured.wear_rate.m_as("kg/m^3"), rel=4 * EPS)
    assert [note for note in comparison.notes if "traction" in note] == [
        "usfd(fitted_for=global) on global: takes the traction that was measured in the tests"
    ]


# Names


def test_predictors_are_called_after_their_law_and_contact_model_as_in_a_study() -> None:
    fastsim = RIG | wl.contact_model("fastsim")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", wl.CalibrationWarning)
        predictors: list[wl.Pipeline[...]] = [EXACT | usfd(), fastsim | usfd(), EXACT | wl.wear_law("kth")]
        predictors += [EXACT | usfd(q_s="50 ug/m/mm^2"), EXACT | wl.patch_mean() | wl.wear_law("brr")]
    assert set(order(wl.compare(predictors, made()))) == {
        "usfd(q_s=55.0 µg/m/mm²) on exact",
        "usfd(q_s=55.0 µg/m/mm²) on fastsim",
        "usfd(q_s=50.0 µg/m/mm²) on exact",
        "kth on exact",
        "brr on exact, patch means",
    }


def test_two_predictors_of_one_name_are_refused() -> None:
    twice = [EXACT | usfd(), wl.TwinDisc.suros(track_width="8 mm") | wl.contact_model("exact") | usfd()]
    with pytest.raises(wl.InputError, match="'usfd on exact'"):
        wl.compare(twice, made())
    assert len(wl.compare({"10 mm": twice[0], "8 mm": twice[1]}, made()).compared) == 2


NO_RATE = wl.WearTests.from_arrays(
    creepage=Q(CREEPAGE, "%"), max_pressure="1500 MPa", friction_coefficient=0.46, traction_coefficient=TRACTION
)


def test_what_holds_no_wear_rate_cannot_be_compared() -> None:
    fit = wl.fit(EXACT, NO_RATE, ["friction_coefficient"], bootstrap=0)
    with pytest.raises(wl.InputError, match="predictor"):
        wl.compare([fit], made())
    with pytest.raises(wl.InputError, match="none of the 8 tests has a wear rate"):
        wl.compare([EXACT | usfd()], NO_RATE)


# Notes


def test_parameters_fitted_for_another_contact_and_tests_beyond_the_range_are_noted_and_not_warned_of() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", wl.CalibrationWarning)
        pipeline = EXACT | usfd(fitted_for="global")
    beyond = made(max_pressure="1600 MPa")
    notes = wl.compare([pipeline], beyond).notes
    assert len(notes) == 3
    assert notes[0].startswith("usfd on exact: the parameters of wear law 'usfd' were fitted for patch means")
    assert notes[1].startswith("tests: the maximum pressure of 1600 MPa at T/N = 0.46 is beyond the shakedown limit")
    assert notes[2].startswith("tests: wear law 'usfd' has a known range of mean wear index density from")


# Fits


def predicted(fit: wl.Fit, friction: float) -> wl.Array:
    """Return the predictions of the fitted law [kg/m/m²], through the public interface."""
    assert isinstance(fit.predict, wl.Pipeline)
    conditions: dict[str, Any] = {"creepage": Q(CREEPAGE, "%"), "max_pressure": "1500 MPa"}
    return np.asarray(fit.predict(**conditions, friction_coefficient=friction).wear_rate.m_as("kg/m^3"))


@pytest.mark.validates(
    "fitting",
    "AIC and its correction for few tests",
    source="by hand, n ln(mean square) + 2k",
    held_to="{roundings:g} ε, relative",
    roundings=1000.0,
)
def test_a_fit_to_these_tests_has_its_aic_and_the_correction_for_few_tests(roundings: float) -> None:
    data = scattered()
    fit = wl.fit(EXACT | usfd(), data, ["m_m", "q_s"], bootstrap=0)
    found = by_label(wl.compare([fit, EXACT | usfd()], data))
    one = found["usfd fitted on exact"]
    residuals = fit.residuals["residual"].to_numpy()
    # 8 tests; 2 parameters and the scatter
    by_hand = 8 * math.log(float(np.mean(residuals**2))) + 2 * 3
    assert one.fitted == 2
    assert one.aic == pytest.approx(by_hand, rel=roundings * EPS)
    assert one.aicc == pytest.approx(by_hand + 2 * 3 * 4 / (8 - 3 - 1), rel=roundings * EPS)
    assert found["usfd on exact"].aic is None


def test_stated_uncertainties_leave_no_scatter_to_be_counted() -> None:
    data = scattered(wear_rate_uncertainty=made().wear_rate * 0.1)
    fit = wl.fit(EXACT | usfd(), data, ["m_m", "q_s"], bootstrap=0)
    (one,) = wl.compare([fit], data).compared
    assert one.aic == pytest.approx(fit.chi2 + 2 * 2, rel=1e3 * EPS)
    assert one.aicc == pytest.approx(fit.chi2 + 2 * 2 + 2 * 2 * 3 / (8 - 2 - 1), rel=1e3 * EPS)


def test_a_fit_to_other_tests_predicts_but_has_no_aic() -> None:
    data = scattered()
    fit = wl.fit(EXACT | usfd(), data[[0, 2, 3, 4, 5, 7]], ["q_s"], bootstrap=0)
    comparison = wl.compare([fit], data[1:7])
    assert comparison.compared[0].aic is None
    assert any(note.startswith("usfd fitted on exact: was fitted to other tests") for note in comparison.notes)
    np.testing.assert_allclose(comparison.compared[0].predicted, predicted(fit, 0.46)[1:7], rtol=4 * EPS)


def test_a_fitted_friction_coefficient_is_used_in_place_of_that_of_the_tests() -> None:
    data = scattered(traction_coefficient=np.array(TRACTION) * 0.7)
    fit = wl.fit(GLOBAL | usfd(fitted_for="global"), data, ["q_s", "friction_coefficient"], bootstrap=0)
    comparison = wl.compare([fit], data)
    friction = float(fit.parameters["friction_coefficient"].magnitude)
    assert abs(friction - 0.46) > 0.005, "it must differ from that of the tests"
    np.testing.assert_allclose(comparison.compared[0].predicted, predicted(fit, friction), rtol=4 * EPS)
    assert f"usfd fitted on global: takes the friction coefficient that was fitted, {friction:.4g}" in comparison.notes
    assert any("AIC is left blank" in note for note in comparison.notes)
    assert comparison.compared[0].aic is None
