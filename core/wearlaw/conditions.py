"""The conditions of a test, as the user gives them: checked, with units, broadcast against each other."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Required, TypedDict

import numpy as np

from wearlaw.arrays import Array
from wearlaw.errors import ConditionsError, did_you_mean
from wearlaw.units import QuantityLike, Unit, coefficient

if TYPE_CHECKING:
    from numpy.typing import ArrayLike


class TwinDiscConditions(TypedDict, total=False):
    """The conditions of a twin-disc test; arrays broadcast against each other.

    Exactly one of `normal_force`, `normal_force_per_width` and `max_pressure` gives the load.

    Attributes
    ----------
    normal_force : Quantity or str
        Normal force on the whole width, N [N].
    normal_force_per_width : Quantity or str
        Normal force per unit width, P [N/m].
    max_pressure : Quantity or str
        Hertz's maximum pressure, p0 [Pa].
    creepage : Quantity or str
        Creepage, ξ [-], positive where disc 1 is the faster one, of magnitude at most 1.
    friction_coefficient : array_like of float
        Friction coefficient, μ [-].
    traction_coefficient : array_like of float
        Measured tangential over normal force, T/N [-], for contact models that can use it.
    """

    normal_force: QuantityLike
    normal_force_per_width: QuantityLike
    max_pressure: QuantityLike
    creepage: Required[QuantityLike]
    friction_coefficient: Required[ArrayLike]
    traction_coefficient: ArrayLike


LOADS = {"normal_force": Unit("N"), "normal_force_per_width": Unit("kN/m"), "max_pressure": Unit("MPa")}
"""The conditions that give the load, with their units."""

CREEPAGE = Unit("", positive=False, limit=1.0)
"""Creepage is a ratio of magnitude at most 1."""

COEFFICIENTS = ("friction_coefficient", "traction_coefficient")
"""The conditions that are plain numbers."""

CONDITIONS = (*LOADS, "creepage", *COEFFICIENTS)
"""All conditions of a twin-disc test."""


UNITS = {**LOADS, "creepage": CREEPAGE}
"""The conditions that have units."""


def condition_arrays(conditions: dict[str, Any]) -> dict[str, Array]:
    """Return all given conditions as SI arrays of one shape."""
    arrays = {}
    for name, value in conditions.items():
        if name in UNITS and value is not None:
            arrays[name] = UNITS[name].si(value, name)
        elif name in COEFFICIENTS and value is not None:
            arrays[name] = coefficient(value, name)
        elif name not in CONDITIONS:
            raise ConditionsError(
                f"{name}: unknown condition;{did_you_mean(name, CONDITIONS)}"
                f" The conditions are: {', '.join(CONDITIONS)}"
            )
    loads = [name for name in LOADS if name in arrays]
    if len(loads) != 1:
        raise ConditionsError(
            f"give exactly one of {', '.join(LOADS)}; got {' and '.join(loads) if loads else 'none of them'}"
        )
    for name in ("creepage", "friction_coefficient"):
        if name not in arrays:
            example = 'Q(1, "%")' if name == "creepage" else "0.46"
            raise ConditionsError(f"{name}: is missing; give {name}={example}")
    return _broadcast(arrays)


def _broadcast(arrays: dict[str, Array]) -> dict[str, Array]:
    """Return the arrays in one shape, as views that cannot be written to."""
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
    return {name: _read_only(array, shape) for name, array in arrays.items()}


def _read_only(array: Array, shape: tuple[int, ...]) -> Array:
    if array.shape != shape:
        return np.broadcast_to(array, shape)
    view = array.view()
    view.setflags(write=False)
    return view
