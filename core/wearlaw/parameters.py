"""The numbers among a model's fields: by name, changed, and with one value for each operating point."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, TypeVar

import pint

from wearlaw.arrays import Array
from wearlaw.configuration import Configuration
from wearlaw.errors import InputError, did_you_mean
from wearlaw.registry import si_factor
from wearlaw.units import Quantity, from_si

ConfigurationT = TypeVar("ConfigurationT", bound=Configuration)


def numbers(record: Configuration) -> dict[str, Quantity | float]:
    """Return the fields that are numbers by name; those of a record within a record as "outer.inner"."""
    found: dict[str, Quantity | float] = {}
    for name in type(record).model_fields:
        value = getattr(record, name)
        if isinstance(value, Configuration):
            found |= {f"{name}.{inner}": number for inner, number in numbers(value).items()}
        elif isinstance(value, pint.Quantity | float):
            found[name] = value
    return found


def number_in_si(value: Quantity | float) -> float:
    """Return a number of `numbers` in SI."""
    if not isinstance(value, pint.Quantity):
        return float(value)
    return float(value.magnitude) * si_factor(value, str(value.units))


def number_like(number: Quantity | float, si: Any) -> Any:
    """Return SI floats in the unit of one of `numbers`."""
    return from_si(si, str(number.units)) if isinstance(number, pint.Quantity) else si


def changed(record: ConfigurationT, values: Mapping[str, Quantity | float]) -> ConfigurationT:
    """Return a copy with some of its `numbers` changed, checked like a new record."""
    return record.model_copy(update=_by_field(record, values, changed))


def per_point(record: ConfigurationT, values: Mapping[str, Array]) -> ConfigurationT:
    """Return a copy in which some of the `numbers` hold one value for each operating point.

    Parameters
    ----------
    record : Configuration
        The model.
    values : mapping of str to ndarray, (points,)
        By the names of `numbers`, in SI.

    Returns
    -------
    Configuration
        Its fields hold arrays of shape (points, 1), which broadcast over the nodes of a contact. It is not checked,
        and good for nothing but computing with it.
    """
    units = numbers(record)
    columns = {name: number_like(units[name], si[:, None]) for name, si in values.items()}
    return _unchecked(record, columns)


def _unchecked(record: ConfigurationT, values: Mapping[str, Any]) -> ConfigurationT:
    fields = {name: getattr(record, name) for name in type(record).model_fields}
    return type(record).model_construct(**fields | _by_field(record, values, _unchecked))


def _by_field(record: Configuration, values: Mapping[str, Any], change: Any) -> dict[str, Any]:
    """Return the new values of the record's own fields, of which some are changed records themselves."""
    known = numbers(record)
    fields: dict[str, Any] = {}
    nested: dict[str, dict[str, Any]] = {}
    for name, value in values.items():
        if name not in known:
            hint = did_you_mean(name, known)
            raise InputError(
                f"{record.subject()}: '{name}' is no number among its fields{hint} There are: {', '.join(known)}"
            )
        outer, _, inner = name.partition(".")
        if inner:
            nested.setdefault(outer, {})[inner] = value
        else:
            fields[outer] = value
    return fields | {outer: change(getattr(record, outer), inner) for outer, inner in nested.items()}
