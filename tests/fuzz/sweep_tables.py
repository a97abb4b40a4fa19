"""Operating points in files of any format, swept row by row."""

from __future__ import annotations

import io
import random
import tempfile
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

import wearlaw as wl
from tests.fuzz import mutations
from tests.fuzz.harness import Files, check

HEAD = "Time [s],Fz [kN],slip [%],mu,note\n"
CSV = [
    HEAD + "".join(f"{0.1 * i:g},{7 + 0.1 * i:g},{0.5 * i:g},0.4,dry\n" for i in range(6)),
    "# source: run 7\n\nTime [s];Fz [kN];slip [%];mu\n0.1;7;0.5;0.4\n0.2;7.5;1;0.4\n",
    "Time\tFz [N]\tslip [-]\tmu\n1\t7000\t-0.01\t0.3\n2\t6000\t0.02\t0.3\n",
]
COLUMNS = {"creepage": "slip", "normal_force": "Fz", "friction_coefficient": "mu"}
ENDINGS = (".csv", ".csv", ".csv", ".csv", ".parquet", ".nc")


def frame() -> pd.DataFrame:
    values = np.linspace(1.0, 2.0, 5)
    return pd.DataFrame({"Time [s]": values, "Fz [kN]": 7.0 * values, "slip [%]": values, "mu": 0.4, "note": "dry"})


def _parquet(table: pd.DataFrame) -> bytes:
    written = io.BytesIO()
    table.to_parquet(written)
    return written.getvalue()


def _netcdf(table: pd.DataFrame) -> bytes:
    given = table.rename(columns=lambda name: str(name).partition(" [")[0]).to_xarray()
    for name, unit in {"Time": "s", "Fz": "kN", "slip": "%", "mu": "1"}.items():
        if name in given:
            given[name].attrs["units"] = unit
    with tempfile.TemporaryDirectory() as folder:
        given.to_netcdf(Path(folder) / "run.nc", engine="h5netcdf")
        return (Path(folder) / "run.nc").read_bytes()


@cache
def whole(ending: str) -> bytes:
    """Return a valid file."""
    return {".parquet": _parquet, ".nc": _netcdf}[ending](frame())


def seeds() -> Iterator[Files]:
    for text in CSV:
        yield {"run.csv": text.encode()}
    for ending in (".parquet", ".nc"):
        yield {f"run{ending}": whole(ending)}


def draw(random: random.Random) -> Files:
    ending = random.choice(ENDINGS)
    if ending == ".csv":
        text = random.choice(CSV).encode()
        return {"run.csv": mutations.mutated(random, text, [mutations.cells, mutations.cells, mutations.units])}
    if random.random() < 0.2:  # cut off; flipped bytes would test the libraries that read these formats
        content = whole(ending)
        return {f"run{ending}": content[: random.randrange(len(content))]}
    try:
        return {f"run{ending}": (_parquet if ending == ".parquet" else _netcdf)(_odd(random, frame()))}
    except (TypeError, ValueError):  # the format cannot hold such a table
        return {f"run{ending}": whole(ending)}


def _odd(random: random.Random, table: pd.DataFrame) -> pd.DataFrame:
    """Return a table with a column of another type, name or value."""
    name = random.choice([*table.columns])
    odd: list[Any] = [
        *(np.nan, np.inf, -1.0, 0.0, 1e308, 5e-324, True, "1.5", "x", "", pd.Timestamp("2026-01-01"), 10**15),
        *(pd.Timedelta(1), "x" * 3000, "\x1b[31m"),
    ]
    kind = random.randrange(5)
    if kind == 0:
        found: pd.DataFrame = table.drop(columns=name)
        return found
    if kind == 1:
        return table.rename(columns={name: random.choice(["creepage", "a [b]", "", "x" * 3000, "\x1b[31m", "slip"])})
    if kind == 2:
        return table.assign(**{name: random.choice(odd)})
    if kind == 3:
        return table.iloc[: random.choice([0, 1])]
    return table.assign(**{name: [random.choice(odd[:6]) for _ in range(len(table))]})


def run() -> None:
    """Sweep over the rows, and predict at each of them alone."""
    (path,) = Path().iterdir()
    predict = wl.TwinDisc.suros() | wl.contact_model("exact") | wl.wear_law("usfd", fitted_for="exact")
    outputs = ["wear_rate", "tangential_force"]
    found = wl.sweep(predict, path, columns=COLUMNS, keep={"time": "Time"}, outputs=outputs)
    rate = found.wear_rate.to_numpy()
    check((rate >= 0.0).all(), "a wear rate is negative or no number")
    check(np.isfinite(rate).all(), "a wear rate is infinite")
    given = {name: wl.Q(float(found[name][-1]), found[name].attrs["units"]) for name in COLUMNS}
    alone = predict(**given).wear_rate.magnitude
    check(np.isclose(rate[-1], alone, rtol=1e-12, atol=0.0), "a row is not what it is alone")
