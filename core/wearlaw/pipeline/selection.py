"""The axes of a prediction: selection of entries along them, by label or by position, and the conditions there."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from wearlaw.arrays import Array
from wearlaw.contact.conditions import Known
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
                known = " and ".join(f"{dim} {own}" for dim, own in problem.dims.items()) or "none"
                raise InputError(
                    f"sel: no labels for an axis {shown(name)}{did_you_mean(name, problem.dims)} Axes with labels:"
                    f" {known}; isel takes positions along any axis"
                )
            own = problem.dims[name]
            several = isinstance(given, Sequence | np.ndarray) and not isinstance(given, str)
            for label in given if several else [given]:
                if label not in own:
                    raise InputError(f"sel: axis {shown(name)} has no label {shown(label)}, only {own}")
            found[name] = [own.index(label) for label in given] if several else own.index(given)
        return cls(tuple(found.get(name, slice(None)) for name in axis_names(problem)))

    @classmethod
    def by_position(cls, problem: Problem, positions: Mapping[str, Any]) -> Selection:
        """Return the selection of positions along any axes.

        Raises
        ------
        InputError
            If there is no such axis or position.
        """
        sizes = dict(zip(axis_names(problem), problem.batch_shape, strict=True))
        for name in positions:
            if name not in sizes:
                known = ", ".join(f"{dim} ({size})" for dim, size in sizes.items()) or "none at one operating point"
                raise InputError(f"isel: no axis {shown(name)}{did_you_mean(name, sizes)} Axes (with sizes): {known}")
        return cls(tuple(_position(name, positions.get(name, slice(None)), size) for name, size in sizes.items()))

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
            raise InputError(f"{shown(positions)}: are more positions than there are axes. Axes: {known}")
        return cls.by_position(problem, dict(zip(names, positions, strict=False)))

    def of_conditions(self, values: Array) -> Array:
        """Return the chosen entries of a condition, with an axis for each of the conditions, of full length or 1."""
        sizes_and_positions = zip(values.shape, self.positions, strict=False)
        kept = (one if size > 1 else 0 if isinstance(one, int) else slice(None) for size, one in sizes_and_positions)
        return Selection(tuple(kept)).of(values)

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


def _position(name: str, given: Any, size: int) -> Position:
    """Return a position along an axis, without negative numbers; a mask has the entries where it is true."""
    if isinstance(given, slice):
        return given
    numbers = np.asarray(given)
    if numbers.dtype == np.bool_ and numbers.shape == (size,):
        numbers = np.flatnonzero(numbers)
    if numbers.ndim > 1 or (numbers.size and numbers.dtype.kind not in "iu"):
        raise InputError(f"isel: {name} must be an integer, a list of integers or a slice, got {shown(given)}")
    wrong = numbers[(numbers < -size) | (numbers >= size)]
    if wrong.size:
        raise InputError(
            f"isel: axis {shown(name)} has {size} entries, 0 to {size - 1}; there is no entry {wrong.flat[0]}"
        )
    found: list[int] = (numbers % size).reshape(-1).tolist()
    return found if numbers.ndim else found[0]


class Conditions:
    """The conditions of a prediction as its user gave them, laid along the axes of its operating points.

    Parameters
    ----------
    given : mapping of str to object
        The conditions.
    shape : tuple of int
        The shape of the operating points.

    Attributes
    ----------
    numbers : dict of str to Known
        The numbers, with an axis for each axis of the operating points, of its full length or 1.
    others : dict of str to str
        Text of the others, such as a law of friction.
    """

    def __init__(self, given: Mapping[str, Any], shape: tuple[int, ...]) -> None:
        self.numbers: dict[str, Known] = {}
        self.others: dict[str, str] = {}
        for name, value in given.items():
            known = None if value is None else Known.of(value)
            if known is not None and _fits(np.shape(known.values), shape):
                values = np.asarray(known.values)
                self.numbers[name] = Known(values.reshape((1,) * (len(shape) - values.ndim) + values.shape), known.unit)
            elif value is not None:
                self.others[name] = str(value)

    def chosen(self, selection: Selection) -> Conditions:
        """Return the conditions of some of the operating points."""
        found = Conditions({}, ())
        found.others = self.others
        found.numbers = {
            name: Known(selection.of_conditions(one.values), one.unit) for name, one in self.numbers.items()
        }
        return found

    def text(self, without: Collection[str] = ()) -> str:
        """Return the conditions in words, those with several values as their range."""
        found = []
        for name, one in self.numbers.items():
            if name not in without and one.values.size:
                ends = dict.fromkeys(f"{end:.4g}" for end in (one.values.min(), one.values.max()))
                found.append(f"{name_of(name)} {' to '.join(ends)} {one.unit or ''}".rstrip())
        found += [f"{name_of(name)} {text}" for name, text in self.others.items() if name not in without]
        return ", ".join(found)

    def varying(self, axis: int) -> list[str]:
        """Return the names of the conditions that vary along an axis."""
        return [name for name, one in self.numbers.items() if one.values.shape[axis] > 1]

    def axes(self, names: Sequence[str], taken: Collection[str]) -> list[str]:
        """Return names for the axes of the operating points.

        An axis along which a single condition varies, and along no other, has its name; the others keep theirs.
        """
        found = list(names)
        for axis in range(len(names)):
            alone = self.varying(axis)
            if len(alone) == 1 and alone[0] not in taken:
                (name,) = alone
                if self.numbers[name].values.size == self.numbers[name].values.shape[axis]:
                    found[axis] = name
        return found


def _fits(shape: tuple[int, ...], whole: tuple[int, ...]) -> bool:
    """Return whether an array broadcasts to a shape without changing it."""
    try:
        return np.broadcast_shapes(shape, whole) == whole
    except ValueError:
        return False
