"""The check that a law's formulas take one value of a number for each operating point, as fits pass them."""

from __future__ import annotations

from typing import Any

import numpy as np

from wearlaw.arrays.array import Array
from wearlaw.contact.contact import Contact
from wearlaw.errors import WearlawError
from wearlaw.models.wear_law import Numbers, WearLaw
from wearlaw.settings.parameters import changed, number_like, numbers
from wearlaw.testing.examples import assert_close, for_each
from wearlaw.testing.law_shape import contacts_for
from wearlaw.testing.sampling import rows

STEPS = (1.0, 1.001, 0.999)
"""Factors of a parameter at one operating point after the other; small, since laws refuse parameters out of order."""


def parameters_may_vary(law: WearLaw) -> None:
    """With one value of a number for each operating point, a law gives what one law after the other gives.

    That goes for its rate, its breakpoints and its ramps.
    """
    law = law.explicit()

    def examine(contact: Contact) -> None:
        batch = rows(contact, [0] * len(STEPS))
        for name, number in numbers(law).items():
            values = law.numbers[name] * np.array(STEPS)
            p: Numbers = {**law.numbers, name: values[:, None]}
            rate = law.rate(batch, p)
            assert np.shape(rate) == batch.pressure.shape, f"rates of shape {np.shape(rate)} when {name} varies"
            for point, value in enumerate(values):
                try:
                    one = changed(law, {name: number_like(number, float(value))})
                except WearlawError:  # not a value that the law takes
                    continue
                what = f"with {name} for each point"
                assert_close(rate[point], one.rate(rows(batch, [point]), one.numbers)[0], f"the rate {what}")
                for found, expected, of in zip(_borders(law, p), _borders(one, one.numbers), BORDERS, strict=True):
                    assert_close(_at(found, point), _at(expected, 0), f"the {of} {what}")

    for_each(contacts_for(law), examine)


BORDERS = ("breakpoints", "ramps")


def _borders(law: WearLaw, p: Numbers) -> tuple[list[Any], list[Any]]:
    """Return the numbers of breakpoints and of ramps, each in one list."""
    breakpoints, ramps = law.breakpoints(p) or {}, law.ramps(p) or ()
    return [value for name in sorted(breakpoints) for value in breakpoints[name]], [n for ramp in ramps for n in ramp]


def _at(found: list[Any], point: int) -> Array:
    """Return numbers at one operating point, of which each is a float or an array with one value for each."""
    flat = [np.ravel(number) for number in found]
    return np.array([each[point if each.size > 1 else 0] for each in flat])


CHECKS = (parameters_may_vary,)
