"""The shapes of a contact patch, as the checks see them: what to draw, what saturates, and how exact a model is.

A check that says the same of several shapes takes the model and a shape, and is marked `on_each_shape` or
`on_patches_of_strips`. One that holds for any batch of problems takes a batch too, and is marked
`on_problems_of_each_shape` or `on_problems_of_strips`.

Tolerances on a line: a position is exact to the rounding of the half-width a, so an integral over a slip zone is exact
to rounding over the zone's share of the patch. Models with nodes of their own, whose sums are only as exact as their
cells, declare that as `accuracy`. On an ellipse, sums over nodes on strips are as exact as the model declares in
`elliptic_accuracy`, as a share of what they are in full slip; the patch means of one node, to rounding.
"""

from __future__ import annotations

import dataclasses
import functools
from collections.abc import Callable, Iterator, Mapping
from typing import Any, ClassVar, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from wearlaw.arrays.array import Array
from wearlaw.contact.contact import Contact
from wearlaw.contact.problem import CreepForces, Geometry, Problem
from wearlaw.contact.quadrature import uniform_cells
from wearlaw.models.contact_model import QUADRATURE, Claim, ContactModel
from wearlaw.models.line_contact_model import LineContactModel
from wearlaw.models.stage import Stage
from wearlaw.numerics.staged import staged
from wearlaw.plugins import loader
from wearlaw_kit.examples import SAME, SUM, assert_close, beginning, for_each
from wearlaw_kit.reduced import (
    at_magnitude,
    creeping,
    friction_limit,
    in_strips,
    lever,
    parts_of_power,
    random_ellipses,
    random_lines,
    saturation,
    sliding_power,
    translation,
    wide_ellipses,
    with_creepage,
)

Claims: TypeAlias = Mapping[Claim, tuple[Callable[..., None], ...]]
"""Checks by the claim from which a contact model may be exempt."""


MANY = 512
"""Lines to average an error over."""

PATCHES = 8
"""Ellipses to average an error over."""

WORDS = {"longitudinal": "Fx", "lateral": "Fy", "spin_moment": "Mz"}
"""What messages call the forces of `CreepForces`."""


class Path(NamedTuple):
    """Problems at creepages that grow through full slip, to look for jumps.

    The reduced creepages go from `low` to `high`, in `intervals` that are small enough for `find_jumps`. `allowed` is
    by how much each field of the contact may jump, for each problem.
    """

    problem: Problem
    low: float
    high: float
    intervals: int
    allowed: dict[str, Array]


def _at_factors(problem: Problem, factors: list[list[float]]) -> Problem:
    """Return the problem at its creepages times factors, to which its batch broadcasts."""
    shape = np.broadcast_shapes(problem.batch_shape, np.shape(factors))
    return creeping(problem.broadcast_to(shape), np.array(factors))


def _at_the_same_reduced_creepage(problem: Problem, other: Problem) -> Problem:
    return with_creepage(other, problem.creepage / saturation(problem) * saturation(other))


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


class Line:
    """Discs with parallel axes: one axis of nodes, one creepage.

    Attributes
    ----------
    where : str
        How messages begin.
    unit : str
        What messages call a reduced creepage of 1.
    problems : Problem
        Many operating points, from nearly full stick to full slip.
    similar : Problem
        As many, each with the same forces over μN as that of `problems`.
    batch : Problem
        Points with and without slip, and in full slip, that a batch must keep apart.
    node_axes : int
        Number of axes of the nodes.
    rounding : float
        Error of forces and powers that are computed in two ways, over `sizes` and `size_of_power`.
    edge : float
        Rounding of a traction bound on the very edge, over that in the centre.
    fall : float
        Share to which the difference between partial and full slip falls, from 1e-4 to 1e-8 away from full slip.
    directions : ndarray, (2, n)
        Directions of reduced creepages ξ and η.
    """

    geometry: ClassVar[Geometry] = "line"
    where = "on a line"
    unit = "the creepage μa/R"
    problems = random_lines(48)
    similar = _at_the_same_reduced_creepage(problems, problems[::-1])
    batch = _at_factors(problems[::6, None, None], [[1.0, 0.0, -1.0], [1e-3, 1e3, 1.0 + 1e-9]])
    node_axes = 1
    rounding = SAME
    edge = 0.0
    # At least as the square root of the distance, the steepest onset in theories of contact.
    fall = 0.01
    directions = np.array([[1.0], [0.0]])

    def random(self, points: int) -> Problem:
        """Return discs of many sizes."""
        return random_lines(points)

    def forces(self, model: ContactModel, problem: Problem) -> CreepForces:
        """Return the forces of the contact."""
        return model.solve(problem).forces

    def forces_alone(self, model: ContactModel, problem: Problem) -> CreepForces:
        """Return what `tangential_force` gives."""
        return CreepForces.of({"longitudinal": model.tangential_force(problem)})

    def solutions(self, model: ContactModel, problem: Problem) -> list[Contact]:
        """Return the contact on the model's own nodes and, where its fields are known anywhere, on uniform cells."""
        contacts = [model.solve(problem)]
        if isinstance(model, LineContactModel):
            contacts.append(model.at(problem, uniform_cells(problem.half_width, 97)))
        return contacts

    def inside(self, problem: Problem, contact: Contact) -> NDArray[np.bool_]:
        """Return where |x| is a at most."""
        within: NDArray[np.bool_] = np.abs(contact.x) <= contact.per_node(problem.a) * (1.0 + SAME)
        return within

    def longer(self, problem: Problem, factor: float) -> Problem:
        """Return the problem under the load at which Hertz's half-width is longer."""
        return problem.replaced(
            a=problem.a * factor,
            max_pressure=problem.max_pressure * factor,
            normal_force=problem.normal_force * factor**2,
        )

    def path(self, model: ContactModel) -> Path:
        """Return creepages from a hundredth to ten times μa/R."""
        problem = random_lines(2)
        # Where a cell begins to slip, the sum of the slips is off by a share of its value in full slip.
        allowed = {"force_x": np.zeros(2), "mean_slip": model.accuracy * saturation(problem)}
        # Carter's force has a curvature of 2 at full slip, hence changes by 2 (3 ln 10/512/2)² = 1e-4 more in one half.
        return Path(problem, low=1e-2, high=10.0, intervals=512, allowed=allowed)

    def to_refine(self) -> Iterator[Problem]:
        """Yield one batch of many, since the place within a cell where a zone begins is random."""
        problem = random_lines(MANY)
        # Nearer to zero, the slip zone is shorter than a cell.
        yield with_creepage(problem, np.linspace(0.1, 1.2, MANY) * saturation(problem))

    def error_of_sums(self, model: ContactModel) -> float:
        """Return the accuracy that the model declares."""
        return model.accuracy

    def error_of_areas(self, model: ContactModel) -> float:  # noqa: ARG002
        """Return rounding."""
        return SUM

    def error_of_force(self, model: ContactModel) -> float:
        """Return rounding, or the accuracy that a model declares: its force is then a sum over its nodes."""
        return SAME if model.accuracy == QUADRATURE else model.accuracy

    def error_of_traction(self, model: ContactModel) -> float:
        """Return rounding, or the error of the force of which the traction is the mean."""
        return self.error_of_force(model) if model.scale == "patch" else SAME

    def error_of_stick(self, model: ContactModel) -> float:  # noqa: ARG002
        """Return zero: a node slips or sticks."""
        return 0.0

    def error_of_power(self, model: ContactModel, problem: Problem, contact: Contact, due: Array) -> Array:
        """Return rounding, and the accuracy as a share of the power, of cells of that in full slip."""
        slipping = contact.slip_area / contact.patch_area
        # Positions are exact to the rounding of a, so in a short slip zone q·s is that much less exact.
        rounding = SUM / np.maximum(slipping, SUM)
        # A slip zone may be shorter than a cell: the error of sums over cells is a share of the power in full slip.
        whole = due if model.accuracy == QUADRATURE else sliding_power(problem)
        return rounding * np.abs(due) + model.accuracy * whole

    def sizes(self, problem: Problem, forces: CreepForces) -> dict[str, Array]:  # noqa: ARG002
        """Return the force."""
        return {"longitudinal": np.abs(forces.longitudinal)}

    def sizes_of_sums(self, problem: Problem, forces: CreepForces) -> dict[str, Array]:  # noqa: ARG002
        """Return μN."""
        return {"longitudinal": friction_limit(problem)}

    def size_of_power(self, problem: Problem, forces: CreepForces) -> Array:
        """Return the power."""
        return parts_of_power(problem, forces)


class Ellipse:
    """A wheel on a rail: nodes on strips, two creepages and a spin; the attributes are those of `Line`."""

    geometry: ClassVar[Geometry] = "ellipse"
    where = "on an ellipse"
    unit = "the creepage that linear theory needs for μN"
    problems = wide_ellipses(32)
    similar = _scaled(problems)
    batch = _at_factors(random_ellipses(8), [[0.0], [1.0], [1e3]])
    node_axes = 2
    rounding = SUM
    edge = SAME
    # What begins as a square root, c √gap (1 + d √gap), falls to a fiftieth where d is as low as -50.
    fall = 0.02
    directions = np.array([[1.0, 1.0, 0.0, -1.0, -1.0, -1.0, 0.0, 1.0], [0.0, 1.0, 1.0, 1.0, 0.0, -1.0, -1.0, -1.0]])

    def random(self, points: int) -> Problem:
        """Return patches of many shapes."""
        return random_ellipses(points)

    def forces(self, model: ContactModel, problem: Problem) -> CreepForces:
        """Return what `creep_forces` gives, for less than the contact."""
        return model.creep_forces(problem)

    forces_alone = forces

    def solutions(self, model: ContactModel, problem: Problem) -> list[Contact]:
        """Return the contact on the model's own nodes."""
        return [model.solve(problem)]

    def inside(self, problem: Problem, contact: Contact) -> NDArray[np.bool_]:
        """Return where (x/a)² + (y/b)² is 1 at most."""
        x, y = contact.x / contact.per_node(problem.a), contact.y / contact.per_node(problem.b)
        within: NDArray[np.bool_] = x**2 + y**2 <= 1.0 + SAME
        return within

    def longer(self, problem: Problem, factor: float) -> Problem:
        """Return the problem with another a."""
        return problem.replaced(a=problem.a * factor)

    def path(self, model: ContactModel) -> Path:
        """Return translations from 0.6 to 6 times the one that gives μN in linear theory, one of them without spin.

        On nodes, with spin, strips may begin to slip elsewhere at once: then a force may jump by the accuracy times μN.
        """
        problem, high = random_ellipses(4)[[0, 1, 3]], 6.0
        error = 0.0 if model.scale == "patch" else model.elliptic_accuracy
        of_forces = error * (problem.spin != 0) * friction_limit(problem)
        # Where a cell begins to slip, the sum of the slips is off by a share of its value in full slip.
        of_slip = error * translation(at_magnitude(problem, high))
        allowed = {"force_x": of_forces, "force_y": of_forces, "mean_slip": of_slip}
        # A force has a logarithmic slope that changes by up to 2 per e-fold: by 2 (ln 10/64/2)² = 6e-4 in one half.
        return Path(problem, low=0.6, high=high, intervals=64, allowed=allowed)

    def to_refine(self) -> Iterator[Problem]:
        """Yield patches one at a time, since the nodes may be many."""
        problem = random_ellipses(PATCHES)
        return (problem[index] for index in range(PATCHES))

    def error_of_sums(self, model: ContactModel) -> float:
        """Return the accuracy that the model declares, or rounding if one node holds the means."""
        return SAME if model.scale == "patch" else model.elliptic_accuracy

    error_of_areas = error_of_sums
    error_of_force = error_of_sums

    def error_of_traction(self, model: ContactModel) -> float:  # noqa: ARG002
        """Return rounding."""
        return SAME

    def error_of_stick(self, model: ContactModel) -> float:
        """Return the accuracy: a cell may slip on one side and stick on the other, and the traction turn within it."""
        return model.elliptic_accuracy

    def error_of_power(
        self,
        model: ContactModel,
        problem: Problem,
        contact: Contact,  # noqa: ARG002
        due: Array,
    ) -> Array:
        """Return a share of the power in full slip, since a slip zone may be shorter than a cell."""
        whole: Array = self.error_of_sums(model) * np.maximum(sliding_power(problem), due)
        return whole

    def sizes(self, problem: Problem, forces: CreepForces) -> dict[str, Array]:
        """Return μN, or the force where it is larger, and for the moment that times its lever."""
        size = np.maximum(friction_limit(problem), forces.tangential)
        moment = np.maximum(size * lever(problem), np.abs(forces.spin_moment))
        return {"longitudinal": size, "lateral": size, "spin_moment": moment}

    sizes_of_sums = sizes

    def size_of_power(self, problem: Problem, forces: CreepForces) -> Array:
        """Return the power of full slip, or of the forces where theirs is larger."""
        size: Array = np.maximum(sliding_power(problem), parts_of_power(problem, forces))
        return size


class Patch(Ellipse):
    """A patch of strips with a given pressure, fuller on one side than an ellipse and shorter on the other."""

    geometry: ClassVar[Geometry] = "strips"
    where = "on strips"
    problems, similar, batch = map(in_strips, (Ellipse.problems, Ellipse.similar, Ellipse.batch))

    def random(self, points: int) -> Problem:
        """Return patches of many shapes."""
        return in_strips(random_ellipses(points))

    def inside(self, problem: Problem, contact: Contact) -> NDArray[np.bool_]:
        """Return where |x| is half the length of the strip at most."""
        strips = problem.strips
        assert strips is not None
        within: NDArray[np.bool_] = np.abs(contact.x) <= strips.half_length[..., None, :] * (1.0 + SAME)
        on_strip: NDArray[np.bool_] = contact.y == strips.y[..., None, :]
        return within & on_strip

    def longer(self, problem: Problem, factor: float) -> Problem:
        """Return the problem with strips of another length."""
        strips = problem.strips
        assert strips is not None
        longer = dataclasses.replace(strips, half_length=strips.half_length * factor)
        return problem.replaced(a=problem.a * factor, strips=longer, normal_force=longer.normal_force.sum(axis=-1))

    def path(self, model: ContactModel) -> Path:
        """Return the path of ellipses; the forces of a few strips jump more than those of many."""
        path = super().path(model)
        return path._replace(problem=in_strips(path.problem))

    def to_refine(self) -> Iterator[Problem]:
        """Yield patches one at a time, since the nodes may be many."""
        return map(in_strips, super().to_refine())


Shape: TypeAlias = Line | Ellipse
LINE, ELLIPSE, PATCH = Line(), Ellipse(), Patch()
SHAPES: tuple[Shape, ...] = (LINE, ELLIPSE, PATCH)


def assert_same_forces(
    shape: Shape, problem: Problem, found: CreepForces, due: CreepForces, message: str, error: float
) -> None:
    """Assert that forces and moment agree to a share of their sizes."""
    for name, size in shape.sizes(problem, due).items():
        assert_close(getattr(found, name), getattr(due, name), f"{WORDS[name]} {message}", 0.0, error * size)


def assert_same_power(shape: Shape, problem: Problem, found: Contact, due: Contact, message: str, error: float) -> None:
    """Assert that two contacts have the same Tγ, to a share of its size."""
    allowed = error * shape.size_of_power(problem, due.forces)
    assert_close(found.wear_index, due.wear_index, f"the wear index {message}", 0.0, allowed)


def of_stage(stage: Stage, points: int) -> list[tuple[ContactModel, Problem]]:
    """Return a stage around contact models of wearlaw, each with random problems of a shape that the model solves."""
    models = {"line": "exact", "ellipse": "fastsim", "strips": "fastsim"}
    return [(staged(loader.contact_model(models[shape.geometry]), (stage,)), shape.random(points)) for shape in SHAPES]


def on_shapes(*shapes: Shape) -> Callable[[Callable[[ContactModel, Shape], None]], Callable[[ContactModel], None]]:
    """Return a decorator that runs a check on those of these shapes which the model solves.

    Its messages begin with the shape.
    """

    def decorate(check: Callable[[ContactModel, Shape], None]) -> Callable[[ContactModel], None]:
        @functools.wraps(check)
        def on_all(model: ContactModel) -> None:
            for shape in shapes:
                if shape.geometry not in model.geometries():
                    continue
                with beginning(f"{shape.where}: "):
                    check(model, shape)

        vars(on_all)["geometries"] = {shape.geometry for shape in shapes}
        return on_all

    return decorate


def on_problems(
    *shapes: Shape,
) -> Callable[[Callable[[ContactModel, Any, Problem], None]], Callable[[ContactModel], None]]:
    """Return a decorator that runs a check on the `problems` of those of these shapes which the model solves."""

    def decorate(check: Callable[[ContactModel, Any, Problem], None]) -> Callable[[ContactModel], None]:
        @functools.wraps(check)
        def on_shape(model: ContactModel, shape: Shape) -> None:
            for_each(shape.problems, functools.partial(check, model, shape))

        return on_shapes(*shapes)(on_shape)

    return decorate


on_each_shape, on_problems_of_each_shape = on_shapes(*SHAPES), on_problems(*SHAPES)
on_patches_of_strips, on_problems_of_strips = on_shapes(ELLIPSE, PATCH), on_problems(ELLIPSE, PATCH)
