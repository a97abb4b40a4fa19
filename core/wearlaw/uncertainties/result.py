"""The uncertainty of a prediction with uncertain conditions and parameters: quasi-random samples and Sobol indices."""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
import scipy

from wearlaw.arrays.array import Array
from wearlaw.contact.conditions import broadcast
from wearlaw.contact.problem import Problem
from wearlaw.errors import InputError
from wearlaw.figures.curves import Curve, FigureData, Panel, PlotAxis
from wearlaw.figures.plot import plot
from wearlaw.models.law import Numbers
from wearlaw.numerics.blocks import Columns
from wearlaw.numerics.integrate import integrate_laws
from wearlaw.pipeline.composition import check_traction, warn_of_unlike_materials
from wearlaw.pipeline.ranges import RangeWatch
from wearlaw.uncertainties.distributions import Distribution, PublishedRange
from wearlaw.uncertainties.inputs import OTHERS, Known, Uncertain, check_samples, parameter, split
from wearlaw.units.quantities import WEAR_RATE, Q, Quantity, QuantityLike, from_si, shortened
from wearlaw.units.variables import UNITS, label

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
    predict: Pipeline[...],
    /,
    *,
    law: Mapping[str, Distribution | PublishedRange] | None = None,
    samples: int = 2**14,
    seed: int = 0,
    **conditions: QuantityLike | ArrayLike | Distribution | FrictionLaw | None,
) -> Uncertainty:
    """Return the uncertainty of the wear rate that follows from uncertain conditions and parameters.

    Parameters
    ----------
    predict : Pipeline
        A rig, a contact model and a wear law.
    law : mapping of str to distribution, optional
        Distributions of parameters of the law by name, such as {"q_s": wl.normal("55 ug/m/mm^2", "5 ug/m/mm^2")} or
        {"coefficient": wl.published_range()}.
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
    return Uncertainty(predict, conditions, law or {}, samples, seed)


class Uncertainty:
    """The wear rate with distributed conditions and parameters, made by `uncertainty`.

    Results have the shape of the conditions that are not distributed.

    Attributes
    ----------
    samples : int
        Number of samples, a power of two as Sobol sequences need.
    inputs : tuple of Uncertain
        The distributed conditions and parameters.
    """

    def __init__(
        self,
        predict: Pipeline[...],
        conditions: Mapping[str, Any],
        law: Mapping[str, Distribution | PublishedRange],
        samples: int,
        seed: int,
    ) -> None:
        if isinstance(samples, bool) or not isinstance(samples, int) or not 2 <= samples <= MOST_SAMPLES:
            raise InputError(f"samples: must be a whole number from 2 to {MOST_SAMPLES}, got {samples!r}")
        if isinstance(seed, bool) or not isinstance(seed, int) or seed < 0:
            raise InputError(f"seed: must be a whole number, zero or positive; got {shortened(seed)}")
        self._predict = predict
        self._law = predict.wear_law.explicit()
        self._given, uncertain = split(conditions, predict.rig)
        uncertain += [parameter(name, given, predict.wear_law) for name, given in law.items()]
        if not uncertain:
            raise InputError(
                'nothing is uncertain; give a condition as a distribution, such as creepage=wl.uniform("0.5 %", "1 %"),'
                " or a parameter by law={...}"
            )
        self.inputs: tuple[Uncertain, ...] = tuple(uncertain)
        self.samples = 1 << (samples - 1).bit_length()
        self._seed = seed

    @cached_property
    def wear_rate(self) -> Quantity:
        """Samples of the wear rate [kg/m/m²], along the last axis."""
        sequence = scipy.stats.qmc.Sobol(len(self.inputs), rng=np.random.default_rng(self._seed))
        probability = sequence.random_base2(self.samples.bit_length() - 1).T
        return from_si(self._rates(probability, stacklevel=4), WEAR_RATE)

    @property
    def median(self) -> Quantity:
        """The median of the wear rate [kg/m/m²]."""
        return self._quantile(0.5)

    def interval(self, confidence: float = CONFIDENCE) -> tuple[Quantity, Quantity]:
        """Return the ends of the interval with equally many samples below and above it [kg/m/m²].

        Parameters
        ----------
        confidence : float
            Share of the samples inside, between 0 and 1.
        """
        if not 0.0 < confidence < 1.0:
            raise InputError(f"confidence: must lie between 0 and 1, such as 0.95; got {confidence!r}")
        return self._quantile(0.5 - 0.5 * confidence), self._quantile(0.5 + 0.5 * confidence)

    def sobol(self) -> pd.DataFrame:
        """Return the share of the variance of the wear rate that each input explains.

        First order: alone. Total order: including interactions with other inputs. Each index is the mean over several
        randomised sequences, whose spread gives its standard error. This takes (inputs + 2) × `samples` predictions.

        Notes
        -----
        A. Saltelli et al., Comput. Phys. Commun. 181 (2010) 259-270, as implemented by scipy.

        Raises
        ------
        InputError
            If the known conditions are more than one operating point, or the rate does not vary.
        """
        if self.shape:
            raise InputError("sobol: needs one operating point; give each condition that is not distributed one value")
        if np.ptp(self.wear_rate.magnitude) == 0.0:
            raise InputError("sobol: the wear rate is the same in all samples, so there is no variance to explain")
        index = pd.Index([one.name for one in self.inputs], name="input")
        if len(self.inputs) == 1:  # scipy takes no fewer than two
            alone = {"first_order": 1.0, "first_order_error": 0.0, "total_order": 1.0, "total_order_error": 0.0}
            return pd.DataFrame(alone, index=index)
        every: list[Any] = [scipy.stats.uniform()] * len(self.inputs)
        size = max(self.samples // SEQUENCES, 2)
        found = [
            scipy.stats.sobol_indices(func=lambda x: self._rates(x)[None, :], n=size, dists=every, rng=rng)
            for rng in np.random.default_rng(self._seed).spawn(SEQUENCES)
        ]
        table: dict[str, Array] = {}
        for order in ("first_order", "total_order"):
            shares = np.array([np.ravel(getattr(one, order)) for one in found])
            table |= {order: shares.mean(axis=0), f"{order}_error": shares.std(axis=0, ddof=1) / np.sqrt(SEQUENCES)}
        return pd.DataFrame(table, index=index)

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
        rates = self.wear_rate
        return Q(np.quantile(rates.magnitude, probability, axis=-1), str(rates.units))

    @property
    def title(self) -> str:
        """Title of the prediction."""
        return f"Wear rate by {self._law.name} on {self._predict.contact_model.name}"

    @cached_property
    def known(self) -> dict[str, Known]:
        """The numeric conditions that are not distributed."""
        found = {name: Known.of(value) for name, value in self._given.items()}
        return {name: one for name, one in found.items() if one is not None}

    @cached_property
    def shape(self) -> tuple[int, ...]:
        """The shape of the conditions that are not distributed."""
        broadcast({name: one.values for name, one in self.known.items()})  # an error names shapes that do not fit
        firsts = {one.name: one.distribution.first for one in self.inputs if not one.of_law}
        # An error here is one of the conditions, not of single samples.
        shape: tuple[int, ...] = self._predict.posed({**self._given, **firsts}, of_one_patch="uncertainty").batch_shape
        return shape

    def _problem(self, sampled: Mapping[str, Any]) -> Problem:
        """Return the contact problems of all operating points and samples, samples along the last axis."""
        known = {name: one.at_samples() for name, one in self.known.items()}
        try:
            return self._predict.posed({**self._given, **known, **sampled})
        except InputError as error:
            raise InputError(f"{error}{OTHERS}") from None

    def _rates(self, probability: Array, stacklevel: int | None = None) -> Array:
        """Return the wear rates [kg/m/m²] at probabilities (inputs, samples), samples along the last axis.

        With a `stacklevel`, warn of samples outside the range of the law or of elastic contact.
        """
        shape = (*self.shape, probability.shape[-1])
        inside = np.clip(probability, INSIDE, 1.0 - INSIDE)
        conditions: dict[str, Any] = {}
        of_law: dict[str, Array] = {}
        for one, row in zip(self.inputs, inside, strict=True):
            if one.of_law:
                of_law.update(one.values(row))
            else:
                conditions[one.name] = one.given(row)
        check_samples(self._law, of_law)
        problem = self._problem(conditions)
        flat = problem.broadcast_to(shape).flatten()
        varied = {name: np.broadcast_to(values, shape).reshape(-1, 1) for name, values in of_law.items()}
        p: Numbers = {**self._law.numbers, **varied}
        predict, watch = self._predict, RangeWatch(self._law)
        check_traction(predict.contact_model, flat)

        def see(part: Problem, columns: Columns) -> None:
            watch.see_block(part, columns)

        watching = see if stacklevel is not None else None
        wear = integrate_laws(predict.staged_model, (self._law,), flat, watching, [p])
        if stacklevel is not None:
            predict.warn_of_problem(flat, stacklevel + 1)
            warn_of_unlike_materials(predict.contact_model, flat, stacklevel + 1)
            watch.warn(stacklevel)
        return wear.values[0].reshape(shape)

    def __repr__(self) -> str:
        lines = [f"Uncertainty of the wear rate, {self.samples} samples"]
        if not self.shape:
            low, high = self.interval()
            share = f"{100 * CONFIDENCE:g} % of the samples"
            lines += [f"{'median':20} {self.median!r}", f"{share:20} {low!r} to {high!r}"]
        lines += [f"{one.name:20} {one.shown}" for one in self.inputs]
        return "\n  ".join(lines)


def _figure_data(uncertainty: Uncertainty) -> FigureData:
    """Return the cumulative distribution of one operating point, or the band along the axis of several."""
    inputs = ", ".join(f"{one.name} {one.shown}" for one in uncertainty.inputs)
    panel = _cumulative(uncertainty) if math.prod(uncertainty.shape) == 1 else _along_axis(uncertainty)
    caption = f"{uncertainty.samples} samples of {inputs}."
    return FigureData("uncertainty", uncertainty.title, (panel,), caption, f"{CONFIDENCE:.0%} of the samples")


def _cumulative(uncertainty: Uncertainty) -> Panel:
    rates = _plain(uncertainty.wear_rate)
    share = (np.arange(STEPS) + 0.5) / STEPS
    low, high = (_plain(end) for end in uncertainty.interval(CONFIDENCE))
    median = _plain(uncertainty.median)
    tail = 0.5 - 0.5 * CONFIDENCE
    curves = (
        Curve("wear rate", np.quantile(rates, share), share),
        Curve(f"median and {CONFIDENCE:.0%} of the samples", np.concatenate([low, median, high]),
              np.array([tail, 0.5, 1.0 - tail]), colour=1, points=True),
    )  # fmt: skip
    y = PlotAxis("share of the samples below [-]", ends=(0.0, 1.0))
    return Panel(PlotAxis(label("wear_rate")), y, curves)


def _along_axis(uncertainty: Uncertainty) -> Panel:
    axes = {name: one for name, one in uncertainty.known.items() if np.size(one.values) > 1}
    if len(axes) != 1:
        raise InputError(f"plot: needs one condition with several values, or none; there are {', '.join(axes)}")
    ((name, one),) = axes.items()
    x, shown = np.ravel(one.values), f"{name.replace('_', ' ')} [{one.unit or '-'}]"
    if name in UNITS:
        x, shown = Q(x, one.unit or "").to(UNITS[name]).magnitude, label(name)
    order = np.argsort(x)
    low, high = (_plain(end)[order] for end in uncertainty.interval(CONFIDENCE))
    median = _plain(uncertainty.median)[order]
    curve = Curve("median", x[order], median, low=low, high=high)
    return Panel(PlotAxis(shown), PlotAxis(label("wear_rate")), (curve,))


def _plain(quantity: Quantity) -> Array:
    return np.ravel(quantity.to(UNITS["wear_rate"]).magnitude)
