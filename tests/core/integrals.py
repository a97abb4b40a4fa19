"""Patch means of the wear laws by integrals of tests/reference.py, at points of a rig at random."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

import wearlaw as wl
from tests import reference
from tests.strategies import LINE_MODELS
from wearlaw import Array, Q
from wearlaw.numerics import integrate  # private: integrals at the size of blocks
from wearlaw.numerics.integrate import integrate_forces  # private: integrals at the size of blocks

Solve = Callable[[reference.Point], reference.Solution]
REFERENCE: dict[str, Solve] = {
    "exact": reference.exact,
    "exact-as_printed": lambda p: reference.exact(p, as_printed=True),
    "fastsim-parabolic-line": reference.parabolic,
    "fastsim-parabolic-kalker": lambda p: reference.parabolic(p, kalker=True),
    "fastsim-elliptic-line": reference.elliptic,
    "fastsim-elliptic-kalker": lambda p: reference.elliptic(p, kalker=True),
}
FULL_SLIP = {"line": 1.0, "kalker": 8.0 / (3.0 * math.pi)}
SPEED = 4.0
RIG = wl.TwinDisc.suros(rolling_speed=Q(SPEED, "m/s"))
USFD_GLOBAL = (5.3, 55.0, 61.9, 77.26)
KTH_MID = (350e-4, 5.5e-4, 35e-4, 5.5e-4)
MEANS: dict[str, Callable[[reference.Solution], float]] = {
    "usfd": lambda s: reference.usfd_mean(s, *USFD_GLOBAL),
    "kth": lambda s: reference.kth_mean(s, KTH_MID),
}


class Wear(NamedTuple):
    """What a pipeline shows of the wear, in SI."""

    wear_rate: Array
    wear_rate_error: Array
    tangential_force: Array


def integrate_wear(model: wl.ContactModel, law: wl.Law, problem: wl.Problem) -> Wear:
    """Return the wear, including the totals that are computed on demand."""
    totals = integrate.integrate_laws(model, (law,), problem)
    forces = totals.forces or integrate_forces(model, problem)
    error = integrate.outcome_error(model, law, problem, totals, 0)
    return Wear(totals.values[0], error, forces.longitudinal)


class Points:
    """Operating points of the rig at random, with the problem that they pose."""

    def __init__(self, seed: int, size: int) -> None:
        self.random = np.random.default_rng(seed)
        self.size = size
        self.pressure = self.random.uniform(0.3e9, 4e9, size)
        self.friction = self.random.uniform(0.05, 1.0, size)
        self.creepage = 10.0 ** self.random.uniform(-7.0, 0.0, size)

    def crowd(self) -> Array:
        """Return factors next to one on both sides."""
        gap = 10.0 ** self.random.uniform(-12.0, -1.0, self.size)
        crowded: Array = 1.0 + gap * self.random.choice([-1.0, 1.0], self.size)
        return crowded

    @property
    def saturation(self) -> Array:
        """μa/R, with a/R = 2 p0/E*."""
        saturation: Array = 2.0 * self.friction * self.pressure / float(self.problem.effective_modulus[0])
        return saturation

    @property
    def problem(self) -> wl.Problem:
        return RIG.problem(
            max_pressure=Q(self.pressure, "Pa"),
            creepage=Q(np.minimum(self.creepage, 1.0), ""),
            friction_coefficient=self.friction,
        )

    def references(self) -> list[reference.Point]:
        p = self.problem
        arrays = (p.normal_force_per_width, p.relative_radius, p.effective_modulus, p.friction_coefficient, p.creepage)
        columns = zip(*(array.tolist() for array in arrays), strict=True)
        return [reference.Point(p, r, e, mu, xi, SPEED) for p, r, e, mu, xi in columns]


def compare(name: str, law: str, points: Points) -> tuple[Array, Array, Array]:
    """Return the rates, those of the reference and the error estimates [µg/m/mm²]."""
    wear = integrate_wear(LINE_MODELS[name], wl.wear_law(law), points.problem)
    want = np.array([MEANS[law](REFERENCE[name](point)) for point in points.references()])
    return wear.wear_rate * 1e3, want, wear.wear_rate_error * 1e3
