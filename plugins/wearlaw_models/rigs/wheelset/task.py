"""What is asked of a wheelset at each position."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

import wearlaw as wl
from wearlaw import Array


@dataclass(frozen=True)
class Elastic:
    """E* [Pa], G [Pa] and ν of the pair, and the density of the wheel [kg/m³]."""

    modulus: float
    shear_modulus: float
    poisson_ratio: float
    density: float


Patch: TypeAlias = Literal["strips", "ellipse"]

Friction: TypeAlias = Array | wl.FallingFriction


@dataclass(frozen=True)
class Task:
    """What is asked of a wheelset at each position, as SI arrays of shape (positions,) except where stated.

    Attributes
    ----------
    displacement, yaw : ndarray
        u [m], where the wheelset begins, and ψ [rad].
    due : ndarray
        Displacement that is asked for [m].
    speed, lateral_velocity, yaw_velocity, turn_rate : ndarray
        V and v_y [m/s], the rate of the yaw and ω_z [rad/s].
    load : ndarray, (positions, 2)
        Vertical load of each wheel, Q [N].
    bears : ndarray of bool, (positions, 2)
        Whether each wheel bears a load; the small load of one that does not is left out of the results.
    friction : pair of ndarray or FallingFriction
        Friction coefficient on the tread and on the flange [-].
    flange_angle : float
        Contact angle beyond which a patch is one of the flange [rad].
    torque : ndarray
        Torque on the axle, M [N m], positive if it drives.
    rotation : ndarray or None
        Given speed of rotation, Ω [rad/s]; the torque then follows.
    roll : ndarray or None
        Given roll, ρ [rad], which stays and has no rate; if it is None, the wheelset finds its roll.
    lateral_force : ndarray or None
        Given sum of the lateral forces on the rails, H [N]; the displacement then follows.
    conditions : mapping of str to ndarray
        Conditions of contact models and stages.
    loops : bool
        Whether compiled loops find the pressure, by the size of the whole task.
    """

    displacement: Array
    due: Array
    yaw: Array
    speed: Array
    lateral_velocity: Array
    yaw_velocity: Array
    turn_rate: Array
    load: Array
    bears: NDArray[np.bool_]
    friction: tuple[Friction, Friction]
    flange_angle: float
    torque: Array
    rotation: Array | None
    roll: Array | None
    lateral_force: Array | None = None
    loops: bool = False
    conditions: Mapping[str, Array] = field(default_factory=dict)

    @property
    def free(self) -> bool:
        """Whether the wheelset finds its roll."""
        return self.roll is None

    def part(self, points: NDArray[np.intp]) -> Task:
        """Return what is asked at some positions."""
        some: dict[str, Any] = {
            name: array[points] for name, array in vars(self).items() if isinstance(array, np.ndarray)
        }
        some["friction"] = tuple(mu[points] if isinstance(mu, np.ndarray) else mu for mu in self.friction)
        some["conditions"] = {name: array[points] for name, array in self.conditions.items()}
        return replace(self, **some)

    def friction_of(self, point: NDArray[np.intp], flange: Array, creep_speed: Array) -> Array:
        """Return friction coefficients of patches [-] by their shares of load on the flange and creep speeds [m/s]."""
        tread, on_flange = (
            mu[point] if isinstance(mu, np.ndarray) else mu.coefficient(creep_speed) for mu in self.friction
        )
        return np.asarray(tread + flange * (on_flange - tread))
