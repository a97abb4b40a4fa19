"""The conditions of a test: check the user's values and units, and broadcast them against each other."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, Protocol, TypeAlias, TypeGuard

import numpy as np
import pint

from wearlaw.arrays.array import Array, extremes, read_only
from wearlaw.errors import ConditionsError, ModelError, UnitError, WearlawError, described, did_you_mean
from wearlaw.units.quantities import Q, Unit, coefficient, parse, real_array
from wearlaw.units.registry import symbol
from wearlaw.units.variables import VARIABLES, expected

if TYPE_CHECKING:
    pass

Arrays: TypeAlias = dict[str, Array]
"""SI arrays of the conditions, by name."""


class FrictionLaw(Protocol):
    """Friction that depends on the speed of sliding."""

    def coefficient(self, creep_speed: Array) -> Array:
        """Return μ [-] at creep speeds [m/s], of their shape."""
        ...


LOADS = ("normal_force", "normal_force_per_width", "max_pressure")
"""The conditions that give the load of a line."""

COEFFICIENTS = ("friction_coefficient", "traction_coefficient")
"""The conditions that are plain numbers."""


@dataclass(frozen=True)
class ConditionTable:
    """The conditions of a rig.

    Attributes
    ----------
    loads, creepages : tuple of str
        Exactly one load and the first creepage are required; other creepages are zero if not given.
    others : tuple of str
        Further conditions with a unit, left out of the arrays if not given.
    coefficients : tuple of str
        Plain numbers; the first is required.
    examples : mapping of str to str
        Example values of the required conditions, for messages.
    """

    loads: tuple[str, ...]
    creepages: tuple[str, ...]
    coefficients: tuple[str, ...]
    examples: Mapping[str, str]
    others: tuple[str, ...] = ()

    @cached_property
    def units(self) -> dict[str, Unit]:
        """The conditions that have a unit."""
        return expected(*self.loads, *self.creepages, *self.others)

    @cached_property
    def names(self) -> tuple[str, ...]:
        """All conditions."""
        return (*self.units, *self.coefficients)

    def si(self, name: str, value: object) -> Array:
        """Return the value of a condition in SI, or raise a `UnitError` that names the condition."""
        unit = self.units.get(name)
        return coefficient(value, name) if unit is None else unit.si(value, name)

    def unknown(self, name: str) -> ConditionsError:
        """Return the error for a condition that the rig does not take."""
        names = self.names
        return ConditionsError(
            f"{name}: unknown condition{did_you_mean(name, names)} The conditions are: {', '.join(names)}"
        )


def condition_arrays(
    conditions: Mapping[str, Any], table: ConditionTable, creep_speed: Callable[[Arrays], Array]
) -> Arrays:
    """Return all conditions as SI arrays of one shape.

    `creep_speed` computes the speed that friction can depend on [m/s] from the other conditions.
    """
    given = {name: value for name, value in conditions.items() if value is not None}
    friction = given.get("friction_coefficient")
    if is_friction_law(friction):
        given["friction_coefficient"] = 1.0
    units = table.units
    arrays: Arrays = {}
    for name, value in given.items():  # not by `table.si`, because its calls take a hundredth of a prediction
        if name in units:
            arrays[name] = units[name].si(value, name)
        elif name in table.coefficients:
            arrays[name] = coefficient(value, name)
    _check_names(conditions, arrays, table)
    for name in table.others:
        if name in arrays and VARIABLES[name].sign == "not negative" and arrays[name].min() < 0.0:
            raise UnitError(f"{name}: must not be negative, got {given[name]!r}")
    for name in table.creepages:
        if name not in arrays:
            arrays[name] = np.float64(0.0)  # type: ignore[assignment]
    arrays = broadcast(arrays)
    if is_friction_law(friction):
        arrays["friction_coefficient"] = _of_friction_law(
            friction, creep_speed(arrays), arrays[table.creepages[0]].shape
        )
    return arrays


def _of_friction_law(friction: FrictionLaw, creep_speed: Array, shape: tuple[int, ...]) -> Array:
    """Return μ [-] of a friction law in the shape of the conditions, checked, since the law may come from anyone."""
    law = f"friction_coefficient: friction law {type(friction).__name__}"
    try:
        given = friction.coefficient(creep_speed)
    except (WearlawError, KeyboardInterrupt, MemoryError):
        raise
    except Exception as error:
        raise ModelError(f"{law} failed: {described(error)}") from error
    try:
        found = coefficient(given, "its result")
    except UnitError as error:
        raise ModelError(f"{law} is wrong at creep speeds of {_spread(creep_speed)}: {error}") from None
    if found.shape == shape:
        return found
    try:
        return np.broadcast_to(found, shape)
    except ValueError:
        raise ModelError(
            f"{law} returned an array of shape {found.shape} for creep speeds of shape {shape}; return one coefficient"
            " for each of them"
        ) from None


def _spread(creep_speed: Array) -> str:
    low, high = extremes(creep_speed)
    return f"{low:.4g} m/s" if low == high else f"{low:.4g} to {high:.4g} m/s"


def is_friction_law(friction: object) -> TypeGuard[FrictionLaw]:
    """Return whether friction depends on the speed of sliding."""
    # A test with isinstance(friction, FrictionLaw) would take a tenth of the time of a prediction.
    return callable(getattr(friction, "coefficient", None)) and not isinstance(friction, type)


def _check_names(conditions: Mapping[str, Any], arrays: Arrays, table: ConditionTable) -> None:
    """Raise an error for an unknown or missing condition, or for several loads."""
    names = table.names
    for name in conditions:
        if name not in names:
            raise table.unknown(name)
    loads = [name for name in table.loads if name in arrays]
    if len(loads) != 1:
        raise ConditionsError(
            f"give exactly one of {', '.join(table.loads)}; got {' and '.join(loads) if loads else 'none of them'}"
        )
    for name, example in table.examples.items():
        if name not in arrays:
            raise ConditionsError(f"{name}: is missing; give {name}={example}")


def broadcast(arrays: Arrays) -> Arrays:
    """Return the arrays in one shape, as read-only views."""
    shapes = {array.shape for array in arrays.values()}
    if shapes == {()}:
        return arrays
    try:
        (shape,) = shapes if len(shapes) == 1 else (np.broadcast_shapes(*shapes),)
    except ValueError:
        shown = ", ".join(f"{name} {array.shape}" for name, array in arrays.items())
        raise ConditionsError(f"the shapes of the conditions do not broadcast: {shown}") from None
    if 0 in shape:
        empty = next(name for name, array in arrays.items() if array.size == 0)
        raise ConditionsError(f"{empty}: is empty; give at least one value")
    return {
        name: read_only(array) if array.shape == shape else np.broadcast_to(array, shape)
        for name, array in arrays.items()
    }


@dataclass(frozen=True, eq=False)
class Known:
    """A known condition: one number or several, and their unit, None for plain numbers."""

    values: Array
    unit: str | None

    @classmethod
    def of(cls, value: object) -> Known | None:
        """Return a given condition, or None if it is not numeric, such as a law of friction."""
        try:
            quantity = parse(value) if isinstance(value, str) else value
            if isinstance(quantity, pint.Quantity):
                return cls(real_array(quantity.magnitude), symbol(quantity.units, "~C"))
            return cls(real_array(quantity), None)
        except UnitError:
            return None

    def at_samples(self) -> Any:
        """Return the condition as an argument for a rig, with a last axis for the samples."""
        values = np.asarray(self.values)[..., None]
        return values if self.unit is None else Q(values, self.unit)
