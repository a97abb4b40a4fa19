"""Watching whether operating points stay in the range that a wear law is stated for."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping

import numpy as np

from wearlaw.arrays.array import Array
from wearlaw.arrays.extremes import extremes
from wearlaw.contact.problem import CreepForces, Problem
from wearlaw.errors import ModelError, RangeWarning
from wearlaw.models.contact_model import Blame
from wearlaw.models.wear_law import WearLaw
from wearlaw.numerics.blocks import Columns
from wearlaw.units.quantities import from_si
from wearlaw.units.variables import UNITS


class RangeWatch:
    """Sees operating points block by block and warns once for each variable that leaves the law's range."""

    def __init__(self, law: WearLaw | None) -> None:
        self.law = law
        self.range: Mapping[str, tuple[float, float]] = {}
        if law is not None:
            with Blame(law):
                self.range = law.valid_range
        self.seen = {name: _Seen() for name in self.range}
        self.points = 0

    def see(self, points: int, mean_over_patch: Callable[[str], Array]) -> None:
        """Take note of so many operating points; `mean_over_patch` gives a variable of `Contact` as its mean in SI."""
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

    def warn(self, stacklevel: int) -> None:
        """Warn of what has been seen; `stacklevel` 1 is the caller."""
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
    """What has been seen of one variable."""

    def __init__(self) -> None:
        self.lowest, self.highest, self.outside = np.inf, -np.inf, 0


def mean_over_patch(problem: Problem, columns: Columns, variable: str) -> Array:
    """Return a variable of `Contact` as its mean over the patch, from forces [N] and areas [m²] in columns.

    The slip is the rigid one, as in `Contact.of_patch`.
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
            on_line = problem.geometry == "line"
            return (np.abs(columns["longitudinal"]) if on_line else CreepForces.of(columns).tangential) / area
        case "wear_index_density":
            return _power(problem, columns) / area
    raise ModelError(f"`valid_range` names '{variable}', which is no variable of a contact that has a patch mean")


def _power(problem: Problem, columns: Columns) -> Array:
    if problem.geometry == "line":  # of which forces across take a tenth of the time of a prediction
        return problem.longitudinal_creepage * columns["longitudinal"]
    return problem.power(CreepForces.of(columns))
