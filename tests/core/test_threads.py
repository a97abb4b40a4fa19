"""wearlaw in several threads at once: its first use in a process, and its warnings."""

from __future__ import annotations

import json
import subprocess
import sys
import warnings
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from threading import Barrier

import pytest

import wearlaw as wl
from tests.core import first_uses
from tests.core.first_uses import USES
from wearlaw_apps.output.notes import caught_warnings  # private: what sweeps and fits collect warnings with


def in_a_fresh_process(names: list[str]) -> list[str]:
    done = subprocess.run([sys.executable, first_uses.__file__, *names], capture_output=True, text=True, check=True)
    assert done.stderr == ""
    found: list[str] = json.loads(done.stdout)
    return found


@pytest.mark.parametrize(
    "names",
    [
        ["predict"] * 8,
        [*USES],
    ],
    ids=lambda names: f"{len(names)} threads: {', '.join(dict.fromkeys(names))}",
)
@pytest.mark.filterwarnings("ignore::wearlaw.CalibrationWarning")
def test_threads_that_begin_at_once_get_what_one_alone_gets(names: list[str]) -> None:
    assert in_a_fresh_process(names) == [USES[name]() for name in names]


@pytest.fixture
def _quick_switches() -> Iterator[None]:
    before = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    yield
    sys.setswitchinterval(before)


@pytest.mark.usefixtures("_quick_switches")
def test_a_thread_gets_its_own_warnings_only() -> None:
    together = Barrier(8)

    def caught(number: int) -> list[str]:
        found = []
        together.wait()
        for _ in range(50):
            with caught_warnings() as mine:
                warnings.warn(wl.RangeWarning(f"of {number}"), stacklevel=1)
            warnings.warn(wl.RangeWarning(f"for the caller of {number}"), stacklevel=1)
            found += [str(one) for one in mine]
        return found

    with warnings.catch_warnings(record=True) as shown:
        warnings.simplefilter("always")
        with ThreadPoolExecutor(8) as threads:
            assert list(threads.map(caught, range(8))) == [[f"of {number}"] * 50 for number in range(8)]
    assert sorted({str(one.message) for one in shown}) == [f"for the caller of {number}" for number in range(8)]
    assert len(shown) == 400
