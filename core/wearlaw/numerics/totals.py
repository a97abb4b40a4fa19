"""What the integrator returns, outcomes of laws, forces and slip at operating points, and how: block by block."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import cache
from typing import Any, NamedTuple, TypeAlias, TypeVar

import numpy as np

from wearlaw.arrays import Array
from wearlaw.contact.contact import Contact
from wearlaw.contact.parts import CreepForces
from wearlaw.contact.problem import Problem
from wearlaw.errors import ConditionsError


class SlipTotals(NamedTuple):
    """Slip of the patch at each operating point, as SI arrays of the batch shape.

    Attributes
    ----------
    mean_slip : ndarray
        Area mean of the magnitude of the slip [-].
    slip_area : ndarray
        Area of the slip zone [m²].
    patch_area : ndarray
        Area of the whole patch, the sum of its nodes' areas [m²].
    cell_wear_index : ndarray
        Energy dissipated per metre rolled, summed over the nodes [N].
    """

    mean_slip: Array
    slip_area: Array
    patch_area: Array
    cell_wear_index: Array

    @classmethod
    def of(cls, contact: Contact) -> SlipTotals:
        """Return the slip of a contact."""
        return cls(*(getattr(contact, name) for name in cls._fields))


class Across(NamedTuple):
    """Wear and slip integrated along each strip, as SI arrays of the batch shape and an axis of strips.

    Attributes
    ----------
    y : ndarray, (batch, strips)
        Position of each strip [m].
    width : ndarray, (batch, strips)
        Width that it represents [m].
    wear : ndarray, (batch, strips)
        ∫ rate dx along it [kg/m²].
    slid : ndarray, (batch, strips)
        ∫ |s| dx along it [m].
    """

    y: Array
    width: Array
    wear: Array
    slid: Array

    @classmethod
    def missing(cls, problem: Problem) -> Across:
        """Return the strips of a problem none of whose patches exists, two of NaN."""
        none = problem.unflatten(np.empty((0, 2)))
        return cls(none, none, none, none)

    @classmethod
    def of(cls, contact: Contact, wear: Array) -> Across:
        """Return the slip of a contact on strips, with the wear along them."""
        return cls(contact.y[..., 0, :], contact.strip_width, wear, contact.over_strip(contact.slip))


class Totals(NamedTuple):
    """Outcomes of laws and forces at each operating point, as SI arrays of the batch shape.

    Attributes
    ----------
    values : tuple of ndarray
        The outcome of each law: the area mean of its rate over the patch, or its value of the patch.
    errors : tuple of ndarray or None
        Estimate of the numerical error of each outcome; None if `outcome_error` computes the estimate.
    forces : CreepForces or None
        The forces and the moment; None if the contact model knows them without nodes.
    patch_area : ndarray or None
        Area of the patch, the sum of its nodes' areas [m²]; None if it equals the area of the problem.
    sliding : ndarray or None
        For laws in p·s: μ∫p·s dA over Tγ = ξFx + ηFy + φMz [-], which is 1 under Coulomb's law, q = μp in slip.
    slip : SlipTotals or None
        The slip, if a patch that is not a line has several blocks; their contacts are not kept.
    across : tuple of Across or None
        Wear and slip of each law along the model's own strips; None on a line, for a law of the patch, and where there
        are too many strips.
    contact : Contact or None
        The solved contact if all points were solved at once, on nodes that cover the patch; of the batch shape or with
        one batch axis.
    """

    values: tuple[Array, ...] = ()
    errors: tuple[Array | None, ...] = ()
    forces: CreepForces | None = None
    patch_area: Array | None = None
    sliding: Array | None = None
    slip: SlipTotals | None = None
    across: tuple[Across | None, ...] = ()
    contact: Contact | None = None

    @classmethod
    def missing(cls, problem: Problem, laws: Sequence[object]) -> Totals:
        """Return the totals of a problem that is not solved, such as one none of whose patches exists."""
        none = np.full(problem.batch_shape, np.nan)
        every, forces = (none,) * len(laws), CreepForces(longitudinal=none, lateral=none, spin_moment=none)
        slip, across = SlipTotals(none, none, none, none), (None,) * len(laws)
        return cls(every, every, forces, patch_area=none, slip=slip, across=across)

    def tangential_force(self, problem: Problem) -> Array:
        """Return the magnitude of the tangential force [N]."""
        assert self.forces is not None
        return np.abs(self.forces.longitudinal) if problem.geometry == "line" else self.forces.tangential

    def power(self, problem: Problem) -> Array:
        """Return the energy dissipated per metre rolled, Tγ [N]."""
        assert self.forces is not None
        if problem.geometry == "line":  # much faster
            return problem.longitudinal_creepage * self.forces.longitudinal
        return problem.power(self.forces)

    def mean(self, problem: Problem, variable: str) -> Array:
        """Return the mean of a variable of `Contact` over the patch; the slip is the rigid slip, as in `of_patch`."""
        match variable:
            case "slip":
                return problem.rigid_slip
            case "slip_speed":
                return problem.rigid_slip * problem.rolling_speed
            case "wear_index":
                return self.power(problem)
        area = problem.patch_area if self.patch_area is None else self.patch_area
        match variable:
            case "pressure":
                return problem.normal_force / area
            case "traction":
                return self.tangential_force(problem) / area
            case "wear_index_density":
                return self.power(problem) / area
        assert variable == "frictional_power_density"  # `Law.check_variables` knows these
        return self.power(problem) / area * problem.rolling_speed


ResultT = TypeVar("ResultT")
"""An array with an entry for each operating point, forces, or a named tuple of such arrays, tuples and None."""

OfBlock: TypeAlias = Callable[[Problem, slice], ResultT]
"""A function of a block of operating points and of the block's slice in the whole problem."""

OnBlock: TypeAlias = Callable[[Problem, ResultT], None]
"""A function called with a block of operating points and its results."""

LARGE = 1000
"""Operating points from which on `keep_memory` pays."""


@cache
def keep_memory() -> None:
    """Make the C library of Linux keep the memory of freed arrays of up to 31 MiB for the next ones.

    Freeing an array of that size does it. Otherwise the library would return the memory to the system and request it
    again, which takes as long as the arithmetic.
    """
    np.empty(31 * 2**20, dtype=np.uint8)


def each(function: Callable[..., Any], first: Any, *others: Any) -> Any:
    """Return results with a function applied to each array; of several like ones, to the arrays in one place."""
    if first is None:
        return None
    if isinstance(first, CreepForces):
        names, every = CreepForces.__slots__, (first, *others)
        return CreepForces(**{name: each(function, *(getattr(some, name) for some in every)) for name in names})
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
    if points >= LARGE:
        keep_memory()
    if points <= block:
        only = function(problem, slice(0, points))
        if on_block is not None:
            on_block(problem, only)
        return only
    whole: Any = None
    for part in blocks(points, block):
        within = problem[part]
        results = function(within, part)
        if on_block is not None:
            on_block(within, results)
        if kept is not None:
            results = kept(results)
        if whole is None:
            whole = each(lambda values: np.empty((points, *values.shape[1:])), results)
        each(lambda values, entries, part=part: values.__setitem__(part, entries), whole, results)
    return whole  # type: ignore[no-any-return]


def blocks(points: int, block: int) -> Iterator[slice]:
    """Return the slice of each block."""
    return (slice(first, min(first + block, points)) for first in range(0, points, block))
