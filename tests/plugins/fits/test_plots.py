"""Figures of fits, comparisons and uncertainties: into axes of one's own, over a condition, with scales and titles."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from matplotlib import pyplot
from matplotlib.figure import Figure

import wearlaw as wl
from tests.plugins.fits.fits import EXACT
from wearlaw import Q
from wearlaw_apps.fits import WearTests

TEST: Any = {"creepage": Q([0.5, 1.0, 2.0, 4.0], "%"), "friction_coefficient": 0.45}
PREDICT = EXACT | wl.wear_law("energy", mass_per_energy="5 ug/J")
RATES = np.array([1.02, 0.97, 1.05, 0.96])


@pytest.fixture(autouse=True)
def closed() -> Iterator[None]:
    yield
    pyplot.close("all")


def fitted(load: Any) -> Any:
    tests = WearTests.from_arrays(
        **TEST, normal_force=load, wear_rate=PREDICT(**TEST, normal_force=load).wear_rate * RATES
    )
    return wl.fit(PREDICT, tests, ["mass_per_energy"], bootstrap=0), tests


def test_a_figure_is_one_that_pyplot_and_notebooks_show() -> None:
    fit, tests = fitted("7 kN")
    for drawn in (fit, wl.compare([PREDICT], tests)):
        assert drawn.plot().figure is pyplot.gcf()
    u = wl.uncertainty(
        PREDICT, normal_force="7 kN", creepage="1 %", friction_coefficient=wl.uniform(0.3, 0.4), samples=64
    )
    assert u.plot(title="Friction").figure is pyplot.gcf()
    assert pyplot.gcf().get_suptitle() == "Friction"


def test_a_figure_is_drawn_into_axes_of_ones_own() -> None:
    figure = Figure()
    left, right = figure.subplots(1, 2)
    fit, _ = fitted("7 kN")
    assert fit.plot(ax=left, title="Ours", log="") is left
    assert left.get_title() == "Ours"
    assert (left.get_xscale(), left.get_yscale()) == ("linear", "linear")
    assert {text.get_text() for text in left.get_legend().get_texts()} == {"fitted", "measured"}
    assert not right.lines
    assert not pyplot.get_fignums()
    with pytest.raises(wl.InputError, match="ax: the figure has 1 panels; give axes for each, got 2"):
        fit.plot(ax=[left, right])
    with pytest.raises(wl.InputError, match="log: must be"):
        fit.plot(log="z")


def test_a_fit_is_drawn_over_the_condition_asked_for() -> None:
    fit, _ = fitted("7 kN")
    (panel,) = fit.figure_data("creepage").panels
    line, points = panel.curves
    assert panel.x.label == "creepage [%]"
    assert points.x == pytest.approx([0.5, 1.0, 2.0, 4.0])
    # Between two tests the curve is that of the law, so at the tests it has the fitted values.
    at_tests = fit.fitted(fit.observations[0]) * 1e3  # in µg/m/mm²
    assert np.interp(points.x, line.x, line.y) == pytest.approx(at_tests, rel=1e-9)
    assert fit.figure_data().panels[0].x.label == fit.figure_data("wear_index_density").panels[0].x.label
    with pytest.raises(wl.InputError, match="x: there is no 'creepag'; did you mean 'creepage'"):
        fit.plot(x="creepag")


def test_a_fit_of_several_conditions_is_drawn_as_points_over_one_of_them() -> None:
    fit, _ = fitted(Q([5.0, 6.0, 7.0, 8.0], "kN"))
    (panel,) = fit.figure_data("normal_force").panels
    fitted_points, measured = panel.curves
    assert fitted_points.points
    assert fitted_points.hollow
    assert measured.x == pytest.approx([5.0, 6.0, 7.0, 8.0])
    assert fitted_points.y / measured.y == pytest.approx(fit.residuals["predicted/measured"], rel=1e-9)


def test_parameters_are_shown_by_their_symbols() -> None:
    fit, _ = fitted("7 kN")
    assert fit.figure_data().title == "Fit of mass per energy"
    traction = WearTests.from_arrays(
        **TEST | {"friction_coefficient": None}, normal_force="7 kN", traction_coefficient=[0.2, 0.31, 0.33, 0.32]
    )
    of_friction = wl.fit(EXACT, traction, ["friction_coefficient"], bootstrap=0)
    assert of_friction.figure_data().title == "Fit of μ"
