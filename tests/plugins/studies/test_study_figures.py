"""Figures of a case, those that it asks for and those that it gets without, against its results and closed forms."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from tests.core import cases
from tests.core.cases import InstallModel, case
from tests.plugins.studies.panels import LOADS, assert_shows, by_label, by_name, one_panel, shown
from tests.strategies import EPS
from wearlaw_studies.figures import spans_of
from wearlaw_studies.report.main_result import main_figure, main_result
from wearlaw_studies.study import Study, run

WEAR = {"sweep": "creepage", "x": "wear_index", "y": "wear_rate"}
AT = {"normal_force": "4 kN", "creepage": "1 %", "friction_coefficient": 0.4}
NEWTONS = {"from": "500 N", "to": "8000 N", "points": 16}
PLANE = {**AT, "normal_force": NEWTONS, "creepage": {"from": "0.1 %", "to": "20 %", "points": 12, "spacing": "log"}}


@pytest.fixture(scope="module")
def study() -> Study:
    by_load = {**cases.POINT, "max_pressure": LOADS, "friction_coefficient": [0.3, 0.4]}
    return run(case(sweeps={"creepage": cases.SWEEP, "load": by_load}))


def styles(panel: Any) -> list[tuple[str, int, int]]:
    return [(curve.label, curve.colour, curve.dash) for curve in panel.curves]


# Figures of a case without figures


def test_a_case_that_asks_for_no_figures_has_one_of_each_kind_with_title_and_conditions(study: Study) -> None:
    assert [(figure.name, figure.title) for figure in study.figures] == [
        ("creepage_wear_rate_over_wear_index", "Wear rate over wear index Tγ (creepage)"),
        ("creepage_wear_rate_over_creepage", "Wear rate over creepage"),
        ("creepage_traction_over_creepage", "Traction coefficient T/N over creepage"),
        ("load_wear_rate_over_wear_index", "Wear rate over wear index Tγ (load)"),
        ("load_wear_rate_over_max_pressure", "Wear rate over maximum pressure"),
        ("partial_slip_along_the_patch", "Stresses and relative slip s along the patch"),
    ]
    over_load = by_name(study)["load_wear_rate_over_wear_index"]
    assert over_load.caption == "At creepage 0.5 %, friction coefficient 0.4."
    assert over_load.conditions == "A small study: creepage 0.5 %"
    assert one_panel(over_load).title == "friction coefficient 0.4"


@pytest.mark.parametrize(
    ("name", "x", "label"),
    [
        ("creepage_wear_rate_over_creepage", "creepage", "creepage [%]"),
        ("creepage_wear_rate_over_wear_index", "wear_index", "wear index Tγ [N]"),
        ("load_wear_rate_over_max_pressure", "max_pressure", "maximum pressure [MPa]"),
    ],
)
def test_wear_rate_is_shown_for_every_pair_with_its_band_colours_of_laws_and_dashes_of_models(
    study: Study, name: str, x: str, label: str
) -> None:
    panel = one_panel(by_name(study)[name])
    scale = "linear" if name.startswith("load") else "log"  # as the values of the sweep are spaced
    assert (panel.x.label, panel.y.label) == (label, "wear rate [µg/m/mm²]")
    assert (panel.x.scale, panel.y.scale) == (scale, scale)
    sweep = study.sweeps["load"].isel(friction_coefficient=1) if scale == "linear" else study.sweeps["creepage"]
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


def test_traction_is_shown_for_every_contact_model_from_zero_on(study: Study) -> None:
    panel = one_panel(by_name(study)["creepage_traction_over_creepage"])
    assert (panel.y.label, panel.x.scale, panel.y.scale) == ("traction coefficient T/N [-]", "log", "linear")
    assert panel.y.ends is not None
    assert panel.y.ends[0] == 0.0
    sweep = study.sweeps["creepage"]
    assert styles(panel) == [("global", 0, 0), ("exact", 1, 1)]
    for model, curve in by_label(panel).items():
        assert_shows(curve, sweep.creepage, sweep.traction_coefficient.sel(contact_model=model))


def test_stresses_are_shown_to_the_edges_of_the_patch_and_slip_at_the_nodes(study: Study) -> None:
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
    figures = by_name(run(case(contact_models=["coarse", "exact"], wear_laws=["kth"])))
    nodes = {c.label: c.x.size for panel in figures["partial_slip_along_the_patch"].panels for c in panel.curves}
    assert nodes["relative slip s, coarse"] == nodes["traction q, coarse"] - 2 == nodes["pressure p"] - 2 == 7
    assert nodes["relative slip s, exact"] == nodes["traction q, exact"] - 2 == 200


@pytest.mark.parametrize(
    ("creepage", "x_scale", "y_scale"),
    [
        ({"from": "0.1 %", "to": "10 %", "points": 5, "spacing": "log"}, "log", "log"),
        ({"from": "1 %", "to": "1.5 %", "points": 5}, "linear", "linear"),
        ({"from": "0.1 %", "to": "20 %", "points": 5}, "linear", "log"),
        (["0.1 %", "0.2 %", "0.5 %", "1 %", "2 %", "5 %"], "log", "log"),
        (["1 %", "2 %"], "linear", "linear"),
        (["0 %", "1 %"], "linear", "linear"),
        ({"from": "-1 %", "to": "1 %", "points": 5}, "linear", "linear"),
        ({"from": "-10 %", "to": "-0.1 %", "points": 5, "spacing": "log"}, "log", "log"),
    ],
)
def test_axes_are_spaced_as_the_values_of_the_sweep_and_show_magnitudes(
    creepage: Any, x_scale: str, y_scale: str
) -> None:
    found = run(case(sweeps={"s": {**cases.POINT, "creepage": creepage}}, profiles={}, wear_laws=["usfd"]))
    panel = one_panel(by_name(found)["s_wear_rate_over_creepage"])
    assert (panel.x.scale, panel.y.scale) == (x_scale, y_scale)
    np.testing.assert_array_equal(panel.curves[0].x, np.abs(found.sweeps["s"].creepage))


@pytest.mark.parametrize(
    ("given", "label", "ends"),
    [
        ({"normal_force": NEWTONS}, "normal force [N]", (500.0, 8000.0)),
        ({"normal_force": {**NEWTONS, "from": "0.5 kN"}}, "normal force [kN]", (0.5, 8.0)),
        ({"max_pressure": ["0.5 GPa", "750 MPa", "1 GPa"]}, "maximum pressure [GPa]", (0.5, 1.0)),
    ],
)
def test_axes_have_the_units_of_the_case(given: dict[str, Any], label: str, ends: tuple[float, float]) -> None:
    (name,) = given
    conditions = {key: value for key, value in AT.items() if key != "normal_force"}
    found = run(case(sweeps={"own": {**conditions, **given}}, profiles={}))
    panel = one_panel(by_name(found)[f"own_wear_rate_over_{name}"])
    assert panel.x.label == label
    for curve in panel.curves:
        assert (curve.x.min(), curve.x.max()) == pytest.approx(ends, rel=1e-14)


def test_a_single_operating_point_is_shown_as_points_beside_their_names() -> None:
    found = run(case(sweeps={"own": AT}, profiles={}, wear_laws=["usfd", "kth"]))
    assert [figure.title for figure in found.figures] == ["Wear rate", "Traction coefficient T/N"]
    panel, sweep = one_panel(found.figures[0]), found.sweeps["own"]
    assert panel.y.names == tuple(sweep.pair.values)
    assert [(curve.label, *curve.y) for curve in panel.curves] == [(name, n) for n, name in enumerate(panel.y.names)]
    np.testing.assert_array_equal(np.concatenate([curve.x for curve in panel.curves]), sweep.wear_rate)
    assert all(curve.points and curve.hollow for curve in panel.curves)
    kth = by_label(panel)["kth on exact"]
    np.testing.assert_array_equal(kth.low, sweep.wear_rate_low.sel(pair="kth on exact"))
    assert panel.x.label == "wear rate [µg/m/mm²]"


# Maps


def test_two_axes_make_a_map_of_the_users_spacing_and_units_for_each_pair() -> None:
    found = run(case(sweeps={"own": PLANE}, profiles={}, wear_laws=["usfd", "kth"]))
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
    main = main_figure(main_result(found))
    assert [panel.title for panel in main.panels] == ["usfd on global", "kth on global"], "two fit on a screen"
    assert main.caption.endswith("Only the pairs with global are shown; the tables hold all.")


def test_a_case_can_ask_for_a_map_of_any_variable_and_few_values_make_none_unasked() -> None:
    spec = {"sweep": "own", "x": "normal_force", "y": "creepage", "map": "traction_coefficient", "y_scale": "log",
            "contact_models": ["exact"]}  # fmt: skip
    sweeps = {"own": {**AT, "normal_force": NEWTONS, "creepage": ["0.1 %", "0.5 %", "3 %"]}}
    panel = one_panel(shown(spec, sweeps=sweeps))
    assert panel.map is not None
    assert (panel.title, panel.y.scale, panel.map.label) == ("exact", "log", "traction coefficient T/N [-]")
    without = run(case(sweeps=sweeps, profiles={})).figures
    assert not any(panel.map for figure in without for panel in figure.panels)


# Beyond shakedown, and outside a law's range


def test_a_strip_shows_where_the_contact_of_any_model_is_beyond_shakedown_in_the_units_of_the_case() -> None:
    found = run(case(sweeps={"own": {**AT, "normal_force": NEWTONS}}, profiles={"one": cases.POINT}))
    panel, sweep = one_panel(by_name(found)["own_wear_rate_over_normal_force"]), found.sweeps["own"]
    (strip,) = panel.shades
    assert (strip.label, strip.strip) == ("beyond shakedown", True)
    beyond = (sweep.max_pressure > sweep.shakedown_limit).any("contact_model").values
    shaded = [any(low <= value <= high for low, high in strip.spans) for value in panel.curves[0].x]
    assert shaded == beyond.tolist()
    assert 0 < beyond.sum() < beyond.size
    stresses, _ = by_name(found)["one_along_the_patch"].panels
    edges = stresses.curves[0].x[[0, -1]].tolist()
    assert tuple(edges) in stresses.shades[0].spans, "one operating point: the whole patch"
    usfd, outside = by_label(panel)["usfd on exact"], sweep.outside_range.sel(pair="usfd on exact").values > 0
    np.testing.assert_array_equal(usfd.outside, outside)
    assert 0 < outside.sum() < outside.size


SOFT = {"diameter": "47 mm", "material": {"youngs_modulus": "206 GPa", "poisson_ratio": 0.28, "density": "7.85 g/cm^3"}}


@pytest.mark.parametrize(
    "changes",
    [
        {"sweeps": {"elastic": {**cases.SWEEP, "max_pressure": "500 MPa"}}},
        {"rig": {"type": "twin_disc", "disc_1": SOFT, "disc_2": SOFT, "track_width": "1 cm", "rolling_speed": "1 m/s"}},
    ],
)
def test_an_elastic_case_or_one_without_a_yield_stress_has_no_strip(changes: dict[str, Any]) -> None:
    figures = run(case(profiles={}, **changes)).figures
    assert all(panel.shades == () for figure in figures for panel in figure.panels)


@pytest.mark.parametrize(
    ("x", "beyond", "spans"),
    [
        ([1, 2, 3, 4], [0, 0, 1, 1], [(2.5, 4)]),
        ([4, 3, 2, 1], [1, 1, 0, 0], [(2.5, 4)]),
        ([1, 2, 3, 4], [1, 0, 1, 0], [(1, 1.5), (2.5, 3.5)]),
        ([1, 2, np.nan, 4], [0, 1, 1, 0], [(1.5, 3)]),
        ([1, 2], [0, 0], []),
        ([1], [1], [(1, 1)]),
    ],
)
def test_spans_reach_half_way_to_the_next_point(x: Any, beyond: Any, spans: Any) -> None:
    assert list(spans_of(np.array(x, dtype=float), np.array(beyond, dtype=bool))) == spans


# What a case asks for


@pytest.mark.parametrize(
    ("spec", "curves"),
    [
        ({**WEAR, "pairs": ["kth on exact", "usfd on global"]}, [("kth on exact", 1, 1), ("usfd on global", 0, 0)]),
        ({**WEAR, "contact_models": ["exact"]}, [("usfd on exact", 0, 1), ("kth on exact", 1, 1)]),
        ({"sweep": "creepage", "x": "creepage", "y": "mean_slip", "contact_models": ["exact"]}, [("exact", 1, 1)]),
        ({"profile": "partial_slip", "y": "wear_rate", "pairs": ["kth on exact"]}, [("kth on exact", 1, 1)]),
        ({"profile": "partial_slip", "y": "traction"}, [("traction q, exact", 1, 1)]),
        (
            {"sweep": "creepage", "x": "creepage", "y": ["wear_index", "averaged_wear_index"]},
            [("wear index Tγ, global", 0, 0), ("wear index Tγ, exact", 0, 1),
             ("averaged wear index, global", 1, 0), ("averaged wear index, exact", 1, 1)],
        ),
    ],
)  # fmt: skip
def test_a_figure_shows_the_chosen_pairs_models_and_variables_in_their_styles(spec: Any, curves: Any) -> None:
    assert styles(one_panel(shown(spec))) == curves


def test_title_and_caption_are_those_that_are_given() -> None:
    figure = shown({**WEAR, "title": "A title", "caption": "A caption.", "panels": [{"title": "(a)"}]})
    assert (figure.name, figure.title, figure.caption) == ("one", "A title", "A caption.")
    assert one_panel(figure).title == "(a)"


def test_a_panel_has_what_the_figure_says_and_it_does_not() -> None:
    panels = [{}, {"x_range": ["10 N", "0.05 kN"], "x_scale": "linear", "y_range": ["0 ug/m/mm^2", "1 mg/m/mm^2"]}]
    first, second = shown({**WEAR, "x_scale": "log", "y_scale": "linear", "panels": panels}).panels
    assert (first.x.scale, first.x.ends) == ("log", None)
    assert (second.x.scale, second.x.ends) == ("linear", (10.0, 50.0))
    assert second.y.ends == pytest.approx((0.0, 1000.0), rel=4 * EPS)
    assert by_label(first).keys() == by_label(second).keys()


@pytest.mark.parametrize("scale", ["linear", "log"])
def test_the_y_axis_shows_all_that_is_in_the_window_bands_too(scale: str) -> None:
    window = {"x_range": ["1 N", "100 N"], "y_scale": scale}
    panel = one_panel(shown({**WEAR, **window, "pairs": ["usfd on global", "kth on global"]}))
    kth = by_label(panel)["kth on global"]
    assert kth.low is not None
    assert kth.high is not None
    inside = (kth.x >= 1.0) & (kth.x <= 100.0)
    assert 0 < inside.sum() < inside.size
    assert panel.y.ends is not None
    low, high = panel.y.ends
    assert max(kth.high[inside]) < high < 1.6 * max(kth.high[inside])
    assert low == 0.0 if scale == "linear" else 0.6 * min(kth.low[inside]) < low < min(kth.low[inside])
    empty = one_panel(shown({**WEAR, "x_range": ["1 MN", "2 MN"], "y_scale": scale}))
    assert empty.y.ends is None


def test_a_figure_runs_along_the_axis_that_its_x_names() -> None:
    grid = {**cases.POINT, "max_pressure": ["500 MPa", "1000 MPa", "1500 MPa"], "creepage": ["1 %", "2 %"],
            "friction_coefficient": [0.1, 0.2]}  # fmt: skip
    names = ("half_width", "creepage", "friction_coefficient")
    figures = {x: {"sweep": "both", "x": x, "y": "wear_rate"} for x in names}
    found = {
        name: one_panel(figure) for name, figure in by_name(run(case(sweeps={"both": grid}, figures=figures))).items()
    }
    assert found["half_width"].title == "creepage 2 %, friction coefficient 0.2"
    assert found["creepage"].title == "maximum pressure 1000 MPa, friction coefficient 0.2"
    # a = 2 p0 R / E*, here with R = 11.75 mm and E* = 112.0212 GPa
    half_widths = 2 * np.array([500, 1000, 1500]) * 11.75 / 112021.2
    np.testing.assert_allclose(found["half_width"].curves[0].x, half_widths, rtol=1e-6)
    np.testing.assert_array_equal(found["creepage"].curves[0].x, [1.0, 2.0])
    np.testing.assert_array_equal(found["friction_coefficient"].curves[0].x, [0.1, 0.2])


def test_along_the_patch_signs_are_kept_and_the_creepage_is_a_level_line() -> None:
    back = {"profiles": {"back": {**cases.POINT, "creepage": "-0.5 %"}}}
    panel = one_panel(shown({"profile": "back", "y": ["slip", "creepage"]}, **back))
    slip, level = panel.curves
    assert slip.y.min() < -0.5
    assert slip.y.max() == 0.0
    assert_shows(level, slip.x[[0, -1]], [-0.5, -0.5])
    assert panel.y.ends is None, "not from zero on, with something below"
