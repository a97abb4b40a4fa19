"""Wear tests as arrays: their contents, their selection, and their conditions for a rig."""

from __future__ import annotations

import dataclasses
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given

import wearlaw as wl
from tests.strategies import EPS, log_uniform
from wearlaw import Q
from wearlaw.errors import DataError
from wearlaw_apps.fits import WearTests

NAN = np.nan


def made(**changes: Any) -> WearTests:
    """Return three tests, the second without wear and the third without traction, with some columns changed."""
    columns: dict[str, Any] = {
        "creepage": Q([0.5, 1.0, 5.0], "%"),
        "normal_force": Q([7.0, 7.5, 8.0], "kN"),
        "traction_coefficient": [0.2, 0.4, NAN],
        "wear_rate": Q([10.0, NAN, 50.0], "ug/m/mm^2"),
        "labels": ["a", "b", "c"],
        "source": "a test",
    }
    return WearTests.from_arrays(**{k: v for k, v in (columns | changes).items() if v is not None})


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


def test_one_value_stands_for_all_tests_and_one_test_is_a_table_too() -> None:
    np.testing.assert_array_equal(made(normal_force="7 kN").columns["normal_force"], [7000.0] * 3)
    one = WearTests.from_arrays(creepage="1 %", max_pressure="1.5 GPa", wear_rate="30 ug/m/mm^2")
    assert len(one) == 1
    assert one.labels == ("",)
    assert one.source == ""


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
    for key in (tests.creepage >= Q(1, "%"), slice(1, None), [1, 2], np.array([False, True, True])):
        last = tests[key]
        assert (last.labels, last.source) == (("b", "c"), "a test")
        np.testing.assert_array_equal(last.columns["normal_force"], [7500.0, 8000.0])
    assert tests[-1].labels == ("c",)
    assert [one.labels for one in tests] == [("a",), ("b",), ("c",)]


def test_a_spreadsheet_is_told(tmp_path: Path) -> None:
    (tmp_path / "tests.xlsx").write_bytes(b"PK\x03\x04\x14\x00\x06\x00")
    with pytest.raises(DataError, match="save its sheet as CSV"):
        wl.read_tests(tmp_path / "tests.xlsx")


def test_selecting_none_is_refused_and_there_is_no_fourth_of_three() -> None:
    tests = made()
    with pytest.raises(DataError, match="none of the 3 tests is selected"):
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
    with pytest.raises(wl.ConditionsError, match="friction_coefficient: is missing; add a column"):
        made().conditions(EXACT)


def test_measured_traction_is_a_condition_where_all_tests_have_it_and_the_model_can_use_it() -> None:
    tests = made()
    measured = tests[:2].conditions(GLOBAL, 0.46)
    np.testing.assert_array_equal(measured["traction_coefficient"], [0.2, 0.4])
    np.testing.assert_array_equal(RIG.problem(**measured).traction_coefficient, [0.2, 0.4])
    assert "traction_coefficient" not in tests.conditions(GLOBAL, 0.46)
    assert "traction_coefficient" not in tests[:2].conditions(EXACT, 0.46)
    assert "traction_coefficient" not in made(traction_coefficient=None).conditions(GLOBAL, 0.46)


# Records


def test_a_test_is_known_again_by_its_digest_in_other_units() -> None:
    digests = made(other_conditions={"mass": Q(1.0, "t")}).digests("wear_rate", "ug/m/mm^2")
    assert digests == made(other_conditions={"mass": Q(1000.0, "kg")}, source="").digests("wear_rate", "kg/m^3")
    assert digests != made(other_conditions={"mass": Q(999.0, "kg")}).digests("wear_rate", "kg/m^3")


def test_tests_are_copies_and_survive_pickling() -> None:
    rate = np.array([1.0, 2.0, 3.0])
    tests = made(wear_rate=Q(rate, "kg/m^3"))
    rate[0] = 9.0
    assert tests.columns["wear_rate"][0] == 1.0
    assert repr(pickle.loads(pickle.dumps(tests))) == repr(tests)


def test_the_repr_is_a_short_summary() -> None:
    assert repr(made()).splitlines() == [
        "3 tests",
        "  creepage               0.5 to 5 %",
        "  normal_force           7 to 8 kN",
        "  traction_coefficient   0.2 to 0.4 in 2",
        "  wear_rate              10 to 50 µg/m/mm² in 2",
        "from a test",
    ]
    one = WearTests.from_arrays(creepage="1 %", normal_force_per_width="700 kN/m", wear_rate=Q(NAN, "ug/m/mm^2"))
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
    again = wl.read_tests(table)
    assert again.labels == tests.labels
    for name, values in tests.columns.items():
        np.testing.assert_allclose(again.columns[name], values, rtol=4 * EPS)
    assert "label" not in made(labels=None).to_dataframe()


# Files

HEAD = "label,creepage [%],normal_force [kN],wear_rate [ug/m/mm^2]"
GOOD = f"{HEAD}\na,1,7.4,30\nb,-2,7.4,40\n"
HEAT = "creepage [%],normal_force [kN],frictional_heat [W],rolling_speed [km/h]"


def read(text: str, folder: Path, **options: Any) -> WearTests:
    """Return the tests of a file."""
    path = folder / "mine.csv"
    path.write_text(text, encoding="utf-8")
    return wl.read_tests(path, **options)


@pytest.mark.parametrize(
    ("text", "options"),
    [
        (GOOD, {}),
        (GOOD.replace("[%]", "[permille]").replace("a,1", "a,10").replace("b,-2", "b,-20"), {}),
        (GOOD.replace("[ug/m/mm^2]", "[kg/m^3]").replace("30", "0.03").replace("40", "0.04"), {}),
        (GOOD.replace(",", ";").replace("7.4", "7,4"), {"decimal": ","}),
        (GOOD.replace(",", "|"), {"sep": "|"}),
        (f"# comment: words\n{GOOD}", {}),
    ],
)
def test_units_separators_and_decimals_of_a_file(text: str, options: dict[str, str], tmp_path: Path) -> None:
    tests = read(text, tmp_path, **options)
    np.testing.assert_allclose(tests.columns["creepage"], [0.01, -0.02], rtol=4 * EPS)
    np.testing.assert_allclose(tests.columns["normal_force"], 7400.0, rtol=4 * EPS)
    np.testing.assert_allclose(tests.columns["wear_rate"], [0.03, 0.04], rtol=4 * EPS)
    assert (tests.labels, tests.source) == (("a", "b"), "mine.csv")


def test_the_source_and_gaps_of_a_file(tmp_path: Path) -> None:
    tests = read(f"# Source:  a lab \n{GOOD}c,1,7,NA\n", tmp_path)
    assert tests.source == "a lab"
    np.testing.assert_array_equal(np.isnan(tests.wear_rate.magnitude), [False, False, True])


def test_other_conditions_and_outcomes_of_a_file(tmp_path: Path) -> None:
    # lateral_creepage resembles creepage, which the file lacks, but is a condition of an installed rig.
    text = "mass [kg],lateral_creepage [-],friction_coefficient,heat_flux [W/mm^2]\n20,0.001,0.3,2\n40,0,0.3,NA\n"
    tests = read(text, tmp_path, outcomes=["heat_flux"])
    assert (set(tests.other_conditions), set(tests.outcomes)) == ({"mass", "lateral_creepage"}, {"heat_flux"})
    assert str(tests[1].other_conditions["mass"]) == str(Q([40.0], "kg"))
    assert "mass                   20 to 40 kg\n" in repr(tests)
    assert wl.read_tests(tests.to_dataframe(), outcomes=["heat_flux"]).other_conditions.keys() == {
        "mass",
        "lateral_creepage",
    }
    np.testing.assert_array_equal(tests.measured("heat_flux", "W/m^2"), [2e6, NAN])
    with pytest.raises(DataError, match="heat_flux"):
        tests.measured("heat_flux", "kg")
    with pytest.raises(DataError, match="heat_flux"):  # a condition must be known in every test
        read(text, tmp_path)


def test_shipped_tests_come_before_a_file_of_that_name(folder: Path) -> None:
    Path("lewis2004").write_text(GOOD, encoding="utf-8")
    assert "Dwyer-Joyce" in wl.read_tests("lewis2004").source
    assert wl.read_tests("./lewis2004").labels == ("a", "b")
    read(GOOD, folder)
    with pytest.raises(DataError, match=r"mine\.csv"):
        wl.read_tests("mime.csv")


FAULTY = [
    *(
        (GOOD.replace(old, new, 1), named)
        for old, new, named in [
            ("creepage [%]", "creepage", "creepage"),
            ("creepage [%]", "crepage [%]", "did you mean 'creepage'"),
            ("creepage [%]", "slide_creepage [%]", "slide_creepage"),
            ("label,", "max_pressur [MPa],", "did you mean 'max_pressure'"),
            ("label,", "p0 [GPa],", "did you mean 'max_pressure'"),
            ("label", "friction", "did you mean 'friction_coefficient'"),
            ("label", "Wear [mg]", "did you mean 'mass_loss'"),
            ("label", "mass [kgg]", "kgg"),
            ("label", "mass [kg]", "line 2, column 'mass"),
            ("[kN]", "[weights]", "normal_force"),
            ("label", "creepage [-]", "creepage"),
            ("40", "-40", "line 3, column 'wear_rate"),
            ("-2", "", "line 3, column 'creepage"),
            ("-2", "two", "line 3, column 'creepage"),
            ("7.4,40", "7,4,40", "line 3"),
        ]
    ),
    (f"{HEAT}\n1,7.4,3,1\n0,7.4,2,1\n", "line 3, column 'frictional_heat"),
    (f"{HEAT}\n1,7.4,3,1\n1,7.4,2,\n", "line 3, column 'frictional_heat"),
    (HEAD, "no test"),
]


@pytest.mark.parametrize(("text", "named"), FAULTY)
def test_what_is_wrong_with_a_file_is_named(text: str, named: str, tmp_path: Path) -> None:
    with pytest.raises(DataError, match=named):
        read(text, tmp_path)


def test_all_faults_of_a_file_are_named(tmp_path: Path) -> None:
    with pytest.raises(DataError) as refusal:
        read(f"{HEAD}\na,1,-7,-30\na,200,7,1\n", tmp_path)
    assert len(refusal.value.problems) == 3


# Wrong arrays

WRONG: list[tuple[str, dict[str, Any]]] = [
    ("creepage", {"creepage": [0.5, 1.0, 5.0]}),
    ("creepage", {"creepage": Q([1.0, NAN, 5.0], "%")}),
    ("creepage", {"creepage": Q([1.0, 2.0, -101.0], "%")}),
    ("creepage", {"creepage": "1 N"}),
    ("creepage", {"creepage": "one"}),
    ("one load", {"normal_force": None}),
    ("one load", {"max_pressure": "1 GPa"}),
    ("normal_force", {"normal_force": Q(0, "N")}),
    ("normal_force", {"normal_force": Q([1, 2, np.inf], "N")}),
    ("one length", {"normal_force": Q([1, 2], "N")}),
    ("one length", {"normal_force": Q([[1, 2, 3]], "N")}),
    ("wear_rate", {"wear_rate": Q([1, 2, -3], "ug/m/mm^2")}),
    ("wear_rate", {"wear_rate": Q([1, 2, 3], "ug/m")}),
    ("nothing is measured", {"wear_rate": None, "traction_coefficient": None}),
    ("wear_rate_uncertainty", {"wear_rate_uncertainty": Q(0, "ug/m/mm^2")}),
    ("wear_rate_uncertainty", {"wear_rate": None, "wear_rate_uncertainty": "1 ug/m/mm^2"}),
    ("friction_coefficient", {"friction_coefficient": 0.0}),
    ("friction_coefficient", {"friction_coefficient": [0.3, 0.4, NAN]}),
    ("friction_coefficient", {"friction_coefficient": Q(0.4, "N")}),
    ("traction_coefficient", {"traction_coefficient": -0.1}),
    ("tangential_force", {"tangential_force": "1 N"}),
    ("rolling_speed", {"rolling_speed": "1 m/s"}),
    ("rolling_speed", {"traction_coefficient": None, "frictional_heat": "1 W"}),
    (
        "tangential_force",
        {"traction_coefficient": None, "normal_force": None, "max_pressure": "1 GPa", "tangential_force": "1 N"},
    ),
    ("did you mean 'creepage'", {"crepage": Q([1.0, 2.0, 3.0], "%")}),
    ("creepage", {"other_conditions": {"creepage": "1 %"}}),
    ("labels", {"labels": ["a", "b"]}),
    ("labels", {"labels": "abc"}),
]


@pytest.mark.parametrize(("named", "changes"), WRONG)
def test_wrong_arrays_are_refused_by_name(named: str, changes: dict[str, Any]) -> None:
    with pytest.raises(DataError, match=named):
        made(**changes)
