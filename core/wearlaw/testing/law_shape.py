"""Checks of the rates that a wear law returns for any contact."""

from __future__ import annotations

import copy
import dataclasses
from collections.abc import Callable
from functools import cache, partial

import numpy as np
from hypothesis import strategies as st

from wearlaw.arrays.array import Array
from wearlaw.contact.contact import Contact
from wearlaw.models.wear_law import WearLaw
from wearlaw.testing.examples import assert_close, for_each
from wearlaw.testing.sampling import retotalled
from wearlaw.testing.strategies import contacts


def contacts_for(law: WearLaw) -> st.SearchStrategy[Contact]:
    """Return contacts of the scale of a law, which crowd at its breakpoints."""
    crowded = ((name, tuple(values)) for name, values in (law.breakpoints(law.numbers) or {}).items())
    return _contacts(1 if law.scale == "patch" else 5, tuple(crowded))


@cache  # draws once for each law
def _contacts(most_nodes: int, crowded: tuple[tuple[str, tuple[float, ...]], ...]) -> st.SearchStrategy[Contact]:
    return contacts(nodes=st.integers(1, most_nodes), crowded=dict(crowded))


def rate_has_the_shape_of_the_nodes(law: WearLaw) -> None:
    """There is a rate for each node, also for one operating point without a batch axis and for two batch axes."""

    def examine(contact: Contact) -> None:
        for shape in ((), (1,), (2, 1)):
            batch = contact[0].mapped(partial(_repeated, shape))
            found, due = np.shape(law.rate(batch, law.numbers)), batch.pressure.shape
            assert found == due, f"rates of shape {found} for nodes of shape {due}"

    for_each(contacts_for(law), examine)


def _repeated(shape: tuple[int, ...], array: Array) -> Array:
    return np.broadcast_to(array, shape + array.shape).copy()


def rate_is_finite(law: WearLaw) -> None:
    """The rate is a finite number at every node, even if pressure, traction or slip is zero."""

    def examine(contact: Contact) -> None:
        rate = law.rate(contact, law.numbers)
        assert np.isfinite(rate).all(), f"the rate is not finite: {rate!r}"

    for_each(contacts_for(law), examine)


def rate_is_never_negative(law: WearLaw) -> None:
    """Wear takes material away; no rate is below zero, whatever the sign of the creepage."""

    def examine(contact: Contact) -> None:
        rate = law.rate(contact, law.numbers)
        assert not (rate < 0).any(), f"the rate is negative: {rate!r}"

    for_each(contacts_for(law), examine)


def no_slip_no_wear(law: WearLaw) -> None:
    """Without slip, and hence without dissipation, the rate is exactly zero."""

    def examine(contact: Contact) -> None:
        rate = law.rate(retotalled(contact, slip=np.zeros_like(contact.slip)), law.numbers)
        assert (rate == 0).all(), f"without slip the rate is {rate!r}, not zero"

    for_each(contacts_for(law), examine)


def sign_of_creepage_does_not_matter(law: WearLaw) -> None:
    """The rate is the same if traction and slip both change sign."""

    def examine(contact: Contact) -> None:
        # Not summed anew, so that a wear index at a border of the law stays there.
        mirrored = dataclasses.replace(
            contact,
            traction=-contact.traction,
            slip=-contact.slip,
            tangential_force=-contact.tangential_force,
        )
        assert_close(
            law.rate(mirrored, law.numbers), law.rate(contact, law.numbers), "the rate with the opposite creepage"
        )

    for_each(contacts_for(law), examine)


def memory_layout_does_not_matter(law: WearLaw) -> None:
    """The rate is the same for arrays in Fortran order, with strides, or read-only."""

    def examine(contact: Contact) -> None:
        rate = law.rate(contact, law.numbers)
        for message, layout in LAYOUTS.items():
            assert_close(law.rate(contact.mapped(layout), law.numbers), rate, f"the rate for {message} arrays")

    for_each(contacts_for(law), examine)


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


def integer_input_does_not_matter(law: WearLaw) -> None:
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
        names = ("pressure", "traction", "slip", "rolling_speed", "density")
        integers = {name: getattr(whole, name).astype(np.int64) for name in names}
        rate = law.rate(dataclasses.replace(whole, **integers), law.numbers)
        assert_close(rate, law.rate(whole, law.numbers), "the rate for integers")

    for_each(contacts_for(law), examine)


def inputs_are_not_changed(law: WearLaw) -> None:
    """The law leaves the arrays of the contact and its numbers as they are."""

    def examine(contact: Contact) -> None:
        before, numbers = copy.deepcopy(contact), dict(law.numbers)
        law.rate(contact, law.numbers)
        for field in dataclasses.fields(contact):
            same = np.array_equal(getattr(contact, field.name), getattr(before, field.name))
            assert same, f"the law changed the {field.name} of the contact"
        assert law.numbers == numbers, "the law changed its numbers, p"

    for_each(contacts_for(law), examine)


@cache
def _pairs(strategy: st.SearchStrategy[Contact]) -> st.SearchStrategy[tuple[Contact, Contact]]:
    return st.tuples(strategy, strategy)


def calls_agree_to_the_bit(law: WearLaw) -> None:
    """The same contact gives the same rates again, with another contact in between, in an array of its own."""

    def examine(pair: tuple[Contact, Contact]) -> None:
        first = law.rate(pair[0], law.numbers)
        kept = np.array(first)
        law.rate(pair[1], law.numbers)
        law.rate(retotalled(pair[0], slip=0.5 * pair[0].slip), law.numbers)
        assert np.array_equal(kept, first), "a later call changed the array that an earlier one returned"
        second = law.rate(pair[0], law.numbers)
        assert np.array_equal(kept, second), f"two calls differ: {kept!r} and {second!r}"

    for_each(_pairs(contacts_for(law)), examine)


CHECKS = (
    rate_has_the_shape_of_the_nodes,
    rate_is_finite,
    rate_is_never_negative,
    no_slip_no_wear,
    sign_of_creepage_does_not_matter,
    memory_layout_does_not_matter,
    integer_input_does_not_matter,
    inputs_are_not_changed,
    calls_agree_to_the_bit,
)
