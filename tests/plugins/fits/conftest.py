"""Fixtures of the core's tests, for the tests of fits."""

from tests.core.conftest import blank_figures, folder_with_tests  # noqa: F401
