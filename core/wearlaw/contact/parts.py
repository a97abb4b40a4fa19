"""The parts of a contact problem and of its solution: bodies, strips of a patch, and forces."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Self

import numpy as np

from wearlaw.arrays import Array, freeze
from wearlaw.contact.material import Material
from wearlaw.units.quantities import scalar_si

OF_BODY = ("rolling_radius", "surface_radius", "profile_position", "profile_direction")
"""Values of a body that may be arrays of the batch shape."""


@dataclass(frozen=True)
class Body:
    """One of the two bodies in contact.

    Attributes
    ----------
    material : Material
        Its material.
    rolling_radius : float or ndarray
        Radius of the rolling surface [m], one for all operating points or an array of the batch shape; infinite for a
        flat or straight body, such as a rail.
    surface_radius : float, ndarray or None
        Radius of curvature of the surface along the rolling direction [m], if it is not the rolling radius: infinite
        for a disc that turns about the normal of its flat side.
    profile_position : ndarray, float or None
        Arc length along the body's profile at y = 0 of the patch [m]; None if it is not known. A rig may give an array
        that broadcasts to the batch shape.
    profile_direction : float or ndarray
        1 where the arc length grows with y, -1 where it falls, as on the left wheel if y is to the right and the arc
        runs outwards.
    usual_width : float
        Greatest usual half width of a patch on the body that is no line [m]; a wider one gets an `UnusualWarning`.
    """

    material: Material
    rolling_radius: float | Array
    profile_position: Array | float | None = None
    profile_direction: float | Array = 1.0
    surface_radius: float | Array | None = None
    usual_width: float = math.inf

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        freeze(self, OF_BODY)

    @cached_property
    def strength(self) -> tuple[float, float] | None:
        """Yield stress in shear [Pa] and Poisson's ratio of the material; None if the yield stress is unknown."""
        stress = self.material.shear_yield_stress
        return None if stress is None else (scalar_si(stress, "Pa"), self.material.poisson_ratio)

    @cached_property
    def youngs_modulus(self) -> float:
        """Young's modulus of the material, E [Pa]."""
        return scalar_si(self.material.youngs_modulus, "Pa")

    def mapped(self, function: Callable[[Array], Array]) -> Body:
        """Return the body with a function applied to those of its values that are arrays."""
        if not any(isinstance(getattr(self, name), np.ndarray) for name in OF_BODY):
            return self
        values: dict[str, Any] = {name: getattr(self, name) for name in OF_BODY}
        values |= {name: function(value) for name, value in values.items() if isinstance(value, np.ndarray)}
        return dataclasses.replace(self, **values)


_ZERO: Any = None
"""Default of an array that becomes zero."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Strips:
    """The strips of a patch that is not an ellipse, as SI arrays of shape (batch, strips).

    A strip lies along the rolling direction. At the distance r from its middle its pressure is p0 √(1 - (r/a)²), with
    p0 and a of the strip. Strips without width and pressure fill up patches with fewer strips than others of the batch;
    they add nothing.

    Attributes
    ----------
    y : ndarray
        Position of the strip across the rolling direction [m].
    width : ndarray
        Width that it represents [m].
    half_length : ndarray
        Half its length, a [m]; zero only where the width is zero.
    max_pressure : ndarray
        Its maximum pressure, p0 [Pa].
    x : ndarray
        Position of its middle along the rolling direction [m]; by default zero.
    longitudinal_creepage, lateral_creepage, spin : ndarray or None
        ξ [-], η [-] and φ [1/m] of the bodies in its middle, if radius or contact angle vary over the patch. Their
        means, weighted with the normal force, are those of the problem. None if the bodies slip as in the problem, by
        ξ - φy, η - φx and φ.
    """

    y: Array
    width: Array
    half_length: Array
    max_pressure: Array
    x: Array = _ZERO
    longitudinal_creepage: Array | None = None
    lateral_creepage: Array | None = None
    spin: Array | None = None

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        x: Any = self.x
        if x is None:
            object.__setattr__(self, "x", np.broadcast_to(0.0, self.y.shape))
        freeze(self, self.__slots__)

    @property
    def has_creepages(self) -> bool:
        """Whether the strips have creepages of their own."""
        creepages = self.longitudinal_creepage, self.lateral_creepage, self.spin
        return any(creepage is not None for creepage in creepages)

    @property
    def area(self) -> Array:
        """Area of each strip, 2a × width [m²]."""
        return 2.0 * self.half_length * self.width

    @property
    def normal_force(self) -> Array:
        """Normal force on each strip, π/4 of its area times its maximum pressure [N]."""
        return 0.25 * np.pi * self.area * self.max_pressure

    def pressure(self, x: Array) -> Array:
        """Return the pressure at positions x along the strips, (batch, nodes, strips) [Pa]."""
        half_length = np.where(self.half_length > 0.0, self.half_length, 1.0)  # of strips that fill up a batch
        share = (x - self.x[..., None, :]) / half_length[..., None, :]
        pressure: Array = self.max_pressure[..., None, :] * np.sqrt(np.maximum((1.0 - share) * (1.0 + share), 0.0))
        return pressure

    def mapped(self, function: Callable[[Array], Array], of_strips: Callable[[Array], Array] | None = None) -> Self:
        """Return the strips with a function of the batch applied to each of their arrays.

        `of_strips` is the same function for arrays with an axis of strips after the batch, if there is one. It is much
        faster.
        """
        arrays = {name: array for name in self.__slots__ if (array := getattr(self, name)) is not None}
        if of_strips is not None:
            return type(self)(**{name: of_strips(array) for name, array in arrays.items()})
        by_strip = {name: [function(strip) for strip in np.moveaxis(array, -1, 0)] for name, array in arrays.items()}
        return type(self)(**{name: np.stack(strips, axis=-1) for name, strips in by_strip.items()})


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LineFields:
    """Pressure, traction, slip and traction bound at points of a line contact, as in `Contact`."""

    pressure: Array
    traction: Array
    slip: Array
    traction_bound: Array


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class CreepForces:
    """The forces and the moment transmitted by a contact, as SI arrays of the batch shape.

    Attributes
    ----------
    longitudinal : ndarray
        Longitudinal force [N], with the sign of the longitudinal creepage.
    lateral : ndarray
        Lateral force [N], with the sign of the lateral creepage and of the spin.
    spin_moment : ndarray
        Spin moment, Mz [N m], -∫ (x qy + y qx) dA, with the sign of the spin.
    power : ndarray or None
        Energy dissipated per metre rolled [N], Σ ξFx + ηFy + φMz over strips with creepages of their own; None if it
        follows from the creepages of the problem.
    """

    longitudinal: Array
    lateral: Array
    spin_moment: Array
    power: Array | None = None

    @classmethod
    def of_line(cls, force: Array) -> Self:
        """Return the forces of a line, which has a longitudinal force alone [N]."""
        shape = getattr(force, "shape", ())  # what a model returns is checked later
        none: Any = np.broadcast_to(0.0, shape) if shape else np.float64(0.0)
        return cls(longitudinal=force, lateral=none, spin_moment=none)

    @property
    def tangential(self) -> Array:
        """Magnitude of the tangential force [N]."""
        force: Array = np.hypot(self.longitudinal, self.lateral)
        return force
