"""Contacts from numbers between 0 and 1, and contacts with one variable changed."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np

from wearlaw.arrays.array import Array
from wearlaw.contact.contact import Contact, variable_at_nodes
from wearlaw.contact.material import steel
from wearlaw.contact.problem import Body, Problem
from wearlaw.models.law import Law

EPS = float(np.finfo(np.float64).eps)

_VALUES = ("pressure", "traction", "slip", "traction_bound", "area", "rolling_speed", "density")
"""Fields of a contact of the kit; its totals follow from them."""

NODE_FIELDS = (
    "pressure", "traction", "slip", "traction_bound", "area", "x", "y", "traction_x", "traction_y", "slip_x", "slip_y",
)  # fmt: skip
"""Fields of a contact with a value at each node."""

_PRESSURE = (1e5, 1e10)
_TRACTION = (1e-6, 1.0)
_SLIP = (1e-8, 1.0)
_AREA = (1e-10, 1e-4)
HALF_LENGTH = 1e-3
"""Half the length of the patch of a contact of the kit [m]."""

STEEL = steel(shear_yield_stress=None)
"""The material of its bodies, unless a law is tried with another."""

NODE_VALUES_DRAWN = 4
"""Shares per node: pressure, traction over its bound, slip, area."""
CONDITIONS_DRAWN = 4
"""Shares per operating point: friction, rolling speed, density, sign."""


def _log_range(share: Array, low: float, high: float) -> Array:
    value: Array = low * (high / low) ** share
    return value


def contact_from_shares(nodes: Array, conditions: Array) -> Contact:
    """Map numbers from 0 to 1 to a contact.

    Parameters
    ----------
    nodes : ndarray, (batch, nodes, NODE_VALUES_DRAWN)
        A share of 0 stands for the value 0 in pressure, traction and slip.
    conditions : ndarray, (batch, CONDITIONS_DRAWN)
    """
    friction = _log_range(conditions[..., 0], 0.01, 1.5)
    sign = np.where(conditions[..., 3] < 0.5, 1.0, -1.0)[..., None]
    pressure = np.where(nodes[..., 0] == 0, 0.0, _log_range(nodes[..., 0], *_PRESSURE))
    bound = friction[..., None] * pressure
    return with_totals(
        pressure=pressure,
        traction=sign * np.where(nodes[..., 1] == 0, 0.0, _log_range(nodes[..., 1], *_TRACTION)) * bound,
        slip=sign * np.where(nodes[..., 2] == 0, 0.0, _log_range(nodes[..., 2], *_SLIP)),
        traction_bound=bound,
        area=_log_range(nodes[..., 3], *_AREA),
        rolling_speed=_log_range(conditions[..., 1], 1e-2, 1e2),
        density=1e3 + 1.9e4 * conditions[..., 2],
    )


def with_totals(
    *,
    pressure: Array,
    traction: Array,
    slip: Array,
    traction_bound: Array,
    area: Array,
    rolling_speed: Array,
    density: Array,
) -> Contact:
    """Return the contact of the given nodes, with one axis of nodes and the sums over it."""
    return Contact(
        pressure=pressure,
        traction=traction,
        slip=slip,
        traction_bound=traction_bound,
        area=area,
        x=np.broadcast_to(np.linspace(-HALF_LENGTH, HALF_LENGTH, area.shape[-1]), area.shape),
        rolling_speed=rolling_speed,
        normal_force=(pressure * area).sum(-1),
        tangential_force=(traction * area).sum(-1),
        wear_index=(traction * slip * area).sum(-1),
        density=density,
    )


def with_totals_of_strips(
    *,
    pressure: Array,
    traction: tuple[Array, Array],
    slip: tuple[Array, Array],
    traction_bound: Array,
    area: Array,
    x: Array,
    y: Array,
    strip_width: Array,
    rolling_speed: Array,
    density: Array,
) -> Contact:
    """Return the contact of the given nodes on strips, with the sums over both axes of nodes."""
    (qx, qy), (sx, sy), nodes = traction, slip, (-2, -1)
    force_x, force_y = (qx * area).sum(nodes), (qy * area).sum(nodes)
    return Contact(
        pressure=pressure,
        traction=np.hypot(qx, qy),
        slip=np.hypot(sx, sy),
        traction_bound=traction_bound,
        area=area,
        x=x,
        y=y,
        strip_width=strip_width,
        traction_x=qx,
        traction_y=qy,
        slip_x=sx,
        slip_y=sy,
        rolling_speed=rolling_speed,
        density=density,
        normal_force=(pressure * area).sum(nodes),
        tangential_force=np.hypot(force_x, force_y),
        force_x=force_x,
        force_y=force_y,
        moment_z=-((x * qy + y * qx) * area).sum(nodes),
        wear_index=((qx * sx + qy * sy) * area).sum(nodes),
    )


def with_problem(contact: Contact, law: Law | None = None) -> Contact:
    """Return the contact with a problem of like size and load, of two bodies of the material to try the law with.

    The bodies are called "body_1" and "body_2", and one of them as the law's `body`.
    """
    area, force = contact.patch_area, contact.normal_force
    a = np.full_like(area, HALF_LENGTH)
    ellipse = contact.on_strips
    material = STEEL if law is None or law.example_material is None else law.example_material
    own = [law.body] if law is not None and law.body else []
    names = [*own, *(name for name in ("body_1", "body_2") if name not in own)][:2]
    problem = Problem(
        geometry="ellipse" if ellipse else "line",
        a=a,
        b=area / (np.pi * a) if ellipse else 0.25 * area / a,
        normal_force=force,
        max_pressure=(1.5 if ellipse else 4.0 / np.pi) * force / area,
        effective_modulus=np.full_like(area, 1.12e11),
        poisson_ratio=np.full_like(area, 0.28),
        friction_coefficient=np.full_like(area, 0.3),
        longitudinal_creepage=contact.mean_slip,
        lateral_creepage=np.zeros_like(area),
        spin=np.zeros_like(area),
        rolling_speed=contact.rolling_speed,
        density=contact.density,
        rolled_distance=np.full_like(area, 1e3),
        bodies={name: Body(material, 0.25) for name in names},
    )
    return contact.replaced(problem=problem)


def random_contacts(
    points: int, nodes: int = 1, seed: int = 0, loaded: bool = False, law: Law | None = None
) -> Contact:
    """Return contacts at many random operating points, reproducible by seed, each with a problem as of `with_problem`.

    With `loaded`, every other one has node values in the upper half of their ranges, those of discs at work: from
    30 MPa, 1e-4 of slip and 0.1 mm².
    """
    random = np.random.default_rng(seed)
    shares, conditions = random.random((points, nodes, NODE_VALUES_DRAWN)), random.random((points, CONDITIONS_DRAWN))
    if loaded:
        shares[::2] = 0.5 + 0.5 * shares[::2]
    return with_problem(contact_from_shares(shares, conditions), law)


def arrays_of(contact: Contact) -> dict[str, Array]:
    """Return the fields and totals of a contact by name."""
    fields = {field.name: getattr(contact, field.name) for field in dataclasses.fields(contact)}
    return {name: value for name, value in fields.items() if value is not None and name != "problem"}


def retotalled(contact: Contact, **changed: Array) -> Contact:
    """Return the contact with some node values changed, and its sums recomputed.

    On strips, a new magnitude of traction or slip keeps the direction of the old one, or lies along x without one.
    """
    values: dict[str, Any] = {name: getattr(contact, name) for name in _VALUES} | changed
    if not contact.on_strips:
        return with_totals(**values).replaced(x=contact.x, problem=contact.problem)
    factors = {name: _ratio(values[name], getattr(contact, name)) for name in ("traction", "slip", "area")}
    for name in ("traction", "slip"):
        old = getattr(contact, name)
        along, across = (getattr(contact, f"{name}_{axis}") * factors[name] for axis in "xy")
        values[name] = np.where(old == 0.0, values[name], along), across
    found = with_totals_of_strips(**values, x=contact.x, y=contact.y, strip_width=contact.strip_width)
    found = found.replaced(problem=contact.problem)
    if not of_means(contact):
        return found
    # The Tγ of means is not the product of their traction and slip.
    factor = factors["traction"] * factors["slip"] * factors["area"]
    return found.replaced(wear_index=contact.wear_index * factor[..., 0, 0])


def _ratio(new: Array, old: Array) -> Array:
    """Return new over old, or one where the old value is zero."""
    factor: Array = np.divide(new, old, out=np.ones_like(old), where=old != 0.0)
    return factor


def of_means(contact: Contact) -> bool:
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
    if variable == "pressure":
        return retotalled(contact, pressure=target.copy(), traction_bound=np.maximum(contact.traction_bound, target))
    if variable == "slip":
        return retotalled(contact, slip=sign * target)
    if variable == "slip_speed":
        return retotalled(contact, slip=sign * target / contact.per_node(contact.rolling_speed))
    if variable == "frictional_power_density":
        return aimed(contact, "wear_index_density", target / contact.per_node(contact.rolling_speed))
    if variable in ("x", "traction_bound"):
        return contact.replaced(**{variable: target.copy()})
    if variable == "wear_index":
        first = target.reshape(*contact.wear_index.shape, -1)[..., 0]
        exact = np.where(contact.wear_index > 0, first, contact.wear_index)
        factor = contact.per_node(_ratio(exact, contact.wear_index))
        return retotalled(contact, area=contact.area * factor).replaced(wear_index=exact)
    if variable == "wear_index_density" and contact.on_strips:
        if of_means(contact):
            index = target[..., 0, 0] * contact.patch_area
            return contact.replaced(wear_index=np.where(contact.wear_index > 0.0, index, contact.wear_index))
        traction = contact.traction * _ratio(target, contact.wear_index_density)
    elif variable == "wear_index_density":
        slip = np.abs(contact.slip)
        traction = np.divide(target, slip, out=np.abs(contact.traction), where=slip > 0)
    else:
        traction = target
    bound = np.maximum(contact.traction_bound, traction)
    return retotalled(contact, traction=sign * traction, traction_bound=bound)


def between(first: Contact, second: Contact, share: Array) -> Contact:
    """Return contacts between two batches, on a straight line in the logarithm of every value.

    Both hold positive values only; `share` has the batch shape.
    """

    def mixed(name: str) -> Array:
        start, end = getattr(first, name), getattr(second, name)
        part = share.reshape(share.shape + (1,) * (start.ndim - share.ndim))
        value: Array = start * (end / start) ** part
        return value

    return with_totals(**{name: mixed(name) for name in _VALUES}).replaced(problem=first.problem)


def e_folds(first: Contact, second: Contact) -> Array:
    """Return the total difference between contacts of one node in e-folds of all values, of the batch shape."""
    total = np.zeros(first.rolling_speed.shape)
    for name in _VALUES:
        if name != "traction_bound":  # which a law has no part in
            total += np.abs(np.log(getattr(second, name) / getattr(first, name))).reshape(total.shape)
    return total


def forward(contact: Contact) -> Contact:
    """Return the contact with positive creepage."""
    return retotalled(contact, traction=np.abs(contact.traction), slip=np.abs(contact.slip))


def rows(contact: Contact, index: object) -> Contact:
    """Return some of the operating points of a batch."""
    return contact[index]


def at_nodes(contact: Contact, variable: str) -> Array:
    """Return the magnitude of a variable at the nodes."""
    magnitude: Array = np.abs(variable_at_nodes(contact, variable))
    return magnitude
