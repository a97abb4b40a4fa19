"""The life of a profile: what a run returns."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
import xarray

import wearlaw as wl
from wearlaw.units.variables import readable
from wearlaw_life._removal import positions
from wearlaw_output.plot import plot

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from wearlaw_wheelset import Profile

SIDES = {1: ("",), 2: ("_left", "_right")}
"""Ends of the names of columns: of one profile for both sides, or of each side."""

MOST_CURVES = 6
"""Most profiles in a picture."""

SEEN = 10.0
"""Largest depth as drawn on the profile [mm]."""

PLACES = 601
"""Places along a profile in `Life.profiles`."""

CURVES = {"flange": "change of the flange [mm]", "equivalent_conicity": "equivalent conicity", "mass": "mass [kg]"}
"""Beginnings of the columns that are drawn over the distance, with the labels of their axes."""


def name_and_unit(column: str) -> tuple[str, str]:
    """Return the name and the unit in the head of a column."""
    name, _, unit = column.partition(" [")
    return name, unit.removesuffix("]")


@dataclass(frozen=True, eq=False, repr=False)
class Life:
    """How profiles wear over a distance.

    Attributes
    ----------
    pipeline : Pipeline
        The pipeline with the worn profiles, for further predictions.
    body : str
        The body that wears.
    ended : str
        Why the life ended: "over", or the name of the measure that reached its limit, as in the table; "" if it was
        interrupted.
    worn_profiles : tuple of tuple of Profile
        The profiles at the start and after each step: one for both sides, or those of the left and the right side.
    table : pandas.DataFrame
        The measures at the start and after each step, with units in the heads. `depth` is the largest depth along the
        normal of the first profile. `mass` is what a wheel lost, or a metre of rail. `worn_area` is the area between
        the sections of the first profile and this one. `factor` is what the step's depths were multiplied by so that
        the removed mass is the predicted one. Where each side has its own profile, the names of their columns end with
        "_left" and "_right".
    """

    pipeline: wl.Pipeline[...]
    body: str
    ended: str
    worn_profiles: tuple[tuple[Profile, ...], ...]
    table: pd.DataFrame

    @property
    def profile(self) -> Profile:
        """The worn profile; that of the right side if each has its own, as `worn_profiles[-1]` has both."""
        return self.worn_profiles[-1][-1]

    @property
    def sides(self) -> tuple[str, ...]:
        """The sides with profiles of their own: "left" and "right", or "mean"."""
        return tuple(side.removeprefix("_") or "mean" for side in SIDES[len(self.worn_profiles[0])])

    @property
    def profiles(self) -> xarray.Dataset:
        """Profiles over the distance: y, z and the depth along the normal of the first profile, at its places.

        The places are arc lengths of the first profile [mm]; y and z are those of the surface that the normal there
        meets now. NaN beyond the end of a profile that is shorter than the other side's.
        """
        firsts = self.worn_profiles[0]
        place = positions(firsts, PLACES)
        data = np.full((3, len(self.worn_profiles), len(firsts), PLACES), np.nan)
        for side, first in enumerate(firsts):
            there = (place >= first.curve.s[0]) & (place <= first.curve.s[-1])
            y, z, angle, _ = first.curve.at(place[there])
            s = wl.Q(1e3 * place[there], "mm")
            depth = np.array([first.depth_to(profiles[side], s).magnitude for profiles in self.worn_profiles])
            inwards = depth if first.kind == "rail" else -depth
            data[:, :, side, there] = [1e3 * y - inwards * np.sin(angle), 1e3 * z + inwards * np.cos(angle), depth]
        along, unit = name_and_unit(self.table.columns[0])
        names = {"y": "y, outwards", "z": "z, down", "depth": "depth worn"}
        return xarray.Dataset(
            {
                name: ((along, "side", "place"), values, {"units": "mm", "long_name": names[name]})
                for name, values in zip(names, data, strict=True)
            },
            {
                along: (along, self.table.iloc[:, 0].to_numpy(), {"units": unit}),
                "side": list(self.sides),
                "place": ("place", 1e3 * place, {"units": "mm", "long_name": "position along the first profile"}),
                "body": self.body,
            },
        )

    def figure(self) -> wl.FigureData:
        """Return the data of `plot`."""
        along, unit = name_and_unit(self.table.columns[0])
        distances = self.table.iloc[:, 0].to_numpy()
        last = len(distances) - 1
        chosen = np.unique(np.linspace(0, last, min(last + 1, MOST_CURVES)).round().astype(int))
        every = self.profiles
        deepest = float(every["depth"].max())
        times = 10.0 ** np.floor(np.log10(SEEN / deepest)) if deepest > 0.0 else 1.0  # so that wear is seen
        across, down, worn = (
            wl.PlotAxis("y, outwards [mm]"),
            wl.PlotAxis("z, down [mm]", inverted=True),
            wl.PlotAxis("depth worn [mm]", inverted=True),
        )
        panels = []
        for side in self.sides:
            new, shapes, depths = every.sel(side=side).isel({along: 0}), [], []
            for number, step in enumerate(chosen):
                one, label = every.sel(side=side).isel({along: step}), f"{distances[step]:,.0f} {unit or along}"
                y, z = (new[name].values + times * (one[name] - new[name]).values for name in "yz")
                shapes.append(wl.Curve(label, y, z, colour=number))
                depths.append(wl.Curve(label, one["y"].values, one["depth"].values, colour=number))
            title = self.body if side == "mean" else f"{side} {self.body}"
            panels.append(wl.Panel(across, down, tuple(shapes), f"{title}, wear × {times:g}"))
            panels.append(wl.Panel(across, worn, tuple(depths), f"{title}, wear along the normal"))
        for beginning, label in CURVES.items():
            there = self.table.filter(regex=f"^{beginning}").dropna(axis=1, how="all")
            if beginning == "flange":
                there = there - there.iloc[0]
            curves = [
                wl.Curve(_words(str(column)), distances, values.to_numpy(), colour=number)
                for number, (column, values) in enumerate(there.items())
            ]
            if curves:
                panels.append(wl.Panel(wl.PlotAxis(self.table.columns[0]), wl.PlotAxis(label), tuple(curves)))
        caption = f"The {self.body} after {last} steps. It follows from the given line and wear law alone."
        return wl.FigureData("life", f"Life of a {self.body}", tuple(panels), caption)

    def plot(self) -> Figure:
        """Draw profiles over the distance, the wear along their normals, and the measures, as a matplotlib figure."""
        return plot(self.figure())

    def __repr__(self) -> str:
        first, last = self.table.iloc[0], self.table.iloc[-1]
        along, unit = name_and_unit(self.table.columns[0])
        why = {"": ", interrupted", "over": ""}.get(self.ended, f", to the limit of {_words(self.ended)}")
        steps = f"{len(self.table) - 1} steps"
        lines = [f"Life of a {self.body}: {_number(last.iloc[0])} {unit or along}, {steps}{why}"]
        for one in map(str, self.table.columns[1:]):
            if not one.startswith("factor") and np.isfinite(last[one]):
                unit = readable(name_and_unit(one)[1])
                lines.append(f"  {_words(one):<26}{_number(first[one])} to {_number(last[one])} {unit}".rstrip())
        return "\n".join(lines)


def _words(column: str) -> str:
    """Return the name of a measure for readers."""
    return name_and_unit(column)[0].replace("_", " ").replace("gradient", "gradient qR")


def _number(value: float) -> str:
    return f"{value:,.0f}" if abs(value) >= 1e4 else f"{value:.4g}"
