"""A new plugin to start from: a small distribution that passes its own tests as generated."""

from __future__ import annotations

import datetime
import keyword
import os
import re
from collections.abc import Iterator
from dataclasses import dataclass
from importlib import resources
from pathlib import Path
from string import Template
from typing import Any, Literal, TypeAlias

from packaging.utils import canonicalize_name

from wearlaw.errors import InputError, OutputError
from wearlaw.output.folder import fresh_folder
from wearlaw.plugins import loader
from wearlaw.plugins.shelf import Shelf
from wearlaw.version import __version__

Kind: TypeAlias = Literal["wear_law", "contact_model", "rig"]
"""What the plugin provides."""

Licence: TypeAlias = Literal["bsd-3-clause", "mit", "none"]
"""The licence of the plugin; "none" leaves the choice for later."""

_SPDX = {"bsd-3-clause": "BSD-3-Clause", "mit": "MIT"}

_NAME = re.compile(r"[a-z][a-z0-9]*(_[a-z0-9]+)*")

LONGEST_NAME = 24
"""So that the lines of the generated files keep their length."""


@dataclass(frozen=True)
class _Example:
    text: str
    pipeline: str
    conditions: str = 'max_pressure="1500 MPa", creepage="1 %", friction_coefficient=0.46'


_EXAMPLES: dict[Kind, _Example] = {
    "wear_law": _Example("Archard's law", 'wl.TwinDisc.suros() | wl.contact_model("exact") | wl.wear_law("{}")'),
    "contact_model": _Example("full slip", 'wl.TwinDisc.suros() | wl.contact_model("{}") | wl.wear_law("usfd")'),
    "rig": _Example(
        "a weight on two rollers",
        'wl.rig("{}") | wl.contact_model("exact") | wl.wear_law("kth")',
        'mass="20 kg", creepage="1 %", friction_coefficient=0.4',
    ),
}


def write_plugin(name: str, kind: Kind, parent: Path, licence: Licence = "none") -> Path:
    """Write a new distribution with one plugin, whole or not at all.

    Parameters
    ----------
    name : str
        The name of the wear law, contact model or rig.
    kind : {"wear_law", "contact_model", "rig"}
        What the plugin provides.
    parent : Path
        The folder in which the new folder is made.
    licence : {"bsd-3-clause", "mit", "none"}
        The licence of the plugin.

    Returns
    -------
    Path
        The new folder, ``parent/wearlaw-NAME``.

    Raises
    ------
    InputError
        If the name cannot be used or is taken.
    OutputError
        If the folder exists, or cannot be written.
    """
    _check_name(name)
    folder = parent / f"wearlaw-{name}"
    if os.path.lexists(folder):
        raise OutputError(f"output: '{folder}' exists and is left as it is; choose another parent folder with -o")
    contents = _files(name, kind, licence)
    with fresh_folder(folder) as fresh:
        _write(contents, fresh)
    return folder


def _class_name(name: str) -> str:
    """Return the name of the class that implements a model: TwoSlopes for two_slopes."""
    return "".join(word.capitalize() for word in name.split("_"))


def _check_name(name: str) -> None:
    if not _NAME.fullmatch(name) or keyword.iskeyword(name):
        raise InputError(
            f"name: must be a Python name of lower-case letters, digits and single underscores between them,"
            f" such as 'zobory', got {name!r}"
        )
    if len(name) > LONGEST_NAME:
        raise InputError(f"name: must have at most {LONGEST_NAME} characters, got {len(name)}: {name!r}")
    made = _class_name(name)
    if made.startswith("Test") or made in {"None", "True", "False", "Any", "Check", "ClassVar", "Field", "Mapping"}:
        raise InputError(f"name: {name!r} would name its class {made}, which means something else; choose another")
    for taker in _takers(name):
        raise InputError(f"name: '{name}' is taken by {taker}; choose another")


def _takers(name: str) -> Iterator[str]:
    """Yield what already has a name, where a look-up would confuse the two.

    `wearlaw show` and `check` take rigs, contact models, wear laws and parameter sets alike, and a wear law hides the
    parameter set of its name. Materials and cases are looked up apart. A distribution replaces that of its name.
    """
    found = loader.installed()
    shelves: list[Shelf[Any]] = [found.wear_laws, found.contact_models, found.rigs, found.parameter_sets]
    for shelf in shelves:
        if name in shelf.providers:
            yield f"the {shelf.kind} of {shelf.origin(name)}"
    for origin in found.plugins:
        if origin.entry_point == name or canonicalize_name(origin.distribution) == canonicalize_name(f"wearlaw-{name}"):
            yield f"the plugin {origin}"


def _files(name: str, kind: Kind, licence: Licence) -> dict[str, str]:
    """Return the text of each file by its path."""
    example = _EXAMPLES[kind]
    values = {
        "name": name,
        "class_name": _class_name(name),
        "kind": kind.replace("_", " "),
        "example": example.text,
        "pipeline": example.pipeline.format(name),
        "conditions": example.conditions,
        "version": __version__,
        "year": str(datetime.datetime.now(tz=datetime.UTC).year),
        "licence": f'license = "{_SPDX[licence]}"\n' if licence in _SPDX else "",
    }
    templates = {
        "pyproject.toml": "pyproject.toml.in",
        f"wearlaw_{name}.py": f"{kind}/module.py.in",
        f"test_{name}.py": f"{kind}/test.py.in",
        "README.md": "README.md.in",
        "LICENSE": f"licences/{licence}.in",
        ".gitignore": "gitignore.in",
        ".github/workflows/tests.yml": "tests.yml.in",
    }
    return {path: _filled(template, values) for path, template in templates.items()}


def _write(contents: dict[str, str], folder: Path) -> None:
    try:
        for path, text in contents.items():
            (folder / path).parent.mkdir(parents=True, exist_ok=True)
            (folder / path).write_text(text, encoding="utf-8")
    except OSError as error:
        raise OutputError(f"output: cannot write the plugin: {error.strerror or error}") from None


def _filled(template: str, values: dict[str, str]) -> str:
    text = resources.files(__name__).joinpath("templates", template).read_text(encoding="utf-8")
    return Template(text).substitute(values)
