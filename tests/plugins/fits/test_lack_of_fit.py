"""Lack of fit: its tests against published numbers, other statistics and by simulation, and what `fit` says of it."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy import stats

import wearlaw as wl
from tests.plugins.fits.fits import FRICTION, PRESSURE, usfd
from wearlaw import Q
from wearlaw.errors import FitWarning
from wearlaw_apps.fits import Fit, WearTests
from wearlaw_apps.fits.lack_of_fit import lack_of_fit, repeats  # private: the example of a textbook

CREEPAGE = [0.2, 0.4, 0.6, 0.8]
"""All within the mild regime of USFD, where wear is m_m times the wear-index density."""


def repeated(effect: Any, each: int, scatter: float, **more: Any) -> WearTests:
    """Return repeated tests in the mild regime, off a law by the logarithms `effect` at each creepage."""
    creepage = np.repeat(CREEPAGE, each)
    conditions: Any = {"creepage": Q(creepage, "%"), "max_pressure": PRESSURE, "friction_coefficient": FRICTION}
    scattered = scatter * np.random.default_rng(5).standard_normal(creepage.size)
    factor = np.exp(np.repeat(effect, each) + scattered)
    return WearTests.from_arrays(**conditions, wear_rate=usfd("exact")(**conditions).wear_rate * factor, **more)


def fitted(tests: WearTests, poor: bool, **options: Any) -> Fit:
    """Return the fit of m_m, which warns if it is poor."""
    if poor:
        with pytest.warns(FitWarning, match="lack of fit.*wear rate"):
            return wl.fit(usfd("exact"), tests, ["m_m"], bootstrap=0, **options)
    return wl.fit(usfd("exact"), tests, ["m_m"], bootstrap=0, **options)


@pytest.mark.validates(
    "fitting",
    "F of the lack of fit of a line to repeated tests",
    source="J. Neter, W. Wasserman and M. H. Kutner, Applied Linear Statistical Models, the example of the bank",
    held_to="its printed digits, F = {f:g} and p = {p:g}",
    f=14.80,
    p=0.006,
)
def test_the_lack_of_fit_of_a_line_is_that_of_the_textbook(f: float, p: float) -> None:
    deposit = np.array([125, 100, 200, 75, 150, 175, 75, 175, 125, 200, 100])
    accounts = np.array([160, 112, 124, 28, 152, 156, 42, 124, 150, 104, 136])
    line: Any = stats.linregress(deposit, accounts)
    residuals = accounts - line.intercept - line.slope * deposit
    found = lack_of_fit("accounts", residuals, repeats({"deposit": deposit}, 11), 2.0, 0.95)
    assert found is not None
    assert (round(found.value, 2), found.degrees, round(found.p_value, 3)) == (f, (4.0, 5.0), p)
    assert found.poor


@pytest.mark.parametrize("known_scatter", [False, True])
def test_p_is_uniform_if_the_model_is_right(known_scatter: bool) -> None:
    generator = np.random.default_rng(2)
    points = np.repeat(np.arange(6), 3)
    design = np.stack([np.ones(18), points.astype(float)], axis=-1)
    residuals = generator.standard_normal((2000, 18)) @ (np.eye(18) - design @ np.linalg.pinv(design))
    checks = [lack_of_fit("y", row, points, 2.0, 0.95, known_scatter) for row in residuals]
    assert stats.kstest([one.p_value for one in checks if one], "uniform").pvalue > 0.001


@pytest.mark.parametrize("effect", [(0.0, 0.0, 0.0, 0.0), (0.3, -0.3, 0.2, -0.2)])
def test_with_one_factor_free_it_is_the_one_way_analysis_of_variance(effect: Any) -> None:
    tests, predict = repeated(effect, 3, 0.05), usfd("exact")
    predicted = predict(creepage=tests.creepage, max_pressure=PRESSURE, friction_coefficient=FRICTION).wear_rate
    expected = stats.f_oneway(*np.log(tests.wear_rate.magnitude / predicted.magnitude).reshape(4, 3))
    fit = fitted(tests, poor=any(effect))
    (check,) = fit.lack_of_fit
    # The search ends within about 1e-8 of the best m_m, where the sum of squares is flat.
    assert (check.method, check.poor) == ("repeats", any(effect))
    assert list(check.degrees) == pytest.approx([3.0, 8.0], rel=1e-6)
    assert (check.value, check.p_value) == pytest.approx((expected.statistic, expected.pvalue), rel=1e-5)
    assert f"F = {check.value:.3g} with 3 and 8 degrees of freedom" in repr(fit)
    # The confidence decides.
    fitted(tests, poor=True, confidence=1.0 - 1.1 * check.p_value)
    fitted(tests, poor=False, confidence=1.0 - 0.9 * check.p_value)


@pytest.mark.parametrize(("share", "poor"), [(0.1, False), (0.01, True)])
def test_stated_uncertainties_are_held_against_the_residuals(share: float, poor: bool) -> None:
    rate = repeated((0.0, 0.1, 0.1, 0.0), 1, 0.0).wear_rate
    tests = repeated((0.0, 0.1, 0.1, 0.0), 1, 0.0, wear_rate_uncertainty=share * rate)
    (check,) = fitted(tests, poor).lack_of_fit
    # The weighted mean of the ratios 1/(measured/law), by hand.
    ratio = np.exp([0.0, 0.1, 0.1, 0.0])
    best = np.sum(1.0 / ratio) / np.sum(1.0 / ratio**2)
    expected = np.sum(((best / ratio - 1.0) / share) ** 2)
    assert (check.method, check.poor) == ("uncertainty", poor)
    assert (check.degrees[0], 3.0 * check.value) == pytest.approx((3.0, expected), rel=1e-6)
    assert check.p_value == pytest.approx(stats.chi2.sf(expected, 3), rel=1e-4, abs=1e-300)


def test_each_kind_of_measurement_is_tested() -> None:
    """The degrees of freedom of both kinds add up to the points less the parameters."""
    predict = usfd("exact")
    creepage = np.repeat([0.1, 0.3, 0.5, 0.8, 1.5], 3)
    given: Any = {"creepage": Q(creepage, "%"), "max_pressure": PRESSURE}
    found = predict(**given, friction_coefficient=FRICTION)
    one, two = np.exp(0.05 * np.random.default_rng(3).standard_normal((2, creepage.size)))
    tests = WearTests.from_arrays(
        **given, wear_rate=found.wear_rate * one, traction_coefficient=found.traction_coefficient * two
    )
    fit = wl.fit(predict, tests, ["m_m", "friction_coefficient"], bootstrap=0)
    assert [(one.observable, one.poor) for one in fit.lack_of_fit] == [
        ("wear_rate", False),
        ("traction_coefficient", False),
    ]
    assert sum(one.degrees[0] for one in fit.lack_of_fit) == pytest.approx(10 - 2, rel=1e-9)
