"""Checks of how the tangential force follows the creepage."""

from __future__ import annotations

from functools import partial

import numpy as np

from wearlaw.arrays.array import Array
from wearlaw.contact.problem import Problem
from wearlaw.models.contact_model import ContactModel
from wearlaw.testing.bisection import Indices, find_jumps
from wearlaw.testing.contact_checks import (
    error_of_force,
    random_problems,
    repeated,
    saturation,
    with_creepage,
)
from wearlaw.testing.examples import SAME, assert_close, for_each
from wearlaw.testing.shared_checks import friction_limit
from wearlaw.testing.strategies import LINE_PROBLEMS


def force_is_odd_in_creepage(model: ContactModel) -> None:
    """The opposite creepage gives the opposite force and the same wear index."""

    def examine(problem: Problem) -> None:
        ahead, back = model.solve(problem), model.solve(with_creepage(problem, -problem.creepage))
        assert_close(-back.tangential_force, ahead.tangential_force, "minus the force at the opposite creepage")
        assert_close(back.wear_index, ahead.wear_index, "the wear index at the opposite creepage")

    for_each(LINE_PROBLEMS, examine)


def force_grows_with_creepage(model: ContactModel) -> None:
    """The tangential force never falls when the creepage grows."""

    def examine(problem: Problem) -> None:
        growing = np.concatenate([[1.0], 1.0 + np.logspace(-12, 3, 31)])
        force = model.solve(
            with_creepage(repeated(problem, growing.shape), problem.creepage * growing)
        ).tangential_force
        fell = np.diff(force) < -SAME * force[:-1]
        assert not fell.any(), f"the force falls as the creepage grows: {force!r}"
        assert force[0] > 0, f"the force is {force[0]!r} at a positive creepage"

    for_each(LINE_PROBLEMS, examine)


def force_stays_below_friction(model: ContactModel) -> None:
    """The tangential force does not exceed μN."""

    def examine(problem: Problem) -> None:
        creepage = problem.creepage * np.logspace(0, 4, 9)
        force = model.solve(with_creepage(repeated(problem, creepage.shape), creepage)).tangential_force
        limit = friction_limit(problem) * (1.0 + error_of_force(model))
        assert (force <= limit).all(), f"the force reaches {force.max() / friction_limit(problem):.9g} μN"

    for_each(LINE_PROBLEMS, examine)


def force_is_continuous(model: ContactModel) -> None:
    """Force and mean slip have no jump as the creepage grows, through full slip; one of 1/1000 is found.

    Cells begin to slip as a whole: with them, the mean slip may jump by the accuracy times μa/R.
    """
    points = 2
    problem = random_problems(points)
    low, decades = 1e-2 * saturation(problem), 3.0

    def solved(name: str, index: Indices, share: Array) -> Array:
        value: Array = getattr(model.solve(with_creepage(problem[index], low[index] * 10.0 ** (decades * share))), name)
        return value

    # Where a cell begins to slip, the sum of the slips is off by a share of what it is in full slip.
    cell = {"tangential_force": np.zeros(points), "mean_slip": model.accuracy * saturation(problem)}
    # Carter's force has a curvature of 2 at full slip, hence changes by 2 (3 ln 10/512/2)² = 1e-4 more in one half.
    for name, allowed in cell.items():
        for point, share, before, behind in find_jumps(partial(solved, name), points, intervals=512):
            creepage = low[point] * 10.0 ** (decades * share)
            assert abs(behind - before) <= allowed[point], (
                f"{name} jumps from {before:.9g} to {behind:.9g} in SI units at creepage {creepage:g}"
            )


def zero_creepage_gives_nothing(model: ContactModel) -> None:
    """Free rolling has no traction, no slip and no wear index."""

    def examine(problem: Problem) -> None:
        contact = model.solve(with_creepage(problem, 0.0))
        for name in ("traction", "slip", "tangential_force", "wear_index"):
            value = getattr(contact, name)
            assert (value == 0).all(), f"at zero creepage {name} is {value!r}"

    for_each(LINE_PROBLEMS, examine)


def wear_index_is_force_times_creepage(model: ContactModel) -> None:
    """Tγ is the tangential force times the creepage."""

    def examine(problem: Problem) -> None:
        contact = model.solve(problem)
        assert_close(contact.wear_index, contact.tangential_force * problem.creepage, "the wear index")

    for_each(LINE_PROBLEMS, examine)


def force_alone_is_that_of_the_contact(model: ContactModel) -> None:
    """`tangential_force` gives what `solve` gives, with the sign of the creepage."""
    for sign in (-1.0, 0.0, 1.0):
        problem = random_problems(64)
        problem = with_creepage(problem, sign * problem.creepage)
        due = model.solve(problem).tangential_force
        assert_close(model.tangential_force(problem), due, "what `tangential_force` gives")


CHECKS = (
    force_is_odd_in_creepage,
    force_grows_with_creepage,
    force_stays_below_friction,
    force_is_continuous,
    zero_creepage_gives_nothing,
    wear_index_is_force_times_creepage,
    force_alone_is_that_of_the_contact,
)
