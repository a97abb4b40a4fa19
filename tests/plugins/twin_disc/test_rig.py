"""The rig: from the conditions of a test to a contact problem, and what is refused."""

from __future__ import annotations

import inspect
import re
import warnings
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import wearlaw as wl
from tests.cases import following_line
from tests.core.stages import RIG
from tests.strategies import EPS
from wearlaw import Q


def problem(rig: wl.TwinDisc = RIG, **conditions: Any) -> wl.Problem:
    loads = {"normal_force", "normal_force_per_width", "max_pressure"}
    load: dict[str, Any] = {} if loads & set(conditions) else {"normal_force": "7.4143 kN"}
    given: dict[str, Any] = {"creepage": "1 %", "friction_coefficient": 0.46, **load, **conditions}
    return rig.problem(**given)


def test_the_suros_rig_is_that_of_the_literature() -> None:
    # Lewis and Dwyer-Joyce (2004): discs of 47 mm, track of 10 mm, 400 rpm; π · 47 mm · 400/min = 0.984 m/s.
    found = problem(creepage="0 %")
    assert found.rolling_speed == pytest.approx(np.pi * 0.047 * 400 / 60, rel=4 * EPS)
    assert round(float(found.rolling_speed), 3) == 0.984
    assert found.track_width == pytest.approx(0.010, rel=EPS)
    assert found.density == 7850.0
    # 1/R = 1/23.5 mm + 1/23.5 mm.
    assert found.relative_radius == pytest.approx(0.01175, rel=4 * EPS)


def test_the_pressure_carries_the_load() -> None:
    found = problem()
    # The area of a half ellipse of axes a and p0.
    carried = 0.5 * np.pi * found.half_width * found.max_pressure * found.track_width
    assert carried == pytest.approx(7414.3, rel=8 * EPS)
    assert found.normal_force == pytest.approx(7414.3, rel=4 * EPS)


OVERRIDES: dict[str, tuple[Any, Callable[[wl.TwinDisc], Any], Any]] = {
    "diameter": ("50 mm", lambda rig: [rig.disc_1.diameter, rig.disc_2.diameter], [Q(50, "mm")] * 2),
    "material": (
        wl.steel(poisson_ratio=0.3),
        lambda rig: [rig.disc_1.material.poisson_ratio, rig.disc_2.material.poisson_ratio],
        [0.3, 0.3],
    ),
    "disc_1": (
        wl.Disc(diameter="90 mm", material=wl.steel()),
        lambda rig: [rig.disc_1.diameter, rig.disc_2.diameter],
        [Q(90, "mm"), Q(47, "mm")],
    ),
    "disc_2": (
        wl.Disc(diameter="90 mm", material=wl.steel()),
        lambda rig: [rig.disc_1.diameter, rig.disc_2.diameter],
        [Q(47, "mm"), Q(90, "mm")],
    ),
    "track_width": ("12 mm", lambda rig: rig.track_width, Q(12, "mm")),
    "rolling_speed": ("2 m/s", lambda rig: rig.rolling_speed, Q(2, "m/s")),
    "speed_of": ("mean", lambda rig: rig.speed_of, "mean"),
}


def test_every_value_of_the_suros_rig_has_a_test_that_overrides_it() -> None:
    assert {*OVERRIDES, "rotational_speed"} == set(inspect.signature(wl.TwinDisc.suros).parameters)


@pytest.mark.parametrize("name", OVERRIDES)
def test_every_value_of_the_suros_rig_can_be_overridden(name: str) -> None:
    value, read, expected = OVERRIDES[name]
    assert read(wl.TwinDisc.suros(**{name: value})) == expected


def test_the_rolling_speed_follows_from_the_rotational_speed_and_disc_1() -> None:
    big = wl.Disc(diameter="94 mm", material=wl.steel())
    usual = np.pi * 0.047 * 400 / 60
    made: list[tuple[dict[str, Any], float]] = [
        ({"rotational_speed": "800 rpm"}, 2 * usual),
        ({"disc_1": big}, 2 * usual),
        ({"disc_2": big}, usual),
    ]
    for values, speed in made:
        rig = wl.TwinDisc.suros(**values)
        assert rig.rolling_speed.m_as("m/s") == pytest.approx(speed, rel=4 * EPS)
        assert problem(rig, creepage="0 %").rolling_speed == pytest.approx(speed, rel=4 * EPS)


SURFACE_SPEEDS = [(1.0, 1.0), (1.1, 0.9), (0.984, 0.805), (0.5, 0.52), (30.0, 10.0), (1.0, 3.0)]
"""v1 and v2 [m/s]; the last two have the creepages 1 and -1."""


@pytest.mark.validates(
    "line-contact",
    "V of two discs, whether the rig keeps the mean of the surface speeds or the speed of disc 1",
    source="the two surface speeds themselves",
    held_to="{roundings} ε, relative",
    roundings=8,
)
@pytest.mark.parametrize(("v1", "v2"), SURFACE_SPEEDS)
def test_the_rolling_speed_is_the_mean_of_the_surface_speeds(v1: float, v2: float, roundings: int) -> None:
    mean = 0.5 * (v1 + v2)
    creepage = Q((v1 - v2) / mean, "")
    keeps_mean = wl.TwinDisc.suros(rolling_speed=Q(mean, "m/s"))
    keeps_disc_1 = wl.TwinDisc.suros(rolling_speed=Q(v1, "m/s"), speed_of="disc_1")
    for rig in (keeps_mean, keeps_disc_1):
        assert problem(rig, creepage=creepage).rolling_speed == pytest.approx(mean, rel=roundings * EPS)
        # What slides per second is the difference of the surface speeds.
        slid = (rig | wl.contact_model("global"))(
            normal_force="5 kN", creepage=creepage, friction_coefficient=0.46
        ).contact.slip_speed
        # A difference rounds by as much as the larger speed does.
        assert slid == pytest.approx(abs(v1 - v2), rel=roundings * EPS, abs=roundings * EPS * max(v1, v2))


def test_a_rig_that_keeps_disc_1_has_a_rolling_speed_at_each_creepage() -> None:
    keeps_mean, keeps_disc_1 = (wl.TwinDisc.suros(rolling_speed="2 m/s", speed_of=of) for of in ("mean", "disc_1"))
    creepage = Q([[0.0, 20.0, -20.0]], "%")
    assert problem(keeps_mean, creepage=creepage).rolling_speed.tolist() == [[2.0, 2.0, 2.0]]
    # v2 is 2, 18/11 and 22/9 m/s.
    expected = np.array([[2.0, 20.0 / 11.0, 20.0 / 9.0]])
    np.testing.assert_allclose(problem(keeps_disc_1, creepage=creepage).rolling_speed, expected, rtol=4 * EPS)


def test_the_suros_rig_keeps_disc_1_at_its_rotational_speed_and_else_the_mean() -> None:
    cases: list[tuple[dict[str, Any], str]] = [
        ({}, "disc_1"),
        ({"rotational_speed": "500 rpm"}, "disc_1"),
        ({"rotational_speed": "500 rpm", "speed_of": "mean"}, "mean"),
        ({"rolling_speed": "1 m/s"}, "mean"),
        ({"rolling_speed": "1 m/s", "speed_of": "disc_1"}, "disc_1"),
    ]
    for values, kept in cases:
        assert wl.TwinDisc.suros(**values).speed_of == kept
    assert wl.rig("twin_disc", **wl.TwinDisc.example_fields).speed_of == "mean"


def test_a_flat_disc_has_the_radius_of_the_other() -> None:
    flat = wl.Disc(diameter="inf mm", material=wl.steel())
    assert problem(wl.TwinDisc.suros(disc_2=flat)).relative_radius == pytest.approx(0.0235, rel=4 * EPS)
    rig = wl.TwinDisc.suros(disc_1=flat, rolling_speed="1 m/s")
    assert problem(rig).relative_radius == pytest.approx(0.0235, rel=4 * EPS)


@pytest.mark.parametrize("value", ["41.887902047863905 rad/s", "400 rpm", "2400 deg/s", "6.666666666666667 turn/s"])
def test_a_rotational_speed_may_count_any_angle(value: str) -> None:
    speed = wl.TwinDisc.suros(rotational_speed=value).rolling_speed.m_as("m/s")
    assert speed == pytest.approx(np.pi * 0.047 * 400 / 60, rel=8 * EPS)


@pytest.mark.parametrize("size", [1, 5])
def test_plasticity_is_warned_of_once_a_call_at_the_users_line(size: int) -> None:
    contact_pipeline = RIG | wl.contact_model("exact")
    line = following_line()
    with pytest.warns(wl.PlasticityWarning) as caught:
        contact_pipeline(max_pressure=Q([2500.0] * size, "MPa"), creepage="1 %", friction_coefficient=0.4)
    assert len(caught) == 1
    assert (caught[0].filename, caught[0].lineno) == (__file__, line)
    # The slip zone holds the middle of the patch, where the traction is μp0, so that the limit is k/μ, k = 541.3 MPa.
    said = "the maximum pressure of 2500 MPa at T/N = 0.323 is beyond the shakedown limit, 1353 MPa: the material flows"
    assert str(caught[0].message).startswith(said)


def test_the_softer_disc_limits_the_pressure() -> None:
    soft = wl.Disc(diameter="47 mm", material=wl.steel(shear_yield_stress="300 MPa"))
    unknown = wl.Disc(diameter="47 mm", material=wl.steel(shear_yield_stress=None))
    conditions: Any = {"creepage": "2 %", "friction_coefficient": 0.4}
    assert said_by(wl.TwinDisc.suros(disc_2=soft), "1 GPa", **conditions) == [("the shakedown limit", "750")]
    assert said_by(wl.TwinDisc.suros(disc_1=soft), "1 GPa", **conditions) == [("the shakedown limit", "750")]
    assert said_by(RIG, "1 GPa", **conditions) == []
    assert said_by(wl.TwinDisc.suros(disc_1=unknown, disc_2=unknown), "9 GPa", **conditions) == []


def test_the_traction_that_is_transmitted_decides_and_not_the_friction() -> None:
    # In stick the patch is as without friction, 1657 MPa at first yield; by k/μ shakedown would end at 1177 MPa.
    assert said_by(RIG, "1.6 GPa", creepage="0.001 %", friction_coefficient=0.46) == []
    assert said_by(RIG, "1.7 GPa", creepage="0.001 %", friction_coefficient=0.46)[0][0] == "first yield"
    assert said_by(RIG, "1.6 GPa", creepage="2 %", friction_coefficient=0.46) == [("the shakedown limit", "1177")]
    assert said_by(RIG, "1.1 GPa", creepage="2 %", friction_coefficient=0.46) == [("first yield", "1005")]
    assert said_by(RIG, "1 GPa", creepage="2 %", friction_coefficient=0.46) == []
    assert said_by(RIG, "1.1 GPa", creepage="-2 %", friction_coefficient=0.46) == [("first yield", "1005")]


def test_of_many_points_the_one_furthest_beyond_shakedown_is_named() -> None:
    found = said_by(RIG, [900.0, 1300.0, 2000.0], creepage=Q([2.0, 2.0, 0.001], "%"), friction_coefficient=0.46)
    assert found == [("the shakedown limit", "1177")]  # and not 2000 MPa, which is 1.2 times first yield


def said_by(rig: wl.TwinDisc, pressure: Any, **conditions: Any) -> list[tuple[str, str]]:
    """Return which limits are said to be passed, and at what pressure in MPa they are."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        load = pressure if isinstance(pressure, str) else Q(pressure, "MPa")
        (rig | wl.contact_model("exact"))(max_pressure=load, **conditions)
    assert all(one.category is wl.PlasticityWarning for one in caught)
    return [re.search(r"beyond (.*), (\d+) MPa", str(one.message)).groups() for one in caught]  # type: ignore[union-attr,misc]


def test_on_an_ellipse_the_limits_are_those_of_its_shape() -> None:
    rails = wl.WheelRail(wheel_radius="460 mm", rail_head_radius="60 mm", material=wl.steel(), rolling_speed="20 m/s")
    contact = rails | wl.contact_model("fastsim")
    given: Any = {"normal_force": "40 kN", "longitudinal_creepage": "0.3 %", "friction_coefficient": 0.3}
    with pytest.warns(wl.PlasticityWarning, match="beyond first yield") as caught:
        r = contact(**given)
    traction = r.traction_coefficient.magnitude
    ratio = float(r.semi_axis_a.magnitude / r.semi_axis_b.magnitude)
    limit = wl.elastic_limit.first_yield(541.3e6, traction, 0.3, poisson_ratio=0.28, axis_ratio=ratio)
    line = wl.elastic_limit.first_yield(541.3e6, traction, 0.3, poisson_ratio=0.28)
    assert abs(float(limit) - float(line)) > 20e6
    assert f"yield, {1e-6 * float(limit):.4g} MPa: " in str(caught[0].message)


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
