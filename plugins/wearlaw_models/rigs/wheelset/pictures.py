"""Pictures of wheels on rails."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

import wearlaw as wl
from wearlaw import Array
from wearlaw_models.rigs.wheelset.curve import Curve
from wearlaw_models.rigs.wheelset.measures import depth_between

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes
    from matplotlib.cm import ScalarMappable
    from matplotlib.figure import Figure

APART = 15.0
"""Distance by which wheel and rail are drawn apart [mm]."""

SHOWN = (-20.0, 16.0)
"""Heights that a figure of both wheels shows [mm]."""

STEP = 0.25
"""Distance between positions of wear along a profile [mm]."""

BELOW = 8.0
"""Depth of the rail that is drawn below the lowest point of contact [mm]."""

LINES = 60
"""Most positions whose contact points are joined by lines."""

STYLE = "wearlaw_apps.output.wearlaw"
"""The style of all pictures, by matplotlib's name."""

WAYS = ("lateral_displacement", "yaw")
"""Axes of a geometry besides the side and the patch."""


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


def _matplotlib() -> Any:
    import matplotlib.figure
    import matplotlib.style

    return matplotlib


def draw_profile(
    ax: Axes | None, curve: Curve, name: str, measures: Mapping[str, wl.Quantity],
    points: tuple[wl.Quantity, wl.Quantity] | None, new: Curve | None,
) -> Axes:  # fmt: skip
    """Draw a profile with its measures and points; see `Profile.plot`."""
    mpl = _matplotlib()
    with mpl.style.context(STYLE if ax is None else {}):
        several: list[Axes] = [] if ax is None else [ax]
        if not several:
            figure: Figure = mpl.figure.Figure(figsize=(7.4, 3.6 if new is None else 5.4))
            several += list(figure.subplots(1 if new is None else 2, squeeze=False)[:, 0])
        axes, *below = several
        axes.plot(1e3 * curve.y, 1e3 * curve.z, color="C0", label=name)
        if new is not None:
            axes.plot(1e3 * new.y, 1e3 * new.z, color="0.4", linestyle="--", label="new")
            axes.legend()
        if new is not None and below:
            there = (new.y >= curve.y.min()) & (new.y <= curve.y.max())
            below[0].plot(1e3 * new.y[there], 1e3 * depth_between(new, curve, new.s[there]), color="C0")
            below[0].set(xlabel="y of the new profile [mm], outwards", ylabel="depth along the normal [mm]")
        lines = (f"{measure.replace('_', ' ')} {value.m_as('mm'):.2f} mm" for measure, value in measures.items())
        place = (0.85, 0.3) if curve.sign < 0.0 else (0.5, 0.5)
        axes.text(*place, "\n".join(lines), transform=axes.transAxes, ha="center", va="center", fontsize="small")
        if points is not None:
            axes.plot(*(value.magnitude for value in points), ".", color="C1", markersize=2.0, zorder=3, label="points")
        axes.set(xlabel="y [mm], outwards", ylabel="z [mm], down", title=name, aspect="equal")
        if not axes.yaxis_inverted():
            axes.invert_yaxis()
        return axes


def geometry_figure(geometry: xarray.Dataset, profiles: Profiles) -> Figure:
    """Return a figure of contact points on both profiles of the right side, Δr and contact angles."""
    mpl = _matplotlib()
    with mpl.style.context(STYLE):
        figure: Figure = mpl.figure.Figure(figsize=(7.4, 6.2))
        axes = figure.subplot_mosaic([["both", "both"], ["radius", "angle"]], height_ratios=(3.0, 4.0))
        colours = mpl.cm.ScalarMappable(cmap="viridis")
        _contact_points(axes["both"], geometry, profiles, colours)
        radius, angle = geometry.rolling_radius_difference, geometry.contact_angle.sel(side="right")
        _curves(axes["radius"], radius.expand_dims("patch", -1))
        _curves(axes["angle"], angle)
        axes["radius"].set_ylabel(f"rolling radius, right minus left [{radius.units}]")
        axes["angle"].set_ylabel(f"contact angle of the right wheel [{angle.units}]")
        if {*WAYS} <= {*geometry.dims}:
            axes["radius"].legend(title=_label(geometry["yaw"]), markerscale=3.0)
    return figure


def _label(coordinate: xarray.DataArray) -> str:
    return f"{coordinate.long_name} [{coordinate.units}]"


def _curves(axes: Any, values: xarray.DataArray) -> None:
    """Draw values over the first swept axis, in a colour for each value of the other one; later patches are pale."""
    swept = [name for name in WAYS if name in values.dims]
    if not swept:
        axes.plot(np.arange(1, values.size + 1), values.values.ravel(), "o")
        axes.set(xlabel="patch", xticks=[1, 2, 3])
        return
    along = values[swept[0]]
    curves = values.transpose(*swept, "patch").values.reshape(along.size, -1, values.sizes["patch"])
    for number in range(curves.shape[1]):
        label = f"{float(values[swept[1]][number]):.4g}" if len(swept) > 1 else None
        for patch in range(curves.shape[2]):  # points, because a line would hide jumps
            look: Any = {"alpha": 0.3} if patch else {"label": label}
            axes.plot(along, curves[:, number, patch], ".", ms=3.0, mew=0.0, color=f"C{number}", **look)
    axes.set_xlabel(_label(along))


def _contact_points(axes: Any, geometry: xarray.Dataset, profiles: Profiles, shades: ScalarMappable) -> None:
    """Draw the right wheel above its rail, apart, with lines between points that touch."""
    wheel_z = 1e3 * profiles.wheel_z - APART
    axes.plot(1e3 * profiles.wheel_y, wheel_z, color="black")
    axes.plot(1e3 * profiles.rail_y, 1e3 * profiles.rail_z, color="black")
    along = next((name for name in WAYS if name in geometry.dims), None)
    right = geometry.sel(side="right").expand_dims(() if along else "row")
    rows = right.isel({along or "row": slice(None, None, -(-right.sizes[along or "row"] // LINES))})
    if along is not None:
        shades.set_clim(float(right[along].min()), float(right[along].max()))
        bar = axes.figure.colorbar(shades, ax=axes, pad=0.01, shrink=0.9)
        bar.set_label(_label(right[along]))
    for number in range(rows.sizes[along or "row"]):
        row = rows.isel({along or "row": number})
        colour = tuple(shades.to_rgba(row[along].values)) if along else "C0"
        ends = np.stack([row.wheel_y + 1e3 * profiles.wheel_offset, row.y]), np.stack([row.wheel_z - APART, row.z])
        axes.plot(*(end.reshape(2, -1) for end in ends), color=colour, lw=0.8)
    axes.text(1e3 * profiles.wheel_y[-1], wheel_z[-1] - 1.0, "wheel", ha="right", va="bottom")
    axes.text(1e3 * profiles.rail_y.mean(), 5.0, "rail", ha="center", va="top")
    axes.set(xlabel="y, to the right [mm]", ylabel="z, down [mm]", aspect="equal")
    axes.set_ylim(float(right.z.max()) + BELOW, wheel_z.min() - 5.0)
    axes.set_title(f"right wheel and rail, drawn {APART:.0f} mm apart; lines join points that touch")


def contact_figure(profiles: Profiles, name: str, prediction: wl.Prediction) -> wl.FigureData:
    """Return both wheels above their rails, with lines between places that touch."""
    panels = []
    for index, side in enumerate(("left", "right")):
        sign = (-1.0, 1.0)[index]
        here = prediction.sel(side=side)
        wheel, rail = (np.asarray(here.problem.body(body).profile_position) for body in ("wheel", "rail"))
        ends = []
        for on_wheel, on_rail in zip(np.ravel(wheel), np.ravel(rail), strict=True):
            if np.isfinite(on_wheel):
                ends.append((*profiles.at("wheel", on_wheel), *profiles.at("rail", on_rail)))
        lines = (
            np.array([[a, c, np.nan] for a, _, c, _ in ends]).ravel(),
            np.array([[b - 1e-3 * APART, d, np.nan] for _, b, _, d in ends]).ravel(),
        )
        panels.append(
            wl.Panel(
                wl.PlotAxis("y, to the right [mm]"),
                wl.PlotAxis("z, down [mm]", ends=SHOWN, inverted=True),
                (
                    wl.Curve("wheel", sign * 1e3 * profiles.wheel_y, 1e3 * profiles.wheel_z - APART, colour=6),
                    wl.Curve("rail", sign * 1e3 * profiles.rail_y, 1e3 * profiles.rail_z, colour=6, dash=1),
                    wl.Curve("lines between places that touch", sign * 1e3 * lines[0], 1e3 * lines[1], dash=2),
                ),
                f"{side} wheel",
                equal=True,
            )
        )
    return wl.FigureData(
        name=f"contact_{name}",
        title=f"Contact points: {name}",
        panels=tuple(panels),
        caption=f"Wheel and rail are drawn {APART:g} mm apart in the middle of the track; lines join the middles of the"
        " patches.",
    )


def wear_figure(profiles: Profiles, name: str, predictions: Mapping[str, wl.Prediction]) -> wl.FigureData:
    """Return the depth that both wheels and rails lose along their profiles."""
    panels = []
    for body in ("wheel", "rail"):
        for side in ("left", "right"):
            curves, unit = [], ""
            for number, (label, prediction) in enumerate(predictions.items()):
                at = _positions(profiles, body)
                worn = prediction.sel(side=side).wear_profile(body, at=wl.Q(at, "mm"))["depth"]
                unit = worn.attrs["units"]
                curves.append(wl.Curve(label, at, np.ravel(worn.values), colour=number, dash=number))
            per = "" if body == "wheel" else " per passage"
            panels.append(
                wl.Panel(
                    wl.PlotAxis(f"position along the profile of the {body} [mm]"),
                    wl.PlotAxis(f"depth{per} [{unit}]".replace("um", "µm")),
                    tuple(curves),
                    f"{side} {body}",
                )
            )
    return wl.FigureData(
        name=f"wear_{name}", title=f"Wear along the profiles: {name}", panels=tuple(panels),
        caption="The flange of a wheel and the gauge side of a rail are at negative positions.",
    )  # fmt: skip


def _positions(profiles: Profiles, body: str) -> Array:
    """Return positions along the part of a profile on which contact is looked for [mm]."""
    arc = profiles.wheel_arc if body == "wheel" else profiles.rail_arc
    return np.arange(1e3 * arc[0], 1e3 * arc[-1], STEP)
