"""The numbers among a model's fields, by name and in SI."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, TypeVar

import pint

from wearlaw.configuration import Configuration
from wearlaw.errors import InputError, did_you_mean, shown
from wearlaw.units.quantities import Quantity, from_si
from wearlaw.units.registry import si_factor

ConfigurationT = TypeVar("ConfigurationT", bound=Configuration)


def numbers(record: Configuration) -> dict[str, Quantity | float]:
    """Return the numbers among the fields by name; a number of a record within a record is "outer.inner"."""
    values: dict[str, Quantity | float] = {}
    for name in type(record).model_fields:
        value = getattr(record, name)
        if isinstance(value, Configuration):
            values |= {f"{name}.{inner}": number for inner, number in numbers(value).items()}
        elif isinstance(value, pint.Quantity | float):
            values[name] = value
    return values


def number_in_si(value: Quantity | float) -> float:
    """Return a number of `numbers` in SI."""
    if not isinstance(value, pint.Quantity):
        return float(value)
    return float(value.magnitude) * si_factor(value, str(value.units))


def numbers_in_si(record: Configuration) -> dict[str, float]:
    """Return the `numbers` of a record in SI."""
    return {name: number_in_si(value) for name, value in numbers(record).items()}


def number_like(number: Quantity | float, si: Any) -> Any:
    """Return SI floats in the unit of one of `numbers`."""
    return from_si(si, str(number.units)) if isinstance(number, pint.Quantity) else si


def changed(record: ConfigurationT, values: Mapping[str, Quantity | float]) -> ConfigurationT:
    """Return a copy with some of its `numbers` changed, checked like a new record."""
    names = numbers(record)
    fields: dict[str, Any] = {}
    nested: dict[str, dict[str, Any]] = {}
    for name, value in values.items():
        if name not in names:
            hint = did_you_mean(name, names)
            raise InputError(
                f"{record.subject()}: {shown(name)} is not a number among its fields{hint} There are:"
                f" {', '.join(names)}"
            )
        outer, _, inner = name.partition(".")
        if inner:
            nested.setdefault(outer, {})[inner] = value
        else:
            fields[outer] = value
    records = {outer: changed(getattr(record, outer), inner) for outer, inner in nested.items()}
    return record.model_copy(update=fields | records)
