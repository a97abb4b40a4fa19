"""Checks of how the forces on an ellipse follow the creepages."""

from __future__ import annotations

from functools import partial

import numpy as np

from wearlaw.arrays.array import Array
from wearlaw.contact.contact import Contact
from wearlaw.contact.problem import CreepForces, Problem
from wearlaw.models.contact_model import ContactModel
from wearlaw.testing.bisection import Indices, find_jumps
from wearlaw.testing.ellipse_checks import forces_of
from wearlaw.testing.ellipses import (
    Creepages,
    assert_same_forces,
    at_magnitude,
    at_reduced,
    random_ellipses,
    sliding_power,
    translation,
    unit_creepages,
)
from wearlaw.testing.examples import SAME, SUM, assert_close, for_each
from wearlaw.testing.shared_checks import friction_limit
from wearlaw.testing.strategies import ELLIPTIC_PROBLEMS


def forces_are_odd_in_the_creepages(model: ContactModel) -> None:
    """Opposite creepages and spin give opposite forces and moment, and the same wear index."""

    def examine(problem: Problem) -> None:
        _compare_turned(model, problem, (-1.0, -1.0, -1.0), "at the opposite creepages")

    for_each(ELLIPTIC_PROBLEMS, examine)


def forces_are_mirrored_with_the_creepages(model: ContactModel) -> None:
    """Opposite lateral creepage and spin give the same Fx and wear index, and opposite Fy and Mz, as y is mirrored."""

    def examine(problem: Problem) -> None:
        _compare_turned(model, problem, (1.0, -1.0, -1.0), "at the mirrored creepages")

    for_each(ELLIPTIC_PROBLEMS, examine)


def _compare_turned(model: ContactModel, problem: Problem, signs: tuple[float, float, float], message: str) -> None:
    """Compare forces and wear index with those for creepages, and hence forces, of other signs."""
    contact, other = (
        model.solve_ellipse(problem),
        model.solve_ellipse(problem.with_creepages(*Creepages.of(problem).times(*signs))),
    )
    due = CreepForces(
        longitudinal=signs[0] * contact.force_x,
        lateral=signs[1] * contact.force_y,
        spin_moment=signs[2] * contact.moment_z,
    )
    assert_same_forces(problem, forces_of(other), due, message)
    rounding = SUM * np.maximum(sliding_power(problem), _parts_of_power(problem, contact))
    assert_close(other.wear_index, contact.wear_index, f"the wear index {message}", 0.0, rounding)


def _parts_of_power(problem: Problem, contact: Contact) -> Array:
    """Return |ξFx| + |ηFy| + |φMz|, the scale of the rounding error of their sum."""
    return (
        np.abs(problem.longitudinal_creepage * contact.force_x)
        + np.abs(problem.lateral_creepage * contact.force_y)
        + np.abs(problem.spin * contact.moment_z)
    )


def longitudinal_force_grows_with_creepage(model: ContactModel) -> None:
    """Fx never falls when a longitudinal creepage alone grows."""

    def examine(problem: Problem) -> None:
        growing = np.concatenate([[1.0], 1.0 + np.logspace(-12, 3, 31)])
        creepage = translation(problem) / unit_creepages(problem).longitudinal
        force = model.creep_forces(at_reduced(problem, creepage * growing, 0.0, 0.0)).longitudinal
        fell = np.diff(force) < -SUM * force[:-1]
        assert not fell.any(), f"the force falls as the creepage grows: {force!r}"
        assert force[0] > 0, f"the force is {force[0]!r} at a positive creepage"

    for_each(ELLIPTIC_PROBLEMS, examine)


def forces_are_continuous(model: ContactModel) -> None:
    """Forces and mean slip have no jump as creepages grow through full slip; one of 1/1000 is found.

    On nodes, with spin, strips may begin to slip elsewhere at once: then a force may jump by the accuracy times μN. The
    mean slip may by the accuracy times the creepage.
    """
    problem, low, high = random_ellipses(4)[[0, 1, 3]], 0.6, 6.0  # one without spin, two with it

    def solved(name: str, index: Indices, share: Array) -> Array:
        chosen = problem[index]
        value: Array = getattr(
            model.solve_ellipse(at_magnitude(chosen, low * (high / low) ** share, chosen.spin)), name
        )
        return value

    error = 0.0 if model.scale == "patch" else model.elliptic_accuracy
    of_forces = error * (problem.spin != 0) * friction_limit(problem)
    # Where a cell begins to slip, the sum of the slips is off by a share of what it is in full slip.
    of_slip = error * translation(at_magnitude(problem, high))
    limits = {"force_x": of_forces, "force_y": of_forces, "mean_slip": of_slip}
    for name, allowed in limits.items():
        # A force has a logarithmic slope that changes by up to 2 per e-fold: by 2 (ln 10/64/2)² = 6e-4 in one half.
        for point, share, before, behind in find_jumps(partial(solved, name), problem.size, intervals=64):
            assert abs(behind - before) <= allowed[point], (
                f"{name} jumps from {before:.9g} to {behind:.9g} in SI units at {low * (high / low) ** share:g} of"
                f" the creepage that linear theory needs for μN"
            )


def zero_creepages_give_nothing(model: ContactModel) -> None:
    """Free rolling of a wheel has no traction, no slip, no forces and no wear index."""

    def examine(problem: Problem) -> None:
        contact = model.solve_ellipse(problem.with_creepages(*Creepages.of(problem).times(0.0)))
        for name in ("traction", "slip", "force_x", "force_y", "moment_z", "wear_index"):
            value = getattr(contact, name)
            assert (value == 0).all(), f"without creepage {name} reaches {np.abs(value).max():.3g} in SI units"

    for_each(ELLIPTIC_PROBLEMS, examine)


def wear_index_is_forces_times_creepages(model: ContactModel) -> None:
    """Tγ is ξFx + ηFy + φMz."""

    def examine(problem: Problem) -> None:
        contact = model.solve_ellipse(problem)
        due, rounding = problem.power(forces_of(contact)), SAME * _parts_of_power(problem, contact)
        assert_close(contact.wear_index, due, "the wear index", 0.0, rounding)

    for_each(ELLIPTIC_PROBLEMS, examine)


def creep_forces_are_those_of_the_contact(model: ContactModel) -> None:
    """`creep_forces` gives what `solve` gives."""

    def examine(problem: Problem) -> None:
        assert_same_forces(
            problem, model.creep_forces(problem), forces_of(model.solve_ellipse(problem)), "of `creep_forces`"
        )

    for_each(ELLIPTIC_PROBLEMS, examine)


CHECKS = (
    forces_are_odd_in_the_creepages,
    forces_are_mirrored_with_the_creepages,
    longitudinal_force_grows_with_creepage,
    forces_are_continuous,
    zero_creepages_give_nothing,
    wear_index_is_forces_times_creepages,
    creep_forces_are_those_of_the_contact,
)
