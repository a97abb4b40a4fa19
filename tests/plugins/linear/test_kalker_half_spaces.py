"""Kalker's creepage coefficients, against numerical solutions for two half-spaces."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tests.half_spaces import contact, solved
from wearlaw import Array, kalker


def values(axis_ratio: float, poisson_ratio: float) -> list[float]:
    found = kalker.coefficients(np.array(axis_ratio), poisson_ratio)
    return [float(value) for value in (found.c11, found.c22, found.c23, found.c33)]


def half_spaces(ratio: float, nu: float, cells: int) -> Array:
    """C11, C22, C23 from spin, C23 from lateral creepage, and C33, where every element sticks."""
    little = 1e-9
    along, across, turning = (solved([ratio, *creepage], cells, nu) / little for creepage in little * np.eye(3))
    found = np.array([along[0], across[1], turning[1], -across[2], turning[2]])
    area = float(contact([ratio, 0.0, 0.0, 0.0], cells).patch_area)  # of the elements; the solved ellipse has that area
    return found / (area / math.pi) ** np.array([1.0, 1.0, 1.5, 1.5, 2.0])


@pytest.mark.validates(
    "elliptic-contact",
    "C11, C22, C23 and C33 between the rows, a/b from 0.15 to 6.7, ν from 0 to 0.45",
    source="`half_space`, extrapolated",
    held_to="{others:g}, and {moment:g} for C33, relative (its grids)",
    others=0.025,
    moment=0.045,
)
@pytest.mark.parametrize("nu", [0.0, 0.28, 0.45])
@pytest.mark.parametrize("ratio", [0.15, 0.35, 1.0, 1.5, 6.7])
def test_the_coefficients_are_those_of_two_half_spaces(ratio: float, nu: float, others: float, moment: float) -> None:
    coarse, fine = half_spaces(ratio, nu, 10), half_spaces(ratio, nu, 20)
    c11, c22, c23, c33 = values(ratio, nu)
    # The error of the elements is of first order, and is extrapolated away. Grids of twice as many cells change the
    # result by up to 1 %, and 4 % in the moment; the table has three digits. Between the rows of the slenderest patches
    # linear interpolation would be off by 8 to 17 %.
    assert 2.0 * fine[:4] - coarse[:4] == pytest.approx([c11, c22, c23, c23], rel=others)
    assert 2.0 * fine[4] - coarse[4] == pytest.approx(c33, rel=moment)


@pytest.mark.validates(
    "limits",
    "C33 of a long patch is uncertain: at a/b = 20 half-spaces give {low:.0%} less at ν = 0.28, {lower:.0%} at 0.45",
    source="`half_space`, extrapolated",
    held_to="{moment:g}; C11, C22 and C23 to {others:g}, and at a/b = {wide:g} all, relative (its grids)",
    low=0.09,
    lower=0.18,
    wide=0.05,
    moment=0.045,
    others=0.025,
)
def test_beyond_the_table_half_spaces_agree_but_for_the_moment_of_long_patches(
    low: float, lower: float, wide: float, moment: float, others: float
) -> None:
    for ratio, nu, less in ((20.0, 0.28, low), (20.0, 0.45, lower), (wide, 0.28, 0.0)):
        found = 2.0 * half_spaces(ratio, nu, 20) - half_spaces(ratio, nu, 10)
        c11, c22, c23, c33 = values(ratio, nu)
        assert found[:4] == pytest.approx([c11, c22, c23, c23], rel=others)
        assert found[4] / c33 == pytest.approx(1.0 - less, abs=moment)
