"""The energy that FASTSIM in two dimensions dissipates above a threshold, in closed form.

With d = ξ/g, where g = L μp2(0)/a × 2 (parabola) or × 1 (ellipse) is the slope of the bound times L, and v = (a - x)/a:

parabola: q s = μp2(0) g P(v), P(v) = v (2-v) (1+d-v), over v < 2 min(d, 1). P rises from zero to one maximum and then
falls towards its next zero z = min(2, 1+d). With v counted from 0 or from z, P is v (z-v) (B + g v).
ellipse: q s = μp2(0) g (d sin ψ + cos ψ) over ψ < 2 atan d, where x = a cos ψ: symmetric about its maximum √(1+d²)
at ψ = atan d, and at least 1 everywhere in the slip zone.

A single operating point of the parabola takes the functions of `math`, with which a formula is ten times as fast as
with NumPy's.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple, TypeVar

import numpy as np

from wearlaw import Array

CLOSE = 2e-3
"""Step of Halley's method after which a root is good enough; see `wearlaw_exact._kernel.CLOSE` for the reason."""

STEPS = 60
"""Most steps; two to four are enough, except near d = 1."""

Number = TypeVar("Number", float, Array)


class Functions(NamedTuple):
    """Functions of floats or of arrays."""

    sqrt: Any
    minimum: Any
    maximum: Any
    all: Any


OF_FLOATS = Functions(math.sqrt, min, max, bool)
OF_ARRAYS = Functions(np.sqrt, np.minimum, np.maximum, np.all)


def parabolic_excess(creepage: Array, *others: Any) -> Array:
    """Return ∫ max(q s - threshold, 0) dx [N/m] for the parabola.

    Parameters
    ----------
    creepage, *others : ndarray
        ξ, g, μp2(0), a and the threshold in SI, of one shape; all but the first may be numbers.
    """
    if creepage.size == 1:
        reduced, level, unit = _reduced(float(creepage.item()), *map(_number, others))
        *of_point, highest = _maximum(OF_FLOATS, reduced)
        return np.full(creepage.shape, unit * _above(OF_FLOATS, level, *of_point) if level < highest else 0.0)
    with np.errstate(over="ignore"):  # a threshold may lie infinitely far above all values
        reduced, level, unit = _reduced(creepage, *others)
    *of_points, highest = _maximum(OF_ARRAYS, reduced)
    excess, reached = np.zeros(creepage.shape), np.nonzero(level < highest)
    excess[reached] = _above(OF_ARRAYS, level[reached], *(values[reached] for values in of_points))
    energy: Array = excess * unit
    return energy


def elliptic_excess(creepage: Array, *others: Any) -> Array:
    """Return ∫ max(q s - threshold, 0) dx [N/m] for the ellipse, as `parabolic_excess` does for the parabola."""
    with np.errstate(over="ignore"):
        reduced, level, unit = _reduced(creepage, *others)
    square = 1.0 + reduced * reduced
    whole = np.arctan(reduced) + reduced / square * (1.0 - 2.0 * np.minimum(level, 1.0))
    cosine = np.minimum(level / np.sqrt(square), 1.0)
    capped = np.arccos(cosine) - cosine * np.sqrt((1.0 - cosine) * (1.0 + cosine))
    energy: Array = reduced * unit * np.where(level <= 1.0, whole, capped)
    return energy


def _number(value: Any) -> float:
    return float(value.item() if isinstance(value, np.ndarray) else value)


def _reduced(creepage: Any, slope: Any, centre: Any, half_width: Any, threshold: Any) -> tuple[Any, Any, Any]:
    """Return d, the threshold over μp2(0) g, and the unit of the energy [N/m]."""
    scale = slope * centre
    return creepage / slope, threshold / scale, scale * half_width


def _maximum(of: Functions, reduced: Number) -> tuple[Number, Number, Number, Number, Number]:
    """Return the end of the slip zone, 1+d, the v of the maximum, and that in the zone with its P."""
    end, more = 2.0 * of.minimum(reduced, 1.0), 1.0 + reduced
    top = 2.0 * more / (2.0 + more + of.sqrt(reduced * reduced + 3.0))
    crest = of.minimum(top, end)
    return end, more, top, crest, crest * (2.0 - crest) * (more - crest)


def _above(of: Functions, level: Number, end: Number, more: Number, top: Number, crest: Number) -> Number:
    """Return ∫ max(P - level, 0) dv over the slip zone, for a level below the maximum there."""
    zero, other = of.minimum(2.0, more), of.maximum(2.0, more)
    left = level / (top * (zero - top) * (other - top))
    share = left / (1.0 + of.sqrt(of.maximum(1.0 - left, 0.0)))  # on the parabola through the maximum
    trailing = of.minimum(_root(of, other, -1.0, zero, level, top, top * share), crest)
    leading = zero - _root(of, other - zero, 1.0, zero, level, zero - top, (zero - top) * share)
    leading = of.minimum(of.maximum(leading, crest), end)
    above: Number = of.maximum(_energy(more, leading) - _energy(more, trailing) - level * (leading - trailing), 0.0)
    return above


def _energy(more: Number, v: Number) -> Number:
    """Return ∫ P from 0 to v."""
    return v * v * (more - v * ((2.0 + more) / 3.0 - 0.25 * v))


def _change(base: Number, growth: float, zero: Number, level: Number, v: Number) -> Number:
    """Return Halley's step towards v (zero-v) (base + growth v) = level."""
    line, arch, slope = base + growth * v, v * (zero - v), zero - 2.0 * v
    value = arch * line - level
    first = slope * line + growth * arch
    half_second = growth * slope - line
    return value * first / (first * first - value * half_second + 1e-300)  # all terms are zero at the maximum itself


def _root(of: Functions, base: Number, growth: float, zero: Number, level: Number, top: Number, v: Number) -> Number:
    """Return the v below the maximum at `top` where v (zero-v) (base + growth v) is at its level, near a guess `v`."""
    for _ in range(STEPS):
        old = v
        v = old - _change(base, growth, zero, level, old)
        v = of.minimum(of.maximum(v, 0.25 * old), 0.5 * (old + top))
        if of.all(abs(v - old) <= CLOSE * of.minimum(v, top - v)):
            break
    return v
