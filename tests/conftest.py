"""How much hypothesis searches, the numbers of marks that tests receive, and fixtures of tests of all parts.

`pytest --hypothesis-profile deep`, or `nox -s deep`, searches twenty times as long.
"""

from __future__ import annotations

import importlib
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import settings

from docs.validation import numbers
from tests.cases import InstallModel, installer
from tests.core.distributions import Install, write_distribution
from wearlaw import loader  # private: a distribution of a test is found as if it were installed

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


@pytest.fixture
def install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Install]:
    """Give what installs a distribution of one plugin until the test ends."""
    known = set(sys.modules)
    monkeypatch.syspath_prepend(tmp_path)

    def write(name: str, source: str, version: str = "1.0") -> None:
        write_distribution(tmp_path, name, source, version)
        importlib.invalidate_caches()
        loader._FOUND.clear()

    loader._FOUND.clear()
    yield write
    for module in set(sys.modules) - known:
        if (
            getattr(sys.modules[module], "__file__", None)
            and tmp_path in Path(str(sys.modules[module].__file__)).parents
        ):
            del sys.modules[module]
    loader._FOUND.clear()


@pytest.fixture
def install_model(monkeypatch: pytest.MonkeyPatch) -> InstallModel:
    """Give what puts a model among the installed ones until the test ends."""
    return installer(monkeypatch)


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Work in a new folder with a space in its name."""
    here = tmp_path / "my work"
    here.mkdir()
    monkeypatch.chdir(here)
    return here
