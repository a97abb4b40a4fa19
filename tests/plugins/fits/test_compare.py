"""Comparing predictors: the same tests for all, the ranking, what is noted, and what of fits is counted."""

from __future__ import annotations

import math
import warnings
from typing import Any

import numpy as np
import pytest

import wearlaw as wl
from tests.plugins.fits.comparisons import CREEPAGE, TRACTION, by_label, made, order, scattered, usfd
from tests.plugins.fits.fits import EXACT, GLOBAL, RIG
from tests.strategies import EPS
from wearlaw import Q
from wearlaw.errors import FitWarning
from wearlaw_apps.fits import Comparison, Fit, WearTests
from wearlaw_apps.fits.agreement import agreement  # private: errors of made-up rates, without a law

pytestmark = pytest.mark.filterwarnings(
    "ignore::wearlaw.errors.FitWarning"
)  # most compare fits to the tests themselves


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


@pytest.mark.filterwarnings("ignore::wearlaw.CalibrationWarning")
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


NO_RATE = WearTests.from_arrays(
    creepage=Q(CREEPAGE, "%"), max_pressure="1500 MPa", friction_coefficient=0.46, traction_coefficient=TRACTION
)


def test_what_holds_no_wear_rate_cannot_be_compared() -> None:
    fit = wl.fit(EXACT, NO_RATE, ["friction_coefficient"], bootstrap=0)
    with pytest.raises(wl.InputError, match="predictor"):
        wl.compare([fit], made())
    with pytest.raises(wl.InputError, match="none of the 8 tests has a wear rate"):
        wl.compare([EXACT | usfd()], NO_RATE)


# Notes


def test_notes_on_parameters_range_and_load_are_a_warning_each_kind() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", wl.CalibrationWarning)
        pipeline = EXACT | usfd(fitted_for="global")
    beyond = made(max_pressure="1600 MPa")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        notes = wl.compare([pipeline], beyond).notes
    assert {one.category: str(one.message) for one in caught} == {
        wl.CalibrationWarning: notes[0],
        wl.PlasticityWarning: notes[1],
        wl.RangeWarning: notes[2],
    }
    assert {one.filename for one in caught} == {__file__}
    assert len(notes) == 3
    assert notes[0].startswith("usfd on exact: the parameters of wear law 'usfd' were fitted for patch means")
    assert notes[1].startswith("tests: the maximum pressure of 1600 MPa at T/N = 0.46 is beyond the shakedown limit")
    assert notes[2].startswith("tests: wear law 'usfd' has a known range of mean wear index density from")


def test_notes_of_one_kind_are_one_warning_and_statements_are_none() -> None:
    rates = made().wear_rate.magnitude.copy()
    rates[[1, 4]], rates[2] = np.nan, 0.0
    data = made(wear_rate=Q(rates, "ug/m/mm^2"), traction_coefficient=TRACTION)
    predict = GLOBAL | usfd(fitted_for="global")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        notes = wl.compare({"a": predict, "b": predict}, data).notes
    (message,) = [str(one.message) for one in caught if one.category is FitWarning]
    zero = "either the predicted or the measured wear rate is zero in 1 of 6 tests"
    assert message.startswith(f"2 of 8 tests have no wear rate and are left out\n  a, b: {zero}")
    assert len([note for note in notes if zero in note]) == 2
    assert "a: takes the traction that was measured in the tests" in notes
    assert not [one for one in caught if "takes the traction" in str(one.message)]


# Fits


def predicted(fit: Fit, friction: float) -> wl.Array:
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


class Above(wl.WearLaw):
    """Wear in proportion to the wear-index density, but none below a threshold of it."""

    name = "above"
    scale = "patch"

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> wl.Array:
        density = contact.wear_index_density
        return np.where(density < 20e6, 0.0, 5e-9 * density)


def test_the_table_ranks_and_has_its_units_in_the_heads() -> None:
    comparison = wl.compare([EXACT | wl.wear_law("kth"), EXACT | usfd()], scattered())
    table = comparison.table()
    assert list(table.columns) == [
        "predictor", "rms_factor", "bias", "geometric_sd", "largest_factor", "rms_error [ug/m/mm^2]", "tests",
        "in_sample", "without_ratio", "fitted", "aic", "aicc",
    ]  # fmt: skip
    assert table["predictor"].tolist() == ["usfd on exact", "kth on exact"]
    for row, one in zip(table.to_dict("records"), comparison.compared, strict=True):
        for measure in ("rms_factor", "bias", "geometric_sd", "largest_factor", "tests", "without_ratio"):
            assert row[measure] == getattr(one.agreement, measure)
        assert row["rms_error [ug/m/mm^2]"] == pytest.approx(one.agreement.rms_error * 1e3, rel=4 * EPS)


def test_the_figure_has_a_panel_for_each_contact_model_with_measured_over_predicted() -> None:
    data = scattered()
    predictors = [EXACT | usfd(), EXACT | wl.wear_law("kth"), GLOBAL | wl.wear_law("kth"), GLOBAL | wl.wear_law("brr")]
    predictors.append(EXACT | wl.wear_law("kth", coefficient="high"))
    comparison = wl.compare(predictors, data)
    figure = comparison.figure_data()
    assert {panel.title: {c.label for c in panel.curves if c.points} for panel in figure.panels} == {
        "exact": {"usfd", "kth(coefficient=mid)", "kth(coefficient=high)"},
        "global": {"kth(coefficient=mid)", "brr"},
    }
    colours: dict[str, set[int]] = {}
    for panel in figure.panels:
        assert (panel.x.scale, panel.y.scale) == ("log", "log")
        assert panel.x.ends is not None
        assert panel.x.ends == panel.y.ends
        assert all(curve.hollow for curve in panel.curves if curve.points), "only measurements have filled markers"
        for curve in (curve for curve in panel.curves if curve.points):
            predicted = by_label(comparison)[f"{curve.label} on {panel.title}"].predicted
            np.testing.assert_allclose(curve.x, predicted * 1e3, rtol=4 * EPS)
            np.testing.assert_allclose(curve.y, data.wear_rate.magnitude, rtol=4 * EPS)
            colours.setdefault(curve.label, set()).add(curve.colour)
            low, high = panel.x.ends
            assert low < min(curve.x.min(), curve.y.min())
            assert high > max(curve.x.max(), curve.y.max())
    assert all(len(found) == 1 for found in colours.values()), "one law, one colour"
    assert len(set.union(*colours.values())) == len(colours) == 4


# Zero rates


@pytest.fixture(scope="module")
def with_zeros() -> Comparison:
    """A law that predicts no wear in the first tests, beside one that is far off, and a measured rate of zero."""
    rates = made().wear_rate.magnitude.copy()
    rates[3] = 0.0
    laws = {"above": GLOBAL | Above(), "far": GLOBAL | wl.wear_law("brr")}
    return wl.compare(laws, made(wear_rate=Q(rates, "ug/m/mm^2")))


def test_no_predicted_wear_where_some_was_measured_ranks_last_and_is_noted(with_zeros: Comparison) -> None:
    found = by_label(with_zeros)
    missed = int(((found["above"].predicted == 0) != (with_zeros.tests.columns["wear_rate"] == 0)).sum())
    assert missed > 1, "the law must miss some tests here"
    assert order(with_zeros) == ["far", "above"]
    assert found["above"].agreement.without_ratio == missed
    assert any(note.startswith("above: ") and f"zero in {missed} of 8 tests" in note for note in with_zeros.notes)
    assert any(note.startswith("far: ") and "zero in 1 of 8 tests" in note for note in with_zeros.notes)


def test_each_measure_is_what_comes_out_by_hand() -> None:
    """The ratios are 2, 2 and 1/4, with logarithms 1, 1 and -2 times ln 2."""
    found = agreement(np.array([2.0, 8.0, 1.0]), np.array([1.0, 4.0, 4.0]))
    assert found.tests == 3
    assert found.without_ratio == 0
    assert found.bias == pytest.approx(1.0, rel=4 * EPS)
    assert found.geometric_sd == pytest.approx(2.0 ** math.sqrt((1 + 1 + 4) / 2), rel=8 * EPS)
    assert found.rms_factor == pytest.approx(2.0 ** math.sqrt((1 + 1 + 4) / 3), rel=8 * EPS)
    assert found.largest_factor == pytest.approx(4.0, rel=4 * EPS)
    assert found.rms_error == pytest.approx(math.sqrt((1 + 16 + 9) / 3), rel=4 * EPS)


def test_a_test_in_which_one_rate_is_zero_has_no_ratio_and_counts_in_the_rms_error() -> None:
    found = agreement(np.array([0.0, 3.0, 2.0]), np.array([1.0, 0.0, 1.0]))
    assert (found.tests, found.without_ratio) == (3, 2)
    assert found.bias == found.rms_factor == found.largest_factor == pytest.approx(2.0, rel=4 * EPS)
    assert found.geometric_sd is None
    assert found.rms_error == pytest.approx(math.sqrt((1 + 9 + 1) / 3), rel=4 * EPS)


def test_missed_wear_ranks_behind_any_factor_and_equal_factors_rank_by_the_rms_error() -> None:
    measured = np.array([1.0, 1.0])
    far = agreement(1e9 * measured, measured)
    missed = agreement(np.array([0.0, 1.0]), measured)
    nothing = agreement(np.zeros(2), measured)
    over = agreement(2.0 * measured, measured)
    under = agreement(0.5 * measured, measured)
    ranked = sorted([nothing, missed, far, over, under], key=lambda one: one.rank)
    assert ranked == [under, over, far, missed, nothing]
