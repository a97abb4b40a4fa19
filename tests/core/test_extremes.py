"""The smallest and the largest entry, and checks that use them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import wearlaw as wl
from wearlaw import Q
from wearlaw.arrays.array import extremes

TINIEST, LARGEST = float(np.finfo(np.float64).smallest_subnormal), float(np.finfo(np.float64).max)


@pytest.mark.parametrize(
    "values",
    [
        [3.0, 1.0, 2.0],
        [-3.0, -1.0, -2.0],
        [-1.0, 2.0],
        [0.0, 5.0],
        [-0.0, 0.0],
        [TINIEST, LARGEST],
        [-TINIEST, TINIEST],
        [1.0, np.inf],
        [-np.inf, np.inf],
        [7.0],
    ],
    ids=str,
)
def test_extremes_are_those_of_numpy(values: list[float]) -> None:
    for order in (values, values[::-1], values * 50):
        array = np.array(order)
        assert extremes(array) == (array.min(), array.max())


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("others", [[1.0, 2.0], [-1.0, 2.0], [np.inf, 0.0]], ids=str)
@pytest.mark.parametrize("where", [0, 1, 2])
def test_nan_anywhere_makes_both_extremes_nan(sign: float, others: list[float], where: int) -> None:
    assert np.isnan(extremes(np.insert(others, where, np.copysign(np.nan, sign)))).all()


@pytest.mark.parametrize("seed", range(5))
def test_extremes_of_every_layout_are_those_of_numpy(seed: int) -> None:
    table = np.random.default_rng(seed).normal(seed, 2.0, (60, 7))
    shared = np.broadcast_to(table[0], (5, 7))  # cannot be written to, and has strides of zero
    frozen = table.copy()
    frozen.setflags(write=False)
    layouts: list[Any] = [table, table.T, table[::3, 1:5], table[:, 2], table[2, 3], shared, frozen]
    for array in layouts:
        assert extremes(array) == (array.min(), array.max())


@pytest.mark.parametrize("where", [0, 8191, 8192, 19_999, 24_999])
@pytest.mark.parametrize(
    ("name", "value", "rule"),
    [
        ("normal_force", np.nan, "must be a number"),
        ("normal_force", np.inf, "must be finite"),
        ("normal_force", 0.0, "must be greater than zero"),
        ("normal_force", -0.0, "must be greater than zero"),
        ("normal_force", -7.0, "must be greater than zero"),
        ("creepage", np.nan, "must be a number"),
        ("creepage", -np.inf, "must be finite"),
        ("creepage", np.nextafter(1.0, 2.0), "must not exceed 1 in magnitude"),
        ("creepage", -1.5, "must not exceed 1 in magnitude"),
        ("friction_coefficient", np.nan, "must be a positive finite number"),
        ("friction_coefficient", np.inf, "must be a positive finite number"),
        ("friction_coefficient", 0.0, "must be a positive finite number"),
        ("friction_coefficient", -0.3, "must be a positive finite number"),
    ],
)
def test_one_bad_value_anywhere_in_a_sweep_is_refused(name: str, value: float, rule: str, where: int) -> None:
    arrays = {
        "normal_force": np.full(25_000, 7000.0),
        "creepage": np.full(25_000, 0.01),
        "friction_coefficient": np.full(25_000, 0.4),
    }
    arrays[name][where] = value
    units = {"normal_force": "N", "creepage": ""}
    conditions: Any = {one: Q(array, units[one]) if one in units else array for one, array in arrays.items()}
    with pytest.raises(wl.UnitError, match=rf"^{name}: {rule}, got .* at index \[{where}\]"):
        wl.TwinDisc.suros().problem(**conditions)


def test_the_conditions_of_a_problem_are_not_to_be_written_to() -> None:
    given = np.array([0.01, 0.02])
    problem = wl.TwinDisc.suros().problem(
        max_pressure="1500 MPa", creepage=Q(given, ""), friction_coefficient=np.array([0.3, 0.4])
    )
    for array in (problem.creepage, problem.friction_coefficient):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0.5
    assert given.flags.writeable  # the user's own still is
