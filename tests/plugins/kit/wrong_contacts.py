"""Contact models that are wrong in one way each, made from Carter's."""

from __future__ import annotations

import dataclasses
from typing import Any, ClassVar

import numpy as np

import wearlaw as wl

Exact: Any = type(wl.contact_model("exact"))


class Wrapped(wl.ContactModel):
    """Carter's contact as a model that only has `solve`; the right one."""

    name: ClassVar[str] = "wrapped"
    source: ClassVar[str] = "made up for the tests"

    def solve_line(self, problem: wl.Problem) -> wl.Contact:
        contact: wl.Contact = Exact().solve(problem)
        return self.spoilt(contact, problem)

    def spoilt(self, contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
        return contact


class OverBoundInOneNode(Wrapped):
    """One node carries a thousandth too much."""

    def spoilt(self, contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
        traction = contact.traction.copy()
        traction[..., -1] *= 1.001
        return dataclasses.replace(contact, traction=traction)


class SlipsInStick(Wrapped):
    """A little slip everywhere."""

    def spoilt(self, contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
        return dataclasses.replace(contact, slip=contact.slip + 1e-9 * problem.creepage[..., None])


class LosesEnergy(Wrapped):
    """One per cent of the slip is missing."""

    def spoilt(self, contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
        return dataclasses.replace(contact, slip=0.99 * contact.slip)


class LosesEnergyAnywhere(Exact):  # type: ignore[misc]
    """A tenth of the slip is missing at any position, so that the energy is not there however fine the cells."""

    def fields(self, problem: wl.Problem, nodes: wl.Nodes) -> wl.LineFields:
        fields: wl.LineFields = super().fields(problem, nodes)
        return dataclasses.replace(fields, slip=0.9 * fields.slip)


class SlipAgainstTraction(Wrapped):
    """The slip has the opposite sign."""

    def spoilt(self, contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
        return dataclasses.replace(contact, slip=-contact.slip)


class GainsEnergyInOneNode(Wrapped):
    """One node slips against its traction, in a model that does not claim their signs."""

    @property
    def exemptions(self) -> Any:
        return {"direction": "for the tests"}

    def spoilt(self, contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
        slip = contact.slip.copy()
        slip[..., -1] *= -1.0
        return dataclasses.replace(contact, slip=slip)


class _ForceScaled(Wrapped):
    """Base of models whose force is wrong by a factor, consistently."""

    def factor(self, problem: wl.Problem) -> Any:
        raise NotImplementedError

    def spoilt(self, contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
        factor = self.factor(problem)
        return dataclasses.replace(
            contact,
            traction=contact.traction * factor[..., None],
            tangential_force=contact.tangential_force * factor,
            wear_index=contact.wear_index * factor,
        )


def reduced(problem: wl.Problem) -> Any:
    """Return ξR/(μa)."""
    return np.abs(problem.creepage) * problem.relative_radius / (problem.friction_coefficient * problem.half_width)


class NotQuiteFullSlip(_ForceScaled):
    """A hundred-thousandth is missing in full slip."""

    def factor(self, problem: wl.Problem) -> Any:
        return np.full(problem.batch_shape, 1.0 - 1e-5)


class AboveFriction(_ForceScaled):
    """A millionth more than friction allows."""

    def factor(self, problem: wl.Problem) -> Any:
        return np.full(problem.batch_shape, 1.0 + 1e-6)


class JumpsIntoFullSlip(_ForceScaled):
    """The force lacks a per mille below full slip."""

    def factor(self, problem: wl.Problem) -> Any:
        return np.where(reduced(problem) < 1.0, 0.999, 1.0)


class WrongInitialSlope(_ForceScaled):
    """Too soft at first by 1e-8, right in full slip."""

    def factor(self, problem: wl.Problem) -> Any:
        return 1.0 - 1e-8 * np.maximum(1.0 - reduced(problem), 0.0)


class FallsWithCreepage(_ForceScaled):
    """Friction that falls with creepage."""

    def factor(self, problem: wl.Problem) -> Any:
        return 1.0 / (1.0 + 0.1 * reduced(problem))


class NotSimilar(_ForceScaled):
    """Depends on the rolling speed."""

    def factor(self, problem: wl.Problem) -> Any:
        return 1.0 / (1.0 + 1e-6 * problem.rolling_speed)


class NotOdd(_ForceScaled):
    """A thousandth less in braking."""

    def factor(self, problem: wl.Problem) -> Any:
        return np.where(problem.creepage < 0, 0.999, 1.0)


class BatchLeakOfForce(_ForceScaled):
    """Depends on the largest creepage of the batch."""

    def factor(self, problem: wl.Problem) -> Any:
        return 1.0 - 1e-6 * (np.abs(problem.creepage) < np.abs(problem.creepage).max())


class SinglePrecisionForce(_ForceScaled):
    """The force is rounded to single precision."""

    def spoilt(self, contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
        force = contact.tangential_force.astype(np.float32).astype(np.float64)
        return dataclasses.replace(contact, tangential_force=force)


class ForgetsWidth(Wrapped):
    """The areas are those of one metre of width."""

    def spoilt(self, contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
        return dataclasses.replace(contact, area=contact.area / problem.track_width[..., None])


class HalfThePressure(Wrapped):
    """The pressure carries half the load."""

    def spoilt(self, contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
        return dataclasses.replace(contact, pressure=0.5 * contact.pressure)


class ForceOfItsOwn(Wrapped):
    """The force is not the sum of the tractions."""

    def spoilt(self, contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
        force = contact.tangential_force * 0.999
        return dataclasses.replace(contact, tangential_force=force, wear_index=force * problem.creepage)


class WearIndexOffset(Wrapped):
    """The wear index has an offset of 1e-7 N, also at zero creepage."""

    def spoilt(self, contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
        return dataclasses.replace(contact, wear_index=contact.wear_index + 1e-7)


class WearIndexTwice(Wrapped):
    """Doubles the wear index."""

    def spoilt(self, contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
        return dataclasses.replace(contact, wear_index=2.0 * contact.wear_index)


class NaNInField(Wrapped):
    """One node holds no number."""

    def spoilt(self, contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
        traction = contact.traction.copy()
        traction[..., 0] = np.nan
        return dataclasses.replace(contact, traction=traction)


class WrongBatchShape(Wrapped):
    """The force has an axis too many."""

    def spoilt(self, contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
        return dataclasses.replace(contact, tangential_force=contact.tangential_force[..., None])


class ForgetsDensity(Wrapped):
    """The density is always that of steel."""

    def spoilt(self, contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
        return dataclasses.replace(contact, density=np.full(problem.batch_shape, 7850.0))


class UnknownExemption(Wrapped):
    """Exempt from what nobody claims."""

    @property
    def exemptions(self) -> Any:
        return {"elegance": "it is not"}


CAUGHT: dict[Any, str] = {
    OverBoundInOneNode: "traction_keeps_its_bound",
    SlipsInStick: "what_sticks_does_not_slip",
    LosesEnergy: "slip_dissipates_the_energy_fed_in",
    LosesEnergyAnywhere: "slip_dissipates_the_energy_fed_in",
    SlipAgainstTraction: "no_node_gains_energy",
    GainsEnergyInOneNode: "no_node_gains_energy",
    NotQuiteFullSlip: "full_slip_is_reached",
    AboveFriction: "force_stays_below_friction",
    JumpsIntoFullSlip: "forces_are_continuous",
    WrongInitialSlope: "initial_slope_is_that_of_the_half_space",
    FallsWithCreepage: "force_grows_with_creepage",
    NotSimilar: "contacts_are_similar",
    NotOdd: "forces_are_odd_in_the_creepages",
    BatchLeakOfForce: "batch_equals_loop",
    SinglePrecisionForce: "solution_is_in_double_precision",
    ForgetsWidth: "nodes_cover_the_patch",
    HalfThePressure: "pressure_sums_to_the_load",
    ForceOfItsOwn: "tractions_sum_to_the_forces",
    WearIndexOffset: "zero_creepage_gives_nothing",
    WearIndexTwice: "wear_index_is_forces_times_creepages",
    NaNInField: "contact_is_finite",
    WrongBatchShape: "contact_has_the_shape_of_the_problem",
    ForgetsDensity: "contact_carries_the_conditions",
    UnknownExemption: "exemptions_are_claims",
}
"""The check that must catch each."""
