"""Contacts on which the checks try a law: on lines, on strips of an ellipse, and the means of an ellipse.

In one contact of several nodes, nodes lie below, at and above a border of the law, nodes stick beside nodes that slip,
and nodes stand for no area. On strips, traction and slip point in different directions. The strips are of different
widths and lie in one part or in two, as in a patch that is no ellipse.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any, TypeAlias

import numpy as np

from wearlaw import steel
from wearlaw.arrays import Array
from wearlaw.contact.contact import Contact
from wearlaw.contact.parts import Body
from wearlaw.models.law import LAW_VARIABLES, Law, variable_at_nodes
from wearlaw_kit.examples import failing, for_each, left_out, part
from wearlaw_kit.reduced import drawn, random_lines, wide_ellipses, without_spin
from wearlaw_kit.rules import rule

NODE_FIELDS = (
    "pressure", "traction", "slip", "traction_bound", "area", "x", "y", "traction_x", "traction_y", "slip_x", "slip_y",
)  # fmt: skip
"""Fields of a contact with a value at each node."""

VALUES = ("pressure", "traction", "slip", "traction_bound", "area", "rolling_speed", "density")
"""Fields of a contact of one node from which the others follow."""

STEEL = steel(shear_yield_stress=None)
"""The material of the bodies, unless a law is tried with another."""

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


CONTACTS = {"line": "", "strips": "on strips: ", "means": "on the means of an ellipse: "}
"""The kinds of contact, by the name of the part in an exemption, and how messages begin."""


def has_rates_at_nodes(law: Law) -> bool:
    """Return whether a law has a rate for each node, and no single value for the patch."""
    return bool(law.outcome.of != "patch")


def borders(law: Law) -> tuple[Border, ...]:
    """Return where a law branches, the wear index last, since the values at the nodes change it.

    `declared_names_are_variables` refuses other names and values.
    """
    limits = [
        (name, float(value))
        for name, values in (law.breakpoints(law.numbers) or {}).items()
        for value in values
        if name in LAW_VARIABLES and np.isfinite(value)
    ]
    return tuple(sorted(limits, key=lambda border: border[0] == "wear_index"))


def for_each_contact(law: Law, examine: Callable[[Contact], None], several: bool = False) -> None:
    """Run a function on contacts of the scale of a law.

    With `several`, on those alone whose nodes can be listed anew, which leaves out the means of an ellipse. A law of
    the patch, which may sum over the nodes, is then not tried at its borders, which a sum meets but for rounding.
    """
    of_law = () if several and law.outcome.of == "patch" else borders(law)
    if law.scale == "patch":
        contacts = [("line", on_line(of_law, 0, POINTS, 1))]
    else:
        contacts = [("line", on_line(of_law, seed, POINTS, nodes)) for seed, nodes in enumerate(LINES)]
        contacts += [("strips", on_strips(of_law, seed, POINTS, axes)) for seed, axes in enumerate(AXES)]
    if not several:
        contacts.append(("means", means_of(of_law, 0, POINTS)))
    for of_contacts, contact in contacts:
        if not left_out(of_contacts):
            with part(of_contacts), failing(CONTACTS[of_contacts]):
                for_each(with_problem(contact, law), examine)


def on_contacts(
    kind: type, several: bool = False, **options: Any
) -> Callable[[Callable[[Any, Contact], None]], Callable[[Any], None]]:
    """Return a decorator that registers a check of a law on the contacts of `for_each_contact`."""

    def decorate(check: Callable[[Any, Contact], None]) -> Callable[[Any], None]:
        @functools.wraps(check)
        def on_all(law: Any) -> None:
            for_each_contact(law, functools.partial(check, law), several)

        return rule(kind, **options)(on_all)

    return decorate


def random_contacts(points: int, seed: int = 0, loaded: bool = False, law: Law | None = None) -> Contact:
    """Return contacts of one node at many random operating points, reproducible by seed.

    With `loaded`, every other one has node values in the upper half of their ranges, those of discs at work: from
    30 MPa, 1e-4 of slip and 0.1 mm².
    """
    random = np.random.default_rng(seed)
    shares, conditions = random.random((points, 1, 4)), random.random((points, 4))
    if loaded:
        shares[::2] = 0.5 + 0.5 * shares[::2]
    return with_problem(_from_shares(shares, conditions), law)


def on_line(of_law: tuple[Border, ...], seed: int, points: int, nodes: int) -> Contact:
    """Return mixed contacts with one axis of nodes; those of one node do not stick."""
    random = np.random.default_rng(seed)
    contact = _at_borders(random, _mixed(random, points, nodes), of_law)
    return contact if nodes == 1 else _sticking(random, contact)


def on_strips(of_law: tuple[Border, ...], seed: int, points: int, axes: tuple[int, int]) -> Contact:
    """Return mixed contacts on strips, with axes of nodes along a strip and of strips."""
    random = np.random.default_rng(seed)
    contact = _strips(random, _mixed(random, points, axes[0] * axes[1]), axes)
    return _sticking(random, _at_borders(random, contact, of_law))


def means_of(of_law: tuple[Border, ...], seed: int, points: int) -> Contact:
    """Return contacts of one node with the means of an ellipse, whose Tγ is not the product of traction and slip."""
    random = np.random.default_rng(seed)
    contact = _strips(random, _mixed(random, points, 1), (1, 1))
    # Spin alone dissipates energy without a force, up to that of full slip.
    contact = retotalled(contact, traction=contact.traction * (random.random((points, 1, 1)) < SPINNING))
    index = random.random(points) * (contact.traction_bound * contact.slip * contact.area)[..., 0, 0]
    return _at_borders(random, contact.replaced(wear_index=index), of_law)


def _mixed(random: np.random.Generator, points: int, nodes: int) -> Contact:
    """Return random contacts of one axis of nodes, of which some lack pressure, traction, slip or area."""
    shares = random.random((points, nodes, 4))
    shares[..., :3] *= random.random((points, nodes, 3)) >= EMPTY
    contact = _from_shares(shares, random.random((points, 4)))
    empty = random.random(contact.area.shape) < EMPTY
    empty[..., 0] = False
    return retotalled(contact, area=np.where(empty, 0.0, contact.area))


def _from_shares(nodes: Array, conditions: Array) -> Contact:
    """Map numbers from 0 to 1 to a contact; 0 stands for the value 0 in pressure, traction and slip.

    Parameters
    ----------
    nodes : ndarray, (batch, nodes, 4)
        For pressure, traction over its bound, slip, area.
    conditions : ndarray, (batch, 4)
        For friction, rolling speed, density, sign.
    """

    def at_node(index: int, low: float, high: float) -> Array:
        value: Array = np.where(nodes[..., index] == 0, 0.0, low * (high / low) ** nodes[..., index])
        return value

    sign = np.where(conditions[..., 3] < 0.5, 1.0, -1.0)[..., None]
    bound = (0.01 * 150.0 ** conditions[..., 0])[..., None] * at_node(0, 1e5, 1e10)
    area = 1e-10 * 1e6 ** nodes[..., 3]
    return with_totals(
        pressure=at_node(0, 1e5, 1e10),
        traction=sign * at_node(1, 1e-6, 1.0) * bound,
        slip=sign * at_node(2, 1e-8, 1.0),
        traction_bound=bound,
        area=area,
        x=np.broadcast_to(np.linspace(-1e-3, 1e-3, area.shape[-1]), area.shape),
        rolling_speed=1e-2 * 1e4 ** conditions[..., 1],
        density=1e3 + 1.9e4 * conditions[..., 2],
    )


def _strips(random: np.random.Generator, contact: Contact, axes: tuple[int, int]) -> Contact:
    """Return a contact with its nodes on strips and its vectors in random directions."""
    points = contact.rolling_speed.size
    laid = {name: np.abs(getattr(contact, name)).reshape(points, *axes) for name in NODE_FIELDS[:5]}
    traction, slip = laid.pop("traction"), laid.pop("slip")
    angle = random.uniform(-np.pi, np.pi, (points, *axes))
    turned = angle + random.uniform(-WIDEST, WIDEST, angle.shape) * (random.random(angle.shape) < 0.7)
    y = np.sort(random.uniform(-5e-3, 5e-3, (points, axes[1])))
    in_two_parts = random.random((points, 1)) < 0.5
    y = y + 1e-2 * in_two_parts * (np.arange(axes[1]) >= axes[1] / 2)
    return with_totals(
        **laid,
        traction_x=traction * np.cos(angle),
        traction_y=traction * np.sin(angle),
        slip_x=slip * np.cos(turned),
        slip_y=slip * np.sin(turned),
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


def with_totals(**fields: Any) -> Contact:
    """Return the contact with these values at its nodes, on strips the components of its vectors, and their sums."""
    area, nodes = fields["area"], tuple(range(fields["rolling_speed"].ndim, fields["area"].ndim))

    def total(value: Array) -> Array:
        summed: Array = (value * area).sum(nodes)
        return summed

    if "strip_width" in fields:
        qx, qy, sx, sy = (fields[name] for name in ("traction_x", "traction_y", "slip_x", "slip_y"))
        fields |= {"traction": np.hypot(qx, qy), "slip": np.hypot(sx, sy)}
        fields |= {"force_x": total(qx), "force_y": total(qy), "wear_index": total(qx * sx + qy * sy)}
        fields["tangential_force"] = np.hypot(fields["force_x"], fields["force_y"])
        fields["moment_z"] = -total(fields["x"] * qy + fields["y"] * qx)
    else:
        fields["tangential_force"] = total(fields["traction"])
        fields["wear_index"] = total(fields["traction"] * fields["slip"])
    return Contact(normal_force=total(fields["pressure"]), **fields)


def with_problem(contact: Contact, law: Law | None = None) -> Contact:
    """Return the contact with a problem of its shape without spin, of two bodies of the material to try the law with.

    The bodies are called "body_1" and "body_2", and one of them as the law's `body`.
    """
    speed = contact.rolling_speed
    material = STEEL if law is None or law.example_material is None else law.example_material
    names = dict.fromkeys([*([law.body] if law is not None and law.body else []), "body_1", "body_2"])
    problem = without_spin((wide_ellipses if contact.on_strips else random_lines)(speed.size)).replaced(
        rolling_speed=speed,
        density=contact.density,
        conditions={} if law is None else drawn(law.own_conditions(), speed.shape),
        bodies={name: Body(material, 0.25) for name in [*names][:2]},
    )
    return contact.replaced(problem=problem)


def at_nodes(contact: Contact, variable: str) -> Array:
    """Return the magnitude of a variable at the nodes."""
    magnitude: Array = np.abs(variable_at_nodes(contact, variable))
    return magnitude


def forward(contact: Contact) -> Contact:
    """Return the contact with positive creepage."""
    return retotalled(contact, traction=np.abs(contact.traction), slip=np.abs(contact.slip))


def retotalled(contact: Contact, **changed: Array) -> Contact:
    """Return the contact with some node values changed, and its sums recomputed.

    On strips, a new magnitude of traction or slip keeps the direction of the old one, or lies along x without one.
    """
    values = {name: getattr(contact, name) for name in (*VALUES, "x")} | changed
    if not contact.on_strips:
        return with_totals(**values).replaced(problem=contact.problem)
    factors = {name: _ratio(values[name], getattr(contact, name)) for name in ("traction", "slip", "area")}
    for name in ("traction", "slip"):
        turned = getattr(contact, name) == 0.0
        for axis, alone in (("x", values[name]), ("y", 0.0)):
            values[f"{name}_{axis}"] = np.where(turned, alone, getattr(contact, f"{name}_{axis}") * factors[name])
    recomputed = with_totals(**values, y=contact.y, strip_width=contact.strip_width).replaced(problem=contact.problem)
    if not _of_means(contact):
        return recomputed
    # The Tγ of means is not the product of their traction and slip.
    factor = factors["traction"] * factors["slip"] * factors["area"]
    return recomputed.replaced(wear_index=contact.wear_index * factor[..., 0, 0])


def _ratio(new: Array, old: Array) -> Array:
    """Return new over old, or one where the old value is zero."""
    factor: Array = np.divide(new, old, out=np.ones_like(old), where=old != 0.0)
    return factor


def _of_means(contact: Contact) -> bool:
    """Return whether the one node of a contact holds the means of an ellipse."""
    return contact.on_strips and contact.pressure.shape[-2:] == (1, 1)


def aimed(contact: Contact, variable: str, value: Array | float) -> Contact:
    """Return the contact with a variable set to a value at all nodes, or unchanged if that is impossible.

    A wear-index density is reached by traction, a slip speed by slip, the wear index by area.

    Parameters
    ----------
    value : ndarray or float
        Value for all nodes, or one for each; for the wear index, the one of the first node counts.
    """
    target = np.broadcast_to(np.asarray(value, dtype=np.float64), contact.pressure.shape)
    sign = np.where(contact.traction + contact.slip < 0, -1.0, 1.0)
    speed = contact.per_node(contact.rolling_speed)
    if variable in ("x", "traction_bound"):
        return contact.replaced(**{variable: target.copy()})
    if variable == "pressure":
        return retotalled(contact, pressure=target.copy(), traction_bound=np.maximum(contact.traction_bound, target))
    if variable in ("slip", "slip_speed"):
        return retotalled(contact, slip=sign * (target if variable == "slip" else target / speed))
    if variable == "frictional_power_density":
        return aimed(contact, "wear_index_density", target / speed)
    first = target.reshape(*contact.wear_index.shape, -1)[..., 0]
    if variable == "wear_index":
        exact = np.where(contact.wear_index > 0, first, contact.wear_index)
        factor = contact.per_node(_ratio(exact, contact.wear_index))
        return retotalled(contact, area=contact.area * factor).replaced(wear_index=exact)
    if variable == "wear_index_density" and _of_means(contact):
        dissipates = contact.wear_index > 0.0
        return contact.replaced(wear_index=np.where(dissipates, first * contact.patch_area, contact.wear_index))
    if variable == "wear_index_density" and contact.on_strips:
        target = contact.traction * _ratio(target, contact.wear_index_density)
    elif variable == "wear_index_density":
        slip = np.abs(contact.slip)
        target = np.divide(target, slip, out=np.abs(contact.traction), where=slip > 0)
    return retotalled(contact, traction=sign * target, traction_bound=np.maximum(contact.traction_bound, target))
