"""Checks of a stage around the contact models of wearlaw, on each shape of patch."""

from __future__ import annotations

import operator

import numpy as np

from wearlaw.contact.problem import Problem
from wearlaw.models.contact_model import Stage
from wearlaw.numerics.integrate import integrate_forces
from wearlaw.numerics.solving import Solver, check_finite
from wearlaw_kit.contact import assert_digits
from wearlaw_kit.reduced import creeping, parts_of_power
from wearlaw_kit.rules import rule
from wearlaw_kit.shapes import assert_same_forces, forces_as, of_stage

POINTS = 24
"""Operating points at which a stage is tried."""

FIXED_POINT = 1e-9
"""Relative difference of two results of one problem, since a fixed point is found only to the tolerance of its search.

Searches that stop at a hundred roundings in friction lie far below it.
"""


@rule(Stage, always=True)
def pipelines_take_the_contact(stage: Stage) -> None:
    """The problem has the geometry and shape of the one it replaces, and the contact keeps its own bounds and sums."""
    for model, problem in of_stage(stage, POINTS):
        for batch in (problem, problem[0], problem[:1], problem[np.arange(POINTS).reshape(2, -1)]):
            flat = batch.flatten() if batch.batch_shape else batch
            Solver(model).solve(flat)
            integrate_forces(model, batch)


@rule(Stage)
def points_are_independent(stage: Stage) -> None:
    """One operating point at a time gives the same as all at once."""
    for model, problem in of_stage(stage, POINTS):
        together = integrate_forces(model, problem)
        for point in range(0, POINTS, 5):
            alone = integrate_forces(model, problem[point])
            part = forces_as(together, operator.itemgetter(point))
            assert_same_forces(problem[point], part, alone, "of a point in a batch", FIXED_POINT)


@rule(Stage)
def opposite_creepages_have_opposite_forces(stage: Stage) -> None:
    """If all creepages change sign, so do the forces."""
    for model, problem in of_stage(stage, POINTS):
        forces, turned = (integrate_forces(model, case) for case in (problem, creeping(problem, -1.0)))
        assert_same_forces(
            problem, forces_as(turned, np.negative), forces, "of the opposite creepages, turned", FIXED_POINT
        )


@rule(Stage, always=True)
def contact_does_not_gain_energy(stage: Stage) -> None:
    """The contact dissipates energy: ξFx + ηFy + φMz is not negative, but for rounding."""
    for model, problem in of_stage(stage, POINTS):
        forces = integrate_forces(model, problem)
        gained = -problem.power(forces)
        assert (gained <= 1e-12 * parts_of_power(problem, forces)).all(), "the contact gains energy"


@rule(Stage, always=True)
def contact_is_finite(stage: Stage) -> None:
    """Every field and total of the contact is a finite number, also at rest and in full slip."""
    for model, problem in of_stage(stage, POINTS):
        for factor in (0.0, 1e-6, 1.0, 100.0):
            held = _held(creeping(problem, factor))
            check_finite(model, model.solve(held), held)


def _held(problem: Problem) -> Problem:
    """Return the problem with creepages of magnitude 1 at the most."""
    return problem.replaced(
        longitudinal_creepage=np.clip(problem.longitudinal_creepage, -1.0, 1.0),
        lateral_creepage=np.clip(problem.lateral_creepage, -1.0, 1.0),
    )


@rule(Stage)
def contact_is_in_double_precision(stage: Stage) -> None:
    """The forces are exact to the search of a fixed point, in steps of 1e-8 of creepage, friction and half-length."""
    for model, problem in of_stage(stage, POINTS):
        assert_digits(model, problem, FIXED_POINT)
