"""The uncertainty of a prediction with uncertain conditions and parameters: quasi-random samples and Sobol indices."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from copy import copy
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
import scipy

from wearlaw.arrays import Array, steadily
from wearlaw.contact.conditions import Known, broadcast
from wearlaw.contact.problem import Problem
from wearlaw.errors import InputError, did_you_mean, shown
from wearlaw.models.law import WEAR, Numbers, named_outcomes
from wearlaw.numerics.integrate import integrate_laws
from wearlaw.pipeline.composition import check_traction, warn_of_unlike_materials
from wearlaw.pipeline.pipeline import expect_pipeline
from wearlaw.pipeline.ranges import RangeWatch
from wearlaw.units.quantities import Q, Quantity, QuantityLike, from_si
from wearlaw.units.variables import UNITS, name_of
from wearlaw_fits.distributions import Distribution, PublishedRange
from wearlaw_fits.named_numbers import Kind, Place, check_loads_stay, part_at, staged_models
from wearlaw_fits.result import Fit
from wearlaw_fits.uncertain_inputs import OTHERS, Uncertain, UncertainCondition, check_samples, numbers_of, of_fit
from wearlaw_output.curves import Curve, FigureData, Panel, PlotAxis, Shade
from wearlaw_output.labels import label
from wearlaw_output.plot import plot

if TYPE_CHECKING:
    from matplotlib.figure import Figure
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
    of = [of_fit(predict, conditions)] if isinstance(predict, Fit) else []
    pipeline = predict.predict if isinstance(predict, Fit) else predict
    expect_pipeline(pipeline)
    pipeline.rig.check_names({**conditions, **(of[0].conditions(np.array(0.5)) if of else {})})
    given = {name: value for name, value in conditions.items() if value is not None}
    of_conditions = [UncertainCondition.of(name, one) for name, one in given.items() if isinstance(one, Distribution)]
    of_stages = numbers_of(pipeline, "stage", stage or {})
    check_loads_stay(pipeline, "uncertainty", [one.name for one in of_stages])
    inputs: list[Uncertain] = [*of_conditions, *numbers_of(pipeline, "law", law or {}), *of_stages, *of]
    if not inputs:
        raise InputError(
            'nothing is uncertain; give a condition as a distribution, such as creepage=wl.uniform("0.5 %", "1 %"),'
            " or a parameter by law={...} or stage={...}"
        )
    places = [place for one in inputs for place in one.numbers(np.array(0.5))]
    twice = [place.field for place in places if places.count(place) > 1]
    if twice:
        raise InputError(f"{' and '.join(one.name for one in inputs)}: {twice[0]} is given twice")
    known = {name: value for name, value in given.items() if not isinstance(value, Distribution)}
    return Uncertainty(pipeline, known, inputs, samples, seed)


class Uncertainty:
    """The outcomes of laws with distributed conditions and parameters, made by `uncertainty`.

    Results have the shape of the conditions that are not distributed. ``u["rcf_damage"]`` has the samples of an outcome
    by its name in results. With several outcomes, ``u.of("rcf_damage")`` has the median and the other summaries of one.

    Attributes
    ----------
    outcomes : tuple of str
        The names of the outcomes.
    samples : int
        Number of samples, a power of two as Sobol sequences need.
    inputs : tuple of Uncertain
        The distributed conditions and parameters.
    """

    def __init__(
        self,
        predict: Pipeline[...],
        conditions: Mapping[str, Any],
        inputs: Sequence[Uncertain],
        samples: int,
        seed: int,
    ) -> None:
        if not isinstance(samples, int) or not 2 <= samples <= MOST_SAMPLES:
            raise InputError(f"samples: must be a whole number from 2 to {MOST_SAMPLES}, got {shown(samples)}")
        if not isinstance(seed, int) or seed < 0:
            raise InputError(f"seed: must be a whole number, zero or positive; got {shown(seed)}")
        if not predict.laws:
            predict.wear_law  # noqa: B018  raises
        self._predict = predict
        self._laws = tuple(law.explicit() for law in predict.laws)
        self.outcomes: tuple[str, ...] = tuple(named_outcomes(predict.laws))
        self._given = conditions
        self.inputs: tuple[Uncertain, ...] = tuple(inputs)
        self.samples = 1 << (samples - 1).bit_length()
        self._seed = seed
        self._whole = self
        self._found: tuple[Array, ...] | None = None

    def of(self, outcome: str) -> Uncertainty:
        """Return the uncertainty of one of the outcomes, with the same samples.

        Parameters
        ----------
        outcome : str
            Its name in results, such as "rcf_damage" or "wear_rate_rail".

        Raises
        ------
        InputError
            If no law predicts it.
        """
        self._index(outcome)
        found = copy(self)
        found.outcomes = (outcome,)
        return found

    def __getitem__(self, outcome: str) -> Quantity:
        """Return the samples of an outcome by its name in results, along the last axis."""
        return self._samples_of(outcome)

    @property
    def wear_rate(self) -> Quantity:
        """Samples of the wear rate [kg/m/m²], along the last axis."""
        if WEAR not in self._whole.outcomes:
            self._predict.wear_law  # noqa: B018  raises
        return self._samples_of(WEAR)

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
        for name, known in self.known.items():
            head = f"{name} [{known.unit}]" if known.unit else name
            columns[head] = np.broadcast_to(known.values, self.shape).reshape(-1)
        for one in map(self.of, self.outcomes):
            unit = f" [{one.unit}]" if one.unit else ""
            for ending, value in zip(("", "_low", "_high"), (one.median, *one.interval()), strict=True):
                columns[f"{one.outcomes[0]}{ending}{unit}"] = np.reshape(value.to(one.unit).magnitude, -1)
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
        index = self._index(self._only)
        if self.shape:
            raise InputError("sobol: needs one operating point; give each condition that is not distributed one value")
        if np.ptp(self._samples_of(self._only).magnitude) == 0.0:
            name = self._only.replace("_", " ")
            raise InputError(f"sobol: the {name} is the same in all samples, so there is no variance to explain")
        rows = pd.Index([one.name for one in self.inputs], name="input")
        if len(self.inputs) == 1:  # scipy takes no fewer than two
            alone = {"first_order": 1.0, "first_order_error": 0.0, "total_order": 1.0, "total_order_error": 0.0}
            return pd.DataFrame(alone, index=rows)
        every: list[Any] = [scipy.stats.uniform()] * len(self.inputs)
        size = max(self.samples // SEQUENCES, 2)
        with steadily():
            found = [
                scipy.stats.sobol_indices(
                    func=lambda x: self._sampled(x, (index,))[0][None, :], n=size, dists=every, rng=rng
                )
                for rng in np.random.default_rng(self._seed).spawn(SEQUENCES)
            ]
        table: dict[str, Array] = {}
        for order in ("first_order", "total_order"):
            shares = np.array([np.ravel(getattr(one, order)) for one in found])
            table |= {order: shares.mean(axis=0), f"{order}_error": shares.std(axis=0, ddof=1) / np.sqrt(SEQUENCES)}
        return pd.DataFrame(table, index=rows)

    def figure_data(self) -> FigureData:
        """Return the data of `plot`.

        Raises
        ------
        InputError
            If the operating points differ in more than one condition.
        """
        return _figure_data(self)

    def plot(self) -> Figure:
        """Draw the cumulative distribution, or the 95 % band along the one axis of the conditions."""
        return plot(self.figure_data())

    def _quantile(self, probability: float) -> Quantity:
        samples = self._samples_of(self._only)
        return Q(np.quantile(samples.magnitude, probability, axis=-1), str(samples.units))

    def _samples_of(self, outcome: str) -> Quantity:
        index = self._index(outcome)
        return from_si(self._whole._values()[index], self._laws[index].outcome.unit)

    def _index(self, outcome: str) -> int:
        """Return the index of the law of an outcome."""
        known = named_outcomes(self._laws)
        if outcome not in known:
            hint = did_you_mean(outcome, known) if isinstance(outcome, str) else "."
            raise InputError(f"no law predicts {shown(outcome)}{hint} The outcomes are: {', '.join(known)}")
        return known[outcome]

    @property
    def _only(self) -> str:
        """The name of the outcome; an error if there are several."""
        if len(self.outcomes) != 1:
            raise InputError(
                f'the pipeline predicts {" and ".join(self.outcomes)}; choose one, as in u.of("{self.outcomes[0]}")'
            )
        return self.outcomes[0]

    @property
    def unit(self) -> str:
        """Unit of the outcome."""
        return self._laws[self._index(self._only)].outcome.unit

    @property
    def title(self) -> str:
        """Title of the prediction."""
        outcome = self._only
        name, law = name_of(outcome), self._laws[self._index(outcome)]
        return f"{name[0].upper()}{name[1:]} by {law.label or law.name} on {self._predict.contact_model.name}"

    @cached_property
    def known(self) -> dict[str, Known]:
        """The numeric conditions that are not distributed."""
        found = {name: Known.of(value) for name, value in self._given.items()}
        return {name: one for name, one in found.items() if one is not None}

    @cached_property
    def shape(self) -> tuple[int, ...]:
        """The shape of the conditions that are not distributed."""
        broadcast({name: one.values for name, one in self.known.items()})  # an error names shapes that do not fit
        # An error here is one of the conditions, not of single samples.
        medians = {name: value for one in self.inputs for name, value in one.conditions(np.array(0.5)).items()}
        shape: tuple[int, ...] = self._predict.posed({**self._given, **medians}, of_one_patch="uncertainty").batch_shape
        return shape

    def _problem(self, sampled: Mapping[str, Any]) -> Problem:
        """Return the contact problems of all operating points and samples, samples along the last axis."""
        known = {
            name: one.values[..., None] if one.unit is None else Q(one.values[..., None], one.unit)
            for name, one in self.known.items()
        }
        try:
            return self._predict.posed({**self._given, **known, **sampled})
        except InputError as error:
            raise InputError(f"{error}{OTHERS}") from None

    def _values(self) -> tuple[Array, ...]:
        """Return the samples of all outcomes in SI; warn the first time."""
        if self._found is None:
            with steadily():
                sequence = scipy.stats.qmc.Sobol(len(self.inputs), rng=np.random.default_rng(self._seed))
                probability = sequence.random_base2(self.samples.bit_length() - 1).T
                self._found = self._sampled(probability, range(len(self._laws)), warns=True)
        return self._found

    def _sampled(self, probability: Array, indices: Sequence[int], warns: bool = False) -> tuple[Array, ...]:
        """Return outcomes of laws in SI at probabilities (inputs, samples), samples along the last axis.

        Parameters
        ----------
        probability : ndarray, (inputs, samples)
        indices : sequence of int
            The laws.
        warns : bool, optional
            Whether to warn of samples outside the range of the laws or of elastic contact.
        """
        count = probability.shape[-1]
        shape = (*self.shape, count)
        inside = np.clip(probability, INSIDE, 1.0 - INSIDE)
        conditions: dict[str, Any] = {}
        numbers: dict[Place, Array] = {}
        for one, row in zip(self.inputs, inside, strict=True):
            conditions |= one.conditions(row)
            numbers |= one.numbers(row)
        predict, laws = self._predict, tuple(self._laws[index] for index in indices)
        for place in numbers:
            check_samples(part_at(predict, place), _of_part(numbers, place.kind, place.index))
        flat = self._problem(conditions).broadcast_to(shape).flatten()
        watch = RangeWatch(*laws)
        check_traction(predict.contact_model, flat)
        watching = watch.see if warns else None
        points = np.arange(math.prod(shape)).reshape(-1, count)
        found = np.empty((len(laws), flat.size))
        for model, members in staged_models(predict, numbers, count):
            chosen = points[:, members].reshape(-1) if members.size < count else slice(None)
            p: list[Numbers] = []
            for index, law in zip(indices, laws, strict=True):
                varied = {
                    name: np.broadcast_to(values, shape).reshape(-1, 1)[chosen]
                    for name, values in _of_part(numbers, "law", index).items()
                }
                p.append({**law.numbers, **varied})
            part = flat[chosen] if members.size < count else flat
            found[:, chosen] = integrate_laws(model, laws, part, watching, p).values
        if warns:
            predict.warn_of_problem(flat)
            warn_of_unlike_materials(predict.contact_model, flat)
            watch.warn()
        return tuple(values.reshape(shape) for values in found)

    def __repr__(self) -> str:
        first, *others = self.outcomes
        what = f"{len(self.outcomes)} outcomes" if others else f"the {name_of(first)}"
        lines = [f"Uncertainty of {what}, {self.samples} samples"]
        for one in map(self.of, self.outcomes):
            median, (low, high) = one.median, one.interval()
            spread = f"{median!r}, {100 * CONFIDENCE:g} % of the samples {low!r} to {high!r}"
            lines.append(
                f"{one.outcomes[0]:20} {f'medians {median.min()!r} to {median.max()!r}' if self.shape else spread}"
            )
        return "\n  ".join([*lines, *(f"{one.name:20} {one.shown}" for one in self.inputs)])


def _of_part(numbers: Mapping[Place, Array], kind: Kind, index: int) -> dict[str, Array]:
    """Return the numbers of one law or stage by their fields."""
    return {place.field: values for place, values in numbers.items() if (place.kind, place.index) == (kind, index)}


def _figure_data(uncertainty: Uncertainty) -> FigureData:
    """Return the cumulative distribution of one operating point, or the band along the axis of several."""
    inputs = ", ".join(f"{one.name} {one.shown}" for one in uncertainty.inputs)
    name, band = uncertainty.outcomes[0], f"{CONFIDENCE:.0%} of the samples"
    outcome = PlotAxis(label(name, units={name: uncertainty.unit}))
    panel = (_cumulative if math.prod(uncertainty.shape) == 1 else _along_axis)(uncertainty, outcome)
    samples = f"{uncertainty.samples} samples of {inputs}"
    return FigureData("uncertainty", uncertainty.title, (panel,), f"{samples}.", band, samples)


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
    axes = {name: one for name, one in uncertainty.known.items() if np.size(one.values) > 1}
    if len(axes) != 1:
        raise InputError(f"plot: needs one condition with several values, or none; there are {', '.join(axes)}")
    ((name, one),) = axes.items()
    x, shown = np.ravel(one.values), f"{name.replace('_', ' ')} [{one.unit or '-'}]"
    if name in UNITS:
        x, shown = Q(x, one.unit or "").to(UNITS[name]).magnitude, label(name)
    order = np.argsort(x)
    low, median, high = (
        np.ravel(values.magnitude)[order]
        for values in (uncertainty.interval()[0], uncertainty.median, uncertainty.interval()[1])
    )
    return Panel(PlotAxis(shown), outcome, (Curve("median", x[order], median, low=low, high=high),))
