"""Figures that a case asks for, against its results, published numbers and closed forms."""

from __future__ import annotations

import numpy as np
import pytest

from tests.core import cases
from tests.core.cases import case
from tests.core.panels import assert_shows, by_label, one_panel, shown
from tests.strategies import EPS
from wearlaw.study.study import run

WEAR = {"sweep": "creepage", "x": "wear_index", "y": "wear_rate"}


def test_title_and_caption_are_those_that_are_given() -> None:
    figure = shown({**WEAR, "title": "A title", "caption": "A caption.", "panels": [{"title": "(a)"}]})
    assert (figure.name, figure.title, figure.caption) == ("one", "A title", "A caption.")
    assert one_panel(figure).title == "(a)"


def test_only_the_chosen_pairs_are_shown_in_their_order_and_their_colours() -> None:
    panel = one_panel(shown({**WEAR, "pairs": ["kth on exact", "usfd on global"]}))
    styles = [(curve.label, curve.colour, curve.dash) for curve in panel.curves]
    assert styles == [("kth on exact", 1, 1), ("usfd on global", 0, 0)]


def test_only_the_chosen_contact_models_and_pairs_are_shown() -> None:
    spec = {"sweep": "creepage", "x": "creepage", "y": "mean_slip", "contact_models": ["exact"]}
    assert [curve.label for curve in one_panel(shown(spec)).curves] == ["exact"]
    wear = {"profile": "partial_slip", "y": "wear_rate", "pairs": ["kth on exact"]}
    assert [curve.label for curve in one_panel(shown(wear)).curves] == ["kth on exact"]
    along = {"profile": "partial_slip", "y": "traction", "contact_models": ["fastsim"]}
    panel = one_panel(shown(along, contact_models=["exact", "fastsim"]))
    assert [curve.label for curve in panel.curves] == ["traction q, fastsim"]


def test_several_variables_of_one_unit_share_an_axis_and_differ_in_colour() -> None:
    spec = {"sweep": "creepage", "x": "creepage", "y": ["wear_index", "averaged_wear_index"]}
    panel = one_panel(shown(spec))
    assert panel.y.label == "wear index Tγ, averaged wear index [N]"
    assert [(curve.label, curve.colour, curve.dash) for curve in panel.curves] == [
        ("wear index Tγ, global", 0, 0), ("wear index Tγ, exact", 0, 1),
        ("averaged wear index, global", 1, 0), ("averaged wear index, exact", 1, 1),
    ]  # fmt: skip


def test_a_panel_has_what_the_figure_says_and_it_does_not() -> None:
    panels = [{}, {"x_range": ["10 N", "0.05 kN"], "x_scale": "linear", "y_range": ["0 ug/m/mm^2", "1 mg/m/mm^2"]}]
    first, second = shown({**WEAR, "x_scale": "log", "y_scale": "linear", "panels": panels}).panels
    assert (first.x.scale, first.x.ends) == ("log", None)
    assert (second.x.scale, second.x.ends) == ("linear", (10.0, 50.0))
    assert second.y.ends == pytest.approx((0.0, 1000.0), rel=4 * EPS)
    assert by_label(first).keys() == by_label(second).keys()


def test_plain_numbers_are_the_ends_of_an_axis_without_a_unit() -> None:
    spec = {"sweep": "creepage", "x": "creepage", "y": "traction_coefficient", "y_range": [0, 0.5]}
    assert one_panel(shown(spec)).y.ends == (0.0, 0.5)


@pytest.mark.parametrize("scale", ["linear", "log"])
def test_the_y_axis_shows_all_that_is_in_the_window_bands_too(scale: str) -> None:
    window = {"x_range": ["1 N", "100 N"], "y_scale": scale}
    panel = one_panel(shown({**WEAR, **window, "pairs": ["usfd on global", "kth on global"]}))
    kth = by_label(panel)["kth on global"]
    assert kth.low is not None
    assert kth.high is not None
    inside = (kth.x >= 1.0) & (kth.x <= 100.0)
    assert inside.any()
    assert not inside.all()
    assert panel.y.ends is not None
    low, high = panel.y.ends
    assert max(kth.high[inside]) < high < 1.6 * max(kth.high[inside])
    assert low == 0.0 if scale == "linear" else 0.6 * min(kth.low[inside]) < low < min(kth.low[inside])


def test_a_window_without_any_point_leaves_its_y_axis_open() -> None:
    assert one_panel(shown({**WEAR, "x_range": ["1 MN", "2 MN"], "y_scale": "log"})).y.ends is None


def test_a_figure_runs_along_the_axis_that_its_x_names() -> None:
    grid = {**cases.POINT, "max_pressure": ["500 MPa", "1000 MPa", "1500 MPa"], "creepage": ["1 %", "2 %"]}
    ran = case(sweeps={"both": grid}).model_copy(
        update={"figures": {x: {"sweep": "both", "x": x, "y": "wear_rate"} for x in ("half_width", "creepage")}}
    )
    across, along = run(ran).figures
    assert one_panel(across).title == "creepage 2 %"
    assert one_panel(along).title == "maximum pressure 1000 MPa"
    # a = 2 p0 R / E*, here with R = 11.75 mm and E* = 112.0212 GPa
    np.testing.assert_allclose(
        one_panel(across).curves[0].x, 2 * np.array([500, 1000, 1500]) * 11.75 / 112021.2, rtol=1e-6
    )
    np.testing.assert_array_equal(one_panel(along).curves[0].x, [1.0, 2.0])


def test_a_figure_runs_along_friction_where_its_x_is_friction() -> None:
    grid = {**cases.POINT, "friction_coefficient": [0.1, 0.2, 0.4], "creepage": ["5 %", "10 %", "15 %", "20 %"]}
    spec = {"sweep": "both", "x": "friction_coefficient", "y": "traction_coefficient", "contact_models": ["exact"]}
    panel = one_panel(shown(spec, sweeps={"both": grid}))
    assert panel.title == "creepage 15 %"
    np.testing.assert_allclose((panel.curves[0].x, panel.curves[0].y), [[0.1, 0.2, 0.4]] * 2, rtol=16 * EPS)


def test_along_the_patch_signs_are_kept_and_the_creepage_is_a_level_line() -> None:
    spec = {"profile": "back", "y": ["slip", "creepage"]}
    slip, level = one_panel(shown(spec, profiles={"back": {**cases.POINT, "creepage": "-0.5 %"}})).curves
    assert slip.y.min() < -0.5
    assert slip.y.max() == 0.0
    assert_shows(level, slip.x[[0, -1]], [-0.5, -0.5])


def test_a_y_axis_does_not_begin_at_zero_where_something_is_below() -> None:
    spec = {"profile": "back", "y": ["pressure", "traction"]}
    panel = one_panel(shown(spec, profiles={"back": {**cases.POINT, "creepage": "-0.5 %"}}))
    assert panel.y.ends is None


def test_wear_along_the_patch_is_shown_for_every_pair() -> None:
    ran = run(case(figures={"one": {"profile": "partial_slip", "y": "wear_rate"}}))
    (figure,) = ran.figures
    rates = ran.profiles["partial_slip"].wear_rate
    assert [(c.label, c.colour, c.dash) for c in one_panel(figure).curves] == [
        ("usfd on exact", 0, 1),
        ("kth on exact", 1, 1),
    ]
    for curve in one_panel(figure).curves:
        assert_shows(curve, rates.x, rates.sel(pair=curve.label))
