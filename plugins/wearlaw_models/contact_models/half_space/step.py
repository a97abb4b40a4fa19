"""A step of Newton's method in rolling contact: a linear system of all elements, by its products alone.

Its approximate inverse consists of blocks of few neighbouring rows, each for itself. A row is a line contact, and rows
feel each other little, so that its block of the matrix is most of it.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy
from numpy.typing import NDArray

from wearlaw import Array
from wearlaw_models.contact_models.half_space.gmres import Vector, gmres
from wearlaw_models.contact_models.half_space.grid import Field, Grid

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


class Step:
    """The equations for changes of tractions around a state, in the unknowns (2, rows, columns).

    Where an element sticks, both components of its traction take up slip. Where it slips, the first unknown is the
    change across the traction, and the second one, if friction falls, that along it.

    Parameters
    ----------
    grid : Grid
    blocks : Blocks
    sticks : ndarray, (rows, columns)
    axis : ndarray, (2, rows, columns)
        Unit vectors along the tractions of the elements that slip; zero elsewhere.
    rest : ndarray, (rows, columns)
        Slip that goes with a unit change across the traction, beside what it takes up.
    slope : ndarray, (rows, columns)
        Growth of the bound with the slip.
    """

    def __init__(self, grid: Grid, blocks: Blocks, sticks: Array, axis: Array, rest: Array, slope: Array) -> None:
        self.grid, self.blocks, self.shape, self.falls = grid, blocks, axis.shape, bool(slope.any())
        single, none = np.where(sticks, 1.0, 0.0), np.zeros(sticks.shape)
        self.exact = np.stack([[single - axis[1], axis[0]], [none, single]])
        self.axes, self.axis, self.slope, self.rest = (
            array.astype(np.float32) for array in (self.exact, axis, slope, rest)
        )
        """Unit vectors of both unknowns, without that along a traction, (2, 2, rows, columns)."""
        self.along = np.square(self.axis).sum(axis=0)
        self.blocks.update(self.axes, self.rest)

    def solved(self, slip: Array, fixed: Array, share: float) -> Array:
        """Return changes of tractions that take up a slip, all but a share of it, beside changes that are fixed."""
        right = np.einsum("ijrc,jrc->irc", self.exact, slip)
        if self.falls:
            right[1] -= self._fall(fixed)
        size = np.abs(right).max()
        if not size:
            return np.zeros_like(right)
        change = gmres(self._product, self._preconditioned, (right / size).astype(np.float32).ravel(), share)
        step: Array = size * self._tractions(change).astype(np.float64)
        return step

    def _fall(self, q: Field) -> Field:
        """Return what changes of tractions change of the bound, with the sign of a slip that is taken up."""
        fall: Field = self.slope * (self.axis * self.grid.taken_up_around(q)).sum(axis=0)
        return fall

    def _tractions(self, v: Vector) -> Vector:
        unknowns = v.reshape(self.shape)
        q: Vector = np.einsum("ijrc,irc->jrc", self.axes, unknowns)
        return q + self.axis * unknowns[1] if self.falls else q

    def _product(self, v: Vector) -> Vector:
        unknowns, q = v.reshape(self.shape), self._tractions(v)
        taken: Vector = np.einsum("ijrc,jrc->irc", self.axes, self.grid.taken_up(q))
        taken[0] += self.rest * unknowns[0]
        if self.falls:
            taken[1] += self.along * unknowns[1] + self._fall(q)
        return taken.ravel()

    def _preconditioned(self, v: Vector) -> Vector:
        solution = self.blocks.solved(v)
        if self.falls:
            solution[v.size // 2 :] += self.along.ravel() * v[v.size // 2 :]
        return solution
