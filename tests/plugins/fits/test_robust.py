"""Outliers by studentised residuals, and fits by robust losses."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy import optimize, stats

import wearlaw as wl
from tests.plugins.fits.fits import EXACT
from wearlaw import Q
from wearlaw.errors import FitError, FitWarning
from wearlaw_apps.fits import WearTests
from wearlaw_apps.fits.intervals import studentised  # private: of any least squares
from wearlaw_apps.fits.least_squares import LOSSES  # private: the losses that there are

X = np.stack([np.ones(12), np.linspace(-1.0, 2.0, 12)], axis=-1)
HAT = np.einsum("np,pq,nq->n", X, np.linalg.inv(X.T @ X), X)


def residuals_of(y: Any) -> Any:
    return X @ np.linalg.lstsq(X, y, rcond=None)[0] - y


@pytest.mark.validates(
    "fitting",
    "Studentised residuals, of a law that is linear over the scatter",
    source="fits without each test",
    held_to="{within:g}, relative",
    within=1e-10,
)
def test_a_studentised_residual_is_the_error_of_a_fit_without_the_test(within: float) -> None:
    y = np.random.default_rng(3).standard_normal(12)
    residuals = residuals_of(y)
    got = studentised(residuals, residuals, HAT, 2)
    for i in range(12):
        others = np.arange(12) != i
        best, cost, *_ = np.linalg.lstsq(X[others], y[others], rcond=None)
        spread = math.sqrt(cost[0] / (11 - 2) * (1.0 + X[i] @ np.linalg.inv(X[others].T @ X[others]) @ X[i]))
        # Condition numbers below 10, and some hundred roundings.
        assert got[i] == pytest.approx((X[i] @ best - y[i]) / spread, rel=within)


def test_a_set_of_tests_without_outliers_has_one_as_seldom_as_stated() -> None:
    """Bonferroni: of normal errors, at most 1 % of the sets have a residual beyond the level over 12 tests."""
    generator, most = np.random.default_rng(0), stats.t.ppf(1.0 - 0.005 / 12, 9)
    count = 5000
    false = 0
    for _ in range(count):
        residuals = residuals_of(generator.standard_normal(12))
        false += bool((np.abs(studentised(residuals, residuals, HAT, 2)) > most).any())
    # The bound is nearly reached, since two such residuals in one set are rare; 0.1 % chance of failing either way.
    assert stats.binom.ppf(0.001, count, 0.009) <= false <= stats.binom.ppf(0.999, count, 0.01)


CREEPAGE = Q(np.linspace(0.5, 5.0, 15), "%")
TEST: Any = {"creepage": CREEPAGE, "normal_force": "7 kN", "friction_coefficient": 0.45}
PREDICT = EXACT | wl.wear_law("energy", mass_per_energy="5 ug/J")
ERRORS = 0.05 * np.random.default_rng(2).standard_normal(15)
ERRORS[[3, 11]] += 0.8, 0.5


def scattered(errors: Any = ERRORS, **more: Any) -> WearTests:
    labels = [f"run {number}" for number in range(15)]
    rate = PREDICT(**TEST).wear_rate * np.exp(errors)
    return WearTests.from_arrays(**TEST, wear_rate=rate, labels=labels, **more)


def fitted(**options: Any) -> Any:
    return wl.fit(PREDICT, scattered(), ["mass_per_energy"], **{"bootstrap": 0, **options})


def test_outliers_are_named_and_stay() -> None:
    with pytest.warns(FitWarning, match=r"outliers: test run 3 \(wear rate, -\d.*at a level of 1% over all tests"):
        fit = fitted()
    assert fit.most == pytest.approx(stats.t.ppf(1.0 - 0.005 / 15, 13), rel=1e-12)
    assert fit.outliers["label"].tolist() == ["run 3"]  # it hides the smaller one
    assert "outlier               test run 3: studentised residual" in repr(fit)
    assert fit.parameters["mass_per_energy"].magnitude == pytest.approx(5.0 * np.exp(ERRORS.mean()), rel=1e-8)
    clean = wl.fit(PREDICT, scattered(np.where(ERRORS > 0.2, 0.0, ERRORS)), ["mass_per_energy"], bootstrap=0)
    assert not len(clean.outliers)


@pytest.mark.parametrize("loss", [name for name in LOSSES if name != "linear"])
def test_a_robust_fit_is_that_of_scipy(loss: Any) -> None:
    with pytest.warns(FitWarning, match="run 3 .* run 11"):
        fit = fitted(robust=loss)
    theta = math.log(fit.parameters["mass_per_energy"].magnitude / 5.0)
    scale = 2.0 * 1.4826 * np.median(np.abs(theta - ERRORS))
    exact: Any = {"xtol": 1e-15, "ftol": 1e-15, "gtol": 1e-15}
    found = optimize.least_squares(lambda x: x[0] - ERRORS, [theta + 0.01], loss=loss, f_scale=scale, **exact)
    # Each round leaves the share 1 - ψ'/ρ' of the last change, at most 0.9 of 1e-7 here; scipy's end is finer.
    assert theta == pytest.approx(found.x[0], abs=1e-6)


def test_the_interval_of_a_robust_fit_is_that_of_huber() -> None:
    """V = s² Σψ²/(n - p)/(mean ψ')²/n for a mean, with ψ(u) = u (1 + u²)^-1/2 and ψ' = (1 + u²)^-3/2."""
    with pytest.warns(FitWarning, match="outliers"):
        fit, boot = (fitted(robust="soft_l1", bootstrap=count) for count in (0, 1000))
    theta = math.log(fit.parameters["mass_per_energy"].magnitude / 5.0)
    scale = 2.0 * 1.4826 * np.median(np.abs(theta - ERRORS))
    size = (theta - ERRORS) / scale
    variance = scale**2 * np.sum(size**2 / (1.0 + size**2)) / 14.0 / np.mean((1.0 + size**2) ** -1.5) ** 2 / 15.0
    relative = fit.standard_errors["mass_per_energy"] / fit.parameters["mass_per_energy"]
    # ψ' is a difference quotient of step 1.5e-8, with an error of rounding of about 1e-8.
    assert relative.magnitude == pytest.approx(math.sqrt(variance), rel=1e-6)
    ends = [np.log(end.magnitude / 5.0) - theta for end in boot.intervals["mass_per_energy"]]
    reach = stats.t.ppf(0.975, 14) * math.sqrt(variance)
    assert -2.0 * reach < ends[0] < 0.0 < ends[1] < 2.0 * reach


def test_stated_uncertainties_are_the_scale_of_a_robust_fit() -> None:
    tests = scattered(wear_rate_uncertainty=0.05 * PREDICT(**TEST).wear_rate)
    with pytest.warns(FitWarning):
        fit = wl.fit(PREDICT, tests, ["mass_per_energy"], bootstrap=0, robust="cauchy")
    truth = 1.0 / 0.05
    measured = truth * np.exp(ERRORS)
    exact: Any = {"xtol": 1e-15, "ftol": 1e-15, "gtol": 1e-15}
    found = optimize.least_squares(lambda x: x[0] * truth - measured, [1.0], loss="cauchy", f_scale=2.0, **exact)
    assert fit.parameters["mass_per_energy"].magnitude / 5.0 == pytest.approx(found.x[0], rel=1e-6)


def test_an_unknown_loss_is_refused() -> None:
    with pytest.raises(FitError, match="robust: must be one of 'linear', 'huber'"):
        fitted(robust="hubert")
