"""Strips along the x axis of panels where the contact is beyond shakedown, and the lines that panels show."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import xarray

from wearlaw.figures.curves import Curve, Shade
from wearlaw.study.figure_kinds import converted
from wearlaw.study.figure_spec import BY_PATCH, FigureSpec, Window
from wearlaw.study.results import (
    LIMITS,
    SHAKEDOWN,
    Patch,
    Results,
    along,
    beyond_limits,
    by_patch,
    is_of_patches,
    middle_of,
    patches_of,
    predicting,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from wearlaw.arrays.array import Array


def lines_of(
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


def values_of(line: xarray.Dataset, variable: str, model: str) -> Array:
    """Return the magnitude of a variable, for one contact model if it depends on the model.

    If the rig makes several patches, the values keep their signs, which differ from side to side.
    """
    values = line[variable]
    found = values.sel(contact_model=model) if "contact_model" in values.dims else values
    shown: Array = (found if is_of_patches(line) else abs(found)).values
    return shown


def shade_in(shade: Shade, unit: str, shown: str) -> Shade:
    """Return a shade with the ends of its spans in another unit."""
    spans = converted(np.array(shade.spans), unit, shown)
    return replace(shade, spans=tuple((float(low), float(high)) for low, high in spans))


def beyond_shakedown(results: Results, spec: FigureSpec, window: Window, axis: str) -> tuple[Shade, ...]:
    """Return a strip where the contact of any model of a panel is beyond shakedown, over a sweep."""
    sweep = results.sweeps[spec.sweep or ""]
    models = spec.contact_models or sweep.contact_model.values.tolist()
    if all("pair" in sweep[y].dims for y in window.shown):
        every = sweep.pair.values.tolist()
        pairs = [pair for y in window.shown for pair in predicting(results, y, spec.pairs or every)]
        models = sweep.pair_contact_model.sel(pair=pairs).values.tolist()
    spans: list[tuple[float, float]] = []
    for _, line in lines_of(sweep, spec, window, axis):
        beyond = beyond_limits(line).get(SHAKEDOWN)
        if beyond is None:
            continue
        for model in dict.fromkeys(models):
            x = values_of(line, spec.x, model)
            shown = (x > 0.0) | (window.x_scale != "log")
            spans += spans_of(x[shown], beyond.sel(contact_model=model).values[shown])
    return (Shade(LIMITS[SHAKEDOWN], tuple(merged(spans)), strip=True),) if spans else ()


def beyond_shakedown_in_patch(
    profile: xarray.Dataset, spec: FigureSpec, window: Window, curves: list[Curve]
) -> tuple[Shade, ...]:
    """Return a strip over the whole patch if the contact of any model is beyond shakedown."""
    beyond = beyond_limits(profile).get(SHAKEDOWN)
    models = list(spec.contact_models or profile.contact_model.values)
    patches = patches_of(profile, window.patches)
    if not curves or beyond is None or not any(beyond.sel({"contact_model": models, **one}).any() for one in patches):
        return ()
    x = np.concatenate([curve.x for curve in curves])
    return (Shade(LIMITS[SHAKEDOWN], ((float(x.min()), float(x.max())),), strip=True),)


def spans_of(x: Array, beyond: NDArray[np.bool_]) -> Iterator[tuple[float, float]]:
    """Yield the ends of each run of points beyond a limit, half-way to the next point on either side."""
    known = np.flatnonzero(np.isfinite(x))
    order = known[np.argsort(x[known], kind="stable")]
    x, beyond = x[order], beyond[order]
    steps = np.flatnonzero(np.diff(np.concatenate([[False], beyond, [False]]).astype(int)))
    edges = np.concatenate([x[:1], 0.5 * (x[1:] + x[:-1]), x[-1:]])
    for first, after in zip(steps[::2], steps[1::2], strict=True):
        yield float(edges[first]), float(edges[after])


def merged(spans: Iterable[tuple[float, float]]) -> Iterator[tuple[float, float]]:
    """Yield the union of spans as spans that do not touch."""
    start, end = np.inf, -np.inf
    for low, high in sorted(spans):
        if low > end and start <= end:
            yield start, end
        start, end = (low, high) if low > end else (start, max(end, high))
    if start <= end:
        yield start, end
