"""Measured tests in the figures of a case, against numbers worked out by hand."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.core import cases
from tests.core.cases import case
from tests.plugins.studies.panels import LOADS, by_name, one_panel, shown
from tests.strategies import EPS
from wearlaw_output.curves import Curve
from wearlaw_output.drawing import draw
from wearlaw_studies.study import run

TESTS = """creepage [%],normal_force [kN],tangential_force [N],wear_rate [ug/m/mm^2],wear_rate_uncertainty [ug/m/mm^2]
1,7,2100,20,2
-5,7,3500,,3
10,6,,60,
"""


@pytest.fixture
def measured(tmp_path: Path) -> dict[str, Any]:
    file = tmp_path / "tests.csv"
    file.write_text(TESTS, encoding="utf-8")
    return {"label": "my tests", "tests": str(file)}


def points(measured: dict[str, Any], x: str, y: str) -> Curve:
    sweeps = {"creepage": cases.SWEEP, "load": {**cases.POINT, "max_pressure": LOADS}}
    of_load = x in ("normal_force", "half_width")
    spec = {"sweep": "load" if of_load else "creepage", "x": x, "y": y, "measured": True}
    (curve,) = (curve for curve in one_panel(shown(spec, measured=measured, sweeps=sweeps)).curves if curve.points)
    assert curve.label == "my tests"
    return curve


def test_measured_traction_is_shown_where_it_was_measured(measured: dict[str, Any]) -> None:
    traction = points(measured, "creepage", "traction_coefficient")
    np.testing.assert_allclose((traction.x, traction.y), ([1.0, 5.0], [0.3, 0.5]), rtol=4 * EPS)
    force = points(measured, "normal_force", "tangential_force")
    np.testing.assert_allclose((force.x, force.y), ([7.0, 7.0], [2100.0, 3500.0]), rtol=8 * EPS)
    assert force.low is None


@pytest.mark.parametrize("x", ["wear_index", "averaged_wear_index"])
def test_measured_wear_is_shown_against_the_measured_wear_index(measured: dict[str, Any], x: str) -> None:
    wear = points(measured, x, "wear_rate")
    np.testing.assert_allclose((wear.x, wear.y), ([21.0], [20.0]), rtol=8 * EPS)


def test_the_uncertainty_of_measured_wear_is_shown(measured: dict[str, Any]) -> None:
    wear = points(measured, "creepage", "wear_rate")
    np.testing.assert_allclose((wear.x, wear.y), ([1.0, 10.0], [20.0, 60.0]), rtol=4 * EPS)
    assert wear.low is not None
    assert wear.high is not None
    against_creepage = {"sweep": "creepage", "x": "creepage", "y": "wear_rate", "measured": True}
    figure = shown(against_creepage, measured=measured)
    draw(figure).draw_without_rendering()
    y_ends = one_panel(figure).y.ends
    assert y_ends is not None
    assert y_ends[0] == 0.0
    assert y_ends[1] > 60.0
    np.testing.assert_allclose((wear.low, wear.high), ([18.0, math.nan], [22.0, math.nan]), rtol=4 * EPS)


def test_the_area_and_width_of_the_patch_in_a_test_are_those_of_its_load(measured: dict[str, Any]) -> None:
    density = points(measured, "half_width", "wear_index_density")
    # 700 N/mm on discs of 47 mm: a² = 4PR/(πE*) in mm and N (Johnson 1985)
    half_width = math.sqrt(4.0 * 700.0 * 47.0 / 4.0 / (math.pi * 206477.42 / (2.0 * (1.0 - 0.28**2))))
    np.testing.assert_allclose(density.x, half_width, rtol=64 * EPS)
    np.testing.assert_allclose(density.y, np.array([21.0, 175.0]) / (20.0 * half_width), rtol=64 * EPS)


@pytest.mark.parametrize("sweep", [cases.SWEEP, cases.POINT])
def test_tests_without_traction_leave_the_default_figures_of_traction_to_the_models(
    tmp_path: Path, sweep: dict[str, Any]
) -> None:
    file = tmp_path / "tests.csv"
    file.write_text(cases.TESTS_CSV, encoding="utf-8")
    figures = run(case(measured={"label": "my tests", "tests": str(file)}, sweeps={"creepage": sweep})).figures
    traction = [figure for figure in figures if "traction" in figure.name]
    assert traction
    assert not any(c.points and not c.hollow for figure in traction for panel in figure.panels for c in panel.curves)


def test_measured_tests_are_shown_without_being_asked_for_by_a_case_without_figures(measured: dict[str, Any]) -> None:
    figures = by_name(run(case(measured=measured)))
    for name in ("traction_over_creepage", "wear_rate_over_creepage", "wear_rate_over_wear_index"):
        assert [c.label for c in one_panel(figures[f"creepage_{name}"]).curves if c.points] == ["my tests"]


def test_default_figures_show_measured_tests_over_creepage_only(measured: dict[str, Any]) -> None:
    sweeps = {"load": {**cases.POINT, "max_pressure": LOADS}}
    figures = run(case(measured=measured, sweeps=sweeps)).figures
    assert not any(curve.points for figure in figures for panel in figure.panels for curve in panel.curves)
