"""The operating points that a sweep is given, above all the rows of a table: which columns are which conditions."""

from __future__ import annotations

import itertools
import os
import re
import tempfile
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from difflib import get_close_matches
from pathlib import Path
from typing import IO, Any, NamedTuple, cast

import numpy as np

from wearlaw.arrays import Array
from wearlaw.errors import ConditionsError, DataError, InputError, UnitError, WearlawWarning, warn
from wearlaw.pipeline.pipeline import Pipeline
from wearlaw.units.quantities import Q
from wearlaw.units.variables import VARIABLES
from wearlaw_apps.heads import Column, named_column
from wearlaw_apps.sweeps.located import advice
from wearlaw_apps.sweeps.points import OnDisk, Points, Varying, split
from wearlaw_apps.sweeps.shares import EQUAL, with_shares
from wearlaw_apps.sweeps.wear_profile import SHARE
from wearlaw_apps.tables import LISTED, Table, open_table

Columns = Mapping[str, str]
"""The columns of a table by the names that they get, as in {"normal_force": "-Fz [N]"}."""

PLACE = re.compile(r"\{([A-Za-z_]\w*)\}")
"""A place in the pattern of columns for the label of a wheel or a contact."""

MISSPELT = 0.8
"""Likeness to the name of a condition from which a column is taken for a misspelt condition, by difflib's ratio."""


@contextmanager
def operating_points(
    predict: Pipeline[...],
    source: Any,
    conditions: Mapping[str, Any],
    columns: Columns | None,
    keep: Columns | None,
    as_csv: Mapping[str, Any],
    store: str | os.PathLike[str] | None,
    summed: bool,
    ignoring: bool = False,
) -> Iterator[Points]:
    """Give the operating points of a sweep: combinations of conditions, or rows of a table that share conditions.

    Arguments are those of `sweep`; `as_csv` has `sep` and `decimal`. If the points are to be summed, the kept column
    `SHARE` has their shares. With `ignoring` a warning names the columns that are no conditions, which are an error
    without it. The numbers of a file that need not fit into memory, since there is a store or only a sum, are kept in a
    temporary file while the context lasts.

    Raises
    ------
    DataError
        If this is not a table, or a column is wrong.
    """
    if source is None:
        for name, value in {"columns": columns, "keep": keep}.items():
            if value is not None:
                raise InputError(f"{name}: belongs to a table; give one, as in wl.sweep(predict, 'run.csv', ...)")
    fixed, arrays = split(conditions)
    if source is None:
        if not arrays:
            raise ConditionsError(
                'no condition is an axis; give at least one as an array, such as creepage=Q([1, 2], "%")'
            )
        yield Points(fixed, arrays)
        return
    for name in arrays:
        raise DataError(f"{name}: beside a table it must be one value; add it to the table as a column")
    table = open_table(source, **as_csv)
    share = (keep or {}).get(SHARE, EQUAL)
    if summed and share == EQUAL and EQUAL not in (column.name for column in table.heads):
        keep = {name: text for name, text in (keep or {}).items() if name != SHARE}
    patterns, labels = _patterns(table, {**(keep or {}), **(columns or {})})
    if summed and (several := labels.keys() - {"contact"}):
        raise DataError(
            f"{table.label}: the rows are summed over {{contact}} alone, not over {{{min(several)}}}; name one of it"
        )
    first = {name: pattern.texts[0] for name, pattern in patterns.items()}
    keep, columns = (some and {name: first.get(name, text) for name, text in some.items()} for some in (keep, columns))
    kept, varying = _chosen(table, columns, keep, predict if ignoring else None)
    for name in varying:
        if name in fixed or name in kept:
            raise DataError(f"{table.label}: {name} is given twice; keep one")
    if not varying:
        advice = f"name them in columns={{...}}. {table.as_read()}".rstrip(". ")
        raise DataError(f"{table.label}: none of its columns is a condition; {advice}")
    try:
        predict.rig.check_names({**fixed, **varying}, predict.models)
    except ConditionsError as error:
        name = str(error).partition(": ")[0]
        if name not in varying:
            raise
        raise ConditionsError(f"{table.label}, column '{varying[name].head}': {error}") from None
    file = isinstance(source, str | os.PathLike)
    origin = f" of {Path(source).name}" if file else ""
    every = {name: [column] for name, column in {**kept, **varying}.items()}
    for name, pattern in patterns.items():
        every[name] = [table.select({name: text})[name] for text in pattern.texts]
        if len(units := {column.unit for column in every[name]}) > 1:
            raise DataError(f"{table.label}: {name}: the columns '{pattern.text}' have the units {units}; keep one")
    with ExitStack() as stack:
        beside = Path(tempfile.gettempdir()) if store is None else Path(store).parent
        on_disk = file and (summed or store is not None)
        inner = {name: patterns[name].dims if name in patterns else () for name in every}
        shapes = [tuple(len(labels[dim]) for dim in dims) for dims in inner.values()]
        collected = _read(table, every, shapes, kept, _files(beside, len(every), stack) if on_disk else None)
        axes = {}
        for (name, (column, *_)), values in zip(every.items(), collected, strict=True):
            text = patterns[name].text if name in patterns else "-" * (column.sign < 0) + column.head
            axes[name] = Varying(table.dim, values, column.unit, file * f"{text}{origin}", inner[name])
        points = Points(
            fixed,
            {name: axes[name] for name in varying},
            {dim: rows for dim, rows in table.labels.items() if dim == table.dim}
            | {dim: (dim, np.array(some, dtype=object)) for dim, some in labels.items()},
            kept={name: axes[name] for name in kept},
            file=table if table.on_disk else Table(table.label),
            numbers=range(axes[next(iter(varying))].values.shape[0]),
        )
        if summed:
            points = with_shares(points, share, _files(beside, 1, stack)[0] if on_disk else None)
        yield points


class Pattern(NamedTuple):
    """Columns that differ by the wheel or the contact: their pattern, its dimensions, and the column of each label."""

    text: str
    dims: tuple[str, ...]
    texts: list[str]


def _patterns(table: Table, columns: Columns) -> tuple[dict[str, Pattern], dict[str, list[str]]]:
    """Return the patterns among columns, such as "W{wheel} N [N]", and the labels of their dimensions.

    Raises
    ------
    DataError
        If no column fits a pattern, or one is missing.
    """
    fits: dict[str, dict[tuple[str, ...], str]] = {}
    labels: dict[str, dict[str, None]] = {}
    dims: dict[str, list[str]] = {}
    for name, text in columns.items():
        dims[name] = PLACE.findall(text)
        if not dims[name]:
            continue
        parts = PLACE.split(named_column(text.removeprefix("-").strip(), 0).name)
        expression = "".join(rf"(?P<{part}>\S+?)" if odd % 2 else re.escape(part) for odd, part in enumerate(parts))
        fits[name] = {}
        for column in table.heads:
            if match := re.fullmatch(expression, column.name):
                label = match.groupdict()
                head = PLACE.sub(lambda place, label=label: label[place[1]], text)  # type: ignore[misc]
                fits[name][tuple(label[dim] for dim in dims[name])] = head
                for dim in dims[name]:
                    labels.setdefault(dim, {})[label[dim]] = None
        if not fits[name]:
            heads = ", ".join(f"'{column.head}'" for column in table.heads[:LISTED])
            raise DataError(f"{table.label}: {name}: no column fits '{text}'. The columns are {heads}")
    patterns = {}
    for name, texts in fits.items():
        order = [dim for dim in labels if dim in dims[name]]
        patterns[name] = Pattern(columns[name], tuple(order), [])
        for values in itertools.product(*(labels[dim] for dim in order)):
            by_dim = dict(zip(order, values, strict=True))
            if (key := tuple(by_dim[dim] for dim in dims[name])) not in texts:
                missing = PLACE.sub(lambda place: by_dim[place[1]], columns[name])  # noqa: B023
                raise DataError(
                    f"{table.label}: {name}: there is no column '{missing}'; every {' and '.join(order)} needs one"
                )
            patterns[name].texts.append(texts[key])
    return patterns, {dim: list(some) for dim, some in labels.items()}


def _chosen(
    table: Table, columns: Columns | None, keep: Columns | None, predict: Pipeline[...] | None
) -> tuple[dict[str, Column], dict[str, Column]]:
    """Return the columns to keep and those of conditions, by name; of a pipeline, only those that it takes."""
    wrong: list[str] = []
    kept: dict[str, Column] = {}
    conditions: dict[str, Column] = {}
    for choice, argument, selected in ((keep or {}, "keep", kept), (columns, "columns", conditions)):
        try:
            selected |= table.select(choice, argument)
        except DataError as error:
            if not error.problems:
                raise
            wrong += error.problems
    if columns is None:
        places = {column.place for column in kept.values()}
        conditions = {name: column for name, column in conditions.items() if column.place not in places}
        if predict is not None and (unknown := _unknown(conditions, predict)):
            heads = ", ".join(f"'{conditions.pop(name).head}'" for name in unknown)
            of_rig = f"rig '{predict.rig.name}' has no such conditions"
            warn(f"{table.label}: ignored columns {heads}; {of_rig}", WearlawWarning)
    for name, column in conditions.items():
        try:
            if column.unit is None and columns is not None and name in VARIABLES and VARIABLES[name].unit:
                raise UnitError(advice(name, "-" * (column.sign < 0) + column.head))
            Q(1.0, column.unit or "")
        except UnitError as error:
            wrong.append(f"{name}: column '{column.head}': {error}")
    if wrong:
        raise DataError(f"{table.label} is wrong in:", wrong)
    return kept, conditions


def _unknown(names: Iterable[str], predict: Pipeline[...]) -> list[str]:
    """Return the names that are neither conditions nor fields of the rig, nor misspelt conditions."""
    conditions = list(predict.conditions)
    near = (name for name in names if name not in conditions and name not in type(predict.rig).model_fields)
    return [
        name for name in near if conditions and not get_close_matches(name.lower(), conditions, n=1, cutoff=MISSPELT)
    ]


def _files(folder: Path, count: int, stack: ExitStack) -> list[IO[bytes]]:
    """Return files without a name, which end with the context."""
    folder.mkdir(parents=True, exist_ok=True)
    return [cast(IO[bytes], stack.enter_context(tempfile.TemporaryFile(dir=folder))) for _ in range(count)]


def _read(
    table: Table,
    columns: Mapping[str, Sequence[Column]],
    shapes: Sequence[tuple[int, ...]],
    gaps: Mapping[str, Column],
    into: list[IO[bytes]] | None,
) -> list[Array]:
    """Return the numbers of columns by name; those of a pattern have the shape of its inner dimensions at each row."""
    pieces: list[list[Array]] = []
    rows = 0
    counts = np.cumsum([0, *map(len, columns.values())])
    for values in table.pieces([column for some in columns.values() for column in some], gaps):
        rows += values[0].size
        joined = [
            np.stack(values[low:high], axis=-1).reshape(-1, *shape)
            for low, high, shape in zip(counts, counts[1:], shapes, strict=False)
        ]
        if into is None:
            pieces.append(joined)
        else:
            for file, numbers in zip(into, joined, strict=True):
                file.write(np.ascontiguousarray(numbers).data)
    if rows == 0:
        raise DataError(f"{table.label}: has no rows")
    if into is None:
        return [np.concatenate(some) for some in zip(*pieces, strict=True)]
    # In the place of arrays, of which it has what is used.
    return [cast(Array, OnDisk(file, shape)) for file, shape in zip(into, shapes, strict=True)]
