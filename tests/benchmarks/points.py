"""The operating points of the benchmarks, and the mean wear rate there by a method that none of the rivals uses.

All arrays are SI: normal force [N], creepage [-], friction coefficient [-], wear rate [kg/m/m²].
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

import wearlaw as wl
from wearlaw import Array, Q

CREEPAGES = (1e-4, 0.3)
FORCES = (2e3, 9e3)
"""Up to 1.65 GPa on the standard rig."""
FRICTIONS = (0.2, 0.6)
DEFAULT_FORCE, DEFAULT_FRICTION = 7414.3, 0.46
"""Those of Tassini et al., Wear 268 (2010) 660-667: 1500 MPa on the standard rig."""

Predict = Callable[..., wl.Prediction]


class Parameters(NamedTuple):
    """The rig and the USFD parameters of Tassini et al. (2010), Table 4, in the order of rivals.c."""

    radius: float = 0.047 / 4
    modulus: float = 206.47742e9 / (2.0 * (1.0 - 0.28**2))
    width: float = 0.01
    m_m: float = 5.3e-9
    q_s: float = 0.055
    m_c: float = 83.7e-9
    tr_sc: float = 95e6


PARAMETERS = Parameters()


@dataclass(frozen=True)
class Points:
    """Operating points, one entry each."""

    force: Array
    creepage: Array
    friction: Array

    @property
    def count(self) -> int:
        return self.creepage.size

    def __getitem__(self, part: slice) -> Points:
        return Points(self.force[part], self.creepage[part], self.friction[part])

    def conditions(self) -> dict[str, Any]:
        """Return the conditions as a user gives them."""
        return {
            "normal_force": Q(self.force, "N"),
            "creepage": Q(self.creepage, ""),
            "friction_coefficient": self.friction,
        }


def workload(count: int) -> Points:
    """Return points that vary in everything."""
    rng = np.random.default_rng(20100301)
    creepage, force = (np.exp(rng.uniform(np.log(low), np.log(high), count)) for low, high in (CREEPAGES, FORCES))
    return Points(force, creepage, rng.uniform(*FRICTIONS, count))


def pipeline() -> Predict:
    """Return the prediction that is timed."""
    return wl.TwinDisc.suros() | wl.contact_model("exact") | wl.wear_law("usfd", fitted_for="exact")


def in_si(quantity: Any) -> Array:
    """Return a wear rate [kg/m/m²]."""
    values: Array = quantity.to("kg/m/m^2").magnitude
    return values


def reference(points: Points) -> Array:
    """Return the mean wear rate by Gauss-Legendre quadrature in θ between bisected breakpoints, t = sin θ.

    In θ the wear-index density w = C (A + h sin θ) cos θ is entire, so the rule is exact to rounding in each panel.
    """
    block = 4096
    return np.concatenate([_reference(points[first : first + block]) for first in range(0, points.count, block)])


def _reference(points: Points) -> Array:
    p = PARAMETERS
    load = points.force / p.width
    half_width = np.sqrt(4.0 * load * p.radius / (math.pi * p.modulus))
    saturation = points.friction * half_width / p.radius
    d = points.creepage / saturation
    h, a = np.minimum(d, 1.0), np.maximum(2.0 - d, d)
    scale = points.friction * 2.0 * load / (math.pi * half_width) * saturation * h

    def density(theta: Array) -> Array:
        w: Array = scale * (a + h * np.sin(theta)) * np.cos(theta)
        return w

    end = np.full(d.shape, 0.5 * math.pi)
    peak = np.arcsin(2.0 * h / (a + np.sqrt(a * a + 8.0 * h * h)))
    splits = [_bisect(density, side, peak, level) for level in (p.q_s / p.m_m, p.tr_sc) for side in (-end, end)]
    edges = np.sort([-end, *splits, end], axis=0)
    mean = np.zeros_like(d)
    for low, high in itertools.pairwise(edges):
        middle, half = 0.5 * (low + high), 0.5 * (high - low)
        for node, weight in zip(*np.polynomial.legendre.leggauss(24), strict=True):
            theta = middle + half * node
            w = density(theta)
            rates = np.minimum(p.m_m * w, p.q_s) + p.m_c * np.maximum(w - p.tr_sc, 0.0)
            mean += 0.5 * h * half * weight * rates * np.cos(theta)
    return mean


def _bisect(function: Callable[[Array], Array], low: Array, high: Array, level: float) -> Array:
    """Return where a rising function passes a level, or the upper end where it stays below."""
    for _ in range(60):
        middle = 0.5 * (low + high)
        below = function(middle) < level
        low, high = np.where(below, middle, low), np.where(below, high, middle)
    return high
