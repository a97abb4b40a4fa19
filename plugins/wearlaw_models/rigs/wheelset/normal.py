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
logarithm at t_0 and the decay near the ends of long patches. On ellipses its error is 2e-6 for a/b from 1/20 to 20.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

import wearlaw as wl
from wearlaw import Array
from wearlaw_models.rigs.wheelset import normal_loops as loops

NODES = 16
"""Nodes of the integral for the displacement, on each side of the deepest point."""

BLOCK = 500
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
    among: int = 0,
) -> StripPatch:
    """Return patches at a penetration.

    Parameters
    ----------
    start, step : array_like, (patches,)
        Place of the first sample of the gap, and the distance from one to the next [m].
    gap : array_like, (patches, samples)
        Gap g at x = 0 between the bodies as they touch [m], at four places of the patch's window at least. Samples
        outside of it are infinite; the window runs to both sides of the smallest gap.
    curvature_x : array_like, (patches,)
        A of the gap A x² + g(t) [1/m], half the relative curvature along the rolling direction.
    modulus : array_like, (patches,)
        Effective modulus, E* [Pa].
    penetration : array_like, (patches,)
        Approach of the bodies from first touching, δ [m].
    strips : int
        Number of strips of a patch.
    among : int
        Number of patches of the task, if these are some of them: compiled loops pay for the last few as well.
    """
    samples = np.ascontiguousarray(gap, dtype=float)
    count = len(samples)
    given = np.empty((count, 4))
    for column, value in enumerate((step, curvature_x, modulus, penetration)):
        given[:, column] = value
    cosine, sine = _even(strips)
    share, weight = _nodes()
    fields, sums = np.empty((count, 3, strips)), np.empty((count, 3))
    if wl.accelerated(max(count, among) * FEW):
        loops.patch_loop(samples, given, cosine, sine, share, weight, fields, sums)
    else:
        _solve(samples, given, (cosine, sine, share, weight), fields, sums)
    return _result(np.asarray(start, dtype=float), given, fields, sums)


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


def _result(start: Array, given: Array, fields: Array, sums: Array) -> StripPatch:
    """Return patches from the strips and sums of the loops."""
    slope, longest, cut = sums.T
    u, width, square = fields[:, 0], fields[:, 1], fields[:, 2]
    load = width * square
    total = load.sum(axis=-1)
    half_length = np.sqrt(np.maximum(square, loops.FLOOR**2 * longest[:, None]))
    y = start[..., None] + given[:, :1] * u
    ratio = 2.0 * np.sqrt(longest) / (_reach(u) * given[:, 0])
    mean = np.sqrt(2.0 / np.pi * (half_length * width).sum(axis=-1))  # √(ab)
    return StripPatch(
        penetration=given[:, 3],
        normal_force=0.5 * np.pi * slope * total,
        max_pressure=slope * np.sqrt(longest),
        a=mean * np.sqrt(ratio),
        b=mean / np.sqrt(ratio),
        centre=(load * y).sum(axis=-1) / total,
        y=y,
        width=width,
        half_length=half_length,
        pressure=slope[:, None] * half_length,
        narrow=cut > 0.0,
    )


def _reach(u: Array) -> Array:
    """Return the width of patches from their strips."""
    width: Array = (u[:, -1] - u[:, 0]) / _even(u.shape[1])[0][-1]
    return width


class _Gaps(NamedTuple):
    """Gaps as arrays (patches, ...): samples, the window, the deepest point, the least gap, the spacing and A."""

    samples: Array
    first: NDArray[np.intp]
    last: NDArray[np.intp]
    deepest: Array
    least: Array
    spacing: Array
    curvature: Array

    def coefficients(self, cell: NDArray[np.intp]) -> tuple[NDArray[np.intp], tuple[Array, Array, Array, Array]]:
        """Return the start and the coefficients of the cubics in cells, (..., patches)."""
        base = np.minimum(np.maximum(cell - 1, self.first), self.last - 3)
        flat, at = self.samples.ravel(), base + np.arange(len(self.samples)) * self.samples.shape[1]
        g0 = flat[at]
        return base, (g0, *loops.cubic(g0, flat[at + 1], flat[at + 2], flat[at + 3]))

    def height(self, u: Array) -> Array:
        """Return the gap above the least one at places (..., patches)."""
        base, (c0, c1, c2, c3) = self.coefficients(u.astype(np.intp))
        x = u - base
        height: Array = c0 - self.least + x * (c1 + x * (c2 + x * c3))
        return height


class _Region(NamedTuple):
    """Thresholds, the ends of patches and whether the window cuts them off."""

    top: Array
    bend: Array
    middle: Array
    approach: Array
    start: Array
    end: Array
    cut: NDArray[np.bool_]

    def excess(self, gaps: _Gaps, u: Array) -> Array:
        """Return by how much gaps are below the threshold at places (..., patches)."""
        level = loops.threshold(self.top, self.bend, self.middle, self.approach, u)
        return np.maximum(level - gaps.height(u), 0.0)


def _gaps(samples: Array, spacing: Array, curvature: Array) -> _Gaps:
    """Return gaps with their deepest points; samples beyond the window become infinite."""
    rows, size = np.arange(len(samples)), samples.shape[1]
    at, place = samples.argmin(axis=1), np.arange(size)
    missing = ~np.isfinite(samples)
    first, last = np.zeros_like(at), np.full_like(at, size - 1)
    if missing.any():
        first = np.where(missing & (place < at[:, None]), place, -1).max(axis=1) + 1
        last = np.where(missing & (place > at[:, None]), place, size).min(axis=1) - 1
        samples = np.where((place < first[:, None]) | (place > last[:, None]), np.inf, samples)
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


def _within(gaps: _Gaps, top: Array, bend: Array | None, middle: Array, cap: Array) -> NDArray[np.bool_]:
    """Return which samples are below the threshold."""
    samples, least = gaps.samples, gaps.least
    below: NDArray[np.bool_] = samples < (cap + least)[:, None]
    if bend is not None:
        level = np.arange(samples.shape[1]) - middle[:, None]
        level *= level
        level *= -bend[:, None]
        level += (top + least)[:, None]
        below &= level > samples
    return below


def _ends(gaps: _Gaps, top: Array, bend: Array | None, middle: Array, cap: Array) -> tuple[Array, NDArray[np.bool_]]:
    """Return the outermost places where gaps are at the threshold, (2, patches), and whether the window ends first."""
    rows, size = np.arange(len(top)), gaps.samples.shape[1]
    within, cell = _within(gaps, top, bend, middle, cap), gaps.deepest.astype(np.intp)
    low, high = within.argmax(axis=1), size - 1 - within[:, ::-1].argmax(axis=1)
    found = within[rows, low] & np.stack([low <= cell, high >= np.minimum(cell + 1, gaps.last)])
    begin, sample = np.stack([gaps.first, gaps.last]), np.stack([low, high])
    away = np.array([[-1], [1]])
    cut = found & (sample == begin)
    outer = np.where(found, sample + away, np.stack([cell, cell + 1]))
    left = np.minimum(np.maximum(outer - np.array([[0], [1]]), gaps.first), gaps.last - 1)
    inner, out = np.minimum(np.maximum(gaps.deepest, left), left + 1), outer.astype(float)
    base, (c0, c1, c2, c3) = gaps.coefficients(left)
    c0 = c0 - gaps.least
    u = 0.5 * (inner + out)
    for _ in range(loops.NEWTON):
        x = u - base
        level = top if bend is None else loops.threshold(top, bend, middle, cap, u)
        value = level - (c0 + x * (c1 + x * (c2 + x * c3)))
        inner, out = np.where(value > 0.0, u, inner), np.where(value > 0.0, out, u)
        slope = -(c1 + x * (2.0 * c2 + x * 3.0 * c3))
        if bend is not None:
            slope -= np.where((level > 0.0) & (level < cap), 2.0 * bend * (u - middle), 0.0)
        to = u - value / np.where(slope == 0.0, np.inf, slope)
        good = (to >= np.minimum(inner, out)) & (to <= np.maximum(inner, out)) & (slope != 0.0)
        to = np.where(good, to, 0.5 * (inner + out))
        moved = (np.abs(to - u) >= loops.STEP * gaps.last) & ~cut
        u = to
        if not moved.any():
            break
    return np.where(cut, begin, u), cut.any(axis=0)


def _region(gaps: _Gaps, approach: Array) -> _Region:
    """Return the thresholds and the ends of patches."""
    half = 0.5 * approach
    (low, high), narrow = _ends(gaps, half, None, half, half)
    middle, curvature = 0.5 * (low + high), gaps.curvature * gaps.spacing**2
    top, bend = loops.correction(approach, curvature, 0.5 * (high - low), np.abs(gaps.deepest - middle))
    (start, end), cut = _ends(gaps, top, bend, middle, approach)
    return _Region(top, bend, middle, approach, start, end, narrow | cut)


def _solve(samples: Array, given: Array, rules: tuple[Array, Array, Array, Array], fields: Array, sums: Array) -> None:
    """Fill in the strips and sums of patches with NumPy, as `loops.patch_loop` does."""
    cosine, sine, share, weight = rules
    for start in range(0, len(samples), BLOCK):
        some = slice(start, start + BLOCK)
        spacing, curvature, modulus, approach = given[some].T
        gaps = _gaps(samples[some], spacing, curvature)
        region = _region(gaps, approach)
        span = np.stack([region.start, region.end])[:, None] - gaps.deepest
        square = region.excess(gaps, gaps.deepest + share[:, None] * span) / curvature
        length = spacing * np.abs(span)
        displaced = length * weight[:, None] * loops.compliance(square, length * share[:, None])
        half = 0.5 * (region.end - region.start)
        place = region.start + half * (1.0 + cosine[:, None])
        excess = region.excess(gaps, place)
        fields[some, 0], fields[some, 1], fields[some, 2] = (
            place.T, (half * spacing * sine[:, None]).T, (excess / curvature).T,
        )  # fmt: skip
        sums[some, 0] = math.pi * modulus * approach / displaced.sum(axis=(0, 1))
        sums[some, 1], sums[some, 2] = _greatest(gaps, region, excess) / curvature, region.cut


def _greatest(gaps: _Gaps, region: _Region, excess: Array) -> Array:
    """Return the largest excess of patches, from parabolas in the angle of strips."""
    count = len(excess)
    step = math.pi / (count + 1)
    angle = step * (count - excess.argmax(axis=0))
    best: Array = excess.max(axis=0)
    centre, half = 0.5 * (region.start + region.end), 0.5 * (region.end - region.start)
    for _ in range(loops.PEAK):
        angles = np.stack([np.minimum(angle + step, math.pi), angle, np.maximum(angle - step, 0.0)])
        before, here, after = region.excess(gaps, centre + half * np.cos(angles))
        best = np.maximum(best, here)
        bow = 2.0 * here - before - after
        ahead = np.where(bow > 0.0, 0.5 * (before - after) / np.where(bow > 0.0, bow, 1.0), 0.0)
        angle = np.minimum(np.maximum(angle + np.minimum(np.maximum(ahead, -1.0), 1.0) * step, 0.0), math.pi)
        step *= 0.25
    return best
