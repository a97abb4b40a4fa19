"""Checks of a contact model that hold for every theory."""

from __future__ import annotations

import dataclasses
from functools import partial
from typing import Any

import numpy as np

from wearlaw.arrays.array import Array
from wearlaw.contact.contact import TOTALS, Contact
from wearlaw.contact.problem import CreepForces, Problem
from wearlaw.models.contact_model import ContactModel
from wearlaw_kit.bisection import lost_digits
from wearlaw_kit.examples import SUM, assert_close, for_each
from wearlaw_kit.reduced import with_creepage
from wearlaw_kit.sampling import EPS, arrays_of
from wearlaw_kit.shapes import (
    ELLIPSE,
    LINE,
    WORDS,
    Claims,
    Shape,
    assert_same_forces,
    assert_same_power,
    on_each_shape,
    on_problems,
    on_problems_of_each_shape,
)

FIELDS = (
    "pressure", "traction", "slip", "traction_bound", "area", "x", "y", "traction_x", "traction_y", "slip_x", "slip_y",
)  # fmt: skip


def sums_of(contact: Contact) -> CreepForces:
    """Return the forces and the moment that the tractions at the nodes sum to."""
    qx, qy = contact.traction_x * contact.area, contact.traction_y * contact.area
    return CreepForces(
        longitudinal=contact.sum_over_nodes(qx),
        lateral=contact.sum_over_nodes(qy),
        spin_moment=-contact.sum_over_nodes(contact.x * qy + contact.y * qx),
    )


@on_each_shape
def contact_has_the_shape_of_the_problem(model: ContactModel, shape: Shape) -> None:
    """Totals have the batch shape, fields one more axis, on an ellipse two, of nodes and strips."""
    for point in range(8):  # a wrong shape may depend on the creepage
        _assert_shape(model, shape, shape.problems[point])


def _assert_shape(model: ContactModel, shape: Shape, problem: Problem) -> None:
    for batch in ((), (1,), (2, 3)):
        # As from conditions that broadcast: arrays without strides, which cannot be written to.
        contact: Any = model.solve(problem.broadcast_to(batch))
        if not isinstance(contact, Contact):
            raise AssertionError(f"the model returned {contact!r}, not a wearlaw.Contact")
        arrays: dict[str, tuple[int, ...]] = {
            name: np.shape(getattr(contact, name)) for name in (*TOTALS, *FIELDS, "strip_width")
        }
        of_batch = f"for a batch of shape {batch}"
        for name in TOTALS:
            if arrays[name] != batch:
                raise AssertionError(f"{name} has the shape {arrays[name]} {of_batch}")
        nodes = arrays["pressure"][len(batch) :]
        if len(nodes) != shape.node_axes:
            raise AssertionError(f"pressure has the shape {arrays['pressure']} {of_batch}")
        for name in FIELDS:
            if arrays[name] != (*batch, *nodes):
                raise AssertionError(f"{name} has the shape {arrays[name]}, not {(*batch, *nodes)}")
        strips = (*batch, *(nodes[1:] or (0,)))
        if arrays["strip_width"] != strips:
            raise AssertionError(f"strip_width has the shape {arrays['strip_width']}, not {strips}")


@on_problems_of_each_shape
def contact_is_finite(model: ContactModel, shape: Shape, problem: Problem) -> None:  # noqa: ARG001
    """Every field and total is a finite number; the traction bound may be infinite."""
    for name, value in arrays_of(model.solve(problem)).items():
        bad = np.isnan(value).any() or (name != "traction_bound" and np.isinf(value).any())
        assert not bad, f"{name} is not finite: {value!r}"


@on_problems_of_each_shape
def contact_carries_the_conditions(model: ContactModel, shape: Shape, problem: Problem) -> None:  # noqa: ARG001
    """The contact keeps the problem, with its rolling speed, density and normal force."""
    contact = model.solve(problem)
    for name in ("rolling_speed", "density", "normal_force"):
        assert_close(getattr(contact, name), getattr(problem, name), f"the {name} of the contact")
    if contact.problem is not None:
        for name in _differing(contact.problem, problem):
            raise AssertionError(f"the contact's problem has another {name}")


def _differing(problem: Problem, other: Problem) -> list[str]:
    """Return the fields in which two problems differ."""
    return [name for name, value in _values(problem).items() if not np.array_equal(value, _values(other)[name])]


def _values(problem: Problem) -> dict[str, Any]:
    """Return the fields of a problem, and of its strips if it has any."""
    records: list[Any] = [problem] if problem.strips is None else [problem, problem.strips]
    fields = [(record, field.name) for record in records for field in dataclasses.fields(record)]
    return {name: getattr(record, name) for record, name in fields if name != "strips"}


@on_each_shape
def tractions_sum_to_the_forces(model: ContactModel, shape: Shape) -> None:
    """Traction times area sums to Fx and Fy, and on the cells of an ellipse -(x qy + y qx) to the spin moment."""
    error = shape.error_of_sums(model)

    def examine(problem: Problem) -> None:
        contact = model.solve(problem)
        due, sums = contact.forces, sums_of(contact)
        sizes = shape.sizes_of_sums(problem, due)
        if model.scale == "patch":  # the means of a patch have no moment
            sizes.pop("spin_moment", None)
        for name, size in sizes.items():
            message = f"{WORDS[name]} that the tractions sum to"
            assert_close(getattr(sums, name), getattr(due, name), message, 0.0, error * size)

    for_each(shape.problems, examine)


@on_problems(LINE)
def traction_and_slip_follow_the_creepage(model: ContactModel, shape: Shape, problem: Problem) -> None:
    """On a line traction and slip have the sign of the creepage or are zero."""
    for sign in (-1.0, 1.0):
        for contact in shape.solutions(model, with_creepage(problem, sign * problem.creepage)):
            # The slip of full slip is a difference that vanishes at the leading edge, to rounding of the creepage.
            allowed = 4.0 * EPS * contact.per_node(problem.creepage)
            assert (sign * contact.slip >= -allowed).all(), f"slip against the creepage: {contact.slip!r}"
            assert (sign * contact.traction >= 0).all(), f"traction against the creepage: {contact.traction!r}"


@on_problems_of_each_shape
def no_node_gains_energy(model: ContactModel, shape: Shape, problem: Problem) -> None:
    """Traction times slip is negative at no node."""
    for contact in shape.solutions(model, problem):
        traction, slip = np.abs(contact.traction), np.abs(contact.slip)
        # The slip of a line is rounded as its creepage is, the product of vectors as that of their magnitudes.
        scale = np.maximum(slip, np.abs(contact.per_node(problem.creepage))) if shape is LINE else slip
        gains = contact.wear_index_density < -4.0 * EPS * traction * scale
        where = contact.x[gains], contact.y[gains]
        cosine = contact.wear_index_density[gains] / (traction * slip)[gains]
        assert not gains.any(), f"traction and slip are at angles of cosines {cosine!r} at x, y = {where!r} m"


@on_problems(ELLIPSE)
def magnitudes_are_those_of_the_vectors(model: ContactModel, shape: Shape, problem: Problem) -> None:  # noqa: ARG001
    """On an ellipse traction, tangential force, and slip on cells are the magnitudes of their components."""
    contact = model.solve(problem)
    for name, components in MAGNITUDES.items():
        if (name, model.scale) == ("slip", "patch"):  # a mean of slips in many directions
            continue
        due = np.hypot(*(getattr(contact, component) for component in components))
        assert_close(getattr(contact, name), due, f"the magnitude of the {name.replace('_', ' ')}")


MAGNITUDES = {
    "traction": ("traction_x", "traction_y"),
    "slip": ("slip_x", "slip_y"),
    "tangential_force": ("force_x", "force_y"),
}
"""What is a magnitude, and of which components."""


@on_each_shape
def batch_equals_loop(model: ContactModel, shape: Shape) -> None:
    """All operating points at once give the same as one at a time."""
    together = model.solve(shape.batch)
    for index in np.ndindex(shape.batch.batch_shape):
        part, found, message = shape.batch[index], together[index], f"at operating point {index} of a batch"
        alone = model.solve(part)
        # A batch may hold zones without length, which change the order of a sum.
        assert_same_forces(shape, part, found.forces, alone.forces, message, SUM)
        assert_same_power(shape, part, found, alone, message, SUM)
        for name in ("patch_area", "mean_slip"):
            assert_close(getattr(found, name), getattr(alone, name), f"the {name} {message}", SUM)


@on_each_shape
def solution_is_in_double_precision(model: ContactModel, shape: Shape) -> None:
    """All is float64, and the force exact to rounding, in steps of 1e-8 of creepage, friction and half-length."""
    problem = shape.random(64)
    for name, value in arrays_of(model.solve(problem)).items():
        assert value.dtype == np.float64, f"{name} is of type {value.dtype}, not float64"
    # An iteration that ends at 1e-10 moves a change of 1e-8 by a fiftieth; single precision, by six of it.
    rounding = min(shape.error_of_force(model), 1e-10)
    for name in ("longitudinal_creepage", "friction_coefficient", "a"):
        force = partial(force_with, model, shape, problem, name)
        lost_digits(force, f"the tangential force loses digits of {name}", rounding)


def force_with(model: ContactModel, shape: Shape, problem: Problem, name: str, factor: float) -> Array:
    """Return the tangential force with a number of the problem multiplied by a factor."""
    changed = (
        shape.longer(problem, factor) if name == "a" else problem.replaced(**{name: getattr(problem, name) * factor})
    )
    return shape.forces(model, changed).tangential


CHECKS = (
    contact_has_the_shape_of_the_problem,
    contact_is_finite,
    contact_carries_the_conditions,
    tractions_sum_to_the_forces,
    magnitudes_are_those_of_the_vectors,
    no_node_gains_energy,
    batch_equals_loop,
    solution_is_in_double_precision,
)

CLAIMS: Claims = {"direction": (traction_and_slip_follow_the_creepage,)}
