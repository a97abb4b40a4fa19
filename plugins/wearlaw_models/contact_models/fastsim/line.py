"""The energy that FASTSIM in two dimensions dissipates above a threshold, in closed form.

With d = ξ/g, where g = L μp2(0)/a × 2 (parabola) or × 1 (ellipse) is the slope of the bound times L, and v = (a - x)/a:

parabola: q s = μp2(0) g P(v), P(v) = v (2-v) (1+d-v), over v < 2 min(d, 1). P rises from zero to its maximum at v = c,
and then falls towards its next zero, min(2, 1+d). With r = √(d²+3)/3 P is at a level at v = c + r (1 - cos α ∓
√3 sin α), where its maximum less the level is 4 r³ sin²(3α/2): Viète's roots of a cubic.
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

Number = TypeVar("Number", float, Array)


class Functions(NamedTuple):
    """Functions of floats or of arrays."""

    sqrt: Any
    sin: Any
    cos: Any
    arcsin: Any
    minimum: Any
    maximum: Any


OF_FLOATS = Functions(math.sqrt, math.sin, math.cos, math.asin, min, max)
OF_ARRAYS = Functions(np.sqrt, np.sin, np.cos, np.arcsin, np.minimum, np.maximum)


def parabolic_excess(creepage: Array, *others: Any) -> Array:
    """Return ∫ max(q s - threshold, 0) dx [N/m] for the parabola.

    Parameters
    ----------
    creepage, *others : ndarray
        ξ, g, μp2(0), a and the threshold in SI, of one shape; all but the first may be numbers.
    """
    if not creepage.ndim:
        reduced, level, unit = _reduced(*map(float, (creepage, *others)))
        *of_point, highest = _maximum(OF_FLOATS, reduced)
        of_patch: Array = np.asarray(unit * _above(OF_FLOATS, level, *of_point) if level < highest else 0.0)[()]
        return of_patch
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


def _reduced(creepage: Any, slope: Any, centre: Any, half_width: Any, threshold: Any) -> tuple[Any, Any, Any]:
    """Return d, the threshold over μp2(0) g, and the unit of the energy [N/m]."""
    scale = slope * centre
    return creepage / slope, threshold / scale, scale * half_width


def _maximum(of: Functions, reduced: Number) -> tuple[Number, Number, Number, Number, Number]:
    """Return the v where the slip zone begins, beyond the patch at full slip, 1+d, r, c, and the greatest P in it."""
    start, more, root = 2.0 * reduced, 1.0 + reduced, of.sqrt(reduced * reduced + 3.0)
    top = 2.0 * more / (2.0 + more + root)
    return start, more, root / 3.0, top, _density(more, of.minimum(top, start))


def _above(of: Functions, level: Number, start: Number, more: Number, size: Number, top: Number) -> Number:
    """Return ∫ max(P - level, 0) dv over the slip zone, for a level below the maximum there."""
    drop = of.maximum(_density(more, top) - level, 0.0)
    angle = 2.0 / 3.0 * of.arcsin(of.sqrt(of.minimum(drop / (4.0 * size * size * size), 1.0)))
    middle, apart = top + size * (1.0 - of.cos(angle)), math.sqrt(3.0) * size * of.sin(angle)
    trailing, leading = middle - apart, of.minimum(middle + apart, start)
    trailing = trailing - (_density(more, trailing) - level) / (2.0 * more)  # keeps its digits next to zero
    above: Number = of.maximum(_energy(more, leading) - _energy(more, trailing) - level * (leading - trailing), 0.0)
    return above


def _density(more: Number, v: Number) -> Number:
    """Return P, whose slope is 2 (1+d) at v = 0."""
    return v * (2.0 - v) * (more - v)


def _energy(more: Number, v: Number) -> Number:
    """Return ∫ P from 0 to v."""
    return v * v * (more - v * ((2.0 + more) / 3.0 - 0.25 * v))
