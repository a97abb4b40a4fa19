"""Checks of a stage around the contact models of wearlaw, on each shape of patch."""

from __future__ import annotations

from functools import partial

import numpy as np

from wearlaw.contact.problem import Problem
from wearlaw.models.stage import Stage
from wearlaw.numerics.integrate import integrate_forces
from wearlaw.numerics.solving import Solver
from wearlaw_kit.bisection import lost_digits
from wearlaw_kit.contact_checks import force_with
from wearlaw_kit.examples import assert_close
from wearlaw_kit.reduced import creeping, parts_of_power
from wearlaw_kit.sampling import arrays_of
from wearlaw_kit.shapes import SHAPES, of_stage

POINTS = 24
"""Operating points at which a stage is tried."""

FOUND = 1e-9
"""Relative difference of two results of one problem, since a fixed point is found only to the tolerance of its search.

Searches that stop at a hundred roundings in friction lie far below it.
"""


def pipelines_take_the_contact(stage: Stage) -> None:
    """The problem has the geometry and shape of the one it replaces, and the contact keeps its own bounds and sums."""
    for model, problem in of_stage(stage, POINTS):
        for batch in (problem, problem[0], problem[:1], problem[np.arange(POINTS).reshape(2, -1)]):
            flat = batch.flatten() if batch.batch_shape else batch
            Solver(model).solve(flat)
            integrate_forces(model, batch)


def points_are_independent(stage: Stage) -> None:
    """One operating point at a time gives the same as all at once."""
    for model, problem in of_stage(stage, POINTS):
        together = integrate_forces(model, problem)
        for point in range(0, POINTS, 5):
            alone = integrate_forces(model, problem[point])
            for name in ("longitudinal", "lateral", "spin_moment"):
                found, due = getattr(together, name)[point], getattr(alone, name)
                scale = FOUND * problem.friction_coefficient[point] * problem.normal_force[point]
                assert_close(found, due, f"the {name} force of a point in a batch", 0.0, scale)


def opposite_creepages_have_opposite_forces(stage: Stage) -> None:
    """If all creepages change sign, so do the forces."""
    for model, problem in of_stage(stage, POINTS):
        forces, turned = (integrate_forces(model, one) for one in (problem, creeping(problem, -1.0)))
        scale = FOUND * problem.friction_coefficient * problem.normal_force
        for name in ("longitudinal", "lateral"):
            found = -getattr(turned, name)
            assert_close(found, getattr(forces, name), f"minus the {name} force of the opposite creepages", 0.0, scale)


def contact_does_not_gain_energy(stage: Stage) -> None:
    """The contact dissipates energy: ξFx + ηFy + φMz is not negative, but for rounding."""
    for model, problem in of_stage(stage, POINTS):
        forces = integrate_forces(model, problem)
        gained = -problem.power(forces)
        assert (gained <= 1e-12 * parts_of_power(problem, forces)).all(), "the contact gains energy"


def contact_is_finite(stage: Stage) -> None:
    """Every field and total of the contact is a finite number, also at rest and in full slip."""
    for model, problem in of_stage(stage, POINTS):
        for factor in (0.0, 1e-6, 1.0, 100.0):
            solved = model.solve(_held(creeping(problem, factor)))
            for name, values in arrays_of(solved).items():
                bad = np.isnan(values).any() or (name != "traction_bound" and np.isinf(values).any())
                assert not bad, f"{name} is not finite"


def _held(problem: Problem) -> Problem:
    """Return the problem with creepages of magnitude 1 at the most."""
    return problem.replaced(
        longitudinal_creepage=np.clip(problem.longitudinal_creepage, -1.0, 1.0),
        lateral_creepage=np.clip(problem.lateral_creepage, -1.0, 1.0),
    )


def contact_is_in_double_precision(stage: Stage) -> None:
    """The forces are exact to the search of a fixed point, in steps of 1e-8 of creepage, friction and half-length."""
    for model, problem in of_stage(stage, POINTS):
        shape = next(shape for shape in SHAPES if shape.geometry == problem.geometry)
        for name in ("longitudinal_creepage", "friction_coefficient", "a"):
            force = partial(force_with, model, shape, problem, name)
            lost_digits(force, f"the tangential force loses digits of {name}", FOUND)


CHECKS = (
    pipelines_take_the_contact,
    points_are_independent,
    opposite_creepages_have_opposite_forces,
    contact_does_not_gain_energy,
    contact_is_finite,
    contact_is_in_double_precision,
)
