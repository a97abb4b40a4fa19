"""Sweeps on several processes of one machine: the same results, whatever happens to the processes."""

from __future__ import annotations

import os
import platform
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import wearlaw as wl
from tests.plugins.sweeps.sweeps import CONDITIONS, OUTPUTS, Failing, deadly, ending, predictor
from tests.plugins.sweeps.test_sweep_outcomes import FINE, STAGED, swept
from tests.plugins.sweeps.test_sweep_wear_profile import GIVEN, PREDICT, TABLE
from wearlaw import (
    Q,
    kernels,  # private: which kernels a worker chose
)
from wearlaw.errors import ModelError, SweepError, WorkerWarning

pytestmark = pytest.mark.usefixtures("small_blocks")


@pytest.mark.validates(
    "reproducibility",
    "A sweep on several processes",
    source="the same sweep in one",
    held_to="to the byte",
)
def test_several_processes_give_the_same_bytes_as_one() -> None:
    predict = predictor()
    one = wl.sweep(predict, **CONDITIONS, outputs=OUTPUTS)
    two = wl.sweep(predict, **CONDITIONS, outputs=OUTPUTS, workers=2)
    assert one.identical(two)
    assert one.wear_rate.to_numpy().tobytes() == two.wear_rate.to_numpy().tobytes()


def test_several_processes_give_the_same_outcomes_of_all_laws() -> None:
    xr.testing.assert_identical(swept(STAGED, **FINE), swept(STAGED, **FINE, workers=2))


@pytest.mark.filterwarnings("ignore::wearlaw.RangeWarning", "ignore::wearlaw.CalibrationWarning")
def test_several_processes_give_the_same_sum_across_a_profile() -> None:
    one, two = (wl.wear_profiles(PREDICT, TABLE, share="share [%]", workers=count, **GIVEN) for count in (1, 2))
    assert np.array_equal(one["depth"], two["depth"])


MEMORY = """
import contextlib
import resource
import numpy as np
from wearlaw_apps.sweeps import workers
with contextlib.suppress(EOFError):
    workers._evaluated_elsewhere(b"", None, None, None)
faults = []
for _ in range(200):
    np.ones(2**17)
    faults.append(resource.getrusage(resource.RUSAGE_SELF).ru_minflt)
print(faults[-1] - faults[100])
"""  # private: what workers of dask call, here without a job


@pytest.mark.skipif(platform.libc_ver()[0] != "glibc", reason="other libraries have other ways")
def test_workers_of_dask_keep_the_memory_that_arrays_leave() -> None:
    """A MiB that is given back and asked for again is 256 faults of pages, and a hundred times as much 25 600."""
    given = os.environ | {"MALLOC_TRIM_THRESHOLD_": "65536"}
    run = subprocess.run([sys.executable, "-c", MEMORY], env=given, check=True, capture_output=True, text=True)
    assert int(run.stdout) < 256


def test_a_worker_that_dies_is_reported_and_its_block_evaluated_again(tmp_path: Path) -> None:
    predict = deadly(tmp_path / "die once")
    with pytest.warns(WorkerWarning, match="died"):
        swept = wl.sweep(predict, **CONDITIONS, outputs=OUTPUTS, workers=2)
    xr.testing.assert_equal(swept, wl.sweep(predict, **CONDITIONS, outputs=OUTPUTS))


@pytest.mark.filterwarnings("ignore::wearlaw.errors.WorkerWarning")
def test_a_sweep_whose_workers_die_again_and_again_is_given_up(tmp_path: Path) -> None:
    predict = deadly(tmp_path / "die always", always=True)
    with pytest.raises(SweepError, match="given up"):
        wl.sweep(predict, **{**CONDITIONS, "normal_force": Q([2.0, 5.0], "kN"), "friction_coefficient": 0.3}, workers=2)


def test_what_a_model_raises_in_a_worker_is_raised_here() -> None:
    failing = predictor(Failing(slope=Q(1.0, "mm")))
    with pytest.raises(ModelError, match="wear law 'failing' failed: OverflowError: too much"):
        wl.sweep(failing, **CONDITIONS, workers=2)
    assert wl.sweep(predictor(), **CONDITIONS, workers=2).wear_rate.notnull().all()


def test_what_would_end_a_worker_is_an_error_here() -> None:
    with pytest.raises(ModelError, match="SystemExit: 0"):
        wl.sweep(ending(), **CONDITIONS, workers=2)


class Choosing(Failing):
    """A law that gives wear only where compiled kernels are turned off."""

    name = "choosing"

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> wl.Array:
        return abs(contact.slip) * (kernels.chosen() is False)


def test_compiled_kernels_are_turned_off_in_workers_where_they_are_here() -> None:
    turned_off = predictor(Choosing(slope=Q(1.0, "mm")))
    assert (wl.sweep(turned_off, **CONDITIONS, workers=2).wear_rate > 0).all()
    wl.accelerate(None)
    assert (wl.sweep(turned_off, **CONDITIONS, workers=2).wear_rate == 0).all()


SCRIPT = """
import numpy as np
import wearlaw as wl
from wearlaw_apps.sweeps import plan, points

points.BLOCK, plan.START_S = 3, 0.0
wl.accelerate(False)

class Mine(wl.WearLaw):
    name = "mine"
    source = "a test"

    def rate(self, contact, p):
        print("evaluated")
        return abs(contact.slip)

given = dict(creepage=wl.Q(np.linspace(1, 2, 9), "%"), normal_force="5 kN", friction_coefficient=0.3)
predict = wl.TwinDisc.suros() | wl.contact_model("global") | wl.wear_law("usfd")
print(wl.sweep(predict, **given, workers=2).wear_rate.size)
try:
    wl.sweep(wl.TwinDisc.suros() | wl.contact_model("global") | Mine(), **given, workers=2)
except wl.InputError as error:
    print(error)
"""


def test_a_script_needs_no_guard_and_laws_of_its_own_are_refused_with_a_reason(tmp_path: Path) -> None:
    script = tmp_path / "script.py"
    script.write_text(SCRIPT, encoding="utf-8")
    done = subprocess.run([sys.executable, "-W", "error", script], capture_output=True, text=True, check=True)
    first, second = done.stdout.splitlines()
    assert first == "9"
    assert second.startswith("mine: is defined in the running script or notebook")
    assert done.stderr == ""


@pytest.mark.skipif(not Path("/proc/self").is_dir(), reason="child processes are listed in /proc")
def test_workers_end_with_a_parent_that_is_killed(tmp_path: Path) -> None:
    script = tmp_path / "killed.py"
    script.write_text("""\
import os, signal
from pathlib import Path
import wearlaw as wl
from wearlaw_apps.sweeps import plan, points

points.BLOCK, plan.START_S = 1, 0.0
predict = wl.TwinDisc.suros() | wl.contact_model("global") | wl.wear_law("usfd")
wl.sweep(predict, max_pressure="1500 MPa", creepage=wl.Q([1.0, 2.0], "%"), friction_coefficient=[0.3, 0.4], workers=2)
print(len([child for task in Path("/proc/self/task").iterdir() for child in (task / "children").read_text().split()]))
os.kill(os.getpid(), signal.SIGKILL)
""")
    # This returns once no process has the pipe any more; the workers got it from their parent.
    killed = subprocess.run([sys.executable, script], stdout=subprocess.PIPE, text=True, timeout=60)
    assert killed.returncode == -signal.SIGKILL
    assert int(killed.stdout) >= 2
