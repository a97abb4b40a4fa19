"""Evaluation of operating points block by block, so that the arrays of a block stay in the cache."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TypeAlias

import numpy as np

from wearlaw.arrays.array import Array
from wearlaw.contact.problem import Problem
from wearlaw.errors import ConditionsError

Columns: TypeAlias = dict[str, Array]
"""Arrays with one entry for each operating point."""

OfBlock: TypeAlias = Callable[[Problem, slice], Columns]
"""A function of a block of operating points and of the block's slice in the whole problem."""

OnBlock: TypeAlias = Callable[[Problem, Columns], None]
"""A function called with a block of operating points and its results."""

KEPT = 2**24
"""Bytes that are allocated and freed before the first of several blocks. The C library of Linux then keeps twice as
much of the memory that a block frees, for the next block. Otherwise it would return the memory to the system and
request it again, which takes as long as the arithmetic."""


def by_block(
    problem: Problem,
    block: int,
    function: OfBlock,
    on_block: OnBlock | None = None,
    drop_force: bool = False,
) -> Columns:
    """Evaluate a function of a problem with at most one batch axis block by block, and return its columns.

    With `drop_force`, the forces are passed to `on_block` and not kept.
    """
    points = problem.size
    if points == 0:
        raise ConditionsError("problem: holds no operating points; give at least one")
    whole: Columns = {}
    if points > block:
        np.empty(KEPT, dtype=np.uint8)
    for part in blocks(points, block):
        within = problem if points <= block else problem[part]
        columns = function(within, part)
        if on_block is not None:
            on_block(within, columns)
        if drop_force:
            del columns["longitudinal"]
        if points <= block:
            whole = columns
            break
        whole = whole or {name: np.empty(points) for name in columns}
        for name, values in columns.items():
            whole[name][part] = values
    return whole


def blocks(points: int, block: int) -> Iterator[slice]:
    """Return the slice of each block."""
    return (slice(first, min(first + block, points)) for first in range(0, points, block))
