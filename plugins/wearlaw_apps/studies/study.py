"""Running a case: every contact model with every law at all operating points, as labelled datasets."""

from __future__ import annotations

import json
import warnings
from collections.abc import Callable, Collection, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray

from wearlaw import loader
from wearlaw.arrays import steady
from wearlaw.configuration import known_name, unusual_fields
from wearlaw.contact.material import Material
from wearlaw.contact.problem import Problem
from wearlaw.errors import (
    ConfigurationError,
    InputError,
    ModelError,
    ResumeWarning,
    WearlawError,
    described,
    shown,
    warn,
)
from wearlaw.models.law import WEAR, WearLaw
from wearlaw.models.model import Model
from wearlaw.pipeline.composition import warn_of_unlike_materials
from wearlaw.pipeline.pipeline import Pipeline, Rig
from wearlaw.pipeline.prediction import Prediction
from wearlaw.pipeline.variables import ERROR, MASS, OF_CONTACT, OF_PATCH, OF_POINT, offered, outcome_units
from wearlaw.units.variables import UNITS, name_of
from wearlaw.version import __version__
from wearlaw_apps.fits.pairs import Pair
from wearlaw_apps.output.notes import Notes, caught_warnings
from wearlaw_apps.output.wear_profile import POSITION
from wearlaw_apps.studies.case import Case
from wearlaw_apps.studies.figures import figures_of, wrong_figures
from wearlaw_apps.studies.results import LIMITS, PATCH_AXES, Results, axes_of, pairs_of
from wearlaw_apps.studies.sections import Section
from wearlaw_apps.sweeps.evaluation import Job
from wearlaw_apps.sweeps.plan import planned
from wearlaw_apps.sweeps.points import Points
from wearlaw_apps.sweeps.provenance import parts
from wearlaw_apps.sweeps.sweep import check_importable, kept, target_of
from wearlaw_apps.sweeps.sweep import run as run_sweep

if TYPE_CHECKING:
    from wearlaw.loader import Shelf
    from wearlaw_apps.output.curves import FigureData
    from wearlaw_apps.studies.grid import Grid

PROFILE_STRIPS = 101
"""Strips of a profile across the patch, if the contact model can choose them."""


@dataclass(frozen=True, repr=False)
class Study(Results):
    """The results of a case.

    Attributes
    ----------
    case : Case
        The case that was run.
    pairs : tuple of Pair
        The pairs that were evaluated.
    sweeps, profiles : dict of str to xarray.Dataset
        The results by the names that the case gives them.
    notes : tuple of str
        Omissions and warnings, once each.
    sections : tuple of Section
        Sections that plugins add to the report, in the order of the case.
    """

    notes: tuple[str, ...]
    sections: tuple[Section, ...] = ()

    @cached_property
    def figures(self) -> tuple[FigureData, ...]:
        """The data of the figures, the main one first; a first sweep of one operating point has no main one."""
        return figures_of(self)

    @property
    def main(self) -> FigureData | None:
        """The figure that the report begins with: the one that the case names, or the main outcome of its sweep."""
        every = (*self.figures, *(figure for section in self.sections for figure in section.figures))
        if self.case.main is not None:
            return next((figure for figure in every if figure.name == self.case.main), None)
        return self.figures[0] if axes_of(next(iter(self.sweeps.values()))) else None

    def __repr__(self) -> str:
        pairs = [pair.label for pair in self.pairs]
        profiles = [name for name, profile in self.profiles.items() if profile]
        rows = {"pairs": pairs, "sweeps": self.sweeps, "profiles": profiles, "sections": self.case.sections}
        parts = [f"  {row}: {', '.join(those)}" for row, those in rows.items() if those]
        return "\n".join([f"Study of {shown(self.case.title)}, with {len(self.notes)} notes", *parts])


@steady
def run(
    case: Case,
    on_block: Callable[[int], None] = lambda _: None,
    workers: int = 1,
    store: Path | None = None,
    resume: bool = False,
) -> Study:
    """Run a case.

    Parameters
    ----------
    case : Case
        The study to run.
    on_block : callable, optional
        Called with the number of evaluations just done, to show progress; `evaluations(case)` is their sum.
    workers : int
        How many processes evaluate the sweeps.
    store : Path, optional
        Folder for the stores of sweeps of more than 10⁵ points, in which an interrupted run keeps its finished blocks.
    resume : bool
        Whether to go on with the stores there.
    """
    if not isinstance(case, Case):
        raise InputError(f"case: must be a wearlaw.Case, as from wl.load_case; got {shown(case)}")
    notes, of_profiles = Notes(), Notes()
    evaluator = _Evaluator(on_block, workers, store, resume)
    for part in parts(case):
        for subject, text in unusual_fields(part).items():
            notes.add(f"{subject}: {text}")
    pairs = pairs_of(case, notes)
    profiles = {name: _profile(name, grid, case, pairs, of_profiles) for name, grid in case.profiles.items()}
    _check_figures(case, pairs, profiles)
    sweeps = {name: _sweep(name, grid, case, pairs, notes, evaluator) for name, grid in case.sweeps.items()}
    if store is not None and 0 < evaluator.kept < evaluator.blocks:
        warn(kept(evaluator.kept, evaluator.blocks, store), ResumeWarning)
    for text in of_profiles.texts:
        notes.add(text)
    words = {name: outcome.long_name for name, outcome in case.outcomes.items()}
    for dataset in (*sweeps.values(), *profiles.values()):
        dataset.attrs.update(title=case.title, provenance=json.dumps(provenance(case)))
        for name, variable in dataset.variables.items():
            variable.attrs.setdefault("long_name", words.get(str(name)) or name_of(str(name)))
    study = Study(case, tuple(pairs), sweeps, profiles, tuple(notes.texts))
    sections = tuple(_section(name, study, notes) for name in case.sections)
    study = replace(study, sections=sections)
    if case.main is not None and study.main is None:
        notes.add(f"main: the report has no figure {shown(case.main)}")
    return replace(study, notes=tuple(notes.texts))


def _check_figures(case: Case, pairs: list[Pair], profiles: dict[str, xarray.Dataset]) -> None:
    """Raise an error if the figures of a case cannot be drawn, before its sweeps are computed.

    They are drawn once from the first operating point of each sweep.
    """
    if not case.figures:
        return
    with caught_warnings():  # the sweeps repeat them
        once = _Evaluator(lambda _: None)
        first = {name: _sweep(name, grid.first(), case, pairs, Notes(), once) for name, grid in case.sweeps.items()}
        wrong = list(wrong_figures(Results(case, tuple(pairs), first, profiles)))
    if wrong:
        raise ConfigurationError("the case", wrong)


def _section(name: str, study: Study, notes: Notes) -> Section:
    """Return the section that a plugin makes from a study."""
    plugins = loader.discovered()
    make = plugins.find("section", name)
    subject = f"section '{name}' of {plugins['section'].origin(name)}"
    try:
        with notes.of(f"section '{name}'"):
            section = make(study)
        if not isinstance(section, Section):
            raise TypeError(f"it must be a Section, got {shown(section)}")
    except WearlawError as error:
        raise InputError(
            f"{subject}: {error}\nTo run the case without this section, take '{name}' out of `sections`"
        ) from error
    except KeyboardInterrupt:
        raise
    except BaseException as error:
        raise ModelError(f"{subject} failed with {described(error)}") from error
    return section


def evaluations(case: Case) -> int:
    """Return the number of evaluations that a case needs, each of a pair at an operating point."""
    pairs = pairs_of(case, Notes())
    return sum(
        grid.size * (1 + len(_band_ends(pair.pipeline)))
        for name, grid in case.sweeps.items()
        for pair in _usable(f"sweep '{name}'", grid, pairs, Notes())
    )


def provenance(case: Case) -> dict[str, Any]:
    """Return the origin of a result: the version of wearlaw, the models that plugins provided, and the case."""
    provided = {f"{kind.replace(' ', '_')}s": names for kind, names in used(case).items()}
    return {"wearlaw": __version__, **provided, "case": case.model_dump(mode="json", by_alias=True, exclude_none=True)}


def used(case: Case) -> dict[str, dict[str, str]]:
    """Return the models and other named items of a case, by kind and name, with distribution and version."""
    plugins = loader.discovered()
    named: dict[type, Shelf] = {WearLaw: plugins["parameter set"], Material: plugins["material"], Case: plugins["case"]}
    origins: dict[str, dict[str, str]] = {kind: {} for kind in plugins.shelves}
    for part in parts(case):
        if isinstance(part, Model):
            origins[part.kind][part.name] = plugins[part.kind].distribution(part.name, type(part))
        name = known_name(part)
        if name is not None:
            (shelf,) = (shelf for kind, shelf in named.items() if isinstance(part, kind))
            origins[shelf.kind][name] = shelf.distribution(name)
        if isinstance(part, Material) and type(part) is not Material:
            types, cls = plugins["material type"], type(part)
            origins[types.kind][cls.__name__] = types.distribution(cls.__name__, cls)
    if case.measured is not None and case.measured.shipped:
        origins["test set"] = {case.measured.tests: plugins["test set"].distribution(case.measured.tests)}
    origins["section"] = {name: plugins["section"].distribution(name) for name in case.sections}
    return {kind: dict(sorted(names.items())) for kind, names in origins.items()}


@dataclass
class _Evaluator:
    """Evaluates pipelines at the points of sweeps, with the arguments of `run`, and counts the blocks kept there."""

    on_block: Callable[[int], None]
    workers: int = 1
    store: Path | None = None
    resume: bool = False
    kept: int = 0
    blocks: int = 0

    def __call__(
        self, key: str, pipeline: Pipeline[...], points: Points, outputs: Sequence[str], first: Problem
    ) -> xarray.Dataset:
        """Return outputs in their usual units; `key` names the store of the sweep, `first` is its first problem."""
        units = {**UNITS, **outcome_units(pipeline.laws)}
        job = Job(pipeline, {name: units[name] for name in outputs}, first.dims)
        points = replace(points, weight=job.weight(first))
        check_importable(pipeline, self.workers)
        store = self.store / f"{key}.zarr" if self.store is not None and points.size > points.room else None
        points, several = planned(job, points, self.workers, store is not None)
        with closing(target_of(job, points, store, self.resume)) as target:
            if store is not None:
                self.kept += len(target.done)
                self.blocks += len(target.points.blocks())
            for warning in run_sweep(target, self.on_block, self.workers if several else 1):
                warnings.warn(warning, stacklevel=2)
            arrays = target.arrays()
        data = {v: ((*points.dims, *first.dims), arrays[v], {"units": units[v]}) for v in outputs}
        return xarray.Dataset(data, attrs={PATCH_AXES: " ".join(first.dims)} if first.dims else {})


def _sweep(name: str, grid: Grid, case: Case, pairs: list[Pair], notes: Notes, evaluator: _Evaluator) -> xarray.Dataset:
    """Evaluate all pairs on a grid; the dimensions are those of the grid, the pairs and the contact models."""
    first, units = grid.problem(case.rig, case.models), case.result_units
    points = grid.points(case.units)
    usable = _usable(f"sweep '{name}'", grid, pairs, notes)
    levels = {v: grid.level(v, case.units) for v in grid.written}
    fixed = {v: level for v, level in levels.items() if isinstance(level, float)}
    # A condition for all patches is not the variable of one of them.
    conditions = fixed if first.dims else points.varying
    of_pairs: dict[str, xarray.Dataset] = {}
    contacts: dict[str, xarray.Dataset] = {}
    of_points = xarray.Dataset(
        coords={axis: (axis, varying.values, {"units": units[axis]}) for axis, varying in points.varying.items()}
        | {axis: list(labels) for axis, labels in first.dims.items()}
    )
    for number, pair in enumerate(usable):
        evaluated = pair.contact_model in contacts
        of_pair = _of_pair(pair, first)
        of_contact, of_every = ([], []) if evaluated else _of_contact(pair, first, case, grid, conditions)
        of_point = [v for v in of_every if v not in of_points]
        with notes.of(f"sweep '{name}'"):
            warn_of_unlike_materials(pair.pipeline.contact_model, first)
            outputs = [*of_pair, *of_contact, *of_point]
            data = evaluator(f"{name}-{number}", pair.pipeline, points, outputs, first)
        band = _band(f"{name}-{number}", pair, points, first, data, evaluator)
        of_pairs[pair.label] = data[of_pair].assign(band)
        contacts.setdefault(pair.contact_model, data[of_contact])
        of_points = of_points.assign(data[of_point].data_vars)
    dataset = _side_by_side(of_pairs, contacts).assign(of_points.variables)
    dataset = dataset.assign(
        {v: (points.dims, np.full(points.shape, level), {"units": units[v]})
         for v, level in fixed.items() if v not in dataset}
    )  # fmt: skip
    named = {"pair_contact_model": [pair.contact_model for pair in usable],
             "pair_wear_law": [pair.law if pair.outcome.name == WEAR else "" for pair in usable]}  # fmt: skip
    if case.laws:
        named["pair_law"] = [pair.law if pair.outcome.name != WEAR else "" for pair in usable]
    return dataset.assign_coords({name: ("pair", labels) for name, labels in named.items()})


def _side_by_side(of_pairs: Mapping[str, xarray.Dataset], contacts: Mapping[str, xarray.Dataset]) -> xarray.Dataset:
    """Return the variables of pairs and of contact models in one dataset; what one of them lacks is NaN."""
    along = (("pair", of_pairs), ("contact_model", contacts))
    datasets = [xarray.concat([*every.values()], xarray.Variable(dim, [*every]), join="outer") for dim, every in along]
    return xarray.merge(datasets, join="outer", compat="no_conflicts")


def _of_pair(pair: Pair, problem: Problem) -> list[str]:
    """Return the variables of a pair: its outcome, the error of a mean over the patch, and whether it is outside.

    With several patches there is also the mass lost at each, since wear rates cannot be added.
    """
    error = [f"{pair.outcome.name}{ERROR}"] if pair.outcome.of == "area mean" else []
    mass = [MASS] if problem.dims and pair.outcome.name == WEAR else []
    return [pair.outcome.name, *error, "outside_range", *mass]


def _of_contact(
    pair: Pair, problem: Problem, case: Case, grid: Grid, conditions: Collection[str]
) -> tuple[list[str], list[str]]:
    """Return the variables of a contact model but those given, and those of the points, which do not depend on it.

    If the rig balances its loads, all depend on it.
    """
    with caught_warnings():  # the sweep repeats them
        prediction = pair.pipeline.without_law().predict(problem)
    of_rig = (result.name for result in problem.results if not result.text and result.name not in grid.written)
    of_contact = [v for v in (*offered(prediction, OF_CONTACT), *of_rig) if v not in conditions]
    # A rig may use the name of a variable for something else.
    same = (v for v in offered(prediction, (*OF_POINT, *OF_PATCH)) if case.units.get(v, UNITS[v]) == UNITS[v])
    of_point = [v for v in same if v not in conditions]
    return (of_contact, of_point) if type(case.rig).balanced is Rig.balanced else (of_contact + of_point, [])


def _usable(subject: str, grid: Grid, pairs: list[Pair], notes: Notes) -> list[Pair]:
    """Leave out pairs that cannot use a traction coefficient, if the grid gives one."""
    if "traction_coefficient" not in grid.written:
        return pairs
    usable = [pair for pair in pairs if pair.pipeline.contact_model.uses_measured_traction]
    for pair in pairs:
        if pair not in usable:
            notes.add(f"{subject}: {pair.contact_model} is left out, since it computes the traction itself")
    if not usable:
        raise InputError(f'{subject}: no contact model of the case can use a traction_coefficient; add "global"')
    return usable


def _band(
    key: str, pair: Pair, points: Points, first: Problem, data: xarray.Dataset, evaluator: _Evaluator
) -> dict[str, xarray.DataArray]:
    """Return the ends of the outcome over the published range of the law's parameters; wear rates have them anyway."""
    outcome, ends = pair.outcome.name, _band_ends(pair.pipeline)
    names = (f"{outcome}_low", f"{outcome}_high")
    if not ends:
        return dict.fromkeys(names, data[outcome]) if outcome == WEAR else {}
    with caught_warnings():  # the middle of the band gave them already
        return {
            name: evaluator(f"{key}-{name}", end, points, [outcome], first)[outcome]
            for name, end in zip(names, ends, strict=True)
        }


def _band_ends(pipeline: Pipeline[...]) -> list[Pipeline[...]]:
    """Return the pipelines with the low and the high end of the law's published range, if there is one."""
    (law,) = pipeline.laws
    band = law.band()
    return [] if band is None else [pipeline.with_law(law) for law in (band[0], band[2])]


def _profile(name: str, grid: Grid, case: Case, pairs: list[Pair], notes: Notes) -> xarray.Dataset:
    """Return the profile of the patch: fields of each contact model, and the outcomes of each pair."""
    problem = grid.problem(case.rig, case.models)
    contacts: dict[str, xarray.Dataset] = {}
    of_pairs: dict[str, xarray.Dataset] = {}
    usable = _usable(f"profile '{name}'", grid, pairs, notes)
    resolved = [pair for pair in usable if pair.pipeline.scale == "cells"]
    if not resolved:
        after = " after its stages" if case.stages else ""
        notes.add(f"profile '{name}' is left out: no contact model of the case resolves the patch{after}")
        return xarray.Dataset()
    for pair in resolved:
        if problem.geometry != "line" and pair.outcome.name != WEAR:
            notes.add(f"profile '{name}': {pair.label} is left out, since only wear is shown across a patch")
            continue
        with notes.of(f"profile '{name}'"):
            prediction = pair.pipeline.predict(pair.pipeline.posed(grid.conditions()))
            of_pair, whole = _seen(prediction, case.rig)
        if not whole:
            notes.add(f"profile '{name}' is left out: rig '{case.rig.name}' does not name its bodies")
            return xarray.Dataset()
        of_contact = whole.drop_vars(of_pair)
        before = contacts.get(pair.contact_model, of_contact)  # laws of the two bodies show a part each
        contacts[pair.contact_model] = of_contact.merge(before, join="outer", compat="override")
        of_pairs[pair.label] = whole.drop_vars(of_contact.data_vars)
    return _side_by_side(of_pairs, contacts) if of_pairs else xarray.Dataset()


def _seen(prediction: Prediction, rig: Rig) -> tuple[list[str], xarray.Dataset]:
    """Return the variables of a profile that differ from law to law, and the profile of a prediction.

    The profile of a line runs along the patch, over x. That of an ellipse runs across it, over y, with the wear of
    each body that the law is for. Several patches lie elsewhere each, so x or y is a variable over the axis "node".
    """
    axes = prediction.problem.dims
    limits = offered(prediction, ("max_pressure", *LIMITS))  # if the yield stress of a body is known
    whole = {name: ([*axes], getattr(prediction, name).magnitude, {"units": UNITS[name]}) for name in limits}
    of_law = {"outside_range": ([*axes], prediction.outside_range.magnitude, {"units": ""})}
    (law,) = prediction.laws
    if prediction.problem.geometry == "line":
        shown = [law.outcome.name] if law.outcome.of == "area mean" else []
        profile = prediction.profile
    else:
        bodies = [body for body in rig.bodies if law.body in (None, body)]
        across = {body: prediction.wear_profile(body, strips=PROFILE_STRIPS) for body in bodies}
        named = {f"{body}_{name}": values for body, wear in across.items()
                 for name, values in wear.reset_coords({*wear.coords} & {POSITION}).data_vars.items()}  # fmt: skip
        shown = [name for name in named if not name.endswith(("_sliding_distance", "_profile_position"))]
        profile = xarray.Dataset(named)
    if not profile:
        return [], profile
    if axes:
        (inner,) = {*profile.sizes} - {*axes}
        profile = profile.rename_dims({inner: "node"}).reset_coords().assign_coords(node=range(profile.sizes[inner]))
        profile = profile.assign_attrs({PATCH_AXES: " ".join(axes)})
    return [*shown, *of_law], profile.assign(whole | of_law)
