"""Equivalent conicity of a wheelset from its rolling radius differences."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import scipy
from numpy.typing import ArrayLike

import wearlaw as wl
from wearlaw import Array

NODES = 2000
"""Nodes of the midpoint rule over half a wave, which is spectral: the integrand is periodic."""
WAVES = 1001
"""Middles of the wave among which the turning points are looked for."""
ROUNDING = 1e-12
"""Share of the largest value that is zero but for rounding."""
NOTHING = 1e-9
"""A rolling radius difference that is zero but for the accuracy of contact points [m]."""


def equivalent_conicity(
    lateral_displacement: ArrayLike, rolling_radius_difference: ArrayLike, amplitude: float
) -> float:
    """Return the equivalent conicity, tan γe [-].

    A free wheelset at low speed follows y'' = -Δr(y)/(e r0) along the track, with the distance e of the rolling circles
    and the nominal radius r0. The equivalent conicity is that of the cones with the same wavelength λ, by Klingel's
    formula: tan γe = 2 e r0 (π/λ)².

    Half a wave runs from y_min to y_max = y_min + 2ŷ. Both are turning points, so ∫Δr dy between them is zero. With
    y'² = 2/(e r0) ∫Δr dy from y to y_max, the wavelength is λ = 2 ∫dy/y'. The substitution y = (y_min + y_max)/2 +
    ŷ sin θ removes the singularities at both ends. The conicity depends neither on e nor on r0, which cancel. It is
    zero where Δr is zero all along the wave.

    Parameters
    ----------
    lateral_displacement : array_like of float, shape (n,)
        Lateral displacements of the wheelset, y, growing [m].
    rolling_radius_difference : array_like of float, shape (n,)
        Rolling radius of the wheel on the side of positive y minus that of the other one, Δr [m]. It is monotone where
        the table is, and has no overshoot: a cubic Hermite interpolation after Fritsch and Butland (1984).
    amplitude : float
        Amplitude of the wave, ŷ [m].

    Raises
    ------
    InputError
        If the wave does not fit into the table, Δr is nowhere zero, or it does not steer the wheelset back.

    Notes
    -----
    Source: Klingel's equation integrated, as in Annex B of EN 15302; J. Klingel, Organ für die Fortschritte des
    Eisenbahnwesens 20 (1883) 113-123. If more than one wave has this amplitude, as with a Δr that has several zeros, it
    is the one nearest to y = 0. Wheels of unequal radii move about the displacement at which Δr vanishes: count y from
    there.
    """
    y, difference = np.asarray(lateral_displacement), np.asarray(rolling_radius_difference)
    if 2.0 * amplitude > (y[-1] - y[0]) * (1.0 + ROUNDING):
        raise wl.InputError(
            f"amplitude: a wave of {1e3 * amplitude:.6g} mm is {2e3 * amplitude:.6g} mm wide, but the displacements"
            f" reach from {1e3 * y[0]:.6g} to {1e3 * y[-1]:.6g} mm; give a smaller amplitude or a wider table"
        )
    near = np.abs(y) <= amplitude * (1.0 + ROUNDING)
    if near.any() and np.abs(difference[near]).max() <= NOTHING:
        return 0.0
    if not (difference.min() < 0.0 < difference.max()):
        raise wl.InputError(
            f"rolling_radius_difference: must change its sign, but lies between {1e3 * difference.min():.4g} and"
            f" {1e3 * difference.max():.4g} mm, so the wheelset runs to one side; give a table with both sides"
        )
    theta = np.pi * ((np.arange(NODES) + 0.5) / NODES - 0.5)
    return float(0.5 / np.mean(1.0 / np.sqrt(wave(y, difference, amplitude, theta).stiffness)) ** 2)


class Wave(NamedTuple):
    """A wave y = y_m + ŷ sin θ between two turning points."""

    place: Array
    """Displacements, y [m]."""
    stiffness: Array
    """(y'/(ŷ cos θ))², in the unit of the restoring difference over metres: a constant where that is linear."""


def wave(y: Array, difference: Array, amplitude: float, theta: Array) -> Wave:
    """Return the wave of y'' = -`difference`(y) with an amplitude [m], at angles [rad].

    Raises
    ------
    InputError
        If no wave fits into the table, or the difference does not steer the wheelset back.
    """
    energy = scipy.interpolate.PchipInterpolator(y, difference).antiderivative()
    middle = _middle(energy, amplitude, y)
    place = np.clip(middle + amplitude * np.sin(theta), y[0], y[-1])
    ends = [energy(np.clip(middle + side * amplitude, y[0], y[-1])) for side in (-1.0, 1.0)]
    height = np.where(np.sin(theta) < 0.0, ends[0], ends[1]) - energy(place)
    stiffness = 2.0 * height / (amplitude * np.cos(theta)) ** 2
    if not (stiffness > 0.0).all():
        worst = float(place[int(np.argmin(stiffness))])
        raise wl.InputError(
            f"rolling_radius_difference: does not steer the wheelset back across y = {1e3 * worst:.4g} mm, so there is"
            f" no wave with an amplitude of {1e3 * amplitude:.6g} mm; try another amplitude"
        )
    return Wave(place, stiffness)


def _middle(energy: Any, amplitude: float, y: Array) -> float:
    """Return the middle between the turning points: ∫Δr dy from one to the other is zero."""

    def excess(middle: Any) -> Any:
        return energy(np.minimum(middle + amplitude, y[-1])) - energy(np.maximum(middle - amplitude, y[0]))

    low, high = y[0] + amplitude, y[-1] - amplitude
    middles = np.linspace(low, max(low, high), WAVES)
    values = excess(middles)
    values[np.abs(values) <= ROUNDING * np.ptp(energy(y))] = 0.0
    roots = middles[values == 0.0].tolist()
    # From the left, a turning point is stable where the integral rises through zero.
    for first in np.flatnonzero((values[:-1] < 0.0) & (values[1:] > 0.0)):
        roots.append(scipy.optimize.brentq(excess, middles[first], middles[first + 1], xtol=1e-15))
    if not roots:
        raise wl.InputError(
            f"amplitude: no wave of {1e3 * amplitude:.6g} mm fits between {1e3 * y[0]:.6g} and {1e3 * y[-1]:.6g} mm,"
            " because the rolling radius difference is larger on one side; give a wider table or a smaller amplitude"
        )
    return float(min(roots, key=abs))
