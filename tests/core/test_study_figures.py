"""Figures of a case that asks for none, against its results."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from tests.core import cases
from tests.core.cases import InstallModel, case
from tests.core.panels import LOADS, assert_shows, by_label, by_name, one_panel
from wearlaw.figures.drawing import draw
from wearlaw.study.study import Study, run


@pytest.fixture(scope="module")
def study() -> Study:
    by_load = {**cases.POINT, "max_pressure": LOADS, "friction_coefficient": [0.3, 0.4]}
    return run(case(sweeps={"creepage": cases.SWEEP, "load": by_load}))


def test_a_case_that_asks_for_no_figures_has_one_of_each_kind(study: Study) -> None:
    assert list(by_name(study)) == [
        "creepage_wear_rate_over_wear_index",
        "creepage_wear_rate_over_creepage",
        "creepage_traction_over_creepage",
        "load_wear_rate_over_wear_index",
        "load_wear_rate_over_max_pressure",
        "partial_slip_along_the_patch",
    ]


@pytest.mark.parametrize(
    ("name", "x", "label"),
    [
        ("creepage_wear_rate_over_creepage", "creepage", "creepage [%]"),
        ("creepage_wear_rate_over_wear_index", "wear_index", "wear index Tγ [N]"),
        ("load_wear_rate_over_max_pressure", "max_pressure", "maximum pressure [MPa]"),
        ("load_wear_rate_over_wear_index", "wear_index", "wear index Tγ [N]"),
    ],
)
def test_wear_rate_is_shown_for_every_pair_as_the_dataset_has_it(study: Study, name: str, x: str, label: str) -> None:
    panel = one_panel(by_name(study)[name])
    assert (panel.x.label, panel.y.label) == (label, "wear rate [µg/m/mm²]")
    scale = "linear" if name.startswith("load") else "log"  # as the values of the sweep are spaced
    assert (panel.x.scale, panel.y.scale) == (scale, scale)
    assert panel.x.ends is None
    sweep = study.sweeps["creepage"]
    if name.startswith("load"):
        sweep = study.sweeps["load"].isel(friction_coefficient=1)
        assert panel.title == "friction coefficient 0.4"
    else:
        assert panel.title == ""
    assert sorted(by_label(panel)) == sorted(sweep.pair.values)
    for pair, curve in by_label(panel).items():
        along = sweep[x].sel(contact_model=pair.split(" on ")[1]) if x == "wear_index" else sweep[x]
        assert_shows(curve, along, sweep.wear_rate.sel(pair=pair))


def test_colour_tells_the_law_and_line_style_the_contact_model_in_all_figures(study: Study) -> None:
    styles = {
        (curve.label, curve.colour, curve.dash)
        for name, figure in by_name(study).items()
        if name.startswith("creepage_wear_rate")
        for curve in one_panel(figure).curves
    }
    assert styles == {
        ("usfd on global", 0, 0), ("kth on global", 1, 0), ("brr on global", 2, 0),
        ("usfd on exact", 0, 1), ("kth on exact", 1, 1),
    }  # fmt: skip


def test_the_band_of_a_law_is_shown_and_only_where_there_is_one(study: Study) -> None:
    curves = by_label(one_panel(by_name(study)["creepage_wear_rate_over_creepage"]))
    sweep = study.sweeps["creepage"]
    for pair, curve in curves.items():
        if pair.startswith("kth"):
            one = sweep.sel(pair=pair)
            np.testing.assert_array_equal((curve.low, curve.high), (one.wear_rate_low, one.wear_rate_high))
        else:
            assert curve.low is None
            assert curve.high is None


def test_traction_is_shown_for_every_contact_model(study: Study) -> None:
    panel = one_panel(by_name(study)["creepage_traction_over_creepage"])
    assert (panel.x.label, panel.y.label) == ("creepage [%]", "traction coefficient T/N [-]")
    assert (panel.x.scale, panel.y.scale) == ("log", "linear")
    assert panel.y.ends is not None
    assert panel.y.ends[0] == 0.0
    sweep = study.sweeps["creepage"]
    assert [(curve.label, curve.colour, curve.dash) for curve in panel.curves] == [("global", 0, 0), ("exact", 1, 1)]
    for model, curve in by_label(panel).items():
        assert_shows(curve, sweep.creepage, sweep.traction_coefficient.sel(contact_model=model))


def test_contact_models_that_differ_have_a_colour_and_a_line_style_each() -> None:
    figures = by_name(run(case(contact_models=["exact", "fastsim"], wear_laws=["kth"], profiles={})))
    panel = one_panel(figures["creepage_traction_over_creepage"])
    assert [(curve.label, curve.colour, curve.dash) for curve in panel.curves] == [("exact", 0, 0), ("fastsim", 1, 1)]


def test_stresses_and_slip_are_shown_along_the_patch(study: Study) -> None:
    stresses, slip = by_name(study)["partial_slip_along_the_patch"].panels
    assert stresses.y.label == "pressure p, traction q, traction bound [MPa]"
    assert (slip.x.label, slip.y.label) == ("position x, leading edge left [mm]", "relative slip s [%]")
    profile = study.profiles["partial_slip"].sel(contact_model="exact")
    curves = {**by_label(stresses), **by_label(slip)}
    # a = 2 p0 R / E*, as in test_study_figures_asked; there every stress is zero, and the nodes lie inside.
    edge = 2 * 1500 * 11.75 / 112021.2
    for label, field in (("pressure p", "pressure"), ("traction q, exact", "traction"),
                         ("traction bound, exact", "traction_bound")):  # fmt: skip
        curve = curves.pop(label)
        np.testing.assert_array_equal((curve.x[1:-1], curve.y[1:-1]), (profile.x, profile[field]))
        assert curve.x[[0, -1]] == pytest.approx([-edge, edge], rel=1e-6)
        assert curve.y[[0, -1]].tolist() == [0.0, 0.0]
    assert_shows(curves.pop("relative slip s, exact"), profile.x, profile.slip)
    assert not curves


def test_a_model_with_nodes_of_its_own_is_shown_on_these(install_model: InstallModel) -> None:
    install_model(cases.Coarse)
    figures = by_name(run(case(contact_models=["coarse", "exact"], wear_laws=["kth"])))
    nodes = {c.label: c.x.size for panel in figures["partial_slip_along_the_patch"].panels for c in panel.curves}
    stresses = {label: size - 2 for label, size in nodes.items() if "slip" not in label}  # without the edges
    assert {size for label, size in stresses.items() if "coarse" in label or label == "pressure p"} == {7}
    assert {size for label, size in stresses.items() if "exact" in label} == {200}
    assert {label: size for label, size in nodes.items() if "slip" in label} == {
        "relative slip s, coarse": 7, "relative slip s, exact": 200,
    }  # fmt: skip


@pytest.mark.parametrize(
    ("creepage", "scale"),
    [
        ({"from": "0.1 %", "to": "10 %", "points": 5, "spacing": "log"}, "log"),
        ({"from": "1 %", "to": "10 %", "points": 5}, "linear"),
        (["0.1 %", "0.2 %", "0.5 %", "1 %", "2 %", "5 %"], "log"),
        (["1 %", "2 %", "3 %", "4.1 %"], "linear"),
        (["1 %", "2 %"], "linear"),
        (["0 %", "1 %"], "linear"),
        ({"from": "-1 %", "to": "1 %", "points": 5}, "linear"),
        ({"from": "-10 %", "to": "-0.1 %", "points": 5, "spacing": "log"}, "log"),
    ],
)
def test_axes_are_spaced_as_the_values_of_the_sweep(creepage: Any, scale: str) -> None:
    figures = by_name(run(case(sweeps={"s": {**cases.POINT, "creepage": creepage}}, profiles={})))
    for name in ("s_wear_rate_over_creepage", "s_wear_rate_over_wear_index"):
        panel, (axes,) = one_panel(figures[name]), draw(figures[name]).axes
        assert (panel.x.scale, axes.get_xscale(), axes.get_yscale()) == (scale, scale, panel.y.scale)
        assert panel.y.scale == scale or scale == "linear"
    assert one_panel(figures["s_traction_over_creepage"]).x.scale == scale


def test_over_a_linear_sweep_wear_rates_that_differ_much_stand_on_a_logarithmic_axis() -> None:
    far = {"from": "0.1 %", "to": "20 %", "points": 5}
    figures = by_name(run(case(sweeps={"s": {**cases.POINT, "creepage": far}}, profiles={})))
    panel = one_panel(figures["s_wear_rate_over_creepage"])
    assert (panel.x.scale, panel.y.scale) == ("linear", "log")


def test_a_sweep_shows_magnitudes() -> None:
    back = run(case(sweeps={"back": {**cases.POINT, "creepage": ["-2 %", "-1 %"]}}, profiles={}))
    for curve in one_panel(by_name(back)["back_traction_over_creepage"]).curves:
        np.testing.assert_array_equal(curve.x, [2.0, 1.0])
        assert (curve.y > 0.0).all()


def test_a_measured_traction_coefficient_that_is_an_axis_is_shown_at_its_middle() -> None:
    conditions = {**cases.POINT, "creepage": ["1 %", "2 %"], "traction_coefficient": [0.1, 0.2]}
    panel = one_panel(by_name(run(case(sweeps={"m": conditions}, profiles={})))["m_traction_over_creepage"])
    assert panel.title == "traction coefficient T/N 0.2"
    assert_shows(panel.curves[0], [1.0, 2.0], [0.2, 0.2])


def test_a_caption_that_is_not_given_tells_the_conditions(study: Study) -> None:
    captions = {name: figure.caption.partition(" Above the grey strip")[0] for name, figure in by_name(study).items()}
    assert captions["creepage_wear_rate_over_creepage"] == "At maximum pressure 1500 MPa, friction coefficient 0.46."
    assert captions["load_wear_rate_over_wear_index"] == "At creepage 0.5 %, friction coefficient 0.4."
    at_one_point = "At maximum pressure 1500 MPa, creepage 0.5 %, friction coefficient 0.46."
    assert captions["partial_slip_along_the_patch"] == at_one_point
