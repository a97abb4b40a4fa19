"""Plane curves by arc length: from pieces with a formula, or through measured points."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

import wearlaw as wl
from wearlaw import Array

SPACING = 5e-5
"""Largest spacing of the table of a curve [m]."""

ROUNDING = 1e-12
"""Arc length that a position may lie beyond the ends of a curve, by rounding [m]."""

_GAUSS, _WEIGHTS = np.polynomial.legendre.leggauss(8)
_NEWTON, _CLOSE = 6, 1e-9
"""Most steps of Newton's method to find a parameter from its arc length, and the error that the last one may mend [m]:
its square is below rounding."""
_HALVINGS = 200
"""Most steps to find the weight of a smoothing spline: bisections of its logarithm."""

Local = tuple[Array, Array, Array, Array]
"""y [m], z [m], the angle of the tangent [rad] and its rate dθ/ds [1/m]."""


@dataclass(frozen=True)
class Curve:
    """A profile by its arc length, as a table of equal steps of at most 0.05 mm.

    The angle is that of the tangent in the direction of growing s, positive where the profile falls (z is positive
    down). The curvature is positive where the body is convex.

    Attributes
    ----------
    s : ndarray of float64, shape (n,)
        Arc length [m] from the first point, at the smaller y, to the last one; zero at y = 0, or at the end nearest to
        y = 0 if the profile does not reach it.
    y, z : ndarray of float64, shape (n,)
        Position, outwards and down [m].
    angle : ndarray of float64, shape (n,)
        Angle of the tangent, θ = atan2(dz, dy) [rad].
    curvature : ndarray of float64, shape (n,)
        Curvature, κ [1/m].
    sign : float
        Sign of dθ/ds where the body is convex: 1 for a rail and -1 for a wheel.
    joints : ndarray of float64, shape (m,)
        Arc lengths at which the curvature of a formula jumps [m]; empty for a profile from points.
    """

    s: Array
    y: Array
    z: Array
    angle: Array
    curvature: Array
    sign: float
    joints: Array = field(default_factory=lambda: np.empty(0))

    def __post_init__(self) -> None:
        for array in (self.s, self.y, self.z, self.angle, self.curvature, self.joints):
            array.setflags(write=False)
        step = (self.s[-1] - self.s[0]) / (self.s.size - 1)
        cells = np.minimum(((self.joints - self.s[0]) / step).astype(np.intp), self.s.size - 2)
        joint = np.full(self.s.size - 1, np.nan)
        joint[cells] = (self.joints - self.s[cells]) / step
        tangent = np.cos(self.angle), np.sin(self.angle)
        for name, value in {"_step": step, "_joint": joint, "_tangent": tangent}.items():
            object.__setattr__(self, name, value)

    _step: float = field(init=False, repr=False, compare=False)
    _joint: Array = field(init=False, repr=False, compare=False)
    """Place of the joint in each cell of the table, from 0 to 1, NaN for none."""
    _tangent: tuple[Array, Array] = field(init=False, repr=False, compare=False)

    def at(self, s: ArrayLike) -> Local:
        """Return y [m], z [m], angle [rad] and curvature [1/m] at arc lengths [m] of any shape.

        Positions have a continuous tangent: a cubic Hermite interpolation of the table, and arcs in a cell with a
        joint. They are within 1e-9 m of the profile, but for the steps of 1.2e-7 and 3.7e-8 m that the printed formulas
        of S1002 leave at y = -35 and -26 mm. The angle is interpolated in the same way, and the curvature linearly.

        Raises
        ------
        InputError
            If a position is beyond the ends of the profile.
        """
        place = np.asarray(s, dtype=np.float64)
        if not ((place >= self.s[0] - ROUNDING) & (place <= self.s[-1] + ROUNDING)).all():
            raise wl.InputError(
                f"s must lie on the profile, from {1e3 * self.s[0]:.6g} to {1e3 * self.s[-1]:.6g} mm; got"
                f" {1e3 * np.nanmin(place):.6g} to {1e3 * np.nanmax(place):.6g} mm"
            )
        step = self._step
        along = np.clip((place - self.s[0]) / step, 0.0, self.s.size - 1.0)
        cell = np.minimum(along.astype(np.intp), self.s.size - 2)
        t = along - cell
        slopes = (*self._tangent, self.sign * self.curvature)
        y, z, angle = (
            _hermite(t, value[cell], value[cell + 1], step * slope[cell], step * slope[cell + 1])
            for value, slope in zip((self.y, self.z, self.angle), slopes, strict=True)
        )
        curvature = self.curvature[cell] + t * (self.curvature[cell + 1] - self.curvature[cell])
        broken = ~np.isnan(self._joint[cell])
        if broken.any():
            rows = np.stack([y, z, angle, curvature])
            rows[:, broken] = self._around_joint(cell[broken], t[broken])
            y, z, angle, curvature = rows
        return y, z, angle, curvature

    def moved(self, move: Callable[[Array, Array], tuple[Array, Array]], side: float, turn: float) -> Curve:
        """Return the curve with its points moved, mirrored if `side` is negative and turned by an angle [rad]."""
        y, z = move(self.y, self.z)
        s, angle, curvature, joints = self.s, side * self.angle + turn, self.curvature, self.joints
        if side < 0.0:
            s, joints = -s[::-1], -joints[::-1]
            y, z, angle, curvature = (value[::-1].copy() for value in (y, z, angle, curvature))
        zero = _zero(s, y, np.cos(angle))
        return Curve(s - zero, y, z, angle, curvature, self.sign, joints - zero)

    def _around_joint(self, cell: NDArray[np.intp], t: Array) -> Array:
        """Return the values in cells with a joint, on the arcs at both ends of the cell.

        Printed formulas have rounded numbers. A step or a kink between the arcs is therefore spread over the cell.
        """
        joint = self._joint[cell]

        def arc(node: NDArray[np.intp], way: Array) -> Array:
            y, z, angle, curvature = (value[node] for value in (self.y, self.z, self.angle, self.curvature))
            return np.stack([*_along_arc(y, z, angle, self.sign * curvature, way)[:3], curvature])

        before = t < joint
        step = self._step
        here = np.where(before, arc(cell, step * t), arc(cell + 1, step * (t - 1.0)))
        left, right = arc(cell, step * joint), arc(cell + 1, step * (joint - 1.0))
        apart = right - left
        bend = step * np.stack([np.cos(right[2]) - np.cos(left[2]), np.sin(right[2]) - np.sin(left[2])])
        bend = np.concatenate([bend, np.zeros_like(bend)])
        apart[3] = 0.0
        gap = apart + bend * (t - joint)
        result: Array = here + _hermite(t, 0.0, apart + bend * (1.0 - joint), 0.0, bend) - np.where(before, 0.0, gap)
        return result


def _along_arc(y: Array, z: Array, angle: Array, rate: Array, way: Array) -> Local:
    """Return y, z, θ and dθ/ds at a distance along arcs, or along straight lines where the rate is zero."""
    turned = 0.5 * rate * way
    chord = way * np.sinc(turned / np.pi)
    return y + chord * np.cos(angle + turned), z + chord * np.sin(angle + turned), angle + 2.0 * turned, rate


def _hermite(t: Array, low: Array | float, high: Array, low_slope: Array | float, high_slope: Array) -> Array:
    """Return the cubic at t from 0 to 1 with these values and slopes at both ends."""
    rise = high - low
    rest = 1.0 - t
    value: Array = low + t * (rise + rest * (rest * (low_slope - rise) - t * (high_slope - rise)))
    return value


@dataclass(frozen=True)
class Arc:
    """A circular arc, or a straight line if its rate is zero, from its first point [m], in SI units."""

    y: float
    z: float
    angle: float
    """Angle of the tangent at its first point [rad]."""
    rate: float
    """dθ/ds [1/m]."""
    length: float

    @classmethod
    def about(cls, centre: tuple[float, float], rate: float, begin: float, end: float) -> Arc:
        """Return the arc of a signed curvature dθ/ds about a centre, between two values of y."""
        first, last = np.arcsin(np.clip(rate * (np.array([begin, end]) - centre[0]), -1.0, 1.0))
        return cls(begin, centre[1] - np.cos(first) / rate, first, rate, (last - first) / rate)

    def at(self, s: Array) -> Local:
        """Return position, angle and its rate at arc lengths from its begin [m]."""
        rate = np.full_like(s, self.rate)
        return _along_arc(np.full_like(s, self.y), np.full_like(s, self.z), np.full_like(s, self.angle), rate, s)


class Parametric:
    """A curve with a parameter u, by its arc length."""

    def __init__(self, derivative: Callable[[Array, int], tuple[Array, Array]], knots: Array) -> None:
        """Take a function of u and the order of a derivative, and the knots between which it is smooth."""
        self._derivative, self._knots = derivative, knots
        self._lengths = np.append(0.0, np.cumsum(self._between(knots[:-1], knots[1:])))

    @property
    def length(self) -> float:
        """Its arc length [m]."""
        return float(self._lengths[-1])

    def _between(self, low: Array, high: Array) -> Array:
        """Return the arc lengths between pairs of parameters that have no knot between them, by Gauss's quadrature."""
        half = 0.5 * (high - low)
        speed = np.hypot(*self._derivative((0.5 * (low + high))[:, None] + half[:, None] * _GAUSS, 1))
        length: Array = half * (speed @ _WEIGHTS)
        return length

    def parameter(self, s: Array) -> Array:
        """Return the parameters at arc lengths from its begin [m]."""
        knots, lengths = self._knots, self._lengths
        cell = np.clip(np.searchsorted(lengths, s, side="right") - 1, 0, knots.size - 2)
        low, high = knots[cell], knots[cell + 1]
        u: Array = low + (s - lengths[cell]) / (lengths[cell + 1] - lengths[cell]) * (high - low)
        for _ in range(_NEWTON):
            excess = lengths[cell] + self._between(low, u) - s
            u = np.clip(u - excess / np.hypot(*self._derivative(u, 1)), low, high)
            if np.abs(excess).max() < _CLOSE:
                break
        return u

    def at(self, s: Array) -> Local:
        """Return position, angle and its rate at arc lengths from its begin [m]."""
        u = self.parameter(s)
        (y, z), (dy, dz), (ddy, ddz) = (self._derivative(u, order) for order in (0, 1, 2))
        return y, z, np.unwrap(np.arctan2(dz, dy)), (dy * ddz - dz * ddy) / (dy**2 + dz**2) ** 1.5


Piece = Arc | Parametric
"""A smooth piece of a curve by its own arc length."""


def joined(pieces: Sequence[Piece], sign: float) -> Curve:
    """Return the curve of pieces that follow each other; `sign` is that of dθ/ds where the body is convex."""
    ends = np.append(0.0, np.cumsum([piece.length for piece in pieces]))
    count = int(np.ceil(ends[-1] / SPACING))
    s = np.linspace(0.0, ends[-1], count + 1)
    which = np.clip(np.searchsorted(ends, s, side="right") - 1, 0, len(pieces) - 1)
    parts = [piece.at(s[which == number] - ends[number]) for number, piece in enumerate(pieces)]
    y, z, angle, rate = (np.concatenate(values) for values in zip(*parts, strict=True))
    joints = ends[1:-1]
    zero = _zero(s, y, np.cos(angle))
    return Curve(s - zero, y, z, angle, sign * rate, sign, joints - zero)


def _zero(s: Array, y: Array, slope: Array) -> float:
    """Return the arc length at y = 0, or that of the end nearest to it."""
    crossed = np.flatnonzero((y[:-1] <= 0.0) & (y[1:] > 0.0))
    if not crossed.size:
        return float(s[0] if abs(y[0]) <= abs(y[-1]) else s[-1])
    cell = slice(crossed[0], crossed[0] + 2)
    ends = tuple((1, 1.0 / value) for value in slope[cell])
    return float(scipy.interpolate.CubicSpline(y[cell], s[cell], bc_type=ends)(0.0))


def through_points(y: Array, z: Array, smoothing: float, weights: Array | None, sign: float) -> Curve:
    """Return the smoothest curve within a distance of points.

    It is a cubic spline in the length of the chords u. With a smoothing of zero it runs through the points. Otherwise
    it has the least ∫|r''|² du of all curves r(u) with a root mean square distance from the points of at most
    `smoothing` (C. H. Reinsch, Numerische Mathematik 10 (1967) 177-183).

    Positions and the distance `smoothing` are in m. `sign` is that of dθ/ds where the body is convex.
    """
    points = np.stack([y, z], axis=1)
    u = np.append(0.0, np.cumsum(np.hypot(np.diff(y), np.diff(z))))
    smooth = points if smoothing == 0.0 else smoothed(u, points, smoothing, weights)
    spline = scipy.interpolate.CubicSpline(u, smooth, bc_type="not-a-knot" if smooth is points else "natural")

    def derivative(u: Array, order: int) -> tuple[Array, Array]:
        values = spline(u, order)
        return values[..., 0], values[..., 1]

    return joined([Parametric(derivative, u)], sign)


def smoothed(u: Array, points: Array, distance: float, weights: Array | None) -> Array:
    """Return the values at its knots u of the smoothing spline with this root mean square distance from points (n, k).

    It is the natural spline; a straight line, but for rounding, if that is near enough.
    """
    scale = (u[-1] - u[0]) / (u.size - 1)
    step = np.diff(u) / scale
    weight = np.ones(u.size) if weights is None else weights / weights.mean()
    second = np.zeros((3, u.size - 2))  # the rows of Qᵀ: second differences
    second[0], second[2] = 1.0 / step[:-1], 1.0 / step[1:]
    second[1] = -second[0] - second[2]

    def differences(values: Array) -> Array:
        return second[0, :, None] * values[:-2] + second[1, :, None] * values[1:-1] + second[2, :, None] * values[2:]

    def spread(gamma: Array) -> Array:
        values = np.zeros((u.size, gamma.shape[1]))
        for row in range(3):
            values[row : row + gamma.shape[0]] += second[row, :, None] * gamma
        return values / weight[:, None]

    inverse = 1.0 / weight
    tied = np.zeros((3, u.size - 2))  # Qᵀ W⁻¹ Q, upper bands
    tied[2] = second[0] ** 2 * inverse[:-2] + second[1] ** 2 * inverse[1:-1] + second[2] ** 2 * inverse[2:]
    tied[1, 1:] = second[1, :-1] * second[0, 1:] * inverse[1:-2] + second[2, :-1] * second[1, 1:] * inverse[2:-1]
    tied[0, 2:] = second[2, :-2] * second[0, 2:] * inverse[2:-2]
    stiff = np.zeros_like(tied)  # R
    stiff[2], stiff[1, 1:] = (step[:-1] + step[1:]) / 3.0, step[1:-1] / 6.0
    bent = differences(points)

    def residual(logarithm: float) -> Array:
        share = 1.0 / (1.0 + np.exp(-logarithm))  # λ/(1 + λ), so that both ends are finite
        left: Array = share * spread(scipy.linalg.solveh_banded((1.0 - share) * stiff + share * tied, bent))
        return left

    def rms(left: Array) -> float:
        return float(np.sqrt((weight[:, None] * left**2).sum() / u.size))

    low, high = -60.0, 35.0
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        if not low < middle < high:
            break
        low, high = (middle, high) if rms(residual(middle)) <= distance else (low, middle)
    return points - residual(low)
