"""Print the cost of the shipped study, from the command to the report: `python tests/benchmarks/study.py`."""

from __future__ import annotations

import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

BUDGET_S = 60.0
"""On two cores."""
BUDGET_MIB = 1024.0


def main() -> int:
    """Run the study in a process of its own, print time, peak memory and sizes, and return 1 if a budget is missed."""
    with tempfile.TemporaryDirectory() as folder:
        command = [str(Path(sys.executable).parent / "wearlaw"), "run", "tassini2010", "-o", "out"]
        start = time.perf_counter()
        subprocess.run(command, cwd=folder, check=True, capture_output=True)
        spent = time.perf_counter() - start
        sizes = {path.name: path.stat().st_size / 2**20 for path in (Path(folder) / "out").glob("*.*")}
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    peak = usage.ru_maxrss / (2**20 if sys.platform == "darwin" else 2**10)
    cpu = usage.ru_utime + usage.ru_stime
    print(f"wearlaw run tassini2010 takes {spent:.1f} s of {BUDGET_S:g} s, {cpu:.1f} s of them on the processor")
    print(f"its peak memory is {peak:.0f} MiB of {BUDGET_MIB:g} MiB")
    for name, size in sizes.items():
        print(f"{name:12} {size:6.2f} MiB")
    return int(spent > BUDGET_S or peak > BUDGET_MIB)


if __name__ == "__main__":
    sys.exit(main())
