"""What lies outside the range of a law, its materials or elastic theory is marked in results, figures and tables."""

from __future__ import annotations

import io
import warnings
from typing import Any

import numpy as np
import pandas as pd
import plotly.graph_objects as go
import pytest

import wearlaw as wl
from tests.core import cases
from tests.core.cases import case
from tests.core.panels import by_label, by_name
from wearlaw import Q
from wearlaw.figures.curves import OUTSIDE, STRIP, Curve, FigureData, Panel, PlotAxis, Shade, in_parts
from wearlaw.figures.drawing import PALE, THIN, draw
from wearlaw.report.interactive import plotly_figure
from wearlaw.report.latex import latex_table
from wearlaw.report.page import report
from wearlaw.report.tables import FOOTNOTES, Marked, cell, profiles, summaries
from wearlaw.study.shades import merged, spans_of
from wearlaw.study.study import Study, run

RIG = wl.TwinDisc.suros()
BRONZE = wl.Material(youngs_modulus="110 GPa", poisson_ratio=0.34, density="8800 kg/m^3")
LOADS = {"from": "300 MPa", "to": "3000 MPa", "points": 28}  # in steps of 100 MPa
X = np.array([1.0, 2.0, 3.0, 4.0])


def silently(pipeline: Any) -> Any:
    """Return the result of composing a pipeline, without its warnings."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return pipeline()


@pytest.fixture(scope="module")
def study() -> Study:
    by_load = {**cases.POINT, "max_pressure": LOADS}
    return run(case(wear_laws=["usfd", "kth"], sweeps={"creepage": cases.SWEEP, "load": by_load}))


@pytest.fixture(scope="module")
def on_rail() -> Study:
    return run(wl.load_case("wheel_on_rail"))


# Predictions


@pytest.mark.parametrize("model", ["exact", "fastsim", "global"])
def test_a_prediction_has_the_limits_of_its_traction(model: str) -> None:
    conditions: dict[str, Any] = {"max_pressure": "1500 MPa", "friction_coefficient": 0.46}
    r = (RIG | wl.contact_model(model))(creepage=Q([0.0, -0.1, 0.5, 5.0], "%"), **conditions)
    k, t = 541.3e6, np.abs(r.traction_coefficient.magnitude)
    first = wl.elastic_limit.first_yield(k, t, 0.46, poisson_ratio=0.28)
    np.testing.assert_allclose(r.first_yield.to("Pa").magnitude, first, rtol=1e-12)
    np.testing.assert_allclose(r.shakedown_limit.to("Pa").magnitude, wl.elastic_limit.shakedown_limit(k, t, 0.46))
    (at_once,) = (RIG | wl.contact_model(model))(creepage=Q([5.0], "%"), **conditions).shakedown_limit
    alone = (RIG | wl.contact_model(model))(creepage="5 %", **conditions).shakedown_limit
    assert alone == at_once
    assert repr(alone) == "1177 MPa"  # k/μ


def test_the_limits_are_those_of_the_body_that_yields_first() -> None:
    weak = wl.steel(shear_yield_stress="300 MPa")
    rig = wl.TwinDisc.suros(disc_2=wl.Disc(diameter="47 mm", material=weak))
    conditions: dict[str, Any] = {"max_pressure": "1500 MPa", "creepage": "5 %", "friction_coefficient": 0.46}
    found = (rig | wl.contact_model("exact"))(**conditions)
    of_weak = (wl.TwinDisc.suros(material=weak) | wl.contact_model("exact"))(**conditions)
    assert found.shakedown_limit == of_weak.shakedown_limit
    assert found.first_yield == of_weak.first_yield


def test_without_a_yield_stress_there_is_no_limit() -> None:
    soft = wl.steel(shear_yield_stress=None)
    r = (wl.TwinDisc.suros(material=soft) | wl.contact_model("exact"))(
        max_pressure="1500 MPa", creepage="1 %", friction_coefficient=0.4
    )
    with pytest.raises(wl.CompositionError, match="no body's material has a shear_yield_stress"):
        r.first_yield  # noqa: B018


def test_the_limits_of_an_ellipse_depend_on_its_axes() -> None:
    rig = wl.WheelRail(wheel_radius="460 mm", rail_head_radius="300 mm", material=wl.steel(), rolling_speed="30 m/s")
    r = (rig | wl.contact_model("polach"))(
        normal_force=Q([50, 200], "kN"), longitudinal_creepage=Q(0.3, "%"), friction_coefficient=0.3
    )
    expected = wl.elastic_limit.shakedown_limit(
        541.3e6,
        r.traction_coefficient.magnitude,
        0.3,
        axis_ratio=(r.semi_axis_a / r.semi_axis_b).to("").magnitude,
    )
    np.testing.assert_allclose(r.shakedown_limit.to("Pa").magnitude, expected, rtol=1e-12)


def test_points_outside_are_those_that_the_warning_counts() -> None:
    predict = RIG | wl.contact_model("global") | wl.wear_law("usfd")
    pressure = Q([300, 899, 900, 1500, 1800, 1801], "MPa")
    r = predict(max_pressure=pressure, creepage="1 %", friction_coefficient=0.46)
    assert r.outside_range.magnitude.tolist() == [1, 1, 0, 0, 0, 1]
    with pytest.warns(wl.RangeWarning, match="wear index density .* 1 of 3 operating points lies outside"):
        r = predict(max_pressure="1500 MPa", creepage=Q([1, 20, -20.1], "%"), friction_coefficient=0.46)
    assert r.outside_range.magnitude.tolist() == [0, 0, 1]


def test_all_points_of_other_materials_are_outside() -> None:
    predict = silently(lambda: wl.TwinDisc.suros(material=BRONZE) | wl.contact_model("global") | wl.wear_law("brr"))
    r = predict(max_pressure="1000 MPa", creepage=Q([1, 2], "%"), friction_coefficient=0.3)
    assert r.outside_range.magnitude.tolist() == [1, 1]


def test_a_law_without_a_record_has_no_outside() -> None:
    law = wl.wear_law("kth", pressure_threshold="1 GPa")
    r = (RIG | wl.contact_model("global") | law)(max_pressure="5 GPa", creepage="90 %", friction_coefficient=0.4)
    assert r.outside_range == 0


# Results


def test_results_hold_the_marks_of_each_pair_and_the_limits_of_each_contact_model(study: Study) -> None:
    sweep = study.sweeps["load"]
    for model in ("global", "exact"):
        predict = silently(lambda model=model: RIG | wl.contact_model(model) | wl.wear_law("usfd"))
        loads = Q(sweep.max_pressure.values, "MPa")
        r = predict(**{**cases.POINT, "max_pressure": loads})
        outside = sweep.outside_range.sel(pair=f"usfd on {model}").values
        np.testing.assert_array_equal(outside, r.outside_range.magnitude)
        assert outside.tolist() == [float(not 900 <= load <= 1800) for load in np.round(sweep.max_pressure.values)]
        limit = sweep.shakedown_limit.sel(contact_model=model).values
        np.testing.assert_allclose(limit, r.shakedown_limit.magnitude, rtol=1e-14)


# Figures of a case


def test_curves_are_marked_where_the_law_is_outside(study: Study) -> None:
    (panel,) = by_name(study)["load_wear_rate_over_max_pressure"].panels
    curves = by_label(panel)
    for pair in ("usfd on global", "usfd on exact"):
        outside = study.sweeps["load"].outside_range.sel(pair=pair).values > 0
        assert curves[pair].outside is not None
        np.testing.assert_array_equal(curves[pair].outside, outside)
        assert 0 < outside.sum() < outside.size
    # KTH: Hertz's maximum is 4/π of a mean pressure of 2.1 GPa.
    outside = np.asarray(curves["kth on global"].outside)
    np.testing.assert_array_equal(outside, curves["kth on global"].x > 2100.0 * 4.0 / np.pi)


@pytest.mark.parametrize("name", ["load_wear_rate_over_max_pressure", "creepage_traction_over_creepage"])
def test_a_strip_shows_where_the_contact_of_any_model_is_beyond_shakedown(study: Study, name: str) -> None:
    figure = by_name(study)[name]
    (panel,) = figure.panels
    sweep = study.sweeps[name.partition("_")[0]]
    (shade,) = panel.shades
    assert (shade.label, shade.strip) == ("beyond shakedown", True)
    beyond = (sweep.max_pressure > sweep.shakedown_limit).any("contact_model").values
    shaded = [any(low <= value <= high for low, high in shade.spans) for value in panel.curves[0].x]
    assert shaded == beyond.tolist()
    assert 0 < beyond.sum() < beyond.size
    assert figure.caption.endswith("beyond shakedown: see First yield and shakedown, theory.md.")


def test_the_strip_of_one_operating_point_is_as_long_as_the_patch(study: Study) -> None:
    for panel in by_name(study)["partial_slip_along_the_patch"].panels:
        ends = min(curve.x.min() for curve in panel.curves), max(curve.x.max() for curve in panel.curves)
        assert [shade.spans for shade in panel.shades] == [(ends,)]


def test_an_elastic_case_is_not_shaded() -> None:
    small = {**cases.SWEEP, "max_pressure": "500 MPa"}
    figures = run(
        case(sweeps={"creepage": small}, profiles={"one": {**cases.POINT, "max_pressure": "500 MPa"}})
    ).figures
    assert all(panel.shades == () for figure in figures for panel in figure.panels)


def test_a_rig_without_a_yield_stress_is_not_shaded() -> None:
    soft = {
        "diameter": "47 mm",
        "material": {"youngs_modulus": "206 GPa", "poisson_ratio": 0.28, "density": "7850 kg/m^3"},
    }
    rig = {"type": "twin_disc", "disc_1": soft, "disc_2": soft, "track_width": "10 mm", "rolling_speed": "1 m/s"}
    found = run(case(rig=rig))
    assert all(panel.shades == () for figure in found.figures for panel in figure.panels)
    assert "shakedown_limit" not in found.sweeps["creepage"]


def test_the_wear_of_a_rail_is_outside_a_law_of_wheel_steel(on_rail: Study) -> None:
    elastic = on_rail.profiles["curve"].outside_range
    assert elastic.sel(pair="kth on fastsim") == 0
    wheel, rail, *_ = by_name(on_rail)["curve_profile"].panels
    assert np.asarray(by_label(rail)["usfd on fastsim"].outside).all()
    assert not np.asarray(by_label(rail)["kth on fastsim"].outside).any()
    outside = bool(elastic.sel(pair="usfd on fastsim").item())
    assert np.asarray(by_label(wheel)["usfd on fastsim"].outside).all() == outside


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


def test_spans_that_touch_become_one() -> None:
    assert list(merged([(3.0, 4.0), (1.0, 2.0), (2.0, 2.5), (3.5, 3.6)])) == [(1.0, 2.5), (3.0, 4.0)]
    assert list(merged([])) == []


# Drawings

OUT = np.array([False, False, True, True])
MARKED = FigureData(
    "marked",
    "Marked",
    (
        Panel(
            PlotAxis("x [-]"),
            PlotAxis("y [-]"),
            (Curve("a", X, X, colour=1, outside=OUT), Curve("b", X, 2.0 * X)),
            shades=(
                Shade("most of the samples", ((1.5, 2.0), (2.5, 4.0))),
                Shade("beyond shakedown", ((3.0, 4.0),), strip=True),
            ),
        ),
    ),
)


def test_a_curve_falls_into_parts_that_meet_at_the_last_point_inside() -> None:
    inside, outside = in_parts(MARKED.panels[0].curves[0])
    np.testing.assert_array_equal(inside, [1.0, 2.0, np.nan, np.nan])
    np.testing.assert_array_equal(outside, [np.nan, 2.0, 3.0, 4.0])
    for flags in (None, np.zeros(4, dtype=bool)):
        whole, none = in_parts(Curve("c", X, X, outside=flags))
        assert whole is X
        assert none is None


def test_in_print_the_part_outside_is_thin_and_pale_and_shades_are_grey() -> None:
    figure = draw(MARKED)
    (axes,) = figure.axes
    inside, outside, other = axes.get_lines()
    np.testing.assert_array_equal(inside.get_ydata(), [1.0, 2.0, np.nan, np.nan])
    np.testing.assert_array_equal(outside.get_ydata(), [np.nan, 2.0, 3.0, 4.0])
    assert (outside.get_linewidth(), outside.get_alpha()) == (THIN, PALE)
    assert outside.get_color() == inside.get_color()
    assert inside.get_linewidth() == other.get_linewidth() > 1.5 * THIN
    spans = [(patch.get_x(), patch.get_x() + patch.get_width()) for patch in axes.patches]  # type: ignore[attr-defined]
    assert spans == [(1.5, 2.0), (2.5, 4.0), (3.0, 4.0)]
    assert all(patch.get_zorder() < line.get_zorder() for patch in axes.patches for line in axes.get_lines())
    assert [patch.get_height() for patch in axes.patches] == [1.0, 1.0, STRIP]  # type: ignore[attr-defined]
    names = [text.get_text() for text in figure.legends[0].get_texts()]
    assert names == ["a", "b", "most of the samples", "beyond shakedown", OUTSIDE]


def test_on_the_page_the_part_outside_is_thin_and_pale_and_shades_are_below() -> None:
    drawn = plotly_figure(MARKED)
    go.Figure(drawn)  # plotly refuses what it does not know
    inside, outside, *others = (trace for trace in drawn["data"] if trace["name"] != "b")
    assert inside["y"] == [1.0, 2.0, None, None]
    assert outside["y"] == [None, 2.0, 3.0, 4.0]
    assert (outside["line"]["width"], outside["opacity"]) == (THIN, PALE)
    assert outside["legendgroup"] == inside["legendgroup"]
    assert [(trace["name"], trace["showlegend"]) for trace in (inside, outside, *others)] == [
        ("a", True), ("a", False), ("most of the samples", True), ("beyond shakedown", True), (OUTSIDE, True),
    ]  # fmt: skip
    shapes = drawn["layout"]["shapes"]
    assert [(shape["x0"], shape["x1"]) for shape in shapes] == [(1.5, 2.0), (2.5, 4.0), (3.0, 4.0)]
    assert {(shape["layer"], shape["yref"], shape["xref"]) for shape in shapes} == {("below", "y domain", "x")}
    assert [shape["y1"] for shape in shapes] == [1, 1, STRIP]


@pytest.mark.parametrize("ends", [(1.0, 2.0), None])
def test_the_legend_explains_only_what_is_seen(ends: Any) -> None:
    panel = Panel(PlotAxis("x [-]", ends=ends), PlotAxis("y [-]"), (Curve("a", X, X, outside=OUT),))
    figure = FigureData("one", "One", (panel,))
    in_print = [text.get_text() for text in draw(figure).legends[0].get_texts()]
    on_page = [trace["name"] for trace in plotly_figure(figure)["data"] if trace["showlegend"]]
    assert (OUTSIDE in in_print) == (OUTSIDE in on_page) == (ends is None)


# Tables


def marks_of(frame: pd.DataFrame, row: str) -> list[str]:
    (found,) = (values for values in frame.itertuples(index=False, name=None) if values[0] == row)
    return [value.marks for value in found[1:]]


def test_tables_mark_wear_rates_and_say_what_the_marks_mean(study: Study) -> None:
    table = {one.name: one for one in summaries(study)}["wear_rate_load"]
    heads = [float(head) for head in table.frame.columns[1:]]
    sweep = study.sweeps["load"].sel(max_pressure=heads, method="nearest")
    assert heads == [300, 1000, 1700, 2300, 3000]
    for row, pair in (("usfd on exact", "usfd on exact"), ("kth on global, low end", "kth on global")):
        one = sweep.sel(pair=pair)
        limits = sweep.sel(contact_model=one.pair_contact_model.item())
        expected = [
            ("†" if outside else "") + ("‡" if p > shakedown else "*" if p > first else "")
            for outside, p, first, shakedown in zip(
                one.outside_range.values, heads, limits.first_yield.values, limits.shakedown_limit.values, strict=True
            )
        ]
        assert marks_of(table.frame, row) == expected
        assert len(set(expected)) > 2
    assert table.footnotes == tuple(f"{mark} {meaning}" for mark, meaning in FOOTNOTES.items())


def test_marks_are_in_the_report_and_for_latex_but_not_in_numbers(study: Study) -> None:
    table = {one.name: one for one in summaries(study)}["wear_rate_load"]
    page = report(study, "")
    assert "<sup>†‡</sup>" in page
    assert "‡ beyond shakedown" in page
    latex = latex_table(table.frame, table.footnotes)
    assert r"\begin{tabular}{lrrrrr}" in latex
    assert r"$\textdagger{}\textdaggerdbl{}" in latex
    assert r"\par{\footnotesize \textdaggerdbl{} beyond shakedown}" in latex
    numbers = table.frame.to_csv(index=False)
    assert "†" not in numbers
    read = pd.read_csv(io.StringIO(numbers))
    np.testing.assert_array_equal(read.iloc[:, 1:], table.frame.iloc[:, 1:].astype(float))


def test_a_marked_number_is_a_number() -> None:
    assert cell(Marked(1234.5678, "†")) == cell(1234.5678).__class__("1235", number=True, marks="†")
    assert cell(Marked(np.nan, "")).text == ""


def test_the_table_of_a_profile_marks_the_rail(on_rail: Study) -> None:
    table = {one.name: one for one in profiles(on_rail)}["profile_curve"]
    rail = next(head for head in table.frame.columns if head.startswith("rail: greatest depth"))
    assert [value.marks for value in table.frame[rail]] == ["†", ""]
    assert table.footnotes == (f"† {FOOTNOTES['†']}",)
