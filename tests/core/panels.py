"""Figures, panels and curves by their names, for the tests of what figures show."""

from __future__ import annotations

from typing import Any

import numpy as np

from wearlaw.figures.curves import Curve, FigureData, Panel
from wearlaw.study import Study


def by_name(study: Study) -> dict[str, FigureData]:
    return {figure.name: figure for figure in study.figures}


def one_panel(figure: FigureData) -> Panel:
    (panel,) = figure.panels
    return panel


def by_label(panel: Panel) -> dict[str, Curve]:
    return {curve.label: curve for curve in panel.curves}


def assert_shows(curve: Curve, x: Any, y: Any) -> None:
    np.testing.assert_array_equal((curve.x, curve.y), (x, y))
