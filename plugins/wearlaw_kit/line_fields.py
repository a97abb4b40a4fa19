"""Checks of what a contact model with closed-form fields says of them: crossings of variables, and energy."""

from __future__ import annotations

from typing import get_args

import numpy as np

from wearlaw.arrays.array import Array
from wearlaw.contact.problem import Problem
from wearlaw.contact.quadrature import Nodes
from wearlaw.models.line_contact_model import FieldVariable, LineContactModel
from wearlaw_kit.examples import SAME, SUM, assert_close
from wearlaw_kit.reduced import random_lines
from wearlaw_kit.rules import rule

POINTS = 64
"""Operating points, from almost all stick to full slip."""

SAMPLES = 400
"""Sampled positions in a slip zone; no crossing between them may be missed."""

BISECTIONS = 60
"""Bisections from the width of a panel to rounding."""

PANEL_NODES = 16
"""Gauss-Legendre nodes of a panel. Singularities lie no nearer to a panel than its own length, so that the
error falls as (3 + √8)^-2 for each node, to 3e-25."""


class _SlipZone:
    """A variable in the slip zones of some problems, by distances from the trailing edge."""

    def __init__(self, model: LineContactModel, problem: Problem, variable: str) -> None:
        self.model, self.problem, self.variable = model, problem, variable
        self.length = model.slip_length(problem)[:, None]

    def at(self, distance: Array) -> Array:
        """Return the variable at distances (points, n)."""
        nodes = Nodes(2.0 * self.problem.half_width[:, None] - distance, distance, np.zeros_like(distance))
        fields = self.model.fields(self.problem[..., None], nodes)
        if self.variable == "wear_index_density":
            return np.abs(fields.traction * fields.slip)
        value: Array = np.abs(getattr(fields, self.variable))
        return np.broadcast_to(value, distance.shape)

    def at_angle(self, angle: Array) -> Array:
        """Return the variable where the distance is length · sin²(ψ/2), for ψ (points, n)."""
        return self.at(self.length * np.sin(0.5 * angle) ** 2)


@rule(LineContactModel, applies=lambda model: type(model).crossings is not LineContactModel.crossings)
def crossings_are_where_the_fields_cross(model: LineContactModel) -> None:
    """A variable has the value at each distance in the slip zone that `crossings` returns, and crosses it nowhere else.

    A distance may be off by the rounding of the slip zone's length, a value by its own.
    """
    problem = random_lines(POINTS)
    for variable in get_args(FieldVariable):
        zone = _SlipZone(model, problem, variable)
        distance = zone.length * np.sin(np.linspace(0.0, 0.5 * np.pi, SAMPLES + 2)[1:-1]) ** 2
        samples = zone.at(distance)
        lowest, highest = samples.min(axis=-1), samples.max(axis=-1)
        for share in (1e-3, 0.1, 0.37, 0.5, 0.83, 0.999, 1.1):
            value = lowest + share * (highest - lowest)
            found = model.crossings(problem, variable, value)
            if found is None:
                break
            _compare_crossings(zone, distance, value[:, None], found)


def _compare_crossings(zone: _SlipZone, distance: Array, value: Array, found: Array) -> None:
    """Compare the returned crossings with those between sampled distances."""
    error = SAME * zone.length
    inside = (found > error) & (found < zone.length - error)
    place = np.where(inside, found, 0.5 * zone.length)
    near = np.stack([zone.at(place + side * error) for side in (-1, 0, 1)])
    has_value = (near.min(axis=0) <= value * (1.0 + SAME)) & (near.max(axis=0) >= value * (1.0 - SAME))
    wrong = inside & ~has_value
    assert not wrong.any(), (
        f"`crossings` says that {zone.variable} is {np.broadcast_to(value, wrong.shape)[wrong]} at distances of"
        f" {found[wrong]}, where it is {near[1][wrong]}"
    )
    samples = zone.at(distance)
    clear = np.abs(samples - value) > SAME * value
    changes = ((samples[:, 1:] > value) != (samples[:, :-1] > value)) & clear[:, 1:] & clear[:, :-1]
    low, high = distance[:, :-1, None] - error[..., None], distance[:, 1:, None] + error[..., None]
    known = (inside[:, None, :] & (found[:, None, :] >= low) & (found[:, None, :] <= high)).any(axis=-1)
    missed = changes & ~known
    assert not missed.any(), (
        f"`crossings` misses that {zone.variable} crosses {np.broadcast_to(value, missed.shape)[missed][0]} between"
        f" distances of {distance[:, :-1][missed][0]} and {distance[:, 1:][missed][0]}"
    )


@rule(LineContactModel, applies=lambda model: type(model).excess_dissipation is not LineContactModel.excess_dissipation)
def excess_dissipation_is_that_of_the_fields(model: LineContactModel) -> None:
    """`excess_dissipation` is the integral of max(q·s - threshold, 0) over the slip zone, and never negative."""
    problem = random_lines(POINTS)
    zone = _SlipZone(model, problem, "wear_index_density")
    # Denser towards both ends, where a square root may lie just outside.
    ends = 0.5 * np.pi * np.logspace(-20, 0, 21, base=2.0)
    edges = np.tile(np.unique(np.concatenate([ends, np.pi - ends, np.linspace(0.0, np.pi, 65)])), (POINTS, 1))
    highest, dissipation = zone.at_angle(edges).max(axis=-1), _integral(zone, np.zeros(POINTS), edges)
    for share in (1e-6, 1e-4, 1e-2, 0.1, 0.3, 0.6, 0.9, 0.99, 10.0):
        threshold = share * highest
        found = model.excess_dissipation(problem, threshold)
        if found is None:
            return
        assert (found >= 0).all(), f"the energy above a threshold is negative, {found.min()!r} N/m"
        due = _integral(zone, threshold, edges)
        # Both are differences of sums that are rounded as the whole dissipation is.
        assert_close(found, due, f"the energy above {share:g} of the highest q·s", 0.0, SUM * dissipation)


def _integral(zone: _SlipZone, threshold: Array, edges: Array) -> Array:
    """Return ∫ max(q·s - threshold, 0) dx over the slip zone, by panels that end where q·s crosses the threshold."""
    level = threshold[:, None]
    low, high = edges[:, :-1], edges[:, 1:]
    above, crosses = zone.at_angle(low) > level, (zone.at_angle(low) > level) != (zone.at_angle(high) > level)
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        same = (zone.at_angle(middle) > level) == above
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    edges = np.sort(np.concatenate([edges, np.where(crosses, low, edges[:, :-1])], axis=-1), axis=-1)
    abscissas, weights = np.polynomial.legendre.leggauss(PANEL_NODES)
    half = 0.5 * np.diff(edges)[..., None]
    angle = (0.5 * (edges[:, 1:] + edges[:, :-1])[..., None] + half * abscissas).reshape(len(edges), -1)
    length = (half * weights).reshape(angle.shape) * 0.5 * zone.length * np.sin(angle)
    total: Array = (np.maximum(zone.at_angle(angle) - level, 0.0) * length).sum(axis=-1)
    return total
