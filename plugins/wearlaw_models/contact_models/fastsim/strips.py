"""FASTSIM on an ellipse or on given strips, with few nodes in stick and more in slip.

A strip sticks from its leading edge to a point that a polynomial gives, and slips from there to its trailing edge.
With spin a few strips stick once more, where w·q̂ falls below the slope of the bound, with w = dq/dx in stick. These
strips have as many nodes as the others, divided among their zones.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

import wearlaw as wl
from wearlaw import Array
from wearlaw_models.contact_models.fastsim.march import Ellipses
from wearlaw_models.contact_models.fastsim.zones import NODES, Nodes, Strips, stick_and_slip, sums

STICK_NODES_PER_STRIP, SLIP_NODES_PER_STRIP = 0.4, 1.0
"""Nodes along a strip over the number of strips: these make errors along and across strips about equal."""


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
    x : ndarray or float
        Position of the middle along the rolling direction [m].
    """

    y: Array
    width: Array
    half_length: Array
    greatest: Array
    x: Array | float = 0.0


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
    layout = problem.strips
    assert layout is not None
    arrays = layout.y, layout.width, layout.half_length, layout.max_pressure, layout.x
    y, width, half_length, p0, x = (np.moveaxis(array, -1, 0) for array in arrays)
    shape = p0
    if not elliptic:  # ∫ p² dx = 4/3 a p0²
        shape = p0**2 * (problem.normal_force / (4.0 / 3.0 * half_length * width * p0**2).sum(axis=0))
    return Layout(y, width, half_length, problem.friction_coefficient * shape, x)


def nodes_along(count: int) -> tuple[int, int]:
    """Return the numbers of nodes along one of `count` strips before it first slips, and from there on."""
    return max(round(STICK_NODES_PER_STRIP * count), 4), max(round(SLIP_NODES_PER_STRIP * count), 8)


def layout_of(problem: wl.Problem, ellipses: Ellipses, count: int) -> Layout:
    """Return the strips of the problem, or `count` even ones of ellipses."""
    if problem.geometry == "strips":
        return given_layout(problem.flatten(), ellipses.elliptic)
    return layout_on(ellipses, *even_strips(count))


def layout_at(ellipses: Ellipses, shares: Array) -> Layout:
    """Return strips of ellipses at y = `shares` × b, each of which represents what is nearest to it."""
    between = 0.5 * (shares[1:] + shares[:-1])
    return layout_on(ellipses, shares, np.diff(np.concatenate([[-1.0], between, [1.0]])))


def solve(problem: wl.Problem, ellipses: Ellipses, layout: Layout, count: int) -> wl.Contact:
    """Return the contact on strips, with as many nodes on each as among `count` strips."""
    nodes = strips(ellipses, layout, *nodes_along(count))
    _clear(ellipses, nodes.traction_x, nodes.traction_y, nodes.slip_x, nodes.slip_y)
    totals = forces(layout, nodes)
    np.add(nodes.x, layout.x, out=nodes.x)
    x, length, bound, q_x, q_y, s_x, s_y = (array.transpose(2, 0, 1) for array in nodes[:-1])
    contact = wl.Contact.from_strips(
        problem.flatten(),
        totals,
        x=x,
        y=layout.y.T,  # in the memory order of the nodes, strip by strip
        length=length,
        strip_width=layout.width.T,
        traction=(q_x, q_y),
        slip=(s_x, s_y),
        traction_bound=bound,
    )
    return contact.unflattened(problem)


def creep_forces(problem: wl.Problem, ellipses: Ellipses, count: int) -> wl.CreepForces:
    """Return the forces of `solve`."""
    flat_forces = forces_alone(ellipses, layout_of(problem, ellipses, count), *nodes_along(count))
    totals = {name: getattr(flat_forces, name) for name in ("longitudinal", "lateral", "spin_moment")}
    _clear(ellipses, *totals.values())
    return wl.CreepForces(**{name: problem.unflatten(total) for name, total in totals.items()})


def _clear(ellipses: Ellipses, *fields: Array) -> None:
    """Set fields of patches that roll freely to zero, in place; nodes of no length at their trailing edge slip."""
    creepages = ellipses.longitudinal_creepage, ellipses.lateral_creepage, ellipses.spin
    rolls_freely = (creepages[0] == 0.0) & (creepages[1] == 0.0) & (creepages[2] == 0.0)
    if rolls_freely.any():
        for field in fields:
            field[..., rolls_freely] = 0.0


def strips(ellipses: Ellipses, layout: Layout, stick_nodes: int, slip_nodes: int) -> Nodes:
    """Return the nodes of strips, (nodes, strips, points).

    Each strip has `stick_nodes` nodes before it first slips and `slip_nodes` from there on.
    """
    return stick_and_slip(_strips(ellipses, layout, stick_nodes + slip_nodes), stick_nodes, slip_nodes)


def forces_alone(ellipses: Ellipses, layout: Layout, stick_nodes: int, slip_nodes: int) -> wl.CreepForces:
    """Return the forces and the moment on the nodes of `strips`; compiled loops leave out the fields."""
    scaled = _strips(ellipses, layout, stick_nodes + slip_nodes)
    if not scaled.compiled:
        return forces(layout, stick_and_slip(scaled, stick_nodes, slip_nodes))
    along, across, turning = sums(scaled, slip_nodes) * (layout.half_length * layout.greatest)
    return _of_strips(layout, along, across, layout.half_length * turning)


def forces(layout: Layout, nodes: Nodes) -> wl.CreepForces:
    """Return the forces and the moment that strips transmit."""
    length, x, q_x, q_y = nodes.length, nodes.x, nodes.traction_x, nodes.traction_y
    along, across = np.einsum("kjp,kjp->jp", length, q_x), np.einsum("kjp,kjp->jp", length, q_y)
    return _of_strips(layout, along, across, np.einsum("kjp,kjp,kjp->jp", length, x, q_y))


def _of_strips(layout: Layout, along: Array, across: Array, turning: Array) -> wl.CreepForces:
    """Return the forces and the moment from ∫ q_x, ∫ q_y and ∫ x q_y dx along strips."""
    parts = along, across, turning + layout.y * along + layout.x * across
    longitudinal, lateral, moment = ((layout.width * part).sum(axis=0) for part in parts)
    return wl.CreepForces(longitudinal=longitudinal, lateral=lateral, spin_moment=-moment)


def _strips(ellipses: Ellipses, layout: Layout, nodes: int) -> Strips:
    rows = _rows(ellipses, layout)
    return Strips(rows, ellipses.elliptic, wl.accelerated(rows[0].size * nodes // NODES))


def _rows(ellipses: Ellipses, layout: Layout) -> Array:
    """Return strips as rows of an array, (7, strips, points), as in `_loops`."""
    _, _, creepage_x, creepage_y, spin, l1, l2, l3, _ = ellipses.arrays
    y, _, half_length, greatest, x = layout
    unit = np.divide(half_length, greatest, out=np.zeros_like(greatest), where=greatest > 0.0)
    growth = (
        (creepage_x / l1 - spin * y / l3) * unit,
        (creepage_y / l2 - spin * x / l3) * unit,
        0.5 * spin / l3 * half_length * unit,
    )
    over = np.where(unit > 0.0, unit, np.inf)  # strips without pressure do not slip
    return np.stack([*growth, half_length, greatest, l1 / over, l2 / over])
