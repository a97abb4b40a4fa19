"""Figures drawn with matplotlib in one style, for print.

The palette is safe for colour-blind readers (Okabe and Ito, 2008). Lines that differ only in colour get sparse markers
for prints in grey. The legend stands below the panels, where it covers no curve.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from wearlaw.arrays.array import Array
from wearlaw.figures.curves import OUTSIDE, has_band, in_parts, lone_points, shows_outside

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from wearlaw.figures.curves import Curve, FigureData, Panel, PlotAxis

PALETTE = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
LINES = ("-", "--", ":", "-.")
MARKERS = ("s", "^", "D", "v", "P", "X", "o")
"""One for each colour."""
SPACING = 0.2
"""Distance between markers along a line, as a share of the axes."""
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
AROUND = 0.9
"""Height and width that the labels of a panel take, in inches."""
SHADES = ("#f4f4f4", "#e4e4e4")
"""Greys of the levels of shades."""
THIN, PALE = 0.8, 0.6
"""Width in points and opacity of a line outside the range of its law."""
LEGEND_WIDTH = 100
"""Characters that fit below a figure."""


def draw(figure: FigureData) -> Figure:
    """Draw a figure: panels in rows of two, an odd first panel over a whole row."""
    count = len(figure.panels)
    cells = [*([0, 0] if count % 2 else []), *range(count % 2, count)]
    rows: Any = [cells[start : start + 2] for start in range(0, len(cells), 2)]
    heights = [max(_height(figure.panels[cell], WIDTH / len(set(row))) for cell in row) for row in rows]
    with mpl.rc_context(STYLE):
        drawn = Figure(figsize=(WIDTH, 1.2 + sum(heights)), layout="constrained")
        axes: dict[int, Axes] = drawn.subplot_mosaic(rows, height_ratios=heights)
        for number, panel in enumerate(figure.panels):
            _fill(axes[number], panel, has_markers(figure))
        drawn.suptitle(_literal(figure.title))
        _legend(drawn, figure, list(axes.values()))
    return drawn


def _height(panel: Panel, width: float) -> float:
    """Return the height of a panel of a width, in inches; a shape takes as much as it needs."""
    if not panel.equal:
        return ROW_HEIGHT
    lengths = []
    for axis, name in ((panel.x, "x"), (panel.y, "y")):
        values = np.concatenate([np.asarray(axis.ends or getattr(curve, name), dtype=float) for curve in panel.curves])
        lengths.append(float(np.nanmax(values) - np.nanmin(values)))
    return min(AROUND + (width - AROUND) * lengths[1] / lengths[0], ROW_HEIGHT)


def has_markers(figure: FigureData) -> bool:
    """Return whether lines need markers: if two lines of a panel differ only in colour."""
    for panel in figure.panels:
        lines = {(c.colour % len(PALETTE), c.dash % len(LINES)) for c in panel.curves if not c.points}
        if len(lines) > len({dash for _, dash in lines}):
            return True
    return False


def marked_points(curve: Curve, panel: Panel) -> list[int]:
    """Return the indices of the visible points of a line that get a marker, one per `SPACING`."""
    across = _shares(curve.x, panel.x, [one.x for one in panel.curves])
    up = _shares(curve.y, panel.y, [one.y for one in panel.curves])
    seen = np.flatnonzero((across >= 0.0) & (across <= 1.0) & (up >= 0.0) & (up <= 1.0))
    way = np.append(0.0, np.cumsum(np.hypot(np.diff(across[seen]), np.diff(up[seen]))))
    # Each colour starts elsewhere, so that the markers of coinciding lines do not coincide.
    place = min(SPACING * (0.5 + 3 * curve.colour % len(PALETTE)) / len(PALETTE), 0.5 * way[-1])
    marked = []
    for point, length in zip(seen.tolist(), way.tolist(), strict=False):
        if length >= place:
            marked.append(point)
            place = length + SPACING
    return marked


def _shares(values: Array, axis: PlotAxis, shown: list[Array]) -> Array:
    """Return the positions of values along an axis from 0 to 1, NaN if it cannot show them."""
    scaled = np.log10 if axis.scale == "log" else np.asarray
    with np.errstate(divide="ignore", invalid="ignore"):
        ends = scaled(axis.ends or np.concatenate(shown))
        ends = ends[np.isfinite(ends)]
        low, high = (ends.min(), ends.max()) if ends.size else (0.0, 0.0)
        shares: Array = (scaled(values) - low) / (high - low or 1.0)
    return shares


def _fill(axes: Axes, panel: Panel, markers: bool) -> None:
    for shade in panel.shades:
        for number, (low, high) in enumerate(shade.spans):
            label = "_" if number else _literal(shade.label)
            axes.axvspan(low, high, color=SHADES[shade.level - 1], lw=0, zorder=0, label=label)
    for curve in panel.curves:
        _plot(axes, curve, marked_points(curve, panel) if markers else None)
    axes.set(xlabel=_literal(panel.x.label), ylabel=_literal(panel.y.label), title=_literal(panel.title))
    axes.set(xscale=panel.x.scale, yscale=panel.y.scale)
    axes.set(xlim=_ends(panel.x), ylim=_ends(panel.y))
    for axis, drawn in ((panel.x, axes.xaxis), (panel.y, axes.yaxis)):
        if axis.inverted:
            drawn.set_inverted(True)
        if axis.names:
            drawn.set_ticks(range(len(axis.names)), [_literal(name) for name in axis.names])
    if panel.equal:
        axes.set_aspect("equal", adjustable="box")


def _ends(axis: PlotAxis) -> Any:
    return axis.ends or (None, None)


def _plot(axes: Axes, curve: Curve, marked: list[int] | None) -> None:
    looks = _looks(curve, marked)
    inside, outside = in_parts(curve)
    axes.plot(curve.x, inside, label=_literal(curve.label), **looks)
    if outside is not None:
        axes.plot(curve.x, outside, label="_", **{**looks, "linewidth": THIN, "alpha": PALE})
    if curve.low is None or curve.high is None:
        return
    if curve.points:
        spread = (curve.y - curve.low, curve.high - curve.y)
        axes.errorbar(curve.x, curve.y, spread, fmt="none", ecolor=looks["color"], elinewidth=1.0, capsize=2.0)
    else:
        axes.fill_between(curve.x, curve.low, curve.high, color=looks["color"], alpha=0.12, lw=0)


def _looks(curve: Curve, marked: list[int] | None) -> dict[str, Any]:
    number = curve.colour % len(PALETTE)
    looks: dict[str, Any] = {"color": PALETTE[number], "marker": MARKERS[number]}
    if curve.points:
        return {**looks, "linestyle": "", "markersize": 4, "zorder": 3}
    looks |= {"linestyle": LINES[curve.dash % len(LINES)], "markerfacecolor": "white", "markersize": 5}
    if curve.x.size == 1:
        return looks  # a single point is invisible without a marker
    every = sorted({*(marked or ()), *lone_points(curve)})
    return {**looks, "marker": ""} if marked is None and not every else {**looks, "markevery": every}


def _legend(drawn: Figure, figure: FigureData, axes: list[Axes]) -> None:
    """Add one legend for all panels, with each label once."""
    drawn_here = [artist for one in axes for artist in (*one.get_lines(), *one.patches)]
    entries: dict[str, Any] = {str(artist.get_label()): artist for artist in drawn_here}
    entries = {label: artist for label, artist in entries.items() if not label.startswith("_")}
    if shows_outside(figure):
        entries[OUTSIDE] = Line2D([], [], color="black", linewidth=THIN, alpha=PALE)
    widths = [len(name) + 8 for name in entries]  # in characters, with the line sample and the gap
    drawn.legend(
        list(entries.values()),
        list(entries),
        loc="outside lower center",
        ncols=len(entries) if sum(widths) <= LEGEND_WIDTH else max(1, LEGEND_WIDTH // max(widths)),
        title=_literal(f"bands: {figure.bands}") if has_band(figure) else None,
    )


def _literal(text: str) -> str:
    """Escape a text for matplotlib: no formula between dollar signs, no hidden legend entry."""
    shown = text.replace("$", r"\$")
    return f" {shown}" if shown.startswith("_") else shown
