"""The wear law of British Rail Research (BRR)."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cache, cached_property
from typing import Annotated, Any, ClassVar, Literal

import numpy as np
from pydantic import Field, model_validator

import wearlaw as wl
from wearlaw import Array

SectionPerForce = Annotated[wl.Quantity, wl.Unit("mm^3/km/N")]
Section = Annotated[wl.Quantity, wl.Unit("mm^3/km")]
Force = Annotated[wl.Quantity, wl.Unit("N")]

WITHOUT_SPIN = wl.Variable(
    "wear_index_without_spin",
    unit="N",
    meaning="Wear index without the part of the spin, ξFx + ηFy",
    symbol="ξFx + ηFy",
)

ROUNDING = 1e-12
"""Relative difference below which two regimes count as continuous."""


@cache
def calibration() -> wl.Calibration:
    """Return the record of the published law, without a range: the paper prints none."""
    return wl.Calibration(
        contact_model="any",
        scale="patch",
        geometry="any",
        materials="R8T wheel steel on BS11 rail steel",
        bodies=(wl.steel(), wl.steel()),
        source=(
            "T. G. Pearce and N. D. Sherratt, Wear 144 (1991) 343-351, after Tassini et al., Wear 268 (2010) 660-667,"
            " section 4.1, which prints no range"
        ),
    )


class BRR(wl.WearLaw):
    """Area of a radial section lost per distance rolled, times the wheel diameter D, against Tγ.

    mild, Tγ < 100 N: 0.25 Tγ; 100 N ≤ Tγ < 200 N: 25; severe, Tγ ≥ 200 N: 1.19 Tγ - 154, in mm² mm/km.

    Area × πD is the volume lost per distance, so D cancels in the wear rate, which is ρπ/A times the values above. At
    200 N the published law jumps from 25 to 84. wearlaw keeps the jump.
    """

    name: ClassVar[str] = "brr"
    source: ClassVar[str] = (
        "T. G. Pearce and N. D. Sherratt, Wear 144 (1991) 343-351, after Tassini et al., Wear 268 (2010) 660-667,"
        " Table 1"
    )
    scale: ClassVar[Literal["patch", "any"]] = "patch"
    monotone_in: ClassVar[tuple[wl.LawVariable, ...]] = ("wear_index",)

    mild_slope: SectionPerForce = Field(default="0.25 mm^3/km/N", validate_default=True)
    """Slope of the mild regime, section × D over Tγ [mm³/km/N]."""
    plateau: Section = Field(default="25 mm^3/km", validate_default=True)
    """Section × D between the two borders [mm³/km]."""
    severe_slope: SectionPerForce = Field(default="1.19 mm^3/km/N", validate_default=True)
    """Slope of the severe regime, section × D over Tγ [mm³/km/N]."""
    severe_offset: Section = Field(default="154 mm^3/km", validate_default=True)
    """Offset of the severe regime, subtracted from slope × Tγ [mm³/km]."""
    mild_limit: Force = Field(default="100 N", validate_default=True)
    """Tγ at which the plateau begins [N]."""
    severe_limit: Force = Field(default="200 N", validate_default=True)
    """Tγ at which the severe regime begins [N]."""

    spin: Literal["included", "left_out"] = "included"
    """Whether Tγ has the part of the spin: "included" takes ξFx + ηFy + φMz, "left_out" ξFx + ηFy, as many vehicle
    programs do. A negative ξFx + ηFy wears nothing."""

    @model_validator(mode="after")
    def _never_falls(self) -> BRR:
        mild_end, plateau, severe_start = _at_borders(self.numbers)
        if self.severe_limit < self.mild_limit:
            raise ValueError(
                f"severe_limit must not lie below mild_limit = {self.mild_limit!r}; got {self.severe_limit!r}"
            )
        if mild_end > plateau * (1.0 + ROUNDING) or plateau > severe_start * (1.0 + ROUNDING):
            raise ValueError("the wear must not fall where a regime begins; check its slope, offset and limit")
        return self

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Array:
        """Return the wear rate of the one node [kg/m/m²]."""
        tgamma = contact.wear_index if self.spin == "included" else np.maximum(contact.wear_index_without_spin, 0.0)
        index = contact.per_node(tgamma)
        section_times_diameter = np.select(
            [index < p["mild_limit"], index < p["severe_limit"]],
            [p["mild_slope"] * index, p["plateau"]],
            p["severe_slope"] * index - p["severe_offset"],
        )
        density, area = contact.per_node(contact.density), contact.per_node(contact.patch_area)
        return np.broadcast_to(density * np.pi * section_times_diameter / area, contact.pressure.shape)

    def breakpoints(self, p: wl.Numbers) -> wl.BreakpointMap:
        """Return the borders of the regimes."""
        return {self._variable: (p["mild_limit"], p["severe_limit"])}

    def jumps(self, p: wl.Numbers) -> wl.BreakpointMap:
        """Return the start of the severe regime for the published numbers, or else each border with a jump."""
        mild_end, plateau, severe_start = _at_borders(p)
        steps = ((p["mild_limit"], plateau - mild_end), (p["severe_limit"], severe_start - plateau))
        return {self._variable: tuple(limit for limit, step in steps if np.any(step > ROUNDING * plateau))}

    @property
    def _variable(self) -> str:
        return "wear_index" if self.spin == "included" else WITHOUT_SPIN.name

    @property
    def own_variables(self) -> Mapping[wl.Variable, Callable[[wl.Contact], Array]]:
        """Tγ without the part of the spin, if that is left out."""
        return {} if self.spin == "included" else {WITHOUT_SPIN: _without_spin}

    @cached_property
    def published(self) -> wl.Calibration | None:
        """The record of the published law; None with numbers of your own."""
        return calibration() if self.numbers == BRR().numbers else None


def _without_spin(contact: wl.Contact) -> Array:
    """Return Tγ without the part of the spin at the nodes."""
    return np.broadcast_to(contact.per_node(contact.wear_index_without_spin), contact.pressure.shape)


def _at_borders(p: wl.Numbers) -> tuple[Any, Any, Any]:
    """Return section × D at the end of the mild regime, on the plateau, and at the start of the severe regime."""
    return p["mild_slope"] * p["mild_limit"], p["plateau"], p["severe_slope"] * p["severe_limit"] - p["severe_offset"]


@wl.hookimpl
def wearlaw_models() -> list[type[wl.WearLaw]]:
    """Return the law of this plugin."""
    return [BRR]
