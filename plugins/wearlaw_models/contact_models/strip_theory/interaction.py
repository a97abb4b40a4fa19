"""What strips displace of each other on half-spaces: the slip at which they slip all over, and energy they exchange.

In full slip the traction of a strip is g √(1-(x/a)²). The displacement by it is even in x, and Cerruti's solution gives
its curvature at x = 0 in closed form. A narrow strip of the width w at the distance y, with η = y/a, m = 1/(1+η²) and
the complete elliptic integrals K and E of the parameter m, adds

    -∂²u_x/∂x² = g w/(πG a²) [G_K - ν G_E],  -∂²u_y/∂x² = g w/(πG a²) [(1-ν) G_K + ν G_E],

with G_K = 2 √m (K - E), from the kernel 1/r, whose partial integration over x leaves ∫ sin²θ/(sin²θ+η²)^(3/2) dθ, and
G_E = 2 √m (m E + (1-m) (K - E)), from y²/r³. Their integrals over η are P_K = 2η√m K and P_E = 2η√m E, which are those
of a strip over its own middle. The sum over all strips, times the half length, is the slip k at which a strip slips all
over. On an ellipse k is a constant times the half length, but not quite that of Kalker's stiffness for small creepage.
So it is scaled by the quotient of both on the ellipse with the patch's area and length.

Where one strip sticks further back than another one, or tractions lie along x and y, the strips feed energy to each
other. With the forces F and the first moments M = ∫ x q dx of both, and kernels as in the middle of a strip, strip i
gains

    Σ_j 2/(π²G a³) [Σ_x,y G (M_i F_j - M_j F_i) - ν G_K (y_j - y_i) (F_xi F_yj + F_yi F_xj)],  a² = (a_i² + a_j²)/2,

with G for x and for y as above. What one strip gains another one loses: the patch keeps its energy and all forces.
"""

from __future__ import annotations

from functools import cache

import numpy as np
import scipy

import wearlaw as wl
from wearlaw import Array
from wearlaw_models.contact_models.strip_theory import loops as loops
from wearlaw_models.contact_models.strip_theory.loops import KNOTS, TINY

ACROSS = 16
"""Strips of half an ellipse; with these its sums are right to 0.15 % for a/b from 0.1 to 10."""

PAIRS = 16
"""Pairs of strips that take about as long as one operating point in the count of `accelerated`."""

ROUNDS = 8
"""How often a rig with strips of its own asks for their forces, to judge whether compiled loops are worth while."""


def full_slips(flat: wl.Problem, layout: wl.Strips, greatest: Array, c11: Array, c22: Array) -> tuple[Array, Array]:
    """Return k along x and along y, (strips, points), of strips with the greatest bounds g."""
    nu, scale = flat.poisson_ratio, 0.5 * np.pi**2 / flat.shear_modulus
    (own_k, own_e), (of_ellipse_k, of_ellipse_e) = _curvatures(layout, greatest), _of_ellipse(flat.a / flat.b)
    along = (own_k - nu * own_e) * (scale / (c11 * (of_ellipse_k - nu * of_ellipse_e)))
    across = (1.0 - nu) * own_k + nu * own_e
    return along, across * (scale / (c22 * ((1.0 - nu) * of_ellipse_k + nu * of_ellipse_e)))


def _curvatures(layout: wl.Strips, greatest: Array) -> Array:
    """Return a Σ g w/a² G_K and a Σ g w/a² G_E at the middle of each strip, (2, strips, points)."""
    y, width = layout.y, layout.width
    half_length = np.where(greatest > 0.0, layout.half_length, 1.0)  # that of a strip without pressure may be zero
    sums = greatest / half_length * np.stack(_up_to(0.5 * width / half_length)) * 2.0
    weight = greatest * width / half_length**2
    if wl.accelerated(ROUNDS * y.shape[0] * y.size // PAIRS):
        loops.others_loop(y, half_length, weight, _table(), sums)
    else:
        diagonal = np.arange(len(y))
        for to, kernel in zip(sums, loops.between(loops.place(y - y[:, None], half_length), _table()), strict=True):
            kernel[diagonal, diagonal] = 0.0
            to += (weight * kernel).sum(axis=1)
    return np.asarray(half_length * sums)


def exchanged(flat: wl.Problem, layout: wl.Strips, totals: Array) -> Array:
    """Return the energy that each strip gains from the others per metre rolled [N], (strips, points).

    The totals are F_x, F_y, M_x and M_y of the strips, (4, strips, points).
    """
    y, gains, nu = layout.y, np.zeros_like(layout.y), flat.poisson_ratio
    square = np.where(layout.max_pressure > 0.0, layout.half_length, 1.0) ** 2
    if wl.accelerated(y.shape[0] * y.size // PAIRS):
        loops.exchange_loop(y, square, nu + np.zeros(y.shape[1]), totals, _table(), gains)
    else:
        for at in range(len(y) - 1):
            half_length, apart = np.sqrt(0.5 * (square[at] + square[at + 1 :])), y[at + 1 :] - y[at]
            kernels = loops.between(loops.place(apart, half_length), _table())
            strip, others = totals[:, at], totals[:, at + 1 :]
            gained = loops.gained(kernels, nu, half_length, apart, tuple(strip), tuple(others))
            gains[at] += gained.sum(axis=0)
            gains[at + 1 :] -= gained
    return gains * (2.0 / (np.pi**2 * flat.shear_modulus))


def _of_ellipse(ratio: Array) -> tuple[Array, ...]:
    """Return the sums of `_curvatures` in the middle of ellipses, over g there."""
    angle = 0.25 * np.pi / ACROSS * np.arange(2 * ACROSS + 1)
    ends, half_length = np.sin(angle[::2, None]), np.multiply.outer(np.cos(angle[1::2]), ratio)
    first, last = _up_to(ends[:-1] / half_length), _up_to(ends[1:] / half_length)
    return tuple(2.0 * (end - start).sum(axis=0) for start, end in zip(first, last, strict=True))


def _up_to(eta: Array) -> tuple[Array, Array]:
    """Return P_K and P_E from 0 to η."""
    square = eta * eta / (1.0 + eta * eta)
    z = np.sqrt(square)
    return 2.0 * z * scipy.special.ellipkm1(np.maximum(square, TINY)), 2.0 * z * scipy.special.ellipe(1.0 - square)


@cache
def _table() -> Array:
    """Return G_K and G_E at even steps of η/√(1+η²) from 0 to 1; at zero, where both strips are one, a finite value."""
    z = np.maximum(np.arange(KNOTS + 1), 1) / KNOTS
    k, e, m = scipy.special.ellipkm1(z**2), scipy.special.ellipe(1.0 - z**2), np.maximum(1.0 - z**2, 0.0)
    table: Array = 2.0 * np.sqrt(m) * np.stack([k - e, m * e + z**2 * (k - e)])
    return table
