"""Checking that an argument is of its type."""

from __future__ import annotations

import os
from typing import Any

from wearlaw.errors import InputError
from wearlaw.units.quantities import shortened


def expect(kind: Any, value: object, name: str, wanted: str) -> None:
    """Raise an `InputError` that names the argument unless its value is of a type.

    Parameters
    ----------
    kind : type or union of types
        The type.
    value : object
        The value, which may be anything. Nothing is asked of it, since to compare or hash it could fail.
    name : str
        The argument.
    wanted : str
        What it must be, as in "a name, such as 'wheel'".
    """
    if not isinstance(value, kind):
        raise InputError(f"{name}: must be {wanted}; got {shortened(value)}")


def expect_path(value: object, name: str, of: str) -> None:
    """Raise an `InputError` that names the argument unless its value is a path; `of` says of what."""
    expect(str | os.PathLike, value, name, f"the path of {of}")
