"""`wearlaw check`, as a user meets it."""

from __future__ import annotations

import itertools
import re
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

import wearlaw as wl
from tests import cases
from tests.cases import InstallModel, assert_refused, wearlaw


class Own(cases.Linear):
    """A right law with an exemption."""

    name = "own"

    @property
    def exemptions(self) -> dict[str, str]:
        return {"each_node_wears_by_itself": "the hottest node heats the patch"}


class Negative(Own):
    """A wrong law: material grows."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> wl.Array:
        return -super().rate(contact, p)


class Offset(Own):
    """A wrong law: it wears without slip, in a check that is given its reason."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> wl.Array:
        return super().rate(contact, p) + 1e-7


class Ends(Own):
    """A wrong law: it ends the program."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> wl.Array:
        raise SystemExit(0)


def checked(install_model: InstallModel, law: type[wl.WearLaw], *options: str) -> tuple[list[str], int]:
    """Return the lines that the check of a law of one's own prints, and the exit code."""
    install_model(law)
    result = wearlaw("check", "own", "--option", "slope=1 m", *options)
    assert "Traceback" not in result.stderr
    return result.stdout.splitlines(), result.exit_code


def test_each_check_has_a_line_and_they_are_counted(install_model: InstallModel) -> None:
    lines, exit_code = checked(install_model, Own)
    assert exit_code == 0
    assert "ok rate_is_finite" in lines
    assert lines[-2:] == [
        "not claimed each_node_wears_by_itself: the hottest node heats the patch",
        f"{len(lines) - 2} ok, 0 failed, 1 not claimed",
    ]


def test_a_slow_check_states_its_time(install_model: InstallModel, monkeypatch: pytest.MonkeyPatch) -> None:
    clock = SimpleNamespace(process_time=itertools.count(0.0, 2.0).__next__)  # two seconds from one look to the next
    monkeypatch.setattr("wearlaw_kit.commands.time", clock)  # private: a clock
    lines, _ = checked(install_model, Own)
    assert "ok rate_is_finite (2 s)" in lines


def test_a_choice_of_checks_states_their_durations(install_model: InstallModel) -> None:
    lines, _ = checked(install_model, Own, "--only", "rate_is_finite", "--durations")
    assert re.fullmatch(r"ok rate_is_finite \(0\.\d{3} s\)", lines[0])
    assert lines[-1] == "1 ok, 0 failed, 1 not claimed"


def test_all_models_of_a_distribution_are_checked(install_model: InstallModel) -> None:
    install_model(Negative)
    result = wearlaw("check", "--distribution", "WEARLAW_TESTING", "--option", "slope=1 m")
    assert result.exit_code == 1
    assert result.stdout.startswith("wear law own\n")
    assert "\nFAILED rate_is_never_negative" in result.stdout


@pytest.mark.parametrize(
    ("law", "check", "reason"),
    [
        (Negative, "rate_is_never_negative", "the rate is negative"),
        (Ends, "rate_is_finite", "the model raised SystemExit: 0"),
    ],
)
def test_a_failed_check_says_why_and_the_others_go_on(
    install_model: InstallModel, law: Any, check: str, reason: str
) -> None:
    lines, exit_code = checked(install_model, law)
    assert exit_code == 1
    assert any(line.startswith(f"FAILED {check}: ") and reason in line for line in lines)
    assert lines.index("ok declared_names_are_variables") > 0
    assert re.fullmatch(r"\d+ ok, \d+ failed, 1 not claimed", lines[-1])


def test_an_expected_failure_is_counted_apart_and_a_failure_once_it_passes(install_model: InstallModel) -> None:
    expected = ("--expect-failure", "no_slip_no_wear=it has an offset = 1e-7")
    lines, _ = checked(install_model, Offset, *expected)
    assert "failed as expected no_slip_no_wear: it has an offset = 1e-7" in lines
    assert ", 1 failed as expected, 1 not claimed" in lines[-1]
    lines, exit_code = checked(install_model, Own, *expected)
    assert any(line.startswith("FAILED no_slip_no_wear: it passes, but is expected to fail") for line in lines)
    assert exit_code == 1


def test_a_law_in_a_file_is_checked_with_its_own_values(
    install_model: InstallModel, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    install_model(Own)  # whose slope must be given
    monkeypatch.chdir(tmp_path)
    Path("law.toml").write_text('[wear_law]\nmodel = "own"\nslope = "1 m"\n', encoding="utf-8")
    checked_file = wearlaw("check", "law.toml")
    assert checked_file.exit_code == 0
    assert "not claimed each_node_wears_by_itself: the hottest node" in checked_file.stdout
    assert_refused(wearlaw("check", "law.toml", "--option", "slope=1 kg"), "slope")


def test_a_rig_is_checked_with_its_example_fields_unless_they_are_given(monkeypatch: pytest.MonkeyPatch) -> None:
    result = wearlaw("check", "twin_disc", "--option", "track_width=8 mm")
    assert result.exit_code == 0
    assert "ok creepage_is_proportional_to_its_condition\n" in result.stdout
    monkeypatch.setattr(wl.TwinDisc, "example_fields", {**wl.TwinDisc.example_fields, "disc_1": {"diameter": "5 cm"}})
    hint = "give --option disc_1=VALUE, or values to try the rig with in TwinDisc.example_fields"
    assert_refused(wearlaw("check", "twin_disc"), f"disc_1.material: is missing\n{hint}")


def test_the_declared_accuracy_of_a_contact_model_is_shown_for_each_shape_of_patch() -> None:
    lines = wearlaw("check", "shen_hedrick_elkins").stdout.splitlines()
    assert not any(line.startswith("accuracy") for line in lines)  # one node holds the means
    lines = wearlaw("check", "exact", "--option", "slip=as_printed").stdout.splitlines()
    assert "accuracy of sums over line contacts: 5e-08" in lines
    assert "not claimed energy_balance: the printed slip lacks a term in partial slip" in lines


@pytest.mark.parametrize(
    ("arguments", "message", "exit_code"),
    [
        (["steel"], "'steel' is a material, which has no checks; wearlaw show steel explains it", 1),
        (["usdf"], "no model is called 'usdf'; did you mean 'usfd'?", 1),
        (["usfd", "--option", "fited_for=exact"], "usfd: fited_for: unknown field; did you mean 'fitted_for'?", 1),
        (["usfd", "--option", "exact"], "--option: write it as FIELD=VALUE, got 'exact'", 2),
        (["usfd", "--option", "q_s=a=b"], "usfd: q_s: 'a=b' is not a number with a unit", 1),
        ([], "give the name of a model, or --distribution", 2),
        (["--distribution", "wearlow"], "no installed distribution 'wearlow' has models; did you mean 'wearlaw'?", 1),
        (["usfd", "--only", "rate_is"], "--only: no check of usfd is called 'rate_is'; did you mean 'rate_", 1),
        (["usfd", "--expect-failure", "rate_is=x"], "--expect-failure: no check of 'usfd' is called 'rate_is'", 1),
        (["usfd", "--expect-failure", "rate_is_finite= "], "the expected failure of 'rate_is_finite' has no reason", 1),
    ],
)
def test_what_cannot_be_checked_is_one_clear_error(arguments: list[str], message: str, exit_code: int) -> None:
    assert_refused(wearlaw("check", *arguments), message, exit_code)
