"""Runs that are killed and damaged at random end with the bytes of an undisturbed one, or say what to remove."""

from __future__ import annotations

import os
from collections.abc import Iterator

import pytest

from tests.core.damage import Trials, trials

pytest.importorskip("zarr")
pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="each run is a child of one process, to save time")


@pytest.fixture(scope="module")
def made() -> Iterator[Trials]:
    with trials() as found:
        yield found


@pytest.mark.parametrize(("kind", "seed"), [(kind, seed) for seed in range(6) for kind in ("run", "store")])
def test_a_run_that_was_killed_and_damaged_resumes_to_the_same_bytes_or_says_what_to_remove(
    made: Trials, kind: str, seed: int
) -> None:
    trial = made.trial(seed, kind)
    assert not trial.wrong, trial
