"""Figures of a case that asks for none, against its results."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from tests.core import cases
from tests.core.cases import InstallModel, case
from tests.core.panels import LOADS, assert_shows, by_label, by_name, one_panel
from wearlaw.study.study import Study, run


@pytest.fixture(scope="module")
def study() -> Study:
    by_load = {**cases.POINT, "max_pressure": LOADS, "friction_coefficient": [0.3, 0.4]}
    return run(case(sweeps={"creepage": cases.SWEEP, "load": by_load}))


def test_a_case_that_asks_for_no_figures_has_one_of_each_kind(study: Study) -> None:
    assert list(by_name(study)) == [
        "creepage_wear_rate_against_wear_index",
        "creepage_wear_rate_against_creepage",
        "creepage_traction_against_creepage",
        "load_wear_rate_against_wear_index",
        "load_wear_rate_against_max_pressure",
        "partial_slip_along_the_patch",
    ]


@pytest.mark.parametrize(
    ("name", "x", "label"),
    [
        ("creepage_wear_rate_against_creepage", "creepage", "creepage [%]"),
        ("creepage_wear_rate_against_wear_index", "wear_index", "wear index Tγ [N]"),
        ("load_wear_rate_against_max_pressure", "max_pressure", "maximum pressure [MPa]"),
        ("load_wear_rate_against_wear_index", "wear_index", "wear index Tγ [N]"),
    ],
)
def test_wear_rate_is_shown_for_every_pair_as_the_dataset_has_it(study: Study, name: str, x: str, label: str) -> None:
    panel = one_panel(by_name(study)[name])
    assert (panel.x.label, panel.y.label) == (label, "wear rate [µg/m/mm²]")
    assert (panel.x.scale, panel.y.scale) == ("log", "log")
    assert (panel.x.ends, panel.y.ends) == (None, None)
    sweep = study.sweeps["creepage"]
    if name.startswith("load"):
        sweep = study.sweeps["load"].isel(friction_coefficient=1)
        assert panel.title == "friction coefficient 0.4"
    else:
        assert panel.title == ""
    assert list(by_label(panel)) == list(sweep.pair.values)
    for pair, curve in by_label(panel).items():
        along = sweep[x].sel(contact_model=pair.split(" on ")[1]) if x == "wear_index" else sweep[x]
        assert_shows(curve, along, sweep.wear_rate.sel(pair=pair))


def test_colour_tells_the_law_and_line_style_the_contact_model_in_all_figures(study: Study) -> None:
    styles = {
        (curve.label, curve.colour, curve.dash)
        for name, figure in by_name(study).items()
        if "wear_rate" in name
        for curve in one_panel(figure).curves
    }
    assert styles == {
        ("usfd on global", 0, 0), ("kth on global", 1, 0), ("brr on global", 2, 0),
        ("usfd on exact", 0, 1), ("kth on exact", 1, 1),
    }  # fmt: skip


def test_the_band_of_a_law_is_shown_and_only_where_there_is_one(study: Study) -> None:
    curves = by_label(one_panel(by_name(study)["creepage_wear_rate_against_creepage"]))
    sweep = study.sweeps["creepage"]
    for pair, curve in curves.items():
        if pair.startswith("kth"):
            one = sweep.sel(pair=pair)
            np.testing.assert_array_equal((curve.low, curve.high), (one.wear_rate_low, one.wear_rate_high))
        else:
            assert curve.low is None
            assert curve.high is None


def test_traction_is_shown_for_every_contact_model(study: Study) -> None:
    panel = one_panel(by_name(study)["creepage_traction_against_creepage"])
    assert (panel.x.label, panel.y.label) == ("creepage [%]", "traction coefficient T/N [-]")
    assert (panel.x.scale, panel.y.scale) == ("log", "linear")
    assert panel.y.ends is not None
    assert panel.y.ends[0] == 0.0
    sweep = study.sweeps["creepage"]
    assert [(curve.label, curve.colour, curve.dash) for curve in panel.curves] == [("global", 0, 0), ("exact", 1, 1)]
    for curve in panel.curves:
        assert_shows(curve, sweep.creepage, sweep.traction_coefficient.sel(contact_model=curve.label))


def test_stresses_and_slip_are_shown_along_the_patch(study: Study) -> None:
    stresses, slip = by_name(study)["partial_slip_along_the_patch"].panels
    assert stresses.y.label == "pressure p, traction q, traction bound [MPa]"
    assert (slip.x.label, slip.y.label) == ("position x, leading edge left [mm]", "relative slip s [%]")
    profile = study.profiles["partial_slip"].sel(contact_model="exact")
    curves = {**by_label(stresses), **by_label(slip)}
    assert_shows(curves.pop("pressure p"), profile.x, profile.pressure)
    assert_shows(curves.pop("traction q, exact"), profile.x, profile.traction)
    assert_shows(curves.pop("traction bound, exact"), profile.x, profile.traction_bound)
    assert_shows(curves.pop("relative slip s, exact"), profile.x, profile.slip)
    assert not curves


def test_a_model_with_nodes_of_its_own_is_shown_on_these(install_model: InstallModel) -> None:
    install_model(cases.Coarse)
    figures = by_name(run(case(contact_models=["coarse", "exact"], wear_laws=["kth"])))
    nodes = {c.label: c.x.size for panel in figures["partial_slip_along_the_patch"].panels for c in panel.curves}
    assert {size for label, size in nodes.items() if "coarse" in label or label == "pressure p"} == {7}
    assert {size for label, size in nodes.items() if "exact" in label} == {200}


@pytest.mark.parametrize(
    ("creepage", "scale"),
    [
        ("1 %", "log"),
        ("0 %", "linear"),
        ("-1 %", "log"),
        (["0 %", "1 %"], "log"),
        ({"from": "-1 %", "to": "1 %", "points": 5}, "log"),
    ],
    ids=["one point", "no creepage", "negative", "from zero", "through zero"],
)
def test_axes_are_logarithmic_unless_nothing_would_be_seen(creepage: Any, scale: str) -> None:
    ran = run(case(sweeps={"s": {**cases.POINT, "creepage": creepage}}, profiles={}))
    panel = one_panel(by_name(ran)["s_wear_rate_against_creepage"])
    assert (panel.x.scale, panel.y.scale) == (scale, scale)


def test_a_sweep_shows_magnitudes() -> None:
    back = run(case(sweeps={"back": {**cases.POINT, "creepage": ["-2 %", "-1 %"]}}, profiles={}))
    for curve in one_panel(by_name(back)["back_traction_against_creepage"]).curves:
        np.testing.assert_array_equal(curve.x, [2.0, 1.0])
        assert (curve.y > 0.0).all()


def test_a_measured_traction_coefficient_that_is_an_axis_is_shown_at_its_middle() -> None:
    conditions = {**cases.POINT, "creepage": ["1 %", "2 %"], "traction_coefficient": [0.1, 0.2]}
    panel = one_panel(by_name(run(case(sweeps={"m": conditions}, profiles={})))["m_traction_against_creepage"])
    assert panel.title == "traction coefficient T/N 0.2"
    assert_shows(panel.curves[0], [1.0, 2.0], [0.2, 0.2])


def test_a_caption_that_is_not_given_tells_the_conditions(study: Study) -> None:
    captions = {name: figure.caption for name, figure in by_name(study).items()}
    assert captions["creepage_wear_rate_against_creepage"] == "At maximum pressure 1500 MPa, friction coefficient 0.46."
    assert captions["load_wear_rate_against_wear_index"] == "At creepage 0.5 %, friction coefficient 0.4."
    at_one_point = "At maximum pressure 1500 MPa, creepage 0.5 %, friction coefficient 0.46."
    assert captions["partial_slip_along_the_patch"] == at_one_point
