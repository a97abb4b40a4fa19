"""A fit as a figure: what was measured, what is fitted, and the band that the bootstrap replicates span."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Literal

import numpy as np

from wearlaw.arrays.array import Array
from wearlaw.contact.problem import Problem
from wearlaw.figures.curves import BLACK, Curve, FigureData, Panel, PlotAxis
from wearlaw.fitting.observations import Observations, predictions, wear_index_density
from wearlaw.pipeline.variables import UNITS, label
from wearlaw.units.quantities import in_unit

if TYPE_CHECKING:
    from wearlaw.fitting.result import Fit

BETWEEN = 8
"""Points of a curve from one test to the next."""

MOST_SAMPLES = 200
"""Replicates that make a band; more change it less than can be seen."""

SAME = 1e-3
"""Relative difference up to which loads, friction and the like of tests are drawn as one curve."""

VARIES = ("longitudinal_creepage", "traction_coefficient")
"""What differs from test to test along one curve."""


def figure_data(fit: Fit) -> FigureData:
    """Return a panel for each kind of measurement: wear rates against Tγ/A, tractions against creepage."""
    panels = tuple(_panel(fit, one) for one in fit.observations)
    band = f"band: {fit.confidence:.0%} of the bootstrap replicates" if fit.samples else "no bootstrap, no band"
    apart = (
        ""
        if all(_one_series(one.problem) for one in fit.observations)
        else "; the tests differ in load, friction or other conditions"
    )
    names = ", ".join(fit.parameters)
    return FigureData(
        "fit",
        f"Fit of {names}",
        panels,
        f"{names} fitted to {fit.tests.source or 'tests'}; {band}{apart}.",
        f"{fit.confidence:.0%} of the bootstrap replicates",
    )


def _panel(fit: Fit, one: Observations) -> Panel:
    x = "wear_index_density" if one.observable == "wear_rate" else "creepage"
    measured = Curve("measured", _along(fit, one.problem, x), _shown(one, one.measured), colour=BLACK, points=True)
    scale: Literal["log", "linear"] = (
        "log" if one.observable == "wear_rate" and (one.measured > 0.0).all() else "linear"
    )
    axes = PlotAxis(label(x), scale), PlotAxis(label(one.observable), scale)
    return Panel(*axes, (_fitted(fit, one, x), measured))


def _fitted(fit: Fit, one: Observations, x: str) -> Curve:
    """Return the fitted values: as a curve through the tests, or at each of them where their loads differ."""
    together = _one_series(one.problem)
    problem = _between(one) if together else one.problem
    along = _along(fit, problem, x)
    order = np.argsort(along, kind="stable")

    def at(values: dict[str, Array]) -> Array:
        return _shown(one, predictions(one.observable, fit.predict, problem, values))[:, order]

    best = at(fit.values_in_si())[0]
    low = high = None
    if fit.samples:
        values = fit.values_in_si(fit.samples)
        count = len(next(iter(values.values())))
        chosen = np.unique(np.linspace(0, count - 1, min(count, MOST_SAMPLES)).round().astype(int))
        tail = 0.5 - 0.5 * fit.confidence
        low, high = np.quantile(at({name: some[chosen] for name, some in values.items()}), [tail, 1.0 - tail], axis=0)
    return Curve("fitted", along[order], best, low=low, high=high, points=not together)


def _arrays(problem: Problem) -> dict[str, Array]:
    """Return the arrays of a problem, by name."""
    found = ((field.name, getattr(problem, field.name)) for field in dataclasses.fields(problem))
    return {name: value for name, value in found if isinstance(value, np.ndarray)}


def _one_series(problem: Problem) -> bool:
    """Return whether operating points differ in their longitudinal creepage alone, and in the traction measured."""
    others = (value for name, value in _arrays(problem).items() if name not in VARIES)
    return all(np.ptp(array) <= SAME * np.abs(array).mean() for array in others)


def _between(one: Observations) -> Problem:
    """Return operating points at the tests and between them, in the order of their creepage."""
    problem = one.problem.forward()
    order = np.argsort(problem.creepage, kind="stable")
    places = np.arange(order.size, dtype=np.float64)
    fine = np.linspace(0.0, places[-1], BETWEEN * (order.size - 1) + 1)
    return problem.replaced(
        **{name: np.interp(fine, places, values[order]) for name, values in _arrays(problem).items()}
    )


def _along(fit: Fit, problem: Problem, x: str) -> Array:
    si = problem.rigid_slip if x == "creepage" else wear_index_density(fit.predict, problem)
    return in_unit(si, UNITS[x])


def _shown(one: Observations, values: Array) -> Array:
    return in_unit(values, UNITS[one.observable])
