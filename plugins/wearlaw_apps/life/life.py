"""The life of a profile: what a run returns."""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
import xarray

import wearlaw as wl
from wearlaw_apps.life.removal import positions
from wearlaw_apps.output.curves import Limit
from wearlaw_apps.output.labels import readable
from wearlaw_apps.output.plot import plot

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from wearlaw_models.rigs.wheelset import Profile

SIDES = {1: ("",), 2: ("_left", "_right")}
"""Ends of the names of columns: of one profile for both sides, or of each side."""

MOST_CURVES = 4
"""Most profiles in a picture."""

NEAR = 1e-9
"""Share of the way to a limit at which it counts as reached."""

SEEN = 10.0
"""Largest depth as drawn on the profile [mm]."""

PLACES = 601
"""Places along a profile in `Life.profiles`."""

RAIL = "rail_"
"""Beginning of the names of the measures of a rail that wears with a wheel."""

DRAWN = ("depth", "flange_thickness", "diameter", "vertical_wear", "side_wear")
"""Lengths that are drawn over the distance if no measure has a limit."""


def name_and_unit(column: str) -> tuple[str, str]:
    """Return the name and the unit in the head of a column."""
    name, _, unit = column.partition(" [")
    return name, unit.removesuffix("]")


def measure_of(name: str) -> str:
    """Return the measure of a column, which may be that of one side."""
    return name.removesuffix("_left").removesuffix("_right")


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
        the removed mass is the predicted one. Measures of a rail that wears with its wheel begin with `rail_`; its
        last profile is that of the pipeline. Where each side has its own profile, the names of their columns end with
        "_left" and "_right". A cut has a row of its own, at the distance of the row before it.
    notes : tuple of tuple of str
        Notes on each step, such as how many patches lie outside the range of the law.
    limits : dict of str to float
        The limits of `until`, `turn` and `least_diameter`, in the units of the table, by column.
    cuts : pandas.DataFrame
        A row for each cut: the distance, also since the last cut, the measure whose limit asked for it, the depth of
        the cut at the taping line, the diameter lost to wear and cut together, and the diameter that is left [mm].
    rail_profiles : tuple of tuple of Profile
        The profiles of the rail that wears with its wheel, as in `worn_profiles`; empty for one body.
    """

    pipeline: wl.Pipeline[...]
    body: str
    ended: str
    worn_profiles: tuple[tuple[Profile, ...], ...]
    table: pd.DataFrame
    notes: tuple[tuple[str, ...], ...]
    limits: Mapping[str, float] = field(default_factory=dict)
    cuts: pd.DataFrame = field(default_factory=pd.DataFrame)
    rail_profiles: tuple[tuple[Profile, ...], ...] = ()

    @property
    def profile(self) -> Profile:
        """The worn profile; that of the right side if each has its own, as `worn_profiles[-1]` has both."""
        return self.worn_profiles[-1][-1]

    @property
    def reached(self) -> dict[str, float]:
        """The distance [km], or number of passages, at which each limit was first reached, by its column."""
        distances = {}
        for column, limit in self.limits.items():
            start = self.table[column].iloc[0]
            there = np.flatnonzero((self.table[column] - start) / (limit - start) >= 1.0 - NEAR)
            if there.size:
                distances[column] = float(self.table.to_numpy()[there[0], 0])
        return distances

    @property
    def rates(self) -> dict[str, float]:
        """The change of each length among the measures, in mm in 1000 km, up to the first cut; {} for passages.

        There are no rates of service beside them: no published ones with their line could be read.
        """
        table, along = self.table, str(self.table.columns[0])
        if len(self.cuts):
            table = table[table[along] <= self.cuts[along].iloc[0]].iloc[:-1]
        distance = table[along].iloc[-1]
        lengths = [str(column) for column in table if str(column).endswith("[mm]")] if "[km]" in along else []
        first, last = table.iloc[0], table.iloc[-1]
        return {name_and_unit(column)[0]: 1e3 * (last[column] - first[column]) / distance for column in lengths}

    @property
    def profiles(self) -> xarray.Dataset:
        """Profiles over the distance: y, z and the depth along the normal of the first profile, at its places.

        The places are arc lengths of the first profile [mm]; y and z are those of the surface that the normal there
        meets now. NaN beyond the end of a profile that is shorter than the others. A wheel and a rail that wear in one
        life have an axis `body`.
        """
        profiles = self._profiles()
        return profiles if self.rail_profiles else profiles.isel(body=0)

    def _profiles(self) -> xarray.Dataset:
        bodies = {self.body: self.worn_profiles} | ({"rail": self.rail_profiles} if self.rail_profiles else {})
        sides = len(self.worn_profiles[0])
        place = positions([first for worn in bodies.values() for first in worn[0]], PLACES)
        data = np.full((3, len(self.table), len(bodies), sides, PLACES), np.nan)
        for body, worn in enumerate(bodies.values()):
            for side, first in enumerate(worn[0]):
                there = (place >= first.curve.s[0]) & (place <= first.curve.s[-1])
                y, z, angle, _ = first.curve.at(place[there])
                s = wl.Q(1e3 * place[there], "mm")
                depth = np.array([first.depth_to(profiles[side], s).magnitude for profiles in worn])
                inwards = depth if first.kind == "rail" else -depth
                surface = 1e3 * y - inwards * np.sin(angle), 1e3 * z + inwards * np.cos(angle), depth
                data[:, :, body, side, there] = surface
        along, unit = name_and_unit(self.table.columns[0])
        names = {"y": "y, outwards", "z": "z, down", "depth": "depth worn"}
        return xarray.Dataset(
            {
                name: ((along, "body", "side", "place"), values, {"units": "mm", "long_name": text})
                for (name, text), values in zip(names.items(), data, strict=True)
            },
            {
                along: (along, self.table.iloc[:, 0].to_numpy(), {"units": unit}),
                "side": ["mean"] if sides == 1 else ["left", "right"],
                "place": ("place", 1e3 * place, {"units": "mm", "long_name": "position along the first profile"}),
                "body": list(bodies),
            },
        )

    def figure(self) -> wl.FigureData:
        """Return the data of `plot`."""
        column = self.table.columns[0]
        (along, unit), distances = name_and_unit(column), self.table[column].to_numpy()
        last = len(distances) - 1
        chosen = np.unique(np.linspace(0, last, min(last + 1, MOST_CURVES)).round().astype(int))
        every = self._profiles().isel({along: chosen})
        panels = []
        for body, side in itertools.product(every["body"].values, every["side"].values):
            worn = every.sel(body=body, side=side)
            new, deepest = worn.isel({along: 0}), float(worn["depth"].max())
            times = 10.0 ** np.floor(np.log10(SEEN / deepest)) if deepest > 0.0 else 1.0  # so that wear is seen
            magnified = worn + (times - 1.0) * (worn - new)
            title = body if side == "mean" else f"{side} {body}"
            for name, shown, label, what in (
                ("z", magnified, "z, down [mm]", f"wear × {times:g}"),
                ("depth", worn, "depth worn [mm]", "wear along the normal"),
            ):
                curves = tuple(
                    wl.Curve(f"{short(round(distance))} {unit or along}", shown["y"][number].values,
                             shown[name][number].values, colour=number)
                    for number, distance in enumerate(distances[chosen])
                )  # fmt: skip
                x, y = wl.PlotAxis("y, outwards [mm]"), wl.PlotAxis(label, inverted=True)
                panels.append(wl.Panel(x, y, curves, f"{title}, {what}", equal=name == "z"))
        # The first of an odd number of panels is as wide as the page: a single profile, or the measures of several.
        panels.insert(2 if len(panels) == 2 else 0, self._measures(column))
        caption = f"The {self.body} after {len(self.notes)} steps. It follows from the given line and wear law alone."
        return wl.FigureData("life", f"Life of a {self.body}", tuple(panels), caption, legends=True)

    def _measures(self, along: str) -> wl.Panel:
        """Return a panel of the measures over the distance: their way to their limits, or changes of lengths."""
        table, distance, limits = self.table, self.table[along].to_numpy(), self.limits
        columns = list(limits) or [
            column for column in map(str, table)
            if measure_of(name_and_unit(column)[0]).removeprefix(RAIL) in DRAWN and table[column].notna().any()
        ]  # fmt: skip
        curves = []
        for number, column in enumerate(columns):
            unit, start, label = readable(name_and_unit(column)[1]), table[column].iloc[0], words(column)
            change = table[column].to_numpy() - start
            if limits:
                change *= 100.0 / (limits[column] - start)
                label = f"{label}, {short(start)} to {short(limits[column])} {unit}".rstrip()
            curves.append(wl.Curve(label, distance, change, colour=MOST_CURVES + number))
        y = wl.PlotAxis("way to the limit [%]" if limits else "change [mm]")
        lines = (Limit("limit", 100.0),) if limits else ()
        return wl.Panel(wl.PlotAxis(along), y, tuple(curves), "measures", limits=lines)

    def plot(self) -> Figure:
        """Draw profiles over the distance, the depth along them, and the way of the measures to their limits."""
        return plot(self.figure())

    def __repr__(self) -> str:
        first, last = self.table.iloc[0], self.table.iloc[-1]
        along, unit = name_and_unit(self.table.columns[0])
        why = {"": ", interrupted", "over": ""}.get(self.ended, f", to the limit of {words(self.ended)}")
        steps = "1 step" if len(self.notes) == 1 else f"{len(self.notes)} steps"
        lines = [f"Life of a {self.body}: {short(last.iloc[0])} {unit or along}, {steps}{why}"]
        for column in map(str, self.table.columns[1:]):
            of_side = len(self.worn_profiles[0]) == 1 and column.partition(" ")[0].endswith(("_left", "_right"))
            if not (column.removeprefix(RAIL).startswith("factor") or of_side) and np.isfinite(last[column]):
                unit, digits = readable(name_and_unit(column)[1]), 6 if column.startswith("diameter") else 4
                low, high = (short(row[column], digits) for row in (first, last))
                lines.append(f"  {words(column):<26}{low} to {high} {unit}".rstrip())
        if len(self.cuts):
            counts = self.cuts["limit"].map(measure_of).value_counts()
            reasons = " and ".join(f"{count} at the limit of {words(str(name))}" for name, count in counts.items())
            lines.append(f"  cuts: {reasons}")
            for column in map(str, self.cuts.columns):
                if column.startswith(("since_last", "depth_of_cut", "diameter_lost")):
                    low, high = map(short, (self.cuts[column].min(), self.cuts[column].max()))
                    spread = low if low == high else f"{low} to {high}"
                    lines.append(f"    {words(column):<24}{spread} {readable(name_and_unit(column)[1])}")
        return "\n".join(lines)


def words(column: str) -> str:
    """Return the name of a measure for readers."""
    return name_and_unit(column)[0].replace("_", " ").replace("gradient", "gradient qR")


def short(value: float, digits: int = 4) -> str:
    """Return a number for readers."""
    return f"{value:,.0f}" if abs(value) >= 1e4 else f"{value:.{digits}g}"
