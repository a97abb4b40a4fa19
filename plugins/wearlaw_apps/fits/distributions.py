"""Distributions of uncertain conditions and parameters."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
import pint
import scipy

from wearlaw.arrays import Array
from wearlaw.errors import InputError, UnitError, shown
from wearlaw.units.quantities import Q, Quantity, QuantityLike, parse, real_array, text_of

Value = Quantity | float
"""A quantity, or a plain number if it has no unit."""


@dataclass(frozen=True, eq=False)
class Distribution:
    """A distribution of one value, made by `uniform`, `normal` or `lognormal`.

    Attributes
    ----------
    kind : str
    first, second : Quantity or float
        "uniform": lower and upper end. "normal": mean and standard deviation. "lognormal": median and geometric
        standard deviation.
    """

    kind: Literal["uniform", "normal", "lognormal"]
    first: Value
    second: Value

    def quantiles(self, probability: Array, first: float, second: float) -> Array:
        """Return the quantiles at the given probabilities, with the two numbers of the distribution in one unit."""
        if self.kind == "uniform":
            return first + (second - first) * probability
        deviates: Array = scipy.special.ndtri(probability)
        if self.kind == "normal":
            return first + second * deviates
        values: Array = first * np.exp(np.log(second) * deviates)
        return values

    def __post_init__(self) -> None:
        first, second = (
            number if isinstance(number, pint.Quantity) else Q(number, "") for number in (self.first, self.second)
        )
        if self.kind == "lognormal":
            if not first.magnitude > 0.0:
                raise InputError(f"{self}: the median must be positive")
        elif not first.is_compatible_with(second):
            raise InputError(f"{self}: the two numbers are not of one dimension")
        elif self.kind == "uniform" and not second.m_as(first.units) > first.magnitude:
            raise InputError(f"{self}: the upper end must lie above the lower one")
        elif self.kind == "normal" and not second.magnitude > 0.0:
            raise InputError(f"{self}: the standard deviation must be positive")

    def __str__(self) -> str:
        return f"{self.kind}({_shown(self.first)}, {_shown(self.second)})"


@dataclass(frozen=True)
class PublishedRange:
    """The published range of a law's parameters, as in `WearLaw.band`; see `published_range`."""

    def __str__(self) -> str:
        return "published_range()"


def uniform(low: QuantityLike | float, high: QuantityLike | float) -> Distribution:
    """Return the uniform distribution: all values from `low` to `high` are equally likely."""
    return Distribution("uniform", _value(low, "low"), _value(high, "high"))


def normal(mean: QuantityLike | float, standard_deviation: QuantityLike | float) -> Distribution:
    """Return the normal distribution."""
    return Distribution("normal", _value(mean, "mean"), _value(standard_deviation, "standard_deviation"))


def lognormal(median: QuantityLike | float, geometric_standard_deviation: float) -> Distribution:
    """Return the lognormal distribution, for a positive value that scatters by a factor.

    Parameters
    ----------
    median : Quantity, str or float
        Half of the values lie below it.
    geometric_standard_deviation : float
        A factor above 1. Two thirds of the values lie within it of the median.

    Raises
    ------
    InputError
        If the factor is not above 1, or a value is not a finite number.
    """
    name = "geometric_standard_deviation"
    factor = _value(geometric_standard_deviation, name)
    if isinstance(factor, pint.Quantity) or not factor > 1.0:
        raise InputError(f"{name}: must be a factor above 1, such as 1.2; got {shown(geometric_standard_deviation)}")
    return Distribution("lognormal", _value(median, "median"), factor)


def published_range() -> PublishedRange:
    """Return the range that the source of a law publishes for its parameters, all values in it equally likely.

    Parameters whose ranges the source gives together, such as the coefficients of KTH, move through them together.
    """
    return PublishedRange()


def _value(value: QuantityLike | float, name: str) -> Value:
    """Return one of the two numbers of a distribution, or raise an `InputError` that names the argument."""
    try:
        number = parse(value) if isinstance(value, str) else value
        magnitude = real_array(number.magnitude if isinstance(number, pint.Quantity) else number)
    except UnitError as error:
        raise UnitError(f"{name}: {error}") from None
    if magnitude.ndim:
        raise InputError(f"{name}: must be one value, got an array of shape {magnitude.shape}")
    return number if isinstance(number, pint.Quantity) else float(magnitude)


def _shown(value: Value) -> str:
    return text_of(value) if isinstance(value, pint.Quantity) else f"{value:g}"
