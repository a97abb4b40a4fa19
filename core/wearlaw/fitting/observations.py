"""Measurements beside the predictions of a pipeline, for many parameter sets at once."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

from wearlaw.arrays.array import Array
from wearlaw.contact.problem import Problem
from wearlaw.errors import FitError
from wearlaw.fitting.free_parameters import FRICTION
from wearlaw.numerics.integrate import integrate_forces, integrate_laws, patch_area
from wearlaw.pipeline.pipeline import Pipeline
from wearlaw.units.quantities import in_unit
from wearlaw.units.variables import UNITS
from wearlaw.wear_tests.tests import WearTests

Scatter: TypeAlias = Literal["relative", "absolute", "uncertainty"]
"""Scatter of measurements: by a factor, by an amount, or by their stated uncertainties."""

Observable: TypeAlias = Literal["wear_rate", "traction_coefficient"]

FLOOR = 1e-300
"""Replaces a prediction of zero, whose logarithm is infinite."""


@dataclass(frozen=True, slots=True, eq=False)
class Observations:
    """One kind of measurement, with the pipeline that predicts it.

    Attributes
    ----------
    observable : str
        "wear_rate" [kg/m/m²] or "traction_coefficient" [-].
    pipeline : Pipeline
        The pipeline that predicts it.
    tests : WearTests
        The tests with this measurement, each with a label.
    measured : ndarray, (n,)
        The measurements in SI.
    problem : Problem
        The contact problems of the tests, with batch shape (n,).
    scatter : str
        Kind of scatter.
    unit : ndarray, (n,)
        Divisor of the residuals; 1 for relative scatter.
    """

    observable: Observable
    pipeline: Pipeline[...]
    tests: WearTests
    measured: Array
    problem: Problem
    scatter: Scatter
    unit: Array

    def predicted(self, values: Mapping[str, Array]) -> Array:
        """Return the predictions (sets, n) for parameters in SI, (sets,) each."""
        return predictions(self.observable, self.pipeline, self.problem, values)

    def residuals(self, values: Mapping[str, Array]) -> Array:
        """Return the residuals (sets, n) for parameters in SI, (sets,) each."""
        return self.compare(self.predicted(values))

    def compare(self, predicted: Array) -> Array:
        """Return the residuals of predictions (..., n)."""
        if self.scatter == "relative":
            return np.log(np.maximum(predicted, FLOOR) / self.measured)
        return (predicted - self.measured) / self.unit

    def in_shown_unit(self, predicted: Array) -> Array:
        """Return the residuals (n,) for tables, with absolute scatter in the unit of the measurement."""
        if self.scatter == "absolute":
            return in_unit(predicted - self.measured, UNITS[self.observable])
        return self.compare(predicted)


def predictions(
    observable: Observable, pipeline: Pipeline[...], problem: Problem, values: Mapping[str, Array]
) -> Array:
    """Return wear rates [kg/m/m²] or traction coefficients at n operating points for many parameter sets.

    Parameters
    ----------
    observable : str
        Which of the two.
    pipeline : Pipeline
    problem : Problem
        With batch shape (n,).
    values : mapping of str to ndarray, (sets,)
        Parameters in SI.

    Returns
    -------
    ndarray, (sets, n)
    """
    sets, points = len(next(iter(values.values()))), problem.size
    problem = problem[np.tile(np.arange(points), sets)]
    if FRICTION in values:
        problem = problem.replaced(friction_coefficient=np.repeat(values[FRICTION], points))
    of_law = {name: np.repeat(value, points)[:, None] for name, value in values.items() if name != FRICTION}
    model = pipeline.staged_model
    if observable == "traction_coefficient":
        predicted = integrate_forces(model, problem).tangential / problem.normal_force
    else:
        law = pipeline.wear_law
        predicted = integrate_laws(model, (law,), problem, numbers=[{**law.numbers, **of_law}]).values[0]
    return predicted.reshape(sets, points)


def wear_index_density(pipeline: Pipeline[...], problem: Problem) -> Array:
    """Return Tγ/A [N/m²] of the whole patch, of the batch shape."""
    model = pipeline.staged_model
    power = problem.power(integrate_forces(model, problem))
    density: Array = np.abs(power) / patch_area(model, problem)
    return density


def observe(
    pipeline: Pipeline[...],
    tests: WearTests,
    friction: float | None,
    fits_friction: bool,
    scatter: Scatter,
) -> list[Observations]:
    """Return the measurements to fit: wear rates if there is a law, and tractions if the friction is free.

    Raises
    ------
    FitError
        If the tests lack a measurement or condition.
    """
    found = []
    if pipeline.laws:
        found.append(_observe("wear_rate", pipeline, tests, friction, fits_friction, scatter))
    if fits_friction:
        of_traction: Scatter = "absolute" if scatter == "absolute" else "relative"
        found.append(_observe("traction_coefficient", pipeline, tests, friction, True, of_traction))
    return found


def _observe(
    observable: Observable,
    pipeline: Pipeline[...],
    tests: WearTests,
    friction: float | None,
    fits_friction: bool,
    scatter: Scatter,
) -> Observations:
    values = tests.columns.get(observable, np.full(len(tests), np.nan))
    there = ~np.isnan(values)
    if not there.any():
        raise FitError(f"tests: none of the {len(tests)} tests has a {observable.replace('_', ' ')}, which is fitted")
    labels = tuple(label or f"number {number}" for number, label in enumerate(tests.labels, 1))
    selected, measured = dataclasses.replace(tests, labels=labels)[there], values[there]
    if scatter == "relative":
        _refuse_zeros(observable, selected, measured)
    conditions = selected.conditions(pipeline.contact_model, friction, pipeline.rig)
    if fits_friction:  # else the measured traction would replace the one that follows from the friction coefficient
        conditions = {**conditions, FRICTION: friction}
        conditions.pop("traction_coefficient", None)
    problem = pipeline.posed(conditions, of_one_patch="fit")
    if scatter == "relative":
        _refuse_rest(observable, selected, problem)
    unit = _unit(selected, measured, scatter)
    return Observations(observable, pipeline, selected, measured, problem, scatter, unit)


def _unit(tests: WearTests, measured: Array, scatter: Scatter) -> Array:
    if scatter == "relative":
        return np.ones_like(measured)
    if scatter == "absolute":
        return np.full_like(measured, np.sqrt(np.mean(measured**2)) or 1.0)
    stated = tests.columns["wear_rate_uncertainty"]
    if np.isnan(stated).any():
        raise FitError(
            f"wear_rate_uncertainty: is missing in {test_names(tests, np.isnan(stated))}; give it for every test with a"
            " wear rate, or for none"
        )
    return stated


def _refuse_zeros(observable: Observable, tests: WearTests, measured: Array) -> None:
    zero = measured <= 0.0
    if zero.any():
        raise FitError(
            f"{observable}: is zero in {test_names(tests, zero)}, but is taken to scatter by a factor, and no factor"
            ' leads to zero; leave these tests out, or fit with scatter="absolute"'
        )


def _refuse_rest(observable: Observable, tests: WearTests, problem: Problem) -> None:
    still = problem.rigid_slip == 0.0
    name = observable.replace("_", " ")
    if still.any():
        raise FitError(
            f"creepage: is zero in {test_names(tests, still)}, where the predicted {name} is zero, whatever the"
            " parameters; leave these tests out"
        )


def test_names(tests: WearTests, which: NDArray[np.bool_]) -> str:
    """Return the labels of up to five tests, for messages."""
    numbers = np.flatnonzero(which)
    shown = [tests.labels[i] for i in numbers[:5]]
    more = f" and {numbers.size - 5} more" if numbers.size > 5 else ""
    return f"test{'s' if numbers.size > 1 else ''} {', '.join(shown)}{more}"
