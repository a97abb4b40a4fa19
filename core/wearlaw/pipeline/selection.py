"""Selection of some entries along the axes of a prediction, by label or by position."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from wearlaw.arrays.array import Array
from wearlaw.contact.contact import Contact
from wearlaw.contact.problem import Problem
from wearlaw.errors import InputError, did_you_mean, shown
from wearlaw.units.variables import name_of

Label: TypeAlias = str | int
"""A label of an entry along one of a rig's own axes."""

Index: TypeAlias = "int | slice | Sequence[int] | NDArray[Any] | tuple[int | slice | Sequence[int] | NDArray[Any], ...]"
"""Positions along the axes in square brackets."""

Position: TypeAlias = int | slice | list[int]
"""Entries along an axis. An integer drops the axis; a slice or a list keeps it."""


def in_words(labels: Mapping[str, Label]) -> str:
    """Return the labels of a patch in words, such as "left, patch 1"; a number stands behind the name of its axis."""
    return ", ".join(one if isinstance(one, str) else f"{name_of(axis)} {one}" for axis, one in labels.items())


def axis_names(problem: Problem) -> list[str]:
    """Return names for the axes of a batch: point_0, point_1, ... for those of the conditions, then the rig's own."""
    of_conditions = len(problem.batch_shape) - len(problem.dims)
    return [*(f"point_{axis}" for axis in range(of_conditions)), *problem.dims]


@dataclass(frozen=True)
class Selection:
    """Entries along the axes of a batch.

    Attributes
    ----------
    positions : tuple
        The positions along each axis of the batch.
    """

    positions: tuple[Position, ...]

    @classmethod
    def by_label(cls, problem: Problem, labels: Mapping[str, Any]) -> Selection:
        """Return the selection of labels along the rig's own axes.

        Raises
        ------
        InputError
            If there is no such axis or label.
        """
        found: dict[str, Position] = {}
        for name, given in labels.items():
            if name not in problem.dims:
                numbered = f"; {shown(name)} has none, so use isel({name}=...)" if name in axis_names(problem) else ""
                known = " and ".join(f"{dim} {_listed(own)}" for dim, own in problem.dims.items()) or "none"
                hint = did_you_mean(name, problem.dims) if not numbered else "."
                raise InputError(f"sel: no labels for an axis {shown(name)}{numbered}{hint} Axes with labels: {known}")
            several = isinstance(given, Sequence | np.ndarray) and not isinstance(given, str)
            places = [_place(name, one, problem.dims[name]) for one in (given if several else [given])]
            found[name] = places if several else places[0]
        return cls(tuple(found.get(name, slice(None)) for name in axis_names(problem)))

    @classmethod
    def by_position(cls, problem: Problem, positions: Mapping[str, Any]) -> Selection:
        """Return the selection of positions along any axes.

        Raises
        ------
        InputError
            If there is no such axis or position.
        """
        names = axis_names(problem)
        sizes = dict(zip(names, problem.batch_shape, strict=True))
        for name in positions:
            if name not in sizes:
                known = ", ".join(f"{dim} ({size})" for dim, size in sizes.items()) or "none at one operating point"
                raise InputError(f"isel: no axis {shown(name)}{did_you_mean(name, names)} Axes (with sizes): {known}")
        return cls(tuple(_position(name, positions.get(name, slice(None)), sizes[name]) for name in names))

    @classmethod
    def by_index(cls, problem: Problem, index: Any) -> Selection:
        """Return the selection of positions along the axes in their order, as in square brackets.

        Raises
        ------
        InputError
            If there are more positions than axes, or there is no such position.
        """
        names = axis_names(problem)
        positions = index if isinstance(index, tuple) else (index,)
        if len(positions) > len(names):
            known = ", ".join(names) or "none: this is one operating point"
            raise InputError(f"{_listed(positions)}: are more positions than there are axes. Axes: {known}")
        given = {
            name: np.flatnonzero(one) if _is_mask(one, size) else one
            for name, size, one in zip(names, problem.batch_shape, positions, strict=False)
        }
        return cls.by_position(problem, given)

    def of_conditions(self, values: Array) -> Array:
        """Return the chosen entries of a condition, with an axis for each of the conditions, of full length or 1."""
        chosen = Selection(
            tuple(
                position if size > 1 else 0 if isinstance(position, int) else slice(None)
                for position, size in zip(self.positions, values.shape, strict=False)
            )
        )
        return chosen.of(values)

    def of(self, array: Array) -> Array:
        """Return the chosen entries of an array whose first axes are those of the batch."""
        chosen: Array = self._of(array)
        return chosen

    def _of(self, array: Any) -> Any:
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
        exists = None if problem.exists is None else self._of(problem.exists)
        if exists is not None and exists.all():
            exists = None
        return problem.mapped(self.of, self.of).replaced(dims=dims, exists=exists)

    def of_solved(self, contact: Contact, problem: Problem) -> Contact:
        """Return the chosen ones of the existing patches, which lie along the one batch axis of a solved contact."""
        if not problem.batch_shape:  # a single point
            return contact
        rows: NDArray[np.intp] = np.full(problem.batch_shape, -1)
        rows[np.ones_like(rows, dtype=np.bool_) if problem.exists is None else problem.exists] = np.arange(problem.size)
        chosen = self._of(rows).reshape(-1)
        return contact[chosen[chosen >= 0]]


def _is_mask(given: object, size: int) -> bool:
    return isinstance(given, np.ndarray) and given.dtype.kind == "b" and given.shape == (size,)


def _place(name: str, label: object, labels: Sequence[Label]) -> int:
    """Return the place of a label among those of an axis."""
    for place, known in enumerate(labels):
        if known == label:
            return place
    raise InputError(f"sel: axis {shown(name)} has no label {shown(label)}, only {_listed(labels)}")


def _position(name: str, given: object, size: int) -> Position:
    """Return a position along an axis, without negative numbers."""
    if isinstance(given, slice):
        return given
    numbers = np.asarray(given)
    if numbers.ndim > 1 or (numbers.size and numbers.dtype.kind not in "iu"):
        raise InputError(f"isel: {name} must be an integer, a list of integers or a slice, got {shown(given)}")
    wrong = numbers[(numbers < -size) | (numbers >= size)]
    if wrong.size:
        raise InputError(
            f"isel: axis {shown(name)} has {size} entries, 0 to {size - 1}; there is no entry {wrong.flat[0]}"
        )
    found: list[int] = (numbers % size).reshape(-1).tolist()
    return found if numbers.ndim else found[0]


def _listed(labels: Sequence[object]) -> str:
    return f"({', '.join(map(repr, labels))})"
