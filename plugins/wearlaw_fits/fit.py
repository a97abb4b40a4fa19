"""Fitting the numbers of laws and stages, and the friction coefficient, to tests: `fit`."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from numbers import Integral
from typing import Any, Literal

import numpy as np

from wearlaw.arrays.array import steadily
from wearlaw.errors import FitError, FitWarning, shown
from wearlaw.pipeline.composition import warn_of_parameters
from wearlaw.pipeline.pipeline import Pipeline
from wearlaw.settings.arguments import expect
from wearlaw.units.quantities import QuantityLike
from wearlaw_fits.intervals import DECIDED_ALONE, Replicates, leverage, replicate
from wearlaw_fits.least_squares import Solutions
from wearlaw_fits.observations import test_names
from wearlaw_fits.result import Fit
from wearlaw_fits.summary import summarise
from wearlaw_fits.task import Task
from wearlaw_fits.wear_tests.tests import WearTests

AT_BOUND = 1e-6
"""Distance from a bound, as a share of the range, up to which a fit counts as lying on it."""

USABLE = 0.95
"""Share of the replicates that must converge and determine each parameter, for reliable intervals."""


def fit(
    predict: Pipeline[...],
    tests: WearTests,
    free: Sequence[str],
    *,
    friction_coefficient: float | None = None,
    scatter: Literal["relative", "absolute"] = "relative",
    bounds: Mapping[str, tuple[QuantityLike | float, QuantityLike | float]] | None = None,
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
    tests : WearTests
        Measured tests. Those without a law's outcome do not affect the parameters of the law.
    free : sequence of str
        Numeric fields of laws and stages, nested ones with a dot as in "coefficient.low_speed", and
        "friction_coefficient". A name that several of them have is written "third_body.reduction", or "usfd_rail.m_m"
        for one of the laws of two bodies. The friction coefficient is one value for all tests. It and the numbers of
        stages are also fitted to the traction T/N, on an ellipse with T = √(Fx² + Fy²).
    friction_coefficient : float, optional
        μ of tests without one, or the starting value if it is free.
    scatter : str
        "relative": measurements scatter by a factor, and the residual is ln(predicted/measured). "absolute": the
        residual is predicted - measured. If the tests state an uncertainty of the wear rate, the residual is
        (predicted - measured) over that, whatever is given here.
    bounds : mapping of str to pair, optional
        Least and greatest values, within the limits of the field. Default: a hundredth and a hundred times the
        starting value of a number that must be positive; for any other, a hundred times its size below and above it;
        within the limits of the field.
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

    Warns
    -----
    CalibrationWarning
        If parameters that are not free were fitted for another contact or other materials.
    FitWarning
        If the law does not fit the tests (see `LackOfFit`), the fit ends at a bound, a test decides a parameter alone,
        or the bootstrap is unreliable.

    Notes
    -----
    G. A. F. Seber and C. J. Wild, Nonlinear Regression, Wiley 1989.
    """
    expect(WearTests, tests, "tests", "wearlaw.WearTests, as from wl.read_tests")
    _check_settings(scatter, confidence, starts=starts, bootstrap=bootstrap, seed=seed)
    with steadily():
        task = Task.of(predict, tests, free, friction_coefficient, scatter, {} if bounds is None else bounds)
        best = task.solve(starts, seed)
        replicates = None
        if bootstrap:
            replicates = replicate(task.model, best, task.free.bounds, task.groups, bootstrap, seed, on_progress)
    if overload := task.overload(best):
        overload.warn()
    settings = {
        "predict": predict,
        "free": list(free),
        "friction_coefficient": friction_coefficient,
        "scatter": scatter,
        "bounds": bounds,
        "starts": starts,
        "seed": seed,
        "confidence": confidence,
    }
    with steadily():
        found = summarise(task, best, replicates, confidence, settings)
    _warn(task, best, replicates, found)
    _warn_of_kept(task)
    return found


def _check_settings(scatter: object, confidence: object, **counts: object) -> None:
    if not isinstance(scatter, str) or scatter not in ("relative", "absolute"):
        raise FitError(f'scatter: must be "relative" or "absolute", got {shown(scatter)}')
    if not (isinstance(confidence, float | np.floating) and 0.0 < confidence < 1.0):
        raise FitError(f"confidence: must be a number between 0 and 1, such as 0.95, got {shown(confidence)}")
    for name, value in counts.items():
        if isinstance(value, bool) or not isinstance(value, Integral) or value < 0:
            raise FitError(f"{name}: must be a whole number that is not negative, got {shown(value)}")
    bootstrap: Any = counts["bootstrap"]
    least = math.ceil(round(2.0 / (1.0 - float(confidence)), 6))  # since 1 - 0.9 is rounded
    if 0 < bootstrap < least:
        raise FitError(
            f"bootstrap: must be at least {least}, for replicates beyond both ends of an interval of confidence"
            f" {confidence:.6g}, or 0 for intervals by Student's t; got {bootstrap}"
        )


def _warn(task: Task, best: Solutions, replicates: Replicates | None, found: Fit) -> None:
    """Warn the caller of `fit` if the fit is less certain than its intervals say."""
    poor = (one.warning for one in found.lack_of_fit if one.poor)
    for text in (*poor, *_at_bounds(task, best), *_decided_alone(task, best), *_unreliable(task, replicates)):
        warnings.warn(text, FitWarning, stacklevel=3)


def _warn_of_kept(task: Task) -> None:
    """Warn the caller of `fit` if a law keeps parameters that were fitted for another contact."""
    predict = task.predict
    free = {(place.index, place.field) for place in task.free.places.values() if place.kind == "law"}
    for one in task.observations:
        if one.law is None:
            continue
        law, problem = predict.laws[one.law], one.problem
        if any((one.law, name) not in free for name in law.numbers):
            warn_of_parameters(problem.geometry, problem.bodies, predict.contact_model, predict.scale, law)


def _at_bounds(task: Task, best: Solutions) -> Iterator[str]:
    bounds, theta = task.free.bounds, best.theta[0]
    margin = AT_BOUND * (bounds.high - bounds.low)
    ended = (theta <= bounds.low + margin) | (theta >= bounds.high - margin)
    if ended.any():
        names = ", ".join(name for name, at in zip(task.free.names, ended, strict=True) if at)
        yield (
            f"the best fit lies at a bound of {names}, whose interval then means nothing; give wider bounds, or free"
            " fewer parameters"
        )


def _decided_alone(task: Task, best: Solutions) -> Iterator[str]:
    alone = leverage(best) > DECIDED_ALONE
    for number, one in enumerate(task.observations):
        which = alone[task.groups == number]
        if which.any():
            yield (
                f"the fit meets {test_names(one.tests, which)} whatever is measured there: so few tests decide a"
                " parameter that nothing checks it, and its interval rests on the scatter of the others"
            )


def _unreliable(task: Task, replicates: Replicates | None) -> Iterator[str]:
    if replicates is None:
        return
    usable = np.mean(replicates.standard_errors > 0.0, axis=0)
    lost = [
        f"{name} ({1.0 - share:.0%})" for name, share in zip(task.free.names, usable, strict=True) if share < USABLE
    ]
    if lost:
        yield f"some bootstrap replicates do not determine {', '.join(lost)}; their intervals may be too narrow"
    if replicates.converged < USABLE:
        yield f"only {replicates.converged:.0%} of the bootstrap replicates have converged; the intervals are rough"
