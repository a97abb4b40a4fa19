"""Checks of a model's description of itself: documentation, units, schema, names."""

from __future__ import annotations

import numpy as np

from wearlaw.contact.contact import LAW_VARIABLES, PATCH_VARIABLES, Contact
from wearlaw.models.law import Law
from wearlaw_kit.law_contacts import for_each_contact
from wearlaw_kit.sampling import forward


def declared_names_are_variables(law: Law) -> None:
    """`breakpoints`, `jumps`, `monotone_in` and `valid_range` name variables of a contact, with finite values."""
    declared = {
        "breakpoints": law.breakpoints(law.numbers) or {},
        "jumps": law.jumps(law.numbers),
        "valid_range": law.valid_range,
    }
    for subject, variables in declared.items():
        for name, values in variables.items():
            known = PATCH_VARIABLES if subject == "valid_range" else (*LAW_VARIABLES, *law.own_variables)
            assert name in known, f"`{subject}` names '{name}'; the variables are: {', '.join(known)}"
            bad = np.isnan(values).any() or (subject != "valid_range" and not np.isfinite(values).all())
            assert not bad, f"`{subject}` has {name} = {values}"
    for name, (low, high) in law.valid_range.items():
        assert low < high, f"`valid_range` of {name} goes from {low:g} to {high:g}"
    for name in law.monotone_in:
        assert name in LAW_VARIABLES, f"`monotone_in` names '{name}'; the variables are: {', '.join(LAW_VARIABLES)}"


def band_is_ordered(law: Law) -> None:
    """The law at the low end of published parameters wears no more than at their middle, and that than at the high."""
    band = law.band()
    if band is None:
        return

    def examine(contact: Contact) -> None:
        low, middle, high = (end.rate(forward(contact), end.numbers) for end in band)
        assert (low <= middle).all(), f"the low end {low!r} lies above the middle {middle!r}"
        assert (middle <= high).all(), f"the middle {middle!r} lies above the high end {high!r}"

    for_each_contact(law, examine)


OF_LAWS = (declared_names_are_variables, band_is_ordered)
