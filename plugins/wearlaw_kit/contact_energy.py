"""Checks of sums over the nodes: the energy that slip dissipates, other strips, and convergence with finer nodes."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from wearlaw.arrays.array import Array
from wearlaw.contact.contact import Contact
from wearlaw.contact.problem import CreepForces, Problem
from wearlaw.models.contact_model import QUADRATURE, ContactModel
from wearlaw_kit.contact_checks import sums_of
from wearlaw_kit.examples import assert_close
from wearlaw_kit.reduced import friction_limit, random_ellipses, sliding_power, without_spin
from wearlaw_kit.shapes import (
    ELLIPSE,
    PATCHES,
    Claims,
    Shape,
    assert_same_forces,
    on_each_shape,
    on_problems_of_each_shape,
    on_shapes,
)

CHANCE = 1.3
"""Scatter of a mean of `MANY` errors: they scatter by 0.58 of their mean where one step falls anywhere in a
cell, and those in short slip zones weigh more, as if there were 128. The ratio of two such means scatters by
0.58 √(2/128) = 0.07; four times that is allowed."""

REFINEMENTS = 3
"""Number of refinements by a factor of two; they reduce a first-order error to an eighth."""

STRIPS = 200
"""Number of strips of equal width; their sum of a parabola across the patch is off by the share 1/(2 `STRIPS`²)."""


@on_problems_of_each_shape
def slip_dissipates_the_energy_fed_in(model: ContactModel, shape: Shape, problem: Problem) -> None:
    """Traction times slip, summed over the patch, is ξFx, and on an ellipse without spin ξFx + ηFy."""
    straight = without_spin(problem)
    contact = model.solve(straight)
    due = straight.power(contact.forces)
    allowed = shape.error_of_power(model, straight, contact, due)
    assert_close(contact.cell_wear_index, due, "the energy dissipated per metre", 0.0, allowed)


@on_each_shape
def refined_nodes_improve_the_sums(model: ContactModel, shape: Shape) -> None:
    """On nodes refined three times, sums of energy and traction are eight times as good, or as good as quadrature.

    The energy is that without spin.
    """
    models = _refinements(model)
    coarse, fine = (_errors(chosen, shape) for chosen in (models[0], models[-1]))
    for name, before in coarse.items():
        assert fine[name] <= max(CHANCE * before / 2**REFINEMENTS, QUADRATURE), (
            f"the sum of {name} is off by {before:.2g}, and still by {fine[name]:.2g} on {2**REFINEMENTS} times finer"
            " nodes"
        )


def _refinements(model: ContactModel) -> list[ContactModel]:
    """Return the model on its own nodes, and refined once up to `REFINEMENTS` times."""
    models = [model]
    for _ in range(REFINEMENTS):
        finer = models[-1].refined()
        assert finer is not None, "`refined` returns a model whose own `refined` returns None"
        models.append(finer)
    return models


def _errors(model: ContactModel, shape: Shape) -> dict[str, float]:
    """Return the mean errors of the sums of energy, without spin, and of traction."""
    energy, traction = [], []
    for problem in shape.to_refine():
        contact = model.solve(problem)
        traction.append(_traction_error(shape, problem, contact))
        if problem.spin.any():
            problem = without_spin(problem)
            contact = model.solve(problem)
        energy.append(_energy_error(shape, problem, contact))
    return {"energy": float(np.mean(energy)), "traction": float(np.mean(traction))}


def _energy_error(shape: Shape, problem: Problem, contact: Contact) -> Array:
    due = problem.power(contact.forces)
    return np.abs(contact.cell_wear_index - due) / shape.size_of_power(problem, contact.forces)


def _traction_error(shape: Shape, problem: Problem, contact: Contact) -> Array:
    sums, due = sums_of(contact), contact.forces
    off: Array = np.hypot(sums.longitudinal - due.longitudinal, sums.lateral - due.lateral)
    return off / shape.sizes(problem, due)["longitudinal"]


@on_shapes(ELLIPSE)
def refined_strips_improve_the_forces(model: ContactModel, shape: Shape) -> None:  # noqa: ARG001
    """Each refinement, to twice the nodes or more, changes the forces on an ellipse half as much as the one before.

    Or less, or no more than quadrature.
    """
    problem, models = random_ellipses(PATCHES), _refinements(model)
    # One at a time since the nodes may be many.
    contacts = [[chosen.solve(problem[index]) for index in range(PATCHES)] for chosen in models]
    nodes = [of_model[0].x.size for of_model in contacts]
    assert (np.diff(nodes) >= nodes[:-1]).all(), f"`refined` has {nodes[1:]} nodes, from {nodes[0]}"
    forces = [np.array([[c.force_x, c.force_y] for c in of_model]).T / friction_limit(problem) for of_model in contacts]
    first, *_, last = (np.abs(fine - coarse).mean() for coarse, fine in pairwise(forces))
    assert last <= max(CHANCE * first / 2 ** (REFINEMENTS - 1), QUADRATURE), (
        f"the first refinement changes the forces by {first:.2g} μN, the last one by {last:.2g}"
    )


@on_shapes(ELLIPSE)
def other_strips_have_the_same_sums(model: ContactModel, shape: Shape) -> None:
    """On given strips, traction and energy sum to the same over y as on the model's own."""
    shares = (2.0 * np.arange(STRIPS) + 1.0) / STRIPS - 1.0
    problem = random_ellipses(PATCHES)
    contact, own = model.on_strips(problem, shares), model.solve(problem)
    if contact is None:  # its nodes are where they are
        return
    assert_close(contact.y, shares * problem.b[:, None, None], "the position of a strip")
    error = 2.0 * shape.error_of_sums(model) + 1.0 / STRIPS**2
    qx, qy = (contact.over_strip(traction) for traction in (contact.traction_x, contact.traction_y))
    lateral, y = qy * contact.strip_width, contact.y[..., 0, :]
    turning = contact.over_strip(contact.x * contact.traction_y) + y * qx
    sums = CreepForces(
        longitudinal=(qx * contact.strip_width).sum(axis=-1),
        lateral=lateral.sum(axis=-1),
        spin_moment=-(turning * contact.strip_width).sum(axis=-1),
    )
    assert_same_forces(shape, problem, sums, own.forces, "summed over the strips", error)
    assert_same_forces(shape, problem, contact.forces, own.forces, "on the strips", error)
    energy = (contact.over_strip(contact.wear_index_density) * contact.strip_width).sum(axis=-1)
    assert_close(energy, own.cell_wear_index, "the energy summed over the strips", 0.0, error * sliding_power(problem))


CLAIMS: Claims = {
    "energy_balance": (
        slip_dissipates_the_energy_fed_in,
        refined_nodes_improve_the_sums,
    ),
}

CHECKS = (refined_strips_improve_the_forces, other_strips_have_the_same_sums)

OF_REFINED = (refined_nodes_improve_the_sums, refined_strips_improve_the_forces)
"""Checks of models that can refine their nodes."""

OF_STRIPS = (other_strips_have_the_same_sums,)
"""Checks of models that solve on given strips."""
