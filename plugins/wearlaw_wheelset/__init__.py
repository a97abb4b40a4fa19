"""Wheelsets on track: profiles of wheels and rails."""

import wearlaw as wl
from wearlaw_wheelset._profile import Profile, read_profile, write_profile

__all__ = ["Profile", "read_profile", "write_profile"]


@wl.hookimpl
def wearlaw_rigs() -> list[type[wl.Rig]]:
    """Return the rigs of this plugin."""
    return []
