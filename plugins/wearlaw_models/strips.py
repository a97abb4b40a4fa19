"""What theories of strips along the rolling direction share: how the strips lie, how a traction turns, and the sums.

Functions of numbers take arrays too, and are compiled with the loops that call them.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, TypeVar

import numpy as np

import wearlaw as wl
from wearlaw import Array

BELOW = 1.0 - 8.0 * float(np.finfo(np.float64).eps)
"""Factor that keeps the magnitude of a traction below its bound despite rounding."""

TINY = 1e-300
"""Keeps divisors from zero."""

Number = TypeVar("Number", float, Array)


def root(value: Number) -> Number:
    """Return the square root of a float or of an array."""
    return np.sqrt(value)  # type: ignore[no-any-return]


def turn(along: Number, across: Number, decay: Number) -> tuple[Number, Number, Number]:
    """Return the factors of a step on a vector at half the angle of the traction: of x along x, y across, the other.

    As complex numbers, a step towards w takes the vector h to (1 + d)/2 h + (1 - d)/2 (w/|w|) h*; the tangent of half
    the angle between the traction and w decays by the factor d.
    """
    over = (0.5 - 0.5 * decay) / root(along * along + across * across + TINY)
    stays, turns = 0.5 + 0.5 * decay, over * along
    return stays + turns, stays - turns, over * across


def direction(half_x: Number, half_y: Number) -> tuple[Number, Number]:
    """Return the direction with a vector at half its angle, shortened for rounding."""
    over = BELOW / (half_x * half_x + half_y * half_y + TINY)
    return (half_x - half_y) * (half_x + half_y) * over, 2.0 * half_x * half_y * over


def half_angle(x: Array, y: Array) -> Array:
    """Return a vector at half the angle of a traction, or along x if there is no traction."""
    long = np.sqrt(x * x + y * y) + np.abs(x)
    short = y / (long + TINY)
    ahead = x >= 0.0
    return np.stack([np.where(ahead, 1.0, short), np.where(ahead, short, 1.0)])


def even_strips(count: int) -> tuple[Array, Array]:
    """Return y/b of strips even in the angle of y = b cos β, and the widths over b that they represent.

    This is Gauss's quadrature with Chebyshev polynomials of the second kind: exact for the area, and of high order for
    forces, since they are smooth and periodic in the angle. Source: M. Abramowitz and I. A. Stegun, Handbook of
    Mathematical Functions (1964), 25.4.40.
    """
    angle = np.pi / (count + 1) * np.arange(count, 0, -1)
    return np.cos(angle), np.pi / (count + 1) * np.sin(angle)


def widths_at(shares: Array) -> Array:
    """Return the widths over b of strips at y = `shares` × b, each of which represents what is nearest to it."""
    between = 0.5 * (shares[1:] + shares[:-1])
    return np.diff(np.concatenate([[-1.0], between, [1.0]]))


def forces_of(layout: Any, along: Array, across: Array, turning: Array, power: Array | None = None) -> wl.CreepForces:
    """Return the forces and the moment from ∫ q_x, ∫ q_y and ∫ x q_y dx along strips, (strips, points).

    `power` is what each metre of their width dissipates, if they have creepages of their own.
    """
    parts = along, across, turning + layout.y * along + layout.x * across
    longitudinal, lateral, moment = ((layout.width * part).sum(axis=0) for part in parts)
    total = None if power is None else (layout.width * power).sum(axis=0)
    return wl.CreepForces(longitudinal=longitudinal, lateral=lateral, spin_moment=-moment, power=total)


def unflattened(problem: wl.Problem, forces: wl.CreepForces) -> wl.CreepForces:
    """Return forces of all points as those of the batch."""
    totals = {name: getattr(forces, name) for name in wl.CreepForces.__slots__}
    return wl.CreepForces(**{name: problem.unflatten(total) for name, total in totals.items() if total is not None})


def contact_of(problem: wl.Problem, layout: Any, forces: wl.CreepForces, fields: Iterable[Array]) -> wl.Contact:
    """Return the contact with fields at the nodes of strips, (nodes, strips, points).

    They are x, the length that a node represents, the bound, and traction and slip along x and y.
    """
    x, length, bound, q_x, q_y, s_x, s_y = (field.transpose(2, 0, 1) for field in fields)
    contact = wl.Contact.from_strips(
        problem.flatten(),
        forces,
        x=x,
        y=layout.y.T,  # in the memory order of the nodes, strip by strip
        length=length,
        strip_width=layout.width.T,
        traction=(q_x, q_y),
        slip=(s_x, s_y),
        traction_bound=bound,
    )
    return contact.unflattened(problem)
