"""Print what it costs to check contacts as they are solved: `python -m tests.benchmarks.checks [--strict]`.

The same sweeps run with the checks of contacts and without, in turns, in one process; CPU time is counted.
"""

from __future__ import annotations

import argparse
import sys
import warnings
from collections.abc import Callable
from typing import Any
from unittest import mock

import numpy as np

import wearlaw as wl
from tests.benchmarks import report
from tests.benchmarks.report import Gate
from tests.benchmarks.timing import in_mode, modes, side_by_side
from wearlaw import Q
from wearlaw.solving import Solver

ROUNDS = 31
LIMIT = 1.03
"""Time with the checks over the time without."""
SIDE = 250
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
        "exact, kth": lambda: discs.sweep(**on_discs, friction_coefficient=0.4),
        "fastsim on an ellipse, usfd": lambda: rail.sweep(**on_rail, friction_coefficient=0.3),
    }


def unchecked(work: Callable[[], object]) -> Callable[[], object]:
    """Return the same work without checks of contacts."""

    def run() -> object:
        with mock.patch.object(Solver, "check", _nothing):  # a mock would keep every contact in memory
            return work()

    return run


def _nothing(*_: object, **__: object) -> None:
    """Check nothing."""


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
            times = side_by_side({"checked": in_mode(on, work), "not": in_mode(on, unchecked(work))}, options.rounds)
            middle, low, high = times.ratio("checked", "not")
            print(f"{sweep}, {mode}: {middle:.3f} of the time without checks ({low:.3f} to {high:.3f})")
            gates.append(Gate(f"time with checks over without, {sweep}, {mode}", middle, LIMIT))
    report.print_gates(gates)
    return int(options.strict and not all(gate.met for gate in gates))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
