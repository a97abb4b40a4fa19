"""A wear law and a contact model from outside wearlaw."""

import wearlaw as wl
from wearlaw_outside.contact import Rigid
from wearlaw_outside.law import MadeUp

wearlaw_interface = 2


@wl.hookimpl
def wearlaw_wear_laws() -> list[type[wl.WearLaw]]:
    """Return the wear laws of this plugin."""
    return [MadeUp]


@wl.hookimpl
def wearlaw_contact_models() -> list[type[wl.ContactModel]]:
    """Return the contact models of this plugin."""
    return [Rigid]
