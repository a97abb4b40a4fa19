"""What `wearlaw show` says of a model: nothing that its class declares may be missing."""

from __future__ import annotations

import inspect
import textwrap
from typing import Any

import pytest

import wearlaw as wl
from tests import cases
from tests.core.outcome_laws import Heat
from tests.plugins.kit.wrong_rigs import Weight
from wearlaw import loader  # private: plugins of a test are found as if they were installed
from wearlaw.configuration import field_docstrings  # private: what `show`, schemas and signatures say of fields
from wearlaw.models.model import Model  # private: the bound of a quadrature
from wearlaw_apps.show import describe

MODELS: dict[str, type[Model]] = {**wl.installed("contact model"), **wl.installed("wear law")}


def said(model: type[Model]) -> str:
    """Return the description with its line breaks undone."""
    return " ".join(describe(model).split())


EXPECTED: dict[str, list[str]] = {
    "global": [
        "global: a contact model of wearlaw",
        "total_from = Exact(slip='consistent')",
        "scale: the means of the patch",
        "takes a measured traction_coefficient",
        "does not keep stick: the one cell slips as a whole",
    ],
    "usfd": [  # Tables 3 and 4 of Tassini et al. (2010)
        "usfd: a wear law of wearlaw",
        "fitted_for = 'global' one of 'global', 'exact', 'fastsim'",
        "m_m = 5.3 µg/m/N",
        "tr_sc = 77.26 N/mm²",
        "scale: patch means or cells",
        "fitted for: patch means (the global model); R8T wheel steel on UIC 60 900A rail steel; parameters: Tassini",
        "never falls with: wear_index_density",
        "branches in wear_index_density at 10.38 N/mm², 77.26 N/mm²",
        "known range of mean wear_index_density from 0 N/mm² to 108.4 N/mm²",
    ],
    "kth": [  # Table 2 of Tassini et al. (2010)
        "coefficient = 'mid' one of 'low', 'mid', 'high'",
        "branches in slip_speed at 0.2000 m/s, 0.7000 m/s",
        "jumps in pressure at 2100 MPa",
        "jumps in slip_speed at 0.2000 m/s, 0.7000 m/s",
        "band: published parameter ranges give a low, a middle and a high law",
    ],
}


@pytest.mark.parametrize("name", EXPECTED)
def test_defaults_units_and_declarations_are_said(name: str) -> None:
    text = said(MODELS[name])
    for expected in EXPECTED[name]:
        assert expected in text


@pytest.mark.parametrize("name", MODELS)
def test_the_theory_the_source_and_every_field_with_its_explanation_are_said(name: str) -> None:
    model, text = MODELS[name], said(MODELS[name])
    for expected in (inspect.getdoc(model), f"source: {model.source}"):
        assert expected is not None
        assert " ".join(expected.split()) in text
    for field, description in field_docstrings(model).items():
        assert f" {field} = " in text or f" {field} (must be given) " in text
        assert description
        assert " ".join(description.split()) in text


class Silent(wl.WearLaw):
    """Says nothing about itself."""

    name = "silent"

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> wl.Array:
        return 0.0 * contact.pressure


def test_a_law_that_declares_nothing_or_must_be_given_a_field_is_described(monkeypatch: pytest.MonkeyPatch) -> None:
    install = cases.installer(monkeypatch)
    for law in (Silent, cases.Linear):
        install(law)
    silent = said(Silent)
    assert silent.startswith("silent: a wear law of wearlaw-testing 9.8.7 (plugin 'testing') Says nothing")
    assert "body = None The body that the law is for" in silent
    assert "declares: scale: patch means or cells branches: not declared" in silent
    assert silent.endswith("branches: not declared")
    must = said(cases.Linear)
    assert "slope (must be given) Wear rate over p s [m], of no meaning. " in must
    assert must.endswith("declares: what depends on its fields")


def test_a_law_without_a_source_is_described(monkeypatch: pytest.MonkeyPatch) -> None:
    class Unsaid(wl.WearLaw):
        """Wears nothing."""

        name = "unsaid"
        rate = Silent.rate

    cases.installer(monkeypatch)(Unsaid)
    assert "source: not stated" in said(Unsaid)


def test_a_stage_is_described() -> None:
    mean = said(wl.installed("stage")["patch_mean"])
    assert mean.startswith("patch_mean: a stage of wearlaw")
    assert mean.endswith(
        "fields: none declares: works around the contact model, and may change the solved contact gives the means of"
        " the whole patch, for laws stated for them"
    )
    assert said(wl.installed("stage")["thermal"]).endswith(
        "declares: changes the problem before the contact model solves it, and leaves the solved contact as it is"
    )


def test_a_law_of_another_outcome_is_described_with_unit_and_sign(monkeypatch: pytest.MonkeyPatch) -> None:
    cases.installer(monkeypatch)(Heat)
    assert "declares: predicts: heat_flux [W/mm²], mean over the area of the patch Heat flux scale:" in said(Heat)
    wlrm = said(loader.discovered()["law"].items()["wlrm"])
    assert wlrm.startswith("wlrm: a law of wearlaw")
    assert "body = None The body that the law is for, by its name in the rig" in wlrm
    assert "declares: predicts: rcf_damage [-], one value for the whole patch, may be negative" in wlrm


@pytest.mark.parametrize("name", ["twin_disc", "wheel_rail", "weight"])
def test_the_example_of_a_rig_is_a_script_that_runs(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    cases.installer(monkeypatch)(Weight)
    monkeypatch.setattr(Weight, "example", {**Weight.example, "mass": wl.Q(20, "kg")})
    rig = wl.installed("rig")[name]
    script = textwrap.dedent(describe(rig).partition("\nexample:\n")[2])
    made: dict[str, Any] = {}
    exec(script.replace("predict(", "found = predict("), made)
    assert made["rig"] == wl.rig(name, **rig.example_fields)
    assert made["found"].problem.normal_force == made["rig"].problem(**rig.example).normal_force
    monkeypatch.setattr(rig, "example", {})
    assert "example:" not in describe(rig)


def test_a_rig_shows_its_conditions_with_units_and_choices() -> None:
    shown = said(wl.WheelRail)
    assert "normal_force [kN] Normal force, N [N];" in shown
    assert "friction_coefficient (must be given) Friction coefficient, μ [-]." in shown
    assert "exactly one of normal_force, max_pressure must be given" in shown


class Pressed(Weight):
    """A rig with an exemption."""

    name = "pressed"

    @property
    def exemptions(self) -> dict[str, str]:
        return {"pressure_carries_the_load": "its pressure is not Hertz's"}


def test_what_a_rig_does_not_keep_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    cases.installer(monkeypatch)(Pressed)
    assert said(Pressed).endswith("declares: does not keep pressure_carries_the_load: its pressure is not Hertz's")


def test_everything_that_is_listed_is_shown_by_its_name() -> None:
    every = [(kind, name) for kind, shelf in loader.discovered().shelves.items() for name in shelf.items()]
    for kind, name in every:
        shown = cases.wearlaw("show", name)
        assert shown.exit_code == 0, shown.output
        assert f"{name}: a {kind} of wearlaw" in shown.stdout


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("steel", ["youngs_modulus = 206.47742 GPa", "density = 7850.0 kg/m³", 'material = "steel"']),
        ("SteelWithHardness", ["hardness (must be given)", 'material = {type = "SteelWithHardness", ...}']),
        ("tassini2010", ["Tassini et al. (2010)", "wearlaw run tassini2010", "wearlaw case tassini2010"]),
        ("lewis2004", ["Proc. IMechE J 218(6) (2004) 467-478", "tests: 8", "columns: creepage [%],normal_force [N]"]),
        ("tassini2010_claims", ['sections = ["tassini2010_claims"]', "Shipped cases with it: tassini2010"]),
        ("wheelset", ["a rig of", "a case of", "a section of"]),
    ],
)
def test_what_is_no_model_is_explained_with_its_use(name: str, expected: list[str]) -> None:
    shown = cases.wearlaw("show", name).stdout
    assert [text for text in expected if text not in shown] == []
