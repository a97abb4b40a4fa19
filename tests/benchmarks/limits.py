"""What a single prediction costs, what units cost, and how much memory many operating points take."""

from __future__ import annotations

import resource
import subprocess
import sys
import warnings
from pathlib import Path

import wearlaw as wl
from tests.benchmarks.points import DEFAULT_FORCE, DEFAULT_FRICTION, pipeline, workload
from tests.benchmarks.timing import Times, cpu_time, in_mode, side_by_side
from wearlaw import Q, RangeWarning

SWEEP = 10**5
MEMORY_POINTS = 10**6


def scalar_seconds(on: bool, rounds: int = 101, calls: int = 100) -> float:
    """Return the CPU seconds of one prediction from Quantities built beforehand, in the fastest round.

    A time in seconds, unlike a ratio, holds for an undisturbed machine only, which the fastest round comes closest to.
    """
    wl.accelerate(on)
    predict = pipeline()
    load, creepage = Q(DEFAULT_FORCE, "N"), Q(1.0, "%")

    def once() -> object:
        return predict(normal_force=load, creepage=creepage, friction_coefficient=DEFAULT_FRICTION).wear_rate

    once()
    return min(cpu_time(once, calls) for _ in range(rounds))


def rim(on: bool, rounds: int) -> Times:
    """Return the times of a sweep and, in it, of the conditions' way from Quantities to checked SI arrays."""
    predict, conditions = pipeline(), workload(SWEEP).conditions()
    works = {
        "sweep": in_mode(on, lambda: predict(**conditions).wear_rate),
        "conditions": lambda: wl.TwinDisc.in_si(conditions, lambda arrays: arrays["creepage"]),
    }
    return side_by_side(works, rounds)


def peak_memory(on: bool) -> float:
    """Return the peak memory [MiB] of a fresh process that predicts at `MEMORY_POINTS`."""
    # The peak that a process reports includes that of the one which started it, so a small one does that.
    launcher = "import subprocess, sys; sys.exit(subprocess.run(sys.argv[1:]).returncode)"
    command = [sys.executable, "-c", launcher, sys.executable, "-m", "tests.benchmarks.limits", str(int(on))]
    project = Path(__file__).parents[2]
    return float(subprocess.run(command, cwd=project, stdout=subprocess.PIPE, text=True, check=True).stdout)


if __name__ == "__main__":
    warnings.simplefilter("ignore", RangeWarning)
    wl.accelerate(sys.argv[1] == "1")
    _ = pipeline()(**workload(MEMORY_POINTS).conditions()).wear_rate
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    print(peak / (2**20 if sys.platform == "darwin" else 2**10))
