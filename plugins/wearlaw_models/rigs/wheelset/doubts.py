"""Warnings about profiles that are possible but unlikely."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

import numpy as np

from wearlaw import Array
from wearlaw_models.rigs.wheelset.curve import Curve, through_points
from wearlaw_models.rigs.wheelset.files import Kind
from wearlaw_models.rigs.wheelset.measures import SIDE_DEPTH, flange, side
from wearlaw_models.rigs.wheelset.points import FLANGE_BACK
from wearlaw_models.rigs.wheelset.reach import LOST, STEEPEST, reach

CROWN, WIDEST_HEAD = 12e-3, 92e-3
"""Depth below its top at which the width of a rail's head is taken, and the width beyond which it is doubted [m]."""

NARROW_HEAD, FLANGES = 50e-3, (20e-3, 40e-3)
"""Width of the narrowest heads of rails, and heights of flanges, from trams to freight wagons [m]."""

UNITS = {"cm": 10.0, "inch": 25.4}
"""Units that profiles may have been measured in, over millimetres."""

OUTWARDS = 1.0 / 80.0
"""Lean of a rail outwards from which it is doubted: half of the smallest cant in use, 1 in 40 [rad]."""

TILTED = np.radians(4.0)
"""Lean of a rail inwards from which it is doubted [rad]: a cant of 1 in 20 and 10 mm of side wear."""

FAR = 20e-3
"""Height of a wheel at its taping line that no wear explains [m]."""

MEASURES: Mapping[Kind, tuple[str, ...]] = {
    "wheel": ("the flange height", "the flange thickness", "the flange gradient"),
    "rail": (f"the gauge side {1e3 * SIDE_DEPTH:g} mm below the top",),
}
"""Names of the measures that are compared."""

MOVED = 0.1e-3
"""Change of a measure by smoothing that is worth a word [m]."""

PIECE = 2e-3
"""Length over which points are averaged [m]: on a top with a radius of 12 mm, its square over 24 radii is 0.014 mm."""

BACK = 1e-3
"""Difference between two places of the back of a flange that is worth a word [m]; profiles are aligned to less."""

RADIUS = 1e-3
"""Difference between the radius of a rig and that of its wheel that is worth a word [m]."""

UPRIGHT = np.radians(80.0)
"""Slope from which the inner side of a flange is its back [rad]."""

STRAIGHT, CROOKED = 6e-3, 0.03e-3
"""Length of a straight piece of the back of a flange, and the root mean square distance up to which points are straight
[m]. An arc has a radius of at least 45 mm then, while those of flanges have up to 25 mm."""

LEANING = np.radians(1.0)
"""Lean from which the back of a flange, a turned plane across the axle, is doubted [rad]."""

ROUNDED = 0.1
"""Slope at the end of a profile up to which the top of a flange is there [rad]. On a top with a radius of 20 mm, which
is more than in use, it is 0.1 mm from the end."""


def of_shape(kind: Kind, curve: Curve, lean: float) -> Iterator[str]:
    """Yield what is unlikely about the shape and place of a profile; the lean is that of a rail's head [rad]."""
    if kind == "rail":
        width = float(np.ptp(curve.y[curve.z < curve.z.min() + CROWN]))
        if width > WIDEST_HEAD:
            yield (
                f"the rail is {_mm(width)} wide {_mm(CROWN)} below its top, but heads of rails have 60 to"
                " 80 mm; is it the profile of a wheel?"
            )
        top = int(curve.z.argmin())
        inner, outer = (float(np.ptp(part)) for part in (curve.z[: top + 1], curve.z[top:]))
        if inner < SIDE_DEPTH <= outer:
            yield (
                f"the profile goes {_mm(inner)} down on its gauge side, y < 0, where the gauge is measured at"
                f" {_mm(SIDE_DEPTH)}, and {_mm(outer)} on the other one; if it is mirrored, change the sign of y, in a"
                " file by mirror_y=True"
            )
        if lean < -OUTWARDS:
            yield (
                f"the head of the rail leans outwards by {np.degrees(-lean):.3g} deg: its gauge side must be at y < 0;"
                " if it is mirrored, change the sign of y, in a file by mirror_y=True; if it was measured turned, turn"
                f' it, in a file by turn="{np.degrees(lean):.3g} deg"'
            )
        elif lean > TILTED:
            yield (
                f"the head of the rail leans inwards by {np.degrees(lean):.3g} deg, more than any cant in use; if"
                f' it was measured turned, turn it, in a file by turn="{np.degrees(lean):.3g} deg"'
            )
        depth, sides = curve.z - curve.z.min(), min(curve.z[0], curve.z[-1]) - curve.z.min()
        heads = {unit: scale * float(np.ptp(curve.y[scale * depth < CROWN])) for unit, scale in UNITS.items()}
        seen = [
            unit for unit, head in heads.items() if NARROW_HEAD < head < WIDEST_HEAD and UNITS[unit] * sides > CROWN
        ]
    else:
        yield from of_height(curve)
        yield from of_turn(curve)
        falls = float(curve.z[-1] - curve.z.min())
        if falls > CROWN:
            yield f"the field side of the wheel falls by {_mm(falls)}; is it the profile of a rail?"
        heights = {unit: flange(scale * curve.y, scale * curve.z, FLANGE_BACK)[0] for unit, scale in UNITS.items()}
        seen = [unit for unit, height in heights.items() if FLANGES[0] < height < FLANGES[1]]
    if seen and np.ptp(curve.y) < NARROW_HEAD:
        yield f'the {kind} is {_mm(float(np.ptp(curve.y)))} wide; is it in {seen[0]}? If so, give units="{seen[0]}"'


def of_height(curve: Curve) -> Iterator[str]:
    """Yield whether a wheel is far above or below its taping line."""
    if curve.y[0] < 0.0 < curve.y[-1] and abs(height := float(np.interp(0.0, curve.y, curve.z))) > FAR:
        yield (
            f"the wheel has z = {_mm(height)} at y = 0, its taping line, where its radius is the nominal one if z is"
            f' zero; shift it, in a file by shift_z="{-1e3 * height:.6g} mm"'
        )


def of_turn(curve: Curve) -> Iterator[str]:
    """Yield whether the back of a wheel's flange is not upright."""
    lean = np.degrees(_lean_of_back(curve))
    if abs(lean) > np.degrees(LEANING):
        yield (
            f"the back of the flange leans by {abs(lean):.2g} deg; if the wheel was measured turned, turn it back, in a"
            f' file by turn="{lean:.2g} deg"'
        )


def _lean_of_back(curve: Curve) -> float:
    """Return the lean of the straightest piece of the back of a flange [rad]; NaN if none is steep and straight."""
    s = curve.s[: int(np.argmax(np.where(curve.y < 0.0, curve.z, -np.inf))) + 1]
    straightest, lean = CROOKED, np.nan
    for start in np.arange(s[0], s[-1] - STRAIGHT, 0.2 * STRAIGHT):
        along = np.linspace(start, start + STRAIGHT, 31)
        y, z = (np.interp(along, curve.s, value) for value in (curve.y, curve.z))
        if np.ptp(z) > np.sin(UPRIGHT) * STRAIGHT:
            slope, place = np.polyfit(z, y, 1)
            crooked = float(np.sqrt(np.mean((y - place - slope * z) ** 2)))
            if crooked < straightest:
                straightest, lean = crooked, float(np.arctan(slope))
    return lean


def of_ends(curve: Curve, cant: float, point_near: Callable[[float, float], str]) -> Iterator[str]:
    """Yield where steep places cut off a part of a profile; the cant is that of a rail [rad]."""
    for place, lost in reach(curve, cant).ends:
        if lost > LOST:
            yield (
                f"beside {point_near(curve.y[place], curve.z[place])} the profile is steeper than"
                f" {np.degrees(STEEPEST):g} deg, and contact with what lies beyond, {_mm(lost, 3)} of its width, is"
                ' left out; mend the points there, or give smoothing, such as "0.02 mm"'
            )


def of_lean(lean: float, cant: float) -> Iterator[str]:
    """Yield whether the head of a rail leans already [rad]."""
    if abs(lean) > 0.5 * cant > 0.0:
        way = (
            "outwards, as a mirrored one" if lean < 0.0 else "inwards, as one that is canted or worn on its gauge side"
        )
        yield (
            f"rail_cant is {np.degrees(cant):.3g} deg, but the head of the profile leans by {np.degrees(abs(lean)):.3g}"
            f" deg {way}; if it is canted, leave rail_cant out"
        )


def of_radius(nominal: float, curve: Curve, diameter: float) -> Iterator[str]:
    """Yield whether a wheel with a nominal radius has another diameter than its own at its taping line [m]."""
    radius = nominal + float(np.interp(0.0, curve.y, curve.z))
    if abs(radius - 0.5 * diameter) > RADIUS:
        yield (
            f"nominal_radius {_mm(nominal)} gives a radius of {_mm(radius)} at the taping line, but the profile states"
            f" a diameter of {_mm(diameter)} there, a radius of {_mm(0.5 * diameter)}"
        )


def of_smoothing(kind: Kind, curve: Curve, y: Array, z: Array) -> Iterator[str]:
    """Yield which measures differ between a smoothed curve and its points [m].

    Those of the points are taken from the means over short pieces, since the highest point is the one with most noise.
    """
    way = slice(None, None, -1 if y[-1] < y[0] else 1)
    y, z = y[way], z[way]
    along = np.append(0.0, np.cumsum(np.hypot(np.diff(y), np.diff(z))))
    _, piece, count = np.unique(along // PIECE, return_inverse=True, return_counts=True)
    exact = through_points(np.bincount(piece, y) / count, np.bincount(piece, z) / count, 0.0, None, curve.sign)
    for name, of_points, smooth in zip(MEASURES[kind], _measures(exact), _measures(curve), strict=True):
        if abs(smooth - of_points) > MOVED:
            yield (
                f"smoothing moves {name} from {_mm(of_points, 4)} to {_mm(smooth, 4)}; give the standard deviation of"
                " the noise of the points"
            )


def _measures(curve: Curve) -> tuple[float, ...]:
    """Return the measures that smoothing must not move [m]."""
    if curve.sign < 0.0:
        return flange(curve.y, curve.z, FLANGE_BACK)
    return (side(curve.y, curve.z, SIDE_DEPTH),)


def of_back(curve: Curve, position: float) -> Iterator[str]:
    """Yield whether the back of a wheel's flange is elsewhere than where it should be [m]."""
    inner = slice(0, int(np.argmax(np.where(curve.y < 0.0, curve.z, -np.inf))) + 1)
    place = float(curve.y[inner].min())
    whole = np.abs(curve.angle[inner]).max() > UPRIGHT
    if (place < position - BACK) or (whole and place > position + BACK):
        yield (
            f"flange_back_position is {_mm(position)}, but the profile has the back of its flange at y = {_mm(place)};"
            " is the origin of the profile at its taping line?"
        )


def of_tip(y: Array, z: Array, angle: Array, height: float) -> Iterator[str]:
    """Yield whether a wheel's profile ends before the top of its flange; `height` is that of its end [m]."""
    if int(np.argmax(z)) == 0 and abs(angle[0]) > ROUNDED and np.isfinite(height):
        yield (
            f"the profile ends at y = {_mm(float(y[0]), 4)} on the flank of its flange, {_mm(height, 4)} above the"
            f" tread, where its slope is {np.degrees(abs(angle[0])):.3g} deg, not at the top of the flange: height and"
            " gradient of the flange are not known"
        )


def _mm(value: float, digits: int = 6) -> str:
    return f"{1e3 * value:.{digits}g} mm"
