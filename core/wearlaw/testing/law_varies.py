"""The check of laws that declare that their parameters may differ from operating point to operating point."""

from __future__ import annotations

import numpy as np

from wearlaw.arrays import Array
from wearlaw.errors import WearlawError
from wearlaw.models import WearLaw
from wearlaw.parameters import changed, number_in_si, number_like, numbers, per_point
from wearlaw.records import Contact
from wearlaw.testing.examples import assert_close, for_each
from wearlaw.testing.law_shape import contacts_for
from wearlaw.testing.sampling import rows

STEPS = (1.0, 1.001, 0.999)
"""Factors of a parameter at one operating point after the other; small, since laws refuse parameters out of order."""


def parameters_may_vary(law: WearLaw) -> None:
    """With one value of a parameter for each operating point, rate and ramps are those of one law after the other."""

    def examine(contact: Contact) -> None:
        batch = rows(contact, [0] * len(STEPS))
        for name, number in numbers(law).items():
            values = number_in_si(number) * np.array(STEPS)
            varied = per_point(law, {name: values})
            rate = varied.rate(batch)
            assert np.shape(rate) == batch.pressure.shape, f"rates of shape {np.shape(rate)} when {name} varies"
            for point, value in enumerate(values):
                try:
                    one = changed(law, {name: number_like(number, float(value))})
                except WearlawError:  # not a value that the law takes
                    continue
                what = f"with {name} for each point"
                assert_close(rate[point], one.rate(rows(batch, [point]))[0], f"the rate {what}")
                assert_close(_ramps(varied, point), _ramps(one, 0), f"the ramps {what}")

    for_each(contacts_for(law), examine)


def _ramps(law: WearLaw, point: int) -> Array:
    flat = [np.ravel(number) for ramp in law.ramps or () for number in ramp]
    return np.array([each[point if each.size > 1 else 0] for each in flat])


CHECKS = (parameters_may_vary,)
