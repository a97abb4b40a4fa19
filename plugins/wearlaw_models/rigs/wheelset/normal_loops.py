"""The method of `_normal`: formulas that NumPy shares, and the loop over patches that numba compiles.

Places across the patch are in samples of the gap: sample j lies at u = j.
"""

from __future__ import annotations

import math
from typing import Any, TypeVar

import numpy as np

import wearlaw as wl
from wearlaw import Array

AGM = 6
"""Steps of an arithmetic-geometric mean: right to 1e-12 for ratios of its numbers from 1e-4, to 1e-3 from 1e-10."""

HERTZ = 2
"""Newton steps to the axis ratio: right to 2e-12 for ratios of curvatures up to 100, to 4e-11 beyond."""

NEWTON = 60
"""Largest number of steps to an end of the patch; 4 are common."""

STEP = 1e-13
"""Step at which an end is found, over the number of samples."""

PEAK = 3
"""Steps to the longest strip."""

REACH = 1.1
"""Least semi-axis across the ellipse, over the distance of its middle from the deepest point."""

FLOOR = 1e-4
"""Half the length of strips that do not touch, over that of the longest: they lie between two humps of the patch."""

NEED = 4
"""Samples of a cubic."""

Number = TypeVar("Number", float, Array)


def cubic(g0: Number, g1: Number, g2: Number, g3: Number) -> tuple[Number, Number, Number]:
    """Return the coefficients of x, x² and x³ of the cubic through four samples at x = 0, 1, 2 and 3."""
    return (
        3.0 * (g1 - g0) - 1.5 * (g2 - g0) + (g3 - g0) / 3.0,
        -2.5 * (g1 - g0) + 2.0 * (g2 - g0) - 0.5 * (g3 - g0),
        0.5 * (g1 - g2) + (g3 - g0) / 6.0,
    )


def threshold(top: Number, bend: Number, middle: Number, cap: Number, u: Number) -> Number:
    """Return the gap at which contact ends, a parabola between 0 and the penetration."""
    value: Any = np.minimum(np.maximum(top - bend * (u - middle) * (u - middle), 0.0), cap)
    return value  # type: ignore[no-any-return]


def compliance(square: Number, distance: Number) -> Number:
    """Return ∫ √(l²-x²)/√(x²+c²) dx over a strip of half the length l, from l² and c.

    It is 2√(l²+c²) (K(m) - E(m)) with m = l²/(l²+c²). With the arithmetic-geometric mean of √(l²+c²) and c this is
    π/mean (l²/2 + c1² + 2 c2² + 4 c3² ...), where c_n is half the difference of the numbers at step n - 1.
    """
    mean: Any = np.sqrt(square + distance * distance)
    other: Any = distance
    total: Any = 0.5 * square
    weight = 1.0
    for _ in range(AGM):
        half = 0.5 * (mean - other)
        other = np.sqrt(mean * other)
        mean = mean - half
        total = total + weight * half * half
        weight *= 2.0
    return math.pi * total / mean  # type: ignore[no-any-return]


def hertz_share(log_ratio: Number) -> Number:
    """Return A a²/δ of Hertz's ellipse with its major semi-axis a, from ln(B/A) ≥ 0.

    B b²/δ is the rest to one. With κ = b/a, m = 1 - κ² and the step c_n of the arithmetic-geometric mean of 1 and κ,

        A a²/δ = f = (K - E)/(m K) = 1/2 + m T,  T = ∑ 2^(n-1) (c_n/m)²,  B/A = (1 - f)/(f κ²),

    df / d(-ln κ) = f² - 2T and d ln(B/A) / d(-ln κ) = 2 - (f² - 2T)/(f(1 - f)), so that Newton's method solves for
    ln κ, and each step corrects f. The first guess of -ln κ has its slope at the circle, 2/3, and at infinity, 1/2.
    """
    logarithm: Any = log_ratio * (0.5 + 1.0 / (6.0 + 0.36 * log_ratio))
    share: Any = 0.5
    for _ in range(HERTZ):
        kappa = np.exp(-logarithm)
        m = (1.0 - kappa) * (1.0 + kappa)
        mean, other = 0.5 * (1.0 + kappa), np.sqrt(kappa)
        step = 0.25 / mean  # c1/m
        total, weight = step * step, 2.0
        for _ in range(AGM):
            mean, other = 0.5 * (mean + other), np.sqrt(mean * other)
            step = 0.25 * m * step * step / mean
            total = total + weight * step * step
            weight *= 2.0
        share = 0.5 + m * total
        rest, growth = 1.0 - share, share * share - 2.0 * total
        ahead = (log_ratio - 2.0 * logarithm - np.log(rest / share)) / (2.0 - growth / (share * rest))
        logarithm, share = logarithm + ahead, share + growth * ahead
    return share  # type: ignore[no-any-return]


def correction(approach: Number, curvature: Number, reach: Number, skew: Number) -> tuple[Number, Number]:
    """Return the threshold in the middle of the patch, A a², and its bend, (A a² - B b²)/b².

    Parameters
    ----------
    approach
        The penetration, δ.
    curvature
        A, for lengths in the unit of `reach`.
    reach
        Half the width of the patch at half the penetration.
    skew
        Distance of the deepest point from the middle; the ellipse reaches at least a little beyond that point.
    """
    across: Any = 0.5 * approach / (reach * reach)
    log_ratio: Any = np.log(across / curvature)
    share: Any = hertz_share(np.abs(log_ratio))
    share = 0.5 + np.sign(log_ratio) * (share - 0.5)
    b: Any = np.maximum(np.sqrt((1.0 - share) * approach / across), REACH * skew)
    return approach * share, approach * (2.0 * share - 1.0) / (b * b)


def _coefficients(gap: Array, first: int, last: int, cell: int) -> tuple[int, float, float, float, float]:
    """Return the start and the coefficients of the cubic in the cell from one sample to the next."""
    base = min(max(cell - 1, first), last - 3)
    c1, c2, c3 = cubic(gap[base], gap[base + 1], gap[base + 2], gap[base + 3])
    return base, gap[base], c1, c2, c3


def height(gap: Array, first: int, last: int, u: float) -> float:
    """Return the gap between samples."""
    base, c0, c1, c2, c3 = _coefficients(gap, first, last, int(u))
    x = u - base
    return c0 + x * (c1 + x * (c2 + x * c3))


def _lowest(gap: Array, outer: Array) -> tuple[int, int, float, float]:
    """Return the first and the last sample of the window, and the place and value of the smallest gap in it.

    Fills in the smallest gap from each sample outwards.
    """
    j = 0
    least = math.inf
    for i in range(gap.size):
        if gap[i] < least:
            j, least = i, gap[i]
    first, last = j, j
    while first > 0 and gap[first - 1] < math.inf:
        first -= 1
    while last < gap.size - 1 and gap[last + 1] < math.inf:
        last += 1
    outer[first] = gap[first]
    for i in range(first + 1, j + 1):
        outer[i] = min(outer[i - 1], gap[i])
    outer[last] = gap[last]
    for i in range(last - 1, j, -1):
        outer[i] = min(outer[i + 1], gap[i])
    if j in (first, last):
        return first, last, float(j), least
    cell = j if gap[j + 1] < gap[j - 1] else j - 1
    base, c0, c1, c2, c3 = _coefficients(gap, first, last, cell)
    x = float(j - base)
    for _ in range(4):
        curvature = 2.0 * c2 + 6.0 * c3 * x
        if curvature > 0.0:
            x -= (c1 + x * (2.0 * c2 + x * 3.0 * c3)) / curvature
        x = min(max(x, float(cell - base)), float(cell + 1 - base))
    value = c0 + x * (c1 + x * (c2 + x * c3))
    if value < least:
        return first, last, base + x, value
    return first, last, float(j), least


def _outermost(outer: Array, begin: int, end: int, level: float) -> int:
    """Return the first sample from `begin` to `end` below a level, or `end`, by bisection of `_lowest`'s array."""
    if outer[begin] < level:
        return begin
    direction = 1 if end > begin else -1
    while (end - begin) * direction > 1:
        middle = (begin + end) // 2
        if outer[middle] < level:
            end = middle
        else:
            begin = middle
    return end


def _end(
    gap: Array,
    outer_least: Array,
    first: int,
    last: int,
    deepest: float,
    least: float,
    top: float,
    bend: float,
    middle: float,
    cap: float,
    direction: int,
) -> tuple[float, bool]:
    """Return the outermost place on one side where the gap is at the threshold, and whether the window ends first."""
    cell = int(deepest)
    begin, last_one = (first, cell) if direction < 0 else (last, min(cell + 1, last))
    j = _outermost(outer_least, begin, last_one, cap + least)
    while j != last_one and threshold(top, bend, middle, cap, float(j)) <= gap[j] - least:
        j -= direction
    if threshold(top, bend, middle, cap, float(j)) > gap[j] - least:
        if j == begin:
            return float(j), True
        j += direction
    cell = j if direction < 0 else j - 1
    inner = max(deepest, float(cell)) if direction > 0 else min(deepest, float(cell + 1))
    base, c0, c1, c2, c3 = _coefficients(gap, first, last, cell)
    out = float(j)
    u = 0.5 * (inner + out)
    for _ in range(NEWTON):
        x = u - base
        level = threshold(top, bend, middle, cap, u)
        value = level - (c0 + x * (c1 + x * (c2 + x * c3)) - least)
        if value > 0.0:
            inner = u
        else:
            out = u
        slope = -(c1 + x * (2.0 * c2 + x * 3.0 * c3))
        if 0.0 < level < cap:
            slope -= 2.0 * bend * (u - middle)
        to = u - value / slope if slope != 0.0 else inner
        if not min(inner, out) <= to <= max(inner, out):
            to = 0.5 * (inner + out)
        step = abs(to - u)
        u = to
        if step < STEP * last:
            break
    return u, False


def _region(
    gap: Array,
    outer: Array,
    first: int,
    last: int,
    deepest: float,
    least: float,
    spacing: float,
    curvature: float,
    approach: float,
) -> tuple[float, float, float, float, float, bool]:
    """Return the threshold (top, bend and middle), the ends of the patch, and whether the window cuts it off."""
    half = 0.5 * approach
    low, cut_low = _end(gap, outer, first, last, deepest, least, half, 0.0, 0.0, half, -1)
    high, cut_high = _end(gap, outer, first, last, deepest, least, half, 0.0, 0.0, half, 1)
    reach, middle = 0.5 * (high - low), 0.5 * (low + high)
    top, bend = correction(approach, curvature * spacing * spacing, reach, abs(deepest - middle))
    start, cut_start = _end(gap, outer, first, last, deepest, least, top, bend, middle, approach, -1)
    end, cut_end = _end(gap, outer, first, last, deepest, least, top, bend, middle, approach, 1)
    return top, bend, middle, start, end, cut_low or cut_high or cut_start or cut_end


def _excess(
    gap: Array,
    first: int,
    last: int,
    least: float,
    top: float,
    bend: float,
    middle: float,
    approach: float,
    u: float,
) -> float:
    """Return by how much the gap is below the threshold at u."""
    return max(threshold(top, bend, middle, approach, u) - (height(gap, first, last, u) - least), 0.0)


def _greatest(
    gap: Array,
    first: int,
    last: int,
    least: float,
    top: float,
    bend: float,
    middle: float,
    approach: float,
    start: float,
    end: float,
    excess: Array,
) -> float:
    """Return the largest excess, from parabolas in the angle of strips."""
    i = 0
    for k in range(excess.size):
        if excess[k] > excess[i]:
            i = k
    step = math.pi / (excess.size + 1)
    angle = step * (excess.size - i)
    best: float = excess[i]
    centre, half = 0.5 * (start + end), 0.5 * (end - start)
    for _ in range(PEAK):
        left = centre + half * math.cos(min(angle + step, math.pi))
        right = centre + half * math.cos(max(angle - step, 0.0))
        before = _excess(gap, first, last, least, top, bend, middle, approach, left)
        here = _excess(gap, first, last, least, top, bend, middle, approach, centre + half * math.cos(angle))
        after = _excess(gap, first, last, least, top, bend, middle, approach, right)
        best = max(best, here)
        bow = 2.0 * here - before - after
        if bow <= 0.0:
            break
        angle += min(max(0.5 * (before - after) / bow, -1.0), 1.0) * step
        angle = min(max(angle, 0.0), math.pi)
        step *= 0.25
    return best


def _displacement(weight: Array, square: Array, distance: Array, mean: Array, total: Array) -> float:
    """Return the weighted sum of `compliance` over nodes, in loops that compilers vectorise; changes `distance`."""
    for k in range(square.size):
        mean[k] = math.sqrt(square[k] + distance[k] * distance[k])
        total[k] = 0.5 * square[k]
    factor = 1.0
    for _ in range(AGM):
        for k in range(square.size):
            half = 0.5 * (mean[k] - distance[k])
            distance[k] = math.sqrt(mean[k] * distance[k])
            mean[k] -= half
            total[k] += factor * half * half
        factor *= 2.0
    result = 0.0
    for k in range(square.size):
        result += weight[k] * total[k] / mean[k]
    return math.pi * result


ROWS, ROW = "float64[:, ::1]", "float64[::1]"


@wl.compiled_loop(f"void({ROWS}, {ROWS}, {ROW}, {ROW}, {ROW}, {ROW}, float64[:, :, ::1], {ROWS})")
def patch_loop(
    gap: Array, given: Array, cosine: Array, sine: Array, share: Array, weight: Array, fields: Array, sums: Array
) -> None:
    """Fill in the strips, (patches, 3, strips), and the sums, (patches, 3), of patches.

    `given` holds the spacing of the samples, the curvature A, the effective modulus and the penetration. The strips are
    their place, width and square of half the length; the sums the slope of the pressure in √(l²-x²), the square of half
    the longest length, and 1 where the window cuts the patch off.
    """
    outer, buffer = np.empty(gap.shape[1]), np.empty((5, 2 * share.size))
    for p in range(len(gap)):
        _solve(gap[p], given[p], cosine, sine, share, weight, outer, buffer, fields[p], sums[p])


def _solve(
    gap: Array,
    given: Array,
    cosine: Array,
    sine: Array,
    share: Array,
    weight: Array,
    outer: Array,
    buffer: Array,
    fields: Array,
    sums: Array,
) -> None:
    """Fill in the strips and the sums of a patch."""
    spacing, curvature, modulus, approach = given[0], given[1], given[2], given[3]
    first, last, deepest, least = _lowest(gap, outer)
    top, bend, middle, start, end, cut = _region(gap, outer, first, last, deepest, least, spacing, curvature, approach)
    square, distance, weights = buffer[0], buffer[1], buffer[2]
    for side in range(2):
        span = (end if side else start) - deepest
        length = spacing * abs(span)
        for k in range(share.size):
            i = side * share.size + k
            square[i] = (
                _excess(gap, first, last, least, top, bend, middle, approach, deepest + share[k] * span) / curvature
            )
            distance[i], weights[i] = length * share[k], length * weight[k]
    displaced = _displacement(weights, square, distance, buffer[3], buffer[4])
    half = 0.5 * (end - start)
    for i in range(cosine.size):
        fields[0, i] = start + half * (1.0 + cosine[i])
        fields[1, i] = half * spacing * sine[i]
        fields[2, i] = _excess(gap, first, last, least, top, bend, middle, approach, fields[0, i])
    longest = _greatest(gap, first, last, least, top, bend, middle, approach, start, end, fields[2])
    for i in range(cosine.size):
        fields[2, i] /= curvature
    sums[0], sums[1], sums[2] = math.pi * modulus * approach / displaced, longest / curvature, 1.0 if cut else 0.0
