"""Checks of a contact model that hold for every theory.

Tolerances: a position is exact to the rounding of the half-width a, so an integral over a slip zone is exact to
rounding over the zone's share of the patch. Models with nodes of their own, whose sums are only as exact as their
cells, declare that as `accuracy`.
"""

from __future__ import annotations

import copy
from functools import partial

import numpy as np

from wearlaw.arrays.array import Array
from wearlaw.contact.contact import Contact
from wearlaw.contact.problem import Problem
from wearlaw.contact.quadrature import uniform_cells
from wearlaw.models.contact_model import QUADRATURE, ContactModel
from wearlaw.models.line_contact_model import LineContactModel
from wearlaw.testing.bisection import lost_digits
from wearlaw.testing.examples import SAME, SUM, assert_close, for_each
from wearlaw.testing.sampling import EPS
from wearlaw.testing.shared_checks import (
    assert_carries,
    assert_double,
    assert_finite,
    assert_solved_alike,
    assert_unchanged,
    friction_limit,
)
from wearlaw.testing.strategies import LINE_PROBLEMS, TWO_LINE_PROBLEMS


def with_creepage(problem: Problem, creepage: Array | float) -> Problem:
    """Return the problem at another creepage."""
    return problem.replaced(longitudinal_creepage=np.asarray(creepage, dtype=np.float64))


def repeated(problem: Problem, shape: tuple[int, ...]) -> Problem:
    """Return one operating point many times."""
    return problem.broadcast_to(shape)


def saturation(problem: Problem) -> Array:
    """Return μa/R, at which Carter's theory slips everywhere."""
    return problem.friction_coefficient * problem.half_width / problem.relative_radius


def error_of_force(model: ContactModel) -> float:
    """Return the permitted relative error of a force.

    This is rounding, or the accuracy that a model declares: its force is then a sum over its nodes.
    """
    return SAME if model.accuracy == QUADRATURE else model.accuracy


def error_of_traction(model: ContactModel) -> float:
    """Return the permitted relative error of a traction in full slip: rounding, or that of the force as its mean."""
    return error_of_force(model) if model.scale == "patch" else SAME


def solutions(model: ContactModel, problem: Problem) -> list[Contact]:
    """Return the contact on the model's own nodes and, where its fields are known anywhere, on uniform cells."""
    contacts = [model.solve(problem)]
    if isinstance(model, LineContactModel):
        contacts.append(model.at(problem, uniform_cells(problem.half_width, 97)))
    return contacts


def contact_has_the_shape_of_the_problem(model: ContactModel) -> None:
    """Totals have the batch shape, fields one more axis; without a batch axis, with one and with two."""

    def examine(problem: Problem) -> None:
        for shape in ((), (1,), (2, 3)):
            contact = model.solve(repeated(problem, shape))
            for name in ("normal_force", "tangential_force", "wear_index", "rolling_speed", "density"):
                found = getattr(contact, name).shape
                assert found == shape, f"{name} has the shape {found} for a batch of shape {shape}"
            for name in ("pressure", "traction", "slip", "traction_bound", "area", "x"):
                found = getattr(contact, name).shape
                assert found == contact.pressure.shape, f"{name} has the shape {found}, pressure another"
                assert found[:-1] == shape, f"{name} has the shape {found} for a batch of shape {shape}"

    for_each(LINE_PROBLEMS, examine)


def contact_is_finite(model: ContactModel) -> None:
    """Every field and total is a finite number; the traction bound may be infinite."""

    def examine(problem: Problem) -> None:
        assert_finite(model.solve(problem))

    for_each(LINE_PROBLEMS, examine)


def contact_carries_the_conditions(model: ContactModel) -> None:
    """Rolling speed, density and normal force are those of the problem, and so is the problem that it keeps."""

    def examine(problem: Problem) -> None:
        assert_carries(model.solve(problem), problem)

    for_each(LINE_PROBLEMS, examine)


def nodes_cover_the_patch(model: ContactModel) -> None:
    """Nodes lie in the patch, none has a negative area, and their areas sum to that of the patch."""

    def examine(problem: Problem) -> None:
        contact = model.solve(problem)
        assert (contact.area >= 0).all(), f"an area is negative: {contact.area.min()!r}"
        inside = np.abs(contact.x) <= problem.half_width * (1.0 + SAME)
        assert inside.all(), f"a node lies outside the patch, at x = {contact.x[~inside]!r}"
        assert_close(contact.patch_area, problem.patch_area, "the sum of the areas", SUM)

    for_each(LINE_PROBLEMS, examine)


def pressure_sums_to_the_load(model: ContactModel) -> None:
    """The pressure is never negative, and pressure times area sums to the normal force."""

    def examine(problem: Problem) -> None:
        contact = model.solve(problem)
        assert (contact.pressure >= 0).all(), f"a pressure is negative: {contact.pressure.min()!r}"
        load = contact.sum_over_nodes(contact.pressure * contact.area)
        assert_close(load, problem.normal_force, "the sum of the pressures", model.accuracy)

    for_each(LINE_PROBLEMS, examine)


def tractions_sum_to_the_force(model: ContactModel) -> None:
    """Traction times area sums to the tangential force."""

    def examine(problem: Problem) -> None:
        contact = model.solve(problem)
        allowed = model.accuracy * friction_limit(problem)
        force = contact.sum_over_nodes(contact.traction * contact.area)
        assert_close(force, contact.tangential_force, "the sum of the tractions", absolute=allowed)

    for_each(LINE_PROBLEMS, examine)


def traction_and_slip_follow_the_creepage(model: ContactModel) -> None:
    """Traction and slip have the sign of the creepage or are zero, so that q·s is never negative."""

    def examine(problem: Problem) -> None:
        for sign in (-1.0, 1.0):
            for contact in solutions(model, with_creepage(problem, sign * problem.creepage)):
                # The slip of full slip is a difference that vanishes at the leading edge, to rounding of the creepage.
                allowed = 4.0 * EPS * problem.creepage
                assert (sign * contact.slip >= -allowed).all(), f"slip against the creepage: {contact.slip!r}"
                assert (sign * contact.traction >= 0).all(), f"traction against the creepage: {contact.traction!r}"

    for_each(LINE_PROBLEMS, examine)


def random_problems(points: int) -> Problem:
    """Return discs of many sizes and stiffnesses under many loads, frictions and speeds; always the same ones."""
    random = np.random.default_rng(5)
    radius, modulus = 10.0 ** random.uniform(-3, 1, points), 10.0 ** random.uniform(9, 12, points)
    half_width = 2.0 * radius * 10.0 ** random.uniform(-5, np.log10(3e-2), points)
    friction = random.uniform(0.01, 1.5, points)
    return Problem.line_from_si(
        normal_force_per_width=0.25 * np.pi * modulus * half_width**2 / radius,
        relative_radius=radius,
        effective_modulus=modulus,
        friction_coefficient=friction,
        creepage=friction * half_width / radius * 10.0 ** random.uniform(-3, 1, points),
        rolling_speed=10.0 ** random.uniform(-2, 2, points),
        track_width=10.0 ** random.uniform(-4, 0, points),
        density=random.uniform(1e3, 2e4, points),
    )


def batch_equals_loop(model: ContactModel) -> None:
    """All operating points at once give the same as one at a time."""

    def examine(problem: Problem) -> None:
        # Stick, full slip and none in one batch: the points that a batch must keep apart.
        factors = np.array([[1.0, 0.0, -1.0], [1e-3, 1e3, 1.0 + 1e-9]])
        batch = with_creepage(repeated(problem, factors.shape), problem.creepage * factors)
        together = model.solve(batch)
        for index in np.ndindex(factors.shape):
            alone = model.solve(batch[index])
            for name in ("tangential_force", "wear_index", "patch_area", "mean_slip"):
                # A batch may hold zones without length, which change the order of a sum.
                found, due = getattr(together, name)[index], getattr(alone, name)
                assert_close(found, due, f"the {name} at operating point {index} of a batch", SUM)

    for_each(LINE_PROBLEMS, examine)


def problem_is_not_changed(model: ContactModel) -> None:
    """The model leaves the arrays of the problem as they are."""

    def examine(problem: Problem) -> None:
        batch = repeated(problem, (2,))
        before = copy.deepcopy(batch)
        model.solve(batch)
        assert_unchanged(batch, before)

    for_each(LINE_PROBLEMS, examine)


def solutions_agree_to_the_bit(model: ContactModel) -> None:
    """The same problem gives the same contact again, with another problem in between."""

    def examine(problems: tuple[Problem, Problem]) -> None:
        assert_solved_alike(model, *problems)

    for_each(TWO_LINE_PROBLEMS, examine)


def solution_is_in_double_precision(model: ContactModel) -> None:
    """The force is a float64 and exact to rounding, in steps of 1e-8 of creepage, friction and half-width."""
    problem = random_problems(64)
    assert_double(model.solve(problem))
    # An iteration that ends at 1e-10 moves a change of 1e-8 by a fiftieth; single precision, by six of it.
    rounding = min(error_of_force(model), 1e-10)
    for name in ("longitudinal_creepage", "friction_coefficient", "a"):
        lost_digits(
            partial(_force_with, model, problem, name), f"the tangential force loses digits of {name}", rounding
        )


def _force_with(model: ContactModel, problem: Problem, name: str, factor: float) -> Array:
    changed = {name: getattr(problem, name) * factor}
    if name == "a":  # by the load, as Hertz has it
        changed |= {"max_pressure": problem.max_pressure * factor, "normal_force": problem.normal_force * factor**2}
    return model.solve(problem.replaced(**changed)).tangential_force


CHECKS = (
    contact_has_the_shape_of_the_problem,
    contact_is_finite,
    contact_carries_the_conditions,
    nodes_cover_the_patch,
    pressure_sums_to_the_load,
    tractions_sum_to_the_force,
    traction_and_slip_follow_the_creepage,
    batch_equals_loop,
    problem_is_not_changed,
    solutions_agree_to_the_bit,
    solution_is_in_double_precision,
)
