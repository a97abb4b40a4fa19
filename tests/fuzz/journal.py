"""Damage to what an interrupted sweep left: the sweep that goes on has the bytes of an undisturbed one."""

from __future__ import annotations

import random
import tempfile
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any
from unittest import mock

import numpy as np

import wearlaw as wl
from tests.core.sweeps import contents
from tests.fuzz import mutations
from tests.fuzz.harness import Files, check
from wearlaw.sweeping import points
from wearlaw.sweeping.progress import Bar

REMOVED = "removed.txt"
"""The file of a case that names, one a line, what is missing."""

GIVEN: dict[str, Any] = {
    "creepage": wl.Q(np.geomspace(0.1, 10.0, 8), "%"),
    "normal_force": wl.Q([2.0, 5.0], "kN"),
    "friction_coefficient": 0.3,
    "outputs": ["wear_rate"],
}
STORE = Path("map.zarr")


def swept(folder: Path, resume: bool = False) -> None:
    """Sweep in four blocks."""
    predict = wl.TwinDisc.suros() | wl.contact_model("exact") | wl.wear_law("usfd", fitted_for="exact")
    with mock.patch.object(points, "BLOCK", 4):
        wl.sweep(predict, **GIVEN, store=folder / STORE, resume=resume)


@cache
def undisturbed() -> Files:
    """Return the files of a finished sweep."""
    with tempfile.TemporaryDirectory() as folder:
        swept(Path(folder))
        return contents(Path(folder))


@cache
def interrupted() -> Files:
    """Return the files of a sweep of which three of four blocks are done."""
    left = [None] * 4

    def advance(*_: object) -> None:
        left.pop()
        if not left:
            raise KeyboardInterrupt

    with tempfile.TemporaryDirectory() as folder, mock.patch.object(Bar, "__call__", advance):
        try:
            swept(Path(folder))
        except KeyboardInterrupt:
            return contents(Path(folder))
    raise AssertionError("the sweep was not interrupted")


def seeds() -> Iterator[Files]:
    yield {}
    yield {str(STORE / "zarr.json"): interrupted()[str(STORE / "zarr.json")]}


def draw(random: random.Random) -> Files:
    """Damage one to three files of an interrupted sweep."""
    whole, changed, removed = interrupted(), {}, []
    for name in random.choices([*whole, *(f"{STORE}.journal",) * len(whole)], k=random.choice([1, 1, 2, 3])):
        kind = random.random()
        if kind < 0.1:
            removed.append(name)
        elif kind < 0.2:
            changed[name] = whole[random.choice([*whole])]
        else:
            changed[name] = mutations.mutated(random, whole[name], [mutations.brackets])
    return {**changed, **({REMOVED: "\n".join(removed).encode()} if removed else {})}


def run() -> None:
    """Go on with the sweep."""
    given = contents(Path())
    gone = given.pop(REMOVED, b"").decode().split("\n")
    for name, content in {**interrupted(), **given}.items():
        Path(name).parent.mkdir(parents=True, exist_ok=True)
        Path(name).write_bytes(content)
    for name in {REMOVED, *gone} - {""}:
        Path(name).unlink(missing_ok=True)
    if not Path(f"{STORE}.journal").exists():  # then nothing says that the sweep is unfinished
        return
    swept(Path(), resume=True)
    found = contents(Path())
    check(set(found) == set(undisturbed()), "the files are not those of an undisturbed sweep")
    check(
        all(found[name] == content for name, content in undisturbed().items()), "bytes differ from an undisturbed sweep"
    )
