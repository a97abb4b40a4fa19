"""What `wearlaw show` says of cases and of sections of reports."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

from wearlaw import loader
from wearlaw.text_files import parse_toml
from wearlaw_apps.studies.case import load_case


def explain_case(name: str, _: str) -> Iterator[str]:
    """Yield the lines of `wearlaw show` for a case, whose file says the rest."""
    yield from (load_case(name).title, "")
    yield f"wearlaw case {name} prints its file, with its rig, models and sweeps, and wearlaw run {name} runs it."


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
