"""Errors in operating points from a file, with the line and the column."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from wearlaw.contact.problem import Problem
from wearlaw.errors import DataError, InputError
from wearlaw.units.variables import VARIABLES
from wearlaw_apps.sweeps.points import Points
from wearlaw_apps.tables import Table


def posed(points: Points, pose: Callable[[Mapping[str, Any]], Problem]) -> Problem:
    """Return the problem of operating points; an error in those of a file names the line and the column.

    Parameters
    ----------
    points : Points
    pose : callable
        Returns the problem of conditions.

    Raises
    ------
    InputError
        If conditions are wrong.
    """
    try:
        return pose(points.conditions())
    except InputError as error:
        if points.file is None or points.numbers is None:
            raise
        raise _located(points, points.file, points.numbers, pose, error) from None


def _located(
    points: Points,
    table: Table,
    numbers: range,
    pose: Callable[[Mapping[str, Any]], Problem],
    error: InputError,
) -> InputError:
    """Return the error for the first row that is wrong by itself, found by halving."""

    def fault(start: int, stop: int, single: bool = False) -> InputError | None:
        part = points.part([slice(start, stop), *(slice(None) for _ in points.dims[1:])])
        conditions = part.conditions()
        if single and part.size == 1:
            conditions |= {name: axis.argument(float(axis.values.flat[0])) for name, axis in part.varying.items()}
        try:
            pose(conditions)
        except InputError as wrong:
            return wrong
        return None

    low, high = 0, len(numbers)
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (low, middle) if fault(low, middle) else (middle, high)
    first = fault(low, high, single=True)
    if first is None:  # wrong only beside other rows
        return error
    message = str(first)
    name = next((name for name in points.varying if message.startswith(f"{name}: ")), None)
    if name is None:
        values = (
            f"{key} = {'/'.join(f'{value:.4g}' for value in np.ravel(axis.values[low]))} {axis.unit or ''}".rstrip()
            for key, axis in points.varying.items()
        )
        return DataError(f"{table.label}, {table.where(numbers[low])} ({', '.join(values)}): {message}")
    if low == 0 and type(table) is Table and fault(len(numbers) - 1, len(numbers), single=True):
        return error  # in memory, and wrong from end to end
    head = points.varying[name].origin.rpartition(" of ")[0]
    if points.varying[name].unit is None and "has no unit" in message:
        message += f"; the column {advice(name, head)}"
    column = f", column '{head}'" if head else ""
    return DataError(f"{table.label}, {table.where(numbers[low])}{column}: {message}")


def advice(name: str, text: str) -> str:
    """Return what to do about a column of a condition that has no unit."""
    usual = VARIABLES[name].unit if name in VARIABLES else "..."
    return f'has no unit; write it in brackets, as in columns={{"{name}": "{text} [{usual}]"}}'
