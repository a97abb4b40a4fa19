"""Every exception and warning that wearlaw raises on purpose.

An error says which field is wrong, the value it got, what was expected and how to put it right.
All of them derive from `WearlawError`; those caused by what the user gave derive from `InputError`,
which is also a `ValueError`, so that generic code may catch either.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from difflib import get_close_matches


class WearlawError(Exception):
    """Base of all errors raised by wearlaw."""


class InputError(WearlawError, ValueError):
    """A value given by the user cannot be used."""


class UnitError(InputError):
    """A value without its unit, with the wrong dimension, an unknown unit, or no finite real number."""


class ConditionsError(InputError):
    """The conditions of an operating point are incomplete, contradictory or do not broadcast."""


class UnknownModelError(InputError):
    """No installed plugin provides a model of this name, or more than one does."""


class CaseError(InputError):
    """A case file is missing, is not TOML, or is wrong in one of its fields."""


class DataError(InputError):
    """Tests of a lab cannot be used: their file is missing or wrong, or values are.

    Attributes
    ----------
    subject : str
        What is wrong.
    problems : tuple of str
        Every problem, each with where it is, not only the first one.
    """

    MOST = 20
    """How many problems the message lists."""

    def __init__(self, subject: str, problems: Iterable[str] = ()) -> None:
        self.subject = subject
        self.problems = tuple(problems)
        super().__init__(subject, self.problems)

    def __str__(self) -> str:
        more = len(self.problems) - self.MOST
        rest = [f"... and {more} more"] if more > 0 else []
        return with_problems(self.subject, [*self.problems[: self.MOST], *rest])


class FitError(InputError):
    """Parameters cannot be fitted: they are not known, or the tests do not determine them."""


class FrozenError(InputError, AttributeError):
    """A setting of a record that never changes was assigned or deleted."""


class OutputError(WearlawError, OSError):
    """Results cannot be written where the user asked for them."""


class CompositionError(WearlawError, TypeError):
    """Stages of a pipeline are in the wrong order or do not fit each other."""


class SweepError(WearlawError, RuntimeError):
    """A sweep cannot be finished, since its worker processes die; what was done before is kept where it is on disk."""


class ModelError(WearlawError, RuntimeError):
    """A contact model or wear law failed, or broke its contract: a wrong shape or type, or a value out of bounds."""


@dataclass(frozen=True)
class Fault:
    """One wrong field of a configuration: the path to it and what is wrong there."""

    path: tuple[str, ...]
    message: str

    def __str__(self) -> str:
        where = ".".join(self.path)
        return f"{where}: {self.message}" if where else self.message


class ConfigurationError(InputError):
    """A model, material, rig or case has a wrong, missing or unknown field.

    Attributes
    ----------
    subject : str
        What was being configured, such as the name of a model.
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
    """Base of all warnings issued by wearlaw."""


class CalibrationWarning(WearlawWarning):
    """A parameter set is used with another contact solution than the one it was fitted for."""


class RangeWarning(WearlawWarning):
    """A model is used outside the range for which its source states it."""


class PlasticityWarning(RangeWarning):
    """A contact is loaded beyond first yield or the shakedown limit, which elastic contact models do not know."""


class FitWarning(WearlawWarning):
    """A fit is there, but is less certain than its numbers say."""


class WorkerWarning(WearlawWarning):
    """A worker process of a sweep died, and what it was at is computed again."""


class ResumeWarning(WearlawWarning):
    """Blocks that an interrupted sweep has left are damaged on disk, and are computed again."""


class PluginWarning(WearlawWarning):
    """An installed plugin, or a part of it, could not be used and is left out."""


def did_you_mean(word: str, known: Iterable[str]) -> str:
    """Return "; did you mean 'x'?" for the nearest known word, or a full stop when none is near."""
    near = get_close_matches(word, list(known), n=1)
    return f"; did you mean '{near[0]}'?" if near else "."


def message_of(error: BaseException) -> str:
    """Return the message of an exception, or a remark if its `__str__` fails, as a plugin's may."""
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
    """Return a message of problems, each on a line below the head."""
    return head + "".join(f"\n  {problem}" for problem in problems)
