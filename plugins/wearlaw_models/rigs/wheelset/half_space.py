"""The normal problem of a patch on elastic half-spaces, solved element by element.

Where the bodies touch, the displacement by the pressure closes the gap and the approach δ is used up; elsewhere the
pressure is zero:

    g(x, t) + 1/(π E*) ∫∫ p/√((x - x')² + (t - t')²) dx' dt' = δ  where p > 0,  ≥ δ  where p = 0.

The pressure is constant on rectangles (A. E. H. Love, Phil. Trans. R. Soc. Lond. A 228 (1929) 377-420), and conjugate
gradients find it together with the area of contact, with products by FFT (I. A. Polonsky and L. M. Keer, Wear 231
(1999) 206-219). Elements lie on multiples of their size from the contact point, and their size follows the area in
which the undeformed bodies overlap. So the force is a continuous function of δ, and on an ellipse the error of its
grid does not depend on δ.

The gap of a wheel is that between the surfaces in space. Rows of elements are halved where a hump is so narrow that the
pressure changes much from one row to the next; neighbours then become one, of the same force and area. A row with the
force per width q and the maximum pressure p0 becomes a strip of half the length 2q/(π p0), which it has if its pressure
is half an ellipse, as on Hertz's patch. Strips lie about x = 0, although yaw moves rows along the rail.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import scipy
from numpy.typing import NDArray

from wearlaw import Array
from wearlaw_models.rigs.wheelset.candidates import Candidates
from wearlaw_models.rigs.wheelset.motion import curvature_along, placed
from wearlaw_models.rigs.wheelset.search import Position, Section, gaps
from wearlaw_models.rigs.wheelset.search_loops import tangential

FAR = 1e3
"""Gap where the bodies are sure not to touch, over the approach."""

ACCURACY = 1e-9
"""Greatest gap within the area of contact that is left over, over the approach."""

ITERATIONS = 500
"""Greatest number of iterations; 15 to 40 are usual."""

NEWTON, CLOSE = 3, 1e-9
"""Most steps to places below and distances along the normal, and the step that is enough [m]: of a tenth of a
millimetre, this takes two or three."""

TARGET = 0.02
"""Estimated error of the maximum pressure from which on rows are halved, as a share of it."""

FINEST = 8
"""Greatest number of rows in place of one."""

FLOOR = 1e-6
"""Pressure and length of strips that do not touch, over the greatest ones."""


class Rows(NamedTuple):
    """Rows of elements of a patch, and its pressure.

    Attributes
    ----------
    y, half_length, max_pressure, width : ndarray
        Place across the patch from the contact point, half the length [m], the maximum pressure [Pa] and the width of
        each row [m].
    rail_y : float
        Place of the centre of the pressure on the rail, in the axes of `Gaps.y` [m].
    angle : float
        Contact angle, the mean over the pressure [rad].
    error : float
        Estimate of the error of the maximum pressure, as a share of it [-].
    finer : int
        Rows of elements in place of one of the count that was asked for.
    pressure : ndarray, (along x, along y)
        Pressure of the elements [Pa].
    middle, own : int
        Indices of the contact point among them.
    """

    y: Array
    half_length: Array
    max_pressure: Array
    width: Array
    rail_y: float
    angle: float
    error: float
    finer: int
    pressure: Array
    middle: int
    own: int


def rows(
    section: Section, place: Candidates, depth: float, modulus: float, count: int, start: Rows | None = None
) -> Rows:
    """Return the rows of the patch of one place at a penetration along its normal.

    Parameters
    ----------
    section : Section
    place : Candidates
        One place.
    depth : float
        Approach along the normal, δ [m].
    modulus : float
        Effective modulus, E* [Pa].
    count : int
        Number of rows over the width in which the undeformed bodies overlap, and of elements over its length. Those
        rows that touch are about two thirds of them. Rows are halved until the error is `TARGET`; neighbours then
        become one, so that `count` are returned all the same.
    start : Rows, optional
        Those of a penetration close by; they save iterations, and their rows are at least as narrow.
    """
    low, high, width = _overlap(section, place, depth)
    dx = 2.0 * np.sqrt(depth / float(place.curvature_x[0])) / count
    finer = 1 if start is None else start.finer
    while True:
        dy = width / (count * finer)
        y = dy * np.arange(np.floor(low / dy) - count // 2, np.ceil(high / dy) + count // 2)
        grid = _grid(section, place, depth, y, dx)
        guess = None if start is None else _moved(start, grid)
        near, pressure = grid.height < depth, np.zeros(grid.gap.shape)
        inside = slice(near.argmax(), near.size - near[::-1].argmax())
        first = None if guess is None or not guess[:, inside].any() else guess[:, inside]
        pressure[:, inside] = pressed(grid.gap[:, inside], dx, dy, modulus, depth, first)
        error = _error(pressure.max(axis=0))
        if error <= TARGET or finer == FINEST:
            break
        finer, start = 2 * finer, None
    most, force = pressure.max(axis=0), dx * pressure.sum(axis=0)
    share = force / force.sum()
    # The pressed wheel overlaps the rail, and on a slope the surfaces' points on a normal then differ in y.
    rail_y = float(np.interp(share @ y, y, grid.foot))
    kept, begin = _joined(most, grid.height, count)
    size = np.diff(np.append(begin, kept.size))
    length = 2.0 / np.pi * force / np.maximum(most, FLOOR * most.max())
    y, force, half_length = (np.add.reduceat(one[kept], begin) / size for one in (y, force, length))
    half_length = np.maximum(half_length, FLOOR * half_length.max())
    greatest = np.maximum.reduceat(most[kept], begin)
    most = np.maximum(2.0 / np.pi * force / half_length, FLOOR * most.max())
    top = greatest.argmax()  # the maximum pressure of the patch is that of the narrow rows
    most[top], half_length[top] = greatest[top], 2.0 / np.pi * force[top] / greatest[top]
    return Rows(
        y, half_length, most, dy * size, rail_y, float(share @ grid.angle), error, finer, pressure, grid.middle,
        grid.own,
    )  # fmt: skip


def _overlap(section: Section, place: Candidates, depth: float) -> tuple[float, float, float]:
    """Return places across the patch beyond the overlap of the undeformed bodies, and the width of the overlap [m]."""
    window = np.flatnonzero(np.isfinite(place.samples[0]))
    y, arc = place.start[0] + place.step[0] * window, place.arcs[0, window]
    shift = gaps(section, place.position, arc).x - gaps(section, place.position, place.arc).x
    height = _above(section, place, depth, shift, y, arc)[0]
    rise = np.sqrt(np.maximum(height, 0.0)) - np.sqrt(depth)  # linear from sample to sample where the gap is a parabola
    within, beyond = (np.maximum(one[:-1], 0.0) + np.maximum(one[1:], 0.0) for one in (-rise, rise))
    step = float(place.step[0])
    low, high = y[np.flatnonzero(rise < 0.0)[[0, -1]]]
    return low - step, high + step, step * float((within / (within + beyond)).sum())


def _error(most: Array) -> float:
    """Return an estimate of the error of the maximum pressure, as a share of it, from those of rows.

    It is an eighth of the second difference from row to row at a peak. Peaks with less than half the greatest pressure
    do not count.
    """
    before, here, after = most[:-2], most[1:-1], most[2:]
    peak = (here >= before) & (here >= after) & (here >= 0.5 * most.max())
    return float(((2.0 * here - before - after)[peak] / (8.0 * here[peak])).max())


def _joined(most: Array, height: Array, count: int) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return the rows to keep, and where the groups of neighbours begin that become one row each, `count` in all.

    Areas that touch share the groups by the root of their number of rows. Where few rows touch, all of them are kept,
    and the nearest of the others.
    """
    touches = most > 0.0
    if np.count_nonzero(touches) <= count:
        return np.sort(np.argsort(np.where(touches, most, -height))[-count:]), np.arange(count)
    kept = np.arange(touches.argmax(), touches.size - touches[::-1].argmax())  # rows stay next to each other
    begins = np.append(0, np.flatnonzero(np.diff(touches[kept])) + 1)
    wide, groups = np.diff(np.append(begins, kept.size)), np.ones(begins.size, dtype=np.intp)
    shared = np.where(touches[kept][begins], wide, 1)  # rows that do not touch are one
    while groups.sum() < count:
        groups[np.where(groups < shared, np.sqrt(shared) / groups, 0.0).argmax()] += 1
    first = [begin + np.arange(n) * size // n for begin, size, n in zip(begins, wide, groups, strict=True)]
    return kept, np.concatenate(first)


class _Grid(NamedTuple):
    """Gap of the undeformed bodies.

    Attributes
    ----------
    gap : ndarray, (along x, along y)
        The gap as they touch, on elements [m]; far from the patch, `FAR` approaches.
    height, foot, angle : ndarray, (along y,)
        The least gap of a row [m], its place on the rail, in the axes of `Gaps.y` [m], and contact angle [rad].
    middle, own : int
        Indices of the contact point.
    """

    gap: Array
    height: Array
    foot: Array
    angle: Array
    middle: int
    own: int


def _grid(section: Section, place: Candidates, depth: float, y: Array, dx: float) -> _Grid:
    """Return the gap on rows at y, of elements dx long [m]; the rest as in `rows`."""
    own = int(np.abs(y).argmin())
    known = np.isfinite(place.between(place.samples, y[None])[0]) & (np.abs(y) < -place.start[0])
    arc = place.arc_at(y[None])[0]
    height, foot, shift = np.full(y.shape, FAR * depth), y.copy(), np.zeros(y.shape)
    if known.sum() > 1:
        shift[known] = gaps(section, place.position, arc[known]).x - gaps(section, place.position, place.arc).x
        height[known], arc[known], foot[known] = _above(section, place, depth, shift[known], y[known], arc[known])
    if not (height < depth).any():  # on the way to a balance, the contact point may lie beyond the known surfaces
        height[own - 1 : own + 2] = 0.0
    there = placed(section, place.position, arc)
    bend = 0.5 * curvature_along(section, place.position, there, arc) / np.cos(there.angle - place.angle)
    near = height < depth
    middle = int((np.abs(shift[near]) + np.sqrt((depth - height[near]) / bend[near])).max() / dx) + 1
    x = dx * np.arange(-middle, middle + 1.0)[:, None]
    gap = np.where(near, height + bend * (x - shift) ** 2, FAR * depth)
    true = near & known
    if true.sum() > 1:
        gap[:, true], _, _ = _above(section, place, depth, x, y[true], arc[true])
    return _Grid(gap, height, foot, there.angle, middle, own)


def _above(
    section: Section, place: Candidates, depth: float, x: Array, y: Array, arc: Array
) -> tuple[Array, Array, Array]:
    """Return the gap along the normal [m], the arc length of the wheel, and y of the rail, at places in the plane.

    The wheel is lowered, not pressed along its normal, and the gap taken along the normal.

    Parameters
    ----------
    section : Section
    place : Candidates
    depth : float
        As in `rows`.
    x, y : ndarray
        Distances from the contact point along the rail and across it, in the plane of contact [m].
    arc : ndarray, like y
        Guess of the arc length of the wheel below them [m].
    """
    first, slope = gaps(section, place.position, place.arc), float(np.tan(place.angle[0]))
    cos, sin = np.cos(place.angle), np.sin(place.angle)
    rate, along = np.gradient(arc, y), first.x + x
    across, down = _wheel(section, place.position, along, arc)
    for _ in range(NEWTON):
        beside = y - tangential(across - first.y, down - first.z, slope)
        if np.abs(beside).max() < CLOSE:
            break
        arc = arc + rate * beside
        across, down = _wheel(section, place.position, along, arc)
    distance = np.zeros(across.shape)
    for _ in range(NEWTON):
        rail, slopes = section.rail_z.at(across - distance * sin)
        step = (rail - down - first.gap - depth / cos - distance * cos) / (cos + slopes * sin)
        distance += step
        if np.abs(step).max() < CLOSE:
            break
    return distance + depth, arc, across - distance * sin


def _wheel(section: Section, position: Position, x: Array, arc: Array) -> tuple[Array, Array]:
    """Return y and z of points of the wheel at places x along the rail and arc lengths of the profile [m]."""
    y, radius = section.wheel_y.at(arc)[0], section.wheel_radius.at(arc)[0]
    displacement, roll, yaw, _ = position
    across = y * np.cos(roll) - radius * np.sin(roll)
    sine = cosine = np.zeros(1)
    for _ in range(2):  # the height above the axle hardly changes the place across
        sine = (x + across * np.sin(yaw)) / (radius * np.cos(yaw))
        cosine = np.sqrt(1.0 - sine**2)
        across = y * np.cos(roll) - radius * cosine * np.sin(roll)
    return across * np.cos(yaw) + radius * sine * np.sin(yaw) + displacement, y * np.sin(
        roll
    ) + radius * cosine * np.cos(roll)


def _moved(start: Rows, grid: _Grid) -> Array:
    """Return a pressure on another grid, by elements from the contact point."""
    found = np.zeros(grid.gap.shape)
    new, old = [], []
    ends = zip(grid.gap.shape, start.pressure.shape, (grid.middle, grid.own), (start.middle, start.own), strict=True)
    for size, other, at, was in ends:
        before, after = min(at, was), min(size - at, other - was)
        new.append(slice(at - before, at + after))
        old.append(slice(was - before, was + after))
    found[tuple(new)] = start.pressure[tuple(old)]
    return found


def pressed(gap: Array, dx: float, dy: float, modulus: float, approach: float, start: Array | None = None) -> Array:
    """Return the pressure of half-spaces on the elements of a grid, (along x, along y) [Pa].

    Parameters
    ----------
    gap : ndarray, (along x, along y)
        Gap of the undeformed bodies as they touch [m]. The grid reaches beyond the patch.
    dx, dy : float
        Size of an element [m].
    modulus : float
        Effective modulus, E* [Pa].
    approach : float
        Approach of the bodies from first touching, δ [m].
    start : ndarray, optional
        A guess of the pressure.

    Raises
    ------
    NumericsError
        If no solution is found.
    """
    nx, ny = gap.shape
    shape = scipy.fft.next_fast_len(2 * nx - 1, real=True), scipy.fft.next_fast_len(2 * ny - 1, real=True)
    x, y = (dx * (np.arange(nx + 1) - 0.5))[:, None], dy * (np.arange(ny + 1) - 0.5)
    corner = x * np.arcsinh(y / np.abs(x)) + y * np.arcsinh(x / np.abs(y))
    quarter = np.diff(np.diff(corner, axis=0), axis=1) / (np.pi * modulus)
    kernel = np.zeros(shape)
    kernel[:nx, :ny] = quarter
    kernel[shape[0] - nx + 1 :, :ny] = quarter[:0:-1]
    kernel[:, shape[1] - ny + 1 :] = kernel[:, ny - 1 : 0 : -1]
    transform = scipy.fft.rfft2(kernel)

    def displaced(pressure: Array) -> Array:
        product = transform * scipy.fft.rfft2(pressure, s=shape)
        moved: Array = scipy.fft.irfft2(product, s=shape)[:nx, :ny]
        return moved

    def overlap() -> Array:
        """Return a first pressure, with the displacement of the bodies where they overlap most."""
        least = gap.min()  # far from zero where the deepest point is not that of first touching
        root = np.sqrt(np.maximum(0.5 * (approach + (least if least > 0.5 * approach else 0.0)) - gap, 0.0))
        return np.asarray(root * ((approach - least) / displaced(root).max()))

    pressure = overlap() if start is None else start
    rest, small = displaced(pressure) + gap - approach, ACCURACY * approach
    step, before = np.zeros_like(gap), np.inf
    for _ in range(ITERATIONS):
        touches = pressure > 0.0
        if np.abs(rest[touches]).max() < small and rest[~touches].min(initial=0.0) > -small:
            return pressure
        norm = float(np.square(rest[touches]).sum())
        step = np.where(touches, rest + norm / before * step, 0.0)
        moved = displaced(step)
        length = float((rest * step).sum() / (moved * step).sum())
        trial, before = pressure - length * step, norm
        again = (trial <= 0.0) & (rest < -small)
        if again.any() or (trial < 0.0).any():
            pressure = np.maximum(np.where(again, pressure - length * rest, trial), 0.0)
            if not pressure.any():  # the guess was far too high
                pressure = overlap()
            rest = displaced(pressure) + gap - approach
            before = np.inf if again.any() else norm
        else:
            pressure, rest = trial, rest - length * moved
    raise ArithmeticError(f"no pressure on half-spaces was found in {ITERATIONS} iterations")
