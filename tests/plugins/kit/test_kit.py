"""Checks as tests of pytest: names, claims, exemptions, expected failures, and what a failure says."""

from __future__ import annotations

import contextlib
import re
import subprocess
import sys
from pathlib import Path
from typing import Any, ClassVar

import pytest

import wearlaw as wl
from tests.plugins.kit.cells import Cells
from tests.plugins.kit.strips import Strips
from tests.plugins.kit.wrong_laws import OF_RATE, Linear
from tests.plugins.kit.wrong_rigs import Weight
from tests.plugins.kit.wrong_stages import Lubricated
from wearlaw_kit import checks, conformance
from wearlaw_kit.rules import RULES  # private: all claims, whatever the model

SUITE = """
from tests.plugins.kit.wrong_laws import OF_RATE, HottestNode, Linear
from wearlaw_kit import conformance

@conformance(OF_RATE["WrongSign"](), expected_failures={"rate_is_never_negative": "material grows"})
def test_known(check):
    check()

@conformance(Linear(), expected_failures={"rate_is_finite": "it passes, in truth"})
def test_unknown(check):
    check()

@conformance(OF_RATE["Offset"]())
def test_wrong(check):
    check()

@conformance(HottestNode())
def test_exempt(check):
    check()
"""


def test_what_pytest_shows_of_expected_failures_exemptions_and_counter_examples(tmp_path: Path) -> None:
    (tmp_path / "test_suite.py").write_text(SUITE)
    chosen = "never_negative or is_finite or no_slip or wears_by_itself"
    command = [sys.executable, "-m", "pytest", "-v", "-rA", "-k", chosen, "-p", "no:cacheprovider", str(tmp_path)]
    command += [f"--rootdir={tmp_path}", "-c", "/dev/null"]
    done = subprocess.run(command, capture_output=True, text=True, cwd=Path(__file__).parents[3], check=False)
    report = done.stdout
    assert "test_wrong[rate_is_finite] PASSED" in report
    assert re.search(r"XFAIL \S+::test_known\[rate_is_never_negative\] - material grows", report), report
    assert "[XPASS(strict)] it passes, in truth" in report
    assert "test_exempt[each_node_wears_by_itself] SKIPPED" in report
    assert "not claimed: the hottest node heats the patch" in report
    assert "test_wrong[no_slip_no_wear] FAILED" in report
    assert "example=Contact(pressure=array([[" in report
    assert "assert np.False_" in report  # only a rewritten assert shows what its parts were


@pytest.mark.parametrize("reason", [{"no_slip_no_war": "misspelt"}, {"no_slip_no_wear": " "}])
def test_an_expected_failure_is_a_check_and_has_a_reason(reason: dict[str, str]) -> None:
    with pytest.raises(wl.InputError, match="no_slip_no_wear"):
        conformance(wl.wear_law("usfd"), expected_failures=reason)


class Beside(Strips):
    """Its strips lie beside the patch."""

    def at(self, problem: wl.Problem, shares: Any = None, widths: Any = None) -> wl.Contact:
        contact = super().at(problem, shares, widths)
        return contact.replaced(y=2.0 * contact.y)


def test_a_message_ends_before_it_fills_a_page() -> None:
    check = {check.name: check for check in checks(Beside())}["nodes_cover_the_patch"]
    with pytest.raises(AssertionError) as failure:
        check()
    assert len(str(failure.value)) == 600


def exempt(base: Any, claim: str) -> Any:
    """Return a model that does not claim something."""
    return type("Exempt", (base,), {"exemptions": property(lambda _: {claim: "for the tests"}), "__doc__": "Exempt."})()


@pytest.mark.parametrize("claim", dict.fromkeys(claim for rule in RULES for claim in rule.claims[1:]))
def test_an_exemption_leaves_out_the_checks_of_a_claim(claim: str) -> None:
    kept, left = ([check.name for check in checks(model)] for model in (Strips(), exempt(Strips, claim)))
    assert set(left) < set(kept)
    assert "no_node_gains_energy" in left


class Soft(Strips):
    """Initial slopes without spin are 20 % too low."""

    exempt: ClassVar[dict[str, str | wl.Exempt]] = {}

    @property
    def exemptions(self) -> dict[str, str | wl.Exempt]:
        return self.exempt

    def at(self, problem: wl.Problem, shares: Any = None, widths: Any = None) -> wl.Contact:
        creepages = 0.8 * problem.longitudinal_creepage, 0.8 * problem.lateral_creepage, problem.spin
        contact = super().at(problem.with_creepages(*creepages), shares, widths)
        return contact.replaced(problem=problem)


@pytest.mark.parametrize(
    ("claim", "exemption", "passes"),
    [
        ("initial_slopes_are_kalkers", wl.Exempt("soft", upto=0.25), True),
        ("initial_slopes_are_kalkers", wl.Exempt("soft", upto=0.1), False),
        ("initial_slopes_are_kalkers", wl.Exempt("soft", only=("longitudinal", "lateral")), True),
        ("initial_slopes_are_kalkers", wl.Exempt("soft", only="longitudinal"), False),
        ("initial_slopes_are_kalkers", wl.Exempt("soft", only="spin"), False),
        ("initial_slopes_are_kalkers", wl.Exempt("soft", only="spin", upto=0.3), False),
        ("initial_slopes_are_kalkers", wl.Exempt("soft", only="ellipse"), True),
        ("exemptions_are_claims", wl.Exempt("soft", only="spinn"), False),
        ("exemptions_are_claims", wl.Exempt("soft", upto=-0.1), False),
        ("exemptions_are_claims", wl.Exempt(" ", only="spin"), False),
    ],
)
def test_an_exemption_of_a_part_or_up_to_a_bound_leaves_the_rest(
    claim: str, exemption: wl.Exempt, passes: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Soft, "exempt", {"initial_slope": exemption})
    check = {check.name: check for check in checks(Soft())}[claim]
    with contextlib.nullcontext() if passes else pytest.raises(AssertionError):
        check()


@pytest.mark.parametrize(
    ("base", "name"),
    [(Linear, "position_does_not_matter"), (Weight, "pressure_carries_the_load"), (Cells, "force_grows_with_creepage")],
)
def test_a_single_check_can_be_exempt(base: Any, name: str) -> None:
    assert [c.name for c in checks(exempt(base, name))] == [c.name for c in checks(base()) if c.name != name]


@pytest.mark.parametrize(
    ("base", "name"),
    [
        (Linear, "rate_is_finite"),
        (Cells, "contact_is_finite"),
        (Weight, "units_of_conditions_are_checked"),
        (Lubricated, "pipelines_take_the_contact"),
    ],
)
def test_what_must_hold_for_any_model_cannot_be_exempt(base: Any, name: str) -> None:
    found = {check.name: check for check in checks(exempt(base, name))}
    assert name in found
    with pytest.raises(AssertionError, match=f"`exemptions` names {name}, which must hold for any"):
        found["exemptions_are_claims"]()


def test_checks_are_named_documented_and_frozen() -> None:
    found = list(checks(OF_RATE["WrongSign"]()))
    assert len({check.name for check in found}) == len(found)
    assert all(check.name.isidentifier() and check.doc for check in found)
    with pytest.raises(AttributeError):
        found[0].name = "other"  # type: ignore[misc]


def test_checks_of_something_else_are_an_error() -> None:
    with pytest.raises(wl.InputError, match="needs a rig, a contact model, a stage, a law, a reader or the function"):
        list(checks(3))  # type: ignore[arg-type]


def test_a_rig_without_an_example_is_an_error_that_says_what_to_write(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Weight, "example", {})
    with pytest.raises(wl.InputError, match=r"(?s)'weight'.*class Weight.*example = {\"mass\": ..., "):
        list(checks(Weight()))


class FailsOnEllipses(Cells):
    """Right on a line, and with an error on an ellipse."""

    def solve_ellipse(self, problem: wl.Problem) -> wl.Contact:
        raise ZeroDivisionError("by nothing")


def test_a_failure_names_the_shape_and_the_first_example_that_fails_alone() -> None:
    finite = {check.name: check for check in checks(FailsOnEllipses())}["contact_is_finite"]
    with pytest.raises(AssertionError, match=r"^on an ellipse: the model raised ZeroDivisionError") as failure:
        finite()
    assert "example=Problem(geometry='ellipse'" in "\n".join(failure.value.__notes__)
