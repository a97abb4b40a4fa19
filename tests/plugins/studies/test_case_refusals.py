"""Case files: errors and their messages, from the loader and from the schema."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest

import wearlaw as wl
from tests import cases
from tests.cases import OWN_TESTS, changed, load, table
from wearlaw.errors import CaseError

WRONG: list[tuple[str, Any, str]] = [
    ("title", None, "title"),
    ("titel", "x", "titel"),
    ("rig", "suros", "rig"),
    ("rig", {}, "rig"),
    ("rig", "twin_disk", "rig"),
    ("rig", {"type": "twin_disc"}, "rig.disc_1"),
    ("rig.type", "wheel_rail", "rig.preset"),
    ("rig.preset", "sros", "rig.preset"),
    ("plugins", ["a"], "plugins"),
    ("rig.diametre", "47 mm", "rig.diametre"),
    ("rig.diameter", 47, "rig.diameter"),
    (
        "rig.material",
        {"youngs_modulus": "210 GPa", "poisson_ratio": 0.6, "density": "7.8 g/cm^3"},
        "rig.material.poisson_ratio",
    ),
    ("contact_models", [], "contact_models"),
    ("contact_models", "exact", "contact_models"),
    ("contact_models", ["exat"], "contact_models.0"),
    ("contact_models", ["exact", "usfd"], "contact_models.1"),
    ("contact_models", [{"model": "exact", "slp": "x"}], "contact_models.0.slp"),
    ("contact_models", [{"model": "exact", "slip": "x"}], "contact_models.0.slip"),
    ("wear_laws", None, "wear_laws"),
    ("wear_laws", [{"model": "kth", "coefficient": {"low_speed": 1.0}}], "wear_laws.0.coefficient.mid_speed"),
    ("sweeps", {}, "sweeps"),
    ("sweeps.creepage.creepage.points", 1, "sweeps.creepage.creepage.points"),
    ("sweeps.creepage.frictioncoefficient", 0.4, "sweeps.creepage.frictioncoefficient"),
    ("sweeps.creepage.friction_coefficient", True, "sweeps.creepage.friction_coefficient"),
    ("profiles.partial_slip.creepage", None, "profiles.partial_slip.creepage"),
    ("measured", {"label": "m"}, "measured.tests"),
]
"""What both the loader and the schema refuse."""

WRONG_TO_THE_LOADER: list[tuple[str, Any, str]] = [
    ("rig.diameter", "47 kN", "rig.diameter"),
    ("rig", {"type": ["a"]}, "rig.type"),
    ("rig.preset", {"a": 1}, "rig.preset"),
    ("rig.material", {"type": ["a"]}, "rig.material"),
    ("sweeps.creepage.normal_force", "1 N", "sweeps.creepage"),
    ("sweeps.a b", {"max_pressure": "1500 MPa", "creepage": "0.5 %", "friction_coefficient": 0.46}, "sweeps"),
    ("profiles.partial_slip.creepage", ["1 %"], "profiles.partial_slip"),
]
"""What takes more than a schema to see."""


@pytest.mark.parametrize(("path", "value", "named"), WRONG + WRONG_TO_THE_LOADER)
def test_a_wrong_field_is_named_by_its_path(tmp_path: Path, path: str, value: Any, named: str) -> None:
    with pytest.raises(CaseError) as refusal:
        load(tmp_path, changed(path, value))
    assert str(refusal.value).startswith(f"case '{tmp_path / 'my.toml'}' is wrong in:\n  ")
    assert f"\n  {named}: " in str(refusal.value)


@pytest.mark.parametrize(("path", "value", "named"), WRONG)
def test_the_schema_refuses_what_the_loader_refuses(validator: Any, path: str, value: Any, named: str) -> None:
    assert not validator.is_valid(changed(path, value)), named


def places(content: Any, tmp_path: Path) -> list[str]:
    """Return the paths of the wrong fields of a case, in alphabetical order."""
    with pytest.raises(CaseError) as refusal:
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
        },
        profiles={"six": {**cases.POINT, "creepage": 1}, "seven": {**cases.POINT, "creepage": ["1 %"]}},
        uncertainty={"eight": {**cases.POINT, "friction_coefficient": {"normal": [0.4, -1]}}},
    )
    assert places(content, tmp_path) == [
        "profiles.seven",
        "profiles.six.creepage",
        "sweeps.four.max_pressure",
        "sweeps.one.max_pressure",
        "sweeps.two.angle",
        "sweeps.two.friction",
        "uncertainty.eight.friction_coefficient",
    ]


def test_tests_that_are_missing_or_wrong_are_refused_with_the_case(tmp_path: Path) -> None:
    path = tmp_path / "own.csv"
    content = table(measured={"label": "m", "tests": "own.csv"})
    assert places(content, tmp_path) == ["measured"]
    path.write_text(OWN_TESTS.replace("7.4,NA", "-1,NA"), encoding="utf-8")
    with pytest.raises(CaseError, match="line 3, column 'normal_force"):
        load(tmp_path, content)


@pytest.mark.parametrize("content", [b'title = "no end', b"\xff\xfe\x00", b'title = "\xb5"', b"", b"#" * (2**20 + 1)])
def test_a_file_that_is_no_case_is_refused(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "wrong.toml"
    path.write_bytes(content)
    with pytest.raises(CaseError, match=re.escape(str(path))):
        wl.load_case(str(path))
