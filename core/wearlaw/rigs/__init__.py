"""The rigs that ship with wearlaw: a plugin like anyone's."""

from wearlaw.base_rig import Rig
from wearlaw.hookspecs import hookimpl
from wearlaw.rigs.twin_disc import TwinDisc
from wearlaw.rigs.wheel_rail import WheelRail


@hookimpl
def wearlaw_rigs() -> list[type[Rig]]:
    """Return the rigs of this plugin."""
    return [TwinDisc, WheelRail]
