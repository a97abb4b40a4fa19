"""Elliptic contact: the problem that a contact model is asked to solve, and the forces that come of it.

x runs along the rolling direction, from the leading to the trailing edge, and y across it. Creepages are those of the
upper body, the wheel, relative to the lower one, the rail; the rigid slip is (ξ - φy, η - φx).
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Self

import numpy as np

from wearlaw.arrays import Array
from wearlaw.batch import Batch
from wearlaw.conditions import CREEPAGE, SPIN, broadcast
from wearlaw.errors import InputError, UnitError
from wearlaw.units import QuantityLike, Unit, coefficient, real_array

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

UNITS = {
    "a": Unit("mm"),
    "b": Unit("mm"),
    "normal_force": Unit("kN"),
    "shear_modulus": Unit("GPa"),
    "longitudinal_creepage": CREEPAGE,
    "lateral_creepage": CREEPAGE,
    "spin": SPIN,
    "rolling_speed": Unit("m/s"),
    "density": Unit("kg/m^3"),
}
"""The units that an `EllipticProblem` is due."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class CreepForces:
    """The forces and the moment that a contact transmits, as SI arrays of the batch shape.

    Attributes
    ----------
    longitudinal : ndarray
        Longitudinal force [N], with the sign of the longitudinal creepage.
    lateral : ndarray
        Lateral force [N], with the sign of the lateral creepage and of the spin.
    spin_moment : ndarray
        Spin moment, Mz [N m], -∫ (x qy + y qx) dA, with the sign of the spin.
    """

    longitudinal: Array
    lateral: Array
    spin_moment: Array

    @classmethod
    def of(cls, columns: Mapping[str, Array]) -> Self:
        """Return the forces that are among some columns; those of a line have no lateral force and no moment."""
        none = np.broadcast_to(0.0, columns["longitudinal"].shape)
        return cls(**{field.name: columns.get(field.name, none) for field in dataclasses.fields(cls)})

    @property
    def tangential(self) -> Array:
        """Magnitude of the tangential force [N]."""
        force: Array = np.hypot(self.longitudinal, self.lateral)
        return force


@dataclass(frozen=True, slots=True, kw_only=True, eq=False, init=False)
class EllipticProblem(Batch):
    """Hertzian contact over an ellipse between two rolling bodies: what a contact model is asked to solve.

    The arguments are quantities, which broadcast against each other; the attributes are SI arrays of the batch shape.
    Both bodies have the same elastic constants.

    Attributes
    ----------
    a : ndarray
        Semi-axis of the patch in the rolling direction [m].
    b : ndarray
        Semi-axis of the patch across the rolling direction [m].
    normal_force : ndarray
        Normal force, N [N].
    shear_modulus : ndarray
        Shear modulus, G [Pa].
    poisson_ratio : ndarray
        Poisson's ratio, ν [-].
    friction_coefficient : ndarray
        Friction coefficient, μ [-].
    longitudinal_creepage : ndarray
        Longitudinal creepage, ξ [-].
    lateral_creepage : ndarray
        Lateral creepage, η [-].
    spin : ndarray
        Spin, φ [1/m], the relative angular velocity about the normal over the rolling speed.
    rolling_speed : ndarray
        Rolling speed, V [m/s]; it matters to what reads the slip speed.
    density : ndarray
        Mass density of the body whose wear is predicted, ρ [kg/m³].
    """

    a: Array
    b: Array
    normal_force: Array
    shear_modulus: Array
    poisson_ratio: Array
    friction_coefficient: Array
    longitudinal_creepage: Array
    lateral_creepage: Array
    spin: Array
    rolling_speed: Array
    density: Array

    def __init__(
        self,
        *,
        a: QuantityLike,
        b: QuantityLike,
        normal_force: QuantityLike,
        shear_modulus: QuantityLike,
        poisson_ratio: ArrayLike,
        friction_coefficient: ArrayLike,
        longitudinal_creepage: QuantityLike,
        lateral_creepage: QuantityLike,
        spin: QuantityLike,
        rolling_speed: QuantityLike = "1 m/s",
        density: QuantityLike = "7850 kg/m^3",
    ) -> None:
        given = {
            "a": a,
            "b": b,
            "normal_force": normal_force,
            "shear_modulus": shear_modulus,
            "longitudinal_creepage": longitudinal_creepage,
            "lateral_creepage": lateral_creepage,
            "spin": spin,
            "rolling_speed": rolling_speed,
            "density": density,
        }
        arrays = {name: UNITS[name].si(value, name) for name, value in given.items()}
        arrays["friction_coefficient"] = coefficient(friction_coefficient, "friction_coefficient")
        arrays["poisson_ratio"] = _poisson_ratio(poisson_ratio)
        self._set(broadcast(arrays))

    @classmethod
    def from_si(cls, **arrays: Array) -> Self:
        """Return the problem of SI arrays of one shape, one for each attribute."""
        problem = cls.__new__(cls)
        problem._set(arrays)
        return problem

    def _set(self, arrays: dict[str, Array]) -> None:
        for name, array in arrays.items():
            object.__setattr__(self, name, array)

    @property
    def batch_shape(self) -> tuple[int, ...]:
        """The shape of the batch, () for one operating point."""
        return self.longitudinal_creepage.shape

    @property
    def max_pressure(self) -> Array:
        """Hertz's maximum pressure, p0 [Pa], 3N/(2πab)."""
        return 1.5 * self.normal_force / self.patch_area

    @property
    def patch_area(self) -> Array:
        """Area of the patch, A [m²], πab."""
        return np.pi * self.a * self.b

    @property
    def rigid_slip(self) -> Array:
        """Root mean square of the rigid slip over the patch [-], √(ξ² + η² + φ²(a² + b²)/4)."""
        turning = 0.25 * self.spin**2 * (self.a**2 + self.b**2)
        slip: Array = np.sqrt(self.longitudinal_creepage**2 + self.lateral_creepage**2 + turning)
        return slip

    def with_creepages(self, longitudinal: Array, lateral: Array, spin: Array) -> Self:
        """Return the problem at other creepages, as SI arrays of the batch shape."""
        creepages = {"longitudinal_creepage": longitudinal, "lateral_creepage": lateral, "spin": spin}
        arrays: dict[str, Array] = {field.name: getattr(self, field.name) for field in dataclasses.fields(self)}
        return self.from_si(**(arrays | creepages))

    def power(self, forces: CreepForces) -> Array:
        """Return the energy dissipated per metre rolled, Tγ = ξFx + ηFy + φMz [N]."""
        return (
            self.longitudinal_creepage * forces.longitudinal
            + self.lateral_creepage * forces.lateral
            + self.spin * forces.spin_moment
        )


def _poisson_ratio(value: object) -> Array:
    try:
        ratio = real_array(value)
    except UnitError as error:
        raise UnitError(f"poisson_ratio: {error}; give a plain number, such as 0.28") from None
    if not ((ratio >= 0.0) & (ratio <= 0.5)).all():
        raise InputError(f"poisson_ratio: must lie between 0 and 0.5, got {value!r}")
    return ratio
