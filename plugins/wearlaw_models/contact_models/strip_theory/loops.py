"""Formulas of one strip and one node that NumPy shares with the loops over nodes that numba compiles.

Strips are rows of one array: along, across, turning, k_x and k_y of `Strips`, and V, n_x and n_y of `Start`. Nodes are
the fields of `_strips.Nodes`, in the order there. Tables hold what nodes at the same place of all strips share.
"""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np

import wearlaw as wl
from wearlaw import Array
from wearlaw_models.strips import BELOW, Number, direction, root, turn

TINY = 1e-100
"""Keeps divisors from zero."""

KNOTS = 2048
"""Steps of the tables of `between`, between which they are linear."""

Pair: TypeAlias = tuple[Any, Any]
Totals: TypeAlias = tuple[Any, Any, Any, Any]


def shape(k_x: Number, k_y: Number, turning: Number, n_x: Number, n_y: Number) -> tuple[Number, Number]:
    """Return k and p."""
    return k_x * n_x * n_x + k_y * n_y * n_y, turning * n_y


def stuck(v: Number, n_x: Number, n_y: Number, spin: Number, cosine: float, sine: float) -> tuple[Number, ...]:
    """Return x, the bound and the traction at x = -V - D cos t of strips that stick; `spin` is φ/k_y."""
    d = 1.0 - v
    ahead, inner = d * (1.0 - cosine), d * sine
    bound = root(ahead * (2.0 - ahead))
    q_x, q_y = n_x * (bound - inner), n_y * (bound - inner) + spin * inner
    within: Any = np.minimum(BELOW * bound / (root(q_x * q_x + q_y * q_y) + TINY), 1.0)
    fields: Any = ahead - 1.0, bound, within * q_x, within * q_y
    return fields  # type: ignore[no-any-return]


def energy(k: Number, p: Number, v: Number, behind: Number, angle: Number, sine: float, arc: float) -> Number:
    """Return 2E at 1 - x = `behind` = 1 - cos `angle`.

    `arc` is ∫ sin² β dβ up to the trailing edge, as ∫ (1+x) √((1-x)(x-1+2V)) dx = V² ((2-V) arc + V sin³β/3).
    """
    bound = root(behind * (2.0 - behind))
    beyond = angle - (1.0 - behind) * bound  # twice ∫ √(1-x²) dx
    inner = v * ((2.0 - v) * arc + v * (sine * sine * sine / 3.0))
    twice: Any = (k - p) * v * (2.0 * inner - beyond) + 2.0 / 3.0 * p * bound * bound * bound
    return np.maximum(twice, TINY)  # type: ignore[no-any-return]


def rate(w_x: Number, w_y: Number, v: Number, behind: Number, sine: float, twice: Number) -> Number:
    """Return the rate at which the traction turns by β, |w| √(1-x²)/(2E) dx/dβ."""
    return root((w_x * w_x + w_y * w_y) * (behind * (2.0 - behind))) * (v * sine) / twice


def lag(kappa: Number) -> Number:
    """Return by how much of a step q̂ lags behind a turning w, if κ grew evenly over the step.

    The lag is 1/κ - 1/(exp κ - 1) within 0.011.
    """
    return (6.0 + kappa) / (12.0 + kappa * (4.0 + kappa))


def taken_up(k: Number, p: Number, v: Number, behind: Number, cosine: float) -> Number:
    """Return e."""
    return k * v - p * (1.0 - behind + v) - (k - p) * root((2.0 - behind) * (v * (1.0 - cosine)))


def place(distance: Number, half_length: Number) -> Number:
    """Return where the tables of `between` have a distance from a strip."""
    position: Any = np.abs(distance) * (KNOTS / root(half_length * half_length + distance * distance))
    return position  # type: ignore[no-any-return]


def between(place: Number, table: Array) -> tuple[Number, Number]:
    """Return G_K and G_E at a place in their table."""
    at: Any = np.int32(np.minimum(place, KNOTS - 1))
    share, first, second = place - at, table[0], table[1]
    return first[at] + share * (first[at + 1] - first[at]), second[at] + share * (second[at + 1] - second[at])


def gained(kernels: Pair, nu: Number, a: Number, apart: Number, strip: Totals, other: Totals) -> Number:
    """Return the energy that a strip gains from one at y + `apart`, from G_K, G_E, F_x, F_y, M_x and M_y of both."""
    (k, e), (x, y, moment_x, moment_y), (to_x, to_y, to_moment_x, to_moment_y) = kernels, strip, other
    along = (k - nu * e) * (moment_x * to_x - to_moment_x * x)
    across = ((1.0 - nu) * k + nu * e) * (moment_y * to_y - to_moment_y * y)
    return (along + across - nu * k * apart * (x * to_y + y * to_x)) / (a * a * a)  # type: ignore[no-any-return]


def slipping(strip: tuple[Number, ...], cosine: float, half_x: Number, half_y: Number) -> tuple[Number, ...]:
    """Return x, the bound, the direction of the traction and the slip along it, at x = 1 - V - V cos β.

    The traction has half the angle of (half_x, half_y).
    """
    along, across, turning, k_x, k_y, v, n_x, n_y = strip
    k, p = shape(k_x, k_y, turning, n_x, n_y)
    behind = v * (1.0 + cosine)
    w_y = across - turning * (1.0 - behind)
    q_x, q_y = direction(half_x, half_y)
    slip = along * q_x + w_y * q_y - taken_up(k, p, v, behind, cosine)
    return 1.0 - behind, root(behind * (2.0 - behind)), q_x, q_y, slip


def choose(which: Any, number: Any, other: Any) -> Any:
    """Return a number where `which` is 1, and the other one where it is 0; both are finite."""
    return which * number + (1.0 - which) * other


def first(strip: tuple[Any, ...]) -> tuple[Any, ...]:
    """Return the state of `again` at the first slip: q̂, the size of λq, s, whether the strip sticks, rate, bound, λ."""
    along, across, turning, k_x, k_y, v, n_x, n_y = strip
    k, p = shape(k_x, k_y, turning, n_x, n_y)
    full = root(energy(k, p, v, 2.0 * v, 2.0 * np.arcsin(root(v)), 0.0, 0.5 * np.pi))
    w_y = across - turning * (1.0 - 2.0 * v)
    s = np.maximum(along * n_x + w_y * n_y - taken_up(k, p, v, 2.0 * v, 1.0), 0.0)
    return n_x, n_y, full, s, 0.0 * v, 0.0 * v, root(2.0 * v * (2.0 - 2.0 * v)), full


def again(strip: tuple[Any, ...], node: tuple[float, ...], state: tuple[Any, ...]) -> tuple[Any, ...]:
    """Return the traction and slip after a step of a strip that sticks again, the share that slips, and the state.

    The node there is a row of the table of `slip_loop`; the size of λq is its bound where the strip slips.
    """
    along, across, turning, k_x, k_y, v, n_x, n_y = strip
    cosine, sine, _, arc, step, way = node
    q_x, q_y, size, s, sticks, rate_before, bound_before, last = state
    k, p = shape(k_x, k_y, turning, n_x, n_y)
    behind, dx = v * (1.0 + cosine), v * way
    w_y = across - turning * (1.0 - behind)
    twice = energy(k, p, v, behind, 2.0 * np.arcsin(root(0.5 * behind)), sine, arc)
    rate_here = rate(along, w_y, v, behind, sine, twice)
    bound, full = root(behind * (2.0 - behind)), root(twice)
    grows = 0.5 * dx * (bound_before / last + bound / full)  # ∫ dx/λ over the step
    # A strip that sticks, until it meets its bound after a share of the step, if it does.
    free_x, free_y = size * q_x + grows * along, size * q_y + grows * (w_y + 0.5 * turning * dx)
    under, over = last - size, root(free_x * free_x + free_y * free_y) - full
    leaves = sticks * (over >= 0.0)
    stuck = leaves * under / choose(leaves, under + over + TINY, 1.0)
    # A strip that slips, over the rest.
    x, y = unit(size * q_x + stuck * (free_x - size * q_x), size * q_y + stuck * (free_y - size * q_y))
    ahead, long = 1.0 * (x >= 0.0), 1.0 + np.abs(x)
    half_x, half_y = choose(ahead, long, y), choose(ahead, y, long)
    kappa = 0.5 * step * (rate_before + rate_here) * (1.0 - stuck)
    more, less, other = turn(along, w_y + turning * (lag(kappa) * (1.0 - stuck) * dx), np.exp(-kappa))
    x, y = direction(more * half_x + other * half_y, less * half_y + other * half_x)
    slip = along * x + w_y * y - taken_up(k, p, v, behind, cosine)
    # One of these whose slip falls to zero after a share of the step, and which sticks from there on.
    enters = (1.0 - sticks) * (slip < 0.0)
    slid = enters * s / choose(enters, s - slip, 1.0)
    held_x, held_y = unit(q_x + slid * (x - q_x), q_y + slid * (y - q_y))
    reached, rest = last + slid * (full - last), (1.0 - slid) * grows
    free_x = choose(enters, reached * held_x + rest * along, free_x)
    free_y = choose(enters, reached * held_y + rest * (w_y + 0.5 * turning * (1.0 - slid) * dx), free_y)
    slips = choose(enters, slid, 1.0 - sticks * choose(leaves, stuck, 1.0))
    sticks = enters + (1.0 - enters) * sticks * (1.0 - leaves)
    to_x, to_y = unit(free_x, free_y)
    q_x, q_y = choose(sticks, to_x, x), choose(sticks, to_y, y)
    within = np.minimum(root(free_x * free_x + free_y * free_y), full)
    size = choose(sticks, within, full)
    s = (1.0 - sticks) * np.maximum(slip, 0.0)
    traction = BELOW * bound * size / full
    return traction * q_x, traction * q_y, s, slips, (q_x, q_y, size, s, sticks, rate_here, bound, full)


def unit(x: Number, y: Number) -> tuple[Number, Number]:
    """Return a vector over its length."""
    length = root(x * x + y * y) + TINY
    return x / length, y / length


ROWS, NODES = "float64[:, ::1]", "float64[:, :, ::1]"


@wl.compiled_loop(f"void({ROWS}, {ROWS}, {NODES})")
def stick_loop(strips: Array, table: Array, nodes: Array) -> None:
    """Fill the first nodes of strips, which stick; the table holds cosine, sine and length over D."""
    turning, k_y, v, n_x, n_y = strips[2], strips[4], strips[5], strips[6], strips[7]
    for at in range(table.shape[0]):
        cosine, sine, length = table[at, 0], table[at, 1], table[at, 2]
        to_x, to_length, to_bound = nodes[0, at], nodes[1, at], nodes[2, at]
        to_q_x, to_q_y = nodes[3, at], nodes[4, at]
        nodes[5, at] = 0.0
        for i in range(v.size):
            x, bound, q_x, q_y = stuck(v[i], n_x[i], n_y[i], turning[i] / k_y[i], cosine, sine)
            to_x[i], to_length[i], to_bound[i] = x, (1.0 - v[i]) * length, bound
            to_q_x[i], to_q_y[i] = q_x, q_y


@wl.compiled_loop(f"void({ROWS}, {NODES}, {NODES})")
def again_loop(strips: Array, table: Array, fields: Array) -> None:
    """Fill in the tractions and slips of strips that stick again, (3, nodes, strips).

    The table is one of (nodes, parts of steps, columns). A node stands for half a step on each side, of which it slips
    over more or less.
    """
    for i in range(strips.shape[1]):
        strip = (
            strips[0, i], strips[1, i], strips[2, i], strips[3, i],
            strips[4, i], strips[5, i], strips[6, i], strips[7, i],
        )  # fmt: skip
        state, before = first(strip), 0.0
        for at in range(table.shape[0]):
            sticks, slips = state[4], 0.0
            for part in range(table.shape[1]):
                cosine, sine, length, arc, step, way = table[at, part]
                x, y, slip, share, state = again(strip, (cosine, sine, length, arc, step, way), state)
                fields[0, at, i], fields[1, at, i], fields[2, at, i] = x, y, slip
                slips += share / table.shape[1]
            if at:
                fields[2, at - 1, i] *= before + 0.5 * slips
            before = choose(sticks, slips, 0.5 * slips)
        fields[2, -1, i] *= before + 0.5


@wl.compiled_loop(f"void({ROWS}, {ROWS}, {', '.join([ROWS] * 3)})")
def lag_loop(strips: Array, table: Array, angle: Array, kappa: Array, lagging: Array) -> None:
    """Fill in -κ, and w across where the traction lags behind; the table is that of `slip_loop`."""
    along, across, turning, k_x, k_y = strips[0], strips[1], strips[2], strips[3], strips[4]
    v, n_x, n_y = strips[5], strips[6], strips[7]
    rates = np.zeros(v.size)
    for at in range(table.shape[0]):
        cosine, sine, _, arc, step, way = table[at]
        angles, to_kappa, to_lagging = angle[at], kappa[at], lagging[at]
        for i in range(v.size):
            k, p = shape(k_x[i], k_y[i], turning[i], n_x[i], n_y[i])
            behind = v[i] * (1.0 + cosine)
            w_y = across[i] - turning[i] * (1.0 - behind)
            twice = energy(k, p, v[i], behind, angles[i], sine, arc)
            here = rate(along[i], w_y, v[i], behind, sine, twice)
            turned = 0.5 * step * (rates[i] + here)
            to_kappa[i] = -turned
            to_lagging[i] = w_y + turning[i] * (lag(turned) * v[i] * way)
            rates[i] = here


@wl.compiled_loop(f"void({ROWS}, {ROWS}, {', '.join([ROWS] * 3)}, int64, {NODES})")
def slip_loop(strips: Array, table: Array, half: Array, decay: Array, lagging: Array, first: int, nodes: Array) -> None:
    """Fill the nodes from `first` on, which slip.

    The table holds cosine, sine, length over V, arc, and the steps in β and x from the node before. `half` holds a
    vector at half the angle of n, which the loop turns.
    """
    along, across, turning, k_x, k_y = strips[0], strips[1], strips[2], strips[3], strips[4]
    v, n_x, n_y, half_x, half_y = strips[5], strips[6], strips[7], half[0], half[1]
    for at in range(table.shape[0]):
        cosine, length, decays, lags, row = table[at, 0], table[at, 2], decay[at], lagging[at], first + at
        to_x, to_length, to_bound = nodes[0, row], nodes[1, row], nodes[2, row]
        to_q_x, to_q_y, to_slip = nodes[3, row], nodes[4, row], nodes[5, row]
        for i in range(v.size):
            more, less, other = turn(along[i], lags[i], decays[i])
            to_x[i], to_length[i] = more * half_x[i] + other * half_y[i], less * half_y[i] + other * half_x[i]
        for i in range(v.size):
            half_x[i], half_y[i] = to_x[i], to_length[i]
            strip = along[i], across[i], turning[i], k_x[i], k_y[i], v[i], n_x[i], n_y[i]
            _, bound, q_x, q_y, to_slip[i] = slipping(strip, cosine, half_x[i], half_y[i])
            to_bound[i], to_q_x[i], to_q_y[i] = bound, bound * q_x, bound * q_y
        for i in range(v.size):
            to_x[i], to_length[i] = 1.0 - v[i] * (1.0 + cosine), v[i] * length


@wl.compiled_loop(f"void({', '.join([ROWS] * 8)})")
def sum_loop(
    strips: Array, stick: Array, slip: Array, half: Array, decay: Array, lagging: Array, held: Array, slid: Array
) -> None:
    """Add up ∫ q_x, ∫ q_y and ∫ x q_y over zones that stick and zones that slip, and find the least slip there.

    The tables and `half` are those of `stick_loop` and `slip_loop`.
    """
    along, across, turning, k_x, k_y = strips[0], strips[1], strips[2], strips[3], strips[4]
    v, n_x, n_y, half_x, half_y = strips[5], strips[6], strips[7], half[0], half[1]
    to_x, to_y, to_turning = held[0], held[1], held[2]
    for at in range(stick.shape[0]):
        cosine, sine, length = stick[at]
        for i in range(v.size):
            x, _, q_x, q_y = stuck(v[i], n_x[i], n_y[i], turning[i] / k_y[i], cosine, sine)
            share = (1.0 - v[i]) * length
            to_x[i] += share * q_x
            to_y[i] += share * q_y
            to_turning[i] += share * x * q_y
    to_x, to_y, to_turning, least = slid[0], slid[1], slid[2], slid[3]
    for at in range(slip.shape[0]):
        cosine, length, decays, lags = slip[at, 0], slip[at, 2], decay[at], lagging[at]
        for i in range(v.size):
            more, less, other = turn(along[i], lags[i], decays[i])
            next_x, next_y = more * half_x[i] + other * half_y[i], less * half_y[i] + other * half_x[i]
            half_x[i], half_y[i] = next_x, next_y
            strip = along[i], across[i], turning[i], k_x[i], k_y[i], v[i], n_x[i], n_y[i]
            x, bound, q_x, q_y, slips = slipping(strip, cosine, next_x, next_y)
            share = v[i] * length * bound
            to_x[i] += share * q_x
            to_y[i] += share * q_y
            to_turning[i] += share * x * q_y
            least[i] = min(least[i], slips)


@wl.compiled_loop(f"void({', '.join([ROWS] * 4)}, {NODES})")
def others_loop(y: Array, half_length: Array, weight: Array, table: Array, sums: Array) -> None:
    """Add to the sums of each strip those over the others, in two loops: a place is many at once, a look-up is not."""
    places = np.empty(y.shape[1])
    for at in range(y.shape[0]):
        first, second = sums[0, at], sums[1, at]
        for other in range(y.shape[0]):
            if other != at:
                for i in range(y.shape[1]):
                    places[i] = place(y[other, i] - y[at, i], half_length[other, i])
                for i in range(y.shape[1]):
                    k, e = between(places[i], table)
                    first[i] += weight[other, i] * k
                    second[i] += weight[other, i] * e


@wl.compiled_loop(f"void({ROWS}, {ROWS}, float64[::1], {NODES}, {ROWS}, {ROWS})")
def exchange_loop(y: Array, square: Array, nu: Array, totals: Array, table: Array, gains: Array) -> None:
    """Add to the gains of each strip, and take from those of the other one, what each pair exchanges."""
    half_length, places = np.empty(y.shape[1]), np.empty(y.shape[1])
    x, across, moment_x, moment_y = totals[0], totals[1], totals[2], totals[3]
    for at in range(y.shape[0]):
        for other in range(at + 1, y.shape[0]):
            for i in range(y.shape[1]):
                half_length[i] = root(0.5 * (square[at, i] + square[other, i]))
                places[i] = place(y[other, i] - y[at, i], half_length[i])
            for i in range(y.shape[1]):
                strip = x[at, i], across[at, i], moment_x[at, i], moment_y[at, i]
                beside = x[other, i], across[other, i], moment_x[other, i], moment_y[other, i]
                apart = y[other, i] - y[at, i]
                gain = gained(between(places[i], table), nu[i], half_length[i], apart, strip, beside)
                gains[at, i] += gain
                gains[other, i] -= gain
