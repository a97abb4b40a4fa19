"""Checks of the branches of a wear law, and of its precision."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator
from functools import partial

import numpy as np

from wearlaw.arrays.array import Array
from wearlaw.contact.contact import PATCH_VARIABLES, Contact
from wearlaw.models.law import BreakpointMap, Law
from wearlaw_kit.bisection import Function, Indices, find_jumps, find_kinks, lost_digits
from wearlaw_kit.examples import SAME, assert_close
from wearlaw_kit.sampling import aimed, at_nodes, between, e_folds, forward, random_contacts, retotalled, rows

PATHS = 64
"""Number of paths between random contacts to search for jumps and kinks."""

KINK = 1e-4
"""Change of slope that counts as a kink: of the rate, per e-fold of all values of the contact together."""

AT_JUMP = 1e-10
"""Relative distance up to which a jump counts as declared: a position on a path that spans ten
decades is known to 23 times rounding."""

STEP = 1e-12
"""Relative distance of the two sides of a jump: a continuous rate changes by a few times that."""

E_FOLDS = 30.0
"""Farthest change of a value, in e-folds, to reach a jump in a variable of the law's own."""


class _Paths:
    """Paths from one random contact to another, straight in the logarithm of every value."""

    def __init__(self, law: Law) -> None:
        self.first, self.second = (forward(random_contacts(PATHS, seed=seed, loaded=True, law=law)) for seed in (1, 2))

    def contact(self, index: Indices, share: Array) -> Contact:
        return between(rows(self.first, index), rows(self.second, index), share)

    def rate(self, law: Law) -> Function:
        return lambda index, share: law.rate(self.contact(index, share), law.numbers)[:, 0]

    def ends(self, path: int, low: float, high: float) -> tuple[Contact, Contact]:
        """Return the contacts at both ends of a piece of a path."""
        start, end = (self.contact(np.array([path]), np.array([share])) for share in (low, high))
        return start, end


def rate_jumps_only_where_declared(law: Law) -> None:
    """Between any two contacts the rate is continuous, except where a variable passes a value in `jumps`."""
    paths, jumps = _Paths(law), law.jumps(law.numbers)
    for path, share, before, behind in find_jumps(paths.rate(law), PATHS):
        values, _ = paths.ends(path, share, share)
        assert _declared(law, jumps, values, values), (
            f"the rate jumps from {before:.6g} to {behind:.6g} kg/m/m², not declared in `jumps`, at {_at(values)}"
        )


def rate_has_kinks_only_where_declared(law: Law) -> None:
    """Where a law declares its `breakpoints`, its slope is continuous everywhere else.

    A kink is found if the slope changes by a thousandth of the rate per e-fold of the variable in which it lies: on
    many paths that variable has more than a fifth of the e-folds of all values, and half of the change shows. What
    turns smoothly over less than a ten-thousandth of a variable counts as a kink too.
    """
    paths, breakpoints = _Paths(law), law.breakpoints(law.numbers) or {}
    for path, low, high, change in find_kinks(paths.rate(law), KINK * e_folds(paths.first, paths.second)):
        start, end = paths.ends(path, low, high)
        assert _declared(law, breakpoints, start, end), (
            f"the slope of the rate jumps by {change:.2g} of the rate, over the length of a path between two contacts,"
            f" not declared in `breakpoints`, at {_at(start)}"
        )


def _declared(law: Law, values: BreakpointMap, start: Contact, end: Contact) -> bool:
    """Return whether a variable passes one of its declared values between two contacts, or just outside of them."""
    for name, declared in values.items():
        low, high = sorted(float(np.abs(law.value_at(contact, name))[0, 0]) for contact in (start, end))
        margin = (high - low) + AT_JUMP * high
        if any(low - margin <= value <= high + margin for value in declared):
            return True
    return False


def _at(contact: Contact) -> str:
    return ", ".join(f"{name} {float(at_nodes(contact, name)[0, 0]):.6g}" for name in PATCH_VARIABLES) + " in SI units"


def declared_jumps_exist(law: Law) -> None:
    """Every value in `jumps` is a breakpoint too, and there is a contact at which the rate jumps there."""
    breakpoints = law.breakpoints(law.numbers) or {}
    contact = forward(random_contacts(512, seed=3, law=law))
    for name, jumps in law.jumps(law.numbers).items():
        missing = set(jumps) - set(breakpoints.get(name, ()))
        assert not missing, f"`jumps` has {name} = {sorted(missing)}, which `breakpoints` lacks"
        for jump in jumps:
            steps = []
            for sides in _beside(law, contact, name, jump):
                below, above = (law.rate(side, law.numbers) for side in sides)
                steps.append(np.abs(above - below) > 1e3 * STEP * np.maximum(np.abs(above), np.abs(below)))
            assert np.any(steps), f"`jumps` declares a jump at {name} = {jump:g}, but the rate is continuous there"


def _beside(law: Law, contact: Contact, name: str, value: float) -> Iterator[tuple[Contact, Contact]]:
    """Yield contacts on both sides of a value of a variable; a law's own variable is moved by slip or by pressure."""
    if name not in law.own_variables:
        yield aimed(contact, name, value * (1.0 - STEP)), aimed(contact, name, value * (1.0 + STEP))
        return
    for field in ("slip", "pressure"):
        start = getattr(contact, field)

        def moved(factor: Array, field: str = field, start: Array = start) -> Contact:
            return retotalled(contact, **{field: start * np.exp(factor)})

        low, high = np.full_like(start, -E_FOLDS), np.full_like(start, E_FOLDS)
        rises = np.abs(law.value_at(moved(high), name)) > np.abs(law.value_at(moved(low), name))
        while (high - low > STEP).any():
            middle = 0.5 * (low + high)
            beyond = (np.abs(law.value_at(moved(middle), name)) >= abs(value)) == rises
            low, high = np.where(beyond, low, middle), np.where(beyond, middle, high)
        yield moved(low - STEP), moved(high + STEP)


def precision_is_double(law: Law) -> None:
    """The rate is a float64 and exact to rounding, in steps of 1e-8 of each value of the contact."""
    contact = random_contacts(256, seed=4, law=law)
    rate = law.rate(contact, law.numbers)
    assert rate.dtype == np.float64, f"the rate is of type {rate.dtype}, not float64"
    for name in ("pressure", "traction", "slip", "rolling_speed", "density"):
        lost_digits(partial(_rate_with, law, contact, name), f"the rate loses digits of {name}")
    lost_digits(
        lambda factor: law.rate(dataclasses.replace(contact, wear_index=contact.wear_index * factor), law.numbers),
        "the rate loses digits of wear_index",
    )


def _rate_with(law: Law, contact: Contact, name: str, factor: float) -> Array:
    return law.rate(retotalled(contact, **{name: getattr(contact, name) * factor}), law.numbers)


def ramps_sum_to_the_rate(law: Law) -> None:
    """The ramps are the law: Σ slope · max(q·s - threshold, 0), with thresholds at zero or at breakpoints."""
    ramps = law.ramps(law.numbers) or ()
    declared = np.array((law.breakpoints(law.numbers) or {}).get("wear_index_density", ()))
    for threshold, slope in ramps:
        assert np.isfinite([threshold, slope]).all(), f"`ramps` has a threshold of {threshold}, a slope of {slope}"
        assert threshold >= 0, f"`ramps` has a negative threshold, {threshold:g}"
        at_breakpoint = (np.abs(declared - threshold) <= SAME * threshold).any()
        assert threshold == 0 or at_breakpoint, f"`ramps` has a threshold at {threshold:g}, which `breakpoints` lacks"
    contact = random_contacts(512, law=law)
    for near in (None, *(threshold for threshold, _ in ramps if threshold > 0)):
        if near is not None:
            contact = aimed(contact, "wear_index_density", near * np.logspace(-1, 1, 512)[:, None])
        w = contact.wear_index_density
        terms = [slope * np.maximum(w - threshold, 0.0) for threshold, slope in ramps]
        # A ramp rounds q·s once more than the law, and the sum as much as its largest term.
        size = sum(abs(slope) * w for _, slope in ramps)
        assert_close(
            sum(terms, np.zeros_like(w)), law.rate(contact, law.numbers), "the sum of the `ramps`", absolute=SAME * size
        )


CHECKS = (
    rate_jumps_only_where_declared,
    rate_has_kinks_only_where_declared,
    declared_jumps_exist,
    ramps_sum_to_the_rate,
    precision_is_double,
)

OF_BREAKPOINTS = (rate_has_kinks_only_where_declared,)
"""Checks of laws that declare their breakpoints."""

OF_RAMPS = (ramps_sum_to_the_rate,)
"""Checks of laws that declare `ramps`."""
