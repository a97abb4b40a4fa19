"""Fixtures of the core's tests, for the tests of output."""

from tests.core.conftest import (  # noqa: F401
    blank_figures,
    folder,
    folder_with_tests,
    install,
    install_model,
    point,
    small_blocks,
    validator,
)
