"""A new plugin to start from: a small distribution that passes its own tests as generated."""

from __future__ import annotations

import datetime
import keyword
import os
import re
import shutil
from collections.abc import Iterator
from dataclasses import dataclass
from importlib import resources
from pathlib import Path
from string import Template
from typing import Any, Literal, TypeAlias

from packaging.utils import canonicalize_name

from wearlaw.errors import InputError, OutputError, quoted, shortened
from wearlaw.plugins import loader
from wearlaw.plugins.shelf import Shelf
from wearlaw.version import __version__

Kind: TypeAlias = Literal["wear_law", "law", "contact_model", "stage", "rig", "material"]
"""What the plugin provides."""

Licence: TypeAlias = Literal["bsd-3-clause", "mit", "none"]
"""The licence of the plugin; "none" leaves the choice for later."""

_SPDX = {"bsd-3-clause": "BSD-3-Clause", "mit": "MIT"}

_NAME = re.compile(r"[a-z][a-z0-9]*(_[a-z0-9]+)*")

LONGEST_NAME = 24
"""So that the lines of the generated files keep their length."""

RESERVED = {"None", "True", "False", "Annotated", "Any", "ArrayLike", "Check", "ClassVar", "Field", "Force", "Mapping"}
"""Names that generated files use, which no class of a plugin can have."""


@dataclass(frozen=True)
class Example:
    """What a kind of plugin starts from.

    Attributes
    ----------
    text : str
        What the generated module holds, in words.
    pipeline : str
        A pipeline with the model; "{}" stands for its name.
    conditions : str
        Conditions of that pipeline.
    next_commands : tuple of str
        Commands that tell more about the installed plugin.
    """

    text: str
    pipeline: str
    conditions: str = 'max_pressure="1500 MPa", creepage="1 %", friction_coefficient=0.46'
    next_commands: tuple[str, ...] = ("wearlaw show {}", "wearlaw check {}")


EXAMPLES: dict[Kind, Example] = {
    "wear_law": Example("Archard's law", 'wl.TwinDisc.suros() | wl.contact_model("exact") | wl.wear_law("{}")'),
    "law": Example("fatigue damage of the patch", 'wl.TwinDisc.suros() | wl.contact_model("exact") | wl.law("{}")'),
    "contact_model": Example("full slip", 'wl.TwinDisc.suros() | wl.contact_model("{}") | wl.wear_law("usfd")'),
    "stage": Example(
        "friction lowered by a factor",
        'wl.TwinDisc.suros() | wl.contact_model("exact") | wl.stage("{}", factor=0.5)',
        next_commands=("wearlaw show {}", "wearlaw check {} --option factor=0.5"),
    ),
    "rig": Example(
        "a weight on two rollers",
        'wl.rig("{}") | wl.contact_model("exact") | wl.wear_law("kth")',
        'mass="20 kg", creepage="1 %", friction_coefficient=0.4',
    ),
    "material": Example(
        "a steel with its hardness",
        'wl.TwinDisc.suros(material=wl.material("{}")) | wl.contact_model("exact")',
        next_commands=("wearlaw plugins",),
    ),
}
"""What each kind of plugin starts from."""


def write_plugin(name: str, kind: Kind, parent: Path, licence: Licence = "none") -> Path:
    """Write a new distribution with one plugin, whole or not at all.

    Parameters
    ----------
    name : str
        The name of the model or material.
    kind : {"wear_law", "law", "contact_model", "stage", "rig", "material"}
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
    _check_name(name, kind)
    folder = parent / f"wearlaw-{name}"
    if os.path.lexists(folder):
        raise OutputError(f"output: {quoted(folder)} exists and is left as it is; choose another parent folder with -o")
    _write(_files(name, kind, licence), folder)
    return folder


def next_commands(name: str, kind: Kind) -> list[str]:
    """Return the commands that tell more about an installed plugin."""
    return [command.format(name) for command in EXAMPLES[kind].next_commands]


def _class_name(name: str) -> str:
    """Return the name of the class that implements a model: TwoSlopes for two_slopes."""
    return "".join(word.capitalize() for word in name.split("_"))


def _check_name(name: str, kind: Kind) -> None:
    if not _NAME.fullmatch(name) or keyword.iskeyword(name):
        raise InputError(
            f"name: must be a Python name of lower-case letters, digits and single underscores between them,"
            f" such as 'zobory', got {shortened(name)}"
        )
    if len(name) > LONGEST_NAME:
        raise InputError(f"name: must have at most {LONGEST_NAME} characters, got {len(name)}: {shortened(name)}")
    made = _class_name(name)
    if made.startswith("Test") or made in RESERVED:
        raise InputError(f"name: {name!r} would name its class {made}, which means something else; choose another")
    for taker in _takers(name, kind):
        raise InputError(f"name: {quoted(name)} is taken by {taker}; choose another")


def _takers(name: str, kind: Kind) -> Iterator[str]:
    """Yield what already has a name, where a look-up would confuse the two.

    `wearlaw show` takes models of all kinds and parameter sets alike, and a wear law hides the parameter set of its
    name. Materials and cases are looked up apart. A distribution replaces that of its name.
    """
    found = loader.installed()
    models = (found.wear_laws, found.contact_models, found.rigs, found.stages, found.laws, found.parameter_sets)
    names: list[tuple[Shelf[Any], str]] = [(shelf, name) for shelf in models]
    if kind == "material":
        names = [(found.materials, name), (found.material_types, _class_name(name))]
    for shelf, known in names:
        if known in shelf.providers:
            yield f"the {shelf.kind} of {shelf.origin(known)}"
    for origin in found.plugins:
        if origin.entry_point == name or canonicalize_name(origin.distribution) == canonicalize_name(f"wearlaw-{name}"):
            yield f"the plugin {origin}"


def _files(name: str, kind: Kind, licence: Licence) -> dict[str, str]:
    """Return the text of each file by its path."""
    example = EXAMPLES[kind]
    values = {
        "name": name,
        "class_name": _class_name(name),
        "kind": kind.replace("_", " "),
        "example": example.text,
        "pipeline": example.pipeline.format(name),
        "conditions": example.conditions,
        "commands": "\n".join(next_commands(name, kind)),
        "checks": ", and runs the conformance checks of wearlaw" if "check" in example.next_commands[-1] else "",
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
        shutil.rmtree(folder, ignore_errors=True)
        raise OutputError(f"output: cannot write the plugin: {error.strerror or error}") from None


def _filled(template: str, values: dict[str, str]) -> str:
    text = resources.files(__name__).joinpath("templates", template).read_text(encoding="utf-8")
    return Template(text).substitute(values)
