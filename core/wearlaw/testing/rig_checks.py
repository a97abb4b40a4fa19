"""Checks of a rig: the problems that it makes from the conditions of its example, and from others near them.

A problem follows from its conditions by a short formula. So two ways to the same problem differ by `SAME` at most.
"""

from __future__ import annotations

import copy
import dataclasses
import re
from typing import Any, TypeAlias

import numpy as np
import pint

from wearlaw.arrays.array import Array
from wearlaw.contact.material import Material
from wearlaw.contact.problem import Body, Geometry
from wearlaw.errors import ConditionsError, InputError, UnitError, WearlawError, described
from wearlaw.pipeline.pipeline import Rig
from wearlaw.testing.examples import assert_close
from wearlaw.units.quantities import Q, Quantity, parse, scalar_si

Conditions: TypeAlias = dict[str, Any]

FACTORS = np.array([1.0, 0.9375, 0.875])
"""Factors that vary the conditions of the example, close enough to one that the rig still takes them."""

POSITIVE = ("normal_force", "max_pressure", "patch_area", "friction_coefficient", "rolling_speed", "density")
"""Attributes of a problem that must be greater than zero."""

LOAD_OVER_PRESSURE: dict[Geometry, float] = {"line": 0.25 * np.pi, "ellipse": 2.0 / 3.0}
"""Hertz's N/(p0 A): the mean of an elliptic pressure over its peak."""


OF_STRIPS = ("y", "width", "half_length", "max_pressure of strips")
"""Names of the numbers with an axis of strips."""


def example_of(rig: Rig) -> Conditions:
    """Return the conditions of a rig's example.

    Raises
    ------
    InputError
        If it has none.
    """
    if not rig.example:
        conditions = ", ".join(f'"{name}": ...' for name in rig.conditions())
        raise InputError(
            f"checks: rig '{rig.name}' has no conditions to try it with; write the conditions of one test into the"
            f' class {type(rig).__name__}, with units as text such as "1 %":\n  example = {{{conditions}}}'
        )
    return dict(rig.example)


def varied(rig: Rig) -> dict[str, Quantity | float]:
    """Return the conditions of the example that are numbers, with or without a unit; words and records are none."""
    found = {name: _number(value) for name, value in example_of(rig).items()}
    return {name: value for name, value in found.items() if value is not None}


def _number(value: object) -> Quantity | float | None:
    if isinstance(value, str):
        try:
            return parse(value)
        except UnitError:
            return None
    if isinstance(value, pint.Quantity) or (isinstance(value, int | float) and not isinstance(value, bool)):
        return value
    return None


def in_unit_of(value: Quantity | float, numbers: Array | float) -> Any:
    """Return numbers in the unit of a condition, or as they are where it has none."""
    return Q(numbers, str(value.units)) if isinstance(value, pint.Quantity) else numbers


def times(value: Quantity | float, factors: Array | float) -> Any:
    """Return a condition multiplied by factors, in its own unit."""
    return in_unit_of(value, getattr(value, "magnitude", value) * factors)


def values_of(problem: Any) -> dict[str, Any]:
    """Return the numbers that a problem holds, by name; zero for missing patches, and 1 or 0 for `exists`."""
    found = {field.name: getattr(problem, field.name) for field in dataclasses.fields(problem)}
    if problem.strips is not None:
        found |= {name: getattr(problem.strips, name.removesuffix(" of strips")) for name in OF_STRIPS}
    values = {name: value for name, value in found.items() if hasattr(value, "dtype") or isinstance(value, int | float)}
    exists: Any = values.pop("exists", None)
    if exists is None:
        return values
    there = {
        name: np.where(exists[..., None] if name in OF_STRIPS else exists, value, 0.0) for name, value in values.items()
    }
    return {**there, "exists": exists.astype(np.float64)}


def _problem(rig: Rig, **changed: Any) -> Any:
    """Return the problem of the example with some conditions changed."""
    return rig.checked_problem({**example_of(rig), **changed})


def _assert_same(found: Any, expected: dict[str, Array], what: str) -> None:
    for name, value in values_of(found).items():
        assert_close(value, expected[name], f"{what}: {name}")


def makes_several_patches(rig: Rig) -> bool:
    """Return whether the problem of the example has several patches; False if the rig fails."""
    try:
        return bool(_problem(rig).dims)
    except WearlawError:
        return False


def problem_is_finite_and_positive(rig: Rig) -> None:
    """The example gives a problem of finite numbers, with a load, a patch, friction and a density above zero."""
    problem = _problem(rig).existing()
    assert problem.size, "the bodies of the example touch nowhere"
    for name, value in values_of(problem).items():
        assert np.isfinite(value).all(), f"{name} of the problem is {value!r}, not finite"
    for name in POSITIVE:
        value = getattr(problem, name)
        assert (np.isfinite(value) & (np.asarray(value) > 0.0)).all(), (
            f"{name} of the problem is {value!r}, not above zero"
        )


def pressure_carries_the_load(rig: Rig) -> None:
    """Load, pressure and patch agree: N is π/4 p0 A on a line, 2/3 p0 A on an ellipse, and the sum of strips."""
    problem = _problem(rig).existing()
    if problem.strips is not None:
        carried = problem.strips.normal_force.sum(axis=-1)
    else:
        carried = LOAD_OVER_PRESSURE[problem.geometry] * problem.max_pressure * problem.patch_area
    assert_close(carried, problem.normal_force, "the force that the pressure carries over the patch [N]")


def problem_has_the_shape_of_the_conditions(rig: Rig) -> None:
    """Every number of the problem is a float64 array of the shape of the conditions: no axis, one, or two.

    The rig's own axes follow, as `dims` names them, and an axis of strips.
    """
    for shape in ((), (1,), (2, 3)):
        problem = _problem(rig, **{name: times(value, np.ones(shape)) for name, value in varied(rig).items()})
        for name, value in values_of(problem).items():
            kind = getattr(value, "dtype", type(value))
            assert kind == np.float64, f"{name} of the problem is of type {kind}, not float64"
            full = (*shape, *map(len, problem.dims.values()))
            found = value.shape[:-1] if name in OF_STRIPS else value.shape
            assert found == full, f"{name} has shape {value.shape} for conditions of shape {shape}"


def arrays_equal_single_calls(rig: Rig) -> None:
    """An array for one condition gives the same as a call for each of its values."""
    for name, value in varied(rig).items():
        singles = [values_of(_problem(rig, **{name: times(value, factor)})) for factor in FACTORS]
        expected = {field: np.stack([np.asarray(single[field]) for single in singles]) for field in singles[0]}
        _assert_same(_problem(rig, **{name: times(value, FACTORS)}), expected, f"an array of {name}")


def conditions_broadcast(rig: Rig) -> None:
    """Conditions on different axes give the grid of their values."""
    values = varied(rig)
    first, *rest = values
    down, along = FACTORS[:2, None], FACTORS

    def changed(one: Array | float, others: Array | float) -> Conditions:
        return {name: times(values[name], one if name == first else others) for name in (first, *rest)}

    singles = [[values_of(_problem(rig, **changed(i, j))) for j in along] for i in down[:, 0]]
    expected = {field: np.array([[single[field] for single in row] for row in singles]) for field in singles[0][0]}
    expected = expected if rest else {field: value[:, :1] for field, value in expected.items()}
    _assert_same(_problem(rig, **changed(down, along)), expected, f"{first} on an axis of its own")


def conditions_are_declared(rig: Rig) -> None:
    """`conditions()` has the names in the example and the one in `creepage`, and the example is one test."""
    declared = rig.conditions()
    for name in (*rig.example, rig.creepage):
        assert name in declared, f"`conditions()` does not name '{name}', only {', '.join(declared) or 'none'}"
    assert rig.creepage in varied(rig), f"the example gives no '{rig.creepage}', which `creepage` names"
    for name, value in varied(rig).items():
        assert np.ndim(value) == 0, f"the example has an array of {name}; give one value"


def zero_creepage_is_taken(rig: Rig) -> None:
    """Without creepage the problem has none, and all else stays finite."""
    problem = _problem(rig, **{rig.creepage: times(varied(rig)[rig.creepage], 0.0)}).existing()
    found = problem.longitudinal_creepage
    assert (found == 0.0).all(), f"the problem has the creepage {found!r} where {rig.creepage} is zero"
    for name, value in values_of(problem).items():
        assert np.isfinite(value).all(), f"{name} of the problem is {value!r} where {rig.creepage} is zero"


def creepage_is_proportional_to_its_condition(rig: Rig) -> None:
    """Half of the condition that `creepage` names is half of the problem's creepage."""
    whole, half = (
        _problem(rig, **{rig.creepage: times(varied(rig)[rig.creepage], share)}).existing() for share in (1.0, 0.5)
    )
    assert (whole.longitudinal_creepage != 0.0).all(), f"the example has no creepage; give another {rig.creepage}"
    assert_close(
        half.longitudinal_creepage, 0.5 * whole.longitudinal_creepage, f"the creepage of half the {rig.creepage}"
    )


def only_creepage_turns_with_its_sign(rig: Rig) -> None:
    """The creepage changes its sign with its condition, and nothing else changes.

    A rolling speed may, where it is the mean of a speed that is kept and one that makes the creepage.
    """
    problem, turned = (_problem(rig, **{rig.creepage: times(varied(rig)[rig.creepage], sign)}) for sign in (1.0, -1.0))
    expected = values_of(problem)
    expected["longitudinal_creepage"] = -expected["longitudinal_creepage"]
    expected["rolling_speed"] = values_of(turned)["rolling_speed"]
    _assert_same(turned, expected, f"{rig.creepage} of the other sign")


def units_of_conditions_are_checked(rig: Rig) -> None:
    """A bare number, or a quantity of another dimension, is refused by a `UnitError` that names the condition."""
    for name, value in varied(rig).items():
        if isinstance(value, pint.Quantity):
            _assert_refused(
                rig, {name: value.magnitude}, UnitError, name, f"the bare number {name}={value.magnitude!r}"
            )
            other = Q(value.magnitude, "candela")  # of which no condition of a rig is
            _assert_refused(rig, {name: other}, UnitError, name, f"{name}={other!r}")


def unknown_conditions_are_refused(rig: Rig) -> None:
    """A condition that the rig does not take is refused by a `ConditionsError` that names it."""
    _assert_refused(rig, {"no_such_condition": 1.0}, ConditionsError, "no_such_condition", "an unknown condition")


def missing_conditions_are_named(rig: Rig) -> None:
    """A condition of the example that is left out is optional, or a `ConditionsError` names it."""
    for name in example_of(rig):
        rest = {other: value for other, value in example_of(rig).items() if other != name}
        try:
            rig.checked_problem(rest)
        except WearlawError as error:
            _assert_names(error, ConditionsError, name, f"the example without {name}")


def values_that_are_no_numbers_are_refused(rig: Rig) -> None:
    """NaN in a condition is refused by an error that names it; infinity is refused, or gives a finite problem."""
    for name, value in varied(rig).items():
        number = getattr(value, "magnitude", value)
        nan, infinite = (in_unit_of(value, np.array([number, bad])) for bad in (np.nan, np.inf))
        _assert_refused(rig, {name: nan}, InputError, name, f"NaN in {name}")
        try:
            problem = _problem(rig, **{name: infinite})
        except InputError:
            continue
        for field, found in values_of(problem).items():
            assert np.isfinite(found).all(), f"infinity in {name} is taken, and makes {field} of the problem {found!r}"


def _assert_refused(rig: Rig, changed: Conditions, kind: type[WearlawError], name: str, what: str) -> None:
    try:
        _problem(rig, **changed)
    except WearlawError as error:
        _assert_names(error, kind, name, what)
    else:
        raise AssertionError(f"{what} is taken; raise wearlaw.{kind.__name__} with a message that names '{name}'")


def _assert_names(error: WearlawError, kind: type[WearlawError], name: str, what: str) -> None:
    named = isinstance(error, kind) and re.search(rf"\b{name}\b", str(error))
    wanted = f"raise wearlaw.{kind.__name__} with a message that names '{name}'"
    assert named, f"{what} raises {described(error)}; {wanted}"


def conditions_are_not_changed(rig: Rig) -> None:
    """The arrays that `problem` is given stay as they are."""
    given = {name: times(value, FACTORS) for name, value in varied(rig).items()}
    before = copy.deepcopy(given)
    _problem(rig, **given)
    for name, value in given.items():
        units = [getattr(one, "units", None) for one in (value, before[name])]
        numbers = [getattr(one, "magnitude", one) for one in (value, before[name])]
        same = units[0] == units[1] and np.array_equal(*numbers)
        assert same, f"the rig changed the condition {name} from {before[name]!r} to {value!r}"


def problems_agree_to_the_bit(rig: Rig) -> None:
    """The same conditions give the same problem, before and after others."""
    first = _problem(rig)
    kept = copy.deepcopy(values_of(first))
    _problem(rig, **{name: times(value, FACTORS[-1]) for name, value in varied(rig).items()})
    for problem in (first, _problem(rig)):
        for name, value in values_of(problem).items():
            assert np.array_equal(value, kept[name]), f"two problems of the same conditions differ in {name}"


def geometry_is_that_of_the_problem(rig: Rig) -> None:
    """`patch_geometry` is the shape of the patch of the problem, or None."""
    made = _problem(rig).geometry
    assert rig.patch_geometry in (None, made), (
        f"`patch_geometry` is '{rig.patch_geometry}', but the patch of the problem is '{made}'"
    )


def bodies_are_named(rig: Rig) -> None:
    """Each of `bodies` has an identifier as its name, a material, and a rolling radius above zero or infinite."""
    for name, body in rig.bodies.items():
        assert name.isidentifier(), f"the name of a body must be an identifier, got {name!r}"
        assert isinstance(body, Body), f"`bodies` has {body!r} for {name}, not a wearlaw.Body"
        assert isinstance(body.material, Material), f"the material of {name} is {body.material!r}"
        radius = body.rolling_radius
        assert np.all(np.asarray(radius) > 0.0), f"the rolling radius of {name} is {radius!r} m, not above zero"


def density_is_that_of_the_first_body(rig: Rig) -> None:
    """The problem has the density of the first of `bodies`, whose wear is predicted."""
    for name, body in [*rig.bodies.items()][:1]:
        expected = np.asarray(scalar_si(body.material.density, "kg/m^3"))
        assert_close(
            _problem(rig).existing().density, expected, f"the density of the problem, with {name} as the first body"
        )


CHECKS = (
    problem_is_finite_and_positive,
    pressure_carries_the_load,
    problem_has_the_shape_of_the_conditions,
    arrays_equal_single_calls,
    conditions_broadcast,
    conditions_are_declared,
    units_of_conditions_are_checked,
    unknown_conditions_are_refused,
    missing_conditions_are_named,
    values_that_are_no_numbers_are_refused,
    conditions_are_not_changed,
    problems_agree_to_the_bit,
    geometry_is_that_of_the_problem,
    bodies_are_named,
    density_is_that_of_the_first_body,
)
OF_CREEPAGE = (zero_creepage_is_taken, creepage_is_proportional_to_its_condition, only_creepage_turns_with_its_sign)
