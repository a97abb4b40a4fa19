"""Contact models whose nodes are wrong in one way each: their places, areas, pressures and bounds, and their spin.

Each change spoils a right model of each kind: in closed form, on cells of a line, and on the strips of an ellipse.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import Any

import numpy as np

import wearlaw as wl
from tests.plugins.kit.cells import Cells
from tests.plugins.kit.strips import Strips
from tests.plugins.kit.wrong_contacts import Wrapped

Exact: Any = type(wl.contact_model("exact"))

Change = Callable[[wl.Contact, wl.Problem], wl.Contact]


class OwnSlope(Strips):
    """Strips that do not claim Kalker's slopes, so that no check of these finds what else is wrong."""

    @property
    def exemptions(self) -> Any:
        return {"initial_slope": "for the tests"}


def changed(base: Any, change: Change) -> Any:
    """Return the class of a right model with a change of its contacts."""

    def solve_line(self: Any, problem: wl.Problem) -> wl.Contact:
        return change(base.solve_line(self, problem), problem)

    def at(self: Any, problem: wl.Problem, shares: Any = None, widths: Any = None) -> wl.Contact:
        return change(base.at(self, problem, shares, widths), problem)

    methods = {"at": at} if issubclass(base, Strips) else {"solve_line": solve_line}
    name = "".join(word.capitalize() for word in change.__name__.split("_")) + f"Of{base.__name__}"
    return type(name, (base,), {**methods, "__module__": __name__, "__doc__": change.__doc__})


def with_sums(contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
    """Return the contact with the spin moment that its tractions sum to, by the formula of the conventions."""
    if not contact.on_strips:
        return contact
    moment = -(contact.integral(contact.x, contact.traction_y) + contact.integral(contact.y, contact.traction_x))
    forces = dataclasses.replace(contact.forces, spin_moment=moment)
    return contact.replaced(moment_z=moment, wear_index=problem.power(forces), problem=problem)


def along(contact: wl.Contact) -> int:
    """Return the axis of the nodes of a strip."""
    return -2 if contact.on_strips else -1


def x_against_the_conventions(contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
    """x runs from the trailing to the leading edge."""
    return with_sums(contact.replaced(x=-contact.x), problem)


def x_in_the_middle(contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
    """x is zero everywhere."""
    return with_sums(contact.replaced(x=np.zeros_like(contact.x)), problem)


def x_over_half_the_patch(contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
    """x ends half-way to the edges, and the pressure is Hertz's there."""
    return with_sums(contact.replaced(x=0.5 * contact.x), problem)


def order_of_x(contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
    """The positions, with their areas and pressures, are in the order of other nodes than the tractions and slips."""
    moved = {
        name: np.roll(getattr(contact, name), contact.x.shape[along(contact)] // 3, axis=along(contact))
        for name in ("x", "area", "pressure")
    }
    return with_sums(contact.replaced(**moved), problem)


def shuffled_pressure(contact: wl.Contact, _: wl.Problem) -> wl.Contact:
    """The pressures are those of other nodes."""
    third = contact.x.shape[along(contact)] // 3
    return contact.replaced(pressure=np.roll(contact.pressure, third, axis=along(contact)))


def uniform_pressure(contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
    """The pressure is its mean."""
    mean = contact.per_node(problem.normal_force / contact.patch_area)
    return contact.replaced(pressure=np.broadcast_to(mean, contact.x.shape))


def parabolic_pressure(contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
    """The pressure is a parabola with the right load."""
    scale = problem.normal_force / contact.integral(contact.pressure, contact.pressure)
    return contact.replaced(pressure=contact.per_node(scale) * contact.pressure**2)


def bound_in_stick(contact: wl.Contact, _: wl.Problem) -> wl.Contact:
    """Where it sticks, the bound is half as large again."""
    return contact.replaced(traction_bound=np.where(contact.slip == 0.0, 1.5, 1.0) * contact.traction_bound)


ON_NODES: dict[Change, str] = {
    x_against_the_conventions: "stick_lies_before_slip",
    x_in_the_middle: "nodes_lie_where_their_areas_do",
    x_over_half_the_patch: "nodes_lie_where_their_areas_do",
    order_of_x: "stick_lies_before_slip",
    shuffled_pressure: "pressure_is_that_of_the_problem",
    uniform_pressure: "pressure_is_that_of_the_problem",
    parabolic_pressure: "pressure_is_that_of_the_problem",
    bound_in_stick: "bound_sums_to_friction",
}
"""The check that must catch each change, whatever model it spoils."""


def equal_widths(contact: wl.Contact, _: wl.Problem) -> wl.Contact:
    """All strips have the mean width, though not the mean area."""
    mean = contact.strip_width.mean(axis=-1, keepdims=True)
    unequal = np.linspace(0.5, 1.5, contact.strip_width.shape[-1])  # where all strips are equally wide
    return contact.replaced(strip_width=np.broadcast_to(mean * unequal, contact.strip_width.shape))


def twice_the_width(contact: wl.Contact, _: wl.Problem) -> wl.Contact:
    """The strips are twice as wide as their areas."""
    return contact.replaced(strip_width=2.0 * contact.strip_width)


def widths_of_others(contact: wl.Contact, _: wl.Problem) -> wl.Contact:
    """The widths, with the areas, are in the order of other strips."""
    third = contact.strip_width.shape[-1] // 3
    width = np.roll(contact.strip_width * np.linspace(0.9, 1.1, contact.strip_width.shape[-1]), third, axis=-1)
    return contact.replaced(strip_width=width)


ON_STRIPS: dict[Change, str] = {
    equal_widths: "strips_have_their_widths",
    twice_the_width: "strips_have_their_widths",
    widths_of_others: "strips_have_their_widths",
}
"""The check that must catch each change of strips."""


class _OtherSpin(OwnSlope):
    """Base of models that solve the problem with another spin."""

    def spin(self, problem: wl.Problem) -> Any:
        raise NotImplementedError

    def at(self, problem: wl.Problem, shares: Any = None, widths: Any = None) -> wl.Contact:
        creepages = problem.longitudinal_creepage, problem.lateral_creepage
        contact = super().at(problem.with_creepages(*creepages, self.spin(problem)), shares, widths)
        return with_sums(contact, problem)


class SpinBackwards(_OtherSpin):
    """The spin has the opposite sign."""

    def spin(self, problem: wl.Problem) -> Any:
        return -problem.spin


class SlipWithoutSpin(OwnSlope):
    """The tractions know of the spin, and the slips do not."""

    def at(self, problem: wl.Problem, shares: Any = None, widths: Any = None) -> wl.Contact:
        still = problem.with_creepages(problem.longitudinal_creepage, problem.lateral_creepage, 0.0 * problem.spin)
        contact, straight = (super(SlipWithoutSpin, self).at(given, shares, widths) for given in (problem, still))
        return contact.replaced(slip=straight.slip, slip_x=straight.slip_x, slip_y=straight.slip_y)


class _Band(Exact):  # type: ignore[misc]
    """Base of closed forms that are off by 0.1 % in a band of a four-hundredth of the patch."""

    def band(self, problem: wl.Problem, nodes: wl.Nodes) -> Any:
        return np.where(np.abs(nodes.x / problem.half_width - 0.3) < 0.0025, 1.001, 1.0)

    def excess_dissipation(self, problem: wl.Problem, threshold: Any) -> Any:
        return None


class TractionInABand(_Band):
    """The traction is too large by 0.1 % in a narrow band."""

    def fields(self, problem: wl.Problem, nodes: wl.Nodes) -> wl.LineFields:
        fields: wl.LineFields = super().fields(problem, nodes)
        return dataclasses.replace(fields, traction=self.band(problem, nodes) * fields.traction)


def slip_and_traction(contact: wl.Contact, _: wl.Problem) -> wl.Contact:
    """The slip is too large by a fifth and the traction too small by a tenth, within the accuracy that it declares."""
    more = {name: 1.2 * getattr(contact, name) for name in ("slip", "slip_x", "slip_y")}
    less = {name: 0.9 * getattr(contact, name) for name in ("traction", "traction_x", "traction_y")}
    return contact.replaced(**more, **less)


class Coarse(changed(Cells, slip_and_traction)):  # type: ignore[misc]
    """Hides its errors in an accuracy of 30 %."""

    @property
    def accuracy(self) -> float:
        return 0.3


class CoarseOnStrips(changed(OwnSlope, slip_and_traction)):  # type: ignore[misc]
    """Hides its errors in an accuracy of 30 %."""

    @property
    def elliptic_accuracy(self) -> float:
        return 0.3


CAUGHT: dict[Any, str] = {
    **{changed(base, change): check for change, check in ON_NODES.items() for base in (Wrapped, Cells, OwnSlope)},
    **{changed(OwnSlope, change): check for change, check in ON_STRIPS.items()},
    SpinBackwards: "spin_has_its_force_and_moment",
    SlipWithoutSpin: "slip_turns_with_the_spin",
    TractionInABand: "tractions_sum_to_the_forces",
    Coarse: "declared_accuracy_is_not_coarse",
    CoarseOnStrips: "declared_accuracy_is_not_coarse",
}
"""The check that must catch each."""

ON_GIVEN_STRIPS = {"strips_have_their_widths", "spin_has_its_force_and_moment", "slip_turns_with_the_spin"}
"""Checks on which models of given strips are tried too, beside those of every shape."""
