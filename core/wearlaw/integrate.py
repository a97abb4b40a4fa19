"""Where the nodes lie, and what a law's rate is on average over the patch.

The only code that sees both a contact model and a wear law. A model that knows its fields in closed form and
a law that declares its breakpoints are integrated to rounding error: nodes in the slip zone, split where a
variable crosses a breakpoint. With less known, the integral is as good as can be had, with an error estimate.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from wearlaw.arrays import Array
from wearlaw.crossings import crossings
from wearlaw.errors import ModelError
from wearlaw.line import LineProblem
from wearlaw.models import ContactModel, LineContactModel, Scale, WearLaw, stick_nodes
from wearlaw.quadrature import join, remainder, zone_nodes
from wearlaw.records import NODE_VARIABLES, Contact

BLOCK = 1024
"""Operating points of a block: small enough for its arrays to stay in the cache."""

PANELS_UNDECLARED = 4
"""Panels of the slip zone for a law that says nothing about where it branches."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ContactTotals:
    """The outcome of a contact at each operating point, as SI arrays of the batch shape."""

    tangential_force: Array
    wear_index: Array
    patch_area: Array
    mean_slip: Array
    slip_area: Array


@dataclass(frozen=True, slots=True, kw_only=True)
class WearTotals:
    """The wear at each operating point, as SI arrays of the batch shape.

    Attributes
    ----------
    wear_rate : ndarray
        Area mean of the law's rate over the patch [kg/m/m²].
    wear_rate_error : ndarray
        Estimate of the integration error in it [kg/m/m²].
    """

    wear_rate: Array
    wear_rate_error: Array


def integrate_contact(model: ContactModel, problem: LineProblem, scale: Scale) -> ContactTotals:
    """Return the totals of a contact, block by block."""
    flat = problem.flatten()
    columns = [_contact_columns(solve(model, flat[block], scale)) for block in _blocks(flat)]
    return ContactTotals(**_join(columns, problem.batch_shape))


def integrate_wear(
    model: ContactModel,
    law: WearLaw,
    problem: LineProblem,
    scale: Scale,
    on_block: Callable[[int], None] | None = None,
) -> tuple[ContactTotals, WearTotals]:
    """Return the totals of a contact and of the wear in it, block by block.

    `on_block` is called with the number of operating points of each block when that is done.

    Raises
    ------
    ModelError
        If the model or the law breaks its contract.
    """
    flat = problem.flatten()
    contact_columns, wear_columns = [], []
    for block in _blocks(flat):
        contact = contact_for(model, law, flat[block], scale)
        rate = law.checked_rate(contact)
        contact_columns.append(_contact_columns(contact))
        wear_columns.append({"wear_rate": contact.mean(rate), "wear_rate_error": _error(model, scale, contact, rate)})
        if on_block is not None:
            on_block(contact.rolling_speed.size)
    shape = problem.batch_shape
    return ContactTotals(**_join(contact_columns, shape)), WearTotals(**_join(wear_columns, shape))


def solve(model: ContactModel, problem: LineProblem, scale: Scale) -> Contact:
    """Return the contact of a model on its own nodes, or its patch mean where that is asked for."""
    contact = model.solve(problem)
    _check_contact(model, contact, problem)
    if scale == "patch" and model.scale != "patch":
        return contact.patch_mean()
    return contact


def contact_for(model: ContactModel, law: WearLaw, problem: LineProblem, scale: Scale) -> Contact:
    """Return the contact on the nodes that suit a law."""
    if scale == "patch" or not isinstance(model, LineContactModel):
        return solve(model, problem, scale)
    start, end = model.slip_zone(dataclasses.replace(problem, creepage=np.abs(problem.creepage)))
    breakpoints = law.breakpoints
    if breakpoints is None:
        slipping = zone_nodes(start, end, panels=PANELS_UNDECLARED)
    else:
        per_node = {name: values for name, values in breakpoints.items() if name in NODE_VARIABLES}
        slipping = zone_nodes(start, end, splits=crossings(model, problem, (start, end), per_node))
    contact = model.at(problem, join(*stick_nodes(problem, start, end), slipping))
    _check_contact(model, contact, problem)
    return contact


def _check_contact(model: ContactModel, contact: Contact, problem: LineProblem) -> None:
    for name in ("pressure", "traction", "slip", "area", "tangential_force"):
        if not np.isfinite(getattr(contact, name)).all():
            raise ModelError(
                f"contact model '{model.name}' gave a {name.replace('_', ' ')} that is not finite"
                f" for {_ranges(problem)}"
            )


def _ranges(problem: LineProblem) -> str:
    creepage, pressure = problem.creepage, problem.max_pressure
    return (
        f"creepages from {creepage.min():g} to {creepage.max():g}"
        f" and maximum pressures from {pressure.min():g} to {pressure.max():g} Pa"
    )


def _error(model: ContactModel, scale: Scale, contact: Contact, rate: Array) -> Array:
    resolved = scale == "cells"
    if resolved and not isinstance(model, LineContactModel):
        return _thinning_error(contact, rate)
    weighted = rate * contact.area
    # Positions are exact to the rounding of a, so in a short slip zone the rates are that much less exact.
    slip_area = contact.slip_area
    shortness = np.divide(contact.patch_area, slip_area, out=np.ones_like(slip_area), where=slip_area > 0)
    error = np.finfo(np.float64).eps * shortness * contact.sum_over_nodes(np.abs(weighted))
    if resolved:
        error = error + remainder(weighted)
    return error / contact.patch_area


def _thinning_error(contact: Contact, rate: Array) -> Array:
    """Return how far the mean moves when nodes are left out, for nodes of which nothing is known.

    The means over every other node show steps that fall between nodes; they agree by symmetry for a rate that
    vanishes at both ends, where the middle nodes of every three, with the area of the three, still differ.
    """
    shape = (*contact.rolling_speed.shape, -1)
    area, weighted = contact.area.reshape(shape), (rate * contact.area).reshape(shape)
    if area.shape[-1] < 2:
        return np.abs(contact.mean(rate))
    halves = [weighted[..., part].sum(-1) / area[..., part].sum(-1) for part in (slice(0, None, 2), slice(1, None, 2))]
    whole = area.shape[-1] // 3 * 3
    threes = (*area.shape[:-1], whole // 3, 3)
    middle = rate.reshape(area.shape)[..., 1:whole:3] * area[..., :whole].reshape(threes).sum(-1)
    thinned = middle.sum(-1) - weighted[..., :whole].sum(-1)
    error: Array = np.abs(halves[0] - halves[1]) + np.abs(thinned) / contact.patch_area
    return error


def _contact_columns(contact: Contact) -> dict[str, Array]:
    return {
        "tangential_force": contact.tangential_force,
        "wear_index": contact.wear_index,
        "patch_area": contact.patch_area,
        "mean_slip": contact.mean_slip,
        "slip_area": contact.slip_area,
    }


def _blocks(flat: LineProblem) -> Iterator[slice]:
    points = flat.creepage.size
    return (slice(first, first + BLOCK) for first in range(0, points, BLOCK))


def _join(columns: list[dict[str, Array]], shape: tuple[int, ...]) -> dict[str, Array]:
    if not columns:
        raise ValueError("an empty batch has no totals")
    return {name: np.concatenate([c[name] for c in columns]).reshape(shape) for name in columns[0]}
