"""Interactive figures: a `FigureData` as plotly.js takes it.

Colours, line styles and markers match the figures drawn by matplotlib.
"""

from __future__ import annotations

import html
from typing import Any

import numpy as np

from wearlaw.arrays.array import Array
from wearlaw.figures.curves import (
    OUTSIDE,
    STRIP,
    Curve,
    FigureData,
    Map,
    Panel,
    PlotAxis,
    Shade,
    head_of_legend,
    in_parts,
    lone_points,
    shows_outside,
)
from wearlaw.figures.drawing import (
    BAND,
    COLOURS,
    EDGE,
    LINES,
    MARKERS,
    PALE,
    PALETTE,
    THIN,
    bar_texts,
    line_styles,
    log_ticks,
    map_range,
    style_of,
)

DASHES = {"-": "solid", "--": "dash", ":": "dot", "-.": "dashdot"}
SYMBOLS = dict(
    zip("s^DvPXo", ("square", "triangle-up", "diamond", "triangle-down", "cross", "x", "circle"), strict=True)
)
GAP = 0.14
"""Between two panels, as a share of the figure."""
ROW_HEIGHT = 380
"""Of a row of panels, in pixels."""

EDGED = {"color": "rgb(128, 128, 128)", "width": 0.5}
"""Edge of a shade in the legend: the lightest grey would not be seen without."""

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
    data += [
        trace
        for number, panel in numbered
        for curve in panel.curves
        for trace in (
            [_bar(curve, panel, number)] if curve.bars else _traces(curve, panel, number, style_of(curve, styles))
        )
    ]
    data += _explained(figure)
    listed: set[str] = set()
    for trace in data:
        if trace["showlegend"]:
            trace["showlegend"] = trace["legendgroup"] not in listed
            listed.add(trace["legendgroup"])
    rows = (len(numbered) + 1) // 2
    longest = max((len(curve.label) for panel in figure.panels for curve in panel.curves), default=0)
    below = {"orientation": "h", "y": -0.2 / rows} if len(numbered) > 1 or longest > LONG else {}
    layout: Json = {
        "height": ROW_HEIGHT * rows + 100,
        "hovermode": "closest",
        "uirevision": figure.name,  # keeps zoom and what is switched off when the colours change
        "margin": {"l": 70, "r": 20, "t": 40, "b": 60},
        "legend": {"tracegroupgap": 0, **below, **_head(figure)},
        "annotations": [_heading(panel, number) for number, panel in numbered if panel.title],
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
    """Return the shades of a panel as rectangles below its curves.

    plotly.js takes the ends of a rectangle on a logarithmic axis as they are, unlike the ends of the axis.
    """
    place = {"xref": f"x{number}", "yref": f"y{number} domain", "y0": 0, "layer": "below"}
    look = {"type": "rect", "line": {"width": 0}}
    return [
        {**look, **place, "y1": STRIP if shade.strip else 1, "fillcolor": _grey(shade), "x0": low, "x1": high}
        for shade in panel.shades
        for low, high in shade.spans
    ]


def _grey(shade: Shade) -> str:
    """Return a translucent grey, for pages on bright and on dark ground."""
    return f"rgba(128, 128, 128, {0.9 if shade.strip else 0.26:g})"


def _explained(figure: FigureData) -> list[Json]:
    """Return traces without points that explain shades and thin lines in the legend."""
    shades = {shade.label: shade for panel in figure.panels for shade in panel.shades}
    looks: dict[str, Json] = {
        label: {"mode": "markers", "marker": {"symbol": "square", "size": 12, "color": _grey(shade), "line": EDGED}}
        for label, shade in shades.items()
    }
    if shows_outside(figure):
        looks[OUTSIDE] = {"mode": "lines", "line": {"color": "rgb(128, 128, 128)", "width": THIN}}
    nowhere = {"type": "scatter", "x": [None], "y": [None], "hoverinfo": "skip", "showlegend": True}
    return [{**nowhere, "name": literal(label), "legendgroup": literal(label), **look} for label, look in looks.items()]


def _head(figure: FigureData) -> Json:
    """Return the title of the legend, if there is anything to explain."""
    head = head_of_legend(figure)
    return {"title": {"text": literal(head)}} if head else {}


def literal(text: str) -> str:
    """Escape a text, so that plotly.js shows tags, entities and templates literally.

    Dollar signs need no escape: the page has no MathJax.
    """
    return html.escape(text, quote=False).replace("%", "&#37;")


def _traces(curve: Curve, panel: Panel, number: str, line_style: int) -> list[Json]:
    """Return the traces of a curve: its band, if any, and the line."""
    colour = PALETTE[curve.colour % len(PALETTE)]
    common: Json = {
        "type": "scatter",
        "name": literal(curve.label),
        "legendgroup": literal(curve.label),
        "xaxis": f"x{number}",
        "yaxis": f"y{number}",
    }
    lone = lone_points(curve)
    some = 0 < len(lone) < np.isfinite(curve.y).sum()
    inside, outside = in_parts(curve)
    style: Json = {"color": colour, "dash": _dash(line_style), "width": 2}
    line = {
        **common,
        **({"selectedpoints": lone, "unselected": {"marker": {"opacity": 0}}} if some and not curve.points else {}),
        "x": _numbers(curve.x),
        "y": _numbers(inside),
        "mode": "markers" if curve.points else "lines+markers" if lone else "lines",
        "line": style,
        "marker": _marker(curve, colour),
        "hovertemplate": _hover(curve, panel),
        **_texts(curve, panel),
        "showlegend": True,
    }
    lines = [line]
    if outside is not None:
        thin = {"line": {**style, "width": THIN}, "opacity": PALE, "showlegend": False}
        lines.append({**line, "y": _numbers(outside), **thin})
    if curve.low is None or curve.high is None:
        return lines
    line["customdata"] = [list(ends) for ends in zip(_numbers(curve.low), _numbers(curve.high), strict=True)]
    if curve.points:
        return [{**line, "error_y": _bars(curve.y, curve.low, curve.high, colour)}]
    return [{**common, **_band(curve, panel, colour), "showlegend": False}, *lines]


def _dash(style: int) -> str:
    """Return a line style as plotly.js names it, or its lengths in pixels on a line of two."""
    pattern = LINES[style]
    return DASHES[pattern] if isinstance(pattern, str) else ",".join(f"{2 * length:g}px" for length in pattern[1])


def _bar(curve: Curve, panel: Panel, number: str) -> Json:
    """Return the trace of bars, with their numbers at their ends."""
    colour, flat = PALETTE[curve.colour % len(PALETTE)], bool(panel.y.names)
    values = curve.x if flat else curve.y
    bar: Json = {
        "type": "bar",
        "name": literal(curve.label),
        "legendgroup": literal(curve.label),
        "xaxis": f"x{number}",
        "yaxis": f"y{number}",
        "x": _numbers(curve.x),
        "y": _numbers(curve.y),
        "width": curve.bars,
        "orientation": "h" if flat else "v",
        "marker": {"color": colour, "opacity": PALE if curve.outside is not None and curve.outside.any() else 1.0},
        "text": bar_texts(curve, panel),
        "textposition": "outside",
        "cliponaxis": False,
        "hovertemplate": f"<b>{literal(curve.label)}</b>: %{{{'x' if flat else 'y'}:.4~g}}<extra></extra>",
        "showlegend": not flat,
    }
    if curve.low is not None and curve.high is not None:
        bar["error_x" if flat else "error_y"] = _bars(values, curve.low, curve.high, "rgb(96, 96, 96)")
    return bar


def _map(shown: Map, number: str, ends: Ends) -> list[Json]:
    """Return the trace of a map and those of the borders of its regions.

    Colours have no logarithmic scale in plotly.js, so they stand for logarithms, and the bar has values at its ticks.
    """
    values = np.asarray(shown.values, dtype=float)
    log = shown.scale == "log"
    with np.errstate(divide="ignore", invalid="ignore"):
        colours = np.log10(np.where(values > 0.0, values, np.nan)) if log else values
    ticks = log_ticks(*ends) if log and ends[0] < ends[1] else []
    low, high = np.log10(ends) if log else ends
    axes: Json = {"xaxis": f"x{number}", "yaxis": f"y{number}", "x": _numbers(shown.x), "y": _numbers(shown.y)}
    bar: Json = {"title": {"text": literal(shown.label), "side": "right"}}
    if ticks:
        bar |= {"tickvals": _numbers(np.log10(ticks)), "ticktext": [f"{tick:g}" for tick in ticks]}
    heat: Json = {
        **axes,
        "type": "heatmap",
        "name": literal(shown.label),
        "legendgroup": literal(shown.label),
        "z": [_numbers(row) for row in colours],
        "customdata": [_numbers(row) for row in values],
        "zmin": float(low),
        "zmax": float(high),
        "colorscale": COLOURS.capitalize(),
        "colorbar": bar,
        "showscale": not number,
        "hovertemplate": f"%{{x:.4~g}}, %{{y:.4~g}}: %{{customdata:.4~g}}<extra>{literal(shown.label)}</extra>",
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
            "line": {"color": "black", "width": 2, "dash": _dash(place % len(LINES))},
            "hoverinfo": "skip",
            "showscale": False,
            "showlegend": True,
        }
        for place, (label, region) in enumerate(shown.borders.items())
        if region.any() and not region.all()
    ]
    return [heat, *borders]


def _marker(curve: Curve, colour: str) -> Json:
    if curve.points:
        symbol = SYMBOLS[MARKERS[curve.colour % len(MARKERS)]]
        return {"color": colour, "symbol": f"{symbol}-open" if curve.hollow else symbol, "size": 7}
    return {"color": colour, "symbol": "circle", "size": 5}


def _texts(curve: Curve, panel: Panel) -> Json:
    """Return the names of the points on an axis with names: of each point the one nearest to it."""
    for axis, values in ((panel.x, curve.x), (panel.y, curve.y)):
        if axis.names:
            nearest = np.clip(np.nan_to_num(values).round().astype(int), 0, len(axis.names) - 1)
            return {"text": [literal(axis.names[number]) for number in nearest]}
    return {}


def _hover(curve: Curve, panel: Panel) -> str:
    lines = [f"<b>{literal(curve.label)}</b>"]
    for axis, value in ((panel.x, "x"), (panel.y, "y")):
        lines.append("%{text}" if axis.names else f"{literal(axis.label)}: %{{{value}:.4~g}}")
    if curve.low is not None:
        lines.append("from %{customdata[0]:.4~g} to %{customdata[1]:.4~g}")
    return "<br>".join(lines) + "<extra></extra>"


def _bars(y: Array, low: Array, high: Array, colour: str) -> Json:
    ends = {"array": _numbers(high - y), "arrayminus": _numbers(y - low)}
    return {"type": "data", "symmetric": False, **ends, "color": colour, "thickness": 1.2}


def _band(curve: Curve, panel: Panel, colour: str) -> Json:
    """Return the closed outline of a band, without points that its axes cannot show."""
    x, low, high = (np.asarray(values, dtype=float) for values in (curve.x, curve.low, curve.high))
    seen = np.isfinite(x) & np.isfinite(low) & np.isfinite(high)
    for values, axis in ((x, panel.x), (low, panel.y), (high, panel.y)):
        seen &= (values > 0) | (axis.scale == "linear")
    return {
        "x": _numbers(np.concatenate([x[seen], x[seen][::-1]])),
        "y": _numbers(np.concatenate([low[seen], high[seen][::-1]])),
        "mode": "lines",
        "line": {"width": 0.5, "color": _faint(colour, EDGE)},
        "fill": "toself",
        "fillcolor": _faint(colour, BAND),
        "hoverinfo": "skip",
    }


def _faint(colour: str, opacity: float) -> str:
    return f"rgba({', '.join(str(part) for part in bytes.fromhex(colour[1:]))}, {opacity:g})"


def _axis(axis: PlotAxis) -> Json:
    described: Json = {
        "title": {"text": literal(axis.label)},
        "type": axis.scale,
        "exponentformat": "power",
        "automargin": True,
        "ticks": "outside",
        "showline": True,
        "zeroline": False,
    }
    if axis.ends is not None:
        ends = [float(end) for end in (np.log10(axis.ends) if axis.scale == "log" else axis.ends)]
        described["range"] = ends[::-1] if axis.inverted else ends
    elif axis.inverted:
        described["autorange"] = "reversed"
    if axis.names:
        described |= {"tickvals": [*range(len(axis.names))], "ticktext": [literal(name) for name in axis.names]}
    return described


def _heading(panel: Panel, number: str) -> Json:
    place = {"xref": f"x{number} domain", "yref": f"y{number} domain", "x": 0.5, "y": 1.0, "yanchor": "bottom"}
    return {**place, "text": literal(panel.title), "showarrow": False}


def _places(count: int) -> list[tuple[Ends, Ends]]:
    """Return the horizontal and vertical span of each panel: rows of two, an odd first panel over a whole row."""
    rows = [1] * (count % 2) + [2] * (count // 2)
    ups = reversed(_spans(len(rows)))
    return [(across, up) for in_row, up in zip(rows, ups, strict=True) for across in _spans(in_row)]


def _spans(count: int) -> list[Ends]:
    """Return the ends of equal spans, as shares of the figure, with gaps between them."""
    size = (1.0 - GAP * (count - 1)) / count
    return [(number * (size + GAP), min(number * (size + GAP) + size, 1.0)) for number in range(count)]


def _numbers(values: Array) -> list[float | None]:
    """Return numbers for JSON with seven digits: no screen shows more, and the page is half as long."""
    return [float(f"{value:.7g}") if np.isfinite(value) else None for value in np.asarray(values, dtype=float)]
