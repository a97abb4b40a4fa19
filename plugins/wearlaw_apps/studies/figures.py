"""The figures of a study: a main one of its first sweep, then those of its case, or else the usual ones.

Line styles stand for contact models. Colours stand for laws in figures of their outcomes, for variables where a panel
shows several, and otherwise for contact models too. If the rig makes several patches, colours stand for patches, and
values keep their signs. Bands show the published range of a law's parameters. Parts of curves outside the range of
their law are dashed, and a strip along the x axis shows where the contact is beyond shakedown.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
import xarray

from wearlaw.errors import ConfigurationError, Fault, UnitError, did_you_mean, shown
from wearlaw.models.law import WEAR
from wearlaw.pipeline.variables import MASS
from wearlaw.units.quantities import Q, Unit, from_si
from wearlaw.units.variables import UNITS, name_of
from wearlaw_apps.output.curves import (
    BLACK,
    OUTSIDE,
    Curve,
    FigureData,
    Limit,
    Map,
    Panel,
    PlotAxis,
    Shade,
    fit_for_log,
)
from wearlaw_apps.output.labels import in_words, label, readable
from wearlaw_apps.studies.figure_spec import ACROSS, COMMON, OF_PROFILE, FigureSpec, Range, Scale, Window
from wearlaw_apps.studies.measured import known_variables, measured_points
from wearlaw_apps.studies.results import (
    LIMITS,
    SHAKEDOWN,
    Results,
    along,
    axes_of,
    beyond_limits,
    borders_of,
    labelled_by,
    main_axis,
    outcomes_of,
    patch_axes,
    patches_of,
    possible_patches,
    predicting,
    together,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray


MOST_MAPS = 6
"""Most panels of a map."""

MOST_CURVES, MOST_MAIN_MAPS = 6, 2
"""Most curves and maps of the main figure; with more pairs it shows those of the first contact model."""

MOST_POINTS, MOST_VALUES = 4000, 300
"""Most points of a curve, and values of each axis of a map; more are finer than a screen."""

LEAST = 4
"""Fewest values of each axis of a map that is made without being asked for."""

ALONG = (("pressure", "traction", "traction_bound"), ("slip",))
"""The panels of the usual figure along the patch of a line."""

NOT_SHOWN = ("outside_range", *LIMITS)
"""Variables of results that mark others in figures."""

Spans: TypeAlias = list[tuple[float, float]]


def figures_of(results: Results) -> tuple[FigureData, ...]:
    """Return the figures of a study, the main one first unless the case names it."""
    main = None if results.case.main else _main_figure(results)
    asked = results.case.figures or dict(_usual(results))
    every = tuple(_figure(results, name, spec) for name, spec in asked.items())
    if main is None:
        return every
    first = next((figure for figure in every if _same(figure, main)), main)  # with the title of the case
    return (first, *(figure for figure in every if figure is not first))


def _same(figure: FigureData, other: FigureData) -> bool:
    """Return whether two figures show the same, whatever their names, titles and captions."""

    def shown(panel: Panel) -> Any:
        return panel.x, panel.y, panel.map and panel.map.label, [(curve.label, curve.y.size) for curve in panel.curves]

    return list(map(shown, figure.panels)) == list(map(shown, other.panels))


def wrong_figures(results: Results) -> Iterator[Fault]:
    """Yield what keeps the figures of a case from being drawn; results at a few operating points show it."""
    for name, spec in results.case.figures.items():
        try:
            _figure(results, name, spec)
        except ConfigurationError as error:
            yield from (Fault(("figures", name, *fault.path), fault.message) for fault in error.problems)


def _main_figure(results: Results) -> FigureData | None:
    """Return the outcome over the first sweep, of all patches together; None if the sweep is one operating point."""
    name, sweep = next(iter(results.sweeps.items()))
    if not axes_of(sweep):
        return None
    whole, (results, outcome) = sweep, main_result(results)
    sweep, creepage = results.sweeps[name], results.case.rig.creepage
    plane, pairs = _plane(sweep, creepage), predicting(results, outcome, sweep.pair.values.tolist())
    spec, more = _over(results, name, outcome, main_axis(sweep, creepage), plane), ""
    if len(pairs) > (MOST_MAIN_MAPS if plane else MOST_CURVES):
        first = results.pair(pairs[0]).contact_model
        pairs = [pair for pair in pairs if results.pair(pair).contact_model == first]
        pairs = pairs[:MOST_MAIN_MAPS] if plane else pairs
        more = f" Only {' and '.join(pairs) if plane else f'the pairs with {first}'} are shown; the results hold all."
    file = "main" if "main" not in results.case.figures else "main_result"
    figure = _figure(results, file, spec.model_copy(update={"pairs": tuple(pairs)}))
    if patch_axes(whole):
        more += f" {'The sum over' if outcome == MASS else 'The largest of'} all patches."
    return replace(figure, caption=figure.caption + more)


def main_result(results: Results) -> tuple[Results, str]:
    """Return the first sweep, with all patches of a point together, and its main outcome.

    It is the wear rate, the mass lost at all patches, or the outcome of the first law.
    """
    name, sweep = next(iter(results.sweeps.items()))
    outcome = outcomes_of(results, sweep)[0].name
    if patch_axes(sweep):
        outcome = MASS if outcome == WEAR else outcome
        sweep = together(sweep, outcome)
    return Results(results.case, results.pairs, {name: sweep}, {}), outcome


def _usual(results: Results) -> Iterator[tuple[str, FigureSpec]]:
    """Yield the default figures: outcomes and traction over each sweep, and the fields or wear of each profile."""
    creepage = results.case.rig.creepage
    for name, sweep in results.sweeps.items():
        if not axes_of(sweep):
            continue
        axis = main_axis(sweep, creepage)
        for outcome in outcomes_of(results, sweep):
            plane = _plane(sweep, creepage)
            specs = [_over(results, name, outcome.name, axis, plane)] if plane else []
            across = (axis,) if patch_axes(sweep) else ("wear_index", axis)  # each patch has an index of its own
            specs += [_over(results, name, outcome.name, x) for x in across]
            for spec in specs:
                up = f"_and_{spec.shown[0]}" if spec.map else ""
                yield f"{name}_{outcome.name}_over_{spec.x}{up}", spec
        if axis == creepage:
            spec = _over(results, name, "traction_coefficient", axis)
            yield f"{name}_traction_over_{axis}", spec.model_copy(update={"y_scale": "linear"})
    for name, profile in results.profiles.items():
        if "y" in profile:
            bodies = [body for body in results.case.rig.bodies if f"{body}_depth" in profile]
            panels = tuple(Window(title=body, y=(y,), body=body) for y in ACROSS for body in bodies)
            yield f"{name}_across_the_patch", FigureSpec(profile=name, x="y", panels=panels)
        elif profile:
            yield f"{name}_along_the_patch", FigureSpec(profile=name, panels=tuple(Window(y=y) for y in ALONG))


def _over(results: Results, name: str, y: str, x: str, plane: tuple[str, str] | None = None) -> FigureSpec:
    """Return the figure of a variable over an axis, or the map over two, with scales that suit the values."""
    if plane:
        return FigureSpec(sweep=name, x=plane[0], y=(plane[1],), map=y)
    sweep, creepage, tests = results.sweeps[name], results.case.rig.creepage, results.case.measured
    axis, outcome = main_axis(sweep, creepage), results.case.outcomes.get(y)
    log = not (outcome and outcome.sign == "any") and fit_for_log(along(sweep, axis)[y].values)
    scale = results.case.sweeps[name].spacing(axis)
    measured = tests is not None and axis == creepage and {x, y} <= {*known_variables(tests.data)}
    return FigureSpec(sweep=name, x=x, y=(y,), x_scale=scale, y_scale="log" if log else "linear", measured=measured)


def _plane(sweep: xarray.Dataset, creepage: str | None) -> tuple[str, str] | None:
    """Return the axes of the map of a sweep: its main axis and the longest other one, None if these are too short."""
    first = main_axis(sweep, creepage)
    others = [axis for axis in axes_of(sweep) if axis != first]
    second = max(others, key=lambda axis: sweep.sizes[axis], default=None)
    return (first, second) if second and min(sweep.sizes[first], sweep.sizes[second]) >= LEAST else None


def _title(spec: FigureSpec, results: Results) -> str:
    """Return a title in words, such as "Wear rate over normal force"."""
    if spec.profile:
        across = "Wear across" if spec.x == "y" else "Stresses and slip along"
        return f"{across} the patch: {spec.profile.replace('_', ' ')}"
    variables = dict.fromkeys([spec.map] if spec.map else [y for window in spec.windows() for y in window.shown])
    words = f"{' and '.join(name_of(y or '') for y in variables)} over {name_of(spec.x)}"
    words += f" and {name_of(spec.shown[0])}" if spec.map else ""
    alike = [
        sweep for sweep in results.sweeps.values() if spec.x in sweep and sweep[spec.x].max() > sweep[spec.x].min()
    ]
    several = f" ({str(spec.sweep).replace('_', ' ')})" if len(alike) > 1 else ""
    return words[:1].upper() + words[1:] + several


def _figure(results: Results, name: str, spec: FigureSpec) -> FigureData:
    """Return a figure.

    Raises
    ------
    ConfigurationError
        If the figure cannot be drawn; problems name its fields.
    """
    asked, case = spec.sweep or spec.profile or "", results.case
    kind, of_kind, grids = (
        ("sweep", results.sweeps, case.sweeps) if spec.sweep else ("profile", results.profiles, case.profiles)
    )
    _choose(kind, [asked], [key for key, dataset in of_kind.items() if dataset])
    data, grid = of_kind[asked], grids[asked]
    units, free, more = case.result_units | grid.written_units(), {spec.x, *spec.shown}, ""
    if spec.map:
        panels, left_out = _maps(results, data, spec, units)
        if left_out:
            more = f" {left_out} more are left out; choose among them with pairs, contact_models or patches."
    else:
        if spec.profile and "y" not in data and not patch_axes(data):  # a level line
            level = 100.0 * float(np.ravel(grid.problem(case.rig, case.models).longitudinal_creepage)[0])
            data = data.assign(creepage=("x", np.full(data.sizes["x"], level)))
        if spec.sweep:
            axis = _axis_along(data, spec.x, case.rig.creepage)
            data, free = along(_beside(results, data, spec.x), axis), {axis}
            data = data.isel({axis: _thinned(data.sizes[axis], MOST_POINTS)})
        panels, wrong = [], []
        for number, window in enumerate(spec.windows()):
            try:
                panels.append(_panel(results, data, spec, window, units))
            except ConfigurationError as error:
                before = ("panels", str(number)) if spec.panels else ()
                wrong += [Fault((*before, *fault.path), fault.message) for fault in error.problems]
        if wrong:
            raise ConfigurationError(name, wrong)
    fixed = ", ".join(_conditions(grid, free, units))
    return FigureData(
        name=name,
        title=spec.title or _title(spec, results),
        panels=tuple(panels),
        caption=spec.caption or (f"At {fixed}.{more}" if fixed else more.strip()),
        conditions=": ".join(filter(None, (case.title, fixed))),
    )


def _choose(path: str, asked: Collection[Any], choices: Collection[Any], fault: str = "cannot be shown") -> None:
    """Raise an error unless all names are among the choices; it lists them."""
    names = [str(name) for name in choices]
    wrong = [str(name) for name in asked if name not in choices]
    if wrong:
        there = f"{did_you_mean(wrong[0], names)} There are: {', '.join(names) or 'none'}"
        raise ConfigurationError("figure", [Fault((path,), f"{shown(wrong[0])} {fault}{there}")])


def _conditions(grid: Any, free: Collection[str], units: Mapping[str, str]) -> Iterator[str]:
    """Yield the conditions of a figure in words, without those that vary in it; axes are at their middle value."""
    for name in grid.written:
        if name not in free:
            level = grid.level(name, units)
            value = level if isinstance(level, str) else f"{level:.5g} {readable(units[name])}"
            yield f"{name_of(name)} {value}".rstrip()


def _beside(results: Results, sweep: xarray.Dataset, x: str) -> xarray.Dataset:
    """Return a sweep in which an outcome on the x axis stands beside all pairs of its contact model."""
    pairs = predicting(results, x, sweep.pair.values.tolist())
    models = [results.pair(pair).contact_model for pair in pairs]
    if not pairs or len({*models}) < len(models):
        return sweep
    values = sweep[x].sel(pair=pairs).drop_vars([name for name in sweep[x].coords if str(name).startswith("pair")])
    return sweep.assign({x: values.rename(pair="contact_model").assign_coords(contact_model=models)})


def _axis_along(sweep: xarray.Dataset, x: str, creepage: str | None) -> str:
    """Return the axis of a sweep along which a figure over x runs: x, or the first one along which x varies."""
    main, axes = main_axis(sweep, creepage), axes_of(sweep)
    if x in axes or x not in sweep:
        return x if x in axes else main
    varies = (axis for axis in (main, *axes) if axis in sweep[x].dims and np.ptp(along(sweep, axis)[x].values) > 0.0)
    return next(varies, main)


# What is shown of each pair or contact model


@dataclass(frozen=True, eq=False)
class _Series:
    """The results of a pair or of a contact model for a variable, or of all models where they agree.

    Attributes
    ----------
    variable, of : str
        The variable, and the label of the pair or the contact model, "" for all models.
    data : Dataset
        The results there.
    style : (int, int)
        Colour and dash.
    """

    variable: str
    of: str
    data: xarray.Dataset
    style: tuple[int, int]

    def label(self, several: bool) -> str:
        """Return the label; it names the variable if there are several, or if nothing else tells it."""
        return ", ".join(filter(None, (name_of(self.variable) if several or not self.of else "", self.of)))

    @property
    def outside(self) -> NDArray[np.bool_] | None:
        """Where a pair is outside the range of its law."""
        outside = self.data.get("outside_range")
        return None if outside is None or "pair" in outside.dims else outside.values > 0.0

    def ends(self) -> dict[str, Any]:
        """Return the ends of the band of an outcome, if it has one."""
        low, high = (self.data.get(f"{self.variable}{end}") for end in ("_low", "_high"))
        if low is None or high is None or "pair" in low.dims or not bool((high > low).any()):
            return {}
        return {"low": low.values, "high": high.values}

    def beyond(self) -> dict[str, xarray.DataArray]:
        """Return where the contact is beyond each limit."""
        limits = beyond_limits(self.data).items()
        return {name: mask.any("contact_model") if "contact_model" in mask.dims else mask for name, mask in limits}


def _series(results: Results, data: xarray.Dataset, spec: FigureSpec, variable: str, x: str = "") -> list[_Series]:
    """Return what data hold of a variable: for each pair that predicts it, or for each contact model."""
    dims = {dim for name in (variable, x) if name in data for dim in data[name].dims}
    models, laws = (list(labels) for labels in (results.case.contact_models_by_label, results.case.laws_by_label))
    _choose("pairs", spec.pairs or (), data.pair.values.tolist())
    _choose("contact_models", spec.contact_models or (), data.contact_model.values.tolist())
    chosen = spec.contact_models or data.contact_model.values.tolist()
    if "pair" in dims:
        series, outcome = [], variable if variable in (*results.case.outcomes, MASS) else WEAR
        for pair in map(results.pair, predicting(results, outcome, spec.pairs or data.pair.values.tolist())):
            if pair.contact_model in chosen:
                style = laws.index(pair.law), models.index(pair.contact_model)
                here = data.sel(pair=pair.label, contact_model=pair.contact_model)
                series.append(_Series(variable, pair.label, here, style))
        if not series:
            raise ConfigurationError("figure", [Fault(("pairs",), f"none of the pairs predicts {variable}")])
        return series
    if "contact_model" in dims and variable not in COMMON:
        places = {model: models.index(model) for model in chosen}
        return [_Series(variable, model, data.sel(contact_model=model), (at, at)) for model, at in places.items()]
    common = data.sel(contact_model=chosen[0]) if variable in COMMON and "contact_model" in dims else data
    return [_Series(variable, "", common, (0, 0))]


# Panels of curves


def _panel(results: Results, data: xarray.Dataset, spec: FigureSpec, window: Window, units: Mapping[str, str]) -> Panel:
    """Return a panel of curves over a sweep or over a profile of the patch."""
    bodies = list(results.case.rig.bodies)
    _choose("body", [window.body] if window.body else [], bodies)
    head = f"{window.body or bodies[0]}_" if spec.profile and "y" in data else ""
    x, names = ("y" if head else spec.x), [f"{head}{y}" for y in window.shown]
    _check_names(data, spec, window, head)
    axes = patch_axes(data)
    _choose("patches", window.patches or (), axes, "is not an axis of the rig's patches")
    for axis, labels in (window.patches or {}).items():
        _choose("patches", labels, data[axis].values.tolist())
    if head:
        units = {**units} | {y: data[name].attrs["units"] for y, name in zip(window.shown, names, strict=True)}
    if len({units[y] for y in window.shown}) > 1:
        each = ", ".join(sorted({units[y] for y in window.shown}))
        fault = Fault(("y",), f"one axis has one unit, but these are in {each}; give each a panel of its own")
        raise ConfigurationError("figure", [fault])
    curves: list[Curve] = []
    limits: list[Limit] = []
    spans: Spans = []
    for patch in patches_of(data, window.patches):
        of_patch = []
        for number, name in enumerate(names):
            for series in _series(results, data.sel(patch), spec, name, x):
                colour, dash = series.style
                if "pair" not in data[name].dims:
                    along_patch = bool(spec.profile) and name in OF_PROFILE
                    colour = OF_PROFILE.index(name) if along_patch else number if len(names) > 1 else colour
                curve = _curve(results, series, spec, window, x, units)
                if not curve.x.size:  # a law for the other body
                    continue
                of_patch.append(replace(curve, colour=colour, dash=dash))
                spans += _beyond(series, curve, spec, window)
                if spec.regimes and "pair" in data[name].dims:
                    limits += _regimes(results, series, curve)
        if patch:
            number = possible_patches(data).index(patch)
            of_patch = [replace(curve, label=labelled_by(patch, curve.label), colour=number, dash=dash)
                        for dash, curve in enumerate(of_patch)]  # fmt: skip
        curves += of_patch
    curves += [_measured(results, x, y, units) for y in window.shown if spec.measured]
    # A logarithmic axis hides values that are not positive, as at zero creepage.
    log = window.x_scale == "log" and any((curve.x > 0.0).any() for curve in curves)
    x_axis = PlotAxis(label(x, units=units), "log" if log else "linear", _ends("x", x, units, window))
    low, high = x_axis.ends or (-np.inf, np.inf)
    seen = tuple(dict.fromkeys((start, end) for start, end in spans if start < high and end > low))
    shades = (Shade(LIMITS[SHAKEDOWN], seen, strip=True),) if seen else ()
    seen_limits = tuple(limit for limit in limits if low < limit.at < high)
    y_axis = _y_axis(x_axis, window, curves, units)
    return Panel(x_axis, y_axis, tuple(curves), window.title, shades, limits=seen_limits)


def _check_names(data: xarray.Dataset, spec: FigureSpec, window: Window, head: str) -> None:
    """Raise an error unless the variables of a panel are those of the results."""
    endings = ("_low", "_high", "_error", "_position")
    variables = [str(name) for name in data.data_vars if name not in NOT_SHOWN and not str(name).endswith(endings)]
    if head:
        variables = [name.removeprefix(head) for name in variables if name.startswith(head)]
    _choose("y", window.shown, variables)
    if spec.sweep:
        _choose("x", [spec.x], [*axes_of(data), *(name for name in variables if "pair" not in data[name].dims)])
    elif spec.x != ("y" if head else "x"):
        _choose("x", [spec.x], ["y" if head else "x"])


def _curve(
    results: Results, series: _Series, spec: FigureSpec, window: Window, x: str, units: Mapping[str, str]
) -> Curve:
    """Return the curve of a series, as magnitudes over the sweep of a single patch."""
    data, several = series.data, len(window.shown) > 1
    if spec.profile:
        there = data[series.variable].notnull().values
        at, values = data[x].values[there], data[series.variable].values[there]
        outside = series.outside
        if outside is not None:
            other = "y" in data and results.is_for_other_body(
                series.of, window.body or next(iter(results.case.rig.bodies))
            )
            outside = np.full(values.shape, bool(outside) or other)
        named = series.of if "y" in data else series.label(several or outside is None)
        curve = Curve(named, at, values, outside=outside)
        return _to_the_edges(curve) if "y" in data or series.variable in ALONG[0] else curve
    signed = bool(data.attrs.get("patch_axes")) or series.outside is not None
    at = data[x].values if data.attrs.get("patch_axes") else np.abs(data[x].values)
    at = Q(at, results.case.result_units[x]).m_as(units[x])
    values = data[series.variable].values if signed else np.abs(data[series.variable].values)
    bands = series.ends()
    return Curve(series.label(several), at, np.broadcast_to(values, at.shape), outside=series.outside, **bands)


def _to_the_edges(curve: Curve) -> Curve:
    """Return a curve over a patch with its ends, where it is zero; nodes are the middles of cells, half a cell off."""
    x = curve.x
    if x.size < 2:
        return curve
    x = np.concatenate([[1.5 * x[0] - 0.5 * x[1]], x, [1.5 * x[-1] - 0.5 * x[-2]]])
    outside = None if curve.outside is None else np.pad(curve.outside, 1, mode="edge")
    return replace(curve, x=x, y=np.pad(curve.y, 1), outside=outside)


def _beyond(series: _Series, curve: Curve, spec: FigureSpec, window: Window) -> Spans:
    """Return where the contact is beyond shakedown, as spans of x."""
    beyond = series.beyond().get(SHAKEDOWN)
    if beyond is None or not curve.x.size:
        return []
    there = np.broadcast_to(beyond.values, curve.x.shape) & np.isfinite(curve.x)
    if spec.profile:
        return [(float(curve.x.min()), float(curve.x.max()))] if there.all() else []
    order = np.argsort(curve.x, kind="stable")
    order = order[np.isfinite(curve.x[order]) & ((curve.x[order] > 0.0) | (window.x_scale != "log"))]
    x, there = curve.x[order], there[order]
    edges = np.concatenate([x[:1], 0.5 * (x[1:] + x[:-1]), x[-1:]])  # half-way to the next point
    steps = np.flatnonzero(np.diff(np.concatenate([[False], there, [False]]).astype(int)))
    return [(float(edges[first]), float(edges[after])) for first, after in zip(steps[::2], steps[1::2], strict=True)]


def _regimes(results: Results, series: _Series, curve: Curve) -> Iterator[Limit]:
    """Yield where the regimes of a law of patch means change along a curve."""
    pair = results.pair(series.of)
    if pair.pipeline.scale == "cells":
        return
    for name, (symbol, borders, unit) in borders_of(pair.pipeline.laws[0]).items():
        if name not in series.data:
            continue
        values = np.broadcast_to(series.data[name].values, curve.x.shape)
        for border in borders:
            below = values < border
            for at in np.flatnonzero(below[1:] != below[:-1]):
                share = (border - values[at]) / (values[at + 1] - values[at])
                x = float(curve.x[at] + share * np.diff(curve.x)[at])
                yield Limit(f"{pair.law}: {symbol} = {border:.4g} {unit}".rstrip(), x, "x")


def _measured(results: Results, x: str, y: str, units: Mapping[str, str]) -> Curve:
    """Return the measured points, as magnitudes like all curves over a sweep."""
    measured = results.case.measured
    _choose("measured", {x, y}, known_variables(measured.data) if measured else (), "is not known for the tests")
    assert measured is not None
    tests = measured.on(results.case.rig)
    values = measured_points(tests, results.case.rig)
    along_x, up = Q(abs(values[x]), UNITS[x]).m_as(units[x]), abs(values[y])
    there = np.isfinite(along_x) & np.isfinite(up)
    curve = Curve(measured.label, along_x[there], up[there], BLACK, points=True)
    uncertainty = tests.wear_rate_uncertainty if y == "wear_rate" else None
    if uncertainty is None:
        return curve
    spread = uncertainty.to(UNITS[y]).magnitude[there]
    return replace(curve, low=curve.y - spread, high=curve.y + spread)


# Maps


def _maps(
    results: Results, sweep: xarray.Dataset, spec: FigureSpec, units: Mapping[str, str]
) -> tuple[list[Panel], int]:
    """Return a panel for each pair or contact model and patch, and how many more there would be."""
    variable, x, y = spec.map or "", spec.x, spec.shown[0]
    _choose("map", [variable], [str(name) for name in sweep.data_vars if name not in NOT_SHOWN])
    for path, axis in (("x", x), ("y", y)):
        _choose(path, [axis], axes_of(sweep), "is not an axis of the sweep")
    plane = sweep.isel({axis: sweep.sizes[axis] // 2 for axis in axes_of(sweep) if axis not in (x, y)})
    plane = plane.isel({axis: _thinned(plane.sizes[axis], MOST_VALUES) for axis in (x, y)})
    all_series = [
        (patch, series)
        for patch in patches_of(plane, spec.patches)
        for series in _series(results, plane.sel(patch), spec, variable)
    ]
    signed, of_pairs = bool(patch_axes(sweep)), "pair" in plane[variable].dims
    values = [series.data[variable].transpose(y, x).values for _, series in all_series]
    values = values if signed or of_pairs else [np.abs(array) for array in values]
    outcome = results.case.outcomes.get(variable)
    scale: Scale = "log" if not (outcome and outcome.sign == "any") and fit_for_log(*values) else "linear"
    axes, places = [], []
    for path, name in (("x", x), ("y", y)):
        at = Q(plane[name].values, results.case.result_units[name]).m_as(units[name])
        spacing = getattr(spec, f"{path}_scale") or results.case.sweeps[spec.sweep or ""].spacing(name)
        axes.append(PlotAxis(label(name, units=units), spacing if (at > 0.0).all() else "linear",
                             _ends(path, name, units, spec)))  # fmt: skip
        places.append(at)
    panels = []
    for (patch, series), drawn in zip(all_series[:MOST_MAPS], values, strict=False):
        regions = {LIMITS[limit]: region.transpose(y, x).values for limit, region in series.beyond().items()}
        if of_pairs:
            regions[OUTSIDE] = series.data.outside_range.transpose(y, x).values > 0.0
        whole = (f"all {words}" for words, region in regions.items() if region.all())  # no border shows them
        title = ", ".join(filter(None, (series.of, in_words(patch), *whole)))
        shown_here = Map(label(variable, units=units), places[0], places[1], drawn, scale, regions)
        panels.append(Panel(axes[0], axes[1], (), title, map=shown_here))
    return panels, len(all_series) - len(panels)


def _thinned(count: int, most: int) -> NDArray[np.intp]:
    """Return places, the first and the last among them, of at most so many of a count of values."""
    return np.unique(np.linspace(0, count - 1, min(count, most)).round().astype(int))


# Axes


def _ends(path: str, variable: str, units: Mapping[str, str], window: Window) -> tuple[float, float] | None:
    """Return the ends that a case gives an axis, if any."""
    ends: Range | None = getattr(window, f"{path}_range")
    if ends is None:
        return None
    unit = units[variable]
    try:
        low, high = (
            end if isinstance(end, float) and not unit
            else float(from_si(Unit(unit, positive=False).si(end, variable), unit).magnitude)
            for end in ends
        )  # fmt: skip
    except UnitError as error:
        raise ConfigurationError("figure", [Fault((f"{path}_range",), str(error))]) from None
    if low >= high or (getattr(window, f"{path}_scale") == "log" and low <= 0.0):
        fault = "must run from the lower end to the higher one, above zero on a logarithmic axis"
        raise ConfigurationError("figure", [Fault((f"{path}_range",), fault)])
    return low, high


def _y_axis(x_axis: PlotAxis, window: Window, curves: Sequence[Curve], units: Mapping[str, str]) -> PlotAxis:
    """Return the y axis of a panel; without ends of its own it holds all values and bands between the ends of x."""
    values = [
        y[x_axis.shows(curve.x) & np.isfinite(y)]
        for curve in curves
        for y in (curve.y, curve.low, curve.high)
        if y is not None
    ]
    seen = np.concatenate([np.empty(0), *values])
    positive = seen[seen > 0]
    scale: Scale = "log" if window.y_scale == "log" and positive.size else "linear"
    y_ends = _ends("y", window.shown[0], units, window)
    if y_ends is None and scale == "log":
        y_ends = (positive.min() / 1.5, positive.max() * 1.5) if x_axis.ends else None
    elif y_ends is None:
        y_ends = (0.0, 1.05 * seen.max()) if positive.size and seen.min() >= 0.0 else None
    return PlotAxis(label(*window.shown, units=units), scale, y_ends)
