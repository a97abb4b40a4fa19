"""Places where wheels may touch their rails under load, and the gaps around them."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

import wearlaw as wl
from wearlaw import Array
from wearlaw_models.rigs.wheelset.motion import curvature_along, placed
from wearlaw_models.rigs.wheelset.normal_loops import NEED
from wearlaw_models.rigs.wheelset.search import BLOCK, Position, Section, Touching, gaps
from wearlaw_models.rigs.wheelset.search_loops import compiled_samples, lagrange, normal_gap, tangential

SAMPLES = 81
"""Samples of the gap under a patch."""

SPACING = 0.25e-3
"""Distance from one sample to the next [m]; it is doubled where a patch is wider than the samples."""

SEPARATE = 0.5
"""Two bumps are patches of their own if the gap between them exceeds this share of the penetration, the share of the
virtual penetration."""

SPARE = 1.5
"""A patch is followed if its gap is at most this share of the penetration under the whole load."""


NEIGHBOURS = 0.5e-3
"""Places at two rolls are one if they lie closer along the wheel [m]."""

LINEAR = "arc", "angle", "lever", "curvature_x"
"""What changes in proportion to the roll, by `rates`."""

LEVEL_ANGLE = 0.2
"""Two places are one patch of half-spaces if their contact angles differ by less: cos 0.2 = 0.98 [rad]."""


@dataclass(frozen=True)
class Candidates:
    """Places where wheels may touch under load, as arrays with one entry for each of them.

    Attributes
    ----------
    point, side, number : ndarray of int
        Index of the position, of the side (0 left, 1 right) and of the patch on its side.
    position : Position
        In outward coordinates.
    arc, gap : ndarray
        Arc length of the wheel's profile, and vertical gap there at first touching [m].
    angle : ndarray
        Contact angle there, δ [rad].
    lever : ndarray
        y + z tan δ, by which a roll changes the gap there [m].
    start, step, samples : ndarray
        The gap normal to the surface around the place as it was last searched, above its least value and not negative
        by rounding, at even steps across the track in the plane of contact [m]; `samples` has the shape (places,
        samples).
    arcs : ndarray, (places, samples)
        Arc length of the wheel's profile at the samples [m].
    curvature_x : ndarray
        Half the relative curvature along the rolling direction [1/m].
    rates : ndarray, (places, 4)
        Rates of `LINEAR` with the roll of the position, from the last two searches; 0 if there was one.
    tilts : ndarray, (places, samples)
        Those of the samples [m/rad].
    turned : ndarray
        Change of the roll since the last search [rad].
    """

    point: NDArray[np.intp]
    side: NDArray[np.intp]
    number: NDArray[np.intp]
    position: Position
    arc: Array
    gap: Array
    angle: Array
    lever: Array
    start: Array
    step: Array
    samples: Array
    arcs: Array
    curvature_x: Array
    rates: Array
    tilts: Array
    turned: Array

    @property
    def cosine(self) -> Array:
        """Cos δ of each place [-]."""
        return np.cos(self.angle)

    @property
    def wheel(self) -> NDArray[np.intp]:
        """Index of the wheel among all wheels."""
        return 2 * self.point + self.side

    @property
    def gaps(self) -> Array:
        """The samples at the present roll, not negative [m]."""
        if not self.turned.any():
            return self.samples
        return np.maximum(self.samples + self.tilts * self.turned[:, None], 0.0)

    def arc_at(self, offset: Array) -> Array:
        """Return arc lengths of the wheel at distances across the track, (places, n) [m]; NaN for none."""
        return self.between(self.arcs, offset) + (self.rates[:, 0] * self.turned)[:, None]

    def learn(self, before: Candidates, rows: NDArray[np.intp], change: Array) -> NDArray[np.bool_]:
        """Find the rates, in place, and return at which positions they are known.

        Parameters
        ----------
        before, rows
            Places as they were found before, and which of them are those of the same positions.
        change : ndarray, (positions of the task,)
            Change of the roll since then [rad].
        """
        count = 2 * change.size
        wheel = before.wheel[rows]
        same = np.bincount(self.wheel, minlength=count) == np.bincount(wheel, minlength=count)
        new, old = np.flatnonzero(same[self.wheel]), rows[same[wheel]]
        moved = np.stack([getattr(self, name)[new] - getattr(before, name)[old] for name in LINEAR], axis=-1)
        moved += before.rates[old] * before.turned[old, None]  # to where the places were found
        with np.errstate(invalid="ignore", divide="ignore"):  # infinite gaps, and positions that did not roll
            rates = moved / change[self.point[new], None]
            tilts = (self.samples[new] - before.samples[old]) / change[self.point[new], None]
        self.rates[new], self.tilts[new] = (np.where(np.isfinite(one), one, 0.0) for one in (rates, tilts))
        known = np.zeros(self.point.shape, dtype=np.bool_)
        known[new] = (np.abs(moved[:, 0]) < NEIGHBOURS) & (self.step[new] == before.step[old])
        learnt: NDArray[np.bool_] = (change != 0.0) & (np.bincount(self.point, ~known, change.size) == 0)
        return learnt

    def turn(self, by: Array) -> None:
        """Roll the positions of the places by so much [rad], in place; the gaps above the first place stay."""
        self.turned[:] += by
        for name, change in zip(LINEAR, (self.rates * by[:, None]).T, strict=True):
            getattr(self, name)[:] += change
        self.position.roll[:] += np.where(self.side == 1, by, -by)

    def between(self, values: Array, offset: Array) -> Array:
        """Return values at samples, (places, samples), at distances across the track, (places, n) [m]; NaN for none."""
        u = (offset - self.start[:, None]) / self.step[:, None]
        base = np.clip(u.astype(np.intp) - 1, 0, SAMPLES - 4)
        near = np.take_along_axis(values[:, None], base[..., None] + np.arange(4), axis=-1)
        with np.errstate(invalid="ignore"):  # infinite gaps
            found: Any = sum(w * near[..., i] for i, w in enumerate(lagrange(u - base, (0.0, 1.0, 2.0, 3.0))))
        return np.asarray(found)

    def part(self, rows: NDArray[Any]) -> Candidates:
        """Return some of the places."""
        found = {name: getattr(self, name)[rows] for name in self.__dataclass_fields__ if name != "position"}
        return Candidates(position=Position(*(array[rows] for array in self.position)), **found)

    def put(self, rows: NDArray[np.intp], other: Candidates) -> None:
        """Replace some of the places, in place."""
        for name in self.__dataclass_fields__:
            if name != "position":
                getattr(self, name)[rows] = getattr(other, name)
        for array, values in zip(self.position, other.position, strict=True):
            array[rows] = values

    def joined(self, other: Candidates) -> tuple[Candidates, NDArray[np.intp]]:
        """Return the places of both in the order of their wheels, and which of this, then the other, each is."""
        order = np.argsort(np.concatenate([self.wheel, other.wheel]), kind="stable")
        found = {
            name: np.concatenate([getattr(self, name), getattr(other, name)])[order]
            for name in self.__dataclass_fields__
            if name != "position"
        }
        pairs = zip(self.position, other.position, strict=True)
        return Candidates(position=Position(*(np.concatenate(pair)[order] for pair in pairs)), **found), order


def candidates(section: Section, position: Position, touching: Touching, spacing: Array) -> Candidates:
    """Return all places where wheels come close to their rails, without samples yet.

    Positions and spacings of samples [m] are of shape (positions, sides).
    """
    point, side, number = np.nonzero(~np.isnan(touching.arc))
    here = Position(*(array[point, side] for array in position))
    arc = touching.arc[point, side, number]
    place = placed(section, here, arc)
    step, none = spacing[point, side], np.empty((arc.size, 0))
    return Candidates(
        point, side, number, here, arc, touching.gap[point, side, number], place.angle,
        place.y + place.z * np.tan(place.angle), -step * (SAMPLES // 2), step, none, none,
        0.5 * curvature_along(section, here, place, arc), np.zeros((arc.size, len(LINEAR))), none, np.zeros(arc.size),
    )  # fmt: skip


def sampled(section: Section, found: Candidates, among: int = 0) -> Candidates:
    """Return places with the gaps around them; `among` is the number of positions of the task, as in `searched`."""
    count = found.arc.size
    samples, arcs = np.empty((2, count, SAMPLES))
    found = replace(found, samples=samples, arcs=arcs, tilts=np.zeros((count, SAMPLES)))
    sample(section, found, np.arange(count), found.step, among)
    return found


def sample(section: Section, found: Candidates, rows: NDArray[np.intp], spacing: Array, among: int = 0) -> None:
    """Fill in, in place, the gaps around some of the places at spacings of theirs [m]; `among` as in `searched`."""
    if section.left is not None:
        for side, one in enumerate(section.sides):
            here = found.side[rows] == side
            sample(one, found, rows[here], spacing[here], among)
        return
    found.start[rows] = -spacing * (SAMPLES // 2)
    found.step[rows] = spacing
    if wl.accelerated(max(rows.size, among) * SAMPLES):
        samples, arcs = np.empty((2, rows.size, SAMPLES))
        position = (np.ascontiguousarray(array[rows]) for array in found.position[:3])
        compiled_samples(*position, found.arc[rows], spacing, section.tables, samples, arcs)
        found.samples[rows], found.arcs[rows] = np.maximum(samples, 0.0), arcs
        return
    middle = SAMPLES // 2
    number = np.arange(SAMPLES)
    for start in range(0, rows.size, BLOCK):
        some = rows[start : start + BLOCK]
        offsets = spacing[start : start + BLOCK, None] * (number - middle)
        arc = found.arc[some, None] + offsets
        at = gaps(section, Position(*(array[some] for array in found.position)).widened(), arc)
        gap, y, z = (array - array[:, middle, None] for array in (at.gap, at.y, at.z))
        own_slope = at.rail_slope[:, middle, None]
        height, inside = normal_gap(gap, at.rail_slope, own_slope)
        t = tangential(y, z, own_slope)
        inside &= (arc >= section.wheel_y.start) & (arc <= section.wheel_y.end)
        inside &= (at.y >= section.rail_z.start) & (at.y <= section.rail_z.end)
        turns = np.zeros_like(inside)  # behind its own horizon
        turns[:, :middle] = t[:, 1 : middle + 1] <= t[:, :middle]
        turns[:, middle + 1 :] = t[:, middle + 1 :] <= t[:, middle:-1]
        out = turns | ~inside
        first = np.where(out & (number <= middle), number + 1, 0).max(axis=-1, keepdims=True)
        last = np.where(out & (number > middle), number - 1, SAMPLES).min(axis=-1, keepdims=True).clip(0, SAMPLES - 1)
        low, high = (np.take_along_axis(t, end.clip(0, SAMPLES - 1), axis=-1) for end in (first, last))
        known = (last - first >= 3) & (offsets >= low) & (offsets <= high)
        ordered = np.where(number < first, -np.inf, np.where(number > last, np.inf, t))
        cell = np.array([np.searchsorted(t, at, side="right") for t, at in zip(ordered, offsets, strict=True)]) - 1
        stencil = np.clip(cell - 1, first, np.maximum(last - 3, first)).clip(0, SAMPLES - 4)[..., None] + np.arange(4)
        four = (np.moveaxis(array[np.arange(some.size)[:, None, None], stencil], -1, 0) for array in (t, height, arc))
        places, heights, arcs = four
        with np.errstate(invalid="ignore", divide="ignore"):
            weights = lagrange(offsets, places)
            for array, four, otherwise in ((found.samples, heights, np.inf), (found.arcs, arcs, arc)):
                through = sum(weight * one for weight, one in zip(weights, four, strict=True))
                array[some] = np.where(known, through, otherwise)
        found.samples[some] = np.maximum(found.samples[some], 0.0)


def distinct(found: Candidates, saddle: Array, penetration: Array, share: Array, joins: bool) -> NDArray[np.bool_]:
    """Return which places are patches of their own.

    Parameters
    ----------
    found : Candidates
        Places, with or without samples.
    saddle : ndarray
        Vertical gap of the saddle between each place and the first one of its wheel [m].
    penetration : ndarray
        Estimate of the vertical penetration of each place's wheel [m].
    share : ndarray
        Share of the penetration that the saddle must exceed, `SEPARATE` or less.
    joins : bool
        Whether places that lie nearly in the plane of the first one are one patch with it, whatever the saddle.
    """
    own = (found.gap < SPARE * penetration) & (saddle > share * penetration)
    first = np.zeros(found.wheel.max(initial=-1) + 1, dtype=np.intp)
    first[found.wheel[found.number == 0]] = np.flatnonzero(found.number == 0)
    first = first[found.wheel]
    apart = np.abs(found.arc - found.arc[first])
    own &= apart > SPACING  # a place may be listed twice
    if joins:
        level = np.abs(found.angle - found.angle[first]) < LEVEL_ANGLE
        own &= ~(level & (apart < 0.5 * SAMPLES * found.step[first]))
    return np.asarray(own | (found.number == 0))


def separated(found: Candidates) -> Candidates:
    """Return patches, each with the gap on its own side of the saddles between them; changes their samples.

    Places with too few samples between two others belong to them.
    """
    wheel = found.wheel
    several = np.flatnonzero(np.bincount(wheel)[wheel] > 1)
    samples = found.samples[several]
    order = several[np.argsort(wheel[several], kind="stable")]
    for shift in (1, 2):
        for one, other in ((order[shift:], order[:-shift]), (order[:-shift], order[shift:])):
            same = wheel[one] == wheel[other]
            _cut(found, one[same], found.arc[other[same]])
    narrow = several[(np.isfinite(found.samples[several]).sum(axis=-1) < NEED) & (found.number[several] > 0)]
    if not narrow.size:
        return found
    found.samples[several] = samples
    return separated(found.part(np.delete(np.arange(wheel.size), narrow)))


def _cut(found: Candidates, rows: NDArray[np.intp], neighbour: Array) -> None:
    """Make the gaps infinite, in place, beyond the saddle to a neighbour at an arc length of the wheel [m]."""
    if not rows.size:
        return
    towards = np.sign(neighbour - found.arc[rows])[:, None]
    away = (found.arcs[rows] - found.arc[rows, None]) * towards
    between = (away >= 0.0) & (away <= np.abs(neighbour - found.arc[rows])[:, None])
    samples = found.samples[rows]
    highest = np.where(between & np.isfinite(samples), samples, -np.inf).argmax(axis=-1)
    border = np.take_along_axis(away, highest[:, None], axis=-1)
    found.samples[rows] = np.where(away > border, np.inf, samples)
