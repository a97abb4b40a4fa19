"""Patches for the tests of FASTSIM on strips, and their solution."""

from __future__ import annotations

import importlib.util
from typing import NamedTuple

import numpy as np
import pytest
from numpy.typing import ArrayLike

import wearlaw as wl
from tests.strategies import EPS
from wearlaw import Array
from wearlaw_models.contact_models.fastsim.strips import (  # private: any flexibilities and number of nodes
    Ellipses,
    forces,
    layout_on,
    strips,
)
from wearlaw_models.contact_models.fastsim.zones import Nodes  # private: as above
from wearlaw_models.strips import even_strips  # private: with any number of nodes

COMPILED = [False, True] if importlib.util.find_spec("numba") else [False]

each_bound = pytest.mark.parametrize("elliptic", [False, True], ids=["parabolic", "elliptic"])

ROUNDING = 100 * EPS

CASE = {"a": 6e-3, "b": 4e-3, "l1": 4.6e-14, "l2": 5.3e-14, "l3": 3.9e-14, "centre": 5e8}
"""A steel wheel on a rail [m], [m³/N], [Pa]."""


def ellipses(
    xi: ArrayLike = 0.0, eta: ArrayLike = 0.0, phi: ArrayLike = 0.0, *, elliptic: bool, **changes: float
) -> Ellipses:
    """Return contacts with these creepages and spins [1/m]."""
    case = {**CASE, **changes}
    creepage_x, creepage_y, spin = np.broadcast_arrays(np.atleast_1d(np.asarray(xi, float)), eta, phi)
    a, b, l1, l2, l3, centre = (np.full(creepage_x.shape, case[name]) for name in CASE)
    return Ellipses(
        a=a,
        b=b,
        longitudinal_creepage=creepage_x * 1.0,
        lateral_creepage=creepage_y * 1.0,
        spin=spin * 1.0,
        longitudinal_flexibility=l1,
        lateral_flexibility=l2,
        spin_flexibility=l3,
        bound_centre=centre,
        elliptic=elliptic,
    )


def sample(elliptic: bool, *, spin: bool = True, count: int = 60) -> Ellipses:
    """Return contacts from little creepage to full slip."""
    random = np.random.default_rng(3)
    xi, eta = (random.choice([-1.0, 1.0], count) * 10.0 ** random.uniform(-4.0, -1.5, count) for _ in range(2))
    return ellipses(xi, eta, random.uniform(-1.0, 1.0, count) * spin, elliptic=elliptic)


class Solved(NamedTuple):
    fields: Nodes
    forces: wl.CreepForces
    power: Array
    """∑ q·s dA [N]."""


def by_points(nodes: Nodes) -> Nodes:
    """Return nodes, (nodes, strips, points), as (points, nodes, strips)."""
    return Nodes(*(array.transpose(2, 0, 1) for array in nodes))


def solve(patches: Ellipses, count: int = 12, stick: int = 3, slip: int = 12) -> Solved:
    shares, widths = even_strips(count)
    layout = layout_on(patches, shares, widths)
    found = strips(patches, layout, stick, slip)
    fields = by_points(found)
    energy = (fields.traction_x * fields.slip_x + fields.traction_y * fields.slip_y) * fields.length
    power = (energy.sum(axis=1) * widths).sum(axis=-1) * patches.b
    return Solved(fields, forces(layout, found), power)


def strips_at(patches: Ellipses, shares: Array, stick: int, slip: int) -> Nodes:
    """Return the fields of strips at y = b shares, whatever widths they stand for."""
    return by_points(strips(patches, layout_on(patches, shares, np.zeros_like(shares)), stick, slip))


def limit(patches: Ellipses) -> Array:
    """Return μN [N]."""
    share = 1.5 if patches.elliptic else 2.0
    bound: Array = patches.bound_centre * np.pi * patches.a * patches.b / share
    return bound


def plain_march(patches: Ellipses, shares: Array, cells: int) -> tuple[Array, Array, Array, Array]:
    """Return angle from the trailing edge, traction and where it slips at the ends of cells even in the angle.

    The published march: grow as in stick, then return radially to the bound. Its error is of first order.
    """
    a, b, xi, eta, phi, l1, l2, l3, centre = (array[:, None] for array in patches.arrays)
    root = np.sqrt(1.0 - shares**2)
    angle = np.pi * (1.0 - np.arange(cells + 1) / cells)
    x = a * root * np.cos(angle)[:, None, None]
    q_x, q_y = np.zeros((2, cells + 1, *x.shape[1:]))
    slips = np.zeros(x.shape, bool)
    for k in range(cells):
        step = x[k + 1] - x[k]
        trial_x = q_x[k] + (xi / l1 - phi * b * shares / l3) * step
        trial_y = q_y[k] + (eta / l2 - phi * 0.5 * (x[k + 1] + x[k]) / l3) * step
        level = root * np.sin(angle[k + 1])
        bound = centre * (level if patches.elliptic else level**2)
        size = np.hypot(trial_x, trial_y)
        slips[k + 1] = size > bound
        scale = np.where(slips[k + 1], bound / size, 1.0)
        q_x[k + 1], q_y[k + 1] = scale * trial_x, scale * trial_y
    return angle, q_x, q_y, slips
