"""Fields that hold a model: written as a name or a table in a file, an instance in Python."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Annotated, Any

from pydantic import BeforeValidator, PlainSerializer, WithJsonSchema

from wearlaw import plugins
from wearlaw.base_rig import Rig
from wearlaw.errors import InputError
from wearlaw.material import Material
from wearlaw.models import WearLaw
from wearlaw.tangential import ContactModel, Model
from wearlaw.units import shortened

if TYPE_CHECKING:
    from pydantic import GetJsonSchemaHandler
    from pydantic_core import core_schema


def specification(model: Model) -> dict[str, Any]:
    """Return a model as a table of its name and fields, from which it can be made again."""
    return {_key(model): model.name, **model.model_dump(mode="json", exclude_none=True)}


def _key(model: Model) -> str:
    return "type" if isinstance(model, Rig) else "model"


NEEDED = {
    "type": 'rig needs its name, as in {type = "twin_disc"}',
    "model": 'model needs its name, as in {model = "exact"}',
}
"""What is said of a table without a name."""


def _maker(look_up: Callable[..., Model], key: str = "model") -> Callable[[Any], Any]:
    def make(value: Any) -> Any:
        if isinstance(value, str):
            return look_up(value)
        if isinstance(value, dict):
            options = dict(value)
            name = options.pop(key, None)
            if not isinstance(name, str):
                raise InputError(f"a {NEEDED[key]}")
            return look_up(name, **options)
        return value

    return make


def _material(value: Any) -> Any:
    return plugins.material(value) if isinstance(value, str) else value


class _OrName:
    """Adds to a field's JSON Schema that a name will do."""

    @staticmethod
    def __get_pydantic_json_schema__(
        schema: core_schema.CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, object]:
        return {"anyOf": [handler(schema), {"type": "string"}]}


MaterialField = Annotated[Material, BeforeValidator(_material), _OrName]
"""A field that takes a material, its name, or a table of its fields."""

_AS_TABLE = PlainSerializer(specification, return_type=dict[str, Any], when_used="json")
_SCHEMA = WithJsonSchema({"anyOf": [{"type": "string"}, {"type": "object", "required": ["model"]}]}, mode="validation")


def _rig(value: Any) -> Any:
    if not isinstance(value, str | dict | Rig):
        raise InputError(f"must be a rig, its name, or a table of its name and fields; got {shortened(value)}")
    return _maker(plugins.rig, "type")(value)


RigField = Annotated[Rig, BeforeValidator(_rig), _AS_TABLE, _SCHEMA]
"""A field that takes a rig, its name, or a table of its name, as `type`, and fields."""

ContactModelField = Annotated[
    ContactModel,
    BeforeValidator(_maker(plugins.contact_model)),
    _AS_TABLE,
    _SCHEMA,
]
"""A field that takes a contact model, its name, or a table of its name and options."""

WearLawField = Annotated[
    WearLaw,
    BeforeValidator(_maker(plugins.wear_law)),
    _AS_TABLE,
    _SCHEMA,
]
"""A field that takes a wear law, its name, or a table of its name and options."""
