"""The damage by fatigue of the whole life rail model, against interpolation and the lines of a public program."""

from __future__ import annotations

import dataclasses
from typing import Any, Literal

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import wearlaw as wl
from tests.plugins.ellipses import EPS
from wearlaw import Array, Q
from wearlaw_models.laws.wlrm import WLRM

POINTS: dict[str, Any] = {"threshold": Q(20, "N"), "peak": Q(65, "N"), "balance": Q(175, "N"), "peak_damage": 1e-5}
"""Of a public program, `railway_project` by A. M. Saleh, crack_initiation/create_di_df.py at commit 605c5c7."""

RIG = wl.WheelRail(wheel_radius="460 mm", rail_head_radius="300 mm", material=wl.steel(), rolling_speed="30 m/s")
SUROS = wl.TwinDisc.suros()
WHEEL: dict[str, Any] = {"normal_force": Q(80, "kN"), "friction_coefficient": 0.35}
DISCS: dict[str, Any] = {"normal_force": Q(7.4, "kN"), "friction_coefficient": 0.4}


def law(beyond: Literal["falls", "zero"] = "falls", **changes: Any) -> WLRM:
    return WLRM(**{**POINTS, "beyond": beyond, **changes})


def contact(wear_index: Any, force_x: Any = 1.0) -> wl.Contact:
    """Return the mean contact of a wheel on its rail with these Tγ and Fx [N]."""
    index, force = np.broadcast_arrays(np.asarray(wear_index, dtype=float), np.asarray(force_x, dtype=float))
    creepage = Q(np.full(index.shape, 0.1), "%")
    solved = (RIG | wl.contact_model("fastsim"))(**WHEEL, longitudinal_creepage=creepage)
    return dataclasses.replace(solved.contact.patch_mean(), wear_index=index, force_x=force)


def damage(of: wl.Law, where: wl.Contact) -> Array:
    return of.checked_rate(where)


@given(
    points=st.lists(st.floats(1.0, 1000.0), min_size=3, max_size=3, unique_by=lambda one: round(one, 1)).map(sorted),
    peak_damage=st.floats(1e-8, 1e-2),
    indices=st.lists(st.floats(0.0, 2000.0), min_size=1, max_size=8),
)
def test_the_damage_is_linear_between_the_points_and_zero_below_the_first(
    points: list[float], peak_damage: float, indices: list[float]
) -> None:
    threshold, peak, balance = points
    fields = {"threshold": Q(threshold, "N"), "peak": Q(peak, "N"), "balance": Q(balance, "N")}
    index = np.array(indices)
    # Each operation rounds its result by EPS/2 at most, and none takes the difference of rounded numbers.
    due = np.interp(index, points, [0.0, peak_damage, 0.0])
    zero = damage(law("zero", **fields, peak_damage=peak_damage), contact(index))
    assert zero == pytest.approx(due, rel=8 * EPS, abs=8 * EPS * peak_damage)
    beyond = np.maximum(index - balance, 0.0) / (balance - peak)
    falling = damage(law("falls", **fields, peak_damage=peak_damage), contact(index))
    assert falling == pytest.approx(due - peak_damage * beyond, rel=8 * EPS, abs=8 * EPS * peak_damage)


@pytest.mark.validates(
    "wear-laws",
    "The damage of WLRM from 0 to 400 N with the points of a public program",
    source="the lines that railway_project (A. M. Saleh) prints, crack_initiation/create_di_df.py at 605c5c7",
    held_to="the digits of their slopes and offsets",
)
def test_the_lines_are_those_of_a_public_program() -> None:
    index = np.linspace(0.0, 400.0, 4001)
    rise, fall = 2.22e-7 * index - 4.44e-6, -9.09e-8 * index + 1.59e-5
    lines = np.select([index < 20.0, index < 65.0, index < 175.0], [0.0 * index, rise, fall], 0.0)
    # Slope and offset are printed with three digits; half a unit of the last one each.
    printed = np.where(index < 65.0, 0.005e-7 * index + 0.005e-6, 0.005e-8 * index + 0.005e-5)
    assert (np.abs(damage(law("zero"), contact(index)) - lines) <= printed).all()


@pytest.mark.parametrize("traction", ["driving", "braking"])
def test_only_the_named_traction_damages_and_wear_removes_under_either(
    traction: Literal["driving", "braking"],
) -> None:
    index = np.array([10.0, 65.0, 100.0, 285.0])
    counted, other = (-1.0, 1.0) if traction == "driving" else (1.0, -1.0)
    of = law(traction=traction)
    assert damage(of, contact(index, counted)).tolist() == damage(law(), contact(index)).tolist()
    for force in (other, 0.0):
        assert damage(of, contact(index, force)) == pytest.approx([0.0, 0.0, 0.0, -1e-5], rel=16 * EPS)


@pytest.mark.parametrize("traction", ["driving", "braking"])
def test_lateral_creepage_alone_neither_drives_nor_brakes(traction: Literal["driving", "braking"]) -> None:
    found = (RIG | wl.contact_model("fastsim") | law(traction=traction))(
        **WHEEL, longitudinal_creepage="0 %", lateral_creepage="0.05 %", spin="0.8 1/m"
    )
    assert found.wear_index.magnitude > 20.0  # the threshold
    assert found["rcf_damage"].magnitude == 0.0


def test_a_wheel_that_pulls_drives() -> None:
    wheelset = wl.rig("wheelset", **wl.installed("rig")["wheelset"].example_fields)
    middle: dict[str, Any] = {"lateral_displacement": "0 mm", "vertical_load": "160 kN", "friction_coefficient": 0.3}
    counted = {}
    for traction in ("driving", "braking"):
        of = law(traction=traction, threshold=Q(0.01, "N"))
        predict = wheelset | wl.contact_model("fastsim") | of
        found = predict(**middle, axle_torque=Q([5, -5], "kN*m"))
        damage_of = np.atleast_2d(found["rcf_damage"].magnitude).reshape(2, -1)
        counted[traction] = [bool((row[~np.isnan(row)] > 0.0).any()) for row in damage_of]
    assert counted == {"driving": [True, False], "braking": [False, True]}


def test_disc_1_drives_where_it_is_the_faster_one() -> None:
    creepage = Q([-0.5, 0.5], "%")
    for traction, counts in (("driving", [False, True]), ("braking", [True, False]), ("either", [True, True])):
        of = law(traction=traction, threshold=Q(1, "N"))
        found = (SUROS | wl.contact_model("exact") | of)(**DISCS, creepage=creepage)["rcf_damage"].magnitude
        assert (found > 0.0).tolist() == counts


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"peak": Q(10, "N")}, "threshold, peak and balance must rise; got 20.00 N, 10.00 N and 175.0 N"),
        ({"balance": Q(65, "N")}, "threshold, peak and balance must rise; got 20.00 N, 65.00 N and 65.00 N"),
        ({"threshold": Q(-1, "N")}, "threshold"),
        ({"peak_damage": 0.0}, "peak_damage"),
        ({"peak_damage": float("inf")}, "peak_damage"),
        ({"beyond": "wear"}, "beyond: input should be 'falls' or 'zero', got 'wear'"),
        ({"traction": "pulling"}, "traction: input should be 'either', 'driving' or 'braking', got 'pulling'"),
    ],
)
def test_wrong_fields_are_named(fields: dict[str, Any], message: str) -> None:
    with pytest.raises(wl.ConfigurationError) as error:
        WLRM(**{**POINTS, "beyond": "zero", **fields})
    assert message in str(error.value)


def test_no_value_is_assumed() -> None:
    with pytest.raises(wl.ConfigurationError) as error:
        wl.law("wlrm")
    for name in (*POINTS, "beyond"):
        assert f"{name}: is missing" in str(error.value)


def test_without_spin_the_damage_is_that_of_the_creepages() -> None:
    found = (RIG | wl.contact_model("fastsim") | law(spin="left_out"))(
        **WHEEL, longitudinal_creepage="0.1 %", lateral_creepage="0.2 %", spin=Q([-1.0, 0.0, 1.0], "1/m")
    )
    index = 1e-3 * found.longitudinal_force.m_as("N") + 2e-3 * found.lateral_force.m_as("N")
    assert (np.abs(found.wear_index.m_as("N") - index) > [0.1, -1.0, 0.1]).all()
    due = np.interp(index, [20.0, 65.0, 175.0], [0.0, 1e-5, 0.0]) - 1e-5 * np.maximum(index - 175.0, 0.0) / 110.0
    assert found["rcf_damage"].magnitude == pytest.approx(due, rel=1e-12)
