"""The conditions of a rig, as its TypedDict declares them: names, units, which must be given, and laws of friction."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from typing import Annotated, Any, ClassVar, NotRequired, Required, TypedDict, Unpack

import numpy as np
import pytest

import wearlaw as wl
from tests import cases
from wearlaw import Q
from wearlaw.errors import CompositionError
from wearlaw_apps.studies.case import Case  # private: a case without its files
from wearlaw_apps.studies.report.tables import summaries  # private: a part of the report, without its page
from wearlaw_apps.studies.study import run  # private: a case run without its files
from wearlaw_kit import Check, conformance

DISCS = wl.TwinDisc.suros(rolling_speed="1 m/s")


class Loads(TypedDict, total=False):
    """Conditions that a rig may leave out, but for the friction."""

    mass: Annotated[wl.QuantityLike, wl.Unit("kg")]
    """Mass of the weight [kg]."""
    normal_force: Annotated[wl.QuantityLike, wl.Unit("N")]
    friction_coefficient: Required[wl.Friction]


class Speeds(Loads):
    """Conditions that must be given, but for the state of the surface."""

    upper_speed: Annotated[wl.QuantityLike, wl.Unit("m/s")]
    """Surface speed of the upper disc, v1 [m/s]."""
    lower_speed: Annotated[wl.QuantityLike, wl.Unit("m/s")]
    traction_coefficient: NotRequired[wl.Coefficient]
    surface: NotRequired[str]


class TwoSpeeds(wl.Rig):
    """Two discs with drives of their own, pressed together by a weight or a cylinder."""

    name: ClassVar[str] = "two_speeds"
    source: ClassVar[str] = "a test"
    patch_geometry: ClassVar[wl.Geometry | None] = "line"
    creepage: ClassVar[str | None] = None
    choices: ClassVar = [("mass", "normal_force")]
    example: ClassVar[Mapping[str, Any]] = {
        "mass": "200 kg",
        "upper_speed": "1.01 m/s",
        "lower_speed": "1 m/s",
        "friction_coefficient": 0.4,
    }

    @property
    def bodies(self) -> Mapping[str, wl.Body]:
        """The discs."""
        return DISCS.bodies

    def problem(self, **conditions: Unpack[Speeds]) -> wl.Problem:
        """Return the problem of discs with these speeds."""
        given = self.in_si(conditions, lambda a: np.abs(a["upper_speed"] - a["lower_speed"]))
        mean = 0.5 * (given["upper_speed"] + given["lower_speed"])
        load = given["normal_force"] if "normal_force" in given else 9.81 * given["mass"]
        problem = DISCS.problem(
            normal_force=Q(load, "N"),
            creepage=Q((given["upper_speed"] - given["lower_speed"]) / mean, ""),
            friction_coefficient=given["friction_coefficient"],
        )
        return problem.replaced(rolling_speed=mean)


GIVEN: Any = TwoSpeeds.example
FALLING = wl.FallingFriction(static_coefficient=0.5, limit_ratio=0.4, decay="0.6 s/m")


def test_what_must_be_given_is_read_from_postponed_annotations_of_a_table_and_its_base() -> None:
    conditions = TwoSpeeds.conditions()
    assert list(conditions) == [*Loads.__annotations__, "upper_speed", "lower_speed", "traction_coefficient", "surface"]
    required = [name for name, one in conditions.items() if one.required]
    assert required == ["friction_coefficient", "upper_speed", "lower_speed"]
    assert conditions["upper_speed"].unit == wl.Unit("m/s")
    assert conditions["upper_speed"].meaning == "Surface speed of the upper disc, v1 [m/s]."
    assert conditions["lower_speed"].meaning == "lower speed"
    assert conditions["traction_coefficient"].unit is conditions["surface"].unit is None


def test_arguments_of_a_rig_without_a_table_are_its_conditions() -> None:
    class Plain(wl.Rig):
        """A rig whose conditions are arguments."""

        name: ClassVar[str] = "plain"
        source: ClassVar[str] = "a test"

        def problem(self, *, mass: wl.QuantityLike, surface: str = "dry") -> Any:
            """Return nothing."""

    assert {name: one.required for name, one in Plain.conditions().items()} == {"mass": True, "surface": False}


def test_conditions_are_si_arrays_of_one_shape() -> None:
    found = TwoSpeeds.in_si({**GIVEN, "mass": Q([1.0, 2.0], "t"), "surface": "wet"}, traction_coefficient=0.1)
    assert found.keys() == {"mass", "upper_speed", "lower_speed", "friction_coefficient", "traction_coefficient"}
    np.testing.assert_array_equal(found["mass"], [1000.0, 2000.0])
    np.testing.assert_array_equal(found["traction_coefficient"], [0.1, 0.1])


def test_a_law_of_friction_is_evaluated_at_the_creep_speed_or_left_to_the_rig() -> None:
    given = {**GIVEN, "friction_coefficient": FALLING, "upper_speed": Q([1.0, 1.5], "m/s")}
    assert "friction_coefficient" not in TwoSpeeds.in_si(given)
    friction = TwoSpeeds().problem(**given).friction_coefficient
    np.testing.assert_array_equal(friction, FALLING.coefficient(np.array([0.0, 0.5])))


class Heavier(TwoSpeeds):
    """Hands its conditions on, with a greater mass."""

    name: ClassVar[str] = "heavier"

    def problem(self, *, more: wl.QuantityLike = "1 kg", **conditions: Any) -> wl.Problem:
        """Return the problem with another weight."""
        unit = wl.Unit("kg")
        load = Q(unit.si(conditions["mass"], "mass") + unit.si(more, "more"), "kg")
        return super().problem(**{**conditions, "mass": load})


def test_a_rig_may_hand_its_conditions_on_to_its_base() -> None:
    found = (Heavier() | wl.contact_model("exact"))(**GIVEN, more="100 kg")
    assert found.problem.normal_force == TwoSpeeds().problem(**{**GIVEN, "mass": "300 kg"}).normal_force


@pytest.mark.parametrize("force", [[Q(1, "kN"), Q(2000, "N")], ["1 kN", "2 kN"], ("1 kN", Q(2, "kN"))])
def test_a_list_of_quantities_or_texts_is_an_array(force: Any) -> None:
    predict = wl.TwinDisc.suros() | wl.contact_model("exact")
    of_list = predict(normal_force=force, creepage=["1 %", "2 %"], friction_coefficient=["10 %", "20 %"])
    of_array = predict(normal_force=Q([1, 2], "kN"), creepage=Q([1, 2], "%"), friction_coefficient=[0.1, 0.2])
    assert of_list.wear_index.magnitude.tolist() == of_array.wear_index.magnitude.tolist()
    assert of_list.to_dataset()["normal_force"].values.tolist() == [1.0, 2.0]
    swept = wl.sweep(predict, normal_force=force, creepage="1 %", friction_coefficient=0.1, outputs=["wear_index"])
    assert swept["normal_force"].values.tolist() == [1.0, 2.0]
    with pytest.raises(wl.UnitError, match="normal_force"):
        predict(normal_force=["1 kN", "2 mm"], creepage="1 %", friction_coefficient=0.1)


@pytest.mark.parametrize(
    ("name", "right"), [("mu", "friction_coefficient"), ("load", "normal_force"), ("slip", "creepage")]
)
def test_another_name_of_a_condition_is_told_the_right_one(name: str, right: str) -> None:
    given: Any = {name: 0.1}
    with pytest.raises(wl.ConditionsError, match=f"^{name}: .* did you mean '{right}'"):
        (DISCS | wl.contact_model("exact"))(**given)


def test_a_friction_coefficient_in_percent_gets_a_word() -> None:
    predict = DISCS | wl.contact_model("exact")
    conditions: dict[str, Any] = {"max_pressure": "300 MPa", "creepage": "0.01 %"}
    with pytest.warns(wl.UnusualWarning, match="friction_coefficient: reaches 40") as caught:
        predict(**conditions, friction_coefficient=[0.4, 40.0])
    assert caught[0].filename == __file__
    predict(**conditions, friction_coefficient=2.0)  # a warning would be an error here


@conformance(TwoSpeeds(), expected_failures={})
def test_a_rig_with_two_speeds_passes_the_kit(check: Check) -> None:
    assert "creepage" not in check.name
    check()


def test_no_creepage_is_sought_on_a_rig_with_two_speeds() -> None:
    with pytest.raises(CompositionError, match="no single condition of rig 'two_speeds' sets the creepage"):
        wl.creepage_for(TwoSpeeds() | wl.contact_model("exact"), traction_coefficient=0.1, mass="200 kg")


def test_tables_and_figures_of_a_rig_with_two_speeds_run_along_the_longest_axis(
    install_model: cases.InstallModel,
) -> None:
    install_model(TwoSpeeds)
    sweep = {**GIVEN, "upper_speed": ["1.01 m/s", "1.02 m/s", "1.03 m/s"], "mass": ["100 kg", "200 kg"]}
    with warnings.catch_warnings(action="ignore", category=wl.WearlawWarning):
        study = run(Case(**cases.table(rig={"type": "two_speeds"}, sweeps={"speeds": sweep}, profiles={"one": GIVEN})))
    assert "wear_rate_over_upper_speed" in " ".join(figure.name for figure in study.figures)
    assert summaries(study)[0].frame.columns[0] == "wear rate [µg/m/mm²] by upper speed [m/s]"
