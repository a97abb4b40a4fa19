"""Wear laws that are right on one node of a line, and wrong with other nodes, or with vectors."""

from __future__ import annotations

from typing import Any

import numpy as np

import wearlaw as wl
from tests.plugins.kit.wrong_laws import SLOPE, Linear

BORDER = 4e6
"""Wear-index density at which some of the laws branch [N/m²]."""


class Severe(Linear):
    """The right one of those with a border: three times the wear above 4 N/mm²."""

    def breakpoints(self, p: wl.Numbers) -> wl.BreakpointMap:
        return {"wear_index_density": (BORDER,)}

    def jumps(self, p: wl.Numbers) -> wl.BreakpointMap:
        return self.breakpoints(p)

    def is_severe(self, contact: wl.Contact) -> Any:
        return contact.wear_index_density >= BORDER

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        return SLOPE * np.where(self.is_severe(contact), 3.0, 1.0) * contact.wear_index_density


class AwayFromTheCentre(Linear):
    """A tenth more where x is not zero."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        return SLOPE * contact.wear_index_density * np.where(contact.x == 0.0, 1.0, 1.1)


class ProductOfMagnitudes(Linear):
    """|q||s| in place of q·s."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        return p["slope"] * np.abs(contact.traction) * np.abs(contact.slip)


class LongitudinalOnly(Linear):
    """What slips across the rolling direction does not wear."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        if contact.on_strips and contact.pressure.shape[-2:] == (1, 1):
            return SLOPE * contact.wear_index_density
        return SLOPE * np.abs(contact.traction_x * contact.slip_x)


class PairOfPoints(Linear):
    """A rate for each pair of operating points."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        if contact.rolling_speed.ndim != 1:
            return SLOPE * contact.wear_index_density
        return SLOPE * contact.wear_index_density[:, None] * np.ones(contact.rolling_speed.shape)[:, None, None]


class MoreOnStrips(Linear):
    """A tenth more on an ellipse."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        return SLOPE * contact.wear_index_density * (1.1 if contact.on_strips else 1.0)


CAUGHT: dict[type[wl.WearLaw], str] = {
    AwayFromTheCentre: "position_does_not_matter",
    ProductOfMagnitudes: "vectors_dissipate_their_product",
    LongitudinalOnly: "direction_of_creepage_does_not_matter",
    PairOfPoints: "rate_has_the_right_shape",
    MoreOnStrips: "strips_wear_as_lines_do",
}
"""The check that must catch each."""
