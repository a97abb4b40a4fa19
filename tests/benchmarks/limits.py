"""What a single prediction costs, what units cost, how much memory a sweep takes, and how its time grows."""

from __future__ import annotations

import resource
import sys
import warnings
from functools import partial
from typing import Any

import numpy as np

import wearlaw as wl
from tests.benchmarks.memory import in_fresh_process, peak_mib
from tests.benchmarks.points import DEFAULT_FORCE, DEFAULT_FRICTION, Predict, pipeline, workload
from tests.benchmarks.timing import Times, cpu_time, in_mode, side_by_side
from wearlaw import Q, RangeWarning
from wearlaw.contact.conditions import condition_arrays
from wearlaw_twin_disc import TWIN_DISC

DECADES = (10**3, 10**4, 10**5, 10**6, 10**7)
SWEEP = 10**5
MEMORY_POINTS = 10**6
PAGE = resource.getpagesize()
WARM_UP, KEPT = 5, 20
"""Sweeps before and while page faults are counted."""

RESULTS = 5
"""Arrays of a prediction: load per width, half-width, maximum pressure, and the wear rate in SI and in its unit."""


def scalar_seconds(on: bool, rounds: int = 101, calls: int = 100) -> tuple[float, float]:
    """Return the CPU seconds of one prediction from Quantities built beforehand: fastest round, and median.

    A time in seconds, unlike a ratio, holds for an undisturbed machine only, which the fastest round comes closest to.
    """
    wl.accelerate(on)
    predict = pipeline()
    load, creepage = Q(DEFAULT_FORCE, "N"), Q(1.0, "%")

    def once() -> object:
        return predict(normal_force=load, creepage=creepage, friction_coefficient=DEFAULT_FRICTION).wear_rate

    once()
    times = [cpu_time(once, calls) for _ in range(rounds)]
    return min(times), float(np.median(times))


def rim(on: bool, rounds: int) -> Times:
    """Return the times of a sweep and, in it, of the conditions' way from Quantities to checked SI arrays."""
    predict, conditions = pipeline(), workload(SWEEP).conditions()
    works = {
        "sweep": in_mode(on, lambda: predict(**conditions).wear_rate),
        "conditions": lambda: condition_arrays(conditions, TWIN_DISC, lambda arrays: arrays["creepage"]),
    }
    return side_by_side(works, rounds)


def peak_memory(on: bool) -> tuple[float, float]:
    """Return the peak memory [MiB] of a fresh process after a small sweep and after that of `MEMORY_POINTS`."""
    before, after = in_fresh_process("tests.benchmarks.limits", "peaks", str(int(on)))
    return before, after


def page_faults(on: bool) -> tuple[float, float]:
    """Return the minor page faults of a warm sweep of `SWEEP` points, and how many of them its results account for.

    The results of all sweeps are kept, so that each needs new memory for its own, and only for them unless temporaries
    go back to the system.
    """
    (faults,) = in_fresh_process("tests.benchmarks.limits", "faults", str(int(on)))
    return faults, RESULTS * SWEEP * np.dtype(np.float64).itemsize / PAGE


def linearity(on: bool) -> tuple[dict[int, float], float]:
    """Return the CPU seconds of sweeps by number of points, and the exponent fitted to them."""
    wl.accelerate(on)
    predict, seconds = pipeline(), {}
    predict(**workload(DECADES[0]).conditions())
    for count in DECADES:
        sweep = partial(_sweep, predict, workload(count).conditions())
        seconds[count] = float(np.median([cpu_time(sweep) for _ in range(max(3, SWEEP // count))]))
    exponent, _ = np.polyfit(np.log(list(seconds)), np.log(list(seconds.values())), 1)
    return seconds, float(exponent)


def _sweep(predict: Predict, conditions: dict[str, Any]) -> object:
    return predict(**conditions).wear_rate


def _print_peaks() -> None:
    predict = pipeline()
    _sweep(predict, workload(DECADES[0]).conditions())
    before = peak_mib()
    _sweep(predict, workload(MEMORY_POINTS).conditions())
    print(before, peak_mib())


def _print_faults() -> None:
    predict, conditions, kept, before = pipeline(), workload(SWEEP).conditions(), [], 0
    for number in range(WARM_UP + KEPT):
        if number == WARM_UP:
            before = resource.getrusage(resource.RUSAGE_SELF).ru_minflt
        prediction = predict(**conditions)
        kept.append((prediction, prediction.wear_rate))
    print((resource.getrusage(resource.RUSAGE_SELF).ru_minflt - before) / KEPT)


if __name__ == "__main__":
    warnings.simplefilter("ignore", RangeWarning)
    wl.accelerate(sys.argv[2] == "1")
    {"peaks": _print_peaks, "faults": _print_faults}[sys.argv[1]]()
