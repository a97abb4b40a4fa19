"""Wear tests as arrays: their contents, their selection, and their conditions for a rig."""

from __future__ import annotations

import dataclasses
import io
import pickle
from typing import Any

import numpy as np
import pint
import pytest
from hypothesis import given

import wearlaw as wl
from tests.plugins.fits.wear_tests import NAN, made
from tests.strategies import EPS, log_uniform
from wearlaw import Q
from wearlaw_fits.wear_tests.reader import parse_tests

RIG = wl.TwinDisc.suros()
GLOBAL, EXACT = wl.contact_model("global"), wl.contact_model("exact")


# What they hold


def test_columns_come_out_with_the_units_and_gaps_they_went_in_with() -> None:
    tests = made(wear_rate_uncertainty=Q([1.0, NAN, 5.0], "ug/m/mm^2"), friction_coefficient=[0.4, 0.45, 0.5])
    assert len(tests) == 3
    # Each value is converted to SI and back: two roundings.
    close: Any = {"rtol": 2 * EPS}
    np.testing.assert_allclose(tests.creepage.to("%").magnitude, [0.5, 1.0, 5.0], **close)
    np.testing.assert_allclose(tests.wear_rate.to("ug/m/mm^2").magnitude, [10.0, NAN, 50.0], **close)
    np.testing.assert_array_equal(tests.traction_coefficient.magnitude, [0.2, 0.4, NAN])
    np.testing.assert_array_equal(tests.friction_coefficient, [0.4, 0.45, 0.5])
    assert tests.wear_rate_uncertainty is not None
    np.testing.assert_allclose(tests.wear_rate_uncertainty.to("mg/m/mm^2").magnitude, [1e-3, NAN, 5e-3], rtol=4 * EPS)
    assert tests.labels == ("a", "b", "c")
    assert tests.source == "a test"


def test_columns_are_si_arrays_by_name_in_one_order() -> None:
    tests = made()
    assert list(tests.columns) == ["creepage", "normal_force", "traction_coefficient", "wear_rate"]
    np.testing.assert_array_equal(tests.columns["normal_force"], [7000.0, 7500.0, 8000.0])
    # 1 µg/(m mm²) is 1e-9 kg / 1e-6 m³.
    np.testing.assert_allclose(tests.columns["wear_rate"], [10e-3, NAN, 50e-3], rtol=4 * EPS)


def test_what_was_not_measured_is_missing_in_all_tests_and_what_was_not_given_is_none() -> None:
    tests = made(traction_coefficient=None)
    assert np.isnan(tests.traction_coefficient.magnitude).all()
    assert tests.traction_coefficient.magnitude.shape == (3,)
    assert np.isnan(made(wear_rate=None).wear_rate.magnitude).all()
    assert tests.friction_coefficient is None
    assert tests.wear_rate_uncertainty is None


def test_one_value_stands_for_all_tests_and_one_test_is_a_table_too() -> None:
    np.testing.assert_array_equal(made(normal_force="7 kN").columns["normal_force"], [7000.0] * 3)
    one = wl.WearTests.from_arrays(creepage="1 %", max_pressure="1.5 GPa", wear_rate="30 ug/m/mm^2")
    assert len(one) == 1
    assert one.labels == ("",)
    assert one.source == ""


def test_quantities_of_another_registry_are_understood() -> None:
    other: Any = pint.UnitRegistry()
    tests = made(normal_force=other.Quantity(np.array([7.0, 7.5, 8.0]), "kN"))
    assert tests == made()


# Traction


@given(force=log_uniform(1.0, 1e4), load=log_uniform(1e2, 1e5))
def test_traction_is_the_force_over_the_load(force: float, load: float) -> None:
    tests = made(traction_coefficient=None, tangential_force=Q([force, NAN, force], "N"), normal_force=Q(load, "N"))
    assert list(tests.columns) == ["creepage", "normal_force", "traction_coefficient", "wear_rate"]
    np.testing.assert_allclose(tests.columns["traction_coefficient"], [force / load, NAN, force / load], rtol=4 * EPS)


@given(traction=log_uniform(0.01, 1.0), creepage=log_uniform(1e-5, 1.0), speed=log_uniform(0.1, 50.0))
def test_traction_from_heat_dissipates_that_heat(traction: float, creepage: float, speed: float) -> None:
    # Power is force times slip velocity, whichever way the disc slips.
    load = 7000.0
    heat = traction * load * creepage * speed
    tests = made(
        traction_coefficient=None,
        creepage=Q([creepage, -creepage, creepage], ""),
        normal_force=Q(load, "N"),
        frictional_heat=Q([heat, heat, NAN], "W"),
        rolling_speed=Q([speed, speed, NAN], "m/s"),
    )
    assert "rolling_speed" not in tests.columns
    np.testing.assert_allclose(tests.traction_coefficient.magnitude, [traction, traction, NAN], rtol=8 * EPS)


# Selection


def test_a_mask_a_slice_and_an_index_select_tests() -> None:
    tests = made()
    last = tests[tests.creepage >= Q(1, "%")]
    assert last.labels == ("b", "c")
    assert last == tests[1:] == tests[[1, 2]] == tests[np.array([False, True, True])]
    np.testing.assert_array_equal(last.columns["normal_force"], [7500.0, 8000.0])
    assert last.source == "a test"
    assert tests[-1] == tests[2:]
    assert [one.labels for one in tests] == [("a",), ("b",), ("c",)]


def test_selecting_none_is_refused_and_there_is_no_fourth_of_three() -> None:
    tests = made()
    with pytest.raises(wl.DataError, match="none of the 3 tests is selected"):
        tests[tests.creepage > Q(50, "%")]
    with pytest.raises(IndexError):
        tests[3]


# Conditions


@pytest.mark.parametrize(
    ("load", "values"),
    [("normal_force", Q(7.0, "kN")), ("normal_force_per_width", Q(700, "kN/m")), ("max_pressure", Q(1.4, "GPa"))],
)
def test_the_conditions_are_those_of_a_problem_of_the_rig(load: str, values: Any) -> None:
    tests = made(**{"normal_force": None, load: values})
    problem = RIG.problem(**tests.conditions(EXACT, 0.46))
    expected = RIG.problem(**{load: values}, creepage=Q([0.5, 1.0, 5.0], "%"), friction_coefficient=0.46)
    for name in (field.name for field in dataclasses.fields(expected)):
        if isinstance(getattr(expected, name), np.ndarray):
            np.testing.assert_allclose(getattr(problem, name), getattr(expected, name), rtol=8 * EPS)
    assert problem.traction_coefficient is None


def test_friction_is_that_of_the_tests_before_that_of_the_argument_and_must_be_known() -> None:
    holding = made(friction_coefficient=[0.3, 0.4, 0.5])
    for given_too in (None, 0.1):
        np.testing.assert_array_equal(holding.conditions(EXACT, given_too)["friction_coefficient"], [0.3, 0.4, 0.5])
    assert made().conditions(EXACT, 0.46)["friction_coefficient"] == 0.46
    with pytest.raises(wl.ConditionsError, match="friction_coefficient: the tests do not hold it; add a column"):
        made().conditions(EXACT)


def test_measured_traction_is_a_condition_where_all_tests_have_it_and_the_model_can_use_it() -> None:
    tests = made()
    measured = tests[:2].conditions(GLOBAL, 0.46)
    np.testing.assert_array_equal(measured["traction_coefficient"], [0.2, 0.4])
    np.testing.assert_array_equal(RIG.problem(**measured).traction_coefficient, [0.2, 0.4])
    assert "traction_coefficient" not in tests.conditions(GLOBAL, 0.46)
    assert "traction_coefficient" not in tests[:2].conditions(EXACT, 0.46)
    assert "traction_coefficient" not in made(traction_coefficient=None).conditions(GLOBAL, 0.46)


def test_tests_are_predicted_one_by_one() -> None:
    predict = RIG | EXACT | wl.wear_law("usfd", fitted_for="exact")
    tests = made(friction_coefficient=0.4)
    together = predict(**tests.conditions(EXACT)).wear_rate
    alone = [predict(**one.conditions(EXACT)).wear_rate.magnitude[0] for one in tests]
    np.testing.assert_allclose(together.magnitude, alone, rtol=16 * EPS)


# Records


def test_equal_tests_are_equal_also_with_gaps_and_others_are_not() -> None:
    assert made() == made()
    assert made() != made(creepage=Q([0.5, 1.0, 5.5], "%"))
    assert made() != made(labels=["a", "b", "d"])
    assert made() != made(source="another")
    assert made() != made(traction_coefficient=[0.2, NAN, NAN])
    assert made() != made(wear_rate=None)
    assert made() != "tests"


def test_tests_never_change_not_even_as_copies() -> None:
    rate = np.array([1.0, 2.0, 3.0])
    tests = made(wear_rate=Q(rate, "kg/m^3"))
    rate[0] = 9.0
    again = pickle.loads(pickle.dumps(tests))
    assert again == tests
    for one in (tests, again, tests[:2]):
        assert one.columns["wear_rate"][0] == 1.0
        with pytest.raises(ValueError, match="read-only"):
            one.columns["wear_rate"][0] = 9.0
        with pytest.raises(TypeError):
            one.columns["wear_rate"] = rate  # type: ignore[index]
        with pytest.raises(dataclasses.FrozenInstanceError):
            one.source = "changed"  # type: ignore[misc]


def test_the_repr_is_a_short_summary() -> None:
    assert repr(made()).splitlines() == [
        "3 tests",
        "  creepage               0.5 to 5 %",
        "  normal_force           7 to 8 kN",
        "  traction_coefficient   0.2 to 0.4 in 2",
        "  wear_rate              10 to 50 µg/m/mm² in 2",
        "from a test",
    ]
    one = wl.WearTests.from_arrays(creepage="1 %", normal_force_per_width="700 kN/m", wear_rate=Q(NAN, "ug/m/mm^2"))
    assert repr(one).splitlines() == [
        "1 test",
        "  creepage               1 %",
        "  normal_force_per_width 700 kN/m",
        "  wear_rate              none",
    ]


def test_the_table_has_units_in_its_head_and_reads_back() -> None:
    tests = made(wear_rate_uncertainty=Q([1.0, NAN, 5.0], "ug/m/mm^2"))
    table = tests.to_dataframe()
    assert list(table) == [
        "label",
        "creepage [%]",
        "normal_force [kN]",
        "traction_coefficient",
        "wear_rate [ug/m/mm^2]",
        "wear_rate_uncertainty [ug/m/mm^2]",
    ]
    assert list(table["normal_force [kN]"]) == [7.0, 7.5, 8.0]
    buffer = io.StringIO()
    table.to_csv(buffer, index=False)
    again = parse_tests(buffer.getvalue(), "a test")
    assert again.labels == tests.labels
    for name, values in tests.columns.items():
        np.testing.assert_allclose(again.columns[name], values, rtol=4 * EPS)
    assert "label" not in made(labels=None).to_dataframe()
