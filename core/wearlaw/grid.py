"""Grids of operating points, as a case file describes them: conditions of which some are axes."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import BeforeValidator, Field, model_validator

from wearlaw.arrays import Array
from wearlaw.conditions import TWIN_DISC
from wearlaw.configuration import Configuration
from wearlaw.errors import InputError
from wearlaw.problem import Problem
from wearlaw.rigs.twin_disc import TwinDisc
from wearlaw.units import Q

SI_UNITS = {"normal_force": "N", "normal_force_per_width": "N/m", "max_pressure": "Pa", "creepage": ""}
"""The coherent SI units of the conditions that have a unit."""

MOST_POINTS = 10_000_000
"""The largest grid that is taken on."""


def _value(value: Any) -> Any:
    """Refuse early what cannot be one value of a condition."""
    if isinstance(value, bool) or not isinstance(value, (int, float, str)):
        raise InputError(f"must be a value, a list of values, or a table with from, to and points; got {value!r}")
    if isinstance(value, float) and not np.isfinite(value):
        raise InputError(f"must be finite, got {value}")
    return value


Value = Annotated[float | str, BeforeValidator(_value)]
"""One value of a condition."""


class Axis(Configuration):
    """Values of a condition from one end to the other."""

    start: Value = Field(alias="from")
    """First value, with its unit where the condition has one."""
    stop: Value = Field(alias="to")
    """Last value, with its unit."""
    points: Annotated[int, Field(ge=2, le=MOST_POINTS, strict=True)]
    """How many values, ends included."""
    spacing: Literal["log", "linear"] = "linear"
    """Whether neighbours stand in a constant ratio or at a constant distance."""

    def values(self, name: str) -> Array:
        """Return the values of the condition `name` in SI."""
        first, last = float(TWIN_DISC.si(name, self.start)), float(TWIN_DISC.si(name, self.stop))
        if self.spacing == "linear":
            return np.linspace(first, last, self.points)
        if first * last <= 0:
            raise InputError(f"{name}: a log axis cannot touch or cross zero; use spacing = 'linear'")
        return np.geomspace(first, last, self.points)


def _condition(value: Any) -> Any:
    """Make an axis from a table, and refuse early what is neither that nor a value nor a list of values."""
    if isinstance(value, Axis):
        return value
    if isinstance(value, dict):
        return Axis(**value)
    if not isinstance(value, (list, tuple)):
        return _value(value)
    if not value:
        raise InputError("is empty; give at least one value")
    return tuple(_value(item) for item in value)


Condition = Annotated[float | str | tuple[float | str, ...] | Axis, BeforeValidator(_condition)]
"""A value, a list of values, or an axis."""


class Grid(Configuration):
    """Conditions of operating points; those with several values are the axes of a grid.

    Exactly one of `normal_force`, `normal_force_per_width` and `max_pressure` gives the load.
    """

    normal_force: Condition | None = None
    """N, with its unit."""
    normal_force_per_width: Condition | None = None
    """P, with its unit."""
    max_pressure: Condition | None = None
    """p0, with its unit."""
    creepage: Condition
    """ξ, in percent or as a ratio: "1 %" or "0.01 dimensionless"."""
    friction_coefficient: Condition
    """μ, a plain number."""
    traction_coefficient: Condition | None = None
    """Measured T/N, a plain number; for contact models that can use it."""

    @model_validator(mode="after")
    def _possible(self) -> Grid:
        """Find what is wrong with the conditions when they are read, not when they are used."""
        extremes = {name: np.array([values.min(), values.max()]) for name, values in self.conditions().items()}
        TwinDisc.suros().problem(**with_units(extremes))
        if self.size > MOST_POINTS:
            raise InputError(f"the axes make a grid of {self.size} points; at most {MOST_POINTS} are possible")
        return self

    def conditions(self) -> dict[str, Array]:
        """Return the SI values of each condition that is given, of shape () or (values,)."""
        given = {name: getattr(self, name) for name in TWIN_DISC.names}
        return {name: _values(name, value) for name, value in given.items() if value is not None}

    def axes(self) -> dict[str, Array]:
        """Return the SI values of the conditions that are axes, in the order of the grid."""
        return {name: values for name, values in self.conditions().items() if values.ndim == 1}

    @property
    def size(self) -> int:
        """The number of operating points."""
        return math.prod(values.size for values in self.axes().values())

    def problem(self, rig: TwinDisc) -> Problem:
        """Return the contact problem at all points of the grid."""
        axes = list(self.axes())
        shaped = {
            name: values.reshape([-1 if axis == name else 1 for axis in axes]) if name in axes else values
            for name, values in self.conditions().items()
        }
        return rig.problem(**with_units(shaped))


def with_units(conditions: Mapping[str, Array]) -> dict[str, Any]:
    """Return conditions in SI as a rig takes them."""
    return {name: Q(si, SI_UNITS[name]) if name in SI_UNITS else si for name, si in conditions.items()}


def _values(name: str, value: Any) -> Array:
    if isinstance(value, Axis):
        return value.values(name)
    if isinstance(value, tuple):
        return np.array([float(TWIN_DISC.si(name, item)) for item in value])
    return TWIN_DISC.si(name, value)
