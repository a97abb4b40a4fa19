"""Grids of operating points: every form of a condition, their order, and what is wrong with wrong ones."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import wearlaw as wl
from wearlaw import Array, Q
from wearlaw_apps.studies.grid import MOST_POINTS, Grid  # private: its errors without those of the rest of a case

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


AXIS = {"from": "1 %", "to": "2 %", "points": 3}


@pytest.mark.parametrize(
    ("condition", "value", "named"),
    [
        ("friction_coefficient", [], "friction_coefficient"),
        ("friction_coefficient", float("nan"), "friction_coefficient"),
        ("friction_coefficient", None, "friction_coefficient"),
        ("creepage", ["1 %", 2], "creepage"),
        ("creepage", ["1 %", "2 mm"], "creepage"),
        ("creepage", 1, "creepage"),
        ("creepage", "1 mm", "creepage"),
        ("creepage", "101 %", "creepage"),
        ("max_pressure", None, ""),
        ("normal_force", "1 kN", ""),
        ("max_presure", "1 GPa", "max_presure"),
        ("max_pressure", ["1 MPa", "1e200 MPa"], ""),
        ("creepage", {**AXIS, "from": "0 %", "spacing": "log"}, "creepage"),
        ("creepage", {**AXIS, "spacing": "lag"}, "creepage.spacing"),
        ("creepage", {**AXIS, "points": 1}, "creepage.points"),
        ("creepage", {**AXIS, "points": MOST_POINTS + 1}, "creepage.points"),
        ("creepage", {"to": "2 %", "points": 3}, "creepage.from"),
        ("creepage", {**AXIS, "from": "little"}, "creepage"),
        ("creepage", {**AXIS, "to": 2}, "creepage"),
        ("creepage", {**AXIS, "to": "200 %"}, "creepage"),
    ],
)
def test_a_wrong_condition_is_refused_by_name(condition: str, value: Any, named: str) -> None:
    with pytest.raises(wl.ConfigurationError) as refusal:
        grid(**{condition: value})
    assert [".".join(problem.path) for problem in refusal.value.problems] == [named]


def test_a_grid_that_is_larger_than_any_memory_is_refused() -> None:
    axis = {"from": 0.1, "to": 0.2, "points": 4000}
    with pytest.raises(wl.ConfigurationError, match="the axes make a grid of 16000000 points; at most 10000000"):
        grid(friction_coefficient=axis, traction_coefficient=axis)
