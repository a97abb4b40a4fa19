"""Times of rivals side by side in one process, and predictions with and without the accelerator."""

from __future__ import annotations

import importlib.util
import time
from collections.abc import Callable, Mapping

import numpy as np

import wearlaw as wl
from wearlaw import Array

SHORTEST_S = 0.02
"""A measurement repeats its work to last at least so long."""


class Times:
    """CPU seconds of each rival in each round."""

    def __init__(self, seconds: dict[str, Array]) -> None:
        self.seconds = seconds

    def median(self, name: str) -> float:
        return float(np.median(self.seconds[name]))

    def ratio(self, name: str, base: str) -> float:
        """Return the median of the per-round ratios of two rivals."""
        return float(np.median(self.seconds[name] / self.seconds[base]))


def side_by_side(rivals: Mapping[str, Callable[[], object]], rounds: int) -> Times:
    """Time every rival once a round, the order turned round from one round to the next."""
    repeats = {name: _repeats(rival) for name, rival in rivals.items()}
    seconds: dict[str, list[float]] = {name: [] for name in rivals}
    for number in range(rounds):
        for name in list(rivals) if number % 2 else reversed(list(rivals)):
            seconds[name].append(cpu_time(rivals[name], repeats[name]))
    return Times({name: np.array(values) for name, values in seconds.items()})


def cpu_time(work: Callable[[], object], repeats: int = 1) -> float:
    """Return the CPU seconds of one call, on average over some."""
    start = time.process_time()
    for _ in range(repeats):
        work()
    return (time.process_time() - start) / repeats


def _repeats(work: Callable[[], object]) -> int:
    work()  # imports, compiles, fills caches
    return max(1, int(np.ceil(SHORTEST_S / max(cpu_time(work), 1e-6))))


def modes() -> dict[str, bool]:
    """Return the ways in which wearlaw can be run here, by name: whether accelerated."""
    return {"NumPy": False, "numba": True} if importlib.util.find_spec("numba") else {"NumPy": False}


def in_mode(on: bool, work: Callable[[], object]) -> Callable[[], object]:
    """Return some work to be done with the accelerator on or off."""

    def turned() -> object:
        wl.accelerate(on)
        return work()

    return turned
