"""Rows across a wheel's area of contact: where they lie, how wheel and rail lie to each other there, and how they move.

Rows lie at fixed places along the rail's arc. Each has the normal of the rail, on which the bodies overlap by

    o = (p - r)·n,

with the rail's point r and the point p of the wheel's envelope on the normal. The envelope is the locus of possible
contact of the search: of all points of the wheel with the same y, it has the lowest. So x of the locus is the crest of
the row, around which the gap grows as c (x - crest)². A small displacement v of the wheel changes the overlap by
v·n' / (n·n'), n' being the normal of the wheel. It is linear in the height of the axle, in the roll and in the lateral
displacement, all of which the balance seeks.

The width of rows follows in small steps that in which the undeformed bodies overlap, and rows lie at its multiples, so
that each patch has some twenty rows, wherever it lies and whatever else is computed with it. Where the overlap bends
much, as at an edge that wear leaves, rows are split.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from wearlaw import Array
from wearlaw_models.rigs.wheelset.motion import Place, curvature_along, in_space
from wearlaw_models.rigs.wheelset.search import Position, Section
from wearlaw_models.rigs.wheelset.search_loops import locus

SAMPLE = 0.25e-3
"""Distance along the rail of the samples of the gap by which rows are chosen [m]."""

WIDEST, NARROWEST, STEP = 1e-3, 3e-5, 2.0**0.25
"""Greatest and least width of rows [m], and the ratio of two widths that follow each other."""

ROWS = 30
"""Fewest rows over the width of an overlap, unless they are the narrowest ones."""

COLUMNS = 4
"""Elements over half the length of the area of contact, as it is estimated."""

LONGEST = 12
"""Most elements over half the length of a row."""

SECANTS, FARTHEST = 12, 2e-3
"""Most steps to the point of the wheel on the normal of a row, of which three or four are usual; the longest [m]."""

CLOSE = 1e-7
"""Distance of that point from the normal [m]."""

BESIDE = 4
"""Samples on both sides of a place where the overlap bends much, up to which rows are split."""

MARGIN = 8
"""Samples beside the overlap whose rows may touch as well, once the loads balance."""

STRAIGHT = 0.2
"""Greatest difference between crests of rows, over half the length of the area, with which it is symmetric."""

SPARE = 0.3
"""Overlap that rows and elements may gain while loads are balanced, over the greatest one."""

FINE = 0.04
"""Share of the greatest overlap by which the overlap of a row may depart from the mean of its neighbours'; rows are
split until it does not."""

LEAST = 1e-6
"""Overlap for which rows are laid where wheels are apart [m]."""

APART = -1.0
"""Overlap where a row does not face the wheel [m]."""

FACING = 0.5
"""Least cosine of the angle between the normals of wheel and rail."""

HERTZ = np.array(
    [[-1.0, -0.5, 0.0, 0.5, 1.0], [0.3209, 0.4410, 0.7071, 1.3945, 3.2089], [0.4818, 0.5750, 0.7071, 0.8182, 0.8763]]
)
"""Of Hertz's ellipses, over the logarithm of L/W, half the length and half the width in which the undeformed bodies
overlap: N/(E* ∫ o dy), and a/L. They follow from the closed form, K. L. Johnson, Contact Mechanics (1985), eq. (4.26).
"""


class Samples(NamedTuple):
    """Places on the rails, (sides, samples): y, z [m], contact angle [rad]; and their arc lengths, (samples,) [m]."""

    y: Array
    z: Array
    angle: Array
    arc: Array


def samples(section: Section) -> Samples:
    """Return the samples of both rails."""
    ends = np.array([(side.rail_position.value[0], side.rail_position.value[-1]) for side in section.sides])
    arc = SAMPLE * (np.arange(np.floor(ends.min() / SAMPLE), np.ceil(ends.max() / SAMPLE)) + 0.5)
    return Samples(*section.on_rails(arc, np.array([[0], [1]])), arc)


@dataclass(frozen=True)
class Rows:
    """Rows of wheels, as arrays with one entry for each row of each wheel, in the order of wheels and of arcs.

    Attributes
    ----------
    start : ndarray of int, (wheels + 1,)
        First row of each wheel, and their number.
    wheel : ndarray of int
        Index of the wheel, 2 × position + side.
    place : Place
        Points of the wheel, relative to the middle of the axle; the angle is the mean of those of wheel and rail.
    y, z, width : ndarray
        Place on the rail and width along its arc [m].
    wheel_arc : ndarray
        Arc length of the wheel's profile [m].
    overlap : ndarray
        Overlap of the undeformed bodies along the normal [m], negative where they are apart.
    curvature : ndarray
        c, half the relative curvature along the rolling direction [1/m].
    down, out, lean : ndarray
        Rates of the overlap with the height of the axle, downwards [-], with the lateral displacement, outwards [-],
        and with the roll that lowers this side [m].
    dx : ndarray, (wheels,)
        Length of elements [m].
    columns : ndarray of int, (wheels,)
        Elements of the longest row, or over half of it where `half`.
    half : ndarray of bool, (wheels,)
        Whether crests lie so close to one line that both halves of a row have the same pressure.
    halves : ndarray of int
        Elements over half of each row.
    deepest : ndarray, (wheels,)
        Greatest overlap [m].
    """

    start: NDArray[np.intp]
    wheel: NDArray[np.intp]
    place: Place
    y: Array
    z: Array
    width: Array
    wheel_arc: Array
    overlap: Array
    curvature: Array
    down: Array
    out: Array
    lean: Array
    dx: Array
    columns: NDArray[np.intp]
    half: NDArray[np.bool_]
    halves: NDArray[np.intp]
    deepest: Array


@dataclass(frozen=True)
class Near:
    """Vertical gaps between wheels and the samples of their rails at axles of height 0, (wheels, samples) [m]."""

    gap: Array
    cosine: Array
    """Of the rail's slope, which has one entry for each sample of each wheel."""
    lean: Array
    """Rate of the gap with the roll that lowers this side, the other way round [m]."""
    radius: float

    def rolled(self, roll: Array) -> Near:
        """Return the gaps after small changes of the roll that lower this side, (wheels,) [rad]."""
        return replace(self, gap=self.gap - self.lean * roll[:, None])

    def overlap(self, height: Array) -> Array:
        """Return the overlaps along the normals at heights of the axle, (wheels,) [m]."""
        return np.asarray((height[:, None] - self.gap) * self.cosine)

    def sunk(self, load: Array, least: Array, modulus: float) -> Array:
        """Return estimates of the approach of wheels from first touching under vertical loads [m]."""
        depth = np.full(load.shape, 5e-5)
        for _ in range(6):
            overlap = np.maximum(self.overlap(least + depth), 0.0)
            most, width = overlap.max(axis=-1), (overlap > 0.0).sum(axis=-1) * SAMPLE
            shape = np.log10(
                np.sqrt(2.0 * self.radius * np.maximum(most, LEAST)) / np.maximum(0.5 * width, 0.4 * SAMPLE)
            )
            volume = (overlap * self.cosine).sum(axis=-1) * SAMPLE
            borne = modulus * np.interp(shape, HERTZ[0], HERTZ[1]) * volume
            depth *= np.clip(load / np.maximum(borne, 1e-3 * load), 0.2, 5.0) ** 0.6
        return depth


def near(section: Section, position: Position, places: Samples) -> Near:
    """Return the gaps of wheels, whose positions are arrays of shape (wheels,), at the samples."""
    y, z, angle = (array[np.asarray(position.side)] for array in places[:3])
    wide = position.widened()
    arc, inside = _arc_below(section, wide, y)
    at = _surface(section, wide, arc)
    gap = np.where(inside & np.isfinite(z), z - at.z - at.slope * (y - at.y), np.inf)
    lean = at.y - wide.displacement + at.slope * at.z
    return Near(gap, np.cos(angle), lean, 1.0 / (1.0 / float(section.wheel_radius.value.mean()) + section.roller))


def _across(section: Section, position: Position, arc: Array, row: tuple[Array, ...]) -> tuple[Array, Surface]:
    """Return arc lengths at which wheels lie on the normals of rows, and the points there, by the secant method.

    Rows are y and z, the latter from the height of the axle, and the cosine and the sine of the angle.
    """
    y, z, cos, sin = row
    arc, open_ = arc.copy(), np.arange(arc.size)
    at = _surface(section, position, arc)
    last = before = np.full(arc.shape, np.nan)
    for _ in range(SECANTS):
        beside = (at.y - y) * cos + (at.z - z) * sin
        open_ = open_[np.abs(beside[open_]) > 1e-3 * CLOSE]
        if not open_.size:
            break
        rate = (cos + at.slope * sin) / np.sqrt(1.0 + at.slope**2)  # but for the yaw, which turns the locus
        with np.errstate(invalid="ignore", divide="ignore"):
            secant = (beside - before) / (arc - last)
        rate = np.where((secant > 0.1 * rate) & (secant < 10.0 * rate), secant, np.maximum(rate, 0.1))
        last, before = arc.copy(), beside
        arc[open_] -= np.clip(beside / rate, -FARTHEST, FARTHEST)[open_]
        some = _surface(section, Position(*(array[open_] for array in position)), arc[open_])
        at = Surface(*(array.copy() for array in at))
        for array, new in zip(at, some, strict=True):
            array[open_] = new
    return arc, at


class Surface(NamedTuple):
    """Points of wheels' envelopes from the middle of the track and the axle [m], slope [-] and radius [m]."""

    x: Array
    y: Array
    z: Array
    slope: Array
    radius: Array


def _surface(section: Section, position: Position, arc: Array) -> Surface:
    y, dy = section.at("wheel_y", arc, position.side)
    radius, d_radius = section.at("wheel_radius", arc, position.side)
    turn = np.sin(position.roll), np.cos(position.roll), np.sin(position.yaw), np.cos(position.yaw)
    x, across, down, slope = locus(y, radius, d_radius / dy, position.displacement, turn, section.axes)
    return Surface(x, across, down, slope, radius)


def _arc_below(section: Section, position: Position, y: Array) -> tuple[Array, NDArray[np.bool_]]:
    """Return the arc lengths of wheels near places across the track [m], and whether the wheels reach there."""
    radius = float(section.wheel_radius.value.mean())
    across = y - position.displacement + radius * np.sin(position.roll)
    arc = np.empty(across.shape)
    for number, side in enumerate(section.sides):
        here = np.broadcast_to(np.asarray(position.side) == number, across.shape)
        arc[here] = side.wheel_y.inverse(across[here])
    inside = np.isfinite(arc)
    return np.where(inside, arc, section.wheel_y.start), inside


def rows(section: Section, places: Samples, position: Position, height: Array, around: Near) -> Rows:
    """Return the rows of wheels near their rails at heights of the axle, (wheels,) [m].

    Rows of a wheel that does not overlap its rail are those for an overlap of `LEAST`.
    """
    wheel, rail_arc, width, region = _chosen(around.overlap(height), places.arc)
    side = np.asarray(position.side)[wheel]
    here = Position(*(array[wheel] for array in position))
    y, z, angle = section.on_rails(rail_arc, side)
    arc, inside = _arc_below(section, here, y)
    inside &= np.isfinite(z)
    z = np.where(inside, z, 0.0)
    cos, sin, down = np.cos(angle), np.sin(angle), height[wheel]
    arc, at = _across(section, here, arc, (y, z - down, cos, sin))
    turned = np.arctan(at.slope)
    facing = np.cos(turned - angle)
    beside = (at.y - y) * cos + (at.z + down - z) * sin
    start = np.array([pair.wheel_y.start for pair in section.sides])[side]
    end = np.array([pair.wheel_y.end for pair in section.sides])[side]
    inside &= (facing > FACING) & (np.abs(beside) < CLOSE) & (arc >= start) & (arc <= end)
    overlap = np.where(inside, (at.z + down - z) * cos - (at.y - y) * sin, APART)
    mean = 0.5 * (turned + angle)
    deepest = np.full(height.size, -np.inf)
    np.maximum.at(deepest, wheel, overlap)
    lift, deepest = np.maximum(LEAST - deepest, 0.0), np.maximum(deepest, LEAST)
    sunk = overlap + lift[wheel]  # a wheel that is lost for a while has rows all the same
    kept = sunk > -SPARE * deepest[wheel]
    wheel, region = wheel[kept], region[kept]
    width, y, z, arc, overlap, sunk, turned, mean, angle, facing, rail_arc, start, end = (
        array[kept] for array in (width, y, z, arc, overlap, sunk, turned, mean, angle, facing, rail_arc, start, end)
    )
    at, here = Surface(*(array[kept] for array in at)), Position(*(array[kept] for array in here))
    z_wheel = in_space(at.x, at.z, section.axes)
    place = Place(at.x, at.y - here.displacement, z_wheel, mean, z, at.radius, rail_arc)
    facing = np.maximum(facing, FACING)
    of_wheel = curvature_along(section, here, at.radius, np.clip(arc, start, end), np.maximum(sunk, 0.0)) / facing
    curvature = 0.5 * (of_wheel + section.roller * np.cos(angle) / (1.0 - section.roller * z))
    lean = (place.y * np.cos(turned) + at.z * np.sin(turned)) / facing
    count = np.bincount(wheel, minlength=height.size)
    first = np.concatenate([[0], np.cumsum(count)])
    # Elements are as long as the shorter one of two parts of the area needs.
    long = np.sqrt(np.maximum(sunk, 0.0) / curvature)
    wide = np.bincount(region, np.where(sunk > 0.0, 0.5 * width, 0.0))
    parts = np.zeros(wide.size)
    np.maximum.at(parts, region, long)
    with np.errstate(divide="ignore"):
        half_length = parts * np.interp(np.log10(parts / np.maximum(wide, 1e-6)), HERTZ[0], HERTZ[2])
    longest = np.zeros(height.size)
    np.maximum.at(longest, wheel, half_length[region])
    short = np.full(height.size, np.inf)
    np.minimum.at(short, wheel, np.where(half_length[region] > 0.5 * longest[wheel], half_length[region], np.inf))
    dx = short / COLUMNS
    reach = np.sqrt((sunk + SPARE * deepest[wheel]) / curvature)
    halves = np.clip(np.floor(reach / dx[wheel] + 0.5), 1, LONGEST).astype(np.intp)
    columns = np.maximum.reduceat(halves, first[:-1])
    touches = sunk > 0.0
    crest = np.where(touches, at.x, np.nan)
    low, high = np.full(height.size, np.inf), np.full(height.size, -np.inf)
    np.fmin.at(low, wheel, crest)
    np.fmax.at(high, wheel, crest)
    half = high - low < STRAIGHT * short
    return Rows(
        first, wheel, place, y, z, width, arc, overlap, curvature, np.cos(turned) / facing, -np.sin(turned) / facing,
        lean, dx, np.where(half, columns, 2 * columns), half, halves, deepest,
    )  # fmt: skip


def _chosen(overlap: Array, arc: Array) -> tuple[NDArray[np.intp], Array, Array, NDArray[np.intp]]:
    """Return wheel, arc length [m], width [m] and part of the area of the rows of wheels.

    The overlap is that of samples, (wheels, samples) [m], at their arc lengths.
    """
    overlap = overlap + np.maximum(LEAST - overlap.max(axis=-1, keepdims=True), 0.0)
    over, aside = overlap > 0.0, ((0, 0), (MARGIN + 1, MARGIN + 1))
    held = np.pad(over, aside)
    held = np.logical_or.reduce([np.roll(held, shift, axis=1) for shift in range(-MARGIN, MARGIN + 1)])
    edges = np.flatnonzero(np.diff(held.ravel(), prepend=False))  # first sample of a part, and the one behind its last
    wheel, begin = np.divmod(edges[::2], held.shape[1])
    size = edges[1::2] - edges[::2]
    asked = SAMPLE / ROWS * np.add.reduceat(np.pad(over, aside).ravel(), edges, dtype=np.intp)[::2]
    width = WIDEST * STEP ** -np.ceil(np.log(WIDEST / np.clip(asked, NARROWEST, WIDEST)) / np.log(STEP))
    low = arc[0] + SAMPLE * (begin - MARGIN - 1.5)
    first = np.ceil(low / width)
    part, number = _counted((np.floor((low + SAMPLE * size) / width) - first).astype(np.intp))
    wheel, width, middle = wheel[part], width[part], width[part] * (first[part] + number + 0.5)
    # Rows are split where the overlap bends much.
    with np.errstate(invalid="ignore"):  # beside the rail
        bend = np.abs(overlap[:, 2:] - 2.0 * overlap[:, 1:-1] + overlap[:, :-2])
        deepest = overlap.max(axis=-1, keepdims=True)
        bend = np.where(overlap[:, 1:-1] > 0.25 * deepest, bend, 0.0) / (FINE * deepest * SAMPLE**2)
    bend = np.pad(bend, ((0, 0), (1 + BESIDE, 1 + BESIDE)))
    bend = np.maximum.reduce([np.roll(bend, shift, axis=1) for shift in range(-BESIDE, BESIDE + 1)])
    nearest = np.clip(np.round((middle - arc[0]) / SAMPLE).astype(np.intp), 0, arc.size - 1)
    pieces = np.minimum(np.ceil(width * np.sqrt(bend[wheel, nearest + BESIDE])), width / NARROWEST)
    pieces = np.maximum(pieces.astype(np.intp), 1)
    row, number = _counted(pieces)
    width = width[row] / pieces[row]
    middle = middle[row] + width * (number + 0.5 - 0.5 * pieces[row])
    return wheel[row], middle, width, part[row]


def _counted(count: NDArray[np.intp]) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return the index of each item of groups with these counts, and its number in its group."""
    group = np.repeat(np.arange(count.size), count)
    return group, np.arange(group.size) - np.repeat(np.cumsum(count) - count, count)
