"""The figures of the shipped study, against the numbers of the paper of Tassini et al. (2010)."""

from __future__ import annotations

import math
import tomllib

import numpy as np
import pytest

import wearlaw as wl
from tests.plugins.studies.panels import assert_shows, by_label, by_name, one_panel
from tests.plugins.tassini2010.paper import AREA, FORCE, FRICTION, HALF_WIDTH, HEAT, LOAD, MODULUS, RADIUS, SPEED
from tests.strategies import EPS
from wearlaw import Q
from wearlaw_apps.output.curves import Curve, FigureData  # private: figures without their files
from wearlaw_apps.studies.case import Case, case_text, load_case  # private: a case without its files
from wearlaw_apps.studies.study import run  # private: a case run without its files

WEAR_INDICES = np.array([50.0, 150.0, 199.9, 200.0001, 700.0])


@pytest.fixture(scope="module")
def paper() -> dict[str, FigureData]:
    """The shipped case, at the creepages at which there are numbers to hold its figures against."""
    fields = tomllib.loads(case_text("tassini2010"))
    creepages = sorted([0.001, 0.01, 0.5, 1.0, 2.0, 10.0, 20.0, *(100.0 * WEAR_INDICES / FORCE)])
    fields["sweeps"]["creepage"]["creepage"] = [f"{float(creepage)!r} %" for creepage in creepages]
    return by_name(run(Case(**{**fields, "sections": []})))


def at(curve: Curve, x: float) -> float:
    """Return the value of a curve at one of its points."""
    (there,) = np.flatnonzero(np.isclose(curve.x, x, rtol=1e-9, atol=0.0))
    return float(curve.y[there])


def test_the_shipped_case_has_the_figures_of_the_paper_in_its_order() -> None:
    shipped = load_case("tassini2010")
    names = [f"figure_{number:02}" for number in range(3, 11)]
    assert [*shipped.figures][:8] == names
    windows = {name: [window.x_range for window in shipped.figures[name].panels] for name in names}
    assert windows["figure_06"] == [("0 N", "682 N"), ("0 N", "70 N"), ("50 N", "350 N")], "section 5.1.1 has two"
    assert windows["figure_05"][0] == ("0 %", "20 %"), "section 5.1 has tests up to 20 %"
    assert shipped.figures["figure_07"].x_range == ("0 N", "682 N")
    assert shipped.figures["figure_09"].x_range == ("0 %", "20 %")
    assert round(0.2 * FORCE) == 682
    assert len(windows["figure_05"]) == len(windows["figure_08"]) == 2
    linear, logarithmic = shipped.figures["figure_10"].panels
    assert linear.x_range == ("0 %", "1.2 %"), "partial slip, which ends at 1.23 %"
    assert (logarithmic.x_scale, logarithmic.y_scale) == ("log", "log")


@pytest.mark.validates(
    "paper",
    "Figure 3: stresses along the patch at 0.5 % creepage",
    source="Hertz's ellipse; T/μN of the creepage table",
    held_to="pressure to {pressure_within:g}, area under the traction to {area:.1e}, relative",
    area=200**-1.5,
    pressure_within=1e-5,
)
def test_figure_3_shows_the_stresses_of_both_local_models(
    paper: dict[str, FigureData], area: float, pressure_within: float
) -> None:
    pressure, exact, fastsim = one_panel(paper["figure_03"]).curves
    assert (pressure.label, exact.label, fastsim.label) == ("pressure p", "traction q, exact", "traction q, fastsim")
    for curve in (pressure, exact, fastsim):
        assert 1e-3 * curve.x[[0, -1]] == pytest.approx([-HALF_WIDTH, HALF_WIDTH], rel=pressure_within)
        assert not curve.y[[0, -1]].any()
    np.testing.assert_allclose(
        pressure.y[1:-1], 1500.0 * np.sqrt(1.0 - (1e-3 * pressure.x[1:-1] / HALF_WIDTH) ** 2), rtol=pressure_within
    )
    # Sums over 200 cells of what begins and ends like a square root are right to the order of 200^-1.5.
    for curve, share in ((exact, 0.6470), (fastsim, 0.6119)):
        assert curve.y[1:-1].mean() * AREA == pytest.approx(share * FORCE, rel=area)


def test_figure_4_shows_slip_from_where_stick_ends_and_the_global_creepage(paper: dict[str, FigureData]) -> None:
    exact, fastsim, level = one_panel(paper["figure_04"]).curves
    assert_shows(level, exact.x, np.full(exact.x.shape, 0.5))
    flexibility = 4.0 * HALF_WIDTH / (math.pi * MODULUS)
    borders = (
        HALF_WIDTH - 2.0 * 0.005 * RADIUS / FRICTION,
        HALF_WIDTH - 4.0 * HALF_WIDTH**3 * 0.005 / (3.0 * LOAD * FRICTION * flexibility),
    )
    cell = 2.0 * HALF_WIDTH / 200.0
    for curve, border in zip((exact, fastsim), borders, strict=True):
        assert border <= 1e-3 * curve.x[curve.y > 0.0][0] <= border + cell


POINTS: dict[str, tuple[list[str], list[tuple[float, list[float], float]]]] = {
    # the curves, and for each x their values and what these may be off by
    "figure_05": (
        ["exact", "fastsim"],
        [(0.5, [0.6470 * FORCE, 0.6119 * FORCE], 5e-5 * FORCE), (10.0, [FORCE, FORCE], 1e-12 * FORCE)],
    ),
    "figure_06": (
        ["usfd on global", "brr on global"],
        [
            (50.0, [5.3 * 50.0 / AREA, 48.98], 5e-3),
            (150.0, [55.0, 97.96], 5e-3),
            (199.9, [55.0, 97.96], 5e-3),
            (200.0001, [55.0, 329.16], 6e-3),  # BRR grows by 0.0005 from 200 N on
            (700.0, [55.0 + 61.9 * (700.0 / AREA - 77.26), 2660.7], 5e-2),
        ],
    ),
    "figure_07": (
        ["usfd on exact", "usfd on fastsim"],
        [(0.1 * FORCE, [54.78239, 98.85414], 5e-6), (0.2 * FORCE, [2247.0774, 2608.1243], 5e-5)],
    ),
    "figure_08": (
        ["usfd on exact", "usfd on fastsim"],
        [(0.1 * FORCE, [54.78239, 98.85414], 5e-6), (0.2 * FORCE, [2247.0774, 2608.1243], 5e-5)],
    ),
    "figure_09": (
        ["usfd on global"],
        [(0.5, [9.29], 5e-3), (1.0, [27.70], 5e-3), (2.0, [55.0], 5e-3), (20.0, [1981.6], 5e-2)],
    ),
    "figure_10": (["usfd on global", "kth on global"], [(0.5, [9.29, 9.6885], 5e-3), (1.0, [27.70, 19.377], 5e-3)]),
}


@pytest.mark.validates(
    "paper",
    "Figures 5 to 10: traction against creepage; the laws on the patch means and on cells, against W.I. and creepage",
    source="the creepage table; Tassini et al. 2010, Tables 1 to 3, by hand",
    held_to="all digits of the tables",
)
@pytest.mark.parametrize("name", POINTS)
def test_figures_5_to_10_go_through_the_points_of_the_tables(paper: dict[str, FigureData], name: str) -> None:
    labels, points = POINTS[name]
    for panel in paper[name].panels:
        curves = by_label(panel)
        for x, values, digit in points:
            assert [at(curves[label], x) for label in labels] == pytest.approx(values, abs=digit)


def test_figure_5_shows_the_tests_and_figure_6_the_band_of_kth(paper: dict[str, FigureData]) -> None:
    for panel in paper["figure_05"].panels:
        *_, tests = panel.curves
        assert tests.points
        np.testing.assert_allclose(tests.y, np.array([*HEAT.values()]) / (0.01 * tests.x * SPEED), rtol=64 * EPS)
    for panel in paper["figure_06"].panels:
        kth = by_label(panel)["kth on global"]
        i = int(np.flatnonzero(np.isclose(kth.x, 0.01 * 0.9646 * FORCE, rtol=1e-4))[0])
        assert kth.low is not None
        assert kth.high is not None
        np.testing.assert_allclose((kth.low[i], kth.y[i], kth.high[i]), (3.523, 19.377, 35.231), rtol=2e-4)


def test_the_averaged_wear_index_is_the_wear_index_in_full_slip_exceeds_it_before_and_is_zero_without_slip() -> None:
    predict = wl.TwinDisc.suros() | wl.contact_model("exact") | wl.law("averaged_wear_index")
    result = predict(max_pressure="1500 MPa", creepage=Q([5, 0.2, 0], "%"), friction_coefficient=FRICTION)
    averaged, index = (result[name].m_as("N") for name in ("averaged_wear_index", "wear_index"))
    assert averaged[0] == pytest.approx(index[0], rel=1e-13)  # in full slip the mean slip is the creepage
    assert averaged[1] > 1.5 * index[1]
    assert averaged[2] == 0.0


def test_figures_7_and_8_are_against_the_averaged_wear_index(paper: dict[str, FigureData]) -> None:
    """Mean slip of the slip zone times T, where slip is k √((x+a-c)² - c²)."""
    curve = by_label(one_panel(paper["figure_07"]))["usfd on exact"]
    stick = HALF_WIDTH - 0.005 * RADIUS / FRICTION
    from_stick, end = np.linspace(stick, 2.0 * HALF_WIDTH - stick, 200_001), 2.0 * HALF_WIDTH - stick
    slip = FRICTION / RADIUS * np.sqrt(from_stick**2 - stick**2)
    mean_slip = np.trapezoid(slip, from_stick) / (end - stick)
    expected = mean_slip * FORCE * (1.0 - (stick / HALF_WIDTH) ** 2)
    # The trapezoidal sum errs by the order of n^-1.5 where the root begins.
    assert np.isclose(curve.x, expected, rtol=200_000**-1.5 + 1e-7).sum() == 1
    (on_global, *_) = paper["figure_08"].panels[0].curves
    assert np.isclose(on_global.x, 0.005 * 0.6470 * FORCE, rtol=1e-4).sum() == 1, "Tγ on the global model"
