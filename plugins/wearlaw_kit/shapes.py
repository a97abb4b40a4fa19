"""The shapes of a contact patch, as the checks see them: what to draw, what saturates, and how exact a model is.

A check that says the same of several shapes takes the model and a shape, and is registered by `on_shapes`. One that
holds for any batch of problems takes a batch too, and is registered by `on_problems`.

Models with nodes of their own, whose sums are only as exact as their cells, declare that as `accuracy` on a line and as
`elliptic_accuracy` on strips, as a share of what the sums are in full slip, since a slip zone may be shorter than a
cell. The patch means of one node are exact to rounding.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from wearlaw import loader, steel
from wearlaw.arrays import Array
from wearlaw.contact.contact import Contact
from wearlaw.contact.parts import Body, CreepForces
from wearlaw.contact.problem import Geometry, Problem
from wearlaw.contact.quadrature import join
from wearlaw.models.contact_model import QUADRATURE, ContactModel, LineContactModel, Stage
from wearlaw.numerics.staged import staged
from wearlaw_kit.examples import SAME, assert_close, bounded, failing, for_each, leeway, left_out, part
from wearlaw_kit.reduced import (
    friction_limit,
    in_strips,
    lever,
    random_ellipses,
    random_lines,
    under_conditions,
    wide_ellipses,
    without_spin,
)
from wearlaw_kit.rules import Applies, rule

PANELS = 64
"""Panels of a zone: on 48 lines, every part of the patch that is longer than a thousandth of it has nodes."""

WORDS = {"longitudinal": "Fx", "lateral": "Fy", "spin_moment": "Mz"}
"""What messages call the forces of `CreepForces`."""


@dataclass(frozen=True, eq=False)
class Shape:
    """A shape of patch.

    Attributes
    ----------
    where : str
        How messages begin.
    uncut : callable
        Returns a number of problems, from partial to full slip, before `cut`.
    wide : Problem
        Many operating points, from nearly full stick to full slip, before `cut`.
    cut : callable
        Returns the problem of the shape: a patch of strips is cut from an ellipse.
    """

    geometry: Geometry
    where: str
    uncut: Callable[[int], Problem]
    wide: Problem
    cut: Callable[[Problem], Problem] = lambda problem: problem

    def draw(self, points: int) -> Problem:
        """Return a number of problems, from partial to full slip."""
        return under_conditions(self.cut(self.uncut(points)))

    def without_spin(self) -> Shape:
        """Return the shape of problems without spin."""
        return replace(self, cut=lambda problem: without_spin(self.cut(problem)))

    @property
    def problems(self) -> Problem:
        """Many operating points, from nearly full stick to full slip."""
        return under_conditions(self._cut)

    @cached_property
    def _cut(self) -> Problem:
        return self.cut(self.wide)


LINE = Shape("line", "on a line: ", random_lines, random_lines(48))
"""Discs with parallel axes: one axis of nodes, one creepage."""

ELLIPSE = Shape("ellipse", "on an ellipse: ", random_ellipses, wide_ellipses(32))
"""A wheel on a rail: nodes on strips, two creepages and a spin."""

PATCH = replace(ELLIPSE, geometry="strips", where="on strips: ", cut=in_strips)
"""A patch of strips with a given pressure, fuller on one side than an ellipse and shorter on the other."""

SHAPES = (LINE, ELLIPSE, PATCH)


def forces_alone(model: ContactModel, problem: Problem) -> CreepForces:
    """Return what `tangential_force` or `creep_forces` gives, for less than the contact."""
    if problem.geometry == "line":
        return CreepForces.of_line(model.tangential_force(problem))
    return model.creep_forces(problem)


def error_of_sums(model: ContactModel, problem: Problem) -> float:
    """Return the accuracy that the model declares, or rounding if one node holds the means of an ellipse.

    An exemption may allow more.
    """
    if problem.geometry == "line":
        return max(model.accuracy, leeway())
    return max(SAME if model.scale == "patch" else model.elliptic_accuracy, leeway())


def error_of_force(model: ContactModel, problem: Problem) -> float:
    """Return the error of a force that is a sum over nodes; one in closed form is exact to rounding."""
    error = error_of_sums(model, problem)
    return SAME if error == QUADRATURE else error


def error_of_traction(model: ContactModel, problem: Problem) -> float:
    """Return rounding, or the error of the force of which the traction is the mean."""
    return error_of_force(model, problem) if model.scale == "patch" else max(SAME, leeway())


def solutions(model: ContactModel, problem: Problem) -> list[Contact]:
    """Return the contact on the model's own nodes and, where its fields are known anywhere, on many panels of nodes."""
    contacts = [model.solve(problem)]
    if problem.geometry == "line" and isinstance(model, LineContactModel):
        stick, slip = (zone.nodes(panels=PANELS) for zone in model.zones(problem))
        contacts.append(model.at(problem, join(stick.reversed(), slip)))
    return contacts


def forces_as(forces: CreepForces, function: Callable[[Array], Array]) -> CreepForces:
    """Return the forces and the moment after a function of each."""
    return CreepForces(**{name: function(getattr(forces, name)) for name in WORDS})


def sizes(problem: Problem, forces: CreepForces) -> dict[str, Array]:
    """Return μN, or the force where it is larger, and for the moment that times its lever."""
    size = np.maximum(friction_limit(problem), forces.tangential)
    moment = np.maximum(size * lever(problem), np.abs(forces.spin_moment))
    return {"longitudinal": size, "lateral": size, "spin_moment": moment}


def assert_same_forces(problem: Problem, actual: CreepForces, due: CreepForces, message: str, error: float) -> None:
    """Assert that forces and moment agree to a share of their sizes."""
    for name, size in sizes(problem, due).items():
        if not left_out(name):
            with part(name):
                allowed = max(error, leeway()) * size
                assert_close(getattr(actual, name), getattr(due, name), f"{WORDS[name]} {message}", 0.0, allowed)


def of_model(model: ContactModel, points: int) -> list[tuple[ContactModel, Problem]]:
    """Return a model with random problems of each shape that it solves."""
    return [(model, shape.draw(points)) for shape in SHAPES if shape.geometry in model.geometries()]


INSIDE: dict[Geometry, str] = {"line": "exact", "ellipse": "fastsim", "strips": "fastsim"}
"""The contact model inside a stage, by the shape of the patch."""


def of_stage(stage: Stage, points: int) -> list[tuple[ContactModel, Problem]]:
    """Return a stage around contact models of wearlaw, each with random problems of a shape that the model solves."""
    inside = {shape: loader.contact_model(INSIDE[shape.geometry]) for shape in SHAPES}
    return [(staged(inside[shape], (stage,)), with_bodies(shape.draw(points))) for shape in kept_shapes()]


def kept_shapes() -> list[Shape]:
    """Return the shapes from which the model is not exempt."""
    return [shape for shape in SHAPES if not left_out(shape.geometry)]


def with_bodies(problem: Problem) -> Problem:
    """Return the problem with two bodies, an inclined surface and conditions, as that of a rig."""
    share = np.linspace(0.1, 1.0, problem.size)
    bodies = {"body_1": Body(steel(), 0.25 * share), "body_2": Body(steel(density="7200 kg/m^3"), np.inf)}
    problem = under_conditions(problem.replaced(bodies=bodies, contact_angle=share))
    return problem.replaced(conditions={"rolled_distance": 1e3 * share, **problem.conditions})


def on_shapes(
    *shapes: Shape, claims: tuple[str, ...] = (), applies: Applies = lambda _: True, **options: bool
) -> Callable[[Callable[[ContactModel, Shape], None]], Callable[[ContactModel], None]]:
    """Return a decorator that registers a check of a model on a shape, on those of these which the model solves.

    Its messages begin with the shape. The options are those of `rule`.
    """

    def decorate(check: Callable[[ContactModel, Shape], None]) -> Callable[[ContactModel], None]:
        def solved(model: ContactModel) -> list[Shape]:
            return [shape for shape in shapes if shape.geometry in model.geometries()]

        @functools.wraps(check)
        def on_all(model: ContactModel) -> None:
            for shape in solved(model):
                if left_out(shape.geometry):
                    continue
                with part(shape.geometry), failing(shape.where):
                    if shape is not LINE and (left_out("spin") or bounded("spin")):
                        check(model, shape.without_spin())
                    if shape is LINE or not left_out("spin"):
                        with part("spin"):
                            check(model, shape)

        def applicable(model: ContactModel) -> bool:
            return bool(solved(model)) and applies(model)

        return rule(ContactModel, *claims, applies=applicable, **options)(on_all)

    return decorate


def on_problems(
    *shapes: Shape, **options: Any
) -> Callable[[Callable[[ContactModel, Problem], None]], Callable[[ContactModel], None]]:
    """Return a decorator that registers a check on the `problems` of those of these shapes which the model solves."""

    def decorate(check: Callable[[ContactModel, Problem], None]) -> Callable[[ContactModel], None]:
        @functools.wraps(check)
        def on_shape(model: ContactModel, shape: Shape) -> None:
            for_each(shape.problems, functools.partial(check, model))

        return on_shapes(*shapes, **options)(on_shape)

    return decorate
