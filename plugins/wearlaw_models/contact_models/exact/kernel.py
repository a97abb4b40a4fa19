"""The energy that Carter's contact dissipates above a threshold, in closed form.

With d = ξ E*/(2 μ p0) = ξR/(μa), h = min(d, 1) and t from -1 to 1 over the slip zone, whose half-length is a h,

    q s = μp0 (μa/R) h f(t),  f(t) = (A + h t) √(1-t²),  A = max(2-d, d).

f rises from zero to its one maximum, at t = c, and falls to zero again, so it exceeds a level between two roots. There
f equals the level, so the integral above it depends only on the square of the roots' errors, and 1e-8 is good enough.

A single operating point takes the functions of `math`, with which a formula is ten times as fast as with NumPy's.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple, TypeVar

import numpy as np

from wearlaw import Array

STEPS = 2
"""Steps towards each root. With the first guesses below, they leave an error of at most 2e-8 at any creepage and level,
the most for the root behind the maximum."""

LEAST = 1e-300
"""Keeps a quotient finite whose terms are all zero: at the maximum itself, and at d = 1 if the level is zero."""

Number = TypeVar("Number", float, Array)


class Functions(NamedTuple):
    """Functions of floats or of arrays."""

    sqrt: Any
    cbrt: Any
    arcsin: Any
    minimum: Any
    maximum: Any


OF_FLOATS = Functions(math.sqrt, math.cbrt, math.asin, min, max)
OF_ARRAYS = Functions(np.sqrt, np.cbrt, np.arcsin, np.minimum, np.maximum)


def excess_dissipation(creepage: Array, *others: Any) -> Array:
    """Return ∫ max(q s - threshold, 0) dx [N/m].

    Parameters
    ----------
    creepage, *others : ndarray
        ξ, μ, p0, a, E* and the threshold in SI, of one shape; all but the first may be numbers.
    """
    if not creepage.ndim:
        zone, mean, level, unit = _reduced(OF_FLOATS, *map(float, (creepage, *others)))
        crest, square = _maximum(OF_FLOATS, zone, mean)
        above = _above(OF_FLOATS, level, zone, mean, crest, square) if level * level < square else 0.0
        of_patch: Any = np.float64(zone * zone * above * unit)
        return of_patch  # type: ignore[no-any-return]
    with np.errstate(over="ignore", divide="ignore"):  # a threshold may lie infinitely far above all values
        zone, mean, level, unit = _reduced(OF_ARRAYS, creepage, *others)
    excess, near = np.zeros(creepage.shape), np.nonzero(level < mean + 0.5 * zone)  # f nowhere exceeds A + h/2
    if not near[0].size:
        return excess
    zone, mean, level = zone[near], mean[near], level[near]
    crest, square = _maximum(OF_ARRAYS, zone, mean)
    above, reached = np.zeros(zone.shape), np.nonzero(level * level < square)
    above[reached] = _above(OF_ARRAYS, *(values[reached] for values in (level, zone, mean, crest, square)))
    excess[near] = zone * zone * above
    energy: Array = excess * unit
    return energy


def _reduced(
    of: Functions, creepage: Any, friction: Any, max_pressure: Any, half_width: Any, modulus: Any, threshold: Any
) -> tuple[Any, Any, Any, Any]:
    """Return h, A, the threshold in the unit of f, and that of the energy over h² [N/m]."""
    saturation = 2.0 * friction * max_pressure / modulus
    scale, reduced = friction * max_pressure * saturation, creepage / saturation
    zone = of.minimum(reduced, 1.0)
    level = threshold / (scale * zone) if of is OF_ARRAYS or zone else math.inf
    return zone, of.maximum(2.0 - reduced, reduced), level, scale * half_width


def _maximum(of: Functions, zone: Number, mean: Number) -> tuple[Number, Number]:
    """Return the t at which f has its maximum, c, and the square of the maximum."""
    crest = 2.0 * zone / (of.sqrt(mean * mean + 8.0 * zone * zone) + mean)
    return crest, (mean + zone * crest) ** 2 * (1.0 - crest) * (1.0 + crest)


def _above(of: Functions, level: Number, zone: Number, mean: Number, crest: Number, highest: Number) -> Number:
    """Return ∫ max(f - level, 0) dt for a level below the maximum, whose square is `highest`.

    With x the distance of t from c, f² lies below its maximum by x² (r + g x + h² x²).
    """
    square, zone2 = level * level, zone * zone
    tilt = 6.0 * zone * crest
    curvature, growth = mean * mean - zone2 + tilt * (mean + zone * crest), 2.0 * zone * (mean + 2.0 * zone * crest)
    below = highest - square
    drop, share = of.sqrt(below), square / highest
    behind = _behind(of, drop, curvature, growth, zone2, (1.0 - crest) * of.sqrt(1.0 - share))
    last = of.minimum(crest + behind, 1.0)
    first = _ahead(of, square, share, zone, mean - zone, 1.0 + crest - drop / of.sqrt(curvature)) - 1.0
    root, other = of.sqrt((1.0 - last) * (1.0 + last)), of.sqrt((1.0 - first) * (1.0 + first))
    area = 0.5 * mean * (last * root + of.arcsin(last) - first * other - of.arcsin(first))
    area = area - zone / 3.0 * (root * root * root - other * other * other)
    result: Number = of.maximum(area - level * (last - first), 0.0)
    return result


def _behind(of: Functions, drop: Number, curvature: Number, growth: Number, zone2: Number, x: Number) -> Number:
    """Return the x > 0 where x √(r + g x + h² x²) equals `drop`, by Newton's method from a guess."""
    for _ in range(STEPS):
        rise = zone2 * x
        square = curvature + x * (growth + rise)
        x = x - (x * square - drop * of.sqrt(square)) / (square + x * (0.5 * growth + rise))
    return x


def _ahead(of: Functions, square: Number, share: Number, zone: Number, base: Number, parabola: Number) -> Number:
    """Return the v = 1 + t ahead of the maximum where f² = v (2-v) (A-h + h v)² is `square`, by Halley's method.

    Next to v = 0 the guess solves 2v ((A-h)² + u²) = `square`, where u is the v at d = 1, and next to the maximum it is
    that of a parabola through the maximum.
    """
    half = 0.5 * square
    at_one = of.cbrt(half)
    v = half / (base * base + at_one * at_one + LEAST)
    v = v + share * (parabola - v)
    for _ in range(STEPS):
        line, circle, slope = base + zone * v, v * (2.0 - v), 2.0 - 2.0 * v
        rise = zone * circle
        value = circle * line * line - square
        first = line * (slope * line + 2.0 * rise)
        half_second = zone * rise + line * (2.0 * zone * slope - line)
        v = v - value * first / (first * first - value * half_second + LEAST)
    result: Number = v
    return result
