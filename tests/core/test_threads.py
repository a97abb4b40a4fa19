"""The first use of wearlaw in a process, from several threads at once."""

from __future__ import annotations

import json
import subprocess
import sys

import pytest

from tests.core import first_uses
from tests.core.first_uses import USES


def in_a_fresh_process(names: list[str]) -> list[str]:
    done = subprocess.run([sys.executable, first_uses.__file__, *names], capture_output=True, text=True, check=True)
    assert done.stderr == ""
    found: list[str] = json.loads(done.stdout)
    return found


@pytest.mark.parametrize(
    "names",
    [
        ["quantity"] * 4,
        ["predict"] * 8,
        ["json", "signature", "schema", "twin_disc"] * 2,
        ["wheel_rail", "sweep"] * 4,
        [*USES],
    ],
    ids=lambda names: f"{len(names)} threads: {', '.join(dict.fromkeys(names))}",
)
@pytest.mark.filterwarnings("ignore::wearlaw.CalibrationWarning")
def test_threads_that_begin_at_once_get_what_one_alone_gets(names: list[str]) -> None:
    assert in_a_fresh_process(names) == [USES[name]() for name in names]
