"""The normal problem: Hertz's theory of elliptic contact.

Two smooth bodies touch at a point, and their principal planes of curvature coincide: one plane holds the rolling
direction x, the other the lateral direction y. Without load, the gap between the bodies is z = A x² + B y². Under the
normal force N they touch in an ellipse with the semi-axes a along x and b along y.

With p = p0 √(1-(x/a)²-(y/b)²) and p0 = 3N/(2πab), the surfaces fit together inside the ellipse if

    A = N/(2πE*) R_D(0, b², a²),  B = N/(2πE*) R_D(0, a², b²),  δ = 3N/(2πE*) R_F(0, a², b²),

with the approach δ of the bodies. These are Hertz's equations in Carlson's symmetric elliptic integrals, which lose no
digits to cancellation at any axis ratio.

Sources: K. L. Johnson, Contact Mechanics, Cambridge University Press, 1985, after the source of the program CONTACT
(E. A. H. Vollebregt, src/m_hertz.f90), which has Legendre's integrals; B. C. Carlson, Numer. Algorithms 10 (1995)
13-26, for R_F and R_D. All values are in SI units. The effective modulus E* is that of `wearlaw.contact.hertz`.
"""

from __future__ import annotations

from typing import overload

import numpy as np
import scipy

from wearlaw.arrays import Array

_ITERATIONS = 10
"""Largest number of iterations; five are enough within the stated range of axis ratios."""


@overload
def curvature(radius_1: float, radius_2: float) -> float: ...
@overload
def curvature(radius_1: Array, radius_2: float | Array) -> Array: ...
@overload
def curvature(radius_1: float, radius_2: Array) -> Array: ...
def curvature(radius_1: float | Array, radius_2: float | Array) -> float | Array:
    """Return A = (1/R1 + 1/R2)/2 [1/m], half the relative curvature in one principal plane.

    Parameters
    ----------
    radius_1, radius_2 : ndarray or float
        Radii of curvature of the two bodies in that plane [m]; infinite where flat, negative where concave.
    """
    return 0.5 * (1.0 / radius_1 + 1.0 / radius_2)


def semi_axes(
    normal_force: float | Array,
    curvature_x: float | Array,
    curvature_y: float | Array,
    effective_modulus: float | Array,
) -> tuple[Array, Array]:
    """Return the semi-axes a along and b across the rolling direction [m].

    Parameters
    ----------
    normal_force : ndarray or float
        N [N].
    curvature_x, curvature_y : ndarray or float
        A and B of the gap A x² + B y² [1/m], both positive. The axis ratio is solved in their own common shape, so that
        a sweep over loads costs one solution for each pair of curvatures.
    effective_modulus : ndarray or float
        E* [Pa].

    Returns
    -------
    a, b : ndarray
        In the shape to which all arguments broadcast.
    """
    elongation = _elongation(curvature_x, curvature_y)
    # The curvature along the minor axis depends least on the elongation.
    shape = scipy.special.elliprd(0.0, elongation**2, 1.0) / np.maximum(curvature_x, curvature_y)
    minor = np.cbrt(normal_force / (2.0 * np.pi * effective_modulus) * shape)
    major = minor * elongation
    long = curvature_y >= curvature_x
    return np.where(long, major, minor), np.where(long, minor, major)


def max_pressure(normal_force: float | Array, a: Array, b: Array) -> Array:
    """Return p0 = 3N/(2πab) [Pa]."""
    return normal_force * (1.5 / np.pi) / (a * b)


def approach(normal_force: float | Array, a: Array, b: Array, effective_modulus: float | Array) -> Array:
    """Return δ [m], the approach of distant points of the two bodies."""
    distance: Array = normal_force * (1.5 / np.pi) / effective_modulus * scipy.special.elliprf(0.0, a**2, b**2)
    return distance


def pressure(x: Array, y: Array, a: Array, b: Array, max_pressure: Array) -> Array:
    """Return p = p0 √(1-(x/a)²-(y/b)²) [Pa] inside the ellipse, 0 outside."""
    half_length = a * np.sqrt(np.maximum((1.0 - y / b) * (1.0 + y / b), 0.0))  # at y
    inside = np.maximum((half_length - x) * (half_length + x), 0.0)
    return max_pressure / a * np.sqrt(inside)


def _elongation(curvature_x: float | Array, curvature_y: float | Array) -> Array:
    """Return the ratio of the major to the minor axis, which depends on the ratio of the curvatures alone.

    Newton's method in the logarithms solves B/A = R_D(0, a², b²) / R_D(0, b², a²). Their slope d ln(B/A) / d ln(a/b)
    rises from 3/2 for a circle towards 2 for a line, so the iteration converges from anywhere. The result is right to
    rounding for axis ratios from 1e-50 to 1e50; far beyond them the integrals underflow.
    """
    target = np.log(np.maximum(curvature_x, curvature_y) / np.minimum(curvature_x, curvature_y))
    # B. J. Hamrock and D. Brewe (1983) fit 1.0339 (B/A)^0.636. (B/A)^(2/π) is within 4 % up to ratios of 100.
    logarithm = target * (2.0 / np.pi)
    for _ in range(_ITERATIONS):
        value, slope = _log_curvature_ratio(logarithm)
        step = (target - value) / slope
        logarithm = logarithm + step
        if (np.abs(step) < 1e-8).all():  # convergence is quadratic, so the next step would be below rounding
            break
    elongation: Array = np.exp(logarithm)
    return elongation


def _log_curvature_ratio(log_elongation: Array) -> tuple[Array, Array]:
    """Return the logarithm of the ratio of the curvatures, and its derivative by the logarithm of the elongation."""
    square = np.exp(2.0 * log_elongation)
    across, along = scipy.special.elliprd(0.0, square, 1.0), scipy.special.elliprd(0.0, 1.0, square)
    near_circle = log_elongation < 1e-4  # there the difference has no digits, and the slope is 3/2 + O(logarithm²)
    mixed = (across - along) / np.where(near_circle, 1.0, square - 1.0)
    slope = np.where(near_circle, 1.5, 3.0 - mixed * (square / across + 1.0 / along))
    return np.log(across / along), slope
