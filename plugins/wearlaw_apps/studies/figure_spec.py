"""Figures as a case file describes them: variables, models, and ranges of the axes."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, GetJsonSchemaHandler, model_validator
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema

from wearlaw.configuration import Configuration
from wearlaw.errors import ConfigurationError, Fault
from wearlaw.models.law import WEAR
from wearlaw.pipeline.variables import MASS, OF_CONTACT, OF_PATCH, OF_POINT
from wearlaw.units.variables import OWNERS, is_text

OF_PROFILE = ("pressure", "traction", "traction_bound", "slip", "wear_rate", "creepage")
"""Variables along the patch of a line contact; the creepage of the operating point is a horizontal line."""

ACROSS = ("depth", "sliding_distance")
"""Variables across the patch of an elliptic contact, for one of the bodies."""

COMMON = ("pressure", "creepage")
"""Variables along the patch that are the same for all contact models: Hertz's pressure, and the creepage."""

Scale = Literal["linear", "log"]


def _several(value: Any) -> Any:
    return (value,) if isinstance(value, str | int) else value


class _Schema:
    """The JSON Schema of names of variables, with those that installed models declare."""

    def __init__(self, *first: str, several: bool = False) -> None:
        self.first, self.several = first, several

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: GetJsonSchemaHandler) -> JsonSchemaValue:
        declared = (name for name in OWNERS if not is_text(name))
        names = {"enum": list(dict.fromkeys((*self.first, *OF_CONTACT, *OF_POINT, *OF_PATCH, *declared)))}
        return {"anyOf": [names, {"type": "array", "items": names, "minItems": 1}]} if self.several else names


_SHOWN = (WEAR, MASS, *OF_PROFILE, *ACROSS)

Variables = Annotated[tuple[str, ...], BeforeValidator(_several), Field(min_length=1), _Schema(*_SHOWN, several=True)]
"""One variable, or several with the same unit."""

_LABELS = Annotated[tuple[str | int, ...], Field(min_length=1)]

Labels = Annotated[_LABELS, BeforeValidator(_several, json_schema_input_type=str | int | _LABELS)]
"""One label of an axis of patches, or several."""

Range = tuple[float | str, float | str]
"""Two ends of an axis, each with its unit if the variable has one."""


class Window(Configuration):
    """A panel of a figure. It inherits all fields but the title from the figure."""

    title: str = ""
    """Title above the panel."""
    y: Variables | None = None
    """The variable to show, or several with the same unit."""
    patches: dict[str, Labels] | None = None
    """The patches to show if the rig makes several, such as { side = "right", patch = 1 }. Default: all."""
    body: str | None = None
    """The body whose wear across the patch is shown, such as "wheel". Default: the first of the rig."""
    x_range: Range | None = None
    """Ends of the x axis, such as ["0 N", "70 N"]. Default: those of the curves."""
    y_range: Range | None = None
    """Ends of the y axis. Default: all values are visible."""
    x_scale: Scale | None = None
    """Linear or logarithmic x axis. Default: linear."""
    y_scale: Scale | None = None
    """Linear or logarithmic y axis. Default: linear."""

    @property
    def shown(self) -> tuple[str, ...]:
        """The variables to show."""
        return self.y or ()


class FigureSpec(Window):
    """A figure of a sweep, or of a profile of the patch."""

    caption: str = ""
    """The caption. Default: the conditions."""
    sweep: str | None = None
    """The sweep to show; give this or `profile`."""
    profile: str | None = None
    """The profile to show."""
    x: Annotated[str, _Schema("x", "y")] = "x"
    """The variable along the x axis. For a profile it is the position: "x" along the patch or "y" across it.
    An outcome of a law can stand there if each contact model has at most one pair with that outcome."""
    pairs: Annotated[tuple[str, ...], Field(min_length=1)] | None = None
    """The pairs whose wear rates or other outcomes are shown, such as "usfd on exact". Default: all."""
    contact_models: Annotated[tuple[str, ...], Field(min_length=1)] | None = None
    """The contact models whose other variables are shown. Default: all."""
    map: Annotated[str, _Schema(*_SHOWN)] | None = None
    """A variable to show in colours over two axes of a sweep, `x` and `y`. Each pair or contact model has a panel."""
    measured: bool = False
    """Whether to show the measured tests."""
    regimes: bool = False
    """Whether to show where the regimes of the laws change, for laws of patch means."""
    panels: tuple[Window, ...] = ()
    """Several panels, such as the whole and an enlarged part. Default: one."""

    @model_validator(mode="after")
    def _possible(self) -> FigureSpec:
        wrong = []
        if (self.sweep is None) == (self.profile is None):
            wrong.append(Fault(("sweep",), "give either sweep or profile, which the figure shows"))
        for number, window in enumerate(self.windows()):
            if not window.y:
                wrong.append(Fault((*(("panels", str(number)) if self.panels else ()), "y"), "is missing"))
        if self.map and (len(self.shown) != 1 or self.shown[0] == self.x):
            wrong.append(Fault(("y",), "a map runs over two axes of the sweep; name the other one as y"))
        if self.map:
            other = [name for name in ("profile", "panels", "measured", "body", "regimes") if getattr(self, name)]
            wrong += [Fault((name,), "a map does not take it; leave it out") for name in other]
        if self.measured and self.profile:
            wrong.append(Fault(("measured",), "tests are measured over the whole patch; show a sweep"))
        if wrong:
            raise ConfigurationError("figure", wrong)
        return self

    def windows(self) -> tuple[Window, ...]:
        """Return the panels, each with the fields that it inherits."""
        inherited = ("y", "patches", "body", "x_range", "y_range", "x_scale", "y_scale")
        common = {name: getattr(self, name) for name in inherited}
        panels = [{name: value for name, value in panel if value is not None} for panel in self.panels] or [{}]
        return tuple(Window(**{**common, **window}) for window in panels)
