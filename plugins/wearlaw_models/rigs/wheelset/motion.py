"""How wheels slide on their rails: creepages and spin at points of contact.

The velocity of the wheel at a place r from the middle of the axle is (V, v_y, 0) + ω × r. The wheelset turns about its
axle e at Ω and about the vertical at ω_z, that of its yaw and that of a curve, V over its radius. And it rolls about f
as it moves sideways, so that both wheels stay on their rails. So

    ω = -Ω e + ω_z z + ρ' f,  e = (-cos ρ sin ψ, cos ρ cos ψ, sin ρ),  f = (cos ψ, sin ψ, 0).

The bodies stay in contact, so the vertical velocity follows from the lateral one, v_z = v_y tan δ. With the tangent
(0, cos δ, sin δ) and the normal n = (0, -sin δ, cos δ) of the rail,

    ξ = v_x/V,  η = v_y/(V cos δ),  φ = ω·n/V.

All three are wheel minus rail. At small angles ξ = 1 - Ωr/V, η = ((v_y - ρ'r)/V - ψ)/cos δ and φ = sin δ/r.

A roller in place of the rail turns at V/R, with its radius R where its z is zero, so that its surface has the speed
(1 - z/R) V. A point at x lies at the angle χ from the top, sin χ = x/(R - z). Tangents and normal turn by χ about the
roller's axis, so that ξ is (v_x/cos χ + v_y tan δ tan χ)/V, of the velocities of the wheel less those of the roller.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from wearlaw import Array
from wearlaw_models.rigs.wheelset.search import Position, Section, gaps

SHORT = 1e-7
"""Way along the profile over which its angle has no mean rate [m]."""


class Place(NamedTuple):
    """Points of contact in outward coordinates, as arrays of one shape.

    Attributes
    ----------
    x, y, z : ndarray
        Place from the middle of the axle, forwards, outwards and down [m].
    angle : ndarray
        Contact angle, δ [rad].
    rail_z : ndarray
        z of the rail's profile in the track [m].
    radius : ndarray
        Rolling radius, r [m].
    rail_arc : ndarray
        Arc length of the rail's profile [m].
    """

    x: Array
    y: Array
    z: Array
    angle: Array
    rail_z: Array
    radius: Array
    rail_arc: Array


def placed(section: Section, position: Position, arc: Array) -> Place:
    """Return the points of contact at arc lengths of the wheel [m], at the mean of the slopes of wheel and rail."""
    at = gaps(section, position, arc)
    rail_arc, _ = section.at("rail_position", at.y, position.side)
    angle = np.arctan(at.rail_slope - 0.5 * at.rise)
    rail_z, _ = section.at("rail_z", at.y, position.side)
    z = in_space(at.x, at.z, section.axes)
    return Place(at.x, at.y - position.displacement, z, angle, rail_z, at.radius, rail_arc)


def in_space(x: Array, z: Array, axes: float) -> Array:
    """Return z of points from the axle, whose circles about a roller's axis have a given z above it [m]."""
    above = 1.0 - axes * z
    return np.asarray(z + axes * x * x / (above + np.sqrt(above * above - (axes * x) ** 2)))


def _pitch(place: Place, roller: float) -> Array:
    """Return the angle of points on a roller from its top, χ [rad]."""
    return np.asarray(np.arcsin(roller * place.x / (1.0 - roller * place.rail_z)))


def curvature_along(
    section: Section, position: Position, radius: Array, arc: Array, overlap: Array | float = 0.0
) -> Array:
    """Return the curvature of wheels along the rolling direction at rolling radii and arc lengths [m], [1/m].

    Yaw turns the wheel's circles out of the rolling direction by θ in the plane of contact, tan θ = tan ψ/cos δ. With
    the angle δ and the curvature κ of the wheel's profile, that of the surface is cos δ/r cos²θ + κ sin²θ (Euler).
    Under yaw, a contact whose undeformed bodies overlap by `overlap` [m] crosses part of the profile; κ is its mean.
    Where a hollow takes more than nine tenths of the first term, which no contact survives, a tenth stays.
    """
    angle, curvature = section.at("wheel", arc, position.side)[2:]
    round_, slope = np.cos(angle) / radius, np.tan(position.yaw) / np.cos(angle)
    # The contact is 1/√2 as long as the overlap. A gap is κ integrated twice, which weighs κ like an even mean over
    # 1/√2 of the contact.
    reach = 0.5 * np.abs(slope) * np.sqrt(2.0 * overlap / round_)
    before, after = (section.at("wheel", arc + way * reach, position.side)[2] for way in (-1.0, 1.0))
    curvature = np.where(reach > SHORT, (before - after) / (2.0 * np.maximum(reach, SHORT)), curvature)
    curved: Array = (round_ + curvature * slope**2) / (1.0 + slope**2)
    return np.maximum(curved, 0.1 * round_)


def roll_rate(place: Place, lateral_velocity: Array, yaw_velocity: Array, roller: float) -> Array:
    """Return the roll velocity at which both wheels stay on their rails [rad/s], positive if it lowers the right one.

    A side whose wheel moves outwards by dy and rolls by dρ opens its gap by tan δ dy - (y + z tan δ) dρ. So does a
    move forwards on a roller, whose curvature at its top is `roller` [1/m].

    Parameters
    ----------
    place : Place
        Points of contact of both sides, of shape (positions, 2).
    lateral_velocity, yaw_velocity : ndarray, (positions,)
        Velocities of the lateral displacement [m/s] and of the yaw [rad/s].
    """
    pitch = _pitch(place, roller)
    fall = np.tan(place.angle) / np.cos(pitch)
    opening = fall * lateral_velocity[:, None] + yaw_velocity[:, None] * (fall * place.x - np.tan(pitch) * place.y)
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
    roller: float,
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
    roller : float
        Curvature of a roller in place of the rail at its top, 1/R [1/m]; 0 for a rail.
    """
    _, roll, yaw, _ = position
    pitch, sin, cos = _pitch(place, roller), np.sin(place.angle), np.cos(place.angle)
    axle = -np.cos(roll) * np.sin(yaw), np.cos(roll) * np.cos(yaw), np.sin(roll)
    ahead = speed * np.cos(pitch) * (1.0 - roller * place.rail_z)

    def of(turn: tuple[Array, ...], along: Array, across: Array) -> tuple[Array, ...]:
        """Return the creepages of a rotation and of velocities forwards and outwards."""
        along = along + turn[1] * place.z - turn[2] * place.y
        across = across + turn[2] * place.x - turn[0] * place.z
        spin = (turn[2] * np.cos(pitch) - turn[0] * np.sin(pitch)) * cos - turn[1] * sin
        along = along / np.cos(pitch) + across * np.tan(pitch) * sin / cos
        return along / speed, side * across / (speed * cos), side * spin / speed

    still = of((roll_rate * np.cos(yaw), roll_rate * np.sin(yaw), turn_rate), ahead, lateral_velocity)
    still = *still[:2], still[2] + side * roller * sin
    turning = of((-axle[0], -axle[1], -axle[2]), 0.0 * speed, 0.0 * speed)
    return Creepages(still, turning)
