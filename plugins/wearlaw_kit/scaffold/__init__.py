"""A new plugin to start from: a small distribution that passes its own tests as generated."""

from __future__ import annotations

import keyword
import os
import re
from collections.abc import Iterator
from importlib import resources
from pathlib import Path
from string import Template
from typing import Literal, TypeAlias

from wearlaw import loader
from wearlaw.errors import InputError, OutputError, shown
from wearlaw.hookspecs import INTERFACE_VERSION
from wearlaw.version import __version__

Kind: TypeAlias = Literal["wear_law", "contact_model", "rig"]
"""What the plugin provides."""

EXAMPLES: dict[Kind, dict[str, str]] = {
    "wear_law": {
        "example": "Archard's law",
        "pipeline": 'wl.TwinDisc.suros() | wl.contact_model("exact") | wl.wear_law("{}")',
        "conditions": 'max_pressure="1500 MPa", creepage="1 %", friction_coefficient=0.46',
    },
    "contact_model": {
        "example": "full slip",
        "pipeline": 'wl.TwinDisc.suros() | wl.contact_model("{}") | wl.wear_law("usfd")',
        "conditions": 'max_pressure="1500 MPa", creepage="1 %", friction_coefficient=0.46',
    },
    "rig": {
        "example": "a weight on two rollers",
        "pipeline": 'wl.rig("{}") | wl.contact_model("exact") | wl.wear_law("kth")',
        "conditions": 'mass="20 kg", creepage="1 %", friction_coefficient=0.4',
    },
}
"""What the module of each kind holds as an example, and how its README uses it; "{}" stands for the name."""


def write_plugin(name: str, kind: Kind, parent: Path) -> Path:
    """Write a new distribution with one plugin.

    Parameters
    ----------
    name : str
        The name of the model.
    kind : {"wear_law", "contact_model", "rig"}
        What the plugin provides.
    parent : Path
        The folder in which the new folder is made.

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
    if not re.fullmatch(r"[a-z][a-z0-9]*(_[a-z0-9]+)*", name) or keyword.iskeyword(name):
        raise InputError(
            f"name: must be a Python name of lower-case letters, digits and single underscores between them,"
            f" such as 'zobory', got {shown(name)}"
        )
    for holder in _holders(name):
        raise InputError(f"name: {shown(name)} is taken by {holder}; choose another")
    folder = parent / f"wearlaw-{name}"
    if os.path.lexists(folder):
        raise OutputError(f"output: {shown(folder)} exists and is left as it is; choose another parent folder with -o")
    try:
        for path, text in _files(name, kind).items():
            (folder / path).parent.mkdir(parents=True, exist_ok=True)
            (folder / path).write_text(text, encoding="utf-8")
    except OSError as error:
        raise OutputError(f"output: cannot write to {shown(folder)}: {error.strerror or error}") from None
    return folder


def _holders(name: str) -> Iterator[str]:
    """Yield what already has a name, where a look-up or an entry point would confuse the two."""
    installed = loader.discovered()
    for kind in ("wear law", "contact model", "rig", "stage", "law", "parameter set"):
        if name in installed[kind]:
            yield f"the {kind} of {installed[kind].origin(name)}"
    for origin in installed.plugins:
        if origin.entry_point == name:
            yield f"the plugin {origin}"


def _files(name: str, kind: Kind) -> dict[str, str]:
    """Return the text of each file by its path."""
    values = {
        "name": name,
        "class_name": "".join(word.capitalize() for word in name.split("_")),
        "kind": kind.replace("_", " "),
        "version": __version__,
        "interface": str(INTERFACE_VERSION),
        **{key: text.format(name) for key, text in EXAMPLES[kind].items()},
    }
    templates = {
        "pyproject.toml": "pyproject.toml.in",
        f"wearlaw_{name}/__init__.py": f"{kind}/module.py.in",
        f"test_{name}.py": f"{kind}/test.py.in",
        "README.md": "README.md.in",
        ".github/workflows/tests.yml": "tests.yml.in",
    }
    folder = resources.files(__name__).joinpath("templates")
    texts = {
        path: Template(folder.joinpath(template).read_text(encoding="utf-8")).substitute(values)
        for path, template in templates.items()
    }
    return {**texts, f"wearlaw_{name}/py.typed": ""}
