"""The base class of contact models, `ContactModel`, and of all models, `Model`.

A model is its configuration: a frozen pydantic record. Its fields carry units, and its methods compute.
"""

import inspect
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, Literal, Self, TypeAlias, cast, final, get_args

import numpy as np
from pydantic import model_validator

from wearlaw.arrays.array import Array
from wearlaw.contact.contact import Contact
from wearlaw.contact.problem import PATCHES, CreepForces, Geometry, Problem
from wearlaw.errors import CompositionError, InputError, ModelError, WearlawError, described, did_you_mean
from wearlaw.extras import load
from wearlaw.settings.configuration import Configuration

Scale: TypeAlias = Literal["patch", "cells"]
"""Whether a contact holds the means of the whole patch in one node, or resolves the patch into many nodes."""

Claim: TypeAlias = str
"""Name of an invariant that a model keeps unless it declares itself exempt; see `Model.exemptions`.

It is the name of a check of the conformance kit, such as "each_node_wears_by_itself". For contact models, some claims
have several checks, such as "energy_balance" or "spin".
"""

QUADRATURE = 5e-8
"""Accuracy of the quadrature of `LineContactModel`; its worst case is a slip zone just short of the whole patch."""

ELLIPTIC = 5e-3
"""Default limit for the error of sums over an ellipse; a model can declare another."""

OF_ARRAYS = (
    "\nIn a fit or an uncertainty, its numbers are arrays of shape (points, 1), one value for each operating point."
    " Write its formulas with NumPy functions that broadcast: np.where instead of if, np.exp instead of math.exp"
)
"""Hint for a law that fails with arrays instead of numbers."""

OF_READ_ONLY = (
    "\nThe arrays that a model is given are read-only, because other models read them too. Make a new array, as in"
    " mpa = pressure / 1e6 instead of mpa = pressure; mpa /= 1e6, or begin with pressure.copy()"
)
"""Hint for a model that fails because it writes into an array that it was given."""


class Model(Configuration, ABC):
    """Base class of rigs, contact models and wear laws."""

    kind: ClassVar[str]
    """Word for a model of this kind in messages."""

    name: ClassVar[str]
    """Name of the model in the look-up."""

    source: ClassVar[str]
    """Literature source of the model."""

    _provided_by: ClassVar[Callable[..., str]]
    """Where a class of models comes from, in words; set by the look-up of plugins."""

    def _origin(self) -> str:
        """Return the class of this model in words, with the distribution or the module that it comes from."""
        cls = type(self)
        return f"class {cls.__name__}{cls._provided_by(cls)}"

    @classmethod
    def subject(cls) -> str:
        """Return the name of this model in messages."""
        return cls.name

    def _repr_html_(self) -> str:
        """Return the model for a notebook: its fields, with a drawing of a rig or the curve of a law."""
        shown: str = load("wearlaw_output.notebook", "html", "a notebook")(self)
        return shown

    @property
    def exemptions(self) -> Mapping[Claim, str]:
        """The invariants that this model does not keep, each with the reason."""
        return {}

    if not TYPE_CHECKING:  # checkers reject this order by themselves

        def __or__(self, other: object) -> object:
            raise CompositionError(
                f"'{self.name}' cannot start a pipeline; begin with a rig, as in"
                ' wl.TwinDisc.suros() | wl.contact_model("exact") | wl.wear_law("usfd")'
            )


def fault(model: Model, what: str) -> ModelError:
    """Return the error for a model that is at fault; it names the model, its class and its distribution.

    Parameters
    ----------
    model : Model
    what : str
        What the model did, such as "returned rates of shape (3,)"; the message begins with kind and name of the model.
    """
    return ModelError(with_origin(model, f"{model.kind} '{model.name}' {what}"))


def with_origin(model: Model, message: str) -> str:
    """Return a message about a model with the class of the model and the distribution or module that it comes from."""
    return f"{message}\nThe {model.kind} is {model._origin()}"


class Blame:
    """A context that turns an exception in a model's code into a `ModelError` that names the model.

    Errors of wearlaw pass, because their messages are complete. An `InputError` gets a note that names the model, but
    not one of a rig or a reader, which is about the conditions or a file. Ctrl-C and a lack of memory pass as well.

    Parameters
    ----------
    model : Model
        The model to name.
    p : mapping of str to float or ndarray, optional
        The numbers given to a wear law. If there are arrays among them, the message says how to compute with arrays.
    """

    __slots__ = ("_model", "_p")

    def __init__(self, model: Model, p: Mapping[str, object] | None = None) -> None:
        self._model, self._p = model, p

    def __enter__(self) -> None:
        return None

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, _: object) -> None:
        model = self._model
        if isinstance(error, InputError) and model.kind not in ("rig", "reader") and not hasattr(error, "__notes__"):
            error.add_note(f"raised in {model.kind} '{model.name}', {model._origin()}")
        if error is None or isinstance(error, WearlawError | KeyboardInterrupt | MemoryError):
            return
        said = described(error)
        hint = ""
        if "read-only" in said or "readonly" in said:  # as NumPy and numba say it
            hint = OF_READ_ONLY
        elif any(isinstance(number, np.ndarray) for number in (self._p or {}).values()):
            hint = OF_ARRAYS
        raise fault(model, f"failed: {said}{hint}") from error


def check_scale(model: Model | type[Model], scale: object, known: tuple[str, ...]) -> None:
    """Raise a `ModelError` if a model declares an unknown scale; a property is checked for each instance."""
    if not isinstance(scale, property | cached_property) and scale not in known:
        cls = model if isinstance(model, type) else type(model)
        words = " or ".join(repr(one) for one in known)
        raise ModelError(f"{cls.__name__}.scale: is {scale!r}{did_you_mean(str(scale), known)} It must be {words}")


class ContactModel(Model):
    """A theory of the tangential contact: from a contact problem to traction and slip in the patch.

    Derive a model with closed-form fields from `LineContactModel` instead, so that its wear is integrated to rounding
    error.
    """

    kind: ClassVar[str] = "contact model"

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
            check_scale(cls, inspect.getattr_static(cls, "scale"), get_args(Scale))

        def __new__(cls, *_: object, **__: object) -> Self:
            """Raise an error for a class that solves neither geometry."""
            if not cls.geometries():
                raise TypeError(f"{cls.__name__} is abstract: it implements neither solve_line nor solve_ellipse")
            return super().__new__(cls)

    @model_validator(mode="after")
    def _has_a_scale(self) -> Self:
        check_scale(self, self.scale, get_args(Scale))
        return self

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
        return tuple(shape for shape, (own, inherited) in methods.items() if own is not inherited)

    def _cannot_solve(self, geometry: Geometry) -> CompositionError:
        return CompositionError(
            f"contact model '{self.name}' does not solve {PATCHES[geometry]}, only"
            f" {' and '.join(PATCHES[known] for known in self.geometries())}"
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
