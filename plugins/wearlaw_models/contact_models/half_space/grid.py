"""A grid of rectangular elements between two like half-spaces that roll steadily, and the slip that tractions take up.

All quantities are reduced: lengths by some length c, tractions by a force F over c², and slip by F/(G c²). x runs from
the leading to the trailing edge, and tractions have the signs of the creepages, so that along x they are positive
against x. Fields have the shape (rows, columns), and vectors of them (2, rows, columns).
"""

from __future__ import annotations

import functools
import math
from typing import Any, TypeAlias

import numpy as np
import scipy
from numpy.typing import NDArray

from wearlaw import Array

Field: TypeAlias = NDArray[np.floating[Any]]
Spectra: TypeAlias = NDArray[np.inexact[Any]]

SMALL = 150
"""Most elements for which the products of all pairs are faster than FFTs."""

EQUAL = 1e-10
"""Difference between widths, or distances, of rows that count as equal, over the width."""


class Grid:
    """Elements in rows along x, with equal distances along x.

    What tractions take up is a convolution along x. Rows that are equally wide and far apart make it one across x too,
    and FFTs on twice the grid compute it. Other rows, such as the strips of a wheelset, take part in pairs: FFTs along
    x leave a matrix of all rows for each wave number. That costs the square of their number, but rows are few there,
    and the elements are exactly those of the strips. A small grid has one matrix of all elements.

    Parameters
    ----------
    x : ndarray, (columns)
        Middles of the elements along x.
    y, width : ndarray, (rows)
        Middles and widths of the rows.
    poisson_ratio : float
    """

    def __init__(self, x: Array, y: Array, width: Array, poisson_ratio: float) -> None:
        self.x, self.y, self.width, self.poisson_ratio = x, y, width, poisson_ratio
        self.shape = rows, columns = y.size, x.size
        self.step = float(x[1] - x[0])
        distance, least = np.diff(y), EQUAL * width.min()
        self.regular = bool(np.ptp(width) <= least and (np.abs(distance - width[0]) <= least).all())
        sources = 1 if self.regular else rows
        along, across, mixed = self._growth(y[:, None] - y[:sources], width[:sources])
        self.small = rows * columns <= SMALL
        self.growth: Field = np.stack([along, across, -mixed]).astype(np.float64 if self.small else np.float32)
        """Growth along x by x, y by y, and x by y, by pairs of rows and distances along x from 1 - columns on."""
        self.stiffness = float(along[0, 0, columns - 1])
        """Slip that an element takes up by a unit traction of its own."""
        self.size = tuple(scipy.fft.next_fast_len(2 * n - 1, real=True) for n in (rows, columns))
        if self.small:
            self.spectra = _in_both(_square(*self.between(*np.divmod(np.arange(rows * columns), columns))))
            return
        place = np.arange(1 - columns, columns) % self.size[1]
        kernels = np.zeros((3, *along.shape[:2], self.size[1]))
        kernels[..., place] = along, across, -mixed
        self.spectra = _in_both(self._spectra(kernels))
        """What tractions take up half-way from the element before, by wave number, or by elements of a small grid."""

    def _growth(self, apart: Array, width: Array) -> tuple[Array, Array, Array]:
        """Return the growth of the displacement per way from the element before, (rows, rows, distances along x)."""
        columns = self.x.size
        far: Array = self.step * np.arange(columns + 1.0)
        tables = influence(far, apart[..., None], self.step, width[:, None], self.poisson_ratio)
        signs = 1.0, 1.0, -1.0  # on the other side, at negative distances
        both = (np.concatenate([s * table[..., :0:-1], table], axis=-1) for s, table in zip(signs, tables, strict=True))
        along, across, mixed = (np.diff(table[..., :-1], axis=-1) / (math.pi * self.step) for table in both)
        return along, across, mixed

    def _spectra(self, kernels: Array) -> Spectra:
        """Return the transforms of kernels along x by x, y by y and x by y, (3, rows, rows, distances)."""
        if not self.regular:
            along, across, mixed = np.moveaxis(scipy.fft.rfft(kernels), -1, 1)
            return _square(along, across, mixed)
        rows = self.y.size
        both = np.zeros((3, *self.size))
        both[:, :rows] = kernels[:, :, 0]
        both[:, self.size[0] - rows + 1 :] = np.array([1.0, 1.0, -1.0])[:, None, None] * kernels[:, :0:-1, 0]
        spectra: Spectra = scipy.fft.rfft2(both)
        return spectra

    def between(self, row: NDArray[np.intp], column: NDArray[np.intp]) -> Field:
        """Return the growth along x by x, y by y, and x by y, of all pairs of elements, (3, elements, elements)."""
        apart, distances = row[:, None] - row, self.growth.shape[-1]
        pair = np.abs(apart) if self.regular else row[:, None] * self.y.size + row
        place = pair * distances + (column[:, None] - column + self.x.size - 1)
        growth: Field = self.growth.reshape(3, -1).take(place, axis=1)
        if self.regular:
            growth[2] *= np.sign(apart)
        return growth

    def taken_up(self, q: Field) -> Field:
        """Return the slip that tractions take up half-way from the element before, in their precision."""
        return self._product(self.spectra[q.dtype.name], q)

    def taken_up_around(self, q: Field) -> Field:
        """Return the mean of the slip that tractions take up half-way from the element before and to the next one.

        By Betti's theorem the same influences, transposed, give what is taken up on the way to the next element.
        """
        return self._product(self._around[q.dtype.name], q)

    @functools.cached_property
    def _around(self) -> dict[str, Spectra]:
        before = self.spectra["float64"]
        if self.regular and not self.small:
            return _in_both(1j * before.imag)
        width = np.tile(np.repeat(self.width, self.shape[1]) if self.small else self.width, 2)
        after: Spectra = -before.conj().swapaxes(-1, -2) * width / width[:, None]
        return _in_both(0.5 * (before + after))

    def _product(self, spectra: Spectra, q: Field) -> Field:
        rows, columns = self.shape
        slip: Field
        if self.small:
            slip = np.asarray(spectra @ q.ravel(), q.dtype).reshape(q.shape)
        elif self.regular:
            along, across, mixed = spectra
            first, second = scipy.fft.rfft2(q, s=self.size)
            waves = np.stack([along * first + mixed * second, mixed * first + across * second])
            slip = scipy.fft.irfft2(waves, s=self.size)[:, :rows, :columns]
        else:
            waves = scipy.fft.rfft(q, n=self.size[1]).reshape(2 * rows, -1, 1)
            waves = (spectra @ waves.swapaxes(0, 1)).swapaxes(0, 1).reshape(2, rows, -1)
            slip = scipy.fft.irfft(waves, n=self.size[1])[..., :columns]
        return slip

    @functools.cached_property
    def coarser(self) -> Grid:
        """A grid of elements twice as long and wide; odd numbers are made even at the end."""
        rows, columns = self.shape
        x = np.append(self.x, self.x[-1] + self.step) if columns % 2 else self.x
        y = np.append(self.y, self.y[-1] + self.width[-1]) if rows % 2 else self.y
        width = np.append(self.width, self.width[-1]) if rows % 2 else self.width
        x, y, width = (values.reshape(-1, 2).mean(axis=1) for values in (x, y, 2.0 * width))
        return Grid(x, y, width, self.poisson_ratio)


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
    shape = np.broadcast_shapes(*(np.shape(values) for values in (x, y, length, width, poisson_ratio)))
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


def _square(along: Spectra, across: Spectra, mixed: Spectra) -> Spectra:
    """Return the matrix of both directions."""
    square: Spectra = np.block([[along, mixed], [mixed, across]])
    return square


def _in_both(spectra: Spectra) -> dict[str, Spectra]:
    """Return spectra for fields in double and in single precision, by their names."""
    return {"float64": spectra, "float32": spectra.astype(np.complex64 if spectra.dtype.kind == "c" else np.float32)}
