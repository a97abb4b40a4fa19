"""Conditions that contact models, stages and laws declare beside those of the rig."""

from __future__ import annotations

import pickle
import warnings
from collections.abc import Iterator, Mapping
from typing import Annotated, Any, ClassVar, NotRequired, TypedDict, Unpack

import numpy as np
import pytest

import wearlaw as wl
import wearlaw_kit
from tests.core.stages import RAILS, TOUGH
from tests.strategies import EPS
from wearlaw import Array, Q
from wearlaw.errors import CompositionError, ModelError

RIG = wl.TwinDisc.suros(material=TOUGH)
EXACT = wl.contact_model("exact")
TEST: dict[str, Any] = {"max_pressure": "1500 MPa", "creepage": "1 %", "friction_coefficient": 0.46}
ON_RAILS = RAILS.model_copy(update={"material": TOUGH})


class Humidity(TypedDict):
    """Humidity of the air."""

    relative_humidity: Annotated[wl.QuantityLike, wl.Unit("%", positive=False, negative=False, usual=(0.0, 100.0))]
    """Relative humidity of the air, RH [-]."""


class Humid(wl.WearLaw):
    """Wear in proportion to the wear-index density, which falls with humidity: k exp(-B RH) w."""

    name: ClassVar[str] = "humid"
    source: ClassVar[str] = "made up for tests"
    conditions: ClassVar[Any] = Humidity

    slope: Annotated[wl.Quantity, wl.Unit("ug/m/N")] = Q(5.0, "ug/m/N")
    """Slope in dry air, k [kg/m/N]."""
    decay: float = 2.0
    """B [-]."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Array:
        humidity = contact.per_node(contact.conditions["relative_humidity"])
        assert contact.conditions["relative_humidity"].shape == contact.rolling_speed.shape
        return p["slope"] * np.exp(-p["decay"] * humidity) * contact.wear_index_density

    def breakpoints(self, p: wl.Numbers) -> wl.BreakpointMap:
        return {}


class Wet(wl.Stage):
    """Friction that falls in proportion to humidity."""

    name: ClassVar[str] = "moist"
    source: ClassVar[str] = "made up for tests"
    conditions: ClassVar[Any] = Humidity

    def altered(self, problem: wl.Problem, forces: wl.Forces) -> wl.Problem:
        wet = 1.0 - 0.5 * problem.conditions["relative_humidity"]
        return problem.replaced(friction_coefficient=problem.friction_coefficient * wet)


class Cold(TypedDict):
    """Humidity, by another unit."""

    relative_humidity: Annotated[wl.QuantityLike, wl.Unit("K")]


class Desert(TypedDict):
    """Humidity of a desert."""

    relative_humidity: Annotated[wl.QuantityLike, wl.Unit("%", usual=(150.0, 300.0))]


class Dry(Humid):
    """The same, whose humidity may be left out."""

    class Maybe(TypedDict):
        """Humidity, if it is known."""

        relative_humidity: NotRequired[Annotated[wl.QuantityLike, wl.Unit("%")]]

    name: ClassVar[str] = "dry"
    conditions: ClassVar[Any] = Maybe

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Array:
        assert "relative_humidity" not in contact.conditions
        return p["slope"] * contact.wear_index_density


PREDICT: wl.Pipeline[...] = RIG | EXACT | Humid()


@pytest.fixture(autouse=True)
def _quiet() -> Iterator[None]:
    with warnings.catch_warnings():
        for category in (wl.PlasticityWarning, wl.CalibrationWarning, wl.RangeWarning):
            warnings.simplefilter("ignore", category)
        yield


def test_a_law_reads_its_condition_in_the_shape_of_the_batch() -> None:
    """Of equal contacts, the wear is as exp(-B RH)."""
    dry = PREDICT(**TEST, relative_humidity="0 %").wear_rate
    for humidity in (0.4, Q([0.0, 40.0], "%"), Q([[0.0], [0.4]], "")):
        humidity = Q(humidity, "") if isinstance(humidity, float) else humidity
        found = PREDICT(**TEST, relative_humidity=humidity).wear_rate
        assert (found / dry).m_as("") == pytest.approx(np.exp(-2.0 * humidity.m_as("")), rel=64 * EPS)


def test_axes_of_rig_and_law_are_combined() -> None:
    creepage, humidity = Q([[0.5], [1.0], [2.0]], "%"), Q([0.0, 40.0], "%")
    found = PREDICT(**{**TEST, "creepage": creepage}, relative_humidity=humidity)
    assert found.wear_rate.shape == (3, 2)
    alone = PREDICT(**{**TEST, "creepage": "2 %"}, relative_humidity="40 %").wear_rate
    assert found.wear_rate[2, 1].m_as(alone.units) == pytest.approx(alone.magnitude, rel=64 * EPS)
    assert found.to_dataset().wear_rate.dims == ("creepage", "relative_humidity")
    with pytest.raises(wl.ConditionsError, match="do not broadcast"):
        PREDICT(**{**TEST, "creepage": Q([1, 2, 3], "%")}, relative_humidity=humidity)


@pytest.mark.parametrize(
    ("given", "kind", "message"),
    [
        ({}, wl.ConditionsError, "relative_humidity: is missing; wear law 'humid' needs it"),
        ({"relative_humidity": "2 m"}, wl.UnitError, "relative_humidity: got 2.000 m"),
        ({"relative_humidity": "-2 %"}, wl.UnitError, "relative_humidity: must not be negative"),
        ({"relative_humidty": "2 %"}, wl.ConditionsError, r"unknown condition; did you mean 'relative_humidity'\?"),
    ],
)  # fmt: skip
def test_a_wrong_condition_is_named(given: dict[str, Any], kind: type[Exception], message: str) -> None:
    with pytest.raises(kind, match=message):
        PREDICT(**TEST, **given)


def test_a_pipeline_without_the_law_does_not_take_its_condition() -> None:
    with pytest.raises(wl.ConditionsError, match="relative_humidity: unknown condition"):
        (RIG | EXACT | wl.wear_law("usfd"))(**TEST, relative_humidity="40 %")  # type: ignore[call-arg]  # pyright: ignore
    assert "relative_humidity" in PREDICT.conditions
    assert "relative_humidity" not in PREDICT.without_law().conditions


def test_a_value_outside_what_is_usual_gets_one_warning() -> None:
    with pytest.warns(wl.UnusualWarning, match="relative_humidity: is 4000 %, usually 0 to 100 %") as caught:
        PREDICT(**TEST, relative_humidity="4000 %")
    assert len([one for one in caught if one.category is wl.UnusualWarning]) == 1


def test_a_condition_that_may_be_left_out() -> None:
    predict: wl.Pipeline[...] = RIG | EXACT | Dry()
    dry = PREDICT(**TEST, relative_humidity="0 %").wear_rate
    assert predict(**TEST).wear_rate.m_as(dry.units) == pytest.approx(dry.magnitude, rel=64 * EPS)


def test_a_stage_alters_the_problem_by_its_condition() -> None:
    """At RH = 50 % the friction is 3/4 of what is given, for the law behind the stage as well."""
    predict: wl.Pipeline[...] = ON_RAILS | wl.contact_model("fastsim") | Wet() | Humid()
    on_rails: dict[str, Any] = {"normal_force": "80 kN", "longitudinal_creepage": Q([0.1, 0.5], "%")}
    wet = predict(**on_rails, friction_coefficient=0.4, relative_humidity="50 %")
    other: wl.Pipeline[...] = ON_RAILS | wl.contact_model("fastsim") | Humid()
    by_hand = other(**on_rails, friction_coefficient=0.3, relative_humidity="50 %")
    assert wet.wear_rate.magnitude == pytest.approx(by_hand.wear_rate.magnitude, rel=64 * EPS)
    assert wet.longitudinal_force.magnitude == pytest.approx(by_hand.longitudinal_force.magnitude, rel=64 * EPS)


@pytest.mark.parametrize("table", [Cold, Desert])
def test_contradicting_conditions_do_not_make_a_pipeline(table: Any) -> None:
    class Other(Wet):
        """A stage with another condition of the same name."""

        name: ClassVar[str] = "other"
        conditions: ClassVar = table

    with pytest.raises(CompositionError, match="relative_humidity: no value suits both stage 'other'"):
        RIG | EXACT | Other() | Humid()


class ChamberConditions(TypedDict):
    """The conditions of a test."""

    creepage: wl.Creepage
    relative_humidity: NotRequired[Annotated[wl.QuantityLike, wl.Unit("", positive=False)]]


class Chamber(wl.Rig):
    """Discs in a chamber; its table has the humidity, or its field holds it."""

    name: ClassVar[str] = "chamber"
    source: ClassVar[str] = "made up for tests"
    patch_geometry: ClassVar[wl.Geometry | None] = "line"
    held: float | None = None

    def problem(self, **conditions: Unpack[ChamberConditions]) -> wl.Problem:
        given = self.in_si(conditions)
        problem = RIG.problem(max_pressure="1500 MPa", creepage=Q(given["creepage"], ""), friction_coefficient=0.46)
        if self.held is None:
            return problem
        return problem.replaced(conditions={"relative_humidity": np.full_like(given["creepage"], self.held)})


def test_a_rig_with_the_condition_provides_it() -> None:
    by_hand = PREDICT(**TEST, relative_humidity="40 %").wear_rate
    of_table: wl.Pipeline[...] = Chamber() | EXACT | Humid()
    assert of_table(creepage="1 %", relative_humidity="40 %").wear_rate == by_hand
    with pytest.raises(wl.ConditionsError, match="wear law 'humid' needs it"):
        of_table(creepage="1 %")
    of_field: wl.Pipeline[...] = Chamber(held=0.4) | EXACT | Humid()
    assert of_field(creepage="1 %").wear_rate == by_hand


def test_several_laws_share_a_condition_and_lists_of_models_take_those_of_all() -> None:
    usfd = wl.wear_law("usfd")
    several: Any = RIG | EXACT | [usfd, Humid()]
    found = several(**TEST, relative_humidity=Q([0.0, 40.0], "%"))
    alone = (RIG | EXACT | usfd)(**TEST).wear_rate
    assert found.wear_rate.sel(law="usfd").values == pytest.approx(np.full(2, alone.magnitude), rel=64 * EPS)
    rates = found.wear_rate.sel(law="humid").values
    assert rates[1] / rates[0] == pytest.approx(np.exp(-0.8), rel=64 * EPS)


def test_a_sweep_has_the_condition_as_an_axis_and_as_a_column() -> None:
    humidity = Q([0.0, 20.0, 80.0], "%")
    swept = wl.sweep(PREDICT, **TEST, relative_humidity=humidity)
    assert swept.wear_rate.dims == ("relative_humidity",)
    assert swept.relative_humidity.attrs["units"] == "%"
    rates = swept.wear_rate.values
    assert rates / rates[0] == pytest.approx(np.exp(-2.0 * humidity.m_as("")), rel=64 * EPS)
    table = swept.wear_rate.to_dataframe().reset_index()[["relative_humidity"]]
    table.columns = ["relative_humidity [%]"]
    again = wl.sweep(PREDICT, table, **TEST)
    assert again.wear_rate.values == pytest.approx(rates, rel=64 * EPS)
    with pytest.raises(wl.ConditionsError, match="relative_humidity: is missing; wear law 'humid' needs it"):
        wl.sweep(PREDICT, **{**TEST, "creepage": Q([1, 2], "%")})


def contact(**conditions: Any) -> wl.Contact:
    return wl.Contact.from_arrays(
        pressure=Q([[1000.0], [1000.0]], "MPa"), traction="400 MPa", slip="1 %", area="1 mm^2",
        rolling_speed=Q([1.0, 1.0], "m/s"), **conditions,
    )  # fmt: skip


def test_a_contact_solved_elsewhere_brings_the_condition_or_the_error_names_the_keyword() -> None:
    """5 µg/m/N · 4 N/mm² · exp(-2 RH)."""
    found = contact(relative_humidity=Q([0.0, 40.0], "%")) | Humid()
    assert found.value.m_as("ug/m/mm^2") == pytest.approx(20.0 * np.exp([0.0, -0.8]), rel=64 * EPS)
    assert (contact().at(relative_humidity="40 %")[1:] | Humid()).value.m_as("ug/m/mm^2") == pytest.approx(
        [20.0 * np.exp(-0.8)], rel=64 * EPS
    )
    with pytest.raises(wl.InputError, match=r"relative_humidity: is missing.* contact\.at\(relative_humidity='50 %'\)"):
        contact() | Humid()
    with pytest.raises(wl.UnitError, match=r"relative_humidity: got .* m, which does not have"):
        contact(relative_humidity="2 m") | Humid()
    with pytest.raises(wl.InputError, match=r"relative_humidity: must be one value or of the shape of the contacts"):
        contact(relative_humidity=Q([1, 2, 3], "%"))


def test_a_solved_contact_gets_other_laws_under_its_conditions() -> None:
    alone = PREDICT(**TEST, relative_humidity="40 %")
    again = wl.Prediction.of(alone.contact, Humid())
    assert again.wear_rate.m_as(alone.wear_rate.units) == pytest.approx(alone.wear_rate.magnitude, rel=1e-6)
    bare = (RIG | EXACT)(**TEST).contact
    with pytest.raises(wl.InputError, match="relative_humidity: is missing"):
        wl.Prediction.of(bare, Humid())
    given = wl.Prediction.of(bare.at(relative_humidity="40 %"), Humid())
    assert given.wear_rate.m_as(alone.wear_rate.units) == pytest.approx(alone.wear_rate.magnitude, rel=1e-6)


def test_a_pipeline_with_conditions_of_models_is_pickled_compared_and_written() -> None:
    assert pickle.loads(pickle.dumps(PREDICT)) == PREDICT
    assert "compared_with" not in PREDICT.model_dump()
    shared = (RIG | EXACT | wl.wear_law("usfd")).among([Humid()])
    assert shared.with_law(wl.wear_law("kth")).conditions.keys() == PREDICT.conditions.keys()


def test_what_a_model_declares_is_checked_with_its_class() -> None:
    class Bare(TypedDict):
        humidity: float

    for wrong, message in ((Bare, "humidity has no unit; write humidity: Annotated"), (dict, "must be a TypedDict")):
        namespace: Mapping[str, Any] = {
            "conditions": wrong, "__annotations__": {"conditions": ClassVar}, "__module__": __name__
        }  # fmt: skip
        with pytest.raises(ModelError, match=message):
            type("Wrong", (Humid,), dict(namespace))


@pytest.mark.parametrize("model", [Humid(), Wet()], ids=["law", "stage"])
def test_the_kit_tries_models_under_their_conditions(model: Any) -> None:
    for check in wearlaw_kit.checks(model):
        check()
