"""The tests of a lab that a case shows beside its predictions."""

from __future__ import annotations

from functools import cached_property

from pydantic import model_validator

from wearlaw.plugins import loader
from wearlaw.settings.configuration import Configuration
from wearlaw.wear_tests.reader import parse_tests, text_of_tests
from wearlaw.wear_tests.tests import WearTests


class Measurement(Configuration):
    """Tests of a lab, to be shown beside the predictions."""

    label: str
    """What the legend calls them."""
    tests: str
    """The name of tests that a plugin ships, or the path of a CSV file, from the folder of the case file."""

    @model_validator(mode="after")
    def _readable(self) -> Measurement:
        """Find what is wrong with the tests when the case is read, not when it has run."""
        _ = self.data
        return self

    @cached_property
    def text(self) -> str:
        """The tests as CSV."""
        return text_of_tests(self.tests)

    @cached_property
    def data(self) -> WearTests:
        """The tests."""
        return parse_tests(self.text, self.tests)

    @property
    def shipped(self) -> bool:
        """Whether a plugin ships the tests; otherwise they are a file."""
        return self.tests in loader.installed().test_sets.providers
