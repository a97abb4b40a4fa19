"""The frozen pydantic base class of models, materials, rigs, pipelines and cases."""

from __future__ import annotations

import ast
import inspect
import textwrap
from functools import cache
from itertools import pairwise
from threading import RLock
from types import NoneType
from typing import TYPE_CHECKING, Annotated, Any, Self, TypeVar, get_args, get_origin

import pint
from pydantic import BaseModel, ConfigDict, ValidationError, field_validator
from pydantic.errors import PydanticSchemaGenerationError
from pydantic.json_schema import GenerateJsonSchema

from wearlaw.errors import ConfigurationError, Fault, FrozenError, ModelError, did_you_mean, shown
from wearlaw.units.quantities import Unit, plain_number, text_of
from wearlaw.units.usual import OneWarning

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping
    from inspect import Signature

    from pydantic import GetJsonSchemaHandler, ValidationInfo
    from pydantic_core import CoreSchema, ErrorDetails

LINE = 100
"""Most characters on a line of a record or a pipeline that is shown."""

ConfigurationT = TypeVar("ConfigurationT", bound="Configuration")


class _Schema(GenerateJsonSchema):
    """JSON Schema in which a default that is a quantity is its text, as in a file."""

    def encode_default(self, dft: Any) -> Any:
        return text_of(dft) if isinstance(dft, pint.Quantity) else super().encode_default(dft)


class Configuration(BaseModel):
    """A frozen, hashable, picklable record of settings; making one raises an error that names every wrong field.

    Quantities serialise to text with a unit (``model_dump(mode="json")``). Validating that text gives an equal record.
    """

    model_config = ConfigDict(
        frozen=True,
        extra="forbid",
        allow_inf_nan=False,
        validate_default=True,
        defer_build=True,
        ser_json_inf_nan="strings",
    )

    @classmethod
    def model_json_schema(cls, *args: Any, **options: Any) -> dict[str, Any]:
        """Return the JSON Schema of the record, with text for quantities."""
        return super().model_json_schema(*args, **{"schema_generator": _Schema, **options})

    @classmethod
    def __get_pydantic_json_schema__(cls, schema: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        reference = handler(schema)
        properties = handler.resolve_ref_schema(reference).get("properties", {})
        for name, text in field_docstrings(cls).items():
            for key in {name, cls.model_fields[name].alias} & properties.keys():
                properties[key] |= {"description": text} if text else {}
        return reference

    @field_validator("*", mode="before")
    @classmethod
    def _ratios_as_numbers(cls, value: Any, info: ValidationInfo) -> Any:
        """Take a ratio such as "30 %" in a field without a unit, and refuse a value with a dimension."""
        field = cls.model_fields.get(info.field_name or "")
        return plain_number(value) if field is not None and _is_number(field.annotation) else value

    if not TYPE_CHECKING:  # checkers keep the signature that pydantic derives from the fields

        @classmethod
        def __pydantic_init_subclass__(cls, **options: Any) -> None:
            super().__pydantic_init_subclass__(**options)
            if not cls.__pydantic_complete__:
                cls.__signature__ = _Signature()

        @classmethod
        def model_rebuild(cls, *, _parent_namespace_depth: int = 2, **options: Any) -> bool | None:
            """Build the validators, in one thread at a time; pydantic does so at the first use if nobody calls this.

            Raises
            ------
            ModelError
                If a field holds quantities without a unit, or has another type that pydantic does not know.
            """
            with _BUILDING:  # pydantic before 2.14 has no lock of its own
                try:
                    return super().model_rebuild(_parent_namespace_depth=_parent_namespace_depth + 1, **options)
                except PydanticSchemaGenerationError as error:
                    raise ModelError(_unknown_type(cls, error)) from None

        def __init__(self, /, **fields: Any) -> None:
            with OneWarning() as unusual:
                try:
                    super().__init__(**fields)
                except ValidationError as error:
                    raise configuration_error(type(self).subject(), type(self), error) from None
                unusual |= unusual_fields(self)

        @classmethod
        def model_validate(cls, obj: Any, **options: Any) -> Self:
            """Return the record for a table of its fields."""
            try:
                return super().model_validate(obj, **options)
            except ValidationError as error:
                raise configuration_error(cls.subject(), cls, error) from None

        @classmethod
        def model_validate_json(cls, json_data: str | bytes | bytearray, **options: Any) -> Self:
            """Return the record for a text from `model_dump_json`."""
            try:
                return super().model_validate_json(json_data, **options)
            except ValidationError as error:
                raise configuration_error(cls.subject(), cls, error) from None

        def __setattr__(self, name: str, value: Any) -> None:
            try:
                super().__setattr__(name, value)
            except ValidationError:
                raise FrozenError(
                    f"{self.subject()}: {name}: cannot be changed, since it is frozen; make a changed copy with"
                    f" .model_copy(update={{{shown(name)}: ...}})"
                ) from None

    @classmethod
    def subject(cls) -> str:
        """Return the name of this configuration in messages."""
        return cls.__name__

    def model_copy(self, *, update: Mapping[str, Any] | None = None, deep: bool = False) -> Self:  # noqa: ARG002
        """Return a copy with some fields changed, checked like a new record; cached values are not copied.

        `deep` makes no difference, because nothing in a configuration can change.
        """
        aliases = {name: field.alias or name for name, field in type(self).model_fields.items()}
        fields = {alias: getattr(self, name) for name, alias in aliases.items()} | (self.model_extra or {})
        with OneWarning() as unusual:
            copy = type(self)(**fields | {aliases.get(name, name): value for name, value in (update or {}).items()})
            for subject in unusual_fields(self):  # their warning came with this record
                if subject.rpartition(": ")[2] not in (update or {}):
                    unusual.pop(subject, None)
        return copy

    def __str__(self) -> str:
        return repr(self)

    def __repr__(self) -> str:
        text = f"{type(self).__name__}("
        for name, value in self.__repr_args__():
            field = f"{name}={text_of(value) if isinstance(value, pint.Quantity) else repr(value)}"
            start = text.rfind("\n") + 1
            if len(text) - start + len(field.partition("\n")[0]) >= LINE and text[start:].strip():
                text = text.rstrip() + "\n    "
            text += f"{field}, "
        return text.removesuffix(", ") + ")"


def _unknown_type(cls: type[BaseModel], error: PydanticSchemaGenerationError) -> str:
    """Return the message for a class whose fields have types without a schema."""
    for name, field in cls.model_fields.items():
        if not any(isinstance(part, Unit) for part in field.metadata) and _is_plain_quantity(field.annotation):
            return (
                f"{cls.__name__}.{name}: its annotation has no unit; write {name}: Annotated[wl.Quantity, wl.Unit(...)]"
                ' with the customary unit, such as wl.Unit("mm"), and a default such as wl.Q(1, "mm")'
            )
    return f"{cls.__name__}: a field has a type that pydantic cannot check; {str(error).partition('. Set')[0]}"


def _is_plain_quantity(annotation: Any) -> bool:
    """Return whether a type is `Quantity`, or a union with it, without a `Unit`."""
    if isinstance(annotation, type):
        return issubclass(annotation, pint.Quantity)
    if get_origin(annotation) is Annotated and any(isinstance(part, Unit) for part in annotation.__metadata__):
        return False
    return any(map(_is_plain_quantity, get_args(annotation)))


def _is_number(annotation: Any) -> bool:
    """Return whether a field holds a float, or a float or None."""
    if annotation is float:
        return True
    inner = get_args(annotation)
    if get_origin(annotation) is Annotated:
        return _is_number(inner[0])
    return len(inner) == 2 and inner[1] is NoneType and _is_number(inner[0])


def unusual_fields(record: Configuration) -> dict[str, str]:
    """Return the fields of a record whose values are unusual, each with what a warning says of it."""
    texts = {}
    for name, unit in _usual_fields(type(record)).items():
        value = getattr(record, name)
        if isinstance(value, pint.Quantity | float) and (text := unit.unusual(name, value)):
            texts[f"{record.subject()}: {name}"] = text
    return texts


@cache
def _usual_fields(cls: type[BaseModel]) -> dict[str, Unit]:
    """Return the units of the fields that state what is usual."""
    units = {name: _unit((*field.metadata, field.annotation)) for name, field in cls.model_fields.items()}
    return {name: unit for name, unit in units.items() if unit is not None and unit.usual is not None}


def _unit(annotations: Iterable[Any]) -> Unit | None:
    """Return the first unit among annotations and what they are made of."""
    for annotation in annotations:
        parts = (*getattr(annotation, "__metadata__", ()), *get_args(annotation))
        unit = annotation if isinstance(annotation, Unit) else _unit(parts)
        if unit is not None:
            return unit
    return None


_BUILDING = RLock()


class _Signature:
    """Signature of a class without validators; pydantic makes it from the fields when it builds the validators."""

    def __get__(self, instance: object, owner: type[BaseModel]) -> Signature:
        if instance is None and owner.model_rebuild(raise_errors=False) is not False:
            return owner.__signature__
        raise AttributeError("__signature__")


def field_docstrings(model: type[BaseModel]) -> dict[str, str]:
    """Return the docstring of each field: its `description`, or else the string literal below it, or else "".

    Pydantic can read these literals too, but it does so as it makes a class, which then takes three times as long. An
    inherited field has the docstring of its last annotation. There are no string literals if the source is not in a
    file, as in a notebook.
    """
    texts = {name: text for base in reversed(model.__mro__) for name, text in item_docstrings(base).items()}
    return {name: field.description or texts.get(name, "") for name, field in model.model_fields.items()}


@cache
def item_docstrings(cls: type) -> dict[str, str]:
    """Return the string literal below each name annotated in the body of a class, or ""; {} without the source."""
    if not vars(cls).get("__annotations__"):
        return {}
    try:
        (statement,) = ast.parse(textwrap.dedent(inspect.getsource(cls))).body
    except (OSError, TypeError, SyntaxError):
        return {}
    texts = {}
    for annotated, below in pairwise([*getattr(statement, "body", ()), ast.Pass()]):
        match annotated, below:
            case ast.AnnAssign(target=ast.Name(id=name)), ast.Expr(value=ast.Constant(value=str(text))):
                texts[name] = inspect.cleandoc(text)
            case ast.AnnAssign(target=ast.Name(id=name)), _:
                texts[name] = ""
    return texts


def known_as(name: str, record: ConfigurationT) -> ConfigurationT:
    """Return an equal record that remembers its name in the look-up; changed copies forget the name."""
    copy = record.model_copy()
    vars(copy)["_known_as"] = name
    return copy


def known_name(record: Configuration) -> str | None:
    """Return the name under which a record was looked up, or None if it was not looked up."""
    return vars(record).get("_known_as")


def configuration_error(subject: str, model: type[BaseModel], error: ValidationError) -> ConfigurationError:
    """Return a pydantic error as a wearlaw error, in the words of the user."""
    problems: list[Fault] = []
    for details in error.errors(include_url=False):
        path = tuple(str(part) for part in details["loc"])
        cause = details.get("ctx", {}).get("error")
        if isinstance(cause, ConfigurationError):
            problems += [Fault(path + inner.path, inner.message) for inner in cause.problems]
        else:
            field = model.model_fields.get(path[0]) if len(path) == 1 else None
            of_class = field is not None and field.default is details["input"]
            problems.append(Fault(path, f"{'its default: ' if of_class else ''}{_message(details, model)}"))
    return ConfigurationError(subject, problems)


def _message(details: ErrorDetails, model: type[BaseModel]) -> str:
    cause = details.get("ctx", {}).get("error")
    if isinstance(cause, Exception):
        return str(cause)
    if details["type"] == "extra_forbidden":
        names = [field.alias or name for name, field in model.model_fields.items()]
        hint = did_you_mean(str(details["loc"][-1]), names)
        return f"unknown field{hint} The fields are: {', '.join(names) or 'none'}"
    if details["type"] == "missing":
        return "is missing"
    tables = {"tuple_type": "list", "dict_type": "table", "model_type": "table"}
    if details["type"] in tables and not isinstance(details["input"], BaseModel):  # such as a law for a contact model
        return f"must be a {tables[details['type']]}, got {shown(details['input'])}"
    message = details["msg"]
    return f"{message[0].lower()}{message[1:]}, got {shown(details['input'])}"
