"""Fitting the numbers of laws and stages, and the friction coefficient, to tests: `fit`."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from decimal import ROUND_CEILING, ROUND_FLOOR, Context
from typing import Any, Literal

import numpy as np
import scipy

from wearlaw.arrays import Array, steadily
from wearlaw.configuration import known_name
from wearlaw.errors import ConfigurationError, FitError, FitWarning, shown, warn, with_problems
from wearlaw.models.law import Calibration, named_outcomes
from wearlaw.numerics.integrate import integrate_forces
from wearlaw.numerics.totals import Totals
from wearlaw.pipeline.composition import warn_of_parameters
from wearlaw.pipeline.pipeline import Pipeline, Rig
from wearlaw.pipeline.ranges import RATIOS, overload_of
from wearlaw.units.quantities import Quantity, QuantityLike, coefficient, in_unit
from wearlaw.units.usual import OneWarning, remark
from wearlaw.units.variables import UNITS, name_of
from wearlaw_apps.fits.free_parameters import FreeParameters, give_bounds
from wearlaw_apps.fits.intervals import (
    Replicates,
    covariance,
    leverage,
    replicate,
    student_intervals,
    studentised,
    studentised_intervals,
    undetermined,
)
from wearlaw_apps.fits.lack_of_fit import LackOfFit, lack_of_fit, repeats
from wearlaw_apps.fits.least_squares import LOSSES, STEP, Bounds, Solutions, fit_many, jacobian, search
from wearlaw_apps.fits.measured_wear import in_outcomes
from wearlaw_apps.fits.named_numbers import FRICTION, changed_parts
from wearlaw_apps.fits.observations import FLOOR, Observations, Scatter, observe, test_names, wear_index_density
from wearlaw_apps.fits.read_tests import Columns, Source, tests_of
from wearlaw_apps.fits.result import Fit
from wearlaw_apps.fits.wear_tests import WearTests

NEAR = 10.0
"""Starting points lie within this factor of the first value, up and down."""

LEVEL = 0.01
"""Probability that a set of tests without outliers has a test that is named as one."""

MARGIN = 2.0
"""Standard deviations from which on a robust loss takes a test for an outlier, scipy's `f_scale`."""

LEAST_SCATTER = 1e-5
"""Least scatter for a weight; made-up tests without scatter would otherwise hide each other's parameters."""

USABLE = 0.95
"""Share of the replicates that must converge and determine each parameter, for reliable intervals."""


def fit(
    predict: Pipeline[...],
    tests: WearTests | Source,
    free: Sequence[str],
    *,
    columns: Columns = None,
    friction_coefficient: float | None = None,
    scatter: Literal["relative", "absolute"] = "relative",
    robust: Literal["linear", "huber", "soft_l1", "cauchy", "arctan"] = "linear",
    bounds: Mapping[str, tuple[QuantityLike | float, QuantityLike | float]] | None = None,
    body: str | None = None,
    starts: int = 256,
    bootstrap: int = 1000,
    seed: int = 0,
    confidence: float = 0.95,
    on_progress: Callable[[int], None] | None = None,
) -> Fit:
    """Fit numbers of laws and stages, and the friction coefficient, to tests by weighted least squares.

    Parameters
    ----------
    predict : Pipeline
        The pipeline to fit. Parameters that are not free keep the values of its laws and stages. Without a law, the
        friction coefficient and the numbers of stages are fitted to the measured traction.
    tests : WearTests, path or pandas.DataFrame
        Measured tests, or what `wearlaw.read_tests` reads. Those without a law's outcome do not affect its parameters.
    free : sequence of str
        Numeric fields of laws and stages, nested ones with a dot as in "coefficient.low_speed", and
        "friction_coefficient". A name that several of them have is written "third_body.reduction", or "usfd_rail.m_m"
        for one of the laws of two bodies. The friction coefficient is one value for all tests. It and the numbers of
        stages are also fitted to the traction T/N, on an ellipse with T = √(Fx² + Fy²).
    columns : mapping of str to str, optional
        Of a table: its columns by the names that they get, as for `wearlaw.read_tests`.
    friction_coefficient : float, optional
        μ of tests without one, or the starting value if it is free.
    scatter : str
        "relative": measurements scatter by a factor, and the residual is ln(predicted/measured). "absolute": the
        residual is predicted - measured. If the tests state an uncertainty of the wear rate, the residual is
        (predicted - measured) over that, whatever is given here.
    robust : str
        Loss of the residuals, as in ``scipy.optimize.least_squares``: "linear" for least squares; in the others, tests
        far from the fit count less, the least in "arctan". Far is beyond twice the stated uncertainty, or else
        2 · 1.4826 times the median of the residuals' magnitudes.
    bounds : mapping of str to pair, optional
        Least and greatest values, within the limits of the field. Default: a hundredth and a hundred times the
        starting value of a number that must be positive; for any other, a hundred times its size below and above it;
        within the limits of the field.
    body : str, optional
        The body whose mass, volume or depth was measured, such as "disc_2", or "both" if it is the sum of both.
        Default: the body of the law, or that in the head of the column, or else the first body of the rig.
    starts : int
        Number of further starting points, within a factor of ten of the given law.
    bootstrap : int
        Replicates of the bootstrap, at least 2/(1 - confidence), so that some lie beyond each end of an interval. 0
        for intervals by Student's t.
    seed : int
        Seed of all random numbers; the same seed gives the same fit.
    confidence : float
        Confidence level of the intervals, and of the tests for lack of fit.
    on_progress : callable, optional
        Called with the number of replicates in each finished batch.

    Raises
    ------
    FitError
        If a parameter is unknown or ambiguous, its outcome is not measured, the tests do not determine it, there are
        too few tests, no fit is found, or a setting is invalid.
    ConditionsError
        If the rig does not take the conditions of the tests.
    DataError
        If measured wear cannot be converted to the outcome of the law; the message says what is missing.

    Warns
    -----
    CalibrationWarning
        If parameters that are not free were fitted for another contact or other materials.
    UnusualWarning
        If the median of a column, or the fitted friction coefficient, is unusual.
    FitWarning
        If the law does not fit the tests (see `LackOfFit`), tests are outliers (see `Fit.outliers`), the fit ends at a
        bound, or the bootstrap is unreliable.

    Notes
    -----
    G. A. F. Seber and C. J. Wild, Nonlinear Regression, Wiley 1989.
    """
    tests = tests_of(tests, columns)
    settings = {
        "free": [free] if isinstance(free, str) else list(free),
        "friction_coefficient": friction_coefficient,
        "scatter": scatter,
        "robust": robust,
        "bounds": bounds,
        "starts": starts,
        "seed": seed,
        "confidence": confidence,
    }
    _check(settings, bootstrap)
    with steadily(), OneWarning() as unusual:
        task = _Task.of(predict, tests, body, settings)
        unusual.clear()  # columns are seen by their medians
    remark(task.tests.unusual(task.predict))
    with steadily(), OneWarning() as unusual:
        best = task.solve(starts, seed)
        replicates = task.replicated(best, bootstrap, seed, on_progress) if bootstrap else None
        result = _result(task, best, replicates, {"predict": task.predict, **settings})
        unusual.clear()  # the search visits parameters that nobody asked for
        friction = float(result.parameters[FRICTION].magnitude) if FRICTION in result.parameters else 0.0
        if friction > (most := RATIOS["friction"].most):
            unusual[FRICTION] = (
                f"the fit gives {friction:.4g}, usually at most {most:g}; are tractions in percent, loads in the wrong"
                " unit, or columns swapped?"
            )
    _warn(task, best, replicates, result)
    return result


def _check(settings: Mapping[str, Any], bootstrap: int) -> None:
    """Raise an error for a setting of a fit that is wrong whatever the tests."""
    for name, choices in {"scatter": ("relative", "absolute"), "robust": tuple(LOSSES)}.items():
        if settings[name] not in choices:
            raise FitError(f"{name}: must be one of {', '.join(map(shown, choices))}; got {shown(settings[name])}")
    for name, count in {"starts": settings["starts"], "bootstrap": bootstrap, "seed": settings["seed"]}.items():
        if not isinstance(count, int) or count < 0:
            raise FitError(f"{name}: must be a whole number, zero or positive, got {shown(count)}")
    confidence = settings["confidence"]
    if not 0.0 < confidence < 1.0:
        raise FitError(f"confidence: must be a number between 0 and 1, such as 0.95, got {shown(confidence)}")
    if 0 < bootstrap < round(2.0 / (1.0 - confidence), 6):
        raise FitError(f"bootstrap: must be 0 or at least 2/(1 - confidence), got {shown(bootstrap)}")


def _warn(task: _Task, best: Solutions, replicates: Replicates | None, result: Fit) -> None:
    """Warn the caller of `fit` of contacts beyond the elastic limit, of what the fit lacks, and of laws it keeps."""
    predict, free = task.predict, task.free
    problem = result.observations[0].problem
    if overload := overload_of(problem, integrate_forces(result.predict.staged_model, problem).tangential):
        overload.warn()
    poor = (test.warning for test in result.lack_of_fit if test.poor)
    if texts := [*poor, *_outliers(result), *_at_bounds(task, best), *_unreliable(task, replicates)]:
        warn(with_problems(texts[0], texts[1:]), FitWarning)
    freed = {(place.index, place.field) for place in free.places.values() if place.kind == "law"}
    for observed in task.observations:
        if observed.law is not None:
            law, problem = predict.laws[observed.law], observed.problem
            if any((observed.law, name) not in freed for name in law.numbers):
                warn_of_parameters(law, predict.contact_model, predict.scale, problem.geometry, problem.bodies)


@dataclass
class _Task:
    """The free parameters, the measurements, and the weights of the residuals: of their kind, and of a robust loss."""

    predict: Pipeline[...]
    tests: WearTests
    free: FreeParameters
    observations: list[Observations]
    robust: str
    weights: Array
    trust: Array
    conversions: tuple[str, ...]

    @classmethod
    def of(
        cls,
        predict: Pipeline[...],
        tests: WearTests,
        body: str | None,
        settings: Mapping[str, Any],
    ) -> _Task:
        """Return the task for the arguments of `fit`."""
        if not isinstance(predict, Pipeline):
            raise FitError(f"predict: give a rig with a contact model, and laws or none, not {shown(predict)}")
        friction, free = settings["friction_coefficient"], settings["free"]
        if friction is not None:
            number = coefficient(friction, FRICTION)
            if number.ndim:
                raise FitError(f"{FRICTION}: must be one number; one for each test can stand in a column of the tests")
            friction = float(number)
        predict = predict.with_law(*(law.explicit() for law in predict.laws)) if predict.laws else predict
        first = _first_friction(tests, friction) if FRICTION in free else friction
        tests = tests.measuring(named_outcomes(predict.laws))
        tests, predict, conversions = in_outcomes(tests, predict, first, body)
        parameters = FreeParameters.of(predict, free, first, settings["bounds"] or {})
        observations = observe(predict, tests, parameters, first, settings["scatter"])
        count = sum(observed.measured.size for observed in observations)
        if count <= len(parameters.names):
            raise FitError(
                f"tests: {count} measurement{'s' if count > 1 else ''} cannot tell {len(parameters.names)} parameters"
                f" ({', '.join(parameters.names)}) and their scatter; give more tests, or free fewer parameters"
            )
        ones = np.ones(count), np.ones(count)
        return cls(predict, tests, parameters, observations, settings["robust"], *ones, conversions)

    @property
    def scatter(self) -> Scatter:
        """Kind of the residuals: by stated uncertainties if any are."""
        return max((observed.scatter for observed in self.observations), key="uncertainty".__eq__)

    def parts(self, values: Array) -> list[Array]:
        """Return values of all measurements, (n,), by their kind, as views."""
        return np.split(values, np.cumsum([observed.measured.size for observed in self.observations])[:-1])

    def model(self, theta: Array) -> Array:
        """Return the weighted residuals (sets, n) of scaled parameters (sets, p)."""
        values = self.free.columns(theta)
        residuals = [observed.compare(observed.predicted(values)) for observed in self.observations]
        return np.concatenate(residuals, axis=-1) * self.weights * self.trust

    def residuals(self, best: Solutions) -> Array:
        """Return the residuals of a fit without their weights, (n,)."""
        residuals: Array = best.residuals[0] / (self.weights * self.trust)
        return residuals

    def solve(self, starts: int, seed: int) -> Solutions:
        """Return the best fit."""
        bounds, first = self.free.bounds, np.zeros(len(self.free.names))
        target = np.zeros(self.weights.size)
        reach = np.where(self.free.positive, math.log(NEAR), NEAR)
        near = Bounds(bounds.clip(-reach), bounds.clip(reach))
        best = search(self.model, target, first, bounds, near, starts, seed)
        if len(self.observations) > 1:
            for _ in range(3):  # the scatter about the fit sets the weights of its kind
                self._weigh(best)
                best = fit_many(self.model, target[None], best.theta, bounds)
        if self.robust != "linear":
            best = self._robust(best, bounds)
        if not best.converged[0]:
            advice = give_bounds(self.free.names[0])
            raise FitError(f"the fit has not converged; {advice}, or a law whose parameters are nearer to the tests")
        names = [name for name, left in zip(self.free.names, undetermined(best.jacobian)[0], strict=True) if left]
        if names:
            combined = ", or determine only a combination of them" if len(names) > 1 else ""
            raise FitError(
                f"free: the tests do not determine {' and '.join(names)}{combined}; fix some of these parameters, or"
                " add tests in other regimes"
            )
        return best

    def _weigh(self, best: Solutions) -> None:
        """Weigh each kind of measurement by its scatter about the fit."""
        for residuals, weights in zip(self.parts(self.residuals(best)), self.parts(self.weights), strict=True):
            scatter = math.sqrt(float(np.mean(residuals**2)))
            if residuals.size >= 4 and scatter > 0.0:  # fewer do not tell their scatter
                weights[:] = 1.0 / max(scatter, LEAST_SCATTER)

    def _robust(self, best: Solutions, bounds: Bounds) -> Solutions:
        """Return the fit by the robust loss, with residuals and derivatives that are not weighted by it.

        Least squares with the weights ρ' have the same minimum, and are solved until they settle.

        Notes
        -----
        P. W. Holland and R. E. Welsch, Commun. Statist. A 6 (1977) 813-827.
        """
        target, converged = np.zeros((1, self.weights.size)), False
        for _ in range(100):
            before = best.theta
            size = self.residuals(best) * self.weights / self._scale(best)
            self.trust[:] = np.sqrt(LOSSES[self.robust](size**2))
            best = fit_many(self.model, target, before, bounds)
            if converged := bool(best.converged[0] and np.abs(best.theta - before).max() < 1e-7):
                break
        self.trust[:] = 1.0
        residuals = self.model(best.theta)
        slopes = jacobian(self.model, best.theta, residuals, bounds)
        return Solutions(best.theta, residuals, slopes, np.array([converged]))

    def _scale(self, best: Solutions) -> Array:
        """Return the scale of the residuals in a robust loss, (n,)."""
        every = self.parts(self.residuals(best) * self.weights)
        scales = [
            1.0 if observed.scatter == "uncertainty" else 1.4826 * float(np.median(np.abs(part)))
            for observed, part in zip(self.observations, every, strict=True)
        ]
        return np.repeat(MARGIN * np.maximum(scales, LEAST_SCATTER), [part.size for part in every])

    def replicated(
        self, best: Solutions, count: int, seed: int, on_progress: Callable[[int], None] | None
    ) -> Replicates:
        """Return bootstrap replicates, drawn within each kind of measurement."""
        sizes = [observed.measured.size for observed in self.observations]
        kinds, errors = np.repeat(np.arange(len(sizes)), sizes), self.errors(best).residuals[0]
        return replicate(self.model, best, errors, self.free.bounds, kinds, count, seed, on_progress)

    def errors(self, best: Solutions) -> Solutions:
        """Return the fit with residuals that scatter as the estimate does: of a robust fit, s ψ(r/s)/mean ψ'.

        With ψ(r) = r ρ'(r²), least squares of these have the same minimum, and its covariance.

        Notes
        -----
        P. J. Huber, Robust Statistics, Wiley 1981, section 7.6, without the correction of order p/n.
        """
        if self.robust == "linear":
            return best
        loss, scale = LOSSES[self.robust], self._scale(best)
        size = best.residuals[0] / scale
        low, size, high = (value * loss(value**2) for value in (size - STEP, size, size + STEP))
        slope = float(np.mean(high - low)) / (2.0 * STEP)
        if slope < 0.1:  # near zero, most tests have hardly any weight, and intervals no meaning
            raise FitError(f'robust: too many tests lie far from the fit for {shown(self.robust)}; take "soft_l1"')
        return dataclasses.replace(best, residuals=(scale * size / slope)[None])

    def studentised(self, best: Solutions) -> Array:
        """Return the studentised residuals, (n,)."""
        errors = self.errors(best)
        return studentised(best.residuals[0], errors.residuals[0], leverage(best), len(self.free.names))

    def most(self) -> float:
        """Return the largest studentised residual that chance explains, at `LEVEL` over all tests, after Bonferroni."""
        count = self.weights.size
        tail = 0.5 * LEVEL / count
        return float(-scipy.special.stdtrit(max(count - len(self.free.names) - 1, 1), tail))


def _first_friction(tests: WearTests, friction: float | None) -> float:
    """Return a starting value of the friction coefficient: given, from the tests, or the greatest traction."""
    traction = tests.columns.get("traction_coefficient")
    if traction is None or np.isnan(traction).all():
        raise FitError(
            "free: the friction coefficient is fitted to measured traction, and the tests have none; add a column"
            " 'traction_coefficient', 'tangential_force [N]' or 'frictional_heat [W]', or give friction_coefficient"
        )
    if friction is not None:
        return friction
    if tests.friction_coefficient is not None:
        return float(np.mean(tests.friction_coefficient))
    return float(np.nanmax(traction))


def _result(task: _Task, best: Solutions, replicates: Replicates | None, settings: Mapping[str, Any]) -> Fit:
    """Return the result of a fit."""
    confidence: float = settings["confidence"]
    free, values = task.free, task.free.columns(best.theta)
    observations = tuple(_with_friction(observed, values) for observed in task.observations)
    errors = task.errors(best)
    by_student = student_intervals(errors, confidence)
    ends = by_student if replicates is None else studentised_intervals(errors, replicates, confidence)
    samples = {} if replicates is None else free.columns(replicates.theta)
    slopes = free.slopes(best.theta[0])
    chi2, aic = _sums(task, best)
    return Fit(
        parameters={name: free.quantity(name, float(value[0])) for name, value in values.items()},
        intervals=_pairs(free, ends),
        covariance_intervals=_pairs(free, by_student),
        confidence=confidence,
        covariance=covariance(errors)[0] * np.outer(slopes, slopes),
        predict=_fitted_pipeline(task, values, observations),
        tests=task.tests,
        scatter=task.scatter,
        chi2=chi2,
        aic=aic,
        samples={name: free.quantity(name, draws) for name, draws in samples.items()},
        observations=observations,
        lack_of_fit=tuple(_lack_of_fit(task, best, confidence)),
        studentised=task.studentised(best),
        most=task.most(),
        conversions=task.conversions,
        settings=settings,
    )


def _lack_of_fit(task: _Task, best: Solutions, confidence: float) -> Iterator[LackOfFit]:
    """Yield a test for each kind of measurement whose scatter is known."""
    residuals, leverages = task.parts(task.residuals(best)), task.parts(leverage(best))
    for observed, errors, spent in zip(task.observations, residuals, leverages, strict=True):
        points, stated = repeats(observed.conditions, errors.size), observed.scatter == "uncertainty"
        test = lack_of_fit(observed.observable, errors, points, float(spent.sum()), confidence, stated)
        if test is not None:
            yield test


def _pairs(free: FreeParameters, ends: tuple[Array, Array]) -> dict[str, tuple[Quantity, Quantity]]:
    low, high = (free.values(free.bounds.clip(end)) for end in ends)  # the search did not go beyond the bounds
    return {
        name: (free.quantity(name, float(low[i])), free.quantity(name, float(high[i])))
        for i, name in enumerate(free.names)
    }


def _with_friction(observed: Observations, values: Mapping[str, Array]) -> Observations:
    if FRICTION not in values:
        return observed
    friction = float(values[FRICTION][0])
    problem = observed.problem.replaced(friction_coefficient=np.full(observed.measured.shape, friction))
    return dataclasses.replace(observed, conditions={**observed.conditions, FRICTION: friction}, problem=problem)


def _fitted_pipeline(task: _Task, values: Mapping[str, Array], observations: Sequence[Observations]) -> Pipeline[...]:
    """Return the pipeline with the fitted numbers; laws with free numbers record the fit."""
    original = task.predict
    at_places = {place: float(values[name][0]) for name, place in task.free.places.items()}
    for observed in observations:
        nothing = observed.predicted(values)[0] <= FLOOR
        if observed.scatter == "relative" and nothing.any():
            raise FitError(
                f"the best fit predicts no {name_of(observed.observable)} in {test_names(observed.tests, nothing)};"
                ' leave these tests out, or fit with scatter="absolute"'
            )
    try:
        stages = changed_parts(original.stages, "stage", at_places)
        laws = list(changed_parts(original.laws, "law", at_places))
    except ConfigurationError as error:
        raise FitError(f"the best fit has parameters that the model does not accept; try bounds: {error}") from None
    predict = original.model_copy(update={"stages": stages})
    for observed in observations:
        if observed.law is not None and observed.law in task.free.freed_laws:
            laws[observed.law] = laws[observed.law].model_copy(
                update={"fitted_for": _calibration(task, predict, observed)}
            )
    return predict.with_law(*laws) if laws else predict


def _calibration(task: _Task, predict: Pipeline[...], observed: Observations) -> Calibration:
    """Return the calibration of a fitted law."""
    problem, model = observed.problem, predict.contact_model
    means = {
        "pressure": Totals().mean(problem, "pressure"),
        "slip_speed": Totals().mean(problem, "slip_speed"),
        "wear_index_density": wear_index_density(predict, problem),
    }
    options = ((name, getattr(model, name)) for name in type(model).model_fields)
    of = f" of {task.tests.source}" if task.tests.source else ""
    with_stages = f", with {' and '.join(map(repr, predict.stages))}" if predict.stages else ""
    return Calibration(
        contact_model=model.name,
        scale=predict.scale,
        options=tuple((name, value) for name, value in options if isinstance(value, str)),
        geometry=problem.geometry,
        materials=_materials(predict.rig),
        bodies=tuple(body.material for body in problem.bodies.values()),
        stated_range=tuple((name, *_ends(name, values)) for name, values in means.items()),
        tests=observed.tests.digests(observed.observable, observed.unit),
        source=f"fitted to {observed.measured.size} tests{of}{with_stages}",
    )


def _ends(variable: str, values: Array) -> tuple[str, str]:
    """Return the least and the greatest value with the unit, rounded outwards to four digits."""
    unit = UNITS[variable]
    shown = in_unit(values, unit)
    low, high = (
        float(Context(4, rounding).create_decimal_from_float(float(end)))
        for end, rounding in ((shown.min(), ROUND_FLOOR), (shown.max(), ROUND_CEILING))
    )
    return f"{low!r} {unit}", f"{high!r} {unit}"


def _materials(rig: Rig) -> str:
    names = [known_name(body.material) or " ".join(repr(body.material).split()) for body in rig.bodies.values()]
    if len(set(names)) == 1:
        return f"both bodies {names[0]}"
    return " on ".join(names) or "unknown"


def _sums(task: _Task, best: Solutions) -> tuple[float, float]:
    """Return the sum of squares and Akaike's criterion, with a separate scatter for each kind of measurement."""
    squares = task.residuals(best) ** 2
    parameters = len(task.free.names)
    if task.scatter == "uncertainty" and len(task.observations) == 1:
        return float(squares.sum()), float(squares.sum()) + 2.0 * parameters
    kinds, tiny = task.parts(squares), float(np.finfo(np.float64).tiny)
    likelihood = sum(kind.size * math.log(max(float(kind.mean()), tiny)) for kind in kinds)
    return float(squares.sum()), likelihood + 2.0 * (parameters + len(kinds))


def _outliers(fit: Fit) -> Iterator[str]:
    """Yield what to tell the user of tests that lie farther from a fit than the others allow."""
    if len(outliers := fit.outliers):
        names = ", ".join(
            f"{row.label} ({name_of(str(row.observable).partition(' ')[0])}, {row.studentised:.1f})"
            for row in outliers.itertuples()
        )
        yield (
            f"outliers: test{'s' if len(outliers) > 1 else ''} {names}; the studentised residual is beyond"
            f" {fit.most:.1f}, the most that the other tests allow at a level of {LEVEL:.0%} over all"
            ' tests. They stay in the fit: check them, or fit with robust="soft_l1"'
        )


def _at_bounds(task: _Task, best: Solutions) -> Iterator[str]:
    bounds, theta = task.free.bounds, best.theta[0]
    margin = 1e-6 * (bounds.high - bounds.low)
    ended = (theta <= bounds.low + margin) | (theta >= bounds.high - margin)
    if ended.any():
        names = ", ".join(name for name, at in zip(task.free.names, ended, strict=True) if at)
        yield (
            f"the best fit lies at a bound of {names}, whose interval then means nothing; check the units of the tests,"
            " give wider bounds, or free fewer parameters"
        )


def _unreliable(task: _Task, replicates: Replicates | None) -> Iterator[str]:
    if replicates is None:
        return
    usable = np.mean(replicates.standard_errors > 0.0, axis=0)
    lost = [name for name, share in zip(task.free.names, usable, strict=True) if share < USABLE]
    if lost:
        yield f"some bootstrap replicates do not determine {', '.join(lost)}; their intervals may be too narrow"
    if replicates.converged < USABLE:
        yield f"only {replicates.converged:.0%} of the bootstrap replicates have converged; the intervals are rough"
