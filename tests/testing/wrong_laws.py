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


class SignedSlip(Linear):
    """Pressure times the slip with its sign."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        return SLOPE * contact.pressure * contact.slip


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


def _arrays(w: Any) -> Any:
    return SLOPE * w


@wl.kernel(_arrays)
def nearly(w: float) -> float:
    """Return a little more than its arrays."""
    return 5e-9 * w * (1.0 + 1e-9)


class KernelDiffers(Linear):
    """The formula of a kernel for one point is not that of its arrays."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        return nearly(contact.wear_index_density)


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


class BatchLeak(Linear):
    """Relative to the largest of the batch."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        w = contact.wear_index_density
        return SLOPE * w * (1.0 + 0.01 * w / np.maximum(w.max(), 1.0))


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


class ReturnsSingle(Linear):
    """Returns single precision."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        return (SLOPE * contact.wear_index_density).astype(np.float32)


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


class BranchesInPython(Linear):
    """Asks whether a slope is steep, which an array of slopes cannot answer."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        return (p["slope"] if p["slope"] < 1e-6 else 1e-6) * contact.wear_index_density


class BreakpointOfItself(Linear):
    """A kink whose place does not move with the slope that it is made of."""

    def breakpoints(self, p: wl.Numbers) -> wl.BreakpointMap:
        return {"wear_index_density": (20e-3 / wl.scalar_si(self.slope, "kg/m/N"),)}

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        return np.minimum(p["slope"] * contact.wear_index_density, 20e-3)


class OneForAll(Linear):
    """The first point's slope at all points."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        return np.ravel(p["slope"])[0] * contact.wear_index_density


class AxisOfPoints(Linear):
    """One value of the slope a node, for want of the axis of the nodes."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        return np.ravel(p["slope"]) * contact.wear_index[0] / contact.patch_area[0]


CAUGHT: dict[type[wl.WearLaw], str] = {
    ReadsItself: "parameters_may_vary",
    BranchesInPython: "parameters_may_vary",
    BreakpointOfItself: "parameters_may_vary",
    OneForAll: "parameters_may_vary",
    AxisOfPoints: "parameters_may_vary",
    WrongSign: "rate_is_never_negative",
    SignedSlip: "rate_is_never_negative",
    ForwardOnly: "direction_of_creepage_does_not_matter",
    Offset: "no_slip_no_wear",
    MissingUnit: "units_of_parameters_do_not_matter",
    KernelDiffers: "acceleration_does_not_matter",
    TwelveDigits: "precision_is_double",
    NodeOrder: "order_of_nodes_does_not_matter",
    BatchLeak: "batching_does_not_matter",
    NeighbourLeak: "each_node_wears_by_itself",
    CountsNodes: "splitting_a_node_does_not_matter",
    PlainMean: "splitting_a_node_does_not_matter",
    NaNAtCorner: "rate_is_finite",
    SinglePrecision: "precision_is_double",
    ReturnsSingle: "precision_is_double",
    WrongShape: "rate_has_the_right_shape",
    Raises: "no_slip_no_wear",
}
"""The check that must catch each."""
