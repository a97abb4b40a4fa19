"""Rolling contact of two like half-spaces with dry friction, solved element by element, as a reference for ellipses.

Everything is reduced: lengths by √(ab), forces by μN, creepages by μN/(G ab), and the spin by that over √(ab).
As in wearlaw, x runs from the leading edge to the trailing edge, and forces have the signs of the creepages.

`python -m tests.half_spaces` writes tests/data/half_spaces.csv, which takes half an hour; `table` reads it.
"""

from __future__ import annotations

import csv
import math
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from random import Random

import numpy as np

from wearlaw import Array

FILE = Path(__file__).parent / "data" / "half_spaces.csv"
POISSON_RATIO = 0.28
CELLS = (10, 20, 40)
"""Elements across the ellipse. The error is of first order, so that two grids extrapolate to none."""
DRAWS = (100, 140, 200)
"""Points without spin, with spin of at most half the creepage, and with any spin."""
INPUTS = ("ratio", "xi", "eta", "phi")
FORCES = ("fx", "fy", "mz")


def influence(x: Array, y: Array, dx: float, dy: float, nu: float) -> tuple[Array, Array, Array]:
    """πG times the relative displacement by unit traction on a rectangle: along x by x, along y by y, and mixed.

    Cerruti's solution for two like half-spaces, after the source of CONTACT (E. A. H. Vollebregt, src/m_inflcf.f90).
    The mixed one has the sign of tractions along the rolling direction at positions against it.
    """
    along, across, mixed = (np.zeros_like(x) for _ in range(3))
    for i, sign_i in ((x + dx / 2, 1), (x - dx / 2, -1)):
        for j, sign_j in ((y + dy / 2, 1), (y - dy / 2, -1)):
            sign, first, second = sign_i * sign_j, i * np.arcsinh(j / abs(i)), j * np.arcsinh(i / abs(j))
            along += sign * ((1.0 - nu) * first + second)
            across += sign * (first + (1.0 - nu) * second)
            mixed += sign * nu * np.hypot(i, j)
    return along, across, mixed


class HalfSpaces:
    """An elliptic patch of square-topped elements between two like half-spaces."""

    def __init__(self, ratio: float, poisson_ratio: float, cells: int) -> None:
        a, b = math.sqrt(ratio), 1.0 / math.sqrt(ratio)
        self.dx, dy = 2.0 * a / cells, 2.0 * b / cells
        middles = (2.0 * np.arange(cells) + 1.0) / cells - 1.0
        x, y = (v.ravel() for v in np.meshgrid(a * middles, b * middles))
        height = 1.0 - (x / a) ** 2 - (y / b) ** 2
        inside = height > 0.0
        self.x, self.y, height = x[inside], y[inside], height[inside]
        self.element = self.dx * dy
        """Area of an element."""
        self.bound = np.sqrt(height) / (np.sqrt(height).sum() * self.element)
        """Hertz's pressure times μ, which carries μN = 1."""
        here, one_before = (
            influence(self.x[:, None] - self.x - back, self.y[:, None] - self.y, self.dx, dy, poisson_ratio)
            for back in (0.0, self.dx)
        )
        self.along, self.across, self.mixed = (
            (first - second) / (math.pi * self.dx) for first, second in zip(here, one_before, strict=True)
        )
        """What a point is displaced on its way from one element to the next, over that way, for each traction."""

    def rigid_slip(self, xi: float, eta: float, phi: float) -> Array:
        """Return the slip of rigid bodies along x and along y, half the way from one element to the next."""
        return np.stack([xi - phi * self.y, eta - phi * (self.x - self.dx / 2.0)])

    def growth(self, q: Array) -> Array:
        """Return by how much tractions let the slip fall short of that of rigid bodies."""
        return np.stack([self.along @ q[0] + self.mixed @ q[1], self.mixed @ q[0] + self.across @ q[1]])

    def stuck(self, xi: float, eta: float, phi: float) -> Array:
        """Return the tractions where every element sticks, along x and along y."""
        w = self.rigid_slip(xi, eta, phi)
        matrix = np.block([[self.along, self.mixed], [self.mixed, self.across]])
        return np.linalg.solve(matrix, w.ravel()).reshape(w.shape).astype(np.float64)

    def rolling(self, xi: float, eta: float, phi: float) -> Array:
        """Return the tractions with friction, along x and along y.

        Where an element sticks, its slip s is zero; where it slips, its traction q is the bound, along s. Both are
        q = P(q + ρs) with any ρ > 0, where P shortens a vector to the bound. Newton's method solves this, with a ρ that
        changes from step to step, since with one that stays some contacts run in circles.
        """
        w, bound = self.rigid_slip(xi, eta, phi), self.bound
        q = np.zeros_like(w)
        for rho in np.tile([0.1, 0.3, 0.03], 20) / self.along.diagonal().mean():
            s = w - self.growth(q)
            length = np.maximum(np.hypot(*(q + rho * s)), 1e-300)
            slips, axis = length > bound, (q + rho * s) / length
            miss = np.where(slips, q - bound * axis, -rho * s)
            if np.abs(miss).max() < 1e-9 * bound.max():
                return q
            # Where an element slips, q goes to the bound at once along q + ρs; across, it follows the slip by a share.
            fixed = np.where(slips, -(miss * axis).sum(axis=0) * axis, 0.0)
            (stick,), (slip,) = np.nonzero(~slips), np.nonzero(slips)
            one, none = np.ones(stick.size), np.zeros(stick.size)
            at = np.concatenate([stick, stick, slip])
            x, y = np.concatenate([one, none, -axis[1, slip]]), np.concatenate([none, one, axis[0, slip]])
            share = np.concatenate([one, one, bound[slip] / length[slip]])
            along, across, mixed = (matrix[np.ix_(at, at)] for matrix in (self.along, self.across, self.mixed))
            matrix = x[:, None] * (along * x + mixed * y) + y[:, None] * (mixed * x + across * y)
            matrix *= rho * share[:, None]
            matrix[np.diag_indices_from(matrix)] += 1.0 - share
            left = miss[:, at] + rho * share * self.growth(fixed)[:, at]
            step = np.linalg.solve(matrix, -(x * left[0] + y * left[1]))
            q = q + fixed + np.stack([np.bincount(at, part * step, slips.size) for part in (x, y)])
        raise ArithmeticError(f"no solution at xi = {xi}, eta = {eta}, phi = {phi}")

    def forces(self, q: Array) -> Array:
        """Return Fx, Fy and Mz of tractions."""
        return np.array([q[0].sum(), q[1].sum(), -(self.x @ q[1] + self.y @ q[0])]) * self.element


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


def solved(point: Sequence[float], cells: int) -> Array:
    """Return Fx, Fy and Mz at a point on a grid."""
    ratio, xi, eta, phi = point
    patch = HalfSpaces(ratio, POISSON_RATIO, cells)
    return patch.forces(patch.rolling(xi, eta, phi))


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
