"""Cases with stages, with laws of other outcomes than wear, and with laws for one body."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from pydantic import Field

import wearlaw as wl
from tests.cases import POINT, InstallModel, case, load, table, wearlaw
from tests.core import outcome_laws
from tests.core.outcome_laws import Heat, Volume
from tests.core.stages import EXACT, KTH, RIG, predicted, silently

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


class Damage(outcome_laws.Damage):
    """The same law, with a default that the schema can show."""

    threshold: Annotated[wl.Quantity, wl.Unit("N")] = Field(default="15 N", validate_default=True)


@pytest.fixture(autouse=True)
def _laws(install_model: InstallModel) -> None:
    for law in (Damage, Heat):
        install_model(law)


def ran(**changes: Any) -> wl.Study:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", wl.WearlawWarning)
        return wl.run(case(**changes))


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


def test_tables_and_default_figures_are_of_each_outcome() -> None:
    study = ran(**BOTH)
    axes = {figure.name: (figure.panels[0].y.label, figure.panels[0].y.scale) for figure in study.figures}
    assert axes == {
        "creepage_wear_rate_over_creepage": ("wear rate [µg/m/mm²]", "log"),
        "creepage_wear_rate_over_wear_index": ("wear rate [µg/m/mm²]", "log"),
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


def test_a_profile_along_a_line_shows_means_over_the_area_alone() -> None:
    profile = ran(**{**BOTH, "contact_models": ["exact"]}).profiles["partial_slip"]
    assert profile.pair.values.tolist() == ["kth on exact", "damage on exact", "heat on exact"]
    assert "rcf_damage" not in profile
    assert profile.heat_flux.attrs["units"] == "W/mm^2"
    heat = profile.heat_flux.sel(pair="heat on exact")
    point: Any = POINT
    power = abs(profile.traction * profile.slip).sel(contact_model="exact") * 1e-2 * RIG.problem(**point).rolling_speed
    np.testing.assert_allclose(heat, 0.5 * power, rtol=64 * EPS)  # half of it; 1 MPa m/s is 1 W/mm²
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
    _, damage, heat, both = study.figures
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
    labels = [curve.label for curve in with_others.figures[1].panels[0].curves]
    assert labels == ["rcf damage, damage on exact", "stick ratio, exact"]


@pytest.mark.parametrize(
    ("changes", "named"),
    [
        ({"wear_laws": []}, "wear_laws"),
        ({"laws": ["usfd"]}, "laws.0"),
        ({"wear_laws": ["kth", "damage"]}, "wear_laws.1"),
        ({"laws": ["damage", "damage"]}, ""),
        ({"wear_laws": ["usfd", {"model": "kth", "body": "disk_2"}]}, "wear_laws.1.body"),
    ],
)
def test_a_wrong_law_is_named_by_its_path(changes: Any, named: str) -> None:
    with pytest.raises(wl.ConfigurationError) as refusal:
        case(**changes)
    assert [".".join(problem.path) for problem in refusal.value.problems] == [named]


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


def test_one_law_for_one_body_shows_that_body_alone() -> None:
    changes: Any = {**ON_RAILS, "wear_laws": [{"model": "kth", "body": "rail"}]}
    study = ran(**changes)
    assert [pair.label for pair in study.pairs] == ["kth(body=rail) on fastsim"]
    assert "wheel_depth" not in study.profiles["one"]
    one = {"profile": "one", "x": "y", "y": "depth"}
    with pytest.raises(wl.ConfigurationError, match=r"figures\.one\.y: 'depth' cannot be shown"):
        ran(**changes, figures={"one": one})
    assert ran(**changes, figures={"one": {**one, "body": "rail"}}).figures[1].panels[0].curves


# --- The command line ------------------------------------------------------------------------------------------


@pytest.mark.usefixtures("blank_figures")
def test_a_run_writes_and_prints_each_outcome(folder: Path) -> None:
    load(folder, table(**BOTH, stages=["patch_mean"], profiles={}))
    result = wearlaw("run", "my.toml", "-o", "out", "--workers", "1", columns=200)
    assert result.exit_code == 0, result.output
    for outcome in ("wear rate [µg/m/mm²]", "rcf damage [-]", "heat flux [W/mm²]"):
        assert f"Sweep 'creepage': {outcome} by creepage [%]" in result.stdout
    frame = pd.read_csv(folder / "out" / "results.csv")
    assert set(frame.law.dropna()) == {"damage", "heat"}
    assert wl.load_case("out/case.toml") == wl.load_case("my.toml")
