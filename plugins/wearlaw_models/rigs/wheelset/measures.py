"""Wear of profiles: flange and tread of a wheel, top and side of a rail, and the depth between two or removed."""

from __future__ import annotations

import numpy as np

import wearlaw as wl
from wearlaw import Array
from wearlaw_models.rigs.wheelset.curve import Curve, through_points

BELOW_TOP, DATUM, ABOVE_TREAD = 2e-3, 70e-3, 10e-3
"""Where a flange is measured [m]: L1, L2 and L3 of "Wheel wear" in MiniProf's standard calculations, which state these
defaults (Greenwood Engineering, greenwood.dk/miniprofstandardcalc.php)."""

SIDE_DEPTH = 14e-3
"""Depth below its top at which the gauge side of a rail is measured, where the gauge is measured too [m]."""

DEEP, TOP = 10e-3, 20e-3
"""Depth of the sides below the top, and half-width of the top, by which a rail's lean is measured [m]."""

NEWTON = 4
"""Steps of Newton's method to where a normal meets a worn profile; the error squares in each."""


def flange(y: Array, z: Array, back: float) -> tuple[float, float, float]:
    """Return the flange height Sh, the flange thickness Sd and the flange gradient qR of a wheel [m].

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


def side(y: Array, z: Array, depth: float) -> float:
    """Return y of the gauge side of a rail at a depth below its top [m]; NaN if it does not reach there."""
    top = int(np.argmin(z))
    up = slice(top, None, -1)
    if z[up].max() <= z[top] + depth:
        return np.nan
    return _first_below(y[up], -z[up], -z[top] - depth)


def rail_wear(new: Curve, worn: Curve) -> tuple[float, float]:
    """Return the vertical wear of a rail at y = 0, and its side wear at one level below the top of the new one [m]."""
    _check_alike(new, worn)
    reaches = max(new.y[0], worn.y[0]) < 0.0 < min(new.y[-1], worn.y[-1])
    vertical = worn.at(0.0)[1] - new.at(0.0)[1] if reaches else np.nan
    lower = float(worn.z.min() - new.z.min())
    sides = side(new.y, new.z, SIDE_DEPTH), side(worn.y, worn.z, SIDE_DEPTH - lower)
    return float(vertical), sides[1] - sides[0]


def _check_alike(new: Curve, worn: Curve) -> None:
    if new.sign != worn.sign:
        raise wl.InputError("a worn wheel needs a new wheel to be compared with, and a worn rail a new rail")


def hollow(z: Array) -> float:
    """Return the largest rise of the radius of a wheel from the top of its flange outwards [m]."""
    tread = z[int(np.argmax(z)) :]
    return float((np.maximum.accumulate(tread[::-1])[::-1] - tread).max())


def depth_between(new: Curve, worn: Curve, s: Array) -> Array:
    """Return the depth between two curves along the normals of the new one, at its arc lengths [m]."""
    _check_alike(new, worn)
    y, z, angle, _ = new.at(s)
    place = worn.s[0] + (s - new.s[0]) / np.ptp(new.s) * np.ptp(worn.s)
    for _ in range(NEWTON):
        there = worn.at(np.clip(place, worn.s[0], worn.s[-1]))
        along = (there[0] - y) * np.cos(angle) + (there[1] - z) * np.sin(angle)
        place = place - along / np.cos(there[2] - angle)
    there = worn.at(np.clip(place, worn.s[0], worn.s[-1]))
    return np.asarray(new.sign * ((there[1] - z) * np.cos(angle) - (there[0] - y) * np.sin(angle)))


def worn_by(curve: Curve, place: Array, removed: Array) -> Curve:
    """Return a curve after removal of depths along its normal, at arc lengths [m].

    Raises
    ------
    InputError
        If the arc lengths do not grow or are not on the curve, if a depth is negative, or if it reaches the centre of a
        convex curve.
    """
    if place.ndim != 1 or not place.size or removed.shape not in ((), place.shape):
        raise wl.InputError(
            f"s must have one axis, and depth a value for each s, got shapes {place.shape} and {removed.shape}"
        )
    if (np.diff(place) <= 0.0).any() or place[0] < curve.s[0] - 1e-9 or place[-1] > curve.s[-1] + 1e-9:
        raise wl.InputError(
            f"s must grow and lie on the profile, from {1e3 * curve.s[0]:.6g} to {1e3 * curve.s[-1]:.6g} mm; got"
            f" {1e3 * place.min():.6g} to {1e3 * place.max():.6g} mm"
        )
    if (removed < 0.0).any():
        raise wl.InputError(f"depth must not be negative, got {1e3 * removed.min():.4g} mm")
    depths = np.interp(curve.s, place, np.broadcast_to(removed, place.shape), left=0.0, right=0.0)
    left = 1.0 - curve.curvature * depths
    if left.min() <= 0.0:
        worst = int(np.argmin(left))
        raise wl.InputError(
            f"depth {1e3 * depths[worst]:.4g} mm at s = {1e3 * curve.s[worst]:.4g} mm reaches the centre of the"
            f" curve, which has a radius of {1e3 / curve.curvature[worst]:.4g} mm there; remove it in smaller steps"
        )
    y = curve.y - curve.sign * np.sin(curve.angle) * depths
    z = curve.z + curve.sign * np.cos(curve.angle) * depths
    return through_points(y, z, 0.0, None, curve.sign)


def lean_of(curve: Curve) -> float:
    """Return the angle at which the top of a rail has no slope about the middle of its head [rad]."""
    lean = 0.0
    for _ in range(50):
        cosine, sine = np.cos(lean), np.sin(lean)
        y, z = cosine * curve.y - sine * curve.z, sine * curve.y + cosine * curve.z
        crown = int(np.argmin(z))
        low = z >= z[crown] + DEEP
        left, right = np.flatnonzero(low[:crown]), np.flatnonzero(low[crown:]) + crown
        if not (left.size and right.size):
            return float("nan")
        sides = []
        for inner, outer in ((left[-1] + 1, left[-1]), (right[0] - 1, right[0])):
            share = (z[crown] + DEEP - z[inner]) / (z[outer] - z[inner])
            sides.append(y[inner] + share * (y[outer] - y[inner]))
        middle = 0.5 * sum(sides)
        top = np.linspace(middle - TOP, middle + TOP, 401)
        order = slice(left[-1], right[0] + 1)
        heights = np.interp(top, y[order], z[order])
        slope = float(((top - middle) * heights).sum() / ((top - middle) ** 2).sum())
        lean -= np.arctan(slope)
        if abs(slope) < 1e-10:
            break
    return lean
