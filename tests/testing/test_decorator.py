from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path
from typing import ClassVar

import pytest

import wearlaw as wl
from tests.testing import cells
from tests.testing.wrong_declarations import NoReason, UnknownClaim
from tests.testing.wrong_laws import Linear, WrongSign
from tests.testing.wrong_rigs import Weight
from wearlaw.testing import Check, checks, conformance

SUITE = """
from tests.testing.wrong_declarations import HottestNode
from tests.testing.wrong_laws import Linear, Offset, Raises, WrongSign
from wearlaw.testing import conformance

@conformance(WrongSign(), expected_failures={"rate_is_never_negative": "material grows"})
def test_known(check):
    check()

@conformance(Linear(), expected_failures={"rate_is_finite": "it passes, in truth"})
def test_unknown(check):
    check()

@conformance(Offset())
def test_wrong(check):
    check()

@conformance(HottestNode())
def test_exempt(check):
    check()
"""


@pytest.fixture(scope="module")
def report(tmp_path_factory: pytest.TempPathFactory) -> str:
    """What pytest prints about a suite of one expected failure, one that passes, and one failure."""
    folder = tmp_path_factory.mktemp("suite")
    (folder / "test_suite.py").write_text(SUITE)
    chosen = "never_negative or is_finite or no_slip or wears_by_itself"
    command = [sys.executable, "-m", "pytest", "-v", "-rA", "-k", chosen, "-p", "no:cacheprovider", str(folder)]
    root = Path(__file__).parents[2]
    done = subprocess.run(
        [*command, f"--rootdir={folder}", "-c", "/dev/null"], capture_output=True, text=True, cwd=root, check=False
    )
    return done.stdout


def test_ids_are_the_names_of_the_checks(report: str) -> None:
    assert "test_wrong[rate_is_finite] PASSED" in report


def test_an_expected_failure_is_an_xfail_with_its_reason(report: str) -> None:
    assert re.search(r"XFAIL \S+::test_known\[rate_is_never_negative\] - material grows", report), report


def test_an_expected_failure_that_passes_fails(report: str) -> None:
    assert "[XPASS(strict)] it passes, in truth" in report


def test_a_claim_that_a_model_is_exempt_from_is_skipped_with_its_reason(report: str) -> None:
    assert "test_exempt[each_node_wears_by_itself] SKIPPED" in report
    assert "not claimed: the hottest node heats the patch" in report
    assert "test_exempt[rate_is_finite] PASSED" in report


def test_a_failure_shows_the_counter_example_and_the_values(report: str) -> None:
    assert "test_wrong[no_slip_no_wear] FAILED" in report
    assert "without slip the rate is array([[1.e-07]]), not zero" in report
    # only a rewritten assert shows what its parts were
    assert "assert np.False_" in report
    assert "example=Contact(pressure=array([[0.]])" in report


def test_an_unknown_expected_failure_is_an_error_with_a_hint() -> None:
    with pytest.raises(wl.InputError, match=r"'no_slip_no_war'.*'no_slip_no_wear'"):
        conformance(wl.wear_law("usfd"), expected_failures={"no_slip_no_war": "misspelt"})


def test_an_expected_failure_needs_a_reason() -> None:
    with pytest.raises(
        wl.InputError, match=r"expected_failures: the expected failure of 'no_slip_no_wear' has no reason"
    ):
        conformance(wl.wear_law("usfd"), expected_failures={"no_slip_no_wear": " "})


def failure_of(model: wl.WearLaw | wl.Rig, name: str) -> str:
    check = {check.name: check for check in checks(model)}[name]
    with pytest.raises(AssertionError) as failure:
        check()
    return str(failure.value).splitlines()[0]


def test_a_wrong_exemption_says_what_is_wrong() -> None:
    assert failure_of(UnknownClaim(), "exemptions_are_claims") == (
        "`exemptions`: no claim is called 'each_node_wears_by_itsel'; did you mean 'each_node_wears_by_itself'?"
    )
    reason = "the exemption from 'each_node_wears_by_itself' has no reason"
    assert failure_of(NoReason(), "exemptions_are_claims") == reason


@pytest.mark.parametrize("claim", ["each_node_wears_by_itself", "position_does_not_matter"])
def test_any_check_of_a_law_can_be_exempt(claim: str, monkeypatch: pytest.MonkeyPatch) -> None:
    all_of_them = [check.name for check in checks(Linear())]
    monkeypatch.setattr(Linear, "exemptions", {claim: "for a test"})
    assert [check.name for check in checks(Linear())] == [name for name in all_of_them if name != claim]


def test_a_check_of_a_rig_and_a_single_one_of_a_contact_model_can_be_exempt() -> None:
    class OwnPressure(Weight):
        exemptions: ClassVar = {"pressure_carries_the_load": "the pressure is not Hertz's"}

    class FallingFriction(cells.Cells):
        exemptions: ClassVar = {"force_grows_with_creepage": "friction falls"}

    for exempt, model in ((OwnPressure(), Weight()), (FallingFriction(), cells.Cells())):
        left_out = {check.name for check in checks(model)} - {check.name for check in checks(exempt)}
        assert left_out == set(exempt.exemptions)
        next(check for check in checks(exempt) if check.name == "exemptions_are_claims")()


def test_what_must_hold_for_any_model_cannot_be_exempt(monkeypatch: pytest.MonkeyPatch) -> None:
    class Growing(Linear):
        """The rate of `Linear` with the other sign."""

        def rate(self, contact: wl.Contact, p: wl.Numbers) -> wl.Array:
            rate: wl.Array = -super().rate(contact, p)
            return rate

    every = {check.name for check in checks(Growing())} - {"exemptions_are_claims"}
    monkeypatch.setattr(Growing, "exemptions", dict.fromkeys(every, "for a test"))
    with pytest.raises(wl.InputError) as error:
        next(checks(Growing()))
    assert str(error.value) == (
        f"wear law '{Linear.name}': `exemptions` names rate_has_the_right_shape, rate_is_finite,"
        " rate_is_never_negative, units_of_parameters_do_not_matter, which must hold for any wear law;"
        " take them out, and correct the model if a check fails"
    )


@pytest.mark.parametrize(
    ("model", "claim"),
    [
        (cells.Cells(), "contact_is_finite"),
        (Weight(), "units_of_conditions_are_checked"),
        (wl.patch_mean(), "pipelines_take_the_contact"),
    ],
)
def test_no_contact_model_rig_or_stage_is_exempt_from_it(
    model: wl.Rig | wl.ContactModel | wl.Stage, claim: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(type(model), "exemptions", {claim: "for a test"})
    with pytest.raises(wl.InputError, match=f"`exemptions` names {claim}, which must hold for any {model.kind}"):
        conformance(model)


def test_a_check_of_what_a_model_does_not_claim_is_not_there_to_fail() -> None:
    with pytest.raises(wl.InputError, match="what_sticks_does_not_slip"):
        conformance(wl.contact_model("global"), expected_failures={"what_sticks_does_not_slip": "one cell"})


def test_checks_are_named_documented_and_frozen() -> None:
    found = list(checks(WrongSign()))
    assert len({check.name for check in found}) == len(found)
    assert all(check.name.isidentifier() and check.doc for check in found)
    with pytest.raises(AttributeError):
        found[0].name = "other"  # type: ignore[misc]


def test_checks_of_something_else_are_an_error() -> None:
    with pytest.raises(wl.InputError, match="needs a rig, a contact model, a stage or a law"):
        list(checks(3))  # type: ignore[arg-type]


def test_a_rig_without_an_example_is_an_error_that_says_what_to_write(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Weight, "example", {})
    with pytest.raises(wl.InputError, match=r"'weight' has no conditions to try it with.*class Weight") as refused:
        list(checks(Weight()))
    assert str(refused.value).endswith('  example = {"mass": ..., "creepage": ..., "friction_coefficient": ...}')


def test_an_error_in_the_model_is_a_failure_that_names_it() -> None:
    def broken() -> None:
        raise ZeroDivisionError("by nothing")

    with pytest.raises(AssertionError, match="the model raised ZeroDivisionError: by nothing"):
        Check("broken", "", broken)()


def test_of_several_errors_of_a_model_the_first_is_the_failure() -> None:
    def broken() -> None:
        raise ExceptionGroup("", [ExceptionGroup("", [KeyError("a"), ValueError("b")]), TypeError("c")])

    def failing() -> None:
        raise ExceptionGroup("", [AssertionError("the rate falls"), ValueError("b")])

    with pytest.raises(AssertionError, match=r"^the model raised KeyError: 'a'$"):
        Check("broken", "", broken)()
    with pytest.raises(AssertionError, match=r"^the rate falls$"):
        Check("failing", "", failing)()
