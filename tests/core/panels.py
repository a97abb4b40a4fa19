"""Figures, panels and curves by their names, and figures of small cases, for the tests of figures."""

from __future__ import annotations

import re
from typing import Any

import numpy as np

from tests.core.cases import case
from wearlaw.figures.coinciding import SAME
from wearlaw.figures.curves import Curve, FigureData, Panel
from wearlaw.study.study import Study, run

LOADS = {"from": "500 MPa", "to": "1500 MPa", "points": 3}
"""A range of maximum pressures."""


def shown(spec: dict[str, Any], **changes: Any) -> FigureData:
    """Return the one figure of a small case that asks for it."""
    (figure,) = run(case(**{"figures": {"one": spec}, **changes})).figures
    return figure


def by_name(study: Study) -> dict[str, FigureData]:
    return {figure.name: figure for figure in study.figures}


def one_panel(figure: FigureData) -> Panel:
    (panel,) = figure.panels
    return panel


def by_label(panel: Panel) -> dict[str, Curve]:
    """Return the curves of a panel by each of the names in their labels: one line stands for all that coincide."""
    return {name: curve for curve in panel.curves for name in re.split(" [=≈] ", curve.label)}


def assert_shows(curve: Curve, x: Any, y: Any) -> None:
    np.testing.assert_array_equal((curve.x, curve.y), (x, y))


def assert_passes(curve: Curve, x: Any, y: Any) -> None:
    """Check that a curve passes through points in their order; it may have more of them at jumps.

    Where one line stands for several, their values are the same to the rounding of their integrals.
    """
    x, y = np.asarray(x), np.asarray(y)
    here = [int(abs(curve.x - value).argmin()) for value in x]
    assert here == sorted(set(here))
    np.testing.assert_allclose((curve.x[here], curve.y[here]), (x, y), rtol=SAME if "=" in curve.label else 0.0)
