"""Fixtures of the tests of files of CONTACT."""

from tests.core.conftest import blank_figures as blank_figures
