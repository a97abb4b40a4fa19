"""Wear laws that are wrong in one way each, made from a right one."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar

import numpy as np
from pydantic import Field

import wearlaw as wl

SLOPE = 5e-9


class Linear(wl.WearLaw):
    """The right one: wear in proportion to the wear-index density."""

    name: ClassVar[str] = "linear"
    source: ClassVar[str] = "made up for the tests"
    monotone_in: ClassVar[tuple[wl.LawVariable, ...]] = ("wear_index_density",)

    slope: Annotated[wl.Quantity, wl.Unit("ug/m/N")] = Field(default="5 ug/m/N", validate_default=True)
    """Slope [kg/m/N]."""

    def breakpoints(self, p: wl.Numbers) -> wl.BreakpointMap:
        return {}

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        return p["slope"] * contact.wear_index_density


class WrongSign(Linear):
    """Material grows."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        return -SLOPE * contact.wear_index_density


class ForwardOnly(Linear):
    """Wear at positive creepage only."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        return SLOPE * contact.wear_index_density * (contact.slip > 0)


class Offset(Linear):
    """A rate of 1e-7 without slip."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        return SLOPE * contact.wear_index_density + 1e-7


class MissingUnit(Linear):
    """The number of a parameter without its unit."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        return 1e-9 * float(self.slope.magnitude) * contact.wear_index_density


class PointDiffers(Linear):
    """A little more wear for a point alone than for an array."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        return SLOPE * contact.wear_index_density * (1.0 + 1e-9 * (contact.pressure.size == 1))


class TwelveDigits(Linear):
    """Loses four digits in a difference of large numbers."""

    def breakpoints(self, p: wl.Numbers) -> Any:
        return None

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        w = contact.wear_index_density
        return SLOPE * ((1.0 + 3e3) * w - 3e3 * w)


class NodeOrder(Linear):
    """Wear accumulates from the leading edge."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        return SLOPE * np.cumsum(contact.wear_index_density, axis=-1)


class NeighbourLeak(Linear):
    """Relative to the largest of the patch."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        w = contact.wear_index_density
        return SLOPE * w * (1.0 + 0.01 * w / np.maximum(w.max(axis=-1, keepdims=True), 1.0))


class CountsNodes(Linear):
    """Depends on how finely the patch is resolved."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        return SLOPE * contact.wear_index_density / contact.area.shape[-1]


class PlainMean(Linear):
    """The mean over the nodes without their areas."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        return np.broadcast_to(SLOPE * contact.wear_index_density.mean(axis=-1, keepdims=True), contact.slip.shape)


class NaNAtCorner(Linear):
    """Divides zero by zero where the pressure is zero."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        with np.errstate(all="ignore"):
            return SLOPE * contact.wear_index_density * (contact.pressure / contact.pressure)


class SinglePrecision(Linear):
    """Computes in single precision, and returns double."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        return SLOPE * contact.wear_index_density.astype(np.float32).astype(np.float64)


class WrongShape(Linear):
    """One rate a patch, though stated for the nodes."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        return SLOPE * contact.wear_index_density.mean(axis=-1)


class Raises(Linear):
    """Refuses a corner."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        if (contact.slip == 0).any():
            raise ZeroDivisionError("no slip")
        return SLOPE * contact.wear_index_density


class ReadsItself(Linear):
    """Takes the slope of the law and not the one that it is given."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        return wl.scalar_si(self.slope, "kg/m/N") * contact.wear_index_density


CAUGHT: dict[type[wl.WearLaw], str] = {
    ReadsItself: "parameters_may_vary",
    WrongSign: "rate_is_never_negative",
    ForwardOnly: "direction_of_creepage_does_not_matter",
    Offset: "no_slip_no_wear",
    MissingUnit: "units_of_parameters_do_not_matter",
    PointDiffers: "batching_does_not_matter",
    TwelveDigits: "precision_is_double",
    NodeOrder: "listing_of_nodes_does_not_matter",
    NeighbourLeak: "each_node_wears_by_itself",
    CountsNodes: "listing_of_nodes_does_not_matter",
    PlainMean: "listing_of_nodes_does_not_matter",
    NaNAtCorner: "rate_is_finite",
    SinglePrecision: "precision_is_double",
    WrongShape: "rate_has_the_right_shape",
    Raises: "no_slip_no_wear",
}
"""The check that must catch each."""
