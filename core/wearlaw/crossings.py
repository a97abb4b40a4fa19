"""Where in the slip zone a variable of the contact crosses a wear law's breakpoints."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from wearlaw.arrays import Array
from wearlaw.line import LineProblem
from wearlaw.models import LineContactModel
from wearlaw.quadrature import Nodes, position

SAMPLES = 32
"""Equal intervals of θ that are searched for a crossing."""

END_SAMPLES = 5
"""How often the first and the last of them are cut again, each time to a quarter next to the end.

A variable is even in θ about an end, so that a maximum close to it would hide in an equal interval.
"""

CROSSINGS = 2
"""Crossings found for each breakpoint; the variables of a line contact rise, or rise and fall, in x."""

END_GAP = 1e-6
"""Distance in θ of the outermost samples from the ends, where a slip may grow without bound.

What lies beyond them is 2.5e-13 of the zone.
"""


def crossings(
    model: LineContactModel,
    problem: LineProblem,
    zone: tuple[Array, Array],
    breakpoints: Mapping[str, tuple[float, ...]],
) -> Array:
    """Return the θ in [-π/2, π/2] at which variables cross their breakpoints.

    Parameters
    ----------
    model : LineContactModel
        The contact model.
    problem : LineProblem
        With a batch of one axis, (points,).
    zone : tuple of ndarray, (points,)
        Start and end of the slip zone [m].
    breakpoints : mapping of str to tuple of float
        Names of node variables of `Contact` with SI values.

    Returns
    -------
    ndarray, (points, 2 × number of breakpoints)
        θ of each crossing, as exact as rounding lets it be; π/2 where there is none.
    """
    columns = [
        _crossings_of(_Variable(model, problem, zone, name), value)
        for name, values in breakpoints.items()
        for value in values
    ]
    points = problem.creepage.size
    return np.concatenate([np.empty((points, 0)), *columns], axis=-1)


class _Variable:
    """The magnitude of one variable of the contact as a function of θ, sampled over the slip zone."""

    def __init__(self, model: LineContactModel, problem: LineProblem, zone: tuple[Array, Array], name: str) -> None:
        self.model, self.problem, self.zone, self.name = model, problem, zone, name
        self.theta = _sample_angles()
        points = np.arange(problem.creepage.size)
        self.samples = self._values(np.broadcast_to(self.theta, (points.size, self.theta.size)), points)

    def at(self, theta: Array, point: Array) -> Array:
        """Return the variable at one θ for each of the operating points `point`, both of shape (m,)."""
        return self._values(theta[:, None], point.astype(np.intp))[:, 0]

    def _values(self, theta: Array, point: NDArray[np.intp]) -> Array:
        x = position(self.zone[0][point], self.zone[1][point], theta)
        contact = self.model.at(self.problem[point], Nodes(x, np.ones_like(x)))
        value: Array = np.abs(getattr(contact, self.name))
        return value


def _sample_angles() -> Array:
    last = 0.5 * np.pi - END_GAP
    equal = np.linspace(-last, last, SAMPLES + 1)
    near_end = last - (equal[1] - equal[0]) * 0.25 ** np.arange(1, END_SAMPLES + 1)
    return np.sort(np.concatenate([equal, near_end, -near_end]))


def _crossings_of(variable: _Variable, value: float) -> Array:
    """Return the crossings of one breakpoint, of shape (points, CROSSINGS)."""
    found = np.full((variable.samples.shape[0], CROSSINGS), 0.5 * np.pi)
    for point, column, low, high in (_sign_changes(variable, value), _hidden_humps(variable, value)):
        if point.size:
            from scipy.optimize import elementwise  # half of the time of `import wearlaw`, so only where it is used

            root = elementwise.find_root(
                lambda theta, who: variable.at(theta, who) - value,
                (low, high),
                args=(point.astype(np.float64),),
            )
            found[point, column] = root.x
    return found


Brackets: TypeAlias = tuple[NDArray[np.intp], NDArray[np.intp], Array, Array]
"""Operating points, columns of the result, and the θ between which a crossing lies; each of shape (m,)."""


def _sign_changes(variable: _Variable, value: float) -> Brackets:
    above = variable.samples >= value
    changes = above[:, 1:] != above[:, :-1]
    order = changes.cumsum(axis=-1)
    point, interval = np.nonzero(changes & (order <= CROSSINGS))
    return point, order[point, interval] - 1, variable.theta[interval], variable.theta[interval + 1]


def _hidden_humps(variable: _Variable, value: float) -> Brackets:
    """Return the brackets of crossings on both sides of a maximum that lies between two samples."""
    theta, samples = variable.theta, variable.samples
    top = samples.argmax(axis=-1).clip(1, theta.size - 2)
    points = np.arange(samples.shape[0])
    left, middle, right = (samples[points, top + step] for step in (-1, 0, 1))
    # A smooth hump exceeds its highest sample by less than four times what that one exceeds its lower neighbour by,
    # for intervals of which one is no more than four times the next.
    may_reach = (middle < value) & (value < middle + 4.0 * (middle - np.minimum(left, right)))
    point = points[may_reach & (middle >= np.maximum(left, right))]
    low, high = theta[top[point] - 1], theta[top[point] + 1]
    if point.size:
        from scipy.optimize import elementwise

        peak = elementwise.find_minimum(
            lambda angle, who: -variable.at(angle, who),
            (low, theta[top[point]], high),
            args=(point.astype(np.float64),),
        )
        reaches = -peak.f_x > value
        point, low, high, crest = point[reaches], low[reaches], high[reaches], peak.x[reaches]
    else:
        crest = low
    return (
        np.concatenate([point, point]),
        np.repeat(np.arange(CROSSINGS), point.size),
        np.concatenate([low, crest]),
        np.concatenate([crest, high]),
    )
