"""Measures of the error of predicted values against measured ones, with their formulas."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from wearlaw.arrays import Array


@dataclass(frozen=True)
class Agreement:
    """Errors of predicted values pᵢ, such as wear rates, against measured ones mᵢ, in n tests.

    The ratios rᵢ = pᵢ/mᵢ exist where both values are positive, in nᵣ of the tests. Measures of ratios leave the other
    tests out, and are None if too few are left.

    Attributes
    ----------
    tests : int
        n.
    without_ratio : int
        Tests in which one of the values is positive and the other is zero or negative. (If both are zero, they agree.)
    bias : float or None
        Geometric mean of the ratios, exp(Σ ln rᵢ / nᵣ); above 1 if the prediction is too high.
    geometric_sd : float or None
        Geometric standard deviation of the ratios, exp(√(Σ (ln rᵢ - ln bias)² / (nᵣ - 1))): the scatter
        that is left without the bias, as a factor. None for fewer than two ratios.
    rms_factor : float or None
        Root mean square of the logarithmic error, as a factor, exp(√(Σ ln² rᵢ / nᵣ)): the factor by
        which a prediction is typically wrong, bias and scatter together.
    largest_factor : float or None
        The factor of the worst test, max exp|ln rᵢ|.
    rms_error : float
        √(Σ (pᵢ - mᵢ)² / n) in SI, for wear rates [kg/m/m²], over all tests.
    """

    tests: int
    without_ratio: int
    bias: float | None
    geometric_sd: float | None
    rms_factor: float | None
    largest_factor: float | None
    rms_error: float

    @property
    def rank(self) -> tuple[float, float, float]:
        """Sort key of predictors, best first: tests without a ratio, rms factor, rms error.

        No wear where some was measured, or the reverse, is wrong by more than any factor. Six digits count, so that
        rounding does not separate equal predictors.
        """
        factor = np.inf if self.rms_factor is None else self.rms_factor
        return self.without_ratio, float(f"{factor:.6g}"), float(f"{self.rms_error:.6g}")


def agreement(predicted: Array, measured: Array) -> Agreement:
    """Return the errors of predicted values (tests,) in SI against measured ones; at least one."""
    both = (predicted > 0) & (measured > 0)
    logs = np.log(predicted[both]) - np.log(measured[both])
    return Agreement(
        tests=predicted.size,
        without_ratio=int(((predicted > 0) != (measured > 0)).sum()),
        bias=float(np.exp(logs.mean())) if logs.size else None,
        geometric_sd=float(np.exp(logs.std(ddof=1))) if logs.size > 1 else None,
        rms_factor=float(np.exp(np.sqrt(np.mean(logs**2)))) if logs.size else None,
        largest_factor=float(np.exp(np.abs(logs).max())) if logs.size else None,
        rms_error=float(np.sqrt(np.mean((predicted - measured) ** 2))),
    )
