"""Checks of the energy that slip dissipates, and of its convergence with finer nodes."""

from __future__ import annotations

import numpy as np

from wearlaw.arrays.array import Array
from wearlaw.contact.contact import Contact
from wearlaw.contact.problem import Problem
from wearlaw.contact.quadrature import uniform_cells
from wearlaw.models.contact_model import QUADRATURE, ContactModel
from wearlaw.models.line_contact_model import LineContactModel
from wearlaw.testing.contact_checks import random_problems, saturation, with_creepage
from wearlaw.testing.examples import SUM, assert_close, for_each
from wearlaw.testing.shared_checks import Claims, friction_limit
from wearlaw.testing.strategies import LINE_PROBLEMS

MANY = 512
"""Number of problems to average an error over, since the place within a cell where a zone begins is random."""

CHANCE = 1.3
"""Scatter of a mean of `MANY` errors: they scatter by 0.58 of their mean where one step falls anywhere in a
cell, and those in short slip zones weigh more, as if there were 128. The ratio of two such means scatters by
0.58 √(2/128) = 0.07; four times that is allowed."""

REFINEMENTS = 3
"""Number of refinements by a factor of two; they reduce a first-order error to an eighth."""


def slip_dissipates_the_energy_fed_in(model: ContactModel) -> None:
    """Traction times slip, summed over the patch, is the tangential force times the creepage."""

    def examine(problem: Problem) -> None:
        contact = model.solve(problem)
        slipping = contact.slip_area / contact.patch_area
        # Positions are exact to the rounding of a, so in a short slip zone q·s is that much less exact.
        rounding = SUM / np.maximum(slipping, SUM)
        due = contact.tangential_force * problem.creepage
        # A slip zone may be shorter than a cell: the error of sums over cells is a share of what full slip dissipates.
        whole = due if model.accuracy == QUADRATURE else friction_limit(problem) * problem.creepage
        allowed = model.accuracy * whole
        assert_close(_dissipated(contact), due, "the energy dissipated per metre", rounding, allowed)

    for_each(LINE_PROBLEMS, examine)


def _dissipated(contact: Contact) -> Array:
    return contact.sum_over_nodes(contact.wear_index_density * contact.area)


def _many_problems() -> Problem:
    problem = random_problems(MANY)
    # Nearer to zero, the slip zone is shorter than a cell.
    return with_creepage(problem, np.linspace(0.1, 1.2, MANY) * saturation(problem))


def _energy_error(contact: Contact) -> float:
    return float(np.abs(_dissipated(contact) / contact.wear_index - 1.0).mean())


def _traction_error(contact: Contact) -> float:
    force = contact.sum_over_nodes(contact.traction * contact.area)
    return float(np.abs(force / contact.tangential_force - 1.0).mean())


def energy_balance_improves_with_refinement(model: LineContactModel) -> None:
    """On 16 times as many uniform cells the energy balance is 16 times as good, or exact.

    The dissipation of a step that falls anywhere in a cell is of first order, that of a square root of order 3/2.
    """
    problem = _many_problems()
    coarse, fine = (_energy_error(model.at(problem, uniform_cells(problem.half_width, cells))) for cells in (50, 800))
    assert fine <= max(CHANCE * coarse / 16.0, SUM), (
        f"the energy is off by {coarse:.2g} on 50 cells, by {fine:.2g} on 800"
    )


def refined_nodes_improve_the_sums(model: ContactModel) -> None:
    """On nodes refined three times, sums of energy and traction are eight times as good, or as good as quadrature."""
    problem = _many_problems()
    models = refinements(model)
    coarse, fine = (chosen.solve(problem) for chosen in (models[0], models[-1]))
    for name, error in (("energy", _energy_error), ("traction", _traction_error)):
        assert_improved(name, error(coarse), error(fine))


def refinements(model: ContactModel) -> list[ContactModel]:
    """Return the model on its own nodes, and refined once up to `REFINEMENTS` times."""
    models = [model]
    for _ in range(REFINEMENTS):
        finer = models[-1].refined()
        assert finer is not None, "`refined` returns a model, but not of what it returned"
        models.append(finer)
    return models


def assert_improved(name: str, before: float, behind: float) -> None:
    """Assert that the error of a sum over nodes has fallen at first order, or to that of quadrature."""
    assert behind <= max(CHANCE * before / 2**REFINEMENTS, QUADRATURE), (
        f"the sum of {name} is off by {before:.2g}, and still by {behind:.2g} on {2**REFINEMENTS} times finer nodes"
    )


CLAIMS: Claims = {
    "energy_balance": (slip_dissipates_the_energy_fed_in,),
}

CLAIMS_OF_FIELDS: Claims = {
    "energy_balance": (energy_balance_improves_with_refinement,),
}
"""Checks of claims for models with fields at any position."""

CLAIMS_OF_REFINED: Claims = {
    "energy_balance": (refined_nodes_improve_the_sums,),
}
"""Checks of claims for models that can refine their nodes."""
