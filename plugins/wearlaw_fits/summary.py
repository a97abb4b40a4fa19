"""The summary of a fit for its user: the law with its calibration, intervals and provenance."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from wearlaw.arrays.array import Array
from wearlaw.errors import ConfigurationError, FitError
from wearlaw.models.contact_model import Model
from wearlaw.models.law import WEAR, Calibration
from wearlaw.numerics.totals import Totals
from wearlaw.pipeline.pipeline import Pipeline, Rig
from wearlaw.plugins import loader
from wearlaw.plugins.fields import specification
from wearlaw.settings.configuration import known_name
from wearlaw.units.quantities import Quantity, in_unit
from wearlaw.units.variables import UNITS
from wearlaw.version import __version__
from wearlaw_fits.free_parameters import FRICTION, FreeParameters
from wearlaw_fits.intervals import Replicates, covariance, leverage, student_intervals, studentised_intervals
from wearlaw_fits.lack_of_fit import LackOfFit, lack_of_fit, repeats
from wearlaw_fits.least_squares import Solutions
from wearlaw_fits.named_numbers import changed_parts
from wearlaw_fits.observations import FLOOR, Observations, test_names, wear_index_density
from wearlaw_fits.result import Fit
from wearlaw_fits.task import Task

DIGITS = 4
"""Significant digits of the stated range of a fitted law, rounded outwards."""


def summarise(
    task: Task, best: Solutions, replicates: Replicates | None, confidence: float, settings: Mapping[str, Any]
) -> Fit:
    """Return the result of a fit.

    Raises
    ------
    FitError
        If the fitted parameters are not valid for the law, or predict no wear where some was measured.
    """
    free, theta = task.free, best.theta[0]
    values = free.columns(best.theta)
    parameters = {name: free.quantity(name, float(value[0])) for name, value in values.items()}
    observations = tuple(_with_friction(one, values) for one in task.observations)
    predict = _fitted_pipeline(task, values, observations)
    by_student = student_intervals(best, confidence)
    ends = by_student if replicates is None else studentised_intervals(best, replicates, confidence)
    samples = {} if replicates is None else free.columns(replicates.theta)
    slopes = free.slopes(theta)
    chi2, aic = _sums(task, best)
    provenance = _provenance(task, predict, replicates, settings["seed"], chi2, confidence)
    return Fit(
        parameters=parameters,
        intervals=_pairs(free, ends),
        covariance_intervals=_pairs(free, by_student),
        interval_method="Student's t" if replicates is None else "studentised bootstrap",
        confidence=confidence,
        covariance=covariance(best)[0] * np.outer(slopes, slopes),
        law=predict.laws[0] if len(predict.laws) == 1 else None,
        predict=predict,
        tests=task.tests,
        scatter=task.scatter,
        chi2=chi2,
        aic=aic,
        samples={name: free.quantity(name, one) for name, one in samples.items()},
        provenance=provenance,
        observations=observations,
        lack_of_fit=_lack_of_fit(task, best, confidence),
        settings=settings,
    )


def _lack_of_fit(task: Task, best: Solutions, confidence: float) -> tuple[LackOfFit, ...]:
    """Return a test for each kind of measurement whose scatter is known."""
    residuals, leverages = best.residuals[0] / task.weights, leverage(best)
    found = []
    for number, one in enumerate(task.observations):
        own = task.groups == number
        points, spent = repeats(one.conditions, one.measured.size), float(leverages[own].sum())
        found.append(
            lack_of_fit(one.observable, residuals[own], points, spent, confidence, one.scatter == "uncertainty")
        )
    return tuple(one for one in found if one is not None)


def _pairs(free: FreeParameters, ends: tuple[Array, Array]) -> dict[str, tuple[Quantity, Quantity]]:
    low, high = (free.values(free.bounds.clip(end)) for end in ends)  # the search did not go beyond the bounds
    return {
        name: (free.quantity(name, float(low[i])), free.quantity(name, float(high[i])))
        for i, name in enumerate(free.names)
    }


def _with_friction(one: Observations, values: Mapping[str, Array]) -> Observations:
    if FRICTION not in values:
        return one
    friction = np.broadcast_to(values[FRICTION], one.measured.shape)
    return dataclasses.replace(one, problem=one.problem.replaced(friction_coefficient=friction))


def _fitted_pipeline(task: Task, values: Mapping[str, Array], observations: Sequence[Observations]) -> Pipeline[...]:
    """Return the pipeline with the fitted numbers; laws record their tests, and those with free numbers the fit."""
    given = task.predict
    at_places = {place: float(values[name][0]) for name, place in task.free.places.items()}
    for one in observations:
        nothing = one.predicted(values)[0] <= FLOOR
        if one.law is not None and one.scatter == "relative" and nothing.any():
            what = "wear" if one.observable == WEAR else one.observable.replace("_", " ")
            raise FitError(
                f"the best fit predicts no {what} in {test_names(one.tests, nothing)}; leave these tests out"
            )
    try:
        stages = changed_parts(given.stages, "stage", at_places)
        laws = list(changed_parts(given.laws, "law", at_places))
    except ConfigurationError as error:
        whose = "law" if task.free.freed_laws else "stage"
        raise FitError(f"the best fit has parameters that the {whose} does not accept; try bounds: {error}") from None
    predict = given.model_copy(update={"stages": stages})
    for one in observations:
        if one.law is not None:
            law = laws[one.law]
            if one.law in task.free.freed_laws:
                law = law.model_copy(update={"fitted_for": _calibration(task, predict, one)})
            laws[one.law] = law.with_tests(one.tests.digests(one.observable, one.unit))
    return predict.with_law(*laws) if laws else predict


def _calibration(task: Task, predict: Pipeline[...], one: Observations) -> Calibration:
    """Return the calibration of a fitted law."""
    problem = one.problem
    means = {
        "pressure": Totals().mean(problem, "pressure"),
        "slip_speed": Totals().mean(problem, "slip_speed"),
        "wear_index_density": wear_index_density(predict, problem),
    }
    of = f" of {task.tests.source}" if task.tests.source else ""
    with_stages = f", with {' and '.join(map(repr, predict.stages))}" if predict.stages else ""
    return Calibration(
        contact_model=predict.contact_model.name,
        scale=predict.scale,
        options=_options(predict.contact_model),
        geometry=problem.geometry,
        materials=_materials(predict.rig),
        bodies=tuple(body.material for body in problem.bodies.values()),
        stated_range=tuple((name, *_ends(name, values)) for name, values in means.items()),
        source=f"fitted to {one.measured.size} tests{of}{with_stages}",
    )


def _ends(variable: str, values: Array) -> tuple[str, str]:
    """Return the least and the greatest value with the unit, rounded outwards."""
    unit = UNITS[variable]
    shown = in_unit(values, unit)
    low, high = _rounded(float(shown.min()), math.floor), _rounded(float(shown.max()), math.ceil)
    return f"{low!r} {unit}", f"{high!r} {unit}"


def _options(model: Model) -> tuple[tuple[str, str], ...]:
    """Return the textual options of a contact model, which change its theory."""
    fields = ((name, getattr(model, name)) for name in type(model).model_fields)
    return tuple((name, value) for name, value in fields if isinstance(value, str))


def _materials(rig: Rig) -> str:
    names = [known_name(body.material) or repr(body.material) for body in rig.bodies.values()]
    if len(set(names)) == 1:
        return f"both bodies {names[0]}"
    return " on ".join(names) or "unknown"


def _rounded(value: float, rounding: Callable[[float], int]) -> float:
    """Return a value with few significant digits, rounded up or down."""
    if value == 0.0:
        return 0.0
    place = DIGITS - 1 - math.floor(math.log10(abs(value)))
    return float(f"{rounding(value * 10.0**place)}e{-place}")


def _sums(task: Task, best: Solutions) -> tuple[float, float]:
    """Return the sum of squares and Akaike's criterion, with a separate scatter for each kind of measurement."""
    squares = (best.residuals[0] / task.weights) ** 2
    parameters = len(task.free.names)
    if task.scatter == "uncertainty" and len(task.observations) == 1:
        return float(squares.sum()), float(squares.sum()) + 2.0 * parameters
    kinds = [squares[task.groups == number] for number in range(len(task.observations))]
    tiny = float(np.finfo(np.float64).tiny)
    likelihood = sum(kind.size * math.log(max(float(kind.mean()), tiny)) for kind in kinds)
    return float(squares.sum()), likelihood + 2.0 * (parameters + len(kinds))


def _provenance(
    task: Task, predict: Pipeline[...], replicates: Replicates | None, seed: int, chi2: float, confidence: float
) -> dict[str, Any]:
    """Return the provenance of a fit, as a TOML table; it holds the stages with their fitted numbers."""
    model = predict.contact_model
    found = loader.installed()
    origins = [(law, found.of_kind(law.kind).distribution(law.name, type(law))) for law in predict.laws]
    origin: dict[str, Any] = {law.kind.replace(" ", "_"): where for law, where in origins[:1]}
    if len(origins) > 1:
        origin = {"laws": {law.name: where for law, where in origins}}
    stages = [specification(stage) for stage in predict.stages]
    return {
        "wearlaw": __version__,
        **origin,
        "contact_model": found.contact_models.distribution(model.name, type(model)),
        **({"stages": stages} if stages else {}),
        "tests": task.tests.source,
        "measurements": {one.observable: one.measured.size for one in task.observations},
        "free": list(task.free.names),
        "scatter": task.scatter,
        "chi2": chi2,
        "seed": seed,
        "bootstrap": 0 if replicates is None else len(replicates.theta),
        "confidence": confidence,
    }
