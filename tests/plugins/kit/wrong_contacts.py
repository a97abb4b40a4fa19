"""Contact models that are wrong in one way each: right ones with a change of their contacts."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import Any, ClassVar

import numpy as np

import wearlaw as wl
from tests.plugins.kit.cells import Cells
from tests.plugins.kit.strips import Strips, on_strips

Exact: Any = type(wl.contact_model("exact"))
ShenHedrickElkins: Any = type(wl.contact_model("shen_hedrick_elkins"))


class Wrapped(wl.ContactModel):
    """Carter's contact as a model that only has `solve`; a right one."""

    name: ClassVar[str] = "wrapped"
    source: ClassVar[str] = "made up for the tests"

    def solve_line(self, problem: wl.Problem) -> wl.Contact:
        contact: wl.Contact = Exact().solve(problem)
        return contact


class OwnSlope(Strips):
    """Strips that do not claim Kalker's slopes, so that no check of these finds what else is wrong; a right one."""

    @property
    def exemptions(self) -> Any:
        return {"initial_slope": "for the tests"}


class Both(OwnSlope):
    """Solves an ellipse and given strips; a right one."""

    def solve_strips(self, problem: wl.Problem) -> wl.Contact:
        return self.at(problem)


LINE, ELLIPSE = Wrapped, Strips
NODES = (Wrapped, Cells, OwnSlope)
"""A right model of each kind: in closed form, on cells of a line, and on the strips of an ellipse."""

Change = Callable[[wl.Contact, wl.Problem], wl.Contact]

CAUGHT: dict[Any, str] = {}
"""The check that must catch each."""


def changed(base: Any, change: Change) -> Any:
    """Return the class of a right model with a change of its contacts."""

    def solve_line(self: Any, problem: wl.Problem) -> wl.Contact:
        return change(base.solve_line(self, problem), problem)

    def at(self: Any, problem: wl.Problem, shares: Any = None, widths: Any = None) -> wl.Contact:
        return change(base.at(self, problem, shares, widths), problem)

    methods = {"at": at} if issubclass(base, Strips) else {"solve_line": solve_line}
    name = "".join(word.capitalize() for word in change.__name__.split("_")) + f"Of{base.__name__}"
    return type(name, (base,), {**methods, "__module__": __name__, "__doc__": change.__doc__})


def wrong(check: str, *bases: Any) -> Callable[[Any], Any]:
    """Return a decorator that notes which check must catch a wrong model, or right ones with a change."""

    def note(model: Any) -> Any:
        CAUGHT.update({changed(base, model): check for base in bases} if bases else {model: check})
        return model

    return note


def times(contact: wl.Contact, factor: Any) -> wl.Contact:
    """Return the contact with all forces and tractions multiplied, one factor for each operating point."""
    nodes, totals = ["traction"], ["tangential_force", "wear_index"]
    if contact.on_strips:
        nodes, totals = [*nodes, "traction_x", "traction_y"], [*totals, "force_x", "force_y", "moment_z"]
    factor = np.broadcast_to(factor, contact.rolling_speed.shape)
    return contact.replaced(
        **{name: getattr(contact, name) * contact.per_node(factor) for name in nodes},
        **{name: getattr(contact, name) * factor for name in totals},
    )


def slipping(contact: wl.Contact, factor: float) -> wl.Contact:
    """Return the contact with all slips multiplied."""
    names = ("slip", "slip_x", "slip_y") if contact.on_strips else ("slip",)
    return contact.replaced(**{name: factor * getattr(contact, name) for name in names})


def reduced(problem: wl.Problem) -> Any:
    """Return ξR/(μa) of a line."""
    return np.abs(problem.creepage) * problem.relative_radius / (problem.friction_coefficient * problem.half_width)


# Shapes, numbers and what is carried on ------------------------------------------------------------------------------


@wrong("contact_has_the_shape_of_the_problem", LINE, ELLIPSE)
def axis_too_many(contact: wl.Contact, _: wl.Problem) -> wl.Contact:
    """A force has an axis too many."""
    name = "force_y" if contact.on_strips else "tangential_force"
    return contact.replaced(**{name: getattr(contact, name)[..., None]})


@wrong("contact_is_finite", LINE, ELLIPSE)
def nan_in_a_field(contact: wl.Contact, _: wl.Problem) -> wl.Contact:
    """Some nodes hold no number."""
    traction = contact.traction.copy()
    traction[..., 0] = np.nan
    return contact.replaced(traction=traction)


@wrong("contact_carries_the_conditions", LINE, ELLIPSE)
def density_of_steel(contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
    """The density is always that of steel."""
    return contact.replaced(density=np.full(problem.batch_shape, 7850.0))


@wrong("solution_is_in_double_precision", LINE, ELLIPSE)
def single_precision(contact: wl.Contact, _: wl.Problem) -> wl.Contact:
    """A force is rounded to single precision."""
    name = "force_x" if contact.on_strips else "tangential_force"
    return contact.replaced(**{name: getattr(contact, name).astype(np.float32).astype(np.float64)})


@wrong("batch_equals_loop", LINE, ELLIPSE)
def leaks_between_points(contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
    """Depends on the largest creepage of the batch."""
    creepage = np.abs(problem.longitudinal_creepage)
    return times(contact, 1.0 - 1e-6 * (creepage < creepage.max()))


# Energy --------------------------------------------------------------------------------------------------------------


@wrong("slip_dissipates_the_energy_fed_in", LINE, ELLIPSE)
def loses_energy(contact: wl.Contact, _: wl.Problem) -> wl.Contact:
    """A tenth of the slip is missing."""
    return slipping(contact, 0.9)


@wrong("refined_nodes_improve_the_sums", Cells, ELLIPSE)
def loses_energy_on_any_nodes(contact: wl.Contact, _: wl.Problem) -> wl.Contact:
    """One per cent of the slip is missing, less than the accuracy, however fine the nodes."""
    return slipping(contact, 0.99)


@wrong("no_node_gains_energy", LINE, ELLIPSE)
def slips_against_traction(contact: wl.Contact, _: wl.Problem) -> wl.Contact:
    """The slip, on an ellipse the lateral one, has the opposite sign."""
    return contact.replaced(slip_y=-contact.slip_y) if contact.on_strips else slipping(contact, -1.0)


@wrong("no_node_gains_energy", LINE)
def slips_against_traction_in_one_node(contact: wl.Contact, _: wl.Problem) -> wl.Contact:
    """One node slips against its traction."""
    slip = contact.slip.copy()
    slip[..., -1] *= -1.0
    return contact.replaced(slip=slip)


@wrong("wear_index_is_forces_times_creepages", LINE)
def wear_index_twice(contact: wl.Contact, _: wl.Problem) -> wl.Contact:
    """Doubles the wear index."""
    return contact.replaced(wear_index=2.0 * contact.wear_index)


@wrong("wear_index_is_forces_times_creepages", ELLIPSE)
def forgets_the_spin(contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
    """The wear index lacks the energy from spin."""
    return contact.replaced(wear_index=contact.wear_index - problem.spin * contact.moment_z)


@wrong("zero_creepage_gives_nothing", LINE, ELLIPSE)
def always_wears(contact: wl.Contact, _: wl.Problem) -> wl.Contact:
    """The wear index has an offset of 1e-7 N, also in free rolling."""
    return contact.replaced(wear_index=contact.wear_index + 1e-7)


# Forces --------------------------------------------------------------------------------------------------------------


@wrong("tractions_sum_to_the_forces", LINE)
def force_of_its_own(contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
    """The force is not the sum of the tractions."""
    force = contact.tangential_force * 0.999
    return contact.replaced(tangential_force=force, wear_index=force * problem.creepage)


@wrong("tractions_sum_to_the_forces", ELLIPSE)
def moment_on_the_wheel(contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
    """The moment has the sign of that on the upper body."""
    index = contact.wear_index - 2.0 * problem.spin * contact.moment_z
    return contact.replaced(moment_z=-contact.moment_z, wear_index=index)


@wrong("forces_alone_are_those_of_the_contact")
class ForcesOfAnother(Strips):
    """The forces alone are larger than those of the contact."""

    def creep_forces(self, problem: wl.Problem) -> wl.CreepForces:
        forces = super().creep_forces(problem)
        return dataclasses.replace(forces, spin_moment=forces.spin_moment * (1.0 + 1e-12))


@wrong("forces_are_odd_in_the_creepages", LINE, ELLIPSE)
def weaker_brakes(contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
    """A thousandth less in braking."""
    return times(contact, np.where(problem.longitudinal_creepage < 0.0, 0.999, 1.0))


@wrong("forces_are_mirrored_with_the_creepages", ELLIPSE)
def left_is_not_right(contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
    """A thousandth more where spin and longitudinal creepage have one sign."""
    return times(contact, np.where(problem.longitudinal_creepage * problem.spin > 0.0, 1.001, 1.0))


@wrong("force_grows_with_creepage", LINE, ELLIPSE)
def falls_with_creepage(contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
    """Loses up to a hundredth as the longitudinal creepage grows."""
    creepage = np.abs(problem.longitudinal_creepage)
    return times(contact, 1.0 - 0.01 * creepage / (creepage + 1e-3))


@wrong("contacts_are_similar", LINE, ELLIPSE)
def knows_millimetres(contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
    """Long patches transmit a thousandth less."""
    return times(contact, 1.0 - 1e-3 * problem.a / (problem.a + 1e-3))


@wrong("initial_slope_is_that_of_the_half_space", LINE)
def wrong_initial_slope(contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
    """Too soft at first by 1e-8, right in full slip."""
    return times(contact, 1.0 - 1e-8 * np.maximum(1.0 - reduced(problem), 0.0))


@wrong("initial_slopes_are_kalkers")
class TooSoftForSpin(ShenHedrickElkins):  # type: ignore[misc]
    """The lateral force of spin is too small by 2 per mille."""

    def creep_forces(self, problem: wl.Problem) -> Any:
        forces = super().creep_forces(problem)
        creeps = (problem.longitudinal_creepage != 0.0) | (problem.lateral_creepage != 0.0)
        return dataclasses.replace(forces, lateral=forces.lateral * np.where(creeps, 1.0, 0.998))


# Friction and full slip ----------------------------------------------------------------------------------------------


@wrong("traction_keeps_its_bound", LINE, ELLIPSE)
def over_bound_in_one_node(contact: wl.Contact, _: wl.Problem) -> wl.Contact:
    """One node carries a thousandth too much."""
    factor = np.ones(contact.traction.shape)
    factor[(..., -1, 0) if contact.on_strips else (..., -1)] = 1.001
    names = ("traction", "traction_x", "traction_y") if contact.on_strips else ("traction",)
    return contact.replaced(**{name: factor * getattr(contact, name) for name in names})


@wrong("what_sticks_does_not_slip", LINE, ELLIPSE)
def slips_everywhere(contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
    """A share of the creepage is slip everywhere: 1e-9 on a line, and a tenth on cells."""
    creepage = np.hypot(problem.longitudinal_creepage, problem.lateral_creepage)
    return contact.replaced(slip=contact.slip + (0.1 if contact.on_strips else 1e-9) * contact.per_node(creepage))


@wrong("forces_are_continuous", LINE, ELLIPSE)
def jumps_into_full_slip(contact: wl.Contact, _: wl.Problem) -> wl.Contact:
    """The force lacks a thousandth, on cells a hundredth, until all tractions are at their bound."""
    below = contact.traction < (1.0 - 1e-12) * contact.traction_bound
    share = 0.99 if contact.on_strips else 0.999
    return times(contact, np.where(below.any(axis=(-2, -1) if contact.on_strips else -1), share, 1.0))


@wrong("full_slip_is_met_from_both_sides", LINE, ELLIPSE)
def steps_into_full_slip(contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
    """Just below full slip the force lacks a millionth, on cells a hundredth."""
    if contact.on_strips:
        below = (contact.traction < (1.0 - 1e-12) * contact.traction_bound).any(axis=(-2, -1))
        return times(contact, np.where(below, 0.99, 1.0))
    share = reduced(problem)
    return times(contact, np.where(share < 1.0, 1.0 - 1e-6 * share**4, 1.0))


@wrong("full_slip_is_reached", LINE)
def not_quite_full_slip(contact: wl.Contact, _: wl.Problem) -> wl.Contact:
    """A hundred-thousandth is missing in full slip."""
    return times(contact, 1.0 - 1e-5)


@wrong("full_slip_is_reached", LINE, ELLIPSE)
def slips_too_fast(contact: wl.Contact, _: wl.Problem) -> wl.Contact:
    """A tenth too much slip."""
    return slipping(contact, 1.1)


@wrong("full_slip_is_reached", ELLIPSE)
def longitudinal_only(contact: wl.Contact, _: wl.Problem) -> wl.Contact:
    """What it gives as magnitude of the traction is its longitudinal component."""
    return contact.replaced(traction=np.abs(contact.traction_x))


# Nodes ---------------------------------------------------------------------------------------------------------------


@wrong("nodes_cover_the_patch", LINE)
def forgets_the_width(contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
    """The areas are those of one metre of width."""
    return contact.replaced(area=contact.area / problem.track_width[..., None])


@wrong("nodes_cover_the_patch", ELLIPSE)
def beyond_the_edge(contact: wl.Contact, _: wl.Problem) -> wl.Contact:
    """The outermost strips lie outside."""
    return contact.replaced(y=1.01 * contact.y)


@wrong("pressure_sums_to_the_load", LINE, ELLIPSE)
def half_the_pressure(contact: wl.Contact, _: wl.Problem) -> wl.Contact:
    """The pressure carries half the load."""
    return contact.replaced(pressure=0.5 * contact.pressure)


def with_sums(contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
    """Return the contact with the spin moment that its tractions sum to, by the formula of the conventions."""
    if not contact.on_strips:
        return contact
    moment = -(contact.integral(contact.x, contact.traction_y) + contact.integral(contact.y, contact.traction_x))
    forces = dataclasses.replace(contact.forces, spin_moment=moment)
    return contact.replaced(moment_z=moment, wear_index=problem.power(forces), problem=problem)


def along(contact: wl.Contact) -> int:
    """Return the axis of the nodes of a strip."""
    return -2 if contact.on_strips else -1


@wrong("stick_lies_before_slip", *NODES)
def x_against_the_conventions(contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
    """x runs from the trailing to the leading edge."""
    return with_sums(contact.replaced(x=-contact.x), problem)


@wrong("stick_lies_before_slip", *NODES)
def order_of_x(contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
    """The positions, with their areas and pressures, are in the order of other nodes than the tractions and slips."""
    third = contact.x.shape[along(contact)] // 3
    moved = {name: np.roll(getattr(contact, name), third, axis=along(contact)) for name in ("x", "area", "pressure")}
    return with_sums(contact.replaced(**moved), problem)


@wrong("pressure_is_that_of_the_problem", *NODES)
def x_over_half_the_patch(contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
    """x ends half-way to the edges."""
    return with_sums(contact.replaced(x=0.5 * contact.x), problem)


@wrong("pressure_is_that_of_the_problem", *NODES)
def shuffled_pressure(contact: wl.Contact, _: wl.Problem) -> wl.Contact:
    """The pressures are those of other nodes."""
    third = contact.x.shape[along(contact)] // 3
    return contact.replaced(pressure=np.roll(contact.pressure, third, axis=along(contact)))


@wrong("pressure_is_that_of_the_problem", *NODES)
def parabolic_pressure(contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
    """The pressure is a parabola with the right load."""
    scale = problem.normal_force / contact.integral(contact.pressure, contact.pressure)
    return contact.replaced(pressure=contact.per_node(scale) * contact.pressure**2)


@wrong("bound_sums_to_friction", *NODES)
def bound_in_stick(contact: wl.Contact, _: wl.Problem) -> wl.Contact:
    """Where it sticks, the bound is half as large again."""
    return contact.replaced(traction_bound=np.where(contact.slip == 0.0, 1.5, 1.0) * contact.traction_bound)


def slip_and_traction(contact: wl.Contact, _: wl.Problem) -> wl.Contact:
    """The slip is too large by a fifth and the traction too small by a tenth, within the accuracy that it declares."""
    return slipping(times(contact, 0.9), 1.2)


@wrong("declared_accuracy_is_not_coarse")
class Coarse(changed(Cells, slip_and_traction)):  # type: ignore[misc]
    """Hides its errors in an accuracy of 30 %."""

    @property
    def accuracy(self) -> float:
        return 0.3


@wrong("declared_accuracy_is_not_coarse")
class CoarseOnStrips(changed(OwnSlope, slip_and_traction)):  # type: ignore[misc]
    """Hides its errors in an accuracy of 30 %."""

    @property
    def elliptic_accuracy(self) -> float:
        return 0.3


# Strips --------------------------------------------------------------------------------------------------------------


@wrong("strips_have_their_widths", OwnSlope)
def equal_widths(contact: wl.Contact, _: wl.Problem) -> wl.Contact:
    """All strips have the mean width, though not the mean area."""
    mean = contact.strip_width.mean(axis=-1, keepdims=True)
    unequal = np.linspace(0.5, 1.5, contact.strip_width.shape[-1])  # where all strips are equally wide
    return contact.replaced(strip_width=np.broadcast_to(mean * unequal, contact.strip_width.shape))


@wrong("strips_have_their_widths", OwnSlope)
def widths_of_others(contact: wl.Contact, _: wl.Problem) -> wl.Contact:
    """The widths are in the order of other strips."""
    count = contact.strip_width.shape[-1]
    width = np.roll(contact.strip_width * np.linspace(0.9, 1.1, count), count // 3, axis=-1)
    return contact.replaced(strip_width=width)


@wrong("refined_nodes_improve_the_sums")
class RefinedHasAsManyStrips(Strips):
    """What it calls refined has as many strips and cells."""

    def refined(self) -> RefinedHasAsManyStrips:
        return self


@wrong("other_strips_have_the_same_sums")
class StripsOfHalfTheWear(Strips):
    """On the strips that are asked for, it slips half as much."""

    def on_strips(self, problem: wl.Problem, shares: Any) -> wl.Contact | None:
        contact = super().on_strips(problem, shares)
        assert contact is not None
        return slipping(contact, 0.5)


@wrong("spin_has_its_force_and_moment")
class SpinBackwards(OwnSlope):
    """The spin has the opposite sign."""

    def at(self, problem: wl.Problem, shares: Any = None, widths: Any = None) -> wl.Contact:
        creepages = problem.longitudinal_creepage, problem.lateral_creepage
        return with_sums(super().at(problem.with_creepages(*creepages, -problem.spin), shares, widths), problem)


@wrong("no_node_gains_energy")
class SlipWithoutSpin(OwnSlope):
    """The tractions know of the spin, and the slips do not."""

    def at(self, problem: wl.Problem, shares: Any = None, widths: Any = None) -> wl.Contact:
        still = problem.with_creepages(problem.longitudinal_creepage, problem.lateral_creepage, 0.0 * problem.spin)
        contact, straight = (super(SlipWithoutSpin, self).at(given, shares, widths) for given in (problem, still))
        return contact.replaced(slip=straight.slip, slip_x=straight.slip_x, slip_y=straight.slip_y)


@wrong("strips_of_an_ellipse_have_its_forces")
class StiffnessOfAnotherEllipse(Both):
    """On given strips, takes the coefficients of the ellipse with its axes exchanged."""

    def solve_strips(self, problem: wl.Problem) -> wl.Contact:
        other = super().solve_strips(problem.replaced(a=problem.b, b=problem.a))
        return other.replaced(problem=problem)


@wrong("contacts_are_similar")
class OncePerCreepage(Both):
    """Solves one contact of each creepage in a batch."""

    def creep_forces(self, problem: wl.Problem) -> wl.CreepForces:
        forces = super().creep_forces(problem)
        _, first, places = np.unique(problem.creepage, return_index=True, return_inverse=True)
        parts = {name: getattr(forces, name) for name in ("longitudinal", "lateral", "spin_moment")}
        return wl.CreepForces(**{name: part.flat[first][places.reshape(part.shape)] for name, part in parts.items()})


@wrong("strips_that_fill_up_a_batch_add_nothing", on_strips(OwnSlope))
def pulled_by_the_number_of_strips(contact: wl.Contact, _: wl.Problem) -> wl.Contact:
    """The forces grow with the number of strips, of those without width too."""
    return times(contact, 0.05 * contact.strip_width.shape[-1])


@wrong("nodes_cover_the_patch", on_strips(OwnSlope))
def strips_side_by_side(contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
    """Strips whose middles lie askew are placed side by side."""
    assert problem.strips is not None
    return contact.replaced(x=contact.x - problem.strips.x[..., None, :])


@wrong("creepages_of_strips_may_be_those_of_the_patch", on_strips(OwnSlope))
def creeping_less_by_strips(contact: wl.Contact, problem: wl.Problem) -> wl.Contact:
    """With creepages for each strip the forces are a tenth smaller."""
    assert problem.strips is not None
    return times(contact, 0.9 if problem.strips.has_creepages else 1.0)


ON_GIVEN_STRIPS = {"strips_have_their_widths", "spin_has_its_force_and_moment"}
"""Checks on which models of given strips are tried too, beside those of every shape."""


# Fields in closed form -----------------------------------------------------------------------------------------------


@wrong("tractions_sum_to_the_forces")
class TractionInABand(Exact):  # type: ignore[misc]
    """The traction is too large by 0.1 % in a band of a four-hundredth of the patch."""

    def fields(self, problem: wl.Problem, nodes: wl.Nodes) -> wl.LineFields:
        fields: wl.LineFields = super().fields(problem, nodes)
        band = np.where(np.abs(nodes.x / problem.half_width - 0.3) < 0.0025, 1.001, 1.0)
        return dataclasses.replace(fields, traction=band * fields.traction)


@wrong("what_sticks_does_not_slip")
class SlipsBeforeTheZone(Exact):  # type: ignore[misc]
    """Slips a little, and for a millionth of the zone, in front of it."""

    def fields(self, problem: wl.Problem, nodes: wl.Nodes) -> wl.LineFields:
        fields: wl.LineFields = super().fields(problem, nodes)
        length = self.slip_length(problem)
        in_front = (nodes.from_trailing > length) & (nodes.from_trailing < (1.0 + 1e-6) * length)
        return dataclasses.replace(fields, slip=np.where(in_front, 1e-9 * problem.creepage, fields.slip))


@wrong("forces_alone_are_those_of_the_contact")
class ForceOfAnother(Exact):  # type: ignore[misc]
    """The force alone is larger than that of the contact."""

    def tangential_force(self, problem: wl.Problem) -> Any:
        return super().tangential_force(problem) * (1.0 + 1e-12)


@wrong("closed_forms_are_those_of_the_fields")
class CrossingAside(Exact):  # type: ignore[misc]
    """The slip crosses a value a thousandth of the patch aside."""

    def crossings(self, problem: wl.Problem, variable: str, value: Any) -> Any:
        found = super().crossings(problem, variable, value)
        return found if found is None else found + 2e-3 * problem.half_width[..., None]


@wrong("closed_forms_are_those_of_the_fields")
class TooMuchExcess(Exact):  # type: ignore[misc]
    """The energy above a threshold is too large by 1e-4."""

    def excess_dissipation(self, problem: wl.Problem, threshold: Any) -> Any:
        return super().excess_dissipation(problem, threshold) * (1.0 + 1e-4)


@wrong("acceleration_does_not_matter")
class ExcessOfCompiledLoopDiffers(Exact):  # type: ignore[misc]
    """A little more energy above a threshold where loops are compiled."""

    def excess_dissipation(self, problem: wl.Problem, threshold: Any) -> Any:
        return super().excess_dissipation(problem, threshold) * (1.0 + 1e-6 * wl.accelerated(problem.size))
