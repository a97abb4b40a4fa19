"""Contacts at places of a wheel's profile that a program for vehicle dynamics has computed, as a rig."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Required, TypedDict, Unpack

import numpy as np
from pydantic import Field

import wearlaw as wl
from wearlaw import Array
from wearlaw_models.rigs.wheelset.curve import Curve
from wearlaw_models.rigs.wheelset.problem import LOAD
from wearlaw_models.rigs.wheelset.profile import Profile
from wearlaw_models.rigs.wheelset.rig import Cant, Place

NARROWEST, WIDEST = 1e-4, 15e-3
"""Half-widths between which that of a patch is sought [m]."""

HALVINGS = 40
"""Halvings of the search: 15 mm are then 1e-14 m."""


class ContactConditions(TypedDict, total=False):
    """The conditions of a contact; arrays broadcast. Signs are those of a right wheel, with y outwards."""

    contact_position: Required[Annotated[wl.QuantityLike, wl.Unit("mm", positive=False)]]
    """Place of the contact along y of the wheel's profile [m]."""
    normal_force: Required[Annotated[wl.QuantityLike, LOAD]]
    """Normal force, N [N]; zero where there is no contact."""
    longitudinal_creepage: Required[wl.Creepage]
    """Longitudinal creepage, ξ [-]; positive if the wheel is braked."""
    lateral_creepage: wl.Creepage
    """Lateral creepage, η [-]; zero if not given."""
    spin: Annotated[wl.QuantityLike, wl.Unit("1/m", positive=False, usual=(-100.0, 100.0))]
    """Spin, φ [1/m]; that of the contact angle, sin δ / r, if not given."""
    semi_axis_a: Annotated[wl.QuantityLike, wl.Unit("mm")]
    """Semi-axis of the patch in the rolling direction, a [m]; with `semi_axis_b`. By default Hertz's."""
    semi_axis_b: Annotated[wl.QuantityLike, wl.Unit("mm")]
    """Semi-axis of the patch across the rolling direction, b [m]."""
    friction_coefficient: Required[wl.Friction]
    """Friction coefficient, μ [-]."""
    rolling_speed: Annotated[wl.QuantityLike, wl.Unit("m/s", usual=(1e-4, 200.0))]
    """Speed along the track, V [m/s]; that of the rig if not given."""


class ProfileContact(wl.Rig):
    """A contact of a wheel with a rail at a place of the wheel's profile that you give.

    Place, creepages and normal force come from a program for vehicle dynamics, and `wear_out` accumulates their wear on
    the profile. The patch is an ellipse: that of Hertz, with the curvatures of both profiles where their tangents are
    parallel, as means over the width of the patch; or the one of the program, by its semi-axes. At 200 random positions
    of S1002 on 60E1, under 30 to 110 kN, a was within 11 % of that of the half-spaces of `Wheelset`, and b from 30 %
    below to 20 % above.

    Prefer `Wheelset` where you have displacements, yaw and loads: it finds the contacts on worn profiles too.
    """

    name: ClassVar[str] = "profile_contact"
    source: ClassVar[str] = "Hertz's theory: K. L. Johnson, Contact Mechanics, Cambridge 1985, section 4.2(b)"
    patch_geometry: ClassVar[wl.Geometry | None] = "ellipse"
    creepage: ClassVar = "longitudinal_creepage"
    example: ClassVar[Mapping[str, Any]] = {
        "contact_position": "0 mm",
        "normal_force": "60 kN",
        "longitudinal_creepage": "0.1 %",
        "lateral_creepage": "0.1 %",
        "friction_coefficient": 0.3,
    }
    example_fields: ClassVar[Mapping[str, Any]] = {
        "wheel": "s1002",
        "rail": "uic60",
        "nominal_radius": "460 mm",
        "rail_cant": "1:40",
        "material": "steel",
        "rolling_speed": "20 m/s",
    }

    wheel: Profile
    """Profile of the wheel; a file may give the name of a formula, such as "s1002", or the path of a profile."""
    rail: Profile
    """Profile of the rail, without cant; a file may give "uic60" or a path."""
    nominal_radius: Annotated[wl.Quantity, wl.Unit("mm", usual=(10.0, 700.0))]
    """Radius of the wheel at the origin of its profile, the taping line [m]."""
    flange_back_position: Place = Field(default="-70 mm", validate_default=True)
    """Place of the inner face in the wheel's profile, y [m]."""
    rail_cant: Cant = Field(default="0 rad", validate_default=True)
    """Angle by which the rail leans inwards, such as "1:40" [rad]."""
    material: wl.MaterialField
    """Material of wheel and rail; a file may also give the name of an installed material."""
    rolling_speed: wl.Speed
    """Speed along the track, V [m/s]; the condition replaces it."""

    if TYPE_CHECKING:

        def __init__(
            self,
            *,
            wheel: Profile,
            rail: Profile,
            nominal_radius: wl.QuantityLike,
            flange_back_position: wl.QuantityLike = "-70 mm",
            rail_cant: wl.QuantityLike = "0 rad",
            material: wl.Material,
            rolling_speed: wl.QuantityLike,
        ) -> None: ...

    @property
    def bodies(self) -> Mapping[str, wl.Body]:
        """The "wheel" and the "rail"; problems have the rolling radii of their places."""
        radius = wl.scalar_si(self.nominal_radius, "m")
        return {"wheel": wl.Body(self.material, radius), "rail": wl.Body(self.material, np.inf)}

    @np.errstate(all="ignore")  # `checked` rejects what overflows
    def problem(self, **conditions: Unpack[ContactConditions]) -> wl.Problem:
        """Return the contact problem that the conditions pose; arrays broadcast against each other.

        Raises
        ------
        ConditionsError
            If conditions are missing or contradictory, a place is beyond the profile, or the profiles do not touch in
            an ellipse there.
        UnitError
            If a condition lacks its unit or is out of bounds.
        """
        arrays = self.in_si(
            conditions,
            lambda a: a["rolling_speed"] * np.hypot(a["longitudinal_creepage"], a["lateral_creepage"]),
            lateral_creepage=0.0,
            rolling_speed=wl.scalar_si(self.rolling_speed, "m/s"),
        )
        place, force, curve = arrays.pop("contact_position"), arrays["normal_force"], self.wheel.curve
        beyond = ~((place >= curve.y[0]) & (place <= curve.y[-1]))
        if beyond.any():
            raise wl.ConditionsError(
                f"contact_position: {1e3 * place[beyond][0]:.4g} mm is beyond the wheel's profile, which reaches from"
                f" {1e3 * curve.y[0]:.4g} to {1e3 * curve.y[-1]:.4g} mm"
            )
        arc = np.interp(place, curve.y, curve.s)
        y, _, angle, _ = curve.at(arc)
        arc = np.clip(arc + (place - y) * np.cos(angle), curve.s[0], curve.s[-1])  # interpolation is off by 1e-9 m
        _, z, angle, _ = curve.at(arc)
        radius = wl.scalar_si(self.nominal_radius, "m") + z
        axes = [arrays.pop(f"semi_axis_{axis}", None) for axis in ("a", "b")]
        if axes[0] is None or axes[1] is None:
            if axes != [None, None]:
                raise wl.ConditionsError("give both semi_axis_a and semi_axis_b, or none of them")
            axes = self._semi_axes(place, arc, angle, radius, force)
        arrays.setdefault("spin", np.sin(angle) / radius)
        young, ratio = wl.scalar_si(self.material.youngs_modulus, "Pa"), self.material.poisson_ratio
        same = {"shear_modulus": 0.5 * young / (1.0 + ratio), "poisson_ratio": ratio}
        same["density"] = wl.scalar_si(self.material.density, "kg/m^3")
        fields: dict[str, Any] = {name: np.broadcast_to(value, place.shape) for name, value in same.items()}
        if not (loaded := force > 0.0).all():
            fields |= {"exists": loaded, "unloaded": ~loaded}
        bodies = {
            "wheel": wl.Body(self.material, radius, profile_position=arc),
            "rail": wl.Body(self.material, np.inf),
        }
        a, b = axes
        return wl.Problem.ellipse_from_si(a=a, b=b, bodies=bodies, contact_angle=angle, **arrays, **fields).checked()

    def _semi_axes(self, place: Array, arc: Array, angle: Array, radius: Array, force: Array) -> list[Any]:
        """Return semi-axes [m] at arc lengths of the wheel, with the rail where its tangent has their angle.

        Hertz's b with the mean of the curvatures over b to both sides is b.
        """
        rail = self.rail.curve
        lean = angle + wl.scalar_si(self.rail_cant, "rad")
        on_rail = np.interp(lean, np.maximum.accumulate(rail.angle), rail.s)
        young, ratio = wl.scalar_si(self.material.youngs_modulus, "Pa"), self.material.poisson_ratio
        modulus = wl.hertz.effective_modulus(young, ratio, young, ratio)
        along = wl.hertz_ellipse.curvature(radius / np.cos(angle), np.asarray(np.inf))

        def wider(width: Array) -> tuple[Any, Array, Array]:
            """Return where b is more than a half-width, and a and b with the mean curvature within it."""
            curvature = 0.5 * (_mean_curvature(self.wheel.curve, arc, width) + _mean_curvature(rail, on_rail, width))
            hollow = ~(curvature > 0.0)
            a, b = wl.hertz_ellipse.semi_axes(force, along, np.where(hollow, along, curvature), modulus)
            return hollow | (b > width), a, b

        low, high = np.full(force.shape, NARROWEST), np.full(force.shape, WIDEST)
        if (conform := wider(high)[0]).any():
            raise wl.ConditionsError(
                f"contact_position: at {1e3 * place[conform][0]:.4g} mm the wheel is as hollow as the rail is round, so"
                " that they do not touch in an ellipse of Hertz; give semi_axis_a and semi_axis_b"
            )
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            more, _, _ = wider(middle)
            low, high = np.where(more, middle, low), np.where(more, high, middle)
        return list(wider(high)[1:])


def _mean_curvature(curve: Curve, arc: Array, width: Array) -> Array:
    """Return mean curvatures of a profile within half-widths of arc lengths [1/m], positive where it is convex."""
    ends = [np.clip(arc + side * width, curve.s[0], curve.s[-1]) for side in (-1.0, 1.0)]
    first, last = (curve.at(end)[2] for end in ends)
    return np.asarray(curve.sign * (last - first) / (ends[1] - ends[0]))
