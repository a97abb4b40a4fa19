"""Case files: a study written down in TOML, with units.

A case names a rig, contact models, wear laws, and the operating points at which every pair of them is
evaluated. `load_case` reads one from a file, or by the name of a case that is shipped with the package.
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
import pint
from pydantic import BeforeValidator, Field, model_validator

from wearlaw import plugins
from wearlaw.arrays import Array
from wearlaw.conditions import CREEPAGE
from wearlaw.configuration import Configuration, known_as
from wearlaw.errors import CaseError, ConfigurationError, InputError, did_you_mean
from wearlaw.grid import Grid
from wearlaw.models import Model
from wearlaw.rig import Disc, TwinDisc
from wearlaw.specification import ContactModelField, MaterialField, WearLawField
from wearlaw.units import Length, Quantity, Speed, Unit, coefficient, scalar_si, text_of


class Measurement(Configuration):
    """Measured traction, to be shown beside the predicted one.

    It is given as `traction_coefficient`, or as the `frictional_heat` of tests under one `normal_force`, which is
    T ξ V.
    """

    label: str
    """What the legend calls it."""
    source: str
    """Where the numbers come from."""
    creepage: tuple[str, ...]
    """Creepage of each test."""
    traction_coefficient: tuple[float, ...] | None = None
    """T/N of each test [-]."""
    frictional_heat: tuple[str, ...] | None = None
    """Heat generated in each test [W]."""
    normal_force: Annotated[Quantity, Unit("N")] | None = None
    """Load of the tests whose heat is given [N]."""

    @model_validator(mode="after")
    def _complete(self) -> Measurement:
        given = self.frictional_heat if self.traction_coefficient is None else self.traction_coefficient
        if given is None or (self.traction_coefficient is not None and self.frictional_heat is not None):
            raise ValueError("give either traction_coefficient or frictional_heat")
        if (self.frictional_heat is None) != (self.normal_force is None):
            raise ValueError("normal_force belongs to frictional_heat: give both or none")
        if not given:
            raise ValueError("creepage is empty; give at least one test")
        if len(given) != len(self.creepage):
            raise ValueError(f"there are {len(self.creepage)} values of creepage, but {len(given)} measured ones")
        self.points(TwinDisc.suros())
        return self

    def points(self, rig: TwinDisc) -> tuple[Array, Array]:
        """Return the creepage [-] and the traction coefficient [-] of each test."""
        creepage = np.array([float(CREEPAGE.si(text, "creepage")) for text in self.creepage])
        if self.traction_coefficient is not None:
            return creepage, coefficient(self.traction_coefficient, "traction_coefficient")
        heat = np.array([float(Unit("W").si(text, "frictional_heat")) for text in self.frictional_heat or ()])
        if self.normal_force is None or not (creepage > 0).all():
            raise InputError("creepage: traction follows from frictional heat only where the creepage is positive")
        slip_speed = creepage * scalar_si(rig.rolling_speed, "m/s")
        return creepage, heat / (slip_speed * scalar_si(self.normal_force, "N"))


class Preset(Configuration):
    """A rig that starts from a known one, with some of its values overridden; see `TwinDisc.suros`."""

    preset: Literal["suros"]
    """The rig to start from."""
    diameter: Length | None = None
    """Diameter of both discs [m]."""
    material: MaterialField | None = None
    """Material of both discs."""
    disc_1: Disc | None = None
    """The wheel disc, whole."""
    disc_2: Disc | None = None
    """The rail disc, whole."""
    track_width: Length | None = None
    """Width of the running track [m]."""
    rotational_speed: Annotated[Quantity, Unit("rpm")] | None = None
    """Speed of disc 1 [rad/s], from which the rolling speed follows."""
    rolling_speed: Speed | None = None
    """Rolling speed [m/s]."""

    def rig(self) -> TwinDisc:
        """Return the rig."""
        given = {name: value for name, value in self if value is not None and name != "preset"}
        return TwinDisc.suros(**given)


def _rig(value: Any) -> Any:
    if not isinstance(value, (dict, TwinDisc)):
        raise InputError(f'must be a table, such as {{preset = "suros"}}; got {value!r}')
    return Preset(**value).rig() if isinstance(value, dict) and "preset" in value else value


def _models(value: Any) -> Any:
    if not (isinstance(value, (list, tuple)) and value):
        raise InputError(f"must be a list of names, or of tables with a name and options; got {value!r}")
    return value


ModelList = (BeforeValidator(_models), Field(json_schema_extra={"minItems": 1}))


class Case(Configuration):
    """A study: a rig, contact models and wear laws, and where to evaluate every pair of them."""

    title: str
    """What the study is called in its results."""
    plugins: dict[str, str] = Field(default_factory=dict)
    """The distributions that the case needs, each with a version range such as ">=1.2,<2"; "" for any version."""
    rig: Annotated[TwinDisc, BeforeValidator(_rig)]
    """The test rig; `preset = "suros"` starts from that rig and overrides what else is given."""
    contact_models: Annotated[tuple[ContactModelField, ...], *ModelList]
    """The contact models, each a name or a table of its name and options."""
    wear_laws: Annotated[tuple[WearLawField, ...], *ModelList]
    """The wear laws, likewise."""
    sweeps: Annotated[dict[str, Grid], Field(min_length=1)]
    """Grids of operating points, each under a name."""
    profiles: dict[str, Grid] = Field(default_factory=dict)
    """Single operating points at which stresses and slip along the patch are shown, each under a name."""
    measured: Measurement | None = None
    """Measured traction."""

    @model_validator(mode="before")
    @classmethod
    def _has_its_plugins(cls, fields: Any) -> Any:
        """Say that a plugin is missing before anything else fails for lack of it."""
        if isinstance(fields, dict):
            needed = fields.get("plugins", {})
            if isinstance(needed, dict):
                plugins.require({str(name): str(versions) for name, versions in needed.items()})
        return fields

    @model_validator(mode="after")
    def _consistent(self) -> Case:
        for kind, names in (("sweeps", self.sweeps), ("profiles", self.profiles)):
            for name in names:
                if not name.isidentifier():
                    raise ValueError(f"{kind}: the name '{name}' must be made of letters, digits and underscores")
        for name, profile in self.profiles.items():
            if profile.axes():
                raise ValueError(f"profiles.{name}: a profile is at one operating point; give each condition one value")
        labels(self.contact_models)
        labels(self.wear_laws)
        return self


def labels(models: Sequence[Model]) -> list[str]:
    """Return a short name for each model: its own, with the options that tell it from others of that name."""
    found = []
    for model in models:
        namesakes = [other for other in models if other.name == model.name]
        if sum(other == model for other in namesakes) > 1:
            raise InputError(f"the model {model.name} is listed twice; leave one out, or give it other options")
        options = [f"{field}={_shown(getattr(model, field))}" for field in _telling_apart(namesakes)]
        found.append(f"{model.name}({', '.join(options)})" if options else model.name)
    return found


def _telling_apart(models: Sequence[Model]) -> list[str]:
    """Return the fewest fields, in their order, by which different models of one name differ."""
    fields: list[str] = []
    kinds: set[tuple[str, ...]] = {()}
    for field in type(models[0]).model_fields:
        finer = {tuple(_shown(getattr(model, name)) for name in (*fields, field)) for model in models}
        if len(finer) > len(kinds):
            fields, kinds = [*fields, field], finer
    return fields


def _shown(value: Any) -> str:
    return text_of(value) if isinstance(value, pint.Quantity) else str(value)


def case_text(name_or_path: str) -> str:
    """Return the text of a case file, or of the case that a plugin ships under that name.

    Raises
    ------
    CaseError
        If there is neither.
    UnknownModelError
        If several plugins ship a case of that name.
    """
    found = plugins.installed()
    known = found.cases.items()
    if name_or_path in found.cases.providers:
        return found.cases.find(name_or_path, found.broken)
    try:
        return Path(name_or_path).read_text(encoding="utf-8")
    except FileNotFoundError:
        hint = did_you_mean(name_or_path, known)
        raise CaseError(f"there is no case file '{name_or_path}';{hint} Shipped cases: {', '.join(known)}") from None
    except (OSError, UnicodeDecodeError) as error:
        raise CaseError(f"cannot read the case file '{name_or_path}': {error}") from None


def case_schema() -> dict[str, Any]:
    """Return the JSON Schema of a case file, with the options of all installed models."""
    schema = Case.model_json_schema(by_alias=True)
    definitions = schema["$defs"]
    kinds: dict[str, Mapping[str, type[Model]]] = {
        "contact_models": plugins.contact_models(),
        "wear_laws": plugins.wear_laws(),
    }
    for field, models in kinds.items():
        tables = [_model_schema(name, model, definitions) for name, model in models.items()]
        schema["properties"][field]["items"] = {"anyOf": [{"enum": list(models)}, *tables]}
    schema["properties"]["wear_laws"]["items"]["anyOf"] += [
        choice
        for name, law in plugins.parameter_sets().items()
        for choice in ({"const": name}, {**_model_schema(name, type(law), definitions), "required": ["model"]})
    ]
    preset = Preset.model_json_schema()
    definitions.update(preset.pop("$defs", {}))
    schema["properties"]["rig"] = {"anyOf": [{"$ref": "#/$defs/TwinDisc"}, preset]}
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **schema}


def _model_schema(name: str, model: type[Model], definitions: dict[str, Any]) -> dict[str, Any]:
    """Return the schema of the table that configures a model; a model's own definitions join the others."""
    table = model.model_json_schema(ref_template=f"#/$defs/{name}.{{model}}")
    definitions.update({f"{name}.{key}": value for key, value in table.pop("$defs", {}).items()})
    table["properties"] = {"model": {"const": name}, **table.get("properties", {})}
    table["required"] = ["model", *(field for field in table.get("required", []) if not _published(model, field))]
    return table


def _published(model: type[Model], field: str) -> bool:
    """Return whether a field without a default gets its value from what the model's source publishes."""
    try:
        return hasattr(model(), field)
    except InputError:
        return False


def load_case(name_or_path: str) -> Case:
    """Return the case of a TOML file, or a shipped one by its name.

    Raises
    ------
    CaseError
        If the file is missing, is not TOML, or has wrong fields, which the message names by their paths.
    """
    text = case_text(name_or_path)
    try:
        case = Case(**tomllib.loads(text))
    except tomllib.TOMLDecodeError as error:
        raise CaseError(f"case '{name_or_path}' is not valid TOML: {error}") from None
    except ConfigurationError as error:
        raise CaseError(f"case '{name_or_path}' is wrong in:" + "".join(f"\n  {p}" for p in error.problems)) from None
    return known_as(name_or_path, case) if name_or_path in plugins.installed().cases.providers else case
