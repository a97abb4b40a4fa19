"""Measures of a worn wheel: flange height, thickness and gradient, and the hollow of the tread."""

from __future__ import annotations

import numpy as np

from wearlaw import Array

BELOW_TOP, DATUM, ABOVE_TREAD = 2e-3, 70e-3, 10e-3
"""Where a flange is measured [m]: L1, L2 and L3 of "Wheel wear" in MiniProf's standard calculations, which state these
defaults (Greenwood Engineering, greenwood.dk/miniprofstandardcalc.php)."""

NAMES = ("flange_height", "flange_thickness", "flange_gradient", "hollow")


def flange(y: Array, z: Array, back: float) -> tuple[float, float, float]:
    """Return the flange height Sh, the flange thickness Sd and the flange gradient qR of a wheel [m].

    The tread datum is the point of the profile 70 mm from the back of the flange. Sh is the height of the flange's top
    over the datum. Sd is the distance from the back to the flank, 10 mm above the datum (towards the flange's top). qR
    is the distance, parallel to the axle, between the point of the flank 10 mm above the datum and the one 2 mm below
    the top.

    Parameters
    ----------
    y, z : ndarray, (points,)
        The profile, outwards and down [m], from the flange to the field side.
    back : float
        y of the back of the flange [m].

    Returns
    -------
    tuple of float
        NaN for a wheel without a flange or a profile that does not reach the datum.

    Notes
    -----
    The quantities are those of MiniProf's calculation "Wheel wear"; the text of EN 15313 was not read.
    """
    tip = int(np.argmax(z))
    outer = slice(tip, None)
    at = back + DATUM
    if not y[tip] < at <= y[-1]:
        return np.nan, np.nan, np.nan
    tread = float(np.interp(at, y[outer], z[outer]))
    height = float(z[tip]) - tread
    if height <= ABOVE_TREAD + BELOW_TOP:
        return np.nan, np.nan, np.nan
    flank, top = (_first_below(y[outer], z[outer], level) for level in (tread + ABOVE_TREAD, z[tip] - BELOW_TOP))
    return height, flank - back, flank - top


def _first_below(y: Array, z: Array, level: float) -> float:
    """Return y where a flank, from the top of the flange outwards, first rises above a height [m]."""
    place = int(np.argmax(z < level))
    share = (z[place - 1] - level) / (z[place - 1] - z[place])
    return float(y[place - 1] + share * (y[place] - y[place - 1]))


def hollow(z: Array) -> float:
    """Return the depth of the hollow of a tread: the largest rise of the radius on the way outwards [m].

    It is zero for a tread whose radius falls from the flange to the field side, as that of a new wheel does. The
    definition is wearlaw's: a place of the tread is hollow if places further out have a larger radius.
    """
    tread = z[int(np.argmax(z)) :]
    return float((np.maximum.accumulate(tread[::-1])[::-1] - tread).max())
