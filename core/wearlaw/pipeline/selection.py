"""Selection of some entries along the axes of a prediction, by label or by position."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from wearlaw.contact.contact import Contact
from wearlaw.contact.problem import Problem
from wearlaw.errors import InputError, did_you_mean, shown

Label: TypeAlias = str | int
"""A label of an entry along one of a rig's own axes."""

Index: TypeAlias = "int | slice | Sequence[int] | NDArray[Any] | tuple[int | slice | Sequence[int] | NDArray[Any], ...]"
"""Positions along the axes in square brackets."""

Position: TypeAlias = int | slice | list[int]
"""Entries along an axis. An integer drops the axis; a slice or a list keeps it."""


def axis_names(problem: Problem) -> list[str]:
    """Return names for the axes of a batch: point_0, point_1, ... for those of the conditions, then the rig's own."""
    of_conditions = len(problem.batch_shape) - len(problem.dims)
    return [*(f"point_{axis}" for axis in range(of_conditions)), *problem.dims]


@dataclass(frozen=True)
class Selection:
    """Entries along the axes of a batch: their positions along each axis."""

    positions: tuple[Position, ...]

    @classmethod
    def by_label(cls, problem: Problem, labels: Mapping[str, Any]) -> Selection:
        """Return the selection of labels along the rig's own axes."""
        chosen: dict[str, Position] = {}
        for name, wanted in labels.items():
            if name not in problem.dims:
                axes = " and ".join(f"{dim} {entries}" for dim, entries in problem.dims.items()) or "none"
                raise InputError(
                    f"sel: no labels for an axis {shown(name)}{did_you_mean(name, problem.dims)} Axes with labels:"
                    f" {axes}; isel takes positions along any axis"
                )
            entries = problem.dims[name]
            several = isinstance(wanted, Sequence | np.ndarray) and not isinstance(wanted, str)
            for label in wanted if several else [wanted]:
                if label not in entries:
                    raise InputError(f"sel: axis {shown(name)} has no label {shown(label)}, only {entries}")
            chosen[name] = [entries.index(label) for label in wanted] if several else entries.index(wanted)
        return cls(tuple(chosen.get(name, slice(None)) for name in axis_names(problem)))

    @classmethod
    def by_position(cls, problem: Problem, positions: Mapping[str, Any]) -> Selection:
        """Return the selection of positions along any axes."""
        sizes = dict(zip(axis_names(problem), problem.batch_shape, strict=True))
        for name in positions:
            if name not in sizes:
                axes = ", ".join(f"{dim} ({size})" for dim, size in sizes.items()) or "none at one operating point"
                raise InputError(f"isel: no axis {shown(name)}{did_you_mean(name, sizes)} Axes (with sizes): {axes}")
        return cls(tuple(_position(name, positions.get(name, slice(None)), size) for name, size in sizes.items()))

    @classmethod
    def by_index(cls, problem: Problem, index: Any) -> Selection:
        """Return the selection of positions along the axes in their order, as in square brackets."""
        names = axis_names(problem)
        positions = index if isinstance(index, tuple) else (index,)
        if len(positions) > len(names):
            axes = ", ".join(names) or "none: this is one operating point"
            raise InputError(f"{shown(positions)}: are more positions than there are axes. Axes: {axes}")
        return cls.by_position(problem, dict(zip(names, positions, strict=False)))

    def of(self, array: NDArray[Any]) -> NDArray[Any]:
        """Return the chosen entries of an array whose first axes are those of the batch."""
        for axis in reversed(range(len(self.positions))):  # the last first, since an integer drops its axis
            array = array[(*(slice(None),) * axis, self.positions[axis], ...)]
        return array

    def of_problem(self, problem: Problem) -> Problem:
        """Return the problem of the chosen entries."""
        first = len(problem.batch_shape) - len(problem.dims)
        dims = {}
        for (name, labels), position in zip(problem.dims.items(), self.positions[first:], strict=True):
            if not isinstance(position, int):
                dims[name] = labels[position] if isinstance(position, slice) else tuple(labels[i] for i in position)
        exists = None if problem.exists is None else self.of(problem.exists)
        if exists is not None and exists.all():
            exists = None
        unloaded = None if problem.unloaded is None else self.of(problem.unloaded)
        return problem.mapped(self.of, self.of).replaced(dims=dims, exists=exists, unloaded=unloaded)

    def of_solved(self, contact: Contact, problem: Problem) -> Contact:
        """Return the chosen ones of the existing patches, which lie along the one batch axis of a solved contact."""
        if not problem.batch_shape:  # a single point
            return contact
        rows: NDArray[np.intp] = np.full(problem.batch_shape, -1)
        rows[np.ones_like(rows, dtype=np.bool_) if problem.exists is None else problem.exists] = np.arange(problem.size)
        chosen = self.of(rows).reshape(-1)
        return contact[chosen[chosen >= 0]]


def _position(name: str, position: Any, size: int) -> Position:
    """Return a position along an axis, without negative numbers; a mask has the entries where it is true."""
    if isinstance(position, slice):
        return position
    try:
        entries = np.arange(size)[list(position) if isinstance(position, tuple) else position]
    except IndexError:
        entries = None
    if entries is None or entries.ndim > 1:
        raise InputError(
            f"isel: axis {shown(name)} has {size} entries, 0 to {size - 1}; give an integer, a list of integers or a"
            f" slice, got {shown(position)}"
        )
    return entries.tolist()  # type: ignore[no-any-return]
