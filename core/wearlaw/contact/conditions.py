"""The conditions of rigs and models: read from their declaration, checked, and broadcast against each other."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cache
from types import SimpleNamespace
from typing import (
    Annotated,
    Any,
    NotRequired,
    Protocol,
    Required,
    TypeAlias,
    TypeGuard,
    Unpack,
    get_args,
    get_origin,
)
from typing import get_type_hints as hints_of

import numpy as np
from numpy.typing import ArrayLike

from wearlaw.arrays import Array, extremes, read_only
from wearlaw.configuration import item_docstrings
from wearlaw.errors import CompositionError, ConditionsError, ModelError, UnitError, WearlawError, described
from wearlaw.units.quantities import Quantity, QuantityLike, Unit, coefficient
from wearlaw.units.registry import unit_in_si
from wearlaw.units.variables import alike, meaning_of

Arrays: TypeAlias = dict[str, Array]
"""SI arrays of the conditions, by name."""


class FrictionLaw(Protocol):
    """Friction that depends on the speed of sliding."""

    def coefficient(self, creep_speed: Array) -> Array:
        """Return μ [-] at creep speeds [m/s], of their shape."""
        ...


Coefficient: TypeAlias = Annotated[ArrayLike, coefficient]
"""A condition that is a positive number without a unit, checked by `wearlaw.coefficient`."""

Friction: TypeAlias = Annotated[ArrayLike | FrictionLaw, coefficient]
"""A coefficient of friction, or a law that gives it for the speed of sliding, such as `FallingFriction`."""

Creepage: TypeAlias = Annotated[QuantityLike, Unit("", positive=False, limit=1.0)]
"""A creepage: a ratio or in percent, of magnitude at most 1."""


@dataclass(frozen=True)
class Condition:
    """A condition that a rig takes, or that a contact model, a stage or a law declares.

    Attributes
    ----------
    name : str
        Its name.
    required : bool
        Whether it must always be given.
    unit : Unit or None
        Its unit and bounds; None for a plain number, or if the rig does not declare it.
    check : callable or None
        Takes its value and its name, and returns an SI array; None if the rig checks it itself.
    law : bool
        Whether it may be a friction law.
    table : type or None
        The `TypedDict` that declares it.
    of : str
        What declares it in words, such as "wear law 'humid'"; "" for the rig.
    """

    name: str
    required: bool
    unit: Unit | None = None
    check: Callable[[object, str], Array] | None = None
    law: bool = False
    table: type | None = None
    of: str = ""

    @property
    def example(self) -> str | float:
        """A value, such as "50 %": the middle of what is usual if that is known."""
        middle = 1.0 if self.unit is None or self.unit.usual is None else 0.5 * sum(self.unit.usual)
        return middle if self.unit is None else f"{middle:.6g} {self.unit.unit or 'dimensionless'}"

    def __str__(self) -> str:
        unit = self.unit or Unit("")
        usual = "" if unit.usual is None else ", usually {:g} to {:g}".format(*unit.usual)
        return f"{self.of or 'the rig'} in [{unit.unit or '-'}]{usual}"

    def in_si(self, value: object) -> Array:
        """Return its value in SI, checked."""
        assert self.check is not None  # as the class of a model that declares conditions ensures
        return self.check(value, self.name)

    def agrees(self, other: Condition) -> bool:
        """Return whether a value can be both this condition and another one of the same name."""
        if None in (self.check, other.check):  # the rig does not declare it
            return True
        first, second = (condition.unit or Unit("") for condition in (self, other))
        if not alike(first.unit, second.unit):
            return False
        any_value = -np.inf, np.inf
        usual = ((end * unit_in_si(unit.unit) for end in unit.usual or any_value) for unit in (first, second))
        (low, high), (least, most) = usual
        return low <= most and least <= high

    @property
    def meaning(self) -> str:
        """What it is: the docstring below it in its `TypedDict`, if it has one."""
        stated = item_docstrings(self.table).get(self.name) if self.table is not None else None
        return stated or meaning_of(self.name)


@cache
def declared(problem: Callable[..., object]) -> Mapping[str, Condition]:
    """Return the conditions that a method `problem` takes, by name.

    They are those of the `TypedDict` by which its `**conditions` are annotated, or else its arguments; {} if it takes
    any conditions.
    """
    signature = inspect.signature(problem)
    _, *parameters = signature.parameters.values()
    any_name = [parameter for parameter in parameters if parameter.kind is parameter.VAR_KEYWORD]
    if not any_name:
        return {
            parameter.name: Condition(parameter.name, parameter.default is parameter.empty) for parameter in parameters
        }
    of = SimpleNamespace(__annotations__={"conditions": any_name[0].annotation})
    hint = hints_of(of, getattr(inspect.unwrap(problem), "__globals__", {}), include_extras=True)["conditions"]
    return of_table(get_args(hint)[0]) if get_origin(hint) is Unpack else {}


@cache
def of_table(table: Any, of: str = "") -> Mapping[str, Condition]:
    """Return the conditions of a `TypedDict`; `of` says in words what declares them."""
    conditions = {}
    for name, hint in hints_of(table, include_extras=True).items():
        # `__required_keys__` does not see `Required` and `NotRequired` in postponed annotations before Python 3.13.
        wrapper = get_origin(hint) if get_origin(hint) in (Required, NotRequired) else None
        required = wrapper is Required or (wrapper is None and name in table.__required_keys__)
        value = get_args(hint)[0] if wrapper else hint
        checks = getattr(value, "__metadata__", ())
        unit = next((check for check in checks if isinstance(check, Unit)), None)
        check = coefficient if coefficient in checks else None if unit is None else unit.si
        conditions[name] = Condition(name, required, unit, check, value == Friction, table, of)
    return conditions


def together(tables: Iterable[Mapping[str, Condition]]) -> dict[str, Condition]:
    """Return the conditions of several tables by name; one is required if any table requires it.

    Raises
    ------
    CompositionError
        If a condition has several dimensions, or ranges that exclude each other.
    """
    every: dict[str, list[Condition]] = {}
    for table in tables:
        for name, condition in table.items():
            for other in (others := every.setdefault(name, [])):
                if not condition.agrees(other):
                    raise CompositionError(
                        f"{name}: no value suits both {other} and {condition}; rename the condition of one of them"
                    )
            others.append(condition)
    return {
        name: replace(first, required=first.required or any(other.required for other in others))
        for name, (first, *others) in every.items()
    }


def friction_at(law: FrictionLaw, name: str, creep_speed: Array) -> Array:
    """Return μ [-] of a friction law in the shape of the creep speed, checked, since the law may come from anyone."""
    subject = f"{name}: friction law {type(law).__name__}"
    try:
        result = law.coefficient(creep_speed)
    except (WearlawError, MemoryError):
        raise
    except Exception as error:
        raise ModelError(f"{subject} failed: {described(error)}") from error
    try:
        friction = coefficient(result, "its result")
        return friction if friction.shape == creep_speed.shape else np.broadcast_to(friction, creep_speed.shape)
    except (UnitError, ValueError) as error:
        low, high = extremes(creep_speed)
        raise ModelError(f"{subject} is wrong at creep speeds from {low:.4g} to {high:.4g} m/s: {error}") from None


def is_friction_law(friction: object) -> TypeGuard[FrictionLaw]:
    """Return whether friction depends on the speed of sliding."""
    # A test with isinstance(friction, FrictionLaw) would take a tenth of the time of a prediction; pint writes all
    # numbers of a quantity into the error for an attribute that it lacks.
    if isinstance(friction, Quantity | type):
        return False
    return callable(getattr(friction, "coefficient", None))


def broadcast(arrays: Arrays) -> Arrays:
    """Return the arrays in one shape, as read-only views."""
    shapes = {array.shape for array in arrays.values()}
    if shapes == {()}:
        return arrays
    try:
        (shape,) = shapes if len(shapes) == 1 else (np.broadcast_shapes(*shapes),)
    except ValueError:
        shown = ", ".join(f"{name} {array.shape}" for name, array in arrays.items() if array.ndim)
        column = "for all combinations, make one a column, as in Q([[1], [2]], ...)"
        raise ConditionsError(f"the shapes do not broadcast: {shown}; {column}") from None
    if 0 in shape:
        empty = next(name for name, array in arrays.items() if array.size == 0)
        raise ConditionsError(f"{empty}: is empty; give at least one value")
    return {
        name: read_only(array) if array.shape == shape else np.broadcast_to(array, shape)
        for name, array in arrays.items()
    }
