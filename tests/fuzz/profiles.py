"""Files of profiles: read, checked, written in other formats and read again."""

from __future__ import annotations

import random
import tempfile
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Literal

import numpy as np

import wearlaw_wheelset as ws
from tests.fuzz import mutations
from tests.fuzz.harness import Files, check

Kind = Literal["wheel", "rail"]

ENDINGS: dict[Kind, tuple[str, ...]] = {
    "wheel": (".prw", ".whl", ".csv", ".txt"),
    "rail": (".prr", ".ban", ".csv", ".txt"),
}
EVERY = 40
"""The seeds have one of so many points of a profile by formula."""


@cache
def valid() -> dict[str, bytes]:
    """Return files by their names."""
    found = {}
    formulas: dict[Kind, ws.Profile] = {"wheel": ws.Profile.s1002(), "rail": ws.Profile.uic60()}
    with tempfile.TemporaryDirectory() as folder:
        for kind, endings in ENDINGS.items():
            y, z = (values[::EVERY] for values in formulas[kind].points)
            profile = ws.Profile.from_points(y=y, z=z, kind=kind)
            for ending in endings:
                path = Path(folder) / f"{kind}{ending}"
                ws.write_profile(path, profile)
                found[path.name] = path.read_bytes()
    return found


def seeds() -> Iterator[Files]:
    for name, content in valid().items():
        yield {name: content}


def draw(random: random.Random) -> Files:
    name = random.choice([*valid()])
    return {name: mutations.mutated(random, valid()[name], [mutations.cells, mutations.units, header])}


def header(random: random.Random, text: str) -> str:
    """Add a line that may change the points."""
    name = random.choice(
        ["point.dist.min", "shift.y", "rotate", "bound.y.min", "bound.y.max", "mirror.z", "inversion", "units.len.f"]
    )
    line = f"    {name} = {random.choice([*mutations.NUMBERS, '0.1', '1', mutations.number(random)])}"
    found = text.split("\n")
    found.insert(random.randrange(min(len(found), 25)), line)
    return "\n".join(found)


def run() -> None:
    """Read a profile, write it in every format, and read these files."""
    (path,) = Path().iterdir()
    kind: Kind = "wheel" if path.stem == "wheel" else "rail"
    profile = ws.read_profile(path, kind=kind)
    repr(profile)
    y, z = (values.magnitude for values in profile.points)
    check(np.isfinite([y, z]).all(), "a point is no number")
    curve = profile.curve
    check(np.isfinite([curve.s, curve.y, curve.z]).all(), "the curve has a point that is no number")
    check((np.diff(curve.s) > 0.0).all(), "the arc length does not grow")
    check(not np.isinf(profile.apparent_cant.magnitude), "the cant is infinite")
    ending = ENDINGS[kind][len(y) % 4]
    copied = Path(f"copy{ending}")
    ws.write_profile(copied, profile)
    again = ws.read_profile(copied, kind=kind)
    for one, other in zip(profile.points, again.points, strict=True):
        check(np.allclose(one.to("mm").magnitude, other.to("mm").magnitude, rtol=0.0, atol=1e-8), "a copy differs")
