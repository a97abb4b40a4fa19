"""Wear laws with wrong declarations."""

from __future__ import annotations

from typing import Any

import numpy as np

import wearlaw as wl
from tests.plugins.kit.wrong_laws import SLOPE, Linear


class HiddenJump(Linear):
    """Twice the rate above 4 N/mm², undeclared."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        w = contact.wear_index_density
        return np.where(w < 4e6, SLOPE, 2 * SLOPE) * w


class JumpElsewhere(Linear):
    """The jump is declared at 4 N/mm², but lies at 5 N/mm²."""

    def breakpoints(self, p: wl.Numbers) -> wl.BreakpointMap:
        return {"wear_index_density": (4e6,)}

    def jumps(self, p: wl.Numbers) -> wl.BreakpointMap:
        return self.breakpoints(p)

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        w = contact.wear_index_density
        return np.where(w < 5e6, SLOPE, 2 * SLOPE) * w


class Smooth(Linear):
    """The right one of those without a breakpoint: steep, saturating and turning in places, but smooth."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        w = contact.wear_index_density
        activated = np.exp(-1e8 / (contact.pressure + 1e3))
        turning = 2.0 + np.tanh(np.log((contact.slip_speed + 1e-9) / 0.2) / 0.01)
        return SLOPE * 1e6 * np.log1p(w / 1e6) * (1.0 + w / 1e7) ** 1.5 * activated * turning


class HiddenKink(Linear):
    """A hundredth more of each further joule above 4 N/mm², undeclared."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        w = contact.wear_index_density
        return SLOPE * (w + 0.01 * np.maximum(w - 4e6, 0.0))


class Ramps(Linear):
    """The right one of those with ramps: a threshold at 4 N/mm²."""

    def breakpoints(self, p: wl.Numbers) -> wl.BreakpointMap:
        return {"wear_index_density": (4e6,)}

    def ramps(self, p: wl.Numbers) -> tuple[tuple[float, float], ...]:
        return (0.0, SLOPE), (4e6, SLOPE)

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        w = contact.wear_index_density
        return SLOPE * (w + np.maximum(w - 4e6, 0.0))


class RampIsTooSteep(Ramps):
    """The second ramp is steeper than the law, by a millionth."""

    def ramps(self, p: wl.Numbers) -> tuple[tuple[float, float], ...]:
        return (0.0, SLOPE), (4e6, SLOPE * (1.0 + 1e-6))


class FallsWithSlip(Linear):
    """Less wear for the same energy at high slip."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        return SLOPE * contact.wear_index_density / (1.0 + (10.0 * contact.slip) ** 2)


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


class HottestNode(Linear):
    """A right one with an exemption: the node that dissipates most makes the whole patch wear more."""

    @property
    def exemptions(self) -> dict[str, str]:
        return {"each_node_wears_by_itself": "the hottest node heats the patch"}

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Any:
        w = contact.wear_index_density
        hottest = w.max(axis=tuple(range(contact.rolling_speed.ndim, w.ndim)), keepdims=True)
        return SLOPE * w * (1.0 + hottest / (hottest + 4e6))


CAUGHT: dict[type[wl.WearLaw], str] = {
    HiddenJump: "rate_jumps_only_where_declared",
    JumpElsewhere: "rate_jumps_only_where_declared",
    HiddenKink: "rate_has_kinks_only_where_declared",
    RampIsTooSteep: "ramps_sum_to_the_rate",
    FallsWithSlip: "is_monotone_as_declared",
    UnknownVariable: "declared_names_are_variables",
    BandUpsideDown: "band_is_ordered",
    UnknownClaim: "exemptions_are_claims",
    NoReason: "exemptions_are_claims",
}
"""The check that must catch each."""
