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
from dataclasses import dataclass
from typing import Self

import numpy as np

import wearlaw as wl
from wearlaw import Array
from wearlaw_fastsim._march_loops import WIDTH, along, compiled_march, strip

BLOCK = 12800
"""Strips of a block in NumPy: its arrays fit in the cache, and are long enough for the calls to cost little."""


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

    @property
    def arrays(self) -> tuple[Array, ...]:
        """The arrays, in the order above."""
        return tuple(getattr(self, field.name) for field in dataclasses.fields(self)[:-1])

    def part(self, part: slice) -> Self:
        """Return some of the operating points."""
        names = (field.name for field in dataclasses.fields(self)[:-1])
        return dataclasses.replace(self, **{name: getattr(self, name)[part] for name in names})

    def cell_lengths(self, cells: int, strips: int) -> Array:
        """Return the length of the cells of each strip [m], of shape (points, strips)."""
        return self.a[:, None] * (2.0 / cells * np.sqrt(1.0 - strip_centres(strips) ** 2))


@dataclass(frozen=True, slots=True, kw_only=True)
class Cells:
    """The result of a march, as SI arrays of shape (points, cells of a strip, strips).

    Attributes
    ----------
    x : ndarray
        Middle of the cell [m].
    traction_x, traction_y : ndarray
        Traction, the mean of both ends of the cell [Pa].
    slip_x, slip_y : ndarray
        Relative slip, the mean over the cell [-].
    bound : ndarray
        Bound of the traction, the mean of both ends [Pa].
    """

    x: Array
    traction_x: Array
    traction_y: Array
    slip_x: Array
    slip_y: Array
    bound: Array

    @classmethod
    def empty(cls, points: int, cells: int, strips: int, *, compiled: bool) -> Self:
        """Return cells for marches to fill, in the memory order that a march fills fastest."""
        names = [field.name for field in dataclasses.fields(cls)]
        if compiled:
            return cls(**{name: np.empty((points, cells, strips)) for name in names})
        return cls(**{name: np.empty((cells, points, strips)).swapaxes(0, 1) for name in names})

    @property
    def arrays(self) -> tuple[Array, ...]:
        """The arrays, in the order above."""
        return tuple(getattr(self, field.name) for field in dataclasses.fields(self))

    def part(self, part: slice) -> Self:
        """Return the cells of some of the operating points."""
        names = (field.name for field in dataclasses.fields(self))
        return dataclasses.replace(self, **{name: getattr(self, name)[part] for name in names})


def strip_centres(strips: int) -> Array:
    """Return y/b in the middle of each strip."""
    return (2.0 * np.arange(strips) + 1.0) / strips - 1.0


def march(ellipses: Ellipses, cells: Cells, *, compiled: bool) -> None:
    """March over every strip of ellipses and fill the cells, in NumPy or compiled by numba; both agree to rounding.

    Patches of more than `WIDTH` strips always use NumPy.
    """
    if compiled and cells.x.shape[2] <= WIDTH:
        compiled_march(np.stack(ellipses.arrays, axis=1), ellipses.elliptic, *cells.arrays)
        return
    points, _, strips = cells.x.shape
    rows = BLOCK // strips
    buffers = np.empty((8, min(rows, points), strips))
    for first in range(0, points, rows):
        part = slice(first, min(first + rows, points))
        with np.errstate(divide="ignore", invalid="ignore"):  # where the traction has not grown
            _march_block(ellipses.part(part), cells.part(part), buffers[:, : part.stop - first])


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


def _march_block(ellipses: Ellipses, cells: Cells, buffers: Array) -> None:
    count, strips = cells.x.shape[1:]
    v = strip_centres(strips)
    columns = [array[:, None] for array in ellipses.arrays]
    half_length, grow_x, grow_y, turn, bound, over_x, over_y = strip(
        columns, ellipses.elliptic, v, np.sqrt(1.0 - v * v), count
    )
    x, y, next_x, next_y, free_x, free_y, share, work = buffers
    x[:] = y[:] = before = 0.0
    by_cell = zip(*(array.swapaxes(0, 1) for array in cells.arrays), strict=True)
    for k, (to_x, to_traction_x, to_traction_y, to_slip_x, to_slip_y, to_bound) in enumerate(by_cell):
        middle, end = along(k, count, ellipses.elliptic)
        np.add(x, grow_x, out=free_x)
        np.multiply(turn, middle, out=free_y)
        np.add(free_y, grow_y, out=free_y)
        np.add(free_y, y, out=free_y)
        np.multiply(free_x, free_x, out=work)
        np.multiply(free_y, free_y, out=share)
        np.add(work, share, out=work)
        np.sqrt(work, out=work)
        np.multiply(bound, end, out=share)
        np.divide(share, work, out=share)
        np.fmin(share, 1.0, out=share)
        np.multiply(free_x, share, out=next_x)
        np.multiply(free_y, share, out=next_y)
        np.add(x, next_x, out=to_traction_x)
        np.add(y, next_y, out=to_traction_y)
        np.subtract(free_x, next_x, out=free_x)
        np.subtract(free_y, next_y, out=free_y)
        np.multiply(free_x, over_x, out=to_slip_x)
        np.multiply(free_y, over_y, out=to_slip_y)
        np.multiply(half_length, middle, out=to_x)
        np.multiply(bound, before + end, out=to_bound)
        x, next_x, y, next_y, before = next_x, x, next_y, y, end
