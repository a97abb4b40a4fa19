"""Drawing a figure on demand: the one place that loads matplotlib for results that seldom need it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from wearlaw_apps.output.curves import FigureData

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def plot(figure: FigureData) -> Figure:
    """Draw a figure with `wearlaw_apps.output.drawing.draw`."""
    from wearlaw_apps.output.drawing import draw

    return draw(figure)
