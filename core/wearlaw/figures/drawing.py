"""Figures drawn with matplotlib in one style, for print.

The palette is safe for colour-blind readers (Okabe and Ito, 2008). Lines that would differ only in colour get a line
style each, for prints in grey. Only measurements have filled markers. The legend stands below the panels, where it
covers no curve.
"""

from __future__ import annotations

import textwrap
from typing import TYPE_CHECKING, Any

import matplotlib as mpl
import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LogNorm, Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

from wearlaw.figures.curves import OUTSIDE, STRIP, head_of_legend, in_parts, lone_points, shows_outside

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis

    from wearlaw.figures.curves import Curve, FigureData, Map, Panel, PlotAxis, Shade

PALETTE = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
LINES: tuple[Any, ...] = ("-", "--", ":", "-.", (0, (9, 3)), (0, (6, 1.5, 1, 1.5, 1, 1.5)), (0, (3, 3, 1, 3, 1, 3)))
"""Line styles, as many as colours: names of matplotlib, or an offset with lengths of dashes and gaps in line widths."""
MARKERS = ("s", "^", "D", "v", "P", "X", "o")
"""One for the measurements of each colour."""
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
BAR, LEAST = 0.42, 1.6
"""Height that a horizontal bar takes, and least height of a panel of bars, in inches."""
AROUND = 0.9
"""Height and width that the labels of a panel take, in inches."""
TITLE, LINE = 0.26, 0.17
"""Height of a line of the title, and of the conditions below it, in inches."""
TITLE_LETTERS, LETTERS = 72, 105
"""Letters of the title, and of the conditions, that fit across a figure."""
PANEL_LETTERS = 76
"""Letters of the title of a panel that fit across a figure."""
SHADE, STRIP_GREY = "#ececec", "#8c8c8c"
"""Greys of a shade as high as a panel, and of a strip along its x axis."""
BAND, EDGE = 0.07, 0.4
"""Opacity of a band and of its edges."""
THIN, PALE = 0.8, 0.6
"""Width in points and opacity of a line outside the range of its law."""
LEGEND_WIDTH = 100
"""Characters that fit below a figure."""
COLOURS = "viridis"
"""Colour map of maps."""
TICKS = 3
"""Fewest labelled ticks on a logarithmic axis."""


def draw(figure: FigureData) -> Figure:
    """Draw a figure: panels in rows of two, an odd first panel over a whole row."""
    count = len(figure.panels)
    cells = [*([0, 0] if count % 2 else []), *range(count % 2, count)]
    rows: Any = [cells[start : start + 2] for start in range(0, len(cells), 2)]
    heights = [max(_height(figure.panels[cell], WIDTH / len(set(row))) for cell in row) for row in rows]
    title = textwrap.wrap(figure.title, TITLE_LETTERS)
    conditions = textwrap.wrap(figure.conditions, LETTERS)
    head = TITLE * len(title) + LINE * len(conditions) + 0.08
    height = 0.9 + head + sum(heights)
    with mpl.rc_context(STYLE):
        drawn = Figure(figsize=(WIDTH, height), layout="constrained")
        engine: Any = drawn.get_layout_engine()
        engine.set(rect=(0.0, 0.0, 1.0, 1.0 - head / height))
        axes: dict[int, Axes] = drawn.subplot_mosaic(rows, height_ratios=heights)
        styles, norm = line_styles(figure), _norm(figure)
        for number, panel in enumerate(figure.panels):
            if panel.map is not None:
                _mesh(axes[number], panel.map, norm)
            across = 1 if len(set(rows[-1])) == 1 or (count % 2 and not number) else 2
            _fill(axes[number], panel, styles, PANEL_LETTERS // across)
        if norm is not None:
            bar = drawn.colorbar(
                ScalarMappable(norm, COLOURS), ax=list(axes.values()), label=_literal(_maps(figure)[0].label)
            )
            if isinstance(norm, LogNorm):
                _label_ticks(bar.ax.yaxis)
        drawn.suptitle(_literal("\n".join(title)), y=1.0 - 0.05 / height, va="top")
        below = 1.0 - (0.05 + TITLE * len(title)) / height
        drawn.text(0.5, below, _literal("\n".join(conditions)), ha="center", va="top", fontsize="small", color="0.35")
        _legend(drawn, figure, list(axes.values()))
    return drawn


def _height(panel: Panel, width: float) -> float:
    """Return the height of a panel of a width, in inches; a shape or bars take as much as they need."""
    if panel.y.names:
        return max(LEAST, AROUND + BAR * len(panel.y.names))
    if not panel.equal:
        return ROW_HEIGHT
    lengths = []
    for axis, name in ((panel.x, "x"), (panel.y, "y")):
        values = np.concatenate([np.asarray(axis.ends or getattr(curve, name), dtype=float) for curve in panel.curves])
        lengths.append(float(np.nanmax(values) - np.nanmin(values)))
    return min(AROUND + (width - AROUND) * lengths[1] / lengths[0], ROW_HEIGHT)


Styles = dict[tuple[int, int], int]


def line_styles(figure: FigureData) -> Styles:
    """Return the index in `LINES` for each colour and dash of the lines of a figure.

    It is that of the dash, unless two lines of a panel would then differ only in colour: every line then has its own.
    """
    kinds = [list(dict.fromkeys(_kind(curve) for curve in panel.curves if curve.is_line)) for panel in figure.panels]
    alike = any(len(of_panel) > len({dash for _, dash in of_panel}) for of_panel in kinds)
    every = list(dict.fromkeys(kind for of_panel in kinds for kind in of_panel))
    return {kind: number % len(LINES) if alike else kind[1] for number, kind in enumerate(every)}


def _kind(curve: Curve) -> tuple[int, int]:
    return curve.colour % len(PALETTE), curve.dash % len(LINES)


def style_of(curve: Curve, styles: Styles) -> int:
    """Return the index in `LINES` of the style of a curve, 0 for points and bars."""
    return styles.get(_kind(curve), 0)


def _fill(axes: Axes, panel: Panel, styles: Styles, letters: int) -> None:
    for shade in panel.shades:
        for number, (low, high) in enumerate(shade.spans):
            label = "_" if number else _literal(shade.label)
            axes.axvspan(low, high, 0.0, STRIP if shade.strip else 1.0, color=_grey(shade), lw=0, zorder=0, label=label)
    for curve in panel.curves:
        if curve.bars:
            _bars(axes, curve, panel)
        else:
            _plot(axes, curve, style_of(curve, styles))
    axes.set(xlabel=_literal(panel.x.label), ylabel=_literal(panel.y.label))
    axes.set_title(_literal("\n".join(textwrap.wrap(panel.title, letters))))
    axes.set(xscale=panel.x.scale, yscale=panel.y.scale)
    if panel.map is not None:
        _borders(axes, panel.map)
    axes.set(xlim=_ends(panel.x), ylim=_ends(panel.y))
    for axis, drawn in ((panel.x, axes.xaxis), (panel.y, axes.yaxis)):
        if axis.inverted:
            drawn.set_inverted(True)
        if axis.names:
            drawn.set_ticks(range(len(axis.names)), [_literal(name) for name in axis.names])
            drawn.grid(visible=False)
        elif axis.scale == "log":
            _label_ticks(drawn)
    if panel.equal:
        axes.set_aspect("equal", adjustable="box")


def _grey(shade: Shade) -> str:
    return STRIP_GREY if shade.strip else SHADE


def _ends(axis: PlotAxis) -> Any:
    return axis.ends or (None, None)


def _label_ticks(axis: Axis) -> None:
    """Label a logarithmic axis with plain numbers: at powers of ten, and between them where these are few."""
    low, high = sorted(map(float, axis.get_view_interval()))
    ticks = log_ticks(low, high)
    axis.set_major_locator(FixedLocator(ticks))
    axis.set_major_formatter(FuncFormatter(lambda value, _: plain(value)))
    if len(ticks) <= 2 * TICKS:
        axis.set_minor_locator(NullLocator())


def log_ticks(low: float, high: float) -> list[float]:
    """Return the labelled ticks of a logarithmic axis with these ends: 1, 10, 100, or 1, 2, 5, 10, or evenly spaced."""
    powers = np.arange(np.floor(np.log10(low)), np.ceil(np.log10(high)) + 1.0)
    powers = powers[:: max(1, len(powers) // 8)]
    for digits in ((1.0,), (1.0, 2.0, 5.0), (1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0)):
        found = np.ravel(np.multiply.outer(10.0**powers, digits))
        seen = found[(found >= low * (1.0 - 1e-9)) & (found <= high * (1.0 + 1e-9))]
        if seen.size >= TICKS:
            return [float(f"{tick:.6g}") for tick in seen]
    step = 10.0 ** np.floor(np.log10(high - low)) / 2.0
    return [float(f"{tick:.6g}") for tick in np.arange(np.ceil(low / step), np.floor(high / step) + 1.0) * step]


def plain(value: float) -> str:
    """Return a number as people write it: 0.02 or 6000, and a power of ten only for the smallest and the largest."""
    if value == 0.0 or 1e-4 <= abs(value) < 1e5:
        return f"{value:.6g}".replace("-", "−")
    digits, power = f"{value:.3e}".split("e")
    factor = "" if float(digits) == 1.0 else rf"{float(digits):g} \times "
    return f"${factor}10^{{{int(power)}}}$"


def _bars(axes: Axes, curve: Curve, panel: Panel) -> None:
    """Draw bars from zero along the axis without names, with their numbers at their ends."""
    colour = PALETTE[curve.colour % len(PALETTE)]
    looks: Any = {
        "color": colour,
        "zorder": 2,
        "alpha": PALE if curve.outside is not None and curve.outside.any() else 1,
    }
    ends: Any = {}
    if curve.low is not None and curve.high is not None:
        values = curve.x if panel.y.names else curve.y
        spread = np.stack([values - curve.low, curve.high - values])
        ends = {"yerr" if panel.x.names else "xerr": spread}
        ends |= {"ecolor": "0.25", "error_kw": {"elinewidth": 1.0, "capsize": 3.0}}
    if panel.y.names:
        drawn = axes.barh(curve.y, curve.x, height=curve.bars, label=_literal(curve.label), **looks, **ends)
    else:
        drawn = axes.bar(curve.x, curve.y, width=curve.bars, label=_literal(curve.label), **looks, **ends)
    axes.bar_label(drawn, bar_texts(curve, panel), padding=3, fontsize="small")
    room = 0.3 if curve.low is not None else 0.12  # for the numbers
    axes.margins(x=room if panel.y.names else None, y=None if panel.y.names else room)


def bar_texts(curve: Curve, panel: Panel) -> list[str]:
    """Return the numbers at the ends of bars, with their ranges if they have any."""

    def shown(value: float) -> str:
        return plain(float(f"{value:.3g}")) if np.isfinite(value) else ""

    values = curve.x if panel.y.names else curve.y
    if curve.low is None or curve.high is None:
        return [shown(value) for value in values]
    ranges = zip(values, curve.low, curve.high, strict=True)
    return [f"{shown(value)} ({shown(low)} to {shown(high)})" for value, low, high in ranges]


def _plot(axes: Axes, curve: Curve, style: int) -> None:
    looks = _looks(curve, style)
    inside, outside = in_parts(curve)
    axes.plot(curve.x, inside, label=_literal(curve.label), **looks)
    if outside is not None:
        axes.plot(curve.x, outside, label="_", **{**looks, "linewidth": THIN, "alpha": PALE})
    if curve.low is None or curve.high is None:
        return
    colour = looks["color"]
    if curve.points:
        spread = (curve.y - curve.low, curve.high - curve.y)
        axes.errorbar(curve.x, curve.y, spread, fmt="none", ecolor=colour, elinewidth=1.0, capsize=2.0)
    else:
        axes.fill_between(
            curve.x, curve.low, curve.high, facecolor=(colour, BAND), edgecolor=(colour, EDGE), lw=0.5, zorder=1
        )


def _looks(curve: Curve, style: int) -> dict[str, Any]:
    number = curve.colour % len(PALETTE)
    looks: dict[str, Any] = {"color": PALETTE[number]}
    if curve.points:
        looks |= {"marker": MARKERS[number], "linestyle": "", "markersize": 4, "zorder": 3}
        return {**looks, "markerfacecolor": "none"} if curve.hollow else looks
    # Sparser lines lie over denser ones, which show in their gaps.
    looks |= {"linestyle": LINES[style], "zorder": 2.0 + 0.1 * style}
    alone = lone_points(curve)
    return {**looks, "marker": ".", "markevery": alone} if alone else looks


def _borders(axes: Axes, drawn: Map) -> None:
    """Draw the borders of the regions of a map, white below black to be seen on every colour."""
    for number, region in enumerate(drawn.borders.values()):
        if region.any() and not region.all():
            for width, colour in ((2.6, "white"), (1.2, "black")):
                axes.contour(
                    drawn.x, drawn.y, region.astype(float), [0.5], colors=colour, linewidths=width,
                    linestyles=[LINES[number % len(LINES)] if colour == "black" else "-"],
                )  # fmt: skip


def _maps(figure: FigureData) -> list[Map]:
    return [panel.map for panel in figure.panels if panel.map is not None]


def map_range(figure: FigureData) -> tuple[float, float]:
    """Return the least and the largest value of the maps of a figure, which share a scale of colours."""
    values = np.concatenate([np.ravel(one.values) for one in _maps(figure)])
    seen = values[np.isfinite(values) & ((values > 0.0) | (_maps(figure)[0].scale == "linear"))]
    return (float(seen.min()), float(seen.max())) if seen.size else (0.0, 1.0)


def _norm(figure: FigureData) -> Any:
    """Return the scale of colours of the maps of a figure, None without maps."""
    if not _maps(figure):
        return None
    low, high = map_range(figure)
    return LogNorm(low, high) if _maps(figure)[0].scale == "log" and low < high else Normalize(low, high)


def _mesh(axes: Axes, drawn: Map, norm: Any) -> None:
    """Draw a map as a cell around each point, so that a jump stays one."""
    mesh = axes.pcolormesh(drawn.x, drawn.y, drawn.values, norm=norm, cmap=COLOURS, shading="nearest", zorder=0)
    mesh.set_rasterized(True)
    axes.set_axisbelow(False)
    axes.grid(visible=False)


def _legend(drawn: Figure, figure: FigureData, axes: list[Axes]) -> None:
    """Add one legend for all panels, with each label once; the names on an axis need none."""
    entries: dict[str, Any] = {}
    for one, panel in zip(axes, figure.panels, strict=True):
        named_by_axis = {_literal(curve.label) for curve in panel.curves if curve.bars and panel.y.names}
        artists: list[Any] = [*one.get_lines(), *one.patches, *one.containers]
        for artist in artists:
            label = str(artist.get_label())
            if not label.startswith("_") and label not in named_by_axis:
                entries[label] = artist
        for shade in panel.shades:
            entries[_literal(shade.label)] = Patch(facecolor=_grey(shade), edgecolor="0.6", linewidth=0.5)
        for number, (label, region) in enumerate(panel.map.borders.items() if panel.map else ()):
            if region.any() and not region.all():
                entries[label] = Line2D([], [], color="black", linewidth=1.2, linestyle=LINES[number % len(LINES)])
    every = [curve for panel in figure.panels for curve in panel.curves]
    if any(curve.bars and curve.low is not None for curve in every):
        entries[figure.bands] = Line2D([], [], color="0.25", linewidth=1.0)
    if shows_outside(figure):
        of_bars = all(curve.bars for curve in every)
        pale: Any = (
            Patch(color="black", alpha=PALE) if of_bars else Line2D([], [], color="black", linewidth=THIN, alpha=PALE)
        )
        entries[OUTSIDE] = pale
    if not entries:
        return
    widths = [len(name) + 10 for name in entries]  # in characters, with the line sample and the gap
    drawn.legend(
        list(entries.values()),
        list(entries),
        loc="outside lower center",
        handlelength=3.0,  # a whole period of every line style
        ncols=len(entries) if sum(widths) <= LEGEND_WIDTH else max(1, LEGEND_WIDTH // max(widths)),
        title=_literal(head_of_legend(figure)) or None,
    )


def _literal(text: str) -> str:
    """Escape a text for matplotlib: no formula between dollar signs, no hidden legend entry."""
    shown = text.replace("$", r"\$")
    return f" {shown}" if shown.startswith("_") else shown
