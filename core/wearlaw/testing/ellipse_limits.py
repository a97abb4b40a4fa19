"""Checks of the claims that a contact model of ellipses may be exempt from."""

from __future__ import annotations

import numpy as np
from hypothesis import strategies as st

from wearlaw.arrays.array import Array
from wearlaw.contact.contact import Contact
from wearlaw.contact.problem import CreepForces, Problem
from wearlaw.models.contact_model import ContactModel
from wearlaw.testing.ellipses import (
    Creepages,
    assert_same_forces,
    at_magnitude,
    at_reduced,
    error_of_sums,
    random_ellipses,
    sliding_power,
    translation,
)
from wearlaw.testing.examples import SAME, SUM, assert_close, for_each
from wearlaw.testing.shared_checks import Claims, friction_limit, full_slip, steps_into_full_slip
from wearlaw.testing.strategies import ELLIPTIC_PROBLEMS, log_uniform

POINTS = 32
"""Number of patches checked at once."""

FAR = 100.0
"""Reduced creepage far beyond the saturation of any theory that saturates."""

SLOPE = 1e-3
"""Error of initial slopes: half of the last digit of Kalker's coefficients."""


def traction_vector_keeps_its_bound(model: ContactModel) -> None:
    """The magnitude of the traction does not exceed the bound at any node of an ellipse."""

    def examine(problem: Problem) -> None:
        contact = model.solve_ellipse(problem)
        over = contact.traction > contact.traction_bound * (1.0 + SAME)
        share = contact.traction[over] / contact.traction_bound[over]
        assert not over.any(), f"the traction is {share} times its bound at x, y = {contact.x[over]}, {contact.y[over]}"

    for_each(ELLIPTIC_PROBLEMS, examine)


def forces_stay_below_friction(model: ContactModel) -> None:
    """The tangential force on an ellipse, of Fx and Fy, does not exceed μN."""

    def examine(problem: Problem) -> None:
        growing = np.logspace(0, 4, 9)
        batch = problem.broadcast_to(growing.shape).with_creepages(*Creepages.of(problem).times(growing))
        share = model.creep_forces(batch).tangential / friction_limit(problem)
        assert (share <= 1.0 + error_of_sums(model)).all(), f"the force reaches {share.max():.9g} μN"

    for_each(ELLIPTIC_PROBLEMS, examine)


def nothing_slips_below_the_bound(model: ContactModel) -> None:
    """Where the traction on an ellipse is below its bound, there is no slip.

    A cell may slip on one side and stick on the other, and the traction may turn within it. So the check sums slip
    times the distance of the traction from its bound, as a share of the power in full slip.
    """
    problem = random_ellipses(POINTS)
    contact = model.solve_ellipse(problem)
    lacking = np.maximum(contact.traction_bound - contact.traction, 0.0)
    share = contact.sum_over_nodes(contact.slip * lacking * contact.area) / sliding_power(problem)
    assert (share <= model.elliptic_accuracy).all(), (
        f"below the bound there is slip, with {share.max():.2g} of the power that full slip has"
    )


def translation_reaches_full_slip(model: ContactModel) -> None:
    """At 100 times the creepage that linear theory needs for μN, the force is μN and every node slips at its bound.

    It lies along a longitudinal or a lateral creepage; where there are both, between the creepage and the force of
    linear theory, since theories with a flexibility each for x and y turn it there.
    """
    linear = np.array([[1.0, 1.0, 0.0, -1.0, -1.0, -1.0, 0.0, 1.0], [0.0, 1.0, 1.0, 1.0, 0.0, -1.0, -1.0, -1.0]])
    linear /= np.hypot(*linear)
    problem = at_reduced(random_ellipses(POINTS)[:, None], FAR * linear[0], FAR * linear[1], 0.0)
    contact, slip, error = model.solve_ellipse(problem), translation(problem), error_of_sums(model)
    limit = np.broadcast_to(friction_limit(problem), slip.shape)
    assert_close(contact.tangential_force, limit, "the force in full slip", error)
    # At a node on the very edge the bound is rounding of that in the centre.
    rounding = SAME * contact.traction_bound.max(axis=(-2, -1), keepdims=True)
    assert_close(contact.traction, contact.traction_bound, "the traction in full slip", SAME, rounding)
    assert (contact.stick_ratio <= SUM).all(), f"{contact.stick_ratio.max():.3g} of the patch sticks in full slip"
    assert_close(contact.mean_slip, slip, "the mean slip in full slip", error)
    creepage, force = np.array(Creepages.of(problem)[:2]) / slip, np.array([contact.force_x, contact.force_y]) / limit
    assert ((creepage * force).sum(axis=0) > 0).all(), "the force in full slip has the sense against the creepage"
    side = np.where(_cross(creepage, linear) < 0.0, -1.0, 1.0)
    aside = -np.minimum(side * _cross(creepage, force), side * _cross(force, linear))
    assert (aside <= error).all(), f"the force in full slip lies aside of the creepage by {aside.max():.3g} rad"


def _cross(first: Array, second: Array) -> Array:
    cross: Array = first[0] * second[1] - first[1] * second[0]
    return cross


def full_slip_on_the_ellipse_is_met_from_both_sides(model: ContactModel) -> None:
    """Where full slip of a translation begins, force and mean slip over creepage have the same limit from both sides.

    The difference between the sides falls with the distance from full slip at least as its square root, the steepest
    onset in theories of contact: from 1e-4 to 1e-8 of it, to a hundredth and hardly more.
    """
    problem = random_ellipses(POINTS)

    def solved(reduced: Array) -> Contact:
        return model.solve_ellipse(at_magnitude(problem, reduced))

    full = full_slip(solved, np.full(POINTS, FAR))
    far, near = (steps_into_full_slip(solved, full, gap) for gap in (1e-4, 1e-8))
    error = SUM + (0.0 if model.scale == "patch" else model.elliptic_accuracy)
    for name, rounding in (("force", SUM), ("mean slip", error)):
        # What begins as a square root, c √gap (1 + d √gap), falls to a fiftieth where d is as low as -50.
        wrong = near[name] > 0.02 * far[name] + 2.0 * rounding
        assert not wrong.any(), (
            f"the {name} jumps by {near[name][wrong].max():.2g} of its value into full slip, at {full[wrong][0]:g} of"
            " the creepage that linear theory needs for μN"
        )


def initial_slopes_are_kalkers(model: ContactModel) -> None:
    """For small creepages Fx is G ab C11 ξ, and Fy is G ab C22 η and G ab √(ab) C23 φ.

    The creepage is a millionth of what saturates, and the force as much nearer to linear than `SLOPE`. A march over
    coarse cells ends the traction up to a cell too soon. That error is within its accuracy, and of first order: at
    least 1.5 times less on nodes twice as fine.
    """
    error = _slope_error(model)
    if error <= SLOPE:
        return
    finer = model.refined()
    assert finer is not None and error <= model.elliptic_accuracy, f"a slope is off by {error:.2g} of Kalker's"  # noqa: PT018
    left = _slope_error(finer)
    assert left <= max(error / 1.5, SLOPE), f"a slope is off by {error:.2g}, and still by {left:.2g} on finer nodes"


def _slope_error(model: ContactModel) -> float:
    """Return the largest error of the initial slopes, relative to Kalker's slope for the same creepage."""
    small, errors = 1e-6, []
    for cause in range(3):
        reduced = [0.0, 0.0, 0.0]
        reduced[cause] = small
        problem = at_reduced(random_ellipses(POINTS), *reduced)
        forces, unit = model.creep_forces(problem), small * friction_limit(problem)
        due = (1.0, 0.0) if cause == 0 else (0.0, 1.0)
        errors += [
            float(np.abs(found / unit - slope).max())
            for found, slope in zip((forces.longitudinal, forces.lateral), due, strict=True)
        ]
    return max(errors)


def elliptic_contacts_are_similar(model: ContactModel) -> None:
    """Forces over μN and the moment over μN a depend on a/b, ν and Gξ/(μp0), Gη/(μp0), Gφa/(μp0) alone."""

    def examine(case: tuple[Problem, tuple[float, float, float, float, float]]) -> None:
        problem, (length, modulus, friction, creepage, speed) = case
        pressure = creepage * modulus / friction
        other = problem.replaced(
            a=length * problem.a,
            b=length * problem.b,
            effective_modulus=modulus * problem.effective_modulus,
            max_pressure=pressure * problem.max_pressure,
            friction_coefficient=friction * problem.friction_coefficient,
            normal_force=pressure * length**2 * problem.normal_force,
            rolling_speed=speed * problem.rolling_speed,
        )
        alike = other.with_creepages(*Creepages.of(problem).times(creepage, creepage, creepage / length))
        known, ratio = model.creep_forces(problem), friction_limit(alike) / friction_limit(problem)
        due = CreepForces(
            longitudinal=ratio * known.longitudinal,
            lateral=ratio * known.lateral,
            spin_moment=ratio * length * known.spin_moment,
        )
        assert_same_forces(alike, model.creep_forces(alike), due, "of a similar contact")

    for_each(SCALED, examine)


FACTOR = log_uniform(0.1, 10.0)
SCALED = st.tuples(ELLIPTIC_PROBLEMS, st.tuples(FACTOR, FACTOR, FACTOR, log_uniform(0.1, 1.0), FACTOR))
"""Problems, with factors of length, modulus, friction, creepage and speed; the creepages may not grow above 1."""


CLAIMS: Claims = {
    "traction_bound": (traction_vector_keeps_its_bound, forces_stay_below_friction),
    "stick": (nothing_slips_below_the_bound,),
    "saturation": (translation_reaches_full_slip, full_slip_on_the_ellipse_is_met_from_both_sides),
    "initial_slope": (initial_slopes_are_kalkers,),
    "similarity": (elliptic_contacts_are_similar,),
}
