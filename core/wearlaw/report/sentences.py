"""What came out of a study, in sentences: the most and the least wear, changes of regime, and what is not valid.

The sentences are about the main result. Outcomes have three digits, and places on an axis up to four.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import xarray
from numpy.typing import NDArray

from wearlaw.arrays.array import Array
from wearlaw.contact.contact import PATCH_VARIABLES
from wearlaw.errors import WearlawWarning
from wearlaw.models.contact_model import Blame
from wearlaw.models.law import WEAR
from wearlaw.numerics.blocks import blocks
from wearlaw.numerics.integrate import solve
from wearlaw.pipeline.composition import other_materials
from wearlaw.pipeline.pipeline import Rig
from wearlaw.pipeline.variables import MASS
from wearlaw.report.main_result import MainResult
from wearlaw.study.pairs import Pair
from wearlaw.study.results import LIMITS, along_main_axis, beyond_limits, in_words, patch_axes, patches_of
from wearlaw.units.variables import name_of, readable

ALIKE = 1e-3
"""Relative difference below which results count as the same: they show the same three digits."""

NEAR = 0.1
"""Relative distance of neighbouring points beyond which a change is said to be between them.

Within it, linear interpolation of a variable that grows as the n-th power of the place misses the place by less than
(n - 1)/8 × 0.1² of it, so two digits hold.
"""

MOST_SOLVED, MOST_BALANCED = 400, 60
"""Number of points along the main axis at which borders of regimes are sought; fewer if a rig balances its loads."""

SOLVED_AT_ONCE = 32
"""Number of contacts that are held with all their nodes."""

SLIPS = 1e-9
"""Share of the patch that sticks by rounding alone."""

THROUGHOUT = "throughout"
"""Words for all points."""

RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")

Point: TypeAlias = tuple[int, ...]
Mask: TypeAlias = NDArray[np.bool_]


def sentences(main: MainResult) -> list[str]:
    """Return up to three sentences about the main result of a study."""
    found = (_most_and_least(main), _regimes(main), _validity(main))
    return [f"{one[0].upper()}{one[1:]}." for one in found if one]


@dataclass(frozen=True)
class _Group:
    """Pairs of one law with the same results: their name for a reader, and the widest ratio of the ends of a band."""

    label: str
    values: Array
    spread: float


def _groups(main: MainResult) -> list[_Group]:
    """Return the pairs; those of one law that give the same results stand together."""
    rates = {pair: main.sweep[main.outcome].sel(pair=pair).values for pair in main.pairs}
    by_law: dict[str, list[list[str]]] = {}
    for pair in main.pairs:
        known = by_law.setdefault(main.study.pair(pair).law, [])
        for group in known:
            if np.allclose(rates[pair], rates[group[0]], ALIKE, 0.0, equal_nan=True):
                group.append(pair)
                break
        else:
            known.append([pair])
    return [
        _Group(
            law if len(groups) == 1 else f"{law} on {_listed([main.study.pair(pair).contact_model for pair in group])}",
            rates[group[0]],
            _spread(main, group[0]),
        )
        for law, groups in by_law.items()
        for group in groups
    ]


def _spread(main: MainResult, pair: str) -> float:
    """Return the widest ratio of the ends of a pair's band, 1 without a band."""
    names = [f"{main.outcome}_{end}" for end in ("low", "high")]
    if any(name not in main.sweep for name in names):
        return 1.0
    low, high = (main.sweep[name].sel(pair=pair).values for name in names)
    some = low > 0.0
    return float((high[some] / low[some]).max(initial=1.0))


def _most_and_least(main: MainResult) -> str:
    """Return which law gives most and which least, and by what factor."""
    groups = _groups(main)
    rates = np.stack([group.values for group in groups])
    known = np.isfinite(rates).all(axis=0)
    if not known.any():
        return ""
    if len(groups) == 1:
        return _of_one(main, groups[0])
    highest, lowest = (np.where(known, ends, np.nan) for ends in (rates.max(axis=0), rates.min(axis=0)))
    if _same(highest[known], lowest[known]):
        return f"the predictions of {_listed([group.label for group in groups])} are the same{_throughout(main)}"
    positive = lowest > 0.0
    if not positive.any():
        at = _place_of(np.nanargmax(highest - lowest), highest)
        place = f" most {_at(main, at)}" if at else ""
        (most, high), (least, low) = _ends(main, groups, at)
        return f"the predictions differ{place}: {most} gives {high} and {least} {low}"
    factors = np.divide(highest, lowest, out=np.full(highest.shape, np.nan), where=positive)
    largest = float(np.nanmax(factors))
    word, last = _words(main)
    at = _place_of(np.nanargmax(np.where(positive, highest, np.nan)), highest)
    (most, high), (least, low) = _ends(main, groups, at)
    by_label = {group.label: group.values for group in groups}
    if at and positive.all() and _same(by_label[most], highest) and _same(by_label[least], lowest):
        by = " to ".join(dict.fromkeys((number(float(factors.min())), number(largest))))
        found = f"the {word} comes from {most} and the {last} from {least}{_throughout(main)}, by a factor of {by}"
    else:
        place = f" {_at(main, at)}, where" if at else ", and"
        found = f"the {word}, {high}, comes from {most}{place} the {last}, {low}, comes from {least}"
        found += f": a factor of {number(float(factors[at]))}"
        if largest > (1.0 + ALIKE) * factors[at]:
            found += f"; {_at(main, _place_of(np.nanargmax(factors), factors))} the factor is {number(largest)}"
    widest = max(groups, key=lambda group: group.spread)
    if widest.spread > largest * (1.0 + ALIKE):
        found += f"; the published range of {widest.label} alone spans a factor of {number(widest.spread)}"
    return found


def _words(main: MainResult) -> tuple[str, str]:
    """Return the words for the highest and the lowest outcome."""
    if main.outcome in (WEAR, MASS):
        return f"most wear{' of all patches together' if main.outcome == MASS else ''}", "least"
    return f"highest {name_of(main.outcome)}", "lowest"


def _same(one: Array, other: Array) -> bool:
    return np.allclose(one, other, ALIKE, 0.0)


def _ends(main: MainResult, groups: Sequence[_Group], at: Point) -> tuple[tuple[str, str], tuple[str, str]]:
    """Return the names and the outcomes of the highest and the lowest prediction at a point."""
    ordered = sorted(groups, key=lambda group: float(group.values[at]))
    high, low = ((group.label, _amount(main, group.values[at])) for group in (ordered[-1], ordered[0]))
    return high, low


def _of_one(main: MainResult, group: _Group) -> str:
    """Return the outcome of a single law: its value, or the lowest and the highest of a sweep."""
    ends = [_place_of(index(group.values), group.values) for index in (np.nanargmin, np.nanargmax)]
    low, high = (_amount(main, group.values[end]) for end in ends)
    found = f"the {name_of(main.outcome)} of {group.label}"
    if low == high:
        found += f" is {low}{_throughout(main)}"
    else:
        found += f" runs from {low} {_at(main, ends[0])} to {high} {_at(main, ends[1])}"
    return found + (f"; its published range spans a factor of {number(group.spread)}" if group.spread > 1.0 else "")


def _amount(main: MainResult, value: float) -> str:
    """Return an outcome with its unit."""
    unit = readable(main.sweep[main.outcome].attrs["units"])
    return _with_unit(number(float(value)), unit)


def _place_of(index: Any, values: Array) -> Point:
    return tuple(int(one) for one in np.unravel_index(index, values.shape))


def _at(main: MainResult, point: Point) -> str:
    """Return an operating point in words, such as "at a creepage of 1 % and a normal force of 5 kN"."""
    return f"at {_listed([_level(main, axis, at) for axis, at in zip(_axes(main), point, strict=True)])}"


def _level(main: MainResult, axis: str, at: int) -> str:
    values, unit = main.along(axis)
    return f"{_with_article(name_of(axis))} of {_with_unit(number(values[at], 4), unit)}"


def _axes(main: MainResult) -> list[str]:
    """Return the axes of the outcome in the order of its values."""
    return [str(dim) for dim in main.sweep[main.outcome].dims if dim != "pair"]


def _throughout(main: MainResult) -> str:
    """Return all points of a sweep in words; "" for a single one."""
    axes = _axes(main)
    if not axes:
        return ""
    if len(axes) > 1:
        return f" at all {main.sweep[main.outcome].isel(pair=0).size} points"
    values, unit = main.along(axes[0])
    last = _with_unit(number(values[-1], 4), unit)
    return f" at every {name_of(axes[0])} from {number(values[0], 4)} to {last}"


def _regimes(main: MainResult) -> str:
    """Return where laws change regime, where the whole patch slips, and where patches come and go."""
    axes = _axes(main)
    if main.axis not in axes:
        return ""
    original = along_main_axis(main.study.sweeps[main.name], main.study.case.rig.creepage)
    of_contact = _coming_and_going if patch_axes(original) else _full_slip
    said = [*_borders(main), *of_contact(main, original)]
    middle = [_level(main, axis, main.sweep.sizes[axis] // 2) for axis in axes if axis != main.axis]
    return f"{f'at {_listed(middle)}, ' if middle and said else ''}{'; '.join(said)}"


def _borders(main: MainResult) -> Iterator[str]:
    """Yield where laws change regime: by the means over the patch, or where its most loaded part does.

    A law on several contact models is followed on the first.
    """
    x, unit = main.along(main.axis)
    most = MOST_SOLVED if type(main.study.case.rig).balanced is Rig.balanced else MOST_BALANCED
    chosen = np.unique(np.linspace(0, x.size - 1, min(x.size, most)).round().astype(int))
    changes: dict[str, dict[str, list[str]]] = {}
    followed: dict[str, list[Pair]] = {}
    for pair in {pair.law: pair for pair in map(main.study.pair, reversed(main.pairs))}.values():
        followed.setdefault(pair.contact_model, []).append(pair)
    for pairs in followed.values():
        peaks = _peaks(pairs, _conditions(main, chosen))
        what = "the mean over the patch" if pairs[0].pipeline.scale == "patch" else "the most loaded part of the patch"
        for law, of_law in peaks.items():
            steps = sorted(step for values, ends in of_law for end in ends for step in _crossed(values, end))
            changes.setdefault(what, {})[law] = _changes(x[chosen], unit, steps)
    for what, of_laws in changes.items():
        names = [pair.law for pair in map(main.study.pair, main.pairs) if pair.law in of_laws]
        places = {law: of_laws[law] for law in dict.fromkeys(names)}
        some = [f"{_listed(where)} ({law})" for law, where in places.items() if where]
        if some:
            yield f"over {name_of(main.axis)}, {what} changes regime {_listed(some)}"
        else:
            yield f"{what} stays in one regime of {_listed(list(places))}"


def _peaks(pairs: Sequence[Pair], conditions: Mapping[str, Any]) -> dict[str, list[tuple[Array, tuple[float, ...]]]]:
    """Return the largest magnitudes in the patch of the variables in which laws branch, with the borders of regimes.

    The pairs have one contact model. Laws that do not declare their borders are left out, and so are laws without any.
    """
    pipeline, borders = pairs[0].pipeline.without_law(), {}
    for pair in pairs:
        (law,) = pair.pipeline.laws
        with Blame(law):
            of_law = law.breakpoints(law.numbers) or {}
        if of_law and {*of_law} <= {*PATCH_VARIABLES, *law.own_variables}:
            borders[pair.law] = law, of_law
    if not borders:
        return {}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", WearlawWarning)  # running the case gave them already
        problem = pipeline.posed(conditions)
        parts: dict[tuple[str, str], list[Array]] = {(law, name): [] for law in borders for name in borders[law][1]}
        flat = problem.flatten()
        for block in blocks(flat.size, SOLVED_AT_ONCE):
            contact = solve(pipeline.staged_model, flat[block])
            for (label, name), known in parts.items():
                with Blame(borders[label][0]):
                    values = np.abs(borders[label][0].value_at(contact, name))
                known.append(values.max(axis=tuple(range(1, values.ndim))))
    found: dict[str, list[tuple[Array, tuple[float, ...]]]] = {label: [] for label in borders}
    for (label, name), known in parts.items():
        values = problem.unflatten(np.concatenate(known))
        found[label].append((np.fmax.reduce(values, axis=tuple(range(1, values.ndim))), borders[label][1][name]))
    return found


def _conditions(main: MainResult, chosen: NDArray[np.int_]) -> dict[str, Any]:
    """Return the conditions at some points of the main axis, and at the middle of the other axes."""
    found = main.study.conditions(sweep=main.name)
    for axis in _axes(main):
        values = found[axis].reshape(-1)
        found[axis] = values[chosen] if axis == main.axis else values[values.size // 2]
    return found


def _crossed(values: Array, border: float) -> list[float]:
    """Return where values cross a border, as positions between the points by linear interpolation."""
    before, after = values[:-1], values[1:]
    steps = np.flatnonzero((before >= border) != (after >= border))
    found: list[float] = (steps + (border - before[steps]) / (after[steps] - before[steps])).tolist()
    return found


def _changes(x: Array, unit: str, places: Sequence[float]) -> list[str]:
    """Return the places of changes in words: where they are interpolated, or between two points that lie apart."""
    about: list[str] = []
    between: list[str] = []
    for place in places:
        first = min(int(place), x.size - 2)
        before, after = x[first], x[first + 1]
        if abs(after - before) <= NEAR * max(abs(before), abs(after)):
            about.append(number(float(np.interp(place, (first, first + 1), (before, after))), 2))
        else:
            between.append(f"between {number(before)} and {_with_unit(number(after), unit)}")
    near = [f"at about {_with_unit(_listed(list(dict.fromkeys(about))), unit)}"] if about else []
    return [*near, *dict.fromkeys(between)]


def _full_slip(main: MainResult, line: xarray.Dataset) -> Iterator[str]:
    """Yield where no part of the patch sticks, by contact model."""
    if "stick_ratio" not in line:
        return
    places: dict[str, list[str]] = {}
    of_cells = dict.fromkeys(pair.contact_model for pair in main.study.pairs if pair.pipeline.scale == "cells")
    for model in of_cells:
        stick = line.stick_ratio.sel(contact_model=model).values
        if np.isfinite(stick).all():
            places.setdefault(_where(main, stick <= SLIPS), []).append(model)
    if list(places) == [""]:
        yield "part of the patch sticks throughout"
    some = {where: models for where, models in places.items() if where}
    if some:
        every = [where if len(places) == 1 else f"{where} ({_listed(models)})" for where, models in some.items()]
        yield f"the whole patch slips {_listed(every)}"


def _coming_and_going(main: MainResult, line: xarray.Dataset) -> Iterator[str]:
    """Yield where patches touch that do not touch throughout."""
    axes = patch_axes(line)
    of_contact = next(one for one in line.data_vars.values() if {"contact_model", *axes} <= set(one.dims))
    there = of_contact.notnull().any("contact_model")
    places = {in_words(patch): _where(main, there.sel(patch).values) for patch in patches_of(line)}
    some = [f"{patch} {where}" for patch, where in places.items() if where != THROUGHOUT]
    yield f"patches come and go: {', '.join(some)}" if some else "the same patches touch throughout"


def _validity(main: MainResult) -> str:
    """Return what lies outside the ranges of the laws and beyond the elastic limits of the bodies."""
    sweep, single = main.sweep, not _axes(main)
    laws = {main.study.pair(pair).law: main.study.pair(pair).pipeline.laws[0] for pair in main.pairs}
    outside: dict[str, list[str]] = {}
    for name, law in laws.items():
        pairs = [pair for pair in main.pairs if main.study.pair(pair).law == name]
        where = _where(main, (sweep.outside_range.sel(pair=pairs) > 0.0).any("pair").values)
        fitted = " (fitted to other materials)" if other_materials(main.study.case.rig.bodies, law) else ""
        outside.setdefault(f"{where}{fitted}" if where else "", []).append(name)
    inside = outside.pop("", [])
    tested = [name for name in inside if laws[name].valid_range]
    beyond = beyond_limits(sweep)
    limits = {LIMITS[name]: _where(main, one.any("contact_model").values) for name, one in beyond.items()}
    reached = {where: words for words, where in limits.items() if where}  # the further limit where both places agree
    said = []
    if outside:
        of_laws = _listed([f"{_listed(names)} {where}" for where, names in outside.items()])
        said.append(f"{'the point lies' if single else 'points lie'} outside the range of {of_laws}")
    if reached:
        said.append(f"the contact is {_listed([f'{words} {where}' for where, words in reached.items()])}")
    if not said and (tested or beyond):
        both = [f"within the range of {_listed(tested)}"] if tested else []
        both += ["below first yield"] if beyond else []
        said.append(f"{'the point' if single else 'every point'} lies {_listed(both)}")
    if len(tested) < len(inside):
        said.append(f"no range is known for {_listed([name for name in inside if name not in tested])}")
    if not beyond:
        said.append("the elastic limits are not known")
    text = "; ".join([*said, *_elsewhere(main)])
    return text.replace(f" {THROUGHOUT}", "") if single else text


def _elsewhere(main: MainResult) -> Iterator[str]:
    """Yield which other sweeps hold points outside the ranges of laws or beyond elastic limits."""
    names = [
        f"'{name}'"
        for name, sweep in main.study.sweeps.items()
        if name != main.name
        and ((sweep.outside_range > 0.0).any() or any(one.any() for one in beyond_limits(sweep).values()))
    ]
    if names:
        yield f"parts of the {'sweep' if len(names) == 1 else 'sweeps'} {_listed(names)} lie outside too"


def _where(main: MainResult, mask: Mask) -> str:
    """Return in words at which points of a sweep something is so; "" if at none."""
    if mask.all() or not mask.any():
        return THROUGHOUT if mask.all() else ""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], mask.ravel(), [False]]).astype(int)))
    if mask.ndim > 1 or edges.size > 2:
        return f"at {int(mask.sum())} of {mask.size} points"
    values, unit = main.along(main.axis)
    first, last = number(float(values[edges[0]])), _with_unit(number(float(values[edges[1] - 1])), unit)
    if edges[1] == edges[0] + 1:
        return f"at {last}"
    if edges[0] == 0:
        return f"up to {last}"
    if edges[1] == mask.size:
        return f"from {_with_unit(first, unit)} on"
    return f"from {first} to {last}"


def number(value: float, digits: int = 3) -> str:
    """Return a number with some significant digits, with a power of ten if it is very large or small."""
    power = 0 if value == 0.0 or 1e-4 <= abs(value) < 1e6 else int(f"{value:e}".partition("e")[2])
    shown = np.format_float_positional(
        value / 10.0**power, precision=digits, unique=False, fractional=False, trim="-"
    ).replace("-", "−")
    return f"{shown} × 10{str(power).translate(RAISED)}" if power else shown


def _with_unit(shown: str, unit: str) -> str:
    """Return a number with its unit, which stay on one line."""
    return f"{shown}\N{NO-BREAK SPACE}{unit}" if unit else shown


def _listed(texts: Sequence[str]) -> str:
    """Return texts with commas and an "and"."""
    return texts[0] if len(texts) == 1 else f"{', '.join(texts[:-1])} and {texts[-1]}"


def _with_article(noun: str) -> str:
    return f"{'an' if noun[0] in 'aeiou' else 'a'} {noun}"
