"""The wear law of the University of Sheffield (USFD)."""

from __future__ import annotations

from functools import cache
from typing import Annotated, Any, ClassVar, Literal

import numpy as np
from pydantic import field_validator, model_validator

import wearlaw as wl
from wearlaw import Array

TASSINI = "Tassini et al., Wear 268 (2010) 660-667"
TESTS = (
    "R. Lewis and R. S. Dwyer-Joyce, Proc. IMechE J 218(6) (2004) 467-478, Table 1, read in a secondary transcription"
)
MATERIALS = "R8T wheel steel on UIC 60 900A rail steel"

PARAMETERS = {
    "global": {"m_m": "5.3 ug/m/N", "q_s": "55 ug/m/mm^2", "m_c": "61.9 ug/m/N", "tr_sc": "77.26 N/mm^2"},
    "exact": {"m_m": "5.3 ug/m/N", "q_s": "55 ug/m/mm^2", "m_c": "83.7 ug/m/N", "tr_sc": "95 N/mm^2"},
    "fastsim": {"m_m": "5.3 ug/m/N", "q_s": "56.5 ug/m/mm^2", "m_c": "83.7 ug/m/N", "tr_sc": "107 N/mm^2"},
}
"""Table 4 of Tassini et al. (2010)."""

TESTED = (
    ("pressure", "706.8 MPa", "1413.8 MPa"),
    ("slip_speed", "0 m/s", "0.197 m/s"),
    ("wear_index_density", "0 N/mm^2", "108.4 N/mm^2"),
)
"""Range of the means over the patch in the tests, rounded outwards.

The tests had maximum pressures from 900 to 1800 MPa, of which the mean is π/4, and creepages up to 20 % at 400 rpm on
discs of 47 mm, which is 0.984 m/s. If disc 1 kept that speed, the highest slip speed was 0.179 m/s; if the mean did, it
was 0.197 m/s. The source does not say which, so the range has the higher one. At 20 % the pressure was 1500 MPa: Tγ/A
is 0.2 · 0.46 · (π/4) 1500 MPa with the μ of the paper. The lower ends of slip speed and Tγ/A are those of the law, at
which nothing wears.
"""

Slope = Annotated[wl.Quantity, wl.Unit("ug/m/N")]
WearRate = Annotated[wl.Quantity, wl.Unit("ug/m/mm^2")]
WearIndexDensity = Annotated[wl.Quantity, wl.Unit("N/mm^2")]


@cache
def calibrations() -> dict[str, wl.Calibration]:
    """Return the calibration of each published set."""
    contacts: dict[str, dict[str, Any]] = {
        "global": {"scale": "patch"},
        "exact": {"scale": "cells"},
        "fastsim": {"scale": "cells", "options": (("bound", "parabolic"),)},
    }
    return {
        name: wl.Calibration(
            contact_model=name,
            **contact,
            materials=MATERIALS,
            bodies=(wl.steel(), wl.steel()),
            stated_range=TESTED,
            source=f"parameters: {TASSINI}, Table 4; tests: {TESTS}",
        )
        for name, contact in contacts.items()
    }


class USFD(wl.WearLaw):
    """Wear rate against w = Tγ/A in three regimes, continuous at both borders.

    mild, w < q_s/m_m: m_m w; severe, w < tr_sc: q_s; catastrophic: q_s + m_c (w - tr_sc).
    """

    name: ClassVar[str] = "usfd"
    source: ClassVar[str] = f"{TASSINI}, Tables 3 and 4"
    monotone_in: ClassVar[tuple[wl.LawVariable, ...]] = ("wear_index_density",)

    fitted_for: Literal["global", "exact", "fastsim"] | wl.Calibration = "global"  # type: ignore[assignment]
    """The contact solution to which the parameters were fitted. A name also chooses a published set, which fills in
    parameters that you do not give. For a set of your own, give a Calibration."""
    m_m: Slope
    """Slope of the mild regime, m_m [µg/m/N]."""
    q_s: WearRate
    """Wear rate of the severe regime, q_s [µg/m/mm²]."""
    m_c: Slope
    """Slope of the catastrophic regime, m_c [µg/m/N]."""
    tr_sc: WearIndexDensity
    """Tγ/A at the transition from the severe to the catastrophic regime, tr_sc [N/mm²]."""

    @field_validator("fitted_for", mode="before")
    @classmethod
    def _name_or_calibration(cls, value: Any) -> Any:
        if isinstance(value, dict):
            return wl.Calibration(**value)
        if isinstance(value, wl.Calibration) or (isinstance(value, str) and value in PARAMETERS):
            return value
        raise ValueError(f"must be 'global', 'exact' or 'fastsim', or the Calibration of your own set, got {value!r}")

    @model_validator(mode="before")
    @classmethod
    def _published(cls, fields: Any) -> Any:
        """Fill in parameters that are not given from the published set."""
        if not isinstance(fields, dict):
            return fields
        chosen = fields.get("fitted_for", "global")
        return {**PARAMETERS.get(chosen, PARAMETERS["global"]), **fields} if isinstance(chosen, str) else fields

    @model_validator(mode="after")
    def _ordered(self) -> USFD:
        if self.q_s / self.m_m > self.tr_sc:
            raise ValueError(
                f"tr_sc must not lie below q_s/m_m = {(self.q_s / self.m_m).to('N/mm^2')!r}, where the severe"
                f" regime begins; got {self.tr_sc!r}"
            )
        return self

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Array:
        """Return the wear rate at the nodes [kg/m/m²]."""
        w = contact.wear_index_density
        return np.minimum(p["m_m"] * w, p["q_s"]) + p["m_c"] * np.maximum(w - p["tr_sc"], 0.0)

    def breakpoints(self, p: wl.Numbers) -> wl.BreakpointMap:
        """Return the mild/severe and the severe/catastrophic border."""
        return {"wear_index_density": (p["q_s"] / p["m_m"], p["tr_sc"])}

    def ramps(self, p: wl.Numbers) -> tuple[tuple[Any, Any], ...]:
        """Return the rise of the mild regime, its end at the border, and the rise of the catastrophic regime."""
        return (0.0, p["m_m"]), (p["q_s"] / p["m_m"], -p["m_m"]), (p["tr_sc"], p["m_c"])

    @property
    def published(self) -> wl.Calibration | None:
        """The record of the set that `fitted_for` names."""
        return calibrations()[self.fitted_for] if isinstance(self.fitted_for, str) else None


@wl.hookimpl
def wearlaw_models() -> list[type[wl.WearLaw]]:
    """Return the law of this plugin."""
    return [USFD]
