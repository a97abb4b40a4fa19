"""`wearlaw check`, as a user meets it."""

from __future__ import annotations

import re
from collections.abc import Iterator

import pytest

import wearlaw as wl
from tests.core import cases
from tests.core.cases import InstallModel, assert_refused, wearlaw
from wearlaw_kit import checks, commands


class SaidCheck:
    """A check that fails with a message, or passes without one."""

    doc = "The rate is fine.\n\nAt every node."

    def __init__(self, name: str, message: str | None = None) -> None:
        self.name = name
        self.message = message

    def __call__(self) -> None:
        if self.message is not None:
            raise AssertionError(self.message)


Checked = list[wl.Rig | wl.ContactModel | wl.WearLaw]


@pytest.fixture
def said(monkeypatch: pytest.MonkeyPatch) -> tuple[list[SaidCheck], Checked]:
    """Put given checks in the place of the kit's, and return them with the models that were checked."""
    given: list[SaidCheck] = []
    checked: Checked = []

    def checks(model: wl.Rig | wl.ContactModel | wl.WearLaw) -> Iterator[SaidCheck]:
        checked.append(model)
        yield from given

    monkeypatch.setattr(commands, "checks", checks)
    return given, checked


def test_each_check_has_a_line_and_they_are_counted(said: tuple[list[SaidCheck], Checked]) -> None:
    said[0][:] = [SaidCheck("shape"), SaidCheck("finite"), SaidCheck("batch")]
    result = wearlaw("check", "usfd")
    assert result.exit_code == 0
    assert result.stdout == "ok shape\nok finite\nok batch\n3 ok, 0 failed, 0 not claimed\n"
    assert said[1] == [wl.wear_law("usfd")]


def test_a_failed_check_says_the_first_line_of_why_and_the_others_go_on(
    said: tuple[list[SaidCheck], Checked],
) -> None:
    said[0][:] = [SaidCheck("shape", "it has 3 axes\nnot 2"), SaidCheck("finite", ""), SaidCheck("batch")]
    result = wearlaw("check", "usfd")
    assert result.exit_code == 1
    assert result.stdout == (
        "FAILED shape: it has 3 axes\nFAILED finite: The rate is fine.\nok batch\n1 ok, 2 failed, 0 not claimed\n"
    )
    assert "Traceback" not in result.stderr


def test_what_a_contact_model_does_not_claim_is_said(said: tuple[list[SaidCheck], Checked]) -> None:
    said[0][:] = [SaidCheck("shape")]
    result = wearlaw("check", "exact", "--option", "slip=as_printed")
    assert result.stdout == (
        "ok shape\naccuracy of sums over line contacts: 5e-08\n"
        "not claimed energy_balance: the printed slip lacks a term in partial slip\n"
        "1 ok, 0 failed, 1 not claimed\n"
    )
    assert result.exit_code == 0
    assert said[1] == [wl.contact_model("exact", slip="as_printed")]


def test_the_declared_accuracy_is_shown_for_each_shape_of_patch(said: tuple[list[SaidCheck], Checked]) -> None:
    said[0][:] = [SaidCheck("shape")]
    result = wearlaw("check", "fastsim")
    assert result.stdout == (
        "ok shape\naccuracy of sums over line contacts: 5e-08\naccuracy of sums over elliptic contacts: 0.05\n"
        "accuracy of sums over patches of strips: 0.05\n1 ok, 0 failed, 0 not claimed\n"
    )
    assert wearlaw("check", "polach").stdout.count("accuracy") == 0  # one node holds the means


def test_options_may_be_repeated_and_hold_an_equals_sign(said: tuple[list[SaidCheck], Checked]) -> None:
    result = wearlaw("check", "usfd", "--option", "fitted_for=exact", "--option", "q_s=56 ug/m/mm^2")
    assert result.exit_code == 0
    assert said[1] == [wl.wear_law("usfd", fitted_for="exact", q_s="56 ug/m/mm^2")]
    assert_refused(wearlaw("check", "usfd", "--option", "q_s=a=b"), "usfd: q_s: 'a=b' is not a number with a unit")


@pytest.mark.parametrize(("options", "width"), [((), "10 mm"), (("--option", "track_width=8 mm"), "8 mm")])
def test_a_rig_is_checked_with_its_example_fields_unless_they_are_given(
    said: tuple[list[SaidCheck], Checked], options: tuple[str, ...], width: str
) -> None:
    assert wearlaw("check", "twin_disc", *options).exit_code == 0
    fields = {**wl.TwinDisc.example_fields, "track_width": width}
    assert said[1] == [wl.rig("twin_disc", **fields)]


def test_fields_that_are_missing_are_named_with_how_to_give_them(
    install_model: InstallModel, monkeypatch: pytest.MonkeyPatch
) -> None:
    install_model(cases.Linear)
    assert_refused(wearlaw("check", "linear"), "slope: is missing\ngive --option slope=VALUE")
    monkeypatch.setattr(wl.TwinDisc, "example_fields", {**wl.TwinDisc.example_fields, "disc_1": {"diameter": "5 cm"}})
    hint = "give --option disc_1=VALUE, or values to try the rig with in TwinDisc.example_fields"
    assert_refused(wearlaw("check", "twin_disc"), f"disc_1.material: is missing\n{hint}")


def test_a_rig_is_checked_from_the_command_line() -> None:
    result = wearlaw("check", "wheel_rail")
    assert result.exit_code == 0
    assert "ok only_creepage_turns_with_its_sign\n" in result.stdout


@pytest.mark.parametrize(
    ("arguments", "message", "exit_code"),
    [
        (["steel"], "'steel' is a material, which has no checks; wearlaw show steel explains it", 1),
        (["usdf"], "no model is called 'usdf'; did you mean 'usfd'?", 1),
        (["usfd", "--option", "fited_for=exact"], "usfd: fited_for: unknown field; did you mean 'fitted_for'?", 1),
        (["usfd", "--option", "exact"], "--option: write it as FIELD=VALUE, got 'exact'", 2),
    ],
)
def test_a_model_that_cannot_be_checked_is_one_clear_error(
    said: tuple[list[SaidCheck], Checked], arguments: list[str], message: str, exit_code: int
) -> None:
    assert_refused(wearlaw("check", *arguments), message, exit_code)
    assert not said[1]


@pytest.mark.parametrize("error", [SystemExit(0), GeneratorExit("over")], ids=["SystemExit", "GeneratorExit"])
def test_a_law_that_ends_the_program_fails_the_checks(
    error: BaseException, monkeypatch: pytest.MonkeyPatch, install_model: InstallModel
) -> None:
    class Ending(cases.Linear):
        name = "ending"

        def rate(self, contact: wl.Contact, p: wl.Numbers) -> wl.Array:
            if contact.pressure.size:
                raise error
            return contact.pressure

    install_model(Ending)
    name = "no_slip_no_wear"
    monkeypatch.setattr("wearlaw_kit.commands.checks", lambda law: [one for one in checks(law) if one.name == name])
    result = wearlaw("check", "ending", "--option", "slope=1 m")
    assert result.exit_code == 1
    reason = f"the model raised {type(error).__name__}: {error}"
    assert result.stdout == f"FAILED no_slip_no_wear: {reason}\n0 ok, 1 failed, 0 not claimed\n"


def test_a_law_that_breaks_its_contract_fails_the_checks(
    monkeypatch: pytest.MonkeyPatch, install_model: InstallModel
) -> None:
    class Negative(cases.Linear):
        name = "negative"

        def rate(self, contact: wl.Contact, p: wl.Numbers) -> wl.Array:
            return -super().rate(contact, p)

    install_model(Negative)
    # Two checks of the kit: hypothesis takes seconds to find the smallest example of each failure.
    chosen = ("rate_is_never_negative", "no_slip_no_wear")
    monkeypatch.setattr("wearlaw_kit.commands.checks", lambda law: [one for one in checks(law) if one.name in chosen])
    result = wearlaw("check", "negative", "--option", "slope=1 m")
    assert result.exit_code == 1
    assert "FAILED rate_is_never_negative: " in result.stdout
    assert "ok no_slip_no_wear\n" in result.stdout
    assert "1 ok, 1 failed" in result.stdout


def with_checks(monkeypatch: pytest.MonkeyPatch, *names: str) -> None:
    """Let `wearlaw check` run some of the checks only."""
    monkeypatch.setattr("wearlaw_kit.commands.checks", lambda law: [one for one in checks(law) if one.name in names])


def test_an_expected_failure_is_counted_apart(monkeypatch: pytest.MonkeyPatch, install_model: InstallModel) -> None:
    install_model(Offset)
    with_checks(monkeypatch, "rate_is_finite", "no_slip_no_wear")
    given = ("check", "offset", "--option", "slope=1 m", "--expect-failure")
    result = wearlaw(*given, "no_slip_no_wear=it has an offset = 1e-7")
    assert result.stdout == (
        "ok rate_is_finite\nfailed as expected no_slip_no_wear: it has an offset = 1e-7\n"
        "1 ok, 0 failed, 1 failed as expected, 0 not claimed\n"
    )
    assert result.exit_code == 0


def test_an_expected_failure_that_passes_is_a_failure(said: tuple[list[SaidCheck], Checked]) -> None:
    said[0][:] = [SaidCheck("shape"), SaidCheck("finite", "NaN")]
    result = wearlaw("check", "usfd", "--expect-failure", "shape=odd", "--expect-failure", "finite=known")
    assert result.stdout == (
        "FAILED shape: it passes, but is expected to fail: odd\nfailed as expected finite: known\n"
        "0 ok, 1 failed, 1 failed as expected, 0 not claimed\n"
    )
    assert result.exit_code == 1


@pytest.mark.parametrize(
    ("expected", "message", "exit_code"),
    [
        ("shap=odd", "--expect-failure: no check of 'usfd' is called 'shap'; did you mean 'shape'?", 1),
        ("shape= ", "--expect-failure: the expected failure of 'shape' has no reason", 1),
        ("shape", "--expect-failure: write it as CHECK=REASON, got 'shape'", 2),
    ],
)
def test_an_expected_failure_that_cannot_be_is_one_clear_error(
    said: tuple[list[SaidCheck], Checked], expected: str, message: str, exit_code: int
) -> None:
    said[0][:] = [SaidCheck("shape")]
    assert_refused(wearlaw("check", "usfd", "--expect-failure", expected), message, exit_code)


def test_what_a_law_does_not_claim_is_said(monkeypatch: pytest.MonkeyPatch, install_model: InstallModel) -> None:
    class NonLocal(cases.Linear):
        name = "non_local"

        @property
        def exemptions(self) -> dict[str, str]:
            return {"each_node_wears_by_itself": "the hottest node heats the patch"}

    install_model(NonLocal)
    with_checks(monkeypatch, "rate_is_finite", "each_node_wears_by_itself")
    result = wearlaw("check", "non_local", "--option", "slope=1 m")
    assert result.stdout == (
        "ok rate_is_finite\nnot claimed each_node_wears_by_itself: the hottest node heats the patch\n"
        "1 ok, 0 failed, 1 not claimed\n"
    )


def test_after_a_wrong_shape_all_checks_fail_with_its_message(install_model: InstallModel) -> None:
    class Pairs(cases.Linear):
        name = "pairs"

        def rate(self, contact: wl.Contact, p: wl.Numbers) -> wl.Array:
            return super().rate(contact, p)[..., None]

    install_model(Pairs)
    result = wearlaw("check", "pairs", "--option", "slope=1 m")
    lines = result.stdout.splitlines()
    assert lines[0].startswith("FAILED rate_has_the_right_shape: rates of shape ")
    assert {line.partition(": ")[2] for line in lines[1:-2]} == {lines[0].partition(": ")[2]}
    assert lines[-2] == "ok exemptions_are_claims"
    assert re.fullmatch(r"1 ok, 2\d failed, 0 not claimed", lines[-1])
    assert result.exit_code == 1


class Offset(cases.Linear):
    """Wear without slip."""

    name = "offset"

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> wl.Array:
        return super().rate(contact, p) + 1e-7
