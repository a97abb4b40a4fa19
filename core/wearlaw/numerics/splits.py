"""Rates of a law on the strips of a patch, with cells split where the rate jumps."""

from __future__ import annotations

from typing import Any

import numpy as np

from wearlaw.arrays import Array
from wearlaw.contact.contact import TOTALS, Contact
from wearlaw.contact.problem import Problem
from wearlaw.models.law import NODE_VARIABLES, Law, Numbers
from wearlaw.models.model import Blame
from wearlaw.numerics.solving import VECTORS, Solver

FIELDS = ("pressure", "traction", "slip", "traction_bound", "x", *VECTORS)
"""The fields of a contact that are interpolated between nodes."""

ROUNDING = 1e-9
"""Relative rounding error of distances of nodes that come from a file or a sum of lengths."""


def split_rates(solver: Solver, law: Law, contact: Contact, problem: Problem, p: Numbers) -> Array:
    """Return the rates of a law at the nodes of strips; where the rate jumps in a node's cell, the mean over the cell.

    A cell is the part of a strip that its node represents. Between two nodes, the contact is interpolated linearly,
    but not from slip to stick if the rate is zero in stick. Where a variable crosses a jump there, the part of a cell
    beyond the jump has the rate beyond it. The error along the strip is then of second order in the size of the cells,
    and otherwise of first order.

    The batch of the contact has one axis, so that the rates are (points, nodes, strips), in SI. The law's numbers `p`
    are floats, or arrays of shape (points, 1, 1).
    """
    rate = solver.rate(law, contact, problem, p)
    with Blame(law, p):
        jumps = law.jumps(p)
    names = {*NODE_VARIABLES, *law.variables}
    levels = [(name, value) for name, values in jumps.items() if name in names for value in values]
    if not levels or contact.x.shape[-2] == 1:
        return rate
    step = np.diff(contact.x, axis=-2)
    inside = step > 0.0
    if law.zero_in_stick:
        slips = contact.slip != 0.0
        inside &= slips[..., 1:, :] & slips[..., :-1, :]
    variables = {name: np.abs(law.value_at(contact, name)) for name, _ in levels}
    crossed = []
    for name, value in levels:
        above = variables[name] >= value
        crossed.append(inside & (above[..., 1:, :] != above[..., :-1, :]))
    first = np.nonzero(np.logical_or.reduce(crossed))
    if not first[0].size:
        return rate
    point, node, strip = first
    second = point, node + 1, strip
    strips = problem.strips
    width = np.where(contact.strip_width > 0.0, contact.strip_width, 1.0)  # of strips that fill up a batch it is zero
    length = contact.area / width[..., None, :]
    middle_at = 0.0 if strips is None else strips.x[..., None, :]
    border = _borders(contact.x, length, step, middle_at)[first]
    shares = np.empty((node.size, len(levels) + 1))
    shares[:] = np.clip((border - contact.x[first]) / step[first], 0.0, 1.0)[:, None]
    in_first_until = shares[:, -1:].copy()
    for column, ((name, value), here) in enumerate(zip(levels, crossed, strict=True)):
        low, high = variables[name][first], variables[name][second]
        level = np.broadcast_to(value, contact.pressure.shape)[first]
        np.divide(level - low, high - low, out=shares[:, column], where=here[first])
    shares.sort(axis=-1)
    middle, part = 0.5 * (shares[:, 1:] + shares[:, :-1]), np.diff(shares, axis=-1) * step[first][:, None]
    numbers = {name: value[point] if isinstance(value, np.ndarray) else value for name, value in p.items()}
    there = law.checked_rate(_between(contact, first, second, middle), numbers)[..., 0]
    in_first = middle < in_first_until
    split = rate.copy()
    for cell, in_cell in ((first, in_first), (second, ~in_first)):
        more = np.where(in_cell, (there - rate[cell][:, None]) * part, 0.0).sum(axis=-1)
        np.add.at(split, cell, np.divide(more, length[cell], out=np.zeros_like(more), where=length[cell] > 0.0))
    return split


def _borders(x: Array, length: Array, step: Array, middle: Array | float) -> Array:
    """Return the border between the cells of each node of a strip and the next one, (points, nodes - 1, strips) [m].

    If two nodes are as far apart as the halves of their cells, they lie in the middles of these. Otherwise the cells
    fill the strip from end to end, about its middle.
    """
    half = 0.5 * length
    filling = middle + length.cumsum(axis=-2) - half.sum(axis=-2, keepdims=True)
    in_middles = np.isclose(half[..., 1:, :] + half[..., :-1, :], step, rtol=ROUNDING, atol=0.0)
    return np.where(in_middles, x[..., :-1, :] + half[..., :-1, :], filling[..., :-1, :])


def _between(contact: Contact, first: Any, second: Any, share: Array) -> Contact:
    """Return the contact at shares (pairs, k) of the way from a first node to a second, as one strip for each pair."""
    point, _, strip = first
    fields = {}
    for name in FIELDS:
        values = getattr(contact, name)
        low, high = values[first][:, None], values[second][:, None]
        with np.errstate(invalid="ignore"):  # a traction bound may be infinite
            fields[name] = (low + share * (high - low))[..., None]
    return Contact(
        **fields,
        area=np.ones_like(fields["x"]),
        strip_width=contact.strip_width[point, strip][:, None],
        problem=contact.problem and contact.problem[point],
        **{name: getattr(contact, name)[point] for name in TOTALS},
    )
