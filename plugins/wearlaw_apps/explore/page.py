"""The page: its figures, its controls, and the ways to open it."""

from __future__ import annotations

import re
import webbrowser
from collections.abc import Iterable, Mapping
from dataclasses import replace
from html import escape
from secrets import token_urlsafe
from time import perf_counter
from typing import Any

import click
import numpy as np
import pandas as pd
import panel as pn
from bokeh.models import CustomJS
from tornado.web import HTTPError, RequestHandler

import wearlaw as wl
from wearlaw import loader
from wearlaw.fields import is_law_file
from wearlaw.models.law import named_outcomes
from wearlaw.pipeline.variables import SHOWN
from wearlaw.text_files import reason_of
from wearlaw.units.registry import symbol
from wearlaw.units.variables import VARIABLES, name_of
from wearlaw_apps.explore.subject import Subject, code_of, numbered
from wearlaw_apps.output.commands import values
from wearlaw_apps.output.conditions import Known
from wearlaw_apps.output.curves import BLACK
from wearlaw_apps.output.labels import in_words, label, readable
from wearlaw_apps.output.notes import Notes, caught_warnings
from wearlaw_apps.output.pictures import of_patch
from wearlaw_apps.output.styled import plain_number
from wearlaw_apps.show import LAWS, completed
from wearlaw_apps.studies.case import load_case
from wearlaw_apps.studies.report.interactive import plotly_figure
from wearlaw_apps.sweeps.evaluation import expect_pipeline

CURVE = 41
"""Points of a curve of wear over creepage."""

SLOW = 0.5
"""Time beyond which a prediction gets no curve, and figures wait until a slider is released [s]."""

PIXELS = (81, 51)
"""Points of a map along and across a patch."""

STRETCHED: dict[str, Any] = {"sizing_mode": "stretch_width"}

WIDE: dict[str, Any] = {"flex": "1 1 300px", "min-width": "260px", "max-width": "100%"}
"""Style of an element that stands beside others if there is room, as on no phone."""

TABLE = ":host { overflow-x: auto } th { text-align: left }"
"""Style of a table, which scrolls on a narrow screen."""

SCREEN = """document.head.insertAdjacentHTML("beforeend",
    '<meta name="viewport" content="width=device-width, initial-scale=1">' +
    '<style>@media (prefers-color-scheme: dark) {' +
    ' html { background: #ebe7e3; filter: invert(1) hue-rotate(180deg) } }</style>')"""
"""JavaScript that makes the page as wide as the screen of a phone, and dark where its reader prefers that."""

MAPS = "@media (prefers-color-scheme: dark) { .heatmaplayer, .cbfills { filter: invert(1) hue-rotate(180deg) } }"
"""Style that keeps the colours of maps on a dark page."""

WRONG = ":host { outline: 2px solid #c04000; outline-offset: 4px }"
"""Style of a control whose value is refused."""

BAR = "#8a8a8a"
"""Colour of a slider up to its value, to be seen on bright and on dark ground."""

LOCAL = r"(localhost|127\.0\.0\.1|\[?::1\]?)"
"""The hosts under which the page is served."""


def patch_figures(predictions: Mapping[str, wl.Prediction], patch: str = "") -> list[wl.FigureData]:
    """Return figures of pressure, slip and wear in a patch, by the first law that sees its cells; [] if none does."""
    law, prediction = next(
        ((law, prediction) for law, prediction in predictions.items() if prediction.scale == "cells"), ("", None)
    )
    if prediction is None:
        return []
    (wear,) = named_outcomes(prediction.laws)  # such as "wear_rate_rail", of a law for the rail alone
    figures = []
    for name, of in (("pressure", "pressure"), ("slip", "slip"), ("wear_rate", wear)):
        title = f"{label(name)}{f' by {law}' if name == 'wear_rate' else ''}{f', {patch}' if patch else ''}"
        panel = of_patch(prediction, of, PIXELS)
        if panel.map is not None:  # the title says what it shows
            panel = replace(panel, map=replace(panel.map, label=""))
        figures.append(wl.FigureData(name, title, (panel,)))
    return figures


def largest(prediction: wl.Prediction) -> Any:
    """Return the largest wear rate of the patches at each operating point [µg/m/mm²]."""
    return np.nanmax(prediction.wear_rate.magnitude, axis=tuple(range(-len(prediction.problem.dims), 0)))


def by_patch(predictions: Mapping[str, wl.Prediction]) -> dict[str, dict[str, wl.Prediction]]:
    """Return predictions by law for each existing patch, by its label, "" for the only one of a rig."""
    for first in predictions.values():
        dims = [*first.problem.dims]
        rows: Any = first.to_dataframe(["wear_rate"])[dims].to_dict("records") if dims else [{}]
        return {in_words(row): {law: prediction.sel(**row) for law, prediction in predictions.items()} for row in rows}
    return {}


def numbers(patches: Mapping[str, Mapping[str, wl.Prediction]]) -> str:
    """Return a table in HTML with a column for each patch."""
    columns = {}
    for patch, predictions in patches.items():
        first = next(iter(predictions.values()))
        wear = {f"wear rate by {law}": prediction.wear_rate for law, prediction in predictions.items()}
        columns[patch] = wear | {name_of(name): first[name] for name in SHOWN[first.problem.geometry]}
    return str(pd.DataFrame(columns).map(in_text).to_html(border=0, header=any(columns)))


def in_text(value: wl.Quantity) -> str:
    """Return a quantity with four digits, as tables have it."""
    return f"{plain_number(float(value.magnitude))} {symbol(value.units, '~P')}".rstrip()


def slider(condition: Any, name: str, value: object) -> Any:
    """Return a slider in a `unit` that starts at a value; None for no number, such as a law of friction.

    One of a condition that a model declares covers what is usual.
    """
    number, bounds = Known.of(value), getattr(condition, "unit", None)
    if number is None or np.ndim(number.values):
        return None
    unit = VARIABLES[name].unit if name in VARIABLES else number.unit or ""
    start = float(wl.Q(number.values, number.unit or "").m_as(unit))
    high = 2.0 * abs(start) or 1.0
    low = -high if bounds is not None and bounds.negative and not bounds.positive else 0.01 * high
    if condition is not None and condition.of and bounds is not None and bounds.usual:
        low, high = (float(wl.Q(end, bounds.unit).m_as(unit)) for end in bounds.usual)
    return _slider(label(name, units={name: unit}).removesuffix(" [-]"), unit, start, low, high)


def of_rig(name: str, value: Any) -> Any:
    """Return a slider for a number of a rig, from half to one and a half times its value; None if that is infinite."""
    unit = f"{value.units:~C}" if isinstance(value, wl.Quantity) else ""
    start = float(getattr(value, "magnitude", value))
    if not np.isfinite(start):
        return None
    low, high = sorted((0.5 * start, 1.5 * start)) if start else (-1.0, 1.0)
    text = f"{name.replace('_', ' ').replace('.', ': ')}{f' [{readable(unit)}]' if unit else ''}"
    return _slider(text, unit, start, low, high)


def _slider(text: str, unit: str, start: float, low: float, high: float) -> Any:
    ends = {"start": low, "end": high, "step": (high - low) / 200.0, "format": "0.[0000]"}
    made: Any = pn.widgets.EditableFloatSlider(label=text, value=start, bar_color=BAR, **ends, **STRETCHED)
    made.unit = unit
    return made


def written(control: Any) -> str | float:
    """Return the value of a slider with its unit."""
    return f"{control.value:.6g} {control.unit}" if control.unit else float(f"{control.value:.6g}")


class Page:
    """The page of a rig, which starts from its example conditions and the given ones."""

    def __init__(self, subject: Subject, conditions: Mapping[str, Any]) -> None:
        self.subject, self.start = subject, subject.conditions(conditions)
        rest = {name: value for name, value in self.start.items() if name not in subject.declared}
        subject.rig.checked_problem(rest)  # an error of what is given, before there is a page with notes
        every = {**subject.declared, **subject.rig.conditions()}
        sliders = {name: slider(every.get(name), name, value) for name, value in self.start.items()}
        self.sliders = {name: control for name, control in sliders.items() if control is not None}
        fields = {name: of_rig(name, value) for name, value in subject.fields.items()}
        self.fields = {name: control for name, control in fields.items() if control is not None}
        self.model = pn.widgets.Select(label="Contact model", options=[*subject.models], **STRETCHED)
        self.laws = pn.widgets.CheckBoxGroup(options=[*subject.laws], value=subject.first_laws, inline=True)
        self.patch = pn.widgets.Select(label="Patch", options=[""], visible=False, **STRETCHED)
        self.panes: dict[str, Any] = {}
        self.figures = pn.FlexBox(**STRETCHED)
        self.notes, self.numbers, self.python = (pn.pane.HTML(stylesheets=[TABLE], **STRETCHED) for _ in range(3))
        self._update()
        self._update()  # for its time: the first predictions load and compile
        for control in (*self.sliders.values(), *self.fields.values()):
            control.param.watch(self._moved, "value")
            control.param.watch(self._update, "value_throttled")
        for widget in (self.model, self.laws, self.patch):
            widget.param.watch(self._update, "value")

    def layout(self) -> Any:
        """Return the controls beside the figures, or above them on a phone."""
        laws = pn.Column(pn.pane.HTML("Wear laws"), self.laws)
        look: dict[str, Any] = {"title": "Rig", "collapsed": True, "margin": (5, 10), **STRETCHED}
        rig = pn.Card(*self.fields.values(), visible=bool(self.fields), **look)
        controls = [*self.sliders.values(), rig, self.model, laws, self.patch, self.numbers]
        left = pn.Column(*controls, styles={**WIDE, "max-width": "420px", "padding-top": "10px"})
        right = pn.Column(self.notes, self.figures, self.python, styles={**WIDE, "flex": "4 1 600px"})
        return pn.FlexBox(left, right, flex_wrap="wrap", **STRETCHED)

    def _moved(self, *_: Any) -> None:
        if self.seconds < SLOW:
            self._update()

    def _update(self, *_: Any) -> None:
        with caught_warnings():  # there are notes of them
            self._show(self.model.value, self.laws.value)

    def _show(self, model: str, laws: list[str]) -> None:
        notes, started = Notes(), perf_counter()
        conditions = dict(self.start)
        conditions |= {name: written(control) for name, control in self.sliders.items()}
        try:
            self.subject.change({name: written(control) for name, control in self.fields.items()})
        except wl.WearlawError as error:
            notes.add(f"rig: {error}")
            laws = []
        predictions = self.subject.predict(model, laws, conditions, notes)
        errors = " ".join(text for text in notes.texts if text.kind is None)
        for name, control in {**self.sliders, **self.fields}.items():
            control.stylesheets = [WRONG] if re.search(rf"(?<!\w){re.escape(name)}\b", errors) else []
        curve = self._curve(predictions, conditions) if perf_counter() - started < SLOW else []
        self.seconds = perf_counter() - started
        patches = by_patch(predictions)
        self.patch.param.update(options=[*patches] or [""], visible=len(patches) > 1)
        if patches and self.patch.value not in patches:
            self.patch.value = next(iter(patches))
        patch = patch_figures(patches.get(self.patch.value, {}), self.patch.value)
        self._draw([*patch, *curve, *self._profiles(predictions)])
        self.numbers.object = numbers(patches)
        python = escape(self.subject.python(model, laws, conditions), quote=False)
        self.python.object = f"<p>The same in Python:</p><pre tabindex=0 style='white-space: pre-wrap'>{python}</pre>"
        self.notes.object = "".join(f"<p role=status>{escape(text)}</p>" for text in notes.texts)

    def _curve(self, predictions: Mapping[str, wl.Prediction], conditions: Mapping[str, Any]) -> list[wl.FigureData]:
        """Return the figure of wear over creepage, with points for the present; none if the creepage has no slider."""
        creepage = self.subject.rig.creepage
        if creepage not in self.sliders:
            return []
        along = self.sliders[creepage]
        x = np.linspace(along.start, along.end, CURVE)
        there = {**conditions, creepage: wl.Q(x, along.unit)}
        predicted = self.subject.predict(self.model.value, [*predictions], there, Notes())
        curves = [
            wl.Curve(law, x, largest(prediction), colour=number)
            for number, (law, prediction) in enumerate(predicted.items())
        ]
        now = np.array([largest(prediction) for prediction in predictions.values()])
        point = wl.Curve("now", np.full(now.shape, along.value), now, colour=BLACK, points=True)
        panel = wl.Panel(wl.PlotAxis(along.label), wl.PlotAxis(label("wear_rate")), (*curves, point))
        several = any(prediction.problem.dims for prediction in predictions.values())
        of = ", the largest of the patches" if several else ""
        return [wl.FigureData("curve", f"wear over {name_of(creepage)}{of}", (panel,))]

    def _profiles(self, predictions: Mapping[str, wl.Prediction]) -> Iterable[wl.FigureData]:
        """Return the figures of a rig with profiles, such as a wheelset."""
        resolved = {law: prediction for law, prediction in predictions.items() if prediction.scale == "cells"}
        draw = getattr(self.subject.rig, "profile_figures", None)
        return draw(resolved) if draw and resolved else ()

    def _draw(self, figures: Iterable[wl.FigureData]) -> None:
        """Show each panel as a figure of its own, which has room on a phone."""
        shown = []
        for figure in figures:
            for number, panel in enumerate(figure.panels):
                name = f"{figure.name}_{number}"
                if name not in self.panes:
                    look: dict[str, Any] = {"config": {"displayModeBar": False}, "styles": WIDE, **STRETCHED}
                    look["stylesheets"] = [MAPS]
                    self.panes[name] = pn.pane.Plotly(name=name, **look)
                drawn = plotly_figure(replace(figure, panels=(replace(panel, title=panel.title or figure.title),)))
                listed = len(panel.curves) > 1
                margin = {"l": 60, "r": 10, "t": 30, "b": 90 if listed else 50}
                look = {"height": 280, "margin": margin, "showlegend": listed, "template": "none", "font": {"size": 10}}
                look |= {"paper_bgcolor": "rgba(0,0,0,0)", "plot_bgcolor": "rgba(0,0,0,0)"}
                below = {"orientation": "h", "yref": "container", "y": 0, "yanchor": "bottom"}
                self.panes[name].object = {**drawn, "layout": {**drawn["layout"], **look, "legend": below}}
                shown.append(self.panes[name])
        self.figures[:] = shown


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
        If `predict` is no pipeline, or a condition is wrong.
    """
    expect_pipeline(predict)
    pn.extension("plotly", inline=True)
    models = {predict.contact_model: code_of(predict.contact_model, "predict.contact_model")}
    laws, stages = (
        {part: code_of(part, code) for part, code in numbered(f"predict.{name}", parts).items()}
        for name, parts in (("laws", predict.laws), ("stages", predict.stages))
    )
    return Page(
        Subject(predict.rig, code_of(predict.rig, "predict.rig"), "", models, laws, stages), conditions
    ).layout()


@click.command("explore")
@click.argument("rig", default="wheel_rail", shell_complete=completed("rig", "case"))
@click.option("--law", "laws", metavar="LAW", multiple=True, shell_complete=completed(*LAWS),
              help="Wear law to start with: its name or TOML file.")  # fmt: skip
@click.option("--set", "conditions", metavar="CONDITION=VALUE", multiple=True, help="Start value of a condition.")
@click.option("--port", type=click.IntRange(0, 65535), default=0, help="Port of the page [default: a free one].")
@click.option("--browser/--no-browser", default=True, help="Whether to open a browser.")
def command(rig: str, laws: tuple[str, ...], conditions: tuple[str, ...], port: int, browser: bool) -> None:
    """Explore a rig on a local page: RIG is an installed rig, such as wheelset, or a case.

    \b
    wearlaw explore
    wearlaw explore twin_disc --set "normal_force=7 kN" --set creepage=1%
    wearlaw explore my-case.toml
    wearlaw explore wheel_rail --law fit/law.toml

    An installed rig has example values. A case brings its own rig, models and laws. The page needs no network; Ctrl-C
    ends it.
    """  # noqa: D301
    pn.extension("plotly")
    subject, start = named(rig, laws), values("--set", conditions)

    def opened() -> Any:
        document: Any = pn.state.curdoc
        document.js_on_event("document_ready", CustomJS(code=SCREEN))
        return Page(subject, start).layout()

    Page(subject, start)  # an error before the server starts
    token = token_urlsafe(16)  # other programs and pages cannot guess it
    look: dict[str, Any] = {"show": False, "verbose": False, "title": {token: f"wearlaw: {subject.rig.name}"}}
    try:
        server: Any = pn.serve({token: opened}, port=port, address="localhost", start=False, use_index=False, **look)
    except OSError as error:  # another program uses it, or only the system may
        hint = "choose another, or leave --port out for a free one"
        raise click.ClickException(f"--port: cannot use {port}: {reason_of(error)}; {hint}") from None
    server._tornado.add_handlers(rf"(?!{LOCAL}$).*", [(".*", Refused)])
    address = f"http://localhost:{server.port}/{token}"
    click.echo(f"The page is at {address}; end it with Ctrl-C")
    if browser:
        server.io_loop.add_callback(webbrowser.open, address)
    server.run_until_shutdown()


class Refused(RequestHandler):
    """Answers to a name of this computer that a page elsewhere has given it."""

    def prepare(self) -> None:
        """Refuse every request."""
        raise HTTPError(403)


def named(rig: str, chosen: Iterable[str] = ()) -> Subject:
    """Return an installed rig with example values, or that of a case with its models and laws; with chosen laws."""
    laws = {}
    for name in chosen:
        read = wl.read_law if is_law_file(name) else wl.wear_law
        laws[read(name)] = f"wl.{read.__name__}({name!r})"
    installed = loader.discovered()
    if rig in installed["rig"]:
        rig_type = installed.find("rig", rig)
        arguments = "".join(f", {name}={text!r}" for name, text in rig_type.example_fields.items())
        return Subject(
            wl.rig(rig, **rig_type.example_fields), "rig", f"rig = wl.rig({rig!r}{arguments})", own_laws=laws
        )
    case = load_case(rig)
    models, wear_laws, stages = (
        numbered(f"case.{name}", getattr(case, name)) for name in ("contact_models", "wear_laws", "stages")
    )
    return Subject(case.rig, "case.rig", f"case = wl.load_case({rig!r})", models, {**wear_laws, **laws}, stages)
