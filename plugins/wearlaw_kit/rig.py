"""Checks of a rig: the problems that it makes from the conditions of its example, and from others near them.

A problem follows from its conditions by a short formula. So two ways to the same problem differ by `SAME` at most.
"""

from __future__ import annotations

import dataclasses
import re
from typing import Any, TypeAlias

import numpy as np
import pint

from wearlaw.arrays import Array
from wearlaw.configuration import Configuration
from wearlaw.contact.material import Material
from wearlaw.contact.parts import Strips
from wearlaw.contact.problem import Geometry
from wearlaw.errors import ConditionsError, InputError, UnitError, WearlawError, described
from wearlaw.pipeline.pipeline import Rig
from wearlaw.units.quantities import Q, Quantity, parse, scalar_si
from wearlaw_kit.bisection import lost_digits
from wearlaw_kit.examples import assert_close
from wearlaw_kit.rules import rule

Conditions: TypeAlias = dict[str, Any]

FACTORS = np.array([1.0, 0.9375, 0.875])
"""Factors that vary the conditions of the example, close enough to one that the rig still takes them."""

LOAD_OVER_PRESSURE: dict[Geometry, float] = {"line": 0.25 * np.pi, "ellipse": 2.0 / 3.0}
"""Hertz's N/(p0 A): the mean of an elliptic pressure over its peak."""

OF_STRIPS = tuple(f"{name} of strips" for name in Strips.__slots__)
"""Names of the numbers with an axis of strips."""

PRECISE = (
    *("normal_force", "max_pressure", "a", "b", "friction_coefficient", "rolling_speed"),
    *("longitudinal_creepage", "lateral_creepage", "spin"),
)
"""Numbers of a problem; what else a rig may add to them, such as what is left of a balance, may be rounding alone."""

ROUNDING = 1e-10
"""Error of a problem that an iteration finds; it moves a step of 1e-8 by a fiftieth, single precision by six of it."""


def varied(rig: Rig) -> dict[str, Quantity | float]:
    """Return the conditions of the example that are numbers, with or without a unit; words and records are none."""
    numbers = {name: _number(value) for name, value in rig.example.items()}
    return {name: value for name, value in numbers.items() if value is not None}


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
    fields = {field.name: getattr(problem, field.name) for field in dataclasses.fields(problem)} | problem.conditions
    if problem.strips is not None:
        fields |= {name: getattr(problem.strips, name.removesuffix(" of strips")) for name in OF_STRIPS}
    values = {
        name: value
        for name, value in fields.items()
        if (hasattr(value, "dtype") and value.dtype.kind != "O") or isinstance(value, int | float)
    }
    exists: Any = values.pop("exists", None)
    if exists is None:
        return values
    there = {
        name: np.where(exists[..., None] if name in OF_STRIPS else exists, value, 0.0) for name, value in values.items()
    }
    return {**there, "exists": exists.astype(np.float64)}


def problem_of(rig: Rig, **changed: Any) -> Any:
    """Return the problem of the example with some conditions changed."""
    return rig.checked_problem({**rig.example, **changed})


def _assert_same(problem: Any, expected: dict[str, Array], what: str) -> None:
    for name, value in values_of(problem).items():
        assert_close(value, expected[name], f"{what}: {name}")


def posed(rig: Rig) -> Any:
    """Return the problem of the example; None if there is none, as a check of its own says."""
    try:
        return problem_of(rig)
    except WearlawError:
        return None


def _has_one_creepage(rig: Rig) -> bool:
    """Return whether one condition gives the creepage; several patches have creepages of their own."""
    return rig.creepage in varied(rig) and not getattr(posed(rig), "dims", {})


@rule(Rig, always=True)
def problem_is_finite_and_positive(rig: Rig) -> None:
    """The example gives a problem of finite numbers, with a load, a patch, friction and a density above zero."""
    assert problem_of(rig).existing().size, (
        "the bodies of the example touch nowhere"
    )  # `checked_problem` tries the rest


@rule(Rig)
def pressure_carries_the_load(rig: Rig) -> None:
    """Load, pressure and patch agree: N is π/4 p0 A on a line, 2/3 p0 A on an ellipse, and the sum of strips.

    No strip has a negative pressure.
    """
    problem = problem_of(rig).existing()
    if problem.strips is not None:
        lowest = problem.strips.max_pressure.min()
        assert lowest >= 0.0, f"a strip has a maximum pressure of {lowest:.3g} Pa"
        carried = problem.strips.normal_force.sum(axis=-1)
    else:
        carried = LOAD_OVER_PRESSURE[problem.geometry] * problem.max_pressure * problem.patch_area
    assert_close(carried, problem.normal_force, "the force that the pressure carries over the patch [N]")


def _has_creepages_of_strips(rig: Rig) -> bool:
    """Return whether the strips of the example have creepages of their own."""
    strips = getattr(posed(rig), "strips", None)
    return strips is not None and strips.has_creepages


@rule(Rig, applies=_has_creepages_of_strips)
def creepages_of_strips_have_the_mean_of_the_patch(rig: Rig) -> None:
    """The creepages and the spin of a patch are the means of those of its strips, weighted with the normal force."""
    problem = problem_of(rig).existing()
    force = problem.strips.normal_force
    names = "longitudinal_creepage", "lateral_creepage", "spin"
    for name, of_strips in zip(names, problem.creepages_of_strips, strict=True):
        mean = (force * of_strips).sum(axis=-1) / force.sum(axis=-1)
        allowed = ROUNDING * np.abs(of_strips).max(axis=-1)
        assert_close(getattr(problem, name), mean, f"the {name} of the patch, over that of its strips", 0.0, allowed)


@rule(Rig, always=True)
def problem_has_the_shape_of_the_conditions(rig: Rig) -> None:
    """Every number of the problem is a float64 array of the shape of the conditions: no axis, one, or two.

    The rig's own axes follow, as `dims` names them, and an axis of strips.
    """
    for shape in ((), (1,), (2, 3)):
        problem = problem_of(rig, **{name: times(value, np.ones(shape)) for name, value in varied(rig).items()})
        for name, value in values_of(problem).items():
            kind = getattr(value, "dtype", type(value))
            assert kind == np.float64, f"{name} of the problem is of type {kind}, not float64"
            full = (*shape, *map(len, problem.dims.values()))
            actual = value.shape[:-1] if name in OF_STRIPS else value.shape
            assert actual == full, f"{name} has shape {value.shape} for conditions of shape {shape}"


@rule(Rig)
def arrays_equal_single_calls(rig: Rig) -> None:
    """Arrays give the same as a call for each of their values, and broadcast if they lie on different axes."""
    values = varied(rig)
    for name, value in values.items():
        singles = [values_of(problem_of(rig, **{name: times(value, factor)})) for factor in FACTORS]
        expected = {field: _stacked([single[field] for single in singles]) for field in singles[0]}
        _assert_same(problem_of(rig, **{name: times(value, FACTORS)}), expected, f"an array of {name}")
    first, *rest = values

    def changed(leading: Array | float, others: Array | float) -> Conditions:
        return {name: times(values[name], leading if name == first else others) for name in (first, *rest)}

    rows = [[values_of(problem_of(rig, **changed(i, j))) for j in FACTORS] for i in FACTORS[:2]]
    each = {field: _stacked([single[field] for row in rows for single in row]) for field in rows[0][0]}
    expected = {field: array.reshape(len(rows), len(rows[0]), *array.shape[1:]) for field, array in each.items()}
    expected = expected if rest else {field: value[:, :1] for field, value in expected.items()}
    _assert_same(problem_of(rig, **changed(FACTORS[:2, None], FACTORS)), expected, f"{first} on an axis of its own")


def _stacked(arrays: list[Any]) -> Array:
    """Return arrays as one; those of fewer strips are filled up, as in a batch."""
    arrays = [np.asarray(array) for array in arrays]
    most = max(array.shape[-1] if array.ndim else 0 for array in arrays)

    def filled(array: Array) -> Array:
        more = most - array.shape[-1] if array.ndim else 0
        return np.concatenate([array, 0.0 * array[..., -1:].repeat(more, axis=-1)], axis=-1) if more else array

    return np.stack([filled(array) for array in arrays])


@rule(Rig)
def conditions_are_declared(rig: Rig) -> None:
    """`conditions()` has the names in the example and the one in `creepage`, and the example is one test."""
    declared, creepage = rig.conditions(), () if rig.creepage is None else (rig.creepage,)
    for name in (*rig.example, *creepage):
        assert declared, (
            f"no condition is declared; annotate `**conditions` of `problem` with Unpack[...] of a TypedDict that has"
            f" '{name}'"
        )
        assert name in declared, f"`conditions()` does not name '{name}', only {', '.join(declared)}"
    for name in creepage:
        assert name in varied(rig), f"the example gives no '{name}', which `creepage` names"
    for name, value in varied(rig).items():
        assert np.ndim(value) == 0, f"the example has an array of {name}; give one value"


@rule(Rig, always=True)
def units_of_conditions_are_checked(rig: Rig) -> None:
    """A bare number, or a quantity of another dimension, is refused by a `UnitError` that names the condition.

    Each condition of the example with a unit is tried, and each one that the rig declares with a unit.
    """
    declared = {
        name: Q(1.0, condition.unit.unit) for name, condition in rig.conditions().items() if condition.unit is not None
    }
    for name, value in {**declared, **varied(rig)}.items():
        if isinstance(value, pint.Quantity):
            number, other = value.magnitude, Q(value.magnitude, "candela")  # of which no condition of a rig is
            for wrong, what in ((number, f"the bare number {name}={number!r}"), (other, f"{name}={other!r}")):
                _assert_refused(rig, {**rig.example, name: wrong}, UnitError, name, what)


@rule(Rig)
def unknown_and_missing_conditions_are_refused(rig: Rig) -> None:
    """A `ConditionsError` names a condition that the rig does not take, or one that is left out and not optional."""
    unknown = {**rig.example, "no_such_condition": 1.0}
    _assert_refused(rig, unknown, ConditionsError, "no_such_condition", "an unknown condition")
    for name in rig.example:
        rest = {other: value for other, value in rig.example.items() if other != name}
        _assert_refused(rig, rest, ConditionsError, name, f"the example without {name}", optional=True)


@rule(Rig, always=True)
def values_that_are_no_numbers_are_refused(rig: Rig) -> None:
    """NaN in a condition is refused by an error that names it; infinity is refused, or gives a finite problem."""
    for name, value in varied(rig).items():
        for number, optional in ((np.nan, False), (np.inf, True)):
            numbers = np.array([getattr(value, "magnitude", value), number])
            conditions = {**rig.example, name: in_unit_of(value, numbers)}
            _assert_refused(rig, conditions, InputError, name, f"{number} in {name}", optional=optional)


def _assert_refused(
    rig: Rig, conditions: Conditions, kind: type[WearlawError], name: str, what: str, optional: bool = False
) -> None:
    """Assert that conditions raise an error that names one of them; if `optional`, they may give a problem too."""
    wanted = f"raise wearlaw.{kind.__name__} with a message that names '{name}'"
    try:
        rig.checked_problem(conditions)
    except WearlawError as raised:
        error = raised
    else:
        assert optional, f"{what} is taken; {wanted}"
        return
    named = isinstance(error, kind) and re.search(rf"\b{name}\b", str(error))
    assert named, f"{what} raises {described(error)}; {wanted}"


@rule(Rig)
def geometry_is_that_of_the_problem(rig: Rig) -> None:
    """`patch_geometry` is the shape of the patch of the problem, or None."""
    made = problem_of(rig).geometry
    assert rig.patch_geometry in (None, made), (
        f"`patch_geometry` is '{rig.patch_geometry}', but the patch of the problem is '{made}'"
    )


@rule(Rig)
def bodies_are_those_of_the_problem(rig: Rig) -> None:
    """Each of `bodies` has a name and a radius, and the problem has the density of the first of them.

    It still has if the materials in the fields of the rig are others. The bodies of a problem that brings its own are
    the same, in the same order.
    """
    for name, body in rig.bodies.items():
        assert name.isidentifier(), f"the name of a body must be an identifier, got {name!r}"
        radius = body.rolling_radius
        assert np.all(np.asarray(radius) > 0.0), f"the rolling radius of {name} is {radius!r} m, not above zero"
    for tried, which in ((rig, ""), (of_other_materials(rig), " of the rig with other materials")):
        problem = problem_of(tried)
        for name, body in [*tried.bodies.items()][:1]:
            expected = np.asarray(scalar_si(body.material.density, "kg/m^3"))
            message = f"the density of the problem{which}, with {name} as the first body"
            assert_close(problem.existing().density, expected, message)
        names = [name for name in problem.bodies if name in tried.bodies]
        assert names == [name for name in tried.bodies if name in names], (
            f"`bodies` has the order {', '.join(tried.bodies)}, the problem {', '.join(problem.bodies)}"
        )
        for (name, body), other in zip(tried.bodies.items(), problem.bodies.values(), strict=False):
            radii = body.rolling_radius, other.rolling_radius  # of places on a profile they differ from the nominal one
            same = np.ndim(radii[1]) > 0 or other.profile_position is not None or radii[0] == radii[1]
            assert same, f"the radius of {name} in `bodies` is not that of the body of the problem{which}"
            assert body.material == other.material, (
                f"the material of {name} in `bodies` is not that of the body of the problem{which}"
            )


def fields_of(record: Configuration) -> dict[str, Any]:
    """Return the fields of a record, without its cached values."""
    return {name: getattr(record, name) for name in type(record).model_fields}


def of_other_materials(record: Any) -> Any:
    """Return a record whose materials are denser, stiffer and more compressible, each more than the one before."""
    changed: dict[str, Any] = {}
    for name, value in fields_of(record).items():
        if isinstance(value, Material):
            changed[name] = other_material(value, 1.25 ** (len(changed) + 1))
        elif isinstance(value, Configuration):
            changed[name] = of_other_materials(value)
    return record.model_copy(update=changed) if changed else record


def other_material(material: Material, factor: float) -> Material:
    """Return a material that is denser, stiffer and more compressible."""
    values = {"density": material.density * factor, "youngs_modulus": material.youngs_modulus * factor}
    return material.model_copy(update={**values, "poisson_ratio": material.poisson_ratio / factor})


@rule(Rig)
def problem_is_in_double_precision(rig: Rig) -> None:
    """Loads, pressures, friction, sizes, speeds and creepages are exact, in steps of 1e-8 of each condition."""
    for name, value in varied(rig).items():

        def changed(factor: float, name: str = name, value: Any = value) -> Array:
            values = values_of(problem_of(rig, **{name: times(value, factor)}))
            return np.concatenate([np.ravel(values[field]) for field in PRECISE])

        lost_digits(changed, f"the problem loses digits of {name}", ROUNDING)


def _crept(rig: Rig, share: float) -> Any:
    """Return the problem of the example with a share of the condition that `creepage` names."""
    assert rig.creepage is not None
    return problem_of(rig, **{rig.creepage: times(varied(rig)[rig.creepage], share)})


@rule(Rig, applies=_has_one_creepage)
def creepage_is_proportional_to_its_condition(rig: Rig) -> None:
    """Half, none and the negative of the condition that `creepage` names give that of the creepage, and little else.

    A rolling speed may change, where it is the mean of a speed that is kept and one that makes the creepage.
    """
    whole = _crept(rig, 1.0).existing()
    assert (whole.longitudinal_creepage != 0.0).all(), f"the example has no creepage; give another {rig.creepage}"
    for share in (0.5, 0.0, -1.0):
        crept = _crept(rig, share).existing()
        expected = values_of(whole)
        expected["longitudinal_creepage"] = share * expected["longitudinal_creepage"]
        expected["rolling_speed"] = values_of(crept)["rolling_speed"]
        _assert_same(crept, expected, f"{share} times the {rig.creepage}")
