"""A law with a condition of its own, from a file: fitted, swept, uncertain, in a case and its report, and explored."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from typing import Any

import jsonschema  # type: ignore[import-untyped]
import numpy as np
import pandas as pd
import pytest
from click.testing import CliRunner

import wearlaw as wl
from wearlaw import Q, loader  # private: plugins of a test are forgotten after it
from wearlaw.cli import main  # private: the program in this process
from wearlaw.errors import CaseError, DataError
from wearlaw_apps.explore.page import Page, named  # private: the page without a browser
from wearlaw_apps.fits import WearTests
from wearlaw_apps.studies.case import case_schema  # private: the schema of the command `schema`

LAW = '''
from typing import Annotated, ClassVar, TypedDict
import numpy as np
import pandas as pd
import wearlaw as wl


class Humidity(TypedDict):
    """The air."""

    relative_humidity: Annotated[wl.QuantityLike, wl.Unit("%", positive=False, negative=False, usual=(0, 100))]
    """Relative humidity of the air, RH [-]."""


class Humid(wl.WearLaw):
    """Wear in proportion to the wear-index density, which falls with humidity: k exp(-B RH) w."""

    name: ClassVar[str] = "humid"
    source: ClassVar[str] = "made up for a test"
    conditions: ClassVar = Humidity

    slope: Annotated[wl.Quantity, wl.Unit("ug/m/N")] = wl.Q(5, "ug/m/N")
    """k [kg/m/N]."""
    decay: Annotated[float, wl.Unit("")] = 2.0
    """B [-]."""

    def rate(self, contact, p):
        humidity = contact.per_node(contact.conditions["relative_humidity"])
        return p["slope"] * np.exp(-p["decay"] * humidity) * contact.wear_index_density

    def breakpoints(self, p):
        return {}


class Moist(wl.Stage):
    """Friction that falls with humidity."""

    name: ClassVar[str] = "moist"
    source: ClassVar[str] = "made up for a test"
    conditions: ClassVar = Humidity

    def altered(self, problem, forces):
        wet = 1.0 - 0.5 * problem.conditions["relative_humidity"]
        return problem.replaced(friction_coefficient=problem.friction_coefficient * wet)


@wl.hookimpl
def wearlaw_models():
    return [Humid, Moist]
'''

CASE = """
title = "Humidity"
rig = {preset = "suros"}
contact_models = ["exact"]
wear_laws = ["humid", "usfd"]

[sweeps.air]
max_pressure = "600 MPa"
creepage = "1 %"
friction_coefficient = 0.4
relative_humidity = {from = "0 %", to = "100 %", points = 5, spacing = "linear"}

[profiles.patch]
max_pressure = "600 MPa"
creepage = "1 %"
friction_coefficient = 0.4
relative_humidity = "40 %"
"""

pytestmark = pytest.mark.filterwarnings("ignore::wearlaw.WearlawWarning")

RIG: Any = wl.TwinDisc.suros()
AT: dict[str, Any] = {"max_pressure": "600 MPa", "creepage": "1 %", "friction_coefficient": 0.4}


@pytest.fixture(scope="module", autouse=True)
def file(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    path = tmp_path_factory.mktemp("law") / "humid_law_of_a_test.py"
    path.write_text(LAW, encoding="utf-8")
    before = [*sys.path]
    wl.use(path)
    yield path
    sys.path[:] = before
    sys.modules.pop(path.stem)
    loader._FOUND.clear()


@pytest.fixture
def predict() -> Any:
    return RIG | wl.contact_model("exact") | wl.wear_law("humid")


def measured_by_hand() -> WearTests:
    """Return tests whose wear is 4 µg/m/N exp(-1.5 RH) of Tγ/A, which is Tξ/A."""
    random = np.random.default_rng(1)
    creepage, humidity = Q(random.uniform(0.5, 3.0, 12), "%"), Q(random.uniform(10.0, 90.0, 12), "%")
    contact = (RIG | wl.contact_model("exact"))(**{**AT, "creepage": creepage})
    density = contact.tangential_force.m_as("N") * creepage.m_as("") / contact.patch_area.m_as("mm^2")
    return WearTests.from_arrays(
        creepage=creepage, max_pressure=AT["max_pressure"], friction_coefficient=0.4,
        wear_rate=Q(4.0 * np.exp(-1.5 * humidity.m_as("")) * density, "ug/m/mm^2"),
        other_conditions={"relative_humidity": humidity},
    )  # fmt: skip


def test_a_fit_takes_the_column_of_the_condition(tmp_path: Path) -> None:
    measured_by_hand().to_dataframe().to_csv(tmp_path / "tests.csv", index=False)
    tests = wl.read_tests(tmp_path / "tests.csv")
    start = RIG | wl.contact_model("exact") | wl.wear_law("humid", slope="2 ug/m/N", decay=0.5)
    fit = wl.fit(start, tests, free=["slope", "decay"])
    assert fit.parameters["slope"].m_as("ug/m/N") == pytest.approx(4.0, rel=1e-6)  # the search stops near 1e-8
    assert fit.parameters["decay"].magnitude == pytest.approx(1.5, rel=1e-6)
    usfd = RIG | wl.contact_model("global") | wl.wear_law("usfd")
    compared = wl.compare([fit, usfd], tests)  # the other law leaves the column aside
    assert "humid" in repr(compared).splitlines()[2]


def test_tests_without_the_column_are_an_error_that_names_it(predict: Any) -> None:
    tests = WearTests.from_arrays(
        creepage="1 %", max_pressure=Q([600, 700], "MPa"), friction_coefficient=0.4, wear_rate="4 ug/m/mm^2"
    )
    with pytest.raises(DataError, match=r"no column 'relative_humidity \[%\]', which wear law 'humid' needs"):
        wl.fit(predict, tests, free=["slope"])


def test_an_uncertain_condition_spreads_the_wear(predict: Any) -> None:
    """The median over RH from 20 % to 80 % is the wear at 50 %, as the law is monotone."""
    found = wl.uncertainty(predict, **AT, relative_humidity=wl.uniform("20 %", "80 %"), samples=256)
    middle = predict(**AT, relative_humidity="50 %").wear_rate
    assert found.median.m_as(middle.units) == pytest.approx(middle.magnitude, rel=2.0 * 0.6 / 256)  # a step of RH
    assert found.sobol().loc["relative_humidity", "total_order"] == pytest.approx(1.0)


def test_a_case_has_the_condition_as_an_axis_for_all_its_laws(tmp_path: Path, file: Path) -> None:
    (tmp_path / "case.toml").write_text(CASE, encoding="utf-8")
    study = wl.run(wl.load_case(str(tmp_path / "case.toml")))
    sweep = study.sweeps["air"]
    rates = sweep.wear_rate.sel(pair="humid on exact").values
    assert rates / rates[0] == pytest.approx(np.exp(-2.0 * np.linspace(0.0, 1.0, 5)), rel=1e-12)
    assert np.ptp(sweep.wear_rate.sel(pair="usfd on exact").values) == 0.0
    pair = study.pairs[1].pipeline(**study.conditions(profile="patch"))  # of usfd, as a section computes it
    assert pair.wear_rate.m_as("ug/m/mm^2") == pytest.approx(sweep.wear_rate.sel(pair="usfd on exact").values[0])
    out = tmp_path / "out"
    arguments = ["run", str(tmp_path / "case.toml"), "-o", str(out), "--plugin", str(file)]
    assert CliRunner().invoke(main, arguments).exit_code == 0
    assert "relative humidity [%]" in (out / "report.html").read_text(encoding="utf-8")


def test_a_case_without_the_condition_is_refused_when_it_is_read(tmp_path: Path) -> None:
    path = tmp_path / "case.toml"
    path.write_text(CASE.replace('relative_humidity = "40 %"', ""), encoding="utf-8")
    with pytest.raises(CaseError, match=r"profiles.patch.relative_humidity: is missing; wear law 'humid' needs it"):
        wl.load_case(str(path))
    path.write_text(CASE.replace('"humid", ', ""), encoding="utf-8")
    with pytest.raises(CaseError, match=r"sweeps.air.relative_humidity: unknown condition"):
        wl.load_case(str(path))


def test_the_schema_of_cases_knows_the_condition() -> None:
    case = import_module("tomllib").loads(CASE)
    jsonschema.validate(case, case_schema())
    case["sweeps"]["air"]["relative_humidty"] = "1 %"
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(case, case_schema())


def test_the_page_to_explore_has_a_slider_over_the_usual_range(capsys: pytest.CaptureFixture[str]) -> None:
    subject = named("twin_disc", ["humid"])
    page = Page(subject, {"max_pressure": "600 MPa"})
    slider = page.sliders["relative_humidity"]
    assert (slider.start, slider.end, slider.value) == (0.0, 100.0, 50.0)
    page.laws.value = ["humid", "usfd"]
    assert "wear rate by humid" in page.numbers.object
    assert "wear rate by usfd" in page.numbers.object
    exec(subject.python("exact", ["humid", "usfd"], subject.conditions({"max_pressure": "600 MPa"})), {})
    assert capsys.readouterr().out.count("Prediction of 1 operating point") == 2


def test_wearlaw_show_tells_of_the_condition() -> None:
    shown = CliRunner().invoke(main, ["show", "humid"]).output
    assert "conditions beside those of the rig:\n  relative_humidity [%] (must be given)" in shown
    assert "Relative humidity of the air, RH [-]." in shown


def test_a_wheelset_has_the_condition_in_all_its_patches_and_balances_its_loads_with_it() -> None:
    """At RH = 50 % friction is 3/4 of what is given, in the balance of the loads too."""
    rig: Any = wl.installed("rig")["wheelset"]
    wheelset, at = wl.rig("wheelset", **rig.example_fields), dict(rig.example)
    alone: Any = wheelset | wl.contact_model("strip_theory") | wl.wear_law("humid")
    found = alone(**at, relative_humidity=Q([20, 60], "%"))
    dry, wet = found.wear_rate.magnitude[:, :, 0]
    assert dry / wet == pytest.approx(np.full(2, np.exp(0.8)), rel=1e-12)
    moist: Any = wheelset | wl.contact_model("strip_theory") | wl.stage("moist") | wl.wear_law("humid")
    by_stage = moist(**at, relative_humidity="50 %").longitudinal_force.m_as("N")[:, 0]
    by_hand = alone(**{**at, "friction_coefficient": 0.75 * at["friction_coefficient"]}, relative_humidity="50 %")
    assert by_stage == pytest.approx(by_hand.longitudinal_force.m_as("N")[:, 0], rel=1e-3)  # of the balance
    several = moist(**at, relative_humidity=Q([20, 50], "%"))
    assert several.longitudinal_force.m_as("N")[1, :, 0] == pytest.approx(by_stage, rel=1e-9)


def test_the_states_of_a_life_have_the_condition_as_a_column() -> None:
    """Half of the distance at RH = 0, half at 50 %, in one state: the mass is (1 + 1/e)/2 of that in dry air."""
    rig: Any = wl.installed("rig")["wheelset"]
    wheelset = wl.rig("wheelset", **rig.example_fields)
    predict = wheelset | wl.contact_model("strip_theory") | wl.wear_law("humid")
    given: Any = {"vertical_load": "60 kN", "friction_coefficient": 0.3, "yaw": "4 mrad"}
    mass = []
    for humidity in (0.0, 50.0):
        head = {"lateral_displacement [mm]": [3.0, 3.0], "share": [0.5, 0.5]}
        states = pd.DataFrame({**head, "relative_humidity [%]": [0.0, humidity]})
        life = wl.wear_out(predict, states, over="1 km", **given)
        mass.append(float(life.table["mass [kg]"].iloc[-1]))
    assert mass[1] / mass[0] == pytest.approx(0.5 * (1.0 + np.exp(-1.0)), rel=1e-3)  # the profiles wear differently
