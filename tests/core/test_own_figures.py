"""Figures of a case of one's own, as they are drawn: units, words, one point and maps."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from tests.core import cases
from tests.core.cases import case
from wearlaw.errors import ConfigurationError
from wearlaw.figures.curves import Curve, FigureData, Panel, PlotAxis
from wearlaw.figures.drawing import draw
from wearlaw.report.interactive import plotly_figure
from wearlaw.report.main_result import main_figure, main_result
from wearlaw.study.study import Study, run

ROLLERS: dict[str, Any] = {
    "type": "twin_disc",
    "disc_1": {"diameter": "60 mm", "material": {**cases.STEEL, "shear_yield_stress": "350 MPa"}},
    "disc_2": {"diameter": "180 mm", "material": {**cases.STEEL, "shear_yield_stress": "350 MPa"}},
    "track_width": "8 mm",
    "rolling_speed": "2 m/s",
}
AT = {"normal_force": "4 kN", "creepage": "1 %", "friction_coefficient": 0.4}
LOADS = {"from": "500 N", "to": "8000 N", "points": 16}


def ran(contact_models: tuple[str, ...] = ("global",), **changes: Any) -> Study:
    """Run a case of one sweep on rollers, at conditions some of which are changed."""
    fields: dict[str, Any] = {
        "title": "Rollers",
        "rig": ROLLERS,
        "contact_models": list(contact_models),
        "profiles": {},
    }
    own: dict[str, Any] = {
        name: changes.pop(name) for name in ("wear_laws", "figures", "profiles", "sweeps") if name in changes
    }
    return run(case(**{**fields, "sweeps": {"own": {**AT, **changes}}, **own}))


def drawings(study: Study) -> dict[str, Figure]:
    """Return the figures of a study by name, drawn to the end."""
    made = {figure.name: draw(figure) for figure in study.figures}
    for figure, drawn in zip(study.figures, made.values(), strict=True):
        drawn.draw_without_rendering()
        plotly_figure(figure)
    return made


def one(study: Study, name: str) -> Axes:
    return drawings(study)[name].axes[0]


def lines(axes: Axes) -> dict[str, np.ndarray[Any, Any]]:
    """Return the points of each line with a label, shape (points, 2)."""
    return {str(line.get_label()): np.asarray(line.get_xydata()) for line in axes.lines if line.get_label()[0] != "_"}  # type: ignore[index]


def texts(figure: Figure) -> str:
    """Return all that stands outside the panels of a drawing."""
    return " ".join(text.get_text().replace("\n", " ") for text in figure.texts)


# Units, scales and words


@pytest.mark.parametrize(
    ("given", "label", "ends"),
    [
        ({"normal_force": LOADS}, "normal force [N]", (500.0, 8000.0)),
        ({"normal_force": {**LOADS, "from": "0.5 kN"}}, "normal force [kN]", (0.5, 8.0)),
        ({"max_pressure": ["0.5 GPa", "750 MPa", "1 GPa"]}, "maximum pressure [GPa]", (0.5, 1.0)),
        (
            {"normal_force_per_width": {"from": "100 N/mm", "to": "1 kN/mm", "points": 4}},
            "normal force per width [N/mm]",
            (100.0, 1000.0),
        ),
    ],
)
def test_axes_have_the_units_of_the_case(given: dict[str, Any], label: str, ends: tuple[float, float]) -> None:
    (name,) = given
    conditions = {key: value for key, value in AT.items() if key != "normal_force" or name == key}
    axes = one(ran(sweeps={"own": {**conditions, **given}}), f"own_wear_rate_over_{name}")
    assert axes.get_xlabel() == label
    assert axes.get_xscale() == axes.get_yscale() == "linear"
    for line in lines(axes).values():
        assert (line[:, 0].min(), line[:, 0].max()) == pytest.approx(ends, rel=1e-14)


def test_the_strip_stands_where_the_limit_is_in_the_units_of_the_case() -> None:
    study = ran(normal_force=LOADS)
    axes = one(study, "own_wear_rate_over_normal_force")
    first = next(patch for patch in axes.patches if patch.get_label() == "beyond shakedown")
    sweep = study.sweeps["own"]
    beyond = (sweep.max_pressure > sweep.shakedown_limit).any("contact_model").values
    newtons = 1000.0 * sweep.normal_force.values
    assert newtons[~beyond].max() < first.get_x() < newtons[beyond].min()  # type: ignore[attr-defined]


def test_a_figure_asked_for_has_ends_in_any_unit_and_the_axis_in_that_of_the_case() -> None:
    spec = {"sweep": "own", "x": "normal_force", "y": "wear_rate", "x_range": ["1 kN", "6 kN"]}
    axes = one(ran(normal_force=LOADS, figures={"mine": spec}), "mine")
    assert axes.get_xlabel() == "normal force [N]"
    assert axes.get_xlim() == pytest.approx((1000.0, 6000.0), rel=1e-14)


@pytest.mark.parametrize(
    ("load", "name"), [({"from": "20 N", "to": "90 N", "points": 5}, "N"), (LOADS, "N"), ("4 kN", "kN")]
)
def test_no_tick_is_a_number_times_a_power_of_ten(load: Any, name: str) -> None:
    study = ran(normal_force=load, creepage={"from": "0.6 %", "to": "7 %", "points": 5, "spacing": "log"})
    for figure in drawings(study).values():
        for axes in (axes for axes in figure.axes if axes.get_xlabel()):  # without the bar of colours
            for axis in (axes.xaxis, axes.yaxis):
                ticks = [*axis.get_ticklabels(), *axis.get_ticklabels(minor=True)]
                assert not any("10^" in tick.get_text() for tick in ticks)
                assert sum(bool(tick.get_text()) for tick in ticks) >= 3
    assert f" {name}" in texts(figure) or "normal_force" in study.sweeps["own"].dims


def test_titles_are_words_and_the_picture_tells_study_and_conditions() -> None:
    profile = {"profiles": {"patch": AT}}
    found = drawings(ran(("exact",), normal_force=LOADS, **profile))
    assert [figure.get_suptitle() for figure in found.values()] == [
        "Wear rate over wear index Tγ", "Wear rate over normal force", "Stresses and relative slip s along the patch",
    ]  # fmt: skip
    each = [texts(figure) for figure in found.values()]
    assert all("Rollers: creepage 1 %, friction coefficient 0.4" in text for text in each[:2])
    assert "Rollers: normal force 4 kN, creepage 1 %, friction coefficient 0.4" in each[2]


def test_titles_of_several_sweeps_name_the_sweep() -> None:
    sweeps = {"dry_run": {**AT, "creepage": ["1 %", "2 %"]}, "wet": {**AT, "creepage": ["1 %", "3 %"]}}
    found = [figure.get_suptitle() for figure in drawings(ran(sweeps=sweeps)).values()]
    assert found[:2] == ["Wear rate over wear index Tγ (dry run)", "Wear rate over creepage (dry run)"]


# Stresses at the edges of the patch


def test_stresses_are_drawn_to_the_edges_of_the_patch() -> None:
    axes = one(ran(("exact",), profiles={"patch": AT}), "patch_along_the_patch")
    for label, line in lines(axes).items():
        assert line[[0, -1], 1].tolist() == [0.0, 0.0], label
        assert line[0, 0] == -line[-1, 0]


def test_wear_is_drawn_to_the_edges_of_an_ellipse() -> None:
    rig = {"type": "wheel_rail", "wheel_radius": "460 mm", "rail_head_radius": "300 mm", "material": "steel",
           "rolling_speed": "20 m/s"}  # fmt: skip
    at = {"normal_force": "60 kN", "longitudinal_creepage": "0.1 %", "friction_coefficient": 0.3}
    fields = {"rig": rig, "contact_models": ["fastsim"], "wear_laws": ["kth"], "profiles": {"patch": at}}
    found = run(case(**fields, sweeps={"own": at}))
    edge = found.conditions(profile="patch")
    half = found.pairs[0].pipeline(**edge).problem.b.item()
    for axes in drawings(found)["patch_across_the_patch"].axes:
        for line in axes.lines:
            points = np.asarray(line.get_xydata())
            assert points[[0, -1]] == pytest.approx(np.array([[-1e3 * half, 0.0], [1e3 * half, 0.0]]), rel=1e-12)


# One operating point


def test_one_operating_point_is_shown_as_bars_with_their_names_and_numbers() -> None:
    study = ran(("global", "exact"), wear_laws=["usfd", "kth"])
    found = drawings(study)
    assert [*found] == ["own_wear_rate", "own_traction"]
    (axes,) = found["own_wear_rate"].axes
    sweep = study.sweeps["own"]
    rates = sweep.wear_rate.values
    bars = [patch for patch in axes.patches if patch.get_width() in rates]  # type: ignore[attr-defined]
    assert [bar.get_width() for bar in bars] == rates.tolist()  # type: ignore[attr-defined]
    assert [text.get_text() for text in axes.get_yticklabels()] == sweep.pair.values.tolist()
    assert [float(text.get_text().split()[0]) for text in axes.texts] == pytest.approx(rates, rel=5e-3)
    kth = axes.texts[1].get_text()
    assert kth.endswith(")"), "with the published range"
    assert axes.get_xlim()[0] == 0.0
    assert axes.get_xlabel() == "wear rate [µg/m/mm²]"
    assert study.figures[0].title == "Wear rate"
    assert study.figures[0].caption.endswith("The contact is beyond shakedown.")


# Maps


def test_two_axes_make_a_map_of_the_users_spacing_and_units_for_each_pair() -> None:
    both: dict[str, Any] = {
        "normal_force": LOADS,
        "creepage": {"from": "0.1 %", "to": "20 %", "points": 12, "spacing": "log"},
    }
    study = ran(("global", "exact"), wear_laws=["usfd", "kth"], **both)
    figure = drawings(study)["own_wear_rate_over_creepage_and_normal_force"]
    assert figure.get_suptitle() == "Wear rate over creepage and normal force"
    *panels, bar = figure.axes
    sweep = study.sweeps["own"]
    assert [axes.get_title() for axes in panels] == sweep.pair.values.tolist()
    for axes, pair in zip(panels, sweep.pair.values, strict=True):
        assert (axes.get_xscale(), axes.get_yscale()) == ("log", "linear")
        assert (axes.get_xlabel(), axes.get_ylabel()) == ("creepage [%]", "normal force [N]")
        rates = sweep.wear_rate.sel(pair=pair).transpose("normal_force", "creepage").values
        np.testing.assert_array_equal(np.asarray(axes.collections[0].get_array()), rates)
        assert axes.get_ylim()[0] < 500.0 < 8000.0 < axes.get_ylim()[1]
    assert bar.get_ylabel() == "wear rate [µg/m/mm²]"
    assert {"beyond first yield", "beyond shakedown"} <= {text.get_text() for text in figure.legends[0].get_texts()}
    assert "Rollers: friction coefficient 0.4" in texts(figure)


def test_few_values_along_an_axis_make_no_map() -> None:
    study = ran(creepage={"from": "1 %", "to": "5 %", "points": 5}, friction_coefficient=[0.2, 0.4])
    assert not any(panel.map for figure in study.figures for panel in figure.panels)


def test_a_case_can_ask_for_a_map_of_any_variable() -> None:
    spec = {"sweep": "own", "x": "normal_force", "y": "creepage", "map": "traction_coefficient", "y_scale": "log",
            "contact_models": ["exact"]}  # fmt: skip
    both: dict[str, Any] = {"normal_force": LOADS, "creepage": ["0.1 %", "0.5 %", "3 %"]}
    study = ran(("global", "exact"), wear_laws=["usfd"], figures={"mine": spec}, **both)
    axes, bar = drawings(study)["mine"].axes
    assert (axes.get_title(), axes.get_yscale(), bar.get_ylabel()) == ("exact", "log", "traction coefficient T/N [-]")


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"y": "friction_coefficient"}, r"figures\.mine\.y: a map runs along axes of the sweep; there is no 'friction"),
        ({"x": "wear_index"}, r"figures\.mine\.x: a map runs along axes of the sweep; there is no 'wear_index'"),
        ({"y": "normal_force"}, "y: a map runs over two axes of the sweep; name the other one as y"),
        ({"map": "waer_rate"}, r"figures\.mine\.map: 'waer_rate' cannot be shown; did you mean 'wear_rate'"),
        ({"panels": [{}]}, "panels: a map has a panel for each pair; leave them out"),
        ({"measured": True}, "measured: a map shows no tests; leave it out"),
        ({"pairs": ["kth on exact"]}, "pairs: .*there is no 'kth on exact'"),
    ],
)
def test_a_map_that_is_not_possible_says_why(changes: dict[str, Any], message: str) -> None:
    spec = {"sweep": "own", "x": "normal_force", "y": "creepage", "map": "wear_rate", **changes}
    sweeps = {"own": {**AT, "normal_force": LOADS, "creepage": ["0.1 %", "0.5 %"]}}
    fields = {"rig": ROLLERS, "contact_models": ["global"], "sweeps": sweeps, "profiles": {}, "figures": {"mine": spec}}
    with pytest.raises(ConfigurationError, match=message):
        case(**fields)


def test_the_main_figure_of_two_axes_is_a_map_that_the_first_screen_has_room_for() -> None:
    both: dict[str, Any] = {"normal_force": LOADS, "creepage": {"from": "0.1 %", "to": "20 %", "points": 6}}
    study = ran(("global", "exact"), wear_laws=["usfd", "kth"], **both)
    figure = main_figure(main_result(study))
    assert figure.name == "main_wear_rate_over_creepage_and_normal_force"
    assert [panel.title for panel in figure.panels if panel.map] == ["usfd on global", "kth on global"]
    assert figure.caption.endswith("Only the pairs with global are shown; the tables hold all.")
    small = ran(wear_laws=["usfd", "kth"], **both)
    assert any(main_figure(main_result(small)) is one for one in small.figures), "the study's own map, shown once"


def test_hollow_markers_are_explained_in_both_drawings() -> None:
    x = np.array([1.0, 2.0])
    curves = (Curve("law", x, x, points=True, hollow=True), Curve("measured", x, x, colour=6, points=True))
    figure = FigureData("f", "F", (Panel(PlotAxis("x"), PlotAxis("y"), curves),))
    drawn = draw(figure)
    hollow, filled = drawn.axes[0].get_lines()
    assert (hollow.get_markerfacecolor(), filled.get_markerfacecolor()) == ("none", filled.get_color())
    assert drawn.legends[0].get_title().get_text() == "hollow markers: predictions"
    interactive = plotly_figure(figure)
    assert [trace["marker"]["symbol"] for trace in interactive["data"]] == ["square-open", "circle"]
    assert interactive["layout"]["legend"]["title"]["text"] == "hollow markers: predictions"
