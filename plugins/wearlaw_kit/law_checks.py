"""Checks that a wear law depends only on permitted variables, and keeps its declarations."""

from __future__ import annotations

import contextlib
import dataclasses
import itertools
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from wearlaw.arrays.array import Array
from wearlaw.contact.contact import Contact
from wearlaw.errors import WearlawError
from wearlaw.models.law import Law, Numbers
from wearlaw.settings.parameters import changed, number_like, numbers
from wearlaw.units.quantities import Quantity
from wearlaw_kit.examples import SAME, assert_close
from wearlaw_kit.law_contacts import borders, for_each_contact, on_contacts, on_nodes
from wearlaw_kit.law_shape import of_patch, with_slip_across
from wearlaw_kit.sampling import NODE_FIELDS, aimed, arrays_of, at_nodes, forward, random_contacts, retotalled, rows

STEPS = (1.0, 1.001, 0.999)
"""Factors of a parameter at one operating point after the other; small, since laws refuse parameters out of order."""


SUMS = 1e-9
"""Rounding of a value that a law of the patch sums over its nodes, where the sum may be a small difference. A mean
without areas, or the first node alone, is off by the difference of one of at most 40 nodes from the others."""


@on_nodes
def order_of_nodes_does_not_matter(law: Law, contact: Contact) -> None:
    """Each node keeps its rate when nodes or strips are listed in another order, and a patch its value."""
    rate = law.rate(contact, law.numbers)
    for axis in _axes(contact):
        count = contact.pressure.shape[axis]
        for order in (np.arange(count)[::-1], np.random.default_rng(count).permutation(count)):
            listed: Callable[[Array], Array] = partial(np.take, indices=order, axis=axis)
            found, due = (
                law.rate(_nodes(contact, listed, axis), law.numbers),
                rate if law.outcome.of == "patch" else listed(rate),
            )
            message = f"the rate with the nodes in the order {order.tolist()}"
            assert_close(found, due, message, of_patch(law, SUMS, SAME))


def position_does_not_matter(law: Law) -> None:
    """The rate is the same if the nodes lie elsewhere, and pressure, traction and slip are as before.

    A law that branches at positions `x` is not checked.
    """
    if any(name == "x" for name, _ in borders(law)):
        return

    def examine(contact: Contact) -> None:
        rate = law.rate(contact, law.numbers)
        for message, factor, shift in (("at zero", 0.0, 0.0), ("mirrored", -1.0, 0.0), ("shifted", 1.0, 1e-3)):
            for name in ("x", "y") if contact.on_strips else ("x",):
                moved = contact.replaced(**{name: factor * getattr(contact, name) + shift})
                assert_close(law.rate(moved, law.numbers), rate, f"the rate with {name} {message}")

    for_each_contact(law, examine)


@on_contacts
def batching_does_not_matter(law: Law, contact: Contact) -> None:
    """One operating point at a time gives the same as all at once."""
    together = law.rate(contact, law.numbers)
    for point in range(contact.rolling_speed.size):
        alone = law.rate(rows(contact, [point]), law.numbers)[0]
        assert_close(together[point], alone, f"the rate at operating point {point} of a batch")


@on_nodes
def splitting_a_node_does_not_matter(law: Law, contact: Contact) -> None:
    """Two parts of a node wear at the rate of the whole, as do two parts of a strip; the rest stays the same.

    So a mean over the nodes has to be weighted by their areas.
    """
    rate = law.rate(contact, law.numbers)
    for axis in _axes(contact):
        count = contact.pressure.shape[axis]
        split: Callable[[Array], Array] = partial(np.repeat, repeats=[2, *[1] * (count - 1)], axis=axis)
        parts, share = _nodes(contact, split, axis), np.array([0.25, 0.75, *[1.0] * (count - 1)])
        width = share * parts.strip_width if _of_strips(contact, axis) else parts.strip_width
        parts = parts.replaced(area=share.reshape(-1, *[1] * (-1 - axis)) * parts.area, strip_width=width)
        found, due = law.rate(parts, law.numbers), rate if law.outcome.of == "patch" else split(rate)
        assert_close(found, due, "the rate with a node in two parts", of_patch(law, SUMS, SAME))


@on_nodes
def each_node_wears_by_itself(law: Law, contact: Contact) -> None:
    """The rate at a node depends on its own values and the totals of the patch, not on its neighbours."""
    rate = law.rate(contact, law.numbers)
    names = [name for name in NODE_FIELDS if name != "area"]
    of_nodes = rate.shape[contact.rolling_speed.ndim :]
    for node in np.ndindex(of_nodes):
        at: Any = (..., *(slice(index, index + 1) for index in node))
        alike = {name: np.broadcast_to(getattr(contact, name)[at], rate.shape).copy() for name in names}
        found = law.rate(contact.replaced(**alike), law.numbers)[at]
        assert_close(found, rate[at], f"the rate at node {_named(node)} among others like it")


@on_nodes
def strips_wear_as_lines_do(law: Law, contact: Contact) -> None:
    """Nodes on strips wear at the rate of the same nodes on a line, where traction and slip are parallel to x."""
    if not contact.on_strips:
        return
    along = with_slip_across(contact, 0.0)
    nodes = ("pressure", "traction", "slip", "traction_bound", "area", "x")
    totals = ("rolling_speed", "normal_force", "tangential_force", "wear_index", "density")
    values = {name: getattr(along, name).reshape(contact.rolling_speed.size, -1) for name in nodes}
    line = Contact(**values, **{name: getattr(along, name) for name in totals}, problem=contact.problem)
    rate = law.rate(along, law.numbers).reshape(line.pressure.shape)
    assert_close(rate, law.rate(line, law.numbers), "the rate on strips, against a line")


def _named(node: tuple[int, ...]) -> str:
    """Return the index of a node as text."""
    return str(node[0]) if len(node) == 1 else f"{node[0]} of strip {node[1]}"


def _of_strips(contact: Contact, axis: int) -> bool:
    """Return whether an axis is that of the strips."""
    return contact.on_strips and axis == -1


def _axes(contact: Contact) -> tuple[int, ...]:
    """Return the axes of nodes; the first of them runs along a strip."""
    return (-2, -1) if contact.on_strips else (-1,)


def is_monotone_as_declared(law: Law) -> None:
    """The rate never falls when a variable in `monotone_in` grows, from anywhere to anywhere, over all decades.

    The wear-index density grows by the traction and by the slip.
    """
    start = _many(law)
    rate = law.rate(start, law.numbers)
    for name in law.monotone_in:
        for by, factor in itertools.product(GROWN_BY.get(name, (name,)), 1.0 + np.logspace(-6, 2, 17)):
            after = law.rate(_grown(start, by, factor), law.numbers)
            fell = after < rate * (1.0 - SAME)
            if fell.any():
                at = tuple(np.argwhere(fell)[0])
                raise AssertionError(
                    f"the rate falls from {rate[at]!r} to {after[at]!r} as {name} grows from"
                    f" {at_nodes(start, name)[at]:g} by a factor of {factor:g} in {by}"
                )


GROWN_BY = {"wear_index_density": ("traction", "slip")}
"""Fields of a contact that are raised to raise a variable; others are raised directly."""


def _many(law: Law, points: int = 512) -> Contact:
    """Return many contacts of one node, a third of them at the breakpoints of the law."""
    contact = forward(random_contacts(points, law=law))
    targets = [(name, value) for name, values in (law.breakpoints(law.numbers) or {}).items() for value in values]
    for number, (name, value) in enumerate(targets):
        chosen = np.arange(points) % (3 * len(targets)) == number
        near = value * np.random.default_rng(number).uniform(0.7, 1.1, contact.pressure.shape)
        contact = _where(chosen, aimed(contact, name, near), contact)
    return contact


def _grown(contact: Contact, name: str, factor: float) -> Contact:
    """Return the contact with a variable raised, and with it the wear index if that depends on the variable."""
    if name == "slip_speed":
        return retotalled(contact, rolling_speed=contact.rolling_speed * factor)
    if name == "wear_index":
        return dataclasses.replace(
            contact, wear_index=contact.wear_index * factor, tangential_force=contact.tangential_force * factor
        )
    return aimed(contact, name, at_nodes(contact, name) * factor)


def _where(chosen: Array, first: Contact, second: Contact) -> Contact:
    def mixed(name: str) -> Array:
        one, other = getattr(first, name), getattr(second, name)
        value: Array = np.where(chosen.reshape(chosen.shape + (1,) * (one.ndim - 1)), one, other)
        return value

    return first.replaced(**{name: mixed(name) for name in arrays_of(first)})


def _nodes(contact: Contact, change: Callable[[Array], Array], axis: int) -> Contact:
    """Return the contact with its arrays of nodes changed along an axis, and its totals kept."""
    names = (*NODE_FIELDS, "strip_width") if _of_strips(contact, axis) else NODE_FIELDS
    return contact.replaced(**{name: change(getattr(contact, name)) for name in names})


def parameters_may_vary(law: Law) -> None:
    """A number that varies from point to point gives the same rate, breakpoints and ramps as a law for each value."""
    law = law.explicit()
    of_each = laws_of_values(law)

    node_axes = (0,) if law.outcome.of == "patch" else (1, 2)

    def with_values(name: str, node_axes: int) -> Numbers:
        return {**law.numbers, name: (law.numbers[name] * np.array(STEPS)).reshape(-1, *[1] * node_axes)}

    for name, laws in of_each.items():
        for axes in node_axes:
            borders_of_points = _borders(law, with_values(name, axes))
            for point, one in laws.items():
                for found, expected, of in zip(borders_of_points, _borders(one, one.numbers), BORDERS, strict=True):
                    assert_close(_at(found, point), _at(expected, 0), f"the {of} with {name} for each point")

    def examine(contact: Contact) -> None:
        for first in range(contact.rolling_speed.size):
            batch, alone = rows(contact, [first] * len(STEPS)), rows(contact, [first])
            due = of_patch(law, batch.pressure.shape[:1], batch.pressure.shape)
            for name, laws in of_each.items():
                rate = law.rate(batch, with_values(name, of_patch(law, 0, batch.pressure.ndim - 1)))
                assert np.shape(rate) == due, f"rates of shape {np.shape(rate)} when {name} varies"
                for point, one in laws.items():
                    assert_close(rate[point], one.rate(alone, one.numbers)[0], f"the rate with {name} for each point")

    for_each_contact(law, examine)


def laws_of_values(law: Law) -> dict[str, dict[int, Law]]:
    """Return for each number of a law the laws with that number at each of `STEPS`, by the index of the step."""
    return {name: _of_values(law, name, number) for name, number in numbers(law).items()}


def _of_values(law: Law, name: str, number: Quantity | float) -> dict[int, Law]:
    """Return the laws with a number at each of `STEPS`, without values that the law does not take."""
    laws = {}
    for point, value in enumerate(law.numbers[name] * np.array(STEPS)):
        with contextlib.suppress(WearlawError):
            laws[point] = changed(law, {name: number_like(number, float(value))})
    return laws


BORDERS = ("breakpoints", "ramps")


def _borders(law: Law, p: Numbers) -> tuple[list[Any], list[Any]]:
    """Return the numbers of breakpoints and of ramps, each in one list."""
    breakpoints, ramps = law.breakpoints(p) or {}, law.ramps(p) or ()
    return [value for name in sorted(breakpoints) for value in breakpoints[name]], [n for ramp in ramps for n in ramp]


def _at(found: list[Any], point: int) -> Array:
    """Return numbers at one operating point, of which each is a float or an array with one value for each."""
    flat = [np.ravel(number) for number in found]
    return np.array([each[point if each.size > 1 else 0] for each in flat])


OF_NODES_OF_ANY_LAW = (order_of_nodes_does_not_matter, splitting_a_node_does_not_matter)
"""Checks of laws of contacts of several nodes, with a rate for each node or one value for the patch."""

OF_SEVERAL_NODES = (*OF_NODES_OF_ANY_LAW, each_node_wears_by_itself, strips_wear_as_lines_do)
"""Checks of laws that are not of the whole patch."""

OF_ANY_LAW = (parameters_may_vary, batching_does_not_matter)

CHECKS = (*OF_ANY_LAW, position_does_not_matter, *OF_SEVERAL_NODES, is_monotone_as_declared)
