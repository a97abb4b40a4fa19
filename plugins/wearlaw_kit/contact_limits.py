"""Checks of the claims that a contact model may be exempt from: bound, stick, full slip, initial slope, similarity."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

import numpy as np

from wearlaw.arrays.array import Array
from wearlaw.contact.contact import Contact
from wearlaw.contact.problem import CreepForces, Problem
from wearlaw.models.contact_model import ContactModel
from wearlaw_kit.examples import SAME, SUM, assert_close, for_each
from wearlaw_kit.reduced import (
    at_magnitude,
    at_reduced,
    friction_limit,
    random_ellipses,
    saturation,
    sliding_power,
    translation,
    with_creepage,
    without_spin,
)
from wearlaw_kit.shapes import (
    ELLIPSE,
    LINE,
    Claims,
    Shape,
    assert_same_forces,
    on_each_shape,
    on_problems,
    on_problems_of_each_shape,
    on_shapes,
)

POINTS = 32
"""Number of patches checked at once."""

FAR = 100.0
"""Reduced creepage far beyond the saturation of any theory that saturates."""

SLOPE = 1e-3
"""Error of initial slopes on an ellipse: half of the last digit of Kalker's coefficients."""

Solved: TypeAlias = Callable[[Array], Contact]
"""From the reduced creepages of some problems to the contacts."""


@on_problems_of_each_shape
def traction_keeps_its_bound(model: ContactModel, shape: Shape, problem: Problem) -> None:
    """The magnitude of the traction does not exceed the bound at any node."""
    for contact in shape.solutions(model, problem):
        traction = np.abs(contact.traction)
        over = traction > contact.traction_bound * (1.0 + shape.error_of_traction(model))
        share = traction[over] / contact.traction_bound[over]
        assert not over.any(), f"the traction is {share} times its bound at x, y = {contact.x[over]}, {contact.y[over]}"


@on_each_shape
def what_sticks_does_not_slip(model: ContactModel, shape: Shape) -> None:
    """There is no slip where the traction is below its bound.

    On an ellipse a cell may slip on one side and stick on the other, and the traction may turn within it. So the check
    sums slip times the distance of the traction from its bound, as a share of the power in full slip; and it leaves out
    creepages at which no more than such cells slip.
    """

    def examine(problem: Problem) -> None:
        for contact in shape.solutions(model, problem):
            lacking = np.maximum(contact.traction_bound * (1.0 - SAME) - np.abs(contact.traction), 0.0)
            share = contact.sum_over_nodes(np.abs(contact.slip) * lacking * contact.area) / sliding_power(problem)
            assert (share <= shape.error_of_stick(model)).all(), (
                f"below the bound there is slip, with {share.max():.2g} of the power that full slip has"
            )

    examine(shape.random(POINTS))
    if shape is LINE:
        for_each(shape.problems, examine)


@on_each_shape
def full_slip_is_reached(model: ContactModel, shape: Shape) -> None:
    """At 100 times the creepage of Carter's full slip, μa/R, the force is μN and every node slips at its bound.

    On an ellipse at 100 times the creepage that linear theory needs for μN, without spin. The force lies along a
    longitudinal or a lateral creepage; where there are both, between the creepage and the force of linear theory, since
    theories with a flexibility each for x and y turn it there.
    """
    linear = shape.directions / np.hypot(*shape.directions)
    problem = at_reduced(shape.random(POINTS)[:, None], FAR * linear[0], FAR * linear[1], 0.0)
    contact, slip, error = model.solve(problem), translation(problem), shape.error_of_force(model)
    limit = friction_limit(problem)
    assert_close(contact.tangential_force, limit, "the force in full slip", error)
    # At a node on the very edge the bound is rounding of that in the centre.
    edge = shape.edge * contact.per_node(contact.traction_bound.max(axis=tuple(range(2, contact.traction_bound.ndim))))
    assert_close(
        contact.traction, contact.traction_bound, "the traction in full slip", shape.error_of_traction(model), edge
    )
    sticks = (contact.slip == 0.0) & (contact.area > 0.0)
    assert not sticks.any(), f"{contact.stick_ratio.max():.3g} of the patch sticks in full slip"
    assert_close(contact.mean_slip, slip, "the mean slip in full slip", shape.error_of_sums(model))
    creepage = np.array([problem.longitudinal_creepage, problem.lateral_creepage]) / slip
    force = np.array([contact.force_x, contact.force_y]) / limit
    assert ((creepage * force).sum(axis=0) > 0).all(), "the force in full slip has the sense against the creepage"
    side = np.where(_cross(creepage, linear) < 0.0, -1.0, 1.0)
    aside = -np.minimum(side * _cross(creepage, force), side * _cross(force, linear))
    assert (aside <= error).all(), f"the force in full slip lies aside of the creepage by {aside.max():.3g} rad"


def _cross(first: Array, second: Array) -> Array:
    cross: Array = first[0] * second[1] - first[1] * second[0]
    return cross


@on_each_shape
def full_slip_is_met_from_both_sides(model: ContactModel, shape: Shape) -> None:
    """Where full slip begins, force and mean slip over creepage have the same limit from both sides, without spin.

    The difference between the sides falls with the distance from full slip at least as its square root, the steepest
    onset in theories of contact: from 1e-4 to 1e-8 of it, to a hundredth, and on an ellipse hardly more.
    """
    problem = without_spin(shape.random(POINTS))

    def solved(reduced: Array) -> Contact:
        return model.solve(at_magnitude(problem, reduced))

    full = _full_slip(solved, np.full(POINTS, FAR))
    far, near = (_steps_into_full_slip(solved, full, gap) for gap in (1e-4, 1e-8))
    error = max(shape.rounding, shape.error_of_sums(model))
    for name, rounding in (("force", shape.rounding), ("mean slip", error)):
        wrong = ~(near[name] <= shape.fall * far[name] + 2.0 * rounding)
        assert not wrong.any(), (
            f"the {name} jumps by {near[name][wrong].max():.2g} of its value into full slip, at {full[wrong][0]:g} of"
            f" {shape.unit}"
        )


def _full_slip(solved: Solved, high: Array) -> Array:
    """Return the least creepages, to rounding, with the same force as at `high` and no stick."""
    low = np.zeros_like(high)
    limit = solved(high).tangential_force * (1.0 - SAME)
    for _ in range(60):
        middle = 0.5 * (low + high)
        contact = solved(middle)
        reached = (contact.tangential_force >= limit) & (contact.stick_ratio <= SUM)
        low, high = np.where(reached, low, middle), np.where(reached, middle, high)
    return high


def _steps_into_full_slip(solved: Solved, full: Array, gap: float) -> dict[str, Array]:
    """Return the relative differences of force and of mean slip over creepage a `gap` below and above full slip."""
    below, above = (solved(full * (1.0 + side * gap)) for side in (-1.0, 1.0))
    slip = below.mean_slip / above.mean_slip * (1.0 + gap) / (1.0 - gap)
    return {
        "force": np.abs(1.0 - below.tangential_force / above.tangential_force),
        "mean slip": np.abs(1.0 - slip),
    }


@on_problems(LINE)
def initial_slope_is_that_of_the_half_space(model: ContactModel, shape: Shape, problem: Problem) -> None:
    """On a line the force at small creepage is (π/2) E* a ξ per width."""
    reduced = np.logspace(-9, -4, problem.size)  # relative to the creepage of full slip
    creepage = reduced * saturation(problem)
    whole, half = (
        model.solve(with_creepage(problem, share * creepage)).tangential_force / (share * creepage)
        for share in (1.0, 0.5)
    )
    due = 0.5 * np.pi * problem.effective_modulus * problem.half_width * problem.track_width
    # T/ξ = T'(0) + c ξ + ..., so that half the creepage halves the remainder: it is twice the difference, except for
    # the next order, which is the share ξR/(μa) of it. With an error e of each T, the first quotient is off by e, and
    # twice the difference by 4 e.
    remainder = 2.0 * (1.0 + reduced) * np.abs(whole - half)
    assert_close(whole, due, "the force over a small creepage", 5.0 * shape.error_of_force(model), remainder)


@on_shapes(ELLIPSE)
def initial_slopes_are_kalkers(model: ContactModel, shape: Shape) -> None:  # noqa: ARG001
    """For small creepages Fx is G ab C11 ξ, and Fy is G ab C22 η and G ab √(ab) C23 φ.

    The creepage is a millionth of the creepage at saturation, so that the force differs from the linear one by far less
    than `SLOPE`. A march over coarse cells ends the traction up to a cell too soon. That error is within its accuracy,
    and of first order: at least 1.5 times smaller on nodes twice as fine.
    """
    error = _slope_error(model)
    if error <= SLOPE:
        return
    finer = model.refined()
    assert finer is not None and error <= model.elliptic_accuracy, f"a slope is off by {error:.2g} of Kalker's"  # noqa: PT018
    left = _slope_error(finer)
    assert left <= max(error / 1.5, SLOPE), f"a slope is off by {error:.2g}, and still by {left:.2g} on finer nodes"


def _slope_error(model: ContactModel) -> float:
    """Return the largest error of the initial slopes, relative to Kalker's slope for the same creepage."""
    small, errors = 1e-6, []
    for cause in range(3):
        reduced = [0.0, 0.0, 0.0]
        reduced[cause] = small
        problem = at_reduced(random_ellipses(POINTS), *reduced)
        forces, unit = model.creep_forces(problem), small * friction_limit(problem)
        due = (1.0, 0.0) if cause == 0 else (0.0, 1.0)
        errors += [
            float(np.abs(found / unit - slope).max())
            for found, slope in zip((forces.longitudinal, forces.lateral), due, strict=True)
        ]
    return max(errors)


@on_each_shape
def contacts_are_similar(model: ContactModel, shape: Shape) -> None:
    """T/(μN) of a line depends on ξR/(μa) alone.

    On an ellipse forces over μN and the moment over μN a depend on a/b, ν and Gξ/(μp0), Gη/(μp0), Gφa/(μp0) alone.
    """
    problem, other = shape.problems, shape.similar
    known, ratio = shape.forces(model, problem), friction_limit(other) / friction_limit(problem)
    due = CreepForces(
        longitudinal=ratio * known.longitudinal,
        lateral=ratio * known.lateral,
        spin_moment=ratio * other.a / problem.a * known.spin_moment,
    )
    assert_same_forces(shape, other, shape.forces(model, other), due, "of a similar contact", SUM)


CLAIMS: Claims = {
    "traction_bound": (traction_keeps_its_bound,),
    "stick": (what_sticks_does_not_slip,),
    "saturation": (full_slip_is_reached, full_slip_is_met_from_both_sides),
    "initial_slope": (initial_slope_is_that_of_the_half_space, initial_slopes_are_kalkers),
    "similarity": (contacts_are_similar,),
}
