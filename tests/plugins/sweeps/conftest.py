"""Fixtures of the core's tests, for the tests of sweeps."""

from tests.core.conftest import blank_figures, small_blocks  # noqa: F401
