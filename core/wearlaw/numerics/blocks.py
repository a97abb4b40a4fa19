"""Evaluation of operating points block by block, so that the arrays of a block stay in the cache."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, TypeAlias, TypeVar

import numpy as np

from wearlaw.contact.problem import Problem
from wearlaw.errors import ConditionsError

ResultT = TypeVar("ResultT")
"""An array with an entry for each operating point, or a named tuple of such arrays, tuples and None."""

OfBlock: TypeAlias = Callable[[Problem, slice], ResultT]
"""A function of a block of operating points and of the block's slice in the whole problem."""

OnBlock: TypeAlias = Callable[[Problem, ResultT], None]
"""A function called with a block of operating points and its results."""

KEPT = 2**24
"""Bytes that are allocated and freed before the first of several blocks. The C library of Linux then keeps twice as
much of the memory that a block frees, for the next block. Otherwise it would return the memory to the system and
request it again, which takes as long as the arithmetic."""


def each(function: Callable[..., Any], first: Any, *others: Any) -> Any:
    """Return results with a function applied to each array; of several like ones, to the arrays in one place."""
    if first is None:
        return None
    if not isinstance(first, tuple):
        return function(first, *others)
    parts = [each(function, *some) for some in zip(first, *others, strict=True)]
    return type(first)(*parts) if hasattr(first, "_fields") else tuple(parts)


def by_block(
    problem: Problem,
    block: int,
    function: OfBlock[ResultT],
    on_block: OnBlock[ResultT] | None = None,
    kept: Callable[[ResultT], ResultT] | None = None,
) -> ResultT:
    """Evaluate a function of a problem with at most one batch axis block by block, and return its results.

    Of several blocks, `kept` returns what is kept of their results after `on_block` has seen them.
    """
    points = problem.size
    if points == 0:
        raise ConditionsError("problem: holds no operating points; give at least one")
    if points <= block:
        only = function(problem, slice(0, points))
        if on_block is not None:
            on_block(problem, only)
        return only
    np.empty(KEPT, dtype=np.uint8)
    whole: Any = None
    for part in blocks(points, block):
        within = problem[part]
        found = function(within, part)
        if on_block is not None:
            on_block(within, found)
        if kept is not None:
            found = kept(found)
        if whole is None:
            whole = each(lambda values: np.empty((points, *values.shape[1:])), found)
        each(lambda values, own, part=part: values.__setitem__(part, own), whole, found)
    return whole  # type: ignore[no-any-return]


def blocks(points: int, block: int) -> Iterator[slice]:
    """Return the slice of each block."""
    return (slice(first, min(first + block, points)) for first in range(0, points, block))
