"""Writing a fitted law into a TOML file."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any
from uuid import uuid4

import tomli_w

from wearlaw.errors import OutputError, shown
from wearlaw.models.law import Law
from wearlaw.plugins.fields import specification
from wearlaw.plugins.law_files import DIGESTS
from wearlaw.settings.text_files import reason_of


def write_law(path: str | os.PathLike[str], law: Law, provenance: Mapping[str, Any]) -> None:
    """Write a law to a TOML file, whole or not at all; `wearlaw.read_law` reads it.

    Raises
    ------
    OutputError
        If the file cannot be written.
    """
    target = Path(path)
    tests = {DIGESTS: list(law.fitted_to)} if law.fitted_to else {}
    text = tomli_w.dumps({law.kind.replace(" ", "_"): specification(law), "provenance": {**provenance, **tests}})
    temporary = target.parent / f".{uuid4().hex}"  # short, since the name of the file may be as long as names can be
    try:
        try:
            temporary.write_text(text, encoding="utf-8", newline="\n")
            os.replace(temporary, target)
        finally:
            temporary.unlink(missing_ok=True)
    except (OSError, ValueError) as error:
        raise OutputError(f"cannot write {shown(Path(path))}: {reason_of(error)}") from None
