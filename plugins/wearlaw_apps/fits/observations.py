"""Measurements beside the predictions of a pipeline, for many parameter sets at once."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

from wearlaw.arrays import Array
from wearlaw.contact.problem import Problem
from wearlaw.errors import ConfigurationError, FitError, ModelError
from wearlaw.models.law import named_outcomes
from wearlaw.numerics.integrate import integrate_forces, patch_area
from wearlaw.pipeline.pipeline import Pipeline
from wearlaw.units.variables import UNITS, name_of
from wearlaw_apps.fits.free_parameters import FreeParameters, give_bounds
from wearlaw_apps.fits.named_numbers import FRICTION, Place, check_loads_stay, outcomes_at, traction_at
from wearlaw_apps.fits.wear_tests import WearTests
from wearlaw_apps.output.labels import label

Scatter: TypeAlias = Literal["relative", "absolute", "uncertainty"]
"""Scatter of measurements: by a factor, by an amount, or by their stated uncertainties."""

TRACTION = "traction_coefficient"
"""The measurement that no law predicts."""

FLOOR = 1e-300
"""Replaces a prediction of zero, whose logarithm is infinite."""


@dataclass(frozen=True, slots=True, eq=False)
class Observations:
    """Measurements of one kind, with the pipeline that predicts them.

    Attributes
    ----------
    observable : str
        "traction_coefficient" [-], or the name of a law's outcome, such as "wear_rate".
    law : int or None
        Index of the law that predicts it; None for the traction.
    measured : ndarray, (n,)
        The measurements in SI.
    conditions : mapping of str to Quantity or array_like, (n,) or a single value
        The conditions of the tests, which the rig takes.
    problem : Problem
        The contact problems of the tests, with batch shape (n,).
    divisor : ndarray, (n,)
        Divisor of the residuals; 1 for relative scatter.
    """

    observable: str
    law: int | None
    pipeline: Pipeline[...]
    places: Mapping[str, Place]
    tests: WearTests
    measured: Array
    conditions: Mapping[str, Any]
    problem: Problem
    scatter: Scatter
    divisor: Array

    @property
    def unit(self) -> str:
        """Unit of the measurement in tables and figures."""
        return UNITS[TRACTION] if self.law is None else self.pipeline.laws[self.law].outcome.unit

    @property
    def label(self) -> str:
        """Name of the measurement with its unit, for the axis of a figure."""
        return label(self.observable, units={self.observable: self.unit})

    def predicted(self, values: Mapping[str, Array], problem: Problem | None = None) -> Array:
        """Return the predictions (sets, n) for all free parameters in SI, (sets,) each, at tests or other points."""
        problem = self.problem if problem is None else problem
        sets, points = len(next(iter(values.values()))), problem.size
        problem = problem[np.tile(np.arange(points), sets)]
        at_points = {place: np.repeat(values[name], points) for name, place in self.places.items()}
        try:
            if self.law is None:
                predicted = traction_at(self.pipeline, problem, at_points)
            else:
                predicted = outcomes_at(self.pipeline, problem, at_points, [self.law])
        except (ConfigurationError, ModelError) as error:
            names = [name for name, place in self.places.items() if place.kind == "stage"]
            if not names:
                raise
            raise FitError(
                f"the search for the best fit has met values of {' and '.join(names)} that the stage or the contact"
                f" model does not accept; {give_bounds(names[0])}: {error}"
            ) from error
        return predicted.reshape(sets, points)

    def compare(self, predicted: Array) -> Array:
        """Return the residuals of predictions (..., n)."""
        if self.scatter == "relative":
            return np.log(np.maximum(predicted, FLOOR) / self.measured)
        return (predicted - self.measured) / self.divisor


def wear_index_density(pipeline: Pipeline[...], problem: Problem) -> Array:
    """Return Tγ/A [N/m²] of the whole patch, of the batch shape."""
    model = pipeline.staged_model
    power = problem.power(integrate_forces(model, problem))
    density: Array = np.abs(power) / patch_area(model, problem)
    return density


def observe(
    pipeline: Pipeline[...],
    tests: WearTests,
    free: FreeParameters,
    friction: float | None,
    scatter: Literal["relative", "absolute"],
) -> list[Observations]:
    """Return the measurements that depend on the free parameters: outcomes of laws, and tractions.

    An outcome depends on the numbers of its law and on all that changes the contact, the traction on the latter only.
    """
    of_contact = free.of_contact
    check_loads_stay(pipeline, "fit", of_contact)
    tests = dataclasses.replace(
        tests, labels=tuple(label or f"number {number}" for number, label in enumerate(tests.labels, 1))
    )
    outcomes: dict[str, int | None] = {**named_outcomes(pipeline.laws), TRACTION: None}
    observations = []
    for name, index in outcomes.items():
        law = None if index is None else pipeline.laws[index]
        values = tests.measured(name, UNITS[TRACTION] if law is None else law.outcome.unit)
        there = ~np.isnan(values)
        needed = FRICTION in free.names if index is None else index in free.freed_laws
        if needed and not there.any():
            unused = [column for column in tests.other_conditions if column not in pipeline.conditions]
            hint = (
                f"; {', '.join(unused)}: no conditions of this rig, so say what they are by columns" if unused else ""
            )
            if tests.ways and law is not None and not law.outcome.wear:
                hint = f"; by its law, {name} is no wear that a measured mass converts to (wear=True of its Outcome)"
            raise FitError(f"tests: none of the {len(tests)} tests has a {name_of(name)}, which is fitted{hint}")
        if not (needed or (of_contact and there.any())):
            continue
        selected, measured = tests[there], values[there]
        conditions = selected.conditions(pipeline.contact_model, friction, pipeline)
        if FRICTION in free.names:
            conditions[FRICTION] = friction
        if of_contact:  # else the measured traction would replace the one that follows from the parameters
            conditions.pop(TRACTION, None)
        problem = pipeline.posed(conditions, of_one_patch="fit")
        stated = f"{name}_uncertainty" in {**tests.columns, **tests.outcomes}
        chosen: Scatter = "uncertainty" if stated else scatter
        unit = "" if law is None else law.outcome.unit
        divisor = _divisor(name, unit, selected, measured, chosen)
        observations.append(
            Observations(name, index, pipeline, free.places, selected, measured, conditions, problem, chosen, divisor)
        )
    if not observations:
        raise FitError(
            f"tests: none of the {len(tests)} tests has a measured {' or '.join(map(name_of, outcomes))}, to which"
            f" {' and '.join(of_contact)} could be fitted"
        )
    return observations


def _divisor(observable: str, unit: str, tests: WearTests, measured: Array, scatter: Scatter) -> Array:
    """Return the divisor of the residuals, (n,), or raise an error if measurements cannot scatter in that way."""
    if scatter == "absolute":
        return np.full_like(measured, np.sqrt(np.mean(measured**2)) or 1.0)
    if scatter == "uncertainty":
        divisor = tests.measured(f"{observable}_uncertainty", unit)
        if np.isnan(divisor).any():
            raise FitError(
                f"{observable}_uncertainty: is missing in {test_names(tests, np.isnan(divisor))}; give it for all"
                f" tests with a {name_of(observable)}, or for none"
            )
        return divisor
    zero = measured <= 0.0
    if zero.any():
        raise FitError(
            f"{observable}: is zero or negative in {test_names(tests, zero)}, which no scatter by a factor can express;"
            ' leave these tests out, or fit with scatter="absolute"'
        )
    return np.ones_like(measured)


def test_names(tests: WearTests, which: NDArray[np.bool_]) -> str:
    """Return the labels of up to five tests, for messages."""
    numbers = np.flatnonzero(which)
    labels = [tests.labels[i] or f"number {i + 1}" for i in numbers[:5]]
    more = f" and {numbers.size - 5} more" if numbers.size > 5 else ""
    return f"test{'s' if numbers.size > 1 else ''} {', '.join(labels)}{more}"
