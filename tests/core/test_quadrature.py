from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.strategies import EPS
from wearlaw import Array
from wearlaw.quadrature import ORDER, Nodes, join, position, remainder, uniform_cells, zone_nodes

START, END = np.array(-0.3), np.array(1.1)


def total(nodes: Nodes, values: Array) -> float:
    return float((values * nodes.length).sum(axis=-1))


@given(start=st.floats(-1.0, 1.0), length=st.floats(0.0, 2.0), splits=st.lists(st.floats(-1.5, 1.5), max_size=4))
def test_the_lengths_of_nodes_sum_to_the_zone(start: float, length: float, splits: list[float]) -> None:
    nodes = zone_nodes(np.array(start), np.array(start + length), splits=np.array(splits))
    assert nodes.x.shape == nodes.length.shape == ((len(splits) + 1) * ORDER,)
    assert nodes.length.sum() == pytest.approx((start + length) - start, rel=64 * EPS, abs=EPS)
    assert (nodes.length >= 0.0).all()
    assert (nodes.x >= start - 2 * EPS).all()
    assert (nodes.x <= start + length + 2 * EPS).all()


@pytest.mark.parametrize("panels", [1, 3])
def test_square_roots_at_both_ends_of_a_zone_are_integrated_to_rounding(panels: int) -> None:
    nodes = zone_nodes(START, END, panels=panels)
    x = nodes.x
    half = 0.7
    semicircle = total(nodes, np.sqrt((x - START) * (END - x)))
    assert semicircle == pytest.approx(0.5 * math.pi * half**2, rel=32 * EPS)
    inverse = total(nodes, 1.0 / np.sqrt((x - START) * (END - x)))
    # x is exact to EPS, which next to an end, where the first node lies 7e-7 inside, is that much of the distance
    assert inverse == pytest.approx(math.pi, rel=1e-9)


def test_polynomials_are_integrated_to_rounding() -> None:
    nodes = zone_nodes(START, END)
    assert total(nodes, nodes.x**5) == pytest.approx((1.1**6 - 0.3**6) / 6.0, rel=32 * EPS)


def test_a_split_at_a_step_keeps_the_accuracy() -> None:
    step = math.asin(0.25)  # x = 0.4 + 0.7·0.25
    nodes = zone_nodes(START, END, splits=np.array([step]))
    assert total(nodes, np.where(nodes.x < 0.575, 0.0, 1.0)) == pytest.approx(1.1 - 0.575, rel=64 * EPS)
    unsplit = zone_nodes(START, END)
    assert abs(total(unsplit, np.where(unsplit.x < 0.575, 0.0, 1.0)) - 0.525) > 1e-4


def test_splits_may_come_in_any_order_and_at_the_end() -> None:
    ordered = zone_nodes(START, END, splits=np.array([-1.0, 0.5, 0.5 * math.pi]))
    mixed = zone_nodes(START, END, splits=np.array([0.5 * math.pi, -1.0, 0.5]))
    assert (ordered.x == mixed.x).all()
    assert (ordered.length[-ORDER:] == 0.0).all()


def test_a_batch_is_its_points() -> None:
    start, end = np.array([[-1.0, -0.5], [0.0, 1.0]]), np.array([[1.0, 0.5], [0.25, 1.0]])
    splits = np.array([[[0.1], [0.2]], [[-0.3], [0.0]]])
    together = zone_nodes(start, end, splits=splits)
    assert together.x.shape == (2, 2, 2 * ORDER)
    for index in np.ndindex(2, 2):
        alone = zone_nodes(start[index], end[index], splits=splits[index])
        assert (together.x[index] == alone.x).all()
        assert (together.length[index] == alone.length).all()
    assert (together.length[1, 1] == 0.0).all()  # a zone without length


def test_the_angle_runs_from_one_end_of_the_zone_to_the_other() -> None:
    x = position(START, END, np.array([-0.5 * math.pi, 0.0, 0.5 * math.pi]))
    assert x == pytest.approx([-0.3, 0.4, 1.1], rel=2 * EPS)


def test_joined_zones_are_both_there() -> None:
    parts = zone_nodes(np.array(-1.0), START), zone_nodes(START, END)
    nodes = join(*parts)
    assert nodes.length.sum() == pytest.approx(2.1, rel=16 * EPS)
    assert (nodes.x == np.concatenate([parts[0].x, parts[1].x])).all()


@pytest.mark.parametrize("cells", [1, 2, 7, 200])
def test_uniform_cells_cover_the_patch(cells: int) -> None:
    nodes = uniform_cells(np.array([0.5, 2.0]), cells)
    assert nodes.x.shape == nodes.length.shape == (2, cells)
    assert nodes.length.sum(axis=-1) == pytest.approx([1.0, 4.0], rel=16 * EPS)
    assert nodes.x == pytest.approx(-nodes.x[:, ::-1], abs=4 * EPS)
    edges = np.concatenate([nodes.x - 0.5 * nodes.length, nodes.x[:, -1:] + 0.5 * nodes.length[:, -1:]], axis=-1)
    assert edges == pytest.approx(np.array([[0.5], [2.0]]) * np.linspace(-1.0, 1.0, cells + 1), abs=8 * EPS)


def test_a_root_just_outside_the_zone_costs_what_the_invariants_allow_for() -> None:
    # Hertz's pressure √(1-x²) over [-1+gap, 1]: its leading root lies just outside, √(2 gap) from the real θ-axis.
    gap = np.geomspace(1e-12, 1.0, 2000)
    nodes = zone_nodes(gap - 1.0, np.ones_like(gap))
    got = (np.sqrt((1.0 - nodes.x) * (1.0 + nodes.x)) * nodes.length).sum(axis=-1)
    before = 0.5 * (np.arccos(1.0 - gap) - (1.0 - gap) * np.sqrt(gap * (2.0 - gap)))
    error = np.abs(got + before - 0.5 * math.pi)
    assert 1e-9 < error.max() < 5e-8


# --- The error estimate ----------------------------------------------------------------------------------------


def test_the_remainder_of_a_resolved_integrand_is_rounding() -> None:
    nodes = zone_nodes(START, END, panels=2)
    assert float(remainder(np.cos(nodes.x) * nodes.length)) < 64 * EPS


def test_the_remainder_is_summed_over_panels() -> None:
    nodes = zone_nodes(START, END, panels=2)
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
    nodes = zone_nodes(START, END)
    values = np.where(nodes.x > kink, np.abs(nodes.x - kink) ** power, 0.0)
    error = abs(total(nodes, values) - (1.1 - kink) ** (power + 1.0) / (power + 1.0))
    # Two coefficients of falling size can both pass close to zero; then a bound by them holds to a factor.
    assert error <= 3.0 * float(remainder(values * nodes.length)) + 8 * EPS
