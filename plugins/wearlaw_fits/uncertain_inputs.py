"""The uncertain inputs of a prediction: distributions of conditions and of numbers of laws and stages, and fits."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np
import pint

from wearlaw.arrays import Array
from wearlaw.errors import InputError, did_you_mean, shown
from wearlaw.models.contact_model import Stage
from wearlaw.models.law import Law
from wearlaw.parameters import changed, number_in_si, number_like, numbers
from wearlaw.pipeline.pipeline import Pipeline
from wearlaw.units.quantities import Unit, coefficient, from_si
from wearlaw.units.registry import symbol
from wearlaw_fits.distributions import Distribution, PublishedRange, uniform
from wearlaw_fits.named_numbers import Kind, NamedNumbers, Place

if TYPE_CHECKING:
    from wearlaw_fits.result import Fit

OTHERS = "\nThe values are samples of its distribution; choose one without such values, such as lognormal or uniform"
"""The hint for impossible samples."""


@dataclass(frozen=True)
class UncertainCondition:
    """A condition with a distribution, which gives an argument of the rig in `unit`; None for plain numbers."""

    name: str
    distribution: Distribution
    ends: tuple[float, float]
    unit: str | None

    @classmethod
    def of(cls, name: str, given: Distribution) -> UncertainCondition:
        """Return an uncertain condition, in the unit of the distribution's first number.

        Raises
        ------
        InputError
            If the distribution is impossible, such as with numbers of two dimensions.
        """
        unit = symbol(given.first.units, "~C") if isinstance(given.first, pint.Quantity) else None
        return cls(name, given, ends_in_si(name, given, unit), unit)

    @property
    def shown(self) -> str:
        """The distribution as given."""
        return str(self.distribution)

    def conditions(self, probability: Array) -> dict[str, Any]:
        """Return the arguments of the rig at probabilities."""
        values = self.distribution.quantiles(probability, *self.ends)
        return {self.name: values if self.unit is None else from_si(values, self.unit)}

    def numbers(self, probability: Array) -> dict[Place, Array]:  # noqa: ARG002
        """Return the numbers of laws and stages in SI at probabilities."""
        return {}


@dataclass(frozen=True)
class UncertainNumbers:
    """Numbers of a law or stage that a distribution moves together, between `ends` in SI."""

    name: str
    distribution: Distribution
    ends: Mapping[Place, tuple[float, float]]
    shown: str

    def conditions(self, probability: Array) -> dict[str, Any]:  # noqa: ARG002
        """Return the arguments of the rig at probabilities."""
        return {}

    def numbers(self, probability: Array) -> dict[Place, Array]:
        """Return the numbers of laws and stages in SI at probabilities."""
        return {place: self.distribution.quantiles(probability, *ends) for place, ends in self.ends.items()}


@dataclass(frozen=True)
class UncertainFit:
    """The parameters of a fit, which its bootstrap replicates move together, with their correlation."""

    fit: Fit
    takes_friction: bool

    name = "fit"

    @property
    def shown(self) -> str:
        """The parameters."""
        return f"of {', '.join(self.fit.samples)}, {len(next(iter(self.fit.samples.values())))} replicates"

    def conditions(self, probability: Array) -> dict[str, Any]:
        """Return the fitted friction coefficient at probabilities, unless it is given otherwise."""
        if not self.takes_friction:
            return {}
        samples = self.fit.values_in_si(self.fit.samples)["friction_coefficient"]
        return {"friction_coefficient": samples[self._replicates(probability)]}

    def numbers(self, probability: Array) -> dict[Place, Array]:
        """Return the numbers of laws and stages in SI at probabilities."""
        places, which = self.fit.observations[0].places, self._replicates(probability)
        samples = self.fit.values_in_si(self.fit.samples)
        return {place: samples[name][which] for name, place in places.items()}

    def _replicates(self, probability: Array) -> Any:
        count = len(next(iter(self.fit.samples.values())))
        return np.minimum((probability * count).astype(np.intp), count - 1)


Uncertain = UncertainCondition | UncertainNumbers | UncertainFit
"""An uncertain input, with its `name`; `shown` is its distribution in words."""


def of_fit(fit: Fit, conditions: Mapping[str, Any]) -> UncertainFit:
    """Return the parameters of a fit as an input.

    Raises
    ------
    InputError
        If the fit has no bootstrap replicates.
    """
    if not fit.samples:
        raise InputError("the fit has no replicates to draw from; fit it with a bootstrap, as in bootstrap=1000")
    return UncertainFit(fit, "friction_coefficient" in fit.samples and conditions.get("friction_coefficient") is None)


def check_samples(law: Law | Stage, samples: Mapping[str, Array]) -> None:
    """Raise an error if a law or stage does not accept some samples of its numbers, in SI by name.

    If it accepts all combinations of their extremes, it accepts the samples. If not, each sample is tried.
    """
    units = numbers(law)
    extremes = product(*((values.min(), values.max()) for values in samples.values()))
    try:
        for sample in extremes:
            _accepted(law, units, samples, sample)
    except InputError:
        try:
            for sample in zip(*samples.values(), strict=True):
                _accepted(law, units, samples, sample)
        except InputError as error:
            raise InputError(f"{error}{OTHERS}") from None


def _accepted(law: Law | Stage, units: Mapping[str, Any], names: Mapping[str, Any], sample: tuple[Any, ...]) -> None:
    changed(law, {name: number_like(units[name], float(si)) for name, si in zip(names, sample, strict=True)})


def numbers_of(predict: Pipeline[...], kind: Kind, given: Mapping[str, Any]) -> list[UncertainNumbers]:
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
    found: list[UncertainNumbers] = []
    for name, one in given.items():
        place = named.place(name)
        if place is None:
            known = ", ".join(named.known) or "none"
            raise InputError(
                f"{kind}: there is no number {shown(name)}{did_you_mean(name, named.known)} There are: {known}"
            )
        ends, distribution, text = parameter(place.field, one, parts[place.index])
        places = {Place(kind, place.index, field): pair for field, pair in ends.items()}
        found.append(UncertainNumbers(name, distribution, places, text))
    return found


def parameter(name: str, given: object, law: Law | Stage) -> tuple[dict[str, tuple[float, float]], Distribution, str]:
    """Return the two numbers in SI for each field that an uncertain number moves, its distribution and that in words.

    Raises
    ------
    InputError
        If there is no such number or no published range for it, or the distribution is impossible.
    UnitError
        If the distribution has the wrong unit.
    """
    if isinstance(given, PublishedRange):
        return _published(name, law), uniform(0.0, 1.0), "published_range()"
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
    unit = symbol(number.units, "~C") if isinstance(number, pint.Quantity) else None
    return {name: ends_in_si(name, given, unit)}, given, str(given)


def ends_in_si(name: str, given: Distribution, unit: str | None) -> tuple[float, float]:
    """Return the two numbers of a distribution in SI; without a unit they are coefficients.

    Raises
    ------
    InputError
        If the distribution is impossible or has the wrong unit.
    """

    def in_si(value: Any) -> float:
        if unit is None:
            return float(value if isinstance(value, float) else coefficient(value, name))
        return float(Unit(unit, positive=False).si(value, name))

    first = in_si(given.first)
    second = float(given.second) if given.kind == "lognormal" else in_si(given.second)
    if fault := given.fault():
        raise InputError(f"{name}: {fault}")
    return first, second


def _published(name: str, law: Law | Stage) -> dict[str, tuple[float, float]]:
    """Return the ends of the published ranges of a field's numbers, which move together."""
    band = law.band() if isinstance(law, Law) else None
    if band is None:
        raise InputError(f"{name}: the source of {law.kind} '{law.name}' publishes no ranges; give a distribution")
    low, _, high = ({field: number_in_si(value) for field, value in numbers(end.explicit()).items()} for end in band)
    ranges = {field: (low[field], high[field]) for field in low if low[field] != high[field]}
    ends = {field: pair for field, pair in ranges.items() if field == name or field.startswith(f"{name}.")}
    if not ends:
        known = sorted({field.partition(".")[0] for field in ranges})
        raise InputError(
            f"{name}: {law.kind} '{law.name}' has no published range of it; there are: {', '.join(known) or 'none'}"
        )
    return ends
