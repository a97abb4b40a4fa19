"""Checks of the nodes of a contact: where they lie, what they stand for, and the pressure and the bound there."""

from __future__ import annotations

import numpy as np

from wearlaw.arrays.array import Array
from wearlaw.contact import hertz, hertz_ellipse
from wearlaw.contact.contact import Contact
from wearlaw.contact.problem import Problem
from wearlaw.models.contact_model import ContactModel
from wearlaw_kit.examples import SAME, assert_close, for_each
from wearlaw_kit.reduced import friction_limit, without_spin
from wearlaw_kit.shapes import LINE, Claims, Shape, on_each_shape, on_patches_of_strips, on_problems_of_each_shape

POINTS = 32
"""Number of patches checked at once."""


@on_each_shape
def declared_accuracy_is_not_coarse(model: ContactModel, shape: Shape) -> None:
    """The declared error of sums over nodes is 5 % on a line at most, and 10 % on an ellipse or on strips.

    A line of a hundred cells has that error, and an ellipse of ten strips. Mistakes of its size pass the checks.
    """
    name, highest = ("accuracy", 0.05) if shape is LINE else ("elliptic_accuracy", 0.1)
    found = 0.0 if model.scale == "patch" else getattr(model, name)
    assert found <= highest, (
        f"the declared `{name}` is {found:g}, more than {highest:g}: use more nodes, or give a reason in `exemptions`"
    )


@on_problems_of_each_shape
def nodes_cover_the_patch(model: ContactModel, shape: Shape, problem: Problem) -> None:
    """Nodes with an area lie in the patch, none has a negative area, and the areas sum to the area of the patch.

    Nodes outside the patch, such as those of a rectangular grid, have no area.
    """
    contact = model.solve(problem)
    assert (contact.area >= 0).all(), f"an area is negative: {contact.area.min()!r}"
    assert (contact.strip_width >= 0).all(), f"a strip's width is negative: {contact.strip_width.min()!r}"
    outside = ~shape.inside(problem, contact) & (contact.area > 0)
    assert not outside.any(), f"a node lies outside the patch, at x, y = {contact.x[outside]!r}, {contact.y[outside]!r}"
    assert_close(contact.patch_area, problem.patch_area, "the sum of the areas", shape.error_of_areas(model))


@on_each_shape
def nodes_lie_where_their_areas_do(model: ContactModel, shape: Shape) -> None:
    """The sums of x, y, x² and y² over the areas are the integrals over the patch; the means of a patch have none."""
    if model.scale == "patch":
        return

    def examine(problem: Problem) -> None:
        contact, error = model.solve(problem), shape.error_of_sums(model)
        for name, half, (first, second) in _moments(problem):
            at, size = getattr(contact, name), problem.patch_area * half
            assert_close(contact.integral(at), first, f"∫ {name} dA", 0.0, error * size)
            assert_close(contact.integral(at, at), second, f"∫ {name}² dA", 0.0, error * size * half)

    for_each(shape.problems, examine)


def _moments(problem: Problem) -> list[tuple[str, Array, tuple[Array, Array]]]:
    """Return x and y, half the extent of the patch along each, and the integrals of both and of their squares."""
    a, b, area, strips = problem.a, problem.b, problem.patch_area, problem.strips
    none = np.zeros_like(area)
    if problem.geometry == "line":
        return [("x", a, (none, area * a**2 / 3.0))]
    if strips is None:
        return [("x", a, (none, area * a**2 / 4.0)), ("y", b, (none, area * b**2 / 4.0))]
    along = (strips.area * strips.half_length**2).sum(axis=-1) / 3.0
    across = (strips.area * strips.y).sum(axis=-1), (strips.area * strips.y**2).sum(axis=-1)
    return [("x", strips.half_length.max(axis=-1), (none, along)), ("y", b, across)]


@on_patches_of_strips
def strips_have_their_widths(model: ContactModel, shape: Shape) -> None:
    """Strips with an area lie side by side across the patch, and each has the area of its width times its length.

    Strips of a problem keep their width. On an ellipse, a strip may be longer or shorter by a cell, and the patch wider
    or narrower by a strip.
    """
    if model.scale == "patch":
        return
    error = shape.error_of_sums(model)

    def examine(problem: Problem) -> None:
        contact, strips, a, b = model.solve(problem), problem.strips, problem.a[..., None], problem.b[..., None]
        y, area = contact.y[..., 0, :], contact.area.sum(axis=-2)
        there = area > 0.0
        width = np.where(there, contact.strip_width, 0.0)
        length, cell = (
            np.divide(part, width, out=np.zeros_like(area), where=width > 0.0)
            for part in (area, contact.area.max(axis=-2))
        )
        if strips is not None:
            assert_close(width, strips.width, "the width of a strip")
            assert_close(length, 2.0 * strips.half_length, "the area of a strip over its width", error)
            return
        assert_close(width.sum(axis=-1), 2.0 * problem.b, "the sum of the widths of strips", error, width.max(axis=-1))
        chord = np.where(there, 2.0 * a * np.sqrt(np.maximum(1.0 - (y / b) ** 2, 0.0)), 0.0)
        assert_close(length, chord, "the area of a strip over its width", 0.0, error * 2.0 * a + cell)
        order = np.argsort(y, axis=-1)
        y, width, there = (np.take_along_axis(array, order, axis=-1) for array in (y, width, there))
        middle = np.where(there, width.cumsum(axis=-1) - 0.5 * width - b, y)
        assert_close(
            y, middle, "the position of a strip between the widths of the others", 0.0, 0.5 * width + error * b
        )

    for_each(shape.problems, examine)


@on_problems_of_each_shape
def pressure_sums_to_the_load(model: ContactModel, shape: Shape, problem: Problem) -> None:
    """The pressure is never negative, and pressure times area sums to the normal force."""
    contact = model.solve(problem)
    assert (contact.pressure >= 0).all(), f"a pressure is negative: {contact.pressure.min()!r}"
    load = contact.sum_over_nodes(contact.pressure * contact.area)
    assert_close(load, problem.normal_force, "the sum of the pressures", shape.error_of_sums(model))


@on_each_shape
def pressure_is_that_of_the_problem(model: ContactModel, shape: Shape) -> None:
    """At each node the pressure is Hertz's at its x and y, or that of its strip; the means of a patch have none."""
    if model.scale == "patch":
        return

    def examine(problem: Problem) -> None:
        for contact in shape.solutions(model, problem):
            due, highest = _pressure(problem, contact), contact.per_node(problem.max_pressure)
            # Squares, since next to an edge the pressure is the root of a rounded distance.
            assert_close((contact.pressure / highest) ** 2, (due / highest) ** 2, "(p/p0)² at a node", 0.0, SAME)

    for_each(shape.problems, examine)


def _pressure(problem: Problem, contact: Contact) -> Array:
    """Return the pressure that the problem has at the nodes [Pa]."""
    a, b, p0 = (contact.per_node(value) for value in (problem.a, problem.b, problem.max_pressure))
    if problem.geometry == "line":
        return hertz.pressure(contact.x, a, p0)
    if problem.strips is None:
        return hertz_ellipse.pressure(contact.x, contact.y, a, b, p0)
    half_length, highest = (value[..., None, :] for value in (problem.strips.half_length, problem.strips.max_pressure))
    return hertz.pressure(contact.x, half_length, highest)


@on_each_shape
def bound_sums_to_friction(model: ContactModel, shape: Shape) -> None:
    """The traction bound, where it sticks and where it slips, sums to μN."""

    def examine(problem: Problem) -> None:
        contact = model.solve(problem)
        bound = np.where(contact.area > 0.0, contact.traction_bound, 0.0)
        found = contact.integral(bound)
        assert_close(found, friction_limit(problem), "the sum of the traction bound", shape.error_of_sums(model))

    examine(shape.random(POINTS))  # most of which stick somewhere; of the drawn ones few may
    for_each(shape.problems, examine)


@on_each_shape
def stick_lies_before_slip(model: ContactModel, shape: Shape) -> None:
    """Without spin, no node of a strip sticks behind one that slips: the patch sticks from its leading edge, x = -a."""

    def examine(problem: Problem) -> None:
        for contact in shape.solutions(model, without_spin(problem)):
            along = -1 if shape is LINE else -2
            slips, there = contact.slip != 0.0, contact.area > 0.0
            first = np.where(slips & there, contact.x, np.inf).min(axis=along, keepdims=True)
            behind = ~slips & there & (contact.x > first)
            assert not behind.any(), (
                f"a node sticks at x = {contact.x[behind]!r} m, behind one of its strip that slips, at"
                f" {np.broadcast_to(first, behind.shape)[behind]!r} m"
            )

    for_each(shape.problems, examine)
    examine(shape.random(POINTS))


CHECKS = (nodes_cover_the_patch, nodes_lie_where_their_areas_do, strips_have_their_widths, pressure_sums_to_the_load)

CLAIMS: Claims = {
    "accuracy": (declared_accuracy_is_not_coarse,),
    "pressure": (pressure_is_that_of_the_problem,),
    "friction": (bound_sums_to_friction,),
    "leading_edge": (stick_lies_before_slip,),
}
