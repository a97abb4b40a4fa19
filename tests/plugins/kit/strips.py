"""A contact model of ellipses that marches along strips, as simple as it can be and right."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np

import wearlaw as wl


class Strips(wl.ContactModel):
    """Kalker's simplified theory with a parabolic bound, sampled in the middle of equal cells along strips.

    From one middle to the next the traction grows by w = dq/dx in stick, and is clipped to the bound. Half of what is
    clipped off in such a step is slip in either cell, so that q·s sums to what is fed in; all of it is in the second
    cell where it points against the traction of the first, for no cell gains energy.
    """

    name: ClassVar[str] = "strips"
    source: ClassVar[str] = "J. J. Kalker, Vehicle System Dynamics 11 (1982) 1-13"

    cells: int = 32
    """Number of cells of a strip [-]."""
    strips: int = 32
    """Number of strips [-]."""

    @property
    def elliptic_accuracy(self) -> float:
        # What the traction would grow by behind the last middle is left out: half of one of 32 cells, of the mean slip.
        return 1.6e-2

    def refined(self) -> Strips:
        return self.model_copy(update={"cells": 2 * self.cells, "strips": 2 * self.strips})

    def solve_ellipse(self, problem: wl.Problem) -> wl.Contact:
        # Chebyshev's quadrature of the second kind, exact for the area.
        angle = np.pi * np.arange(1, self.strips + 1) / (self.strips + 1)
        return self.at(problem, -np.cos(angle), np.pi / (self.strips + 1) * np.sin(angle))

    def on_strips(self, problem: wl.Problem, shares: Any) -> wl.Contact | None:
        edges = np.concatenate([[-1.0], 0.5 * (shares[1:] + shares[:-1]), [1.0]])
        return self.at(problem, shares, np.diff(edges))

    def at(self, problem: wl.Problem, shares: Any = None, widths: Any = None) -> wl.Contact:
        """Return the contact on strips at y = `shares` × b that stand for `widths` × b, or on those of the problem."""
        known = wl.kalker.coefficients(problem.a / problem.b, problem.poisson_ratio)
        modulus = problem.shear_modulus
        along, across, turning = (
            value[..., None, None]
            for value in (
                8.0 * problem.a / (3.0 * known.c11 * modulus),
                8.0 * problem.a / (3.0 * known.c22 * modulus),
                np.pi * problem.a * np.sqrt(problem.a / problem.b) / (4.0 * known.c23 * modulus),
            )
        )
        creepages = (problem.longitudinal_creepage, problem.lateral_creepage, problem.spin)
        creep_x, creep_y, spin = (creepage[..., None, None] for creepage in creepages)
        given = problem.strips
        if given is None:
            y, width = problem.b[..., None] * shares, problem.b[..., None] * widths
            half_length = (problem.a[..., None] * np.sqrt(1.0 - shares**2))[..., None, :]
            # The parabola with the load N of an ellipse has 2N/A in the centre.
            centre = (2.0 * problem.normal_force / problem.patch_area)[..., None] * (1.0 - shares**2)
        else:
            y, width, half_length = given.y, given.width, given.half_length[..., None, :]
            # The paraboloid of an ellipse is proportional to p². With the load N, ∫ c p² dx = 4/3 c a p0².
            squares = given.max_pressure**2
            load = (4.0 / 3.0 * given.half_length * given.width * squares).sum(axis=-1)
            centre = squares * (problem.normal_force / load)[..., None]
        share = (2.0 * np.arange(self.cells)[:, None] + 1.0) / self.cells - 1.0
        x = half_length * share + (0.0 if given is None else given.x[..., None, :])
        step = 2.0 / self.cells * half_length
        across_patch = np.broadcast_to(y[..., None, :], x.shape)
        friction = problem.friction_coefficient[..., None, None]
        bound = friction * centre[..., None, :] * (1.0 - share**2)
        grow = (
            (creep_x / along - spin * across_patch / turning) * step,
            (creep_y / across - spin * (x - 0.5 * step) / turning) * step,
        )
        traction, clipped = self.marched(grow, bound)
        length = np.broadcast_to(step, x.shape)
        over = np.where(length > 0.0, length, 1.0)  # strips that fill up a batch have no length
        slip = along * clipped[0] / over, across * clipped[1] / over
        area = length * width[..., None, :]
        return wl.Contact.from_strips(
            problem,
            wl.CreepForces(
                longitudinal=(traction[0] * area).sum(axis=(-2, -1)),
                lateral=(traction[1] * area).sum(axis=(-2, -1)),
                spin_moment=-((x * traction[1] + across_patch * traction[0]) * area).sum(axis=(-2, -1)),
            ),
            x=x,
            y=y,
            length=length,
            strip_width=width,
            traction=traction,
            slip=slip,
            traction_bound=bound,
        )

    def marched(self, grow: Any, bound: Any) -> tuple[Any, Any]:
        """Return the traction in the middles, and what is clipped off around them."""
        traction, clipped = np.zeros((2, *bound.shape)), np.zeros((2, *bound.shape))
        grow = np.stack(np.broadcast_arrays(*grow, bound)[:2])
        now = np.zeros_like(grow[..., 0, :])
        for k in range(self.cells):
            free = now + (0.5 if k == 0 else 1.0) * grow[..., k, :]
            size = np.hypot(*free)
            over = size > bound[..., k, :]
            now = np.where(over, free * np.divide(bound[..., k, :], size, out=np.zeros_like(size), where=over), free)
            traction[..., k, :] = now
            slip = free - now
            # Where spin turns the traction fast, the slip of a step may point against the traction of the cell before.
            before = traction[..., k - 1, :]  # none before the first cell: the last one has no traction yet
            shared = 0.5 * slip * ((slip * before).sum(axis=0) > 0.0)
            clipped[..., k, :] += slip - shared
            clipped[..., k - 1, :] += shared
        clipped[..., -1, :] += 0.5 * now  # at the trailing edge, where the bound is zero
        return traction, clipped


def on_strips(model: Any) -> Any:
    """Return the class of a model on the strips that a problem gives, and on no ellipse, made from a `Strips`."""

    def solve_strips(self: Any, problem: wl.Problem) -> wl.Contact:
        found: wl.Contact = self.at(problem)
        return found

    methods = {"solve_ellipse": wl.ContactModel.solve_ellipse, "solve_strips": solve_strips}
    return type(f"{model.__name__}OnStrips", (model,), {**methods, "__module__": __name__, "__doc__": model.__doc__})


StripsOnStrips: Any = on_strips(Strips)
"""The right model on given strips alone."""
