"""Intervals of fitted parameters: by Student's t from the covariance, and by a studentised bootstrap."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

from wearlaw.arrays.array import Array
from wearlaw.fitting.least_squares import Bounds, Model, Solutions, fit_many

BATCH = 250
"""Replicates fitted together; progress is reported after each batch."""

DECIDED_ALONE = 0.999
"""Leverage from which a test decides a parameter alone: its residual then does not measure the scatter."""

SINGULAR = 1e-12
"""Eigenvalues of JᵀJ, over the largest, that count as zero."""


@dataclass(frozen=True, slots=True, eq=False)
class Replicates:
    """Fits to data resampled from the residuals.

    Attributes
    ----------
    theta : ndarray, (replicates, p)
        Parameters.
    standard_errors : ndarray, (replicates, p)
        Standard errors of each replicate from its own covariance; zero if it does not determine a parameter.
    converged : float
        Share of the replicates that converged.
    """

    theta: Array
    standard_errors: Array
    converged: float


def covariance(fits: Solutions) -> Array:
    """Return the covariance of the parameters, s² (JᵀJ)⁻¹ with s² = Σr²/(n - p), of shape (sets, p, p)."""
    tests, count = fits.jacobian.shape[1:]
    variance = fits.cost / (tests - count)
    found: Array = variance[:, None, None] * _inverse_normal(fits.jacobian)
    return found


def standard_errors(fits: Solutions) -> Array:
    """Return the standard errors of the parameters, (sets, p)."""
    errors: Array = np.sqrt(np.maximum(np.einsum("mpp->mp", covariance(fits)), 0.0))
    return errors


def leverage(fit: Solutions) -> Array:
    """Return the leverage of each test, (n,): how much its prediction follows its measurement, from 0 to 1."""
    slopes = fit.jacobian[0]
    found: Array = np.einsum("np,pq,nq->n", slopes, _inverse_normal(fit.jacobian)[0], slopes)
    return found


def student_intervals(fit: Solutions, confidence: float) -> tuple[Array, Array]:
    """Return the ends of the intervals by Student's t with n - p degrees of freedom, each (p,)."""
    tests, count = fit.jacobian.shape[1:]
    reach = scipy.special.stdtrit(tests - count, 0.5 + 0.5 * confidence) * standard_errors(fit)[0]
    return fit.theta[0] - reach, fit.theta[0] + reach


def replicate(
    model: Model,
    fit: Solutions,
    bounds: Bounds,
    groups: NDArray[np.intp],
    count: int,
    seed: int,
    on_progress: Callable[[int], None] | None = None,
) -> Replicates:
    """Fit the model to the fitted values plus resampled residuals.

    Since the fit follows each test, its residual is smaller than its scatter by √(1 - leverage). Residuals are scaled
    up by that and centred in their group before they are drawn.

    Parameters
    ----------
    model : callable
        The fitted model.
    fit : Solutions
        The fit to one set of data.
    bounds : Bounds
        Bounds of the parameters.
    groups : ndarray of int, (n,)
        Kind of each measurement; residuals are drawn within each kind.
    count : int
        Number of replicates.
    seed : int
        Seed of the random numbers.
    on_progress : callable, optional
        Called with the number of replicates in each finished batch.

    Notes
    -----
    A. C. Davison and D. V. Hinkley, Bootstrap Methods and their Application, Cambridge 1997, after the example
    `nuclear` of the R package boot.
    """
    generator = np.random.default_rng(seed)
    predicted = fit.residuals[0]  # as good as the prediction, since the target of the model is zero
    scatter = predicted / np.sqrt(1.0 - np.minimum(leverage(fit), DECIDED_ALONE))
    drawn = np.empty((count, scatter.size))
    for group in np.unique(groups):
        members = np.flatnonzero(groups == group)
        centred = scatter[members] - scatter[members].mean()
        drawn[:, members] = centred[generator.integers(0, members.size, (count, members.size))]
    found = []
    for first in range(0, count, BATCH):
        targets = predicted - drawn[first : first + BATCH]
        start = np.broadcast_to(fit.theta[0], (len(targets), fit.theta.shape[1]))
        found.append(fit_many(model, targets, start, bounds))
        if on_progress is not None:
            on_progress(len(targets))
    return Replicates(
        np.concatenate([one.theta for one in found]),
        np.concatenate([np.where(_collinear(one.jacobian)[:, None], 0.0, standard_errors(one)) for one in found]),
        float(np.mean(np.concatenate([one.converged for one in found]))),
    )


def studentised_intervals(fit: Solutions, replicates: Replicates, confidence: float) -> tuple[Array, Array]:
    """Return the ends of the intervals, each (p,), from the distribution of (θ* - θ)/(standard error of θ*).

    Replicates that do not determine a parameter do not count for its interval.

    Notes
    -----
    B. Efron and R. J. Tibshirani, An Introduction to the Bootstrap, Chapman & Hall 1993, section 12.5.
    """
    own = replicates.standard_errors
    ratio = np.divide(replicates.theta - fit.theta[0], own, out=np.full_like(own, np.nan), where=own > 0.0)
    tail = 0.5 - 0.5 * confidence
    low, high = np.nanquantile(ratio, [tail, 1.0 - tail], axis=0)
    error = standard_errors(fit)[0]
    return fit.theta[0] - high * error, fit.theta[0] - low * error


def _inverse_normal(slopes: Array) -> Array:
    """Return (JᵀJ)⁻¹ of shape (sets, p, p), with zeros for parameters without influence."""
    normal, size = _scaled_normal(slopes)
    inverse = np.linalg.pinv(normal, rcond=SINGULAR, hermitian=True)
    seen = (size > 0.0).astype(np.float64)
    size = np.where(size > 0.0, size, 1.0)
    result: Array = inverse * (seen / size)[:, :, None] * (seen / size)[:, None, :]
    return result


def _collinear(slopes: Array) -> NDArray[np.bool_]:
    """Return the sets whose influential parameters cannot be told apart, as a mask (sets,)."""
    normal, _ = _scaled_normal(slopes)
    singular: NDArray[np.bool_] = np.linalg.eigvalsh(normal)[:, 0] < SINGULAR
    return singular


def _scaled_normal(slopes: Array) -> tuple[Array, Array]:
    """Return JᵀJ for columns scaled to length one, and the lengths; the diagonal is one even for length zero."""
    size = np.linalg.norm(slopes, axis=1)
    scaled = slopes / np.where(size > 0.0, size, 1.0)[:, None, :]
    normal = scaled.swapaxes(1, 2) @ scaled
    index = np.arange(size.shape[1])
    normal[:, index, index] = 1.0
    return normal, size
