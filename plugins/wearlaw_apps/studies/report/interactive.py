"""Interactive figures: a `FigureData` as plotly.js takes it, in the colours, line styles and markers of print."""

from __future__ import annotations

import html
from typing import Any

import numpy as np

from wearlaw_apps.output.curves import (
    BLACK,
    OUTSIDE,
    STRIP,
    Curve,
    FigureData,
    Limit,
    Map,
    Panel,
    PlotAxis,
    Shade,
    borders_of,
    head_of_legend,
    in_parts,
    map_range,
    marked_points,
    shows_outside,
)
from wearlaw_apps.output.drawing import ROW_HEIGHT as PRINTED
from wearlaw_apps.output.drawing import line_styles, log_ticks, panel_height, plain
from wearlaw_apps.output.style import (
    BAND,
    COLOURS,
    COLUMN,
    EDGE,
    LIMIT_LINE,
    LINES,
    MARKERS,
    OUTSIDE_LINE,
    PAGE,
    PALETTE,
    THIN,
)

DASHES = {"-": "solid", "--": "dash", ":": "dot", "-.": "dashdot"}
SYMBOLS = dict(
    zip("os^DvPX", ("circle", "square", "triangle-up", "diamond", "triangle-down", "cross", "x"), strict=True)
)
GAP = 0.14
"""Between two panels, as a share of the figure, and less between many."""
ROW_HEIGHT = 380
"""Of a row of panels, in pixels."""
GREY = "rgb(128, 128, 128)"
LOG_TICKS = 5
"""Most ticks that a logarithmic axis aims at; with more, all digits from 1 to 9 have one."""
LONG = 30
"""Letters of a label beyond which the legend stands below the panels."""

Json = dict[str, Any]
Ends = tuple[float, float]


def plotly_figure(figure: FigureData) -> Json:
    """Return the traces and the layout of a figure, as plotly.js takes them.

    A click on a legend entry switches all curves of that label, in all panels, with their bands. Colours of text, grid
    and background are left to the page.
    """
    # plotly.js numbers axes from the second one on: x, x2, x3.
    numbered = list(zip(["", *map(str, range(2, len(figure.panels) + 1))], figure.panels, strict=True))
    styles = line_styles(figure)
    data = [trace for number, panel in numbered if panel.map for trace in _map(panel.map, number, map_range(figure))]
    for number, panel in numbered:
        for curve in panel.curves:
            data += _traces(curve, panel, number, styles.get((curve.colour, curve.dash), 0))
    data += _explained(figure)
    listed: set[str] = set()
    for trace in data:
        if trace["showlegend"]:
            trace["showlegend"] = trace["legendgroup"] not in listed
            listed.add(trace["legendgroup"])
    rows = (len(numbered) + 1) // 2
    width = COLUMN if len(numbered) == 1 else PAGE / 2
    tall = max(panel_height(panel, width) for panel in figure.panels) / PRINTED
    longest = max((len(curve.label) for panel in figure.panels for curve in panel.curves), default=0)
    beside = len(numbered) == 1 and longest <= LONG and figure.panels[0].map is None  # no bar of colours is there
    below = {} if beside else {"orientation": "h", "y": -0.24 / rows / tall}
    head = head_of_legend(figure)
    layout: Json = {
        "height": round(ROW_HEIGHT * tall) * rows + 100,
        "hovermode": "closest",
        "uirevision": figure.name,  # keeps zoom and what is switched off when the colours change
        "margin": {"l": 70, "r": 20, "t": 40, "b": 60},
        "legend": {
            "tracegroupgap": 0,
            **below,
            **({"title": {"text": literal(head), "font": {"size": 12}}} if head else {}),
        },
        "annotations": [note for number, panel in numbered for note in _notes(panel, number)],
        "shapes": [shape for number, panel in numbered for shape in _shapes(panel, number)],
    }
    for (number, panel), (across, up) in zip(numbered, _places(len(numbered)), strict=True):
        layout[f"xaxis{number}"] = {**_axis(panel.x), "domain": across, "anchor": f"y{number}"}
        layout[f"yaxis{number}"] = {**_axis(panel.y), "domain": up, "anchor": f"x{number}"}
        if panel.equal:
            layout[f"xaxis{number}"] |= {"constrain": "domain"}
            layout[f"yaxis{number}"] |= {"constrain": "domain", "scaleanchor": f"x{number}"}
    return {"data": data, "layout": layout}


def _shapes(panel: Panel, number: str) -> list[Json]:
    """Return the shades of a panel as rectangles below its curves, and the lines of its limits.

    plotly.js takes the ends of a shape on a logarithmic axis as they are, unlike the ends of the axis.
    """
    common = {"type": "rect", "xref": f"x{number}", "yref": f"y{number} domain", "y0": 0, "layer": "below"}
    shades = [
        {**common, "y1": STRIP if shade.strip else 1, "x0": low, "x1": high, "fillcolor": _grey(shade),
         "line": {"width": 0}}
        for shade in panel.shades
        for low, high in shade.spans
    ]  # fmt: skip
    line = {"type": "line", "line": {"color": GREY, "width": 1.5 * THIN, "dash": _dash(LIMIT_LINE)}}
    for limit in panel.limits:
        other = "y" if limit.axis == "x" else "x"
        refs = {f"{limit.axis}ref": f"{limit.axis}{number}", f"{other}ref": f"{other}{number} domain"}
        ends = {f"{limit.axis}0": limit.at, f"{limit.axis}1": limit.at, f"{other}0": 0, f"{other}1": 1}
        shades.append({**line, **refs, **ends})
    return shades


def _grey(shade: Shade) -> str:
    """Return a translucent grey, for pages on bright and on dark ground."""
    return f"rgba(128, 128, 128, {0.9 if shade.strip else 0.26:g})"


def _explained(figure: FigureData) -> list[Json]:
    """Return traces without points that explain shades and dashed lines in the legend."""
    edge = {"color": GREY, "width": 0.5}  # the lightest grey would not be seen without
    looks: dict[str, Json] = {
        shade.label: {
            "mode": "markers",
            "marker": {"symbol": "square", "size": 12, "color": _grey(shade), "line": edge},
        }
        for panel in figure.panels
        for shade in panel.shades
    }
    if shows_outside(figure):
        looks[OUTSIDE] = {"mode": "lines", "line": {"color": GREY, "dash": _dash(OUTSIDE_LINE), "width": 2}}
    nowhere = {"type": "scatter", "x": [None], "y": [None], "hoverinfo": "skip", "showlegend": True}
    return [{**nowhere, "name": literal(label), "legendgroup": literal(label), **look} for label, look in looks.items()]


def literal(text: str) -> str:
    """Escape a text, so that plotly.js shows tags, entities and templates literally.

    Dollar signs need no escape: the page has no MathJax.
    """
    return html.escape(text, quote=False).replace("%", "&#37;")


def _traces(curve: Curve, panel: Panel, number: str, style: int) -> list[Json]:
    """Return the traces of a curve: its band, if any, and the line."""
    place = curve.colour % len(PALETTE)
    colour, marked = PALETTE[place], [] if curve.points else marked_points(curve, style, panel)
    common: Json = {
        "type": "scatter",
        "name": literal(curve.label),
        "legendgroup": literal(curve.label),
        "xaxis": f"x{number}",
        "yaxis": f"y{number}",
    }
    marker: Json = {"color": colour, "symbol": SYMBOLS[MARKERS[style]], "size": 6}
    if curve.points:
        symbol = SYMBOLS[MARKERS[(place + 1) % len(MARKERS)]]
        marker |= {"symbol": symbol + ("-open" if curve.hollow else ""), "size": 7}
    inside, outside = in_parts(curve)
    line: Json = {
        **common,
        "x": _numbers(curve.x),
        "y": _numbers(inside),
        "mode": "markers" if curve.points else "lines+markers" if marked else "lines",
        "line": {"color": colour, "dash": _dash(LINES[style if curve.outside is None else 0]), "width": 2},
        "marker": marker,
        "hovertemplate": _hover(curve, panel),
        "showlegend": curve.label != "",
    }
    if 0 < len(marked) < np.isfinite(curve.y).sum():
        line |= {"selectedpoints": marked, "unselected": {"marker": {"opacity": 0}}}
    lines = [line]
    if outside is not None:
        dashed = {"line": {**line["line"], "dash": _dash(OUTSIDE_LINE)}, "showlegend": curve.label != ""}
        beyond = {**line, "y": _numbers(outside), **dashed}
        lines = [line, {**beyond, "showlegend": False}] if np.isfinite(inside).any() else [beyond]
    if curve.low is None or curve.high is None:
        return lines
    band = [list(ends) for ends in zip(_numbers(curve.low), _numbers(curve.high), strict=True)]
    lines = [{**trace, "customdata": band} for trace in lines]
    if not curve.points:
        return [{**common, **_band(curve, panel, colour), "showlegend": False}, *lines]
    ends = {"array": _numbers(curve.high - curve.y), "arrayminus": _numbers(curve.y - curve.low)}
    error_bars = {"type": "data", "symmetric": False, **ends, "color": colour, "thickness": 1.2}
    return [{**line, "customdata": band, "error_y": error_bars}]


def _dash(pattern: Any) -> str:
    """Return a line style as plotly.js names it, or its lengths in pixels on a line of two."""
    return DASHES[pattern] if isinstance(pattern, str) else ",".join(f"{2 * length:g}px" for length in pattern[1])


def _map(shown: Map, number: str, ends: Ends) -> list[Json]:
    """Return the trace of a map and those of the borders of its regions.

    Colours have no logarithmic scale in plotly.js, so they stand for logarithms, and the bar has values at its ticks.
    """
    values = np.asarray(shown.values, dtype=float)
    (low, high), value = ends, "z"
    bar: Json = {"title": {"text": literal(shown.label), "side": "right"}}
    heat: Json = {"z": [_numbers(row) for row in values]}
    if shown.scale == "log":
        logarithms = np.log10(values, where=values > 0.0, out=np.full(values.shape, np.nan))
        heat, value = {"z": [_numbers(row) for row in logarithms], "customdata": heat["z"]}, "customdata"
        ticks = log_ticks(low, high) if low < high else []
        bar |= {"tickvals": _numbers(np.log10(ticks)), "ticktext": [plain(tick) for tick in ticks]} if ticks else {}
        low, high = np.log10(ends)
    axes: Json = {"xaxis": f"x{number}", "yaxis": f"y{number}", "x": _numbers(shown.x), "y": _numbers(shown.y)}
    heat |= {
        **axes,
        "type": "heatmap",
        "name": literal(shown.label),
        "legendgroup": literal(shown.label),
        "zmin": float(low),
        "zmax": float(high),
        "colorscale": COLOURS.capitalize(),
        "colorbar": bar,
        "showscale": not number,
        "hovertemplate": f"%{{x:.4~g}}, %{{y:.4~g}}: %{{{value}:.4~g}}<extra>{literal(shown.label)}</extra>",
        "showlegend": False,
    }
    borders = [
        {
            **axes,
            "type": "contour",
            "name": literal(label),
            "legendgroup": literal(label),
            "z": [_numbers(row) for row in region.astype(float)],
            "contours": {"start": 0.5, "end": 0.5, "size": 1.0, "coloring": "none"},
            "line": {"color": PALETTE[BLACK], "width": 2, "dash": _dash(LINES[place])},
            "hoverinfo": "skip",
            "showscale": False,
            "showlegend": True,
        }
        for label, (place, region) in borders_of(shown).items()
    ]
    return [heat, *borders]


def _hover(curve: Curve, panel: Panel) -> str:
    lines = [f"<b>{literal(curve.label)}</b>"] if curve.label else []
    for axis, value in ((panel.x, "x"), (panel.y, "y")):
        lines.append(f"{literal(axis.label)}: %{{{value}:.4~g}}")
    if curve.low is not None:
        lines.append("from %{customdata[0]:.4~g} to %{customdata[1]:.4~g}")
    return "<br>".join(lines) + "<extra></extra>"


def _band(curve: Curve, panel: Panel, colour: str) -> Json:
    """Return the closed outline of a band, without points that its axes cannot show."""
    x, low, high = (np.asarray(values, dtype=float) for values in (curve.x, curve.low, curve.high))
    seen = np.isfinite(x) & np.isfinite(low) & np.isfinite(high)
    for values, axis in ((x, panel.x), (low, panel.y), (high, panel.y)):
        seen &= (values > 0) | (axis.scale == "linear")
    edge, face = (f"{colour}{round(255 * opacity):02x}" for opacity in (EDGE, BAND))
    return {
        "x": _numbers(np.concatenate([x[seen], x[seen][::-1]])),
        "y": _numbers(np.concatenate([low[seen], high[seen][::-1]])),
        "mode": "lines",
        "line": {"width": 0.5, "color": edge},
        "fill": "toself",
        "fillcolor": face,
        "hoverinfo": "skip",
    }


def _axis(axis: PlotAxis) -> Json:
    described: Json = {
        "title": {"text": literal(axis.label), "standoff": 8},
        "type": axis.scale,
        "exponentformat": "power",
        "minexponent": 5,
        "automargin": True,
        "ticks": "outside",
        "showline": True,
        "zeroline": False,
        **({"nticks": LOG_TICKS, "tickformat": "~g"} if axis.scale == "log" else {}),
    }
    if axis.ends is not None:
        ends = [float(end) for end in (np.log10(axis.ends) if axis.scale == "log" else axis.ends)]
        described["range"] = ends[::-1] if axis.inverted else ends
    elif axis.inverted:
        described["autorange"] = "reversed"
    return described


def _notes(panel: Panel, number: str) -> list[Json]:
    """Return the title of a panel, and the names of its limits."""
    place = {"xref": f"x{number} domain", "yref": f"y{number} domain", "showarrow": False}
    title = {**place, "x": 0.5, "y": 1.0, "yanchor": "bottom", "yshift": 5, "text": literal(panel.title)}
    return [*([title] if panel.title else []), *(_named(limit, panel, place, number) for limit in panel.limits)]


def _named(limit: Limit, panel: Panel, place: Json, number: str) -> Json:
    """Return the name of a limit at the end of its line."""
    axis = panel.x if limit.axis == "x" else panel.y
    at = float(np.log10(limit.at)) if axis.scale == "log" else limit.at
    here = {f"{limit.axis}ref": f"{limit.axis}{number}", "text": literal(limit.label), "font": {"size": 11}}
    turned = {"x": at, "y": 1.0, "textangle": -90, "xanchor": "right", "yanchor": "top"}
    level = {"x": 1.0, "y": at, "xanchor": "right", "yanchor": "bottom"}
    return {**place, **here, **(turned if limit.axis == "x" else level)}


def _places(count: int) -> list[tuple[Ends, Ends]]:
    """Return the horizontal and vertical span of each panel: rows of two, an odd first panel over a whole row."""
    rows = [1] * (count % 2) + [2] * (count // 2)
    ups = reversed(_spans(len(rows)))
    return [(across, up) for in_row, up in zip(rows, ups, strict=True) for across in _spans(in_row)]


def _spans(count: int) -> list[Ends]:
    """Return the ends of equal spans, as shares of the figure, with gaps between them."""
    gap = min(GAP, 0.32 / count)
    size = (1.0 - gap * (count - 1)) / count
    return [(number * (size + gap), min(number * (size + gap) + size, 1.0)) for number in range(count)]


def _numbers(values: Any) -> list[float | None]:
    """Return numbers for JSON with seven digits: no screen shows more, and the page is half as long."""
    return [float(f"{value:.7g}") if np.isfinite(value) else None for value in np.asarray(values, dtype=float)]
