"""A wear law of two slopes."""

from functools import cached_property
from typing import Annotated, ClassVar

import numpy as np
from pydantic import Field

import wearlaw as wl

Slope = Annotated[wl.Quantity, wl.Unit("ug/m/N")]


class MadeUp(wl.WearLaw):
    """Wear in proportion to q·s, three times as steep above a limit. All numbers are made up."""

    name: ClassVar[str] = "made_up"
    source: ClassVar[str] = "made up for tests; it fits no material"
    monotone_in: ClassVar[tuple[str, ...]] = ("wear_index_density",)

    slope: Slope = Field(default="5 ug/m/N", validate_default=True)
    """Slope below the limit [kg/m/N]."""
    limit: Annotated[wl.Quantity, wl.Unit("N/mm^2")] = Field(default="4 N/mm^2", validate_default=True)
    """Wear-index density at the kink [N/m²]."""

    @cached_property
    def _si(self) -> tuple[float, float]:
        return wl.scalar_si(self.slope, "kg/m/N"), wl.scalar_si(self.limit, "N/m^2")

    @property
    def breakpoints(self) -> wl.BreakpointMap:
        """Return the place of the kink."""
        return {"wear_index_density": (self._si[1],)}

    def rate(self, contact: wl.Contact) -> wl.Array:
        """Return the mass lost per metre rolled and contact area [kg/m/m²]."""
        slope, limit = self._si
        w = contact.wear_index_density
        return slope * (w + 2.0 * np.maximum(w - limit, 0.0))
