"""Drawing a figure on demand: the one place that loads matplotlib for results that seldom need it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from wearlaw_output.curves import FigureData

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def plot(figure: FigureData) -> Figure:
    """Draw a figure with `wearlaw_output.drawing.draw`."""
    from wearlaw_output.drawing import draw

    return draw(figure)
