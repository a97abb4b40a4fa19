"""Notes that a reader needs beside the results."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field

from wearlaw.errors import caught_warnings


@dataclass
class Notes:
    """Collects notes for the reader of the results, each once."""

    texts: list[str] = field(default_factory=list)

    def add(self, text: str) -> None:
        """Add a note unless it is there already."""
        if text not in self.texts:
            self.texts.append(text)

    @contextmanager
    def of(self, subject: str) -> Iterator[None]:
        """Turn wearlaw's warnings inside the context into notes about a subject."""
        with caught_warnings() as caught:
            yield
        for warning in caught:
            self.add(f"{subject}: {warning}")


def grouped(texts: Iterable[str]) -> list[str]:
    """Return notes with one in place of those that say the same of several subjects."""
    subjects: dict[str, list[str]] = {}
    for text in texts:
        subject, _, remark = text.partition(": ")
        subjects.setdefault(f": {remark}" if remark else subject, []).append(subject if remark else "")
    return [", ".join(those) + remark for remark, those in subjects.items()]
