"""Contact models of ellipses that are wrong in one way each, made from a march along strips."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np

import wearlaw as wl
from tests.plugins.kit.strips import Strips


class Spoilt(Strips):
    """Base of models whose contact is right before they spoil it."""

    def at(self, problem: wl.Problem, shares: Any = None, widths: Any = None) -> wl.Contact:
        return self.spoilt(super().at(problem, shares, widths), problem)

    def spoilt(self, contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
        raise NotImplementedError


def times(contact: wl.Contact, factor: Any) -> wl.Contact:
    """Return the contact with all forces and tractions multiplied, one factor for each operating point."""
    fields = ("traction", "traction_x", "traction_y")
    totals = ("tangential_force", "force_x", "force_y", "moment_z", "wear_index")
    return contact.replaced(
        **{name: getattr(contact, name) * np.asarray(factor)[..., None, None] for name in fields},
        **{name: getattr(contact, name) * factor for name in totals},
    )


def slipping(contact: wl.Contact, factor: float) -> wl.Contact:
    """Return the contact with all slips multiplied."""
    return contact.replaced(**{name: factor * getattr(contact, name) for name in ("slip", "slip_x", "slip_y")})


class AxisTooMany(Spoilt):
    """The lateral force has an axis too many."""

    def spoilt(self, contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
        return contact.replaced(force_y=contact.force_y[..., None])


class NoNumberOnTheEdge(Spoilt):
    """One node holds no number."""

    def spoilt(self, contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
        slip = contact.slip_y.copy()
        slip[..., 0, 0] = np.nan
        return contact.replaced(slip_y=slip)


class ForgetsSpeed(Spoilt):
    """The rolling speed is always 1 m/s."""

    def spoilt(self, contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
        return contact.replaced(rolling_speed=np.ones(problem.batch_shape))


class BeyondTheEdge(Spoilt):
    """The outermost strips lie outside."""

    def spoilt(self, contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
        return contact.replaced(y=1.01 * contact.y)


class TwiceThePressure(Spoilt):
    """The pressure carries twice the load."""

    def spoilt(self, contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
        return contact.replaced(pressure=2.0 * contact.pressure)


class MomentOnTheWheel(Spoilt):
    """The moment has the sign of that on the upper body."""

    def spoilt(self, contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
        index = contact.wear_index - 2.0 * problem.spin * contact.moment_z
        return contact.replaced(moment_z=-contact.moment_z, wear_index=index)


class LongitudinalOnly(Spoilt):
    """What it gives as magnitude of the traction is its longitudinal component."""

    def spoilt(self, contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
        return contact.replaced(traction=np.abs(contact.traction_x))


class SlipsAgainstLateralTraction(Spoilt):
    """The lateral slip has the opposite sign."""

    def spoilt(self, contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
        return contact.replaced(slip_y=-contact.slip_y)


class LeaksBetweenPoints(Spoilt):
    """Depends on the largest spin of the batch."""

    def spoilt(self, contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
        return times(contact, 1.0 - 1e-6 * (np.abs(problem.spin) < np.abs(problem.spin).max()))


class SinglePrecisionForces(Strips):
    """The forces are rounded to single precision."""

    def creep_forces(self, problem: wl.Problem) -> wl.CreepForces:
        forces = super().creep_forces(problem)
        return dataclasses.replace(forces, longitudinal=forces.longitudinal.astype(np.float32).astype(np.float64))


class WeakerBrakes(Spoilt):
    """A thousandth less in braking."""

    def spoilt(self, contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
        return times(contact, np.where(problem.longitudinal_creepage < 0.0, 0.999, 1.0))


class LeftIsNotRight(Spoilt):
    """A thousandth more where spin and longitudinal creepage have one sign."""

    def spoilt(self, contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
        return times(contact, np.where(problem.longitudinal_creepage * problem.spin > 0.0, 1.001, 1.0))


class AlwaysWears(Spoilt):
    """The wear index has an offset of 1e-7 N, also in free rolling."""

    def spoilt(self, contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
        return contact.replaced(wear_index=contact.wear_index + 1e-7)


class ForgetsTheSpin(Spoilt):
    """The wear index lacks the energy from spin."""

    def spoilt(self, contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
        return contact.replaced(wear_index=contact.wear_index - problem.spin * contact.moment_z)


class ForcesOfAnother(Strips):
    """The forces alone are larger than those of the contact."""

    def creep_forces(self, problem: wl.Problem) -> wl.CreepForces:
        forces = super().creep_forces(problem)
        return dataclasses.replace(forces, spin_moment=forces.spin_moment * (1.0 + 1e-12))


class OverBoundInOneCell(Spoilt):
    """One cell carries a thousandth too much."""

    def spoilt(self, contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
        factor = np.ones(contact.traction.shape)
        factor[..., -1, 0] = 1.001
        return contact.replaced(
            traction=factor * contact.traction,
            traction_x=factor * contact.traction_x,
            traction_y=factor * contact.traction_y,
        )


class SlipsEverywhere(Spoilt):
    """A tenth of the creepage is slip everywhere."""

    def spoilt(self, contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
        more = 0.1 * np.hypot(problem.longitudinal_creepage, problem.lateral_creepage)[..., None, None]
        return contact.replaced(slip=contact.slip + more)


class SlipsTooFastInFullSlip(Spoilt):
    """A tenth too much slip."""

    def spoilt(self, contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
        return slipping(contact, 1.1)


CAUGHT: dict[Any, str] = {
    AxisTooMany: "contact_has_the_shape_of_the_problem",
    NoNumberOnTheEdge: "contact_is_finite",
    ForgetsSpeed: "contact_carries_the_conditions",
    BeyondTheEdge: "nodes_cover_the_patch",
    TwiceThePressure: "pressure_sums_to_the_load",
    MomentOnTheWheel: "tractions_sum_to_the_forces",
    LongitudinalOnly: "full_slip_is_reached",
    SlipsAgainstLateralTraction: "no_node_gains_energy",
    LeaksBetweenPoints: "batch_equals_loop",
    SinglePrecisionForces: "solution_is_in_double_precision",
    WeakerBrakes: "forces_are_odd_in_the_creepages",
    LeftIsNotRight: "forces_are_mirrored_with_the_creepages",
    AlwaysWears: "zero_creepage_gives_nothing",
    ForgetsTheSpin: "wear_index_is_forces_times_creepages",
    ForcesOfAnother: "forces_alone_are_those_of_the_contact",
    OverBoundInOneCell: "traction_keeps_its_bound",
    SlipsEverywhere: "what_sticks_does_not_slip",
    SlipsTooFastInFullSlip: "full_slip_is_reached",
}
"""The check that must catch each."""
