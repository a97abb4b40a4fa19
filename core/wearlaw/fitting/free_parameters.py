"""The free parameters of a fit: their names, scaling and bounds."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Self

import numpy as np
import pint
from numpy.typing import NDArray

from wearlaw.arrays.array import Array
from wearlaw.errors import FitError, UnitError, did_you_mean
from wearlaw.fitting.least_squares import Bounds
from wearlaw.models.law import Law
from wearlaw.settings.configuration import Configuration
from wearlaw.settings.parameters import number_in_si, number_like, numbers
from wearlaw.units.quantities import Quantity, QuantityLike, Unit, from_si
from wearlaw.units.registry import symbol

FRICTION = "friction_coefficient"
"""The only parameter that is not a field of the law."""

FACTOR = 100.0
"""Default bounds of a parameter: this factor up and down from its first value."""


@dataclass(frozen=True, slots=True, eq=False)
class FreeParameters:
    """The free parameters of a fit.

    Positive parameters are fitted by θ = ln(x/x₀), others by θ = (x - x₀)/|x₀|, with their first values x₀.

    Attributes
    ----------
    names : tuple of str
    like : tuple of Quantity or float
        The first values, with the units of the parameters.
    first : ndarray, (p,)
        The first values in SI.
    positive : ndarray of bool, (p,)
        Whether each must be greater than zero.
    bounds : Bounds
        Of θ.
    """

    names: tuple[str, ...]
    like: tuple[Quantity | float, ...]
    first: Array
    positive: NDArray[np.bool_]
    bounds: Bounds

    @classmethod
    def of(
        cls,
        law: Law | None,
        free: Sequence[str],
        friction: float | None,
        bounds: Mapping[str, tuple[QuantityLike | float, QuantityLike | float]],
    ) -> Self:
        """Return the free parameters among those of a law and the friction coefficient.

        Raises
        ------
        FitError
            If a name is unknown or given twice, or its bounds are invalid.
        """
        like = dict(numbers(law)) if law is not None else {}
        _check_names(law, tuple(free), like)
        positive = {name: _is_positive(law, name) for name in like} if law is not None else {}
        if friction is not None:
            like[FRICTION], positive[FRICTION] = float(friction), True
        if not isinstance(bounds, Mapping):
            raise FitError(f"bounds: give {{name: (low, high)}}, got {bounds!r}")
        for name in bounds:
            if name not in free:
                raise FitError(f"bounds: '{name}' is not free{did_you_mean(name, free)} Free are: {', '.join(free)}")
        first = np.array([number_in_si(like[name]) for name in free])
        ends = [_ends(name, like[name], positive[name], bounds.get(name)) for name in free]
        flags = np.array([positive[name] for name in free])
        chosen = cls(tuple(free), tuple(like[name] for name in free), first, flags, Bounds(first, first))
        low, high = (chosen.theta(np.array(end)) for end in zip(*ends, strict=True))
        return cls(chosen.names, chosen.like, first, flags, Bounds(low, high))

    def theta(self, values: Array) -> Array:
        """Return the scaled parameters of values in SI, (..., p)."""
        with np.errstate(divide="ignore", invalid="ignore"):
            logarithms = np.log(np.where(self.positive, values / self.first, 1.0))
        return np.where(self.positive, logarithms, (values - self.first) / self._size)

    def values(self, theta: Array) -> Array:
        """Return the values in SI of scaled parameters, (..., p)."""
        return np.where(self.positive, self.first * np.exp(np.where(self.positive, theta, 0.0)), self._linear(theta))

    def slopes(self, theta: Array) -> Array:
        """Return the derivatives of the values in SI by the scaled parameters, (..., p)."""
        return np.where(self.positive, self.values(theta), self._size)

    def columns(self, theta: Array) -> dict[str, Array]:
        """Return the values in SI of scaled parameters (sets, p), by name."""
        return dict(zip(self.names, self.values(theta).T, strict=True))

    def quantity(self, name: str, si: Any) -> Quantity:
        """Return SI floats as a quantity in the unit of a parameter."""
        like = self.like[self.names.index(name)]
        quantity: Quantity = from_si(si, "") if isinstance(like, float) else number_like(like, si)
        return quantity

    @property
    def _size(self) -> Array:
        return np.where(self.first != 0.0, np.abs(self.first), 1.0)

    def _linear(self, theta: Array) -> Array:
        return self.first + self._size * theta


def _check_names(law: Law | None, free: tuple[str, ...], like: Mapping[str, object]) -> None:
    known = [*like, FRICTION]
    if not free:
        raise FitError(f"free: name at least one parameter of {', '.join(known)}")
    for name in free:
        if law is not None and name not in known and name in type(law).model_fields:
            kind = type(getattr(law, name)).__name__
            raise FitError(
                f"free: '{name}' of wear law '{law.name}' is a {kind} and not a number, so it"
                f" cannot be fitted; its numbers are: {', '.join(like)}"
            )
        if name not in known:
            if law is None:
                raise FitError(f"free: without a wear law there is only '{FRICTION}', not '{name}'; add a law with |")
            hint = did_you_mean(name, known)
            raise FitError(f"free: wear law '{law.name}' has no number '{name}'{hint} There are: {', '.join(known)}")
        if free.count(name) > 1:
            raise FitError(f"free: '{name}' is given twice")


def _is_positive(record: Configuration, name: str) -> bool:
    """Return whether a field, or a nested one with a dot, must be greater than zero."""
    outer, _, inner = name.partition(".")
    if inner:
        return _is_positive(getattr(record, outer), inner)
    rules = type(record).model_fields[outer].metadata
    return any(isinstance(rule, Unit) and rule.positive for rule in rules) or any(
        getattr(rule, "gt", None) is not None and rule.gt >= 0.0 for rule in rules
    )


def free_names(free: Any) -> Sequence[str]:
    """Return the names of free parameters as a sequence; one name may be given as a text."""
    names = [free] if isinstance(free, str) else free
    if not (isinstance(names, Sequence) and all(isinstance(name, str) for name in names)):
        raise FitError(f'free: give names of parameters, such as ["q_s", "m_c"], got {free!r}')
    return names


def _ends(name: str, like: Quantity | float, positive: bool, given: tuple[Any, Any] | None) -> tuple[float, float]:
    """Return the bounds of a parameter in SI."""
    first = number_in_si(like)
    if given is None:
        if first == 0.0:
            raise FitError(f"bounds: the first value of '{name}' is zero, which says nothing of its size; give bounds")
        return (
            (first / FACTOR, first * FACTOR) if positive else (first - FACTOR * abs(first), first + FACTOR * abs(first))
        )
    if not (isinstance(given, tuple | list) and len(given) == 2):
        raise FitError(f"bounds: '{name}' must have two values, low and high, got {given!r}")
    try:
        low, high = (_end_in_si(name, like, end) for end in given)
    except UnitError as error:
        raise FitError(f"bounds: {error}") from None
    if not (low < high and (low > 0.0 or not positive)):
        rule = "greater than zero and in ascending order" if positive else "in ascending order"
        raise FitError(f"bounds: '{name}' must have two values {rule}, got {given!r}")
    return low, high


def _end_in_si(name: str, like: Quantity | float, end: Any) -> float:
    unit = symbol(like.units, "~C") if isinstance(like, pint.Quantity) else ""
    if not unit and isinstance(end, float | int) and not isinstance(end, bool):
        return float(end)
    return float(Unit(unit, positive=False).si(end, name))
