"""Notes that a reader needs beside the results."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field

from wearlaw.errors import WearlawWarning


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
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always", WearlawWarning)
            yield
        for warning in caught:
            if issubclass(warning.category, WearlawWarning):
                self.add(f"{subject}: {warning.message}")
            else:
                warnings.warn_explicit(warning.message, warning.category, warning.filename, warning.lineno)
