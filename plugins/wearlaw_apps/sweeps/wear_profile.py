"""Wear across the profile of a body at the operating points of a sweep, and its sum weighted by their shares."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

import numpy as np
import xarray
from pydantic import TypeAdapter

from wearlaw.arrays import Array
from wearlaw.contact.problem import Problem
from wearlaw.errors import ConditionsError
from wearlaw.pipeline.pipeline import Pipeline
from wearlaw.pipeline.prediction import Prediction
from wearlaw.units.quantities import Q, QuantityLike, coefficient
from wearlaw.units.variables import VARIABLES
from wearlaw_apps.output.notes import caught_warnings
from wearlaw_apps.output.wear_profile import PATCH, POSITION
from wearlaw_apps.sweeps.evaluation import BlockRecord, Job, Outputs, outputs_of, unsolved
from wearlaw_apps.sweeps.points import Block, Points
from wearlaw_apps.sweeps.provenance import digest, provenance_of
from wearlaw_apps.sweeps.results import COMPLETE, Target, attributes, labels_of

if TYPE_CHECKING:
    from wearlaw_apps.sweeps.folder import Parts

WEAR_PROFILE = "wear_profile"
"""Name of the output that `sweep` refuses: `wear_profiles` gives it."""

SHARE = "share"
"""Name that the column with the shares gets."""

REMEDY = "correct the state, or leave it out and divide the shares by the sum of those that stay"
"""What to do about a state that has no place in a sum over service."""

UNITS = (
    {"depth": "um/km", "sliding_distance": "mm/m", "mass": "mg/km"},
    {"depth": "nm", "sliding_distance": "um", "mass": "mg/m"},
)
"""Units per distance rolled of a body that turns, and per passage of a wheel of one that does not."""


@dataclass(frozen=True, kw_only=True)
class ProfileJob(Job):
    """The wear across the profile of a body, at each point or summed over all of them, then with the mass.

    Attributes
    ----------
    body : str
        Its name in the rig.
    at : ndarray, (positions,)
        Arc lengths of its profile [m].
    others : mapping of str to str
        The units of other outputs, by their names.
    """

    body: str
    at: Array
    others: Mapping[str, str]

    @classmethod
    def of(
        cls,
        pipeline: Pipeline[...],
        first: Problem,
        body: str,
        at: QuantityLike,
        summed: bool,
        others: Mapping[str, str] = {},
    ) -> Self:
        """Return the job of a pipeline, after a prediction at the first operating point.

        Raises
        ------
        InputError
            If the body or the positions are wrong.
        """
        unsolved(first[:1], pipeline.staged_model, pipeline.laws).wear_profile(body, at=at)
        turns = bool(np.isfinite(pipeline.rig.bodies[body].rolling_radius).any())
        units = {name: unit for name, unit in UNITS[0 if turns else 1].items() if summed or name != "mass"}
        positions = VARIABLES[POSITION].expected.si(at, "at")
        return cls(pipeline, {**units, **others}, first.dims, body=body, at=positions, summed=summed, others=others)

    def labels(self, name: str) -> Mapping[str, Sequence[str | int | float]]:
        """Return the axes of an output; those of the profile are the rig's but for patches, and the positions [mm]."""
        if name in self.others:
            return super().labels(name)
        axes = {name: labels for name, labels in self.dims.items() if name != PATCH}
        return {**axes, POSITION: tuple((1e3 * self.at).tolist())}

    @property
    def _patches(self) -> int:
        """The axis of the patches, from the end."""
        return list(self.dims).index(PATCH) - len(self.dims)

    @property
    def settings(self) -> dict[str, str]:
        """What else determines the results."""
        return {"body": self.body, "at": digest(self.at, "m")}

    def attributes(self, name: str) -> dict[str, str]:
        """Return the attributes of an output in results: its unit and its long name."""
        if name in self.others:
            return super().attributes(name)
        per = "passage of a wheel" if self.units["depth"] == UNITS[1]["depth"] else "distance rolled"
        return {"units": self.units[name], "long_name": f"{name.replace('_', ' ')} of the {self.body} per {per}"}

    def weight(self, problem: Problem) -> float:
        """Return the size of an operating point: four columns of its positions, of which 16 numbers are one patch."""
        return super().weight(problem) + 0.25 * math.prod(self.own_shape("depth"))

    def posed(self, conditions: Mapping[str, Any]) -> Problem:
        """Return the problem of conditions; a state that has no place in a sum over service is an error."""
        problem = super().posed(conditions)
        if not self.summed:
            return problem
        resolved = problem.resolved if PATCH in problem.dims else None
        if resolved is not None and (missing := ~resolved.any(self._patches)).any():
            status = getattr(problem, "status", None)
            why = (
                ", as where friction holds a flange"
                if status is None
                else f": {np.take(status, 0, self._patches)[missing][0]}"
            )
            wrong = f"no normal forces balance this state{why}"
        elif np.any(getattr(problem, "climbs", False)):
            wrong = "the wheel climbs its rail, beyond the steepest point of its flange, as no wheel does in service"
        else:
            return problem
        raise ConditionsError(f"{wrong}; {REMEDY}")

    def outputs(self, prediction: Prediction, part: Points) -> Outputs:
        """Return the depth and the sliding distance, (points, *sides, positions), or the sums of these and the mass."""
        with caught_warnings():  # `of` has given those of the law and the body
            across = prediction.wear_profile(self.body, at=Q(1e3 * self.at, "mm"))
        losses = {
            name: Q(across[name].values, across[name].attrs["units"]).m_as(unit)
            for name, unit in self.units.items()
            if name in across
        }
        if not self.summed:
            return {**losses, **outputs_of(prediction, self.others)}
        mass = prediction.mass_lost("1 km" if "km" in self.units["mass"] else "1 m", self.body).m_as("mg")
        if PATCH in self.dims:
            mass = np.nansum(mass, axis=self._patches)
        share = part.kept[SHARE]
        shares = coefficient(share.argument(part.laid_out(share)), SHARE, positive=False)
        return {
            name: np.asarray(np.tensordot(shares, loss, axes=1), np.float64)
            for name, loss in {**losses, "mass": mass}.items()
        }


class Sum(Target):
    """The sum of the outputs of all blocks, in their order, so that it is the same from any number of processes.

    Parameters
    ----------
    job : Job
    points : Points
    folder : path, optional
        Where to keep the outputs of each block.
    resume : bool
        Whether to go on with the blocks that are there.
    """

    def __init__(self, job: Job, points: Points, folder: Path | None = None, resume: bool = False) -> None:
        super().__init__(job, points)
        self._totals: Outputs = {}
        self._waiting: dict[int, Outputs] = {}
        self._next = 0
        self._parts: Parts | None = None
        if folder is None:
            return
        from wearlaw_apps.sweeps.folder import Parts  # zarr takes half a second

        self._parts = Parts(folder, provenance_of(job, points), resume)
        self.resumed = self._parts.resumed
        for block in points.blocks() if self.resumed else ():
            if (part := self._parts[block.number]) is not None:
                self._take(block, part.arrays, TypeAdapter(BlockRecord).validate_python(part.record))

    def add(self, block: Block, outputs: Outputs, record: BlockRecord) -> None:
        """Take over a finished block."""
        if self._parts is not None:
            self._parts.add(block.number, outputs, asdict(record))
        self._take(block, outputs, record)

    def _take(self, block: Block, outputs: Outputs, record: BlockRecord) -> None:
        self.done[block.number] = record
        self._waiting[block.number] = outputs
        while self._next in self._waiting:
            for name, values in self._waiting.pop(self._next).items():
                self._totals[name] = self._totals.get(name, 0.0) + values
            self._next += 1

    def arrays(self) -> dict[str, Array]:
        """Return the sums."""
        return self._totals

    def finish(self, notes: Sequence[str]) -> xarray.Dataset:
        """Return the sums as a labelled dataset, and write them."""
        coordinates = labels_of(self.job)
        data = {
            name: (tuple(coordinates)[: values.ndim], values, self.job.attributes(name))
            for name, values in self._totals.items()
        }
        attrs = attributes(COMPLETE, provenance_of(self.job, self.points), notes)
        sums = xarray.Dataset(data, coordinates, attrs)
        if self._parts is not None:
            self._parts.finish(sums)
        return sums

    def close(self) -> None:
        """Let other processes write the folder."""
        if self._parts is not None:
            self._parts.close()
