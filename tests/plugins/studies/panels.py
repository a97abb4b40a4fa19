"""Figures, panels and curves by their names, and figures of small cases, for the tests of figures."""

from __future__ import annotations

from typing import Any

import numpy as np

import wearlaw as wl
from tests.cases import case
from wearlaw import Curve, FigureData, Panel, Study

LOADS = {"from": "500 MPa", "to": "1500 MPa", "points": 3}
"""A range of maximum pressures."""


def shown(spec: dict[str, Any], **changes: Any) -> FigureData:
    """Return the one figure of a small case that asks for it."""
    return by_name(wl.run(case(**{"figures": {"one": spec}, **changes})))["one"]


def by_name(study: Study) -> dict[str, FigureData]:
    return {figure.name: figure for figure in study.figures}


def one_panel(figure: FigureData) -> Panel:
    (panel,) = figure.panels
    return panel


def by_label(panel: Panel) -> dict[str, Curve]:
    return {curve.label: curve for curve in panel.curves}


def assert_shows(curve: Curve, x: Any, y: Any) -> None:
    np.testing.assert_array_equal((curve.x, curve.y), (x, y))
