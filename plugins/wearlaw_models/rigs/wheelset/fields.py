"""The fields of a profile: coordinates with a unit, and what is known beside them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray
from pydantic import GetJsonSchemaHandler
from pydantic_core import core_schema

import wearlaw as wl
from wearlaw import Array

CONVEX = {"wheel": -1.0, "rail": 1.0}
"""Sign of dθ/ds where a body is convex: the wheel lies above its profile, the rail below."""

KNOWN = "_known"
"""Key of what is known of a profile among its fields."""


class Fields(dict[str, Any]):
    """The fields of a profile with what is known of it."""

    lines: NDArray[np.intp] | None = None
    """Line of each point in its file."""
    worn: bool = False
    """Whether wearlaw wore it, so that nothing about its shape is doubted."""
    told: bool = False
    """Whether they were checked, and what is unlikely about them was told."""


class AnyCoordinates:
    """Makes pydantic accept coordinates: a quantity with one axis, or a table of values and their unit."""

    def __get_pydantic_core_schema__(self, source: object, handler: object) -> core_schema.CoreSchema:
        return core_schema.no_info_plain_validator_function(
            self._checked,
            serialization=core_schema.plain_serializer_function_ser_schema(self._table, when_used="json"),
        )

    def __get_pydantic_json_schema__(
        self, schema: core_schema.CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, object]:
        values = {"type": "array", "items": {"type": "number"}}
        properties = {"values": values, "unit": {"type": "string", "examples": ["mm"]}}
        return {"type": "object", "properties": properties, "required": ["values", "unit"]}

    def _checked(self, value: object) -> wl.Quantity:
        if isinstance(value, Mapping):
            if value.keys() != {"values", "unit"}:
                raise ValueError('give {values = [...], unit = "mm"}')
            value = wl.Q(value["values"], value["unit"])
        if not isinstance(value, wl.Quantity):
            raise ValueError(
                f'has no unit; give a quantity, such as Q([-1.0, 0.0, 1.0], "mm"), not a {type(value).__name__}'
            )
        wl.Unit("mm", positive=False).si(wl.Q(0.0, str(value.units)), "it")
        if np.ndim(value.magnitude) != 1:
            raise ValueError(f"must have one axis, got an array of shape {np.shape(value.magnitude)}")
        numbers = np.array(value.magnitude, dtype=np.float64)
        numbers.setflags(write=False)
        return wl.Q(numbers, str(value.units))

    @staticmethod
    def _table(value: wl.Quantity) -> dict[str, Any]:
        return {"values": value.magnitude.tolist(), "unit": f"{value.units:~C}"}


Coordinates = Annotated[wl.Quantity, AnyCoordinates()]
Angle = Annotated[wl.Quantity, wl.Unit("deg", positive=False)]
Shift = Annotated[wl.Quantity, wl.Unit("mm", positive=False)]


def metres(value: wl.Quantity) -> Array:
    """Return lengths in metres."""
    return np.asarray(value.magnitude * wl.scalar_si(wl.Q(1.0, str(value.units)), "m"))
