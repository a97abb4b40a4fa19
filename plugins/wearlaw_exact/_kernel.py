"""The energy that Carter's contact dissipates above a threshold, in closed form.

With d = ξ E*/(2 μ p0) = ξR/(μa), h = min(d, 1) and t from -1 to 1 over the slip zone, whose half-length is a h,

    q s = μp0 (μa/R) h f(t),  f(t) = (A + h t) √(1-t²),  A = max(2-d, d).

f rises from zero to one maximum and falls to zero again, so it exceeds a level between two roots. With v the distance
of t from the end next to a root, f² = v (2-v) (B + g v)², where B = A + h and g = -h at the trailing end, and B = A - h
and g = h at the other. Near d = 1 the latter f² grows like a cube.

A single operating point takes the functions of `math`, with which a formula is ten times as fast as with NumPy's.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple, TypeVar

import numpy as np

from wearlaw import Array

CLOSE = 2e-3
"""Step of Halley's method, over the distances from both ends of its range, after which a root is good enough.

The next error is of the order of its cube, 1e-8. At a root f equals the level, so the integral above the level only
depends on the square of that error.
"""

STEPS = 60
"""Most steps; four are enough, except next to the maximum, where rounding keeps the test from passing."""

Number = TypeVar("Number", float, Array)


class Functions(NamedTuple):
    """Functions of floats or of arrays."""

    sqrt: Any
    cbrt: Any
    arcsin: Any
    minimum: Any
    maximum: Any
    all: Any


OF_FLOATS = Functions(math.sqrt, math.cbrt, math.asin, min, max, bool)
OF_ARRAYS = Functions(np.sqrt, np.cbrt, np.arcsin, np.minimum, np.maximum, np.logical_and.reduce)


def excess_dissipation(creepage: Array, *others: Any) -> Array:
    """Return ∫ max(q s - threshold, 0) dx [N/m].

    Parameters
    ----------
    creepage, *others : ndarray
        ξ, μ, p0, a, E* and the threshold in SI, of one shape; all but the first may be numbers.
    """
    if not creepage.ndim:
        reduced, level, unit = _reduced(*map(float, (creepage, *others)))
        of_point = _maximum(OF_FLOATS, reduced)
        of_patch: Any = np.float64(unit * _above(OF_FLOATS, level, *of_point) if level < of_point[-1] else 0.0)
        return of_patch  # type: ignore[no-any-return]
    with np.errstate(over="ignore"):  # a threshold may lie infinitely far above all values
        reduced, level, unit = _reduced(creepage, *others)
    excess, of_points = np.zeros(creepage.shape), _maximum(OF_ARRAYS, reduced)
    reached = np.nonzero(level < of_points[-1])
    excess[reached] = _above(OF_ARRAYS, level[reached], *(values[reached] for values in of_points))
    energy: Array = excess * unit
    return energy


def _reduced(
    creepage: Any, friction: Any, max_pressure: Any, half_width: Any, modulus: Any, threshold: Any
) -> tuple[Any, Any, Any]:
    """Return d, the threshold over μp0 μa/R, and the unit of the energy [N/m]."""
    saturation = 2.0 * friction * max_pressure / modulus
    scale = friction * max_pressure * saturation
    return creepage / saturation, threshold / scale, scale * half_width


def _maximum(of: Functions, reduced: Number) -> tuple[Number, Number, Number, Number]:
    """Return h, A, the t at which f has its maximum, and h times the maximum."""
    zone, mean = of.minimum(reduced, 1.0), of.maximum(2.0 - reduced, reduced)
    crest = 2.0 * zone / (of.sqrt(mean * mean + 8.0 * zone * zone) + mean)
    return zone, mean, crest, zone * (mean + zone * crest) * of.sqrt((1.0 - crest) * (1.0 + crest))


def _above(of: Functions, level: Number, zone: Number, mean: Number, crest: Number, highest: Number) -> Number:
    """Return h² ∫ max(f - level/h, 0) dt, for a level below the maximum."""
    share = (level / highest) ** 2
    share = share / (1.0 + of.sqrt(1.0 - share))  # on the ellipse through the maximum
    # Behind the leading edge f² is close to 2v (B + hv)², and to 2h² v³ where B is zero, at d = 1.
    height, base = level / zone, mean - zone
    cubic = 0.5 * height * height
    leading = of.maximum(cubic / (base + zone * of.cbrt(cubic / (zone * zone))) ** 2, share * (1.0 + crest))
    above = 0.5 * math.pi * mean
    for growth, top, guess in ((-zone, 1.0 - crest, share * (1.0 - crest)), (zone, 1.0 + crest, leading)):
        v = _root(of, mean - growth, growth, top, height * height, guess)
        root, angle = of.sqrt(v * (2.0 - v)), 2.0 * of.arcsin(of.sqrt(0.5 * v))
        above = above - 0.5 * mean * (angle - (1.0 - v) * root) + growth / 3.0 * root * root * root - height * (1.0 - v)
    result: Number = zone * zone * of.maximum(above, 0.0)
    return result


def _root(of: Functions, base: Number, growth: Number, top: Number, square: Number, v: Number) -> Number:
    """Return the v below the maximum at `top` where v (2-v) (base + growth v)² equals `square`, near a guess `v`."""
    for step in range(STEPS):
        old = v
        v = old - _change(base, growth, square, old)
        v = of.minimum(of.maximum(v, 0.25 * old), 0.5 * (old + top))
        if step and of.all(abs(v - old) <= CLOSE * of.minimum(v, top - v)):
            break
    return v


def _change(base: Number, growth: Number, square: Number, v: Number) -> Number:
    """Return Halley's step towards v (2-v) (base + growth v)² = square."""
    line, circle, slope = base + growth * v, v * (2.0 - v), 2.0 - 2.0 * v
    rise = growth * circle
    value = circle * line * line - square
    first = line * (slope * line + 2.0 * rise)
    half_second = growth * rise + line * (2.0 * growth * slope - line)
    return value * first / (first * first - value * half_second + 1e-300)  # all terms are zero at the maximum itself
