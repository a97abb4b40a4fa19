"""Checks of the branches of a law, and of its precision."""

from __future__ import annotations

import dataclasses
from functools import partial

import numpy as np

from wearlaw.arrays import Array
from wearlaw.contact.contact import Contact
from wearlaw.models.law import PATCH_VARIABLES, BreakpointMap, Law
from wearlaw_kit.bisection import Indices, find_jumps, find_kinks, lost_digits
from wearlaw_kit.examples import SAME, assert_close
from wearlaw_kit.law_contacts import (
    VALUES,
    aimed,
    at_nodes,
    forward,
    has_rates_at_nodes,
    random_contacts,
    retotalled,
    with_totals,
)
from wearlaw_kit.rules import rule

PATHS = 64
"""Number of paths between random contacts to search for jumps and kinks."""

KINK = 1e-4
"""Change of slope that counts as a kink: of the rate, per e-fold of all values of the contact together."""

AT_JUMP = 1e-10
"""Relative distance up to which a jump counts as declared: a position on a path that spans ten
decades is known to 23 times rounding."""


class _Paths:
    """Paths from one random contact to another, straight in the logarithm of every value."""

    def __init__(self, law: Law) -> None:
        self.law = law
        self.first, self.second = (forward(random_contacts(PATHS, seed, loaded=True, law=law)) for seed in (1, 2))

    def contact(self, index: Indices, share: Array) -> Contact:
        """Return the contacts at shares of the way along paths."""
        first, second = self.first[index], self.second[index]

        def between(name: str) -> Array:
            start, end = getattr(first, name), getattr(second, name)
            value: Array = start * (end / start) ** share.reshape(-1, *[1] * (start.ndim - 1))
            return value

        return with_totals(**{name: between(name) for name in VALUES}, x=first.x).replaced(problem=first.problem)

    def rate(self, index: Indices, share: Array) -> Array:
        """Return the rate there."""
        rate: Array = self.law.rate(self.contact(index, share), self.law.numbers)[:, 0]
        return rate

    def e_folds(self) -> Array:
        """Return how far each path goes, in e-folds of all values that a law has a part in."""
        names = [name for name in VALUES if name != "traction_bound"]
        logs = [np.log(getattr(self.second, name) / getattr(self.first, name)).reshape(PATHS) for name in names]
        total: Array = np.abs(logs).sum(axis=0)
        return total

    def assert_declared(self, declared: BreakpointMap, path: int, ends: tuple[float, float], what: str) -> None:
        """Assert that a variable passes one of its declared values in a piece of a path, or just outside of it."""
        start, end = (self.contact(np.array([path]), np.array([share])) for share in ends)
        for name, values in declared.items():
            low, high = sorted(float(np.abs(self.law.value_at(contact, name))[0, 0]) for contact in (start, end))
            margin = (high - low) + AT_JUMP * high
            if any(low - margin <= value <= high + margin for value in values):
                return
        at = ", ".join(f"{name} {float(at_nodes(start, name)[0, 0]):.6g}" for name in PATCH_VARIABLES)
        raise AssertionError(f"{what}, at {at} in SI units")


@rule(Law, applies=has_rates_at_nodes)
def rate_jumps_only_where_declared(law: Law) -> None:
    """Between any two contacts the rate is continuous, except where a variable passes a value in `jumps`."""
    paths, jumps = _Paths(law), law.jumps(law.numbers)
    for path, share, before, behind in find_jumps(paths.rate, PATHS):
        what = f"the rate jumps from {before:.6g} to {behind:.6g} kg/m/m², not declared in `jumps`"
        paths.assert_declared(jumps, path, (share, share), what)


@rule(Law, applies=lambda law: has_rates_at_nodes(law) and law.breakpoints(law.numbers) is not None)
def rate_has_kinks_only_where_declared(law: Law) -> None:
    """Where a law declares its `breakpoints`, its slope is continuous everywhere else.

    A kink is found if the slope changes by a thousandth of the rate per e-fold of the variable in which it lies: on
    many paths that variable has more than a fifth of the e-folds of all values, and half of the change shows. What
    turns smoothly over less than a ten-thousandth of a variable counts as a kink too.
    """
    paths, breakpoints = _Paths(law), law.breakpoints(law.numbers) or {}
    for path, low, high, change in find_kinks(paths.rate, KINK * paths.e_folds()):
        what = f"the slope of the rate jumps by {change:.2g} of the rate per path, not declared in `breakpoints`"
        paths.assert_declared(breakpoints, path, (low, high), what)


@rule(Law, applies=lambda law: has_rates_at_nodes(law) and law.ramps(law.numbers) is not None)
def ramps_sum_to_the_rate(law: Law) -> None:
    """The ramps are the law: Σ slope · max(q·s - threshold, 0), with thresholds at zero or at breakpoints."""
    ramps = law.ramps(law.numbers) or ()
    declared = np.array((law.breakpoints(law.numbers) or {}).get("wear_index_density", ()))
    for threshold, _ in ramps:
        at_breakpoint = (np.abs(declared - threshold) <= SAME * threshold).any()
        assert threshold == 0 or at_breakpoint, f"`ramps` has a threshold at {threshold:g}, which `breakpoints` lacks"
    contact = random_contacts(512, law=law)
    for near in (None, *(threshold for threshold, _ in ramps if threshold > 0)):
        if near is not None:
            contact = aimed(contact, "wear_index_density", near * np.logspace(-1, 1, 512)[:, None])
        w = contact.wear_index_density
        total = sum((slope * np.maximum(w - threshold, 0.0) for threshold, slope in ramps), np.zeros_like(w))
        # A ramp rounds q·s once more than the law, and the sum as much as its largest term.
        size = sum(abs(slope) * w for _, slope in ramps)
        assert_close(total, law.rate(contact, law.numbers), "the sum of the `ramps`", absolute=SAME * size)


@rule(Law)
def precision_is_double(law: Law) -> None:
    """The rate is a float64 and exact to rounding, in steps of 1e-8 of each value of the contact."""
    contact = random_contacts(256, seed=4, law=law)
    rate = law.rate(contact, law.numbers)
    assert rate.dtype == np.float64, f"the rate is of type {rate.dtype}, not float64"
    for name in ("pressure", "traction", "slip", "rolling_speed", "density", "wear_index"):
        lost_digits(partial(_rate_with, law, contact, name), f"the rate loses digits of {name}")


def _rate_with(law: Law, contact: Contact, name: str, factor: float) -> Array:
    """Return the rate with a value times a factor; its sums follow, but for a wear index alone."""
    change = dataclasses.replace if name == "wear_index" else retotalled
    rate: Array = law.rate(change(contact, **{name: getattr(contact, name) * factor}), law.numbers)
    return rate
