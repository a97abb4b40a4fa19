"""Print the gain of a sweep on two processes, and the time of the worked example: `python -m tests.benchmarks.sweep`.

The gain is the time of a sweep in one process over that on two that are warm, on a machine that is otherwise idle.
`--strict` fails if it is too small, `--write` renews the picture.
"""

from __future__ import annotations

import argparse
import os
import resource
import shutil
import subprocess
import sys
import tempfile
import time
import warnings
from pathlib import Path
from typing import Any

import numpy as np

import wearlaw as wl
from wearlaw import Q

POINTS = (250, 500, 400)
"""5·10⁷ operating points: at a fifth of a microsecond each ten seconds of work."""
GAIN = 1.6
ROUNDS = 3
DOCS = Path(__file__).parents[2] / "docs"


def main(arguments: list[str]) -> int:
    """Run the benchmark; return 1 if the gain is too small and `--strict` is given."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--strict", action="store_true", help="fail if the gain is too small")
    parser.add_argument("--write", action="store_true", help="renew the picture of the documentation")
    options = parser.parse_args(arguments)
    warnings.simplefilter("ignore", wl.WearlawWarning)
    print(f"{os.cpu_count()} processors")
    example(options.write)  # first, since a process that starts another passes on its peak memory
    gain = speed_up()
    return int(options.strict and gain < GAIN)


def speed_up() -> float:
    """Print and return how many times as fast two warm processes are, the best of some rounds each."""
    predict = wl.TwinDisc.suros() | wl.contact_model("exact") | wl.wear_law("usfd", fitted_for="exact")
    loads, creepages, frictions = POINTS
    given: dict[str, Any] = {
        "normal_force": Q(np.linspace(1.0, 9.0, loads), "kN"),
        "creepage": Q(np.geomspace(0.1, 13.0, creepages), "%"),
        "friction_coefficient": np.linspace(0.1, 0.6, frictions),
    }
    small = {**given, "friction_coefficient": given["friction_coefficient"][:10]}
    best = {}
    for workers in (1, 2):
        wl.sweep(predict, **small, workers=workers)  # starts processes, loads kernels
        times = []
        for _ in range(ROUNDS):
            start = time.perf_counter()
            wl.sweep(predict, **given, workers=workers)
            times.append(time.perf_counter() - start)
            print(f"{np.prod(POINTS):.0e} points on {workers}: {times[-1]:.2f} s")
        best[workers] = min(times)
    gain = best[1] / best[2]
    print(f"two processes are {gain:.2f} times as fast as one, {'met' if gain >= GAIN else 'MISSED'}: {GAIN}")
    return gain


def example(write: bool) -> None:
    """Run the worked example in processes of its own, and print time, memory and size."""
    with tempfile.TemporaryDirectory() as folder:
        start = time.perf_counter()
        subprocess.run([sys.executable, DOCS / "examples" / "wear_map.py"], cwd=folder, check=True)
        seconds = time.perf_counter() - start
        size = sum(path.stat().st_size for path in Path(folder, "map.zarr").rglob("*") if path.is_file())
        if write:
            shutil.copy(Path(folder, "map.png"), DOCS / "pictures" / "sweep_map.png")
    peak = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 2**10
    print(
        f"the map of 10⁷ points takes {seconds:.1f} s, from the start of Python to the picture, and {size / 1e6:.0f} MB"
    )
    print(f"of disk; none of its three processes takes more than {peak:.0f} MiB of memory")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
