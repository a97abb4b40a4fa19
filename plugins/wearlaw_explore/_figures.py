"""The figures of the page, each with the data that it shows."""

from __future__ import annotations

from typing import Any

import numpy as np
from bokeh.models import ColorBar, ColumnDataSource, LinearColorMapper
from bokeh.palettes import Viridis256
from bokeh.plotting import figure

import wearlaw as wl
from wearlaw.pipeline.worn import POSITION
from wearlaw.units.variables import label
from wearlaw_explore._answer import law_name, unwarned

FIELDS = {"pressure": label("pressure"), "slip": label("slip"), "wear": "wear rate [µg/m/mm²]"}
"""The fields of a patch with their labels."""

COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000")
"""Colours that the colour-blind can tell apart (M. Okabe and K. Ito)."""

WIDE: dict[str, str | None] = {"flex": "1 1 300px", "min-width": "260px", "max-width": "100%"}
"""Style of an element that stands beside others if there is room, as on no phone."""

APART = 15.0
"""Distance by which wheel and rail are drawn apart [mm]."""

Data = dict[str, Any]
NONE: Data = {"x": [], "y": []}


def nodes(prediction: wl.Prediction) -> Data:
    """Return the fields of one patch: cells that tile it, or values along a line; {} for patch means."""
    if prediction.scale == "patch":
        return {}
    contact = prediction.contact
    with unwarned():
        wear = 1e3 * (contact | prediction.laws[0]).rate  # µg/m/mm²
    fields = {"pressure": 1e-6 * contact.pressure, "slip": 100.0 * contact.slip, "wear": wear}
    if prediction.problem.geometry == "line":
        order = np.argsort(contact.x)
        return {"x": 1e3 * contact.x[order], **{name: values[order] for name, values in fields.items()}}
    # Areas are weights of a quadrature. Their running sum separates the nodes and ends at the edge of the patch.
    width = contact.strip_width
    across = np.concatenate([[0.0], np.cumsum(width)])
    across += np.mean(contact.y[..., [0, -1]]) - 0.5 * across[-1]
    length = contact.area / width
    ahead = np.cumsum(length, axis=0)
    middle = 0.5 * ahead[-1]
    edges = {
        "left": ahead - length - middle,
        "right": ahead - middle,
        "bottom": np.broadcast_to(across[:-1], length.shape),
        "top": np.broadcast_to(across[1:], length.shape),
    }
    there = contact.area > 0.0
    return {name: np.broadcast_to(v, there.shape)[there] for name, v in fields.items()} | {
        name: 1e3 * v[there] for name, v in edges.items()
    }


def edge(prediction: wl.Prediction) -> Data:
    """Return the true edge of an ellipse [mm]; that of strips is the edge of their cells."""
    if prediction.problem.geometry != "ellipse":
        return NONE
    angle = np.linspace(0.0, 2.0 * np.pi, 181)
    problem = prediction.problem
    return {"x": 1e3 * problem.a * np.cos(angle), "y": 1e3 * problem.b * np.sin(angle)}


def contacts(prediction: wl.Prediction, side: str, profiles: Any) -> Data:
    """Return where a wheel and its rail touch, each on its own profile [mm]."""
    one = prediction.sel(side=side)
    there = np.isfinite(one.normal_force.magnitude)
    places = [
        np.array([profiles.at(body, s) for s in np.asarray(one.problem.bodies[body].profile_position)[there]])
        for body in ("wheel", "rail")
    ]
    wheel, rail = (1e3 * place.reshape(-1, 2) for place in places)
    return {"x": np.concatenate([wheel[:, 0], rail[:, 0]]), "y": np.concatenate([APART - wheel[:, 1], -rail[:, 1]])}


def wear_across(prediction: wl.Prediction, side: str, profiles: Any) -> Data:
    """Return the depth worn off a wheel [µm/km] over y in the track [mm], with a gap between patches."""
    if prediction.scale == "patch":
        return NONE
    with unwarned():
        worn = prediction.sel(side=side).wear_profile("wheel")
    gap = {"strip": (0, 1)}
    arc, depth = (worn[name].pad(gap, constant_values=np.nan).values.ravel() for name in (POSITION, "depth"))
    return {"x": 1e3 * np.interp(1e-3 * arc, profiles.wheel_arc, profiles.wheel_y), "y": depth}


def plain(title: str, x: str, y: str, **options: Any) -> Any:
    """Return an empty figure as wide as its place."""
    drawn = figure(title=title, x_axis_label=x, y_axis_label=y, height=320, tools="pan,wheel_zoom,reset,hover,save",
                   sizing_mode="stretch_width", styles=WIDE, **options)  # fmt: skip
    drawn.toolbar.logo = None
    drawn.toolbar.active_scroll = None  # the wheel scrolls the page
    return drawn


class Patch:
    """Figures of the fields of a patch: maps with equal axes, or curves along the patch of a line."""

    def __init__(self, line: bool) -> None:
        self.places = ("x",) if line else ("left", "right", "top", "bottom")
        self.cells, self.edge = ColumnDataSource(), ColumnDataSource()
        self.figures = []
        for name, text in FIELDS.items():
            title, x = text.partition(" [")[0], "x, leading edge left [mm]"
            if line:
                drawn = plain(title, x, text)
                drawn.line("x", name, source=self.cells, color=COLOURS[0], line_width=2)
            else:
                drawn = plain(title, x, "y [mm]", match_aspect=True)
                colours = LinearColorMapper(palette=list(Viridis256))
                drawn.quad(*self.places, source=self.cells, line_color=None,
                           fill_color={"field": name, "transform": colours})  # fmt: skip
                drawn.line("x", "y", source=self.edge, color="black")
                drawn.hover.tooltips = [(text, f"@{name}")]
                drawn.add_layout(ColorBar(color_mapper=colours, title=text, height=8), "below")
            self.figures.append(drawn)
        self.show(None)

    def show(self, prediction: wl.Prediction | None) -> None:
        """Show a prediction of one patch."""
        found = nodes(prediction) if prediction is not None else {}
        self.cells.data = found or {name: [] for name in (*self.places, *FIELDS)}
        self.edge.data = edge(prediction) if prediction is not None else NONE


class Curves:
    """A figure of a curve for each law, with a mark at the present value."""

    def __init__(self, title: str, x: str, y: str, laws: Any) -> None:
        self.figure, self.mark = plain(title, x, y), ColumnDataSource(NONE)
        self.sources = {law: ColumnDataSource(NONE) for law in laws}
        for (law, source), colour in zip(self.sources.items(), COLOURS * len(self.sources), strict=False):
            self.figure.line("x", "y", source=source, color=colour, line_width=2, legend_label=law_name(law))
        self.figure.scatter("x", "y", source=self.mark, color="black", size=8)
        self.figure.legend.background_fill_alpha = 0.6

    def show(self, curves: Any) -> None:
        """Show curves by law; other laws have none."""
        for law, source in self.sources.items():
            source.data = curves.get(law, NONE)


class OnProfiles:
    """Figures of the profiles of a wheel and its rail with their contacts, and of the wear across the wheel."""

    def __init__(self, profiles: Any, laws: Any) -> None:
        self.profiles, self.touching = profiles, ColumnDataSource(NONE)
        drawn = plain(f"wheel and rail, drawn {APART:.0f} mm apart", "y in the track [mm]", "height [mm]",
                      match_aspect=True)  # fmt: skip
        for y, z, up in ((profiles.wheel_y, profiles.wheel_z, APART), (profiles.rail_y, profiles.rail_z, 0.0)):
            drawn.line(1e3 * y, up - 1e3 * z, color="black")
        drawn.scatter("x", "y", source=self.touching, color=COLOURS[1], size=9)
        self.wear = Curves("wear across the wheel", "y in the track [mm]", "depth [µm/km]", laws)
        self.figures = [drawn, self.wear.figure]

    def show(self, predictions: dict[str, wl.Prediction], side: str) -> None:
        """Show the contacts of a side, which the left wheel has in its mirror, and the wear by each law."""
        first = next(iter(predictions.values()))
        self.touching.data = contacts(first, side, self.profiles)
        self.wear.show({law: wear_across(one, side, self.profiles) for law, one in predictions.items()})
