"""Displacements of an elastic half-space under tractions on a rectangle, for solutions element by element."""

from __future__ import annotations

import numpy as np

from wearlaw import Array


def influence(
    x: Array, y: Array, length: Array | float, width: Array | float, poisson_ratio: Array | float
) -> tuple[Array, Array, Array]:
    """Return 2πG times the displacements of the surface by a unit traction on a rectangle.

    The displacement of two like half-spaces relative to each other is twice that of one.

    Parameters
    ----------
    x, y : ndarray
        Position relative to the middle of the rectangle [m]; the arguments broadcast.
    length, width : ndarray or float
        Sides of the rectangle along x and y [m].
    poisson_ratio : ndarray or float
        ν [-].

    Returns
    -------
    along, across, mixed : ndarray
        Displacement along x by a traction along x, along y by one along y, and along y by one along x, which is that
        along x by one along y [m].

    Notes
    -----
    Cerruti's solution for a point force, integrated over the rectangle: K. L. Johnson, Contact Mechanics, 1985,
    section 3.6. With ν = 0 the first one is also 2πG/(1-ν) times the displacement along the normal by a unit
    pressure, after A. E. H. Love, Phil. Trans. R. Soc. Lond. A 228 (1929) 377-420.
    """
    shape = np.broadcast_shapes(*(np.shape(one) for one in (x, y, length, width, poisson_ratio)))
    along, across, mixed = (np.zeros(shape) for _ in range(3))
    for i, sign_i in ((x + 0.5 * length, 1.0), (x - 0.5 * length, -1.0)):
        for j, sign_j in ((y + 0.5 * width, 1.0), (y - 0.5 * width, -1.0)):
            sign = sign_i * sign_j
            first, second = sign * _side(i, j), sign * _side(j, i)
            along += (1.0 - poisson_ratio) * first + second
            across += first + (1.0 - poisson_ratio) * second
            mixed -= sign * poisson_ratio * np.hypot(i, j)
    return along, across, mixed


def _side(i: Array, j: Array) -> Array:
    """Return i arsinh(j/|i|), which is zero at i = 0."""
    size = np.abs(i)
    side: Array = i * np.arcsinh(j / np.where(size > 0.0, size, 1.0))
    return side
