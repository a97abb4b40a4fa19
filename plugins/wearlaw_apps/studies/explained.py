"""What `wearlaw show` says of cases and of sections of reports."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

from wearlaw import loader
from wearlaw.text_files import parse_toml
from wearlaw_apps.show import wrapped
from wearlaw_apps.studies.case import load_case


def explain_case(name: str, _: str) -> Iterator[str]:
    """Yield the lines of `wearlaw show` for a case."""
    case = load_case(name)
    yield case.title
    yield ""
    yield f"rig: {case.rig.name}"
    yield from wrapped("contact models: ", ", ".join(case.contact_models_by_label))
    yield from wrapped("laws: ", ", ".join(case.laws_by_label))
    for sweep, grid in case.sweeps.items():
        axes = [f"{count} values of {axis}" for axis, count in grid.axes().items()]
        yield f"sweep {sweep}: {' × '.join(axes) or 'one operating point'}"
    for kind, names in (("profiles", case.profiles), ("sections", case.sections)):
        if names:
            yield from wrapped(f"{kind}: ", ", ".join(names))
    if case.measured is not None:
        yield f"measured: {case.measured.tests}"
    yield from ("", f"wearlaw run {name} runs it, and wearlaw case {name} prints its file to edit.")


def explain_section(name: str, make: Callable[..., Any]) -> Iterator[str]:
    """Yield the lines of `wearlaw show` for a section."""
    while isinstance(make, partial):
        make = make.func
    documented = inspect.getdoc(make)
    if documented:
        yield from (documented, "")
    yield f'A case adds it to its report with sections = ["{name}"].'
    cases = loader.discovered()["case"].items()
    users = [case for case, text in cases.items() if name in parse_toml(text).get("sections", [])]
    if users:
        yield f"Shipped cases with it: {', '.join(users)}"
