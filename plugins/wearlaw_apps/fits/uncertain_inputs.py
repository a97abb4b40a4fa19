"""The uncertain inputs of a prediction: distributions of conditions and of numbers of laws and stages, and fits."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import product
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
import pint

from wearlaw.arrays import Array
from wearlaw.errors import InputError, did_you_mean, shown
from wearlaw.models.contact_model import Stage
from wearlaw.models.law import Law
from wearlaw.parameters import changed, number_like, numbers, numbers_in_si
from wearlaw.pipeline.pipeline import Pipeline
from wearlaw.units.quantities import Unit, coefficient, from_si
from wearlaw.units.registry import symbol
from wearlaw_apps.fits.distributions import Distribution, PublishedRange, uniform
from wearlaw_apps.fits.named_numbers import FRICTION, Kind, Place, place_of

if TYPE_CHECKING:
    from wearlaw_apps.fits.result import Fit

OTHERS = "\nThe values are samples of its distribution; choose one without such values, such as lognormal or uniform"
"""The hint for impossible samples."""

Ends: TypeAlias = tuple[float, float]
"""The two numbers of a distribution in SI."""

Sampled: TypeAlias = dict[str | Place, Any]
"""Conditions by name, as the rig takes them, and numbers of laws and stages in SI by place."""


@dataclass(frozen=True)
class Uncertain:
    """A condition, numbers of a law or stage that move together, or the parameters of a fit.

    Its `at` returns the values at probabilities.
    """

    name: str
    shown: str
    at: Callable[[Array], Sampled]


def _drawn(distribution: Distribution, ends: Mapping[Any, Ends], unit: str | None, probability: Array) -> Sampled:
    """Return values of a distribution with two numbers in SI for each; the rig gets a condition in `unit`."""
    values = {key: distribution.quantiles(probability, *pair) for key, pair in ends.items()}
    return {key: number if unit is None else from_si(number, unit) for key, number in values.items()}


def _replicated(samples: Mapping[str, Array], places: Mapping[str, Place], probability: Array) -> Sampled:
    """Return the parameters of a fit from its replicates, all of the same for a probability."""
    drawn: Sampled = {}
    for name, place in places.items():
        count = samples[name].size
        which = np.minimum((probability * count).astype(np.intp), count - 1)
        drawn[name if place.kind == "condition" else place] = samples[name][which]
    return drawn


def of_fit(fit: Fit, conditions: Mapping[str, Any]) -> Uncertain:
    """Return the parameters of a fit as an input; a fitted friction coefficient only if it is not given otherwise."""
    if not fit.samples:
        raise InputError("the fit has no replicates to draw from; fit it with a bootstrap, as in bootstrap=1000")
    places = dict(fit.observations[0].places)
    if conditions.get(FRICTION) is not None:
        places.pop(FRICTION, None)
    samples = fit.values_in_si(fit.samples)
    count = len(next(iter(samples.values())))
    return Uncertain("fit", f"of {', '.join(samples)}, {count} replicates", partial(_replicated, samples, places))


def uncertain_inputs(
    predict: Pipeline[...],
    law: Mapping[str, Any],
    stage: Mapping[str, Any],
    conditions: Mapping[str, Any],
    fits: Sequence[Uncertain] = (),
) -> list[Uncertain]:
    """Return the inputs that distributed conditions and numbers of laws and stages are, with those of fits.

    Raises
    ------
    InputError
        If there are none, or a number is given twice.
    """
    distributed = {name: value for name, value in conditions.items() if isinstance(value, Distribution)}
    of_conditions = [of_condition(name, value) for name, value in distributed.items()]
    inputs = [*of_conditions, *of_numbers(predict, "law", law), *of_numbers(predict, "stage", stage), *fits]
    if not inputs:
        raise InputError(
            'nothing is uncertain; give a condition as a distribution, such as creepage=wl.uniform("0.5 %", "1 %"),'
            " or a parameter by law={...} or stage={...}"
        )
    places = [place for uncertain in inputs for place in uncertain.at(np.array(0.5)) if isinstance(place, Place)]
    twice = [place.field for place in places if places.count(place) > 1]
    if twice:
        raise InputError(f"{' and '.join(uncertain.name for uncertain in inputs)}: {twice[0]} is given twice")
    return inputs


def of_condition(name: str, distribution: Distribution) -> Uncertain:
    """Return a condition as an input, in the unit of the distribution's first number."""
    unit = symbol(distribution.first.units, "~C") if isinstance(distribution.first, pint.Quantity) else None
    ends = {name: ends_in_si(name, distribution, unit)}
    return Uncertain(name, str(distribution), partial(_drawn, distribution, ends, unit))


def of_numbers(predict: Pipeline[...], kind: Kind, distributions: Mapping[str, Any]) -> list[Uncertain]:
    """Return distributed numbers of the laws or stages of a pipeline as inputs, by their names as in `place_of`."""
    inputs = []
    for name, number in distributions.items():
        try:
            place = place_of(predict, name, kind)
        except InputError as error:
            raise InputError(f"{kind}: {error}") from None
        part = (predict.laws if kind == "law" else predict.stages)[place.index]
        ends, distribution = parameter(place.field, number, part)
        at_places = {replace(place, field=field): pair for field, pair in ends.items()}
        inputs.append(Uncertain(name, str(number), partial(_drawn, distribution, at_places, None)))
    return inputs


def parameter(name: str, spread: object, part: Law | Stage) -> tuple[dict[str, Ends], Distribution]:
    """Return the two numbers in SI for each field of a law or stage that an uncertain number moves, and how."""
    if isinstance(spread, PublishedRange):
        return _published(name, part), uniform(0.0, 1.0)
    if not isinstance(spread, Distribution):
        raise InputError(
            f"{name}: must be a distribution, such as wl.normal(5.3, 0.5) with its unit, or wl.published_range();"
            f" got {shown(spread)}"
        )
    choices = numbers(part.explicit() if isinstance(part, Law) else part)
    if name not in choices:
        hint = did_you_mean(name, choices)
        raise InputError(f"{part.kind} '{part.name}' has no number {shown(name)}{hint} There are: {', '.join(choices)}")
    number = choices[name]
    unit = symbol(number.units, "~C") if isinstance(number, pint.Quantity) else None
    return {name: ends_in_si(name, spread, unit)}, spread


def ends_in_si(name: str, distribution: Distribution, unit: str | None) -> Ends:
    """Return the two numbers of a distribution in SI; without a unit they are coefficients."""

    def in_si(value: Any) -> float:
        if unit is None:
            return float(value if isinstance(value, float) else coefficient(value, name))
        return float(Unit(unit, positive=False).si(value, name))

    second = float(distribution.second) if distribution.kind == "lognormal" else in_si(distribution.second)
    return in_si(distribution.first), second


def _published(name: str, part: Law | Stage) -> dict[str, Ends]:
    """Return the ends of the published ranges of a field's numbers, which move together."""
    band = part.band() if isinstance(part, Law) else None
    if band is None:
        raise InputError(f"{name}: the source of {part.kind} '{part.name}' publishes no ranges; give a distribution")
    low, _, high = (numbers_in_si(end.explicit()) for end in band)
    ranges = {field: (low[field], high[field]) for field in low if low[field] != high[field]}
    ends = {field: pair for field, pair in ranges.items() if field == name or field.startswith(f"{name}.")}
    if not ends:
        choices = sorted({field.partition(".")[0] for field in ranges})
        raise InputError(
            f"{name}: {part.kind} '{part.name}' has no published range of it; there are: {', '.join(choices) or 'none'}"
        )
    return ends


def check_samples(part: Law | Stage, samples: Mapping[str, Array]) -> None:
    """Raise an error if a law or stage does not accept some samples of its numbers, in SI by name.

    If it accepts all combinations of their extremes, it accepts the samples. If not, each sample is tried.
    """
    like = numbers(part)

    def accept(sample: tuple[Any, ...]) -> None:
        changed(part, {name: number_like(like[name], float(si)) for name, si in zip(samples, sample, strict=True)})

    try:
        for extremes in product(*((values.min(), values.max()) for values in samples.values())):
            accept(extremes)
    except InputError:
        try:
            for sample in zip(*samples.values(), strict=True):
                accept(sample)
        except InputError as error:
            raise InputError(f"{error}{OTHERS}") from None
