"""Drawing a figure when it is asked for: the one place that loads matplotlib for results that rarely need it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from wearlaw.figures.curves import FigureData

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def plot(figure: FigureData) -> Figure:
    """Return a drawing of a figure, as `wearlaw.figures.drawing.draw` does."""
    from wearlaw.figures.drawing import draw

    return draw(figure)
