"""The creep-force model of Shen, Hedrick and Elkins."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

import numpy as np

import wearlaw as wl


class ShenHedrickElkins(wl.CreepForceModel):
    """The forces of Kalker's linear theory, reduced by one factor to what friction can transmit.

    With the linear forces and moment F'x, F'y and M'z, as in the contact model `linear`, and u = √(F'x² + F'y²)/(μN),

        F/(μN) = u - u²/3 + u³/27 for u ≤ 3, and 1 above,

    in the direction of (F'x, F'y). The cubic is 1 - (1 - u/3)³: Johnson and Vermeulen's form, with Kalker's
    coefficients.

    Mz is M'z times the same factor, F/(μN u), so that Tγ is a sum of squares, G ab (C11 ξ² + C22 η² + ab C33 φ²), times
    that factor.

    Notes
    -----
    Prefer this for vehicle dynamics on the tread: with little spin its forces are on average nearer to the half-space
    theory than those of `polach`. It can't take much spin, because it counts spin as if all of the patch stuck. Under a
    large spin alone the true Fy falls to zero, but this one rises to μN. Where spin works against a lateral creepage,
    the linear forces cancel, but the true ones do not. Mz is a guess wherever the patch slips. The theory of
    elliptic contact in the documentation has tables of its errors.
    """

    name: ClassVar[str] = "shen_hedrick_elkins"
    source: ClassVar[str] = (
        "Z. Y. Shen, J. K. Hedrick, J. A. Elkins, Vehicle System Dynamics 12 (1983) 79-83; P. J. Vermeulen,"
        " K. L. Johnson, ASME J. Appl. Mech. 31 (1964) 338-340"
    )

    @property
    def exemptions(self) -> Mapping[wl.Claim, str]:
        """The one node slips as a whole."""
        return {"stick": "the one node slips as a whole, with a traction below its bound"}

    def creep_forces(self, problem: wl.Problem) -> wl.CreepForces:
        """Return the forces and the moment, of the batch shape."""
        linear = wl.kalker.linear_forces(problem)
        share = linear.tangential / (problem.friction_coefficient * problem.normal_force)
        partial = np.minimum(share, 3.0) / 3.0
        factor = (1.0 - partial + partial**2 / 3.0) * (3.0 / np.maximum(share, 3.0))
        return wl.CreepForces(
            longitudinal=factor * linear.longitudinal,
            lateral=factor * linear.lateral,
            spin_moment=factor * linear.spin_moment,
        )


@wl.hookimpl
def wearlaw_models() -> list[type[wl.ContactModel]]:
    """Return the model of this plugin."""
    return [ShenHedrickElkins]
