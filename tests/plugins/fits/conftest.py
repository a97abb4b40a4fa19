"""Fixtures of the core's tests, for the tests of fits."""

from tests.core.conftest import blank_figures, folder, folder_with_tests, install, install_model  # noqa: F401
