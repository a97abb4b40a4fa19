"""Exceptions and warnings, and how messages show a value.

An error names the wrong field, the value it got and the expected value, and suggests a fix. All errors derive from
`WearlawError`. Errors in the user's input derive from `InputError`, which is also a `ValueError`, so that generic code
can catch either. `wearlaw` itself has those that scripts catch most often and that models raise; this module has all.
"""

from __future__ import annotations

import os
import sys
import warnings
from collections.abc import Iterable
from dataclasses import dataclass
from difflib import get_close_matches

import numpy as np

__all__ = [
    "CalibrationWarning", "CaseError", "CompositionError", "ConditionsError", "ConfigurationError", "DataError",
    "FitError", "FitWarning", "FrozenError", "InputError", "ModelError", "OutputError", "PlasticityWarning",
    "PluginWarning", "RangeWarning", "ResumeWarning", "SweepError", "UnitError", "UnknownModelError",
    "UnusualWarning", "WearlawError", "WearlawWarning", "WorkerWarning", "warn",
]  # fmt: skip

LONGEST = 400
"""Most characters that a message shows of a value."""

LINE = 900
"""Most characters on a line of a message."""


def cut(text: str, most: int = LONGEST) -> str:
    """Return a text as far as a message shows it."""
    return text if len(text) <= most else f"{text[:most]}... ({len(text)} characters)"


def shown(value: object) -> str:
    """Return a value as a message shows it: its repr, cut if it is long; of a path, its text between quotes."""
    if isinstance(value, os.PathLike):
        value = os.fspath(value)
    elif isinstance(value, np.generic):
        value = value.item()  # 20.0 rather than np.float64(20.0)
    return cut(repr(value))


class WearlawError(Exception):
    """Base of all errors raised by wearlaw."""

    def __str__(self) -> str:
        return "\n".join(cut(line, LINE) for line in super().__str__().split("\n"))


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

    def __init__(self, subject: str, problems: Iterable[str] = ()) -> None:
        self.subject = subject
        self.problems = tuple(problems)
        super().__init__(subject, self.problems)

    def __str__(self) -> str:
        return with_problems(self.subject, self.problems)


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
        where = cut(".".join(self.path))
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
            return f"{self.subject}: {self.problems[0]}"
        return with_problems(f"{self.subject}:", self.problems)


class WearlawWarning(UserWarning):
    """Base of all warnings of wearlaw."""


class CalibrationWarning(WearlawWarning):
    """A parameter set is used with a contact, materials or a body for which it was not fitted."""


class RangeWarning(WearlawWarning):
    """A model is used outside the range for which its source states it."""


class PlasticityWarning(RangeWarning):
    """A contact is loaded beyond first yield or the shakedown limit, which elastic contact models do not know."""


class UnusualWarning(WearlawWarning):
    """A value is outside what people usually have, as after a slip of unit."""


class FitWarning(WearlawWarning):
    """A fit is less certain than its numbers suggest."""


class WorkerWarning(WearlawWarning):
    """A worker process of a sweep died, and its blocks are computed again."""


class ResumeWarning(WearlawWarning):
    """Some blocks of a resumed sweep are missing or damaged, and are computed."""


class PluginWarning(WearlawWarning):
    """A plugin, or a part of it, could not be used and is left out."""


def did_you_mean(word: str, words: Iterable[str]) -> str:
    """Return "; did you mean 'x'?" for the nearest known word, or a full stop if no word is near.

    Case does not matter. A word that is part of longer names, such as creepage in longitudinal_creepage, suggests the
    first of them.
    """
    sought = word.lower()
    spelt = {name.lower(): name for name in reversed(list(words))}  # of equal names, the first counts
    longer = [name for name in reversed(spelt) if len(sought) > 2 and sought in name]
    near = [*longer, *get_close_matches(sought, spelt, n=1)]
    return f"; did you mean {shown(spelt[sought if sought in spelt else near[0]])}?" if near else "."


INSIDE = ("wearlaw", "numpy", "contextlib", "pydantic")
"""What stands between the lines of a user and a warning: wearlaw with its plugins, decorators and validators."""


def warn(message: str | Warning, category: type[Warning] | None = None) -> None:
    """Warn at the nearest line that is not one of wearlaw or its plugins."""
    level, frame = 2, sys._getframe(1)
    while frame.f_back is not None and str(frame.f_globals.get("__name__")).startswith(INSIDE):
        level, frame = level + 1, frame.f_back
    warnings.warn(message, category, stacklevel=level)


def described(error: BaseException) -> str:
    """Return the type and the message of an exception."""
    return f"{type(error).__name__}: {error}".removesuffix(": ")


def with_problems(head: str, problems: Iterable[object]) -> str:
    """Return a message with each problem on a line of its own below the head, the first `PROBLEMS` of them."""
    every = list(problems)
    more = len(every) - PROBLEMS
    lines = [*every[:PROBLEMS], *([f"... and {more} more"] if more > 0 else [])]
    return head + "".join(f"\n  {cut(str(line), LINE)}" for line in lines)
