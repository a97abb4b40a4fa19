"""The data that figures hand to plotly.js; a browser draws them in test_report_browser.py."""

from __future__ import annotations

import html
import json
from typing import Any, Literal

import numpy as np
import plotly.graph_objects as go
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from matplotlib.colors import to_hex

from tests.core import report_data as data
from tests.core.report_data import ONE, THREE
from wearlaw.figures.curves import Curve, FigureData, Map, Panel, PlotAxis
from wearlaw.figures.drawing import draw
from wearlaw.report.interactive import literal, plotly_figure

SEVEN_DIGITS = 5e-7
"""Half a unit of the seventh digit, relative to the number."""


def traces(figure: FigureData) -> dict[str, Any]:
    """Return the curves of the first panel by their names."""
    return {t["name"]: t for t in plotly_figure(figure)["data"] if t["xaxis"] == "x" and t.get("fill") is None}


@pytest.fixture
def one() -> dict[str, Any]:
    return traces(ONE)


@pytest.mark.parametrize("figure", [ONE, THREE, data.ODD])
def test_plotly_accepts_the_figure_and_it_is_json(figure: FigureData) -> None:
    drawn = plotly_figure(figure)
    go.Figure(drawn)  # plotly refuses what it does not know
    assert json.loads(json.dumps(drawn, allow_nan=False)) == json.loads(json.dumps(drawn))


def test_every_curve_is_a_trace_with_its_numbers(one: dict[str, Any]) -> None:
    assert list(one) == [curve.label for curve in data.LOG_LOG.curves]
    for curve in data.LOG_LOG.curves:
        for name in ("x", "y"):
            numbers = np.array(one[curve.label][name], dtype=float)
            finite = np.where(np.isfinite(getattr(curve, name)), getattr(curve, name), np.nan)
            np.testing.assert_allclose(numbers, finite, rtol=SEVEN_DIGITS)


def test_numbers_have_seven_digits() -> None:
    curve = Curve("thirds", np.array([1.0]) / 3.0, np.array([2e9]) / 3.0)
    axis = PlotAxis("x [-]")
    (trace,) = plotly_figure(FigureData("f", "", (Panel(axis, axis, (curve,)),)))["data"]
    assert (trace["x"], trace["y"]) == ([0.3333333], [666666700.0])


def test_what_is_not_a_number_is_left_out(one: dict[str, Any]) -> None:
    assert one["gaps"]["y"] == [None, 1.0, None, 2.0]


def test_only_measurements_and_single_points_of_a_line_have_markers(one: dict[str, Any]) -> None:
    modes = {name: trace["mode"] for name, trace in one.items()}
    assert modes.pop("tests") == modes.pop("uncertain tests") == "markers"
    assert {name for name, mode in modes.items() if mode == "lines+markers"} == {"lone", "gaps"}
    assert {mode for name, mode in modes.items() if name not in ("lone", "gaps")} == {"lines"}
    some = Curve("some", np.arange(5.0), np.array([1.0, 2.0, 3.0, np.nan, 5.0]))
    (trace,) = traces(FigureData("f", "", (Panel(PlotAxis("x"), PlotAxis("y"), (some,)),))).values()
    assert trace["selectedpoints"] == [4]
    assert trace["unselected"] == {"marker": {"opacity": 0}}


def test_markers_are_those_of_the_printed_figure(one: dict[str, Any]) -> None:
    symbols = {"s": "square", "^": "triangle-up", "D": "diamond", "v": "triangle-down", "X": "x", "o": "circle"}
    (axes,) = draw(ONE).axes
    printed = {str(line.get_label()): line for line in axes.get_lines()}
    for name in ("tests", "uncertain tests"):
        assert one[name]["marker"]["symbol"] == symbols[str(printed[name].get_marker())]
    assert {one[name]["marker"]["symbol"] for name in ("lone", "gaps")} == {"circle"}
    assert {printed[name].get_marker() for name in ("lone", "gaps")} == {"."}


def test_colours_and_line_styles_are_those_of_the_printed_figure(one: dict[str, Any]) -> None:
    (axes,) = draw(ONE).axes
    printed = {label: line for line in axes.get_lines() if (label := str(line.get_label())) != "_nolegend_"}
    assert printed.keys() == one.keys()
    names = {"-": "solid", "--": "dash", ":": "dot", "-.": "dashdot"}
    for name, trace in one.items():
        assert trace["line"]["color"].lower() == trace["marker"]["color"].lower() == to_hex(printed[name].get_color())
        if trace["mode"] != "markers":
            pattern = printed[name]._unscaled_dash_pattern[1]  # type: ignore[attr-defined]
            shown = trace["line"]["dash"]
            if "px" in shown:  # twice the lengths in line widths, on a line of two pixels
                assert [float(length) for length in shown.replace("px", "").split(",")] == [2.0 * n for n in pattern]
            else:
                assert shown == names[str(printed[name].get_linestyle())]
    assert len({trace["line"]["color"] for trace in one.values()}) > 5
    lines = [trace["line"]["dash"] for trace in one.values() if trace["mode"] != "markers"]
    assert len(set(lines)) == len(lines), "two of them would differ only in colour"


def test_bars_lie_along_the_axis_without_names_with_their_numbers() -> None:
    bar = Curve("a", np.array([3.0]), np.array([0.0]), low=np.array([1.0]), high=np.array([7.0]), bars=0.7)
    panel = Panel(PlotAxis("wear [g]"), PlotAxis("", names=("a",)), (bar,))
    drawn = plotly_figure(FigureData("f", "", (panel,)))
    go.Figure(drawn)
    (trace,) = drawn["data"]
    assert (trace["type"], trace["orientation"], trace["x"], trace["y"]) == ("bar", "h", [3.0], [0.0])
    assert trace["text"] == ["3 (1 to 7)"]
    assert (trace["error_x"]["array"], trace["error_x"]["arrayminus"]) == ([4.0], [2.0])


@pytest.mark.parametrize("scale", ["linear", "log"])
def test_maps_share_a_scale_of_colours(scale: Literal["linear", "log"]) -> None:
    values = np.array([[1.0, 10.0, 100.0], [2.0, 20.0, np.nan]])
    maps = [Map("wear [g]", np.arange(3.0), np.arange(2.0), factor * values, scale, {"beyond": values > 5.0})
            for factor in (1.0, 7.0)]  # fmt: skip
    drawn = plotly_figure(FigureData("f", "", tuple(Panel(PlotAxis("a"), PlotAxis("b"), (), map=m) for m in maps)))
    go.Figure(drawn)
    assert json.loads(json.dumps(drawn, allow_nan=False)) == json.loads(json.dumps(drawn))
    heats = [trace for trace in drawn["data"] if trace["type"] == "heatmap"]
    ends = [0.0, np.log10(700.0)] if scale == "log" else [1.0, 700.0]
    for heat in heats:
        assert [heat["zmin"], heat["zmax"]] == pytest.approx(ends, rel=1e-15)
    assert heats[0]["customdata"] == [[1.0, 10.0, 100.0], [2.0, 20.0, None]]
    assert [heat["showscale"] for heat in heats] == [True, False]
    assert [trace["showlegend"] for trace in drawn["data"] if trace["type"] == "contour"] == [True, False]


def test_axes_have_their_labels_scales_and_ends() -> None:
    layout = plotly_figure(THREE)["layout"]
    for number, panel in zip(("", 2, 3), THREE.panels, strict=True):
        for axis, expected in ((layout[f"xaxis{number}"], panel.x), (layout[f"yaxis{number}"], panel.y)):
            assert html.unescape(axis["title"]["text"]) == expected.label
            assert axis["type"] == expected.scale
    assert "range" not in layout["xaxis"]
    assert layout["xaxis2"]["range"] == [0.0, 1.0]
    assert layout["yaxis2"]["range"] == [-1.0, 1.0]  # plotly.js takes the exponents of 0.1 and 10


@pytest.mark.parametrize("ends", [None, (0.1, 10.0)])
def test_axes_can_be_inverted_equal_and_named(ends: tuple[float, float] | None) -> None:
    y = PlotAxis("z [mm]", "log", ends, inverted=True)
    panel = Panel(PlotAxis("patch", names=("left & 1", "right 1")), y, (data.FALLING,), equal=True)
    drawn = plotly_figure(FigureData("f", "", (panel, panel)))
    go.Figure(drawn)
    layout = drawn["layout"]
    for number in ("", 2):
        x, y_axis = layout[f"xaxis{number}"], layout[f"yaxis{number}"]
        assert (x["tickvals"], x["ticktext"]) == ([0, 1], ["left &amp; 1", "right 1"])
        assert y_axis["scaleanchor"] == f"x{number}"
        assert x["constrain"] == y_axis["constrain"] == "domain"
        assert y_axis.get("range") == (None if ends is None else [1.0, -1.0])
        assert y_axis.get("autorange") == ("reversed" if ends is None else None)
    plain = plotly_figure(ONE)["layout"]
    assert not {"scaleanchor", "constrain", "autorange", "tickvals"} & {*plain["xaxis"], *plain["yaxis"]}


def test_a_point_between_gaps_has_a_marker() -> None:
    curve = Curve("gaps", np.arange(5.0), np.array([1.0, np.nan, 1.0, 1.0, np.nan]))
    (trace,) = traces(FigureData("f", "", (Panel(PlotAxis("x"), PlotAxis("y"), (curve,)),))).values()
    assert (trace["mode"], trace["selectedpoints"]) == ("lines+markers", [0])
    assert trace["y"] == [1.0, None, 1.0, 1.0, None]
    assert "connectgaps" not in trace


def bands(figure: FigureData) -> dict[str, Any]:
    return {trace["legendgroup"]: trace for trace in plotly_figure(figure)["data"] if trace.get("fill")}


def test_a_band_is_filled_between_its_ends_and_goes_with_its_curve() -> None:
    band = bands(ONE)["rising"]
    corners = set(zip(band["x"], band["y"], strict=True))
    assert corners == {(x, factor * x) for x in data.X for factor in (2.0, 4.0)}
    assert band["x"] == [*data.X, *data.X[::-1]]  # once around, not back and forth
    assert (band["fill"], band["hoverinfo"], band["showlegend"]) == ("toself", "skip", False)


def test_a_band_begins_where_its_axes_can_show_it() -> None:
    """Its low end reaches zero at 0.1, which no logarithmic axis has."""
    assert set(bands(ONE)["from nothing"]["x"]) == {1.0, 10.0}
    linear = Panel(PlotAxis("x [-]"), PlotAxis("y [-]"), (data.WITHOUT_WEAR,))
    assert set(bands(FigureData("f", "", (linear,)))["from nothing"]["x"]) == set(data.X)


def test_the_colour_of_a_band_is_that_of_its_curve(one: dict[str, Any]) -> None:
    for name, band in bands(ONE).items():
        red, green, blue, opacity = band["fillcolor"].removeprefix("rgba(").removesuffix(")").split(", ")
        assert f"#{int(red):02X}{int(green):02X}{int(blue):02X}" == one[name]["line"]["color"]
        assert 0.0 < float(opacity) < 0.5


def test_the_ends_of_measured_points_are_error_bars(one: dict[str, Any]) -> None:
    bars = one["uncertain tests"]["error_y"]
    np.testing.assert_allclose(bars["array"], 0.25 * data.X, rtol=SEVEN_DIGITS)
    np.testing.assert_allclose(bars["arrayminus"], 0.5 * data.X, rtol=SEVEN_DIGITS)
    assert "uncertain tests" not in bands(ONE)


def test_hovering_shows_name_values_units_and_the_band(one: dict[str, Any]) -> None:
    hover = one["rising"]["hovertemplate"]
    assert html.unescape(hover) == (
        "<b>rising</b><br>creepage [%]: %{x:.4~g}<br>wear rate [µg/m/mm²]: %{y:.4~g}"
        "<br>from %{customdata[0]:.4~g} to %{customdata[1]:.4~g}<extra></extra>"
    )
    assert one["rising"]["customdata"] == [[2.0 * x, 4.0 * x] for x in data.X]
    assert "customdata" not in one["falling"]["hovertemplate"]


def test_the_legend_names_each_curve_once_and_switches_it_in_all_panels() -> None:
    drawn = plotly_figure(THREE)["data"]
    assert [trace["name"] for trace in drawn if trace["showlegend"]] == [c.label for c in data.LOG_LOG.curves]
    assert [trace["xaxis"] for trace in drawn if trace["legendgroup"] == "rising"] == [
        *("x", "x", "x2", "x2", "x3", "x3")
    ]
    assert all(trace["name"] == trace["legendgroup"] for trace in drawn)


@pytest.mark.parametrize("count", range(1, 7))
def test_panels_stand_side_by_side_as_in_print(count: int) -> None:
    axis = PlotAxis("x [-]")
    figure = FigureData("f", "", (Panel(axis, axis, (data.RISING,)),) * count)
    layout, printed = plotly_figure(figure)["layout"], draw(figure)
    printed.draw_without_rendering()
    numbers = ["", *range(2, count + 1)]
    places = [(layout[f"xaxis{n}"]["domain"], layout[f"yaxis{n}"]["domain"]) for n in numbers]
    assert all(0.0 <= low < high <= 1.0 for place in places for low, high in place)
    for number, (across, up) in enumerate(places):
        for other, (other_across, other_up) in enumerate(places):
            here, there = printed.axes[number].get_position(), printed.axes[other].get_position()
            assert (across[1] <= other_across[0]) == (here.x1 <= there.x0)
            assert (up[1] <= other_up[0]) == (here.y1 <= there.y0)


@given(st.text())
@example("<b>%{y}</b> &amp; &lt $x$")
def test_a_text_is_handed_over_without_anything_to_interpret(text: str) -> None:
    handed = literal(text)
    assert html.unescape(handed) == text
    assert not {"<", ">", "%"} & set(handed)
