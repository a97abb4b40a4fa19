"""What figures show, against results, published numbers and closed forms."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.core import cases
from tests.core.cases import InstallModel, case
from tests.core.panels import assert_shows, by_label, by_name, one_panel
from wearlaw.figures.curves import Curve, FigureData
from wearlaw.figures.drawing import draw
from wearlaw.study import Study, run

EPS = float(np.finfo(float).eps)
LOADS = {"from": "500 MPa", "to": "1500 MPa", "points": 3}


@pytest.fixture(scope="module")
def study() -> Study:
    by_load = {**cases.POINT, "max_pressure": LOADS, "friction_coefficient": [0.3, 0.4]}
    return run(case(sweeps={"creepage": cases.SWEEP, "load": by_load}))


def shown(spec: dict[str, Any], **changes: Any) -> FigureData:
    """Return the one figure of a small case that asks for it."""
    (figure,) = run(case(**{"figures": {"one": spec}, **changes})).figures
    return figure


# Figures of a case that asks for none


def test_a_case_that_asks_for_no_figures_has_one_of_each_kind(study: Study) -> None:
    assert list(by_name(study)) == [
        "creepage_wear_rate_against_wear_index",
        "creepage_wear_rate_against_creepage",
        "creepage_traction_against_creepage",
        "load_wear_rate_against_wear_index",
        "load_wear_rate_against_max_pressure",
        "partial_slip_along_the_patch",
    ]


@pytest.mark.parametrize(
    ("name", "x", "label"),
    [
        ("creepage_wear_rate_against_creepage", "creepage", "creepage [%]"),
        ("creepage_wear_rate_against_wear_index", "wear_index", "wear index Tγ [N]"),
        ("load_wear_rate_against_max_pressure", "max_pressure", "maximum pressure [MPa]"),
        ("load_wear_rate_against_wear_index", "wear_index", "wear index Tγ [N]"),
    ],
)
def test_wear_rate_is_shown_for_every_pair_as_the_dataset_has_it(study: Study, name: str, x: str, label: str) -> None:
    panel = one_panel(by_name(study)[name])
    assert (panel.x.label, panel.y.label) == (label, "wear rate [µg/m/mm²]")
    assert (panel.x.scale, panel.y.scale) == ("log", "log")
    assert (panel.x.ends, panel.y.ends) == (None, None)
    sweep = study.sweeps["creepage"]
    if name.startswith("load"):
        sweep = study.sweeps["load"].isel(friction_coefficient=1)
        assert panel.title == "friction coefficient 0.4"
    else:
        assert panel.title == ""
    assert list(by_label(panel)) == list(sweep.pair.values)
    for pair, curve in by_label(panel).items():
        along = sweep[x].sel(contact_model=pair.split(" on ")[1]) if x == "wear_index" else sweep[x]
        assert_shows(curve, along, sweep.wear_rate.sel(pair=pair))


def test_colour_tells_the_law_and_line_style_the_contact_model_in_all_figures(study: Study) -> None:
    styles = {
        (curve.label, curve.colour, curve.dash)
        for name, figure in by_name(study).items()
        if "wear_rate" in name
        for curve in one_panel(figure).curves
    }
    assert styles == {
        ("usfd on global", 0, 0), ("kth on global", 1, 0), ("brr on global", 2, 0),
        ("usfd on exact", 0, 1), ("kth on exact", 1, 1),
    }  # fmt: skip


def test_the_band_of_a_law_is_shown_and_only_where_there_is_one(study: Study) -> None:
    curves = by_label(one_panel(by_name(study)["creepage_wear_rate_against_creepage"]))
    sweep = study.sweeps["creepage"]
    for pair, curve in curves.items():
        if pair.startswith("kth"):
            one = sweep.sel(pair=pair)
            np.testing.assert_array_equal((curve.low, curve.high), (one.wear_rate_low, one.wear_rate_high))
        else:
            assert curve.low is None
            assert curve.high is None


def test_traction_is_shown_for_every_contact_model(study: Study) -> None:
    panel = one_panel(by_name(study)["creepage_traction_against_creepage"])
    assert (panel.x.label, panel.y.label) == ("creepage [%]", "traction coefficient T/N [-]")
    assert (panel.x.scale, panel.y.scale) == ("log", "linear")
    assert panel.y.ends is not None
    assert panel.y.ends[0] == 0.0
    sweep = study.sweeps["creepage"]
    assert [(curve.label, curve.colour, curve.dash) for curve in panel.curves] == [("global", 0, 0), ("exact", 1, 1)]
    for curve in panel.curves:
        assert_shows(curve, sweep.creepage, sweep.traction_coefficient.sel(contact_model=curve.label))


def test_stresses_and_slip_are_shown_along_the_patch(study: Study) -> None:
    stresses, slip = by_name(study)["partial_slip_along_the_patch"].panels
    assert stresses.y.label == "pressure p, traction q, traction bound [MPa]"
    assert (slip.x.label, slip.y.label) == ("position x, leading edge left [mm]", "relative slip s [%]")
    profile = study.profiles["partial_slip"].sel(contact_model="exact")
    curves = {**by_label(stresses), **by_label(slip)}
    assert_shows(curves.pop("pressure p"), profile.x, profile.pressure)
    assert_shows(curves.pop("traction q, exact"), profile.x, profile.traction)
    assert_shows(curves.pop("traction bound, exact"), profile.x, profile.traction_bound)
    assert_shows(curves.pop("relative slip s, exact"), profile.x, profile.slip)
    assert not curves


def test_a_model_with_nodes_of_its_own_is_shown_on_these(install_model: InstallModel) -> None:
    install_model(cases.Coarse)
    figures = by_name(run(case(contact_models=["coarse", "exact"], wear_laws=["kth"])))
    nodes = {c.label: c.x.size for panel in figures["partial_slip_along_the_patch"].panels for c in panel.curves}
    assert {size for label, size in nodes.items() if "coarse" in label or label == "pressure p"} == {7}
    assert {size for label, size in nodes.items() if "exact" in label} == {200}


@pytest.mark.parametrize(
    ("creepage", "scale"),
    [
        ("1 %", "log"),
        ("0 %", "linear"),
        ("-1 %", "log"),
        (["0 %", "1 %"], "log"),
        ({"from": "-1 %", "to": "1 %", "points": 5}, "log"),
    ],
    ids=["one point", "no creepage", "negative", "from zero", "through zero"],
)
def test_axes_are_logarithmic_unless_nothing_would_be_seen(creepage: Any, scale: str) -> None:
    ran = run(case(sweeps={"s": {**cases.POINT, "creepage": creepage}}, profiles={}))
    panel = one_panel(by_name(ran)["s_wear_rate_against_creepage"])
    assert (panel.x.scale, panel.y.scale) == (scale, scale)


def test_a_sweep_shows_magnitudes() -> None:
    back = run(case(sweeps={"back": {**cases.POINT, "creepage": ["-2 %", "-1 %"]}}, profiles={}))
    for curve in one_panel(by_name(back)["back_traction_against_creepage"]).curves:
        np.testing.assert_array_equal(curve.x, [2.0, 1.0])
        assert (curve.y > 0.0).all()


def test_a_measured_traction_coefficient_that_is_an_axis_is_shown_at_its_middle() -> None:
    conditions = {**cases.POINT, "creepage": ["1 %", "2 %"], "traction_coefficient": [0.1, 0.2]}
    panel = one_panel(by_name(run(case(sweeps={"m": conditions}, profiles={})))["m_traction_against_creepage"])
    assert panel.title == "traction coefficient T/N 0.2"
    assert_shows(panel.curves[0], [1.0, 2.0], [0.2, 0.2])


def test_a_caption_that_is_not_given_tells_the_conditions(study: Study) -> None:
    captions = {name: figure.caption for name, figure in by_name(study).items()}
    assert captions["creepage_wear_rate_against_creepage"] == "At maximum pressure 1500 MPa, friction coefficient 0.46."
    assert captions["load_wear_rate_against_wear_index"] == "At creepage 0.5 %, friction coefficient 0.4."
    at_one_point = "At maximum pressure 1500 MPa, creepage 0.5 %, friction coefficient 0.46."
    assert captions["partial_slip_along_the_patch"] == at_one_point


# Figures that a case asks for

WEAR = {"sweep": "creepage", "x": "wear_index", "y": "wear_rate"}


def test_title_and_caption_are_those_that_are_given() -> None:
    figure = shown({**WEAR, "title": "A title", "caption": "A caption.", "panels": [{"title": "(a)"}]})
    assert (figure.name, figure.title, figure.caption) == ("one", "A title", "A caption.")
    assert one_panel(figure).title == "(a)"


def test_only_the_chosen_pairs_are_shown_in_their_order_and_their_colours() -> None:
    panel = one_panel(shown({**WEAR, "pairs": ["kth on exact", "usfd on global"]}))
    styles = [(curve.label, curve.colour, curve.dash) for curve in panel.curves]
    assert styles == [("kth on exact", 1, 1), ("usfd on global", 0, 0)]


def test_only_the_chosen_contact_models_and_pairs_are_shown() -> None:
    spec = {"sweep": "creepage", "x": "creepage", "y": "mean_slip", "contact_models": ["exact"]}
    assert [curve.label for curve in one_panel(shown(spec)).curves] == ["exact"]
    wear = {"profile": "partial_slip", "y": "wear_rate", "pairs": ["kth on exact"]}
    assert [curve.label for curve in one_panel(shown(wear)).curves] == ["kth on exact"]
    along = {"profile": "partial_slip", "y": "traction", "contact_models": ["fastsim"]}
    panel = one_panel(shown(along, contact_models=["exact", "fastsim"]))
    assert [curve.label for curve in panel.curves] == ["traction q, fastsim"]


def test_several_variables_of_one_unit_share_an_axis_and_differ_in_colour() -> None:
    spec = {"sweep": "creepage", "x": "creepage", "y": ["wear_index", "averaged_wear_index"]}
    panel = one_panel(shown(spec))
    assert panel.y.label == "wear index Tγ, averaged wear index [N]"
    assert [(curve.label, curve.colour, curve.dash) for curve in panel.curves] == [
        ("wear index Tγ, global", 0, 0), ("wear index Tγ, exact", 0, 1),
        ("averaged wear index, global", 1, 0), ("averaged wear index, exact", 1, 1),
    ]  # fmt: skip


def test_a_panel_has_what_the_figure_says_and_it_does_not() -> None:
    panels = [{}, {"x_range": ["10 N", "0.05 kN"], "x_scale": "linear", "y_range": ["0 ug/m/mm^2", "1 mg/m/mm^2"]}]
    first, second = shown({**WEAR, "x_scale": "log", "y_scale": "linear", "panels": panels}).panels
    assert (first.x.scale, first.x.ends) == ("log", None)
    assert (second.x.scale, second.x.ends) == ("linear", (10.0, 50.0))
    assert second.y.ends == pytest.approx((0.0, 1000.0), rel=4 * EPS)
    assert by_label(first).keys() == by_label(second).keys()


def test_plain_numbers_are_the_ends_of_an_axis_without_a_unit() -> None:
    spec = {"sweep": "creepage", "x": "creepage", "y": "traction_coefficient", "y_range": [0, 0.5]}
    assert one_panel(shown(spec)).y.ends == (0.0, 0.5)


@pytest.mark.parametrize("scale", ["linear", "log"])
def test_the_y_axis_shows_all_that_is_in_the_window_bands_too(scale: str) -> None:
    window = {"x_range": ["1 N", "100 N"], "y_scale": scale}
    panel = one_panel(shown({**WEAR, **window, "pairs": ["usfd on global", "kth on global"]}))
    kth = by_label(panel)["kth on global"]
    assert kth.low is not None
    assert kth.high is not None
    inside = (kth.x >= 1.0) & (kth.x <= 100.0)
    assert inside.any()
    assert not inside.all()
    assert panel.y.ends is not None
    low, high = panel.y.ends
    assert max(kth.high[inside]) < high < 1.6 * max(kth.high[inside])
    assert low == 0.0 if scale == "linear" else 0.6 * min(kth.low[inside]) < low < min(kth.low[inside])


def test_a_window_without_any_point_leaves_its_y_axis_open() -> None:
    assert one_panel(shown({**WEAR, "x_range": ["1 MN", "2 MN"], "y_scale": "log"})).y.ends is None


def test_a_figure_runs_along_the_axis_that_its_x_names() -> None:
    grid = {**cases.POINT, "max_pressure": ["500 MPa", "1000 MPa", "1500 MPa"], "creepage": ["1 %", "2 %"]}
    ran = case(sweeps={"both": grid}).model_copy(
        update={"figures": {x: {"sweep": "both", "x": x, "y": "wear_rate"} for x in ("half_width", "creepage")}}
    )
    across, along = run(ran).figures
    assert one_panel(across).title == "creepage 2 %"
    assert one_panel(along).title == "maximum pressure 1000 MPa"
    # a = 2 p0 R / E*, here with R = 11.75 mm and E* = 112.0212 GPa
    np.testing.assert_allclose(
        one_panel(across).curves[0].x, 2 * np.array([500, 1000, 1500]) * 11.75 / 112021.2, rtol=1e-6
    )
    np.testing.assert_array_equal(one_panel(along).curves[0].x, [1.0, 2.0])


def test_a_figure_runs_along_friction_where_its_x_is_friction() -> None:
    grid = {**cases.POINT, "friction_coefficient": [0.1, 0.2, 0.4], "creepage": ["5 %", "10 %", "15 %", "20 %"]}
    spec = {"sweep": "both", "x": "friction_coefficient", "y": "traction_coefficient", "contact_models": ["exact"]}
    panel = one_panel(shown(spec, sweeps={"both": grid}))
    assert panel.title == "creepage 15 %"
    np.testing.assert_allclose((panel.curves[0].x, panel.curves[0].y), [[0.1, 0.2, 0.4]] * 2, rtol=16 * EPS)


def test_along_the_patch_signs_are_kept_and_the_creepage_is_a_level_line() -> None:
    spec = {"profile": "back", "y": ["slip", "creepage"]}
    slip, level = one_panel(shown(spec, profiles={"back": {**cases.POINT, "creepage": "-0.5 %"}})).curves
    assert slip.y.min() < -0.5
    assert slip.y.max() == 0.0
    assert_shows(level, slip.x[[0, -1]], [-0.5, -0.5])


def test_a_y_axis_does_not_begin_at_zero_where_something_is_below() -> None:
    spec = {"profile": "back", "y": ["pressure", "traction"]}
    panel = one_panel(shown(spec, profiles={"back": {**cases.POINT, "creepage": "-0.5 %"}}))
    assert panel.y.ends is None


def test_wear_along_the_patch_is_shown_for_every_pair() -> None:
    ran = run(case(figures={"one": {"profile": "partial_slip", "y": "wear_rate"}}))
    (figure,) = ran.figures
    rates = ran.profiles["partial_slip"].wear_rate
    assert [(c.label, c.colour, c.dash) for c in one_panel(figure).curves] == [
        ("usfd on exact", 0, 1),
        ("kth on exact", 1, 1),
    ]
    for curve in one_panel(figure).curves:
        assert_shows(curve, rates.x, rates.sel(pair=curve.label))


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


def points(measured: dict[str, Any], x: str, y: str) -> Curve:
    sweeps = {"creepage": cases.SWEEP, "load": {**cases.POINT, "max_pressure": LOADS}}
    of_load = x in ("normal_force", "half_width")
    spec = {"sweep": "load" if of_load else "creepage", "x": x, "y": y, "measured": True}
    (curve,) = (curve for curve in one_panel(shown(spec, measured=measured, sweeps=sweeps)).curves if curve.points)
    assert curve.label == "my tests"
    return curve


def test_measured_traction_is_shown_where_it_was_measured(measured: dict[str, Any]) -> None:
    traction = points(measured, "creepage", "traction_coefficient")
    np.testing.assert_allclose((traction.x, traction.y), ([1.0, 5.0], [0.3, 0.5]), rtol=4 * EPS)
    force = points(measured, "normal_force", "tangential_force")
    np.testing.assert_allclose((force.x, force.y), ([7000.0, 7000.0], [2100.0, 3500.0]), rtol=8 * EPS)
    assert force.low is None


@pytest.mark.parametrize("x", ["wear_index", "averaged_wear_index"])
def test_measured_wear_is_shown_against_the_measured_wear_index(measured: dict[str, Any], x: str) -> None:
    wear = points(measured, x, "wear_rate")
    np.testing.assert_allclose((wear.x, wear.y), ([21.0], [20.0]), rtol=8 * EPS)


def test_the_uncertainty_of_measured_wear_is_shown(measured: dict[str, Any]) -> None:
    wear = points(measured, "creepage", "wear_rate")
    np.testing.assert_allclose((wear.x, wear.y), ([1.0, 10.0], [20.0, 60.0]), rtol=4 * EPS)
    assert wear.low is not None
    assert wear.high is not None
    against_creepage = {"sweep": "creepage", "x": "creepage", "y": "wear_rate", "measured": True}
    figure = shown(against_creepage, measured=measured)
    draw(figure).draw_without_rendering()
    y_ends = one_panel(figure).y.ends
    assert y_ends is not None
    assert y_ends[0] == 0.0
    assert y_ends[1] > 60.0
    np.testing.assert_allclose((wear.low, wear.high), ([18.0, math.nan], [22.0, math.nan]), rtol=4 * EPS)


def test_the_area_and_width_of_the_patch_in_a_test_are_those_of_its_load(measured: dict[str, Any]) -> None:
    density = points(measured, "half_width", "wear_index_density")
    # 700 N/mm on discs of 47 mm: a² = 4PR/(πE*) in mm and N (Johnson 1985)
    half_width = math.sqrt(4.0 * 700.0 * 47.0 / 4.0 / (math.pi * 206477.42 / (2.0 * (1.0 - 0.28**2))))
    np.testing.assert_allclose(density.x, half_width, rtol=64 * EPS)
    np.testing.assert_allclose(density.y, np.array([21.0, 175.0]) / (20.0 * half_width), rtol=64 * EPS)


def test_measured_traction_is_shown_without_being_asked_for_by_a_case_without_figures(measured: dict[str, Any]) -> None:
    figures = by_name(run(case(measured=measured)))
    assert [c.label for c in one_panel(figures["creepage_traction_against_creepage"]).curves if c.points] == [
        "my tests"
    ]
