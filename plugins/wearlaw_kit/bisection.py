"""Jumps, kinks and lost digits of a function of one number, for many such functions at once.

When an interval is halved repeatedly, the change of a continuous function over it vanishes, and so does the change of
slope of a smooth one. A jump remains, and so does the change of slope at a kink.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from wearlaw.arrays import Array
from wearlaw_kit.examples import SAME

HALVINGS = 46
"""From 1/32 to 4e-16, the rounding of a number near 1."""

JUMP = 1e-6
"""Share of the function's value that counts as a jump. A square root, the steepest onset in theories of contact,
changes by √(2^-46) = 1.2e-7 over the last interval."""

FIRST_HALVINGS = 1
"""Halvings after which an interval is given up whose two halves change alike, in this halving and in the one before: a
jump lies in one of them. To hide it, a curved function would have to undo it twice, to a share of `jump`."""

HALVINGS_OF_KINKS = 24
"""From 1/128 to h = 4.7e-10. There the slope of a smooth function whose logarithm has the slope n changes by the share
n² h/2 of its value, which is below 1e-4 up to n = 600, and rounding of the values by 16 EPS, as many as `SAME` has,
changes it by 8 · 16 EPS/h = 6e-5."""

FIRST_HALVINGS_OF_KINKS = 6
"""Halvings after which a part is given up whose change of slope is a quarter of what counts."""

STEEP = 1e-4
"""Change of the slope, as a share, that counts as a kink. Over the last part, the slope of a smooth function whose
logarithm has the slope n changes by n h/2, and the slope of a function that turns over the share w of an e-fold by
h/(2 w)."""

UNDERFLOW = 1e-200
"""Value below which a product of two factors may underflow, and lose its digits."""

Indices: TypeAlias = NDArray[np.intp]

Function: TypeAlias = Callable[[Indices, Array], Array]
"""From indices of functions and their arguments in [0, 1], both of shape (n,), to values."""


def find_jumps(
    function: Function, count: int, intervals: int = 32, jump: float = JUMP, least: Array | float = 0.0
) -> list[tuple[int, float, float, float]]:
    """Return the jumps of functions of one number: index, argument, and the values on both sides.

    Each of `intervals` equal parts of [0, 1] is halved repeatedly, keeping the half with the larger relative change. A
    jump is found if it exceeds the change by curvature in an interval.

    Parameters
    ----------
    function : callable
        The functions.
    count : int
        Their number.
    jump : float
        The share of the function's value that counts as a jump.
    least : ndarray, (count,), or float
        For each function, a change that counts as none.
    """
    edges = np.linspace(0.0, 1.0, intervals + 1)
    index = np.repeat(np.arange(count), intervals)
    low, high = np.tile(edges[:-1], count), np.tile(edges[1:], count)
    at_low, at_high = function(index, low), function(index, high)
    size = np.maximum(jump * np.maximum(np.abs(at_low), np.abs(at_high)), np.broadcast_to(least, count)[index])
    uneven_before = np.full_like(low, np.inf)
    for halving in range(HALVINGS):
        middle = 0.5 * (low + high)
        at_middle = function(index, middle)
        uneven = np.abs(at_low - 2.0 * at_middle + at_high)
        left = _change(at_low, at_middle) >= _change(at_middle, at_high)
        low, at_low = np.where(left, low, middle), np.where(left, at_low, at_middle)
        high, at_high = np.where(left, middle, high), np.where(left, at_middle, at_high)
        if halving >= FIRST_HALVINGS:
            kept = np.flatnonzero((np.maximum(uneven, uneven_before) > size) & (np.abs(at_high - at_low) > size))
            index, size, uneven = index[kept], size[kept], uneven[kept]
            low, high, at_low, at_high = low[kept], high[kept], at_low[kept], at_high[kept]
        uneven_before = uneven
        if not index.size:
            break
    return list(zip(index.tolist(), high.tolist(), at_low.tolist(), at_high.tolist(), strict=True))


def each_once(functions: Callable[[Indices, Array], Mapping[str, Array]]) -> Callable[[str], Function]:
    """Return the function with a name, of functions that are evaluated together and once at each place."""
    values: dict[tuple[int, float], dict[str, float]] = {}

    def evaluated(name: str, index: Indices, share: Array) -> Array:
        places = list(zip(index.tolist(), share.tolist(), strict=True))
        if new := list({place: None for place in places if place not in values}):
            at, shares = (np.array(column) for column in zip(*new, strict=True))
            columns = {of: array.tolist() for of, array in functions(at, shares).items()}
            for number, place in enumerate(new):
                values[place] = {of: column[number] for of, column in columns.items()}
        return np.array([values[place][name] for place in places])

    return lambda name: partial(evaluated, name)


def _change(before: Array, behind: Array) -> Array:
    total = np.abs(before) + np.abs(behind)
    change: Array = np.divide(np.abs(behind - before), total, out=np.zeros_like(total), where=total > 0)
    return change


def find_kinks(function: Function, threshold: Array, intervals: int = 128) -> list[tuple[int, float, float, float]]:
    """Return the kinks of functions of one number: index, arguments on both sides, and size.

    [0, 1] is covered twice by parts of length 1/`intervals`, so that each kink lies well inside one. Each part is
    shrunk repeatedly to its first, middle or last half, whichever has the largest change of slope. A kink then lies
    between a quarter and three quarters of the remaining part, where at least half of its change of slope shows.

    Parameters
    ----------
    function : callable
        The functions.
    threshold : ndarray, (count,)
        For each function, the change of slope, over the largest value in the part, that counts as a kink. It must also
        exceed `STEEP` times the slope itself, which may be large for small values.
    """
    starts, width = np.arange(2 * intervals - 1) / (2.0 * intervals), 1.0 / intervals
    index, low = np.repeat(np.arange(threshold.size), starts.size), np.tile(starts, threshold.size)
    values = np.stack([function(index, low + 0.25 * quarter * width) for quarter in range(5)])
    size = np.abs(values).max(axis=0)
    change = least = np.zeros_like(low)
    for halving in range(HALVINGS_OF_KINKS):
        each = np.arange(low.size)
        chosen = np.abs(values[:-2] - 2.0 * values[1:-1] + values[2:]).argmax(axis=0)
        low, width = low + 0.25 * width * chosen, 0.5 * width
        kept = [values[chosen + quarter, each] for quarter in range(3)]
        between = [function(index, low + quarter * width) for quarter in (0.25, 0.75)]
        values = np.stack([kept[0], between[0], kept[1], between[1], kept[2]])
        change = 2.0 / width * np.abs(values[0] - 2.0 * values[2] + values[4])
        slope = np.abs(values[4] - values[0]) / width
        least = np.maximum(threshold[index] * size, STEEP * slope)
        if halving >= FIRST_HALVINGS_OF_KINKS:  # a kink shows as much in each part, what is smooth half as much
            remain = change > 0.25 * least
            index, low, size, change, least = (array[remain] for array in (index, low, size, change, least))
            values = values[:, remain]
        if not index.size:
            return []
    kinks = np.flatnonzero((change > least) & (size > UNDERFLOW))
    return [(int(index[i]), float(low[i]), float(low[i] + width), float(change[i] / size[i])) for i in kinks]


def lost_digits(function: Callable[[float], Array], message: str, rounding: float = SAME) -> None:
    """Assert that a function of a factor near 1 is as exact as rounding allows, by changes of 1e-8.

    With D(h) the change over h relative to the value, a smooth function has D(h) = e + c h + O(h²), where e is its
    condition number, so that D(1e-5) - D(1e-8) is 1/9 of D(1e-4) - D(1e-5), and rounding of the value and of its
    argument, (1 + |e|) `rounding` in both ends of the change, moves D(1e-8) by 2 (1 + |e|) `rounding`/1e-8. That is
    7e-7 (1 + |e|) for 16 roundings; single precision, with its 6e-8, moves it by 6. A kink or jump between two of
    the arguments breaks this on one side of 1 only.

    A function may also bend within some 1e-5 of 1, as the force of a patch does where a row of it hardly slides. Its
    D(1e-7) then is D(1e-8), which is not zero. In single precision D(1e-8) is 6 at the least, or zero.
    """
    here = function(1.0)
    lost = np.ones(here.shape, dtype=bool)
    worst = np.zeros(here.shape)
    for side in (-1.0, 1.0):
        coarse, middle, near, fine = (_slope(function, here, side * step) for step in (1e-4, 1e-5, 1e-7, 1e-8))
        noise = 2.0 * (1.0 + np.abs(middle)) * rounding / 1e-8
        lost &= np.abs(fine - middle) > np.abs(coarse - middle) / 8.0 + noise
        lost &= (np.abs(fine - near) > noise) | (fine == 0.0)
        worst = np.maximum(worst, np.abs(fine - middle))
    assert not lost.any(), (
        f"{message}: relative to a change of 1e-8 it is off by {worst[lost].max():.2g} times that;"
        " is it computed in single precision, or as a difference of large numbers?"
    )


def _slope(function: Callable[[float], Array], here: Array, step: float) -> Array:
    # The factor that is applied is a double, whose distance from 1 is not quite the step.
    change = function(1.0 + step) - here
    slope: Array = np.divide(change, ((1.0 + step) - 1.0) * here, out=np.zeros_like(here), where=here != 0)
    return slope
