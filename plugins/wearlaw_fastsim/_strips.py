"""FASTSIM on an ellipse, strip by strip, with the nodes where they are needed: few where it sticks.

A strip sticks from its leading edge to a point that a polynomial gives, and slips from there to its trailing edge.
With spin a few strips stick once more, where w·q̂ falls below the slope of the bound, w = dq/dx in stick; theirs are
the same nodes, shared out to their zones.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

import wearlaw as wl
from wearlaw import Array
from wearlaw_fastsim._first_slip import Growth
from wearlaw_fastsim._march import Ellipses
from wearlaw_fastsim._zones import stick_and_slip


@dataclass(frozen=True, slots=True, kw_only=True)
class StripFields:
    """Solution along strips, as SI arrays of shape (points, nodes of a strip, strips).

    Attributes
    ----------
    x : ndarray
        From the leading edge, x < 0, to the trailing edge [m].
    length : ndarray
        Length along x that a node stands for, its weight in integrals [m].
    traction_x, traction_y : ndarray
        Traction [Pa].
    slip_x, slip_y : ndarray
        Relative slip [-], zero in stick.
    bound : ndarray
        Bound of the traction [Pa].
    """

    x: Array
    length: Array
    traction_x: Array
    traction_y: Array
    slip_x: Array
    slip_y: Array
    bound: Array


def even_strips(count: int) -> tuple[Array, Array]:
    """Return y/b of strips even in the angle of y = b cos β, and the widths over b that they stand for.

    It is Gauss's quadrature with Chebyshev polynomials of the second kind: exact for the area, and of a high order for
    forces, since they are smooth and periodic in the angle. Source: M. Abramowitz and I. A. Stegun, Handbook of
    Mathematical Functions (1964), 25.4.40.
    """
    angle = np.pi / (count + 1) * np.arange(count, 0, -1)
    return np.cos(angle), np.pi / (count + 1) * np.sin(angle)


def strips(ellipses: Ellipses, y_share: Array, stick_nodes: int, slip_nodes: int) -> StripFields:
    """Return the fields of strips at y = b y_share, |y_share| < 1, of shape (strips,).

    Each has `stick_nodes` before it first slips, and `slip_nodes` from there on.
    The last axis counts the strips, but the first in memory is that of the nodes.
    """
    half_length, greatest, growth = _growth(ellipses, y_share)
    zones = zip(*stick_and_slip(growth, ellipses.elliptic, stick_nodes, slip_nodes), strict=True)
    x, length, bound, traction_x, traction_y, excess = (np.concatenate(parts) for parts in zones)
    slip = greatest / half_length * np.maximum(excess, 0.0) / bound  # to L q, whose direction it has
    fields = {
        "x": half_length * x,
        "length": half_length * length,
        "traction_x": greatest * traction_x,
        "traction_y": greatest * traction_y,
        "slip_x": ellipses.longitudinal_flexibility[:, None] * slip * traction_x,
        "slip_y": ellipses.lateral_flexibility[:, None] * slip * traction_y,
        "bound": greatest * bound,
    }
    return StripFields(**{name: field.swapaxes(0, 1) for name, field in fields.items()})


def forces(ellipses: Ellipses, y_share: Array, width_share: Array, fields: StripFields) -> wl.CreepForces:
    """Return the forces and the moment of strips at y = b y_share that stand for widths of b width_share."""
    b = ellipses.b[:, None]
    along = np.einsum("pkj,pkj->pj", fields.length, fields.traction_x)
    across = np.einsum("pkj,pkj->pj", fields.length, fields.traction_y)
    turning = np.einsum("pkj,pkj,pkj->pj", fields.length, fields.x, fields.traction_y) + b * y_share * along
    longitudinal, lateral, moment = ((b * width_share * part).sum(axis=-1) for part in (along, across, turning))
    return wl.CreepForces(longitudinal=longitudinal, lateral=lateral, spin_moment=-moment)


def _growth(ellipses: Ellipses, y_share: Array) -> tuple[Array, Array, Growth]:
    """Return half length, greatest bound and growth of strips."""
    a, b, creepage_x, creepage_y, spin, l1, l2, l3, centre = (array[:, None] for array in ellipses.arrays)
    root = np.sqrt((1.0 - y_share) * (1.0 + y_share))
    half_length, greatest = a * root, centre * (root if ellipses.elliptic else root * root)
    unit = half_length / greatest
    along = (creepage_x / l1 - spin * b * y_share / l3) * unit
    return half_length, greatest, Growth(along, creepage_y / l2 * unit, 0.5 * spin / l3 * half_length * unit)
