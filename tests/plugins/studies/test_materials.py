"""Materials of classes that plugins and scripts derive: they stay what they are, in every file and report."""

from __future__ import annotations

import json
import pickle
import tomllib
from pathlib import Path
from typing import Annotated, Any, ClassVar

import jsonschema  # type: ignore[import-untyped]
import numpy as np
import pytest

import wearlaw as wl
from tests.cases import POINT, case, load, table
from tests.core.distributions import Install
from wearlaw import loader  # private: plugins of a test are found as if they were installed
from wearlaw.errors import CaseError, PluginWarning
from wearlaw_apps.studies import Case
from wearlaw_apps.studies.case import case_schema, load_case, written  # private: a case without its files
from wearlaw_apps.studies.report.tables import parameters  # private: a part of the report, without its page
from wearlaw_apps.studies.study import provenance, run  # private: a case run without its files

STEELS = """
    from typing import Annotated

    import wearlaw as wl

    class RailSteel(wl.Material):
        hardness: Annotated[wl.Quantity, wl.Unit("GPa")]
        \"\"\"Hardness, H [Pa].\"\"\"

    class Bare(wl.Material):
        grain: wl.Length = "10 um"
        \"\"\"Size of its grains [m].\"\"\"

    HARD = RailSteel(youngs_modulus="210 GPa", poisson_ratio=0.3, density="7800 kg/m^3", hardness="3.5 GPa")

    class Softer(wl.WearLaw):
        name = "softer"
        source = "a test"

        def rate(self, contact, p):
            hardness = contact.body().material.hardness.to("Pa").magnitude
            return 1e-6 * contact.wear_index_density / hardness

    @wl.hookimpl
    def wearlaw_named():
        return {"r350": HARD, "Bare": Bare}

    @wl.hookimpl
    def wearlaw_models():
        return [Softer]
"""

FIELDS = {"youngs_modulus": "210 GPa", "poisson_ratio": 0.3, "density": "7800 kg/m^3"}
TYPED = {"type": "RailSteel", **FIELDS, "hardness": "3.5 GPa"}
AT: Any = {"max_pressure": "800 MPa", "creepage": "1 %", "friction_coefficient": 0.2}


class Own(wl.Material):
    """A material of a script."""

    hardness: Annotated[wl.Quantity, wl.Unit("GPa")]
    """Hardness, H [Pa]."""


def own(**changes: Any) -> Own:
    return Own(**{**FIELDS, "hardness": "2.6 GPa", **changes})


@pytest.fixture
def steels(install: Install) -> None:
    install("steels", STEELS, version="2.5")


@pytest.mark.usefixtures("steels")
def test_a_rig_keeps_the_class_of_its_material_in_json_and_pickles() -> None:
    hard = wl.material("r350", density="7700 kg/m^3")
    assert type(hard).__name__ == "RailSteel"
    predict = wl.TwinDisc.suros(material=hard) | wl.contact_model("exact") | wl.wear_law("softer")
    as_json = predict.model_dump_json()
    again: wl.Pipeline[...] = wl.Pipeline.model_validate_json(as_json)
    for one in (again, pickle.loads(pickle.dumps(predict))):
        assert one == predict
        assert isinstance(one.rig, wl.TwinDisc)
        assert type(one.rig.disc_1.material) is type(hard)
        assert hash(one) == hash(predict)
    assert again.model_dump_json() == as_json
    assert json.loads(as_json)["rig"]["disc_2"]["material"]["type"] == "RailSteel"


@pytest.mark.usefixtures("steels")
@pytest.mark.parametrize("given", ["r350", TYPED, {"type": "r350"}, {"type": "r350", "hardness": "3.5 GPa"}])
def test_a_case_file_names_a_material_or_gives_its_class_and_fields(given: Any, tmp_path: Path) -> None:
    read = load(tmp_path, table(rig={"preset": "suros", "material": given}))
    assert isinstance(read.rig, wl.TwinDisc)
    assert read.rig.disc_1.material == wl.material("r350")
    assert type(read.rig.disc_1.material).__name__ == "RailSteel"
    rig = {"type": "wheel_rail", "wheel_radius": "460 mm", "rail_head_radius": "300 mm", "rolling_speed": "30 m/s"}
    point = {"max_pressure": "800 MPa", "longitudinal_creepage": "1 %", "friction_coefficient": 0.2}
    fields = table(rig={**rig, "material": given}, contact_models=["fastsim"], sweeps={"a": point}, profiles={})
    assert load(tmp_path, fields).rig.bodies["rail"].material == wl.material("r350")
    assert jsonschema.Draft202012Validator(case_schema()).is_valid(fields)


@pytest.mark.usefixtures("steels")
def test_a_class_without_a_material_is_offered_under_its_own_name() -> None:
    bare = wl.material("Bare", **FIELDS, grain="20 um")
    assert type(bare).__name__ == "Bare"
    assert bare.model_dump(mode="json", exclude_none=True)["grain"] == "20.0 µm"
    with pytest.raises(wl.ConfigurationError, match=r"Bare:\n  youngs_modulus: is missing"):
        wl.material("Bare")


@pytest.mark.usefixtures("steels")
def test_a_case_of_a_run_names_material_class_and_plugin_as_the_first_one_did(tmp_path: Path) -> None:
    changed = {"type": "r350", "hardness": "4 GPa"}
    rig = {"type": "twin_disc", "track_width": "10 mm", "rolling_speed": "1 m/s"}
    discs = {f"disc_{n}": {"diameter": "47 mm", "material": one} for n, one in ((1, "r350"), (2, changed))}
    first = case(rig={**rig, **discs}, contact_models=["exact"], wear_laws=["softer"])
    said = provenance(first)
    assert said["materials"] == {"r350": "steels 2.5"}
    assert said["material_types"] == {"RailSteel": "steels 2.5"}
    for name, text in written(first).items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    again = load_case(str(tmp_path / "case.toml"))
    assert again == first
    assert provenance(again) == said
    assert written(again) == written(first)
    tables = tomllib.loads(written(first)["case.toml"])["rig"]
    assert [tables[f"disc_{n}"]["material"]["type"] for n in (1, 2)] == ["r350", "RailSteel"]


def test_a_material_of_a_script_works_everywhere_but_in_files(tmp_path: Path) -> None:
    rig = wl.TwinDisc.suros(material=own())
    assert pickle.loads(pickle.dumps(rig)).disc_1.material == own()
    fields = {**table(sweeps={"point": POINT}, profiles={}), "rig": rig}
    study = run(Case(**fields))
    assert provenance(study.case)["material_types"] == {"Own": "not installed"}
    assert "disc_2.material.hardness" in set(parameters(study).frame["parameter"])
    (tmp_path / "case.toml").write_text(written(study.case)["case.toml"], encoding="utf-8")
    with pytest.raises(CaseError) as error:
        load_case(str(tmp_path / "case.toml"))
    assert "rig.disc_1.material: no material is called 'Own'. Installed: R200, " in str(error.value)


def test_the_record_of_a_fit_keeps_the_class_of_its_bodies(install: Install) -> None:
    install("steels", STEELS)
    bodies = (wl.material("r350"), wl.steel())
    record = wl.Calibration(contact_model="exact", scale="cells", materials="-", source="-", bodies=bodies)
    assert wl.Calibration.model_validate_json(record.model_dump_json()) == record


def test_a_law_takes_a_material_by_its_name_in_a_field() -> None:
    class Counterpart(wl.WearLaw):
        name: ClassVar[str] = "counterpart"

        other: wl.MaterialField
        """Material of the other body."""

        def rate(self, contact: wl.Contact, p: wl.Numbers) -> wl.Array:
            return contact.wear_index_density / p["other.youngs_modulus"]

    law = Counterpart(other="steel")  # type: ignore[arg-type]
    assert law.other == wl.steel()
    assert law.numbers["other.youngs_modulus"] == pytest.approx(206.47742e9, rel=1e-15)
    assert Counterpart(**law.model_dump(mode="json")) == law
    with pytest.raises(wl.ConfigurationError, match="other: no material is called 'steal'; did you mean 'steel'"):
        Counterpart(other="steal")  # type: ignore[arg-type]


@pytest.mark.usefixtures("steels")
def test_a_law_reads_the_material_of_the_body_that_wears() -> None:
    """Of two bodies with the same density the softer one wears more, by the ratio of the hardnesses."""
    discs = [
        wl.Disc(diameter="47 mm", material=one) for one in (wl.material("r350"), wl.material("r350", hardness="7 GPa"))
    ]
    rig = wl.TwinDisc(disc_1=discs[0], disc_2=discs[1], track_width="10 mm", rolling_speed="1 m/s")
    found = (rig | wl.contact_model("exact") | wl.wear_law("softer"))(**AT)
    one, two = (found.mass_lost(over="1 km", body=body).magnitude for body in ("disc_1", "disc_2"))
    assert one / two == pytest.approx(2.0, rel=1e-13)
    assert found.contact.body().material == found.contact.body("disc_1").material == wl.material("r350")
    assert found.contact.body("disc_2").material == wl.material("r350", hardness="7 GPa")


@pytest.mark.usefixtures("steels")
def test_the_profile_of_the_second_body_is_that_of_its_material() -> None:
    rig = wl.WheelRail(
        wheel_radius="460 mm",
        rail_head_radius="300 mm",
        material=wl.material("r350"),
        rail_material=wl.material("r350", hardness="7 GPa"),
        rolling_speed="30 m/s",
    )
    predict = rig | wl.contact_model("fastsim") | wl.wear_law("softer")
    found = predict(normal_force="20 kN", longitudinal_creepage="1 %", friction_coefficient=0.2)
    wheel, rail = (found.wear_profile(body)["depth"] for body in ("wheel", "rail"))
    around = 2.0 * np.pi * 0.46
    assert wheel.attrs["units"] == "um/km"
    assert rail.attrs["units"] == "nm"
    # nm a passage are 1e-9 m over the whole patch; the wheel's depth is spread over its circumference
    np.testing.assert_allclose(rail.values * 1e-9 * 2.0, wheel.values * 1e-9 * around, rtol=1e-12)


def test_a_contact_without_a_problem_says_so_where_a_law_asks_for_its_body() -> None:
    nodes = wl.Contact.from_arrays(
        pressure=wl.Q([1.0], "GPa"),
        traction=wl.Q([0.1], "GPa"),
        slip=wl.Q([1.0], "%"),
        area="1 mm^2",
        rolling_speed="1 m/s",
    )
    with pytest.raises(wl.InputError, match="body: is not known, because this contact was solved elsewhere"):
        nodes.body()
    with pytest.raises(wl.InputError, match="half_width: is not known, because"):
        _ = nodes.half_width
    found = (wl.TwinDisc.suros() | wl.contact_model("exact"))(**AT)
    assert found.contact.half_width == found.problem.half_width
    with pytest.raises(wl.InputError, match="body: this rig has no 'wheel'; its bodies are 'disc_1' and 'disc_2'"):
        found.contact.body("wheel")
    with pytest.raises(wl.InputError, match="body: the rig does not name its bodies, so their materials are not known"):
        found.contact.replaced(problem=found.problem.replaced(bodies={})).body()


@pytest.mark.parametrize(
    ("old", "new", "cause"),
    [
        ('"Bare": Bare', '"bare": Bare', "a class of materials goes by its own name: write 'Bare' in place of 'bare'"),
        ('"Bare": Bare', '"Bare": int', "material 'Bare' must be a Material or a class derived from it, got <class 'i"),
    ],
)
def test_a_wrong_class_of_materials_is_left_out_with_the_reason(
    install: Install, old: str, new: str, cause: str
) -> None:
    assert old in STEELS
    install("steels", STEELS.replace(old, new))
    with pytest.warns(PluginWarning, match="left out: steels 1.0"):
        (broken,) = loader.discovered().broken
    assert cause in broken.cause
