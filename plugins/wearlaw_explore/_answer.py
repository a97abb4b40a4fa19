"""What the page asks of wearlaw, without the page: which models fit a rig, and what they predict."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from functools import cached_property
from time import perf_counter
from typing import Any, NamedTuple

import numpy as np

import wearlaw as wl
from wearlaw.contact.conditions import LOADS
from wearlaw.pipeline.prediction import SHOWN
from wearlaw.units.variables import VARIABLES, label
from wearlaw_output.notes import Notes

POINTS = 25
"""Points of a curve."""

SLOW = 0.3
"""Time of a contact beyond which there is no curve [s]: elements on half-spaces take longer."""


class Slider(NamedTuple):
    """Label, unit, start and ends of a slider."""

    label: str
    unit: str
    start: float
    low: float
    high: float

    def condition(self, value: float) -> str | float:
        """Return a value as a user writes it."""
        return f"{value:.6g} {self.unit}" if self.unit else float(f"{value:.6g}")


@dataclass
class Subject:
    """A rig, and models besides the installed ones, with the Python that makes each."""

    rig: Any
    code: str
    setup: str = ""
    own_models: Mapping[str, Any] = field(default_factory=dict)
    own_laws: Mapping[str, Any] = field(default_factory=dict)
    stages: Mapping[str, Any] = field(default_factory=dict)

    @cached_property
    def models(self) -> dict[str, Any]:
        """The contact models that solve this rig's contact, by the Python that makes them."""
        fitting = {}
        for code, model in _menu(self.own_models, "contact_model", wl.contact_models()).items():
            with suppress(wl.WearlawError):
                self.rig | model
                fitting[code] = model
        return fitting

    @cached_property
    def laws(self) -> dict[str, Any]:
        """The wear laws that need no numbers from the user, by the Python that makes them."""
        return _menu(self.own_laws, "wear_law", [*wl.wear_laws(), *wl.parameter_sets()])

    def composed(self, model: str, law: str) -> tuple[Any, str]:
        """Return a pipeline and its Python after the contact model; a law of patch means gets them."""
        contact, code = self.rig | self.models[model], ""
        for stage, made in self.stages.items():
            contact, code = contact | made, f"{code} | {stage}"
        try:
            return contact | self.laws[law], f"{code} | {law}"
        except wl.CompositionError:
            return contact | wl.patch_mean() | self.laws[law], f"{code} | wl.patch_mean() | {law}"

    def slider(self, name: str, start: Mapping[str, Any]) -> Slider | None:
        """Return the slider of a condition; None for a value that is no number, such as a law of friction."""
        value = start[name]
        quantity: Any = wl.parse(value) if isinstance(value, str) else wl.Q(value, "") if np.isscalar(value) else value
        if np.ndim(getattr(quantity, "magnitude", [])):
            return None
        unit = VARIABLES[name].unit if name in VARIABLES else f"{quantity.units:~}"
        value = float(quantity.m_as(unit))
        high = 2.0 * abs(value) or 1.0
        low = 0.01 * high
        with suppress(wl.WearlawError):  # the rig may take the other sign
            self.rig.checked_problem({**start, name: wl.Q(-(value or 1e-3), unit)})
            low = -high
        return Slider(label(name, units={name: unit}).removesuffix(" [-]"), unit, value, low, high)

    def python(self, model: str, laws: Sequence[str], conditions: Mapping[str, Any]) -> str:
        """Return the Python that predicts the numbers on the page."""
        given = ", ".join(f"{name}={value!r}" for name, value in conditions.items())
        prints = [f"print((contact{self.composed(model, law)[1]})(**conditions))\n" for law in laws]
        head = f"import wearlaw as wl\n\n{self.setup}contact = {self.code} | {model}\nconditions = dict({given})\n"
        return head + "".join(prints)


def _menu(own: Mapping[str, Any], function: str, names: Any) -> dict[str, Any]:
    """Return own models and those that are installed and need no options, each once."""
    menu: dict[str, Any] = {}
    for name in names:
        with suppress(wl.WearlawError):
            menu[f'wl.{function}("{name}")'] = getattr(wl, function)(name)
    first = {next((known for known in menu if menu[known] == model), code): model for code, model in own.items()}
    return {**first, **menu}


def together(conditions: Mapping[str, Any], more: Mapping[str, Any]) -> dict[str, Any]:
    """Return conditions with more of them; a load replaces the other one."""
    replaced = LOADS if set(LOADS) & set(more) else ()
    return {**{name: value for name, value in conditions.items() if name not in replaced}, **more}


class Answer:
    """What the models predict under some conditions: `predictions` by the Python of the law, with notes."""

    def __init__(self, subject: Subject, model: str, laws: Sequence[str], conditions: Mapping[str, Any]) -> None:
        self.subject, self.model, self.laws, self.conditions = subject, model, laws, conditions
        self.notes = Notes()
        started = perf_counter()
        self.predictions = self._predicted(conditions, self.notes)
        self.seconds = perf_counter() - started

    def _predicted(self, conditions: Mapping[str, Any], notes: Notes) -> dict[str, wl.Prediction]:
        found: dict[str, wl.Prediction] = {}
        problem = None
        for law in self.laws:
            try:
                with notes.of(law_name(law)):
                    pipeline, _ = self.subject.composed(self.model, law)
                    problem = pipeline.posed(conditions) if problem is None else problem
                    found[law] = pipeline.predict(problem)
            except wl.WearlawError as error:
                notes.add(f"{law_name(law)}: {error}")
        return found

    def curve(self, slider: Slider) -> dict[str, dict[str, Any]]:
        """Return creepages x and wear rates y by law; {} if it would take too long, or there is no contact."""
        if not self.predictions or self.seconds > SLOW * len(self.laws):
            return {}
        x = np.linspace(slider.low, slider.high, POINTS)
        conditions = {**self.conditions, self.subject.rig.creepage: wl.Q(x, slider.unit)}
        found = self._predicted(conditions, Notes()).items()  # with notes about points that nobody chose
        return {law: {"x": x, "y": worst(one.wear_rate.magnitude, x.size)} for law, one in found}

    def patches(self) -> dict[str, wl.Prediction]:
        """Return the first law's prediction for each existing patch, the one that wears most first."""
        if not self.predictions:
            return {}
        resolved = (one for one in self.predictions.values() if one.scale == "cells")
        first = next(resolved, next(iter(self.predictions.values())))
        if not first.problem.dims:
            return {"": first}
        rates, labels = first.wear_rate.magnitude, tuple(first.problem.dims.values())
        places = [np.unravel_index(place, rates.shape) for place in np.argsort(-rates, axis=None)]
        return {
            " ".join(str(names[i]) for names, i in zip(labels, at, strict=True)): first[tuple(map(int, at))]
            for at in places
            if not np.isnan(rates[at])
        }

    def numbers(self) -> str:
        """Return a table of the numbers in HTML, with a column for each patch."""
        if not self.predictions:
            return ""
        first, *_ = self.predictions.values()
        table = first.to_dataframe(list(SHOWN[first.problem.geometry]))
        table = table.set_index(list(first.problem.dims)) if first.problem.dims else table
        for place, (law, one) in enumerate(self.predictions.items()):
            rate = one.to_dataframe(["wear_rate"]).iloc[:, -1].to_numpy()
            table.insert(place, f"wear rate, {law_name(law)} [µg/m/mm²]", rate)
        table.columns = table.columns.str.replace("_", " ")
        return str(table.T.to_html(float_format="{:.4g}".format, border=0, header=bool(first.problem.dims)))


def worst(rates: Any, points: int) -> Any:
    """Return the largest wear rate of the patches at each point."""
    return np.nanmax(np.reshape(rates, (points, -1)), axis=1)


def law_name(code: str) -> str:
    """Return the name in the Python of a model, such as "usfd" of 'wl.wear_law("usfd")'."""
    return code.split('"')[1] if '"' in code else code
