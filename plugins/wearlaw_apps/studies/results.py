"""The datasets of a case that was run, and slices of them for tables and figures."""

from __future__ import annotations

import itertools
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple, TypeAlias, TypeVar

import xarray

from wearlaw.errors import InputError, did_you_mean, shown
from wearlaw.models.law import WEAR, Law, Outcome
from wearlaw.models.model import Blame
from wearlaw.pipeline.composition import remark_on_body
from wearlaw.pipeline.variables import MASS
from wearlaw.units.quantities import from_si
from wearlaw.units.variables import UNITS, VARIABLES
from wearlaw_apps.fits.pairs import Pair, compose
from wearlaw_apps.output.labels import in_words, readable
from wearlaw_apps.output.notes import Notes
from wearlaw_apps.studies.case import Case

TAKE_MEANS_IN_A_CASE = 'write stages = ["patch_mean"] in the case, or use the contact model "global"'
"""Remedy in a case for a law of the whole patch on a contact resolved into cells."""

T = TypeVar("T")

Patch: TypeAlias = Mapping[str, Any]
"""Labels of a patch along the axes of its rig, such as {"side": "left", "patch": 1}; {} if the rig makes one patch."""

PATCH_AXES = "patch_axes"
"""Attribute of a sweep with the names of the axes that its rig adds for several patches."""

LIMITS = {"first_yield": "beyond first yield", "shakedown_limit": "beyond shakedown"}
"""The limits of the maximum pressure, with words for a contact beyond them."""

SHAKEDOWN = "shakedown_limit"
"""The limit beyond which panels have a strip along the x axis."""


@dataclass(frozen=True)
class Results:
    """The sweeps and profiles of a case; `Study` documents the attributes."""

    case: Case
    pairs: tuple[Pair, ...]
    sweeps: dict[str, xarray.Dataset]
    profiles: dict[str, xarray.Dataset]

    def sweep(self, name: str) -> xarray.Dataset:
        """Return the results of a sweep.

        Raises
        ------
        InputError
            If the case has none of that name.
        """
        return _found("sweep", name, self.sweeps)

    def conditions(self, *, sweep: str | None = None, profile: str | None = None) -> dict[str, Any]:
        """Return the conditions of a sweep or a profile of the case, as arguments of a pipeline.

        The axes of a sweep are arrays, each along a dimension of its own. A section can predict more than the results
        hold: ``study.pairs[0].pipeline(**study.conditions(sweep="curve"))``.

        Raises
        ------
        InputError
            If the case has none of that name.
        """
        if sweep is not None:
            return _found("sweep", sweep, self.case.sweeps).conditions()
        return _found("profile", profile or "", self.case.profiles).conditions()

    def pair(self, label: str) -> Pair:
        """Return the pair with a label."""
        (pair,) = (pair for pair in self.pairs if pair.label == label)
        return pair

    def is_for_other_body(self, label: str, body: str) -> bool:
        """Return whether the parameters of a pair's wear law were fitted to another body than this one."""
        return bool(remark_on_body(self.case.rig.bodies, self.pair(label).pipeline.wear_law, body))


def _found(kind: str, name: str, every: Mapping[str, T]) -> T:
    if name not in every:
        raise InputError(f"the case has no {kind} {shown(name)}{did_you_mean(name, every)} Add [{kind}s.{name}]")
    return every[name]


def pairs_of(case: Case, notes: Notes) -> list[Pair]:
    """Compose all pairs of a case, for the first operating point of its first sweep."""
    problem = next(iter(case.sweeps.values())).problem(case.rig, case.models)
    models, laws = case.contact_models_by_label, case.laws_by_label
    return compose(case.rig, models, laws, notes, problem, case.stages, TAKE_MEANS_IN_A_CASE)


def predicting(results: Results, outcome: str, labels: Sequence[str]) -> list[str]:
    """Return the pairs among these whose law predicts an outcome; a wear law also predicts `MASS`."""
    of_law = WEAR if outcome == MASS else outcome
    return [label for label in labels if results.pair(label).outcome.name == of_law]


def outcomes_of(results: Results, sweep: xarray.Dataset) -> list[Outcome]:
    """Return the outcomes in the results of a sweep, wear first."""
    return [outcome for name, outcome in results.case.outcomes.items() if name in sweep]


class Borders(NamedTuple):
    """Where the regimes of a law change: the symbol of a variable, the values, and their unit for readers."""

    symbol: str
    values: list[float]
    unit: str


def borders_of(law: Law) -> dict[str, Borders]:
    """Return the borders of the regimes of a law by variable; {} if it declares none."""
    with Blame(law):
        borders = law.breakpoints(law.numbers) or {}
    named = {}
    for name, values in borders.items():
        variable = law.variables[name] if name in law.variables else VARIABLES[name]
        numbers = [float(from_si(value, variable.unit).magnitude) for value in values]
        named[name] = Borders(variable.symbol or variable.long_name, numbers, readable(variable.unit))
    return named


def axes_of(sweep: xarray.Dataset) -> list[str]:
    """Return the axes of a sweep's grid."""
    others = ("pair", "contact_model", *patch_axes(sweep))
    return [str(dim) for dim in sweep.dims if dim not in others]


def patch_axes(sweep: xarray.Dataset) -> list[str]:
    """Return the axes of a sweep that its rig adds for several patches."""
    return [axis for axis in sweep.attrs.get(PATCH_AXES, "").split() if axis in sweep.dims]


def patches_of(sweep: xarray.Dataset, asked: Mapping[str, Collection[Any]] | None = None) -> list[Patch]:
    """Return the labels of each patch that exists at any point of a sweep; [{}] if the rig makes one patch.

    `asked` holds the labels to choose from, by axis.
    """
    axes = patch_axes(sweep)
    if not axes:
        return [{}]
    of_contact = next(
        variable for variable in sweep.data_vars.values() if {"contact_model", *axes} <= set(variable.dims)
    )
    there = of_contact.notnull().any([dim for dim in of_contact.dims if dim not in axes])
    return [
        patch
        for patch in possible_patches(sweep)
        if there.sel(patch) and all(patch[axis] in labels for axis, labels in (asked or {}).items())
    ]


def possible_patches(sweep: xarray.Dataset) -> list[Patch]:
    """Return the labels of each patch that the rig can make, whether it exists or not."""
    axes = patch_axes(sweep)
    labels = itertools.product(*(sweep[axis].values.tolist() for axis in axes))
    return [dict(zip(axes, patch, strict=True)) for patch in labels]


def labelled_by(patch: Patch, label: str) -> str:
    """Return a label with a patch in words behind it, if the rig makes several."""
    return f"{label}, {in_words(patch)}" if patch else label


def main_axis(sweep: xarray.Dataset, creepage: str | None) -> str:
    """Return the axis along which tables and figures run: the creepage of the rig, or else the longest axis.

    Without axes, it is the creepage of the single point, or else another condition.
    """
    axes = axes_of(sweep)
    if creepage in axes or not axes:
        return creepage if creepage is not None and creepage in sweep else _other(sweep)
    return max(axes, key=lambda axis: sweep.sizes[axis])


def along(sweep: xarray.Dataset, axis: str) -> xarray.Dataset:
    """Return a sweep along an axis, at the middle of the others; a single point becomes an axis of length 1."""
    line = sweep.isel({other: sweep.sizes[other] // 2 for other in axes_of(sweep) if other != axis})
    if axes_of(line):
        return line
    at = axis if axis in line else _other(line)
    return line.set_coords(at).expand_dims(at)


def _other(point: xarray.Dataset) -> str:
    """Return a variable of a sweep without axes."""
    return next(str(name) for name in point.data_vars if not point[name].dims)


def beyond_limits(dataset: xarray.Dataset) -> dict[str, xarray.DataArray]:
    """Return where the contact of each model is beyond each of `LIMITS`; {} if they are not known."""
    needed = ("max_pressure", *LIMITS)
    if any(name not in dataset or dataset[name].attrs.get("units") != UNITS[name] for name in needed):
        return {}
    return {limit: dataset.max_pressure > dataset[limit] for limit in LIMITS}


def together(sweep: xarray.Dataset, outcome: str) -> xarray.Dataset:
    """Return a sweep of several patches with one value at each point.

    The mass lost is the sum over the patches, and any other outcome the largest of them. A point is outside a range or
    beyond a limit if one of its patches is: its maximum pressure is the largest one, and its limits are scaled to it.
    """
    axes = patch_axes(sweep)
    value = sweep[outcome].sum(axes, min_count=1) if outcome == MASS else sweep[outcome].max(axes)
    variables = {outcome: value, "outside_range": sweep.outside_range.max(axes)}
    if all(name in sweep for name in ("max_pressure", *LIMITS)):
        variables["max_pressure"] = largest = sweep.max_pressure.max(axes)
        variables |= {limit: largest * (sweep[limit] / sweep.max_pressure).min(axes) for limit in LIMITS}
    return sweep.drop_dims(axes).assign(
        {name: variable.assign_attrs(sweep[name].attrs) for name, variable in variables.items()}
    )
