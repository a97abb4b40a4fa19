"""Discs that were weighed: masses, volumes and depths, tables of several shapes, and their conversion on a rig."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Annotated, Any, ClassVar

import numpy as np
import pytest

import wearlaw as wl
from tests.environments import ROOT
from tests.plugins.fits.fits import EXACT, RIG, refused
from tests.strategies import EPS
from wearlaw import Q
from wearlaw.errors import DataError, FitWarning
from wearlaw_apps.fits import WearTests

CREEPAGE = Q([0.5, 1.0, 2.0, 4.0], "%")
TEST: Any = {"creepage": CREEPAGE, "normal_force": Q([5.0, 6.0, 7.0, 8.0], "kN"), "friction_coefficient": 0.45}
ENERGY = EXACT | wl.wear_law("energy", mass_per_energy="5 ug/J")
TURNS = np.array([1e4, 2e4, 3e4, 4e4])

# An independent way from the contact to what a lab measures: Tγ = T ξ, mass 5 µg/J · Tγ · distance, discs of 47 mm and
# 7850 kg/m³ with a track of 10 mm.
XI = np.array([0.005, 0.01, 0.02, 0.04])
DISTANCE = TURNS * math.pi * 0.047


def mass() -> Any:
    """Return the masses that the discs lose [kg]."""
    tangential = EXACT(**TEST).tangential_force.m_as("N")
    return 5e-9 * tangential * XI * DISTANCE


def weighed(**measured: Any) -> WearTests:
    return WearTests.from_arrays(**TEST, **measured)


def found(tests: WearTests, predict: Any = ENERGY, **more: Any) -> float:
    fit = wl.fit(predict, tests, ["mass_per_energy"], bootstrap=0, starts=4, **more)
    return fit.parameters["mass_per_energy"].m_as("ug/J")  # type: ignore[no-any-return]


SPEED = RIG.problem(**TEST).rolling_speed
AROUND = math.pi * 0.047
MEASURES: dict[str, Any] = {
    "distance": lambda: {"mass_loss": Q(mass(), "kg"), "distance": Q(DISTANCE, "m")},
    "revolutions": lambda: {"mass_loss": Q(1e6 * mass(), "mg"), "revolutions": TURNS},
    "turns": lambda: {"mass_loss": Q(1e6 * mass(), "mg"), "revolutions": Q(TURNS / 1000.0, "kiloturn")},
    "cycles": lambda: {"mass_loss": Q(1e6 * mass(), "mg"), "cycles": Q(TURNS, "")},
    "duration": lambda: {"mass_loss": Q(mass(), "kg"), "duration": Q(DISTANCE / SPEED / 3600.0, "hour")},
    "volume": lambda: {"wear_volume": Q(1e9 * mass() / 7850.0, "mm^3"), "revolutions": TURNS},
    "depth": lambda: {"wear_depth": Q(mass() / 7850.0 / (AROUND * 0.01), "m"), "revolutions": TURNS},
    "per distance": lambda: {"mass_per_distance": Q(mass() / DISTANCE, "kg/m")},
    "per cycle": lambda: {"mass_per_cycle": Q(1e9 * mass() / TURNS, "ug")},
}


@pytest.mark.parametrize("measure", MEASURES)
def test_every_measure_gives_the_law_that_made_the_tests(measure: str) -> None:
    # A fit without scatter ends where its parameter changes by less than 1e-9 (`TOLERANCE`).
    assert found(weighed(**MEASURES[measure]())) == pytest.approx(5.0, rel=1e-8)


def test_tests_of_different_measures_are_one_fit() -> None:
    gaps = np.where([True, False, False, False], 1.0, np.nan)
    of_volume = np.where([False, True, False, False], 1.0, np.nan)
    direct = np.where([False, False, True, True], 1.0, np.nan)
    tests = weighed(
        mass_loss=Q(mass() * gaps, "kg"),
        wear_volume=Q(mass() / 7850.0 * of_volume, "m^3"),
        revolutions=TURNS,
        wear_rate=ENERGY(**TEST).wear_rate * direct,
    )
    fit = wl.fit(ENERGY, tests, ["mass_per_energy"], bootstrap=0)
    assert fit.parameters["mass_per_energy"].m_as("ug/J") == pytest.approx(5.0, rel=1e-8)
    assert [text.partition(", ")[0] + ", " + text.split(", ")[1] for text in fit.conversions] == [
        "mass_loss in 1 of 4 tests, of disc_1",
        "wear_volume in 1 of 4 tests, of disc_1",
    ]
    assert "converted             mass_loss in 1 of 4 tests, of disc_1, over revolutions times πD" in repr(fit)
    again = wl.fit(tests=fit.tests, bootstrap=0, **fit.settings)
    assert again.parameters == fit.parameters
    with pytest.warns(FitWarning, match=r"fitted to these tests.*4 of 4"):
        wl.compare([fit], tests)


UNLIKE = wl.TwinDisc.suros(disc_2={"diameter": "94 mm", "material": wl.steel(density="7000 kg/m^3")})  # type: ignore[arg-type]


def test_the_weighed_body_sets_circumference_and_density() -> None:
    predict = UNLIKE | wl.contact_model("exact") | wl.wear_law("energy", mass_per_energy="5 ug/J")
    power = predict.without_law()(**TEST).tangential_force.m_as("N") * XI
    lost = 5e-9 * power * TURNS * math.pi * 0.094
    volume = {"wear_volume": Q(lost / 7000.0, "m^3"), "revolutions": TURNS}
    assert found(weighed(**volume), predict, body="disc_2") == pytest.approx(5.0, rel=1e-8)
    of_2 = EXACT.with_law(wl.wear_law("energy", mass_per_energy="5 ug/J", body="disc_2"))
    of_2 = UNLIKE | of_2.contact_model | of_2.laws[0]
    assert found(weighed(**volume), of_2) == pytest.approx(5.0, rel=1e-8)
    named = weighed(revolutions=TURNS, outcomes={"wear_volume_disc_2": volume["wear_volume"]})
    assert found(named, predict) == pytest.approx(5.0, rel=1e-8)


def test_the_sum_of_both_bodies_is_shared_between_them() -> None:
    twice = {"mass_loss": Q(2.0 * mass(), "kg"), "revolutions": TURNS}
    assert found(weighed(**twice), body="both") == pytest.approx(5.0, rel=1e-8)
    each = {"mass_loss_disc_1": Q(1.5 * mass(), "kg"), "mass_loss_disc_2": Q(0.5 * mass(), "kg")}
    assert found(weighed(revolutions=TURNS, outcomes=each), body="both") == pytest.approx(5.0, rel=1e-8)
    assert found(weighed(revolutions=TURNS, outcomes=each), body="disc_2") == pytest.approx(2.5, rel=1e-8)


def test_each_body_has_its_law_and_its_mass() -> None:
    laws = [wl.wear_law("energy", mass_per_energy="1 ug/J", body=body) for body in ("disc_1", "disc_2")]
    each = {"mass_loss_disc_1": Q(mass(), "kg"), "mass_loss_disc_2": Q(3.0 * mass(), "kg")}
    free = [f"energy_{body}.mass_per_energy" for body in ("disc_1", "disc_2")]
    fit = wl.fit(EXACT.with_law(*laws), weighed(revolutions=TURNS, outcomes=each), free, bootstrap=0)
    assert [fit.parameters[name].m_as("ug/J") for name in free] == pytest.approx([5.0, 15.0], rel=1e-8)


@pytest.mark.filterwarnings("ignore:lack of fit")  # these masses scatter by more than stated
def test_a_balance_or_a_stated_scatter_weighs_the_tests() -> None:
    """One parameter in proportion: weighted least squares in closed form, Σ m x/σ² over Σ x²/σ²."""
    factors = np.array([1.1, 0.9, 1.05, 1.2])
    lost = {"mass_loss": Q(1e6 * mass() * factors, "mg"), "revolutions": TURNS}
    one_step = found(weighed(**lost, balance_resolution="0.1 mg"))
    assert one_step == pytest.approx(5.0 * np.sum(factors * mass() ** 2) / np.sum(mass() ** 2), rel=1e-8)
    scatter = np.array([1.0, 2.0, 5.0, 4.0])
    for ending in ("scatter", "uncertainty"):
        tests = weighed(**lost, outcomes={f"mass_loss_{ending}": Q(scatter, "mg")})
        weights = (mass() / scatter) ** 2
        assert found(tests) == pytest.approx(5.0 * np.sum(factors * weights) / np.sum(weights), rel=1e-8)
    fit = wl.fit(ENERGY, weighed(**lost, balance_resolution="0.1 mg"), ["mass_per_energy"], bootstrap=0)
    # Two readings, each uniform over one step of 0.1 mg, of variance (0.1 mg)²/12.
    assert fit.chi2 == pytest.approx(
        np.sum((1e6 * mass() * (factors - one_step / 5.0)) ** 2) / (2.0 * 0.1**2 / 12.0), rel=1e-6
    )


def test_a_comparison_converts_on_the_rig_of_its_predictors() -> None:
    tests = weighed(mass_loss=Q(mass(), "kg"), revolutions=TURNS)
    double = EXACT | wl.wear_law("energy", mass_per_energy="10 ug/J")
    comparison = wl.compare({"right": ENERGY, "double": double}, tests)
    factors = {one.names.label: one.agreement.rms_factor for one in comparison.compared}
    # A dozen roundings in the conversion and in the prediction.
    assert factors == pytest.approx({"right": 1.0, "double": 2.0}, rel=64 * EPS)
    assert comparison.notes[0].startswith("converted: mass_loss, of disc_1, over revolutions")
    other = wl.TwinDisc.suros(track_width="5 mm") | ENERGY.contact_model | ENERGY.laws[0]
    with pytest.raises(wl.InputError, match="converts the measured wear to another wear rate"):
        wl.compare([ENERGY, other.with_law(other.laws[0].model_copy(update={"label": "narrow"}))], tests)


class Worn(wl.Law):
    """Volume lost per distance rolled, by the energy."""

    name: ClassVar[str] = "worn"
    outcome: ClassVar[wl.Outcome] = wl.Outcome("lost_volume", "mm^3/m", of="patch", wear=True)

    volume_per_energy: Annotated[wl.Quantity, wl.Unit("mm^3/J")] = Q(1e-3, "mm^3/J")
    """Volume over energy."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> wl.Array:
        return p["volume_per_energy"] * contact.wear_index


class Tired(Worn):
    """The same, but no wear."""

    name: ClassVar[str] = "tired"
    outcome: ClassVar[wl.Outcome] = wl.Outcome("fatigue_of_labs", "mm^3/m", of="patch")


class Squared(Worn):
    """Wear in a unit of no wear."""

    name: ClassVar[str] = "squared"
    outcome: ClassVar[wl.Outcome] = wl.Outcome("squared_wear", "mm^6", of="patch", wear=True)


def test_an_outcome_of_a_law_of_ones_own_is_measured_as_mass_if_it_is_wear() -> None:
    predict = EXACT.without_law() | Worn()
    tests = weighed(**MEASURES["revolutions"]())
    fit = wl.fit(predict, tests, ["volume_per_energy"], bootstrap=0)
    assert fit.parameters["volume_per_energy"].m_as("m^3/J") == pytest.approx(5e-9 / 7850.0, rel=1e-8)
    refused(
        r"has a fatigue of labs, .* no wear .*wear=True", EXACT.without_law() | Tired(), tests, ["volume_per_energy"]
    )
    with pytest.raises(DataError, match=r"squared_wear: its unit 'mm\^6' is no mass or volume"):
        wl.fit(EXACT.without_law() | Squared(), tests, ["volume_per_energy"], bootstrap=0)


ONE: Any = {"mass_loss": Q([1.0, 2.0, 3.0, 4.0], "mg")}
HALF = Q([1.0, np.nan, 3.0, 4.0], "mg")
WRONG: dict[str, tuple[dict[str, Any], dict[str, Any], str]] = {
    "gap": ({**ONE, "revolutions": [1e4, 1e4, np.nan, 1e4]}, {}, r"in test number 3, mass_loss needs how far"),
    "two": ({**ONE, "wear_volume": "1 mm^3", "revolutions": 1e4}, {}, "stands in wear_volume and in another column"),
    "rate": ({**ONE, "wear_rate": "1 ug/m/mm^2", "revolutions": 1e4}, {}, "stands in wear_rate and in another column"),
    "body": (
        {**ONE, "revolutions": 1e4},
        {"body": "wheel"},
        "this rig has no 'wheel'; give 'disc_1', 'disc_2' or 'both'",
    ),
    "name": ({**ONE, "revolutions": 1e4, "outcomes": {"mass_loss_scater": HALF}}, {}, "did you mean 'scatter'"),
    "both": (
        {"revolutions": 1e4, "outcomes": {"mass_loss_disc_1": HALF, "mass_loss_disc_2": HALF}},
        {},
        'disc_1 and disc_2 were weighed; say which .* body="disc_1" or body="disc_2" or body="both"',
    ),
    "half": ({"revolutions": 1e4, "outcomes": {"mass_loss_disc_1": HALF}}, {"body": "both"}, "only disc_1 has columns"),
    "depth": ({"wear_depth": "1 um", "revolutions": 1e4}, {"body": "both"}, "wear_depth: is one body's"),
}


@pytest.mark.parametrize("name", WRONG)
def test_what_cannot_be_converted_says_what_is_missing(name: str) -> None:
    measured, options, message = WRONG[name]
    with pytest.raises(DataError, match=message):
        found(weighed(**measured), **options)


def test_unlike_bodies_are_not_weighed_together() -> None:
    predict = UNLIKE | ENERGY.contact_model | ENERGY.laws[0]
    with pytest.raises(DataError, match="revolutions: the bodies differ in diameter; weigh one of them"):
        found(weighed(**ONE, revolutions=1e4), predict, body="both")
    with pytest.raises(DataError, match="disc_2 has another material"):
        found(weighed(**ONE, distance="1 km"), predict, body="both")
    with pytest.raises(DataError, match="mass_loss: add how far the test rolled"):
        weighed(**ONE)


def test_a_rail_makes_no_revolutions() -> None:
    wheel = wl.WheelRail(wheel_radius="460 mm", rail_head_radius="300 mm", material=wl.steel(), rolling_speed="30 m/s")
    predict = wheel | wl.contact_model("fastsim") | wl.wear_law("energy", mass_per_energy="5 ug/J", body="rail")
    given: Any = {"normal_force": "80 kN", "friction_coefficient": 0.3}
    others: Any = {"longitudinal_creepage": Q([0.1, 0.2, 0.3], "%"), "lateral_creepage": "0 %", "spin": "0 1/m"}
    tests = WearTests.from_arrays(**given, other_conditions=others, mass_loss="1 mg", cycles=1e4)
    with pytest.raises(DataError, match="cycles: rail makes no revolutions; give mass_loss with the distance"):
        wl.fit(predict, tests, ["mass_per_energy"], bootstrap=0)
    lost = Q(predict(**given, **others).wear_index.m_as("N") * 5e-9 * 1e3, "kg")
    tests = WearTests.from_arrays(**given, other_conditions=others, mass_loss=lost, distance="1 km")
    # The energy of the nodes is that of the creepages but for FASTSIM's grid: without spin the error is that of strips.
    assert found(tests, predict) == pytest.approx(5.0, rel=0.02)


def test_distances_that_contradict_each_other_are_told() -> None:
    tests = weighed(mass_loss=Q(mass(), "kg"), distance=Q(DISTANCE, "m"), revolutions=1e3 * TURNS)
    with pytest.warns(
        wl.UnusualWarning, match="revolutions: is 1e\\+03 times the distance by distance in tests number 1"
    ):
        assert found(tests) == pytest.approx(5.0, rel=1e-8)


# Tables of labs

HEADS = {
    "label": "Test no.",
    "creepage": "Slip (%)",
    "normal_force": "Load (kN)",
    "friction_coefficient": "COF",
    "revolutions": "Revs",
}
CAMPAIGN = """\
Test no.;Slip / %;Load in kN;COF;Revs;Mass loss, mg
1;0,3;7,4;0,45;60000;226,5
2;0,5;7,4;0,45;60000;586,0
3;0,7;7,4;0,45;60000;1148,1
4;1;7,4;0,45;40000;1141,3
5;1,5;7,4;0,45;40000;1288,6
"""
OF_CAMPAIGN = {
    "creepage": np.array([0.003, 0.005, 0.007, 0.01, 0.015]),
    "normal_force": np.full(5, 7400.0),
    "mass_loss": 1e-6 * np.array([226.5, 586.0, 1148.1, 1141.3, 1288.6]),
    "revolutions": np.array([6e4, 6e4, 6e4, 4e4, 4e4]),
}


def is_campaign(tests: WearTests) -> None:
    for name, values in OF_CAMPAIGN.items():
        np.testing.assert_allclose(tests.columns[name], values, rtol=4 * EPS)
    assert tests.labels == ("1", "2", "3", "4", "5")


def test_a_table_with_decimal_commas_and_heads_of_its_own(tmp_path: Path) -> None:
    (tmp_path / "campaign.csv").write_text(CAMPAIGN, encoding="utf-8")
    columns = {**HEADS, "creepage": "Slip", "normal_force": "Load"}
    is_campaign(wl.read_tests(tmp_path / "campaign.csv", columns=columns, decimal=","))
    with pytest.raises(DataError) as error:
        wl.read_tests(tmp_path / "campaign.csv", decimal=",")
    example = next(text for text in error.value.problems if "columns={" in text)
    assert '"label": "Test no.", "creepage": "Slip / %", "normal_force": "Load in kN"' in example
    assert '--columns creepage="Slip / %"' in example
    (tmp_path / "bare.csv").write_text(CAMPAIGN.replace("Slip / %", "Slip %"), encoding="utf-8")
    with pytest.raises(DataError, match="column 'Slip %': unknown column; did you mean 'creepage'"):
        wl.read_tests(tmp_path / "bare.csv", decimal=",")
    with pytest.raises(DataError, match="there is no column 'Slipp'; did you mean 'Slip'"):
        wl.read_tests(tmp_path / "campaign.csv", columns={**columns, "creepage": "Slipp"}, decimal=",")


def test_a_workbook_with_a_title_and_a_sheet_of_notes() -> None:
    is_campaign(wl.read_tests(ROOT / "tests" / "data" / "campaign.xlsx", sheet="Tests", columns=HEADS))
    with pytest.raises(DataError, match=r"no sheet 'Test'; did you mean 'Tests'\? There are: 'Notes', 'Tests'"):
        wl.read_tests(ROOT / "tests" / "data" / "campaign.xlsx", sheet="Test")
    with pytest.raises(DataError, match="has 2 sheets with cells, 'Notes' and 'Tests'; name one by sheet="):
        wl.read_tests(ROOT / "tests" / "data" / "campaign.xlsx")


def test_an_open_document_with_a_row_of_units() -> None:
    is_campaign(wl.read_tests(ROOT / "tests" / "data" / "campaign.ods"))
    predict = EXACT | wl.wear_law("energy", mass_per_energy="5 ug/J")
    fit = wl.fit(predict, ROOT / "tests" / "data" / "campaign.ods", ["mass_per_energy"], bootstrap=0)
    assert fit.observations[0].measured.size == 5


def test_a_row_of_units_holds_units_alone(tmp_path: Path) -> None:
    for row, expected in {"%,kN,-": 0.01, "[%],[kN],": 0.01, "permille,kN,-": 0.001}.items():
        (tmp_path / "a.csv").write_text(f"creepage,normal_force,traction_coefficient\n{row}\n1,7,0.3\n2,7,0.3\n")
        tests = wl.read_tests(tmp_path / "a.csv")
        assert tests.columns["creepage"][0] == pytest.approx(expected, rel=4 * EPS)
        assert tests.columns["normal_force"][0] == 7000.0
    (tmp_path / "a.csv").write_text("creepage,normal_force,traction_coefficient\n%,kN,-\n1,7,0.3\n2,x,0.3\n")
    with pytest.raises(DataError, match="line 4, column 'normal_force \\[kN\\]': 'x' is not a number"):
        wl.read_tests(tmp_path / "a.csv")


@pytest.mark.parametrize(
    ("creepage", "traction", "says"),
    [
        (Q([0.3, 0.4, 0.45], "%"), [1.0, 5.0, 10.0], "are the columns traction_coefficient and creepage swapped"),
        (Q([1.0, 5.0, 10.0], "%"), [30.0, 40.0, 45.0], "did you mean 40 %"),
        (Q([1.0, 5.0, 10.0], "%"), [0.3, 0.4, 0.45], ""),
    ],
)
def test_columns_that_look_swapped_are_told_before_the_fit(creepage: Any, traction: Any, says: str) -> None:
    tests = WearTests.from_arrays(creepage=creepage, normal_force="7 kN", traction_coefficient=traction)
    remarks = tests.unusual(EXACT)
    assert says in remarks.get("column traction_coefficient", "")
    assert bool(remarks) == bool(says)


def test_a_unit_that_explains_a_column_comes_before_a_swap() -> None:
    """Loads in N under kN are usual wear rates, but their unit explains them, and leaves the wear rates as they are."""
    tests = WearTests.from_arrays(
        creepage=Q([1.0, 2.0, 5.0], "%"),
        normal_force=Q([7400.0, 5200.0, 6300.0], "kN"),
        friction_coefficient=0.4,
        wear_rate=Q([20.0, 40.0, 45.0], "ug/m/mm^2"),
    )
    said = tests.unusual(EXACT)
    assert said == {"column normal_force": "its median is 6300 kN, usually 0.01 to 300 kN; did you mean 6300 N?"}
    percent = WearTests.from_arrays(
        creepage=Q([1.0, 5.0, 10.0], "%"), normal_force="7 kN", friction_coefficient=45.0, wear_rate="20 ug/m/mm^2"
    )
    assert "; did you mean 45 %?" in percent.unusual(EXACT)["column friction_coefficient"]


@pytest.mark.parametrize(
    ("heads", "says"),
    [
        (
            "Versuch,Schlupf [%],Last [kN],Verlust [mg]",
            'columns={"creepage": "Schlupf [%]", "normal_force": "Last [kN]", ',
        ),
        ("creepage [%],normal_force [kN],cycles [thousand],mass_loss [mg]", "convert it, or state its unit by columns"),
        ("creepage [%],0.3,0.5,1.0", "the heads are numbers; turn the table, so that each test has a row"),
        ("a [%],b [kN],c [-],d [mg]", "a, b, c, d: no conditions of this rig, so say what they are by columns"),
    ],
)
def test_heads_that_are_not_known_say_what_to_do(tmp_path: Path, heads: str, says: str) -> None:
    (tmp_path / "a.csv").write_text(f"{heads}\n1,7,30,200\n2,7,30,300\n")
    with pytest.raises(wl.WearlawError, match=re.escape(says)):
        wl.fit(EXACT | wl.wear_law("usfd", fitted_for="exact"), tmp_path / "a.csv", ["m_m"])
