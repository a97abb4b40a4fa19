"""Spreading the loss of strips over positions of a profile: what they lose in all stays, and nothing is negative."""

from __future__ import annotations

import itertools
from collections.abc import Callable

import numpy as np
import pytest
import scipy

from tests.strategies import EPS
from wearlaw import Array
from wearlaw_apps.output.wear_profile import (
    onto_positions,  # private: its totals to rounding, at positions that no rig has
)


def spread(arc: Array, width: Array, loss: Array, positions: Array) -> Array:
    """Return the loss at all positions, (patches, positions)."""
    index, (values,) = onto_positions(arc, width, [loss], positions)
    found = np.zeros((arc.shape[0], positions.size))
    for patch, (places, own) in enumerate(zip(index, values, strict=True)):
        found[patch, places] += own
    return found


def even_in_angle(count: int) -> tuple[Array, Array]:
    """Return strips from -1 to 1 as those of an ellipse."""
    angle = np.pi / (count + 1) * np.arange(count, 0, -1)
    return np.cos(angle)[None], np.pi / (count + 1) * np.sin(angle)[None]


def even(count: int) -> tuple[Array, Array]:
    """Return strips of one width from -1 to 1."""
    edges = np.linspace(-1.0, 1.0, count + 1)
    return 0.5 * (edges[1:] + edges[:-1])[None], np.full((1, count), 2.0 / count)


@pytest.mark.parametrize("seed", range(40))
def test_the_total_stays_for_any_strips_and_positions(seed: int) -> None:
    random = np.random.default_rng(seed)
    patches, strips, count = random.integers(1, 5), random.integers(1, 20), random.integers(2, 60)
    arc = random.uniform(-1.0, 1.0, (patches, strips))  # in any order, with gaps and overlaps
    width = random.uniform(0.0, 0.3, arc.shape) * (random.random(arc.shape) > 0.1)
    loss = random.random(arc.shape) * (random.random(arc.shape) > 0.3)
    inside = np.unique(random.uniform(-2.0, 2.0, count))
    positions = np.concatenate([[-2.0], inside, [2.0]])
    found = spread(arc, width, loss, positions)
    assert (found >= 0.0).all()
    total, area = (loss * width).sum(axis=-1), np.trapezoid(found, positions, axis=-1)
    np.testing.assert_allclose(area, total, rtol=0.0, atol=positions.size * EPS * total.max())


@pytest.mark.parametrize("strips", [even, even_in_angle])
@pytest.mark.parametrize(
    "loss", [lambda y: (1 - y**2) ** 1.5, lambda y: (1 - y**2) * np.exp(y), lambda y: (1 - y**2) * np.cos(4 * y) ** 2]
)
def test_the_loss_at_a_position_is_the_mean_around_it_to_second_order(
    strips: Callable[[int], tuple[Array, Array]], loss: Callable[[Array], Array]
) -> None:
    positions = np.arange(-1.4, 1.4, 0.1) + 0.0123
    ends = np.concatenate([positions[:1], 0.5 * (positions[1:] + positions[:-1]), positions[-1:]])
    cut = np.clip(ends, -1.0, 1.0)
    exact = [scipy.integrate.quad(loss, *ends_of)[0] for ends_of in itertools.pairwise(cut)]
    exact /= np.diff(ends)
    errors = []
    for count in (16, 32, 64, 128):
        y, width = strips(count)
        errors.append(np.sqrt(np.mean((spread(y, width, loss(y), positions)[0] - exact) ** 2)))
    order = np.log2(errors[0] / errors[-1]) / 3.0
    assert order > 1.9
    assert errors[1] < 0.01  # with 32 strips, of a largest loss of about one


def test_cells_that_are_the_strips_lose_what_the_strips_lose() -> None:
    y, width = even(20)
    loss = np.random.default_rng(7).random(y.shape)
    positions = 0.05 + 0.1 * np.arange(-20.0, 20.0)  # the strips, and more on both sides
    expected = np.zeros(positions.size)
    expected[10:30] = loss[0]
    np.testing.assert_allclose(spread(y, width, loss, positions)[0], expected, rtol=0.0, atol=64 * EPS)
    backwards = spread(-y[:, ::-1], width, loss[:, ::-1], -positions[::-1])[0]
    np.testing.assert_allclose(backwards, expected[::-1], rtol=0.0, atol=64 * EPS)


def test_a_strip_that_loses_nothing_stays_whole_and_so_does_what_lies_beside_the_patch() -> None:
    y, width = even(20)
    loss = np.where(np.abs(y) < 0.42, 0.0, 1.0)
    positions = np.linspace(-1.5, 1.5, 301)
    found = spread(y, width, loss, positions)[0]
    ends = np.abs(positions)
    assert (found[(ends < 0.395) | (ends > 1.005)] == 0.0).all()
    assert (found[(ends > 0.5) & (ends < 0.9)] > 0.9).all()


def test_positions_that_end_inside_the_patch_leave_the_rest_out() -> None:
    y, width = even(50)
    positions = np.linspace(-2.0, 0.0, 41)
    found = spread(y, width, np.ones_like(y), positions)[0]
    np.testing.assert_allclose(np.trapezoid(found, positions), 1.0, rtol=4 * EPS)
    assert (spread(y + 9.0, width, np.ones_like(y), positions) == 0.0).all()


def test_a_patch_between_two_positions_is_not_lost() -> None:
    y, width = even(10)
    positions = np.array([-50.0, -3.0, 40.0, 60.0])
    found = spread(y, width, np.ones_like(y), positions)
    np.testing.assert_allclose(np.trapezoid(found, positions), 2.0, rtol=8 * EPS)
