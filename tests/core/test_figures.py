"""Drawing with matplotlib: every curve, band and point of the data, on the axes and in the style that they ask for."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from tests.core import cases
from tests.core.cases import case
from wearlaw.figures.curves import Curve, FigureData, Map, Panel, PlotAxis
from wearlaw.figures.drawing import BAND, LINES, MARKERS, PALETTE, draw, line_styles
from wearlaw.study.study import run

X = np.array([1.0, 2.0, 4.0])
SVG = "{http://www.w3.org/2000/svg}"


def curve(label: str = "a", **changes: Any) -> Curve:
    return Curve(**{"label": label, "x": X, "y": 10.0 * X, **changes})


def panel(*curves: Curve, **changes: Any) -> Panel:
    return Panel(**{"x": PlotAxis("load [N]"), "y": PlotAxis("wear [g]"), "curves": curves or (curve(),), **changes})


def drawn(*panels: Panel, title: str = "A figure") -> Figure:
    """Return a figure, drawn to the end, so that what is wrong with it shows."""
    figure = draw(FigureData("name", title, panels or (panel(),)))
    figure.draw_without_rendering()
    return figure


def axes_of(*curves: Curve, **changes: Any) -> Axes:
    (axes,) = drawn(panel(*curves, **changes)).axes
    return axes


def legend_of(figure: Figure) -> Any:
    (legend,) = figure.legends
    return legend


def names(figure: Figure) -> list[str]:
    return [text.get_text() for text in legend_of(figure).get_texts()]


def test_a_curve_is_drawn_as_it_is_in_the_colour_and_line_style_of_its_numbers() -> None:
    first, second = axes_of(curve("a", colour=1, dash=2), curve("b", y=X, colour=len(PALETTE), dash=len(LINES))).lines
    np.testing.assert_array_equal(first.get_xydata(), np.column_stack([X, 10.0 * X]))
    np.testing.assert_array_equal(second.get_xydata(), np.column_stack([X, X]))
    assert (first.get_color(), first.get_linestyle()) == (PALETTE[1], LINES[2])
    assert (second.get_color(), second.get_linestyle()) == (PALETTE[0], LINES[0]), "numbers start again"
    assert first.get_marker() in ("", "None")


def test_no_two_colours_with_their_markers_and_no_two_line_styles_are_alike() -> None:
    assert len(set(PALETTE)) == len(set(MARKERS)) == len(PALETTE) == len(MARKERS)
    assert len(set(LINES)) == len(LINES)


def test_a_curve_of_one_point_is_a_dot() -> None:
    (line,) = axes_of(curve(x=X[:1], y=X[:1])).lines
    assert (line.get_marker(), line.get_markevery()) == (".", [0])


def test_only_measurements_have_markers() -> None:
    many = [curve(str(number), colour=number) for number in range(len(PALETTE))]
    *lines, points = axes_of(*many, curve("tests", colour=6, points=True)).lines
    assert {line.get_marker() for line in lines} <= {"", "None"}
    assert (points.get_marker(), points.get_linestyle()) == (MARKERS[6], "None")


def dashes(line: Any) -> Any:
    """Return the dashes of a line in widths of it, None for a solid one."""
    return line._unscaled_dash_pattern[1]


@pytest.mark.parametrize("axis", [0, 1])
def test_where_only_colour_would_tell_lines_apart_each_line_of_the_figure_has_a_style(axis: int) -> None:
    panels = [panel(curve("a")), panel(curve("a"), curve("b", colour=1))]
    figure = drawn(*panels[:: 1 - 2 * axis])
    found = {str(line.get_label()): dashes(line) for axes in figure.axes for line in axes.lines}
    assert found["a"] != found["b"]
    alike = [curve(str(number), colour=number) for number in range(len(PALETTE))]
    assert len({dashes(line) and tuple(dashes(line)) for line in axes_of(*alike).lines}) == len(PALETTE) == len(LINES)


def test_where_dashes_tell_lines_apart_they_stay_as_they_are() -> None:
    figure = FigureData("f", "", (panel(curve("a", dash=2), curve("b", colour=1, dash=1)), panel(curve("c", colour=3))))
    assert line_styles(figure) == {(0, 2): 2, (1, 1): 1, (3, 0): 0}


def test_a_sparser_line_lies_over_a_denser_one() -> None:
    first, second, third = axes_of(curve("a"), curve("b", dash=2), curve("c", dash=1)).lines
    assert first.get_zorder() < third.get_zorder() < second.get_zorder()


def test_points_of_each_colour_have_a_marker_of_their_own() -> None:
    lines = axes_of(*(curve(str(number), colour=number, points=True) for number in range(len(PALETTE)))).lines
    assert [line.get_marker() for line in lines] == [*MARKERS]


def test_measured_points_are_not_joined() -> None:
    (points,) = axes_of(curve(points=True, colour=6)).lines
    assert (points.get_linestyle(), points.get_marker(), points.get_color()) == ("None", "o", "#000000")


def test_a_band_is_filled_between_its_ends() -> None:
    (band,) = axes_of(curve(low=X, high=20.0 * X)).collections
    corners = {tuple(corner) for corner in np.asarray(band.get_paths()[0].vertices)}
    assert corners == {*zip(X, X, strict=True), *zip(X, 20.0 * X, strict=True)}


def test_a_band_is_light_and_has_edges() -> None:
    (band,) = axes_of(curve(low=X, high=20.0 * X)).collections
    face, edge = (np.asarray(colours, dtype=float)[0, 3] for colours in (band.get_facecolor(), band.get_edgecolor()))
    assert face == BAND < 0.1
    assert edge > 3.0 * BAND


def test_the_uncertainty_of_points_is_drawn_as_bars() -> None:
    axes = axes_of(curve(points=True, low=9.0 * X, high=12.0 * X))
    (bars,) = axes.collections
    segments = np.array(bars.get_segments())  # type: ignore[attr-defined]
    np.testing.assert_array_equal(segments[:, :, 0], np.column_stack([X, X]))
    np.testing.assert_allclose(segments[:, :, 1], np.column_stack([9.0 * X, 12.0 * X]), rtol=1e-15)


def test_the_legend_says_what_bands_are_only_where_there_are_bands() -> None:
    ends: dict[str, Any] = {"low": X, "high": 20.0 * X}
    with_band, points, plain = (drawn(panel(c)) for c in (curve(**ends), curve(points=True, **ends), curve()))
    assert legend_of(with_band).get_title().get_text() == "bands: published range of parameters"
    for without in (points, plain):
        assert legend_of(without).get_title().get_text() in ("", "None")


def test_axes_have_their_labels_scales_and_ends() -> None:
    axes = axes_of(x=PlotAxis("a [N]", "log", (0.5, 8.0)), y=PlotAxis("b [-]", "linear", (-1.0, 7.0)), title="(a)")
    assert (axes.get_xlabel(), axes.get_ylabel(), axes.get_title()) == ("a [N]", "b [-]", "(a)")
    assert (axes.get_xscale(), axes.get_yscale()) == ("log", "linear")
    assert (axes.get_xlim(), axes.get_ylim()) == ((0.5, 8.0), (-1.0, 7.0))


@pytest.mark.parametrize("ends", [None, (0.5, 8.0)])
def test_an_inverted_axis_runs_the_other_way(ends: tuple[float, float] | None) -> None:
    axes = axes_of(x=PlotAxis("y [mm]", ends=ends), y=PlotAxis("z [mm]", ends=ends, inverted=True))
    assert axes.get_xlim()[0] < axes.get_xlim()[1]
    assert axes.get_ylim()[0] > axes.get_ylim()[1]
    assert ends is None or axes.get_ylim() == ends[::-1]


def test_with_equal_axes_a_length_is_as_long_in_x_as_in_y() -> None:
    axes = axes_of(curve(y=X), curve(y=-X), equal=True)
    box, (left, right), (low, high) = axes.get_window_extent(), axes.get_xlim(), axes.get_ylim()
    assert box.width / (right - left) == pytest.approx(box.height / (high - low), rel=1e-9)
    assert axes_of().get_aspect() == "auto"


def test_named_values_have_their_names_on_the_axis() -> None:
    axes = axes_of(x=PlotAxis("patch", names=("left 1", "$right$ 1")))
    assert [text.get_text() for text in axes.get_xticklabels()] == ["left 1", r"\$right\$ 1"]
    assert list(axes.get_xticks()) == [0, 1]


def test_a_point_of_a_line_without_neighbours_has_a_marker_and_gaps_stay_open() -> None:
    x = np.arange(6.0)
    gaps = curve(x=x, y=np.array([1.0, np.nan, 1.0, 1.0, np.nan, 1.0]))
    (line,) = axes_of(gaps).lines
    assert (line.get_marker(), line.get_markevery()) == (".", [0, 5])
    np.testing.assert_array_equal(line.get_ydata(), gaps.y)


def test_without_ends_all_of_the_curves_is_seen() -> None:
    axes = axes_of(y=PlotAxis("b", "log"))
    assert axes.get_xlim()[0] <= 1.0 < 4.0 <= axes.get_xlim()[1]
    assert 0.0 < axes.get_ylim()[0] <= 10.0 < 40.0 <= axes.get_ylim()[1]


@pytest.mark.parametrize("count", [1, 2, 3, 4, 5])
def test_panels_stand_in_rows_of_two_in_their_order_with_an_odd_one_over_the_first_row(count: int) -> None:
    figure = drawn(*(panel(title=str(number)) for number in range(count)))
    assert [axes.get_title() for axes in figure.axes] == [str(number) for number in range(count)]
    boxes = [axes.get_position() for axes in figure.axes]
    assert [(-box.y0, box.x0) for box in boxes] == sorted((-box.y0, box.x0) for box in boxes)
    widths = [round(box.width, 1) for box in boxes]
    assert widths == ([0.9] if count % 2 else []) + [0.4] * (count - count % 2)


def test_one_legend_below_names_each_curve_of_all_panels_once() -> None:
    figure = drawn(panel(curve("a"), curve("b")), panel(curve("b"), curve("c", points=True, low=X, high=20.0 * X)))
    assert names(figure) == ["a", "b", "c"]
    box = legend_of(figure).get_window_extent()
    for axes in figure.axes:
        around = axes.get_tightbbox()
        assert around is not None
        assert box.y1 <= around.y0


@pytest.mark.parametrize("count", [1, 9])
@pytest.mark.parametrize("length", [5, 40, 120])
def test_the_legend_is_not_wider_than_the_figure(count: int, length: int) -> None:
    figure = drawn(panel(*(curve(f"{number:{length}}") for number in range(count))))
    box = legend_of(figure).get_window_extent()
    whole = figure.bbox
    assert whole.x0 <= box.x0 < box.x1 <= whole.x1
    assert whole.y0 <= box.y0


@pytest.mark.parametrize("text", [r"a $\nonsense$ b", "5 $ and 6 $", "_under^score", "100 % {x}"])
def test_texts_are_shown_as_they_are_written(text: str) -> None:
    figure = drawn(panel(curve(text), x=PlotAxis(text), y=PlotAxis(text), title=text), title=text)
    (axes,) = figure.axes
    shown = [figure.get_suptitle(), axes.get_title(), axes.get_xlabel(), axes.get_ylabel(), *names(figure)]
    assert [one.replace(r"\$", "$").strip() for one in shown] == [text] * 5


def texts_of(figure: Figure) -> list[str]:
    """Return the texts below the title, without their line breaks."""
    return [text.get_text().replace("\n", " ") for text in figure.texts if text is not figure._suptitle]  # type: ignore[attr-defined]


@pytest.mark.parametrize(
    ("low", "high", "shown"),
    [
        (0.02, 300.0, ["0.1", "1", "10", "100"]),
        (0.5, 30.0, ["0.5", "1", "2", "5", "10", "20"]),
        (8.0, 70.0, ["10", "20", "50"]),
        (500.0, 1500.0, ["500", "600", "800", "1000", "1500"]),
        (61.0, 64.0, ["61", "61.5", "62", "62.5", "63", "63.5", "64"]),
        (1e-6, 1e6, ["$10^{-6}$", "$10^{-5}$", *["0.0001", "0.001", "0.01", "0.1", "1", "10", "100", "1000", "10000"],
                     "$10^{5}$", "$10^{6}$"]),
    ],
)  # fmt: skip
def test_a_logarithmic_axis_has_plain_numbers(low: float, high: float, shown: list[str]) -> None:
    axis = PlotAxis("load [N]", "log", (low, high))
    axes = axes_of(curve(x=np.array([low, high]), y=np.array([low, high])), x=axis, y=axis)
    for drawn_axis in (axes.xaxis, axes.yaxis):
        found = [text.get_text() for text in drawn_axis.get_ticklabels() if text.get_text()]
        assert found == shown
        assert not any(text.get_text() for text in drawn_axis.get_ticklabels(minor=True))


def test_the_conditions_stand_below_the_title_above_the_panels() -> None:
    figure = draw(FigureData("f", "A title", (panel(),), conditions="A study: load 4 kN, " + "more, " * 30))
    figure.draw_without_rendering()
    (shown,) = (text for text in figure.texts if text is not figure._suptitle)  # type: ignore[attr-defined]
    assert shown.get_text().count("\n") == 1, "they are wrapped"
    box, title = shown.get_window_extent(), figure._suptitle.get_window_extent()  # type: ignore[attr-defined]
    around = figure.axes[0].get_tightbbox()
    assert around is not None
    assert around.y1 <= box.y0 < box.y1 <= title.y0 < title.y1 <= figure.bbox.y1
    assert figure.bbox.x0 <= box.x0 < box.x1 <= figure.bbox.x1


BARS = Panel(
    PlotAxis("wear [g]"),
    PlotAxis("", ends=(-0.5, 1.5), inverted=True, names=("a", "b")),
    (
        Curve("a", np.array([3.0]), np.array([0.0]), low=np.array([1.0]), high=np.array([7.0]), bars=0.7),
        Curve("b", np.array([5.0]), np.array([1.0]), colour=1, outside=np.array([True]), bars=0.7),
    ),
)


def test_bars_begin_at_zero_with_their_names_on_the_axis_and_their_numbers_at_their_ends() -> None:
    figure = drawn(BARS)
    (axes,) = figure.axes
    first, second = axes.patches
    assert [(bar.get_x(), bar.get_width()) for bar in (first, second)] == [(0.0, 3.0), (0.0, 5.0)]  # type: ignore[attr-defined]
    assert first.get_window_extent().y0 > second.get_window_extent().y1, "from top to bottom"
    assert [text.get_text() for text in axes.get_yticklabels()] == ["a", "b"]
    assert [text.get_text() for text in axes.texts] == ["3 (1 to 7)", "5"]
    assert names(figure) == ["published range of parameters", "outside the range of the law"]
    assert first.get_alpha() != second.get_alpha()
    assert axes.texts[0].get_window_extent().x1 <= axes.get_window_extent().x1


def test_bars_of_an_axis_of_names_below_stand_upright() -> None:
    axis = PlotAxis("patch", names=("left", "right"))
    (axes,) = drawn(panel(curve("a", x=np.arange(2.0), y=X[:2], bars=0.7), x=axis)).axes
    assert [(bar.get_y(), bar.get_height()) for bar in axes.patches] == [(0.0, 1.0), (0.0, 2.0)]  # type: ignore[attr-defined]
    assert names(axes.figure) == ["a"]  # type: ignore[arg-type]


@pytest.mark.parametrize("scale", ["linear", "log"])
def test_maps_share_a_scale_of_colours_and_draw_borders_of_regions(scale: Literal["linear", "log"]) -> None:
    x, y = np.array([1.0, 2.0, 3.0]), np.array([10.0, 100.0])
    values = np.array([[1.0, 10.0, 100.0], [2.0, 20.0, np.nan]])
    borders = {"beyond": values > 5.0, "nowhere": values > 1e3}
    first, second = (Map("wear [g]", x, y, factor * values, scale, borders) for factor in (1.0, 7.0))
    axis = PlotAxis("b [-]", "log")
    figure = drawn(*(Panel(PlotAxis("a [N]"), axis, (), map=one) for one in (first, second)))
    *panels, bar = figure.axes
    meshes = [axes.collections[0] for axes in panels]
    assert [mesh.norm.vmin for mesh in meshes] == [1.0, 1.0]
    assert [mesh.norm.vmax for mesh in meshes] == [700.0, 700.0]
    np.testing.assert_array_equal(np.ma.filled(meshes[1].get_array(), np.nan), 7.0 * values)  # type: ignore[arg-type]
    assert bar.get_ylabel() == "wear [g]"
    assert bar.get_yscale() == scale
    assert [axes.get_yscale() for axes in panels] == ["log", "log"]
    assert names(figure) == ["beyond"]


@pytest.mark.parametrize("creepage", [cases.SWEEP["creepage"], "1 %", "0 %", ["0 %", "-1 %"]])
def test_every_figure_of_a_study_can_be_drawn_without_a_warning(creepage: Any) -> None:
    """Warnings are errors in the tests."""
    study = run(case(sweeps={"creepage": {**cases.POINT, "creepage": creepage}}))
    for figure in study.figures:
        made = draw(figure)
        made.draw_without_rendering()
        assert made.get_suptitle() == figure.title
        assert texts_of(made) == [figure.conditions]
        for axes, panel in zip(made.axes, figure.panels, strict=True):
            bars = [patch for patch in axes.patches if patch.get_zorder() > 0]
            assert len(bars) == sum(1 for curve in panel.curves if curve.bars)
            lines = [line for line in axes.lines if line.get_label() != "_nolegend_" or not bars]
            assert len(lines) == sum(1 for curve in panel.curves if not curve.bars)
