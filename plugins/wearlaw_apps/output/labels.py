"""Words for readers of tables and figures: names of models side by side, of variables with units, and of patches."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TypeVar

from wearlaw.errors import InputError
from wearlaw.models.law import Law, named_outcomes
from wearlaw.models.model import Model
from wearlaw.pipeline.selection import Label
from wearlaw.pipeline.variables import outcome_units
from wearlaw.units.quantities import Quantity, text_of
from wearlaw.units.registry import symbol
from wearlaw.units.variables import UNITS, name_of

ModelT = TypeVar("ModelT", bound=Model)


def labels(models: Sequence[Model]) -> list[str]:
    """Return a short name for each model: its own name, and the options that tell it from models of the same name.

    The name of a law for one body has that body, as in "usfd(body=rail)". A law with a label has its label.
    """
    names = []
    for model in models:
        label = getattr(model, "label", None)
        if label is not None:
            names.append(label)
            continue
        namesakes = [other for other in models if other.name == model.name and not getattr(other, "label", None)]
        body = ["body"] if getattr(model, "body", None) is not None else []
        fields = dict.fromkeys([*_telling_apart(namesakes), *body])
        options = [f"{field}={text_of(getattr(model, field))}" for field in fields]
        names.append(f"{model.name}({', '.join(options)})" if options else model.name)
    for name in names:
        if names.count(name) > 1:
            raise InputError(f"the model {name} is listed twice; leave one out, or give it other options or a label")
    return names


def labelled(models: Sequence[ModelT]) -> dict[str, ModelT]:
    """Return models by their `labels`."""
    return dict(zip(labels(models), models, strict=True))


def _telling_apart(models: Sequence[Model]) -> list[str]:
    """Return the fewest fields, in their order, that tell models of one name apart."""
    fields: list[str] = []
    kinds: set[tuple[str, ...]] = {()}
    for field in type(models[0]).model_fields:
        finer = {tuple(text_of(getattr(model, name)) for name in (*fields, field)) for model in models}
        if len(finer) > len(kinds):
            fields, kinds = [*fields, field], finer
    return fields


def label(*variables: str, units: Mapping[str, str] = UNITS) -> str:
    """Return the names of variables that share a unit, with the unit, as in "creepage [%]"."""
    return f"{', '.join(name_of(variable) for variable in variables)} [{readable(units[variables[0]]) or '-'}]"


def readable(unit: str) -> str:
    """Return a unit for a reader, as in "µg/m/mm²"."""
    return unit.replace("ug", "µg").replace("um", "µm").replace("^2", "²").replace("*", "·")


def raised(power: int) -> str:
    """Return a power as superscript letters, which survive where a text is broken or copied."""
    return str(power).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))


def in_words(labels: Mapping[str, Label]) -> str:
    """Return the labels of a patch in words, such as "left, patch 1"; a number stands behind the name of its axis."""
    return ", ".join(label if isinstance(label, str) else f"{name_of(axis)} {label}" for axis, label in labels.items())


def unit_of(name: str, value: Quantity, laws: Sequence[Law]) -> str:
    """Return the unit of a variable in results, in the notation of `UNITS`."""
    units = {**UNITS, **outcome_units(laws)}
    return units[name] if name in units else symbol(value.units, "~C")


def long_name(variable: str, laws: Sequence[Law]) -> str:
    """Return the readable name of a variable, such as "wear rate of rail"."""
    index = named_outcomes(laws).get(variable)
    if index is None:
        return name_of(variable)
    law = laws[index]
    return law.outcome.long_name + (f" of {law.body}" if law.body is not None else "")
