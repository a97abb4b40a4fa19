"""What `wearlaw show` says of everything that plugins provide: models, and materials, cases, test sets and sections."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator
from typing import Any

from wearlaw.cli.describe import describe, fields_of
from wearlaw.contact.material import Material
from wearlaw.errors import UnknownModelError
from wearlaw.extras import load
from wearlaw.hookspecs import Command
from wearlaw.plugins import loader
from wearlaw.plugins.shelf import unknown

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
    found = loader.installed()
    tell = _TELL.get(kind)
    if kind in found.explanations:
        module, _, function = found.explanations[kind].partition(":")
        tell = load(module, function, f"wearlaw show {name}")
    if tell is None:
        return describe(item)
    head = f"{name}: a {kind} of {found.of_kind(kind).origin(name)}"
    return "\n".join([head, "", *tell(name, item)])


def _material(name: str, material: Material) -> Iterator[str]:
    yield (inspect.getdoc(type(material)) or "").partition("\n\n")[0]  # the rest is for authors of classes
    yield from ("", "fields:", *fields_of(type(material), material))
    yield from ("", f'In a case: material = "{name}". In Python: wl.material("{name}").')


def _material_type(name: str, cls: type[Material]) -> Iterator[str]:
    yield inspect.getdoc(cls) or ""
    yield from ("", "fields:", *fields_of(cls, None))
    yield from ("", f'In a case: material = {{type = "{name}", ...}} with these fields.')


def _command(name: str, command: Command) -> Iterator[str]:
    yield command.help
    yield from ("", f"wearlaw {name} --help lists its options.")


_TELL: dict[str, Callable[[str, Any], Iterator[str]]] = {
    "material": _material,
    "material type": _material_type,
    "command": _command,
}
"""What makes the lines of the kinds that are no models."""
