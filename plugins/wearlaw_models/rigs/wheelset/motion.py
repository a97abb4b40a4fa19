"""How wheels slide on their rails: creepages and spin at points of contact.

The velocity of the wheel at a place r from the middle of the axle is (V, v_y, 0) + ω × r. The wheelset turns about its
axle e at Ω and about the vertical at ω_z, that of its yaw and that of a curve, V over its radius. And it rolls about f
as it moves sideways, so that both wheels stay on their rails. So

    ω = -Ω e + ω_z z + ρ' f,  e = (-cos ρ sin ψ, cos ρ cos ψ, sin ρ),  f = (cos ψ, sin ψ, 0).

The bodies stay in contact, so the vertical velocity follows from the lateral one, v_z = v_y tan δ. With the tangent
(0, cos δ, sin δ) and the normal n = (0, -sin δ, cos δ) of the rail,

    ξ = v_x/V,  η = v_y/(V cos δ),  φ = ω·n/V.

All three are wheel minus rail. At small angles ξ = 1 - Ωr/V, η = ((v_y - ρ'r)/V - ψ)/cos δ and φ = sin δ/r.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from wearlaw import Array
from wearlaw_models.rigs.wheelset.search import Position, Section, gaps


class Place(NamedTuple):
    """Points of contact in outward coordinates, as arrays of one shape.

    Attributes
    ----------
    x, y, z : ndarray
        Place from the middle of the axle, forwards, outwards and down [m].
    angle : ndarray
        Contact angle, δ [rad].
    radius : ndarray
        Rolling radius, r [m].
    rail_arc : ndarray
        Arc length of the rail's profile [m].
    """

    x: Array
    y: Array
    z: Array
    angle: Array
    radius: Array
    rail_arc: Array


def placed(section: Section, position: Position, arc: Array) -> Place:
    """Return the points of contact at arc lengths of the wheel [m], at the mean of the slopes of wheel and rail."""
    at = gaps(section, position, arc)
    rail_arc, _ = section.at("rail_position", at.y, position.side)
    angle = np.arctan(at.rail_slope - 0.5 * at.rise)
    return Place(at.x, at.y - position.displacement, at.z, angle, at.radius, rail_arc)


def curvature_along(section: Section, position: Position, place: Place, arc: Array) -> Array:
    """Return the curvature of wheels along the rolling direction where they touch [1/m].

    Yaw turns the wheel's circles out of the rolling direction by θ in the plane of contact, tan θ = tan ψ/cos δ. With
    the curvature κ of the profile that of the surface is cos δ/r cos²θ + κ sin²θ (Euler). Where a hollow takes more
    than nine tenths of the first term, which no contact survives, a tenth stays.
    """
    cosine = np.cos(place.angle)
    square = (np.tan(position.yaw) / cosine) ** 2
    round_ = cosine / place.radius
    curved: Array = (round_ + section.at("wheel", arc, position.side)[3] * square) / (1.0 + square)
    return np.maximum(curved, 0.1 * round_)


def roll_rate(place: Place, lateral_velocity: Array, yaw_velocity: Array) -> Array:
    """Return the roll velocity at which both wheels stay on their rails [rad/s], positive if it lowers the right one.

    A side whose wheel moves outwards by dy and rolls by dρ opens its gap by tan δ dy - (y + z tan δ) dρ.

    Parameters
    ----------
    place : Place
        Points of contact of both sides, of shape (positions, 2).
    lateral_velocity, yaw_velocity : ndarray, (positions,)
        Velocities of the lateral displacement [m/s] and of the yaw [rad/s].
    """
    fall = np.tan(place.angle)
    opening = fall * (lateral_velocity[:, None] + yaw_velocity[:, None] * place.x)
    rate: Array = opening.sum(axis=-1) / (place.y + fall * place.z).sum(axis=-1)
    return rate


class Creepages(NamedTuple):
    """ξ [-], η [-] and φ [1/m] as linear functions of the speed of rotation: `still` + Ω `turning`."""

    still: tuple[Array, ...]
    turning: tuple[Array, ...]

    def at(self, speed: Array) -> list[Array]:
        """Return the creepages at speeds of rotation [rad/s]."""
        return [creepage + speed * rate for creepage, rate in zip(self.still, self.turning, strict=True)]

    def part(self, some: NDArray[np.bool_]) -> Creepages:
        """Return those of some points."""
        still, turning = (tuple(array[some] for array in arrays) for arrays in self)
        return Creepages(still, turning)


def creepages(
    position: Position,
    place: Place,
    speed: Array,
    lateral_velocity: Array,
    turn_rate: Array,
    roll_rate: Array,
    side: Array,
) -> Creepages:
    """Return the creepages in the axes of the track.

    Parameters
    ----------
    position : Position
    place : Place
    speed : ndarray
        V [m/s].
    lateral_velocity, turn_rate, roll_rate : ndarray
        v_y [m/s], ω_z and ρ' [rad/s], outward, so that they have opposite signs on the left.
    side : ndarray
        1 on the right and -1 on the left.
    """
    _, roll, yaw, _ = position
    axle = -np.cos(roll) * np.sin(yaw), np.cos(roll) * np.cos(yaw), np.sin(roll)
    rolling = roll_rate * np.cos(yaw), roll_rate * np.sin(yaw)
    upright = speed * np.cos(place.angle)
    still = (
        1.0 + (rolling[1] * place.z - turn_rate * place.y) / speed,
        side * (lateral_velocity + turn_rate * place.x - rolling[0] * place.z) / upright,
        side * (turn_rate * np.cos(place.angle) - rolling[1] * np.sin(place.angle)) / speed,
    )
    turning = (
        -(axle[1] * place.z - axle[2] * place.y) / speed,
        -side * (axle[2] * place.x - axle[0] * place.z) / upright,
        side * (axle[1] * np.sin(place.angle) - axle[2] * np.cos(place.angle)) / speed,
    )
    return Creepages(still, turning)
