"""Least squares within bounds, for one set of data and for thousands at once.

All functions take a *model* of many parameter sets, from θ of shape (sets, p) to predictions for the n tests of shape
(sets, n). Parameters should be scaled: of order one, or logarithms of ratios.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import scipy
from numpy.typing import NDArray

from wearlaw.arrays import Array

Model: TypeAlias = Callable[[Array], Array]
"""From parameter sets (sets, p) to predictions (sets, n)."""

STEP = float(np.sqrt(np.finfo(np.float64).eps))
"""Step of the difference quotients, for which truncation and rounding errors are about equal."""

TOLERANCE = 1e-9
"""Change of the parameters below which a fit has converged."""

SOFTEST, STIFFEST = 1e-12, 1e12
"""Least and greatest damping. At the greatest one, a step is as small as rounding. A fit that it does not improve has
converged: the best fit may lie on a kink of the model, where the gradient does not vanish."""


LOSSES: Mapping[str, Callable[[Array], Array]] = {
    "linear": np.ones_like,
    "huber": lambda z: 1.0 / np.sqrt(np.maximum(z, 1.0)),
    "soft_l1": lambda z: 1.0 / np.sqrt(1.0 + z),
    "cauchy": lambda z: 1.0 / (1.0 + z),
    "arctan": lambda z: 1.0 / (1.0 + z**2),
}
"""Slopes dρ/dz of scipy's losses in z = r²: the weights of r² in least squares with the same minimum."""


@dataclass(frozen=True, slots=True, eq=False)
class Bounds:
    """The least and the greatest parameters, each of shape (p,)."""

    low: Array
    high: Array

    def clip(self, theta: Array) -> Array:
        """Return the nearest parameters within the bounds."""
        return np.clip(theta, self.low, self.high)


@dataclass(frozen=True, slots=True, eq=False)
class Solutions:
    """The best fits to many sets of data.

    Parameters (sets, p), residuals (sets, n), which are prediction minus target, and derivatives of the predictions
    (sets, n, p).
    """

    theta: Array
    residuals: Array
    jacobian: Array
    converged: NDArray[np.bool_]

    @property
    def cost(self) -> Array:
        """Sum of the squares of the residuals, (sets,)."""
        return _squares(self.residuals)

    def __getitem__(self, index: int) -> Solutions:
        """Return one of the fits, still with the axis of sets."""
        single = slice(index, index + 1)
        return Solutions(self.theta[single], self.residuals[single], self.jacobian[single], self.converged[single])


def jacobian(model: Model, theta: Array, predicted: Array, bounds: Bounds) -> Array:
    """Return the derivatives of the predictions (sets, n, p), by difference quotients within the bounds."""
    sets, count = theta.shape
    step = STEP * np.maximum(np.abs(theta), 1.0)
    step = np.where(theta + step > bounds.high, -step, step)
    moved = theta[:, None, :] + step[:, None, :] * np.eye(count)
    taken = np.einsum("mpp->mp", moved) - theta  # the step that remains after rounding of the sum
    changed = model(moved.reshape(-1, count)).reshape(sets, count, -1)
    quotient: Array = ((changed - predicted[:, None, :]) / taken[:, :, None]).swapaxes(1, 2)
    return quotient


def fit_many(model: Model, targets: Array, start: Array, bounds: Bounds) -> Solutions:
    """Fit many sets of data (sets, n) at once by the Levenberg-Marquardt method, projected to the bounds.

    Notes
    -----
    Nocedal and Wright, Numerical Optimization, 2nd edition 2006; the damping follows Nielsen's rule (H. B. Nielsen,
    Damping parameter in Marquardt's method, IMM-REP-1999-05).
    """
    theta = bounds.clip(start)
    predicted = model(theta)
    residuals, slopes = predicted - targets, jacobian(model, theta, predicted, bounds)
    damping, growth, scale = np.full(len(theta), 1e-3), np.full(len(theta), 2.0), np.zeros(theta.shape)
    active = np.arange(len(theta))
    for _ in range(100):  # smooth problems take about ten
        if not active.size:
            break
        normal = slopes[active].swapaxes(1, 2) @ slopes[active]
        gradient = np.einsum("mnp,mn->mp", slopes[active], residuals[active])
        scale[active] = np.maximum(scale[active], np.einsum("mpp->mp", normal))
        step = _step(theta[active], normal, gradient, damping[active], scale[active], bounds)
        moved = bounds.clip(theta[active] + step)
        step = moved - theta[active]
        predicted = model(moved)
        tried = predicted - targets[active]
        linear = residuals[active] + np.einsum("mnp,mp->mn", slopes[active], step)
        before = _squares(residuals[active])
        with np.errstate(invalid="ignore"):  # a step that overflows is no improvement
            gain, hoped = before - _squares(tried), before - _squares(linear)
            better = gain > 0.0
        ratio = np.divide(gain, hoped, out=np.zeros_like(gain), where=better & (hoped > 0.0))
        softer = np.maximum(1.0 / 3.0, 1.0 - (2.0 * ratio - 1.0) ** 3)
        damping[active] = np.clip(damping[active] * np.where(better, softer, growth[active]), SOFTEST, STIFFEST)
        growth[active] = np.where(better, 2.0, 2.0 * growth[active])
        still = np.abs(step).max(axis=-1) <= TOLERANCE
        little = better & (gain <= np.finfo(np.float64).eps * before)  # it is rounding
        stiff = ~better & (damping[active] >= STIFFEST)
        accepted = active[better]
        if accepted.size:
            theta[accepted], residuals[accepted] = moved[better], tried[better]
            slopes[accepted] = jacobian(model, moved[better], predicted[better], bounds)
        active = active[~(still | little | stiff)]
    converged = np.ones(len(theta), dtype=bool)
    converged[active] = False
    return Solutions(theta, residuals, slopes, converged)


def _step(theta: Array, normal: Array, gradient: Array, damping: Array, scale: Array, bounds: Bounds) -> Array:
    """Return the damped steps; parameters pressed against a bound do not move."""
    pressed = ((theta <= bounds.low) & (gradient > 0.0)) | ((theta >= bounds.high) & (gradient < 0.0))
    scale = np.maximum(scale, STEP * scale.max(axis=-1, keepdims=True))
    scale = np.where(scale > 0.0, scale, 1.0)
    damped = np.where(pressed[:, :, None] | pressed[:, None, :], 0.0, normal)
    diagonal = np.where(pressed, 1.0, np.einsum("mpp->mp", damped) + damping[:, None] * scale)
    index = np.arange(theta.shape[1])
    damped[:, index, index] = diagonal
    solved: Array = np.linalg.solve(damped, np.where(pressed, 0.0, gradient)[..., None])
    return -solved[..., 0]


def search(
    model: Model, target: Array, start: Array, bounds: Bounds, near: Bounds, starts: int, seed: int
) -> Solutions:
    """Return the best of fits to one set of data (n,) from `start` (p,) and from other points in the range `near`.

    The other points, a Latin hypercube, are evaluated in one batch, and the best few fitted in another.
    """
    chosen = bounds.clip(start)[None]
    if starts:
        shares = scipy.stats.qmc.LatinHypercube(start.size, rng=np.random.default_rng(seed)).random(starts)
        points = bounds.clip(near.low + shares * (near.high - near.low))
        with np.errstate(over="ignore"):
            cost = _squares(model(points) - target)
        chosen = np.concatenate([chosen, points[np.argsort(cost, kind="stable")[:8]]])
    fits = fit_many(model, np.broadcast_to(target, (len(chosen), target.size)), chosen, bounds)
    return fits[int(np.argmin(fits.cost))]


def _squares(values: Array) -> Array:
    squares: Array = np.einsum("mn,mn->m", values, values)
    return squares
