"""Parameter sets, materials and cases that plugins provide by name."""

from __future__ import annotations

import json
import pickle
import tomllib
from pathlib import Path
from typing import Any

import jsonschema  # type: ignore[import-untyped]
import pytest

import wearlaw as wl
from tests.cases import case, table, wearlaw
from tests.core.distributions import LAB, Install
from wearlaw import loader  # private: plugins of a test are found as if they were installed
from wearlaw.errors import PluginWarning
from wearlaw_apps.studies.case import (  # private: a case without its files
    Case,
    case_schema,
    case_text,
    load_case,
    written,
)
from wearlaw_apps.studies.study import provenance, run  # private: a case run without its files

POINT: Any = {"max_pressure": "1500 MPa", "creepage": "1 %", "friction_coefficient": 0.46}
RIG = wl.TwinDisc.suros()


def test_a_parameter_set_is_looked_up_like_a_law_and_takes_options(install: Install) -> None:
    install("lab", LAB)
    law = wl.wear_law("lab_2026")
    assert law == wl.installed("parameter set")["lab_2026"]
    assert law.name == "usfd"
    assert wl.wear_law("lab_2026", m_c=wl.Q(75, "ug/m/N")) == law.model_copy(update={"m_c": "75 ug/m/N"}) != law
    with pytest.raises(wl.ConfigurationError, match="usfd: mc: unknown field; did you mean 'm_c'"):
        wl.wear_law("lab_2026", mc="75 ug/m/N")


def test_a_parameter_set_says_what_it_was_fitted_for_and_its_range(
    install: Install,
    recwarn: pytest.WarningsRecorder,
) -> None:
    install("lab", LAB)
    law = wl.wear_law("lab_2026")
    predict = RIG | wl.contact_model("exact") | law
    predict(**POINT)
    assert {one.category for one in recwarn.list} <= {wl.PlasticityWarning}
    with pytest.warns(wl.CalibrationWarning, match=r"fitted for the cells of contact_model\('exact'\)"):
        RIG | wl.contact_model("global") | law
    assert law.valid_range == {"wear_index_density": (0.0, 40e6)}
    with pytest.warns(wl.RangeWarning, match=r"from 0 N/mm² to 40.00 N/mm²"):
        predict(**{**POINT, "creepage": "10 %"})


def test_case_files_name_parameter_sets_and_materials(install: Install) -> None:
    install("lab", LAB)
    rig = {"preset": "suros", "material": "soft_steel"}
    changes: Any = {"rig": rig, "contact_models": ["exact"], "wear_laws": ["lab_2026"]}
    read = case(**changes)
    assert read.wear_laws == (wl.wear_law("lab_2026"),)
    assert read.rig == wl.TwinDisc.suros(material=wl.material("soft_steel"))
    validator = jsonschema.Draft202012Validator(case_schema())
    assert validator.is_valid(table(**changes))
    assert validator.is_valid(table(**{**changes, "wear_laws": [{"model": "lab_2026", "m_c": "75 ug/m/N"}]}))
    assert not validator.is_valid(table(**{**changes, "wear_laws": ["lab_2027"]}))


LAB_STUDY = """
    title = "A study of the lab"
    contact_models = ["exact"]
    wear_laws = [{ model = "lab_2026", m_c = "75 ug/m/N" }, "kth"]

    [rig]
    preset = "suros"
    material = "soft_steel"

    [sweeps.one]
    max_pressure = "1500 MPa"
    creepage = "1 %"
    friction_coefficient = 0.46
"""


def test_the_provenance_names_where_a_set_a_material_and_a_case_come_from(install: Install, tmp_path: Path) -> None:
    install("lab", LAB.replace("\"title = 'A study of the lab'\"", repr(LAB_STUDY)), version="1.2.3")
    loaded = load_case("lab_study")
    assert loaded == Case(**tomllib.loads(case_text("lab_study")))
    for ran in (loaded, pickle.loads(pickle.dumps(loaded))):
        said = provenance(ran)
        assert said["parameter_sets"] == {"lab_2026": "lab 1.2.3"}
        assert said["materials"] == {"soft_steel": "lab 1.2.3"}
        assert said["cases"] == {"lab_study": "lab 1.2.3"}
        assert said["wear_laws"] == {"kth": f"wearlaw {wl.__version__}", "usfd": f"wearlaw {wl.__version__}"}
    for name, text in written(loaded).items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    again = load_case(str(tmp_path / "case.toml"))
    assert again == loaded
    assert provenance(again) == {**said, "cases": {}}
    (sweep,) = run(loaded).sweeps.values()
    assert json.loads(sweep.attrs["provenance"]) == provenance(loaded)


@pytest.mark.parametrize(
    ("old", "new", "cause"),
    [
        ("wl.steel(youngs_modulus=", "dict(youngs_modulus=", "material 'soft_steel' must be a Material or a class"),
        ('"lab_tests"', '"lab-tests"', "the name of a test set must be an identifier, got 'lab-tests'"),
    ],
)
def test_what_is_not_of_its_kind_is_left_out_with_the_reason(
    install: Install,
    old: str,
    new: str,
    cause: str,
) -> None:
    assert old in LAB
    install("lab", LAB.replace(old, new))
    with pytest.warns(PluginWarning, match="left out: lab 1.0"):
        found = loader.discovered()
    assert cause in found.broken[0].cause


def test_a_parameter_set_is_explained_with_its_numbers(install: Install) -> None:
    install("lab", LAB, version="1.2.3")
    shown = wearlaw("show", "lab_2026").stdout
    assert shown.startswith(
        "lab_2026: a parameter set of lab 1.2.3 (plugin 'lab'), for\n"
        f"usfd: a wear law of wearlaw {wl.__version__} (plugin 'usfd')\n"
    )
    assert "\n  q_s = 60.0 µg/m/mm²\n" in shown
    assert "fitted for: the cells of contact_model('exact'); two steels of a test; made up for a test" in shown
    assert "known range of mean wear_index_density from 0 N/mm² to 40.00 N/mm²" in shown


def test_a_parameter_set_is_checked_like_a_law(install: Install, monkeypatch: pytest.MonkeyPatch) -> None:
    install("lab", LAB)
    checked: list[Any] = []

    def checks(model: Any) -> list[Any]:
        checked.append(model)
        return []

    monkeypatch.setattr("wearlaw_kit.commands.checks", checks)  # private: batches of patches
    assert wearlaw("check", "lab_2026").stdout == "0 ok, 0 failed, 0 not claimed\n"
    wearlaw("check", "lab_2026", "--option", "m_c=75 ug/m/N")
    assert checked == [wl.wear_law("lab_2026"), wl.wear_law("lab_2026", m_c="75 ug/m/N")]
    refused = wearlaw("check", "lab_2025")
    assert "no model is called 'lab_2025'; did you mean 'lab_2026'?" in refused.stderr


def test_a_parameter_set_with_the_name_of_a_law_is_left_out_by_name(install: Install) -> None:
    install("lab", LAB.replace('"lab_2026"', '"kth"'))
    with pytest.warns(PluginWarning) as caught:
        assert wl.wear_law("kth").name == "kth"
    assert [str(one.message) for one in caught] == [
        "left out: lab 1.0 (plugin 'lab'): parameter set 'kth' has the name of a wear law of"
        f" wearlaw {wl.__version__} (plugin 'kth'); give it another name"
    ]
    assert "kth" not in wl.installed("parameter set")
    assert wl.material("soft_steel").density == wl.Q(7800, "kg/m^3")
