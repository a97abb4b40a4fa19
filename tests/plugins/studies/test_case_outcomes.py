"""Cases with stages, with laws of other outcomes than wear, and with laws for one body."""

from __future__ import annotations

import json
import warnings
from pathlib import Path
from typing import Annotated, Any, ClassVar

import jsonschema  # type: ignore[import-untyped]
import numpy as np
import pandas as pd
import pytest
import xarray as xr
from pydantic import Field

import wearlaw as wl
from tests.core import test_outcomes
from tests.core.cases import POINT, InstallModel, case, changed, load, table, wearlaw
from tests.core.stages import EXACT, KTH, RIG, predicted, silently
from tests.core.test_outcomes import Heat, Volume
from wearlaw.errors import CompositionError
from wearlaw_studies.case import case_schema, load_case, written
from wearlaw_studies.report.page import report
from wearlaw_studies.report.tables import models, parameters, summaries, tables
from wearlaw_studies.study import Study, run
from wearlaw_studies.written import table as csv_table

EPS = float(np.finfo(np.float64).eps)
ON_RAILS: Any = {
    "rig": {
        "type": "wheel_rail",
        "wheel_radius": "460 mm",
        "rail_head_radius": "300 mm",
        "material": "steel",
        "rolling_speed": "30 m/s",
    },
    "contact_models": ["fastsim"],
    "sweeps": {
        "creepage": {
            "normal_force": "80 kN",
            "longitudinal_creepage": ["0.05 %", "0.2 %", "1 %"],
            "friction_coefficient": 0.3,
        }
    },
    "profiles": {"one": {"normal_force": "80 kN", "longitudinal_creepage": "0.2 %", "friction_coefficient": 0.3}},
}
BOTH: Any = {"contact_models": ["exact", "global"], "wear_laws": ["kth"], "laws": ["damage", "heat"]}


class Damage(test_outcomes.Damage):
    """The same law, with a default that the schema can show."""

    threshold: Annotated[wl.Quantity, wl.Unit("N")] = Field(default="15 N", validate_default=True)


@pytest.fixture(autouse=True)
def _laws(install_model: InstallModel) -> None:
    for law in (Damage, Heat):
        install_model(law)


def ran(**changes: Any) -> Study:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", wl.WearlawWarning)
        return run(case(**changes))


def refused(path: Path, **changes: Any) -> str:
    with pytest.raises(wl.CaseError) as refusal:
        load(path, table(**changes))
    return str(refusal.value)


# --- Stages ----------------------------------------------------------------------------------------------------


def test_the_advice_of_a_note_is_what_a_case_can_follow() -> None:
    alone = {"contact_models": ["exact"], "wear_laws": ["brr", "kth"], "profiles": {}}
    (note,) = (note for note in ran(**alone).notes if note.startswith("brr on exact is left out"))
    assert note.endswith('write stages = ["patch_mean"] in the case, or use the contact model "global"')
    followed = ran(**alone, stages=["patch_mean"])
    assert not any("is left out" in note for note in followed.notes)
    sweep = followed.sweeps["creepage"]
    assert sweep.pair.values.tolist() == ["brr on exact with patch_mean", "kth on exact with patch_mean"]
    assert sweep.contact_model.values.tolist() == ["exact with patch_mean"]
    at: Any = {**POINT, "creepage": wl.Q(sweep.creepage.values, "%")}
    due = predicted(RIG | EXACT | wl.patch_mean() | wl.wear_law("brr"), **at).wear_rate
    np.testing.assert_allclose(sweep.wear_rate[0], due.magnitude, rtol=16 * EPS)


def test_results_name_the_stages(tmp_path: Path) -> None:
    study = ran(contact_models=["exact"], wear_laws=["brr"], stages=[{"model": "patch_mean"}])
    assert study.notes[-1].endswith("no contact model of the case resolves the patch after its stages")
    said = json.loads(study.sweeps["creepage"].attrs["provenance"])
    assert said["stages"] == {"patch_mean": f"wearlaw {wl.__version__}"}
    assert said["case"]["stages"] == [{"model": "patch_mean"}]
    assert models(study).frame[["model", "kind"]].to_numpy().tolist() == [
        ["exact", "contact model"],
        ["patch_mean", "stage"],
        ["brr", "wear law"],
    ]
    files = written(study.case)
    (tmp_path / "case.toml").write_text(files["case.toml"], encoding="utf-8")
    assert load_case(str(tmp_path / "case.toml")) == study.case
    page = report(study, files["case.toml"])
    assert ">brr on exact with patch_mean</th>" in page
    assert "<li>stage patch_mean" not in page, "it stands in the table of models"
    assert {curve.label for panel in study.figures[0].panels for curve in panel.curves} == {
        "brr on exact with patch_mean"
    }


def test_a_case_without_stages_and_laws_of_others_is_written_as_before() -> None:
    fields = case().model_dump(mode="json")
    assert not {"stages", "laws"} & fields.keys()
    assert "wear_laws" not in case(wear_laws=[], laws=["damage"]).model_dump(mode="json")


class Slim(wl.Stage):
    """A stage for resolved contacts only."""

    name: ClassVar[str] = "slim"
    source: ClassVar[str] = "test"

    def solve(self, problem: wl.Problem, inner: wl.Solve) -> wl.Contact:
        contact = inner(problem)
        if contact.pressure.size == contact.rolling_speed.size:
            raise CompositionError("it needs a contact resolved into cells")
        return contact


@pytest.mark.parametrize(
    ("stages", "said"),
    [
        (["patch_men"], "stages.0: no stage is called 'patch_men'; did you mean 'patch_mean'?"),
        (["patch_mean", "exact"], "stages.1: no stage is called 'exact'"),
        ("patch_mean", "stages: must be a list of names, or of tables with a name and options; got 'patch_mean'"),
        ([{"model": "patch_mean", "width": 1}], "stages.0.width: unknown field"),
        (["patch_mean", "patch_mean"], "stages: the model patch_mean is listed twice; leave one out"),
        (["patch_mean", "slim"], "stages.1: slim cannot stand around exact: it needs a contact resolved into cells"),
        (["slim"], "stages.0: slim cannot stand around global: it needs a contact resolved into cells; leave one"),
    ],
)
def test_a_wrong_stage_is_named_by_its_path(
    tmp_path: Path, install_model: InstallModel, stages: Any, said: str
) -> None:
    install_model(Slim)
    assert f"\n  {said}" in refused(tmp_path, contact_models=["exact", "global"], stages=stages)


def test_a_stage_where_it_can_stand_changes_nothing_else(install_model: InstallModel) -> None:
    install_model(Slim)
    plain, staged = (
        ran(contact_models=["exact"], wear_laws=["kth"], stages=stages, profiles={}) for stages in ([], ["slim"])
    )
    assert staged.pairs[0].label == "kth on exact with slim"
    # the stage has no closed form, so the mean is that of cells: right to its error
    one, two = (study.sweeps["creepage"].isel(pair=0) for study in (plain, staged))
    assert (abs(one.wear_rate - two.wear_rate) <= one.wear_rate_error + two.wear_rate_error).all()


# --- Laws of other outcomes ------------------------------------------------------------------------------------


def test_each_outcome_has_its_own_name_and_unit_in_a_sweep() -> None:
    sweep = ran(**BOTH).sweeps["creepage"]
    assert {v: sweep[v].attrs["units"] for v in sweep.data_vars if "pair" in sweep[v].dims} == {
        "wear_rate": "ug/m/mm^2",
        "wear_rate_error": "ug/m/mm^2",
        "outside_range": "",
        "wear_rate_low": "ug/m/mm^2",
        "wear_rate_high": "ug/m/mm^2",
        "rcf_damage": "",
        "heat_flux": "W/mm^2",
        "heat_flux_error": "W/mm^2",
    }
    predict = silently(RIG, EXACT, KTH, Damage(), Heat())
    due = predicted(predict, **{**POINT, "creepage": wl.Q(sweep.creepage.values, "%")})
    for law, outcome in (("kth", "wear_rate"), ("damage", "rcf_damage"), ("heat", "heat_flux")):
        of_pair = sweep[outcome].sel(pair=f"{law} on exact")
        np.testing.assert_allclose(of_pair, due[outcome].magnitude, rtol=64 * EPS)
        others = [label for label in sweep.pair.values if not label.startswith(law)]
        assert sweep[outcome].sel(pair=others).isnull().all()
    assert sweep.pair_wear_law.values.tolist() == ["kth", "", ""] * 2
    assert sweep.pair_law.values.tolist() == ["", "damage", "heat"] * 2


def test_the_tidy_table_has_a_column_for_each_outcome() -> None:
    frame = csv_table(ran(**BOTH))
    assert list(frame.columns[:4]) == ["sweep", "contact_model", "wear_law", "law"]
    assert {"wear_rate [ug/m/mm^2]", "rcf_damage", "heat_flux [W/mm^2]", "heat_flux_error [W/mm^2]"} <= {*frame.columns}
    damage = frame[frame.law == "damage"]
    assert len(damage) == 10
    assert damage["rcf_damage"].notna().all()
    assert damage[["wear_rate [ug/m/mm^2]", "heat_flux [W/mm^2]"]].isna().all(axis=None)
    assert (damage.wear_law == "").all()


def test_tables_and_default_figures_are_of_each_outcome() -> None:
    study = ran(**BOTH)
    heads = {one.name: one.frame.columns[0] for one in summaries(study)}
    assert heads == {
        "wear_rate_creepage": "wear rate [µg/m/mm²] by creepage [%]",
        "rcf_damage_creepage": "rcf damage [-] by creepage [%]",
        "heat_flux_creepage": "heat flux [W/mm²] by creepage [%]",
    }
    (rows,) = (one.frame.iloc[:, 0].tolist() for one in summaries(study) if one.name == "rcf_damage_creepage")
    assert rows == ["damage on exact", "damage on global"]
    axes = {figure.name: (figure.panels[0].y.label, figure.panels[0].y.scale) for figure in study.figures}
    assert axes == {
        "creepage_wear_rate_over_wear_index": ("wear rate [µg/m/mm²]", "log"),
        "creepage_wear_rate_over_creepage": ("wear rate [µg/m/mm²]", "log"),
        "creepage_rcf_damage_over_wear_index": ("rcf damage [-]", "linear"),  # it has a sign
        "creepage_rcf_damage_over_creepage": ("rcf damage [-]", "linear"),
        "creepage_heat_flux_over_wear_index": ("heat flux [W/mm²]", "log"),
        "creepage_heat_flux_over_creepage": ("heat flux [W/mm²]", "log"),
        "creepage_traction_over_creepage": ("traction coefficient T/N [-]", "linear"),
        "partial_slip_along_the_patch": ("pressure p, traction q, traction bound [MPa]", "linear"),
    }
    (figure,) = (one for one in study.figures if one.name == "creepage_rcf_damage_over_creepage")
    assert [curve.label for curve in figure.panels[0].curves] == ["damage on exact", "damage on global"]
    assert min(figure.panels[0].curves[0].y) < 0.0, "signs stay"
    assert {"damage", "kth"} <= {*parameters(study).frame["of"]}


def test_damage_alone_is_nowhere_a_wear_rate(tmp_path: Path) -> None:
    study = ran(contact_models=["exact"], wear_laws=[], laws=["damage"])
    texts = [csv_table(study).to_csv(), *(one.frame.to_csv() for one in tables(study))]
    texts += [axis.label for figure in study.figures for panel in figure.panels for axis in (panel.x, panel.y)]
    for text in texts:
        assert "wear_rate" not in text
        assert "wear rate" not in text
        assert "g/m/mm" not in text
    assert not any(str(name).startswith("wear_rate") for name in study.sweeps["creepage"].data_vars)
    text = written(study.case)["case.toml"]
    (tmp_path / "case.toml").write_text(text, encoding="utf-8")
    assert load_case(str(tmp_path / "case.toml")) == study.case
    assert "rcf damage [-] by creepage [%]" in report(study, text)


def test_a_profile_along_a_line_shows_means_over_the_area_alone() -> None:
    profile = ran(**{**BOTH, "contact_models": ["exact"]}).profiles["partial_slip"]
    assert profile.pair.values.tolist() == ["kth on exact", "damage on exact", "heat on exact"]
    assert "rcf_damage" not in profile
    assert profile.heat_flux.attrs["units"] == "W/mm^2"
    heat = profile.heat_flux.sel(pair="heat on exact")
    point: Any = POINT
    power = abs(profile.traction * profile.slip).sel(contact_model="exact") * 1e-2 * RIG.problem(**point).rolling_speed
    np.testing.assert_allclose(heat, power, rtol=64 * EPS)  # 1 MPa m/s is 1 W/mm²
    assert profile.heat_flux.sel(pair="kth on exact").isnull().all()


def test_across_an_ellipse_only_wear_is_shown() -> None:
    study = ran(**ON_RAILS, wear_laws=["kth"], laws=["damage", "heat"])
    assert study.profiles["one"].pair.values.tolist() == ["kth on fastsim"]
    for law in ("damage", "heat"):
        said = f"profile 'one': {law} on fastsim is left out, since only wear is shown across a patch"
        assert said in study.notes
    alone = ran(**ON_RAILS, wear_laws=[], laws=["heat"])
    assert not alone.profiles["one"]
    assert {figure.name.partition("_over")[0] for figure in alone.figures} == {
        "creepage_heat_flux",
        "creepage_traction",
    }


def test_a_figure_can_name_outcomes() -> None:
    spec = {"sweep": "creepage", "x": "wear_index"}
    figures = {
        "damage": {**spec, "y": "rcf_damage", "pairs": ["damage on exact"], "y_range": [-1e-5, 1e-4]},
        "heat": {"profile": "partial_slip", "y": "heat_flux"},
        "both": {**spec, "panels": [{"y": "wear_rate"}, {"y": "heat_flux", "y_range": ["0 W/mm^2", "1 kW/mm^2"]}]},
    }
    study = ran(**BOTH, figures=figures)
    damage, heat, both = study.figures
    assert [curve.label for curve in damage.panels[0].curves] == ["damage on exact"]
    assert (damage.panels[0].y.label, damage.panels[0].y.ends) == ("rcf damage [-]", (-1e-5, 1e-4))
    assert [curve.label for curve in heat.panels[0].curves] == ["heat on exact"]
    assert heat.panels[0].y.label == "heat flux [W/mm²]"
    assert [panel.y.label for panel in both.panels] == ["wear rate [µg/m/mm²]", "heat flux [W/mm²]"]
    assert both.panels[1].y.ends == (0.0, 1000.0)
    with_others = ran(
        **{**BOTH, "contact_models": ["exact"]},
        figures={"one": {**spec, "x": "creepage", "y": ["rcf_damage", "stick_ratio"]}},
    )
    labels = [curve.label for curve in with_others.figures[0].panels[0].curves]
    assert labels == ["rcf damage, damage on exact", "stick ratio, exact"]


def test_an_outcome_whose_law_is_left_out_cannot_be_shown(tmp_path: Path, install_model: InstallModel) -> None:
    class Whole(Damage):
        name: ClassVar[str] = "whole"
        scale: ClassVar[Any] = "patch"

    install_model(Whole)
    spec = {"sweep": "creepage", "x": "creepage", "y": "rcf_damage"}
    changes: Any = {"contact_models": ["exact"], "wear_laws": ["kth"], "laws": ["whole"], "figures": {"one": spec}}
    said = refused(tmp_path, **changes)
    assert "figures.one.y: none of the pairs predicts rcf_damage; whole on exact is left out: " in said
    assert 'write stages = ["patch_mean"] in the case' in said
    assert (
        ran(**changes, stages=["patch_mean"]).figures[0].panels[0].curves[0].label == "whole on exact with patch_mean"
    )


class Flux(Damage):
    """Another unit under a name that is taken."""

    name: ClassVar[str] = "flux"
    outcome = wl.Outcome("heat_flux", unit="MW/m^2", of="area mean", signed=True)


class Wear(Damage):
    """A wear rate of a law that is no wear law."""

    name: ClassVar[str] = "wear"
    outcome = wl.Outcome("wear_rate", unit="ug/m/mm^2", of="area mean")


class Named(Damage):
    """An outcome with the name of a column of results."""

    name: ClassVar[str] = "named"
    outcome = wl.Outcome("law", unit="", of="patch", signed=True)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"wear_laws": []}, "wear_laws: is missing or empty; give at least one, as in wear_laws"),
        ({"laws": ["damag"]}, "laws.0: no law is called 'damag'; did you mean 'damage'? Installed: damage, "),
        ({"laws": ["usfd"]}, "laws.0: usfd predicts the wear rate; list it under wear_laws"),
        ({"wear_laws": ["kth", "damage"]}, "wear_laws.1: damage predicts rcf_damage, not wear; list it under laws"),
        ({"wear_laws": [{"model": "heat"}]}, "wear_laws.0: heat predicts heat_flux, not wear; list it under laws"),
        ({"laws": [{"model": "damage", "threshold": "1 m"}]}, "laws.0.threshold: got 1.000 m, which does not have"),
        ({"laws": "damage"}, "laws: must be a list of names, or of tables with a name and options; got 'damage'"),
        ({"laws": ["heat", "flux"]}, "laws.1: flux gives heat_flux in [MW/m^2] of area mean, but heat in [W/mm^2] of"),
        ({"laws": ["named"]}, "laws.0: its outcome 'law' is the name of another column of results; rename it"),
        ({"laws": ["wear"]}, "laws.0: wear predicts the wear rate; derive it from wl.WearLaw, for wear_laws"),
        ({"laws": ["damage", "damage"]}, "the model damage is listed twice; leave one out, or give it other options"),
        (
            {"wear_laws": ["usfd", {"model": "kth", "body": "disk_2"}]},
            "wear_laws.1.body: the rig has no body 'disk_2'; did you mean 'disc_2'? Its bodies are disc_1 and disc_2",
        ),
        ({"laws": [{"model": "heat", "body": "rail"}]}, "laws.0.body: the rig has no body 'rail'. Its bodies are"),
    ],
)  # fmt: skip
def test_a_wrong_law_is_named_by_its_path(tmp_path: Path, install_model: InstallModel, changes: Any, said: str) -> None:
    for law in (Flux, Named, Wear):
        install_model(law)
    assert said in refused(tmp_path, **changes)


def test_the_schema_knows_stages_laws_and_outcomes() -> None:
    validator: Any = jsonschema.Draft202012Validator(case_schema())
    whole = table(
        **BOTH, stages=["patch_mean"], figures={"one": {"sweep": "creepage", "x": "creepage", "y": ["rcf_damage"]}}
    )
    assert validator.is_valid(whole)
    assert validator.is_valid(changed("wear_laws", None, whole))
    assert validator.is_valid(changed("wear_laws", [], whole))
    assert validator.is_valid(changed("laws", [{"model": "damage", "threshold": "3 N", "body": "disc_1"}], whole))
    assert validator.is_valid(changed("stages", [{"model": "patch_mean"}], whole))
    for path, wrong in (
        ("stages", ["patch_men"]),
        ("stages", [{"model": "patch_mean", "x": 1}]),
        ("laws", ["damag"]),
        ("laws", ["usfd"]),
        ("wear_laws", ["damage"]),
        ("figures.one.y", "rcf_damag"),
    ):
        assert not validator.is_valid(changed(path, wrong, whole)), path
    assert not validator.is_valid(changed("laws", [], changed("wear_laws", [], whole)))


# --- Laws for one body -----------------------------------------------------------------------------------------


def test_laws_for_one_body_are_labelled_with_it(install_model: InstallModel) -> None:
    install_model(Volume)
    laws = [{"model": "volume", "body": "wheel"}, {"model": "volume", "body": "rail", "factor": 2.0}]
    study = ran(**ON_RAILS, wear_laws=laws)
    wheel, rail = (pair.label for pair in study.pairs)
    assert (wheel, rail) == ("volume(factor=1.0, body=wheel) on fastsim", "volume(factor=2.0, body=rail) on fastsim")
    sweep, profile = study.sweeps["creepage"], study.profiles["one"]
    np.testing.assert_allclose(sweep.wear_rate.sel(pair=rail), 2.0 * sweep.wear_rate.sel(pair=wheel), rtol=16 * EPS)
    for body, mine, other in (("wheel", wheel, rail), ("rail", rail, wheel)):
        assert (profile[f"{body}_depth"].sel(pair=mine) > 0.0).any()
        assert profile[f"{body}_depth"].sel(pair=other).isnull().all()
        assert (profile[f"{body}_sliding_distance"] > 0.0).any()
    both = ran(**ON_RAILS, wear_laws=["volume"]).profiles["one"]
    xr.testing.assert_equal(
        profile.wheel_depth.sel(pair=wheel, drop=True), both.wheel_depth.isel(pair=0).drop_vars("pair")
    )
    xr.testing.assert_equal(profile.rail_sliding_distance, both.rail_sliding_distance)
    (across,) = (figure for figure in study.figures if figure.name == "one_across_the_patch")
    assert [[curve.label for curve in panel.curves] for panel in across.panels] == [
        [wheel],
        [rail],
        ["fastsim"],
        ["fastsim"],
    ]


def test_one_law_for_one_body_shows_that_body_alone(tmp_path: Path) -> None:
    changes: Any = {**ON_RAILS, "wear_laws": [{"model": "kth", "body": "rail"}]}
    study = ran(**changes)
    assert [pair.label for pair in study.pairs] == ["kth(body=rail) on fastsim"]
    assert "wheel_depth" not in study.profiles["one"]
    (of_profile,) = (one.frame for one in tables(study) if one.name == "profile_one")
    assert list(of_profile.columns) == ["pair", "rail: greatest depth [nm]", "rail: at y [mm]"]
    figures = {"one": {"profile": "one", "x": "y", "y": "depth"}}
    said = "figures.one.body: no wear law shown is for 'wheel'"
    assert said in refused(tmp_path, **changes, figures=figures)
    load(tmp_path, table(**changes, figures={"one": {**figures["one"], "body": "rail"}}))
    changes["wear_laws"] = [{"model": "kth", "body": body} for body in ("wheel", "rail")]
    one = {**figures["one"], "pairs": ["kth(body=wheel) on fastsim"]}
    load(tmp_path, table(**changes, figures={"one": one}))
    said = "figures.one.body: no wear law shown is for 'rail'"
    assert said in refused(tmp_path, **changes, figures={"one": {**one, "body": "rail"}})


# --- The command line ------------------------------------------------------------------------------------------


@pytest.mark.usefixtures("blank_figures")
def test_a_run_writes_and_prints_each_outcome(folder: Path) -> None:
    load(folder, table(**BOTH, stages=["patch_mean"], profiles={}))
    result = wearlaw("run", "my.toml", "-o", "out", "--workers", "1", columns=200)
    assert result.exit_code == 0, result.output
    for outcome in ("wear rate [µg/m/mm²]", "rcf damage [-]", "heat flux [W/mm²]"):
        assert f"Sweep 'creepage': {outcome} by creepage [%]" in result.stdout
    assert "law damage" in result.stdout
    frame = pd.read_csv(folder / "out" / "results.csv")
    assert set(frame.law.dropna()) == {"damage", "heat"}
    with xr.open_datatree(folder / "out" / "results.nc", engine="h5netcdf") as tree:
        assert tree["sweeps/creepage"].heat_flux.attrs["units"] == "W/mm^2"
    again = wearlaw("run", "out/case.toml", "-o", "again")
    assert again.exit_code == 0, again.output
    assert (folder / "again" / "results.nc").read_bytes() == (folder / "out" / "results.nc").read_bytes()
    assert load_case("out/case.toml") == load_case("my.toml")
