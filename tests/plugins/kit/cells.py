"""Contact models that solve on cells and give nothing in closed form: a right one, and wrong ones."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np

import wearlaw as wl


class Cells(wl.ContactModel):
    """Kalker's simplified theory with a parabolic bound, marched over equal cells; its force is a sum over them."""

    name: ClassVar[str] = "cells"
    source: ClassVar[str] = "J. J. Kalker, Vehicle System Dynamics 11 (1982) 1-13"
    cells: int = 400
    """Number of cells [-]."""

    @property
    def accuracy(self) -> float:
        # Next to the trailing edge q grows with the distance y from it, and s is that of full slip, ξ_f: of n cells m
        # slip, of length dx = 2a/cells, where y/dx up to n should. As a share of the power in full slip, μNξ, the sum
        # of q·s is off by (3/2) (dx/a) |m² - n²|/n, the most for m = 1 and n = 1/2.
        return 4.5 / self.cells

    def refined(self) -> Cells:
        return self.model_copy(update={"cells": 2 * self.cells})

    def solve_line(self, problem: wl.Problem) -> wl.Contact:
        a, creepage = problem.half_width[..., None], problem.creepage[..., None]
        x = a * ((2.0 * np.arange(self.cells) + 1.0) / self.cells - 1.0)
        flexibility = 4.0 * a / (np.pi * problem.effective_modulus[..., None])
        centre = (problem.friction_coefficient * 0.75 * problem.normal_force_per_width)[..., None] / a
        bound = centre * (1.0 - (x / a) ** 2)
        stuck = creepage / flexibility * (x + a)
        slipping = np.abs(stuck) > bound
        fields = wl.LineFields(
            pressure=wl.hertz.pressure(x, a, problem.max_pressure[..., None]),
            traction=np.where(slipping, np.copysign(bound, creepage), stuck),
            slip=np.where(slipping, creepage + np.copysign(2.0 * flexibility * centre * x / a**2, x * creepage), 0.0),
            traction_bound=bound,
        )
        return self.made(problem, fields, x, np.broadcast_to(2.0 * a / self.cells, x.shape))

    def made(self, problem: wl.Problem, fields: wl.LineFields, x: Any, length: Any) -> wl.Contact:
        force = (fields.traction * length).sum(axis=-1)
        return wl.Contact.from_line(problem, fields, x=x, length=length, force_per_width=force)
