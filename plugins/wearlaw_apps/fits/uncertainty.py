"""The uncertainty of a prediction with uncertain conditions and parameters: quasi-random samples and Sobol indices."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
import scipy

from wearlaw.arrays import Array, steadily
from wearlaw.contact.conditions import broadcast
from wearlaw.errors import InputError, did_you_mean, shown
from wearlaw.models.law import WEAR, Law, named_outcomes
from wearlaw.pipeline.composition import check_traction, warn_of_unlike_materials
from wearlaw.pipeline.ranges import RangeWatch
from wearlaw.units.quantities import Q, Quantity, QuantityLike, from_si
from wearlaw.units.usual import OneWarning
from wearlaw.units.variables import UNITS, name_of
from wearlaw_apps.fits.distributions import Distribution, PublishedRange
from wearlaw_apps.fits.named_numbers import Place, check_loads_stay, of_part, outcomes_at, part_at
from wearlaw_apps.fits.result import Fit
from wearlaw_apps.fits.uncertain_inputs import (
    OTHERS,
    Sampled,
    Uncertain,
    check_samples,
    of_fit,
    uncertain_inputs,
)
from wearlaw_apps.output.conditions import Known
from wearlaw_apps.output.curves import Curve, FigureData, Panel, PlotAxis, Shade
from wearlaw_apps.output.labels import label
from wearlaw_apps.output.plot import Drawn
from wearlaw_apps.sweeps.evaluation import expect_pipeline

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from wearlaw.contact.conditions import FrictionLaw
    from wearlaw.pipeline.pipeline import Pipeline

CONFIDENCE = 0.95
"""Default share of the samples in an interval."""

STEPS = 512
"""Points of the cumulative distribution in a figure."""

MOST_SAMPLES = 2**22
"""Largest number of samples."""

SEQUENCES = 8
"""Number of randomised sequences; their spread gives the error of the Sobol indices."""

INSIDE = 2.0**-54
"""Least distance of a probability from 0 and 1, where quantiles of the normal distribution are infinite."""


def uncertainty(
    predict: Pipeline[...] | Fit,
    /,
    *,
    law: Mapping[str, Distribution | PublishedRange] | None = None,
    stage: Mapping[str, Distribution] | None = None,
    samples: int = 2**14,
    seed: int = 0,
    **conditions: QuantityLike | ArrayLike | Distribution | FrictionLaw | None,
) -> Uncertainty:
    """Return the uncertainty of wear and other outcomes that follows from uncertain conditions and parameters.

    Parameters
    ----------
    predict : Pipeline or Fit
        A rig, a contact model and laws. With a fit, its parameters are drawn from its bootstrap replicates, all of one
        replicate together, so that their correlation counts. A fitted friction coefficient is the condition of that
        name unless you give it.
    law : mapping of str to distribution, optional
        Distributions of parameters of the laws by name, such as {"q_s": wl.normal("55 ug/m/mm^2", "5 ug/m/mm^2")} or
        {"coefficient": wl.published_range()}. A number that several laws have is written "usfd.m_m".
    stage : mapping of str to distribution, optional
        Distributions of numbers of the stages by name, such as {"reduction": wl.uniform(0.6, 0.9)}. The contact of each
        sample is then solved by itself, with stages of its own, which takes longer.
    samples : int
        Number of samples, rounded up to a power of two.
    seed : int
        The same seed gives the same samples.
    **conditions
        The conditions of a prediction. Any number may be a distribution: `uniform`, `normal` or `lognormal`.

    Raises
    ------
    InputError
        If nothing is distributed, or a distribution is impossible for its condition or parameter.
    """
    if not isinstance(samples, int) or not 2 <= samples <= MOST_SAMPLES:
        raise InputError(f"samples: must be a whole number from 2 to {MOST_SAMPLES}, got {shown(samples)}")
    if not isinstance(seed, int) or seed < 0:
        raise InputError(f"seed: must be a whole number, zero or positive; got {shown(seed)}")
    inputs: list[Uncertain] = [of_fit(predict, conditions)] if isinstance(predict, Fit) else []
    pipeline = predict.predict if isinstance(predict, Fit) else predict
    expect_pipeline(pipeline)
    if not pipeline.laws:
        pipeline.wear_law  # noqa: B018  raises
    check_loads_stay(pipeline, "uncertainty", list(stage or {}))
    inputs = uncertain_inputs(pipeline, law or {}, stage or {}, conditions, inputs)
    fixed = {
        name: value for name, value in conditions.items() if value is not None and not isinstance(value, Distribution)
    }
    explicit = pipeline.with_law(*(model.explicit() for model in pipeline.laws))
    sampler = Sampler(explicit, fixed, tuple(inputs))
    count = 1 << (samples - 1).bit_length()
    sequence = scipy.stats.qmc.Sobol(len(inputs), rng=np.random.default_rng(seed))
    values = sampler.sampled(sequence.random_base2(count.bit_length() - 1).T, range(len(pipeline.laws)), warns=True)
    outcomes = zip(named_outcomes(pipeline.laws), pipeline.laws, values, strict=True)
    return Uncertainty(sampler, {name: from_si(drawn, law.outcome.unit) for name, law, drawn in outcomes}, count, seed)


@dataclass(frozen=True, eq=False)
class Sampler:
    """A pipeline whose laws predict at probabilities of the uncertain inputs, with the conditions that are given."""

    predict: Pipeline[...]
    certain: Mapping[str, Any]
    inputs: tuple[Uncertain, ...]

    @cached_property
    def levels(self) -> dict[str, Known]:
        """The numeric conditions that are not distributed."""
        numbers = {name: Known.of(value) for name, value in self.certain.items()}
        return {name: number for name, number in numbers.items() if number is not None}

    @cached_property
    def shape(self) -> tuple[int, ...]:
        """The shape of the conditions that are not distributed."""
        broadcast({name: level.values for name, level in self.levels.items()})  # an error names shapes that do not fit
        # An error here is one of the conditions, not of single samples.
        conditions, _ = self._at(np.full(len(self.inputs), 0.5))
        shape: tuple[int, ...] = self.predict.posed(
            {**self.certain, **conditions}, of_one_patch="uncertainty"
        ).batch_shape
        return shape

    def sampled(self, probability: Array, indices: Sequence[int], warns: bool = False) -> tuple[Array, ...]:
        """Return outcomes of laws in SI at probabilities (inputs, samples), samples along the last axis.

        With `warns`, warn of samples outside the range of the laws or of elastic contact.
        """
        shape = (*self.shape, probability.shape[-1])
        conditions, numbers = self._at(np.clip(probability, INSIDE, 1.0 - INSIDE))
        for place in numbers:
            check_samples(part_at(self.predict, place), of_part(numbers, place.kind, place.index))
        fixed = {
            name: number.values[..., None] if number.unit is None else Q(number.values[..., None], number.unit)
            for name, number in self.levels.items()
        }
        with steadily():
            try:
                with OneWarning() as unusual:
                    problem = self.predict.posed({**self.certain, **fixed, **conditions})
                    if not warns:
                        unusual.clear()
            except InputError as error:
                raise InputError(f"{error}{OTHERS}") from None
            flat = problem.broadcast_to(shape).flatten()
            check_traction(self.predict.contact_model, flat)
            watch = RangeWatch(*(self.predict.laws[index] for index in indices))
            at_points = {place: np.broadcast_to(values, shape).reshape(-1) for place, values in numbers.items()}
            outcomes = outcomes_at(self.predict, flat, at_points, indices, watch.see if warns else None)
        if warns:
            self.predict.warn_of_problem(flat)
            warn_of_unlike_materials(self.predict.contact_model, flat)
            watch.warn()
        return tuple(values.reshape(shape) for values in outcomes)

    def _at(self, probability: Array) -> tuple[dict[str, Any], dict[Place, Array]]:
        """Return the sampled conditions, and the sampled numbers of laws and stages."""
        sampled: Sampled = {}
        for uncertain, row in zip(self.inputs, probability, strict=True):
            sampled |= uncertain.at(row)
        numbers = {key: value for key, value in sampled.items() if isinstance(key, Place)}
        return {key: value for key, value in sampled.items() if isinstance(key, str)}, numbers


@dataclass(frozen=True, eq=False, repr=False)
class Uncertainty(Drawn):
    """The outcomes of laws with distributed conditions and parameters, made by `uncertainty`.

    Results have the shape of the conditions that are not distributed. ``u["rcf_damage"]`` has the samples of an outcome
    by its name in results. With several outcomes, ``u.of("rcf_damage")`` has the median and the other summaries of one.

    Attributes
    ----------
    sampler : Sampler
        The pipeline with its known conditions and uncertain inputs.
    values : dict of str to Quantity
        The samples of each outcome by its name in results, along the last axis.
    samples : int
        Number of samples, a power of two as Sobol sequences need.
    seed : int
        Seed of the samples.
    """

    sampler: Sampler
    values: Mapping[str, Quantity]
    samples: int
    seed: int

    @property
    def outcomes(self) -> tuple[str, ...]:
        """The names of the outcomes."""
        return tuple(self.values)

    def of(self, outcome: str) -> Uncertainty:
        """Return the uncertainty of one of the outcomes, such as "rcf_damage" or "wear_rate_rail", by the same samples.

        Raises
        ------
        InputError
            If no law predicts it.
        """
        return replace(self, values={outcome: self[outcome]})

    def __getitem__(self, outcome: str) -> Quantity:
        """Return the samples of an outcome by its name in results, along the last axis."""
        if outcome not in self.values:
            hint = f"{did_you_mean(outcome, self.values)} The outcomes are: {', '.join(self.values)}"
            raise InputError(f"no law predicts {shown(outcome)}{hint}")
        return self.values[outcome]

    @property
    def wear_rate(self) -> Quantity:
        """Samples of the wear rate [kg/m/m²], along the last axis."""
        return self[WEAR]

    @property
    def median(self) -> Quantity:
        """The median of the outcome."""
        return self._quantile(0.5)

    def interval(self, confidence: float = CONFIDENCE) -> tuple[Quantity, Quantity]:
        """Return the ends of the interval with equally many samples of the outcome below and above it.

        Parameters
        ----------
        confidence : float
            Share of the samples inside, between 0 and 1.

        Returns
        -------
        low, high : Quantity
            In the shape of the operating points.

        Raises
        ------
        InputError
            If the share is not between 0 and 1.
        """
        if not 0.0 < confidence < 1.0:
            raise InputError(f"confidence: must lie between 0 and 1, such as 0.95; got {shown(confidence)}")
        return self._quantile(0.5 - 0.5 * confidence), self._quantile(0.5 + 0.5 * confidence)

    def table(self) -> pd.DataFrame:
        """Return medians and 95 % intervals with the known conditions, a row for each operating point.

        The heads hold the units. The median of an outcome stands under its name, as in "wear_rate [ug/m/mm^2]", and the
        ends of its interval under "wear_rate_low" and "wear_rate_high".
        """
        columns = {}
        for name, condition in self.sampler.levels.items():
            head = f"{name} [{condition.unit}]" if condition.unit else name
            columns[head] = np.broadcast_to(condition.values, self.sampler.shape).reshape(-1)
        for single in map(self.of, self.outcomes):
            unit = f" [{single.unit}]" if single.unit else ""
            for ending, value in zip(("", "_low", "_high"), (single.median, *single.interval()), strict=True):
                columns[f"{single.outcomes[0]}{ending}{unit}"] = np.reshape(value.to(single.unit).magnitude, -1)
        return pd.DataFrame(columns)

    def sobol(self) -> pd.DataFrame:
        """Return the share of the variance of the outcome that each input explains.

        First order: alone. Total order: including interactions with other inputs. Each index is the mean over several
        randomised sequences, whose spread gives its standard error. This takes (inputs + 2) × `samples` predictions.

        Notes
        -----
        A. Saltelli et al., Comput. Phys. Commun. 181 (2010) 259-270, as implemented by scipy.

        Raises
        ------
        InputError
            If there are several outcomes, the known conditions are more than one operating point, or the outcome does
            not vary.
        """
        outcome, inputs = self._only, self.sampler.inputs
        if self.sampler.shape:
            raise InputError("sobol: needs one operating point; give each condition that is not distributed one value")
        if np.ptp(self[outcome].magnitude) == 0.0:
            raise InputError(
                f"sobol: the {name_of(outcome)} is the same in all samples, so there is no variance to explain"
            )
        rows = pd.Index([uncertain.name for uncertain in inputs], name="input")
        if len(inputs) == 1:  # scipy takes no fewer than two
            alone = {"first_order": 1.0, "first_order_error": 0.0, "total_order": 1.0, "total_order_error": 0.0}
            return pd.DataFrame(alone, index=rows)
        every: list[Any] = [scipy.stats.uniform()] * len(inputs)
        index = named_outcomes(self.sampler.predict.laws)[outcome]
        indices = [
            scipy.stats.sobol_indices(
                func=lambda x: self.sampler.sampled(x, (index,))[0][None, :],
                n=max(self.samples // SEQUENCES, 2),
                dists=every,
                rng=rng,
            )
            for rng in np.random.default_rng(self.seed).spawn(SEQUENCES)
        ]
        table: dict[str, Array] = {}
        for order in ("first_order", "total_order"):
            shares = np.array([np.ravel(getattr(estimate, order)) for estimate in indices])
            table |= {order: shares.mean(axis=0), f"{order}_error": shares.std(axis=0, ddof=1) / np.sqrt(SEQUENCES)}
        return pd.DataFrame(table, index=rows)

    def figure_data(self) -> FigureData:
        """Return the cumulative distribution of one operating point, or the 95 % band along the axis of several.

        Raises
        ------
        InputError
            If the operating points differ in more than one condition, or there are several outcomes.
        """
        inputs = ", ".join(f"{uncertain.name} {uncertain.shown}" for uncertain in self.sampler.inputs)
        outcome = PlotAxis(label(self._only, units={self._only: self.unit}))
        panel = (_cumulative if math.prod(self.sampler.shape) == 1 else _along_axis)(self, outcome)
        samples, band = f"{self.samples} samples of {inputs}", f"{CONFIDENCE:.0%} of the samples"
        return FigureData("uncertainty", self.title, (panel,), f"{samples}.", band, samples)

    def _quantile(self, probability: float) -> Quantity:
        samples = self[self._only]
        return Q(np.quantile(samples.magnitude, probability, axis=-1), str(samples.units))

    @property
    def _only(self) -> str:
        """The name of the outcome; an error if there are several."""
        if len(self.outcomes) != 1:
            raise InputError(
                f'the pipeline predicts {" and ".join(self.outcomes)}; choose one, as in u.of("{self.outcomes[0]}")'
            )
        return self.outcomes[0]

    @property
    def _law(self) -> Law:
        laws = self.sampler.predict.laws
        return laws[named_outcomes(laws)[self._only]]

    @property
    def unit(self) -> str:
        """Unit of the outcome."""
        return self._law.outcome.unit

    @property
    def title(self) -> str:
        """Title of the prediction."""
        name, law = name_of(self._only), self._law
        return f"{name[0].upper()}{name[1:]} by {law.label or law.name} on {self.sampler.predict.contact_model.name}"

    def __repr__(self) -> str:
        first, *others = self.outcomes
        what = f"{len(self.outcomes)} outcomes" if others else f"the {name_of(first)}"
        lines = [f"Uncertainty of {what}, {self.samples} samples"]
        for single in map(self.of, self.outcomes):
            median, (low, high) = single.median, single.interval()
            spread = f"{median!r}, {100 * CONFIDENCE:g} % of the samples {low!r} to {high!r}"
            several = bool(self.sampler.shape)
            lines.append(
                f"{single.outcomes[0]:20} {f'medians {median.min()!r} to {median.max()!r}' if several else spread}"
            )
        return "\n  ".join([*lines, *(f"{uncertain.name:20} {uncertain.shown}" for uncertain in self.sampler.inputs)])


def _cumulative(uncertainty: Uncertainty, outcome: PlotAxis) -> Panel:
    name = uncertainty.outcomes[0]
    values = np.ravel(uncertainty[name].magnitude)
    share = (np.arange(STEPS) + 0.5) / STEPS
    low, median, high = np.quantile(values, [0.5 - 0.5 * CONFIDENCE, 0.5, 0.5 + 0.5 * CONFIDENCE])
    curves = (
        Curve(name_of(name), np.quantile(values, share), share),
        Curve("median", np.repeat(median, 2), np.array([0.0, 0.5]), colour=1, dash=1),
    )
    inside = Shade(f"{CONFIDENCE:.0%} of the samples", ((float(low), float(high)),))
    return Panel(outcome, PlotAxis("share of the samples below [-]", ends=(0.0, 1.0)), curves, shades=(inside,))


def _along_axis(uncertainty: Uncertainty, outcome: PlotAxis) -> Panel:
    axes = {name: condition for name, condition in uncertainty.sampler.levels.items() if np.size(condition.values) > 1}
    if len(axes) != 1:
        raise InputError(f"plot: needs one condition with several values, or none; there are {', '.join(axes)}")
    ((name, condition),) = axes.items()
    x, shown = np.ravel(condition.values), f"{name.replace('_', ' ')} [{condition.unit or '-'}]"
    if name in UNITS:
        x, shown = Q(x, condition.unit or "").to(UNITS[name]).magnitude, label(name)
    order = np.argsort(x)
    low, median, high = (
        np.ravel(values.magnitude)[order]
        for values in (uncertainty.interval()[0], uncertainty.median, uncertainty.interval()[1])
    )
    return Panel(PlotAxis(shown), outcome, (Curve("median", x[order], median, low=low, high=high),))
