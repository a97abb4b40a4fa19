"""The page: its figures, which show new data without being drawn anew, its controls, and the ways to open it."""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Mapping
from html import escape
from itertools import cycle
from time import perf_counter
from typing import Any

import click
import numpy as np
import panel as pn
from bokeh.models import ColorBar, CustomJS, LinearColorMapper
from bokeh.palettes import Viridis256
from bokeh.plotting import figure

import wearlaw as wl
from wearlaw.contact.conditions import Known
from wearlaw.fields import is_law_file
from wearlaw.models.law import named_outcomes
from wearlaw.pipeline.pipeline import expect_pipeline
from wearlaw.units.variables import VARIABLES, name_of
from wearlaw_explore._models import Subject, by_patch, largest, numbered, numbers
from wearlaw_output.commands import values
from wearlaw_output.drawing import PALETTE
from wearlaw_output.labels import label
from wearlaw_output.notes import Notes
from wearlaw_output.pictures import cells, fields_of
from wearlaw_studies.case import load_case

FIELDS = ("pressure", "slip", "wear_rate")
"""The fields of a patch."""

APART = 0.015
"""Distance by which wheel and rail are drawn apart [m]."""

SLOW = 0.3
"""Time of a prediction beyond which there is no curve, and figures wait for the release of a slider [s]."""

STRETCHED: dict[str, Any] = {"sizing_mode": "stretch_width"}

WIDE: dict[str, Any] = {"flex": "1 1 300px", "min-width": "260px", "max-width": "100%"}
"""Style of an element that stands beside others if there is room, as on no phone."""

VIEWPORT = """document.head.insertAdjacentHTML("beforeend",
    '<meta name="viewport" content="width=device-width, initial-scale=1">')"""
"""JavaScript that makes the page as wide as the screen of a phone."""


def plain(title: str, x: str, y: str, **options: Any) -> Any:
    """Return an empty figure as wide as its place."""
    look = {"height": 320, "styles": WIDE, "tools": "pan,wheel_zoom,reset,hover,save", **STRETCHED}
    drawn = figure(title=title, x_axis_label=x, y_axis_label=y, **look, **options)
    drawn.toolbar.logo = None
    drawn.toolbar.active_scroll = None  # the wheel scrolls the page
    return drawn


class Lines:
    """A figure of lines by name, with marks."""

    def __init__(self, title: str, x: str, y: str, names: Iterable[str], **options: Any) -> None:
        self.figure = plain(title, x, y, **options)
        self.lines = {
            name: self.figure.line([], [], color=colour, line_width=2, legend_label=name)
            for name, colour in zip(names, cycle(PALETTE))
        }
        self.marks = self.figure.scatter([], [], color="black", size=8)
        self.figure.legend.update(background_fill_alpha=0.6, visible=len(self.lines) > 1)

    def show(self, lines: Mapping[str, tuple[Any, Any]], marks: Any = ([], [])) -> None:
        """Show x and y of lines and marks; lines that are not given are left out."""
        shown = {line: lines.get(name, ([], [])) for name, line in self.lines.items()}
        for glyphs, (x, y) in [*shown.items(), (self.marks, marks)]:
            glyphs.data_source.data = {"x": x, "y": y}
        for name, entry in zip(self.lines, self.figure.legend[0].items, strict=True):
            entry.visible = name in lines


class Map:
    """A figure of a field in the cells of a patch, with equal axes."""

    def __init__(self, name: str) -> None:
        self.name, self.figure = name, plain(name_of(name), label("x"), "y [mm]", match_aspect=True)
        colours = LinearColorMapper(palette=list(Viridis256))
        colour = {"field": "value", "transform": colours}
        look = {"fill_color": colour, "line_color": colour, "line_width": 0.3}  # no seams between cells
        self.cells = self.figure.patches("x", "y", source={"x": [], "y": [], "value": []}, **look)
        self.figure.hover.tooltips = [(label(name), "@value")]
        self.figure.add_layout(ColorBar(color_mapper=colours, title=label(name), height=8), "below")

    def show(self, maps: Mapping[str, tuple[Any, Any]]) -> None:
        """Show the outlines of the cells and their values, if they are given."""
        outlines, values = maps.get(self.name, (np.empty((0, 0, 2)), []))
        x, y = np.moveaxis(outlines, -1, 0)
        self.cells.data_source.data = {"x": list(x), "y": list(y), "value": values}


def fields(predictions: Iterable[wl.Prediction]) -> dict[str, tuple[Any, Any]]:
    """Return places and values of the fields of a patch by the first law that sees its cells; {} if none does."""
    for prediction in predictions:
        if prediction.scale == "cells":
            found = fields_of(prediction)
            place = found["x"].values if prediction.problem.geometry == "line" else cells(prediction)
            (wear,) = named_outcomes(prediction.laws)  # such as "wear_rate_rail", of a law for the rail alone
            return {name: (place, found[wear if name == "wear_rate" else name].values.ravel()) for name in FIELDS}
    return {}


class OnProfiles:
    """Figures of a wheel and its rail, drawn apart, with their contacts, and of the wear across the wheel."""

    def __init__(self, profiles: Any, laws: Iterable[str]) -> None:
        self.profiles, y = profiles, "y in the track [mm]"
        title = f"wheel and rail, drawn {1e3 * APART:.0f} mm apart"
        self.both = Lines(title, y, "height [mm]", ("wheel", "rail"), match_aspect=True)
        self.wear = Lines("wear across the wheel", y, "depth [µm/km]", laws)

    def show(self, predictions: Mapping[str, wl.Prediction]) -> None:
        """Show the contacts on one side, which the left side has in its mirror, and the wear by each law."""
        problem = next(iter(predictions.values())).problem
        lines, marks = {}, []
        for name, body in problem.bodies.items():
            arc, y, z = getattr(self.profiles, name)
            height = (APART if name == "wheel" else 0.0) - z
            at = np.asarray(body.profile_position)[problem.exists]
            lines[name] = 1e3 * y, 1e3 * height
            marks.append([1e3 * np.interp(at, arc, y), 1e3 * np.interp(at, arc, height)])
        self.both.show(lines, np.concatenate(marks, axis=1))
        arc, y, _ = self.profiles.wheel
        resolved = {law: one for law, one in predictions.items() if one.scale == "cells"}
        depths = {law: one.wear_profile("wheel", at=wl.Q(1e3 * arc, "mm"))["depth"] for law, one in resolved.items()}
        self.wear.show({law: (1e3 * y, depth.values) for law, depth in depths.items()})


def slider(rig: Any, name: str, value: object) -> Any:
    """Return a slider in a `unit` that starts at a condition; None for no number, such as a law of friction."""
    known, bounds = Known.of(value), getattr(rig.conditions().get(name), "unit", None)
    if known is None or np.ndim(known.values):
        return None
    unit = VARIABLES[name].unit if name in VARIABLES else known.unit or ""
    start = float(wl.Q(known.values, known.unit or "").m_as(unit))
    high = 2.0 * abs(start) or 1.0
    low = -high if bounds is not None and bounds.negative and not bounds.positive else 0.01 * high
    text = label(name, units={name: unit}).removesuffix(" [-]")
    ends = {"start": low, "end": high, "step": (high - low) / 200.0, "format": "0.[0000]"}
    made: Any = pn.widgets.EditableFloatSlider(label=text, value=start, **ends, **STRETCHED)
    made.unit = unit
    return made


class Page:
    """The page of a rig, which starts from its example conditions and the given ones."""

    def __init__(self, subject: Subject, given: Mapping[str, Any]) -> None:
        rig, self.subject, self.start = subject.rig, subject, subject.conditions(given)
        sliders = {name: slider(rig, name, value) for name, value in self.start.items()}
        self.sliders = {name: one for name, one in sliders.items() if one is not None}
        self.model = pn.widgets.Select(label="Contact model", options=[*subject.models], **STRETCHED)
        self.laws = pn.widgets.CheckBoxGroup(options=[*subject.laws], value=subject.first_laws, inline=True)
        self.patch = pn.widgets.Select(label="Patch", options=[""], visible=False, **STRETCHED)
        line = rig.patch_geometry == "line"
        self.fields: Any = [Lines(name_of(one), label("x"), label(one), [one]) if line else Map(one) for one in FIELDS]
        self.along = self.sliders.get(rig.creepage)
        along = self.along.label if self.along is not None else ""
        title = f"wear over {name_of(rig.creepage or 'creepage')}"
        self.curve = Lines(title, along, label("wear_rate"), subject.laws)
        self.curves: dict[str, Any] = {}
        self.curves_of: Any = None
        self.profiles: Any = (
            OnProfiles(rig.profiles_in_track(), subject.laws) if hasattr(rig, "profiles_in_track") else None
        )
        self.notes, self.numbers, self.python = pn.pane.HTML(**STRETCHED), pn.pane.HTML(), pn.pane.HTML(**STRETCHED)
        self._update()
        self._update()  # for its time: the first predictions load and compile
        for one in self.sliders.values():
            one.param.watch(self._moved, "value")
            one.param.watch(self._update, "value_throttled")
        for widget in (self.model, self.laws, self.patch):
            widget.param.watch(self._update, "value")

    def layout(self) -> Any:
        """Return the controls beside the figures, or above them on a phone."""
        laws = pn.Column(pn.pane.HTML("Wear laws"), self.laws)
        left = pn.Column(*self.sliders.values(), self.model, laws, self.patch, styles={**WIDE, "max-width": "420px"})
        every = [*self.fields, self.curve, *([self.profiles.both, self.profiles.wear] if self.profiles else [])]
        figures = pn.FlexBox(*(one.figure for one in every), **STRETCHED)
        right = pn.Column(self.notes, figures, self.numbers, self.python, styles={**WIDE, "flex": "4 1 600px"})
        return pn.FlexBox(left, right, flex_wrap="wrap", **STRETCHED)

    def _moved(self, *_: Any) -> None:
        if self.seconds < SLOW:
            self._update()

    def _update(self, *_: Any) -> None:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", wl.WearlawWarning)  # there are notes of them
            self._show(self.model.value, self.laws.value)

    def _show(self, model: str, laws: list[str]) -> None:
        notes, started = Notes(), perf_counter()
        conditions = dict(self.start)
        for name, one in self.sliders.items():
            conditions[name] = f"{one.value:.6g} {one.unit}" if one.unit else float(f"{one.value:.6g}")
        predictions = self.subject.predict(model, laws, conditions, notes)
        self.seconds = perf_counter() - started
        self._show_curve(predictions, conditions)
        patches = by_patch(predictions)
        self.patch.param.update(options=[*patches] or [""], visible=len(patches) > 1)
        if patches and self.patch.value not in patches:
            self.patch.value = next(iter(patches))
        found = fields(patches[self.patch.value].values()) if patches else {}
        for one in self.fields:
            one.show(found)
        if self.profiles and predictions:
            side = self.patch.value.partition(" ")[0]
            self.profiles.show({law: one.sel(side=side) for law, one in predictions.items()})
        self.numbers.object = numbers(patches)
        python = escape(self.subject.python(model, laws, conditions), quote=False)
        self.python.object = f"<p>The same in Python:</p><pre tabindex=0 style='white-space: pre-wrap'>{python}</pre>"
        self.notes.object = "".join(f"<p role=status>{escape(text)}</p>" for text in notes.texts)

    def _show_curve(self, predictions: Mapping[str, wl.Prediction], conditions: dict[str, Any]) -> None:
        if self.along is None:
            return
        creepage, model, laws = self.subject.rig.creepage, self.model.value, self.laws.value
        key = model, laws, {**conditions, creepage: None}
        if self.curves_of != key:  # along the curve itself it stays
            x = np.linspace(self.along.start, self.along.end, 25)
            there = {**conditions, creepage: wl.Q(x, self.along.unit)}
            found = self.subject.predict(model, laws, there, Notes()) if self.seconds < SLOW * len(laws) else {}
            self.curves, self.curves_of = {law: (x, largest(one)) for law, one in found.items()}, key
        rates = [largest(one) for one in predictions.values()]
        self.curve.show(self.curves, ([self.along.value] * len(rates), rates))


def explore(predict: Any, /, **conditions: Any) -> Any:
    """Return a page to explore a pipeline in a notebook: sliders for its conditions, menus of models, live figures.

    Parameters
    ----------
    predict : Pipeline
        As in rig | contact model | wear law. The page starts with its models; the menus have the installed ones too.
    **conditions
        Start values of conditions, such as ``normal_force="80 kN"``. Default: the example values of the rig. Those that
        are numbers get sliders, from about 0 or from minus twice to twice their start value.

    Returns
    -------
    panel.viewable.Viewable
        The page. A notebook shows it; ``.show()`` opens it in a browser.

    Raises
    ------
    InputError
        If `predict` is no pipeline.
    """
    expect_pipeline(predict)
    pn.extension(inline=True)
    models = {predict.contact_model: "predict.contact_model"}
    laws, stages = numbered("predict.laws", predict.laws), numbered("predict.stages", predict.stages)
    return Page(Subject(predict.rig, "predict.rig", "", models, laws, stages), conditions).layout()


@click.command("explore")
@click.argument("rig", default="wheel_rail")
@click.option("--law", "laws", metavar="LAW", multiple=True, help="Wear law to start with: its name or TOML file.")
@click.option("--set", "conditions", metavar="CONDITION=VALUE", multiple=True, help="Start value of a condition.")
@click.option("--port", default=0, help="Port of the page [default: a free one].")
@click.option("--browser/--no-browser", default=True, help="Whether to open a browser.")
def command(rig: str, laws: tuple[str, ...], conditions: tuple[str, ...], port: int, browser: bool) -> None:
    """Explore a rig on a local page: RIG is an installed rig or a case.

    \b
    wearlaw explore
    wearlaw explore twin_disc --set "normal_force=7 kN" --set creepage=1%
    wearlaw explore my-case.toml
    wearlaw explore wheel_rail --law fit/law.toml

    An installed rig has example values. A case brings its own rig, models and laws. The page needs no network; Ctrl-C
    ends it.
    """  # noqa: D301
    subject, start = named(rig, laws), values("--set", conditions)

    def opened() -> Any:
        document: Any = pn.state.curdoc
        document.js_on_event("document_ready", CustomJS(code=VIEWPORT))
        return Page(subject, start).layout()

    Page(subject, start)  # an error before the server starts
    look: dict[str, Any] = {"show": browser, "verbose": False, "title": f"wearlaw: {subject.rig.name}"}
    server: Any = pn.serve(opened, port=port, address="localhost", start=False, **look)
    click.echo(f"The page is at http://localhost:{server.port}; end it with Ctrl-C")
    server.run_until_shutdown()


def named(rig: str, chosen: Iterable[str] = ()) -> Subject:
    """Return an installed rig with example values, or that of a case with its models and laws; with chosen laws."""
    laws = {}
    for name in chosen:
        read = wl.read_law if is_law_file(name) else wl.wear_law
        laws[read(name)] = f"wl.{read.__name__}({name!r})"
    found = wl.rigs().get(rig)
    if found is not None:
        given = "".join(f", {name}={text!r}" for name, text in found.example_fields.items())
        return Subject(wl.rig(rig, **found.example_fields), "rig", f"rig = wl.rig({rig!r}{given})", own_laws=laws)
    case = load_case(rig)
    models, wear_laws, stages = (
        numbered(f"case.{name}", getattr(case, name)) for name in ("contact_models", "wear_laws", "stages")
    )
    return Subject(case.rig, "case.rig", f"case = wl.load_case({rig!r})", models, {**wear_laws, **laws}, stages)
