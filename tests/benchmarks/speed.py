"""Print what wear rates cost and how exact they are, beside rivals: `python -m tests.benchmarks.speed [--strict]`.

All rivals run in one process, and CPU time is counted, of all threads. `--write` renews the files that the page on
accuracy and speed shows.
"""

from __future__ import annotations

import argparse
import sys
import warnings
from pathlib import Path

from tests.benchmarks import limits, report
from tests.benchmarks.contest import compare, curve
from tests.benchmarks.points import WORKLOAD
from tests.benchmarks.report import Gate
from tests.benchmarks.timing import modes
from wearlaw import RangeWarning
from wearlaw.numerics.integrate import BLOCK  # private: memory is counted in blocks

ROUNDS = 15
DOCS = Path(__file__).parents[2] / "docs"


def main(arguments: list[str]) -> int:
    """Run all benchmarks; return 1 if a gate is missed and `--strict` is given."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--strict", action="store_true", help="fail if a gate is missed")
    parser.add_argument("--write", action="store_true", help="renew the files of the documentation")
    parser.add_argument("--rounds", type=int, default=ROUNDS)
    options = parser.parse_args(arguments)
    # The workload goes beyond the wear-index densities of the tests that the law was fitted to.
    warnings.simplefilter("ignore", RangeWarning)
    print(f"{report.machine()}\n{WORKLOAD}")
    rows, gates = compare(options.rounds)
    rows += curve()
    report.print_rows(rows)
    for name, on in modes().items():
        gates += budgets(name, on, options.rounds)
    report.print_gates(gates)
    if options.write:
        report.write(DOCS, rows, gates)
    return int(options.strict and not all(gate.met for gate in gates))


def budgets(name: str, on: bool, rounds: int) -> list[Gate]:
    """Return the gates of one way to run wearlaw, and print how its cost grows."""
    before, peak = limits.peak_memory(on)
    times = limits.rim(on, rounds)
    share, low, high = times.ratio("conditions", "sweep")
    print(f"{name}: conditions take {share:.2%} of a sweep ({low:.2%} to {high:.2%})")
    print(
        f"{name}: peak memory {before:.0f} MiB before the sweep of {limits.MEMORY_POINTS:.0e} points, {peak:.0f} after"
    )
    faults, pages = limits.page_faults(on)
    print(
        f"{name}: a warm sweep of {limits.SWEEP:.0e} points has {faults:.1f} page faults, its results fill {pages:.1f}"
    )
    seconds, exponent = limits.linearity(on)
    for count, spent in seconds.items():
        print(f"{name}: {count:.0e} points {1e9 * spent / count:9.1f} ns a point")
    print(f"{name}: time grows as points to the power {exponent:.3f}")
    fastest, median = limits.scalar_seconds(on)
    print(f"{name}: one prediction takes {1e6 * fastest:.1f} µs in the fastest round, {1e6 * median:.1f} in the median")
    return [
        Gate(f"one prediction, {name}, fastest round [µs]", 1e6 * fastest, 60.0),
        Gate(f"unit checking of {limits.SWEEP:.0e} points, {name} [%]", 100.0 * share, 1.0),
        # fewer than one temporary of one block would cost
        Gate(
            f"page faults of temporaries of {limits.SWEEP:.0e} points, {name}", faults - pages, BLOCK * 8 / limits.PAGE
        ),
        Gate(f"peak memory of {limits.MEMORY_POINTS:.0e} points, {name} [MiB]", peak, 300.0),
    ]


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
