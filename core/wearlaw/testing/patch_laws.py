"""Checks of a law with one value for the whole patch."""

from __future__ import annotations

import numpy as np

from wearlaw.contact.contact import Contact
from wearlaw.models.law import Law, Numbers
from wearlaw.testing.examples import assert_close
from wearlaw.testing.law_checks import STEPS, laws_of_values
from wearlaw.testing.law_contacts import for_each_of_nodes
from wearlaw.testing.sampling import rows


def value_has_the_shape_of_the_batch(law: Law) -> None:
    """There is one value for each patch, with no batch axis, one or two."""

    def examine(contact: Contact) -> None:
        for shape in ((), (1,), (2, 1)):
            batch = contact[0].mapped(lambda array: np.broadcast_to(array, shape + array.shape).copy())  # noqa: B023
            found = np.shape(law.rate(batch, law.numbers))
            assert found == shape, f"values of shape {found} for patches of shape {shape}"

    for_each_of_nodes(law, examine)


def patches_are_independent(law: Law) -> None:
    """One operating point at a time gives the same as all at once."""

    def examine(contact: Contact) -> None:
        together = law.rate(contact, law.numbers)
        for point in range(contact.rolling_speed.size):
            alone = law.rate(rows(contact, [point]), law.numbers)[0]
            assert_close(together[point], alone, f"the value at operating point {point} of a batch")

    for_each_of_nodes(law, examine)


def numbers_may_vary(law: Law) -> None:
    """A number that varies from point to point gives the same value as a law for each number."""
    law = law.explicit()
    of_each = laws_of_values(law)

    def examine(contact: Contact) -> None:
        batch, alone = rows(contact, [0] * len(STEPS)), rows(contact, [0])
        for name, laws in of_each.items():
            p: Numbers = {**law.numbers, name: law.numbers[name] * np.array(STEPS)}
            values = law.rate(batch, p)
            for point, one in laws.items():
                assert_close(values[point], one.rate(alone, one.numbers)[0], f"the value with {name} for each point")

    for_each_of_nodes(law, examine)


CHECKS = (value_has_the_shape_of_the_batch, patches_are_independent, numbers_may_vary)
