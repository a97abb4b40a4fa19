"""Wear coefficients as papers print them, and the conversion from one form to another."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal, TypeAlias, overload

import wearlaw as wl

PlainForm: TypeAlias = Literal["k", "k_of_3h"]

FormWithUnit: TypeAlias = Literal["volume_per_load", "mass_per_load", "volume_per_energy", "mass_per_energy"]


@dataclass(frozen=True)
class _Form:
    """A form of the wear coefficient: `factor` H^hardness ρ^density μ^friction_coefficient times V/(N s)."""

    formula: str
    unit: str
    factor: float = 1.0
    hardness: int = 0
    density: int = 0
    friction_coefficient: int = 0


FORMS: Mapping[str, _Form] = {
    "k": _Form("V = k N s / H", "", hardness=1),
    "k_of_3h": _Form("V = k N s / (3 H)", "", hardness=1, factor=3.0),
    "volume_per_load": _Form("V = k N s", "mm^3/N/m"),
    "mass_per_load": _Form("m = k N s", "ug/N/m", density=1),
    "volume_per_energy": _Form("V = k E", "mm^3/J", friction_coefficient=-1),
    "mass_per_energy": _Form("m = k E", "ug/J", density=1, friction_coefficient=-1),
}
"""The forms by name."""


@overload
def wear_coefficient(
    value: wl.QuantityLike | float,
    form: PlainForm | FormWithUnit,
    *,
    to: PlainForm,
    hardness: wl.QuantityLike | None = ...,
    density: wl.QuantityLike | None = ...,
    friction_coefficient: float | None = ...,
) -> float: ...
@overload
def wear_coefficient(
    value: wl.QuantityLike | float,
    form: PlainForm | FormWithUnit,
    *,
    to: FormWithUnit,
    hardness: wl.QuantityLike | None = ...,
    density: wl.QuantityLike | None = ...,
    friction_coefficient: float | None = ...,
) -> wl.Quantity: ...
def wear_coefficient(
    value: wl.QuantityLike | float,
    form: str,
    *,
    to: str,
    hardness: wl.QuantityLike | None = None,
    density: wl.QuantityLike | None = None,
    friction_coefficient: float | None = None,
) -> wl.Quantity | float:
    """Return a published wear coefficient in another form.

    A unit does not tell the form: m³/(N m), m²/N and 1/Pa are the same as m³/J, but a volume per load and sliding
    distance is μ times the volume per energy. So name both forms.

    ===================== ========================== ==================================================
    form                  meaning                    unit
    ===================== ========================== ==================================================
    "k"                   V = k N s / H              none
    "k_of_3h"             V = k N s / (3 H)          none
    "volume_per_load"     V = k N s                  mm³/(N m), m²/N, 1/Pa; also called specific wear rate or k/H
    "mass_per_load"       m = k N s                  µg/(N m)
    "volume_per_energy"   V = k E                    mm³/J
    "mass_per_energy"     m = k E                    µg/J, µg/m/N
    ===================== ========================== ==================================================

    V is the worn volume and m the worn mass of one body, N the normal force, s the sliding distance, H the hardness,
    and E = μ N s the energy of friction.

    Parameters
    ----------
    value : Quantity, str or float
        The published coefficient; a plain number for "k" and "k_of_3h".
    form : str
        Its form.
    to : str
        The form to convert it to.
    hardness : Quantity or str, optional
        H [Pa], to convert between one of the plain numbers and another form; that of the paper.
    density : Quantity or str, optional
        ρ of the body that wears [kg/m³], to convert between a volume and a mass.
    friction_coefficient : float, optional
        μ of the test, to convert between load and energy.

    Returns
    -------
    Quantity or float
        The coefficient, a plain number for "k" and "k_of_3h".

    Raises
    ------
    InputError
        If a form is unknown, or the conversion needs a value that is not given.
    UnitError
        If a value lacks the unit of its form, or is not positive.

    Notes
    -----
    J. F. Archard, J. Appl. Phys. 24 (1953) 981-988.
    """
    source, target = _form(form, "form"), _form(to, "to")
    try:
        result = _scalar(value, source.unit, "value") * target.factor / source.factor
    except wl.UnitError as error:
        raise wl.UnitError(f"{form}, {source.formula}: {error}") from None
    properties = {"hardness": hardness, "density": density, "friction_coefficient": friction_coefficient}
    numbers = {
        name: _scalar(quantity, EXAMPLES[name][1], name)
        for name, quantity in properties.items()
        if quantity is not None
    }
    powers = {name: getattr(target, name) - getattr(source, name) for name in properties}
    missing = [EXAMPLES[name][0] for name, power in powers.items() if power and name not in numbers]
    if missing:
        raise wl.InputError(
            f"{to}, {target.formula}, from {form}, {source.formula}, needs values of your source: {', '.join(missing)}"
        )
    result *= float(math.prod(numbers[name] ** power for name, power in powers.items() if power))
    if not 0.0 < result < math.inf:
        raise wl.InputError(f"value: as {to}, {target.formula}, it is too small or too large; check the values")
    if not target.unit:
        return result
    return wl.Q(result / wl.scalar_si(wl.Q(1.0, target.unit), target.unit), target.unit)


EXAMPLES = {
    "hardness": ('hardness="2.6 GPa"', "GPa"),
    "density": ('density="7850 kg/m^3"', "kg/m^3"),
    "friction_coefficient": ("friction_coefficient=0.45", ""),
}
"""The arguments as messages show them, with their units."""


def _form(form: str, argument: str) -> _Form:
    if form not in FORMS:
        forms = "; ".join(f"{name}, {entry.formula}" for name, entry in FORMS.items())
        raise wl.InputError(f"{argument}: no form {wl.shown(form)}; there are: {forms}")
    return FORMS[form]


def _scalar(value: Any, unit: str, name: str) -> float:
    array = wl.Unit(unit).si(value, name) if unit else wl.coefficient(value, name)
    if array.ndim:
        raise wl.InputError(f"{name}: must be one value, got an array of shape {array.shape}")
    return float(array)
