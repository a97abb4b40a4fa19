"""Drawing a figure on demand: the one place that loads matplotlib for results that seldom need it."""

from __future__ import annotations

import dataclasses
from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import TYPE_CHECKING, Literal, TypeAlias

from wearlaw.errors import InputError, shown
from wearlaw_apps.output.curves import FigureData, PlotAxis

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Log: TypeAlias = Literal["", "x", "y", "xy"]
"""The axes of a figure that are logarithmic."""


def plot(figure: FigureData, managed: bool = False) -> Figure:
    """Draw a figure with `wearlaw_apps.output.drawing.draw`."""
    from wearlaw_apps.output.drawing import draw

    return draw(figure, managed)


def plotted(
    figure: FigureData, ax: Axes | Sequence[Axes] | None = None, log: Log | None = None, title: str | None = None
) -> Axes:
    """Draw a figure as `Drawn.plot` does."""
    if log not in (None, "", "x", "y", "xy"):
        raise InputError(f'log: must be "x", "y", "xy" or "", got {shown(log)}')
    if log is not None:
        panels = (
            dataclasses.replace(panel, x=_scaled(panel.x, "x" in log), y=_scaled(panel.y, "y" in log))
            for panel in figure.panels
        )
        figure = dataclasses.replace(figure, panels=tuple(panels))
    if ax is None:
        figure = figure if title is None else dataclasses.replace(figure, title=title)
        return plot(figure, managed=True).axes[0]
    from wearlaw_apps.output.drawing import draw_into

    axes = [*ax] if isinstance(ax, Sequence) else list(getattr(ax, "flat", [ax]))
    if len(axes) != len(figure.panels):
        raise InputError(f"ax: the figure has {len(figure.panels)} panels; give axes for each, got {len(axes)}")
    draw_into(axes, figure)
    if title is not None:
        axes[0].set_title(title)
    return axes[0]


def _scaled(axis: PlotAxis, log: bool) -> PlotAxis:
    """Return an axis with a scale, without ends that it cannot show."""
    ends = None if log and axis.ends is not None and axis.ends[0] <= 0.0 else axis.ends
    return dataclasses.replace(axis, scale="log" if log else "linear", ends=ends)


class Drawn(ABC):
    """A result that is drawn as one figure."""

    @abstractmethod
    def figure_data(self) -> FigureData:
        """Return what `plot` draws."""

    def plot(
        self, *, ax: Axes | Sequence[Axes] | None = None, log: Log | None = None, title: str | None = None
    ) -> Axes:
        """Draw `figure_data`, and return the axes of its first panel; their `figure` is the whole.

        Parameters
        ----------
        ax : matplotlib.axes.Axes or sequence of these, optional
            Axes to draw into, one for each panel, in the style in force. Default: those of a new figure of
            `matplotlib.pyplot`, which it and notebooks show.
        log : {"", "x", "y", "xy"}, optional
            The logarithmic axes. Default: by what is drawn.
        title : str, optional
            The title.

        Raises
        ------
        InputError
            If `log` is unknown, or there are not as many axes as panels.
        """
        return plotted(self.figure_data(), ax, log, title)
