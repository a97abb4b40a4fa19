"""The memory that a process of its own takes."""

from __future__ import annotations

import resource
import subprocess
import sys
from pathlib import Path


def peak_mib() -> float:
    """Return the peak memory of this process so far."""
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak / (2**20 if sys.platform == "darwin" else 2**10)


def in_fresh_process(module: str, *arguments: str) -> list[float]:
    """Return the numbers that a module prints, whose process does not pass for larger than it is."""
    # The peak that a process reports includes that of the one which started it, so a small one does that.
    launcher = "import subprocess, sys; sys.exit(subprocess.run(sys.argv[1:]).returncode)"
    command = [sys.executable, "-c", launcher, sys.executable, "-m", module, *arguments]
    project = Path(__file__).parents[2]
    printed = subprocess.run(command, cwd=project, stdout=subprocess.PIPE, text=True, check=True).stdout
    return [float(number) for number in printed.split()]
