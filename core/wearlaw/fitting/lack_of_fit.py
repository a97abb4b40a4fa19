"""Lack of fit: whether residuals are larger than the scatter of the measurements explains."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy
from numpy.typing import NDArray

from wearlaw.arrays.array import Array
from wearlaw.fitting.observations import Observations
from wearlaw.units.quantities import real_array
from wearlaw.units.variables import name_of

SAME = 1e-3
"""Relative difference in load, creepage, friction and other conditions up to which tests are equal."""

POOR_FACTOR = 2.0
"""Typical factor between prediction and measurement from which a fit without repeated tests counts as poor; a choice of
wearlaw, as are the lines of a factor of two in figures."""

POOR_SHARE = 1.0 - 1.0 / POOR_FACTOR
"""The same for absolute scatter: the rms residual over the rms measurement, as for predictions of half the wear."""


@dataclass(frozen=True)
class LackOfFit:
    """A check of the fit to one kind of measurement.

    Repeated tests measure the scatter, and an F test compares it with the distance of the predictions from the means of
    the repeats. If the tests state their uncertainty, a χ² test compares the residuals with that. Without either, a fit
    counts as poor from a typical factor of `POOR_FACTOR`.

    Attributes
    ----------
    observable : str
        "traction_coefficient", or the name of an outcome.
    method : str
        "repeats", "uncertainty", "factor", or "share" for absolute scatter without repeats.
    value : float
        F, χ²/ν, the typical factor exp √(Σ r²/n), or the rms residual over the rms measurement.
    degrees : tuple of float
        Degrees of freedom: of F (two), of χ² (one), or none.
    p_value : float or None
        The probability of such a value or a larger one if the model is right.
    rms : float
        Root mean square of the residuals.
    scatter : float or None
        Standard deviation of repeated tests, as a residual.
    poor : bool
        Whether the fit is poor: p below 1 - confidence, or the value beyond its limit.

    Notes
    -----
    N. R. Draper and H. Smith, Applied Regression Analysis, 3rd ed., Wiley 1998, chapter 2, for a linear model; for a
    law the tests hold approximately, as far as it is linear over the scatter.
    """

    observable: str
    method: str
    value: float
    degrees: tuple[float, ...]
    p_value: float | None
    rms: float
    scatter: float | None
    poor: bool

    def __str__(self) -> str:
        degrees = " and ".join(f"{one:.3g}" for one in self.degrees)
        if self.method == "repeats":
            return f"F = {self.value:.3g} with {degrees} degrees of freedom, p = {self.p_value:.2g}"
        if self.method == "uncertainty":
            return f"χ²/ν = {self.value:.3g} with ν = {degrees}, p = {self.p_value:.2g}"
        if self.method == "factor":
            return f"typical factor {self.value:.3g}, limit {POOR_FACTOR:g}"
        return f"rms residual {self.value:.0%} of the rms measurement, limit {POOR_SHARE:.0%}"

    @property
    def warning(self) -> str:
        """What to tell the user about a poor fit."""
        name = name_of(self.observable)
        if self.method == "factor":
            why = (
                f"the fitted {name} is typically wrong by a factor of {self.value:.3g}, more than {POOR_FACTOR:g};"
                " repeated tests would tell how much of it is scatter"
            )
        elif self.method == "share":
            why = (
                f"the rms residual of the {name} is {self.value:.0%} of the rms measurement, more than"
                f" {POOR_SHARE:.0%}; repeated tests would tell how much of it is scatter"
            )
        elif self.method == "uncertainty":
            why = f"the residuals of the {name} are {math.sqrt(self.value):.3g} times the stated uncertainty ({self})"
        else:
            why = f"the fitted {name} is further from repeated tests than these are from each other ({self})"
        return f"lack of fit: {why}; intervals hold only if law and contact model fit, so try others"


def check_fit(
    observations: Iterable[Observations],
    residuals: Array,
    leverage: Array,
    groups: NDArray[np.intp],
    confidence: float,
) -> tuple[LackOfFit, ...]:
    """Return a check for each kind of measurement.

    Parameters
    ----------
    observations : iterable of Observations
        The kinds.
    residuals : ndarray, (n,)
        Residuals without weights, all kinds in a row.
    leverage : ndarray, (n,)
        Leverage of each measurement; it adds up to the number of parameters that a kind determines.
    groups : ndarray of int, (n,)
        Kind of each measurement.
    confidence : float
        Confidence level; a test with p below 1 - confidence finds a lack of fit.
    """
    found = []
    for number, one in enumerate(observations):
        own = groups == number
        found.append(_check(one, residuals[own], float(leverage[own].sum()), confidence))
    return tuple(found)


def _check(one: Observations, residuals: Array, spent: float, confidence: float) -> LackOfFit:
    rms = math.sqrt(float(np.mean(residuals**2)))
    if one.scatter == "uncertainty":
        nu = residuals.size - spent
        chi2 = float(np.sum(residuals**2))
        p = float(scipy.special.chdtrc(nu, chi2))
        return LackOfFit(one.observable, "uncertainty", chi2 / nu, (nu,), p, rms, None, p < 1.0 - confidence)
    f, degrees, p_value, scatter = f_test(residuals, repeats(one.conditions, one.measured.size), spent)
    if p_value is not None:
        return LackOfFit(one.observable, "repeats", f, degrees, p_value, rms, scatter, p_value < 1.0 - confidence)
    if one.scatter == "relative":
        factor = math.exp(min(rms, 700.0))  # beyond, a float overflows
        return LackOfFit(one.observable, "factor", factor, (), None, rms, None, factor > POOR_FACTOR)
    return LackOfFit(one.observable, "share", rms, (), None, rms, None, rms > POOR_SHARE)


def repeats(conditions: Mapping[str, Any], count: int) -> NDArray[np.intp]:
    """Return the number of the operating point of each test, (n,); tests with the same number repeat each other.

    Two tests are at the same point if all their conditions agree to `SAME`.

    Parameters
    ----------
    conditions : mapping of str to Quantity or array_like, (n,) or a single value
        The conditions of the tests.
    count : int
        Number of tests n.
    """
    arrays = (real_array(getattr(value, "magnitude", value)) for value in conditions.values())
    values = np.stack([np.broadcast_to(value, (count,)) for value in arrays], axis=-1)
    near = SAME * np.abs(values)
    points: list[int] = []
    found = np.empty(count, dtype=np.intp)
    for test, value in enumerate(values):
        same = (i for i, point in enumerate(points) if (np.abs(value - values[point]) <= near[point]).all())
        found[test] = next(same, len(points))
        if found[test] == len(points):
            points.append(test)
    return found


def f_test(
    residuals: Array, points: NDArray[np.intp], spent: float
) -> tuple[float, tuple[float, ...], float | None, float | None]:
    """Return F of the lack of fit, its degrees of freedom, p, and the standard deviation of the repeats.

    With n tests at m points, p parameters, residuals rᵢ and their mean r̄ⱼ at each point,

        F = [Σⱼ nⱼ r̄ⱼ²/(m - p)] / [Σᵢ (rᵢ - r̄ⱼ₍ᵢ₎)²/(n - m)].

    Parameters
    ----------
    residuals : ndarray, (n,)
        Residuals.
    points : ndarray of int, (n,)
        Number of the point of each test.
    spent : float
        Number of parameters p.

    Returns
    -------
    tuple
        p and the standard deviation are None if nothing repeats, or the points are no more than the parameters, or
        repeats differ by no more than `SAME`, like copies of a test.
    """
    counts = np.bincount(points)
    means = np.bincount(points, residuals) / counts
    lack, error = float(np.sum(counts * means**2)), float(np.sum((residuals - means[points]) ** 2))
    degrees = (counts.size - spent, float(residuals.size - counts.size))
    # The leverages add up to whole numbers of parameters but for rounding, far below 0.01.
    if degrees[0] < 0.01 or degrees[1] < 1.0 or math.sqrt(error / degrees[1]) <= SAME:
        return math.nan, degrees, None, None
    f = (lack / degrees[0]) / (error / degrees[1])
    return f, degrees, float(scipy.special.fdtrc(*degrees, f)), math.sqrt(error / degrees[1])
