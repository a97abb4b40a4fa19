"""Case files: what is read, what is refused and how that is said, and the schema that says the same."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

import jsonschema  # type: ignore[import-untyped]
import numpy as np
import pytest
import tomli_w

import wearlaw as wl
from tests.core import cases
from tests.core.cases import InstallModel, case, changed, table
from wearlaw import plugins
from wearlaw.case import Case, case_schema, case_text, labels, load_case, written


def load(tmp_path: Path, content: cases.Table) -> Case:
    return load_case(str(cases.write(tmp_path / "my.toml", content)))


def rewritten(read: Case) -> str:
    return tomli_w.dumps(read.model_dump(mode="json", by_alias=True, exclude_none=True))


@pytest.fixture(scope="module")
def validator() -> Any:
    schema = case_schema()
    jsonschema.Draft202012Validator.check_schema(schema)
    return jsonschema.Draft202012Validator(schema)


# Measured tests

OWN_TESTS = """\
creepage [%],normal_force [kN],traction_coefficient,wear_rate [ug/m/mm^2]
1,7.4,0.35,10
3,7.4,NA,40
"""


def test_tests_of_a_lab_are_found_from_the_folder_of_the_case_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    studies = tmp_path / "studies"
    (studies / "data").mkdir(parents=True)
    (studies / "data" / "own.csv").write_text(OWN_TESTS, encoding="utf-8")
    cases.write(studies / "my.toml", table(measured={"label": "m", "tests": "data/own.csv"}))
    monkeypatch.chdir(tmp_path)
    for where in ("studies/my.toml", str(studies / "my.toml")):
        measured = load_case(where).measured
        assert measured is not None
        np.testing.assert_allclose(measured.data.wear_rate.to("ug/m/mm^2").magnitude, [10.0, 40.0], rtol=1e-14)
        assert measured.data.source == "own.csv"
        assert not measured.shipped


def test_a_case_can_be_written_with_its_tests_to_run_again_anywhere(tmp_path: Path) -> None:
    text = "# source: a test in µg\r\n" + OWN_TESTS
    (tmp_path / "own.csv").write_text(text, encoding="cp1252", newline="")
    read = load(tmp_path, table(measured={"label": "m", "tests": "own.csv"}))
    (tmp_path / "own.csv").unlink()  # what is written is what was read
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    files = written(read)
    assert list(files) == ["case.toml", "tests.csv"]
    for name, content in files.items():
        (elsewhere / name).write_text(content, encoding="utf-8")
    again = load_case(str(elsewhere / "case.toml"))
    assert read.measured is not None
    assert again.measured is not None
    assert again.measured.data == read.measured.data
    assert again.measured.data.source == "a test in µg"
    assert again.model_copy(update={"measured": None}) == read.model_copy(update={"measured": None})


def test_a_case_with_shipped_tests_is_written_without_them() -> None:
    shipped = load_case("tassini2010")
    assert list(written(shipped)) == ["case.toml"]
    assert Case(**tomllib.loads(written(shipped)["case.toml"])) == shipped


# What is read is written and read again

STEEL = {"youngs_modulus": "210 GPa", "poisson_ratio": 0.3, "density": "7.8 g/cm^3"}
RAIL = {**STEEL, "elastic_limit": "1 GPa"}
OWN_K = {"high_pressure": 0.03, "low_speed": 1e-4, "mid_speed": 1e-3, "high_speed": 2e-4}
OWN_RIG = {
    "disc_1": {"diameter": "47 mm", "material": STEEL},
    "disc_2": {"diameter": "inf mm", "material": RAIL},
    "track_width": "1 cm",
    "rolling_speed": "3.6 km/hr",
}
ACCEPTED = {
    "small": table(),
    "one name": table(contact_models=["exact"], wear_laws=[{"model": "usfd"}], profiles={}),
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
    read = load(tmp_path, content)
    text = rewritten(read)
    (tmp_path / "again.toml").write_text(text, encoding="utf-8")
    again = load_case(str(tmp_path / "again.toml"))
    assert again == read
    assert labels(again.contact_models) == labels(read.contact_models)
    assert labels(again.wear_laws) == labels(read.wear_laws)
    assert rewritten(again) == text
    validator.validate(tomllib.loads(text))


@pytest.mark.parametrize("content", ACCEPTED.values(), ids=ACCEPTED)
def test_the_schema_accepts_what_the_loader_accepts(validator: Any, content: cases.Table) -> None:
    validator.validate(content)


def test_the_shipped_case_keeps_the_schema_and_reads_back_the_same(tmp_path: Path, validator: Any) -> None:
    shipped = load_case("tassini2010")
    validator.validate(tomllib.loads(case_text("tassini2010")))
    assert load(tmp_path, tomllib.loads(rewritten(shipped))) == shipped


def test_a_preset_is_the_rig_with_what_is_overridden() -> None:
    assert case().rig == wl.TwinDisc.suros()
    material = wl.Material(**STEEL)  # type: ignore[arg-type]
    rig = Case(**ACCEPTED["preset, overridden"]).rig
    assert rig == wl.TwinDisc.suros(diameter="100 mm", material=material, track_width="5 mm", rolling_speed="1 m/s")
    by_disc = Case(**ACCEPTED["preset, disc by disc"]).rig
    assert by_disc.disc_2 == wl.Disc(diameter="inf mm", material=wl.Material(**RAIL))  # type: ignore[arg-type]
    assert by_disc.rolling_speed.to("m/s").magnitude == pytest.approx(np.pi * 0.047 * 10.0, rel=1e-14)


# Labels


@pytest.mark.parametrize(
    ("laws", "expected"),
    [
        (["usfd", "kth"], ["usfd", "kth"]),
        ([{"model": "usfd", "fitted_for": "exact"}], ["usfd"]),
        (
            ["usfd", {"model": "usfd", "fitted_for": "exact"}, "brr"],
            ["usfd(fitted_for=global)", "usfd(fitted_for=exact)", "brr"],
        ),
        (
            ["usfd", {"model": "usfd", "m_c": "70 ug/m/N"}, {"model": "usfd", "fitted_for": "exact"}],
            [
                "usfd(fitted_for=global, m_c=61.9 µg/m/N)",
                "usfd(fitted_for=global, m_c=70.0 µg/m/N)",
                "usfd(fitted_for=exact, m_c=83.7 µg/m/N)",
            ],
        ),
    ],
)
def test_models_that_share_a_name_are_labelled_by_what_they_differ_in(laws: Any, expected: list[str]) -> None:
    assert labels(case(wear_laws=laws).wear_laws) == expected


@pytest.mark.parametrize(
    "models",
    [
        ["exact", "exact"],
        ["exact", {"model": "exact"}],
        ["exact", {"model": "exact", "slip": "consistent"}],
        ["global", "exact", {"model": "global", "total_from": {"model": "exact"}}],
    ],
)
def test_a_model_listed_twice_is_refused_however_it_is_written(models: Any) -> None:
    with pytest.raises(wl.ConfigurationError, match="is listed twice; leave one out, or give it other options"):
        case(contact_models=models)


# What is refused

WRONG: list[tuple[str, Any, str]] = [
    ("title", None, "title: is missing"),
    ("title", 1, "title: input should be a valid string, got 1"),
    ("titel", "x", "titel: unknown field; did you mean 'title'?"),
    ("rig", None, "rig: is missing"),
    ("rig", "suros", "rig: must be a table, such as {preset = \"suros\"}; got 'suros'"),
    ("rig", {}, "rig.disc_1: is missing"),
    ("rig.preset", "sros", "rig.preset: input should be 'suros', got 'sros'"),
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
    ("wear_laws", [], "wear_laws: must be a list of names"),
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
        "sweeps.creepage.frictioncoefficient: unknown field; did you mean 'friction_coefficient'?",
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
    ("rig.diameter", "47 kN", "rig.diameter: got 47.00 kN, which is not of the dimension of 'mm'"),
    ("rig.diameter", "-1 mm", "rig.diameter: must be greater than zero, got -1.000 mm"),
    ("rig.diameter", "47 foo", "rig.diameter: 'foo' is not a known unit"),
    ("sweeps.creepage.max_pressure", "1 kN", "sweeps.creepage: max_pressure: got 1.000 kN, which is not of the dim"),
    ("sweeps.creepage.creepage", 1, "sweeps.creepage: creepage: got the bare number 1.0, which has no unit"),
    ("sweeps.creepage.normal_force", "1 N", "sweeps.creepage: give exactly one of normal_force, normal_force_per"),
    ("sweeps.a b", cases.POINT, "sweeps: the name 'a b' must be made of letters, digits and underscores"),
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
        (b"\xff\xfe\x00\x01", "cannot read the case file"),
        (b"title,rig\n1,2\n", "is not valid TOML: "),
        (b"", "is wrong in:\n  title: is missing"),
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


# The schema and other people's models


class OwnCoefficients(wl.Configuration):
    strength: float


class Law(cases.Linear):
    name = "other"
    coefficients: OwnCoefficients = OwnCoefficients(strength=1.0)


OwnCoefficients.__name__ = OwnCoefficients.__qualname__ = "Coefficients"  # as KTH's


def test_the_schema_knows_the_options_of_every_installed_model(install_model: InstallModel) -> None:
    install_model(Law)
    validator = jsonschema.Draft202012Validator(case_schema())

    def valid(**law: Any) -> bool:
        return bool(validator.is_valid(table(wear_laws=[law])))

    assert valid(model="other", slope="1 mm")
    assert not valid(model="other"), "slope must be given"
    assert valid(model="other", slope="1 mm", coefficients={"strength": 1.0})
    assert not valid(model="other", slope="1 mm", coefficients=OWN_K)
    assert valid(model="kth", coefficient=OWN_K)
    assert not valid(model="kth", coefficient={"strength": 1.0})
    assert not validator.is_valid(table(contact_models=["other"]))


@pytest.mark.parametrize("kind", ["contact_models", "wear_laws"])
def test_the_schema_accepts_each_installed_model_by_name_and_as_a_table(validator: Any, kind: str) -> None:
    for name in getattr(plugins, kind)():
        assert validator.is_valid(table(**{kind: [name]}))
        assert validator.is_valid(table(**{kind: [{"model": name}]}))
        assert not validator.is_valid(table(**{kind: [{"model": name, "nonsense": 1}]}))


@pytest.mark.parametrize("versions", ["", ">=0.1", ">=0.0.1,<99", "==0.1.*"])
def test_a_case_may_name_the_distributions_it_needs(versions: str) -> None:
    assert case(plugins={"wearlaw": versions}).plugins == {"wearlaw": versions}


@pytest.mark.parametrize(
    ("needed", "message"),
    [
        ({"wearlaw": ">=99"}, "plugins.wearlaw: version .* is installed, but >=99 is needed"),
        ({"wearlaw-zobory": ">=1"}, "plugins.wearlaw-zobory: is not installed; install it with: pip install "),
        ({"wearlaw": "new"}, "plugins.wearlaw: 'new' is no version range; write one such as '>=1.2,<2'"),
    ],
)
def test_a_case_whose_plugins_are_missing_is_refused_for_that_alone(needed: Any, message: str) -> None:
    with pytest.raises(wl.ConfigurationError, match=message) as caught:
        case(plugins=needed, wear_laws=["zobory"])
    assert len(caught.value.problems) == 1
