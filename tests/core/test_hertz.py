"""Hertz's line contact, against closed forms and quadrature."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import integrate

from tests.strategies import EPS, log_uniform
from wearlaw import hertz


def test_a_flat_body_leaves_the_radius_of_the_other() -> None:
    assert hertz.relative_radius(0.46, math.inf) == 0.46
    assert hertz.relative_radius(math.inf, 0.46) == 0.46


@given(log_uniform(1e-3, 10.0), log_uniform(1e-3, 10.0))
def test_the_relative_radius_is_that_of_the_sum_of_the_curvatures(first: float, second: float) -> None:
    assert hertz.relative_radius(first, second) == pytest.approx(first * second / (first + second), rel=4 * EPS)


def test_a_rigid_body_leaves_the_plane_strain_modulus_of_the_other() -> None:
    assert hertz.effective_modulus(200e9, 0.3, math.inf, 0.3) == pytest.approx(200e9 / 0.91, rel=2 * EPS)
    assert hertz.effective_modulus(math.inf, 0.0, 200e9, 0.3) == pytest.approx(200e9 / 0.91, rel=2 * EPS)


@pytest.mark.validates(
    "hertz",
    "Half-width and maximum pressure of a line contact: a² = 4PR/(πE*), p0 = 2P/(πa)",
    source="a = 2 p0 R/E* (Johnson 1985, section 4.2)",
    held_to="{roundings} ε, relative",
    roundings=8,
)
@given(log_uniform(1e-3, 10.0), log_uniform(1e9, 1e12), log_uniform(1e-5, 3e-2))
def test_load_half_width_and_maximum_pressure_go_round(
    roundings: int, radius: float, modulus: float, ratio: float
) -> None:
    pressure = np.array(ratio * modulus)
    load = hertz.force_from_max_pressure(pressure, radius, modulus)
    width = hertz.half_width(load, radius, modulus)
    assert hertz.max_pressure(load, width) == pytest.approx(float(pressure), rel=roundings * EPS)
    # a = 2 p0 R / E* (Johnson, section 4.2)
    assert width == pytest.approx(2.0 * float(pressure) * radius / modulus, rel=roundings * EPS)


@pytest.mark.validates(
    "hertz",
    "Hertz's pressure on a line carries the load: P = π a p0/2",
    source="adaptive quadrature (QUADPACK) of p(x)",
    held_to="{within:g}, relative",
    within=1e-09,
)
@given(log_uniform(1e-6, 1.0), log_uniform(1e3, 1e10))
def test_the_pressure_carries_the_load(within: float, half_width: float, max_pressure: float) -> None:
    a, p0 = np.array(half_width), np.array(max_pressure)
    load, _ = integrate.quad(lambda x: float(hertz.pressure(np.array(x), a, p0)), -half_width, half_width, epsrel=1e-10)
    # P = π a p0 / 2; QUADPACK's estimate next to the square roots at the edges is far above its error
    assert load == pytest.approx(0.5 * math.pi * half_width * max_pressure, rel=within)


@pytest.mark.validates(
    "hertz",
    "Hertz's pressure bends two half-spaces to the curvature 1/R of the bodies",
    source="displacement of half-planes (Johnson 1985), as a principal value by QUADPACK",
    held_to="{within:g}, relative",
    within=1e-06,
)
def test_the_pressure_deforms_the_bodies_into_each_other(within: float) -> None:
    # In the patch the approach of the half spaces has the curvature 1/R: d/dx of the displacement is
    # -(2/πE*) ⨍ p(s)/(x-s) ds = -x/R (Johnson, for both bodies), checked as a principal value.
    radius, modulus, load = 0.01175, 112e9, 741e3
    a = hertz.half_width(np.array(load), radius, modulus)
    p0 = hertz.max_pressure(np.array(load), a)
    for position in (-0.7, 0.1, 0.5):
        x = position * float(a)
        value, _ = integrate.quad(
            lambda s: float(hertz.pressure(np.array(s), a, p0)), -float(a), float(a), weight="cauchy", wvar=x
        )
        # ∫ p/(s-x) ds = -(∫ p/(x-s) ds)
        assert -2.0 / (math.pi * modulus) * -value == pytest.approx(-x / radius, rel=within)


def test_the_pressure_is_zero_outside_and_at_the_edges() -> None:
    x = np.array([-2.0, -1.0, 1.0, 1.5])
    assert (hertz.pressure(x, np.array(1.0), np.array(5.0)) == 0.0).all()


@given(log_uniform(1e-6, 1.0), log_uniform(1e-6, 1.0))
def test_a_pressure_is_borne_at_two_distances_from_an_edge(share: float, half_width: float) -> None:
    near, far = hertz.distances_at_pressure(np.array(share * 3e9), np.array(half_width), np.array(3e9))
    # a - |x| = d, so that (a-x)(a+x) = d (2a - d); a dozen roundings, half of which the root takes off
    assert math.sqrt(near * (2.0 * half_width - near)) == pytest.approx(share * half_width, rel=8 * EPS)
    assert near <= half_width
    assert near + far == pytest.approx(2.0 * half_width, rel=4 * EPS)


def test_the_largest_pressure_is_borne_in_the_middle_and_a_larger_one_nowhere() -> None:
    distances = hertz.distances_at_pressure(np.array([5.0, 0.0, 5.1]), np.array([3.0, 3.0, 3.0]), np.array(5.0))
    np.testing.assert_array_equal(distances, [[3.0, 3.0], [0.0, 6.0], [np.nan, np.nan]])


@given(st.floats(1e-15, 1e-3))
def test_the_pressure_keeps_its_digits_next_to_an_edge(gap: float) -> None:
    x = 1.0 - gap
    # the gap that the float x leaves is exact; √(1-x²) = √(gap (2-gap))
    left = 1.0 - x
    assert float(hertz.pressure(np.array(x), np.array(1.0), np.array(1.0))) == pytest.approx(
        math.sqrt(left * (2.0 - left)), rel=4 * EPS
    )
