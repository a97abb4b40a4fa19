"""The temperature in the patch, a law of another outcome than wear."""

from typing import ClassVar

import numpy as np

import wearlaw as wl
from wearlaw_outside.material import MADE_UP_STEEL, HeatedSteel


class Flash(wl.Law):
    """Rise of the surface temperature of two like bodies: 2 (q/2) √(t/π)/√(λρc), after the time t = 2a/V.

    The heat flux q is the mean over the patch, and half of it flows into each body.
    """

    name: ClassVar[str] = "flash"
    source: ClassVar[str] = "H. S. Carslaw, J. C. Jaeger, Conduction of Heat in Solids, 2nd ed., Oxford 1959, 2.9"
    outcome: ClassVar[wl.Outcome] = wl.Outcome(
        "flash_temperature",
        unit="K",
        of="patch",
        long_name="flash temperature Θ",
        meaning="Rise of the surface temperature at the trailing edge",
        symbol="Θ",
    )
    example_material: ClassVar[wl.Material | None] = MADE_UP_STEEL

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> wl.Array:
        """Return the rise at the trailing edge [K]."""
        material = contact.body().material
        if not isinstance(material, HeatedSteel):
            raise wl.InputError("material: the law 'flash' needs a HeatedSteel with a conductivity and a heat capacity")
        flux = contact.wear_index * contact.rolling_speed / contact.patch_area
        time = 2.0 * contact.half_width / contact.rolling_speed
        return flux * np.sqrt(time / np.pi) / material.effusivity
