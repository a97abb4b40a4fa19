"""Frictionless contact of half-spaces, solved element by element, as a reference for the normal problem.

The pressure is constant on each element of a grid (A. E. H. Love, Phil. Trans. R. Soc. Lond. A 228 (1929) 377-420, for
the displacement), and conjugate gradients find it together with the area of contact (I. A. Polonsky and L. M. Keer,
Wear 231 (1999) 206-219).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import scipy

import wearlaw_models.contact_models.half_space
from wearlaw import Array


class Contact(NamedTuple):
    """Pressure on the grid [Pa], penetration [m] and area [m²]."""

    pressure: Array
    penetration: float
    area: float


def pressed(
    gap: Array, dx: float, dy: float, modulus: float, force: float, tolerance: float = 1e-8, first: Array | None = None
) -> Contact:
    """Return the contact of half-spaces with a gap [m] on a grid, (along x, along y), under a normal force.

    A penetration counts from the gap's zero. The grid must reach beyond the patch. The search begins at the pressure
    `first`.
    """
    nx, ny = gap.shape
    shape = scipy.fft.next_fast_len(2 * nx, real=True), scipy.fft.next_fast_len(2 * ny, real=True)
    x, y = (np.minimum(np.arange(n), n - np.arange(n)) * step for n, step in zip(shape, (dx, dy), strict=True))
    # Without Poisson's ratio, the influence of tractions along x is that of a pressure.
    along, across = np.meshgrid(x, y, indexing="ij")
    kernel = wearlaw_models.contact_models.half_space.influence(along, across, dx, dy, 0.0)[0] / (np.pi * modulus)
    transform = scipy.fft.rfft2(kernel)

    def displaced(pressure: Array) -> Array:
        product = transform * scipy.fft.rfft2(pressure, s=shape)
        moved: Array = scipy.fft.irfft2(product, s=shape)[:nx, :ny]
        return moved

    cell = dx * dy
    pressure = np.where(gap < np.quantile(gap, 0.3), 1.0, 0.0) if first is None else first
    pressure = pressure * (force / (pressure.sum() * cell))
    step, before, restart = np.zeros_like(gap), 1.0, 0.0
    for _ in range(3000):
        rest = displaced(pressure) + gap  # the penetration, where the bodies touch
        touches = pressure > 0.0
        level = float(rest[touches].mean())
        rest -= level
        norm = float((rest[touches] ** 2).sum())
        step = np.where(touches, rest + restart * norm / before * step, 0.0)
        before = norm
        along = displaced(step)
        along -= along[touches].mean()
        length = float((rest * step)[touches].sum() / (along * step)[touches].sum())
        last = pressure
        pressure = np.where(touches, np.maximum(pressure - length * step, 0.0), 0.0)
        again = (pressure <= 0.0) & (rest < 0.0)
        restart = 0.0 if again.any() else 1.0
        pressure = np.where(again, pressure - length * rest, pressure)
        pressure *= force / (pressure.sum() * cell)
        if np.abs(pressure - last).sum() * cell < tolerance * force:
            edge = np.concatenate([pressure[0], pressure[-1], pressure[:, 0], pressure[:, -1]])
            if edge.any():
                raise ArithmeticError("the patch reaches the end of the grid")
            return Contact(pressure, level, float(np.count_nonzero(pressure) * cell))
    raise ArithmeticError("no solution")
