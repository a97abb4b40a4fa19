"""What `wearlaw show` says of everything that plugins provide: models, and materials, cases, test sets and sections."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

from wearlaw.cli.describe import describe, fields_of, wrapped
from wearlaw.contact.material import Material
from wearlaw.errors import InputError, UnknownModelError
from wearlaw.hookspecs import Command
from wearlaw.plugins import loader
from wearlaw.plugins.shelf import unknown
from wearlaw.settings.toml_files import parse_toml
from wearlaw.study.case import load_case
from wearlaw.wear_tests.reader import parse_tests

OTHERS = "model, material, case, test set or section"
"""The things that can be shown, in the message for an unknown name."""


def explain(name: str) -> str:
    """Return the descriptions of everything with a name, separated by blank lines.

    Raises
    ------
    UnknownModelError
        If there is nothing of that name, or two distributions provide a thing of one kind.
    """
    found = loader.installed()
    shelves = [shelf for shelf in found.shelves() if name in shelf.providers]
    if not shelves:
        known = dict.fromkeys(one for shelf in found.shelves() for one in shelf.items())
        raise UnknownModelError(unknown(OTHERS, name, known, found.broken))
    return "\n\n".join(_explained(shelf.kind, name, shelf.find(name, found.broken)) for shelf in shelves)


def _explained(kind: str, name: str, item: Any) -> str:
    if kind == "parameter set":
        return describe(type(item), name)
    tell = _TELL.get(kind)
    if tell is None:
        return describe(item)
    head = f"{name}: a {kind} of {loader.installed().of_kind(kind).origin(name)}"
    return "\n".join([head, "", *tell(name, item)])


def _material(name: str, material: Material) -> Iterator[str]:
    yield (inspect.getdoc(type(material)) or "").partition("\n\n")[0]  # the rest is for authors of classes
    yield from ("", "fields:", *fields_of(type(material), material))
    yield from ("", f'In a case: material = "{name}". In Python: wl.material("{name}").')


def _material_type(name: str, cls: type[Material]) -> Iterator[str]:
    yield inspect.getdoc(cls) or ""
    yield from ("", "fields:", *fields_of(cls, None))
    yield from ("", f'In a case: material = {{type = "{name}", ...}} with these fields.')


def _case(name: str, _: str) -> Iterator[str]:
    case = load_case(name)
    yield case.title
    yield ""
    yield f"rig: {case.rig.name}"
    yield from wrapped("contact models: ", ", ".join(case.contact_models_by_label))
    yield from wrapped("laws: ", ", ".join(case.laws_by_label))
    for sweep, grid in case.sweeps.items():
        axes = [f"{count} values of {axis}" for axis, count in grid.axes().items()]
        yield f"sweep {sweep}: {' × '.join(axes) or 'one operating point'}"
    for kind, names in (("profiles", case.profiles), ("uncertainty", case.uncertainty), ("sections", case.sections)):
        if names:
            yield from wrapped(f"{kind}: ", ", ".join(names))
    if case.measured is not None:
        yield f"measured: {case.measured.tests}"
    yield from ("", f"wearlaw run {name} runs it, and wearlaw case {name} prints its file to edit.")


def _test_set(name: str, text: str) -> Iterator[str]:
    for line in text.splitlines():
        if line.startswith("#"):
            yield line.removeprefix("#").strip()
    tests = parse_tests(text, name)
    head, *_ = (line for line in text.splitlines() if not line.startswith("#"))
    yield from ("", f"tests: {len(tests)}", f"columns: {head}")
    yield from ("", f'In a case: measured = {{label = "Tests", tests = "{name}"}}. In Python: wl.read_tests("{name}").')


def _section(name: str, make: Callable[..., Any]) -> Iterator[str]:
    while isinstance(make, partial):
        make = make.func
    documented = inspect.getdoc(make)
    if documented:
        yield from (documented, "")
    yield f'A case adds it to its report with sections = ["{name}"].'
    cases = loader.installed().cases.items()
    users = [case for case, text in cases.items() if name in _sections(text)]
    if users:
        yield f"Shipped cases with it: {', '.join(users)}"


def _command(name: str, command: Command) -> Iterator[str]:
    yield command.help
    yield from ("", f"wearlaw {name} --help lists its options.")


def _sections(text: str) -> list[str]:
    """Return the sections of a case file, none if it is not valid TOML."""
    try:
        named: list[str] = parse_toml(text).get("sections", [])
    except InputError:
        return []
    return named


_TELL: dict[str, Callable[[str, Any], Iterator[str]]] = {
    "material": _material,
    "material type": _material_type,
    "case": _case,
    "test set": _test_set,
    "section": _section,
    "command": _command,
}
"""What makes the lines of the kinds that are no models."""
