"""The section of a report about the life of a wheel: its profiles, its measures, and which states wear where."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np
import pandas as pd

import wearlaw as wl
from wearlaw_apps.life.life import short
from wearlaw_apps.life.over_distance import wear_out
from wearlaw_apps.life.steps import CONICITY
from wearlaw_apps.output.notes import caught_warnings
from wearlaw_apps.output.styled import plain_number

LINE = "line"
"""The sweep whose states make up the line."""

OVER = wl.Q(10_000, "km")
"""The distance of the example."""

STATES = 7
"""Most states in the figure of what wears where."""


def section(study: wl.Study) -> wl.Section:
    """Return the section about the life of a wheel, on the states of the sweep "line", with equal shares.

    Lateral displacements of a wheelset above zero are the amplitudes of its free motion.

    Raises
    ------
    InputError
        If the case has no such sweep, or it varies more than one condition.
    """
    conditions = study.conditions(sweep=LINE)
    varying = [name for name, value in conditions.items() if np.ndim(getattr(value, "magnitude", value))]
    if len(varying) != 1:
        raise wl.InputError(f"the section 'life' takes a sweep {LINE!r} of one condition, got {len(varying)}")
    (name,) = varying
    values = conditions.pop(name)
    unit = f"{values.units:~C}"
    states = pd.DataFrame({f"{name} [{unit}]": values.magnitude, "share": 1.0 / values.size})
    waves = values[values.magnitude > 0.0]
    free = name == "lateral_displacement" and waves.size and isinstance(study.pairs[0].pipeline.rig, wl.Wheelset)
    motion: dict[str, Any] = {
        "amplitudes": waves,
        "shares": np.full(waves.size, 1.0 / max(waves.size, 1)),
        "phases": 4,
        "vertical_load": conditions.get("vertical_load"),
    }
    line = partial(wl.free_motion, **motion) if free else states
    held = f"the {waves.size} amplitudes of Klingel's motion" if free else f"the {values.size} states"
    predict = study.pairs[0].pipeline
    with caught_warnings():  # the sweep of the study has said them
        life = wear_out(predict, line, over=OVER, **conditions)
        figures = (life.figure(), _states(predict, name, values, conditions))
    head, *rows = repr(life).splitlines()
    rates = f"{life.rates['depth']:.3g} mm at its deepest place and {-life.rates['diameter']:.3g} mm of its diameter"
    return wl.Section(
        title="The life of a wheel",
        text=f"An example and no prediction of service: {short(OVER.m_as('km'))} km with equal shares of {held} in the"
        f" sweep '{LINE}'. Real lines have curves, in which flanges wear. In 1000 km it loses {rates}. Compare them"
        " with rates of your own service: no published ones with their line could be read, so that none stand here.",
        tables={"life": life.table.rename(columns={CONICITY: f"{CONICITY} [-]"})},
        figures=figures,
        summary=f"{head}: {'; '.join(' '.join(row.split()) for row in rows)}.",
    )


def _states(predict: wl.Pipeline[...], name: str, values: wl.Quantity, conditions: dict[str, object]) -> wl.FigureData:
    """Return the depth that single states wear across the new profile."""
    chosen = np.unique(np.linspace(0, values.size - 1, min(values.size, STATES)).round().astype(int))
    s = predict.rig.wheel.curve.s  # type: ignore[attr-defined]
    at = wl.Q(np.arange(1e3 * s[0], 1e3 * s[-1], 0.25), "mm")
    prediction = predict(**{name: values[chosen]}, **conditions)
    depth = prediction.wear_profile("wheel", at=at)["depth"]
    panels = []
    for side in depth["side"].values:
        curves = tuple(
            wl.Curve(f"{plain_number(value)} {values.units:~P}", at.magnitude, depth.sel(side=side)[row].values, row)
            for row, value in enumerate(values.magnitude[chosen])
        )
        x, y = wl.PlotAxis("position along the profile [mm]"), wl.PlotAxis("depth [µm/km]")
        panels.append(wl.Panel(x, y, curves, f"{side} wheel"))
    title = f"Which {name.replace('_', ' ')} wears where"
    return wl.FigureData("states", title, tuple(panels), "On the new profile, by single states, without smoothing.")
