"""Nodes over the slip zone, and the estimate of errors; `test_integrate.py` holds the integrals over them."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.strategies import EPS
from wearlaw import Array, Nodes
from wearlaw.contact.quadrature import ORDER, Zone, remainder  # private: no result shows them


def zone(length: float | Array = 1.4, half_width: float | Array = 1.1) -> Zone:
    return Zone.of(np.asarray(half_width), np.asarray(length), over_patch=False)


def total(nodes: Nodes, values: Array) -> float:
    return float((values * nodes.length).sum(axis=-1))


def test_points_are_given_by_x_or_counted_from_the_other_edge() -> None:
    nodes = Nodes.at(np.array([-1.0, 0.25]), np.array(1.0))
    assert nodes.x == pytest.approx([-1.0, 0.25])
    assert nodes.from_leading == pytest.approx([0.0, 1.25])
    assert nodes.reversed().x == pytest.approx([1.0, -0.25])


def test_the_middle_stands_for_the_zone() -> None:
    node = zone().middle()
    assert node.x == pytest.approx([0.4], rel=2 * EPS)
    assert node.length == 1.4


@pytest.mark.validates(
    "limits",
    ("Integrals of Hertz's pressure over a slip zone that ends just short of the leading edge lose digits"),
    source="the integral in closed form",
    held_to="up to {most:g} of the whole",
    most=5e-08,
)
def test_a_root_just_outside_a_zone_mapped_over_itself_costs_what_models_declare(most: float) -> None:
    # Hertz's pressure √(1-x²) over [-1+gap, 1]: its leading root lies just outside, √(2 gap) from the real axis.
    gap = np.geomspace(1e-12, 1.0, 2000)
    nodes = zone(2.0 - gap, np.ones_like(gap)).nodes()
    got = (np.sqrt(nodes.from_leading * nodes.from_trailing) * nodes.length).sum(axis=-1)
    before = 0.5 * (np.arccos(1.0 - gap) - (1.0 - gap) * np.sqrt(gap * (2.0 - gap)))
    error = np.abs(got + before - 0.5 * math.pi)
    assert 1e-9 < error.max() < most


# --- The error estimate ----------------------------------------------------------------------------------------


def test_the_remainder_is_summed_over_panels() -> None:
    nodes = zone().nodes(panels=2)
    rough = np.abs(nodes.x - 0.1) * nodes.length
    first, second = rough.copy(), rough.copy()
    first[ORDER:] = 0.0
    second[:ORDER] = 0.0
    assert float(remainder(rough)) == pytest.approx(float(remainder(first) + remainder(second)), rel=8 * EPS)


def test_the_remainder_is_the_size_of_the_last_two_legendre_coefficients() -> None:
    abscissas, weights = np.polynomial.legendre.leggauss(ORDER)
    for degree, expected in ((ORDER - 3, 0.0), (ORDER - 2, 1.0), (ORDER - 1, 1.0)):
        values = np.polynomial.legendre.legval(abscissas, [0.0] * degree + [1.0])
        # (2n+1) ∫ P_n² = 2, the length of a panel times the coefficient
        assert float(remainder(values * weights)) == pytest.approx(2.0 * expected, abs=1e-13)


@given(kink=st.floats(-0.29, 1.09), power=st.sampled_from([0.0, 1.0, 1.5]))
def test_the_remainder_bounds_the_error_of_kinks_and_steps(kink: float, power: float) -> None:
    nodes = zone().nodes()
    values = np.where(nodes.x > kink, np.abs(nodes.x - kink) ** power, 0.0)
    error = abs(total(nodes, values) - (1.1 - kink) ** (power + 1.0) / (power + 1.0))
    # Two coefficients of falling size can both pass close to zero; then a bound by them holds to a factor.
    assert error <= 3.0 * float(remainder(values * nodes.length)) + 8 * EPS
