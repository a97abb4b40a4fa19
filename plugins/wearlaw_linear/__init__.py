"""Kalker's linear theory of rolling contact as a wearlaw plugin."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

import wearlaw as wl


class Linear(wl.CreepForceModel):
    """Kalker's linear theory: the whole patch sticks, and the forces are linear in the creepages.

    With the creepage coefficients Cij of `wl.kalker`, which depend on a/b and on ν,

        Fx = G ab C11 ξ,  Fy = G ab (C22 η + √(ab) C23 φ),  Mz = G ab (-√(ab) C23 η + ab C33 φ).

    Notes
    -----
    It is the limit of the full theory for vanishing creepage and knows no friction. Beside the half-space solution of
    CONTACT for pure longitudinal creepage at a = b/2, its force is 7 % too high where that is 0.26 μN, 17 % at 0.47 μN,
    28 % at 0.65 μN, and grows without end.
    """

    name: ClassVar[str] = "linear"
    source: ClassVar[str] = (
        "J. J. Kalker, On the rolling contact of two elastic bodies in the presence of dry friction, doctoral thesis,"
        " Delft University of Technology, 1967"
    )

    interpolation: wl.kalker.Interpolation = "scaled"
    """How the table of the coefficients is read, as in `wl.kalker.coefficients`. "contact": as the program CONTACT
    does, for comparisons with it."""

    @property
    def exemptions(self) -> Mapping[wl.Claim, str]:
        """Linear forces know no friction."""
        exempt: dict[wl.Claim, str] = {
            "traction_bound": "the force is linear in the creepage and passes μN",
            "saturation": "the force is linear in the creepage and passes μN",
            "stick": "the one node slips by what dissipates the energy of the creepages, at any traction",
        }
        if self.interpolation == "contact":
            exempt["initial_slope"] = "between the rows of Kalker's table long patches differ"
        return exempt

    def creep_forces(self, problem: wl.Problem) -> wl.CreepForces:
        """Return the forces and the moment, of the batch shape."""
        return wl.kalker.linear_forces(problem, self.interpolation)


@wl.hookimpl
def wearlaw_contact_models() -> list[type[wl.ContactModel]]:
    """Return the model of this plugin."""
    return [Linear]
