"""A weight on two rollers."""

import dataclasses
from collections.abc import Mapping
from typing import Annotated, Any, ClassVar, TypedDict, Unpack

import wearlaw as wl

GRAVITY = 9.81  # [m/s²]


class WeightedConditions(TypedDict):
    """The conditions of a test."""

    mass: Annotated[wl.QuantityLike, wl.Unit("kg")]
    """Mass of the weight [kg]."""
    creepage: wl.Creepage
    """Creepage, ξ [-]."""
    friction_coefficient: wl.Coefficient
    """Friction coefficient, μ [-]."""


@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class WeightedProblem(wl.Problem):
    """The contact of the rollers, with the load on the bearings of the lower one."""

    bearing_load: wl.Array

    results: ClassVar[tuple[wl.Variable, ...]] = (
        wl.Variable(
            "bearing_load",
            unit="N",
            long_name="bearing load B",
            meaning="Load of each of the two bearings of the lower roller",
            symbol="B",
        ),
    )


class Weighted(wl.Rig):
    """Two rollers of one material, the upper one pressed down by a weight."""

    name: ClassVar[str] = "weighted"
    source: ClassVar[str] = "made up for tests"
    patch_geometry: ClassVar[wl.Geometry | None] = "line"
    example: ClassVar[Mapping[str, Any]] = {"mass": "20 kg", "creepage": "1 %", "friction_coefficient": 0.4}
    example_fields: ClassVar[Mapping[str, Any]] = {"material": "made_up_steel"}

    material: wl.MaterialField
    """Material of both rollers."""

    def problem(self, **conditions: Unpack[WeightedConditions]) -> wl.Problem:
        """Return the contact problem of the conditions; arrays broadcast against each other."""
        given = self.in_si(conditions)
        weight = given["mass"] * GRAVITY
        problem = self.rollers.problem(
            normal_force=wl.Q(weight, "N"),
            creepage=wl.Q(given["creepage"], ""),
            friction_coefficient=given["friction_coefficient"],
        )
        return WeightedProblem.of(problem, bearing_load=0.5 * weight)

    @property
    def bodies(self) -> Mapping[str, wl.Body]:
        """Return the rollers by name; the wear of the first is predicted."""
        upper, lower = self.rollers.bodies.values()
        return {"upper": upper, "lower": lower}

    @property
    def rollers(self) -> wl.TwinDisc:
        """Return the rollers as two discs."""
        return wl.TwinDisc.suros(material=self.material, rolling_speed="1 m/s")
