"""Result files of the program CONTACT: read, and the wear in them."""

from __future__ import annotations

import random
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import numpy as np

import wearlaw as wl
from tests.fuzz import mutations
from tests.fuzz.harness import Files, check
from tests.plugins.contact_files import FILES, HEAD, SUBSURFACE, of_version, rows_of, turned
from wearlaw_contact_files.subsurface import read_subsurface

LINES = 60
"""Lines of the subsurface stresses that a case has, of many thousands."""


@cache
def valid() -> list[Files]:
    """Return files as CONTACT writes them, older ones and turned ones too."""
    found = [{"case.0001.mat": FILES[name].read_bytes()} for name in ("tread", "flange", "half_space")]
    rows = rows_of(FILES["tread"])
    found += [
        {"case.0001.mat": _written(one)} for one in (turned(rows), of_version(rows, 2310), of_version(rows, 1401))
    ]
    lines = SUBSURFACE.read_bytes().splitlines(keepends=True)
    return [*found, {"case.0001.subs": b"".join(lines)}]


def _written(rows: wl.Array) -> bytes:
    lines = ["%  TIM   FMT", *(" ".join(f"{number:14.6g}" for number in row) for row in rows)]
    return ("\n".join(lines) + "\n").encode()


def seeds() -> Iterator[Files]:
    yield from valid()


def draw(random: random.Random) -> Files:
    ((name, content),) = random.choice(valid()).items()
    return {name: mutations.mutated(random, content, [head, head, blanks])}


def head(random: random.Random, text: str) -> str:
    """Replace a number of the head, which says how to read the rest."""
    lines = text.split("\n")
    at = random.randrange(min(len(lines), HEAD + 2))
    lines[at] = mutations.numbers(random, lines[at])
    return "\n".join(lines)


def blanks(random: random.Random, text: str) -> str:
    """Replace a cell of a row, or leave it out."""
    lines = text.split("\n")
    at = random.randrange(len(lines))
    row = lines[at].split() or [""]
    row[random.randrange(len(row))] = random.choice([*mutations.NUMBERS, "-1", "7", "1e3"])
    lines[at] = " ".join(row)
    return "\n".join(lines)


def run() -> None:
    """Read a file, and predict the wear in its contact."""
    (path,) = Path().iterdir()
    if path.suffix == ".subs":
        stresses = read_subsurface(path)
        for name, values in stresses.items():
            check(np.isfinite(values.to_numpy()).all(), f"{name} is not finite")
        return
    contact = wl.read_contact(path)
    found = wl.Prediction.of(contact, wl.wear_law("kth"))
    for name in ("wear_rate", "wear_index", "tangential_force", "normal_force", "patch_area", "max_pressure"):
        check(np.isfinite(found[name].magnitude).all(), f"{name} is not finite")
    check(np.all(found.wear_rate.magnitude >= 0.0), "a wear rate is negative")
    check(np.all(found.patch_area.magnitude > 0.0), "the patch has no area")
    depth = found.wear_profile("rail").depth.to_numpy()
    check(np.isfinite(depth).all(), "a depth is not finite")
