"""Intervals of fitted parameters: by Student's t from the covariance, and by a studentised bootstrap."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

from wearlaw.arrays import Array
from wearlaw_apps.fits.least_squares import Bounds, Model, Solutions, fit_many

BATCH = 250
"""Replicates fitted together; progress is reported after each batch."""

DECIDED_ALONE = 0.999
"""Leverage from which a test decides a parameter alone: its residual then does not measure the scatter."""

UNSEEN = 1e-6
"""Influence of a parameter, or of a combination of some, relative to the greatest, below which it counts as none: a
hundred times the error of the derivatives."""


@dataclass(frozen=True, slots=True, eq=False)
class Replicates:
    """Fits to data resampled from the residuals, (replicates, p), and the share of them that converged.

    The standard errors are from the covariance of each replicate, zero if it does not determine a parameter.
    """

    theta: Array
    standard_errors: Array
    converged: float


def covariance(fits: Solutions) -> Array:
    """Return the covariance of the parameters, s² (JᵀJ)⁻¹ with s² = Σr²/(n - p), of shape (sets, p, p)."""
    tests, count = fits.jacobian.shape[1:]
    variance = fits.cost / (tests - count)
    matrix: Array = variance[:, None, None] * _inverse_normal(fits.jacobian)
    return matrix


def undetermined(jacobian: Array) -> NDArray[np.bool_]:
    """Return which parameters tests leave open, (sets, p), alone or because only a combination of them matters."""
    size = np.linalg.norm(jacobian, axis=1)
    unseen = size <= UNSEEN * np.maximum(size.max(axis=-1, keepdims=True), UNSEEN)
    scaled = jacobian * np.where(unseen, 0.0, 1.0 / np.where(unseen, 1.0, size))[:, None, :]
    _, singular, directions = np.linalg.svd(scaled, full_matrices=False)
    # Parameters with a share of a tenth in an undetermined combination count.
    involved: NDArray[np.bool_] = (singular < UNSEEN)[..., None] & (np.abs(directions) > 0.1)
    return np.asarray(involved.any(axis=1))


def standard_errors(fits: Solutions) -> Array:
    """Return the standard errors of the parameters, (sets, p)."""
    errors: Array = np.sqrt(np.maximum(np.einsum("mpp->mp", covariance(fits)), 0.0))
    return errors


def leverage(fit: Solutions) -> Array:
    """Return the leverage of each test, (n,): how much its prediction follows its measurement, from 0 to 1."""
    slopes = fit.jacobian[0]
    leverages: Array = np.einsum("np,pq,nq->n", slopes, _inverse_normal(fit.jacobian)[0], slopes)
    return leverages


def studentised(residuals: Array, errors: Array, leverages: Array, count: int) -> Array:
    """Return residuals over what they scatter by the others alone, (n,); Student's t with n - p - 1 degrees of freedom.

    tᵢ = rᵢ/(s₍ᵢ₎ √(1 - hᵢ)), with the scatter s₍ᵢ₎ of a fit without test i. For a law that is linear over the scatter,
    s₍ᵢ₎² = (Σr² - rᵢ²/(1 - hᵢ))/(n - p - 1).

    Parameters
    ----------
    residuals, errors : ndarray, (n,)
        Residuals, and those from which the scatter follows; they differ in a robust fit.
    leverages : ndarray, (n,)
        hᵢ, as from `leverage`.
    count : int
        Number p of parameters.

    Returns
    -------
    ndarray, (n,)
        NaN for a test that decides a parameter alone, or if there are too few tests.

    Notes
    -----
    R. D. Cook and S. Weisberg, Residuals and Influence in Regression, Chapman and Hall 1982, section 2.2.
    """
    spare, degrees = 1.0 - leverages, residuals.size - count - 1
    usable = (leverages < DECIDED_ALONE) & (degrees > 0)
    size = np.where(usable, spare, 1.0)
    without = (np.sum(errors**2) - errors**2 / size) / max(degrees, 1)
    scatter = np.sqrt(np.maximum(without, 1e-3**2) * size)  # made-up tests scatter by less, and have no outliers
    return np.where(usable, residuals / scatter, np.nan)


def student_intervals(fit: Solutions, confidence: float) -> tuple[Array, Array]:
    """Return the ends of the intervals by Student's t with n - p degrees of freedom, each (p,)."""
    tests, count = fit.jacobian.shape[1:]
    reach = scipy.special.stdtrit(tests - count, 0.5 + 0.5 * confidence) * standard_errors(fit)[0]
    return fit.theta[0] - reach, fit.theta[0] + reach


def replicate(
    model: Model,
    fit: Solutions,
    errors: Array,
    bounds: Bounds,
    groups: NDArray[np.intp],
    count: int,
    seed: int,
    on_progress: Callable[[int], None] | None = None,
) -> Replicates:
    """Fit the model to the fitted values plus `errors` (n,) resampled within each of the `groups`, (n,).

    The errors are the residuals of the fit, or of a robust fit those of least squares with the same minimum. Since the
    fit follows each test, they are smaller than its scatter by √(1 - leverage). They are scaled up by that and centred
    in their group before they are drawn. `on_progress` is called with the number of replicates in each finished batch.

    Notes
    -----
    A. C. Davison and D. V. Hinkley, Bootstrap Methods and their Application, Cambridge 1997, after the example
    `nuclear` of the R package boot.
    """
    generator = np.random.default_rng(seed)
    predicted = fit.residuals[0]  # as good as the prediction, since the target of the model is zero
    scatter = errors / np.sqrt(1.0 - np.minimum(leverage(fit), DECIDED_ALONE))
    drawn = np.empty((count, scatter.size))
    for group in np.unique(groups):
        members = np.flatnonzero(groups == group)
        centred = scatter[members] - scatter[members].mean()
        drawn[:, members] = centred[generator.integers(0, members.size, (count, members.size))]
    fits = []
    for first in range(0, count, BATCH):
        targets = predicted - drawn[first : first + BATCH]
        start = np.broadcast_to(fit.theta[0], (len(targets), fit.theta.shape[1]))
        fits.append(fit_many(model, targets, start, bounds))
        if on_progress is not None:
            on_progress(len(targets))
    return Replicates(
        np.concatenate([batch.theta for batch in fits]),
        np.concatenate([np.where(undetermined(batch.jacobian), 0.0, standard_errors(batch)) for batch in fits]),
        float(np.mean(np.concatenate([batch.converged for batch in fits]))),
    )


def studentised_intervals(fit: Solutions, replicates: Replicates, confidence: float) -> tuple[Array, Array]:
    """Return the ends of the intervals, each (p,), from the distribution of (θ* - θ)/(standard error of θ*).

    Replicates that do not determine a parameter do not count for its interval.

    Notes
    -----
    B. Efron and R. J. Tibshirani, An Introduction to the Bootstrap, Chapman & Hall 1993, section 12.5.
    """
    errors = replicates.standard_errors
    ratio = np.divide(replicates.theta - fit.theta[0], errors, out=np.full_like(errors, np.nan), where=errors > 0.0)
    tail = 0.5 - 0.5 * confidence
    low, high = np.nanquantile(ratio, [tail, 1.0 - tail], axis=0)
    error = standard_errors(fit)[0]
    return fit.theta[0] - high * error, fit.theta[0] - low * error


def _inverse_normal(slopes: Array) -> Array:
    """Return (JᵀJ)⁻¹ of shape (sets, p, p), with zeros for parameters without influence."""
    size = np.linalg.norm(slopes, axis=1)
    seen = np.divide(1.0, size, out=np.zeros_like(size), where=size > 0.0)
    scaled = slopes * seen[:, None, :]
    normal = scaled.swapaxes(1, 2) @ scaled
    index = np.arange(size.shape[1])
    normal[:, index, index] = 1.0
    result: Array = np.linalg.pinv(normal, rcond=1e-12, hermitian=True) * seen[:, :, None] * seen[:, None, :]
    return result
