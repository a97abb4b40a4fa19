"""Nodes and weights over the slip zone and the patch, against integrals in closed form."""

from __future__ import annotations

import math

import mpmath  # type: ignore[import-untyped]
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.strategies import EPS
from wearlaw import Array, Nodes
from wearlaw.contact.quadrature import ORDER, Zone, join, remainder  # private: no result shows them

HALF_WIDTH, LENGTH = np.array(1.1), np.array(1.4)


def zone(length: float | Array = LENGTH, half_width: float | Array = HALF_WIDTH, over_patch: bool = False) -> Zone:
    return Zone.of(np.asarray(half_width), np.asarray(length), over_patch)


def total(nodes: Nodes, values: Array) -> float:
    return float((values * nodes.length).sum(axis=-1))


@pytest.mark.parametrize("over_patch", [False, True])
@given(length=st.floats(0.0, 2.2), splits=st.lists(st.floats(0.0, 1.0), max_size=4))
def test_the_lengths_of_nodes_sum_to_the_zone(over_patch: bool, length: float, splits: list[float]) -> None:
    it = zone(length, over_patch=over_patch)
    nodes = it.nodes(it.angle * np.sort(splits))
    assert nodes.x.shape == nodes.length.shape == ((len(splits) + 1) * ORDER,)
    # the angle is exact to a rounding, of which the length feels the sine, at most the span over the length
    assert nodes.length.sum() == pytest.approx(length, rel=64 * EPS, abs=4 * EPS if over_patch else 1e-300)
    assert (nodes.length >= 0.0).all()
    assert (nodes.from_trailing >= 0.0).all()
    assert (nodes.from_trailing <= length * (1.0 + 4 * EPS)).all()
    assert nodes.from_leading + nodes.from_trailing == pytest.approx(2.2, rel=4 * EPS)


@given(exponent=st.floats(-16.0, 0.0))
def test_positions_in_a_short_zone_keep_their_digits(exponent: float) -> None:
    length = 10.0**exponent
    distances = zone(length).nodes().from_trailing
    assert distances == pytest.approx(length * zone(1.0).nodes().from_trailing, rel=4 * EPS)


@pytest.mark.parametrize("panels", [1, 3])
def test_square_roots_at_both_ends_of_a_zone_are_integrated_to_rounding(panels: int) -> None:
    nodes = zone().nodes(panels=panels)
    before, into = nodes.from_trailing, LENGTH - nodes.from_trailing
    assert total(nodes, np.sqrt(into * before)) == pytest.approx(0.5 * math.pi * 0.7**2, rel=32 * EPS)
    # the distance from where the zone begins is exact to EPS, next to it, 7e-7 inside, that much of the distance
    assert total(nodes, 1.0 / np.sqrt(into * before)) == pytest.approx(math.pi, rel=1e-9)


@pytest.mark.parametrize("length", [1e-12, 1e-3, 1.0, 2.2 * (1 - 1e-12), 2.2])
def test_a_zone_mapped_over_the_patch_has_the_square_roots_of_its_edges_to_rounding(length: float) -> None:
    nodes = zone(length, over_patch=True).nodes()
    # ∫ √(y (2a - y)) dy from 0 to L, with y = 2a sin²(ψ/2): a²/2 (ψ - sin ψ cos ψ)
    with mpmath.workdps(60):  # the difference cancels in short zones
        end = 2 * mpmath.asin(mpmath.sqrt(mpmath.mpf(length) / mpmath.mpf(2.2)))
        expected = float(mpmath.mpf(1.1) ** 2 / 2 * (end - mpmath.sin(end) * mpmath.cos(end)))
    assert total(nodes, np.sqrt(nodes.from_leading * nodes.from_trailing)) == pytest.approx(expected, rel=64 * EPS)


def test_a_split_at_a_step_keeps_the_accuracy() -> None:
    split = zone().angle_of(np.array([0.525]))
    nodes = zone().nodes(split)
    assert total(nodes, np.where(nodes.x < 0.575, 0.0, 1.0)) == pytest.approx(0.525, rel=64 * EPS)
    unsplit = zone().nodes()
    assert abs(total(unsplit, np.where(unsplit.x < 0.575, 0.0, 1.0)) - 0.525) > 1e-4


@pytest.mark.parametrize("over_patch", [False, True])
def test_what_is_not_in_the_zone_has_the_angle_of_its_end(over_patch: bool) -> None:
    it = zone(over_patch=over_patch)
    angles = it.angle_of(np.array([np.nan, 1.5, -0.1, 0.0, 0.7]))
    assert (angles[:2] == it.angle).all()
    assert (angles[2:4] == 0.0).all()
    assert it.span * np.sin(0.5 * angles[4]) ** 2 == pytest.approx(0.7, rel=4 * EPS)


def test_a_zone_without_length_has_nodes_without_length() -> None:
    for over_patch in (False, True):
        it = zone(0.0, over_patch=over_patch)
        nodes = it.nodes(it.angle_of(np.array([0.1])))
        assert (nodes.length == 0.0).all()
        assert np.isfinite(nodes.x).all()


@pytest.mark.parametrize("over_patch", [False, True])
def test_a_batch_is_its_points(over_patch: bool) -> None:
    half_width, length = np.array([[1.0, 0.5], [0.25, 1.0]]), np.array([[1.0, 1.0], [0.1, 0.0]])
    splits = np.array([[[0.1], [0.2]], [[0.3], [0.0]]])
    together = zone(length, half_width, over_patch).nodes(splits)
    assert together.x.shape == (2, 2, 2 * ORDER)
    for index in np.ndindex(2, 2):
        alone = zone(length[index], half_width[index], over_patch).nodes(splits[index])
        assert (together.x[index] == alone.x).all()
        assert (together.length[index] == alone.length).all()


def test_the_middle_stands_for_the_zone() -> None:
    node = zone().middle()
    assert node.x == pytest.approx([0.4], rel=2 * EPS)
    assert node.length == LENGTH


def test_points_are_given_by_x_or_counted_from_the_other_edge() -> None:
    nodes = Nodes.at(np.array([-1.0, 0.25]), np.array(1.0))
    assert nodes.x == pytest.approx([-1.0, 0.25])
    assert nodes.from_leading == pytest.approx([0.0, 1.25])
    assert nodes.reversed().x == pytest.approx([1.0, -0.25])


def test_joined_zones_are_both_there() -> None:
    parts = zone(0.8).nodes().reversed(), zone().nodes()
    nodes = join(*parts)
    assert nodes.length.sum() == pytest.approx(2.2, rel=16 * EPS)
    assert (nodes.x == np.concatenate([parts[0].x, parts[1].x])).all()


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
