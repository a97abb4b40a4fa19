"""Running a case: every contact model with every wear law at all operating points, as labelled datasets."""

from __future__ import annotations

import json
import warnings
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from wearlaw import plugins
from wearlaw.arrays import Array
from wearlaw.case import Case, labelled
from wearlaw.configuration import known_name, parts
from wearlaw.errors import (
    InputError,
    ModelError,
    WearlawError,
    WearlawWarning,
    described,
    did_you_mean,
    message_of,
)
from wearlaw.material import Material
from wearlaw.models import WearLaw
from wearlaw.notes import Notes
from wearlaw.pairs import Pair, compose
from wearlaw.pipeline import Pipeline
from wearlaw.sections import Section
from wearlaw.sweeping.checkpoint import Checkpoint
from wearlaw.sweeping.evaluator import Evaluator, points_of
from wearlaw.sweeping.points import Points
from wearlaw.tangential import Model
from wearlaw.units import from_si
from wearlaw.variables import OF_CONTACT, OF_POINT, UNITS
from wearlaw.version import __version__

if TYPE_CHECKING:
    import xarray

    from wearlaw.figures.curves import FigureData
    from wearlaw.grid import Grid
    from wearlaw.shelf import Shelf

RATES, BAND = ("wear_rate", "wear_rate_error"), ("wear_rate_low", "wear_rate_high")
"""What differs from pair to pair: the wear rate, and its ends over the published range of the law's parameters."""


@dataclass(frozen=True)
class Study:
    """The results of a case.

    Attributes
    ----------
    case : Case
        What was run.
    pairs : tuple of Pair
        The pairs that were evaluated.
    sweeps, profiles : dict of str to xarray.Dataset
        The results by the names that the case gives them.
    notes : tuple of str
        What was left out, and every warning, once each.
    sections : tuple of Section
        What plugins add to the report, as the case lists it.
    """

    case: Case
    pairs: tuple[Pair, ...]
    sweeps: dict[str, xarray.Dataset]
    profiles: dict[str, xarray.Dataset]
    notes: tuple[str, ...]
    sections: tuple[Section, ...] = ()

    @cached_property
    def figures(self) -> tuple[FigureData, ...]:
        """What the figures of the study show."""
        from wearlaw.figures.of_study import figures_of

        return figures_of(self)

    def sweep(self, name: str) -> xarray.Dataset:
        """Return the results of a sweep.

        Raises
        ------
        InputError
            If the case has none of that name.
        """
        if name not in self.sweeps:
            raise InputError(f"the case has no sweep '{name}'{did_you_mean(name, self.sweeps)} Add [sweeps.{name}]")
        return self.sweeps[name]


def run(
    case: Case,
    on_block: Callable[[int], None] = lambda _: None,
    workers: int = 1,
    checkpoint: Checkpoint | None = None,
) -> Study:
    """Run a case.

    Parameters
    ----------
    case : Case
        The study to run.
    on_block : callable, optional
        Called with the number of evaluations done, `evaluations(case)` in all, to show progress.
    workers : int
        How many processes evaluate the sweeps.
    checkpoint : Checkpoint, optional
        Where an interrupted run leaves what is done.
    """
    notes = Notes()
    evaluator = Evaluator(on_block, workers, checkpoint)
    pairs = compose(case.rig, labelled(case.contact_models), labelled(case.wear_laws), notes)
    sweeps = {name: _sweep(name, grid, pairs, notes, evaluator) for name, grid in case.sweeps.items()}
    profiles = {name: _profile(name, grid, case, pairs, notes) for name, grid in case.profiles.items()}
    for dataset in (*sweeps.values(), *profiles.values()):
        dataset.attrs.update(title=case.title, provenance=json.dumps(provenance(case)))
    study = Study(case, tuple(pairs), sweeps, profiles, tuple(notes.texts))
    sections = tuple(_section(name, study, notes) for name in case.sections)
    return replace(study, notes=tuple(notes.texts), sections=sections)


def _section(name: str, study: Study, notes: Notes) -> Section:
    """Return what the plugin makes of a study."""
    found = plugins.installed()
    make = found.sections.find(name, found.broken)
    subject = f"section '{name}' of {found.sections.origin(name)}"
    try:
        with notes.of(f"section '{name}'"):
            section = make(study)
        if not isinstance(section, Section):
            raise TypeError(f"it must be a Section, got {section!r}")
    except WearlawError as error:
        raise InputError(
            f"{subject}: {message_of(error)}\nTo run the case without this section, take '{name}' out of `sections`"
        ) from error
    except KeyboardInterrupt:
        raise
    except BaseException as error:
        raise ModelError(f"{subject} failed with {described(error)}") from error
    return section


def evaluations(case: Case) -> int:
    """Return how many evaluations of a pair at an operating point a case needs."""
    pairs = compose(case.rig, labelled(case.contact_models), labelled(case.wear_laws), Notes())
    return sum(
        grid.size * (1 + len(_band_ends(pair.pipeline)))
        for name, grid in case.sweeps.items()
        for pair in _usable(f"sweep '{name}'", grid, pairs, Notes())
    )


def provenance(case: Case) -> dict[str, Any]:
    """Return what a result came from: the version of wearlaw, all that plugins provided, and the case."""
    provided = {f"{kind.replace(' ', '_')}s": names for kind, names in used(case).items()}
    return {"wearlaw": __version__, **provided, "case": case.model_dump(mode="json", by_alias=True, exclude_none=True)}


def used(case: Case) -> dict[str, dict[str, str]]:
    """Return the models of a case and what else it names, by kind and name, each with distribution and version."""
    found = plugins.installed()
    named: dict[type, Shelf[Any]] = {WearLaw: found.parameter_sets, Material: found.materials, Case: found.cases}
    origins: dict[str, dict[str, str]] = {shelf.kind: {} for shelf in found.shelves()}
    for part in parts(case):
        if isinstance(part, Model):
            origins[part.kind][part.name] = found.of_kind(part.kind).distribution(part.name, type(part))
        name = known_name(part)
        if name is not None:
            (shelf,) = (shelf for kind, shelf in named.items() if isinstance(part, kind))
            origins[shelf.kind][name] = shelf.distribution(name)
    if case.measured is not None and case.measured.shipped:
        origins[found.test_sets.kind] = {case.measured.tests: found.test_sets.distribution(case.measured.tests)}
    origins[found.sections.kind] = {name: found.sections.distribution(name) for name in case.sections}
    return {kind: dict(sorted(names.items())) for kind, names in origins.items()}


def _sweep(name: str, grid: Grid, pairs: list[Pair], notes: Notes, evaluator: Evaluator) -> xarray.Dataset:
    """Evaluate all pairs on a grid; the dimensions are those of the grid, the pairs and the contact models."""
    import xarray

    points = points_of(grid)
    axes = points.dims
    usable = _usable(f"sweep '{name}'", grid, pairs, notes)
    rates: list[dict[str, Array]] = []
    contacts: dict[str, dict[str, Array]] = {}
    of_contact, of_point = ([v for v in variables if v not in axes] for variables in (OF_CONTACT, OF_POINT))
    for number, pair in enumerate(usable):
        new = pair.contact_model not in contacts
        outputs = [*RATES, *(of_contact if new else []), *(of_point if not contacts else [])]
        with notes.of(f"sweep '{name}'"):
            found = evaluator(f"{name}-{number}", pair.pipeline, points, outputs)
        contacts.setdefault(pair.contact_model, found)
        rates.append(_with_band(f"{name}-{number}", pair.pipeline, points, found, evaluator))
    any_contact = next(iter(contacts.values()))
    variables = {
        **{v: (("pair", *axes), np.stack([rate[v] for rate in rates])) for v in (*RATES, *BAND)},
        **{v: (("contact_model", *axes), np.stack([c[v] for c in contacts.values()])) for v in of_contact},
        **{v: (axes, any_contact[v]) for v in of_point},
    }
    dataset = xarray.Dataset({v: (dims, values, {"units": UNITS[v]}) for v, (dims, values) in variables.items()})
    grid_values = {axis: from_si(values, UNITS[axis]).magnitude for axis, values in grid.axes().items()}
    return dataset.assign_coords(
        {axis: (axis, values, {"units": UNITS[axis]}) for axis, values in grid_values.items()}
        | {"pair": [pair.label for pair in usable], "contact_model": list(contacts)}
        | {"pair_contact_model": ("pair", [pair.contact_model for pair in usable])}
        | {"pair_wear_law": ("pair", [pair.wear_law for pair in usable])}
    )


def _usable(subject: str, grid: Grid, pairs: list[Pair], notes: Notes) -> list[Pair]:
    """Leave out the pairs that have no use for a measured traction coefficient."""
    if grid.traction_coefficient is None:
        return pairs
    usable = [pair for pair in pairs if pair.pipeline.contact_model.uses_measured_traction]
    for pair in pairs:
        if pair not in usable:
            notes.add(f"{subject}: {pair.contact_model} is left out, since it computes the traction itself")
    if not usable:
        raise InputError(f'{subject}: no contact model of the case can use a traction_coefficient; add "global"')
    return usable


def _with_band(
    key: str, pipeline: Pipeline[...], points: Points, found: dict[str, Array], evaluator: Evaluator
) -> dict[str, Array]:
    """Return results with the ends of the wear rate over the published range of the law's parameters."""
    ends = []
    for end, one in zip(BAND, _band_ends(pipeline), strict=False):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", WearlawWarning)  # the middle of the band has given them already
            ends.append(evaluator(f"{key}-{end}", one, points, ["wear_rate"])["wear_rate"])
    return {**found, **dict(zip(BAND, ends or [found["wear_rate"]] * 2, strict=True))}


def _band_ends(pipeline: Pipeline[...]) -> list[Pipeline[...]]:
    """Return the pipeline with the low and the high end of its law's published range, if there is one."""
    band = pipeline.wear_law.band()
    return [] if band is None else [pipeline.with_law(law) for law in (band[0], band[2])]


def _profile(name: str, grid: Grid, case: Case, pairs: list[Pair], notes: Notes) -> xarray.Dataset:
    """Return stresses and slip along the patch for each contact model, and the wear rate for each pair."""
    import xarray

    problem = grid.problem(case.rig)
    contacts: dict[str, xarray.Dataset] = {}
    rates: list[xarray.DataArray] = []
    usable = _usable(f"profile '{name}'", grid, pairs, notes)
    resolved = [pair for pair in usable if pair.pipeline.scale == "cells"]
    for pair in resolved:
        with notes.of(f"profile '{name}'"):
            profile = pair.pipeline.predict(problem).profile
        contacts[pair.contact_model] = profile.drop_vars("wear_rate")
        rates.append(profile["wear_rate"])
    if not resolved:
        notes.add(f"profile '{name}' is left out: no contact model of the case resolves the patch")
        return xarray.Dataset()
    # Models with nodes of their own, not on the uniform cells, have no value where only others have a node.
    dataset = xarray.concat(list(contacts.values()), xarray.Variable("contact_model", list(contacts)), join="outer")
    return dataset.assign(wear_rate=xarray.concat(rates, "pair", join="outer")).assign_coords(
        pair=[pair.label for pair in resolved]
    )


def axes_of(sweep: xarray.Dataset) -> list[str]:
    """Return the axes of a sweep's grid."""
    return [str(dim) for dim in sweep.dims if dim not in ("pair", "contact_model")]


def main_axis(sweep: xarray.Dataset) -> str:
    """Return the axis that tables and figures run along: creepage if it is one, else the longest."""
    axes = axes_of(sweep)
    return "creepage" if "creepage" in axes or not axes else max(axes, key=lambda axis: sweep.sizes[axis])


def along_main_axis(sweep: xarray.Dataset) -> xarray.Dataset:
    """Return a sweep along its main axis, with the other axes at their middle value."""
    return along(sweep, main_axis(sweep))


def along(sweep: xarray.Dataset, axis: str) -> xarray.Dataset:
    """Return a sweep along an axis, with the others at their middle value; along its creepage if it has none."""
    line = sweep.isel({other: sweep.sizes[other] // 2 for other in axes_of(sweep) if other != axis})
    return line if axes_of(line) else line.set_coords("creepage").expand_dims("creepage")
