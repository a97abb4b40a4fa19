"""The zones of a strip of FASTSIM on an ellipse: it sticks, slips, and may stick and slip again.

A strip at y has the half length a_y = a √(1 - y²/b²) and the greatest bound g_y. Lengths are over a_y, and tractions
over g_y: U = 1 + X from the leading edge, V = 1 - X from the trailing edge, X = cos β. From the leading edge the
traction grows as U (P, R + S V), with dq/dX = (P, R - 2 S X); it slips where it first meets the bound U V (parabola) or
√(U V) (ellipse).

Where a strip slips, |q| is the bound g, and the direction q̂ obeys dq̂/dx = (1 - q̂ q̂ᵀ) w/g, where w = dq/dx in stick: it
turns towards w at the rate |w|/g per length. While w keeps its direction, half the angle θ of q̂ is a linear problem:
as a complex number, h ~ exp(iθ/2) becomes

    (1 + exp(-κ))/2 h + (1 - exp(-κ))/2 (w/|w|) h*,  κ = ∫ |w|/g dx,  q̂ = h²/|h|².

With spin w turns. A step of the march takes w at the place that q̂ lags behind it, so that the error is of second order
in the step however large κ is. Without spin the march is exact.
"""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from wearlaw import Array
from wearlaw_models.contact_models.fastsim import loops as loops
from wearlaw_models.strips import half_angle, turn

LEAST_ANGLE = 1e-90
"""Slip zone of a strip without creepage [rad]; the powers of it in the formulas do not underflow to zero."""

SHARP = 1.6
"""Distances between nodes within which w turns by a right angle where a strip is looked at more closely."""

NODES = 4
"""Nodes that take about as long as one operating point in the count of `accelerated`."""


class Growth(NamedTuple):
    """Growth of the traction of strips in stick, over g_y and per a_y, as arrays of one shape."""

    along: Array
    """P = (ξ/L1 - φy/L3) a_y/g_y."""
    across: Array
    """R = (η/L2) a_y/g_y."""
    turning: Array
    """S = φ/(2 L3) a_y²/g_y."""

    def lateral_rate(self, x: Array) -> Array:
        """Return the lateral part of dq/dX; the longitudinal part is P."""
        return self.across - 2.0 * self.turning * x


class Nodes(NamedTuple):
    """Nodes of strips, as SI arrays of shape (nodes, ...).

    Attributes
    ----------
    x : ndarray
        Position from the leading edge, x < 0, to the trailing edge [m].
    length : ndarray
        Length along x that a node represents, its weight in integrals [m].
    bound : ndarray
        Bound of the traction [Pa].
    traction_x, traction_y : ndarray
        Traction [Pa].
    slip_x, slip_y : ndarray
        Relative slip [-], zero in stick.
    excess : ndarray
        w·q̂ - dg/dx, the growth of the traction that the bound takes off; zero in stick.
    """

    x: Array
    length: Array
    bound: Array
    traction_x: Array
    traction_y: Array
    slip_x: Array
    slip_y: Array
    excess: Array


class Point(NamedTuple):
    """A point of each strip: its angle, its distance from the leading edge, and the traction there.

    If the strip slips from this point, any vector along the traction will do.
    """

    angle: Array
    u: Array
    x: Array
    y: Array


class Strips(NamedTuple):
    """Strips to march along.

    Attributes
    ----------
    rows : ndarray, (7, ...)
        The strips, as in `_loops`.
    elliptic : bool
        Whether the bound is an ellipse; otherwise it is a parabola.
    compiled : bool
        Whether numba compiles the loops over the nodes.
    """

    rows: Array
    elliptic: bool
    compiled: bool

    @property
    def growth(self) -> Growth:
        """Growth of the traction in stick."""
        return Growth(*self.rows[:3])


def stick_and_slip(strips: Strips, stick_nodes: int, slip_nodes: int) -> Nodes:
    """Return the nodes of strips: those before they first slip, then the rest, in which a few strips stick once more.

    The nodes are Gauss's: in x where a strip sticks, since q is a polynomial there, and in the angle where it slips,
    in which both bounds and q·s are smooth.
    """
    start = _first_slip(strips)
    edge = np.zeros_like(start.u)
    nodes = _empty(stick_nodes + slip_nodes, edge.shape)
    _stick(strips, Point(edge, edge, edge, edge), start.u, nodes, slice(0, stick_nodes))
    _slip(strips, start, edge, nodes, slice(stick_nodes, None))
    again = _turns(strips, start, Nodes(*nodes).excess[stick_nodes:].min(axis=0), slip_nodes)
    if again.any():
        nodes[:, stick_nodes:, again] = _split(*_some(again, strips, start), slip_nodes)
    return Nodes(*nodes)


def sums(strips: Strips, slip_nodes: int) -> Array:
    """Return ∫q_x, ∫q_y and ∫X q_y dX of strips, (3, ...), on the nodes of `stick_and_slip`, by compiled loops."""
    start, shape = _first_slip(strips), strips.rows.shape[1:]
    integrals = np.empty((4, *shape))
    integrals[:3] = loops.held(*strips.growth, start.u)
    held, integrals[3] = integrals[:3].copy(), np.inf
    share, weight = _gauss(slip_nodes)
    rows, flat = _flat(strips.rows), _flat(integrals)
    march = _compiled_march(strips, start, np.zeros(shape), share)
    loops.sum_loop(strips.elliptic, rows, *march, weight, flat)
    again = _turns(strips, start, integrals[3], slip_nodes)
    if again.any():
        zone = Nodes(*_split(*_some(again, strips._replace(rows=_unscaled(strips.rows)), start), slip_nodes))
        x, y = zone.length * zone.traction_x, zone.length * zone.traction_y
        integrals[:3, again] = held[:, again] + np.stack([x, y, zone.x * y]).sum(axis=1)
    return integrals[:3]


def _first_slip(strips: Strips) -> Point:
    """Return the points where strips first slip; the traction there is given by its direction."""
    growth = strips.growth
    square = first_slip(growth, strips.elliptic)
    angle, u = np.maximum(2.0 * np.arctan(np.sqrt(square)), LEAST_ANGLE), 2.0 / (1.0 + square)
    return Point(angle, u, growth.along, growth.lateral_rate(0.5 * u - 1.0))


def first_slip(growth: Growth, elliptic: bool) -> Array:
    """Return tan² β/2 = V/U where a strip first slips: infinite at its leading edge, 0 if it never slips."""
    return _elliptic(growth) if elliptic else _parabolic(growth)


def _parabolic(growth: Growth) -> Array:
    """Return V/U at the root of V² = P² + (R + S V)² in [0, 2], or infinity if there is none; there is at most one.

    With D² = P² + R² - S²P² the root is (RS + D)/(1 - S²) = (P² + R²)/(D - RS); use the form that does not cancel.
    """
    p, r, s = growth
    square, cross = p * p + r * r, r * s
    root = np.sqrt(np.maximum(square - (s * p) ** 2, 0.0))
    adds = cross > 0.0
    over = np.where(adds, cross + root, square)
    under = np.where(adds, (1.0 - s) * (1.0 + s), root - cross)
    grows_slower = p * p + (r + 2.0 * s) ** 2 < 4.0
    v = np.divide(over, under, out=np.zeros_like(over), where=grows_slower & (under > 0.0))
    u = 2.0 - v
    return np.divide(v, u, out=np.full_like(u, np.inf), where=grows_slower & (u > 0.0))


def _elliptic(growth: Growth) -> Array:
    """Return V/U at the largest root V of U (P² + (R + S V)²) = V below 2.

    Z = 2/U = 1 + V/U is the largest root of Z³ - 3 m Z² + 2 n Z - l, with 3 m = 1 + P² + T², n = T c, l = c²,
    T = R + c, c = 2 S. With Z = m (1 + z) the cubic is z³ - 3 p z - 2 q, which has three real roots or one.
    """
    c = 2.0 * growth.turning
    t = growth.across + c
    mean = (1.0 + growth.along**2 + t * t) / 3.0
    slope = t * c / mean**2
    p = 1.0 - 2.0 / 3.0 * slope
    q = 1.0 - slope + 0.5 * (c / mean) ** 2 / mean
    single = q * q - p**3
    size = np.sqrt(np.maximum(p, 1e-100))
    largest = 2.0 * size * np.cos(np.arccos(np.clip(q / size**3, -1.0, 1.0)) / 3.0)
    radius = np.cbrt(np.abs(q) + np.sqrt(np.maximum(single, 0.0)))
    only = np.copysign(radius + p / np.maximum(radius, 1e-100), q)
    z = np.where(single > 0.0, only, largest)
    return _without_rounding(growth, mean * (1.0 + z) - 1.0)


def _without_rounding(growth: Growth, w: Array) -> Array:
    """Return w = V/U after a step of Newton's method for w = P² + (R + 2 S w/(1+w))².

    The step removes the rounding in w = Z - 1, which is small at small creepage.
    """
    lateral = growth.across + 2.0 * growth.turning * (w / (1.0 + w))
    slope = 1.0 - 4.0 * growth.turning * lateral / (1.0 + w) ** 2
    miss = w - growth.along**2 - lateral * lateral
    step = np.divide(miss, slope, out=np.zeros_like(w), where=slope > 0.0)  # zero where nearby roots coincide
    return np.maximum(w - step, 0.0)


def _turns(strips: Strips, start: Point, excess: Array, count: int) -> NDArray[np.bool_]:
    """Return which strips may stick once more: the least excess at their nodes is negative, or w turns round at once.

    Between two nodes such a strip may stick and not show it, and its traction turns too fast for even steps.
    """
    growth = strips.growth
    begin, end = (growth.lateral_rate(x) for x in (start.u - 1.0, np.ones_like(start.u)))
    within, turning = SHARP * np.pi / count, np.abs(growth.turning)
    sharp = (np.abs(growth.along) < within * turning) & (turning * within**2 > 1.0)
    return np.asarray((excess < 0.0) | (sharp & (begin * end < 0.0)))


def _some(chosen: NDArray[np.bool_], strips: Strips, start: Point) -> tuple[Strips, Point]:
    """Return some of the strips, and where they first slip."""
    rows = np.stack([row[chosen] for row in strips.rows])
    return strips._replace(rows=rows), Point(*(part[chosen] for part in start))


def _unscaled(rows: Array) -> Array:
    """Return strips with a half length, a greatest bound and slips of one."""
    return np.concatenate([rows[:3], np.ones_like(rows[3:])])


def _empty(count: int, shape: tuple[int, ...]) -> Array:
    """Return empty fields for a number of nodes of strips."""
    return np.empty((len(Nodes._fields), count, *shape))


@cache
def _gauss(count: int) -> tuple[Array, Array]:
    """Return the nodes and weights of Gauss's quadrature from 0 to 1."""
    nodes, weights = np.polynomial.legendre.leggauss(count)
    return 0.5 + 0.5 * nodes, 0.5 * weights


@cache
def _down(count: int) -> Array:
    """Return one, and how far Gauss's nodes are from one."""
    return np.append(1.0, 1.0 - _gauss(count)[0])


def _from_leading(angle: Array) -> Array:
    distance: Array = 2.0 * np.cos(0.5 * angle) ** 2
    return distance


def _bound(elliptic: bool, sine: Array) -> Array:
    return sine if elliptic else sine * sine


def _stick(strips: Strips, start: Point, end: Array, nodes: Array, part: slice) -> None:
    """Fill some of the nodes of strips that stick from a point up to a distance from the leading edge."""
    zone = Nodes(*nodes[:, part])
    share, weight = _gauss(len(zone.x))
    span = end - start.u
    if strips.compiled:
        begin = np.stack([start.u, span, start.x, start.y])
        loops.stick_loop(strips.elliptic, _flat(strips.rows), _flat(begin), share, weight, part.start, _flat(nodes, 2))
        return
    along, across, turning, half_length, greatest, *_ = strips.rows
    u = start.u + np.multiply.outer(share, span)
    traction = loops.stuck(along, across, turning, start.x, start.y, start.u, u)
    bound, q_x, q_y = loops.sticking(strips.elliptic, *traction, u)
    np.multiply(half_length, u - 1.0, out=zone.x)
    np.multiply.outer(weight, half_length * span, out=zone.length)
    np.multiply(greatest, bound, out=zone.bound)
    np.multiply(greatest, q_x, out=zone.traction_x)
    np.multiply(greatest, q_y, out=zone.traction_y)
    zone.slip_x[:] = zone.slip_y[:] = zone.excess[:] = 0.0


def _slip(strips: Strips, start: Point, end: Array, nodes: Array, part: slice) -> None:
    """Fill some of the nodes of strips that slip from a point up to an angle."""
    zone = Nodes(*nodes[:, part])
    share, weight = _gauss(len(zone.x))
    if strips.compiled:
        march = _compiled_march(strips, start, end, share)
        loops.slip_loop(strips.elliptic, _flat(strips.rows), *march, weight, part.start, _flat(nodes, 2))
        return
    span, half = start.angle - end, half_angle(start.x, start.y)
    tangent, left = _steps(strips, span, end, share)
    along, across, turning, half_length, greatest, to_slip_x, to_slip_y = strips.rows
    u, sine, bound = loops.place(strips.elliptic, tangent)
    steps = u[:-1], bound[:-1], u[1:], bound[1:], left[:-1] - left[1:]
    kappa, lagged = loops.lagging(along, across, turning, *steps)
    decay = np.exp(kappa, out=kappa)
    more, less, other = turn(along, lagged, decay)
    keeps = np.stack([more, less], axis=1)
    halves = np.empty((len(share), *half.shape))
    for k in range(len(share)):
        half = np.add(keeps[k] * half, other[k] * half[::-1], out=halves[k])
    u, sine = u[1:], sine[1:]
    q_x, q_y, zone.excess[:] = loops.slipping(
        strips.elliptic, along, across, turning, u, sine, halves[:, 0], halves[:, 1]
    )
    np.multiply(half_length, u - 1.0, out=zone.x)
    np.multiply(np.multiply.outer(weight, half_length * span), sine, out=zone.length)
    np.multiply(greatest, bound[1:], out=zone.bound)
    np.multiply(zone.bound, q_x, out=zone.traction_x)
    np.multiply(zone.bound, q_y, out=zone.traction_y)
    slips = np.maximum(zone.excess, 0.0)
    np.multiply(to_slip_x * slips, q_x, out=zone.slip_x)
    np.multiply(to_slip_y * slips, q_y, out=zone.slip_y)


def _steps(strips: Strips, span: Array, end: Array, share: Array) -> tuple[Array, Array]:
    """Return the tangents of half the angles of nodes, (1 + nodes, ...), and ∫ dX over the bound up to a constant."""
    angle = np.multiply.outer(_down(len(share)), span)
    angle += end
    tangent = np.tan(0.5 * angle)
    return tangent, angle if strips.elliptic else np.log(tangent)


def _compiled_march(strips: Strips, start: Point, end: Array, share: Array) -> tuple[Array, Array, Array, Array]:
    """Return the arguments `start`, `tangent`, `decay` and `lagged` of the compiled loops over zones that slip."""
    span = start.angle - end
    tangent, left = (_flat(array) for array in _steps(strips, span, end, share))
    kappa, lagged = np.empty((2, len(share), span.size))
    loops.lag_loop(strips.elliptic, _flat(strips.rows), tangent, left, kappa, lagged)
    return _flat(np.stack([*half_angle(start.x, start.y), span])), tangent, np.exp(kappa, out=kappa), lagged


def _flat(array: Array, axes: int = 1) -> Array:
    """Return an array that keeps its first axes and has one axis for all strips."""
    return array.reshape(*array.shape[:axes], -1)


def _split(strips: Strips, start: Point, count: int) -> Array:
    """Return the nodes of strips (strips,) that slip from the start on, may stick again, and slip again.

    Where they do not stick, nodes are close where the traction turns fastest.
    """
    edge = np.zeros_like(start.angle)
    trial, nodes = _empty(2 * count, edge.shape), _empty(count, edge.shape)
    _slip(strips._replace(rows=_unscaled(strips.rows)), start, edge, trial, slice(0, None))
    held = _where_it_sticks(Nodes(*trial), strips.elliptic)
    again = _where_it_slips(strips, held, 2 * count)
    stuck = count // 4
    first = (count - stuck) // 2
    _slip(strips, start, held.angle, nodes, slice(0, first))
    _stick(strips, held, again.u, nodes, slice(first, first + stuck))
    _slip(strips, again, edge, nodes, slice(first + stuck, None))
    return nodes


def _where_it_sticks(zone: Nodes, elliptic: bool) -> Point:
    """Return the point where the excess of a slip zone falls to zero, or comes closest to it."""
    falls = zone.excess < 0.0
    after = np.where(falls.any(axis=0), falls.argmax(axis=0), zone.excess.argmin(axis=0))
    strip = np.arange(after.size)
    here, there = (np.maximum(after - 1, 0), strip), (after, strip)
    drop = zone.excess[here] - zone.excess[there]
    share = np.divide(zone.excess[here], drop, out=np.ones_like(drop), where=drop > 0.0).clip(max=1.0)
    angle, x, y = (
        part[here] + share * (part[there] - part[here])
        for part in (np.arccos(zone.x), zone.traction_x / zone.bound, zone.traction_y / zone.bound)
    )
    scale = _bound(elliptic, np.sin(angle)) / np.sqrt(x * x + y * y)
    return Point(angle, _from_leading(angle), scale * x, scale * y)


def _where_it_slips(strips: Strips, start: Point, count: int) -> Point:
    """Return where strips that stick from the start on meet their bound, by ever finer grids of `count` steps."""
    near, far = start.angle, np.zeros_like(start.angle)
    strip = np.arange(near.size)

    def traction(u: Array) -> tuple[Array, Array]:
        return loops.stuck(*strips.growth, start.x, start.y, start.u, u)

    for _ in range(3):
        angle = near + np.multiply.outer(np.arange(count + 1) / count, far - near)
        x, y = traction(_from_leading(angle))
        beyond = np.sqrt(x * x + y * y) > _bound(strips.elliptic, np.sin(angle))
        after = beyond[1:].argmax(axis=0) + 1
        near, far = angle[after - 1, strip], angle[after, strip]
    u = _from_leading(near)
    return Point(near, u, *traction(u))
