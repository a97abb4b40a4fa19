"""Units at the interface: users give and get quantities with units, and wearlaw computes in plain SI floats.

`Q(7.4, "kN")` makes a quantity. `Unit` states the expected unit of a field or argument, checks the value and returns SI
floats. All functions look up pint's application registry at each use, so that they accept quantities from other
packages and from `pint.set_application_registry`.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Annotated, Any, TypeAlias, TypeGuard

import numpy as np
import pint
from pydantic_core import core_schema

from wearlaw.arrays import extremes
from wearlaw.errors import UnitError, WearlawWarning, shown, warn
from wearlaw.units.registry import HARDNESS, divided, quantity, si_factor, symbol, unit_in_si
from wearlaw.units.registry import from_si as from_si
from wearlaw.units.usual import in_words, likely_slip, remark

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import ArrayLike, NDArray
    from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler

    Quantity: TypeAlias = pint.Quantity[Any]
else:
    Quantity = pint.Quantity

QuantityLike: TypeAlias = Quantity | str | Sequence[Quantity | str]
"""A quantity, or its text such as "47 mm", or a list of these."""


def Q(value: ArrayLike, unit: str) -> Quantity:
    """Return `value` with its unit, as a pint quantity.

    Parameters
    ----------
    value : array_like
        A number or an array of numbers.
    unit : str
        Its unit, such as "kN", "%" or "ug/m/mm^2"; "" for a ratio. HB and HV are kgf/mm², with a warning that says so.

    Returns
    -------
    pint.Quantity
        Its `repr` shows four significant digits; `.magnitude` holds all of them.

    Raises
    ------
    UnitError
        If the unit is not known, or the value is not a real number.
    """
    magnitude: Any = value
    if type(value) not in (int, float):
        array = real_array(value)
        magnitude = float(array) if array.ndim == 0 else array
    result: Quantity = quantity(magnitude, unit)
    if HARDNESS.fullmatch(str(unit)):
        warn(
            f"{unit}: taken as kgf/mm², here {from_si(result.to('Pa').magnitude, 'GPa')!r}: the load over the surface"
            " of the indentation, for Brinell and Vickers alike; over its projected area it is up to 11 % more",
            WearlawWarning,
        )
    return result


def parse(value: QuantityLike) -> Quantity:
    """Return the quantity of a text such as "47 mm", "1e-3 %" or "0.01 dimensionless".

    A list of texts or quantities becomes one quantity, in the unit of the first. A quantity stays as it is.

    Raises
    ------
    UnitError
        If a text is not a number followed by a known unit, or the dimensions in a list differ.
    """
    if isinstance(value, pint.Quantity):
        return value
    if with_units(value):
        first, *others = map(parse, value)
        try:
            return Q([first.magnitude, *(entry.m_as(first.units) for entry in others)], str(first.units))
        except pint.DimensionalityError as error:
            raise UnitError(f"{shown(value)}: {error}") from None
    match = _QUANTITY_TEXT.fullmatch(value) if isinstance(value, str) else None
    if match is not None and re.match(r",\d", match["unit"]):
        raise UnitError(f"{shown(value)} has a decimal comma; write a decimal point")
    if match is None or not match["unit"]:
        raise UnitError(f"{shown(value)} is not a number with a unit")
    return Q(float(match["number"]), match["unit"])


def with_units(value: object) -> TypeGuard[Sequence[Quantity | str]]:
    """Return whether a value is a list of quantities or their texts, such as [Q(1, "kN"), "2 kN"]."""
    return (
        isinstance(value, list | tuple) and bool(value) and all(isinstance(item, pint.Quantity | str) for item in value)
    )


def text_of(value: object) -> str:
    """Return the text of a scalar quantity, which `parse` reads back exactly; of any other value, its `str`."""
    if not isinstance(value, pint.Quantity):
        return str(value)
    return f"{float(value.magnitude)!r} {symbol(value.units, '~P') or 'dimensionless'}"


_QUANTITY_TEXT = re.compile(
    r"\s*(?P<number>[+-]?(?:(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?|inf|nan))\s*(?P<unit>(?:(?:(?<=\s)1(?=\s*/)|[^\d\s+.-]).*)?)"
)


@dataclass(frozen=True)
class Unit:
    """The expected unit of a field or argument, with the bounds of its value.

    In an annotation, ``Annotated[Quantity, Unit("mm")]``, it makes pydantic accept a quantity of that dimension, or a
    text such as "47 mm". Every other value raises an error that names the field.

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
    negative : bool
        Whether a value that need not be positive may be negative.
    usual : tuple of float, optional
        The least and the greatest value that people usually have, in `unit`. A value outside gets an `UnusualWarning`
        with the slip of unit that is likely. Choose the ends so generously that ordinary values never do. Small values
        of an array are usual beside greater ones, and so is zero where it is allowed, as of a load where a wheel lifts.

    Raises
    ------
    UnitError
        If the least usual value is not below the greatest.

    Notes
    -----
    ``Annotated[float, Unit("", usual=(1e-8, 0.1))]`` is a field of a plain number, for which it states what is usual.
    """

    unit: str
    positive: bool = True
    limit: float = np.inf
    infinite: bool = False
    negative: bool = True
    usual: tuple[float, float] | None = None

    def __post_init__(self) -> None:
        """Check the range of usual values."""
        if self.usual is None:
            return
        try:
            low, high = map(float, self.usual)
            ordered = low < high
        except (TypeError, ValueError):
            ordered = False
        if not ordered:
            raise UnitError(
                f"usual: must be the least and the greatest usual value in {self.unit or 'plain numbers'}, such as"
                f" (0.1, 10), got {shown(self.usual)}"
            )

    def si(self, value: object, name: str) -> NDArray[np.float64]:
        """Return `value` as SI floats, or raise a `UnitError` that names the argument.

        Parameters
        ----------
        value : Quantity or str
            The user's value, of any shape.
        name : str
            The argument's name, for the message.

        Returns
        -------
        ndarray of float64
            The value in the coherent SI unit of this dimension, a NumPy scalar if it has no axes. It shares memory with
            the input if the numbers do not change.
        """
        try:
            quantity, in_si, ends = self._checked(value)
        except UnitError as error:
            raise UnitError(f"{name}: {error}; {self._fix(name, value)}") from None
        if self.usual is not None and ends is not None:
            (low, high), (least, most) = ends, self._usual_in_si
            if not (least <= low and high <= most) and (text := self._unusual(name, quantity, low, high)):
                remark({name: text})
        return in_si

    def unusual(self, name: str, value: Quantity | float) -> str:
        """Return what is unusual about a value of a field of this name that is checked already, or ""."""
        if self.usual is None:
            return ""
        quantity = value if isinstance(value, pint.Quantity) else Q(value, self.unit)
        si = scalar_si(quantity, self.unit)
        return self._unusual(name, quantity, si, si)

    def _unusual(self, name: str, quantity: Quantity, low: float, high: float) -> str:
        """Return what is unusual about values with these extremes [SI], or ""."""
        least, most = self._usual_in_si
        if most < high < np.inf:
            worst, how = high, "reaches"
        elif -np.inf < low < least and (least <= 0.0 or (high < least and high != 0.0)):  # a wheel may lift
            worst, how = low, "goes down to"
        else:
            return ""
        assert self.usual is not None
        unit = str(quantity.units)
        number, usual = worst / unit_in_si(unit), f"{self.usual[0]:.5g} to {in_words(self.usual[1], self.unit)}"
        slip = likely_slip(name, number, unit, self.unit, self._usual_in_si)
        return f"{'is' if low == high else how} {in_words(number, unit)}, usually {usual}{slip}"

    def _checked(self, value: object) -> tuple[Quantity, NDArray[np.float64], tuple[float, float] | None]:
        """Return a value as a quantity and in SI, with its extremes unless it is empty."""
        quantity = self._as_quantity(value)
        magnitude = real_array(quantity.magnitude)
        try:
            factor = si_factor(quantity, self.unit)
        except UnitError as error:
            raise UnitError(f"got {_describe(Q(magnitude, str(quantity.units)))}, {error}") from None
        in_si: Any
        if factor == 1.0:
            in_si = magnitude
        elif not magnitude.ndim:  # unlike NumPy's, Python's product is silent if it overflows
            in_si = np.float64(float(magnitude) * factor)
        else:
            in_si = _scaled(magnitude, factor)
        ends = extremes(in_si) if in_si.size else None
        if ends is not None and self._allows(*ends):
            return quantity, in_si, ends
        for wrong, rule in self._rules(in_si):
            if wrong.any():
                first, where = _first(magnitude, wrong)
                raise UnitError(f"{rule}, got {Q(first, str(quantity.units))!r}{where}")
        return quantity, in_si, ends

    def _allows(self, low: float, high: float) -> bool:
        """Return whether the extremes show that no rule is broken; False for an array with NaN."""
        limit = self._limit_in_si
        above = low > 0.0 if self.positive else low >= (-limit if self.negative else 0.0)
        return above and high <= limit and (self.infinite or (low > -np.inf and high < np.inf))

    @cached_property
    def _limit_in_si(self) -> float:
        return self.limit * unit_in_si(self.unit) if self.limit < np.inf else np.inf

    @cached_property
    def _usual_in_si(self) -> tuple[float, float]:
        assert self.usual is not None
        factor = unit_in_si(self.unit)
        return self.usual[0] * factor, self.usual[1] * factor

    def _rules(self, in_si: NDArray[np.float64]) -> Iterator[tuple[NDArray[np.bool_], str]]:
        """Yield for each rule where it is broken, and its text."""
        yield np.isnan(in_si), "must be a number"
        if not self.infinite:
            yield np.isinf(in_si), "must be finite"
        if self.positive:
            yield in_si <= 0, "must be greater than zero"
        if not self.negative:
            yield in_si < 0, "must not be negative"
        yield (
            np.abs(in_si) > self._limit_in_si,
            f"must not exceed {self.limit:g} {self.unit}".rstrip() + " in magnitude",
        )

    @staticmethod
    def _as_quantity(value: object) -> Quantity:
        if not isinstance(value, pint.Quantity):
            if isinstance(value, str) or with_units(value):
                return parse(value)
            raise UnitError(f"got {_describe(value)}, which has no unit")
        return value

    def _fix(self, name: str, value: object) -> str:
        """Return what to do, with an example in a form that Python and TOML share unless the value is an array."""
        several = isinstance(value, list | tuple | np.ndarray)
        if self.unit == "":
            example = 'Q([1, 2], "%")' if several else '"1 %"'
            return f"give {name} in percent or as a ratio, such as {example}"
        unit = self.unit
        example = f'Q([1.0, 2.0], "{unit}")' if several else f'"1.0 {unit}"'
        return f"give {name} in {unit} or another unit of that dimension, such as {example}"

    def __get_pydantic_core_schema__(self, source: object, handler: GetCoreSchemaHandler) -> core_schema.CoreSchema:
        if source is float:
            return handler(source)
        return core_schema.no_info_plain_validator_function(
            self._scalar,
            serialization=core_schema.plain_serializer_function_ser_schema(text_of, when_used="json"),
        )

    def __get_pydantic_json_schema__(
        self, schema: core_schema.CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, object]:
        inner: Any = schema
        while "schema" in inner:  # that of a default, for example
            inner = inner["schema"]
        if inner["type"] == "float":
            return handler(schema)
        example = f"1.0 {self.unit or 'dimensionless'}"
        return {"type": "string", "description": "a number with its unit", "examples": [example]}

    def _scalar(self, value: object) -> Quantity:
        try:
            quantity, in_si, _ = self._checked(value)
        except UnitError as error:
            raise UnitError(f"{error}; {self._fix('it', value)}") from None
        if in_si.ndim != 0:
            raise UnitError(f"must be one value, got an array of shape {in_si.shape}")
        return Q(float(quantity.magnitude), str(quantity.units))


@np.errstate(over="ignore", under="ignore")
def _scaled(magnitude: NDArray[np.float64], factor: float) -> NDArray[np.float64]:
    """Return numbers in another unit; those that overflow are infinite, which callers check."""
    return magnitude * factor


def real_array(value: object) -> NDArray[np.float64]:
    """Return `value` as float64; raise an error for booleans, complex numbers, text and masked entries."""
    if type(value) is float or type(value) is int:
        return np.float64(value)  # type: ignore[return-value]  # computes like an array without axes, but faster
    if np.ma.is_masked(value):
        raise UnitError("masked entries have no value")
    if isinstance(value, pint.Quantity) or (
        isinstance(value, (list, tuple)) and any(isinstance(entry, pint.Quantity) for entry in value)
    ):
        raise UnitError(f"{_describe(value)} has a unit of its own where a plain number is expected")
    try:
        array = np.asarray(value)
    except Exception:  # whatever the `__array__` of another package's type raises
        raise UnitError(f"{_describe(value)} is not an array of numbers") from None
    if array.dtype.kind not in "iuf":
        raise UnitError(f"{_describe(value)} is not a real number")
    if array.dtype != np.float64:
        with np.errstate(over="ignore", under="ignore"):  # numbers with more than 64 bits; callers check for infinity
            array = array.astype(np.float64)
    return array if array.ndim else array[()]


def coefficient(value: object, name: str, *, positive: bool = True) -> NDArray[np.float64]:
    """Return a coefficient without dimension, such as that of friction, as float64.

    Parameters
    ----------
    value : array_like of float, Quantity or str
        Plain numbers, or a ratio with its unit: 0.3, Q(30, "%") and "30 %" are the same. Of any shape.
    name : str
        The argument's name, for the message.
    positive : bool
        Whether the value must be greater than zero.

    Returns
    -------
    ndarray of float64
        The value as a ratio, a NumPy scalar if it has no axes. It shares memory with the input if the numbers do not
        change.

    Raises
    ------
    UnitError
        If it has a dimension, or is not a finite real number.
    """
    try:
        array = _ratios(value)
        low, high = extremes(array) if array.size else (1.0, 1.0)
        if not ((low > 0.0 if positive else low > -np.inf) and high < np.inf):
            first, where = _first(array, ~(np.isfinite(array) & ((array > 0) | (not positive))))
            raise UnitError(f"must be a {'positive ' if positive else ''}finite number, got {first:g}{where}")
    except UnitError as error:
        raise UnitError(f"{name}: {error}; give {name} {_AS_RATIO}") from None
    return array


def plain_number(value: object) -> object:
    """Return a ratio such as "30 %" as a number, for a field that holds one; other text and numbers stay.

    Raises
    ------
    UnitError
        If the value has a dimension or axes, or is True or False.
    """
    if isinstance(value, str):
        try:
            value = parse(value)
        except UnitError:
            return value
    if not isinstance(value, pint.Quantity | bool | np.bool_):
        return value
    try:
        array = _ratios(value)
    except UnitError as error:
        raise UnitError(f"{error}; give it {_AS_RATIO}") from None
    if array.ndim:
        raise UnitError(f"must be one value, got an array of shape {array.shape}")
    return float(array)


def _ratios(value: object) -> NDArray[np.float64]:
    of_units = isinstance(value, pint.Quantity | str) or with_units(value)
    return _RATIO._checked(value)[1] if of_units else real_array(value)


_RATIO, _AS_RATIO = Unit("", positive=False), "as a plain number or in percent, such as 0.3 or '30 %'"


def scalar_si(quantity: Quantity, unit: str) -> float:
    """Return the SI value of a scalar quantity that is already checked."""
    return quantity.magnitude * si_factor(quantity, unit)  # type: ignore[no-any-return]


def in_unit(value: NDArray[np.float64], unit: str) -> NDArray[np.float64]:
    """Return SI floats as floats in `unit`."""
    factor = unit_in_si(unit)
    return value if factor == 1.0 else divided(value, factor)


Length = Annotated[Quantity, Unit("mm")]
"""A field of a model that takes a length, as a quantity or its text."""
Speed = Annotated[Quantity, Unit("m/s", usual=(1e-4, 200.0))]
"""A field of a model that takes a speed, as a quantity or its text."""
WEAR_RATE = "ug/m/mm^2"
"""The unit for showing wear rates: mass lost per metre rolled and contact area."""


def _first(values: NDArray[np.float64], wrong: NDArray[np.bool_]) -> tuple[float, str]:
    """Return the first wrong value and, for an array, its index as text."""
    where = f" at index {np.argwhere(wrong)[0].tolist()}" if values.ndim else ""
    return float(values[wrong][0]), where


def _describe(value: object) -> str:
    kind = "the bare number " if isinstance(value, (int, float)) and not isinstance(value, bool) else ""
    return f"{kind}{shown(value)}"
