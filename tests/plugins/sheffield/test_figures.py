"""The figures of the shipped study, against the numbers of the paper of Tassini et al. (2010)."""

from __future__ import annotations

import math
import tomllib

import numpy as np
import pytest

from tests.plugins.sheffield.paper import (
    AREA,
    FORCE,
    FRICTION,
    FULL_SLIP,
    HALF_WIDTH,
    HEAT,
    LOAD,
    MODULUS,
    RADIUS,
    SOLUTIONS,
    SPEED,
    point,
    usfd,
)
from tests.plugins.studies.panels import assert_shows, by_label, by_name, one_panel
from tests.strategies import EPS
from wearlaw_output.curves import Curve, FigureData  # private: figures without their files
from wearlaw_sheffield import figures  # private: one claim or table, without the study
from wearlaw_sheffield.bench import Bench  # private: one claim or table, without the study
from wearlaw_studies.case import Case, case_text, load_case  # private: a case without its files
from wearlaw_studies.study import run  # private: a case run without its files

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
    for name in ("figure_06", "figure_07", "figure_09"):
        assert "measured wear rates, which have not been published" in shipped.figures[name].caption


def test_the_sweep_of_the_shipped_case_reaches_beyond_where_brr_and_usfd_cross() -> None:
    shipped = load_case("tassini2010")
    highest = 0.01 * float(shipped.sweeps["creepage"].points(shipped.units).varying["creepage"].values.max())
    assert highest == 0.25
    assert highest * FORCE > 797.0


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
        assert_shows(curve, [*(curve.x[:1]), *curve.x[1:-1], -curve.x[0]], [0.0, *curve.y[1:-1], 0.0])
        assert 1e-3 * curve.x[-1] == pytest.approx(HALF_WIDTH, rel=pressure_within)
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


@pytest.mark.validates(
    "paper",
    "Figure 5: T against creepage, with the points of the tests",
    source="T/μN of the creepage table; heat over slip speed of Lewis and Dwyer-Joyce 2004, Table 3",
    held_to="{share_within:g} of μN; tests to {roundings} ε",
    roundings=64,
    share_within=5e-5,
)
def test_figure_5_shows_the_force_of_local_models_and_tests(
    paper: dict[str, FigureData], roundings: int, share_within: float
) -> None:
    whole, low = paper["figure_05"].panels
    curves = by_label(low)
    assert by_label(whole).keys() == curves.keys()
    exact, fastsim, tests = curves.values()
    for curve, share in ((exact, 0.6470), (fastsim, 0.6119)):
        assert at(curve, 0.5) == pytest.approx(share * FORCE, abs=share_within * FORCE)
        assert at(curve, 10.0) == pytest.approx(FORCE, rel=1e-12)
    assert tests.points
    np.testing.assert_allclose(tests.y, np.array([*HEAT.values()]) / (0.01 * tests.x * SPEED), rtol=roundings * EPS)


@pytest.mark.validates(
    "paper",
    "Figure 6: the three laws on the global model, and KTH's band",
    source="Tassini et al. 2010, Tables 1 to 3, by hand",
    held_to="BRR and KTH to the digits of the tables, USFD to {within:g}",
    within=1e-06,
)
def test_figure_6_shows_the_laws_on_the_global_model(paper: dict[str, FigureData], within: float) -> None:
    whole, mild, severe = paper["figure_06"].panels
    assert (mild.x.ends, severe.x.ends) == ((0.0, 70.0), (50.0, 350.0))
    assert by_label(whole).keys() == by_label(mild).keys() == by_label(severe).keys()
    usfd, kth, brr = whole.curves
    assert (usfd.label, kth.label, brr.label) == ("usfd on global", "kth on global", "brr on global")
    published = [48.98, 97.96, 97.96, 329.16, 2660.7]
    digits = [5e-3, 5e-3, 5e-3, 6e-3, 5e-2]  # half of the last one; BRR grows by 0.0005 from 200 to 200.0001 N
    for wear_index, rate, digit in zip(WEAR_INDICES, published, digits, strict=True):
        assert at(brr, wear_index) == pytest.approx(rate, abs=digit)
    w = usfd.x / AREA
    np.testing.assert_allclose(usfd.y, np.minimum(5.3 * w, 55.0) + 61.9 * np.maximum(w - 77.26, 0.0), rtol=within)
    assert kth.low is not None
    assert kth.high is not None
    i = int(np.flatnonzero(np.isclose(kth.x, 0.01 * 0.9646 * FORCE, rtol=1e-4))[0])
    np.testing.assert_allclose((kth.low[i], kth.y[i], kth.high[i]), (3.523, 19.377, 35.231), rtol=2e-4)


@pytest.mark.validates(
    "paper",
    "Figures 7 and 8: USFD on cells, on the averaged wear index",
    source="the integrals of the creepage table",
    held_to="all digits of the creepage table",
)
@pytest.mark.parametrize("name", ["figure_07", "figure_08"])
def test_figures_7_and_8_show_usfd_with_its_original_parameters_on_the_cells(
    paper: dict[str, FigureData], name: str
) -> None:
    for panel in paper[name].panels:
        curves = by_label(panel)
        for model, at_10, at_20 in (("exact", 54.78239, 2247.0774), ("fastsim", 98.85414, 2608.1243)):
            assert at(curves[f"usfd on {model}"], 0.1 * FORCE) == pytest.approx(at_10, abs=5e-6)
            assert at(curves[f"usfd on {model}"], 0.2 * FORCE) == pytest.approx(at_20, abs=5e-5)


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


@pytest.mark.validates(
    "paper",
    "Figure 9: USFD against creepage",
    source="Tassini et al. 2010, Table 3, by the integrals of the creepage table",
    held_to="all digits of the creepage table",
)
def test_figure_9_shows_usfd_against_creepage(paper: dict[str, FigureData]) -> None:
    (curve,) = one_panel(paper["figure_09"]).curves
    assert curve.label == "usfd on global"
    for creepage, rate, digit in ((0.5, 9.29, 5e-3), (1.0, 27.70, 5e-3), (2.0, 55.0, 5e-3), (20.0, 1981.6, 5e-2)):
        assert at(curve, creepage) == pytest.approx(rate, abs=digit)


@pytest.mark.validates(
    "paper",
    "Figure 10: towards zero creepage USFD is quadratic in the creepage, and KTH linear",
    source="Tassini et al. 2010, section 6; T's series in the creepage",
    held_to="slopes {usfd_slope:g} within T's own bend, {kth_slope:g} to {roundings} ε",
    usfd_slope=2.0,
    kth_slope=1.0,
    roundings=64,
)
def test_figure_10_shows_usfd_quadratic_and_kth_linear_in_partial_slip(
    paper: dict[str, FigureData], usfd_slope: float, kth_slope: float, roundings: int
) -> None:
    linear, logarithmic = paper["figure_10"].panels
    assert linear.x.ends is not None
    assert linear.x.ends == (0.0, 1.2)
    assert (logarithmic.x.scale, logarithmic.y.scale) == ("log", "log")
    assert linear.x.ends[1] < FULL_SLIP
    usfd, kth = linear.curves
    slopes = [math.log(at(curve, 0.01) / at(curve, 0.001)) / math.log(10.0) for curve in (usfd, kth)]
    # T grows as ξ (1 - ξ/2ξ_sat), whose last factor turns the slope by no more than its own logarithm.
    assert slopes[0] == pytest.approx(usfd_slope, abs=0.01 / FULL_SLIP)
    assert slopes[1] == pytest.approx(kth_slope, rel=roundings * EPS)


# The figures beside the claims

TESTS = np.array([*HEAT]), np.array([heat / (x / 100.0 * SPEED * LOAD * 0.01) for x, heat in HEAT.items()])


def nearest(curve: Curve, x: float) -> int:
    return int(np.abs(curve.x - x).argmin())


@pytest.mark.validates(
    "paper",
    "Figure 4 with equation 7 as printed, and with the slip that follows from the tractions",
    source="Tassini et al. 2010, eq. (7); Carter 1926 and Kalker 1982, by hand",
    held_to="{roundings} ε",
    roundings=256,
)
def test_figure_4_with_equation_7_as_printed(bench: Bench, roundings: int) -> None:
    consistent, printed, fastsim, creepage = one_panel(figures.slip_along_patch(bench)).curves
    x, k, a, xi = 1e-3 * consistent.x, FRICTION / RADIUS, HALF_WIDTH, 0.005
    c = a - xi / k
    slips = x > 2.0 * c - a
    np.testing.assert_allclose(printed.y[slips], 100.0 * (xi + k * x[slips]), rtol=roundings * EPS)
    root = k * np.sqrt((x[slips] + a - c) ** 2 - c**2)
    # Where slip begins the root amplifies rounding by up to the number of cells.
    np.testing.assert_allclose(consistent.y[slips], 100.0 * root, rtol=200.0 * roundings * EPS)
    assert not printed.y[~slips].any()
    assert not consistent.y[~slips].any()
    behind = fastsim.y > 0.0
    np.testing.assert_allclose(fastsim.y[behind], 100.0 * (xi + 1.5 * k * x[behind]), rtol=roundings * EPS)
    np.testing.assert_array_equal(creepage.y, [0.5, 0.5])


@pytest.mark.validates(
    "paper",
    "Figures 7 and 8 in mild wear with means over the patch, over the slip zone, and mixed as in the paper",
    source="tanh-sinh quadrature, written anew for the tests",
    held_to="{within:g}, relative",
    within=1e-7,
)
@pytest.mark.parametrize("model", ["exact", "fastsim"])
def test_figures_7_and_8_with_other_averages(bench: Bench, model: str, within: float) -> None:
    mixed, zone, patch = figures.averages(bench).panels
    label = figures.MODELS[model]
    for creepage in (
        float(bench.creepage[nearest_to]) for nearest_to in np.searchsorted(bench.creepage, [0.2, 0.5, 0.9])
    ):
        solution = SOLUTIONS[model](point(creepage))
        share = 0.5 * solution.border
        averaged = 0.01 * solution.force * solution.mean(solution.slip) / share
        rate = usfd(model, creepage)
        for panel, x, y in (
            (mixed, averaged, rate),
            (zone, averaged, rate / share),
            (patch, 0.01 * solution.force * creepage / 100.0, rate),
        ):
            curve = by_label(panel)[label]
            there = nearest(curve, x)
            assert (curve.x[there], curve.y[there]) == pytest.approx((x, y), rel=within)
        assert patch.x.label.startswith("W.I., Tγ")
