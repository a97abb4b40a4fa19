"""The figures of the page, each with the data that it shows."""

from __future__ import annotations

from typing import Any

import numpy as np
from bokeh.models import ColorBar, ColumnDataSource, LinearColorMapper
from bokeh.palettes import Viridis256
from bokeh.plotting import figure

import wearlaw as wl
from wearlaw.units.variables import label
from wearlaw_explore._answer import law_name
from wearlaw_output.drawing import PALETTE
from wearlaw_output.pictures import cells

FIELDS = {"pressure": label("pressure"), "slip": label("slip"), "wear": "wear rate [µg/m/mm²]"}
"""The fields of a patch with their labels."""

ENDS = ("left", "bottom", "right", "top")
"""The ends of a cell."""

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
    wear = 1e3 * (contact | prediction.laws[0]).rate  # µg/m/mm²
    fields = {"pressure": 1e-6 * contact.pressure, "slip": 100.0 * contact.slip, "wear": wear}
    if prediction.problem.geometry == "line":
        order = np.argsort(contact.x)
        return {"x": 1e3 * contact.x[order], **{name: values[order] for name, values in fields.items()}}
    there = contact.area.ravel() > 0.0
    corners = cells(prediction)[there][:, [0, 2]].reshape(-1, 4)
    values = {name: np.broadcast_to(one, contact.area.shape).ravel()[there] for name, one in fields.items()}
    return dict(zip(ENDS, corners.T, strict=True)) | values


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
    """Return the depth worn off a wheel [µm/km] over y in the track [mm]."""
    if prediction.scale == "patch":
        return NONE
    worn = prediction.sel(side=side).wear_profile("wheel", at=wl.Q(1e3 * profiles.wheel_arc, "mm"))
    return {"x": 1e3 * profiles.wheel_y, "y": worn["depth"].values}


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
        self.places = ("x",) if line else ENDS
        self.cells = ColumnDataSource()
        self.figures = []
        for name, text in FIELDS.items():
            title, x = text.partition(" [")[0], "x, leading edge left [mm]"
            if line:
                drawn = plain(title, x, text)
                drawn.line("x", name, source=self.cells, color=PALETTE[0], line_width=2)
            else:
                drawn = plain(title, x, "y [mm]", match_aspect=True)
                colours = LinearColorMapper(palette=list(Viridis256))
                fill = {"field": name, "transform": colours}
                drawn.quad(**{end: end for end in ENDS}, source=self.cells, line_color=None, fill_color=fill)
                drawn.hover.tooltips = [(text, f"@{name}")]
                drawn.add_layout(ColorBar(color_mapper=colours, title=text, height=8), "below")
            self.figures.append(drawn)
        self.show(None)

    def show(self, prediction: wl.Prediction | None) -> None:
        """Show a prediction of one patch."""
        found = nodes(prediction) if prediction is not None else {}
        self.cells.data = found or {name: [] for name in (*self.places, *FIELDS)}


class Curves:
    """A figure of a curve for each law, with a mark at the present value."""

    def __init__(self, title: str, x: str, y: str, laws: Any) -> None:
        self.figure, self.mark = plain(title, x, y), ColumnDataSource(NONE)
        self.sources = {law: ColumnDataSource(NONE) for law in laws}
        for (law, source), colour in zip(self.sources.items(), PALETTE * len(self.sources), strict=False):
            self.figure.line("x", "y", source=source, color=colour, line_width=2, legend_label=law_name(law))
        self.figure.scatter("x", "y", source=self.mark, color="black", size=8)
        self.figure.legend.background_fill_alpha = 0.6

    def show(self, curves: Any) -> None:
        """Show curves by law; other laws have none."""
        for (law, source), entry in zip(self.sources.items(), self.figure.legend[0].items, strict=True):
            source.data = curves.get(law, NONE)
            entry.visible = law in curves


class OnProfiles:
    """Figures of the profiles of a wheel and its rail with their contacts, and of the wear across the wheel."""

    def __init__(self, profiles: Any, laws: Any) -> None:
        self.profiles, self.touching = profiles, ColumnDataSource(NONE)
        drawn = plain(f"wheel and rail, drawn {APART:.0f} mm apart", "y in the track [mm]", "height [mm]",
                      match_aspect=True)  # fmt: skip
        for y, z, up in ((profiles.wheel_y, profiles.wheel_z, APART), (profiles.rail_y, profiles.rail_z, 0.0)):
            drawn.line(1e3 * y, up - 1e3 * z, color="black")
        drawn.scatter("x", "y", source=self.touching, color=PALETTE[1], size=9)
        self.wear = Curves("wear across the wheel", "y in the track [mm]", "depth [µm/km]", laws)
        self.figures = [drawn, self.wear.figure]

    def show(self, predictions: dict[str, wl.Prediction], side: str) -> None:
        """Show the contacts of a side, which the left wheel has in its mirror, and the wear by each law."""
        first = next(iter(predictions.values()))
        self.touching.data = contacts(first, side, self.profiles)
        self.wear.show({law: wear_across(one, side, self.profiles) for law, one in predictions.items()})
