"""Results of CONTACT and its printed totals, and files made of them: turned around, older, or changed in a place."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

from wearlaw import Array

ROOT = Path(__file__).parents[3]
RESULTS, EXAMPLES = Path(__file__).parent / "contact_results", ROOT / "docs" / "examples"

FILES = {
    "half_space": RESULTS / "half_space.0001.mat",
    "fastsim": RESULTS / "fastsim.0001.mat",
    "carter": ROOT / "plugins" / "wearlaw_apps" / "contact_files" / "carter.0001.mat",
    "tread": EXAMPLES / "flange.0001a.mat",
    "flange": EXAMPLES / "flange.0001b.mat",
}
SUBSURFACE = RESULTS / "half_space.0001.subs"

PRINTED = {
    # module, V [mm/s], CKSI, CETA, CPHI [1/mm], FN, FX, FY or FS [N], MZ or MN [N mm], FRIC.POWER [W], PMAX [N/mm²],
    # NCON, NADH
    "half_space": (3, 30000, 0.002, 0.001, 0.0003, 82000, -13700, -11750, -2461, -1083, 1632, 721, 365),
    "fastsim": (3, 30000, 0.002, 0.001, 0.0003, 81812, -14220, -12010, -1852, -1052, 1631, 698, 437),
    "carter": (3, 30000, -0.001, 0, 0, 972300, 152000, 0, 0, -4413, 619.1, 100, 69),
    "tread": (1, 30140, 0.009271, 0.01954, 0.001992, 4490, -573.7, -1216, 33.37, -873.7, 1474, 130, 0),
    "flange": (1, 30380, 0.02502, 0.07113, 0.001978, 10990, -1100, -3105, -146.6, -7559, 1768, 262, 0),
}
"""What CONTACT prints of each case. FN of `fastsim` is the sum of its elements: the program prints the given 82000."""

HEAD = 6
"""Rows of numbers before the elements."""


def rows_of(path: Path) -> Array:
    """Return the numbers of a file."""
    return np.loadtxt(path, comments="%")


def write_rows(path: Path, rows: Array, comment: str = "%  TIM   FMT") -> Path:
    """Write rows of numbers as CONTACT does, behind a comment."""
    lines = [comment, *(" ".join(f"{number:14.6g}" for number in row) for row in rows)]
    path.write_text("\n".join(lines) + "\n", encoding="ascii")
    return path


def turned(rows: Array) -> Array:
    """Return the same patch in axes turned by 180 degrees about the normal, so that it rolls along -x."""
    found, (mx, my) = rows.copy(), rows[3, :2]
    found[3, 2:4] = -(rows[3, 2] + mx * rows[3, 4]), -(rows[3, 3] + my * rows[3, 5])
    found[3, 6] = np.pi
    elements = found[HEAD:][::-1].copy()
    elements[:, 0] = mx * my + 1 - elements[:, 0]
    elements[:, [5, 6, 8, 9]] *= -1.0
    found[HEAD:] = elements
    return found


def of_version(rows: Array, version: int) -> Array:
    """Return the contents of a file of an older version, after the layouts that CONTACT's `loadcase.m` lists."""
    first, second, place = rows[:3]
    grid = rows[3].copy()
    if version >= 2320:
        head = [first.copy(), second, place]
    elif version >= 1801:
        older = np.zeros_like(first)
        older[:10] = [*first[:2], *second[:5], *first[3:6]]
        head = [older, np.array([*place[:9], second[5], first[6], *place[11:]])]
    else:
        older = np.zeros_like(first)
        older[1:3] = place[:2]
        head = [older] if version >= 1401 else []
    if version < 2310:
        grid[10] = 0.0
    if version < 1901:
        grid[8:10] = 0.0
    found = np.array([*head, grid, *rows[4:]])
    found[0, -1] = version
    return found


def changed(path: Path, made: Path, change: Callable[[list[str]], list[str]]) -> Path:
    """Write a file with some of its lines changed."""
    lines = change(path.read_text(encoding="ascii").splitlines(keepends=True))
    made.write_text("".join(lines), encoding="ascii")
    return made
