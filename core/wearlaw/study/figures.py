"""The figures of a study: the figures of its case, or else one of each kind for each sweep and profile.

Line styles stand for contact models. Colours stand for laws in figures of their outcomes, for variables along the patch
or where several are shown, and otherwise for contact models too. If the rig makes several patches, colours stand for
patches, line styles for what is shown of each, and values keep their signs. Bands show the published range of a law's
parameters. Two long axes of a sweep also make a map, and a single operating point makes bars. Parts of curves outside
the range of their law are thin and pale, and a strip along the x axis shows where the contact is beyond shakedown.
"""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Collection, Iterator, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray

from wearlaw.figures.curves import BLACK, Curve, FigureData, Panel, PlotAxis
from wearlaw.models.law import WEAR
from wearlaw.study.figure_kinds import (
    axes_of_map,
    bars,
    converted,
    fit_for_log,
    limits_in_words,
    maps,
    whole_maps,
)
from wearlaw.study.figure_spec import ACROSS, BY_PATCH, OF_PROFILE, FigureSpec, Scale, Window, axis_along, ends
from wearlaw.study.measured import known_variables, measured_points
from wearlaw.study.results import (
    Patch,
    Results,
    along,
    axes_of,
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
from wearlaw.study.shades import beyond_shakedown, beyond_shakedown_in_patch, lines_of, shade_in, values_of
from wearlaw.units.variables import UNITS, label, name_of

if TYPE_CHECKING:
    from wearlaw.arrays.array import Array
    from wearlaw.study.grid import Grid


STRESSES = ("pressure", "traction", "traction_bound")
"""Variables along the patch that a title calls stresses."""

TOGETHER = 0.8
"""Thickness of the bars of a patch together; the next patch is at a distance of 1."""

MANY_LINES = 8
"""Number of lines in a panel beyond which a figure's caption says how to choose."""


def figures_of(results: Results) -> tuple[FigureData, ...]:
    """Return the data of each figure of a study."""
    asked = results.case.figures or dict(_usual(results))
    titles = {name: spec.title or _title(spec, results) for name, spec in asked.items()}
    of_many = {title for title, count in Counter(titles.values()).items() if count > 1}
    for name, spec in asked.items():
        if titles[name] in of_many and not spec.title:
            titles[name] += f" ({(spec.sweep or spec.profile or '').replace('_', ' ')})"
    return tuple(_figure(results, name, spec, titles[name]) for name, spec in asked.items())


def _usual(results: Results) -> Iterator[tuple[str, FigureSpec]]:
    """Yield the default figures: outcomes and traction over each sweep, and the fields or wear of each profile.

    Scales are those of the sweep's own spacing. Figures over creepage show the measured tests.
    """
    creepage, tests = results.case.rig.creepage, results.case.measured
    known = known_variables(tests.data) if tests is not None else ()
    for name, sweep in results.sweeps.items():
        axis, several = main_axis(sweep, creepage), is_of_patches(sweep)
        # One operating point of several patches is no curve.
        point = not axes_of(sweep)
        first = BY_PATCH if several and point else axis
        spacing: Scale = "linear" if point else results.case.sweeps[name].spacing(axis)
        plane = axes_of_map(sweep, creepage)
        for outcome in outcomes_of(results, sweep):
            if plane is not None:
                spec = FigureSpec(sweep=name, x=plane[0], y=(plane[1],), map=outcome.name)
                yield f"{name}_{outcome.name}_over_{plane[0]}_and_{plane[1]}", spec
            if point and not several:
                yield f"{name}_{outcome.name}", FigureSpec(sweep=name, x=axis, y=(outcome.name,))
                continue
            along_axis = along(sweep, axis)[outcome.name].values
            log = not outcome.signed and first != BY_PATCH and (spacing == "log" or fit_for_log(along_axis))
            for x in (first,) if first == BY_PATCH else ("wear_index", first):
                y_scale: Scale = "log" if log else "linear"
                measured = axis == creepage and {x, outcome.name} <= {*known}
                spec = FigureSpec(
                    sweep=name, x=x, y=(outcome.name,), x_scale=spacing, y_scale=y_scale, measured=measured
                )
                yield f"{name}_{outcome.name}_over_{x}", spec
        if axis == creepage:
            measured = {first, "traction_coefficient"} <= {*known}
            spec = FigureSpec(sweep=name, x=first, y=("traction_coefficient",), x_scale=spacing, measured=measured)
            yield f"{name}_traction" if point and not several else f"{name}_traction_over_{first}", spec
    for name, profile in results.profiles.items():
        if "y" in profile:
            bodies = [body for body in results.case.rig.bodies if f"{body}_depth" in profile]
            across = tuple(Window(title=body, y=(y,), body=body) for y in ACROSS for body in bodies)
            yield f"{name}_across_the_patch", FigureSpec(profile=name, x="y", panels=across)
        elif profile:
            panels = (Window(y=STRESSES), Window(y=("slip",)))
            yield f"{name}_along_the_patch", FigureSpec(profile=name, panels=panels)


def _title(spec: FigureSpec, results: Results) -> str:
    """Return a title in words, such as "Wear rate over normal force"."""
    if spec.map:
        words = f"{name_of(spec.map)} over {name_of(spec.x)} and {name_of(spec.shown[0])}"
    else:
        shown = dict.fromkeys(variable for window in spec.windows() for variable in window.shown)
        names = [name_of(variable) for variable in shown if variable not in STRESSES]
        stresses = [name_of(variable) for variable in shown if variable in STRESSES]
        names = [*(["stresses"] if len(stresses) == len(STRESSES) else stresses), *names]
        words = " and ".join(filter(None, (", ".join(names[:-1]), names[-1])))
        if spec.profile:
            words += f" {'across' if spec.x == 'y' else 'along'} the patch"
        elif spec.x == BY_PATCH:
            words += " by patch"
        elif not _is_of_bars(results, spec):
            words += f" over {name_of(spec.x)}"
    return words[:1].upper() + words[1:]


def _is_of_bars(results: Results, spec: FigureSpec) -> bool:
    """Return whether a figure shows the one point of a sweep as bars."""
    sweep = results.sweeps.get(spec.sweep or "")
    return sweep is not None and not (axes_of(sweep) or is_of_patches(sweep) or spec.measured)


def _figure(results: Results, name: str, spec: FigureSpec, title: str) -> FigureData:
    grid = results.case.sweeps[spec.sweep] if spec.sweep else results.case.profiles[spec.profile or ""]
    units = results.case.result_units | grid.written_units()
    axis = axis_along(grid, spec.x, results.case.rig.creepage) if spec.sweep else ""
    of_bars = _is_of_bars(results, spec)
    free = {spec.x, *spec.shown} if spec.map else {"" if of_bars else axis}
    fixed = _conditions(grid, free, units)
    more, heads = "", []
    if spec.map:
        panels, left_out = maps(results, spec, units)
        more = whole_maps(panels)
        if left_out:
            more += f" {left_out} more are left out; choose among them with pairs, contact_models or patches."
    elif of_bars:
        panels = [bars(results, spec, window, units) for window in spec.windows()]
        more = limits_in_words(results.sweeps[spec.sweep or ""])
    else:
        heads = [text for condition, text in fixed.items() if condition in grid.axes()]
        panels = [_panel(results, spec, window, axis, heads, units) for window in spec.windows()]
    head, conditions = results.case.title, ", ".join(fixed.values())
    below = ", ".join(text for text in fixed.values() if text not in heads)
    return FigureData(
        name=name,
        title=title,
        panels=tuple(panels),
        caption=spec.caption or f"At {conditions}.{more}{_hint(results, spec, panels)}{_of_strip(panels)}",
        conditions=f"{head}: {below}" if below else head,
    )


def _panel(
    results: Results, spec: FigureSpec, window: Window, axis: str, heads: list[str], shown_units: Mapping[str, str]
) -> Panel:
    """Return a panel of curves, with its x axis in the unit of the case's own file."""
    units, x = results.case.result_units, spec.x
    if spec.sweep:
        curves = _over_sweep(results, spec, window, axis)
        shades = beyond_shakedown(results, spec, window, axis)
        if x != BY_PATCH and units[x] != shown_units[x]:
            curves = [replace(curve, x=converted(curve.x, units[x], shown_units[x])) for curve in curves]
            shades = tuple(shade_in(shade, units[x], shown_units[x]) for shade in shades)
        units = {**units, x: shown_units.get(x, "")}
    else:
        profile = results.profiles[spec.profile or ""]
        curves = _of_profile(results, profile, spec, window)
        shades = beyond_shakedown_in_patch(profile, spec, window, curves)
        if "y" in profile:
            x, body = "y", _body(results, window)
            units = units | {name: profile[f"{body}_{name}"].attrs["units"] for name in window.shown}
    by_name = x == BY_PATCH
    x_axis = _named(results.sweep(spec.sweep or ""), window) if by_name else _x_axis(x, window, curves, units)
    low, high = x_axis.ends or (-np.inf, np.inf)
    seen = (shade for shade in shades if any(start < high and end > low for start, end in shade.spans))
    y_axis = _y_axis(x_axis, window, curves, units)
    title = ", ".join(filter(None, (window.title, *heads)))
    return Panel(x_axis, y_axis, curves=tuple(curves), title=title, shades=tuple(seen))


def _of_strip(panels: list[Panel]) -> str:
    """Return what a strip along the x axis means."""
    if not any(panel.shades for panel in panels):
        return ""
    return " Above the grey strip the contact is beyond shakedown: see First yield and shakedown, theory.md."


def _hint(results: Results, spec: FigureSpec, panels: list[Panel]) -> str:
    """Return how to choose patches if a panel has too many lines, or why one has none."""
    dataset = results.sweeps[spec.sweep] if spec.sweep else results.profiles[spec.profile or ""]
    if not is_of_patches(dataset):
        return ""
    if any(not panel.curves and panel.map is None for panel in panels) or not panels:
        return " None of the chosen patches exists here."
    if spec.x == BY_PATCH or all(len(panel.curves) <= MANY_LINES for panel in panels):
        return ""
    chosen = ", ".join(f"{axis} = {json.dumps(label)}" for axis, label in patches_of(dataset)[0].items())
    return f" To show fewer lines, choose in the table of the figure, as in patches = {{ {chosen} }}."


def _conditions(grid: Grid, free: Collection[str], units: Mapping[str, str]) -> dict[str, str]:
    """Return the conditions of a figure in words, without those that vary in it; axes are at their middle value."""
    found = {}
    for name in grid.given:
        if name not in free:
            level = grid.level(name, units)
            shown = level if isinstance(level, str) else f"{level:.5g} {units[name]}"
            found[name] = f"{name_of(name)} {shown}".rstrip()
    return found


def _over_sweep(results: Results, spec: FigureSpec, window: Window, axis: str) -> list[Curve]:
    """Return curves of outcomes for each pair, and of other variables for each contact model, by patch."""
    sweep = results.sweeps[spec.sweep or ""]
    curves: list[Curve] = []
    for patch, line in lines_of(sweep, spec, window, axis):
        found = _of_patch(results, line, spec, window)
        if spec.x == BY_PATCH:
            step = TOGETHER / len(found) if found else 0.0
            beside = step * (np.arange(len(found)) - 0.5 * (len(found) - 1))
            # Bars begin at zero, which a logarithmic axis does not have.
            look: dict[str, Any] = {"points": True, "hollow": True} if window.y_scale == "log" else {"bars": 0.9 * step}
            found = [
                replace(curve, x=curve.x + shift, colour=number, dash=0, **look)
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


def _of_patch(results: Results, line: xarray.Dataset, spec: FigureSpec, window: Window) -> list[Curve]:
    """Return the curves of a line along an axis of a sweep."""
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
        values_of(line, x, one.pair_contact_model.item()),
        one[y].values,
        *_style(results, pair),
        low=low if has_band else None,
        high=high if has_band else None,
        outside=one.outside_range.values > 0.0,
    )


def _of_contact(
    results: Results, line: xarray.Dataset, x: str, shown: tuple[str, ...], variable: str, model: str, alike: int | None
) -> Curve:
    """Return the curve of a variable for one contact model, or for all if they agree."""
    along = values_of(line, x, model)
    dash = 0 if alike else _dash(results, model)
    several = name_of(variable) if alike else f"{name_of(variable)}, {model}"
    return Curve(
        label=model if len(shown) == 1 and not alike else several,
        x=along,
        y=np.broadcast_to(values_of(line, variable, model), along.shape),
        colour=dash if len(shown) == 1 else shown.index(variable),
        dash=dash,
    )


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
    grid = results.case.profiles[spec.profile or ""]
    problem = grid.problem(results.case.rig)
    half = 0.0 if problem.dims else 1e3 * float(np.ravel(problem.half_width)[0])
    for variable in window.shown:
        if variable == "creepage":
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
            found = [_field(results, profile, variable, model) for model in models[:alike]]
            curves += [_to_the_edges(curve, half) for curve in found] if half and variable in STRESSES else found
    return curves


def _to_the_edges(curve: Curve, half: float) -> Curve:
    """Return a curve over a patch of this half width with its ends, where it is zero; nodes lie inside."""
    if not curve.x.size or abs(curve.x).max() >= half:
        return curve
    ends = (-half, half) if curve.x[0] <= curve.x[-1] else (half, -half)
    x, y = np.concatenate([ends[:1], curve.x, ends[1:]]), np.concatenate([[0.0], curve.y, [0.0]])
    return replace(curve, x=x, y=y, outside=None if curve.outside is None else np.pad(curve.outside, 1, mode="edge"))


def _across_the_patch(results: Results, profile: xarray.Dataset, spec: FigureSpec, window: Window) -> list[Curve]:
    """Return curves across the patch for a body: depth for each pair, sliding distance for each contact model.

    At the edges, where the patch has no length, both are zero.
    """
    curves, body = [], _body(results, window)
    problem = results.case.profiles[spec.profile or ""].problem(results.case.rig)
    half = 1e3 * float(np.ravel(problem.b)[0]) if problem.geometry == "ellipse" and not problem.dims else 0.0
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
    return [_to_the_edges(curve, half) for curve in curves] if half else curves


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
        room = 1.12 if any(curve.bars for curve in curves) else 1.05  # for the numbers at the ends of bars
        y_ends = (0.0, room * seen.max()) if positive.size and seen.min() >= 0.0 else None
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
