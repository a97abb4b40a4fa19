"""FASTSIM on an ellipse, strip by strip, with few nodes in stick and more in slip.

A strip sticks from its leading edge to a point that a polynomial gives, and slips from there to its trailing edge.
With spin a few strips stick once more, where w·q̂ falls below the slope of the bound, with w = dq/dx in stick. These
strips have as many nodes as the others, divided among their zones.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

import wearlaw as wl
from wearlaw import Array
from wearlaw_fastsim._march import Ellipses
from wearlaw_fastsim._zones import NODES, Strips, stick_and_slip, sums


class StripFields(NamedTuple):
    """Solution along strips, as SI arrays of shape (points, nodes of a strip, strips).

    Attributes
    ----------
    x : ndarray
        Position from the leading edge, x < 0, to the trailing edge [m].
    length : ndarray
        Length along x that a node represents, its weight in integrals [m].
    traction_x, traction_y : ndarray
        Traction [Pa].
    slip_x, slip_y : ndarray
        Relative slip [-], zero in stick.
    bound : ndarray
        Bound of the traction [Pa].
    """

    x: Array
    length: Array
    bound: Array
    traction_x: Array
    traction_y: Array
    slip_x: Array
    slip_y: Array


def even_strips(count: int) -> tuple[Array, Array]:
    """Return y/b of strips even in the angle of y = b cos β, and the widths over b that they represent.

    This is Gauss's quadrature with Chebyshev polynomials of the second kind: exact for the area, and of high order for
    forces, since they are smooth and periodic in the angle. Source: M. Abramowitz and I. A. Stegun, Handbook of
    Mathematical Functions (1964), 25.4.40.
    """
    angle = np.pi / (count + 1) * np.arange(count, 0, -1)
    return np.cos(angle), np.pi / (count + 1) * np.sin(angle)


class Layout(NamedTuple):
    """Strips of patches, as SI arrays of shape (strips, points).

    Attributes
    ----------
    y, width : ndarray
        Position and width [m].
    half_length : ndarray
        Half the length [m].
    greatest : ndarray
        Bound of the traction in the middle [Pa].
    """

    y: Array
    width: Array
    half_length: Array
    greatest: Array


def layout_on(ellipses: Ellipses, y_share: Array, width_share: Array) -> Layout:
    """Return strips of ellipses at y = b y_share, |y_share| < 1, that represent widths of b width_share."""
    root = np.sqrt((1.0 - y_share) * (1.0 + y_share))
    greatest = np.multiply.outer(root if ellipses.elliptic else root * root, ellipses.bound_centre)
    y, width, half_length = (
        np.multiply.outer(share, size)
        for share, size in ((y_share, ellipses.b), (width_share, ellipses.b), (root, ellipses.a))
    )
    return Layout(y, width, half_length, greatest)


def given_layout(problem: wl.Problem, elliptic: bool) -> Layout:
    """Return the strips of a problem with a given pressure and one batch axis.

    The elliptic bound is μp. The parabolic bound is proportional to p² and carries the same load; on an ellipse under
    Hertz's pressure it is the paraboloid.
    """
    given = problem.strips
    assert given is not None
    y, width, half_length, p0 = (
        np.moveaxis(array, -1, 0) for array in (given.y, given.width, given.half_length, given.max_pressure)
    )
    shape = p0
    if not elliptic:  # ∫ p² dx = 4/3 a p0²
        shape = p0**2 * (problem.normal_force / (4.0 / 3.0 * half_length * width * p0**2).sum(axis=0))
    return Layout(y, width, half_length, problem.friction_coefficient * shape)


def strips(ellipses: Ellipses, layout: Layout, stick_nodes: int, slip_nodes: int) -> StripFields:
    """Return the fields of strips.

    Each strip has `stick_nodes` nodes before it first slips and `slip_nodes` from there on. The last axis is the
    axis of the strips, but in memory the axis of the nodes comes first.
    """
    zone = stick_and_slip(_strips(ellipses, layout, stick_nodes + slip_nodes), stick_nodes, slip_nodes)
    return StripFields(*(getattr(zone, name).transpose(2, 0, 1) for name in StripFields._fields))


def forces_alone(ellipses: Ellipses, layout: Layout, stick_nodes: int, slip_nodes: int) -> wl.CreepForces:
    """Return the forces and the moment on the nodes of `strips`; compiled loops leave out the fields."""
    found = _strips(ellipses, layout, stick_nodes + slip_nodes)
    if not found.compiled:
        return forces(layout, strips(ellipses, layout, stick_nodes, slip_nodes))
    along, across, turning = sums(found, slip_nodes) * (layout.half_length * layout.greatest)
    return _of_strips(layout, along, across, layout.half_length * turning)


def forces(layout: Layout, fields: StripFields) -> wl.CreepForces:
    """Return the forces and the moment that strips transmit."""
    arrays = fields.length, fields.x, fields.traction_x, fields.traction_y
    length, x, q_x, q_y = (array.transpose(1, 2, 0) for array in arrays)  # in memory order
    along, across = np.einsum("kjp,kjp->jp", length, q_x), np.einsum("kjp,kjp->jp", length, q_y)
    return _of_strips(layout, along, across, np.einsum("kjp,kjp,kjp->jp", length, x, q_y))


def _of_strips(layout: Layout, along: Array, across: Array, turning: Array) -> wl.CreepForces:
    """Return the forces and the moment from ∫ q_x, ∫ q_y and ∫ x q_y dx along strips."""
    parts = along, across, turning + layout.y * along
    longitudinal, lateral, moment = ((layout.width * part).sum(axis=0) for part in parts)
    return wl.CreepForces(longitudinal=longitudinal, lateral=lateral, spin_moment=-moment)


def _strips(ellipses: Ellipses, layout: Layout, nodes: int) -> Strips:
    rows = _rows(ellipses, layout)
    return Strips(rows, ellipses.elliptic, wl.accelerated(rows[0].size * nodes // NODES))


def _rows(ellipses: Ellipses, layout: Layout) -> Array:
    """Return strips as rows of an array, (7, strips, points), as in `_zone_loops`."""
    _, _, creepage_x, creepage_y, spin, l1, l2, l3, _ = ellipses.arrays
    y, _, half_length, greatest = layout
    unit = half_length / greatest
    growth = (
        (creepage_x / l1 - spin * y / l3) * unit,
        creepage_y / l2 * unit,
        0.5 * spin / l3 * half_length * unit,
    )
    return np.stack([*growth, half_length, greatest, l1 / unit, l2 / unit])
