"""Panels without curves: maps over two axes of a sweep, and bars for one operating point."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

import numpy as np
import xarray

from wearlaw.figures.curves import OUTSIDE, Curve, Map, Panel, PlotAxis
from wearlaw.study.figure_spec import FigureSpec, Range, Scale, Window, ends
from wearlaw.study.results import (
    LIMITS,
    Patch,
    Results,
    along,
    axes_of,
    beyond_limits,
    in_words,
    is_of_patches,
    main_axis,
    patches_of,
    predicting,
)
from wearlaw.units.quantities import Q
from wearlaw.units.variables import label, name_of

if TYPE_CHECKING:
    from wearlaw.arrays.array import Array

MOST_MAPS = 6
"""Most panels of a map."""

LEAST = 4
"""Fewest values of each axis of a map that is made without being asked for."""

DECADES = 30.0
"""Ratio of the largest to the smallest value beyond which a scale that nobody chose is logarithmic."""

BAR = 0.7
"""Thickness of a bar; the next one is at a distance of 1."""


def axes_of_map(sweep: xarray.Dataset, creepage: str) -> tuple[str, str] | None:
    """Return the axes of the map of a sweep: its main axis and the longest other one, None if these are too short."""
    if len(axes_of(sweep)) < 2:
        return None
    first = main_axis(sweep, creepage)
    second = max((axis for axis in axes_of(sweep) if axis != first), key=lambda axis: sweep.sizes[axis])
    return (first, second) if min(sweep.sizes[first], sweep.sizes[second]) >= LEAST else None


def converted(values: Array, unit: str, shown: str) -> Array:
    """Return values of a unit in the unit in which a figure shows them."""
    found: Array = values if unit == shown else Q(values, unit).to(shown).magnitude
    return found


def fit_for_log(*values: Array) -> bool:
    """Return whether values that nobody chose a scale for are better seen on a logarithmic one."""
    found = np.concatenate([np.ravel(one) for one in values]) if values else np.zeros(0)
    seen = found[np.isfinite(found)]
    return bool(seen.size and seen.min() > 0.0 and seen.max() > DECADES * seen.min())


def maps(results: Results, spec: FigureSpec, units: Mapping[str, str]) -> tuple[list[Panel], int]:
    """Return a panel for each pair or contact model and patch, and how many more there would be."""
    sweep, grid = results.sweeps[spec.sweep or ""], results.case.sweeps[spec.sweep or ""]
    x, y = spec.x, spec.shown[0]
    others = [axis for axis in axes_of(sweep) if axis not in (x, y)]
    plane = sweep.isel({axis: sweep.sizes[axis] // 2 for axis in others})
    found = list(_shown(results, plane, spec))
    every = [values for *_, values in found]
    log = spec.map not in results.case.outcomes or not results.case.outcomes[spec.map].signed
    scale: Scale = "log" if log and fit_for_log(*every) else "linear"
    along_x, along_y = (converted(plane[axis].values, results.case.result_units[axis], units[axis]) for axis in (x, y))
    x_axis = _axis(x, along_x, grid.spacing(x), spec.x_scale, spec.x_range, units)
    y_axis = _axis(y, along_y, grid.spacing(y), spec.y_scale, spec.y_range, units)
    head = label(spec.map or "", units=units)
    panels = []
    for title, patch, pair, model, values in found[:MOST_MAPS]:
        borders = _borders(plane, patch, pair, model, x, y)
        panels.append(Panel(x_axis, y_axis, (), title, map=Map(head, along_x, along_y, values, scale, borders)))
    return panels, len(found) - len(panels)


def _axis(
    name: str, values: Array, spacing: Scale, scale: Scale | None, given: Range | None, units: Mapping[str, str]
) -> PlotAxis:
    """Return an axis of a map, of the spacing of its values unless the figure has a scale."""
    limits = ends(name, units[name], given) if given else None
    chosen = (scale or spacing) if (values > 0.0).all() else "linear"
    return PlotAxis(label(name, units=units), chosen, limits)


def _shown(
    results: Results, plane: xarray.Dataset, spec: FigureSpec
) -> Iterator[tuple[str, Patch, str | None, str | None, Array]]:
    """Yield the title, the patch, the pair and the contact model of each panel of a map, with its values (y, x)."""
    variable = spec.map or ""
    for patch in patches_of(plane, spec.patches):
        here = plane.sel(patch)
        one = here[variable] if is_of_patches(here) or "pair" in here[variable].dims else abs(here[variable])
        if "pair" in one.dims:
            kinds: list[tuple[str | None, str | None]] = [
                (pair, results.pair(pair).contact_model)
                for pair in predicting(results, variable, spec.pairs or plane.pair.values.tolist())
            ]
        elif "contact_model" in one.dims:
            kinds = [(None, model) for model in spec.contact_models or plane.contact_model.values.tolist()]
        else:
            kinds = [(None, None)]
        for pair, model in kinds:
            at = {"pair": pair} if pair else {"contact_model": model} if model else {}
            values = one.sel(at).transpose(spec.shown[0], spec.x).values
            yield ", ".join(filter(None, (pair or model, in_words(patch)))), patch, pair, model, values


def _borders(
    plane: xarray.Dataset, patch: Patch, pair: str | None, model: str | None, x: str, y: str
) -> dict[str, np.ndarray]:
    """Return where the contact is beyond a limit, and where the law of a pair is outside its range."""
    here = plane.sel(patch)
    regions = {LIMITS[limit]: one for limit, one in beyond_limits(here).items()}
    if pair is not None:
        regions[OUTSIDE] = here.outside_range.sel(pair=pair) > 0.0
    found = {}
    for words, region in regions.items():
        one = region.sel(contact_model=model) if model and "contact_model" in region.dims else region
        found[words] = (one.any("contact_model") if "contact_model" in one.dims else one).transpose(y, x).values
    return found


def whole_maps(panels: list[Panel]) -> str:
    """Return which regions cover the whole of maps, where no border shows them."""
    found: dict[str, list[str]] = {}
    for panel in panels:
        for words, region in panel.map.borders.items() if panel.map else ():
            if region.all():
                found.setdefault(words, []).append(panel.title)
    return "".join(
        f" {'All' if len(titles) == len(panels) else ' and '.join(titles) + ': all'} {words}."
        for words, titles in found.items()
    )


def bars(results: Results, spec: FigureSpec, window: Window, units: Mapping[str, str]) -> Panel:
    """Return a panel with a bar for each pair, or for each contact model, at the one point of a sweep."""
    sweep = results.sweeps[spec.sweep or ""]
    point = along(sweep, main_axis(sweep, results.case.rig.creepage))
    first = window.shown[0]
    found: list[Curve] = []
    names: list[str] = []
    for variable in window.shown:
        one = point[variable] if "pair" in point[variable].dims else abs(point[variable])
        if "pair" in one.dims:
            kind, labels = "pair", predicting(results, variable, spec.pairs or point.pair.values.tolist())
        elif "contact_model" in one.dims:
            kind, labels = "contact_model", list(spec.contact_models or point.contact_model.values.tolist())
        else:
            kind, labels = "", [""]
        for bar in labels:
            at = {kind: bar} if kind else {}
            low, high = (point[f"{variable}{end}"].sel(at).values if kind == "pair" and f"{variable}{end}" in point
                         else None for end in ("_low", "_high"))  # fmt: skip
            spread = low is not None and high is not None and bool((high > low).any())
            several = name_of(variable) if len(window.shown) > 1 or not bar else ""
            names.append(", ".join(filter(None, (several, bar))))
            found.append(
                Curve(
                    names[-1], one.sel(at).values, np.array([len(names) - 1.0]), colour=_colour(results, kind, bar),
                    low=low if spread else None, high=high if spread else None,
                    outside=point.outside_range.sel(at).values > 0.0 if kind == "pair" else None, bars=BAR,
                )
            )  # fmt: skip
    x_ends = ends(first, units[first], window.y_range) if window.y_range else None
    return Panel(
        PlotAxis(label(*window.shown, units=units), ends=x_ends),
        PlotAxis("", ends=(-0.5, len(names) - 0.5), inverted=True, names=tuple(names)),
        tuple(found),
        window.title,
    )


def _colour(results: Results, kind: str, bar: str) -> int:
    """Return the colour of a pair's law or of a contact model, as in other figures."""
    if kind == "pair":
        return list(results.case.laws_by_label).index(results.pair(bar).law)
    return list(results.case.contact_models_by_label).index(bar) if kind else 0


def limits_in_words(sweep: xarray.Dataset) -> str:
    """Return the worst limit that the contact of each model is beyond at one operating point."""
    worst: dict[str, str] = {}
    for limit, beyond in beyond_limits(sweep).items():
        for model in sweep.contact_model.values.tolist():
            if bool(beyond.sel(contact_model=model).any() if "contact_model" in beyond.dims else beyond.any()):
                worst[model] = LIMITS[limit]
    found = [
        f"{words} on {', '.join(one for one in worst if worst[one] == words)}"
        for words in dict.fromkeys(worst.values())
    ]
    if len(worst) == sweep.sizes["contact_model"] and len(found) == 1:
        return f" The contact is {next(iter(worst.values()))}."
    return f" The contact is {' and '.join(found)}." if found else ""
