"""The figures of a study: the figures of its case, or else one of each kind for each sweep and profile.

Line styles stand for contact models. Colours stand for laws in figures of their outcomes, for variables along the patch
or where several are shown, and otherwise for contact models too. If the rig makes several patches, colours stand for
patches, line styles for what is shown of each, and values keep their signs. Bands show the published range of a law's
parameters. Two long axes of a sweep also make a map, and a single operating point makes points beside their names.
Parts of curves outside the range of their law are thin and pale, and a strip along the x axis shows where the contact
is beyond shakedown.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
import xarray

from wearlaw.units.quantities import Q
from wearlaw.units.variables import UNITS, label, name_of
from wearlaw_output.curves import BLACK, OUTSIDE, Curve, FigureData, Map, Panel, PlotAxis, Shade
from wearlaw_studies.figure_spec import (
    ACROSS,
    BY_PATCH,
    OF_PROFILE,
    FigureSpec,
    Range,
    Scale,
    Window,
    axis_along,
    ends,
)
from wearlaw_studies.measured import known_variables, measured_points
from wearlaw_studies.results import (
    LIMITS,
    SHAKEDOWN,
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

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from wearlaw.arrays.array import Array
    from wearlaw_studies.grid import Grid

STRESSES = ("pressure", "traction", "traction_bound")
"""Variables along the patch that a title calls stresses."""

TOGETHER = 0.4
"""Distance from the first to the last point of a patch; the next patch is at a distance of 1."""

MOST_MAPS = 6
"""Most panels of a map."""

LEAST = 4
"""Fewest values of each axis of a map that is made without being asked for."""

DECADES = 30.0
"""Ratio of the largest to the smallest value beyond which a scale that nobody chose is logarithmic."""

Spans: TypeAlias = list[tuple[float, float]]


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
            log = first != BY_PATCH and (spacing == "log" or fit_for_log(along(sweep, axis)[outcome.name].values))
            for x in (first,) if first == BY_PATCH else ("wear_index", first):
                y_scale: Scale = "log" if log and not outcome.signed else "linear"
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


def axes_of_map(sweep: xarray.Dataset, creepage: str | None) -> tuple[str, str] | None:
    """Return the axes of the map of a sweep: its main axis and the longest other one, None if these are too short."""
    if len(axes_of(sweep)) < 2:
        return None
    first = main_axis(sweep, creepage)
    second = max((axis for axis in axes_of(sweep) if axis != first), key=lambda axis: sweep.sizes[axis])
    return (first, second) if min(sweep.sizes[first], sweep.sizes[second]) >= LEAST else None


def fit_for_log(*values: Array) -> bool:
    """Return whether values that nobody chose a scale for are better seen on a logarithmic one."""
    found = np.concatenate([np.ravel(one) for one in values]) if values else np.zeros(0)
    seen = found[np.isfinite(found)]
    return bool(seen.size and seen.min() > 0.0 and seen.max() > DECADES * seen.min())


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
        elif not _is_point(results, spec):
            words += f" over {name_of(spec.x)}"
    return words[:1].upper() + words[1:]


def _is_point(results: Results, spec: FigureSpec) -> bool:
    """Return whether a figure shows the one operating point of a sweep with one patch."""
    sweep = results.sweeps.get(spec.sweep or "")
    return sweep is not None and not (axes_of(sweep) or is_of_patches(sweep) or spec.measured)


def _figure(results: Results, name: str, spec: FigureSpec, title: str) -> FigureData:
    grid = results.case.sweeps[spec.sweep] if spec.sweep else results.case.profiles[spec.profile or ""]
    units = results.case.result_units | grid.written_units()
    axis, point = axis_along(grid, spec.x, results.case.rig.creepage) if spec.sweep else "", _is_point(results, spec)
    fixed = _conditions(grid, {spec.x, *spec.shown} if spec.map else {"" if point else axis}, units)
    more, heads = "", []
    if spec.map:
        panels, left_out = _maps(results, spec, units)
        if left_out:
            more = f" {left_out} more are left out; choose among them with pairs, contact_models or patches."
    elif point:
        panels = [_points(results, spec, window, units) for window in spec.windows()]
    else:
        heads = [text for condition, text in fixed.items() if condition in grid.axes()]
        panels = [_panel(results, spec, window, axis, heads, units) for window in spec.windows()]
    if any(not panel.curves and panel.map is None for panel in panels) or not panels:
        more = " None of the chosen patches exists here."
    head, below = results.case.title, ", ".join(text for text in fixed.values() if text not in heads)
    return FigureData(
        name=name,
        title=title,
        panels=tuple(panels),
        caption=spec.caption or f"At {', '.join(fixed.values())}.{more}",
        conditions=f"{head}: {below}" if below else head,
    )


def _conditions(grid: Grid, free: Collection[str], units: Mapping[str, str]) -> dict[str, str]:
    """Return the conditions of a figure in words, without those that vary in it; axes are at their middle value."""
    found = {}
    for name in grid.given:
        if name not in free:
            level = grid.level(name, units)
            shown = level if isinstance(level, str) else f"{level:.5g} {units[name]}"
            found[name] = f"{name_of(name)} {shown}".rstrip()
    return found


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
        found = self.data.outside_range if "outside_range" in self.data else None
        return None if found is None or "pair" in found.dims else found.values > 0.0

    def ends(self) -> dict[str, Any]:
        """Return the ends of the band of an outcome, if it has one."""
        low, high = (self.data.get(f"{self.variable}{end}") for end in ("_low", "_high"))
        if low is None or high is None or "pair" in low.dims or not bool((high > low).any()):
            return {}
        return {"low": low.values, "high": high.values}

    def beyond(self) -> dict[str, xarray.DataArray]:
        """Return where the contact is beyond each limit."""
        limits = beyond_limits(self.data).items()
        return {name: one.any("contact_model") if "contact_model" in one.dims else one for name, one in limits}


def _series(
    results: Results, data: xarray.Dataset, spec: FigureSpec, variable: str, names: Collection[str]
) -> Iterator[_Series]:
    """Yield what data hold of a variable: for each pair that predicts it, or for each model that `names` depend on."""
    dims = {dim for name in names for dim in data[name].dims}
    models, laws = (list(one) for one in (results.case.contact_models_by_label, results.case.laws_by_label))
    chosen = spec.contact_models or data.contact_model.values.tolist()
    if "pair" in dims:
        for pair in map(results.pair, predicting(results, variable, spec.pairs or data.pair.values.tolist())):
            if pair.contact_model in chosen:
                at = {"pair": pair.label, "contact_model": pair.contact_model}
                style = laws.index(pair.law), models.index(pair.contact_model)
                yield _Series(variable, pair.label, data.sel(at), style)
    elif "contact_model" in dims:
        for model in chosen:
            yield _Series(variable, model, data.sel(contact_model=model), (models.index(model), models.index(model)))
    else:
        yield _Series(variable, "", data, (0, 0))


# Curves over a sweep


def _panel(
    results: Results, spec: FigureSpec, window: Window, axis: str, heads: list[str], shown_units: Mapping[str, str]
) -> Panel:
    """Return a panel of curves, with its x axis in the unit of the case's own file."""
    units, x = results.case.result_units, spec.x
    if spec.sweep:
        curves, spans = _over_sweep(results, spec, window, axis, shown_units)
        units = {**units, x: shown_units.get(x, "")}
    else:
        profile = results.profiles[spec.profile or ""]
        across = "y" in profile
        curves, spans = (_across_the_patch if across else _along_the_patch)(results, profile, spec, window)
        if across:
            x, body = "y", _body(results, window)
            units = units | {name: profile[f"{body}_{name}"].attrs["units"] for name in window.shown}
    if x == BY_PATCH:
        sweep = results.sweeps[spec.sweep or ""]
        names = tuple(map(in_words, patches_of(middle_of(sweep), window.patches)))
        x_ends = (-0.5, len(names) - 0.5) if names else None
        x_axis = PlotAxis(", ".join(map(name_of, patch_axes(sweep))), ends=x_ends, names=names)
    else:
        # A logarithmic axis hides values that are not positive, as at zero creepage.
        scale: Scale = "log" if window.x_scale == "log" and any((c.x > 0).any() for c in curves) else "linear"
        x_axis = PlotAxis(label(x, units=units), scale, _ends(x, units, window.x_range))
    low, high = x_axis.ends or (-np.inf, np.inf)
    seen = tuple(dict.fromkeys((start, end) for start, end in spans if start < high and end > low))
    shades = (Shade(LIMITS[SHAKEDOWN], seen, strip=True),) if seen else ()
    title = ", ".join(filter(None, (window.title, *heads)))
    return Panel(x_axis, _y_axis(x_axis, window, curves, units), curves=tuple(curves), title=title, shades=shades)


def _over_sweep(
    results: Results, spec: FigureSpec, window: Window, axis: str, shown_units: Mapping[str, str]
) -> tuple[list[Curve], Spans]:
    """Return curves of outcomes for each pair, and of other variables for each contact model, by patch.

    Also return where the contact of any of them is beyond shakedown, as spans of x.
    """
    sweep, x, several = results.sweeps[spec.sweep or ""], spec.x, len(window.shown) > 1
    signed = is_of_patches(sweep)  # signs differ from side to side
    curves: list[Curve] = []
    spans: Spans = []
    for patch, line in _lines_of(sweep, x, window, axis):
        found = []
        for number, y in enumerate(window.shown):
            for one in _series(results, line, spec, y, (x, y)):
                own, colour = "pair" in line[y].dims, number if several else one.style[0]
                at, values = _values(one.data[x], signed), _values(one.data[y], signed or own)
                if x != BY_PATCH:
                    at = _converted(at, results.case.result_units[x], shown_units[x])
                values = np.broadcast_to(values, at.shape)
                style = one.style if own else (colour, one.style[1])
                outside = one.outside if own else None
                found.append(Curve(one.label(several), at, values, *style, outside=outside, **one.ends()))
                seen = (at > 0.0) | (window.x_scale != "log")
                beyond = one.beyond()
                if SHAKEDOWN in beyond:
                    spans += spans_of(at[seen], beyond[SHAKEDOWN].values[seen])
        if x == BY_PATCH:
            beside = TOGETHER * (np.linspace(-0.5, 0.5, len(found)) if len(found) > 1 else np.zeros(1))
            curves += [
                replace(curve, x=curve.x + shift, colour=number, dash=0, points=True, hollow=True)
                for number, (curve, shift) in enumerate(zip(found, beside, strict=False))
            ]
        else:
            curves += _coloured(found, patch, sweep) if patch else found
    return curves + [_measured(results, x, y) for y in window.shown if spec.measured], spans


def _values(one: xarray.DataArray, signed: bool) -> Array:
    found: Any = one.values if signed else abs(one.values)
    values: Array = found
    return values


def _lines_of(sweep: xarray.Dataset, x: str, window: Window, axis: str) -> Iterator[tuple[Patch, xarray.Dataset]]:
    """Yield each existing patch that a panel shows, with the sweep along an axis; or all of them as one axis."""
    if x == BY_PATCH:
        point = middle_of(sweep)
        if patches_of(point, window.patches):
            yield {}, by_patch(point, window.patches)
        return
    line = along(sweep, axis)
    for patch in patches_of(line, window.patches):
        yield patch, line.sel(patch)


def _coloured(curves: list[Curve], patch: Patch, dataset: xarray.Dataset) -> list[Curve]:
    """Return the curves of a patch with its label and colour, which is the same in all figures."""
    colour = possible_patches(dataset).index(patch)
    return [
        replace(curve, label=labelled_by(patch, curve.label), colour=colour, dash=number)
        for number, curve in enumerate(curves)
    ]


def _converted(values: Array, unit: str, shown: str) -> Array:
    """Return values of a unit in the unit in which a figure shows them."""
    found: Array = values if unit == shown else Q(values, unit).to(shown).magnitude
    return found


def spans_of(x: Array, beyond: NDArray[np.bool_]) -> Iterator[tuple[float, float]]:
    """Yield the ends of each run of points beyond a limit, half-way to the next point on either side."""
    known = np.flatnonzero(np.isfinite(x))
    order = known[np.argsort(x[known], kind="stable")]
    x, beyond = x[order], beyond[order]
    steps = np.flatnonzero(np.diff(np.concatenate([[False], beyond, [False]]).astype(int)))
    edges = np.concatenate([x[:1], 0.5 * (x[1:] + x[:-1]), x[-1:]])
    for first, after in zip(steps[::2], steps[1::2], strict=True):
        yield float(edges[first]), float(edges[after])


def _measured(results: Results, x: str, y: str) -> Curve:
    """Return the measured points, as magnitudes like all curves over a sweep."""
    measured = results.case.measured
    assert measured is not None
    values = measured_points(measured.data, results.case.rig)
    along, across = abs(values[x]), abs(values[y])
    there = np.isfinite(along) & np.isfinite(across)
    found = Curve(measured.label, along[there], across[there], BLACK, points=True)
    uncertainty = measured.data.wear_rate_uncertainty if y == "wear_rate" else None
    if uncertainty is None:
        return found
    spread = uncertainty.to(UNITS[y]).magnitude[there]
    return replace(found, low=found.y - spread, high=found.y + spread)


# Profiles of the patch


def _body(results: Results, window: Window) -> str:
    """Return the body whose wear a panel shows."""
    return window.body or next(iter(results.case.rig.bodies))


def _along_the_patch(
    results: Results, profile: xarray.Dataset, spec: FigureSpec, window: Window
) -> tuple[list[Curve], Spans]:
    """Return curves along the patch: outcomes for each pair, other variables for each contact model."""
    curves: list[Curve] = []
    spans: Spans = []
    grid = results.case.profiles[spec.profile or ""]
    problem = grid.problem(results.case.rig)
    half = 0.0 if problem.dims else 1e3 * float(np.ravel(problem.half_width)[0])
    for patch in patches_of(profile, window.patches):
        found, here = [], profile.sel(patch)
        for variable in window.shown:
            if variable == "creepage":
                along, units = results.case.rig.creepage, results.case.units
                at = grid.level(along, units) if along else 100.0 * float(np.ravel(problem.longitudinal_creepage)[0])
                level = np.full(2, at)
                colour = OF_PROFILE.index(variable)
                found.append(Curve(name_of(variable), here.x.values[[0, -1]], level, colour))
                continue
            every = list(_series(results, here, spec, variable, (variable,)))
            own = "pair" in here[variable].dims
            for one in every[:1] if variable == "pressure" else every:  # all contact models have Hertz's pressure
                x, y = _at_nodes(one.data, variable, "x")
                if own:
                    outside = np.full(y.shape, bool(one.outside))
                    curve = Curve(one.label(len(window.shown) > 1), x, y, *one.style, outside=outside)
                else:
                    dash = 0 if variable == "pressure" else one.style[1]
                    named = name_of(variable) if variable == "pressure" else one.label(several=True)
                    curve = Curve(named, x, y, OF_PROFILE.index(variable), dash)
                found.append(_to_the_edges(curve, half) if half and variable in STRESSES else curve)
                spans += _whole(one, found[-1])
        curves += _coloured(found, patch, profile) if patch else found
    return curves, spans


def _across_the_patch(
    results: Results, profile: xarray.Dataset, spec: FigureSpec, window: Window
) -> tuple[list[Curve], Spans]:
    """Return curves across the patch for a body: depth for each pair, sliding distance for each contact model.

    At the edges, where the patch has no length, both are zero.
    """
    curves: list[Curve] = []
    spans: Spans = []
    body = _body(results, window)
    problem = results.case.profiles[spec.profile or ""].problem(results.case.rig)
    half = 1e3 * float(np.ravel(problem.b)[0]) if problem.geometry == "ellipse" and not problem.dims else 0.0
    for patch in patches_of(profile, window.patches):
        found = []
        for name in (f"{body}_{variable}" for variable in window.shown):
            own = "pair" in profile[name].dims
            for one in _series(results, profile.sel(patch), spec, "wear_rate" if own else name, (name,)):
                x, y = _at_nodes(one.data, name, "y")
                if not y.size:  # a law for the other body
                    continue
                outside = np.full(y.shape, results.is_outside(profile.sel(patch), one.of, body)) if own else None
                curve = Curve(one.of, x, y, *one.style, outside=outside)
                found.append(_to_the_edges(curve, half) if half else curve)
                spans += _whole(one, found[-1])
        curves += _coloured(found, patch, profile) if patch else found
    return curves, spans


def _whole(one: _Series, curve: Curve) -> Spans:
    """Return the ends of a curve over a patch if the contact is beyond shakedown."""
    beyond = one.beyond().get(SHAKEDOWN)
    there = beyond is not None and bool(beyond) and curve.x.size
    return [(float(curve.x.min()), float(curve.x.max()))] if there else []


def _to_the_edges(curve: Curve, half: float) -> Curve:
    """Return a curve over a patch of this half width with its ends, where it is zero; nodes lie inside."""
    if not curve.x.size or abs(curve.x).max() >= half:
        return curve
    ends = (-half, half) if curve.x[0] <= curve.x[-1] else (half, -half)
    x, y = np.concatenate([ends[:1], curve.x, ends[1:]]), np.concatenate([[0.0], curve.y, [0.0]])
    return replace(curve, x=x, y=y, outside=None if curve.outside is None else np.pad(curve.outside, 1, mode="edge"))


def _at_nodes(data: xarray.Dataset, variable: str, position: str) -> tuple[Array, Array]:
    """Return the positions of the nodes of a contact model, and the values of a variable there."""
    there = data[variable].notnull().values
    return data[position].values[there], data[variable].values[there]


# One operating point, and maps


def _points(results: Results, spec: FigureSpec, window: Window, units: Mapping[str, str]) -> Panel:
    """Return a panel with a point for each pair, or for each contact model, at the one point of a sweep."""
    point, several = results.sweeps[spec.sweep or ""], len(window.shown) > 1
    found = [one for y in window.shown for one in _series(results, point, spec, y, (y,))]
    names = tuple(one.label(several) for one in found)
    curves = []
    for number, (one, name) in enumerate(zip(found, names, strict=True)):
        own = "pair" in point[one.variable].dims
        value = _values(one.data[one.variable], own)
        shown: dict[str, Any] = {**one.ends(), **({"outside": one.outside} if own else {})}
        shown = {field: np.atleast_1d(values) for field, values in shown.items()}
        place = np.array([float(number)])
        curves.append(Curve(name, np.atleast_1d(value), place, one.style[0], points=True, hollow=True, **shown))
    values = [one for curve in curves for one in (curve.x, curve.low, curve.high) if one is not None]
    log = window.y_scale == "log" or (window.y_scale is None and fit_for_log(*values))
    return Panel(
        PlotAxis(label(*window.shown, units=units), "log" if log else "linear",
                 _ends(window.shown[0], units, window.y_range)),
        PlotAxis("", ends=(-0.5, len(names) - 0.5), inverted=True, names=names),
        tuple(curves),
        window.title,
    )  # fmt: skip


def _maps(results: Results, spec: FigureSpec, units: Mapping[str, str]) -> tuple[list[Panel], int]:
    """Return a panel for each pair or contact model and patch, and how many more there would be."""
    sweep, grid = results.sweeps[spec.sweep or ""], results.case.sweeps[spec.sweep or ""]
    variable, x, y = spec.map or "", spec.x, spec.shown[0]
    plane = sweep.isel({axis: sweep.sizes[axis] // 2 for axis in axes_of(sweep) if axis not in (x, y)})
    found = [
        (patch, one)
        for patch in patches_of(plane, spec.patches)
        for one in _series(results, plane.sel(patch), spec, variable, (variable,))
    ]
    signed, own = is_of_patches(sweep), "pair" in plane[variable].dims
    values = [_values(one.data[variable].transpose(y, x), signed or own) for _, one in found]
    log = variable not in results.case.outcomes or not results.case.outcomes[variable].signed
    scale: Scale = "log" if log and fit_for_log(*values) else "linear"
    axes, places = [], []
    for name, chosen, given in ((x, spec.x_scale, spec.x_range), (y, spec.y_scale, spec.y_range)):
        at = _converted(plane[name].values, results.case.result_units[name], units[name])
        spacing: Any = (chosen or grid.spacing(name)) if (at > 0.0).all() else "linear"
        axes.append(PlotAxis(label(name, units=units), spacing, _ends(name, units, given)))
        places.append(at)
    panels = []
    for (patch, one), shown in zip(found[:MOST_MAPS], values, strict=False):
        regions = {LIMITS[limit]: region.transpose(y, x).values for limit, region in one.beyond().items()}
        if own:
            regions[OUTSIDE] = one.data.outside_range.transpose(y, x).values > 0.0
        whole = (f"all {words}" for words, region in regions.items() if region.all())  # no border shows them
        title = ", ".join(filter(None, (one.of, in_words(patch), *whole)))
        drawn = Map(label(variable, units=units), places[0], places[1], shown, scale, regions)
        panels.append(Panel(axes[0], axes[1], (), title, map=drawn))
    return panels, len(found) - len(panels)


# Axes


def _ends(variable: str, units: Mapping[str, str], given: Range | None) -> tuple[float, float] | None:
    return ends(variable, units[variable], given) if given else None


def _y_axis(x_axis: PlotAxis, window: Window, curves: list[Curve], units: Mapping[str, str]) -> PlotAxis:
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
    y_ends = _ends(window.shown[0], units, window.y_range)
    if y_ends is None and scale == "log":
        y_ends = (positive.min() / 1.5, positive.max() * 1.5) if x_axis.ends else None
    elif y_ends is None:
        y_ends = (0.0, 1.05 * seen.max()) if positive.size and seen.min() >= 0.0 else None
    return PlotAxis(label(*window.shown, units=units), scale, y_ends)
