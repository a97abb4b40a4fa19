"""The base class of readers, `Reader`: they read contacts that other programs have solved."""

from __future__ import annotations

from abc import abstractmethod
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

from wearlaw.contact.contact import Contact
from wearlaw.errors import CompositionError
from wearlaw.models.contact_model import Model


class Reader(Model):
    """Reads the contacts that another program has solved from its files.

    Its fields are what the files do not hold, such as the materials of the bodies.
    """

    kind: ClassVar[str] = "reader"

    suffixes: ClassVar[tuple[str, ...]]
    """The endings of the files, in lower case, such as (".mat",)."""

    if not TYPE_CHECKING:

        @classmethod
        def __pydantic_init_subclass__(cls, **options: Any) -> None:
            """Raise an error for a reader without endings of files."""
            super().__pydantic_init_subclass__(**options)
            suffixes = getattr(cls, "suffixes", ())
            wrong = isinstance(suffixes, str) or not suffixes
            if wrong or not all(one.startswith(".") and one == one.lower() for one in suffixes):
                raise TypeError(
                    f'{cls.__name__}.suffixes must hold the endings of its files in lower case, such as (".mat",);'
                    f" got {suffixes!r}"
                )

        def __or__(self, other: object) -> object:
            raise CompositionError(
                f"reader '{self.name}' cannot start a pipeline; read a contact, and take"
                ' wl.Prediction.of(contact, wl.wear_law("usfd"))'
            )

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
