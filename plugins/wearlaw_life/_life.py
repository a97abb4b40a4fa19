"""The life of a profile: what a run returns."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
import xarray

import wearlaw as wl
from wearlaw import Array
from wearlaw.units.variables import readable
from wearlaw_life._removal import normal_depth, positions
from wearlaw_output.plot import plot

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from wearlaw_wheelset import Profile

UNITS = {
    "distance": "km",
    "passages": "",
    "depth": "mm",
    "mass": "kg",
    "worn_area": "mm^2",
    "flange_height": "mm",
    "flange_thickness": "mm",
    "flange_gradient": "mm",
    "hollow": "mm",
    "equivalent_conicity": "",
    "factor": "",
}
"""Measures of a life, with their units in tables."""

SIDES = {1: ("",), 2: ("_left", "_right")}
"""Ends of the names of columns: of one profile for both sides, or of each side."""

MOST_CURVES = 6
"""Most profiles in a picture."""

SEEN = 10.0
"""Largest depth as drawn on the profile [mm]."""

PLACES = 601
"""Places along a profile in `Life.profiles`."""


@dataclass(frozen=True, eq=False)
class Life:
    """How profiles wear over a distance.

    Attributes
    ----------
    pipeline : Pipeline
        The pipeline with the worn profiles, for further predictions.
    body : str
        The body that wears.
    ended : str
        Why the life ended: "over", or the column of the measure that reached its limit; "" if it was interrupted.
    worn_profiles : tuple of tuple of Profile
        The profiles at the start and after each step: one for both sides, or those of the left and the right side.
    rows : tuple of dict
        Measures at the start and after each step, in SI; see `table`.
    """

    pipeline: wl.Pipeline[...]
    body: str
    ended: str
    worn_profiles: tuple[tuple[Profile, ...], ...]
    rows: tuple[dict[str, float], ...] = field(repr=False)

    @property
    def profile(self) -> Profile:
        """The worn profile; that of the right side if each has its own, as `worn_profiles[-1]` has both."""
        return self.worn_profiles[-1][-1]

    @property
    def sides(self) -> tuple[str, ...]:
        """The sides with profiles of their own: "left" and "right", or "mean"."""
        return tuple(side.removeprefix("_") or "mean" for side in SIDES[len(self.worn_profiles[0])])

    @property
    def along(self) -> str:
        """What the life is counted in: "distance", or "passages" of a rail."""
        return next(iter(self.rows[0]))

    @property
    def table(self) -> pd.DataFrame:
        """The measures at the start and after each step, with units in the heads.

        `depth` is the largest depth along the normal of the first profile. `mass` is what a wheel lost, or a metre of
        rail. `worn_area` is the area between the sections of the first profile and this one. `factor` is what the
        step's depths were multiplied by so that the removed mass is the predicted one. Where each side has its own
        profile, the names of their columns end with "_left" and "_right".
        """
        return pd.DataFrame({_head(name): self._column(name) for name in self.rows[0]})

    @property
    def profiles(self) -> xarray.Dataset:
        """Profiles over the distance: y, z and the depth along the normal of the first profile, at its places.

        The places are arc lengths of the first profile [mm]; y and z are those of the surface that the normal there
        meets now. NaN beyond the end of a profile that is shorter than the other side's.
        """
        firsts = self.worn_profiles[0]
        place = positions(firsts, PLACES)
        data = np.full((3, len(self.rows), len(firsts), PLACES), np.nan)
        for side, first in enumerate(firsts):
            there = (place >= first.curve.s[0]) & (place <= first.curve.s[-1])
            s = place[there]
            y, z, angle, _ = first.curve.at(s)
            depth = np.array([normal_depth(first, one[side], s) for one in self.worn_profiles])
            out = depth if first.kind == "rail" else -depth
            data[:, :, side, there] = [y - out * np.sin(angle), z + out * np.cos(angle), depth]
        names = {"y": "y, outwards", "z": "z, down", "depth": "depth worn"}
        return xarray.Dataset(
            {
                name: ((self.along, "side", "place"), 1e3 * values, {"units": "mm", "long_name": names[name]})
                for name, values in zip(names, data, strict=True)
            },
            {
                self.along: (self.along, self._column(self.along), {"units": UNITS[self.along]}),
                "side": list(self.sides),
                "place": ("place", 1e3 * place, {"units": "mm", "long_name": "position along the first profile"}),
                "body": self.body,
            },
        )

    def figure(self) -> wl.FigureData:
        """Return the data of `plot`."""
        along, unit = self._column(self.along), UNITS[self.along]
        chosen = np.unique(np.linspace(0, along.size - 1, min(along.size, MOST_CURVES)).round().astype(int))
        every = self.profiles
        deepest = float(every["depth"].max())
        times = 10.0 ** np.floor(np.log10(SEEN / deepest)) if deepest > 0.0 else 1.0  # so that wear is seen
        across, distance = wl.PlotAxis("y, outwards [mm]"), wl.PlotAxis(_label(self.along))
        panels = []
        for side in self.sides:
            of_side, shapes, depths = every.sel(side=side), [], []
            new, which = of_side.isel({self.along: 0}), "" if side == "mean" else f"{side} "
            for number, step in enumerate(chosen):
                one, label = of_side.isel({self.along: int(step)}), f"{along[step]:,.0f} {unit or 'passages'}"
                y, z = (new[name].values + times * (one[name] - new[name]).values for name in "yz")
                shapes.append(wl.Curve(label, y, z, colour=number))
                depths.append(wl.Curve(label, one["y"].values, one["depth"].values, colour=number))
            down, worn = (wl.PlotAxis(label, inverted=True) for label in ("z, down [mm]", "depth worn [mm]"))
            panels.append(wl.Panel(across, down, tuple(shapes), f"{which}{self.body}, wear × {times:g}"))
            panels.append(wl.Panel(across, worn, tuple(depths), f"{which}{self.body}, wear along the normal"))
        for names in (("flange_height", "flange_thickness", "flange_gradient"), ("equivalent_conicity",), ("mass",)):
            there = [one for one in self.rows[0] if _base(one) in names and np.isfinite(self._column(one)).any()]
            values = [self._column(name) for name in there]
            values = [one - one[0] for one in values] if len(names) > 1 else values
            curves = tuple(
                wl.Curve(_shown(name), along, value, colour=number)
                for number, (name, value) in enumerate(zip(there, values, strict=True))
            )
            if curves:
                label = _label(names[0]) if len(names) == 1 else "change of the flange [mm]"
                panels.append(wl.Panel(distance, wl.PlotAxis(label), curves))
        caption = (
            f"The {self.body} after {len(self.rows) - 1} steps. It follows from the given line and wear law alone."
        )
        return wl.FigureData("life", f"Life of a {self.body}", tuple(panels), caption)

    def plot(self) -> Figure:
        """Draw profiles over the distance, the wear along their normals, and the measures, as a matplotlib figure."""
        return plot(self.figure())

    def _column(self, name: str) -> Array:
        values, unit = np.array([row[name] for row in self.rows]), unit_of(name) or ""
        return np.asarray(wl.Q(values, {"mm": "m", "mm^2": "m^2", "km": "m"}.get(unit, unit)).m_as(unit))

    def __repr__(self) -> str:
        values = {name: self._column(name) for name in self.rows[0]}
        why = {"": ", interrupted", "over": ""}.get(self.ended, f", to the limit of {_shown(self.ended)}")
        run = f"{_number(values.pop(self.along)[-1])} {UNITS[self.along] or 'passages'}, {len(self.rows) - 1} steps"
        lines = [f"Life of a {self.body}: {run}{why}"]
        for name, value in values.items():
            if _base(name) != "factor" and np.isfinite(value[-1]):
                unit = readable(unit_of(name) or "")
                lines.append(f"  {_shown(name):<26}{_number(value[0])} to {_number(value[-1])} {unit}".rstrip())
        return "\n".join(lines)


def _base(name: str) -> str:
    """Return the measure of a column."""
    return name.removesuffix("_left").removesuffix("_right")


def unit_of(name: str) -> str | None:
    """Return the unit of a column in tables, None for an unknown one."""
    return UNITS.get(_base(name))


def _shown(name: str) -> str:
    return name.replace("_", " ").replace("gradient", "gradient qR")


def _head(name: str) -> str:
    unit = unit_of(name)
    return f"{name} [{unit}]" if unit else name


def _label(name: str) -> str:
    unit = unit_of(name)
    return name.replace("_", " ") + (f" [{readable(unit)}]" if unit else "")


def _number(value: Any) -> str:
    return f"{value:,.0f}" if abs(value) >= 1e4 else f"{value:.4g}"
