"""Contact models of ellipses whose energy, refinements, strips or conditions are wrong, made from a march on strips."""

from __future__ import annotations

from typing import Any

import numpy as np

import wearlaw as wl
from tests.plugins.kit.strips import Strips
from tests.plugins.kit.wrong_ellipses import Spoilt, slipping, times


class LosesEnergyOfTranslation(Spoilt):
    """A tenth of the slip is missing."""

    def spoilt(self, contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
        return slipping(contact, 0.9)


class LosesEnergyOnAnyStrips(Spoilt):
    """One per cent of the slip is missing, less than its accuracy, however fine the strips."""

    def spoilt(self, contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
        return slipping(contact, 0.99)


class RefinedHasAsManyStrips(Strips):
    """What it calls refined has as many strips and cells."""

    def refined(self) -> RefinedHasAsManyStrips:
        return self


class StripsOfHalfTheWear(Strips):
    """On the strips that are asked for, it slips half as much."""

    def on_strips(self, problem: wl.Problem, shares: Any) -> wl.Contact | None:
        contact = super().on_strips(problem, shares)
        assert contact is not None
        return slipping(contact, 0.5)


class WeakerWithCreepage(Spoilt):
    """Loses up to a hundredth as the longitudinal creepage grows."""

    def spoilt(self, contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
        creepage = np.abs(problem.longitudinal_creepage)
        return times(contact, 1.0 - 0.01 * creepage / (creepage + 1e-3))


class MoreThanFriction(Spoilt):
    """Reaches 1.05 μN."""

    def spoilt(self, contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
        return times(contact, np.full(problem.batch_shape, 1.05))


class JumpsNearFriction(Spoilt):
    """Loses a tenth until it reaches 0.9 μN."""

    def spoilt(self, contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
        share = contact.tangential_force / (problem.friction_coefficient * problem.normal_force)
        return times(contact, np.where(share > 0.9, 1.0, 0.9))


class JumpsWhereAllSlips(Spoilt):
    """Loses a hundredth until all tractions are at their bound."""

    def spoilt(self, contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
        below = contact.traction < (1.0 - 1e-12) * contact.traction_bound
        return times(contact, np.where(below.any(axis=(-2, -1)), 0.99, 1.0))


class KnowsMillimetresOnStrips(Spoilt):
    """Long patches transmit a thousandth less."""

    def spoilt(self, contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
        return times(contact, 1.0 - 1e-3 * problem.a / (problem.a + 1e-3))


CAUGHT: dict[Any, str] = {
    WeakerWithCreepage: "force_grows_with_creepage",
    MoreThanFriction: "force_stays_below_friction",
    JumpsNearFriction: "forces_are_continuous",
    JumpsWhereAllSlips: "forces_are_continuous",
    KnowsMillimetresOnStrips: "contacts_are_similar",
    LosesEnergyOfTranslation: "slip_dissipates_the_energy_fed_in",
    LosesEnergyOnAnyStrips: "refined_nodes_improve_the_sums",
    RefinedHasAsManyStrips: "refined_nodes_improve_the_sums",
    StripsOfHalfTheWear: "other_strips_have_the_same_sums",
}
"""The check that must catch each."""
