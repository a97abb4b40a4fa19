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
from tests.benchmarks.report import Gate
from tests.benchmarks.timing import modes
from wearlaw import RangeWarning

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
    print(report.machine())
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
    """Return the gates of one way to run wearlaw."""
    peak = limits.peak_memory(on)  # first, since a process that starts another passes on its own peak
    share = limits.rim(on, rounds).ratio("conditions", "sweep")
    return [
        Gate(f"one prediction, {name}, fastest round [µs]", 1e6 * limits.scalar_seconds(on), 60.0),
        Gate(f"unit checking of {limits.SWEEP:.0e} points, {name} [%]", 100.0 * share, 1.0),
        Gate(f"peak memory of {limits.MEMORY_POINTS:.0e} points, {name} [MiB]", peak, 300.0),
    ]


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
