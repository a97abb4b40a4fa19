"""The point where a strip of FASTSIM on an ellipse first slips.

A strip at y has the half length a_y = a √(1 - y²/b²) and the greatest bound g_y. Lengths are over a_y, and tractions
over g_y: U = 1 + X from the leading edge, V = 1 - X from the trailing edge. From the leading edge the traction grows
as U (P, R + S V), with dq/dX = (P, R - 2 S X); it slips where it first meets the bound U V (parabola) or √(U V)
(ellipse).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from wearlaw import Array


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
