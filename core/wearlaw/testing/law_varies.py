"""The check of laws that declare that their parameters may differ from operating point to operating point."""

from __future__ import annotations

import dataclasses

import numpy as np

from wearlaw.arrays import Array
from wearlaw.errors import WearlawError
from wearlaw.models import WearLaw
from wearlaw.parameters import changed, number_in_si, number_like, numbers, per_point
from wearlaw.records import Contact
from wearlaw.testing.examples import assert_close, for_each
from wearlaw.testing.law_shape import contacts_for

STEPS = (1.0, 1.001, 0.999)
"""Factors of a parameter at one operating point after the other; small, since laws refuse parameters out of order."""


def parameters_may_vary(law: WearLaw) -> None:
    """With one value of a parameter for each operating point, rate and ramps are those of one law after the other."""

    def examine(contact: Contact) -> None:
        batch = _repeated(contact, len(STEPS))
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
                assert_close(rate[point], one.rate(_point(batch, point))[0], f"the rate {what}")
                assert_close(_ramps(varied, point), _ramps(one, 0), f"the ramps {what}")

    for_each(contacts_for(law), examine)


def _ramps(law: WearLaw, point: int) -> Array:
    flat = [np.ravel(number) for ramp in law.ramps or () for number in ramp]
    return np.array([numbers[point if numbers.size > 1 else 0] for numbers in flat])


def _repeated(contact: Contact, times: int) -> Contact:
    fields = {field.name: getattr(contact, field.name)[:1] for field in dataclasses.fields(contact)}
    return Contact(**{name: np.repeat(value, times, axis=0) for name, value in fields.items()})


def _point(contact: Contact, point: int) -> Contact:
    fields = {field.name: getattr(contact, field.name)[point : point + 1] for field in dataclasses.fields(contact)}
    return Contact(**fields)


CHECKS = (parameters_may_vary,)
