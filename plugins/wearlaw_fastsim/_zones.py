"""The zones of a strip of FASTSIM on an ellipse: where it sticks, slips and perhaps sticks and slips again.

Lengths are over the half length a_y of a strip and tractions over its greatest bound, as in `_first_slip`. The angle β
is counted from the trailing edge, x = cos β.

Where a strip slips, |q| is the bound g, and the direction q̂ obeys dq̂/dx = (1 - q̂ q̂ᵀ) w/g, where w = dq/dx in stick: it
turns towards w at the rate |w|/g per length. While w keeps its direction, half the angle θ of q̂ is a linear problem:
as a complex number, h ~ exp(iθ/2) becomes

    h + tanh(κ/2) (w/|w|) h*,  κ = ∫ |w|/g dx,  q̂ = h²/|h|².

With spin w turns; a step of the march takes it at the place that q̂ lags behind it, so that the error is of second order
in the step however large κ is. Without spin the march is exact.
"""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

import numpy as np

from wearlaw import Array
from wearlaw_fastsim._first_slip import Growth, first_slip

BELOW = 1.0 - 8.0 * float(np.finfo(np.float64).eps)
"""Factor that keeps the magnitude of a traction below its bound, whatever is rounded."""

LEAST_ANGLE = 1e-90
"""Slip zone of a strip without creepage [rad]: the powers of it that are needed are not zero."""


class Zone(NamedTuple):
    """Nodes, of shape (nodes, ...), of a part of each strip that sticks or slips."""

    x: Array
    length: Array
    bound: Array
    traction_x: Array
    traction_y: Array
    excess: Array
    """w·q̂ - dg/dx, what the bound takes off the growth of the traction: zero in stick."""


class Point(NamedTuple):
    """A point of each strip: its angle, and the traction there; where a strip slips from it any vector along it."""

    angle: Array
    x: Array
    y: Array


RENEWED = 400
"""Steps after which the vector at half the angle of the traction gets the length of one: 2^800, its square, is"
" finite."""


def stick_and_slip(growth: Growth, elliptic: bool, stick_nodes: int, slip_nodes: int) -> tuple[Zone, Zone]:
    """Return the nodes of strips before they first slip, and the rest, where a few strips stick once more.

    The nodes are Gauss's: in x where a strip sticks, since q is a polynomial there, and in the angle where it slips,
    in which both bounds and q·s are smooth.
    """
    angle = np.maximum(2.0 * np.arctan(np.sqrt(first_slip(growth, elliptic))), LEAST_ANGLE)
    edge = np.zeros_like(angle)
    start = Point(angle, growth.along, growth.lateral_rate(0.5 * (np.cos(angle) - 1.0)))
    stick = _stick_zone(growth, elliptic, Point(edge + np.pi, edge, edge), angle, stick_nodes)
    slip = _slip_zone(growth, elliptic, start, edge, slip_nodes)
    again = (slip.excess < 0.0).any(axis=0)
    if again.any():
        gathered = Growth(*(part[again] for part in growth))
        split = _split_zone(gathered, elliptic, Point(*(part[again] for part in start)), slip_nodes)
        for whole, part in zip(slip, split, strict=True):
            whole[:, again] = part
    return stick, slip


@cache
def _gauss(count: int) -> tuple[Array, Array]:
    """Return the nodes and weights of Gauss's quadrature from 0 to 1."""
    nodes, weights = np.polynomial.legendre.leggauss(count)
    return 0.5 + 0.5 * nodes, 0.5 * weights


def _magnitude(x: Array, y: Array) -> Array:
    """Return √(x² + y²), sooner than np.hypot, which minds squares that overflow."""
    magnitude: Array = np.sqrt(x * x + y * y)
    return magnitude


def _from_leading(angle: Array) -> Array:
    distance: Array = 2.0 * np.cos(0.5 * angle) ** 2
    return distance


def _bound(elliptic: bool, sine: Array) -> Array:
    return sine if elliptic else sine * sine


def _stuck(growth: Growth, start: Point, from_leading: Array) -> tuple[Array, Array]:
    """Return the traction of strips that have stuck since the start."""
    before = _from_leading(start.angle)
    since, middle = from_leading - before, 0.5 * (from_leading + before) - 1.0
    return start.x + since * growth.along, start.y + since * growth.lateral_rate(middle)


def _stick_zone(growth: Growth, elliptic: bool, start: Point, end: Array, count: int) -> Zone:
    """Return the nodes of strips that stick from a point on, up to the angle of the end."""
    share, weight = _gauss(count)
    before = _from_leading(start.angle)
    span = _from_leading(end) - before
    from_leading = before + np.multiply.outer(share, span)
    traction_x, traction_y = _stuck(growth, start, from_leading)
    bound = _bound(elliptic, np.sqrt(from_leading * (2.0 - from_leading)))
    within = np.minimum(BELOW, BELOW * bound / np.maximum(_magnitude(traction_x, traction_y), 1e-150))
    return Zone(
        x=from_leading - 1.0,
        length=np.multiply.outer(weight, span),
        bound=bound,
        traction_x=within * traction_x,
        traction_y=within * traction_y,
        excess=np.zeros_like(bound),
    )


def _slip_zone(growth: Growth, elliptic: bool, start: Point, end: Array, count: int) -> Zone:
    """Return the nodes of strips that slip from a point on, up to the angle of the end."""
    share, weight = _gauss(count)
    span = start.angle - end
    angle = np.multiply.outer(np.append(1.0, 1.0 - share), span) + end
    tangent = np.tan(0.5 * angle)
    from_leading = 2.0 / (1.0 + tangent * tangent)
    x, sine = from_leading - 1.0, tangent * from_leading
    bound = _bound(elliptic, sine)
    left = angle if elliptic else np.log(tangent)  # ∫ dX over the bound, from there on, and a constant
    along, across = _directions(growth, start, x, bound, left)
    x, sine, bound = x[1:], sine[1:], bound[1:]
    growing = growth.along * along + growth.lateral_rate(x) * across
    return Zone(
        x=x,
        length=np.multiply.outer(weight, span) * sine,
        bound=bound,
        traction_x=bound * along,
        traction_y=bound * across,
        excess=growing + (x / sine if elliptic else 2.0 * x),
    )


def _directions(growth: Growth, start: Point, x: Array, bound: Array, left: Array) -> tuple[Array, Array]:
    """Return the direction of the traction at all x but the first, which is the start."""
    steps = np.diff(x, axis=0)
    kappa = (left[:-1] - left[1:]) * _magnitude(growth.along, growth.lateral_rate(x[1:] - 0.5 * steps))
    w = growth.lateral_rate(x[1:] - steps * _lag(kappa, bound))
    decay = np.exp(-kappa)
    turn = (1.0 - decay) / ((1.0 + decay) * np.maximum(_magnitude(growth.along, w), 1e-150))
    turns_x, turns_y = turn * growth.along, turn * w
    half_x, half_y = np.empty(w.shape), np.empty(w.shape)
    before_x, before_y = _half_angle(start)
    for k in range(len(w)):
        half_x[k] = before_x + (turns_x[k] * before_x + turns_y[k] * before_y)
        half_y[k] = before_y + (turns_y[k] * before_x - turns_x[k] * before_y)
        before_x, before_y = half_x[k], half_y[k]
        if k % RENEWED == RENEWED - 1:  # only the direction matters, and each step may double the length
            long = np.hypot(before_x, before_y)
            before_x, before_y = before_x / long, before_y / long
    over = BELOW / np.maximum(half_x * half_x + half_y * half_y, 1e-300)
    return (half_x - half_y) * (half_x + half_y) * over, 2.0 * half_x * half_y * over


def _lag(kappa: Array, bound: Array) -> Array:
    """Return how far the traction lags behind w at the end of each step, over the step.

    It is the mean of the way to the end, weighted with exp(-κ) of that way and 1/bound. For a bound that is linear in κ
    over the step it is r + (1 - 2 r) (skew/κ), where r = 1/κ - 1/(exp κ - 1) is (6+κ)/(12+4κ+κ²) within 0.011.
    """
    skew = (bound[1:] - bound[:-1]) / (bound[1:] + bound[:-1])
    lag: Array = (6.0 + kappa + skew * (2.0 + kappa)) / (12.0 + kappa * (4.0 + kappa))
    return lag


def _half_angle(start: Point) -> tuple[Array, Array]:
    """Return a vector at half the angle of the traction, or along x where there is none."""
    long = np.hypot(start.x, start.y) + np.abs(start.x)
    short = np.divide(start.y, long, out=np.zeros_like(long), where=long > 0.0)
    ahead = start.x >= 0.0
    return np.where(ahead, 1.0, short), np.where(ahead, short, 1.0)


def _split_zone(growth: Growth, elliptic: bool, start: Point, count: int) -> Zone:
    """Return the nodes of strips (strips,) that slip from the start on, stick again and slip again."""
    edge = np.zeros_like(start.angle)
    held = _where_it_sticks(_slip_zone(growth, elliptic, start, edge, 2 * count), elliptic)
    again = _where_it_slips(growth, elliptic, held, 2 * count)
    stuck = count // 4
    first = (count - stuck) // 2
    zones = (
        _slip_zone(growth, elliptic, start, held.angle, first),
        _stick_zone(growth, elliptic, held, again.angle, stuck),
        _slip_zone(growth, elliptic, again, edge, count - stuck - first),
    )
    return Zone(*(np.concatenate(parts) for parts in zip(*zones, strict=True)))


def _where_it_sticks(zone: Zone, elliptic: bool) -> Point:
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
    scale = _bound(elliptic, np.sin(angle)) / _magnitude(x, y)
    return Point(angle, scale * x, scale * y)


def _where_it_slips(growth: Growth, elliptic: bool, start: Point, count: int) -> Point:
    """Return where strips that stick from the start on meet their bound: on ever finer grids of `count` steps."""
    near, far = start.angle, np.zeros_like(start.angle)
    strip = np.arange(near.size)
    for _ in range(3):
        angle = near + np.multiply.outer(np.arange(count + 1) / count, far - near)
        beyond = _magnitude(*_stuck(growth, start, _from_leading(angle))) > _bound(elliptic, np.sin(angle))
        after = beyond[1:].argmax(axis=0) + 1
        near, far = angle[after - 1, strip], angle[after, strip]
    return Point(near, *_stuck(growth, start, _from_leading(near)))
