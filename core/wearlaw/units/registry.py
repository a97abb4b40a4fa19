"""pint's registry of units: looked up at each use, with a cache and a readable repr."""

from __future__ import annotations

import functools
import math
import re
from threading import RLock
from typing import Any

import numpy as np
import pint
from pint.util import string_preprocessor

from wearlaw.errors import UnitError, shown

_SIGNIFICANT_DIGITS = 4

_MAKING = RLock()
"""Held by the thread that makes a registry or its class of quantities."""

MOST_POWERS = 1000.0
"""Largest product of the powers in a unit. pint computes numbers with powers, and 9**9**9 for minutes."""

LONGEST_UNIT = 1000
"""Most characters of a unit."""

_POWER = re.compile(
    r"""
    \*\*\s*
    (?: [+-]? (\d+\.?\d*|\.\d+) (?:e-\d+)? | \(\s* [+-]? (\d+\.?\d*|\.\d+) (?:\s*/\s*\d+)? \s*\) )
    (?! [\w.] | \s*\*\* )
""",
    re.VERBOSE,
)
"""A number or a ratio as the power of a unit, to which no other power belongs."""

HARDNESS = re.compile(r"H(BW?|V|R[A-Z]*)[\d\s./]*")
"""A scale of hardness in place of a unit, such as "HB", "HBW 10/3000", "HV30" or "HRC".

The surface of an indentation exceeds its projected area by 1/sin 68° under Vickers's pyramid, and by 2/(1 + √(1 -
(d/D)²)) under a ball of diameter D, by 11 % at the greatest diameter of ISO 6506-1, d = 0.6 D.
"""

_ready: object = None
"""The last registry in force, which is certain to be complete."""


def application_registry() -> pint.UnitRegistry[Any]:
    """Return the registry in force now, which `pint.set_application_registry` may have changed."""
    global _ready
    current: Any = pint.application_registry
    registry: pint.UnitRegistry[Any] = current.get()
    if registry is not _ready:
        with _MAKING:  # pint builds its default registry at the first use of any attribute; threads share it
            registry.Unit  # noqa: B018
            _ready = registry
    return registry


@functools.lru_cache(maxsize=512)
def parse_unit(registry: pint.UnitRegistry[Any], unit: str) -> pint.Unit:
    """Return the unit of a text, or raise a `UnitError`; for the scales of Brinell and Vickers kgf/mm²."""
    if scale := HARDNESS.fullmatch(str(unit)):
        if scale[1].startswith("R"):
            raise UnitError(
                f"{unit} measures a depth of indentation, which is no pressure; find HB or HV in the tables of ISO"
                ' 18265 for your steel, and give that, such as "260 HB"'
            )
        unit = "kgf/mm^2"
    if not _has_small_powers(str(unit)):
        raise UnitError(f"{shown(unit)} is not a unit that can be computed; powers are numbers, as in mm^2 or MPa^0.5")
    try:
        text = re.sub(r"\b([mkM]?)Nm\b", r"(\1N*m)", str(unit))  # Nm is a count of yarn to pint
        parsed = registry.Unit(re.sub(r"\b([a-zµμ]?m)([23])\b", r"\1^\2", text))  # mm2
        in_root_units: Any = registry.get_root_units(parsed)[0]
        if not 0.0 < in_root_units < np.inf:  # nm^40
            raise ValueError
        return parsed
    except pint.UndefinedUnitError:
        raise UnitError(f"{shown(unit)} is not a known unit") from None
    except Exception:  # the registry's expression parser raises many types of error on malformed text
        raise UnitError(f"{shown(unit)} is not a unit") from None


def _has_small_powers(unit: str) -> bool:
    """Return whether a unit can be computed at once."""
    if len(unit) > LONGEST_UNIT:
        return False
    text = string_preprocessor(unit)
    powers = [float(plain or ratio) for plain, ratio in _POWER.findall(text)]
    return len(powers) == text.count("**") and math.prod(max(power, 1.0) for power in powers) <= MOST_POWERS


def si_factor(quantity: Any, due: str) -> float:
    """Return the factor from a quantity's unit to the coherent SI unit of the dimension of `due`."""
    # pint's container of units hashes and compares ten times as fast as the unit around it
    return _factor(quantity._REGISTRY, quantity._units, due)


@functools.lru_cache(maxsize=512)
def _factor(registry: pint.UnitRegistry[Any], container: Any, due: str) -> float:
    unit, due_unit = registry.Unit(container), parse_unit(registry, due)
    if unit.dimensionality != due_unit.dimensionality:
        raise UnitError(f"which does not have the dimension of '{due}'" if due else "which is not a ratio")
    zero, unity = (registry.convert(value, unit, due_unit) for value in (0.0, 1.0))
    if zero != 0.0:  # degrees Celsius, decibel
        raise UnitError("whose unit has an offset or is logarithmic; convert it first")
    return float(unity) * unit_in_si(due)


def unit_in_si(unit: str) -> float:
    """Return the factor from a unit to the coherent SI unit of its dimension."""
    return _coherent(application_registry(), unit)


@functools.lru_cache(maxsize=512)
def _coherent(registry: pint.UnitRegistry[Any], unit: str) -> float:
    """Return the factor from a unit to the coherent SI unit of its dimension."""
    parsed = parse_unit(registry, unit)
    in_root_units: Any = registry.get_root_units(parsed)[0]
    mass_exponent: Any = parsed.dimensionality.get("[mass]", 0)
    # pint's root unit of mass is the gram; all its other root units are those of SI.
    return float(in_root_units / 1000.0**mass_exponent)


def symbol(unit: Any, style: str) -> str:
    """Return a unit's symbol in one of pint's styles, with the same micro sign and dot in all versions of pint.

    The style for files, "~C", gives "ug/m/mm^2", and that for readers, "~P", "µg/m/mm²". Since version 0.26, pint
    writes the Greek letter mu and the dot operator, which look the same but are other characters.
    """
    return _symbol(unit._REGISTRY, unit._units, style)


_ONE_CHARACTER = str.maketrans("\u03bc\u22c5", "\u00b5\u00b7")


@functools.lru_cache(maxsize=512)
def _symbol(registry: pint.UnitRegistry[Any], container: Any, style: str) -> str:
    text = format(registry.Unit(container), style).translate(_ONE_CHARACTER)
    if style == "~C":
        text = text.replace("µ", "u").replace("**", "^")
    return "N·m" if text == "m·N" else text  # pint sorts by letter, but engineers write moments as N·m


def quantity(magnitude: Any, unit: str) -> Any:
    """Return a quantity of the registry in force; the magnitude is a float or a float array."""
    registry = application_registry()
    return quantity_class(registry)(magnitude, parse_unit(registry, unit))


def with_magnitude(quantity: Any, magnitude: Any) -> Any:
    """Return another magnitude in the unit of a quantity."""
    return quantity_class(quantity._REGISTRY).of(magnitude, quantity._units)


def magnitude(quantity: pint.Quantity[Any], unit: str) -> Any:
    """Return the number of a quantity in a unit, whose text is parsed once and not at each use."""
    return quantity.m_as(parse_unit(quantity._REGISTRY, unit))


def from_si(value: Any, unit: str) -> pint.Quantity[Any]:
    """Return SI floats as a quantity in `unit`; arrays without axes become plain numbers."""
    cls, container, factor = _shown_in(application_registry(), unit)
    shown = divided(value, factor) if isinstance(value, np.ndarray) and value.ndim else float(value) / factor
    made: pint.Quantity[Any] = cls.of(shown, container)
    return made


@np.errstate(over="ignore", under="ignore")
def divided(values: Any, factor: float) -> Any:
    """Return an array over a number, whatever `np.errstate` the caller has set."""
    return values / factor


@functools.lru_cache(maxsize=512)
def _shown_in(registry: pint.UnitRegistry[Any], unit: str) -> tuple[type[Any], Any, float]:
    # pint takes its container of units faster than the unit around it
    container = parse_unit(registry, unit)._units
    return quantity_class(registry), container, _coherent(registry, unit)


@functools.lru_cache(maxsize=64)
def quantity_class(registry: pint.UnitRegistry[Any]) -> type[Any]:
    """Return the registry's quantity class with a readable repr."""
    with _MAKING:  # pint's methods compare the classes of quantities, so there must be only one
        return _quantity_class(registry)


@functools.lru_cache(maxsize=64)
def _quantity_class(registry: pint.UnitRegistry[Any]) -> type[Any]:
    class ReadableQuantity(registry.Quantity):  # type: ignore[misc, name-defined]
        @classmethod
        def of(cls, magnitude: Any, container: Any) -> Any:
            """Return the quantity without pint's checks, which take most of the time."""
            made = object.__new__(cls)
            made._magnitude, made._units = magnitude, container
            return made

        def __repr__(self) -> str:
            return f"{_digits(self.magnitude)} {symbol(self.units, '~P')}".rstrip()

        def __str__(self) -> str:
            return repr(self)

        def __reduce__(self) -> tuple[Any, ...]:
            return quantity, (self.magnitude, str(self.units))

    return ReadableQuantity


def _digits(magnitude: Any) -> str:
    def text(number: Any) -> str:
        return f"{number:#.{_SIGNIFICANT_DIGITS}g}".rstrip(".")

    if np.ndim(magnitude) == 0:
        if not isinstance(magnitude, (int, float, np.number)):
            return repr(magnitude)
        return text(magnitude) if magnitude else "0"
    formatter: Any = {"float_kind": text}
    return np.array2string(np.asarray(magnitude), formatter=formatter)
