"""Print how long the conformance kit takes for each model: `python tests/benchmarks/kit.py [NAME ...]`."""

from __future__ import annotations

import sys
import time

import wearlaw as wl
from wearlaw_kit import checks

BUDGET_S = 20.0
"""For one law on two cores."""


def main(names: list[str]) -> None:
    """Time the kit on the installed models, or on those named."""
    for name in names or [*wl.wear_laws(), *wl.contact_models()]:
        model = wl.wear_law(name) if name in wl.wear_laws() else wl.contact_model(name)
        found, start = list(checks(model)), time.perf_counter()
        slowest = (0.0, "")
        for check in found:
            before = time.perf_counter()
            check()
            slowest = max(slowest, (time.perf_counter() - before, check.name))
        spent = time.perf_counter() - start
        print(
            f"{name:10} {len(found):3} checks {spent:6.2f} s of {BUDGET_S:g} s; slowest {slowest[1]} {slowest[0]:.2f} s"
        )


if __name__ == "__main__":
    main(sys.argv[1:])
