"""Contacts that other programs have solved: `Reader` reads them, and `Solved` stands in for their contact model."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping
from pathlib import Path
from typing import Any, ClassVar

from pydantic import SkipValidation

from wearlaw.arrays import Array
from wearlaw.contact.contact import Contact
from wearlaw.contact.problem import Problem
from wearlaw.errors import CompositionError
from wearlaw.models.contact_model import ContactModel, Scale
from wearlaw.models.model import Claim, Model


class Reader(Model):
    """Reads the contacts that another program has solved from its files.

    Its fields are what the files do not hold, such as the materials of the bodies.
    """

    kind: ClassVar[str] = "reader"

    suffixes: ClassVar[tuple[str, ...]]
    """The endings of the files, in lower case, such as (".mat",)."""

    example: ClassVar[Mapping[str, Any]] = {}
    """A small file to try the reader with, and what its program says of the contact, with units, such as
    {"file": Path(__file__).with_name("small.prt"), "normal_force": "80 kN", "slip": "0.3 %"}. The file is a path or its
    content; of a value that varies over the patch, such as the slip, the largest magnitude is stated."""

    digits: ClassVar[int | None] = None
    """Significant digits of the numbers that the program prints: by their rounding, a traction may exceed its bound.
    None for numbers of full precision."""

    @classmethod
    def __pydantic_init_subclass__(cls, **options: Any) -> None:
        """Raise an error for a reader without endings of files, or with one text in place of several."""
        super().__pydantic_init_subclass__(**options)
        suffixes = getattr(cls, "suffixes", ())
        if isinstance(suffixes, str) or not suffixes:
            raise TypeError(f'{cls.__name__}.suffixes must be a tuple such as (".mat",); got {suffixes!r}')

    @classmethod
    def recognises(cls, head: bytes) -> bool:  # noqa: ARG003
        """Return whether a file may be one of this program, by its first 4096 bytes.

        wearlaw asks the readers that share an ending. By default a reader recognises every file of its endings.
        """
        return True

    @abstractmethod
    def read(self, path: Path) -> Contact:
        """Return the contact in a file, with its `problem`, on strips unless it is a line.

        The signs are those of wearlaw. A file of one operating point gives a contact without a batch axis.

        Raises
        ------
        InputError
            If the file is wrong, with its line and column.
        """


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
    def rounding(self) -> float:
        """Share by which a printed traction may exceed its printed bound: half a unit of the last digit of each."""
        digits = None if self.read_by is None else self.read_by.digits
        return 0.0 if digits is None else 10.0 ** (1 - digits)

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
        contact: Contact = self.contact
        if problem.batch_shape == ():
            contact = contact[0]
        if problem.batch_shape != contact.rolling_speed.shape:
            raise CompositionError("the contact is already solved; it holds no other operating points")
        return contact

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
