"""The shares of the rows of a table in a sum over service: as given, equal, or from the times or places of a run."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import IO, cast

import numpy as np

from wearlaw.arrays import Array
from wearlaw.errors import DataError, shown
from wearlaw.units.quantities import Q, coefficient
from wearlaw.units.variables import alike
from wearlaw_apps.sweeps.points import OnDisk, Points, Varying
from wearlaw_apps.sweeps.wear_profile import SHARE
from wearlaw_apps.tables import Table

EQUAL = "equal"
"""In place of a column: all rows have the same share."""

SPEED = "rolling_speed"
"""The condition that makes a distance of a time."""

ROUNDED = 1e-6
"""Deviation of the sum of the shares from one that is rounding of the numbers in a table."""

PIECE = 1_000_000
"""Shares that are read at a time."""


def with_shares(points: Points, name: str, file: IO[bytes] | None) -> Points:
    """Return points whose kept column `SHARE` has the shares of the distance, written to a file if there is one.

    A column of times or of distances along a run is that of a series: a row stands for what lies half-way to its
    neighbours. Durations are multiplied by the speeds of the rows, if they have some.

    Raises
    ------
    DataError
        If shares are wrong, or times or distances do not grow.
    """
    table, rows = points.file, points.dims[0]
    assert table is not None
    if name == EQUAL and SHARE not in points.kept:
        count = points.sizes[rows]
        shares = np.full(count, 1.0 / count)
    else:
        column = points.kept[SHARE]
        unit = column.unit or ""
        if not (alike(unit, "m") or alike(unit, "s")):
            check_shares(points, name)
            return points
        speed = points.varying.get(SPEED) if alike(unit, "s") else None
        total = sum(float(lengths.sum()) for lengths in _lengths(column, speed, name, table))
        every = (lengths / total for lengths in _lengths(column, speed, name, table))
        if file is None:
            shares = np.concatenate(list(every))
        else:
            for lengths in every:
                file.write(lengths.data)
            shares = cast(Array, OnDisk(file))
    return replace(points, kept={**points.kept, SHARE: Varying(rows, shares, None)})


def _lengths(column: Varying, speed: Varying | None, name: str, table: Table) -> Iterator[Array]:
    """Yield what rows of a series stand for, in pieces: half-way to both neighbours, times their speeds if given."""
    count = column.values.size
    for start in range(0, count, PIECE):
        stop = min(start + PIECE, count)
        at = column.values[max(start - 1, 0) : stop + 1]
        wrong = np.flatnonzero(~(np.diff(at) > 0.0))
        if wrong.size or count < 2:
            row = table.where(max(start - 1, 0) + int(wrong[0]) + 1) if wrong.size else "its only row"
            raise DataError(f"{table.label}, {row}, column {shown(name)}: must grow from row to row, as in a run")
        ends = np.concatenate([at[:1], 0.5 * (at[1:] + at[:-1]), at[-1:]])
        lengths = np.diff(ends[start > 0 : ends.size - (stop < count)])
        yield lengths if speed is None else lengths * speed.values[start:stop]


def check_shares(points: Points, name: str) -> None:
    """Raise an error unless the kept column `SHARE` of points has the shares of one whole.

    Raises
    ------
    DataError
        If a share is missing or negative, or they do not add up to one.
    """
    column, total, table = points.kept[SHARE], 0.0, points.file
    assert table is not None
    factor = 1.0 if column.unit is None else float(coefficient(Q(1.0, column.unit), name))
    for start in range(0, column.values.size, PIECE):
        shares = column.values[start : start + PIECE]
        wrong = np.flatnonzero(~(shares >= 0.0))
        if wrong.size:
            row = table.where(start + int(wrong[0]))
            raise DataError(
                f"{table.label}, {row}, column {shown(name)}: must be a share of the distance, zero or more, got"
                f" {shares[wrong[0]]:g}"
            )
        total += factor * float(shares.sum())
    if abs(total - 1.0) > ROUNDED:
        percent = "; are they in percent? Name the column with its unit, as in 'share [%]'"
        advice = percent if abs(total - 100.0) < 100.0 * ROUNDED else f"; divide the column by {total:.6g}"
        raise DataError(
            f"{table.label}: the shares in {shown(name)} must add up to 1, but add up to {total:.6g}{advice}"
        )
