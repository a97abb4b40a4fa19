"""The energy that Carter's contact dissipates above a threshold, in closed form.

With d = ξ E*/(2 μ p0) = ξR/(μa), h = min(d, 1) and t from -1 to 1 over the slip zone, whose half-length is a h,

    q s = μp0 (μa/R) h f(t),  f(t) = (A + h t) √(1-t²),  A = max(2-d, d).

f rises from zero to one maximum and falls to zero again, so it exceeds a level between two roots. With v the distance
of t from the end next to a root, f² = v (2-v) (B + g v)², where B = A + h and g = -h at the trailing end, and B = A - h
and g = h at the other. Near d = 1 the latter f² grows like a cube.
"""

from __future__ import annotations

import math
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

import wearlaw as wl
from wearlaw import Array

CLOSE = 2e-3
"""Step of Halley's method, over the distances from both ends of its range, after which a root is good enough.

The next error is of the order of its cube, 1e-8. At a root f equals the level, so the integral above the level only
depends on the square of that error.
"""

STEPS = 60
"""Most steps; two to four are enough, except near d = 1, where the first guess is far off a cube."""

Number = TypeVar("Number", float, Array)


def _change(base: Number, growth: Number, square: Number, v: Number) -> Number:
    """Return Halley's step towards v (2-v) (base + growth v)² = square."""
    line, circle, slope = base + growth * v, v * (2.0 - v), 2.0 - 2.0 * v
    rise = growth * circle
    value = circle * line * line - square
    first = line * (slope * line + 2.0 * rise)
    half_second = growth * rise + line * (2.0 * growth * slope - line)
    return value * first / (first * first - value * half_second + 1e-300)  # all terms are zero at the maximum itself


def _roots(base: Array, growth: Array, top: Array, square: Array, v: Array) -> Array:
    """Return the v below the maximum at `top` where v (2-v) (base + growth v)² equals `square`, near a guess `v`."""
    rest: slice | NDArray[np.intp] = slice(None)
    for step in range(STEPS):
        old, crest = v[rest], top[rest]
        new = old - _change(base[rest], growth[rest], square[rest], old)
        new = np.minimum(np.maximum(new, 0.25 * old), 0.5 * (old + crest))
        if step == 0:  # one is never enough
            v = new
            continue
        far = np.abs(new - old) > CLOSE * np.minimum(new, crest - new)
        v[rest] = new
        rest = np.flatnonzero(far) if isinstance(rest, slice) else rest[far]
        if not rest.size:
            break
    return v


def _excess_arrays(
    creepage: Array, friction: Array, max_pressure: Array, half_width: Array, modulus: Array, threshold: float | Array
) -> Array:
    saturation = 2.0 * friction * max_pressure / modulus
    scale, reduced = friction * max_pressure * saturation, creepage / saturation
    reduced, level = np.broadcast_arrays(reduced, threshold / scale)
    shape, reduced, level = reduced.shape, reduced.ravel(), level.ravel()
    excess = np.zeros(reduced.shape)
    zone, mean = np.minimum(reduced, 1.0), np.maximum(2.0 - reduced, reduced)
    near = np.flatnonzero(level < zone * (mean + zone))  # f stays below any higher level
    zone, mean, height = zone[near], mean[near], level[near] / zone[near]
    crest = 2.0 * zone / (np.sqrt(mean * mean + 8.0 * zone * zone) + mean)
    square, peak = height * height, mean + zone * crest
    left = square / (peak * peak * ((1.0 - crest) * (1.0 + crest)))
    there = left < 1.0
    if not there.all():
        near, zone, mean, height = near[there], zone[there], mean[there], height[there]
        crest, square, left = crest[there], square[there], left[there]
    guess = left / (1.0 + np.sqrt(1.0 - left))  # on the ellipse through the maximum
    growth = np.concatenate([-zone, zone])  # the trailing end, then the other
    both, top = np.concatenate([mean, mean]), 1.0 + np.concatenate([-crest, crest])
    v = _roots(both - growth, growth, top, np.concatenate([square, square]), top * np.concatenate([guess, guess]))
    root, angle = np.sqrt(v * (2.0 - v)), 2.0 * np.arcsin(np.sqrt(0.5 * v))
    tails = 0.5 * both * (angle - (1.0 - v) * root) - growth / 3.0 * root * root * root
    tails -= np.concatenate([height, height]) * v
    above = 0.5 * np.pi * mean - 2.0 * height - tails[: near.size] - tails[near.size :]
    excess[near] = zone * zone * np.maximum(above, 0.0)
    return excess.reshape(shape) * scale * half_width


@wl.kernel(_excess_arrays)
def excess_dissipation(
    creepage: float, friction: float, max_pressure: float, half_width: float, modulus: float, threshold: float
) -> float:
    """Return ∫ max(q s - threshold, 0) dx [N/m] from values in SI."""
    saturation = 2.0 * friction * max_pressure / modulus
    scale, reduced = friction * max_pressure * saturation, creepage / saturation
    level = threshold / scale
    zone, mean = min(reduced, 1.0), max(2.0 - reduced, reduced)
    if level >= zone * (mean + zone):
        return 0.0
    crest = 2.0 * zone / (math.sqrt(mean * mean + 8.0 * zone * zone) + mean)
    height = level / zone
    square, peak = height * height, mean + zone * crest
    left = square / (peak * peak * ((1.0 - crest) * (1.0 + crest)))
    if left >= 1.0:
        return 0.0
    guess = left / (1.0 + math.sqrt(1.0 - left))
    v, top, u, summit = guess * (1.0 - crest), 1.0 - crest, guess * (1.0 + crest), 1.0 + crest
    for _ in range(STEPS):  # both roots at once: processors overlap them
        next_v = v - _change(mean + zone, -zone, square, v)
        next_u = u - _change(mean - zone, zone, square, u)
        next_v = min(max(next_v, 0.25 * v), 0.5 * (v + top))
        next_u = min(max(next_u, 0.25 * u), 0.5 * (u + summit))
        far = abs(next_v - v) - CLOSE * min(next_v, top - next_v)
        far = max(far, abs(next_u - u) - CLOSE * min(next_u, summit - next_u))
        v, u = next_v, next_u
        if far <= 0.0:
            break
    root_v, root_u = math.sqrt(v * (2.0 - v)), math.sqrt(u * (2.0 - u))
    angles = 2.0 * (math.asin(math.sqrt(0.5 * v)) + math.asin(math.sqrt(0.5 * u)))
    above = 0.5 * mean * (math.pi - angles + (1.0 - v) * root_v + (1.0 - u) * root_u)
    above += zone / 3.0 * (root_u * root_u * root_u - root_v * root_v * root_v) - height * (2.0 - v - u)
    return scale * half_width * zone * zone * max(above, 0.0)
