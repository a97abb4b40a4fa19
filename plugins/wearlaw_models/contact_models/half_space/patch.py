"""A patch of rectangular elements with constant tractions between two like half-spaces that roll steadily.

All quantities are reduced: lengths by some length c, tractions by a force F over c², and slip by F/(G c²). x runs from
the leading to the trailing edge, and tractions have the signs of the creepages, so that along x they are positive
against x.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wearlaw import Array
from wearlaw_models.contact_models.half_space.cerruti import influence

MISS = 1e-10
"""Traction that is left to correct, over the greatest bound."""

STEPS = np.tile([0.1, 0.3, 0.03], 30)
"""Weights of the slip beside the traction, over the stiffness of an element. With one that stays, Newton's method runs
in circles in some contacts."""

COARSE = 8
"""Fewest rows and columns of a coarser grid that gives a first guess."""


class Patch:
    """The elements of a patch in rows along x.

    Parameters
    ----------
    x : ndarray, (columns)
        Middles of the elements along x, at equal distances.
    y, width : ndarray, (rows)
        Middles and widths of the rows.
    pressure : ndarray, (columns, rows)
        Pressure on the elements; those without are outside the patch.
    poisson_ratio : float
    """

    def __init__(self, x: Array, y: Array, width: Array, pressure: Array, poisson_ratio: float) -> None:
        self.grid = x, y, width, pressure, poisson_ratio
        self.inside = pressure > 0.0
        column, row = np.nonzero(self.inside)
        self.x, self.y, self.pressure, self.step = x[column], y[row], pressure[self.inside], x[1] - x[0]
        self.area = self.step * width[row]
        """Area of each element."""
        # All pairs of rows, at each distance along x and at one more.
        between = np.arange(-len(x), len(x)) * self.step
        tables = influence(between, (y[:, None] - y)[..., None], self.step, width[:, None], poisson_ratio)
        place = (row[:, None] * len(y) + row) * (len(between) - 1) + (column[:, None] - column + len(x) - 1)
        along, across, mixed = (
            np.take(np.diff(table, axis=-1).ravel() / (math.pi * self.step), place) for table in tables
        )
        self.growth = along, across, -mixed
        """Growth of the relative displacement per way from the element before, for each traction: along x by x, along
        y by y, and mixed, negative as tractions along x are positive against it."""
        self.single = tuple(one.astype(np.float32) for one in self.growth)
        """The same in single precision, enough for corrections of tractions."""

    def rigid_slip(self, x: Array, xi: float, eta: float, phi: float) -> Array:
        """Return the slip of rigid bodies at positions along x of the elements, along x and along y."""
        return np.stack([xi - phi * self.y, eta - phi * x])

    def taken_up(self, q: Array) -> Array:
        """Return the slip that tractions take up half-way from the element before, of the shape of q."""
        along, across, mixed = self.growth
        return np.stack([along @ q[0] + mixed @ q[1], mixed @ q[0] + across @ q[1]])

    def slip(self, q: Array, xi: float, eta: float, phi: float) -> Array:
        """Return the slip in the middle of each element, the mean of those half-way from and to its neighbours.

        By Betti's theorem the same influences give what is taken up on the way to the next element. This slip
        dissipates ξFx + ηFy + φMz on the elements, whatever their size.
        """
        along, across, mixed = self.growth
        f = self.area * q
        after = -np.stack([f[0] @ along + f[1] @ mixed, f[0] @ mixed + f[1] @ across]) / self.area
        slip: Array = self.rigid_slip(self.x, xi, eta, phi) - 0.5 * (self.taken_up(q) + after)
        return slip

    def solved(
        self, bound: Array, xi: float, eta: float, phi: float, guess: Array | None = None
    ) -> tuple[Array, Array]:
        """Return the tractions of `rolling`, and the slip along them of the elements where they are at their bound.

        An element that sticks slips in its second half if the next one slips. That energy is counted there.
        """
        q, slips = self.rolling(bound, xi, eta, phi, self.guess(xi, eta, phi) if guess is None else guess)
        both: Array = np.zeros((2, *self.inside.shape))
        energy, stuck = both[0, ...], both[1, ...]
        energy[self.inside] = (q * self.slip(q, xi, eta, phi)).sum(axis=0)
        stuck[self.inside] = ~slips
        energy[1:] += (energy * stuck)[:-1]
        slip = np.where(slips, np.maximum(energy[self.inside], 0.0) / bound**2, 0.0)
        return q, slip * q

    def guess(self, xi: float, eta: float, phi: float) -> Array:
        """Return tractions from those on elements twice as long and wide, if they are not too few."""
        columns, rows = self.inside.shape
        if columns % 2 or rows % 2 or min(columns, rows) < 2 * COARSE:
            return np.zeros((2, self.x.size))
        x, y, width, pressure, poisson_ratio = self.grid
        blocks = pressure.reshape(columns // 2, 2, rows // 2, 2).mean(axis=(1, 3))
        x, y, width = (one.reshape(-1, 2).mean(axis=1) for one in (x, y, 2.0 * width))
        coarse = Patch(x, y, width, blocks, poisson_ratio)
        q, _ = coarse.rolling(coarse.pressure, xi, eta, phi, coarse.guess(xi, eta, phi))
        share = np.zeros((2, *blocks.shape))
        share[:, coarse.inside] = q / coarse.pressure
        guess: Array = share.repeat(2, axis=1).repeat(2, axis=2)[:, self.inside] * self.pressure
        return guess

    def rolling(self, bound: Array, xi: float, eta: float, phi: float, q: Array) -> tuple[Array, NDArray[np.bool_]]:
        """Return the tractions, (2, elements), under a bound of their magnitude, from a first guess, and what slips.

        Where an element sticks, its slip s is zero. Where it slips, its traction q is the bound, along s. Both are
        q = P(q + ρs) with any ρ > 0, where P shortens a vector to the bound. Newton's method solves this.
        """
        w = self.rigid_slip(self.x - 0.5 * self.step, xi, eta, phi)
        for rho in STEPS / self.growth[0].diagonal().mean():
            s = w - self.taken_up(q)
            length = np.maximum(np.hypot(*(q + rho * s)), 1e-300)
            slips, axis = length > bound, (q + rho * s) / length
            miss = np.where(slips, q - bound * axis, -rho * s)
            if np.abs(miss).max() <= MISS * min(bound.max(), rho * np.abs(w).max()):
                return np.where(slips, bound * axis, q), slips
            # Where an element slips, q goes to the bound at once along q + ρs; across, it follows the slip by a share.
            fixed = np.where(slips, -(miss * axis).sum(axis=0) * axis, 0.0)
            (stick,), (slip,) = np.nonzero(~slips), np.nonzero(slips)
            one, none = np.ones(stick.size), np.zeros(stick.size)
            at = np.concatenate([stick, stick, slip])
            x, y = np.concatenate([one, none, -axis[1, slip]]), np.concatenate([none, one, axis[0, slip]])
            share = np.concatenate([one, one, bound[slip] / length[slip]])
            left = miss[:, at] + rho * share * self.taken_up(fixed)[:, at]
            step = np.linalg.solve(
                self._matrix(at, x, y, rho * share, 1.0 - share), -(x * left[0] + y * left[1]).astype(np.float32)
            )
            q = q + fixed + np.stack([np.bincount(at, part * step, slips.size) for part in (x, y)])
        raise ArithmeticError(f"no solution at reduced creepages of {xi:g} and {eta:g} and a spin of {phi:g}")

    def _matrix(self, at: NDArray[np.intp], *parts: Array) -> NDArray[np.float32]:
        """Return the derivative of what tractions miss along axes (x, y) at elements, a scale and a diagonal."""
        x, y, scale, diagonal = (np.asarray(part, np.float32) for part in parts)
        place = at[:, None] * self.x.size + at
        along, across, mixed = (one.take(place) for one in self.single)
        matrix: Any = (scale * x)[:, None] * (along * x + mixed * y)
        matrix += (scale * y)[:, None] * (mixed * x + across * y)
        matrix[np.diag_indices_from(matrix)] += diagonal
        found: NDArray[np.float32] = matrix
        return found

    def forces(self, q: Array) -> Array:
        """Return Fx, Fy and Mz of tractions."""
        fx, fy = self.area * q
        return np.array([fx.sum(), fy.sum(), -(self.x @ fy + self.y @ fx)])
