"""A contact that is already solved, in the place of a contact model."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

from pydantic import SkipValidation

from wearlaw.arrays.array import Array
from wearlaw.contact.contact import Contact
from wearlaw.contact.problem import Problem
from wearlaw.errors import CompositionError
from wearlaw.models.contact_model import Claim, ContactModel, Scale


class Solved(ContactModel):
    """The contacts of a batch that another program or another pipeline has solved, one after the other.

    It "solves" their problem only, all of it at once.
    """

    source: ClassVar[str] = "the program that solved the contact"

    contact: SkipValidation[Any]
    """The contacts, with a batch of one axis, and none of them missing."""
    read_by: SkipValidation[Any] = None
    """The reader that read them, for messages."""

    @property
    def kind(self) -> str:  # type: ignore[override]
        """Word for the origin of the contacts in messages."""
        return "contact model" if self.read_by is None else "reader"

    @property
    def name(self) -> str:  # type: ignore[override]
        """Name of the origin of the contacts in messages."""
        return "solved" if self.read_by is None else str(self.read_by.name)

    def _origin(self) -> str:
        return "not known: the contact was solved elsewhere" if self.read_by is None else str(self.read_by._origin())

    @property
    def scale(self) -> Scale:
        """Whether each contact is one node with the means of its patch."""
        return "patch" if self.contact.pressure.size == self.contact.rolling_speed.size else "cells"

    @property
    def exemptions(self) -> Mapping[Claim, str]:
        """The nodes are those of another program, so their sums differ from the totals by its errors."""
        return {"energy_balance": "the nodes are those of the program that solved the contact"}

    def of(self, problem: Problem) -> Contact:
        """Return the contacts in the shape of the batch of their problem, flat or as a single one."""
        found: Contact = self.contact
        if problem.batch_shape == ():
            found = found[0]
        if problem.batch_shape != found.rolling_speed.shape:
            raise CompositionError("the contact is already solved; it holds no other operating points")
        return found

    solve_line = of
    solve_ellipse = of
    solve_strips = of

    def on_strips(self, problem: Problem, shares: Array) -> Contact | None:  # noqa: ARG002
        """Raise an error, since the strips cannot be chosen any more."""
        raise CompositionError("strips: the contact is already solved on its own strips; leave `strips` out")

    def __repr__(self) -> str:
        return "a contact solved elsewhere"


def flat(contact: Contact, problem: Problem) -> Contact:
    """Return the contacts of the existing patches along one batch axis."""
    speed, exists = contact.rolling_speed, problem.exists

    def along_one_axis(array: Array) -> Array:
        return array.reshape(speed.size, *array.shape[speed.ndim :]) if exists is None else array[exists]

    return contact.replaced(problem=None).mapped(along_one_axis).replaced(problem=problem.flatten())
