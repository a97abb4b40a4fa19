"""A contact model of ellipses on a rectangular grid, whose outer nodes lie outside the patch; a right one."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np

import wearlaw as wl


class Grid(wl.ContactModel):
    """Rigid bodies in full slip, on a grid of equal elements with a margin outside the patch.

    An element whose centre lies in the patch belongs to it. The pressure is Hertz's times a factor, so that it sums to
    the load.
    """

    name: ClassVar[str] = "grid"
    source: ClassVar[str] = "Amontons' law"
    elements: int = 60
    """Number of elements along and across [-]."""

    @property
    def exemptions(self) -> Any:
        return {
            "initial_slope": "rigid bodies slip at any creepage",
            "pressure": "the pressure is scaled to the load on the elements of the grid",
        }

    @property
    def elliptic_accuracy(self) -> float:
        # About π/4 · 60² elements hold the patch, and some 4 · 60 of its border are in or out by chance: √240 of 2827.
        return 1e-2

    def solve_ellipse(self, problem: wl.Problem) -> wl.Contact:
        a, b, xi, eta, phi, friction, p0, load = (
            value[..., None, None]
            for value in (
                *(problem.a, problem.b, problem.longitudinal_creepage, problem.lateral_creepage, problem.spin),
                *(problem.friction_coefficient, problem.max_pressure, problem.normal_force),
            )
        )
        share = 1.1 * ((2.0 * np.arange(self.elements) + 1.0) / self.elements - 1.0)
        inside = share[:, None] ** 2 + share**2 < 1.0
        x, y = np.broadcast_arrays(a * share[:, None], b * share)
        length = 2.2 / self.elements * a * inside
        width = np.broadcast_to(2.2 / self.elements * b[..., 0], y[..., 0, :].shape)
        area = length * width[..., None, :]
        pressure = wl.hertz_ellipse.pressure(x, y, a, b, p0)
        pressure = pressure * load / (pressure * area).sum(axis=(-2, -1), keepdims=True)
        bound = friction * pressure
        slip_x, slip_y = np.broadcast_arrays(xi - phi * y, eta - phi * x)
        slip = np.hypot(slip_x, slip_y)
        over_slip = np.divide(bound, slip, out=np.zeros_like(slip), where=slip > 0.0)
        q_x, q_y = over_slip * slip_x, over_slip * slip_y
        return wl.Contact.from_strips(
            problem,
            wl.CreepForces(
                longitudinal=(area * q_x).sum(axis=(-2, -1)),
                lateral=(area * q_y).sum(axis=(-2, -1)),
                spin_moment=-(area * (x * q_y + y * q_x)).sum(axis=(-2, -1)),
            ),
            x=x,
            y=y[..., 0, :],
            length=length,
            strip_width=width,
            traction=(q_x, q_y),
            slip=(slip_x, slip_y),
            traction_bound=bound,
            pressure=pressure,
        )
