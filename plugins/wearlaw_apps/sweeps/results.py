"""Results of a sweep in memory, and as a labelled dataset."""

from __future__ import annotations

import json
import math
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray

from wearlaw.arrays import Array
from wearlaw.units.variables import VARIABLES, is_text, name_of
from wearlaw_apps.output.conditions import Known
from wearlaw_apps.sweeps.evaluation import BlockRecord, Job, Outputs
from wearlaw_apps.sweeps.points import ITEM, Block, Points
from wearlaw_apps.sweeps.provenance import Provenance, provenance_of
from wearlaw_apps.sweeps.room import check_memory

COMPLETE, INCOMPLETE = "complete", "incomplete"
"""Values of the attribute "status" of results."""


CONVENTIONS = {"Conventions": "CF-1.8"}
"""What files follow in names of attributes: the first version of the conventions that knows groups."""


def bytes_of(job: Job, points: Points) -> int:
    """Return the size of the outputs of a sweep."""
    return points.size * sum(math.prod(job.own_shape(name)) for name in job.units) * ITEM


class Target(ABC):
    """Where the results of a sweep go.

    Attributes
    ----------
    store : str or None
        The absolute path of a folder to which the evaluating processes write; None if they hand results back.
    resumed : bool
        Whether it holds blocks of an interrupted sweep.
    job : Job
    points : Points
    done : dict of int to BlockRecord
        Records of the finished blocks, by number.
    """

    store: str | None = None
    resumed = False

    def __init__(self, job: Job, points: Points) -> None:
        self.job, self.points = job, points
        self.done: dict[int, BlockRecord] = {}

    @abstractmethod
    def add(self, block: Block, outputs: Outputs, record: BlockRecord) -> None:
        """Take over a finished block."""

    @abstractmethod
    def arrays(self) -> dict[str, Array]:
        """Return the outputs in the shape of the points, or their sums over the points."""

    @abstractmethod
    def finish(self, notes: Sequence[str]) -> xarray.Dataset:
        """Return the results as a labelled dataset, with remarks for the reader."""

    def close(self) -> None:  # noqa: B027
        """Let other processes write the folder, if there is one."""


class Memory(Target):
    """Results in memory."""

    def __init__(self, job: Job, points: Points) -> None:
        check_memory(bytes_of(job, points), 'give a folder for them, store="..."')
        super().__init__(job, points)
        dtypes = {name: object if is_text(name) else np.float64 for name in job.units}
        self._arrays = {name: np.empty(points.shape + job.own_shape(name), dtypes[name]) for name in job.units}

    def add(self, block: Block, outputs: Outputs, record: BlockRecord) -> None:
        """Take over a finished block."""
        for name, values in outputs.items():
            self._arrays[name][block.slices] = values.reshape(block.shape + self.job.own_shape(name))
        self.done[block.number] = record

    def arrays(self) -> dict[str, Array]:
        """Return the outputs in the shape of the points."""
        return self._arrays

    def finish(self, notes: Sequence[str]) -> xarray.Dataset:
        """Return the results as a labelled dataset."""
        attrs = attributes(COMPLETE, provenance_of(self.job, self.points), notes)
        return dataset(self.points, self._arrays, self.job, attrs)


def attributes(status: str, provenance: Provenance, notes: Sequence[str] = ()) -> dict[str, str]:
    """Return the attributes of results: status, provenance, and remarks for the reader."""
    return {**CONVENTIONS, "status": status, "provenance": json.dumps(provenance), "notes": "\n".join(notes)}


def described(name: str, unit: str | None) -> dict[str, str]:
    """Return the attributes of a coordinate: its unit and its long name."""
    return {"units": unit or "", "long_name": name_of(name)}


def dataset(points: Points, variables: Mapping[str, Array], job: Job, attrs: Mapping[str, str]) -> xarray.Dataset:
    """Return results as a dataset with the conditions as coordinates, except those on disk."""
    coordinates: dict[str, Any] = {**points.rows, **labels_of(job)}
    for name, condition in points.coordinates().items():
        if not condition.on_disk:
            coordinates[name] = (condition.dims, condition.values, described(name, condition.unit))
    fixed = {name: Known.of(value) for name, value in points.fixed.items()}
    coordinates |= {
        name: ((), float(condition.values), described(name, condition.unit))
        for name, condition in fixed.items()
        if condition
    }
    data = {
        name: ((*points.dims, *job.labels(name)), values, job.attributes(name)) for name, values in variables.items()
    }
    others = {name: str(points.fixed[name]) for name, condition in fixed.items() if condition is None}
    return xarray.Dataset(data, coordinates, {**others, **attrs})


def labels_of(job: Job) -> dict[str, Any]:
    """Return the axes of outputs at a point as coordinates; zarr has a stable format only for texts of any length."""
    coordinates: dict[str, Any] = {}
    every = [axis for output in job.units for axis in job.labels(output).items()]
    for name, labels in dict(every).items():
        numbers = np.array(labels) if all(isinstance(label, int | float) for label in labels) else None
        attrs = described(name, VARIABLES[name].unit) if name in VARIABLES else {"long_name": name_of(name)}
        coordinates[name] = (name, np.array(labels, dtype=object) if numbers is None else numbers, attrs)
    return coordinates
