"""Checks of how the forces follow the creepages: symmetry, growth, friction, full slip, initial slopes, spin."""

from __future__ import annotations

import numpy as np

from wearlaw.arrays import Array
from wearlaw.contact.contact import Contact
from wearlaw.contact.parts import CreepForces
from wearlaw.contact.problem import Problem
from wearlaw.models.contact_model import ContactModel
from wearlaw_kit.bisection import Indices, each_once, find_jumps
from wearlaw_kit.contact import POINTS_OF_STEPS, mixed_batch
from wearlaw_kit.examples import SAME, SUM, assert_close, for_each, leeway, left_out, part
from wearlaw_kit.reduced import (
    STRIP_AT,
    at_magnitude,
    at_reduced,
    creeping,
    friction_limit,
    in_strips,
    lever,
    parts_of_power,
    sliding_power,
    translation,
    under_conditions,
    without_spin,
)
from wearlaw_kit.shapes import (
    ELLIPSE,
    LINE,
    PATCH,
    SHAPES,
    Shape,
    assert_same_forces,
    error_of_force,
    error_of_sums,
    error_of_traction,
    forces_alone,
    on_problems,
    on_shapes,
    solutions,
)

POINTS = 32
"""Number of patches checked at once."""

FAR = 100.0
"""Reduced creepage far beyond the saturation of any theory that saturates."""

SMALL = 0.1
"""Reduced spin at which theories are still close to linear theory."""

JUMP = 1e-4
"""Share of a force that counts as a jump, a tenth of what `forces_are_continuous` claims to find."""

SLOPE = 1e-3
"""Error of initial slopes on an ellipse: half of the last digit of Kalker's coefficients."""


CAUSES = {"longitudinal": (1.0, 0.0), "lateral": (0.0, 1.0), "spin": (0.0, 1.0)}
"""The creepages, and the reduced Fx and Fy of linear theory for a reduced one."""

FALL = 0.02
"""Share to which the difference between partial and full slip falls, from 1e-4 to 1e-8 away from full slip: a hundredth
for a square root c √gap, the steepest onset in theories of contact, and a fiftieth for c √gap (1 + d √gap) with a d as
low as -50."""


@on_problems(*SHAPES)
def wear_index_is_forces_times_creepages(model: ContactModel, problem: Problem) -> None:
    """Tγ is ξFx, and on an ellipse ξFx + ηFy + φMz."""
    contact = model.solve(problem)
    rounding = SAME * parts_of_power(problem, contact.forces)
    assert_close(contact.wear_index, problem.power(contact.forces), "the wear index", 0.0, rounding)


@on_shapes(*SHAPES)
def forces_alone_are_those_of_the_contact(model: ContactModel, shape: Shape) -> None:
    """`tangential_force` and `creep_forces` give the forces of `solve`, with the sign of the creepage."""

    def examine(problem: Problem) -> None:
        assert_same_forces(problem, forces_alone(model, problem), model.solve(problem).forces, "alone", SUM)

    for_each(shape.problems, examine)
    examine(mixed_batch(shape))


@on_problems(*SHAPES, claims=("direction",))
def zero_creepage_gives_nothing(model: ContactModel, problem: Problem) -> None:
    """Free rolling has no traction, no slip, no forces and no wear index."""
    contact = model.solve(creeping(problem, 0.0))
    for name in ("traction", "slip", "tangential_force", "force_x", "force_y", "moment_z", "wear_index"):
        value = getattr(contact, name)
        assert (value == 0).all(), f"without creepage {name} reaches {np.abs(value).max():.3g} in SI units"


@on_problems(*SHAPES, claims=("symmetry",))
def forces_are_odd_in_the_creepages(model: ContactModel, problem: Problem) -> None:
    """Opposite creepages and spin give opposite forces and moment."""
    _compare_turned(model, problem, (-1.0, -1.0, -1.0), "at the opposite creepages")


@on_problems(ELLIPSE, claims=("symmetry",))
def forces_are_mirrored_with_the_creepages(model: ContactModel, problem: Problem) -> None:
    """Opposite lateral creepage and spin give the same Fx, and opposite Fy and Mz, as y is mirrored."""
    _compare_turned(model, problem, (1.0, -1.0, -1.0), "at the mirrored creepages")


def _compare_turned(model: ContactModel, problem: Problem, signs: tuple[float, float, float], message: str) -> None:
    """Compare forces with those for creepages, and hence forces, of other signs."""
    forces, other = (forces_alone(model, case) for case in (problem, creeping(problem, *signs)))
    due = CreepForces(
        longitudinal=signs[0] * forces.longitudinal,
        lateral=signs[1] * forces.lateral,
        spin_moment=signs[2] * forces.spin_moment,
    )
    assert_same_forces(problem, other, due, message, SUM)


@on_problems(*SHAPES, claims=("growth",))
def force_grows_with_creepage(model: ContactModel, problem: Problem) -> None:
    """Fx never falls when a longitudinal creepage alone grows."""
    growing = np.concatenate([[1.0], 1.0 + np.logspace(-12, 3, 31)])
    creepage = translation(problem)[:, None] * growing
    batch = problem[:, None].broadcast_to(creepage.shape).with_creepages(creepage, 0.0 * creepage, 0.0 * creepage)
    force = forces_alone(model, batch).longitudinal
    fell = np.diff(force) < -max(SUM, leeway()) * force[:, :-1]
    assert not fell.any(), f"the force falls as the creepage grows: {force!r}"
    assert (force[:, 0] > 0).all(), f"the force is {force[:, 0].min()!r} at a positive creepage"


@on_problems(*SHAPES, claims=("traction_bound",))
def traction_keeps_its_bound(model: ContactModel, problem: Problem) -> None:
    """The magnitude of the traction does not exceed the bound at any node."""
    for contact in solutions(model, problem):
        traction = np.abs(contact.traction)
        over = traction > contact.traction_bound * (1.0 + error_of_traction(model, problem))
        share = traction[over] / contact.traction_bound[over]
        assert not over.any(), f"the traction is {share} times its bound at x, y = {contact.x[over]}, {contact.y[over]}"


@on_shapes(*SHAPES, claims=("stick",))
def what_sticks_does_not_slip(model: ContactModel, shape: Shape) -> None:
    """There is no slip where the traction is below its bound.

    On an ellipse a cell may slip on one side and stick on the other, and the traction may turn within it. So the check
    sums slip times the distance of the traction from its bound, as a share of the power in full slip; and it leaves out
    creepages at which no more than such cells slip.
    """
    allowed = leeway() if shape is LINE else max(model.elliptic_accuracy, leeway())

    def examine(problem: Problem) -> None:
        for contact in solutions(model, problem):
            lacking = np.maximum(contact.traction_bound * (1.0 - SAME) - np.abs(contact.traction), 0.0)
            share = contact.integral(np.abs(contact.slip), lacking) / sliding_power(problem)
            assert (share <= allowed).all(), f"below the bound, slip has {share.max():.2g} of the power of full slip"

    for_each(shape.draw(POINTS), examine)
    if shape is LINE:
        for_each(shape.problems, examine)


@on_shapes(*SHAPES, claims=("continuity",))
def forces_are_continuous(model: ContactModel, shape: Shape) -> None:
    """Forces and mean slip have no jump as creepages grow through full slip; one of 1/1000 is found.

    Cells begin to slip as a whole: with them, the mean slip may jump by the accuracy times that of full slip. On the
    nodes of an ellipse, with spin, strips may begin to slip elsewhere at once: then a force may jump by the accuracy
    times μN.
    """
    # A curved force changes by less than 1/1000 more in one half of an interval than in the other: Carter's, with its
    # curvature of 2 at full slip, by 2 (3 ln 10/512/2)² = 1e-4, and that of an ellipse, whose logarithmic slope changes
    # by up to 2 per e-fold, by 2 (ln 10/64/2)² = 6e-4.
    low, high, intervals = (1e-2, 10.0, 512) if shape is LINE else (0.6, 6.0, 64)
    problem = shape.draw(2)
    error = error_of_sums(model, problem)
    of_forces = np.maximum(error * (problem.spin != 0), leeway()) * friction_limit(problem)
    allowed = {"mean_slip": error * translation(at_magnitude(problem, high))}
    allowed |= dict.fromkeys(("force_x",) if shape is LINE else ("force_x", "force_y"), of_forces)

    def solved(index: Indices, share: Array) -> dict[str, Array]:
        contact = model.solve(at_magnitude(problem[index], low * (high / low) ** share))
        return {name: getattr(contact, name) for name in allowed}

    function = each_once(solved)
    for name, step in allowed.items():
        jumps = find_jumps(function(name), problem.size, intervals, JUMP, 0.5 * step)
        for point, share, before, behind in jumps:
            where = f"at the reduced creepage {low * (high / low) ** share:g}"
            assert abs(behind - before) <= step[point], f"{name} jumps from {before:.9g} to {behind:.9g} {where}"


@on_shapes(*SHAPES, claims=("saturation",))
def full_slip_is_reached(model: ContactModel, shape: Shape) -> None:
    """At 100 times the creepage of Carter's full slip, μa/R, the force is μN and every node slips at its bound.

    On an ellipse at 100 times the creepage that linear theory needs for μN, without spin. The force lies along a
    longitudinal or a lateral creepage; where there are both, between the creepage and the force of linear theory, since
    theories with a flexibility each for x and y turn it there.
    """
    angle = 0.25 * np.pi * np.arange(1 if shape is LINE else 8)
    linear = np.array([np.cos(angle), np.sin(angle)])
    problem = at_reduced(shape.draw(POINTS)[:, None], FAR * linear[0], FAR * linear[1], 0.0)
    contact, slip, error = model.solve(problem), translation(problem), error_of_force(model, problem)
    limit, bound = friction_limit(problem), contact.traction_bound
    there = f"at {FAR:g} times the creepage {'μa/R' if shape is LINE else 'of linear theory for μN'}"
    assert_close(contact.tangential_force, limit, f"the force {there}", error)
    # At a node on the very edge the bound is rounding of that in the centre.
    edge = SAME * contact.per_node(bound.max(axis=tuple(range(2, bound.ndim))))
    assert_close(contact.traction, bound, f"the traction {there}", error_of_traction(model, problem), edge)
    sticks = contact.stick_ratio > max(SUM, leeway())
    assert not sticks.any(), f"{contact.stick_ratio.max():.3g} of the patch sticks {there}"
    assert_close(contact.mean_slip, slip, f"the mean slip {there}", error_of_sums(model, problem))
    creepage = np.array([problem.longitudinal_creepage, problem.lateral_creepage]) / slip
    force = np.array([contact.force_x, contact.force_y]) / limit
    assert ((creepage * force).sum(axis=0) > 0).all(), "the force in full slip has the sense against the creepage"
    side = np.where(_cross(creepage, linear) < 0.0, -1.0, 1.0)
    aside = -np.minimum(side * _cross(creepage, force), side * _cross(force, linear))
    assert (aside <= error).all(), f"the force in full slip lies aside of the creepage by {aside.max():.3g} rad"


def _cross(first: Array, second: Array) -> Array:
    cross: Array = first[0] * second[1] - first[1] * second[0]
    return cross


@on_shapes(*SHAPES, claims=("saturation",))
def full_slip_is_met_from_both_sides(model: ContactModel, shape: Shape) -> None:
    """Where full slip begins, force and mean slip over creepage have the same limit from both sides, without spin.

    The difference between the sides falls with the distance from full slip at least as its square root.
    """
    problem = without_spin(shape.draw(POINTS_OF_STEPS))

    def solved(reduced: Array) -> Contact:
        return model.solve(at_magnitude(problem, reduced))

    full = np.full(problem.size, FAR)  # the least creepages, to rounding, with the force of full slip and no stick
    low, limit = np.zeros(problem.size), solved(full).tangential_force * (1.0 - SAME)
    for _ in range(60):
        middle = 0.5 * (low + full)
        contact = solved(middle)
        reached = (contact.tangential_force >= limit) & (contact.stick_ratio <= max(SUM, leeway()))
        low, full = np.where(reached, low, middle), np.where(reached, middle, full)

    def step(gap: float) -> dict[str, Array]:
        """Return the relative differences between a `gap` below and a `gap` above full slip."""
        below, above = (solved(full * (1.0 + side * gap)) for side in (-1.0, 1.0))
        slip = below.mean_slip / above.mean_slip * (1.0 + gap) / (1.0 - gap)
        return {"force": np.abs(1.0 - below.tangential_force / above.tangential_force), "mean slip": np.abs(1.0 - slip)}

    far, near = step(1e-4), step(1e-8)
    error = max(SUM, error_of_sums(model, problem))
    for name, rounding in (("force", max(SUM, leeway())), ("mean slip", error)):
        wrong = ~(near[name] <= FALL * far[name] + 2.0 * rounding)
        assert not wrong.any(), (
            f"the {name} jumps by {near[name][wrong].max():.2g} of its value into full slip, at the reduced creepage"
            f" {full[wrong][0]:g}"
        )


@on_problems(LINE, claims=("initial_slope",))
def initial_slope_is_that_of_the_half_space(model: ContactModel, problem: Problem) -> None:
    """On a line the force at small creepage is (π/2) E* a ξ per width."""
    reduced = np.logspace(-9, -4, problem.size)  # relative to the creepage of full slip
    small = [at_reduced(problem, share * reduced, 0.0, 0.0) for share in (1.0, 0.5)]
    whole, half = (model.solve(case).tangential_force / case.creepage for case in small)
    due = 0.5 * np.pi * problem.effective_modulus * problem.half_width * problem.track_width
    # T/ξ = T'(0) + c ξ + ..., so that half the creepage halves the remainder: it is twice the difference, except for
    # the next order, which is the share ξR/(μa) of it. With an error e of each T, the first quotient is off by e, and
    # twice the difference by 4 e.
    remainder = 2.0 * (1.0 + reduced) * np.abs(whole - half)
    assert_close(whole, due, "the force over a small creepage", 5.0 * error_of_force(model, problem), remainder)


@on_shapes(ELLIPSE, claims=("initial_slope",))
def initial_slopes_are_kalkers(model: ContactModel, shape: Shape) -> None:
    """For small creepages Fx is G ab C11 ξ, and Fy is G ab C22 η and G ab √(ab) C23 φ.

    The creepage is a millionth of the creepage at saturation, so that the force differs from the linear one by far less
    than `SLOPE`. A march over coarse cells ends the traction up to a cell too soon. That error is within its accuracy,
    and of first order: at least 1.5 times smaller on nodes twice as fine.
    """
    for cause in CAUSES:
        if left_out(cause):
            continue
        with part(cause):
            error, enough = _slope_error(model, shape, cause), max(SLOPE, leeway())
        if error <= enough:
            continue
        finer, slope = model.refined(), f"a slope with the {cause} creepage" if cause != "spin" else "a slope with spin"
        assert finer is not None, f"{slope} is off by {error:.2g} of Kalker's"
        assert error <= model.elliptic_accuracy, f"{slope} is off by {error:.2g} of Kalker's"
        left = _slope_error(finer, shape, cause)
        assert left <= max(error / 1.5, enough), f"{slope} is off by {error:.2g}, and by {left:.2g} on finer nodes"


def _slope_error(model: ContactModel, shape: Shape, cause: str) -> float:
    """Return the largest error of the initial slopes, relative to Kalker's slope for the same creepage."""
    small, (along, across) = 1e-6, CAUSES[cause]
    creepages = {name: small * (name == cause) for name in CAUSES}
    problem = at_reduced(shape.draw(POINTS), *creepages.values())
    forces, unit = model.creep_forces(problem), small * friction_limit(problem)
    return float(max(np.abs(forces.longitudinal / unit - along).max(), np.abs(forces.lateral / unit - across).max()))


@on_shapes(*SHAPES, claims=("similarity",))
def contacts_are_similar(model: ContactModel, shape: Shape) -> None:
    """T/(μN) of a line depends on ξR/(μa) alone.

    On an ellipse forces over μN and the moment over μN a depend on a/b, ν and Gξ/(μp0), Gη/(μp0), Gφa/(μp0) alone. So
    they do for contacts of the same creepages under other loads, in one batch.
    """
    twice = np.tile(np.arange(shape.wide.size), 2)
    for cases, same in ((shape.wide, False), (shape.wide[twice], True)):
        problem, other = (under_conditions(shape.cut(case)) for case in (cases, _scaled(cases, same)))
        forces, ratio = forces_alone(model, problem), friction_limit(other) / friction_limit(problem)
        due = CreepForces(
            longitudinal=ratio * forces.longitudinal,
            lateral=ratio * forces.lateral,
            spin_moment=ratio * other.a / problem.a * forces.spin_moment,
        )
        assert_same_forces(other, forces_alone(model, other), due, "of a similar contact", SUM)


def _scaled(problem: Problem, same: bool) -> Problem:
    """Return similar problems of other moduli, frictions, speeds and, unless `same`, sizes and creepages."""
    random, shape = np.random.default_rng(8), problem.batch_shape
    length, modulus, friction, speed = 10.0 ** random.uniform(-1.0, 1.0, (4, *shape))
    creepage = 10.0 ** random.uniform(-1.0, 0.0, shape)  # it may not grow above 1
    if same:
        length = creepage = np.ones(shape)
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
    return creeping(other, creepage, creepage, creepage / length)


@on_shapes(ELLIPSE, applies=lambda model: "strips" in model.geometries())
def strips_of_an_ellipse_have_its_forces(model: ContactModel, shape: Shape) -> None:
    """An ellipse, long or wide, and the strips that it is cut into transmit the same forces."""
    problem = shape.draw(POINTS)
    strips = under_conditions(in_strips(problem, lean=0.0))
    # A sum over n strips of equal width misses a parabola by the share 1/(2n²).
    error = error_of_sums(model, problem) + 0.5 / STRIP_AT.size**2
    forces, due = forces_alone(model, strips), forces_alone(model, problem)
    assert_same_forces(problem, forces, due, "of the strips of the ellipse", error)


@on_shapes(ELLIPSE, PATCH, claims=("spin",))
def spin_has_its_force_and_moment(model: ContactModel, shape: Shape) -> None:
    """A positive spin alone gives neither a negative Fy nor a negative Mz, and one of them has a size.

    For a small spin, Fy is at least a quarter of the linear theory's. Or Mz is as large a share of μN times its lever:
    in full slip between rigid bodies, spin gives a moment alone. The simplified theory and Polach's have at least half
    of the linear Fy at a/b from 1/20 to 20.
    """
    if left_out("spin"):
        return
    problem = at_reduced(shape.draw(POINTS), 0.0, 0.0, SMALL)
    forces, linear = forces_alone(model, problem), SMALL * friction_limit(problem)
    shares = {"Fy": forces.lateral / linear, "Mz": forces.spin_moment / (linear * lever(problem))}
    for name, share in shares.items():
        assert (share >= -max(SUM, error_of_sums(model, problem)) / SMALL).all(), (
            f"a positive spin alone gives a negative {name}, of {share.min():.3g} times the size of linear theory"
        )
    least = np.maximum(*shares.values()).min()
    assert least >= 0.25 * (1.0 - leeway()), (
        f"a spin alone gives only {least:.3g} of the Fy of linear theory, and no Mz of that size"
    )
