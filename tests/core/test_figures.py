"""Drawing with matplotlib: every curve, band and point of the data, on the axes and in the style that they ask for."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from tests.core import cases
from tests.core.cases import case
from wearlaw.figures.curves import Curve, FigureData, Panel, PlotAxis
from wearlaw.figures.drawing import LINES, PALETTE, draw
from wearlaw.study import run

X = np.array([1.0, 2.0, 4.0])


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


def test_no_two_colours_and_no_two_line_styles_are_alike() -> None:
    assert len(set(PALETTE)) == len(PALETTE)
    assert len(set(LINES)) == len(LINES)


def test_a_curve_of_one_point_has_a_marker() -> None:
    (line,) = axes_of(curve(x=X[:1], y=X[:1])).lines
    assert line.get_marker() == "o"


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
