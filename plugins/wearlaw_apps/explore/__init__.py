"""A page to explore a rig, with sliders and live figures."""

from __future__ import annotations

import wearlaw as wl


@wl.hookimpl
def wearlaw_commands() -> list[wl.Command]:
    """Return the command that opens the page."""
    return [wl.Command("explore", "wearlaw_apps.explore.page:command", "Explore a rig on a local page.")]
