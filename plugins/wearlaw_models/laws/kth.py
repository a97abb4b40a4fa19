"""The wear map of the Royal Institute of Technology, Stockholm (KTH)."""

from __future__ import annotations

from functools import cache, cached_property
from typing import Annotated, Any, ClassVar, Literal

import numpy as np
from pydantic import Field, field_validator, model_validator

import wearlaw as wl
from wearlaw import Array

Coefficient = Annotated[float, Field(gt=0.0, strict=True), wl.Unit("", usual=(1e-10, 0.1))]


class Coefficients(wl.Configuration):
    """The wear coefficient k [-] of V = k N d / H in each field of the wear map."""

    high_pressure: Coefficient
    """Wear coefficient at and above the pressure threshold, at any slip speed, k [-]."""
    low_speed: Coefficient
    """Wear coefficient below the lower slip speed, k [-]."""
    mid_speed: Coefficient
    """Wear coefficient from the lower to the upper slip speed, k [-]."""
    high_speed: Coefficient
    """Wear coefficient at and above the upper slip speed, k [-]."""


THRESHOLD_OVER_HARDNESS = 0.8
"""Pressure at which seizure begins, over the hardness, in the wear map of Jendel (2002). Tassini et al. (2010) print it
as 2.1 GPa."""

PUBLISHED = {
    "low": {"high_pressure": 300e-4, "low_speed": 1e-4, "mid_speed": 30e-4, "high_speed": 1e-4},
    "mid": {"high_pressure": 350e-4, "low_speed": 5.5e-4, "mid_speed": 35e-4, "high_speed": 5.5e-4},
    "high": {"high_pressure": 400e-4, "low_speed": 10e-4, "mid_speed": 40e-4, "high_speed": 10e-4},
}


@cache
def calibration() -> wl.Calibration:
    """Return the record of the published map.

    Table 2 gives k in the outermost fields of the map, at 2.1 GPa and above and at 0.7 m/s and above, but prints no end
    for them, and the paper does not say how far the tests went. A prediction in them counts as out of range.
    """
    return wl.Calibration(
        contact_model="any",
        scale="any",
        geometry="any",
        materials="unspecified materials, in twin-disc and pin-on-disc tests",
        stated_range=(("pressure", "0 MPa", "2100 MPa"), ("slip_speed", "0 m/s", "0.7 m/s")),
        source=(
            "T. Jendel, Wear 253 (2002) 89-99, after Tassini et al., Wear 268 (2010) 660-667, Table 2, whose outermost"
            " fields, at 2.1 GPa and above and at 0.7 m/s and above, have a k but no printed end"
        ),
    )


class KTH(wl.WearLaw):
    """Archard's law V = k N d / H with k from a map of pressure and slip speed; at a node, ρ k p s / H.

    k is dimensionless, and H is the hardness. Some sources print V = k N d / (3H), with a k three times as large. The
    border in pressure is a share of H, so that it moves with a hardness of your own. If p equals the border, the law
    takes the upper field of the map; the published map leaves this case open. The density ρ is that of the contact.

    Notes
    -----
    Table 2 of Tassini et al. (2010) prints "ṡ ≥ 0.2" in its first row below 2.1 GPa; it must read "ṡ < 0.2".
    """

    name: ClassVar[str] = "kth"
    source: ClassVar[str] = (
        "T. Jendel, Wear 253 (2002) 89-99, after Tassini et al., Wear 268 (2010) 660-667, Table 2 and eq. (15)"
    )
    follows_pressure_times_slip: ClassVar[bool] = True

    coefficient: Literal["low", "mid", "high"] | Coefficients = "mid"
    """The published values of k are ranges. Choose their low end, middle or high end, or give your own values."""
    hardness: Annotated[wl.Quantity, wl.Unit("GPa", usual=(0.05, 100.0))] = Field(
        default="2.625 GPa", validate_default=True
    )
    """Hardness, H [Pa]. Not printed in the paper; 2.1 GPa is 0.8 H in the wear map."""
    threshold_over_hardness: Annotated[float, Field(gt=0.0, strict=True)] = THRESHOLD_OVER_HARDNESS
    """Pressure at which seizure begins, over the hardness [-]; 0.8 in the wear map."""
    pressure_threshold: Annotated[wl.Quantity, wl.Unit("GPa")] | None = Field(default=None, examples=["2.1 GPa"])
    """Pressure at which seizure begins [Pa]; None for that share of the hardness."""
    lower_slip_speed: wl.Speed = Field(default="0.2 m/s", validate_default=True)
    """Slip speed at which severe wear begins [m/s]."""
    upper_slip_speed: wl.Speed = Field(default="0.7 m/s", validate_default=True)
    """Slip speed at which severe wear ends [m/s]."""

    @field_validator("coefficient", mode="before")
    @classmethod
    def _published_or_own(cls, value: Any) -> Any:
        if isinstance(value, dict):
            return Coefficients(**value)
        if isinstance(value, Coefficients) or (isinstance(value, str) and value in PUBLISHED):
            return value
        fields = ", ".join(Coefficients.model_fields)
        raise ValueError(f"must be 'low', 'mid', 'high' or your own {fields}, got {value!r}")

    @model_validator(mode="after")
    def _one_threshold(self) -> KTH:
        if self.pressure_threshold is not None and self.threshold_over_hardness != THRESHOLD_OVER_HARDNESS:
            raise ValueError("give either pressure_threshold or threshold_over_hardness, not both")
        return self

    @model_validator(mode="after")
    def _ordered(self) -> KTH:
        if self.upper_slip_speed < self.lower_slip_speed:
            raise ValueError(
                f"upper_slip_speed must not lie below lower_slip_speed = {self.lower_slip_speed!r};"
                f" got {self.upper_slip_speed!r}"
            )
        return self

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Array:
        """Return the wear rate at the nodes [kg/m/m²]."""
        speed = contact.slip_speed
        fast = np.where(speed < p["upper_slip_speed"], p["coefficient.mid_speed"], p["coefficient.high_speed"])
        below = np.where(speed < p["lower_slip_speed"], p["coefficient.low_speed"], fast)
        k = np.where(contact.pressure >= _threshold(p), p["coefficient.high_pressure"], below)
        density = contact.per_node(contact.density)
        rate: Array = density * k * contact.pressure * np.abs(contact.slip) / p["hardness"]
        return rate

    def breakpoints(self, p: wl.Numbers) -> wl.BreakpointMap:
        """Return the borders of the wear map."""
        return {
            "pressure": (_threshold(p),),
            "slip_speed": (p["lower_slip_speed"], p["upper_slip_speed"]),
        }

    def jumps(self, p: wl.Numbers) -> wl.BreakpointMap:
        """Return every border of the map: the rate jumps there."""
        return self.breakpoints(p)

    @cached_property
    def published(self) -> wl.Calibration | None:
        """The record of the published map; None with borders, coefficients or a hardness of your own."""
        ends: tuple[Literal["low", "mid", "high"], ...] = ("low", "mid", "high")
        return calibration() if _map(self) in [_map(KTH(coefficient=end)) for end in ends] else None

    def explicit(self) -> KTH:
        """Return this law with numbers for k."""
        if isinstance(self.coefficient, Coefficients):
            return self
        return self.model_copy(update={"coefficient": Coefficients(**PUBLISHED[self.coefficient])})

    def band(self) -> tuple[KTH, KTH, KTH]:
        """Return this law at the low end, middle and high end of k; your own values of k have no range."""
        if isinstance(self.coefficient, Coefficients):
            return self, self, self
        low, mid, high = (self.model_copy(update={"coefficient": end}) for end in ("low", "mid", "high"))
        return low, mid, high


def _threshold(p: wl.Numbers) -> Any:
    """Return the pressure at which seizure begins [Pa]."""
    return p["pressure_threshold"] if "pressure_threshold" in p else p["threshold_over_hardness"] * p["hardness"]


def _map(law: KTH) -> dict[str, float]:
    """Return the numbers of a law with its pressure threshold, however that is given."""
    return {**law.numbers, "pressure_threshold": _threshold(law.numbers)}


@wl.hookimpl
def wearlaw_models() -> list[type[wl.WearLaw]]:
    """Return the law of this plugin."""
    return [KTH]
