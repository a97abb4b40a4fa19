"""Checks of what the problem of a rig takes from its bodies, its fields and its conditions."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import filterfalse
from typing import Any

import numpy as np
import pint
import scipy

from wearlaw.arrays import Array
from wearlaw.configuration import Configuration
from wearlaw.contact import hertz
from wearlaw.contact.material import Material
from wearlaw.errors import WearlawError
from wearlaw.pipeline.pipeline import Rig
from wearlaw_kit.examples import assert_close, left_out, part
from wearlaw_kit.rig import (
    fields_of,
    in_unit_of,
    of_other_materials,
    other_material,
    posed,
    problem_of,
    times,
    values_of,
    varied,
)
from wearlaw_kit.rules import rule

SAME_PATCH = 1e-9
"""Relative difference of a patch that an iteration finds."""

SHORTER = 0.97
"""Factor of a field; small, since rigs refuse fields that do not fit each other."""

OTHERS = (1.001, SHORTER, 0.9, 1.1)
"""Factors of a condition or a field of which one at least must change the problem."""

FAR = (0.2, 5.0)
"""Further factors of a condition, which may count beyond a threshold alone."""

NAMESAKES = (
    *("normal_force", "normal_force_per_width", "max_pressure", "friction_coefficient", "traction_coefficient"),
    *("creepage", "longitudinal_creepage", "lateral_creepage", "spin", "rolling_speed"),
    *("contact_angle", "track_width"),
)
"""Conditions and fields that a problem has under the same name."""

SIZES = {"a": (1e-7, 0.1), "b": (1e-7, 0.5), "max_pressure": (1e5, 5e10), "rolling_speed": (1e-5, 300.0)}
"""The least and the largest numbers [SI] that the problem of a test has: tenths of those in any test, and tenfold."""


def _has_two_bodies(rig: Rig) -> bool:
    return len((posed(rig) or rig).bodies) == 2


def other_fields(record: Any, factor: float) -> Iterator[tuple[str, Any]]:
    """Yield fields that hold quantities or materials, each with another value; those of a record together."""
    for name, value in fields_of(record).items():
        if isinstance(value, pint.Quantity) and np.isfinite(value.magnitude) and value.magnitude != 0.0:
            yield name, value * factor
        elif isinstance(value, Material):
            yield name, other_material(value, 1.0 / factor)
        elif isinstance(value, Configuration) and (inner := dict(other_fields(value, factor))):
            yield name, value.model_copy(update=inner)


def _problems(rig: Rig) -> Iterator[tuple[Any, str]]:
    """Yield the problems of the rig, of other materials and of one field after the other, those that there are."""
    yield problem_of(rig).existing(), ""
    changes = [(name, {name: value}) for name, value in other_fields(rig, SHORTER)]
    for name, change in [("materials", fields_of(of_other_materials(rig))), *changes]:
        try:
            problem = problem_of(rig.model_copy(update=change)).existing()
        except WearlawError:
            continue
        if problem.size:
            yield problem, f" with other {name}"


@rule(Rig, applies=_has_two_bodies)
def stiffness_is_that_of_the_bodies(rig: Rig) -> None:
    """1/E* of the problem is the sum of (1-ν²)/E of its bodies, and on an ellipse ν/G is the mean of theirs."""
    for problem, which in _problems(rig):
        constants = [
            constant
            for body in problem.bodies.values()
            for constant in (body.youngs_modulus, body.material.poisson_ratio)
        ]
        due = {"effective_modulus": hertz.effective_modulus(*constants)}
        if problem.geometry != "line":
            due["poisson_ratio"] = hertz.mean_poisson_ratio(*constants)
        for name, value in due.items():
            message = f"the {name} of the rig{which}, against its bodies"
            assert_close(getattr(problem, name), np.asarray(value), message, SAME_PATCH)


@rule(Rig, applies=_has_two_bodies)
def curvature_is_that_of_the_bodies(rig: Rig) -> None:
    """The patch is Hertz's for the curvature of the bodies along the rolling direction, 1/R1 + 1/R2 times cos δ.

    A flat body has an infinite rolling radius. A body whose surface has another radius along the rolling direction,
    such as a disc that turns about the normal of its flat side, states it as `surface_radius`. Strips are not checked,
    nor rigs with several patches, whose bodies may be turned against each other.
    """
    if problem_of(rig).dims:
        return
    for problem, which in _problems(rig):
        if problem.strips is not None:
            return
        radii = [
            body.rolling_radius if body.surface_radius is None else body.surface_radius
            for body in problem.bodies.values()
        ]
        due: Array = np.sum([1.0 / np.asarray(radius) for radius in np.broadcast_arrays(*radii)], axis=0)
        if problem.contact_angle is not None:
            due = due * np.cos(problem.contact_angle)
        if problem.geometry == "line":
            curvature = 1.0 / problem.relative_radius
        else:  # 2 A of the gap A x² + B y²
            shape = scipy.special.elliprd(0.0, problem.b**2, problem.a**2)
            curvature = problem.normal_force / (np.pi * problem.effective_modulus) * shape
        message = f"the curvature of the rig{which} that the patch has, against the radii of its bodies [1/m]"
        assert_close(curvature, due, message, SAME_PATCH)


def _matters(rig: Rig, changes: Iterable[tuple[dict[str, Any], dict[str, Any]]]) -> bool:
    """Return whether other fields or conditions change the problem, or the rig refuses them."""
    before = values_of(problem_of(rig))
    for fields, conditions in changes:
        try:
            after = values_of(problem_of(rig.model_copy(update=fields) if fields else rig, **conditions))
        except WearlawError:
            return True
        if any(name not in after or not np.array_equal(after[name], value) for name, value in before.items()):
            return True
    return False


@rule(Rig)
def each_condition_matters(rig: Rig) -> None:
    """Another value of each condition in the example changes the problem."""
    for name, value in varied(rig).items():
        if left_out(name):
            continue
        zero = getattr(value, "magnitude", value) == 0.0
        others = [in_unit_of(value, 1e-3)] if zero else [times(value, factor) for factor in OTHERS + FAR]
        matters = _matters(rig, [({}, {name: other}) for other in others])
        assert matters, f"the problem is the same with another {name}; does the rig read it?"


@rule(Rig)
def each_field_matters(rig: Rig) -> None:
    """Another value of each field with a unit or a material changes the problem.

    A field with a default may belong to a condition that the example leaves out, and then is not tried.
    """
    variants = [dict(other_fields(rig, factor)) for factor in OTHERS]
    all_given = set(rig.conditions()) <= set(rig.example)
    tried = [name for name in variants[0] if all_given or type(rig).model_fields[name].is_required()]
    for name in filterfalse(left_out, tried):
        matters = _matters(rig, [({name: fields[name]}, {}) for fields in variants])
        assert matters, f"the problem is the same with another {name}; does the rig read the field?"


@rule(Rig)
def namesakes_are_the_same(rig: Rig) -> None:
    """A condition or a field has the value that the problem has under its name, such as `normal_force`.

    So has the creepage, if a ratio without a unit sets it. A creepage ξ and a rolling speed may refer to the speed of
    one body in place of the mean of both, by which they differ by the share ξ at most.
    """
    problem = problem_of(rig)
    if problem.dims:
        return
    creepage = np.abs(problem.longitudinal_creepage)
    inputs: dict[str, Any] = {
        **{name: value for name, value in fields_of(rig).items() if name in NAMESAKES},
        **varied(rig),
    }
    for name, value in inputs.items():
        if left_out(name):
            continue
        of_problem = name
        if name == rig.creepage and not (isinstance(value, pint.Quantity) and not value.dimensionless):
            of_problem = "longitudinal_creepage"
        if of_problem not in NAMESAKES or (of_problem == "normal_force_per_width" and problem.geometry != "line"):
            continue
        due = value.to_base_units().magnitude if isinstance(value, pint.Quantity) else value
        share = creepage if of_problem in ("longitudinal_creepage", "creepage", "rolling_speed") else 0.0
        actual = getattr(problem, of_problem)
        if of_problem == "contact_angle" and due == 0.0:
            continue  # a level surface has none
        assert actual is not None, f"the problem has no {of_problem}, which the rig is given"
        with part(name):
            assert_close(
                actual, np.asarray(due), f"the {of_problem} of the problem, against {name}", share + SAME_PATCH
            )


@rule(Rig)
def speed_is_among_those_of_the_rig(rig: Rig) -> None:
    """The rolling speed lies within the speeds that the rig is given, or those of its bodies at rates of rotation.

    It may lie outside by the share of the creepage.
    """
    problem = problem_of(rig).existing()
    radii = [np.asarray(body.rolling_radius) for body in problem.bodies.values()]
    inputs = [value for value in (*fields_of(rig).values(), *varied(rig).values()) if isinstance(value, pint.Quantity)]
    speeds = [abs(value.to_base_units().magnitude) for value in inputs if value.check("[speed]")]
    rates = [abs(value.to_base_units().magnitude) for value in inputs if value.check("1/[time]")]
    if rates and len(radii) == 2 and all(np.isfinite(radius).all() for radius in radii):
        speeds += [rate * radius for rate in rates for radius in radii]
    elif rates:
        return
    if speeds:
        slack = 1.0 + np.abs(problem.longitudinal_creepage) + SAME_PATCH
        low, high = np.min(np.concatenate([np.ravel(s) for s in speeds])), max(np.max(s) for s in speeds)
        fits = (problem.rolling_speed >= low / slack) & (problem.rolling_speed <= high * slack)
        assert fits.all(), (
            f"the rolling speed is {problem.rolling_speed.flat[0]:.4g} m/s, not from {low:.4g} to {high:.4g} m/s as the"
            " speeds of the rig"
        )


@rule(Rig)
def example_has_sizes_of_a_test(rig: Rig) -> None:
    """The example gives a patch, a pressure and a speed that a test can have; mm are not taken for m."""
    problem = problem_of(rig).existing()
    for name, (low, high) in SIZES.items():
        values = getattr(problem, name)
        least, most = np.min(values), np.max(values)
        assert low <= least and most <= high, f"the {name} of the example is {least:.3g} to {most:.3g} in SI units"  # noqa: PT018


class _Falling:
    """Friction that falls by half over the speeds of a problem."""

    def __init__(self, speed: float) -> None:
        self.speed = speed

    def coefficient(self, creep_speed: Array) -> Array:
        """Return the coefficient at creep speeds [m/s]."""
        return 0.4 / (1.0 + creep_speed / self.speed)


@rule(Rig, applies=lambda rig: any(condition.law for condition in rig.conditions().values()))
def friction_laws_are_taken(rig: Rig) -> None:
    """Where `wl.Friction` is declared, a law gives the friction coefficient at the creep speed, V √(ξ² + η²)."""
    problem = problem_of(rig).existing()
    law = _Falling(float(np.max(_creep_speed(problem))) or 1.0)
    for name, condition in rig.conditions().items():
        if condition.law and name in rig.example and not left_out(name):
            solved = problem_of(rig, **{name: law}).existing()
            message = f"the friction coefficient by a law as {name}"
            assert_close(solved.friction_coefficient, law.coefficient(_creep_speed(solved)), message)


def _creep_speed(problem: Any) -> Array:
    """Return V √(ξ² + η²) [m/s]."""
    speed: Array = problem.rolling_speed * np.hypot(problem.longitudinal_creepage, problem.lateral_creepage)
    return speed
