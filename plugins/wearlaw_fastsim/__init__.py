"""Kalker's simplified theory (FASTSIM) for rolling line contact as a wearlaw plugin."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, Literal

import numpy as np

import wearlaw as wl
from wearlaw import Array


class Fastsim(wl.LineContactModel):
    """FASTSIM in two dimensions: displacement proportional to traction, u = L q.

    From the leading edge the traction grows by ξ/L per length until it meets the bound μ p2, which it then
    follows with the slip s = ξ - L d(μ p2)/dx. In two dimensions, with constant creepage, the march from cell to
    cell has this closed form, since the bound is concave.

    `pressure` is always Hertz's; the parabola is the bound of the traction only.
    """

    name: ClassVar[str] = "fastsim"
    source: ClassVar[str] = (
        "J. J. Kalker, Vehicle System Dynamics 11 (1982) 1-13; Tassini et al., Wear 268 (2010) 660-667, section 3.2.2"
    )

    bound: Literal["parabolic", "elliptic"] = "parabolic"
    """Shape of p2 in the bound μ p2 of the traction, with the load of Hertz's pressure: the parabola
    3P/(4a) (1-(x/a)²), or Hertz's ellipse."""

    flexibility: Literal["line", "kalker"] = "line"
    """L [m³/N]. "line": 4a/(πE*), which gives the initial slope of the exact theory. "kalker": 32a/(3π²E*), the
    limit of Kalker's coefficient for a long ellipse."""

    @property
    def exemptions(self) -> Mapping[wl.Claim, str]:
        """The elliptic bound never saturates; Kalker's flexibility has another initial slope."""
        exempt: dict[wl.Claim, str] = {}
        if self.bound == "elliptic":
            exempt["saturation"] = "the bound rises infinitely steeply at the leading edge, which always sticks"
        if self.flexibility == "kalker":
            exempt["initial_slope"] = "the flexibility is that of a long ellipse"
        return exempt

    def slip_zone(self, problem: wl.LineProblem) -> tuple[Array, Array]:
        """Return from where the traction meets its bound to the trailing edge."""
        a, saturation = problem.half_width, self._saturation(problem)
        if self.bound == "parabolic":
            return a - 2.0 * a * np.minimum(saturation, 1.0), a
        return a - 2.0 * a * (saturation**2 / (1.0 + saturation**2)), a

    def fields(self, problem: wl.LineProblem, x: Array) -> wl.LineFields:
        """Return the fields of the paper's eqs. (11) to (13), in closed form."""
        a, creepage, flexibility = problem.half_width, problem.creepage, self._flexibility(problem)
        bound, slope = self._bound(problem, x)
        stuck = creepage / flexibility * (x + a)
        slipping = stuck > bound
        return wl.LineFields(
            pressure=wl.hertz.pressure(x, a, problem.max_pressure),
            traction=np.where(slipping, bound, stuck),
            slip=np.where(slipping, creepage - flexibility * slope, 0.0),
            traction_bound=bound,
        )

    def tangential_force_per_width(self, problem: wl.LineProblem) -> Array:
        """Return T [N/m].

        Parabolic: μP [1 - (1-d)³], d = ξ/ξ_f, ξ_f = 3μPL/(2a²). Elliptic: μP (2/π) [atan κ + κ/(1+κ²)],
        κ = ξa/(μ p0 L).
        """
        saturation = self._saturation(problem)
        if self.bound == "parabolic":
            d = np.minimum(saturation, 1.0)
            share: Array = d * (3.0 - 3.0 * d + d**2)
        else:
            share = 2.0 / np.pi * (np.arctan(saturation) + saturation / (1.0 + saturation**2))
        return problem.friction_coefficient * problem.normal_force_per_width * share

    def _flexibility(self, problem: wl.LineProblem) -> Array:
        factor = 4.0 / np.pi if self.flexibility == "line" else 32.0 / (3.0 * np.pi**2)
        return factor * problem.half_width / problem.effective_modulus

    def _saturation(self, problem: wl.LineProblem) -> Array:
        """Return d (parabolic) or κ (elliptic): creepage over the creepage that the bound's size sets."""
        grip = problem.friction_coefficient * self._flexibility(problem)
        if self.bound == "parabolic":
            grip = grip * 1.5 * problem.normal_force_per_width / problem.half_width
        else:
            grip = grip * problem.max_pressure
        return problem.creepage * problem.half_width / grip

    def _bound(self, problem: wl.LineProblem, x: Array) -> tuple[Array, Array]:
        """Return the bound [Pa] and its derivative in x [Pa/m]."""
        a, friction = problem.half_width, problem.friction_coefficient
        inside = np.maximum((a - x) * (a + x), 0.0)
        if self.bound == "parabolic":
            scale = friction * 0.75 * problem.normal_force_per_width / a**3
            return scale * inside, -2.0 * scale * x
        scale = friction * problem.max_pressure / a
        # At an edge the slope is infinite; x is no finer than rounding there, and q·s keeps its finite limit.
        root = np.sqrt(np.maximum(inside, 0.25 * np.finfo(np.float64).eps * a**2))
        return scale * root, -scale * x / root


@wl.hookimpl
def wearlaw_contact_models() -> list[type[wl.ContactModel]]:
    """Return the model of this plugin."""
    return [Fastsim]
