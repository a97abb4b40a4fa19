"""Reading TOML from outside: of bounded size and depth, so that no file takes long or ends in a deep recursion."""

from __future__ import annotations

import re
import tomllib
from typing import Any

from wearlaw.errors import InputError
from wearlaw.settings.text_files import MIB

LARGEST = MIB
"""Size of the largest TOML file that is read [bytes]."""

DEEPEST = 50
"""Most tables and lists inside each other, and most parts of a key."""

_PART = r"""(?:[\w-]+|"[^"\n]*"|'[^'\n]*')"""
_LONG_KEY = re.compile(rf"(?<![\w-]){_PART}(?:[ \t]*\.[ \t]*{_PART}){{{DEEPEST}}}")
"""A key of too many parts. `tomllib` takes a time that grows with the square of their number."""

_TOO_DEEP = f"is nested too deeply; {DEEPEST} tables and lists inside each other are the most"


def parse_toml(text: str) -> dict[str, Any]:
    """Return the contents of a text in TOML.

    Raises
    ------
    InputError
        If it is not TOML, is nested too deeply, or holds an integer or a character that results cannot hold.
        The message follows the name of the file.
    """
    long = _LONG_KEY.search(text)
    if long is not None:
        line = text.count("\n", 0, long.start()) + 1
        raise InputError(f"is wrong in line {line}: a key has more than {DEEPEST} parts between points")
    try:
        found = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise InputError(f"is not valid TOML: {error}") from None
    except ValueError:  # Python limits the digits of an integer
        raise InputError("is not valid TOML: an integer has thousands of digits") from None
    except RecursionError:
        raise InputError(_TOO_DEEP) from None
    _check(found)
    return found


def _check(contents: dict[str, Any]) -> None:
    """Check depth, integers and characters, without recursion."""
    left: list[tuple[tuple[str, ...], Any]] = [((), contents)]
    while left:
        path, value = left.pop()
        if len(path) > DEEPEST and isinstance(value, (dict, list)):
            raise InputError(_TOO_DEEP)
        fault = ""
        if isinstance(value, dict):
            left += [((*path, key), inner) for key, inner in value.items()]
            fault = "has a key with a null character" if any("\0" in key for key in value) else ""
        elif isinstance(value, list):
            left += [((*path, str(number)), inner) for number, inner in enumerate(value)]
        elif isinstance(value, str) and "\0" in value:
            fault = "has a null character, which files of results cannot hold"
        elif isinstance(value, int) and not -(2**63) <= value < 2**63:
            fault = "is an integer of more than 64 bits, which TOML does not have"
        if fault:
            raise InputError(f"is wrong in:\n  {'.'.join(path) or 'its top'}: {fault}")
