"""Wear tests, fits of laws, comparisons and uncertainties."""

from typing import TYPE_CHECKING

import wearlaw as wl
from wearlaw.late import face

if TYPE_CHECKING:
    from wearlaw_apps.fits.comparison import Comparison
    from wearlaw_apps.fits.result import Fit
    from wearlaw_apps.fits.uncertainty import Uncertainty
    from wearlaw_apps.fits.wear_tests import WearTests

__all__ = ["Comparison", "Fit", "Uncertainty", "WearTests"]

__getattr__ = face(
    "wearlaw_apps.fits",
    {
        "wearlaw_apps.fits.comparison": ("Comparison",),
        "wearlaw_apps.fits.result": ("Fit",),
        "wearlaw_apps.fits.uncertainty": ("Uncertainty",),
        "wearlaw_apps.fits.wear_tests": ("WearTests",),
    },
)


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
