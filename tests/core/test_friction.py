"""Friction that falls with the creep speed, by a law that is shipped or a user's, and friction that no contact has."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import wearlaw as wl
from tests.core.stages import predicted
from tests.plugins.fits.fits import usfd
from tests.strategies import EPS
from wearlaw import Array, Q
from wearlaw.errors import ModelError

# Polach, Wear 258 (2005) 992-1000, Table 2: typical parameters on dry rails. μ0 is after Open Rails (Axle.cs).
DRY: dict[str, Any] = {"static_coefficient": 0.55, "limit_ratio": 0.4, "decay": "0.6 s/m"}
FRICTION = wl.FallingFriction(**DRY)

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


PREDICT = usfd("exact")
CONDITIONS: Mapping[str, Any] = {"normal_force": "7 kN", "creepage": "1 %", "friction_coefficient": 0.4}
THREE = predicted(PREDICT, **{**CONDITIONS, "creepage": Q([1.0, 2.0, 3.0], "%")})


class Friction:
    """A law of friction of a user."""

    def __init__(self, coefficient: Callable[[Any], Any]) -> None:
        self.coefficient = coefficient


@pytest.mark.parametrize(
    ("coefficient", "says"),
    [
        (lambda _: np.ones(7), r"is wrong at creep speeds from 0.009795 to .*broadcast"),
        (
            lambda speed: speed * np.nan,
            r"is wrong at creep speeds from 0.009795 to .* got nan at index \[0\]",
        ),
        (lambda speed: -speed, r"must be a positive finite number, got -0.009"),
        (lambda _: None, "None is not a real number"),
        (lambda _: 1 / 0, "failed: ZeroDivisionError: division by zero"),
    ],
)
def test_a_wrong_law_of_friction_is_named(coefficient: Callable[[Any], Any], says: str) -> None:
    conditions: Any = {**CONDITIONS, "creepage": Q([1.0, 2.0, 3.0], "%"), "friction_coefficient": Friction(coefficient)}
    with pytest.raises(ModelError, match=rf"^friction_coefficient: friction law Friction .*{says}"):
        PREDICT(**conditions)


def test_a_law_of_friction_may_return_one_number() -> None:
    several: Any = {
        **CONDITIONS,
        "creepage": Q([1.0, 2.0, 3.0], "%"),
        "friction_coefficient": Friction(lambda _: 0.4),
    }
    assert PREDICT(**several).wear_rate.magnitude.tolist() == THREE.wear_rate.magnitude.tolist()


@pytest.mark.parametrize("coefficient", [1.7e308, Friction(lambda _: 1e300)])
def test_friction_that_no_contact_comes_near_is_not_blamed_on_a_model(coefficient: Any) -> None:
    with pytest.raises(wl.ConditionsError, match=r"^friction_coefficient: must be at most 1e\+12"):
        PREDICT(**{**CONDITIONS, "friction_coefficient": coefficient})


@pytest.mark.filterwarnings("ignore::wearlaw.WearlawWarning")
@pytest.mark.parametrize("model", ["exact", "fastsim", "global"])
def test_the_greatest_friction_gives_finite_numbers(model: str) -> None:
    found = (wl.TwinDisc.suros() | wl.contact_model(model))(**{**CONDITIONS, "friction_coefficient": 1e12})
    assert np.isfinite(found.tangential_force.magnitude)


def test_a_distance_for_each_point_must_fit_the_points() -> None:
    says = r"^over: an array of shape \(2,\) does not broadcast to the operating points, of shape \(3,\)"
    with pytest.raises(wl.InputError, match=says):
        THREE.mass_lost(Q([1.0, 2.0], "m"), "disc_1")
