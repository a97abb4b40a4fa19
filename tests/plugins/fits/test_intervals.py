"""Intervals of fitted parameters, against textbook formulas and known distributions."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy import stats

from wearlaw_apps.fits.intervals import (  # private: a line, whose intervals are in textbooks
    covariance,
    leverage,
    replicate,
    standard_errors,
    student_intervals,
    studentised_intervals,
)
from wearlaw_apps.fits.least_squares import Bounds, Solutions, fit_many  # private: as above

WIDE = Bounds(np.full(2, -50.0), np.full(2, 50.0))
X = np.linspace(0.0, 3.0, 12)
ONE_GROUP = np.zeros(X.size, dtype=np.intp)


def to(model: Any, target: Any) -> Any:
    """Return the model of residuals, whose target is zero."""
    return lambda theta: model(theta) - target


def line(theta: Any) -> Any:
    return theta[:, :1] + theta[:, 1:] * X


def fitted(model: Any, start: Any, bounds: Bounds = WIDE) -> Solutions:
    tests = model(np.array([start])).shape[1]
    return fit_many(model, np.zeros((1, tests)), np.array([start]), bounds)


def straight(scatter: Any) -> tuple[Any, Solutions, Any]:
    target = 1.0 - 2.0 * X + scatter
    model = to(line, target)
    return model, fitted(model, [0.0, 0.0]), target


@pytest.mark.validates(
    "fitting",
    "Standard errors and covariance of a line",
    source="scipy's linregress; the normal equations",
    held_to="{within:g}, relative",
    within=1e-06,
)
def test_the_covariance_of_a_line_is_that_of_linear_regression(within: float) -> None:
    _, fit, target = straight(np.random.default_rng(0).standard_normal(X.size))
    textbook: Any = stats.linregress(X, target)
    np.testing.assert_allclose(standard_errors(fit)[0], [textbook.intercept_stderr, textbook.stderr], rtol=within)
    columns = np.stack([np.ones_like(X), X], axis=-1)
    variance = fit.cost[0] / (X.size - 2)
    np.testing.assert_allclose(covariance(fit)[0], variance * np.linalg.inv(columns.T @ columns), rtol=within)


def test_the_leverage_of_a_line_is_that_of_the_textbook() -> None:
    _, fit, _ = straight(np.random.default_rng(0).standard_normal(X.size))
    exact = 1.0 / X.size + (X - X.mean()) ** 2 / np.sum((X - X.mean()) ** 2)
    np.testing.assert_allclose(leverage(fit), exact, rtol=1e-6)


@pytest.mark.validates(
    "fitting",
    "The studentised bootstrap with normal scatter",
    source="Student's t",
    held_to="{tails:g} + {draws:g} standard errors (its tails and its draws)",
    tails=0.3,
    draws=4.0 * 0.04,
)
def test_for_normal_scatter_the_bootstrap_agrees_with_student(tails: float, draws: float) -> None:
    # The residuals of the fit are the quantiles of a normal distribution, in an order that is orthogonal to the line.
    scatter = stats.norm.ppf((np.arange(X.size) + 0.5) / X.size)[np.random.default_rng(4).permutation(X.size)]
    model, fit, _ = straight(scatter)
    replicates = replicate(model, fit, fit.residuals[0], WIDE, ONE_GROUP, 8000, seed=0)
    by_bootstrap, by_student = studentised_intervals(fit, replicates, 0.95), student_intervals(fit, 0.95)
    error = standard_errors(fit)[0]
    # A quantile t of 8000 draws has the standard error √(0.025 · 0.975/8000)/density(t), 0.04 with 10 degrees of
    # freedom; twelve residuals have no tails beyond 1.7, which takes less than 0.3 from a quantile of 2.23.
    for ours, theirs in zip(by_bootstrap, by_student, strict=True):
        assert np.abs((ours - theirs) / error).max() < tails + draws


def mean_of(target: Any) -> Any:
    return lambda theta: theta - target


def test_for_skewed_scatter_the_interval_reaches_farther_to_the_side_of_the_tail() -> None:
    target = np.random.default_rng(1).exponential(size=15)
    bounds = Bounds(np.array([-50.0]), np.array([50.0]))
    fit = fitted(mean_of(target), [0.0], bounds)
    replicates = replicate(mean_of(target), fit, fit.residuals[0], bounds, np.zeros(15, dtype=np.intp), 2000, seed=0)
    low, high = studentised_intervals(fit, replicates, 0.95)
    mean = target.mean()
    assert fit.theta[0, 0] == pytest.approx(mean, rel=1e-8)
    # The mean of few values with a long upper tail is more often far too low than far too high.
    assert high[0] - mean > 1.2 * (mean - low[0])


def test_residuals_are_drawn_as_large_as_the_scatter_is() -> None:
    # With four tests and two parameters, plain residuals are half as large in the square as the scatter.
    x, scatter = np.array([0.0, 1.0, 2.0, 3.0]), np.array([1.0, -2.0, 0.5, 1.5])

    def model(theta: Any) -> Any:
        return theta[:, :1] + theta[:, 1:] * x - scatter

    fit = fitted(model, [0.0, 0.0])
    replicates = replicate(model, fit, fit.residuals[0], WIDE, np.zeros(4, dtype=np.intp), 20000, seed=0)
    drawn = fit.residuals[0] / np.sqrt(1.0 - leverage(fit))
    columns = np.stack([np.ones(4), x], axis=-1)
    exact = drawn.var() * np.linalg.inv(columns.T @ columns)
    # The variance of 20000 draws is known to √(2/20000), 1 %, for normal ones, and less for those without tails.
    np.testing.assert_allclose(np.cov(replicates.theta.T), exact, rtol=0.04, atol=0.02 * exact.max())


def test_residuals_are_drawn_within_their_group() -> None:
    groups = np.repeat([0, 1], 6)
    scatter = np.where(groups == 0, 1e-3, 10.0) * np.random.default_rng(2).standard_normal(12)

    def model(theta: Any) -> Any:
        return np.where(groups == 0, theta[:, :1], theta[:, 1:]) - scatter

    fit = fitted(model, [0.0, 0.0])
    spread = replicate(model, fit, fit.residuals[0], WIDE, groups, 500, seed=0).theta.std(axis=0)
    assert spread[0] < 1e-3
    assert spread[1] > 1.0


W = np.concatenate([np.geomspace(0.5, 9.0, 7), np.linspace(12.0, 72.0, 6), np.linspace(82.0, 130.0, 7)])
TRUE = np.array([5.3, 55.0, 61.9, 77.26])


def usfd(theta: Any) -> Any:
    """The logarithm of the USFD law on patch means, by the logarithms of its parameters over the true ones."""
    m_m, q_s, m_c, tr_sc = (np.exp(theta[:, [column]]) * TRUE[column] for column in range(4))
    return np.log(np.minimum(m_m * W, q_s) + m_c * np.maximum(W - tr_sc, 0.0))


@pytest.mark.validates(
    "fitting",
    "Intervals of {level:.0%} hold the true parameters of USFD that often",
    source="100 synthetic data sets",
    held_to="not fewer than a binomial does with a probability of {chance:g}",
    level=0.95,
    chance=0.001,
)
def test_intervals_of_a_law_with_kinks_hold_the_true_parameters_as_often_as_they_say(
    level: float, chance: float
) -> None:
    fits, bounds = 100, Bounds(np.full(4, -3.0), np.full(4, 3.0))
    targets = usfd(np.zeros((1, 4))) + 0.1 * np.random.default_rng(5).standard_normal((fits, W.size))
    best = fit_many(usfd, targets, np.zeros((fits, 4)), bounds)
    held = np.zeros(4)
    for number in range(fits):
        one = best[number]
        model = to(usfd, targets[number])
        replicates = replicate(model, one, one.residuals[0], bounds, np.zeros(W.size, dtype=np.intp), 200, number)
        low, high = studentised_intervals(one, replicates, level)
        held += (low <= 0.0) & (high >= 0.0)
    # Of 100 intervals that hold the truth with probability 0.95, fewer than these 87 do once in a thousand times.
    # Plain percentiles of unscaled residuals hold it 83 to 90 times here.
    assert held.min() >= stats.binom.ppf(chance, fits, level)
