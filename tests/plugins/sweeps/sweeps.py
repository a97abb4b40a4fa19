"""What the tests of sweeps share: small blocks, and laws that end the process in which they are evaluated."""

from __future__ import annotations

import os
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import wearlaw as wl
from tests.cases import Linear
from wearlaw import Array, Q

CONDITIONS: dict[str, Any] = {
    "creepage": Q(np.geomspace(0.1, 10.0, 20), "%"),
    "normal_force": Q([2.0, 5.0, 9.0], "kN"),
    "friction_coefficient": [0.1, 0.3, 0.4, 0.6],
}
"""240 operating points."""

OUTPUTS = ["wear_rate", "tangential_force"]


def predictor(law: wl.WearLaw | None = None) -> wl.Pipeline[...]:
    return wl.TwinDisc.suros() | wl.contact_model("exact") | (law or wl.wear_law("usfd", fitted_for="exact"))


class Deadly(Linear):
    """A law that ends a process other than that of the test: once, when `marker` is a file, or always."""

    name = "deadly"

    marker: str
    """The file, which is removed."""
    always: bool = False
    """Whether the file stays."""
    spared: int
    """The process of the test."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Array:
        marker = Path(self.marker)
        if os.getpid() != self.spared and marker.exists():
            if not self.always:
                try:
                    marker.unlink()
                except FileNotFoundError:  # the other worker has just died
                    return super().rate(contact, p)
            os._exit(9)
        return super().rate(contact, p)


class Failing(Linear):
    """A law that cannot deal with high loads."""

    name = "failing"

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Array:
        if contact.normal_force.max() > 8e3:
            raise OverflowError("too much")
        return super().rate(contact, p)


class Ending(Linear):
    """A law that ends a process other than that of the test by an exception."""

    name = "ending"

    spared: int
    """The process of the test."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Array:
        if os.getpid() != self.spared:
            raise SystemExit(0)
        return super().rate(contact, p)


class Held(Linear):
    """A law that waits, in a process other than that of the test, at the greatest slips until `gate` is there."""

    name = "held"

    gate: str
    """A file, or a folder."""
    spared: int
    """The process of the test."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Array:
        while os.getpid() != self.spared and abs(contact.slip).max() > 0.07 and not Path(self.gate).exists():
            time.sleep(0.01)
        return super().rate(contact, p)


def held(gate: Path) -> wl.Pipeline[...]:
    """Return a pipeline whose last block of `CONDITIONS` waits in workers until a path is there."""
    return predictor(Held(slope=Q(1.0, "mm"), gate=str(gate), spared=os.getpid()))


def ending() -> wl.Pipeline[...]:
    """Return a pipeline that raises `SystemExit` in every worker."""
    return predictor(Ending(slope=Q(1.0, "mm"), spared=os.getpid()))


def deadly(marker: Path, always: bool = False) -> wl.Pipeline[...]:
    """Return a pipeline that kills the next worker that evaluates it, or all."""
    marker.touch()
    return predictor(Deadly(slope=Q(1.0, "mm"), marker=str(marker), always=always, spared=os.getpid()))


def interrupted_after(blocks: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Make as if Ctrl-C was pressed after some blocks, once."""
    from wearlaw_apps.sweeps.progress import Bar  # private: interrupts come from the bar

    left = [None] * (blocks + 1)  # the first call is for what was done before

    def advance(self: Bar, points: int) -> None:  # noqa: ARG001
        if left:
            left.pop()
            if not left:
                raise KeyboardInterrupt

    monkeypatch.setattr(Bar, "__call__", advance)


def told(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Return a list that will hold the numbers of points of which the progress bar is told."""
    from wearlaw_apps.sweeps.progress import Bar  # private: what is told on the way

    found: list[int] = []
    monkeypatch.setattr(Bar, "__call__", lambda _, points: found.append(points))
    return found


def contents(folder: Path) -> dict[str, bytes]:
    """Return all files below a folder."""
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}
