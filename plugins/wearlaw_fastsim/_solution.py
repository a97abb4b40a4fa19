"""FASTSIM on an ellipse: from the contact problem to the strips, and from their fields to a `Contact`."""

from __future__ import annotations

import numpy as np

import wearlaw as wl
from wearlaw import Array
from wearlaw_fastsim import _march, _strips
from wearlaw_fastsim._march import Cells, Ellipses, drop_gains, march, strip_centres

STICK_NODES_PER_STRIP, SLIP_NODES_PER_STRIP = 0.4, 1.0
"""Nodes along a strip over the number of strips: these make errors along and across strips about equal."""

CELLS = 16
"""Cells that take about as long as one operating point in the count of `accelerated`."""


def ellipses(problem: wl.Problem, elliptic: bool, interpolation: wl.kalker.Interpolation = "scaled") -> Ellipses:
    """Return the patches of a problem with one batch axis, with Kalker's three flexibilities.

    L1 = 8a/(3 C11 G), L2 = 8a/(3 C22 G), L3 = π a √(a/b)/(4 C23 G) (Kalker 1982).
    """
    a, modulus = problem.a, problem.shear_modulus
    ratio = a / problem.b
    c = wl.kalker.coefficients(ratio, problem.poisson_ratio, interpolation)
    share = 1.5 if elliptic else 2.0
    return Ellipses(
        a=a,
        b=problem.b,
        longitudinal_creepage=problem.longitudinal_creepage,
        lateral_creepage=problem.lateral_creepage,
        spin=problem.spin,
        longitudinal_flexibility=8.0 / 3.0 * a / (c.c11 * modulus),
        lateral_flexibility=8.0 / 3.0 * a / (c.c22 * modulus),
        spin_flexibility=0.25 * np.pi * a * np.sqrt(ratio) / (c.c23 * modulus),
        bound_centre=share * problem.friction_coefficient * problem.normal_force / problem.patch_area,
        elliptic=elliptic,
    )


def adaptive(problem: wl.Problem, patches: Ellipses, count: int) -> wl.Contact:
    """Return the contact on `count` strips with adaptive nodes."""
    return _on_strips(problem, patches, count, _strips.layout_on(patches, *_strips.even_strips(count)))


def on_strips(problem: wl.Problem, patches: Ellipses, count: int, shares: Array) -> wl.Contact:
    """Return the contact on strips at y = `shares` × b, with as many nodes on each as among `count` strips."""
    between = 0.5 * (shares[1:] + shares[:-1])
    widths = np.diff(np.concatenate([[-1.0], between, [1.0]]))
    return _on_strips(problem, patches, count, _strips.layout_on(patches, shares, widths))


def on_given_strips(problem: wl.Problem, patches: Ellipses, count: int) -> wl.Contact:
    """Return the contact on the strips of the problem, with as many nodes on each as among `count` strips."""
    return _on_strips(problem, patches, count, _strips.given_layout(problem.flatten(), patches.elliptic))


def forces(problem: wl.Problem, patches: Ellipses, count: int) -> wl.CreepForces:
    """Return the forces on strips with adaptive nodes, those of `adaptive` or of `on_given_strips`."""
    if problem.geometry == "strips":
        layout = _strips.given_layout(problem.flatten(), patches.elliptic)
    else:
        layout = _strips.layout_on(patches, *_strips.even_strips(count))
    found = _strips.forces_alone(patches, layout, *_nodes(count))
    totals = {name: getattr(found, name) for name in ("longitudinal", "lateral", "spin_moment")}
    _clear(patches, *totals.values())
    return wl.CreepForces(**{name: problem.unflatten(total) for name, total in totals.items()})


def _nodes(count: int) -> tuple[int, int]:
    """Return the numbers of nodes along a strip before it first slips, and from there on."""
    return max(round(STICK_NODES_PER_STRIP * count), 4), max(round(SLIP_NODES_PER_STRIP * count), 8)


def _fields(patches: Ellipses, count: int, layout: _strips.Layout) -> _strips.StripFields:
    found = _strips.strips(patches, layout, *_nodes(count))
    _clear(patches, found.traction_x, found.traction_y, found.slip_x, found.slip_y)
    return found


def _clear(patches: Ellipses, *fields: Array) -> None:
    """Set fields of patches that roll freely to zero, in place; nodes of no length at their trailing edge slip."""
    creepages = patches.longitudinal_creepage, patches.lateral_creepage, patches.spin
    rolls_freely = (creepages[0] == 0.0) & (creepages[1] == 0.0) & (creepages[2] == 0.0)
    if rolls_freely.any():
        for field in fields:
            field[rolls_freely] = 0.0


def _on_strips(problem: wl.Problem, patches: Ellipses, count: int, layout: _strips.Layout) -> wl.Contact:
    flat, found = problem.flatten(), _fields(patches, count, layout)
    contact = wl.Contact.from_strips(
        flat,
        _strips.forces(layout, found),
        x=found.x,
        y=layout.y.T,  # in the memory order of the nodes, strip by strip
        length=found.length,
        strip_width=layout.width.T,
        traction=(found.traction_x, found.traction_y),
        slip=(found.slip_x, found.slip_y),
        traction_bound=found.bound,
    )
    return contact.unflattened(problem)


def uniform(problem: wl.Problem, patches: Ellipses, count: int) -> wl.Contact:
    """Return the contact on `count` × `count` cells, by Kalker's march."""
    flat = problem.flatten()
    compiled = wl.accelerated(flat.size * count**2 // CELLS)
    cells = Cells.empty(flat.size, count, count, compiled=compiled)
    march(patches, cells, compiled=compiled)
    drop_gains(cells)
    contact = wl.Contact.from_strips(
        flat,
        _march.forces(patches, cells),
        x=cells.x,
        y=flat.b[:, None] * strip_centres(count),
        length=np.broadcast_to(patches.cell_lengths(count, count)[:, None, :], cells.x.shape),
        strip_width=np.broadcast_to(2.0 / count * flat.b[:, None], (flat.size, count)),
        traction=(cells.traction_x, cells.traction_y),
        slip=(cells.slip_x, cells.slip_y),
        traction_bound=cells.bound,
    )
    return contact.unflattened(problem)
