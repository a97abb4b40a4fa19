"""Equivalent conicity of a wheelset from its rolling radius differences."""

from __future__ import annotations

import numpy as np
import scipy

import wearlaw as wl
from wearlaw import Array

NODES = 200
"""Nodes of the quadrature over a wave."""

_GAUSS, _WEIGHTS = np.polynomial.legendre.leggauss(NODES)


def equivalent_conicity(
    lateral_displacement: Array,
    rolling_radius_difference: Array,
    amplitude: float,
    tape_distance: float,
    nominal_radius: float,
) -> float:
    """Return the equivalent conicity, tan γe [-].

    A free wheelset at low speed follows y'' = -Δr(y)/(e r0) along the track. The equivalent conicity is that of the
    cones which have the same wavelength λ, by Klingel's formula: tan γe = 2 e r0 (π/λ)². The wave runs from y_min to
    y_max, which lie an amplitude of 2 ŷ apart; both are turning points, so that ∫Δr dy between them is zero. With
    ψ² = y'² = 2/(e r0) ∫Δr dy from y to y_max, the wavelength is λ = 2 ∫dy/ψ. Both ends are singular like an inverse
    square root, which the substitution y = (y_min + y_max)/2 + ŷ sin θ removes.

    Δr is a cubic spline through the table.

    Parameters
    ----------
    lateral_displacement : ndarray of float64, shape (n,)
        Lateral displacement of the wheelset from the middle of the track, y, growing [m].
    rolling_radius_difference : ndarray of float64, shape (n,)
        Difference of the rolling radii, Δr, positive where the wheelset steers back from y > 0 [m]: that of the right
        wheel minus that of the left one, with y to the right.
    amplitude : float
        Amplitude of the wave, ŷ [m].
    tape_distance : float
        Distance of the rolling circles, e [m].
    nominal_radius : float
        Nominal rolling radius, r0 [m].

    Raises
    ------
    InputError
        If the table is not one, the wave does not fit into it, or Δr does not steer the wheelset back.

    Notes
    -----
    Source: EN 15302, method by integration of the nonlinear differential equation.
    """
    y, difference = _table(lateral_displacement, rolling_radius_difference)
    for name, value in (
        ("amplitude", amplitude),
        ("tape_distance", tape_distance),
        ("nominal_radius", nominal_radius),
    ):
        if not 0.0 < value < np.inf:
            raise wl.InputError(f"{name}: must be positive and finite, got {value:g} m")
    if 2.0 * amplitude > (y[-1] - y[0]) * (1.0 + 1e-12):
        raise wl.InputError(
            f"amplitude: the wave is {2e3 * amplitude:.6g} mm wide, but the table has displacements from"
            f" {1e3 * y[0]:.6g} to {1e3 * y[-1]:.6g} mm; give a smaller amplitude or a wider table"
        )
    radius = scipy.interpolate.CubicSpline(y, difference)
    energy = radius.antiderivative()
    middle = _middle(radius, energy, amplitude, y)
    steering = energy(middle + amplitude)
    theta = 0.5 * np.pi * _GAUSS
    place = middle + amplitude * np.sin(theta)
    height = np.where(theta > 0.0, steering - energy(place), energy(middle - amplitude) - energy(place))
    inside = height / amplitude**2 / np.cos(theta) ** 2
    if not (inside > 0.0).all():
        worst = place[int(np.argmin(inside))]
        raise wl.InputError(
            f"rolling_radius_difference: does not steer the wheelset back through y = {1e3 * worst:.4g} mm, so that a"
            f" wave of amplitude {1e3 * amplitude:.4g} mm does not exist; try another amplitude"
        )
    # λ = 2 ∫dy/ψ with dy = ŷ cos θ dθ and ψ = ŷ cos θ √(2 inside/(e r0))
    quarter = 0.5 * np.pi * float((_WEIGHTS / np.sqrt(2.0 * inside)).sum())
    return float(2.0 * (0.5 * np.pi / quarter) ** 2)
