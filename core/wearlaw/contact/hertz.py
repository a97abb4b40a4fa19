"""The normal problem: Hertz's theory of line contact.

Source: K. L. Johnson, Contact Mechanics, Cambridge University Press, 1985, section 4.2(c), after Tassini et al.,
Wear 268 (2010) 660-667, eqs. (1) and (2), of which (1) is misprinted. All values are in SI units; the normal force P is
per unit width.
"""

from __future__ import annotations

import numpy as np

from wearlaw.arrays import Array


def relative_radius(radius_1: float, radius_2: float) -> float:
    """Return R [m] of 1/R = 1/R1 + 1/R2; a flat body has an infinite radius (Johnson, eq. 4.3)."""
    return 1.0 / (1.0 / radius_1 + 1.0 / radius_2)


def effective_modulus(
    youngs_modulus_1: float, poisson_ratio_1: float, youngs_modulus_2: float, poisson_ratio_2: float
) -> float:
    """Return E* [Pa] of 1/E* = (1-ν1²)/E1 + (1-ν2²)/E2 (Johnson, eq. 4.17)."""
    compliance = (1.0 - poisson_ratio_1**2) / youngs_modulus_1
    return 1.0 / (compliance + (1.0 - poisson_ratio_2**2) / youngs_modulus_2)


def mean_poisson_ratio(
    youngs_modulus_1: float, poisson_ratio_1: float, youngs_modulus_2: float, poisson_ratio_2: float
) -> float:
    """Return ν [-] of like bodies equivalent to unlike ones: ν/G = (ν1/G1 + ν2/G2)/2, where 1/G = (1/G1 + 1/G2)/2.

    With these means, G/(1-ν) is the E* of the unlike bodies, because (1-ν²)/E = (1-ν)/(2G) for each body. The mean of
    two like bodies has every digit of theirs.
    """
    softness_1, softness_2 = (1.0 + poisson_ratio_1) / youngs_modulus_1, (1.0 + poisson_ratio_2) / youngs_modulus_2
    both = softness_1 + softness_2
    return poisson_ratio_1 * (softness_1 / both) + poisson_ratio_2 * (softness_2 / both)


def mean_shear_modulus(shear_modulus_1: float, shear_modulus_2: float) -> float:
    """Return G [Pa] of like bodies equivalent to unlike ones: 1/G = (1/G1 + 1/G2)/2, as in `mean_poisson_ratio`."""
    return shear_modulus_1 * (2.0 * shear_modulus_2 / (shear_modulus_1 + shear_modulus_2))


def half_width(normal_force_per_width: Array, radius: float | Array, modulus: float | Array) -> Array:
    """Return a [m] of a² = 4 P R / (π E*) (Johnson, eq. 4.43)."""
    width: Array = np.sqrt(normal_force_per_width * (4.0 * radius / (np.pi * modulus)))
    return width


def max_pressure(normal_force_per_width: Array, half_width: Array) -> Array:
    """Return p0 = 2 P / (π a) [Pa] (Johnson, eq. 4.45)."""
    return normal_force_per_width * (2.0 / np.pi) / half_width


def force_from_max_pressure(max_pressure: Array, radius: float, modulus: float) -> Array:
    """Return P = π p0² R / E* [N/m], the load that gives the maximum pressure p0 (Johnson, eq. 4.45)."""
    return np.pi * max_pressure**2 * radius / modulus


def pressure(x: Array, half_width: Array, max_pressure: Array) -> Array:
    """Return p = p0 √(1-(x/a)²) [Pa] inside the patch, 0 outside (Johnson, eq. 4.44).

    The product (a-x)(a+x) keeps full precision next to the edges.
    """
    inside = np.maximum((half_width - x) * (half_width + x), 0.0)
    return max_pressure * np.sqrt(inside) / half_width


def distances_at_pressure(pressure: Array, half_width: Array, max_pressure: Array) -> Array:
    """Return the distances from an edge with a given pressure [m], of shape (..., 2); NaN if no point has it."""
    share = np.where(pressure <= max_pressure, pressure / max_pressure, np.nan)
    x = np.sqrt((1.0 - share) * (1.0 + share))
    return half_width[..., None] * np.stack([share**2 / (1.0 + x), 1.0 + x], axis=-1)
