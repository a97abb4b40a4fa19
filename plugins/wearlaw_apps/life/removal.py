"""Removing a wear depth from a profile: smoothing, removal along the normal, and the mass that is removed."""

from __future__ import annotations

import math
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

WIDEST = 8.5
"""Reach of a kernel over its standard deviation: beyond, it is below the rounding of 1."""

STEPS = 6
"""Most steps of Newton's method for the factor; two are usual."""

FLANGE = np.radians(30.0)
"""Angle of a profile beyond which it is the flange of a wheel, or the gauge side of a rail [rad]."""

STEEPEST = np.radians(80.0)
"""Slope up to which wear makes a flank steeper [rad]. Rigs look for contact up to 86°; a patch beside that place ends
there, with the pressure of an edge."""

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
    spread, step = depth.copy(), (at[-1] - at[0]) / (at.size - 1)
    for row, wear, sigma in zip(spread, depth, np.broadcast_to(width, depth.shape), strict=True):
        worn = np.flatnonzero((wear > 0.0) & (sigma > 0.0))
        reach = math.ceil(WIDEST * sigma[worn].max(initial=0.0) / step)
        place = worn[:, None] + np.arange(-reach, reach + 1)
        kernel = np.exp(-0.5 * (step * (place - worn[:, None]) / np.maximum(sigma[worn, None], 1e-9)) ** 2)
        kernel[(place < 0) | (place >= at.size)] = 0.0
        kernel *= (wear[worn] / kernel.sum(axis=1))[:, None]
        row[worn] = 0.0
        row += np.bincount(np.clip(place, 0, at.size - 1).ravel(), kernel.ravel(), at.size)
    return spread


def shared(profile: Profile, depth: Array, resolution: float) -> Array:
    """Return depths at the points of a profile [m] after which the flank of a wheel is hardly steeper than `STEEPEST`.

    The gauge corner of a rail cuts its shape into a flank, down to where the rail is too steep for a rig to look for
    contact. There an edge would stay, which the side of a rail takes away: bodies that conform wear at the rate at
    which they approach. The edge goes, and the wear of the flank gives it up, so that the sum of the depths stays,
    unless the edge is more than that wear. What a place gives up follows the slope about it, since ripples would grow
    if each point followed its own.

    Parameters
    ----------
    profile : Profile
        The profile before the wear.
    depth : ndarray, (points,)
        Depths at the points of its curve [m].
    resolution : float
        Standard deviation of the kernel that smooths the lower end of the edge [m].
    """
    curve, tip = profile.curve, int(np.argmax(profile.curve.z))
    y, z, angle = curve.y, curve.z, curve.angle
    flank = np.where((y < 0.0) & (np.arange(y.size) >= tip), -angle, 0.0)
    steep = np.clip((flank - FLANGE) / (STEEPEST - FLANGE), 0.0, 1.0)
    if profile.kind != "wheel" or not steep.any():
        return depth
    rate = np.cos(angle) / np.tan(STEEPEST) - np.sin(angle)
    sigma = max(resolution / (curve.s[-1] - curve.s[0]) * (y.size - 1), 1e-6)  # in steps of the curve, not zero

    def smooth(values: Array) -> Array:
        return np.asarray(scipy.ndimage.gaussian_filter1d(values, sigma, truncate=WIDEST))

    def with_edge(left: Array) -> Array:
        """Return depths with the edge that they would leave."""
        along = (y + z / np.tan(STEEPEST) - rate * left)[tip:]
        beyond = along - np.minimum.accumulate(along[::-1])[::-1]  # of the steepest line from nearer to the tread
        edge = np.where(steep > 0.0, np.pad(beyond, (tip, 0)) / rate, 0.0)
        lower = curve.s < curve.s[edge.argmax()]  # the upper end is in contact
        return np.asarray(left + np.maximum(edge, np.where(lower, smooth(edge), 0.0)))

    weight = smooth(steep**2 * (3.0 - 2.0 * steep)) * depth

    def excess(share: float) -> float:
        """Return what the sum of the depths gains if the flank gives up a share of its wear."""
        return float(with_edge(depth - share * weight).sum() - depth.sum())

    if excess(0.0) <= 0.0:
        return depth
    share = scipy.optimize.brentq(excess, 0.0, 1.0, xtol=1e-12) if excess(1.0) < 0.0 else 1.0
    return with_edge(depth - share * weight)


def between(profile: Profile, at: Array, depth: Array) -> Array:
    """Return depths at the points of the curve of a profile, by a cubic spline, so that no kinks arise [m]."""
    s = np.clip(profile.curve.s, at[0], at[-1])
    return np.asarray(np.maximum(scipy.interpolate.CubicSpline(at, depth)(s), 0.0))


def removed(profile: Profile, depth: Array) -> Profile:
    """Return the profile after removal of depths along its normal at the points of its curve [m]."""
    return profile.worn(wl.Q(1e3 * profile.curve.s, "mm"), wl.Q(1e3 * depth, "mm"))


def swept(old: Profile, new: Profile, radius: float = np.inf) -> float:
    """Return the volume between two profiles of a wheel [m³], or the area of the section [m²] if they do not turn.

    Both are taken as polygons through their points, closed at their ends. A wheel turns about an axis at a distance
    `radius` from z = 0 [m]; the volume is exact for frustums of cones.
    """
    first, last = (np.array([1e-3 * value.magnitude for value in profile.points]) for profile in (old, new))
    return enclosed(first, last, radius)


def enclosed(old: Array, new: Array, radius: float) -> float:
    """Return the volume or the area of `swept` between points, (2, points) [m]."""
    y, z = np.concatenate([old, new[:, ::-1], old[:, :1]], axis=1)
    low, high = z[:-1], z[1:]
    section = 0.5 * (low + high)
    if np.isfinite(radius):
        section = np.pi * (2.0 * radius * section + (low**2 + low * high + high**2) / 3.0)
    return float(abs((section * np.diff(y)).sum()))


def conserving(profile: Profile, depth: Array, volume: float, radius: float) -> tuple[Profile, float]:
    """Return the profile after removal of depths, and the factor that makes them remove a given volume.

    The depths are those at the points of its curve. Without the factor the volume differs: a depth along the normal of
    a curved profile sweeps an area that also depends on the curvature, and smoothing moves wear to other radii.

    Raises
    ------
    InputError
        If the profile is too short for the wear.
    """
    for name, value in zip(("first", "last"), depth[[0, -1]], strict=True):
        if value > EDGE * depth.max():
            raise wl.InputError(
                f"{profile.kind}: the profile is too short for the wear, which reaches {value / depth.max():.2g} of its"
                f" deepest place at the {name} point; give a wider profile, or less smoothing"
            )

    curve = profile.curve
    points = np.stack([curve.y, curve.z])
    normal = curve.sign * np.stack([-np.sin(curve.angle), np.cos(curve.angle)])
    # The points alone tell the factor nearly, and the slope: what they enclose is of second order in it.
    once, twice = (enclosed(points, points + times * depth * normal, radius) for times in (1.0, 2.0))
    rate, bend = 2.0 * once - 0.5 * twice, 0.5 * twice - once
    slope = math.sqrt(rate**2 + 4.0 * bend * volume)
    factor = 2.0 * volume / (rate + slope)
    for _ in range(STEPS):
        new = removed(profile, factor * depth)
        lost = swept(profile, new, radius)
        if abs(lost - volume) <= ACCURACY * volume:
            return new, factor
        factor += (volume - lost) / slope
    return removed(profile, factor * depth), factor
