"""Formulas of one node of a strip that NumPy shares with the loops over nodes that numba compiles.

Strips are rows of one array: along, across and turning, the growth of the traction, `_zones.Growth`; the half length
[m] and the greatest bound [Pa]; and the longitudinal and lateral slip over the excess. Nodes are the fields of `Nodes`.
"""

from __future__ import annotations

from typing import Any

import numpy as np

import wearlaw as wl
from wearlaw import Array
from wearlaw_models.strips import BELOW, TINY, Number, direction, root, turn


def place(elliptic: bool, tangent: Number) -> tuple[Number, Number, Number]:
    """Return the distance from the leading edge, the sine of the angle and the bound, from tan of half the angle."""
    u = 2.0 / (1.0 + tangent * tangent)
    sine = tangent * u
    return u, sine, sine if elliptic else sine * sine


def stuck(
    along: Number, across: Number, turning: Number, x: Number, y: Number, before: Number, u: Number
) -> tuple[Number, Number]:
    """Return the traction at a distance u from the leading edge, in strips that stick since it was (x, y) before."""
    since = u - before
    return x + since * along, y + since * (across - turning * (u + before - 2.0))


def held(along: Number, across: Number, turning: Number, u: Number) -> tuple[Number, Number, Number]:
    """Return ∫q_x, ∫q_y and ∫X q_y dX up to a distance u from the leading edge, in strips that stick from that edge."""
    lateral, half, third = across + 2.0 * turning, 0.5 * u * u, u * u * u / 3.0
    return (
        along * half,
        lateral * half - turning * third,
        lateral * (third - half) - turning * (0.5 * half * u * u - third),
    )


def sticking(elliptic: bool, x: Number, y: Number, u: Number) -> tuple[Number, Number, Number]:
    """Return the bound, and the traction (x, y) kept below it."""
    square = u * (2.0 - u)
    bound = root(square) if elliptic else square
    within: Any = BELOW * np.minimum(bound / root(x * x + y * y + TINY), 1.0)
    return bound, within * x, within * y


def lagging(
    along: Number,
    across: Number,
    turning: Number,
    u: Number,
    bound: Number,
    to_u: Number,
    to_bound: Number,
    left: Number,
) -> tuple[Number, Number]:
    """Return -κ of a step from node to node, and w across at the place that the traction lags behind at its end.

    The lag, over the step, is the mean distance to the end, weighted with exp(-κ) of that distance and 1/bound. For a
    bound that is linear in κ over the step the lag is r + (1 - 2 r) (skew/κ), where r = 1/κ - 1/(exp κ - 1) is
    (6+κ)/(12+4κ+κ²) within 0.011, and skew is the rise of the bound over the sum of the bounds at both ends.
    """
    middle = across - turning * (u + to_u - 2.0)
    kappa = left * root(along * along + middle * middle)
    rise, both = to_bound - bound, to_bound + bound
    lag = (both * (6.0 + kappa) + rise * (2.0 + kappa)) / (both * (12.0 + kappa * (4.0 + kappa)))
    return -kappa, across - 2.0 * turning * (to_u - 1.0 - lag * (to_u - u))


def slipping(
    elliptic: bool,
    along: Number,
    across: Number,
    turning: Number,
    u: Number,
    sine: Number,
    half_x: Number,
    half_y: Number,
) -> tuple[Number, Number, Number]:
    """Return the direction of the traction, from a vector at half its angle, and the excess."""
    q_x, q_y = direction(half_x, half_y)
    x = u - 1.0
    growing = along * q_x + (across - 2.0 * turning * x) * q_y
    return q_x, q_y, growing + (x / sine if elliptic else 2.0 * x)


ROWS, NODES = "float64[:, ::1]", "float64[:, :, ::1]"


@wl.compiled_loop(f"void(boolean, {ROWS}, {ROWS}, float64[::1], float64[::1], int64, {NODES})")
def stick_loop(
    elliptic: bool, strips: Array, start: Array, share: Array, weight: Array, first: int, nodes: Array
) -> None:
    """Fill the nodes of zones that stick, from the node `first` on.

    `start` holds the distance of the zones from the leading edge, their length, and the traction where they start.
    """
    along, across, turning, half_length, greatest = strips[0], strips[1], strips[2], strips[3], strips[4]
    before, span, from_x, from_y = start[0], start[1], start[2], start[3]
    for k in range(share.size):
        row = first + k
        x, length, bound, traction_x, traction_y = (
            nodes[0, row],
            nodes[1, row],
            nodes[2, row],
            nodes[3, row],
            nodes[4, row],
        )
        nodes[5:, row] = 0.0
        for i in range(x.size):
            u = before[i] + share[k] * span[i]
            q_x, q_y = stuck(along[i], across[i], turning[i], from_x[i], from_y[i], before[i], u)
            level, q_x, q_y = sticking(elliptic, q_x, q_y, u)
            x[i], length[i] = half_length[i] * (u - 1.0), half_length[i] * (weight[k] * span[i])
            bound[i], traction_x[i], traction_y[i] = greatest[i] * level, greatest[i] * q_x, greatest[i] * q_y


@wl.compiled_loop(f"void(boolean, {', '.join([ROWS] * 5)})")
def lag_loop(elliptic: bool, strips: Array, tangent: Array, left: Array, kappa: Array, lagged: Array) -> None:
    """Fill in -κ and w across for the steps from node to node."""
    along, across, turning = strips[0], strips[1], strips[2]
    for k in range(len(kappa)):
        here, there, left_here, left_there = tangent[k], tangent[k + 1], left[k], left[k + 1]
        to_kappa, to_lagged = kappa[k], lagged[k]
        for i in range(to_kappa.size):
            u, _, bound = place(elliptic, here[i])
            to_u, _, to_bound = place(elliptic, there[i])
            to_kappa[i], to_lagged[i] = lagging(
                along[i], across[i], turning[i], u, bound, to_u, to_bound, left_here[i] - left_there[i]
            )


@wl.compiled_loop(f"void(boolean, {', '.join([ROWS] * 5)}, float64[::1], {ROWS})")
def sum_loop(
    elliptic: bool, strips: Array, start: Array, tangent: Array, decay: Array, lagged: Array, weight: Array, sums: Array
) -> None:
    """Add up ∫q_x, ∫q_y and ∫X q_y dX over zones that slip, and find their least excess, without the nodes.

    `start` is that of `slip_loop`.
    """
    along, across, turning, half_x, half_y, span = strips[0], strips[1], strips[2], start[0], start[1], start[2]
    to_x, to_y, to_turning, least = sums[0], sums[1], sums[2], sums[3]
    for k in range(weight.size):
        there, fades, w = tangent[k + 1], decay[k], lagged[k]
        for i in range(least.size):
            u, sine, bound = place(elliptic, there[i])
            more, less, other = turn(along[i], w[i], fades[i])
            next_x, next_y = more * half_x[i] + other * half_y[i], less * half_y[i] + other * half_x[i]
            half_x[i], half_y[i] = next_x, next_y
            q_x, q_y, excess = slipping(elliptic, along[i], across[i], turning[i], u, sine, next_x, next_y)
            share = weight[k] * span[i] * sine * bound
            to_x[i] += share * q_x
            to_y[i] += share * q_y
            to_turning[i] += share * (u - 1.0) * q_y
            least[i] = min(least[i], excess)


@wl.compiled_loop(f"void(boolean, {', '.join([ROWS] * 5)}, float64[::1], int64, {NODES})")
def slip_loop(
    elliptic: bool,
    strips: Array,
    start: Array,
    tangent: Array,
    decay: Array,
    lagged: Array,
    weight: Array,
    first: int,
    nodes: Array,
) -> None:
    """Fill the nodes of zones that slip, from the node `first` on, in three loops: compilers give up on larger ones.

    `start` holds a vector at half the angle of the traction, which the loops advance, and the angle of the zones.
    """
    along, across, turning, half_length, greatest = strips[0], strips[1], strips[2], strips[3], strips[4]
    to_slip_x, to_slip_y, half_x, half_y, span = strips[5], strips[6], start[0], start[1], start[2]
    for k in range(weight.size):
        row = first + k
        x, length, bound, traction_x = nodes[0, row], nodes[1, row], nodes[2, row], nodes[3, row]
        traction_y, slip_x, slip_y, excess = nodes[4, row], nodes[5, row], nodes[6, row], nodes[7, row]
        there, fades, w = tangent[k + 1], decay[k], lagged[k]
        for i in range(x.size):
            u, sine, _ = place(elliptic, there[i])
            more, less, other = turn(along[i], w[i], fades[i])
            to_x, to_y = more * half_x[i] + other * half_y[i], less * half_y[i] + other * half_x[i]
            half_x[i], half_y[i] = to_x, to_y
            traction_x[i], traction_y[i], excess[i] = slipping(
                elliptic, along[i], across[i], turning[i], u, sine, to_x, to_y
            )
        for i in range(x.size):
            u, sine, level = place(elliptic, there[i])
            x[i], length[i] = half_length[i] * (u - 1.0), half_length[i] * (weight[k] * span[i] * sine)
            bound[i] = greatest[i] * level
        for i in range(x.size):
            slips = excess[i] if excess[i] > 0.0 else 0.0
            slip_x[i], slip_y[i] = to_slip_x[i] * slips * traction_x[i], to_slip_y[i] * slips * traction_y[i]
            traction_x[i] *= bound[i]
            traction_y[i] *= bound[i]
