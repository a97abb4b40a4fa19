"""What a fit holds, prints, draws and writes."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.figure import Figure
from scipy import stats

import wearlaw as wl
from tests.plugins.fits.fits import ALL, CREEPAGE, EXACT, FRICTION, PRESSURE, RIG, made_up, usfd
from tests.strategies import EPS
from wearlaw import Q
from wearlaw_apps.fits import Fit, WearTests
from wearlaw_apps.output.curves import head_of_legend  # private: what the legend explains


@pytest.fixture(scope="module")
def exact_fit() -> Fit:
    predict = usfd("exact")
    return wl.fit(predict, made_up(predict, 0.1, source="made up"), free=ALL, bootstrap=300)


def test_the_fitted_law_knows_what_it_was_fitted_to(exact_fit: Fit) -> None:
    law: Any = exact_fit.law
    calibration = law.calibration
    assert calibration.source == "fitted to 20 tests of made up"
    assert calibration.scale == "cells"
    assert calibration.options == (("slip", "consistent"),)
    assert calibration.covers(EXACT.contact_model, "cells")
    (low, high) = calibration.range_in_si["wear_index_density"]
    contact = exact_fit.predict(creepage=Q(CREEPAGE, "%"), max_pressure=PRESSURE, friction_coefficient=FRICTION)
    tested = contact.wear_index_density.to("N/m^2").magnitude
    assert low <= tested.min() < 1.001 * low
    assert high >= tested.max() > 0.999 * high
    mean_pressure, of_disc_1 = 0.25 * np.pi * PRESSURE.to("Pa").magnitude, RIG.rolling_speed.to("m/s").magnitude
    low, high = calibration.range_in_si["pressure"]
    assert low <= mean_pressure * (1 + 4 * EPS)
    assert mean_pressure * (1 - 4 * EPS) <= high <= 1.001 * low
    low, high = calibration.range_in_si["slip_speed"]
    # v1 - v2 = ξV with V = v1/(1 + ξ/2)
    slowest, fastest = (of_disc_1 * 0.01 * x / (1.0 + 0.005 * x) for x in (CREEPAGE[0], CREEPAGE[-1]))
    assert low <= slowest < 1.001 * low
    assert high >= fastest > 0.999 * high
    assert calibration.bodies == (RIG.disc_1.material, RIG.disc_2.material)


def test_the_fitted_pipeline_predicts_what_the_residuals_say(exact_fit: Fit) -> None:
    table = exact_fit.residuals
    predicted: Any = exact_fit.predict(creepage=Q(CREEPAGE, "%"), max_pressure=PRESSURE, friction_coefficient=FRICTION)
    np.testing.assert_allclose(table["predicted"], predicted.wear_rate.magnitude, rtol=1e-9)
    np.testing.assert_allclose(table["residual"], np.log(table["predicted"] / table["measured"]), atol=1e-12)
    np.testing.assert_allclose(table["measured"], exact_fit.tests.wear_rate.magnitude, rtol=1e-12)
    np.testing.assert_allclose(table["creepage [%]"], CREEPAGE, rtol=1e-12)
    assert exact_fit.chi2 == pytest.approx(np.sum(table["residual"] ** 2), rel=1e-9)
    assert exact_fit.aic == pytest.approx(20 * np.log(exact_fit.chi2 / 20) + 2 * 5, rel=1e-9)


def test_standard_errors_and_correlations_are_those_of_the_covariance(exact_fit: Fit) -> None:
    reach = stats.t.ppf(0.975, 16)
    for name, (low, high) in exact_fit.covariance_intervals.items():
        value, error = exact_fit.parameters[name].magnitude, exact_fit.standard_errors[name].magnitude
        # The interval is symmetric in the logarithm.
        assert high.magnitude == pytest.approx(value * np.exp(reach * error / value), rel=1e-9)
        assert low.magnitude == pytest.approx(value * np.exp(-reach * error / value), rel=1e-9)
    assert np.diag(exact_fit.correlation) == pytest.approx(1.0)
    assert exact_fit.correlation[2, 3] > 0.5  # a steeper rise that begins later
    assert np.abs(exact_fit.correlation).max() <= 1.0 + 1e-12


@pytest.mark.validates(
    "reproducibility",
    "A fit with its bootstrap, made again with the same seed",
    source="the first fit",
    held_to="to the bit",
)
def test_a_fit_is_determined_by_its_seed(exact_fit: Fit) -> None:
    predict, tests = usfd("exact"), exact_fit.tests
    again = wl.fit(predict, tests, free=ALL, bootstrap=300)
    other = wl.fit(predict, tests, free=ALL, bootstrap=300, seed=1)
    assert again.parameters == exact_fit.parameters
    assert again.intervals == exact_fit.intervals
    assert other.intervals != exact_fit.intervals
    for name in ALL:  # the best fit does not depend on where the search began
        assert other.parameters[name].magnitude == pytest.approx(exact_fit.parameters[name].magnitude, rel=1e-6)


@pytest.mark.validates(
    "reproducibility",
    "A fitted law written to a file and read back",
    source="the law before",
    held_to="equal",
)
def test_a_law_that_was_written_reads_back_equal(exact_fit: Fit, tmp_path: Path) -> None:
    path = tmp_path / "my-usfd.toml"
    path.write_text("an older file")
    exact_fit.to_toml(path)
    assert wl.read_law(path) == exact_fit.law
    assert [file.name for file in tmp_path.iterdir()] == ["my-usfd.toml"]
    provenance = tomllib.loads(path.read_text(encoding="utf-8"))["provenance"]
    assert provenance["wearlaw"] == wl.__version__
    assert provenance["laws"] == {"usfd": f"wearlaw {wl.__version__}"}
    assert (provenance["tests"], provenance["measurements"]) == ("made up", {"wear_rate": 20})
    assert (provenance["free"], provenance["seed"], provenance["bootstrap"]) == (list(ALL), 0, 300)
    assert provenance["chi2"] == exact_fit.chi2


def test_the_figure_holds_the_measurements_and_a_curve_through_the_fit_with_a_band(exact_fit: Fit) -> None:
    (panel,) = exact_fit.figure_data().panels
    curve, points = panel.curves
    np.testing.assert_allclose(points.y, exact_fit.tests.wear_rate.magnitude, rtol=1e-12)
    assert points.points
    assert not curve.points
    assert curve.low is not None
    assert curve.high is not None
    assert (np.diff(curve.x) > 0.0).all()
    assert ((curve.low <= curve.y) & (curve.y <= curve.high)).mean() > 0.95
    # The curve passes through what is predicted for the tests.
    predicted = exact_fit.residuals["predicted"].to_numpy()
    assert np.interp(points.x, curve.x, curve.y) == pytest.approx(predicted, rel=1e-9)
    assert isinstance(exact_fit.plot().figure, Figure)


def test_tests_at_several_loads_are_drawn_against_the_fit() -> None:
    predict = usfd("exact")
    conditions: Any = {
        "creepage": Q(np.geomspace(0.2, 8.0, 8), "%"),
        "max_pressure": Q(np.tile([900.0, 1500.0], 4), "MPa"),
        "friction_coefficient": np.full(8, 0.4),
    }
    tests = WearTests.from_arrays(**conditions, wear_rate=predict(**conditions).wear_rate * np.linspace(0.9, 1.1, 8))
    fit = wl.fit(predict, tests, free=["m_m"], bootstrap=0)
    (panel,) = fit.figure_data().panels
    *guides, shown = panel.curves
    assert not any(curve.computed for curve in guides)  # their ends are no tests
    assert [(curve.points, float(curve.y[0] / curve.x[0])) for curve in guides] == [
        (False, 1.0), (False, 0.5), (False, 2.0)
    ]  # fmt: skip
    assert (shown.points, shown.hollow) == (True, True)
    assert not head_of_legend(fit.figure_data())
    np.testing.assert_array_equal(shown.x, fit.residuals["predicted"])
    np.testing.assert_array_equal(shown.y, fit.residuals["measured"])
    assert [(axis.label, axis.scale) for axis in (panel.x, panel.y)] == [
        ("predicted wear rate [µg/m/mm²]", "log"), ("measured wear rate [µg/m/mm²]", "log")
    ]  # fmt: skip


@pytest.mark.parametrize("varied", ["max_pressure", "friction_coefficient"])
def test_tests_that_differ_in_one_condition_have_a_curve_over_it(varied: str) -> None:
    predict = usfd("exact")
    conditions: Any = {"creepage": "1 %", "max_pressure": "1200 MPa", "friction_coefficient": 0.4}
    conditions[varied] = {
        "max_pressure": Q([1500.0, 600.0, 900.0, 1200.0], "MPa"), "friction_coefficient": np.array([0.3, 0.2, 0.5, 0.4])
    }[varied]  # fmt: skip
    factor = np.array([1.1, 0.9, 1.05, 0.95])
    tests = WearTests.from_arrays(**conditions, wear_rate=predict(**conditions).wear_rate * factor)
    fit = wl.fit(predict, tests, free=["m_m"], bootstrap=0)
    (panel,) = fit.figure_data().panels
    curve, points = panel.curves
    assert (curve.points, points.points) == (False, True)
    assert (panel.x.label.partition(" [")[0], panel.x.scale) == (
        {"max_pressure": "maximum pressure", "friction_coefficient": "friction coefficient"}[varied], "linear"
    )  # fmt: skip
    given = conditions[varied]
    np.testing.assert_allclose(points.x, getattr(given, "magnitude", given), rtol=4 * EPS)
    assert (np.diff(curve.x) > 0.0).all()
    # Between the tests too, the curve is what the fitted law predicts.
    over = Q(curve.x, "MPa") if varied == "max_pressure" else curve.x
    expected = fit.predict(**{**conditions, varied: over}).wear_rate.magnitude
    np.testing.assert_allclose(curve.y, expected, rtol=1e-9)


@pytest.mark.filterwarnings("ignore::wearlaw.errors.FitWarning")
def test_a_notebook_shows_a_fit_and_a_comparison_as_tables(exact_fit: Fit) -> None:
    html = exact_fit._repr_html_()
    assert html.count("<tr>") == len(exact_fit.parameters) + 2
    assert "<td>q_s</td>" in html
    found = wl.compare({"a <b>": exact_fit, "plain": exact_fit.predict}, exact_fit.tests)._repr_html_()
    assert "a &lt;b&gt;" in found
    assert found.count("<tr") == 3
    assert "2 predictors on 20 tests" in found
