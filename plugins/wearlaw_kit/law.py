"""Checks of a law: its rates, what they depend on, and what it declares."""

from __future__ import annotations

import contextlib
import dataclasses
import itertools
from collections.abc import Iterator, Mapping
from functools import partial
from itertools import filterfalse
from typing import Any, TypeVar

import numpy as np
import pint

from wearlaw.arrays import Array
from wearlaw.contact.contact import Contact
from wearlaw.errors import WearlawError
from wearlaw.models.law import Law, Numbers, WearLaw
from wearlaw.parameters import changed, number_like, numbers
from wearlaw.units.quantities import Quantity
from wearlaw_kit.examples import SAME, assert_close, leeway, left_out
from wearlaw_kit.law_contacts import (
    NODE_FIELDS,
    aimed,
    at_nodes,
    borders,
    for_each_contact,
    forward,
    has_rates_at_nodes,
    on_contacts,
    random_contacts,
    retotalled,
)
from wearlaw_kit.rules import rule

T = TypeVar("T")

STEPS = (1.0, 1.001, 0.999)
"""Factors of a parameter at one operating point after the other; small, since laws refuse parameters out of order."""

SUMS = 1e-9
"""Rounding of a value that a law of the patch sums over its nodes, where the sum may be a small difference. A mean
without areas, or the first node alone, is off by the difference of one of at most 40 nodes from the others."""

GROWN_BY = {"wear_index_density": ("traction", "slip")}
"""Fields of a contact that are raised to raise a variable; others are raised directly."""


def of_patch(law: Law, patch: T, nodes: T) -> T:
    """Return one of two things: what a law with one value for the patch has, or one with a rate for each node."""
    return patch if law.outcome.of == "patch" else nodes


def of_cells(law: Law) -> bool:
    """Return whether a law is one of the nodes of a patch; one of the whole patch has a single node."""
    return bool(law.scale != "patch")


def at_each_node(law: Law) -> bool:
    """Return whether a law has a rate for each node of the patch."""
    return of_cells(law) and has_rates_at_nodes(law)


@on_contacts(Law, always=True)
def rate_has_the_right_shape(law: Law, contact: Contact) -> None:
    """There is a rate for each node, or one value for each patch, with no batch axis, one or two."""
    for shape in ((), (1,), (2, 1)):
        batch = contact[[0]].mapped(partial(_repeated, shape))
        actual, due = np.shape(law.rate(batch, law.numbers)), of_patch(law, shape, batch.pressure.shape)
        assert actual == due, f"rates of shape {actual} in place of {due}"


def _repeated(shape: tuple[int, ...], array: Array) -> Array:
    return np.broadcast_to(array[0], shape + array.shape[1:]).copy()


@on_contacts(Law, always=True)
def rate_is_finite(law: Law, contact: Contact) -> None:
    """The rate is a finite number at every node, even if pressure, traction or slip is zero."""
    rate = law.rate(contact, law.numbers)
    assert np.isfinite(rate).all(), f"the rate is not finite: {rate!r}"


@on_contacts(Law, always=True, applies=lambda law: law.outcome.sign != "any")
def rate_is_never_negative(law: Law, contact: Contact) -> None:
    """Wear takes material away; no rate is below zero, whatever the sign of the creepage."""
    rate = law.rate(contact, law.numbers)
    assert not (rate < 0).any(), f"the rate is negative: {rate!r}"


@on_contacts(Law, applies=lambda law: has_rates_at_nodes(law) and (isinstance(law, WearLaw) or law.zero_in_stick))
def no_slip_no_wear(law: Law, contact: Contact) -> None:
    """Without slip, and hence without dissipation, the rate is exactly zero: at one node or in the whole patch."""
    rate = law.rate(retotalled(contact, slip=np.zeros_like(contact.slip)), law.numbers)
    assert (rate == 0).all(), f"without slip the rate is {rate!r}, not zero"
    rate = law.rate(contact, law.numbers)[contact.slip == 0.0]
    assert (rate == 0).all(), f"where the bodies stick beside nodes that slip, the rate is {rate!r}, not zero"


@on_contacts(WearLaw)
def direction_of_creepage_does_not_matter(law: WearLaw, contact: Contact) -> None:
    """The rate is the same if traction and slip both change sign, turn by a right angle, or are mirrored in x."""
    rate = law.rate(contact, law.numbers)
    for turned in _turned(contact):
        assert_close(law.rate(turned, law.numbers), rate, "the rate with traction and slip in another direction")


def _turned(contact: Contact) -> Iterator[Contact]:
    """Yield the contact with reversed vectors, and on strips with turned and with mirrored ones.

    Its sums are not computed anew, so that a wear index at a border of the law stays there.
    """
    if not contact.on_strips:
        names = ("traction", "slip", "tangential_force")
        yield contact.replaced(**{name: -getattr(contact, name) for name in names})
        return
    for (xx, xy), (yx, yy), moment in (((-1, 0), (0, -1), -1), ((0, -1), (1, 0), 1), ((1, 0), (0, -1), -1)):
        turned = {"moment_z": moment * contact.moment_z}
        for vector in ("traction", "slip", "force"):
            x, y = (getattr(contact, f"{vector}_{axis}") for axis in "xy")
            turned |= {f"{vector}_x": xx * x + xy * y, f"{vector}_y": yx * x + yy * y}
        yield contact.replaced(**turned)


@on_contacts(WearLaw)
def vectors_dissipate_their_product(law: WearLaw, contact: Contact) -> None:
    """On an ellipse q·s is the product of vectors: slip across the traction adds no wear to a law of the energy.

    A law of the energy is one whose rate on a line stays the same, to the bit, if the traction doubles and the slip is
    halved. Other laws may depend on the slip across the traction.
    """
    if contact.on_strips and _is_of_energy(law):
        straight, across = (law.rate(_with_slip_across(contact, share), law.numbers) for share in (0.0, 1.0))
        assert_close(
            across, straight, "the rate with slip across the traction; take q·s from contact.wear_index_density"
        )


def _is_of_energy(law: WearLaw) -> bool:
    contact = random_contacts(256, law=law)
    q, bound, s = 2.0 * contact.traction, 2.0 * contact.traction_bound, 0.5 * contact.slip
    other = contact.replaced(traction=q, traction_bound=bound, slip=s)
    return np.array_equal(law.rate(contact, law.numbers), law.rate(other, law.numbers))


def _with_slip_across(contact: Contact, share: float) -> Contact:
    """Return a contact with traction along x, and with slip across it of a share of that along it."""
    return contact.replaced(
        traction_x=contact.traction,
        traction_y=np.zeros_like(contact.slip),
        slip_x=contact.slip,
        slip_y=share * contact.slip,
        slip=contact.slip * np.hypot(1.0, share),
    )


@rule(Law, applies=lambda law: has_rates_at_nodes(law) and law.follows_pressure_times_slip)
def pressure_times_slip_is_followed(law: Law) -> None:
    """A law that declares it depends on p·s: not on the traction, nor on how p and s share their product.

    A small change of both is tried, so that no border of the law is passed.
    """
    contact = random_contacts(256, law=law)
    rate = law.rate(contact, law.numbers)
    for share in (0.5, 0.9):
        other = law.rate(retotalled(contact, traction=share * contact.traction), law.numbers)
        assert_close(other, rate, f"the rate with {share} times the traction, at the same p·s")
    step = 1.0 + 1e-6
    other = law.rate(retotalled(contact, pressure=contact.pressure * step, slip=contact.slip / step), law.numbers)
    assert_close(other, rate, "the rate with the pressure a little higher and the slip lower, at the same p·s")


@rule(Law)
def numbers_are_fields(law: Law) -> None:
    """`rate`, `breakpoints` and `ramps` read the law's numbers from `p`, and no other number of its class."""
    read: set[str] = set()

    def noted(self: Any, name: str) -> Any:
        read.add(name)
        return object.__getattribute__(self, name)

    watched = type("Watched", (type(law),), {"__getattribute__": noted, "__module__": __name__, "__doc__": ""})
    fields = {name: getattr(law, name) for name in type(law).model_fields}
    copy, contact = watched(**fields), random_contacts(4, law=law)
    rate, declared = copy.rate, (copy.breakpoints, copy.ramps)
    read.clear()
    rate(contact, law.numbers)
    for method in declared:
        method(law.numbers)
    for name in filterfalse(left_out, read - {*type(law).model_fields, *dir(Law)}):
        value = getattr(law, name)
        number = isinstance(value, int | float | pint.Quantity | np.ndarray) and not isinstance(value, bool)
        assert not number, f"a method reads the number `{name}` of the class, which is no field, so no fit can vary it"


@rule(Law)
def parameters_may_vary(law: Law) -> None:
    """A number that varies from point to point gives the same rate, breakpoints and ramps as a law for each value."""
    law = law.explicit()
    for name, number in numbers(law).items():
        if left_out(name):
            continue
        laws = _of_values(law, name, number)
        for axes in of_patch(law, (0,), (1, 2)):
            values = (law.numbers[name] * np.array(STEPS)).reshape(-1, *[1] * axes)
            varying = _borders(law, {**law.numbers, name: values})
            for step, fixed_law in laws.items():
                message = f"the breakpoints and ramps with {name} for each point"
                assert_close(_at(varying, step), _at(_borders(fixed_law, fixed_law.numbers), 0), message)
        for_each_contact(law, partial(_compare_varying, law, name, laws))


def _compare_varying(law: Law, name: str, laws: Mapping[int, Law], contact: Contact) -> None:
    """Compare the rate with a number that goes through `STEPS` from point to point with that of the law of each."""
    steps = np.arange(contact.rolling_speed.size) % len(STEPS)
    values = law.numbers[name] * np.array(STEPS)[steps]
    rate = law.rate(contact, {**law.numbers, name: of_patch(law, values, contact.per_node(values))})
    due = of_patch(law, values.shape, contact.pressure.shape)
    assert np.shape(rate) == due, f"rates of shape {np.shape(rate)} when {name} varies"
    for step, fixed_law in laws.items():
        at = steps == step
        assert_close(rate[at], fixed_law.rate(contact[at], fixed_law.numbers), f"the rate with {name} for each point")


def _of_values(law: Law, name: str, number: Quantity | float) -> dict[int, Law]:
    """Return the laws with a number at each of `STEPS`, by the step, without values that the law does not take."""
    laws = {}
    for point, value in enumerate(law.numbers[name] * np.array(STEPS)):
        with contextlib.suppress(WearlawError):
            laws[point] = changed(law, {name: number_like(number, float(value))})
    return laws


def _borders(law: Law, p: Numbers) -> list[Any]:
    """Return the numbers of breakpoints and of ramps."""
    breakpoints, ramps = law.breakpoints(p) or {}, law.ramps(p) or ()
    return [value for name in sorted(breakpoints) for value in breakpoints[name]] + [n for ramp in ramps for n in ramp]


def _at(values: list[Any], point: int) -> Array:
    """Return numbers at one operating point, of which each is a float or an array with one value for each."""
    flat = [np.ravel(number) for number in values]
    return np.array([each[point if each.size > 1 else 0] for each in flat])


@on_contacts(Law)
def batching_does_not_matter(law: Law, contact: Contact) -> None:
    """One operating point at a time gives the same as all at once."""
    together = law.rate(contact, law.numbers)
    for point in range(contact.rolling_speed.size):
        alone = law.rate(contact[[point]], law.numbers)[0]
        assert_close(together[point], alone, f"the rate at operating point {point} of a batch")


@on_contacts(Law, applies=lambda law: has_rates_at_nodes(law) and not any(name == "x" for name, _ in borders(law)))
def position_does_not_matter(law: Law, contact: Contact) -> None:
    """The rate is the same if the nodes lie elsewhere, and pressure, traction and slip are as before.

    A law that branches at positions `x` is not checked.
    """
    rate = law.rate(contact, law.numbers)
    for message, factor, shift in (("at zero", 0.0, 0.0), ("mirrored", -1.0, 0.0), ("shifted", 1.0, 1e-3)):
        for name in ("x", "y") if contact.on_strips else ("x",):
            moved = contact.replaced(**{name: factor * getattr(contact, name) + shift})
            assert_close(law.rate(moved, law.numbers), rate, f"the rate with {name} {message}")


@on_contacts(Law, several=True, applies=of_cells)
def listing_of_nodes_does_not_matter(law: Law, contact: Contact) -> None:
    """Nodes and strips in another order, and a node or strip in two parts, wear as before.

    So a mean over the nodes has to be weighted by their areas.
    """
    rate = law.rate(contact, law.numbers)
    for axis in (-2, -1) if contact.on_strips else (-1,):
        nodes = np.arange(contact.pressure.shape[axis])
        parts, share = np.array([0, *nodes]), np.array([0.25, 0.75, *np.ones(nodes.size - 1)])
        for order, sizes in ((nodes[::-1], np.ones(nodes.size)), (parts, share)):
            listed = {name: np.take(getattr(contact, name), order, axis=axis) for name in NODE_FIELDS}
            listed["area"] = listed["area"] * sizes.reshape(-1, *[1] * (-1 - axis))
            if contact.on_strips and axis == -1:
                listed["strip_width"] = contact.strip_width[..., order] * sizes
            relisted = law.rate(contact.replaced(**listed), law.numbers)
            due = rate if law.outcome.of == "patch" else np.take(rate, order, axis=axis)
            message = f"the rate with the nodes {order.tolist()} of shares {sizes.tolist()}"
            assert_close(relisted, due, message, of_patch(law, SUMS, SAME))


@on_contacts(Law, several=True, applies=at_each_node)
def each_node_wears_by_itself(law: Law, contact: Contact) -> None:
    """The rate at a node depends on its own values and the totals of the patch, not on its neighbours."""
    rate = law.rate(contact, law.numbers)
    names = [name for name in NODE_FIELDS if name != "area"]
    for node in np.ndindex(rate.shape[contact.rolling_speed.ndim :]):
        at: Any = (..., *(slice(index, index + 1) for index in node))
        alike = {name: np.broadcast_to(getattr(contact, name)[at], rate.shape).copy() for name in names}
        repeated = law.rate(contact.replaced(**alike), law.numbers)[at]
        assert_close(repeated, rate[at], f"the rate at node {node} among others like it")


@on_contacts(Law, several=True, applies=at_each_node)
def strips_wear_as_lines_do(law: Law, contact: Contact) -> None:
    """Nodes on strips wear at the rate of the same nodes on a line, where traction and slip are parallel to x."""
    if not contact.on_strips:
        return
    along = _with_slip_across(contact, 0.0)
    nodes = ("pressure", "traction", "slip", "traction_bound", "area", "x")
    totals = ("rolling_speed", "normal_force", "tangential_force", "wear_index", "density")
    values = {name: getattr(along, name).reshape(contact.rolling_speed.size, -1) for name in nodes}
    line = Contact(**values, **{name: getattr(along, name) for name in totals}, problem=contact.problem)
    rate = law.rate(along, law.numbers).reshape(line.pressure.shape)
    assert_close(rate, law.rate(line, law.numbers), "the rate on strips, against a line")


@rule(Law, applies=has_rates_at_nodes)
def is_monotone_as_declared(law: Law) -> None:
    """The rate never falls when a variable in `monotone_in` grows, from anywhere to anywhere, over all decades.

    The wear-index density grows by the traction and by the slip.
    """
    contact, random = forward(random_contacts(256, law=law)), np.random.default_rng(0)
    near = [aimed(contact, name, value * random.uniform(0.7, 1.1, (256, 1))) for name, value in borders(law)]
    for start in (contact, *near):
        rate = law.rate(start, law.numbers)
        for name in filterfalse(left_out, law.monotone_in):
            for by, factor in itertools.product(GROWN_BY.get(name, (name,)), 1.0 + np.logspace(-6, 2, 17)):
                after = law.rate(_grown(start, by, factor), law.numbers)
                fell = after < rate * (1.0 - max(SAME, leeway()))
                assert not fell.any(), (
                    f"the rate falls from {rate[fell][0]!r} to {after[fell][0]!r} as {name} grows from"
                    f" {at_nodes(start, name)[fell][0]:g} by the share {factor - 1.0:.3g} in {by}"
                )


def _grown(contact: Contact, name: str, factor: float) -> Contact:
    """Return the contact with a variable raised, and with it the wear index if that depends on the variable."""
    if name == "slip_speed":
        return retotalled(contact, rolling_speed=contact.rolling_speed * factor)
    if name == "wear_index":
        return dataclasses.replace(
            contact, wear_index=contact.wear_index * factor, tangential_force=contact.tangential_force * factor
        )
    return aimed(contact, name, at_nodes(contact, name) * factor)


@rule(Law, applies=has_rates_at_nodes)
def declared_names_are_variables(law: Law) -> None:
    """`breakpoints`, `jumps`, `monotone_in` and `valid_range` name variables of a contact, with finite values.

    Every value in `jumps` is a breakpoint too.
    """
    law.check_variables()
    breakpoints, jumps = law.breakpoints(law.numbers) or {}, law.jumps(law.numbers)
    for subject, declared in (("breakpoints", breakpoints), ("jumps", jumps)):
        for name, values in declared.items():
            assert np.isfinite(values).all(), f"`{subject}` has {name} = {values}"
    for name, values in jumps.items():
        missing = {*values} - {*breakpoints.get(name, ())}
        assert not missing, f"`jumps` has {name} = {sorted(missing)}, which `breakpoints` lacks"
    for name, (low, high) in law.valid_range.items():
        assert low < high, f"`valid_range` of {name} goes from {low:g} to {high:g}"


@on_contacts(WearLaw, applies=lambda law: law.band() is not None)
def band_is_ordered(law: WearLaw, contact: Contact) -> None:
    """The law at the low end of published parameters wears no more than at their middle, and that than at the high."""
    low, middle, high = (end.rate(forward(contact), end.numbers) for end in law.band() or ())
    assert (low <= middle).all(), f"the low end {low!r} lies above the middle {middle!r}"
    assert (middle <= high).all(), f"the middle {middle!r} lies above the high end {high!r}"
