"""The range in which a parameter may lie, from the annotation of its field."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, get_args

import numpy as np
from pydantic.fields import FieldInfo

from wearlaw.configuration import Configuration
from wearlaw.units.quantities import Unit
from wearlaw.units.registry import unit_in_si


def allowed_range(record: Configuration, name: str) -> tuple[float, float, bool]:
    """Return the least and the greatest value in SI that one of `numbers` may have, and whether it must be positive.

    These are the bounds in the annotation of the field, infinite where it has none.
    """
    outer, _, inner = name.partition(".")
    if inner:
        return allowed_range(getattr(record, outer), inner)
    low, high, positive = -np.inf, np.inf, False
    field = type(record).model_fields[outer]
    for rule in (*field.metadata, *_rules_within(field.annotation)):
        if isinstance(rule, Unit):
            limit = rule.limit * unit_in_si(rule.unit) if rule.limit < np.inf else np.inf
            low, high, positive = max(low, -limit), min(high, limit), positive or rule.positive
            continue
        above = getattr(rule, "gt", None)
        positive = positive or (above is not None and above >= 0.0)
        low = max([low, *(float(end) for end in (above, getattr(rule, "ge", None)) if end is not None)])
        high = min([high, *(float(getattr(rule, end)) for end in ("lt", "le") if getattr(rule, end, None) is not None)])
    return (max(low, 0.0) if positive else low), high, positive


def _rules_within(annotation: Any) -> Iterator[Any]:
    """Yield the rules of the types in a union, such as those of `Annotated[float, Field(ge=1)] | None`."""
    for one in get_args(annotation):
        for rule in getattr(one, "__metadata__", ()):
            yield from rule.metadata if isinstance(rule, FieldInfo) else (rule,)
