"""Case files: studies in TOML, with units.

A case names a rig, contact models with stages around them, laws, and the operating points at which every pair of a
contact model and a law is evaluated. `load_case` reads one from a file, or by the name of a case that a plugin ships.
"""

from __future__ import annotations

import os
import re
import textwrap
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cached_property
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Annotated, Any, TypeVar

import tomli_w
from packaging.specifiers import InvalidSpecifier, SpecifierSet
from pydantic import AfterValidator, Field, ValidationInfo, field_validator, model_validator

from wearlaw import loader
from wearlaw.configuration import Configuration, known_as
from wearlaw.contact.conditions import of_table
from wearlaw.errors import (
    CaseError,
    ConfigurationError,
    Fault,
    InputError,
    PluginWarning,
    described,
    did_you_mean,
    shown,
    warn,
    with_problems,
)
from wearlaw.fields import ContactModelField, LawField, StageField, preset_fields
from wearlaw.loader import Shelf
from wearlaw.models.contact_model import ContactModel
from wearlaw.models.law import WEAR, Law, Outcome
from wearlaw.models.model import Model
from wearlaw.pipeline.pipeline import Rig, RigField
from wearlaw.text_files import LARGEST, parse_toml, read_text, reading
from wearlaw.units.variables import UNITS
from wearlaw_apps.output.labels import labelled, labels
from wearlaw_apps.output.spreadsheets import without_formulas
from wearlaw_apps.studies.figure_spec import FigureSpec
from wearlaw_apps.studies.grid import Grid
from wearlaw_apps.studies.measured import MeasuredTests, check_rig

ModelT = TypeVar("ModelT", bound=Model)

CASE_FILE, TESTS_FILE = "case.toml", "tests.csv"
"""Names of the files that a run writes: its case, and its measured tests if they came from a file."""

MODELS = ("contact_models", "stages", "laws", "wear_laws")
"""The lists of models of a case."""


def _some(models: tuple[ContactModel, ...]) -> tuple[ContactModel, ...]:
    if not models:
        raise InputError('is empty; give at least one, as in contact_models = ["exact"]')
    return models


def _wear_law(law: Law) -> Law:
    if law.outcome.name != WEAR:
        raise InputError(f"{law.name} predicts {law.outcome.name}, not wear; list it under laws")
    return law


def _other_law(law: Law) -> Law:
    if law.outcome.name == WEAR:
        raise InputError(f"{law.name} predicts the wear rate; list it under wear_laws")
    return law


def _unmet(name: str, versions: str) -> str:
    """Return why a distribution does not meet a range of versions, or "" if it does."""
    try:
        allowed = SpecifierSet(versions)
    except InvalidSpecifier:
        return f"{shown(versions)} is not a version range; write one such as '>=1.2,<2'"
    try:
        installed = version(name)
    except PackageNotFoundError:
        return f"is not installed; install it with: pip install '{name}{versions}'"
    if allowed.contains(installed, prereleases=True):
        return ""
    return f"version {installed} is installed, but {versions} is needed"


def _section(name: str) -> str:
    loader.discovered().find("section", name)
    return name


class Case(Configuration):
    """A study: a rig, contact models, laws, and operating points at which every pair of a model and a law is evaluated.

    Stages, if given, stand around every contact model.
    """

    title: str
    """The title of the study in its results."""
    plugins: dict[str, str] = Field(default_factory=dict)
    """The distributions that the case needs, each with a version range such as ">=1.2,<2"; "" for any version."""
    rig: RigField
    """The rig: its `type` and fields, or a `preset` such as "suros" with the fields that differ."""
    contact_models: Annotated[
        tuple[ContactModelField, ...], AfterValidator(_some), Field(json_schema_extra={"minItems": 1})
    ]
    """The contact models, each a name or a table of its name and options."""
    stages: tuple[StageField, ...] = ()
    """Stages around every contact model, such as "patch_mean", likewise; the first one stands next to the model."""
    laws: tuple[Annotated[LawField, AfterValidator(_other_law)], ...] = ()
    """Laws of other outcomes than wear, such as damage by fatigue, likewise."""
    wear_laws: tuple[Annotated[LawField, AfterValidator(_wear_law)], ...] = ()
    """The wear laws, likewise; they can be left out if there are `laws`."""
    sweeps: Annotated[dict[str, Grid], Field(min_length=1)]
    """Grids of operating points, each under a name."""
    profiles: dict[str, Grid] = Field(default_factory=dict)
    """Single operating points at which the patch is shown, each under a name: stresses and slip along a line's patch,
    wear across an ellipse."""
    measured: MeasuredTests | None = None
    """Measured tests, to show beside the predictions."""
    sections: tuple[Annotated[str, AfterValidator(_section)], ...] = ()
    """The sections that plugins add to the report, by name."""
    figures: dict[str, FigureSpec] = Field(default_factory=dict)
    """The figures, each under the name of its file. Default: one of each kind for each sweep and profile."""
    main: str | None = None
    """The figure that the report begins with, one of the case or of its sections. Default: the main outcome of the
    first sweep."""

    @model_validator(mode="before")
    @classmethod
    def _can_be_read(cls, fields: Any) -> Any:
        """Check for missing plugins first, before something else fails without them, and for distributions."""
        tables = fields if isinstance(fields, dict) else {}
        needed = tables.get("plugins")
        named = needed.items() if isinstance(needed, dict) else ()
        unmet = {name: _unmet(name, str(versions)) for name, versions in named}
        wrong = [Fault(("plugins", name), fault) for name, fault in unmet.items() if fault]
        if "uncertainty" in tables:
            instead = "wl.uncertainty(case.rig | case.contact_models[0] | case.wear_laws[0], ...)"
            wrong.append(Fault(("uncertainty",), f"a case has no distributions; give them to {instead} in Python"))
        if wrong:
            raise ConfigurationError(cls.subject(), wrong)
        return fields

    @field_validator("wear_laws")
    @classmethod
    def _some_law(cls, laws: tuple[Law, ...], info: ValidationInfo) -> tuple[Law, ...]:
        if not laws and info.data.get("laws") == ():
            raise InputError(
                'is missing or empty; give at least one, as in wear_laws = ["usfd"], or laws of other outcomes than'
                " wear under laws"
            )
        return laws

    @field_validator("laws", "wear_laws")
    @classmethod
    def _of_known_bodies(cls, laws: tuple[Law, ...], info: ValidationInfo) -> tuple[Law, ...]:
        """Check the bodies of laws when the case is read; a rig need not name its bodies."""
        named = any(law.body is not None for law in laws)
        bodies = tuple(info.data["rig"].bodies) if named and "rig" in info.data else ()
        has = f"Its bodies are {' and '.join(bodies)}"
        wrong = [
            Fault((str(number), "body"), f"the rig has no body {shown(law.body)}{did_you_mean(law.body, bodies)} {has}")
            for number, law in enumerate(laws)
            if law.body is not None and bodies and law.body not in bodies
        ]
        if wrong:
            raise ConfigurationError(cls.subject(), wrong)
        return laws

    @field_validator("sweeps", "profiles", "figures")
    @classmethod
    def _have_names_of_files(cls, tables: dict[str, Any]) -> dict[str, Any]:
        """Check the names, which are part of the names of files."""
        fault = "must be made of letters, digits and underscores"
        wrong = [name for name in tables if not name.isidentifier()]
        if wrong:
            raise ConfigurationError(cls.subject(), [Fault((), f"the name {shown(name)} {fault}") for name in wrong])
        return tables

    @field_validator("sweeps", "profiles")
    @classmethod
    def _fit_the_rig(cls, tables: dict[str, Any], info: ValidationInfo) -> dict[str, Any]:
        """Let the rig check conditions when the case is read, not when it runs; a wrong rig checks none."""
        rig, wrong = info.data.get("rig"), []
        models = [model for kind in MODELS for model in info.data.get(kind, ())]
        for name, point in tables.items():
            if info.field_name == "profiles" and point.axes():
                wrong.append(Fault((name,), "a profile is at one operating point; give each condition one value"))
            if rig is not None:
                wrong += [Fault((name, *fault.path), fault.message) for fault in point.faults(rig, models)]
        if wrong:
            raise ConfigurationError(cls.subject(), wrong)
        return tables if rig is None else {name: point.ordered(rig) for name, point in tables.items()}

    @property
    def models(self) -> list[Model]:
        """The contact models, stages and laws."""
        return [model for kind in MODELS for model in getattr(self, kind)]

    @cached_property
    def units(self) -> dict[str, str]:
        """The unit in which results show each condition of the sweeps and profiles."""
        grids = (*self.sweeps.values(), *self.profiles.values())
        return {name: unit for grid in reversed(grids) for name, unit in grid.units().items()}

    @cached_property
    def contact_models_by_label(self) -> dict[str, ContactModel]:
        """The contact models by their labels in results, which name the stages around them."""
        around = f" with {' and '.join(labels(self.stages))}" if self.stages else ""
        return {f"{label}{around}": model for label, model in labelled(self.contact_models).items()}

    @cached_property
    def laws_by_label(self) -> dict[str, Law]:
        """The laws by their labels in results, wear laws first."""
        return labelled((*self.wear_laws, *self.laws))

    @cached_property
    def outcomes(self) -> dict[str, Outcome]:
        """The outcomes of the laws by name, wear first."""
        return {law.outcome.name: law.outcome for law in (*self.wear_laws, *self.laws)}

    @cached_property
    def result_units(self) -> dict[str, str]:
        """The units of all variables in results: those of the table of variables, outcomes and conditions."""
        endings = ("", "_error", "_low", "_high")
        of_laws = {f"{name}{end}": outcome.unit for name, outcome in self.outcomes.items() for end in endings}
        return {**UNITS, **of_laws, **self.units}

    @model_validator(mode="after")
    def _consistent(self) -> Case:
        # the others need labels and units
        if wrong := [*self._wrong_names(), *self._wrong_units()] or [*self._wrong_tests()]:
            raise ConfigurationError(self.subject(), wrong)
        return self

    def _wrong_names(self) -> Iterator[Fault]:
        """Yield the lists of models in which one is listed twice."""
        laws = (*self.wear_laws, *self.laws)
        lists: dict[str, tuple[Model, ...]] = {"contact_models": self.contact_models, "stages": self.stages, "": laws}
        for path, models in lists.items():
            try:
                labels(models)
            except InputError as error:
                yield Fault((path,) if path else (), str(error))

    def _wrong_units(self) -> Iterator[Fault]:
        """Yield the conditions that have units of different dimensions in different places."""
        for kind, grids in (("sweeps", self.sweeps), ("profiles", self.profiles)):
            for name, grid in grids.items():
                try:
                    grid.points(self.units)
                except InputError as error:
                    yield Fault((kind, name), str(error))

    def _wrong_tests(self) -> Iterator[Fault]:
        """Yield why the measured tests are not of the rig."""
        try:
            if self.measured is not None:
                check_rig(self.measured.data, self.rig)
                self.measured.on(self.rig)
        except InputError as error:
            yield Fault(("measured",), str(error))


def case_text(name_or_path: str) -> str:
    """Return the text of a case file, or of a shipped case by its name.

    Raises
    ------
    CaseError
        If there is no such file and no such case.
    UnknownModelError
        If several plugins ship a case of that name.
    """
    plugins = loader.discovered()
    cases = plugins["case"].items()
    if name_or_path in plugins["case"]:
        text: str = plugins.find("case", name_or_path)
        return text
    try:
        return read_text(name_or_path, LARGEST)
    except FileNotFoundError:
        hint = did_you_mean(name_or_path, cases)
        raise CaseError(
            f"there is no case file {shown(Path(name_or_path))}{hint} Shipped cases: {', '.join(cases)}"
        ) from None
    except InputError as error:
        raise CaseError(f"cannot read the case file {shown(Path(name_or_path))}: {error}") from None


def case_schema() -> dict[str, Any]:
    """Return the JSON Schema of a case file, with the options of all installed models."""
    plugins = loader.discovered()
    schema = Case.model_json_schema(by_alias=True)
    properties, definitions = schema["properties"], schema["$defs"]
    for field in MODELS:
        shelf = plugins[field.replace("_", " ").removesuffix("s")]
        properties[field]["items"] = {"anyOf": [{"enum": list(shelf.items())}, *_tables(shelf, definitions)]}
    sets = plugins["parameter set"]
    for laws in ("laws", "wear_laws"):
        file = {"type": "string", "pattern": r"\.toml$"}
        properties[laws]["items"]["anyOf"] += [
            file,
            {"type": "object", "properties": {"model": file}, "required": ["model"]},
        ]
    properties["wear_laws"]["items"]["anyOf"] += [
        *({"const": name} for name in sets.items()),
        *({**table, "required": ["model"]} for table in _tables(sets, definitions)),
    ]
    schema["anyOf"] = [{"required": [name], "properties": {name: {"minItems": 1}}} for name in ("wear_laws", "laws")]
    properties["sections"]["items"] = {"enum": list(plugins["section"].items())}
    rigs = plugins["rig"].items()
    bare = [name for name, rig in rigs.items() if not any(option.is_required() for option in rig.model_fields.values())]
    properties["rig"] = {"anyOf": [{"enum": bare}]}
    axis, schema["allOf"] = definitions["FigureSpec"]["properties"]["x"], []
    for name, rig in rigs.items():
        with _left_out(plugins["rig"], name):
            tables, conditions = list(_rig_tables(name, rig, definitions)), rig.conditions()
            if conditions:
                this = {"properties": {"rig": {"anyOf": _named(name, rig)}}}
                schema["allOf"].append({"if": this, "then": {"properties": _conditions(rig, definitions)}})
            properties["rig"]["anyOf"] += tables
            axis["enum"] = list(dict.fromkeys([*axis["enum"], *conditions]))
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **schema}


@contextmanager
def _left_out(shelf: Shelf, name: str) -> Iterator[None]:
    """Leave a model out, with a warning, if its schema raises an error."""
    try:
        yield
    except KeyboardInterrupt:
        raise
    except BaseException as error:
        reason = f"{shelf.kind} {shown(name)} of {shelf.origin(name)} is left out of the schema: {described(error)}"
        warn(reason, PluginWarning)


def _rig_tables(name: str, rig: type[Rig], definitions: dict[str, Any]) -> Iterator[dict[str, Any]]:
    """Yield the schemas of a rig's table: one with its fields, and one for each preset."""
    yield _model_schema(name, rig, definitions, "type")
    for preset in _presets(rig):
        fields = preset_fields(loader.discovered().find("preset", preset))
        table = fields.model_json_schema(ref_template=f"#/$defs/{name}.{preset}.{{model}}")
        definitions.update({f"{name}.{preset}.{key}": value for key, value in table.pop("$defs", {}).items()})
        required = ["preset", *table.get("required", [])]
        properties = {"preset": {"const": preset}, **table.get("properties", {})}
        yield {**table, "properties": properties, "required": required}


def _presets(rig: type[Rig]) -> list[str]:
    """Return the names of the presets of a rig."""
    return [name for name, preset in loader.discovered()["preset"].items().items() if preset.rig is rig]


def _named(name: str, rig: type[Rig]) -> list[dict[str, Any]]:
    """Return the schemas that identify a rig: its name, a table with its type, or one with a preset of its own."""
    typed = {"type": "object", "properties": {"type": {"const": name}}, "required": ["type"]}
    presets = _presets(rig)
    by_preset = {"type": "object", "properties": {"preset": {"enum": presets}}, "required": ["preset"]}
    return [{"const": name}, typed, *([by_preset] if presets else [])]


def _conditions(rig: type[Rig], definitions: dict[str, Any]) -> dict[str, Any]:
    """Return the schemas of the tables of a case that hold a rig's conditions."""
    conditions = rig.conditions()
    declared: dict[str, Any] = {}
    for kind in ("contact model", "stage", "law", "wear law"):
        for model in loader.installed(kind).values():
            if isinstance(model.conditions, type):
                declared |= of_table(model.conditions)
    needed = [name for name, condition in conditions.items() if condition.required]
    rules = [{"required": needed}, *({"oneOf": [{"required": [name]} for name in names]} for names in rig.choices)]
    schema = definitions["Grid"]["additionalProperties"]
    properties = {
        name: {**schema, "description": condition.meaning} for name, condition in {**declared, **conditions}.items()
    }
    table = {"properties": properties, "allOf": rules, "additionalProperties": False}
    return {"sweeps": {"additionalProperties": table}, "profiles": {"additionalProperties": table}}


def _tables(shelf: Shelf, definitions: dict[str, Any]) -> list[dict[str, Any]]:
    """Return the schema of each model's table."""
    schemas = []
    for name, item in shelf.items().items():
        with _left_out(shelf, name):
            schemas.append(_model_schema(name, item if isinstance(item, type) else type(item), definitions))
    return schemas


def _model_schema(name: str, model: type[Model], definitions: dict[str, Any], key: str = "model") -> dict[str, Any]:
    """Return the schema of a model's table, and add its definitions to the others."""
    table = model.model_json_schema(ref_template=f"#/$defs/{name}.{{model}}")
    definitions.update({f"{name}.{inner}": value for inner, value in table.pop("$defs", {}).items()})
    table["properties"] = {key: {"const": name}, **table.get("properties", {})}
    table["required"] = [key, *(field for field in table.get("required", []) if not _published(model, field))]
    return table


def _published(model: type[Model], field: str) -> bool:
    """Return whether a field without a default takes a value published by the model's source."""
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
    name_or_path = os.fspath(name_or_path)
    text = case_text(name_or_path)
    try:
        fields = parse_toml(text)
    except InputError as error:
        raise CaseError(f"case {shown(Path(name_or_path))} {error}") from None
    try:
        if name_or_path in loader.discovered()["case"]:
            return known_as(name_or_path, Case(**fields))
        with reading(name_or_path):
            return Case(**fields)
    except ConfigurationError as error:
        raise CaseError(with_problems(f"case {shown(Path(name_or_path))} is wrong in:", error.problems)) from None


def written(case: Case) -> dict[str, str]:
    """Return the files that rerun a case in any folder, by name: the case with all defaults, and its measured tests.

    Tests that a plugin ships need no file.
    """
    fields = case.model_dump(mode="json", by_alias=True, exclude_none=True)
    files = {}
    if case.measured is not None and not case.measured.shipped:
        fields["measured"]["tests"] = TESTS_FILE
        files[TESTS_FILE] = without_formulas(case.measured.text)
    text = re.sub(r"\[\n((?: +-?[\d.e+-]+,\n){9,})\]", _on_full_lines, tomli_w.dumps(fields))
    return {CASE_FILE: text, **files}


def _on_full_lines(numbers: re.Match[str]) -> str:
    """Return a long list of numbers, such as the points of a profile, with as many on a line as fit."""
    return f"[\n{textwrap.fill(numbers[1], 118, initial_indent='  ', subsequent_indent='  ')}\n]"
