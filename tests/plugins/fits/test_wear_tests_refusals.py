"""Wear tests as arrays: what is wrong is named by its array."""

from __future__ import annotations

import pickle
from typing import Any

import numpy as np
import pytest

import wearlaw as wl
from tests.plugins.fits.wear_tests import NAN, made
from wearlaw import Q

REFUSED: list[tuple[dict[str, Any], str]] = [
    ({"creepage": [0.5, 1.0, 5.0]}, "creepage: has no unit; give it such as Q([1.0, 2.0], '%')"),
    ({"creepage": Q([1.0, NAN, 5.0], "%")}, "creepage: nan % at index 1 is missing; every test needs it"),
    ({"creepage": Q([1.0, 2.0, -101.0], "%")}, "creepage: -101.0 % at index 2 must not exceed 100 % in magnitude"),
    ({"creepage": "1 N"}, "creepage: got 'newton', which does not have the dimension of '%'; give it in %"),
    ({"creepage": "one"}, "creepage: 'one' is not a number with a unit"),
    ({"normal_force": None}, "give exactly one load of normal_force [kN], normal_force_per_width [kN/m], max_pres"),
    ({"max_pressure": "1 GPa"}, "give exactly one load of normal_force [kN], normal_force_per_width [kN/m], max_pr"),
    ({"normal_force": Q(0, "N")}, "normal_force: 0.000 kN at index 0 must be greater than zero"),
    ({"normal_force": Q([1, 2, np.inf], "N")}, "normal_force: inf kN at index 2 must be finite"),
    ({"normal_force": Q(1e306, "MN")}, "normal_force: inf kN at index 0 must be finite"),
    ({"normal_force": Q([1, 2], "N")}, "give arrays with one entry for each test, all of one length; got creepage (3,"),
    ({"normal_force": Q([[1, 2, 3]], "N")}, "give arrays with one entry for each test, all of one length; got cree"),
    ({"wear_rate": Q([1, 2, -3], "ug/m/mm^2")}, "wear_rate: -3.000 µg/m/mm² at index 2 must not be negative"),
    ({"wear_rate": Q([1, 2, 3], "ug/m")}, "wear_rate: got 'microgram / meter', which does not have the dimension of"),
    ({"wear_rate": [True, False, True]}, "wear_rate: has no unit"),
    ({"wear_rate": None, "traction_coefficient": None}, "nothing is measured; add a column 'wear_rate [ug/m/mm^2]' or"),
    ({"wear_rate_uncertainty": Q(0, "ug/m/mm^2")}, "wear_rate_uncertainty: 0.000 µg/m/mm² at index 0 must be greater"),
    (
        {"wear_rate": None, "wear_rate_uncertainty": "1 ug/m/mm^2"},
        "wear_rate_uncertainty: there is no wear_rate beside it",
    ),
    ({"friction_coefficient": 0.0}, "friction_coefficient: 0.000 at index 0 must be greater than zero"),
    ({"friction_coefficient": [0.3, 0.4, NAN]}, "friction_coefficient: nan at index 2 is missing; every test needs it"),
    ({"friction_coefficient": Q(0.4, "N")}, "friction_coefficient: got 'newton', which is not a ratio; give it as a p"),
    ({"friction_coefficient": [True] * 3}, "friction_coefficient: [True, True, True] is not a real number"),
    ({"traction_coefficient": -0.1}, "traction_coefficient: -0.1000 at index 0 must be greater than zero"),
    ({"tangential_force": "1 N"}, "traction_coefficient and tangential_force: all give the traction; keep one of them"),
    ({"rolling_speed": "1 m/s"}, "rolling_speed: belongs to the rig; it is only needed beside frictional_heat"),
    (
        {"traction_coefficient": None, "frictional_heat": "1 W"},
        "frictional_heat: is T × creepage × rolling speed; add a column 'rolling_speed [m/s]' beside it",
    ),
    (
        {"traction_coefficient": None, "normal_force": None, "max_pressure": "1 GPa", "tangential_force": "1 N"},
        "tangential_force: T/N follows from it only where the load is normal_force, not max_pressure",
    ),
    (
        {
            "traction_coefficient": None,
            "frictional_heat": "1 W",
            "rolling_speed": Q([1, NAN, 1], "m/s"),
        },
        "rolling_speed: nan m/s at index 1 is missing; frictional_heat needs it",
    ),
    (
        {
            "traction_coefficient": None,
            "frictional_heat": "1 W",
            "rolling_speed": "1 m/s",
            "creepage": Q([0, 1, 2], "%"),
        },
        "frictional_heat: 1.000 W at index 0 gives a traction coefficient of inf; check the creepage and the units",
    ),
    (
        {"traction_coefficient": None, "tangential_force": "1e-320 N", "normal_force": "1e10 N"},
        "tangential_force: 1.000e-320 N at index 0 gives a traction coefficient of 0",
    ),
    (
        {"creepage": Q([], "%"), "normal_force": "1 N", "wear_rate": "1 kg/m^3", "traction_coefficient": None},
        "give arrays with one entry for each test, all of one length; got creepage (0,), normal_force (), wear_rate ()",
    ),
    ({"labels": ["a", "b"]}, "labels: give one text for each of the 3 tests, got ['a', 'b']"),
    ({"labels": "abc"}, "labels: give one text for each of the 3 tests, got 'abc'"),
]


@pytest.mark.parametrize(("changes", "message"), REFUSED, ids=[message[:60] for _, message in REFUSED])
def test_wrong_arrays_are_refused_by_name(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(wl.DataError) as refusal:
        made(**changes)
    assert message in str(refusal.value)


def test_all_that_is_wrong_is_said_up_to_twenty_faults() -> None:
    with pytest.raises(wl.DataError) as refusal:
        made(wear_rate=Q([-1, -2, -3], "kg/m^3"), normal_force=Q([1, -1, -2], "N"))
    assert len(refusal.value.problems) == 5
    assert len(str(refusal.value).splitlines()) == 6
    many = Q(np.full(25, -1.0), "kg/m^3")
    with pytest.raises(wl.DataError) as refusal:
        wl.WearTests.from_arrays(creepage="1 %", normal_force="1 N", wear_rate=many)
    lines = str(refusal.value).splitlines()
    assert len(refusal.value.problems) == 25
    assert len(lines) == 1 + 20 + 1
    assert lines[-1] == "  ... and 5 more"
    assert str(pickle.loads(pickle.dumps(refusal.value))) == str(refusal.value)


@pytest.mark.parametrize(
    ("load", "unit"), [("normal_force", "kN"), ("normal_force_per_width", "kN/m"), ("max_pressure", "MPa")]
)
def test_a_wrong_unit_says_which_would_be_right(load: str, unit: str) -> None:
    with pytest.raises(wl.DataError, match=f"give it in {unit} or another unit of that dimension"):
        made(**{"normal_force": None, load: Q(1.0, "furlong")})
