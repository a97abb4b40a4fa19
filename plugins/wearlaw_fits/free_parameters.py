"""The free parameters of a fit: their names, places, scaling and bounds."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Self

import numpy as np
import pint
from numpy.typing import NDArray

from wearlaw.arrays.array import Array
from wearlaw.errors import FitError, InputError, UnitError, did_you_mean, shown
from wearlaw.pipeline.pipeline import Pipeline
from wearlaw.settings.parameters import allowed_range, number_in_si, number_like, numbers
from wearlaw.units.quantities import Quantity, QuantityLike, Unit, from_si
from wearlaw.units.registry import symbol
from wearlaw_fits.least_squares import Bounds
from wearlaw_fits.named_numbers import NamedNumbers, Place, part_at

FRICTION = "friction_coefficient"
"""The only parameter that is a condition, not a number of a law or stage."""

FACTOR = 100.0
"""Default bounds of a parameter: this factor up and down from its first value."""

ROUNDINGS = 16.0 * float(np.finfo(np.float64).eps)
"""Relative distance from the end of the range that a field allows, so that roundings do not lead beyond it."""


@dataclass(frozen=True, slots=True, eq=False)
class FreeParameters:
    """The free parameters of a fit.

    Positive parameters are fitted by θ = ln(x/x₀), others by θ = (x - x₀)/|x₀|, with their first values x₀.

    Attributes
    ----------
    names : tuple of str
    places : dict of str to Place
        Where each number stands in the pipeline, by name; without the friction coefficient.
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
    places: dict[str, Place]
    like: tuple[Quantity | float, ...]
    first: Array
    positive: NDArray[np.bool_]
    bounds: Bounds

    @classmethod
    def of(
        cls,
        predict: Pipeline[...],
        free: Sequence[str],
        friction: float | None,
        bounds: Mapping[str, tuple[QuantityLike | float, QuantityLike | float]],
    ) -> Self:
        """Return the free parameters among the numbers of laws and stages and the friction coefficient.

        Raises
        ------
        FitError
            If a name is unknown, ambiguous or given twice, or its bounds are invalid.
        """
        if not isinstance(bounds, Mapping):
            raise FitError(f"bounds: give {{name: (low, high)}}, got {shown(bounds)}")
        places = _places(predict, tuple(free))
        like: dict[str, Quantity | float] = {}
        ranges: dict[str, tuple[float, float, bool]] = {}
        for name, place in places.items():
            part = part_at(predict, place)
            like[name] = numbers(part)[place.field]
            least, most, positive = allowed_range(part, place.field)
            if place.kind == "stage" and name not in bounds:  # a share or a factor keeps its sign unless bounds differ
                positive = positive or number_in_si(like[name]) > 0.0
            ranges[name] = least, most, positive
        if friction is not None:
            like[FRICTION], ranges[FRICTION] = float(friction), (-np.inf, np.inf, True)
        for name in bounds:
            if name not in free:
                raise FitError(
                    f"bounds: {shown(name)} is not free{did_you_mean(name, free)} Free are: {', '.join(free)}"
                )
        first = np.array([number_in_si(like[name]) for name in free])
        ends = [_ends(name, like[name], ranges[name], bounds.get(name)) for name in free]
        flags = np.array([ranges[name][2] for name in free])
        chosen = cls(tuple(free), places, tuple(like[name] for name in free), first, flags, Bounds(first, first))
        low, high = (chosen.theta(np.array(end)) for end in zip(*ends, strict=True))
        return cls(chosen.names, places, chosen.like, first, flags, Bounds(low, high))

    @property
    def of_contact(self) -> list[str]:
        """The names of the parameters that change the contact: the friction coefficient and numbers of stages."""
        return [name for name in self.names if name not in self.places or self.places[name].kind == "stage"]

    @property
    def freed_laws(self) -> set[int]:
        """The indices of the laws of which a number is free."""
        return {place.index for place in self.places.values() if place.kind == "law"}

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


def _places(predict: Pipeline[...], free: tuple[str, ...]) -> dict[str, Place]:
    """Return the places of the free numbers of laws and stages by name."""
    named = NamedNumbers(predict)
    known = [*named.known, FRICTION]
    if not free:
        raise FitError(f"free: name at least one parameter of {', '.join(known)}")
    places: dict[str, Place] = {}
    taken: dict[Place | None, str] = {}
    for name in free:
        try:
            place = None if name == FRICTION else named.place(name)
        except InputError as error:
            raise FitError(f"free: {error}") from None
        if name != FRICTION:
            places[name] = _checked(predict, named, name, place)
        if place in taken:
            also = "" if taken[place] == name else f", as {shown(taken[place])} too"
            raise FitError(f"free: {shown(name)} is given twice{also}")
        taken[place] = name
    return places


def _checked(predict: Pipeline[...], named: NamedNumbers, name: str, place: Place | None) -> Place:
    """Return the place of a number, or raise an error for a name that is not one of a number."""
    if place is not None and place.field in numbers(part_at(predict, place)):
        return place
    known = [*named.known, FRICTION]
    has = "has" if len(named.parts) == 1 else "have"
    owners = f"{named.owners()} {has}" if named.known else "without a wear law or a stage the pipeline has"
    raise FitError(f"free: {owners} no number {shown(name)}{did_you_mean(name, known)} There are: {', '.join(known)}")


def free_names(free: Any) -> Sequence[str]:
    """Return the names of free parameters as a sequence; one name may be given as a text."""
    names = [free] if isinstance(free, str) else free
    if not (isinstance(names, Sequence) and all(isinstance(name, str) for name in names)):
        raise FitError(f'free: give names of parameters, such as ["q_s", "m_c"], got {shown(free)}')
    return names


def give_bounds(name: str) -> str:
    """Return the advice to give bounds of a parameter, as Python and the command line take them."""
    return f"give bounds, as in bounds={{'{name}': (low, high)}} or --bounds {name}=LOW:HIGH"


def _ends(
    name: str, like: Quantity | float, allowed: tuple[float, float, bool], given: tuple[Any, Any] | None
) -> tuple[float, float]:
    """Return the bounds of a parameter in SI."""
    first = number_in_si(like)
    least, most, positive = allowed
    inward = tuple(
        end + away * ROUNDINGS * abs(end) if np.isfinite(end) else end for end, away in ((least, 1.0), (most, -1.0))
    )
    if given is None:
        if first == 0.0:
            raise FitError(
                f"bounds: the first value of {shown(name)} is zero, which says nothing of its size; {give_bounds(name)}"
            )
        low, high = (
            (first / FACTOR, first * FACTOR) if positive else (first - FACTOR * abs(first), first + FACTOR * abs(first))
        )
        return max(low, inward[0]), min(high, inward[1])
    if not (isinstance(given, tuple | list) and len(given) == 2):
        raise FitError(f"bounds: {shown(name)} must have two values, low and high, got {shown(given)}")
    try:
        low, high = (_end_in_si(name, like, end) for end in given)
    except UnitError as error:
        raise FitError(f"bounds: {error}") from None
    if not (low < high and (low > 0.0 or not positive)):
        rule = "greater than zero and in ascending order" if positive else "in ascending order"
        raise FitError(f"bounds: {shown(name)} must have two values {rule}, got {shown(given)}")
    if low < least or high > most:
        ends = " to ".join(repr(number_like(like, end)) for end in (least, most))
        raise FitError(f"bounds: {shown(name)} takes values in the range {ends}, got {shown(given)}")
    return max(low, inward[0]), min(high, inward[1])


def _end_in_si(name: str, like: Quantity | float, end: Any) -> float:
    unit = symbol(like.units, "~C") if isinstance(like, pint.Quantity) else ""
    if not unit and isinstance(end, float | int) and not isinstance(end, bool):
        return float(end)
    return float(Unit(unit, positive=False).si(end, name))
