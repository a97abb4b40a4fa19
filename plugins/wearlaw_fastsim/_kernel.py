"""The energy that FASTSIM in two dimensions dissipates above a threshold, in closed form.

With d = ξ/g, where g = L μp2(0)/a × 2 (parabola) or × 1 (ellipse) is the slope of the bound times L, and v = (a - x)/a:

parabola: q s = μp2(0) g P(v), P(v) = v (2-v) (1+d-v), over v < 2 min(d, 1). P rises from zero to one maximum and then
falls towards its next zero z = min(2, 1+d). With v counted from 0 or from z, P is v (z-v) (B + g v).
ellipse: q s = μp2(0) g (d sin ψ + cos ψ) over ψ < 2 atan d, where x = a cos ψ: symmetric about its maximum √(1+d²)
at ψ = atan d, and at least 1 everywhere in the slip zone.
"""

from __future__ import annotations

import math
from typing import TypeVar

import numpy as np

import wearlaw as wl
from wearlaw import Array

Number = TypeVar("Number", float, Array)

CLOSE = 2e-3
"""Step of Halley's method after which a root is good enough; see `wearlaw_exact._kernel.CLOSE` for the reason."""

STEPS = 60
"""Most steps; two to four are enough, except near d = 1."""


def _change(base: Number, growth: float, zero: Number, level: Number, v: Number) -> Number:
    """Return Halley's step towards v (zero-v) (base + growth v) = level."""
    line, arch, slope = base + growth * v, v * (zero - v), zero - 2.0 * v
    value = arch * line - level
    first = slope * line + growth * arch
    half_second = growth * slope - line
    return value * first / (first * first - value * half_second + 1e-300)  # all terms are zero at the maximum itself


def _root(base: Array, growth: float, zero: Array, level: Array, top: Array, share: Array) -> Array:
    """Return the v below the maximum at `top` where v (zero-v) (base + growth v) is at its level."""
    v = top * share
    for _ in range(STEPS):
        old = v
        v = old - _change(base, growth, zero, level, old)
        v = np.minimum(np.maximum(v, 0.25 * old), 0.5 * (old + top))
        if (np.abs(v - old) <= CLOSE * np.minimum(v, top - v)).all():
            break
    return v


def _parabolic_arrays(
    creepage: Array, slope: Array, centre: Array, half_width: Array, threshold: float | Array
) -> Array:
    reduced, level = np.broadcast_arrays(creepage / slope, threshold / (slope * centre))
    excess = np.zeros(reduced.shape)
    end, more = 2.0 * np.minimum(reduced, 1.0), 1.0 + reduced
    top = 2.0 * more / (2.0 + more + np.sqrt(reduced**2 + 3.0))
    crest = np.minimum(top, end)
    reached = np.nonzero(level < crest * (2.0 - crest) * (more - crest))
    end, more, level, top, crest = end[reached], more[reached], level[reached], top[reached], crest[reached]
    zero, other = np.minimum(2.0, more), np.maximum(2.0, more)
    left = level / (top * (zero - top) * (other - top))
    share = left / (1.0 + np.sqrt(np.maximum(1.0 - left, 0.0)))  # on the parabola through the maximum
    trailing = np.minimum(_root(other, -1.0, zero, level, top, share), crest)
    leading = np.clip(zero - _root(other - zero, 1.0, zero, level, zero - top, share), crest, end)
    third = (2.0 + more) / 3.0
    energy = leading**2 * (more - leading * (third - 0.25 * leading))
    energy -= trailing**2 * (more - trailing * (third - 0.25 * trailing))
    excess[reached] = np.maximum(energy - level * (leading - trailing), 0.0)
    return excess * slope * centre * half_width


@wl.kernel(_parabolic_arrays)
def parabolic_excess(creepage: float, slope: float, centre: float, half_width: float, threshold: float) -> float:
    """Return ∫ max(q s - threshold, 0) dx [N/m] for the parabola from g, μp2(0) and other values in SI."""
    reduced, level = creepage / slope, threshold / (slope * centre)
    end, more = 2.0 * min(reduced, 1.0), 1.0 + reduced
    top = 2.0 * more / (2.0 + more + math.sqrt(reduced * reduced + 3.0))
    crest = min(top, end)
    if level >= crest * (2.0 - crest) * (more - crest):
        return 0.0
    zero, other = min(2.0, more), max(2.0, more)
    left = level / (top * (zero - top) * (other - top))
    share = left / (1.0 + math.sqrt(max(1.0 - left, 0.0)))
    v, summit = top * share, zero - top
    u = summit * share
    for _ in range(STEPS):  # both roots at once: processors overlap them
        next_v = v - _change(other, -1.0, zero, level, v)
        next_u = u - _change(other - zero, 1.0, zero, level, u)
        next_v = min(max(next_v, 0.25 * v), 0.5 * (v + top))
        next_u = min(max(next_u, 0.25 * u), 0.5 * (u + summit))
        far = abs(next_v - v) - CLOSE * min(next_v, top - next_v)
        far = max(far, abs(next_u - u) - CLOSE * min(next_u, summit - next_u))
        v, u = next_v, next_u
        if far <= 0.0:
            break
    trailing, leading = min(v, crest), min(max(zero - u, crest), end)
    third = (2.0 + more) / 3.0
    energy = leading * leading * (more - leading * (third - 0.25 * leading))
    energy -= trailing * trailing * (more - trailing * (third - 0.25 * trailing))
    return slope * centre * half_width * max(energy - level * (leading - trailing), 0.0)


def _elliptic_arrays(
    creepage: Array, slope: Array, centre: Array, half_width: Array, threshold: float | Array
) -> Array:
    reduced, level = creepage / slope, threshold / (slope * centre)
    square = 1.0 + reduced**2
    whole = np.arctan(reduced) + reduced / square * (1.0 - 2.0 * np.minimum(level, 1.0))
    cosine = np.minimum(level / np.sqrt(square), 1.0)
    capped = np.arccos(cosine) - cosine * np.sqrt((1.0 - cosine) * (1.0 + cosine))
    return creepage * centre * half_width * np.where(level <= 1.0, whole, capped)


@wl.kernel(_elliptic_arrays)
def elliptic_excess(creepage: float, slope: float, centre: float, half_width: float, threshold: float) -> float:
    """Return ∫ max(q s - threshold, 0) dx [N/m] for the ellipse from g, μp2(0) and other values in SI."""
    reduced, level = creepage / slope, threshold / (slope * centre)
    scale = creepage * centre * half_width
    square = 1.0 + reduced * reduced
    if level <= 1.0:
        return scale * (math.atan(reduced) + reduced / square * (1.0 - 2.0 * level))
    cosine = min(level / math.sqrt(square), 1.0)
    return scale * (math.acos(cosine) - cosine * math.sqrt((1.0 - cosine) * (1.0 + cosine)))
