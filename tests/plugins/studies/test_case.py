"""Case files: what is read and what is refused, by the loader and by the schema that says the same."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tomli_w

import wearlaw as wl
from tests import cases
from tests.cases import OWN_TESTS, STEEL, SWEEP, case, changed, load, table
from wearlaw.errors import CaseError
from wearlaw_apps.output.labels import labels  # private: the names of models in results, without running them
from wearlaw_apps.studies import Case
from wearlaw_apps.studies.case import written  # private: a case without its files


def rewritten(read: Case) -> str:
    return tomli_w.dumps(read.model_dump(mode="json", by_alias=True, exclude_none=True))


# Measured tests


def test_tests_of_a_lab_are_found_from_the_folder_of_the_case_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    studies = tmp_path / "studies"
    (studies / "data").mkdir(parents=True)
    (studies / "data" / "own.csv").write_text(OWN_TESTS, encoding="utf-8")
    cases.write(studies / "my.toml", table(measured={"label": "m", "tests": "data/own.csv"}))
    monkeypatch.chdir(tmp_path)
    for where in ("studies/my.toml", str(studies / "my.toml")):
        measured = wl.load_case(where).measured
        assert measured is not None
        np.testing.assert_allclose(measured.data.wear_rate.to("ug/m/mm^2").magnitude, [10.0, 40.0], rtol=1e-14)
        assert measured.data.source == "own.csv"
        assert not measured.shipped


def test_long_lists_of_a_written_case_stand_on_full_lines_and_are_the_same(tmp_path: Path) -> None:
    loads = [1.0 / 3.0 * number for number in range(1, 400)]
    read = load(tmp_path, table(sweeps={"c": {**SWEEP, "friction_coefficient": loads}}))
    (tmp_path / "again.toml").write_text(written(read)["case.toml"], encoding="utf-8")
    lines = written(read)["case.toml"].splitlines()
    assert len(lines) < 150
    assert max(map(len, lines)) <= 120
    assert wl.load_case(str(tmp_path / "again.toml")) == read


def test_a_case_can_be_written_with_its_tests_to_run_again_anywhere(tmp_path: Path) -> None:
    text = "# source: a test in µg\r\n" + OWN_TESTS.replace(",", ";").replace(".", ",")
    (tmp_path / "own.csv").write_text(text, encoding="utf-8", newline="")
    read = load(tmp_path, table(measured={"label": "m", "tests": "own.csv", "decimal": ","}))
    (tmp_path / "own.csv").unlink()  # what is written is what was read
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    files = written(read)
    assert list(files) == ["case.toml", "tests.csv"]
    for name, content in files.items():
        (elsewhere / name).write_text(content, encoding="utf-8")
    again = wl.load_case(str(elsewhere / "case.toml"))
    assert read.measured is not None
    assert again.measured is not None
    assert again.measured.data.to_dataframe().equals(read.measured.data.to_dataframe())
    assert again.measured.data.source == "a test in µg"
    assert again.model_copy(update={"measured": None}) == read.model_copy(update={"measured": None})


# What is read is written and read again

RAIL = {**STEEL, "shear_yield_stress": "300 MPa"}
OWN_K = {"high_pressure": 0.03, "low_speed": 1e-4, "mid_speed": 1e-3, "high_speed": 2e-4}
OWN_RIG: dict[str, Any] = {
    "type": "twin_disc",
    "disc_1": {"diameter": "47 mm", "material": STEEL},
    "disc_2": {"diameter": "inf mm", "material": RAIL},
    "track_width": "1 cm",
    "rolling_speed": "3.6 km/hr",
}
ACCEPTED = {
    "small": table(),
    "own rig": table(rig=OWN_RIG),
    "preset, overridden": table(
        rig={
            "preset": "suros",
            "diameter": "100 mm",
            "material": STEEL,
            "track_width": "5 mm",
            "rolling_speed": "1 m/s",
        }
    ),
    "rig, the speed of disc 1": table(rig={**OWN_RIG, "speed_of": "disc_1"}),
    "preset, disc by disc": table(
        rig={"preset": "suros", "disc_1": OWN_RIG["disc_1"], "disc_2": OWN_RIG["disc_2"], "rotational_speed": "600 rpm"}
    ),
    "options": table(
        contact_models=[
            {"model": "global", "total_from": {"model": "fastsim", "bound": "elliptic"}},
            {"model": "global", "total_from": "exact"},
            {"model": "exact", "slip": "as_printed"},
            "exact",
        ],
        wear_laws=[
            {"model": "kth", "coefficient": OWN_K, "hardness": "3 GPa"},
            {"model": "kth", "coefficient": "low"},
            {"model": "usfd", "fitted_for": "fastsim", "m_c": "70 ug/m/N"},
        ],
    ),
    "all forms of a condition": changed(
        "sweeps.creepage",
        {
            "normal_force": ["1 kN", "2000 N"],
            "creepage": {"from": "0 %", "to": "1 %", "points": 3},
            "friction_coefficient": 0.4,
            "traction_coefficient": [0.1, 0.2],
        },
    ),
    "shipped tests": table(measured={"label": "m", "tests": "lewis2004"}),
}


@pytest.mark.parametrize("content", ACCEPTED.values(), ids=ACCEPTED)
def test_a_case_written_with_all_its_defaults_reads_back_as_the_same_case(
    tmp_path: Path, validator: Any, content: cases.Table
) -> None:
    validator.validate(content)
    read = load(tmp_path, content)
    text = rewritten(read)
    (tmp_path / "again.toml").write_text(text, encoding="utf-8")
    again = wl.load_case(str(tmp_path / "again.toml"))
    assert again == read
    assert labels(again.contact_models) == labels(read.contact_models)
    assert labels(again.wear_laws) == labels(read.wear_laws)
    assert rewritten(again) == text
    validator.validate(tomllib.loads(text))


def test_the_shipped_case_keeps_the_schema_and_reads_back_the_same(tmp_path: Path, validator: Any) -> None:
    shipped = wl.load_case("tassini2010")
    validator.validate(tomllib.loads(cases.wearlaw("case", "tassini2010").stdout))
    assert load(tmp_path, tomllib.loads(rewritten(shipped))) == shipped


# Labels


@pytest.mark.parametrize(
    "models",
    [
        ["exact", {"model": "exact"}],
        ["global", "exact", {"model": "global", "total_from": {"model": "exact"}}],
    ],
)
def test_a_model_listed_twice_is_refused_however_it_is_written(models: Any) -> None:
    with pytest.raises(wl.ConfigurationError, match="is listed twice; leave one out, or give it other options"):
        case(contact_models=models)


# The schema and other people's models


REQUIRED: dict[str, dict[str, Any]] = {"archard": {"coefficient": 1e-4}, "energy": {"mass_per_energy": "1 ug/J"}}
"""Fields without defaults of models that ship with wearlaw."""


@pytest.mark.parametrize("kind", ["contact_models", "wear_laws"])
def test_the_schema_accepts_each_installed_model_by_name_and_as_a_table(validator: Any, kind: str) -> None:
    for name in wl.installed(kind.replace("_", " ").removesuffix("s")):
        given = REQUIRED.get(name, {})
        assert validator.is_valid(table(**{kind: [name]}))
        assert validator.is_valid(table(**{kind: [{"model": name, **given}]}))
        assert validator.is_valid(table(**{kind: [{"model": name}]})) == (not given)
        assert not validator.is_valid(table(**{kind: [{"model": name, **given, "nonsense": 1}]}))


@pytest.mark.parametrize(("name", "versions"), [("wearlaw", ">=99"), ("wearlaw-zobory", ">=1"), ("wearlaw", "new")])
def test_a_case_whose_plugins_are_missing_is_refused_for_that_alone(name: str, versions: str) -> None:
    with pytest.raises(wl.ConfigurationError) as caught:
        case(plugins={name: versions}, wear_laws=["zobory"])
    assert [problem.path for problem in caught.value.problems] == [("plugins", name)]


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


def test_distributions_are_refused_with_what_takes_them(tmp_path: Path) -> None:
    with pytest.raises(CaseError, match=r"\n  uncertainty: a case has no distributions; give them to wl\.uncertainty"):
        load(tmp_path, table(uncertainty={"scatter": cases.POINT}))


def places(content: Any, tmp_path: Path) -> list[str]:
    """Return the paths of the wrong fields of a case, in alphabetical order."""
    with pytest.raises(CaseError) as refusal:
        load(tmp_path, content)
    return sorted(line.strip().split(":")[0] for line in str(refusal.value).splitlines()[1:])


def test_the_first_condition_that_the_rig_refuses_is_named_in_every_sweep_and_profile(tmp_path: Path) -> None:
    content = table(
        sweeps={
            "one": {**cases.POINT, "max_pressure": "1500 N"},
            "two": {**cases.POINT, "angle": "1 deg", "friction": 0.3},
            "four": {**cases.POINT, "max_pressure": ["1 GPa", "-1 GPa"]},
        },
        profiles={"six": {**cases.POINT, "creepage": 1}, "seven": {**cases.POINT, "creepage": ["1 %"]}},
    )
    assert places(content, tmp_path) == [
        "profiles.seven",
        "profiles.six.creepage",
        "sweeps.four.max_pressure",
        "sweeps.one.max_pressure",
        "sweeps.two.angle",
        "sweeps.two.friction",
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
