"""The materials of the bodies in contact."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

from pydantic import Field
from pydantic_core import core_schema

from wearlaw.configuration import Configuration, known_name
from wearlaw.units.quantities import Quantity, QuantityLike, Unit, scalar_si

ALIKE = 0.1
"""Relative difference in E and in ρ up to which two materials are alike. Grades of steel differ by less; bronze, cast
iron, titanium and aluminium differ from steel by more."""


TYPE = "type"
"""The key of a material's table that names its class, or the installed material that it is."""


class Material(Configuration):
    """An isotropic elastic material.

    Derive a class to give a material further properties; each field with a unit is kept by JSON, pickles, case files
    and reports. Files name the class in `type`, and a plugin makes it known there with the hook `wearlaw_named`.
    """

    _look_up: ClassVar[Callable[..., Any]]
    """Returns the installed material with a name and the given fields; set by the loader of plugins, which knows it."""

    youngs_modulus: Annotated[Quantity, Unit("GPa", usual=(1.0, 1200.0))]
    """Young's modulus, E [Pa]."""
    poisson_ratio: Annotated[float, Field(ge=0.0, le=0.5, strict=True)]
    """Poisson's ratio, ν [-]."""
    density: Annotated[Quantity, Unit("kg/m^3", usual=(500.0, 25000.0))]
    """Mass density, ρ [kg/m³]."""
    shear_yield_stress: Annotated[Quantity, Unit("GPa", usual=(1e-3, 10.0))] | None = None
    """Yield stress in shear, k [Pa]; None if not known, and then no contact counts as yielding."""

    if TYPE_CHECKING:  # checkers do not know that a text is accepted for a quantity

        def __init__(
            self,
            *,
            youngs_modulus: QuantityLike,
            poisson_ratio: float,
            density: QuantityLike,
            shear_yield_stress: QuantityLike | None = None,
        ) -> None: ...

    else:

        @classmethod
        def __get_pydantic_core_schema__(cls, source: Any, handler: Any) -> Any:
            """Return the schema of the class; it reads and writes materials of derived classes as what they are."""
            schema = handler(source)
            return core_schema.no_info_before_validator_function(
                cls._of_table,
                schema,
                serialization=core_schema.wrap_serializer_function_ser_schema(
                    partial(_table, cls), schema=schema, info_arg=True
                ),
            )

    @classmethod
    def _of_table(cls, value: Any) -> Any:
        """Return the material of a table that names its type, or its fields if the type is this class."""
        if not isinstance(value, Mapping) or TYPE not in value:
            return value
        fields = {name: field for name, field in value.items() if name != TYPE}
        return fields if value[TYPE] == cls.__name__ else cls._look_up(value[TYPE], **fields)

    def resembles(self, other: Material) -> bool:
        """Return whether E and ρ differ from those of another material by at most a tenth.

        This tells bronze from steel, but not one grade of steel from another.
        """
        pairs = (
            (scalar_si(self.youngs_modulus, "Pa"), scalar_si(other.youngs_modulus, "Pa")),
            (scalar_si(self.density, "kg/m^3"), scalar_si(other.density, "kg/m^3")),
        )
        return all(abs(ours - theirs) <= ALIKE * theirs for ours, theirs in pairs)


def _table(
    cls: type[Material],
    material: Material,
    handler: core_schema.SerializerFunctionWrapHandler,
    info: core_schema.SerializationInfo,
) -> dict[str, Any]:
    """Return a material as a table of all its fields, with `type` unless it is a plain material without a name."""
    if type(material) is not cls:  # the handler would leave out the fields of a derived class
        return material.model_dump(mode=info.mode, by_alias=info.by_alias, exclude_none=info.exclude_none)
    name = known_name(material) or (None if cls is Material else cls.__name__)
    return {**({TYPE: name} if name else {}), **handler(material)}


def dundurs_beta(material_1: Material, material_2: Material) -> float:
    """Return Dundurs' β [-] of two bodies, from -1/2 to 1/2: how far normal and tangential displacement are coupled.

    β = [(1-2ν1)/G1 - (1-2ν2)/G2] / [(1-ν1)/G1 + (1-ν2)/G2] / 2 is zero for like materials, and for two incompressible
    ones.

    Notes
    -----
    K. L. Johnson, Contact Mechanics, Cambridge University Press, 1985.
    """
    (soft_1, ratio_1), (soft_2, ratio_2) = (
        ((1.0 + material.poisson_ratio) / scalar_si(material.youngs_modulus, "Pa"), material.poisson_ratio)
        for material in (material_1, material_2)
    )
    difference = (1.0 - 2.0 * ratio_1) * soft_1 - (1.0 - 2.0 * ratio_2) * soft_2
    return 0.5 * difference / ((1.0 - ratio_1) * soft_1 + (1.0 - ratio_2) * soft_2)
