"""A wear law of two slopes."""

from typing import Annotated, ClassVar

import numpy as np
from pydantic import Field

import wearlaw as wl

Slope = Annotated[wl.Quantity, wl.Unit("ug/m/N")]


class MadeUp(wl.WearLaw):
    """Wear in proportion to q·s, three times as steep above a limit. All numbers are made up."""

    name: ClassVar[str] = "made_up"
    source: ClassVar[str] = "made up for tests; it fits no material"
    monotone_in: ClassVar[tuple[wl.LawVariable, ...]] = ("wear_index_density",)

    slope: Slope = Field(default="5 ug/m/N", validate_default=True)
    """Slope below the limit [kg/m/N]."""
    limit: Annotated[wl.Quantity, wl.Unit("N/mm^2")] = Field(default="4 N/mm^2", validate_default=True)
    """Wear-index density at the kink [N/m²]."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> wl.Array:
        """Return the mass lost per metre rolled and contact area [kg/m/m²]."""
        w = contact.wear_index_density
        return p["slope"] * (w + 2.0 * np.maximum(w - p["limit"], 0.0))

    def breakpoints(self, p: wl.Numbers) -> wl.BreakpointMap:
        """Return the place of the kink."""
        return {"wear_index_density": (p["limit"],)}
