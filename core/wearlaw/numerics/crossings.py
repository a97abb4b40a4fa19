"""Find the points in the slip zone where a variable of the contact crosses a wear law's breakpoints."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, TypeAlias, cast

import numpy as np
from numpy.typing import NDArray

from wearlaw.arrays import Array
from wearlaw.contact.contact import Contact
from wearlaw.contact.problem import Problem
from wearlaw.contact.quadrature import Nodes, Zone
from wearlaw.errors import ModelError
from wearlaw.models.contact_model import FieldVariable, LineContactModel
from wearlaw.models.law import NODE_VARIABLES
from wearlaw.models.model import with_origin

SAMPLES = 32
"""Number of equal intervals of ψ that are searched for a crossing."""

END_SAMPLES = 5
"""Number of further cuts of the first and the last interval, each to a quarter next to the end.

A variable is even in ψ about an end, so a maximum close to the end would hide in an equal interval.
"""

PER_SPEED = {"slip_speed": "slip", "frictional_power_density": "wear_index_density"}
"""Variables that are another one times the rolling speed."""

VariableOf: TypeAlias = Callable[[Contact, str], Array]
"""Returns a variable of a contact by its name."""

CROSSINGS = 2
"""Largest number of crossings of a breakpoint, since the variables of a line contact rise, or rise and fall, in x."""

END_GAP = 3e-7
"""Share of the range of ψ between the outermost samples and the ends, where slip may grow without bound.

The part of the zone beyond the outermost samples is 2.5e-13.
"""


_EQUAL = np.linspace(END_GAP, 1.0 - END_GAP, SAMPLES + 1)
_NEAR_END = (_EQUAL[1] - _EQUAL[0]) * 0.25 ** np.arange(1, END_SAMPLES + 1)

SHARES: Array = np.sort(np.concatenate([_EQUAL, _EQUAL[0] + _NEAR_END, _EQUAL[-1] - _NEAR_END]))
"""The samples, as shares of the range of ψ."""


def crossings(
    model: LineContactModel,
    problem: Problem,
    zone: Zone,
    breakpoints: Mapping[str, tuple[Any, ...]],
    variable: VariableOf = getattr,
) -> Array:
    """Return the values of ψ in the slip zone at which variables cross their breakpoints, (batch, k), ascending.

    They are exact to rounding, and the zone's angle where there is no crossing; k is at most 2 × the number of
    breakpoints. The problem has a batch of at most one axis and creepage ≥ 0. Breakpoints are SI values by the names of
    variables at the nodes, each a float or one for each operating point, (points, 1).
    """
    shape = problem.batch_shape
    distances, columns = [np.empty((*shape, 0))], []
    for name, values in breakpoints.items():
        searched = None
        for value in values:
            level: Any = np.full(shape, value[:, 0] if np.ndim(value) else value) if shape else np.float64(value)
            distance = None
            if name in NODE_VARIABLES:
                per_speed = name in PER_SPEED
                field = cast(FieldVariable, PER_SPEED.get(name, name))
                distance = model.crossings(problem, field, level / problem.rolling_speed if per_speed else level)
            if distance is not None:
                distances.append(distance)
                continue
            searched = searched or _Variable(model, problem, zone, name, variable)
            share = _searched(searched, level.reshape(-1, 1)).reshape(*shape, CROSSINGS)
            columns.append(zone.angle[..., None] * share)
    columns.append(zone.angle_of(np.concatenate(distances, axis=-1)))
    return np.sort(np.concatenate(columns, axis=-1) if len(columns) > 1 else columns[0], axis=-1)


class _Variable:
    """The magnitude of one variable of the contact as a function of ψ/Ψ, sampled over the slip zone."""

    def __init__(self, model: LineContactModel, problem: Problem, zone: Zone, name: str, variable: VariableOf) -> None:
        self.model, self.name, self.variable = model, name, variable
        self.problem, self.zone = problem.flatten(), zone.flatten()
        points = np.arange(problem.creepage.size)
        self.samples = self._values(np.broadcast_to(SHARES, (points.size, SHARES.size)), points)

    def at(self, share: Array, point: Array) -> Array:
        """Return the variable at one share of Ψ for each of the operating points `point`, both of shape (m,)."""
        return self._values(share[:, None], point.astype(np.intp))[:, 0]

    def _values(self, share: Array, point: NDArray[np.intp]) -> Array:
        half_angle = 0.5 * self.zone.angle[point][:, None] * share
        span, patch = self.zone.span[point][:, None], self.zone.patch[point][:, None]
        nodes = Nodes(
            (patch - span) + span * np.cos(half_angle) ** 2, span * np.sin(half_angle) ** 2, np.ones_like(half_angle)
        )
        contact = self.model.at(self.problem[point], nodes)
        value: Array = np.abs(self.variable(contact, self.name))
        return value


def _elementwise() -> Any:
    """Return scipy's search for roots and minima of many functions at once; loading it takes long."""
    from scipy.optimize import elementwise

    return elementwise


def _searched(variable: _Variable, value: Array) -> Array:
    """Return the crossings of a breakpoint (points, 1), as shares of Ψ (points, CROSSINGS); 1 for no crossing."""
    share, samples = np.broadcast_to(SHARES, variable.samples.shape), variable.samples
    point, top = _hidden_humps(samples, value[:, 0])
    if point.size:
        peak = _elementwise().find_minimum(
            lambda where, who: -variable.at(where, who),
            tuple(SHARES[top + step] for step in (-1, 0, 1)),
            args=(point.astype(np.float64),),
        )
        share, samples = share.copy(), samples.copy()
        share[point, top], samples[point, top] = peak.x, -peak.f_x
    above = samples >= value
    changes = above[:, 1:] != above[:, :-1]
    order = changes.cumsum(axis=-1)
    point, interval = np.nonzero(changes & (order <= CROSSINGS))
    shares = np.ones((samples.shape[0], CROSSINGS))
    if point.size:
        root = _elementwise().find_root(
            lambda where, who: variable.at(where, who) - value[who.astype(np.intp), 0],
            (share[point, interval], share[point, interval + 1]),
            args=(point.astype(np.float64),),
        )
        if not root.success.all():
            message = (
                f"contact model '{variable.model.name}': its {variable.name} crosses a breakpoint, but the crossing"
                " cannot be found; it must be finite in the whole slip zone, and the same at each call"
            )
            raise ModelError(with_origin(variable.model, message))
        shares[point, order[point, interval] - 1] = root.x
    return shares


def _hidden_humps(samples: Array, level: Array) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return the operating points where a maximum between samples may reach the level, and the highest sample there."""
    top = samples.argmax(axis=-1).clip(1, samples.shape[-1] - 2)
    points = np.arange(samples.shape[0])
    left, middle, right = (samples[points, top + step] for step in (-1, 0, 1))
    # Neighbouring intervals differ by a factor of at most four. The top of a smooth hump then lies above its highest
    # sample by less than four times the difference between that sample and its lower neighbour.
    may_reach = (middle < level) & (level < middle + 4.0 * (middle - np.minimum(left, right)))
    point = points[may_reach & (middle >= np.maximum(left, right))]
    return point, top[point]
