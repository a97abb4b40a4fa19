"""What `wearlaw show` says of a model: nothing that its class declares may be missing."""

from __future__ import annotations

import inspect
import textwrap
from collections.abc import Mapping
from typing import Annotated, Any

import pytest
from pydantic import Field

import wearlaw as wl
from tests.core import cases
from tests.core.outcome_laws import Damage as BaseOfDamage
from tests.core.outcome_laws import Heat
from tests.plugins.kit.wrong_rigs import Weight
from wearlaw.cli.show import describe  # private: the program, in this process
from wearlaw.models.model import Model  # private: the bound of a quadrature
from wearlaw.plugins import loader  # private: plugins of a test are found as if they were installed
from wearlaw.settings.configuration import (
    field_docstrings,
)  # private: what `show`, schemas and signatures say of fields

MODELS: dict[str, type[Model]] = {**wl.contact_models(), **wl.wear_laws()}


def said(model: type[Model]) -> str:
    """Return the description with its line breaks undone."""
    return " ".join(describe(model).split())


EXPECTED: dict[str, list[str]] = {
    "half_space": ["cells = 30", "decay = 0.6 s/m"],
    "archard": [
        "coefficient (must be given)",
        "hardness = None",
        "source: J. F. Archard, J. Appl. Phys. 24 (1953) 981-988",
    ],
    "energy": [
        "mass_per_energy (must be given)",
        "severe_mass_per_energy = None",
        "power_limit = None",
        "energy_limit = None",
        "source: H. Krause and G. Poll, Wear 113 (1986) 103-122",
    ],
    "global": [
        "global: a contact model of wearlaw",
        "total_from = Exact(slip='consistent')",
        "scale: the means of the patch",
        "takes a measured traction_coefficient",
        "does not keep stick: the one cell slips as a whole",
    ],
    "exact": [
        "exact: a contact model of wearlaw",
        "slip = 'consistent' one of 'consistent', 'as_printed'",
        "scale: the patch resolved into cells",
    ],
    "fastsim": [
        "bound = 'parabolic' one of 'parabolic', 'elliptic'",
        "flexibility = 'line' one of 'line', 'kalker'",
        "scale: the patch resolved into cells",
    ],
    "linear": [
        "linear: a contact model of wearlaw",
        "source: J. J. Kalker",
        "scale: the means of the patch",
        "does not keep traction_bound: the force is linear in the creepage and passes μN",
        "does not keep saturation: the force is linear in the creepage and passes μN",
        "does not keep stick: the one node slips",
    ],
    "polach": [
        "adhesion_reduction = 1.0",
        "slip_reduction = 1.0",
        "source: O. Polach, Vehicle System Dynamics Suppl. 33 (1999) 728-739",
        "scale: the means of the patch",
        "does not keep stick: the one node slips as a whole",
        "does not keep saturation: the force tends to μN without reaching it",
    ],
    "shen_hedrick_elkins": [
        "source: Z. Y. Shen, J. K. Hedrick, J. A. Elkins",
        "scale: the means of the patch",
        "does not keep stick: the one node slips as a whole",
    ],
    "strip_theory": [
        "strips = 10",
        "does not keep initial_slope: strips have stiffnesses for the creepages, and none for the spin",
        "source: derived for wearlaw after the strips of D. J. Haines and E. Ollerton",
    ],
    "usfd": [  # Tables 3 and 4 of Tassini et al. (2010)
        "usfd: a wear law of wearlaw",
        "fitted_for = 'global' one of 'global', 'exact', 'fastsim'",
        "m_m = 5.3 µg/m/N",
        "q_s = 55.0 µg/m/mm²",
        "m_c = 61.9 µg/m/N",
        "tr_sc = 77.26 N/mm²",
        "scale: patch means or cells",
        "fitted for: patch means (the global model); R8T wheel steel on UIC 60 900A rail steel; parameters: Tassini",
        "never falls with: wear_index_density",
        "branches in wear_index_density at 10.38 N/mm², 77.26 N/mm²",
        "known range of mean wear_index_density from 0.000 N/mm² to 108.4 N/mm²",
    ],
    "brr": [  # Table 1 of Tassini et al. (2010), times the diameter
        "mild_slope = 0.25 mm³/km/N",
        "plateau = 25.0 mm³/km",
        "severe_slope = 1.19 mm³/km/N",
        "severe_offset = 154.0 mm³/km",
        "mild_limit = 100.0 N",
        "severe_limit = 200.0 N",
        "scale: means of the whole patch only",
        "never falls with: wear_index",
        "branches in wear_index at 100.0 N, 200.0 N",
        "jumps in wear_index at 200.0 N",
    ],
    "kth": [  # Table 2 of Tassini et al. (2010)
        "coefficient = 'mid' one of 'low', 'mid', 'high'",
        "hardness = 2.625 GPa",
        "pressure_threshold = 2.1 GPa",
        "lower_slip_speed = 0.2 m/s",
        "upper_slip_speed = 0.7 m/s",
        "scale: patch means or cells",
        "branches in pressure at 2100 MPa",
        "branches in slip_speed at 0.2000 m/s, 0.7000 m/s",
        "jumps in pressure at 2100 MPa",
        "jumps in slip_speed at 0.2000 m/s, 0.7000 m/s",
        "band: published parameter ranges give a low, a middle and a high law",
    ],
}


def test_there_is_an_expectation_for_every_model_of_the_package() -> None:
    ours = {
        name for shelf in (loader.installed()["contact model"], loader.installed()["wear law"])
        for name in shelf.items() if shelf.origin(name).distribution == "wearlaw"
    }  # fmt: skip
    assert ours == EXPECTED.keys()


@pytest.mark.parametrize("name", EXPECTED)
def test_defaults_units_and_declarations_are_said(name: str) -> None:
    text = said(MODELS[name])
    for expected in EXPECTED[name]:
        assert expected in text


@pytest.mark.parametrize("name", EXPECTED)
def test_the_theory_the_source_and_every_field_with_its_explanation_are_said(name: str) -> None:
    model, text = MODELS[name], said(MODELS[name])
    for expected in (inspect.getdoc(model), f"source: {model.source}"):
        assert expected is not None
        assert " ".join(expected.split()) in text
    for field, description in field_docstrings(model).items():
        assert f" {field} = " in text or f" {field} (must be given) " in text
        assert description
        assert " ".join(description.split()) in text


def test_no_line_of_the_fields_is_wider_than_a_screen() -> None:
    for model in MODELS.values():
        fields = describe(model).partition("fields:")[2].partition("declares:")[0]
        assert max(len(line) for line in fields.splitlines()) <= 100


def test_a_field_with_a_default_need_not_be_given_where_others_must_be() -> None:
    discs, wheel = (said(wl.rigs()[name]) for name in ("twin_disc", "wheel_rail"))
    assert "rolling_speed (must be given)" in discs
    assert "speed_of = 'mean' one of 'mean', 'disc_1' Whose surface speed" in discs
    assert "wheel_profile_radius = inf mm Lateral radius" in wheel


class Silent(wl.WearLaw):
    """Says nothing about itself."""

    name = "silent"
    source = "none"

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> wl.Array:
        return 0.0 * contact.pressure


class Bounded(Silent):
    """Says all that nothing of the package says."""

    name = "bounded"

    def breakpoints(self, p: wl.Numbers) -> wl.BreakpointMap:
        return {}

    @property
    def valid_range(self) -> Mapping[str, tuple[float, float]]:
        return {"pressure": (1e6, 2e9)}


def test_a_law_that_declares_nothing_or_must_be_given_a_field_is_described(monkeypatch: pytest.MonkeyPatch) -> None:
    install = cases.installer(monkeypatch)
    for law in (Silent, Bounded, cases.Linear):
        install(law)
    silent = said(Silent)
    assert silent.startswith("silent: a wear law of wearlaw-testing 9.8.7 (plugin 'testing') Says nothing")
    assert "body = None The body that the law is for" in silent
    assert "declares: scale: patch means or cells branches: not declared" in silent
    assert silent.endswith("branches: not declared")
    assert said(Bounded).endswith("scale: patch means or cells known range of mean pressure from 1.000 MPa to 2000 MPa")
    must = said(cases.Linear)
    assert "slope (must be given) Wear rate over p s [m], of no meaning. " in must
    assert must.endswith("declares: what depends on its fields")


class Damage(BaseOfDamage):
    """Damage of a passage."""

    threshold: Annotated[wl.Quantity, wl.Unit("N")] = Field(default="15 N", validate_default=True)


class Cooling(wl.Stage):
    """Friction that falls."""

    name = "cooling"
    source = "A test, 3. ed., 2026"

    share: float
    """Share of the friction that is left [-]."""

    def altered(self, problem: wl.Problem, forces: wl.Forces) -> wl.Problem:
        return problem.replaced(friction_coefficient=self.share * problem.friction_coefficient)


def test_a_stage_is_described(monkeypatch: pytest.MonkeyPatch) -> None:
    mean = said(wl.stages()["patch_mean"])
    assert mean.startswith("patch_mean: a stage of wearlaw")
    assert mean.endswith(
        "fields: none declares: works around the contact model, and may change the solved contact gives the means of"
        " the whole patch, for laws stated for them"
    )
    cases.installer(monkeypatch)(Cooling)
    cooling = said(Cooling)
    assert "share (must be given) Share of the friction that is left [-]." in cooling
    assert cooling.endswith(
        "declares: changes the problem before the contact model solves it, and leaves the solved contact as it is"
    )


def test_a_law_of_another_outcome_is_described_with_unit_and_sign(monkeypatch: pytest.MonkeyPatch) -> None:
    for law in (Damage, Heat):
        cases.installer(monkeypatch)(law)
    damage, heat = said(Damage), said(Heat)
    assert damage.startswith("damage: a law of wearlaw-testing 9.8.7 (plugin 'testing') Damage of a passage")
    assert "body = None The body that the law is for, by its name in the rig" in damage
    assert "declares: predicts: rcf_damage [-], one value for the whole patch, may be negative scale:" in damage
    assert "declares: predicts: heat_flux [W/mm²], mean over the area of the patch scale:" in heat


def test_stages_and_laws_are_shown_and_listed_by_name(monkeypatch: pytest.MonkeyPatch) -> None:
    for model in (Cooling, Heat):
        cases.installer(monkeypatch)(model)
    listing = cases.wearlaw("plugins").stdout
    for kind, name in (("stage", "cooling"), ("law", "heat"), ("stage", "patch_mean")):
        shown = cases.wearlaw("show", name)
        assert shown.exit_code == 0
        assert shown.stdout.startswith(f"{name}: a {kind} of ")
        assert any(line.split()[:2] == [kind, name] for line in listing.splitlines())
    assert "did you mean 'cooling'?" in cases.wearlaw("show", "coolin").stderr


def test_a_rig_shows_which_fields_have_a_default() -> None:
    shown = said(wl.WheelRail)
    assert "wheel_radius (must be given)" in shown
    assert "wheel_profile_radius = inf mm" in shown
    assert "contact_angle = 0 deg" in shown
    assert "rail_material = None" in shown


@pytest.mark.parametrize("name", ["twin_disc", "wheel_rail", "weight"])
def test_the_example_of_a_rig_is_a_script_that_runs(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    cases.installer(monkeypatch)(Weight)
    monkeypatch.setattr(Weight, "example", {**Weight.example, "mass": wl.Q(20, "kg")})
    rig = wl.rigs()[name]
    script = textwrap.dedent(describe(rig).partition("\nexample:\n")[2])
    made: dict[str, Any] = {}
    exec(script.replace("predict(", "found = predict("), made)
    assert made["rig"] == wl.rig(name, **rig.example_fields)
    assert made["found"].problem.normal_force == made["rig"].problem(**rig.example).normal_force
    monkeypatch.setattr(rig, "example", {})
    assert "example:" not in describe(rig)


def test_a_rig_shows_its_conditions_with_units_and_choices() -> None:
    shown = said(wl.WheelRail)
    assert "normal_force [kN] Normal force, N [N]." in shown
    assert "friction_coefficient (must be given) Friction coefficient, μ [-]." in shown
    assert "exactly one of normal_force, max_pressure must be given" in shown


class Exempt(wl.WearLaw):
    """A law with an exemption."""

    name = "exempt"
    source = "made up for the tests"

    @property
    def exemptions(self) -> dict[str, str]:
        return {"each_node_wears_by_itself": "the hottest node heats the patch"}

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> wl.Array:
        return 0.0 * contact.pressure


class Pressed(Weight):
    """A rig with an exemption."""

    name = "pressed"

    @property
    def exemptions(self) -> dict[str, str]:
        return {"pressure_carries_the_load": "its pressure is not Hertz's"}


def test_what_a_law_or_a_rig_does_not_keep_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    install = cases.installer(monkeypatch)
    install(Exempt)
    install(Pressed)
    assert said(Exempt).endswith("does not keep each_node_wears_by_itself: the hottest node heats the patch")
    assert said(Pressed).endswith("declares: does not keep pressure_carries_the_load: its pressure is not Hertz's")


def test_everything_that_is_listed_is_shown_by_its_name() -> None:
    for kind, name, _ in loader.installed().listing():
        shown = cases.wearlaw("show", name)
        assert shown.exit_code == 0, shown.output
        assert f"{name}: a {kind} of wearlaw" in shown.stdout


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("steel", ["youngs_modulus = 206.47742 GPa", "density = 7850.0 kg/m³", 'material = "steel"']),
        ("SteelWithHardness", ["hardness (must be given)", 'material = {type = "SteelWithHardness", ...}']),
        ("tassini2010", ["rig: twin_disc", "laws: usfd, kth, brr", "sweep creepage: 600 values of creepage"]),
        ("tassini2010", ["measured: lewis2004", "wearlaw run tassini2010", "wearlaw case tassini2010"]),
        ("lewis2004", ["Proc. IMechE J 218(6) (2004) 467-478", "tests: 8", "columns: creepage [%],normal_force [N]"]),
        ("tassini2010_claims", ['sections = ["tassini2010_claims"]', "Shipped cases with it: tassini2010"]),
        ("wheelset", ["a rig of", "a case of", "a section of"]),
    ],
)
def test_what_is_no_model_is_explained_with_its_use(name: str, expected: list[str]) -> None:
    shown = cases.wearlaw("show", name).stdout
    assert [text for text in expected if text not in shown] == []


def test_a_name_of_another_kind_is_suggested_too() -> None:
    assert "did you mean 'steel'?" in cases.wearlaw("show", "Steel").stderr
