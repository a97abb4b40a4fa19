"""Kalker's linear theory of rolling contact."""

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
    The linear theory is the limit of the full theory for vanishing creepage, and ignores friction. Compared with the
    half-space solution of CONTACT for pure longitudinal creepage at a = b/2, its force is 7 % too high at 0.26 μN, 17 %
    at 0.47 μN and 28 % at 0.65 μN. It grows without limit.
    """

    name: ClassVar[str] = "linear"
    source: ClassVar[str] = (
        "J. J. Kalker, On the rolling contact of two elastic bodies in the presence of dry friction, doctoral thesis,"
        " Delft University of Technology, 1967; forces after the source of the program CONTACT"
        " (E. A. H. Vollebregt), moment after another program"
    )

    interpolation: wl.kalker.Interpolation = "scaled"
    """Method of interpolating the coefficients, as in `wl.kalker.coefficients`. "contact" interpolates as the program
    CONTACT does, for comparisons with it."""

    @property
    def exemptions(self) -> Mapping[wl.Claim, str | wl.Exempt]:
        """The linear forces ignore friction."""
        exempt: dict[wl.Claim, str | wl.Exempt] = {
            "traction_bound": "the force is linear in the creepage and passes μN",
            "saturation": "the force is linear in the creepage and passes μN",
            "stick": "the one node slips at any traction, so that it dissipates the energy of the creepages",
        }
        if self.interpolation == "contact":
            reason = "the slopes of long patches differ between the rows of Kalker's table"
            exempt["initial_slope"] = wl.Exempt(reason, upto=0.17)
        return exempt

    def creep_forces(self, problem: wl.Problem) -> wl.CreepForces:
        """Return the forces and the moment, of the batch shape."""
        return wl.kalker.linear_forces(problem, self.interpolation)


@wl.hookimpl
def wearlaw_models() -> list[type[wl.ContactModel]]:
    """Return the model of this plugin."""
    return [Linear]
