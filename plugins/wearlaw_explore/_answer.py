"""What the page asks of wearlaw, without the page: which models fit a rig, and what they predict."""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from functools import cached_property
from time import perf_counter
from typing import Any, NamedTuple

import numpy as np

import wearlaw as wl
from wearlaw.contact.conditions import LOADS
from wearlaw.pipeline.notes import Notes
from wearlaw.pipeline.prediction import SHOWN
from wearlaw.units.variables import VARIABLES, label

POINTS = 31
"""Points of a curve where contacts are solved together."""

FEW_POINTS = 9
"""Points of a curve of a rig that balances its loads at each point, which takes a thousand times as long."""

SLOW = 0.3
"""Time of a contact beyond which there is no curve [s]: elements on half-spaces take that long."""

RANGE = 2.0
"""Largest value of a slider over its start value."""


class Slider(NamedTuple):
    """Label, unit, start and ends of a slider."""

    label: str
    unit: str
    start: float
    low: float
    high: float

    def condition(self, value: float) -> str | float:
        """Return a value as a user writes it."""
        value = float(f"{value:.6g}")
        return f"{value:g} {self.unit}" if self.unit else value


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
        found = _menu(self.own_models, "contact_model", wl.contact_models())
        return {code: model for code, model in found.items() if self._takes(model)}

    @cached_property
    def laws(self) -> dict[str, Any]:
        """The wear laws that need no numbers from the user, by the Python that makes them."""
        return _menu(self.own_laws, "wear_law", [*wl.wear_laws(), *wl.parameter_sets()])

    def _takes(self, model: Any) -> bool:
        try:
            return bool(self.rig | model)
        except wl.WearlawError:
            return False

    def composed(self, model: str, law: str) -> tuple[Any, str]:
        """Return a pipeline and its Python after the contact model; a law of patch means gets them."""
        contact, code = self.rig | self.models[model], ""
        for stage, made in self.stages.items():
            contact, code = contact | made, f"{code} | {stage}"
        try:
            return contact | self.laws[law], f"{code} | {law}"
        except wl.CompositionError:
            return contact | wl.patch_mean() | self.laws[law], f"{code} | wl.patch_mean() | {law}"

    def start(self, given: Mapping[str, Any]) -> dict[str, Any]:
        """Return the conditions to start from: those given, and the rig's example."""
        return together(self.rig.example, given)

    def slider(self, name: str, start: Mapping[str, Any]) -> Slider | None:
        """Return the slider of a condition; None for a value that is no number, such as a law of friction."""
        try:
            quantity = wl.parse(start[name]) if isinstance(start[name], str) else wl.Q(start[name], "")
        except TypeError:
            quantity = start[name]
        if not hasattr(quantity, "units") or np.ndim(quantity.magnitude):
            return None
        known = VARIABLES.get(name)
        unit = known.unit if known else f"{quantity.units:~}"
        value = float(quantity.to(unit or "dimensionless").magnitude)
        high = RANGE * abs(value) or 1.0
        title = label(name, units={name: unit}).removesuffix(" [-]")
        return Slider(title, unit, value, -high if self._signed(name, start, value, unit) else 0.01 * high, high)

    def _signed(self, name: str, start: Mapping[str, Any], value: float, unit: str) -> bool:
        """Return whether the rig takes the condition with the other sign."""
        with suppress(wl.WearlawError):
            self.rig.checked_problem({**start, name: wl.Q(-(value or 1e-3), unit) if unit else -value})
            return True
        return False

    def python(self, model: str, laws: Sequence[str], conditions: Mapping[str, Any]) -> str:
        """Return the Python that predicts the numbers on the page."""
        given = ", ".join(f"{name}={value!r}" for name, value in conditions.items())
        with unwarned():
            chains = [self.composed(model, law)[1] for law in laws]
        prints = "".join(f"print((contact{chain})(**conditions))\n" for chain in chains)
        return (
            f"import wearlaw as wl\n\n{self.setup}contact = {self.code} | {model}\nconditions = dict({given})\n{prints}"
        )


def _menu(own: Mapping[str, Any], function: str, names: Any) -> dict[str, Any]:
    """Return own models and those that are installed and need no options, each once."""
    menu: dict[str, Any] = {}
    for name in names:
        with suppress(wl.WearlawError):
            menu[f'wl.{function}("{name}")'] = getattr(wl, function)(name)
    same = {code: next((known for known in menu if menu[known] == model), code) for code, model in own.items()}
    return {**{same[code]: model for code, model in own.items()}, **menu}


def together(conditions: Mapping[str, Any], more: Mapping[str, Any]) -> dict[str, Any]:
    """Return conditions with more of them; a load replaces the other one."""
    without = {name for name in LOADS if set(LOADS) & set(more)}
    return {**{name: value for name, value in conditions.items() if name not in without}, **more}


@contextmanager
def unwarned() -> Iterator[None]:
    """Keep quiet of what the answer has noted already."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", wl.WearlawWarning)
        yield


@contextmanager
def noted(notes: Notes, subject: str) -> Iterator[None]:
    """Turn wearlaw's warnings and errors into notes."""
    try:
        with notes.of(subject):
            yield
    except wl.WearlawError as error:
        notes.add(f"{subject}: {error}")


@dataclass
class Answer:
    """What the models predict under some conditions: `predictions` by the name of the law, with notes."""

    subject: Subject
    model: str
    laws: Sequence[str]
    conditions: Mapping[str, Any]
    notes: Notes = field(default_factory=Notes)
    predictions: dict[str, wl.Prediction] = field(default_factory=dict)
    seconds: float = 0.0

    def __post_init__(self) -> None:
        started = perf_counter()
        self.predictions = self._predicted(self.conditions, self.notes)
        self.seconds = perf_counter() - started

    def _predicted(self, conditions: Mapping[str, Any], notes: Notes) -> dict[str, wl.Prediction]:
        found: dict[str, wl.Prediction] = {}
        problem = None
        for law in self.laws:
            with noted(notes, law_name(law)):
                pipeline, _ = self.subject.composed(self.model, law)
                problem = pipeline.posed(conditions) if problem is None else problem
                found[law] = pipeline.predict(problem)
        return found

    def curve(self, slider: Slider) -> dict[str, tuple[Any, Any]]:
        """Return creepages and wear rates by law; {} if it would take too long, or there is no contact everywhere."""
        rig = self.subject.rig
        balances = type(rig).balanced is not wl.Rig.balanced
        if not self.predictions or (self.seconds > SLOW * len(self.laws) and not balances):
            return {}
        low = slider.low if slider.low > 0.0 or balances else slider.high / POINTS
        x = np.linspace(low, slider.high, FEW_POINTS if balances else POINTS)
        conditions = {**self.conditions, rig.creepage: wl.Q(x, slider.unit)}
        found = self._predicted(conditions, Notes()).items()  # with notes about points that nobody chose
        return {law: (x, worst(one.wear_rate.magnitude, x.size)) for law, one in found}

    def patches(self) -> dict[str, wl.Prediction]:
        """Return the first law's prediction for each existing patch, the one that wears most first."""
        if not self.predictions:
            return {}
        resolved = (one for one in self.predictions.values() if one.scale == "cells")
        first = next(resolved, next(iter(self.predictions.values())))
        if not first.problem.dims:
            return {"": first}
        rates = first.wear_rate.magnitude
        order = [place for place in np.argsort(-rates, axis=None) if not np.isnan(rates.flat[place])]
        labels = tuple(first.problem.dims.values())
        found = {}
        for place in order:
            at = np.unravel_index(place, rates.shape)
            words = " ".join(str(names[i]) for names, i in zip(labels, at, strict=True))
            found[words] = first[tuple(int(i) for i in at)]
        return found

    def numbers(self) -> str:
        """Return a table of the numbers in HTML, with a column for each patch."""
        rows = [(law_name(law), one.to_dataframe(["wear_rate"]).iloc[:, -1]) for law, one in self.predictions.items()]
        if not rows:
            return ""
        first = next(iter(self.predictions.values()))
        names = list(SHOWN[first.problem.geometry])
        table = first.to_dataframe(names)
        others = [(str(head), table[head]) for head in table.columns if head.partition(" [")[0] in names]
        lines = [(f"wear rate, {name} [µg/m/mm²]", values) for name, values in rows] + others
        cells = "".join(
            f"<tr><th scope=row>{name.replace('_', ' ')}</th>{''.join(f'<td>{v:.4g}</td>' for v in values)}</tr>"
            for name, values in lines
        )
        patches = "".join(
            f"<th scope=col>{' '.join(map(str, row))}</th>" for row in table[list(first.problem.dims)].values.tolist()
        )
        return f"<table><tr><td></td>{patches}</tr>{cells}</table>"


def worst(rates: Any, points: int) -> Any:
    """Return the largest wear rate of the patches at each point."""
    return np.nanmax(np.reshape(rates, (points, -1)), axis=1)


def law_name(code: str) -> str:
    """Return the name in the Python of a model, such as "usfd" of 'wl.wear_law("usfd")'."""
    return code.split('"')[1] if '"' in code else code
