"""A step of Newton's method in rolling contact: a linear system of all elements, by its products alone."""

from __future__ import annotations

import numpy as np

from wearlaw import Array
from wearlaw_models.contact_models.half_space.blocks import Blocks
from wearlaw_models.contact_models.half_space.gmres import Vector, gmres
from wearlaw_models.contact_models.half_space.grid import Field, Grid


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
            one.astype(np.float32) for one in (self.exact, axis, slope, rest)
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
