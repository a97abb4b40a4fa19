"""What hypothesis draws for arguments typed `Problem` and `Contact`.

It stands beside the package, so that `import hypothesis` does not import wearlaw. Whichever of the two is imported
last has the types registered.
"""

from __future__ import annotations

import sys
from importlib import import_module
from types import ModuleType
from typing import Any

from hypothesis import strategies as st

STRATEGIES = {
    "Problem": "problems",
    "Contact": "contacts",
}
"""The public types, and the names of their strategies in `wearlaw_kit`."""


def register() -> None:
    """Register the types if wearlaw is imported already; the entry point of hypothesis."""
    if "wearlaw" in sys.modules:
        register_types(sys.modules["wearlaw"])


def register_types(wearlaw: ModuleType) -> None:
    """Register the types of the package; the strategies are imported when one is drawn from."""

    def resolver(name: str) -> Any:
        def draw_from(_: type[Any]) -> st.SearchStrategy[Any]:
            strategy: st.SearchStrategy[Any] = getattr(import_module("wearlaw_kit"), name)()
            return strategy

        return draw_from

    for cls, name in STRATEGIES.items():
        st.register_type_strategy(getattr(wearlaw, cls), resolver(name))
