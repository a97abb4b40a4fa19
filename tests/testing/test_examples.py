"""How the checks search: the same examples for each, and a counter-example that is named, or the failure itself."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import strategies as st

import wearlaw as wl
from wearlaw.testing import examples
from wearlaw.testing.examples import for_each
from wearlaw.testing.shapes import LINE


def test_a_function_that_writes_into_its_examples_leaves_those_of_the_next_as_they_are() -> None:
    seen: list[list[float]] = []
    for _ in range(2):
        seen.append([])

        def examine(problem: wl.Problem) -> None:
            seen[-1].append(float(problem.creepage))
            np.asarray(problem.creepage)[...] = np.nan

        for_each(LINE.problems, examine)
    assert len(seen[0]) == examples._SETTINGS.max_examples >= examples.EXAMPLES
    assert seen[0] == seen[1]
    assert np.isfinite(seen[0]).all()


def test_a_counter_example_is_shrunk_and_named() -> None:
    def examine(number: int) -> None:
        assert number < 20, f"{number} is too large"

    with pytest.raises(AssertionError, match=r"^20 is too large") as failure:
        for_each(st.integers(0, 1000), examine)
    assert "example=20" in "\n".join(failure.value.__notes__)


def test_a_failure_that_is_not_met_again_is_raised_as_it_was() -> None:
    left = ["only once"]

    def examine(_: int) -> None:
        assert not left, left.pop()

    with pytest.raises(AssertionError, match=r"^only once"):
        for_each(st.integers(), examine)
