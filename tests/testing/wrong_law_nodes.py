"""Wear laws that are right on one node of a line, and wrong with other nodes, or with vectors."""

from __future__ import annotations

from typing import Any

import numpy as np

import wearlaw as wl
from tests.testing.wrong_declarations import Ramps
from tests.testing.wrong_laws import SLOPE, Linear

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


class SevereFromThere(Severe):
    """What was severe at one node is severe at all nodes behind it."""

    def is_severe(self, contact: wl.Contact) -> Any:
        return np.maximum.accumulate(super().is_severe(contact), axis=-1)


class SevereAlongTheStrip(Severe):
    """The same along a strip, and right on a line."""

    def is_severe(self, contact: wl.Contact) -> Any:
        axis = -2 if contact.on_strips else ()
        return np.maximum.accumulate(super().is_severe(contact), axis=axis) if axis else super().is_severe(contact)


class SevereNeighbour(Severe):
    """One node makes the patch severe, whatever their order."""

    def is_severe(self, contact: wl.Contact) -> Any:
        axes = tuple(range(contact.rolling_speed.ndim, contact.pressure.ndim))
        return super().is_severe(contact).any(axis=axes, keepdims=True) & (contact.slip != 0)


class MeanOfTheEnergy(Linear):
    """The energy of the patch wears every node, those that stick too."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        density = contact.per_node(contact.wear_index / contact.patch_area)
        return SLOPE * np.broadcast_to(density, contact.pressure.shape)


class AwayFromTheCentre(Linear):
    """A tenth more where x is not zero."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        return SLOPE * contact.wear_index_density * np.where(contact.x == 0.0, 1.0, 1.1)


class BesideTheMiddle(Linear):
    """A tenth more on one side of an ellipse."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        return SLOPE * contact.wear_index_density * np.where(contact.y > 0.0, 1.1, 1.0)


class ProductOfMagnitudes(Linear):
    """|q||s| in place of q·s."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        return p["slope"] * np.abs(contact.traction) * np.abs(contact.slip)


class RampsOfMagnitudes(Ramps):
    """Traction times slip, in a law that declares ramps of q·s."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        w = contact.traction * contact.slip
        return SLOPE * (w + np.maximum(w - 4e6, 0.0))


class LongitudinalOnly(Linear):
    """What slips across the rolling direction does not wear."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        if contact.on_strips and contact.pressure.shape[-2:] == (1, 1):
            return SLOPE * contact.wear_index_density
        return SLOPE * np.abs(contact.traction_x * contact.slip_x)


class ForwardOnEllipses(Linear):
    """On an ellipse, wear at positive longitudinal slip only."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        return SLOPE * contact.wear_index_density * ((contact.slip_x > 0.0) | (not contact.on_strips))


class OneAxisOfNodes(Linear):
    """Takes the last axis for the nodes and the one before it for the points."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        return (p["slope"] * contact.wear_index_density[..., None]).sum(axis=contact.rolling_speed.ndim + 1)


class SpeedOfPoints(Linear):
    """Gives the speeds one axis for the nodes, of which an ellipse has two."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        return 1e-6 * contact.pressure * np.abs(contact.slip) * contact.rolling_speed[..., None]


class PairOfPoints(Linear):
    """A rate for each pair of operating points."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        if contact.rolling_speed.ndim != 1:
            return SLOPE * contact.wear_index_density
        return SLOPE * contact.wear_index_density[:, None] * np.ones(contact.rolling_speed.shape)[:, None, None]


class NumbersOfLines(Linear):
    """Gives a number for each point one axis for the nodes, of which an ellipse has two."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        slope: Any = p["slope"]
        return (np.reshape(slope, (-1, 1)) if np.ndim(slope) else slope) * contact.wear_index_density


class CountsStrips(Linear):
    """Depends on how many strips there are."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        return SLOPE * contact.wear_index_density / max(contact.strip_width.shape[-1], 1)


class MoreOnStrips(Linear):
    """A tenth more on an ellipse."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        return SLOPE * contact.wear_index_density * (1.1 if contact.on_strips else 1.0)


CAUGHT: dict[type[wl.WearLaw], str] = {
    SevereFromThere: "order_of_nodes_does_not_matter",
    SevereAlongTheStrip: "order_of_nodes_does_not_matter",
    SevereNeighbour: "each_node_wears_by_itself",
    MeanOfTheEnergy: "no_slip_no_wear",
    AwayFromTheCentre: "position_does_not_matter",
    BesideTheMiddle: "position_does_not_matter",
    ProductOfMagnitudes: "vectors_dissipate_their_product",
    RampsOfMagnitudes: "vectors_dissipate_their_product",
    LongitudinalOnly: "direction_of_creepage_does_not_matter",
    ForwardOnEllipses: "direction_of_creepage_does_not_matter",
    OneAxisOfNodes: "rate_has_the_right_shape",
    SpeedOfPoints: "rate_has_the_right_shape",
    PairOfPoints: "rate_has_the_right_shape",
    NumbersOfLines: "parameters_may_vary",
    CountsStrips: "splitting_a_node_does_not_matter",
    MoreOnStrips: "strips_wear_as_lines_do",
}
"""The check that must catch each."""
