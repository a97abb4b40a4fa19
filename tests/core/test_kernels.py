"""Where compiled loops run."""

from __future__ import annotations

import sys

import pytest

import wearlaw as wl
from wearlaw import (
    accelerated,
    kernels,  # private: the choice between NumPy and numba
)
from wearlaw.kernels import WORTHWHILE  # private: the choice between NumPy and numba

pytestmark = pytest.mark.usefixtures("by_size_again")


@pytest.fixture
def numba(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let numba seem installed."""
    monkeypatch.setattr(kernels, "_numba", object)


@pytest.mark.usefixtures("numba")
def test_loops_are_compiled_where_they_are_worth_loading() -> None:
    assert [accelerated(points) for points in (0, 2, WORTHWHILE - 1, WORTHWHILE)] == [False, False, False, True]


@pytest.mark.usefixtures("numba")
@pytest.mark.parametrize(("value", "on"), [("0", False), ("1", True), ("", True)])
def test_the_environment_turns_compiled_loops_off(monkeypatch: pytest.MonkeyPatch, value: str, on: bool) -> None:
    monkeypatch.setenv("WEARLAW_ACCELERATE", value)
    assert accelerated(WORTHWHILE) == on


@pytest.mark.usefixtures("numba")
def test_what_the_process_says_goes_before_size_and_environment(monkeypatch: pytest.MonkeyPatch) -> None:
    wl.accelerate(False)
    assert not accelerated(WORTHWHILE)
    monkeypatch.setenv("WEARLAW_ACCELERATE", "0")
    wl.accelerate(True)
    assert accelerated(2)
    wl.accelerate(None)
    assert not accelerated(WORTHWHILE)


def test_a_numba_that_cannot_be_imported_is_as_if_there_were_none(monkeypatch: pytest.MonkeyPatch) -> None:
    kernels._numba.cache_clear()
    monkeypatch.setitem(sys.modules, "numba", None)  # makes `import numba` raise ImportError
    try:
        assert not accelerated(WORTHWHILE)
        with pytest.raises(wl.InputError, match=r"numba is not installed.*wearlaw\[fast\]"):
            wl.accelerate(True)
    finally:
        kernels._numba.cache_clear()
