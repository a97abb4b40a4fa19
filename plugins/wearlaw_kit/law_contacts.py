"""Contacts on which the checks try a wear law: on lines, on strips of an ellipse, and the means of an ellipse.

In one contact of several nodes, nodes lie below, at and above a border of the law, nodes stick beside nodes that slip,
and nodes stand for no area. On strips, traction and slip point in different directions. The strips are of different
widths and lie in one part or in two, as in a patch that is no ellipse.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import TypeAlias

import numpy as np

from wearlaw.arrays.array import Array
from wearlaw.contact.contact import LAW_VARIABLES, Contact
from wearlaw.models.law import Law
from wearlaw_kit.examples import beginning, for_each
from wearlaw_kit.sampling import (
    CONDITIONS_DRAWN,
    NODE_VALUES_DRAWN,
    aimed,
    at_nodes,
    contact_from_shares,
    retotalled,
    with_problem,
    with_totals_of_strips,
)

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

POINTS = 24
"""Operating points of a batch."""

LINES, AXES = (1, 3, 8), ((3, 1), (4, 3), (5, 4))
"""Numbers of nodes on a line, and along a strip and of strips."""

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
    patch, of_law = law.scale == "patch", borders(law)
    lines = (1,) if patch else LINES
    _run(law, LINE, [on_line(of_law, seed, POINTS, nodes) for seed, nodes in enumerate(lines)], examine)
    if not patch:
        _run(law, STRIPS, [on_strips(of_law, seed, POINTS, axes) for seed, axes in enumerate(AXES)], examine)
    _run(law, MEANS, [means_of(of_law, 0, POINTS)], examine)


def for_each_of_nodes(law: Law, examine: Callable[[Contact], None]) -> None:
    """Run a function on contacts whose nodes can be listed anew; the means of an ellipse have one node only.

    A law of the patch, which may sum over the nodes, is not tried at its borders, which a sum meets but for rounding.
    """
    of_law = borders(law) if law.outcome.of != "patch" else ()
    _run(law, LINE, [on_line(of_law, seed, POINTS, nodes) for seed, nodes in enumerate(LINES)], examine)
    _run(law, STRIPS, [on_strips(of_law, seed, POINTS, axes) for seed, axes in enumerate(AXES)], examine)


def on_contacts(check: Callable[[Law, Contact], None]) -> Callable[[Law], None]:
    """Run a check on contacts of the scale of a law."""
    return functools.wraps(check)(lambda law: for_each_contact(law, functools.partial(check, law)))


def on_nodes(check: Callable[[Law, Contact], None]) -> Callable[[Law], None]:
    """Run a check on contacts whose nodes can be listed anew."""
    return functools.wraps(check)(lambda law: for_each_of_nodes(law, functools.partial(check, law)))


def _run(law: Law, where: str, found: list[Contact], examine: Callable[[Contact], None]) -> None:
    with beginning(where):
        for contact in found:
            for_each(with_problem(contact, law), examine)


def on_line(of_law: tuple[Border, ...], seed: int, points: int, nodes: int) -> Contact:
    """Return mixed contacts with one axis of nodes; those of one node do not stick."""
    random = np.random.default_rng(seed)
    contact = _at_borders(random, _random(random, points, nodes), of_law)
    return contact if nodes == 1 else _sticking(random, contact)


def on_strips(of_law: tuple[Border, ...], seed: int, points: int, axes: tuple[int, int]) -> Contact:
    """Return mixed contacts on strips, with axes of nodes along a strip and of strips."""
    random = np.random.default_rng(seed)
    contact = _strips(random, _random(random, points, axes[0] * axes[1]), axes)
    return _sticking(random, _at_borders(random, contact, of_law))


def means_of(of_law: tuple[Border, ...], seed: int, points: int) -> Contact:
    """Return contacts of one node with the means of an ellipse, whose Tγ is not the product of traction and slip."""
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


def _sticking(random: np.random.Generator, contact: Contact) -> Contact:
    """Return the contact with nodes that stick, a share of them at each operating point."""
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
