"""The description of a figure: panels of curves, points and maps with their axes, independent of how they are drawn."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from wearlaw.arrays import Array

FigureFormat = Literal["png", "pdf", "svg"]
"""The format of a figure's file."""

BLACK = 6
"""Index of black, the last colour of the palette, for measurements and reference lines."""


@dataclass(frozen=True, eq=False)
class Curve:
    """A curve or a set of points in a figure.

    Attributes
    ----------
    label : str
        Its name in the legend; "" leaves it out.
    x, y : ndarray, (points,)
        In the units of the axis labels.
    colour, dash : int
        Index of its colour and marker, and of its line style; the same throughout a report.
    low, high : ndarray, (points,), or None
        Ends of a band around it; of points, ends of error bars.
    points : bool
        Whether it is a set of points, not joined by a line. Predictions are lines, measurements points.
    hollow : bool
        Whether the markers of points are hollow: predictions that no line can join.
    outside : ndarray of bool, (points,), or None
        Where a line lies outside the range of its law, and is dashed; such a line is told by markers, not by dashes.
    computed : bool
        Whether its points were computed: a line of few such points has a marker at each.
    """

    label: str
    x: Array
    y: Array
    colour: int = 0
    dash: int = 0
    low: Array | None = None
    high: Array | None = None
    points: bool = False
    outside: NDArray[np.bool_] | None = None
    hollow: bool = False
    computed: bool = True


@dataclass(frozen=True, eq=False)
class Map:
    """A variable over a grid of the values of both axes, drawn in colours.

    Attributes
    ----------
    label : str
        The variable with its unit.
    x : ndarray, (columns,)
    y : ndarray, (rows,)
        In the units of the axis labels.
    values : ndarray, (rows, columns)
        NaN where there is no value.
    scale : {"linear", "log"}
        Scale of the colours.
    borders : mapping of str to ndarray of bool, (rows, columns)
        Regions by their names in the legend, of which the border is drawn as a line.
    """

    label: str
    x: Array
    y: Array
    values: Array
    scale: Literal["linear", "log"] = "linear"
    borders: Mapping[str, NDArray[np.bool_]] = field(default_factory=dict)


@dataclass(frozen=True)
class Shade:
    """A shaded part of a panel.

    Attributes
    ----------
    label : str
        Its name in the legend.
    spans : tuple of (float, float)
        Ends of each span along the x axis.
    strip : bool
        Whether it is a thin strip along the x axis; otherwise it is as high as the panel.
    """

    label: str
    spans: tuple[tuple[float, float], ...]
    strip: bool = False


@dataclass(frozen=True)
class Limit:
    """A limit in a panel: a thin line with its name.

    Attributes
    ----------
    label : str
        Its name, which stands at the line.
    at : float
        Its value.
    axis : {"x", "y"}
        The axis that it is a value of.
    """

    label: str
    at: float
    axis: Literal["x", "y"] = "y"


STRIP = 0.025
"""Height of a strip along the x axis, as a share of the panel."""


@dataclass(frozen=True)
class PlotAxis:
    """An axis of a panel.

    Attributes
    ----------
    label : str
        Its label with the unit.
    scale : {"linear", "log"}
        Linear or logarithmic.
    ends : tuple of (float, float), or None
        The lower and the higher end; None if the curves set them.
    inverted : bool
        Whether values grow from right to left or from top to bottom, as for a depth.
    """

    label: str
    scale: Literal["linear", "log"] = "linear"
    ends: tuple[float, float] | None = None
    inverted: bool = False

    def shows(self, values: Array) -> NDArray[np.bool_]:
        """Return which values lie between the ends."""
        low, high = self.ends or (-np.inf, np.inf)
        return (low <= values) & (values <= high)


@dataclass(frozen=True, eq=False)
class Panel:
    """A pair of axes with its curves, shades and limits.

    With `equal`, a length in x is as long as in y, as for the shape of a body. A map lies below the curves.
    """

    x: PlotAxis
    y: PlotAxis
    curves: tuple[Curve, ...]
    title: str = ""
    shades: tuple[Shade, ...] = ()
    equal: bool = False
    map: Map | None = None
    limits: tuple[Limit, ...] = ()


@dataclass(frozen=True, eq=False)
class FigureData:
    """A figure: its panels from left to right, with title and caption.

    Attributes
    ----------
    name : str
        File name, an identifier.
    title, caption : str
        Plain text; the caption also says what is missing, and why.
    panels : tuple of Panel
    bands : str
        Meaning of the bands, if there are any.
    conditions : str
        The study and the conditions that are the same in all panels, for a line below the title of a picture.
    legends : bool
        Whether each panel of a picture has a legend of its own, instead of one below all panels.
    """

    name: str
    title: str
    panels: tuple[Panel, ...]
    caption: str = ""
    bands: str = "published range of parameters"
    conditions: str = ""
    legends: bool = False


OUTSIDE = "outside the range of the law"
"""Legend of the dashed parts of lines."""

FEW = 25
"""Most points of a line that all have a marker."""

MARKS = 7
"""Markers along a line of more points, which tell it from others in a print without colours."""

DECADES = 30.0
"""Ratio of the largest to the smallest value beyond which a scale that nobody chose is logarithmic."""


def head_of_legend(figure: FigureData) -> str:
    """Return the title of the legend of a figure, which explains bands, and hollow markers beside others."""
    curves = [curve for panel in figure.panels for curve in panel.curves]
    ranges = dict.fromkeys("error bars" if curve.hollow else "bands" for curve in curves
                           if curve.low is not None and (curve.hollow or not curve.points))  # fmt: skip
    markers = {curve.hollow for curve in curves if curve.points}
    hollow = ["hollow markers: predictions"] if len(markers) > 1 else []
    return "; ".join([*(f"{kind}: {figure.bands}" for kind in ranges), *hollow])


def shows_outside(figure: FigureData) -> bool:
    """Return whether a figure shows any part of a line outside the range of its law, between two points in sight."""
    for panel in figure.panels:
        for curve in panel.curves:
            outside = in_parts(curve)[1]
            if outside is not None:
                seen = np.isfinite(outside) & panel.x.shows(curve.x)
                if (seen[1:] & seen[:-1]).any() or (seen.size == 1 and seen.all()):
                    return True
    return False


def in_parts(curve: Curve) -> tuple[Array, Array | None]:
    """Return the y values of a curve inside the range of its law, and those outside if there are any.

    Values of the other part are NaN. The part outside begins and ends at the nearest point inside.
    """
    outside = curve.outside
    if outside is None or curve.points or not outside.any():
        return curve.y, None
    near = outside.copy()
    near[1:] |= outside[:-1]
    near[:-1] |= outside[1:]
    return np.where(outside, np.nan, curve.y), np.where(near, curve.y, np.nan)


def marked_points(curve: Curve, style: int, panel: Panel | None = None) -> list[int]:
    """Return the indices of the points of a line that have a marker, in a panel or on linear axes.

    These are all points of a line of few, and those without a neighbour to join them to. Lines of laws but the first
    have some more at equal lengths along the line.
    """
    axes = (panel.x, panel.y) if panel else (PlotAxis(""), PlotAxis(""))
    seen, places = np.ones(curve.x.shape, bool), []
    for axis, values in zip(axes, (curve.x, curve.y), strict=True):
        log = axis.scale == "log"
        seen &= np.isfinite(values) & axis.shows(values) & ((values > 0.0) | (not log))
        places.append(np.log10(values, where=values > 0.0, out=np.zeros(values.shape)) if log else values)
    around = np.pad(seen, 1)
    chosen = seen & ~around[:-2] & ~around[2:]
    if curve.computed and seen.sum() <= FEW:
        chosen = seen
    elif curve.outside is not None and style:
        there = np.flatnonzero(seen)
        steps = np.hypot(*(np.diff(place[there]) / (np.ptp(place[there]) or 1.0) for place in places))
        length = np.concatenate([[0.0], np.cumsum(steps)])
        at = (np.arange(MARKS) + style / 7.0) / MARKS * length[-1]  # marks of lines that coincide stand apart
        chosen[there[np.searchsorted(length, at)]] = True
    return list(map(int, np.flatnonzero(chosen)))


def fit_for_log(*values: Array) -> bool:
    """Return whether values that nobody chose a scale for are better seen on a logarithmic one."""
    numbers = np.concatenate([np.ravel(array) for array in values]) if values else np.zeros(0)
    seen = numbers[np.isfinite(numbers) & (numbers != 0.0)]
    return bool(seen.size and seen.min() > 0.0 and seen.max() > DECADES * seen.min())


def map_range(figure: FigureData) -> tuple[float, float]:
    """Return the least and the largest value of the maps of a figure, which share a scale of colours."""
    maps = [panel.map for panel in figure.panels if panel.map is not None]
    values = np.concatenate([np.ravel(drawn_map.values) for drawn_map in maps])
    seen = values[np.isfinite(values) & ((values > 0.0) | (maps[0].scale == "linear"))]
    return (float(seen.min()), float(seen.max())) if seen.size else (0.0, 1.0)


def borders_of(drawn: Map | None) -> dict[str, tuple[int, NDArray[np.bool_]]]:
    """Return the regions of a map that have a border in it, by name, each with its number, which sets its line."""
    regions = enumerate(drawn.borders.items() if drawn else ())
    return {name: (number, region) for number, (name, region) in regions if region.any() and not region.all()}
