"""The life of a wheel: removal, conservation of mass, measures, the loop, its errors and its store."""

from __future__ import annotations

import shutil
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

import wearlaw as wl
from tests.plugins.wheelset.wheelsets import R0, cone, round_head, wheelset
from wearlaw import Q
from wearlaw.errors import DataError, OutputError, ResumeWarning
from wearlaw_apps.life import Life
from wearlaw_apps.life.line import Line  # private: a step that fails
from wearlaw_apps.life.removal import (  # private: the parts of a step in closed form
    between,
    conserving,
    even,
    positions,
    removed,
    shared,
    smoothed,
    swept,
    widths,
)
from wearlaw_apps.life.steps import Limits  # private: the limits alone
from wearlaw_apps.output import Limit
from wearlaw_apps.sweeps.sweep import run  # private: the warnings of a step
from wearlaw_apps.sweeps.wear_profile import REMEDY  # private: a state without result

GIVEN: dict[str, Any] = {"vertical_load": "60 kN", "friction_coefficient": 0.3}

pytestmark = pytest.mark.filterwarnings("ignore::wearlaw.RangeWarning", "ignore::wearlaw.CalibrationWarning")


def pipeline(**changed: Any) -> wl.Pipeline[...]:
    rig = wheelset(**changed)
    return rig | wl.contact_model("fastsim") | wl.wear_law("usfd", fitted_for="fastsim")


def line(count: int = 5, spread: float = 1.5) -> pd.DataFrame:
    """Return displacements that are symmetric about the middle of the track, with normal shares."""
    displacement = np.linspace(-2.0 * spread, 2.0 * spread, count)
    share = np.exp(-0.5 * (displacement / spread) ** 2)
    return pd.DataFrame({"lateral_displacement [mm]": displacement, "share": share / share.sum()})


def last(life: Life, column: str) -> float:
    """Return a measure at the end."""
    return float(life.table[column].iloc[-1])


@pytest.fixture(scope="module")
def short() -> Life:
    """A life of a few steps."""
    return wl.wear_out(pipeline(), line(), over="1500 km", **GIVEN)


def test_cone_worn_evenly_is_a_cone() -> None:
    start = even(cone(0.05))
    worn = removed(start, np.full(start.curve.s.size, 0.3e-3))
    angle = np.arctan(0.05)
    assert worn.curve.angle == pytest.approx(-angle, abs=1e-9)
    at_middle = np.interp(0.0, worn.curve.y, worn.curve.z)
    assert at_middle == pytest.approx(-0.3e-3 / np.cos(angle), abs=1e-12)


def test_circle_worn_evenly_along_its_normal_is_a_circle() -> None:
    start = even(round_head(80e-3))
    for step in range(1, 4):
        start = removed(start, np.full(start.curve.s.size, 0.2e-3))
        radius = np.hypot(start.curve.y, start.curve.z - 80e-3)
        assert radius == pytest.approx(80e-3 - step * 0.2e-3, abs=1e-9)


def test_what_is_unusual_about_a_wheel_is_said_once_a_life() -> None:
    with pytest.warns(wl.UnusualWarning, match="flange_back_position is -60 mm"):
        predict = pipeline(flange_back_position="-60 mm")
    with warnings.catch_warnings(record=True, action="always") as given:
        life = wl.wear_out(predict, line(3), over="300 km", depth_step="5e-5 mm", **GIVEN)
    assert len(life.table) > 3
    assert [str(one.message)[:20] for one in given if one.category is wl.UnusualWarning] == ["flange_back_position"]


def test_volume_between_two_cones_is_that_of_frustums() -> None:
    """A cone worn by d along its normal: Pappus's theorem on the parallelogram between the two lines."""
    start, depth, slope = even(cone(0.05)), 0.1e-3, 0.05
    worn = removed(start, np.full(start.curve.s.size, depth))
    length = np.ptp(start.curve.s)
    centroid = R0 - 0.5 * depth * np.cos(np.arctan(slope))
    assert swept(start, worn, R0) == pytest.approx(2.0 * np.pi * centroid * depth * length, rel=1e-9)
    assert swept(start, worn) == pytest.approx(depth * length, rel=1e-9)


def test_smoothing_keeps_the_sum_and_has_its_length() -> None:
    at = np.linspace(0.0, 60e-3, 601)
    depth = np.zeros(601)
    depth[[40, 300]] = 1.0, 2.0
    (found,) = smoothed(depth[None], at, np.full((1, 601), 2e-3))
    assert found.sum() == pytest.approx(3.0, rel=1e-12)
    peak = found[200:400] / found[200:400].sum()
    spread = np.sqrt((peak * (at[200:400] - at[300]) ** 2).sum())
    assert spread == pytest.approx(2e-3, rel=1e-3)


def test_kernels_are_as_wide_as_patches_are_apart_but_on_flanges() -> None:
    """For n patches that are g apart the standard deviation is g √((n² - 1)/12)."""
    at = np.linspace(-20e-3, 40e-3, 601)
    places, angle = np.zeros((1, 601)), np.zeros((1, 601))
    places[0, 100:401:25] = 1.0  # 13 of them, 2.5 mm apart
    distance = 2.5e-3 * np.sqrt(168.0) / 13.0
    assert widths(places, at, angle, 3e-3, 0.0) == pytest.approx(distance, rel=1e-9)
    assert widths(places, at, angle, 1e-3, 0.25e-3) == pytest.approx(np.hypot(1e-3, 0.25e-3), rel=1e-9)
    for steep, share in ((10.0, 0.75), (30.0, 0.0), (-70.0, 0.0)):
        found = widths(places, at, np.radians(angle + steep), 3e-3, 0.0)
        assert found == pytest.approx(share * distance, abs=1e-12)
    single = np.where(np.arange(601) == 300, 1.0, 0.0)[None]
    assert widths(single, at, angle, 3e-3, 0.25e-3) == pytest.approx(0.25e-3, rel=1e-9)


def test_a_rail_that_cuts_into_a_flank_leaves_no_edge() -> None:
    """A corner of radius r = 13 mm that cuts h deep makes a flank of 70° steeper by √(2 h/r) = 18°, less smoothing."""
    profile = new = even(wl.Profile.s1002())
    at = positions([new], int(np.ceil(np.ptp(new.curve.s) / 0.1e-3)) + 1)
    middle, radius, steps = -43.2e-3, 13e-3, 13
    away, slopes = at - middle, []
    for edges in (True, False):
        profile = new
        for step in range(steps):
            # The arc moves evenly. Its depth is a parabola.
            whole = np.maximum(0.65e-3 * (step + 1) / steps - 0.5 * away**2 / radius, 0.0)
            before = np.maximum(0.65e-3 * step / steps - 0.5 * away**2 / radius, 0.0)
            (smooth,) = smoothed((whole - before)[None], at, np.full((1, at.size), 0.4e-3))
            depth = between(profile, at, smooth)
            worn = shared(profile, depth, 0.4e-3) if edges else depth
            assert worn.sum() == pytest.approx(depth.sum(), rel=1e-9)
            profile, _ = conserving(profile, worn, 2.0 * np.pi * R0 * float(np.trapezoid(smooth, at)), R0)
        slopes.append(float(np.degrees(-profile.curve.angle[profile.curve.y < 0.0].min())))
    print(f"steepest slopes {slopes}")
    assert slopes[0] < 82.0
    assert slopes[1] > 84.0
    tread = np.exp(-0.5 * ((new.curve.s + 10e-3) / 5e-3) ** 2) * 0.05e-3
    assert shared(new, tread, 0.4e-3) is tread


def test_wear_at_the_end_of_a_long_steep_flank_makes_nothing_steeper() -> None:
    """A flank that gave up wear by its slope at each point had ripples, which grew beyond 86°."""
    profile = even(wl.Profile.s1002())
    steepest = 0.0
    for step in range(65):
        curve = profile.curve
        tip = int(np.argmax(curve.z))
        place = tip + int(np.argmax(curve.z[tip:] < (15e-3 if step < 40 else 14e-3)))
        depth = 0.04e-3 * np.exp(-0.5 * ((curve.s - curve.s[place]) / 0.8e-3) ** 2)
        volume = 2.0 * np.pi * R0 * float(np.trapezoid(depth, curve.s))
        worn, _ = conserving(profile, shared(profile, depth, 0.8e-3), volume, R0)
        assert swept(profile, worn, R0) == pytest.approx(volume, rel=1e-10)
        profile = worn
        steepest = max(steepest, float(np.degrees(-profile.curve.angle[profile.curve.y < 0.0].min())))
    print(f"steepest slope {steepest:.2f}")
    assert 80.0 < steepest < 84.0


def test_one_factor_makes_the_mass_exact_on_a_flange() -> None:
    """In the root of the flange, of radius 13 mm, removal along the normal alone misses by depth/2 × curvature."""
    start = even(wl.Profile.s1002())
    depth = 0.1e-3 * np.exp(-0.5 * ((start.curve.s + 37e-3) / 2e-3) ** 2)
    volume = 2.0 * np.pi * R0 * float(np.trapezoid(depth, start.curve.s))
    worn, factor = conserving(start, depth, volume, R0)
    assert abs(factor - 1.0) > 1e-3
    assert swept(start, worn, R0) == pytest.approx(volume, rel=1e-10)


def test_mass_removed_is_mass_predicted(short: Life) -> None:
    """Before its factor, each step is within 1e-3; after it, the sum of all steps is exact."""
    assert abs(short.table["factor"] - 1.0).max() < 1e-3
    volume = swept(short.worn_profiles[0][0], short.profile, R0)
    density = short.pipeline.rig.bodies["wheel"].material.density.m_as("kg/m^3")
    assert volume * density == pytest.approx(last(short, "mass [kg]"), rel=1e-10)


def test_mass_of_the_first_step_is_that_of_the_prediction() -> None:
    states = line(3)
    found = wl.wear_out(pipeline(), states, over="10 km", **GIVEN)
    r = pipeline()(lateral_displacement=Q(states.iloc[:, 0].to_numpy(), "mm"), **GIVEN)
    mass = states["share"].to_numpy() @ np.nansum(r.mass_lost("10 km", "wheel").m_as("kg"), axis=-1)
    assert found.table[["mass_left [kg]", "mass_right [kg]"]].iloc[-1].to_numpy() == pytest.approx(mass, rel=1e-9)
    assert last(found, "mass [kg]") == pytest.approx(mass.mean(), rel=1e-9)


def test_first_step_wears_the_weighted_sum_of_the_states() -> None:
    states = line(3)
    found = wl.wear_out(pipeline(), states, over="10 km", smoothing="0 mm", resolution="0 mm", **GIVEN)
    (first,) = found.worn_profiles[0]
    at = positions([first], int(np.ceil(np.ptp(first.curve.s) / 0.1e-3)) + 1)
    r = pipeline()(lateral_displacement=Q(states.iloc[:, 0].to_numpy(), "mm"), **GIVEN)
    depth = r.wear_profile("wheel", at=Q(1e3 * at, "mm"))["depth"].mean("side").values
    expected = 10e3 * states["share"].to_numpy() @ depth * 1e-9 * last(found, "factor")  # um/km
    worn = first.depth_to(found.profile, Q(1e3 * at, "mm")).m_as("m")
    assert worn == pytest.approx(expected, abs=2e-3 * expected.max())


def test_a_turned_vehicle_wears_the_mean_of_both_sides() -> None:
    one_sided = line()
    one_sided.iloc[:, 0] += 2.0
    found = wl.wear_out(pipeline(), one_sided, over="10 km", **GIVEN)
    left, right, mean = (last(found, f"mass{side} [kg]") for side in ("_left", "_right", ""))
    assert right > 1.2 * left
    assert mean == pytest.approx(0.5 * (left + right), rel=1e-9)


def test_each_side_wears_for_itself_and_alike_on_a_symmetric_line(short: Life) -> None:
    found = wl.wear_out(pipeline(), line(), over="1500 km", sides="each", **GIVEN)
    table, (left, right) = found.table, found.worn_profiles[-1]
    # The mirrored states differ by rounding, which moves contact points by up to 2e-9 m (`wheelset/test_positions`).
    assert table["depth_left [mm]"].to_numpy() == pytest.approx(table["depth_right [mm]"].to_numpy(), rel=1e-6)
    assert left.points[1].magnitude == pytest.approx(right.points[1].magnitude, abs=1e-6)
    mean = short.table
    assert len(table) == len(mean)
    assert table["mass_left [kg]"].to_numpy() == pytest.approx(mean["mass [kg]"].to_numpy(), rel=1e-6)
    assert found.profiles.sizes["side"] == 2
    assert "right wheel, wear × " in found.figure().panels[3].title


def test_a_line_of_right_hand_curves_wears_its_sides_differently() -> None:
    one_sided = line()
    one_sided.iloc[:, 0] += 2.0
    found = wl.wear_out(pipeline(), one_sided, over="1000 km", sides="each", until={"depth": "0.04 mm"}, **GIVEN)
    assert last(found, "mass_right [kg]") > 1.2 * last(found, "mass_left [kg]")
    assert found.ended == "depth_right"
    assert last(found, "depth_right [mm]") == pytest.approx(0.04, rel=1e-5)
    for side, first, worn in zip(("left", "right"), found.worn_profiles[0], found.worn_profiles[-1], strict=True):
        assert swept(first, worn, R0) * 7850.0 == pytest.approx(last(found, f"mass_{side} [kg]"), rel=1e-10)
    rig = found.pipeline.rig
    assert (rig.left_wheel, rig.wheel) == found.worn_profiles[-1]  # type: ignore[attr-defined]


def test_a_pair_of_unlike_wheels_has_no_mean() -> None:
    unlike = pipeline(left_wheel=wl.Profile.s1002())
    with pytest.raises(wl.InputError, match="'each'"):
        wl.wear_out(unlike, line(3), over="10 km", **GIVEN)


def test_several_processes_give_the_same_life(tmp_path: Path, short: Life, monkeypatch: pytest.MonkeyPatch) -> None:
    """From a file, in blocks of a few states."""
    monkeypatch.setattr("wearlaw_apps.sweeps.points.BLOCK", 2500)  # private: small blocks
    line().to_csv(tmp_path / "line.csv", index=False)
    lives = [
        wl.wear_out(pipeline(), tmp_path / "line.csv", over="500 km", workers=workers, **GIVEN) for workers in (1, 2)
    ]
    assert lives[0].table.equals(lives[1].table)
    assert lives[0].table["mass [kg]"][1] == pytest.approx(short.table["mass [kg]"][1], rel=1e-12)


def test_a_cluster_gives_the_same_life(short: Life, monkeypatch: pytest.MonkeyPatch) -> None:
    distributed = pytest.importorskip("distributed")
    monkeypatch.setattr("wearlaw_apps.sweeps.points.BLOCK", 2500)  # private: small blocks
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=":0") as machines,
        distributed.Client(machines) as client,
    ):
        found = wl.wear_out(pipeline(), line(), over="500 km", client=client, **GIVEN)
    assert found.table["mass [kg]"][1] == pytest.approx(short.table["mass [kg]"][1], rel=1e-12)
    assert found.table["distance [km]"].iloc[-1] == pytest.approx(500.0)


def test_result_has_a_table_profiles_and_a_picture(short: Life) -> None:
    table = short.table
    assert table["distance [km]"].iloc[[0, -1]].tolist() == pytest.approx([0.0, 1500.0])
    assert short.ended == "over"
    assert table["mass_left [kg]"].to_numpy() == pytest.approx(table["mass_right [kg]"].to_numpy(), rel=1e-9)
    assert abs(table["equivalent_conicity"].diff()).max() <= 0.005
    profiles = short.profiles
    assert dict(profiles.sizes) == {"distance": len(table), "side": 1, "place": 601}
    assert profiles["depth"].max() == pytest.approx(table["depth [mm]"].iloc[-1], rel=1e-3)
    assert profiles["depth"].attrs["units"] == "mm"
    area = np.trapezoid(profiles["depth"].isel(distance=-1, side=0), profiles["place"])
    assert last(short, "worn_area [mm^2]") == pytest.approx(area, rel=1e-2)
    worn = profiles.isel(distance=-1, side=0)
    y, curve = worn["y"].values, short.profile.curve
    tread, there = y > -34.0, curve.y > -35e-3
    z = np.interp(y[tread], 1e3 * curve.y[there], 1e3 * curve.z[there])
    assert worn["z"].values[tread] == pytest.approx(z, abs=3e-5)  # 0.025²/(2 R) mm between points, with R = 13 mm
    assert "1500 km" in repr(short)
    drawn, normal, measures = short.figure().panels
    assert normal.title == "wheel, wear along the normal"
    assert drawn.equal
    for line in drawn.curves:  # each runs across the whole profile
        assert (line.x.min(), line.x.max()) == pytest.approx((-70.0, 60.0), abs=0.1)
    assert measures.y.label == "change [mm]"
    assert [curve.label for curve in measures.curves] == ["depth", "flange thickness", "diameter"]
    assert measures.curves[2].y == pytest.approx(table["diameter [mm]"].to_numpy() - 920.0)
    legends = [axes.get_legend() for axes in short.plot().axes]
    distances = [f"{table['distance [km]'].iloc[place]:.0f} km" for place in (0, 2, 3, 5)]
    names = [[text.get_text() for text in legend.get_texts()] for legend in legends if legend]
    assert names == [distances, distances, ["depth", "flange thickness", "diameter"]]


def test_life_ends_at_a_limit() -> None:
    found = wl.wear_out(pipeline(), line(3), over="10000 km", until={"depth": "0.02 mm"}, **GIVEN)
    *_, measures = found.figure().panels
    assert (measures.y.label, measures.limits) == ("way to the limit [%]", (Limit("limit", 100.0),))
    (depth,) = measures.curves
    assert depth.label == "depth, 0 to 0.02 mm"
    assert depth.y == pytest.approx(found.table["depth [mm]"].to_numpy() / 0.02 * 100.0)
    assert found.ended == "depth"
    assert last(found, "depth [mm]") == pytest.approx(0.02, rel=1e-5)


def test_rails_wear_by_passages() -> None:
    one_sided = line(3)
    one_sided.iloc[:, 0] += 2.0
    found = wl.wear_out(pipeline(), one_sided, over=2e4, body="rail", sides="each", **GIVEN)
    assert last(found, "passages") == 2e4
    assert last(found, "mass_right [kg]") > 1.2 * last(found, "mass_left [kg]")
    for side, new, worn in zip(("left", "right"), found.worn_profiles[0], found.worn_profiles[-1], strict=True):
        assert worn.kind == "rail"
        assert last(found, f"mass_{side} [kg]") == pytest.approx(swept(new, worn) * 7850.0, rel=1e-2)


def test_rollers_wear_over_a_distance() -> None:
    predict = pipeline(roller_radius="350 mm")
    found = wl.wear_out(predict, line(3), over="200 km", body="rail", **GIVEN)
    assert last(found, "distance [km]") == 200.0
    (new,), (worn,) = found.worn_profiles[0], found.worn_profiles[-1]
    # The surfaces of revolution of both, by Guldin's rule on their radii R - z.
    y = 1e-3 * np.linspace(-36.0, 36.0, 20001)
    radii = [0.35 - np.interp(y, profile.curve.y, profile.curve.z) for profile in (new, worn)]
    lost = np.pi * np.trapezoid(radii[0] ** 2 - radii[1] ** 2, y)
    # Straight lines between points 0.05 mm apart on radii of 13 mm and more cut off (0.05 mm)²/8/13 mm on both alike.
    assert last(found, "mass [kg]") == pytest.approx(7850.0 * lost, rel=1e-3)


def test_line_may_be_a_file_with_its_own_heads(tmp_path: Path) -> None:
    table = line(3)
    table.columns = ["y [mm]", "part [%]"]
    table["part [%]"] *= 100.0
    table.to_csv(tmp_path / "line.csv", index=False)
    columns = {"lateral_displacement": "y [mm]"}
    found = wl.wear_out(pipeline(), tmp_path / "line.csv", share="part [%]", columns=columns, over="10 km", **GIVEN)
    same = wl.wear_out(pipeline(), line(3), over="10 km", **GIVEN)
    assert last(found, "mass [kg]") == pytest.approx(last(same, "mass [kg]"), rel=1e-9)


def changed(**columns: Any) -> pd.DataFrame:
    table = line(3)
    for name, values in columns.items():
        table[{"y": "lateral_displacement [mm]"}.get(name, name)] = values
    return table


@pytest.mark.parametrize(
    ("states", "options", "error", "named"),
    [
        (changed(share=[0.2, 0.5, 0.2]), {}, DataError, "add up to 0.9"),
        (changed(share=[20.0, 60.0, 20.0]), {}, DataError, "percent"),
        (changed(share=[-0.2, 1.0, 0.2]), {}, DataError, "row 0"),
        (line(3).drop(columns="share"), {}, DataError, "share"),
        (line(3).set_axis(["lateral_displacement", "share"], axis=1), {}, wl.UnitError, "lateral_displacement"),
        (
            changed(y=[0.0, 1.0, 7.0]),
            {},
            DataError,
            r"^step 1, after 0 km: .*row 2 .*lateral_displacement = 7 mm.*climbs",
        ),
        (changed(y=[-7.0, 1.0, 7.0]), {}, DataError, r"row 0 .*lateral_displacement = -7 mm.*climbs"),
        (changed(**{"rolling_speed [m]": 20.0}), {}, wl.UnitError, "rolling_speed"),
        (changed(gauge=1.5), {}, wl.ConditionsError, "gauge: is a field of rig 'wheelset'"),
        (changed(**{"yaww [mrad]": 0.0}), {}, wl.ConditionsError, "yaww.*did you mean 'yaw'"),
        (changed(y=[0.0, 60.0, 1.0]), {}, DataError, r"row 1 .*60 mm"),
        (line(3), {"over": "100"}, wl.UnitError, "over"),
        (line(3), {"depth_step": "0.2 mm"}, wl.InputError, "depth_step"),
        (line(3), {"until": {"flange": "25 mm"}}, wl.InputError, "limit: .*'flange'"),
        (line(3), {"until": {"flange_thickness": 25.0}}, wl.UnitError, "flange_thickness"),
        (line(3), {"body": "rail", "over": 10.0, "until": {"hollow": "1 mm"}}, wl.InputError, "has no 'hollow'"),
        (line(3), {"until": {"flange_thickness": "33 mm"}}, wl.InputError, r"must lie below .*, 32\.5 mm; got '33 mm'"),
        (line(3), {"until": {"flange_gradient": "11 mm"}}, wl.InputError, "flange_gradient: must lie below"),
        (line(3), {"until": {"flange_height": "27.9 mm"}}, wl.InputError, "flange_height: must lie above"),
        (line(3), {"body": "axle"}, wl.InputError, "body"),
        (line(3), {"body": "rail"}, wl.InputError, "passages"),
    ],
)
def test_mistakes_name_row_value_and_remedy(
    states: pd.DataFrame, options: dict[str, Any], error: type[Exception], named: str
) -> None:
    with pytest.raises(error, match=named):
        wl.wear_out(pipeline(), states, **{"over": "10 km", **GIVEN, **options})


def test_limits_lie_on_the_side_to_which_a_measure_wears() -> None:
    """The conicity has two such sides."""
    start = {"distance [km]": 0.0, "flange_thickness_left [mm]": 30.0, "flange_thickness_right [mm]": 32.5}
    start["equivalent_conicity"] = 0.18
    for conicity in (0.17, 0.19):
        limits = Limits({"flange_thickness": "28 mm", "equivalent_conicity": conicity}, 10.0, start)
        assert limits.reached({**start, "equivalent_conicity": conicity}) == "equivalent_conicity"
        assert limits.reached({**start, "flange_thickness_right [mm]": 28.0}) == "flange_thickness_right"
    for name, limit in (("flange_thickness", wl.Q(31.0, "mm")), ("equivalent_conicity", wl.Q(0.18, ""))):
        with pytest.raises(wl.InputError, match=name):
            Limits({name: limit}, 10.0, start)


def test_columns_that_are_no_conditions_are_ignored_with_a_word(tmp_path: Path) -> None:
    table = changed(**{"distance [km]": 1.0, "track": "A"})
    table.to_csv(tmp_path / "line.csv", index=False, sep=";", decimal=",")
    with pytest.warns(wl.WearlawWarning, match=r"ignored columns 'distance \[km\]', 'track'"):
        found = wl.wear_out(pipeline(), tmp_path / "line.csv", over="10 km", sep=";", decimal=",", **GIVEN)
    same = wl.wear_out(pipeline(), line(3), over="10 km", **GIVEN)
    assert last(found, "mass [kg]") == pytest.approx(last(same, "mass [kg]"), rel=1e-12)


def test_profile_too_short_for_the_wear() -> None:
    narrow = cone(0.05)
    points = [one[(narrow.points[0].magnitude > -12.0) & (narrow.points[0].magnitude < 12.0)] for one in narrow.points]
    wheel = wl.Profile.from_points(y=points[0], z=points[1], kind="wheel")
    with pytest.raises(wl.InputError, match="too short"):
        wl.wear_out(pipeline(wheel=wheel), line(3), over="10 km", **GIVEN)


def test_interrupted_life_goes_on(tmp_path: Path, short: Life) -> None:
    path = tmp_path / "life.zarr"
    wl.wear_out(pipeline(), line(), over="1500 km", store=path, **GIVEN)
    *_, before, latest = sorted(path.glob("part_*"))
    shutil.rmtree(latest)
    (before / "depth/c/0/0").write_bytes(b"damaged")
    with pytest.raises(OutputError, match="resume"):
        wl.wear_out(pipeline(), line(), over="1500 km", store=path, **GIVEN)
    with pytest.raises(OutputError, match="smoothing"):
        wl.wear_out(pipeline(), line(), over="1500 km", smoothing="2 mm", store=path, resume=True, **GIVEN)
    first = path / "part_000000/zarr.json"
    written = first.stat().st_mtime_ns
    with pytest.warns(ResumeWarning, match="kept"):
        again = wl.wear_out(pipeline(), line(), over="1500 km", store=path, resume=True, **GIVEN)
    assert again.table.equals(short.table)
    assert all(short.notes)
    assert again.notes == short.notes
    assert first.stat().st_mtime_ns == written  # it was not computed again


def test_a_step_warns_of_what_none_before_it_had(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Each step of this line leaves the law's range, which the first one says; the third says something new."""

    def noted(*given: Any) -> Any:
        every.append(given)
        more = [wl.RangeWarning(f"{0.1 * len(every)} of the load is left over")] if len(every) > 2 else []
        return [*run(*given), *more]

    every: list[Any] = []
    monkeypatch.setattr("wearlaw_apps.life.line.run", noted)  # private: as above
    texts = []
    for resume in (False, True):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always", wl.WearlawWarning)
            found = wl.wear_out(
                pipeline(), line(3), over="1000 km", conicity_step=1.0, store=tmp_path / "life", resume=resume, **GIVEN
            )
        texts.append([str(one.message) for one in caught if isinstance(one.message, wl.RangeWarning)])
        computed = len(every)  # none anew in the second life
    assert computed == len(found.notes) == 3
    assert all(found.notes)
    assert "of the load is left over" in found.notes[2][-1]
    *first, third = texts[0]
    assert len(first) == len(found.notes[0])
    assert third == f"step 3: {found.notes[2][-1]}"
    assert texts[0] == texts[1]


def test_a_step_before_one_without_result_is_taken_again_in_part(
    tmp_path: Path, short: Life, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Once in the fourth step, on the profiles of the third one."""

    def failing(*given: Any) -> Any:
        calls.append(given)
        if len(calls) == 4:
            raise wl.ConditionsError(f"row 1: no normal forces balance this state; {REMEDY}")
        return run(*given)

    calls: list[Any] = []
    monkeypatch.setattr("wearlaw_apps.life.line.run", failing)  # private: as above
    found = wl.wear_out(pipeline(), line(), over="1500 km", store=tmp_path / "life", **GIVEN)
    before, after = (one.table["distance [km]"].to_numpy() for one in (short, found))
    assert after[:3] == pytest.approx(before[:3], rel=1e-12)
    assert after[3] - after[2] == pytest.approx(0.8 * (before[3] - before[2]), rel=1e-9)
    assert "0.8 times as long: row 1: no normal forces" in found.notes[3][-1]
    volume = swept(found.worn_profiles[0][0], found.profile, R0)
    assert volume * 7850.0 == pytest.approx(last(found, "mass [kg]"), rel=1e-10)
    with pytest.warns(ResumeWarning):
        again = wl.wear_out(pipeline(), line(), over="1500 km", store=tmp_path / "life", resume=True, **GIVEN)
    assert again.table.equals(found.table)
    assert again.notes == found.notes

    calls[:] = [()] * 3
    with pytest.raises(DataError, match=r"step 1, after 0 km: row 1: no normal forces"):  # nothing to take again
        wl.wear_out(pipeline(), line(), over="1500 km", **GIVEN)


def test_finished_steps_stay_when_a_step_fails(monkeypatch: pytest.MonkeyPatch) -> None:
    calls: list[Any] = []

    def failing(*given: Any) -> Any:
        calls.append(given)
        if len(calls) == 3:
            raise wl.ConditionsError("line, row 1: the wheel climbs")
        return wear(*given)

    wear = Line.wear
    monkeypatch.setattr(Line, "wear", failing)
    with pytest.raises(wl.ConditionsError) as caught:
        wl.wear_out(pipeline(), line(3), over="10000 km", **GIVEN)
    assert len(caught.value.life.table) == 3  # type: ignore[attr-defined]
    assert caught.value.__notes__
