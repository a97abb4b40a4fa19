"""Fixtures that the tests of the core share."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

import wearlaw as wl
from wearlaw import kernels  # private: the choice between NumPy and numba


@pytest.fixture
def by_size_again(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Begin and end with the choice of kernels by size, whatever the environment says."""
    monkeypatch.delenv(kernels.SETTING, raising=False)
    wl.accelerate(None)
    yield
    wl.accelerate(None)
