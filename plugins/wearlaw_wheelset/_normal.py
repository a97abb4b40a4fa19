"""The normal problem of a patch whose curvature varies across it, by virtual penetration.

The gap between wheel and rail is A x² + g(t) along the rolling direction x and across it, t. The bodies approach by δ.
Kik and Piotrowski let the undeformed bodies penetrate each other by δ/2 and take the region in which they overlap as
the patch. Its width there gives Hertz's ellipse (a, b) of the curvatures A and B. The elliptic correction ends it where
g reaches a threshold that varies from A a² in the middle of the ellipse to B b² at its sides,

    e(t) = A a² - (A a² - B b²) ((t - t_m)/b)²,  l(t) = √((e - g)/A),

with half the length l of the strip at t. So an ellipse is found as Hertz's own. The pressure is proportional to
√(l² - x²), and the displacement at the deepest point t_0 of the gap is δ:

    δ = 1/(π E*) ∫∫ p/√(x² + (t - t_0)²) dx dt.

Sources: J. Piotrowski and W. Kik, Vehicle System Dynamics 46 (2008) 27-48, for the penetration and the pressure; the
elliptic correction as in the program CONTACT (E. A. H. Vollebregt, src/m_snorm.f90), where its name is KPEC.

Numerics: cubics through four samples give the gap between samples, with an error of 3/128 h⁴ g'''' at the spacing h and
of about h²/8 times a step of g''. Strips are even in the angle between the ends of the patch. The integral over x is an
elliptic one. The integral over t takes Gauss's nodes in s on each side of t_0, t = t_0 + (5 s⁴ - 4 s⁵) L, for the
logarithm at t_0 and the decay near the ends of long patches. On ellipses its error is 1e-6 for a/b from 1/20 to 20.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache
from typing import NamedTuple, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

import wearlaw as wl
from wearlaw import Array
from wearlaw_wheelset import _normal_loops as loops

NODES = 16
"""Nodes of the integral for the displacement, on each side of the deepest point."""

BLOCK = 512
"""Patches of a block in NumPy: its arrays fit in the cache."""

FEW = 100
"""Patches of whose work there is as much as of 10 000 operating points in the count of `wl.accelerated`."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class StripPatch:
    """Patches of strips, as SI arrays of shape (patches,) or (patches, strips).

    Attributes
    ----------
    penetration : ndarray
        Approach of the bodies from first touching, δ [m].
    normal_force : ndarray
        Normal force, the sum over the strips [N].
    max_pressure : ndarray
        Greatest pressure, in the middle of the longest strip [Pa].
    a, b : ndarray
        Semi-axes of the ellipse that stands for the patch in Kalker's coefficients [m]: it has the area of the patch
        and the ratio of its length to its width.
    centre : ndarray
        Mean of t, weighted with the pressure [m].
    y, width, half_length, pressure : ndarray, (patches, strips)
        Place t of the strips, the width they represent, half their length [m] and their greatest pressure [Pa].
    narrow : ndarray of bool
        Whether the patch reaches the end of the samples of its gap, so that it may be wider in truth.
    jumps : ndarray of bool
        Whether no penetration gives the normal force, as a second hump of the patch joins at this penetration. The
        strips are those without it, and their pressure is scaled to the normal force.
    """

    penetration: Array
    normal_force: Array
    max_pressure: Array
    a: Array
    b: Array
    centre: Array
    y: Array
    width: Array
    half_length: Array
    pressure: Array
    narrow: NDArray[np.bool_]
    jumps: NDArray[np.bool_]

    @property
    def area(self) -> Array:
        """Area of the patch [m²]."""
        area: Array = self.strips.area.sum(axis=-1)
        return area

    @property
    def strips(self) -> wl.Strips:
        """The strips, for `wl.Problem.of_strips`."""
        return wl.Strips(y=self.y, width=self.width, half_length=self.half_length, max_pressure=self.pressure)


def penetrated(
    start: ArrayLike,
    step: ArrayLike,
    gap: ArrayLike,
    curvature_x: ArrayLike,
    modulus: ArrayLike,
    penetration: ArrayLike,
    strips: int = 21,
) -> StripPatch:
    """Return patches at a penetration.

    Parameters
    ----------
    start, step : array_like, (patches,)
        Place of the first sample of the gap, and the distance from one to the next [m].
    gap : array_like, (patches, samples)
        Gap g at x = 0 between the bodies as they touch [m]. Samples outside of the patch's window are infinite or NaN;
        the window runs to both sides of the smallest gap.
    curvature_x : array_like, (patches,)
        A of the gap A x² + g(t) [1/m], half the relative curvature along the rolling direction.
    modulus : array_like, (patches,)
        Effective modulus, E* [Pa].
    penetration : array_like, (patches,)
        Approach of the bodies from first touching, δ [m].
    strips : int
        Number of strips of a patch.

    Raises
    ------
    InputError
        If a patch has fewer than four samples.
    """
    return _patches(start, step, gap, curvature_x, modulus, penetration, 0.0, strips)


def loaded(
    start: ArrayLike,
    step: ArrayLike,
    gap: ArrayLike,
    curvature_x: ArrayLike,
    modulus: ArrayLike,
    normal_force: ArrayLike,
    strips: int = 21,
    guess: ArrayLike | None = None,
) -> StripPatch:
    """Return patches that carry a normal force, to 1e-10 of it.

    Parameters
    ----------
    start, step, gap, curvature_x, modulus, strips
        As for `penetrated`.
    normal_force : array_like, (patches,)
        Normal force, N [N].
    guess : array_like, (patches,), optional
        A guess of the penetration [m], such as that of a load close by; it saves steps.

    Notes
    -----
    The force is a power of the penetration with a slope near 3/2, so that the secant method in logarithms takes about
    five steps; it is kept within bounds, and bisected where it leaves them. The force jumps where a second hump of the
    gap joins the patch, see `StripPatch.jumps`.
    """
    if guess is None:  # that of a sphere
        force, curvature, elastic = (np.asarray(value, dtype=float) for value in (normal_force, curvature_x, modulus))
        guess = np.cbrt(1.125 * (force / elastic) ** 2 * curvature)
    return _patches(start, step, gap, curvature_x, modulus, guess, normal_force, strips)


class HertzPatch(NamedTuple):
    """Elliptic patches: their semi-axes [m], maximum pressure [Pa] and penetration [m]."""

    a: Array
    b: Array
    max_pressure: Array
    penetration: Array


def hertz(curvature_x: Array, curvature_y: Array, modulus: Array | float, normal_force: Array) -> HertzPatch:
    """Return Hertz's patches, for gaps A x² + B t² with the curvatures A and B [1/m]."""
    a, b = wl.hertz_ellipse.semi_axes(normal_force, curvature_x, curvature_y, modulus)
    approach = wl.hertz_ellipse.approach(normal_force, a, b, modulus)
    return HertzPatch(a, b, wl.hertz_ellipse.max_pressure(normal_force, a, b), approach)


def _patches(
    start: ArrayLike,
    step: ArrayLike,
    gap: ArrayLike,
    curvature_x: ArrayLike,
    modulus: ArrayLike,
    penetration: ArrayLike,
    load: ArrayLike,
    strips: int,
) -> StripPatch:
    """Return patches at a penetration or, if the load is not zero, under it."""
    samples = np.array(gap, dtype=float, order="C")
    samples[np.isnan(samples)] = np.inf
    count = len(samples)
    given = np.empty((count, 5))
    for column, value in enumerate((step, curvature_x, modulus, penetration, load)):
        given[:, column] = value
    _check(samples)
    cosine, sine = _even(strips)
    share, weight = _nodes()
    fields, sums = np.empty((count, 3, strips)), np.empty((count, 7))
    if wl.accelerated(count * FEW):
        loops.patch_loop(samples, given, cosine, sine, share, weight, fields, sums)
    else:
        for block in range(0, count, BLOCK):
            part = slice(block, block + BLOCK)
            _solve(samples[part], given[part], cosine, sine, share, weight, fields[part], sums[part])
    return _result(np.asarray(start, dtype=float), given[:, 0], fields, sums)


def _check(samples: Array) -> None:
    """Raise an error if a patch has too few samples."""
    finite = np.isfinite(samples)
    few = finite.sum(axis=1) < loops.NEED
    if few.any():
        at = int(few.argmax())
        raise wl.InputError(
            f"gap: patch {at} has {np.count_nonzero(finite[at])} finite samples; at least {loops.NEED} are needed, "
            "so sample it more finely or widen its window"
        )


@cache
def _even(count: int) -> tuple[Array, Array]:
    """Return the cosines of strips even in the angle, and the widths over half the width of the patch."""
    angle = np.pi / (count + 1) * np.arange(count, 0, -1)
    return np.cos(angle), np.pi / (count + 1) * np.sin(angle)


@cache
def _nodes() -> tuple[Array, Array]:
    """Return nodes and weights of the integral for the displacement, on one side, over its length."""
    place, weight = np.polynomial.legendre.leggauss(NODES)
    s, weight = 0.5 + 0.5 * place, 0.5 * weight
    return s**4 * (5.0 - 4.0 * s), 20.0 * s**3 * (1.0 - s) * weight


def _result(start: Array, step: Array, fields: Array, sums: Array) -> StripPatch:
    """Return patches from the strips and sums of the loops."""
    penetration, force, slope, a, b, warning, longest = sums.T
    u, width, square = fields[:, 0], fields[:, 1], fields[:, 2]
    half_length = np.sqrt(np.maximum(square, (loops.FLOOR * longest[:, None]) ** 2))
    y = (start + 0.0)[..., None] + step[:, None] * u
    load = width * square
    return StripPatch(
        penetration=penetration,
        normal_force=force,
        max_pressure=slope * longest,
        a=a,
        b=b,
        centre=(load * y).sum(axis=-1) / load.sum(axis=-1),
        y=y,
        width=width,
        half_length=half_length,
        pressure=slope[:, None] * half_length,
        narrow=warning % 2.0 > 0.5,
        jumps=warning > 1.5,
    )


class _Gaps(NamedTuple):
    """Gaps as arrays: samples (patches, samples), the window, the deepest point, the least gap, spacing and A."""

    samples: Array
    first: NDArray[np.intp]
    last: NDArray[np.intp]
    deepest: Array
    least: Array
    spacing: Array
    curvature: Array

    def part(self, rows: NDArray[np.intp]) -> Self:
        """Return some of the gaps."""
        return type(self)(*(array[rows] for array in self))  # type: ignore[arg-type]

    def coefficients(self, cell: NDArray[np.intp]) -> tuple[NDArray[np.intp], tuple[Array, Array, Array, Array]]:
        """Return the start and the coefficients of the cubics in cells, (patches, ...)."""
        shape = (-1, *[1] * (cell.ndim - 1))
        base = np.minimum(np.maximum(cell - 1, self.first.reshape(shape)), self.last.reshape(shape) - 3)
        flat, at = self.samples.ravel(), base + (np.arange(len(cell)) * self.samples.shape[1]).reshape(shape)
        g0 = flat[at]
        return base, (g0, *loops.cubic(g0, flat[at + 1], flat[at + 2], flat[at + 3]))

    def height(self, u: Array) -> Array:
        """Return the gap above the least one at places (patches, places)."""
        base, (c0, c1, c2, c3) = self.coefficients(u.astype(np.intp))
        x = u - base
        height: Array = c0 - self.least[:, None] + x * (c1 + x * (c2 + x * c3))
        return height


class _Region(NamedTuple):
    """Thresholds, the ends of patches, Hertz's semi-axes and whether the window cuts them off."""

    top: Array
    bend: Array
    middle: Array
    approach: Array
    start: Array
    end: Array
    a: Array
    b: Array
    cut: NDArray[np.bool_]


def _gaps(samples: Array, spacing: Array, curvature: Array) -> _Gaps:
    """Return gaps with their deepest points."""
    rows, size = np.arange(len(samples)), samples.shape[1]
    at, place = samples.argmin(axis=1), np.arange(size)
    missing = ~np.isfinite(samples)
    first = np.where(missing & (place < at[:, None]), place, -1).max(axis=1) + 1
    last = np.where(missing & (place > at[:, None]), place, size).min(axis=1) - 1
    least = samples[rows, at]
    gaps = _Gaps(samples, first, last, at.astype(float), np.zeros_like(least), spacing, curvature)
    inside = (at > first) & (at < last)
    before, after = samples[rows, np.maximum(at - 1, first)], samples[rows, np.minimum(at + 1, last)]
    cell = np.where(after < before, at, at - 1)
    base, (c0, c1, c2, c3) = gaps.coefficients(cell)
    x = (at - base).astype(float)
    for _ in range(4):
        bow = 2.0 * c2 + 6.0 * c3 * x
        x = x - np.where(bow > 0.0, (c1 + x * (2.0 * c2 + x * 3.0 * c3)) / np.where(bow > 0.0, bow, 1.0), 0.0)
        x = np.minimum(np.maximum(x, cell - base), cell + 1 - base)
    value = c0 + x * (c1 + x * (c2 + x * c3))
    better = inside & (value < least)
    return gaps._replace(deepest=np.where(better, base + x, at), least=np.where(better, value, least))


def _end(
    gaps: _Gaps, top: Array, bend: Array, middle: Array, cap: Array, direction: int
) -> tuple[Array, NDArray[np.bool_]]:
    """Return the outermost places on one side where gaps are at the threshold, and whether the windows end first."""
    rows, samples, first, last = np.arange(len(top)), gaps.samples, gaps.first, gaps.last
    if bend.any():
        place = np.arange(samples.shape[1], dtype=float)
        level = loops.threshold(top[:, None], bend[:, None], middle[:, None], cap[:, None], place)
    else:
        level = top[:, None]
    within = level + gaps.least[:, None] > samples
    begin, deepest = (
        (first, gaps.deepest.astype(np.intp)) if direction < 0 else (last, gaps.deepest.astype(np.intp) + 1)
    )
    if direction < 0:
        within &= np.arange(samples.shape[1]) >= first[:, None]
        j = within.argmax(axis=1)
        found = within[rows, j] & (j <= deepest)
    else:
        within &= np.arange(samples.shape[1]) <= last[:, None]
        j = samples.shape[1] - 1 - within[:, ::-1].argmax(axis=1)
        found = within[rows, j] & (j >= deepest)
    cut = found & (j == begin)
    outer = np.where(found, j + direction, deepest)
    cell = np.minimum(np.maximum(outer if direction < 0 else outer - 1, first), last - 1)
    inner = np.minimum(gaps.deepest, cell + 1) if direction < 0 else np.maximum(gaps.deepest, cell)
    base, (c0, c1, c2, c3) = gaps.coefficients(cell)
    c0 = c0 - gaps.least
    out = outer.astype(float)
    u = 0.5 * (inner + out)
    for _ in range(loops.NEWTON):
        x = u - base
        level = loops.threshold(top, bend, middle, cap, u)
        value = level - (c0 + x * (c1 + x * (c2 + x * c3)))
        inner, out = np.where(value > 0.0, u, inner), np.where(value > 0.0, out, u)
        slope = -(c1 + x * (2.0 * c2 + x * 3.0 * c3))
        slope = np.where((level > 0.0) & (level < cap), slope - 2.0 * bend * (u - middle), slope)
        to = u - value / np.where(slope == 0.0, np.inf, slope)
        good = (to >= np.minimum(inner, out)) & (to <= np.maximum(inner, out)) & (slope != 0.0)
        to = np.where(good, to, 0.5 * (inner + out))
        moved = np.abs(to - u)
        u = to
        if not (moved > 1e-13 * last)[~cut].any():
            break
    return np.where(cut, begin, u), cut


def _region(gaps: _Gaps, approach: Array) -> _Region:
    """Return the thresholds and the ends of patches."""
    half, none = 0.5 * approach, np.zeros_like(approach)
    low, cut_low = _end(gaps, half, none, none, half, -1)
    high, cut_high = _end(gaps, half, none, none, half, 1)
    middle, curvature = 0.5 * (low + high), gaps.curvature
    across = half / (0.5 * gaps.spacing * (high - low)) ** 2
    share = loops.hertz_share(np.abs(np.log(across / curvature)))
    share = np.where(across >= curvature, share, 1.0 - share)
    a, b = np.sqrt(share * approach / curvature), np.sqrt((1.0 - share) * approach / across)
    wide = np.maximum(b / gaps.spacing, loops.REACH * np.abs(gaps.deepest - middle))
    top, bend = approach * share, approach * (2.0 * share - 1.0) / wide**2
    start, cut_start = _end(gaps, top, bend, middle, approach, -1)
    end, cut_end = _end(gaps, top, bend, middle, approach, 1)
    return _Region(top, bend, middle, approach, start, end, a, b, cut_low | cut_high | cut_start | cut_end)


def _squares(gaps: _Gaps, region: _Region, u: Array) -> Array:
    """Return the squares of half the lengths of strips at u, (patches, places)."""
    top, bend, middle, cap = (array[:, None] for array in region[:4])
    free = loops.threshold(top, bend, middle, cap, u) - gaps.height(u)
    return np.maximum(free, 0.0) / gaps.curvature[:, None]


def _evaluated(
    gaps: _Gaps, modulus: Array, approach: Array, cosine: Array, sine: Array, share: Array, weight: Array
) -> tuple[_Region, Array, Array, Array]:
    """Return the region of patches, the slope of their pressure in √(l²-x²), their strips and their forces."""
    region = _region(gaps, approach)
    span = np.stack([gaps.deepest - region.start, region.end - gaps.deepest], axis=1)
    signed = span * np.array([-1.0, 1.0])
    u = (gaps.deepest[:, None, None] + signed[..., None] * share).reshape(len(approach), -1)
    distance = (gaps.spacing[:, None, None] * span[..., None] * share).reshape(u.shape)
    weights = (gaps.spacing[:, None, None] * span[..., None] * weight).reshape(u.shape)
    displaced = (weights * loops.compliance(_squares(gaps, region, u), distance)).sum(axis=1)
    slope = math.pi * modulus * approach / displaced
    half = 0.5 * (region.end - region.start)
    strips = np.empty((len(approach), 3, cosine.size))
    strips[:, 0] = region.start[:, None] + half[:, None] * (1.0 + cosine)
    strips[:, 1] = (half * gaps.spacing)[:, None] * sine
    strips[:, 2] = _squares(gaps, region, strips[:, 0])
    force = 0.5 * math.pi * slope * (strips[:, 1] * strips[:, 2]).sum(axis=1)
    return region, slope, strips, force


def _solve(
    samples: Array, given: Array, cosine: Array, sine: Array, share: Array, weight: Array, fields: Array, sums: Array
) -> None:
    """Fill in the strips and sums of patches with NumPy, as `loops.patch_loop` does."""
    spacing, curvature, modulus, approach, load = given.T
    every = _gaps(samples, spacing, curvature)
    active = np.arange(len(samples))
    logarithm, before_log, before = np.log(approach), np.zeros_like(load), np.zeros_like(load)
    low, high = np.full_like(load, -np.inf), np.full_like(load, np.inf)
    for iteration in range(loops.ITERATIONS):
        gaps = every if len(active) == len(samples) else every.part(active)
        here, target = logarithm[active], load[active]
        region, slope, strips, force = _evaluated(gaps, modulus[active], np.exp(here), cosine, sine, share, weight)
        wanted = np.where(target > 0.0, target, force)
        miss = np.log(force / wanted)
        short = miss < 0.0
        low[active], high[active] = np.where(short, here, low[active]), np.where(short, high[active], here)
        jumped = high[active] - low[active] < loops.WIDTH
        done = (np.abs(miss) < loops.TOLERANCE) | (jumped & short)
        if iteration == loops.ITERATIONS - 1:
            done[:] = True
        if done.any():
            _finish(
                gaps,
                region,
                slope,
                strips,
                force,
                wanted,
                jumped & (np.abs(miss) >= loops.TOLERANCE),
                done,
                active,
                fields,
                sums,
            )
        rate = np.full_like(miss, 1.5)
        if iteration:
            rate = (miss - before[active]) / (here - before_log[active])
            rate = np.minimum(np.maximum(rate, loops.LEAST_SLOPE), loops.STEEPEST_SLOPE)
        to = here - miss / rate
        to = np.where((to > low[active]) & (to < high[active]), to, 0.5 * (low[active] + high[active]))
        to = np.where(jumped, low[active], to)
        before_log[active], before[active], logarithm[active] = here, miss, to
        active = active[~done]
        if not len(active):
            break


def _finish(
    gaps: _Gaps,
    region: _Region,
    slope: Array,
    strips: Array,
    force: Array,
    wanted: Array,
    jumps: NDArray[np.bool_],
    done: NDArray[np.bool_],
    active: NDArray[np.intp],
    fields: Array,
    sums: Array,
) -> None:
    """Fill in strips and sums of the patches that are done."""
    at = active[done]
    warning = loops.JUMPS * jumps + loops.NARROW * region.cut
    longest = np.sqrt(_greatest(gaps, region, strips[:, 2]))
    columns = (region.approach, wanted, slope * wanted / force, region.a, region.b, warning, longest)
    fields[at], sums[at] = strips[done], np.stack(columns, axis=1)[done]


def _greatest(gaps: _Gaps, region: _Region, squares: Array) -> Array:
    """Return the largest squares of half a strip's length, from parabolas in the angle of strips."""
    count = squares.shape[1]
    step = math.pi / (count + 1)
    angle = step * (count - squares.argmax(axis=1))
    best: Array = squares.max(axis=1)
    centre, half = 0.5 * (region.start + region.end), 0.5 * (region.end - region.start)
    for _ in range(3):
        angles = np.stack([np.minimum(angle + step, math.pi), angle, np.maximum(angle - step, 0.0)], axis=1)
        left, here, right = _squares(gaps, region, centre[:, None] + half[:, None] * np.cos(angles)).T
        best = np.maximum(best, here)
        bow = 2.0 * here - left - right
        ahead = np.where(bow > 0.0, 0.5 * (left - right) / np.where(bow > 0.0, bow, 1.0), 0.0)
        angle = np.minimum(np.maximum(angle + np.clip(ahead, -1.0, 1.0) * step, 0.0), math.pi)
        step *= 0.25
    return best
