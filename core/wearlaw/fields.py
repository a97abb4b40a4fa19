"""Fields that take a model by its name, table, file or instance."""

from __future__ import annotations

import inspect
import os
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, get_type_hints

from pydantic import BeforeValidator, Field, PlainSerializer, WithJsonSchema, create_model

from wearlaw import loader
from wearlaw.configuration import Configuration, field_docstrings, known_name
from wearlaw.contact.material import TYPE, Material
from wearlaw.errors import ConfigurationError, Fault, InputError, shown, with_problems
from wearlaw.loader import Preset
from wearlaw.models.contact_model import ContactModel, Stage
from wearlaw.models.law import Law, WearLaw
from wearlaw.models.model import Model
from wearlaw.text_files import beside, read_toml

if TYPE_CHECKING:
    from pydantic import GetJsonSchemaHandler
    from pydantic_core import core_schema


def is_law_file(name: str) -> bool:
    """Return whether the name of a law is the path of a file of a law, such as "fit/law.toml"."""
    return name.endswith(".toml")


def read_law(path: str | os.PathLike[str]) -> Law:
    """Return the law of the table ``[wear_law]`` or ``[law]`` in a TOML file.

    Parameters
    ----------
    path : str or path-like
        A file such as `Fit.to_toml` writes: ``model`` names the law, and its fields follow.

    Raises
    ------
    InputError
        If the file is missing, is not TOML, or does not describe a law of an installed plugin.
    """
    contents = read_toml("law", path)
    fields = contents.get("wear_law", contents.get("law"))
    if not isinstance(fields, dict) or not isinstance(fields.get("model"), str):
        raise InputError(
            f'law {shown(Path(path))} needs a table [wear_law] with the name of the law, as in model = "usfd"'
        )
    try:
        return loader.law(fields.pop("model"), **fields)
    except ConfigurationError as error:
        raise InputError(with_problems(f"law {shown(Path(path))} is wrong in:", error.problems)) from None


def specification(model: Model) -> dict[str, Any]:
    """Return a model as a table of its name and fields; the table makes an equal model.

    The name of a law that was looked up as a parameter set is that of the set.
    """
    key = "type" if model.kind == "rig" else "model"
    fields = model.model_dump(mode="json", exclude_none=True)
    name = known_name(model)
    if name is not None and name in loader.installed("parameter set") and loader.wear_law(name, **fields) == model:
        return {key: name, **fields}
    return {key: loader.discovered()[model.kind].name_of(model.name, type(model)), **fields}


def _maker(look_up: Callable[..., Model]) -> BeforeValidator:
    """Return what makes a model of its name or of a table."""

    def make(value: Any) -> Any:
        options = {"model": value} if isinstance(value, str) else value
        if not isinstance(options, dict):
            return value
        options = dict(options)
        name = options.pop("model", None)
        if not isinstance(name, str):
            raise InputError('a model needs its name, as in {model = "exact"}')
        if is_law_file(name):
            return read_law(beside(name)).model_copy(update=options)
        return look_up(name, **options)

    return BeforeValidator(make)


def _material(value: Any) -> Any:
    return loader.material(value) if isinstance(value, str) else value


class _OrName:
    """Adds to a field's JSON Schema that a name and a table with a type are valid too."""

    @staticmethod
    def __get_pydantic_json_schema__(
        schema: core_schema.CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, object]:
        typed = {"type": "object", "properties": {TYPE: {"type": "string"}}, "required": [TYPE]}
        return {"anyOf": [handler(schema), typed, {"type": "string"}]}


MaterialField = Annotated[Material, BeforeValidator(_material), _OrName]
"""A field that takes a material, its name, or a table of its fields, with its class or its name as `type`."""

_AS_TABLE = PlainSerializer(specification, return_type=dict[str, Any], when_used="json")
_SCHEMA = WithJsonSchema({"anyOf": [{"type": "string"}, {"type": "object", "required": ["model"]}]}, mode="validation")


def _rig(value: Any) -> Any:
    if isinstance(value, str):
        return loader.rig(value)
    if not isinstance(value, Mapping):
        return value
    table = dict(value)
    if {"type", "preset"} <= table.keys():
        raise ConfigurationError("rig", [Fault(("preset",), "stands beside a type; keep one of them")])
    if "type" in table:
        return _named("rig", "type", table.pop("type"))(**table)
    if "preset" in table:
        preset = _named("preset", "preset", table.pop("preset"))
        fields = preset_fields(preset)(**table)
        return preset.make(**{name: getattr(fields, name) for name in fields.model_fields_set})
    rigs, presets = loader.installed("rig"), loader.discovered()["preset"].items()
    fitting = [name for name, rig in rigs.items() if table and table.keys() <= rig.model_fields.keys()]
    raise InputError(
        f'needs a type, such as type = "{[*fitting, *rigs][0]}". Installed: {", ".join(rigs)}; or a preset:'
        f" {', '.join(presets)}"
    )


def _named(kind: str, key: str, name: Any) -> Any:
    try:
        return loader.discovered().find(kind, name)
    except InputError as error:
        raise ConfigurationError("rig", [Fault((key,), str(error))]) from None


def preset_fields(preset: Preset) -> type[Configuration]:
    """Return a record of the arguments of a preset's function, checked by their annotations."""
    annotations, docs = get_type_hints(preset.make, include_extras=True), field_docstrings(preset.rig)
    parameters = inspect.signature(preset.make).parameters.items()
    fields: dict[str, Any] = {
        name: (
            annotations.get(name, Any),
            Field(
                ... if parameter.default is parameter.empty else parameter.default, description=docs.get(name) or None
            ),
        )
        for name, parameter in parameters
    }
    return create_model("preset", __base__=Configuration, **fields)


RIG = (BeforeValidator(_rig), _AS_TABLE, _SCHEMA)
"""Annotations of a field that takes a rig, its name, or a table with its `type` or `preset`."""

ContactModelField = Annotated[ContactModel, _maker(loader.contact_model), _AS_TABLE, _SCHEMA]
"""A field that takes a contact model, its name, or a table of its name and options."""

StageField = Annotated[Stage, _maker(loader.stage), _AS_TABLE, _SCHEMA]
"""A field that takes a stage, its name, or a table of its name and options."""

LawField = Annotated[Law, _maker(loader.law), _AS_TABLE, _SCHEMA]
"""A field that takes a law of any outcome, its name, or a table of its name and options."""

WearLawField = Annotated[WearLaw, _maker(loader.wear_law), _AS_TABLE, _SCHEMA]
"""A field that takes a wear law, its name, or a table of its name and options."""
