"""Units at the rim: quantities come in and go out with units, plain SI floats live inside.

`Q(7.4, "kN")` makes a quantity, `Unit` says which unit a field or argument is due, checks what it is
given and hands on SI floats. Everything uses pint's application registry, looked up when it is needed,
so that quantities made by other packages and by `pint.set_application_registry` fit in.
"""

from __future__ import annotations

import functools
import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any, TypeAlias

import numpy as np
import pint
from pydantic_core import core_schema

from wearlaw.errors import UnitError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray
    from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler

    Quantity: TypeAlias = pint.Quantity[Any]
else:
    Quantity = pint.Quantity

QuantityLike: TypeAlias = "Quantity | str"
"""A quantity, or its text such as "47 mm"."""

_SIGNIFICANT_DIGITS = 4


def Q(value: ArrayLike, unit: str) -> Quantity:
    """Return `value` with its unit, as a pint quantity.

    Parameters
    ----------
    value : array_like
        A number or an array of numbers.
    unit : str
        Its unit, such as "kN", "%" or "ug/m/mm^2"; "" for a ratio.

    Returns
    -------
    pint.Quantity
        Its `repr` shows four significant digits; `.magnitude` holds all of them.

    Raises
    ------
    UnitError
        If the unit is not known, or the value is no real number.
    """
    registry = _registry()
    magnitude: Any = value if type(value) in (int, float) else real_array(value)
    quantity: Quantity = _quantity_class(registry)(magnitude, _parse_unit(registry, unit))
    return quantity


def parse(text: str) -> Quantity:
    """Return the quantity that a text such as "47 mm" or "1e-3 %" stands for.

    Raises
    ------
    UnitError
        If the text is not a number followed by a known unit.
    """
    match = _QUANTITY_TEXT.fullmatch(text)
    if match is None:
        raise UnitError(f"'{text}' is not a number with a unit")
    return Q(float(match["number"]), match["unit"])


def text_of(quantity: Quantity) -> str:
    """Return the text that `parse` reads back to the same scalar quantity, to the last digit."""
    return f"{float(quantity.magnitude)!r} {quantity.units:~C}".strip()


_QUANTITY_TEXT = re.compile(
    r"\s*(?P<number>[+-]?(?:(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?|inf|nan))\s*(?P<unit>(?:[^\d\s+.-].*)?)"
)


@dataclass(frozen=True)
class Unit:
    """The unit that a field or argument is due, with the bounds of its value.

    Used in an annotation, ``Annotated[Quantity, Unit("mm")]``, it makes pydantic accept a quantity of that
    dimension, or a text such as "47 mm"; everything else is an error that names the field.

    Parameters
    ----------
    unit : str
        The customary unit, shown in messages and in the schema; "" for a ratio such as creepage.
    positive : bool
        Whether the value must be greater than zero.
    limit : float
        The largest magnitude allowed, in `unit`.
    infinite : bool
        Whether infinity is allowed, as for the diameter of a flat body.
    """

    unit: str
    positive: bool = True
    limit: float = np.inf
    infinite: bool = False

    def si(self, value: object, name: str) -> NDArray[np.float64]:
        """Return `value` as SI floats, or raise a `UnitError` that names the argument.

        Parameters
        ----------
        value : Quantity or str
            What the user gave, of any shape.
        name : str
            The argument's name, for the message.

        Returns
        -------
        ndarray of float64
            The value in the coherent SI unit of this dimension; memory is shared where nothing changes.
        """
        try:
            return self._checked(value)[1]
        except UnitError as error:
            raise UnitError(f"{name}: {error}; {self._fix(name)}") from None

    def _checked(self, value: object) -> tuple[Quantity, NDArray[np.float64]]:
        quantity = self._as_quantity(value)
        magnitude = real_array(quantity.magnitude)
        factor = _si_factor(_registry(), quantity.units, self.unit)
        in_si = magnitude if factor == 1.0 else magnitude * factor
        if np.isnan(in_si).any():
            raise UnitError(f"must be a number, got {quantity!r}")
        if not self.infinite and np.isinf(in_si).any():
            raise UnitError(f"must be finite, got {quantity!r}")
        if self.positive and not (in_si > 0).all():
            raise UnitError(f"must be greater than zero, got {quantity!r}")
        if (np.abs(in_si) > self.limit * _unit_in_si(self.unit)).any():
            raise UnitError(f"must not exceed {self.limit:g} {self.unit}".rstrip() + f" in magnitude, got {quantity!r}")
        return quantity, in_si

    @staticmethod
    def _as_quantity(value: object) -> Quantity:
        if isinstance(value, str):
            return parse(value)
        if not isinstance(value, pint.Quantity):
            raise UnitError(f"got {_describe(value)}, which has no unit")
        quantity: Quantity = value
        if quantity._REGISTRY is not _registry():
            return Q(quantity.magnitude, str(quantity.units))
        return quantity

    def _fix(self, name: str) -> str:
        if self.unit == "":
            return f'give {name} in percent or as a ratio, such as Q(1, "%") or Q(0.01, "")'
        return f'give {name} in {self.unit} or another unit of that dimension, such as Q(1.0, "{self.unit}")'

    def __get_pydantic_core_schema__(self, source: object, handler: GetCoreSchemaHandler) -> core_schema.CoreSchema:
        return core_schema.no_info_plain_validator_function(
            self._scalar,
            serialization=core_schema.plain_serializer_function_ser_schema(text_of, when_used="json"),
        )

    def __get_pydantic_json_schema__(
        self, schema: core_schema.CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, object]:
        return {"type": "string", "description": f"a number with a unit such as '1.0 {self.unit}'".rstrip()}

    def _scalar(self, value: object) -> Quantity:
        try:
            quantity, in_si = self._checked(value)
        except UnitError as error:
            raise UnitError(f"{error}; {self._fix('it')}") from None
        if in_si.ndim != 0:
            raise UnitError(f"must be one value, got an array of shape {in_si.shape}")
        return Q(float(quantity.magnitude), str(quantity.units))


def real_array(value: object) -> NDArray[np.float64]:
    """Return `value` as float64, refusing what is no real number: booleans, complex, text, masked entries."""
    if np.ma.is_masked(value):
        raise UnitError("masked entries have no value")
    try:
        array = np.asarray(value)
    except (TypeError, ValueError):
        raise UnitError(f"{_describe(value)} is not an array of numbers") from None
    if array.dtype.kind not in "iuf":
        raise UnitError(f"{_describe(value)} is not a real number")
    return array.astype(np.float64, copy=False)


def coefficient(value: object, name: str) -> NDArray[np.float64]:
    """Return a positive, finite number without unit, such as a friction coefficient, as float64.

    Raises
    ------
    UnitError
        If it has a dimension, or is no positive finite real number.
    """
    if isinstance(value, pint.Quantity):
        return Unit("").si(value, name)
    try:
        array = real_array(value)
    except UnitError as error:
        raise UnitError(f"{name}: {error}; give {name} as a plain number, such as 0.46") from None
    if not (np.isfinite(array) & (array > 0)).all():
        raise UnitError(f"{name}: must be a positive finite number, got {_describe(value)}")
    return array


def scalar_si(quantity: Quantity, unit: str) -> float:
    """Return the SI value of a scalar quantity that has been validated before."""
    return float(quantity.magnitude) * _si_factor(quantity._REGISTRY, quantity.units, unit)


def from_si(value: NDArray[np.float64] | float, unit: str) -> Quantity:
    """Return SI floats as a quantity in `unit`; arrays without axes become plain numbers."""
    scaled = np.asarray(value) / _unit_in_si(unit)
    return Q(float(scaled) if scaled.ndim == 0 else scaled, unit)


Length = Annotated[Quantity, Unit("mm")]
Speed = Annotated[Quantity, Unit("m/s")]
Stress = Annotated[Quantity, Unit("GPa")]
Density = Annotated[Quantity, Unit("kg/m^3")]
WEAR_RATE = "ug/m/mm^2"
"""The unit in which wear rates are shown: mass lost per metre rolled and contact area."""


def _describe(value: object) -> str:
    shown = repr(value)
    if len(shown) > 60:
        shown = shown[:57] + "..."
    kind = "the bare number " if isinstance(value, (int, float)) and not isinstance(value, bool) else ""
    return f"{kind}{shown}"


def _registry() -> pint.UnitRegistry[Any]:
    application_registry: Any = pint.application_registry
    registry: pint.UnitRegistry[Any] = application_registry.get()
    return registry


@functools.lru_cache(maxsize=512)
def _parse_unit(registry: pint.UnitRegistry[Any], unit: str) -> pint.Unit:
    try:
        return registry.Unit(unit)
    except pint.UndefinedUnitError:
        raise UnitError(f"'{unit}' is not a known unit") from None
    except Exception:  # the registry's expression parser raises errors of many types on malformed text
        raise UnitError(f"'{unit}' is not a unit") from None


@functools.lru_cache(maxsize=512)
def _si_factor(registry: pint.UnitRegistry[Any], given: pint.Unit, due: str) -> float:
    """Return the factor from `given` to the coherent SI unit of the dimension of `due`."""
    due_unit = _parse_unit(registry, due)
    if given.dimensionality != due_unit.dimensionality:
        shown = f"'{given:~P}'" if str(given) != "dimensionless" else "no unit"
        raise UnitError(f"got a value in {shown}, which is not of the dimension of '{due}'")
    zero, one = (registry.convert(value, given, due_unit) for value in (0.0, 1.0))
    if zero != 0.0:  # degrees Celsius, decibel
        raise UnitError(f"'{given:~P}' is not proportional to '{due}'")
    return float(one) * _unit_in_si(due)


def _unit_in_si(unit: str) -> float:
    return _coherent(_registry(), unit)


@functools.lru_cache(maxsize=512)
def _coherent(registry: pint.UnitRegistry[Any], unit: str) -> float:
    """Return the factor from a unit to the coherent SI unit of its dimension."""
    parsed = _parse_unit(registry, unit)
    in_root_units: Any = registry.get_root_units(parsed)[0]
    mass_exponent: Any = parsed.dimensionality.get("[mass]", 0)
    # pint's root unit of mass is the gram; all its other root units are those of SI.
    return float(in_root_units / 1000.0**mass_exponent)


@functools.lru_cache(maxsize=64)
def _quantity_class(registry: pint.UnitRegistry[Any]) -> type[Any]:
    """Return the registry's quantity class with a repr that a reader of wear rates can read."""

    class ReadableQuantity(registry.Quantity):  # type: ignore[misc, name-defined]
        def __repr__(self) -> str:
            return f"{_digits(self.magnitude)} {self.units:~P}".rstrip()

        def __reduce__(self) -> tuple[Any, ...]:
            return Q, (self.magnitude, str(self.units))

    return ReadableQuantity


def _digits(magnitude: Any) -> str:
    def one(number: Any) -> str:
        return f"{number:#.{_SIGNIFICANT_DIGITS}g}".rstrip(".")

    if np.ndim(magnitude) == 0:
        return one(magnitude) if isinstance(magnitude, (int, float, np.number)) else repr(magnitude)
    formatter: Any = {"float_kind": one}
    return np.array2string(np.asarray(magnitude), formatter=formatter)
