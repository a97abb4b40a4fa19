"""The figures of a study: the figures of its case, or else one of each kind for each sweep and profile.

Line styles stand for contact models. Colours stand for laws in figures of their outcomes, for variables along the patch
or where several are shown, and otherwise for contact models too. If the rig makes several patches, colours stand for
patches, line styles for what is shown of each, and values keep their signs. Bands show the published range of a law's
parameters. Parts of curves outside the range of their law are thin and pale, and parts of panels beyond first yield or
shakedown are shaded.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import xarray

from wearlaw.figures.curves import BLACK, Curve, FigureData, Panel, PlotAxis, Shade
from wearlaw.models.law import WEAR
from wearlaw.study.figure_spec import ACROSS, BY_PATCH, OF_PROFILE, FigureSpec, Scale, Window, axis_along, ends
from wearlaw.study.measured import measured_points
from wearlaw.study.results import (
    LIMITS,
    Patch,
    Results,
    along,
    axes_of,
    beyond_limits,
    by_patch,
    in_words,
    is_of_patches,
    labelled_by,
    main_axis,
    middle_of,
    outcomes_of,
    patch_axes,
    patches_of,
    possible_patches,
    predicting,
)
from wearlaw.units.variables import UNITS, label, name_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from wearlaw.arrays.array import Array
    from wearlaw.study.grid import Grid


BESIDE = 0.15
"""Largest distance of points from the middle of their patch, so that they do not cover each other."""

MANY_LINES = 8
"""Number of lines in a panel beyond which a figure's caption says how to choose."""


def figures_of(results: Results) -> tuple[FigureData, ...]:
    """Return the data of each figure of a study."""
    asked = results.case.figures or dict(_usual(results))
    return tuple(_figure(results, name, spec) for name, spec in asked.items())


def _usual(results: Results) -> Iterator[tuple[str, FigureSpec]]:
    """Yield the default figures: outcomes and traction over each sweep, and the fields or wear of each profile."""
    creepage = results.case.rig.creepage
    for name, sweep in results.sweeps.items():
        axis, several = main_axis(sweep, creepage), is_of_patches(sweep)
        # One operating point of several patches is no curve. The conditions of a wheelset may be zero or negative.
        first = BY_PATCH if several and not axes_of(sweep) else axis
        x_scale: Scale = "linear" if several else "log"
        for outcome in outcomes_of(results, sweep):
            for x in (first,) if first == BY_PATCH else ("wear_index", first):
                y_scale: Scale = "linear" if outcome.signed else "log"
                spec = FigureSpec(sweep=name, x=x, y=(outcome.name,), x_scale=x_scale, y_scale=y_scale)
                yield f"{name}_{outcome.name}_against_{x}", spec
        if axis == creepage:
            measured = results.case.measured is not None
            spec = FigureSpec(sweep=name, x=first, y=("traction_coefficient",), x_scale=x_scale, measured=measured)
            yield f"{name}_traction_against_{first}", spec
    for name, profile in results.profiles.items():
        if "y" in profile:
            bodies = [body for body in results.case.rig.bodies if f"{body}_depth" in profile]
            across = tuple(Window(title=body, y=(y,), body=body) for y in ACROSS for body in bodies)
            yield f"{name}_across_the_patch", FigureSpec(profile=name, x="y", panels=across)
        elif profile:
            panels = (Window(y=("pressure", "traction", "traction_bound")), Window(y=("slip",)))
            yield f"{name}_along_the_patch", FigureSpec(profile=name, panels=panels)


def _figure(results: Results, name: str, spec: FigureSpec) -> FigureData:
    grid = results.case.sweeps[spec.sweep] if spec.sweep else results.case.profiles[spec.profile or ""]
    axis = axis_along(grid, spec.x, results.case.rig.creepage) if spec.sweep else ""
    fixed = _conditions(grid, axis, results.case.units)
    heads = [text for condition, text in fixed.items() if condition in grid.axes()]
    panels = []
    for window in spec.windows():
        units = results.case.result_units
        x = spec.x
        if spec.sweep:
            curves = _over_sweep(results, spec, window, axis)
            shades = _over_limits(results, spec, window, axis)
        else:
            profile = results.profiles[spec.profile or ""]
            curves = _of_profile(results, profile, spec, window)
            shades = _all_over(profile, spec, window, curves)
            if "y" in profile:
                x, body = "y", _body(results, window)
                units = units | {name: profile[f"{body}_{name}"].attrs["units"] for name in window.shown}
        title = ", ".join(filter(None, (window.title, *heads)))
        by_name = x == BY_PATCH
        x_axis = _named(results.sweep(spec.sweep or ""), window) if by_name else _x_axis(x, window, curves, units)
        low, high = x_axis.ends or (-np.inf, np.inf)
        seen = (shade for shade in shades if any(start < high and end > low for start, end in shade.spans))
        y_axis = _y_axis(x_axis, window, curves, units)
        panels.append(Panel(x_axis, y_axis, curves=tuple(curves), title=title, shades=tuple(seen)))
    caption = spec.caption or f"At {', '.join(fixed.values())}.{_hint(results, spec, panels)}"
    return FigureData(name=name, title=spec.title or results.case.title, panels=tuple(panels), caption=caption)


def _hint(results: Results, spec: FigureSpec, panels: list[Panel]) -> str:
    """Return how to choose patches if a panel has too many lines, or why one has none."""
    dataset = results.sweeps[spec.sweep] if spec.sweep else results.profiles[spec.profile or ""]
    if not is_of_patches(dataset):
        return ""
    if any(not panel.curves for panel in panels):
        return " None of the chosen patches exists here."
    if spec.x == BY_PATCH or all(len(panel.curves) <= MANY_LINES for panel in panels):
        return ""
    chosen = ", ".join(f"{axis} = {json.dumps(label)}" for axis, label in patches_of(dataset)[0].items())
    return f" To show fewer lines, choose in the table of the figure, as in patches = {{ {chosen} }}."


def _conditions(grid: Grid, axis: str, units: Mapping[str, str]) -> dict[str, str]:
    """Return the fixed conditions of a figure in words; axes are at their middle value."""
    found = {}
    for name in grid.given:
        if name != axis:
            level = grid.level(name, units)
            shown = level if isinstance(level, str) else f"{level:.5g} {units[name]}"
            found[name] = f"{name_of(name)} {shown}".rstrip()
    return found


def _over_sweep(results: Results, spec: FigureSpec, window: Window, axis: str) -> list[Curve]:
    """Return curves of outcomes for each pair, and of other variables for each contact model, by patch."""
    sweep = results.sweeps[spec.sweep or ""]
    curves: list[Curve] = []
    for patch, line in _lines(sweep, spec, window, axis):
        found = _of_patch(results, line, spec, window)
        if spec.x == BY_PATCH:
            beside = np.linspace(-BESIDE, BESIDE, len(found)) if len(found) > 1 else [0.0]
            found = [
                replace(curve, x=curve.x + shift, points=True, colour=number, dash=0)
                for number, (curve, shift) in enumerate(zip(found, beside, strict=True))
            ]
        elif patch:
            found = _coloured(found, patch, sweep)
        curves += found
    return curves + [_measured(results, spec.x, y) for y in window.shown if spec.measured]


def _coloured(curves: list[Curve], patch: Patch, dataset: xarray.Dataset) -> list[Curve]:
    """Return the curves of a patch with its label and colour, which is the same in all figures."""
    colour = possible_patches(dataset).index(patch)
    return [
        replace(curve, label=labelled_by(patch, curve.label), colour=colour, dash=number)
        for number, curve in enumerate(curves)
    ]


def _lines(
    sweep: xarray.Dataset, spec: FigureSpec, window: Window, axis: str
) -> Iterator[tuple[Patch, xarray.Dataset]]:
    """Yield each existing patch that a panel shows, with the sweep along an axis; or all of them as one axis."""
    if spec.x == BY_PATCH:
        point = middle_of(sweep)
        if patches_of(point, window.patches):
            yield {}, by_patch(point, window.patches)
        return
    line = along(sweep, axis)
    for patch in patches_of(line, window.patches):
        yield patch, line.sel(patch)


def _of_patch(results: Results, line: xarray.Dataset, spec: FigureSpec, window: Window) -> list[Curve]:
    """Return the curves of a line through the points of a sweep."""
    shown = window.shown
    models = spec.contact_models or line.contact_model.values.tolist()
    curves = []
    for y in shown:
        if "pair" in line[y].dims:
            pairs = predicting(results, y, spec.pairs or line.pair.values.tolist())
            curves += [_outcome(results, line, spec.x, shown, y, pair) for pair in pairs]
        else:
            alike = None if "contact_model" in line[y].dims or "contact_model" in line[spec.x].dims else 1
            curves += [_of_contact(results, line, spec.x, shown, y, model, alike) for model in models[:alike]]
    return curves


def _outcome(results: Results, line: xarray.Dataset, x: str, shown: tuple[str, ...], y: str, pair: str) -> Curve:
    """Return the curve of an outcome of a pair, with its band if the law has one."""
    one = line.sel(pair=pair)
    low, high = (one[name].values if name in one else np.array(np.nan) for name in (f"{y}_low", f"{y}_high"))
    has_band = bool((high > low).any())
    return Curve(
        pair if len(shown) == 1 else f"{name_of(y)}, {pair}",
        _values(line, x, one.pair_contact_model.item()),
        one[y].values,
        *_style(results, pair),
        low=low if has_band else None,
        high=high if has_band else None,
        outside=one.outside_range.values > 0.0,
    )


def _over_limits(results: Results, spec: FigureSpec, window: Window, axis: str) -> list[Shade]:
    """Return where the contact of any model of a panel is beyond its elastic limits, over a sweep."""
    sweep = results.sweeps[spec.sweep or ""]
    models = spec.contact_models or sweep.contact_model.values.tolist()
    if all("pair" in sweep[y].dims for y in window.shown):
        every = sweep.pair.values.tolist()
        pairs = [pair for y in window.shown for pair in predicting(results, y, spec.pairs or every)]
        models = sweep.pair_contact_model.sel(pair=pairs).values.tolist()
    tracks = [
        (_values(line, spec.x, model), {limit: one.sel(contact_model=model).values for limit, one in beyond.items()})
        for _, line in _lines(sweep, spec, window, axis)
        for beyond in (beyond_limits(line),)
        for model in dict.fromkeys(models)
    ]
    shades = []
    for level, (limit, words) in enumerate(LIMITS.items(), start=1):
        spans = [span for x, beyond in tracks if limit in beyond for span in _spans(x, beyond[limit])]
        if window.x_scale == "log" and spans:
            positive = np.concatenate([x[x > 0.0] for x, _ in tracks])
            spans = [(max(low, positive.min()), high) for low, high in spans if high > 0.0]
        if spans:
            shades.append(Shade(words, level, tuple(_merged(spans))))
    return shades


def _all_over(profile: xarray.Dataset, spec: FigureSpec, window: Window, curves: list[Curve]) -> list[Shade]:
    """Return shades over the whole patch if the contact of any model is beyond its elastic limits."""
    if not curves:
        return []
    models = list(spec.contact_models or profile.contact_model.values)
    x = np.concatenate([curve.x for curve in curves])
    return [
        Shade(LIMITS[limit], level, ((float(x.min()), float(x.max())),))
        for level, (limit, beyond) in enumerate(beyond_limits(profile).items(), start=1)
        if any(beyond.sel({"contact_model": models, **patch}).any() for patch in patches_of(profile, window.patches))
    ]


def _spans(x: Array, beyond: NDArray[np.bool_]) -> Iterator[tuple[float, float]]:
    """Yield the ends of each run of points beyond a limit, half-way to the next point on either side."""
    known = np.flatnonzero(np.isfinite(x))
    order = known[np.argsort(x[known], kind="stable")]
    x, beyond = x[order], beyond[order]
    steps = np.flatnonzero(np.diff(np.concatenate([[False], beyond, [False]]).astype(int)))
    edges = np.concatenate([x[:1], 0.5 * (x[1:] + x[:-1]), x[-1:]])
    for first, after in zip(steps[::2], steps[1::2], strict=True):
        yield float(edges[first]), float(edges[after])


def _merged(spans: Iterable[tuple[float, float]]) -> Iterator[tuple[float, float]]:
    """Yield the union of spans as spans that do not touch."""
    start, end = np.inf, -np.inf
    for low, high in sorted(spans):
        if low > end and start <= end:
            yield start, end
        start, end = (low, high) if low > end else (start, max(end, high))
    if start <= end:
        yield start, end


def _of_contact(
    results: Results, line: xarray.Dataset, x: str, shown: tuple[str, ...], variable: str, model: str, alike: int | None
) -> Curve:
    """Return the curve of a variable for one contact model, or for all if they agree."""
    along = _values(line, x, model)
    dash = 0 if alike else _dash(results, model)
    several = name_of(variable) if alike else f"{name_of(variable)}, {model}"
    return Curve(
        label=model if len(shown) == 1 and not alike else several,
        x=along,
        y=np.broadcast_to(_values(line, variable, model), along.shape),
        colour=dash if len(shown) == 1 else shown.index(variable),
        dash=dash,
    )


def _values(line: xarray.Dataset, variable: str, model: str) -> Array:
    """Return the magnitude of a variable, for one contact model if it depends on the model.

    If the rig makes several patches, the values keep their signs, which differ from side to side.
    """
    values = line[variable]
    found = values.sel(contact_model=model) if "contact_model" in values.dims else values
    shown: Array = (found if is_of_patches(line) else abs(found)).values
    return shown


def _measured(results: Results, x: str, y: str) -> Curve:
    """Return the measured points, as magnitudes like all curves over a sweep."""
    measured = results.case.measured
    assert measured is not None
    values = measured_points(measured.data, results.case.rig)
    along, across = abs(values[x]), abs(values[y])
    there = np.isfinite(along) & np.isfinite(across)
    uncertainty = measured.data.wear_rate_uncertainty if y == "wear_rate" else None
    spread = np.zeros(across.shape) if uncertainty is None else uncertainty.to(UNITS[y]).magnitude
    return Curve(
        measured.label,
        along[there],
        across[there],
        BLACK,
        low=None if uncertainty is None else (across - spread)[there],
        high=None if uncertainty is None else (across + spread)[there],
        points=True,
    )


def _of_profile(results: Results, profile: xarray.Dataset, spec: FigureSpec, window: Window) -> list[Curve]:
    """Return the curves of a profile, by patch."""
    make = _across_the_patch if "y" in profile else _along_the_patch
    curves: list[Curve] = []
    for patch in patches_of(profile, window.patches):
        found = make(results, profile.sel(patch), spec, window)
        curves += _coloured(found, patch, profile) if patch else found
    return curves


def _body(results: Results, window: Window) -> str:
    """Return the body whose wear a panel shows."""
    return window.body or next(iter(results.case.rig.bodies))


def _along_the_patch(results: Results, profile: xarray.Dataset, spec: FigureSpec, window: Window) -> list[Curve]:
    """Return curves along the patch: outcomes for each pair, other variables for each contact model."""
    curves = []
    for variable in window.shown:
        if variable == "creepage":
            grid = results.case.profiles[spec.profile or ""]
            level = np.full(2, grid.level(results.case.rig.creepage, results.case.units))
            curves.append(Curve(name_of(variable), profile.x.values[[0, -1]], level, OF_PROFILE.index(variable)))
        elif "pair" in profile[variable].dims:
            for pair in predicting(results, variable, spec.pairs or profile.pair.values.tolist()):
                x, y = _at_nodes(profile, profile[variable].sel(pair=pair), "x", results.pair(pair).contact_model)
                outside = np.full(y.shape, profile.outside_range.sel(pair=pair).item() > 0.0)
                named = pair if len(window.shown) == 1 or variable == WEAR else f"{name_of(variable)}, {pair}"
                curves.append(Curve(named, x, y, *_style(results, pair), outside=outside))
        else:
            models = spec.contact_models or profile.contact_model.values.tolist()
            alike = 1 if variable == "pressure" else None
            curves += [_field(results, profile, variable, model) for model in models[:alike]]
    return curves


def _across_the_patch(results: Results, profile: xarray.Dataset, spec: FigureSpec, window: Window) -> list[Curve]:
    """Return curves across the patch for a body: depth for each pair, sliding distance for each contact model."""
    curves, body = [], _body(results, window)
    for variable in window.shown:
        values = profile[f"{body}_{variable}"]
        if "pair" in values.dims:
            for pair in spec.pairs or profile.pair.values.tolist():
                x, y = _at_nodes(profile, values.sel(pair=pair), "y", results.pair(pair).contact_model)
                if not y.size:  # a law for the other body
                    continue
                outside = np.full(y.shape, results.is_outside(profile, pair, body))
                curves.append(Curve(pair, x, y, *_style(results, pair), outside=outside))
        else:
            for model in spec.contact_models or profile.contact_model.values.tolist():
                x, y = _at_nodes(profile, values.sel(contact_model=model), "y", model)
                curves.append(Curve(model, x, y, _dash(results, model), _dash(results, model)))
    return curves


def _field(results: Results, profile: xarray.Dataset, variable: str, model: str) -> Curve:
    """Return the curve of a field along the patch; all contact models have Hertz's pressure."""
    x, y = _at_nodes(profile, profile[variable].sel(contact_model=model), "x", model)
    colour = OF_PROFILE.index(variable)
    if variable == "pressure":
        return Curve(name_of(variable), x, y, colour)
    return Curve(f"{name_of(variable)}, {model}", x, y, colour, _dash(results, model))


def _at_nodes(profile: xarray.Dataset, values: xarray.DataArray, position: str, model: str) -> tuple[Array, Array]:
    """Return the positions of the nodes of a contact model, and the values of a variable there."""
    there = values.notnull().values
    places = profile[position]
    places = places.sel(contact_model=model) if "contact_model" in places.dims else places
    return places.values[there], values.values[there]


def _dash(results: Results, model: str) -> int:
    return list(results.case.contact_models_by_label).index(model)


def _style(results: Results, label_of_pair: str) -> tuple[int, int]:
    """Return the colour of a pair's law and the dash of its contact model."""
    pair = results.pair(label_of_pair)
    return list(results.case.laws_by_label).index(pair.law), _dash(results, pair.contact_model)


def _x_axis(x: str, window: Window, curves: list[Curve], units: Mapping[str, str]) -> PlotAxis:
    """Return the x axis of a panel."""
    x_ends = ends(x, units[x], window.x_range) if window.x_range else None
    # A logarithmic axis hides values that are not positive, as at zero creepage.
    scale: Scale = "log" if window.x_scale == "log" and any((c.x > 0).any() for c in curves) else "linear"
    return PlotAxis(label(x, units=units), scale, x_ends)


def _y_axis(x_axis: PlotAxis, window: Window, curves: list[Curve], units: Mapping[str, str]) -> PlotAxis:
    """Return the y axis of a panel."""
    seen = _seen(curves, x_axis.ends)
    positive = seen[seen > 0]
    scale: Scale = "log" if window.y_scale == "log" and positive.size else "linear"
    y_ends: tuple[float, float] | None
    if window.y_range:
        y_ends = ends(window.shown[0], units[window.shown[0]], window.y_range)
    elif scale == "log":
        y_ends = (positive.min() / 1.5, positive.max() * 1.5) if x_axis.ends else None
    else:
        y_ends = (0.0, 1.05 * seen.max()) if positive.size and seen.min() >= 0.0 else None
    return PlotAxis(label(*window.shown, units=units), scale, y_ends)


def _named(sweep: xarray.Dataset, window: Window) -> PlotAxis:
    """Return the axis of a figure with a point for each patch."""
    names = tuple(map(in_words, patches_of(middle_of(sweep), window.patches)))
    return PlotAxis(
        ", ".join(map(name_of, patch_axes(sweep))), ends=(-0.5, len(names) - 0.5) if names else None, names=names
    )


def _seen(curves: list[Curve], x_ends: tuple[float, float] | None) -> Array:
    """Return all finite values of curves and bands between the ends of the x axis."""
    low, high = x_ends or (-np.inf, np.inf)
    values = [
        y[(low <= curve.x) & (curve.x <= high) & np.isfinite(y)]
        for curve in curves
        for y in (curve.y, curve.low, curve.high)
        if y is not None
    ]
    return np.concatenate([np.empty(0), *values])
