"""Strip theory with friction: the fields along strips that do not feel each other.

Lengths of a strip are over its half length a, and tractions over its greatest bound g = μp0. From the leading edge at
x = -1 the bound is √(1-x²). The slip of rigid bodies is w = (w_x, w_y - φx). A traction takes up the slip e of plane
elasticity, e = k H q along x and along y, where H is skew, so that ∫ q·e dx = 0, H √(1-x²) = -x, and k = g/K with the
stiffness K of the plane: Carter's strip slips all over from the slip k on.

Stick, from -1 to 1 - 2V. Its traction is bounded at both ends only if in its middle, at x = -V, w has the direction and
size (w_x/k_x, (w_y + φV)/k_y) = V n. This gives V and n. The traction is n √(1-x²), less (n - φ/k_y ŷ) √(D²-(x+V)²),
D = 1 - V. A strip with V = 1 slips all over, and n is the direction in which its leading edge slips.

Slip, from there to 1. With the traction n √(1-x²) all of this is the solution of plane elasticity, and along n it takes
up e = kV - p(x+V) - (k-p) √((1+x)(x-1+2V)), where k = k_x n_x² + k_y n_y² and p = φ n_y. But with spin, or k_x ≠ k_y,
its slip is not along n. So here the traction turns to a direction q̂(x) instead and still takes up e along itself: the
slip is s = w·q̂ - e along q̂, and ∫ q·s dx = ∫ q·w dx for any q̂.

Turning. As in FASTSIM q̂ follows w by a flexibility, but one that takes up the same e: the flexibility λ² of
e = λ d(λq)/dx, whose energy λ²q²/2 is E(x) = -∫ √(1-x²) e dx from x to 1. Then q̂ turns towards w at the rate
|w| √(1-x²)/(2E). Where s would be negative, the strip sticks again: λq grows by w/λ until |q| meets the bound. With
much spin w turns round, and a strip may stick again for less than a step, so steps of such strips are divided.
"""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

import wearlaw as wl
from wearlaw import Array
from wearlaw_models.contact_models.strip_theory import loops as loops
from wearlaw_models.contact_models.strip_theory.loops import TINY
from wearlaw_models.strips import half_angle, turn

NODES = 4
"""Nodes that take about as long as one operating point in the count of `accelerated`."""

STEPS = 4
"""Steps of Newton's method for the slip at a leading edge; it converges from below, and is nearly linear."""

PARTS = 4
"""Parts of a step between two nodes of a strip that sticks again, or whose rigid slip turns round within a step."""

SHARP = 0.3
"""Least tangent of the angle by which w turns over a step where it turns round."""


class Strips(NamedTuple):
    """Strips, as arrays of one shape: w = (along, across - turning x) and k as slips."""

    along: Array
    across: Array
    turning: Array
    k_x: Array
    k_y: Array


class Start(NamedTuple):
    """Where strips first slip, V, and the direction n of the traction there."""

    v: Array
    n_x: Array
    n_y: Array


class Nodes(NamedTuple):
    """Nodes, (nodes, ...): position, length that a node represents, bound, traction, and the slip along it."""

    x: Array
    length: Array
    bound: Array
    q_x: Array
    q_y: Array
    slip: Array

    @property
    def sums(self) -> Array:
        """∫ q_x dx, ∫ q_y dx and ∫ x q_y dx, (3, ...)."""
        return _add_up(self.x, self.length, self.q_x, self.q_y)


def start(strips: Strips) -> Start:
    """Return V and n.

    V is the root of V² = P² + (R + S V)², of which the left side is larger at V = 1 if a strip sticks. If it slips all
    over, with the slip σ n at the leading edge, n = (w_x/(σ + k_x), w_y/(σ + k_y)).
    """
    along, across, turning, k_x, k_y = strips
    p, r, s = along / k_x, across / k_y, turning / k_y
    square, cross = p * p + r * r, r * s
    root = np.sqrt(np.maximum(square - (s * p) ** 2, 0.0))
    adds = cross > 0.0
    over = np.where(adds, cross + root, square)
    under = np.where(adds, (1.0 - s) * (1.0 + s), root - cross)
    v = np.divide(over, under, out=np.zeros_like(over), where=under > 0.0)  # zero if the strip rolls freely
    v = np.where(p * p + (r + s) ** 2 < 1.0, np.minimum(v, 1.0), 1.0)
    w_y = across + turning * v
    sigma = np.where(v < 1.0, 0.0, np.maximum(np.sqrt(along * along + w_y * w_y) - np.maximum(k_x, k_y), 0.0))
    for _ in range(STEPS):
        x, y = along / (sigma + k_x), w_y / (sigma + k_y)
        square = x * x + y * y
        falls = x * x / (sigma + k_x) + y * y / (sigma + k_y)
        sigma += np.where(v < 1.0, 0.0, (np.sqrt(square) - 1.0) * square / (falls + TINY))
    x, y = along / (sigma + k_x), w_y / (sigma + k_y)
    size = np.sqrt(x * x + y * y) + TINY
    return Start(v, x / size, y / size)


def solve(strips: Strips, stick_nodes: int, slip_nodes: int) -> Nodes:
    """Return the nodes of strips, those in stick first."""
    rows, stick, slip = _rows(strips), _stick_table(stick_nodes), _slip_table(slip_nodes)
    nodes = np.empty((len(Nodes._fields), stick_nodes + slip_nodes, rows.shape[1]))
    if compiled := _compiled(strips, nodes.shape[1]):
        loops.stick_loop(rows, stick, nodes)
        loops.slip_loop(rows, slip, *_steps(rows, slip), stick_nodes, nodes)
    else:
        _stick(rows, stick, nodes)
        _slip(rows, slip, nodes, stick_nodes)
    again = (nodes[5, stick_nodes:] < 0.0).any(axis=0) | _turn_round(rows, slip_nodes)
    if again.any():
        nodes[3:, stick_nodes:, again] = _again(rows[:, again], slip_nodes, compiled)
    return Nodes(*nodes.reshape(*nodes.shape[:2], *strips.k_x.shape))


def sums(strips: Strips, stick_nodes: int, slip_nodes: int, rounds: int) -> Array:
    """Return the sums of the nodes of `solve`, (3, ...), which are asked for in a number of rounds.

    Compiled loops leave out the nodes.
    """
    if not _compiled(strips, rounds * (stick_nodes + slip_nodes)):
        return solve(strips, stick_nodes, slip_nodes).sums
    rows, slip = _rows(strips), _slip_table(slip_nodes)
    held, slid = np.zeros((3, rows.shape[1])), np.zeros((4, rows.shape[1]))
    loops.sum_loop(rows, _stick_table(stick_nodes), slip, *_steps(rows, slip), held, slid)
    again = (slid[3] < 0.0) | _turn_round(rows, slip_nodes)
    if again.any():
        v, cosine, length = rows[5, again], slip[:, :1], slip[:, 2:3]
        q_x, q_y, _ = _again(rows[:, again], slip_nodes, compiled=True)
        slid[:3, again] = _add_up(1.0 - v * (1.0 + cosine), v * length, q_x, q_y)
    return (held + slid[:3]).reshape(3, *strips.k_x.shape)


def _turn_round(rows: Array, count: int) -> NDArray[np.bool_]:
    """Return in which strips w turns round from one of `count` nodes in slip to the next."""
    along, across, turning, _, _, v, *_ = rows
    aside, spin = np.abs(across - turning * (1.0 - v)), np.abs(turning)  # w_y in the middle of the zone
    return np.asarray((aside < spin * v) & (SHARP * np.abs(along) < np.pi / count * spin * v))


def _add_up(x: Array, length: Array, q_x: Array, q_y: Array) -> Array:
    along, across = length * q_x, length * q_y
    return np.stack([along.sum(axis=0), across.sum(axis=0), (x * across).sum(axis=0)])


def _rows(strips: Strips) -> Array:
    """Return strips as rows of an array, as in `_loops`."""
    shape = strips.k_x.shape
    return np.stack([np.broadcast_to(row, shape).ravel() for row in (*strips, *start(strips))])


def _compiled(strips: Strips, nodes: int) -> bool:
    return wl.accelerated(strips.k_x.size * nodes // NODES)


@cache
def _gauss(count: int) -> tuple[Array, Array]:
    """Return the nodes and weights of Gauss's quadrature from 0 to π."""
    nodes, weights = np.polynomial.legendre.leggauss(count)
    return 0.5 * np.pi * (1.0 + nodes), 0.5 * np.pi * weights


def _stick_table(count: int) -> Array:
    """Return the table of `stick_loop`."""
    t, weights = _gauss(count)
    return np.stack([np.cos(t), np.sin(t), weights * np.sin(t)], axis=1)


def _slip_table(count: int) -> Array:
    """Return the table of `slip_loop`."""
    beta, weights = _gauss(count)
    return _march_table(beta, weights)


@cache
def _parts_table(count: int) -> Array:
    """Return the table of `again_loop`, of steps in even parts; it has no lengths."""
    beta = _gauss(count)[0]
    parts = np.linspace(np.append(0.0, beta[:-1]), beta, PARTS + 1, axis=1)[:, 1:]
    return _march_table(parts.ravel(), np.zeros(parts.size)).reshape(*parts.shape, -1)


def _march_table(beta: Array, weights: Array) -> Array:
    cosine, sine = np.cos(beta), np.sin(beta)
    arc = 0.5 * (np.pi - beta) + 0.25 * np.sin(2.0 * beta)
    return np.stack(
        [cosine, sine, weights * sine, arc, np.diff(beta, prepend=0.0), -np.diff(cosine, prepend=1.0)], axis=1
    )


def _stick(rows: Array, table: Array, nodes: Array) -> None:
    """Fill the nodes in stick, at x = -V - D cos t."""
    _, _, turning, _, k_y, v, n_x, n_y = rows
    cosine, sine, length = table.T[..., None]
    count = len(table)
    nodes[0, :count], nodes[2, :count], nodes[3, :count], nodes[4, :count] = loops.stuck(
        v, n_x, n_y, turning / k_y, cosine, sine
    )
    nodes[1, :count], nodes[5, :count] = (1.0 - v) * length, 0.0


def _slip(rows: Array, table: Array, nodes: Array, stick_nodes: int) -> None:
    """Fill the nodes in slip, at x = 1 - V - V cos β, as if no strip stuck again."""
    along, across, turning, k_x, k_y, v, n_x, n_y = rows
    cosine, sine, length, arc, step, way = table.T[..., None]
    behind = v * (1.0 + cosine)
    angle = 2.0 * np.arcsin(np.sqrt(0.5 * behind))
    half = half_angle(n_x, n_y)
    k, p = loops.shape(k_x, k_y, turning, n_x, n_y)
    x = 1.0 - behind
    w_y = across - turning * x
    rate = loops.rate(along, w_y, v, behind, sine, loops.energy(k, p, v, behind, angle, sine, arc))
    kappa = rate.copy()
    kappa[1:] += rate[:-1]
    kappa *= 0.5 * step
    more, less, other = turn(along, w_y + turning * (loops.lag(kappa) * v * way), np.exp(-kappa))
    keeps = np.stack([more, less], axis=1)
    halves = np.empty_like(keeps)
    for at in range(len(table)):
        half = np.add(keeps[at] * half, other[at] * half[::-1], out=halves[at])
    to = nodes[:, stick_nodes:]
    to[0], to[2], q_x, q_y, to[5] = loops.slipping(tuple(rows), cosine, halves[:, 0], halves[:, 1])
    to[1], to[3], to[4] = v * length, to[2] * q_x, to[2] * q_y


def _steps(rows: Array, table: Array) -> tuple[Array, Array, Array]:
    """Return the arguments `half`, `decay` and `lagging` of the compiled loops over zones that slip."""
    angle = np.multiply.outer(0.5 + 0.5 * table[:, 0], rows[5])
    angle = np.multiply(2.0, np.arcsin(np.sqrt(angle, out=angle), out=angle), out=angle)
    decay, lagging = np.empty(angle.shape), np.empty(angle.shape)
    loops.lag_loop(rows, table, angle, decay, lagging)
    return half_angle(rows[6], rows[7]), np.exp(decay, out=decay), lagging


def _again(rows: Array, count: int, compiled: bool) -> Array:
    """Return the tractions and slips of strips that stick again, (3, nodes, strips), part by part of the steps.

    A step is divided where s falls below zero, and where a strip that sticks meets its bound, both by linear
    interpolation. So tractions are continuous functions of the creepages, without which loads would not balance.
    """
    table, fields = _parts_table(count), np.empty((3, count, rows.shape[1]))
    if compiled:
        loops.again_loop(np.ascontiguousarray(rows), table, fields)
        return fields
    state, before = loops.first(tuple(rows)), np.empty(0)
    for at, parts in enumerate(table):
        sticks, slips = state[4], np.zeros(rows.shape[1])
        for part in parts:
            *fields[:, at], share, state = loops.again(tuple(rows), tuple(part), state)
            slips += share / PARTS
        if at:
            fields[2, at - 1] *= before + 0.5 * slips
        before = loops.choose(sticks, slips, 0.5 * slips)
    fields[2, -1] *= before + 0.5
    return fields
