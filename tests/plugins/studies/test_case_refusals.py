"""Case files: errors and their messages, from the loader and from the schema."""

from __future__ import annotations

import re
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


def test_every_wrong_field_is_named_once(tmp_path: Path) -> None:
    content = changed("rig.diameter", 47, changed("contact_models", ["exat"], changed("wear_laws", ["usfd", "kht"])))
    with pytest.raises(wl.CaseError) as refusal:
        load(tmp_path, content)
    where = [line.strip().split(":")[0] for line in str(refusal.value).splitlines()[1:]]
    assert sorted(where) == ["contact_models.0", "rig.diameter", "wear_laws.1"]


def places(content: Any, tmp_path: Path) -> list[str]:
    """Return the paths of the wrong fields of a case, in alphabetical order."""
    with pytest.raises(wl.CaseError) as refusal:
        load(tmp_path, content)
    return sorted(line.strip().split(":")[0] for line in str(refusal.value).splitlines()[1:])


def test_conditions_that_cannot_be_read_are_named_in_every_sweep(tmp_path: Path) -> None:
    content = table(
        sweeps={
            "two": {**cases.POINT, "creepage": {"from": "1 %", "to": "2 %", "points": 1}, "friction_coefficient": True},
            "three": {**cases.POINT, "creepage": ["1 %", 2]},
        },
        uncertainty={"eight": {**cases.POINT, "creepage": {"normal": [1]}}},
        sections=["nope"],
    )
    assert places(content, tmp_path) == [
        "sections.0",
        "sweeps.three.creepage",
        "sweeps.two.creepage.points",
        "sweeps.two.friction_coefficient",
        "uncertainty.eight.creepage.normal.1",
    ]


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


def test_a_wrong_condition_lays_no_blame_on_the_others(tmp_path: Path) -> None:
    """Without the wrong load, none is left, and without the misspelt friction none is given."""
    loads = {"creepage": "1 %", "max_presure": "1 GPa", "friction_coefficient": 0.4}
    assert places(table(sweeps={"one": loads}), tmp_path) == ["sweeps.one.max_presure"]
    assert places(table(sweeps={"one": {**cases.POINT, "max_pressure": "1 N"}}), tmp_path) == [
        "sweeps.one.max_pressure"
    ]


def test_what_does_not_fit_together_is_named_in_every_place(tmp_path: Path) -> None:
    content = table(
        uncertainty={
            "one": {**cases.POINT, "laws": {"usdf": {"q_s": {"normal": [1, 2]}}, "kth": {"hard": {"normal": [1, 2]}}}}
        },
        figures={"a": {"sweep": "nope", "x": "creepage", "y": "wear_rate"}},
    )
    assert places(content, tmp_path) == [
        "figures.a.sweep",
        "uncertainty.one.laws.kth.hard",
        "uncertainty.one.laws.usdf",
    ]


WHEEL_RAIL = {"type": "wheel_rail", "wheel_radius": "460 mm", "rail_head_radius": "300 mm", "material": "steel"}


@pytest.mark.parametrize(
    ("path", "value", "advice"),
    [
        ("sweeps.creepage.creepage", 1, 'such as "1 %"'),
        ("sweeps.creepage.max_pressure", [1, 2], 'such as "1.0 MPa"'),
        ("rig.track_width", 10, 'such as "1.0 mm"'),
        ("wear_laws", [{"model": "usfd", "q_s": 3}], 'such as "1.0 ug/m/mm^2"'),
        (
            "rig",
            {**WHEEL_RAIL, "rolling_speed": "1 m/s", "wheel_profile_radius": "0 mm"},
            'a flat body has the radius "inf mm"',
        ),
        ("rig", {**WHEEL_RAIL, "rolling_speed": "1 m/s", "contact_angle": "95 deg"}, 'such as "70 deg" on a flange'),
        ("uncertainty", {"one": {**cases.POINT, "creepage": {"normal": [1, 2]}}}, 'such as "1 %"'),
        (
            "uncertainty",
            {"one": {**cases.POINT, "laws": {"usfd": {"q_s": {"normal": [1, 2]}}}}},
            'such as "1.0 µg/m/mm**2"',
        ),
    ],
)
def test_advice_in_errors_of_a_case_is_toml_and_not_python(tmp_path: Path, path: str, value: Any, advice: str) -> None:
    with pytest.raises(wl.CaseError) as refusal:
        load(tmp_path, changed(path, value))
    assert advice in str(refusal.value)
    assert not re.search(r"\bQ\(|\bwl\.|\bnp\.", str(refusal.value))


def test_every_missing_plugin_is_named(tmp_path: Path) -> None:
    needed = {"wearlaw-one": ">=1", "wearlaw-two": "", "wearlaw": ">=99"}
    expected = ["plugins.wearlaw", "plugins.wearlaw-one", "plugins.wearlaw-two"]
    assert places(table(plugins=needed), tmp_path) == expected


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
    assert "line 3, column 'normal_force [kN]'" in message


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


def test_a_missing_file_is_refused_with_the_shipped_case_that_may_be_meant(tmp_path: Path) -> None:
    with pytest.raises(wl.CaseError, match=r"there is no case file 'tasini2010'; did you mean 'tassini2010'\?"):
        load_case("tasini2010")
    with pytest.raises(wl.CaseError, match=r"there is no case file '.*x.toml'. Shipped cases: tassini2010"):
        load_case(str(tmp_path / "x.toml"))


def test_a_folder_is_no_case_file(tmp_path: Path) -> None:
    with pytest.raises(wl.CaseError, match=f"cannot read the case file '{tmp_path}'"):
        load_case(str(tmp_path))
