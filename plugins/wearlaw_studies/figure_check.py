"""Checks that a case can fill its figures, made when the case is read, not after it has run."""

from __future__ import annotations

import warnings
from collections.abc import Collection, Iterator, Mapping
from typing import TYPE_CHECKING, Any, TypeAlias

from wearlaw.contact.conditions import LOADS
from wearlaw.errors import Fault, UnitError, WearlawError, WearlawWarning, did_you_mean, shown
from wearlaw.models.law import WEAR
from wearlaw.pipeline.notes import Notes
from wearlaw.pipeline.variables import MASS, OF_CONTACT, OF_PATCH, OF_POINT, offered
from wearlaw.units.variables import UNITS
from wearlaw_fits.pairs import Pair
from wearlaw_studies.figure_spec import ACROSS, BY_PATCH, OF_LOAD, OF_PROFILE, FigureSpec, Window, axis_along, ends
from wearlaw_studies.measured import known_variables
from wearlaw_studies.pairs import pairs_of

if TYPE_CHECKING:
    from wearlaw_studies.grid import Grid

AnyCase: TypeAlias = Any
"""A `Case`, which imports this file."""

LONGEST_NAME = 100
"""Most bytes of the name of a sweep, profile or figure; file systems allow 255 for it with what files add to it."""


def wrong_name(name: str) -> str:
    """Return what keeps a name in a case from being part of the name of a file, or "" if it can be."""
    if not name.isidentifier():
        return "must be made of letters, digits and underscores"
    size = len(name.encode())
    return f"has {size} bytes, but {LONGEST_NAME} are the most" if size > LONGEST_NAME else ""


def wrong_figures(case: AnyCase) -> Iterator[Fault]:
    """Yield the faults of the figures of a case: names in them that it does not have, and units that do not fit."""
    for name in case.figures:
        if fault := wrong_name(name):
            yield Fault(("figures", name), f"the name {fault}")
    try:
        notes = Notes()
        pairs = pairs_of(case, notes) if case.figures else []
    except WearlawError:  # running the case says why there are none
        return
    for name, spec in case.figures.items():
        kind, grids = ("sweep", case.sweeps) if spec.sweep else ("profile", case.profiles)
        asked = spec.sweep or spec.profile or ""
        if asked not in grids:
            yield Fault(("figures", name, kind), f"the case has no {kind} {_choice(asked, grids)}")
            continue
        for path, message in _wrong_figure(case, spec, grids[asked], pairs, notes):
            yield Fault(("figures", name, *path.split(".")), message)


def _wrong_figure(
    case: AnyCase, spec: FigureSpec, grid: Grid, pairs: list[Pair], notes: Notes
) -> Iterator[tuple[str, str]]:
    usable = [pair for pair in pairs if "traction_coefficient" not in grid.given
              or pair.pipeline.contact_model.uses_measured_traction]  # fmt: skip
    if spec.profile:
        usable = [pair for pair in usable if pair.pipeline.scale == "cells"]
    if not usable:
        yield "profile" if spec.profile else "sweep", "no pair of the case has results there"
        return
    x, y, patches = known_variables_of(case, grid, usable, bool(spec.profile))
    labels = {pair.label: pair.outcome.name for pair in usable}
    yield from _unknown("pairs", spec.pairs or (), labels)
    yield from _unknown("contact_models", spec.contact_models or (), {pair.contact_model for pair in usable})
    if spec.map:
        for path, axis in (("x", spec.x), ("y", spec.shown[0])):
            yield from _unknown(path, [axis], grid.axes(), "is not an axis of the sweep")
        yield from _unknown("map", [spec.map], y)
        return
    yield from _unknown("x", [spec.x], x)
    if spec.sweep and spec.x in x and _is_constant(case, spec.x, grid, bool(patches)):
        yield "x", f"{spec.x} is the same at all points of the sweep; give one of its axes: {', '.join(grid.axes())}"
    for number, window in enumerate(spec.windows()):
        path = f"panels.{number}." if spec.panels else ""
        yield from (
            (f"{path}{name}", message) for name, message in _wrong_window(case, spec, window, usable, y, patches)
        )
    outcomes = spec.of_values & {*case.outcomes}
    predicted = {labels[pair] for pair in spec.pairs or labels if pair in labels}
    if outcomes - predicted:
        why = "".join(f"; {text}" for text in notes.texts if "is left out" in text)
        yield (
            "pairs" if spec.pairs else "y",
            f"none of the pairs predicts {' or '.join(sorted(outcomes - predicted))}{why}",
        )
    if spec.measured:
        tests = known_variables(case.measured.data) if case.measured else ()
        yield from _unknown("measured", {spec.x, *spec.of_values}, tests, "is not known for the tests of [measured]")


def known_variables_of(
    case: AnyCase, grid: Grid, pairs: list[Pair], profile: bool
) -> tuple[list[str], list[str], Mapping[str, Collection[str | int]]]:
    """Return the variables of a sweep or profile for each axis, and the labels along each axis of the patches.

    They are found by predicting the first operating point with each contact model.
    """
    problem = grid.problem(case.rig)
    if profile and problem.geometry != "line":
        return ["x", "y"], [*ACROSS], problem.dims
    if profile:
        local = [name for name, outcome in case.outcomes.items() if outcome.of == "area mean"]
        left_out = {WEAR, *(("creepage",) if problem.dims else ())}  # patches differ in creepage
        return ["x"], [*(name for name in OF_PROFILE if name not in left_out), *local], problem.dims
    every: dict[str, None] = {}
    for pair in {pair.contact_model: pair for pair in pairs}.values():
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", WearlawWarning)  # running the case repeats them
            try:
                prediction = pair.pipeline.without_law().predict(problem)
            except WearlawError:  # running the case says why
                continue
        every |= dict.fromkeys(offered(prediction, (*OF_CONTACT, *OF_POINT, *OF_PATCH)))
    numbers = [name for name in grid.given if isinstance(grid.level(name, case.units), float)]
    x = [*every, *(name for name in numbers if name not in every), *([BY_PATCH] if problem.dims else [])]
    mass = [MASS] if problem.dims and WEAR in case.outcomes else []
    return x, [*case.outcomes, *every, *mass], problem.dims


def _wrong_window(
    case: AnyCase,
    spec: FigureSpec,
    window: Window,
    pairs: list[Pair],
    known: Collection[str],
    patches: Mapping[str, Collection[str | int]],
) -> Iterator[tuple[str, str]]:
    yield from _unknown("y", window.shown, known)
    for axis, labels in (window.patches or {}).items():
        yield from _unknown("patches", [axis], patches, "is not an axis of the rig's patches")
        yield from _unknown(f"patches.{axis}", labels, patches.get(axis, labels))
    bodies = tuple(case.rig.bodies)
    if window.body is not None:
        yield from _unknown("body", [window.body], bodies, "is not a body of the rig")
    body = window.body or next(iter(bodies), "")
    laws = [pair.pipeline.laws[0] for pair in pairs if not spec.pairs or pair.label in spec.pairs]
    if "depth" in window.shown and all(law.body not in (None, body) for law in laws):
        yield "body", f"no wear law shown is for {shown(body)}; name another body, or other pairs"
        return
    units = case.result_units | _units_across(case, spec, window, pairs)
    each = {units[name] for name in window.shown if name in units}
    if len(each) > 1:
        yield "y", f"one axis has one unit, but these are in {', '.join(sorted(each))}; give each a panel of its own"
    for path, name, given, scale in (
        ("x_range", spec.x, window.x_range, window.x_scale),
        ("y_range", window.shown[0], window.y_range, window.y_scale),
    ):
        if given is None or name not in units:
            continue
        try:
            low, high = ends(name, units[name], given)
        except UnitError as error:
            yield path, str(error)
            continue
        if low >= high or (scale == "log" and low <= 0.0):
            yield path, "must run from the lower end to the higher one, above zero on a logarithmic axis"


def _units_across(case: AnyCase, spec: FigureSpec, window: Window, pairs: list[Pair]) -> dict[str, str]:
    """Return the units of what a panel shows across the patch; those of the wear of a body depend on the rig."""
    bodies = tuple(case.rig.bodies)
    body = window.body or next(iter(bodies), "")
    wear = [pair for pair in pairs if pair.outcome.name == WEAR and pair.pipeline.laws[0].body in (None, body)]
    if not (spec.profile and {*window.shown} & {*ACROSS} and wear and body in bodies):
        return {}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", WearlawWarning)  # running the case repeats them
        try:
            found = wear[0].pipeline.predict(case.profiles[spec.profile].problem(case.rig)).wear_profile(body)
        except WearlawError:  # running the case says why
            return {}
    return {str(name): column.attrs["units"] for name, column in found.data_vars.items()}


def _is_constant(case: AnyCase, x: str, grid: Grid, several: bool) -> bool:
    """Return whether nothing changes along the x axis; `several` patches change with any condition."""
    axis = axis_along(grid, x, case.rig.creepage)
    of_point = x in grid.given or (x in OF_POINT and not several)
    unknown = axis not in UNITS and not several
    varies = not of_point or x == axis or unknown or (x in OF_LOAD and axis in LOADS)
    return bool(grid.axes()) and x != BY_PATCH and not varies


def _unknown(
    path: str, given: Collection[str | int], known: Collection[str | int], fault: str = "cannot be shown"
) -> Iterator[tuple[str, str]]:
    """Yield a fault for each name that is not known, with the closest one and all of them."""
    names = [str(name) for name in known]
    for name in given:
        if name not in known:
            yield (
                path,
                f"{shown(str(name))} {fault}{did_you_mean(str(name), names)} There are: {', '.join(names) or 'none'}",
            )


def _choice(asked: str, known: Collection[str]) -> str:
    return f"{shown(asked)}{did_you_mean(asked, known)} There are: {', '.join(known) or 'none'}"
