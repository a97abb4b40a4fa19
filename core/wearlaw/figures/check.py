"""Whether a case has what its figures ask for, found when it is read and not when it has run."""

from __future__ import annotations

import warnings
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass

from wearlaw.conditions import LOADS
from wearlaw.errors import CompositionError, Problem, WearlawWarning, did_you_mean
from wearlaw.figures.spec import OF_LOAD, FigureSpec, axis_along
from wearlaw.grid import Grid
from wearlaw.models import WearLaw
from wearlaw.rigs.twin_disc import TwinDisc
from wearlaw.tangential import ContactModel
from wearlaw.variables import OF_POINT


@dataclass(frozen=True)
class Contents:
    """What a case has for its figures.

    Attributes
    ----------
    rig : TwinDisc
    contact_models, wear_laws : mapping of str to Model
        By their labels in results.
    sweeps, profiles : mapping of str to Grid
    measured : collection of str
        The variables that its measured tests have.
    """

    rig: TwinDisc
    contact_models: Mapping[str, ContactModel]
    wear_laws: Mapping[str, WearLaw]
    sweeps: Mapping[str, Grid]
    profiles: Mapping[str, Grid]
    measured: Collection[str]

    def problems(self, figures: Mapping[str, FigureSpec]) -> Iterator[Problem]:
        """Give what figures ask for and the case does not have."""
        for name, spec in figures.items():
            if not name.isidentifier():
                yield Problem(("figures", name), "the name must be made of letters, digits and underscores")
            for field, message in self._problems(spec):
                yield Problem(("figures", name, field), message)

    def _problems(self, spec: FigureSpec) -> Iterator[tuple[str, str]]:
        kind, grids = ("sweep", self.sweeps) if spec.sweep else ("profile", self.profiles)
        asked = spec.sweep or spec.profile or ""
        if asked not in grids:
            yield kind, f"the case has no {kind} {_choice(asked, grids)}"
            return
        if spec.sweep:
            yield from _constant(spec.x, grids[asked])
        yield from self._of_models(spec, grids[asked])
        shown = {spec.x, *(variable for window in spec.windows() for variable in window.shown)}
        missing = sorted(shown.difference(self.measured))
        if spec.measured and missing:
            has = f"have only {', '.join(self.measured)}" if self.measured else "are missing; add [measured]"
            yield "measured", f"cannot show {' and '.join(missing)} of the measured tests, which {has}"

    def _of_models(self, spec: FigureSpec, grid: Grid) -> Iterator[tuple[str, str]]:
        refusals = {
            (model, law): self._refusal(model, law, spec, grid)
            for model in self.contact_models
            for law in self.wear_laws
        }
        pairs = [f"{law} on {model}" for (model, law), refusal in refusals.items() if not refusal]
        models = list(dict.fromkeys(model for (model, _), refusal in refusals.items() if not refusal))
        if not pairs:
            yield "profile" if spec.profile else "sweep", next(iter(refusals.values()))
            return
        refused = {f"{law} on {model}": refusal for (model, law), refusal in refusals.items() if refusal}
        for pair in spec.pairs or ():
            if pair not in pairs:
                yield (
                    "pairs",
                    f"'{pair}': {refused[pair]}" if pair in refused else f"there is no {_choice(pair, pairs)}",
                )
        for model in spec.contact_models or ():
            if model not in models:
                yield "contact_models", f"there is no {_choice(model, models)}"

    def _refusal(self, model: str, law: str, spec: FigureSpec, grid: Grid) -> str:
        """Return why a pair has no results that the figure could show; nothing if it has."""
        contact_model = self.contact_models[model]
        if grid.traction_coefficient is not None and not contact_model.uses_measured_traction:
            return f"{model} is left out there, since it computes the traction itself"
        if spec.profile and contact_model.scale != "cells":
            return f"{model} does not resolve the patch"
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", WearlawWarning)  # running the case gives them
                _ = self.rig | contact_model | self.wear_laws[law]
        except CompositionError as error:
            return str(error)
        return ""


def _constant(x: str, grid: Grid) -> Iterator[tuple[str, str]]:
    axis = axis_along(grid, x)
    varies = x not in OF_POINT or x == axis or (x in OF_LOAD and axis in LOADS)
    if grid.axes() and not varies:
        yield "x", f"{x} is the same at all points of the sweep; give {axis}, or what follows from it"


def _choice(asked: str, known: Collection[str]) -> str:
    return f"'{asked}'{did_you_mean(asked, known)} There are: {', '.join(known) or 'none'}"
