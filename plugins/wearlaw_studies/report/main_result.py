"""The main result of a study: outcomes of the first sweep, with the figure and the table that a report begins with."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pandas as pd
import xarray
from numpy.typing import NDArray

from wearlaw.arrays.array import Array
from wearlaw.models.contact_model import Blame
from wearlaw.models.law import WEAR, Law
from wearlaw.pipeline.variables import MASS
from wearlaw.units.quantities import Q, from_si
from wearlaw.units.variables import UNITS, name_of, readable
from wearlaw_output.curves import FigureData
from wearlaw_studies.figure_spec import FigureSpec, Scale
from wearlaw_studies.figures import axes_of_map, figures_of
from wearlaw_studies.grid import Axis
from wearlaw_studies.results import (
    LIMITS,
    SHAKEDOWN,
    axes_of,
    beyond_limits,
    main_axis,
    outcomes_of,
    patch_axes,
    predicting,
)
from wearlaw_studies.study import Study

MANY_CURVES = 6
"""Number of curves beyond which the figure shows the pairs of one contact model only."""

MANY_MAPS = 2
"""Number of maps that the first screen has room for."""

WIDE = 30.0
"""Ratio of the largest outcome to the smallest beyond which the figure has a logarithmic axis."""


@dataclass(frozen=True)
class MainResult:
    """The outcome of the first sweep, with all patches of a point together.

    Attributes
    ----------
    study : Study
    name : str
        Name of the sweep.
    sweep : xarray.Dataset
        The sweep; that of `together` if the rig makes several patches.
    axis : str
        The axis along which tables and figures run.
    outcome : str
        The wear rate, the mass lost at all patches, or the outcome of the first law.
    pairs : tuple of str
        The pairs that predict it.
    """

    study: Study
    name: str
    sweep: xarray.Dataset
    axis: str
    outcome: str
    pairs: tuple[str, ...]


def main_result(study: Study) -> MainResult:
    """Return the main result of a study."""
    name, sweep = next(iter(study.sweeps.items()))
    outcome = outcomes_of(study, sweep)[0].name
    if patch_axes(sweep):
        outcome = MASS if outcome == WEAR else outcome
        sweep = together(sweep, outcome)
    axis = main_axis(sweep, study.case.rig.creepage)
    return MainResult(study, name, sweep, axis, outcome, tuple(predicting(study, outcome, sweep.pair.values.tolist())))


def together(sweep: xarray.Dataset, outcome: str) -> xarray.Dataset:
    """Return a sweep of several patches with one value at each point.

    The mass lost is the sum over the patches, and any other outcome the largest of them. A point is outside a range or
    beyond a limit if one of its patches is: its maximum pressure is the largest one, and its limits are scaled to it.
    """
    axes = patch_axes(sweep)
    value = sweep[outcome].sum(axes, min_count=1) if outcome == MASS else sweep[outcome].max(axes)
    found = {outcome: value, "outside_range": sweep.outside_range.max(axes)}
    if all(name in sweep for name in ("max_pressure", *LIMITS)):
        found["max_pressure"] = largest = sweep.max_pressure.max(axes)
        found |= {limit: largest * (sweep[limit] / sweep.max_pressure).min(axes) for limit in LIMITS}
    return sweep.drop_dims(axes).assign({name: one.assign_attrs(sweep[name].attrs) for name, one in found.items()})


def main_figure(main: MainResult) -> FigureData:
    """Return the figure of the main result: one of the study if it shows the same curves, otherwise a new one."""
    wanted = _drawn(main)
    return next((one for one in main.study.figures if _contents(one) == _contents(wanted)), wanted)


def main_caption(main: MainResult) -> str:
    """Return the caption of the main table, which names the axes of the places in it."""
    axes = " and ".join(map(name_of, axes_of(main.sweep)))
    return f"Least and most over the sweep '{main.name}'{f', with the {axes} there' if axes else ''}"


def main_table(main: MainResult) -> pd.DataFrame:
    """Return the least and the most of the outcome of each pair, the borders of its law, and what lies outside."""
    what = f"[{readable(main.sweep[main.outcome].attrs['units'])}]"
    limits, axes = beyond_limits(main.sweep), axes_of(main.sweep)
    rows = []
    for pair in main.pairs:
        of_pair = main.sweep.sel(pair=pair)
        values, model = of_pair[main.outcome], main.study.pair(pair).contact_model
        (law,) = main.study.pair(pair).pipeline.laws
        row: dict[str, Any] = {"pair": pair}
        for word, find in (("least", values.argmin), ("most", values.argmax)):
            found = find(...) if bool(values.notnull().any()) else None
            row[f"{word} {what}"] = None if found is None else values.isel(found).item()
            if axes:
                row[f"{word} at"] = "" if found is None else _at(main, {axis: int(found[axis]) for axis in axes})
        row["regimes change at"] = _borders(law)
        row["outside the range"] = _count(of_pair.outside_range.values > 0.0) if law.valid_range else "not known"
        beyond = limits[SHAKEDOWN].sel(contact_model=model).values if limits else None
        row[LIMITS[SHAKEDOWN]] = "not known" if beyond is None else _count(beyond)
        rows.append(row)
    return pd.DataFrame(rows)


def _at(main: MainResult, point: dict[str, int]) -> str:
    """Return the place of an operating point, such as "1 %", in the units of the case."""
    written, shown = main.study.case.sweeps[main.name].written_units(), []
    for axis, place in point.items():
        unit = written.get(axis, "")
        value = Q(main.sweep[axis].values[place], main.sweep[axis].attrs["units"]).m_as(unit)
        shown.append(f"{value:.4g} {readable(unit)}".rstrip())
    return ", ".join(shown)


def _borders(law: Law) -> str:
    """Return the borders of the regimes of a law in words; a variable that only the law knows is in SI units."""
    with Blame(law):
        borders = law.breakpoints(law.numbers)
    if borders is None:
        return "not known"
    shown = []
    for name, values in borders.items():
        unit = UNITS.get(name, "")
        numbers = ", ".join(f"{from_si(value, unit).magnitude:.4g}" if unit else f"{value:.4g}" for value in values)
        shown.append(f"{name_of(name)} {numbers} {readable(unit)}".rstrip())
    return "; ".join(shown) or "none"


def _count(mask: NDArray[np.bool_]) -> str:
    """Return in how many points of a sweep something is so."""
    if mask.all() or not mask.any():
        return "everywhere" if mask.all() else "nowhere"
    return f"{mask.sum()} of {mask.size}"


def _contents(figure: FigureData) -> list[Any]:
    """Return the labels of what a figure shows."""
    return [
        (
            panel.x.label,
            panel.y.label,
            {curve.label for curve in panel.curves},
            panel.map and (panel.map.label, panel.title),
        )
        for panel in figure.panels
    ]


def _drawn(main: MainResult) -> FigureData:
    """Return the figure of the outcome: a map over two long axes, otherwise curves along the main axis."""
    study, pairs, more = main.study, main.pairs, ""
    plane = axes_of_map(main.sweep, study.case.rig.creepage)
    if len(pairs) > (MANY_CURVES if plane is None else MANY_MAPS):
        first = study.pair(pairs[0]).contact_model
        pairs = tuple(pair for pair in pairs if study.pair(pair).contact_model == first)
        more = f" Only the pairs with {first} are shown; the tables hold all."
    if plane is not None:
        if len(pairs) > MANY_MAPS:
            pairs = pairs[:MANY_MAPS]
            more = f" Only {' and '.join(pairs)} are shown; the results hold all."
        x, y = plane
        name = f"{main.outcome}_over_{x}_and_{y}"
        return _figure(main, name, FigureSpec(sweep=main.name, x=x, y=(y,), map=main.outcome, pairs=pairs), more)
    given = study.case.sweeps[main.name].given.get(main.axis)
    spec = FigureSpec(
        sweep=main.name,
        x=main.axis,
        y=(main.outcome,),
        x_scale="log" if isinstance(given, Axis) and given.spacing == "log" else "linear",
        y_scale=_scale(main.sweep[main.outcome].sel(pair=list(pairs)).values),
        pairs=pairs,
    )
    name = f"{main.outcome}_over_{main.axis}" if axes_of(main.sweep) else main.outcome
    return _figure(main, name, spec, more)


def _figure(main: MainResult, name: str, spec: FigureSpec, more: str) -> FigureData:
    """Return a figure of the main result under a name that no figure of the case has."""
    study, name = main.study, f"main_{name}"
    while name in study.case.figures:
        name = f"main_{name}"
    case = study.case.model_copy(update={"figures": {name: spec}})
    (figure,) = figures_of(replace(study, case=case, sweeps={main.name: main.sweep}))
    if patch_axes(study.sweeps[main.name]):
        more += f" {'The sum over' if main.outcome == MASS else 'The largest of'} all patches."
    return replace(figure, caption=figure.caption + more)


def _scale(values: Array) -> Scale:
    """Return a logarithmic scale for values of one sign that differ by more than `WIDE`."""
    known = values[np.isfinite(values)]
    positive = known[known > 0.0]
    wide = positive.size and not (known < 0.0).any() and positive.max() > WIDE * positive.min()
    return "log" if wide else "linear"
