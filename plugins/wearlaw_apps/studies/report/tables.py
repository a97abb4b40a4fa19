"""The tables of a study: outcomes of its sweeps, its models and their parameters, and the tables of its sections."""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
import pint
import xarray

from wearlaw.configuration import Configuration, field_docstrings
from wearlaw.errors import InputError
from wearlaw.models.law import WEAR, Law
from wearlaw.models.model import Model
from wearlaw.pipeline.variables import MASS
from wearlaw.units.quantities import Q
from wearlaw.units.registry import symbol
from wearlaw.units.variables import name_of
from wearlaw_apps.output.labels import label as label_of
from wearlaw_apps.output.labels import labelled, readable
from wearlaw_apps.output.notes import caught_warnings
from wearlaw_apps.output.styled import Marked, plain_number
from wearlaw_apps.studies.figures import main_result
from wearlaw_apps.studies.results import (
    along,
    axes_of,
    beyond_limits,
    borders_of,
    labelled_by,
    main_axis,
    outcomes_of,
    patches_of,
    predicting,
    together,
)
from wearlaw_apps.studies.sections import Section
from wearlaw_apps.studies.study import Study, used

COLUMNS = 5
"""Number of values on the main axis at which outcomes are shown."""

MOST_NAMED = 3
"""Most pairs in the headline."""

FOOTNOTES = {
    "†": "outside the range, the materials or the body that the law was fitted to",
    "*": "beyond first yield",
    "‡": "beyond shakedown",
}
"""Meanings of the marks of outcomes and depths."""


@dataclass(frozen=True, eq=False)
class NamedTable:
    """A table with its file name, an identifier, its title and footnotes. The heads of its columns hold the units."""

    name: str
    title: str
    frame: pd.DataFrame
    footnotes: tuple[str, ...] = ()


def tables(study: Study) -> list[NamedTable]:
    """Return all tables of a study."""
    sections = (table for section in study.sections for table in of_section(section))
    results = [main_table(study), *summaries(study), *profiles(study)]
    return [*results, parameters(study), *points(study), models(study), *sections]


def of_section(section: Section) -> list[NamedTable]:
    """Return the tables of a section, with their names in words as titles."""
    return [
        NamedTable(name, name.replace("_", " ").strip().capitalize(), frame) for name, frame in section.tables.items()
    ]


def main_table(study: Study) -> NamedTable:
    """Return the main outcome of each pair at a few values of the main axis, and the borders of its law."""
    results, outcome = main_result(study)
    ((name, sweep),) = results.sweeps.items()
    pairs = predicting(study, outcome, sweep.pair.values.tolist())
    frame = summary(sweep, study.case.rig.creepage, outcome, pairs)
    borders = {label: _borders(study.pair(label).pipeline.laws[0]) for label in pairs}
    if any(borders.values()):
        frame["the regime changes at"] = [borders.get(label, "") for label in frame.iloc[:, 0]]
    return _marked("main", _sweep_in_words(study, name, outcome), frame)


def _sweep_in_words(study: Study, name: str, outcome: str) -> str:
    """Return the title of the table of a sweep."""
    together_ = ", all patches together" if outcome == MASS else ""
    return f"Sweep '{name}'{_fixed(study.sweeps[name], study.case.rig.creepage)}{together_}"


def headline(study: Study) -> str:
    """Return the main outcome of the first sweep in a sentence: its range, or at one operating point all that it means.

    Wear at one point has its mass and its depth too, over a distance that leaves the body in being.
    """
    results, outcome = main_result(study)
    ((name, sweep),) = results.sweeps.items()
    unit, parts = readable(sweep[outcome].attrs["units"]), []
    for label in predicting(study, outcome, sweep.pair.values.tolist())[:MOST_NAMED]:
        values = sweep[outcome].sel(pair=label)
        if values.isnull().all():
            continue
        low, high = float(values.min()), float(values.max())
        if axes_of(sweep):
            parts.append(f"{label} {plain_number(low)} to {plain_number(high)} {unit}")
        else:
            more = _as_mass_and_depth(study, name, label) if outcome == WEAR else ""
            parts.append(f"{label} {plain_number(high)} {unit}{more}")
    if not parts:
        return ""
    over = [f"{name_of(axis)} from {_ends(sweep[axis])}" for axis in axes_of(sweep)]
    head = f"{name_of(outcome)}{' over ' if over else ''}{' and '.join(over)}: "
    return f"{head[:1].upper()}{head[1:]}{'; '.join(parts)}."


def _ends(axis: xarray.DataArray) -> str:
    """Return the ends of an axis, as in "0.1 to 20 %"."""
    low, high = (plain_number(end.item()) for end in (axis.min(), axis.max()))
    return f"{low} to {high} {readable(axis.attrs['units'])}".rstrip()


def _as_mass_and_depth(study: Study, name: str, label: str) -> str:
    """Return the wear at the only operating point of a sweep as mass and depth, as in ", 35 mg/km, wheel 1 mm in 9 km".

    The depth is that of 1000 km, or of the power of ten of it in which a body loses at most a tenth of its radius.
    """
    pipeline = study.pair(label).pipeline
    parts = []
    with caught_warnings():  # the study has them
        prediction = pipeline.predict(pipeline.posed(study.case.sweeps[name].written))
        parts.append(f"{_compact(Q(float(prediction.mass_per_distance.m_as('g/km')), 'g'))}/km")
        body = pipeline.laws[0].body or next(iter(study.case.rig.bodies), None)
        if body is not None:
            with suppress(InputError):  # a rail does not turn
                depth = float(prediction.depth_per_distance(body).m_as("m/km"))
                most = 0.1 * float(np.ravel(prediction.problem.body(body).rolling_radius)[0])
                distance = 1000.0
                while depth * distance > most:
                    distance /= 10.0
                parts.append(f"{body} {_compact(Q(depth * distance, 'm'))} in {distance:g} km")
    return "".join(f", {part}" for part in parts)


def _compact(quantity: Any) -> str:
    """Return a quantity in the unit in which it has few digits, such as "1.2 mm" for 0.0012 m."""
    compact = quantity.to_compact()
    return f"{compact.magnitude:.4g} {symbol(compact.units, '~P')}"


def _borders(law: Law) -> str:
    """Return the borders of the regimes of a law in words, "" if there are none."""
    return "; ".join(
        f"{symbol} = {' and '.join(f'{value:.4g}' for value in values)} {unit}".rstrip()
        for symbol, values, unit in borders_of(law).values()
    )


def summaries(study: Study) -> list[NamedTable]:
    """Return a short table of each outcome for each sweep, and of the mass lost at all patches if there are several."""
    creepage = study.case.rig.creepage
    return [
        _marked(
            f"{outcome}_{name}",
            _sweep_in_words(study, name, outcome),
            summary(sweep, creepage, outcome, predicting(study, outcome, sweep.pair.values.tolist())),
        )
        for name, sweep in study.sweeps.items()
        for outcome in (*(outcome.name for outcome in outcomes_of(study, sweep)), *((MASS,) if MASS in sweep else ()))
    ]


def _marked(name: str, title: str, frame: pd.DataFrame) -> NamedTable:
    """Return a table with the footnotes of its marks."""
    marks = "".join(getattr(value, "marks", "") for value in frame.to_numpy().flat)
    return NamedTable(name, title, frame, tuple(f"{mark} {FOOTNOTES[mark]}" for mark in FOOTNOTES if mark in marks))


def _marks(outside: Any, beyond: Mapping[str, xarray.DataArray], model: str) -> list[str]:
    """Return the marks of the operating points of a contact model, from where they are outside and beyond limits."""
    limits = [np.atleast_1d(where.sel(contact_model=model).values) for where in beyond.values()]
    beyond_yield, beyond_shakedown = limits or [np.zeros(np.shape(outside), bool)] * 2
    last = np.where(beyond_shakedown, "‡", np.where(beyond_yield, "*", ""))
    return [str(mark) for mark in np.char.add(np.where(outside, "†", ""), last)]


def _fixed(sweep: xarray.Dataset, creepage: str | None) -> str:
    """Return the values of the other axes at which a sweep is shown, in words."""
    main = main_axis(sweep, creepage)
    line = along(sweep, main)
    others = [axis for axis in axes_of(sweep) if axis != main]
    at = (f"{name_of(axis)} {line[axis].item():.4g} {line[axis].attrs['units']}".rstrip() for axis in others)
    return f" at {', '.join(at)}" if others else ""


def summary(sweep: xarray.Dataset, creepage: str | None, outcome: str, pairs: list[str]) -> pd.DataFrame:
    """Return an outcome at a few values of the main axis, with a row for each pair and for the ends of its band.

    If the rig makes several patches, there is a row for each of them, or one for the sum of `MASS` over all.
    """
    axis = main_axis(sweep, creepage)
    line = along(sweep, axis)
    count = line.sizes[axis]
    line = line.isel({axis: sorted({round(step * (count - 1) / (COLUMNS - 1)) for step in range(COLUMNS)})})
    rows: dict[str, Any] = {}
    low, high = f"{outcome}_low", f"{outcome}_high"
    line = together(line, MASS) if outcome == MASS else line
    for pair, patch in itertools.product(pairs, patches_of(line)):
        here = line.sel(patch)
        of_pair, label = here.sel(pair=pair), labelled_by(patch, pair)
        marks = _marks(of_pair.outside_range.values > 0.0, beyond_limits(here), of_pair.pair_contact_model.item())
        values = {label: of_pair[outcome]}
        if low in of_pair and (of_pair[high] > of_pair[low]).any():
            values |= {f"{label}, low end": of_pair[low], f"{label}, high end": of_pair[high]}
        rows |= {label: list(map(Marked, each.values, marks)) for label, each in values.items()}
    heads = [np.format_float_positional(at, precision=4, fractional=False, trim="-") for at in line[axis].values]
    frame = pd.DataFrame(list(rows.values()), columns=heads, dtype=object)
    units = {name: line[name].attrs["units"] for name in (outcome, axis)}
    what, over = (label_of(name, units=units) for name in units)
    frame.insert(0, f"{what} by {over}", list(rows))
    # The heads round the values, and spell the units for readers.
    frame.attrs |= {"at": line[axis].values.tolist(), "units": list(units.values())}
    return frame


def profiles(study: Study) -> list[NamedTable]:
    """Return a short table for each profile across the patch: the greatest depth on each body, by pair and patch."""
    profile_tables = []
    for name, profile in study.profiles.items():
        if "y" not in profile:
            continue
        depths = {body: profile[f"{body}_depth"] for body in study.case.rig.bodies if f"{body}_depth" in profile}
        rows = [(pair, patch) for pair in profile.pair.values.tolist() for patch in patches_of(profile)]
        columns: dict[str, Any] = {"pair": [labelled_by(patch, pair) for pair, patch in rows]}
        for body, depth in depths.items():
            unit = readable(depth.attrs["units"])
            deepest = [_deepest(study, profile.sel(patch), pair, body) for pair, patch in rows]
            columns[f"{body}: greatest depth [{unit}]"], columns[f"{body}: at y [mm]"] = zip(*deepest, strict=True)
        per = ", ".join(f"{body} {depth.attrs['long_name']}" for body, depth in depths.items())
        frame = pd.DataFrame({head: np.array(values, dtype=object) for head, values in columns.items()})
        profile_tables.append(_marked(f"profile_{name}", f"Profile '{name}': wear across the patch, {per}", frame))
    return profile_tables


def _deepest(study: Study, profile: xarray.Dataset, pair: str, body: str) -> tuple[Marked, float]:
    """Return the greatest depth that a pair gives for a body, with its marks, and its position."""
    depth, model = profile[f"{body}_depth"].sel(pair=pair), study.pair(pair).contact_model
    outside = study.is_for_other_body(pair, body) or bool(profile.outside_range.sel(pair=pair))
    (marks,) = _marks([outside], beyond_limits(profile), model)
    if depth.isnull().all():  # a law for the other body
        return Marked(np.nan, marks), np.nan
    place = profile.y.sel(contact_model=model) if "contact_model" in profile.y.dims else profile.y
    deepest = int(np.nanargmax(depth.values))
    return Marked(depth[deepest].item(), marks), place[deepest].item()


def parameters(study: Study) -> NamedTable:
    """Return every parameter of the rig and of the models."""
    subjects: list[tuple[str, Configuration]] = [("rig", study.case.rig), *_models(study)]
    rows = [(subject, *row) for subject, record in subjects for row in _fields(record)]
    columns = ["of", "parameter", "value", "meaning"]
    return NamedTable("parameters", "Parameters", pd.DataFrame(rows, columns=columns))


def points(study: Study) -> list[NamedTable]:
    """Return a table for each part of the rig whose fields are lists, such as the points of a measured profile."""
    return [
        NamedTable(f"points_of_{name}", f"Points of the {name.replace('_', ' ')}", pd.DataFrame(columns))
        for name, columns in _lists(study.case.rig)
    ]


def _lists(record: Configuration, within: str = "") -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield the names of nested records with lists of numbers, and these lists by heads with units."""
    columns = {}
    for name in type(record).model_fields:
        value = getattr(record, name)
        if isinstance(value, Configuration):
            yield from _lists(value, f"{within}{name}_")
        elif _is_list(value):
            unit = f" [{symbol(value.units, '~C')}]" if isinstance(value, pint.Quantity) else ""
            columns[f"{name}{unit}"] = getattr(value, "magnitude", value)
    if columns:
        yield within.removesuffix("_"), columns


def models(study: Study) -> NamedTable:
    """Return the distribution and the literature source of each model."""
    origins = used(study.case)
    rows = [(label, model.kind, origins[model.kind][model.name], model.source) for label, model in _models(study)]
    columns = ["model", "kind", "provided by", "source"]
    return NamedTable("models", "Models", pd.DataFrame(rows, columns=columns))


def _models(study: Study) -> list[tuple[str, Model]]:
    """Return the contact models of all pairs, the stages around them and the laws, with their labels."""
    used_here = [pair.pipeline.contact_model for pair in study.pairs]
    contact_models = {
        label: model for label, model in labelled(study.case.contact_models).items() if model in used_here
    }
    laws = {pair.law: pair.pipeline.laws[0] for pair in study.pairs}
    return [*contact_models.items(), *labelled(study.case.stages).items(), *laws.items()]


def _fields(record: Configuration, within: str = "") -> Iterator[tuple[str, str, str]]:
    """Yield name, value and meaning of each field that is set, including fields of nested records."""
    for name, meaning in field_docstrings(type(record)).items():
        value = getattr(record, name)
        if isinstance(value, Model):
            yield f"{within}{name}", value.name, meaning
        if isinstance(value, Configuration):
            yield from _fields(value, f"{within}{name}.")
        elif value is not None:
            yield f"{within}{name}", _text(value), meaning


def _text(value: Any) -> str:
    if isinstance(value, pint.Quantity):
        return f"{_number(value.magnitude)} {symbol(value.units, '~P')}".rstrip()
    return _number(value) if isinstance(value, float) or _is_list(value) else str(value)


def _is_list(value: Any) -> bool:
    """Return whether a value is a list of numbers."""
    return np.ndim(value) > 0 and np.asarray(getattr(value, "magnitude", value)).dtype.kind == "f"


def _number(value: Any) -> str:
    """Return a number with 12 digits, or the count and the ends of an array, such as the points of a profile."""
    if np.ndim(value):
        return f"{np.size(value)} values from {_number(np.min(value))} to {_number(np.max(value))}"
    return re.sub("^-", "−", f"{value:.12g}")
