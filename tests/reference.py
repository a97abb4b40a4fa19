"""Line-contact solutions and patch means written anew for the tests, from the literature and not from the plugins.

All fields are functions of v = (a - x)/a, the distance from the trailing edge in half widths, in which nothing
cancels: 0 at the trailing edge, 2 at the leading edge. Pressures are in Pa, the load P is per unit width.

Sources: K. L. Johnson, Contact Mechanics, 1985, section 4.2; F. W. Carter, Proc. R. Soc. A 112 (1926) 151-157, and
J. J. Kalker, Vehicle System Dynamics 11 (1982) 1-13, after Tassini et al., Wear 268 (2010) 660-667.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy import integrate, optimize

Field = Callable[[Any], Any]
"""A function of v."""


def brentq(function: Callable[[float], Any], low: float, high: float, **options: Any) -> float:
    """Return where a function passes zero between two places at which it has different signs, by Brent's method."""
    found: Any = optimize.brentq(function, low, high, **options)
    return float(found)


@dataclass(frozen=True)
class Point:
    """One operating point, for creepage above zero."""

    load: float
    radius: float
    modulus: float
    friction: float
    creepage: float
    speed: float = 1.0

    @property
    def half_width(self) -> float:
        return math.sqrt(4.0 * self.load * self.radius / (math.pi * self.modulus))

    @property
    def max_pressure(self) -> float:
        return 2.0 * self.load / (math.pi * self.half_width)

    @property
    def exact_saturation(self) -> float:
        """ξ_sat = μa/R."""
        return self.friction * self.half_width / self.radius

    def pressure(self, v: Any) -> Any:
        return self.max_pressure * np.sqrt(v * (2.0 - v))


@dataclass(frozen=True)
class Solution:
    """Traction and slip in the slip zone 0 ≤ v ≤ border, the peak of q·s there, and T per unit width."""

    point: Point
    border: float
    traction: Field
    slip: Field
    peak: float
    force: float

    def density(self, v: Any) -> Any:
        """Return q·s [N/m²]."""
        return self.traction(v) * self.slip(v)

    def density_crossings(self, value: float) -> list[float]:
        """Return where q·s, which rises and falls at most once, passes a value."""
        ends = [self.border * 1e-30, min(self.peak, self.border), self.border]
        signs = [self.density(v) - value for v in ends]
        return [
            brentq(lambda v: self.density(v) - value, low, high, xtol=1e-300, rtol=1e-15)
            for low, high, at_low, at_high in zip(ends, ends[1:], signs, signs[1:], strict=False)
            if at_low * at_high < 0.0
        ]

    def pressure_crossings(self, value: float) -> list[float]:
        """Return where p = p0 √(1-(x/a)²) passes a value."""
        if value >= self.point.max_pressure:
            return []
        root = math.sqrt(1.0 - (value / self.point.max_pressure) ** 2)
        return [1.0 - root, 1.0 + root]

    def slip_crossings(self, value: float) -> list[float]:
        """Return where the slip, which falls with v, passes a value."""
        high, low = self.slip(self.border * 1e-30), self.slip(self.border)
        if not low < value < high:
            return []
        return [
            brentq(
                lambda v: self.slip(v) - value, self.border * 1e-30, self.border, xtol=1e-300, rtol=1e-15, maxiter=500
            )
        ]

    def mean(self, integrand: Field, breaks: Iterable[float] = ()) -> float:
        """Return ∫ integrand dx/(2a) over the slip zone by tanh-sinh quadrature, split at the breaks.

        Tanh-sinh keeps its full precision with the square roots that fields have at the ends of a panel.
        """
        edges = np.array([0.0, *sorted(v for v in breaks if 0.0 < v < self.border), self.border])
        panels = integrate.tanhsinh(integrand, edges[:-1], edges[1:], rtol=1e-13)
        return 0.5 * float(panels.integral.sum())


def exact(point: Point, *, as_printed: bool = False) -> Solution:
    """Return Carter's solution in the slip zone; `as_printed` with the slip of eq. (7) of Tassini et al."""
    saturation = point.exact_saturation
    d = point.creepage / saturation
    bound = point.friction * point.max_pressure

    def traction(v: Any) -> Any:
        return bound * np.sqrt(v * (2.0 - v))

    def full(v: Any) -> Any:
        return point.creepage + saturation * (1.0 - v)

    def partial(v: Any) -> Any:
        # s = k √((x+a-c)² - c²) with c = a(1-d): the two factors are a(2d - v) and a(2 - v).
        return saturation * np.sqrt(np.maximum(2.0 * d - v, 0.0) * (2.0 - v))

    force = point.friction * point.load * (1.0 - (1.0 - min(d, 1.0)) ** 2)
    if d < 1.0 and not as_printed:
        # d/dv of √(v(2d-v)) (2-v) is zero where 2v² - (2+3d)v + 2d = 0.
        peak = (2.0 + 3.0 * d - math.sqrt((2.0 + 3.0 * d) ** 2 - 16.0 * d)) / 4.0
        return Solution(point, 2.0 * d, traction, partial, peak, force)
    # d/dt of √(1-t²) (d+t) is zero where 2t² + dt - 1 = 0.
    peak = 1.0 - (-d + math.sqrt(d * d + 8.0)) / 4.0
    return Solution(point, min(2.0 * d, 2.0), traction, full, peak, force)


def parabolic(point: Point, *, kalker: bool = False) -> Solution:
    """Return the slip zone of FASTSIM with a parabolic bound."""
    compliance = (32.0 / (3.0 * math.pi**2) if kalker else 4.0 / math.pi) * point.half_width / point.modulus
    top = point.friction * 0.75 * point.load / point.half_width
    saturation = 2.0 * compliance * top / point.half_width
    d = point.creepage / saturation
    # d/dt of (1-t²)(d+t) is zero where 3t² + 2dt - 1 = 0.
    peak = 1.0 - (-d + math.sqrt(d * d + 3.0)) / 3.0
    force = point.friction * point.load * (1.0 - (1.0 - min(d, 1.0)) ** 3)
    return Solution(
        point,
        min(2.0 * d, 2.0),
        lambda v: top * v * (2.0 - v),
        lambda v: point.creepage + saturation * (1.0 - v),
        peak,
        force,
    )


def elliptic(point: Point, *, kalker: bool = False) -> Solution:
    """Return the slip zone of FASTSIM with Hertz's ellipse as bound."""
    compliance = (32.0 / (3.0 * math.pi**2) if kalker else 4.0 / math.pi) * point.half_width / point.modulus
    top = point.friction * point.max_pressure
    steepness = compliance * top / point.half_width
    kappa = point.creepage / steepness
    peak = 1.0 - 1.0 / math.hypot(kappa, 1.0)  # of ξ√(1-t²) + steepness·t
    share = 2.0 / math.pi * (math.atan(kappa) + kappa / (1.0 + kappa**2))
    return Solution(
        point,
        2.0 * kappa**2 / (1.0 + kappa**2),
        lambda v: top * np.sqrt(v * (2.0 - v)),
        lambda v: point.creepage + steepness * (1.0 - v) / np.sqrt(v * (2.0 - v)),
        peak,
        point.friction * point.load * share,
    )


def usfd_mean(solution: Solution, m_m: float, q_s: float, m_c: float, transition: float) -> float:
    """Return the patch mean of the USFD law [µg/m/mm²], Tables 3 and 4 of Tassini et al.

    The parameters are in their printed units: µg/m/N, µg/m/mm², µg/m/N, N/mm².
    """

    def rate(v: Any) -> Any:
        w = solution.density(v) / 1e6
        return np.where(w < q_s / m_m, m_m * w, np.where(w < transition, q_s, m_c * w - (m_c * transition - q_s)))

    breaks = [v for w in (q_s / m_m, transition) for v in solution.density_crossings(w * 1e6)]
    return solution.mean(rate, breaks)


def kth_mean(solution: Solution, k: tuple[float, float, float, float], hardness: float = 2.625e9) -> float:
    """Return the patch mean of the KTH map [µg/m/mm²] at 7850 kg/m³, Table 2 of Tassini et al.

    `k` is (p ≥ 2.1 GPa; sV < 0.2 m/s; 0.2 to 0.7 m/s; above).
    """
    point = solution.point

    def rate(v: Any) -> Any:
        p, slip = point.pressure(v), solution.slip(v)
        speed = slip * point.speed
        coefficient = np.where(p >= 2.1e9, k[0], np.where(speed < 0.2, k[1], np.where(speed < 0.7, k[2], k[3])))
        return 7850.0 * coefficient * p * slip / hardness * 1e3  # kg/m/m² to µg/m/mm²

    breaks = [v for speed in (0.2, 0.7) for v in solution.slip_crossings(speed / point.speed)]
    return solution.mean(rate, [*breaks, *solution.pressure_crossings(2.1e9)])
