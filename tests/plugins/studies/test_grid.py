"""Grids of operating points: every form of a condition, their order, and what is wrong with wrong ones."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import wearlaw as wl
from wearlaw import Array, Q
from wearlaw_studies.grid import MOST_POINTS, Grid  # private: its errors without those of the rest of a case

RIG = wl.TwinDisc.suros()


def grid(**changes: Any) -> Grid:
    conditions = {"max_pressure": "1500 MPa", "creepage": "1 %", "friction_coefficient": 0.46, **changes}
    read = Grid(**{name: value for name, value in conditions.items() if value is not None})
    if wrong := read.faults(RIG):
        raise wl.ConfigurationError("Grid", wrong)
    return read.ordered(RIG)


def along(read: Grid, name: str) -> Array:
    """Return the values of an axis as results show them."""
    return read.points(read.units()).varying[name].values


def problem(read: Grid) -> Any:
    """Return the contact problem at all points of a grid."""
    return RIG.problem(**read.points(read.units()).conditions())


@pytest.mark.parametrize(
    ("creepage", "expected"),
    [
        ("1 %", 0.01),
        ("-0.02 dimensionless", -0.02),
        (["1 %"], [0.01]),
        (["3 %", "1 %", "0 %"], [0.03, 0.01, 0.0]),
        ({"from": "-1 %", "to": "1 %", "points": 5}, [-0.01, -0.005, 0.0, 0.005, 0.01]),
        ({"from": "1 %", "to": "0 %", "points": 3}, [0.01, 0.005, 0.0]),
        ({"from": "0.1 %", "to": "10 %", "points": 3, "spacing": "log"}, [0.001, 0.01, 0.1]),
        ({"from": "-10 %", "to": "-0.1 %", "points": 3, "spacing": "log"}, [-0.1, -0.01, -0.001]),
        ({"from": "1 %", "to": "1 %", "points": 2, "spacing": "log"}, [0.01, 0.01]),
    ],
)
def test_a_condition_is_a_value_a_list_or_an_axis(creepage: Any, expected: Any) -> None:
    read = grid(creepage=creepage)
    assert ("creepage" in read.axes()) == isinstance(expected, list)
    percent = along(read, "creepage") if read.axes() else np.array(read.level("creepage", read.units()))
    np.testing.assert_allclose(percent, 100.0 * np.array(expected), rtol=1e-14, atol=0)  # rounding
    assert percent.shape == np.shape(expected)
    np.testing.assert_allclose(problem(read).creepage, expected, rtol=1e-14, atol=0)
    assert read.size == np.size(expected)


def test_an_axis_keeps_its_ends_to_the_last_digit() -> None:
    for spacing in ("log", "linear"):
        axis = grid(friction_coefficient={"from": 0.1, "to": 0.7, "points": 11, "spacing": spacing})
        values = along(axis, "friction_coefficient")
        assert (values[0], values[-1]) == (0.1, 0.7)


def test_several_axes_make_a_grid_in_the_order_of_the_conditions_whatever_the_order_in_the_file() -> None:
    conditions: dict[str, Any] = {
        "friction_coefficient": [0.2, 0.3, 0.4, 0.5],
        "creepage": ["1 %", "2 %"],
        "normal_force": {"from": "1 kN", "to": "3 kN", "points": 3},
    }
    read = Grid(**conditions).ordered(RIG)
    assert list(read.axes()) == ["normal_force", "creepage", "friction_coefficient"]
    points = read.points(read.units())
    assert points.shape == (3, 2, 4)
    assert read.size == 24
    many = problem(read)
    for number, index in enumerate(np.ndindex(3, 2, 4)):
        one = RIG.problem(
            normal_force=Q(1.0 + index[0], "kN"),
            creepage=Q(1.0 + index[1], "%"),
            friction_coefficient=0.2 + 0.1 * index[2],
        )
        for field in ("normal_force_per_width", "half_width", "max_pressure", "creepage", "friction_coefficient"):
            np.testing.assert_allclose(
                getattr(many, field)[number], getattr(one, field), rtol=1e-15
            )  # rounding of 0.2 + 0.1 i


SHAPE = "must be a value, a list of values, or a table with from, to and points; got "
CREEPAGE_FIX = "give creepage in percent or as a ratio"


@pytest.mark.parametrize(
    ("condition", "value", "message"),
    [
        ("friction_coefficient", [], "Grid: friction_coefficient: is empty; give at least one value"),
        ("friction_coefficient", float("nan"), "Grid: friction_coefficient: must be finite, got nan"),
        ("friction_coefficient", "0.4", "friction_coefficient: '0.4' is not a number with a unit"),
        ("creepage", ["1 %", 2], "creepage: got the bare number 2.0, which has no unit, beside '1 %'; give all"),
        ("creepage", ["1 %", "2"], "creepage: '2' is not a number with a unit; write '2 %'"),
        ("creepage", ["1 %", "2 mm"], "creepage: '1 %' and '2 mm' are not of one dimension"),
        ("friction_coefficient", None, "Grid: friction_coefficient: is missing"),
        ("creepage", None, "Grid: creepage: is missing"),
        ("creepage", 1, f"creepage: got the bare number 1.0, which has no unit; {CREEPAGE_FIX}"),
        ("creepage", "1 mm", f"creepage: got 1.000 mm, which is not a ratio; {CREEPAGE_FIX}"),
        ("creepage", "101 %", "creepage: must not exceed 1 in magnitude, got 101.0 %"),
        ("max_pressure", "1 kN", "max_pressure: got 1.000 kN, which does not have the dimension of 'MPa'"),
        ("max_pressure", None, "give exactly one of normal_force, normal_force_per_width, max_pressure; got none"),
        ("normal_force", "1 kN", "give exactly one of normal_force, normal_force_per_width, max_pressure; got norm"),
        ("max_presure", "1 GPa", "Grid: max_presure: unknown condition; did you mean 'max_pressure'?"),
        ("max_pressure", ["1 MPa", "1e200 MPa"], "which no contact has; check the units of the load"),
    ],
)
def test_a_wrong_condition_is_refused_by_name(condition: str, value: Any, message: str) -> None:
    with pytest.raises(wl.ConfigurationError) as refusal:
        grid(**{condition: value})
    assert message in str(refusal.value)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"from": "0 %", "spacing": "log"}, "creepage: a log axis cannot touch or cross zero"),
        ({"spacing": "lag"}, "creepage.spacing: input should be 'log' or 'linear', got 'lag'"),
        ({"points": 1}, "creepage.points: input should be greater than or equal to 2, got 1"),
        ({"points": MOST_POINTS + 1}, f"creepage.points: input should be less than or equal to {MOST_POINTS}"),
        ({"from": None}, "creepage.from: is missing"),
        ({"to": "12"}, "creepage: to: '12' is not a number with a unit; write '12 %'"),
        ({"from": "little"}, "creepage: from: 'little' is not a number with a unit"),
        ({"to": float("nan")}, "creepage.to: must be finite, got nan"),
        ({"to": 2}, "creepage: got the bare number 2.0, which has no unit"),
        ({"to": "200 %"}, "creepage: must not exceed 1 in magnitude, got 200.0 %"),
        ({"step": 2}, "creepage.step: unknown field"),
    ],
)
def test_a_wrong_axis_is_refused_with_its_path(changes: dict[str, Any], message: str) -> None:
    axis = {"from": "1 %", "to": "2 %", "points": 3, **changes}
    with pytest.raises(wl.ConfigurationError) as refusal:
        grid(creepage={name: value for name, value in axis.items() if value is not None})
    assert f"Grid: {message}" in str(refusal.value)


def test_a_grid_that_is_larger_than_any_memory_is_refused() -> None:
    axis = {"from": 0.1, "to": 0.2, "points": 4000}
    with pytest.raises(wl.ConfigurationError, match="the axes make a grid of 16000000 points; at most 10000000"):
        grid(friction_coefficient=axis, traction_coefficient=axis)
