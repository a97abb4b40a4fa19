"""Checks that a case can fill its figures, made when the case is read, not after it has run."""

from __future__ import annotations

import itertools
import warnings
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, TypeAlias

from wearlaw.contact.conditions import LOADS
from wearlaw.errors import CompositionError, Fault, WearlawError, WearlawWarning, did_you_mean, excerpt, quoted
from wearlaw.models.contact_model import ContactModel, Scale
from wearlaw.models.law import WEAR, Law, Outcome
from wearlaw.models.stage import Stage
from wearlaw.numerics.staged import staged
from wearlaw.pipeline.pipeline import Rig
from wearlaw.pipeline.prediction import Prediction
from wearlaw.pipeline.variables import MASS, OF_CONTACT, OF_PATCH, OF_POINT, offered
from wearlaw.study.composed import composed
from wearlaw.study.figure_spec import (
    ACROSS,
    BY_PATCH,
    OF_LOAD,
    OF_PROFILE,
    FigureSpec,
    Window,
    axis_along,
    wrong_range,
)
from wearlaw.study.grid import Grid
from wearlaw.units.variables import UNITS

LONGEST_NAME = 100
"""Most bytes of the name of a sweep, profile or figure; file systems allow 255 for it with what files add to it."""


def wrong_name(name: str) -> str:
    """Return what keeps a name in a case from being part of the name of a file, or "" if it can be."""
    if not name.isidentifier():
        return "must be made of letters, digits and underscores"
    size = len(name.encode())
    return f"has {size} bytes, but {LONGEST_NAME} are the most" if size > LONGEST_NAME else ""


@dataclass(frozen=True)
class Variables:
    """The variables of a sweep or a profile that a figure can show.

    Attributes
    ----------
    x, y : tuple of str
        Those for each axis.
    units : mapping of str to str
        The unit of each; wear across a patch has an entry for each body, such as "wheel_depth".
    patches : mapping of str to tuple
        The labels along each axis of the patches, {} if the rig makes one patch.
    """

    x: tuple[str, ...]
    y: tuple[str, ...]
    units: Mapping[str, str]
    patches: Mapping[str, tuple[str | int, ...]]


_Known: TypeAlias = tuple[tuple[str, ...], tuple[str, ...], Mapping[str, str]]
"""The variables for each axis, and their units."""


@dataclass(frozen=True)
class Contents:
    """The contents of a case that its figures can show.

    Attributes
    ----------
    rig : Rig
    contact_models, laws : mapping of str to Model
        By their labels in results.
    stages : tuple of Stage
        The stages around every contact model.
    outcomes : mapping of str to Outcome
        The outcomes of the laws by name.
    sweeps, profiles : mapping of str to Grid
    units : mapping of str to str
        The unit in which each condition is shown.
    measured : collection of str
        Variables of the measured tests.
    """

    rig: Rig
    contact_models: Mapping[str, ContactModel]
    stages: tuple[Stage, ...]
    laws: Mapping[str, Law]
    outcomes: Mapping[str, Outcome]
    sweeps: Mapping[str, Grid]
    profiles: Mapping[str, Grid]
    units: Mapping[str, str]
    measured: Collection[str]
    _known: dict[tuple[str, str], Variables] = field(default_factory=dict)
    _posed: dict[int, Any] = field(default_factory=dict)

    def problems(self, figures: Mapping[str, FigureSpec]) -> Iterator[Fault]:
        """Yield the faults of figures: names in them that the case does not have."""
        for name, spec in figures.items():
            fault = wrong_name(name)
            if fault:
                yield Fault(("figures", name), f"the name {fault}")
            for path, message in self._problems(spec):
                yield Fault(("figures", name, *path.split(".")), message)

    def _problems(self, spec: FigureSpec) -> Iterator[tuple[str, str]]:
        kind, grids = ("sweep", self.sweeps) if spec.sweep else ("profile", self.profiles)
        asked = spec.sweep or spec.profile or ""
        if asked not in grids:
            yield kind, f"the case has no {kind} {_choice(asked, grids)}"
            return
        grid = grids[asked]
        known = self._variables(kind, asked, grid)
        if spec.map:
            yield from self._of_map(spec, grid, known)
            return
        yield from _unknown("x", [spec.x], known.x)
        for number, window in enumerate(spec.windows()):
            path = f"panels.{number}." if spec.panels else ""
            for name, message in self._of_window(spec.x, window, known, across=bool(spec.profile)):
                yield f"{path}{name}", message
        if spec.sweep and spec.x in known.x:
            yield from self._constant(spec.x, grid, bool(known.patches))
        yield from self._of_models(spec, grids[asked])
        shown = {spec.x, *(variable for window in spec.windows() for variable in window.shown)}
        missing = sorted(shown.difference(self.measured))
        if spec.measured and missing:
            has = f"have only {', '.join(self.measured)}" if self.measured else "are missing; add [measured]"
            yield "measured", f"cannot show {' and '.join(map(excerpt, missing))} of the measured tests, which {has}"

    def _of_map(self, spec: FigureSpec, grid: Grid, known: Variables) -> Iterator[tuple[str, str]]:
        """Yield the faults of a map."""
        axes = tuple(grid.axes())
        for field_, axis in (("x", spec.x), ("y", spec.shown[0])):
            if axis not in axes:
                yield field_, f"a map runs along axes of the sweep; there is no {_choice(axis, axes)}"
        yield from _unknown("map", spec.of_values, known.y)
        yield from self._of_models(spec, grid)

    def _variables(self, kind: str, name: str, grid: Grid) -> Variables:
        """Return the variables of a sweep or profile, found by predicting its first operating point."""
        if (kind, name) not in self._known:
            problem = self._problem(grid)
            predictions = list(self._predictions(problem))
            of_kind = self._of_sweep(grid, predictions) if kind == "sweep" else self._of_profile(predictions, problem)
            x, y, units = of_kind
            if kind == "sweep" and problem.dims:
                x, y = (*x, BY_PATCH), (*y, *((MASS,) if WEAR in self.outcomes else ()))
            self._known[kind, name] = Variables(x, y, units, problem.dims)
        return self._known[kind, name]

    def _problem(self, grid: Grid) -> Any:
        """Return the problem of the first operating point of a grid, posed once, since a rig may take long."""
        if id(grid) not in self._posed:
            self._posed[id(grid)] = grid.problem(self.rig)
        return self._posed[id(grid)]

    def _predictions(self, problem: Any) -> Iterator[Any]:
        """Yield a prediction for each contact model that solves the problem, with the first law that fits it.

        Running the case reports the errors of the others.
        """
        for model in self.contact_models.values():
            found = next(filter(None, (self._prediction(model, law, problem) for law in self.laws.values())), None)
            if found is not None:
                yield found

    def _prediction(self, model: ContactModel, law: Law, problem: Any) -> Any:
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", WearlawWarning)  # running the case repeats them
                return composed(self.rig, model, self.stages, law, problem.geometry).predict(problem)
        except WearlawError:
            return None

    def _of_sweep(self, grid: Grid, predictions: list[Prediction]) -> _Known:
        every = {name for one in predictions for name in offered(one, (*OF_CONTACT, *OF_POINT, *OF_PATCH))}
        levels = {name: grid.level(name, self.units) for name in grid.given}
        conditions = [name for name, level in levels.items() if isinstance(level, float)]
        of_contact, of_point = (
            [name for name in names if name in every] for names in (OF_CONTACT, (*OF_POINT, *OF_PATCH))
        )
        x = tuple(dict.fromkeys((*of_contact, *of_point, *conditions)))
        return x, (*self.outcomes, *of_contact, *of_point), {**UNITS, **self._of_laws(), **self.units}

    def _of_laws(self) -> dict[str, str]:
        return {name: outcome.unit for name, outcome in self.outcomes.items()}

    def _of_profile(self, predictions: list[Prediction], problem: Any) -> _Known:
        units = {**UNITS, **self._of_laws()}
        if all(one.problem.geometry == "line" for one in predictions):
            local = [name for name, outcome in self.outcomes.items() if outcome.of == "area mean"]
            left_out = {WEAR, *(("creepage",) if problem.dims else ())} - {*local}  # patches differ in creepage
            known = dict.fromkeys((*(name for name in OF_PROFILE if name not in left_out), *local))
            return ("x",), tuple(known), units
        for body in self.rig.bodies:
            for model, law in itertools.product(self.contact_models.values(), self.laws.values()):
                if law.outcome.name != WEAR or law.body not in (None, body) or not self._resolves(model):
                    continue
                found = self._prediction(model, law, problem)
                if found is not None:
                    with warnings.catch_warnings():
                        warnings.simplefilter("ignore", WearlawWarning)  # running the case repeats them
                        columns = found.wear_profile(body).data_vars.items()
                    units |= {f"{body}_{name}": column.attrs["units"] for name, column in columns}
                    break
        return ("x", "y"), ACROSS, units

    def _resolves(self, model: ContactModel) -> bool:
        """Return whether laws see the cells of a contact model after its stages."""
        scale: Scale = staged(model, self.stages).scale
        return scale == "cells"

    def _of_window(self, x: str, window: Window, known: Variables, across: bool) -> Iterator[tuple[str, str]]:
        """Yield the faults of a panel."""
        whole = [name for name in window.shown if across and name in self.outcomes and name not in known.y]
        for name in whole:
            yield "y", f"{name} has no profile; show it in a figure of a sweep"
        yield from _unknown("y", [name for name in window.shown if name not in whole], known.y)
        for axis, labels in (window.patches or {}).items():
            if not known.patches:
                yield "patches", "the rig makes one patch at each operating point; leave it out"
                break
            if axis not in known.patches:
                yield "patches", f"the rig has no axis {_choice(axis, known.patches)}"
                continue
            for label in labels:
                if label not in known.patches[axis]:
                    yield f"patches.{axis}", f"there is no {_choice(str(label), [*map(str, known.patches[axis])])}"
        across = across and known.y == ACROSS
        bodies = tuple(self.rig.bodies)
        if window.body is not None and not across:
            yield "body", "only wear across the patch is of one body; leave it out"
        if window.body is not None and window.body not in bodies:
            yield "body", f"there is no {_choice(window.body, bodies)}"
            return
        body = f"{window.body or bodies[0]}_" if across and bodies else ""
        units = {name: known.units[f"{body}{name}"] for name in window.shown if f"{body}{name}" in known.units}
        if across and not units and any(f"{one}_depth" in known.units for one in bodies):
            yield "body", f"no wear law of the case is for {quoted(window.body or bodies[0])}; name another body"
        if len(set(units.values())) > 1:
            each = ", ".join(f"{variable} in {unit or 'no unit'}" for variable, unit in units.items())
            yield "y", f"one axis has one unit, but these are {each}; give each a panel of its own"
        if x in known.units:
            for message in wrong_range(x, known.units[x], window.x_range, window.x_scale):
                yield "x_range", message
        first = window.shown[0]
        if first in units:
            for message in wrong_range(first, units[first], window.y_range, window.y_scale):
                yield "y_range", message

    def _constant(self, x: str, grid: Grid, several: bool) -> Iterator[tuple[str, str]]:
        """Yield a fault if nothing changes along the x axis; `several` patches change with any condition."""
        axis = axis_along(grid, x, self.rig.creepage)
        if x == BY_PATCH:
            return
        of_point = x in grid.given or (x in OF_POINT and not several)
        unknown = axis not in UNITS and not several
        varies = not of_point or x == axis or unknown or (x in OF_LOAD and axis in LOADS)
        if grid.axes() and not varies:
            yield "x", f"{x} is the same at all points of the sweep; give {axis}, or what follows from it"

    def _of_models(self, spec: FigureSpec, grid: Grid) -> Iterator[tuple[str, str]]:
        refusals = {
            (model, law): self._refusal(model, law, spec, grid) for model in self.contact_models for law in self.laws
        }
        pairs = {f"{law} on {model}": self.laws[law] for (model, law), refusal in refusals.items() if not refusal}
        models = list(dict.fromkeys(model for (model, _), refusal in refusals.items() if not refusal))
        if not pairs:
            yield "profile" if spec.profile else "sweep", next(iter(refusals.values()))
            return
        shown = spec.of_values & {*self.outcomes}
        for outcome in sorted(shown - {law.outcome.name for law in pairs.values()}):
            reasons = (refusal for (_, law), refusal in refusals.items() if self.laws[law].outcome.name == outcome)
            yield "y", f"no pair of the case gives {outcome}: {next(reasons)}"
        refused = {f"{law} on {model}": refusal for (model, law), refusal in refusals.items() if refusal}
        unknown = [pair for pair in spec.pairs or () if pair not in pairs]
        for pair in unknown:
            why = f"{quoted(pair)}: {refused[pair]}" if pair in refused else f"there is no {_choice(pair, pairs)}"
            yield "pairs", why
        if spec.pairs and not unknown:
            for message in self._of_pairs(spec, shown, {pair: pairs[pair] for pair in spec.pairs}):
                yield "pairs", message
        for model in spec.contact_models or ():
            if model not in models:
                yield "contact_models", f"there is no {_choice(model, models)}"

    def _of_pairs(self, spec: FigureSpec, shown: set[str], chosen: Mapping[str, Law]) -> Iterator[str]:
        """Yield the faults of the chosen pairs: those that a figure does not show, and panels left without a curve."""
        predicted = {pair: law.outcome.name for pair, law in chosen.items()}
        for pair, outcome in predicted.items():
            if shown and outcome not in shown:
                yield f"{quoted(pair)} predicts {outcome}, which the figure does not show; leave it out"
        for outcome in sorted(shown - {*predicted.values()}):
            yield f"none of them predicts {outcome}, which the figure shows; add one that does"
        for window in spec.windows():
            body = window.body or next(iter(self.rig.bodies), None)
            if "depth" in window.shown and all(law.body not in (None, body) for law in chosen.values()):
                yield f"none of them has a law for {quoted(body)}, whose depth the figure shows; add one that does"

    def _refusal(self, model: str, law: str, spec: FigureSpec, grid: Grid) -> str:
        """Return why a pair has no results for the figure, or "" if it has."""
        contact_model = self.contact_models[model]
        if "traction_coefficient" in grid.given and not contact_model.uses_measured_traction:
            return f"{model} is left out there, since it computes the traction itself"
        if spec.profile and not self._resolves(contact_model):
            return f"{model} does not resolve the patch"
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", WearlawWarning)  # running the case repeats them
                geometry = self._problem(grid).geometry
                composed(self.rig, contact_model, self.stages, self.laws[law], geometry)
        except CompositionError as error:
            return str(error)
        outcome = self.laws[law].outcome.name
        if spec.profile and geometry != "line" and outcome != WEAR:
            return f"{law} predicts {outcome}, but across the patch of an ellipse only wear is shown"
        return ""


def _unknown(path: str, given: Collection[str], known: Collection[str]) -> Iterator[tuple[str, str]]:
    for name in given:
        if name not in known:
            yield path, f"{quoted(name)} cannot be shown{did_you_mean(name, known)} It can be: {', '.join(known)}"


def _choice(asked: str, known: Collection[str]) -> str:
    return f"{quoted(asked)}{did_you_mean(asked, known)} There are: {', '.join(known) or 'none'}"
