"""Tolerances for the paper's words, and helpers that find verdicts and write numbers."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

import wearlaw as wl
from wearlaw import Array

SAME = 0.02
"""Largest relative difference between results that are called the same, which coincide in a plot."""

SIMILAR = 0.10
"""Largest relative difference between results that are called similar or overlapping."""

GOOD = 0.20
"""Largest relative difference of a good approximation, or of a law that reproduces wear well."""

WORDS = f"""\
The paper states no tolerances, so each claim below has a criterion. Results are called the same if they differ by \
less than {100 * SAME:g} %, similar or overlapping if by less than {100 * SIMILAR:g} %, and a good approximation if by \
less than {100 * GOOD:g} %. Where the paper judges by a figure, differences are given in percent of the highest rate \
in the window of the figure ("of the plot"), along with relative differences in percent of the second result. The \
windows are the paper's: W.I. up to 70 N, W.I. from 50 to 350 N, and creepages up to 20 %, as in the tests; section \
5.2 goes to 25 %.

A claim holds in part if it holds for some of its variants or in part of the range. It cannot be decided if the answer \
depends on something that the paper does not give. There are four such things. The coefficient k of KTH has ranges; a \
claim holds if it holds for some k in them. The slip of the exact theory is computed both from the tractions and from \
eq. (7) as printed. The paper does not print the flexibility L of FASTSIM. Nor does it print the rolling speed V, \
which sets the slip speed and thus where KTH reaches its thresholds. Section 3 defines V as the mean of the surface \
speeds, but the paper does not say which speed its rig keeps as the creepage grows. So claims near a threshold are \
judged for two rigs with the same speed. In one, disc 1, which drives, keeps it, and V = v1/(1 + ξ/2) falls as the \
creepage grows; in the other, the mean keeps it."""


def verdict(parts: Iterable[bool | None]) -> wl.Verdict:
    """Return the verdict on a claim from its parts: each holds, does not hold, or cannot be decided (None)."""
    found = list(parts)
    if all(found):
        return "holds"
    if any(found):
        return "holds in part"
    return "cannot be decided" if None in found else "does not hold"


def at_both(parts: Iterable[bool]) -> bool | None:
    """Return whether something holds whichever speed the rig keeps, or None if that depends on the speed."""
    found = set(parts)
    return found.pop() if len(found) == 1 else None


def by_speed(part: bool | None, what: str = "this part of the claim") -> str:
    """Return a sentence on how far a part of a claim depends on the speed that the rig keeps, from `at_both`."""
    if part is None:
        return f"Whether {what} holds depends on which speed the rig keeps."
    return f"{what[0].upper()}{what[1:]} {'holds' if part else 'fails'} whichever speed the rig keeps."


def percent(share: float) -> str:
    """Return a relative difference with its sign, as in "+12.3 %"."""
    if abs(share) < 5e-4:
        return "0.0 %"
    return f"{100 * share:+.{0 if abs(share) >= 1 else 1}f} %"


def largest(relative: Array, x: Array) -> tuple[float, float]:
    """Return the entry of largest magnitude, and the x where it occurs."""
    i = int(np.abs(relative).argmax())
    return float(relative[i]), float(x[i])


def first_crossing(x: Array, one: Array, other: Array) -> float | None:
    """Return where `one - other` first changes sign, by linear interpolation, or None if it never does."""
    difference = one - other
    beyond = np.flatnonzero(difference * difference[0] < 0)
    if beyond.size == 0:
        return None
    i = int(beyond[0])
    share = difference[i] / (difference[i] - difference[i - 1])
    return float(x[i] + share * (x[i - 1] - x[i]))
