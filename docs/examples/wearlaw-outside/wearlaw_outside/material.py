"""A steel with its thermal properties."""

from typing import TYPE_CHECKING, Annotated

import numpy as np

import wearlaw as wl


class HeatedSteel(wl.Material):
    """A steel with its thermal properties."""

    conductivity: Annotated[wl.Quantity, wl.Unit("W/m/K")]
    """Thermal conductivity, λ [W/(m K)]."""
    heat_capacity: Annotated[wl.Quantity, wl.Unit("J/kg/K")]
    """Specific heat capacity, c [J/(kg K)]."""

    if TYPE_CHECKING:  # checkers do not know that a text is accepted for a quantity

        def __init__(
            self,
            *,
            youngs_modulus: wl.QuantityLike,
            poisson_ratio: float,
            density: wl.QuantityLike,
            shear_yield_stress: wl.QuantityLike | None = None,
            conductivity: wl.QuantityLike,
            heat_capacity: wl.QuantityLike,
        ) -> None: ...

    @property
    def effusivity(self) -> float:
        """√(λρc) [W √s/(m² K)]."""
        heat = wl.scalar_si(self.heat_capacity, "J/kg/K") * wl.scalar_si(self.density, "kg/m^3")
        return float(np.sqrt(wl.scalar_si(self.conductivity, "W/m/K") * heat))


MADE_UP_STEEL = HeatedSteel(
    youngs_modulus="208 GPa",
    poisson_ratio=0.29,
    density="7800 kg/m^3",
    conductivity="50 W/m/K",
    heat_capacity="450 J/kg/K",
)
"""Made up for tests."""
