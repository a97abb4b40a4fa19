"""Pictures of a prediction: curves, a map or bars over its operating points, and the fields of a single patch.

The panels are those of all figures; pandas draws bars.
"""

from __future__ import annotations

import math
import textwrap
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import matplotlib as mpl
import numpy as np
from matplotlib import pyplot

from wearlaw.arrays import Array
from wearlaw.contact.problem import Problem
from wearlaw.errors import InputError, did_you_mean, shown
from wearlaw.models.law import named_outcomes
from wearlaw.pipeline.prediction import Prediction
from wearlaw.pipeline.solution import Solution
from wearlaw.pipeline.variables import OUTSIDE_RANGE, default_variables
from wearlaw.units.variables import name_of
from wearlaw_apps.output.conditions import Conditions
from wearlaw_apps.output.curves import OUTSIDE, Curve, FigureData, Map, Panel, PlotAxis, fit_for_log
from wearlaw_apps.output.datasets import data_of, dataset, fields, labelled
from wearlaw_apps.output.drawing import draw_into
from wearlaw_apps.output.labels import in_words, label, readable
from wearlaw_apps.output.style import STYLE

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes

MOST_CURVES = 8
"""Most curves of a prediction over two conditions; with more it is a map."""

TITLE = 60
"""Characters on a line of the title."""

ALONG = ("pressure", "traction", "traction_bound")
"""Fields along the patch of a line that are shown if none is named."""

FIELDS = ("traction", "pressure", "slip")
"""Fields of a patch that is not a line; the first is shown if none is named."""

PIXELS = (401, 301)
"""Points along and across a patch that is not a line."""


def draw(prediction: Prediction, solution: Solution, name: str | None, x: str | None, ax: Axes | None) -> Axes:
    """Draw a prediction; see `Prediction.plot`."""
    conditions, problem = Conditions.of(solution), prediction.problem
    points = problem.batch_shape[: len(problem.batch_shape) - len(problem.dims)]
    single = math.prod(points) == 1 and x is None
    shown_here: tuple[str, ...] = ()
    with mpl.rc_context(STYLE if ax is None else {}):
        if single and math.prod(problem.batch_shape) > 1:
            axes = _bars(prediction, conditions, name, ax)
        else:
            panel, shown_here = (
                (of_patch(prediction, name), ()) if single else _over_points(prediction, conditions, name, x)
            )
            axes = pyplot.subplots()[1] if ax is None else ax
            draw_into([axes], FigureData("", "", (panel,)))
        lines = textwrap.wrap(conditions.text(without=shown_here), TITLE)
        axes.set_title("\n".join(lines), fontsize="small", loc="left")
    return axes


def _over_points(
    prediction: Prediction, conditions: Conditions, name: str | None, x: str | None
) -> tuple[Panel, tuple[str, ...]]:
    """Return a panel of a variable over the operating points, and the conditions that it shows.

    It is a map over two axes of many values, otherwise curves.
    """
    problem = prediction.problem
    data, variable = _found(prediction, conditions, name, x)
    dims = [str(dim) for dim in data[variable].dims if dim not in problem.dims]
    if len(dims) > 2:
        raise InputError(
            f"plot: there are {len(dims)} axes of operating points, and a picture shows two; choose some of the points,"
            " as in r.isel(point_0=0).plot()"
        )
    for dim in dims:  # conditions that vary together give an axis of positions
        if dim not in data.coords:
            data = data.assign_coords({dim: (dim, range(data.sizes[dim]), {"long_name": "operating point"})})
    along = x if x in dims else max(dims, key=lambda dim: data.sizes[dim])
    others = [dim for dim in dims if dim != along]
    if x is None and others and data.sizes[others[0]] > MOST_CURVES:
        return _map(data, variable, along, others[0], problem), tuple(dims)
    together = [name for name in conditions.numbers if name in data and data[name].dims == (along,)]
    across = x or (along if along in together or not together else together[0])
    curves = _curves(data, variable, across, others, problem)
    return Panel(_axis(data[across]), _axis(data[variable]), curves), (across, *others)


def _found(
    prediction: Prediction, conditions: Conditions, name: str | None, x: str | None = None
) -> tuple[xarray.Dataset, str]:
    """Return the variables to draw, without axes of a single operating point, and the name of the one to draw."""
    outcomes = named_outcomes(prediction.laws)
    variable = name or next(iter(outcomes), "tangential_force")
    names = [variable]
    if x is not None and x not in conditions.numbers:
        names.append(x)
    if variable in outcomes:
        names.append(OUTSIDE_RANGE)
    data = dataset(prediction, conditions, names)
    points = [dim for dim in data[variable].dims if dim not in prediction.problem.dims]
    return data.squeeze([dim for dim in points if data.sizes[dim] == 1]), variable


def _curves(
    data: xarray.Dataset, variable: str, across: str, others: Sequence[str], problem: Problem
) -> tuple[Curve, ...]:
    """Return a curve for each value of the other axes and for each patch."""
    apart = [*others, *(dim for dim in problem.dims if dim in data.dims)]
    curves: list[Curve] = []
    for index in np.ndindex(*(data.sizes[dim] for dim in apart)):
        place = dict(zip(apart, index, strict=True))
        here = data.isel(place)
        x, y = (np.atleast_1d(here[name].values) for name in (across, variable))
        there = np.isfinite(x) & np.isfinite(y)
        outside = np.atleast_1d(here[OUTSIDE_RANGE].values > 0.0)[there] if OUTSIDE_RANGE in here else None
        if there.any():
            number = len(curves)
            curves.append(Curve(_series(data, place, problem), x[there], y[there], number, number, outside=outside))
    if not curves:
        raise InputError(f"plot: {variable} has no value at these operating points")
    return tuple(curves)


def _map(data: xarray.Dataset, variable: str, along: str, up: str, problem: Problem) -> Panel:
    """Return a map over two axes; a border shows what lies outside the range of the law."""
    values = data[variable]
    if values.ndim > 2:
        patches = " and ".join(f"{dim} {labels}" for dim, labels in problem.dims.items())
        raise InputError(f"plot: a map shows one patch; choose one of {patches}, as in r.sel(...).plot()")
    outside = {OUTSIDE: data[OUTSIDE_RANGE].transpose(up, along).values > 0.0} if OUTSIDE_RANGE in data else {}
    x, y, shown_here = data[along].values, data[up].values, values.transpose(up, along).values
    drawn = Map(_label(values), x, y, shown_here, "log" if fit_for_log(shown_here) else "linear", outside)
    return Panel(_axis(data[along]), _axis(data[up]), (), map=drawn)


def _bars(prediction: Prediction, conditions: Conditions, name: str | None, ax: Axes | None) -> Axes:
    """Draw a variable of each existing patch at one operating point."""
    data, variable = _found(prediction, conditions, name)
    dims = [str(dim) for dim in data[variable].dims]
    table = data.to_dataframe(dim_order=dims).dropna(subset=variable)
    labels = [row if isinstance(row, tuple) else (row,) for row in table.index.tolist()]
    names = [in_words(dict(zip(dims, row, strict=True))) for row in labels]
    drawn: Axes = table[[variable]].set_axis(names).plot.bar(legend=False, rot=0, ax=ax)
    marks = table[OUTSIDE_RANGE].tolist() if OUTSIDE_RANGE in table else []
    outside = [place for place, mark in enumerate(marks) if mark > 0.0]
    for place in outside:
        drawn.patches[place].set(hatch="///", label=OUTSIDE if place == outside[0] else "_")
    if outside:
        drawn.legend(handles=[drawn.patches[outside[0]]])
    drawn.set(xlabel="", ylabel=_label(data[variable]))
    drawn.axhline(0.0, color="black", linewidth=0.8)
    return drawn


def of_patch(prediction: Prediction, name: str | None, pixels: tuple[int, int] = PIXELS) -> Panel:
    """Return a panel of a field of the only patch, or of its stresses: along a line, otherwise a map."""
    if prediction.scale == "patch":
        raise InputError(
            "plot: there is one operating point, and the contact model gives means of its patch; give a condition"
            ' several values, such as creepage=Q([0.5, 1, 2], "%"), or take a contact model that resolves the patch,'
            ' such as wl.contact_model("exact") for discs and wl.contact_model("strip_theory") for wheels'
        )
    line = prediction.problem.geometry == "line"
    data = fields_of(prediction)
    every = [str(variable) for variable in data.data_vars]
    if name is not None and name not in every:
        raise InputError(
            f"plot: there is one operating point, and {shown(name)} is no field of its patch"
            f"{did_you_mean(name, [*every, *default_variables(prediction)])} The fields are: {', '.join(every)}"
        )
    if not line:
        variable = name or FIELDS[0]
        drawn = Map(_label(data[variable]), *raster(prediction, data[variable].values, *pixels))
        return Panel(_axis(data["x"]), _axis(data["y"]), (), equal=True, map=drawn)
    names = list(ALONG) if name is None else [name]
    words = [name_of(variable) if name is None else "" for variable in names]
    curves = (Curve(word, data["x"].values, data[variable].values, number, number)
              for number, (word, variable) in enumerate(zip(words, names, strict=True)))  # fmt: skip
    up = _axis(data[name]) if name else PlotAxis(label("pressure", "traction"))
    return Panel(_axis(data["x"]), up, tuple(curves))


def fields_of(prediction: Prediction) -> xarray.Dataset:
    """Return the fields of a single patch and the local outcomes: along a line, otherwise over the nodes of its strips.

    The contact model must resolve the patch.
    """
    if prediction.problem.geometry == "line":
        return prediction.profile
    contact = prediction.contact
    columns, shape = fields(contact, prediction.laws, ("x", "y", *FIELDS)), contact.pressure.shape
    shaped = {
        name: (np.broadcast_to(values, shape).reshape(shape[-2:]), unit) for name, (values, unit) in columns.items()
    }
    data = data_of(("node", "strip"), shaped)
    return labelled(prediction.problem.replaced(dims={}), {name: data.pop(name) for name in ("x", "y")}, data)


def raster(prediction: Prediction, field: Array, columns: int = 81, rows: int = 51) -> tuple[Array, Array, Array]:
    """Return x and y of a grid over a patch [mm], and a field at its points, between its nodes; NaN outside.

    The edge is that of an ellipse, or else a smooth one through the ends of the strips.
    """
    nodes, length, strips, width, middles = _strips(prediction)
    field = field[:, prediction.contact.strip_width.reshape(-1) > 0.0]
    low, high = _ends(strips, width)
    y = low.min() + np.ptp([low, high]) * (np.arange(rows) + 0.5) / rows
    edge, order = _edge(prediction, y), np.argsort(strips)
    middle = np.interp(y, strips[order], middles[order])
    begin, end = (middle - edge).min(), (middle + edge).max()
    x = 0.5 * (begin + end) + 0.5 * (end - begin) * (2.0 * np.arange(columns) + 1.0 - columns) / columns
    from_middle, tiny = x - middle[:, None], np.finfo(float).tiny
    share = from_middle / np.maximum(edge, tiny)[:, None]  # along each row, -1 to 1 within the patch
    in_strips = []
    for strip in order:
        along, half = np.argsort(nodes[:, strip]), max(0.5 * length[:, strip].sum(), tiny)
        in_strips.append(np.interp(share, nodes[along, strip] / half, field[along, strip]))
    place = np.interp(y, strips[order], np.arange(strips.size))
    below = np.minimum(place.astype(int), max(strips.size - 2, 0))
    stacked, weight, row = np.stack(in_strips), (place - below)[:, None], np.arange(rows)
    above = np.minimum(below + 1, strips.size - 1)
    between = (1.0 - weight) * stacked[below, row] + weight * stacked[above, row]
    return 1e3 * x, 1e3 * y, np.where(np.abs(from_middle) <= edge[:, None], between, np.nan)


def _strips(prediction: Prediction) -> tuple[Array, Array, Array, Array, Array]:
    """Return x of nodes from the middle of their strip, their lengths, and y, widths and x of the strips [m]."""
    contact, strips = prediction.contact, prediction.problem.strips
    shape = contact.pressure.shape[-2:]
    width = contact.strip_width.reshape(shape[1])
    middle = np.zeros(shape[1]) if strips is None else strips.x.reshape(shape[1])
    y = np.broadcast_to(contact.y, contact.pressure.shape).reshape(shape)[0]
    wide = width > 0.0  # others fill up a batch
    x, area = (values.reshape(shape)[:, wide] for values in (contact.x, contact.area))
    return x - middle[wide], area / width[wide], y[wide], width[wide], middle[wide]


def _edge(prediction: Prediction, y: Array) -> Array:
    """Return half the length of a patch at positions across it [m]."""
    problem = prediction.problem
    if problem.geometry == "ellipse":
        squared = problem.a**2 * np.maximum(1.0 - (y / problem.b) ** 2, 0.0)
    else:
        _, length, strips, width, _ = _strips(prediction)
        low, high = _ends(strips, width)
        order = np.argsort(low)
        places = np.concatenate([[low.min()], 0.5 * (low + high)[order], [high.max()]])
        squared = np.interp(y, places, np.concatenate([[0.0], (0.5 * length.sum(axis=0)[order]) ** 2, [0.0]]))
    half_length: Array = np.sqrt(squared)
    return half_length


def _ends(strips: Array, width: Array) -> tuple[Array, Array]:
    """Return the ends of strips that lie side by side, each about its middle."""
    order = np.argsort(strips)
    sizes = width[order]
    ends = np.cumsum(sizes)
    ends += ((strips[order] - (ends - 0.5 * sizes)) * sizes).sum() / ends[-1]
    after = ends[np.argsort(order)]
    return after - width, after


def _series(data: xarray.Dataset, place: Mapping[str, int], problem: Problem) -> str:
    """Return the name of a curve: the value of each other condition, and the patch."""
    of_points = [_value(data[dim].isel({dim: at})) for dim, at in place.items() if dim not in problem.dims]
    patch = in_words({dim: data[dim].values[at] for dim, at in place.items() if dim in problem.dims})
    return ", ".join([*of_points, *([patch] if patch else [])])


def _value(condition: xarray.DataArray) -> str:
    """Return the name and the value of a condition."""
    return f"{name_of(str(condition.name))} {condition.item():.4g} {_unit(condition)}".rstrip()


def _axis(variable: xarray.DataArray) -> PlotAxis:
    return PlotAxis(_label(variable))


def _label(variable: xarray.DataArray) -> str:
    """Return the label of an axis."""
    return f"{variable.attrs.get('long_name', name_of(str(variable.name)))} [{_unit(variable) or '-'}]"


def _unit(variable: xarray.DataArray) -> str:
    return readable(variable.attrs.get("units", ""))
