"""Hertz's contacts, against closed forms, quadrature, Hertz's equations and Boussinesq's integral."""

from __future__ import annotations

import math
from collections.abc import Callable

import mpmath  # type: ignore[import-untyped]
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import integrate

from tests.strategies import EPS, log_uniform
from wearlaw import Array, hertz, hertz_ellipse


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


AXIS_RATIOS = sorted(
    {*np.geomspace(1e-3, 1e3, 24), *(1.0 + sign * gap for sign in (-1, 1) for gap in np.logspace(-9, -1, 9))}
)

# The logarithm of the curvature ratio is below 12 for axis ratios to 1000; its rounding, and a few more of the
# integrals' and of the curvatures themselves, stay in the axes.
AXES_ROUNDING = 32 * EPS


def johnson(a: float, b: float, max_pressure: float, modulus: float) -> tuple[float, float, float]:
    """A, B and the approach by Hertz's equations in Legendre's integrals, which need the extra digits.

    K. L. Johnson, Contact Mechanics, 1985, after the source of CONTACT (E. A. H. Vollebregt, src/m_hertz.f90).
    """
    with mpmath.workdps(150):
        major, minor = mpmath.mpf(max(a, b)), mpmath.mpf(min(a, b))
        m = 1 - (minor / major) ** 2
        k, e = mpmath.ellipk(m), mpmath.ellipe(m)
        factor = max_pressure / mpmath.mpf(modulus) * minor / (m * major**2)
        along, across = factor * (k - e), factor * ((major / minor) ** 2 * e - k)
        approach = max_pressure / mpmath.mpf(modulus) * minor * k
        first, second = (along, across) if a > b else (across, along)
        return float(first), float(second), float(approach)


def number(function: Callable[..., Array], *values: float) -> float:
    return float(function(*map(np.array, values)))


def semi_axes(force: float, curvature_x: float, curvature_y: float, modulus: float) -> tuple[float, float]:
    a, b = hertz_ellipse.semi_axes(np.array(force), np.array(curvature_x), np.array(curvature_y), modulus)
    return float(a), float(b)


@pytest.mark.validates(
    "hertz",
    "Semi-axes of the ellipse for a/b from 0.001 to 1000, with the approach of the bodies",
    source="Johnson 1985, after CONTACT, in Legendre's integrals with 150 digits",
    held_to="{axes:.1e} (a, b), {others:.1e} (p0, approach), relative",
    axes=AXES_ROUNDING,
    others=2 * AXES_ROUNDING,
)
@pytest.mark.parametrize("ratio", AXIS_RATIOS)
def test_the_ellipse_is_the_one_of_johnsons_equations(ratio: float, axes: float, others: float) -> None:
    b, max_pressure, modulus = 5e-3, 1.2e9, 1.139e11
    a = ratio * b
    curvature_x, curvature_y, approach = johnson(a, b, max_pressure, modulus)
    force = 2.0 / 3.0 * math.pi * a * b * max_pressure
    found = semi_axes(force, curvature_x, curvature_y, modulus)
    assert found == pytest.approx((a, b), rel=axes)
    assert number(hertz_ellipse.max_pressure, force, *found) == pytest.approx(max_pressure, rel=others)
    assert number(hertz_ellipse.approach, force, *found, modulus) == pytest.approx(approach, rel=others)


def displacement(x: float, y: float, a: float, b: float, max_pressure: float, modulus: float) -> float:
    """Boussinesq's integral of p/(πE*r) over the ellipse, by chords through the point."""
    # Both rules are trapezoidal over whole periods, so they converge faster than any power.
    angles = np.arange(400) * math.pi / 400
    turns = np.arange(1, 64) * math.pi / 64
    cosine, sine = np.cos(angles), np.sin(angles)
    quadratic = (cosine / a) ** 2 + (sine / b) ** 2
    middle = -(x * cosine / a**2 + y * sine / b**2) / quadratic
    half = np.sqrt(middle**2 + (1.0 - (x / a) ** 2 - (y / b) ** 2) / quadratic)
    along = middle[:, None] + half[:, None] * np.cos(turns)
    pressure = hertz_ellipse.pressure(
        x + along * cosine[:, None], y + along * sine[:, None], np.array(a), np.array(b), np.array(max_pressure)
    )
    chords = half * (pressure * np.sin(turns)).sum(axis=1) * math.pi / 64
    return float(chords.sum() * math.pi / 400) / (math.pi * modulus)


@pytest.mark.validates(
    "hertz",
    "The elliptic pressure closes the gap A x² + B y² between the bodies",
    source="Boussinesq's integral over chords of the ellipse",
    held_to="{within:g}, relative",
    within=1e-10,
)
@pytest.mark.parametrize(("curvature_x", "curvature_y"), [(0.8, 0.2814), (0.3, 2.0), (1.0, 1.0)])
def test_the_pressure_closes_the_gap_inside_the_ellipse(curvature_x: float, curvature_y: float, within: float) -> None:
    force, modulus = 106.7e3, 1.139e11
    a, b = semi_axes(force, curvature_x, curvature_y, modulus)
    p0 = number(hertz_ellipse.max_pressure, force, a, b)
    approach = number(hertz_ellipse.approach, force, a, b, modulus)
    for x, y in ((0.0, 0.0), (0.5, 0.0), (0.0, -0.7), (-0.4, 0.6)):
        x, y = x * a, y * b
        gap = approach - curvature_x * x**2 - curvature_y * y**2
        # next to the ends of a chord 1-(x/a)²-(y/b)² cancels, and its root keeps about half of the digits
        assert displacement(x, y, a, b, p0, modulus) == pytest.approx(gap, rel=within)


def test_a_curvature_adds_flat_and_concave_bodies() -> None:
    assert number(hertz_ellipse.curvature, 0.46, math.inf) == pytest.approx(0.5 / 0.46, rel=EPS)
    assert number(hertz_ellipse.curvature, 0.3, -0.5) == pytest.approx(0.5 * (1 / 0.3 - 1 / 0.5), rel=4 * EPS)


@pytest.mark.validates(
    "hertz",
    "Patch and pressure of a locomotive wheel (Polach 2005)",
    source="CONTACT (Vollebregt), example tractcurv",
    held_to="the printed digits of a = {a_printed} mm, b = {b_printed} mm, {pressure} MPa",
    a_printed=6.304,
    b_printed=12.61,
    pressure=640.7,
)
def test_a_locomotive_wheel_has_the_patch_of_the_program_contact(
    a_printed: float, b_printed: float, pressure: float
) -> None:
    # E. A. H. Vollebregt, CONTACT (Vtech CMCC, github.com/eve70a/CONTACT, Apache License 2.0), example tractcurv, after
    # O. Polach, Wear 258 (2005) 992-1000: 106.7 kN, G = 82 GPa, ν = 0.28, curvatures in 1/mm, as it prints them.
    force, modulus = 106.7e3, 82e9 / (1.0 - 0.28)
    a, b = semi_axes(force, 0.0008e3, 0.2814e-3 * 1e3, modulus)
    assert 1e3 * a == pytest.approx(a_printed, abs=5e-4)
    assert 1e3 * b == pytest.approx(b_printed, abs=5e-3)
    # It prints the largest pressure at the middle of an element, of which there are 48 by 44 on 2.2 a by 2.2 b.
    p0 = number(hertz_ellipse.max_pressure, force, a, b)
    assert number(hertz_ellipse.pressure, 1.1 * a / 48, 1.1 * b / 44, a, b, p0) / 1e6 == pytest.approx(
        pressure, abs=0.05
    )


def test_the_pressure_is_zero_a_rounding_beyond_the_edge() -> None:
    beyond = np.nextafter(1.0, 2.0)
    a, b, p0 = np.array(6e-3), np.array(4e-3), np.array(1e9)
    assert hertz_ellipse.pressure(np.array(0.0), b * beyond, a, b, p0) == 0.0
    assert hertz_ellipse.pressure(a * beyond, np.array(0.0), a, b, p0) == 0.0
