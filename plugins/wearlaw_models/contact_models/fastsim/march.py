"""FASTSIM on an ellipse as published: the march of J. J. Kalker, Vehicle System Dynamics 11 (1982) 1-13.

The march cuts the patch into strips of equal width along the rolling direction, each at the y of its middle. It divides
every strip into the same number of cells from its own leading to its own trailing edge. From end to end of a cell the
traction grows by the exact integral of the linear w = (ξ/L1 - φy/L3, η/L2 - φx/L3). At the end of the cell the traction
is clipped radially to the bound. The clipped part over the cell's length, times (L1, L2), is the mean slip of the cell.

A cell holds means: the mean slip, and the means of traction and bound at both ends. So |q| ≤ bound, since the bound is
concave; forces are sums by the trapezoidal rule; and without spin ∑ q·s dA = ξFx + ηFy holds to rounding. In the number
of cells of a strip the error of forces is of order 2 without spin, or 3/2 with the elliptic bound, which begins and
ends like a square root. With spin it is of order 1, as the direction of the traction turns. Where w is close to zero,
spin may turn it by more than a right angle within a cell, and the means of that cell then gain energy (`drop_gains`).

All arrays hold half the traction, so that the sum from both ends of a cell is the mean.
"""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass
from typing import NamedTuple, Self

import numpy as np

import wearlaw as wl
from wearlaw import Array


@dataclass(frozen=True, slots=True, kw_only=True)
class Ellipses:
    """Elliptic patches of the simplified theory, as SI arrays of shape (points,).

    Attributes
    ----------
    a, b : ndarray
        Semi-axes in the rolling direction and across it [m].
    longitudinal_creepage, lateral_creepage : ndarray
        ξ and η [-].
    spin : ndarray
        φ [1/m].
    longitudinal_flexibility, lateral_flexibility, spin_flexibility : ndarray
        L1, L2 and L3 [m³/N].
    bound_centre : ndarray
        Bound of the traction at the centre of the patch, μ p2(0) [Pa].
    elliptic : bool
        Whether the bound is a half-ellipsoid; otherwise it is a paraboloid.
    """

    a: Array
    b: Array
    longitudinal_creepage: Array
    lateral_creepage: Array
    spin: Array
    longitudinal_flexibility: Array
    lateral_flexibility: Array
    spin_flexibility: Array
    bound_centre: Array
    elliptic: bool

    @classmethod
    def of(cls, problem: wl.Problem, elliptic: bool, interpolation: wl.kalker.Interpolation = "scaled") -> Self:
        """Return the patches of a problem with one batch axis, with Kalker's three flexibilities.

        L1 = 8a/(3 C11 G), L2 = 8a/(3 C22 G), L3 = π a √(a/b)/(4 C23 G) (Kalker 1982).
        """
        a, modulus = problem.a, problem.shear_modulus
        ratio = a / problem.b
        c = wl.kalker.coefficients(ratio, problem.poisson_ratio, interpolation)
        return cls(
            a=a,
            b=problem.b,
            longitudinal_creepage=problem.longitudinal_creepage,
            lateral_creepage=problem.lateral_creepage,
            spin=problem.spin,
            longitudinal_flexibility=8.0 / 3.0 * a / (c.c11 * modulus),
            lateral_flexibility=8.0 / 3.0 * a / (c.c22 * modulus),
            spin_flexibility=0.25 * np.pi * a * np.sqrt(ratio) / (c.c23 * modulus),
            bound_centre=(1.5 if elliptic else 2.0)
            * problem.friction_coefficient
            * problem.normal_force
            / problem.patch_area,
            elliptic=elliptic,
        )

    @property
    def arrays(self) -> tuple[Array, ...]:
        """The arrays, in the order above."""
        return tuple(getattr(self, field.name) for field in dataclasses.fields(self)[:-1])

    def cell_lengths(self, cells: int, strips: int) -> Array:
        """Return the length of the cells of each strip [m], of shape (points, strips)."""
        return self.a[:, None] * (2.0 / cells * np.sqrt(1.0 - strip_centres(strips) ** 2))


class Cells(NamedTuple):
    """The result of a march, as SI arrays of shape (points, cells of a strip, strips).

    Attributes
    ----------
    x : ndarray
        Middle of the cell [m].
    bound : ndarray
        Bound of the traction, the mean of both ends [Pa].
    traction_x, traction_y : ndarray
        Traction, the mean of both ends of the cell [Pa].
    slip_x, slip_y : ndarray
        Relative slip, the mean over the cell [-].
    """

    x: Array
    bound: Array
    traction_x: Array
    traction_y: Array
    slip_x: Array
    slip_y: Array


def strip_centres(strips: int) -> Array:
    """Return y/b in the middle of each strip."""
    return (2.0 * np.arange(strips) + 1.0) / strips - 1.0


def march(ellipses: Ellipses, count: int, strips: int) -> Cells:
    """March over every strip of ellipses, from cell to cell."""
    v = strip_centres(strips)
    s = np.sqrt(1.0 - v * v)
    a, b, creepage_x, creepage_y, spin, flexibility_x, flexibility_y, flexibility_spin, centre = (
        array[:, None] for array in ellipses.arrays
    )
    half_length, length = a * s, ellipses.cell_lengths(count, strips)
    half_spin = 0.5 * spin / flexibility_spin * length
    grow_x = 0.5 * creepage_x / flexibility_x * length - half_spin * b * v
    grow_y = 0.5 * creepage_y / flexibility_y * length
    turn, bound = -half_spin * half_length, 0.5 * centre * (s if ellipses.elliptic else s * s)
    over_x, over_y = 2.0 * flexibility_x / length, 2.0 * flexibility_y / length
    cells = Cells(*np.empty((len(Cells._fields), count, *length.shape)))
    x = y = np.zeros(length.shape)
    before = 0.0
    for k, cell in enumerate(zip(*cells, strict=True)):
        to_x, to_bound, to_traction_x, to_traction_y, to_slip_x, to_slip_y = cell
        middle, end = (2 * k + 1 - count) / count, 4.0 * (k + 1) * (count - k - 1) / (count * count)
        end = math.sqrt(end) if ellipses.elliptic else end
        free_x, free_y = x + grow_x, y + (turn * middle + grow_y)
        with np.errstate(divide="ignore", invalid="ignore"):  # where the traction has not grown
            share = np.fmin(bound * end / np.sqrt(free_x * free_x + free_y * free_y), 1.0)
        next_x, next_y = free_x * share, free_y * share
        np.multiply(half_length, middle, out=to_x)
        np.multiply(bound, before + end, out=to_bound)
        np.add(x, next_x, out=to_traction_x)
        np.add(y, next_y, out=to_traction_y)
        np.multiply(free_x - next_x, over_x, out=to_slip_x)
        np.multiply(free_y - next_y, over_y, out=to_slip_y)
        x, y, before = next_x, next_y, end
    return Cells(*(array.swapaxes(0, 1) for array in cells))


def drop_gains(cells: Cells) -> None:
    """Set the slip to zero in cells with q·s < 0, which wear laws cannot take: some in a million with spin."""
    gains = cells.traction_x * cells.slip_x + cells.traction_y * cells.slip_y < 0.0
    cells.slip_x[gains] = cells.slip_y[gains] = 0.0


def forces(ellipses: Ellipses, cells: Cells) -> wl.CreepForces:
    """Return the forces and the moment of marched cells."""
    _, count, strips = cells.x.shape
    area = ellipses.cell_lengths(count, strips) * (2.0 / strips) * ellipses.b[:, None]
    y = ellipses.b[:, None] * strip_centres(strips)
    along, across = cells.traction_x.sum(axis=1), cells.traction_y.sum(axis=1)
    moment = np.einsum("pkj,pkj->pj", cells.x, cells.traction_y) + y * along
    return wl.CreepForces(
        longitudinal=(along * area).sum(axis=-1),
        lateral=(across * area).sum(axis=-1),
        spin_moment=-(moment * area).sum(axis=-1),
    )


def solve(problem: wl.Problem, ellipses: Ellipses, count: int) -> wl.Contact:
    """Return the contact on `count` × `count` cells."""
    flat, cells = problem.flatten(), march(ellipses, count, count)
    drop_gains(cells)
    contact = wl.Contact.from_strips(
        flat,
        forces(ellipses, cells),
        x=cells.x,
        y=flat.b[:, None] * strip_centres(count),
        length=np.broadcast_to(ellipses.cell_lengths(count, count)[:, None, :], cells.x.shape),
        strip_width=np.broadcast_to(2.0 / count * flat.b[:, None], (flat.size, count)),
        traction=(cells.traction_x, cells.traction_y),
        slip=(cells.slip_x, cells.slip_y),
        traction_bound=cells.bound,
    )
    return contact.unflattened(problem)
