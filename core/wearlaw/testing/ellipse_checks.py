"""Checks of a contact model of ellipses that hold for every theory.

Tolerances: sums over nodes on strips are as exact as the model declares in `elliptic_accuracy`, as a share of what they
are in full slip; the patch means of one node, to rounding.
"""

from __future__ import annotations

import copy
import dataclasses
from functools import partial

import numpy as np

from wearlaw.arrays.array import Array
from wearlaw.contact.contact import NODE_VARIABLES, TOTALS, Contact
from wearlaw.contact.problem import CreepForces, Problem
from wearlaw.models.contact_model import ContactModel
from wearlaw.rigs.wheel_rail import WheelRailConditions
from wearlaw.testing.acceleration import Ramps
from wearlaw.testing.bisection import lost_digits
from wearlaw.testing.ellipses import (
    WHEEL_RAIL,
    Creepages,
    assert_same_forces,
    error_of_sums,
    random_ellipses,
)
from wearlaw.testing.examples import SAME, SUM, assert_close, for_each
from wearlaw.testing.sampling import EPS
from wearlaw.testing.shared_checks import (
    assert_carries,
    assert_double,
    assert_finite,
    assert_solved_alike,
    assert_unchanged,
)
from wearlaw.testing.strategies import ELLIPTIC_PROBLEMS, TWO_ELLIPTIC_PROBLEMS
from wearlaw.units.quantities import Q

FIELDS = (
    "pressure", "traction", "slip", "traction_bound", "area", "x", "y", "traction_x", "traction_y", "slip_x", "slip_y",
)  # fmt: skip


def forces_of(contact: Contact) -> CreepForces:
    """Return the forces and the moment of a contact."""
    return CreepForces(longitudinal=contact.force_x, lateral=contact.force_y, spin_moment=contact.moment_z)


def sums_of(contact: Contact) -> CreepForces:
    """Return the forces and the moment that the tractions at the nodes sum to."""
    qx, qy = contact.traction_x * contact.area, contact.traction_y * contact.area
    return CreepForces(
        longitudinal=contact.sum_over_nodes(qx),
        lateral=contact.sum_over_nodes(qy),
        spin_moment=-contact.sum_over_nodes(contact.x * qy + contact.y * qx),
    )


def elliptic_contact_has_the_shape_of_the_problem(model: ContactModel) -> None:
    """On an ellipse totals have the batch shape and fields two more axes, of nodes and strips."""

    def examine(problem: Problem) -> None:
        for shape in ((), (1,), (2, 3)):
            # As from conditions that broadcast: arrays without strides, which cannot be written to.
            contact = model.solve_ellipse(problem.broadcast_to(shape))
            for name in TOTALS:
                found = getattr(contact, name).shape
                assert found == shape, f"{name} has the shape {found} for a batch of shape {shape}"
            nodes = contact.pressure.shape[len(shape) :]
            assert len(nodes) == 2, f"pressure has the shape {contact.pressure.shape} for a batch of shape {shape}"
            for name in FIELDS:
                found = getattr(contact, name).shape
                assert found == (*shape, *nodes), f"{name} has the shape {found}, not {(*shape, *nodes)}"
            found = np.shape(contact.strip_width)
            assert found == (*shape, nodes[1]), f"strip_width has the shape {found}, not {(*shape, nodes[1])}"

    for_each(ELLIPTIC_PROBLEMS, examine)


def elliptic_contact_is_finite(model: ContactModel) -> None:
    """On an ellipse every field and total is a finite number; the traction bound may be infinite."""

    def examine(problem: Problem) -> None:
        assert_finite(model.solve_ellipse(problem))

    for_each(ELLIPTIC_PROBLEMS, examine)


def elliptic_contact_carries_the_conditions(model: ContactModel) -> None:
    """On an ellipse rolling speed, density and normal force are the problem's, and so is the problem that it keeps."""

    def examine(problem: Problem) -> None:
        assert_carries(model.solve_ellipse(problem), problem)

    for_each(ELLIPTIC_PROBLEMS, examine)


def nodes_cover_the_ellipse(model: ContactModel) -> None:
    """Nodes lie in the ellipse, none has a negative area, and their areas sum to πab."""

    def examine(problem: Problem) -> None:
        contact = model.solve_ellipse(problem)
        assert (contact.area >= 0).all(), f"an area is negative: {contact.area.min()!r}"
        assert (contact.strip_width >= 0).all(), f"a strip's width is negative: {contact.strip_width.min()!r}"
        inside = (contact.x / problem.a) ** 2 + (contact.y / problem.b) ** 2 <= 1.0 + SAME
        assert inside.all(), (
            f"a node lies outside the ellipse, at x, y = {contact.x[~inside]!r}, {contact.y[~inside]!r}"
        )
        assert_close(contact.patch_area, problem.patch_area, "the sum of the areas", error_of_sums(model))

    for_each(ELLIPTIC_PROBLEMS, examine)


def pressure_on_the_ellipse_sums_to_the_load(model: ContactModel) -> None:
    """On an ellipse the pressure is never negative, and pressure times area sums to the normal force."""

    def examine(problem: Problem) -> None:
        contact = model.solve_ellipse(problem)
        assert (contact.pressure >= 0).all(), f"a pressure is negative: {contact.pressure.min()!r}"
        load = contact.sum_over_nodes(contact.pressure * contact.area)
        assert_close(load, problem.normal_force, "the sum of the pressures", error_of_sums(model))

    for_each(ELLIPTIC_PROBLEMS, examine)


def traction_vectors_sum_to_the_forces(model: ContactModel) -> None:
    """Traction times area sums to Fx and Fy, and on cells -(x qy + y qx) to the spin moment."""

    def examine(problem: Problem) -> None:
        contact = model.solve_ellipse(problem)
        due, sums = forces_of(contact), sums_of(contact)
        if model.scale == "patch":  # the means of a patch have no moment
            sums = dataclasses.replace(sums, spin_moment=due.spin_moment)
        assert_same_forces(problem, sums, due, "that the tractions sum to", error_of_sums(model))

    for_each(ELLIPTIC_PROBLEMS, examine)


def magnitudes_are_those_of_the_vectors(model: ContactModel) -> None:
    """Traction, tangential force, and slip on cells are the magnitudes of their components."""

    def examine(problem: Problem) -> None:
        contact = model.solve_ellipse(problem)
        for name, components in MAGNITUDES.items():
            if (name, model.scale) == ("slip", "patch"):  # a mean of slips in many directions
                continue
            due = np.hypot(*(getattr(contact, component) for component in components))
            assert_close(getattr(contact, name), due, f"the magnitude of the {name.replace('_', ' ')}")

    for_each(ELLIPTIC_PROBLEMS, examine)


MAGNITUDES = {
    "traction": ("traction_x", "traction_y"),
    "slip": ("slip_x", "slip_y"),
    "tangential_force": ("force_x", "force_y"),
}
"""What is a magnitude, and of which components."""


def no_node_gains_energy(model: ContactModel) -> None:
    """Traction times slip is negative at no node of an ellipse."""

    def examine(problem: Problem) -> None:
        contact = model.solve_ellipse(problem)
        gains = contact.wear_index_density < -4.0 * EPS * contact.traction * contact.slip
        where = contact.x[gains] / problem.a, contact.y[gains] / problem.b
        cosine = contact.wear_index_density[gains] / (contact.traction * contact.slip)[gains]
        assert not gains.any(), f"traction and slip are at angles of cosines {cosine!r} at x/a, y/b = {where!r}"

    for_each(ELLIPTIC_PROBLEMS, examine)


def batch_of_ellipses_equals_loop(model: ContactModel) -> None:
    """All operating points on ellipses at once give what one at a time gives."""
    problem = random_ellipses(8)
    # No slip, some and full slip in one batch: the points that a batch must keep apart.
    factors = np.array([0.0, 1.0, 1e3])[:, None]
    batch = problem.broadcast_to((3, 8)).with_creepages(*Creepages.of(problem).times(factors))
    together = model.solve_ellipse(batch)
    for index in np.ndindex(batch.batch_shape):
        part, message = batch[index], f"at operating point {index} of a batch"
        alone = model.solve_ellipse(part)
        found = CreepForces(
            longitudinal=together.force_x[index], lateral=together.force_y[index], spin_moment=together.moment_z[index]
        )
        assert_same_forces(part, found, forces_of(alone), message)
        for name in ("patch_area", "mean_slip"):
            assert_close(getattr(together, name)[index], getattr(alone, name), f"the {name} {message}", SUM)


def elliptic_problem_is_not_changed(model: ContactModel) -> None:
    """The model leaves the arrays of an elliptic problem as they are."""
    problem = random_ellipses(8)
    before = copy.deepcopy(problem)
    model.solve_ellipse(problem)
    model.creep_forces(problem)
    assert_unchanged(problem, before)


def elliptic_solutions_agree_to_the_bit(model: ContactModel) -> None:
    """The same elliptic problem gives the same contact again, with another problem in between."""

    def examine(problems: tuple[Problem, Problem]) -> None:
        assert_solved_alike(model, *problems)

    for_each(TWO_ELLIPTIC_PROBLEMS, examine)


def elliptic_solution_is_in_double_precision(model: ContactModel) -> None:
    """On an ellipse all is float64, and the force exact to rounding, in steps of 1e-8 of creepage, friction and a."""
    problem = random_ellipses(64)
    assert_double(model.solve_ellipse(problem))
    # An iteration that ends at 1e-10 moves a change of 1e-8 by a fiftieth; single precision, by six of it.
    rounding = min(error_of_sums(model), 1e-10)
    for name in ("longitudinal_creepage", "friction_coefficient", "a"):
        lost_digits(partial(_force_with, model, problem, name), f"the force loses digits of {name}", rounding)


def _force_with(model: ContactModel, problem: Problem, name: str, factor: float) -> Array:
    return model.creep_forces(problem.replaced(**{name: getattr(problem, name) * factor})).tangential


def wear_laws_run_on_the_ellipse(model: ContactModel) -> None:
    """A wheel on a rail wears by the mean of the law's rate over the nodes, one rate for each of them."""
    conditions: WheelRailConditions = {
        "normal_force": Q(LOADS, "kN"),
        "longitudinal_creepage": "0.3 %",
        "friction_coefficient": 0.4,
    }
    contact = model.solve_ellipse(WHEEL_RAIL.problem(**conditions))
    for variable in NODE_VARIABLES:
        found = getattr(contact, variable).shape
        assert found == contact.pressure.shape, f"{variable} has the shape {found}, not {contact.pressure.shape}"
    law = Ramps()
    due = contact.mean(law.rate(contact, law.numbers))
    found = (WHEEL_RAIL | model).with_law(law)(**conditions).wear_rate.m_as("kg/m/m^2")
    assert (due > 0).all(), f"the wear rates are {due!r}"
    assert_close(found, due, "the wear rate of a pipeline", SUM)


LOADS = np.array([[60.0, 80.0, 100.0], [50.0, 70.0, 90.0]])
"""Loads [kN], of two axes."""

CHECKS = (
    elliptic_contact_has_the_shape_of_the_problem,
    elliptic_contact_is_finite,
    elliptic_contact_carries_the_conditions,
    nodes_cover_the_ellipse,
    pressure_on_the_ellipse_sums_to_the_load,
    traction_vectors_sum_to_the_forces,
    magnitudes_are_those_of_the_vectors,
    no_node_gains_energy,
    batch_of_ellipses_equals_loop,
    elliptic_problem_is_not_changed,
    elliptic_solutions_agree_to_the_bit,
    elliptic_solution_is_in_double_precision,
    wear_laws_run_on_the_ellipse,
)
