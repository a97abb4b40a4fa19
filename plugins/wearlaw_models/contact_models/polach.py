"""Polach's creep-force model."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, ClassVar

import numpy as np
from pydantic import Field, model_validator

import wearlaw as wl
from wearlaw import Array

Factor = Annotated[float, Field(gt=0.0, le=1.0, strict=True)]


class Polach(wl.CreepForceModel):
    """Polach's method: a closed form for the force of a patch that sticks and slips, and a term for the spin.

    With the creepage s = √(ξ² + η²), its coefficient C = √((C11 ξ)² + (C22 η)²)/s, and Kalker's Cij of `wl.kalker`,

        F = (2/π) μN [k_A ε/(1 + (k_A ε)²) + arctan(k_S ε)],  ε = π G ab C s_C/(4 μN),
        Fx = F ξ/s_C,  Fy = F η/s_C + F_S φ/s_C,

    where s_C² = ξ² + η_C², and η_C is the larger in magnitude of η and η + φa, the creepage at the leading edge. The
    part of the spin is

        F_S = -(9/16) a μN K K_M,  K = 1 + 6.3 (1 - exp(-a/b)),
        K_M = ε_S (δ³/3 - δ²/2 + 1/6) - √((1 - δ²)³)/3,  δ = (ε_S² - 1)/(ε_S² + 1),
        ε_S = (8/3) G b √(ab) C23 |η_C|/(K μN),

    which is F_S = G ab √(ab) C23 |η_C|/(1 + ε_S²)².

    The reduction factors k_S ≤ k_A ≤ 1 are for contacts less stiff than clean smooth ones. Polach's typical values are
    k_A = 1 and k_S = 0.4 on dry rails, 0.3 and 0.1 on wet ones, together with friction that falls with the creep speed,
    `wl.FallingFriction`. The factors do not act on the part of the spin. Below k_S = 0.13 k_A the force is not monotone
    in the creepage.

    Polach leaves the moment out: spin alone would dissipate nothing, and spin against a lateral creepage could give a
    negative Tγ. Here Mz is the moment of the linear theory, reduced like the forces: -F_S η/s_C from the lateral
    creepage, and G ab ab C33 φ times F/(G ab C s_C), with C = C22, from the spin. Tγ is then a sum of squares.

    Notes
    -----
    Prefer this at the limit of adhesion, on wet or dirty track, for which there are values of k_A and k_S. It can't
    stand in for `fastsim` where the contact spins, because one term covers the spin, from the creepage at the leading
    edge: it is furthest off on long patches where spin works against the lateral creepage. Pure creepages meet Kalker's
    linear theory where they are small; in combinations C stands in for C11 and C22, and ξ weakens the part of the spin.
    The theory of elliptic contact in the documentation has tables of its errors.
    """

    name: ClassVar[str] = "polach"
    source: ClassVar[str] = (
        "O. Polach, Vehicle System Dynamics Suppl. 33 (1999) 728-739; the factors k_A and k_S: O. Polach, Wear 258"
        " (2005) 992-1000, eqs. (4), (11) and Table 2"
    )

    adhesion_reduction: Factor = 1.0
    """Reduction factor in the area of adhesion, k_A [-]."""
    slip_reduction: Factor = 1.0
    """Reduction factor in the area of slip, k_S [-], at most k_A."""

    @model_validator(mode="after")
    def _ordered(self) -> Polach:
        if self.slip_reduction > self.adhesion_reduction:
            raise ValueError(
                f"slip_reduction must not lie above adhesion_reduction = {self.adhesion_reduction!r};"
                f" got {self.slip_reduction!r}"
            )
        return self

    @property
    def exemptions(self) -> Mapping[wl.Claim, str | wl.Exempt]:
        """The force tends to μN without reaching it; reduction factors change the initial slope."""
        exempt: dict[wl.Claim, str | wl.Exempt] = {
            "stick": "the one node slips as a whole, with a traction below its bound",
            # At 100 times the creepage of linear theory for μN, ε is 25π, and T/(μN) is 1 - 2/(π k_S ε) at the least.
            "saturation": wl.Exempt("the force tends to μN without reaching it", upto=0.0082 / self.slip_reduction),
        }
        if self.slip_reduction < 1.0:
            lower = 1.0 - 0.5 * (self.adhesion_reduction + self.slip_reduction)
            reason = "the reduction factors lower it to (k_A + k_S)/2 of Kalker's"
            exempt["initial_slope"] = wl.Exempt(reason, upto=lower + 1e-3)
            reason = "the part of the spin is not reduced, and can pass μN on a long patch"
            exempt["traction_bound"] = wl.Exempt(reason, only="spin")
        return exempt

    def creep_forces(self, problem: wl.Problem) -> wl.CreepForces:
        """Return the forces and the moment, of the batch shape."""
        along, across, spin = problem.longitudinal_creepage, problem.lateral_creepage, problem.spin
        c = wl.kalker.coefficients(problem.a / problem.b, problem.poisson_ratio)
        ab = problem.a * problem.b
        stiffness, bound = problem.shear_modulus * ab, problem.friction_coefficient * problem.normal_force
        leading = np.maximum(np.abs(across), np.abs(across + spin * problem.a))  # |η_C|
        total = np.hypot(along, leading)  # s_C
        gradient = 0.25 * np.pi * stiffness * total / bound  # ε/C
        mean = _ratio(np.hypot(c.c11 * along, c.c22 * across), np.hypot(along, across))  # C
        straight = stiffness * mean * self._reduction(gradient * mean)  # F/s_C
        turn = stiffness * np.sqrt(ab) * c.c23  # F_S/s_C where everything sticks
        elongation = 1.0 + 6.3 * (1.0 - np.exp(-problem.a / problem.b))  # K
        turn_gradient = 8.0 / 3.0 * turn * leading / (problem.a * elongation * bound)  # ε_S
        turn = turn * _ratio(leading, total) / (1.0 + turn_gradient**2) ** 2
        twist = stiffness * ab * c.c33 * self._reduction(gradient * c.c22)
        return wl.CreepForces(
            longitudinal=straight * along,
            lateral=straight * across + turn * spin,
            spin_moment=twist * spin - turn * across,
        )

    def _reduction(self, gradient: Array) -> Array:
        """Return F over the force of the linear theory, F/(G ab C s_C), for ε."""
        adhesion = self.adhesion_reduction / (1.0 + (self.adhesion_reduction * gradient) ** 2)
        slip = _ratio(np.arctan(self.slip_reduction * gradient), gradient)
        return 0.5 * (adhesion + slip)


def _ratio(value: Array, over: Array) -> Array:
    """Return a quotient, or zero where nothing moves: any finite number would do, as it is multiplied by zero."""
    ratio: Array = np.divide(value, over, out=np.zeros_like(over), where=over > 0)
    return ratio


@wl.hookimpl
def wearlaw_models() -> list[type[wl.ContactModel]]:
    """Return the model of this plugin."""
    return [Polach]
