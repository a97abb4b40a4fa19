"""The conditions of a prediction as its user gave them: for datasets, tables, pictures and notebooks."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pint

from wearlaw.arrays import Array
from wearlaw.errors import UnitError
from wearlaw.pipeline.selection import Selection
from wearlaw.pipeline.solution import Solution
from wearlaw.units.quantities import parse, real_array, with_units
from wearlaw.units.registry import symbol
from wearlaw.units.variables import name_of


@dataclass(frozen=True, eq=False)
class Known:
    """A known condition: one number or several, and their unit, None for plain numbers."""

    values: Array
    unit: str | None

    @classmethod
    def of(cls, value: object) -> Known | None:
        """Return a given condition, or None if it is not numeric, such as a law of friction."""
        try:
            quantity = parse(value) if isinstance(value, str) or with_units(value) else value
            if isinstance(quantity, pint.Quantity):
                return cls(real_array(quantity.magnitude), symbol(quantity.units, "~C"))
            return cls(real_array(quantity), None)
        except UnitError:
            return None


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

    def __init__(self, conditions: Mapping[str, Any], shape: tuple[int, ...]) -> None:
        self.numbers: dict[str, Known] = {}
        self.others: dict[str, str] = {}
        for name, value in conditions.items():
            number = None if value is None else Known.of(value)
            if number is not None and _fits(np.shape(number.values), shape):
                values = np.asarray(number.values)
                self.numbers[name] = Known(
                    values.reshape((1,) * (len(shape) - values.ndim) + values.shape), number.unit
                )
            elif value is not None:
                self.others[name] = str(value)

    @classmethod
    def of(cls, solution: Solution) -> Conditions:
        """Return the conditions of a solution, or of the part of one, along the axes of its operating points."""
        if solution.whole is not None:
            whole, chosen = solution.whole
            return cls.of(whole).chosen(chosen)
        shape = solution.problem.batch_shape
        return cls(solution.conditions or {}, shape[: len(shape) - len(solution.problem.dims)])

    def chosen(self, selection: Selection) -> Conditions:
        """Return the conditions of some of the operating points."""
        part = Conditions({}, ())
        part.others = self.others
        part.numbers = {
            name: Known(_chosen(condition.values, selection), condition.unit)
            for name, condition in self.numbers.items()
        }
        return part

    def text(self, without: Collection[str] = ()) -> str:
        """Return the conditions in words, those with several values as their range."""
        texts = []
        for name, condition in self.numbers.items():
            if name not in without and condition.values.size:
                ends = dict.fromkeys(f"{end:.4g}" for end in (condition.values.min(), condition.values.max()))
                texts.append(f"{name_of(name)} {' to '.join(ends)} {condition.unit or ''}".rstrip())
        texts += [f"{name_of(name)} {text}" for name, text in self.others.items() if name not in without]
        return ", ".join(texts)

    def varying(self, axis: int) -> list[str]:
        """Return the names of the conditions that vary along an axis."""
        return [name for name, condition in self.numbers.items() if condition.values.shape[axis] > 1]

    def axes(self, names: Sequence[str], taken: Collection[str]) -> list[str]:
        """Return names for the axes of the operating points.

        An axis along which a single condition varies, and along no other, has its name; the others keep theirs.
        """
        labels = list(names)
        for axis in range(len(names)):
            alone = self.varying(axis)
            if len(alone) == 1 and alone[0] not in taken:
                (name,) = alone
                if self.numbers[name].values.size == self.numbers[name].values.shape[axis]:
                    labels[axis] = name
        return labels


def _chosen(values: Array, selection: Selection) -> Array:
    """Return the chosen entries of a condition, with an axis for each of the conditions, of full length or 1."""
    sizes_and_positions = zip(values.shape, selection.positions, strict=False)
    kept = (
        position if size > 1 else 0 if isinstance(position, int) else slice(None)
        for size, position in sizes_and_positions
    )
    return Selection(tuple(kept)).of(values)


def _fits(shape: tuple[int, ...], whole: tuple[int, ...]) -> bool:
    """Return whether an array broadcasts to a shape without changing it."""
    try:
        return np.broadcast_shapes(shape, whole) == whole
    except ValueError:
        return False
