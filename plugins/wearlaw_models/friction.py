"""Friction that depends on the speed of sliding."""

from typing import TYPE_CHECKING, Annotated

import numpy as np
from pydantic import Field

from wearlaw import Array, Configuration, Quantity, QuantityLike, Unit, scalar_si


class FallingFriction(Configuration):
    """Friction that falls with the creep speed: μ = μ0 [(1 - A) exp(-B w) + A]. Use it instead of a coefficient.

    w is the magnitude of the rigid slip velocity at the centre of the patch, V √(ξ² + η²), without spin. It is one
    number for the whole patch, so any contact model can take the resulting friction. Friction that differs from point
    to point, with the local slip, is another theory.

    Notes
    -----
    O. Polach, Wear 258 (2005) 992-1000, eq. (9).
    """

    static_coefficient: Annotated[float, Field(gt=0.0, strict=True), Unit("", usual=(0.0, 2.0))]
    """Friction coefficient at rest, μ0 [-]."""
    limit_ratio: Annotated[float, Field(gt=0.0, le=1.0, strict=True)]
    """Friction coefficient at infinite creep speed over μ0, A [-]."""
    decay: Annotated[Quantity, Unit("s/m")]
    """Coefficient of the exponential fall, B [s/m]."""

    if TYPE_CHECKING:

        def __init__(
            self, *, static_coefficient: float | QuantityLike, limit_ratio: float | QuantityLike, decay: QuantityLike
        ) -> None: ...

    def coefficient(self, creep_speed: Array) -> Array:
        """Return μ [-] at creep speeds w ≥ 0 [m/s], of their shape."""
        falling = (1.0 - self.limit_ratio) * np.exp(-scalar_si(self.decay, "s/m") * creep_speed)
        coefficient: Array = self.static_coefficient * (falling + self.limit_ratio)
        return coefficient
