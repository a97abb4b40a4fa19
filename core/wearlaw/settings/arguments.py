"""Checking that an argument is of its type."""

from __future__ import annotations

from typing import Any

from wearlaw.errors import InputError, shown


def expect(kind: Any, value: object, name: str, wanted: str) -> None:
    """Raise an `InputError` that names the argument unless its value is of a type.

    Parameters
    ----------
    kind : type or union of types
        The type.
    value : object
        The value.
    name : str
        The argument.
    wanted : str
        What it must be, as in "a name, such as 'wheel'".
    """
    if not isinstance(value, kind):
        raise InputError(f"{name}: must be {wanted}; got {shown(value)}")


def expect_names(value: object, name: str, example: str, least: int = 1) -> list[str]:
    """Return an argument that is a list of names, at least so many, or raise an `InputError` that names it."""
    try:
        found: Any = None if isinstance(value, str) else list(value)  # type: ignore[call-overload]
    except TypeError:
        found = None
    if found is None or len(found) < least or not all(isinstance(one, str) for one in found):
        raise InputError(f'{name}: must be a list of names, such as ["{example}"], got {shown(value)}')
    names: list[str] = found
    return names
