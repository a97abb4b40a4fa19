"""The free parameters of a fit: their names, places, scaling and bounds."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Self, get_args

import numpy as np
import pint
from numpy.typing import NDArray
from pydantic.fields import FieldInfo

from wearlaw.arrays import Array
from wearlaw.configuration import Configuration
from wearlaw.errors import FitError, InputError, UnitError, did_you_mean, shown
from wearlaw.parameters import number_in_si, number_like, numbers
from wearlaw.pipeline.pipeline import Pipeline
from wearlaw.units.quantities import Quantity, QuantityLike, Unit, from_si
from wearlaw.units.registry import symbol, unit_in_si
from wearlaw_apps.fits.least_squares import Bounds
from wearlaw_apps.fits.named_numbers import FRICTION, Place, known_names, part_at, place_of

FACTOR = 100.0
"""Default bounds of a parameter: this factor up and down from its first value."""

ROUNDINGS = 16.0 * float(np.finfo(np.float64).eps)
"""Relative distance from the end of the range that a field allows, so that roundings do not lead beyond it."""


@dataclass(frozen=True, slots=True, eq=False)
class FreeParameters:
    """The free parameters of a fit: their names, places and first values, and the least and the greatest values in SI.

    Positive parameters are fitted by θ = ln(x/x₀), others by θ = (x - x₀)/|x₀|, with their first values x₀.
    """

    names: tuple[str, ...]
    places: dict[str, Place]
    like: tuple[Quantity | float, ...]
    first: Array
    positive: NDArray[np.bool_]
    ends: tuple[Array, Array]

    @classmethod
    def of(
        cls,
        predict: Pipeline[...],
        free: Sequence[str],
        friction: float | None,
        bounds: Mapping[str, tuple[QuantityLike | float, QuantityLike | float]],
    ) -> Self:
        """Return the free parameters among the numbers of laws and stages and the friction coefficient."""
        places = _places(predict, tuple(free))
        like: dict[str, Quantity | float] = {}
        ranges: dict[str, tuple[float, float, bool]] = {}
        for name, place in places.items():
            if place.kind == "condition":
                assert friction is not None
                like[name], ranges[name] = float(friction), (-np.inf, np.inf, True)
                continue
            part = part_at(predict, place)
            like[name] = numbers(part)[place.field]
            least, most, positive = allowed_range(part, place.field)
            if place.kind == "stage" and name not in bounds:  # a share or a factor keeps its sign unless bounds differ
                positive = positive or number_in_si(like[name]) > 0.0
            ranges[name] = least, most, positive
        for name in bounds:
            if name not in free:
                raise FitError(
                    f"bounds: {shown(name)} is not free{did_you_mean(name, free)} Free are: {', '.join(free)}"
                )
        return cls(
            names=tuple(free),
            places=places,
            like=tuple(like[name] for name in free),
            first=np.array([number_in_si(like[name]) for name in free]),
            positive=np.array([ranges[name][2] for name in free]),
            ends=tuple(np.array([_ends(name, like[name], ranges[name], bounds.get(name)) for name in free]).T),
        )

    @property
    def bounds(self) -> Bounds:
        """The bounds of θ."""
        return Bounds(*map(self.theta, self.ends))

    @property
    def of_contact(self) -> list[str]:
        """The names of the parameters that change the contact: the friction coefficient and numbers of stages."""
        return [name for name, place in self.places.items() if place.kind != "law"]

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
        return np.where(
            self.positive, self.first * np.exp(np.where(self.positive, theta, 0.0)), self.first + self._size * theta
        )

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


def _places(predict: Pipeline[...], free: tuple[str, ...]) -> dict[str, Place]:
    """Return the places of the free numbers of laws and stages by name."""
    places: dict[str, Place] = {}
    for name in free:
        if name == FRICTION:
            places[name] = Place("condition", 0, name)
            continue
        try:
            place = place_of(predict, name, others=[FRICTION])
        except InputError as error:
            raise FitError(f"free: {error}") from None
        fields = numbers(part_at(predict, place))
        if place.field not in fields:
            inner = [field for field in fields if field.startswith(f"{place.field}.")]
            raise FitError(f"free: {shown(name)} is several numbers; name some of {', '.join(inner)}")
        places[name] = place
    if not free or len(set(places.values())) < len(free):
        names = ", ".join([*known_names(predict), FRICTION])
        raise FitError(f"free: name each parameter once, at least one of {names}; got {shown(free)}")
    return places


def give_bounds(name: str) -> str:
    """Return the advice to give bounds of a parameter, as Python and the command line take them."""
    return f"give bounds, as in bounds={{'{name}': (low, high)}} or --bounds {name}=LOW:HIGH"


def _ends(
    name: str, like: Quantity | float, allowed: tuple[float, float, bool], pair: tuple[Any, Any] | None
) -> tuple[float, float]:
    """Return the bounds of a parameter in SI."""
    first = number_in_si(like)
    least, most, positive = allowed
    if pair is None:
        if first == 0.0:
            raise FitError(
                f"bounds: the first value of {shown(name)} is zero, which says nothing of its size; {give_bounds(name)}"
            )
        reach = FACTOR * abs(first)
        low, high = (first / FACTOR, first * FACTOR) if positive else (first - reach, first + reach)
    else:
        unit = symbol(like.units, "~C") if isinstance(like, pint.Quantity) else ""
        try:
            low, high = (
                float(end)
                if not unit and isinstance(end, float | int)
                else float(Unit(unit, positive=False).si(end, name))
                for end in pair
            )
        except (UnitError, TypeError, ValueError) as error:
            raise FitError(
                f"bounds: {shown(name)} must have two values, low and high, got {shown(pair)}: {error}"
            ) from None
        if not least <= low < high <= most or (positive and low <= 0.0):
            ends = " to ".join(repr(number_like(like, end)) for end in (least, most))
            raise FitError(
                f"bounds: {shown(name)} must have two values in ascending order in the range {ends}"
                f"{', greater than zero' if positive else ''}; got {shown(pair)}"
            )
    if np.isfinite(least):
        low = max(low, least + ROUNDINGS * abs(least))
    if np.isfinite(most):
        high = min(high, most - ROUNDINGS * abs(most))
    return low, high


def allowed_range(record: Configuration, name: str) -> tuple[float, float, bool]:
    """Return the least and the greatest value in SI that one of `numbers` may have, and whether it must be positive.

    These are the bounds in the annotation of the field, infinite where it has none.
    """
    outer, _, inner = name.partition(".")
    if inner:
        return allowed_range(getattr(record, outer), inner)
    low, high, positive = -np.inf, np.inf, False
    field = type(record).model_fields[outer]
    for rule in (*field.metadata, *_rules_within(field.annotation)):
        if isinstance(rule, Unit):
            limit = rule.limit * unit_in_si(rule.unit) if rule.limit < np.inf else np.inf
            low, high, positive = max(low, -limit), min(high, limit), positive or rule.positive
            continue
        above = getattr(rule, "gt", None)
        positive = positive or (above is not None and above >= 0.0)
        low = max([low, *(float(end) for end in (above, getattr(rule, "ge", None)) if end is not None)])
        high = min([high, *(float(getattr(rule, end)) for end in ("lt", "le") if getattr(rule, end, None) is not None)])
    return (max(low, 0.0) if positive else low), high, positive


def _rules_within(annotation: Any) -> Iterator[Any]:
    """Yield the rules of the types in a union, such as those of `Annotated[float, Field(ge=1)] | None`."""
    for member in get_args(annotation):
        for rule in getattr(member, "__metadata__", ()):
            yield from rule.metadata if isinstance(rule, FieldInfo) else (rule,)
