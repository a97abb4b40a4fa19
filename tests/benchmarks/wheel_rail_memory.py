"""The peak memory of many operating points of a wheel on a rail: `python -m tests.benchmarks.wheel_rail_memory 1`."""

from __future__ import annotations

import sys
import time
import warnings
from typing import Any

import numpy as np

import wearlaw as wl
from tests.benchmarks.memory import peak_mib
from wearlaw import Q

FEW, POINTS = 10**3, 10**6


def conditions(count: int) -> dict[str, Any]:
    """Return conditions that vary in everything that the rig leaves open."""
    rng = np.random.default_rng(19820102)
    return {
        "normal_force": Q(rng.uniform(20.0, 120.0, count), "kN"),
        "friction_coefficient": rng.uniform(0.1, 0.5, count),
        "longitudinal_creepage": Q(np.exp(rng.uniform(np.log(1e-4), np.log(3e-2), count)), ""),
        "lateral_creepage": Q(np.exp(rng.uniform(np.log(1e-4), np.log(3e-2), count)), ""),
        "spin": Q(rng.uniform(0.0, 1.0, count), "1/m"),
    }


def main() -> None:
    """Print the peak after few and after many points, the CPU seconds of the many, and their number."""
    warnings.simplefilter("ignore", wl.WearlawWarning)
    wl.accelerate(sys.argv[1] == "1")
    rig = wl.WheelRail(
        wheel_radius=Q(460, "mm"),
        rail_head_radius=Q(300, "mm"),
        wheel_profile_radius=Q(np.inf, "mm"),
        material=wl.steel(),
        rolling_speed=Q(30, "m/s"),
    )
    predict = rig | wl.contact_model("fastsim") | wl.wear_law("usfd")
    _ = predict(**conditions(FEW)).wear_rate
    before, given, start = peak_mib(), conditions(POINTS), time.process_time()
    _ = predict(**given).wear_rate
    print(before, peak_mib(), time.process_time() - start, POINTS)


if __name__ == "__main__":
    main()
