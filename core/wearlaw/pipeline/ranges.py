"""Checks whether operating points stay elastic and within the range of a wear law."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping
from functools import partial

import numpy as np

from wearlaw.arrays.array import Array
from wearlaw.arrays.extremes import extremes
from wearlaw.contact.elastic_limit import Overload, overload
from wearlaw.contact.problem import CreepForces, Problem
from wearlaw.errors import ModelError, RangeWarning
from wearlaw.models.contact_model import Blame
from wearlaw.models.wear_law import WearLaw
from wearlaw.numerics.blocks import Columns
from wearlaw.units.quantities import from_si
from wearlaw.units.variables import UNITS


class RangeWatch:
    """Sees operating points block by block and warns once for each variable that leaves the law's range.

    Attributes
    ----------
    overload : Overload or None
        The operating point furthest beyond first yield.
    """

    def __init__(self, law: WearLaw | None) -> None:
        self.law = law
        self.range: Mapping[str, tuple[float, float]] = {}
        if law is not None:
            with Blame(law):
                self.range = law.valid_range
        self.seen = {name: _Seen() for name in self.range}
        self.points = 0
        self.overload: Overload | None = None

    def see(self, points: int, mean_over_patch: Callable[[str], Array]) -> None:
        """Record a number of operating points; `mean_over_patch` returns the mean of a variable of `Contact` in SI."""
        self.points += points
        for name, (low, high) in self.range.items():
            values = mean_over_patch(name)
            lowest, highest = extremes(values)
            seen = self.seen[name]
            seen.lowest, seen.highest = min(seen.lowest, lowest), max(seen.highest, highest)
            if lowest < low:
                seen.outside += int(np.count_nonzero(values < low))
            if highest > high:
                seen.outside += int(np.count_nonzero(values > high))

    def see_block(self, part: Problem, columns: Columns) -> None:
        """Record a block of operating points, with forces [N] and areas [m²] in columns."""
        self.see(part.size, partial(mean_over_patch, part, columns))
        self.see_overload(overload_of(part, tangential_force(part, columns)))

    def see_overload(self, overload: Overload | None) -> None:
        """Record an operating point beyond first yield if none so far lies further beyond."""
        if overload is not None:
            self.overload = overload if self.overload is None else max(self.overload, overload)

    def warn(self, stacklevel: int) -> None:
        """Warn of points beyond first yield or out of range; `stacklevel` 1 is the caller."""
        if self.overload is not None:
            self.overload.warn(stacklevel + 1)
        for name, seen in self.seen.items():
            if self.law is not None and seen.outside:
                low, high = self.range[name]
                farthest = seen.highest if seen.highest > high else seen.lowest
                shown = [repr(from_si(value, UNITS[name])) for value in (low, high, farthest)]
                warnings.warn(
                    f"wear law '{self.law.name}' is stated for a mean {name.replace('_', ' ')} from {shown[0]} to"
                    f" {shown[1]}; {seen.outside} of {self.points} operating points lie outside, as far as {shown[2]}",
                    RangeWarning,
                    stacklevel=stacklevel + 1,
                )


class _Seen:
    """Extremes of one variable, and the number of points out of range."""

    def __init__(self) -> None:
        self.lowest, self.highest, self.outside = np.inf, -np.inf, 0


def mean_over_patch(problem: Problem, columns: Columns, variable: str) -> Array:
    """Return the mean of a variable of `Contact` over the patch, from forces [N] and areas [m²] in columns.

    The slip is the rigid slip, as in `Contact.of_patch`.
    """
    match variable:
        case "slip":
            return problem.rigid_slip
        case "slip_speed":
            return problem.rigid_slip * problem.rolling_speed
        case "wear_index":
            return _power(problem, columns)
    area = columns.get("patch_area", problem.patch_area)
    match variable:
        case "pressure":
            return problem.normal_force / area
        case "traction":
            return tangential_force(problem, columns) / area
        case "wear_index_density":
            return _power(problem, columns) / area
    raise ModelError(f"`valid_range` names '{variable}', which is no variable of a contact that has a patch mean")


def overload_of(problem: Problem, tangential_force: Array) -> Overload | None:
    """Return the operating point furthest beyond first yield of a body, or None if all are elastic.

    Parameters
    ----------
    problem : Problem
    tangential_force : ndarray
        Magnitude of the tangential force [N], of the batch shape; NaN where there is no patch.
    """
    strengths = {body.strength for body in problem.bodies.values() if body.strength is not None}
    if not strengths:
        return None
    if problem.exists is not None:
        tangential_force, problem = tangential_force[problem.exists], problem.existing()
    return overload(
        strengths,
        problem.max_pressure,
        tangential_force / problem.normal_force,
        problem.friction_coefficient,
        None if problem.geometry == "line" else problem.a / problem.b,
    )


def tangential_force(problem: Problem, columns: Columns) -> Array:
    """Return the magnitude of the tangential force [N]."""
    if problem.geometry == "line":  # zero lateral forces would add a tenth to the time of a prediction
        return np.abs(columns["longitudinal"])
    return CreepForces.of(columns).tangential


def _power(problem: Problem, columns: Columns) -> Array:
    if problem.geometry == "line":
        return problem.longitudinal_creepage * columns["longitudinal"]
    return problem.power(CreepForces.of(columns))
