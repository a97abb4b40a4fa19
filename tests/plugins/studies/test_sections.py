"""Sections that plugins add to a report: how they are found, asked for and made."""

from __future__ import annotations

import json
import warnings
from typing import Any

import pytest

import wearlaw as wl
from tests.cases import SWEEP, case
from tests.core.distributions import Install
from wearlaw.errors import ModelError

LAB = """
    import warnings

    import wearlaw as wl

    def highest(study):
        rate = float(study.sweep("creepage")["wear_rate"].max())
        verdict = "holds" if rate < 60.0 else "does not hold"
        claim = wl.CheckedClaim("It wears little.", "section 3", f"It reaches {rate:.1f}.", verdict, "Below 60.")
        return wl.Section("Highest", "One paragraph.", claims=(claim,))

    def warned(study):
        warnings.warn("beyond all tests", wl.RangeWarning)
        warnings.warn("beyond all tests", wl.RangeWarning)
        return wl.Section("Warned", f"It has {len(study.pairs)} pairs.")

    def needs_load(study):
        return wl.Section("Loads", str(study.sweep("lod")))

    def raises(study):
        return 1 / 0

    @wl.hookimpl
    def wearlaw_resources():
        return {"section": {"highest": highest, "warned": warned, "needs_load": needs_load, "raises": raises}}
"""


def test_a_study_holds_the_sections_in_the_order_of_the_case(install: Install) -> None:
    install("lab", LAB)
    study = wl.run(case(sections=["warned", "highest"]))
    assert [section.title for section in study.sections] == ["Warned", "Highest"]
    (claim,) = study.sections[1].claims
    rate = float(study.sweeps["creepage"]["wear_rate"].max())
    assert rate > 60.0
    found = f"It reaches {rate:.1f}."
    assert claim == wl.CheckedClaim("It wears little.", "section 3", found, "does not hold", "Below 60.")
    assert study.sections[0].text == "It has 5 pairs."
    assert wl.run(case()).sections == ()


def test_a_claim_has_one_of_four_verdicts() -> None:
    wrong: Any = "fails"
    with pytest.raises(wl.InputError, match="verdict: must be one of"):
        wl.CheckedClaim("It wears little.", "section 3", "It reaches 55.", wrong, "Below 60.")


def test_a_warning_becomes_one_note_of_the_section(install: Install) -> None:
    install("lab", LAB)
    without = wl.run(case()).notes
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert wl.run(case(sections=["warned"])).notes == (*without, "section 'warned': beyond all tests")


def test_what_a_section_cannot_do_names_it_and_its_plugin(install: Install) -> None:
    install("lab", LAB, version="1.2.3")
    with pytest.raises(wl.InputError) as caught:
        wl.run(case(sections=["needs_load"], sweeps={"load": SWEEP}))
    assert str(caught.value) == (
        "section 'needs_load' of lab 1.2.3 (plugin 'lab'): the case has no sweep 'lod';"
        " did you mean 'load'? Add [sweeps.lod]"
        "\nTo run the case without this section, take 'needs_load' out of `sections`"
    )
    assert "Dimensions" in wl.run(case(sections=["needs_load"], sweeps={"lod": SWEEP})).sections[0].text


def test_what_a_section_raises_is_the_plugins_fault_and_kept_as_the_cause(install: Install) -> None:
    install("lab", LAB)
    message = r"section 'raises' of lab 1\.0 .* failed with ZeroDivisionError: division by zero"
    with pytest.raises(ModelError, match=message) as refused:
        wl.run(case(sections=["raises"]))
    assert isinstance(refused.value.__cause__, ZeroDivisionError)


def test_the_provenance_names_where_sections_come_from(install: Install) -> None:
    install("lab", LAB, version="1.2.3")
    asked = case(sections=["warned", "highest"])
    (sweep,) = wl.run(asked).sweeps.values()
    assert json.loads(sweep.attrs["provenance"])["sections"] == {"highest": "lab 1.2.3", "warned": "lab 1.2.3"}
