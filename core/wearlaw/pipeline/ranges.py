"""Checks whether operating points stay elastic and within the range of a wear law."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from wearlaw.arrays import Array, extremes, steady
from wearlaw.contact.elastic_limit import Overload, first_yield, overload, shakedown_limit
from wearlaw.contact.problem import Problem
from wearlaw.errors import CompositionError, RangeWarning, warn
from wearlaw.models.law import Law
from wearlaw.numerics.totals import Totals
from wearlaw.units.quantities import from_si, scalar_si
from wearlaw.units.usual import remark
from wearlaw.units.variables import UNITS

SLIDING = "sliding_ratio"
"""Name of `Totals.sliding` among the variables that a watch sees."""

SLIDING_RANGE = 0.95, 1.05
"""μ∫p·s dA over Tγ without a warning."""


class Seen(NamedTuple):
    """The extremes of a variable among points some of which are out of range [SI], and the number of these."""

    lowest: float
    highest: float
    outside: int

    def farthest(self, low: float, high: float) -> float:
        """Return the extreme that lies farther outside."""
        return self.highest if self.highest - high >= low - self.lowest else self.lowest


class RangeWatch:
    """Sees operating points block by block and warns once for each variable that leaves the range of a law.

    It also warns if a law goes with p·s where the contact model's ∫p·s dA is not that of Coulomb friction.

    Attributes
    ----------
    points : int
        The number of points seen.
    seen : dict of str to Seen
        The points outside, by the index of the law and the variable that leaves its range, as in "0 pressure", or by
        `SLIDING`.
    overload : Overload or None
        The operating point furthest beyond first yield.
    counted : str
        Word for the points in the warnings: each patch is one if a rig makes several.
    ratios : dict of str to float
        The greatest values that are unusual, by the name of the ratio.
    on_block : callable, optional
        Called after each block with the number of its operating points.
    """

    counted = "operating points"

    def __init__(self, *laws: Law, on_block: Callable[[int], None] | None = None) -> None:
        self.laws = laws
        self.on_block = on_block
        self.seen: dict[str, Seen] = {}
        self.ratios: dict[str, float] = {}
        self.points = 0
        self.overload: Overload | None = None

    def see(self, part: Problem, totals: Totals) -> None:
        """Record a block of operating points."""
        self.points += part.size
        for index, law in enumerate(self.laws):
            for name, ends in law.valid_range.items():
                self._see_values(index, name, totals.mean(part, name), ends)
        if totals.sliding is not None:
            self._see_values(None, SLIDING, totals.sliding, SLIDING_RANGE)
        self.overload = overload_of(part, totals.tangential_force(part), self.overload)
        if ratios := unusual_ratios(part, self.laws):
            self.see_ratios(ratios)
        if self.on_block is not None:
            self.on_block(part.size)

    def _see_values(self, law: int | None, name: str, values: Array, ends: tuple[float, float]) -> None:
        (lowest, highest), (low, high) = extremes(values), ends
        if lowest < low or highest > high:
            key = name if law is None else f"{law} {name}"
            self.see_outside(key, Seen(lowest, highest, int(((values < low) | (values > high)).sum())))

    def see_outside(self, key: str, more: Seen) -> None:
        """Record points outside the range of a law, by a key as in `seen`."""
        seen = self.seen.get(key, Seen(more.lowest, more.highest, 0))
        self.seen[key] = Seen(
            min(seen.lowest, more.lowest), max(seen.highest, more.highest), seen.outside + more.outside
        )

    def see_ratios(self, ratios: Mapping[str, float]) -> None:
        """Record the unusual ratios of a block."""
        for name, ratio in ratios.items():
            self.ratios[name] = max(ratio, self.ratios.get(name, ratio))

    def warn(self) -> None:
        """Warn of points beyond first yield, out of range or unusual."""
        if self.ratios:
            remark({RATIOS[name].subject: RATIOS[name].text.format(ratio) for name, ratio in self.ratios.items()})
        if self.overload is not None:
            self.overload.warn()
        if not self.seen:
            return
        for index, law in enumerate(self.laws):
            for name, ends in law.valid_range.items():
                self._warn_of_range(law, f"{index} {name}", name, ends)
        if SLIDING in self.seen:
            laws = dict.fromkeys(f"{law.kind} '{law.name}'" for law in self.laws if law.follows_pressure_times_slip)
            warn(
                f"{' and '.join(laws)}: the rate follows pressure times slip, p·s, but where the contact slips its"
                " traction is not μp, as with the parabolic bound of fastsim. ∫p·s dA is then not Tγ/μ, and the rate is"
                " off by about the same factor. The two agree with exact, for discs, and with strip_theory, for wheels;"
                f" {self._lie(SLIDING)} more than 5 % off, as far as"
                f" {self.seen[SLIDING].farthest(*SLIDING_RANGE):.3g} times Tγ/μ",
                RangeWarning,
            )

    def _warn_of_range(self, law: Law, key: str, name: str, ends: tuple[float, float]) -> None:
        if key not in self.seen:
            return
        low, high, far = (repr(from_si(value, UNITS[name])) for value in (*ends, self.seen[key].farthest(*ends)))
        calibration = law.calibration
        source = f" ({calibration.source})" if calibration and name in calibration.range_in_si else ""
        warn(
            f"{law.kind} '{law.name}' has a known range of mean {name.replace('_', ' ')} from {low} to {high}{source};"
            f" {self._lie(key)} outside, as far as {far}",
            RangeWarning,
        )

    def _lie(self, key: str) -> str:
        """Return how many points lie outside, as the beginning of a clause."""
        outside = self.seen[key].outside
        return f"{outside} of {self.points} {self.counted} {'lies' if outside == 1 else 'lie'}"


class Ratio(NamedTuple):
    """A ratio that no unit shows.

    Attributes
    ----------
    most : float
        Its greatest usual value.
    subject, text : str
        What a warning names, and what it says of it.
    """

    most: float
    subject: str
    text: str


RATIOS: Mapping[str, Ratio] = {
    "friction": Ratio(2.0, "friction_coefficient", "reaches {:.4g}, usually at most 2; is it in percent?"),
    "traction": Ratio(2.0, "traction_coefficient", "reaches {:.4g}, usually at most 2; is it in percent?"),
    "length": Ratio(
        0.3,
        "a",
        "half the patch's length reaches {:.2g} of a body's rolling radius, usually at most 0.3; theories of contact"
        " take the patch to be small. Check the load, the radii and Young's moduli",
    ),
    "width": Ratio(
        1.0,
        "b",
        "half the patch's width reaches {:.3g} times what is usual on such a body; check the load, the lateral radii"
        " and Young's moduli",
    ),
    "strain": Ratio(
        0.1,
        "max_pressure",
        "reaches {:.2g} of a body's Young's modulus, usually at most 0.1; check the load, the radii and Young's moduli",
    ),
    "hardness": Ratio(
        1.5,
        "hardness",
        "the maximum pressure reaches {:.3g} times the hardness of a law, usually at most 1.5; check the load and the"
        " hardness",
    ),
}
"""Ratios that only the contact shows. They are generous.

The hardness is the mean pressure of an indentation, so a body carries no Hertzian ellipse, whose mean is two thirds of
its maximum, beyond 1.5 times it (Tabor, The Hardness of Metals, 1951). Yield is told from the yield stress.
"""


def unusual_ratios(problem: Problem, laws: Iterable[Law] = ()) -> dict[str, float]:
    """Return the `RATIOS` of a problem that are unusual."""
    ratios: dict[str, float] = {}
    if problem.exists is not None:
        problem = problem.flatten()
        if not problem.size:
            return ratios
    pressure, a = extremes(problem.max_pressure)[1], extremes(problem.a)[1]
    b = 0.0 if problem.geometry == "line" else extremes(problem.b)[1]
    every = [("friction", extremes(problem.friction_coefficient)[1])]
    if problem.traction_coefficient is not None:
        every.append(("traction", extremes(problem.traction_coefficient)[1]))
    for body in problem.bodies.values():
        radius = body.rolling_radius
        relative = extremes(problem.a / radius)[1] if isinstance(radius, np.ndarray) else a / radius
        every += ("strain", pressure / body.youngs_modulus), ("length", relative), ("width", b / body.usual_width)
    every += [("hardness", pressure / hardness_of(law, problem)) for law in laws if has_hardness(type(law))]
    for name, ratio in every:
        if ratio > RATIOS[name].most:
            ratios[name] = max(ratio, ratios.get(name, ratio))
    return ratios


@cache
def has_hardness(law: type[Law]) -> bool:
    """Return whether laws of a class have a field `hardness`."""
    return "hardness" in law.model_fields


def hardness_of(law: Law, problem: Problem) -> float:
    """Return the field `hardness` of a law, or else of the material that wears [Pa]; infinite if neither has one."""
    hardness: float | None = law.numbers.get("hardness")
    if hardness is None and problem.bodies:
        body = problem.bodies.get(law.body or "", next(iter(problem.bodies.values())))
        stated = getattr(body.material, "hardness", None)
        hardness = None if stated is None else scalar_si(stated, "Pa")
    return np.inf if hardness is None else hardness


def overload_of(problem: Problem, tangential_force: Array, worst: Overload | None = None) -> Overload | None:
    """Return the operating point furthest beyond first yield of a body, or None if all are elastic.

    The tangential force [N] is a magnitude; `worst` is the furthest of other points.
    """
    strengths = {strength for body in problem.bodies.values() if (strength := body.strength)}
    if not strengths:
        return worst
    if problem.exists is not None:
        tangential_force, problem = tangential_force[problem.exists], problem.existing()
    traction, friction = tangential_force / problem.normal_force, problem.friction_coefficient
    axis_ratio = None if problem.geometry == "line" else problem.a / problem.b
    return overload(strengths, problem.max_pressure, traction, friction, axis_ratio, worst)


@steady
def outside_range(problem: Problem, totals: Totals, law: Law) -> NDArray[np.bool_]:
    """Return at which operating points a mean over the patch lies outside the law's range, of the batch shape."""
    outside = np.zeros(problem.batch_shape, dtype=np.bool_)
    for name, (low, high) in law.valid_range.items():
        values = totals.mean(problem, name)
        outside |= (values < low) | (values > high)
    return outside


@steady
def elastic_limits(problem: Problem, tangential_force: Array) -> tuple[Array, Array]:
    """Return Hertz's maximum pressure at first yield and at the shakedown limit [Pa], of the body that yields first.

    The tangential force [N] is a magnitude. Where it is NaN, since there is no patch, the limits are too.

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
    of_bodies = [
        (
            first_yield(k, traction, friction, poisson_ratio=nu, axis_ratio=ratio),
            shakedown_limit(k, traction, friction, axis_ratio=ratio),
        )
        for k, nu in strengths
    ]
    limits[:, there] = np.min(of_bodies, axis=0)
    return limits[0], limits[1]
