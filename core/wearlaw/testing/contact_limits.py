"""Checks of the claims that a contact model may be exempt from."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from hypothesis import strategies as st

from wearlaw.arrays import Array
from wearlaw.line import LineProblem
from wearlaw.tangential import Claim, ContactModel
from wearlaw.testing.contact_checks import (
    SUM,
    error_of_force,
    error_of_traction,
    friction_limit,
    saturation,
    solutions,
    with_creepage,
)
from wearlaw.testing.examples import SAME, assert_close, for_each
from wearlaw.testing.strategies import line_problems, log_uniform


def traction_keeps_its_bound(model: ContactModel) -> None:
    """The magnitude of the traction does not exceed the bound at any node."""

    def examine(problem: LineProblem) -> None:
        for contact in solutions(model, problem):
            over = np.abs(contact.traction) > contact.traction_bound * (1.0 + error_of_traction(model))
            share = np.abs(contact.traction[over]) / contact.traction_bound[over]
            assert not over.any(), f"the traction is {share} times its bound at x = {contact.x[over]}"

    for_each(line_problems(), examine)


def what_sticks_does_not_slip(model: ContactModel) -> None:
    """There is no slip where the traction is below its bound."""

    def examine(problem: LineProblem) -> None:
        for contact in solutions(model, problem):
            below = np.abs(contact.traction) < contact.traction_bound * (1.0 - SAME)
            wrong = below & (contact.slip != 0)
            assert not wrong.any(), f"slip of {contact.slip[wrong]} where the traction is below its bound"

    for_each(line_problems(), examine)


def full_slip_is_reached(model: ContactModel) -> None:
    """At 100 times the creepage of Carter's full slip, μa/R, the force is μN and every node slips at its bound."""

    def examine(problem: LineProblem) -> None:
        contact = model.solve(with_creepage(problem, 100.0 * saturation(problem)))
        assert_close(contact.tangential_force, friction_limit(problem), "the force in full slip", error_of_force(model))
        assert_close(contact.traction, contact.traction_bound, "the traction in full slip", error_of_traction(model))
        assert (contact.slip != 0).all(), "a node sticks in full slip"
        assert_close(contact.mean_slip, 100.0 * saturation(problem), "the mean slip in full slip", model.accuracy)

    for_each(line_problems(), examine)


def full_slip_is_met_from_both_sides(model: ContactModel) -> None:
    """Where full slip begins, force and mean slip over creepage have the same limit from both sides.

    What separates the two sides falls with the distance from full slip, at the least as its square root, the steepest
    onset of the theories of contact: from 1e-4 to 1e-8 of it, to a hundredth.
    """

    def examine(problem: LineProblem) -> None:
        full = _full_slip(model, problem)
        steps = np.array([_steps(model, problem, full, gap) for gap in (1e-4, 1e-8)])
        for name, (far, near), rounding in zip(
            ("force", "mean slip"), steps.T, (SAME, SAME + model.accuracy), strict=True
        ):
            assert near <= 0.01 * far + 2.0 * rounding, (
                f"the {name} jumps by {near:.2g} of its value into full slip, at the creepage {float(full):g}"
            )

    for_each(line_problems(), examine)


def _steps(model: ContactModel, problem: LineProblem, full: Array, gap: float) -> list[float]:
    """Return by which share the force, and the mean slip over creepage, differ on both sides of full slip."""
    creepage = [full * (1.0 + side * gap) for side in (-1.0, 1.0)]
    below, above = (model.solve(with_creepage(problem, at)) for at in creepage)
    slip_below, slip_above = below.mean_slip / creepage[0], above.mean_slip / creepage[1]
    return [
        float(abs(1.0 - below.tangential_force / above.tangential_force)),
        float(abs(1.0 - slip_below / slip_above)),
    ]


def _full_slip(model: ContactModel, problem: LineProblem) -> Array:
    """Return the least creepage at which the force has its limit and nothing sticks, to rounding, by bisection."""
    low, high = np.zeros_like(problem.creepage), 100.0 * saturation(problem)
    limit = model.solve(with_creepage(problem, high)).tangential_force * (1.0 - SAME)
    for _ in range(60):
        middle = 0.5 * (low + high)
        contact = model.solve(with_creepage(problem, middle))
        reached = (contact.tangential_force >= limit) & (contact.stick_ratio <= SUM)
        low, high = np.where(reached, low, middle), np.where(reached, middle, high)
    return high


def initial_slope_is_that_of_the_half_space(model: ContactModel) -> None:
    """For small creepage the force is (π/2) E* a ξ per width."""

    def examine(case: tuple[LineProblem, float]) -> None:
        problem, reduced = case
        creepage = reduced * saturation(problem)
        whole, half = (
            model.solve(with_creepage(problem, share * creepage)).tangential_force / (share * creepage)
            for share in (1.0, 0.5)
        )
        due = 0.5 * np.pi * problem.effective_modulus * problem.half_width * problem.track_width
        # T/ξ = T'(0) + c ξ + ..., so that half the creepage halves what is missing from T'(0): twice the difference
        # is the remainder, but for the share ξR/(μa) of it that the next order has. With an error e of each T, the
        # first is off by e, and twice the difference by 4 e.
        remainder = 2.0 * (1.0 + reduced) * np.abs(whole - half)
        assert_close(whole, due, "the force over a small creepage", 5.0 * error_of_force(model), remainder)

    for_each(st.tuples(line_problems(), log_uniform(1e-9, 1e-4)), examine)


def contacts_are_similar(model: ContactModel) -> None:
    """T/(μN) depends on ξR/(μa) alone."""

    def examine(pair: tuple[LineProblem, LineProblem]) -> None:
        problem, other = pair
        alike = with_creepage(other, problem.creepage / saturation(problem) * saturation(other))
        first, second = (model.solve(p).tangential_force / friction_limit(p) for p in (problem, alike))
        assert_close(second, first, "T/(μN) of a similar contact", SUM)

    for_each(st.tuples(line_problems(), line_problems()), examine)


CLAIMS: dict[Claim, tuple[Callable[[ContactModel], None], ...]] = {
    "traction_bound": (traction_keeps_its_bound,),
    "stick": (what_sticks_does_not_slip,),
    "saturation": (full_slip_is_reached, full_slip_is_met_from_both_sides),
    "initial_slope": (initial_slope_is_that_of_the_half_space,),
    "similarity": (contacts_are_similar,),
}
"""The checks of each claim."""
