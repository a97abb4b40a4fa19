"""The conformance kit: the rules for every rig, contact model and wear law, and strategies for testing your own code.

`checks` yields the checks of a model, `conformance` makes pytest tests of them. The strategies are also what
hypothesis draws from for arguments typed `Problem` and `Contact`.
"""

from collections.abc import Iterable
from importlib import import_module
from typing import TYPE_CHECKING

import wearlaw as wl

if TYPE_CHECKING:
    from wearlaw_kit.kit import Check, checks, conformance
    from wearlaw_kit.strategies import (
        contacts,
        elliptic_problems,
        line_problems,
        problems,
    )

__all__ = [
    "Check",
    "checks",
    "conformance",
    "contacts",
    "elliptic_problems",
    "line_problems",
    "problems",
]


def __getattr__(name: str) -> object:
    """Return a public name. Its module is imported at its first use: looking up the plugin needs none."""
    if name in ("Check", "checks", "conformance"):
        return getattr(import_module("wearlaw_kit.kit"), name)
    if name not in __all__:
        raise AttributeError(f"module 'wearlaw_kit' has no attribute {name!r}")
    try:
        return getattr(import_module("wearlaw_kit.strategies"), name)
    except ModuleNotFoundError as error:
        if error.name != "hypothesis":
            raise
        message = f'wearlaw_kit.{name} needs hypothesis; install it with: pip install "wearlaw[check]"'
        raise ModuleNotFoundError(message, name=error.name) from error


@wl.hookimpl
def wearlaw_commands() -> Iterable[wl.Command]:
    """Return the commands of this plugin."""
    return [
        wl.Command("check", "wearlaw_kit.commands:check", "Check that a model keeps what wearlaw relies on."),
        wl.Command("new-plugin", "wearlaw_kit.commands:new_plugin", "Write a small plugin to start from."),
    ]
