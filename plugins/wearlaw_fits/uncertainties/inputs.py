"""The uncertain inputs of a prediction: distributions of conditions and of numbers of laws and stages."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from itertools import product
from typing import Any

import numpy as np
import pint

from wearlaw.arrays.array import Array
from wearlaw.errors import InputError, did_you_mean, shown
from wearlaw.models.law import Law
from wearlaw.models.stage import Stage
from wearlaw.pipeline.pipeline import Pipeline, Rig
from wearlaw.settings.parameters import changed, number_in_si, number_like, numbers
from wearlaw.units.quantities import Unit, coefficient, from_si
from wearlaw.units.registry import symbol
from wearlaw_fits.named_numbers import Kind, NamedNumbers, Place
from wearlaw_fits.uncertainties.distributions import Distribution, PublishedRange, uniform


@dataclass(frozen=True)
class Uncertain:
    """An uncertain input with its distribution.

    Attributes
    ----------
    name : str
    distribution : Distribution
    ends : dict of str to tuple of float
        For each number that the input moves, the two numbers of its distribution in SI.
    part : tuple of ("law" or "stage", int), optional
        Kind and index of the law or stage that has the numbers; None for a condition.
    shown : str
        The distribution as given.
    unit : str or None
        The unit of a condition as given; None for plain numbers.
    """

    name: str
    distribution: Distribution
    ends: Mapping[str, tuple[float, float]]
    shown: str
    part: tuple[Kind, int] | None = None
    unit: str | None = None

    def values(self, probability: Array) -> dict[str, Array]:
        """Return the values in SI, by name, at probabilities."""
        return {name: self.distribution.quantiles(probability, *ends) for name, ends in self.ends.items()}

    def given(self, probability: Array) -> Any:
        """Return the values of a condition at probabilities, as an argument for a rig."""
        values = self.values(probability)[self.name]
        return values if self.unit is None else from_si(values, self.unit)


OTHERS = "\nThe values are samples of its distribution; choose one without such values, such as lognormal or uniform"
"""The hint for impossible samples."""


def check_samples(law: Law | Stage, samples: Mapping[str, Array]) -> None:
    """Raise an error if a law or stage does not accept some samples of its numbers, in SI by name.

    If it accepts all combinations of their extremes, it accepts the samples. If not, each sample is tried, the extreme
    ones first.
    """
    units = numbers(law)

    def check(sample: Iterable[float]) -> None:
        changed(law, {name: number_like(units[name], float(si)) for name, si in zip(samples, sample, strict=True)})

    try:
        for extremes in product(*((values.min(), values.max()) for values in samples.values())):
            check(extremes)
    except InputError:
        table = np.stack(list(samples.values()), axis=-1)
        first = np.concatenate([table.argmin(axis=0), table.argmax(axis=0)])
        try:
            for sample in (*table[first], *table):
                check(sample)
        except InputError as error:
            raise InputError(f"{error}{OTHERS}") from None


def condition(name: str, given: Distribution) -> Uncertain:
    """Return an uncertain condition, in the unit of the distribution's first number.

    Raises
    ------
    UnitError
        If the two numbers of the distribution have different dimensions.
    """
    if isinstance(given.first, pint.Quantity):
        unit = symbol(given.first.units, "~C")
        return replace(_uncertain(name, given, Unit(unit, positive=False)), unit=unit)
    second = given.second if isinstance(given.second, float) else coefficient(given.second, name)
    return _checked(name, given, float(given.first), float(second))


def numbers_of(predict: Pipeline[...], kind: Kind, given: Mapping[str, Any]) -> list[Uncertain]:
    """Return the uncertain numbers of the laws or stages of a pipeline.

    Parameters
    ----------
    predict : Pipeline
    kind : {"law", "stage"}
    given : mapping of str to distribution
        By the names of the numbers, as in `NamedNumbers`.

    Raises
    ------
    InputError
        If no law or stage has such a number, several have it, or its distribution is impossible.
    UnitError
        If a distribution has the wrong unit.
    """
    named = NamedNumbers(predict, kind)
    parts = predict.laws if kind == "law" else predict.stages
    found: dict[Place, Uncertain] = {}
    for name, one in given.items():
        place = named.place(name)
        if place is None:
            hint = did_you_mean(name, named.known)
            owners = f"{named.owners()} has" if len(parts) == 1 else f"the {kind}s have"
            raise InputError(
                f"{kind}: {owners} no number {shown(name)}{hint} There are: {', '.join(named.known) or 'none'}"
            )
        if place in found:
            raise InputError(f"{kind}: {shown(name)} is given twice, as {shown(found[place].name)} too")
        found[place] = replace(parameter(place.field, one, parts[place.index]), name=name, part=(kind, place.index))
    return list(found.values())


def parameter(name: str, given: object, law: Law | Stage) -> Uncertain:
    """Return an uncertain number of a law or stage.

    Raises
    ------
    InputError
        If it has no such number or no published range for it, or the distribution is impossible.
    UnitError
        If the distribution has the wrong unit.
    """
    if isinstance(given, PublishedRange):
        return _published(name, law)
    if not isinstance(given, Distribution):
        raise InputError(
            f"{name}: must be a distribution, such as wl.normal(5.3, 0.5) with its unit, or wl.published_range();"
            f" got {shown(given)}"
        )
    known = numbers(law.explicit() if isinstance(law, Law) else law)
    if name not in known:
        hint = did_you_mean(name, known)
        raise InputError(f"{law.kind} '{law.name}' has no number {shown(name)}{hint} There are: {', '.join(known)}")
    number = known[name]
    unit = Unit(symbol(number.units, "~C"), positive=False) if isinstance(number, pint.Quantity) else None
    return _uncertain(name, given, unit)


def _uncertain(name: str, given: Distribution, unit: Unit | None) -> Uncertain:
    """Return an uncertain input of one number; without a unit it is a coefficient."""
    if unit is None:
        first = float(coefficient(given.first, name))
        plain = isinstance(given.second, float)  # its fault is that of the distribution
        second = float(given.second if plain else coefficient(given.second, name))
    else:
        first = float(unit.si(given.first, name))
        is_factor = given.kind == "lognormal"
        second = float(given.second if is_factor else Unit(unit.unit, positive=False).si(given.second, name))
    return _checked(name, given, first, second)


def _published(name: str, law: Law | Stage) -> Uncertain:
    """Return the input that moves a field's numbers through their published ranges together."""
    band = law.band() if isinstance(law, Law) else None
    if band is None:
        raise InputError(f"{name}: the source of {law.kind} '{law.name}' publishes no ranges; give a distribution")
    low, _, high = ({field: number_in_si(value) for field, value in numbers(end.explicit()).items()} for end in band)
    ends = {
        field: (low[field], high[field])
        for field in low
        if low[field] != high[field] and (field == name or field.startswith(f"{name}."))
    }
    if not ends:
        ranges = sorted({field.partition(".")[0] for field in low if low[field] != high[field]})
        raise InputError(
            f"{name}: {law.kind} '{law.name}' has no published range of it; there are: {', '.join(ranges) or 'none'}"
        )
    return Uncertain(name, uniform(0.0, 1.0), ends, "published_range()")


def _checked(name: str, given: Distribution, first: float, second: float) -> Uncertain:
    """Return an uncertain input of one number, whose distribution must be possible."""
    if fault := given.fault():
        raise InputError(f"{name}: {fault}")
    return Uncertain(name, given, {name: (first, second)}, str(given))


def split(conditions: Mapping[str, Any], rig: Rig | None = None) -> tuple[dict[str, Any], list[Uncertain]]:
    """Separate known conditions from distributed ones; a condition of None counts as not given.

    Parameters
    ----------
    conditions : mapping of str to object
    rig : Rig, optional
        The rig that takes the conditions.

    Raises
    ------
    ConditionsError
        If the rig has no such condition, or lacks one.
    UnitError
        If the two numbers of a distribution have different dimensions.
    """
    if rig is not None:
        rig.check_names(conditions)
    given = {name: value for name, value in conditions.items() if value is not None}
    known = {name: value for name, value in given.items() if not isinstance(value, Distribution)}
    return known, [condition(name, value) for name, value in given.items() if isinstance(value, Distribution)]
