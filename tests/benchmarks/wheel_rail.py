"""Print what elliptic contacts cost and how exact they are: `python -m tests.benchmarks.wheel_rail [--strict]`.

FASTSIM on few nodes, as wearlaw chooses them, is timed beside Kalker's march over even cells. All in one process, in
CPU time.
"""

from __future__ import annotations

import argparse
import sys
import warnings
from collections.abc import Callable
from functools import partial

import numpy as np

import wearlaw as wl
from tests.benchmarks import report
from tests.benchmarks.memory import in_fresh_process
from tests.benchmarks.report import Gate
from tests.benchmarks.timing import in_mode, modes, side_by_side
from tests.benchmarks.wheel_rail_rivals import RIVAL_CELLS, WORKLOAD, MarchAndLaw, Outcome, workload
from wearlaw.numerics.integrate import integrate_laws  # private: without the rig
from wearlaw_fastsim import Fastsim

ROUNDS = 15
BLOCK = 128
"""Operating points that a march takes at once, which suits it best."""
POINTS = 4096
ACCURACY_POINTS = 256
REFERENCE_CELLS, REFERENCE_STRIPS = 1600, 400
DEFAULT_STRIPS = Fastsim().strips
STRIPS = (6, 8, 10, 14, 20)
RIVAL = f"march {RIVAL_CELLS} × {RIVAL_CELLS}, NumPy"


def main(arguments: list[str]) -> int:
    """Run all benchmarks; return 1 if a gate is missed and `--strict` is given."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--strict", action="store_true", help="fail if a gate is missed")
    parser.add_argument("--rounds", type=int, default=ROUNDS)
    options = parser.parse_args(arguments)
    # The workload exceeds the law's range.
    warnings.simplefilter("ignore", wl.WearlawWarning)
    print(f"{report.machine()}\n{WORKLOAD}")
    gates: list[Gate] = []
    for bound in ("parabolic", "elliptic"):
        gates += few_nodes(bound, options.rounds)
    gates += forces_alone(options.rounds)
    gates += [memory(name, on) for name, on in modes().items()]
    report.print_gates(gates)
    return int(options.strict and not all(gate.met for gate in gates))


def few_nodes(bound: str, rounds: int) -> list[Gate]:
    """Return the gates of wearlaw's own nodes beside the march in NumPy, and print those of more and fewer strips."""
    default = f"wearlaw, {DEFAULT_STRIPS} strips, NumPy"
    sample, problem = workload(ACCURACY_POINTS), workload(POINTS)
    marched = {RIVAL: RIVAL_CELLS, f"{RIVAL}, again": RIVAL_CELLS, "march 20 × 20, NumPy": 20}
    works: dict[str, Callable[[], object]] = {
        name: _march_and_law(problem, bound, count, count) for name, count in marched.items()
    }
    outcomes = {name: _march_and_law(sample, bound, count, count)() for name, count in marched.items()}
    for name, on in modes().items():
        for count in STRIPS if name == "NumPy" else (DEFAULT_STRIPS,):
            key = f"wearlaw, {count} strips, {name}"
            works[key] = in_mode(on, partial(_wearlaw, problem, bound, count))
            outcomes[key] = _wearlaw(sample, bound, count)
    times, exact = side_by_side(works, rounds), _reference(sample, bound)
    errors = {name: _errors(found, exact, sample) for name, found in outcomes.items()}
    print(f"\n{bound:30} {'µs/point':>9} {'× march':>8} {'force rms':>10} {'max':>8} {'wear rms':>10} {'max':>8}")
    for name, (force, most, wear, worst) in errors.items():
        cost = f"{1e6 * times.median(name) / POINTS:9.2f} {times.ratio(name, RIVAL)[0]:8.3f}"
        print(f"{name:30} {cost} {force:10.1e} {most:8.1e} {wear:10.1e} {worst:8.1e}")
    force, _, wear, _ = errors[default]
    return [
        Gate(f"rms error of the forces over μN, {bound}", force, 3e-3),
        Gate(f"rms error of the wear rate, {bound}", wear, 5e-3),
        Gate(f"time over the march in NumPy, {bound}", times.best_ratio(default, RIVAL), 0.4),
    ]


def forces_alone(rounds: int) -> list[Gate]:
    """Return the gates of the forces of `strip_theory`, without fields, beside those of FASTSIM."""
    problem, models = workload(POINTS), ("strip_theory", "fastsim")
    works = {
        f"{model}, {name}": in_mode(on, partial(wl.contact_model(model).creep_forces, problem))
        for model in models
        for name, on in modes().items()
    }
    times = side_by_side(works, rounds)
    strips, fastsim = ([f"{model}, {name}" for name in modes()] for model in models)
    return [
        Gate(f"time of the forces of {one} over those of FASTSIM", times.best_ratio(one, other), 2.0)
        for one, other in zip(strips, fastsim, strict=True)
    ]


def _march_and_law(problem: wl.Problem, bound: str, cells: int, strips: int, block: int = BLOCK) -> MarchAndLaw:
    return MarchAndLaw(problem, bound == "elliptic", cells, strips, block)


def _wearlaw(problem: wl.Problem, bound: str, strips: int) -> Outcome:
    model = wl.contact_model("fastsim", bound=bound, strips=strips)
    found = integrate_laws(model, (wl.wear_law("usfd", fitted_for="global"),), problem)
    assert found.forces is not None
    return found.forces.longitudinal, found.forces.lateral, found.values[0]


def _reference(problem: wl.Problem, bound: str) -> Outcome:
    """Return the limit of the march, whose error is of first order, from cells of two sizes."""
    coarse, fine = (
        _march_and_law(problem, bound, cells, REFERENCE_STRIPS, block=4)()
        for cells in (REFERENCE_CELLS // 2, REFERENCE_CELLS)
    )
    longitudinal, lateral, rate = (2.0 * b - a for a, b in zip(coarse, fine, strict=True))
    return longitudinal, lateral, rate


def _errors(found: Outcome, exact: Outcome, problem: wl.Problem) -> tuple[float, float, float, float]:
    """Return root mean square and maximum of the errors of the force over μN, and of the relative ones of the wear."""
    limit = problem.friction_coefficient * problem.normal_force
    force = np.hypot(found[0] - exact[0], found[1] - exact[1]) / limit
    wear = found[2] / exact[2] - 1.0
    rms_force, rms_wear = (float(np.sqrt(np.mean(error * error))) for error in (force, wear))
    return rms_force, float(force.max()), rms_wear, float(np.abs(wear).max())


def memory(name: str, on: bool) -> Gate:
    """Return the gate on the peak memory of many operating points in a process of their own."""
    before, peak, seconds, points = in_fresh_process("tests.benchmarks.wheel_rail_memory", str(int(on)))
    print(f"{name}: {points:.0e} points, {seconds:.0f} s of CPU; peak memory {before:.0f} MiB before, {peak:.0f} after")
    return Gate(f"peak memory of {points:.0e} points, {name} [MiB]", peak, 1024.0)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
