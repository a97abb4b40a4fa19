"""How uncertain a prediction is where conditions and parameters are: quasi-random samples and Sobol indices."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from wearlaw.arrays.array import Array
from wearlaw.contact.conditions import broadcast
from wearlaw.contact.problem import Problem
from wearlaw.errors import InputError
from wearlaw.models.wear_law import Numbers
from wearlaw.numerics.blocks import Columns
from wearlaw.numerics.integrate import integrate_wear
from wearlaw.pipeline.composition import check_traction, warn_of_geometry
from wearlaw.pipeline.ranges import RangeWatch
from wearlaw.uncertainties.distributions import Distribution, PublishedRange
from wearlaw.uncertainties.figure import CONFIDENCE, figure_data
from wearlaw.uncertainties.inputs import OTHERS, Known, Uncertain, check_samples, parameter, split
from wearlaw.units.quantities import WEAR_RATE, Q, Quantity, QuantityLike, from_si, shortened

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure
    from numpy.typing import ArrayLike

    from wearlaw.contact.conditions import FrictionLaw
    from wearlaw.contact.problem import Problem
    from wearlaw.figures.curves import FigureData
    from wearlaw.pipeline.pipeline import Pipeline

MOST_SAMPLES = 2**22
"""The most samples that are taken on."""

SEQUENCES = 8
"""Randomised sequences whose spread gives the error of the Sobol indices."""

INSIDE = 2.0**-54
"""The least distance of a probability from 0 and 1, where a normal distribution is infinite."""


def uncertainty(
    predict: Pipeline[...],
    /,
    *,
    law: Mapping[str, Distribution | PublishedRange] | None = None,
    samples: int = 2**14,
    seed: int = 0,
    **conditions: QuantityLike | ArrayLike | Distribution | FrictionLaw | None,
) -> Uncertainty:
    """Return how uncertain the wear rate is where conditions and parameters are.

    Parameters
    ----------
    predict : Pipeline
        A rig, a contact model and a wear law.
    law : mapping of str to distribution, optional
        Parameters of the wear law by name, such as {"q_s": wl.normal("55 ug/m/mm^2", "5 ug/m/mm^2")} or
        {"coefficient": wl.published_range()}.
    samples : int
        How many samples to take, rounded up to a power of two.
    seed : int
        The same seed gives the same samples.
    **conditions
        Those of a prediction, of which any that is a number may be a distribution: `uniform`, `normal` or `lognormal`.

    Raises
    ------
    InputError
        If nothing is distributed, or a distribution is not possible there.
    """
    return Uncertainty(predict, conditions, law or {}, samples, seed)


class Uncertainty:
    """The wear rate where some conditions and parameters are distributed; made by `uncertainty`.

    What it returns has the shape of the conditions that are not distributed.

    Attributes
    ----------
    samples : int
        How many there are: a power of two, as Sobol sequences need it.
    inputs : tuple of Uncertain
        What is distributed.
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
        """The samples of the wear rate [kg/m/m²]; they are the last axis."""
        from scipy.stats import qmc

        sequence = qmc.Sobol(len(self.inputs), rng=np.random.default_rng(self._seed))
        probability = sequence.random_base2(self.samples.bit_length() - 1).T
        return from_si(self._rates(probability, stacklevel=4), WEAR_RATE)

    @property
    def median(self) -> Quantity:
        """The wear rate that half of the samples exceed [kg/m/m²]."""
        return self._quantile(0.5)

    def interval(self, confidence: float = CONFIDENCE) -> tuple[Quantity, Quantity]:
        """Return the ends of the interval that leaves out as many samples below as above [kg/m/m²].

        Parameters
        ----------
        confidence : float
            The share of the samples inside, between 0 and 1.
        """
        if not 0.0 < confidence < 1.0:
            raise InputError(f"confidence: must lie between 0 and 1, such as 0.95; got {confidence!r}")
        return self._quantile(0.5 - 0.5 * confidence), self._quantile(0.5 + 0.5 * confidence)

    def sobol(self) -> pd.DataFrame:
        """Return which share of the variance of the wear rate each input explains.

        First order: by itself; total: also together with others. Each is the mean over several randomised sequences,
        which also give its standard error. It predicts (inputs + 2) × `samples` times.

        Notes
        -----
        A. Saltelli et al., Comput. Phys. Commun. 181 (2010) 259-270, as implemented by scipy.

        Raises
        ------
        InputError
            If the conditions that are not distributed hold more than one operating point, or the rate does not vary.
        """
        import pandas as pd
        from scipy.stats import sobol_indices, uniform

        if self.shape:
            raise InputError("sobol: needs one operating point; give each condition that is not distributed one value")
        if np.ptp(self.wear_rate.magnitude) == 0.0:
            raise InputError("sobol: the wear rate is the same in all samples, so that there is no variance to explain")
        index = pd.Index([one.name for one in self.inputs], name="input")
        if len(self.inputs) == 1:  # scipy takes no fewer than two
            alone = {"first_order": 1.0, "first_order_error": 0.0, "total_order": 1.0, "total_order_error": 0.0}
            return pd.DataFrame(alone, index=index)
        every: list[Any] = [uniform()] * len(self.inputs)
        size = max(self.samples // SEQUENCES, 2)
        found = [
            sobol_indices(func=lambda x: self._rates(x)[None, :], n=size, dists=every, rng=rng)
            for rng in np.random.default_rng(self._seed).spawn(SEQUENCES)
        ]
        table: dict[str, Array] = {}
        for order in ("first_order", "total_order"):
            shares = np.array([np.ravel(getattr(one, order)) for one in found])
            table |= {order: shares.mean(axis=0), f"{order}_error": shares.std(axis=0, ddof=1) / np.sqrt(SEQUENCES)}
        return pd.DataFrame(table, index=index)

    def figure_data(self) -> FigureData:
        """Return what `plot` draws."""
        return figure_data(self)

    def plot(self) -> Figure:
        """Return a figure: the cumulative distribution, or the band of 95 % along the one axis of the conditions."""
        from wearlaw.figures.drawing import draw

        return draw(self.figure_data())

    def _quantile(self, probability: float) -> Quantity:
        rates = self.wear_rate
        return Q(np.quantile(rates.magnitude, probability, axis=-1), str(rates.units))

    @property
    def title(self) -> str:
        """What is predicted, in words."""
        return f"Wear rate by {self._law.name} on {self._predict.contact_model.name}"

    @cached_property
    def known(self) -> dict[str, Known]:
        """The conditions that are not distributed and made of numbers."""
        found = {name: Known.of(value) for name, value in self._given.items()}
        return {name: one for name, one in found.items() if one is not None}

    @cached_property
    def shape(self) -> tuple[int, ...]:
        """The shape of the conditions that are not distributed."""
        broadcast({name: one.values for name, one in self.known.items()})  # names the shapes if they do not fit
        firsts = {one.name: one.distribution.first for one in self.inputs if not one.of_law}
        # What is wrong here is wrong with the conditions, and not with single samples.
        shape: tuple[int, ...] = self._predict.rig.checked_problem({**self._given, **firsts}).batch_shape
        return shape

    def _problem(self, sampled: Mapping[str, Any]) -> Problem:
        """Return the contact problem at all operating points and samples, the latter along the last axis."""
        known = {name: one.at_samples() for name, one in self.known.items()}
        try:
            return self._predict.rig.checked_problem({**self._given, **known, **sampled})
        except InputError as error:
            raise InputError(f"{error}{OTHERS}") from None

    def _rates(self, probability: Array, stacklevel: int | None = None) -> Array:
        """Return the wear rates [kg/m/m²] at probabilities (inputs, samples) of the inputs, of the shape of all.

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
        model, scale = predict.contact_model, predict.scale
        check_traction(model, flat)

        def see(part: Problem, columns: Columns) -> None:
            watch.see_block(predict.rig, part, columns)

        wear = integrate_wear(model, self._law, flat, scale, see if stacklevel is not None else None, p)
        if stacklevel is not None:
            warn_of_geometry(predict.rig, model, scale, self._law, flat, stacklevel + 1)
            watch.warn(stacklevel)
        return wear.wear_rate.reshape(shape)

    def __repr__(self) -> str:
        lines = [f"Uncertainty of the wear rate, {self.samples} samples"]
        if not self.shape:
            low, high = self.interval()
            share = f"{100 * CONFIDENCE:g} % of the samples"
            lines += [f"{'median':20} {self.median!r}", f"{share:20} {low!r} to {high!r}"]
        lines += [f"{one.name:20} {one.shown}" for one in self.inputs]
        return "\n  ".join(lines)
