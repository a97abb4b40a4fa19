"""Removing a wear depth from a profile: smoothing, removal along the normal, and the mass that is removed."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
import scipy

import wearlaw as wl
from wearlaw import Array

if TYPE_CHECKING:
    from wearlaw_models.rigs.wheelset import (
        Profile,  # or what has its `curve`, `kind`, `points`, `worn`, `depth_to` and `measures`
    )

ACCURACY = 5e-11
"""Share of the predicted mass by which the removed one may differ, after the factor."""

STEPS = 6
"""Most steps of the secant method for the factor; two are usual."""

FLANGE = np.radians(30.0)
"""Angle of a profile beyond which it is the flange of a wheel, or the gauge side of a rail [rad]."""

EDGE = 1e-3
"""Share of the deepest wear at an end of a profile that says that the profile is too short."""


def positions(profiles: Sequence[Profile], count: int) -> Array:
    """Return even arc lengths from end to end of profiles [m]."""
    ends = np.array([profile.curve.s[[0, -1]] for profile in profiles])
    return np.linspace(ends[:, 0].min(), ends[:, 1].max(), count)


def even(profile: Profile) -> Profile:
    """Return a profile with points at even arc lengths."""
    return profile.worn(wl.Q(1e3 * profile.curve.s[[0, -1]], "mm"), "0 mm")


def widths(places: Array, at: Array, angle: Array, largest: float, least: float) -> Array:
    """Return standard deviations of a kernel that stands for further states between those of a line [m].

    It is as wide as the mean distance of the patches, for which √12 times their standard deviation is their range, and
    zero for a single patch. States in between move a patch along a tread, but hardly on a flange: with the angle δ of
    the profile the width falls, as cos², to zero at 30°. It adds to `least` as variances do.

    Parameters
    ----------
    places : ndarray, (sides, positions)
        How many patches have their middle at each position.
    at : ndarray, (positions,)
        Positions [m].
    angle : ndarray, (sides, positions)
        Angle of the profile, δ [rad].
    largest, least : float
        Limits of the width [m].
    """
    count = places.sum(axis=-1, keepdims=True)
    share = places / count
    middle = share @ at
    distance = np.sqrt(12.0 * (share * (at - middle[:, None]) ** 2).sum(axis=-1, keepdims=True)) / count
    steep = np.minimum(np.abs(angle) / FLANGE, 1.0)
    width: Array = np.hypot(np.minimum(distance, largest) * np.cos(0.5 * np.pi * steep) ** 2, least)
    return width


def smoothed(depth: Array, at: Array, width: Array) -> Array:
    """Return depths at even positions [m], each spread by a Gaussian kernel; their sum stays.

    Parameters
    ----------
    depth : ndarray, (sides, positions)
    at : ndarray, (positions,)
    width : ndarray, (sides or 1, positions)
        Standard deviation of the kernel at each position [m]; zero for none.
    """
    spread = depth.copy()
    for row, wear, sigma in zip(spread, depth, np.broadcast_to(width, depth.shape), strict=True):
        worn = np.flatnonzero((wear > 0.0) & (sigma > 0.0))
        kernel = np.exp(-0.5 * ((at[:, None] - at[worn]) / np.maximum(sigma[worn], 1e-9)) ** 2)
        row[worn] = 0.0
        row += kernel @ (wear[worn] / kernel.sum(axis=0))
    return spread


def removed(profile: Profile, at: Array, depth: Array) -> Profile:
    """Return the profile after removal of depths [m] along its normal, with points at even arc lengths.

    Depths between the positions `at` [m] follow a cubic spline, so that no kinks arise.
    """
    s = profile.curve.s
    between = np.maximum(scipy.interpolate.CubicSpline(at, depth)(np.clip(s, at[0], at[-1])), 0.0)
    return profile.worn(wl.Q(1e3 * s, "mm"), wl.Q(1e3 * between, "mm"))


def swept(old: Profile, new: Profile, radius: float = np.inf) -> float:
    """Return the volume between two profiles of a wheel [m³], or the area of the section [m²] if they do not turn.

    Both are taken as polygons through their points, closed at their ends. A wheel turns about an axis at a distance
    `radius` from z = 0 [m]; the volume is exact for frustums of cones.
    """
    ends = [[1e-3 * value.magnitude for value in profile.points] for profile in (old, new)]
    y, z = (np.concatenate([ends[0][axis], ends[1][axis][::-1], ends[0][axis][:1]]) for axis in (0, 1))
    low, high = z[:-1], z[1:]
    section = 0.5 * (low + high)
    if np.isfinite(radius):
        section = np.pi * (2.0 * radius * section + (low**2 + low * high + high**2) / 3.0)
    return float(abs((section * np.diff(y)).sum()))


def conserving(profile: Profile, at: Array, depth: Array, volume: float, radius: float) -> tuple[Profile, float]:
    """Return the profile after removal of depths, and the factor that makes them remove a given volume.

    Without the factor the volume differs: a depth along the normal of a curved profile sweeps an area that also depends
    on the curvature, and smoothing moves wear to other radii.

    Raises
    ------
    InputError
        If the profile is too short for the wear.
    """
    for name, value in zip(("first", "last"), np.interp(profile.curve.s[[0, -1]], at, depth), strict=True):
        if value > EDGE * depth.max():
            raise wl.InputError(
                f"{profile.kind}: the profile is too short for the wear, which reaches {value / depth.max():.2g} of its"
                f" deepest place at the {name} point; give a wider profile, or less smoothing"
            )

    def by(factor: float) -> tuple[Profile, float]:
        new = removed(profile, at, factor * depth)
        return new, swept(profile, new, radius)

    new, lost = by(1.0)
    before, factor = (1.0, lost), volume / lost
    for _ in range(STEPS):
        new, lost = by(factor)
        if abs(lost - volume) <= ACCURACY * volume or lost == before[1]:
            break
        slope = (lost - before[1]) / (factor - before[0])
        before, factor = (factor, lost), factor + (volume - lost) / slope
    return new, factor
