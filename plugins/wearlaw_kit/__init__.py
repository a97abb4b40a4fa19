"""The conformance kit: checks of models, and strategies for tests of your own.

`checks` yields the checks of a model, `conformance` makes pytest tests of them. The strategies are also what
hypothesis draws from for arguments typed `Problem` and `Contact`.
"""

from collections.abc import Iterable
from typing import TYPE_CHECKING

import wearlaw as wl
from wearlaw.late import face

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


__getattr__ = face(
    "wearlaw_kit",
    {
        "wearlaw_kit.kit": ("Check", "checks", "conformance"),
        "wearlaw_kit.strategies": ("contacts", "elliptic_problems", "line_problems", "problems"),
    },
)


@wl.hookimpl
def wearlaw_commands() -> Iterable[wl.Command]:
    """Return the commands of this plugin."""
    return [
        wl.Command("check", "wearlaw_kit.commands:check", "Check that a model keeps what wearlaw relies on."),
        wl.Command("new-plugin", "wearlaw_kit.commands:new_plugin", "Write a small plugin to start from."),
    ]
