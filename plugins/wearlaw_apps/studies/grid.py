"""Operating points as a case file describes them: conditions of a rig, some of which are axes of a grid."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from functools import cached_property
from typing import Annotated, Any, Literal

import numpy as np
import pint
from pydantic import BeforeValidator, Field, model_validator

from wearlaw.arrays import Array
from wearlaw.configuration import Configuration
from wearlaw.contact.conditions import together
from wearlaw.errors import CompositionError, Fault, InputError, UnitError, WearlawError, shown
from wearlaw.models.model import Model
from wearlaw.pipeline.pipeline import Rig, unknown_condition
from wearlaw.units.quantities import Q, parse
from wearlaw.units.registry import symbol
from wearlaw.units.variables import UNITS
from wearlaw_apps.output.conditions import Known
from wearlaw_apps.output.notes import caught_warnings
from wearlaw_apps.sweeps.points import Points, Varying

MOST_POINTS = 10_000_000
"""Largest grid that a case may have."""


def _value(value: Any) -> Any:
    """Raise an error unless this may be a value of a condition."""
    if isinstance(value, bool) or not isinstance(value, (int, float, str)):
        raise InputError(f"must be a value, a list of values, or a table with from, to and points; got {shown(value)}")
    if isinstance(value, float) and not np.isfinite(value):
        raise InputError(f"must be finite, got {value}")
    return value


Value = Annotated[float | str, BeforeValidator(_value)]
"""One value of a condition."""


class Axis(Configuration):
    """Evenly spaced values of a condition."""

    start: Value = Field(alias="from")
    """First value, with its unit if the condition has one."""
    stop: Value = Field(alias="to")
    """Last value, with its unit."""
    points: Annotated[int, Field(ge=2, le=MOST_POINTS, strict=True)]
    """Number of values, ends included."""
    spacing: Literal["log", "linear"] = "linear"
    """Spacing of the values: "log" at a constant ratio, "linear" at a constant distance."""

    def values(self) -> tuple[Array, str | None]:
        """Return the values, and the unit of the first of them, None for plain numbers.

        Raises
        ------
        InputError
            If the ends have different dimensions, are not finite, or are too far apart, or a log axis touches zero.
        """
        (first, last), unit = _in_one_unit((self.start, self.stop))
        if not math.isfinite(float(last) - float(first)):
            raise InputError(
                f"the ends of an axis and their distance must be finite, got '{self.start}' and '{self.stop}'"
            )
        if self.spacing == "linear":
            return np.linspace(first, last, self.points), unit
        if np.sign(first) * np.sign(last) <= 0:
            raise InputError("a log axis cannot touch or cross zero; use spacing = 'linear'")
        return np.geomspace(first, last, self.points), unit


def _condition(value: Any) -> Any:
    """Make an axis from a table; raise an error unless this is an axis, a value, or values of one dimension."""
    if isinstance(value, dict):
        value = Axis(**value)
    elif isinstance(value, (list, tuple)):
        if not value:
            raise InputError("is empty; give at least one value")
        value = tuple(_value(item) for item in value)
    elif not isinstance(value, Axis):
        return _value(value)
    _values(value)
    return value


Condition = Annotated[float | str | tuple[float | str, ...] | Axis, BeforeValidator(_condition)]
"""A value, a list of values, or an axis."""


class Grid(Configuration, extra="allow"):
    """Conditions of operating points, by the names that the rig gives them; those with several values are axes."""

    __pydantic_extra__: dict[str, Condition]  # pyright: ignore[reportIncompatibleVariableOverride]

    @model_validator(mode="after")
    def _has_room(self) -> Grid:
        if self.size > MOST_POINTS:
            raise InputError(f"the axes make a grid of {self.size} points; at most {MOST_POINTS} are possible")
        return self

    @property
    def written(self) -> Mapping[str, Any]:
        """The conditions as written in the case."""
        return self.__pydantic_extra__ or {}

    def ordered(self, rig: Rig) -> Grid:
        """Return the conditions in the order in which the rig names them, and then those of models."""
        order = [*rig.conditions(), *self.written]
        return Grid(**dict(sorted(self, key=lambda item: order.index(item[0]) if item[0] in order else -1)))

    @cached_property
    def _axes(self) -> dict[str, Varying]:
        """The conditions that are axes, each in the unit of its first value."""
        read = ((name, _values(value)) for name, value in self.written.items())
        return {name: Varying(name, *axis) for name, axis in read if axis is not None}

    @cached_property
    def _known(self) -> dict[str, Varying | Known | None]:
        """All conditions; None for what is no number."""
        return {name: self._axes.get(name) or Known.of(value) for name, value in self.written.items()}

    def axes(self) -> dict[str, int]:
        """Return the number of values of each axis, in the order of the grid."""
        return {name: axis.values.size for name, axis in self._axes.items()}

    @property
    def size(self) -> int:
        """The number of operating points."""
        return math.prod(self.axes().values())

    def first(self) -> Grid:
        """Return the grid of the first value of each axis."""
        first = {name: (float(axis.values[0]), axis.unit) for name, axis in self._axes.items()}
        points = {name: (f"{value!r} {unit}" if unit else value,) for name, (value, unit) in first.items()}
        return Grid(**{**self.written, **points})

    def faults(self, rig: Rig, models: Iterable[Model] = ()) -> list[Fault]:
        """Return the unknown and missing conditions, or else what is refused at the ends of the axes, one of each."""
        try:
            conditions = together([rig.conditions(), *(model.own_conditions() for model in models)])
        except CompositionError as error:
            return [Fault((), str(error))]
        unknown = [name for name in self.written if rig.conditions() and name not in conditions]
        faults = {name: unknown_condition(name, conditions, type(rig)) for name in unknown}
        for name, condition in conditions.items():
            if condition.required and name not in self.written:
                faults[name] = f"is missing; {condition.of} needs it" if condition.of else "is missing"
        for end in () if faults else (np.min, np.max):
            ends = {name: axis.argument(float(end(axis.values))) for name, axis in self._axes.items()}
            try:
                _quietly(rig, {**self.written, **ends}, models)
            except WearlawError as error:
                text = str(error)
                about = next((name for name in self.written if text.startswith(f"{name}: ")), "")
                faults.setdefault(about, text.removeprefix(f"{about}: "))
        return [Fault((name,) if name else (), text) for name, text in faults.items()]

    def units(self) -> dict[str, str]:
        """Return the units of the conditions in results: the usual unit of a known variable, else as written."""
        return {
            name: shown_unit(name, None if condition is None else condition.unit)
            for name, condition in self._known.items()
        }

    def written_units(self) -> dict[str, str]:
        """Return the unit in which the grid gives each condition; plain numbers and names have none here."""
        return {name: condition.unit for name, condition in self._known.items() if condition and condition.unit}

    def spacing(self, name: str) -> Literal["log", "linear"]:
        """Return how the values of an axis are spaced; a list is logarithmic if its ratios differ less than its steps.

        Two values, or values of both signs, are linear.
        """
        condition = self.written[name]
        if isinstance(condition, Axis):
            return condition.spacing
        values = np.unique(np.abs(self._axes[name].values))
        if values.size < 3 or values[0] == 0.0 or np.ptp(np.sign(self._axes[name].values)) > 0.0:
            return "linear"
        ratios, steps = values[1:] / values[:-1], np.diff(values)
        return "log" if ratios.max() / ratios.min() < steps.max() / steps.min() else "linear"

    def points(self, units: Mapping[str, str]) -> Points:
        """Return the operating points, with the axes in these units.

        Raises
        ------
        UnitError
            If a unit has another dimension than the condition.
        """
        varying = {
            name: Varying(name, *_converted(name, axis.values, axis.unit, units[name]))
            for name, axis in self._axes.items()
        }
        return Points({name: value for name, value in self.written.items() if name not in varying}, varying)

    def conditions(self) -> dict[str, Any]:
        """Return the conditions as arguments of a pipeline; each axis is an array along a dimension of its own."""
        last = len(self._axes) - 1
        shapes = {name: (-1,) + (1,) * (last - number) for number, name in enumerate(self._axes)}
        axes = {name: axis.argument(axis.values.reshape(shapes[name])) for name, axis in self._axes.items()}
        return {**self.written, **axes}

    def level(self, name: str, units: Mapping[str, str]) -> float | str:
        """Return the value of a condition in the given unit, or its text; for an axis, its middle value."""
        condition = self._known[name]
        if condition is None:
            return self.written[name]  # type: ignore[no-any-return]
        middle = np.ravel(condition.values)[condition.values.size // 2]
        return float(_converted(name, middle, condition.unit or "", units[name])[0])

    def problem(self, rig: Rig, models: Iterable[Model] = ()) -> Any:
        """Return the contact problem of the first operating point, for a rig and the models of a case."""
        first = {name: axis.argument(float(axis.values[0])) for name, axis in self._axes.items()}
        return _quietly(rig, {**self.written, **first}, models)


def _quietly(rig: Rig, conditions: Mapping[str, Any], models: Iterable[Model]) -> Any:
    """Return the rig's problem without its warnings, which running the case repeats."""
    with caught_warnings():
        return rig.checked_problem(conditions, models)


def shown_unit(name: str, written: str | None) -> str:
    """Return the unit of a condition in results from the unit it was written in, None for plain numbers."""
    usual = UNITS.get(name)
    if usual is None or written is None:
        return written or ""
    try:
        Q(1.0, written).to(usual)
    except pint.DimensionalityError:  # a rig may give the name to something else
        return written
    return usual


def _values(value: Any) -> tuple[Array, str | None] | None:
    """Return the values of an axis, or None for a single value."""
    if isinstance(value, Axis):
        return value.values()
    if isinstance(value, tuple):
        return _in_one_unit(value)
    return None


def _in_one_unit(values: tuple[float | str, ...]) -> tuple[Array, str | None]:
    """Return values as numbers in the unit of the first one."""
    texts = [value for value in values if isinstance(value, str)]
    if not texts:
        return np.array(values, dtype=np.float64), None
    if bare := [value for value in values if not isinstance(value, str)]:
        raise UnitError(
            f"got the bare number {shown(bare[0])}, which has no unit, beside {shown(texts[0])}; give all values one"
        )
    quantities = [parse(text) for text in texts]
    for quantity, text in zip(quantities, texts, strict=True):
        if not quantity.is_compatible_with(quantities[0]):
            raise UnitError(f"{shown(texts[0])} and {shown(text)} are not of one dimension")
    numbers = [quantity.to(quantities[0].units).magnitude for quantity in quantities]
    return np.array(numbers, dtype=np.float64), symbol(quantities[0].units, "~C")


def _converted(name: str, values: Any, unit: str | None, wanted: str) -> tuple[Any, str | None]:
    """Convert numbers to the unit wanted and return both; plain numbers stay as they are."""
    if unit is None or unit == wanted:
        return values, unit
    try:
        return Q(values, unit).to(wanted).magnitude, wanted
    except pint.DimensionalityError:
        raise UnitError(
            f"{name}: is in {unit}, and elsewhere in {wanted or 'no unit'}; use units of one dimension"
        ) from None
