"""What a plugin implements that solves the tangential contact: `ContactModel`, or one of the classes derived from it.

A model is its configuration: a frozen pydantic record whose fields carry units and whose methods compute.
"""

from abc import ABC
from collections.abc import Mapping
from typing import TYPE_CHECKING, ClassVar, Literal, Self, TypeAlias, final

import numpy as np

from wearlaw.arrays.array import Array
from wearlaw.contact.contact import Contact
from wearlaw.contact.problem import PATCHES, CreepForces, Geometry, Problem
from wearlaw.errors import CompositionError, ModelError, WearlawError, described
from wearlaw.settings.configuration import Configuration

Scale: TypeAlias = Literal["patch", "cells"]
"""Whether a contact holds the means of the whole patch in one node, or resolves it into many."""

Claim: TypeAlias = Literal["traction_bound", "stick", "energy_balance", "saturation", "initial_slope", "similarity"]
"""An invariant that a contact model keeps unless it declares itself exempt; see `ContactModel.exemptions`."""

QUADRATURE = 5e-8
"""Accuracy of the quadrature of `LineContactModel`; its worst case is a slip zone just short of the whole patch."""

ELLIPTIC = 5e-3
"""Error of sums over an ellipse that a model is held to unless it declares another."""

OF_ARRAYS = (
    "\nIn a fit or an uncertainty its numbers are arrays of shape (points, 1), one value for each operating point."
    " Write its formulas with NumPy functions that broadcast: np.where instead of if, np.exp instead of math.exp"
)
"""Hint for a law that fails with arrays in place of numbers."""


class Model(Configuration, ABC):
    """What rigs, contact models and wear laws have in common."""

    kind: ClassVar[str]
    """What messages call a model of this kind."""

    name: ClassVar[str]
    """The name under which the model is looked up."""

    source: ClassVar[str]
    """The literature that the model is taken from."""

    @classmethod
    def subject(cls) -> str:
        """Return what messages call this model."""
        return cls.name

    if not TYPE_CHECKING:  # checkers reject this order by themselves

        def __or__(self, other: object) -> object:
            raise CompositionError(
                f"'{self.name}' cannot start a pipeline; begin with a rig, as in"
                ' wl.TwinDisc.suros() | wl.contact_model("exact") | wl.wear_law("usfd")'
            )


class Blame:
    """A context in which whatever a model's code raises becomes a `ModelError` that names the model.

    wearlaw's own errors pass, as they say what is wrong; so do a person's interrupt and a lack of memory.

    Parameters
    ----------
    model : Model
        The model that is named.
    p : mapping of str to float or ndarray, optional
        The numbers that a wear law was given. If there are arrays among them, the message says how to take them.
    """

    __slots__ = ("_model", "_p")

    def __init__(self, model: Model, p: Mapping[str, object] | None = None) -> None:
        self._model, self._p = model, p

    def __enter__(self) -> None:
        return None

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, _: object) -> None:
        if error is None or isinstance(error, WearlawError | KeyboardInterrupt | MemoryError):
            return
        arrays = any(isinstance(number, np.ndarray) for number in (self._p or {}).values())
        raise ModelError(
            f"{self._model.kind} '{self._model.name}' failed: {described(error)}{OF_ARRAYS if arrays else ''}"
        ) from error


class ContactModel(Model):
    """A theory of the tangential contact: from a contact problem to traction and slip in the patch.

    A subclass that knows its fields at any point in closed form derives from `LineContactModel` instead,
    which lets the wear be integrated to rounding error.
    """

    kind: ClassVar[str] = "contact model"

    scale: ClassVar[Scale] = "cells"
    """"patch" where the model gives the means of the whole patch only."""

    uses_measured_traction: ClassVar[bool] = False
    """Whether the model can use a measured traction coefficient."""

    if not TYPE_CHECKING:

        def __new__(cls, *_: object, **__: object) -> Self:
            """Refuse a model that solves nothing."""
            if not cls.geometries():
                raise TypeError(f"{cls.__name__} is abstract: it implements neither solve_line nor solve_ellipse")
            return super().__new__(cls)

    @final
    def solve(self, problem: Problem) -> Contact:
        """Return the solved contact, on nodes of the model's choice.

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
        """Return the shapes of patch that the model solves: those whose method it implements."""
        methods: dict[Geometry, tuple[object, object]] = {
            "line": (cls.solve_line, ContactModel.solve_line),
            "ellipse": (cls.solve_ellipse, ContactModel.solve_ellipse),
            "strips": (cls.solve_strips, ContactModel.solve_strips),
        }
        return tuple(shape for shape, (own, inherited) in methods.items() if own is not inherited)

    def _cannot_solve(self, geometry: Geometry) -> CompositionError:
        return CompositionError(
            f"contact model '{self.name}' does not solve {PATCHES[geometry]}, only"
            f" {' and '.join(PATCHES[known] for known in self.geometries())}"
        )

    def tangential_force(self, problem: Problem) -> Array:
        """Return T [N] of a line contact with the sign of the creepage, of the batch shape.

        It is that of `solve_line`, unless the model knows it without.
        """
        return self.solve_line(problem).tangential_force

    def creep_forces(self, problem: Problem) -> CreepForces:
        """Return the forces of an elliptic contact or of strips; those of `solve`, unless it knows them without."""
        return self.solve(problem).forces

    def on_strips(self, problem: Problem, shares: Array) -> Contact | None:  # noqa: ARG002
        """Return the contact on strips at y = `shares` × b, of shape (strips), or None if it is known on its own only.

        Each strip stands for the width from half-way to the one before to half-way to the next one.
        """
        return None

    def refined(self) -> "ContactModel | None":
        """Return the same theory on twice as fine nodes, or None, the default, if the model has no such choice.

        The checks then hold the model to errors of its sums that fall with refinement, at the least in first order.
        """
        return None

    @property
    def accuracy(self) -> float:
        """Relative error of sums over the nodes of a line contact, for pressure, traction and dissipation."""
        return QUADRATURE

    @property
    def elliptic_accuracy(self) -> float:
        """Error of sums over the nodes of an elliptic contact, as a share of what they are in full slip."""
        return ELLIPTIC

    @property
    def exemptions(self) -> Mapping[Claim, str]:
        """The invariants that this model does not keep, each with the reason."""
        return {}
