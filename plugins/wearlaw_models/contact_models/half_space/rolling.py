"""Steady rolling of two like half-spaces with dry friction under a given pressure, by Newton's method.

Where an element sticks, its slip s is zero. Where it slips, its traction q is the bound g, along s. Both are

    q = P(q + ρs) with any ρ > 0,

where P shortens a vector to the bound. Newton's method solves this. Its steps are linear systems of all elements,
solved as far as they are worth it by GMRES, with products by FFT and the rows as approximate inverse (S. C. Eisenstat
and H. F. Walker, SIAM J. Sci. Comput. 17 (1996) 16-32, on inexact steps). The traction on a grid twice as coarse is
the first guess.

A model of many elements stays fast this way: no matrix of all pairs; few steps, from a good guess; a cheap inverse of
what is near.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from wearlaw import Array
from wearlaw_models.contact_models.half_space.blocks import Blocks
from wearlaw_models.contact_models.half_space.gmres import Vector, gmres
from wearlaw_models.contact_models.half_space.grid import Grid

MISS, GUESS = 1e-10, 0.1
"""Traction that is left to correct, over the greatest bound, and that of a first guess."""

STEPS = np.tile([0.1, 0.3, 0.03], 30)
"""Weights of the slip beside the traction, over the stiffness of an element. With one that stays, Newton's method runs
in circles in some contacts."""

NEAR, EARLY, LATE = 0.1, 0.1, 1e-4
"""Share of the residual that GMRES leaves: `LATE` if less than `NEAR` is left to correct, or else `EARLY`."""

COARSE = 8
"""Fewest rows and columns of a coarser grid that gives a first guess."""


class Patch:
    """The elements of a grid that touch, under a pressure.

    Parameters
    ----------
    grid : Grid
    pressure : ndarray, (rows, columns)
        Pressure on the elements; those without are outside the patch.
    """

    def __init__(self, grid: Grid, pressure: Array) -> None:
        self.grid, self.pressure, self.inside = grid, pressure, pressure > 0.0
        self.area = grid.step * grid.width[:, None]
        """Area of each element, (rows, 1)."""

    def rigid_slip(self, ahead: float, xi: float, eta: float, phi: float) -> Array:
        """Return the slip of rigid bodies a way ahead of the middles of the elements."""
        x, y = np.broadcast_arrays(self.grid.x - ahead, self.grid.y[:, None])
        return np.stack([xi - phi * y, eta - phi * x]) * self.inside

    def slip(self, q: Array, xi: float, eta: float, phi: float) -> Array:
        """Return the slip in the middle of each element, the mean of those half-way from and to its neighbours.

        This slip dissipates ξFx + ηFy + φMz on the elements, whatever their size.
        """
        slip: Array = self.rigid_slip(0.0, xi, eta, phi) - self.inside * self.grid.taken_up_around(q)
        return slip

    def solved(
        self, bound: Array, xi: float, eta: float, phi: float, guess: Array | None = None
    ) -> tuple[Array, Array]:
        """Return the tractions of `rolling`, and the slip along them of the elements where they are at their bound.

        An element that sticks slips in its second half if the next one slips. That energy is counted there.
        """
        q, slips = self.rolling(bound, xi, eta, phi, self.guess(xi, eta, phi) if guess is None else guess)
        energy = (q * self.slip(q, xi, eta, phi)).sum(axis=0)
        energy[:, 1:] += (energy * ~slips)[:, :-1]
        slip = np.where(slips, np.maximum(energy, 0.0) / np.where(slips, bound, 1.0) ** 2, 0.0)
        return q, slip * q

    def guess(self, xi: float, eta: float, phi: float) -> Array:
        """Return tractions from those on elements twice as long and wide, if they are not too few."""
        rows, columns = self.grid.shape
        if min(rows, columns) < 2 * COARSE:
            return np.zeros((2, rows, columns))
        whole = np.pad(self.pressure, ((0, rows % 2), (0, columns % 2)))
        blocks = whole.reshape((rows + 1) // 2, 2, (columns + 1) // 2, 2).mean(axis=(1, 3))
        coarse = Patch(self.grid.coarser, blocks)
        q, _ = coarse.rolling(blocks, xi, eta, phi, coarse.guess(xi, eta, phi), GUESS)
        share = q / np.where(coarse.inside, blocks, 1.0)
        guess: Array = share.repeat(2, axis=1).repeat(2, axis=2)[:, :rows, :columns] * self.pressure
        return guess

    def rolling(
        self, bound: Array, xi: float, eta: float, phi: float, q: Array, miss: float = MISS
    ) -> tuple[Array, NDArray[np.bool_]]:
        """Return the tractions under a bound of their magnitude, from a first guess, and what slips.

        Raises
        ------
        ArithmeticError
            If there is no solution after all steps, or a step has none.
        """
        w = self.rigid_slip(0.5 * self.grid.step, xi, eta, phi)
        some, blocks = np.where(self.inside, bound, 1.0), Blocks(self.grid)
        settled = False
        for rho in STEPS / self.grid.stiffness:
            s = w - self.inside * self.grid.taken_up(q)
            u = q + rho * s
            length = np.maximum(np.hypot(*u), 1e-300)
            slips, axis = self.inside & (length > bound), u / length
            left = np.abs(np.where(slips, q - bound * axis, -rho * s)).max()
            left /= min(bound.max(), rho * np.abs(w).max()) or 1.0
            if left <= miss and (settled or miss > MISS):
                return np.where(slips, bound * axis, q), slips
            settled = left <= miss
            # Where an element slips, q goes to the bound at once along q + ρs; across, it follows the slip by a share.
            fixed = np.where(slips, (bound - (q * axis).sum(axis=0)) * axis, 0.0)
            right = s * np.where(slips, length / some, 1.0) - self.grid.taken_up(fixed)
            rest = np.where(slips, (length - bound) / (some * rho), 0.0)
            step = self._step(blocks, self._axes(slips, axis), rest, right, LATE if left <= NEAR else EARLY)
            q = q + fixed + step
        raise ArithmeticError(f"no solution at reduced creepages of {xi:g} and {eta:g} and a spin of {phi:g}")

    def _axes(self, slips: NDArray[np.bool_], axis: Array) -> Array:
        """Return unit vectors along which the tractions of elements may change, (2, 2, rows, columns), or zero."""
        none, sticks = np.zeros(slips.shape), np.where(self.inside & ~slips, 1.0, 0.0)
        axes: Array = np.stack([np.where(slips, [-axis[1], axis[0]], [sticks, none]), [none, sticks]])
        return axes

    def _step(self, blocks: Blocks, axes: Array, rest: Array, right: Array, share: float) -> Array:
        """Return changes of tractions along axes that take up a slip, less a share of it.

        Parameters
        ----------
        blocks : Blocks
        axes : ndarray, (2, 2, rows, columns)
        rest : ndarray, (rows, columns)
            Slip that goes with a unit change along the first axis, beside what it takes up.
        right : ndarray, (2, rows, columns)
            The slip.
        share : float
        """
        parts = np.einsum("ijrc,jrc->irc", axes, right)
        size = np.abs(parts).max()
        if not size:
            return np.zeros_like(right)
        single, beside = axes.astype(np.float32), rest.astype(np.float32)
        blocks.update(single, beside)

        def tractions(v: Vector) -> Vector:
            q: Vector = np.einsum("ijrc,irc->jrc", single, v.reshape(parts.shape))
            return q

        def product(v: Vector) -> Vector:
            taken: Vector = np.einsum("ijrc,jrc->irc", single, self.grid.taken_up(tractions(v)))
            taken[0] += beside * v.reshape(parts.shape)[0]
            return taken.ravel()

        change = gmres(product, blocks.solved, (parts / size).astype(np.float32).ravel(), share)
        step: Array = size * tractions(change).astype(np.float64)
        return step

    def forces(self, q: Array) -> Array:
        """Return Fx, Fy and Mz of tractions."""
        fx, fy = self.area * q
        return np.array([fx.sum(), fy.sum(), -(self.grid.x * fy).sum() - (self.grid.y[:, None] * fx).sum()])
