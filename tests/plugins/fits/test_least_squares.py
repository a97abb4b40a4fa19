"""Least squares for one and for many sets of data, against scipy and closed forms."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy import optimize

from wearlaw_apps.fits.least_squares import STEP, TOLERANCE, Bounds, fit_many, search  # private: models with kinks

X = np.linspace(0.0, 3.0, 15)
WIDE = Bounds(np.full(2, -5.0), np.full(2, 5.0))


def decay(theta: Any) -> Any:
    """a exp(-b x)."""
    return theta[:, :1] * np.exp(-theta[:, 1:] * X)


def decay_slopes(theta: Any) -> Any:
    falling = np.exp(-theta[1] * X)
    return np.stack([falling, -theta[0] * X * falling], axis=-1)


def line(theta: Any) -> Any:
    return theta[:, :1] + theta[:, 1:] * X


def noisy(model: Any, theta: list[float], scatter: float, sets: int) -> Any:
    generator = np.random.default_rng(3)
    return model(np.array([theta])) + scatter * generator.standard_normal((sets, X.size))


@pytest.mark.validates(
    "fitting",
    "The solver of many fits at once, on a model that is not linear",
    source="Levenberg-Marquardt of scipy with exact derivatives",
    held_to="{tolerance:g}, and what difference quotients leave",
    tolerance=2.0 * TOLERANCE,
)
def test_every_one_of_many_fits_is_that_of_scipy(tolerance: float) -> None:
    targets = noisy(decay, [1.5, 0.7], 0.1, 50)
    found = fit_many(decay, targets, np.tile([1.0, 1.0], (50, 1)), WIDE)
    assert found.converged.all()
    for target, theta in zip(targets, found.theta, strict=True):
        solve: Any = optimize.least_squares  # its stubs know no `jac` that is a function
        exact = solve(
            lambda one, target=target: decay(one[None])[0] - target,
            [1.0, 1.0],
            jac=decay_slopes,
            method="lm",
            xtol=1e-15,
            ftol=1e-15,
            gtol=1e-15,
        )
        slopes = decay_slopes(exact.x)
        inverse = np.linalg.inv(slopes.T @ slopes)
        # A difference quotient is off by half a step times f'', here at most 2 x² exp(-b x) < 2; so is Jᵀr by that
        # times the residuals. Steps end below TOLERANCE, and shrink at least by half from one to the next.
        quotient = np.linalg.norm(inverse, 2) * STEP * max(exact.x.max(), 1.0) * 2.0 * np.abs(exact.fun).sum()
        assert np.abs(theta - exact.x).max() <= quotient + tolerance


@pytest.mark.validates(
    "fitting",
    "Fits with bounds on the parameters",
    source="scipy's lsq_linear (BVLS)",
    held_to="{tolerance:g}",
    tolerance=2.0 * TOLERANCE,
)
def test_fits_stay_within_their_bounds_and_end_where_a_bounded_line_does(tolerance: float) -> None:
    targets = noisy(line, [1.0, -2.0], 0.3, 20)
    bounds = Bounds(np.array([0.0, -1.5]), np.array([0.5, 5.0]))
    found = fit_many(line, targets, np.tile([0.2, 1.0], (20, 1)), bounds)
    columns = np.stack([np.ones_like(X), X], axis=-1)
    for target, theta in zip(targets, found.theta, strict=True):
        exact = optimize.lsq_linear(columns, target, (bounds.low, bounds.high), method="bvls", tol=1e-14).x
        np.testing.assert_allclose(theta, exact, atol=tolerance, rtol=0.0)


def test_a_model_is_never_asked_beyond_the_bounds() -> None:
    bounds = Bounds(np.array([0.0, 0.0]), np.array([1.2, 0.5]))

    def watched(theta: Any) -> Any:
        assert (theta >= bounds.low).all()
        assert (theta <= bounds.high).all()
        return decay(theta)

    targets = noisy(decay, [1.5, 0.7], 0.1, 10)
    found = fit_many(watched, targets, np.tile([1.2, 0.5], (10, 1)), bounds)
    assert (found.theta == bounds.high).any()
    search(watched, targets[0], np.array([0.4, 0.2]), bounds, WIDE, 20, 0)


def kinked(theta: Any) -> Any:
    """Pulled up to a kink at 0 by the first residual, and held there by the second."""
    return np.concatenate([theta - 1.0, 1.0 + 3.0 * np.maximum(theta, 0.0)], axis=-1)


def test_a_best_fit_on_a_kink_is_found() -> None:
    bounds = Bounds(np.array([-5.0]), np.array([5.0]))
    starts = np.array([[-3.0], [-0.1], [0.2], [4.0]])
    found = fit_many(kinked, np.zeros((4, 2)), starts, bounds)
    assert found.converged.all()
    # Within one step of the difference quotients from the kink, they mix the slopes of both sides.
    assert np.abs(found.theta).max() <= STEP


def wave(theta: Any) -> Any:
    return np.sin(theta * X)


def test_a_search_from_many_points_finds_what_one_start_does_not() -> None:
    bounds = Bounds(np.array([0.1]), np.array([12.0]))
    target = wave(np.array([[7.0]]))[0]
    assert search(wave, target, np.array([1.0]), bounds, bounds, 0, seed=0).cost[0] > 1.0
    best = search(wave, target, np.array([1.0]), bounds, bounds, 64, seed=0)
    assert best.theta[0, 0] == pytest.approx(7.0, abs=2.0 * TOLERANCE)
    assert best.converged[0]
