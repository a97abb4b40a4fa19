"""Checks of a model's description of itself: documentation, units, schema, names."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pint

from wearlaw.contact.contact import LAW_VARIABLES, PATCH_VARIABLES, Contact
from wearlaw.models.contact_model import Model
from wearlaw.models.law import Law
from wearlaw.settings.docstrings import field_docstrings
from wearlaw.testing.law_contacts import for_each_contact
from wearlaw.testing.sampling import forward


def model_is_documented(model: Model) -> None:
    """The class has a name, a docstring of its own and a source; each field has a docstring with its unit."""
    cls = type(model)
    assert isinstance(getattr(cls, "name", None), str), "the class has no name"
    assert cls.name.isidentifier(), f"the name must be an identifier, got {cls.name!r}"
    assert (cls.__doc__ or "").strip(), f"{cls.__name__} has no docstring"
    assert str(getattr(cls, "source", "")).strip(), f"{cls.__name__} names no source"
    for name, description in field_docstrings(cls).items():
        assert description.strip(), f"the field '{name}' has no docstring"
        if isinstance(getattr(model, name), (float, pint.Quantity)):
            assert "[" in description, f"the docstring of the field '{name}' names no unit, such as [N/m²] or [-]"


def json_schema_is_complete(model: Model) -> None:
    """The class has a JSON Schema, with a description of each field, that can be written as JSON."""
    schema: dict[str, Any] = json.loads(json.dumps(type(model).model_json_schema()))
    properties = schema.get("properties", {})
    for name, field in type(model).model_fields.items():
        key = field.alias or name
        assert key in properties, f"the schema lacks the field '{key}'"
        assert properties[key].get("description"), f"the schema does not describe the field '{key}'"


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


COMMON = (model_is_documented, json_schema_is_complete)
OF_LAWS = (declared_names_are_variables, band_is_ordered)
