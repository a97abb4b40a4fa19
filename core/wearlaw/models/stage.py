"""The base class of stages, `Stage`: steps around the contact model."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, ClassVar, TypeAlias

from wearlaw.contact.contact import Contact
from wearlaw.contact.problem import CreepForces, Problem
from wearlaw.errors import CompositionError
from wearlaw.models.contact_model import Model

Solve: TypeAlias = Callable[[Problem], Contact]
"""Solves a contact problem."""

Forces: TypeAlias = Callable[[Problem], CreepForces]
"""Solves a contact problem for its forces."""


class Stage(Model):
    """A step around the contact model: it changes the problem before the model solves it, or the solved contact.

    A stage overrides one of two methods. One that changes only the problem, such as friction that falls with
    temperature, overrides `altered`; wear is then integrated as exactly as without the stage. Any other stage overrides
    `solve`.
    """

    kind: ClassVar[str] = "stage"

    gives_means: ClassVar[bool] = False
    """Whether the contact after this stage is one node with the means of the whole patch."""

    if not TYPE_CHECKING:

        @classmethod
        def __pydantic_init_subclass__(cls, **options: Any) -> None:
            """Raise an error for a stage that changes nothing."""
            super().__pydantic_init_subclass__(**options)
            if cls.solve is Stage.solve and cls.altered is Stage.altered:
                raise TypeError(f"{cls.__name__} changes nothing: it implements neither altered nor solve")

        def __or__(self, other: object) -> object:
            raise CompositionError(
                f"stage '{self.name}' cannot start a pipeline; the order is"
                f' rig | wl.contact_model("fastsim") | wl.stage("{self.name}") | wl.wear_law("usfd")'
            )

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
        return inner(self.altered(problem, lambda one: inner(one).forces))

    @classmethod
    def alters_problem_only(cls) -> bool:
        """Return whether the stage leaves the solved contact as it is, because it does not override `solve`."""
        return cls.solve is Stage.solve
