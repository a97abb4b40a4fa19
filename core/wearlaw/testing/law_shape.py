"""Checks of the rates that a wear law returns for any contact."""

from __future__ import annotations

import copy
from collections.abc import Callable
from functools import partial

import numpy as np

from wearlaw.arrays.array import Array
from wearlaw.contact.contact import Contact
from wearlaw.models.law import Law
from wearlaw.testing.examples import assert_close
from wearlaw.testing.law_contacts import for_each_contact
from wearlaw.testing.sampling import arrays_of, retotalled


def rate_has_the_shape_of_the_nodes(law: Law) -> None:
    """There is a rate for each node, on one axis of nodes or two, with no batch axis, one or two."""

    def examine(contact: Contact) -> None:
        for shape in ((), (1,), (2, 1)):
            batch = contact[0].mapped(partial(_repeated, shape))
            found, due = np.shape(law.rate(batch, law.numbers)), batch.pressure.shape
            assert found == due, f"rates of shape {found} for nodes of shape {due}"

    for_each_contact(law, examine)


def _repeated(shape: tuple[int, ...], array: Array) -> Array:
    return np.broadcast_to(array, shape + array.shape).copy()


def runtime_takes_the_rate(law: Law) -> None:
    """`WearLaw.checked_rate`, through which every prediction calls the law, takes its rate."""

    def examine(contact: Contact) -> None:
        law.check_not_negative(law.checked_rate(contact))

    for_each_contact(law, examine)


def rate_is_finite(law: Law) -> None:
    """The rate is a finite number at every node, even if pressure, traction or slip is zero."""

    def examine(contact: Contact) -> None:
        rate = law.rate(contact, law.numbers)
        assert np.isfinite(rate).all(), f"the rate is not finite: {rate!r}"

    for_each_contact(law, examine)


def rate_is_never_negative(law: Law) -> None:
    """Wear takes material away; no rate is below zero, whatever the sign of the creepage."""

    def examine(contact: Contact) -> None:
        rate = law.rate(contact, law.numbers)
        assert not (rate < 0).any(), f"the rate is negative: {rate!r}"

    for_each_contact(law, examine)


def no_slip_no_wear(law: Law) -> None:
    """Without slip, and hence without dissipation, the rate is exactly zero: at one node or in the whole patch."""

    def examine(contact: Contact) -> None:
        rate = law.rate(retotalled(contact, slip=np.zeros_like(contact.slip)), law.numbers)
        assert (rate == 0).all(), f"without slip the rate is {rate!r}, not zero"
        rate = law.rate(contact, law.numbers)[contact.slip == 0.0]
        assert (rate == 0).all(), f"where the bodies stick beside nodes that slip, the rate is {rate!r}, not zero"

    for_each_contact(law, examine)


def sign_of_creepage_does_not_matter(law: Law) -> None:
    """The rate is the same if traction and slip both change sign."""
    _compare_turned(law, _reversed, "the rate with the opposite creepage")


def direction_of_creepage_does_not_matter(law: Law) -> None:
    """On an ellipse the rate is the same if traction and slip turn together by a right angle, or are mirrored in x."""
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


def memory_layout_does_not_matter(law: Law) -> None:
    """The rate is the same for arrays in Fortran order, with strides, or read-only."""

    def examine(contact: Contact) -> None:
        rate = law.rate(contact, law.numbers)
        for message, layout in LAYOUTS.items():
            assert_close(law.rate(contact.mapped(layout), law.numbers), rate, f"the rate for {message} arrays")

    for_each_contact(law, examine)


def _strided(array: Array) -> Array:
    spaced = np.full((*array.shape, 2), np.nan)
    spaced[..., 0] = array
    return spaced[..., 0]


def _read_only(array: Array) -> Array:
    array = array.copy()
    array.flags.writeable = False
    return array


LAYOUTS: dict[str, Callable[[Array], Array]] = {
    "Fortran-ordered": np.asfortranarray,
    "strided": _strided,
    "read-only": _read_only,
}


def integer_input_does_not_matter(law: Law) -> None:
    """The rate is the same for whole numbers given as integers."""

    def examine(contact: Contact) -> None:
        whole = retotalled(
            contact,
            pressure=np.rint(contact.pressure),
            traction=np.rint(contact.traction),
            slip=np.sign(contact.slip),
            rolling_speed=np.ceil(contact.rolling_speed),
            density=np.rint(contact.density),
        )
        names = ["pressure", "traction", "slip", "rolling_speed", "density"]
        if contact.on_strips:  # with vectors along x, so that their components are whole too
            magnitudes = {name: np.rint(getattr(whole, name)) for name in ("traction", "slip")}
            whole = with_slip_across(whole.replaced(**magnitudes), 0.0)
            names += ["traction_x", "traction_y", "slip_x", "slip_y"]
        integers = {name: getattr(whole, name).astype(np.int64) for name in names}
        rate = law.rate(whole.replaced(**integers), law.numbers)
        assert_close(rate, law.rate(whole, law.numbers), "the rate for integers")

    for_each_contact(law, examine)


def inputs_are_not_changed(law: Law) -> None:
    """The law leaves the arrays of the contact and its numbers as they are."""

    def examine(contact: Contact) -> None:
        before, numbers = copy.deepcopy(contact), dict(law.numbers)
        law.rate(contact, law.numbers)
        for name, values in arrays_of(contact).items():
            assert np.array_equal(values, getattr(before, name)), f"the law changed the {name} of the contact"
        assert law.numbers == numbers, "the law changed its numbers, p"

    for_each_contact(law, examine)


CALLS = 64
"""Calls between two for the same contact."""


def calls_agree_to_the_bit(law: Law) -> None:
    """The same contact gives the same rates again, whatever was computed in between, in an array of its own.

    A law of the same numbers that has computed nothing before, or something else, gives these rates too.
    """
    seen: list[Contact] = []

    def examine(contact: Contact) -> None:
        new, used = law.model_copy(), law.model_copy()
        first = new.rate(contact, law.numbers)
        kept = np.array(first)
        half = retotalled(contact, slip=0.5 * contact.slip)
        for other in (*seen[-3:], half):
            new.rate(other, law.numbers)
            used.rate(other, law.numbers)
        assert np.array_equal(kept, first), "a later call changed the array that an earlier one returned"
        for one in (new, used):
            again = one.rate(contact, law.numbers)
            assert np.array_equal(kept, again), f"two calls differ: {kept!r} and {again!r}"
        for _ in range(CALLS):
            again = used.rate(contact, law.numbers)
        assert np.array_equal(kept, again), f"after {CALLS} more calls, two calls differ: {kept!r} and {again!r}"
        seen.append(contact)

    for_each_contact(law, examine)


OF_ANY_LAW = (
    runtime_takes_the_rate,
    rate_is_finite,
    rate_is_never_negative,
    memory_layout_does_not_matter,
    integer_input_does_not_matter,
    inputs_are_not_changed,
    calls_agree_to_the_bit,
)
"""Checks of laws of any outcome, also of laws with one value for the patch."""

OF_WEAR = (
    sign_of_creepage_does_not_matter,
    direction_of_creepage_does_not_matter,
    vectors_dissipate_their_product,
)
"""Checks of wear only; other outcomes, such as fatigue, may depend on the direction of the traction."""

CHECKS = (
    rate_has_the_shape_of_the_nodes,
    *OF_ANY_LAW[:3],
    no_slip_no_wear,
    *OF_WEAR,
    *OF_ANY_LAW[3:],
)
