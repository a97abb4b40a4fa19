"""Brush models whose bristles let go: kinetic friction is lower than static friction, so energy is lost at a point."""

from __future__ import annotations

import dataclasses
from typing import Any, ClassVar, NamedTuple

import numpy as np

import wearlaw as wl
from tests.plugins.kit.cells import Cells

KINETIC = 0.5
"""Kinetic over static friction."""

NOT_CLAIMED = {
    "friction": "where it slips, the bound is that of kinetic friction",
    "growth": "kinetic friction is lower than static friction",
    "saturation": "in full slip the force is that of kinetic friction",
}


class LetGo(NamedTuple):
    """The point where the bristles let go, on a parabolic bound.

    A bristle of flexibility L sticks with the traction ξ (x+a)/L until that is the static bound, c (a-x)(a+x). Its
    traction then falls to the kinetic bound. In the fall it loses L (q_s² - q_k²)/2 per width, since
    ξ ∫q dx = L q_s²/2 in stick, and ξ ∫q dx = ∫q s dx - L q_k²/2 in slip.
    """

    flexibility: Any
    """L [m³/N]."""
    bound: Any
    """c, of the static bound [Pa/m²]."""
    slip_length: Any
    """Length of the slip zone [m]."""

    @classmethod
    def of(cls, problem: wl.Problem) -> LetGo:
        flexibility = 4.0 * problem.half_width / (np.pi * problem.effective_modulus)
        bound = 0.75 * problem.friction_coefficient * problem.normal_force_per_width / problem.half_width**3
        return cls(flexibility, bound, np.minimum(np.abs(problem.creepage) / (flexibility * bound), 2.0 * problem.a))

    def energy(self, problem: wl.Problem) -> Any:
        """Return the energy that is lost at the point, for a metre rolled [N]."""
        static = self.bound * self.slip_length * (2.0 * problem.half_width - self.slip_length)
        return 0.5 * self.flexibility * static**2 * (1.0 - KINETIC**2) * problem.track_width


class Brush(wl.LineContactModel):
    """A brush in closed form, whose fields lack the energy of the point where the bristles let go."""

    name: ClassVar[str] = "brush"
    source: ClassVar[str] = "made up for the tests"

    square_roots_at = "patch"

    @property
    def exemptions(self) -> Any:
        return {**NOT_CLAIMED, "energy_balance": "bristles lose energy at the point where they let go"}

    def slip_length(self, problem: wl.Problem) -> Any:
        return LetGo.of(problem).slip_length

    def fields(self, problem: wl.Problem, nodes: wl.Nodes) -> wl.LineFields:
        flexibility, c, length = LetGo.of(problem)
        static = c * nodes.from_trailing * nodes.from_leading
        slips = (nodes.from_trailing < length) & (length > 0.0)
        slope = c * (nodes.from_trailing - nodes.from_leading)
        return wl.LineFields(
            pressure=wl.hertz.pressure(nodes.x, problem.half_width, problem.max_pressure),
            traction=np.where(slips, KINETIC * static, problem.creepage / flexibility * nodes.from_leading),
            slip=np.where(slips, problem.creepage - flexibility * KINETIC * slope, 0.0),
            traction_bound=np.where(slips, KINETIC * static, static),
        )

    def tangential_force_per_width(self, problem: wl.Problem) -> Any:
        flexibility, c, length = LetGo.of(problem)
        stick = 2.0 * problem.half_width - length
        slipping = c * length**2 * (problem.half_width - length / 3.0)
        return 0.5 * problem.creepage / flexibility * stick**2 + KINETIC * slipping


class BrushOnCells(Cells):
    """The same brush on cells: the first cell that slips also has the slip of the bristles that let go in it."""

    name: ClassVar[str] = "brush_on_cells"

    @property
    def exemptions(self) -> Any:
        return {**NOT_CLAIMED, "continuity": "the traction of a whole cell falls at once"}

    def solve_line(self, problem: wl.Problem) -> wl.Contact:
        x = problem.half_width[..., None] * ((2.0 * np.arange(self.cells) + 1.0) / self.cells - 1.0)
        length = np.broadcast_to(2.0 * problem.half_width[..., None] / self.cells, x.shape)
        a = problem.half_width[..., None]
        fields = Brush().fields(problem.forward()[..., None], wl.Nodes(a + x, a - x, length))
        slips = fields.slip != 0.0
        first = slips & (slips.cumsum(axis=-1) == 1)
        energy = (LetGo.of(problem).energy(problem) / problem.track_width)[..., None]
        there = first & (fields.traction > 0.0)
        let_go = np.divide(energy, fields.traction * length, out=np.zeros_like(x), where=there)
        sign = np.sign(problem.creepage)[..., None]
        fields = dataclasses.replace(fields, traction=sign * fields.traction, slip=sign * (fields.slip + let_go))
        return self.made(problem, fields, x, length)
