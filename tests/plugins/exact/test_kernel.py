"""The energy that Carter's contact dissipates above a threshold, against integrals in fifty digits."""

from __future__ import annotations

import functools
import math

import mpmath  # type: ignore[import-untyped]
import numpy as np
import pytest

from tests.plugins.excess import DIGITS, Density, Real, copies, crowded, shares
from tests.strategies import EPS
from wearlaw import Array
from wearlaw_models.contact_models.exact import kernel  # private: each copy of the formula
from wearlaw_models.contact_models.exact.kernel import excess_dissipation  # private: each copy of the formula

COPIES = copies(excess_dissipation)
every_copy = pytest.mark.parametrize("copy", COPIES)

ROUNDINGS = 8 * 0.5 * EPS
"""Error as a share of the whole dissipation.

The six terms of the sum come to less than five times the whole together, whatever the threshold, and each carries a
rounding or two. Roots matter only by the square of their error.
"""


def density(reduced: Real) -> Density:
    """Return q·s/(μp0 μa/R) by its factors (Carter 1926), with d = ξR/(μa).

    s/(μa/R) is √((x+a-c)² - c²)/a = √((2d-v)(2-v)) in partial slip, and d + x/a = d + 1 - v in full slip.
    """
    with mpmath.workdps(DIGITS):
        d = mpmath.mpf(reduced)
        if d < 1:
            top = (2 + 3 * d - mpmath.sqrt((2 + 3 * d) ** 2 - 16 * d)) / 4
            return Density(lambda v: mpmath.sqrt(abs(v * (2 * d - v))) * (2 - v), top, 2 * d)
        top = 1 - (mpmath.sqrt(d * d + 8) - d) / 4
        return Density(lambda v: mpmath.sqrt(abs(v * (2 - v))) * (d + 1 - v), top, mpmath.mpf(2))


def whole(reduced: Array) -> Array:
    """Return the whole dissipation T ξ over μp0 a μa/R: (π/2) d² (2-d), and (π/2) d in full slip."""
    return 0.5 * math.pi * reduced * np.where(reduced < 1.0, reduced * (2.0 - reduced), 1.0)


def apply(copy: str, reduced: Array, level: Array) -> Array:
    """Return the results of a copy of the kernel in units where μ, p0, a and R are one, and E* = 2 p0 R/a is two."""
    one = np.ones_like(reduced)
    return COPIES[copy](reduced, one, one, one, 2.0 * one, level)


@functools.cache
def integrals() -> tuple[Array, Array, Array]:
    """Return reduced creepages, thresholds, and the energy above these."""
    random = np.random.default_rng(41)
    reduced = crowded(random, 40)
    densities = [density(d) for d in reduced]
    level = shares(random, reduced.size) * [each.peak for each in densities]
    return reduced, level, np.array([each.excess(at) for each, at in zip(densities, level, strict=True)])


@pytest.mark.validates(
    "integration",
    "The closed form of the energy that `exact` dissipates above a threshold",
    source="mpmath quadrature in 50 digits (Carter 1926, after Tassini et al. 2010)",
    held_to="{share:.1e} of the whole dissipation",
    share=ROUNDINGS,
)
@every_copy
def test_the_energy_above_a_threshold_is_its_integral(copy: str, share: float) -> None:
    reduced, level, expected = integrals()
    error = np.abs(apply(copy, reduced, level) - expected).astype(float)
    assert (error <= share * whole(reduced)).all()
    assert np.ptp(expected.astype(float) / whole(reduced)) > 0.99  # thresholds leave all of it, and nearly nothing


@every_copy
def test_just_below_the_maximum_nothing_is_negative_and_above_it_all_is_zero(copy: str) -> None:
    random = np.random.default_rng(47)
    reduced = crowded(random, 500)
    peaks = np.array([density(d).peak for d in reduced])
    assert (apply(copy, reduced, peaks * (1.0 - 10.0 ** random.uniform(-14.0, -8.0, reduced.size))) >= 0.0).all()
    # squares of the level and of the maximum, of four factors, are compared
    gap = 10.0 ** random.uniform(math.log10(8.0 * EPS), 3.0, reduced.size)
    assert (apply(copy, reduced, peaks * (1.0 + gap)) == 0.0).all()


@every_copy
def test_a_threshold_next_to_nothing_leaves_the_whole_dissipation(copy: str) -> None:
    reduced = np.append(crowded(np.random.default_rng(43), 1_000), 1.0)
    for level in (0.0, 1e-40, 1e-300):
        error = np.abs(apply(copy, reduced, np.full_like(reduced, level)) - whole(reduced))
        assert (error <= (ROUNDINGS + 2 * EPS) * whole(reduced)).all()  # that of the test has four roundings


def test_two_steps_find_the_roots_at_any_creepage_and_level(monkeypatch: pytest.MonkeyPatch) -> None:
    random = np.random.default_rng(46)
    reduced = crowded(random, 100_000)
    level = shares(random, reduced.size) * np.where(reduced < 1.0, 2.0 * reduced, 1.0 + reduced)  # near the maximum
    limit = 2.0 * ROUNDINGS * whole(reduced)
    found = {}
    for steps in (1, 2, 8):
        monkeypatch.setattr(kernel, "STEPS", steps)
        found[steps] = apply("arrays", reduced, level)
    assert (np.abs(found[2] - found[8]) <= limit).all()
    assert not (np.abs(found[1] - found[8]) <= limit).all()
