"""Figures drawn with matplotlib in the style of `wearlaw.mplstyle`, for print.

Lines of laws are solid, and dashed outside the range of their law; markers tell them apart in prints without colours.
Other lines that would differ only in colour get a line style each. The legend stands below the panels, or each below
its panel, where it covers no curve.
"""

from __future__ import annotations

import dataclasses
import textwrap
from typing import TYPE_CHECKING, Any

import matplotlib as mpl
import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LogNorm, Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.textpath import TextPath
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator
from matplotlib.transforms import ScaledTranslation

from wearlaw_apps.output.curves import (
    OUTSIDE,
    STRIP,
    FigureData,
    borders_of,
    head_of_legend,
    in_parts,
    map_range,
    marked_points,
    shows_outside,
)
from wearlaw_apps.output.labels import raised
from wearlaw_apps.output.style import (
    BAND,
    COLOURS,
    COLUMN,
    EDGE,
    LIMIT_GREY,
    LIMIT_LINE,
    LINES,
    MARKERS,
    OUTSIDE_LINE,
    PAGE,
    PALETTE,
    SHADE,
    STRIP_GREY,
    STYLE,
    THIN,
)

if TYPE_CHECKING:
    from collections.abc import Mapping

    from matplotlib.axes import Axes
    from matplotlib.axis import Axis

    from wearlaw_apps.output.curves import Curve, Limit, Map, Panel, Shade

ROW_HEIGHT = 2.2
"""Height of a row of panels, in inches."""
AROUND = 0.6
"""Height and width that the labels of a panel take, in inches."""
TITLE, LINE = 0.17, 0.13
"""Height of a line of the title, and of the conditions below it, in inches."""
TITLE_LETTERS, LETTERS = 12, 20
"""Letters of the title of a figure, and of smaller texts, that fit in an inch."""
SAMPLE, FRAME = 0.47, 0.1
"""Widths of the sample of a line with its spaces, and of the margins of a legend, in inches."""
BELOW = 0.36
"""Distance of the legend of a panel below its axes, in inches."""
TICKS = 3
"""Fewest labelled ticks on a logarithmic axis."""


def draw(figure: FigureData, managed: bool = False) -> Figure:
    """Draw a figure as wide as a column, or as a page: panels in rows of two, an odd first panel over a whole row.

    A `managed` one is of `matplotlib.pyplot`, which shows it.
    """
    count = len(figure.panels)
    width = COLUMN if count == 1 else PAGE
    cells = [*([0, 0] if count % 2 else []), *range(count % 2, count)]
    rows: Any = [cells[start : start + 2] for start in range(0, len(cells), 2)]
    widths = {cell: width / len(set(row)) for row in rows for cell in row}
    heights: list[float] = [max(panel_height(figure.panels[cell], widths[cell]) for cell in row) for row in rows]
    title = textwrap.wrap(figure.title, round(TITLE_LETTERS * width))
    conditions, heading = (
        textwrap.wrap(text, round(LETTERS * width)) for text in (figure.conditions, head_of_legend(figure))
    )
    with mpl.rc_context(STYLE):
        if managed:
            from matplotlib import pyplot  # loads a backend

            drawn = pyplot.figure(layout="constrained")
        else:
            drawn = Figure(layout="constrained")
        axes: dict[int, Axes] = drawn.subplot_mosaic(rows, height_ratios=heights)
        entries = _fill(figure, list(axes.values()), [round(LETTERS * 0.9 * widths[number]) for number in axes])
        look: Any = {"handlelength": 2.8, "columnspacing": 1.2}  # a whole period of every line style
        if figure.legends:
            lines = {cell: _own_legend(axes[cell], figure.panels[cell], widths[cell], look) for cell in axes}
            heights = [tall + LINE * max(lines[cell] for cell in row) for tall, row in zip(heights, rows, strict=True)]
            entries = {}
        columns = _columns(entries, width)
        head = TITLE * len(title) + LINE * len(conditions) + 0.06
        height = head + sum(heights) + LINE * (len(heading) - (-len(entries) // columns)) + 0.1
        drawn.set_size_inches(width, height)
        engine: Any = drawn.get_layout_engine()
        engine.set(rect=(0.0, 0.0, 1.0, 1.0 - head / height))
        drawn.suptitle(_literal("\n".join(title)), y=1.0 - 0.04 / height, va="top")
        below = 1.0 - (0.04 + TITLE * len(title)) / height
        drawn.text(0.5, below, _literal("\n".join(conditions)), ha="center", va="top", fontsize="small", color="0.35")
        if entries or heading:
            below_heading = _literal("\n".join(heading)) or None
            drawn.legend(
                list(entries.values()), list(entries), loc="outside lower center", ncols=columns, title=below_heading,
                **look,
            )  # fmt: skip
    return drawn


def _columns(entries: Mapping[str, Any], width: float) -> int:
    """Return the columns of a legend that fit in a width, in inches."""
    size, room = STYLE["legend.fontsize"], width - FRAME
    widths = [TextPath((0.0, 0.0), name, size=size).get_extents().width / 72.0 + SAMPLE for name in entries] or [room]
    return len(widths) if sum(widths) <= room else max(1, int(room // max(widths)))


def _own_legend(axes: Axes, panel: Panel, width: float, look: dict[str, Any]) -> int:
    """Draw the legend of a panel below it, and return how many lines it takes."""
    entries = _entries(FigureData("", "", (panel,)), [axes])
    columns = _columns(entries, width)
    below = axes.transAxes + ScaledTranslation(0.0, -BELOW, axes.figure.dpi_scale_trans)
    axes.legend(list(entries.values()), list(entries), loc="upper center", bbox_to_anchor=(0.5, 0.0),
                bbox_transform=below, borderaxespad=0.0, ncols=columns, **look)  # fmt: skip
    return -(-len(entries) // columns)


def draw_into(axes: list[Axes], figure: FigureData) -> None:
    """Draw the panels of a figure into axes, in the style in force."""
    for drawn_axes, panel in zip(axes, figure.panels, strict=True):
        entries = _fill(dataclasses.replace(figure, panels=(panel,)), [drawn_axes], [round(LETTERS * COLUMN)])
        if entries:
            framed = panel.map is not None
            drawn_axes.legend(list(entries.values()), list(entries), frameon=framed)


def panel_height(panel: Panel, width: float) -> float:
    """Return the height of a panel of a width, in inches; a shape takes as much as it needs."""
    if not panel.equal or not panel.curves:
        return ROW_HEIGHT
    across, up = (
        np.ptp(axis.ends or np.concatenate([values[np.isfinite(values)] for values in every]))
        for axis, every in (
            (panel.x, [curve.x for curve in panel.curves]),
            (panel.y, [curve.y for curve in panel.curves]),
        )
    )
    return float(min(AROUND + (width - AROUND) * up / across, ROW_HEIGHT))


def line_styles(figure: FigureData) -> dict[tuple[int, int], int]:
    """Return the index in `LINES` and `MARKERS` for each colour and dash of the lines of a figure.

    It is that of the dash, unless two lines of a panel would then differ only in colour: every line then has its own.
    """
    kinds = [
        list(dict.fromkeys((curve.colour, curve.dash) for curve in panel.curves if not curve.points))
        for panel in figure.panels
    ]
    alike = any(len(of_panel) > len({dash for _, dash in of_panel}) for of_panel in kinds)
    several = dict.fromkeys(kind for of_panel in kinds if len(of_panel) > 1 for kind in of_panel)
    numbers = {kind: number for number, kind in enumerate(several)} if alike else {}
    return {kind: numbers.get(kind, kind[1]) % len(LINES) for of_panel in kinds for kind in of_panel}


def _fill(figure: FigureData, axes: list[Axes], letters: list[int]) -> dict[str, Any]:
    """Draw panels into axes, maps with a bar of their colours, and return the entries of the legend."""
    styles, maps = line_styles(figure), [panel.map for panel in figure.panels if panel.map is not None]
    norm: Any = None
    if maps:
        low, high = map_range(figure)
        norm = LogNorm(low, high) if maps[0].scale == "log" and low < high else Normalize(low, high)
    for drawn_axes, panel, room in zip(axes, figure.panels, letters, strict=True):
        _fill_panel(drawn_axes, panel, styles, norm, room)
    if maps:
        drawn: Any = axes[0].get_figure(root=True)
        bar = drawn.colorbar(ScalarMappable(norm, COLOURS), ax=axes, label=_literal(maps[0].label))
        if isinstance(norm, LogNorm):
            _label_ticks(bar.ax.yaxis)
    return _entries(figure, axes)


def _fill_panel(axes: Axes, panel: Panel, styles: dict[tuple[int, int], int], norm: Any, letters: int) -> None:
    if panel.map is not None:
        _draw_map(axes, panel.map, norm)
    for shade in panel.shades:
        for low, high in shade.spans:
            axes.axvspan(low, high, 0.0, STRIP if shade.strip else 1.0, color=_grey(shade), lw=0, zorder=0)
    for curve in panel.curves:
        plot_curve(axes, curve, styles.get((curve.colour, curve.dash), 0), panel)
    axes.set_title(_literal("\n".join(textwrap.wrap(panel.title, letters))))
    axes.set(xlabel=_literal(panel.x.label), ylabel=_literal(panel.y.label))
    axes.set(xscale=panel.x.scale, yscale=panel.y.scale)
    axes.set(xlim=panel.x.ends or (None, None), ylim=panel.y.ends or (None, None))
    for axis, drawn in ((panel.x, axes.xaxis), (panel.y, axes.yaxis)):
        if axis.inverted:
            drawn.set_inverted(True)
        if axis.scale == "log":
            _label_ticks(drawn)
    for limit in panel.limits:
        if (panel.y if limit.axis == "y" else panel.x).ends is None:
            axes.autoscale(axis=limit.axis)  # a name far outside of the axes leaves no room for them
        _draw_limit(axes, limit)
    if panel.equal:
        axes.set_aspect("equal", adjustable="box")


def _draw_limit(axes: Axes, limit: Limit) -> None:
    """Draw a limit across a panel, with its name at the end of the line."""
    look: Any = {"color": LIMIT_GREY, "lw": THIN, "ls": LIMIT_LINE, "zorder": 1.5}
    words: Any = {"color": LIMIT_GREY, "fontsize": 6.5, "ha": "right", "textcoords": "offset points"}
    if limit.axis == "y":
        axes.axhline(limit.at, **look)
        place = axes.get_yaxis_transform()
        axes.annotate(_literal(limit.label), (1.0, limit.at), (0.0, 1.5), xycoords=place, va="bottom", **words)
    else:
        axes.axvline(limit.at, **look)
        place = axes.get_xaxis_transform()
        axes.annotate(
            _literal(limit.label), (limit.at, 1.0), (-1.5, -1.0), xycoords=place, va="top", rotation=90.0, **words
        )


def _grey(shade: Shade) -> str:
    return STRIP_GREY if shade.strip else SHADE


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
        ticks = np.ravel(np.multiply.outer(10.0**powers, digits))
        seen = ticks[(ticks >= low * (1.0 - 1e-9)) & (ticks <= high * (1.0 + 1e-9))]
        if seen.size >= TICKS:
            return [float(f"{tick:.6g}") for tick in seen]
    step = 10.0 ** np.floor(np.log10(high - low)) / 2.0
    return [float(f"{tick:.6g}") for tick in np.arange(np.ceil(low / step), np.floor(high / step) + 1.0) * step]


def plain(value: float) -> str:
    """Return a number as people write it: 0.02 or 6000, and a power of ten only for the smallest and the largest."""
    if value == 0.0 or 1e-4 <= abs(value) < 1e5:
        return f"{value:.6g}".replace("-", "−")
    digits, power = f"{value:.3e}".split("e")
    return f"{'' if float(digits) == 1.0 else f'{float(digits):g} × '}10{raised(int(power))}"


def plot_curve(axes: Axes, curve: Curve, style: int = 0, panel: Panel | None = None) -> None:
    """Draw a curve with its band, or points with their error bars, in a panel or on linear axes."""
    number = curve.colour % len(PALETTE)
    colour, marked = PALETTE[number], marked_points(curve, style, panel)
    looks: dict[str, Any] = {"color": colour, "linestyle": LINES[style if curve.outside is None else 0],
                             "marker": MARKERS[style] if marked else "", "markevery": marked,
                             "zorder": 2.0 + 0.1 * style}  # fmt: skip
    if curve.points:
        looks = {"color": colour, "marker": MARKERS[(number + 1) % len(MARKERS)], "linestyle": "", "zorder": 3,
                 "markerfacecolor": "none" if curve.hollow else colour}  # fmt: skip
    inside, outside = in_parts(curve)
    name = _literal(curve.label)
    if outside is not None:
        (dashed,) = axes.plot(curve.x, outside, **{**looks, "linestyle": OUTSIDE_LINE})
        dashed.set_label("_" if np.isfinite(inside).any() else name)
    if outside is None or np.isfinite(inside).any():
        axes.plot(curve.x, inside, label=name, **looks)
    if curve.low is None or curve.high is None:
        return
    if curve.points:
        bars = curve.y - curve.low, curve.high - curve.y
        axes.errorbar(curve.x, curve.y, bars, fmt="none", ecolor=colour, elinewidth=0.8, capsize=1.5)
    else:
        axes.fill_between(
            curve.x, curve.low, curve.high, facecolor=(colour, BAND), edgecolor=(colour, EDGE), lw=0.5, zorder=1
        )


def _draw_map(axes: Axes, drawn: Map, norm: Any) -> None:
    """Draw a map as a cell around each point, so that a jump stays one, with borders, white below black.

    What lies outside the range of a law is hatched.
    """
    mesh = axes.pcolormesh(drawn.x, drawn.y, drawn.values, norm=norm, cmap=COLOURS, shading="nearest", zorder=0)
    mesh.set_rasterized(True)
    axes.set_axisbelow(False)
    axes.grid(visible=False)
    for name, (number, region) in borders_of(drawn).items():
        if name == OUTSIDE:  # whose side a border alone would not tell
            hatched = axes.contourf(drawn.x, drawn.y, region.astype(float), [0.5, 1.5], colors="none", hatches=["///"])
            hatched.set(edgecolor="white", linewidth=0.0)
        for width, colour, line in ((2.2, "white", "-"), (1.0, "black", LINES[number])):
            axes.contour(
                drawn.x, drawn.y, region.astype(float), [0.5], colors=colour, linewidths=width, linestyles=[line]
            )


def _entries(figure: FigureData, axes: list[Axes]) -> dict[str, Any]:
    """Return what the legend of all panels shows, by its label."""
    entries: dict[str, Any] = {}
    for drawn_axes, panel in zip(axes, figure.panels, strict=True):
        labelled = ((artist, str(artist.get_label())) for artist in drawn_axes.get_lines())
        entries |= {label: artist for artist, label in labelled if label and not label.startswith("_")}
        for shade in panel.shades:
            entries[_literal(shade.label)] = Patch(facecolor=_grey(shade), edgecolor="0.6", linewidth=0.5)
        for label, (number, _) in borders_of(panel.map).items():
            entries[label] = Line2D([], [], color="black", linewidth=1.2, linestyle=LINES[number])
    if shows_outside(figure):
        entries[OUTSIDE] = Line2D([], [], color="black", linestyle=OUTSIDE_LINE)
    return entries


def _literal(text: str) -> str:
    """Escape a text for matplotlib: no formula between dollar signs, no hidden legend entry."""
    shown = text.replace("$", r"\$")
    return f" {shown}" if shown.startswith("_") else shown
