"""Laws in TOML files: a table of the law, and one of the provenance of its parameters."""

from __future__ import annotations

import os
from pathlib import Path

from wearlaw.errors import ConfigurationError, InputError, shown, with_problems
from wearlaw.models.law import Law
from wearlaw.plugins import loader
from wearlaw.settings.text_files import read_toml


def is_law_file(name: str) -> bool:
    """Return whether the name of a law is the path of a file of a law, such as "fit/law.toml"."""
    return name.endswith(".toml")


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
    contents = read_toml("law", path)
    fields = contents.get("wear_law", contents.get("law"))
    if not isinstance(fields, dict) or not isinstance(fields.get("model"), str):
        raise InputError(
            f'law {shown(Path(path))} needs a table [wear_law] with the name of the law, as in model = "usfd"'
        )
    try:
        return loader.law(fields.pop("model"), **fields)
    except ConfigurationError as error:
        raise InputError(with_problems(f"law {shown(Path(path))} is wrong in:", error.problems)) from None
