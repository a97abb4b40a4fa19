"""What a figure shows, apart from how it is drawn: curves and points with their axes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from wearlaw.arrays.array import Array

FigureFormat = Literal["png", "pdf", "svg"]
"""The format of a figure's file."""

BLACK = 6
"""The number of black, the last colour of the palette: of what was measured, and of lines to compare with."""


@dataclass(frozen=True, eq=False)
class Curve:
    """One curve, or a set of points, of a figure.

    Attributes
    ----------
    label : str
        What the legend calls it.
    x, y : ndarray, (points,)
        In the units that the labels of the axes give.
    colour, dash : int
        Numbers of its colour, with its marker, and its line style; the same number is the same in all of a report.
    low, high : ndarray, (points,), or None
        The ends of a band about it.
    points : bool
        Whether it consists of points, which no line joins.
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
    """One axis of a panel: its label with the unit, its scale, and its ends where they are not those of the curves."""

    label: str
    scale: Literal["linear", "log"] = "linear"
    ends: tuple[float, float] | None = None


@dataclass(frozen=True, eq=False)
class Panel:
    """One pair of axes with its curves."""

    x: PlotAxis
    y: PlotAxis
    curves: tuple[Curve, ...]
    title: str = ""


@dataclass(frozen=True, eq=False)
class FigureData:
    """A figure: its panels from left to right, and what a reader must know.

    Attributes
    ----------
    name : str
        The name of its file, an identifier.
    title, caption : str
        Plain text; the caption also says what is not shown, and why.
    panels : tuple of Panel
    bands : str
        What the bands about curves are, where there are any.
    """

    name: str
    title: str
    panels: tuple[Panel, ...]
    caption: str = ""
    bands: str = "published range of parameters"


def has_band(figure: FigureData) -> bool:
    """Return whether a figure has a band about any line; points have bars."""
    return any(curve.low is not None and not curve.points for panel in figure.panels for curve in panel.curves)
