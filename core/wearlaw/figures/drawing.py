"""Figures drawn with matplotlib in one style, for print.

The palette can be told apart by colour-blind people (Okabe and Ito, 2008). The legend stands below the panels, where
it covers no curve.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import matplotlib as mpl
from matplotlib.figure import Figure

from wearlaw.figures.curves import has_band

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from wearlaw.figures.curves import Curve, FigureData, Panel, PlotAxis

PALETTE = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
LINES = ("-", "--", ":", "-.")
STYLE: Any = {
    "axes.grid": True,
    "grid.alpha": 0.3,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.titlesize": "medium",
    "axes.xmargin": 0.02,
    "figure.titlesize": "large",
    "legend.frameon": False,
    "legend.fontsize": "small",
    "legend.title_fontsize": "small",
    "font.size": 10,
    "lines.linewidth": 1.6,
}
WIDTH, ROW_HEIGHT = 7.4, 3.6
"""Width of a figure and height of a row of panels, in inches."""
LEGEND_WIDTH = 100
"""How many characters fit below a figure."""


def draw(figure: FigureData) -> Figure:
    """Return a drawing of a figure; panels stand in rows of two, and an odd one first over a whole row."""
    count = len(figure.panels)
    cells = [*([0, 0] if count % 2 else []), *range(count % 2, count)]
    rows: Any = [cells[start : start + 2] for start in range(0, len(cells), 2)]
    with mpl.rc_context(STYLE):
        drawn = Figure(figsize=(WIDTH, 1.2 + ROW_HEIGHT * len(rows)), layout="constrained")
        axes: dict[int, Axes] = drawn.subplot_mosaic(rows)
        for number, panel in enumerate(figure.panels):
            _fill(axes[number], panel)
        drawn.suptitle(_literal(figure.title))
        _legend(drawn, figure, list(axes.values()))
    return drawn


def _fill(axes: Axes, panel: Panel) -> None:
    for curve in panel.curves:
        _plot(axes, curve)
    axes.set(xlabel=_literal(panel.x.label), ylabel=_literal(panel.y.label), title=_literal(panel.title))
    axes.set(xscale=panel.x.scale, yscale=panel.y.scale)
    axes.set(xlim=_ends(panel.x), ylim=_ends(panel.y))


def _ends(axis: PlotAxis) -> Any:
    return axis.ends or (None, None)


def _plot(axes: Axes, curve: Curve) -> None:
    colour = PALETTE[curve.colour % len(PALETTE)]
    label = _literal(curve.label)
    if curve.points:
        axes.plot(curve.x, curve.y, "o", label=label, color=colour, markersize=4, zorder=3)
    else:
        # A line of one point would not be seen without a marker.
        marker = "o" if curve.x.size == 1 else ""
        axes.plot(curve.x, curve.y, LINES[curve.dash % len(LINES)], label=label, color=colour, marker=marker)
    if curve.low is None or curve.high is None:
        return
    if curve.points:
        spread = (curve.y - curve.low, curve.high - curve.y)
        axes.errorbar(curve.x, curve.y, spread, fmt="none", ecolor=colour, elinewidth=1.0, capsize=2.0)
    else:
        axes.fill_between(curve.x, curve.low, curve.high, color=colour, alpha=0.12, lw=0)


def _legend(drawn: Figure, figure: FigureData, axes: list[Axes]) -> None:
    """Add one legend for all panels, which names each curve once."""
    lines = [line for one in axes for line in one.get_lines()]
    entries = {str(line.get_label()): line for line in lines if not str(line.get_label()).startswith("_")}
    widths = [len(name) + 8 for name in entries]  # in characters, with what stands for the line and the gap
    drawn.legend(
        list(entries.values()),
        list(entries),
        loc="outside lower center",
        ncols=len(entries) if sum(widths) <= LEGEND_WIDTH else max(1, LEGEND_WIDTH // max(widths)),
        title=_literal(f"bands: {figure.bands}") if has_band(figure) else None,
    )


def _literal(text: str) -> str:
    """Return a text that matplotlib shows as it is: no formula between dollar signs, no hidden legend entry."""
    shown = text.replace("$", r"\$")
    return f" {shown}" if shown.startswith("_") else shown
