"""Checks of how the forces follow the creepages."""

from __future__ import annotations

from functools import partial

import numpy as np

from wearlaw.arrays.array import Array
from wearlaw.contact.problem import CreepForces, Problem
from wearlaw.models.contact_model import ContactModel
from wearlaw_kit.bisection import Indices, find_jumps
from wearlaw_kit.examples import SAME, assert_close, for_each
from wearlaw_kit.reduced import (
    at_magnitude,
    at_reduced,
    creeping,
    friction_limit,
    lever,
    parts_of_power,
    translation,
    without_spin,
)
from wearlaw_kit.shapes import (
    ELLIPSE,
    Claims,
    Shape,
    assert_same_forces,
    assert_same_power,
    on_each_shape,
    on_patches_of_strips,
    on_problems,
    on_problems_of_each_shape,
)

POINTS = 32
"""Number of patches checked at once."""

FULL = 1e4
"""Reduced creepage at which hardly more than the rigid slip is left."""

SMALL = 0.1
"""Reduced spin at which theories are still close to linear theory."""


@on_problems_of_each_shape
def forces_are_odd_in_the_creepages(model: ContactModel, shape: Shape, problem: Problem) -> None:
    """Opposite creepages and spin give opposite forces and moment, and the same wear index."""
    _compare_turned(model, shape, problem, (-1.0, -1.0, -1.0), "at the opposite creepages")


@on_problems(ELLIPSE)
def forces_are_mirrored_with_the_creepages(model: ContactModel, shape: Shape, problem: Problem) -> None:
    """Opposite lateral creepage and spin give the same Fx and wear index, and opposite Fy and Mz, as y is mirrored."""
    _compare_turned(model, shape, problem, (1.0, -1.0, -1.0), "at the mirrored creepages")


def _compare_turned(
    model: ContactModel, shape: Shape, problem: Problem, signs: tuple[float, float, float], message: str
) -> None:
    """Compare forces and wear index with those for creepages, and hence forces, of other signs."""
    contact, other = model.solve(problem), model.solve(creeping(problem, *signs))
    due = CreepForces(
        longitudinal=signs[0] * contact.force_x,
        lateral=signs[1] * contact.force_y,
        spin_moment=signs[2] * contact.moment_z,
    )
    assert_same_forces(shape, problem, other.forces, due, message, shape.rounding)
    assert_same_power(shape, problem, other, contact, message, shape.rounding)


@on_problems_of_each_shape
def force_grows_with_creepage(model: ContactModel, shape: Shape, problem: Problem) -> None:
    """Fx never falls when a longitudinal creepage alone grows."""
    growing = np.concatenate([[1.0], 1.0 + np.logspace(-12, 3, 31)])
    creepage = translation(problem)[:, None] * growing
    batch = problem[:, None].broadcast_to(creepage.shape).with_creepages(creepage, 0.0 * creepage, 0.0 * creepage)
    force = shape.forces(model, batch).longitudinal
    fell = np.diff(force) < -shape.rounding * force[:, :-1]
    assert not fell.any(), f"the force falls as the creepage grows: {force!r}"
    assert (force[:, 0] > 0).all(), f"the force is {force[:, 0].min()!r} at a positive creepage"


@on_problems_of_each_shape
def force_stays_below_friction(model: ContactModel, shape: Shape, problem: Problem) -> None:
    """The tangential force, on an ellipse of Fx and Fy, does not exceed μN."""
    growing = np.logspace(0, 2, 5)
    batch = creeping(problem[:, None].broadcast_to((problem.size, growing.size)), growing)
    share = shape.forces(model, batch).tangential / friction_limit(batch)
    assert (share <= 1.0 + shape.error_of_force(model)).all(), f"the force reaches {share.max():.9g} μN"


@on_each_shape
def forces_are_continuous(model: ContactModel, shape: Shape) -> None:
    """Forces and mean slip have no jump as creepages grow through full slip; one of 1/1000 is found.

    Cells begin to slip as a whole: with them, the mean slip may jump by the accuracy times the creepage, on a line that
    of full slip. On the nodes of an ellipse, with spin, a force may jump by the accuracy times μN.
    """
    path = shape.path(model)
    growth = path.high / path.low

    def solved(name: str, index: Indices, share: Array) -> Array:
        value: Array = getattr(model.solve(at_magnitude(path.problem[index], path.low * growth**share)), name)
        return value

    for name, allowed in path.allowed.items():
        for point, share, before, behind in find_jumps(partial(solved, name), path.problem.size, path.intervals):
            assert abs(behind - before) <= allowed[point], (
                f"{name} jumps from {before:.9g} to {behind:.9g} in SI units at {path.low * growth**share:g} of"
                f" {shape.unit}"
            )


@on_problems_of_each_shape
def zero_creepage_gives_nothing(model: ContactModel, shape: Shape, problem: Problem) -> None:  # noqa: ARG001
    """Free rolling has no traction, no slip, no forces and no wear index."""
    contact = model.solve(creeping(problem, 0.0))
    for name in ("traction", "slip", "tangential_force", "force_x", "force_y", "moment_z", "wear_index"):
        value = getattr(contact, name)
        assert (value == 0).all(), f"without creepage {name} reaches {np.abs(value).max():.3g} in SI units"


@on_problems_of_each_shape
def wear_index_is_forces_times_creepages(model: ContactModel, shape: Shape, problem: Problem) -> None:  # noqa: ARG001
    """Tγ is ξFx, and on an ellipse ξFx + ηFy + φMz."""
    contact = model.solve(problem)
    rounding = SAME * parts_of_power(problem, contact.forces)
    assert_close(contact.wear_index, problem.power(contact.forces), "the wear index", 0.0, rounding)


@on_each_shape
def forces_alone_are_those_of_the_contact(model: ContactModel, shape: Shape) -> None:
    """`tangential_force` and `creep_forces` give the forces of `solve`, with the sign of the creepage."""

    def examine(problem: Problem) -> None:
        found, due = shape.forces_alone(model, problem), model.solve(problem).forces
        assert_same_forces(shape, problem, found, due, "alone", shape.rounding)

    for_each(shape.problems, examine)
    examine(shape.batch)


@on_patches_of_strips
def spin_has_its_force_and_moment(model: ContactModel, shape: Shape) -> None:
    """A positive spin alone gives neither a negative Fy nor a negative Mz, and one of them has a size.

    For a small spin, Fy is at least a quarter of the linear theory's. Or Mz is as large a share of μN times its lever:
    in full slip between rigid bodies, spin gives a moment alone. The simplified theory and Polach's have at least half
    of the linear Fy at a/b from 1/20 to 20.
    """
    problem = at_reduced(shape.random(POINTS), 0.0, 0.0, SMALL)
    forces, linear = shape.forces_alone(model, problem), SMALL * friction_limit(problem)
    shares = {"Fy": forces.lateral / linear, "Mz": forces.spin_moment / (linear * lever(problem))}
    for name, share in shares.items():
        assert (share >= -max(shape.rounding, shape.error_of_sums(model)) / SMALL).all(), (
            f"a positive spin alone gives a negative {name}, of {share.min():.3g} times the size of linear theory"
        )
    least = np.maximum(*shares.values()).min()
    assert least >= 0.25, f"a spin alone gives only {least:.3g} of the Fy of linear theory, and no Mz of that size"


@on_patches_of_strips
def slip_turns_with_the_spin(model: ContactModel, shape: Shape) -> None:
    """In full slip the slip turns with the spin: it gains (-φy, -φx), where a model resolves the patch.

    It gains a quarter to four times that, since theories with a flexibility each for x, y and spin turn at other rates:
    the simplified theory at 1 to 3.9 times that, at a/b from 1/20 to 20. The check compares ∫ y s_x dA and ∫ x s_y dA.
    Half the difference between both signs of the spin leaves out the slip of elastic bodies without spin.
    """
    if model.scale == "patch":
        return
    problem = at_magnitude(without_spin(shape.random(POINTS)), FULL)
    spin = 0.5 * translation(problem) / np.maximum(problem.a, problem.b)
    more, less = (
        model.solve(problem.with_creepages(problem.creepage, problem.lateral_creepage, side * spin))
        for side in (1.0, -1.0)
    )
    for slip, arm in (("slip_x", "y"), ("slip_y", "x")):
        turned = [contact.integral(getattr(contact, slip), getattr(contact, arm)) for contact in (more, less)]
        rate = -0.5 * (turned[0] - turned[1]) / (spin * more.integral(getattr(more, arm), getattr(more, arm)))
        wrong = ~((rate >= 0.25) & (rate <= 4.0))
        assert not wrong.any(), f"along {arm}, {slip} falls at {rate[wrong][0]:.3g} times the spin"


CHECKS = (wear_index_is_forces_times_creepages, forces_alone_are_those_of_the_contact)

CLAIMS: Claims = {
    "symmetry": (forces_are_odd_in_the_creepages, forces_are_mirrored_with_the_creepages),
    "growth": (force_grows_with_creepage,),
    "traction_bound": (force_stays_below_friction,),
    "friction": (force_stays_below_friction,),
    "continuity": (forces_are_continuous,),
    "direction": (zero_creepage_gives_nothing,),
    "spin": (spin_has_its_force_and_moment, slip_turns_with_the_spin),
}
