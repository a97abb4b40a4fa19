"""Wear profiles: the depth that a body loses across a patch, or along its own profile."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from wearlaw.arrays import Array, steady
from wearlaw.contact.parts import Body
from wearlaw.contact.problem import Problem
from wearlaw.errors import CompositionError, InputError, shown
from wearlaw.numerics.totals import blocks
from wearlaw.pipeline.selection import axis_names
from wearlaw.pipeline.solution import Solution
from wearlaw.units.quantities import QuantityLike, scalar_si
from wearlaw.units.variables import VARIABLES
from wearlaw_apps.output.datasets import Columns, data_of, labelled

if TYPE_CHECKING:
    import xarray

MOST_STRIPS = 10_000
"""Most strips of a wear profile; a wheel's patch of 10 mm then has strips of 1 µm."""

PATCH = "patch"
"""Name of the axis of patches that lie on one profile."""

POSITION = "profile_position"
"""Name of the position along a profile."""

BLOCK = 2**18
"""Positions in a block of patches."""


@steady
def wear_profile(solution: Solution, body: str, strips: int | None, at: QuantityLike | None) -> xarray.Dataset:
    """Return the depth lost and the distance slid across patches; see `Prediction.wear_profile`."""
    problem, worn = solution.problem, solution.problem.body(body)
    if problem.geometry == "line":
        raise CompositionError("wear_profile: a line wears evenly across its width; take depth_per_distance")
    if solution.model.scale == "patch":
        raise CompositionError(
            f"wear_profile: {solution.model!r} gives means of the whole patch; take a contact model that resolves it,"
            ' such as wl.contact_model("strip_theory")'
        )
    if strips is not None and (
        isinstance(strips, bool) or not isinstance(strips, int) or not 2 <= strips <= MOST_STRIPS
    ):
        raise InputError(f"strips: must be a whole number from 2 to {MOST_STRIPS}, such as 101; got {shown(strips)}")
    across = solution.across(solution.law(body=body), body, strips)
    radius = np.asarray(worn.rolling_radius)
    turns = not np.isinf(radius).any()
    once = (2.0 * np.pi * radius if turns else np.ones_like(radius))[..., None]
    units = ("um/km", "mm/m") if turns else ("nm", "um")
    depth = across.wear / (scalar_si(worn.material.density, "kg/m^3") * once)
    columns = {"depth": (depth, units[0]), "sliding_distance": (across.slid / once, units[1])}
    if problem.contact_angle is not None:
        angle = problem.contact_angle[..., None]
        columns["depth_vertical"] = depth * np.cos(angle), units[0]
        columns["depth_lateral"] = depth * np.abs(np.sin(angle)), units[0]
    per = "metre rolled" if turns else "passage of a wheel"
    if problem.unloaded is not None:
        columns = {
            name: (np.where(problem.unloaded[..., None], 0.0, values), unit) for name, (values, unit) in columns.items()
        }
    if at is not None:
        return _on_profile(problem, worn, across.y, across.width, columns, per, at)
    there = across.width > 0.0  # strips that fill up a batch lie nowhere
    if problem.unloaded is not None:
        there |= problem.unloaded[..., None]
    columns = {name: (np.where(there, values, np.nan), unit) for name, (values, unit) in columns.items()}
    batch = axis_names(problem)
    dims = [*batch, "strip"] if batch else ["y"]
    places = {"y": (np.where(there, across.y, np.nan), "mm")}
    if worn.profile_position is not None:
        places[POSITION] = _arc(worn, places["y"][0]), "mm"
    return labelled(problem, data_of(dims, places), data_of(dims, columns, per))


def _on_profile(
    problem: Problem, body: Body, y: Array, width: Array, columns: Columns, per: str, at: QuantityLike
) -> xarray.Dataset:
    """Return columns over positions of the body's profile, summed over the axis of patches if there is one.

    Raises
    ------
    InputError
        If the positions do not increase, or the rig does not know where its patches lie on the profile.
    """
    positions = VARIABLES[POSITION].expected.si(at, "at")
    if positions.ndim != 1 or positions.size < 2 or not (np.diff(positions) > 0.0).all():
        raise InputError(
            f"at: must be two or more increasing positions, such as Q(np.linspace(-40, 30, 141), 'mm'); got {shown(at)}"
        )
    if body.profile_position is None:
        raise InputError(
            "at: the rig does not say where its patches lie on the profile; leave it out, or give the bodies of the"
            " problem a `profile_position`"
        )
    names = axis_names(problem)
    rest = {name: size for name, size in zip(names, problem.batch_shape, strict=True) if name != PATCH}
    sums = {name: np.zeros((*rest.values(), positions.size)) for name in columns}
    rows = np.arange(math.prod(rest.values())).reshape(tuple(rest.values()))
    if PATCH in names:
        rows = np.expand_dims(rows, names.index(PATCH))
    there = np.broadcast_to(rows, problem.batch_shape).reshape(-1)
    arc, of_strip = _arc(body, y), [values for values, _ in columns.values()]
    if problem.exists is not None:
        exists = problem.exists
        there, arc, width, *of_strip = there[exists.reshape(-1)], *(array[exists] for array in (arc, width, *of_strip))
    arc, width, *of_strip = (array.reshape(-1, array.shape[-1]) for array in (arc, width, *of_strip))
    for some in blocks(there.size, max(BLOCK // positions.size, 1)):
        index, losses = onto_positions(arc[some], width[some], [array[some] for array in of_strip], positions)
        flat = index + positions.size * there[some, None]
        for total, values in zip(sums.values(), losses, strict=True):
            np.add.at(total.reshape(-1), flat, values)
    dims = [*rest, POSITION]
    data = data_of(dims, {name: (total, columns[name][1]) for name, total in sums.items()}, per)
    return labelled(problem, data_of([POSITION], {POSITION: (positions, "mm")}), data, without=PATCH)


def _arc(body: Body, y: Array) -> Array:
    """Return the positions of strips along the profile of the body [m]."""
    arc: Array = np.asarray(body.profile_position)[..., None] + np.asarray(body.profile_direction)[..., None] * y
    return arc


def onto_positions(
    arc: Array, width: Array, losses: Sequence[Array], positions: Array
) -> tuple[NDArray[np.intp], list[Array]]:
    """Return losses at positions along the profile, each as its mean over the cell around the position.

    The cells end half-way between positions. The sum of loss times cell is that of the strips, to rounding, if the
    positions reach over the whole patch. The trapezoidal rule over the positions gives the same sum.

    Each strip loses its loss times its width between its two edges. The loss up to an edge is interpolated by a cubic
    that is monotone, so that no loss is negative, and flat at both ends of the patch.

    Parameters
    ----------
    arc : ndarray, (patches, strips)
        Position of each strip along the profile [m].
    width : ndarray, (patches, strips)
        Width that each strip represents [m].
    losses : sequence of ndarray, (patches, strips)
        Loss of each strip over its width, in any unit.
    positions : ndarray, (positions,)
        Increasing positions along the profile [m].

    Returns
    -------
    index : ndarray, (patches, some)
        Indices of the positions that the patch may reach; the loss is zero at all others.
    losses : list of ndarray, (patches, some)
        The losses there, in the same units.

    Notes
    -----
    The slopes of the cubics are those of F. N. Fritsch, J. Butland, SIAM J. Sci. Stat. Comput. 5 (1984) 300-304, with
    weights for uneven steps.
    """
    end = np.where(width > 0.0, arc + 0.5 * width, -np.inf).max(axis=-1, keepdims=True)
    arc = np.where(width > 0.0, arc, end)  # strips that fill up a batch lie nowhere
    order = np.argsort(arc, axis=-1)
    arc, width = (np.take_along_axis(array, order, axis=-1) for array in (arc, width))
    lower, upper = arc - 0.5 * width, arc + 0.5 * width
    edges = np.concatenate([lower[:, :1], 0.5 * (upper[:, :-1] + lower[:, 1:]), upper[:, -1:]], axis=-1)
    edges = np.maximum.accumulate(edges, axis=-1)
    step = np.diff(edges, axis=-1)
    ends = np.concatenate([positions[:1], 0.5 * (positions[1:] + positions[:-1]), positions[-1:]])
    index, strip = _cells(edges, ends)
    places = ends[np.concatenate([index, index[:, -1:] + 1], axis=-1)]
    own_step = np.take_along_axis(step, strip, -1)
    into = places - np.take_along_axis(edges, strip, -1)
    t = np.where(own_step > 0.0, np.clip(into / _or_one(own_step), 0.0, 1.0), into >= 0.0)
    rising, leaving, arriving = t * t * (3.0 - 2.0 * t), own_step * t * (1.0 - t) ** 2, own_step * t * t * (t - 1.0)
    means = []
    for loss in losses:
        lost = np.take_along_axis(loss, order, axis=-1) * width
        slope = _slopes(np.where(step > 0.0, lost / _or_one(step), 0.0), step)
        before = np.concatenate([np.zeros_like(lost[:, :1]), lost.cumsum(axis=-1)], axis=-1)
        up_to = np.take_along_axis(before, strip, -1) + np.take_along_axis(lost, strip, -1) * rising
        up_to += np.take_along_axis(slope, strip, -1) * leaving + np.take_along_axis(slope, strip + 1, -1) * arriving
        means.append(np.maximum(np.diff(up_to, axis=-1), 0.0) / np.diff(ends)[index])
    return index, means


def _cells(edges: Array, ends: Array) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return the indices of the cells that a patch may reach, and the index of the strip at each of their ends."""
    after = np.searchsorted(ends, edges)  # the first end that does not lie before the edge
    cells = ends.size - 1
    first = np.clip(after[:, 0] - 1, 0, cells - 1)
    count = int(max((after[:, -1] - first).max(), 1))
    first = np.minimum(first, max(cells - count, 0))[:, None]
    count = min(count, cells)
    row = (count + 2) * np.arange(edges.shape[0])[:, None]
    begun = np.bincount((np.clip(after - first, 0, count + 1) + row).ravel(), minlength=row.size * (count + 2))
    strip = begun.reshape(-1, count + 2)[:, :-1].cumsum(axis=-1) - 1
    return first + np.arange(count), np.clip(strip, 0, edges.shape[1] - 2)


def _slopes(mean: Array, step: Array) -> Array:
    """Return the loss at each edge, from the means over the steps on both sides; zero at the ends of the patch."""
    before, after = mean[:, :-1], mean[:, 1:]
    to_before, to_after = step[:, :-1] + 2.0 * step[:, 1:], 2.0 * step[:, :-1] + step[:, 1:]
    weighted = to_before * after + to_after * before
    inside = (to_before + to_after) * before * after / _or_one(weighted)
    return np.pad(inside, ((0, 0), (1, 1)))


def _or_one(array: Array) -> Array:
    """Return an array with ones in place of zeros, for divisions whose numerator is zero too."""
    return np.where(array == 0.0, 1.0, array)
