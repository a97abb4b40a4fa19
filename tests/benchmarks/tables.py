"""Print the rows per second and the memory of sweeps over tables: `python -m tests.benchmarks.tables [ROWS ...]`.

A table of conditions of twin discs or of a wheel on a rail is swept from CSV, from parquet (with pyarrow), and from
arrays in memory, each into a store and in a fresh process.
"""

from __future__ import annotations

import importlib.util
import sys
import tempfile
import time
import warnings
from pathlib import Path
from typing import Any

import numpy as np

import wearlaw as wl
from tests.benchmarks.memory import in_fresh_process, peak_mib

KINDS = ("arrays", "csv", "parquet")
RIGS: dict[str, dict[str, tuple[str, float, float]]] = {
    "twin_disc": {"creepage": ("%", 0.1, 10.0), "normal_force": ("kN", 2.0, 9.0)},
    "wheel_rail": {
        "normal_force": ("kN", 30.0, 70.0),
        "longitudinal_creepage": ("%", -0.3, 0.3),
        "lateral_creepage": ("%", -0.3, 0.3),
        "spin": ("1/m", -0.3, 0.3),
    },
}
"""Units and ends of the conditions of each rig."""
BESIDE = 6
"""Columns that are in the file and are not used."""
PIECE = 500_000
MODULE = "tests.benchmarks.tables"


def main(arguments: list[str]) -> None:
    """Print the measurements."""
    sizes = [int(float(one)) for one in arguments] or [10**6]
    with tempfile.TemporaryDirectory() as folder:
        for rig in RIGS:
            for rows in sizes:
                for kind in KINDS:
                    if kind == "parquet" and importlib.util.find_spec("pyarrow") is None:
                        continue
                    if kind != "arrays":
                        make(kind, rig, rows, Path(folder, f"run.{kind}"))
                    seconds, peak = in_fresh_process(MODULE, kind, rig, str(rows), folder)
                    rate = f"{rows / seconds:,.0f} rows per second of the processor"
                    print(f"{rig}, {rows:.0e} rows, {kind}: {rate}, peak {peak:.0f} MiB", flush=True)


def columns(rig: str, rows: int, seed: int) -> dict[str, Any]:
    """Return columns of a table by their heads."""
    random = np.random.default_rng(seed)
    used = {f"{name} [{unit}]": random.uniform(low, high, rows) for name, (unit, low, high) in RIGS[rig].items()}
    return used | {f"other {number} [m]": random.normal(size=rows) for number in range(BESIDE)}


def make(kind: str, rig: str, rows: int, path: Path) -> None:
    """Write a table to a file, piece by piece."""
    import pandas as pd

    path.unlink(missing_ok=True)
    if kind == "csv":
        for start in range(0, rows, PIECE):
            frame = pd.DataFrame(columns(rig, min(PIECE, rows - start), start))
            frame.to_csv(path, mode="a", header=start == 0, index=False)
        return
    import pyarrow as pa
    import pyarrow.parquet as pq

    schema = pa.schema([(name, pa.float64()) for name in columns(rig, 0, 0)])
    with pq.ParquetWriter(path, schema) as writer:
        for start in range(0, rows, PIECE):
            writer.write_table(pa.table(columns(rig, min(PIECE, rows - start), start), schema=schema))


def measured(kind: str, rig: str, rows: int, folder: str) -> tuple[float, float]:
    """Return the seconds of a sweep and the peak memory [MiB]."""
    warnings.simplefilter("ignore", wl.WearlawWarning)
    model = wl.contact_model("exact" if rig == "twin_disc" else "fastsim")
    bodies = (
        wl.TwinDisc.suros()
        if rig == "twin_disc"
        else wl.WheelRail(wheel_radius="460 mm", rail_head_radius="300 mm", material=wl.steel(), rolling_speed="20 m/s")
    )
    law = wl.wear_law("usfd", fitted_for="exact" if rig == "twin_disc" else "fastsim")
    predict = bodies | model | law
    names = {name: f"{name} [{unit}]" for name, (unit, _, _) in RIGS[rig].items()}
    import pandas as pd

    few = pd.DataFrame(columns(rig, 100_000, 0))
    wl.sweep(predict, few, columns=names, friction_coefficient=0.3)  # compiles, and takes the memory of a block
    table: Any = Path(folder, f"run.{kind}")
    if kind == "arrays":
        table = pd.DataFrame(columns(rig, rows, 0))[list(names.values())]
    with tempfile.TemporaryDirectory(dir=folder) as into:
        start = time.process_time()
        wl.sweep(predict, table, columns=names, friction_coefficient=0.3, store=Path(into, "map.zarr"))
        return time.process_time() - start, peak_mib()


if __name__ == "__main__":
    if sys.argv[1:2] and sys.argv[1] in KINDS:
        print(*measured(sys.argv[1], sys.argv[2], int(sys.argv[3]), sys.argv[4]))
    else:
        main(sys.argv[1:])
