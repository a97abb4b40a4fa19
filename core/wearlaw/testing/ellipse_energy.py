"""Checks of sums over an ellipse: the energy that slip dissipates, and convergence with finer nodes."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np

from wearlaw.arrays.array import Array
from wearlaw.contact.contact import Contact
from wearlaw.contact.problem import CreepForces, Problem
from wearlaw.models.contact_model import QUADRATURE, ContactModel
from wearlaw.testing.contact_energy import CHANCE, REFINEMENTS, assert_improved, refinements
from wearlaw.testing.ellipse_checks import forces_of, sums_of
from wearlaw.testing.ellipses import (
    Creepages,
    assert_same_forces,
    error_of_sums,
    random_ellipses,
    sliding_power,
)
from wearlaw.testing.examples import assert_close, for_each
from wearlaw.testing.shared_checks import Claims, friction_limit
from wearlaw.testing.strategies import ELLIPTIC_PROBLEMS

PATCHES = 8
"""Number of patches to average an error over."""

STRIPS = 200
"""Strips of equal width, whose sums of what is a parabola across the patch are off by 1/(2 `STRIPS`²) of it."""


def translation_dissipates_the_energy_fed_in(model: ContactModel) -> None:
    """Without spin, traction times slip, summed over the ellipse, is ξFx + ηFy."""

    def examine(problem: Problem) -> None:
        straight = problem.with_creepages(*Creepages.of(problem).times(1.0, 1.0, 0.0))
        contact = model.solve_ellipse(straight)
        due = straight.power(forces_of(contact))
        # A slip zone may be shorter than a cell: the error of sums over cells is a share of what full slip dissipates.
        allowed = error_of_sums(model) * np.maximum(sliding_power(straight), due)
        assert_close(contact.cell_wear_index, due, "the energy dissipated per metre", 0.0, allowed)

    for_each(ELLIPTIC_PROBLEMS, examine)


def refined_strips_improve_the_sums(model: ContactModel) -> None:
    """On nodes refined three times, of twice the number and more, sums of energy and traction are eight times as good.

    Or as good as quadrature. The energy is that without spin.
    """
    problem = random_ellipses(PATCHES)
    straight = problem.with_creepages(*Creepages.of(problem).times(1.0, 1.0, 0.0))
    models = refinements(model)
    nodes = [chosen.solve(problem[0]).x.size for chosen in models]
    assert (np.diff(nodes) >= nodes[:-1]).all(), f"`refined` has {nodes[1:]} nodes, from {nodes[0]}"
    for name, error, of in (("energy", _energy_error, straight), ("traction", _traction_error, problem)):
        before, behind = (float(_each(error, chosen, of).mean()) for chosen in (models[0], models[-1]))
        assert_improved(name, before, behind)


def refined_strips_improve_the_forces(model: ContactModel) -> None:
    """Each refinement changes the forces half as much as the one before, or less, or no more than quadrature."""
    problem = random_ellipses(PATCHES)
    forces = [_each(_forces, chosen, problem) for chosen in refinements(model)]
    first, *_, last = (np.abs(fine - coarse).mean() for coarse, fine in pairwise(forces))
    assert last <= max(CHANCE * first / 2 ** (REFINEMENTS - 1), QUADRATURE), (
        f"the first refinement changes the forces by {first:.2g} μN, the last one by {last:.2g}"
    )


Measure = Callable[[Problem, Contact], Array]


def _each(measure: Measure, model: ContactModel, problem: Problem) -> Array:
    """Return a measure of the contact of each patch, solved one at a time since the nodes may be many."""
    parts = (problem[index] for index in range(problem.size))
    return np.array([measure(part, model.solve_ellipse(part)) for part in parts])


def _energy_error(problem: Problem, contact: Contact) -> Array:
    return np.abs(contact.cell_wear_index - problem.power(forces_of(contact))) / sliding_power(problem)


def _traction_error(problem: Problem, contact: Contact) -> Array:
    sums = sums_of(contact)
    off: Array = np.hypot(sums.longitudinal - contact.force_x, sums.lateral - contact.force_y)
    return off / friction_limit(problem)


def _forces(problem: Problem, contact: Contact) -> Array:
    return np.array([contact.force_x, contact.force_y]) / friction_limit(problem)


def other_strips_have_the_same_sums(model: ContactModel) -> None:
    """On given strips, traction and energy sum to the same over y as on the model's own."""
    shares = (2.0 * np.arange(STRIPS) + 1.0) / STRIPS - 1.0
    problem = random_ellipses(PATCHES)
    contact, own = model.on_strips(problem, shares), model.solve_ellipse(problem)
    if contact is None:  # its nodes are where they are
        return
    assert_close(contact.y, shares * problem.b[:, None, None], "the position of a strip")
    error = 2.0 * error_of_sums(model) + 1.0 / STRIPS**2
    qx, qy = (contact.over_strip(traction) for traction in (contact.traction_x, contact.traction_y))
    lateral, y = qy * contact.strip_width, contact.y[..., 0, :]
    turning = contact.over_strip(contact.x * contact.traction_y) + y * qx
    sums = CreepForces(
        longitudinal=(qx * contact.strip_width).sum(axis=-1),
        lateral=lateral.sum(axis=-1),
        spin_moment=-(turning * contact.strip_width).sum(axis=-1),
    )
    assert_same_forces(problem, sums, forces_of(own), "summed over the strips", error)
    assert_same_forces(problem, forces_of(contact), forces_of(own), "on the strips", error)
    energy = (contact.over_strip(contact.wear_index_density) * contact.strip_width).sum(axis=-1)
    assert_close(energy, own.cell_wear_index, "the energy summed over the strips", 0.0, error * sliding_power(problem))


CLAIMS: Claims = {
    "energy_balance": (translation_dissipates_the_energy_fed_in,),
}

CLAIMS_OF_REFINED: Claims = {
    "energy_balance": (refined_strips_improve_the_sums,),
}
"""Checks of claims for models that can refine their nodes."""

OF_REFINED = (refined_strips_improve_the_forces,)
"""Checks of models that can refine their nodes."""

OF_STRIPS = (other_strips_have_the_same_sums,)
"""Checks of models that solve on given strips."""
