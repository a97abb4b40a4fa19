"""The command that opens the page."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any

import click
import panel as pn
from bokeh.models import CustomJS

import wearlaw as wl
from wearlaw.plugins.law_files import is_law_file
from wearlaw_explore._answer import Subject
from wearlaw_explore._page import Page
from wearlaw_output.commands import echo, values
from wearlaw_studies.case import load_case

VIEWPORT = """document.head.insertAdjacentHTML("beforeend",
    '<meta name="viewport" content="width=device-width, initial-scale=1">')"""
"""JavaScript that makes the page as wide as the screen of a phone."""


@click.command()
@click.argument("rig", default="wheel_rail")
@click.option("--law", "laws", metavar="LAW", multiple=True, help="Wear law to start with: its name or TOML file.")
@click.option("--set", "conditions", metavar="CONDITION=VALUE", multiple=True, help="Start value of a condition.")
@click.option("--port", default=0, help="Port of the page [default: a free one].")
@click.option("--browser/--no-browser", default=True, help="Whether to open a browser.")
def explore(rig: str, laws: tuple[str, ...], conditions: tuple[str, ...], port: int, browser: bool) -> None:
    """Explore a rig on a local page: RIG is an installed rig or a case.

    \b
    wearlaw explore
    wearlaw explore twin_disc --set "normal_force=7 kN" --set creepage=1%
    wearlaw explore my-case.toml
    wearlaw explore wheel_rail --law fit/law.toml

    An installed rig has example values. A case brings its own rig, models and laws. The page needs no network; Ctrl-C
    ends it.
    """  # noqa: D301
    subject = named(rig, laws)
    start = values("--set", conditions)
    Page(subject, start)  # an error before the server starts
    server: Any = pn.serve(
        lambda: _served(subject, start), port=port, address="localhost", show=browser, start=False, verbose=False,
        title=f"wearlaw: {subject.rig.name}",
    )  # fmt: skip
    echo(f"The page is at http://localhost:{server.port}; end it with Ctrl-C")
    server.run_until_shutdown()


def _served(subject: Subject, start: dict[str, str | float]) -> Any:
    page_document: Any = pn.state.curdoc
    page_document.js_on_event("document_ready", CustomJS(code=VIEWPORT))
    return Page(subject, start).layout


def named(rig: str, chosen: Sequence[str] = ()) -> Subject:
    """Return an installed rig with example values, or that of a case with its models and laws; with chosen laws."""
    more = dict(map(_law, chosen))
    found = wl.rigs().get(rig)
    if found is not None:
        given = "".join(f", {name}={text!r}" for name, text in found.example_fields.items())
        return Subject(wl.rig(rig, **found.example_fields), f'wl.rig("{rig}"{given})', own_laws=more)
    case = load_case(rig)
    models = {f"case.contact_models[{i}]": model for i, model in enumerate(case.contact_models)}
    laws = {f"case.wear_laws[{i}]": law for i, law in enumerate(case.wear_laws)}
    stages = {f"case.stages[{i}]": stage for i, stage in enumerate(case.stages)}
    return Subject(case.rig, "case.rig", f"case = wl.load_case({rig!r})\n", models, {**laws, **more}, stages)


def _law(name: str) -> tuple[str, wl.WearLaw]:
    """Return the Python that makes a law of a name or a file, and the law."""
    function = "read_law" if is_law_file(name) else "wear_law"
    return f"wl.{function}({json.dumps(name, ensure_ascii=False)})", getattr(wl, function)(name)
