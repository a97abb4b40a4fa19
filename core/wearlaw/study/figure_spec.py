"""The figures that a case file asks for: what to plot against what, for which models, in which windows."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, WithJsonSchema, model_validator

from wearlaw.contact.conditions import LOADS
from wearlaw.errors import ConfigurationError, Fault, UnitError
from wearlaw.pipeline.variables import OF_CONTACT, OF_POINT, UNITS
from wearlaw.settings.configuration import Configuration
from wearlaw.study.grid import Grid
from wearlaw.units.quantities import Unit, from_si

OF_PROFILE = ("pressure", "traction", "traction_bound", "slip", "wear_rate", "creepage")
"""What a figure can show along the patch of a line; the creepage of the operating point is a level line there."""

ACROSS = ("depth", "sliding_distance")
"""What a figure can show across the patch of an ellipse, of one of the bodies."""

OF_PAIRS = ("wear_rate", "depth")
"""The variables that differ from law to law."""

OF_LOAD = (*LOADS, "half_width", "semi_axis_a", "semi_axis_b")
"""The variables that the load alone determines."""

Scale = Literal["linear", "log"]


def _variables(value: Any) -> Any:
    return (value,) if isinstance(value, str) else value


_VARIABLE = {"enum": list(dict.fromkeys(("wear_rate", *OF_CONTACT, *OF_POINT, *OF_PROFILE, *ACROSS)))}

Variables = Annotated[
    tuple[str, ...],
    BeforeValidator(_variables),
    Field(min_length=1),
    WithJsonSchema({"anyOf": [_VARIABLE, {"type": "array", "items": _VARIABLE, "minItems": 1}]}),
]
"""One variable, or several of one unit."""

Range = tuple[float | str, float | str]
"""Two ends of an axis, each with its unit where the variable has one."""


class Window(Configuration):
    """One panel of a figure; what it does not give is as in the figure, but for the title."""

    title: str = ""
    """What stands above it."""
    y: Variables | None = None
    """What it shows: a variable, or several of one unit."""
    body: str | None = None
    """The body whose wear across the patch it shows, such as "wheel"; the first of the rig where not given."""
    x_range: Range | None = None
    """Where the x axis begins and ends, as in ["0 N", "70 N"]; with the curves where not given."""
    y_range: Range | None = None
    """Where the y axis begins and ends; so that all is seen where not given."""
    x_scale: Scale | None = None
    """Whether the x axis is linear, which it is where this is not given, or logarithmic."""
    y_scale: Scale | None = None
    """The same for the y axis."""

    @property
    def shown(self) -> tuple[str, ...]:
        """The variables that it shows."""
        return self.y or ()


class FigureSpec(Window):
    """A figure of a sweep, or of a profile of the patch."""

    caption: str = ""
    """What a reader must know; the conditions where not given."""
    sweep: str | None = None
    """The sweep that it shows; give this or `profile`."""
    profile: str | None = None
    """The profile that it shows."""
    x: Annotated[str, Field(json_schema_extra={"enum": ["x", "y", *OF_CONTACT, *OF_POINT]})] = "x"
    """The variable along the x axis; for a profile the position, "x" along the patch or "y" across it."""
    pairs: Annotated[tuple[str, ...], Field(min_length=1)] | None = None
    """The pairs whose wear rate it shows, such as "usfd on exact"; all where not given."""
    contact_models: Annotated[tuple[str, ...], Field(min_length=1)] | None = None
    """The contact models of which it shows other variables than wear rate; all where not given."""
    measured: bool = False
    """Whether it shows the measured tests."""
    panels: tuple[Window, ...] = ()
    """Several panels, such as the whole and an enlargement of a part; one where not given."""

    @model_validator(mode="after")
    def _possible(self) -> FigureSpec:
        wrong = [Fault(path, message) for path, message in self._problems()]
        if wrong:
            raise ConfigurationError("figure", wrong)
        return self

    def windows(self) -> tuple[Window, ...]:
        """Return the panels, each with all that it shows."""
        inherited = ("y", "body", "x_range", "y_range", "x_scale", "y_scale")
        common = {name: getattr(self, name) for name in inherited}
        own = [{name: value for name, value in panel if value is not None} for panel in self.panels] or [{}]
        return tuple(Window(**{**common, **window}) for window in own)

    def _problems(self) -> Iterator[tuple[tuple[str, ...], str]]:
        """Give what is wrong with the fields by themselves, whatever the case holds."""
        if (self.sweep is None) == (self.profile is None):
            yield ("sweep",), "give either sweep or profile, which the figure shows"
            return
        for number, window in enumerate(self.windows()):
            path = ("panels", str(number)) if self.panels else ()
            if window.y is None:
                yield (*path, "y"), "is missing"
            elif len(set(window.y)) < len(window.y):
                yield (*path, "y"), "names a variable twice"
        shown = {variable for window in self.windows() for variable in window.shown}
        if self.pairs and not shown.intersection(OF_PAIRS):
            yield ("pairs",), "the figure does not show wear_rate; choose among contact_models instead"
        if self.contact_models and shown == {"wear_rate"}:
            yield ("contact_models",), "the figure shows only wear_rate; choose among pairs instead"
        if self.measured and self.profile:
            yield ("measured",), "tests are measured over the whole patch; show them in a figure of a sweep"


def wrong_range(variable: str, unit: str, given: Range | None, scale: Scale | None) -> Iterator[str]:
    """Give what is wrong with the ends of an axis whose variable is shown in a unit."""
    if given is None:
        return
    try:
        low, high = ends(variable, unit, given)
    except UnitError as error:
        yield str(error)
        return
    if low >= high:
        yield f"must run from the lower end to the higher one, got {given[0]} to {given[1]}"
    if scale == "log" and low <= 0.0:
        yield f"a logarithmic axis must begin above zero, got {given[0]}"


def ends(variable: str, unit: str, given: Range) -> tuple[float, float]:
    """Return the ends of an axis in the unit in which its variable is shown.

    Raises
    ------
    UnitError
        If an end lacks a unit, or has one of another dimension.
    """
    due = Unit(unit, positive=False)
    plain = [isinstance(end, float) and not unit for end in given]
    low, high = (
        end if bare else from_si(due.si(end, variable), unit).magnitude for end, bare in zip(given, plain, strict=True)
    )
    return float(low), float(high)


def axis_along(grid: Grid, x: str, creepage: str) -> str:
    """Return the axis of a grid that a figure runs along: what its x says, else the creepage, else the longest.

    Where only a rig of other people knows what the load is, the axes that it names itself come before the creepage.
    """
    axes = grid.axes()
    loads = [name for name in axes if name in LOADS] or [name for name in axes if name not in UNITS]
    if x in axes:
        return x
    if x in OF_LOAD and loads:
        return loads[0]
    return creepage if creepage in axes or not axes else max(axes, key=lambda name: axes[name])
