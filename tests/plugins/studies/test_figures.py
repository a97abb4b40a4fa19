"""Figures of a case, those that it asks for and those that it gets without, against its results."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import jsonschema  # type: ignore[import-untyped]
import numpy as np
import pytest

import wearlaw as wl
from tests import cases
from tests.cases import InstallModel, case, table
from tests.plugins.studies.panels import LOADS, assert_shows, by_label, by_name, one_panel, shown
from tests.plugins.studies.test_rigs import ON_RAIL
from tests.strategies import EPS
from wearlaw_apps.studies import Case

WEAR = {"sweep": "creepage", "x": "wear_index", "y": "wear_rate"}
PATCH = {"profile": "partial_slip", "y": "slip"}
AT = {"normal_force": "4 kN", "creepage": "1 %", "friction_coefficient": 0.4}
NEWTONS = {"from": "500 N", "to": "8000 N", "points": 16}
PLANE = {**AT, "normal_force": NEWTONS, "creepage": {"from": "0.1 %", "to": "20 %", "points": 12, "spacing": "log"}}


@pytest.fixture(scope="module")
def study() -> wl.Study:
    by_load = {**cases.POINT, "max_pressure": LOADS, "friction_coefficient": [0.3, 0.4]}
    return wl.run(case(sweeps={"creepage": cases.SWEEP, "load": by_load}))


# Figures of a case without figures


def test_a_case_that_asks_for_no_figures_has_one_of_each_kind_with_title_and_conditions(study: wl.Study) -> None:
    assert [(figure.name, figure.title) for figure in study.figures] == [
        ("creepage_wear_rate_over_creepage", "Wear rate over creepage"),
        ("creepage_wear_rate_over_wear_index", "Wear rate over wear index Tγ (creepage)"),
        ("creepage_traction_over_creepage", "Traction coefficient T/N over creepage"),
        ("load_wear_rate_over_wear_index", "Wear rate over wear index Tγ (load)"),
        ("load_wear_rate_over_max_pressure", "Wear rate over maximum pressure"),
        ("partial_slip_along_the_patch", "Stresses and slip along the patch: partial slip"),
    ]
    over_load = by_name(study)["load_wear_rate_over_wear_index"]
    assert over_load.caption == "At creepage 0.5 %, friction coefficient 0.4."
    assert over_load.conditions == "A small study: creepage 0.5 %, friction coefficient 0.4"


@pytest.mark.parametrize(
    ("name", "x", "label"),
    [
        ("creepage_wear_rate_over_creepage", "creepage", "creepage [%]"),
        ("creepage_wear_rate_over_wear_index", "wear_index", "wear index Tγ [N]"),
        ("load_wear_rate_over_max_pressure", "max_pressure", "maximum pressure [MPa]"),
    ],
)
def test_wear_rate_is_shown_for_every_pair_with_its_band_colours_of_laws_and_dashes_of_models(
    study: wl.Study, name: str, x: str, label: str
) -> None:
    panel = one_panel(by_name(study)[name])
    assert (panel.x.label, panel.y.label) == (label, "wear rate [µg/m/mm²]")
    assert panel.x.scale == ("linear" if name.startswith("load") else "log")
    sweep = study.sweeps["creepage"]
    sweep = study.sweeps["load"].isel(friction_coefficient=1) if name.startswith("load") else sweep
    laws, models = ["usfd", "kth", "brr"], ["global", "exact"]
    assert sorted(by_label(panel)) == sorted(sweep.pair.values)
    for pair, curve in by_label(panel).items():
        law, model = pair.split(" on ")
        along = sweep[x].sel(contact_model=model) if x == "wear_index" else sweep[x]
        one = sweep.sel(pair=pair)
        assert_shows(curve, along, one.wear_rate)
        assert (curve.colour, curve.dash) == (laws.index(law), models.index(model))
        assert (curve.low is None) == (law != "kth")
        if law == "kth":
            np.testing.assert_array_equal((curve.low, curve.high), (one.wear_rate_low, one.wear_rate_high))


def test_stresses_are_shown_to_the_edges_of_the_patch_and_slip_at_the_nodes(study: wl.Study) -> None:
    stresses, slip = by_name(study)["partial_slip_along_the_patch"].panels
    assert stresses.y.label == "pressure p, traction q, traction bound [MPa]"
    assert (slip.x.label, slip.y.label) == ("position x, leading edge left [mm]", "relative slip s [%]")
    profile = study.profiles["partial_slip"].sel(contact_model="exact")
    curves = {**by_label(stresses), **by_label(slip)}
    edge = 2 * 1500 * 11.75 / 112021.2  # a = 2 p0 R / E*; there every stress is zero, and the nodes lie inside
    for label, field in (("pressure p", "pressure"), ("traction q, exact", "traction"),
                         ("traction bound, exact", "traction_bound")):  # fmt: skip
        curve = curves.pop(label)
        np.testing.assert_array_equal((curve.x[1:-1], curve.y[1:-1]), (profile.x, profile[field]))
        assert curve.x[[0, -1]] == pytest.approx([-edge, edge], rel=1e-6)
        assert curve.y[[0, -1]].tolist() == [0.0, 0.0]
    assert_shows(curves.pop("relative slip s, exact"), profile.x, profile.slip)
    assert not curves


def test_a_model_with_nodes_of_its_own_is_shown_on_these(install_model: InstallModel) -> None:
    install_model(cases.Coarse)
    figures = by_name(wl.run(case(contact_models=["coarse", "exact"], wear_laws=["kth"])))
    nodes = {c.label: c.x.size for panel in figures["partial_slip_along_the_patch"].panels for c in panel.curves}
    assert nodes["relative slip s, coarse"] == nodes["traction q, coarse"] - 2 == 7
    assert nodes["relative slip s, exact"] == nodes["traction q, exact"] - 2 == 200


@pytest.mark.parametrize(
    ("creepage", "x_scale", "y_scale"),
    [
        ({"from": "1 %", "to": "1.5 %", "points": 5}, "linear", "linear"),
        ({"from": "0.1 %", "to": "20 %", "points": 5}, "linear", "log"),
        (["0.1 %", "0.2 %", "0.5 %", "1 %", "2 %", "5 %"], "log", "log"),
        (["0 %", "1 %"], "linear", "linear"),
        ({"from": "-10 %", "to": "-0.1 %", "points": 5, "spacing": "log"}, "log", "log"),
    ],
)
def test_axes_are_spaced_as_the_values_of_the_sweep_and_show_magnitudes(
    creepage: Any, x_scale: str, y_scale: str
) -> None:
    found = wl.run(case(sweeps={"s": {**cases.POINT, "creepage": creepage}}, profiles={}, wear_laws=["usfd"]))
    panel = one_panel(by_name(found)["s_wear_rate_over_creepage"])
    assert (panel.x.scale, panel.y.scale) == (x_scale, y_scale)
    np.testing.assert_array_equal(panel.curves[0].x, np.abs(found.sweeps["s"].creepage))


@pytest.mark.parametrize(
    ("given", "label", "ends"),
    [
        ({"normal_force": {**NEWTONS, "from": "0.5 kN"}}, "normal force [kN]", (0.5, 8.0)),
        ({"max_pressure": ["0.5 GPa", "750 MPa", "1 GPa"]}, "maximum pressure [GPa]", (0.5, 1.0)),
    ],
)
def test_axes_have_the_units_of_the_case(given: dict[str, Any], label: str, ends: tuple[float, float]) -> None:
    (name,) = given
    conditions = {key: value for key, value in AT.items() if key != "normal_force"}
    found = wl.run(case(sweeps={"own": {**conditions, **given}}, profiles={}))
    panel = one_panel(by_name(found)[f"own_wear_rate_over_{name}"])
    assert panel.x.label == label
    for curve in panel.curves:
        assert (curve.x.min(), curve.x.max()) == pytest.approx(ends, rel=1e-14)


# The main figure


def test_the_main_figure_stands_first_and_shows_one_contact_model_if_all_would_be_too_many() -> None:
    models, laws = ["global", "exact", "fastsim"], ["usfd", "kth", "brr"]
    asked = {"own": {"sweep": "creepage", "x": "creepage", "y": "traction_coefficient"}}
    few = wl.run(case(contact_models=models[:2], wear_laws=laws[:2], figures=asked)).figures
    assert [figure.name for figure in few] == ["main", "own"]
    assert len(one_panel(few[0]).curves) == 4
    many = wl.run(case(contact_models=models, wear_laws=laws, profiles={})).figures[0]
    assert [curve.label for curve in one_panel(many).curves] == ["usfd on global", "kth on global", "brr on global"]
    assert "Only the pairs with global are shown" in many.caption


def test_a_figure_of_the_case_that_shows_the_same_is_the_main_one() -> None:
    asked = {"force": {"sweep": "creepage", "x": "creepage", "y": "tangential_force"},
             "own": {**WEAR, "x": "creepage", "x_scale": "log", "y_scale": "log", "title": "My own"}}  # fmt: skip
    assert [figure.name for figure in wl.run(case(figures=asked)).figures] == ["own", "force"]


def test_a_first_sweep_of_one_point_has_no_main_figure() -> None:
    found = wl.run(case(sweeps={"own": AT}, profiles={}, wear_laws=["usfd", "kth"]))
    assert found.figures == ()


# Maps


def test_two_axes_make_a_map_of_the_users_spacing_and_units_for_each_pair() -> None:
    found = wl.run(case(sweeps={"own": PLANE}, profiles={}, wear_laws=["usfd", "kth"]))
    figure, sweep = by_name(found)["own_wear_rate_over_creepage_and_normal_force"], found.sweeps["own"]
    assert figure.title == "Wear rate over creepage and normal force"
    assert [panel.title for panel in figure.panels] == sweep.pair.values.tolist()
    for panel in figure.panels:
        assert panel.map is not None
        assert (panel.x.label, panel.x.scale) == ("creepage [%]", "log")
        assert (panel.y.label, panel.y.scale) == ("normal force [N]", "linear")
        assert panel.map.y[[0, -1]] == pytest.approx([500.0, 8000.0], rel=1e-14)
        one = sweep.sel(pair=panel.title, contact_model=panel.title.split(" on ")[1]).transpose("normal_force", ...)
        np.testing.assert_array_equal(panel.map.values, one.wear_rate)
        np.testing.assert_array_equal(panel.map.borders["beyond shakedown"], one.max_pressure > one.shakedown_limit)
        np.testing.assert_array_equal(panel.map.borders["outside the range of the law"], one.outside_range > 0)
    assert [panel.title for panel in found.figures[0].panels] == ["usfd on global", "kth on global"]


def test_a_case_can_ask_for_a_map_of_any_variable_and_few_values_make_none_unasked() -> None:
    spec = {"sweep": "own", "x": "normal_force", "y": "creepage", "map": "traction_coefficient", "y_scale": "log",
            "contact_models": ["exact"]}  # fmt: skip
    sweeps = {"own": {**AT, "normal_force": NEWTONS, "creepage": ["0.1 %", "0.5 %", "3 %"]}}
    panel = one_panel(shown(spec, sweeps=sweeps))
    assert panel.map is not None
    assert (panel.title, panel.y.scale, panel.map.label) == ("exact", "log", "traction coefficient T/N [-]")
    without = wl.run(case(sweeps=sweeps, profiles={})).figures
    assert not any(panel.map for figure in without for panel in figure.panels)


# Beyond shakedown, and outside a law's range


def test_a_strip_shows_where_the_contact_of_any_model_is_beyond_shakedown_in_the_units_of_the_case() -> None:
    found = wl.run(case(sweeps={"own": {**AT, "normal_force": NEWTONS}}, profiles={"one": cases.POINT}))
    panel, sweep = one_panel(by_name(found)["own_wear_rate_over_normal_force"]), found.sweeps["own"]
    (strip,) = panel.shades
    assert (strip.label, strip.strip) == ("beyond shakedown", True)
    beyond = (sweep.max_pressure > sweep.shakedown_limit).any("contact_model").values
    shaded = [any(low <= value <= high for low, high in strip.spans) for value in panel.curves[0].x]
    assert shaded == beyond.tolist()
    assert 0 < beyond.sum() < beyond.size
    stresses, _ = by_name(found)["one_along_the_patch"].panels
    assert tuple(stresses.curves[0].x[[0, -1]].tolist()) in stresses.shades[0].spans, "one point: the whole patch"
    usfd, outside = by_label(panel)["usfd on exact"], sweep.outside_range.sel(pair="usfd on exact").values > 0
    np.testing.assert_array_equal(usfd.outside, outside)
    assert 0 < outside.sum() < outside.size
    elastic = wl.run(case(profiles={}, sweeps={"elastic": {**cases.SWEEP, "max_pressure": "500 MPa"}})).figures
    assert all(panel.shades == () for figure in elastic for panel in figure.panels)


# What a case asks for


@pytest.mark.parametrize(
    ("spec", "curves"),
    [
        ({**WEAR, "pairs": ["kth on exact", "usfd on global"]}, [("kth on exact", 1, 1), ("usfd on global", 0, 0)]),
        ({**WEAR, "contact_models": ["exact"]}, [("usfd on exact", 0, 1), ("kth on exact", 1, 1)]),
        ({"sweep": "creepage", "x": "creepage", "y": "mean_slip", "contact_models": ["exact"]}, [("exact", 1, 1)]),
        ({"profile": "partial_slip", "y": "wear_rate", "pairs": ["kth on exact"]}, [("kth on exact", 1, 1)]),
        (
            {"profile": "partial_slip", "y": ["slip", "creepage"]},
            [("relative slip s, exact", 3, 1), ("creepage", 5, 0)],
        ),
        (
            {"sweep": "creepage", "x": "creepage", "y": ["wear_index", "tangential_force"]},
            [("wear index Tγ, global", 0, 0), ("wear index Tγ, exact", 0, 1),
             ("tangential force T, global", 1, 0), ("tangential force T, exact", 1, 1)],
        ),
    ],
)  # fmt: skip
def test_a_figure_shows_the_chosen_pairs_models_and_variables_in_their_styles(spec: Any, curves: Any) -> None:
    assert [(curve.label, curve.colour, curve.dash) for curve in one_panel(shown(spec)).curves] == curves


def test_a_panel_has_what_the_figure_says_and_it_does_not() -> None:
    panels = [{}, {"x_range": ["10 N", "0.05 kN"], "x_scale": "linear", "y_range": ["0 ug/m/mm^2", "1 mg/m/mm^2"],
                   "title": "(b)"}]  # fmt: skip
    given = {"title": "A title", "caption": "A caption."}
    figure = shown({**WEAR, **given, "x_scale": "log", "y_scale": "linear", "panels": panels})
    assert (figure.name, figure.title, figure.caption) == ("one", "A title", "A caption.")
    first, second = figure.panels
    assert (first.x.scale, first.x.ends) == ("log", None)
    assert (second.x.scale, second.x.ends, second.title) == ("linear", (10.0, 50.0), "(b)")
    assert second.y.ends == (0.0, 1000.0)


def test_the_y_axis_shows_all_that_is_in_the_window_bands_too() -> None:
    panel = one_panel(shown({**WEAR, "x_range": ["0 N", "30 N"], "y_scale": "linear"}))
    inside = [end[(curve.x >= 0.0) & (curve.x <= 30.0)] for curve in panel.curves
              for end in (curve.y, curve.high) if end is not None]  # fmt: skip
    assert panel.y.ends == pytest.approx((0.0, 1.05 * np.concatenate(inside).max()))


def test_the_regimes_of_a_law_of_patch_means_are_lines_where_they_change() -> None:
    spec = {"sweep": "creepage", "x": "wear_index", "y": "wear_rate", "regimes": True}
    panel = one_panel(shown(spec, sweeps={"creepage": {**cases.SWEEP, "max_pressure": "1500 MPa"}}))
    area = 4 * 1500 * 11.75 / 112021.2 * 10.0  # 2a × 10 mm with a = 2 p0 R / E*
    usfd = {limit.label: limit.at for limit in panel.limits if limit.label.startswith("usfd")}
    # q_s/m_m of Table 4 of Tassini et al.; Tγ is proportional to Tγ/A, so nothing is lost between points
    assert usfd["usfd: Tγ/A = 10.38 N/mm²"] == pytest.approx(55.0 / 5.3 * area, rel=1e-5)
    assert {limit.axis for limit in panel.limits} == {"x"}
    assert not shown({**spec, "pairs": ["usfd on exact"]}).panels[0].limits, "cells change at different points"


def test_a_case_names_the_figure_that_its_report_begins_with() -> None:
    spec = {"sweep": "creepage", "x": "wear_index", "y": "wear_rate"}
    study = wl.run(case(figures={"first": spec, "second": {**spec, "x": "creepage"}}, main="second"))
    assert [figure.name for figure in study.figures] == ["first", "second"]
    assert study.main is study.figures[1]
    assert wl.run(case(main="third")).notes[-1] == "main: the report has no figure 'third'"


@pytest.mark.parametrize("count", [4, 299, 301, 1200])
def test_a_map_has_at_most_as_many_values_as_a_screen_shows(count: int) -> None:
    spec = {"sweep": "load", "x": "max_pressure", "y": "friction_coefficient", "map": "wear_index",
            "contact_models": ["global"]}  # fmt: skip
    plane = {**cases.POINT, "max_pressure": {**LOADS, "points": count}, "friction_coefficient": [0.3, 0.4]}
    drawn = one_panel(shown(spec, sweeps={"load": plane})).map
    assert drawn is not None
    assert drawn.x.size == min(count, 300)
    assert (drawn.x[0], drawn.x[-1]) == (500.0, 1500.0)


@pytest.mark.parametrize("x", ["max_pressure", "normal_force", "friction_coefficient", "creepage", "half_width"])
def test_a_figure_runs_along_an_axis_on_which_its_x_varies(x: str) -> None:
    axes = {"max_pressure": LOADS, "friction_coefficient": [0.3, 0.4, 0.5], "creepage": ["1 %", "2 %"]}
    panel = one_panel(shown({"sweep": "own", "x": x, "y": "wear_rate"}, sweeps={"own": axes}, profiles={}))
    sizes = {"creepage": 2, "friction_coefficient": 3}
    assert {curve.x.size for curve in panel.curves} == {sizes.get(x, 3)}
    assert all(np.ptp(curve.x) > 0.0 for curve in panel.curves)


WRONG: list[tuple[dict[str, Any], str]] = [
    ({**WEAR, "sweep": "crepage"}, "sweep"),
    ({**WEAR, "x": "wear_indx"}, "x"),
    ({**WEAR, "x": "wear_rate", "y": "wear_index"}, "x"),  # of two laws on each contact model
    ({"sweep": "creepage", "y": "wear_rate"}, "x"),
    ({**WEAR, "y": "wear_rat"}, "y"),
    ({**PATCH, "y": ["slip", "pressure"]}, "y"),
    ({**WEAR, "pairs": ["usfd on exat"]}, "pairs"),
    ({**WEAR, "contact_models": ["exat"]}, "contact_models"),
    ({**WEAR, "x_range": ["0 MPa", "70 MPa"]}, "x_range"),
    ({**WEAR, "x_range": ["70 N", "0 N"]}, "x_range"),
    ({**WEAR, "x_range": ["0 N", "70 N"], "x_scale": "log"}, "x_range"),
    ({**WEAR, "measured": True}, "measured"),
    ({**WEAR, "body": "rial"}, "body"),
    ({**WEAR, "patches": {"side": "left"}}, "patches"),
    ({**WEAR, "panels": [{}, {"x_range": ["2 N", "1 N"]}]}, "panels.1.x_range"),
    ({"sweep": "both", "x": "max_pressure", "y": "friction_coefficient", "map": "wear_rate"}, "y"),
    ({"sweep": "both", "x": "max_pressure", "y": "creepage", "map": "waer_rate"}, "map"),
]
ACROSS = {"profile": "curve", "x": "y", "y": "depth"}
WRONG_ACROSS: list[tuple[dict[str, Any], str]] = [
    ({**ACROSS, "x": "creepage"}, "x"),
    ({**ACROSS, "body": "rail", "y_range": ["0 um/km", "1 um/km"]}, "y_range"),
    ({**ACROSS, "y": ["depth", "sliding_distance"]}, "y"),
]


@pytest.mark.parametrize(("spec", "path"), WRONG + WRONG_ACROSS)
def test_what_is_wrong_with_a_figure_is_named_before_anything_is_swept(spec: dict[str, Any], path: str) -> None:
    both = {"both": {**cases.SWEEP, "max_pressure": ["1 GPa", "2 GPa"]}, "creepage": cases.SWEEP}
    fields = ON_RAIL if spec.get("profile") == "curve" else table(sweeps=both)
    swept: list[int] = []
    with pytest.raises(wl.ConfigurationError) as refused:
        wl.run(Case(**{**fields, "figures": {"one": spec}}), swept.append)
    assert [".".join(problem.path) for problem in refused.value.problems] == [f"figures.one.{path}"]
    assert not swept


@pytest.mark.parametrize(
    "changes",
    [{"x": "wear_indx"}, {"y": "wear_rat"}, {"y": []}, {"x_range": ["0 N"]}, {"x_scale": "lin"}, {"pairs": []},
     {"panels": [{"sweep": "creepage"}]}, {"measured": "yes please"}, {"profile": "partial_slip"}, {"sweeps": "a"}],
)  # fmt: skip
def test_the_schema_or_the_loader_refuses_a_figure_that_no_case_can_have(changes: Any, validator: Any) -> None:
    spec = {**WEAR, **changes}
    good = table(figures={"one": WEAR})
    validator.validate(good)
    assert Case(**good) == Case(**Case(**good).model_dump(mode="json", by_alias=True, exclude_none=True))
    if changes not in ({"x": "wear_indx"}, {"y": "wear_rat"}):  # which depend on the laws of the case
        with pytest.raises(wl.ConfigurationError, match=r"figures\.one\."):
            case(figures={"one": spec})
    if "profile" not in changes:
        with pytest.raises(jsonschema.ValidationError):
            validator.validate(table(figures={"one": spec}))


def test_the_schema_accepts_a_map_of_the_outcome_of_a_law(validator: Any) -> None:
    validator.validate(table(figures={"one": {**WEAR, "map": "rcf_damage"}}))


# Measured tests

TESTS = """creepage [%],normal_force [kN],tangential_force [N],wear_rate [ug/m/mm^2],wear_rate_uncertainty [ug/m/mm^2]
1,7,2100,20,2
-5,7,3500,,3
10,6,,60,
"""


@pytest.fixture
def measured(tmp_path: Path) -> dict[str, Any]:
    file = tmp_path / "tests.csv"
    file.write_text(TESTS, encoding="utf-8")
    return {"label": "my tests", "tests": str(file)}


def points(measured: dict[str, Any], x: str, y: str) -> wl.Curve:
    sweeps = {"creepage": cases.SWEEP, "load": {**cases.POINT, "max_pressure": LOADS}}
    of_load = x in ("normal_force", "half_width")
    spec = {"sweep": "load" if of_load else "creepage", "x": x, "y": y, "measured": True}
    (curve,) = (curve for curve in one_panel(shown(spec, measured=measured, sweeps=sweeps)).curves if curve.points)
    assert curve.label == "my tests"
    return curve


def test_mass_losses_are_shown_as_wear_rates_on_the_rig_of_the_case(tmp_path: Path) -> None:
    """m/(n πD A), where Hertz's patch of two discs of 47 mm has a = 2 R p0/E* with R = 11.75 mm, and A = 2a · 10 mm."""
    file = tmp_path / "campaign.csv"
    file.write_text("Slip (%),max_pressure [MPa],Revs,Mass loss (mg)\n1,1500,40000,200\n5,1500,40000,300\n", "utf-8")
    heads = {"creepage": "Slip (%)", "revolutions": "Revs"}
    curve = points({"label": "my tests", "tests": str(file), "columns": heads}, "creepage", "wear_rate")
    steel = wl.TwinDisc.suros().disc_1.material
    modulus = steel.youngs_modulus.m_as("MPa") / (2.0 * (1.0 - steel.poisson_ratio**2))
    area = 4.0 * 11.75 * 1500.0 / modulus * 10.0
    due = np.array([200e3, 300e3]) / (40000 * np.pi * 0.047 * area)
    np.testing.assert_allclose((curve.x, curve.y), ([1.0, 5.0], due), rtol=32 * EPS)


def test_tests_are_shown_where_they_were_measured_with_their_uncertainty(measured: dict[str, Any]) -> None:
    traction = points(measured, "creepage", "traction_coefficient")
    np.testing.assert_allclose((traction.x, traction.y), ([1.0, 5.0], [0.3, 0.5]), rtol=4 * EPS)
    assert traction.low is None
    by_index = points(measured, "wear_index", "wear_rate")
    np.testing.assert_allclose((by_index.x, by_index.y), ([21.0], [20.0]), rtol=8 * EPS)
    wear = points(measured, "creepage", "wear_rate")
    np.testing.assert_allclose((wear.x, wear.y), ([1.0, 10.0], [20.0, 60.0]), rtol=4 * EPS)
    np.testing.assert_allclose((wear.low, wear.high), ([18.0, math.nan], [22.0, math.nan]), rtol=4 * EPS)  # type: ignore[arg-type]


def test_the_area_and_width_of_the_patch_in_a_test_are_those_of_its_load(measured: dict[str, Any]) -> None:
    density = points(measured, "half_width", "wear_index_density")
    # 700 N/mm on discs of 47 mm: a² = 4PR/(πE*) in mm and N (Johnson 1985)
    half_width = math.sqrt(4.0 * 700.0 * 47.0 / 4.0 / (math.pi * 206477.42 / (2.0 * (1.0 - 0.28**2))))
    np.testing.assert_allclose(density.x, half_width, rtol=64 * EPS)
    np.testing.assert_allclose(density.y, np.array([21.0, 175.0]) / (20.0 * half_width), rtol=64 * EPS)


def test_measured_tests_are_shown_over_creepage_by_a_case_without_figures(measured: dict[str, Any]) -> None:
    figures = by_name(wl.run(case(measured=measured)))
    for name in ("traction_over_creepage", "wear_rate_over_creepage", "wear_rate_over_wear_index"):
        assert [c.label for c in one_panel(figures[f"creepage_{name}"]).curves if c.points] == ["my tests"]
