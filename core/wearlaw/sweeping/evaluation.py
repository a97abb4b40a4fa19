"""Evaluating a block of a sweep, in whichever process that happens."""

from __future__ import annotations

import json
import warnings
import zlib
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import pint

from wearlaw.arrays import kernels
from wearlaw.arrays.array import Array
from wearlaw.contact.elastic_limit import Overload
from wearlaw.errors import CompositionError, InputError, did_you_mean
from wearlaw.pipeline.pipeline import Pipeline
from wearlaw.pipeline.variables import UNITS
from wearlaw.sweeping.points import Points
from wearlaw.units.quantities import Quantity
from wearlaw.units.registry import symbol

Outputs = dict[str, Array]
"""Results of a block by name, (points,) each, in the units of its job."""


@dataclass(frozen=True)
class Job:
    """What is done with every block.

    Attributes
    ----------
    pipeline : Pipeline
    units : mapping of str to str
        The unit of each output, by its name.
    accelerate : bool or None
        As in `wearlaw.accelerate`, which is set in one process only.
    """

    pipeline: Pipeline[...]
    units: Mapping[str, str]
    accelerate: bool | None = field(default_factory=kernels.chosen)


@dataclass(frozen=True)
class Seen:
    """What is kept of a block besides its outputs: for warnings, and to find damage on disk.

    Attributes
    ----------
    points : int
        How many operating points it has.
    overload : Overload or None
        The one that is furthest beyond first yield.
    ranges : mapping of str to tuple
        For each variable with a range in the law: lowest and highest mean over the patch in SI, and how many points lie
        outside.
    checksum : int
        That of the outputs and of the above.
    """

    points: int
    overload: Overload | None
    ranges: Mapping[str, tuple[float, float, int]]
    checksum: int


def evaluate(job: Job, part: Points, on_block: Callable[[int], None] | None = None) -> tuple[Outputs, Seen]:
    """Return the outputs of a block of operating points, and what else is kept of it.

    `on_block` is called with the number of points done, several times where that takes long.
    """
    kernels.accelerate(job.accelerate)
    problem = job.pipeline.rig.checked_problem(part.conditions())
    watch = job.pipeline.range_watch()
    prediction = job.pipeline.watched(problem, watch, on_block)
    outputs = {name: _in_unit(getattr(prediction, name), unit) for name, unit in job.units.items()}
    ranges = {name: (seen.lowest, seen.highest, seen.outside) for name, seen in watch.seen.items()}
    seen = Seen(watch.points, watch.overload, ranges, checksum=0)
    return outputs, replace(seen, checksum=checksum(seen, outputs.values()))


def checksum(seen: Seen, outputs: Iterable[Array]) -> int:
    """Return the CRC-32 of the outputs of a block in their order, and of what was seen of it.

    CRC-32 is the fastest checksum of the standard library, above 1 GB/s, and misses one in 2³² cases of accidental
    damage. It does not protect against forgery.
    """
    found = zlib.crc32(json.dumps([seen.points, seen.overload, seen.ranges]).encode())
    for values in outputs:
        found = zlib.crc32(np.ascontiguousarray(values).data, found)
    return found


def range_warnings(pipeline: Pipeline[...], blocks: Iterable[Seen]) -> list[Warning]:
    """Return what a prediction of all blocks together would warn of."""
    every = list(blocks)
    watch = pipeline.range_watch()
    watch.points = sum(one.points for one in every)
    for name, seen in watch.seen.items():
        lowest, highest, outside = zip(*(one.ranges[name] for one in every), strict=True)
        seen.lowest, seen.highest, seen.outside = min(lowest), max(highest), sum(outside)
    watch.overload = max((one.overload for one in every if one.overload), default=None)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        watch.warn(stacklevel=1)
    return [one.message for one in caught if isinstance(one.message, Warning)]


def output_units(pipeline: Pipeline[...], points: Points, outputs: list[str]) -> dict[str, str]:
    """Return the unit in which each output is written, found by evaluating the first operating point.

    Raises
    ------
    InputError
        If there is no such output, or it is a condition.
    """
    problem = pipeline.rig.checked_problem(points.part([slice(0, 1)] * len(points.dims)).conditions())
    prediction = pipeline.watched(problem, pipeline.range_watch())
    given = {*points.varying, *points.fixed}
    units = {}
    for name in outputs:
        if name in given:
            raise InputError(f"outputs: '{name}' is one of the conditions, and among the coordinates of the results")
        value = _output(prediction, name)
        if value is None:
            known = [one for one in dir(prediction) if one not in given and _is_output(prediction, one)]
            raise InputError(
                f"outputs: there is no '{name}' at an operating point{did_you_mean(name, known)}"
                f" There are: {', '.join(known)}"
            )
        units[name] = UNITS.get(name, _written(value))
    return units


def _output(prediction: object, name: str) -> Quantity | None:
    """Return a property of a prediction of one point that can be an output, or None if it is none."""
    there = not name.startswith("_") and hasattr(type(prediction), name)
    value = getattr(prediction, name) if there else None
    return value if isinstance(value, pint.Quantity) and np.shape(value.magnitude) == (1,) else None


def _is_output(prediction: object, name: str) -> bool:
    try:
        return _output(prediction, name) is not None
    except CompositionError:  # there is no wear without a law
        return False


def _written(quantity: Quantity) -> str:
    """Return the unit of a quantity in the way of `UNITS`."""
    return symbol(quantity.units, "~C").replace("µ", "u").replace("**", "^")


def _in_unit(quantity: Any, unit: str) -> Array:
    return np.ascontiguousarray(quantity.to(unit).magnitude)
