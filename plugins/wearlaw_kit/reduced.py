"""Contact problems for the checks: random ones, and their creepages *reduced* by the size that saturates.

On a line, reduced creepages are over μa/R, at which Carter's theory slips everywhere. On an ellipse they are the forces
of Kalker's linear theory that they cause, over μN. A translation then saturates near 3 whatever the patch: at 3 in the
theory of Vermeulen and Johnson, ASME J. Appl. Mech. 31 (1964) 338-340, and at 32/(3π) in FASTSIM with a parabolic
bound, where ξ/L1 is the steepest slope of the bound, 4μN/(πa²b).
"""

from __future__ import annotations

from collections.abc import Mapping
from contextvars import ContextVar

import numpy as np
from numpy.typing import ArrayLike

from wearlaw import kalker
from wearlaw.arrays import Array
from wearlaw.contact.conditions import Condition
from wearlaw.contact.parts import CreepForces, Strips
from wearlaw.contact.problem import Problem
from wearlaw.units.quantities import Unit
from wearlaw.units.registry import unit_in_si

SATURATION = (3.0, 32.0 / (3.0 * np.pi))
"""Reduced creepages at which a theory of ellipses may saturate."""

FULL_SLIP = (1.0, 1.5)
"""Reduced creepages at which Carter's theory and FASTSIM slip everywhere on a line."""

STRIP_AT = np.linspace(-0.95, 0.95, 20)
"""Positions y/b of the strips of a patch."""

STRIP_WIDTH = np.full(20, 0.1)
"""Widths of the strips over b."""


def in_strips(problem: Problem, lean: float = 1.0) -> Problem:
    """Return an elliptic problem cut into strips, each longer and under less pressure the further they lie on one side.

    Their middles lie askew. Without `lean`, they are those of the ellipse. The load is that of the ellipse, which
    stands for the patch in Kalker's coefficients.
    """
    y, width = (share * problem.b[..., None] for share in (STRIP_AT, STRIP_WIDTH))
    root = np.sqrt(1.0 - STRIP_AT**2)
    shares = root * (1.0 + 0.2 * lean * STRIP_AT), 0.2 * lean * STRIP_AT
    half_length, x = (problem.a[..., None] * share for share in shares)
    shape = np.broadcast_to(root * (1.0 - 0.3 * lean * STRIP_AT), y.shape)
    load = (0.5 * np.pi * half_length * width * shape).sum(axis=-1)
    max_pressure = shape * (problem.normal_force / load)[..., None]
    fields = ("friction_coefficient", "longitudinal_creepage", "lateral_creepage", "spin", "rolling_speed", "density")
    return Problem.of_strips(
        Strips(y=y, width=width, half_length=half_length, max_pressure=max_pressure, x=x),
        shear_modulus=problem.shear_modulus,
        poisson_ratio=problem.poisson_ratio,
        a=problem.a,
        b=problem.b,
        **{name: getattr(problem, name) for name in fields},
    )


def friction_limit(problem: Problem) -> Array:
    """Return μN."""
    return problem.friction_coefficient * problem.normal_force


def translation(problem: Problem) -> Array:
    """Return the magnitude of the creepage, √(ξ²+η²)."""
    magnitude: Array = np.hypot(problem.longitudinal_creepage, problem.lateral_creepage)
    return magnitude


def lever(problem: Problem) -> Array:
    """Return √((a²+b²)/5) [m], the rms distance of Hertz's pressure on an ellipse from the centre."""
    arm: Array = np.hypot(problem.a, problem.b) / np.sqrt(5.0)
    return arm


def sliding_power(problem: Problem) -> Array:
    """Return the dissipation of full slip per metre rolled [N], without the reduction of slip by spin."""
    return friction_limit(problem) * (translation(problem) + np.abs(problem.spin) * lever(problem))


def parts_of_power(problem: Problem, forces: CreepForces) -> Array:
    """Return |ξFx| + |ηFy| + |φMz| [N], the scale of the rounding error of their sum."""
    return (
        np.abs(problem.longitudinal_creepage * forces.longitudinal)
        + np.abs(problem.lateral_creepage * forces.lateral)
        + np.abs(problem.spin * forces.spin_moment)
    )


def creeping(problem: Problem, *factors: Array | float) -> Problem:
    """Return the problem with ξ, η and φ multiplied by a factor each, or by a single one."""
    longitudinal, lateral, spin = factors * (3 // len(factors))
    return problem.with_creepages(
        problem.longitudinal_creepage * longitudinal, problem.lateral_creepage * lateral, problem.spin * spin
    )


def at_factors(problem: Problem, factors: ArrayLike) -> Problem:
    """Return the problems at their creepages times each factor, (points, factors)."""
    return creeping(problem[:, None].broadcast_to((problem.size, np.size(factors))), np.asarray(factors))


def without_spin(problem: Problem) -> Problem:
    """Return the problem with the same translation and no spin."""
    return creeping(problem, 1.0, 1.0, 0.0)


def unit_creepages(problem: Problem) -> tuple[Array, Array, Array]:
    """Return ξ, η and φ that are 1 when reduced.

    On a line μa/R and zeros, on an ellipse μN/(G ab C11), μN/(G ab C22) and μN/(G ab √(ab) C23).
    """
    if problem.geometry == "line":
        none = np.zeros(problem.batch_shape)
        return problem.friction_coefficient * problem.half_width / problem.relative_radius, none, none
    coefficients = kalker.coefficients(problem.a / problem.b, problem.poisson_ratio)
    area = problem.a * problem.b
    unit = friction_limit(problem) / (problem.shear_modulus * area)
    return unit / coefficients.c11, unit / coefficients.c22, unit / (np.sqrt(area) * coefficients.c23)


def at_reduced(problem: Problem, longitudinal: Array | float, lateral: Array | float, spin: Array | float) -> Problem:
    """Return the problem at reduced creepages, to which its batch broadcasts."""
    shape = np.broadcast_shapes(problem.batch_shape, np.shape(longitudinal), np.shape(lateral), np.shape(spin))
    problem = problem.broadcast_to(shape)
    units = unit_creepages(problem)
    return problem.with_creepages(longitudinal * units[0], lateral * units[1], spin * units[2])


def at_magnitude(problem: Problem, reduced: Array | float) -> Problem:
    """Return the problem with the same spin, and with a translation of the same direction and a reduced magnitude."""
    along, across, _ = unit_creepages(problem)
    lateral = problem.lateral_creepage
    size = np.hypot(
        problem.longitudinal_creepage / along, np.divide(lateral, across, out=np.zeros_like(across), where=across > 0.0)
    )
    return creeping(problem, reduced / size, reduced / size, 1.0)


CHECKED: ContextVar[Mapping[str, Condition]] = ContextVar("conditions of the model that is checked", default={})  # noqa: B039
"""The conditions that the model being checked declares, which every problem of the kit has then."""


def drawn(conditions: Mapping[str, Condition], shape: tuple[int, ...]) -> dict[str, Array]:
    """Return random values of conditions in SI, over what is usual or else by a factor of two about 1."""
    random = np.random.default_rng(0)
    values = {}
    for name, condition in conditions.items():
        unit = condition.unit or Unit("")
        low, high = unit.usual or (0.5, 2.0)
        values[name] = random.uniform(low, high, shape) * unit_in_si(unit.unit)
    return values


def under_conditions(problem: Problem) -> Problem:
    """Return the problem with values of the conditions that the model being checked declares."""
    values = drawn(CHECKED.get(), problem.batch_shape)
    return problem.replaced(conditions={**values, **problem.conditions}) if values else problem


def random_lines(points: int, seed: int = 5) -> Problem:
    """Return discs of many sizes and stiffnesses under many loads, frictions and speeds, the same for a seed.

    Creepages are uniform in their logarithm, from a thousandth of μa/R, where nearly all of the patch sticks, to ten
    times that; three quarters stick in part. Every eighth lies next to full slip in Carter's theory or in FASTSIM.
    """
    random = np.random.default_rng(seed)
    radius, modulus = 10.0 ** random.uniform(-3, 1, points), 10.0 ** random.uniform(9, 12, points)
    half_width = 2.0 * radius * 10.0 ** random.uniform(-5, np.log10(3e-2), points)
    friction = random.uniform(0.01, 1.5, points)
    return Problem.line_from_si(
        normal_force_per_width=0.25 * np.pi * modulus * half_width**2 / radius,
        relative_radius=radius,
        effective_modulus=modulus,
        friction_coefficient=friction,
        creepage=np.minimum(friction * half_width / radius * _reduced(random, points, (1e-3, 10.0), FULL_SLIP), 1.0),
        rolling_speed=10.0 ** random.uniform(-2, 2, points),
        track_width=10.0 ** random.uniform(-4, 0, points),
        density=random.uniform(1e3, 2e4, points),
    )


def _reduced(random: np.random.Generator, points: int, limits: tuple[float, float], full: tuple[float, ...]) -> Array:
    """Return reduced creepages, uniform in their logarithm; every eighth next to one of those of full slip."""
    anywhere = _between(random, points, *limits)
    gap = random.choice([-1.0, 1.0], points) * 10.0 ** random.uniform(-12, -1, points)
    return np.where(np.arange(points) % 8 == 7, random.choice(full, points) * (1.0 + gap), anywhere)


def wide_ellipses(points: int, seed: int = 7) -> Problem:
    """Return patches of one material, slender and round, in nearly full stick and in full slip, the same for a seed.

    Axis ratios a/b go from 1/20 to 20. Reduced creepages are uniform in their logarithm from 0.01 to 30, every eighth
    next to saturation, along x or y or between. Every other patch spins, by either sign. Nothing slips more than it
    rolls.
    """
    problem = _ellipses(points, seed, ratio=20.0, reduced=(1e-2, 30.0), spin=(1e-2, 10.0))
    fastest = translation(problem) + np.abs(problem.spin) * np.maximum(problem.a, problem.b)
    return creeping(problem, 1.0 / np.maximum(fastest, 1.0))


def random_ellipses(points: int) -> Problem:
    """Return patches of many shapes, loads and frictions in partial slip, the same at every call.

    Reduced creepages go from 0.3, where the slip zone is a tenth of the patch, to 3.5.
    """
    return _ellipses(points, 6, ratio=10.0, reduced=(0.3, 3.5), spin=(0.1, 3.0))


def _ellipses(points: int, seed: int, ratio: float, reduced: tuple[float, float], spin: tuple[float, float]) -> Problem:
    """Return patches with axis ratios up to one, and reduced creepages and spins, of every other one, in ranges."""
    random = np.random.default_rng(seed)

    def between(low: float, high: float) -> Array:
        return _between(random, points, low, high)

    mean, shape, shear_modulus = between(1e-4, 2e-2), between(1.0 / ratio, ratio), between(1e9, 1e12)
    a, b = mean * np.sqrt(shape), mean / np.sqrt(shape)
    problem = Problem.ellipse_from_si(
        a=a,
        b=b,
        normal_force=2.0 / 3.0 * np.pi * a * b * between(1e-4, 2e-2) * shear_modulus,
        shear_modulus=shear_modulus,
        poisson_ratio=random.uniform(0.0, 0.5, points),
        friction_coefficient=between(0.05, 1.0),
        longitudinal_creepage=np.zeros(points),
        lateral_creepage=np.zeros(points),
        spin=np.zeros(points),
        rolling_speed=between(0.1, 100.0),
        density=random.uniform(1e3, 2e4, points),
    )
    size = _reduced(random, points, reduced, SATURATION)
    along_axes = 0.5 * np.pi * (np.arange(points) // 2)
    angle = np.where(random.random(points) < 0.5, random.uniform(-np.pi, np.pi, points), along_axes)
    turning = between(*spin) * random.choice([-1.0, 1.0], points) * (np.arange(points) % 2)
    return at_reduced(problem, size * np.cos(angle), size * np.sin(angle), turning)


def _between(random: np.random.Generator, points: int, low: float, high: float) -> Array:
    """Return numbers that are uniform in their logarithm."""
    value: Array = 10.0 ** random.uniform(np.log10(low), np.log10(high), points)
    return value
