"""Contacts solved with CONTACT, and how far the forces of a contact model are from them.

The files in tests/data name their source and licence. Forces have the signs of the creepages, unlike there.
"""

from __future__ import annotations

import csv
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

import wearlaw as wl
from wearlaw import Array, Q

DATA = Path(__file__).parents[1] / "data"


@dataclass(frozen=True)
class Reference:
    """Operating points with their forces [N] and Tγ [N]."""

    names: list[str]
    problem: wl.Problem
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


def locomotive(creepage: Array) -> wl.Problem:
    """Return a locomotive wheel in pure longitudinal creepage, at a = b/2."""
    return wl.Problem.ellipse(
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


def creep_curve() -> Reference:
    """Return the locomotive wheel at creepages from 1e-5 to 0.25, by the full theory."""
    table = rows("creep_curve.csv")
    creepage, force = (np.array([float(row[column]) for row in table]) for column in ("xi", "fx"))
    names = [row["xi"] for row in table]
    return Reference(names, locomotive(creepage), -force, np.zeros_like(force), -creepage * force)


def spheres(method: str) -> Reference:
    """Return pure creepages, spin and combinations at a = b, by a method of the file."""
    table = rows("hertz3d_reference.csv")

    def column(name: str) -> Array:
        return np.array([float(row[name]) for row in table])

    problem = wl.Problem.ellipse(
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


def assert_forces_miss_by(model: wl.ContactModel, curve_most: float, *, at: float, circle: float) -> None:
    """Forces over μN are at most so much too low on the creep curve, where they are `at`, and so far off on a circle.

    All are held to the digits that are given.
    """
    curve = creep_curve()
    deviation = curve.force_deviation(model)
    largest = int(np.abs(deviation).argmax())
    assert deviation[largest] == pytest.approx(-curve_most, abs=0.0005)
    assert curve.force_x[largest] / curve.bound[largest] == pytest.approx(at, abs=0.005)
    assert spheres("fullX").distance(model).max() == pytest.approx(circle, abs=0.0005)


def assert_energy_misses_by(model: wl.ContactModel, low: float, high: float, *, highest: str) -> None:
    """On a circle Tγ is off by `low`, with lateral creepage and spin of one sign, to `high`, in the case named."""
    circles = spheres("fullX")
    energy = circles.energy_deviation(model)
    assert energy.min() == energy[circles.at("comb_B_eta1e-3_spin+1e-3")] == pytest.approx(low, abs=0.005)
    assert energy.max() == energy[circles.at(highest)] == pytest.approx(high, abs=0.005)
