"""A wheelset on two rails as a rig: its conditions, and the contact problem that they pose."""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal

import numpy as np
from pydantic import BeforeValidator, Field, model_validator

import wearlaw as wl
from wearlaw import Array
from wearlaw_wheelset._geometry import Geometry
from wearlaw_wheelset._loads import Balance, Elastic, Task
from wearlaw_wheelset._profile import Profile
from wearlaw_wheelset._search import PATCHES, Section, both_sides, searched, section

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

DIMS: Mapping[str, tuple[str | int, ...]] = {"side": ("left", "right"), "patch": (1, 2, 3)}
"""The axes of patches."""

UNITS = {
    "lateral_displacement": wl.Unit("mm", positive=False),
    "yaw": wl.Unit("mrad", positive=False),
    "roll": wl.Unit("mrad", positive=False),
    "vertical_load": wl.Unit("kN"),
    "axle_torque": wl.Unit("N*m", positive=False),
    "angular_speed": wl.Unit("rad/s"),
    "lateral_velocity": wl.Unit("m/s", positive=False),
    "yaw_velocity": wl.Unit("rad/s", positive=False),
    "curve_radius": wl.Unit("m", positive=False, infinite=True),
    "rolled_distance": wl.Unit("km", positive=False),
}
"""Units of the conditions."""

MOST_YAW = 0.2
"""Greatest yaw [rad]: a locomotive in the tightest curve has a tenth of it."""

RATIO = re.compile(r"\s*1\s*:\s*([0-9.]+)\s*")


def _cant(value: object) -> object:
    """Return the angle of a cant such as "1:40"; other values stay."""
    if isinstance(value, str) and (found := RATIO.fullmatch(value)):
        return wl.Q(float(np.arctan(1.0 / float(found[1]))), "rad")
    if isinstance(value, int | float) and not isinstance(value, bool) and value == 0:
        return wl.Q(0.0, "rad")
    return value


Cant = Annotated[wl.Quantity, wl.Unit("rad", positive=False, limit=0.2), BeforeValidator(_cant)]
Place = Annotated[wl.Quantity, wl.Unit("mm", positive=False)]
Angle = Annotated[wl.Quantity, wl.Unit("deg")]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Posed(wl.Problem):
    """A problem that knows the balance that it comes from."""

    balance: Balance
    shape: tuple[int, ...]


class Wheelset(wl.Rig):
    """Two wheels on an axle that roll on two rails, with the profiles of wheels and rails.

    Each wheel touches its rail in one to three patches. The roll is found so that both wheels touch. The vertical load
    of each wheel is carried by the normal forces and the lateral creep forces of its patches, which share it by their
    penetration. The wheelset turns at the speed at which the creep forces balance the torque on the axle.

    The motion is steady or given: masses, suspensions and bending of the axle are not part of the rig. A program for
    vehicle dynamics gives lateral displacement, yaw and loads. Both wheels have the same profile, and so do both rails.

    Axes are those of the track: x forwards, y to the right, z down. Results have the axes "side" and "patch", in which
    patch 1 is the one that touches first.

    Materials may differ. The rig then takes E* and Kalker's means of G and ν.
    """

    name: ClassVar[str] = "wheelset"
    source: ClassVar[str] = (
        "locus of contact: A. D. de Pater, Vehicle System Dynamics 17 (1988) 127-140; strips: J. Piotrowski and W. Kik,"
        " Vehicle System Dynamics 46 (2008) 27-48"
    )
    creepage: ClassVar[str] = "lateral_displacement"
    example: ClassVar[Mapping[str, Any]] = {
        "lateral_displacement": "3 mm",
        "yaw": "7.2 mrad",
        "vertical_load": "50 kN",
        "friction_coefficient": 0.3,
    }
    example_fields: ClassVar[Mapping[str, Any]] = {
        "wheel": "s1002",
        "rail": "uic60",
        "nominal_radius": "460 mm",
        "flange_back_distance": "1360 mm",
        "gauge": "1435 mm",
        "rail_cant": "1:40",
        "material": "steel",
        "rolling_speed": "20 m/s",
    }

    wheel: Profile
    """Profile of the wheels; a file may give the name of a formula, such as "s1002", or the path of a profile."""
    rail: Profile
    """Profile of the rails, without cant; a file may give "uic60" or a path."""
    nominal_radius: wl.Length
    """Radius of the wheels at the origin of their profile [m]."""
    flange_back_distance: wl.Length
    """Distance between the inner faces of the wheels [m]."""
    flange_back_position: Place = Field(default="-70 mm", validate_default=True)
    """y of the inner face in the wheel's profile [m]."""
    gauge: wl.Length
    """Track gauge, the distance between the rails [m]."""
    gauge_depth: wl.Length = Field(default="14 mm", validate_default=True)
    """Depth below the rail's highest point at which the gauge is measured [m]."""
    rail_cant: Cant = Field(default="0 rad", validate_default=True)
    """Angle by which the rails lean inwards, such as "1:40" [rad]."""
    flange_angle: Angle = Field(default="30 deg", validate_default=True)
    """Contact angle beyond which a patch is one of the flange and takes `flange_friction_coefficient` [rad]."""
    pressure: Literal["kpec", "hertz"] = "kpec"
    """Normal problem. "kpec": strips under the pressure of Kik and Piotrowski with elliptic correction. "hertz": ellipses
    with the curvatures where the bodies first touch, for profiles whose curvature hardly varies over the patch."""
    strips: Annotated[int, Field(ge=5, le=500, strict=True)] = 20
    """Number of strips of a patch with `pressure = "kpec"`."""
    material: wl.MaterialField
    """Material of wheels and rails; a file may also give the name of an installed material."""
    rail_material: wl.MaterialField | None = None
    """Material of the rails, if it differs from the wheels'."""
    rolling_speed: wl.Speed
    """Speed of the wheelset along the track, V [m/s]."""

    if TYPE_CHECKING:

        def __init__(
            self,
            *,
            wheel: Profile,
            rail: Profile,
            nominal_radius: wl.QuantityLike,
            flange_back_distance: wl.QuantityLike,
            flange_back_position: wl.QuantityLike = "-70 mm",
            gauge: wl.QuantityLike,
            gauge_depth: wl.QuantityLike = "14 mm",
            rail_cant: wl.QuantityLike = "0 rad",
            flange_angle: wl.QuantityLike = "30 deg",
            pressure: Literal["kpec", "hertz"] = "kpec",
            strips: int = 20,
            material: wl.Material,
            rail_material: wl.Material | None = None,
            rolling_speed: wl.QuantityLike,
        ) -> None: ...

    @property
    def geometry_of_patches(self) -> wl.Geometry:
        return "ellipse" if self.pressure == "hertz" else "strips"
