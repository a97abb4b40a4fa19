"""The energy that FASTSIM in two dimensions dissipates above a threshold, in closed form.

With d = ξ/g, where g = L μp2(0)/a × 2 (parabola) or × 1 (ellipse) is the slope of the bound times L, and v = (a - x)/a:

parabola: q s = μp2(0) g v (2-v) (1+d-v) over v < 2 min(d, 1): a cubic in v, so its roots are known.
ellipse: q s = μp2(0) g (d sin ψ + cos ψ) over ψ < 2 atan d, where x = a cos ψ: symmetric about its maximum √(1+d²)
at ψ = atan d, and not below 1 anywhere in the slip zone.
"""

from __future__ import annotations

import math

import numpy as np

import wearlaw as wl
from wearlaw import Array


def _parabolic_arrays(creepage: Array, slope: Array, centre: Array, half_width: Array, threshold: float) -> Array:
    reduced, level = creepage / slope, threshold / (slope * centre)
    excess = np.zeros(reduced.shape)
    end, more = 2.0 * np.minimum(reduced, 1.0), 1.0 + reduced
    spread = np.sqrt(reduced**2 + 3.0)
    top = np.minimum(2.0 * more / (2.0 + more + spread), end)
    reached = np.nonzero(level < top * (2.0 - top) * (more - top))
    if not reached[0].size:
        return excess
    end, more, spread, level = end[reached], more[reached], spread[reached], level[reached]
    third = (2.0 + more) / 3.0
    offset = third * (2.0 * more - 2.0 * third**2) - level
    angle = np.arccos(np.clip(-13.5 * offset / spread**3, -1.0, 1.0)) / 3.0
    trailing = third + 2.0 / 3.0 * spread * np.cos(angle + 2.0 / 3.0 * np.pi)
    leading = third + 2.0 / 3.0 * spread * np.cos(angle - 2.0 / 3.0 * np.pi)
    leading = np.where(level > end * (2.0 - end) * (more - end), np.minimum(leading, end), end)
    trailing = np.clip(trailing, 0.0, leading)
    energy = leading**2 * (more - leading * (third - 0.25 * leading))
    energy -= trailing**2 * (more - trailing * (third - 0.25 * trailing))
    excess[reached] = np.maximum(energy - level * (leading - trailing), 0.0)
    return excess * slope * centre * half_width


@wl.kernel(_parabolic_arrays)
def parabolic_excess(creepage: float, slope: float, centre: float, half_width: float, threshold: float) -> float:
    """Return ∫ max(q s - threshold, 0) dx [N/m] for the parabola, of g, μp2(0) and other values in SI."""
    reduced, level = creepage / slope, threshold / (slope * centre)
    end, more = 2.0 * min(reduced, 1.0), 1.0 + reduced
    spread = math.sqrt(reduced * reduced + 3.0)
    top = min(2.0 * more / (2.0 + more + spread), end)
    if level >= top * (2.0 - top) * (more - top):
        return 0.0
    third = (2.0 + more) / 3.0
    offset = third * (2.0 * more - 2.0 * third * third) - level
    angle = math.acos(min(max(-13.5 * offset / (spread * spread * spread), -1.0), 1.0)) / 3.0
    trailing = third + 2.0 / 3.0 * spread * math.cos(angle + 2.0 / 3.0 * math.pi)
    leading = end
    if level > end * (2.0 - end) * (more - end):
        leading = min(third + 2.0 / 3.0 * spread * math.cos(angle - 2.0 / 3.0 * math.pi), end)
    trailing = min(max(trailing, 0.0), leading)
    energy = leading * leading * (more - leading * (third - 0.25 * leading))
    energy -= trailing * trailing * (more - trailing * (third - 0.25 * trailing))
    return slope * centre * half_width * max(energy - level * (leading - trailing), 0.0)


def _elliptic_arrays(creepage: Array, slope: Array, centre: Array, half_width: Array, threshold: float) -> Array:
    reduced, level = creepage / slope, threshold / (slope * centre)
    square = 1.0 + reduced**2
    whole = np.arctan(reduced) + reduced / square * (1.0 - 2.0 * level)
    cosine = np.minimum(level / np.sqrt(square), 1.0)
    capped = np.arccos(cosine) - cosine * np.sqrt((1.0 - cosine) * (1.0 + cosine))
    return creepage * centre * half_width * np.where(level <= 1.0, whole, capped)


@wl.kernel(_elliptic_arrays)
def elliptic_excess(creepage: float, slope: float, centre: float, half_width: float, threshold: float) -> float:
    """Return ∫ max(q s - threshold, 0) dx [N/m] for the ellipse, of g, μp2(0) and other values in SI."""
    reduced, level = creepage / slope, threshold / (slope * centre)
    scale = creepage * centre * half_width
    square = 1.0 + reduced * reduced
    if level <= 1.0:
        return scale * (math.atan(reduced) + reduced / square * (1.0 - 2.0 * level))
    cosine = min(level / math.sqrt(square), 1.0)
    return scale * (math.acos(cosine) - cosine * math.sqrt((1.0 - cosine) * (1.0 + cosine)))
