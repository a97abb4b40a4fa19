"""Laws in TOML files: a table of the law, and one of the provenance of its parameters."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from wearlaw.errors import ConfigurationError, InputError, shown, with_problems
from wearlaw.models.law import Law, WearLaw
from wearlaw.plugins import loader
from wearlaw.settings.text_files import LARGEST, parse_toml, read_text, reason_of

DIGESTS = "digests_of_tests"
"""The entry of the provenance with the digests of the tests of a fit."""


def is_law_file(name: str) -> bool:
    """Return whether the name of a law is the path of a file of a law, such as "fit/law.toml"."""
    return name.endswith(".toml")


def read_toml(subject: str, path: str | os.PathLike[str]) -> dict[str, Any]:
    """Return the contents of a TOML file; errors name it by its subject.

    Raises
    ------
    InputError
        If the file is missing or is not TOML.
    """
    try:
        text = read_text(path, LARGEST)
    except (FileNotFoundError, InputError) as error:
        raise InputError(f"cannot read {subject} {shown(Path(path))}: {reason_of(error)}") from None
    try:
        return parse_toml(text)
    except InputError as error:
        raise InputError(f"{subject} {shown(Path(path))} {error}") from None


def read_wear_law(path: str | os.PathLike[str]) -> WearLaw:
    """Return the wear law of the table ``[wear_law]`` in a TOML file; see `read_law`."""
    found = read_law(path)
    if not isinstance(found, WearLaw):
        raise InputError(
            f"wear law {shown(Path(path))} holds law {shown(found.name)}, which predicts"
            f" {found.outcome.name} and no wear; read it with read_law"
        )
    return found


def read_law(path: str | os.PathLike[str]) -> Law:
    """Return the law of the table ``[wear_law]`` or ``[law]`` in a TOML file.

    Parameters
    ----------
    path : str or path-like
        A file such as `Fit.to_toml` writes: ``model`` names the law, and its fields follow.

    Raises
    ------
    InputError
        If the file is missing, is not TOML, or does not describe a law of an installed plugin.
    """
    contents = read_toml("wear law", path)
    kind = "law" if "law" in contents and "wear_law" not in contents else "wear_law"
    fields = contents.get(kind)
    if not isinstance(fields, dict) or not isinstance(fields.get("model"), str):
        raise InputError(
            f'wear law {shown(Path(path))} needs a table [wear_law] with the name of the law, as in model = "usfd"'
        )
    name = fields.pop("model")
    try:
        law = loader.law(name, **fields) if kind == "law" else loader.wear_law(name, **fields)
    except ConfigurationError as error:
        raise InputError(with_problems(f"wear law {shown(Path(path))} is wrong in:", error.problems)) from None
    provenance = contents.get("provenance")
    digests = provenance.get(DIGESTS) if isinstance(provenance, dict) else None
    return law.with_tests(map(str, digests)) if isinstance(digests, list) else law
