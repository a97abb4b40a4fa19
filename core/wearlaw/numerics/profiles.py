"""The loss of strips, spread over given positions along the profile of a body without a change of its total."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from wearlaw.arrays.array import Array


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
    found = []
    for loss in losses:
        lost = np.take_along_axis(loss, order, axis=-1) * width
        slope = _slopes(np.where(step > 0.0, lost / _or_one(step), 0.0), step)
        before = np.concatenate([np.zeros_like(lost[:, :1]), lost.cumsum(axis=-1)], axis=-1)
        up_to = np.take_along_axis(before, strip, -1) + np.take_along_axis(lost, strip, -1) * rising
        up_to += np.take_along_axis(slope, strip, -1) * leaving + np.take_along_axis(slope, strip + 1, -1) * arriving
        found.append(np.maximum(np.diff(up_to, axis=-1), 0.0) / np.diff(ends)[index])
    return index, found


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
