"""Laws of other outcomes than wear, and of each body, that tests of fits, comparisons and uncertainties share."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar

from pydantic import Field

import wearlaw as wl
from wearlaw import Array, Q


class Heat(wl.Law):
    """The share of the frictional power that enters one body, over area."""

    name: ClassVar[str] = "heat"
    source: ClassVar[str] = "test"
    outcome = wl.Outcome("heat_flux", unit="W/mm^2", of="area mean")
    zero_in_stick: ClassVar[bool] = True

    share: Annotated[float, Field(gt=0.0)] = 0.5

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Array:
        return p["share"] * contact.frictional_power_density

    def breakpoints(self, p: wl.Numbers) -> wl.BreakpointMap:
        return {}


class Damage(wl.Law):
    """Damage of a passage, linear in Tγ beyond a threshold; it has a sign, as wear removes it."""

    name: ClassVar[str] = "damage"
    source: ClassVar[str] = "test"
    outcome = wl.Outcome("rcf_damage", unit="", of="patch", sign="any")

    threshold: Annotated[wl.Quantity, wl.Unit("N")] = Q(15.0, "N")
    slope: Annotated[wl.Quantity, wl.Unit("1/N")] = Q(1e-6, "1/N")

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Array:
        return p["slope"] * (contact.wear_index - p["threshold"])


class Volume(wl.WearLaw):
    """Wear of a volume, so that the mass lost grows with the density."""

    name: ClassVar[str] = "volume"
    source: ClassVar[str] = "test"
    factor: float = 1.0

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Array:
        return 1e-15 * p["factor"] * contact.per_node(contact.density) * contact.wear_index_density

    def breakpoints(self, p: wl.Numbers) -> wl.BreakpointMap:
        return {}


BRONZE = wl.Material(youngs_modulus="110 GPa", poisson_ratio=0.33, density="8800 kg/m^3")
MIXED = wl.TwinDisc(
    disc_1=wl.Disc(diameter="47 mm", material=wl.steel()),
    disc_2=wl.Disc(diameter="47 mm", material=BRONZE),
    track_width="10 mm",
    rolling_speed="1 m/s",
)
CREEPAGE = Q([0.1, 0.2, 0.4, 0.7, 1.0, 2.0, 4.0], "%")
CONDITIONS: Any = {"creepage": CREEPAGE, "normal_force": Q(7.4, "kN"), "friction_coefficient": 0.4}
