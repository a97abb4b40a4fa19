"""Friction that falls with the creep speed."""

from __future__ import annotations

import math
import re
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import wearlaw as wl
from tests.core.stages import RAILS
from tests.strategies import EPS
from wearlaw import Array, Q

# Polach, Wear 258 (2005) 992-1000, Table 2: typical parameters on dry rails. μ0 is after Open Rails (Axle.cs).
DRY: dict[str, Any] = {"static_coefficient": 0.55, "limit_ratio": 0.4, "decay": "0.6 s/m"}
FRICTION = wl.FallingFriction(**DRY)

ELLIPTIC = [name for name, model in wl.installed("contact model").items() if "ellipse" in model.geometries()]
LINE = [name for name, model in wl.installed("contact model").items() if "line" in model.geometries()]


@pytest.mark.validates(
    "creep-forces",
    "`FallingFriction`",
    source="Polach 2005",
    held_to="{roundings} ε, relative",
    roundings=8,
)
@given(
    speed=st.floats(0.0, 100.0),
    static=st.floats(0.05, 1.0),
    ratio=st.floats(0.01, 1.0),
    decay=st.floats(1e-3, 10.0),
)
def test_the_coefficient_is_polachs(roundings: int, speed: float, static: float, ratio: float, decay: float) -> None:
    friction = wl.FallingFriction(static_coefficient=static, limit_ratio=ratio, decay=Q(decay, "s/m"))
    expected = static * ((1.0 - ratio) * math.exp(-decay * speed) + ratio)
    # exp takes over the rounding of its argument, as far as it is not small itself: x e^-x < 1
    assert float(friction.coefficient(np.array(speed))) == pytest.approx(expected, rel=roundings * EPS)


def falling(speed: Array) -> Array:
    expected: Array = 0.55 * (0.6 * np.exp(-0.6 * speed) + 0.4)
    return expected


@pytest.mark.parametrize("name", LINE)
def test_a_line_contact_has_the_friction_of_its_creep_speed(name: str) -> None:
    solve = wl.TwinDisc.suros(rolling_speed="10 m/s") | wl.contact_model(name)
    creepage = np.array([-0.2, -0.01, 0.0, 0.01, 0.05, 0.2])
    conditions: dict[str, Any] = {"normal_force": Q(7, "kN"), "creepage": Q(creepage, "")}
    found = solve(friction_coefficient=FRICTION, **conditions)
    coefficient = falling(10.0 * np.abs(creepage))
    assert found.friction_coefficient.magnitude == pytest.approx(coefficient, rel=8 * EPS)
    plain = solve(friction_coefficient=coefficient, **conditions)
    assert found.tangential_force.magnitude == pytest.approx(plain.tangential_force.magnitude, rel=64 * EPS)
    # All slips at 5 % and more: the traction falls with the friction.
    assert found.traction_coefficient.magnitude[4:] == pytest.approx(coefficient[4:], rel=64 * EPS)


def test_discs_have_the_friction_of_the_difference_of_their_surface_speeds() -> None:
    # Disc 1 keeps 10 m/s; disc 2 turns more slowly, as fast, faster, and three times as fast.
    faster, slower = 10.0, np.array([6.0, 9.5, 10.0, 11.0, 30.0])
    creepage = 2.0 * (faster - slower) / (faster + slower)
    rig = wl.TwinDisc.suros(rolling_speed=Q(faster, "m/s"), speed_of="disc_1")
    found = rig.problem(normal_force="7 kN", creepage=Q(creepage, ""), friction_coefficient=FRICTION)
    assert found.friction_coefficient == pytest.approx(falling(np.abs(faster - slower)), rel=32 * EPS)


@pytest.mark.parametrize("name", ELLIPTIC)
def test_an_elliptic_contact_has_the_friction_of_its_creep_speed(name: str) -> None:
    solve = RAILS | wl.contact_model(name, **({"cells": 8} if name == "half_space" else {}))
    along, across = np.array([0.0, 0.001, 0.01, 0.1]), np.array([0.0, -0.002, 0.003, 0.0])
    conditions: dict[str, Any] = {
        "normal_force": Q(80, "kN"),
        "longitudinal_creepage": Q(along, ""),
        "lateral_creepage": Q(across, ""),
        "spin": Q(0.3, "1/m"),
    }
    found = solve(friction_coefficient=FRICTION, **conditions)
    coefficient = falling(30.0 * np.hypot(along, across))
    assert found.friction_coefficient.magnitude == pytest.approx(coefficient, rel=8 * EPS)
    plain = solve(friction_coefficient=coefficient, **conditions)
    # A slip zone moves by the roundings of the coefficient over what is left of the patch.
    assert found.tangential_force.magnitude == pytest.approx(plain.tangential_force.magnitude, rel=1e-10)


WRONG: list[tuple[dict[str, Any], str]] = [
    ({"static_coefficient": 0.0}, "static_coefficient: input should be greater than 0"),
    ({"limit_ratio": 1.01}, "limit_ratio: input should be less than or equal to 1"),
    ({"decay": 0.6}, "decay: got the bare number 0.6, which has no unit"),
    ({"decay": "-1 s/m"}, "decay: must be greater than zero"),
]


@pytest.mark.parametrize(("change", "message"), WRONG)
def test_parameters_that_are_none_are_refused(change: dict[str, Any], message: str) -> None:
    with pytest.raises(wl.ConfigurationError, match=re.escape(f"FallingFriction: {message}")):
        wl.FallingFriction(**{**DRY, **change})
