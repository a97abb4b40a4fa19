"""What the page asks of wearlaw, without the page: which models fit a rig, and what they predict."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Any

import wearlaw as wl
from wearlaw.errors import CompositionError
from wearlaw.fields import specification
from wearlaw.parameters import changed, number_in_si, numbers
from wearlaw_apps.output.labels import labelled
from wearlaw_apps.output.notes import Notes
from wearlaw_apps.sweeps.several import composed

FIRST = "strip_theory"
"""The contact model with which a page starts, if it solves the rig's patches and the user has none."""

LONGEST = 1500
"""Most letters of the arguments of a model in Python, such as those of a profile by points."""

MEANS: Any = wl.patch_mean()
"""The stage for a law of patch means."""


@dataclass
class Subject:
    """A rig and the user's models, each with the Python that makes it; the installed models join them."""

    rig: Any
    code: str
    setup: str = ""
    own_models: Mapping[Any, str] = field(default_factory=dict)
    own_laws: Mapping[Any, str] = field(default_factory=dict)
    stages: Mapping[Any, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        by_use = sorted(wl.installed("contact model"), key=lambda name: name != FIRST)
        models = {**self.own_models, **_installed(wl.contact_model, by_use)}
        wear_laws = {law: code for law, code in self.own_laws.items() if isinstance(law, wl.WearLaw)}
        laws = {**wear_laws, **_installed(wl.wear_law, [*wl.installed("wear law"), *wl.installed("parameter set")])}
        self.codes = {MEANS: "wl.patch_mean()", **self.stages, **models, **laws}
        fitting = []
        for model in models:
            with suppress(CompositionError):  # it is for another shape of patch
                self.rig | model
                fitting.append(model)
        self.models, self.laws = labelled(fitting), labelled([*laws])
        self.first_laws = [*self.laws][: len(wear_laws)] or ["usfd"]

    def conditions(self, conditions: Mapping[str, Any]) -> dict[str, Any]:
        """Return example conditions of the rig and the user's models, and the given ones, which replace those."""
        replaced = [name for names in self.rig.choices if {*names} & {*conditions} for name in names]
        of_models = {name: condition.example for name, condition in self.declared.items() if condition.required}
        of_rig = {name: value for name, value in self.rig.example.items() if name not in replaced}
        return {**of_rig, **of_models, **conditions}

    @property
    def fields(self) -> dict[str, Any]:
        """The numbers of the rig but those of its materials, by name."""
        return {name: value for name, value in numbers(self.rig).items() if "material" not in name.split(".")}

    def change(self, fields: Mapping[str, Any]) -> None:
        """Give the rig other numbers, as text with units."""
        now = self.fields
        values = {name: wl.parse(value) if isinstance(value, str) else value for name, value in fields.items()}
        moved = {
            name: value
            for name, value in values.items()
            if not math.isclose(number_in_si(value), number_in_si(now[name]), rel_tol=1e-5)  # texts have six digits
        }
        for name, value in moved.items():
            try:
                self.rig = changed(self.rig, {name: value})
            except wl.WearlawError as error:
                raise wl.InputError(f"{name}: {error}") from None
        if moved:
            self.code = code_of(self.rig, self.code)

    @property
    def declared(self) -> dict[str, Any]:
        """The conditions of all models in the menus beside those of the rig, by name."""
        of_rig = self.rig.conditions()
        every = {name: condition for model in self.codes for name, condition in model.own_conditions().items()}
        return {name: condition for name, condition in every.items() if name not in of_rig}

    def pipeline(self, model: str, law: str) -> Any:
        """Return the pipeline of a contact model and a law, by their labels; a law of patch means gets them."""
        try:
            return composed(self.rig, self.models[model], [*self.stages], self.laws[law])
        except CompositionError:
            return composed(self.rig, self.models[model], [*self.stages, MEANS], self.laws[law])

    def taken(self, pipeline: Any, conditions: Mapping[str, Any]) -> dict[str, Any]:
        """Return the conditions without those that only other models of the page take."""
        others = self.declared.keys() - pipeline.conditions.keys()
        return {name: value for name, value in conditions.items() if name not in others}

    def predict(
        self, model: str, laws: Sequence[str], conditions: Mapping[str, Any], notes: Notes
    ) -> dict[str, wl.Prediction]:
        """Return a prediction for each law, by its label; there are notes of warnings and errors."""
        predictions: dict[str, wl.Prediction] = {}
        for law in laws:
            try:
                with notes.of(law):
                    pipeline = self.pipeline(model, law)
                    predictions[law] = pipeline(**self.taken(pipeline, conditions))
            except wl.WearlawError as error:
                notes.add(f"{law}: {error}")
        return predictions

    def python(self, model: str, laws: Sequence[str], conditions: Mapping[str, Any]) -> str:
        """Return the Python that predicts the same."""
        every = {name: f"{name}={value!r}" for name, value in conditions.items()}
        of_rig = ", ".join(text for name, text in every.items() if name not in self.declared)
        lines = ["import wearlaw as wl", "", self.setup, f"conditions = dict({of_rig})"]
        for pipeline in (self.pipeline(model, law) for law in laws):
            parts = (pipeline.contact_model, *pipeline.stages, *pipeline.laws)
            declared = [every[name] for name in self.taken(pipeline, conditions) if name in self.declared]
            composed_of = " | ".join([self.code, *(self.codes[part] for part in parts)])
            lines.append(f"print(({composed_of})({', '.join(['**conditions', *declared])}))")
        return "\n".join(lines)


MAKERS = {"rig": "rig", "contact model": "contact_model", "stage": "stage", "wear law": "wear_law", "law": "law"}
"""Functions of wearlaw that make models, by kind."""


def code_of(part: Any, code: str) -> str:
    """Return the Python that makes a model, or that of the user where it would be long or is of no installed class."""
    make, fields = MAKERS[part.kind], specification(part)
    name = fields.pop("type" if part.kind == "rig" else "model")
    installed = {**wl.installed(part.kind), **wl.installed("parameter set")}.get(name)
    arguments = "".join(f", {field}={value!r}" for field, value in fields.items())
    if type(part) not in (installed, type(installed)) or len(arguments) > LONGEST:
        return code
    with suppress(wl.WearlawError):
        arguments = "" if getattr(wl, make)(name) == part else arguments
    return f"wl.{make}({name!r}{arguments})"


def numbered(code: str, parts: Iterable[Any]) -> dict[Any, str]:
    """Return the parts in a list that has a name in Python."""
    return {part: f"{code}[{place}]" for place, part in enumerate(parts)}


def _installed(make: Callable[[str], Any], names: Iterable[str]) -> dict[Any, str]:
    """Return the models that need no numbers from the user, each with the Python that makes it."""
    codes = {}
    for name in names:
        with suppress(wl.ConfigurationError):
            codes[make(name)] = f'wl.{make.__name__}("{name}")'
    return codes
