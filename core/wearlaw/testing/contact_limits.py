"""Checks of the claims that a contact model may be exempt from."""

from __future__ import annotations

import numpy as np
from hypothesis import strategies as st

from wearlaw.arrays.array import Array
from wearlaw.contact.contact import Contact
from wearlaw.contact.problem import Problem
from wearlaw.models.contact_model import ContactModel
from wearlaw.testing.contact_checks import (
    error_of_force,
    error_of_traction,
    saturation,
    solutions,
    with_creepage,
)
from wearlaw.testing.examples import SAME, SUM, assert_close, for_each
from wearlaw.testing.shared_checks import Claims, friction_limit, full_slip, steps_into_full_slip
from wearlaw.testing.strategies import LINE_PROBLEMS, TWO_LINE_PROBLEMS, log_uniform


def traction_keeps_its_bound(model: ContactModel) -> None:
    """The magnitude of the traction does not exceed the bound at any node."""

    def examine(problem: Problem) -> None:
        for contact in solutions(model, problem):
            over = np.abs(contact.traction) > contact.traction_bound * (1.0 + error_of_traction(model))
            share = np.abs(contact.traction[over]) / contact.traction_bound[over]
            assert not over.any(), f"the traction is {share} times its bound at x = {contact.x[over]}"

    for_each(LINE_PROBLEMS, examine)


def what_sticks_does_not_slip(model: ContactModel) -> None:
    """There is no slip where the traction is below its bound."""

    def examine(problem: Problem) -> None:
        for contact in solutions(model, problem):
            below = np.abs(contact.traction) < contact.traction_bound * (1.0 - SAME)
            wrong = below & (contact.slip != 0)
            assert not wrong.any(), f"slip of {contact.slip[wrong]} where the traction is below its bound"

    for_each(LINE_PROBLEMS, examine)


def full_slip_is_reached(model: ContactModel) -> None:
    """At 100 times the creepage of Carter's full slip, μa/R, the force is μN and every node slips at its bound."""

    def examine(problem: Problem) -> None:
        contact = model.solve(with_creepage(problem, 100.0 * saturation(problem)))
        assert_close(contact.tangential_force, friction_limit(problem), "the force in full slip", error_of_force(model))
        assert_close(contact.traction, contact.traction_bound, "the traction in full slip", error_of_traction(model))
        assert (contact.slip != 0).all(), "a node sticks in full slip"
        assert_close(contact.mean_slip, 100.0 * saturation(problem), "the mean slip in full slip", model.accuracy)

    for_each(LINE_PROBLEMS, examine)


def full_slip_is_met_from_both_sides(model: ContactModel) -> None:
    """Where full slip begins, force and mean slip over creepage have the same limit from both sides.

    The difference between the sides falls with the distance from full slip at least as its square root, the steepest
    onset in theories of contact: from 1e-4 to 1e-8 of it, to a hundredth.
    """

    def examine(problem: Problem) -> None:

        def solved(creepage: Array) -> Contact:
            return model.solve(with_creepage(problem, creepage))

        full = full_slip(solved, 100.0 * saturation(problem))
        far, near = (steps_into_full_slip(solved, full, gap) for gap in (1e-4, 1e-8))
        for name, rounding in (("force", SAME), ("mean slip", SAME + model.accuracy)):
            assert near[name] <= 0.01 * far[name] + 2.0 * rounding, (
                f"the {name} jumps by {near[name]:.2g} of its value into full slip, at the creepage {float(full):g}"
            )

    for_each(LINE_PROBLEMS, examine)


AT_SMALL_CREEPAGES = st.tuples(LINE_PROBLEMS, log_uniform(1e-9, 1e-4))
"""Problems, and creepages over that of full slip."""


def initial_slope_is_that_of_the_half_space(model: ContactModel) -> None:
    """For small creepage the force is (π/2) E* a ξ per width."""

    def examine(case: tuple[Problem, float]) -> None:
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

    for_each(AT_SMALL_CREEPAGES, examine)


def contacts_are_similar(model: ContactModel) -> None:
    """T/(μN) depends on ξR/(μa) alone."""

    def examine(pair: tuple[Problem, Problem]) -> None:
        problem, other = pair
        alike = with_creepage(other, problem.creepage / saturation(problem) * saturation(other))
        first, second = (model.solve(p).tangential_force / friction_limit(p) for p in (problem, alike))
        assert_close(second, first, "T/(μN) of a similar contact", SUM)

    for_each(TWO_LINE_PROBLEMS, examine)


CLAIMS: Claims = {
    "traction_bound": (traction_keeps_its_bound,),
    "stick": (what_sticks_does_not_slip,),
    "saturation": (full_slip_is_reached, full_slip_is_met_from_both_sides),
    "initial_slope": (initial_slope_is_that_of_the_half_space,),
    "similarity": (contacts_are_similar,),
}
