"""The life of a profile: what a run returns."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
import xarray

import wearlaw as wl
from wearlaw import Array
from wearlaw_life._removal import Profile, normal_depth
from wearlaw_output.plot import plot

if TYPE_CHECKING:
    from matplotlib.figure import Figure

UNITS = {
    "distance": "km",
    "passages": "",
    "depth": "mm",
    "mass": "kg",
    "mass_left": "kg",
    "mass_right": "kg",
    "worn_area": "mm^2",
    "flange_height": "mm",
    "flange_thickness": "mm",
    "flange_gradient": "mm",
    "hollow": "mm",
    "equivalent_conicity": "",
    "factor": "",
}
"""Columns of a life, with their units in tables."""

SHOWN = {name: name.replace("_", " ") for name in UNITS} | {"flange_gradient": "flange gradient qR"}
"""Names for people."""

MOST_CURVES = 6
"""Most profiles in a picture."""

SEEN = 10.0
"""Largest depth as drawn on the profile [mm]."""

PLACES = 601
"""Places along a profile in `Life.profiles`."""


@dataclass(frozen=True, eq=False)
class Life:
    """How a profile wears over a distance.

    Attributes
    ----------
    pipeline : Pipeline
        The pipeline with the worn profile, for further predictions.
    body : str
        The body that wears.
    ended : str
        Why the life ended: "over", or the name of the measure that reached its limit; "" if it was interrupted.
    worn_profiles : tuple of Profile
        The profile at the start and after each step.
    rows : tuple of dict
        Measures at the start and after each step, in SI; see `table`.
    """

    pipeline: wl.Pipeline[...]
    body: str
    ended: str
    worn_profiles: tuple[Profile, ...]
    rows: tuple[dict[str, float], ...] = field(repr=False)

    @property
    def profile(self) -> Profile:
        """The worn profile."""
        return self.worn_profiles[-1]

    @property
    def along(self) -> str:
        """What the life is counted in: "distance", or "passages" of a rail."""
        return next(iter(self.rows[0]))

    @property
    def table(self) -> pd.DataFrame:
        """The measures at the start and after each step, with units in the heads.

        `depth` is the largest depth along the normal of the first profile. `mass` is what a wheel lost, or a metre of
        rail. `worn_area` is the area between the sections of the first profile and this one. `factor` is what the
        step's depths were multiplied by so that the removed mass is the predicted one.
        """
        return pd.DataFrame({_head(name): self._column(name) for name in self.rows[0]})

    @property
    def profiles(self) -> xarray.Dataset:
        """Profiles over the distance: y, z and the depth along the normal of the first profile, at its places.

        The places are arc lengths of the first profile [mm]; y and z are those of the surface that the normal there
        meets now.
        """
        first = self.worn_profiles[0]
        s = np.linspace(first.curve.s[0], first.curve.s[-1], PLACES)
        y, z, angle, _ = first.curve.at(s)
        depth = np.array([normal_depth(first, one, s) for one in self.worn_profiles])
        sign = 1.0 if first.kind == "rail" else -1.0
        dims = (self.along, "place")
        data = {"y": y - sign * depth * np.sin(angle), "z": z + sign * depth * np.cos(angle), "depth": depth}
        names = {"y": "y, outwards", "z": "z, down", "depth": "depth worn"}
        return xarray.Dataset(
            {name: (dims, 1e3 * values, {"units": "mm", "long_name": names[name]}) for name, values in data.items()},
            {
                self.along: (self.along, self._column(self.along), {"units": UNITS[self.along]}),
                "place": ("place", 1e3 * s, {"units": "mm", "long_name": "position along the first profile"}),
                "body": self.body,
            },
        )

    def figure(self) -> wl.FigureData:
        """Return the data of `plot`."""
        along, unit = self._column(self.along), UNITS[self.along]
        chosen = np.unique(np.linspace(0, along.size - 1, min(along.size, MOST_CURVES)).round().astype(int))
        every = self.profiles
        new, deepest = every.isel({self.along: 0}), float(every["depth"].max())
        times = 10.0 ** np.floor(np.log10(SEEN / deepest)) if deepest > 0.0 else 1.0  # so that wear is seen
        shapes, depths = [], []
        for number, step in enumerate(chosen):
            one, label = every.isel({self.along: int(step)}), f"{along[step]:,.0f} {unit or 'passages'}"
            y, z = (new[name].values + times * (one[name] - new[name]).values for name in "yz")
            shapes.append(wl.Curve(label, y, z, colour=number))
            depths.append(wl.Curve(label, one["y"].values, one["depth"].values, colour=number))
        across, distance = wl.PlotAxis("y, outwards [mm]"), wl.PlotAxis(_label(self.along))
        panels = [
            wl.Panel(
                across,
                wl.PlotAxis("z, down [mm]", inverted=True),
                tuple(shapes),
                f"profile of the {self.body}, wear × {times:g}",
            ),
            wl.Panel(across, wl.PlotAxis("depth worn [mm]", inverted=True), tuple(depths), "wear along the normal"),
        ]
        for names in (("flange_height", "flange_thickness", "flange_gradient"), ("equivalent_conicity",), ("mass",)):
            there = [name for name in names if np.isfinite(self._column(name)).any()]
            values = [self._column(name) for name in there]
            values = [one - one[0] for one in values] if len(names) > 1 else values
            curves = tuple(
                wl.Curve(SHOWN[name], along, value, colour=number)
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
        values = np.array([row.get(name, np.nan) for row in self.rows])
        return np.asarray(wl.Q(values, si_unit(name)).m_as(UNITS[name]))

    def __repr__(self) -> str:
        values = {name: self._column(name) for name in self.rows[0]}
        why = {"": ", interrupted", "over": ""}.get(self.ended, f", to the limit of {SHOWN.get(self.ended, '')}")
        run = f"{_number(values.pop(self.along)[-1])} {UNITS[self.along] or 'passages'}, {len(self.rows) - 1} steps"
        lines = [f"Life of a {self.body}: {run}{why}"]
        for name, value in values.items():
            if name != "factor" and np.isfinite(value[-1]):
                ends = f"{_number(value[0])} to {_number(value[-1])} {_symbol(name)}"
                lines.append(f"  {SHOWN[name]:<22}{ends}".rstrip())
        return "\n".join(lines)


def si_unit(name: str) -> str:
    """Return the unit of a column in `Life.rows`."""
    return {"mm": "m", "mm^2": "m^2", "km": "m"}.get(UNITS[name], UNITS[name])


def _symbol(name: str) -> str:
    return UNITS[name].replace("^2", "²")


def _head(name: str) -> str:
    return f"{name} [{UNITS[name]}]" if UNITS[name] else name


def _label(name: str) -> str:
    return f"{SHOWN[name]} [{_symbol(name)}]" if UNITS[name] else SHOWN[name]


def _number(value: Any) -> str:
    return f"{value:,.0f}" if abs(value) >= 1e4 else f"{value:.4g}"
