"""Measures of error, against sums worked out by hand and what must hold for any rates."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tests.strategies import EPS
from wearlaw_fits.agreement import agreement  # private: errors of made-up rates, without a law


def test_each_measure_is_what_comes_out_by_hand() -> None:
    """The ratios are 2, 2 and 1/4, with logarithms 1, 1 and -2 times ln 2."""
    found = agreement(np.array([2.0, 8.0, 1.0]), np.array([1.0, 4.0, 4.0]))
    assert found.tests == 3
    assert found.without_ratio == 0
    assert found.bias == pytest.approx(1.0, rel=4 * EPS)
    assert found.geometric_sd == pytest.approx(2.0 ** math.sqrt((1 + 1 + 4) / 2), rel=8 * EPS)
    assert found.rms_factor == pytest.approx(2.0 ** math.sqrt((1 + 1 + 4) / 3), rel=8 * EPS)
    assert found.largest_factor == pytest.approx(4.0, rel=4 * EPS)
    assert found.rms_error == pytest.approx(math.sqrt((1 + 16 + 9) / 3), rel=4 * EPS)


def test_a_test_in_which_one_rate_is_zero_has_no_ratio_and_counts_in_the_rms_error() -> None:
    found = agreement(np.array([0.0, 3.0, 2.0]), np.array([1.0, 0.0, 1.0]))
    assert (found.tests, found.without_ratio) == (3, 2)
    assert found.bias == found.rms_factor == found.largest_factor == pytest.approx(2.0, rel=4 * EPS)
    assert found.geometric_sd is None
    assert found.rms_error == pytest.approx(math.sqrt((1 + 9 + 1) / 3), rel=4 * EPS)


def test_missed_wear_ranks_behind_any_factor_and_equal_factors_rank_by_the_rms_error() -> None:
    measured = np.array([1.0, 1.0])
    far = agreement(1e9 * measured, measured)
    missed = agreement(np.array([0.0, 1.0]), measured)
    nothing = agreement(np.zeros(2), measured)
    over = agreement(2.0 * measured, measured)
    under = agreement(0.5 * measured, measured)
    ranked = sorted([nothing, missed, far, over, under], key=lambda one: one.rank)
    assert ranked == [under, over, far, missed, nothing]
