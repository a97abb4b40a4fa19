"""Fixtures of the core's tests, for the tests of studies."""

from tests.core.conftest import blank_figures, folder_with_tests, point, small_blocks, validator  # noqa: F401
