"""The data of a figure: curves and points with their axes, independent of how they are drawn."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from wearlaw.arrays.array import Array

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
        Its name in the legend.
    x, y : ndarray, (points,)
        In the units of the axis labels.
    colour, dash : int
        Index of its colour and marker, and of its line style; the same throughout a report.
    low, high : ndarray, (points,), or None
        Ends of a band around it.
    points : bool
        Whether it is a set of points, not joined by a line.
    """

    label: str
    x: Array
    y: Array
    colour: int = 0
    dash: int = 0
    low: Array | None = None
    high: Array | None = None
    points: bool = False


@dataclass(frozen=True, eq=False)
class PlotAxis:
    """An axis of a panel: its label with the unit, its scale, and its ends if the curves do not set them."""

    label: str
    scale: Literal["linear", "log"] = "linear"
    ends: tuple[float, float] | None = None


@dataclass(frozen=True, eq=False)
class Panel:
    """A pair of axes with its curves."""

    x: PlotAxis
    y: PlotAxis
    curves: tuple[Curve, ...]
    title: str = ""


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
    """

    name: str
    title: str
    panels: tuple[Panel, ...]
    caption: str = ""
    bands: str = "published range of parameters"


def has_band(figure: FigureData) -> bool:
    """Return whether any line of a figure has a band; points have error bars."""
    return any(curve.low is not None and not curve.points for panel in figure.panels for curve in panel.curves)
