"""Forces of two like half-spaces in rolling contact with dry friction, as a reference for ellipses.

Everything is reduced: lengths by √(ab), forces by μN, creepages by μN/(G ab), and the spin by that over √(ab).
As in wearlaw, x runs from the leading edge to the trailing edge, and forces have the signs of the creepages.

`python -m tests.half_spaces` writes tests/data/half_spaces.csv, which takes two minutes; `table` reads it.
"""

from __future__ import annotations

import csv
import math
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from random import Random

import numpy as np

import wearlaw as wl
from wearlaw import Array, Q

FILE = Path(__file__).parent / "data" / "half_spaces.csv"
POISSON_RATIO = 0.28
CELLS = (15, 30, 60)
"""Elements across the ellipse. The error is of first order, so that two grids extrapolate to none."""
DRAWS = (100, 140, 200)
"""Points without spin, with spin of at most half the creepage, and with any spin."""
INPUTS = ("ratio", "xi", "eta", "phi")
FORCES = ("fx", "fy", "mz")


def points() -> Iterator[tuple[float, ...]]:
    """Draw `INPUTS`: a/b from 1/10 to 10, half of them from 1/2 to 2; reduced creepages and spin up to 1.

    Signs of ξ and of η matter only beside that of φ, by symmetry, so ξ and η are positive.
    """
    draw = Random(1982).random  # the same numbers with any version of Python

    def log_uniform(low: float, high: float) -> float:
        return low * math.exp(math.log(high / low) * draw())

    for kind, count in enumerate(DRAWS):
        for i in range(count):
            widest = 2.0 if i % 2 else 10.0
            ratio, xi, eta = log_uniform(1.0 / widest, widest), log_uniform(0.01, 1.0), log_uniform(0.01, 1.0)
            spin = (0.0, 0.5 * math.hypot(xi, eta) * draw(), log_uniform(0.01, 1.0))[kind]
            yield tuple(round(value, 4) + 0.0 for value in (ratio, xi, eta, math.copysign(spin, draw() - 0.5)))


def contact(point: Sequence[float], cells: int, poisson_ratio: float = POISSON_RATIO) -> wl.Contact:
    """Return the contact at a point on a grid, in units in which G, ab and μN are one."""
    ratio, xi, eta, phi = point
    problem = wl.Problem.ellipse(
        a=Q(math.sqrt(ratio), "m"),
        b=Q(1.0 / math.sqrt(ratio), "m"),
        normal_force="1 N",
        shear_modulus="1 Pa",
        poisson_ratio=poisson_ratio,
        friction_coefficient=1.0,
        longitudinal_creepage=Q(xi, ""),
        lateral_creepage=Q(eta, ""),
        spin=Q(phi, "1/m"),
    )
    return wl.contact_model("half_space", cells=cells).solve(problem)


def solved(point: Sequence[float], cells: int, poisson_ratio: float = POISSON_RATIO) -> Array:
    """Return Fx, Fy and Mz at a point on a grid."""
    found = contact(point, cells, poisson_ratio)
    return np.array([found.force_x, found.force_y, found.moment_z])


def columns() -> dict[str, Array]:
    """Return the columns of the file."""
    lines = FILE.read_text(encoding="utf-8").splitlines()
    rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


def table(fine: int = CELLS[-1]) -> dict[str, Array]:
    """Return inputs and results at all points: `FORCES`, extrapolated from a grid and the next coarser, and Tγ."""
    column = columns()
    found = {name: column[name] for name in INPUTS}
    for name in FORCES:
        found[name] = 2.0 * column[f"{name}{fine}"] - column[f"{name}{fine // 2}"]
    found["power"] = found["xi"] * found["fx"] + found["eta"] * found["fy"] + found["phi"] * found["mz"]
    return found


HEAD = f"""\
# Forces of two like half-spaces in steady rolling with dry friction, at points drawn at random.
# Computed by `python -m tests.half_spaces`, which says how. nu = {POISSON_RATIO}; ratio = a/b.
# Reduced: xi, eta = creepage times G ab/(mu N); phi = spin times G ab sqrt(ab)/(mu N); fx, fy = force over mu N;
# mz = moment over mu N sqrt(ab). The number after them is that of the elements across the ellipse. Signs as in wearlaw.
# The first {sum(DRAWS)} points were drawn. The others are where a search found the largest errors of the models: with
# differential evolution beside FASTSIM, and for FASTSIM itself around the worst of the points drawn.
"""


def write() -> None:
    """Write the file anew, with the points that a search found as they are there, and say how far it is."""
    lines = [",".join((*INPUTS, *(f"{name}{cells}" for cells in CELLS for name in FORCES)))]
    searched = np.stack([columns()[name] for name in INPUTS], axis=1)[sum(DRAWS) :]
    for number, point in enumerate([*points(), *searched.tolist()]):
        forces = np.concatenate([solved(point, cells) for cells in CELLS])
        lines.append(",".join([*(f"{value:g}" for value in point), *(f"{value:.5f}" for value in forces)]))
        print(number, lines[-1], file=sys.stderr, flush=True)
    FILE.write_text(HEAD + "\n".join(lines) + "\n", encoding="utf-8", newline="\n")


if __name__ == "__main__":
    write()
