"""Values outside what people usually have: one warning a call, with the slip of unit that is likely."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any, ClassVar, TypedDict, Unpack

import numpy as np
import pandas as pd
import pytest

import wearlaw as wl
from wearlaw import Q
from wearlaw.errors import FitWarning
from wearlaw_apps.fits import WearTests
from wearlaw_models.laws.archard import Archard

STEEL = wl.steel(shear_yield_stress=None)
WHEEL: dict[str, Any] = {
    "wheel_radius": "460 mm",
    "rail_head_radius": "300 mm",
    "material": STEEL,
    "rolling_speed": "20 m/s",
}
ROLLING: dict[str, Any] = {"longitudinal_creepage": "0.2 %", "friction_coefficient": 0.3}
DISCS: dict[str, Any] = {"max_pressure": "1200 MPa", "creepage": "1 %", "friction_coefficient": 0.4}
FASTSIM, EXACT = wl.contact_model("fastsim"), wl.contact_model("exact")
GLOBAL = wl.contact_model("global")


def said(call: Callable[[], Any]) -> list[str]:
    """Return the warnings of unusual values in a call, which come from the line of the caller."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        call()
    found = [one for one in caught if issubclass(one.category, wl.UnusualWarning)]
    assert {one.filename for one in found} <= {__file__}
    return [str(one.message) for one in found]


def material(**changes: Any) -> wl.Material:
    return wl.Material(**{"youngs_modulus": "206 GPa", "poisson_ratio": 0.28, "density": "7850 kg/m^3", **changes})


def on_rail(rig: dict[str, Any] | None = None, **conditions: Any) -> wl.Prediction:
    predict = wl.WheelRail(**WHEEL | (rig or {})) | FASTSIM
    return predict(**{"normal_force": "80 kN", **ROLLING, **conditions})


SLIPS: list[tuple[Callable[[], Any], str]] = [
    (
        lambda: material(density="7.85 kg/m^3"),
        "Material: density: is 7.85 kg/m³, usually 500 to 25000 kg/m³; did you mean 7.85 g/cm³?",
    ),
    (lambda: material(youngs_modulus="210 MPa"), "usually 1 to 1200 GPa; did you mean 210 GPa?"),
    (
        lambda: wl.WheelRail(**WHEEL | {"wheel_radius": "920 mm"}),
        "wheel_radius: is 920 mm, usually 10 to 700 mm; is it the diameter?",
    ),
    (lambda: wl.WheelRail(**WHEEL | {"wheel_radius": "0.46 mm"}), "did you mean 0.46 m?"),
    (lambda: wl.WheelRail(**WHEEL | {"rolling_speed": "3000 m/s"}), "rolling_speed: is 3000 m/s, usually"),
    (lambda: wl.TwinDisc.suros(track_width="10 m"), "track_width: is 10 m, usually 0.1 to 500 mm; did you mean 10 mm?"),
    (lambda: wl.wear_law("archard", coefficient=3.0, hardness="2.6 GPa"), "archard: coefficient: is 3, usually 1e-10"),
    (lambda: wl.FallingFriction(static_coefficient=46, limit_ratio=0.4, decay="0.6 s/m"), "static_coefficient: is 46"),
    (lambda: on_rail(normal_force="60 N"), "normal_force: is 60 N, usually 0.1 to 300 kN; did you mean 60 kN?"),
    (lambda: on_rail(spin="0.3 rad/mm"), "spin: is 0.3 rad/mm, usually -100 to 100 1/m; did you mean 0.3 1/m?"),
    (lambda: on_rail(friction_coefficient=30.0), "friction_coefficient: reaches 30, usually at most 2; is it in perc"),
    (lambda: on_rail({"rail_head_radius": "300 m"}), "b: half the patch's width reaches"),
    (
        lambda: (wl.TwinDisc.suros() | EXACT)(**DISCS | {"max_pressure": "1200 GPa"}),
        "max_pressure: is 1200 GPa, usually 5 to 10000 MPa; did you mean 1200 MPa?",
    ),
    (
        lambda: (wl.TwinDisc.suros() | GLOBAL)(**DISCS, traction_coefficient=[30.0, 25.0]),
        "traction_coefficient: reaches 30, usually at most 2; is it in percent?",
    ),
]


@pytest.mark.parametrize(("call", "sentence"), SLIPS)
def test_a_slip_of_unit_gets_one_warning_with_its_sentence(call: Callable[[], Any], sentence: str) -> None:
    (found,) = said(call)
    assert sentence in found


def test_ratios_that_no_unit_shows_are_seen_in_the_contact() -> None:
    """The bounds are those of the table: a/R, b on a rail and p0/E by Hertz, p0/H as given."""
    rubber = material(youngs_modulus="1.0 GPa", density="1100 kg/m^3")
    rig = wl.TwinDisc.suros(diameter="60 mm", material=rubber, track_width="30 mm")
    radius, modulus = 15e-3, 0.5e9 / (1.0 - 0.28**2)
    for half_width, length, strain in ((8.9e-3, False, True), (9.1e-3, True, True), (2.5e-3, False, False)):
        pressure = half_width * modulus / (2.0 * radius)  # Hertz: p0 = a E*/(2R)
        assert (pressure > 0.1e9) is strain
        given = {**DISCS, "max_pressure": Q(pressure, "Pa")}
        found = "".join(said(lambda: (rig | EXACT)(**given)))  # noqa: B023
        assert ("a: half the patch's length reaches 0.3 of a body's rolling radius" in found) is length
        assert ("max_pressure: reaches" in found) is strain


@pytest.mark.parametrize(("pressure", "warns"), [("3590 MPa", False), ("3610 MPa", True)])
@pytest.mark.parametrize("of_material", [False, True])
def test_a_mean_pressure_beyond_the_hardness_of_a_law_is_told(pressure: str, warns: bool, of_material: bool) -> None:
    """The mean pressure of an ellipse is 2/3 of its maximum."""
    hard = wl.material("SteelWithHardness", hardness="2.4 GPa", shear_yield_stress=None)
    law = Archard(coefficient=2e-4, hardness=None if of_material else Q(2.4, "GPa"))
    rig = wl.WheelRail(**WHEEL | {"material": hard if of_material else STEEL, "rail_head_radius": "13 mm"})
    found = said(lambda: (rig | FASTSIM | law)(max_pressure=pressure, **ROLLING))
    assert [one.startswith("hardness: the maximum pressure reaches 1") for one in found] == [True] * warns


@pytest.mark.parametrize(
    ("usual", "wrong"),
    [((3, 1), True), ((1, 1), True), ((1,), True), (5, True), ("ab", True), ((float("nan"), 1), True), ((0, 1), False)],
)
def test_a_range_of_usual_values_must_rise_where_it_is_written(usual: Any, wrong: bool) -> None:
    if not wrong:
        assert wl.Unit("mm", usual=usual).usual == usual
        return
    with pytest.raises(wl.UnitError, match="usual: must be the least and the greatest usual value in mm"):
        wl.Unit("mm", usual=usual)


@pytest.mark.parametrize(
    ("values", "sentence"),
    [
        (Q([60.0, 80.0], "N"), "load: goes down to 60 N, usually 0.1 to 300 kN; did you mean 60 kN?"),
        (Q([0.01, 60.0], "kN"), None),  # a wheel lifts
        (Q(0.0, "kN"), None),
        (Q([60.0, 4000.0], "kN"), "load: reaches 4000 kN, usually 0.1 to 300 kN; did you mean 4000 N?"),
    ],
)
def test_small_values_of_an_array_are_usual_beside_greater_ones(values: Any, sentence: str | None) -> None:
    found = said(lambda: wl.Unit("kN", positive=False, usual=(0.1, 300)).si(values, "load"))
    assert found == ([] if sentence is None else [sentence])


def test_infinity_is_usual_where_it_is_allowed_and_negative_values_have_a_range_too() -> None:
    flat = wl.Unit("mm", infinite=True, usual=(2, 3000))
    humidity = wl.Unit("%", positive=False, usual=(0, 100))
    assert not said(lambda: flat.si("inf mm", "diameter"))
    assert said(lambda: humidity.si(Q([50.0, -5.0], "%"), "humidity")) == [
        "humidity: goes down to -5 %, usually 0 to 100 %"
    ]
    assert said(lambda: humidity.si(Q(60, ""), "humidity")) == [
        "humidity: is 60, usually 0 to 100 %; did you mean 60 %?"
    ]


class Rubbing(TypedDict, total=False):
    """The conditions of a rig from outside."""

    mass: Annotated[wl.QuantityLike, wl.Unit("kg", usual=(1, 500))]
    humidity: Annotated[wl.QuantityLike, wl.Unit("%", positive=False, usual=(0, 100))]
    friction_coefficient: wl.Friction


class Outside(wl.Rig):
    """A rig from outside, with usual values of its own."""

    name: ClassVar[str] = "outside"
    arm: Annotated[wl.Quantity, wl.Unit("mm", usual=(50, 500))]
    share: Annotated[float, wl.Unit("", usual=(0, 1))] = 0.5

    def problem(self, **conditions: Unpack[Rubbing]) -> wl.Problem:
        arrays = self.in_si(conditions)
        load = Q(9.81 * arrays["mass"], "N")
        return wl.TwinDisc.suros(material=STEEL).problem(
            normal_force=load, creepage="1 %", friction_coefficient=arrays["friction_coefficient"]
        )


def test_fields_and_conditions_from_outside_have_the_same_mechanism() -> None:
    (fields,) = said(lambda: Outside(arm=Q(100.0, "m"), share=40.0))
    assert fields == (
        "Outside: arm: is 100 m, usually 50 to 500 mm; did you mean 100 mm?\nOutside: share: is 40, usually 0 to 1"
    )
    predict = Outside(arm=Q(100.0, "mm")) | EXACT
    (conditions,) = said(lambda: predict(mass="50000 kg", humidity=Q(60, ""), friction_coefficient=0.3))
    assert conditions.splitlines()[:2] == [
        "mass: is 50000 kg, usually 1 to 500 kg; did you mean 50 kg?",
        "humidity: is 60, usually 0 to 100 %; did you mean 60 %?",
    ]
    assert Outside.model_json_schema()["properties"]["share"]["type"] == "number"


def test_a_record_is_told_once_and_its_copies_are_not() -> None:
    with pytest.warns(wl.UnusualWarning):
        light = material(density="7.85 kg/m^3")
    assert not said(lambda: light.model_copy(update={"poisson_ratio": 0.3}))
    assert len(said(lambda: light.model_copy(update={"density": "7.9 kg/m^3"}))) == 1
    rig: list[Any] = []
    assert not said(lambda: rig.append(wl.TwinDisc.suros(material=light)))
    assert not said(lambda: (rig[0] | EXACT | wl.wear_law("usfd"))(**DISCS))
    assert len(said(lambda: wl.Material.model_validate_json(light.model_dump_json()))) == 1


def test_an_error_comes_without_the_warning() -> None:
    def refused() -> None:
        with pytest.raises(wl.ConditionsError):
            (wl.TwinDisc.suros() | EXACT)(**DISCS | {"max_pressure": "1e200 Pa"})

    assert not said(refused)


def test_a_sweep_warns_once_for_all_blocks_and_keeps_the_note(tmp_path: Path) -> None:
    predict = wl.TwinDisc.suros(material=STEEL) | GLOBAL | wl.wear_law("energy", mass_per_energy="1 ug/J")
    creepage = Q(np.linspace(0.5, 1.0, 150_000), "%")
    given: dict[str, Any] = {"creepage": creepage, "max_pressure": "1.2 MPa", "friction_coefficient": [0.3, 30.0]}
    for store in (None, tmp_path / "store"):
        found: list[Any] = []
        (text,) = said(lambda: found.append(wl.sweep(predict, store=store, outputs=["wear_rate"], **given)))  # noqa: B023
        assert text.splitlines() == [
            "max_pressure: is 1.2 MPa, usually 5 to 10000 MPa; did you mean 1.2 GPa?",
            "friction_coefficient: reaches 30, usually at most 2; is it in percent?",
        ]
        assert text in found[0].attrs["notes"]


def measured(**columns: Any) -> WearTests:
    """Return twelve tests with a wear rate and a traction in full slip, with columns in other units."""
    creepage = np.linspace(1.0, 12.0, 12)
    scatter = np.random.default_rng(3).normal(1.0, 0.02, 12)
    table = {
        "creepage [%]": creepage,
        "max_pressure [MPa]": np.full(12, 1500.0),
        "traction_coefficient": 0.4 * scatter,
        "wear_rate [ug/m/mm^2]": 100.0 * scatter,
        "friction_coefficient": np.full(12, 0.45),
    }
    for name, values in columns.items():
        head = next(one for one in table if one.startswith(name))
        del table[head]
        table |= {values[0]: np.full(12, values[1]) * (scatter if np.ndim(values[1]) == 0 else 1.0)}
    return wl.read_tests(pd.DataFrame(table))


COLUMNS: list[tuple[dict[str, Any], str]] = [
    ({"creepage": ("creepage [%]", np.linspace(0.01, 0.02, 12))}, "usually 0.1 to 60 %; did you mean 0.015?"),
    (
        {"max_pressure": ("max_pressure [GPa]", np.full(12, 1500.0))},
        "is 1500 GPa, usually 5 to 10000 MPa; did you mean 1500 MPa?",
    ),
    ({"traction_coefficient": ("traction_coefficient", 40.0)}, "column traction_coefficient: its median is 39"),
    (
        {"friction_coefficient": ("friction_coefficient", np.full(12, 46.0))},
        "is 46, usually 0.01 to 200 %; did you mean 46 %?",
    ),
    (
        {"friction_coefficient": ("friction_coefficient", np.geomspace(0.2, 10.0, 12))},  # those of creepages
        "column friction_coefficient: its greatest value is 10, usually 0.01 to 200 %",
    ),
    (
        {"wear_rate": ("wear_rate [mg/m/mm^2]", np.full(12, 100.0))},
        "0.0001 to 10000 µg/m/mm²; did you mean 100 µg/m/mm²?",
    ),
]


@pytest.mark.parametrize(("columns", "sentence"), COLUMNS)
@pytest.mark.parametrize("application", ["fit", "compare"])
def test_a_column_of_tests_in_the_wrong_unit_is_told_by_its_median(
    columns: dict[str, Any], sentence: str, application: str
) -> None:
    tests = measured(**columns)
    rig = wl.TwinDisc.suros(material=STEEL)
    law = wl.wear_law("energy", mass_per_energy="1 ug/J")

    def run() -> None:
        with warnings.catch_warnings(action="ignore", category=FitWarning):
            if application == "compare":
                assert any(sentence in note for note in wl.compare([rig | EXACT | law], tests).notes)
            else:
                wl.fit(rig | EXACT | law, tests, ["mass_per_energy"], bootstrap=0)

    (found,) = said(run)
    assert sentence in found


def test_models_compared_say_once_what_is_unusual_for_all_of_them() -> None:
    tests = measured(max_pressure=("max_pressure [GPa]", np.full(12, 1500.0)))
    rig = wl.TwinDisc.suros(material=STEEL)
    laws = [wl.wear_law("energy", mass_per_energy="1 ug/J"), wl.wear_law("archard", coefficient=1e-4, hardness="3 GPa")]
    with warnings.catch_warnings(action="ignore", category=wl.WearlawWarning):
        notes = wl.compare([rig | EXACT | law for law in laws], tests).notes
    assert [note.partition(": half")[0] for note in notes if "half the patch's length" in note] == ["tests: a"]
    (hard,) = (note for note in notes if "times the hardness" in note)
    assert hard.startswith("tests: hardness: ")


def test_ordinary_tests_get_no_warning() -> None:
    rig = wl.TwinDisc.suros(material=STEEL)
    law = wl.wear_law("energy", mass_per_energy="1 ug/J")
    with warnings.catch_warnings(action="ignore", category=FitWarning):
        assert not said(lambda: wl.fit(rig | EXACT | law, measured(), ["mass_per_energy"], bootstrap=0))
    assert not said(lambda: wl.compare([rig | EXACT | law], measured()))


def test_a_fitted_friction_beyond_two_is_told() -> None:
    rig = wl.TwinDisc.suros(material=STEEL)
    creepage = np.linspace(0.025, 0.03, 12)
    # Carter: T/N = 2c - c²/μ with c = Rξ/a, here of μ = 5; each traction itself is below 2.
    slope = 23.5e-3 / 2.0 / float((rig | EXACT)(**DISCS | {"max_pressure": "1500 MPa"}).half_width.m_as("m"))
    traction = 2.0 * slope * creepage - (slope * creepage) ** 2 / 5.0
    tests = measured(
        creepage=("creepage [-]", creepage),
        traction_coefficient=("traction_coefficient", traction * np.tile([1.0001, 0.9999], 6)),
    )
    with warnings.catch_warnings(action="ignore", category=FitWarning):
        (found,) = said(lambda: wl.fit(rig | EXACT, tests, ["friction_coefficient"], bootstrap=0))
    assert found.startswith("friction_coefficient: the fit gives ")


@pytest.mark.parametrize("seed", range(4))
def test_plausible_set_ups_get_no_warning(seed: int) -> None:
    """Fifty drawings each, from scaled rigs and trams to freight, with flange corners of 13 mm."""
    random = np.random.default_rng(seed)

    def between(low: float, high: float) -> float:
        return float(np.exp(random.uniform(np.log(low), np.log(high))))

    def every() -> None:
        for _ in range(50):
            steel = material(
                youngs_modulus=Q(random.uniform(195.0, 215.0), "GPa"), density=Q(random.uniform(7700, 7900), "kg/m^3")
            )
            scale = random.choice([1.0, 1.0, 0.5, 0.2])
            wheel = wl.WheelRail(
                wheel_radius=Q(scale * random.uniform(250.0, 630.0), "mm"),
                rail_head_radius=Q(scale * random.choice([13.0, 20.0, 80.0, 300.0]), "mm"),
                wheel_profile_radius=Q(random.choice([np.inf, -scale * 500.0]), "mm"),
                material=steel,
                rolling_speed=Q(between(0.1, 100.0), "m/s"),
            )
            (wheel | FASTSIM)(
                normal_force=Q(scale**2 * between(5.0, 150.0), "kN"),
                longitudinal_creepage=Q(random.uniform(-1.0, 1.0), "%"),
                lateral_creepage=Q(random.uniform(-1.0, 1.0), "%"),
                contact_angle=Q(random.uniform(-70.0, 70.0), "deg"),
                friction_coefficient=between(0.02, 0.7),
            )
            discs = wl.TwinDisc.suros(
                diameter=Q(between(20.0, 400.0), "mm"),
                material=steel,
                track_width=Q(between(1.0, 50.0), "mm"),
                rolling_speed=Q(between(0.05, 20.0), "m/s"),
            )
            (discs | EXACT)(
                max_pressure=Q(between(200.0, 3000.0), "MPa"),
                creepage=Q(between(0.01, 30.0), "%"),
                friction_coefficient=between(0.02, 0.8),
            )

    assert not said(every)


def test_the_warning_is_silenced_by_its_name() -> None:
    with warnings.catch_warnings(action="error"), warnings.catch_warnings(action="ignore", category=wl.UnusualWarning):
        material(density="7.85 kg/m^3")
    assert issubclass(wl.UnusualWarning, wl.WearlawWarning)
