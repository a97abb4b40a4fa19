"""The search of the checks for counter-examples, and their shared tolerances."""

from __future__ import annotations

import copy
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, TypeVar

import numpy as np
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

from wearlaw.arrays.array import Array
from wearlaw.errors import described
from wearlaw.testing.sampling import EPS

T = TypeVar("T")

EXAMPLES = 25
"""Number of examples that a check draws."""

SAME = 16.0 * EPS
"""Relative difference of two orders of the same few operations: vector and scalar code may round differently."""

SUM = 64.0 * EPS
"""Error of a sum over nodes, relative to the sum of magnitudes."""

_SETTINGS = settings(
    max_examples=EXAMPLES,
    derandomize=True,
    database=None,
    deadline=None,
    report_multiple_bugs=False,
    phases=(Phase.generate, Phase.shrink),
    suppress_health_check=(HealthCheck.too_slow, HealthCheck.data_too_large, HealthCheck.large_base_example),
)
"""Deterministic and without files, so that a check gives the same answer everywhere."""


def for_each(strategy: st.SearchStrategy[T], examine: Callable[[T], None]) -> None:
    """Run a function on examples; shrink a counter-example and name it in a note of the error."""
    for example in _examples(strategy):
        try:
            examine(copy.deepcopy(example))
        except Exception as error:
            failure = error
            break
    else:
        return
    _search(strategy, examine)
    raise failure  # the search did not find it again: the model is not deterministic


def _examples(strategy: st.SearchStrategy[T]) -> list[T]:
    """Return the examples of a strategy, drawn once since drawing takes longer than most checks."""
    if strategy not in _drawn:
        examples: list[T] = []
        _search(strategy, examples.append)
        _drawn[strategy] = examples
    return _drawn[strategy]


_drawn: dict[st.SearchStrategy[Any], list[Any]] = {}


def _search(strategy: st.SearchStrategy[T], examine: Callable[[T], None]) -> None:
    """Run a function on the examples of a strategy, the same for every function until one fails."""

    @_SETTINGS
    @given(strategy)
    def check(example: T) -> None:
        examine(example)

    check()


class ModelRaisedError(AssertionError):
    """The failure of a check in which the model raised an error of its own."""


def as_failure(error: BaseException) -> AssertionError:
    """Return an error as the failure of a check: of a model's own, one with its name, message and notes."""
    while isinstance(error, BaseExceptionGroup):  # of several different failures, the first
        error = error.exceptions[0]
    if isinstance(error, AssertionError):
        return error
    failure = ModelRaisedError(f"the model raised {described(error)}")
    for note in getattr(error, "__notes__", []):
        failure.add_note(note)
    return failure


@contextmanager
def beginning(where: str) -> Iterator[None]:
    """Begin the message of a failure with the place where the model fails."""
    try:
        yield
    except KeyboardInterrupt:
        raise
    except BaseException as error:
        failure = as_failure(error)
        failure.args = (f"{where}{failure}",)
        raise failure from (None if failure is error else error)


def assert_close(
    found: Array, expected: Array, message: str, relative: float | Array = SAME, absolute: float | Array = 0.0
) -> None:
    """Assert that two arrays agree, and name the worst entry if they do not."""
    found, expected = np.broadcast_arrays(found, expected)
    allowed = np.broadcast_to(relative * np.abs(expected) + absolute, expected.shape)
    wrong = ~(np.abs(found - expected) <= allowed)
    if wrong.any():
        worst = np.unravel_index(np.argmax(np.where(wrong, np.abs(found - expected), 0.0)), expected.shape)
        raise AssertionError(
            f"{message}: {found[worst]!r} instead of {expected[worst]!r} (allowed: {allowed[worst]:.1e})"
        )
