"""The exact theory of rolling line contact (Carter, Johnson) as a wearlaw plugin."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, Literal

import numpy as np

import wearlaw as wl
from wearlaw import Array


class Exact(wl.LineContactModel):
    """Carter's exact solution for like materials: a stick zone [-a, -a+2c] at the leading edge, slip behind it.

    With k = μ/R the half-length of the stick zone is c = a - ξ/k; where it would be negative, at and above the
    saturation creepage ξ_sat = μa/R, the whole patch slips. In the slip zone the traction is μp, and
    s = k √((x+a-c)² - c²), which for full slip becomes s = ξ + kx.

    Notes
    -----
    Tassini et al. (2010) print the slip of their eq. (7) as ξ + kx in the whole slip zone also for partial slip,
    and (x+a+c) in place of (x+a-c) in their eq. (8). The first is offered as ``slip="as_printed"``.
    """

    name: ClassVar[str] = "exact"
    source: ClassVar[str] = (
        "F. W. Carter, Proc. R. Soc. A 112 (1926) 151-157; K. L. Johnson, Contact Mechanics, Cambridge 1985, "
        "section 8.3; Tassini et al., Wear 268 (2010) 660-667, section 3.2.1"
    )

    slip: Literal["consistent", "as_printed"] = "consistent"
    """"consistent": the slip that follows from the tractions. "as_printed": eq. (7) of Tassini et al. (2010),
    which jumps where slip begins and dissipates more energy than Tγ; to reproduce the paper."""

    @property
    def exemptions(self) -> Mapping[wl.Claim, str]:
        """The printed slip breaks the energy balance."""
        if self.slip == "consistent":
            return {}
        return {"energy_balance": "the printed slip lacks a term in partial slip"}

    def slip_zone(self, problem: wl.LineProblem) -> tuple[Array, Array]:
        """Return [-a+2c, a]."""
        a = problem.half_width
        return a - 2.0 * np.minimum(problem.creepage * _inverse_k(problem), a), a

    def fields(self, problem: wl.LineProblem, x: Array) -> wl.LineFields:
        """Return the fields of the paper's eqs. (7) and (8), corrected."""
        a, k = problem.half_width, 1.0 / _inverse_k(problem)
        stick_start = np.minimum(problem.creepage / k, a)  # a - c, without its rounding at small creepage
        border = a - 2.0 * stick_start  # -a + 2c
        pressure = wl.hertz.pressure(x, a, problem.max_pressure)
        bound = problem.friction_coefficient * pressure
        # μp - (c/a) μp0 √(1-((x+a-c)/c)²) as √A - √B = (A-B)/(√A + √B), which loses no digits and is never negative.
        roots = np.sqrt(np.maximum(a - x, 0.0)) + np.sqrt(np.maximum(border - x, 0.0))
        growth = 2.0 * stick_start * np.sqrt(np.maximum(a + x, 0.0))
        growth = np.divide(growth, roots, out=np.zeros_like(roots), where=roots > 0)
        stuck = problem.friction_coefficient * problem.max_pressure / a * growth
        if self.slip == "as_printed":
            slip = problem.creepage + k * x
        else:
            partial = k * np.sqrt(np.maximum((x - border) * (x + a), 0.0))
            slip = np.where(problem.creepage < k * a, partial, problem.creepage + k * x)
        slipping = x > border
        return wl.LineFields(
            pressure=pressure,
            traction=np.where(slipping, bound, stuck),
            slip=np.where(slipping, slip, 0.0),
            traction_bound=bound,
        )

    def tangential_force_per_width(self, problem: wl.LineProblem) -> Array:
        """Return μP [1 - (c/a)²], with d = ξ/ξ_sat = (a-c)/a as μP d (2-d)."""
        d = np.minimum(problem.creepage * _inverse_k(problem) / problem.half_width, 1.0)
        return problem.friction_coefficient * problem.normal_force_per_width * d * (2.0 - d)


def _inverse_k(problem: wl.LineProblem) -> Array:
    """Return 1/k = R/μ [m]."""
    return problem.relative_radius / problem.friction_coefficient


@wl.hookimpl
def wearlaw_contact_models() -> list[type[wl.ContactModel]]:
    """Return the model of this plugin."""
    return [Exact]
