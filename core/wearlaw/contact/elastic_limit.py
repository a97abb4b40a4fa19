"""First yield and shakedown: the Hertz pressure up to which a contact that transmits traction responds elastically.

The stresses are those of an elastic half-space under Hertz's pressure and this traction along the rolling direction:

- If T = μN, the whole patch slips, and q = μp.
- In partial slip q = μ[p - (c/a) p'], where p' is the pressure of a patch of the same shape and pressure p0, c/a times
  as large, that touches the leading edge. That patch is the stick zone. On a line this is Carter's solution, with
  T/μN = 1 - (c/a)²; on an ellipse it is the solution of Vermeulen and Johnson, with T/μN = 1 - (c/a)³.

The theory leaves out traction from spin, and counts a lateral force as if it were longitudinal.

*First yield* is the pressure at which the most stressed point of a body reaches its yield criterion, whichever way the
traction acts on the body. The *shakedown limit* is the pressure at which τzx, the shear stress in the rolling
direction, reaches the yield stress in shear. On a line no residual stress can oppose τzx, so beyond that limit the
material flows forward with every passage; between first yield and shakedown it flows until residual stresses keep it
elastic. In full slip on a line the limit is 4k without friction, and k/μ from μ = 0.37 on (Johnson's map). Melan's
theorem proves it safe by Tresca's criterion in full slip; by von Mises's criterion, and in partial slip, the pressure
that is proved safe is up to 10 % lower. On an ellipse it is such a bound where the surface decides, from T/N = 0.3 on.
With less traction it is an estimate, and too high for a/b above 2, where other stresses decide.

Notes
-----
A semi-elliptic load is a sum over directions of loads that vary along one direction only. Each of them makes plane
strain and antiplane shear in the half-space (the inverse Radon transform of the load). With ζ = ξ/w + iz/w, w the half
width of the ellipse across the direction ξ, such a load is the real part of F = [2 - ζ ln((ζ+1)/(ζ-1))]/2, divided by π
and summed over directions that divide the ellipse evenly. On a line there is one direction, and F = √(1-ζ²) + iζ, which
is McEwen's solution. With P + iQ = F and z downwards, a pressure P and a traction P along ξ make

    σξ = -P - z ∂P/∂z,   σz = -P + z ∂P/∂z,   τξz = z ∂P/∂ξ,
    σξ = -2Q - z ∂P/∂ξ,  σz = z ∂P/∂ξ,        τξz = -P - z ∂P/∂z,

plane strain has ση = ν(σξ + σz), and a traction P across ξ makes τηz = -P and τξη = -Q.

Sources: K. L. Johnson, Contact Mechanics, Cambridge University Press, 1985; K. L. Johnson, A graphical approach to
shakedown in rolling contact, in Applied Stress Analysis, Elsevier, 1990, 263-274, for the method; the limits and the
sum over directions are derived here; E. McEwen, Phil. Mag. 40 (1949) 454-459, after the wiki of the library
Medusa (https://e6.ijs.si/medusa/wiki/index.php/Hertzian_contact); P. J. Vermeulen, K. L. Johnson, ASME J. Appl. Mech.
31 (1964) 338-340. All values are in SI units.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from functools import lru_cache
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

import numpy as np

from wearlaw.arrays import Array
from wearlaw.errors import InputError, PlasticityWarning, warn
from wearlaw.units.quantities import coefficient

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

_Value = TypeVar("_Value", float, Array)

FRICTIONS = 64
"""Steps of μ/(1+μ) from 0 to 1; stresses are linear in this variable, and their peak is convex."""

SLIPS = 32
"""Steps of √(1 - c/a) from stick to full slip."""

WIDTH = SLIPS + 2
"""Entries in a row of a table; the last entry is stored twice."""

TINY = 1e-12
"""A friction coefficient that stands for zero."""

PER_OCTAVE = 2.0
"""Axis ratios per octave in the tables; ratios between them are interpolated."""

OCTAVES = 5.0
"""Octaves to either side of the circle; a more slender ellipse counts as one with a/b of 1/32 or 32."""

LAST_STEP = PER_OCTAVE * OCTAVES - 1.0
"""Place of the last but one axis ratio in the tables."""

DIRECTIONS = 48
"""Directions of loads in a quarter of an ellipse."""

SURFACE = 1e-12
"""Depth over the smaller semi-axis that stands for the surface, where the formulas are singular at the edges."""


def first_yield(
    shear_yield_stress: ArrayLike,
    traction_coefficient: ArrayLike,
    friction_coefficient: ArrayLike | None = None,
    *,
    poisson_ratio: float,
    axis_ratio: ArrayLike = 0.0,
) -> Array:
    """Return Hertz's maximum pressure at first yield by von Mises's criterion [Pa]; arguments broadcast.

    Parameters
    ----------
    shear_yield_stress : array_like of float
        Yield stress in shear, k [Pa]: Y/√3 of the yield stress Y in tension.
    traction_coefficient : array_like of float
        The transmitted traction, T/N [-], of either sign.
    friction_coefficient : array_like of float, optional
        μ [-]; if it exceeds T/N, the patch slips in part. Without it the whole patch slips.
    poisson_ratio : float
        ν of the body [-].
    axis_ratio : array_like of float
        a/b of the patch [-], a in the rolling direction; 0 for a line.

    Raises
    ------
    InputError
        If a coefficient or axis ratio is not a finite number or is negative.

    Notes
    -----
    Interpolated in tables: within 0.15 % if the whole patch of a line slips, otherwise at most 3.5 % too low and 2 %
    too high, for a/b from 1/20 to 20, T/N up to 1 and T/μN from 0.05 on.
    """
    shear = _peak_of("von_mises", float(poisson_ratio), traction_coefficient, friction_coefficient, axis_ratio)
    limit: Array = np.asarray(shear_yield_stress, dtype=np.float64) / shear
    return limit


def shakedown_limit(
    shear_yield_stress: ArrayLike,
    traction_coefficient: ArrayLike,
    friction_coefficient: ArrayLike | None = None,
    *,
    axis_ratio: ArrayLike = 0.0,
) -> Array:
    """Return Hertz's maximum pressure at the shakedown limit [Pa]; arguments broadcast.

    Parameters
    ----------
    shear_yield_stress, traction_coefficient, friction_coefficient, axis_ratio
        As in `first_yield`.

    Notes
    -----
    The limit holds for perfectly plastic material that yields under the shear stress k, whatever its Poisson's ratio.
    Interpolated in tables: within 0.15 % if the whole patch of a line slips, otherwise within 3.5 %, in the same range
    as `first_yield`.
    """
    shear = _peak_of("forward", 0.0, traction_coefficient, friction_coefficient, axis_ratio)
    limit: Array = np.asarray(shear_yield_stress, dtype=np.float64) / shear
    return limit


LIMITS = (("forward", True), ("von_mises", False))
"""The stresses that decide about shakedown and about first yield, and whether it is shakedown."""


class Overload(NamedTuple):
    """An operating point beyond first yield; a warning should name the greater of two."""

    beyond_shakedown: bool
    """Whether the point is beyond the shakedown limit too."""
    ratio: float
    """The maximum pressure over the shakedown limit if the point is beyond it, otherwise over first yield."""
    max_pressure: float
    """Hertz's maximum pressure, p0 [Pa]."""
    traction_coefficient: float
    """The transmitted traction, T/N [-]."""

    def warn(self) -> None:
        """Warn of this point."""
        pressure, limit = 1e-6 * self.max_pressure, 1e-6 * self.max_pressure / self.ratio
        passed, result = (
            ("the shakedown limit", "the material flows with every passage")
            if self.beyond_shakedown
            else ("first yield", "the material flows until residual stresses keep it elastic")
        )
        warn(
            f"the maximum pressure of {pressure:.4g} MPa at T/N = {self.traction_coefficient:.3g} is beyond {passed},"
            f" {limit:.4g} MPa: {result}, which elastic contact models leave out",
            PlasticityWarning,
        )


def overload(
    bodies: Iterable[tuple[float, float]],
    max_pressure: Array,
    traction_coefficient: Array,
    friction_coefficient: Array,
    axis_ratio: Array | None,
    worst: Overload | None = None,
) -> Overload | None:
    """Return the operating point furthest beyond the limits of a body, or None if all points are elastic.

    Parameters
    ----------
    bodies : iterable of pairs of float
        Yield stress in shear [Pa] and Poisson's ratio of each body.
    max_pressure, traction_coefficient, friction_coefficient, axis_ratio : ndarray
        Arrays of one shape, not negative; an `axis_ratio` of None is a line.
    worst : Overload, optional
        The furthest of other points.
    """
    points = [max_pressure, traction_coefficient, friction_coefficient]
    if axis_ratio is not None:
        points.append(axis_ratio)
    if max_pressure.size == 1:
        point = [array.item() for array in points]  # functions of NumPy take ten times as long
        for k, nu in bodies:
            worst = max(filter(None, (worst, _overload_at(k, nu, *point))), default=None)
        return worst
    flat = [array.reshape(-1) for array in points]
    highest, traction, friction = (float(array.max()) for array in flat[:3])
    friction = max(traction, friction)
    for k, nu in bodies:
        if highest * _most_stressed(nu, friction) <= k:
            continue
        for measure, beyond in LIMITS:
            flows = worst is not None and worst.beyond_shakedown
            least = worst.ratio if worst is not None and flows == beyond else 1.0
            if not flows or beyond:  # beyond shakedown there is no need to check first yield
                further = _furthest(measure, k, nu, friction, least, *flat)
                worst = max(filter(None, (worst, further)), default=None)
    return worst


def _overload_at(k: float, nu: float, max_pressure: float, *point: float) -> Overload | None:
    """Return the overload of a body at one operating point, or None if it stays elastic."""
    traction, friction, *_ = point
    if max_pressure * _most_stressed(nu, max(traction, friction)) <= k:
        return None
    for measure, beyond in LIMITS:
        load = max_pressure * _peak(measure, nu, *point) / k
        if load > 1.0:  # beyond shakedown there is no need to check first yield
            return Overload(beyond, float(load), max_pressure, traction)
    return None


def _most_stressed(poisson_ratio: float, friction_coefficient: _Value) -> _Value:
    """Return an upper bound of von Mises's stress over √3 p0, in any patch and however much of it slips [-].

    The stress is a norm, so the stresses under the pressure and under the traction add at most. Under the pressure
    alone it is greatest on the surface of a line, (1 - 2ν)/√3, or below the surface, where it is at most 0.38 in any
    ellipse; under the traction alone it is at most √(3/2) μ, that of a line with ν = 0.
    """
    return max(0.38, (1.0 - 2.0 * poisson_ratio) / math.sqrt(3.0)) + 1.23 * friction_coefficient


def _furthest(
    measure: str, k: float, nu: float, friction: float, least: float, max_pressure: Array, traction: Array, *more: Array
) -> Overload | None:
    """Return the point with the greatest deciding shear stress, or None if none is above `least` k.

    Points are left out whose p0 is so low that at the greatest `friction` their stress is below that of a point that is
    close to the greatest.
    """
    at = int((max_pressure * traction).argmax())
    load = float(max_pressure[at]) * _peak(measure, nu, *(float(array[at]) for array in (traction, *more))) / k
    share = _greatest(measure, nu, friction, line=len(more) == 1) / k
    chosen = np.flatnonzero(max_pressure * share > (1.0 + 1e-9) * max(load, least))
    if chosen.size:
        loads = max_pressure[chosen] * _peak(measure, nu, *(array[chosen] for array in (traction, *more))) / k
        greatest = int(loads.argmax())
        if loads[greatest] > load:
            at, load = chosen[greatest], float(loads[greatest])
    if load <= least:
        return None
    return Overload(measure == "forward", load, float(max_pressure[at]), float(traction[at]))


def _greatest(measure: str, nu: float, friction: float, *, line: bool) -> float:
    """Return an upper bound of `_peak` for all points up to μ; on a line it is the greatest value of the table."""
    if line:
        most, u = _rows(measure, nu), FRICTIONS * friction / (1.0 + friction)
        row = int(u)
        return float((1.0 + friction) * (most[row] + (u - row) * (most[row + 1] - most[row])))
    if measure == "forward":  # at most 0.25 without traction, μ with much, within the error of the tables
        return max(0.251 + 0.326 * friction, 1.008 * friction)
    return _most_stressed(nu, friction)


@lru_cache(maxsize=16)
def _rows(measure: str, nu: float) -> Array:
    """Return the greatest value of each row of the table of a line; stresses grow with μ."""
    greatest: Array = _table(measure, nu, 0.0).reshape(-1, WIDTH).max(axis=1)
    return greatest


def _peak_of(measure: str, nu: float, traction: ArrayLike, friction: ArrayLike | None, axis_ratio: ArrayLike) -> Array:
    """Return `_peak` of arguments that broadcast; friction may be None."""
    t = np.abs(coefficient(traction, "traction_coefficient", positive=False))
    mu = t if friction is None else _not_negative(friction, "friction_coefficient")
    t, mu, ratio = np.broadcast_arrays(t, mu, _not_negative(axis_ratio, "axis_ratio"))
    peak: Array = np.empty(t.shape)
    line = ratio == 0.0
    if line.any():
        peak[line] = _peak(measure, nu, t[line], mu[line])
    if not line.all():
        peak[~line] = _peak(measure, nu, t[~line], mu[~line], ratio[~line])
    return peak


def _not_negative(value: ArrayLike, name: str) -> Array:
    array = coefficient(value, name, positive=False)
    if (array < 0.0).any():
        raise InputError(f"{name}: must not be negative, got {array.min():g}")
    return array


def _peak(measure: str, nu: float, traction: _Value, friction: _Value, axis_ratio: _Value | None = None) -> _Value:
    """Return the greatest value of the deciding shear stress over p0 [-], of a point or of arrays of one shape."""
    if axis_ratio is None:
        return _interpolated(_table(measure, nu, 0.0), traction, friction, 0.5)
    if isinstance(axis_ratio, float):
        place: Any = PER_OCTAVE * min(max(math.log2(axis_ratio), -OCTAVES), OCTAVES)
        low = highest = lows = min(float(math.floor(place)), LAST_STEP)
    else:
        place = PER_OCTAVE * np.clip(np.log2(axis_ratio), -OCTAVES, OCTAVES)
        lows = np.minimum(np.floor(place), LAST_STEP)
        low, highest = lows.min(), lows.max()
    if low == highest:
        at_low, at_high = (
            _interpolated(_table(measure, nu, 2.0 ** (end / PER_OCTAVE)), traction, friction, 1.0 / 3.0)
            for end in (low, low + 1.0)
        )
        return at_low + (place - low) * (at_high - at_low)  # type: ignore[no-any-return]
    peak: Any = np.empty(place.shape)
    for low in np.unique(lows):
        here = lows == low
        peak[here] = _peak(measure, nu, *(array[here] for array in (traction, friction, axis_ratio)))  # type: ignore[index]
    return peak  # type: ignore[no-any-return]


def _interpolated(table: Array, traction: _Value, friction: _Value, power: float) -> _Value:
    """Return the value of a table at T/N and μ, times 1 + μ.

    T/μN = 1 - (c/a)^(1/power), and the table has steps of √(1 - c/a).
    """
    alone = isinstance(traction, float)  # functions of NumPy take ten times as long
    mu: Any = max(friction, traction, TINY) if alone else np.maximum(np.maximum(friction, traction), TINY)
    u = FRICTIONS * (mu / (1.0 + mu))
    v = SLIPS * (1.0 - (1.0 - traction / mu) ** power) ** 0.5
    i, j = (int(u), int(v)) if alone else (u.astype(np.intp), v.astype(np.intp))
    f, g = u - i, v - j
    at = WIDTH * i + j
    entry: Any = table.item if alone else table.__getitem__  # `item` returns Python's float, which computes faster
    first, third = entry(at), entry(at + WIDTH)
    low, high = first + g * (entry(at + 1) - first), third + g * (entry(at + WIDTH + 1) - third)
    return (1.0 + mu) * (low + f * (high - low))  # type: ignore[no-any-return]


@lru_cache(maxsize=256)
def _table(measure: str, nu: float, axis_ratio: float) -> Array:
    """Return the greatest shear stresses over p0 (1 + μ) [-], a row for each μ/(1+μ), each ending with full slip.

    The last row and the last column are there twice, for points at the end of the table. An axis ratio of 0 is a line.
    """
    share = np.linspace(0.0, 1.0, FRICTIONS + 1)[:, None]
    x, z = _points(min(1.0, 1.0 / axis_ratio) if axis_ratio else 1.0)
    pressed, slipping = _stresses(x, z, nu, axis_ratio)
    columns = []
    for step in range(SLIPS + 1):
        stick, sheared = 1.0 - (step / SLIPS) ** 2, slipping
        if stick:
            sheared = slipping - stick * _stresses((x + 1.0 - stick) / stick, z / stick, nu, axis_ratio)[1]
        columns.append(MEASURES[measure](pressed, sheared, share).max(axis=-1))
    return np.pad(np.stack(columns, axis=1), ((0, 1), (0, 1)), mode="edge").reshape(-1)


def _points(depth: float) -> tuple[Array, Array]:
    """Return x/a and z/a of the points to search for the greatest stresses, on and below the surface at y = 0.

    On the surface they are where the stick zones end, at which traction peaks, and as many again ahead.
    """
    ends = 1.0 - 2.0 * (np.arange(SLIPS + 1) / SLIPS) ** 2
    surface = np.append(ends, np.sin(np.linspace(-0.45, 0.45, 19) * np.pi))
    x, z = np.meshgrid(np.linspace(-0.88, 0.88, 17), np.linspace(0.06, 0.96, 16), indexing="ij")
    below = depth * np.append(np.full(surface.shape, SURFACE), z)
    return np.append(surface, x), below


def _stresses(x: Array, z: Array, nu: float, axis_ratio: float) -> tuple[Array, Array]:
    """Return σx, σy, σz and τzx over p0, (4, points), under pressure, and under an equal traction along x.

    Parameters
    ----------
    x, z : ndarray, (points,)
        Places in the plane y = 0, over a.
    nu : float
        Poisson's ratio.
    axis_ratio : float
        a/b; 0 for a line.
    """
    if axis_ratio:
        step = (np.arange(DIRECTIONS) + 0.5) / DIRECTIONS
        angle, weight = 0.5 * np.pi * step**2, 2.0 * step / DIRECTIONS  # dense along x, for points on the edge there
        narrow = np.hypot(np.cos(angle), axis_ratio * np.sin(angle))  # a/w
        cos = np.cos(angle) / narrow
        u, v = x[:, None] * np.cos(angle), z[:, None] * narrow
        ahead, behind = (u - 1.0) ** 2 + v**2, (u + 1.0) ** 2 + v**2
        log, turn = 0.5 * np.log(behind / ahead), np.arctan2(v, u + 1.0) - np.arctan2(v, u - 1.0)
        p, q = 1.0 - 0.5 * (u * log - v * turn), -0.5 * (u * turn + v * log)
        along = 0.5 * v * ((u + 1.0) / behind + (u - 1.0) / ahead - log)
        down = 0.5 * v * (v / behind + v / ahead + turn)
    else:
        weight, cos = np.ones(1), np.ones(1)
        zeta = (x + 1j * z)[:, None]
        root = -1j * np.sqrt(zeta - 1.0) * np.sqrt(zeta + 1.0)
        load, slope = root + 1j * zeta, z[:, None] * (1j - zeta / root)
        p, q, along, down = load.real, load.imag, slope.real, -slope.imag
    sin2 = 1.0 - cos**2

    # The stresses of a load along ξ in the frame (ξ, η, z), turned to x and y. Parts odd in y cancel.
    def turned(xi: Array, eta: Array, shear: Array | float = 0.0) -> tuple[Array, Array]:
        return (xi * cos**2 + eta * sin2 - 2.0 * shear) @ weight, (xi * sin2 + eta * cos**2 + 2.0 * shear) @ weight

    pressed = *turned(-p - down, -2.0 * nu * p), (down - p) @ weight, (along * cos) @ weight
    across = cos * sin2 * q  # τξη sin cos of the traction across ξ, which is -sin
    sheared = (
        *turned(cos * (-2.0 * q - along), -2.0 * nu * cos * q, across),
        (cos * along) @ weight,
        (-(cos**2) * (p + down) - sin2 * p) @ weight,
    )
    return np.stack(pressed), np.stack(sheared)


def _von_mises(pressed: Array, sheared: Array, share: Array) -> Array:
    """Return von Mises's stress over √3 at each share of the traction, the greater for its two directions."""

    def product(first: Array, second: Array) -> Array:
        normal = (first[:3] - first[[1, 2, 0]]) * (second[:3] - second[[1, 2, 0]])
        total: Array = normal.sum(axis=0) / 6.0 + first[3] * second[3]
        return total

    mixed = np.abs(product(pressed, sheared))
    rest = 1.0 - share
    square = rest**2 * product(pressed, pressed) + 2.0 * rest * share * mixed + share**2 * product(sheared, sheared)
    stress: Array = np.sqrt(square)
    return stress


def _forward(pressed: Array, sheared: Array, share: Array) -> Array:
    """Return |τzx| at each share of the traction, the greater for its two directions."""
    stress: Array = (1.0 - share) * np.abs(pressed[3]) + share * np.abs(sheared[3])
    return stress


MEASURES = {"von_mises": _von_mises, "forward": _forward}
"""The deciding shear stress, (n, points), from σx, σy, σz, τzx, (4, points), at shares, (n, 1), of the traction."""
