"""Every exception and warning that wearlaw raises on purpose, and how messages show what came from outside.

An error names the wrong field, the value it got and the expected value, and suggests a fix. All errors derive from
`WearlawError`. Errors in the user's input derive from `InputError`, which is also a `ValueError`, so that generic code
can catch either.

A text from outside, such as a name, a unit or a path, enters a message by `quoted` or `excerpt`, and any other value by
`shortened`. They escape control characters and line breaks, so that a value cannot steer a terminal or pass for a line
of ours, and cut it. All errors and warnings then pass `readable`, also those that a plugin raises with a raw text.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterable
from dataclasses import dataclass
from difflib import get_close_matches

VALUE, PATH, LINE, LINES = 100, 400, 1000, 50
"""Most characters that a message shows of a value, of a path and in a line, and most lines."""

_CONTROL = re.compile("[\x00-\x1f\x7f-\x9f\u2028-\u202e\u2066-\u2069\ud800-\udfff\ufffe\uffff]")
"""Characters that steer a terminal, break a line, reverse the direction of the text after them, or are none at all."""


def printable(text: str, kept: str = "") -> str:
    """Return a text with its control characters written as Python writes them in a repr, except those to be kept."""
    return _CONTROL.sub(lambda found: found[0] if found[0] in kept else ascii(found[0])[1:-1], text)


def excerpt(text: object) -> str:
    """Return a text from outside as a message shows it: printable, and cut with its length if it is long."""
    whole = str(text)
    return printable(whole[:VALUE]) + (f"... ({len(whole)} characters)" if len(whole) > VALUE else "")


def quoted(text: object) -> str:
    """Return a text from outside between quotes, as a message shows it; of a path it shows more than of a value."""
    whole, most = str(text), PATH if isinstance(text, os.PathLike) else VALUE
    cut = f"...' ({len(whole)} characters)" if len(whole) > most else "'"
    return f"'{printable(whole[:most])}{cut}"


def shortened(value: object) -> str:
    """Return the repr of a value, shortened for a message."""
    try:
        return excerpt(repr(value))
    except Exception as error:  # such as a whole number of more digits than Python writes
        return f"a {type(value).__name__} whose value cannot be shown: {excerpt(message_of(error))}"


def readable(message: str) -> str:
    """Return a message without control characters but line breaks, and without overlong lines, for a terminal."""
    lines = [
        line if len(line) <= LINE else f"{line[: LINE // 2]} ... ({len(line)} characters) ... {line[-LINE // 4 :]}"
        for line in printable(message, kept="\n\t").split("\n")
    ]
    if len(lines) > LINES:
        lines[LINES:] = [f"... and {len(lines) - LINES} more lines"]
    return "\n".join(lines)


class WearlawError(Exception):
    """Base of all errors raised by wearlaw."""

    def __str__(self) -> str:
        return readable(super().__str__())


class InputError(WearlawError, ValueError):
    """A value from the user is invalid."""


class UnitError(InputError):
    """A value has no unit, an unknown unit or the wrong dimension, or is not a finite real number."""


class ConditionsError(InputError):
    """The conditions of an operating point are incomplete, contradictory or do not broadcast."""


class UnknownModelError(InputError):
    """No installed plugin provides a model of this name, or more than one does."""


class CaseError(InputError):
    """A case file is missing, is not TOML, or has a wrong field."""


PROBLEMS = 20
"""Largest number of problems that a message lists."""


class DataError(InputError):
    """Data cannot be used: a file with tests or a contact, a table of a sweep, or a value in it is missing or wrong.

    Attributes
    ----------
    subject : str
        The wrong file or table.
    problems : tuple of str
        Every problem with its place, not only the first one.
    """

    MOST = PROBLEMS
    """Largest number of problems that the message lists."""

    def __init__(self, subject: str, problems: Iterable[str] = ()) -> None:
        self.subject = subject
        self.problems = tuple(problems)
        super().__init__(subject, self.problems)

    def __str__(self) -> str:
        return readable(with_problems(self.subject, self.problems))


class FitError(InputError):
    """Parameters cannot be fitted: the law does not have them, or the tests do not determine them."""


class FrozenError(InputError, AttributeError):
    """A setting of a record that never changes was assigned or deleted."""


class OutputError(WearlawError, OSError):
    """Results cannot be written where the user asked for them."""


class CompositionError(WearlawError, TypeError):
    """Stages of a pipeline are in the wrong order or do not fit each other."""


class SweepError(WearlawError, RuntimeError):
    """A sweep cannot be finished, because its worker processes die; finished blocks on disk are kept."""


class ModelError(WearlawError, RuntimeError):
    """A contact model or wear law failed, or broke its contract: a wrong shape or type, or a value out of bounds."""


@dataclass(frozen=True)
class Fault:
    """One wrong field of a configuration: its path and a message."""

    path: tuple[str, ...]
    message: str

    def __str__(self) -> str:
        where = ".".join(map(excerpt, self.path))
        return f"{where}: {self.message}" if where else self.message


class ConfigurationError(InputError):
    """A model, material, rig or case has a wrong, missing or unknown field.

    Attributes
    ----------
    subject : str
        The thing being configured, such as the name of a model.
    problems : tuple of Fault
        Every wrong field with its path, not only the first one.
    """

    def __init__(self, subject: str, problems: Iterable[Fault]) -> None:
        self.subject = subject
        self.problems = tuple(problems)
        super().__init__(subject, self.problems)

    def __str__(self) -> str:
        if len(self.problems) == 1:
            return readable(f"{self.subject}: {self.problems[0]}")
        return readable(with_problems(f"{self.subject}:", self.problems))


class WearlawWarning(UserWarning):
    """Base of all warnings of wearlaw."""

    def __str__(self) -> str:
        return readable(super().__str__())


class CalibrationWarning(WearlawWarning):
    """A parameter set is used with a contact, materials or a body for which it was not fitted."""


class RangeWarning(WearlawWarning):
    """A model is used outside the range for which its source states it."""


class PlasticityWarning(RangeWarning):
    """A contact is loaded beyond first yield or the shakedown limit, which elastic contact models do not know."""


class FitWarning(WearlawWarning):
    """A fit is less certain than its numbers suggest."""


class WorkerWarning(WearlawWarning):
    """A worker process of a sweep died, and its blocks are computed again."""


class ResumeWarning(WearlawWarning):
    """Some blocks of a resumed sweep are missing or damaged, and are computed."""


class PluginWarning(WearlawWarning):
    """A plugin, or a part of it, could not be used and is left out."""


_WORDS = re.compile(r"[^\W_]{3,}")
"""The words of a name such as "coefficient.low_speed"; letters such as the "m" of "m_c" are none."""


def did_you_mean(word: str, known: Iterable[str]) -> str:
    """Return "; did you mean 'x'?" for the nearest known word, or a full stop if no word is near.

    Case does not matter. A word that is part of longer names, such as creepage in longitudinal_creepage, suggests the
    first of them.
    """
    if len(word) > VALUE:
        return "."  # no name is that long, and comparing would take long
    names = list(known)
    sought = word.lower()
    parts = set(_WORDS.findall(sought))
    whole = [name for name in names if name.lower() == sought]
    longer = [name for name in names if parts and parts <= set(_WORDS.findall(name.lower()))]
    spelt = {name.lower(): name for name in reversed(names)}  # of equal names, the first counts
    near = [*whole, *longer, *(spelt[name] for name in get_close_matches(sought, spelt, n=1))]
    return f"; did you mean {quoted(near[0])}?" if near else "."


def message_of(error: BaseException) -> str:
    """Return the message of an exception, or a remark if its `__str__` fails, which can happen in a plugin."""
    try:
        return str(error)
    except KeyboardInterrupt:
        raise
    except BaseException as another:
        return f"(its message cannot be shown: {type(another).__name__})"


def described(error: BaseException) -> str:
    """Return the type and the message of an exception."""
    message = message_of(error)
    return f"{type(error).__name__}: {message}" if message else type(error).__name__


def with_problems(head: str, problems: Iterable[object]) -> str:
    """Return a message with each problem on a line of its own below the head, the first `PROBLEMS` of them."""
    every = list(problems)
    more = len(every) - PROBLEMS
    lines = [*every[:PROBLEMS], *([f"... and {more} more"] if more > 0 else [])]
    return head + "".join(f"\n  {line}" for line in lines)
