"""The datasets of a case that was run, and slices of them for tables and figures."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import xarray

from wearlaw.errors import InputError, did_you_mean
from wearlaw.models.law import Outcome
from wearlaw.pipeline.composition import fitted_to_other_body
from wearlaw.study.case import Case
from wearlaw.study.pairs import Pair
from wearlaw.units.variables import UNITS

LIMITS = {"first_yield": "beyond first yield", "shakedown_limit": "beyond shakedown"}
"""The limits of the maximum pressure, with words for a contact beyond them."""


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
        if name not in self.sweeps:
            raise InputError(f"the case has no sweep '{name}'{did_you_mean(name, self.sweeps)} Add [sweeps.{name}]")
        return self.sweeps[name]

    def pair(self, label: str) -> Pair:
        """Return the pair with a label."""
        (found,) = (pair for pair in self.pairs if pair.label == label)
        return found

    def is_outside(self, profile: xarray.Dataset, label: str, body: str) -> bool:
        """Return whether the depth that a pair gives for a body lies outside what its law was fitted to."""
        law = self.pair(label).pipeline.wear_law
        other = fitted_to_other_body(self.case.rig.bodies, law, body)
        return other or bool(profile.outside_range.sel(pair=label).item())


def predicting(results: Results, outcome: str, labels: Sequence[str]) -> list[str]:
    """Return the pairs among these whose law predicts an outcome."""
    return [label for label in labels if results.pair(label).outcome.name == outcome]


def outcomes_of(results: Results, sweep: xarray.Dataset) -> list[Outcome]:
    """Return the outcomes in the results of a sweep, wear first."""
    return [outcome for name, outcome in results.case.outcomes.items() if name in sweep]


def axes_of(sweep: xarray.Dataset) -> list[str]:
    """Return the axes of a sweep's grid."""
    return [str(dim) for dim in sweep.dims if dim not in ("pair", "contact_model")]


def main_axis(sweep: xarray.Dataset, creepage: str) -> str:
    """Return the axis along which tables and figures run: the creepage of the rig, or else the longest axis.

    Without axes, it is the creepage of the single point, or else another condition.
    """
    axes = axes_of(sweep)
    if creepage in axes or not axes:
        return creepage if creepage in sweep else _other(sweep)
    return max(axes, key=lambda axis: sweep.sizes[axis])


def along_main_axis(sweep: xarray.Dataset, creepage: str) -> xarray.Dataset:
    """Return a sweep along its main axis, at the middle of the other axes."""
    return along(sweep, main_axis(sweep, creepage))


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
