"""Rigs and conditions that are refused, and how the refusal reads."""

from __future__ import annotations

from typing import Any

import pytest

import wearlaw as wl
from tests.core.stages import RIG
from wearlaw import Q


def test_a_flat_disc_1_needs_its_rolling_speed() -> None:
    with pytest.raises(wl.InputError, match=r"rolling_speed: a flat disc_1 .* give rolling_speed instead"):
        wl.TwinDisc.suros(disc_1=wl.Disc(diameter="inf mm", material=wl.steel()))


def test_two_flat_discs_are_refused() -> None:
    with pytest.raises(wl.ConfigurationError, match="disc_1 and disc_2 are both flat; give at least one of them"):
        wl.TwinDisc.suros(diameter="inf mm", rolling_speed="1 m/s")


@pytest.mark.parametrize("value", [400, "400", "0 rpm", "-400 rpm", "nan rpm", "400 mm", True])
def test_a_wrong_rotational_speed_is_refused(value: Any) -> None:
    with pytest.raises(wl.UnitError, match=r'^rotational_speed: .* such as "1\.0 rpm"$'):
        wl.TwinDisc.suros(rotational_speed=value)


@pytest.mark.parametrize("value", ["10 Hz", Q(7, "1/s")])
def test_a_rotational_speed_must_say_what_it_counts(value: Any) -> None:
    with pytest.raises(wl.UnitError, match=r"rotational_speed: .* revolutions or radians; give it in rpm or rad/s"):
        wl.TwinDisc.suros(rotational_speed=value)


def test_rolling_and_rotational_speed_together_are_refused() -> None:
    with pytest.raises(wl.InputError, match="rolling_speed: follows from rotational_speed; give one of the two"):
        wl.TwinDisc.suros(rotational_speed="400 rpm", rolling_speed="1 m/s")


WRONG_CONDITIONS: list[tuple[dict[str, Any], type[Exception], list[str]]] = [
    (
        {"normal_force": None},
        wl.ConditionsError,
        ["normal_force, normal_force_per_width, max_pressure", "none of them"],
    ),
    (
        {"max_pressure": "1 GPa", "normal_force": "1 kN"},
        wl.ConditionsError,
        ["exactly one", "normal_force and max_pressure"],
    ),
    ({"creepage": None}, wl.ConditionsError, ["creepage: is missing", 'creepage=Q(1, "%")']),
    ({"friction_coefficient": None}, wl.ConditionsError, ["friction_coefficient: is missing", "=0.46"]),
    ({"creepge": "1 %"}, wl.ConditionsError, ["creepge: unknown condition", "did you mean 'creepage'?"]),
    ({"normal_force": 7000}, wl.UnitError, ["normal_force: got the bare number 7000", '"1.0 kN"']),
    ({"normal_force": "5 mm"}, wl.UnitError, ["normal_force: got 5.000 mm, which does not have the dimension of 'kN'"]),
    ({"creepage": 1}, wl.UnitError, ["creepage: got the bare number 1", 'such as "1 %"']),
    ({"creepage": "101 %"}, wl.UnitError, ["creepage: must not exceed 1 in magnitude, got 101.0 %"]),
    ({"creepage": Q([], "%")}, wl.ConditionsError, ["creepage: is empty; give at least one value"]),
    ({"friction_coefficient": -0.3}, wl.UnitError, ["friction_coefficient: ", "got -0.3", "such as 0.3 or '30 %'"]),
    (
        {"creepage": Q([0.1, 0.2], ""), "friction_coefficient": [0.1, 0.2, 0.3]},
        wl.ConditionsError,
        ["do not broadcast: ", "creepage (2,)", "friction_coefficient (3,)"],
    ),
    ({"normal_force": "1e-320 N"}, wl.ConditionsError, ["half width", "which no contact has", "check the units"]),
    ({"max_pressure": "1e200 Pa"}, wl.ConditionsError, ["which no contact has", "check the units"]),
    ({"traction_coefficient": 1e308}, wl.ConditionsError, ["traction_coefficient: must be at most 1e+12"]),
]


@pytest.mark.parametrize(("conditions", "error", "said"), WRONG_CONDITIONS, ids=lambda value: str(value)[:40])
@pytest.mark.filterwarnings("ignore::wearlaw.UnusualWarning")  # loads that overflow
def test_wrong_conditions_are_refused_with_name_value_and_fix(
    conditions: dict[str, Any], error: type[Exception], said: list[str]
) -> None:
    given_conditions = {"creepage": "1 %", "friction_coefficient": 0.46, **conditions}
    if not any(name in conditions for name in ("normal_force", "normal_force_per_width", "max_pressure")):
        given_conditions["normal_force"] = "7.4143 kN"
    with pytest.raises(error) as caught:
        RIG.problem(**given_conditions)
    assert type(caught.value) is error
    for words in said:
        assert words in str(caught.value)


def test_a_body_that_the_rig_has_not_is_refused() -> None:
    problem = RIG.problem(creepage="1 %", max_pressure="1.5 GPa", friction_coefficient=0.46)
    assert problem.body("disc_2").material is RIG.disc_2.material
    with pytest.raises(wl.InputError, match="no 'wheel'; its bodies are 'disc_1' and 'disc_2'"):
        problem.body("wheel")
