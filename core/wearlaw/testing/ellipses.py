"""Elliptic problems for the checks, and what their forces and energies are measured against.

Creepages are given *reduced*, as the forces of Kalker's linear theory that they cause, over μN. A translation then
saturates near 3 whatever the patch: at 3 in the theory of Vermeulen and Johnson, ASME J. Appl. Mech. 31 (1964) 338-340,
and at 32/(3π) in FASTSIM with a parabolic bound, where ξ/L1 is the steepest slope of the bound, 4μN/(πa²b).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from wearlaw.arrays.array import Array
from wearlaw.contact import kalker
from wearlaw.contact.material import steel
from wearlaw.contact.problem import CreepForces, Problem
from wearlaw.models.contact_model import ContactModel
from wearlaw.rigs.twin_disc import TwinDisc
from wearlaw.rigs.wheel_rail import WheelRail
from wearlaw.testing.examples import SAME, SUM, assert_close
from wearlaw.testing.shared_checks import friction_limit

SATURATION = (3.0, 32.0 / (3.0 * np.pi))
"""Reduced creepages at which a theory may saturate."""

ELASTIC = steel(shear_yield_stress=None)
"""Steel of unknown strength, of whose plastic flow nothing warns."""

TWIN_DISC = TwinDisc.suros(material=ELASTIC)
"""The rig of the University of Sheffield."""

WHEEL_RAIL = WheelRail(wheel_radius="460 mm", rail_head_radius="300 mm", material=ELASTIC, rolling_speed="30 m/s")
"""A new wheel on straight track."""


class Creepages(NamedTuple):
    """Creepages, in SI or reduced."""

    longitudinal: Array
    lateral: Array
    spin: Array

    @classmethod
    def of(cls, problem: Problem) -> Creepages:
        """Return the creepages of a problem."""
        return cls(problem.longitudinal_creepage, problem.lateral_creepage, problem.spin)

    def times(self, *factors: Array | float) -> Creepages:
        """Return creepages multiplied by a factor each, or by a single one."""
        return Creepages(
            *(creepage * factor for creepage, factor in zip(self, factors * (3 // len(factors)), strict=True))
        )


def unit_creepages(problem: Problem) -> Creepages:
    """Return the creepages that are 1 when reduced: μN/(G ab C11), μN/(G ab C22) and μN/(G ab √(ab) C23)."""
    known = kalker.coefficients(problem.a / problem.b, problem.poisson_ratio)
    area = problem.a * problem.b
    unit = problem.friction_coefficient * problem.normal_force / (problem.shear_modulus * area)
    return Creepages(unit / known.c11, unit / known.c22, unit / (np.sqrt(area) * known.c23))


def at_reduced(problem: Problem, longitudinal: Array | float, lateral: Array | float, spin: Array | float) -> Problem:
    """Return the problem at reduced creepages, to which its batch broadcasts."""
    shape = np.broadcast_shapes(problem.batch_shape, np.shape(longitudinal), np.shape(lateral), np.shape(spin))
    problem = problem.broadcast_to(shape)
    units = unit_creepages(problem)
    return problem.with_creepages(longitudinal * units[0], lateral * units[1], spin * units[2])


def at_magnitude(problem: Problem, reduced: Array | float, spin: Array | float = 0.0) -> Problem:
    """Return the problem with creepages of the same direction and of a reduced magnitude, and with a spin in SI."""
    units = unit_creepages(problem)
    size = np.hypot(problem.longitudinal_creepage / units.longitudinal, problem.lateral_creepage / units.lateral)
    factor = reduced / size
    creepages = (problem.longitudinal_creepage * factor, problem.lateral_creepage * factor)
    return problem.with_creepages(*creepages, np.broadcast_to(np.float64(spin), problem.batch_shape))


def random_ellipses(points: int) -> Problem:
    """Return patches of many shapes, loads and frictions, the same at every call.

    Reduced creepages go from 0.3, where the slip zone is a tenth of the patch, to 3.5, and have random directions.
    Every other patch spins.
    """
    random = np.random.default_rng(6)

    def between(low: float, high: float) -> Array:
        return 10.0 ** random.uniform(np.log10(low), np.log10(high), points)

    size, ratio = between(1e-4, 2e-2), between(0.1, 10.0)
    a, b, shear_modulus = size * np.sqrt(ratio), size / np.sqrt(ratio), between(1e9, 1e12)
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
    size, angle = between(0.3, 3.5), random.uniform(-np.pi, np.pi, points)
    spin = between(0.1, 3.0) * random.choice([-1.0, 1.0], points) * (np.arange(points) % 2)
    return at_reduced(problem, size * np.cos(angle), size * np.sin(angle), spin)


def translation(problem: Problem) -> Array:
    """Return the magnitude of the creepage, √(ξ²+η²)."""
    magnitude: Array = np.hypot(problem.longitudinal_creepage, problem.lateral_creepage)
    return magnitude


def lever(problem: Problem) -> Array:
    """Return √((a²+b²)/5) [m], the rms distance of Hertz's pressure from the centre."""
    arm: Array = np.hypot(problem.a, problem.b) / np.sqrt(5.0)
    return arm


def sliding_power(problem: Problem) -> Array:
    """Return the dissipation of full slip per metre rolled [N], without the reduction of slip by spin."""
    return friction_limit(problem) * (translation(problem) + np.abs(problem.spin) * lever(problem))


def error_of_sums(model: ContactModel) -> float:
    """Return the error of sums over the nodes: rounding where one node holds the means."""
    return SAME if model.scale == "patch" else model.elliptic_accuracy


def assert_same_forces(
    problem: Problem, found: CreepForces, due: CreepForces, message: str, error: float = SUM
) -> None:
    """Assert that forces and moment agree to a share of μN, or of the force where it is larger."""
    size = np.maximum(friction_limit(problem), due.tangential)
    for name, words in {"longitudinal": "Fx", "lateral": "Fy", "spin_moment": "Mz"}.items():
        known = getattr(due, name)
        arm = lever(problem) if name == "spin_moment" else 1.0
        allowed = error * np.maximum(size * arm, np.abs(known))
        assert_close(getattr(found, name), known, f"{words} {message}", 0.0, allowed)
