"""Contact models of ellipses whose forces do not follow the creepages as they must, made from patch means."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np

import wearlaw as wl
from tests.testing.strips import Means


class FallsWithLongitudinalCreepage(Means):
    """Friction that falls with creepage."""

    def factor(self, problem: wl.Problem, reduced: Any) -> Any:
        return 1.0 / (1.0 + 0.1 * reduced)


class JumpsIntoFullSlipOnTheEllipse(Means):
    """The force lacks a per mille below full slip."""

    def factor(self, problem: wl.Problem, reduced: Any) -> Any:
        return np.where(reduced < 3.0, 0.999, 1.0)


class AboveFrictionOnTheEllipse(Means):
    """A millionth more than friction allows."""

    def factor(self, problem: wl.Problem, reduced: Any) -> Any:
        return np.full_like(reduced, 1.0 + 1e-6)


class NeverAllFriction(Means):
    """A hundred-thousandth is missing in full slip."""

    def factor(self, problem: wl.Problem, reduced: Any) -> Any:
        return np.full_like(reduced, 1.0 - 1e-5)


class AsideOfTheCreepage(Means):
    """The force is turned by a millionth of a radian."""

    def creep_forces(self, problem: wl.Problem) -> wl.CreepForces:
        forces = super().creep_forces(problem)
        along, across, cos, sin = forces.longitudinal, forces.lateral, np.cos(1e-6), np.sin(1e-6)
        return dataclasses.replace(forces, longitudinal=cos * along - sin * across, lateral=cos * across + sin * along)


class StepsIntoFullSlipOnTheEllipse(Means):
    """The force lacks a millionth just below full slip."""

    def factor(self, problem: wl.Problem, reduced: Any) -> Any:
        return np.where(reduced < 3.0, 1.0 - 1e-6 * (reduced / 3.0) ** 4, 1.0)


class TooSoftForSpin(Means):
    """The lateral force of spin is too small by 2 per mille."""

    def creep_forces(self, problem: wl.Problem) -> wl.CreepForces:
        forces = super().creep_forces(problem)
        creeps = (problem.longitudinal_creepage != 0.0) | (problem.lateral_creepage != 0.0)
        return dataclasses.replace(forces, lateral=forces.lateral * np.where(creeps, 1.0, 0.998))


class TooStiffAtFirst(Means):
    """Too stiff by 2 per mille, right in full slip."""

    def factor(self, problem: wl.Problem, reduced: Any) -> Any:
        return 1.0 + 2e-3 * np.maximum(1.0 - reduced / 3.0, 0.0)


class KnowsMillimetres(Means):
    """Depends on the size of the patch."""

    def factor(self, problem: wl.Problem, reduced: Any) -> Any:
        return 1.0 / (1.0 + 1e-6 * problem.a / 1e-3)


CAUGHT: dict[Any, str] = {
    FallsWithLongitudinalCreepage: "force_grows_with_creepage",
    JumpsIntoFullSlipOnTheEllipse: "forces_are_continuous",
    AboveFrictionOnTheEllipse: "force_stays_below_friction",
    NeverAllFriction: "full_slip_is_reached",
    AsideOfTheCreepage: "full_slip_is_reached",
    StepsIntoFullSlipOnTheEllipse: "full_slip_is_met_from_both_sides",
    TooSoftForSpin: "initial_slopes_are_kalkers",
    TooStiffAtFirst: "initial_slopes_are_kalkers",
    KnowsMillimetres: "contacts_are_similar",
}
"""The check that must catch each."""
