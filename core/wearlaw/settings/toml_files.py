"""Reading TOML from outside."""

from __future__ import annotations

import tomllib
from typing import Any

from wearlaw.errors import InputError
from wearlaw.settings.text_files import MIB

LARGEST = MIB
"""Size of the largest TOML file that is read [bytes]."""


def parse_toml(text: str) -> dict[str, Any]:
    """Return the contents of a text in TOML.

    Raises
    ------
    InputError
        If it is not TOML; the message follows the name of the file.
    """
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise InputError(f"is not valid TOML: {error}") from None
