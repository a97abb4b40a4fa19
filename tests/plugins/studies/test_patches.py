"""Cases of rigs whose bodies touch in several places."""

from __future__ import annotations

import json
import warnings
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, ClassVar

import jsonschema  # type: ignore[import-untyped]
import numpy as np
import pandas as pd
import pytest
import xarray

import wearlaw as wl
from tests import cases
from tests.cases import InstallModel, Table, changed, wearlaw
from tests.core import axles
from tests.core.distributions import Install
from tests.core.stages import predicted, silently
from tests.plugins.axle_case import AXLES, EXISTS, FLANGING, MOVED, MOVING, ON_AXLE, PATCHES, SIDES, Axle
from tests.plugins.studies.panels import by_label, by_name, one_panel
from tests.strategies import EPS
from wearlaw import ConfigurationError, Q
from wearlaw_apps.studies import Case

THERE: list[dict[str, Any]] = [
    {"side": "left", "patch": 1}, {"side": "left", "patch": 2}, {"side": "right", "patch": 1},
    {"side": "right", "patch": 2},
]  # fmt: skip
AT_SEVEN = [patch for patch in THERE if patch != {"side": "left", "patch": 2}]
"""The patches at a displacement of 7 mm."""
BY_DISPLACEMENT = {"sweep": "moving", "x": "displacement", "y": "wear_rate"}


@pytest.fixture(autouse=True)
def _axle(install: Install) -> None:
    install(*AXLES)


def ran(**changes: Any) -> wl.Study:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", wl.WearlawWarning)
        return wl.run(Case(**{**ON_AXLE, **changes}))


def small(**changes: Any) -> wl.Study:
    """Run a case of one pair."""
    return ran(**{"contact_models": ["fastsim"], "wear_laws": ["kth"], "profiles": {}, **changes})


def direct(model: str, law: str, **conditions: Any) -> wl.Prediction:
    predict = silently(Axle(), wl.contact_model(model), wl.wear_law(law))
    found: wl.Prediction = predicted(predict, **{**FLANGING, **conditions})
    return found


# --- Numbers ---------------------------------------------------------------------------------------------------------


def test_the_sweep_holds_direct_predictions_and_nan_for_missing_patches() -> None:
    sweep = ran().sweeps["moving"]
    assert sweep.attrs["patch_axes"] == "side patch"
    assert (list(sweep.side.values), list(sweep.patch.values)) == ([*SIDES], [*PATCHES])
    for model, law in (("fastsim", "usfd"), ("polach", "kth")):
        found = direct(model, law, displacement=Q(MOVED, "mm"))
        for name in ("wear_rate", "outside_range", "longitudinal_force", "wear_index", "max_pressure", "normal_force"):
            values = sweep[name]
            values = values.sel(contact_model=model) if "contact_model" in values.dims else values
            values = values.sel(pair=f"{law} on {model}") if "pair" in values.dims else values
            assert values.dims == ("displacement", "side", "patch")
            assert (values.notnull().values == EXISTS).all()
            # the axis of the sweep and that of the direct call may round differently, in sums of a hundred nodes
            expected = getattr(found, name).to(values.attrs["units"] or "").magnitude
            np.testing.assert_allclose(values, expected, rtol=1e-12, err_msg=name)
    for name in ("load", "driving", "friction_coefficient"):
        assert sweep[name].dims == ("displacement",)


def test_results_have_the_creepages_and_the_angle_of_each_patch(install_model: InstallModel) -> None:
    class Inclined(Axle):
        """The axle with flanges at an angle of 60 degrees, where they spin."""

        name: ClassVar[str] = "inclined"

        def problem(self, **conditions: Any) -> wl.Problem:
            """Return the problem with contact angles."""
            found = super().problem(**conditions)
            angle = np.broadcast_to(np.radians([[-1.0, -60.0], [1.0, 60.0]]), found.batch_shape)
            return found.replaced(contact_angle=angle, spin=np.sin(angle) / 0.46)

        @classmethod
        def conditions(cls) -> Mapping[str, wl.Condition]:
            return Axle.conditions()

    install_model(Inclined)
    shown = {"x": "contact_angle", "y": "spin", "sweep": "moving"}
    study = small(rig={"type": "inclined"}, figures={"one": shown})
    sweep = study.sweeps["moving"]
    there = np.where(EXISTS, 1.0, np.nan)
    np.testing.assert_allclose(sweep.contact_angle, there * [[-1.0, -60.0], [1.0, 60.0]], rtol=8 * EPS)
    np.testing.assert_allclose(sweep.spin, np.sin(np.radians(sweep.contact_angle)) / 0.46, rtol=8 * EPS)
    expected = direct("fastsim", "kth", displacement=Q(MOVED, "mm")).creepage.to("%").magnitude
    np.testing.assert_allclose(sweep.creepage, expected, rtol=1e-12)
    assert (sweep.lateral_creepage.values[EXISTS] == 0.0).all()
    assert one_panel(by_name(study)["one"]).x.label == "contact angle [deg]"
    level = small().sweeps["moving"]
    assert "contact_angle" not in level
    assert "creepage" in level


def test_the_mass_lost_can_be_added_over_patches() -> None:
    study = ran(figures={"mass": {**BY_DISPLACEMENT, "y": "mass_per_distance", "pairs": ["kth on fastsim"]}})
    sweep = study.sweeps["moving"]
    expected = direct("fastsim", "kth", displacement=Q(MOVED, "mm")).mass_per_distance.to("ug/m").magnitude
    mass = sweep.mass_per_distance.sel(pair="kth on fastsim")
    np.testing.assert_allclose(mass, expected, rtol=1e-12)
    assert mass.attrs["units"] == "ug/m"
    assert len(one_panel(by_name(study)["mass"]).curves) == 4
    main = one_panel(by_name(study)["main"])
    assert main.y.label == "mass lost per metre rolled [µg/m]"
    for pair, curve in by_label(main).items():
        due = sweep.mass_per_distance.sel(pair=pair).fillna(0.0).sum(["side", "patch"])
        np.testing.assert_allclose(curve.y, due, rtol=8 * EPS)
        outside = sweep.outside_range.sel(pair=pair).max(["side", "patch"]).values > 0.0
        np.testing.assert_array_equal(curve.outside, outside)
    with pytest.raises(wl.ConfigurationError, match=r"figures\.one\.y: 'mass_per_distance' cannot be shown"):
        wl.run(cases.case(figures={"one": {"sweep": "creepage", "x": "creepage", "y": "mass_per_distance"}}))


# --- Figures ---------------------------------------------------------------------------------------------------------


def test_a_figure_has_a_line_for_each_patch_with_gaps_where_there_is_none() -> None:
    study = small(figures={"one": BY_DISPLACEMENT, "force": {**BY_DISPLACEMENT, "y": "longitudinal_force"}})
    wear, force = (by_label(one_panel(by_name(study)[name])) for name in ("one", "force"))
    sweep = study.sweeps["moving"]
    for label, curves in (("kth on fastsim", wear), ("fastsim", force)):
        assert list(curves) == [f"{label}, {side}, patch {patch}" for side in SIDES for patch in PATCHES]
    for patch in THERE:
        label = f"{patch['side']}, patch {patch['patch']}"
        curve = wear[f"kth on fastsim, {label}"]
        np.testing.assert_array_equal(curve.x, MOVED)
        np.testing.assert_array_equal(curve.y, sweep.wear_rate.sel(patch).values[0])
        there = EXISTS[:, SIDES.index(patch["side"]), PATCHES.index(patch["patch"])]
        assert (np.isfinite(curve.y) == there).all()
        np.testing.assert_array_equal(force[f"fastsim, {label}"].y, sweep.longitudinal_force.sel(patch).values[0])
    assert force["fastsim, right, patch 1"].y.min() < 0.0, "values keep their signs"
    assert [curve.colour for curve in wear.values()] == [curve.colour for curve in force.values()] == [0, 1, 2, 3]
    assert {curve.dash for curve in wear.values()} == {0}


def test_with_several_pairs_colours_are_of_patches_and_line_styles_of_pairs() -> None:
    study = ran(figures={"one": BY_DISPLACEMENT, "few": {**BY_DISPLACEMENT, "patches": {"patch": 2}}})
    every, few = (by_name(study)[name] for name in ("one", "few"))
    curves = one_panel(every).curves
    assert len(curves) == 16
    assert [curve.colour for curve in curves] == [number for number in range(4) for _ in range(4)]
    assert [curve.dash for curve in curves] == [0, 1, 2, 3] * 4
    assert {curve.label: curve.colour for curve in one_panel(few).curves} == {
        curve.label: curve.colour for curve in curves if curve.label.endswith("patch 2")
    }


def test_a_strip_shows_where_a_shown_patch_is_beyond_shakedown() -> None:
    heavy = {**MOVING, "load": "1500 kN"}
    tread, flange = ({**BY_DISPLACEMENT, "patches": {"side": "right", "patch": patch}} for patch in PATCHES)
    study = small(sweeps={"moving": heavy}, figures={"tread": tread, "flange": flange})
    sweep = study.sweeps["moving"]
    on_tread, on_flange = (one_panel(by_name(study)[name]).shades for name in ("tread", "flange"))
    beyond = (sweep.max_pressure > sweep.shakedown_limit).sel(side="right", contact_model="fastsim")
    assert beyond.sel(patch=1).all()
    assert not beyond.sel(patch=2).any()
    assert on_tread[0].spans == ((-7.0, 7.0),)
    assert on_flange == ()


# --- Profiles --------------------------------------------------------------------------------------------------------


def test_a_profile_has_the_wear_across_each_patch() -> None:
    study = ran()
    profile = study.profiles["flanging"]
    assert profile.wheel_depth.dims == ("pair", "side", "patch", "node")
    for patch in AT_SEVEN:
        expected = direct("fastsim", "kth").sel(**patch).wear_profile("wheel", strips=101)
        here = profile.sel(patch)
        np.testing.assert_array_equal(here.wheel_depth.sel(pair="kth on fastsim"), expected.depth)
        np.testing.assert_array_equal(here.y.sel(contact_model="fastsim"), expected.y)
    assert profile.wheel_depth.sel(side="left", patch=2).isnull().all()
    figure = by_name(study)["flanging_across_the_patch"]
    wheel = by_label(figure.panels[0])
    labels = [f"{patch['side']}, patch {patch['patch']}" for patch in AT_SEVEN]
    assert list(wheel) == [f"{law} on fastsim, {label}" for label in labels for law in ("usfd", "kth")]
    assert [curve.colour for curve in wheel.values()] == [0, 0, 2, 2, 3, 3], "as in figures of sweeps"
    curve = wheel["kth on fastsim, right, patch 2"]
    place = {"side": "right", "patch": 2}
    np.testing.assert_array_equal(curve.y[1:-1], profile.wheel_depth.sel({"pair": "kth on fastsim", **place}))
    np.testing.assert_array_equal(curve.x[1:-1], profile.y.sel({"contact_model": "fastsim", **place}))


@pytest.mark.parametrize("hertzian", [True, False])
def test_a_profile_has_the_places_of_patches_on_the_bodies(install_model: InstallModel, hertzian: bool) -> None:
    install_model(axles.Placed)
    given: Table = {
        "load": "80 kN",
        "displacement": "7 mm",
        "longitudinal_creepage": "0.2 %",
        "spin": "0.3 1/m",
        "friction_coefficient": 0.3,
    }
    rig = {"type": "placed", "hertzian": hertzian}
    sweeps = {"moving": {**given, "displacement": ["0 mm", "7 mm"]}}
    study = small(rig=rig, sweeps=sweeps, profiles={"flanging": given})
    profile = study.profiles["flanging"].sel(side="right", patch=2)
    predict: Any = axles.Placed(hertzian=hertzian) | wl.contact_model("fastsim") | wl.wear_law("kth")
    one = predict(**given).sel(side="right", patch=2)
    for body in ("wheel", "rail"):
        expected = one.wear_profile(body, strips=101)
        np.testing.assert_array_equal(profile[f"{body}_depth"].values[0], expected.depth)
        np.testing.assert_array_equal(profile[f"{body}_profile_position"].values[0], expected.profile_position)
    assert profile.sizes["node"] == (101 if hertzian else axles.STRIPS)
    shown = by_label(by_name(study)["flanging_across_the_patch"].panels[1])["kth on fastsim, right, patch 2"]
    np.testing.assert_array_equal(shown.y[1:-1], profile.rail_depth.values[0])
    together = study.sweeps["moving"].mass_per_distance.sum(("side", "patch"))
    assert (together > 0.0).all()


class Strings(wl.Rig):
    """Two pairs of discs on one axle, of which the second may be lifted off."""

    name: ClassVar[str] = "strings"

    def problem(self, *, creepage: wl.QuantityLike, lift: wl.QuantityLike) -> wl.Problem:
        """Return the problem of both."""
        lifted = wl.Unit("mm", positive=False).si(lift, "lift")[..., None] > 0.0
        slip = wl.Unit("", positive=False).si(creepage, "creepage")[..., None]
        exists = ~lifted | np.array([True, False])
        found = wl.TwinDisc.suros().problem(
            creepage=Q(slip * np.ones(exists.shape), ""), max_pressure="1.5 GPa", friction_coefficient=0.46
        )
        return found.replaced(dims={"disc": (1, 2)}, exists=np.broadcast_to(exists, found.batch_shape).copy())


def test_patches_of_lines_have_profiles_along_them(install_model: InstallModel) -> None:
    install_model(Strings)
    down, up = ({"creepage": "0.5 %", "lift": lift} for lift in ("0 mm", "1 mm"))
    fields: Table = {
        "title": "Discs",
        "rig": {"type": "strings"},
        "contact_models": ["exact"],
        "wear_laws": ["kth"],
        "sweeps": {"lifting": {**down, "lift": ["0 mm", "1 mm"]}},
        "profiles": {"down": down, "up": up},
    }
    study = wl.run(Case(**fields))
    lifting = study.sweeps["lifting"].wear_rate.values[0]
    assert lifting[0, 0] == lifting[0, 1] == lifting[1, 0]
    assert np.isnan(lifting[1, 1])
    traction = study.profiles["down"].traction.sel(contact_model="exact")
    expected = (wl.TwinDisc.suros() | wl.contact_model("exact"))(
        creepage="0.5 %", max_pressure="1.5 GPa", friction_coefficient=0.46
    ).profile.traction
    np.testing.assert_array_equal(traction.sel(disc=2), expected)
    assert study.profiles["up"].traction.sel(disc=2).isnull().all()
    shown = by_label(by_name(study)["up_along_the_patch"].panels[0])
    assert list(shown) == ["pressure p, disc 1", "traction q, exact, disc 1", "traction bound, exact, disc 1"]


class Twins(wl.Rig):
    """Two pairs of discs at a time, with the conditions of one."""

    name: ClassVar[str] = "twins"

    def problem(self, *, normal_force: wl.QuantityLike, creepage: wl.QuantityLike, friction_coefficient: Any) -> Any:
        """Return the problem of both."""
        force, slip = wl.Unit("N").si(normal_force, "normal_force"), wl.Unit("").si(creepage, "creepage")
        both = wl.TwinDisc.suros().problem(
            normal_force=Q(force[..., None] * np.ones(2), "N"),
            creepage=Q(slip[..., None] * np.ones(2), ""),
            friction_coefficient=np.asarray(friction_coefficient)[..., None],
        )
        return both.replaced(dims={"pair": (1, 2)})


def test_tests_of_one_contact_are_not_of_a_rig_with_several(install_model: InstallModel) -> None:
    install_model(Twins)
    given = {"normal_force": "6 kN", "creepage": ["0.5 %", "1 %"], "friction_coefficient": 0.4}
    fields: Table = {
        "title": "Discs", "rig": {"type": "twins"}, "contact_models": ["exact"], "wear_laws": ["kth"],
        "sweeps": {"slip": given},
    }  # fmt: skip
    assert Case(**fields).rig.name == "twins"
    with pytest.raises(ConfigurationError, match=r"measured: the tests are of one line contact, but rig 'twins' makes"):
        Case(**{**fields, "measured": {"label": "Lewis", "tests": "lewis2004"}})


# --- Rigs that balance their loads -----------------------------------------------------------------------------------


class Leaning(Axle):
    """The axle, with a normal force that falls by the longitudinal force."""

    name: ClassVar[str] = "leaning"

    def balanced(self, problem: wl.Problem, forces: Callable[[wl.Problem], wl.CreepForces]) -> wl.Problem:
        """Return the problem with the load of one step."""
        return problem.with_normal_force(problem.normal_force - np.abs(forces(problem).longitudinal))


def test_balanced_loads_belong_to_the_contact_model(install_model: InstallModel) -> None:
    install_model(Leaning)
    study = ran(rig={"type": "leaning"}, wear_laws=["kth"])
    for model in ("fastsim", "polach"):
        found = predicted(silently(Leaning(), wl.contact_model(model), wl.wear_law("kth")), **FLANGING)
        point = study.sweeps["flanging"]
        for name in ("normal_force", "max_pressure", "semi_axis_a"):
            expected = getattr(found, name).to(point[name].attrs["units"]).magnitude
            np.testing.assert_allclose(point[name].sel(contact_model=model), expected, rtol=1e-12)
        np.testing.assert_allclose(point.wear_rate.sel(pair=f"kth on {model}"), found.wear_rate.magnitude, rtol=1e-12)
    loads = study.sweeps["flanging"].normal_force
    assert (loads.sel(contact_model="fastsim") != loads.sel(contact_model="polach")).sum() == 4  # NaN differs too
    fastsim: Any = Leaning() | wl.contact_model("fastsim") | wl.wear_law("kth")
    right = fastsim(**FLANGING).sel(side="right", patch=1).wear_profile("wheel", strips=101)
    profile = study.profiles["flanging"].sel(side="right", patch=1, pair="kth on fastsim")
    np.testing.assert_array_equal(profile.wheel_depth, right.depth)


# --- The command line ------------------------------------------------------------------------------------------------


@pytest.mark.usefixtures("folder")
def test_a_case_runs_from_the_command_line_and_again_from_what_it_wrote() -> None:
    content: Table = {**ON_AXLE, "figures": {"one": {**BY_DISPLACEMENT, "patches": {"side": "right", "patch": [1, 2]}}}}
    cases.write(Path("c.toml"), content)
    schema = jsonschema.Draft202012Validator(json.loads(wearlaw("schema").stdout))
    schema.validate(content)
    assert not schema.is_valid(changed("figures.one.patches", ["right"], content))
    done = wearlaw("run", "c.toml", "-o", "out")
    assert done.exit_code == 0, done.output
    assert "kth on fastsim, right, patch 2" in done.stdout
    assert "nan" not in done.stdout
    page = Path("out/report.html").read_text(encoding="utf-8")
    assert "kth on polach, left, patch 2" in page
    assert wl.load_case("out/case.toml") == wl.load_case("c.toml")
    assert wearlaw("run", "out/case.toml", "-o", "again").exit_code == 0
    assert Path("out/results.csv").read_bytes() == Path("again/results.csv").read_bytes()
    rows = pd.read_csv("out/results.csv")
    assert list(rows.columns[:5]) == ["sweep", "contact_model", "wear_law", "side", "patch"]
    moving = rows[(rows.sweep == "moving") & (rows.contact_model == "polach") & (rows.wear_law == "kth")]
    places = np.argwhere(EXISTS)
    assert moving["displacement [mm]"].tolist() == MOVED[places[:, 0]].tolist()
    assert moving["side"].tolist() == [SIDES[place] for place in places[:, 1]]
    assert moving["patch"].tolist() == [PATCHES[place] for place in places[:, 2]]
    assert len(rows) == 4 * (EXISTS.sum() + 3)
    with xarray.open_dataset("out/results.nc", group="sweeps/moving", engine="h5netcdf") as read:
        np.testing.assert_array_equal(
            moving["wear_rate [ug/m/mm^2]"], read.wear_rate.sel(pair="kth on polach").values[EXISTS]
        )
    frame = pd.read_csv("out/tables/wear_rate_moving.csv")
    assert len(frame) == 2 * 4 * (1 + 3)  # models, patches, and laws with the ends of the band of kth
    assert frame.isna().sum().sum() == len(frame) // 2 * 4  # a flange touches at one of the five displacements
    mass = pd.read_csv("out/tables/mass_per_distance_moving.csv", index_col=0)
    with xarray.open_dataset("out/results.nc", group="sweeps/moving", engine="h5netcdf") as read:
        together = read.mass_per_distance.sum(["side", "patch"])
        for pair in read.pair.values:  # one row each, the sum over all patches
            np.testing.assert_allclose(mass.loc[pair], together.sel(pair=pair), rtol=1e-12)
    assert list(mass.index) == list(together.pair.values)
