"""What the paper's words are taken to mean, and how numbers are written in what was found."""

from __future__ import annotations

import numpy as np

from wearlaw import Array

SAME = 0.02
"""Curves that a plot shows as one differ by less than this share."""

SIMILAR = 0.10
"""Results that are called similar, overlapping or a good approximation differ by less than this share."""

CLOSE = 2.0
"""Laws that are called close to each other are less than this factor apart."""

WORDS = f"""\
The paper states no tolerances. Here, results are the same if they differ by less than {100 * SAME:g} %, similar, \
overlapping or a good approximation if by less than {100 * SIMILAR:g} %, and laws are close if they are less than \
a factor of {CLOSE:g} apart, at every creepage of the range that is named. A difference is that of the first result \
from the second, in percent of the second. KTH states its coefficient k as ranges; where its place in the range \
matters, a claim is put to the test at both ends and in the middle, else in the middle."""


def percent(share: float) -> str:
    """Return a relative difference with its sign, as in "+12.3 %"."""
    if abs(share) < 5e-4:
        return "0.0 %"
    return f"{100 * share:+.{0 if abs(share) >= 1 else 1}f} %"


def largest(relative: Array, x: Array) -> tuple[float, float]:
    """Return the entry of largest magnitude and where it is."""
    i = int(np.abs(relative).argmax())
    return float(relative[i]), float(x[i])


def first_crossing(x: Array, one: Array, other: Array) -> float | None:
    """Return where `one - other` first loses the sign that it begins with, by linear interpolation; None if nowhere."""
    difference = one - other
    beyond = np.flatnonzero(difference * difference[0] < 0)
    if beyond.size == 0:
        return None
    i = int(beyond[0])
    share = difference[i] / (difference[i] - difference[i - 1])
    return float(x[i] + share * (x[i - 1] - x[i]))
