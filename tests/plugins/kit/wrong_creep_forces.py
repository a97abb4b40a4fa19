"""Contact models of ellipses whose forces do not follow the creepages as they must, made from patch means."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np

import wearlaw as wl
from tests.plugins.kit.strips import Means


class TooSoftForSpin(Means):
    """The lateral force of spin is too small by 2 per mille."""

    def creep_forces(self, problem: wl.Problem) -> wl.CreepForces:
        forces = super().creep_forces(problem)
        creeps = (problem.longitudinal_creepage != 0.0) | (problem.lateral_creepage != 0.0)
        return dataclasses.replace(forces, lateral=forces.lateral * np.where(creeps, 1.0, 0.998))


CAUGHT: dict[Any, str] = {
    TooSoftForSpin: "initial_slopes_are_kalkers",
}
"""The check that must catch each."""
