"""Fields that hold a model: a name or a table in a file, an instance in Python."""

from __future__ import annotations

import inspect
import warnings
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Annotated, Any, get_type_hints

from pydantic import BeforeValidator, Field, PlainSerializer, WithJsonSchema, create_model

from wearlaw.contact.material import TYPE, Material
from wearlaw.errors import (
    ConfigurationError,
    Fault,
    InputError,
    PluginWarning,
    WearlawError,
    described,
    did_you_mean,
    shown,
)
from wearlaw.models.contact_model import ContactModel, Stage
from wearlaw.models.law import Law, WearLaw
from wearlaw.models.model import Model
from wearlaw.plugins import loader
from wearlaw.plugins.law_files import is_law_file, read_law
from wearlaw.settings.configuration import Configuration, known_name
from wearlaw.settings.docstrings import field_docstrings
from wearlaw.settings.text_files import beside

if TYPE_CHECKING:
    from pydantic import GetJsonSchemaHandler
    from pydantic_core import core_schema


RIGS = "rig"
"""The kind of models that a file names with `type` instead of `model`."""


def _is_rig(value: object) -> bool:
    return isinstance(value, Model) and value.kind == RIGS


def specification(model: Model) -> dict[str, Any]:
    """Return a model as a table of its name and fields; the table makes an equal model.

    The name of a law that was looked up as a parameter set is that of the set.
    """
    key = "type" if model.kind == RIGS else "model"
    fields = model.model_dump(mode="json", exclude_none=True)
    known = known_name(model)
    if known is not None and known in loader.parameter_sets() and loader.wear_law(known, **fields) == model:
        return {key: known, **fields}
    return {key: model.name, **fields}


def _maker(look_up: Callable[..., Model]) -> Callable[[Any], Any]:
    def make(value: Any) -> Any:
        options = {"model": value} if isinstance(value, str) else value
        if not isinstance(options, dict):
            return value
        options = dict(options)
        name = options.pop("model", None)
        if not isinstance(name, str):
            raise InputError('a model needs its name, as in {model = "exact"}')
        if is_law_file(name):
            return read_law(beside(name)).changed(**options)
        return look_up(name, **options)

    return make


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
    if isinstance(value, dict):
        return _rig_of_table(value)
    if isinstance(value, str):
        if value not in loader.rigs() and value in known_presets():
            raise InputError(f'{shown(value)} is a preset; write {{preset = "{value}"}}')
        return loader.rig(value)
    if not _is_rig(value):
        raise InputError(f"must be a rig, its name, or a table of its name and fields; got {shown(value)}")
    return value


def _rig_of_table(table: Mapping[str, Any]) -> Any:
    """Return the rig of a table with `type`, `preset` or both, and fields."""
    given = {name: value for name, value in table.items() if name not in ("type", "preset")}
    kind, preset = table.get("type"), table.get("preset")
    if kind is None and preset is None:
        raise InputError(_without_type(given))
    for name, value in (("type", kind), ("preset", preset)):
        if not isinstance(value, str | None):
            raise ConfigurationError("rig", [Fault((name,), f"must be a name, got {shown(value)}")])
    if preset is None:
        found = loader.installed()
        try:
            rig = found.rigs.find(str(kind), found.broken)
        except InputError as error:
            raise ConfigurationError("rig", [Fault(("type",), str(error))]) from None
        return rig(**given)
    return _of_preset(kind, preset, given)


def _without_type(given: Mapping[str, Any]) -> str:
    """Return the message for a table without a type; it suggests a type with these fields first."""
    rigs, presets = loader.rigs(), ", ".join(known_presets())
    fitting = [name for name, rig in rigs.items() if given and given.keys() <= rig.model_fields.keys()]
    text = f'needs a type, such as type = "{[*fitting, *rigs][0]}". Installed: {", ".join(rigs)}'
    return f"{text}; or a preset: {presets}" if presets else text


def known_presets() -> dict[str, list[type[Any]]]:
    """Return for each preset, by its name, the rigs that have it."""
    found: dict[str, list[type[Any]]] = {}
    for rig in loader.rigs().values():
        try:
            names = [str(name) for name in rig.presets()]
        except Exception as error:
            warnings.warn(f"presets of rig '{rig.name}' are left out: {described(error)}", PluginWarning, stacklevel=2)
            continue
        for name in names:
            found.setdefault(name, []).append(rig)
    return found


def _of_preset(kind: str | None, preset: str, given: Mapping[str, Any]) -> Any:
    """Return the rig of a preset, with some of its arguments given."""
    presets = {
        name: rigs
        for name, every in known_presets().items()
        if (rigs := [rig for rig in every if kind is None or rig.name == kind])
    }
    if len(presets.get(preset, [])) != 1:
        raise ConfigurationError("rig", [_no_preset(kind, preset, presets)])
    (rig,) = presets[preset]
    make = rig.presets()[preset]
    try:
        fields = preset_fields(rig, preset)(**given)
        made = make(**{name: getattr(fields, name) for name in fields.model_fields_set})
    except WearlawError:
        raise
    except Exception as error:
        raise InputError(f"preset {shown(preset)} of rig '{rig.name}' failed: {described(error)}") from error
    if not _is_rig(made):
        raise InputError(f"preset {shown(preset)} of rig '{rig.name}' must return a rig, got {shown(made)}")
    return made


def _no_preset(kind: str | None, preset: str, presets: Mapping[str, list[type[Any]]]) -> Fault:
    if preset in presets:
        names = " and ".join(rig.name for rig in presets[preset])
        return Fault(("preset",), f"{shown(preset)} is a preset of {names}; add the type")
    if kind is not None and kind not in loader.rigs():
        rigs = loader.rigs()
        return Fault(
            ("type",), f"no rig is called {shown(kind)}{did_you_mean(kind, rigs)} Installed: {', '.join(rigs)}"
        )
    of = f"rig {shown(kind)} has no preset" if kind else "no rig has a preset"
    known = ", ".join(presets) or "none"
    return Fault(("preset",), f"{of} {shown(preset)}{did_you_mean(preset, presets)} There are: {known}")


def preset_fields(rig: type[Any], preset: str) -> type[Configuration]:
    """Return a record of the arguments of a preset's function, checked by their annotations."""
    make = rig.presets()[preset]
    annotations, docs = get_type_hints(make, include_extras=True), field_docstrings(rig)
    fields: dict[str, Any] = {}
    open_ended = False
    for name, one in inspect.signature(make).parameters.items():
        if one.kind in (one.VAR_POSITIONAL, one.VAR_KEYWORD):
            open_ended |= one.kind is one.VAR_KEYWORD
            continue
        default = ... if one.default is one.empty else one.default
        fields[name] = annotations.get(name, Any), Field(default, description=docs.get(name) or None)
    base = OpenPreset if open_ended else Configuration
    return create_model(preset, __base__=base, **fields)


class OpenPreset(Configuration, extra="allow"):
    """A preset with a function that takes any keyword."""


RIG = (BeforeValidator(_rig), _AS_TABLE, _SCHEMA)
"""Annotations of a field that takes a rig, its name, or a table with its `type` or `preset`."""

ContactModelField = Annotated[
    ContactModel,
    BeforeValidator(_maker(loader.contact_model)),
    _AS_TABLE,
    _SCHEMA,
]
"""A field that takes a contact model, its name, or a table of its name and options."""

StageField = Annotated[
    Stage,
    BeforeValidator(_maker(loader.stage)),
    _AS_TABLE,
    _SCHEMA,
]
"""A field that takes a stage, its name, or a table of its name and options."""

LawField = Annotated[
    Law,
    BeforeValidator(_maker(loader.law)),
    _AS_TABLE,
    _SCHEMA,
]
"""A field that takes a law of any outcome, its name, or a table of its name and options."""

WearLawField = Annotated[
    WearLaw,
    BeforeValidator(_maker(loader.wear_law)),
    _AS_TABLE,
    _SCHEMA,
]
"""A field that takes a wear law, its name, or a table of its name and options."""
