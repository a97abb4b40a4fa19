"""The energy that FASTSIM dissipates above a threshold, against integrals in fifty digits."""

from __future__ import annotations

from collections.abc import Callable

import mpmath  # type: ignore[import-untyped]
import numpy as np
import pytest

from tests.plugins.excess import DIGITS, Density, Real, copies, crowded, shares
from tests.strategies import EPS
from wearlaw import Array
from wearlaw_models.contact_models.fastsim.line import (  # private: of single points and of arrays
    elliptic_excess,
    parabolic_excess,
)


def parabolic(reduced: Real) -> Density:
    """Return q·s/(μp2(0) g): bound 1 - (x/a)² = v (2-v), and slip ξ/g + x/a = d + 1 - v, if g is the bound's slope."""
    with mpmath.workdps(DIGITS):
        d = mpmath.mpf(reduced)
        end = 2 * min(d, 1)
        return Density(lambda v: v * (2 - v) * (1 + d - v), min(1 - (mpmath.sqrt(d * d + 3) - d) / 3, end), end)


def elliptic(reduced: Real) -> Density:
    """Return q·s/(μp2(0) g): bound √(v (2-v)), slip d + (1-v)/√(v (2-v)), over v < 2d²/(1+d²)."""
    with mpmath.workdps(DIGITS):
        d = mpmath.mpf(reduced)
        square = d * d
        return Density(
            lambda v: d * mpmath.sqrt(abs(v * (2 - v))) + 1 - v,
            square / (1 + square + mpmath.sqrt(1 + square)),
            2 * square / (1 + square),
        )


KERNELS = {"parabolic": copies(parabolic_excess), "elliptic": copies(elliptic_excess)}
DENSITIES: dict[str, Callable[[Real], Density]] = {"parabolic": parabolic, "elliptic": elliptic}

ROUNDINGS = {"parabolic": 6 * 4 * 0.5 * EPS, "elliptic": 8 * 0.5 * EPS}
"""Error as a share of the whole dissipation.

Parabola: the antiderivative is a difference of terms six times as great at full slip, 8 - 20/3 = 4/3, with four
roundings each. Ellipse: terms no greater than the whole, which is their sum, or than π/2 of it.
"""

every_bound = pytest.mark.parametrize("bound", KERNELS)
every_copy = pytest.mark.parametrize(
    ("bound", "copy"), [(bound, copy) for bound, found in KERNELS.items() for copy in found]
)


def whole(bound: str, reduced: Array) -> Array:
    """Return the whole dissipation T ξ over a μp2(0) g, of the forces in Tassini et al. (2010), section 3.2.2."""
    if bound == "parabolic":
        d = np.minimum(reduced, 1.0)
        share: Array = 4.0 / 3.0 * d * (3.0 - 3.0 * d + d * d)
    else:
        share = np.arctan(reduced) + reduced / (1.0 + reduced * reduced)
    return reduced * share


def apply(bound: str, copy: str, reduced: Array, level: Array) -> Array:
    """Return the results of a copy of the kernel in units where g, μp2(0) and a are one."""
    return KERNELS[bound][copy](reduced, *[np.ones_like(reduced)] * 3, level)


def sample(bound: str, seed: int, size: int) -> tuple[Array, Array, list[Density]]:
    """Return reduced creepages and thresholds, a third of these next to the density where slip begins."""
    random = np.random.default_rng(seed)
    reduced = crowded(random, size)
    random.shuffle(reduced)
    densities = [DENSITIES[bound](d) for d in reduced]
    with mpmath.workdps(DIGITS):
        at_border = np.array([float(abs(each.at(each.end))) for each in densities])
    level = shares(random, size) * [each.peak for each in densities]
    gap = 10.0 ** random.uniform(-15.0, -1.0, size) * random.choice([-1.0, 0.0, 1.0], size)
    close = (np.arange(size) % 3 == 0) & (at_border > 0.0)
    return reduced, np.where(close, at_border * (1.0 + gap), level), densities


@pytest.mark.validates(
    "integration",
    "The closed forms of the energy that `fastsim` dissipates above a threshold",
    source="mpmath quadrature in 50 digits",
    held_to="{parabolic:.1e} (parabolic), {elliptic:.1e} (elliptic) of the whole dissipation",
    parabolic=ROUNDINGS["parabolic"],
    elliptic=ROUNDINGS["elliptic"],
)
@every_bound
def test_the_energy_above_a_threshold_is_its_integral(bound: str, parabolic: float, elliptic: float) -> None:
    reduced, level, densities = sample(bound, 51, 45)
    expected = np.array([float(each.excess(at)) for each, at in zip(densities, level, strict=True)])
    for copy in KERNELS[bound]:
        error = np.abs(apply(bound, copy, reduced, level) - expected)
        assert (error <= {"parabolic": parabolic, "elliptic": elliptic}[bound] * whole(bound, reduced)).all(), copy
    assert np.ptp(expected / whole(bound, reduced)) > 0.99  # thresholds leave all of it, and nearly nothing


@every_copy
def test_just_below_the_maximum_nothing_is_negative_and_above_it_all_is_zero(bound: str, copy: str) -> None:
    random = np.random.default_rng(59)
    # just below 1/4 the slip zone of the parabola begins next to the maximum
    reduced = np.append(crowded(random, 500), 0.25 - 10.0 ** random.uniform(-15.0, -9.0, 500))
    peaks = np.array([DENSITIES[bound](d).peak for d in reduced])
    below = np.append(10.0 ** random.uniform(-14.0, -8.0, 500), np.zeros(500))
    assert (apply(bound, copy, reduced, peaks * (1.0 - below)) >= 0.0).all()
    above = 10.0 ** random.uniform(np.log10(8.0 * EPS), 3.0, reduced.size)  # of a product of three sums
    assert (apply(bound, copy, reduced, peaks * (1.0 + above)) == 0.0).all()


@every_copy
def test_a_threshold_next_to_nothing_leaves_the_whole_dissipation(bound: str, copy: str) -> None:
    reduced = np.append(crowded(np.random.default_rng(53), 1_000), 1.0)
    for level in (0.0, 1e-40, 1e-300):
        error = np.abs(apply(bound, copy, reduced, np.full_like(reduced, level)) - whole(bound, reduced))
        assert (error <= (ROUNDINGS[bound] + 4 * EPS) * whole(bound, reduced)).all()  # eight are of the test


@every_copy
def test_values_in_si_are_reduced_by_the_slope_of_the_bound(bound: str, copy: str) -> None:
    random = np.random.default_rng(55)
    reduced, level, _ = sample(bound, 56, 100)
    slope, centre, half_width = (random.uniform(*limits, 100) for limits in ((1e-3, 0.1), (1e8, 4e9), (1e-4, 1e-2)))
    found = KERNELS[bound][copy](reduced * slope, slope, centre, half_width, level * slope * centre)
    error = np.abs(found / (slope * centre * half_width) - apply(bound, copy, reduced, level))
    # Less than twenty roundings make d, of which the energy is the square at most, the level and the quotient.
    assert (error <= (2.0 * ROUNDINGS[bound] + 2 * 20 * 0.5 * EPS) * whole(bound, reduced)).all()
