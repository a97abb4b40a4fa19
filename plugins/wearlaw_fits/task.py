"""The task of a fit: free parameters, measurements and weights, and solving for the best fit."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from wearlaw.arrays.array import Array
from wearlaw.contact.elastic_limit import Overload
from wearlaw.errors import FitError, shown
from wearlaw.models.law import named_outcomes
from wearlaw.numerics.integrate import integrate_forces
from wearlaw.pipeline.pipeline import Pipeline
from wearlaw.pipeline.ranges import overload_of
from wearlaw.units.quantities import QuantityLike, coefficient, from_si
from wearlaw.units.variables import UNITS
from wearlaw_fits.free_parameters import FRICTION, FreeParameters, free_names, give_bounds
from wearlaw_fits.intervals import undetermined
from wearlaw_fits.least_squares import Bounds, Solutions, refine, search
from wearlaw_fits.named_numbers import staged_models
from wearlaw_fits.observations import Observations, Scatter, observe, wear_index_density
from wearlaw_fits.wear_tests.tests import WearTests

NEAR = 10.0
"""Starting points lie within this factor of the first value, up and down."""

ROUNDS = 3
"""Iterations in which the scatter about the fit sets the weights of two kinds of measurement."""

LEAST_SCATTER = 1e-5
"""Least scatter for a weight; made-up tests without scatter would otherwise hide each other's parameters."""

LEAST_GROUP = 4
"""Least number of measurements of a kind to estimate their scatter."""


@dataclass
class Task:
    """The free parameters, the measurements, and the weights of the residuals."""

    predict: Pipeline[...]
    tests: WearTests
    scatter: Scatter
    free: FreeParameters
    observations: list[Observations]
    weights: Array

    @classmethod
    def of(
        cls,
        predict: Pipeline[...],
        tests: WearTests,
        free: Sequence[str],
        friction: float | None,
        scatter: Literal["relative", "absolute"],
        bounds: Mapping[str, tuple[QuantityLike | float, QuantityLike | float]],
    ) -> Task:
        """Return the task for the arguments of `fit`.

        Raises
        ------
        FitError
            If the tests lack a measurement or condition, or a parameter is unknown.
        """
        friction = _one_value(friction)
        if not isinstance(predict, Pipeline):
            raise FitError(f"predict: give a rig with a contact model, and laws or none, not {shown(predict)}")
        if predict.laws:
            predict = predict.with_law(*(law.explicit() for law in predict.laws))
        free = free_names(free)
        first = _first_friction(tests, friction) if FRICTION in free else friction
        parameters = FreeParameters.of(predict, free, first, bounds)
        observations = observe(predict, tests.measuring(named_outcomes(predict.laws)), parameters, first, scatter)
        stated = any(one.scatter == "uncertainty" for one in observations)
        chosen: Scatter = "uncertainty" if stated else scatter
        count = sum(one.measured.size for one in observations)
        if count <= len(parameters.names):
            raise FitError(
                f"tests: {count} measurement{'s' if count > 1 else ''} cannot tell {len(parameters.names)} parameters"
                f" ({', '.join(parameters.names)}) and their scatter; give more tests, or free fewer parameters"
            )
        return cls(predict, tests, chosen, parameters, observations, np.ones(count))

    @property
    def groups(self) -> NDArray[np.intp]:
        """The index of the kind of each measurement, (n,)."""
        return np.repeat(np.arange(len(self.observations)), [one.measured.size for one in self.observations])

    def model(self, theta: Array) -> Array:
        """Return the weighted residuals (sets, n) of scaled parameters (sets, p)."""
        values = self.free.columns(theta)
        return np.concatenate([one.residuals(values) for one in self.observations], axis=-1) * self.weights

    def solve(self, starts: int, seed: int) -> Solutions:
        """Return the best fit.

        Raises
        ------
        FitError
            If the fit has not converged, or the tests do not determine it.
        """
        bounds, first = self.free.bounds, np.zeros(len(self.free.names))
        target = np.zeros(self.weights.size)
        reach = np.where(self.free.positive, math.log(NEAR), NEAR)
        near = Bounds(bounds.clip(-reach), bounds.clip(reach))
        fits = search(self.model, target, first, bounds, near, starts, seed)
        best = min(fits, key=lambda one: float(one.cost[0]))
        if len(self.observations) > 1:
            for _ in range(ROUNDS):
                self._weigh(best)
                best = refine(self.model, target, best.theta[0], bounds)
        if not best.converged[0]:
            advice = give_bounds(self.free.names[0])
            raise FitError(f"the fit has not converged; {advice}, or a law whose parameters are nearer to the tests")
        self._check_determined(best)
        return best

    def _check_determined(self, best: Solutions) -> None:
        """Raise an error that names the parameters which the tests leave open."""
        names = [name for name, left in zip(self.free.names, undetermined(best.jacobian)[0], strict=True) if left]
        if not names:
            return
        one = self.observations[0]
        tested = {
            "creepage": one.problem.rigid_slip,
            "wear index density": wear_index_density(one.pipeline, one.problem),
        }
        units = (UNITS[name.replace(" ", "_")] for name in tested)
        covered = " and ".join(
            f"{name} {from_si(values.min(), unit)!r} to {from_si(values.max(), unit)!r}"
            for (name, values), unit in zip(tested.items(), units, strict=True)
        )
        open_ = " and ".join(names)
        raise FitError(
            f"free: the tests do not determine {open_}"
            + (", or determine only a combination of them" if len(names) > 1 else "")
            + f"; they cover {covered}; fix some of these parameters, or add tests in other regimes"
        )

    def overload(self, best: Solutions) -> Overload | None:
        """Return the test that is furthest beyond first yield, with the traction that the best fit predicts."""
        problem, values = self.observations[0].problem, self.free.columns(best.theta[:1])
        if FRICTION in values:
            problem = problem.replaced(friction_coefficient=np.full(problem.batch_shape, values[FRICTION][0]))
        at_places = {place: values[name] for name, place in self.free.places.items()}
        ((model, _),) = staged_models(self.predict, at_places, 1)
        return overload_of(problem, integrate_forces(model, problem).tangential)

    def _weigh(self, best: Solutions) -> None:
        """Weigh each kind of measurement by its scatter about the fit."""
        residuals, groups = best.residuals[0] / self.weights, self.groups
        for group in np.unique(groups):
            own = residuals[groups == group]
            scatter = math.sqrt(float(np.mean(own**2)))
            if own.size >= LEAST_GROUP and scatter > 0.0:
                self.weights[groups == group] = 1.0 / max(scatter, LEAST_SCATTER)


def _one_value(friction: float | None) -> float | None:
    if friction is None:
        return None
    value = coefficient(friction, FRICTION)
    if value.ndim:
        raise FitError(
            f"{FRICTION}: must be one number for all tests, such as 0.46, got an array of shape {value.shape}; one for"
            " each can stand in a column of the tests"
        )
    return float(value)


def _first_friction(tests: WearTests, given: float | None) -> float:
    """Return a starting value of the friction coefficient: given, from the tests, or the greatest traction."""
    traction = tests.columns.get("traction_coefficient")
    if traction is None or np.isnan(traction).all():
        raise FitError(
            "free: the friction coefficient is fitted to measured traction, and the tests hold none; add a column"
            " 'traction_coefficient', 'tangential_force [N]' or 'frictional_heat [W]', or give friction_coefficient"
        )
    if given is not None:
        return given
    if tests.friction_coefficient is not None:
        return float(np.mean(tests.friction_coefficient))
    return float(np.nanmax(traction))
