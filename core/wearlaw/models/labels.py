"""Short names for models shown side by side."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeVar

from wearlaw.errors import InputError
from wearlaw.models.contact_model import Model
from wearlaw.units.quantities import full_text

ModelT = TypeVar("ModelT", bound=Model)


def labels(models: Sequence[Model]) -> list[str]:
    """Return a short name for each model: its own name, and the options that tell it from models of the same name.

    The name of a law for one body has that body, as in "usfd(body=rail)". A law with a label has its label.
    """
    found = []
    for model in models:
        label = getattr(model, "label", None)
        if label is not None:
            found.append(label)
            continue
        namesakes = [other for other in models if other.name == model.name and not getattr(other, "label", None)]
        body = ["body"] if getattr(model, "body", None) is not None else []
        fields = dict.fromkeys([*_telling_apart(namesakes), *body])
        options = [f"{field}={full_text(getattr(model, field))}" for field in fields]
        found.append(f"{model.name}({', '.join(options)})" if options else model.name)
    for name in found:
        if found.count(name) > 1:
            raise InputError(f"the model {name} is listed twice; leave one out, or give it other options or a label")
    return found


def labelled(models: Sequence[ModelT]) -> dict[str, ModelT]:
    """Return models by their `labels`."""
    return dict(zip(labels(models), models, strict=True))


def _telling_apart(models: Sequence[Model]) -> list[str]:
    """Return the fewest fields, in their order, that tell models of one name apart."""
    fields: list[str] = []
    kinds: set[tuple[str, ...]] = {()}
    for field in type(models[0]).model_fields:
        finer = {tuple(full_text(getattr(model, name)) for name in (*fields, field)) for model in models}
        if len(finer) > len(kinds):
            fields, kinds = [*fields, field], finer
    return fields
