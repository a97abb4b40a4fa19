"""The pictures of a study, by the data that they draw."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from tests.core import cases
from tests.core.cases import Install, case
from wearlaw.figures import figures
from wearlaw.study import Study, run

MEASURED = {"label": "_$points$", "source": "s", "creepage": ["0.5 %", "2 %"], "traction_coefficient": [0.3, 0.4]}
LOADS = {"from": "500 MPa", "to": "1500 MPa", "points": 3}


@pytest.fixture(scope="module")
def study() -> Study:
    by_load = {**cases.POINT, "max_pressure": LOADS, "friction_coefficient": [0.3, 0.4]}
    return run(case(sweeps={"creepage": cases.SWEEP, "load": by_load}, measured=MEASURED))


def draw(study: Study, name: str) -> Figure:
    """Return a figure, drawn to the end, so that what is wrong with it shows."""
    figure = figures(study)[name]()
    figure.draw_without_rendering()
    return figure


def data(line: Any) -> tuple[Any, Any]:
    return line.get_xdata(), line.get_ydata()


def lines(axes: Axes) -> dict[str, Any]:
    return {str(line.get_label()): line for line in axes.get_lines()}


def assert_draws(line: Any, x: Any, y: Any) -> None:
    np.testing.assert_array_equal(data(line), (x, y))


def test_a_study_has_these_figures(study: Study) -> None:
    assert list(figures(study)) == [
        "creepage_wear_rate_against_wear_index",
        "creepage_wear_rate_against_creepage",
        "creepage_traction_against_creepage",
        "load_wear_rate_against_wear_index",
        "load_wear_rate_against_max_pressure",
        "partial_slip_along_the_patch",
    ]


@pytest.mark.parametrize(
    ("name", "x", "xlabel"),
    [
        ("creepage_wear_rate_against_creepage", "creepage", "creepage [%]"),
        ("creepage_wear_rate_against_wear_index", "wear_index", "wear index Tγ [N]"),
        ("load_wear_rate_against_max_pressure", "max_pressure", "maximum pressure [MPa]"),
        ("load_wear_rate_against_wear_index", "wear_index", "wear index Tγ [N]"),
    ],
)
def test_wear_rate_is_drawn_for_every_pair_as_the_dataset_has_it(study: Study, name: str, x: str, xlabel: str) -> None:
    (axes,) = draw(study, name).axes
    assert (axes.get_xlabel(), axes.get_ylabel()) == (xlabel, "wear rate [µg/m/mm²]")
    assert (axes.get_xscale(), axes.get_yscale()) == ("log", "log")
    sweep = study.sweeps["creepage"]
    if name.startswith("load"):
        sweep = study.sweeps["load"].isel(friction_coefficient=1)
        assert axes.get_title() == "A small study\nfriction coefficient 0.4"
    else:
        assert axes.get_title() == "A small study"
    drawn = lines(axes)
    assert list(drawn) == list(sweep.pair.values)
    for pair, line in drawn.items():
        along = sweep[x]
        if x == "wear_index":
            along = along.sel(contact_model=pair.split(" on ")[1])
        assert_draws(line, along, sweep.wear_rate.sel(pair=pair))


def test_colour_tells_the_law_and_line_style_the_contact_model(study: Study) -> None:
    (axes,) = draw(study, "creepage_wear_rate_against_creepage").axes
    drawn = lines(axes)
    colours = {pair: line.get_color() for pair, line in drawn.items()}
    styles = {pair: line.get_linestyle() for pair, line in drawn.items()}
    for one in drawn:
        for other in drawn:
            (law, model), (other_law, other_model) = one.split(" on "), other.split(" on ")
            assert (colours[one] == colours[other]) == (law == other_law)
            assert (styles[one] == styles[other]) == (model == other_model)


def test_the_band_of_a_law_is_drawn_and_only_where_there_is_one(study: Study) -> None:
    (axes,) = draw(study, "creepage_wear_rate_against_creepage").axes
    sweep = study.sweeps["creepage"]
    bands = axes.collections
    assert len(bands) == 2
    for band, pair in zip(bands, ["kth on global", "kth on exact"], strict=True):
        corners = {tuple(corner) for corner in np.asarray(band.get_paths()[0].vertices)}
        one = sweep.sel(pair=pair)
        for edge in (one.wear_rate_low, one.wear_rate_high):
            assert set(zip(sweep.creepage.values, edge.values, strict=True)) <= corners
    legend = axes.get_legend()
    assert legend is not None
    assert legend.get_title().get_text() == "bands: published range of parameters"


def test_without_a_band_the_legend_does_not_speak_of_one() -> None:
    without = run(case(wear_laws=["usfd"], profiles={}))
    (axes,) = draw(without, "creepage_wear_rate_against_creepage").axes
    legend = axes.get_legend()
    assert legend is not None
    assert not axes.collections
    assert legend.get_title().get_text() in ("", "None")


def test_traction_is_drawn_for_every_contact_model_with_the_measured_points(study: Study) -> None:
    (axes,) = draw(study, "creepage_traction_against_creepage").axes
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("creepage [%]", "traction coefficient T/N [-]")
    assert axes.get_ylim()[0] == 0.0
    *models, points = axes.get_lines()
    sweep = study.sweeps["creepage"]
    assert [line.get_label() for line in models] == ["global", "exact"]
    for line in models:
        expected = sweep.traction_coefficient.sel(contact_model=line.get_label())
        np.testing.assert_allclose(data(line), (sweep.creepage, expected), rtol=1e-14)
    np.testing.assert_allclose(data(points), ([0.5, 2.0], [0.3, 0.4]), rtol=1e-14)
    assert points.get_linestyle() == "None"
    legend = axes.get_legend()
    assert legend is not None
    assert [text.get_text() for text in legend.get_texts()] == ["global", "exact", r" _\$points\$"]


def test_stresses_and_slip_are_drawn_along_the_patch(study: Study) -> None:
    stresses, slip = draw(study, "partial_slip_along_the_patch").axes
    assert stresses.get_ylabel() == "stress [MPa] (thin: bound)"
    assert (slip.get_xlabel(), slip.get_ylabel()) == ("position x, leading edge left [mm]", "relative slip s [%]")
    profile = study.profiles["partial_slip"].sel(contact_model="exact")
    pressure, traction, bound = stresses.get_lines()
    assert (pressure.get_label(), traction.get_label()) == ("pressure p", "q, exact")
    assert_draws(pressure, profile.x, profile.pressure)
    assert_draws(traction, profile.x, profile.traction)
    assert_draws(bound, profile.x, profile.traction_bound)
    assert_draws(lines(slip)["exact"], profile.x, profile.slip)


def test_a_model_with_nodes_of_its_own_is_drawn_on_these(monkeypatch: pytest.MonkeyPatch) -> None:
    install: Install = cases.installer(monkeypatch)
    install(cases.Coarse)
    both = run(case(contact_models=["coarse", "exact"], wear_laws=["kth"]))
    stresses, slip = draw(both, "partial_slip_along_the_patch").axes
    drawn = {label: len(line.get_xdata()) for axes in (stresses, slip) for label, line in lines(axes).items()}
    assert drawn["pressure p"] == drawn["q, coarse"] == drawn["coarse"] == 7
    assert drawn["q, exact"] == drawn["exact"] == 200


@pytest.mark.parametrize(
    "creepage",
    ["1 %", "0 %", "-1 %", ["0 %", "1 %"], {"from": "-1 %", "to": "1 %", "points": 5}],
    ids=["one point", "no creepage", "negative", "from zero", "through zero"],
)
def test_every_creepage_is_drawn_without_a_warning(creepage: Any) -> None:
    """Warnings are errors in the tests."""
    point = {**cases.POINT, "creepage": creepage}
    profile = {**cases.POINT, "creepage": "0 %" if isinstance(creepage, dict) else "-1 %"}
    drawn = run(case(sweeps={"s": point}, profiles={"p": profile}, measured=MEASURED))
    for name in figures(drawn):
        draw(drawn, name)


def test_one_operating_point_is_drawn_with_a_marker() -> None:
    one = run(case(sweeps={"point": cases.POINT}, profiles={}))
    for name in ("point_wear_rate_against_creepage", "point_traction_against_creepage"):
        for line in draw(one, name).axes[0].get_lines():
            assert len(data(line)[0]) == 1
            assert line.get_marker() == "o"


def test_negative_creepage_is_drawn_as_magnitude() -> None:
    back = run(case(sweeps={"back": {**cases.POINT, "creepage": ["-2 %", "-1 %"]}}, profiles={}))
    (axes,) = draw(back, "back_traction_against_creepage").axes
    for line in axes.get_lines():
        creepage, traction = data(line)
        np.testing.assert_array_equal(creepage, [2.0, 1.0])
        assert (traction > 0.0).all()


def test_measured_traction_is_drawn_against_creepage() -> None:
    conditions = {**cases.POINT, "creepage": ["1 %", "2 %"], "traction_coefficient": [0.1, 0.2]}
    measured = run(case(sweeps={"m": conditions}, profiles={}))
    (axes,) = draw(measured, "m_traction_against_creepage").axes
    assert axes.get_title() == "A small study\ntraction coefficient T/N 0.2"
    np.testing.assert_allclose(data(axes.get_lines()[0]), ([1.0, 2.0], [0.2, 0.2]), rtol=1e-14)


@pytest.mark.parametrize("title", [r"a $\nonsense$ b", "5 $ and 6 $", "_under^score", "100 % {x}"])
def test_a_title_is_shown_as_it_is_written(title: str) -> None:
    named = run(case(title=title, contact_models=["exact"], wear_laws=["kth"], sweeps={"s": cases.POINT}))
    for name in ("s_wear_rate_against_creepage", "partial_slip_along_the_patch"):
        shown = draw(named, name).axes[0].get_title()
        assert shown.replace(r"\$", "$").strip() == title
