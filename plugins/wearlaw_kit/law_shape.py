"""Checks of the rates that a wear law returns for any contact."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TypeVar

import numpy as np

from wearlaw.arrays.array import Array
from wearlaw.contact.contact import Contact
from wearlaw.models.law import Law
from wearlaw_kit.examples import assert_close
from wearlaw_kit.law_contacts import for_each_contact, on_contacts
from wearlaw_kit.sampling import retotalled

T = TypeVar("T")


@on_contacts
def rate_has_the_right_shape(law: Law, contact: Contact) -> None:
    """There is a rate for each node, or one value for each patch, with no batch axis, one or two."""
    for shape in ((), (1,), (2, 1)):
        batch = contact[0].mapped(partial(_repeated, shape))
        found, due = np.shape(law.rate(batch, law.numbers)), of_patch(law, shape, batch.pressure.shape)
        assert found == due, f"rates of shape {found} in place of {due}"


def of_patch(law: Law, patch: T, nodes: T) -> T:
    """Return one of two things: what a law with one value for the patch has, or one with a rate for each node."""
    return patch if law.outcome.of == "patch" else nodes


def _repeated(shape: tuple[int, ...], array: Array) -> Array:
    return np.broadcast_to(array, shape + array.shape).copy()


@on_contacts
def rate_is_finite(law: Law, contact: Contact) -> None:
    """The rate is a finite number at every node, even if pressure, traction or slip is zero."""
    rate = law.rate(contact, law.numbers)
    assert np.isfinite(rate).all(), f"the rate is not finite: {rate!r}"


@on_contacts
def rate_is_never_negative(law: Law, contact: Contact) -> None:
    """Wear takes material away; no rate is below zero, whatever the sign of the creepage."""
    rate = law.rate(contact, law.numbers)
    assert not (rate < 0).any(), f"the rate is negative: {rate!r}"


@on_contacts
def no_slip_no_wear(law: Law, contact: Contact) -> None:
    """Without slip, and hence without dissipation, the rate is exactly zero: at one node or in the whole patch."""
    rate = law.rate(retotalled(contact, slip=np.zeros_like(contact.slip)), law.numbers)
    assert (rate == 0).all(), f"without slip the rate is {rate!r}, not zero"
    rate = law.rate(contact, law.numbers)[contact.slip == 0.0]
    assert (rate == 0).all(), f"where the bodies stick beside nodes that slip, the rate is {rate!r}, not zero"


def direction_of_creepage_does_not_matter(law: Law) -> None:
    """The rate is the same if traction and slip both change sign, turn by a right angle, or are mirrored in x."""
    _compare_turned(law, _reversed, "the rate with the opposite creepage")
    _compare_turned(law, _by_a_right_angle, "the rate with traction and slip turned by a right angle")
    _compare_turned(law, _mirrored, "the rate with mirrored traction and slip")


def _compare_turned(law: Law, turned: Callable[[Contact], Contact], message: str) -> None:
    def examine(contact: Contact) -> None:
        # Not summed anew, so that a wear index at a border of the law stays there.
        assert_close(law.rate(turned(contact), law.numbers), law.rate(contact, law.numbers), message)

    for_each_contact(law, examine)


VECTORS = (("traction_x", "traction_y"), ("slip_x", "slip_y"), ("force_x", "force_y"))
"""The vectors of a contact on strips."""


def _reversed(contact: Contact) -> Contact:
    if contact.on_strips:
        changed = {name: -getattr(contact, name) for pair in VECTORS for name in pair}
        return contact.replaced(**changed, moment_z=-contact.moment_z)
    return contact.replaced(traction=-contact.traction, slip=-contact.slip, tangential_force=-contact.tangential_force)


def _by_a_right_angle(contact: Contact) -> Contact:
    if not contact.on_strips:
        return contact
    pairs = [(x, -getattr(contact, y), y, getattr(contact, x)) for x, y in VECTORS]
    return contact.replaced(**{name: value for x, of_x, y, of_y in pairs for name, value in ((x, of_x), (y, of_y))})


def _mirrored(contact: Contact) -> Contact:
    if not contact.on_strips:
        return contact
    return contact.replaced(**{y: -getattr(contact, y) for _, y in VECTORS}, moment_z=-contact.moment_z)


def vectors_dissipate_their_product(law: Law) -> None:
    """On an ellipse q·s is the product of vectors: slip across the traction adds no wear to a law of the energy.

    A law of the energy is one whose rate on a line stays the same, to the bit, if the traction doubles and the slip is
    halved. Other laws may depend on the slip across the traction.
    """
    if not _is_of_the_energy(law):
        return

    def examine(contact: Contact) -> None:
        if not contact.on_strips:
            return
        straight, across = with_slip_across(contact, 0.0), with_slip_across(contact, 1.0)
        assert_close(
            law.rate(across, law.numbers), law.rate(straight, law.numbers), "the rate with slip across the traction"
        )

    for_each_contact(law, examine)


def _is_of_the_energy(law: Law) -> bool:
    same = []

    def examine(contact: Contact) -> None:
        if not contact.on_strips:
            other = contact.replaced(
                traction=2.0 * contact.traction, slip=0.5 * contact.slip, traction_bound=2.0 * contact.traction_bound
            )
            same.append(np.array_equal(law.rate(contact, law.numbers), law.rate(other, law.numbers)))

    for_each_contact(law, examine)
    return all(same)


def with_slip_across(contact: Contact, share: float) -> Contact:
    """Return a contact with traction along x, and with slip across it of a share of that along it."""
    none = np.zeros_like(contact.slip)
    return contact.replaced(
        traction_x=contact.traction,
        traction_y=none,
        slip_x=contact.slip,
        slip_y=share * contact.slip,
        slip=contact.slip * np.hypot(1.0, share),
    )


OF_ANY_LAW = (rate_has_the_right_shape, rate_is_finite, rate_is_never_negative)
"""Checks of laws of any outcome, also of laws with one value for the patch."""

CHECKS = (
    *OF_ANY_LAW,
    no_slip_no_wear,
    direction_of_creepage_does_not_matter,
    vectors_dissipate_their_product,
)

OF_WEAR = (direction_of_creepage_does_not_matter, vectors_dissipate_their_product)
"""Checks of wear only; other outcomes, such as fatigue, may depend on the direction of the traction."""
