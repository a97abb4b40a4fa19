"""Checks of a stage around the contact models of wearlaw, on each shape of patch."""

from __future__ import annotations

import operator
from typing import Any, ClassVar

import numpy as np
from pydantic import SkipValidation

from wearlaw import loader
from wearlaw.arrays import Array
from wearlaw.contact.contact import TOTALS, Contact
from wearlaw.contact.problem import Problem
from wearlaw.models.contact_model import Solve, Stage
from wearlaw.numerics.integrate import integrate_forces
from wearlaw.numerics.solving import FIELDS, Solver, check_finite
from wearlaw.numerics.staged import staged
from wearlaw_kit.bisection import Indices, each_once, find_jumps
from wearlaw_kit.contact import assert_digits
from wearlaw_kit.examples import assert_close
from wearlaw_kit.reduced import creeping, random_lines
from wearlaw_kit.rig_inputs import other_fields
from wearlaw_kit.rules import rule
from wearlaw_kit.shapes import (
    ELLIPSE,
    INSIDE,
    LINE,
    Shape,
    assert_same_forces,
    forces_as,
    kept_shapes,
    of_stage,
    with_bodies,
)

POINTS = 24
"""Operating points at which a stage is tried."""

PATHS = 16
"""Number of paths between random contacts to search for jumps."""

INTERVALS = 64
"""Parts of a path, in each of which one jump can be found."""

JUMP = 1e-3
"""Share of a value that counts as a jump, a tenth of what the check claims to find."""

ON_WAY = (
    *("longitudinal_creepage", "friction_coefficient", "rolling_speed", "max_pressure", "a", "b", "normal_force"),
    *("effective_modulus", "density"),
)
"""Numbers of a line contact, all above zero, that change along a path; messages give the first five."""

FACTOR = 0.8
"""Factor of a field that should matter."""

FORCES = ("tangential_force", "wear_index")
"""Totals of a contact that are searched for jumps."""

FIXED_POINT = 1e-9
"""Relative difference of two results of one problem, since a fixed point is found only to the tolerance of its search.

Searches that stop at a hundred roundings in friction lie far below it.
"""


@rule(Stage, always=True)
def pipelines_take_the_contact(stage: Stage) -> None:
    """The problem keeps geometry and shape, the contact its bounds and sums; and the contact does not gain energy."""
    for model, problem in of_stage(stage, POINTS):
        for batch in (problem, problem[0], problem[:1], problem[np.arange(POINTS).reshape(2, -1)]):
            flat = batch.flatten() if batch.batch_shape else batch
            Solver(model).solve(flat)
            integrate_forces(model, batch)


@rule(Stage)
def points_are_independent(stage: Stage) -> None:
    """One operating point at a time gives the same as all at once."""
    for model, problem in of_stage(stage, POINTS):
        together = integrate_forces(model, problem)
        for point in range(0, POINTS, 5):
            alone = integrate_forces(model, problem[point])
            part = forces_as(together, operator.itemgetter(point))
            assert_same_forces(problem[point], part, alone, "of a point in a batch", FIXED_POINT)


@rule(Stage)
def opposite_creepages_have_opposite_forces(stage: Stage) -> None:
    """If all creepages change sign, so do the forces."""
    for model, problem in of_stage(stage, POINTS):
        forces, turned = (integrate_forces(model, case) for case in (problem, creeping(problem, -1.0)))
        assert_same_forces(
            problem, forces_as(turned, np.negative), forces, "of the opposite creepages, turned", FIXED_POINT
        )


@rule(Stage, always=True)
def contact_is_finite(stage: Stage) -> None:
    """Every field and total of the contact is a finite number, also at rest and in full slip."""
    for model, problem in of_stage(stage, POINTS):
        for factor in (0.0, 1e-6, 1.0, 100.0):
            held = _held(creeping(problem, factor))
            check_finite(model, model.solve(held), held)


def _held(problem: Problem) -> Problem:
    """Return the problem with creepages of magnitude 1 at the most."""
    return problem.replaced(
        longitudinal_creepage=np.clip(problem.longitudinal_creepage, -1.0, 1.0),
        lateral_creepage=np.clip(problem.lateral_creepage, -1.0, 1.0),
    )


class _Watched(Stage):
    """A stage whose problems for the contact model, and whose contact, are kept."""

    name: ClassVar[str] = "watched"
    source: ClassVar[str] = "the kit"
    stage: SkipValidation[Any]
    """The stage."""
    kept: SkipValidation[list[Any]]
    """What the stage gives to the contact model, and returns."""

    def solve(self, problem: Problem, inner: Solve) -> Contact:
        def noted(changed: Problem) -> Contact:
            self.kept.append(changed)
            return inner(changed)

        contact: Contact = self.stage.solve(problem, noted)
        self.kept.append(contact)
        return contact


def _kept(stage: Stage, shape: Shape, problem: Problem) -> list[Any]:
    """Return the problems that a stage gives to the contact model, one after the other, and the contact."""
    kept: list[Any] = []
    staged(loader.contact_model(INSIDE[shape.geometry]), (_Watched(stage=stage, kept=kept),)).solve(problem)
    return kept


@rule(Stage)
def stages_keep_what_is_not_theirs(stage: Stage) -> None:
    """The contact has the density, the speed and the problem of the conditions, and that their bodies and angles.

    So have the problems that a stage gives to the contact model.
    """
    for shape in kept_shapes():
        problem = with_bodies(shape.draw(POINTS))
        *changed, contact = _kept(stage, shape, problem)
        for name in ("density", "rolling_speed"):
            assert_close(getattr(contact, name), getattr(problem, name), f"{shape.where}the {name} of the contact")
        assert contact.problem is not None, f"{shape.where}the contact after the stage has no problem"
        for after in (*changed, contact.problem):
            assert [*after.bodies.items()] == [*problem.bodies.items()] or _same_bodies(after, problem), (
                f"{shape.where}the problem after the stage has other bodies, or in another order"
            )
            names = ("density", "rolling_speed", "contact_angle")
            kept = {name: (getattr(after, name), getattr(problem, name)) for name in names}
            kept |= {name: (after.conditions.get(name), due) for name, due in problem.conditions.items()}
            for name, (value, due) in kept.items():
                assert value is not None, f"{shape.where}the problem after the stage lacks the {name}"
                assert_close(value, due, f"{shape.where}the {name} of the problem after the stage")


def _same_bodies(after: Problem, before: Problem) -> bool:
    pairs = zip(after.bodies.items(), before.bodies.items(), strict=False)
    return len(after.bodies) == len(before.bodies) and all(
        name == other and body.material == due.material and np.array_equal(body.rolling_radius, due.rolling_radius)
        for (name, body), (other, due) in pairs
    )


@rule(Stage)
def stages_act_on_each_shape(stage: Stage) -> None:
    """A stage changes the contact on lines and ellipses alike; strips have a given pressure."""
    acts = []
    for shape in (LINE, ELLIPSE):
        problem = shape.draw(POINTS)
        before = loader.contact_model(INSIDE[shape.geometry]).solve(problem)
        after = _kept(stage, shape, problem)[-1]
        names = (*TOTALS, "pressure", "slip")
        acts.append(any(not np.array_equal(getattr(before, name), getattr(after, name)) for name in names))
    on_line, on_ellipse = acts
    assert on_ellipse or not on_line, "on an ellipse the stage changes nothing, but on a line it does"
    assert on_line or not on_ellipse, "on a line the stage changes nothing, but on an ellipse it does"


@rule(Stage)
def each_field_of_a_stage_matters(stage: Stage) -> None:
    """Another value of each field with a unit changes the contact on a line or an ellipse."""
    problems = [(shape, shape.draw(POINTS)) for shape in (LINE, ELLIPSE)]
    for name, value in other_fields(stage, FACTOR):
        changed = stage.model_copy(update={name: value})
        pairs = [[_kept(variant, shape, problem)[-1] for variant in (stage, changed)] for shape, problem in problems]
        same = all(
            np.array_equal(getattr(before, part), getattr(after, part)) for before, after in pairs for part in TOTALS
        )
        assert not same, f"the contact is the same with another {name}; does the stage read the field?"


@rule(Stage, "continuity")
def stages_do_not_jump(stage: Stage) -> None:
    """From any line contact to any other, the problem after the stage and its forces have no jump by 1/100."""
    first, second = (with_bodies(random_lines(PATHS, seed)) for seed in (1, 2))
    slight, large = (10.0 ** np.random.default_rng(3).uniform(low, low + 2.0, PATHS) for low in (-5.0, -2.0))
    first, second = (first.replaced(longitudinal_creepage=slight), second.replaced(longitudinal_creepage=large))

    def between(index: Indices, share: Array) -> Problem:
        """Return problems on the way, straight in the logarithm of every value; so they are Hertzian."""
        start, end = first[index], second[index]
        ways = {name: getattr(start, name) * (getattr(end, name) / getattr(start, name)) ** share for name in ON_WAY}
        return start.replaced(**ways)

    def solved(index: Indices, share: Array) -> dict[str, Array]:
        *_, inside, contact = _kept(stage, LINE, between(index, share))
        return {name: getattr(inside if name in ON_WAY else contact, name) for name in (*ON_WAY, *FORCES)}

    function = each_once(solved)
    for name in (*ON_WAY, *FORCES):
        for path, share, before, behind in find_jumps(function(name), PATHS, INTERVALS, JUMP):
            at = between(np.array([path]), np.array([share]))
            where = ", ".join(f"{key} {float(getattr(at, key)[0]):.4g}" for key in ON_WAY[:5])
            jump = f"jumps from {before:.6g} to {behind:.6g}"
            raise AssertionError(f"the {name} after the stage {jump}, at {where} in SI units")


@rule(Stage)
def contact_is_in_double_precision(stage: Stage) -> None:
    """The forces are exact to the search of a fixed point, in steps of 1e-8 of creepage, friction and half-length.

    No array of the contact holds nothing but numbers of single precision.
    """
    for model, problem in of_stage(stage, POINTS):
        assert_digits(model, problem, FIXED_POINT)
    for shape in kept_shapes():
        *changed, contact = _kept(stage, shape, with_bodies(shape.draw(POINTS)))
        for values in (contact, *changed):
            for name in (*FIELDS, *TOTALS) if values is contact else ON_WAY:
                array = getattr(values, name)
                # Of 24 random numbers in double precision, none is one of single precision but by a chance of 2^-29.
                coarse = array[array != 0.0]
                single = coarse.size >= POINTS and np.array_equal(coarse, coarse.astype(np.float32))
                assert not single, f"{shape.where}the {name} after the stage is in single precision"
