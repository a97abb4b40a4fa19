"""Checks whether operating points stay elastic and within the range of a wear law."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from functools import partial
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from wearlaw.arrays.array import Array, extremes, steady
from wearlaw.contact.elastic_limit import Overload, first_yield, overload, shakedown_limit
from wearlaw.contact.problem import CreepForces, Problem
from wearlaw.errors import CompositionError, ModelError, RangeWarning
from wearlaw.models.contact_model import Blame
from wearlaw.models.law import Law
from wearlaw.numerics.blocks import Columns
from wearlaw.numerics.integrate import SLIDING
from wearlaw.units.quantities import from_si
from wearlaw.units.variables import UNITS

SLIDING_TOLERANCE = 0.05
"""Share by which μ∫p·s dA may differ from Tγ without a warning."""


class RangeWatch:
    """Sees operating points block by block and warns once for each variable that leaves the range of a law.

    It also warns if a law goes with p·s where the contact model's ∫p·s dA is not that of Coulomb friction.

    Attributes
    ----------
    seen : dict of str to Seen
        The points outside, by the index of the law and the variable that leaves its range, as in "0 pressure", or by
        `SLIDING`.
    overload : Overload or None
        The operating point furthest beyond first yield.
    counted : str
        Word for the points in the warnings: each patch is one if a rig makes several.
    """

    counted = "operating points"

    def __init__(self, *laws: Law) -> None:
        self.laws = laws
        self.ranges: dict[str, tuple[float, float]] = {}
        for index, law in enumerate(laws):
            with Blame(law):
                self.ranges |= {f"{index} {name}": ends for name, ends in law.valid_range.items()}
        self.seen: dict[str, Seen] = {}
        self.points = 0
        self.overload: Overload | None = None

    def see(self, points: int, mean_over_patch: Callable[[str], Array]) -> None:
        """Record a number of operating points; `mean_over_patch` returns the mean of a variable of `Contact` in SI."""
        self.points += points
        for key, (low, high) in self.ranges.items():
            self._see_outside_of(key, mean_over_patch(key.partition(" ")[2]), low, high)

    def see_block(self, part: Problem, columns: Columns) -> None:
        """Record a block of operating points, with forces [N] and areas [m²] in columns."""
        self.see(part.size, partial(mean_over_patch, part, columns))
        self.overload = overload_of(part, tangential_force(part, columns), self.overload)
        if SLIDING in columns:
            self._see_outside_of(SLIDING, columns[SLIDING], 1.0 - SLIDING_TOLERANCE, 1.0 + SLIDING_TOLERANCE)

    def _see_outside_of(self, key: str, values: Array, low: float, high: float) -> None:
        lowest, highest = extremes(values)
        if lowest < low or highest > high:
            self.see_outside(key, Seen(lowest, highest, int(((values < low) | (values > high)).sum())))

    def see_outside(self, key: str, more: Seen) -> None:
        """Record points outside the range of a law, by a key as in `seen`."""
        known = self.seen.get(key, more)
        outside = more.outside if known is more else known.outside + more.outside
        self.seen[key] = Seen(min(known.lowest, more.lowest), max(known.highest, more.highest), outside)

    def warn(self, stacklevel: int) -> None:
        """Warn of points beyond first yield or out of range; `stacklevel` 1 is the caller."""
        if self.overload is not None:
            self.overload.warn(stacklevel + 1)
        for key, (low, high) in self.ranges.items():
            if key in self.seen:
                index, _, name = key.partition(" ")
                law, seen = self.laws[int(index)], self.seen[key]
                calibration = law.calibration
                farthest = seen.highest if seen.highest > high else seen.lowest
                shown = [repr(from_si(value, UNITS[name])) for value in (low, high, farthest)]
                lie = "lies" if seen.outside == 1 else "lie"
                source = f" ({calibration.source})" if calibration and name in calibration.range_in_si else ""
                warnings.warn(
                    f"{law.kind} '{law.name}' has a known range of mean {name.replace('_', ' ')} from {shown[0]} to"
                    f" {shown[1]}{source}; {seen.outside} of {self.points} {self.counted} {lie} outside, as far"
                    f" as {shown[2]}",
                    RangeWarning,
                    stacklevel=stacklevel + 1,
                )
        if SLIDING in self.seen:
            seen = self.seen[SLIDING]
            farthest = seen.highest if seen.highest - 1.0 >= 1.0 - seen.lowest else seen.lowest
            laws = [f"{law.kind} '{law.name}'" for law in self.laws if law.follows_pressure_times_slip]
            lie = "lies" if seen.outside == 1 else "lie"
            warnings.warn(
                f"{' and '.join(dict.fromkeys(laws))}: the rate follows pressure times slip, p·s, but where the"
                " contact slips its traction is not μp, as with the parabolic bound of fastsim. ∫p·s dA is then not"
                " Tγ/μ, and the rate is off by about the same factor. The two agree with exact, for discs, and with"
                f" strip_theory, for wheels; {seen.outside} of {self.points} {self.counted} {lie} more than"
                f" {100.0 * SLIDING_TOLERANCE:.0f} % off, as far as {farthest:.3g} times Tγ/μ",
                RangeWarning,
                stacklevel=stacklevel + 1,
            )


class Seen(NamedTuple):
    """The extremes of a variable among points some of which are out of range [SI], and the number of these."""

    lowest: float
    highest: float
    outside: int


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
        case "frictional_power_density":
            return _power(problem, columns) / area * problem.rolling_speed
    raise ModelError(f"`valid_range` names '{variable}', which is no variable of a contact that has a patch mean")


def overload_of(problem: Problem, tangential_force: Array, worst: Overload | None = None) -> Overload | None:
    """Return the operating point furthest beyond first yield of a body, or None if all are elastic.

    Parameters
    ----------
    problem : Problem
    tangential_force : ndarray
        Magnitude of the tangential force [N], of the batch shape; NaN where there is no patch.
    worst : Overload, optional
        The furthest of other points.
    """
    strengths = {body.strength for body in problem.bodies.values() if body.strength is not None}
    if not strengths:
        return worst
    if problem.exists is not None:
        tangential_force, problem = tangential_force[problem.exists], problem.existing()
    return overload(
        strengths,
        problem.max_pressure,
        tangential_force / problem.normal_force,
        problem.friction_coefficient,
        None if problem.geometry == "line" else problem.a / problem.b,
        worst,
    )


@steady
def outside_range(problem: Problem, columns: Columns, law: Law) -> NDArray[np.bool_]:
    """Return at which operating points a mean over the patch lies outside the law's range, of the batch shape."""
    outside = np.zeros(problem.batch_shape, dtype=np.bool_)
    for name, (low, high) in law.valid_range.items():
        values = mean_over_patch(problem, columns, name)
        outside |= (values < low) | (values > high)
    return outside


@steady
def elastic_limits(problem: Problem, tangential_force: Array) -> tuple[Array, Array]:
    """Return Hertz's maximum pressure at first yield and at the shakedown limit [Pa], of the body that yields first.

    Parameters
    ----------
    problem : Problem
    tangential_force : ndarray
        Magnitude of the tangential force [N], of the batch shape; NaN where there is no patch, and in the result.

    Raises
    ------
    CompositionError
        If no body's material has a `shear_yield_stress`.
    """
    strengths = {body.strength for body in problem.bodies.values() if body.strength is not None}
    if not strengths:
        raise CompositionError("elastic limit: no body's material has a shear_yield_stress; give one to its Material")
    there = np.isfinite(tangential_force)
    limits = np.full((2, *problem.batch_shape), np.nan)
    traction, friction = (tangential_force / problem.normal_force)[there], problem.friction_coefficient[there]
    ratio = 0.0 if problem.geometry == "line" else (problem.a / problem.b)[there]
    found = [
        (
            first_yield(k, traction, friction, poisson_ratio=nu, axis_ratio=ratio),
            shakedown_limit(k, traction, friction, axis_ratio=ratio),
        )
        for k, nu in strengths
    ]
    limits[:, there] = np.min(found, axis=0)
    return limits[0], limits[1]


def tangential_force(problem: Problem, columns: Columns) -> Array:
    """Return the magnitude of the tangential force [N]."""
    if problem.geometry == "line":  # zero lateral forces would add a tenth to the time of a prediction
        return np.abs(columns["longitudinal"])
    return CreepForces.of(columns).tangential


def _power(problem: Problem, columns: Columns) -> Array:
    if problem.geometry == "line":
        return problem.longitudinal_creepage * columns["longitudinal"]
    return problem.power(CreepForces.of(columns))
