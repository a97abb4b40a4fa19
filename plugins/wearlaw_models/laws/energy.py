"""Wear in proportion to the energy of friction, mild or severe."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, ClassVar

import numpy as np
from pydantic import Field, model_validator

import wearlaw as wl
from wearlaw import Array

MassPerEnergy = Annotated[wl.Quantity, wl.Unit("ug/J")]
PowerDensity = Annotated[wl.Quantity, wl.Unit("W/mm^2")]
EnergyDensity = Annotated[wl.Quantity, wl.Unit("N/mm^2")]


class Energy(wl.WearLaw):
    """Mass lost in proportion to the energy of friction, with more mass per energy in severe wear.

    At a node the rate is the mass per energy times q s. Wear is mild below a limit and severe at and above it, so the
    rate jumps there. The limit is one of the frictional power over area, q s V, or of the energy over area, q s, which
    for the whole patch is Tγ/A. Without a limit, the mass per energy is the same everywhere.

    Krause and Poll (1986) find the worn volume proportional to the frictional work, and its factor a function of the
    frictional power over area, which governs the temperature of the surfaces and so the transition from mild to severe
    wear. No field has a default: take the numbers from the paper whose materials are yours. `wearlaw.wear_coefficient`
    converts a volume per energy.

    Prefer a limit in power where the heat of friction brings severe wear on, so that it begins at a lower creepage at
    high speed. A limit in energy gives the same at all speeds, as `usfd` does.
    """

    name: ClassVar[str] = "energy"
    source: ClassVar[str] = (
        "H. Krause and G. Poll, Wear 113 (1986) 103-122; see also I. Zobory, Vehicle System Dynamics 28 (1997) 221-259"
    )
    monotone_in: ClassVar[tuple[wl.LawVariable, ...]] = ("wear_index_density",)
    example_fields: ClassVar[Mapping[str, Any]] = {"mass_per_energy": "5 ug/J"}

    mass_per_energy: Annotated[MassPerEnergy, Field(examples=["1 ug/J"])]
    """Mass lost per energy of friction, in mild wear if there is a limit [µg/J]."""
    severe_mass_per_energy: MassPerEnergy | None = None
    """Mass lost per energy of friction in severe wear [µg/J]."""
    power_limit: PowerDensity | None = None
    """Frictional power over area, qsV, at and above which wear is severe [W/mm²]. In print it may stand in N/(mm s), a
    thousandth of this unit."""
    energy_limit: EnergyDensity | None = None
    """Energy of friction per distance rolled and area, Tγ/A, at and above which wear is severe [N/mm²]."""

    @model_validator(mode="after")
    def _mild_and_severe(self) -> Energy:
        if self.power_limit is not None and self.energy_limit is not None:
            raise ValueError("give one limit, power_limit or energy_limit, not both")
        if self.severe_mass_per_energy is None:
            if self._limit is not None:
                raise ValueError(f"{self._limit[0]} needs severe_mass_per_energy, which holds from it on")
            return self
        if self._limit is None:
            raise ValueError("severe_mass_per_energy needs the limit at which it begins: power_limit or energy_limit")
        if self.severe_mass_per_energy < self.mass_per_energy:
            raise ValueError(
                f"severe_mass_per_energy must not be below mass_per_energy = {self.mass_per_energy!r}; got"
                f" {self.severe_mass_per_energy!r}"
            )
        return self

    @property
    def _limit(self) -> tuple[str, str] | None:
        """Name of the given limit, and the variable that it limits."""
        if self.power_limit is not None:
            return "power_limit", "frictional_power_density"
        return None if self.energy_limit is None else ("energy_limit", "wear_index_density")

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Array:
        """Return the wear rate at the nodes [kg/m/m²]."""
        per_energy: Any = p["mass_per_energy"]
        if self._limit is not None:
            limit, variable = self._limit
            per_energy = np.where(getattr(contact, variable) < p[limit], per_energy, p["severe_mass_per_energy"])
        rate: Array = per_energy * contact.wear_index_density
        return rate

    def breakpoints(self, p: wl.Numbers) -> wl.BreakpointMap:
        """Return the limit."""
        if self._limit is None:
            return {}
        limit, variable = self._limit
        return {variable: (p[limit],)}

    def jumps(self, p: wl.Numbers) -> wl.BreakpointMap:
        """Return the limit, unless the mass per energy is the same on both sides."""
        same = self._limit is None or np.all(p["severe_mass_per_energy"] == p["mass_per_energy"])
        return {} if same else self.breakpoints(p)

    def ramps(self, p: wl.Numbers) -> tuple[tuple[Any, Any], ...] | None:
        """Return the whole law without a limit; a law that jumps is no sum of ramps."""
        return ((0.0, p["mass_per_energy"]),) if self._limit is None else None


@wl.hookimpl
def wearlaw_models() -> list[type[wl.WearLaw]]:
    """Return the law of this plugin."""
    return [Energy]
