"""A weight on two rollers."""

from collections.abc import Mapping
from typing import Any, ClassVar

from numpy.typing import ArrayLike

import wearlaw as wl

GRAVITY = 9.81  # [m/s²]


class Weighted(wl.Rig):
    """Two rollers of one material, the upper one pressed down by a weight."""

    name: ClassVar[str] = "weighted"
    source: ClassVar[str] = "made up for tests"
    patch_geometry: ClassVar[wl.Geometry | None] = "line"
    example: ClassVar[Mapping[str, Any]] = {"mass": "20 kg", "creepage": "1 %", "friction_coefficient": 0.4}
    example_fields: ClassVar[Mapping[str, Any]] = {"material": "made_up_steel"}

    material: wl.MaterialField
    """Material of both rollers."""

    def problem(
        self, *, mass: wl.QuantityLike, creepage: wl.QuantityLike, friction_coefficient: ArrayLike
    ) -> wl.Problem:
        """Return the contact problem of the mass of the weight, the creepage ξ and the friction coefficient μ."""
        load = wl.Q(wl.Unit("kg").si(mass, "mass") * GRAVITY, "N")
        return self.rollers.problem(normal_force=load, creepage=creepage, friction_coefficient=friction_coefficient)

    @property
    def bodies(self) -> Mapping[str, wl.Body]:
        """Return the rollers by name; the wear of the first is predicted."""
        upper, lower = self.rollers.bodies.values()
        return {"upper": upper, "lower": lower}

    @property
    def rollers(self) -> wl.TwinDisc:
        """Return the rollers as two discs."""
        return wl.TwinDisc.suros(material=self.material, rolling_speed="1 m/s")
