"""The wear that a line causes across the profiles of a body: the sum of a sweep over its states, at every step."""

from __future__ import annotations

import dataclasses
import json
import os
import re
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

import wearlaw as wl
from wearlaw import Array
from wearlaw.errors import DataError, ResumeWarning, warn
from wearlaw_apps.output.notes import caught_warnings
from wearlaw_apps.sweeps.evaluation import Outputs
from wearlaw_apps.sweeps.located import posed
from wearlaw_apps.sweeps.points import Points
from wearlaw_apps.sweeps.provenance import check_same, digest, provenance_of
from wearlaw_apps.sweeps.sweep import check_importable, run
from wearlaw_apps.sweeps.wear_profile import REMEDY, ProfileJob, Sum

if TYPE_CHECKING:
    from wearlaw_apps.sweeps.folder import Parts


NUMBER = re.compile(r"\d[\d.e+-]*")
"""A number in a warning. Steps repeat warnings with other numbers, and the first of them is enough."""


HEADS = ("", "beside_")
"""Beginnings of the names of the outputs of the first body, and of a second one that wears with it."""

SIDE = "side"
"""Name of the axis of the left and the right wheel."""


class NoResultError(DataError):
    """A state of a line has no result on the profiles of a step."""


class Wear(NamedTuple):
    """Wear per metre rolled, or per passage over a rail, weighted by share."""

    depth: Array
    """Depth normal to the profile, (sides, positions) [m per metre or passage]."""
    mass: Array
    """Mass of a wheel [kg/m], or of a metre of rail [kg/m per passage], (sides,)."""
    places: Array
    """Number of patches whose middle lies at each position, (sides, positions)."""

    @classmethod
    def of(cls, sums: Mapping[str, Array], head: str, units: Mapping[str, str]) -> Wear:
        """Return the wear in SI from sums whose names begin with `head`, in the units of a job."""
        depth, mass = (wl.Q(sums[head + name], units[name]).to_base_units().magnitude for name in ("depth", "mass"))
        return cls(np.atleast_2d(depth), np.atleast_1d(mass), sums[f"{head}places"])


@dataclasses.dataclass(frozen=True, kw_only=True)
class WearJob(ProfileJob):
    """The wear of a line, and where its patches lie."""

    beside: WearJob | None = None
    """The job of a second body that wears in the same predictions."""

    def outputs(self, prediction: wl.Prediction, part: Points) -> Outputs:
        """Return the sums of a block, and the number of its patches at each position, (sides, positions)."""
        problem, step, axes = prediction.problem, self.at[1] - self.at[0], list(self.dims)
        middle = np.where(problem.normal_force > 0.0, problem.bodies[self.body].profile_position, np.nan)  # type: ignore[arg-type]
        of_sides = np.moveaxis(middle, axes.index(SIDE) - len(axes), 0) if SIDE in axes else middle[None]
        at = np.append(self.at - 0.5 * step, self.at[-1] + 0.5 * step)
        places = [np.histogram(places, at)[0] for places in of_sides]
        beside = {} if self.beside is None else self.beside.outputs(prediction, part)
        return {
            **super().outputs(prediction, part),
            "places": np.array(places, np.float64),
            **{f"{HEADS[1]}{name}": values for name, values in beside.items()},
        }


class Line:
    """The states of a line, whose wear at positions along the profile of each body [m] is summed with their shares.

    `points` are those of the first step. Where they follow from the profiles, `renewed` returns those of a rig.
    """

    def __init__(
        self,
        predict: wl.Pipeline[...],
        points: Points,
        at: Mapping[str, Array],
        workers: int,
        client: Any,
        renewed: Callable[[wl.Rig], Points] | None = None,
    ) -> None:
        with caught_warnings():  # the first step gives them
            first = posed(
                points.part([slice(0, 1), *(slice(None) for _ in points.dims[1:])]),
                lambda conditions: predict.rig.checked_problem(conditions, predict.models),
            )
        check_importable(predict, workers, client)
        self.jobs = [WearJob.of(predict, first, body, wl.Q(1e3 * places, "mm"), True) for body, places in at.items()]
        self.job = dataclasses.replace(self.jobs[0], beside=self.jobs[1] if len(self.jobs) > 1 else None)
        self.sides = len(self.job.dims.get("side", "-"))
        self.points = dataclasses.replace(points, weight=self.job.weight(first))
        self._workers, self._client, self._renewed = workers, client, renewed
        self._kept: Parts | None = None
        self._said: set[str] = set()

    def keep(self, store: str | os.PathLike[str], life: Mapping[str, Any], resume: bool) -> Parts:
        """Keep the wear of each step in a store, of a life with these settings, and return the store."""
        from wearlaw_apps.sweeps.folder import Parts  # zarr takes half a second

        provenance = provenance_of(self.job, self.points) | {"life": json.loads(json.dumps(life))}
        self._kept = Parts(store, provenance, resume, "life")
        if self._kept.resumed:
            text = f"the finished steps in {wl.shown(store)} are kept; the life goes on from there"
            warn(text, ResumeWarning)
        return self._kept

    def wear(
        self, step: int, predict: wl.Pipeline[...], at: Sequence[Array], failures: Sequence[str] = ()
    ) -> tuple[list[Wear], tuple[str, ...]]:
        """Return the wear of both sides of each body at arc lengths [m] at the beginning of a step, and notes on it.

        A note of a new kind is a warning, too. `failures` are those of this step on other profiles.

        Raises
        ------
        NoResultError
            If a state has no result, or its wheel climbs; the message names the row.
        OutputError
            If the states of this step are not those in the store.
        """
        points, table, remarks = self.points, {}, []
        part = None if self._kept is None else self._kept[step]
        if part is not None and len(before := part.record["failures"]) > len(failures):
            raise NoResultError(before[len(failures)])
        if self._renewed is not None:
            with caught_warnings() as remarks:
                points = self._renewed(predict.rig) if step else points
            points = dataclasses.replace(points, weight=self.points.weight)
            table = points.coordinates()
        states = {name: digest(column.values, column.unit) for name, column in table.items()}
        if self._kept is not None and part is not None:
            now = f"step {step + 1}"
            check_same(self._kept.path, {now: part.record["states"]}, {now: states}, "life")
            wears = [Wear(*(part.arrays[f"{head}{name}"] for name in Wear._fields)) for head in HEADS[: len(at)]]
            notes = part.record["notes"]
        else:
            beside = self.job.beside and dataclasses.replace(self.job.beside, at=at[1])
            total = Sum(dataclasses.replace(self.job, pipeline=predict, at=at[0], beside=beside), points)
            try:
                remarks += run(total, lambda _: None, self._workers, self._client)
            except wl.InputError as error:
                if REMEDY not in str(error):  # other mistakes do not go with the profile
                    raise
                raise NoResultError(str(error)) from None
            notes = [[type(remark).__name__, str(remark)] for remark in remarks]
            arrays = total.arrays()
            wears = [Wear.of(arrays, head, job.units) for head, job in zip(HEADS, self.jobs, strict=False)]
            if self._kept is not None:
                results = {f"line_{name}": column.values for name, column in table.items()}
                for head, wear in zip(HEADS, wears, strict=False):
                    results |= {f"{head}{name}": values for name, values in wear._asdict().items()}
                self._kept.add(step, results, {"notes": notes, "states": states, "failures": failures})
        for kind, text in notes:
            if (words := NUMBER.sub("", text)) not in self._said:
                self._said.add(words)
                warn(f"step {step + 1}: {text}" if step else text, getattr(wl, kind))
        return wears, tuple(text for _, text in notes)
