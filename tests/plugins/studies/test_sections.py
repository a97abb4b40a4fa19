"""Sections that plugins add to a report: how they are found, asked for and made."""

from __future__ import annotations

import json
import warnings
from pathlib import Path
from typing import Any

import jsonschema  # type: ignore[import-untyped]
import pytest

import wearlaw as wl
from tests.core.cases import SWEEP, assert_refused, case, table, wearlaw, write
from tests.core.distributions import FIRST_PARTY_LAWS, Install
from wearlaw.plugins import loader
from wearlaw_studies.case import Case, case_schema
from wearlaw_studies.study import provenance, run, used

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

    def in_millionths(study):
        for dataset in (*study.sweeps.values(), *study.profiles.values()):
            for values in dataset.data_vars.values():
                values *= 1e-6
            dataset["made_up"] = 0.0
        study.sweeps.clear()
        return wl.Section("In millionths", "")

    def needs_load(study):
        return wl.Section("Loads", str(study.sweep("lod")))

    def wrong(study):
        return "Highest"

    def raises(study):
        return 1 / 0

    @wl.hookimpl
    def wearlaw_resources():
        sections = {
            "highest": highest, "warned": warned, "needs_load": needs_load, "wrong": wrong, "raises": raises,
            "in_millionths": in_millionths,
        }
        return {"section": sections}
"""

UNKIND = """
    import wearlaw as wl

    def exits(study):
        raise SystemExit(0)

    class Mute(Exception):
        def __str__(self):
            raise SystemExit(0)

    def mute(study):
        raise Mute

    class MuteError(Mute, wl.WearlawError):
        pass

    def refuses(study):
        raise MuteError

    class Unshown:
        def __repr__(self):
            raise SystemExit(0)

    def unshown(study):
        return Unshown()

    @wl.hookimpl
    def wearlaw_resources():
        return {"section": {"exits": exits, "mute": mute, "refuses": refuses, "unshown": unshown}}
"""

OURS = ["life", "tassini2010_claims", "tassini2010_table_4", "tassini2010_tables", "wheelset"]


def test_the_sections_of_the_study_come_from_a_plugin_like_any_other() -> None:
    assert list(loader.installed().resources["section"].items()) == OURS
    assert ("section", OURS[0], loader.installed().resources["section"].origin(OURS[0])) in loader.installed().listing()
    printed = wearlaw("plugins").stdout.splitlines()
    assert [line.split()[1] for line in printed if line.startswith("section ")] == OURS


def test_a_study_holds_the_sections_in_the_order_of_the_case(install: Install) -> None:
    install("lab", LAB)
    study = run(case(sections=["warned", "highest"]))
    assert [section.title for section in study.sections] == ["Warned", "Highest"]
    (claim,) = study.sections[1].claims
    rate = float(study.sweeps["creepage"]["wear_rate"].max())
    assert rate > 60.0
    found = f"It reaches {rate:.1f}."
    assert claim == wl.CheckedClaim("It wears little.", "section 3", found, "does not hold", "Below 60.")
    assert study.sections[0].text == "It has 5 pairs."
    assert run(case()).sections == ()


@pytest.mark.parametrize("verdict", [True, "fails", "Holds"])
def test_a_claim_has_one_of_four_verdicts(verdict: Any) -> None:
    message = "verdict: must be one of 'holds', 'holds in part', 'does not hold', 'cannot be decided', got "
    with pytest.raises(wl.InputError, match=f"{message}{verdict!r}"):
        wl.CheckedClaim("It wears little.", "section 3", "It reaches 55.", verdict, "Below 60.")


def test_a_section_that_changes_its_tables_changes_no_others(install: Install) -> None:
    install("lab", LAB)
    study, without = run(case(sections=["in_millionths", "highest"])), run(case())
    for kept, expected in ((study.sweeps, without.sweeps), (study.profiles, without.profiles)):
        assert [*kept] == [*expected]
        assert all(kept[name].equals(expected[name]) for name in kept)
    assert study.sections[1].claims[0].verdict == "does not hold"


def test_a_warning_becomes_one_note_of_the_section(install: Install) -> None:
    install("lab", LAB)
    without = run(case()).notes
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert run(case(sections=["warned"])).notes == (*without, "section 'warned': beyond all tests")


def test_what_a_section_cannot_do_names_it_and_its_plugin(install: Install) -> None:
    install("lab", LAB, version="1.2.3")
    with pytest.raises(wl.InputError) as caught:
        run(case(sections=["needs_load"], sweeps={"load": SWEEP}))
    assert str(caught.value) == (
        "section 'needs_load' of lab 1.2.3 (plugin 'lab'): the case has no sweep 'lod';"
        " did you mean 'load'? Add [sweeps.lod]"
        "\nTo run the case without this section, take 'needs_load' out of `sections`"
    )
    assert "Dimensions" in run(case(sections=["needs_load"], sweeps={"lod": SWEEP})).sections[0].text


def test_what_is_no_section_is_the_plugins_fault(install: Install) -> None:
    install("lab", LAB)
    with pytest.raises(wl.ModelError, match=r"section 'wrong' of lab 1\.0 .* must be a Section, got 'Highest'"):
        run(case(sections=["wrong"]))


def test_what_a_section_raises_is_the_plugins_fault_and_kept_as_the_cause(install: Install) -> None:
    install("lab", LAB)
    message = r"section 'raises' of lab 1\.0 .* failed with ZeroDivisionError: division by zero"
    with pytest.raises(wl.ModelError, match=message) as refused:
        run(case(sections=["raises"]))
    assert isinstance(refused.value.__cause__, ZeroDivisionError)


@pytest.mark.parametrize(
    ("name", "error", "reason"),
    [
        ("exits", wl.ModelError, " failed with SystemExit: 0"),
        ("mute", wl.ModelError, " failed with Mute: (its message cannot be shown: SystemExit)"),
        ("refuses", wl.InputError, ": (its message cannot be shown: SystemExit)"),
        ("unshown", wl.ModelError, " failed with SystemExit: 0"),
    ],
)
def test_a_section_that_ends_the_program_or_cannot_say_why_it_fails_is_named(
    install: Install, name: str, error: type[Exception], reason: str
) -> None:
    install("unkind", UNKIND)
    with pytest.raises(error) as refused:
        run(case(sections=[name]))
    assert str(refused.value).startswith(f"section '{name}' of unkind 1.0 (plugin 'unkind'){reason}")


def test_the_command_line_ends_with_the_message_and_leaves_no_folder(
    install: Install,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    install("lab", LAB)
    monkeypatch.chdir(tmp_path)
    write(tmp_path / "own.toml", table(sections=["needs_load"]))
    assert_refused(wearlaw("run", "own.toml"), "section 'needs_load' of lab 1.0 (plugin 'lab'): the case has no sweep")
    assert not (tmp_path / "own-results").exists()


@pytest.mark.parametrize(
    ("sections", "message"),
    [
        (
            ["highest", "higest"],
            "sections.1: no section is called 'higest'; did you mean 'highest'? Installed: highest, ",
        ),
        (["highest", "highest"], "sections: 'highest' is listed twice; leave one out"),
        ([3], "sections.0: input should be a valid string, got 3"),
        ("highest", "sections: input should be a valid tuple, got 'highest'"),
    ],
)
def test_wrong_sections_are_named_when_the_case_is_read(
    install: Install,
    sections: Any,
    message: str,
) -> None:
    install("lab", LAB)
    with pytest.raises(wl.ConfigurationError) as error:
        case(sections=sections)
    assert message in str(error.value)


def test_two_sections_of_one_name_are_refused_with_both_plugins(install: Install) -> None:
    install("lab", LAB)
    install("other", LAB)
    with pytest.raises(
        wl.ConfigurationError, match=r"'highest' is provided more than once, by lab 1\.0 .* and other 1"
    ):
        case(sections=["highest"])


@pytest.mark.parametrize(
    ("hook", "cause"),
    [
        ("return {'section': {'of_lab': 3}}", "TypeError: section 'of_lab' must be a Callable, got 3"),
        (
            "return {'section': {'of lab': print}}",
            "TypeError: the name of a section must be an identifier, got 'of lab'",
        ),
        ("return {'sections': {'of_lab': print}}", "there is no kind 'sections'; did you mean 'section'?"),
        ("raise KeyError('lost')", "KeyError: 'lost'"),
    ],
)
def test_a_plugin_whose_hook_is_wrong_is_left_out_and_the_others_work(
    install: Install,
    hook: str,
    cause: str,
) -> None:
    install("lab", LAB)
    install("broken", f"import wearlaw as wl\n@wl.hookimpl\ndef wearlaw_resources():\n    {hook}\n")
    with pytest.warns(wl.PluginWarning, match="left out: broken 1.0"):
        found = loader.installed()
    assert cause in found.broken[0].cause
    assert {"highest", "warned", *OURS} <= set(found.resources["section"].items())
    assert set(wl.wear_laws()) == FIRST_PARTY_LAWS


def test_the_provenance_names_where_sections_come_from(install: Install) -> None:
    install("lab", LAB, version="1.2.3")
    asked = case(sections=["warned", "highest"])
    assert used(asked)["section"] == {"highest": "lab 1.2.3", "warned": "lab 1.2.3"}
    assert list(used(asked)["section"]) == ["highest", "warned"]
    assert provenance(asked)["sections"] == used(asked)["section"]
    (sweep,) = run(asked).sweeps.values()
    assert json.loads(sweep.attrs["provenance"])["sections"] == used(asked)["section"]


def test_sections_survive_json_and_are_in_the_schema(install: Install) -> None:
    install("lab", LAB)
    asked = case(sections=["warned", "highest"])
    assert Case.model_validate_json(asked.model_dump_json(by_alias=True)) == asked
    validator = jsonschema.Draft202012Validator(case_schema())
    assert validator.is_valid(table(sections=["warned", "highest"]))
    assert not validator.is_valid(table(sections=["higest"]))
