"""Drawing with matplotlib: every curve, band and point of the data, on the axes and in the style that they ask for."""

from __future__ import annotations

import io
from typing import Any, Literal
from xml.etree import ElementTree

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from tests.core import cases
from tests.core.cases import case
from wearlaw.figures.curves import Curve, FigureData, Panel, PlotAxis
from wearlaw.figures.drawing import LINES, MARKERS, PALETTE, draw, marked_points
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


def test_a_curve_of_one_point_has_a_marker() -> None:
    (line,) = axes_of(curve(x=X[:1], y=X[:1])).lines
    assert line.get_marker() == MARKERS[0]


def places(*curves: Curve) -> list[np.ndarray[Any, Any]]:
    """Return where the markers of each curve are drawn, shape (markers, 2), in points."""
    figure = drawn(panel(*curves))
    (axes,) = figure.axes
    for number, line in enumerate(axes.lines):
        line.set_gid(f"line {number}")
    file = io.StringIO()
    figure.savefig(file, format="svg")
    groups = {group.get("id"): group for group in ElementTree.fromstring(file.getvalue()).iter(f"{SVG}g")}
    lines = [groups[f"line {number}"] for number in range(len(curves))]
    return [np.array([(float(m.attrib["x"]), float(m.attrib["y"])) for m in line.iter(f"{SVG}use")]) for line in lines]


def test_lines_that_only_colour_would_tell_apart_have_markers_which_are_few_and_do_not_meet() -> None:
    x = np.linspace(0.0, 1.0, 1001)
    alike = [curve(str(number), x=x, y=x, colour=number) for number in range(len(PALETTE))]
    lines = axes_of(*alike).lines
    assert [line.get_marker() for line in lines] == [*MARKERS]
    assert {line.get_markerfacecolor() for line in lines} == {"white"}
    found = places(*alike)
    assert all(len(one) == 7 for one in found)
    together = np.concatenate(found)
    apart = np.hypot(*(together[:, None] - together).transpose(2, 0, 1))
    assert (apart + np.diag(np.full(len(together), np.inf))).min() > lines[0].get_markersize()


def test_markers_stand_at_equal_distances_along_a_line_on_logarithmic_axes_where_the_axes_show_it() -> None:
    x = np.geomspace(1.0, 1e6, 6001)
    axis = PlotAxis("x [-]", "log", (10.0, 1e5))
    level = PlotAxis("y [-]", "linear", (0.0, 1.0))
    line = curve(x=x, y=np.full(x.size, 0.5), colour=2)
    marked = np.log10(x[marked_points(line, Panel(axis, level, (line,)))])
    # A fifth of four decades, with points of a thousandth of a decade; each marker stands at most one of them later.
    assert np.diff(marked) == pytest.approx(np.full(marked.size - 1, 0.8), abs=2e-3)
    assert 1.0 < marked[0] < 1.8
    assert 4.2 < marked[-1] < 5.0


@pytest.mark.parametrize("height", [0.0, 1.0])
def test_a_level_line_has_markers_and_a_jump_does_not_crowd_them(height: float) -> None:
    line = curve(x=np.linspace(0.0, 1.0, 1000), y=np.where(np.arange(1000) < 500, 0.0, height))
    marked = marked_points(line, panel(line))
    # The first stands at a fourteenth of a spacing, 14.3 steps, the next 199.8 steps later, or right after the jump.
    assert marked == [15, 215, 415, 615, 815] if height == 0.0 else [15, 215, 415, 500, 700, 900]


@pytest.mark.parametrize("scale", ["linear", "log"])
@pytest.mark.parametrize(
    ("x", "y", "marked"),
    [
        ([1.0, 2.0], [np.nan, 1.0], [1]),
        ([1.0, 1.02, 2.0], [1.0, 1.0, np.inf], [1]),
        ([1.0, 2.0], [np.nan, np.nan], []),
        ([], [], []),
    ],
    ids=["one point", "a short line", "none", "nothing"],
)
def test_the_shortest_line_has_a_marker_and_what_cannot_be_seen_has_none(
    scale: Literal["linear", "log"], x: list[float], y: list[float], marked: list[int]
) -> None:
    line = curve(x=np.array(x), y=np.array(y))
    assert marked_points(line, panel(line, curve(), y=PlotAxis("y", scale))) == marked


@pytest.mark.parametrize("axis", [0, 1])
def test_where_one_panel_needs_markers_all_panels_have_them(axis: int) -> None:
    panels = [panel(curve("a")), panel(curve("a"), curve("b", colour=1))]
    figure = drawn(*panels[:: 1 - 2 * axis])
    assert [line.get_marker() for axes in figure.axes for line in axes.lines] == [["s", "s", "^"], ["s", "^", "s"]][
        axis
    ]


def test_lines_that_their_style_tells_apart_have_no_markers() -> None:
    points = curve("tests", colour=6, points=True)
    assert [len(one) for one in places(curve("a"), curve("b", colour=1, dash=1), points)] == [0, 0, 3]


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
    assert (line.get_marker(), line.get_markevery()) == (MARKERS[0], [0, 5])
    np.testing.assert_array_equal(line.get_ydata(), gaps.y)
    together = axes_of(gaps, curve(x=x, y=x, colour=1)).lines
    assert {0, 5} < set(together[0].get_markevery())  # type: ignore[arg-type]


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


@pytest.mark.parametrize("creepage", [cases.SWEEP["creepage"], "1 %", "0 %", ["0 %", "-1 %"]])
def test_every_figure_of_a_study_can_be_drawn_without_a_warning(creepage: Any) -> None:
    """Warnings are errors in the tests."""
    study = run(case(sweeps={"creepage": {**cases.POINT, "creepage": creepage}}))
    for figure in study.figures:
        made = draw(figure)
        made.draw_without_rendering()
        assert made.get_suptitle() == "A small study"
        assert [len(axes.lines) for axes in made.axes] == [len(panel.curves) for panel in figure.panels]
