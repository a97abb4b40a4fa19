"""The results of the benchmarks, printed and written."""

from __future__ import annotations

import csv
import platform
import subprocess
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path

from tests.benchmarks.rivals import has_compiler
from tests.benchmarks.timing import modes


@dataclass(frozen=True)
class Row:
    """What one method costs and how exact it is."""

    method: str
    cells: int | None
    microseconds: float
    rms_error: float
    max_error: float


@dataclass(frozen=True)
class Gate:
    """A measured number and the most that it may be."""

    name: str
    measured: float
    limit: float

    @property
    def met(self) -> bool:
        return self.measured <= self.limit


def print_rows(rows: list[Row]) -> None:
    """Print cost and error of every method, the exact ones last."""
    print(f"\n{'method':32} {'cells':>6} {'µs/point':>10} {'rms error':>10} {'max error':>10}")
    for row in sorted(rows, key=lambda row: (row.method, row.cells or 0)):
        errors = f"{row.rms_error:10.1e} {row.max_error:10.1e}"
        print(f"{row.method:32} {row.cells or '-':>6} {row.microseconds:10.4f} {errors}")


def print_gates(gates: list[Gate]) -> None:
    """Print every gate as met or not met."""
    print(f"\n{'gate':52} {'measured':>10} {'at most':>10}")
    for gate in gates:
        print(f"{gate.name:52} {gate.measured:10.4g} {gate.limit:10.4g}  {'met' if gate.met else 'NOT MET'}")


def write(folder: Path, rows: list[Row], gates: list[Gate]) -> None:
    """Write the results that the documentation shows."""
    with (folder / "accuracy.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["method", "cells", "µs a point", "rms relative error", "largest relative error"])
        for row in sorted(rows, key=lambda row: (row.method, row.cells or 0)):
            numbers = (f"{row.microseconds:.3g}", f"{row.rms_error:.1e}", f"{row.max_error:.1e}")
            writer.writerow([row.method, row.cells or "", *numbers])
    with (folder / "accuracy-gates.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow([f"measured on {machine()}", "measured", "at most"])
        writer.writerows([gate.name, f"{gate.measured:.3g}", f"{gate.limit:g}"] for gate in gates)


def machine() -> str:
    """Return the machine and versions of the measurements."""
    parts = [_processor(), f"Python {platform.python_version()}", f"NumPy {version('numpy')}"]
    if "numba" in modes():
        parts.append(f"numba {version('numba')}")
    if has_compiler():
        shown = subprocess.run(["cc", "--version"], stdout=subprocess.PIPE, text=True, check=True).stdout
        parts.append(shown.splitlines()[0])
    return ", ".join(parts)


def _processor() -> str:
    information = Path("/proc/cpuinfo")
    if information.exists():
        for line in information.read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    return platform.processor() or platform.machine()
