"""Wear tests, parameters of laws fitted to them, comparisons with predictions, and uncertainties of predictions."""

import wearlaw as wl


@wl.hookimpl
def wearlaw_resources() -> dict[str, dict[str, wl.ResourceKind]]:
    """Return the kinds of resources that this plugin looks up."""
    return {"kind": {"test set": wl.ResourceKind(str, "wearlaw_apps.fits.read_tests:explain_tests")}}


@wl.hookimpl
def wearlaw_commands() -> list[wl.Command]:
    """Return the commands of this plugin."""
    return [
        wl.Command("compare", "wearlaw_apps.fits.commands:compare", "Rank models by how well they predict your tests."),
        wl.Command("fit", "wearlaw_apps.fits.commands:fit", "Fit the parameters of a wear law to your tests."),
    ]
