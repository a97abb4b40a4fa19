"""Sections of reports in the kit: wrong ones are caught, each by its check, and right ones by none."""

from __future__ import annotations

from typing import Any

import pytest

import wearlaw as wl
from tests.cases import case, wearlaw
from tests.core.distributions import Install
from tests.plugins.kit.wrong_sections import CAUGHT, right
from wearlaw import loader  # private: the functions of shipped sections
from wearlaw_kit import Check, checks, conformance

CASE = case(contact_models=["global"], profiles={})


@pytest.mark.validates(
    "invariants",
    "The kit catches wrong sections of reports, each by the right check",
    source="sections that are wrong in one way each",
    held_to="every one is caught",
)
@pytest.mark.parametrize("wrong", CAUGHT)
def test_each_wrong_section_is_caught_by_the_check_that_should(wrong: str) -> None:
    name, make = CAUGHT[wrong]
    check = {check.name: check for check in checks(make, CASE)}[name]
    with pytest.raises(AssertionError) as failure:
        check()
    assert len(str(failure.value)) > 10
    assert ("the model raised" in str(failure.value)) == (wrong == "no colour"), failure.value


def test_every_check_of_a_section_catches_a_wrong_one() -> None:
    assert {check.name for check in checks(right, CASE)} == {name for name, _ in CAUGHT.values()}


@conformance(right, CASE)
def test_a_right_section_passes(check: Check) -> None:
    check()


@pytest.mark.parametrize("name", ["tassini2010_tables", "tassini2010_claims"])
def test_shipped_sections_pass(name: str) -> None:
    for check in checks(loader.discovered().find("section", name), "tassini2010"):
        check()


def test_a_section_without_a_case_is_an_error() -> None:
    with pytest.raises(wl.InputError, match=r'a section is made from the results of a case; give .* case="two_discs"'):
        list(checks(right))


def test_the_command_checks_a_section_on_a_case(install: Install) -> None:
    install(
        "lab",
        """
        import wearlaw as wl

        def empty(study):
            return wl.Section("Empty", "")

        @wl.hookimpl
        def wearlaw_resources():
            return {"section": {"empty": empty}}
        """,
    )
    asked: list[Any] = ["check", "empty", "--only", "section_is_plain_text"]
    result = wearlaw(*asked, "--case", "two_discs")
    assert result.exit_code == 1
    assert "the text is empty" in result.stdout
    refused = wearlaw(*asked)
    assert refused.exit_code == 1
    assert "--case two_discs" in refused.stderr
