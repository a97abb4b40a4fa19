"""Wheelsets on track as a wearlaw plugin: profiles of wheels and rails, where they touch, and their wear."""

import wearlaw as wl
from wearlaw_wheelset._geometry import Geometry
from wearlaw_wheelset._profile import Profile, read_profile, write_profile
from wearlaw_wheelset._rig import Wheelset

__all__ = ["Geometry", "Profile", "Wheelset", "read_profile", "write_profile"]


@wl.hookimpl
def wearlaw_rigs() -> list[type[wl.Rig]]:
    """Return the rig of this plugin."""
    return [Wheelset]
