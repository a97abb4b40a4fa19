"""The table and the figure of the wear in contacts that are already solved."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd

from wearlaw.arrays import Array
from wearlaw.models.law import WEAR, named_outcomes
from wearlaw.pipeline.prediction import Prediction
from wearlaw.units.quantities import WEAR_RATE, Q, Quantity
from wearlaw.units.registry import symbol
from wearlaw_apps.output.curves import Curve, FigureData, Panel, PlotAxis

SHOWN = {
    "normal_force": "N",
    "longitudinal_force": "N",
    "lateral_force": "N",
    "spin_moment": "N*m",
    "creepage": "%",
    "lateral_creepage": "%",
    "spin": "1/m",
    "friction_coefficient": "",
    "patch_area": "mm^2",
    "max_pressure": "MPa",
    "stick_ratio": "",
}
"""Variables of the contact in the table, with their units."""

POWER_OF_CREEPAGES, POWER_OF_SLIP = "power_of_creepages [W]", "power_of_slip [W]"
"""Columns of the two powers: V(ξFx + ηFy + φMz), and the sum over the nodes, V ∑ q·s dA."""


def worn_table(prediction: Prediction, labels: Sequence[str]) -> pd.DataFrame:
    """Return forces, powers and outcomes of the laws, with a row for each contact of a batch of one axis."""
    columns: dict[str, Any] = {"contact": list(labels)}
    for name, unit in SHOWN.items():
        full = "longitudinal_creepage" if name == "creepage" else name
        columns[_head(full, unit)] = _column(getattr(prediction, name), unit)
    speed = np.atleast_1d(prediction.problem.rolling_speed)
    columns[POWER_OF_CREEPAGES] = speed * _column(prediction.wear_index, "N")
    columns[POWER_OF_SLIP] = speed * _column(prediction.cell_wear_index, "N")
    for name, index in named_outcomes(prediction.laws).items():
        law = prediction.laws[index]
        if law.outcome.name == WEAR and law.body is None and prediction.problem.bodies:
            for body in prediction.problem.bodies:
                columns[_head(f"{name}_{body}", WEAR_RATE)] = _column(prediction.wear_rate_of(body), WEAR_RATE)
        else:
            columns[_head(name, law.outcome.unit)] = _column(prediction[name], law.outcome.unit)
    return pd.DataFrame(columns)


def _head(name: str, unit: str) -> str:
    return f"{name} [{unit}]" if unit else name


def _column(quantity: Quantity, unit: str) -> Array:
    return np.atleast_1d(np.asarray(quantity.m_as(unit), dtype=np.float64))


def profile_tables(prediction: Prediction, labels: Sequence[str]) -> dict[str, pd.DataFrame]:
    """Return depth and sliding distance over the strips of the contacts, as "profile_wheel" for a body "wheel"."""
    tables = {}
    for body in _worn_bodies(prediction):
        across, strips = _across(prediction, body)
        where = np.nonzero(strips)
        columns: dict[str, Any] = {"contact": [labels[int(row)] for row in where[0]]}
        columns["y [mm]"] = across["y"].to_numpy().reshape(strips.shape)[where]
        for name, values in across.data_vars.items():
            columns[f"{name} [{values.units}]"] = values.to_numpy().reshape(strips.shape)[where]
        tables[f"profile_{body}"] = pd.DataFrame(columns)
    return tables


def worn_figure(prediction: Prediction, labels: Sequence[str], law: str) -> FigureData | None:
    """Return a figure of the depth that each body loses across the patch, or None if the patch is not resolved."""
    panels = []
    for body in _worn_bodies(prediction):
        across, strips = _across(prediction, body)
        depth, y = (across[name].to_numpy().reshape(strips.shape) for name in ("depth", "y"))
        curves = tuple(
            Curve(label, y[row][strips[row]], depth[row][strips[row]], row % 6, row // 6)
            for row, label in enumerate(labels)
        )
        values = across["depth"]
        unit = symbol(Q(1.0, values.units).units, "~P")
        panels.append(Panel(PlotAxis("y [mm]"), PlotAxis(f"{values.long_name} [{unit}]"), curves, body))
    if not panels:
        return None
    return FigureData("wear", f"Wear across the patch by {law}", tuple(panels))


def _worn_bodies(prediction: Prediction) -> list[str]:
    """Return the bodies with a wear law on a contact that is resolved across its patch."""
    if prediction.problem.geometry == "line" or prediction.scale == "patch":
        return []
    of = [law.body for law in prediction.laws if law.outcome.name == WEAR]
    return [body for body in prediction.problem.bodies if body in of or None in of]


def _across(prediction: Prediction, body: str) -> tuple[Any, Any]:
    """Return the profile of a body, and which of its strips touch, (contacts, strips)."""
    across = prediction.wear_profile(body)
    touching = prediction.contact.area.sum(axis=-2) > 0.0
    return across, np.atleast_2d(touching)
