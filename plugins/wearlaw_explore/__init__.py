"""A page to explore a rig, as a wearlaw plugin: sliders for its conditions, menus of models, and live figures."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import wearlaw as wl

if TYPE_CHECKING:
    from wearlaw_explore._page import explore

__all__ = ["explore"]


def __getattr__(name: str) -> Any:
    if name not in __all__:
        raise AttributeError(f"module 'wearlaw_explore' has no attribute {name!r}")
    from wearlaw_explore import _page  # needs panel, which looking up a plugin must not load

    return getattr(_page, name)


@wl.hookimpl
def wearlaw_commands() -> list[wl.Command]:
    """Return the command that opens the page."""
    return [wl.Command("explore", "wearlaw_explore._command:explore", "Explore a rig on a local page.")]
