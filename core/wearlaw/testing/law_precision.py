"""Checks of a wear law for jumps and lost digits."""

from __future__ import annotations

import dataclasses
from functools import partial

import numpy as np

from wearlaw.arrays import Array
from wearlaw.models import WearLaw
from wearlaw.records import Contact
from wearlaw.testing.bisection import Indices, find_jumps, lost_digits
from wearlaw.testing.sampling import aimed, at_nodes, between, forward, random_contacts, retotalled, rows

PATHS = 64
"""Paths between random contacts along which a jump is looked for."""

AT_JUMP = 1e-10
"""Relative distance from a declared jump at which it is taken to lie there: a position on a path that spans ten
decades is known to 23 times rounding."""

STEP = 1e-12
"""Relative distance of the two sides of a jump: a continuous rate changes by a few times that."""


def rate_jumps_only_where_declared(law: WearLaw) -> None:
    """Between any two contacts the rate is continuous, except where a variable passes a value in `jumps`."""
    first, second = (forward(random_contacts(PATHS, seed=seed)) for seed in (1, 2))

    def contact(index: Indices, share: Array) -> Contact:
        return between(rows(first, index), rows(second, index), share)

    found = find_jumps(lambda index, share: law.rate(contact(index, share))[:, 0], PATHS)
    for path, share, before, behind in found:
        values = contact(np.array([path]), np.array([share]))
        declared = any(
            abs(float(at_nodes(values, name)[0, 0]) - jump) <= AT_JUMP * abs(jump)
            for name, jumps in law.jumps.items()
            for jump in jumps
        )
        assert declared, (
            f"the rate jumps from {before:.6g} to {behind:.6g} kg/m/m², not declared in `jumps`, at {_at(values)}"
        )


def _at(contact: Contact) -> str:
    names = ("pressure", "traction", "slip", "slip_speed", "wear_index_density", "wear_index")
    return ", ".join(f"{name} {float(at_nodes(contact, name)[0, 0]):.6g}" for name in names) + " in SI units"


def declared_jumps_exist(law: WearLaw) -> None:
    """At every value in `jumps` there is a contact at which the rate jumps."""
    contact = forward(random_contacts(512, seed=3))
    for name, jumps in law.jumps.items():
        for jump in jumps:
            below, above = (law.rate(aimed(contact, name, jump * (1.0 + side * STEP))) for side in (-1, 1))
            step = np.abs(above - below) > 1e3 * STEP * np.maximum(np.abs(above), np.abs(below))
            assert step.any(), f"`jumps` declares a jump at {name} = {jump:g}, but the rate is continuous there"


def jumps_are_breakpoints(law: WearLaw) -> None:
    """A declared jump is also a breakpoint, where the integration puts the border of a panel."""
    breakpoints = law.breakpoints or {}
    for name, jumps in law.jumps.items():
        missing = set(jumps) - set(breakpoints.get(name, ()))
        assert not missing, f"`jumps` has {name} = {sorted(missing)}, which `breakpoints` lacks"


def precision_is_double(law: WearLaw) -> None:
    """The rate is a float64 and resolves changes of 1e-8 in each value of the contact."""
    contact = random_contacts(256, seed=4)
    rate = law.rate(contact)
    assert rate.dtype == np.float64, f"the rate is of type {rate.dtype}, not float64"
    for name in ("pressure", "traction", "slip", "rolling_speed", "density"):
        lost_digits(partial(_rate_with, law, contact, name), f"the rate loses digits of {name}")
    lost_digits(
        lambda factor: law.rate(dataclasses.replace(contact, wear_index=contact.wear_index * factor)),
        "the rate loses digits of wear_index",
    )


def _rate_with(law: WearLaw, contact: Contact, name: str, factor: float) -> Array:
    return law.rate(retotalled(contact, **{name: getattr(contact, name) * factor}))


CHECKS = (rate_jumps_only_where_declared, declared_jumps_exist, jumps_are_breakpoints, precision_is_double)
