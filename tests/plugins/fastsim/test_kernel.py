"""The energy that FASTSIM dissipates above a threshold, against integrals in fifty digits."""

from __future__ import annotations

import functools
from collections.abc import Callable

import mpmath  # type: ignore[import-untyped]
import numpy as np
import pytest

from tests.plugins.excess import DIGITS, Density, Real, copies, crowded, shares
from tests.strategies import EPS
from wearlaw import Array
from wearlaw_fastsim._line import elliptic_excess, parabolic_excess  # private: of single points and of arrays


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


@functools.cache
def in_si(bound: str) -> tuple[tuple[Array, ...], Array, Array]:
    """Return the arguments of a kernel, the energy above the thresholds among them, and the whole energy."""
    random = np.random.default_rng(55)
    reduced, level, _ = sample(bound, 56, 15)
    slope, centre = random.uniform(1e-3, 0.1, 15), random.uniform(1e8, 4e9, 15)
    arguments = (reduced * slope, slope, centre, random.uniform(1e-4, 1e-2, 15), level * slope * centre)
    expected, most = [], []
    with mpmath.workdps(DIGITS):
        for xi, g, top, a, at in ([mpmath.mpf(value) for value in row] for row in zip(*arguments, strict=True)):
            each = DENSITIES[bound](xi / g)
            expected.append(float(g * top * a * each.excess(at / (g * top))))
            most.append(float(g * top * a * each.excess(0.0)))
    return arguments, np.array(expected), np.array(most)


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
def test_what_is_not_above_the_maximum_is_zero(bound: str, copy: str) -> None:
    random = np.random.default_rng(52)
    reduced = crowded(random, 200)
    gap = 10.0 ** random.uniform(np.log10(8.0 * EPS), 3.0, reduced.size)  # of a product of three sums
    level = np.array([DENSITIES[bound](d).peak for d in reduced]) * (1.0 + gap)
    assert (apply(bound, copy, reduced, level) == 0.0).all()


@every_copy
def test_next_to_the_maximum_rounding_makes_nothing_negative(bound: str, copy: str) -> None:
    random = np.random.default_rng(59)
    reduced = crowded(random, 500)
    peaks = np.array([DENSITIES[bound](d).peak for d in reduced])
    level = peaks * (1.0 - 10.0 ** random.uniform(-14.0, -8.0, reduced.size))
    assert (apply(bound, copy, reduced, level) >= 0.0).all()


@every_copy
def test_a_threshold_next_to_nothing_leaves_the_whole_dissipation(bound: str, copy: str) -> None:
    reduced = crowded(np.random.default_rng(53), 1_000)
    for level in (0.0, 1e-40, 1e-300):
        error = np.abs(apply(bound, copy, reduced, np.full_like(reduced, level)) - whole(bound, reduced))
        assert (error <= (ROUNDINGS[bound] + 4 * EPS) * whole(bound, reduced)).all()  # eight are of the test


@pytest.mark.parametrize("copy", KERNELS["elliptic"])
def test_a_threshold_below_the_ends_of_the_slip_zone_takes_its_whole_length(copy: str) -> None:
    random = np.random.default_rng(54)
    reduced = crowded(random, 2_000)
    level = random.uniform(0.0, 1.0, reduced.size)  # q·s is μp2(0) g at both ends
    length = 2.0 * reduced**2 / (1.0 + reduced**2)
    error = np.abs(apply("elliptic", copy, reduced, level) - (whole("elliptic", reduced) - level * length))
    assert (error <= (ROUNDINGS["elliptic"] + 4 * EPS) * whole("elliptic", reduced)).all()


@every_copy
def test_values_in_si_are_reduced_by_the_slope_of_the_bound(bound: str, copy: str) -> None:
    arguments, expected, most = in_si(bound)
    # One rounding makes d, of which the energy is the square at most, two the level, and three the product.
    within = (ROUNDINGS[bound] + (2 + 2 + 3) * 0.5 * EPS) * most
    assert (np.abs(KERNELS[bound][copy](*arguments) - expected) <= within).all()


@every_bound
def test_copies_of_the_formula_agree(bound: str) -> None:
    random = np.random.default_rng(57)
    reduced = crowded(random, 20_000)
    peaks = 2.0 * reduced if bound == "parabolic" else np.sqrt(1.0 + reduced**2)
    level = shares(random, reduced.size) * peaks  # of the order of the maximum, and above it
    results = {copy: apply(bound, copy, reduced, level) for copy in KERNELS[bound]}
    for copy, found in results.items():
        apart = np.abs(found - results["arrays"])
        assert (apart <= 2.0 * ROUNDINGS[bound] * whole(bound, reduced)).all(), copy


@every_copy
def test_no_creepage_dissipates_nothing_beside_points_that_do(bound: str, copy: str) -> None:
    reduced = np.array([0.0, 0.5, 0.0, 1.0, 2.0, 0.0])
    level = np.array([1e-9, 1e-3, 1.0, 1e-3, 10.0, 1e9])
    got = apply(bound, copy, reduced, level)
    assert (got[[0, 2, 4, 5]] == 0.0).all()
    assert (got[[1, 3]] > 0.0).all()
    assert (apply(bound, copy, np.zeros(3), np.full(3, 1e-9)) == 0.0).all()
