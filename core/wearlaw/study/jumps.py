"""Jumps in curves of outcomes: more predictions where a law jumps between two points of a sweep."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from wearlaw.errors import WearlawError, WearlawWarning
from wearlaw.models.law import Law
from wearlaw.pipeline.prediction import Prediction
from wearlaw.study.results import Results

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from wearlaw.arrays.array import Array
    from wearlaw.figures.curves import Curve
    from wearlaw.pipeline.pipeline import Pipeline

SEEN = 0.02
"""Least jump that is looked for, as a share of the curve's range, linear or logarithmic."""

PARTS, ROUNDS = 16, 5
"""Parts into which an interval falls in each round; 16^-5 of a distance between points is less than a line's width."""

PASSES = 3
"""Most jumps found between two neighbouring points of a sweep."""


def with_jumps(results: Results, sweep: str, axis: str, x: str, y: str, pair: str, curve: Curve) -> Curve:
    """Return the curve of an outcome of a pair along an axis of a sweep, with both sides of each jump of its law.

    Without them a line between two points of the sweep would turn a jump into a ramp.
    """
    pipeline, grid = results.pair(pair).pipeline, results.case.sweeps[sweep]
    (law,) = pipeline.laws
    if not any(law.jumps(law.numbers).values()) or axis not in grid.axes():
        return curve
    units = results.case.result_units

    def predicted(values: Array, chosen: Pipeline[...] = pipeline) -> Prediction:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", WearlawWarning)  # running the case has repeated them
            return chosen.predict(chosen.posed(grid.conditions_along(axis, values)))

    def outcome(values: Array, chosen: Pipeline[...] = pipeline) -> Array:
        found: Array = predicted(values, chosen).outcome(y).to(units[y]).magnitude
        return found

    points, known = grid.values_along(axis), results.pair(pair).jumps
    key = (sweep, axis, y, points.tobytes(), curve.y.tobytes(), curve.low is None)
    try:
        if key not in known:
            sides, behind = jumps_of(points, curve.y, outcome)
            new = predicted(sides) if sides.size else None
            band = () if new is None or curve.low is None else _band(law)
            known[key] = sides, behind, new, [outcome(sides, pipeline.with_law(end)) for end in band]
        sides, behind, new, ends = known[key]
        if new is None:
            return curve
        along = grid.in_units(axis, sides, units) if x == axis else getattr(new, x).to(units[x]).magnitude
    except WearlawError:  # a rig may not take the values between those of the sweep
        return curve
    low, high = ends or (None, None)

    def joined(old: Array | None, more: Array | None) -> Array | None:
        return None if old is None or more is None else np.insert(old, behind, more)

    return replace(
        curve,
        x=np.insert(curve.x, behind, np.abs(along)),
        y=np.insert(curve.y, behind, new.outcome(y).to(units[y]).magnitude),
        low=joined(curve.low, low),
        high=joined(curve.high, high),
        outside=None if curve.outside is None else np.insert(curve.outside, behind, new.outside_range.magnitude > 0.0),
    )


def _band(law: Law) -> tuple[Law, Law]:
    """Return a law with the low and the high end of its published range."""
    band = law.band()
    assert band is not None
    return band[0], band[2]


def jumps_of(points: Array, values: Array, function: Callable[[Array], Array]) -> tuple[Array, NDArray[np.intp]]:
    """Return the arguments on both sides of the jumps of a function, and the index of the next point of each.

    Parameters
    ----------
    points, values : ndarray, (points,)
        Arguments in their order, and the values of the function there.
    function : callable
        Gives values for an array of arguments.
    """
    sides: list[Array] = []
    known, heights = points, values
    for _ in range(PASSES):
        low, high = _brackets(known, heights, function)
        if not low.size:
            break
        sides += [low, high]
        known, heights = _inserted(known, heights, np.concatenate([low, high]), function)
    found = np.setdiff1d(np.concatenate(sides), points) if sides else np.empty(0)
    upwards = points[-1] >= points[0]
    found = found if upwards else found[::-1]
    behind = np.searchsorted(points if upwards else -points, found if upwards else -found)
    return found, behind


def _inserted(known: Array, heights: Array, new: Array, function: Callable[[Array], Array]) -> tuple[Array, Array]:
    every, values = np.append(known, new), np.append(heights, function(new))
    order = np.argsort(every if known[-1] >= known[0] else -every, kind="stable")
    return every[order], values[order]


def _brackets(points: Array, values: Array, function: Callable[[Array], Array]) -> tuple[Array, Array]:
    """Return the narrow ends around the largest jump in each interval that has one."""
    change = _changes(values)
    narrow = abs(np.diff(points)) <= 2.0 * PARTS**-ROUNDS * np.ptp(points)
    here = np.flatnonzero((change(values[:-1], values[1:]) > SEEN) & ~narrow)
    low, high = points[here], points[here + 1]
    for _ in range(ROUNDS):
        if not low.size:
            break
        inner = np.linspace(low, high, PARTS + 1, axis=1)
        found = function(inner.ravel()).reshape(inner.shape)
        steps = change(found[:, :-1], found[:, 1:])
        steepest = steps.argmax(axis=1)
        rows = np.flatnonzero(steps.max(axis=1) > SEEN)
        low, high = inner[rows, steepest[rows]], inner[rows, steepest[rows] + 1]
    return low, high


def _changes(values: Array) -> Callable[[Array, Array], Array]:
    """Return a function that gives the larger change from one value to another, linear or logarithmic, as shares."""
    seen = values[np.isfinite(values)]
    positive = seen[seen > 0.0]
    width = np.ptp(seen) if seen.size else 0.0
    decades = np.ptp(np.log(positive)) if positive.size else 0.0

    def change(first: Array, second: Array) -> Array:
        with np.errstate(divide="ignore", invalid="ignore"):
            linear = abs(second - first) / width if width else np.zeros(first.shape)
            ratio = abs(np.log(second / first)) / decades if decades else np.zeros(first.shape)
            both: Array = np.fmax(np.nan_to_num(linear), np.where(np.isfinite(ratio), ratio, 0.0))
        return both

    return change
