"""How much hypothesis searches, and the numbers of marks that tests receive.

`pytest --hypothesis-profile deep`, or `nox -s deep`, searches twenty times as long.
"""

from __future__ import annotations

import pytest
from hypothesis import settings

from docs.validation import numbers

EXAMPLES, DEEP = 10, 20

# Times of single examples vary with the machine and with what is imported first, so there is no deadline.
settings.register_profile("default", max_examples=EXAMPLES, deadline=None)
settings.register_profile("deep", max_examples=DEEP * EXAMPLES, deadline=None)
settings.load_profile("default")

# A relative tolerance is one: pytest's own floor of 1e-12 would let any value below that pass, as flexibilities in SI.
type(pytest.approx(1.0)).DEFAULT_ABSOLUTE_TOLERANCE = 0.0  # type: ignore[attr-defined]
assert pytest.approx(0.0) != 1e-13, "pytest calls its floor another name now"


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """Give a test the numbers of its mark `validates`, so that the page about validation shows what is asserted."""
    for mark in metafunc.definition.iter_markers("validates"):
        for name, value in numbers(mark).items():
            metafunc.parametrize(name, [value], ids=[f"{name}={value}"])
