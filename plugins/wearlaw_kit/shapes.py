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
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from wearlaw import loader
from wearlaw.arrays import Array
from wearlaw.contact.contact import Contact
from wearlaw.contact.problem import CreepForces, Geometry, Problem
from wearlaw.contact.quadrature import join
from wearlaw.models.contact_model import QUADRATURE, ContactModel, LineContactModel, Stage
from wearlaw.numerics.staged import staged
from wearlaw_kit.examples import SAME, assert_close, failing, for_each
from wearlaw_kit.reduced import (
    creeping,
    friction_limit,
    in_strips,
    lever,
    parts_of_power,
    random_ellipses,
    random_lines,
    saturation,
    sliding_power,
    wide_ellipses,
    with_creepage,
)
from wearlaw_kit.rules import Applies, any_model, rule

MANY = 512
"""Lines to average an error over."""

PATCHES = 8
"""Ellipses to average an error over."""

PANELS = 64
"""Panels of a zone: on 48 lines, every part of the patch that is longer than a thousandth of it has nodes."""

WORDS = {"longitudinal": "Fx", "lateral": "Fy", "spin_moment": "Mz"}
"""What messages call the forces of `CreepForces`."""


class Path(NamedTuple):
    """Problems at reduced creepages that grow from `low` to `high`, through full slip, to look for jumps.

    The `intervals` are so small that a curved force changes by less than 1/1000 more in one half of them than in the
    other: Carter's, with its curvature of 2 at full slip, by 2 (3 ln 10/512/2)² = 1e-4, and that of an ellipse, whose
    logarithmic slope changes by up to 2 per e-fold, by 2 (ln 10/64/2)² = 6e-4.
    """

    problem: Problem
    low: float
    high: float
    intervals: int


@dataclass(frozen=True, eq=False)
class Shape:
    """A shape of patch.

    Attributes
    ----------
    where : str
        How messages begin.
    draw : callable
        Returns a number of problems, from partial to full slip.
    problems : Problem
        Many operating points, from nearly full stick to full slip.
    similar : Problem
        As many, each with the same forces over μN as that of `problems`.
    batch : Problem
        Points with and without slip, and in full slip, that a batch must keep apart.
    path : Path
        Where to look for jumps.
    to_refine : list of Problem
        Batches to average an error over; patches one at a time, since the nodes may be many.
    directions : ndarray, (2, n)
        Directions of reduced creepages ξ and η.
    """

    geometry: Geometry
    where: str
    draw: Callable[[int], Problem]
    problems: Problem
    similar: Problem
    batch: Problem
    path: Path
    to_refine: list[Problem]
    directions: Array


def _at_factors(problem: Problem, factors: list[list[float]]) -> Problem:
    """Return the problem at its creepages times factors, to which its batch broadcasts."""
    shape = np.broadcast_shapes(problem.batch_shape, np.shape(factors))
    return creeping(problem.broadcast_to(shape), np.array(factors))


def _scaled(problem: Problem) -> Problem:
    """Return similar problems of other lengths, moduli, frictions, creepages and speeds."""
    random, shape = np.random.default_rng(8), problem.batch_shape
    length, modulus, friction, speed = 10.0 ** random.uniform(-1.0, 1.0, (4, *shape))
    creepage = 10.0 ** random.uniform(-1.0, 0.0, shape)  # it may not grow above 1
    pressure = creepage * modulus / friction
    other = problem.replaced(
        a=length * problem.a,
        b=length * problem.b,
        effective_modulus=modulus * problem.effective_modulus,
        max_pressure=pressure * problem.max_pressure,
        friction_coefficient=friction * problem.friction_coefficient,
        normal_force=pressure * length**2 * problem.normal_force,
        rolling_speed=speed * problem.rolling_speed,
    )
    return creeping(other, creepage, creepage, creepage / length)


_lines, _ellipses = random_lines(48), wide_ellipses(32)

LINE = Shape(
    geometry="line",
    where="on a line: ",
    draw=random_lines,
    problems=_lines,
    similar=_scaled(_lines),
    batch=_at_factors(_lines[::6, None, None], [[1.0, 0.0, -1.0], [1e-3, 1e3, 1.0 + 1e-9]]),
    path=Path(random_lines(2), 1e-2, 10.0, 512),
    # Nearer to zero, the slip zone is shorter than a cell.
    to_refine=[with_creepage(random_lines(MANY), np.linspace(0.1, 1.2, MANY) * saturation(random_lines(MANY)))],
    directions=np.array([[1.0], [0.0]]),
)
"""Discs with parallel axes: one axis of nodes, one creepage."""

ELLIPSE = Shape(
    geometry="ellipse",
    where="on an ellipse: ",
    draw=random_ellipses,
    problems=_ellipses,
    similar=_scaled(_ellipses),
    batch=_at_factors(random_ellipses(8), [[0.0], [1.0], [1e3]]),
    path=Path(random_ellipses(4)[[0, 1, 3]], 0.6, 6.0, 64),
    to_refine=[random_ellipses(PATCHES)[index] for index in range(PATCHES)],
    directions=np.array([[1.0, 1.0, 0.0, -1.0, -1.0, -1.0, 0.0, 1.0], [0.0, 1.0, 1.0, 1.0, 0.0, -1.0, -1.0, -1.0]]),
)
"""A wheel on a rail: nodes on strips, two creepages and a spin."""

PATCH = Shape(
    geometry="strips",
    where="on strips: ",
    draw=lambda points: in_strips(random_ellipses(points)),
    problems=in_strips(ELLIPSE.problems),
    similar=in_strips(ELLIPSE.similar),
    batch=in_strips(ELLIPSE.batch),
    path=ELLIPSE.path._replace(problem=in_strips(ELLIPSE.path.problem)),
    to_refine=[in_strips(problem) for problem in ELLIPSE.to_refine],
    directions=ELLIPSE.directions,
)
"""A patch of strips with a given pressure, fuller on one side than an ellipse and shorter on the other."""

SHAPES = (LINE, ELLIPSE, PATCH)


def forces_alone(model: ContactModel, problem: Problem) -> CreepForces:
    """Return what `tangential_force` or `creep_forces` gives, for less than the contact."""
    if problem.geometry == "line":
        return CreepForces.of_line(model.tangential_force(problem))
    return model.creep_forces(problem)


def error_of_sums(model: ContactModel, problem: Problem) -> float:
    """Return the accuracy that the model declares, or rounding if one node holds the means of an ellipse."""
    if problem.geometry == "line":
        return model.accuracy
    return SAME if model.scale == "patch" else model.elliptic_accuracy


def error_of_force(model: ContactModel, problem: Problem) -> float:
    """Return the error of a force that is a sum over nodes; one in closed form is exact to rounding."""
    error = error_of_sums(model, problem)
    return SAME if error == QUADRATURE else error


def error_of_traction(model: ContactModel, problem: Problem) -> float:
    """Return rounding, or the error of the force of which the traction is the mean."""
    return error_of_force(model, problem) if model.scale == "patch" else SAME


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


def size_of_power(problem: Problem, forces: CreepForces) -> Array:
    """Return the power of full slip, or of the forces where theirs is larger."""
    size: Array = np.maximum(sliding_power(problem), parts_of_power(problem, forces))
    return size


def assert_same_forces(problem: Problem, found: CreepForces, due: CreepForces, message: str, error: float) -> None:
    """Assert that forces and moment agree to a share of their sizes."""
    for name, size in sizes(problem, due).items():
        assert_close(getattr(found, name), getattr(due, name), f"{WORDS[name]} {message}", 0.0, error * size)


def assert_same_power(problem: Problem, found: Contact, due: Contact, message: str, error: float) -> None:
    """Assert that two contacts have the same Tγ, to a share of its size."""
    allowed = error * size_of_power(problem, due.forces)
    assert_close(found.wear_index, due.wear_index, f"the wear index {message}", 0.0, allowed)


def of_stage(stage: Stage, points: int) -> list[tuple[ContactModel, Problem]]:
    """Return a stage around contact models of wearlaw, each with random problems of a shape that the model solves."""
    models = {"line": "exact", "ellipse": "fastsim", "strips": "fastsim"}
    return [(staged(loader.contact_model(models[shape.geometry]), (stage,)), shape.draw(points)) for shape in SHAPES]


def on_shapes(
    *shapes: Shape, claims: tuple[str, ...] = (), applies: Applies = any_model, **options: bool
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
                with failing(shape.where):
                    check(model, shape)

        def known(model: ContactModel) -> bool:
            return bool(solved(model)) and applies(model)

        return rule(ContactModel, *claims, applies=known, **options)(on_all)

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
