"""Lack of fit: whether residuals are larger than the scatter of the measurements explains."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy
from numpy.typing import NDArray

from wearlaw.arrays import Array
from wearlaw.units.quantities import real_array
from wearlaw.units.variables import name_of

SAME = 1e-3
"""Relative difference in load, creepage, friction and other conditions up to which tests repeat each other."""


@dataclass(frozen=True)
class LackOfFit:
    """A test of the residuals of one kind of measurement.

    Attributes
    ----------
    observable : str
        "traction_coefficient", or the name of an outcome.
    method : str
        "repeats" for the F test, "uncertainty" for the χ² test.
    value : float
        F or χ²/ν.
    degrees : tuple of float
        Degrees of freedom: two of F, one of χ².
    p_value : float
        The probability of such a value or a larger one if the model is right.
    poor : bool
        Whether the p-value is below 1 - confidence.
    """

    observable: str
    method: str
    value: float
    degrees: tuple[float, ...]
    p_value: float
    poor: bool

    def __str__(self) -> str:
        name = "F" if self.method == "repeats" else "χ²/ν"
        degrees = " and ".join(f"{number:.3g}" for number in self.degrees)
        return f"{name} = {self.value:.3g} with {degrees} degrees of freedom, p = {self.p_value:.2g}"

    @property
    def warning(self) -> str:
        """What to tell the user about a poor fit."""
        scatter = "repeated tests" if self.method == "repeats" else "the stated uncertainty"
        return (
            f"lack of fit: the residuals of the {name_of(self.observable)} are larger than {scatter} can explain"
            f" ({self}); intervals hold only if law and contact model fit, so try others"
        )


def lack_of_fit(
    observable: str,
    residuals: Array,
    points: NDArray[np.intp],
    parameters: float,
    confidence: float,
    known_scatter: bool = False,
) -> LackOfFit | None:
    """Test residuals (n,) for lack of fit; None if nothing tells the scatter of the measurements.

    With n residuals rᵢ at m operating points, numbered by `points` as in `repeats`, p parameters and the mean residual
    r̄ⱼ of each point,

        F = [Σⱼ nⱼ r̄ⱼ²/(m - p)] / [Σᵢ (rᵢ - r̄ⱼ₍ᵢ₎)²/(n - m)].

    If the residuals are in units of their stated uncertainty, Σ rᵢ² is χ² with ν = n - p. `parameters` is the number p
    that these residuals determine, the sum of their leverages.

    Notes
    -----
    N. R. Draper and H. Smith, Applied Regression Analysis, 3rd ed., Wiley 1998, chapter 2, for a linear model; for a
    law the tests hold approximately, as far as it is linear over the scatter.
    """
    degrees: tuple[float, ...]
    if known_scatter:
        method, total, degrees = "uncertainty", float(np.sum(residuals**2)), (residuals.size - parameters,)
        value, p_value = total / degrees[0], float(scipy.special.chdtrc(*degrees, total))
    else:
        counts = np.bincount(points)
        means = np.bincount(points, residuals) / counts
        lack, error = float(np.sum(counts * means**2)), float(np.sum((residuals - means[points]) ** 2))
        degrees = (counts.size - parameters, float(residuals.size - counts.size))
        # Leverages add up to whole numbers but for rounding. Copies of a test do not show its scatter.
        if degrees[0] < 0.01 or degrees[1] < 1.0 or math.sqrt(error / degrees[1]) <= SAME:
            return None
        method, value = "repeats", (lack / degrees[0]) / (error / degrees[1])
        p_value = float(scipy.special.fdtrc(*degrees, value))
    return LackOfFit(observable, method, value, degrees, p_value, p_value < 1.0 - confidence)


def repeats(conditions: Mapping[str, Any], count: int) -> NDArray[np.intp]:
    """Return the number of the operating point of each test, (n,); tests with the same number repeat each other.

    Two tests are at the same point if all their conditions, (n,) or single values, agree to `SAME`.
    """
    arrays = (real_array(getattr(value, "magnitude", value)) for value in conditions.values())
    values = np.stack([np.broadcast_to(value, (count,)) for value in arrays], axis=-1)
    near = SAME * np.abs(values)
    points: list[int] = []
    numbers = np.empty(count, dtype=np.intp)
    for test, value in enumerate(values):
        same = (i for i, point in enumerate(points) if (np.abs(value - values[point]) <= near[point]).all())
        numbers[test] = next(same, len(points))
        if numbers[test] == len(points):
            points.append(test)
    return numbers
