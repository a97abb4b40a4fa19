"""The table of variables: name, symbol, unit, words and bounds of each quantity in conditions, results and files."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, Literal

import numpy as np

from wearlaw.errors import InputError, UnitError, shown
from wearlaw.units.quantities import Q, Unit
from wearlaw.units.registry import unit_in_si


@dataclass(frozen=True)
class Variable:
    """A physical quantity in results.

    Attributes
    ----------
    name : str
        Name in code and at the head of a column, such as "wheel_load".
    unit : str
        Unit in results, files and figures, such as "kN"; "" for a plain number. Models compute in SI.
    long_name : str
        Name on axes and in sentences, such as "wheel load Q". Default: the name with spaces.
    meaning : str
        A phrase that says what it is, such as "Vertical force of a wheel on its rail". Default: the long name.
    symbol : str
        Symbol in formulas, if it has one.
    sign : {"positive", "not negative", "any"}
        Sign of the values.
    limit : float
        Largest magnitude [SI].
    text : bool
        Whether the values are texts, not numbers.

    Raises
    ------
    InputError
        If the name is not made of letters, digits and underscores.
    """

    name: str
    unit: str
    long_name: str = ""
    meaning: str = ""
    symbol: str = ""
    sign: Literal["positive", "not negative", "any"] = "positive"
    limit: float = np.inf
    text: bool = False

    def __post_init__(self) -> None:
        """Check the name, and fill in the words."""
        if not (isinstance(self.name, str) and self.name.isidentifier()):
            kind = type(self).__name__.lower()
            raise InputError(
                f"{kind}: its name must be made of letters, digits and underscores, got {shown(self.name)}"
            )
        if not self.long_name:
            object.__setattr__(self, "long_name", self.name.replace("_", " "))
        if not self.meaning:
            object.__setattr__(self, "meaning", self.long_name[:1].upper() + self.long_name[1:])

    @cached_property
    def expected(self) -> Unit:
        """Unit and bounds of an argument."""
        return Unit("" if self.unit == "%" else self.unit, positive=self.sign == "positive", limit=self.limit)

    def _check_unit(self) -> None:
        """Raise a `UnitError` if the unit is unknown; the table of wearlaw does without, so as not to load pint."""
        try:
            unit_in_si(self.unit)
        except UnitError as error:
            raise UnitError(f"{type(self).__name__.lower()} '{self.name}': {error}") from None


def _from_file() -> dict[str, Variable]:
    """Return the variables of the file beside this one; a blank cell stands for the default."""
    text = Path(__file__).with_suffix(".csv").read_text(encoding="utf-8")
    rows: list[Any] = [*csv.DictReader(text.splitlines())]
    return {row["name"]: Variable(**{**row, "limit": float(row["limit"] or "inf")}) for row in rows}


VARIABLES = _from_file()
"""The variables by their names in code."""

GIVEN = (
    *("a", "b", "area", "track_width", "relative_radius", "shear_modulus", "density", "rolling_speed"),
    *("rolled_distance", "frictional_heat", "wear_rate_uncertainty"),
)
"""Variables that are inputs only, never results."""

UNITS = {name: variable.unit for name, variable in VARIABLES.items() if name not in GIVEN}
"""Unit of each variable in results."""

OWNERS: dict[str, str] = {}
"""Module and class of each variable that a class of models or problems has declared, by its name."""


def declare(cls: type, variable: Variable) -> None:
    """Put a variable of a class of models or problems into the table, so that all results and files show it.

    If several classes have a variable of one name, the words of the first are shown.

    Raises
    ------
    UnitError
        If its unit is unknown, or the name is in the table with another dimension.
    InputError
        If the name is that of an outcome, and the variable is none, or the other way round.
    """
    place = f"{cls.__module__}.{cls.__qualname__}"  # the same for a class that is defined again, as in a notebook
    listed, owner = VARIABLES.get(variable.name), OWNERS.get(variable.name)
    if listed is None or variable.unit != listed.unit:
        variable._check_unit()
    if listed is not None and owner != place:
        both = f"variable '{variable.name}': {{}} in {place}, and {{}} in {owner or 'wearlaw'}; choose another name"
        if not alike(variable.unit, listed.unit):
            raise UnitError(both.format(*(f"it has the unit {shown(item.unit)}" for item in (variable, listed))))
        if owner is not None and type(variable) is not type(listed):
            kinds = ("an outcome" if type(item) is not Variable else "a result of a rig" for item in (variable, listed))
            raise InputError(both.format(*(f"it is {kind}" for kind in kinds)))
        return
    VARIABLES[variable.name], UNITS[variable.name], OWNERS[variable.name] = variable, variable.unit, place


def alike(unit: str, other: str) -> bool:
    """Return whether units have one dimension."""
    try:
        return unit == other or Unit(unit, positive=False).si(Q(1.0, other), "unit") is not None
    except UnitError:
        return False


def is_text(variable: str) -> bool:
    """Return whether the values of a variable are texts."""
    return variable in VARIABLES and VARIABLES[variable].text


def name_of(variable: str) -> str:
    """Return the readable name of a variable; a condition that only its rig knows keeps the rig's name."""
    listed = VARIABLES.get(variable)
    return listed.long_name if listed else variable.replace("_", " ")


def meaning_of(variable: str) -> str:
    """Return the meaning of a variable; for a condition that only its rig knows, its name."""
    listed = VARIABLES.get(variable)
    return listed.meaning if listed else name_of(variable)


def expected(*names: str) -> dict[str, Unit]:
    """Return the units and bounds of arguments, by name."""
    return {name: VARIABLES[name].expected for name in names}
