"""Archard's wear law with the hardness of the body that wears."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Self

import numpy as np
from pydantic import Field

import wearlaw as wl
from wearlaw import Array
from wearlaw_models.laws.archard.coefficients import FORMS as FORMS
from wearlaw_models.laws.archard.coefficients import wear_coefficient as wear_coefficient

PASCAL = wl.Unit("GPa")
Hardness = Annotated[wl.Quantity, wl.Unit("GPa", usual=(0.05, 100.0))]


class SteelWithHardness(wl.Material):
    """A steel with its hardness; the defaults of all other fields are those of `wearlaw.steel`."""

    youngs_modulus: Annotated[wl.Quantity, wl.Unit("GPa", usual=(1.0, 1200.0))] = Field(
        default="206.47742 GPa", validate_default=True
    )
    """Young's modulus, E [Pa]."""
    poisson_ratio: Annotated[float, Field(ge=0.0, le=0.5, strict=True)] = 0.28
    """Poisson's ratio, ν [-]."""
    density: Annotated[wl.Quantity, wl.Unit("kg/m^3", usual=(500.0, 25000.0))] = Field(
        default="7850 kg/m^3", validate_default=True
    )
    """Mass density, ρ [kg/m³]."""
    shear_yield_stress: Annotated[wl.Quantity, wl.Unit("GPa", usual=(1e-3, 10.0))] | None = Field(
        default="541.3 MPa", validate_default=True
    )
    """Yield stress in shear, k [Pa]; None if not known, and then no contact counts as yielding."""
    hardness: Hardness
    """Hardness, H [Pa]. A Brinell or Vickers number is in kgf/mm²."""
    source: str | None = None
    """Where the hardness and the yield stress are from."""

    if TYPE_CHECKING:  # checkers do not know that a text is accepted for a quantity

        def __init__(
            self,
            *,
            youngs_modulus: wl.QuantityLike = ...,
            poisson_ratio: float = ...,
            density: wl.QuantityLike = ...,
            shear_yield_stress: wl.QuantityLike | None = ...,
            hardness: wl.QuantityLike,
            source: str | None = ...,
        ) -> None: ...

    def model_copy(self, *, update: Mapping[str, Any] | None = None, deep: bool = False) -> Self:
        """Return a copy with some fields changed; another hardness or yield stress has not the same source."""
        if update and not {"hardness", "shear_yield_stress"}.isdisjoint(update):
            update = {"source": None, **update}
        return super().model_copy(update=update, deep=deep)


HARDNESS_OF_RAILS = {
    "R200": (200, 240),
    "R220": (220, 260),
    "R260": (260, 300),
    "R260Mn": (260, 300),
    "R320Cr": (320, 360),
    "R350HT": (350, 390),
    "R350LHT": (350, 390),
}
"""Brinell numbers [kgf/mm²] of rail steels by EN 13674-1:2008, as printed in the railway track manual of ThyssenKrupp
GfT Gleistechnik, page 211-07 (2010)."""


def _rail_steel(least: int, greatest: int) -> SteelWithHardness:
    """Return a rail steel of the least hardness that the standard allows, with k from it as in `wearlaw.steel`."""
    yield_stress = least * 9.80665 / (2.8 * 3.0**0.5)  # Tabor, then von Mises [MPa]
    return SteelWithHardness(
        hardness=f"{least} kgf/mm^2",
        shear_yield_stress=f"{yield_stress:.4g} MPa",
        source=(
            f"hardness: the least of EN 13674-1:2008, {least} to {greatest} HBW, as printed in ThyssenKrupp"
            " GfT Gleistechnik, Railway track manual, page 211-07; shear_yield_stress: an estimate from"
            " the hardness, H/(2.8 √3)"
        ),
    )


class Archard(wl.WearLaw):
    """Archard's law V = k N s / H with one wear coefficient k; at a node, ρ k p s / H.

    k is dimensionless. Some sources print V = k N s / (3H), with a k three times as large; `wearlaw.wear_coefficient`
    converts it. H and the density ρ are those of the body that wears. If you give no hardness, it is the field
    `hardness` of the body's material, such as a `SteelWithHardness`.

    Prefer this law where k was measured under one regime of wear. It can't tell mild from severe wear or seizure; use
    `kth` for Archard's law with a map of k. The law holds as long as p is well below H, since p/H is the share of the
    surface that touches: at a p beyond H it still returns a number, without a meaning.
    """

    name: ClassVar[str] = "archard"
    source: ClassVar[str] = "J. F. Archard, J. Appl. Phys. 24 (1953) 981-988"
    monotone_in: ClassVar[tuple[wl.LawVariable, ...]] = ("pressure", "slip")
    follows_pressure_times_slip: ClassVar[bool] = True
    example_fields: ClassVar[Mapping[str, Any]] = {"coefficient": 1e-4}

    coefficient: Annotated[float, Field(gt=0.0, strict=True, examples=["1e-4"]), wl.Unit("", usual=(1e-10, 0.1))]
    """Wear coefficient of V = k N s / H, k [-]."""
    hardness: Hardness | None = Field(default=None, examples=["2.6 GPa"])
    """Hardness of the body that wears, H [Pa]; None for that of its material."""

    def rate(self, contact: wl.Contact, p: wl.Numbers) -> Array:
        """Return the wear rate at the nodes [kg/m/m²]."""
        hardness = p["hardness"] if "hardness" in p else _hardness_of_material(contact)
        density = contact.per_node(contact.density)
        rate: Array = density * p["coefficient"] * contact.pressure * np.abs(contact.slip) / hardness
        return rate

    def breakpoints(self, p: wl.Numbers) -> wl.BreakpointMap:  # noqa: ARG002
        """Return nothing: the law is smooth."""
        return {}

    @property
    def example_material(self) -> wl.Material:
        """A steel with a hardness, for the checks."""
        return SteelWithHardness(hardness="2.6 GPa")


def _hardness_of_material(contact: wl.Contact) -> float:
    """Return the hardness of the material of the body that wears [Pa]."""
    remedy = 'give the law its field hardness, such as hardness="2.6 GPa"'
    if contact.problem is None:
        raise wl.InputError(
            "hardness: wear law 'archard' needs it, but this contact was solved elsewhere, so the material of its"
            f" bodies is not known; {remedy}"
        )
    material = contact.body().material
    hardness, name = getattr(material, "hardness", None), next(iter(contact.problem.bodies))
    if hardness is None:
        raise wl.InputError(
            f"hardness: wear law 'archard' needs it, but the material of {name}, a {type(material).__name__}, has none;"
            f" give {name} a material with a hardness, such as a SteelWithHardness, or {remedy}"
        )
    return float(PASCAL.si(hardness, f"hardness of the material of {name}"))


@wl.hookimpl
def wearlaw_models() -> list[type[wl.WearLaw]]:
    """Return the law of this plugin."""
    return [Archard]


@wl.hookimpl
def wearlaw_named() -> dict[str, wl.Material | type[wl.Material]]:
    """Return the class of steels with a hardness, so that files can name it, and the rail steels of EN 13674-1."""
    rails = {name: _rail_steel(*numbers) for name, numbers in HARDNESS_OF_RAILS.items()}
    return {"SteelWithHardness": SteelWithHardness, **rails}
