"""Warnings that were caught, and the notes for the readers of results that are made of them."""

from __future__ import annotations

import re
import warnings
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from threading import RLock, get_ident
from typing import Self, TextIO

from wearlaw.errors import (
    CalibrationWarning,
    CompositionError,
    FitWarning,
    PlasticityWarning,
    RangeWarning,
    UnusualWarning,
    WearlawWarning,
    warn,
    with_problems,
)
from wearlaw.units.usual import OneWarning, apart

_CATCHING = RLock()

_NUMBER = re.compile(r"\d+(?:\.\d+)?(?:e[+-]?\d+)?")

NAMED = 3
"""Most subjects that a note names."""

HEADS: dict[type[Exception], str] = {
    CalibrationWarning: "parameters fitted for something else",
    PlasticityWarning: "beyond the elastic limit",
    RangeWarning: "outside the range of a model",
    UnusualWarning: "unusual values",
    CompositionError: "left out",
}
"""What several notes of a kind have in common; notes of other kinds stand alone."""


@contextmanager
def caught_warnings(*kinds: type[Warning]) -> Iterator[list[Warning]]:
    """Yield a list of the warnings of some kinds, by default all of wearlaw's, that this thread gives in the context.

    All other warnings are shown as ever. Python's `catch_warnings` changes settings of the process, and two threads
    that enter it at once leave the changes behind, so one thread at a time enters it here.
    """
    kept, thread = kinds or (WearlawWarning,), get_ident()
    caught: list[Warning] = []
    with _CATCHING, warnings.catch_warnings(), apart():
        for kind in kept:
            warnings.simplefilter("always", kind)
        show = warnings.showwarning

        def keep(
            message: Warning | str,
            category: type[Warning],
            filename: str,
            lineno: int,
            file: TextIO | None = None,
            line: str | None = None,
        ) -> None:
            if get_ident() == thread and isinstance(message, kept):
                caught.append(message)
            else:
                show(message, category, filename, lineno, file, line)

        warnings.showwarning = keep
        yield caught


class Note(str):
    """A remark for the reader of results.

    Attributes
    ----------
    kind : type of exception or None
        The class of the warning or error that it was; None if it states what was done.
    """

    kind: type[Exception] | None

    def __new__(cls, text: str, kind: type[Exception] | None = None) -> Self:
        """Return a text as a note."""
        note = super().__new__(cls, text)
        note.kind = kind
        return note


@dataclass
class Notes:
    """Collects notes for the reader of the results, each once.

    Attributes
    ----------
    texts : list of Note
        The notes.
    """

    texts: list[Note] = field(default_factory=list)

    def add(self, text: str, kind: type[Exception] | None = None) -> None:
        """Add a note unless it is there already."""
        if text not in self.texts:
            self.texts.append(text if isinstance(text, Note) else Note(text, kind))

    @contextmanager
    def of(self, subject: str) -> Iterator[None]:
        """Turn wearlaw's warnings inside the context into notes about a subject."""
        with caught_warnings() as caught, OneWarning():
            yield
        for warning in sorted(caught, key=lambda warning: not isinstance(warning, UnusualWarning)):  # the causes first
            several = isinstance(warning, UnusualWarning | FitWarning | RangeWarning)
            for text in str(warning).splitlines() if several else [str(warning)]:
                self.add(f"{subject}: {text.strip()}", type(warning))

    def warn(self) -> None:
        """Raise the notes that are warnings, one warning a kind."""
        for kind in dict.fromkeys(note.kind for note in self.texts):
            if kind is not None and issubclass(kind, Warning):
                first, *others = grouped(note for note in self.texts if note.kind is kind)
                warn(with_problems(first, others), kind)


def by_kind(notes: Iterable[str]) -> list[Note]:
    """Return notes with one in place of those of a kind in `HEADS`, which says how many they are and has one a line."""
    kinds: dict[object, list[str]] = {}
    for note in notes:
        kind = getattr(note, "kind", None)
        kinds.setdefault(kind if kind in HEADS else note, []).append(note)
    summaries = []
    for texts in kinds.values():
        kind, every = getattr(texts[0], "kind", None), grouped(texts)
        head = [f"{HEADS[kind]} ({len(every)}):"] if kind in HEADS and len(every) > 1 else []
        summaries.append(Note("\n  ".join([*head, *every]), kind))
    return summaries


def warn_by_kind(caught: Iterable[Warning]) -> None:
    """Raise warnings again, one a kind, with the same text once."""
    kinds: dict[type[Warning], dict[str, None]] = {}
    for warning in caught:
        kinds.setdefault(type(warning), {})[str(warning)] = None
    for kind, texts in kinds.items():
        warn("\n".join(texts), kind)


def grouped(texts: Iterable[str]) -> list[str]:
    """Return notes with one in place of those that say the same of several subjects, up to their last semicolon.

    It names the first subjects and counts the others. Of notes that differ in numbers alone, it has the one whose first
    number is greatest.
    """
    groups: dict[str, list[tuple[str, str, str]]] = {}
    for text in texts:
        subject, _, remark = text.partition(": ")
        head, _, tail = remark.rpartition("; ")
        key = head or _NUMBER.sub("#", remark) or text
        groups.setdefault(key, []).append((subject, head or remark or text, f"; {tail}" if head else ""))
    notes = []
    for members in groups.values():
        subjects, heads, tails = zip(*members, strict=True)
        head = heads[0]
        if subjects == (head,):
            notes.append(head)
        elif len({*heads}) > 1:
            worst, text, _ = max(members, key=lambda member: float(_NUMBER.findall(member[1])[0]))
            others = [subject for subject in dict.fromkeys(subjects) if subject != worst]
            named = "".join(f", {subject}" for subject in others[: NAMED - 1])
            notes.append(f"{worst}: {text} ({len(heads) - 1} more with other numbers{named})")
        elif len({*tails}) == 1:
            named, more = ", ".join(subjects[:NAMED]), len(subjects) - NAMED
            notes.append(f"{named}{f' and {more} more' if more > 0 else ''}: {head}{tails[0]}")
        else:
            notes.append(head + "".join(f"; {subject}: {tail[2:]}" for subject, _, tail in members))
    return notes
