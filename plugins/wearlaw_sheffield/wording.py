"""What the paper's words are taken to mean, and how verdicts and numbers are written."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

import wearlaw as wl
from wearlaw import Array

SAME = 0.02
"""Results that a plot shows as one differ by less than this share."""

SIMILAR = 0.10
"""Results that are called similar or overlapping differ by less than this share."""

GOOD = 0.20
"""A good approximation, or a law that reproduces wear well, differs by less than this share."""

WORDS = f"""\
The paper states no tolerances, so each claim below has a criterion. Results are the same if they differ by less than \
{100 * SAME:g} %, similar or overlapping by less than {100 * SIMILAR:g} %, and a good approximation by less than \
{100 * GOOD:g} %. Where the paper judges by a figure, a difference is in percent of the highest rate that the window \
of the figure shows, "of the plot"; relative differences, in percent of the second result, stand beside it. Windows \
are the paper's: W.I. up to 70 N, from 50 to 350 N, and creepages up to the 20 % of the tests; section 5.2 goes to 25 %.

A claim holds in part if it holds for some of its variants or in part of the range. It cannot be decided if it depends \
on something that the paper does not give. Four things are such: the coefficient k of KTH, which has ranges, so that a \
claim holds if it does for some k within them; the slip, for which the exact theory is computed with the slip that \
follows from the tractions and with eq. (7) as printed; the flexibility L of FASTSIM; and the rolling speed V, on \
which the slip speed depends, and with it where KTH has its thresholds. V is the mean of the surface speeds, as in \
section 3 of the paper, which prints neither V nor which speed its rig keeps as the creepage grows. Claims near a \
threshold are computed for two rigs of one speed: in one, disc 1, which drives, keeps it, and V = v1/(1 + ξ/2) falls \
as the creepage grows; in the other the mean keeps it."""


def verdict(parts: Iterable[bool | None]) -> wl.Verdict:
    """Return the verdict on a claim whose parts hold, do not, or cannot be decided (None)."""
    found = list(parts)
    if all(found):
        return "holds"
    if any(found):
        return "holds in part"
    return "cannot be decided" if None in found else "does not hold"


def at_both(parts: Iterable[bool]) -> bool | None:
    """Return whether something holds whichever speed the rig keeps, or None if that depends on it."""
    found = set(parts)
    return found.pop() if len(found) == 1 else None


def by_speed(part: bool | None, what: str = "this part of the claim") -> str:
    """Return a sentence on how far a part of a claim depends on the speed that the rig keeps, from `at_both`."""
    if part is None:
        return f"Which speed the rig keeps decides {what}."
    return f"{what[0].upper()}{what[1:]} {'holds' if part else 'fails'} whichever speed the rig keeps."


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
