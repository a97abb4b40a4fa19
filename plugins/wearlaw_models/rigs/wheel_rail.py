"""A wheel on a rail, and the contact problem that its conditions pose."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, NamedTuple, Required, TypedDict, Unpack

import numpy as np
from pydantic import Field, field_validator, model_validator

import wearlaw as wl
from wearlaw import Array

Radius = Annotated[wl.Quantity, wl.Unit("mm", positive=False, infinite=True)]
Angle = Annotated[wl.Quantity, wl.Unit("deg", positive=False)]


LEAST_RADIUS = 1e-150
"""Least magnitude of a radius of curvature [m]; its square is a float of full precision."""

USUAL_WIDTH = 20e-3
"""Greatest usual half width of a patch on a rail [m]; a corner with a radius of 13 mm has less."""


class WheelRailConditions(TypedDict, total=False):
    """The conditions of a wheel on a rail; exactly one of the first two gives the load. Arrays broadcast.

    Creepages are the velocity of the wheel minus that of the rail, over V, as in CONTACT; a positive spin adds to a
    positive lateral creepage at the leading edge. The contact angle is positive where the surface falls towards y.
    """

    normal_force: Annotated[wl.QuantityLike, wl.Unit("kN", positive=False, negative=False, usual=(0.1, 300.0))]
    """Normal force, N [N]; zero where the wheel is lifted, and all results with it."""
    max_pressure: Annotated[wl.QuantityLike, wl.Unit("MPa", positive=False, negative=False, usual=(5.0, 10000.0))]
    """Hertz's maximum pressure, p0 [Pa]; zero as for the normal force."""
    longitudinal_creepage: Required[wl.Creepage]
    """Longitudinal creepage, ξ [-], of magnitude at most 1; positive if the wheel is braked."""
    lateral_creepage: wl.Creepage
    """Lateral creepage, η [-], of magnitude at most 1; zero if not given."""
    spin: Annotated[wl.QuantityLike, wl.Unit("1/m", positive=False, usual=(-100.0, 100.0))]
    """Spin, φ [1/m]; that of the contact angle, sin δ / r, with a roller sin δ (1/r + 1/R), if not given."""
    contact_angle: Annotated[wl.QuantityLike, wl.Unit("deg", positive=False)]
    """Contact angle, δ [rad], between -90 and 90 deg; that of the rig if not given."""
    rolled_distance: Annotated[wl.QuantityLike, wl.Unit("km", positive=False, negative=False)]
    """Distance that the bodies have rolled since they were new [m], for laws of running-in."""
    friction_coefficient: Required[wl.Friction]
    """Friction coefficient, μ [-]."""


class _Patch(NamedTuple):
    """The patch under a load of 1 N at a contact angle, and the spin of that angle, in SI."""

    a: float | Array
    b: float | Array
    max_pressure: float | Array
    spin: float | Array


class _Constants(NamedTuple):
    """Values shared by all operating points, in SI; G and ν are the means of both bodies."""

    shear_modulus: float
    poisson_ratio: float
    density: float
    rolling_speed: float


class WheelRail(wl.Rig):
    """A wheel that rolls on a straight rail and touches it in a point, which the load widens to an ellipse.

    Radii of curvature are positive for a convex body, infinite for a flat one and negative for a concave one. The
    lateral radii are those of the profiles, in a plane upright and across the rail. On a surface at the contact angle
    δ, a wheel of the rolling radius r has the radius of curvature r/cos δ in the plane of the rolling direction and the
    normal. It still rolls 2πr in a revolution. The normal force, the pressure and the lateral creepage and force are
    normal and tangential to that surface. On a roller rig, a roller whose axis is parallel to the axle stands for the
    rail; both roll at V.

    Materials may differ. The rig then takes E* and Kalker's means of G and ν.
    """

    name: ClassVar[str] = "wheel_rail"
    source: ClassVar[str] = "Hertz's theory: K. L. Johnson, Contact Mechanics, Cambridge 1985, section 4.2(b)"
    patch_geometry: ClassVar[wl.Geometry | None] = "ellipse"
    creepage: ClassVar = "longitudinal_creepage"
    choices: ClassVar = [("normal_force", "max_pressure")]
    example: ClassVar[Mapping[str, Any]] = {
        "normal_force": "80 kN",
        "longitudinal_creepage": "0.2 %",
        "lateral_creepage": "0.1 %",
        "spin": "0.2 1/m",
        "friction_coefficient": 0.3,
    }
    example_fields: ClassVar[Mapping[str, Any]] = {
        "wheel_radius": "460 mm",
        "rail_head_radius": "300 mm",
        "material": "steel",
        "rolling_speed": "30 m/s",
    }

    wheel_radius: Annotated[wl.Quantity, wl.Unit("mm", usual=(10.0, 700.0))]
    """Rolling radius of the wheel at the contact point, from the axle, r [m]."""
    rail_head_radius: Radius
    """Lateral radius of the rail head at the contact point [m]."""
    wheel_profile_radius: Radius = Field(default="inf mm", validate_default=True)
    """Lateral radius of the wheel profile at the contact point [m]; infinite for a cone, negative for a worn hollow."""
    contact_angle: Angle = Field(default="0 deg", validate_default=True)
    """Contact angle, δ [rad], between -90 and 90 deg, positive where the surface falls towards y; the condition of the
    same name replaces it."""
    roller_radius: Annotated[wl.Quantity, wl.Unit("mm")] | None = None
    """Rolling radius of the roller in place of the rail at the contact point, from its axis, R [m]; None for a rail."""
    material: wl.MaterialField
    """Material of wheel and rail; a file may also give the name of an installed material."""
    rail_material: wl.MaterialField | None = None
    """Material of the rail, if it differs from the wheel's."""
    rolling_speed: wl.Speed
    """Rolling speed, V [m/s]."""

    if TYPE_CHECKING:

        def __init__(
            self,
            *,
            wheel_radius: wl.QuantityLike,
            rail_head_radius: wl.QuantityLike,
            wheel_profile_radius: wl.QuantityLike = "inf mm",
            contact_angle: wl.QuantityLike = "0 deg",
            roller_radius: wl.QuantityLike | None = None,
            material: wl.Material,
            rail_material: wl.Material | None = None,
            rolling_speed: wl.QuantityLike,
        ) -> None: ...

    @field_validator("contact_angle")
    @classmethod
    def _not_upright(cls, angle: wl.Quantity) -> wl.Quantity:
        _check_angle(wl.scalar_si(angle, "rad"))
        return angle

    @model_validator(mode="after")
    def _touch_in_a_point(self) -> WheelRail:
        radii = wl.scalar_si(self.rail_head_radius, "m"), wl.scalar_si(self.wheel_profile_radius, "m")
        if min(map(abs, radii)) < LEAST_RADIUS:
            raise ValueError('a radius must not be zero or next to it; a flat body has the radius "inf mm"')
        across = 1.0 / radii[0] + 1.0 / radii[1]
        if across <= 0.0:
            raise ValueError(
                f"rail_head_radius {self.rail_head_radius!r} and wheel_profile_radius {self.wheel_profile_radius!r}"
                f" have curvatures that sum to {across:.4g} 1/m across the rail; the bodies touch in a point only if"
                " the sum is positive, so a hollow must have a larger radius than the body inside it"
            )
        return self

    @property
    def bodies(self) -> Mapping[str, wl.Body]:
        """The "wheel" and the "rail"."""
        return self._bodies

    @cached_property
    def _bodies(self) -> dict[str, wl.Body]:
        return {
            "wheel": wl.Body(self.material, wl.scalar_si(self.wheel_radius, "m")),
            "rail": wl.Body(self.rail_material or self.material, self._roller, usual_width=USUAL_WIDTH),
        }

    @np.errstate(all="ignore")  # `checked` rejects what overflows
    def problem(self, /, **conditions: Unpack[WheelRailConditions]) -> wl.Problem:
        """Return the contact problem that the conditions pose.

        Raises
        ------
        ConditionsError
            If conditions are missing, unknown or contradictory, or do not broadcast.
        UnitError
            If a condition lacks its unit or is out of bounds.
        """
        constants = self._constants
        arrays = self.in_si(
            conditions,
            lambda a: constants.rolling_speed * np.hypot(a["longitudinal_creepage"], a["lateral_creepage"]),
            lateral_creepage=0.0,
            spin=0.0,
        )
        arrays.pop("rolled_distance", None)  # for laws that declare it
        shape = arrays["longitudinal_creepage"].shape
        patch, angle = self._patch, arrays.get("contact_angle")
        if angle is not None:
            _check_angle(angle, "contact_angle: ")
            # An axis of stride 0 repeats one angle, for which one patch is enough.
            patch = self._patch_at(angle[tuple(slice(None if stride else 1) for stride in angle.strides)])
        elif patch.spin:
            arrays["contact_angle"] = np.broadcast_to(self._angle, shape)
        if "contact_angle" in arrays and conditions.get("spin") is None:
            arrays["spin"] = np.broadcast_to(patch.spin, shape)
        if "max_pressure" in arrays:
            pressure = arrays.pop("max_pressure")
            arrays["normal_force"] = (pressure / patch.max_pressure) ** 3
        loaded = arrays["normal_force"] > 0.0
        scale = np.cbrt(arrays["normal_force"])
        a, b = patch.a * scale, patch.b * scale
        same: dict[str, Any] = constants._asdict()
        same = {name: np.broadcast_to(value, shape) if shape else np.float64(value) for name, value in same.items()}
        if not loaded.all():
            same |= {"exists": loaded, "unloaded": ~loaded}
        return wl.Problem.ellipse_from_si(a=a, b=b, bodies=self._bodies, **arrays, **same).checked()

    @property
    def _roller(self) -> float:
        """The rolling radius of the roller [m], infinite for a rail."""
        return np.inf if self.roller_radius is None else wl.scalar_si(self.roller_radius, "m")

    @cached_property
    def _angle(self) -> Array:
        """The contact angle of the rig [rad]."""
        return np.asarray(wl.scalar_si(self.contact_angle, "rad"))

    @cached_property
    def _patch(self) -> _Patch:
        """The patch at the contact angle of the rig."""
        return _Patch(*(float(value) for value in self._patch_at(self._angle)))

    def _patch_at(self, angle: Array) -> _Patch:
        """Return the patch at contact angles [rad], of their shape."""
        modulus = wl.hertz.effective_modulus(*(value for pair in self._elastic for value in pair))
        radii = (self.wheel_radius, self.wheel_profile_radius, self.rail_head_radius)
        wheel, profile, head = (np.asarray(wl.scalar_si(radius, "m")) for radius in radii)
        load, roller = np.asarray(1.0), np.asarray(self._roller)
        curvatures = (
            wl.hertz_ellipse.curvature(wheel / np.cos(angle), roller / np.cos(angle)),
            wl.hertz_ellipse.curvature(profile, head),
        )
        a, b = wl.hertz_ellipse.semi_axes(load, *curvatures, modulus)
        spin = np.sin(angle) * (1.0 / wheel + 1.0 / roller)
        return _Patch(a, b, wl.hertz_ellipse.max_pressure(load, a, b), spin)

    @cached_property
    def _constants(self) -> _Constants:
        (wheel, wheel_ratio), (rail, rail_ratio) = self._elastic
        return _Constants(
            shear_modulus=wl.hertz.mean_shear_modulus(
                0.5 * wheel / (1.0 + wheel_ratio), 0.5 * rail / (1.0 + rail_ratio)
            ),
            poisson_ratio=wl.hertz.mean_poisson_ratio(wheel, wheel_ratio, rail, rail_ratio),
            density=wl.scalar_si(self.material.density, "kg/m^3"),
            rolling_speed=wl.scalar_si(self.rolling_speed, "m/s"),
        )

    @cached_property
    def _elastic(self) -> tuple[tuple[float, float], ...]:
        """E [Pa] and ν of the wheel and of the rail."""
        materials = (body.material for body in self._bodies.values())
        return tuple((wl.scalar_si(material.youngs_modulus, "Pa"), material.poisson_ratio) for material in materials)


def _check_angle(angle: Array | float, subject: str = "") -> None:
    """Raise an error for contact angles [rad] of a right angle or more."""
    upright = np.abs(angle) >= 0.5 * np.pi
    if upright.any():
        first = float(np.asarray(angle)[upright].flat[0])
        raise wl.UnitError(
            f"{subject}must lie between -90 and 90 deg, got {wl.Q(np.degrees(first), 'deg')!r}; give the angle of the"
            ' surface to the axle, such as "70 deg" on a flange'
        )


@wl.hookimpl
def wearlaw_models() -> list[type[wl.Rig]]:
    """Return the rig of this plugin."""
    return [WheelRail]


@wl.hookimpl
def wearlaw_resources() -> dict[str, dict[str, str]]:
    """Return the study of a wheel on a rail."""
    return {"case": {"wheel_on_rail": Path(__file__).with_name("wheel_on_rail.toml").read_text(encoding="utf-8")}}
