"""Checks of how the forces follow the creepages."""

from __future__ import annotations

from functools import partial

import numpy as np

from wearlaw.arrays.array import Array
from wearlaw.contact.problem import CreepForces, Problem
from wearlaw.models.contact_model import ContactModel
from wearlaw.testing.bisection import Indices, find_jumps
from wearlaw.testing.examples import SAME, assert_close, for_each
from wearlaw.testing.problems import at_magnitude, creeping, friction_limit, parts_of_power, translation
from wearlaw.testing.shapes import ELLIPSE, Shape, on_each_shape


@on_each_shape
def forces_are_odd_in_the_creepages(model: ContactModel, shape: Shape) -> None:
    """Opposite creepages and spin give opposite forces and moment, and the same wear index."""

    def examine(problem: Problem) -> None:
        _compare_turned(model, shape, problem, (-1.0, -1.0, -1.0), "at the opposite creepages")

    for_each(shape.problems, examine)


def forces_are_mirrored_with_the_creepages(model: ContactModel) -> None:
    """Opposite lateral creepage and spin give the same Fx and wear index, and opposite Fy and Mz, as y is mirrored."""

    def examine(problem: Problem) -> None:
        _compare_turned(model, ELLIPSE, problem, (1.0, -1.0, -1.0), "at the mirrored creepages")

    for_each(ELLIPSE.problems, examine)


def _compare_turned(
    model: ContactModel, shape: Shape, problem: Problem, signs: tuple[float, float, float], message: str
) -> None:
    """Compare forces and wear index with those for creepages, and hence forces, of other signs."""
    contact, other = model.solve(problem), model.solve(creeping(problem, *signs))
    due = CreepForces(
        longitudinal=signs[0] * contact.force_x,
        lateral=signs[1] * contact.force_y,
        spin_moment=signs[2] * contact.moment_z,
    )
    shape.assert_same_forces(problem, other.forces, due, message, shape.rounding)
    shape.assert_same_power(problem, other, contact, message, shape.rounding)


@on_each_shape
def force_grows_with_creepage(model: ContactModel, shape: Shape) -> None:
    """Fx never falls when a longitudinal creepage alone grows."""

    def examine(problem: Problem) -> None:
        growing = np.concatenate([[1.0], 1.0 + np.logspace(-12, 3, 31)])
        none = np.zeros(growing.shape)
        batch = problem.broadcast_to(growing.shape).with_creepages(translation(problem) * growing, none, none)
        force = shape.forces(model, batch).longitudinal
        fell = np.diff(force) < -shape.rounding * force[:-1]
        assert not fell.any(), f"the force falls as the creepage grows: {force!r}"
        assert force[0] > 0, f"the force is {force[0]!r} at a positive creepage"

    for_each(shape.problems, examine)


@on_each_shape
def force_stays_below_friction(model: ContactModel, shape: Shape) -> None:
    """The tangential force, on an ellipse of Fx and Fy, does not exceed μN, unless an ellipse has no traction bound."""
    if shape is ELLIPSE and "traction_bound" in model.exemptions:
        return

    def examine(problem: Problem) -> None:
        growing = np.logspace(0, 4, 9)
        batch = creeping(problem.broadcast_to(growing.shape), growing)
        share = shape.forces(model, batch).tangential / friction_limit(problem)
        assert (share <= 1.0 + shape.error_of_force(model)).all(), f"the force reaches {share.max():.9g} μN"

    for_each(shape.problems, examine)


@on_each_shape
def forces_are_continuous(model: ContactModel, shape: Shape) -> None:
    """Forces and mean slip have no jump as creepages grow through full slip; one of 1/1000 is found.

    Cells begin to slip as a whole: with them, the mean slip may jump by the accuracy times the creepage, on a line that
    of full slip. On the nodes of an ellipse, with spin, a force may jump by the accuracy times μN.
    """
    path = shape.path(model)
    growth = path.high / path.low

    def solved(name: str, index: Indices, share: Array) -> Array:
        value: Array = getattr(model.solve(at_magnitude(path.problem[index], path.low * growth**share)), name)
        return value

    for name, allowed in path.allowed.items():
        for point, share, before, behind in find_jumps(partial(solved, name), path.problem.size, path.intervals):
            assert abs(behind - before) <= allowed[point], (
                f"{name} jumps from {before:.9g} to {behind:.9g} in SI units at {path.low * growth**share:g} of"
                f" {shape.unit}"
            )


@on_each_shape
def zero_creepage_gives_nothing(model: ContactModel, shape: Shape) -> None:
    """Free rolling has no traction, no slip, no forces and no wear index."""

    def examine(problem: Problem) -> None:
        contact = model.solve(creeping(problem, 0.0))
        for name in ("traction", "slip", "tangential_force", "force_x", "force_y", "moment_z", "wear_index"):
            value = getattr(contact, name)
            assert (value == 0).all(), f"without creepage {name} reaches {np.abs(value).max():.3g} in SI units"

    for_each(shape.problems, examine)


@on_each_shape
def wear_index_is_forces_times_creepages(model: ContactModel, shape: Shape) -> None:
    """Tγ is ξFx, and on an ellipse ξFx + ηFy + φMz."""

    def examine(problem: Problem) -> None:
        contact = model.solve(problem)
        rounding = SAME * parts_of_power(problem, contact.forces)
        assert_close(contact.wear_index, problem.power(contact.forces), "the wear index", 0.0, rounding)

    for_each(shape.problems, examine)


@on_each_shape
def forces_alone_are_those_of_the_contact(model: ContactModel, shape: Shape) -> None:
    """`tangential_force` and `creep_forces` give the forces of `solve`, with the sign of the creepage."""

    def examine(problem: Problem) -> None:
        found, due = shape.forces_alone(model, problem), model.solve(problem).forces
        shape.assert_same_forces(problem, found, due, "alone", shape.rounding)

    for_each(shape.problems, examine)
    for_each(shape.batches, examine)


CHECKS = (
    forces_are_odd_in_the_creepages,
    forces_are_mirrored_with_the_creepages,
    force_grows_with_creepage,
    force_stays_below_friction,
    forces_are_continuous,
    zero_creepage_gives_nothing,
    wear_index_is_forces_times_creepages,
    forces_alone_are_those_of_the_contact,
)

OF_ELLIPSES = (forces_are_mirrored_with_the_creepages,)
"""Checks of models that solve ellipses."""
