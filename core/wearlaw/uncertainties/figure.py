"""The figure of an uncertain prediction: its cumulative distribution, or its band along an axis."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from wearlaw.arrays.array import Array
from wearlaw.errors import InputError
from wearlaw.figures.curves import Curve, FigureData, Panel, PlotAxis
from wearlaw.pipeline.variables import UNITS, label
from wearlaw.units.quantities import Q, Quantity

if TYPE_CHECKING:
    from wearlaw.uncertainties.result import Uncertainty

CONFIDENCE = 0.95
"""The share of the samples in an interval, where none is given."""

STEPS = 512
"""Points of the cumulative distribution."""


def figure_data(uncertainty: Uncertainty) -> FigureData:
    """Return the cumulative distribution of one operating point, or the band along the one axis of several.

    Raises
    ------
    InputError
        If several operating points differ in more than one condition.
    """
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
