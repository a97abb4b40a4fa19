"""Both drawers, matplotlib and plotly: every curve, band, point and region of the description, in one style."""

from __future__ import annotations

import html
import json
from typing import Any, Literal

import numpy as np
import plotly.graph_objects as go
import pytest
from matplotlib.axes import Axes
from matplotlib.colors import to_hex
from matplotlib.figure import Figure

from tests.plugins.studies import report_data as data
from tests.plugins.studies.report_data import ONE, THREE
from wearlaw import Curve, FigureData, Panel, PlotAxis
from wearlaw_apps.output import Limit
from wearlaw_apps.output.curves import OUTSIDE, STRIP, Map, Shade, in_parts  # private: rarer parts of the description
from wearlaw_apps.output.drawing import draw, line_styles  # private: the drawer
from wearlaw_apps.output.style import (  # private: the looks that both drawers share
    BAND,
)
from wearlaw_apps.studies.report.interactive import plotly_figure  # private: the drawer for the page

X = np.array([1.0, 2.0, 4.0])
SEVEN_DIGITS = 5e-7
"""Half a unit of the seventh digit, relative to the number."""


def curve(label: str = "a", **changes: Any) -> Curve:
    return Curve(**{"label": label, "x": X, "y": 10.0 * X, **changes})


def panel(*curves: Curve, **changes: Any) -> Panel:
    return Panel(**{"x": PlotAxis("load [N]"), "y": PlotAxis("wear [g]"), "curves": curves or (curve(),), **changes})


def both(*panels: Panel, **changes: Any) -> tuple[Figure, dict[str, Any]]:
    """Return a figure drawn by both, to the end, so that what is wrong with it shows."""
    figure = FigureData("name", "A figure", panels or (panel(),), **changes)
    drawn, interactive = draw(figure), plotly_figure(figure)
    drawn.draw_without_rendering()
    go.Figure(interactive)  # plotly refuses what it does not know
    assert json.loads(json.dumps(interactive, allow_nan=False)) == json.loads(json.dumps(interactive))
    return drawn, interactive


def axes_of(*curves: Curve, **changes: Any) -> Axes:
    (axes,) = both(panel(*curves, **changes))[0].axes
    return axes


def names(figure: Figure) -> list[str]:
    return [text.get_text() for text in figure.legends[0].get_texts()]


def traces(figure: FigureData) -> dict[str, Any]:
    """Return the curves of the first panel on the page by their names."""
    return {t["name"]: t for t in plotly_figure(figure)["data"] if t["xaxis"] == "x" and t.get("fill") is None}


# Curves


@pytest.mark.parametrize("figure", [ONE, THREE, data.ODD])
def test_every_curve_has_its_numbers_colour_and_line_style_in_both(figure: FigureData) -> None:
    drawn, shown = draw(figure), traces(figure)
    go.Figure(plotly_figure(figure))
    lines = (line for line in drawn.axes[0].get_lines() if not str(line.get_label()).startswith("_"))
    printed = {str(line.get_label()).strip(): line for line in lines}
    names_of_dashes = {"-": "solid", "--": "dash", ":": "dot", "-.": "dashdot"}
    assert len(printed) == len(shown) == len(figure.panels[0].curves)
    for one, line, trace in zip(figure.panels[0].curves, printed.values(), shown.values(), strict=True):
        np.testing.assert_array_equal(line.get_xydata(), np.column_stack([one.x, one.y]))
        numbers = np.array([trace["x"], trace["y"]], dtype=float)
        np.testing.assert_allclose(numbers, np.where(np.isfinite([one.x, one.y]), [one.x, one.y], np.nan), SEVEN_DIGITS)
        assert trace["line"]["color"].lower() == trace["marker"]["color"].lower() == to_hex(line.get_color())
        if one.points:
            symbols = {"s": "square", "^": "triangle-up", "D": "diamond", "v": "triangle-down", "X": "x", "o": "circle"}
            assert trace["marker"]["symbol"] == symbols[str(line.get_marker())]
            assert (trace["mode"], line.get_linestyle()) == ("markers", "None")
        elif "px" not in trace["line"]["dash"]:
            assert trace["line"]["dash"] == names_of_dashes[str(line.get_linestyle())]


def test_where_only_colour_would_tell_lines_apart_each_line_of_the_figure_has_a_style() -> None:
    a, b = curve("a"), curve("b", colour=1)
    assert line_styles(FigureData("f", "", (panel(a), panel(a, b)))) == {(0, 0): 0, (1, 0): 1}
    apart = FigureData("f", "", (panel(curve("a", dash=2), curve("b", colour=1, dash=1)), panel(curve("c", colour=3))))
    assert line_styles(apart) == {(0, 2): 2, (1, 1): 1, (3, 0): 0}


def marks(*curves: Curve, **changes: Any) -> list[list[int]]:
    """Return the points with a marker of each curve, the same by both drawers."""
    drawn, shown = both(panel(*curves, **changes))
    lines, on_page = drawn.axes[0].get_lines(), shown["data"]
    found: list[Any] = [line.get_markevery() if line.get_marker() else [] for line in lines]
    for indices, trace in zip(found, on_page, strict=True):
        every = [*range(np.isfinite(np.array(trace["y"], float)).sum())]
        assert (trace["mode"] == "lines+markers") == bool(indices)
        assert trace.get("selectedpoints", every if indices else []) == indices
    return found


def test_a_point_of_a_line_without_neighbours_has_a_marker_and_gaps_stay_open() -> None:
    gaps = curve(x=np.arange(6.0), y=np.array([1.0, np.nan, 1.0, 1.0, np.nan, 1.0]), computed=False)
    assert marks(gaps) == [[0, 5]]
    _, shown = both(panel(gaps))
    assert shown["data"][0]["unselected"] == {"marker": {"opacity": 0}}


def test_few_computed_points_have_a_marker_each_and_a_formula_has_none() -> None:
    assert marks(curve(), curve("b", computed=False)) == [[0, 1, 2], []]
    many = np.linspace(0.0, 1.0, 1001)
    assert marks(curve(x=many, y=many)) == [[]]


def test_lines_of_laws_have_marks_at_equal_lengths_along_them_on_the_scales_of_the_panel() -> None:
    x = np.geomspace(1.0, 1000.0, 1000)
    laws = [curve(str(number), x=x, y=x**2, colour=number, outside=np.zeros(1000, bool)) for number in range(2)]
    first, second = marks(*laws, x=PlotAxis("x", "log"), y=PlotAxis("y", "log"))
    assert first == []
    steps = np.diff(np.log(x[second]))
    assert len(second) == 7
    assert steps == pytest.approx(np.log(1000.0) / 7.0, abs=2.0 * np.log(x[1] / x[0]))  # the nearest points
    drawn, _ = both(panel(*laws))
    assert [line.get_linestyle() for line in drawn.axes[0].get_lines()] == ["-", "-"]


def test_a_band_is_light_with_edges_between_its_ends() -> None:
    band = curve(low=X, high=20.0 * X)
    drawn, shown = both(panel(band))
    (filled,) = drawn.axes[0].collections
    corners = {*zip(X, X, strict=True), *zip(X, 20.0 * X, strict=True)}
    assert {tuple(corner) for corner in np.asarray(filled.get_paths()[0].vertices)} == corners
    assert np.asarray(filled.get_facecolor(), dtype=float)[0, 3] == BAND
    outline, line = shown["data"]
    assert set(zip(outline["x"], outline["y"], strict=True)) == corners
    assert outline["x"] == [*X, *X[::-1]], "once around, not back and forth"
    assert outline["legendgroup"] == line["legendgroup"]
    assert line["customdata"] == [[x, 20.0 * x] for x in X]
    assert drawn.legends[0].get_title().get_text() == shown["layout"]["legend"]["title"]["text"]
    assert drawn.legends[0].get_title().get_text() == "bands: published range of parameters"


def test_a_band_begins_where_its_axes_can_show_it() -> None:
    from_zero = curve(low=X - 1.0, high=X)
    _, shown = both(panel(from_zero, y=PlotAxis("y", "log")))
    assert set(shown["data"][0]["x"]) == {2.0, 4.0}


@pytest.mark.parametrize("hollow", [True, False])
def test_points_have_error_bars(hollow: bool) -> None:
    x, y = np.array([0.0]), np.array([3.0])
    drawn, shown = both(panel(curve("one", x=x, y=y, low=y - 2.0, high=y + 4.0, points=True, hollow=hollow)))
    (bar,) = drawn.axes[0].collections
    segments: Any = bar
    assert np.asarray(segments.get_segments()).tolist() == [[[0.0, 1.0], [0.0, 7.0]]]
    (trace,) = shown["data"]
    assert (trace["error_y"]["array"], trace["error_y"]["arrayminus"]) == ([4.0], [2.0])
    assert trace["marker"]["symbol"].endswith("-open") == hollow


OUT = np.array([False, False, True])
MARKED = panel(
    curve("a", colour=1, outside=OUT),
    curve("b", y=X),
    shades=(Shade("most of the samples", ((1.5, 2.0), (2.5, 4.0))), Shade("beyond", ((3.0, 4.0),), strip=True)),
)


def test_parts_outside_are_dashed_at_full_colour_and_shades_lie_below_in_both() -> None:
    inside, outside = in_parts(MARKED.curves[0])
    np.testing.assert_array_equal(inside, [10.0, 20.0, np.nan])
    np.testing.assert_array_equal(outside, [np.nan, 20.0, 40.0])
    drawn, shown = both(MARKED)
    (axes,) = drawn.axes
    part, whole, _ = axes.get_lines()
    assert (part.get_linewidth(), part.get_alpha(), part.get_color()) == (
        whole.get_linewidth(),
        None,
        whole.get_color(),
    )
    assert (part.get_linestyle(), whole.get_linestyle()) == ("--", "-")
    spans = [(patch.get_x(), patch.get_x() + patch.get_width(), patch.get_height()) for patch in axes.patches]  # type: ignore[attr-defined]
    assert spans == [(1.5, 2.0, 1.0), (2.5, 4.0, 1.0), (3.0, 4.0, STRIP)]
    assert [(s["x0"], s["x1"], s["y1"]) for s in shown["layout"]["shapes"]] == spans
    assert {shape["layer"] for shape in shown["layout"]["shapes"]} == {"below"}
    whole, dashed, *_ = shown["data"]
    assert dashed["y"] == [None, 20.0, 40.0]
    assert "opacity" not in dashed
    assert dashed["line"] == {**whole["line"], "dash": "6px,3.2px"}
    assert names(drawn) == ["a", "b", "most of the samples", "beyond", OUTSIDE]
    assert [trace["name"] for trace in shown["data"] if trace["showlegend"]] == names(drawn)


def test_a_law_that_is_outside_everywhere_is_dashed_in_the_legend_too() -> None:
    drawn, shown = both(panel(curve("a", outside=np.ones(3, bool)), curve("b", y=X)))
    samples = drawn.legends[0].get_lines()
    assert [line.get_linestyle() for line in samples] == ["--", "-", "--"]
    assert names(drawn) == ["a", "b", OUTSIDE]
    listed = {trace["name"]: trace["line"]["dash"] for trace in shown["data"] if trace["showlegend"]}
    assert listed == {"a": "6px,3.2px", "b": "solid", OUTSIDE: "6px,3.2px"}


@pytest.mark.parametrize(("axis", "at"), [("x", 2.0), ("y", 25.0)])
@pytest.mark.parametrize("scale", ["linear", "log"])
def test_a_limit_is_a_line_with_its_name(axis: Any, at: float, scale: Any) -> None:
    here = {axis: PlotAxis("load [N]", scale)}
    drawn, shown = both(panel(curve("a"), limits=(Limit("limit 25 mm", at, axis),), **here))
    (axes,) = drawn.axes
    *_, line = axes.get_lines()
    assert {*np.ravel(line.get_xdata() if axis == "x" else line.get_ydata())} == {at}
    assert [text.get_text() for text in axes.texts] == ["limit 25 mm"]
    assert names(drawn) == ["a"], "it has its name at the line"
    (shape,), (note,) = shown["layout"]["shapes"], shown["layout"]["annotations"]
    assert (shape[f"{axis}0"], shape[f"{axis}1"]) == (at, at)
    assert (note["text"], note[axis]) == ("limit 25 mm", np.log10(at) if scale == "log" else at)


def test_a_figure_is_as_wide_as_a_column_or_a_page_of_a_journal() -> None:
    sizes = [both(*[panel()] * count)[0].get_size_inches()[0] * 25.4 for count in (1, 2, 3)]
    assert sizes == pytest.approx([90.0, 190.0, 190.0], abs=0.1)


# Maps


@pytest.mark.parametrize("scale", ["linear", "log"])
def test_maps_share_a_scale_of_colours_and_draw_borders_of_regions(scale: Literal["linear", "log"]) -> None:
    values = np.array([[1.0, 10.0, 100.0], [2.0, 20.0, np.nan]])
    regions = {"beyond": values > 5.0, "nowhere": values > 1e3}
    maps = [Map("wear [g]", X, np.array([10.0, 100.0]), factor * values, scale, regions) for factor in (1.0, 7.0)]
    drawn, shown = both(*(panel(map=one, curves=(), y=PlotAxis("b [-]", "log")) for one in maps))
    *axes, bar = drawn.axes
    for one, of in zip(axes, maps, strict=True):
        mesh = one.collections[0]
        assert (mesh.norm.vmin, mesh.norm.vmax) == (1.0, 700.0)
        np.testing.assert_array_equal(np.asarray(mesh.get_array()), of.values)
    assert bar.get_ylabel() == "wear [g]"
    assert names(drawn) == ["beyond"]
    heats = [trace for trace in shown["data"] if trace["type"] == "heatmap"]
    ends = [0.0, np.log10(700.0)] if scale == "log" else [1.0, 700.0]
    assert all([heat["zmin"], heat["zmax"]] == pytest.approx(ends, rel=1e-15) for heat in heats)
    assert heats[0]["customdata" if scale == "log" else "z"] == [[1.0, 10.0, 100.0], [2.0, 20.0, None]]
    assert [heat["showscale"] for heat in heats] == [True, False]
    assert [trace["name"] for trace in shown["data"] if trace["showlegend"]] == ["beyond"]


def test_the_legend_of_a_single_map_stands_below_since_its_bar_is_beside_it() -> None:
    region = {"beyond": np.array([[True, False, False], [True, True, False]])}
    drawn_map = Map("wear [g]", X, np.array([1.0, 2.0]), np.ones((2, 3)), "linear", region)
    _, of_map = both(panel(map=drawn_map, curves=()))
    _, of_curves = both(panel())
    assert of_map["layout"]["legend"]["orientation"] == "h"
    assert "orientation" not in of_curves["layout"]["legend"]


# Axes, panels and texts


@pytest.mark.parametrize("ends", [None, (0.5, 8.0)])
@pytest.mark.parametrize("scale", ["linear", "log"])
def test_axes_have_their_labels_scales_ends_and_directions(scale: Any, ends: Any) -> None:
    x, y = PlotAxis("a [N]", scale, ends), PlotAxis("z [mm]", scale, ends, inverted=True)
    drawn, shown = both(panel(x=x, y=y))
    (axes,) = drawn.axes
    assert (axes.get_xlabel(), axes.get_ylabel(), axes.get_xscale(), axes.get_yscale()) == (
        x.label,
        y.label,
        scale,
        scale,
    )
    assert axes.get_ylim()[0] > axes.get_ylim()[1]
    across, up = shown["layout"]["xaxis"], shown["layout"]["yaxis"]
    assert (across["title"]["text"], across["type"]) == (x.label, scale)
    if ends is None:
        assert up["autorange"] == "reversed"
        assert axes.get_xlim()[0] <= 1.0 < 4.0 <= axes.get_xlim()[1]
    else:
        assert axes.get_xlim() == axes.get_ylim()[::-1] == ends
        exponents = [float(end) for end in (np.log10(ends) if scale == "log" else ends)]
        assert across["range"] == up["range"][::-1] == exponents


def test_axes_can_be_equal() -> None:
    drawn, shown = both(panel(curve(y=-X), equal=True))
    assert drawn.axes[0].get_aspect() == 1.0
    assert shown["layout"]["yaxis"]["scaleanchor"] == "x"


@pytest.mark.parametrize(
    ("low", "high", "ticks"),
    [
        (0.02, 300.0, ["0.1", "1", "10", "100"]),
        (0.5, 30.0, ["0.5", "1", "2", "5", "10", "20"]),
        (8.0, 70.0, ["10", "20", "50"]),
        (500.0, 1500.0, ["500", "600", "800", "1000", "1500"]),
        (61.0, 64.0, ["61", "61.5", "62", "62.5", "63", "63.5", "64"]),
        (1e-6, 1e6, ["10⁻⁶", "10⁻⁵", *["0.0001", "0.001", "0.01", "0.1", "1", "10", "100", "1000", "10000"],
                     "10⁵", "10⁶"]),
    ],
)  # fmt: skip
def test_a_logarithmic_axis_has_plain_numbers(low: float, high: float, ticks: list[str]) -> None:
    axes = axes_of(x=PlotAxis("load [N]", "log", (low, high)))
    assert [text.get_text() for text in axes.xaxis.get_ticklabels() if text.get_text()] == ticks
    assert not any(text.get_text() for text in axes.xaxis.get_ticklabels(minor=True))


@pytest.mark.parametrize("count", range(1, 7))
def test_panels_stand_in_rows_of_two_in_both_with_one_legend_below(count: int) -> None:
    drawn, shown = both(*(panel(curve(str(n)), curve("in all", y=X), title=str(n)) for n in range(count)))
    layout, boxes = shown["layout"], [axes.get_position() for axes in drawn.axes]
    assert [axes.get_title() for axes in drawn.axes] == [note["text"] for note in layout["annotations"]]
    assert [(-box.y0, box.x0) for box in boxes] == sorted((-box.y0, box.x0) for box in boxes)
    widths = [round(box.width, 1) for box in boxes]
    assert widths == ([0.9] if count % 2 else []) + [0.4] * (count - count % 2)
    places = [(layout[f"xaxis{n}"]["domain"], layout[f"yaxis{n}"]["domain"]) for n in ("", *range(2, count + 1))]
    for (across, up), here in zip(places, boxes, strict=True):
        for (other_across, other_up), there in zip(places, boxes, strict=True):
            assert (across[1] <= other_across[0]) == (here.x1 <= there.x0)
            assert (up[1] <= other_up[0]) == (here.y1 <= there.y0)
    assert sorted(names(drawn)) == sorted({*map(str, range(count)), "in all"})
    assert [trace["name"] for trace in shown["data"] if trace["showlegend"]] == names(drawn)
    below = drawn.legends[0].get_window_extent().y1
    assert all(below <= box.y0 for axes in drawn.axes if (box := axes.get_tightbbox()) is not None)


@pytest.mark.parametrize("labels", [("usfd on global", "kth on global", "beyond shakedown"), ("W" * 20, "W"), "abc"])
def test_a_legend_fits_between_the_edges_of_a_column(labels: tuple[str, ...]) -> None:
    drawn = both(panel(*(curve(label, colour=number) for number, label in enumerate(labels))))[0]
    box = drawn.legends[0].get_window_extent()
    assert 0.0 <= box.x0 < box.x1 <= drawn.bbox.x1


def test_the_legend_explains_dashes_only_where_a_dashed_line_is_in_sight() -> None:
    x, outside = np.array([1.0, 2.0, 3.0, 4.0]), np.array([False, False, False, True])
    for end, explained in ((3.0, False), (4.0, True)):
        line = curve(x=x, y=x, outside=outside)
        drawn, shown = both(panel(line, x=PlotAxis("load [N]", ends=(1.0, end))))
        assert (OUTSIDE in names(drawn)) == explained == (OUTSIDE in [trace["name"] for trace in shown["data"]])


@pytest.mark.parametrize("text", [r"a $\nonsense$ b", "5 $ and 6 $", "_under^score", "100 % {x}"])
def test_texts_are_shown_as_they_are_written(text: str) -> None:
    drawn, shown = both(panel(curve(text), x=PlotAxis(text), y=PlotAxis(text), title=text))
    (axes,) = drawn.axes
    every = [axes.get_title(), axes.get_xlabel(), axes.get_ylabel(), *names(drawn)]
    assert [one.replace(r"\$", "$").strip() for one in every] == [text] * 4
    assert html.unescape(shown["data"][0]["name"]) == text


def test_hovering_shows_name_values_units_and_the_band() -> None:
    hover = {name: html.unescape(trace["hovertemplate"]) for name, trace in traces(ONE).items()}
    head = "<b>{}</b><br>creepage [%]: %{{x:.4~g}}<br>wear rate [µg/m/mm²]: %{{y:.4~g}}{}<extra></extra>"
    assert hover["rising"] == head.format("rising", "<br>from %{customdata[0]:.4~g} to %{customdata[1]:.4~g}")
    assert hover["falling"] == head.format("falling", "")
