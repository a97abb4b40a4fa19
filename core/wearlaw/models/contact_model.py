"""The base classes of contact models, `ContactModel`, and of the steps around one, `Stage`."""

import dataclasses
from abc import abstractmethod
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, ClassVar, Literal, Self, TypeAlias, cast, final, get_args

import numpy as np

from wearlaw.arrays import Array, freeze
from wearlaw.contact.contact import Contact
from wearlaw.contact.parts import CreepForces, LineFields
from wearlaw.contact.problem import PATCHES, Geometry, Problem
from wearlaw.contact.quadrature import Nodes, Zone, join
from wearlaw.errors import CompositionError
from wearlaw.models.model import Model, check_scale

Scale: TypeAlias = Literal["patch", "cells"]
"""Whether a contact holds the means of the whole patch in one node, or resolves the patch into many nodes."""

FieldVariable: TypeAlias = Literal["pressure", "traction", "slip", "wear_index_density"]
"""A variable of the nodes that depends on the fields alone."""

Solve: TypeAlias = Callable[[Problem], Contact]
"""Solves a contact problem."""

Forces: TypeAlias = Callable[[Problem], CreepForces]
"""Solves a contact problem for its forces."""

QUADRATURE = 5e-8
"""Accuracy of the quadrature of `LineContactModel`; its worst case is a slip zone just short of the whole patch."""

ELLIPTIC = 5e-3
"""Default limit for the error of sums over an ellipse; a model can declare another."""


class ContactModel(Model):
    """A theory of the tangential contact: from a contact problem to traction and slip in the patch.

    Derive a model with closed-form fields from `LineContactModel` instead, so that its wear is integrated to rounding
    error.
    """

    kind: ClassVar[str] = "contact model"
    conditions: ClassVar[type[Any] | None]

    scale: ClassVar = cast(Any, "cells")  # Any: for type checkers, a subclass may make it a property
    """"patch" if the model gives only the means of the whole patch, otherwise "cells". A model that contains another
    can make it a property."""

    uses_measured_traction: ClassVar[bool] = False
    """Whether the model can use a measured traction coefficient."""

    assumes_like_materials: ClassVar[bool] = True
    """Whether the model neglects the tractions that the pressure causes between unlike materials. wearlaw then warns
    where they matter."""

    if not TYPE_CHECKING:

        @classmethod
        def __pydantic_init_subclass__(cls, **options: Any) -> None:
            """Raise an error for an unknown scale."""
            super().__pydantic_init_subclass__(**options)
            check_scale(cls, get_args(Scale))

        def __new__(cls, *_: object, **__: object) -> Self:
            """Raise an error for a class that solves neither geometry."""
            if not cls.geometries():
                raise TypeError(f"{cls.__name__} is abstract: it implements neither solve_line nor solve_ellipse")
            return super().__new__(cls)

    @final
    def solve(self, problem: Problem) -> Contact:
        """Return the solved contact on nodes of the model's choice.

        Raises
        ------
        CompositionError
            If the model does not solve contacts of this geometry.
        """
        if problem.geometry == "line":
            return self.solve_line(problem)
        return self.solve_ellipse(problem) if problem.geometry == "ellipse" else self.solve_strips(problem)

    def solve_line(self, problem: Problem) -> Contact:  # noqa: ARG002
        """Return the solved line contact on nodes of the model's choice, of shape (batch, nodes)."""
        raise self._cannot_solve("line")

    def solve_ellipse(self, problem: Problem) -> Contact:  # noqa: ARG002
        """Return the solved elliptic contact on strips of the model's choice, of shape (batch, nodes, strips)."""
        raise self._cannot_solve("ellipse")

    def solve_strips(self, problem: Problem) -> Contact:  # noqa: ARG002
        """Return the solved contact on the strips of the problem, of shape (batch, nodes, strips)."""
        raise self._cannot_solve("strips")

    @classmethod
    def geometries(cls) -> tuple[Geometry, ...]:
        """Return the shapes of patch that the model solves, according to the methods that it implements."""
        methods: dict[Geometry, tuple[object, object]] = {
            "line": (cls.solve_line, ContactModel.solve_line),
            "ellipse": (cls.solve_ellipse, ContactModel.solve_ellipse),
            "strips": (cls.solve_strips, ContactModel.solve_strips),
        }
        return tuple(shape for shape, (method, inherited) in methods.items() if method is not inherited)

    def _cannot_solve(self, geometry: Geometry) -> CompositionError:
        return CompositionError(
            f"contact model '{self.name}' does not solve {PATCHES[geometry]}, only"
            f" {' and '.join(PATCHES[shape] for shape in self.geometries())}"
        )

    def tangential_force(self, problem: Problem) -> Array:
        """Return T [N] of a line contact with the sign of the creepage, of the batch shape.

        By default it is the force of `solve_line`. A model can override this method to compute the force for less.
        """
        return self.solve_line(problem).tangential_force

    def creep_forces(self, problem: Problem) -> CreepForces:
        """Return the forces of an ellipse or of strips, by default from `solve`; override it if they cost less."""
        return self.solve(problem).forces

    def on_strips(self, problem: Problem, shares: Array) -> Contact | None:  # noqa: ARG002
        """Return the contact on strips at y = `shares` × b, of shape (strips), or None if the model cannot choose them.

        Each strip represents the width from half-way to the strip before it to half-way to the strip after it.
        """
        return None

    def refined(self) -> "ContactModel | None":
        """Return the same theory on nodes twice as fine, or None, the default, if the model cannot be refined.

        The checks then require that the errors of the sums fall with refinement, at least in first order.
        """
        return None

    @property
    def accuracy(self) -> float:
        """Relative error of sums over the nodes of a line contact, for pressure, traction and dissipation."""
        return QUADRATURE

    @property
    def elliptic_accuracy(self) -> float:
        """Error of sums over the nodes of an elliptic contact, as a share of the sums in full slip."""
        return ELLIPTIC


class CreepForceModel(ContactModel):
    """A contact model that gives Fx, Fy and Mz from the creepages and the spin; its contact is one node of means."""

    scale: ClassVar[Scale] = "patch"

    @abstractmethod
    def creep_forces(self, problem: Problem) -> CreepForces:
        """Return the forces and the moment, of the batch shape."""

    def solve_ellipse(self, problem: Problem) -> Contact:
        """Return the patch means as a contact of one node, of shape (batch, 1, 1)."""
        return Contact.of_patch(problem, self.creep_forces(problem))


class LineContactModel(ContactModel):
    """Base class for contact models with closed-form fields and one slip zone, at the trailing edge.

    The wear is integrated to rounding error. The methods are only called with creepage ≥ 0; `solve` mirrors the result
    for negative creepage. Methods that return None by default are optional; they only save time.
    """

    square_roots_at: ClassVar[Literal["slip_zone", "patch"]] = "slip_zone"
    """The interval with square-root behaviour of pressure, traction and slip at its ends. "slip_zone" suits elastic
    half-spaces. "patch" suits models with smooth slip up to the start of the slip zone."""

    @abstractmethod
    def slip_length(self, problem: Problem) -> Array:
        """Return the length of the slip zone, which ends at the trailing edge [m]; 0 if nothing slips."""

    @abstractmethod
    def fields(self, problem: Problem, nodes: Nodes) -> LineFields:
        """Return the fields at `nodes`; their positions have the shape (batch, nodes) or broadcast to it.

        The arrays of `problem` have a last axis of length one, and those of one operating point no axis, so that
        formulas broadcast against positions.
        """

    @abstractmethod
    def tangential_force_per_width(self, problem: Problem) -> Array:
        """Return T [N/m], of the batch shape."""

    def crossings(self, problem: Problem, variable: FieldVariable, value: Array) -> Array | None:  # noqa: ARG002
        """Return the positions in the slip zone where a variable crosses a value, or None to let wearlaw search.

        Parameters
        ----------
        problem : Problem
            With a batch of any shape.
        variable : str
            "pressure" [Pa], "traction" [Pa], "slip" [-] or "wear_index_density" [N/m²].
        value : ndarray, (batch)
            In SI.

        Returns
        -------
        ndarray, (batch, k), or None
            Distances from the trailing edge [m]; NaN, or any value beyond the slip zone, if there is no crossing.
        """
        return None

    def excess_dissipation(self, problem: Problem, threshold: float | Array) -> Array | None:  # noqa: ARG002
        """Return ∫ max(q·s - threshold, 0) dx over the patch [N/m], of the batch shape, or None if not known.

        `threshold` [N/m²] is positive, a single number or an array of the batch shape.
        """
        return None

    def tangential_force(self, problem: Problem) -> Array:
        """Return T [N] with the sign of the creepage."""
        return self._mirrored_force(problem) * problem.track_width

    def _mirrored_force(self, problem: Problem) -> Array:
        return np.copysign(self.tangential_force_per_width(problem.forward()), problem.creepage)

    def zones(self, problem: Problem) -> tuple[Zone, Zone]:
        """Return the stick zone, measured from the leading edge, and the slip zone, measured from the trailing edge."""
        over_patch, length = self.square_roots_at == "patch", self.slip_length(problem.forward())
        stick = Zone.of(problem.half_width, 2.0 * problem.half_width - length, over_patch)
        return stick, Zone.of(problem.half_width, length, over_patch)

    def at(self, problem: Problem, nodes: Nodes) -> Contact:
        """Return the contact on the given nodes, mirrored where the creepage is negative."""
        freeze(nodes, nodes.__slots__)
        forward = problem.forward()
        fields = self.fields(forward[..., None] if forward.batch_shape else forward, nodes)
        if not (problem.creepage > 0.0).all():
            sign = np.sign(problem.creepage)[..., None]
            fields = dataclasses.replace(fields, traction=sign * fields.traction, slip=sign * fields.slip)
        force = self._mirrored_force(problem)
        return Contact.from_line(problem, fields, x=nodes.x, length=nodes.length, force_per_width=force)

    def solve_line(self, problem: Problem) -> Contact:
        """Return the contact on quadrature nodes of the stick zone and the slip zone."""
        stick, slip = self.zones(problem)
        sticks, nodes = stick.length.any(), slip.nodes()
        return self.at(problem, join(stick.nodes().reversed(), nodes) if sticks else nodes)


class Stage(Model):
    """A step around the contact model: it changes the problem before the model solves it, or the solved contact.

    A stage overrides one of two methods. One that changes only the problem, such as friction that falls with
    temperature, overrides `altered`; wear is then integrated as exactly as without the stage. Any other stage overrides
    `solve`.
    """

    kind: ClassVar[str] = "stage"
    conditions: ClassVar[type[Any] | None]

    gives_means: ClassVar[bool] = False
    """Whether the contact after this stage is one node with the means of the whole patch."""

    if not TYPE_CHECKING:

        @classmethod
        def __pydantic_init_subclass__(cls, **options: Any) -> None:
            """Raise an error for a stage that changes nothing."""
            super().__pydantic_init_subclass__(**options)
            if cls.solve is Stage.solve and cls.altered is Stage.altered:
                raise TypeError(f"{cls.__name__} changes nothing: it implements neither altered nor solve")

    def altered(self, problem: Problem, forces: Forces) -> Problem:  # noqa: ARG002
        """Return the problem that the contact model is to solve instead.

        Parameters
        ----------
        problem : Problem
            The problem made by the rig, or altered by a stage further out, with a batch of any shape.
        forces : callable
            Returns the forces for a problem of the same batch shape, with the contact model and the stages inside.

        Returns
        -------
        Problem
            Of the same geometry and batch shape, as from `Problem.replaced`.
        """
        return problem

    def solve(self, problem: Problem, inner: Solve) -> Contact:
        """Return the solved contact.

        Parameters
        ----------
        problem : Problem
            As for `altered`.
        inner : callable
            Solves a problem with the contact model and the stages inside. A fixed point calls it several times.

        Returns
        -------
        Contact
            Of the geometry and batch shape of `problem`.
        """
        return inner(self.altered(problem, lambda part: inner(part).forces))

    @classmethod
    def alters_problem_only(cls) -> bool:
        """Return whether the stage leaves the solved contact as it is, because it does not override `solve`."""
        return cls.solve is Stage.solve
