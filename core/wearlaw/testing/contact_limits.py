"""Checks of the claims that a contact model may be exempt from."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from hypothesis import strategies as st

from wearlaw.arrays import Array
from wearlaw.line import LineProblem
from wearlaw.models import Claim, ContactModel, LineContactModel
from wearlaw.quadrature import uniform_cells
from wearlaw.records import Contact
from wearlaw.testing.contact_checks import (
    SUM,
    friction_limit,
    random_problems,
    saturation,
    with_creepage,
)
from wearlaw.testing.examples import SAME, assert_close, for_each
from wearlaw.testing.strategies import line_problems, log_uniform


def solutions(model: ContactModel, problem: LineProblem) -> list[Contact]:
    """Return the contact on the model's own nodes and, where its fields are known anywhere, on uniform cells."""
    contacts = [model.solve(problem)]
    if isinstance(model, LineContactModel):
        contacts.append(model.at(problem, uniform_cells(problem.half_width, 97)))
    return contacts


def traction_keeps_its_bound(model: ContactModel) -> None:
    """The magnitude of the traction does not exceed the bound at any node."""

    def examine(problem: LineProblem) -> None:
        for contact in solutions(model, problem):
            over = np.abs(contact.traction) > contact.traction_bound * (1.0 + SAME)
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


def slip_dissipates_the_energy_fed_in(model: ContactModel) -> None:
    """Traction times slip, summed over the patch, is the tangential force times the creepage."""

    def examine(problem: LineProblem) -> None:
        contact = model.solve(problem)
        slipping = contact.slip_area / contact.patch_area
        # Positions are exact to the rounding of a, so in a short slip zone q·s is that much less exact.
        rounding = SUM / np.maximum(slipping, SUM)
        due = contact.tangential_force * problem.creepage
        assert_close(_dissipated(contact), due, "the energy dissipated per metre", model.accuracy + rounding)

    for_each(line_problems(), examine)


def _dissipated(contact: Contact) -> Array:
    return contact.sum_over_nodes(contact.wear_index_density * contact.area)


def energy_balance_improves_with_refinement(model: LineContactModel) -> None:
    """On 16 times as many uniform cells the energy balance is at least four times as good, or exact.

    The dissipation of a step that falls anywhere in a cell is of first order, that of a square root of order 3/2; a
    quarter of the first order is demanded, on the mean over many problems.
    """
    problem = random_problems(128)
    # Nearer to zero, the slip zone is shorter than a cell.
    problem = with_creepage(problem, np.linspace(0.1, 1.2, 128) * saturation(problem))
    errors = []
    for cells in (50, 800):
        contact = model.at(problem, uniform_cells(problem.half_width, cells))
        errors.append(float(np.abs(_dissipated(contact) / contact.wear_index - 1.0).mean()))
    coarse, fine = errors
    assert fine <= max(coarse / 4.0, SUM), f"the energy is off by {coarse:.2g} on 50 cells, by {fine:.2g} on 800"


def full_slip_is_reached(model: ContactModel) -> None:
    """At 100 times the creepage of Carter's full slip, μa/R, the force is μN and every node slips at its bound."""

    def examine(problem: LineProblem) -> None:
        contact = model.solve(with_creepage(problem, 100.0 * saturation(problem)))
        assert_close(contact.tangential_force, friction_limit(problem), "the force in full slip")
        assert_close(contact.traction, contact.traction_bound, "the traction in full slip")
        assert (contact.slip != 0).all(), "a node sticks in full slip"
        assert_close(contact.mean_slip, 100.0 * saturation(problem), "the mean slip in full slip", model.accuracy)

    for_each(line_problems(), examine)


def full_slip_is_met_from_both_sides(model: ContactModel) -> None:
    """Just below full slip the force is already μN, and the mean slip is the creepage, to the distance from it."""

    def examine(problem: LineProblem) -> None:
        full = _full_slip(model, problem)
        for gap in (1e-4, 1e-8):
            below, above = (model.solve(with_creepage(problem, full * (1.0 + side * gap))) for side in (-1, 1))
            limit = friction_limit(problem)
            # T differs from μN in the second order of the gap at least, and s in the first.
            assert_close(above.tangential_force, limit, "the force above full slip", absolute=SAME * limit)
            assert_close(below.tangential_force, limit, "the force below full slip", 4.0 * gap + model.accuracy)
            assert_close(below.mean_slip, above.mean_slip, "the mean slip below full slip", 8.0 * gap + model.accuracy)

    for_each(line_problems(), examine)


def _full_slip(model: ContactModel, problem: LineProblem) -> Array:
    """Return the least creepage at which the force is μN to rounding, by bisection."""
    limit = friction_limit(problem) * (1.0 - SAME)
    low, high = np.zeros_like(limit), 100.0 * saturation(problem)
    for _ in range(60):
        middle = 0.5 * (low + high)
        reached = model.solve(with_creepage(problem, middle)).tangential_force >= limit
        low, high = np.where(reached, low, middle), np.where(reached, middle, high)
    return high


def initial_slope_is_that_of_the_half_space(model: ContactModel) -> None:
    """For small creepage the force is (π/2) E* a ξ per width."""

    def examine(case: tuple[LineProblem, float]) -> None:
        problem, reduced = case
        creepage = reduced * saturation(problem)
        force = model.solve(with_creepage(problem, creepage)).tangential_force / problem.track_width
        slope = 0.5 * np.pi * problem.effective_modulus * problem.half_width
        # The next term is of relative size ξR/(μa) times a number near one: 1/2 for Carter, 2/3 for the parabola.
        assert_close(force, slope * creepage, "the force at small creepage", 10.0 * reduced + SUM)

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
    "energy_balance": (slip_dissipates_the_energy_fed_in,),
    "saturation": (full_slip_is_reached, full_slip_is_met_from_both_sides),
    "initial_slope": (initial_slope_is_that_of_the_half_space,),
    "similarity": (contacts_are_similar,),
}
"""The checks of each claim."""

CLAIMS_OF_FIELDS: dict[Claim, tuple[Callable[[LineContactModel], None], ...]] = {
    "energy_balance": (energy_balance_improves_with_refinement,),
}
"""The checks of each claim that need a model which knows its fields at any position."""
