"""An approximate inverse for Newton's steps in rolling contact: blocks of few neighbouring rows, each for itself.

A row is a line contact, and rows feel each other little, so that its block of the matrix is most of it.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy
from numpy.typing import NDArray

from wearlaw_models.contact_models.half_space.gmres import Vector
from wearlaw_models.contact_models.half_space.grid import Grid

FACTORED, SOLVED = scipy.linalg.get_lapack_funcs(("getrf", "getrs"), dtype=np.float32)

SIZE = 128
"""Unknowns of a block, if it has more than one row."""

CHANGE = 0.3
"""Change of an element's direction, or of its share of the diagonal, from which on its block is factored anew."""


class Blocks:
    """The factored blocks of a grid, which are kept while the states of their elements stay."""

    def __init__(self, grid: Grid) -> None:
        rows, columns = grid.shape
        self.grid, self.begins = grid, np.arange(0, rows, max(1, SIZE // (2 * columns)))
        self.states = np.full((5, rows, columns), np.nan, np.float32)
        self.blocks: list[tuple[NDArray[np.intp], Any]] = [(np.zeros(0, dtype=np.intp), None)] * self.begins.size

    def update(self, axes: Vector, diagonal: Vector) -> None:
        """Factor the blocks whose elements changed.

        Parameters
        ----------
        axes : ndarray, (2, 2, rows, columns)
            Unit vectors of the one or two directions in which an element's traction may change; zero if none.
        diagonal : ndarray, (rows, columns)
            What the first direction takes up beside the displacements.
        """
        rows, columns = self.grid.shape
        states = np.concatenate([axes.reshape(4, rows, columns), diagonal[None] / (self.grid.stiffness + diagonal)])
        change = np.maximum.reduceat(np.abs(states - self.states).max(axis=(0, 2)), self.begins)
        for number in np.flatnonzero(~(change <= CHANGE)):
            begin, end = self.begins[number], [*self.begins[1:], rows][number]
            self.states[:, begin:end] = states[:, begin:end]
            which, row, column = np.nonzero(axes[:, :, begin:end].any(axis=1))
            row += begin
            x, y = axes[which, :, row, column].T
            along, across, mixed = self.grid.between(row, column)
            block = x[:, None] * (x * along + y * mixed) + y[:, None] * (x * mixed + y * across)
            first = np.flatnonzero(which == 0)
            block[first, first] += diagonal[row, column][first]
            self.blocks[number] = (which * rows + row) * columns + column, FACTORED(block)[:2] if row.size else None

    def solved(self, right: Vector) -> Vector:
        """Return the solution of the blocks for a right side of (2, rows, columns), flat."""
        solution = np.zeros_like(right)
        for place, block in self.blocks:
            if place.size:
                solution[place] = SOLVED(*block, right[place])[0]
        return solution
