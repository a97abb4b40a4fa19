"""The problem of a contact: units in, SI inside, and what is refused."""

from __future__ import annotations

import dataclasses
import pickle
from typing import Any

import numpy as np
import pytest

import wearlaw as wl
from tests.strategies import EPS
from wearlaw import Q
from wearlaw.errors import CompositionError

GIVEN: dict[str, Any] = {
    "a": Q(6, "mm"),
    "b": Q(4, "mm"),
    "normal_force": Q(100, "kN"),
    "shear_modulus": Q(82, "GPa"),
    "poisson_ratio": 0.28,
    "friction_coefficient": 0.3,
    "longitudinal_creepage": Q(0.1, "%"),
    "lateral_creepage": Q(0, "%"),
    "spin": Q(0.001, "1/mm"),
}


def problem(**changes: Any) -> wl.Problem:
    return wl.Problem.ellipse(**{**GIVEN, **changes})


def test_quantities_become_si_arrays_of_one_shape() -> None:
    found = problem(longitudinal_creepage=Q([[0.1], [0.2]], "%"), normal_force=Q([50.0, 100.0, 150.0], "kN"))
    assert found.batch_shape == (2, 3)
    assert found.size == 6
    assert found.geometry == "ellipse"
    for field in dataclasses.fields(found):
        if field.type == "Array":
            assert getattr(found, field.name).shape == (2, 3), field.name
    assert found.a[0, 0] == pytest.approx(6e-3, rel=EPS)
    assert found.spin[0, 0] == pytest.approx(1.0, rel=2 * EPS)
    assert found.longitudinal_creepage[1, 0] == pytest.approx(2e-3, rel=2 * EPS)
    assert found.normal_force[0].tolist() == [5e4, 1e5, 1.5e5]


def test_the_maximum_pressure_carries_the_load() -> None:
    # The volume of half an ellipsoid is two thirds of its height times its base.
    found = problem()
    assert 2.0 / 3.0 * found.max_pressure * np.pi * found.a * found.b == pytest.approx(1e5, rel=4 * EPS)
    assert found.patch_area == pytest.approx(np.pi * 6e-3 * 4e-3, rel=4 * EPS)


def test_the_power_is_the_sum_over_the_creepages() -> None:
    found = problem(lateral_creepage=Q(-0.2, "%"))
    forces = wl.CreepForces(longitudinal=np.array(3e3), lateral=np.array(-4e3), spin_moment=np.array(5.0))
    assert found.power(forces) == pytest.approx(0.001 * 3e3 + 0.002 * 4e3 + 1.0 * 5.0, rel=4 * EPS)
    assert forces.tangential == pytest.approx(5e3, rel=2 * EPS)


def test_points_of_a_batch_can_be_picked_and_the_rest_stays() -> None:
    found = problem(spin=Q([0.0, 1.0, 2.0], "1/m"))
    assert found[1:].spin.tolist() == [1.0, 2.0]
    other = found.with_creepages(found.longitudinal_creepage, found.lateral_creepage, 2.0 * found.spin)
    assert other.spin.tolist() == [0.0, 2.0, 4.0]
    assert other.normal_force is found.normal_force
    assert found.broadcast_to((2, 3)).flatten().spin.tolist() == [0.0, 1.0, 2.0] * 2
    assert pickle.loads(pickle.dumps(found)).spin.tolist() == [0.0, 1.0, 2.0]


def test_every_array_of_a_problem_takes_part_in_its_batch() -> None:
    rig = wl.WheelRail(
        wheel_radius="460 mm", rail_head_radius="300 mm", material=wl.steel(), rolling_speed="30 m/s",
        contact_angle="40 deg",
    )  # fmt: skip
    found = rig.problem(
        normal_force="80 kN",
        longitudinal_creepage=Q([0.1, 0.2, 0.3], "%"),
        friction_coefficient=0.3,
    )
    given = found.replaced(
        traction_coefficient=np.array([0.1, 0.2, 0.3]),
        conditions={"humidity": np.array([0.4, 0.5, 0.6])},
        exists=np.array([True, True, False]),
        dims={"patch": (1, 2, 3)},
        unloaded=np.array([False, False, True]),
    )
    fields = {field.name: getattr(given, field.name) for field in dataclasses.fields(given)}
    assert [name for name, value in fields.items() if value is None] == ["strips"]
    second = given[1:]
    for name, value in fields.items():
        if isinstance(value, np.ndarray):
            np.testing.assert_array_equal(getattr(second, name), value[1:], err_msg=name)
        elif name == "conditions":
            np.testing.assert_array_equal(second.conditions["humidity"], [0.5, 0.6])
        elif name != "strips":
            assert getattr(second, name) == value, name


def test_a_problem_cannot_be_changed() -> None:
    with pytest.raises(dataclasses.FrozenInstanceError):
        problem().a = np.array(1.0)  # type: ignore[misc]


WRONG: list[tuple[dict[str, Any], str]] = [
    ({"a": Q(0, "mm")}, "a: must be greater than zero, got 0 mm"),
    ({"b": Q(np.inf, "mm")}, "b: must be finite, got inf mm"),
    ({"a": 6.0}, "a: got the bare number 6.0, which has no unit; give a in mm"),
    ({"spin": Q(0.3, "rad/s")}, "spin: got 0.3000 rad/s, which does not have the dimension of '1/m'"),
    ({"spin": Q(0.3, "%")}, "spin: got 0.3000 %, which does not have the dimension of '1/m'"),
    ({"longitudinal_creepage": Q(101, "%")}, "longitudinal_creepage: must not exceed 1 in magnitude, got 101.0 %"),
    ({"lateral_creepage": Q(-2, "")}, "lateral_creepage: must not exceed 1 in magnitude, got -2.000"),
    ({"poisson_ratio": 0.6}, "poisson_ratio: must lie between 0 and 0.5, got 0.6"),
    ({"poisson_ratio": "steel"}, "poisson_ratio: 'steel' is not a number with a unit; give poisson_ratio as"),
    ({"friction_coefficient": 0.0}, "friction_coefficient: must be a positive finite number, got 0"),
    ({"a": Q([1, 2], "mm"), "b": Q([1, 2, 3], "mm")}, "the shapes do not broadcast"),
]


@pytest.mark.parametrize(("changes", "message"), WRONG)
def test_wrong_input_is_named(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(wl.InputError) as caught:
        problem(**changes)
    assert str(caught.value).startswith(message)


def test_spin_may_be_given_in_radians_per_length() -> None:
    assert problem(spin=Q(0.3, "rad/m")).spin == pytest.approx(0.3, rel=2 * EPS)


# --- On a line -------------------------------------------------------------------------------------------------------

STEEL = wl.steel()


def line(**changes: Any) -> wl.Problem:
    shear_modulus = STEEL.youngs_modulus / (2.0 * (1.0 + STEEL.poisson_ratio))
    given: dict[str, Any] = {
        "normal_force": Q(7.4, "kN"),
        "track_width": Q(10, "mm"),
        "relative_radius": Q(11.75, "mm"),
        "shear_modulus": shear_modulus,
        "poisson_ratio": STEEL.poisson_ratio,
        "friction_coefficient": 0.46,
        "creepage": Q([-1.0, 2.0], "%"),
        "rolling_speed": Q(2, "m/s"),
    }
    return wl.Problem.line(**{**given, **changes})


def test_a_line_is_that_of_discs_of_its_radius_and_material() -> None:
    discs = wl.TwinDisc.suros(rolling_speed="2 m/s", material=STEEL)
    expected = discs.problem(normal_force="7.4 kN", creepage=Q([-1.0, 2.0], "%"), friction_coefficient=0.46)
    found = line()
    assert found.geometry == expected.geometry == "line"
    for field in dataclasses.fields(expected):
        if isinstance(getattr(expected, field.name), np.ndarray):
            np.testing.assert_allclose(
                getattr(found, field.name), getattr(expected, field.name), rtol=16 * EPS, err_msg=field.name
            )
    assert found.relative_radius == pytest.approx(11.75e-3, rel=8 * EPS)
    assert found.rigid_slip.tolist() == np.abs(found.creepage).tolist()


def test_a_line_without_a_unit_or_of_an_impossible_ratio_is_refused() -> None:
    with pytest.raises(wl.UnitError, match="track_width"):
        line(track_width=0.01)
    with pytest.raises(wl.InputError, match=r"poisson_ratio: must lie between 0 and 0\.5"):
        line(poisson_ratio=0.7)
    with pytest.raises(wl.ConditionsError, match="do not broadcast"):
        line(normal_force=Q([1.0, 2.0, 3.0], "kN"))


def test_what_belongs_to_lines_is_refused_on_an_ellipse() -> None:
    for name in ("normal_force_per_width", "relative_radius"):
        with pytest.raises(CompositionError, match=f"{name}: belongs to line contacts, not to elliptic contacts"):
            getattr(problem(), name)


def test_flattening_makes_no_copies_of_one_number_that_stands_for_all() -> None:
    flat = line().broadcast_to((300, 2)).flatten()
    assert flat.batch_shape == (600,)
    assert flat.rolling_speed.strides == (0,)
    assert flat.creepage.tolist() == [-0.01, 0.02] * 300
