"""Case files: errors and their messages, from the loader and from the schema."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import wearlaw as wl
from tests.core import cases
from tests.core.cases import OWN_TESTS, STEEL, changed, load, table
from wearlaw_studies.case import load_case

WRONG: list[tuple[str, Any, str]] = [
    ("title", None, "title: is missing"),
    ("title", 1, "title: input should be a valid string, got 1"),
    ("titel", "x", "titel: unknown field; did you mean 'title'?"),
    ("rig", None, "rig: is missing"),
    ("rig", "suros", "rig: 'suros' is a preset; write {preset = \"suros\"}"),
    (
        "rig",
        "twin_disk",
        "rig: no rig is called 'twin_disk'; did you mean 'twin_disc'? Installed: twin_disc, wheel_rail",
    ),
    ("rig", 1, "rig: must be a rig, its name, or a table of its name and fields; got 1"),
    (
        "rig",
        {},
        'rig: needs a type, such as type = "twin_disc". Installed: twin_disc, wheel_rail, wheelset; or a preset: suros',
    ),
    ("rig", {"wheel_radius": "460 mm"}, 'rig: needs a type, such as type = "wheel_rail". Installed: '),
    ("rig", {"type": "twin_disc"}, "rig.disc_1: is missing"),
    ("rig.type", "twin_disk", "rig.type: no rig is called 'twin_disk'; did you mean 'twin_disc'?"),
    ("rig.type", 1, "rig.type: must be a name, got 1"),
    ("rig.type", "wheel_rail", "rig.preset: rig 'wheel_rail' has no preset 'suros'. There are: none"),
    ("rig.preset", "sros", "rig.preset: no rig has a preset 'sros'; did you mean 'suros'? There are: suros"),
    ("rig.preset", 1, "rig.preset: must be a name, got 1"),
    ("rig.diametre", "47 mm", "rig.diametre: unknown field; did you mean 'diameter'?"),
    ("rig.diameter", 47, "rig.diameter: got the bare number 47, which has no unit; give it in mm"),
    ("rig.material", {**STEEL, "poisson_ratio": 0.6}, "rig.material.poisson_ratio: input should be less than or equal"),
    ("rig.material", {"youngs_modulus": "1 GPa", "poisson_ratio": 0.3}, "rig.material.density: is missing"),
    ("rig.disc_1", {"diameter": "47 mm", "material": {**STEEL, "E": 1}}, "rig.disc_1.material.E: unknown field"),
    ("contact_models", None, "contact_models: is missing"),
    ("contact_models", [], "contact_models: must be a list of names, or of tables with a name and options; got []"),
    ("contact_models", "exact", "contact_models: must be a list of names, or of tables"),
    ("contact_models", ["exat"], "contact_models.0: no contact model is called 'exat'; did you mean 'exact'?"),
    ("contact_models", ["exact", "usfd"], "contact_models.1: no contact model is called 'usfd'"),
    ("contact_models", [{"slip": "consistent"}], 'contact_models.0: a model needs its name, as in {model = "exact"}'),
    ("contact_models", [{"model": "exact", "slp": "x"}], "contact_models.0.slp: unknown field; did you mean 'slip'?"),
    ("contact_models", [{"model": "exact", "slip": "x"}], "contact_models.0.slip: input should be 'consistent' or"),
    ("contact_models", [3], "contact_models.0: input should be a valid dictionary or instance of ContactModel, got 3"),
    ("wear_laws", [], 'wear_laws: is missing or empty; give at least one, as in wear_laws = ["usfd"]'),
    ("wear_laws", None, "wear_laws: is missing or empty"),
    ("wear_laws", ["brr", "usdf"], "wear_laws.1: no wear law is called 'usdf'; did you mean 'usfd'?"),
    ("wear_laws", [{"model": "kth", "coefficient": {"low_speed": 1.0}}], "wear_laws.0.coefficient.mid_speed: is miss"),
    ("wear_laws", [{"model": "usfd", "m_m": 5.3}], "wear_laws.0.m_m: got the bare number 5.3, which has no unit"),
    ("sweeps", None, "sweeps: is missing"),
    ("sweeps", {}, "sweeps: dictionary should have at least 1 item"),
    ("sweeps.creepage", 1, "sweeps.creepage: input should be a valid dictionary"),
    ("sweeps.creepage.creepage.points", 1, "sweeps.creepage.creepage.points: input should be greater than or equal"),
    ("sweeps.creepage.creepage.step", 1, "sweeps.creepage.creepage.step: unknown field"),
    (
        "sweeps.creepage.frictioncoefficient",
        0.4,
        "sweeps.creepage.frictioncoefficient: unknown condition; did you mean 'friction_coefficient'?",
    ),
    ("sweeps.creepage.friction_coefficient", True, "sweeps.creepage.friction_coefficient: must be a value"),
    ("profiles.partial_slip.creepage", None, "profiles.partial_slip.creepage: is missing"),
    ("measured", {"label": "m"}, "measured.tests: is missing"),
    ("measured", {"tests": "lewis2004"}, "measured.label: is missing"),
    ("measured", {"label": "m", "tests": 1}, "measured.tests: input should be a valid string, got 1"),
    ("measured", {"label": "m", "tests": "lewis2004", "source": "s"}, "measured.source: unknown field"),
]
"""What both the loader and the schema refuse."""

WRONG_TO_THE_LOADER: list[tuple[str, Any, str]] = [
    ("rig.diameter", "47 kN", "rig.diameter: got 47.00 kN, which does not have the dimension of 'mm'"),
    ("rig.diameter", "-1 mm", "rig.diameter: must be greater than zero, got -1.000 mm"),
    ("rig.diameter", "47 foo", "rig.diameter: 'foo' is not a known unit"),
    ("sweeps.creepage.max_pressure", "1 kN", "sweeps.creepage.max_pressure: got 1.000 kN, which does not have the dim"),
    ("sweeps.creepage.creepage", 1, "sweeps.creepage.creepage: got the bare number 1.0, which has no unit"),
    ("sweeps.creepage.normal_force", "1 N", "sweeps.creepage: give exactly one of normal_force, normal_force_per"),
    ("sweeps.a b", cases.POINT, "sweeps: the name 'a b' must be made of letters, digits and underscores"),
    ("sweeps." + "é" * 51, cases.POINT, f"sweeps: the name '{'é' * 51}' has 102 bytes, but 100 are the most"),
    ("profiles.a/b", cases.POINT, "profiles: the name 'a/b' must be made of letters, digits and underscores"),
    (
        "profiles.partial_slip.creepage",
        ["1 %"],
        "profiles.partial_slip: a profile is at one operating point; give each condition one value",
    ),
]
"""What takes more than a schema to see."""


@pytest.mark.parametrize(("path", "value", "message"), WRONG + WRONG_TO_THE_LOADER)
def test_a_wrong_field_is_named_by_its_path(tmp_path: Path, path: str, value: Any, message: str) -> None:
    with pytest.raises(wl.CaseError) as refusal:
        load(tmp_path, changed(path, value))
    assert str(refusal.value).startswith(f"case '{tmp_path / 'my.toml'}' is wrong in:\n  ")
    assert f"\n  {message}" in str(refusal.value)


@pytest.mark.parametrize(("path", "value", "message"), WRONG)
def test_the_schema_refuses_what_the_loader_refuses(validator: Any, path: str, value: Any, message: str) -> None:
    assert not validator.is_valid(changed(path, value)), message


def places(content: Any, tmp_path: Path) -> list[str]:
    """Return the paths of the wrong fields of a case, in alphabetical order."""
    with pytest.raises(wl.CaseError) as refusal:
        load(tmp_path, content)
    return sorted(line.strip().split(":")[0] for line in str(refusal.value).splitlines()[1:])


def test_the_first_condition_that_the_rig_refuses_is_named_in_every_sweep_profile_and_uncertain_point(
    tmp_path: Path,
) -> None:
    content = table(
        sweeps={
            "one": {**cases.POINT, "max_pressure": "1500 N"},
            "two": {**cases.POINT, "angle": "1 deg", "friction": 0.3},
            "four": {**cases.POINT, "max_pressure": ["1 GPa", "-1 GPa"]},
            "fi ve": cases.POINT,
        },
        profiles={"six": {**cases.POINT, "creepage": 1}, "seven": {**cases.POINT, "creepage": ["1 %"]}},
        uncertainty={"eight": {**cases.POINT, "friction_coefficient": {"normal": [0.4, -1]}}},
    )
    assert places(content, tmp_path) == [
        "profiles.seven",
        "profiles.six.creepage",
        "sweeps",
        "sweeps.four.max_pressure",
        "sweeps.one.max_pressure",
        "sweeps.two.angle",
        "sweeps.two.friction",
        "uncertainty.eight.friction_coefficient",
    ]


def test_tests_that_are_missing_or_wrong_are_refused_with_the_case(tmp_path: Path) -> None:
    path = tmp_path / "own.csv"
    content = table(measured={"label": "m", "tests": "own.csv"})
    with pytest.raises(
        wl.CaseError, match=r"is wrong in:\n  measured: there is no file '.*own.csv'. Shipped tests: lew"
    ):
        load(tmp_path, content)
    path.write_text(OWN_TESTS.replace("7.4,NA", "-1,NA"), encoding="utf-8")
    with pytest.raises(wl.CaseError) as refusal:
        load(tmp_path, content)
    message = str(refusal.value)
    assert f"  measured: the tests '{path}' are wrong in:" in message
    assert "line 3, column 'normal_force [kN]': got -1, which must be greater than zero" in message


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b'title = "no end', "is not valid TOML: "),
        (b"\xff\xfe\x00", "cannot read the case file .*: it is not text in UTF-8; save it in UTF-8"),
        (b'title = "\xb5"', "cannot read the case file .*: it is not text in UTF-8; save it in UTF-8"),
        (b"title,rig\n1,2\n", "is not valid TOML: "),
        (b"", "is wrong in:\n  title: is missing"),
        (b"#" * (2**20 + 1), "cannot read the case file .*: it has more than 1 MiB, the most that is read; is it the"),
    ],
)
def test_a_file_that_is_no_case_is_refused(tmp_path: Path, content: bytes, message: str) -> None:
    path = tmp_path / "wrong.toml"
    path.write_bytes(content)
    with pytest.raises(wl.CaseError, match=message) as refusal:
        load_case(str(path))
    assert str(path) in str(refusal.value)
