"""Print what wheelsets on track cost: `python -m tests.benchmarks.wheelset [--strict] [--points 1e5]`.

The contact search is timed beside one that takes position after position with scipy: `brentq` for the roll, and
`minimize_scalar` for the least gap of either wheel, on the same profiles without yaw. Predictions are FASTSIM and USFD
with wear profiles, on strips of the normal problem "kpec". Their cost a patch leaves out the search. All in one
process, in CPU time; the sweeps have processes of their own.
"""

from __future__ import annotations

import argparse
import sys
import time
import warnings
from collections.abc import Callable
from typing import Any

import numpy as np
import scipy

import wearlaw as wl
import wearlaw_wheelset as ws
from tests.benchmarks import report
from tests.benchmarks.memory import in_fresh_process, peak_mib
from tests.benchmarks.report import Gate
from tests.benchmarks.timing import in_mode, modes, side_by_side
from tests.plugins.wheelset.wheelsets import wheelset
from wearlaw import Q
from wearlaw_wheelset._search import searched as find_contact  # private: timed without the rest

ROUNDS = 5
SIDE = 100
"""Displacements, and yaws, of the geometry."""
POSITIONS = 2000
"""Positions of a prediction, about those of a block of a sweep."""
RIVAL_POSITIONS = 40
LIMITS = {"NumPy": 150.0, "numba": 50.0}
"""Microseconds a patch."""


def main(arguments: list[str]) -> int:
    """Run all benchmarks; return 1 if a gate is missed and `--strict` is given."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--strict", action="store_true", help="fail if a gate is missed")
    parser.add_argument("--rounds", type=int, default=ROUNDS)
    parser.add_argument("--points", type=float, default=2e4, help="positions of the larger sweep")
    options = parser.parse_args(arguments)
    warnings.simplefilter("ignore", wl.WearlawWarning)
    print(report.machine())
    gates = search(options.rounds) + predictions(options.rounds)
    for name, on in modes().items():
        gates += sweeps(name, on, int(options.points))
    report.print_gates(gates)
    return int(options.strict and not all(gate.met for gate in gates))


def search(rounds: int) -> list[Gate]:
    """Return the gates of the geometry of 10 000 positions, and print its ratio to the search by scipy."""
    pair, across = wheelset(), np.linspace(-6.0, 6.0, SIDE)
    few = np.linspace(-6.0, 6.0, RIVAL_POSITIONS)
    mine = pair.geometry(lateral_displacement=Q(few, "mm")).dataset["rolling_radius_difference"].to_numpy()
    theirs = np.array([radius_difference(pair, 1e-3 * one) for one in few])
    print(f"rolling radius differences agree within {np.nanmax(np.abs(mine - 1e3 * theirs)):.1e} mm")

    def geometry() -> object:
        return pair.geometry(lateral_displacement=Q(across, "mm"), yaw=Q(np.linspace(-5.0, 5.0, SIDE), "mrad"))

    works: dict[str, Callable[[], object]] = {name: in_mode(on, geometry) for name, on in modes().items()}
    works["scipy"] = lambda: [radius_difference(pair, 1e-3 * one) for one in few]
    times = side_by_side(works, rounds)
    cost = {name: seconds.min() / SIDE**2 for name, seconds in times.seconds.items()}
    cost["scipy"] *= SIDE**2 / RIVAL_POSITIONS
    for name, one in cost.items():
        print(f"geometry, {name:6} {1e6 * one:9.1f} µs a position, {one / cost['scipy']:.5f} × scipy")
    return [Gate(f"geometry of {SIDE**2} positions, {name} [s]", SIDE**2 * cost[name], 2.0) for name in modes()]


def predictions(rounds: int) -> list[Gate]:
    """Return the gates of predictions with wear profiles, without the search."""
    pair, given = wheelset(), conditions(POSITIONS)
    predict = pipeline(pair)
    where = {name: given[name] for name in ("lateral_displacement", "yaw")}
    patches = int(np.isfinite(predict(**given).normal_force.magnitude).sum())
    works: dict[str, Callable[[], object]] = {}
    for name, on in modes().items():
        works[name] = in_mode(on, lambda: predict(**given).wear_profile("wheel"))
        works[f"{name}, search"] = in_mode(on, lambda: searched(pair, **where))
    times, gates = side_by_side(works, rounds), []
    for name in modes():
        cost = (times.seconds[name].min() - times.seconds[f"{name}, search"].min()) / patches
        gates.append(Gate(f"prediction and profile, {name} [µs a patch]", 1e6 * cost, LIMITS[name]))
    return gates


def sweeps(name: str, on: bool, points: int) -> list[Gate]:
    """Return the gates of the growth of time and memory with the number of positions, from two sweeps."""
    found = [
        in_fresh_process("tests.benchmarks.wheelset", "sweep", str(int(on)), str(n)) for n in (points // 4, points)
    ]
    for (seconds, peak), count in zip(found, (points // 4, points), strict=True):
        print(f"{name}: sweep of {count} positions, {1e6 * seconds / count:.0f} µs each, peak memory {peak:.0f} MiB")
    (before, low), (after, high) = found
    return [
        Gate(f"time of four times as many positions over four, {name}", 0.25 * after / before, 1.15),
        Gate(f"growth of the peak memory, {name} [MiB]", high - low, 64.0),
    ]


def pipeline(pair: ws.Wheelset) -> Any:
    """Return FASTSIM and USFD on a wheelset."""
    return pair | wl.contact_model("fastsim") | wl.wear_law("usfd")


def conditions(count: int) -> dict[str, Any]:
    """Return positions from flange to flange, with loads and friction."""
    draw = np.random.default_rng(18)
    return {
        "lateral_displacement": Q(draw.uniform(-6.0, 6.0, count), "mm"),
        "yaw": Q(draw.uniform(-5.0, 5.0, count), "mrad"),
        "vertical_load": Q(draw.uniform(30.0, 100.0, count), "kN"),
        "friction_coefficient": draw.uniform(0.15, 0.5, count),
    }


def searched(pair: ws.Wheelset, lateral_displacement: wl.Quantity, yaw: wl.Quantity) -> object:
    """Return where the wheels touch, as predictions find it."""
    return find_contact(pair._section, lateral_displacement.to("m").magnitude, yaw.to("rad").magnitude)


def radius_difference(pair: ws.Wheelset, displacement: float) -> float:
    """Return the rolling radius of the right wheel minus that of the left one [m], by scipy at one position."""
    section = pair._section
    wheel = scipy.interpolate.CubicSpline(section.wheel_y.value[::4], section.wheel_radius.value[::4])
    rail_y = section.rail_z.start + section.rail_z.step * np.arange(section.rail_z.value.size)
    rail = scipy.interpolate.CubicSpline(rail_y[::4], section.rail_z.value[::4])
    across = np.arange(wheel.x[0], wheel.x[-1], 0.5e-3)
    radii = wheel(across)

    def least(side: float, roll: float) -> tuple[float, float]:
        """Return the least gap, and the radius there."""
        sine, cosine = np.sin(side * roll), np.cos(roll)

        def gap(y: Any, radius: Any) -> Any:
            place = y * cosine - radius * sine + side * displacement
            there = np.where((place > rail_y[0]) & (place < rail_y[-1]), rail(place), np.inf)
            return there - (y * sine + radius * cosine)

        start = across[gap(across, radii).argmin()]
        bounds = max(start - 0.5e-3, wheel.x[0]), min(start + 0.5e-3, wheel.x[-1])
        found = scipy.optimize.minimize_scalar(
            lambda y: float(gap(y, wheel(y))), bounds=bounds, method="bounded", options={"xatol": 1e-9}
        )
        return float(found.fun), float(wheel(found.x))

    roll = scipy.optimize.brentq(lambda angle: least(1.0, angle)[0] - least(-1.0, angle)[0], -0.05, 0.05, xtol=1e-10)
    return least(1.0, roll)[1] - least(-1.0, roll)[1]


def _sweep(on: bool, count: int) -> None:
    """Print the CPU seconds and the peak memory [MiB] of a sweep."""
    wl.accelerate(on)
    predict, start = pipeline(wheelset()), time.process_time()
    wl.sweep(
        predict,
        lateral_displacement=Q(np.linspace(-6.0, 6.0, count // SIDE), "mm"),
        yaw=Q(np.linspace(-5.0, 5.0, SIDE), "mrad"),
        vertical_load=Q(60.0, "kN"),
        friction_coefficient=0.3,
    )
    print(time.process_time() - start, peak_mib())


if __name__ == "__main__":
    if sys.argv[1:2] == ["sweep"]:
        warnings.simplefilter("ignore", wl.WearlawWarning)
        _sweep(sys.argv[2] == "1", int(sys.argv[3]))
    else:
        sys.exit(main(sys.argv[1:]))
