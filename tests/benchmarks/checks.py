"""Print the cost of checking contacts as they are solved: `python -m tests.benchmarks.checks [--strict]`.

Sweeps run with the checks, whose own seconds are counted: a sweep's time differs by more than they take from one run
to the next.
"""

from __future__ import annotations

import argparse
import sys
import time
import warnings
from collections.abc import Callable
from typing import Any
from unittest import mock

import numpy as np

import wearlaw as wl
from tests.benchmarks import report
from tests.benchmarks.report import Gate
from tests.benchmarks.timing import in_mode, modes
from wearlaw import Q
from wearlaw.numerics.solving import Solver

ROUNDS = 15
LIMIT = 1.03
"""Time with the checks over the time without."""
SIDE = 400
"""Operating points along each of two axes."""


def sweeps() -> dict[str, Callable[[], object]]:
    """Return sweeps whose contacts have nodes, on a line and on an ellipse."""
    discs = wl.TwinDisc.suros() | wl.contact_model("exact") | wl.wear_law("kth")
    wheel = wl.WheelRail(wheel_radius="460 mm", rail_head_radius="300 mm", material=wl.steel(), rolling_speed="30 m/s")
    rail = wheel | wl.contact_model("fastsim") | wl.wear_law("usfd")
    on_discs: dict[str, Any] = {
        "normal_force": Q(np.linspace(1.0, 20.0, SIDE), "kN"),
        "creepage": Q(np.linspace(0.1, 20.0, SIDE), "%"),
    }
    on_rail: dict[str, Any] = {
        "normal_force": Q(np.linspace(30.0, 120.0, SIDE), "kN"),
        "longitudinal_creepage": Q(np.linspace(0.01, 2.0, SIDE), "%"),
        "lateral_creepage": "0.1 %",
        "spin": "0.1 1/m",
    }
    return {
        "exact, kth": lambda: wl.sweep(discs, **on_discs, friction_coefficient=0.4),
        "fastsim on an ellipse, usfd": lambda: wl.sweep(rail, **on_rail, friction_coefficient=0.3),
    }


def times(work: Callable[[], object]) -> tuple[float, float]:
    """Return the seconds of some work, and those of the checks of contacts among them."""
    in_checks: list[float] = []
    check = Solver.check

    def timed(*arguments: Any, **options: Any) -> None:
        start = time.perf_counter()
        check(*arguments, **options)
        in_checks.append(time.perf_counter() - start)

    with mock.patch.object(Solver, "check", timed):
        start = time.perf_counter()
        work()
        return time.perf_counter() - start, sum(in_checks)


def main(arguments: list[str]) -> int:
    """Run all benchmarks; return 1 if a gate is missed and `--strict` is given."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--strict", action="store_true", help="fail if a gate is missed")
    parser.add_argument("--rounds", type=int, default=ROUNDS)
    options = parser.parse_args(arguments)
    warnings.simplefilter("ignore", wl.WearlawWarning)
    gates = []
    for sweep, work in sweeps().items():
        for mode, on in modes().items():
            run = in_mode(on, work)
            run()  # imports, compiles
            ratios = [spent / (spent - checks) for spent, checks in (times(run) for _ in range(options.rounds))]
            low, middle, high = np.quantile(ratios, [0.25, 0.5, 0.75])
            print(f"{sweep}, {mode}: {middle:.3f} of the time without checks ({low:.3f} to {high:.3f})")
            gates.append(Gate(f"time with checks over without, {sweep}, {mode}", float(middle), LIMIT))
    report.print_gates(gates)
    return int(options.strict and not all(gate.met for gate in gates))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
