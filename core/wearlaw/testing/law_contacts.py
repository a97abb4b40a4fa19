"""Contacts on which the checks try a wear law: on lines, on strips of an ellipse, and the means of an ellipse.

The plain ones have one axis of nodes, and one value at all nodes if they are at a border of the law. The others are
mixed: in one contact, nodes lie below, at and above a border of the law, nodes stick beside nodes that slip, and nodes
stand for no area. On strips, traction and slip point in different directions. The strips are of different widths and
lie in one part or in two, as in a patch that is no ellipse.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, partial
from typing import TypeAlias

import numpy as np
from hypothesis import strategies as st

from wearlaw.arrays.array import Array
from wearlaw.contact.contact import LAW_VARIABLES, Contact
from wearlaw.models.law import Law
from wearlaw.testing.examples import beginning, for_each
from wearlaw.testing.sampling import (
    CONDITIONS_DRAWN,
    NODE_VALUES_DRAWN,
    aimed,
    at_nodes,
    contact_from_shares,
    retotalled,
    with_problem,
    with_totals_of_strips,
)
from wearlaw.testing.strategies import contacts

Contacts: TypeAlias = st.SearchStrategy[Contact]

Border: TypeAlias = tuple[str, float]
"""A variable of a contact, and the SI value at which a law branches."""

EMPTY = 0.1
"""Share of nodes without area, pressure, traction or slip, and of those far from the border that others are at."""

STICK = (0.0, 0.3, 0.6)
"""Shares of nodes that stick."""

SPINNING = 0.75
"""Share of the means of an ellipse that transmit a force; the others only spin."""

WIDEST = np.arccos(0.05)
"""Largest angle between traction and slip. At a right angle they would dissipate nothing."""

LINE, STRIPS, MEANS = "", "on strips: ", "on the means of an ellipse: "
"""How messages begin."""


def borders(law: Law) -> tuple[Border, ...]:
    """Return where a law branches, the wear index last, since the values at the nodes change it.

    `declared_names_are_variables` refuses other names and values.
    """
    found = [
        (name, float(value))
        for name, values in (law.breakpoints(law.numbers) or {}).items()
        for value in values
        if name in LAW_VARIABLES and np.isfinite(value)
    ]
    return tuple(sorted(found, key=lambda border: border[0] == "wear_index"))


def for_each_contact(law: Law, examine: Callable[[Contact], None]) -> None:
    """Run a function on contacts of the scale of a law."""
    for where, strategy in _of_law(law.scale == "patch", borders(law)):
        with beginning(where):
            for_each(strategy, lambda contact: examine(with_problem(contact, law)))


def for_each_of_nodes(law: Law, examine: Callable[[Contact], None]) -> None:
    """Run a function on contacts whose nodes can be listed anew; the means of an ellipse have one node only.

    A law of the patch, which may sum over the nodes, is not tried at its borders, which a sum meets but for rounding.
    """
    for where, strategy in _of_law(False, borders(law) if law.outcome.of != "patch" else ()):
        if where != MEANS:
            with beginning(where):
                for_each(strategy, lambda contact: examine(with_problem(contact, law)))


@cache  # draws once for each law
def _of_law(patch: bool, of_law: tuple[Border, ...]) -> tuple[tuple[str, Contacts], ...]:
    crowded: dict[str, tuple[float, ...]] = {}
    for name, value in of_law:
        crowded[name] = (*crowded.get(name, ()), value)
    plain, means = contacts(nodes=st.just(1) if patch else st.integers(1, 5), crowded=crowded), means_of(of_law)
    if patch:
        return (LINE, plain), (MEANS, means)
    return (LINE, plain), (LINE, on_lines(of_law)), (STRIPS, on_strips(of_law)), (MEANS, means)


_POINTS, _SEEDS = st.integers(2, 4), st.integers(0, 2**32 - 1)


@cache
def on_lines(of_law: tuple[Border, ...]) -> Contacts:
    """Return mixed contacts with one axis of nodes."""
    return st.builds(partial(_on_line, of_law), _SEEDS, _POINTS, st.integers(3, 8))


@cache
def on_strips(of_law: tuple[Border, ...]) -> Contacts:
    """Return mixed contacts on strips."""
    return st.builds(partial(_on_strips, of_law), _SEEDS, _POINTS, st.tuples(st.integers(3, 5), st.integers(1, 4)))


@cache
def means_of(of_law: tuple[Border, ...]) -> Contacts:
    """Return contacts of one node with the means of an ellipse, whose Tγ is not the product of traction and slip."""
    return st.builds(partial(_means, of_law), _SEEDS, _POINTS)


def _on_line(of_law: tuple[Border, ...], seed: int, points: int, nodes: int) -> Contact:
    random = np.random.default_rng(seed)
    return _mixed(random, _random(random, points, nodes), of_law)


def _on_strips(of_law: tuple[Border, ...], seed: int, points: int, axes: tuple[int, int]) -> Contact:
    random = np.random.default_rng(seed)
    return _mixed(random, _strips(random, _random(random, points, axes[0] * axes[1]), axes), of_law)


def _means(of_law: tuple[Border, ...], seed: int, points: int) -> Contact:
    random = np.random.default_rng(seed)
    contact = _strips(random, _random(random, points, 1), (1, 1))
    # Spin alone dissipates energy without a force, up to that of full slip.
    contact = retotalled(contact, traction=contact.traction * (random.random((points, 1, 1)) < SPINNING))
    index = random.random(points) * (contact.traction_bound * contact.slip * contact.area)[..., 0, 0]
    return _at_borders(random, contact.replaced(wear_index=index), of_law)


def _random(random: np.random.Generator, points: int, nodes: int) -> Contact:
    """Return random contacts of one axis of nodes, of which some lack pressure, traction, slip or area."""
    shares = random.random((points, nodes, NODE_VALUES_DRAWN))
    shares[..., :3] *= random.random((points, nodes, 3)) >= EMPTY
    contact = contact_from_shares(shares, random.random((points, CONDITIONS_DRAWN)))
    empty = random.random(contact.area.shape) < EMPTY
    empty[..., 0] = False
    return retotalled(contact, area=np.where(empty, 0.0, contact.area))


def _strips(random: np.random.Generator, contact: Contact, axes: tuple[int, int]) -> Contact:
    """Return a contact with its nodes on strips and its vectors in random directions."""
    points = contact.rolling_speed.size

    def laid(name: str) -> Array:
        array: Array = np.abs(getattr(contact, name)).reshape(points, *axes)
        return array

    angle = random.uniform(-np.pi, np.pi, (points, *axes))
    turned = angle + random.uniform(-WIDEST, WIDEST, angle.shape) * (random.random(angle.shape) < 0.7)
    traction, slip = laid("traction"), laid("slip")
    y = np.sort(random.uniform(-5e-3, 5e-3, (points, axes[1])))
    in_two_parts = random.random((points, 1)) < 0.5
    y = y + 1e-2 * in_two_parts * (np.arange(axes[1]) >= axes[1] / 2)
    return with_totals_of_strips(
        pressure=laid("pressure"),
        traction=(traction * np.cos(angle), traction * np.sin(angle)),
        slip=(slip * np.cos(turned), slip * np.sin(turned)),
        traction_bound=laid("traction_bound"),
        area=laid("area"),
        x=np.sort(random.uniform(-5e-3, 5e-3, (points, *axes)), axis=-2),
        y=np.broadcast_to(y[:, None, :], (points, *axes)),
        strip_width=10.0 ** random.uniform(-4, -2, (points, axes[1])),
        rolling_speed=contact.rolling_speed,
        density=contact.density,
    )


def _mixed(random: np.random.Generator, contact: Contact, of_law: tuple[Border, ...]) -> Contact:
    """Return a contact with nodes on both sides of borders, and with nodes that stick."""
    contact = _at_borders(random, contact, of_law)
    share = random.choice(STICK, contact.rolling_speed.shape)
    sticks = random.random(contact.slip.shape) < contact.per_node(share)
    return retotalled(contact, slip=np.where(sticks, 0.0, contact.slip))


def _at_borders(random: np.random.Generator, contact: Contact, of_law: tuple[Border, ...]) -> Contact:
    """Return a contact with each operating point at one border: its nodes below, at or above it by random gaps."""
    shape = contact.pressure.shape
    chosen = contact.per_node(np.floor(random.uniform(0, len(of_law), contact.rolling_speed.shape)))
    for number, (name, value) in enumerate(of_law):
        near = value * (1.0 + random.choice([-1.0, 0.0, 1.0], shape) * 10.0 ** random.uniform(-15.0, -1.0, shape))
        there = (chosen == number) & (random.random(shape) >= EMPTY)
        contact = aimed(contact, name, np.where(there, near, at_nodes(contact, name)))
    return contact


def straddles(contact: Contact, border: Border) -> bool:
    """Return whether one operating point has nodes below a border and nodes at or above it, all of which slip."""
    value = at_nodes(contact, border[0]).reshape(contact.rolling_speed.size, -1)
    slips = contact.slip.reshape(value.shape) != 0.0
    below, above = (value < border[1]) & slips, (value >= border[1]) & slips
    return bool((below.any(axis=-1) & above.any(axis=-1)).any())


def sticks_in_part(contact: Contact) -> bool:
    """Return whether one operating point has nodes that stick and nodes that dissipate energy."""
    slip, density = (a.reshape(contact.rolling_speed.size, -1) for a in (contact.slip, contact.wear_index_density))
    return bool(((slip == 0.0).any(axis=-1) & (density > 0.0).any(axis=-1)).any())
