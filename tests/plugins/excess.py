"""The energy above a threshold in fifty digits, and where closed forms of it are hard.

Positions are v = (a - x)/a, the distance from the trailing edge in half widths.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import mpmath  # type: ignore[import-untyped]
import numpy as np

from wearlaw import Array

DIGITS = 50  # with thirty, mpmath ends some integrals at 1e-14
BISECTIONS = 180  # 2^-180 = 1e-54

Real = Any  # mpmath has no types


@dataclass(frozen=True)
class Density:
    """q·s over the slip zone 0 < v < end, in a unit of its own; it rises up to v = top and falls from there."""

    at: Callable[[Real], Real]
    top: Real
    end: Real

    @property
    def peak(self) -> Real:
        """Return the maximum, rounded to a float."""
        with mpmath.workdps(DIGITS):
            return float(self.at(self.top))

    def excess(self, level: float) -> Real:
        """Return ∫ max(q·s - level, 0) dv, between roots that are bisected."""
        with mpmath.workdps(DIGITS):
            if self.at(self.top) <= level:
                return mpmath.mpf(0)
            between = [self._root(level, mpmath.mpf(0)), self.top, self._root(level, self.end)]
            return mpmath.quad(lambda v: self.at(v) - level, between)

    def _root(self, level: float, outside: Real) -> Real:
        if self.at(outside) >= level:
            return outside
        # the distance from the end keeps its digits where the root is close to it
        low, high = mpmath.mpf(0), self.top - outside
        for _ in range(BISECTIONS):
            middle = (low + high) / 2
            low, high = (middle, high) if self.at(outside + middle) < level else (low, middle)
        return outside + high


def crowded(random: np.random.Generator, size: int) -> Array:
    """Return reduced creepages, half of them log-uniform from 1e-12 to 1e4, half next to 1 on both sides."""
    anywhere = 10.0 ** random.uniform(-12.0, 4.0, size - size // 2)
    gap = 10.0 ** random.uniform(-15.0, -1.0, size // 2)
    return np.concatenate([anywhere, 1.0 + gap * random.choice([-1.0, 1.0], gap.size)])


def shares(random: np.random.Generator, size: int) -> Array:
    """Return shares of a maximum: from 1e-6 on, next to the maximum, and next to nothing."""
    anywhere, below = 10.0 ** random.uniform(-6.0, 0.0, size), 1.0 - 10.0 ** random.uniform(-14.0, -1.0, size)
    little = 10.0 ** random.uniform(-30.0, -6.0, size)
    return np.choose(random.integers(0, 3, size), [anywhere, below, little])


def copies(formula: Callable[..., Array]) -> dict[str, Callable[..., Array]]:
    """Return a formula on arrays, and on one operating point after the other, which has functions of its own."""

    def one_by_one(*arguments: Array | float) -> Array:
        columns = np.broadcast_arrays(*arguments)
        return np.array([formula(*row) for row in zip(*columns, strict=True)])

    return {"arrays": formula, "one by one": one_by_one}
