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
"""Steps of the arithmetic-geometric mean: enough for c over √(l²+c²) down to 1e-4, and to 1e-3 of it at 1e-10."""

TOLERANCE = 1e-10
"""Relative error of the force that a penetration is solved to."""

WIDTH = 1e-12
"""Relative width of the bracket of a penetration at which the force is taken to jump."""

ITERATIONS = 100
"""Largest number of steps: bisection alone takes 60."""

NEWTON = 60
"""Largest number of steps to an end of the patch; 4 are common."""

LEAST_SLOPE, STEEPEST_SLOPE = 0.5, 6.0
"""Range of d ln N / d ln δ; it is 3/2 where the gap is a parabola."""

REACH = 1.1
"""Least semi-axis across the ellipse, over the distance of its middle from the deepest point."""

FLOOR = 1e-4
"""Half the length of strips that do not touch, over that of the longest: they lie between two humps of the patch."""

NEED = 4
"""Samples of a cubic."""

NARROW, JUMPS = 1.0, 2.0
"""What may be wrong: the window is too narrow; the force jumps over the given one."""

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

    and d ln(B/A) / d(-ln κ) = 2 - (f² - 2T)/(f(1 - f)), so that Newton's method solves for ln κ.
    """
    logarithm: Any = log_ratio * (2.0 / math.pi)
    share: Any = 0.5
    for _ in range(4):
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
        rest = 1.0 - share
        slope = 2.0 - (share * share - 2.0 * total) / (share * rest)
        logarithm = logarithm + (log_ratio - 2.0 * logarithm - np.log(rest / share)) / slope
    return share  # type: ignore[no-any-return]


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


def _lowest(gap: Array) -> tuple[int, int, float, float]:
    """Return the first and the last sample of the window, and the place and value of the smallest gap in it."""
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


def _end(
    gap: Array,
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
    outer = cell if direction < 0 else cell + 1
    j = first if direction < 0 else last
    begin = j
    while (outer - j) * direction < 0:
        if threshold(top, bend, middle, cap, float(j)) > gap[j] - least:
            break
        j -= direction
    if threshold(top, bend, middle, cap, float(j)) > gap[j] - least:
        if j == begin:
            return float(j), True
        outer = j + direction
    cell = outer if direction < 0 else outer - 1
    inner = max(deepest, float(cell)) if direction > 0 else min(deepest, float(cell + 1))
    base, c0, c1, c2, c3 = _coefficients(gap, first, last, cell)
    out = float(outer)
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
        if step < 1e-13 * last:
            break
    return u, False


def _region(
    gap: Array, first: int, last: int, deepest: float, least: float, spacing: float, curvature: float, approach: float
) -> tuple[float, float, float, float, float, float, float, bool]:
    """Return the threshold (top, bend and middle), the ends of the patch, Hertz's semi-axes, and what is wrong."""
    half = 0.5 * approach
    low, cut_low = _end(gap, first, last, deepest, least, half, 0.0, 0.0, half, -1)
    high, cut_high = _end(gap, first, last, deepest, least, half, 0.0, 0.0, half, 1)
    reach = 0.5 * spacing * (high - low)
    middle = 0.5 * (low + high)
    across = half / (reach * reach)
    long = across >= curvature
    share = hertz_share(abs(math.log(across / curvature)))
    along_share = share if long else 1.0 - share
    a = math.sqrt(along_share * approach / curvature)
    b = math.sqrt((1.0 - along_share) * approach / across)
    wide = max(b / spacing, REACH * abs(deepest - middle))
    top = approach * along_share
    bend = approach * (2.0 * along_share - 1.0) / (wide * wide)
    start, cut_start = _end(gap, first, last, deepest, least, top, bend, middle, approach, -1)
    end, cut_end = _end(gap, first, last, deepest, least, top, bend, middle, approach, 1)
    return top, bend, middle, start, end, a, b, cut_low or cut_high or cut_start or cut_end


def _square(
    gap: Array,
    first: int,
    last: int,
    least: float,
    top: float,
    bend: float,
    middle: float,
    approach: float,
    curvature: float,
    u: float,
) -> float:
    """Return the square of half the length of the strip at u."""
    free = threshold(top, bend, middle, approach, u) - (height(gap, first, last, u) - least)
    return max(free, 0.0) / curvature


def _solve(
    gap: Array,
    spacing: float,
    curvature: float,
    modulus: float,
    approach: float,
    load: float,
    cosine: Array,
    sine: Array,
    share: Array,
    weight: Array,
    fields: Array,
    sums: Array,
) -> None:
    """Fill in the strips (y in samples, width, half the length) and the sums of a patch."""
    first, last, deepest, least = _lowest(gap)
    count = cosine.size
    logarithm, before_log, before = math.log(approach), 0.0, 0.0
    low, high = -math.inf, math.inf
    warning = 0.0
    for iteration in range(ITERATIONS):
        approach = math.exp(logarithm)
        top, bend, middle, start, end, a, b, cut = _region(
            gap, first, last, deepest, least, spacing, curvature, approach
        )
        displaced = 0.0
        for k in range(share.size):
            for side in range(2):
                span = (end if side else start) - deepest
                square = _square(
                    gap, first, last, least, top, bend, middle, approach, curvature, deepest + share[k] * span
                )
                distance = spacing * abs(span) * share[k]
                displaced += spacing * abs(span) * weight[k] * compliance(square, distance)
        slope = math.pi * modulus * approach / displaced  # of the pressure in √(l²-x²)
        force, half = 0.0, 0.5 * (end - start)
        for i in range(count):
            fields[0, i] = start + half * (1.0 + cosine[i])
            fields[1, i] = half * spacing * sine[i]
            fields[2, i] = _square(gap, first, last, least, top, bend, middle, approach, curvature, fields[0, i])
            force += fields[1, i] * fields[2, i]
        force *= 0.5 * math.pi * slope
        if load <= 0.0:
            break
        miss = math.log(force / load)
        if abs(miss) < TOLERANCE:
            break
        if miss < 0.0:
            low = logarithm
        else:
            high = logarithm
        if high - low < WIDTH:
            if miss < 0.0:
                warning = JUMPS
                break
            to = low
        else:
            rate = 1.5
            if iteration > 0:
                rate = (miss - before) / (logarithm - before_log)
                rate = min(max(rate, LEAST_SLOPE), STEEPEST_SLOPE)
            to = logarithm - miss / rate
            if not low < to < high:
                to = 0.5 * (low + high)
        before_log, before, logarithm = logarithm, miss, to
    if load > 0.0:
        slope *= load / force
        force = load
    sums[0], sums[1], sums[2], sums[3], sums[4], sums[5] = (
        approach,
        force,
        slope,
        a,
        b,
        warning + (NARROW if cut else 0.0),
    )
    sums[6] = math.sqrt(
        _greatest(gap, first, last, least, top, bend, middle, approach, curvature, start, end, fields[2])
    )


def _greatest(
    gap: Array,
    first: int,
    last: int,
    least: float,
    top: float,
    bend: float,
    middle: float,
    approach: float,
    curvature: float,
    start: float,
    end: float,
    squares: Array,
) -> float:
    """Return the largest square of half a strip's length, from parabolas in the angle of strips."""
    i = 0
    for k in range(squares.size):
        if squares[k] > squares[i]:
            i = k
    step = math.pi / (squares.size + 1)
    angle = step * (squares.size - i)
    best: float = squares[i]
    for _ in range(3):
        centre = 0.5 * (start + end)
        half = 0.5 * (end - start)
        left = _square(
            gap,
            first,
            last,
            least,
            top,
            bend,
            middle,
            approach,
            curvature,
            centre + half * math.cos(min(angle + step, math.pi)),
        )
        here = _square(gap, first, last, least, top, bend, middle, approach, curvature, centre + half * math.cos(angle))
        right = _square(
            gap,
            first,
            last,
            least,
            top,
            bend,
            middle,
            approach,
            curvature,
            centre + half * math.cos(max(angle - step, 0.0)),
        )
        best = max(best, here)
        bow = 2.0 * here - left - right
        if bow <= 0.0:
            break
        angle += min(max(0.5 * (left - right) / bow, -1.0), 1.0) * step
        angle = min(max(angle, 0.0), math.pi)
        step *= 0.25
    return best


ROWS = "float64[:, ::1]"


@wl.compiled_loop(
    f"void({ROWS}, {ROWS}, float64[::1], float64[::1], float64[::1], float64[::1], float64[:, :, ::1], {ROWS})"
)
def patch_loop(
    gap: Array, given: Array, cosine: Array, sine: Array, share: Array, weight: Array, fields: Array, sums: Array
) -> None:
    """Fill in the strips, (patches, 3, strips), and the sums, (patches, 7), of patches.

    `given` holds the spacing of the samples, the curvature A, the effective modulus, the penetration or a guess of it,
    and the normal force or 0.
    """
    for p in range(len(gap)):
        _solve(
            gap[p],
            given[p, 0],
            given[p, 1],
            given[p, 2],
            given[p, 3],
            given[p, 4],
            cosine,
            sine,
            share,
            weight,
            fields[p],
            sums[p],
        )
