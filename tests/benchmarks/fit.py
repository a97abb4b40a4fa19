"""Print the cost of a bootstrap, beside one that refits its replicates one by one: `python -m tests.benchmarks.fit`.

Both start from the best fit, draw the same kind of residuals, and run in one process; CPU time is counted.
"""

from __future__ import annotations

import argparse
import sys
import time
import warnings
from typing import Any

import numpy as np

import wearlaw as wl
from tests.benchmarks.coverage import CREEPAGE, FREE, made_up, pipeline
from wearlaw import Q

REPLICATES = 1000
GATE = 10.0
"""Times faster than the loop that the bootstrap must be."""


def bootstrap_seconds(predict: wl.Pipeline[...], tests: wl.WearTests) -> float:
    """Return the CPU time of the replicates alone: that of a fit with them less that of one without."""
    wl.fit(predict, tests, free=FREE, bootstrap=40)  # imports and caches
    began = time.process_time()
    wl.fit(predict, tests, free=FREE, bootstrap=0)
    middle = time.process_time()
    wl.fit(predict, tests, free=FREE, bootstrap=REPLICATES)
    return time.process_time() - middle - (middle - began)


def loop_seconds(predict: wl.Pipeline[...], tests: wl.WearTests, replicates: int) -> float:
    """Return the CPU time of REPLICATES refits with scipy through `predict(...)`, from that of some of them."""
    from scipy.optimize import least_squares

    conditions: Any = {
        "creepage": Q(CREEPAGE, "%"),
        "max_pressure": Q(1500, "MPa"),
        "friction_coefficient": 0.46,
    }
    first = wl.fit(predict, tests, free=FREE, bootstrap=0)
    units = {name: str(value.units) for name, value in first.parameters.items()}
    best = np.array([value.magnitude for value in first.parameters.values()])

    def predicted(theta: np.ndarray[Any, Any]) -> Any:
        values = zip(units.items(), best * np.exp(theta), strict=True)
        law = predict.wear_law.model_copy(update={name: Q(value, unit) for (name, unit), value in values})
        again = predict.with_law(law)
        return np.log(again(**conditions).wear_rate.to("ug/m/mm^2").magnitude)

    fitted = predicted(np.zeros(len(FREE)))
    residuals = first.residuals["residual"].to_numpy()
    generator = np.random.default_rng(0)
    began = time.process_time()
    for _ in range(replicates):
        target = fitted + generator.choice(residuals, residuals.size)
        least_squares(lambda theta, target=target: predicted(theta) - target, np.zeros(len(FREE)), x_scale="jac")
    return (time.process_time() - began) * REPLICATES / replicates


def main(arguments: list[str]) -> int:
    """Time both for each contact; return 1 if a gate is missed and `--strict` is given."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--strict", action="store_true", help="fail if a gate is missed")
    parser.add_argument("--replicates", type=int, default=50, help="how many the loop refits")
    options = parser.parse_args(arguments)
    warnings.simplefilter("ignore", wl.WearlawWarning)
    met = True
    for contact in ("global", "exact", "fastsim"):
        predict = pipeline(contact)
        tests = made_up(predict, 0.1, seed=0)
        ours, loop = bootstrap_seconds(predict, tests), loop_seconds(predict, tests, options.replicates)
        met &= loop >= GATE * ours
        print(
            f"{contact}: {REPLICATES} replicates of {CREEPAGE.size} tests take {ours:.2f} s, one by one {loop:.1f} s;"
            f" ratio {loop / ours:.0f}, at least {GATE:.0f}"
        )
    return int(options.strict and not met)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
