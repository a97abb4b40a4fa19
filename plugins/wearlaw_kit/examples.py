"""How the checks run on examples, and their shared tolerances."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import TypeVar

import numpy as np

from wearlaw.arrays import Array
from wearlaw.contact.contact import Contact
from wearlaw.contact.problem import Problem
from wearlaw.errors import ModelError, described
from wearlaw.models.model import Exempt

T = TypeVar("T", Contact, Problem)

EPS = float(np.finfo(np.float64).eps)

SAME = 16.0 * EPS
"""Relative difference of two orders of the same few operations: vector and scalar code may round differently."""

SUM = 64.0 * EPS
"""Error of a sum over nodes, relative to the sum of magnitudes."""


_EXEMPTION: ContextVar[Exempt | None] = ContextVar("exemption", default=None)
_PARTS: ContextVar[tuple[str, ...]] = ContextVar("parts", default=())


@contextmanager
def exempt(exemption: Exempt | None) -> Iterator[None]:
    """Check a model with an exemption from a part of the claim, or up to a bound."""
    token = _EXEMPTION.set(exemption)
    try:
        yield
    finally:
        _EXEMPTION.reset(token)


@contextmanager
def part(*names: str) -> Iterator[None]:
    """Check these parts of a claim, by which an exemption can name them."""
    token = _PARTS.set((*_PARTS.get(), *names))
    try:
        yield
    finally:
        _PARTS.reset(token)


def left_out(name: str) -> bool:
    """Return whether the model is exempt from a part."""
    exemption = _EXEMPTION.get()
    return exemption is not None and exemption.upto is None and name in exemption.parts


def bounded(name: str) -> bool:
    """Return whether the model is exempt from a part up to a bound."""
    exemption = _EXEMPTION.get()
    return exemption is not None and exemption.upto is not None and name in exemption.parts


def leeway() -> float:
    """Return the relative deviation that the exemption allows in the part being checked."""
    exemption = _EXEMPTION.get()
    if exemption is None or exemption.upto is None or (exemption.only and not {*exemption.parts} & {*_PARTS.get()}):
        return 0.0
    return exemption.upto


def for_each(examples: T, examine: Callable[[T], None]) -> None:
    """Run a function on a batch of problems or contacts; if it fails, name the first one that fails by itself."""
    try:
        examine(examples)
    except Exception:
        for point in range(len(examples.rolling_speed)):
            alone = examples[point : point + 1]
            try:
                examine(alone)
            except Exception as error:
                error.add_note(f"example={alone!r}")
                raise error from None
        raise  # only together


@contextmanager
def failing(where: str = "") -> Iterator[None]:
    """Begin the message of a failure with the place where the model fails; an error in the model is a failure too."""
    try:
        yield
    except KeyboardInterrupt:
        raise
    except AssertionError as error:
        error.args = (f"{where}{error}",)
        raise
    except BaseException as error:
        of_a_run = isinstance(error, ModelError)  # what every run checks
        failure = AssertionError(f"{where}{error if of_a_run else f'the model raised {described(error)}'}")
        failure.__notes__ = getattr(error, "__notes__", [])
        raise failure from error


def assert_close(
    actual: Array, expected: Array, message: str, relative: float | Array = SAME, absolute: float | Array = 0.0
) -> None:
    """Assert that two arrays agree, and name the worst entry if they do not."""
    actual, expected = np.broadcast_arrays(actual, expected)
    relative = np.maximum(relative, leeway())
    allowed = np.broadcast_to(relative * np.abs(expected) + absolute, expected.shape)
    wrong = ~(np.abs(actual - expected) <= allowed)
    if wrong.any():
        worst = np.unravel_index(np.argmax(np.where(wrong, np.abs(actual - expected), 0.0)), expected.shape)
        value, due = actual[worst].item(), expected[worst].item()
        raise AssertionError(f"{message}: {value!r} instead of {due!r} (allowed: {allowed[worst]:.1e})")
