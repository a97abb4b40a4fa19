"""Panels of measured against predicted values, with the lines of equality and of a factor of two."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np

from wearlaw.arrays import Array
from wearlaw_apps.output.curves import BLACK, Curve, Panel, PlotAxis

MARGIN = 0.05
"""Margin of linear axes, as a share of the range of the values."""


def parity_panels(
    name: str, curves: Sequence[tuple[str, Sequence[Curve]]], values: Array, linear: bool
) -> tuple[Panel, ...]:
    """Return panels with one pair of axes: predicted values across, measured values up.

    The lines of a factor of two are on logarithmic axes only.

    Parameters
    ----------
    name : str
        Name and unit of the values, for the axes.
    curves : sequence of (str, sequence of Curve)
        Title and points of each panel.
    values : ndarray
        All values, predicted and measured, in the unit of the axes.
    linear : bool
        Whether the axes are linear, for values of zero or below; otherwise they are logarithmic.
    """
    scale: Literal["linear", "log"] = "linear" if linear else "log"
    ends = _ends(values if linear else values[values > 0.0], linear)
    across, up = (PlotAxis(f"{kind} {name}", scale, ends) for kind in ("predicted", "measured"))
    guides = _guides(ends)[: 1 if linear else None]
    return tuple(Panel(across, up, (*guides, *shown), title) for title, shown in curves)


def _ends(values: Array, linear: bool) -> tuple[float, float]:
    """Return the ends of both axes: a factor of two around all values, since whole decades would waste space."""
    if linear:
        margin = MARGIN * float(np.ptp(values))
        return float(values.min()) - margin, float(values.max()) + margin
    return (0.5 * values.min(), 2.0 * values.max()) if values.size else (0.1, 10.0)


def _guides(ends: tuple[float, float]) -> list[Curve]:
    """Return the lines of equality and of a factor of two either way."""
    x = np.array(ends)
    lines = (("predicted = measured", 1.0, 0), ("factor of two", 0.5, 2), ("factor of two", 2.0, 2))
    return [Curve(name, x, factor * x, colour=BLACK, dash=dash, computed=False) for name, factor, dash in lines]
