"""Print how long `import wearlaw` takes over its three foundations: `python tests/benchmarks/importing.py`."""

from __future__ import annotations

import statistics
import subprocess
import sys

GATE = 2.0
"""Measured 1.2 to 1.6 on a busy machine; with scipy.optimize it was 3.0."""
ROUNDS = 11


def seconds(modules: str) -> float:
    """Return the CPU seconds of an import in a fresh process."""
    clock = f"import time; start = time.process_time()\nimport {modules}\nprint(time.process_time() - start)"
    return float(subprocess.run([sys.executable, "-c", clock], check=True, stdout=subprocess.PIPE).stdout)


def main() -> int:
    """Time the imports in turns, print the ratio of their medians, and return 1 if the gate is missed."""
    rounds = [(seconds("wearlaw"), seconds("numpy, pydantic, pint")) for _ in range(ROUNDS)]
    wearlaw, foundations = (statistics.median(times) for times in zip(*rounds, strict=True))
    ratio = wearlaw / foundations
    print(f"import wearlaw takes {ratio:.2f} times as long as numpy, pydantic and pint, gate {GATE}")
    return int(ratio >= GATE)


if __name__ == "__main__":
    sys.exit(main())
