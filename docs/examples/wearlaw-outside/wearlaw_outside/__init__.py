"""One of each kind of plugin from outside wearlaw."""

import wearlaw as wl
from wearlaw_outside.contact import Rigid
from wearlaw_outside.flash import Flash
from wearlaw_outside.law import MadeUp
from wearlaw_outside.material import MADE_UP_STEEL
from wearlaw_outside.rig import Weighted
from wearlaw_outside.stage import Wet

wearlaw_interface = 4


@wl.hookimpl
def wearlaw_models() -> list[type[wl.Rig | wl.ContactModel | wl.Stage | wl.Law]]:
    """Return the rig, the contact model, the stage and the laws of this plugin."""
    return [Weighted, Rigid, Wet, MadeUp, Flash]


@wl.hookimpl
def wearlaw_named() -> dict[str, wl.Material]:
    """Return the materials of this plugin by name."""
    return {"made_up_steel": MADE_UP_STEEL}


@wl.hookimpl
def wearlaw_commands() -> list[wl.Command]:
    """Return the command of this plugin."""
    return [wl.Command("weigh", "wearlaw_outside.command:weigh", "Print the weight of a mass.")]
