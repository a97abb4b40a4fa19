"""Where wheels touch their rails: the contact search for rigid bodies.

A wheel is a body of revolution, and a rail a prism along x. Where they touch, their common normal has no component
along x. On each circle of the wheel, one point at the bottom has such a normal. Together these points are the locus of
possible contact, and the wheel touches the rail where the vertical gap from the locus to the rail is least. The
coordinates in this module are *outward* ones: y runs from the middle of the track to the field side of either wheel and
z runs down. The right wheel has the track's axes, and the left one is its mirror image.

Let ρ be the roll that lowers this side, ψ the yaw that turns x towards y, R(y) the profile's radius and R' its slope.
The outward normal of the wheel at the angle α from the bottom is (sin α, -R', cos α). After roll and yaw its component
along x vanishes if

    sin(α + β) = -tan ψ cos ρ R' / √(1 + tan²ψ sin²ρ),  tan β = tan ψ sin ρ.

The rails bear both wheels if the least gaps of both sides are equal; that gives the roll.

Source: the locus of possible contact after A. D. de Pater, Vehicle System Dynamics 17 (1988) 127-140, derived here for
the axes above.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
import scipy
from numpy.typing import NDArray

import wearlaw as wl
from wearlaw import Array
from wearlaw_models.rigs.wheelset.curve import Curve
from wearlaw_models.rigs.wheelset.reach import reach
from wearlaw_models.rigs.wheelset.search_loops import (
    PATCHES,
    ROLL_ACCURACY,
    ROLLS,
    ROOTS,
    ROUNDING,
    compiled_search,
    cubic,
    locus,
    roll_step,
)

COARSE = 0.5e-3
"""Spacing of the points on the wheel among which least gaps are looked for [m]; the roots between them are exact."""

FINE = 0.05e-3
"""Spacing of the tables of profiles [m]."""

ACCURATE = {"xatol": 1e-9}
"""Accuracy of the place of a rail's top along its profile [m]; that of its height is quadratic in it."""

BESIDE = 1e3
"""A place beside any rail [m]."""

STRAIGHT = np.radians(0.5)
"""Difference in the angle of a flank that is straight, given by points [rad]; arcs beside it make splines overshoot."""

LEVELS = 4
"""Steps of the roll by which the least gaps below coarse points become about equal."""

ON_EDGE = 1e-6
"""Difference between slopes at a contact point that only the end of a profile can have."""

BLOCK = 256
"""Positions that NumPy searches at once: their arrays stay in the cache."""

LOOPS = 1000
"""Formulas of a position in one search, to judge whether compiled loops are worth while."""


class Table(NamedTuple):
    """A function at even abscissae, with the cubics between them that have its values and slopes.

    Attributes
    ----------
    start, step : float
        The first abscissa and the spacing [m].
    cubics : ndarray, (4, abscissae - 1)
        Coefficients of the share of a step, of growing power.
    value : ndarray
        The function.
    """

    start: float
    step: float
    cubics: Array
    value: Array

    @classmethod
    def of(cls, start: float, step: float, value: Array, slope: Array) -> Table:
        """Return the table of a function with these values and derivatives."""
        rise, first, second = np.diff(value), step * slope[:-1], step * slope[1:]
        cubics = np.stack([value[:-1], first, 3.0 * rise - 2.0 * first - second, first + second - 2.0 * rise])
        return cls(start, step, cubics, value)

    @property
    def end(self) -> float:
        """The last abscissa [m]."""
        return self.start + self.step * (self.value.size - 1)

    def at(self, x: Array) -> tuple[Array, Array]:
        """Return the value and the slope at x; beyond the abscissae, of the outermost cubic."""
        share = (x - self.start) / self.step
        index = np.minimum(np.maximum(share.astype(np.intp), 0), self.value.size - 2)
        return cubic(share - index, self.step, self.cubics.take(index, axis=1))

    def near(self, x: Array) -> tuple[Array, Array]:
        """Return the value and the slope at x; the value is infinite beyond the abscissae."""
        share = (x - self.start) / self.step
        inside = (share >= 0.0) & (share < self.value.size - 1)
        value, slope = self.at(np.where(inside, x, self.start))
        return np.where(inside, value, np.inf), slope

    def inverse(self, value: Array) -> Array:
        """Return abscissae at which a growing function has values, by lines; infinite ones beyond its ends."""
        places = self.start + self.step * np.arange(self.value.size)
        return np.asarray(np.interp(value, self.value, places, -np.inf, np.inf))


class Coarse(NamedTuple):
    """Points on a wheel at even arc lengths: distance from the middle of the wheelset, radius and its slope dR/dy.

    The first and the last point stand for the ends of the profile. They are far beside the rail, so that an end that is
    nearest to the rail counts as a least gap.
    """

    arc: Array
    y: Array
    radius: Array
    slope: Array


@dataclass(frozen=True, eq=False)
class Section:
    """One wheel above its rail, in outward coordinates, as tables in SI.

    Attributes
    ----------
    wheel_y, wheel_radius : Table
        Distance of the wheel's surface from the middle of the wheelset, and its radius, over the arc length of the
        profile, from the top of the flange to the field side.
    rail_z, rail_position : Table
        Height of the rail, positive downwards, and the arc length of its profile, over y.
    wheel, rail : Curve
        The profiles.
    roller : float
        Curvature about its axis of the roller in place of the rail, at its top [1/m]; 0 for a rail.
    axes : float
        1 over the distance between this axis and the axle where the taping line is on the roller's top [1/m].
    left : Section or None
        The left wheel above its rail if their profiles differ; the others are then those of the right side.
    """

    wheel_y: Table
    wheel_radius: Table
    rail_z: Table
    rail_position: Table
    wheel: Curve
    rail: Curve
    roller: float
    axes: float
    left: Section | None = None

    @cached_property
    def sides(self) -> tuple[Section, Section]:
        """The left and the right wheel above their rails, each as a section alone."""
        return (self, self) if self.left is None else (self.left, replace(self, left=None))

    def at(self, name: str, x: Array, side: NDArray[np.intp]) -> tuple[Array, ...]:
        """Return values of a table, or of a profile within its ends, at places x on sides; the arrays broadcast."""
        if self.left is None:
            return _at(getattr(self, name), x)
        x, side = np.broadcast_arrays(x, side)
        of_left, of_right = (_at(getattr(half, name), x) for half in self.sides)
        return tuple(np.where(side == 0, left, right) for left, right in zip(of_left, of_right, strict=True))

    def on_rails(self, arc: Array, side: NDArray[np.intp]) -> tuple[Array, Array, Array]:
        """Return y, z [m] and the slope's angle [rad] of rails at arc lengths of their profiles [m], on sides.

        Beyond the ends of a rail z is infinite.
        """
        y = np.empty(np.broadcast_shapes(arc.shape, side.shape))
        for number, section in enumerate(self.sides):
            y = np.where(side == number, section.rail_position.inverse(arc), y)
        beyond = np.isinf(y)
        y = np.where(beyond, 0.0, y)
        for _ in range(2):
            value, slope = self.at("rail_position", y, side)
            y = np.where(beyond, 0.0, y - (value - arc) / slope)
        z, slope = self.at("rail_z", y, side)
        return y, np.where(beyond, np.inf, z), np.arctan(slope)

    @property
    def tables(self) -> tuple[tuple[float, float, Array], ...]:
        """The tables of y, radius and the rail, for compiled loops."""
        return self.wheel_y[:3], self.wheel_radius[:3], self.rail_z[:3]

    @property
    def steepest(self) -> float:
        """Arc length of the steepest place of the flange; where it is straight, of its end towards the top [m]."""
        flange = (self.wheel.s >= self.wheel_y.start) & (self.wheel.y < 0.0)
        if not flange.any():
            return -np.inf
        angle = self.wheel.angle[flange]
        return float(self.wheel.s[flange][angle <= angle.min() + STRAIGHT][0])

    @property
    def spacing(self) -> float:
        """Distance between the coarse points [m]."""
        length = self.wheel_y.end - self.wheel_y.start
        return length / round(length / COARSE)

    @cached_property
    def coarse(self) -> Coarse:
        """The points on the wheel among which least gaps are looked for."""
        arc = np.arange(self.wheel_y.start, self.wheel_y.end + 0.5 * self.spacing, self.spacing)
        (y, dy), (radius, d_radius) = self.wheel_y.at(arc), self.wheel_radius.at(arc)
        points = (np.pad(array, 1, mode="edge") for array in (arc, y, radius, d_radius / dy))
        coarse = Coarse(*points)
        coarse.y[[0, -1]] = BESIDE
        return coarse

    def below_points(self, position: Position) -> Gaps:
        """Return the gaps below the coarse points of the wheel of this section alone; the arrays broadcast."""
        points = self.coarse
        return _gaps(position, points.y, points.radius, points.slope, self.axes, self.rail_z.near)


def _at(of: Table | Curve, x: Array) -> tuple[Array, ...]:
    return of.at(x) if isinstance(of, Table) else of.at(np.minimum(np.maximum(x, of.s[0]), of.s[-1]))


def section(
    wheel: Curve, rail: Curve, *, nominal_radius: float, wheel_offset: float, cant: float, gauge: float, depth: float,
    roller_radius: float,
) -> Section:  # fmt: skip
    """Return one wheel above its rail.

    Parameters
    ----------
    wheel, rail : Curve
        Their profiles.
    nominal_radius : float
        Radius of the wheel where z of its profile is zero [m].
    wheel_offset : float
        Distance of the wheel profile's origin from the middle of the wheelset [m].
    cant : float
        Angle by which the rail leans inwards [rad].
    gauge, depth : float
        Distance between the rails, and the depth below their highest points at which it is measured [m].
    roller_radius : float
        Radius of rollers in place of the rails, at their tops [m]; infinite for rails.

    Raises
    ------
    InputError
        If the rail does not reach down to that depth on its gauge side, or if a profile is too steep at its top.
    """
    kept = _reached("wheel", wheel)
    step = (wheel.s[-1] - wheel.s[0]) / (wheel.s.size - 1)
    cos, sin = np.cos(wheel.angle[kept]), np.sin(wheel.angle[kept])
    across = Table.of(float(wheel.s[kept.start]), step, wheel.y[kept] + wheel_offset, cos)
    radius = Table.of(float(wheel.s[kept.start]), step, wheel.z[kept] + nominal_radius, sin)

    def leaned(s: Any) -> tuple[Any, Any]:
        y, z, _, _ = rail.at(s)
        return y * np.cos(cant) + z * np.sin(cant), z * np.cos(cant) - y * np.sin(cant)

    y, z = leaned(rail.s)
    angle = rail.angle - cant
    top = int(z.argmin())
    around = rail.s[max(top - 1, 0)], rail.s[min(top + 1, z.size - 1)]
    crown = scipy.optimize.minimize_scalar(lambda s: leaned(s)[1], bounds=around, method="bounded", options=ACCURATE)
    z = z - crown.fun
    if not z[: top + 1].max() > depth:
        raise wl.InputError(
            f"gauge_depth: {1e3 * depth:.4g} mm is below the gauge side of the rail, which ends"
            f" {1e3 * z[: top + 1].max():.4g} mm below the rail's top; give a smaller one, as for a narrow roller, or a"
            " profile that reaches further down"
        )
    below = top - np.flatnonzero(z[top::-1] > depth)[0]
    at_depth = scipy.optimize.brentq(
        lambda s: leaned(s)[1] - crown.fun - depth, rail.s[below], rail.s[below + 1], xtol=1e-15
    )
    y = y + (0.5 * gauge - leaned(at_depth)[0])
    kept = _reached("rail", rail, cant)
    count = int((y[kept.stop - 1] - y[kept.start]) / FINE)
    at = y[kept.start] + FINE * np.arange(count + 1)
    height = scipy.interpolate.CubicHermiteSpline(y[kept], z[kept], np.tan(angle[kept]))
    place = scipy.interpolate.CubicHermiteSpline(y[kept], rail.s[kept], 1.0 / np.cos(angle[kept]))
    rail_z, position = (Table.of(at[0], FINE, of(at), of(at, 1)) for of in (height, place))
    axes = 1.0 / (nominal_radius + roller_radius)
    return Section(across, radius, rail_z, position, wheel, rail, 1.0 / roller_radius, axes)


def _reached(kind: str, curve: Curve, cant: float = 0.0) -> slice:
    """Return the part of a profile that a contact can reach, or raise an error if it is too short for a table."""
    part = reach(curve, cant).part
    if part.stop - part.start < 2 or curve.y[part.stop - 1] - curve.y[part.start] < 2.0 * FINE:
        place = min(part.start, curve.s.size - 1)
        top = "top of the flange" if kind == "wheel" else "top"
        raise wl.InputError(
            f"{kind}: the profile is too steep for contact at its {top}, y = {1e3 * curve.y[place]:.6g} mm,"
            f" z = {1e3 * curve.z[place]:.6g} mm; mend its points there"
        )
    return part


class Position(NamedTuple):
    """Position of wheels relative to their rails in outward coordinates, as arrays of one shape.

    Attributes
    ----------
    displacement : ndarray
        Lateral displacement of the wheelset [m], positive towards this side's field.
    roll : ndarray
        Roll [rad], positive if it lowers this side.
    yaw : ndarray
        Yaw [rad], positive if it turns the rolling direction towards y.
    side : ndarray of int
        0 on the left, 1 on the right.
    """

    displacement: Array
    roll: Array
    yaw: Array
    side: Any

    def widened(self) -> Position:
        """Return the position with one more axis."""
        return Position(*(array[..., None] for array in self))


class Gaps(NamedTuple):
    """The gap from points on a wheel's locus of contact to its rail.

    Attributes
    ----------
    gap : ndarray
        Vertical gap to the rail plus a constant [m]; infinite beside the rail.
    rise : ndarray
        Slope of the rail minus that of the locus, zero where the gap is least [-].
    x, y, z : ndarray
        Place on the locus [m].
    rail_slope : ndarray
        Slope of the rail below it, dz/dy [-].
    radius : ndarray
        Radius of the wheel there [m].
    """

    gap: Array
    rise: Array
    x: Array
    y: Array
    z: Array
    rail_slope: Array
    radius: Array

    @property
    def lean(self) -> Array:
        """Fall of the gap with the roll that lowers this side [m]."""
        return self.y + self.rail_slope * self.z


def gaps(section: Section, position: Position, arc: Array) -> Gaps:
    """Return the gaps below points of the wheel at arc lengths [m]; the arrays broadcast."""
    side = position.side
    y, dy = section.at("wheel_y", arc, side)
    radius, d_radius = section.at("wheel_radius", arc, side)
    return _gaps(position, y, radius, d_radius / dy, section.axes, lambda across: section.at("rail_z", across, side))


def _gaps(
    position: Position,
    y: Array,
    radius: Array,
    slope: Array,
    axes: float,
    rail_at: Callable[[Array], tuple[Array, ...]],
) -> Gaps:
    displacement, roll, yaw, _ = position
    turn = np.sin(roll), np.cos(roll), np.sin(yaw), np.cos(yaw)
    place_x, place_y, down, steep = locus(y, radius, slope, displacement, turn, axes)
    rail, rail_slope = rail_at(place_y)
    return Gaps(rail - down, rail_slope - steep, place_x, place_y, down, rail_slope, radius)


class Touching(NamedTuple):
    """Contact points of wheels, arrays of shape (positions, sides, patches); patches are ordered by their gap.

    Attributes
    ----------
    arc : ndarray
        Arc length of the wheel's profile at the contact point [m]; NaN where there is none.
    gap : ndarray
        Vertical gap there when the first point touches [m]; zero for the first one.
    least : ndarray, (positions, sides)
        Gap of the first point plus a constant: minus the height of the wheelset's centre above the rail [m].
    """

    arc: Array
    gap: Array
    least: Array


def touching(section: Section, position: Position) -> Touching:
    """Return the places where the gaps of wheels are least; positions are of shape (positions, sides)."""
    if section.left is not None:
        single = []
        for side, half in enumerate(section.sides):
            here = Position(*(array[:, [side]] for array in position))
            single.append(touching(half, here))
        return Touching(*(np.concatenate(pair, axis=1) for pair in zip(*single, strict=True)))
    around = section.below_points(position.widened())
    gap, rise = around.gap, around.rise
    falls = (rise < 0.0) | np.isinf(gap)
    low = falls[..., :-1] & ~falls[..., 1:]
    low |= (rise[..., :-1] < 0.0) & np.isinf(gap[..., 1:]) & np.isfinite(gap[..., :-1])  # on an end of a profile
    index = _smallest(np.where(low, np.minimum(gap[..., :-1], gap[..., 1:]), np.inf))
    valid = np.take_along_axis(low, index, axis=-1)
    arc = np.full(valid.shape, np.nan)
    height = np.full(valid.shape, np.inf)
    place = np.nonzero(valid)
    arcs = np.broadcast_to(section.coarse.arc, gap.shape)
    left, right = ((*place[:-1], index[place] + step) for step in (0, 1))
    there = Position(*(array[place[:-1]] for array in position))
    begin, end = (
        np.where(np.isinf(gap[side]), arcs[other], arcs[side]) for side, other in ((left, right), (right, left))
    )
    arc[place] = _root(section, there, begin, end)
    height[place] = gaps(section, there, arc[place]).gap
    order = np.argsort(height, axis=-1)
    arc, height = (np.take_along_axis(values, order, axis=-1) for values in (arc, height))
    least = height[..., 0]
    none = np.isnan(arc)
    above = np.where(none, np.nan, height) - np.where(none[..., 0], np.nan, least)[..., None]
    return Touching(arc, above, least)


def _smallest(values: Array) -> NDArray[np.intp]:
    """Return the indices of the smallest values along the last axis, `PATCHES` of them."""
    values = values.copy()
    indices = []
    for _ in range(PATCHES):
        index = values.argmin(axis=-1)[..., None]
        np.put_along_axis(values, index, np.inf, axis=-1)
        indices.append(index)
    return np.concatenate(indices, axis=-1)


def _root(section: Section, position: Position, left: Array, right: Array) -> Array:
    """Return the arc lengths between `left` and `right` where the gap is least, by the Illinois method."""
    at_left, at_right = (gaps(section, position, arc).rise for arc in (left, right))
    for _ in range(ROOTS):
        span = at_right - at_left
        share = np.divide(at_right, span, out=np.zeros_like(span), where=span != 0.0)
        root = right - share * (right - left)
        value = gaps(section, position, root).rise
        going = np.abs(at_right) >= ROUNDING  # a place that is found stays, whatever others do
        same = value * at_right > 0.0
        moved = np.where(same, left, right), np.where(same, 0.5 * at_left, at_right), root, value
        left, at_left, right, at_right = (
            np.where(going, new, old) for new, old in zip(moved, (left, at_left, right, at_right), strict=True)
        )
        if not going.any():
            break
    return right


def searched(section: Section, displacement: Array, yaw: Array, roll: Array | None = None) -> tuple[Array, Touching]:
    """Return the roll at which both wheels touch [rad], positive if it lowers the right one, and where they touch.

    Parameters
    ----------
    section : Section
    displacement : ndarray, (positions,)
        Lateral displacement of the wheelset [m], positive to the right.
    yaw : ndarray, (positions,)
        Yaw [rad], positive if the right wheel moves backwards.
    roll : ndarray, (positions,), optional
        The roll, if it is given; each wheel then touches at a height of its own.

    Notes
    -----
    Where a wheel stands on the end of a profile, its own or the rail's, there is no contact point.
    """
    if wl.accelerated(LOOPS * displacement.size):
        rolls, places = _compiled(section, displacement, yaw, roll)
    else:
        rolls = np.empty(displacement.shape)
        parts = []
        for start in range(0, displacement.size, BLOCK):
            some = slice(start, start + BLOCK)
            rolls[some], part = _searched(section, displacement[some], yaw[some], None if roll is None else roll[some])
            parts.append(part)
        places = Touching(*(np.concatenate(arrays) for arrays in zip(*parts, strict=True)))
    position = both_sides(displacement, rolls, yaw).widened()
    arc = np.where(np.isnan(places.arc), _starts(section), places.arc)
    edge = np.abs(gaps(section, position, arc).rise) > ON_EDGE
    return rolls, places._replace(arc=np.where(edge, np.nan, places.arc))


def _compiled(section: Section, displacement: Array, yaw: Array, roll: Array | None) -> tuple[Array, Touching]:
    shape = (displacement.size, 2, PATCHES)
    roll_found = np.zeros(displacement.size) if roll is None else roll.copy()
    arc, above = np.empty(shape), np.empty(shape)
    least = np.empty(shape[:2])
    compiled_search(
        np.ascontiguousarray(displacement), np.ascontiguousarray(yaw), roll is not None,
        tuple(tuple(half.coarse) for half in section.sides), tuple(half.tables for half in section.sides), section.axes,
        roll_found, arc, above, least,
    )  # fmt: skip
    return roll_found, Touching(arc, above, least)


def _searched(section: Section, displacement: Array, yaw: Array, fixed: Array | None) -> tuple[Array, Touching]:
    if fixed is not None:
        return fixed, touching(section, both_sides(displacement, fixed, yaw))
    roll, open_ = _leveled(section, displacement, yaw), np.arange(displacement.size)
    places = touching(section, both_sides(displacement, roll, yaw))
    for _ in range(ROLLS):
        open_ = open_[~np.isnan(places.arc[open_, :, 0]).any(axis=-1)]  # a wheel may be beside its rail
        at = gaps(section, both_sides(displacement[open_], roll[open_], yaw[open_]), places.arc[open_, :, 0])
        step = roll_step(places.least[open_, 1] - places.least[open_, 0], at.lean.sum(axis=-1))
        tilted = np.abs(step) > ROLL_ACCURACY
        open_ = open_[tilted]
        if not open_.size:
            break
        roll[open_] += step[tilted]
        position = both_sides(displacement[open_], roll[open_], yaw[open_])
        for old, new in zip(places, touching(section, position), strict=True):
            old[open_] = new
    return roll, places


def _leveled(section: Section, displacement: Array, yaw: Array) -> Array:
    """Return rolls at which the least gaps below the coarse points are about equal [rad]; gaps are linear in rolls."""
    roll = np.zeros_like(displacement)
    around = [
        half.below_points(Position(*(array[:, side, None] for array in both_sides(displacement, roll, yaw))))
        for side, half in enumerate(section.sides)
    ]
    for _ in range(LEVELS):
        below = [at.gap - way * at.lean * roll[:, None] for at, way in zip(around, (-1.0, 1.0), strict=True)]
        lowest = [gap.argmin(axis=-1)[:, None] for gap in below]
        left, right = (np.take_along_axis(gap, at, axis=-1)[:, 0] for gap, at in zip(below, lowest, strict=True))
        levers = (np.take_along_axis(at.lean, k, axis=-1)[:, 0] for at, k in zip(around, lowest, strict=True))
        with np.errstate(invalid="ignore"):  # both wheels may be beside their rails
            roll += np.where(np.isfinite(right - left), roll_step(right - left, sum(levers)), 0.0)
    return roll


def both_sides(displacement: Array, roll: Array, yaw: Array) -> Position:
    """Return the positions of the left and the right wheel in outward coordinates, with an axis of sides."""
    across, lowered, turned = (np.stack([-array, array], axis=-1) for array in (displacement, roll, yaw))
    return Position(across, lowered, turned, np.broadcast_to(np.arange(2), across.shape))


def _starts(section: Section) -> Array:
    """Return the arc length of the first point of each side's wheel, of shape (sides, 1) [m]."""
    return np.array([[half.wheel_y.start] for half in section.sides])
