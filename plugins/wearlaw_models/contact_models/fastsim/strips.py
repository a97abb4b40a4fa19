"""FASTSIM on an ellipse or on given strips, with few nodes in stick and more in slip.

A strip sticks from its leading edge to a point that a polynomial gives, and slips from there to its trailing edge.
With spin a few strips stick once more, where w·q̂ falls below the slope of the bound, with w = dq/dx in stick. These
strips have as many nodes as the others, divided among their zones.
"""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import NamedTuple, Self

import numpy as np

import wearlaw as wl
from wearlaw import Array
from wearlaw_models.contact_models.fastsim.zones import NODES, Nodes, Strips, stick_and_slip, sums
from wearlaw_models.strips import contact_of, even_strips, forces_of, unflattened

STICK_NODES_PER_STRIP, SLIP_NODES_PER_STRIP = 0.4, 1.0
"""Nodes along a strip over the number of strips: these make errors along and across strips about equal."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Ellipses:
    """Elliptic patches of the simplified theory, as SI arrays of shape (points,).

    Attributes
    ----------
    a, b : ndarray
        Semi-axes in the rolling direction and across it [m].
    longitudinal_creepage, lateral_creepage : ndarray
        ξ and η [-].
    spin : ndarray
        φ [1/m].
    longitudinal_flexibility, lateral_flexibility, spin_flexibility : ndarray
        L1, L2 and L3 [m³/N].
    bound_centre : ndarray
        Bound of the traction at the centre of the patch, μ p2(0) [Pa].
    elliptic : bool
        Whether the bound is a half-ellipsoid; otherwise it is a paraboloid.
    """

    a: Array
    b: Array
    longitudinal_creepage: Array
    lateral_creepage: Array
    spin: Array
    longitudinal_flexibility: Array
    lateral_flexibility: Array
    spin_flexibility: Array
    bound_centre: Array
    elliptic: bool

    @classmethod
    def of(cls, problem: wl.Problem, elliptic: bool, interpolation: wl.kalker.Interpolation = "scaled") -> Self:
        """Return the patches of a problem with one batch axis, with Kalker's three flexibilities.

        L1 = 8a/(3 C11 G), L2 = 8a/(3 C22 G), L3 = π a √(a/b)/(4 C23 G) (Kalker 1982).
        """
        a, modulus = problem.a, problem.shear_modulus
        ratio = a / problem.b
        c = wl.kalker.coefficients(ratio, problem.poisson_ratio, interpolation)
        return cls(
            a=a,
            b=problem.b,
            longitudinal_creepage=problem.longitudinal_creepage,
            lateral_creepage=problem.lateral_creepage,
            spin=problem.spin,
            longitudinal_flexibility=8.0 / 3.0 * a / (c.c11 * modulus),
            lateral_flexibility=8.0 / 3.0 * a / (c.c22 * modulus),
            spin_flexibility=0.25 * np.pi * a * np.sqrt(ratio) / (c.c23 * modulus),
            bound_centre=(1.5 if elliptic else 2.0)
            * problem.friction_coefficient
            * problem.normal_force
            / problem.patch_area,
            elliptic=elliptic,
        )

    @property
    def arrays(self) -> tuple[Array, ...]:
        """The arrays, in the order above."""
        return tuple(getattr(self, field.name) for field in dataclasses.fields(self)[:-1])


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


def solve(problem: wl.Problem, ellipses: Ellipses, layout: Layout, count: int) -> wl.Contact:
    """Return the contact on strips, with as many nodes on each as among `count` strips."""
    nodes = strips(ellipses, layout, *nodes_along(count))
    _clear(ellipses, nodes.traction_x, nodes.traction_y, nodes.slip_x, nodes.slip_y)
    totals = forces(layout, nodes)
    np.add(nodes.x, layout.x, out=nodes.x)
    return contact_of(problem, layout, totals, nodes[:-1])


def creep_forces(problem: wl.Problem, ellipses: Ellipses, count: int) -> wl.CreepForces:
    """Return the forces of `solve`."""
    flat_forces = forces_alone(ellipses, layout_of(problem, ellipses, count), *nodes_along(count))
    _clear(ellipses, flat_forces.longitudinal, flat_forces.lateral, flat_forces.spin_moment)
    return unflattened(problem, flat_forces)


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
    return forces_of(layout, along, across, layout.half_length * turning)


def forces(layout: Layout, nodes: Nodes) -> wl.CreepForces:
    """Return the forces and the moment that strips transmit."""
    length, x, q_x, q_y = nodes.length, nodes.x, nodes.traction_x, nodes.traction_y
    along, across = np.einsum("kjp,kjp->jp", length, q_x), np.einsum("kjp,kjp->jp", length, q_y)
    return forces_of(layout, along, across, np.einsum("kjp,kjp,kjp->jp", length, x, q_y))


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
