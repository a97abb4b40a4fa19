"""With which bounds, and in which copies, the tests of FASTSIM run."""

from __future__ import annotations

import importlib.util

import pytest

COMPILED = [False, True] if importlib.util.find_spec("numba") else [False]

each_bound = pytest.mark.parametrize("elliptic", [False, True], ids=["parabolic", "elliptic"])
