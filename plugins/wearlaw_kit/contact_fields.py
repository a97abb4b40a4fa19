"""Checks of closed-form fields on a line: their sums, the slip zone, crossings of variables, and energy."""

from __future__ import annotations

from typing import get_args

import numpy as np

from wearlaw.arrays.array import Array
from wearlaw.contact.contact import Contact
from wearlaw.contact.problem import Problem
from wearlaw.contact.quadrature import Nodes, join
from wearlaw.models.contact_model import QUADRATURE
from wearlaw.models.line_contact_model import FieldVariable, LineContactModel
from wearlaw_kit.examples import SAME, SUM, assert_close
from wearlaw_kit.reduced import friction_limit, random_lines
from wearlaw_kit.shapes import Claims

POINTS = 64
"""Operating points, from almost all stick to full slip."""

SAMPLES = 400
"""Sampled positions in a slip zone; no crossing between them may be missed."""

BISECTIONS = 60
"""Bisections from the distance between samples to rounding."""

PANELS = 64
"""Panels of a zone: on 64 lines, every part of the patch that is longer than a thousandth of it has nodes."""

PANEL_NODES = 16
"""Gauss-Legendre nodes of a panel. Singularities lie no nearer to a panel than its own length, so that the
error falls as (3 + √8)^-2 for each node, to 3e-25."""


def slip_lies_in_the_slip_zone(model: LineContactModel) -> None:
    """The slip zone is at most as long as the patch, and there is no slip in front of it."""
    problem = random_lines(POINTS)
    patch, length = 2.0 * problem.half_width, model.slip_length(problem)
    assert (length >= 0).all(), f"the slip zone has a negative length, {length.min()!r}"
    assert (length <= patch * (1.0 + SAME)).all(), f"the slip zone is {(length / patch).max()!r} times the patch"
    share = np.logspace(-10, 0, 101)
    stick = np.maximum(patch - length, 0.0)[:, None]
    nodes = Nodes(stick * (1.0 - share), length[:, None] + stick * share, np.zeros((POINTS, share.size)))
    in_front = nodes.from_trailing > length[:, None] * (1.0 + SAME)
    slip = np.where(in_front, model.fields(problem[..., None], nodes).slip, 0.0)
    distance, zone = (np.broadcast_to(value, slip.shape)[slip != 0] for value in (nodes.from_trailing, length[:, None]))
    assert (slip == 0).all(), f"slip of {slip[slip != 0]} at {distance} m from the trailing edge, zones of {zone} m"


def fields_sum_to_the_totals(model: LineContactModel) -> None:
    """On many panels of nodes, pressure sums to N and traction to T."""
    problem = random_lines(POINTS)
    contact, error = _on_panels(model, problem), _error_on_panels(model)
    for name, value, due in (
        ("pressure", contact.pressure, problem.normal_force),
        ("traction", contact.traction, contact.tangential_force),
    ):
        size = problem.normal_force if name == "pressure" else friction_limit(problem)
        assert_close(contact.integral(value), due, f"the sum of the {name} on {PANELS} panels", 0.0, error * size)


def fields_dissipate_the_energy_fed_in(model: LineContactModel) -> None:
    """On many panels of nodes, traction times slip sums to ξT."""
    problem = random_lines(POINTS)
    contact = _on_panels(model, problem)
    due = contact.tangential_force * problem.creepage
    # Positions are exact to the rounding of a, so in a short slip zone q·s is that much less exact.
    slipping = np.maximum(contact.slip_area / contact.patch_area, SUM)
    error = _error_on_panels(model) / slipping
    assert_close(contact.cell_wear_index, due, f"the energy dissipated on {PANELS} panels", error)


def _on_panels(model: LineContactModel, problem: Problem) -> Contact:
    stick, slip = (zone.nodes(panels=PANELS) for zone in model.zones(problem))
    return model.at(problem, join(stick.reversed(), slip))


def _error_on_panels(model: LineContactModel) -> float:
    """Return the accuracy that a model declares, or rounding and what is left of the accuracy of one panel.

    A square root just outside a zone, or at its end, adds an error in proportion to the cube of the panel's length.
    """
    return SUM + QUADRATURE / PANELS**3 if model.accuracy == QUADRATURE else model.accuracy


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

    def roots(self, low: Array, high: Array, value: Array) -> Array:
        """Return where the variable crosses values (points, n) between distances at which it lies on both sides."""
        above = self.at(low) > value
        for _ in range(BISECTIONS):
            middle = 0.5 * (low + high)
            same = (self.at(middle) > value) == above
            low, high = np.where(same, middle, low), np.where(same, high, middle)
        return 0.5 * (low + high)


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
    found = np.where(inside, found, np.nan)
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
    known = ((found[:, None, :] >= low) & (found[:, None, :] <= high)).any(axis=-1)
    missed = changes & ~known
    assert not missed.any(), (
        f"`crossings` misses that {zone.variable} crosses {np.broadcast_to(value, missed.shape)[missed][0]} between"
        f" distances of {distance[:, :-1][missed][0]} and {distance[:, 1:][missed][0]}"
    )


def excess_dissipation_is_that_of_the_fields(model: LineContactModel) -> None:
    """`excess_dissipation` is the integral of max(q·s - threshold, 0) over the slip zone, and never negative."""
    problem = random_lines(POINTS)
    zone = _SlipZone(model, problem, "wear_index_density")
    edges = _panel_edges(zone)
    highest = zone.at_angle(edges).max(axis=-1)
    dissipation = _integral(zone, np.zeros(POINTS), edges)
    for share in np.logspace(-6, 1, 22):
        threshold = share * highest
        found = model.excess_dissipation(problem, threshold)
        if found is None:
            return
        assert (found >= 0).all(), f"the energy above a threshold is negative, {found.min()!r} N/m"
        alone = np.array([model.excess_dissipation(problem[i], threshold[i]) for i in range(0, POINTS, 8)])
        assert_close(alone, found[::8], "the energy of a point alone", 0.0, SUM * dissipation[::8])
        due = _integral(zone, threshold, edges)
        # Both are differences of sums that are rounded as the whole dissipation is.
        assert_close(found, due, f"the energy above {share:g} of the highest q·s", 0.0, SUM * dissipation)


def _panel_edges(zone: _SlipZone) -> Array:
    """Return ψ from 0 to π, denser towards both ends, where a square root may lie just outside, and at the maximum.

    Between two of them the variable then passes a level once at most.
    """
    half = 0.5 * np.pi * np.concatenate([[0.0], np.logspace(-20, 0, 21, base=2.0)])
    edges = np.tile(np.concatenate([half, np.pi - half[-2::-1]]), (len(zone.length), 1))
    top = zone.at_angle(edges).argmax(axis=-1).clip(1, edges.shape[-1] - 2)[:, None]
    low, high = (np.take_along_axis(edges, top + side, axis=-1) for side in (-1, 1))
    for _ in range(BISECTIONS):
        left, right = low + (high - low) / 3.0, high - (high - low) / 3.0
        rises = zone.at_angle(left) < zone.at_angle(right)
        low, high = np.where(rises, left, low), np.where(rises, high, right)
    return np.sort(np.concatenate([edges, 0.5 * (low + high)], axis=-1), axis=-1)


def _integral(zone: _SlipZone, threshold: Array, edges: Array) -> Array:
    """Return ∫ max(q·s - threshold, 0) dx over the slip zone, by panels that end where q·s crosses the threshold."""
    level = threshold[:, None]
    low, high = (zone.length * np.sin(0.5 * part) ** 2 for part in (edges[:, :-1], edges[:, 1:]))
    crosses = (zone.at(low) > level) != (zone.at(high) > level)
    root = np.where(crosses, zone.roots(low, high, level), high)
    share = np.divide(root, zone.length, out=np.ones_like(root), where=zone.length > 0)
    splits = 2.0 * np.arcsin(np.sqrt(np.minimum(share, 1.0)))
    abscissas, weights = np.polynomial.legendre.leggauss(PANEL_NODES)
    total = np.zeros(threshold.shape)
    for start, end in ((edges[:, :-1], splits), (splits, edges[:, 1:])):
        half = 0.5 * (end - start)[..., None]
        angle = (0.5 * (end + start)[..., None] + half * abscissas).reshape(len(threshold), -1)
        length = (half * weights).reshape(angle.shape) * 0.5 * zone.length * np.sin(angle)
        over = np.maximum(zone.at_angle(angle) - level, 0.0)
        total += (over * length).sum(axis=-1)
    return total


CHECKS = (
    fields_sum_to_the_totals,
    slip_lies_in_the_slip_zone,
    crossings_are_where_the_fields_cross,
    excess_dissipation_is_that_of_the_fields,
)

CLAIMS: Claims = {"energy_balance": (fields_dissipate_the_energy_fed_in,)}

OF_FIELDS = (*CHECKS, fields_dissipate_the_energy_fed_in)
"""Checks of models with fields at any position."""

OF_CROSSINGS = (crossings_are_where_the_fields_cross,)
"""Checks of models that implement `crossings`."""

OF_EXCESS = (excess_dissipation_is_that_of_the_fields,)
"""Checks of models that implement `excess_dissipation`."""
