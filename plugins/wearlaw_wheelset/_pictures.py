"""Pictures of wheels on rails."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from wearlaw import Array

if TYPE_CHECKING:
    import xarray
    from matplotlib.figure import Figure

APART = 15.0
"""Distance by which wheel and rail are drawn apart [mm]."""

LINES = 40
"""Most lines between contact points."""


class Profiles(NamedTuple):
    """The right wheel and its rail in the middle of the track [m].

    Attributes
    ----------
    wheel_y, wheel_z : ndarray
        The wheel, with y in the track and z from the taping line.
    wheel_offset : float
        y of the profile's origin in the track.
    wheel_arc : ndarray
        Arc length of the wheel's profile.
    rail_y, rail_z, rail_arc : ndarray
        The rail in the track, and the arc length of its profile.
    """

    wheel_y: Array
    wheel_z: Array
    wheel_offset: float
    wheel_arc: Array
    rail_y: Array
    rail_z: Array
    rail_arc: Array

    def at(self, body: str, arc: float) -> tuple[float, float]:
        """Return y and z of a place on a profile by its arc length."""
        s, y, z = self.rail if body == "rail" else self.wheel
        return float(np.interp(arc, s, y)), float(np.interp(arc, s, z))

    @property
    def wheel(self) -> tuple[Array, Array, Array]:
        """Arc length, y and z of the wheel."""
        return self.wheel_arc, self.wheel_y, self.wheel_z

    @property
    def rail(self) -> tuple[Array, Array, Array]:
        """Arc length, y and z of the rail."""
        return self.rail_arc, self.rail_y, self.rail_z


def geometry_figure(geometry: xarray.Dataset, profiles: Profiles) -> Figure:
    """Return a figure of contact points on both profiles of the right side, Δr and contact angles."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.4, 7.0), layout="constrained")
    axes = figure.subplot_mosaic([["both", "both"], ["radius", "angle"]], height_ratios=(1.2, 1.0))
    _contact_points(axes["both"], geometry, profiles)
    swept = [name for name in ("lateral_displacement", "yaw") if name in geometry.dims]
    along = swept[0] if swept else None
    for name, panel in (("rolling_radius_difference", axes["radius"]), ("contact_angle", axes["angle"])):
        found = geometry[name]
        if name == "contact_angle":
            found = found.sel(side="right")
        panel.set(ylabel=f"{'contact angle, right' if name == 'contact_angle' else 'rolling radius, right minus left'}"
                         f" [{geometry[name].units}]")  # fmt: skip
        _curves(panel, found, along)
    return figure


def _curves(axes: Any, values: xarray.DataArray, along: str | None) -> None:
    """Draw values over the first swept axis, with a curve for each value of the other axes."""
    if along is None:
        axes.plot(np.arange(1, values.size + 1), values.values.ravel(), "o")
        return
    others = [name for name in values.dims if name != along]
    flat = values.stack(other=others) if others else values.expand_dims("other")
    per = values.sizes.get("patch", 1)
    for index in range(flat.sizes["other"]):
        curve = flat.isel(other=index)
        if curve.notnull().any():
            axes.plot(values[along], curve, ".", color=f"C{index // per}", ms=2.5)  # a line would hide jumps
    axes.set_xlabel(f"{values[along].long_name} [{values[along].units}]")
    axes.grid(alpha=0.3)


def _contact_points(axes: Any, geometry: xarray.Dataset, profiles: Profiles) -> None:
    """Draw the right wheel above its rail, apart, with lines between points that touch."""
    axes.plot(1e3 * profiles.wheel_y, 1e3 * profiles.wheel_z - APART, color="black")
    axes.plot(1e3 * profiles.rail_y, 1e3 * profiles.rail_z, color="black")
    right = geometry.sel(side="right")
    wheel_y, wheel_z, y, z = (right[name].values.ravel() for name in ("wheel_y", "wheel_z", "y", "z"))
    there = np.flatnonzero(np.isfinite(y))
    for index in there[:: max(1, there.size // LINES)]:
        ends = [wheel_y[index] + 1e3 * profiles.wheel_offset, y[index]], [wheel_z[index] - APART, z[index]]
        axes.plot(*ends, color="C0", lw=0.6)
    axes.text(1e3 * profiles.wheel_y[-1], 1e3 * profiles.wheel_z[-1] - APART, "wheel ", ha="right", va="top")
    axes.text(1e3 * profiles.rail_y.mean(), 8.0, "rail", ha="center")
    title = f"right wheel and rail, drawn {APART:.0f} mm apart; lines join points that touch"
    axes.set(xlabel="y, to the right [mm]", ylabel="z, down [mm]", aspect="equal", title=title)
    axes.invert_yaxis()
