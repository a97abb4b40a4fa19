"""Water between the bodies."""

from typing import Annotated, ClassVar

from pydantic import Field

import wearlaw as wl


class Wet(wl.Stage):
    """Friction that a film of water lowers: μ/(1 + V/V0)."""

    name: ClassVar[str] = "wet"
    source: ClassVar[str] = "made up for tests"

    half_speed: Annotated[wl.Quantity, wl.Unit("m/s")] = Field(default="1 m/s", validate_default=True)
    """Rolling speed at which friction is half as high as at rest, V0 [m/s]."""

    def altered(self, problem: wl.Problem, forces: wl.Forces) -> wl.Problem:
        """Return the problem with the lower friction coefficient."""
        share = 1.0 / (1.0 + problem.rolling_speed / wl.scalar_si(self.half_speed, "m/s"))
        return problem.replaced(friction_coefficient=share * problem.friction_coefficient)
