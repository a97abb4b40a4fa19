"""One of each kind of plugin from outside wearlaw."""

import wearlaw as wl
from wearlaw_outside.contact import Rigid
from wearlaw_outside.flash import Flash
from wearlaw_outside.law import MadeUp
from wearlaw_outside.material import MADE_UP_STEEL
from wearlaw_outside.rig import Weighted
from wearlaw_outside.stage import Wet

wearlaw_interface = 2


@wl.hookimpl
def wearlaw_rigs() -> list[type[wl.Rig]]:
    """Return the rigs of this plugin."""
    return [Weighted]


@wl.hookimpl
def wearlaw_contact_models() -> list[type[wl.ContactModel]]:
    """Return the contact models of this plugin."""
    return [Rigid]


@wl.hookimpl
def wearlaw_stages() -> list[type[wl.Stage]]:
    """Return the stages of this plugin."""
    return [Wet]


@wl.hookimpl
def wearlaw_wear_laws() -> list[type[wl.WearLaw]]:
    """Return the wear laws of this plugin."""
    return [MadeUp]


@wl.hookimpl
def wearlaw_laws() -> list[type[wl.Law]]:
    """Return the laws of other outcomes of this plugin."""
    return [Flash]


@wl.hookimpl
def wearlaw_materials() -> dict[str, wl.Material]:
    """Return the materials of this plugin by name."""
    return {"made_up_steel": MADE_UP_STEEL}
