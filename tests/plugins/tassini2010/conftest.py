"""The bench of the paper, which several test files share."""

from __future__ import annotations

from typing import Any

import pytest

import wearlaw as wl


@pytest.fixture(scope="session")
def bench() -> Any:
    """Return the rig of Tassini et al. (2010) under their load and friction."""
    from wearlaw_apps.papers.tassini2010.bench import (
        Bench,  # private: here, since tests of other plugins do not need it
    )

    return Bench(wl.TwinDisc.suros())
