"""Comparing predictors: the same tests for all, the ranking, what is noted, and what a figure shows."""

from __future__ import annotations

import math
import warnings
from typing import Any

import numpy as np
import pandas as pd
import pytest

import wearlaw as wl
from wearlaw import Q
from wearlaw.comparison.compare import Predictor
from wearlaw.comparison.result import Compared

EPS = float(np.finfo(np.float64).eps)
RIG = wl.TwinDisc.suros()
EXACT = RIG | wl.contact_model("exact")
GLOBAL = RIG | wl.contact_model("global")
CREEPAGE = [0.2, 0.5, 1.0, 2.0, 5.0, 12.0, 18.0, 20.0]
SCATTER = np.array([1.1, 0.9, 1.05, 0.97, 1.02, 0.93, 1.08, 0.99])
TRACTION = [0.13, 0.3, 0.42, 0.45, 0.46, 0.46, 0.46, 0.46]


class Above(wl.WearLaw):
    """Wear in proportion to the wear-index density, but none below a threshold of it."""

    name = "above"
    source = "A test, 3. ed., 2026"
    scale = "patch"

    def rate(self, contact: wl.Contact) -> wl.Array:
        density = contact.wear_index_density
        return np.where(density < 20e6, 0.0, 5e-9 * density)


def usfd(**options: Any) -> wl.WearLaw:
    return wl.wear_law("usfd", **{"fitted_for": "exact", **options})


def made(**columns: Any) -> wl.WearTests:
    """Return tests whose wear rates are those of the USFD law on the exact contact, unless others are given."""
    conditions: dict[str, Any] = {
        "creepage": Q(CREEPAGE, "%"),
        "max_pressure": "1500 MPa",
        "friction_coefficient": 0.46,
    }
    rates = (EXACT | usfd())(**conditions).wear_rate
    return wl.WearTests.from_arrays(**{**conditions, "wear_rate": rates, **columns})


def scattered(**columns: Any) -> wl.WearTests:
    return made(wear_rate=made().wear_rate * SCATTER, **columns)


def by_label(comparison: wl.Comparison) -> dict[str, Compared]:
    return {one.names.label: one for one in comparison.compared}


def order(comparison: wl.Comparison) -> list[str]:
    return [one.names.label for one in comparison.compared]


# What is compared


def test_every_predictor_gives_what_its_pipeline_gives_for_the_same_tests() -> None:
    data = scattered()
    predictors = {"published": EXACT | usfd(), "map": EXACT | wl.wear_law("kth")}
    found = by_label(wl.compare(predictors, data))
    for label, pipeline in predictors.items():
        direct = pipeline(creepage=Q(CREEPAGE, "%"), max_pressure="1500 MPa", friction_coefficient=0.46).wear_rate
        np.testing.assert_allclose(found[label].predicted, direct.to("kg/m^3").magnitude, rtol=4 * EPS)
        assert found[label].agreement.tests == len(CREEPAGE)


def test_the_measures_are_those_of_the_predicted_and_the_measured_rates() -> None:
    """The tests wear more than predicted by factors of 2 and 1/2, in turn, so that all factors are known."""
    factors = np.array([2.0, 0.5] * 4)
    found = wl.compare([EXACT | usfd()], made(wear_rate=made().wear_rate * factors)).compared[0].agreement
    # Rates that were made into µg/m/mm² and back.
    assert found.bias == pytest.approx(1.0, rel=1e2 * EPS)
    assert found.rms_factor == found.largest_factor == pytest.approx(2.0, rel=1e2 * EPS)
    assert found.geometric_sd == pytest.approx(2.0 ** math.sqrt(8 / 7), rel=1e2 * EPS)
    rates = made().wear_rate.magnitude
    in_si = float(np.sqrt(np.mean((rates * (factors - 1.0)) ** 2))) * 1e-3  # µg/m/mm² is 1e-9 kg/m over 1e-6 m²
    assert found.rms_error == pytest.approx(in_si, rel=1e2 * EPS)


def test_the_best_comes_first_whatever_the_order_they_are_given_in() -> None:
    predictors = {
        "half": EXACT | usfd(m_m="2.65 ug/m/N", q_s="27.5 ug/m/mm^2"),
        "true": EXACT | usfd(),
        "near": EXACT | usfd(q_s="50 ug/m/mm^2"),
    }
    assert order(wl.compare(predictors, made())) == ["true", "near", "half"]
    assert order(wl.compare(dict(reversed(predictors.items())), made())) == ["true", "near", "half"]


def test_tests_without_a_wear_rate_are_left_out_for_all() -> None:
    rates = made().wear_rate.magnitude.copy()
    rates[[1, 4]] = np.nan
    data = made(wear_rate=Q(rates, "ug/m/mm^2"), traction_coefficient=TRACTION)
    comparison = wl.compare([EXACT | usfd(), EXACT | wl.wear_law("kth")], data)
    assert "2 of 8 tests have no wear rate and are left out" in comparison.notes
    assert len(comparison.tests) == 6
    assert {one.agreement.tests for one in comparison.compared} == {6}
    assert comparison.compared[0].agreement.rms_factor == pytest.approx(1.0, rel=1e2 * EPS)


def test_the_friction_coefficient_is_that_of_the_tests_or_else_the_given_one() -> None:
    conditions: dict[str, Any] = {"creepage": Q(CREEPAGE, "%"), "max_pressure": "1500 MPa"}
    without = wl.WearTests.from_arrays(**conditions, wear_rate=made().wear_rate)
    given = wl.compare([EXACT | usfd()], without, friction_coefficient=0.46).compared[0]
    held = wl.compare([EXACT | usfd()], made(), friction_coefficient=0.3).compared[0]
    np.testing.assert_array_equal(given.predicted, held.predicted)
    with pytest.raises(wl.ConditionsError, match="friction_coefficient"):
        wl.compare([EXACT | usfd()], without)


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
        predictors = [EXACT | usfd(), fastsim | usfd(), EXACT | wl.wear_law("kth")]
        predictors += [EXACT | usfd(q_s="50 ug/m/mm^2"), EXACT | wl.patch_mean() | wl.wear_law("brr")]
    assert set(order(wl.compare(predictors, made()))) == {
        "usfd(q_s=55.0 µg/m/mm**2) on exact",
        "usfd(q_s=55.0 µg/m/mm**2) on fastsim",
        "usfd(q_s=50.0 µg/m/mm**2) on exact",
        "kth on exact",
        "brr on exact, patch means",
    }


def test_a_fit_is_called_fitted() -> None:
    fit = wl.fit(EXACT | usfd(), scattered(), ["q_s"], bootstrap=0)
    assert set(order(wl.compare([EXACT | usfd(), fit], scattered()))) == {"usfd on exact", "usfd fitted on exact"}


def test_two_predictors_of_one_name_are_refused() -> None:
    twice = [EXACT | usfd(), wl.TwinDisc.suros(track_width="8 mm") | wl.contact_model("exact") | usfd()]
    with pytest.raises(wl.InputError, match="two predictors are called 'usfd on exact'; give a mapping"):
        wl.compare(twice, made())
    assert len(wl.compare({"10 mm": twice[0], "8 mm": twice[1]}, made()).compared) == 2


@pytest.mark.parametrize("predictors", [[], {}])
def test_no_predictor_is_an_error(predictors: Any) -> None:
    with pytest.raises(wl.InputError, match="give at least one predictor"):
        wl.compare(predictors, made())


@pytest.mark.parametrize("wrong", [EXACT, usfd(), "usfd", None])
def test_what_predicts_no_wear_is_refused(wrong: Any) -> None:
    with pytest.raises(wl.InputError, match=r"a predictor of wear is a pipeline, .* not"):
        wl.compare({"good": EXACT | usfd(), "wrong": wrong}, made())


def test_a_fit_of_the_friction_coefficient_alone_predicts_no_wear() -> None:
    fit = wl.fit(EXACT, made(traction_coefficient=TRACTION), ["friction_coefficient"], bootstrap=0)
    with pytest.raises(wl.InputError, match="a predictor of wear is a pipeline"):
        wl.compare([fit], made())


def test_tests_without_any_wear_rate_are_refused() -> None:
    data = wl.WearTests.from_arrays(
        creepage=Q(CREEPAGE, "%"), max_pressure="1500 MPa", friction_coefficient=0.46, traction_coefficient=TRACTION
    )
    with pytest.raises(wl.InputError, match="none of the 8 tests has a wear rate"):
        wl.compare([EXACT | usfd()], data)


# Notes


def test_parameters_fitted_for_another_contact_and_tests_beyond_the_range_are_noted_and_not_warned_of() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", wl.CalibrationWarning)
        pipeline = EXACT | usfd(fitted_for="global")
    beyond = made(max_pressure="1600 MPa")
    notes = wl.compare([pipeline], beyond).notes
    assert len(notes) == 2
    assert notes[0].startswith("usfd on exact: the parameters of wear law 'usfd' were fitted for patch means")
    assert notes[1].startswith("tests: wear law 'usfd' is stated for a mean wear index density from")


def test_nothing_is_noted_where_there_is_nothing_to_know() -> None:
    assert wl.compare([EXACT | usfd(), EXACT | wl.wear_law("kth")], made()).notes == ()


# Zero rates


@pytest.fixture(scope="module")
def with_zeros() -> wl.Comparison:
    """A law that predicts no wear in the first tests, beside one that is far off, and a measured rate of zero."""
    rates = made().wear_rate.magnitude.copy()
    rates[3] = 0.0
    laws = {"above": GLOBAL | Above(), "far": GLOBAL | wl.wear_law("brr")}
    return wl.compare(laws, made(wear_rate=Q(rates, "ug/m/mm^2")))


def test_no_predicted_wear_where_some_was_measured_ranks_last_and_is_noted(with_zeros: wl.Comparison) -> None:
    found = by_label(with_zeros)
    missed = int(((found["above"].predicted == 0) != (with_zeros.tests.columns["wear_rate"] == 0)).sum())
    assert missed > 1, "the law must miss some tests here"
    assert order(with_zeros) == ["far", "above"]
    assert found["above"].agreement.without_ratio == missed
    assert any(note.startswith("above: ") and f"zero in {missed} of 8 tests" in note for note in with_zeros.notes)
    assert any(note.startswith("far: ") and "zero in 1 of 8 tests" in note for note in with_zeros.notes)


def test_a_table_holds_blanks_and_nothing_infinite_or_nan(with_zeros: wl.Comparison) -> None:
    """A law that predicts no wear at all has no ratio."""
    comparison = wl.compare({"nothing": GLOBAL | Above()}, made()[:2])
    row = comparison.table().iloc[0]
    assert [head for head in row.index if row[head] is pd.NA] == [
        "rms_factor", "bias", "geometric_sd", "largest_factor", "fitted", "aic", "aicc",
    ]  # fmt: skip
    for table in (comparison.table(), with_zeros.table()):
        numbers = table.drop(columns="predictor").astype("Float64")
        assert np.isfinite(numbers.stack().dropna().to_numpy(dtype=float)).all()
    assert "nan" not in repr(comparison) + repr(with_zeros)


def test_a_figure_leaves_zero_rates_out_and_says_so(with_zeros: wl.Comparison) -> None:
    (panel,) = with_zeros.figure_data().panels
    shown = {curve.label: curve for curve in panel.curves if curve.points}
    assert shown["far"].x.size == 7
    worn = (by_label(with_zeros)["above"].predicted > 0) & (with_zeros.tests.columns["wear_rate"] > 0)
    assert shown["above"].x.size == worn.sum() < 7
    assert all((curve.x > 0).all() and (curve.y > 0).all() for curve in panel.curves)
    assert "Not shown: wear rates of zero, in up to" in with_zeros.figure_data().caption


def test_a_figure_of_nothing_but_zero_rates_can_be_drawn() -> None:
    zero = made(wear_rate=Q([0.0] * len(CREEPAGE), "ug/m/mm^2"))[:1]
    comparison = wl.compare({"nothing": GLOBAL | Above()}, zero)
    assert comparison.compared[0].agreement.without_ratio == 0
    comparison.plot()


# Fits


def predicted(fit: wl.Fit, friction: float) -> wl.Array:
    """Return what the fitted law predicts [kg/m/m²], by the public way."""
    assert isinstance(fit.predict, wl.Pipeline)
    conditions: dict[str, Any] = {"creepage": Q(CREEPAGE, "%"), "max_pressure": "1500 MPa"}
    return np.asarray(fit.predict(**conditions, friction_coefficient=friction).wear_rate.m_as("kg/m^3"))


def test_a_fit_to_these_tests_has_its_aic_and_the_correction_for_few_tests() -> None:
    data = scattered()
    fit = wl.fit(EXACT | usfd(), data, ["m_m", "q_s"], bootstrap=0)
    found = by_label(wl.compare([fit, EXACT | usfd()], data))
    information = found["usfd fitted on exact"].information
    assert information is not None
    residuals = fit.residuals["residual"].to_numpy()
    # 8 tests; 2 parameters and the scatter
    by_hand = 8 * math.log(float(np.mean(residuals**2))) + 2 * 3
    assert information.parameters == 2
    assert information.aic == pytest.approx(by_hand, rel=1e3 * EPS)
    assert information.aicc == pytest.approx(by_hand + 2 * 3 * 4 / (8 - 3 - 1), rel=1e3 * EPS)
    assert found["usfd on exact"].information is None


def test_stated_uncertainties_leave_no_scatter_to_be_counted() -> None:
    data = scattered(wear_rate_uncertainty=made().wear_rate * 0.1)
    fit = wl.fit(EXACT | usfd(), data, ["m_m", "q_s"], bootstrap=0)
    information = wl.compare([fit], data).compared[0].information
    assert information is not None
    assert information.aic == pytest.approx(fit.chi2 + 2 * 2, rel=1e3 * EPS)
    assert information.aicc == pytest.approx(fit.chi2 + 2 * 2 + 2 * 2 * 3 / (8 - 2 - 1), rel=1e3 * EPS)


def test_with_too_few_tests_there_is_no_correction() -> None:
    data = scattered()[[0, 1, 3, 4]]
    fit = wl.fit(EXACT | usfd(), data, ["m_m", "q_s"], bootstrap=0)
    table = wl.compare([fit], data).table()
    assert table["fitted"].tolist() == [2]
    assert table["aic"].notna().all()
    assert table["aicc"].isna().all()


def test_a_fit_to_other_tests_predicts_but_has_no_aic() -> None:
    data = scattered()
    fit = wl.fit(EXACT | usfd(), data[[0, 2, 3, 4, 5, 7]], ["q_s"], bootstrap=0)
    comparison = wl.compare([fit], data[1:7])
    assert comparison.compared[0].information is None
    assert any(note.startswith("usfd fitted on exact: was fitted to other tests, so") for note in comparison.notes)
    np.testing.assert_allclose(comparison.compared[0].predicted, predicted(fit, 0.46)[1:7], rtol=4 * EPS)


def test_tests_without_a_wear_rate_make_no_other_tests() -> None:
    rates = scattered().wear_rate.magnitude.copy()
    rates[4] = np.nan
    data = made(wear_rate=Q(rates, "ug/m/mm^2"))
    fit = wl.fit(EXACT | usfd(), data, ["q_s"], bootstrap=0)
    assert wl.compare([fit], data).compared[0].information is not None


def test_fits_that_take_the_tests_to_scatter_differently_have_no_aic() -> None:
    data = scattered()
    fits: dict[str, Predictor] = {
        "relative": wl.fit(EXACT | usfd(), data, ["q_s"], bootstrap=0),
        "absolute": wl.fit(EXACT | usfd(), data, ["q_s"], scatter="absolute", bootstrap=0),
    }
    comparison = wl.compare(fits, data)
    assert all(one.information is None for one in comparison.compared)
    assert "AIC is left blank, since the fits take the tests to scatter in different ways" in comparison.notes


def test_a_fitted_friction_coefficient_is_used_in_place_of_that_of_the_tests() -> None:
    data = scattered(traction_coefficient=np.array(TRACTION) * 0.7)
    fit = wl.fit(GLOBAL | usfd(fitted_for="global"), data, ["q_s", "friction_coefficient"], bootstrap=0)
    comparison = wl.compare([fit], data)
    friction = float(fit.parameters["friction_coefficient"].magnitude)
    assert abs(friction - 0.46) > 0.005, "it must differ from that of the tests"
    np.testing.assert_allclose(comparison.compared[0].predicted, predicted(fit, friction), rtol=4 * EPS)
    assert f"usfd fitted on global: takes the friction coefficient that was fitted, {friction:.4g}" in comparison.notes
    assert any("was fitted to tractions too" in note for note in comparison.notes)
    assert comparison.compared[0].information is None


# What comes of it


def test_the_table_ranks_and_has_its_units_in_the_heads() -> None:
    comparison = wl.compare([EXACT | wl.wear_law("kth"), EXACT | usfd()], scattered())
    table = comparison.table()
    assert list(table.columns) == [
        "predictor", "rms_factor", "bias", "geometric_sd", "largest_factor", "rms_error [ug/m/mm^2]", "tests",
        "without_ratio", "fitted", "aic", "aicc",
    ]  # fmt: skip
    assert table["predictor"].tolist() == ["usfd on exact", "kth on exact"]
    for row, one in zip(table.to_dict("records"), comparison.compared, strict=True):
        for measure in ("rms_factor", "bias", "geometric_sd", "largest_factor", "tests", "without_ratio"):
            assert row[measure] == getattr(one.agreement, measure)
        assert row["rms_error [ug/m/mm^2]"] == pytest.approx(one.agreement.rms_error * 1e3, rel=4 * EPS)


def test_the_printed_table_has_the_same_numbers_to_four_digits() -> None:
    fit = wl.fit(EXACT | usfd(), scattered(), ["q_s"], bootstrap=0)
    comparison = wl.compare([fit, EXACT | wl.wear_law("kth")], scattered())
    title, heads, *lines = repr(comparison).splitlines()
    assert title == "2 predictors on 8 tests, best first; rms_error in µg/m/mm²"
    names = heads.split()
    assert names == [
        "predictor",
        "rms_factor",
        "bias",
        "geometric_sd",
        "largest_factor",
        "rms_error",
        "fitted",
        "aic",
        "aicc",
    ]
    table = comparison.table().rename(columns=lambda head: head.partition(" ")[0])
    for line, row in zip(lines, table.to_dict("records"), strict=True):
        cells = line.removeprefix(f"  {row['predictor']}").split()
        assert cells[:5] == [f"{row[name]:.4g}" for name in names[1:6]]
        assert cells[5:] == (["1", f"{row['aic']:.4g}", f"{row['aicc']:.4g}"] if "fitted" in row["predictor"] else [])


def test_the_predictions_stand_beside_the_tests() -> None:
    comparison = wl.compare({"ours": EXACT | usfd()}, scattered())
    frame = comparison.predictions()
    assert list(frame.columns) == [
        "creepage [%]", "max_pressure [MPa]", "friction_coefficient", "wear_rate [ug/m/mm^2]", "ours [ug/m/mm^2]",
    ]  # fmt: skip
    rates = made().wear_rate.magnitude
    np.testing.assert_allclose(frame["wear_rate [ug/m/mm^2]"], rates * SCATTER, rtol=4 * EPS)
    np.testing.assert_allclose(frame["ours [ug/m/mm^2]"], rates, rtol=4 * EPS)


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


def test_the_figure_has_lines_of_equality_and_of_a_factor_of_two() -> None:
    (panel,) = wl.compare([EXACT | usfd()], made()).figure_data().panels
    lines = {(curve.label, float(curve.y[0] / curve.x[0])) for curve in panel.curves if not curve.points}
    assert lines == {("predicted = measured", 1.0), ("factor of two", 0.5), ("factor of two", 2.0)}
    assert all(np.ptp(curve.y / curve.x) == 0.0 for curve in panel.curves if not curve.points)


def test_the_figure_can_be_drawn() -> None:
    data = wl.WearTests.from_arrays(
        creepage=Q(CREEPAGE, "%"),
        max_pressure="1500 MPa",
        friction_coefficient=0.46,
        wear_rate=made().wear_rate,
        source="a lab",
    )
    comparison = wl.compare([EXACT | usfd(), GLOBAL | wl.wear_law("brr")], data)
    assert len(comparison.plot().axes) == 2
    assert comparison.figure_data().caption == "8 tests of a lab. The lines are equality and a factor of two."
