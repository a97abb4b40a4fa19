"""The operating points of a sweep: axes whose values are all combined, or the rows of a table.

They are never expanded as a whole: a block holds only the values along each dimension, and is expanded where it is
evaluated.
"""

from __future__ import annotations

import dataclasses
import itertools
import math
import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import IO, TYPE_CHECKING, Any, cast

import numpy as np
import pint

from wearlaw.arrays import Array
from wearlaw.contact.conditions import is_friction_law
from wearlaw.errors import ConditionsError, UnitError
from wearlaw.units.quantities import Q, parse, real_array, with_units
from wearlaw.units.registry import symbol

if TYPE_CHECKING:
    from wearlaw_apps.tables import Table

ITEM = np.dtype(np.float64).itemsize

BLOCK = 100_000
"""Most operating points that are evaluated at once."""


@dataclass(frozen=True, eq=False)
class Varying:
    """A condition that varies along a dimension of the operating points, and maybe along inner ones.

    Attributes
    ----------
    dim : str
        The dimension.
    values : ndarray, (size of the dimension, sizes of the inner ones)
        The values; `OnDisk` if they are too many for memory.
    unit : str or None
        Their unit; None for plain numbers.
    origin : str
        The column and the file from which they come, "" if none.
    inner : tuple of str
        Further dimensions, such as the wheels of a row of a table.
    """

    dim: str
    values: Array
    unit: str | None
    origin: str = ""
    inner: tuple[str, ...] = ()

    @property
    def dims(self) -> tuple[str, ...]:
        """All its dimensions."""
        return (self.dim, *self.inner)

    @property
    def sizes(self) -> dict[str, int]:
        """Number of values along each of its dimensions."""
        return dict(zip(self.dims, self.values.shape, strict=True))

    def part(self, by_dim: Mapping[str, slice]) -> Varying:
        """Return some of the values, by the slices along their dimensions."""
        values = self.values[tuple(by_dim[dim] for dim in self.dims)]
        return dataclasses.replace(self, values=np.ascontiguousarray(values))

    @property
    def on_disk(self) -> bool:
        """Whether the values are read from disk when used."""
        return isinstance(cast(object, self.values), OnDisk)

    def argument(self, values: Array | float) -> Any:
        """Return values as an argument of a prediction."""
        return values if self.unit is None else Q(values, self.unit)


class OnDisk:
    """Numbers in a temporary file, which are read when used.

    Parameters
    ----------
    file : binary file
        It holds nothing but the numbers, as float64, at least one.
    inner : tuple of int
        Sizes of the inner dimensions.
    """

    def __init__(self, file: IO[bytes], inner: tuple[int, ...] = ()) -> None:
        file.flush()
        self._file = file
        self.size = os.fstat(file.fileno()).st_size // ITEM
        self.shape = (self.size // math.prod(inner), *inner)

    def __getitem__(self, part: slice | tuple[slice, ...]) -> Array:
        """Return some of the numbers."""
        return np.array(np.memmap(self._file, np.float64, "r", shape=self.shape)[part])


@dataclass(frozen=True)
class Block:
    """A rectangle of operating points.

    Attributes
    ----------
    number : int
        Index of the block.
    slices : tuple of slice
        Range along each dimension.
    """

    number: int
    slices: tuple[slice, ...]

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of values along each dimension."""
        return tuple(span.stop - span.start for span in self.slices)

    @property
    def size(self) -> int:
        """Number of operating points."""
        return math.prod(self.shape)


@dataclass(frozen=True, eq=False)
class Points:
    """Operating points.

    Attributes
    ----------
    fixed : mapping of str to object
        Conditions that are the same at all points, as given.
    varying : mapping of str to Varying
        Other conditions. Those along one dimension vary together; different dimensions are combined. The inner
        dimensions of all conditions have one order.
    rows : mapping of str to object
        Labels of a table's rows, by their dimension.
    kept : mapping of str to Varying
        Columns of a table that are not conditions, to be coordinates of the results.
    file : Table or None
        The table from which the points come, to name the places of errors, without values that are in memory.
    numbers : range or None
        The numbers of the points among the rows of the table.
    weight : float
        Size of an operating point compared with a single line or ellipse, such as the number of its patches. Fewer are
        evaluated at once in proportion.
    divided : tuple of int
        The shape of a block. Default: as many points as are evaluated at once.
    piece : tuple of int
        The shape of what is evaluated at once, if a block has several. It does not depend on the blocks, and so do no
        results.
    """

    fixed: Mapping[str, Any]
    varying: Mapping[str, Varying]
    rows: Mapping[str, Any] = field(default_factory=dict)
    weight: float = 1.0
    kept: Mapping[str, Varying] = field(default_factory=dict)
    file: Table | None = None
    numbers: range | None = None
    divided: tuple[int, ...] = ()
    piece: tuple[int, ...] = ()

    @cached_property
    def sizes(self) -> dict[str, int]:
        """Number of values along each dimension."""
        return {
            dim: size for axis in self.varying.values() for dim, size in zip(axis.dims, axis.values.shape, strict=True)
        }

    @property
    def dims(self) -> tuple[str, ...]:
        """The dimensions."""
        return tuple(self.sizes)

    @property
    def shape(self) -> tuple[int, ...]:
        """The shape of the results."""
        return tuple(self.sizes.values())

    @property
    def size(self) -> int:
        """Number of operating points."""
        return math.prod(self.shape)

    @property
    def room(self) -> int:
        """Most points that are evaluated at once."""
        return max(int(BLOCK / self.weight), 1)

    @cached_property
    def block_shape(self) -> tuple[int, ...]:
        """The shape of a block."""
        return self.divided or rectangle(self.shape, self.room)

    def divided_by(self, room: float) -> Points:
        """Return the points in blocks of at most so many, if more, each of several that are evaluated at once."""
        piece = rectangle(self.shape, self.room)
        counts = tuple(math.ceil(size / step) for size, step in zip(self.shape, piece, strict=True))
        together = rectangle(counts, room / math.prod(piece))
        divided = tuple(step * count for step, count in zip(piece, together, strict=True))
        return replace(self, divided=divided, piece=piece)

    def blocks(self) -> list[Block]:
        """Return all blocks, in the order of the results."""
        along = [
            [slice(start, min(start + step, size)) for start in range(0, size, step)]
            for size, step in zip(self.shape, self.block_shape, strict=True)
        ]
        return [Block(number, slices) for number, slices in enumerate(itertools.product(*along))]

    def part(self, slices: Iterable[slice]) -> Points:
        """Return the points of a block."""
        by_dim = dict(zip(self.dims, slices, strict=True))
        varying = {name: axis.part(by_dim) for name, axis in self.varying.items()}
        kept = {name: axis.part(by_dim) for name, axis in self.kept.items()}
        numbers = None if self.numbers is None else self.numbers[by_dim[self.dims[0]]]
        return Points(self.fixed, varying, kept=kept, file=self.file, numbers=numbers, divided=self.piece)

    def coordinates(self) -> dict[str, Varying]:
        """Return the conditions and kept columns that vary, by name."""
        return {**self.varying, **self.kept}

    def conditions(self) -> dict[str, Any]:
        """Return the conditions as arguments of a prediction, with an entry for each operating point."""
        laid_out = {name: axis.argument(self.laid_out(axis)) for name, axis in self.varying.items()}
        return {**self.fixed, **laid_out}

    def laid_out(self, axis: Varying) -> Array:
        """Return the values of a condition or of a kept column at each operating point."""
        shape = [axis.sizes.get(dim, 1) for dim in self.dims]
        return np.broadcast_to(axis.values.reshape(shape), self.shape).reshape(-1)


def rectangle(shape: tuple[int, ...], room: float) -> tuple[int, ...]:
    """Return a small shape: last dimensions in full, the one before in even parts, single values of the others."""
    sides = []
    for size in reversed(shape):
        parts = math.ceil(size / max(int(room), 1))
        sides.append(math.ceil(size / parts))
        room = room / size if parts == 1 else 0
    return tuple(reversed(sides))


def split(conditions: Mapping[str, Any]) -> tuple[dict[str, Any], dict[str, Varying]]:
    """Separate conditions of one value, as given, from axes; a condition of None counts as not given.

    Raises
    ------
    ConditionsError
        If a condition has more than one axis or an empty one.
    """
    fixed: dict[str, Any] = {}
    varying: dict[str, Varying] = {}
    for name, value in conditions.items():
        if value is None:  # not given, as in a prediction
            continue
        values, unit = _plain(name, value)
        if np.ndim(values) == 0:
            fixed[name] = value
        elif np.ndim(values) == 1:
            if not np.size(values):
                raise ConditionsError(f"{name}: the axis is empty; give at least one value")
            varying[name] = Varying(name, np.ascontiguousarray(values), unit)
        else:
            raise ConditionsError(
                f"{name}: must be one value or an axis of values, got an array of shape {np.shape(values)};"
                " all axes are combined with each other"
            )
    return fixed, varying


def _plain(name: str, value: Any) -> tuple[Any, str | None]:
    """Return the numbers of a condition, and their unit if they have one."""
    if isinstance(value, (str, int, float)) or is_friction_law(value):  # text with a unit, or a law of friction
        return 0.0, None
    try:
        value = parse(value) if with_units(value) else value
        quantity = isinstance(value, pint.Quantity)
        return real_array(value.magnitude if quantity else value), symbol(value.units, "~C") if quantity else None
    except UnitError as error:
        raise UnitError(f'{name}: {error}; give one value, or several as in Q([1, 2], "kN") or [0.3, 0.4]') from None
