"""The geometry of contact: where rigid wheels touch their rails, as a table and as pictures."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

import wearlaw as wl
from wearlaw import Array
from wearlaw_models.rigs.wheelset.motion import curvature_along, placed
from wearlaw_models.rigs.wheelset.pictures import Profiles, geometry_figure
from wearlaw_models.rigs.wheelset.search import Position, Section, Touching

if TYPE_CHECKING:
    import xarray
    from matplotlib.figure import Figure

SIDES = ("left", "right")

VARIABLES = {
    "y": ("mm", "lateral place of contact in the track, positive to the right"),
    "z": ("mm", "height of contact, positive down from the top of the rails"),
    "x": ("mm", "place of contact along the track, positive forwards of the axle"),
    "contact_angle": ("deg", "contact angle, positive where the surface falls to the right"),
    "rolling_radius": ("mm", "rolling radius"),
    "wheel_y": ("mm", "place on the wheel's profile, y"),
    "wheel_z": ("mm", "place on the wheel's profile, z"),
    "wheel_position": ("mm", "place on the wheel's profile, arc length"),
    "rail_y": ("mm", "place on the rail's profile, y"),
    "rail_z": ("mm", "place on the rail's profile, z"),
    "rail_position": ("mm", "place on the rail's profile, arc length"),
    "wheel_curvature": ("1/m", "curvature of the wheel's profile, positive where convex"),
    "rail_curvature": ("1/m", "curvature of the rail's profile, positive where convex"),
    "rolling_curvature": ("1/m", "curvature of the wheel in the rolling direction"),
    "gap": ("mm", "vertical gap as the first patch touches"),
}
"""Units and names of the variables of a patch."""

OF_WHEELSET = {
    "roll": ("mrad", "roll, positive if it lowers the right wheel"),
    "vertical_displacement": (
        "mm",
        "vertical displacement, positive down, from where the taping line is on the rails' top",
    ),
    "rolling_radius_difference": ("mm", "rolling radius, right minus left"),
}
"""Units and names of the variables of a wheelset."""


def patches(section: Section, position: Position, touching: Touching) -> dict[str, Array]:
    """Return `VARIABLES` of contact patches in SI, (positions, sides, patches); NaN where there is none."""
    wide = position.widened()
    arc = np.where(np.isnan(touching.arc), [[pair.wheel_y.start] for pair in section.sides], touching.arc)
    place = placed(section, wide, arc)
    side = np.array([-1.0, 1.0])[:, None]
    across = place.y + wide.displacement
    wheel_y, wheel_z, _, wheel_curvature = section.at("wheel", arc, wide.side)
    rail_y, rail_z, _, rail_curvature = section.at("rail", place.rail_arc, wide.side)
    values = {
        "y": side * across,
        "z": place.z + touching.least[..., None] + touching.gap,
        "x": np.broadcast_to(place.x, arc.shape),
        "contact_angle": side * place.angle,
        "rolling_radius": place.radius,
        "wheel_y": wheel_y,
        "wheel_z": wheel_z,
        "wheel_position": arc,
        "rail_y": rail_y,
        "rail_z": rail_z,
        "rail_position": place.rail_arc,
        "wheel_curvature": wheel_curvature,
        "rail_curvature": rail_curvature,
        "rolling_curvature": curvature_along(section, wide, place.radius, arc),
        "gap": touching.gap,
    }
    none = np.where(np.isnan(touching.arc), np.nan, 0.0)
    return {name: array + none for name, array in values.items()}


@dataclass(frozen=True)
class Geometry:
    """Where rigid wheels touch their rails.

    Attributes
    ----------
    dataset : xarray.Dataset
        Places, angles, radii and curvatures of each patch, with units in attrs; NaN where there is no such patch. The
        axes are the lateral displacement and the yaw where they are arrays, in the unit given, then "side" and "patch".
    """

    dataset: xarray.Dataset
    _profiles: Profiles

    def __repr__(self) -> str:
        axes = ", ".join(f"{name} {size}" for name, size in self.dataset.sizes.items())
        return f"Geometry of {axes}"

    def plot(self) -> Figure:
        """Return a figure of the contact points on both profiles, the rolling radius difference and the contact angle.

        The lines join points of the right wheel and its rail that touch each other. The curves run over the lateral
        displacement, with a curve for each yaw.
        """
        return geometry_figure(self.dataset, self._profiles)


def geometry(
    section: Section, axes: dict[str, wl.Quantity], roll: Array, touching: Touching, position: Position, within: float,
    nominal_radius: float,
) -> Geometry:  # fmt: skip
    """Return the geometry at all combinations of the axes, quantities by name with the last one running fastest."""
    import xarray

    patch_values = patches(section, position, touching)
    values_of = {name: np.asarray(axis.magnitude, dtype=np.float64) for name, axis in axes.items()}
    shape = tuple(array.size for array in values_of.values() if array.ndim)
    named = [name for name, array in values_of.items() if array.ndim]
    far = ~(touching.gap <= within)
    data: dict[str, Any] = {}
    for name, (unit, words) in VARIABLES.items():
        values = np.where(far, np.nan, patch_values[name])
        dims = [*named, "side", "patch"]
        data[name] = (
            dims,
            wl.Q(values, _si(unit)).to(unit).magnitude.reshape(*shape, *values.shape[1:]),
            _attrs(unit, words),
        )
    first = patch_values["rolling_radius"][..., 0]
    wheelset = {
        "roll": roll,
        "vertical_displacement": touching.least.mean(axis=-1) + nominal_radius,
        "rolling_radius_difference": first[:, 1] - first[:, 0],
    }
    for name, (unit, words) in OF_WHEELSET.items():
        data[name] = named, wl.Q(wheelset[name], _si(unit)).to(unit).magnitude.reshape(shape), _attrs(unit, words)
    coordinates: dict[str, Any] = {
        name: ([name] if array.ndim else [], array, _attrs(f"{axes[name].units:~C}", name.replace("_", " ")))
        for name, array in values_of.items()
    }
    coordinates |= {"side": list(SIDES), "patch": np.arange(1, touching.arc.shape[-1] + 1)}
    return Geometry(xarray.Dataset(data, coordinates), profiles(section, nominal_radius))


def profiles(section: Section, nominal_radius: float) -> Profiles:
    """Return the profiles of the right wheel and its rail in the middle of the track."""
    table = section.wheel_y
    wheel_arc: Array = table.start + table.step * np.arange(table.value.size, dtype=np.float64)
    offset = table.value[0] - float(section.wheel.at(table.start)[0])
    radius = section.wheel_radius.value - nominal_radius
    rail_y: Array = section.rail_z.start + section.rail_z.step * np.arange(section.rail_z.value.size, dtype=np.float64)
    return Profiles(table.value, radius, offset, wheel_arc, rail_y, section.rail_z.value, section.rail_position.value)


def _si(unit: str) -> str:
    return {"mm": "m", "deg": "rad", "mrad": "rad"}.get(unit, unit)


def _attrs(unit: str, words: str) -> dict[str, str]:
    return {"units": unit, "long_name": words}
