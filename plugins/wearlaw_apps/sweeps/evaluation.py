"""Evaluating a block of a sweep, in any process."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from wearlaw import kernels
from wearlaw.arrays import Array, steady
from wearlaw.contact.elastic_limit import Overload
from wearlaw.contact.problem import Problem
from wearlaw.errors import InputError, RangeWarning, shown
from wearlaw.models.contact_model import ContactModel
from wearlaw.models.law import Law
from wearlaw.models.model import fault
from wearlaw.numerics.totals import Totals
from wearlaw.pipeline.pipeline import Pipeline
from wearlaw.pipeline.prediction import Prediction
from wearlaw.pipeline.ranges import RangeWatch, Seen
from wearlaw.pipeline.solution import Solution
from wearlaw.units.registry import magnitude
from wearlaw.units.usual import OneWarning, remark
from wearlaw.units.variables import is_text
from wearlaw_apps.output.labels import long_name
from wearlaw_apps.output.notes import caught_warnings
from wearlaw_apps.sweeps.located import posed
from wearlaw_apps.sweeps.points import Points

Outputs = dict[str, Array]
"""Results of a block by name, (points, *axes of the rig) each, in the units of the job."""


@dataclass(frozen=True)
class Job:
    """The evaluation of every block.

    Attributes
    ----------
    pipeline : Pipeline
    units : mapping of str to str
        The unit of each output, by its name.
    dims : mapping of str to tuple
        The rig's own axes with their labels, as in `Problem.dims`.
    accelerate : bool or None
        The setting of `wearlaw.accelerate`, to apply in every process.
    summed : bool
        Whether the points are weighted by their shares and summed.
    """

    pipeline: Pipeline[...]
    units: Mapping[str, str]
    dims: Mapping[str, tuple[str | int, ...]] = field(default_factory=dict)
    accelerate: bool | None = field(default_factory=kernels.chosen)
    summed: bool = False

    def labels(self, name: str) -> Mapping[str, Sequence[str | int | float]]:  # noqa: ARG002
        """Return the axes of an output at one operating point, with their labels."""
        return self.dims

    def own_shape(self, name: str) -> tuple[int, ...]:
        """Return the shape of an output at one operating point."""
        return tuple(map(len, self.labels(name).values()))

    @property
    def settings(self) -> dict[str, str]:
        """What determines the outputs beside the pipeline, the points and the units."""
        return {}

    def weight(self, problem: Problem) -> float:
        """Return the size of an operating point compared with a single line or ellipse.

        Four numbers of a strip count as one of 16 for a patch.
        """
        strips = 0 if problem.strips is None else problem.strips.y.shape[-1]
        return math.prod(map(len, problem.dims.values())) * (1.0 + 0.25 * strips)

    def posed(self, conditions: Mapping[str, Any]) -> Problem:
        """Return the problem of conditions."""
        return self.pipeline.posed(conditions)

    def outputs(self, prediction: Prediction, part: Points) -> Outputs:  # noqa: ARG002
        """Return the outputs of a prediction at some of the points."""
        return outputs_of(prediction, self.units)

    def attributes(self, name: str) -> dict[str, str]:
        """Return the attributes of an output in results: its unit and its long name."""
        return {"units": self.units[name], "long_name": long_name(name, self.pipeline.laws)}


def outputs_of(prediction: Prediction, units: Mapping[str, str]) -> Outputs:
    """Return variables of a prediction in their units."""
    return {name: np.asarray(magnitude(prediction[name], unit)) for name, unit in units.items()}


@dataclass(frozen=True)
class BlockRecord:
    """What the warnings of a sweep need to know of a block.

    Attributes
    ----------
    points : int
        Number of operating points, or of patches if there are several at each point.
    overload : Overload or None
        The one furthest beyond first yield.
    ranges : mapping of str to tuple
        For each variable that leaves the range of the law: lowest and highest mean over the patch in SI, and the number
        of points outside.
    remarks : tuple of str
        Warnings of the rig, such as that a wheel climbs its rail.
    unusual : mapping of str to str
        Unusual conditions, each with what a warning says of it.
    ratios : mapping of str to float
        Unusual ratios, as in `RangeWatch`.
    """

    points: int
    overload: Overload | None
    ranges: Mapping[str, tuple[float, float, int]]
    remarks: tuple[str, ...] = ()
    unusual: Mapping[str, str] = field(default_factory=dict)
    ratios: Mapping[str, float] = field(default_factory=dict)


@steady
def evaluate(job: Job, block: Points, on_block: Callable[[int], None] | None = None) -> tuple[Outputs, BlockRecord]:
    """Return the outputs of a block of operating points, and its record.

    `on_block` is called with the number of points just done, several times for a long block.
    """
    kernels.accelerate(job.accelerate)
    watch = RangeWatch(*job.pipeline.laws)
    remarks: dict[str, None] = {}
    unusual: dict[str, str] = {}
    outputs: Outputs = {}
    for piece in block.blocks():
        part = block.part(piece.slices)
        with caught_warnings() as caught, OneWarning() as seen:
            problem = posed(part, job.posed)
            unusual = {**seen, **unusual}
            seen.clear()
        remarks |= dict.fromkeys(map(str, caught))
        watch.on_block = on_block
        if job.dims or problem.dims:
            _check_axes(job, problem, part)
            watch.on_block = on_block and _in_points(on_block, part.size, problem.size)
        for name, values in job.outputs(job.pipeline.watched(problem, watch), part).items():
            if piece.size == block.size:
                outputs[name] = values
                continue
            axes = values.shape[1:]
            if name not in outputs:
                outputs[name] = np.empty((block.size, *axes), object if is_text(name) else np.float64)
            outputs[name].reshape(block.shape + axes)[piece.slices] = values.reshape(piece.shape + axes)
    return outputs, BlockRecord(watch.points, watch.overload, watch.seen, tuple(remarks), unusual, watch.ratios)


def _check_axes(job: Job, problem: Problem, part: Points) -> None:
    """Raise an error unless the axes of a block's problem are the operating points and the rig's own axes."""
    rig_axes = tuple(map(len, job.dims.values()))
    if problem.dims != job.dims or problem.batch_shape != ((part.size, *rig_axes) if part.dims else rig_axes):
        raise fault(
            job.pipeline.rig,
            f"gave a batch of shape {problem.batch_shape} with the axes {problem.dims!r} for {part.size} operating"
            " points; in the rig, give each condition an axis of length one for each of the rig's axes, as in"
            " values[..., None, None]",
        )


def _in_points(on_block: Callable[[int], None], points: int, patches: int) -> Callable[[int], None]:
    """Return a function that takes numbers of patches and passes on numbers of operating points in proportion."""
    done = 0

    def advance(more: int) -> None:
        nonlocal done
        before, done = done * points // patches, done + more
        on_block(done * points // patches - before)

    return advance


def range_warnings(job: Job, blocks: Iterable[BlockRecord]) -> list[Warning]:
    """Return the warnings of a prediction at the points of all blocks together, and the first one of the rig."""
    every = list(blocks)
    watch = RangeWatch(*job.pipeline.laws)
    if job.dims:
        watch.counted = "patches"
    watch.points = sum(block.points for block in every)
    for block in every:
        for name, seen in block.ranges.items():
            watch.see_outside(name, Seen(*seen))
    watch.overload = max((block.overload for block in every if block.overload), default=None)
    with caught_warnings() as caught, OneWarning():
        for block in every:
            remark(block.unusual)
            watch.see_ratios(block.ratios)
        watch.warn()
    first = next((text for block in every for text in block.remarks), None)
    return caught if first is None else [*caught, RangeWarning(first)]


def unsolved(problem: Problem, model: ContactModel, laws: tuple[Law, ...]) -> Prediction:
    """Return a prediction of NaN, with all names and units of the solved one, at no cost."""
    return Prediction(Solution(problem, model, laws, Totals.missing(problem, laws)))


def expect_pipeline(predict: object) -> None:
    """Raise an `InputError` unless the argument `predict` of an application is a pipeline."""
    if not isinstance(predict, Pipeline):
        raise InputError(f"predict: must be a pipeline, as in rig | contact model | wear law; got {shown(predict)}")
