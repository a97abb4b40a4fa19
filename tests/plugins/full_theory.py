"""Contacts solved with CONTACT, and how far the forces of a contact model are from them.

The files in tests/data name their source and licence. Forces have the signs of the creepages, unlike there.
"""

from __future__ import annotations

import csv
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import wearlaw as wl
from wearlaw import Array, Q

DATA = Path(__file__).parents[1] / "data"


@dataclass(frozen=True)
class Reference:
    """Operating points with their forces [N] and Tγ [N]."""

    names: list[str]
    problem: wl.EllipticProblem
    force_x: Array
    force_y: Array
    wear_index: Array

    @property
    def bound(self) -> Array:
        """μN [N]."""
        return self.problem.friction_coefficient * self.problem.normal_force

    def force_deviation(self, model: wl.ContactModel) -> Array:
        """Return by how much the magnitude of the force is too high, over μN."""
        found = model.creep_forces(self.problem).tangential
        deviation: Array = (found - np.hypot(self.force_x, self.force_y)) / self.bound
        return deviation

    def distance(self, model: wl.ContactModel) -> Array:
        """Return the magnitude of the difference of the forces, over μN."""
        found = model.creep_forces(self.problem)
        distance: Array = np.hypot(found.longitudinal - self.force_x, found.lateral - self.force_y) / self.bound
        return distance

    def energy_deviation(self, model: wl.ContactModel) -> Array:
        """Return by which share Tγ is too high."""
        return self.problem.power(model.creep_forces(self.problem)) / self.wear_index - 1.0

    def at(self, name: str) -> int:
        return self.names.index(name)


def rows(name: str) -> list[dict[str, str]]:
    lines = (DATA / name).read_text(encoding="utf-8").splitlines()
    return list(csv.DictReader(line for line in lines if not line.startswith("#")))


def creep_curve() -> Reference:
    """Return a locomotive wheel in pure longitudinal creepage from 1e-5 to 0.25, at a = b/2, by the full theory."""
    table = rows("creep_curve.csv")
    creepage, force = (np.array([float(row[column]) for row in table]) for column in ("xi", "fx"))
    problem = wl.EllipticProblem(
        a=Q(6.304, "mm"),
        b=Q(12.61, "mm"),
        normal_force=Q(106.7, "kN"),
        shear_modulus=Q(82, "GPa"),
        poisson_ratio=0.28,
        friction_coefficient=0.33,
        longitudinal_creepage=Q(creepage, ""),
        lateral_creepage=Q(0, ""),
        spin=Q(0, "1/m"),
    )
    return Reference([row["xi"] for row in table], problem, -force, np.zeros_like(force), -creepage * force)


def spheres(method: str) -> Reference:
    """Return pure creepages, spin and combinations at a = b, by a method of the file."""
    table = rows("hertz3d_reference.csv")

    def column(name: str) -> Array:
        return np.array([float(row[name]) for row in table])

    problem = wl.EllipticProblem(
        a=Q(6, "mm"),
        b=Q(6, "mm"),
        normal_force=Q(100, "kN"),
        shear_modulus=Q(82, "GPa"),
        poisson_ratio=0.28,
        friction_coefficient=0.3,
        longitudinal_creepage=Q(column("xi"), ""),
        lateral_creepage=Q(column("eta"), ""),
        spin=Q(column("phi"), "1/mm"),
    )
    force_x, force_y = -3e4 * column(f"{method}_fx"), -3e4 * column(f"{method}_fy")
    return Reference([row["case"] for row in table], problem, force_x, force_y, column(f"{method}_Tgamma"))
