"""Steady rolling of two like half-spaces with dry friction under a given pressure, by Newton's method.

Where an element sticks, its slip s is zero. Where it slips, its traction q is the bound g, along s. Both are

    q = P(q + ρs) with any ρ > 0,

where P shortens a vector to the bound. Newton's method solves this. Its steps are linear systems of all elements,
solved as far as they are worth it by GMRES, with products by FFT and the rows as approximate inverse (S. C. Eisenstat
and H. F. Walker, SIAM J. Sci. Comput. 17 (1996) 16-32, on inexact steps). The traction on a grid twice as coarse is
the first guess. If friction falls with the slip, the bound changes with q, and the steps know how.

A model of many elements stays fast this way: no matrix of all pairs; few steps, from a good guess; a cheap inverse of
what is near.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from wearlaw import Array
from wearlaw_models.contact_models.half_space.grid import Grid
from wearlaw_models.contact_models.half_space.step import Blocks, Step

MISS, GUESS = 1e-10, 0.1
"""Traction that is left to correct, over the greatest bound, and that of a first guess."""

STEPS = np.tile([0.1, 0.3, 0.03], 60)
"""Weights of the slip beside the traction, over the stiffness of an element. With one that stays, Newton's method runs
in circles in some contacts."""

DAMPED = {10: 0.5, 30: 0.2}
"""Numbers of steps from which on friction that falls follows the slip by a share of the way."""

CLOSE = 1e-3
"""What is left to correct when it follows at once again."""

NEAR, EARLY, LATE = 0.1, 0.1, 1e-4
"""Share of the residual that GMRES leaves: `LATE` if less than `NEAR` is left to correct, or else `EARLY`."""

COARSE = 8
"""Fewest rows and columns of a coarser grid that gives a first guess."""


class Friction(NamedTuple):
    """Friction that falls with the slip, over that at rest, as `wl.FallingFriction` does; `rate` is over the slip."""

    limit_ratio: float = 1.0
    rate: float = 0.0

    @property
    def falls(self) -> bool:
        """Whether friction depends on the slip."""
        return self.limit_ratio < 1.0 and self.rate > 0.0

    def at(self, slip: Array) -> tuple[Array, Array]:
        """Return the values at slips, and their slopes; none where nothing slips."""
        fallen = (1.0 - self.limit_ratio) * np.exp(-self.rate * slip)
        return self.limit_ratio + fallen, np.where(slip > 0.0, -self.rate * fallen, 0.0)


class Patch:
    """The elements of a grid that touch, under a pressure.

    Creepages are arrays of (3, rows, 1): ξ, η and φ of each row, whose rigid slip is (ξ, η - φx).

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

    def rigid_slip(self, ahead: float, creepages: Array) -> Array:
        """Return the slip of rigid bodies a way ahead of the middles of the elements."""
        xi, eta, phi = creepages
        return np.stack(np.broadcast_arrays(xi, eta - phi * (self.grid.x - ahead))) * self.inside

    def slip(self, q: Array, creepages: Array) -> Array:
        """Return the slip in the middle of each element, the mean of those half-way from and to its neighbours.

        This slip dissipates ξFx + ηFy + φMz on the elements, whatever their size.
        """
        slip: Array = self.rigid_slip(0.0, creepages) - self.inside * self.grid.taken_up_around(q)
        return slip

    def slipped(self, q: Array, slips: NDArray[np.bool_], creepages: Array) -> Array:
        """Return the slip along tractions in the middle of the elements that slip, (rows, columns).

        An element that sticks slips in its second half if the next one slips. That energy is counted there.
        """
        energy = (q * self.slip(q, creepages)).sum(axis=0)
        energy[:, 1:] += np.where(slips, 0.0, energy)[:, :-1]
        slip: Array = np.where(slips, np.maximum(energy, 0.0) / np.where(slips, np.hypot(*q), 1.0), 0.0)
        return slip

    def guess(self, friction: Friction, creepages: Array) -> Array:
        """Return tractions from those on elements twice as long and wide, if they are not too few."""
        rows, columns = self.grid.shape
        if min(rows, columns) < 2 * COARSE:
            return np.zeros((2, rows, columns))
        whole = np.pad(self.pressure, ((0, rows % 2), (0, columns % 2)))
        blocks = whole.reshape((rows + 1) // 2, 2, (columns + 1) // 2, 2).mean(axis=(1, 3))
        coarse = Patch(self.grid.coarser, blocks)
        creepages = np.pad(creepages, ((0, 0), (0, rows % 2), (0, 0)), "edge").reshape(3, -1, 2, 1).mean(axis=2)
        q = coarse.rolling(friction, creepages, coarse.guess(friction, creepages), GUESS)[0]
        share = q / np.where(coarse.inside, blocks, 1.0)
        guess: Array = share.repeat(2, axis=1).repeat(2, axis=2)[:, :rows, :columns] * self.pressure
        return guess

    def solved(self, friction: Friction, creepages: Array) -> tuple[Array, Array, Array]:
        """Return the solution to rounding, as `rolling` does."""
        return self.rolling(friction, creepages, self.guess(friction, creepages))

    def rolling(self, friction: Friction, creepages: Array, q: Array, miss: float = MISS) -> tuple[Array, Array, Array]:
        """Return tractions (2, rows, columns), the slip along them and their bound (rows, columns), from a first guess.

        Raises
        ------
        ArithmeticError
            If there is no solution after all steps, or a step has none.
        """
        w = self.rigid_slip(0.5 * self.grid.step, creepages)
        blocks, settled, left, slips = Blocks(self.grid), False, np.inf, np.zeros(self.inside.shape, dtype=np.bool_)
        bound, slope, share = self.pressure, np.zeros(self.inside.shape), 1.0
        for number, rho in enumerate(STEPS / self.grid.stiffness):
            if friction.falls:
                before = bound
                bound, slope = (self.pressure * value for value in friction.at(self.slipped(q, slips, creepages)))
                share = DAMPED.get(number, share)
                if share < 1.0 and left > CLOSE:
                    bound, slope = before + share * (bound - before), 0.0 * slope
            s = w - self.inside * self.grid.taken_up(q)
            u = q + rho * s
            length = np.maximum(np.hypot(*u), 1e-300)
            slips, axis = self.inside & (length > bound), u / length
            left = np.abs(np.where(slips, q - bound * axis, -rho * s)).max()
            left /= min(bound.max(), rho * np.abs(w).max()) or 1.0
            if left <= miss and (settled or miss > MISS):
                q = np.where(slips, bound * axis, q)
                return q, self.slipped(q, slips, creepages), bound
            settled = left <= miss
            # Where an element slips, q goes to the bound at once along q + ρs; across, it follows the slip by a share.
            fixed = np.where(slips, (bound - (q * axis).sum(axis=0)) * axis, 0.0)
            some = np.where(slips, bound, 1.0)
            right = s * np.where(slips, length / some, 1.0) - self.grid.taken_up(fixed)
            rest = np.where(slips, (length - bound) / (some * rho), 0.0)
            step = Step(self.grid, blocks, self.inside & ~slips, np.where(slips, axis, 0.0), rest, slope)
            q = q + fixed + step.solved(right, fixed, LATE if left <= NEAR else EARLY)
        xi, eta, phi = creepages.mean(axis=(1, 2))
        falls = "; friction may fall too fast with the slip for a steady one" if friction.falls else ""
        raise ArithmeticError(f"no solution at a reduced ξ, η and φ of {xi:g}, {eta:g} and {phi:g}{falls}")

    def totals(self, q: Array, creepages: Array) -> Array:
        """Return Fx, Fy and Mz of tractions, and the power that they take from the rigid slip."""
        force = fx, fy = self.area * q
        moment = -(self.grid.x * fy).sum() - (self.grid.y[:, None] * fx).sum()
        return np.array([fx.sum(), fy.sum(), moment, (force * self.rigid_slip(0.0, creepages)).sum()])
