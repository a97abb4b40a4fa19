"""Line contact: the problem that a contact model is asked to solve, and the fields that solve it.

Both are frozen and hold SI float64 arrays, whose first axes are the *batch*, one entry an operating point.
"""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import Self

import numpy as np

from wearlaw.arrays import Array
from wearlaw.batch import Batch


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LineProblem(Batch):
    """Hertzian line contact between two rolling bodies: what a contact model is asked to solve.

    All arrays are of the batch shape. Lengths lie along the rolling direction x, which runs from the leading
    edge at x = -half_width to the trailing edge at x = half_width.

    Attributes
    ----------
    normal_force_per_width : ndarray
        Normal force per unit width, P [N/m].
    half_width : ndarray
        Half the patch's length in the rolling direction, a [m].
    max_pressure : ndarray
        Hertz's maximum pressure, p0 [Pa].
    relative_radius : ndarray
        Relative radius of curvature, R [m], 1/R = 1/R1 + 1/R2.
    effective_modulus : ndarray
        Effective modulus, E* [Pa], 1/E* = (1-ν1²)/E1 + (1-ν2²)/E2.
    friction_coefficient : ndarray
        Friction coefficient, μ [-].
    creepage : ndarray
        Creepage, ξ [-], with its sign; positive where disc 1 is the faster one.
    rolling_speed : ndarray
        Rolling speed, V [m/s].
    track_width : ndarray
        Width of the patch across the rolling direction [m].
    density : ndarray
        Mass density of the body whose wear is predicted, ρ [kg/m³].
    traction_coefficient : ndarray or None
        Measured tangential over normal force, T/N [-], where the test gave one.
    """

    normal_force_per_width: Array
    half_width: Array
    max_pressure: Array
    relative_radius: Array
    effective_modulus: Array
    friction_coefficient: Array
    creepage: Array
    rolling_speed: Array
    track_width: Array
    density: Array
    traction_coefficient: Array | None = None

    @property
    def batch_shape(self) -> tuple[int, ...]:
        """The shape of the batch, () for one operating point."""
        return self.creepage.shape

    @property
    def normal_force(self) -> Array:
        """Normal force on the whole width, N [N]."""
        return self.normal_force_per_width * self.track_width

    @property
    def patch_area(self) -> Array:
        """Area of the patch, 2 a × width, A [m²]."""
        return 2.0 * self.half_width * self.track_width

    def forward(self) -> Self:
        """Return the problem with the magnitude of the creepage."""
        lowest = self.creepage.min() if self.creepage.ndim else self.creepage
        return self if lowest >= 0.0 else dataclasses.replace(self, creepage=np.abs(self.creepage))


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LineFields:
    """Pressure, traction, slip and traction bound at points of a line contact, as in `Contact`."""

    pressure: Array
    traction: Array
    slip: Array
    traction_bound: Array
