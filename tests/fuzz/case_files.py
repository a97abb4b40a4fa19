"""Case files: read, run, and written as reports."""

from __future__ import annotations

import random
import re
import tomllib
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import tomli_w
from click.testing import CliRunner

import wearlaw as wl
from tests.environments import ROOT
from tests.fuzz import mutations
from tests.fuzz.harness import Broken, Files, check
from wearlaw.cli import main
from wearlaw_studies.case import case_text
from wearlaw_studies.study import evaluations

MOST = 400
"""Evaluations of the largest case that is run."""

POINT = {"max_pressure": "1500 MPa", "creepage": "0.5 %", "friction_coefficient": 0.46}
SMALL: dict[str, Any] = {
    "title": "A small study",
    "rig": {"preset": "suros", "track_width": "8 mm"},
    "contact_models": ["global", {"model": "fastsim", "bound": "elliptic"}],
    "wear_laws": [{"model": "usfd", "fitted_for": "global"}, "kth"],
    "sweeps": {"creepage": {**POINT, "creepage": {"from": "0.1 %", "to": "10 %", "points": 3, "spacing": "log"}}},
    "profiles": {"partial_slip": POINT},
    "figures": {"wear": {"sweep": "creepage", "x": "creepage", "y": "wear_rate"}},
}
KNOWN = [
    *("title", "rig", "contact_models", "wear_laws", "laws", "stages", "sections", "sweeps", "profiles", "uncertainty"),
    *("measured", "figures", "plugins", "preset", "type", "model", "from", "to", "points", "spacing", "tests", "label"),
    *(
        "exact",
        "fastsim",
        "global",
        "linear",
        "polach",
        "usfd",
        "kth",
        "brr",
        "archard",
        "wlrm",
        "patch_mean",
        "thermal",
    ),
    *("twin_disc", "wheel_rail", "wheelset", "suros", "steel", "lewis2004", "sheffield", "log", "x", "y", "sweep"),
    *("normal_force", "creepage", "friction_coefficient", "lateral_creepage", "spin", "rolled_distance", "wear_rate"),
]


@cache
def valid() -> list[str]:
    """Return case files: those that ship, those of the documentation, and a small one."""
    pages = ((ROOT / "docs" / page).read_text(encoding="utf-8") for page in ("case-files.md", "fitting.md"))
    blocks = [
        found for page in pages for found in re.findall(r"```\{code-block\} toml\n:caption.*\n\n([^`]*)```", page)
    ]
    complete = [block for block in blocks if "contact_models" in block and "wrong" not in block]
    shipped = [case_text(name) for name in ("tassini2010", "wheel_on_rail")]
    return [tomli_w.dumps(SMALL)] * 4 + complete + shipped


def seeds() -> Iterator[Files]:
    for text in dict.fromkeys(valid()):
        yield {"run.toml": text.encode()}
    yield {"write.toml": valid()[0].encode()}


def draw(random: random.Random) -> Files:
    text = random.choice(valid())
    if random.random() < 0.6:
        table = tomllib.loads(text)
        for _ in range(1 + min(int(random.expovariate(1.0)), 3)):
            table = mutations.tree(random, table, KNOWN)
        try:
            content = tomli_w.dumps(table).encode("utf-8", "surrogateescape")
        except (TypeError, ValueError, RecursionError):  # a table that TOML, or its writer, cannot hold
            content = text.encode()
    else:
        content = mutations.mutated(random, text.encode(), [mutations.units, mutations.brackets])
    return {f"{random.choices(['load', 'run', 'write'], [60, 37, 3])[0]}.toml": content}


def run() -> None:
    """Read a case; run it or write its results if its name says so and it is small."""
    (path,) = Path().iterdir()
    case = wl.load_case(str(path))
    if path.stem == "load" or evaluations(case) > MOST:
        return
    if path.stem == "write":
        _write(path)
        return
    study = wl.run(case)
    for name in case.sweeps:
        for outcome, values in study.sweep(name).data_vars.items():
            check(not np.isinf(values.to_numpy()).any() if values.dtype.kind == "f" else True, f"{outcome} is infinite")
            if outcome == "wear_rate":
                check(not (values < 0.0).any(), "a wear rate is negative")


def _write(path: Path) -> None:
    """Run the command, which writes the whole folder or nothing."""
    result = CliRunner().invoke(main, ["run", str(path), "-o", "out"])
    if result.exception is not None and not isinstance(result.exception, SystemExit):
        raise result.exception
    check(Path("out").exists() == (result.exit_code == 0), "the results are there and the exit code is not 0")
    if result.exit_code != 0:
        check(len(result.stderr.strip()) > 0, "no message")
    written = set("".join(path.read_text("utf-8") for path in Path("out").rglob("*.csv")))
    if {"\x1b", "\x00", "\x07"} & set(result.output + result.stderr):
        raise Broken("control characters on the terminal")
    check(not {"\x1b", "\x00", "\x07"} & written, "control characters in a table")
