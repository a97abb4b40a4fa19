"""Draws the picture of signs and conventions."""

from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Arc, Circle, Ellipse, Rectangle

from wearlaw_apps.output.style import PALETTE, STYLE


def conventions() -> Figure:
    """Return the axes, creepages and forces of a wheel on a rail: from the side, from above, and rigid slip."""
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(7.4, 5.6), layout="constrained")
        rows: Any = [["side", "side", "side", "above", "above", "above"], ["ξ", "ξ", "η", "η", "φ", "φ"]]
        axes = figure.subplot_mosaic(rows, height_ratios=(1.35, 1.0))
        _from_the_side(axes["side"])
        _from_above(axes["above"])
        _rigid_slip(axes["ξ"], "rigid slip, ξ > 0", lambda x, y: (np.ones_like(x), np.zeros_like(y)))
        _rigid_slip(axes["η"], "η > 0", lambda x, y: (np.zeros_like(x), np.ones_like(y)))
        _rigid_slip(axes["φ"], "φ > 0", lambda x, y: (-1.6 * y, -1.6 * x))
        for one in axes.values():
            one.set_aspect("equal")
            one.set_axis_off()
    return figure


def _from_the_side(axes: Axes) -> None:
    """Draw a braking wheel on its rail, which rolls to the left as in all panels."""
    axes.add_patch(Circle((0.0, 1.0), 1.0, fill=False, lw=1.6))
    axes.add_patch(Rectangle((-1.5, -0.42), 3.0, 0.42, facecolor="0.9", edgecolor="black", lw=1.0))
    _arrow(axes, (0.0, 1.0), (-0.8, 0.0))
    axes.text(-0.4, 1.06, "V", ha="center")
    axes.add_patch(Arc((0.0, 1.0), 1.3, 1.3, theta1=20.0, theta2=90.0, lw=1.8))
    _arrow(axes, (0.02, 1.65), (-0.1, 0.0))
    axes.text(0.55, 1.5, "ω")
    axes.text(0.0, 0.55, "ωR < V,  ξ > 0", ha="center")
    _arrow(axes, (0.0, -0.1), (-0.7, 0.0), PALETTE[0])
    axes.text(-0.35, -0.16, "Fx on the rail", color=PALETTE[0], ha="center", va="top")
    _arrow(axes, (0.0, 0.14), (0.7, 0.0), PALETTE[1], linestyle="--")
    axes.text(0.78, 0.08, "−Fx on the wheel", color=PALETTE[1])
    axes.set(xlim=(-1.6, 1.9), ylim=(-0.5, 2.1), title="from the side")


def _from_above(axes: Axes) -> None:
    """Draw the patch with its axes, and the forces on the rail."""
    axes.add_patch(Ellipse((0.0, 0.0), 2.4, 1.7, facecolor="0.93", edgecolor="black", lw=1.6))
    for way, name in (((1.7, 0.0), "x"), ((0.0, 1.2), "y")):
        _arrow(axes, (-way[0], -way[1]), (2.0 * way[0], 2.0 * way[1]), lw=1.0)
        axes.text(way[0] + 0.06, way[1] - 0.04, name)
    _arrow(axes, (-0.5, 1.12), (-1.1, 0.0))
    axes.text(-1.05, 1.2, "rolling, X in CONTACT", ha="center")
    _arrow(axes, (0.0, 0.0), (-0.8, 0.0), PALETTE[0])
    axes.text(-0.5, -0.07, "Fx", color=PALETTE[0], ha="center", va="top")
    _arrow(axes, (0.0, 0.0), (0.0, 0.65), PALETTE[0])
    axes.text(0.07, 0.5, "Fy", color=PALETTE[0])
    axes.add_patch(Arc((0.0, 0.0), 0.9, 0.9, theta1=105.0, theta2=172.0, lw=1.8, color=PALETTE[2]))
    _arrow(axes, (-0.12, 0.432), (0.06, 0.014), PALETTE[2])
    axes.text(-0.42, 0.32, "φ, Mz", color=PALETTE[2], ha="right")
    axes.text(-1.26, -0.08, "−a\nleading\nedge", ha="right", va="top")
    axes.text(1.26, -0.08, "a\ntrailing\nedge", ha="left", va="top")
    axes.text(0.06, -0.87, "−b", va="top")
    axes.text(0.06, 0.87, "b")
    axes.set(xlim=(-2.0, 2.0), ylim=(-1.3, 1.4), title="the patch, with forces on the rail")


def _rigid_slip(axes: Axes, title: str, slip: Any) -> None:
    """Draw the rigid slip over the patch; a positive longitudinal part points to the left."""
    x, y = (part.ravel() for part in np.meshgrid(np.linspace(-1.0, 1.0, 7), np.linspace(-0.72, 0.72, 5)))
    inside = x**2 + (y / 0.75) ** 2 < 0.75
    along, across = slip(x[inside], y[inside])
    axes.add_patch(Ellipse((0.0, 0.0), 2.2, 1.65, facecolor="0.93", edgecolor="black", lw=1.2))
    axes.quiver(x[inside], y[inside], -along, across, color=PALETTE[0], pivot="mid", scale=11.0, width=0.011)
    axes.set(xlim=(-1.3, 1.3), ylim=(-0.9, 0.9), title=title)


def _arrow(
    axes: Axes, start: tuple[float, float], way: tuple[float, float], colour: str = PALETTE[-1], **style: Any
) -> None:
    head = (start[0] + way[0], start[1] + way[1])
    looks = {"arrowstyle": "-|>", "color": colour, "lw": 1.8, "shrinkA": 0.0, "shrinkB": 0.0, **style}
    axes.annotate("", head, start, arrowprops=looks)
