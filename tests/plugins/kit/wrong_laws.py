"""Wear laws that are wrong in one way each, made from right ones: their rates, and what they declare."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated, Any, ClassVar

import numpy as np
from pydantic import Field

import wearlaw as wl

SLOPE = 5e-9
"""Of the laws [kg/m/N]."""

BORDER = 4e6
"""Wear-index density at which some of the laws branch [N/m²]."""


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


class Severe(Linear):
    """A right one with a border, where the wear jumps to twice as much."""

    def breakpoints(self, p: wl.Numbers) -> wl.BreakpointMap:
        return {"wear_index_density": (BORDER,)}

    jumps = breakpoints

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        w = contact.wear_index_density
        return np.where(w < BORDER, SLOPE, 2 * SLOPE) * w


class Smooth(Linear):
    """A right one without a breakpoint: steep, saturating and turning in places, but smooth."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        w = contact.wear_index_density
        activated = np.exp(-1e8 / (contact.pressure + 1e3))
        turning = 2.0 + np.tanh(np.log((contact.slip_speed + 1e-9) / 0.2) / 0.01)
        return SLOPE * 1e6 * np.log1p(w / 1e6) * (1.0 + w / 1e7) ** 1.5 * activated * turning


class Ramps(Linear):
    """A right one with ramps: a threshold at 4 N/mm²."""

    def breakpoints(self, p: wl.Numbers) -> wl.BreakpointMap:
        return {"wear_index_density": (BORDER,)}

    def ramps(self, p: wl.Numbers) -> tuple[tuple[float, float], ...]:
        return (0.0, SLOPE), (BORDER, SLOPE)

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        w = contact.wear_index_density
        return SLOPE * (w + np.maximum(w - BORDER, 0.0))


class HottestNode(Linear):
    """A right one with an exemption: the node that dissipates most makes the whole patch wear more."""

    @property
    def exemptions(self) -> dict[str, str]:
        return {"each_node_wears_by_itself": "the hottest node heats the patch"}

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        w = contact.wear_index_density
        hottest = w.max(axis=tuple(range(contact.rolling_speed.ndim, w.ndim)), keepdims=True)
        return SLOPE * w * (1.0 + hottest / (hottest + BORDER))


def refuses_a_corner(contact: wl.Contact) -> Any:
    if (contact.slip == 0).any():
        raise ZeroDivisionError("no slip")
    return contact.wear_index_density


def nan_at_corner(contact: wl.Contact) -> Any:
    with np.errstate(all="ignore"):
        return contact.wear_index_density * (contact.pressure / contact.pressure)


def longitudinal_only(contact: wl.Contact) -> Any:
    if contact.on_strips and contact.pressure.shape[-2:] == (1, 1):
        return contact.wear_index_density
    return np.abs(contact.traction_x * contact.slip_x)


def of_pairs(contact: wl.Contact) -> Any:
    w = contact.wear_index_density
    speeds = contact.rolling_speed
    return w if speeds.ndim != 1 else w[:, None] * np.ones(speeds.shape)[:, None, None]


def of_neighbours(contact: wl.Contact) -> Any:
    w = contact.wear_index_density
    return w * (1.0 + 0.01 * w / np.maximum(w.max(axis=-1, keepdims=True), 1.0))


Rate = Callable[[wl.Contact], Any]

WRONG_RATES: dict[str, tuple[str, Rate]] = {
    "WrongSign": ("rate_is_never_negative", lambda c: -c.wear_index_density),
    "ForwardOnly": ("direction_of_creepage_does_not_matter", lambda c: c.wear_index_density * (c.slip > 0)),
    "LongitudinalOnly": ("direction_of_creepage_does_not_matter", longitudinal_only),
    "Offset": ("no_slip_no_wear", lambda c: c.wear_index_density + 20.0),
    "Raises": ("no_slip_no_wear", refuses_a_corner),
    "PointDiffers": ("batching_does_not_matter", lambda c: c.wear_index_density * (1 + 1e-9 * (c.pressure.size == 1))),
    "NodeOrder": ("listing_of_nodes_does_not_matter", lambda c: np.cumsum(c.wear_index_density, axis=-1)),
    "CountsNodes": ("listing_of_nodes_does_not_matter", lambda c: c.wear_index_density / c.area.shape[-1]),
    "NeighbourLeak": ("each_node_wears_by_itself", of_neighbours),
    "NaNAtCorner": ("rate_is_finite", nan_at_corner),
    "SinglePrecision": ("precision_is_double", lambda c: c.wear_index_density.astype(np.float32).astype(np.float64)),
    "WrongShape": ("rate_has_the_right_shape", lambda c: c.wear_index_density.mean(axis=-1)),
    "PairOfPoints": ("rate_has_the_right_shape", of_pairs),
    "AwayFromTheCentre": ("position_does_not_matter", lambda c: c.wear_index_density * np.where(c.x == 0.0, 1.0, 1.1)),
    "ProductOfMagnitudes": ("vectors_dissipate_their_product", lambda c: np.abs(c.traction) * np.abs(c.slip)),
    "MoreOnStrips": ("strips_wear_as_lines_do", lambda c: c.wear_index_density * (1.1 if c.on_strips else 1.0)),
    "FallsWithSlip": ("is_monotone_as_declared", lambda c: c.wear_index_density / (1.0 + (10.0 * c.slip) ** 2)),
    "HiddenJump": ("rate_jumps_only_where_declared", lambda c: Severe().rate(c, {}) / SLOPE),
    "HiddenKink": (
        "rate_has_kinks_only_where_declared",  # a hundredth more of each further joule
        lambda c: c.wear_index_density + 0.01 * np.maximum(c.wear_index_density - BORDER, 0.0),
    ),
}
"""Rates over the slope by the names of wrong laws, each with the check that must catch it."""


def of_rate(name: str, over_slope: Rate) -> Any:
    """Return the class of a law with a rate in place of the right one."""

    def rate(self: Any, contact: wl.Contact, p: wl.Numbers) -> Any:  # noqa: ARG001
        return SLOPE * over_slope(contact)

    return type(name, (Linear,), {"rate": rate, "__module__": __name__, "__doc__": "Wrong."})


class MissingUnit(Linear):
    """The number of a parameter without its unit."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        return 1e-9 * float(self.slope.magnitude) * contact.wear_index_density


class ReadsItself(Linear):
    """Takes the slope of the law and not the one that it is given."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        return wl.scalar_si(self.slope, "kg/m/N") * contact.wear_index_density


class TwelveDigits(Linear):
    """Loses four digits in a difference of large numbers."""

    def breakpoints(self, p: wl.Numbers) -> Any:
        return None

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        w = contact.wear_index_density
        return SLOPE * ((1.0 + 3e3) * w - 3e3 * w)


class JumpElsewhere(Severe):
    """The jump is declared at 4 N/mm², but lies at 5 N/mm²."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        w = contact.wear_index_density
        return np.where(w < 1.25 * BORDER, SLOPE, 2 * SLOPE) * w


class RampIsTooSteep(Ramps):
    """The second ramp is steeper than the law, by a millionth."""

    def ramps(self, p: wl.Numbers) -> tuple[tuple[float, float], ...]:
        return (0.0, SLOPE), (BORDER, SLOPE * (1.0 + 1e-6))


class UnknownVariable(Linear):
    """Has a range of an unknown variable."""

    @property
    def valid_range(self) -> dict[str, tuple[float, float]]:
        return {"temperature": (0.0, 1.0)}


class BandUpsideDown(Linear):
    """The low end wears most."""

    def band(self) -> tuple[wl.WearLaw, wl.WearLaw, wl.WearLaw]:
        low, middle, high = (Linear(slope=wl.Q(k, "ug/m/N")) for k in (7.0, 5.0, 3.0))
        return low, middle, high


class OfTheEnergy(Linear):
    """Says that it goes with p·s, and goes with q·s."""

    follows_pressure_times_slip: ClassVar[bool] = True


class NumberOfTheClass(Linear):
    """Has a number that is no field."""

    factor: ClassVar[float] = 1.5

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        return self.factor * super().rate(contact, p)


class Driven(Linear):
    """Wears more where the slip points along the rolling direction."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        slip = contact.slip_x if contact.on_strips else contact.slip
        return np.where(slip > 0.0, 1.0, 1.5) * super().rate(contact, p)


class UnknownClaim(Linear):
    """Exempt from a check that is misspelt."""

    @property
    def exemptions(self) -> dict[str, str]:
        return {"each_node_wears_by_itsel": "the hottest node counts"}


class NoReason(Linear):
    """Exempt without a reason."""

    @property
    def exemptions(self) -> dict[str, str]:
        return {"each_node_wears_by_itself": " "}


class NoSource(Linear):
    """States no source."""

    source: ClassVar[str] = " "


OF_RATE: dict[str, Any] = {name: of_rate(name, rate) for name, (_, rate) in WRONG_RATES.items()}
"""The classes of these laws."""

CAUGHT: dict[Any, str] = {
    **{OF_RATE[name]: check for name, (check, _) in WRONG_RATES.items()},
    MissingUnit: "units_of_parameters_do_not_matter",
    ReadsItself: "parameters_may_vary",
    TwelveDigits: "precision_is_double",
    JumpElsewhere: "rate_jumps_only_where_declared",
    RampIsTooSteep: "ramps_sum_to_the_rate",
    UnknownVariable: "declared_names_are_variables",
    BandUpsideDown: "band_is_ordered",
    OfTheEnergy: "pressure_times_slip_is_followed",
    NumberOfTheClass: "numbers_are_fields",
    Driven: "direction_of_creepage_does_not_matter",
    UnknownClaim: "exemptions_are_claims",
    NoReason: "exemptions_are_claims",
    NoSource: "source_is_stated",
}
"""The check that must catch each."""
