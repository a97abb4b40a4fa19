"""The exact theory of rolling line contact (Carter, Johnson)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, Literal

import numpy as np

import wearlaw as wl
from wearlaw import Array
from wearlaw_models.contact_models.exact.kernel import excess_dissipation


class Exact(wl.LineContactModel):
    """Carter's exact solution for like materials: a stick zone [-a, -a+2c] at the leading edge, slip behind it.

    With k = μ/R the half-length of the stick zone is c = a - ξ/k. At and above the saturation creepage ξ_sat = μa/R,
    where c would not be positive, the whole patch slips. In the slip zone the traction is μp, and
    s = k √((x+a-c)² - c²), which for full slip becomes s = ξ + kx.

    Notes
    -----
    Tassini et al. (2010) print the slip in their eq. (7) as ξ + kx in the whole slip zone, in partial slip too, and
    (x+a+c) in place of (x+a-c) in their eq. (8). ``slip="as_printed"`` gives their eq. (7).
    """

    name: ClassVar[str] = "exact"
    source: ClassVar[str] = (
        "F. W. Carter, Proc. R. Soc. A 112 (1926) 151-157; K. L. Johnson, Contact Mechanics, Cambridge 1985, "
        "section 8.3, after Tassini et al., Wear 268 (2010) 660-667, section 3.2.1"
    )

    slip: Literal["consistent", "as_printed"] = "consistent"
    """"consistent": the slip that follows from the tractions. "as_printed": eq. (7) of Tassini et al. (2010),
    which jumps where slip begins and dissipates more energy than Tγ; use it to reproduce the paper."""

    @property
    def exemptions(self) -> Mapping[wl.Claim, str]:
        """The printed slip breaks the energy balance."""
        if self.slip == "consistent":
            return {}
        return {"energy_balance": "the printed slip lacks a term in partial slip"}

    def slip_length(self, problem: wl.Problem) -> Array:
        """Return 2 (a - c)."""
        return _slip_length(problem, _inverse_k(problem))

    def fields(self, problem: wl.Problem, nodes: wl.Nodes) -> wl.LineFields:
        """Return the fields of the paper's eqs. (7) and (8), corrected."""
        a, inverse_k = problem.half_width, _inverse_k(problem)
        k, length = 1.0 / inverse_k, _slip_length(problem, inverse_k)
        before, behind = nodes.from_trailing, nodes.from_leading  # a - x and x + a
        into = length - before  # x + a - 2c, the distance from the start of the slip zone
        slipping = into > 0.0
        root_before, root_behind, scale = np.sqrt(before), np.sqrt(behind), problem.max_pressure / a
        pressure = scale * root_before * root_behind
        bound = problem.friction_coefficient * pressure
        # μp - (c/a) μp0 √(1-((x+a-c)/c)²) as √A - √B = (A-B)/(√A + √B): no digits are lost, and it is never negative.
        roots = root_before + np.sqrt(np.maximum(-into, 0.0))
        growth = length * root_behind / np.maximum(roots, 1e-150)  # zero only at the trailing edge
        stuck = problem.friction_coefficient * scale * growth
        everywhere = problem.creepage + k * nodes.x
        if self.slip == "as_printed":
            slip = everywhere
        else:
            slip = np.where(problem.creepage < k * a, k * np.sqrt(np.maximum(into, 0.0) * behind), everywhere)
        return wl.LineFields(
            pressure=pressure,
            traction=np.where(slipping, bound, stuck),
            slip=np.where(slipping, slip, 0.0),
            traction_bound=bound,
        )

    def tangential_force_per_width(self, problem: wl.Problem) -> Array:
        """Return μP [1 - (c/a)²], with d = ξ/ξ_sat = (a-c)/a as μP d (2-d)."""
        d = np.minimum(problem.creepage / _saturation(problem), 1.0)
        return problem.friction_coefficient * problem.normal_force_per_width * d * (2.0 - d)

    def crossings(self, problem: wl.Problem, variable: str, value: Array) -> Array | None:
        """Return where the pressure or the slip crosses a value."""
        if variable == "pressure":
            return wl.hertz.distances_at_pressure(value, problem.half_width, problem.max_pressure)
        if variable != "slip":
            return None
        a, inverse_k = problem.half_width, _inverse_k(problem)
        length, grown = _slip_length(problem, inverse_k), value * inverse_k
        everywhere = a + problem.creepage * inverse_k - grown
        if self.slip == "as_printed":
            return everywhere[..., None]
        c = a - 0.5 * length
        partial = length - grown**2 / (c + np.sqrt(c**2 + grown**2))
        return np.where(length < 2.0 * a, partial, everywhere)[..., None]

    def excess_dissipation(self, problem: wl.Problem, threshold: float | Array) -> Array | None:
        """Return ∫ max(q·s - threshold, 0) dx [N/m] in closed form."""
        if self.slip == "as_printed":
            return None
        return excess_dissipation(
            problem.creepage,
            problem.friction_coefficient,
            problem.max_pressure,
            problem.half_width,
            problem.effective_modulus,
            threshold,
        )


def _inverse_k(problem: wl.Problem) -> Array:
    """Return 1/k = R/μ [m], a/ξ_sat."""
    return problem.half_width / _saturation(problem)


def _slip_length(problem: wl.Problem, inverse_k: Array) -> Array:
    """Return 2 (a - c) [m]."""
    return 2.0 * np.minimum(problem.creepage * inverse_k, problem.half_width)


def _saturation(problem: wl.Problem) -> Array:
    """Return ξ_sat = μa/R = 2 μ p0/E*."""
    return 2.0 * problem.friction_coefficient * problem.max_pressure / problem.effective_modulus


@wl.hookimpl
def wearlaw_models() -> list[type[wl.ContactModel]]:
    """Return the model of this plugin."""
    return [Exact]
